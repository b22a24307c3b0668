/* detect.c - the order of contact detection.
 *
 * Phases: after edits rows are found again by id, and what was known of blocks that have changed is dropped; the
 * broad phase lists the neighbours of these, and is made anew when something may have left its skin; pairs without a contact are looked at when they may have come near; contacts are
 * followed, or made anew when they moved more than a margin; births, deaths and growth are then settled
 * serially in the order of pairs. How far anything can have moved is told by the bodies' odometers. */
#include "detect/detect.h"

#include "base/parallel.h"
#include "contact/contacts.h"
#include "contact/cut_contacts.h"
#include "contact/handover.h"
#include "contact/index.h"
#include "contact/pair_view.h"
#include "contact/prefetch.h"
#include "contact/presses.h"
#include "contact/store.h"
#include "detect/asked.h"
#include "detect/broad.h"
#include "detect/grazing.h"
#include "detect/kinds.h"
#include "detect/overlap.h"
#include "detect/pairs.h"
#include "detect/update.h"
#include "force/cut_parts.h"
#include "model/body_shape.h"
#include "model/joints.h"
#include "model/rows.h"
#include "narrow/manifold.h"
#include "narrow/place.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Rows a worker takes at a time. */
#define CONTACT_CHUNK 256
#define GROUP_CHUNK 8
/* SIMD groups from one for which the memory is asked to the present one, and from one whose contacts' rows are asked for. */
#define AHEAD 2
#define FAR_AHEAD 6

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
    d->next_contact = m->next_contact;
    m->detect = d;
    m->detect_destroy = tl_detect_destroy;
    return TL_OK;
}

/* ---------------------------------------------------------------- after edits -------------
 *
 * What edits of the model leave of pairs and contacts.
 *
 * A block bears the count of structure with which it came, or got another shape, frame or tags. What is newer than the
 * count that detection has seen is treated as if it were new; all else that is known of pairs and contacts stays. What contacts of
 * blocks that were cut carry is left to those of their parts (contact/cut_contacts.c). */

/* Tolerance: minimum area over that of a patch from which the patch may be none: below MOST_MIN_AREA of
 * narrow/manifold.c. */
#define SURE_MIN_AREA 0.01

/* ---------------------------------------------------------------- rows ------------------- */

/* What is made before anything is changed. */
typedef struct rows_scratch {
    uint32_t *row;      /* [blocks seen] the present row, or TL_NO_ROW */
    uint32_t *part;     /* [blocks seen] of one that was cut: one of its parts, or TL_NO_ROW */
    double *odometer_0; /* [bodies] */
    uint8_t *touched;   /* [bodies] */
    tl_known_block *known_blocks; /* [blocks] */
} rows_scratch;

static bool reserve_scratch(const tl_model *m, rows_scratch *scratch)
{
    tl_detect *d = m->detect;
    size_t blocks = m->blocks.table.rows, bodies = m->bodies.table.rows;
    *scratch = (rows_scratch){.row = malloc((d->known_block_count + 1) * sizeof *scratch->row),
                              .part = malloc((d->known_block_count + 1) * sizeof *scratch->part),
                              .odometer_0 = malloc((bodies + 1) * sizeof *scratch->odometer_0),
                              .touched = malloc(bodies + 1),
                              .known_blocks = malloc((blocks + 1) * sizeof *scratch->known_blocks)};
    if (scratch->row && scratch->part && scratch->odometer_0 && scratch->touched &&
        scratch->known_blocks && tl_fit(&d->idle, &d->idle_capacity, bodies + 1, sizeof *d->idle) &&
        tl_fit(&d->path, &d->path_capacity, blocks + 1, sizeof *d->path))
        return true;
    return false;
}

static void free_scratch(rows_scratch *scratch)
{
    free(scratch->row);
    free(scratch->part);
    free(scratch->odometer_0);
    free(scratch->touched);
    free(scratch->known_blocks);
}

/* Runs of bodies that have come or changed begin here, and their contacts are not what they were; others keep both. */
static void keep_bodies(tl_model *m, const rows_scratch *scratch)
{
    const tl_detect *d = m->detect;
    for (size_t body = 0; body < m->bodies.table.rows; body++) {
        scratch->odometer_0[body] = m->bodies.odometer[body];
        scratch->touched[body] = true;
    }
    for (size_t old = 0; old < d->known_block_count; old++) {
        uint32_t row = scratch->row[old], before = d->known_blocks[old].body;
        if (row == TL_NO_ROW || tl_block_is_new(m, row))
            continue;
        scratch->odometer_0[m->blocks.body[row]] = d->odometer_0[before];
        scratch->touched[m->blocks.body[row]] = d->touched[before];
    }
}

