/* fields.c - field contacts from step to step.
 *
 * A contact that has stayed near a place for some time goes by the slopes that its press has there. So does one in
 * motion, a little way for some steps, as far as the energy balance allows. Others go by their list of faces,
 * while that holds. */
#include "detect/fields.h"

#include "contact/across_gap.h"
#include "contact/contacts.h"
#include "contact/cut_contacts.h"
#include "contact/handover.h"
#include "contact/lean.h"
#include "contact/pair_view.h"
#include "contact/places.h"
#include "narrow/flush.h"
#include "narrow/narrow.h"
#include "narrow/press.h"

#include <math.h>
#include <string.h>

/* ---------------------------------------------------------------- before ----------------- */

/* Tolerance: tilt, as a sine, beyond which bonds of two faces end: 3 degrees. The overlap of a patch is that along one
 * normal, whose cosine is wrong by 1e-3 there. */
#define BONDED_TILT 0.05

/* How far the blocks of a field contact have moved against each other in the last step: at its point, and by their turn
 * so far from it. */
static double last_way(const tl_model *m, uint32_t c, double lever)
{
    tl_contact_motion by = tl_contact_moved(m, c);
    tl_vec3 arm = tl_side_arm(m, tl_contact_sides(m, c).a, tl_press_row_of(m, c)->press.point);
    return tl_v3_norm(tl_v3_add(by.way, tl_v3_cross(by.turn, arm))) + lever * tl_v3_norm(by.turn);
}

/* Whether the blocks of a field contact hardly moved against each other in the last step: only then may it become a
 * patch. A patch spreads the shear anew: where faces only pass by each other that would turn some of it into heat. */
static bool is_calm(const tl_model *m, uint32_t c)
{
    double size = tl_contact_size(m, c);
    return last_way(m, c, size) < tl_still_share(m) * size;
}

static double bonded_tilt(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_facet *f = &contacts->facet[c];
    const bool corners = tl_pair_at_corners(m, contacts->a[c], f->ia, contacts->b[c], f->ib);
    return fmax(BONDED_TILT, tl_flush_limits_of(corners).tilt);
}

/* How far apart the blocks may be while faces press that are moved so. */
static double reach_of(const tl_model *m, uint32_t c, const tl_manifold_before *before)
{
    double size = tl_contact_size(m, c);
    const tl_plane *face = before->leans ? before->lean : NULL;
    tl_vec3 n = {0, 0, 0};
    const tl_contacts *contacts = &m->detect->contacts;
    if (face)
        n = tl_pair_shape(m, contacts->a[c], contacts->b[c])->plane[before->shifted.a].normal;
    return tl_lean_reach(before->shift, face, n, size);
}

/* Notes how far the faces of a field contact are moved out. */
static void note_moved_faces(const tl_model *m, uint32_t c, const tl_press_row *row, tl_manifold_before *to)
{
    to->shift = row->shift;
    to->shifted = row->shifted;
    to->leans = row->leans;
    memcpy(to->lean, row->lean, sizeof to->lean);
    to->reach = reach_of(m, c, to);
    to->opened = row->lifted_at == m->cycles ? row->opened : 0;
}

tl_manifold_before tl_contact_before(const tl_model *m, uint32_t c, bool reframed, const tl_point_lanes *lanes)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_facet *facet = &contacts->facet[c];
    const tl_press_row *row = tl_press_row_of(m, c);
    tl_manifold_before out = {.kind = (tl_facet_kind)facet->kind,
                              .faces = {facet->ia, facet->ib},
                              .born_tilt = tl_cut_contact_tilt(m, contacts->a[c], contacts->b[c])};
    bool patch = out.kind == TL_FACET_PATCH && (contacts->point_count[c] > 0 || contacts->holds_over_gap[c]);
    if (patch) {
        tl_contact_across across = tl_contact_across_gap(m, c);
        bool unseen = contacts->point_count[c] == 0; /* of a cut contact, until it has got its room */
        out.holds = reframed || unseen || across.bonded;
        out.most_tilt = across.bonded && !reframed ? bonded_tilt(m, c) : INFINITY;
        out.over = out.holds ? INFINITY : TL_PARTED * across.most;
        const tl_lean lean = tl_contact_lean(m, c, lanes);
        out.shift = lean.mean;
        out.shifted = out.faces;
        out.leans = lean.leans;
        memcpy(out.lean, lean.face, sizeof out.lean);
        out.reach = reach_of(m, c, &out);
    } else if (row) {
        out.calm = !reframed && is_calm(m, c);
        note_moved_faces(m, c, row, &out);
    }
    return out;
}

/* ---------------------------------------------------------------- faces ------------------ */

