/* update.c - one contact brought up to the present place of its blocks: its faces, its points.
 *
 * Most contacts are two faces on each other and stay so: while nothing else can touch, the patch alone is made anew,
 * several at once. A field contact goes by its list of faces while that holds. Otherwise everything is looked
 * at that could touch (find). */
#include "detect/update.h"

#include "base/columns.h"
#include "contact/across_gap.h"
#include "contact/contacts.h"
#include "contact/cut_contacts.h"
#include "contact/facing.h"
#include "contact/handover.h"
#include "contact/lean.h"
#include "contact/shear.h"
#include "contact/store.h"
#include "detect/fields.h"
#include "detect/grazing.h"
#include "detect/overlap.h"
#include "detect/pairs.h"
#include "narrow/coarse_test.h"
#include "narrow/corner.h"
#include "narrow/flush.h"
#include "narrow/manifold.h"
#include "narrow/narrow.h"
#include "narrow/patch.h"
#include "narrow/patch_batch.h"
#include "narrow/press.h"

#include <string.h>

/* Tolerance: motion within which a field contact is reused, over its overlap: its force is then wrong by no more than
 * that. A contact that rests moves by less. */
#define REUSE_FIELD 1e-11

/* Tolerance: motion within which the points of a patch stand and ride, over its least closure o. An area of width b is
 * then wrong by a share of o/(16 b). That is a quarter of the load on its border, which a patch neglects in any case
 * (docs/theory.md). It is TL_STILL at least: a patch that opens has no closure where it opens. Test:
 * lua/test_symmetric_stiffness. */
#define STANDS (1.0 / 16)

/* Tolerance: the same of a patch that is bonded whole, over the smaller block's size: a bond that swings to tension
 * passes through no closure. Test: lua/test_landing, lua/test_new_points. */
#define BOND_STANDS 5e-4

static bool same_topology(const tl_detect *d, uint32_t c, const tl_manifold *g)
{
    const tl_contacts *contacts = &d->contacts;
    const tl_facet *f = &contacts->facet[c], *h = &g->facet;
    if (contacts->point_count[c] != g->point_count || f->kind != h->kind)
        return false;
    if (tl_facet_is_field(f))
        return true;
    if (f->ia != h->ia || f->ib != h->ib)
        return false;
    for (size_t k = 0; k < g->point_count; k++)
        if (d->points.key[tl_point_row(contacts, c, k)] != g->points[k].key)
            return false;
    return true;
}

/* ---------------------------------------------------------------- looking at all ---------- */

static bool is_patch(const tl_contacts *contacts, uint32_t c)
{
    return tl_facet_is_patch(&contacts->facet[c]) && contacts->point_count[c] > 0;
}

/* Ends a contact whose blocks have parted. */
static void part(tl_model *m, uint32_t c, double way)
{
    tl_contacts *contacts = &m->detect->contacts;
    contacts->pending[c] = TL_PENDING_DIE;
    if (tl_facet_is_patch(&contacts->facet[c]) && contacts->point_count[c] > 0)
        contacts->released[c] = tl_contact_ends(m, c);
    tl_pair_sleep(m->detect, &m->detect->pairs[contacts->pair[c]], way);
}

/* Whether a pair without points is still near enough to stay a contact, so that it need not be born again. */
static bool is_near(const tl_pair_view *view, double gap, double over, double *way)
{
    double reach = over + TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * view->size;
    *way = fmax(gap, reach) - TL_CONTACT_TOLERANCE * view->size;
    return gap <= reach && tl_coarse_test(view, reach);
}

static void note_tag(tl_model *m, uint32_t c, tl_tag tag)
{
    tl_contacts *contacts = &m->detect->contacts;
    if (tag.joint == contacts->tag[c].joint && tag.plane == contacts->tag[c].plane)
        return;
    contacts->tag[c] = tag;
    if (tl_law_row(m, tag, contacts->a[c], contacts->b[c]) != contacts->law[c])
        contacts->pending[c] = TL_PENDING_MOVE;
}

static void check_depth(tl_model *m, uint32_t c, const tl_pair_view *view, const tl_region *region,
                        tl_narrow_scratch *scratch)
{
    tl_contacts *contacts = &m->detect->contacts;
    bool born = contacts->deep[c] == TL_DEEP_BORN;
    contacts->deep[c] = TL_DEEP_NOT;
    if (!tl_overlap_is_deep(m, view, region, contacts->a[c], contacts->b[c], born))
        return;
    tl_overlap_mark(contacts, c, born);
    scratch->deep = true;
}

