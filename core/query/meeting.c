/* meeting.c - see meeting.h. */
#include "query/meeting.h"

#include "base/columns.h"
#include "base/table.h"
#include "contact/detection.h"
#include "contact/index.h"
#include "contact/sides.h"
#include "segment/lay.h"

#include <math.h>

bool tl_row_is_meeting(const tl_model *m, uint32_t row)
{
    return row != TL_NO_ROW && row >= m->detect->contacts.table.rows;
}

/* The number of its first meet. */
static size_t first_of(const tl_model *m, uint32_t row)
{
    return row - m->detect->contacts.table.rows;
}

/* Behind the last meet of the two blocks of one. */
static size_t end_of(const struct tl_segments *s, size_t first)
{
    size_t end = first;
    while (end < s->meet_count && s->meet[end].a == s->meet[first].a && s->meet[end].b == s->meet[first].b)
        end++;
    return end;
}

/* Whether two blocks are told of by these meets: both are there, some area is, and no field contact takes part. */
static bool is_told(const tl_model *m, size_t first)
{
    const struct tl_segments *s = m->segments;
    const tl_meet *meet = &s->meet[first];
    double area = 0;
    for (size_t k = first; k < end_of(s, first); k++)
        area += s->meet[k].area;
    if (!(area > 0) || tl_block_row_quiet(m, meet->a) == TL_NO_ROW || tl_block_row_quiet(m, meet->b) == TL_NO_ROW)
        return false;
    const uint32_t contact = tl_contact_row(m, meet->a, meet->b);
    return contact == TL_NO_ROW || meet->alone || m->detect->contacts.point_count[contact] == 0;
}

uint32_t tl_meeting_next(const tl_model *m, uint32_t row)
{
    const struct tl_segments *s = m->segments;
    size_t first = s && row != TL_NO_ROW ? end_of(s, first_of(m, row)) : 0;
    while (s && first < s->meet_count && !is_told(m, first))
        first = end_of(s, first);
    return s && first < s->meet_count ? (uint32_t)(m->detect->contacts.table.rows + first) : TL_NO_ROW;
}

uint32_t tl_meeting_row(const tl_model *m, tl_id a, tl_id b)
{
    const struct tl_segments *s = m->segments;
    const uint64_t pair = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    size_t low = 0, high = s ? s->meet_count : 0;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (((uint64_t)s->meet[middle].a << 32 | s->meet[middle].b) < pair)
            low = middle + 1;
        else
            high = middle;
    }
    const bool found = s && low < s->meet_count && ((uint64_t)s->meet[low].a << 32 | s->meet[low].b) == pair;
    return found && is_told(m, low) ? (uint32_t)(m->detect->contacts.table.rows + low) : TL_NO_ROW;
}

/* ---------------------------------------------------------------- sums ------------------- */

/* How far a point of a side has moved since displacements of its block began to count, m; x is where it is, from the
 * model's origin. Gridpoints know that since they were made. What the block's frame had done before, and what of it
 * does not count, is that of a rigid body: strains at the last reset are left out. */
static tl_vec3 moved_of(const tl_model *m, const tl_segment_side *side, tl_id block, tl_vec3 at, tl_vec3 x)
{
    const uint32_t row = tl_block_row_quiet(m, block);
    if (tl_side_is_rigid(side))
        return tl_block_point_displacement(m, row, at);
    const tl_body_mesh *mesh = &m->zones->mesh[m->zones->points.mesh[side->at[0]]];
    const tl_base made = {mesh->made_u, mesh->made_q};
    const tl_vec3 local = tl_side_local(m, mesh->row, x);
    const double w[3] = {at.x, at.y, at.z};
    tl_vec3 sum = tl_v3_sub(tl_block_point_displacement(m, row, local), tl_block_point_moved(m, row, &made, local));
    for (int k = 0; k < 3; k++)
        sum = tl_v3_madd(sum, w[k], tl_columns_get(m->zones->points.u, side->at[k]));
    return sum;
}

/* What a segment does to its side B, N. */
static tl_vec3 force_of(const struct tl_segments *s, size_t row)
{
    const tl_segment_push *push = &s->table.push[row];
    tl_vec3 sum = {0, 0, 0};
    for (int corner = 0; corner < (tl_side_is_rigid(&s->table.of[row].b) ? 1 : 3); corner++)
        sum = tl_v3_add(sum, tl_v3(push->of[1][corner][0], push->of[1][corner][1], push->of[1][corner][2]));
    return sum;
}

