/* detect.c - the order of contact detection, and the update of one pair and one contact.
 *
 * Phases: rows that changed are found again by id; the broad phase is made anew when something may
 * have left its skin; pairs without a contact are looked at when they may have come near; contacts are
 * followed, or made anew when they moved more than a margin; births, deaths and growth are then settled
 * serially in the order of pairs. How far anything can have moved is told by the bodies' odometers. */
#include "detect/detect.h"

#include <stdlib.h>
#include <string.h>

/* Motion within which facets and areas are reused, relative to the smaller block's size: areas are
 * then wrong by a few 1e-6 at most; gaps are exact all the same. */
#define REUSE 1e-6
/* A point of a tilted patch stays on A until the patch is made anew, wherever the feature that made it goes:
 * the error of its gap is the motion times the tilt, and may be this share of the gap. */
#define GAP_SHARE 1e-4
/* The axis is searched anew after motion of half its lead over the next one, or this share of |s|, ... */
#define AXIS_SHARE 0.25
/* ... but at the latest after this times the size. */
#define AXIS_MOST 0.02
/* Motion within which a pair that touches without area is not looked at again, relative to the size: the
 * share of its faces that may have come into contact unseen. */
#define SILENT 1e-5

/* Overlap of a new contact, relative to the smaller block's size, of which the user is told: blocks that
 * were placed into each other, or that a step has thrown into each other. */
#define DEEP 1e-2

/* Rows a worker takes at a time. */
#define PAIR_CHUNK 256
#define CONTACT_CHUNK 64

static void narrow_free(tl_narrow *n)
{
    free(n->vertex_b);
    free(n->normal_b);
    free(n->dots);
    free(n->manifold.facets);
    free(n->manifold.points);
    free(n->old);
    free(n->value);
    tl_polygon_free(n->polygon);
}

static void detect_destroy(tl_detect *d)
{
    tl_broad_destroy(d->broad);
    tl_table_free(&d->contacts.table);
    tl_table_free(&d->spare.table);
    tl_table_free(&d->points.table);
    tl_table_free(&d->spare_points.table);
    for (unsigned i = 0; i < d->threads; i++) {
        narrow_free(&d->narrow[i]);
        tl_table_free(&d->lanes[i].table);
    }
    free(d->narrow);
    free(d->lanes);
    free(d->moving);
    free(d->points.owner);
    free(d->spare_points.owner);
    free(d->contacts.facet);
    free(d->spare.facet);
    free(d->pairs);
    free(d->odometer_0);
    free(d->runs);
    free(d->by_block);
    free(d->by_block_start);
    free(d->by_id);
    free(d);
}

static tl_status ensure(tl_model *m)
{
    if (m->detect)
        return TL_OK;
    tl_detect *d = calloc(1, sizeof *d);
    if (!d)
        return tl_fail_memory(&m->error);
    d->threads = tl_pool_threads(m->pool);
    d->narrow = calloc(d->threads, sizeof *d->narrow);
    d->lanes = calloc(d->threads, sizeof *d->lanes);
    if (!d->narrow || !d->lanes) {
        free(d->narrow);
        free(d->lanes);
        free(d);
        return tl_fail_memory(&m->error);
    }
    for (unsigned i = 0; i < d->threads; i++)
        tl_point_lanes_init(&d->lanes[i]);
    tl_contacts_init(&d->contacts, &d->points);
    tl_contacts_init(&d->spare, &d->spare_points);
    m->detect = d;
    m->detect_destroy = detect_destroy;
    return TL_OK;
}

/* ---------------------------------------------------------------- rows ------------------- */

/* Finds the blocks of contacts and pairs again after rows have changed. Pairs without a contact are
 * forgotten: the broad phase lists them anew. */