/* All that the contact is in the present place, into the thread's manifold. false: out of memory. */
static bool find(tl_model *m, uint32_t c, tl_narrow_scratch *scratch, const tl_point_lanes *lanes)
{
    tl_contacts *contacts = &m->detect->contacts;
    double odometer = tl_contact_odometer(m, c), way;
    tl_contact_lift_field(m, c);
    tl_pair_view view = tl_contact_view(m, c);
    tl_manifold_before before = tl_contact_before(m, c, scratch->reframed, lanes);
    tl_region region;
    if (!tl_pair_place(&view, scratch) ||
        !tl_region_find(&view, TL_LIST_MARGIN * view.size + before.reach, scratch, &region))
        return false;
    const tl_press_row *row = tl_press_row_of(m, c);
    tl_field_mesh mesh, flat;
    if (row)
        mesh = flat = (tl_field_mesh){0};
    if (row && contacts->point_count[c] && !scratch->reframed) /* else faces may have other numbers */
        mesh = tl_field_listed_anew(row, &region);
    region.mesh = row ? &mesh : NULL;
    region.flat = row ? &flat : NULL;
    tl_tag tag = tl_touching_tag(&view, region.n);
    tl_touch_rule rule = tl_touch_rule_of(m, contacts->a[c], contacts->b[c], &view, tag, before.over);
    const tl_manifold *g = &scratch->manifold;
    if (!tl_kind_find(m, contacts->a[c], contacts->b[c], &view, &region, &rule, &before, scratch))
        return false;
    contacts->faces_valid_to[c] = scratch->reframed ? TL_OUTDATED : odometer + g->valid;
    contacts->spot[c] = tl_spot_of(m, tl_contact_sides(m, c), g->valid);
    /* a patch that is to be a field may have a row before it is one: it must not part for that */
    const bool patch = is_patch(contacts, c);
    const double over = row && !patch ? TL_PARTED * before.reach : before.holds ? 0 : before.over;
    if (g->point_count == 0 && !is_near(&view, region.gap, over, &way)) {
        part(m, c, way);
        return true;
    }
    check_depth(m, c, &view, &region, scratch);
    note_tag(m, c, tag);
    if (tl_press_row_of(m, c))
        tl_field_keep(tl_press_row_of(m, c), &view, &region, before.calm);
    if (row && g->point_count > 0 && tl_facet_is_field(&g->facet))
        tl_press_shift_faces(m, c, row->shift == 0 ? tl_touching_faces(&view, region.n) : row->shifted);
    return true;
}

/* How far, at most, points of a patch have been carried apart by their blocks since they were laid, `way2`. And how far
 * along the faces new ones of the same keys lie from where they have gone, `run2`: squares, in A's frame. */
typedef struct contact_run {
    const tl_facet *laid;
    tl_facing_place by_b;
    double way2, run2;
} contact_run;

static contact_run run_to(const tl_facet *laid, const tl_pair_pose *now)
{
    tl_mat3 own = tl_m3_identity();
    return (contact_run){.laid = laid,
                         .by_b = tl_facing_ride(&own, &now->turn, now->shift, &laid->laid.turn, laid->laid.shift, 1)};
}

static void run_add(contact_run *run, tl_vec3 old, tl_vec3 now)
{
    tl_vec3 way = tl_v3_sub(tl_v3_add(tl_m3_mul(&run->by_b.to, old), run->by_b.at), old);
    tl_vec3 rest = tl_v3_madd(tl_v3_sub(now, old), -run->laid->ride, way);
    rest = tl_v3_madd(rest, -tl_v3_dot(rest, run->laid->na), run->laid->na);
    run->way2 = fmax(run->way2, tl_v3_norm2(way));
    run->run2 = fmax(run->run2, tl_v3_norm2(rest));
}

/* Whether points have run along their polygon, farther than their blocks have moved: what they carry belongs to the
 * places where they have been. `near`: a distance that makes no difference. */
static bool has_run(const contact_run *run, double near)
{
    return run->run2 > run->way2 && run->run2 > near * near;
}

/* ---------------------------------------------------------------- taking ------------------ */

static void note_manifold(tl_detect *d, uint32_t c, const tl_manifold *g)
{
    const uint32_t areas = d->kinds[g->facet.kind]->place->areas((uint32_t)g->point_count);
    double area = 0;
    for (size_t k = 0; k < areas; k++)
        area += g->points[k].area;
    d->contacts.area[c] = area;
    d->contacts.new_points[c] = TL_POINTS_PLACED;
}

/* Asks for room for a manifold, or for a place in another span, unless the contact has them. */
static bool wants_place(tl_detect *d, uint32_t c, const tl_manifold *g, bool reframed)
{
    tl_contacts *contacts = &d->contacts;
    bool field = tl_facet_is_field(&g->facet);
    bool lacks_press = field && contacts->press[c] == TL_NO_ROW; /* it has not got the room for its press yet */
    bool moves = (g->point_count > 0 || field) && (contacts->kind[c] != g->facet.kind || lacks_press);
    if (!moves && g->point_count <= contacts->point_capacity[c])
        return false;
    contacts->kind[c] = (uint8_t)g->facet.kind;
    d->pairs[contacts->pair[c]].want_points = (uint16_t)g->point_count;
    contacts->pending[c] = reframed ? TL_PENDING_REFRAME : TL_PENDING_GROW;
    return true;
}

