/* word.c - what the law of a patch says that it carries in the step to come.
 *
 * It is asked as in the step, its cells found where some of the patch is apart, but with copies of the points: what it changes is
 * forgotten. Bonds that break in the step break at their points only. */
#include "force/word.h"

#include "base/columns.h"
#include "base/inside.h"
#include "contact/detection.h"
#include "force/partly_open.h"

#include <string.h>

/* The contact alone in its place of its SIMD group. */
static tl_simd_group alone(const tl_contacts *contacts, uint32_t c, size_t l)
{
    tl_simd_group group = {.start = contacts->point_start[c] - (uint32_t)l,
                           .slots = contacts->point_count[c]};
    for (size_t k = 0; k < TL_LANES; k++)
        group.contact[k] = k == l ? c : TL_NO_ROW;
    return group;
}

/* Takes points from the first lanes to those of their place in a SIMD group; what is beside them carries nothing. */
static void spread(const tl_point_lanes *t, size_t count, size_t l)
{
    double *const column[] = {t->normal[0], t->normal[1], t->normal[2], t->closure,  t->arm[0],
                              t->arm[1],    t->arm[2],    t->du_n,      t->du_s[0],  t->du_s[1],
                              t->du_s[2],   t->before[1], t->before[2], t->before[3]};
    for (size_t j = 0; j < sizeof column / sizeof *column; j++)
        for (size_t k = count; k-- > 0;) { /* none goes to a lane before its own */
            double value = column[j][k];
            for (size_t i = 0; i < TL_LANES; i++)
                column[j][k * TL_LANES + i] = j < 3 || i == l ? value : 0;
        }
}

/* Copies of what the law would change. */
static void copy_points(const tl_points_table *p, size_t first, size_t rows,
                        const tl_point_lanes *t)
{
    memset(t->stored, 0, rows * sizeof *t->stored);
    memset(t->dissipated, 0, rows * sizeof *t->dissipated);
    memcpy(t->before[0], p->f_n + first, rows * sizeof *t->before[0]);
    for (uint32_t s = 0; s < TL_STATE_COLUMNS; s++)
        if (s < p->state_columns)
            memcpy(t->before[4 + s], p->state[s] + first, rows * sizeof *t->before[4 + s]);
        else
            memset(t->before[4 + s], 0, rows * sizeof *t->before[4 + s]);
    memcpy(t->flags_before, p->flags + first, rows * sizeof *t->flags_before);
}

static bool ask(const tl_model *m, const tl_law *law, size_t first, size_t rows, bool partly,
                const tl_point_lanes *t)
{
    const tl_points_table *p = &m->detect->points;
    tl_law_batch batch = {.size = sizeof batch,
                          .count = (uint32_t)rows,
                          .dt = m->dt,
                          .area = p->area + first,
                          .closure = t->closure,
                          .f_n0 = p->f_n0 ? p->f_n0 + first : t->zero,
                          .normal = {t->normal[0], t->normal[1], t->normal[2]},
                          .du_n = t->du_n,
                          .du_s = {t->du_s[0], t->du_s[1], t->du_s[2]},
                          .f_n = t->before[0],
                          .f_s = {t->before[1], t->before[2], t->before[3]},
                          .state = &t->before[4],
                          .flags = t->flags_before,
                          .stored = t->stored,
                          .dissipated = t->dissipated,
                          .closure_edge = law->pulls != TL_PULL_NONE ? t->edge : t->closure,
                          .closure_apart = partly ? t->apart : t->zero};
    tl_report report = {.size = sizeof report};
    const tl_law_ops *ops = law->kind->ops;
    tl_enter(law->kind, "update");
    tl_status status = ops->update(law->self, &batch, &report);
    tl_leave();
    return status == TL_OK;
}

/* Exchanges the normal forces of the points for those in the lanes. */
static void exchange(tl_detect *d, uint32_t c, size_t l, const tl_point_lanes *t)
{
    for (size_t k = 0; k < d->contacts.point_count[c]; k++) {
        double *of = &d->points.f_n[tl_point_row(&d->contacts, c, k)], was = *of;
        *of = t->before[0][k * TL_LANES + l];
        t->before[0][k * TL_LANES + l] = was;
    }
}

/* Adds what cells have beside their points, by whose forces they go. */
static void add_cells(tl_model *m, const tl_simd_group *group, size_t l, const tl_point_lanes *t,
                      tl_word *to)
{
    const tl_vec3 turn[TL_LANES] = {{0, 0, 0}}; /* that is for heat alone */
    const tl_law *law = &m->joint_laws[m->detect->contacts.law[group->contact[l]]];
    tl_part_sums all[TL_LANES], *more = &all[l];
    exchange(m->detect, group->contact[l], l, t);
    tl_simd_group_part_sum(m, law, group, t, 0, (tl_part_lanes){1u << l, 0}, turn, all);
    exchange(m->detect, group->contact[l], l, t);
    tl_vec3 force = tl_v3_scale(more->force, tl_columns_get(t->normal, l));
    to->force = tl_v3_add(to->force, force);
    to->moment = tl_v3_add(to->moment, more->moment);
    to->moment = tl_v3_add(to->moment, tl_v3_cross(more->arm, force));
}

bool tl_patch_word(tl_model *m, uint32_t c, const tl_point_lanes *t, tl_word *out)
{
    const tl_detect *d = m->detect;
    const tl_law *law = &m->joint_laws[d->contacts.law[c]];
    size_t count = d->contacts.point_count[c], l = d->contacts.point_start[c] % TL_LANES;
    const tl_simd_group group = alone(&d->contacts, c, l);
    *out = (tl_word){.most = 0};
    spread(t, count, l);
    if (law->pulls != TL_PULL_NONE)
        tl_simd_group_edges(m, &group, t, 0);
    const bool partly = tl_simd_group_part(m, law, &group, t, 0).parts != 0;
    copy_points(&d->points, group.start, count * TL_LANES, t);
    if (!ask(m, law, group.start, count * TL_LANES, partly, t))
        return false;
    for (size_t k = 0; k < count; k++) {
        size_t i = k * TL_LANES + l;
        double normal = t->before[0][i];
        tl_vec3 force = tl_v3_scale(normal, tl_columns_get(t->normal, i));
        out->force = tl_v3_add(out->force, force);
        out->moment = tl_v3_add(out->moment, tl_v3_cross(tl_columns_get(t->arm, i), force));
        out->most += fabs(normal);
    }
    if (partly)
        add_cells(m, &group, l, t, out);
    for (size_t k = 0; k < count; k++)
        tl_columns_put(&t->before[1], k, tl_columns_get(&t->before[1], k * TL_LANES + l));
    return isfinite(out->most) && tl_v3_finite(out->force) && tl_v3_finite(out->moment);
}
