/* joint_law.c - setting a law, and what becomes of the contacts that come under it.
 *
 * Contacts come under another law with the groups of their blocks, too. */
#include "cycle/joint_law.h"

#include "base/columns.h"
#include "base/inside.h"
#include "base/parallel.h"
#include "base/params.h"
#include "base/strength.h"
#include "contact/across_gap.h"
#include "contact/contacts.h"
#include "contact/places.h"
#include "contact/store.h"
#include "cycle/cycle_data.h"
#include "cycle/remarks.h"
#include "detect/asked.h"
#include "detect/detect.h"
#include "detect/fields.h"
#include "force/field_press.h"
#include "force/joint_laws.h"
#include "model/joints.h"
#include "model/rows.h"
#include "model/scope.h"
#include "plugin/loader.h"

#include <stdlib.h>
#include <string.h>
#include <talus/number.h>

/* ---------------------------------------------------------------- fields ------------------
 *
 * Field contacts that come under another law keep their normal force.
 *
 * What an edge or a corner presses with follows from how far it overlaps. What can be chosen is how far the two faces
 * are moved out (detect/fields.c). So they are moved, outward or inward, until the new law gives the force of the last
 * step. The force grows with the way, from nothing where the faces part. */

/* Tolerance: force that is missed, of the force, and how often the faces are moved at the most. Test:
 * lua/test_moved_faces. */
#define CLOSE 1e-13
#define MOST_TRIES 100

/* A contact under its new law. */
typedef struct trial {
    tl_model *m;
    uint32_t contact;
    const tl_law *law;
    double state[TL_STATE_COLUMNS], wanted;
    bool failed;
} trial;

/* How much larger than wanted the force is with a shift. */
static double excess(trial *t, double shift)
{
    tl_press_row *row = tl_press_row_of(t->m, t->contact);
    row->shift = shift;
    t->failed = t->failed || !tl_field_press_anew(t->m, t->contact, &t->m->detect->narrow[0]);
    return t->failed ? 0 : tl_press_force(t->law, row, t->state) - t->wanted;
}

/* Moves the faces until the force is that wanted: between two shifts with less and more, by the Illinois rule. */
static void find_shift(trial *t)
{
    const tl_press_row *row = tl_press_row_of(t->m, t->contact);
    double a = row->shift, at_a = excess(t, a), way = row->press.overlap, b = a, at_b = at_a;
    for (int k = 0; k < MOST_TRIES && !t->failed && (at_a < 0) == (at_b < 0); k++, way *= 2) {
        a = b;
        at_a = at_b;
        b += at_a < 0 ? way : -way;
        at_b = excess(t, b);
    }
    for (int k = 0; k < MOST_TRIES && !t->failed && fabs(at_b) > CLOSE * t->wanted; k++) {
        double c = (a * at_b - b * at_a) / (at_b - at_a), at_c = excess(t, c);
        if ((at_c < 0) == (at_b < 0)) {
            at_a *= 0.5;
        } else {
            a = b;
            at_a = at_b;
        }
        b = c;
        at_b = at_c;
    }
}

/* What the new law keeps of the first point of a contact that may have been under another one. */
static void read_state(trial *t)
{
    const tl_model *m = t->m;
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    const tl_kind *kind = t->law->kind;
    bool kept = m->joint_laws[contacts->law[t->contact]].kind == kind && t->law->columns > 0;
    size_t i = tl_point_row(contacts, t->contact, TL_FIELD_SHEAR);
    uint32_t column = 0;
    for (uint32_t k = 0; k < p->state_columns && kept; k++)
        t->state[k] = p->state[k][i];
    for (uint32_t k = 0; k < kind->state_count && !kept; k++) {
        const tl_state *state = tl_kind_state(kind, k);
        bool tangent = state->kind == TL_STATE_TANGENT;
        t->state[column] = tangent ? 0 : state->initial;
        column += tangent ? 3 : 1;
    }
}

/* What slip has opened, as the new law has it, is in the shift already. */
static void note_openings(trial *t)
{
    const tl_contacts *contacts = &t->m->detect->contacts;
    tl_press_row *row = tl_press_row_of(t->m, t->contact);
    double opening[TL_LANES] = {0};
    if (tl_law_opens(t->law) && t->m->joint_laws[contacts->law[t->contact]].kind == t->law->kind)
        tl_law_point_openings(t->m, t->law, t->contact, 0, opening);
    for (size_t k = 0; k < TL_FIELD_POINTS; k++)
        row->opening[k] = opening[k];
    row->opened = row->paid = 0;
}