static bool have_run(const tl_model *m, uint32_t c, const tl_manifold *g)
{
    const tl_contacts *contacts = &m->detect->contacts;
    contact_run run = run_to(&contacts->facet[c], &g->facet.laid);
    for (size_t k = 0; k < g->point_count; k++)
        run_add(&run, tl_columns_get(m->detect->points.p, tl_point_row(contacts, c, k)), g->points[k].p);
    return has_run(&run, TL_MERGE * tl_contact_size(m, c));
}

/* What a contact without points stays. A patch that is lifted becomes a field whose faces are moved so: they press
 * again there. */
static tl_facet parted_facet(const tl_model *m, uint32_t c)
{
    tl_facet facet = m->detect->contacts.facet[c];
    if (is_patch(&m->detect->contacts, c) && tl_contact_mean_lift(m, c) != 0)
        facet.kind = TL_FACET_FIELD;
    return facet;
}

/* Puts the built manifold in the place of the contact's points, or asks for room. */
static bool take_manifold(tl_model *m, uint32_t c, tl_narrow_scratch *scratch, const tl_point_lanes *lanes)
{
    tl_detect *d = m->detect;
    tl_manifold *g = &scratch->manifold;
    note_manifold(d, c, g);
    if (g->point_count == 0)
        g->facet = parted_facet(m, c);
    if (wants_place(d, c, g, scratch->reframed))
        return true;
    bool same = same_topology(d, c, g);
    if (!same)
        d->contacts.new_points[c] = TL_POINTS_OTHERS;
    bool stays = same && (tl_facet_is_field(&g->facet) || scratch->reframed || !have_run(m, c, g));
    return d->kinds[g->facet.kind]->make->take(m, c, stays, scratch, lanes);
}

/* How far the points of a patch have been carried apart by their blocks since they were laid, the farthest of them. */
static double points_moved(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_facet *f = &contacts->facet[c];
    const tl_sides s = tl_contact_sides(m, c);
    const tl_mat3 *ra = tl_side_rotation(m, s.a), *rb = tl_side_rotation(m, s.b);
    tl_facing_place by_b = tl_facing_ride(ra, rb, tl_sides_apart(m, s), &f->laid.turn, f->laid.shift, 1);
    double most = 0;
    for (size_t k = 0; k < contacts->point_count[c]; k++) {
        tl_vec3 p = tl_columns_get(m->detect->points.p, tl_point_row(contacts, c, k));
        tl_vec3 there = tl_v3_add(tl_m3_mul(&by_b.to, p), by_b.at);
        most = fmax(most, tl_v3_norm2(tl_v3_sub(there, tl_m3_mul(ra, p))));
    }
    return sqrt(most);
}

/* How far from the centroid of B the points of either side may lie. */
static double reach_of(const tl_model *m, tl_sides s)
{
    return fmax(tl_side_radius(m, s.b), tl_v3_norm(tl_sides_apart(m, s)) + tl_side_radius(m, s.a));
}

static double faces_moved(const tl_model *m, uint32_t c)
{
    const tl_sides s = tl_contact_sides(m, c);
    return tl_spot_moved(m, &m->detect->contacts.spot[c], s, reach_of(m, s));
}

/* Way left to go before the faces of a patch are to be chosen anew. */
static double way_of_faces(const tl_model *m, uint32_t c)
{
    return (double)m->detect->contacts.spot[c].remaining - faces_moved(m, c);
}

/* Motion of next to nothing. */
static double still_way(const tl_model *m, uint32_t c)
{
    return tl_still_share(m) * tl_contact_size(m, c);
}

/* Lets a contact whose points have just been made move a little before they are made anew. */
static void contact_allow_reuse(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    bool patch = is_patch(contacts, c);
    bool field = tl_facet_is_field(&contacts->facet[c]) && contacts->point_count[c] > 0;
    const tl_press *press = field ? &tl_press_row_of(m, c)->press : NULL;
    double most = field ? REUSE_FIELD * fmin(press->overlap, press->deepest) : still_way(m, c);
    if (!patch || contacts->new_points[c] != TL_POINTS_STAY)
        contacts->points_valid_to[c] = tl_contact_odometer(m, c) + most;
    if (!patch)
        return;
    contacts->spot[c] = tl_spot_of(m, tl_contact_sides(m, c), way_of_faces(m, c));
}

/* Closure of a patch, or stretch of its bond, where that is least: normal stress over kn, initial stress included. */
static double least_closure(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    uint32_t law = contacts->law[c];
    double stress = INFINITY, kn = law == TL_NO_ROW ? 0 : m->joint_laws[law].kn;
    for (size_t k = 0; k < contacts->point_count[c]; k++) {
        size_t i = tl_point_row(contacts, c, k);
        stress = fmin(stress, fabs(p->f_n[i]) / p->area[i]);
    }
    return kn > 0 ? stress / kn : 0;
}

