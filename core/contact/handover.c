/* handover.c - a manifold takes the place of a contact: a patch becomes a field contact, or the other way round, or its
 * points are other ones, or have moved.
 *
 * The shear of a field contact is one force and one torsion about the centre of its pressure. That of a patch
 * is a force at each point. Force and moment go over; the moment no further than the energy of the springs
 * goes. Area that comes brings no shear. Of the area that is there that goes first which carries the least
 * (resized). Neither makes energy.
 *
 * An initial stress of a patch, and slip that has opened its joint, move both faces outward, half each.
 * Together they move by as much as the springs would be pressed where the faces just meet: by the plane that
 * fits the lifts (lean.c). There the faces stay. */
#include "contact/handover.h"

#include "base/columns.h"
#include "contact/across_gap.h"
#include "contact/contacts.h"
#include "contact/cut_contacts.h"
#include "contact/lean.h"
#include "contact/pair_view.h"
#include "contact/places.h"
#include "contact/shear.h"
#include "contact/transfer.h"

#include <string.h>

/* An arm of a contact before the last turn, which was B's by the share `ride`, and A's by the rest. The forces are as
 * they were then: so must the arms be, or the torsion is another one for B. */
static tl_vec3 arm_before(const tl_model *m, uint32_t c, double ride, tl_vec3 arm)
{
    const tl_sides s = tl_contact_sides(m, c);
    const tl_vec3 a = tl_side_pose(m, s.a)->w_moved, b = tl_side_pose(m, s.b)->w_moved;
    const tl_vec3 turned = tl_v3_madd(a, ride, tl_v3_sub(b, a));
    return tl_v3_sub(arm, tl_v3_scale(m->dt, tl_v3_cross(turned, arm)));
}

/* From the centre of the new points to that of the old, before their last turns. The old one is carried by B by the
 * share `ride`; the new one comes half from A and half from B. So it is the same whichever block is A. */
static tl_vec3 arm_of_old(const tl_model *m, uint32_t c, double ride, tl_vec3 old, tl_vec3 centre)
{
    tl_contact_motion moved = tl_contact_moved(m, c);
    tl_vec3 passed = tl_v3_add(moved.way, tl_v3_cross(moved.turn, old));
    return arm_before(m, c, 0.5, tl_v3_sub(tl_v3_madd(old, 0.5 - ride, passed), centre));
}

/* The centroid of a contact's points, whose arms are in the lanes: of a field contact its centre of pressure. */
static tl_vec3 centre_of(const tl_model *m, uint32_t c, const tl_point_lanes *lanes)
{
    const tl_detect *d = m->detect;
    if (tl_facet_is_field(&d->contacts.facet[c]))
        return tl_columns_get(lanes->arm, TL_FIELD_SHEAR);
    tl_vec3 sum = {0, 0, 0};
    double area = tl_contact_area_of_points(d, c);
    for (size_t k = 0; k < d->contacts.point_count[c]; k++)
        sum = tl_v3_madd(sum, d->points.area[tl_point_row(&d->contacts, c, k)], tl_columns_get(lanes->arm, k));
    return tl_v3_scale(area > 0 ? 1 / area : 0, sum);
}

/* Energy of the springs of a field contact, times 2 ks, and its torsion. */
static tl_shear field_springs(const tl_model *m, uint32_t c)
{
    const tl_press_row *row = tl_press_row_of(m, c);
    tl_shear out = {.area = 0};
    tl_shear_add_field(m, c, &out);
    out.energy += row->spare[0] + row->spare[1];
    return out;
}

