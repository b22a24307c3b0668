/* places.c - contacts one by one: where their facets and points are, for those who ask between steps and for points
 * that are new. */
#include "contact/places.h"

#include "base/columns.h"
#include "contact/detection.h"
#include "contact/pair_view.h"
#include "contact/points.h"

tl_sight tl_sight_of(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    uint32_t a = m->blocks.body[contacts->a[c]], b = m->blocks.body[contacts->b[c]];
    return (tl_sight){.ra = &m->bodies.pose[a].r,
                      .rb = &m->bodies.pose[b].r,
                      .d = tl_body_apart(&m->bodies, a, b),
                      .shapes = m->blocks.shape,
                      .a = contacts->a[c],
                      .b = contacts->b[c]};
}

/* Of vertices on a face of A, or of B. */
static tl_facing face_vertices(const tl_facet *f, const tl_sight *s)
{
    if (f->kind == TL_FACET_FACE_A) {
        tl_vec3 n = tl_m3_mul(s->ra, f->na);
        return tl_facing_level(n, n, f->offset);
    }
    tl_vec3 n = tl_m3_mul(s->rb, f->nb);
    return tl_facing_level(tl_v3_neg(n), n, f->offset + tl_v3_dot(n, s->d));
}

static tl_facing face_edges(const tl_facet *f, const tl_sight *s)
{
    const tl_poly *a = s->shapes[s->a], *b = s->shapes[s->b];
    const tl_edge *ea = &a->edge[f->ia], *eb = &b->edge[f->ib];
    tl_vec3 from_a = a->vertex[ea->a], from_b = b->vertex[eb->a];
    tl_vec3 along_a = tl_m3_mul(s->ra, tl_v3_sub(a->vertex[ea->b], from_a));
    tl_vec3 along_b = tl_m3_mul(s->rb, tl_v3_sub(b->vertex[eb->b], from_b));
    tl_vec3 foot_a = tl_m3_mul(s->ra, from_a);
    tl_vec3 foot_b = tl_v3_add(tl_m3_mul(s->rb, from_b), s->d);
    /* the side was settled when the facet was made */
    tl_vec3 n = tl_facing_edges(along_a, along_b, tl_m3_mul(s->ra, f->na));
    return tl_facing_level(n, tl_v3(0, 0, 0), -tl_v3_dot(n, tl_v3_sub(foot_b, foot_a)));
}

tl_facing tl_facing_of(const tl_facet *f, const tl_sight *s)
{
    if (f->kind == TL_FACET_PATCH)
        return tl_facing_patch(tl_m3_mul(s->ra, f->na), tl_m3_mul(s->rb, f->nb), s->d, f->offset);
    return f->kind == TL_FACET_EDGES ? face_edges(f, s) : face_vertices(f, s);
}

/* To the bit what a step made of the same mean and lean: a point that rests is not turned. */
tl_vec3 tl_facet_last_normal(const tl_facet *f, tl_lean lean)
{
    double l2 = tl_v3_norm2(f->last_lean);
    if (l2 == 0)
        return f->last;
    return tl_leaning(f->last, f->last_lean, tl_v3_cross(f->last, f->last_lean),
                      tl_v3_norm2(f->last), l2, lean.face, lean.edge);
}

/* Arm, normal and closure of the contact's point k, which is in that row, into lane k. */
static void place_point(const tl_points_table *p, size_t row, size_t k, const tl_facet *f,
                        const tl_facing *to, const tl_sight *s, const tl_point_lanes *l)
{
    bool in_b = tl_facet_in_b(f);
    tl_vec3 x = tl_m3_mul(in_b ? s->rb : s->ra, tl_columns_get(p->p, row));
    x = tl_v3_add(x, in_b ? s->d : tl_v3(0, 0, 0));
    tl_columns_put(l->arm, k, x);
    tl_lean by = tl_point_lean(p, row);
    tl_columns_put(l->normal, k,
                   tl_leaning(to->mean, to->lean, tl_v3_cross(to->mean, to->lean), to->mean2,
                              to->l2, by.face, by.edge));
    l->closure[k] = to->offset - tl_v3_dot(to->plane, x) - (p->reference ? p->reference[row] : 0);
}

void tl_contact_places(const tl_model *m, uint32_t contact, const tl_point_lanes *l)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_sight s = tl_sight_of(m, contact);
    for (uint32_t i = 0; i < contacts->facet_count[contact]; i++) {
        const tl_facet *f = &contacts->facet[contacts->facet_start[contact] + i];
        tl_facing to = tl_facing_of(f, &s);
        for (size_t k = f->begin; k < f->begin + (size_t)f->count; k++)
            place_point(&m->detect->points, tl_point_row(contacts, contact, k), k, f, &to, &s, l);
    }
}

void tl_contact_begin(tl_model *m, uint32_t contact, const tl_point_lanes *l)
{
    tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    tl_sight s = tl_sight_of(m, contact);
    for (uint32_t i = 0; i < contacts->facet_count[contact]; i++) {
        tl_facet *f = &contacts->facet[contacts->facet_start[contact] + i];
        tl_facing to = tl_facing_of(f, &s);
        for (size_t k = f->begin; k < f->begin + (size_t)f->count; k++)
            place_point(p, tl_point_row(contacts, contact, k), k, f, &to, &s, l);
        f->last = to.mean;
        f->last_lean = to.lean;
    }
}

/* Of a contact without points: that along its axis. */
static double axis_gap(const tl_model *m, uint32_t contact)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_pair_view view = tl_pair_view_of(m, contacts->a[contact], contacts->b[contact]);
    tl_axis axis = tl_axis_of(contacts->axis[contact]);
    bool placed = tl_pair_place(&view, &m->detect->narrow[0]) && tl_axis_place(&view, &axis);
    return placed ? axis.s : INFINITY;
}

void tl_contact_summary(const tl_model *m, uint32_t contact, tl_vec3 *normal, tl_vec3 *point,
                        double *gap)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    uint32_t body = m->blocks.body[contacts->a[contact]];
    tl_sight s = tl_sight_of(m, contact);
    tl_vec3 n = {0, 0, 0}, x = {0, 0, 0};
    double area = 0;
    *gap = contacts->point_count[contact] ? INFINITY : axis_gap(m, contact);
    for (uint32_t k = 0; k < contacts->facet_count[contact]; k++) {
        const tl_facet *f = &contacts->facet[contacts->facet_start[contact] + k];
        bool on_b = tl_facet_in_b(f);
        tl_facing to = tl_facing_of(f, &s);
        for (size_t j = f->begin; j < f->begin + (size_t)f->count; j++) {
            size_t i = tl_point_row(contacts, contact, j);
            tl_vec3 at = tl_m3_mul(on_b ? s.rb : s.ra, tl_columns_get(p->p, i));
            at = tl_v3_add(at, on_b ? s.d : tl_v3(0, 0, 0));
            n = tl_v3_madd(n, p->area[i], tl_facet_last_normal(f, tl_point_lean(p, i)));
            x = tl_v3_madd(x, p->area[i], at);
            area += p->area[i];
            *gap = fmin(*gap, tl_v3_dot(to.plane, at) - to.offset);
        }
    }
    *normal = tl_v3_unit(n);
    *point = tl_v3_madd(tl_body_place(&m->bodies, body), area > 0 ? 1 / area : 0, x);
}