/* Gives planes of a mesh their new numbers; false: one has none. */
static bool renumber(uint8_t *plane, uint32_t count, const uint8_t *now)
{
    bool all = true;
    for (size_t k = 0; k < count; k++) {
        uint8_t number = plane[k] == TL_MESH_ZERO ? TL_MESH_ZERO : now[plane[k]];
        all = all && (plane[k] == TL_MESH_ZERO || number != TL_MESH_ZERO);
        plane[k] = number;
    }
    return all;
}

tl_field_mesh tl_field_listed_anew(const tl_press_row *row, const tl_region *r)
{
    const uint32_t count[] = {r->a, r->b, r->border_a, r->border_b};
    uint8_t now[TL_PRESS_FACES];
    tl_field_mesh mesh = {0};
    if (!row->listed)
        return mesh;
    mesh = row->mesh;
    mesh.bounding = 0;
    uint32_t old = 0, begin = 0;
    for (int kind = 0; kind < 4; begin += count[kind++]) {
        for (uint32_t left = row->count[kind]; left > 0; left--, old++) {
            uint32_t at = begin, end = begin + count[kind];
            while (at < end && r->face[at] != row->face[old])
                at++;
            bool there = at < end && at < TL_FIELD_KNOWN;
            now[old] = there ? (uint8_t)at : TL_MESH_ZERO;
            if (!(row->mesh.bounding >> old & 1))
                continue;
            if (!there)
                return (tl_field_mesh){0};
            mesh.bounding |= UINT64_C(1) << at;
        }
    }
    if (!mesh.bounding && !mesh.polygons)
        return (tl_field_mesh){0};
    bool all = renumber(mesh.own[0], 2u * mesh.polygons, now);
    for (int k = 0; k < 4; k++)
        all = all && renumber(mesh.plane[k], tl_mesh_lanes(&mesh), now);
    for (int k = 0; k < 2; k++)
        all = all && renumber(mesh.apex[k].held, mesh.apex[k].holds, now) &&
              renumber(mesh.apex[k].stray, mesh.apex[k].strays, now);
    if (!all) /* nothing of what has the old numbers is left */
        mesh = (tl_field_mesh){.bounding = mesh.bounding};
    return mesh;
}

void tl_field_keep(tl_press_row *row, const tl_pair_view *view, const tl_region *r, bool calm)
{
    row->refused = calm;
    uint32_t faces = r->a + r->b + r->border_a + r->border_b;
    row->by_slope = false;
    row->flat = *r->flat;
    row->listed_at = (tl_pair_pose){view->turn, view->shift};
    row->listed_shift = row->shift;
    row->listed = faces <= TL_PRESS_FACES;
    row->flush = r->flush;
    row->blunt_a = (uint16_t)r->blunt_a;
    row->blunt_b = (uint16_t)r->blunt_b;
    if (!row->listed)
        return;
    const uint32_t count[] = {r->a, r->b, r->border_a, r->border_b};
    for (int k = 0; k < 4; k++)
        row->count[k] = (uint16_t)count[k];
    memcpy(row->face, r->face, faces * sizeof *r->face);
    row->mesh = *r->mesh;
}

static tl_region kept_region(tl_press_row *row)
{
    return (tl_region){.mesh = &row->mesh,
                       .flat = &row->flat,
                       .a = row->count[0],
                       .b = row->count[1],
                       .border_a = row->count[2],
                       .border_b = row->count[3],
                       .face = row->face,
                       .flush = row->flush,
                       .blunt_a = row->blunt_a,
                       .blunt_b = row->blunt_b};
}

/* ---------------------------------------------------------------- places ----------------- */

/* The square of the longest way of some vertices x, the change of a matrix times x plus a vector. */
static double longest_way(const tl_vec3 *x, uint32_t count, const tl_mat3 *change, tl_vec3 way)
{
    double most = 0;
    for (uint32_t i = 0; i < count; i++) {
        double moved = tl_v3_norm2(tl_v3_add(tl_m3_mul(change, x[i]), way));
        most = moved > most ? moved : most;
    }
    return most;
}

/* The farthest that a vertex of either block has moved against the other block, since B was at a place. */
static double way_since(const tl_pair_view *view, const tl_pair_pose *since)
{
    tl_mat3 change, back;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            back.m[k][i] = change.m[i][k] = view->turn.m[i][k] - since->turn.m[i][k];
    const tl_vec3 now = tl_m3_tmul(&view->turn, view->shift), then = tl_m3_tmul(&since->turn, since->shift);
    const tl_poly *a = view->a, *b = view->b;
    double of_b = longest_way(b->vertex, b->vertex_count, &change, tl_v3_sub(view->shift, since->shift));
    double of_a = longest_way(a->vertex, a->vertex_count, &back, tl_v3_sub(then, now)); /* in B's frame */
    return sqrt(fmax(of_a, of_b));
}

