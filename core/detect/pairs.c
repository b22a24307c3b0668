/* pairs.c - when pairs without a contact are tested.
 *
 * A pair that was tested and is not near sleeps until its blocks, together, may have moved as far as they are apart.
 * How far a block can have moved follows from its body's odometer, since the broad phase was made: single precision is
 * enough. Path lengths are rounded up and wake-up distances down, so rounding can only make a pair be tested too early.
 * Most pairs sleep in most steps. Of a chunk that sleeps longer than any two blocks have moved nothing is read. */
#include "detect/pairs.h"

#include "base/inline.h"
#include "contact/cut_contacts.h"
#include "contact/kind.h"
#include "contact/pair_view.h"
#include "detect/grazing.h"
#include "detect/overlap.h"
#include "narrow/coarse_test.h"
#include "narrow/manifold.h"
#include "narrow/patch.h"
#include "narrow/place.h"

#include <string.h>
#include <talus/plugin.h>

/* Constant: below any path length. The pair is tested in the next step. */
#define AWAKE (-1.f)
/* Blocks a worker takes at a time: there is little to do with each. */
#define BLOCK_CHUNK 4096

/* The bits of a float that is not less than a number which is not negative: those of the next one follow. */
TL_INLINE uint32_t rounded_up(double x)
{
    float y = (float)x;
    uint32_t bits;
    memcpy(&bits, &y, sizeof bits);
    return bits + ((double)y < x);
}

static float rounded_down(double x)
{
    float y = (float)x;
    return (double)y > x ? nextafterf(y, -INFINITY) : y;
}

tl_status tl_pairs_restart(tl_model *m)
{
    tl_detect *d = m->detect;
    size_t blocks = m->blocks.table.rows, bodies = m->bodies.table.rows;
    if (!tl_fit(&d->odometer_0, &d->odometer_capacity, bodies + 1, sizeof *d->odometer_0) ||
        !tl_fit(&d->touched, &d->touched_capacity, bodies + 1, sizeof *d->touched) ||
        !tl_fit(&d->idle, &d->idle_capacity, bodies + 1, sizeof *d->idle) ||
        !tl_fit(&d->path, &d->path_capacity, blocks + 1, sizeof *d->path))
        return tl_fail_memory(&m->error);
    for (size_t body = 0; body < bodies; body++)
        d->odometer_0[body] = m->bodies.odometer[body];
    for (size_t row = 0; row < blocks; row++)
        d->path[row] = 0;
    d->longest_path = 0;
    return TL_OK;
}

typedef struct path_job {
    tl_model *m;
    float longest[TL_MAX_THREADS];
} path_job;

/* Path lengths of blocks; the longest of them. Floats that are not negative are in the order of their bits. */
TL_VECTORIZED static float measure_paths(float *restrict path, const uint32_t *restrict body,
                                         const double *restrict odometer,
                                         const double *restrict odometer_0, size_t count)
{
    uint32_t most = 0;
    float farthest;
    for (size_t i = 0; i < count; i++) {
        uint32_t bits = rounded_up(odometer[body[i]] - odometer_0[body[i]]);
        memcpy(&path[i], &bits, sizeof bits);
        most = bits > most ? bits : most;
    }
    memcpy(&farthest, &most, sizeof farthest);
    return farthest;
}

static void path_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    path_job *job = user;
    const tl_model *m = job->m;
    tl_detect *d = m->detect;
    float farthest = measure_paths(d->path + begin, m->blocks.body + begin, m->bodies.odometer,
                                   d->odometer_0, end - begin);
    job->longest[thread] = farthest > job->longest[thread] ? farthest : job->longest[thread];
}

void tl_pairs_measure_paths(tl_model *m)
{
    path_job job = {.m = m};
    unsigned threads = tl_pool_threads(m->pool);
    for (unsigned i = 0; i < threads; i++)
        job.longest[i] = 0;
    tl_parallel_for(m->pool, m->blocks.table.rows, BLOCK_CHUNK, path_range, &job);
    m->detect->longest_path = 0;
    for (unsigned i = 0; i < threads; i++)
        m->detect->longest_path =
            job.longest[i] > m->detect->longest_path ? job.longest[i] : m->detect->longest_path;
}

