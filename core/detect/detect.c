/* detect.c - the order of contact detection.
 *
 * Phases: after edits rows are found again by id, and what was known of blocks that have changed is dropped (edits.c).
 * The broad phase lists the neighbours of these, and is made anew when something may have left its skin. Pairs without
 * a contact are tested when they may have come near. Contacts are followed, or made anew when they moved more than a
 * margin. Births, deaths and growth are then settled serially in the order of pairs. The bodies' odometers tell how far
 * anything can have moved. */
#include "detect/detect.h"

#include "base/inline.h"
#include "base/parallel.h"
#include "contact/contacts.h"
#include "contact/cut_contacts.h"
#include "contact/handover.h"
#include "contact/index.h"
#include "contact/kind.h"
#include "contact/pair_view.h"
#include "contact/prefetch.h"
#include "contact/store.h"
#include "detect/asked.h"
#include "detect/broad.h"
#include "detect/edits.h"
#include "detect/grazing.h"
#include "detect/kinds.h"
#include "detect/overlap.h"
#include "detect/pairs.h"
#include "detect/update.h"
#include "force/cut_parts.h"
#include "model/body_shape.h"
#include "model/rows.h"
#include "model/seats.h"
#include "narrow/coarse_test.h"
#include "narrow/manifold.h"
#include "narrow/narrow.h"
#include "narrow/patch.h"
#include "zone/grid.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Rows a worker takes at a time. */
#define CONTACT_CHUNK 256
/* Blocks a worker takes at a time: there is little to do with each. */
#define BLOCK_CHUNK 4096
#define GROUP_CHUNK 8
/* SIMD groups from one for which the memory is asked to the present one, and from one whose contacts' rows are asked
 * for. */
#define AHEAD 2
#define FAR_AHEAD 6
/* Bytes of most shapes: one of eight corners and six faces. */
#define SHAPE 704

static tl_status ensure(tl_model *m)
{
    if (m->detect)
        return TL_OK;
    uint32_t columns = 0;
    for (size_t i = 0; i < m->joint_law_count; i++) {
        uint32_t wanted = m->joint_laws[i].columns;
        columns = wanted > columns ? wanted : columns;
    }
    tl_detect *d = tl_detect_make(tl_pool_threads(m->pool), tl_contact_kinds, TL_FACET_KINDS);
    if (!d || !tl_detect_hold_states(d, columns)) {
        if (d)
            tl_detect_destroy(d);
        return tl_fail_memory(&m->error);
    }
    m->detect = d;
    m->detect_destroy = tl_detect_destroy;
    return TL_OK;
}

/* ---------------------------------------------------------------- pairs -------------------
 *
 * When pairs without a contact are tested.
 *
 * A pair that was tested and is not near sleeps until its blocks, together, may have moved as far as they are apart.
 * How far a block can have moved follows from its body's odometer, since the broad phase was made: single precision is
 * enough. Path lengths are rounded up and wake-up distances down, so rounding can only make a pair be tested too early.
 * Most pairs sleep in most steps. Of a chunk that sleeps longer than any two blocks have moved nothing is read. */

/* The bits of a float that is not less than a number which is not negative: those of the next one follow. */
TL_INLINE uint32_t rounded_up(double x)
{
    float y = (float)x;
    uint32_t bits;
    memcpy(&bits, &y, sizeof bits);
    return bits + ((double)y < x);
}

typedef struct path_job {
    tl_model *m;
    float longest[TL_MAX_THREADS];
} path_job;

/* Path lengths of blocks; the longest of them. Floats that are not negative are in the order of their bits. */
TL_VECTORIZED static float measure_paths(float *restrict path, const uint32_t *restrict body,
                                         const double *restrict odometer, const double *restrict odometer_0,
                                         size_t count)
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
    float farthest =
        measure_paths(d->path + begin, m->blocks.body + begin, m->bodies.odometer, d->odometer_0, end - begin);
    job->longest[thread] = farthest > job->longest[thread] ? farthest : job->longest[thread];
}