static int compare_known(const void *x, const void *y)
{
    const tl_known_block *p = x, *q = y;
    return (p->id > q->id) - (p->id < q->id);
}

/* Finds a part of each block that was cut. */
static void find_parts(const tl_model *m, const rows_scratch *scratch)
{
    const tl_detect *d = m->detect;
    for (size_t old = 0; old < d->known_block_count; old++)
        scratch->part[old] = TL_NO_ROW;
    for (size_t i = 0; i < m->cut_part_count && d->known_block_count; i++) {
        tl_known_block root = {.id = m->cut_parts[i].root};
        if (tl_block_row_quiet(m, m->cut_parts[i].id) == TL_NO_ROW)
            continue;
        const tl_known_block *known =
            bsearch(&root, d->known_blocks, d->known_block_count, sizeof root, compare_known);
        if (known)
            scratch->part[known - d->known_blocks] = (uint32_t)i;
    }
}

/* Whether the contact of a pair, with the rows that detection has seen, ends because a block of it was cut. */
static bool leaves(const tl_detect *d, const rows_scratch *scratch, const tl_pair *p)
{
    bool a_ends = scratch->row[p->a] == TL_NO_ROW, b_ends = scratch->row[p->b] == TL_NO_ROW;
    return (a_ends || b_ends) && !tl_pair_is_apart(p) &&
           (!a_ends || scratch->part[p->a] != TL_NO_ROW) &&
           (!b_ends || scratch->part[p->b] != TL_NO_ROW) &&
           d->contacts.pending[p->contact] != TL_PENDING_DIE &&
           d->contacts.point_count[p->contact] > 0;
}

static tl_cut_side side_of(const tl_model *m, const rows_scratch *scratch, uint32_t seen)
{
    tl_id id = m->detect->known_blocks[seen].id;
    uint32_t row = scratch->row[seen];
    if (row == TL_NO_ROW) {
        const tl_cut_part *part = &m->cut_parts[scratch->part[seen]];
        uint32_t body = m->blocks.body[tl_block_row_quiet(m, part->id)];
        return (tl_cut_side){.id = id, .r = &part->r, .place = part->place, .body = body};
    }
    uint32_t body = m->blocks.body[row];
    return (tl_cut_side){.id = id,
                         .r = &m->bodies.pose[body].r,
                         .place = tl_body_place(&m->bodies, body),
                         .body = body,
                         .reframed = tl_block_is_new(m, row)};
}

/* Keeps what contacts of blocks that were cut leave; false when out of memory (nothing changed). */
static bool keep_cut_contacts(tl_model *m, const rows_scratch *scratch)
{
    tl_detect *d = m->detect;
    size_t contacts = d->cut_count, points = d->cut_point_count;
    bool there = true;
    for (size_t i = 0; i < d->pair_count && m->cut_part_count && there; i++) {
        const tl_pair *p = &d->pairs[i];
        if (!leaves(d, scratch, p))
            continue;
        tl_cut_side a = side_of(m, scratch, p->a), b = side_of(m, scratch, p->b);
        tl_cut_contact *cut = tl_cut_contact_keep(m, p->contact, &a, &b);
        there = cut != NULL;
        if (there)
            tl_cut_contact_foresee(m, p->contact, cut, &a, &b);
    }
    if (d->cut_count == contacts)
        return there;
    /* for the references of what the parts press with */
    if (!there || !tl_detect_hold_initial(d)) {
        d->cut_count = contacts;
        d->cut_point_count = points;
        return false;
    }
    for (size_t i = 0; i < d->pair_count; i++)
        if (leaves(d, scratch, &d->pairs[i]))
            tl_cut_contact_empty(m, d->pairs[i].contact);
    tl_cut_contacts_sort(d);
    return true;
}

/* Ends a contact: a block of it has gone, or both have become one body. */
static void end_contact(tl_model *m, const rows_scratch *scratch, uint32_t contact, uint32_t a,
                        uint32_t b)
{
    m->detect->contacts.pending[contact] = TL_PENDING_DIE;
    if (a != TL_NO_ROW)
        scratch->touched[m->blocks.body[a]] = true;
    if (b != TL_NO_ROW)
        scratch->touched[m->blocks.body[b]] = true;
}