static double path_of(const tl_detect *d, const tl_pair *p)
{
    return (double)d->path[p->a] + (double)d->path[p->b];
}

void tl_pair_sleep(tl_detect *d, tl_pair *pair, double way)
{
    pair->wake = rounded_down(path_of(d, pair) + way);
}

void tl_pair_rebase(const tl_detect *d, tl_pair *pair)
{
    pair->wake = rounded_down((double)pair->wake - path_of(d, pair));
}

void tl_pair_parted(tl_detect *d, uint32_t pair)
{
    tl_pair_chunk *chunk = &d->chunks[pair / TL_PAIR_CHUNK];
    if (pair < d->pair_count && d->pairs[pair].wake < chunk->wake)
        chunk->wake = d->pairs[pair].wake;
}

void tl_pair_wake(tl_detect *d, uint32_t i)
{
    tl_pair *p = &d->pairs[i];
    tl_pair_faces faces = tl_pair_faces_of(p);
    if (tl_pair_is_apart(p) && faces.one != faces.other) {
        p->wake = AWAKE;
        d->chunks[i / TL_PAIR_CHUNK].wake = AWAKE;
    }
    tl_pair_forget_faces(p);
}

/* How far a pair may move that is apart by the gap of its region before it may become a contact; below 0: it may be
 * one. Only a patch is born across a gap, of faces within its limit of tilt. */
static double way_to_contact(const tl_pair_view *view, const tl_region *r, bool corners)
{
    const double most_tilt = tl_flush_limits_of(corners).tilt;
    double tolerance = TL_CONTACT_TOLERANCE * view->size;
    if (r->gap > tolerance)
        return r->gap - tolerance;
    double tilt = r->flush ? tl_region_tilt(view, r->flush_a, r->flush_b) : INFINITY;
    bool parallel = (tilt - most_tilt) * view->size <= 2 * r->gap;
    return r->gap > 0 && !parallel ? r->gap : -1;
}

/* How far a pair may move that only edges part before it may touch; 0: it may touch already. By coarse tests with
 * reaches twice as long each, up to the longest with which it is known to be near. */
static double way_to_edges(const tl_pair_view *view, double longest)
{
    double tolerance = TL_CONTACT_TOLERANCE * view->size, reach = tolerance;
    if (tl_coarse_test(view, reach))
        return 0;
    while (2 * reach < longest && !tl_coarse_test(view, 2 * reach))
        reach *= 2;
    return fmax(reach - tolerance, tolerance);
}

tl_manifold_before tl_pair_before(const tl_model *m, const tl_pair *p, const tl_pair_view *view,
                                  tl_narrow_scratch *scratch)
{
    tl_manifold_before out = {.kind = TL_FACET_PATCH, .most_tilt = INFINITY};
    const tl_cut_contact *cut = tl_cut_contact_of(m, p->a, p->b);
    tl_face_pair faces;
    out.born_tilt = tl_cut_contact_tilt(m, p->a, p->b);
    out.shift = tl_cut_contact_shift(m, p->a, p->b, &out.shifted);
    out.reach = fmax(0, out.shift);
    if (!cut || !cut->holds_over_gap || !tl_cut_contact_faces(m, p->a, p->b, &faces))
        return out;
    tl_touch_rule rule = tl_touch_rule_of(m, view, view->a->tag[faces.a], INFINITY);
    out.over = INFINITY;
    out.holds = tl_patch_lay(view, faces.a, faces.b, &rule, scratch) > 0;
    out.faces = faces;
    return out;
}