/* Notes how far each block can have moved since the broad phase was made. */
static void measure_all_paths(tl_model *m)
{
    path_job job = {.m = m};
    unsigned threads = tl_pool_threads(m->pool);
    for (unsigned i = 0; i < threads; i++)
        job.longest[i] = 0;
    tl_parallel_for(m->pool, m->blocks.table.rows, BLOCK_CHUNK, path_range, &job);
    m->detect->longest_path = 0;
    for (unsigned i = 0; i < threads; i++)
        m->detect->longest_path = job.longest[i] > m->detect->longest_path ? job.longest[i] : m->detect->longest_path;
}

/* Notes that a pair has lost its contact. */
static void note_parted(tl_detect *d, uint32_t pair)
{
    tl_pair_chunk *chunk = &d->chunks[pair / TL_PAIR_CHUNK];
    if (pair < d->pair_count && d->pairs[pair].wake < chunk->wake)
        chunk->wake = d->pairs[pair].wake;
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

/* How far a pair may move that only edges part before it may touch; negative: it may touch already. By coarse tests
 * with reaches twice as long each, where it is within the longest. */
static double way_to_edges(const tl_pair_view *view, double longest)
{
    double tolerance = TL_CONTACT_TOLERANCE * view->size, reach = tolerance;
    if (tl_coarse_test(view, reach))
        return -1;
    if (!tl_coarse_test(view, longest))
        return longest - tolerance;
    while (2 * reach < longest && !tl_coarse_test(view, 2 * reach))
        reach *= 2;
    return fmax(reach - tolerance, tolerance);
}

/* How far a pair may move before edges and corners that graze carry more than goes unseen; negative: they may do so
 * now. */
static double way_to_grazing(const tl_model *m, const tl_pair_view *view, tl_pair *p, const tl_region_lows *lows)
{
    if (!tl_grazing_may_be(view))
        return -1;
    tl_grazing_choose_faces(view, p, lows);
    double gap, margin = tl_grazing_margin(view, p, &gap);
    if (margin >= 0 && !(tl_touch_rule_of(m, p->a, p->b, view, tl_touching_tag(view, lows->n), 0).min_area > 0))
        return margin;
    tl_pair_forget_faces(p);
    return -1;
}

/* What is known of a placed pair before its contact is made: that it holds across a gap, if it takes over from one. */
static tl_manifold_before before_contact(const tl_model *m, const tl_pair *p, const tl_pair_view *view,
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
    tl_touch_rule rule = tl_touch_rule_of(m, p->a, p->b, view, view->a->tag[faces.a], INFINITY);
    out.over = INFINITY;
    out.holds = tl_patch_lay(view, faces.a, faces.b, &rule, scratch) > 0;
    out.faces = faces;
    return out;
}

/* Size of the smaller one of a pair's bodies, m. */
static double size_of_bodies(const tl_model *m, const tl_pair *pair)
{
    return fmin(tl_body_size(m, m->blocks.body[pair->a]), tl_body_size(m, m->blocks.body[pair->b]));
}

/* What the contact of a placed pair begins with, whose facet and points have been found. */
static tl_birth birth_of(const tl_model *m, const tl_pair *p, const tl_pair_view *view, const tl_region *region,
                         tl_tag tag, const tl_narrow_scratch *scratch)
{
    const tl_manifold *g = &scratch->manifold;
    const double overlap = tl_facet_is_field(&g->facet) ? g->press->deepest : -region->gap;
    const bool meet = !tl_cut_contact_of(m, p->a, p->b); /* parts of blocks go on in the overlap of these */
    return (tl_birth){.pair = (uint32_t)(p - m->detect->pairs),
                      .kind = g->facet.kind,
                      .tag = tag,
                      .points = (uint32_t)g->point_count,
                      .valid = g->valid,
                      .overlaps =
                          meet && overlap > TL_SHALLOW * view->size && overlap > TL_SHALLOW * size_of_bodies(m, p),
                      .deep = tl_overlap_is_deep(m, view, region, p->a, p->b, meet)};
}

/* Keeps what was found of a pair until its contact is made. Without the memory for it, it is found again. */
static void note_birth(tl_births *births, const tl_birth *birth)
{
    if (tl_grow(&births->list, &births->capacity, births->count + 1, sizeof *births->list))
        births->list[births->count++] = *birth;
}

/* Cost only: gap along a face, over the reach of the coarse test, from which on that test is spared. */
#define FAR_APART 0.25

/* How far a pair that nothing holds may move before it is near enough to become a contact; negative: it may be now.
 * What is cheap to tell comes first: in a lattice most pairs graze. */
static double way_to_near(const tl_model *m, const tl_pair_view *view, tl_pair *p, const tl_region_lows *lows)
{
    const double reach = m->detect->reach, tolerance = TL_CONTACT_TOLERANCE * view->size;
    if (lows->gap - tolerance > FAR_APART * reach)
        return fmin(lows->gap - tolerance, reach);
    const double margin = lows->gap > tolerance ? -1 : way_to_grazing(m, view, p, lows);
    if (margin >= 0)
        return margin;
    if (!(lows->gap > 0))
        return way_to_edges(view, tolerance + reach);
    if (!tl_coarse_test(view, tolerance + reach))
        return reach;
    return lows->gap > tolerance ? lows->gap - tolerance : -1;
}

/* Tolerance: way over the size after which it is seen that segments no longer are all of a contact: a tilt of 0.1
 * degrees (segment/blend.c). */
#define TILTS 0.002

/* How far a pair may move before it is tested again; negative: it is near enough to become a contact; NAN: out of
 * memory. */
static double way_to_test(const tl_model *m, tl_pair *p, tl_births *births, tl_narrow_scratch *scratch)
{
    const double reach = m->detect->reach;
    tl_pair_view view = tl_pair_view_of(m, p->a, p->b);
    if (tl_blocks_meet(m, p->a, p->b))
        return fmin(reach, TILTS * view.size); /* by segments, until faces have tilted */
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
    tl_region_lows lows;
    if (!tl_region_gap(&view, scratch, &lows))
        return NAN;
    double way = holds ? -1 : way_to_near(m, &view, p, &lows);
    if (way >= 0)
        return way;
    tl_region region;
    if (!tl_region_find(&view, TL_LIST_MARGIN * view.size + shift, scratch, &region))
        return NAN;
    const tl_manifold_before before = before_contact(m, p, &view, scratch);
    const bool corners = m->config.contact_points == TL_POINTS_CORNERS;
    const bool held = before.holds || (shift > 0 && region.gap <= shift);
    way = held ? -1 : way_to_contact(&view, &region, corners);
    if (way < 0 && holds && !held) /* it takes over from another, and does not hold by that */
        way = way_to_near(m, &view, p, &lows);
    if (way >= 0)
        return way;
    const tl_tag tag = tl_touching_tag(&view, region.n);
    tl_touch_rule rule = tl_touch_rule_of(m, p->a, p->b, &view, tag, before.over);
    if (!tl_kind_find(m, p->a, p->b, &view, &region, &rule, &before, scratch))
        return NAN; /* what was found is not all there is */
    if (scratch->manifold.point_count == 0 && !tl_overlap_is_whole(&view, &region))
        return TL_STILL * view.size; /* edges part the blocks by next to nothing */
    if (!cut) {
        const tl_birth birth = birth_of(m, p, &view, &region, tag, scratch);
        note_birth(births, &birth);
    }
    return -1;
}

static void test_pair(tl_model *m, tl_pair *p, tl_births *births, tl_narrow_scratch *scratch)
{
    const double way = way_to_test(m, p, births, scratch);
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
        if (tl_pair_path(d, p) >= (double)p->wake) {
            test_pair(m, p, &d->births[thread], &d->narrow[thread]);
            all->found = all->found || p->wake == TL_PAIR_FOUND;
        }
        wake = p->wake < wake ? p->wake : wake;
    }
    all->wake = wake;
}