static void find_rows(tl_model *m)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    size_t kept = 0;
    for (size_t i = 0; i < d->pair_count; i++) {
        tl_pair p = d->pairs[i];
        if (p.contact == TL_NO_ROW)
            continue;
        uint32_t row = p.contact;
        uint32_t a = tl_block_row_quiet(m, c->id_a[row]), b = tl_block_row_quiet(m, c->id_b[row]);
        if (a == TL_NO_ROW || b == TL_NO_ROW || m->blocks.body[a] == m->blocks.body[b]) {
            c->fate[row] = TL_FATE_DIE;
            continue;
        }
        p.a = c->a[row] = a;
        p.b = c->b[row] = b;
        c->pair[row] = (uint32_t)kept;
        d->pairs[kept++] = p;
    }
    d->pair_count = kept;
}

/* After a change of laws or of the minimum area: contacts under another material are marked, and all
 * facets are made anew in the next step. */
static void find_materials(tl_model *m)
{
    tl_contacts *c = &m->detect->contacts;
    for (uint32_t row = 0; row < c->table.rows; row++) {
        c->until[row] = -INFINITY;
        if (c->fate[row] == TL_FATE_KEEP && tl_material_row(m, c->tag[row]) != c->material[row])
            c->fate[row] = TL_FATE_MATERIAL;
    }
}

static bool left_skin(const tl_model *m)
{
    const tl_detect *d = m->detect;
    for (size_t body = 0; body < m->bodies.table.rows; body++)
        if (m->bodies.odometer[body] - d->odometer_0[body] > d->reach)
            return true;
    return false;
}

/* ---------------------------------------------------------------- geometry --------------- */

/* The rule of the point share for a pair of a joint; pairs that carry a force across a gap
 * keep all their points. */
static tl_share_rule share_rule(const tl_model *m, const tl_pair_view *view, tl_tag tag,
                                bool across)
{
    tl_area_rule rule = tl_area_rule_of(m, tag);
    double tolerance = TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * view->size;
    bool absolute = !isnan(rule.absolute);
    return (tl_share_rule){.minimum = absolute ? rule.absolute : rule.fraction * view->mean_face,
                           .unconditional = absolute,
                           .corners = m->config.contact_points == TL_POINTS_CORNERS,
                           .reach = across ? INFINITY : tolerance};
}

/* How far a pair may run before its axis is searched again. */
static double axis_margin(const tl_axis *axis, double size)
{
    double lead = 0.5 * (axis->s - axis->second);
    return fmin(fmax(lead, AXIS_SHARE * fabs(axis->s)), AXIS_MOST * size);
}

static void look_at(tl_model *m, tl_pair *p, tl_narrow *room)
{
    p->found = false;
    double odometer = tl_pair_odometer(m, p->a, p->b);
    if (p->contact != TL_NO_ROW || odometer < p->wake)
        return;
    tl_pair_view view = tl_pair_view_of(m, p->a, p->b);
    if (!tl_pair_place(&view, room)) {
        room->failed = true;
        return;
    }
    double tolerance = TL_CONTACT_TOLERANCE * view.size, reach = m->detect->reach;
    if (!tl_look_near(&view, tolerance + reach)) {
        p->wake = odometer + reach;
        return;
    }
    tl_axis axis = tl_axis_search(&view, room, NULL);
    if (axis.s > tolerance) {
        p->wake = odometer + (axis.s - tolerance);
        return;
    }
    tl_share_rule rule = share_rule(m, &view, tl_touching_tag(&view, axis.n), false);
    tl_manifold_build(&view, &axis, &rule, room);
    room->failed = room->failed || room->manifold.failed;
    p->found = room->manifold.point_count > 0;
    p->wake = odometer + SILENT * view.size;
}

/* Whether some point carries a force across a gap: a bond in tension, or an initial stress not yet relieved.
 * Such a contact ends only with that force. */
static bool carries_across(const tl_detect *d, uint32_t c)
{
    const tl_points_table *p = &d->points;
    size_t begin = d->contacts.point_start[c];
    for (size_t i = begin; i < begin + d->contacts.point_count[c]; i++)
        if (p->f_n[i] < 0 || (p->f_n[i] > 0 && p->closure[i] + p->reference[i] < 0))
            return true;
    return false;
}