/* Adds a segment; place and way are divided by the area at the end. */
static void add_segment(const tl_model *m, const tl_meet *meet, size_t row, tl_meeting *sum)
{
    const struct tl_segments *s = m->segments;
    const tl_segment_points *p = &s->points;
    const tl_segment *of = &s->table.of[row];
    const tl_vec3 n = tl_columns_get(s->table.normal, row), force = force_of(s, row);
    const double press = tl_v3_dot(force, n);
    sum->pressing += press;
    sum->shear = tl_v3_add(sum->shear, tl_v3_madd(force, -press, n));
    sum->area += s->table.area[row];
    sum->normal = tl_v3_madd(sum->normal, s->table.area[row], n);
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
        const size_t point = tl_segment_point_row(row, k);
        const tl_vec3 at_a = tl_columns_get(p->at_a, point), at_b = tl_columns_get(p->at_b, point);
        const tl_vec3 a = tl_segment_place(m, &of->a, at_a), b = tl_segment_place(m, &of->b, at_b);
        const double area = p->area[point];
        sum->gap = fmin(sum->gap, tl_v3_dot(n, tl_v3_sub(b, a)));
        sum->point = tl_v3_madd(sum->point, 0.5 * area, tl_v3_add(a, b));
        const tl_vec3 moved_a = moved_of(m, &of->a, meet->a, at_a, a), moved_b = moved_of(m, &of->b, meet->b, at_b, b);
        sum->passed = tl_v3_madd(sum->passed, area, tl_v3_sub(moved_b, moved_a));
        sum->initial += p->f_n0 ? p->f_n0[point] : 0;
        sum->any |= p->flags[point];
        sum->all &= p->flags[point];
    }
}

tl_meeting tl_meeting_named(const tl_model *m, uint32_t row)
{
    const struct tl_segments *s = m->segments;
    const size_t first = first_of(m, row), end = end_of(s, first);
    tl_meeting out = {.a = s->meet[first].a,
                      .b = s->meet[first].b,
                      .law = TL_NO_ROW,
                      .born = s->meet[first].born,
                      .gap = INFINITY,
                      .all = ~0u};
    double most = 0;
    for (size_t k = first; k < end; k++)
        if (s->meet[k].area > most) {
            most = s->meet[k].area;
            out.tag = s->meet[k].tag;
            out.law = s->meet[k].law;
        }
    return out;
}

tl_meeting tl_meeting_of(const tl_model *m, uint32_t row)
{
    const struct tl_segments *s = m->segments;
    const size_t first = first_of(m, row), end = end_of(s, first);
    tl_meeting sum = tl_meeting_named(m, row);
    for (size_t k = first; k < end; k++)
        for (size_t at = s->meet[k].begin; at < s->meet[k].end; at++)
            if (s->table.of[at].meet == k)
                add_segment(m, &s->meet[k], at, &sum);
    sum.normal = tl_v3_unit(sum.normal);
    sum.point = tl_v3_scale(1 / sum.area, sum.point);
    sum.passed = tl_v3_scale(1 / sum.area, sum.passed);
    return sum;
}

void tl_meeting_mark(const tl_model *m, uint32_t row, const size_t *first, unsigned char *marks)
{
    const struct tl_segments *s = m->segments;
    for (size_t k = first_of(m, row), end = end_of(s, k); k < end; k++) {
        const tl_meet *meet = &s->meet[k];
        if (!(meet->area > 0))
            continue;
        marks[first[tl_block_row_quiet(m, meet->a)] + meet->face_a] = 1;
        marks[first[tl_block_row_quiet(m, meet->b)] + meet->face_b] = 1;
    }
}

void tl_meeting_state(const tl_model *m, uint32_t row, uint32_t column, size_t width, bool adds, double value[3])
{
    const struct tl_segments *s = m->segments;
    const tl_segment_points *p = &s->points;
    const size_t first = first_of(m, row), end = end_of(s, first);
    double weights = 0, sum[3] = {0, 0, 0};
    for (size_t k = first; k < end; k++)
        for (size_t at = s->meet[k].begin; at < s->meet[k].end; at++)
            for (size_t i = 0; s->table.of[at].meet == k && i < TL_SEGMENT_POINTS; i++) {
                const size_t point = tl_segment_point_row(at, i);
                const double weight = adds ? 1 : p->area[point];
                weights += weight;
                for (size_t w = 0; w < width && column + w < p->state_columns; w++)
                    sum[w] += weight * p->state[column + w][point];
            }
    for (size_t w = 0; w < width; w++)
        value[w] = adds ? sum[w] : weights > 0 ? sum[w] / weights : 0;
}