/* Tests the pairs without a contact that may have come near: chunks and pairs tell which were found. */
static void test_pairs(tl_model *m)
{
    tl_detect *d = m->detect;
    bool all_sleep = true;
    tl_births_end(d); /* of an update that failed */
    for (size_t chunk = 0; all_sleep && chunk * TL_PAIR_CHUNK < d->pair_count; chunk++)
        all_sleep = sleeps(d, &d->chunks[chunk]);
    if (!all_sleep) /* a loop of the threads costs more than to see that there is nothing to do */
        tl_parallel_for(m->pool, d->pair_count, TL_PAIR_CHUNK, test_range, m);
}

/* ---------------------------------------------------------------- phases ----------------- */

/* Prefetches the rows of a SIMD group's contacts, which tell where all else is: for one that comes a little later. */
static void prefetch_contacts(const tl_detect *d, const tl_simd_group *group)
{
    const tl_contacts *c = &d->contacts;
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t i = group->contact[l];
        if (i == TL_NO_ROW)
            continue;
        tl_prefetch(&c->a[i], sizeof *c->a);
        tl_prefetch(&c->b[i], sizeof *c->b);
        tl_prefetch(&c->tag[i], sizeof *c->tag);
        tl_prefetch(&c->law[i], sizeof *c->law);
        tl_prefetch(&c->faces_valid_to[i], sizeof *c->faces_valid_to);
        tl_prefetch(&c->points_valid_to[i], sizeof *c->points_valid_to);
        tl_prefetch(&c->facet[i], sizeof *c->facet);
        tl_prefetch(&c->point_count[i], sizeof *c->point_count);
    }
}