/* Of the points as they are, whose arms are in the lanes. */
static tl_shear shear_of(const tl_model *m, uint32_t c, const tl_point_lanes *lanes)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    bool springs = contacts->point_count[c] && tl_facet_is_field(&m->detect->contacts.facet[c]);
    tl_shear out = springs ? field_springs(m, c) : tl_shear_of(m, c);
    out.normal = contacts->facet[c].last;
    out.centre = centre_of(m, c, lanes);
    if (springs) {
        out.area = p->area[tl_point_row(contacts, c, TL_FIELD_TORSION)];
        out.force = tl_columns_get(p->f_s, tl_point_row(contacts, c, TL_FIELD_SHEAR));
        return out;
    }
    for (size_t k = 0; k < contacts->point_count[c]; k++) {
        tl_vec3 force = tl_columns_get(p->f_s, tl_point_row(contacts, c, k));
        tl_vec3 arm = tl_v3_sub(tl_columns_get(lanes->arm, k), out.centre);
        arm = arm_before(m, c, contacts->facet[c].ride, arm);
        out.torsion += tl_v3_dot(out.normal, tl_v3_cross(arm, force));
    }
    return out;
}

double tl_contact_lift_field(tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_press_row *row = tl_press_row_of(m, c);
    double opening[TL_LANES];
    if (!row || contacts->facet[c].kind != TL_FACET_FIELD || contacts->point_count[c] == 0)
        return 0;
    bool is_flat = row->opened == 0 && row->opening[0] == 0 && row->opening[1] == 0;
    if (is_flat && !tl_contact_opens(m, c))
        return 0;
    tl_contact_point_openings(m, c, 0, opening);
    if (row->lifted_at != m->cycles)
        row->opened = row->paid = 0;
    row->lifted_at = m->cycles;
    for (size_t k = 0; k < TL_FIELD_POINTS; k++) {
        double by = opening[k] - row->opening[k], closure = row->press.overlap + by;
        row->opening[k] = opening[k];
        row->opened += by;
        row->paid += by != 0 && closure > 0
                         ? m->detect->points.f_n[tl_point_row(contacts, c, k)] * by * (1 - 0.5 * by / closure)
                         : 0;
        row->shift += by;
    }
    return row->opened;
}

double tl_contact_lost(const tl_model *m, uint32_t c, tl_vec3 force, tl_vec3 moment, double stored)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_contact_motion after = tl_contact_moved(m, c), before = tl_contact_moved_from(m, c);
    double work = 0.5 * (tl_v3_dot(contacts->force[c], before.way) + tl_v3_dot(force, after.way) +
                         tl_v3_dot(tl_v3_add(contacts->moment[c], moment), after.turn));
    return isnan(contacts->stored[c]) ? 0 : contacts->stored[c] - stored - work;
}

/* Notes the heat of a contact that is left without points. Its faces stay moved out by `lift`, m: what slip has opened
 * is forgotten, and of a patch all. */
static void let_go(tl_model *m, uint32_t c, double lift)
{
    tl_press_row *row = tl_press_row_of(m, c);
    m->detect->contacts.released[c] = tl_contact_ends(m, c);
    if (row)
        row->shift = lift;
}

/* What the law keeps of a contact, as an old point: means over what presses. */
static tl_old_point mean_point(const tl_model *m, uint32_t c)
{
    const tl_points_table *p = &m->detect->points;
    const tl_contacts *contacts = &m->detect->contacts;
    size_t count = tl_contact_areas(m->detect, c);
    tl_old_point out = {.normal = contacts->facet[c].last};
    double force = 0, sum = 0;
    for (size_t k = 0; k < count; k++)
        force += fmax(0, p->f_n[tl_point_row(contacts, c, k)]);
    for (size_t k = 0; k < count; k++) {
        size_t i = tl_point_row(contacts, c, k);
        double share = force > 0 ? fmax(0, p->f_n[i]) : p->area[i];
        sum += share;
        out.area += share * p->area[i];
        out.flags |= p->flags[i];
        for (uint32_t s = 0; s < p->state_columns; s++)
            out.state[s] += share * p->state[s][i];
    }
    out.area /= sum > 0 ? sum : 1;
    for (uint32_t s = 0; s < p->state_columns && sum > 0; s++)
        out.state[s] /= sum;
    return out;
}

/* Gives new points flags and, with `known`, law states of an old point, in their plane. The torsion of a field
 * contact begins without a vector: its plane is another one. */
