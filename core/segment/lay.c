/* lay.c - segments laid into their tables, with what points take over.
 *
 * Segments come by the laws of their meets, and of one law by meets and triangles. A meet that is not stale keeps its
 * segments, whatever rows they get. Stale meets mostly have segments of the same triangles as before. Then these
 * stay in their rows, and nothing else is touched. */
#include "segment/lay.h"

#include "base/columns.h"
#include "contact/contacts.h"
#include "contact/law_states.h"
#include "model/joints.h"
#include "model/scope.h"
#include "segment/follow.h"
#include "segment/moved.h"
#include "segment/uses.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- tables ----------------- */

static void add_columns(struct tl_segments *s, uint32_t states)
{
    tl_segment_table *t = &s->table;
    tl_table_init(&t->table, t);
    TL_COLUMN(&t->table, t, of, 0);
    TL_COLUMN(&t->table, t, area, TL_COLUMN_STATE);
    TL_COLUMN(&t->table, t, outline, 0);
    TL_COLUMN(&t->table, t, corners, 0);
    for (int k = 0; k < 3; k++)
        TL_COLUMN(&t->table, t, normal[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
    for (int side = 0; side < 2; side++)
        for (int c = 0; c < 3; c++)
            TL_COLUMN(&t->table, t, corner[side][c], 0);
    TL_COLUMN(&t->table, t, share, 0);
    TL_COLUMN(&t->table, t, push, 0);
    TL_COLUMN(&t->table, t, bears, 0);
    TL_COLUMN(&t->table, t, stored, 0);
    TL_COLUMN(&t->table, t, heat, 0);
    TL_COLUMN(&t->table, t, slid, 0);

    tl_segment_points *p = &s->points;
    tl_table_init(&p->table, p);
    for (int k = 0; k < 3; k++) {
        TL_COLUMN(&p->table, p, at_a[k], TL_COLUMN_STATE);
        TL_COLUMN(&p->table, p, at_b[k], TL_COLUMN_STATE);
        TL_COLUMN(&p->table, p, f_s[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
    }
    TL_COLUMN(&p->table, p, area, TL_COLUMN_STATE);
    TL_COLUMN(&p->table, p, f_n, TL_COLUMN_STATE | TL_COLUMN_STEP);
    TL_COLUMN(&p->table, p, flags, TL_COLUMN_STATE | TL_COLUMN_STEP);
    for (uint32_t k = 0; k < states; k++)
        TL_COLUMN(&p->table, p, state[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
    p->state_columns = states;
}

bool tl_segments_begin(tl_model *m)
{
    m->segments = calloc(1, sizeof *m->segments);
    if (!m->segments)
        return false;
    m->segments_destroy = tl_segments_free;
    m->segments_follow = tl_segments_follow;
    add_columns(m->segments, 0);
    return true;
}

void tl_segments_free(struct tl_segments *s)
{
    tl_table_free(&s->table.table);
    tl_table_free(&s->points.table);
    tl_table_free(&s->spare.table);
    tl_table_free(&s->spare_points.table);
    void *const owned[] = {s->meet,       s->span,   s->use,         s->body_use,      s->use_start,
                           s->body_start, s->corner, s->room_memory, s->blend,         s->outline,
                           s->touched,    s->now,    s->box,         s->spare_outline, s->damping};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    free(s);
}

/* ---------------------------------------------------------------- meets ------------------ */

void tl_laying_begin(tl_laying *l)
{
    *l = (tl_laying){.list = NULL};
}

bool tl_laying_add(tl_laying *l, const tl_new_segment *segment)
{
    const size_t corners = segment->over.corners;
    if (!tl_grow(&l->list, &l->capacity, l->count + 1, sizeof *l->list) ||
        !tl_grow(&l->outline, &l->outline_capacity, l->outline_count + corners, sizeof *l->outline))
        return false;
    tl_new_segment *to = &l->list[l->count++];
    *to = *segment;
    to->outline = l->outline_count;
    for (size_t k = 0; k < corners; k++)
        l->outline[l->outline_count++] = segment->over.outline[k];
    return true;
}

void tl_laying_end(tl_laying *l)
{
    free(l->list);
    free(l->outline);
    free(l->now);
}

static int order_of(const tl_meet *a, const tl_meet *b)
{
    const uint64_t x[4] = {a->a, a->b, a->face_a, a->face_b}, y[4] = {b->a, b->b, b->face_a, b->face_b};
    for (int k = 0; k < 4; k++)
        if (x[k] != y[k])
            return x[k] < y[k] ? -1 : 1;
    return 0;
}

/* Twice the energy of the shear springs of a segment, times ks. */
static double shear_energy(const tl_segment_points *p, size_t segment)
{
    double sum = 0;
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
        const size_t row = tl_segment_point_row(segment, k);
        double f2 = 0;
        for (int c = 0; c < 3; c++)
            f2 += p->f_s[c][row] * p->f_s[c][row];
        sum += p->area[row] > 0 ? f2 / p->area[row] : 0;
    }
    return sum;
}

/* What the springs of shear of a meet hold that goes, J: heat, as of contacts that end. */
static double shear_of(const tl_model *m, const struct tl_segments *s, const tl_meet *meet)
{
    const double ks = meet->law < m->joint_law_count ? m->joint_laws[meet->law].ks : 0;
    double sum = 0;
    for (uint32_t row = meet->begin; row < meet->end; row++)
        sum += s->table.of[row].meet != TL_NO_ROW ? shear_energy(&s->points, row) : 0;
    return ks > 0 ? 0.5 * meet->counts * sum / ks : 0;
}

bool tl_laying_change_meets(const tl_model *m, tl_laying *l, tl_meet *list, size_t count)
{
    struct tl_segments *s = m->segments;
    l->now = malloc((s->meet_count + 1) * sizeof *l->now);
    if (!l->now) {
        free(list);
        return false;
    }
    size_t at = 0;
    l->other_meets = count != s->meet_count;
    for (size_t k = 0; k < s->meet_count; k++) {
        while (at < count && order_of(&list[at], &s->meet[k]) < 0)
            at++;
        const bool same = at < count && order_of(&list[at], &s->meet[k]) == 0;
        l->now[k] = same ? (uint32_t)at : TL_NO_ROW;
        l->other_meets = l->other_meets || !same;
        if (!same)
            s->lost += shear_of(m, s, &s->meet[k]);
        if (same) {
            const double size = list[at].size;
            const bool tilted = list[at].tilted, stale = s->meet[k].area == 0; /* its faces may overlap by now */
            list[at] = s->meet[k];
            list[at].tilted = tilted;
            list[at].size = size;
            list[at].stale = list[at].stale || stale;
        }
    }
    free(s->meet);
    s->meet = list;
    s->meet_count = s->meet_capacity = count;
    return true;
}

/* ---------------------------------------------------------------- places ----------------- */

tl_vec3 tl_segment_place(const tl_model *m, const tl_segment_side *side, tl_vec3 at)
{
    if (tl_side_is_rigid(side))
        return tl_body_point(&m->bodies, side->at[0], at);
    const tl_gridpoints *g = &m->zones->points;
    const double w[3] = {at.x, at.y, at.z};
    tl_vec3 sum = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        sum = tl_v3_madd(sum, w[k], tl_gridpoint_place(g, side->at[k]));
    return sum;
}

/* What keeps to the material of a side at a place: weights, or the place in the body's frame. */
static tl_vec3 keep_to(const tl_model *m, const tl_segment_side *side, tl_vec3 place)
{
    if (tl_side_is_rigid(side))
        return tl_body_local(&m->bodies, side->at[0], place);
    const tl_gridpoints *g = &m->zones->points;
    const tl_vec3 x = tl_gridpoint_place(g, side->at[0]);
    const tl_vec3 a = tl_v3_sub(tl_gridpoint_place(g, side->at[1]), x),
                  b = tl_v3_sub(tl_gridpoint_place(g, side->at[2]), x);
    const tl_vec3 d = tl_v3_sub(place, x), n = tl_v3_cross(a, b);
    const double n2 = tl_v3_norm2(n);
    const double wb = tl_v3_dot(tl_v3_cross(d, b), n) / n2, wc = tl_v3_dot(tl_v3_cross(a, d), n) / n2;
    return tl_v3(1 - wb - wc, wb, wc);
}

/* ---------------------------------------------------------------- what is taken over ----- */

/* A segment to be laid: an old row, or a new one of the list. */
typedef struct entry {
    uint32_t law, meet;
    uint32_t old; /* row; TL_NO_ROW: it is new */
    uint32_t fresh;
} entry;

static void copy_point(tl_segment_points *to, size_t at, const tl_segment_points *from, size_t row, double scale)
{
    for (int c = 0; c < 3; c++)
        to->f_s[c][at] = scale * from->f_s[c][row];
    to->f_n[at] = scale * from->f_n[row];
    to->flags[at] = from->flags[row];
    for (uint32_t k = 0; k < from->state_columns && k < to->state_columns; k++)
        to->state[k][at] = from->state[k][row];
    if (to->f_n0 && from->f_n0) {
        to->f_n0[at] = scale * from->f_n0[row];
        to->reference[at] = from->reference[row];
    }
}

/* A point that takes over from none: a law's states begin. Walls that are apart were never bonded. */
static void begin_point(tl_segment_points *p, size_t at, const tl_kind *law, bool apart)
{
    for (int c = 0; c < 3; c++)
        p->f_s[c][at] = 0;
    p->f_n[at] = 0;
    p->flags[at] = apart ? TL_POINT_APART : 0;
    for (uint32_t k = 0; k < p->state_columns; k++)
        p->state[k][at] = 0;
    for (tl_state_columns s = {0}; tl_state_next(law, p->state_columns, &s);)
        if (s.count == 1)
            p->state[s.begin][at] = s.state->initial;
}

/* The row of the old segment of a meet that has the same triangles, or TL_NO_ROW. */
static uint32_t same_segment(const struct tl_segments *s, const tl_meet *meet, const uint32_t key[2])
{
    uint32_t found = TL_NO_ROW;
    for (uint32_t low = meet->begin, high = meet->end; low < high && found == TL_NO_ROW;) {
        const uint32_t middle = low + (high - low) / 2;
        const uint32_t *at = s->table.of[middle].key;
        const int order = at[0] != key[0] ? (at[0] < key[0] ? -1 : 1) : (at[1] > key[1]) - (at[1] < key[1]);
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
        if (order == 0)
            found = middle;
    }
    return found == TL_NO_ROW || s->table.of[found].meet == TL_NO_ROW ? TL_NO_ROW : found;
}

/* The row of the old point of the meet that is nearest to a place, or TL_NO_ROW. */
static size_t nearest_point(const tl_model *m, const tl_meet *meet, tl_vec3 place)
{
    const struct tl_segments *s = m->segments;
    const tl_segment_points *p = &s->points;
    size_t found = TL_NO_ROW;
    double least = INFINITY;
    for (uint32_t i = meet->begin; i < meet->end; i++)
        for (size_t k = 0; k < TL_SEGMENT_POINTS && s->table.of[i].meet != TL_NO_ROW; k++) {
            const size_t row = tl_segment_point_row(i, k);
            const tl_vec3 at = tl_v3(p->at_a[0][row], p->at_a[1][row], p->at_a[2][row]);
            const double d2 = tl_v3_norm2(tl_v3_sub(place, tl_segment_place(m, &s->table.of[i].a, at)));
            if (d2 < least) {
                least = d2;
                found = row;
            }
        }
    return found;
}

/* The row of the segment that has a point. */
static size_t segment_of(size_t point)
{
    return point / (TL_SEGMENT_POINTS * TL_LANES) * TL_LANES + point % TL_LANES;
}

/* Turns the shear of a point into the plane of its segment from that of the segment that it was of. */
static void turn_point(tl_segment_points *p, size_t at, const tl_segment_table *of, size_t from, tl_vec3 to)
{
    const tl_vec3 was = tl_columns_get(of->normal, segment_of(from)), f = tl_columns_get(p->f_s, at);
    const double c = 1 + tl_v3_dot(was, to);
    const double off = tl_v3_dot(f, to) / (c > 0 ? c : 1);
    tl_columns_put(p->f_s, at, tl_v3_madd(f, -off, tl_v3_add(was, to)));
}

/* Where a law acts: the kind of that of a row of the model, or NULL. */
static const tl_kind *kind_of(const tl_model *m, uint32_t law)
{
    return law != TL_NO_ROW ? m->joint_laws[law].kind : NULL;
}

/* The shear of the last motion goes by the place half-way: half by the old point, and half by the new one, at a and b,
 * of which the law is going to be told. By how much the former has moved farther than the latter, over two. */
static tl_vec3 late_by(const tl_model *m, const tl_new_segment *made, size_t old, tl_vec3 a, tl_vec3 b)
{
    const struct tl_segments *s = m->segments;
    const double share = s->meet[made->meet].share;
    const tl_segment now = {made->meet, made->a, made->b, {0, 0}, made->normal_a, made->normal_b};
    const tl_vec3 old_a = tl_columns_get(s->points.at_a, old), old_b = tl_columns_get(s->points.at_b, old);
    const tl_vec3 was = tl_segment_moved(m, &s->table.of[segment_of(old)], share, made->over.n, old_a, old_b);
    return tl_v3_scale(0.5, tl_v3_sub(was, tl_segment_moved(m, &now, share, made->over.n, a, b)));
}

/* Points of a segment that has been found, in row `row` of a table. `same`: the old row of these triangles, or
 * TL_NO_ROW; it may be that very row. */
static void lay_points(const tl_model *m, tl_segment_points *p, size_t row, tl_new_segment *made, uint32_t same)
{
    const tl_meet *meet = &m->segments->meet[made->meet];
    const tl_segment_points *old = &m->segments->points;
    made->row = row;
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
        const size_t point = tl_segment_point_row(row, k);
        const size_t from =
            same != TL_NO_ROW ? tl_segment_point_row(same, k) : nearest_point(m, meet, made->over.on_a[k]);
        const double size = from != TL_NO_ROW ? old->area[from] : 0;
        const tl_vec3 a = keep_to(m, &made->a, made->over.on_a[k]), b = keep_to(m, &made->b, made->over.on_b[k]);
        const double gap = tl_v3_dot(tl_v3_sub(made->over.on_b[k], made->over.on_a[k]), made->over.n);
        made->late[k] = size > 0 ? late_by(m, made, from, a, b) : tl_v3(0, 0, 0);
        tl_columns_put(p->at_a, point, a);
        tl_columns_put(p->at_b, point, b);
        p->area[point] = made->over.area / TL_SEGMENT_POINTS;
        if (size > 0) {
            copy_point(p, point, old, from, p->area[point] / size);
            turn_point(p, point, &m->segments->table, from, made->over.n);
        } else
            begin_point(p, point, kind_of(m, meet->law), gap > TL_CONTACT_TOLERANCE * sqrt(made->over.area));
    }
}

/* Sides, area and normal of a segment that has been found, in row `row` of a table. */
static void lay_sides(tl_segment_table *to, size_t row, const tl_new_segment *made)
{
    to->of[row] =
        (tl_segment){made->meet, made->a, made->b, {made->key[0], made->key[1]}, made->normal_a, made->normal_b};
    to->area[row] = made->over.area;
    to->normal[0][row] = made->over.n.x;
    to->normal[1][row] = made->over.n.y;
    to->normal[2][row] = made->over.n.z;
}

/* ---------------------------------------------------------------- laying ----------------- */

/* What rows of segments hold of the energy of shear springs, times 2 ks. */
static double energy_of_rows(const struct tl_segments *s, uint32_t begin, uint32_t end)
{
    double sum = 0;
    for (uint32_t row = begin; row < end; row++)
        sum += s->table.of[row].meet != TL_NO_ROW ? shear_energy(&s->points, row) : 0;
    return sum;
}

/* Lets the springs of shear of a meet, whose rows are given, hold no more than `before`. Gives what they hold less. */
static double keep_energy(const tl_model *m, struct tl_segments *to, const tl_meet *meet, double before, uint32_t begin,
                          uint32_t end)
{
    const double now = energy_of_rows(to, begin, end), ks = meet->law != TL_NO_ROW ? m->joint_laws[meet->law].ks : 0;
    const double scale = now > before ? sqrt(before / now) : 1;
    for (uint32_t row = begin; row < end && now > before; row++)
        for (size_t k = 0; k < TL_SEGMENT_POINTS; k++)
            for (int c = 0; c < 3; c++)
                to->points.f_s[c][tl_segment_point_row(row, k)] *= scale;
    return ks > 0 && before > now ? 0.5 * meet->counts * (before - now) / ks : 0;
}

/* And those of all stale meets, which fresh tables have. The old ones are still there. */
static double keep_energies(const tl_model *m, struct tl_segments *to)
{
    const struct tl_segments *s = m->segments;
    double lost = 0;
    uint32_t end;
    for (uint32_t row = 0; row < to->table.table.rows; row = end) {
        const uint32_t number = to->table.of[row].meet;
        for (end = row + 1; end < to->table.table.rows && to->table.of[end].meet == number;)
            end++;
        if (number == TL_NO_ROW || !s->meet[number].stale)
            continue;
        const tl_meet *meet = &s->meet[number];
        lost += keep_energy(m, to, meet, energy_of_rows(s, meet->begin, meet->end), row, end);
    }
    return lost;
}

/* The springs of new segments take what their walls had gone farther. It does work, so what they hold may grow. */
static void add_late(const tl_model *m, struct tl_segments *to, const tl_laying *l)
{
    for (size_t i = 0; i < l->count; i++) {
        const tl_new_segment *made = &l->list[i];
        const uint32_t law = m->segments->meet[made->meet].law;
        const double ks = law != TL_NO_ROW ? m->joint_laws[law].ks : 0;
        for (size_t k = 0; k < TL_SEGMENT_POINTS && ks > 0; k++) {
            const size_t point = tl_segment_point_row(made->row, k);
            const tl_vec3 f = tl_columns_get(to->points.f_s, point);
            tl_columns_put(to->points.f_s, point, tl_v3_madd(f, -ks * to->points.area[point], made->late[k]));
        }
    }
}

/* Whether a stale meet has lost all of its segments: no fresh row tells of it. */
static bool has_none(const tl_laying *l, size_t first, uint32_t meet)
{
    return first >= l->count || l->list[first].meet != meet;
}

/* Lists the segments to be laid, by laws, meets and triangles. There is room. `lost`: adds what springs of shear held
 * of stale meets that have none any more, J. */
static size_t list_entries(const tl_model *m, const tl_laying *l, entry *list, double *lost)
{
    const struct tl_segments *s = m->segments;
    size_t count = 0;
    for (uint32_t i = 0; i <= m->joint_law_count; i++) {
        const uint32_t law = i < m->joint_law_count ? i : TL_NO_ROW;
        size_t fresh = 0;
        for (uint32_t k = 0; k < s->meet_count; k++) {
            const tl_meet *meet = &s->meet[k];
            while (fresh < l->count && l->list[fresh].meet < k)
                fresh++;
            if (meet->law != law)
                continue;
            if (meet->stale && has_none(l, fresh, k))
                *lost += shear_of(m, s, meet);
            for (uint32_t row = meet->begin; row < meet->end && !meet->stale; row++)
                if (s->table.of[row].meet != TL_NO_ROW)
                    list[count++] = (entry){law, k, row, TL_NO_ROW};
            for (; fresh < l->count && l->list[fresh].meet == k; fresh++)
                list[count++] = (entry){law, k, TL_NO_ROW, (uint32_t)fresh};
        }
    }
    return count;
}

/* Corners that the list of outlines has room for, of each segment: of two triangles as many as they may have. */
#define OUTLINE_ROOM 6

/* Copies the outline of a segment to the end of the list, where there is room. */
static void put_outline(struct tl_segments *to, size_t row, const tl_point2 *outline, size_t corners)
{
    to->table.outline[row] = (uint32_t)to->outline_count;
    to->table.corners[row] = (uint32_t)corners;
    for (size_t k = 0; k < corners || k < OUTLINE_ROOM; k++)
        to->outline[to->outline_count++] = k < corners ? outline[k] : (tl_point2){0, 0};
}

/* Corners that the outline of a segment may have where it is: up to that of the next segment. */
static size_t outline_room(const struct tl_segments *s, size_t row)
{
    size_t next = row + 1;
    while (next < s->table.table.rows && s->table.of[next].meet == TL_NO_ROW)
        next++;
    const size_t end = next < s->table.table.rows ? s->table.outline[next] : s->outline_count;
    return end > s->table.outline[row] ? end - s->table.outline[row] : 0;
}

static void lay_entry(const tl_model *m, tl_laying *l, struct tl_segments *to, size_t row, const entry *e)
{
    const struct tl_segments *s = m->segments;
    if (e->old == TL_NO_ROW) {
        tl_new_segment *made = &l->list[e->fresh];
        lay_sides(&to->table, row, made);
        put_outline(to, row, l->outline + made->outline, made->over.corners);
        lay_points(m, &to->points, row, made, same_segment(s, &s->meet[made->meet], made->key));
        return;
    }
    to->table.of[row] = s->table.of[e->old];
    to->table.of[row].meet = e->meet;
    to->table.area[row] = s->table.area[e->old];
    put_outline(to, row, s->outline + s->table.outline[e->old], s->table.corners[e->old]);
    for (int c = 0; c < 3; c++)
        to->table.normal[c][row] = s->table.normal[c][e->old];
    for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
        const size_t at = tl_segment_point_row(row, k), from = tl_segment_point_row(e->old, k);
        for (int c = 0; c < 3; c++) {
            to->points.at_a[c][at] = s->points.at_a[c][from];
            to->points.at_b[c][at] = s->points.at_b[c][from];
        }
        to->points.area[at] = s->points.area[from];
        copy_point(&to->points, at, &s->points, from, 1);
    }
}

/* Rows of all segments, each law from a new group on. */
static size_t rows_of(const entry *list, size_t count)
{
    size_t rows = 0;
    for (size_t k = 0; k < count; k++) {
        if (k > 0 && list[k].law != list[k - 1].law)
            rows = (rows + TL_LANES - 1) / TL_LANES * TL_LANES;
        rows++;
    }
    return (rows + TL_LANES - 1) / TL_LANES * TL_LANES;
}

/* Columns of states that the laws need. */
static uint32_t states_of(const tl_model *m)
{
    uint32_t most = 0;
    for (size_t k = 0; k < m->joint_law_count; k++)
        most = m->joint_laws[k].columns > most ? m->joint_laws[k].columns : most;
    return most;
}

static void fill_tables(const tl_model *m, tl_laying *l, struct tl_segments *to, const entry *list, size_t count)
{
    size_t row = 0;
    for (size_t k = 0; k < to->table.table.rows; k++)
        to->table.of[k].meet = TL_NO_ROW;
    to->span_count = 0;
    for (size_t k = 0; k < count; k++, row++) {
        if (k == 0 || list[k].law != list[k - 1].law) {
            row = (row + TL_LANES - 1) / TL_LANES * TL_LANES;
            to->span[to->span_count++] = (tl_segment_span){list[k].law, (uint32_t)(row / TL_LANES), 0};
        }
        lay_entry(m, l, to, row, &list[k]);
        to->span[to->span_count - 1].group_end = (uint32_t)(row / TL_LANES + 1);
    }
}

/* ---------------------------------------------------------------- laying ----------------- */

/* Rows and areas of all meets. The segments of one follow each other. */
static void sum_meets(struct tl_segments *s)
{
    for (size_t k = 0; k < s->meet_count; k++) {
        s->meet[k].area = 0;
        s->meet[k].begin = s->meet[k].end = 0;
    }
    for (uint32_t row = 0; row < s->table.table.rows; row++) {
        if (s->table.of[row].meet == TL_NO_ROW)
            continue;
        tl_meet *meet = &s->meet[s->table.of[row].meet];
        meet->begin = meet->end > 0 ? meet->begin : row;
        meet->end = row + 1;
        meet->area += s->table.area[row];
    }
}

static void move_tables(struct tl_segments *to, const tl_segment_table *table, const tl_segment_points *points)
{
    to->table = *table;
    to->table.table.owner = &to->table;
    to->points = *points;
    to->points.table.owner = &to->points;
}

/* Fresh tables of so many rows, and room for outlines, in the memory of those before the last. false: out of memory. */
static bool make_fresh(struct tl_segments *s, struct tl_segments *fresh, uint32_t states, size_t rows, size_t corners)
{
    const bool fits = s->spare.table.capacity > 0 && s->spare_points.state_columns == states &&
                      !s->spare_points.f_n0 == !s->points.f_n0;
    bool enough = true;
    if (fits) {
        move_tables(fresh, &s->spare, &s->spare_points);
    } else {
        tl_table_free(&s->spare.table);
        tl_table_free(&s->spare_points.table);
        add_columns(fresh, states);
        enough = !s->points.f_n0 || tl_segments_hold_initial(fresh);
    }
    memset(&s->spare, 0, sizeof s->spare);
    memset(&s->spare_points, 0, sizeof s->spare_points);
    fresh->outline = s->spare_outline;
    fresh->outline_capacity = s->spare_outline_capacity;
    s->spare_outline = NULL;
    s->spare_outline_capacity = 0;
    return enough && tl_table_resize(&fresh->table.table, 0) && tl_table_resize(&fresh->points.table, 0) &&
           tl_table_resize(&fresh->table.table, rows) &&
           tl_table_resize(&fresh->points.table, TL_SEGMENT_POINTS * rows) &&
           tl_grow(&fresh->outline, &fresh->outline_capacity, corners, sizeof *fresh->outline);
}

/* Puts fresh tables in the place of those that there are, which become spare ones. */
static void take_fresh(struct tl_segments *s, struct tl_segments *fresh)
{
    s->spare = s->table;
    s->spare.table.owner = &s->spare;
    s->spare_points = s->points;
    s->spare_points.table.owner = &s->spare_points;
    s->spare_outline = s->outline;
    s->spare_outline_capacity = s->outline_capacity;
    move_tables(s, &fresh->table, &fresh->points);
    s->span_count = fresh->span_count;
    s->outline = fresh->outline;
    s->outline_count = fresh->outline_count;
    s->outline_capacity = fresh->outline_capacity;
}

/* Finds the laws of meets. Rows of blocks are searched for where some law names blocks. */
static void find_laws(tl_model *m)
{
    const struct tl_segments *s = m->segments;
    const bool named = tl_laws_name_blocks(m);
    for (size_t k = 0; k < s->meet_count; k++) {
        tl_meet *meet = &s->meet[k];
        meet->law = tl_law_row(m, meet->tag, named ? tl_block_row_quiet(m, meet->a) : TL_NO_ROW,
                               named ? tl_block_row_quiet(m, meet->b) : TL_NO_ROW);
    }
}

bool tl_lay_segments(tl_model *m, tl_laying *l)
{
    struct tl_segments *s = m->segments, fresh = {.span = NULL};
    find_laws(m);
    entry *list = malloc((s->table.table.rows + l->count + 1) * sizeof *list);
    double lost = 0;
    const size_t count = list ? list_entries(m, l, list, &lost) : 0;
    const bool enough = list &&
                        make_fresh(s, &fresh, states_of(m), rows_of(list, count),
                                   s->outline_count + l->outline_count + OUTLINE_ROOM * count + 1) &&
                        tl_grow(&s->span, &s->span_capacity, m->joint_law_count + 1, sizeof *s->span) &&
                        tl_segment_uses_room(m, s, count);
    if (!enough) {
        tl_table_free(&fresh.table.table);
        tl_table_free(&fresh.points.table);
        free(fresh.outline);
    } else {
        fresh.span = s->span;
        fill_tables(m, l, &fresh, list, count);
        s->lost += lost + keep_energies(m, &fresh);
        add_late(m, &fresh, l);
        take_fresh(s, &fresh);
        for (size_t k = 0; k < s->meet_count; k++)
            s->meet[k].stale = false;
        s->version++;
        sum_meets(s);
        tl_segment_uses_list(m, s);
    }
    free(list);
    return enough;
}

/* ---------------------------------------------------------------- in their rows ---------- */

/* Whether the segments that have been found of a meet, from one of the list on, are those that it has. */
static bool meet_fits(const struct tl_segments *s, const tl_laying *l, uint32_t number, size_t fresh)
{
    const tl_meet *meet = &s->meet[number];
    bool fits = true;
    for (uint32_t row = meet->begin; fits && row < meet->end; row++, fresh++) {
        const tl_new_segment *made = &l->list[fresh];
        const uint32_t *key = s->table.of[row].key;
        fits = fresh < l->count && made->meet == number && s->table.of[row].meet == number && key[0] == made->key[0] &&
               key[1] == made->key[1] && made->over.corners <= outline_room(s, row);
    }
    return fits && has_none(l, fresh, number);
}

bool tl_laying_fits(const tl_model *m, const tl_laying *l)
{
    const struct tl_segments *s = m->segments;
    bool fits = !l->other_meets;
    for (size_t k = 0, end; fits && k < l->count; k = end) {
        for (end = k + 1; end < l->count && l->list[end].meet == l->list[k].meet;)
            end++;
        fits = meet_fits(s, l, l->list[k].meet, k);
    }
    size_t fresh = 0;
    for (uint32_t k = 0; fits && k < s->meet_count; k++) {
        while (fresh < l->count && l->list[fresh].meet < k)
            fresh++;
        fits = !s->meet[k].stale || !has_none(l, fresh, k) || s->meet[k].begin == s->meet[k].end;
    }
    return fits;
}

/* Gives a segment its new polygon and points, in its row. */
static void renew_segment(tl_model *m, const tl_laying *l, uint32_t row, tl_new_segment *made)
{
    struct tl_segments *s = m->segments;
    tl_point2 *outline = s->outline + s->table.outline[row];
    lay_points(m, &s->points, row, made, row);
    lay_sides(&s->table, row, made);
    s->table.share[row] = s->meet[made->meet].share;
    s->table.slid[row] = 0;
    s->table.corners[row] = (uint32_t)made->over.corners;
    for (size_t k = 0; k < made->over.corners; k++)
        outline[k] = l->outline[made->outline + k];
}

void tl_renew_segments(tl_model *m, tl_laying *l)
{
    struct tl_segments *s = m->segments;
    size_t fresh = 0;
    double lost = 0;
    for (size_t k = 0; k < s->meet_count; k++) {
        tl_meet *meet = &s->meet[k];
        if (!meet->stale)
            continue;
        const double before = energy_of_rows(s, meet->begin, meet->end);
        meet->area = 0;
        for (uint32_t row = meet->begin; row < meet->end; row++, fresh++) {
            renew_segment(m, l, row, &l->list[fresh]);
            meet->area += s->table.area[row];
        }
        lost += keep_energy(m, s, meet, before, meet->begin, meet->end);
        meet->stale = false;
    }
    add_late(m, s, l);
    s->lost += lost;
    s->version++;
}

bool tl_segments_hold_initial(struct tl_segments *s)
{
    tl_segment_points *p = &s->points;
    return TL_COLUMN_NEED(&p->table, p, reference, TL_COLUMN_STATE) &&
           TL_COLUMN_NEED(&p->table, p, f_n0, TL_COLUMN_STATE);
}

bool tl_segments_hold_states(struct tl_segments *s, uint32_t columns)
{
    tl_segment_points *p = &s->points;
    tl_column more[TL_STATE_COLUMNS];
    uint32_t count = 0;
    for (uint32_t k = p->state_columns; k < columns; k++)
        more[count++] = (tl_column)TL_COLUMN_NEW(p, state[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
    const bool enough = count == 0 || tl_table_widen(&p->table, more, count);
    p->state_columns += enough ? count : 0;
    return enough;
}