static bool same_topology(const tl_detect *d, uint32_t c, const tl_manifold *g)
{
    const tl_contacts *contacts = &d->contacts;
    if (contacts->point_count[c] != g->point_count || contacts->facet_count[c] != g->facet_count)
        return false;
    for (size_t k = 0; k < g->facet_count; k++) {
        const tl_facet *f = &contacts->facet[contacts->facet_start[c] + k], *h = &g->facets[k];
        if (f->kind != h->kind || f->ia != h->ia || f->ib != h->ib || f->count != h->count)
            return false;
    }
    for (size_t k = 0; k < g->point_count; k++)
        if (d->points.key[contacts->point_start[c] + k] != g->points[k].key)
            return false;
    return true;
}

/* New places and areas of the same points: stresses stay, forces follow the area. */
static void refit(tl_model *m, uint32_t c, const tl_manifold *g)
{
    tl_detect *d = m->detect;
    tl_points_table *p = &d->points;
    tl_facet *facet = &d->contacts.facet[d->contacts.facet_start[c]];
    for (size_t k = 0; k < g->facet_count; k++) {
        tl_vec3 last = facet[k].last, last_lean = facet[k].last_lean;
        facet[k] = g->facets[k];
        facet[k].last = last;
        facet[k].last_lean = last_lean;
    }
    uint32_t material = d->contacts.material[c];
    const tl_kind *kind = material == TL_NO_ROW ? NULL : m->materials[material].kind;
    for (size_t k = 0; k < g->point_count; k++) {
        size_t i = d->contacts.point_start[c] + k;
        double old = p->area[i], scale = g->points[k].area / old;
        double state[TL_STATE_COLUMNS];
        tl_columns_put(p->p, i, g->points[k].p);
        p->rest[i] = g->points[k].rest;
        p->lean[i] = g->points[k].lean;
        p->area[i] = g->points[k].area;
        if (scale == 1)
            continue;
        p->f_n[i] *= scale;
        p->f_n0[i] *= scale;
        for (int s = 0; s < 3; s++)
            p->f_s[s][i] *= scale;
        if (kind && kind->state_count) {
            for (int s = 0; s < TL_STATE_COLUMNS; s++)
                state[s] = p->state[s][i];
            tl_point_keep_state(p, i, kind, state, old);
        }
    }
}

/* The contact's facets in the present place, by its axis followed or searched. false: out of memory. */
static bool rebuild(tl_model *m, uint32_t c, tl_narrow *room, bool across)
{
    tl_contacts *contacts = &m->detect->contacts;
    double odometer = tl_pair_odometer(m, contacts->a[c], contacts->b[c]);
    tl_pair_view view = tl_pair_view_of(m, contacts->a[c], contacts->b[c]);
    tl_axis axis = contacts->axis[c];
    if (!tl_pair_place(&view, room))
        return false;
    bool search =
        !m->config.reuse_geometry || odometer - contacts->searched[c] > contacts->margin[c];
    for (;; search = true) {
        bool followed = !search && tl_axis_follow(&view, &axis);
        if (search) {
            axis = tl_axis_search(&view, room, &contacts->axis[c]);
            contacts->searched[c] = odometer;
            contacts->margin[c] = axis_margin(&axis, view.size);
        }
        tl_tag tag = tl_touching_tag(&view, axis.n);
        tl_share_rule rule = share_rule(m, &view, tag, across);
        tl_manifold_build(&view, &axis, &rule, room);
        if (room->manifold.failed)
            return false;
        if (!search && !followed && !(room->manifold.patch_area > 0))
            continue; /* what touched has parted: look at all features */
        contacts->axis[c] = axis;
        if (tag.joint != contacts->tag[c].joint || tag.plane != contacts->tag[c].plane) {
            contacts->tag[c] = tag;
            uint32_t material = tl_material_row(m, tag);
            if (material != contacts->material[c])
                contacts->fate[c] = TL_FATE_MATERIAL;
        }
        /* a pair that touches without area stays a contact, so that it need not be born again */
        if (axis.s > TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * view.size && !across) {
            contacts->fate[c] = TL_FATE_DIE;
            m->detect->pairs[contacts->pair[c]].wake =
                odometer + axis.s - TL_CONTACT_TOLERANCE * view.size;
        }
        return true;
    }
}