static void give_states(tl_model *m, uint32_t c, tl_old_point old, bool known)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    const tl_kind *kind = tl_law_kind(m, contacts->law[c]);
    tl_vec3 n = contacts->facet[c].last;
    if (old.normal.x != n.x || old.normal.y != n.y || old.normal.z != n.z)
        tl_states_turn(kind, p->state_columns, old.state, old.normal, n);
    for (size_t k = 0; k < contacts->point_count[c]; k++) {
        size_t i = tl_point_row(contacts, c, k);
        tl_state_columns at = {0};
        while (tl_facet_is_field(&m->detect->contacts.facet[c]) && k == TL_FIELD_TORSION &&
               tl_state_next(kind, p->state_columns, &at))
            if (at.count == 3)
                memset(&old.state[at.begin], 0, 3 * sizeof *old.state);
        p->flags[i] = old.flags;
        if (known)
            tl_point_take_state(p, i, kind, old.state, old.area, false);
    }
}

/* By how much leaning faces are farther out at a point of A's frame than those of the blocks, together, m. */
static double lean_at(const tl_model *m, uint32_t c, const tl_plane lean[2], const tl_plane faces[2], tl_vec3 p)
{
    tl_pair_view b = tl_contact_view(m, c);
    const tl_vec3 at[] = {p, tl_m3_tmul(&b.turn, tl_v3_sub(p, b.shift))};
    double out = 0;
    for (int k = 0; k < 2; k++)
        out += lean[k].offset - faces[k].offset - tl_v3_dot(tl_v3_sub(lean[k].normal, faces[k].normal), at[k]);
    return out;
}

/* Lets the points of a patch count their overlaps from a lift: of faces that lean, from that at their places. */
static void refer_to_lift(tl_model *m, uint32_t c, double lift)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    const tl_press_row *row = tl_press_row_of(m, c);
    for (size_t k = 0; k < contacts->point_count[c] && p->reference; k++) {
        size_t i = tl_point_row(contacts, c, k);
        p->reference[i] = -lift;
        if (row && row->leans)
            p->reference[i] -= lean_at(m, c, row->lean, row->shifted_at, tl_columns_get(p->p, i));
    }
}

/* Share of the force f of springs of some energy that stays on an area, without more energy. Energies times 2 ks. */
static double share_on(double f2, double energy, double area)
{
    return f2 > energy * area ? energy * area / f2 : 1;
}

/* Shear of what is left of it on a new area, as in `resized`, with an arm from the new centre to the old. */
static tl_shear left_on(const tl_shear *old, double area, tl_vec3 normal, tl_vec3 arm)
{
    double part = share_on(tl_v3_norm2(old->force), old->energy, area);
    tl_shear out = {.area = area, .energy = old->energy, .normal = normal};
    if (old->area > 0)
        out.force = tl_v3_scale(part, tl_v3_turn(old->force, old->normal, normal));
    out.force = tl_v3_madd(out.force, -tl_v3_dot(out.force, normal), normal);
    out.torsion = part * old->torsion + tl_v3_dot(normal, tl_v3_cross(arm, out.force));
    return out;
}

/* Torsion that springs may have beside a force, of the energy there is. */
static double allowed_torsion(const tl_shear *now)
{
    double rest = now->energy - tl_shear_energy(tl_v3_norm2(now->force), now->area);
    double most = now->polar * fmax(0, rest);
    return now->torsion * now->torsion > most ? copysign(sqrt(most), now->torsion) : now->torsion;
}