/* Prefetches what a SIMD group that comes soon will need to be brought up to date. */
static void prefetch_shapes(const tl_model *m, const tl_simd_group *group)
{
    const tl_points_table *p = &m->detect->points;
    const tl_contacts *contacts = &m->detect->contacts;
    size_t count = (size_t)group->slots * TL_LANES;
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t contact = group->contact[l];
        if (contact == TL_NO_ROW || !tl_prefetch_bodies(m, contact))
            continue;
        tl_prefetch(m->blocks.shape[contacts->a[contact]], SHAPE);
        tl_prefetch(m->blocks.shape[contacts->b[contact]], SHAPE);
    }
    tl_prefetch_points(p, group->start, count);
    tl_prefetch(p->key + group->start, count * sizeof *p->key);
}

/* SIMD groups of a span. */
typedef struct update_job {
    tl_model *m;
    const tl_simd_group *groups;
    size_t count;
} update_job;

static void update_groups(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    const update_job *job = user;
    bool far = tl_points_are_far(job->m->detect), moved = false;
    for (size_t r = begin; r < end; r++) {
        bool alike = far && moved; /* as SIMD groups side by side are */
        if (alike && r + FAR_AHEAD < job->count)
            prefetch_contacts(job->m->detect, &job->groups[r + FAR_AHEAD]);
        if (alike && r + AHEAD < job->count)
            prefetch_shapes(job->m, &job->groups[r + AHEAD]);
        moved = tl_simd_group_update(job->m, &job->groups[r], thread);
    }
}

/* Contacts without points are in no SIMD group. */
static void update_others(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    tl_model *m = user;
    for (uint32_t c = (uint32_t)begin; c < end; c++)
        if (m->detect->contacts.point_capacity[c] == 0 && !tl_contact_points_hold(m, c))
            tl_contact_update(m, c, thread);
}

static void update_contacts(tl_model *m)
{
    const tl_layout *layout = &m->detect->layout;
    for (size_t k = 0; k < layout->span_count; k++) {
        const tl_span *span = &layout->spans[k];
        if (tl_span_rests(m, span))
            continue;
        update_job job = {m, layout->groups + span->group_begin, span->group_end - span->group_begin};
        tl_parallel_for(m->pool, span->group_end - span->group_begin, GROUP_CHUNK, update_groups, &job);
    }
    if (m->detect->any_without_rows)
        tl_parallel_for(m->pool, m->detect->contacts.table.rows, CONTACT_CHUNK, update_others, m);
}