/* Way left to go before the points of a patch are to be laid anew. */
static double way_of_points(const tl_model *m, uint32_t c)
{
    uint32_t law = m->detect->contacts.law[c];
    bool pulls = law != TL_NO_ROW && m->joint_laws[law].pulls != TL_PULL_NONE;
    double stands = pulls && tl_contact_across_gap(m, c).whole ? BOND_STANDS * tl_contact_size(m, c)
                                                               : fmax(still_way(m, c), STANDS * least_closure(m, c));
    return stands - points_moved(m, c);
}

/* Whether the odometers have not run out, or the blocks of a patch have some way left to go against each other. */
static bool is_valid(const tl_model *m, uint32_t c, double *valid_to, double way_left(const tl_model *m, uint32_t c))
{
    double odometer = tl_contact_odometer(m, c);
    if (odometer <= *valid_to)
        return true;
    if (*valid_to == TL_OUTDATED || !is_patch(&m->detect->contacts, c))
        return false;
    double left = way_left(m, c);
    if (left > 0)
        *valid_to = odometer + left;
    return left > 0;
}

/* ---------------------------------------------------------------- patches ----------------- */

/* Puts a patch in the place of the contact's, whose points are the same. */
static void refit_patch(tl_model *m, uint32_t c, const tl_patch_points *g, const tl_facet *laid)
{
    tl_points_table *p = &m->detect->points;
    double area = 0, *whole = &m->detect->contacts.area[c];
    for (size_t k = 0; k < g->count; k++)
        area += g->area[k];
    bool same = fabs(area - *whole) <= TL_SAME_AREA * area;
    tl_shear before = same ? (tl_shear){0} : tl_shear_of(m, c);
    for (size_t k = 0; k < g->count; k++) {
        size_t i = tl_point_row(&m->detect->contacts, c, k);
        tl_columns_put(p->p, i, tl_columns_get(g->p, k));
        tl_point_resize(p, i, g->area[k]);
    }
    *whole = area;
    m->detect->contacts.facet[c].ride = laid->ride;
    m->detect->contacts.facet[c].laid = laid->laid;
    if (same)
        return;
    tl_shear now = tl_shear_of(m, c);
    tl_shear_resized(m, c, &before, &now);
}

static bool same_keys(const tl_points_table *p, size_t begin, const tl_patch_points *g)
{
    for (size_t k = 0; k < g->count; k++)
        if (p->key[begin + k * TL_LANES] != g->key[k])
            return false;
    return true;
}

/* Whether a contact is a patch and stays one. */
static bool contact_is_patch(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    uint32_t law = contacts->law[c];
    return is_patch(contacts, c) && law != TL_NO_ROW && !m->joint_laws[law].splits &&
           is_valid(m, c, &contacts->faces_valid_to[c], way_of_faces);
}

/* Brings one face of B into A's frame, and nothing else of B; false when out of memory. */
static bool place_face(tl_pair_view *view, uint32_t face, tl_narrow_scratch *scratch)
{
    const tl_poly *b = view->b;
    if (!tl_grow(&scratch->vertex_b, &scratch->vertex_capacity, b->vertex_count, sizeof(tl_vec3)) ||
        !tl_grow(&scratch->normal_b, &scratch->normal_capacity, b->face_count, sizeof(tl_vec3)))
        return false;
    view->vertex_b = scratch->vertex_b;
    view->normal_b = scratch->normal_b;
    for (uint32_t i = b->start[face]; i < b->start[face + 1]; i++) {
        uint32_t v = b->loop[i];
        view->vertex_b[v] = tl_v3_add(tl_m3_mul(&view->turn, b->vertex[v]), view->shift);
    }
    view->normal_b[face] = tl_m3_mul(&view->turn, b->plane[face].normal);
    return true;
}

/* The patch of a contact that is one and stays one, made anew; false when that is not all there is to it. */
static bool renew_patch(tl_model *m, uint32_t c, unsigned thread)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_narrow_scratch *scratch = &m->detect->narrow[thread];
    const tl_facet *f = &contacts->facet[c];
    if (!contact_is_patch(m, c))
        return false;
    tl_pair_view view = tl_contact_view(m, c);
    tl_touch_rule rule = tl_touch_rule_of(m, contacts->a[c], contacts->b[c], &view, contacts->tag[c],
                                          contacts->holds_over_gap[c] ? INFINITY : 0);
    scratch->manifold.failed = !place_face(&view, f->ib, scratch);
    if (scratch->manifold.failed || !(tl_patch_add(&view, f->ia, f->ib, &rule, scratch) > 0))
        return false;
    const tl_patch_points *g = &scratch->patch;
    size_t begin = contacts->point_start[c];
    if (g->count == contacts->point_count[c] && same_keys(&m->detect->points, begin, g) &&
        !have_run(m, c, &scratch->manifold)) {
        refit_patch(m, c, g, &scratch->manifold.facet);
        contacts->new_points[c] = TL_POINTS_PLACED;
        return true;
    }
    if (rule.min_area > 0) /* it may be too small for a patch now */
        return false;
    scratch->manifold.failed = !take_manifold(m, c, scratch, &m->detect->lanes[thread]);
    if (contacts->pending[c] == TL_PENDING_GROW)
        contacts->pending[c] = TL_PENDING_GROW_PATCH;
    return !scratch->manifold.failed;
}