/* Whether a contact is no more than an answer to somebody who has asked: it has been in no step, and bears no initial stress. Where
 * a block of it changes it is found as if nobody had. */
static bool is_fresh(const tl_detect *d, uint32_t contact)
{
    bool stressed = false;
    for (size_t k = 0; d->points.initial && k < d->contacts.point_count[contact]; k++)
        stressed = stressed || d->points.f_n0[tl_point_row(&d->contacts, contact, k)] != 0;
    return d->contacts.id[contact] > d->stepped_contact && !stressed;
}

/* Pairs, in their order, with their present rows: ids ascend with rows before and after. */
static void keep_pairs(tl_model *m, const rows_scratch *scratch)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    size_t kept = 0;
    for (size_t i = 0; i < d->pair_count; i++) {
        tl_pair p = d->pairs[i];
        uint32_t a = scratch->row[p.a], b = scratch->row[p.b];
        bool parted = a == TL_NO_ROW || b == TL_NO_ROW || m->blocks.body[a] == m->blocks.body[b];
        bool changed = !parted && (tl_block_is_new(m, a) || tl_block_is_new(m, b));
        if (tl_pair_is_apart(&p)) {
            if (parted || changed)
                continue; /* the broad phase lists it anew */
        } else if (parted || (changed && is_fresh(d, p.contact))) {
            end_contact(m, scratch, p.contact, a, b);
            continue;
        } else {
            c->a[p.contact] = a;
            c->b[p.contact] = b;
            c->pair[p.contact] = (uint32_t)kept;
            if (c->pending[p.contact] == TL_PENDING_DIE)
                end_contact(m, scratch, p.contact, a, b);
        }
        p.a = a;
        p.b = b;
        d->pairs[kept++] = p;
    }
    d->pair_count = kept;
    for (size_t chunk = 0; chunk * TL_PAIR_CHUNK < kept; chunk++)
        d->chunks[chunk] = (tl_pair_chunk){.wake = -INFINITY};
}

/* Finds the blocks of pairs and contacts again after rows have changed, and drops what was known of those that have come, gone
 * or changed: their pairs without a contact, and contacts of which a block has gone. TL_E_MEMORY: nothing has changed. */
static tl_status edited_rows(tl_model *m)
{
    tl_detect *d = m->detect;
    size_t blocks = m->blocks.table.rows, bodies = m->bodies.table.rows;
    rows_scratch scratch;
    bool there = reserve_scratch(m, &scratch);
    for (size_t old = 0; there && old < d->known_block_count; old++)
        scratch.row[old] = tl_block_row_quiet(m, d->known_blocks[old].id);
    if (there)
        find_parts(m, &scratch);
    if (!there || !keep_cut_contacts(m, &scratch)) {
        free_scratch(&scratch);
        return tl_fail_memory(&m->error);
    }
    keep_bodies(m, &scratch);
    keep_pairs(m, &scratch);
    for (size_t row = 0; row < blocks; row++)
        scratch.known_blocks[row] = (tl_known_block){m->blocks.id[row], m->blocks.body[row]};
    free(scratch.row);
    free(scratch.part);
    free(d->odometer_0);
    free(d->touched);
    free(d->known_blocks);
    d->odometer_0 = scratch.odometer_0;
    d->touched = scratch.touched;
    d->known_blocks = scratch.known_blocks;
    d->odometer_capacity = d->touched_capacity = bodies + 1;
    d->known_block_capacity = blocks + 1;
    d->known_block_count = blocks;
    d->any_touched = true;
    tl_contacts_unlist(d);
    return TL_OK;
}

/* ---------------------------------------------------------------- laws ------------------- */

/* Whether a contact's press lacks the volumes that its law asks for now. */
static bool lacks_volumes(const tl_model *m, uint32_t row, uint32_t law)
{
    const tl_press_row *press = tl_press_row_of(m, row);
    return press && !press->press.powers && law != TL_NO_ROW && tl_law_presses(&m->joint_laws[law]);
}

/* Contacts under another joint law belong in another span. */
static void find_laws(tl_model *m)
{
    tl_contacts *c = &m->detect->contacts;
    for (uint32_t row = 0; row < c->table.rows; row++) {
        if (c->pending[row] == TL_PENDING_DIE)
            continue;
        uint32_t law = tl_law_row(m, c->tag[row]);
        if (c->pending[row] == TL_PENDING_NONE && law != c->law[row])
            c->pending[row] = TL_PENDING_MOVE;
        if (lacks_volumes(m, row, law))
            c->points_valid_to[row] = TL_OUTDATED;
    }
}

