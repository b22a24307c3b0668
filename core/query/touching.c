/* touching.c - the faces of blocks that lie on faces of others.
 *
 * Joints are planes; blocks that settle on them sink in and turn a little, so that an edge bears and faces part. What
 * bounds their motion is the joint all the same. A block may have moved against another by less than TL_TOUCH_KEPT of
 * its size. It then touches it where a face lay on a face when it was made. Else, and where none did, it touches where
 * faces lie on each other now. A corner or an edge on a face bounds no half-space of motion that its neighbours do not.
 *
 * Candidates are pairs whose bounds overlap: those of both places, sorted along the model's longest side. */
#include "query/touching.h"

#include "base/error.h"
#include "base/parallel.h"
#include "geometry/measure.h"
#include "model/body_shape.h"
#include "model/seats.h"
#include "narrow/flush.h"
#include "narrow/manifold.h"
#include "narrow/narrow.h"
#include "narrow/patch.h"
#include "narrow/press.h"
#include "narrow/region.h"
#include "zone/zones.h"

#include <stdlib.h>
#include <string.h>

/* Tolerance: gap up to which blocks touch, and overlap up to which they still do, over the smaller one's size. Angle
 * between faces that lie on each other, as a sine. Test: lua/test_keyblocks. */
#define GAP (TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE)
#define OVERLAP 0.1
#define TILT 0.03
/* Blocks a thread takes at a time. */
#define CHUNK 64

/* Where a block lies: its body's frame. */
typedef struct place {
    tl_mat3 r;
    tl_vec3 x;
} place;

/* What a thread works in, and the touches that it finds. */
typedef struct worker {
    tl_narrow_scratch scratch;
    tl_touches found;
    uint32_t *left; /* rows of blocks that touched another when they were made, and no longer do */
    size_t left_count, left_capacity;
    bool failed; /* out of memory */
} worker;

typedef struct search {
    const tl_model *m;
    double *size;       /* of each body, m */
    place (*places)[2]; /* by row: as the block lay when it was made, as it lies now */
    bool *still;        /* by row: the two are the same */
    tl_bounds *bounds;  /* by row */
    uint32_t *order;    /* rows, by the lower ends of their bounds along `axis` */
    size_t count;
    int axis;
    worker *workers;
} search;

static place place_of(const tl_model *m, uint32_t row, bool now)
{
    const tl_pose *pose = &m->bodies.pose[m->blocks.body[row]];
    if (now)
        return (place){pose->r, tl_v3_add(pose->x_ref, pose->u)};
    const tl_base made = tl_block_made(m, row);
    return (place){tl_q_matrix(made.turn), tl_v3_add(pose->x_ref, made.shift)};
}

/* A point of a block in another block's frame. */
static tl_vec3 point_in(const place *frame, const place *p, tl_vec3 local)
{
    tl_vec3 apart = tl_v3_sub(p->x, frame->x);
    return tl_m3_tmul(&frame->r, tl_v3_add(apart, tl_m3_mul(&p->r, local)));
}

tl_vec3 tl_touch_normal(const tl_model *m, const tl_touch *touch, bool now)
{
    place at = place_of(m, touch->row, now);
    return tl_m3_mul(&at.r, m->blocks.shape[touch->row]->plane[touch->face].normal);
}

/* Components of a translation that are held: of a deformable body those in which any gridpoint is. */
static unsigned held_components(const tl_model *m, uint32_t body)
{
    if (!m->bodies.mesh[body])
        return m->bodies.fixed[body];
    const tl_body_mesh *mesh = &m->zones->mesh[m->bodies.mesh[body] - 1];
    unsigned held = 0;
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++)
        held |= m->zones->points.fixed[row];
    return held;
}