/* Pairs that overlap deeply when their contact is made. */
typedef struct overlaps {
    size_t count;
    uint32_t pair; /* the first */
} overlaps;

/* What was found of a pair when it was tested; NULL: nothing is known. Pairs are asked for in their order. */
static const tl_birth *noted_birth(const tl_detect *d, uint32_t pair)
{
    for (unsigned i = 0; i < d->threads; i++) {
        tl_births *births = &d->births[i];
        while (births->next < births->count && births->list[births->next].pair < pair)
            births->next++;
        if (births->next < births->count && births->list[births->next].pair == pair)
            return &births->list[births->next];
    }
    return NULL;
}

/* Finds what the contact of a pair begins with that takes over from another, and how it is held; false: out of
 * memory. */
static bool find_birth(const tl_model *m, const tl_pair *p, tl_birth *out, bool *holds, tl_narrow_scratch *scratch)
{
    tl_pair_view view = tl_pair_view_of(m, p->a, p->b);
    if (!tl_pair_place(&view, scratch))
        return false;
    const tl_manifold_before before = before_contact(m, p, &view, scratch);
    tl_region region;
    if (!tl_region_find(&view, TL_LIST_MARGIN * view.size + before.shift, scratch, &region))
        return false;
    tl_tag tag = tl_touching_tag(&view, region.n);
    tl_touch_rule rule = tl_touch_rule_of(m, p->a, p->b, &view, tag, before.over);
    if (!tl_kind_find(m, p->a, p->b, &view, &region, &rule, &before, scratch))
        return false;
    *out = birth_of(m, p, &view, &region, tag, scratch);
    *holds = before.holds;
    return true;
}

/* Makes the contact of a pair that has come near; its overlap is noted when it is deep. */
static tl_status give_birth(tl_model *m, uint32_t pair, overlaps *deep)
{
    tl_detect *d = m->detect;
    tl_narrow_scratch *scratch = &d->narrow[0];
    const tl_birth *noted = noted_birth(d, pair);
    tl_birth birth;
    bool holds = false;
    if (noted)
        birth = *noted;
    else if (!find_birth(m, &d->pairs[pair], &birth, &holds, scratch))
        return tl_fail_memory(&m->error);
    if (!tl_contact_append(m, pair, birth.kind, birth.valid, birth.tag, birth.points))
        return tl_fail_memory(&m->error);
    uint32_t row = (uint32_t)d->contacts.table.rows - 1;
    if (holds) { /* so that it is found once more when it has got its room */
        d->contacts.facet[row] = scratch->manifold.facet;
        d->contacts.holds_over_gap[row] = true;
    }
    if (birth.overlaps && deep->count++ == 0)
        deep->pair = pair;
    if (birth.deep) {
        tl_overlap_mark(&d->contacts, row, !tl_cut_contact_of(m, d->pairs[pair].a, d->pairs[pair].b));
        scratch->deep = true;
    }
    return TL_OK;
}

