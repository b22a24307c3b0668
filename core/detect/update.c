/* update.c - one contact brought up to the present place of its blocks: its axis, its facets and points.
 *
 * Most contacts are two faces on each other and stay so: while the axis is certain and no other faces look
 * at each other, the patch alone is made anew, several at once (renew.c). Otherwise everything is looked
 * at that could touch (rebuild). */
#include "detect/update.h"

#include "base/columns.h"
#include "contact/contacts.h"
#include "contact/pair_view.h"
#include "contact/points.h"
#include "contact/transfer.h"
#include "detect/beside.h"
#include "detect/overlap.h"
#include "detect/pairs.h"
#include "narrow/manifold.h"

/* Motion within which facets and areas are reused, relative to the smaller block's size: areas are
 * then wrong by a few 1e-6 at most; gaps are exact all the same. */
#define REUSE 1e-6
/* The same for areas that depend on a gap, over as little as TL_CONTACT_TOLERANCE: wrong by a few 1e-5. */
#define REUSE_BRIEF 5e-8
/* The axis is searched anew after motion of half its lead over the next one, or this share of |s|, ... */
#define AXIS_SHARE 0.05
/* ... but at the latest after this times the size. */
#define AXIS_MOST 0.02
/* The same where patches have less than the minimum area: flush ones that sink in get a point share (SHALLOW_* in
 * manifold.c), of which this is a share that no result shows. */
#define SINK_MOST 5e-4

double tl_axis_margin(const tl_axis *axis, double size)
{
    double lead = 0.5 * (axis->s - axis->second);
    return fmin(fmax(lead, AXIS_SHARE * fabs(axis->s)), AXIS_MOST * size);
}

/* Looks again soon at a contact that has just been built as one small patch. */
static void watch_small(tl_model *m, uint32_t c, const tl_pair_view *view,
                        const tl_share_rule *rule, const tl_manifold *g)
{
    tl_contacts *contacts = &m->detect->contacts;
    double odometer = tl_pair_odometer(m, contacts->a[c], contacts->b[c]);
    if (g->lone && g->facet_count == 1 && g->patch_area < rule->minimum)
        contacts->search[c] = fmin(contacts->search[c], odometer + SINK_MOST * view->size);
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
        if (d->points.key[tl_point_row(contacts, c, k)] != g->points[k].key)
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
    const tl_kind *kind = NULL; /* of states that go with the area */
    if (material != TL_NO_ROW && m->materials[material].splits)
        kind = m->materials[material].kind;
    for (size_t k = 0; k < g->point_count; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        double old = p->area[i], scale = g->points[k].area / old;
        double state[TL_STATE_COLUMNS];
        tl_columns_put(p->p, i, g->points[k].p);
        tl_point_set_lean(p, i, g->points[k].lean);
        p->area[i] = g->points[k].area;
        if (scale == 1)
            continue;
        p->f_n[i] *= scale;
        if (p->f_n0)
            p->f_n0[i] *= scale;
        for (int s = 0; s < 3; s++)
            p->f_s[s][i] *= scale;
        if (kind) {
            for (uint32_t s = 0; s < p->state_columns; s++)
                state[s] = p->state[s][i];
            tl_point_keep_state(p, i, kind, state, old);
        }
    }
}

/* Ends a contact whose blocks have parted along an axis. */
static void part(tl_model *m, uint32_t c, const tl_axis *axis, double size)
{
    tl_contacts *contacts = &m->detect->contacts;
    contacts->fate[c] = TL_FATE_DIE;
    tl_pair_sleep(m->detect, &m->detect->pairs[contacts->pair[c]], tl_axis_wait(axis, size));
}

/* The contact's facets in the present place, by its axis followed or searched. false: out of memory. */
static bool rebuild(tl_model *m, uint32_t c, tl_narrow *room, bool across)
{
    tl_contacts *contacts = &m->detect->contacts;
    double odometer = tl_pair_odometer(m, contacts->a[c], contacts->b[c]);
    tl_pair_view view = tl_pair_view_of(m, contacts->a[c], contacts->b[c]);
    tl_axis axis = tl_axis_of(contacts->axis[c]);
    if (!tl_pair_place(&view, room))
        return false;
    bool search = odometer > contacts->search[c];
    for (;; search = true) {
        bool followed = !search && tl_axis_follow(&view, &axis);
        if (!search && !followed && axis.kind == TL_AXIS_EDGES)
            continue; /* edges that no longer meet have no axis */
        if (search) {
            axis = tl_axis_search(&view, room, &contacts->axis[c]);
            if (isinf(axis.s) && !across) {
                part(m, c, &axis, view.size);
                return true;
            }
            if (isinf(axis.s)) { /* what bonds carry goes on along the walls that they belong to */
                axis = tl_axis_of(contacts->axis[c]);
                tl_axis_place(&view, &axis);
            }
            contacts->search[c] = odometer + tl_axis_margin(&axis, view.size);
            bool born = contacts->deep[c] == TL_DEEP_BORN;
            contacts->deep[c] = TL_DEEP_NOT;
            if (tl_overlap_is_deep(m, &view, &axis, contacts->a[c], contacts->b[c], born)) {
                tl_overlap_mark(contacts, c, born);
                room->deep = true;
            }
        }
        tl_tag tag = tl_touching_tag(&view, axis.n);
        tl_share_rule rule = tl_share_rule_of(m, &view, tag, across);
        tl_manifold_build(&view, &axis, &rule, room);
        if (room->manifold.failed)
            return false;
        if (!search && !followed && !(room->manifold.patch_area > 0))
            continue; /* what touched has parted: look at all features */
        if (search)
            watch_small(m, c, &view, &rule, &room->manifold);
        contacts->axis[c] = tl_features_of(&axis);
        if (tag.joint != contacts->tag[c].joint || tag.plane != contacts->tag[c].plane) {
            contacts->tag[c] = tag;
            uint32_t material = tl_material_row(m, tag);
            if (material != contacts->material[c])
                contacts->fate[c] = TL_FATE_MOVE;
        }
        /* a pair that touches without area stays a contact, so that it need not be born again */
        if (axis.s > TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * view.size && !across) {
            part(m, c, &axis, view.size);
        }
        return true;
    }
}