size_t tl_held_axes(const tl_model *m, uint32_t body, tl_vec3 held[3])
{
    static const uint8_t fix[] = {TL_FIX_X, TL_FIX_Y, TL_FIX_Z};
    const tl_vec3 axis[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const unsigned components = held_components(m, body);
    size_t count = 0;
    for (int k = 0; k < 3; k++)
        if (components & fix[k])
            held[count++] = axis[k];
    return count;
}

bool tl_touches_moved(const tl_model *m, const tl_touches *touches, uint32_t body)
{
    double most = 0;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        uint32_t row = m->members[m->bodies.member_start[body] + k];
        for (size_t i = touches->start[row]; i < touches->start[row + 1]; i++)
            most = fmax(most, touches->at[i].moved);
        if (touches->left[row])
            return true;
    }
    return !(most < TL_TOUCH_KEPT);
}

/* ---------------------------------------------------------------- pairs ------------------ */

/* By how much a pair has moved against each other, m: the farthest corner of the smaller one. */
static double moved_of(const search *s, uint32_t a, uint32_t b)
{
    const tl_model *m = s->m;
    bool first = m->blocks.size[a] <= m->blocks.size[b];
    uint32_t small = first ? a : b, large = first ? b : a;
    const place *its = s->places[small], *frame = s->places[large];
    const tl_poly *shape = m->blocks.shape[small];
    double most = 0;
    for (uint32_t i = 0; i < shape->vertex_count; i++) {
        tl_vec3 before = point_in(&frame[0], &its[0], shape->vertex[i]);
        tl_vec3 after = point_in(&frame[1], &its[1], shape->vertex[i]);
        most = fmax(most, tl_v3_norm(tl_v3_sub(after, before)));
    }
    return most;
}

static tl_pair_view view_of(const search *s, uint32_t a, uint32_t b, bool now)
{
    const tl_model *m = s->m;
    const place *at = &s->places[a][now], *other = &s->places[b][now];
    return (tl_pair_view){.a = tl_pair_shape(m, a, b),
                          .b = tl_pair_shape(m, b, a),
                          .turn = tl_m3_tproduct(&at->r, &other->r),
                          .shift = tl_m3_tmul(&at->r, tl_v3_sub(other->x, at->x)),
                          .size = fmin(m->blocks.size[a], m->blocks.size[b]),
                          .mean_face = fmin(m->blocks.mean_face[a], m->blocks.mean_face[b])};
}

/* Two faces, of A and of B, on each other. */
typedef struct common {
    bool looked;
    uint32_t face[2];
    double area; /* 0: there are none */
    tl_tag joint;
} common;

/* Looks at a pair as it lies, or lay, unless that has been done. Most pairs are apart, and their gap tells that. false:
 * out of memory. */
static bool look(const search *s, tl_narrow_scratch *scratch, uint32_t a, uint32_t b, bool now, common *out)
{
    if (out->looked)
        return true;
    out->looked = true;
    const tl_touch_rule rule = {.reach = INFINITY};
    tl_pair_view view = view_of(s, a, b, now);
    tl_region_lows lows;
    tl_region region;
    if (!tl_pair_place(&view, scratch) || !tl_region_gap(&view, scratch, &lows))
        return false;
    if (lows.gap > GAP * view.size)
        return true;
    if (!tl_region_find(&view, TL_LIST_MARGIN * view.size, scratch, &region))
        return false;
    uint32_t fa = region.flush_a, fb = region.flush_b;
    if (!region.flush || region.flush_gap < -OVERLAP * view.size || tl_region_tilt(&view, fa, fb) > TILT)
        return true;
    out->face[0] = fa;
    out->face[1] = fb;
    out->area = tl_patch_lay(&view, fa, fb, &rule, scratch);
    out->joint = tl_flush_tag(view.a->tag[fa], view.b->tag[fb]);
    return !scratch->failed;
}

/* Notes that the block in `row`, of a pair that does not touch now, has left what it lay on, if it did. */
static bool note_left(const search *s, worker *w, uint32_t row, common *before, const uint32_t pair[2])
{
    if (!look(s, &w->scratch, pair[0], pair[1], false, before))
        return false;
    if (!(before->area > 0))
        return true;
    if (!tl_grow(&w->left, &w->left_capacity, w->left_count + 1, sizeof *w->left))
        return false;
    w->left[w->left_count++] = row;
    return true;
}