static void spread_over_patch(tl_model *m, uint32_t c, tl_shear *s, const tl_point_lanes *lanes)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    size_t count = contacts->point_count[c];
    for (size_t k = 0; k < count; k++) {
        tl_vec3 arm = tl_v3_sub(tl_columns_get(lanes->arm, k), s->centre);
        s->polar += p->area[tl_point_row(contacts, c, k)] * tl_v3_norm2(arm);
    }
    double torsion = allowed_torsion(s);
    for (size_t k = 0; k < count; k++) {
        size_t i = tl_point_row(contacts, c, k);
        tl_vec3 arm = tl_v3_sub(tl_columns_get(lanes->arm, k), s->centre);
        tl_vec3 f = tl_v3_scale(p->area[i] / s->area, s->force);
        f = tl_v3_madd(f, s->polar > 0 ? p->area[i] * torsion / s->polar : 0, tl_v3_cross(s->normal, arm));
        tl_columns_put(p->f_s, i, f);
    }
}

static void put_on_field(tl_model *m, uint32_t c, tl_shear *s)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    double radius = tl_press_row_of(m, c)->press.radius;
    s->polar = s->area * radius * radius;
    double torsion = allowed_torsion(s);
    tl_columns_put(p->f_s, tl_point_row(contacts, c, TL_FIELD_SHEAR), s->force);
    tl_columns_put(p->f_s, tl_point_row(contacts, c, TL_FIELD_TORSION),
                   tl_v3_scale(radius > 0 ? torsion / radius : 0, s->normal));
}

static void keep_press(tl_press_row *row, const tl_manifold *g)
{
    row->press = *g->press;
    if (tl_press_has_extra(g->press) && g->extra)
        row->extra = *g->extra;
}

/* Notes the press of points that have been written. What slip has opened is in it, and the law adds it. */
static void begin_field(tl_model *m, uint32_t c, const tl_manifold *g)
{
    tl_press_row *row = tl_press_row_of(m, c);
    double opening[TL_LANES];
    keep_press(row, g);
    tl_contact_point_openings(m, c, 0, opening); /* 0 without points */
    memcpy(row->opening, opening, sizeof row->opening);
    m->detect->contacts.facet[c].offset -= row->opening[TL_FIELD_SHEAR];
}

/* A new field contact of parts of blocks takes its area's share of what the whole carried. The law's states are
 * those of the point nearest to it. */
static void take_share(tl_model *m, uint32_t c, const tl_manifold *g, const tl_cut_contact *cut,
                       const tl_point_lanes *lanes)
{
    tl_contact_place_points(m, c, g, lanes);
    tl_vec3 at = tl_columns_get(lanes->arm, 0);
    tl_old_point nearest = {.area = 0};
    for (size_t k = 0; k < cut->count; k++) {
        tl_old_point point = tl_cut_contact_point(m, cut, c, k);
        if (k == 0 || tl_v3_norm2(tl_v3_sub(point.arm, at)) < tl_v3_norm2(tl_v3_sub(nearest.arm, at)))
            nearest = point;
    }
    tl_shear whole = cut->whole;
    whole.normal = nearest.normal;
    whole.force = tl_v3_scale(tl_cut_contact_sign(m, cut, c), whole.force);
    bool known = tl_cut_contact_is_of_law(m, cut, c);
    nearest.normal = tl_v3(0, 0, 0); /* vectors are brought into the plane, and not turned */
    nearest.flags = known ? nearest.flags : 0;
    give_states(m, c, nearest, known);
    begin_field(m, c, g);
    tl_shear_keep(m, c, tl_cut_contact_kept(m, cut, c));
    double area = g->points[0].area, share = tl_cut_contact_share(cut, area);
    whole.force = tl_v3_scale(share, whole.force);
    whole.torsion *= share * share;
    whole.energy *= share;
    tl_shear now = left_on(&whole, area, m->detect->contacts.facet[c].last, tl_v3(0, 0, 0));
    put_on_field(m, c, &now);
}

void tl_press_shift_faces(tl_model *m, uint32_t c, tl_face_pair faces)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_press_row *row = tl_press_row_of(m, c);
    row->shifted = faces;
    row->shifted_at[0] = tl_pair_shape(m, contacts->a[c], contacts->b[c])->plane[faces.a];
    row->shifted_at[1] = tl_pair_shape(m, contacts->b[c], contacts->a[c])->plane[faces.b];
    row->frame[0] = tl_block_frame_of(m, contacts->a[c]);
    row->frame[1] = tl_block_frame_of(m, contacts->b[c]);
}

