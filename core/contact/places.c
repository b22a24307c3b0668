/* places.c - contacts one by one: where their facets and points are, for those who ask between steps and for points
 * that are new. */
#include "contact/places.h"

#include "base/columns.h"
#include "base/extremes.h"
#include "contact/kind.h"
#include "contact/sides.h"
#include "narrow/frame2.h"

static tl_body_frames body_frames_of(const tl_model *m, uint32_t c)
{
    const tl_sides s = tl_contact_sides(m, c);
    return (tl_body_frames){.ra = tl_side_rotation(m, s.a), .rb = tl_side_rotation(m, s.b), .d = tl_sides_apart(m, s)};
}

static tl_facing_place place_of(const tl_model *m, uint32_t c, const tl_body_frames *frames)
{
    return tl_contact_kind_of(m->detect, c)->place->place(&m->detect->contacts.facet[c], frames);
}

static tl_facing facing_of(const tl_model *m, uint32_t c, const tl_body_frames *frames)
{
    return tl_contact_kind_of(m->detect, c)->place->facing(&m->detect->contacts.facet[c], frames);
}

static tl_vec3 placed(const tl_facing_place *place, tl_vec3 p)
{
    return tl_v3_add(tl_m3_mul(&place->to, p), place->at);
}

tl_vec3 tl_contact_places(const tl_model *m, uint32_t contact, const tl_point_lanes *l)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    tl_body_frames frames = body_frames_of(m, contact);
    tl_facing to = facing_of(m, contact, &frames);
    tl_facing_place place = place_of(m, contact, &frames);
    for (size_t k = 0; k < contacts->point_count[contact]; k++) {
        size_t row = tl_point_row(contacts, contact, k);
        tl_vec3 x = placed(&place, tl_columns_get(p->p, row));
        tl_columns_put(l->arm, k, x);
        tl_columns_put(l->normal, k, to.n);
        l->closure[k] = to.offset - tl_v3_dot(to.plane, x) - (p->reference ? p->reference[row] : 0);
    }
    return to.n;
}

/* The motion of B against A in the last step, about A's centroid as B's centroid was seen from it `back` s before the
 * end. */
static tl_contact_motion moved(const tl_model *m, uint32_t c, double back)
{
    const tl_sides s = tl_contact_sides(m, c);
    const tl_pose *a = tl_side_pose(m, s.a), *b = tl_side_pose(m, s.b);
    const tl_vec3 centroids = tl_v3_sub(b->v_moved, a->v_moved);
    const tl_vec3 apart = tl_v3_madd(tl_sides_apart(m, s), -back, centroids);
    const tl_vec3 way = tl_v3_sub(centroids, tl_v3_cross(b->w_moved, apart));
    return (tl_contact_motion){tl_v3_scale(m->dt, way), tl_v3_scale(m->dt, tl_v3_sub(b->w_moved, a->w_moved))};
}

tl_contact_motion tl_contact_moved(const tl_model *m, uint32_t c)
{
    return moved(m, c, 0);
}

tl_contact_motion tl_contact_moved_from(const tl_model *m, uint32_t c)
{
    return moved(m, c, m->dt);
}

tl_facing_place tl_contact_place(const tl_model *m, uint32_t contact)
{
    const tl_body_frames frames = body_frames_of(m, contact);
    return place_of(m, contact, &frames);
}

tl_vec3 tl_contact_point_arm(const tl_model *m, uint32_t contact, size_t k)
{
    tl_body_frames frames = body_frames_of(m, contact);
    tl_facing_place place = place_of(m, contact, &frames);
    return placed(&place, tl_columns_get(m->detect->points.p, tl_point_row(&m->detect->contacts, contact, k)));
}

void tl_contact_point_places(const tl_model *m, uint32_t contact, tl_vec3 *place, double *gap)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_body_frames frames = body_frames_of(m, contact);
    tl_facing to = facing_of(m, contact, &frames);
    tl_facing_place at = place_of(m, contact, &frames);
    tl_vec3 from = tl_side_place(m, tl_contact_sides(m, contact).a);
    for (size_t k = 0; k < contacts->point_count[contact]; k++) {
        size_t row = tl_point_row(contacts, contact, k);
        tl_vec3 x = placed(&at, tl_columns_get(m->detect->points.p, row));
        place[k] = tl_v3_add(from, x);
        gap[k] = tl_v3_dot(to.plane, x) - to.offset;
    }
}

/* The smallest gap at a corner of a patch whose points are drawn in towards its centroid, the last of them; else that
 * of its points. */
static double corner_gap(const tl_model *m, uint32_t contact, const tl_facing *to, const tl_facing_place *place,
                         double gap)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    const tl_facet *f = &contacts->facet[contact];
    size_t count = contacts->point_count[contact], last = tl_point_row(contacts, contact, count - 1);
    if (!tl_facet_is_patch(f) || count < 2 || p->key[last] != tl_centroid_key(f->ia, f->ib))
        return gap;
    double centre = tl_v3_dot(to->plane, placed(place, tl_columns_get(p->p, last)));
    for (size_t k = count / 2; k < count - 1; k++) {
        size_t i = tl_point_row(contacts, contact, k);
        double at = tl_v3_dot(to->plane, placed(place, tl_columns_get(p->p, i)));
        gap = tl_smaller(centre + (at - centre) / tl_point_rule_of(false).reach - to->offset, gap);
    }
    return gap;
}

void tl_contact_summary(const tl_model *m, uint32_t contact, tl_vec3 *normal, tl_vec3 *point, double *gap)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    const tl_facet *f = &contacts->facet[contact];
    tl_body_frames frames = body_frames_of(m, contact);
    tl_facing to = facing_of(m, contact, &frames);
    tl_facing_place place = place_of(m, contact, &frames);
    tl_vec3 x = {0, 0, 0};
    double area = 0;
    size_t count = contacts->point_count[contact];
    *gap = INFINITY;
    for (size_t k = 0; k < count; k++) {
        size_t i = tl_point_row(contacts, contact, k);
        tl_vec3 at = placed(&place, tl_columns_get(p->p, i));
        x = tl_v3_madd(x, p->area[i], at);
        area += p->area[i];
        *gap = tl_smaller(tl_v3_dot(to.plane, at) - to.offset, *gap);
    }
    *gap = corner_gap(m, contact, &to, &place, *gap);
    if (tl_facet_is_field(f) && contacts->point_count[contact] > 0)
        *gap = -m->detect->press[contacts->press[contact]].press.deepest;
    *normal = f->last;
    *point = tl_v3_madd(tl_side_place(m, tl_contact_sides(m, contact).a), area > 0 ? 1 / area : 0, x);
}