/* Whether there is memory for the next function. Nothing changes. */
static bool may_keep_field_force(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_press_row *row = tl_press_row_of(m, c);
    const tl_press_row kept = *row;
    const double faces = contacts->faces_valid_to[c], points = contacts->points_valid_to[c];
    bool enough = tl_field_press_anew(m, c, &m->detect->narrow[0]);
    *row = kept;
    contacts->faces_valid_to[c] = faces;
    contacts->points_valid_to[c] = points;
    return enough;
}

/* Shear and torsion stay what they are, on the area that presses now. */
static void keep_shear(trial *t, double radius)
{
    const tl_contacts *contacts = &t->m->detect->contacts;
    const tl_points_table *p = &t->m->detect->points;
    const size_t torsion = tl_point_row(contacts, t->contact, TL_FIELD_TORSION);
    const tl_press *press = &tl_press_row_of(t->m, t->contact)->press;
    if (!(press->area > 0 && press->radius > 0))
        return;
    p->area[tl_point_row(contacts, t->contact, TL_FIELD_SHEAR)] = p->area[torsion] = press->area;
    tl_columns_put(p->f_s, torsion, tl_v3_scale(radius / press->radius, tl_columns_get(p->f_s, torsion)));
}

/* Moves the faces of a field contact so that the law of its joint gives the force of the last step. */
static void keep_field_force(tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const size_t first = tl_point_row(contacts, c, TL_FIELD_SHEAR);
    const tl_points_table *p = &m->detect->points;
    const double radius = tl_press_row_of(m, c)->press.radius;
    trial t = {.m = m, .contact = c, .law = tl_law_of(m, contacts->tag[c], contacts->a[c], contacts->b[c])};
    t.wanted = tl_v3_norm(tl_v3_sub(contacts->force[c], tl_columns_get(p->f_s, first)));
    read_state(&t);
    note_openings(&t);
    if (t.wanted > 0 && tl_press_row_of(m, c)->press.overlap > 0)
        find_shift(&t);
    if (!t.failed)
        keep_shear(&t, radius);
}

/* ---------------------------------------------------------------- patches -----------------
 *
 * A new law, kn, ks or curve leaves the forces of its contacts as they are, with what slip has opened.
 *
 * Where one spring takes the place of another, walls are moved so that closures are as much smaller as it is stiffer.
 * That keeps the pressure everywhere, in patches that are open in part, too. By a curve the present normal force of a
 * point becomes the initial one where its walls are now. A point that is open keeps the gap at which it closes. Other
 * properties leave the walls as they are. */

/* Rebases a point that was lifted and which the new law has opened, by a curve: its force becomes the initial one. */
static void rebase_point(tl_points_table *p, size_t i, double closure, double lift, double opening)
{
    bool open = p->flags[i] & TL_POINT_OPEN;
    p->reference[i] += opening + (open ? -lift : closure);
    p->f_n0[i] = open ? 0 : p->f_n[i];
}

/* From springs to springs: closure and lift, pressed or apart, take `ratio` of what they were. So they are 0 along the
 * same line of a patch that is open in part, and pressures are the same everywhere. */
static void rebase_spring(tl_points_table *p, size_t i, double closure, double lift, double opening, double ratio)
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

/* Energies of points of 1 m2 without history that are pressed in by up to 1 m. */
static void find_curve(const tl_law *law, double energy[TL_LANES])
{
    static _Alignas(TL_ALIGN) const double zeros[TL_LANES];
    _Alignas(TL_ALIGN) uint32_t none[TL_LANES] = {0};
    _Alignas(TL_ALIGN) double area[TL_LANES], closure[TL_LANES], force[TL_LANES];
    double *state[TL_STATE_COLUMNS];
    for (size_t k = 0; k < TL_STATE_COLUMNS; k++)
        state[k] = (double *)(uintptr_t)zeros;
    for (size_t k = 0; k < TL_LANES; k++) {
        area[k] = 1;
        closure[k] = k > 0 ? 0.05 * closure[k - 1] : 1;
    }
    const tl_law_batch batch = {.size = sizeof batch,
                                .count = TL_LANES,
                                .area = area,
                                .closure = closure,
                                .f_n0 = zeros,
                                .f_n = force,
                                .state = state,
                                .flags = none};
    tl_enter(law->kind, "pressed");
    ((const tl_law_ops *)law->kind->ops)->pressed(law->self, &batch, energy);
    tl_leave();
}