static void note_manifold(tl_contacts *contacts, uint32_t c, const tl_manifold *g)
{
    double area = 0;
    for (size_t k = 0; k < g->point_count; k++)
        area += g->points[k].area;
    contacts->area[c] = area;
    contacts->lone[c] = g->lone;
    contacts->fresh[c] = true;
}

/* Asks for room for a manifold, unless there is enough. */
static bool wants_room(tl_detect *d, uint32_t c, const tl_manifold *g)
{
    tl_contacts *contacts = &d->contacts;
    if (g->point_count <= contacts->point_room[c] && g->facet_count <= contacts->facet_room[c])
        return false;
    tl_pair *pair = &d->pairs[contacts->pair[c]];
    pair->want.points = (uint16_t)g->point_count;
    pair->want.facets = (uint16_t)g->facet_count;
    contacts->fate[c] = TL_FATE_GROW;
    return true;
}

/* Puts the built manifold in the place of the contact's points, or asks for room. */
static bool take_manifold(tl_model *m, uint32_t c, tl_narrow *room, const tl_point_lanes *lanes)
{
    tl_detect *d = m->detect;
    tl_contacts *contacts = &d->contacts;
    const tl_manifold *g = &room->manifold;
    note_manifold(contacts, c, g);
    if (same_topology(d, c, g)) {
        refit(m, c, g);
        return true;
    }
    return wants_room(d, c, g) || tl_contact_transfer(m, c, room, lanes);
}

void tl_contact_allow_reuse(tl_model *m, uint32_t c, bool brief)
{
    tl_contacts *contacts = &m->detect->contacts;
    double size_a = m->blocks.size[contacts->a[c]], size_b = m->blocks.size[contacts->b[c]];
    double most = (brief                      ? REUSE_BRIEF
                   : contacts->point_count[c] ? REUSE
                                              : TL_SILENT) *
                  (size_a < size_b ? size_a : size_b);
    contacts->until[c] = tl_pair_odometer(m, contacts->a[c], contacts->b[c]) + most;
}

/* Puts a patch in the place of the contact's, whose points begin there and are the same: stresses stay, forces follow
 * the area. Returns its area. */
static double refit_patch(tl_points_table *p, size_t begin, const tl_patch_points *g)
{
    double area = 0;
    for (size_t k = 0; k < g->count; k++) {
        size_t i = begin + k * TL_LANES;
        double scale = g->area[k] / p->area[i];
        for (int x = 0; x < 3; x++) {
            p->p[x][i] = g->p[x][k];
            p->f_s[x][i] *= scale;
        }
        tl_point_set_lean(p, i, g->lean[k]);
        p->f_n[i] *= scale;
        if (p->f_n0)
            p->f_n0[i] *= scale;
        p->area[i] = g->area[k];
        area += g->area[k];
    }
    return area;
}

static bool same_keys(const tl_points_table *p, size_t begin, const tl_patch_points *g)
{
    for (size_t k = 0; k < g->count; k++)
        if (p->key[begin + k * TL_LANES] != g->key[k])
            return false;
    return true;
}

bool tl_contact_is_patch(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_facet *f = &contacts->facet[contacts->facet_start[c]];
    const tl_axis_features *axis = &contacts->axis[c];
    uint32_t material = contacts->material[c];
    return contacts->lone[c] && contacts->facet_count[c] == 1 && f->kind == TL_FACET_PATCH &&
           ((axis->kind == TL_AXIS_FACE_A && axis->ia == f->ia) ||
            (axis->kind == TL_AXIS_FACE_B && axis->ib == f->ib)) &&
           material != TL_NO_ROW && !m->materials[material].splits &&
           tl_pair_odometer(m, contacts->a[c], contacts->b[c]) <= contacts->search[c];
}

/* The one patch of a contact whose axis stands, made anew where its points are the same; false when that is
 * not all there is to it. */