/* Whether a contact without points still overlaps by no more than may go unseen. */
static bool touches_still(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    if (contacts->point_count[c] || contacts->points_valid_to[c] == TL_OUTDATED)
        return false;
    tl_pair_view view = tl_contact_view(m, c);
    if (tl_touch_rule_of(m, contacts->a[c], contacts->b[c], &view, contacts->tag[c], 0).min_area > 0)
        return false;
    tl_pair *p = &m->detect->pairs[contacts->pair[c]];
    double gap, margin = tl_grazing_margin(&view, p, &gap);
    if (margin < 0) {
        tl_grazing_choose_faces(&view, p, NULL);
        margin = tl_grazing_margin(&view, p, &gap);
    }
    if (margin < 0 || gap > TL_CONTACT_TOLERANCE * view.size)
        return false;
    contacts->points_valid_to[c] = tl_contact_odometer(m, c) + margin;
    return true;
}

/* Whether the faces of a patch need not be chosen anew while its points stand. */
static bool faces_hold(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    return is_valid(m, c, &contacts->faces_valid_to[c], way_of_faces) || way_of_faces(m, c) > -still_way(m, c);
}

/* Whether a contact's points are still good although its odometers have run out. */
bool tl_contact_points_hold_yet(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    if (!is_patch(contacts, c))
        return m->config.reuse_geometry && tl_contact_odometer(m, c) <= contacts->points_valid_to[c];
    return is_valid(m, c, &contacts->points_valid_to[c], way_of_points) && faces_hold(m, c);
}

/* Whether the points of a patch stand although its faces have been chosen anew: they are the same. */
static bool still_stands(const tl_model *m, uint32_t c, const tl_narrow_scratch *scratch)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_manifold *g = &scratch->manifold;
    const tl_facet *f = &contacts->facet[c], *now = &g->facet;
    return !scratch->reframed && is_patch(contacts, c) && g->point_count > 0 && tl_facet_is_patch(now) &&
           f->ia == now->ia && f->ib == now->ib && tl_contact_odometer(m, c) <= contacts->points_valid_to[c];
}

/* Makes all that a contact is anew. Without the memory for it the contact is as it was, so that it can be tried again
 * and gives the same. */
static bool make_anew(tl_model *m, uint32_t c, unsigned thread)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_narrow_scratch *scratch = &m->detect->narrow[thread];
    double faces_valid_to = contacts->faces_valid_to[c];
    tl_spot spot = contacts->spot[c];
    tl_tag tag = contacts->tag[c];
    uint8_t kind = contacts->kind[c], pending = contacts->pending[c], deep = contacts->deep[c];
    if (find(m, c, scratch, &m->detect->lanes[thread]) &&
        (contacts->pending[c] == TL_PENDING_DIE || still_stands(m, c, scratch) ||
         take_manifold(m, c, scratch, &m->detect->lanes[thread])))
        return true;
    contacts->faces_valid_to[c] = faces_valid_to;
    contacts->spot[c] = spot;
    contacts->tag[c] = tag;
    contacts->kind[c] = kind;
    contacts->pending[c] = pending;
    contacts->deep[c] = deep;
    scratch->failed = true;
    return false;
}

/* Notes from where the points of a contact that has been made may be reused. One that waits for room is made once more:
 * noted twice, the rounding of its spot would count twice. */
static void note_made(tl_model *m, uint32_t c)
{
    if (!tl_pending_waits(m->detect->contacts.pending[c]))
        contact_allow_reuse(m, c);
}

/* Brings up to the present place some field contacts that go on, up to TL_FIELD_PAIRS. */
static void contacts_follow(tl_model *m, const uint32_t contact[], uint32_t count, unsigned thread)
{
    tl_narrow_scratch *scratch = &m->detect->narrow[thread];
    tl_field_batch batch;
    batch.count = count;
    memcpy(batch.contact, contact, count * sizeof *contact);
    tl_fields_follow(m, &batch, scratch);
    for (uint32_t k = 0; k < count; k++) {
        tl_field_result result = tl_field_take(m, &batch, k, scratch);
        bool done = result == TL_FIELD_FOUND && take_manifold(m, contact[k], scratch, &m->detect->lanes[thread]);
        done = done || (result == TL_FIELD_LOST && make_anew(m, contact[k], thread));
        if (done)
            note_made(m, contact[k]);
        else
            scratch->failed = true;
    }
}