/* Moves the faces of a patch apart as its points are lifted. */
static void lift_faces(tl_model *m, uint32_t c, const tl_point_lanes *lanes)
{
    const tl_facet *facet = &m->detect->contacts.facet[c];
    tl_press_row *row = tl_press_row_of(m, c);
    const tl_lean lean = tl_contact_lean(m, c, lanes);
    row->shift = lean.mean;
    row->leans = lean.leans;
    memcpy(row->lean, lean.face, sizeof row->lean);
    tl_press_shift_faces(m, c, (tl_face_pair){facet->ia, facet->ib});
}

/* Puts the manifold's points in the place of the contact's, for which there is room, and notes the press of a field.
 * Force and moment of the shear are kept as far as the energy of its springs goes. The moment is lost where the old
 * points are `reframed`, in frames that are no more. */
static void hand_over(tl_model *m, uint32_t c, const tl_manifold *g, bool reframed, const tl_point_lanes *lanes)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_press_row *row = tl_press_row_of(m, c);
    bool field = g->facet.kind == TL_FACET_FIELD, held = contacts->point_count[c] > 0;
    const tl_cut_contact *cut = held ? NULL : tl_cut_contact_of(m, contacts->a[c], contacts->b[c]);
    if (cut && g->point_count && field) {
        take_share(m, c, g, cut, lanes);
        return;
    }
    tl_contact_places(m, c, lanes);
    tl_shear old = shear_of(m, c, lanes);
    tl_old_point mean = mean_point(m, c);
    const double kept = tl_shear_kept(m, c), ride = contacts->facet[c].ride;
    if (row && held && !tl_facet_is_field(&m->detect->contacts.facet[c]))
        lift_faces(m, c, lanes);
    double lift = row ? row->shift - row->opening[TL_FIELD_SHEAR] : 0;
    tl_contact_place_points(m, c, g, lanes);
    /* bonds end with their patch, and walls that meet at an edge have none */
    mean.flags |= TL_POINT_APART;
    give_states(m, c, mean, held);
    if (row)
        row->spare[0] = row->spare[1] = 0;
    if (field)
        begin_field(m, c, g);
    else
        refer_to_lift(m, c, lift);
    tl_shear_keep(m, c, kept);
    if (g->point_count == 0)
        let_go(m, c, lift);
    contacts->handed_over[c] = held && g->point_count > 0;
    if (!contacts->handed_over[c])
        return;
    tl_vec3 centre = centre_of(m, c, lanes), arm = arm_of_old(m, c, ride, old.centre, centre);
    if (reframed) {
        old.torsion = 0;
        arm = tl_v3(0, 0, 0);
    }
    double area = tl_contact_area_of_points(m->detect, c);
    tl_shear now = left_on(&old, area, contacts->facet[c].last, arm);
    now.centre = centre;
    if (field)
        put_on_field(m, c, &now);
    else
        spread_over_patch(m, c, &now, lanes);
}

/* Gives a shear spring of force f and area `old` another area, `now`. Area that comes carries nothing until it
 * is sheared, so the energy stays with what was there: `spare` is by how much it is more than that of the same
 * force spread over all. Area that goes carries the least, which costs nothing while the force on what is left
 * has no more energy than there is. From then on the stress stays, and the force goes with the area. All of it
 * is continuous in area and force, and an area that swings costs nothing from the second time on. Energies
 * times 2 ks. Returns the share of the force that stays. */
static double resized(double f2, double old, double now, double *spare)
{
    double energy = tl_shear_energy(f2, old) + *spare;
    double part = share_on(f2, energy, now);
    *spare = fmax(0, energy - tl_shear_energy(f2, now));
    return part;
}

/* Half of the way of the centre of pressure in the last step, in A's frame; 0 where none has been noted. */
static tl_vec3 half_way(const tl_model *m, const tl_press_row *row)
{
    return row->moved_at == m->cycles ? row->half : tl_v3(0, 0, 0);
}

