/* joint_laws.c - a law and its properties, for a joint, and what becomes of the contacts that come under it.
 *
 * A new law, kn, ks or curve leaves the forces of its contacts as they are, with what slip has opened. Where one spring
 * takes the place of another, walls are moved so that closures are as much smaller as it is stiffer. That keeps the
 * pressure everywhere, in patches that are open in part, too. By a curve the present normal force of a point becomes
 * the initial one where its walls are now. A point that is open keeps the gap at which it closes. Other properties
 * leave the walls as they are. */

#include "force/joint_laws.h"

#include "base/inside.h"
#include "contact/across_gap.h"
#include "contact/contacts.h"
#include "contact/places.h"
#include "contact/store.h"
#include "force/field_press.h"
#include "model/joints.h"
#include "plugin/loader.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Forces over smaller ones would not be finite. */
static bool is_stiffness(double k)
{
    return k == 0 || (k >= TL_LEAST_MEASURE && isfinite(k));
}

/* A law and its properties from what `out` has: those not given stay, with `keep`. */
static tl_status make(tl_law *out, const tl_args *args, bool keep, const char *context,
                      tl_error *error)
{
    const tl_kind *kind = out->kind;
    const tl_law_ops *ops = kind->ops;
    tl_report report = {.size = sizeof report};
    tl_status status = tl_args_read(kind->params, kind->param_count, kind->param_stride, args, keep,
                                    out->params, context, error);
    out->self = out->params;
    if (status == TL_OK && ops->create) {
        tl_enter(kind, "create");
        status = ops->create(out->params, &out->self, &report);
        tl_leave();
        if (status != TL_OK)
            tl_fail(error, status, "%s of plugin '%s': %s", context, tl_plugin_id(kind),
                    tl_report_text(&report, status));
    }
    if (status != TL_OK) {
        free(out->params);
        *out = (tl_law){0};
        return status;
    }
    tl_enter(kind, "stiffness");
    ops->stiffness(out->self, &out->kn, &out->ks);
    tl_leave();
    if (!is_stiffness(out->kn) || !is_stiffness(out->ks)) {
        tl_fail(error, TL_E_PLUGIN,
                "%s of plugin '%s': its stiffness() gives kn = %g and ks = %g Pa/m; both must be "
                "finite and 0 or at least %g",
                context, tl_plugin_id(kind), out->kn, out->ks, TL_LEAST_MEASURE);
        tl_law_clear(out);
        return TL_E_PLUGIN;
    }
    tl_state_columns at = {0};
    out->energy = TL_NO_ROW;
    while (tl_state_next(kind, UINT32_MAX, &at)) {
        out->tangents |= at.count == 3 ? 1u << at.begin : 0;
        out->splits = out->splits || at.state->transfer == TL_TRANSFER_SPLIT;
        if (at.state->transfer == TL_TRANSFER_ENERGY)
            out->energy = at.begin;
    }
    tl_enter(kind, "stateless");
    out->columns = ops->stateless && ops->stateless(out->self) ? 0 : at.begin;
    tl_leave();
    tl_enter(kind, "pulls");
    out->pulls = ops->pulls ? ops->pulls(out->self) : TL_PULL_ANY;
    tl_leave();
    return TL_OK;
}

tl_status tl_law_make(const tl_kind *kind, const tl_args *args, const char *context,
                      tl_error *error, tl_law *out)
{
    *out = (tl_law){.kind = kind, .params = calloc(1, kind->params_size + 1)};
    return out->params ? make(out, args, false, context, error) : tl_fail_memory(error);
}

tl_status tl_law_make_for(tl_model *m, tl_tag tag, const char *joint, const tl_kind *kind,
                          const tl_args *args, const tl_law *from, tl_law *out)
{
    char context[TL_ERROR_TEXT / 2];
    *out = (tl_law){.tag = tag, .kind = kind, .params = calloc(1, kind->params_size + 1)};
    if (!out->params)
        return tl_fail_memory(&m->error);
    if (from)
        memcpy(out->params, from->params, kind->params_size);
    snprintf(context, sizeof context, "joint '%.80s', law '%.40s'", joint, kind->name);
    return make(out, args, from != NULL, context, &m->error);
}

/* Rebases a point that was lifted and which the new law has opened, by a curve: its force becomes the initial one. */
static void rebase_point(tl_points_table *p, size_t i, double closure, double lift, double opening)
{
    bool open = p->flags[i] & TL_POINT_OPEN;
    p->reference[i] += opening + (open ? -lift : closure);
    p->f_n0[i] = open ? 0 : p->f_n[i];
}

/* From springs to springs: closure and lift, pressed or apart, take `ratio` of what they were. So they are 0 along the
 * same line of a patch that is open in part, and pressures are the same everywhere. */
static void rebase_spring(tl_points_table *p, size_t i, double closure, double lift, double opening,
                          double ratio)
{
    p->reference[i] += closure + opening - ratio * (closure + lift);
    p->f_n0[i] = 0;
}