/* Puts the built manifold in the place of the contact's points, or asks for room. */
static bool take_manifold(tl_model *m, uint32_t c, tl_narrow *room, const tl_point_lanes *lanes)
{
    tl_detect *d = m->detect;
    tl_contacts *contacts = &d->contacts;
    const tl_manifold *g = &room->manifold;
    contacts->area[c] = 0;
    for (size_t k = 0; k < g->point_count; k++)
        contacts->area[c] += g->points[k].area;
    if (same_topology(d, c, g)) {
        refit(m, c, g);
        return true;
    }
    if (g->point_count > contacts->point_room[c] || g->facet_count > contacts->facet_room[c]) {
        contacts->want_points[c] = (uint32_t)g->point_count;
        contacts->want_facets[c] = (uint32_t)g->facet_count;
        contacts->fate[c] = TL_FATE_GROW;
        return true;
    }
    return tl_contact_transfer(m, c, room, lanes);
}

/* How far a contact whose facets have just been made may move before they are made anew. */
static void allow_reuse(tl_model *m, uint32_t c, double tilt)
{
    tl_contacts *contacts = &m->detect->contacts;
    double size = fmin(m->blocks.size[contacts->a[c]], m->blocks.size[contacts->b[c]]);
    double most = (contacts->point_count[c] ? REUSE : SILENT) * size;
    if (tilt > 0) {
        double gap = INFINITY;
        for (size_t i = contacts->point_start[c];
             i < contacts->point_start[c] + contacts->point_count[c]; i++)
            gap = fmin(gap, -(m->detect->points.closure[i] + m->detect->points.reference[i]));
        most = fmin(most, GAP_SHARE * fabs(gap) / tilt);
    }
    contacts->until[c] = tl_pair_odometer(m, contacts->a[c], contacts->b[c]) + most;
}

static void update_contact(tl_model *m, uint32_t c, tl_narrow *room, const tl_point_lanes *lanes)
{
    tl_contacts *contacts = &m->detect->contacts;
    if (contacts->fate[c] == TL_FATE_DIE)
        return;
    double odometer = tl_pair_odometer(m, contacts->a[c], contacts->b[c]);
    if (!m->config.reuse_geometry || odometer > contacts->until[c]) {
        bool across = carries_across(m->detect, c);
        if (!rebuild(m, c, room, across) ||
            (contacts->fate[c] != TL_FATE_DIE && !take_manifold(m, c, room, lanes))) {
            contacts->fate[c] = TL_FATE_MEMORY;
            return;
        }
        allow_reuse(m, c, room->manifold.tilt);
    }
}

/* ---------------------------------------------------------------- phases ----------------- */

static void look_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    tl_model *m = user;
    for (size_t i = begin; i < end; i++)
        look_at(m, &m->detect->pairs[i], &m->detect->narrow[thread]);
}

static void update_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    tl_model *m = user;
    for (size_t c = begin; c < end; c++)
        update_contact(m, (uint32_t)c, &m->detect->narrow[thread], &m->detect->lanes[thread]);
}

/* Bodies that were joined or parted have other frames than before: what contacts keep in them is made
 * anew, before anything is computed from it. */
static void reframe_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    tl_model *m = user;
    tl_contacts *contacts = &m->detect->contacts;
    tl_narrow *room = &m->detect->narrow[thread];
    for (uint32_t c = (uint32_t)begin; c < end; c++) {
        if (contacts->fate[c] == TL_FATE_DIE)
            continue;
        contacts->searched[c] = -INFINITY;
        room->reframed = true;
        if (!rebuild(m, c, room, carries_across(m->detect, c)) ||
            (contacts->fate[c] != TL_FATE_DIE &&
             !take_manifold(m, c, room, &m->detect->lanes[thread])))
            contacts->fate[c] = TL_FATE_MEMORY;
        room->reframed = false;
    }
}