/* Whether the faces of a contact are listed still. By the odometers, which count the motion of both blocks together,
 * and when that has run out by their motion against each other. */
static bool is_listed(tl_model *m, uint32_t c, const tl_press_row *row)
{
    tl_contacts *contacts = &m->detect->contacts;
    double odometer = tl_contact_odometer(m, c);
    if (odometer <= contacts->faces_valid_to[c])
        return true;
    if (contacts->faces_valid_to[c] == TL_OUTDATED) /* it is to be looked at in any case */
        return false;
    tl_pair_view view = tl_contact_view(m, c);
    double moved = way_since(&view, &row->listed_at) + fabs(row->shift - row->listed_shift);
    double left = TL_LIST_MARGIN * view.size - moved;
    if (left > 0)
        contacts->faces_valid_to[c] = odometer + left;
    return left > 0;
}

bool tl_field_goes_on(tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_press_row *row = tl_press_row_of(m, c);
    return row && row->listed && tl_facet_is_field(&contacts->facet[c]) && contacts->point_count[c] > 0 &&
           contacts->deep[c] == TL_DEEP_NOT && is_listed(m, c, row);
}

/* Whether a contact may go by slopes of its press: these are of the energy only. */
static bool takes_slopes(const tl_model *m, uint32_t c)
{
    uint32_t law = m->detect->contacts.law[c];
    bool tells = law != TL_NO_ROW && tl_law_presses(&m->joint_laws[law]);
    return !tells && m->config.reuse_geometry;
}

/* How far a contact may go by slopes in motion, over its overlap. */
static double reach_in_motion(const tl_model *m)
{
    return TL_PRESS_NEAR + m->detect->balance_left * (TL_PRESS_REACH - TL_PRESS_NEAR);
}

/* The press of a contact near the place of its slopes. false: it has none, or is not near. They last by the count of
 * steps, not of looks: a step made again finds the same. */
static bool is_near(const tl_model *m, uint32_t c, const tl_pair_pose *now, tl_press *press)
{
    const tl_press_row *row = tl_press_row_of(m, c);
    const double reach = m->cycles - row->since < TL_PRESS_STEPS ? reach_in_motion(m) : TL_PRESS_NEAR;
    return row->by_slope && takes_slopes(m, c) && m->detect->contacts.points_valid_to[c] != TL_OUTDATED &&
           tl_press_near(&row->there, &row->slope, &row->place, now, reach, press);
}

/* Whether slopes of the mesh at the present place may be of use: the contact does not move as far in a step as they
 * reach in motion. */
static bool wants_slopes(const tl_model *m, uint32_t c)
{
    const tl_press_row *row = tl_press_row_of(m, c);
    const tl_press *press = &row->press;
    if (!takes_slopes(m, c))
        return false;
    return m->detect->balance_left > 0 && last_way(m, c, tl_press_lever(press)) <= reach_in_motion(m) * press->deepest;
}

/* Finds the slopes of the press just found when the contact has stayed where it is for as many steps as that costs. In
 * motion it keeps those that the mesh has told, in which areas stay as they are. false: out of memory. */
static bool watch(const tl_model *m, const tl_press_query *query, const tl_press *press, tl_press_row *row,
                  tl_narrow_scratch *scratch)
{
    const tl_pair_pose place = {query->view->turn, query->view->shift};
    const bool told = query->slope && query->slope->known;
    bool stays = tl_press_stays(press, &row->place, &place, 0.5 * TL_PRESS_NEAR);
    const bool moves = told && m->detect->balance_left > 0;
    if (!stays || moves) {
        row->place = place;
        row->since = m->cycles;
    }
    bool rests = stays && m->cycles - row->since >= TL_PRESS_SLOPE_COST && (press->patch < 1 || row->refused) &&
                 !press->powers && m->config.reuse_geometry; /* slopes are of the energy only */
    if (!rests && !moves)
        return true;
    tl_press_slope slope;
    if (!rests)
        slope = tl_press_slope_of(press, query->slope);
    else if (!tl_press_slope_find(query, press, scratch, &slope))
        return false;
    row->place = place;
    if (slope.known) {
        row->by_slope = true;
        row->there = *press;
        row->slope = slope;
    }
    return true;
}

/* Moves faces apart by what slip has opened. true: it has, so what is known of the field at this place holds no
 * more. */
static bool lift(tl_model *m, uint32_t c)
{
    double by = tl_contact_lift_field(m, c);
    m->detect->contacts.faces_valid_to[c] -= fabs(by);
    return by != 0;
}