static void rebase_patch(tl_model *m, uint32_t c, const tl_law *law)
{
    tl_detect *d = m->detect;
    const tl_law *before = &m->joint_laws[d->contacts.law[c]];
    const bool opened = before->kind == law->kind && tl_law_opens(law);
    const bool springs = tl_law_is_linear(before) && tl_law_is_linear(law) && law->kn > 0;
    double lift[TL_LANES], opening[TL_LANES] = {0};
    tl_contact_places(m, c, &d->lanes[0]);
    for (size_t first = 0; first < d->contacts.point_count[c]; first += TL_LANES) {
        tl_contact_point_lifts(m, c, first, lift);
        if (opened)
            tl_law_point_openings(m, law, c, first, opening);
        for (size_t l = 0; l < TL_LANES && first + l < d->contacts.point_count[c]; l++) {
            size_t i = tl_point_row(&d->contacts, c, first + l);
            double closure = d->lanes[0].closure[first + l];
            if (d->points.area[i] <= 0)
                continue;
            if (springs)
                rebase_spring(&d->points, i, closure, lift[l], opening[l], before->kn / law->kn);
            else
                rebase_point(&d->points, i, closure, lift[l], opening[l]);
        }
    }
}

/* Whether there are forces to keep. A contact that carries nothing and has no initial force begins under the new
 * law. */
static bool has_forces(const tl_detect *d, uint32_t c)
{
    const tl_points_table *p = &d->points;
    if (d->contacts.point_count[c] > 0 && !tl_v3_is_zero(d->contacts.force[c]))
        return true; /* its points may have been laid since */
    for (uint32_t k = 0; k < d->contacts.point_count[c]; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        if (p->f_n[i] != 0 || (p->initial && p->f_n0[i] != 0))
            return true;
    }
    return false;
}

static bool is_patch(const tl_model *m, uint32_t c)
{
    return tl_facet_is_patch(&m->detect->contacts.facet[c]);
}

/* Whether a contact that has forces gets this law in place of another. */
static bool takes_over(const tl_model *m, const tl_law *law, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    if (contacts->law[c] == TL_NO_ROW || !tl_tag_matches(law->tag, contacts->tag[c]))
        return false;
    const tl_law *ruling = tl_law_of(m, contacts->tag[c]);
    /* a law set for a plane of the joint goes before one set for the whole */
    if (ruling->tag.joint > 0 && law->tag.joint == 0)
        return false;
    if (ruling->tag.plane > 0 && law->tag.plane == 0)
        return false;
    return has_forces(m->detect, c);
}

/* Whether a law presses as the one before it does, at any closure and opening. */
static bool presses_alike(const tl_law *before, const tl_law *law)
{
    if (before->kind != law->kind || before->kn != law->kn)
        return false;
    if (tl_law_opens(before) && !tl_law_opens(law))
        return false;
    return tl_law_is_linear(law) || (tl_law_presses(law) && tl_law_same_curve(before, law));
}

bool tl_law_rebases(const tl_model *m, const tl_law *law, uint32_t c)
{
    return takes_over(m, law, c) && !presses_alike(&m->joint_laws[m->detect->contacts.law[c]], law);
}

tl_law_batch tl_lanes_batch(const tl_model *m, const tl_point_lanes *l, size_t count)
{
    return (tl_law_batch){.size = sizeof(tl_law_batch),
                          .count = (uint32_t)count,
                          .dt = m->dt,
                          .closure = l->closure,
                          .normal = {l->normal[0], l->normal[1], l->normal[2]},
                          .du_n = l->du_n,
                          .du_s = {l->du_s[0], l->du_s[1], l->du_s[2]},
                          .f_n = l->before[0],
                          .f_s = {l->before[1], l->before[2], l->before[3]},
                          .state = &l->before[4],
                          .flags = l->flags_before,
                          .stored = l->stored,
                          .dissipated = l->dissipated};
}

tl_status tl_law_update(const tl_law *law, const tl_law_batch *batch, tl_report *report)
{
    const tl_law_ops *ops = law->kind->ops;
    *report = (tl_report){.size = sizeof *report};
    tl_enter(law->kind, "update");
    tl_status status = ops->update(law->self, batch, report);
    tl_leave();
    return status;
}

bool tl_law_reserve(tl_model *m, const tl_law *law)
{
    bool rebased = false;
    for (uint32_t c = 0; c < m->detect->contacts.table.rows && !rebased; c++)
        rebased = is_patch(m, c) && tl_law_rebases(m, law, c);
    return tl_detect_hold_states(m->detect, law->columns) &&
           (!rebased || tl_detect_hold_initial(m->detect));
}

void tl_law_rebase(tl_model *m, const tl_law *law)
{
    tl_detect *d = m->detect;
    for (uint32_t c = 0; d && c < d->contacts.table.rows; c++) {
        if (!takes_over(m, law, c))
            continue;
        const tl_law *before = &m->joint_laws[d->contacts.law[c]];
        bool alike = presses_alike(before, law);
        if (!alike || before->ks != law->ks || !tl_law_is_linear(law))
            d->contacts.stored[c] = NAN; /* its springs store another energy */
        if (!alike && is_patch(m, c))
            rebase_patch(m, c, law);
        if (before->kind == law->kind && tl_law_opens(before) && !tl_law_opens(law))
            tl_contact_begin_law(m, c, law->kind,
                                 &d->lanes[0]); /* how far it is open is in its walls now */
    }
}

void tl_law_reset(tl_model *m, uint32_t law, const tl_kind *kind)
{
    tl_detect *d = m->detect;
    for (uint32_t c = 0; d && c < d->contacts.table.rows; c++)
        if (d->contacts.law[c] == law)
            tl_contact_begin_law(m, c, kind, &d->lanes[0]);
}