/* Builds the facets of a contact that has just been given its room. */
static bool fill_contact(tl_model *m, uint32_t c, tl_narrow *room)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_pair_view view = tl_pair_view_of(m, contacts->a[c], contacts->b[c]);
    if (!tl_pair_place(&view, room))
        return false;
    if (contacts->point_count[c] == 0)
        contacts->margin[c] = axis_margin(&contacts->axis[c], view.size);
    tl_share_rule rule = share_rule(m, &view, contacts->tag[c], carries_across(m->detect, c));
    tl_manifold_build(&view, &contacts->axis[c], &rule, room);
    contacts->area[c] = 0;
    for (size_t k = 0; k < room->manifold.point_count; k++)
        contacts->area[c] += room->manifold.points[k].area;
    if (room->manifold.failed || !tl_contact_transfer(m, c, room, &m->detect->lanes[0]))
        return false;
    allow_reuse(m, c, room->manifold.tilt);
    return true;
}

/* Pairs that overlap deeply when their contact is made. */
typedef struct overlaps {
    size_t count;
    uint32_t pair; /* the first */
} overlaps;

/* Contacts of the pairs that have come near. */
static tl_status give_birth(tl_model *m, size_t *born)
{
    tl_detect *d = m->detect;
    tl_narrow *room = &d->narrow[0];
    overlaps deep = {0, 0};
    *born = 0;
    for (uint32_t i = 0; i < d->pair_count; i++) {
        tl_pair *p = &d->pairs[i];
        if (p->contact != TL_NO_ROW || !p->found)
            continue;
        tl_pair_view view = tl_pair_view_of(m, p->a, p->b);
        if (!tl_pair_place(&view, room))
            return tl_fail_memory(&m->error);
        tl_axis axis = tl_axis_search(&view, room, NULL);
        tl_tag tag = tl_touching_tag(&view, axis.n);
        tl_share_rule rule = share_rule(m, &view, tag, false);
        tl_manifold_build(&view, &axis, &rule, room);
        const tl_manifold *g = &room->manifold;
        if (g->failed || !tl_contact_append(m, i, &axis, tag, g->point_count, g->facet_count))
            return tl_fail_memory(&m->error);
        p->found = false;
        ++*born;
        if (axis.s < -DEEP * view.size && deep.count++ == 0)
            deep.pair = i;
    }
    if (deep.count)
        tl_model_say(
            m,
            "%zu pair%s of blocks (first: blocks %u and %u) overlap%s by more than %g of their "
            "size when they come into contact: they will be pushed apart by that much",
            deep.count, deep.count == 1 ? "" : "s", m->blocks.id[d->pairs[deep.pair].a],
            m->blocks.id[d->pairs[deep.pair].b], deep.count == 1 ? "s" : "", DEEP);
    return TL_OK;
}

/* A contact that comes under another law begins with that law's states; under the same law with other
 * properties it keeps them. */
static void change_material(tl_model *m, uint32_t c)
{
    tl_detect *d = m->detect;
    uint32_t old = d->contacts.material[c], material = tl_material_row(m, d->contacts.tag[c]);
    d->contacts.material[c] = material;
    const tl_kind *kind = material == TL_NO_ROW ? NULL : m->materials[material].kind;
    if (old != TL_NO_ROW && m->materials[old].kind == kind)
        return;
    size_t begin = d->contacts.point_start[c];
    for (size_t i = begin; i < begin + d->contacts.point_count[c]; i++) {
        d->points.flags[i] = 0;
        tl_point_initial_state(&d->points, i, kind);
    }
}

/* Takes out the dead and finds room for those that are new or have grown; false when there is none. Backward,
 * for the last contact takes the row of one that goes. */