/* Whether two laws of a kind that tells of energies have the same at any closure of a point without history. */
static bool same_curve(const tl_law *one, const tl_law *other)
{
    _Alignas(TL_ALIGN) double a[TL_LANES], b[TL_LANES];
    find_curve(one, a);
    find_curve(other, b);
    return memcmp(a, b, sizeof a) == 0;
}

/* Whether a law presses as the one before it does, at any closure and opening. */
static bool presses_alike(const tl_law *before, const tl_law *law)
{
    if (before->kind != law->kind || before->kn != law->kn)
        return false;
    if (tl_law_opens(before) && !tl_law_opens(law))
        return false;
    return tl_law_is_linear(law) || (tl_law_presses(law) && same_curve(before, law));
}

/* The same of the last two laws that were compared. Contacts of a law are neighbours, so a curve is not found often. */
typedef struct compared {
    const tl_law *before, *law;
    bool alike;
} compared;

static bool still_alike(compared *last, const tl_law *before, const tl_law *law)
{
    if (last->before != before || last->law != law)
        *last = (compared){before, law, presses_alike(before, law)};
    return last->alike;
}

/* ---------------------------------------------------------------- who comes --------------- */

/* How laws change: by one new law, by new ones that take the places of all, or by groups that blocks have now. */
typedef struct laws_now {
    tl_model *m;
    const tl_law *fresh; /* NULL: groups */
    bool all;            /* fresh[i] takes the place of law i */
    tl_law_change *change;
} laws_now;

/* Cost only: contacts that a thread takes at a time. */
#define CONTACT_CHUNK 2048

/* The law that a contact with forces comes under, or NULL. The contact is under the law that rules it. */
static const tl_law *law_to_come(const laws_now *now, uint32_t c)
{
    const tl_model *m = now->m;
    const tl_contacts *contacts = &m->detect->contacts;
    const uint32_t own = contacts->law[c], a = contacts->a[c], b = contacts->b[c];
    if (own == TL_NO_ROW || !has_forces(m->detect, c))
        return NULL;
    if (now->all)
        return &now->fresh[own];
    if (now->fresh)
        return !tl_scope_before(&m->joint_laws[own].scope, &now->fresh->scope) &&
                       tl_scope_covers(m, &now->fresh->scope, contacts->tag[c], a, b)
                   ? now->fresh
                   : NULL;
    const tl_law *ruling = tl_law_of(m, contacts->tag[c], a, b);
    return ruling && ruling != &m->joint_laws[own] ? ruling : NULL;
}

static void find_coming(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const laws_now *now = user;
    for (size_t c = begin; c < end; c++)
        now->change->coming[c] = law_to_come(now, (uint32_t)c);
}

static bool is_field(const tl_model *m, uint32_t c)
{
    return tl_facet_is_field(&m->detect->contacts.facet[c]) && m->detect->contacts.point_count[c] > 0;
}

/* Lists field contacts that get a law that presses otherwise, and adds the columns that patches need. false: out of
 * memory. */
static bool prepare_coming(const laws_now *now)
{
    tl_model *m = now->m;
    const tl_contacts *contacts = &m->detect->contacts;
    tl_law_change *change = now->change;
    compared last = {NULL, NULL, false};
    bool rebased = false, enough = true;
    for (uint32_t c = 0; c < contacts->table.rows && enough; c++) {
        if (!change->coming[c] || still_alike(&last, &m->joint_laws[contacts->law[c]], change->coming[c]))
            continue;
        rebased = rebased || is_patch(m, c);
        if (is_field(m, c)) {
            enough = may_keep_field_force(m, c);
            change->field[change->field_count++] = c;
        }
    }
    return enough && (!rebased || tl_detect_hold_initial(m->detect));
}

/* Keeps the forces of patches. What their contacts, and those of fields, have stored is not known any more. */
static void rebase(tl_model *m, const tl_law_change *change)
{
    tl_detect *d = m->detect;
    compared last = {NULL, NULL, false};
    for (uint32_t c = 0; d && c < d->contacts.table.rows; c++) {
        const tl_law *law = change->coming[c];
        if (!law)
            continue;
        const tl_law *before = &m->joint_laws[d->contacts.law[c]];
        const bool alike = still_alike(&last, before, law);
        if (!alike || before->ks != law->ks || !tl_law_is_linear(law))
            d->contacts.stored[c] = NAN; /* its springs store another energy */
        if (!alike && is_patch(m, c))
            rebase_patch(m, c, law);
        if (before->kind == law->kind && tl_law_opens(before) && !tl_law_opens(law))
            /* how far it is open is in its walls now */
            tl_contact_begin_law(m, c, law->kind, &d->lanes[0]);
    }
}