static bool renew_patch(tl_model *m, uint32_t c, tl_narrow *room)
{
    tl_contacts *contacts = &m->detect->contacts;
    const tl_facet *f = &contacts->facet[contacts->facet_start[c]];
    if (!tl_contact_is_patch(m, c))
        return false;
    tl_pair_view view = tl_pair_view_of(m, contacts->a[c], contacts->b[c]);
    tl_share_rule rule = tl_share_rule_of(m, &view, contacts->tag[c], false);
    room->manifold.failed = !tl_pair_place_face(&view, f->ib, room);
    if (room->manifold.failed || !tl_manifold_renew(&view, f->ia, f->ib, &rule, room))
        return false;
    const tl_patch_points *g = &room->patch;
    tl_points_table *p = &m->detect->points;
    size_t begin = contacts->point_start[c];
    if (g->count != contacts->point_count[c] || !same_keys(p, begin, g))
        return false;
    contacts->area[c] = refit_patch(p, begin, g);
    contacts->fresh[c] = true;
    return true;
}

/* Whether a contact without points still overlaps by no more than may go unseen. */
static bool touches_still(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    if (contacts->point_count[c] || contacts->until[c] == -INFINITY) /* under other rules */
        return false;
    if (contacts->fate[c] == TL_FATE_GROW) /* the room it wants is in the place of the faces */
        return false;
    tl_pair_view view = tl_pair_view_of(m, contacts->a[c], contacts->b[c]);
    if (tl_share_rule_of(m, &view, contacts->tag[c], false).unconditional)
        return false;
    tl_pair *p = &m->detect->pairs[contacts->pair[c]];
    double gap, margin = tl_beside_margin(&view, p, &gap);
    if (margin < 0) {
        tl_beside_note(&view, p);
        margin = tl_beside_margin(&view, p, &gap);
    }
    if (margin < 0 || gap > TL_CONTACT_TOLERANCE * view.size)
        return false;
    contacts->until[c] = tl_pair_odometer(m, contacts->a[c], contacts->b[c]) + margin;
    return true;
}

bool tl_contact_stands(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    return contacts->fate[c] == TL_FATE_DIE ||
           (m->config.reuse_geometry &&
            tl_pair_odometer(m, contacts->a[c], contacts->b[c]) <= contacts->until[c]);
}

/* Makes all that a contact is anew. Without the memory for it the contact is as it was, so that it can be tried again
 * and gives the same. */
static bool make_anew(tl_model *m, uint32_t c, unsigned thread)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_narrow *room = &m->detect->narrow[thread];
    tl_axis_features axis = contacts->axis[c];
    double search = contacts->search[c];
    tl_tag tag = contacts->tag[c];
    uint8_t lone = contacts->lone[c], fate = contacts->fate[c], deep = contacts->deep[c];
    if (rebuild(m, c, room, contacts->across[c]) &&
        (contacts->fate[c] == TL_FATE_DIE || take_manifold(m, c, room, &m->detect->lanes[thread])))
        return true;
    contacts->axis[c] = axis;
    contacts->search[c] = search;
    contacts->tag[c] = tag;
    contacts->lone[c] = lone;
    contacts->fate[c] = fate;
    contacts->deep[c] = deep;
    room->failed = true;
    return false;
}

void tl_contact_update(tl_model *m, uint32_t c, unsigned thread)
{
    tl_narrow *room = &m->detect->narrow[thread];
    if (touches_still(m, c))
        return;
    room->manifold.failed = false;
    if (renew_patch(m, c, room))
        tl_contact_allow_reuse(m, c, false);
    else if (room->manifold.failed)
        room->failed = true; /* to be tried again, and not in another way */
    else if (make_anew(m, c, thread))
        tl_contact_allow_reuse(m, c, room->manifold.brief);
}

void tl_contact_reframe(tl_model *m, uint32_t c, unsigned thread)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_narrow *room = &m->detect->narrow[thread];
    if (contacts->fate[c] == TL_FATE_DIE)
        return;
    contacts->search[c] = -INFINITY;
    room->reframed = true;
    make_anew(m, c, thread);
    room->reframed = false;
}

bool tl_contact_fill(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_narrow *room = &m->detect->narrow[0];
    tl_pair_view view = tl_pair_view_of(m, contacts->a[c], contacts->b[c]);
    if (!tl_pair_place(&view, room))
        return false;
    tl_axis axis = tl_axis_of(contacts->axis[c]);
    if (!tl_axis_place(&view, &axis))
        axis = tl_axis_search(&view, room, NULL);
    tl_share_rule rule = tl_share_rule_of(m, &view, contacts->tag[c], contacts->across[c]);
    tl_manifold_build(&view, &axis, &rule, room);
    watch_small(m, c, &view, &rule, &room->manifold);
    note_manifold(contacts, c, &room->manifold);
    if (room->manifold.failed)
        return false;
    if (wants_room(m->detect, c, &room->manifold)) /* its axis has been found in another way */
        return true;
    if (!tl_contact_transfer(m, c, room, &m->detect->lanes[0]))
        return false;
    contacts->fate[c] = TL_FATE_KEEP;
    tl_contact_allow_reuse(m, c, room->manifold.brief);
    return true;
}