/* Whether a contact that is a patch remains one whatever the minimum area was before. */
static bool stays_patch(const tl_model *m, uint32_t row)
{
    const tl_contacts *c = &m->detect->contacts;
    if (c->point_count[row] == 0 || tl_facet_is_field(&c->facet[row]))
        return false;
    tl_min_area_rule rule = tl_min_area_of(m, c->tag[row]);
    double mean = fmin(m->blocks.mean_face[c->a[row]], m->blocks.mean_face[c->b[row]]);
    double min_area = isnan(rule.absolute) ? rule.fraction * mean : rule.absolute;
    return min_area <= SURE_MIN_AREA * c->area[row];
}

/* Pairs that touch without area are tested again, but for those that have nothing in common. */
static void wake_pairs(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)thread;
    tl_model *m = user;
    tl_detect *d = m->detect;
    for (uint32_t i = (uint32_t)begin; i < end; i++) {
        tl_pair *p = &d->pairs[i];
        tl_pair_faces faces = tl_pair_faces_of(p);
        if (!tl_pair_is_apart(p) || faces.one == faces.other) {
            tl_pair_wake(d, i);
            continue;
        }
        tl_pair_view view = tl_pair_view_of(m, p->a, p->b);
        if (!tl_grazing_only_touches(&view, p)) {
            tl_pair_wake(d, i);
            continue;
        }
        tl_pair_forget_faces(p);
        tl_pair_sleep(d, p, TL_STILL * view.size);
        if (p->wake < d->chunks[chunk].wake)
            d->chunks[chunk].wake = p->wake;
    }
}

/* Under another minimum area contacts that are no patches, or too small ones, are made anew, and pairs that only touched are
 * looked at again; under another rule for the points of patches, all are made anew. */
static void find_rules(tl_model *m)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    bool all = d->contact_points != m->config.contact_points;
    tl_parallel_for(m->pool, d->pair_count, TL_PAIR_CHUNK, wake_pairs, m);
    for (uint32_t row = 0; row < c->table.rows; row++) {
        if (c->pending[row] == TL_PENDING_DIE)
            continue;
        bool patch = stays_patch(m, row);
        if (all || !patch)
            c->points_valid_to[row] = TL_OUTDATED;
        if (!patch && tl_facet_is_patch(&c->facet[row]))
            c->faces_valid_to[row] = TL_OUTDATED;
    }
}

/* Marks the contacts that come under another joint law, and those whose facets follow other rules than they did. */
static void edited_laws(tl_model *m)
{
    tl_detect *d = m->detect;
    if (d->rules != m->rules) /* before contacts note the room they want in the place of faces */
        find_rules(m);
    if (d->laws != m->laws)
        find_laws(m);
}

/* ---------------------------------------------------------------- frames ----------------- */

static void reframe_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    tl_model *m = user;
    const tl_contacts *c = &m->detect->contacts;
    for (uint32_t row = (uint32_t)begin; row < end; row++)
        if (c->pending[row] != TL_PENDING_DIE &&
            (tl_block_is_new(m, c->a[row]) || tl_block_is_new(m, c->b[row])))
            tl_contact_reframe(m, row, thread);
}

/* Makes anew what contacts keep in the frames of bodies that have changed, before anything is computed from it. */
static void edited_frames(tl_model *m)
{
    tl_parallel_for(m->pool, m->detect->contacts.table.rows, CONTACT_CHUNK, reframe_range, m);
}

/* ---------------------------------------------------------------- phases ----------------- */

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
            tl_simd_group_prefetch_contacts(job->m->detect, &job->groups[r + FAR_AHEAD]);
        if (alike && r + AHEAD < job->count)
            tl_simd_group_prefetch_shapes(job->m, &job->groups[r + AHEAD]);
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
        update_job job = {m, layout->groups + span->group_begin,
                          span->group_end - span->group_begin};
        tl_parallel_for(m->pool, span->group_end - span->group_begin, GROUP_CHUNK, update_groups,
                        &job);
    }
    if (m->detect->any_without_rows)
        tl_parallel_for(m->pool, m->detect->contacts.table.rows, CONTACT_CHUNK, update_others, m);
}