/* Contacts of the pairs that have come near. */
static tl_status give_births(tl_model *m, size_t *born)
{
    tl_detect *d = m->detect;
    overlaps deep = {0, 0};
    *born = 0;
    for (uint32_t chunk = 0; (size_t)chunk * TL_PAIR_CHUNK < d->pair_count; chunk++) {
        uint32_t begin = chunk * TL_PAIR_CHUNK;
        for (uint32_t i = begin; d->chunks[chunk].found && i < begin + TL_PAIR_CHUNK && i < d->pair_count; i++) {
            if (!tl_pair_is_apart(&d->pairs[i]) || d->pairs[i].wake != TL_PAIR_FOUND)
                continue;
            tl_status status = give_birth(m, i, &deep);
            if (status != TL_OK)
                return status;
            ++*born;
        }
        d->chunks[chunk].found = false;
    }
    tl_births_end(d);
    if (deep.count && tl_model_says(m, TL_REMARK_OVERLAP))
        tl_model_say(m,
                     "%zu pair%s of blocks (first: blocks %u and %u) overlap%s by more than %g of their "
                     "size when they come into contact: they will be pushed apart by that much",
                     deep.count, deep.count == 1 ? "" : "s", m->blocks.id[d->pairs[deep.pair].a],
                     m->blocks.id[d->pairs[deep.pair].b], deep.count == 1 ? "s" : "", TL_SHALLOW);
    return TL_OK;
}

/* A contact that comes under another law begins with that law's states; under the same law with other
 * properties it keeps them. */
static void change_law(tl_model *m, uint32_t c)
{
    tl_detect *d = m->detect;
    uint32_t old = d->contacts.law[c], law = tl_law_row(m, d->contacts.tag[c], d->contacts.a[c], d->contacts.b[c]);
    d->contacts.law[c] = law;
    const tl_kind *kind = tl_law_kind(m, law);
    if (old != TL_NO_ROW && m->joint_laws[old].kind == kind)
        return;
    tl_contact_begin_law(m, c, kind, &d->lanes[0]);
}

/* Notes that the contacts of two bodies are no longer what they were. Of those that ended with their blocks it was
 * noted when rows were found. */
static void touch(tl_model *m, uint32_t row)
{
    tl_detect *d = m->detect;
    if (d->rows_changed && d->contacts.pending[row] == TL_PENDING_DIE)
        return;
    d->any_touched = true;
    const tl_sides on = tl_contact_bodies(m, row);
    d->touched[on.a] = d->touched[on.b] = true;
}

/* Takes out the dead, gives others their law, and finds room for those that are new or have grown; false when there is
 * none. Backward, for the last contact takes the row of one that goes. */
static bool settle_rows(tl_model *m)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    for (uint32_t row = (uint32_t)c->table.rows; row-- > 0;) {
        if (c->pending[row] == TL_PENDING_NONE)
            continue;
        uint32_t pair = c->pair[row];
        if (!tl_pending_waits(c->pending[row])) /* others are noted when they have got their points */
            touch(m, row);
        if (c->pending[row] == TL_PENDING_DIE) {
            const double share = c->share ? c->share[row] : 1;
            tl_addends_put(&d->parting, share * (tl_contact_sheared(m, row) + c->released[row]));
            tl_contact_remove(d, row);
            note_parted(d, pair);
            continue;
        }
        if (c->pending[row] == TL_PENDING_MOVE)
            d->pairs[pair].want_points = c->point_capacity[row];
        if (tl_law_row(m, c->tag[row], c->a[row], c->b[row]) != c->law[row])
            change_law(m, row);
    }
    return tl_contacts_place(d, m->cycles);
}

/* Builds the facets of the contacts that have been given their room; *more: some want more still. */
static tl_status fill_contacts(tl_model *m, bool *more)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    *more = false;
    for (uint32_t row = 0; row < c->table.rows; row++) {
        if (c->pending[row] == TL_PENDING_NONE)
            continue;
        if (tl_pending_waits(c->pending[row]) && !tl_contact_fill(m, row))
            return tl_fail_memory(&m->error);
        if (tl_pending_waits(c->pending[row])) {
            *more = true;
            continue;
        }
        c->pending[row] = TL_PENDING_NONE;
        tl_pair_forget_faces(&d->pairs[c->pair[row]]); /* the room it wanted was in their place */
    }
    return TL_OK;
}

/* Something was left to do for some contact: in most steps for none, and all are asked. */
static bool some_pending(const tl_contacts *c)
{
    static_assert(TL_PENDING_NONE == 0, "what is pending is not told by its bits");
    unsigned any = 0;
    for (size_t row = 0; row < c->table.rows; row++)
        any |= c->pending[row];
    return any != TL_PENDING_NONE;
}