/* Points whose joint law becomes one of another kind begin with the states of that. */
static void reset(tl_model *m, uint32_t law, const tl_kind *kind)
{
    tl_detect *d = m->detect;
    for (uint32_t c = 0; d && c < d->contacts.table.rows; c++)
        if (d->contacts.law[c] == law)
            tl_contact_begin_law(m, c, kind, &d->lanes[0]);
}

/* ---------------------------------------------------------------- laws of joints ---------- */

/* Brings contacts up to the present places, where a step that failed has left them already. */
static tl_status bring_up(tl_model *m)
{
    tl_asked_end(m);
    return m->detect ? tl_detect_update(m) : TL_OK;
}

/* Finds who comes under which law, and holds what that needs. All that can fail is done before laws take their
 * places. */
static tl_status prepare_contacts(const laws_now *now, size_t laws)
{
    tl_model *m = now->m;
    tl_detect *d = m->detect;
    bool enough = true;
    if (!d)
        return TL_OK;
    for (size_t i = 0; i < laws && enough; i++)
        enough = tl_detect_hold_states(d, now->fresh[i].columns);
    const size_t rows = d->contacts.table.rows;
    now->change->coming = malloc((rows + 1) * sizeof *now->change->coming);
    now->change->field = malloc((rows + 1) * sizeof *now->change->field);
    if (!enough || !now->change->coming || !now->change->field)
        return tl_fail_memory(&m->error);
    tl_parallel_for(m->pool, rows, CONTACT_CHUNK, find_coming, (void *)(uintptr_t)now);
    return prepare_coming(now) ? TL_OK : tl_fail_memory(&m->error);
}

static void keep_field_forces(tl_model *m, const tl_law_change *change)
{
    for (size_t k = 0; k < change->field_count; k++)
        keep_field_force(m, change->field[k]);
}

/* The law of just this scope, or NULL. */
static tl_law *law_of_scope(tl_model *m, const tl_scope *scope)
{
    for (size_t i = 0; i < m->joint_law_count; i++)
        if (tl_scope_same(&m->joint_laws[i].scope, scope))
            return &m->joint_laws[i];
    return NULL;
}

/* That law, or a place for it behind the others; NULL: out of memory. */
static tl_law *place_of(tl_model *m, const tl_scope *scope)
{
    tl_law *place = law_of_scope(m, scope);
    if (place)
        return place;
    tl_law *laws = realloc(m->joint_laws, (m->joint_law_count + 1) * sizeof *laws);
    if (!laws)
        return NULL;
    m->joint_laws = laws;
    laws[m->joint_law_count] = (tl_law){.kind = NULL};
    return &laws[m->joint_law_count];
}

/* Puts a law in its place, which owns it then; after a failure nothing has changed. */
static tl_status put_law(tl_model *m, const tl_law *law)
{
    tl_law_change change = {NULL, NULL, 0};
    const laws_now now = {m, law, false, &change};
    tl_law *place = place_of(m, &law->scope);
    tl_status status = place ? bring_up(m) : tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = prepare_contacts(&now, 1);
    if (status == TL_OK) {
        char scope[TL_SCOPE_TEXT], of[TL_SCOPE_TEXT + 60];
        tl_text_print(of, sizeof of, "%s, law '%.40s'", tl_scope_text(m, &law->scope, scope), law->kind->name);
        tl_remark_friction(m, of, law->kind, law->params);
        rebase(m, &change);
        const uint32_t row = (uint32_t)(place - m->joint_laws);
        if (row == m->joint_law_count)
            m->joint_law_count++;
        else if (place->kind != law->kind)
            reset(m, row, law->kind);
        tl_law_clear(place);
        *place = *law;
        keep_field_forces(m, &change);
        m->laws++;
    }
    tl_law_change_free(&change);
    return status;
}

/* Puts laws in the places of all, which own them then; after a failure nothing has changed. Each is of the same kind
 * and scope as that before. */