/* Pairs that overlap deeply when their contact is made. */
typedef struct overlaps {
    size_t count;
    uint32_t pair; /* the first */
} overlaps;

/* Size of the smaller one of a pair's bodies, m. */
static double size_of_bodies(const tl_model *m, const tl_pair *pair)
{
    return fmin(tl_body_size(m, m->blocks.body[pair->a]), tl_body_size(m, m->blocks.body[pair->b]));
}

/* Makes the contact of a pair that has come near; its overlap is noted when it is deep. */
static tl_status give_birth(tl_model *m, uint32_t pair, overlaps *deep)
{
    tl_detect *d = m->detect;
    tl_narrow_scratch *scratch = &d->narrow[0];
    tl_pair_view view = tl_pair_view_of(m, d->pairs[pair].a, d->pairs[pair].b);
    if (!tl_pair_place(&view, scratch))
        return tl_fail_memory(&m->error);
    const tl_manifold_before before = tl_pair_before(m, &d->pairs[pair], &view, scratch);
    tl_region region;
    if (!tl_region_find(&view, TL_LIST_MARGIN * view.size + before.shift, scratch, &region))
        return tl_fail_memory(&m->error);
    tl_tag tag = tl_touching_tag(&view, region.n);
    tl_touch_rule rule = tl_touch_rule_of(m, &view, tag, before.over);
    const tl_manifold *g = &scratch->manifold;
    if (!tl_kind_find(m, d->pairs[pair].a, d->pairs[pair].b, &view, &region, &rule, &before,
                      scratch) ||
        !tl_contact_append(m, pair, g->facet.kind, g->valid, tag, g->point_count))
        return tl_fail_memory(&m->error);
    uint32_t row = (uint32_t)d->contacts.table.rows - 1;
    if (before.holds) { /* so that it is found once more when it has got its room */
        d->contacts.facet[row] = g->facet;
        d->contacts.holds_over_gap[row] = true;
    }
    double overlap = tl_facet_is_field(&g->facet) ? g->press->deepest : -region.gap;
    /* parts of blocks go on in the overlap of these */
    bool meet = !tl_cut_contact_of(m, d->pairs[pair].a, d->pairs[pair].b);
    if (meet && overlap > TL_SHALLOW * view.size &&
        overlap > TL_SHALLOW * size_of_bodies(m, &d->pairs[pair]) && deep->count++ == 0)
        deep->pair = pair;
    if (tl_overlap_is_deep(m, &view, &region, d->pairs[pair].a, d->pairs[pair].b, meet)) {
        tl_overlap_mark(&d->contacts, row, meet);
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
        for (uint32_t i = begin;
             d->chunks[chunk].found && i < begin + TL_PAIR_CHUNK && i < d->pair_count; i++) {
            if (!tl_pair_is_apart(&d->pairs[i]) || d->pairs[i].wake != TL_PAIR_FOUND)
                continue;
            tl_status status = give_birth(m, i, &deep);
            if (status != TL_OK)
                return status;
            ++*born;
        }
        d->chunks[chunk].found = false;
    }
    if (deep.count && tl_model_says(m, TL_REMARK_OVERLAP))
        tl_model_say(
            m,
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
    uint32_t old = d->contacts.law[c], law = tl_law_row(m, d->contacts.tag[c]);
    d->contacts.law[c] = law;
    const tl_kind *kind = tl_law_kind(m, law);
    if (old != TL_NO_ROW && m->joint_laws[old].kind == kind)
        return;
    tl_contact_begin_law(m, c, kind, &d->lanes[0]);
}

/* Notes that the contacts of two bodies are no longer what they were. Of those that ended with their blocks it was noted when
 * rows were found. */
static void touch(tl_model *m, uint32_t row)
{
    tl_detect *d = m->detect;
    if (d->rows_changed && d->contacts.pending[row] == TL_PENDING_DIE)
        return;
    d->any_touched = true;
    d->touched[m->blocks.body[d->contacts.a[row]]] = true;
    d->touched[m->blocks.body[d->contacts.b[row]]] = true;
}

/* Takes out the dead and finds room for those that are new or have grown; false when there is none. Backward,
 * for the last contact takes the row of one that goes. */
static bool settle_rows(tl_model *m)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    bool enough = true;
    for (uint32_t row = (uint32_t)c->table.rows; row-- > 0;) {
        if (c->pending[row] == TL_PENDING_NONE)
            continue;
        uint32_t pair = c->pair[row];
        if (!tl_pending_waits(
                c->pending[row])) /* others are noted when they have got their points */
            touch(m, row);
        if (c->pending[row] == TL_PENDING_DIE) {
            d->parted += tl_contact_sheared(m, row) + c->released[row];
            tl_contact_remove(d, row);
            tl_pair_parted(d, pair);
            continue;
        }
        if (c->pending[row] == TL_PENDING_MOVE) {
            d->pairs[pair].want_points = c->point_capacity[row];
        }
        if (tl_law_row(m, c->tag[row]) != c->law[row])
            change_law(m, row);
        enough = enough && tl_contact_place(d, row);
    }
    return enough;
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

/* Whether there was no memory to look at some pair or to bring some contact up to date; it is as it was, for another time. */
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
    tl_contacts *c = &d->contacts;
    size_t born = 0;
    tl_contacts_free_spare(d, m->cycles);
    tl_status status = lacked_memory(d) ? tl_fail_memory(&m->error) : give_births(m, &born);
    if (status != TL_OK)
        return status;
    if (born == 0 && !d->rows_changed && !some_pending(c))
        return TL_OK;
    d->any_without_rows = true; /* until they are listed anew */
    for (bool more = true; more && status == TL_OK;) {
        if (!settle_rows(m))
            status = tl_contacts_repack(m);
        else if (!tl_contacts_index(m))
            status = tl_fail_memory(&m->error);
        if (status == TL_OK)
            status = fill_contacts(m, &more);
        d->rows_changed =
            status != TL_OK; /* contacts are not what they seem until all is settled */
    }
    if (status == TL_OK) {
        tl_cut_contacts_balance(m);
        d->rows_changed = !tl_cut_parts_correct(m);
        if (d->rows_changed)
            return tl_fail_memory(&m->error);
        tl_cut_contacts_sum(m);
        tl_cut_contacts_end(d);
    }
    return status;
}