static bool settle_rows(tl_model *m)
{
    tl_contacts *c = &m->detect->contacts;
    bool room = true;
    for (uint32_t row = (uint32_t)c->table.rows; row-- > 0;) {
        if (c->fate[row] == TL_FATE_KEEP)
            continue;
        if (c->fate[row] == TL_FATE_DIE) {
            tl_contact_remove(m->detect, row);
            continue;
        }
        if (c->fate[row] == TL_FATE_MATERIAL) {
            c->want_points[row] = c->point_room[row];
            c->want_facets[row] = c->facet_room[row];
        }
        if (tl_material_row(m, c->tag[row]) != c->material[row])
            change_material(m, row);
        room = room && tl_contact_place(m->detect, row);
    }
    return room;
}

/* Builds the facets of the contacts that have been given their room. */
static tl_status fill_contacts(tl_model *m)
{
    tl_contacts *c = &m->detect->contacts;
    for (uint32_t row = 0; row < c->table.rows; row++) {
        if (c->fate[row] == TL_FATE_GROW) {
            if (!fill_contact(m, row, &m->detect->narrow[0]))
                return tl_fail_memory(&m->error);
        }
        c->fate[row] = TL_FATE_KEEP;
    }
    return TL_OK;
}

/* Births, deaths, growth and changes of material, in the order of pairs. */
static tl_status settle(tl_model *m)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    size_t changed;
    for (unsigned i = 0; i < d->threads; i++)
        if (d->narrow[i].failed) {
            d->narrow[i].failed = false;
            return tl_fail_memory(&m->error);
        }
    tl_status status = give_birth(m, &changed);
    if (status != TL_OK)
        return status;
    for (uint32_t row = 0; row < c->table.rows; row++) {
        if (c->fate[row] == TL_FATE_MEMORY)
            return tl_fail_memory(&m->error);
        changed += c->fate[row] != TL_FATE_KEEP;
    }
    if (changed == 0 && !d->rows_changed)
        return TL_OK;
    d->changes++;
    if (!settle_rows(m))
        status = tl_contacts_repack(m);
    else if (!tl_contacts_index(m))
        status = tl_fail_memory(&m->error);
    d->rows_changed = status != TL_OK;
    return status == TL_OK ? fill_contacts(m) : status;
}

/* Pairs and contacts after a change of rows or laws, and new contacts; those that stand are not
 * touched. */
static tl_status find_contacts(tl_model *m)
{
    tl_status status = ensure(m);
    if (status != TL_OK)
        return status;
    tl_detect *d = m->detect;
    bool rows = d->structure != m->structure || !d->broad;
    if (rows) {
        d->rows_changed = true;
        find_rows(m);
        tl_parallel_for(m->pool, d->contacts.table.rows, CONTACT_CHUNK, reframe_range, m);
    }
    if (d->laws != m->laws)
        find_materials(m);
    if (rows || left_skin(m)) {
        status = tl_broad_update(m);
        if (status != TL_OK)
            return status;
    }
    d->structure = m->structure;
    d->laws = m->laws;
    tl_parallel_for(m->pool, d->pair_count, PAIR_CHUNK, look_range, m);
    return TL_OK;
}

tl_status tl_detect_refresh(tl_model *m)
{
    if (m->detect && m->detect->structure == m->structure && m->detect->laws == m->laws)
        return TL_OK;
    tl_status status = find_contacts(m);
    return status == TL_OK ? settle(m) : status;
}

tl_status tl_detect_update(tl_model *m)
{
    tl_status status = find_contacts(m);
    if (status != TL_OK)
        return status;
    tl_parallel_for(m->pool, m->detect->contacts.table.rows, CONTACT_CHUNK, update_range, m);
    if (!tl_grow(&m->detect->moving, &m->detect->moving_room, m->bodies.table.rows,
                 sizeof *m->detect->moving))
        return tl_fail_memory(&m->error);
    return settle(m);
}