void tl_contact_update(tl_model *m, uint32_t c, unsigned thread)
{
    tl_narrow_scratch *scratch = &m->detect->narrow[thread];
    if (touches_still(m, c))
        return;
    scratch->manifold.failed = false;
    if (tl_field_goes_on(m, c))
        contacts_follow(m, &c, 1, thread);
    else if (renew_patch(m, c, thread) || (!scratch->manifold.failed && make_anew(m, c, thread)))
        note_made(m, c);
    else
        scratch->failed = true; /* to be tried again, and not in another way */
}

void tl_contact_reframe(tl_model *m, uint32_t c, unsigned thread)
{
    tl_narrow_scratch *scratch = &m->detect->narrow[thread];
    if (m->detect->contacts.pending[c] == TL_PENDING_DIE)
        return;
    scratch->reframed = true;
    if (make_anew(m, c, thread))
        note_made(m, c); /* by the odometers of the bodies as they are now */
    scratch->reframed = false;
}

/* Whether a field contact is to become a patch, and its faces are moved apart by more than slip has opened its point of
 * shear: points need a reference then. */
static bool lacks_reference(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_press_row *row = tl_press_row_of(m, c);
    return row && tl_facet_is_field(&contacts->facet[c]) && contacts->kind[c] != TL_FACET_FIELD &&
           (row->leans || row->shift != row->opening[TL_FIELD_SHEAR]) && !m->detect->points.initial;
}

/* Before a contact gets points of another kind: gives a patch that was a field contact the reference that its points
 * need, and a field contact its row. The faces of one that takes over from another are moved out as those were. false:
 * out of memory. */
static bool reserve_field(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    if (lacks_reference(m, c) && !tl_detect_hold_initial(m->detect))
        return false;
    if (contacts->kind[c] != TL_FACET_FIELD || contacts->press[c] != TL_NO_ROW)
        return true;
    contacts->press[c] = tl_press_take(m->detect);
    if (contacts->press[c] == TL_NO_ROW)
        return false;
    tl_face_pair faces;
    double shift = tl_cut_contact_shift(m, contacts->a[c], contacts->b[c], &faces);
    if (shift != 0) {
        tl_press_shift_faces(m, c, faces);
        tl_press_row_of(m, c)->shift = shift;
    }
    return true;
}

bool tl_contact_fill(tl_model *m, uint32_t c)
{
    tl_detect *d = m->detect;
    tl_contacts *contacts = &d->contacts;
    if (!reserve_field(m, c))
        return false;
    uint8_t pending = contacts->pending[c];
    contacts->pending[c] = TL_PENDING_NONE;
    d->narrow[0].reframed = pending == TL_PENDING_REFRAME;
    d->narrow[0].manifold.failed = false;
    bool made = (pending == TL_PENDING_GROW_PATCH && renew_patch(m, c, 0)) ||
                (!d->narrow[0].manifold.failed && make_anew(m, c, 0));
    d->narrow[0].reframed = false;
    if (!made) {
        d->narrow[0].failed = false; /* the caller tells */
        contacts->pending[c] = pending;
        return false;
    }
    note_made(m, c);
    return true;
}

/* ---------------------------------------------------------------- SIMD groups -------------
 *
 * The patches of a SIMD group made anew at once, a contact in each lane.
 *
 * Most contacts are two faces on each other and stay so. What eight of them need is laid side by side (patch_batch.c)
 * and comes out as the SIMD group has its points: slot by slot. Lanes whose polygon has changed, and contacts that are
 * something else, are brought up to date one by one. */

/* Adds a contact's pair of faces to a batch; false when they are none for it. `corners`: the batch has points at
 * corners only. */
static bool add_to_batch(tl_model *m, uint32_t c, uint32_t lane, bool corners, tl_patch_batch *batch)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_facet *f = &contacts->facet[c];
    uint32_t a = contacts->a[c], b = contacts->b[c];
    const tl_poly *of_a = tl_pair_shape(m, a, b), *of_b = tl_pair_shape(m, b, a);
    if (!contact_is_patch(m, c) || (corners && !tl_at_corners(of_a, f->ia, of_b, f->ib)) ||
        !tl_batch_takes(of_a, f->ia, of_b, f->ib))
        return false;
    double size = m->blocks.size[a] < m->blocks.size[b] ? m->blocks.size[a] : m->blocks.size[b];
    tl_batch_add(batch, lane, of_a, f->ia, of_b, f->ib, size,
                 contacts->holds_over_gap[c] ? INFINITY : TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * size);
    const tl_sides s = tl_contact_sides(m, c);
    tl_batch_between(batch, lane, tl_side_rotation(m, s.a), tl_side_rotation(m, s.b), tl_sides_apart(m, s));
    return true;
}