static tl_status put_laws(tl_model *m, const tl_law *laws)
{
    tl_law_change change = {NULL, NULL, 0};
    const laws_now now = {m, laws, true, &change};
    tl_status status = bring_up(m);
    if (status == TL_OK)
        status = prepare_contacts(&now, m->joint_law_count);
    if (status == TL_OK) {
        rebase(m, &change);
        for (size_t i = 0; i < m->joint_law_count; i++) {
            tl_law_clear(&m->joint_laws[i]);
            m->joint_laws[i] = laws[i];
        }
        keep_field_forces(m, &change);
        m->laws++;
    }
    tl_law_change_free(&change);
    return status;
}

/* ---------------------------------------------------------------- groups ------------------ */

/* Gives blocks the groups of a change, and the change those that they had. */
static void swap_groups(tl_model *m, tl_group_change *change, bool backward)
{
    for (size_t i = 0; i < change->count; i++) {
        const size_t k = backward ? change->count - 1 - i : i; /* some block may be there twice */
        uint32_t *group = &m->blocks.group[change->row[k]], had = *group;
        *group = change->group[k];
        change->group[k] = had;
    }
}

static tl_status begin_groups(tl_model *m, tl_group_change *change)
{
    const laws_now now = {m, NULL, false, &change->laws};
    tl_status status = bring_up(m);
    if (status != TL_OK)
        return status;
    swap_groups(m, change, false);
    status = prepare_contacts(&now, 0);
    swap_groups(m, change, true);
    return status;
}

static void apply_groups(tl_model *m, tl_group_change *change)
{
    swap_groups(m, change, false);
    rebase(m, &change->laws);
    keep_field_forces(m, &change->laws);
    m->laws++;
    if (m->cycle)
        m->cycle->dt = 0;
}

void tl_laws_follow_groups(tl_model *m)
{
    static const tl_group_verbs verbs = {begin_groups, apply_groups};
    m->group_verbs = &verbs;
}

/* ---------------------------------------------------------------- setting a law ----------- */

/* The law whose properties one of this scope begins with: that which goes before all others that are for the whole of
 * it, or NULL. */
static const tl_law *law_to_begin_with(const tl_model *m, const tl_scope *scope)
{
    const tl_law *best = NULL;
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const tl_law *one = &m->joint_laws[i];
        if (tl_scope_contains(&one->scope, scope) && (!best || tl_scope_before(&one->scope, &best->scope)))
            best = one;
    }
    return best;
}

static tl_status no_law(tl_model *m, const tl_scope *scope)
{
    char text[TL_SCOPE_TEXT];
    const char *joint = tl_pattern_name(m, scope->tag);
    if (scope->names > 0)
        return tl_fail(&m->error, TL_E_STATE, "%s: no law is for all of them yet: name one",
                       tl_scope_text(m, scope, text));
    return tl_fail(&m->error, TL_E_STATE,
                   m->speaks_lua ? "joint '%s' has no law yet: name one, as in model:joint(\"%s\", LAW, {...})"
                                 : "joint '%s' has no law yet: give tl_joint_law() one for \"%s\"",
                   joint, joint);
}

tl_status tl_joint_law_for(tl_model *m, const tl_law_scope *given, const char *law, const tl_args *args)
{
    tl_scope scope;
    tl_law fresh = {.kind = NULL};
    tl_status status = tl_model_may_set(m, "set a law or its properties");
    if (status != TL_OK)
        return status;
    tl_rows_tidy(m);
    status = tl_scope_read(m, given, &scope);
    if (status != TL_OK)
        return status;
    const tl_law *same = law_of_scope(m, &scope), *from = law ? NULL : law_to_begin_with(m, &scope);
    const tl_kind *kind = law ? tl_plugin_find(TL_KIND_LAW, law) : from ? from->kind : NULL;
    if (same && !law) /* it is the same law, and not a later one */
        scope.order = same->scope.order;
    if (law && !kind)
        status = tl_kind_unknown(&m->error, TL_KIND_LAW, law);
    else if (!kind)
        status = no_law(m, &scope);
    else
        status = tl_law_make_for(m, &scope, kind, args, from, &fresh);
    if (status == TL_OK)
        scope = (tl_scope){.names = 0};
    if (status == TL_OK && (status = put_law(m, &fresh)) != TL_OK)
        tl_law_clear(&fresh);
    tl_scope_clear(&scope);
    if (status == TL_OK && m->cycle)
        m->cycle->dt = 0;
    if (status == TL_OK)
        tl_laws_follow_groups(m);
    return status;
}

