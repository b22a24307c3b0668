/* gather.c - what segments do to gridpoints and bodies, and how stiff they hold them. */
#include "segment/gather.h"

#include "base/columns.h"
#include "contact/contacts.h"
#include "force/joint_laws.h"
#include "zone/grid.h"

#include <math.h>

void tl_segments_gather_body(const tl_model *m, uint32_t body, tl_acting *on)
{
    const struct tl_segments *s = m->segments;
    if (body >= s->bodies_listed)
        return;
    for (uint32_t k = s->body_start[body]; k < s->body_start[body + 1]; k++) {
        const tl_segment_use *use = &s->body_use[k];
        double(*push)[4] = s->table.push[use->segment].of[use->side];
        on->force = tl_v3_add(on->force, tl_v3(push[0][0], push[0][1], push[0][2]));
        on->moment = tl_v3_add(on->moment, tl_v3(push[1][0], push[1][1], push[1][2]));
        on->magnitude += s->table.bears[use->segment];
    }
}

/* By how much of it a segment counts beside a field contact. */
static double counts_of(const struct tl_segments *s, uint32_t segment)
{
    const uint32_t meet = s->table.of[segment].meet;
    return meet == TL_NO_ROW ? 0 : s->meet[meet].counts;
}

void tl_segments_damp_body(const tl_model *m, uint32_t body, tl_vec3 *force, tl_vec3 *moment)
{
    const struct tl_segments *s = m->segments;
    if (!(s->damping_rate > 0) || body >= s->bodies_listed)
        return;
    for (uint32_t k = s->body_start[body]; k < s->body_start[body + 1]; k++) {
        const tl_segment_use *use = &s->body_use[k];
        double(*push)[4] = s->damping[use->segment].of[use->side];
        const double counts = counts_of(s, use->segment);
        *force = tl_v3_madd(*force, counts, tl_v3(push[0][0], push[0][1], push[0][2]));
        *moment = tl_v3_madd(*moment, counts, tl_v3(push[1][0], push[1][1], push[1][2]));
    }
}

void tl_segments_damp(tl_model *m)
{
    const struct tl_segments *s = m->segments;
    tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; s && s->damping_rate > 0 && row < p->table.rows; row++) {
        tl_vec3 sum = tl_columns_get(p->damping, row);
        for (uint32_t k = s->use_start[row]; k < s->use_start[row + 1]; k++) {
            const tl_segment_use *use = &s->use[k];
            const double *push = s->damping[use->segment].of[use->side][use->corner];
            sum = tl_v3_madd(sum, counts_of(s, use->segment), tl_v3(push[0], push[1], push[2]));
        }
        tl_columns_put(p->damping, row, sum);
    }
}

/* Twice k w of each point, for each corner: w its weight there. */
void tl_segments_stiffen(tl_model *m)
{
    const struct tl_segments *s = m->segments;
    for (uint32_t row = 0; s && row < s->table.table.rows; row++) {
        const tl_segment *of = &s->table.of[row];
        if (of->meet == TL_NO_ROW || s->meet[of->meet].law == TL_NO_ROW)
            continue;
        const double k = tl_law_stiffness(&m->joint_laws[s->meet[of->meet].law]);
        for (size_t i = 0; i < TL_SEGMENT_POINTS; i++) {
            const size_t point = tl_segment_point_row(row, i);
            for (int side = 0; side < 2; side++) {
                const tl_segment_side *to = side ? &of->b : &of->a;
                for (int c = 0; c < 3 && !tl_side_is_rigid(to); c++)
                    m->zones->points.holds[to->at[c]] +=
                        2 * k * s->points.area[point] * fabs((side ? s->points.at_b : s->points.at_a)[c][point]);
            }
        }
    }
}

void tl_segments_hold(const tl_model *m, uint32_t body, tl_holding *sum)
{
    const struct tl_segments *s = m->segments;
    if (body >= s->bodies_listed)
        return;
    for (uint32_t k = s->body_start[body]; k < s->body_start[body + 1]; k++) {
        const tl_segment *of = &s->table.of[s->body_use[k].segment];
        const uint32_t law = of->meet != TL_NO_ROW ? s->meet[of->meet].law : TL_NO_ROW;
        if (law == TL_NO_ROW)
            continue;
        const double stiff = tl_law_stiffness(&m->joint_laws[law]);
        sum->law = fmax(sum->law, stiff);
        sum->presses = true;
        for (size_t i = 0; i < TL_SEGMENT_POINTS; i++) {
            const uint32_t row = s->body_use[k].segment;
            const size_t point = tl_segment_point_row(row, i);
            double *const *at = s->body_use[k].side ? s->points.at_b : s->points.at_a;
            sum->stiffness.sum += stiff * s->points.area[point];
            sum->stiffness.r2 += stiff * s->points.area[point] * tl_v3_norm2(tl_columns_get(at, point));
        }
    }
}

tl_energies tl_segments_energies(tl_model *m)
{
    struct tl_segments *s = m->segments;
    tl_energies sum = {.heat = s ? s->lost : 0};
    if (s) {
        sum.stored -= s->blend_stored;
        sum.heat -= s->blend_heat;
    }
    for (size_t row = 0; s && row < s->table.table.rows; row++)
        if (s->table.of[row].meet != TL_NO_ROW) {
            sum.stored += s->table.stored[row];
            sum.heat += s->table.heat[row];
        }
    if (s)
        s->lost = 0;
    return sum;
}