/* Lanes whose patch takes the place of the contact's, 1 or 0, and the area it gets. */
typedef struct patch_choice {
    double mine[TL_LANES], area[TL_LANES];
} patch_choice;

TL_INLINE double choose(double yes, double a, double b)
{
    return yes > 0 ? a : b;
}

/* Puts a point of each lane that is taken in the place of the table's: stress stays, force follows the area. */
TL_VECTORIZED static void refit_slot(tl_points_table *p, size_t row, const tl_batch_point *point,
                                     patch_choice *restrict t)
{
    double *restrict x = p->p[0] + row, *restrict y = p->p[1] + row, *restrict z = p->p[2] + row;
    double *restrict f_x = p->f_s[0] + row, *restrict f_y = p->f_s[1] + row;
    double *restrict f_z = p->f_s[2] + row, *restrict f_n = p->f_n + row;
    double *restrict area = p->area + row, scale[TL_LANES];
#pragma omp simd
    for (uint32_t l = 0; l < TL_LANES; l++) {
        double old = area[l], now = choose(t->mine[l], point->area[l], old);
        double by = choose(t->mine[l], now / choose(t->mine[l], old, 1), 1);
        x[l] = choose(t->mine[l], point->p.x[l], x[l]);
        y[l] = choose(t->mine[l], point->p.y[l], y[l]);
        z[l] = choose(t->mine[l], point->p.z[l], z[l]);
        f_x[l] *= by;
        f_y[l] *= by;
        f_z[l] *= by;
        f_n[l] *= by;
        area[l] = now;
        t->area[l] += now;
        scale[l] = by;
    }
    for (uint32_t l = 0; l < TL_LANES && p->f_n0; l++)
        p->f_n0[row + l] *= scale[l];
}

/* Puts the patches of the lanes that are taken, which all have so many points, in the place of the contacts'. */
static void refit_group(tl_points_table *p, size_t row, const tl_patch_batch *batch, tl_batch_counts n, patch_choice *t)
{
    for (uint32_t l = 0; l < TL_LANES; l++)
        t->area[l] = 0;
    for (uint32_t k = 0; k < n.middles; k++, row += TL_LANES)
        refit_slot(p, row, &batch->middles[k], t);
    for (uint32_t k = 0; k < n.corners; k++, row += TL_LANES)
        refit_slot(p, row, &batch->corners[k], t);
    if (n.centroid)
        refit_slot(p, row, &batch->centroid, t);
}

/* The shear of the points of a SIMD group, summed over those of each lane: energy times 2 ks, and force. */
typedef struct shear_lanes {
    double energy[TL_LANES];
    tl_lanes3 force;
} shear_lanes;

TL_VECTORIZED static void sum_shear(const tl_points_table *p, size_t row, uint32_t slots, shear_lanes *restrict out)
{
    const double *restrict f_x = p->f_s[0] + row, *restrict f_y = p->f_s[1] + row;
    const double *restrict f_z = p->f_s[2] + row, *restrict area = p->area + row;
    shear_lanes sum = {0};
    for (size_t at = 0; at < (size_t)slots * TL_LANES; at += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            double x = f_x[at + l], y = f_y[at + l], z = f_z[at + l];
            sum.force.x[l] += x;
            sum.force.y[l] += y;
            sum.force.z[l] += z;
            sum.energy[l] += (x * x + y * y + z * z) / choose(area[at + l], area[at + l], 1);
        }
    *out = sum;
}

/* Lanes whose area is to change, a bit each. */
static uint32_t changing(const tl_contacts *contacts, const tl_simd_group *group, const tl_patch_batch *batch,
                         uint32_t now)
{
    uint32_t changed = 0;
    for (uint32_t l = 0; l < TL_LANES; l++)
        if (now >> l & 1) {
            double area = contacts->area[group->contact[l]];
            changed |= (uint32_t)(fabs(batch->area[l] - area) > TL_SAME_AREA * area) << l;
        }
    return changed;
}

/* The shear of lane l. All of it acts at the centroid: an area that changes by as little as those of a batch takes no
 * more of a twist's heat than goes unseen. */
static tl_shear shear_in(const shear_lanes *s, const tl_patch_batch *batch, uint32_t l, double area)
{
    tl_mat3 turn = tl_lanes9_get(&batch->r_a, l);
    tl_vec3 arm = tl_m3_mul(&turn, tl_lanes3_get(&batch->centroid.p, l));
    tl_vec3 force = tl_lanes3_get(&s->force, l);
    return (tl_shear){.area = area, .energy = s->energy[l], .force = force, .moment = tl_v3_cross(arm, force)};
}