static tl_status settle_named(tl_model *m)
{
    tl_status status = settle(m);
    return status == TL_OK && !tl_asked_name(m) ? tl_fail_memory(&m->error) : status;
}

/* Pairs and contacts after edits of the model, and new contacts; those that stand are not touched. */
static tl_status find_contacts(tl_model *m)
{
    tl_rows_tidy(m);
    tl_status status = ensure(m);
    if (status != TL_OK)
        return status;
    tl_detect *d = m->detect;
    bool rows = d->structure != m->structure || !d->listed;
    if (rows) {
        d->rows_changed = true;
        status = edited_rows(m);
        if (status != TL_OK)
            return status;
    }
    tl_pairs_measure_paths(m);
    edited_laws(m);
    if (rows)
        edited_frames(m);
    if (rows && lacked_memory(d))
        return tl_fail_memory(&m->error);
    if (rows || d->laws != m->laws || d->constraints != m->constraints)
        tl_held_sort(m);
    if (!d->listed || (double)d->longest_path > d->reach)
        status = tl_broad_update(m);
    else if (rows)
        status = tl_broad_add(m);
    if (status != TL_OK)
        return status;
    d->structure = m->structure;
    d->laws = m->laws;
    d->rules = m->rules;
    d->contact_points = m->config.contact_points;
    d->constraints = m->constraints;
    tl_pairs_test(m);
    return TL_OK;
}

tl_status tl_detect_refresh(tl_model *m)
{
    tl_rows_tidy(m);
    const tl_detect *d = m->detect;
    bool listed =
        d && !d->rows_changed && d->indexed == d->contacts.table.rows; /* no step failed */
    bool ruled = m->found_for != TL_FOR_QUERIES || !d ||
                 (d->rules == m->rules && d->contact_points == m->config.contact_points);
    if (listed && ruled && d->structure == m->structure && d->laws == m->laws)
        return TL_OK;
    tl_status status = tl_asked_begin(m);
    if (status == TL_OK)
        status = find_contacts(m);
    return status == TL_OK ? settle_named(m) : status;
}

tl_status tl_detect_update(tl_model *m)
{
    tl_rows_tidy(m);
    tl_asked_end(m);
    tl_status status = find_contacts(m);
    if (status != TL_OK)
        return status;
    update_contacts(m);
    status = settle_named(m);
    if (status == TL_OK)
        m->cut_part_count = 0; /* contacts know them now */
    return status;
}