tl_status tl_joint_law(tl_model *m, const char *joint, const char *law, const tl_args *args)
{
    tl_law_scope scope = tl_law_scope_default();
    scope.joint = joint;
    return tl_joint_law_for(m, &scope, law, args);
}

/* ---------------------------------------------------------------- other values ------------
 *
 * Laws of their scopes with some of their parameters multiplied or divided. */

/* Most parameters of a law that are stiffnesses. */
#define MOST_STIFF 16

/* A law as `from` is, but for some values. */
static tl_status make_with(tl_model *m, const tl_law *from, const tl_args *args, tl_law *out)
{
    tl_scope scope;
    if (!tl_scope_copy(&from->scope, &scope))
        return tl_fail_memory(&m->error);
    const tl_status status = tl_law_make_for(m, &scope, from->kind, args, from, out);
    if (status != TL_OK)
        tl_scope_clear(&scope);
    return status;
}

/* The law with its stiffnesses multiplied. */
static tl_status make_stiffer(tl_model *m, const tl_law *law, double factor, tl_law *out)
{
    const tl_kind *kind = law->kind;
    char text[TL_SCOPE_TEXT];
    tl_value values[MOST_STIFF];
    tl_args args = {values, 0};
    for (uint32_t i = 0; i < kind->param_count && args.count < MOST_STIFF; i++) {
        const tl_param p = tl_param_row(kind->params, i, kind->param_stride);
        double value;
        if (p.type != TL_PARAM_REAL || !(p.flags & TL_PARAM_STIFFNESS))
            continue;
        memcpy(&value, (const char *)law->params + p.offset, sizeof value);
        if (!isnan(value))
            values[args.count++] = tl_arg_number(p.name, factor * value);
    }
    if (args.count == 0)
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "%s: law '%s' says of no parameter that it is a stiffness; its plugin is to mark them with "
                       "TL_PARAM_STIFFNESS",
                       tl_scope_text(m, &law->scope, text), kind->name);
    return make_with(m, law, &args, out);
}

/* Puts laws in the places of all if `status` is TL_OK, and frees those of `made` that no place has taken. */
static tl_status put_made(tl_model *m, tl_law *made, size_t ready, tl_status status)
{
    if (status == TL_OK)
        status = put_laws(m, made);
    if (status == TL_OK && m->cycle)
        m->cycle->dt = 0;
    for (size_t i = 0; i < ready && status != TL_OK; i++)
        tl_law_clear(&made[i]);
    free(made);
    return status;
}

tl_status tl_joints_stiffen(tl_model *m, double factor)
{
    tl_status status = tl_model_may_set(m, "make joints stiffer");
    if (status == TL_OK && !(factor > 0 && isfinite(factor)))
        status = tl_fail(&m->error, TL_E_ARGUMENT, "a factor of stiffness of %g must be > 0", factor);
    const size_t count = m->joint_law_count;
    tl_law *made = status == TL_OK ? calloc(count + 1, sizeof *made) : NULL;
    if (status == TL_OK && !made)
        status = tl_fail_memory(&m->error);
    size_t ready = 0;
    while (status == TL_OK && ready < count) {
        status = make_stiffer(m, &m->joint_laws[ready], factor, &made[ready]);
        ready += status == TL_OK;
    }
    return put_made(m, made, ready, status);
}

/* The law with its strengths divided. */
static tl_status make_weaker(tl_model *m, const tl_law *law, double factor, tl_law *out)
{
    tl_args args;
    void *held;
    if (!tl_strengths_divide(law->kind, law->params, factor, &args, &held))
        return tl_fail_memory(&m->error);
    const tl_status status = make_with(m, law, &args, out);
    free(held);
    return status;
}

tl_status tl_joints_weaken(tl_model *m, const tl_model *from, const uint8_t *which, double factor)
{
    static const tl_args none = {NULL, 0};
    const size_t count = from->joint_law_count;
    tl_law *made = calloc(count + 1, sizeof *made);
    tl_status status = made ? TL_OK : tl_fail_memory(&m->error);
    size_t ready = 0;
    while (status == TL_OK && ready < count) {
        const tl_law *law = &from->joint_laws[ready];
        status = which[ready] ? make_weaker(m, law, factor, &made[ready]) : make_with(m, law, &none, &made[ready]);
        ready += status == TL_OK;
    }
    return put_made(m, made, ready, status);
}