/* What else a contact keeps of its patch. */
static void note_patch(tl_model *m, uint32_t c, const tl_patch_batch *batch, uint32_t l, double area)
{
    tl_contacts *contacts = &m->detect->contacts;
    contacts->area[c] = area;
    contacts->facet[c].ride = batch->ride[l];
    contacts->facet[c].laid.turn = tl_lanes9_get(&batch->turn, l);
    contacts->facet[c].laid.shift = tl_lanes3_get(&batch->shift, l);
    contacts->new_points[c] = TL_POINTS_PLACED;
    contact_allow_reuse(m, c);
}

/* Puts the patches of some lanes, a bit each, into the place of their contacts'. */
static void take_lanes(tl_model *m, const tl_simd_group *group, const tl_patch_batch *batch, tl_batch_counts n,
                       uint32_t now, patch_choice *t)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    uint32_t changed = changing(contacts, group, batch, now);
    shear_lanes before, after;
    if (changed)
        sum_shear(p, group->start, n.all, &before);
    refit_group(p, group->start, batch, n, t);
    if (changed)
        sum_shear(p, group->start, n.all, &after);
    for (uint32_t l = 0; l < TL_LANES; l++) {
        uint32_t c = group->contact[l];
        if (changed >> l & 1) {
            tl_shear old = shear_in(&before, batch, l, contacts->area[c]);
            tl_shear fresh = shear_in(&after, batch, l, t->area[l]);
            tl_shear_resized(m, c, &old, &fresh);
        }
        if (now >> l & 1)
            note_patch(m, c, batch, l, t->area[l]);
    }
}

static bool group_has_run(const tl_model *m, uint32_t c, const tl_patch_batch *batch, uint32_t l, tl_batch_counts n)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_pair_pose now = {tl_lanes9_get(&batch->turn, l), tl_lanes3_get(&batch->shift, l)};
    contact_run run = run_to(&contacts->facet[c], &now);
    for (uint32_t k = 0; k < n.all; k++) {
        const tl_batch_point *point = k < n.middles               ? &batch->middles[k]
                                      : k < n.middles + n.corners ? &batch->corners[k - n.middles]
                                                                  : &batch->centroid;
        run_add(&run, tl_columns_get(m->detect->points.p, tl_point_row(contacts, c, k)), tl_lanes3_get(&point->p, l));
    }
    return has_run(&run, batch->near[l]);
}

/* Puts patches into the place of those of the SIMD group that have the same points, and takes their lanes out of `in`:
 * lanes of as many points together. */
static void take_patches(tl_model *m, const tl_simd_group *group, const tl_patch_batch *batch, uint32_t *in)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    tl_batch_counts n[TL_LANES];
    uint32_t same = 0;
    for (uint32_t l = 0; l < TL_LANES; l++) {
        if (!(*in >> l & 1) || !batch->laid[l])
            continue;
        n[l] = tl_batch_count(batch, l);
        if (n[l].all == contacts->point_count[group->contact[l]] &&
            tl_batch_has_keys(batch, l, n[l], p->key + group->start + l, TL_LANES) &&
            !group_has_run(m, group->contact[l], batch, l, n[l]))
            same |= 1u << l;
    }
    *in &= ~same;
    for (uint32_t l = 0; same; l++) {
        patch_choice t;
        uint32_t now = 0;
        for (uint32_t k = 0; k < TL_LANES; k++) {
            bool like = same >> k & 1 && same >> l & 1 && n[k].all == n[l].all && n[k].corners == n[l].corners;
            t.mine[k] = like;
            now |= (uint32_t)like << k;
        }
        if (!now)
            continue;
        take_lanes(m, group, batch, n[l], now, &t);
        same &= ~now;
    }
}

bool tl_simd_group_update(tl_model *m, const tl_simd_group *group, unsigned thread)
{
    tl_patch_batch *batch = NULL;
    bool any = false;
    uint32_t in = 0, others = 0, fields[TL_LANES], field_count = 0;
    bool corners = m->config.contact_points == TL_POINTS_CORNERS;
    double tilt = tl_flush_limits_of(corners).points_tilt, steep = tilt * tilt;
    for (uint32_t l = 0; l < TL_LANES; l++) {
        uint32_t c = group->contact[l];
        if (c == TL_NO_ROW || tl_contact_points_hold(m, c))
            continue;
        any = true;
        if (tl_field_goes_on(m, c)) {
            fields[field_count++] = c;
            continue;
        }
        if (!batch && !(batch = tl_batch_begin(&m->detect->narrow[thread], corners, steep))) {
            m->detect->narrow[thread].failed = true;
            return true;
        }
        if (add_to_batch(m, c, l, corners, batch))
            in |= 1u << l;
        else
            others |= 1u << l;
    }
    if (in) {
        tl_batch_lay(batch);
        take_patches(m, group, batch, &in);
    }
    for (uint32_t l = 0; l < TL_LANES; l++)
        if ((in | others) >> l & 1)
            tl_contact_update(m, group->contact[l], thread);
    if (field_count)
        contacts_follow(m, fields, field_count, thread);
    return any;
}