/* The work in the last step of a force and a moment that acted at the centre of pressure before it, J. */
static double work_on(tl_model *m, uint32_t c, const tl_manifold *g, tl_vec3 force, tl_vec3 twist)
{
    const tl_contact_motion by = tl_contact_moved(m, c);
    tl_vec3 before = tl_v3_madd(g->points[0].p, -2, half_way(m, tl_press_row_of(m, c)));
    tl_vec3 arm = tl_side_arm(m, tl_contact_sides(m, c).a, before);
    tl_vec3 du = tl_v3_add(by.way, tl_v3_cross(by.turn, arm));
    return tl_v3_dot(force, du) + tl_v3_dot(twist, by.turn);
}

/* Shear and torsion for a new area and radius. */
static void refit_springs(tl_model *m, uint32_t c, const tl_manifold *g)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    tl_press_row *row = tl_press_row_of(m, c);
    size_t first = tl_point_row(contacts, c, TL_FIELD_SHEAR);
    size_t torsion = tl_point_row(contacts, c, TL_FIELD_TORSION);
    double old = p->area[torsion], area = g->points[0].area;
    double r0 = row->press.radius, r1 = g->press->radius;
    double polar = old * r0 * r0, now = area * r1 * r1;
    tl_vec3 force = tl_columns_get(p->f_s, first);
    tl_vec3 twist = tl_v3_scale(r0, tl_columns_get(p->f_s, torsion));
    double f2 = tl_v3_norm2(force), t2 = tl_v3_norm2(twist);
    double lost = tl_shear_energy(f2, old) + tl_shear_energy(t2, polar) + row->spare[0] + row->spare[1];
    /* what slips is at its limit everywhere, under a pressure that is not uniform */
    if (p->flags[first] & TL_POINT_SLIPPING)
        row->spare[0] = fmin(row->spare[0], tl_shear_energy(f2, old));
    if (p->flags[torsion] & TL_POINT_SLIPPING)
        row->spare[1] = fmin(row->spare[1], tl_shear_energy(t2, polar));
    double stays = resized(f2, old, area, &row->spare[0]);
    double stays_turned = resized(t2, polar, now, &row->spare[1]);
    lost -= tl_shear_energy(stays * stays * f2, area) + tl_shear_energy(stays_turned * stays_turned * t2, now) +
            row->spare[0] + row->spare[1];
    double work = stays < 1 || stays_turned < 1
                      ? work_on(m, c, g, tl_v3_scale(1 - stays, force), tl_v3_scale(1 - stays_turned, twist))
                      : 0;
    double ks = contacts->law[c] == TL_NO_ROW ? 0 : m->joint_laws[contacts->law[c]].ks;
    contacts->released[c] += ks > 0 ? 0.5 * (lost / ks - work) : 0;
    tl_columns_put(p->f_s, first, tl_v3_scale(stays, force));
    tl_columns_put(p->f_s, torsion, tl_v3_scale(r1 > 0 ? stays_turned / r1 : 0, twist));
    p->area[first] = p->area[torsion] = area;
}

/* Notes half of the way of the centre of pressure in the last step. The old one has gone half with A and half
 * with B. A step that is made again finds the points where it left them, and keeps what it has noted. A contact
 * that has gone by slopes for long has stayed where it is. */
static void note_way(tl_model *m, uint32_t c, tl_vec3 centre)
{
    tl_press_row *row = tl_press_row_of(m, c);
    const bool stays = row->by_slope && m->cycles - row->since >= TL_PRESS_STEPS;
    if (row->moved_at == m->cycles || stays)
        return;
    const tl_contact_motion by = tl_contact_moved(m, c);
    const tl_mat3 *turn = tl_side_rotation(m, tl_contact_sides(m, c).a);
    tl_vec3 old = tl_columns_get(m->detect->points.p, tl_point_row(&m->detect->contacts, c, TL_FIELD_SHEAR));
    tl_vec3 passed = tl_v3_add(by.way, tl_v3_cross(by.turn, tl_m3_mul(turn, old)));
    old = tl_v3_madd(old, 0.5, tl_m3_tmul(turn, passed));
    row->half = tl_v3_scale(0.5, tl_v3_sub(centre, old));
    row->moved_at = m->cycles;
}