/* ---------------------------------------------------------------- points ----------------- */

size_t tl_meeting_point_count(const tl_model *m, uint32_t row)
{
    const struct tl_segments *s = m->segments;
    const size_t first = first_of(m, row), end = end_of(s, first);
    size_t count = 0;
    for (size_t k = first; k < end; k++)
        for (size_t at = s->meet[k].begin; at < s->meet[k].end; at++)
            count += s->table.of[at].meet == k ? TL_SEGMENT_POINTS : 0;
    return count;
}

/* The segment that has a point, and its number there. */
static size_t segment_of(const tl_model *m, uint32_t row, size_t *k)
{
    const struct tl_segments *s = m->segments;
    size_t number = first_of(m, row), at = s->meet[number].begin;
    for (;; at++) {
        while (at >= s->meet[number].end)
            at = s->meet[++number].begin;
        if (s->table.of[at].meet != number)
            continue;
        if (*k < TL_SEGMENT_POINTS)
            return at;
        *k -= TL_SEGMENT_POINTS;
    }
}

size_t tl_meeting_point(const tl_model *m, uint32_t row, size_t k, tl_vec3 *place, double *gap)
{
    const struct tl_segments *s = m->segments;
    const size_t at = segment_of(m, row, &k), point = tl_segment_point_row(at, k);
    const tl_segment *of = &s->table.of[at];
    const tl_vec3 a = tl_segment_place(m, &of->a, tl_columns_get(s->points.at_a, point));
    const tl_vec3 b = tl_segment_place(m, &of->b, tl_columns_get(s->points.at_b, point));
    *place = tl_v3_scale(0.5, tl_v3_add(a, b));
    *gap = tl_v3_dot(tl_columns_get(s->table.normal, at), tl_v3_sub(b, a));
    return point;
}

/* ---------------------------------------------------------------- outlines --------------- */

/* Directions of the three points from the centroid, times sqrt(2): as in narrow/overlay.c. */
static const double around[TL_SEGMENT_POINTS][2] = {{1.4142135623730950488, 0},
                                                    {-0.70710678118654752440, 1.2247448713915890491},
                                                    {-0.70710678118654752440, -1.2247448713915890491}};

/* The outline is in y, x = c + L y, and point k is at c + L around[k]. So x is the sum of (1 + y . around[k]) / 3 of
 * the points. */
static tl_vec3 corner_of(const tl_vec3 points[TL_SEGMENT_POINTS], tl_point2 y)
{
    tl_vec3 x = {0, 0, 0};
    for (int k = 0; k < TL_SEGMENT_POINTS; k++)
        x = tl_v3_madd(x, (1 + y.x * around[k][0] + y.y * around[k][1]) / 3, points[k]);
    return x;
}

static bool add_outline(const tl_model *m, size_t row, tl_surface *to)
{
    const struct tl_segments *s = m->segments;
    const tl_segment *of = &s->table.of[row];
    const uint32_t corners = s->table.corners[row];
    if (corners < 3)
        return true;
    if (!tl_grow(&to->corner, &to->corner_capacity, to->corners + corners, sizeof *to->corner) ||
        !tl_grow(&to->size, &to->polygon_capacity, to->polygons + 1, sizeof *to->size))
        return false;
    tl_vec3 points[TL_SEGMENT_POINTS];
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
        const size_t point = tl_segment_point_row(row, k);
        const tl_vec3 a = tl_segment_place(m, &of->a, tl_columns_get(s->points.at_a, point));
        points[k] = tl_v3_scale(0.5, tl_v3_add(a, tl_segment_place(m, &of->b, tl_columns_get(s->points.at_b, point))));
    }
    for (uint32_t k = 0; k < corners; k++)
        to->corner[to->corners++] = corner_of(points, s->outline[s->table.outline[row] + k]);
    to->size[to->polygons++] = corners;
    return true;
}

bool tl_meeting_outlines(const tl_model *m, uint32_t row, tl_surface *surface)
{
    const struct tl_segments *s = m->segments;
    const size_t first = first_of(m, row), end = end_of(s, first);
    bool enough = true;
    for (size_t k = first; k < end; k++)
        for (size_t at = s->meet[k].begin; at < s->meet[k].end && enough; at++)
            if (s->table.of[at].meet == k)
                enough = add_outline(m, at, surface);
    return enough;
}