/* How far a pair may move before it is tested again; negative: it is near enough to become a contact; NAN: out of memory. */
static double way_to_test(const tl_model *m, tl_pair *p, tl_narrow_scratch *scratch)
{
    const double reach = m->detect->reach;
    tl_pair_view view = tl_pair_view_of(m, p->a, p->b);
    tl_face_pair moved;
    const tl_cut_contact *cut = tl_cut_contact_of(m, p->a, p->b);
    double shift = fmax(0, tl_cut_contact_shift(m, p->a, p->b, &moved));
    bool holds = (cut && cut->holds_over_gap) || shift > 0;
    double gap, margin = holds ? -1 : tl_grazing_margin(&view, p, &gap);
    if (margin >= 0)
        return margin;
    tl_pair_forget_faces(p);
    if (!tl_pair_place(&view, scratch))
        return NAN;
    double tolerance = TL_CONTACT_TOLERANCE * view.size;
    if (!holds && !tl_coarse_test(&view, tolerance + reach))
        return reach;
    tl_region region;
    if (!tl_region_find(&view, TL_LIST_MARGIN * view.size + shift, scratch, &region))
        return NAN;
    const tl_manifold_before before = tl_pair_before(m, p, &view, scratch);
    const bool corners = m->config.contact_points == TL_POINTS_CORNERS;
    holds = before.holds || (shift > 0 && region.gap <= shift);
    double way = holds ? -1 : way_to_contact(&view, &region, corners);
    if (way > 0)
        return way;
    tl_touch_rule rule = tl_touch_rule_of(m, &view, tl_touching_tag(&view, region.n), before.over);
    if (!holds && !(rule.min_area > 0)) {
        tl_grazing_choose_faces(&view, p);
        margin = tl_grazing_margin(&view, p, &gap);
        if (margin >= 0)
            return margin;
        tl_pair_forget_faces(p);
    }
    way = holds || region.gap > 0 ? 0 : way_to_edges(&view, tolerance + reach);
    if (way > 0)
        return way;
    if (!tl_kind_find(m, p->a, p->b, &view, &region, &rule, &before, scratch))
        return NAN; /* what was found is not all there is */
    if (scratch->manifold.point_count > 0 || tl_overlap_is_whole(&view, &region))
        return -1;
    return TL_STILL * view.size; /* edges part the blocks by next to nothing */
}

static void test_pair(tl_model *m, tl_pair *p, tl_narrow_scratch *scratch)
{
    const double way = way_to_test(m, p, scratch);
    if (isnan(way))
        scratch->failed = true;
    else if (way < 0)
        p->wake = TL_PAIR_FOUND;
    else
        tl_pair_sleep(m->detect, p, way);
}

/* None of its pairs without a contact can have come near, whichever two blocks have moved the farthest. */
static bool sleeps(const tl_detect *d, const tl_pair_chunk *chunk)
{
    return 2 * (double)d->longest_path < (double)chunk->wake;
}

static void test_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    tl_model *m = user;
    tl_detect *d = m->detect;
    tl_pair_chunk *all = &d->chunks[chunk];
    if (sleeps(d, all))
        return;
    float wake = INFINITY;
    for (size_t i = begin; i < end; i++) {
        tl_pair *p = &d->pairs[i];
        if (!tl_pair_is_apart(p))
            continue;
        if (path_of(d, p) >= (double)p->wake) {
            test_pair(m, p, &d->narrow[thread]);
            all->found = all->found || p->wake == TL_PAIR_FOUND;
        }
        wake = p->wake < wake ? p->wake : wake;
    }
    all->wake = wake;
}

void tl_pairs_test(tl_model *m)
{
    const tl_detect *d = m->detect;
    bool all_sleep = true;
    for (size_t chunk = 0; all_sleep && chunk * TL_PAIR_CHUNK < d->pair_count; chunk++)
        all_sleep = sleeps(d, &d->chunks[chunk]);
    if (!all_sleep) /* a loop of the threads costs more than to see that there is nothing to do */
        tl_parallel_for(m->pool, d->pair_count, TL_PAIR_CHUNK, test_range, m);
}