static bool test_pair(const search *s, worker *w, uint32_t a, uint32_t b)
{
    if (!tl_bounds_meet(&s->bounds[a], &s->bounds[b]) || s->m->blocks.body[a] == s->m->blocks.body[b])
        return true;
    const uint32_t row[] = {a, b};
    const bool still = s->still[a] && s->still[b];
    const double moved = still ? 0 : moved_of(s, a, b);
    /* where a pair that has not moved did not touch, it does not touch now */
    common before = {.looked = false}, now = {.looked = still};
    for (int side = 0; side < 2; side++) {
        const double share = moved / s->size[s->m->blocks.body[row[side]]];
        const bool kept = share < TL_TOUCH_KEPT;
        if (kept && !look(s, &w->scratch, a, b, false, &before))
            return false;
        if (!(kept && before.area > 0) && !look(s, &w->scratch, a, b, true, &now))
            return false;
        const common *it = kept && before.area > 0 ? &before : &now;
        /* of a block that has hardly moved a strip of another one's face, on which it has slid, is no joint */
        const tl_poly *shape = s->m->blocks.shape[row[side]];
        double least =
            kept && it == &now && it->area > 0 ? 2 * TL_TOUCH_KEPT * tl_poly_face_area(shape, it->face[side]) : 0;
        const tl_touch touch = {row[side], it->face[side], row[1 - side], it->area, it->joint, share};
        if (it->area > least) {
            if (!tl_grow(&w->found.at, &w->found.capacity, w->found.count + 1, sizeof touch))
                return false;
            w->found.at[w->found.count++] = touch;
        }
        if (!kept && !(now.area > 0) && !note_left(s, w, row[side], &before, row))
            return false;
    }
    return true;
}

/* ---------------------------------------------------------------- search ----------------- */

static double along(tl_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* Bounds of a block at both places, grown by the gap. */
static tl_bounds bounds_of(const search *s, uint32_t row)
{
    const tl_poly *shape = s->m->blocks.shape[row];
    const place *at = s->places[row];
    tl_bounds b = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < 2 * shape->vertex_count; i++) {
        tl_vec3 x = tl_v3_add(at[i % 2].x, tl_m3_mul(&at[i % 2].r, shape->vertex[i / 2]));
        b.min = tl_v3_min(b.min, x);
        b.max = tl_v3_max(b.max, x);
    }
    double growth = GAP * s->m->blocks.size[row];
    tl_vec3 skin = {growth, growth, growth};
    return (tl_bounds){tl_v3_sub(b.min, skin), tl_v3_add(b.max, skin)};
}

/* A row and where its bounds begin, for qsort. */
typedef struct begin {
    double at;
    uint32_t row;
} begin;

static int compare_begin(const void *x, const void *y)
{
    const begin *a = x, *b = y;
    return a->at != b->at ? (a->at > b->at) - (a->at < b->at) : (a->row > b->row) - (a->row < b->row);
}

static bool prepare(search *s)
{
    const tl_model *m = s->m;
    size_t rows = m->blocks.table.rows;
    begin *begins = malloc((rows + 1) * sizeof *begins);
    s->places = malloc((rows + 1) * sizeof *s->places);
    s->still = malloc((rows + 1) * sizeof *s->still);
    s->bounds = malloc((rows + 1) * sizeof *s->bounds);
    s->order = malloc((rows + 1) * sizeof *s->order);
    s->size = malloc((m->bodies.table.rows + 1) * sizeof *s->size);
    bool enough = begins && s->places && s->still && s->bounds && s->order && s->size;
    for (uint32_t body = 0; body < m->bodies.table.rows && enough; body++)
        s->size[body] = tl_body_size(m, body);
    tl_vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t row = 0; row < rows && enough; row++) {
        if (!m->blocks.stays[row])
            continue;
        s->places[row][0] = place_of(m, row, false);
        s->places[row][1] = place_of(m, row, true);
        s->still[row] = memcmp(&s->places[row][0], &s->places[row][1], sizeof(place)) == 0;
        s->bounds[row] = bounds_of(s, row);
        low = tl_v3_min(low, s->bounds[row].min);
        high = tl_v3_max(high, s->bounds[row].max);
        begins[s->count++].row = row;
    }
    for (int axis = 1; axis < 3; axis++)
        if (along(high, axis) - along(low, axis) > along(high, s->axis) - along(low, s->axis))
            s->axis = axis;
    for (size_t i = 0; i < s->count && enough; i++)
        begins[i].at = along(s->bounds[begins[i].row].min, s->axis);
    if (enough)
        qsort(begins, s->count, sizeof *begins, compare_begin);
    for (size_t i = 0; i < s->count && enough; i++)
        s->order[i] = begins[i].row;
    free(begins);
    return enough;
}