/* Adds a contact, of which there is the view, to those of which the presses are to be found. */
static void ask(tl_model *m, tl_field_batch *b, uint32_t c)
{
    tl_press_row *row = tl_press_row_of(m, c);
    uint32_t k = b->asked++;
    const tl_pair_view *view = &b->view[k];
    if (row->by_slope) /* its slopes have taken the place of that mesh */
        row->flat = (tl_field_mesh){0};
    row->by_slope = false;
    const tl_contacts *contacts = &m->detect->contacts;
    tl_touch_rule rule = tl_touch_rule_of(m, contacts->a[c], contacts->b[c], view, contacts->tag[c], 0);
    b->region[k] = kept_region(row);
    tl_manifold_before before = {.kind = TL_FACET_FIELD};
    note_moved_faces(m, c, row, &before);
    b->query[k] = tl_manifold_query(view, &b->region[k], &rule, &before);
    b->query[k].faces_only = true;
    b->query[k].lean = row->leans ? row->lean : NULL; /* that lasts */
    b->query[k].slope = wants_slopes(m, c) ? &b->slope[k] : NULL;
}

bool tl_field_press_anew(tl_model *m, uint32_t c, tl_narrow_scratch *scratch)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_press_row *row = tl_press_row_of(m, c);
    tl_pair_view view = tl_contact_view(m, c);
    tl_touch_rule rule = tl_touch_rule_of(m, contacts->a[c], contacts->b[c], &view, contacts->tag[c], 0);
    tl_manifold_before before = {.kind = TL_FACET_FIELD};
    tl_region region;
    note_moved_faces(m, c, row, &before);
    before.opened = 0;
    if (!tl_pair_place(&view, scratch) ||
        !tl_region_find(&view, TL_LIST_MARGIN * view.size + before.reach, scratch, &region))
        return false;
    region.mesh = NULL;
    const tl_press_query query = tl_manifold_query(&view, &region, &rule, &before);
    row->by_slope = false;
    row->mesh = row->flat = (tl_field_mesh){0};
    contacts->faces_valid_to[c] = contacts->points_valid_to[c] = TL_OUTDATED;
    return tl_press_find(&query, 1, scratch, &row->press, &row->extra);
}

void tl_fields_follow(tl_model *m, tl_field_batch *b, tl_narrow_scratch *scratch)
{
    b->asked = 0;
    for (uint32_t k = 0; k < b->count; k++) {
        uint32_t c = b->contact[k];
        tl_pair_view *view = &b->view[b->asked];
        *view = tl_contact_view(m, c);
        const tl_pair_pose place = {view->turn, view->shift};
        b->near[k] = !lift(m, c) && is_near(m, c, &place, &b->press[k]);
        if (!b->near[k])
            ask(m, b, c);
    }
    b->failed = !tl_pairs_reserve(b->view, b->asked, scratch);
    if (b->failed)
        return;
    for (uint32_t k = 0; k < b->asked; k++) {
        const tl_region *r = &b->region[k];
        const uint16_t *of_b = r->face + r->a, *borders_of_b = of_b + r->b + r->border_a;
        tl_pair_place_normals(&b->view[k], of_b, r->b);
        tl_pair_place_normals(&b->view[k], borders_of_b, r->border_b);
        tl_region_choose_flush(&b->view[k], &b->region[k]);
    }
    b->failed = !tl_press_find(b->query, b->asked, scratch, b->found, b->extra);
    b->asked = 0;
}

/* Whether a contact may be a patch now. One that was none when it lay still here is none yet. */
static bool may_be_patch(const tl_model *m, uint32_t c, const tl_pair_view *view, const tl_press *press)
{
    const tl_press_row *row = tl_press_row_of(m, c);
    return press->patch >= 1 && is_calm(m, c) &&
           !(row->refused && way_since(view, &row->listed_at) < TL_STILL * view->size);
}

tl_field_result tl_field_take(tl_model *m, tl_field_batch *b, uint32_t k, tl_narrow_scratch *scratch)
{
    uint32_t c = b->contact[k];
    tl_press_row *row = tl_press_row_of(m, c);
    const tl_press *press = &b->press[k];
    const tl_press_extra *extra = NULL;
    const tl_facet *facet = &m->detect->contacts.facet[c];
    tl_face_pair faces = {facet->ia, facet->ib};
    if (b->failed)
        return TL_FIELD_FAILED;
    if (!b->near[k]) {
        uint32_t i = b->asked++;
        press = &b->found[i];
        extra = &b->extra[i];
        if (!(press->area > 0) || may_be_patch(m, c, &b->view[i], press))
            return TL_FIELD_LOST; /* it may be a patch or nothing now */
        if (!watch(m, &b->query[i], press, row, scratch))
            return TL_FIELD_FAILED;
        faces = (tl_face_pair){b->region[i].flush_a, b->region[i].flush_b};
    }
    return tl_manifold_press(press, extra, faces, scratch) ? TL_FIELD_FOUND : TL_FIELD_FAILED;
}