/* Puts the manifold of a field contact in the place of what it was. */
static void refit_field(tl_model *m, uint32_t c, const tl_manifold *g)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    tl_press_row *row = tl_press_row_of(m, c);
    tl_facet *facet = &contacts->facet[c];
    double area = p->area[tl_point_row(contacts, c, TL_FIELD_TORSION)];
    note_way(m, c, g->points[0].p);
    /* what is found again in the same place stays what it is, to the bit */
    if (g->points[0].area != area || g->press->radius != row->press.radius)
        refit_springs(m, c, g);
    for (size_t k = 0; k < TL_FIELD_POINTS; k++)
        tl_columns_put(p->p, tl_point_row(contacts, c, k), g->points[0].p);
    facet->na = g->facet.na;
    facet->offset = g->facet.offset - row->opening[TL_FIELD_SHEAR];
    facet->ia = g->facet.ia;
    facet->ib = g->facet.ib;
    keep_press(row, g);
}

double tl_contact_sheared(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    if (!tl_facet_is_field(&contacts->facet[c]) || contacts->law[c] == TL_NO_ROW)
        return 0;
    double ks = m->joint_laws[contacts->law[c]].ks;
    return tl_shear_kept(m, c) + (ks > 0 && contacts->point_count[c] ? 0.5 * field_springs(m, c).energy / ks : 0);
}

/* ---------------------------------------------------------------- taking ----------------- */

/* New places and areas of the same points. */
static void refit_patch(tl_model *m, uint32_t c, const tl_manifold *g)
{
    tl_detect *d = m->detect;
    tl_points_table *p = &d->points;
    tl_shear before = tl_shear_of(m, c);
    tl_vec3 last = d->contacts.facet[c].last;
    d->contacts.facet[c] = g->facet;
    d->contacts.facet[c].last = last;
    uint32_t law = d->contacts.law[c];
    const tl_kind *kind = NULL; /* of states that go with the area */
    if (law != TL_NO_ROW && m->joint_laws[law].splits)
        kind = m->joint_laws[law].kind;
    for (size_t k = 0; k < g->point_count; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        double old = p->area[i], state[TL_STATE_COLUMNS];
        tl_columns_put(p->p, i, g->points[k].p);
        tl_point_resize(p, i, g->points[k].area);
        if (kind && g->points[k].area != old) {
            for (uint32_t column = 0; column < p->state_columns; column++)
                state[column] = p->state[column][i];
            tl_point_take_state(p, i, kind, state, old, true);
        }
    }
    tl_shear now = tl_shear_of(m, c);
    tl_shear_resized(m, c, &before, &now);
}

static bool take_patch(tl_model *m, uint32_t c, bool stays, tl_narrow_scratch *scratch, const tl_point_lanes *lanes)
{
    const tl_manifold *g = &scratch->manifold;
    bool done = true;
    if (stays) {
        refit_patch(m, c, g);
    } else if (tl_facet_is_field(&m->detect->contacts.facet[c])) {
        hand_over(m, c, g, scratch->reframed, lanes);
    } else {
        done = tl_contact_transfer(m, c, scratch, lanes);
        if (g->point_count == 0)
            let_go(m, c, 0);
    }
    return done;
}

static bool take_field(tl_model *m, uint32_t c, bool stays, tl_narrow_scratch *scratch, const tl_point_lanes *lanes)
{
    const tl_manifold *g = &scratch->manifold;
    if (!stays)
        hand_over(m, c, g, scratch->reframed, lanes);
    else if (g->point_count > 0)
        refit_field(m, c, g);
    return true;
}

const tl_kind_make tl_patch_make = {.take = take_patch};
const tl_kind_make tl_field_make = {.take = take_field};