/* Places of the order, and the pairs of each with those that begin after it and before it ends. */
static void test_pairs(void *user, size_t first, size_t end, size_t chunk, unsigned thread)
{
    const search *s = user;
    worker *w = &s->workers[thread];
    (void)chunk;
    for (size_t i = first; i < end && !w->failed; i++) {
        uint32_t row = s->order[i];
        double reach = along(s->bounds[row].max, s->axis);
        for (size_t j = i + 1; j < s->count && !w->failed; j++) {
            uint32_t other = s->order[j];
            if (along(s->bounds[other].min, s->axis) > reach)
                break;
            w->failed = !test_pair(s, w, row < other ? row : other, row < other ? other : row);
        }
    }
}

static int compare_touch(const void *x, const void *y)
{
    const tl_touch *a = x, *b = y;
    return a->row != b->row ? (a->row > b->row) - (a->row < b->row) : (a->other > b->other) - (a->other < b->other);
}

/* Takes what all threads have found together, in order. */
static bool collect(const search *s, unsigned threads, tl_touches *out)
{
    const size_t rows = s->m->blocks.table.rows;
    bool enough = true;
    size_t count = 0;
    for (unsigned k = 0; k < threads; k++) {
        enough = enough && !s->workers[k].failed;
        count += s->workers[k].found.count;
    }
    out->start = calloc(rows + 2, sizeof *out->start);
    out->at = malloc((count + 1) * sizeof *out->at);
    out->left = calloc(rows + 1, sizeof *out->left);
    if (!enough || !out->start || !out->at || !out->left)
        return false;
    for (unsigned k = 0; k < threads; k++) {
        const tl_touches *found = &s->workers[k].found;
        if (found->count)
            memcpy(out->at + out->count, found->at, found->count * sizeof *out->at);
        out->count += found->count;
        for (size_t i = 0; i < s->workers[k].left_count; i++)
            out->left[s->workers[k].left[i]] = 1;
    }
    qsort(out->at, out->count, sizeof *out->at, compare_touch);
    for (size_t i = 0; i < out->count; i++)
        out->start[out->at[i].row + 1]++;
    for (size_t row = 0; row < rows; row++)
        out->start[row + 1] += out->start[row];
    return true;
}

tl_status tl_touches_find(tl_model *m, tl_touches *out)
{
    const unsigned threads = tl_pool_threads(m->pool);
    search s = {.m = m, .workers = calloc(threads, sizeof *s.workers)};
    *out = (tl_touches){0};
    bool enough = s.workers && prepare(&s);
    if (enough) {
        tl_parallel_for(m->pool, s.count, CHUNK, test_pairs, &s);
        enough = collect(&s, threads, out);
    }
    free(s.size);
    free(s.places);
    free(s.still);
    free(s.bounds);
    free(s.order);
    for (unsigned k = 0; k < threads && s.workers; k++) {
        tl_narrow_scratch_free(&s.workers[k].scratch);
        free(s.workers[k].found.at);
        free(s.workers[k].left);
    }
    free(s.workers);
    return enough ? TL_OK : tl_fail_memory(&m->error);
}

void tl_touches_free(tl_touches *touches)
{
    free(touches->at);
    free(touches->start);
    free(touches->left);
    *touches = (tl_touches){0};
}