/* Whether there was no memory to look at some pair or to bring some contact up to date; it is as it was, for another
 * time. */
static bool lacked_memory(tl_detect *d)
{
    bool lacked = false;
    for (unsigned i = 0; i < d->threads; i++) {
        lacked = lacked || d->narrow[i].failed;
        d->narrow[i].failed = false;
    }
    return lacked;
}

/* Births, deaths, growth and changes of joint law, in the order of pairs. */
static tl_status settle(tl_model *m)
{
    tl_detect *d = m->detect;
    size_t born = 0;
    bool scattered = tl_contacts_scattered(d, m->cycles);
    tl_contacts_free_spare(d, m->cycles);
    tl_status status = lacked_memory(d) ? tl_fail_memory(&m->error) : give_births(m, &born);
    if (status != TL_OK)
        return status;
    if (born == 0 && !d->rows_changed && !some_pending(&d->contacts) && !scattered)
        return TL_OK;
    d->any_without_rows = true; /* until they are listed anew */
    for (bool more = true; more && status == TL_OK;) {
        if (!settle_rows(m) || scattered)
            status = tl_contacts_repack(m);
        else if (!tl_contacts_index(m))
            status = tl_fail_memory(&m->error);
        scattered = false;
        if (status == TL_OK)
            status = fill_contacts(m, &more);
        d->parted += tl_addends_sum(&d->parting);
        d->parting = (tl_addends){.count = 0};
        d->rows_changed = status != TL_OK; /* contacts are not what they seem until all is settled */
    }
    if (status == TL_OK) {
        d->rows_changed = !tl_cut_parts_settle(m);
        if (d->rows_changed)
            return tl_fail_memory(&m->error);
    }
    return status;
}

/* Pairs and contacts after edits of the model, and new contacts; those that stand are not touched. */
static tl_status find_contacts(tl_model *m)
{
    tl_rows_tidy(m);
    tl_status status = ensure(m);
    if (status != TL_OK)
        return status;
    if (!tl_seats_follow(m))
        return tl_fail_memory(&m->error);
    tl_detect *d = m->detect;
    bool rows = d->structure != m->structure || !d->listed;
    if (rows) {
        d->rows_changed = true;
        status = tl_edits_find_rows(m);
        if (status != TL_OK)
            return status;
    }
    measure_all_paths(m);
    tl_edits_follow(m, rows);
    if (rows && lacked_memory(d))
        return tl_fail_memory(&m->error);
    if (rows || d->laws != m->laws || d->constraints != m->constraints)
        tl_held_sort(m);
    status = tl_broad_update(m, rows);
    if (status != TL_OK)
        return status;
    d->structure = m->structure;
    d->laws = m->laws;
    d->rules = m->rules;
    d->contact_points = m->config.contact_points;
    d->constraints = m->constraints;
    test_pairs(m);
    return TL_OK;
}

tl_status tl_detect_refresh(tl_model *m)
{
    tl_rows_tidy(m);
    const tl_detect *d = m->detect;
    bool listed = d && !d->rows_changed && d->indexed == d->contacts.table.rows; /* no step failed */
    bool ruled =
        m->found_for != TL_FOR_QUERIES || !d || (d->rules == m->rules && d->contact_points == m->config.contact_points);
    if (listed && ruled && d->structure == m->structure && d->laws == m->laws)
        return TL_OK;
    tl_status status = tl_asked_begin(m);
    if (status == TL_OK)
        status = find_contacts(m);
    return status == TL_OK ? settle(m) : status;
}

tl_status tl_detect_update(tl_model *m)
{
    tl_rows_tidy(m);
    tl_asked_end(m);
    tl_status status = find_contacts(m);
    if (status != TL_OK)
        return status;
    update_contacts(m);
    status = settle(m);
    if (status == TL_OK)
        m->cut_part_count = 0; /* contacts know them now */
    return status;
}
