/* follow.c - what a step does with every contact whose facets stand: gaps, normals and relative motion
 * of its points in the present place.
 *
 * The gap comes from the planes of the faces (or the normal of two edges), carried with their bodies,
 * never from the axis. Shear forces are turned with the common plane, exactly from the old normal to
 * the new and by the bodies' mean spin about it; (5) of Hart, Cundall and Lemos (1988) is the first
 * order of this. Two bodies that turn as one make no slip, and their forces turn with them. */
#include "detect/detect.h"

/* Angles below which sine and cosine are taken from their series, whose next term is then below
 * rounding. */
#define SERIES_ANGLE 0.1

/* A body's motion in the last step: a way and a turn. */
typedef struct moving {
    tl_vec3 way, turn;    /* turn: axis times angle */
    double sine, versine; /* sin(angle) / angle, (1 - cos(angle)) / angle^2 */
    tl_vec3 half;         /* axis times the tangent of half the angle */
} moving;

static moving moving_of(tl_vec3 v, tl_vec3 w, double dt)
{
    moving out = {.way = tl_v3_scale(dt, v), .turn = tl_v3_scale(dt, w)};
    double a2 = tl_v3_norm2(out.turn), tangent; /* tan(angle / 2) / angle */
    if (a2 < SERIES_ANGLE * SERIES_ANGLE) {
        out.sine = 1 - a2 / 6 * (1 - a2 / 20 * (1 - a2 / 42 * (1 - a2 / 72)));
        out.versine = 0.5 * (1 - a2 / 12 * (1 - a2 / 30 * (1 - a2 / 56 * (1 - a2 / 90))));
        tangent = 0.5 + a2 * (1. / 24 + a2 * (1. / 240 + a2 * (17. / 40320 + a2 * 31. / 725760)));
    } else {
        double a = sqrt(a2);
        out.sine = sin(a) / a;
        out.versine = (1 - cos(a)) / a2;
        tangent = tan(0.5 * a) / a;
    }
    out.half = tl_v3_scale(tangent, out.turn);
    return out;
}

/* How a body's point, now at `arm` from the centroid, has moved: exact, so a rolling contact and one
 * that is turned as a whole gather no slip. */
static tl_vec3 motion(const moving *body, tl_vec3 arm)
{
    tl_vec3 across = tl_v3_cross(body->turn, arm);
    tl_vec3 turned = tl_v3_madd(tl_v3_scale(body->sine, across), -body->versine,
                                tl_v3_cross(body->turn, across));
    return tl_v3_add(body->way, turned);
}

/* Two bodies as a facet sees them: axes of the model, A's centroid as zero. */
typedef struct sight {
    const tl_mat3 *ra, *rb;
    tl_vec3 d; /* from A's centroid to B's */
    moving a, b;
} sight;

/* The facet's normal, and the plane a point's gap is measured to. */
typedef struct facing {
    tl_vec3 n;      /* A to B; of a patch the mean of the faces' normals */
    tl_vec3 lean;   /* patches: from n to the normal of A's face, and against it to that of B's */
    double n2, l2;  /* squares of the lengths of both, which are perpendicular */
    tl_vec3 normal; /* outward, of the plane */
    double offset;
    tl_vec3 foot; /* edges: a point of A's edge */
    double gap;   /* edges: the gap of every point */
} facing;

static facing facet_facing(const tl_facet *f, const sight *s)
{
    facing out = {0};
    switch (f->kind) {
    case TL_FACET_PATCH: {
        tl_vec3 na = tl_m3_mul(s->ra, f->na);
        out.normal = tl_m3_mul(s->rb, f->nb);
        out.offset = f->offset + tl_v3_dot(out.normal, s->d);
        out.n = tl_v3_scale(0.5, tl_v3_sub(na, out.normal));
        out.lean = tl_v3_scale(0.5, tl_v3_add(na, out.normal));
        out.n2 = tl_v3_norm2(out.n);
        out.l2 = tl_v3_norm2(out.lean);
        break;
    }
    case TL_FACET_FACE_A:
        out.n = out.normal = tl_m3_mul(s->ra, f->na);
        out.offset = f->offset;
        break;
    case TL_FACET_FACE_B:
        out.normal = tl_m3_mul(s->rb, f->nb);
        out.offset = f->offset + tl_v3_dot(out.normal, s->d);
        out.n = tl_v3_neg(out.normal);
        break;
    default: {
        tl_vec3 foot_a = tl_m3_mul(s->ra, f->pa);
        tl_vec3 foot_b = tl_v3_add(tl_m3_mul(s->rb, f->pb), s->d);
        /* the side was settled when the facet was made: na x nb, turned outward, is n */
        if (!tl_edge_normal(tl_m3_mul(s->ra, f->na), tl_m3_mul(s->rb, f->nb),
                            tl_m3_mul(s->ra, f->side), &out.n))
            out.n = tl_m3_mul(s->ra, f->side);
        out.gap = tl_v3_dot(out.n, tl_v3_sub(foot_b, foot_a));
        break;
    }
    }
    return out;
}

static tl_vec3 point_normal(const facing *f, double lean)
{
    return tl_v3_scale(1 / sqrt(f->n2 + lean * lean * f->l2), tl_v3_madd(f->n, lean, f->lean));
}

/* v turned from the plane of normal `from` to that of `to`, and about `to` by the angle whose half has
 * the tangent `h`: no trigonometry, no growth. */
static tl_vec3 carry(tl_vec3 v, tl_vec3 from, tl_vec3 to, double h)
{
    v = tl_v3_turn(v, from, to);
    if (h != 0) {
        double c = (1 - h * h) / (1 + h * h), t = 2 * h / (1 + h * h);
        v = tl_v3_add(tl_v3_scale(c, v), tl_v3_scale(t, tl_v3_cross(to, v)));
    }
    return tl_v3_madd(v, -tl_v3_dot(v, to), to);
}

/* Turns the shear force and the tangent states of a point into the plane of `n`; h as for carry. */
static void turn_vectors(tl_points_table *p, size_t i, tl_vec3 n, double h, uint32_t tangents)
{
    tl_vec3 old = tl_columns_get(p->normal, i);
    if (tl_v3_norm2(old) > 0) {
        tl_columns_put(p->f_s, i, carry(tl_columns_get(p->f_s, i), old, n, h));
        for (uint32_t k = 0; k + 2 < TL_STATE_COLUMNS && tangents; k++, tangents >>= 1)
            if (tangents & 1)
                tl_columns_put(&p->state[k], i, carry(tl_columns_get(&p->state[k], i), old, n, h));
    }
    tl_columns_put(p->normal, i, n);
}

static void follow_facet(tl_points_table *p, const tl_facet *f, size_t begin, const sight *s,
                         uint32_t tangents)
{
    facing to = facet_facing(f, s);
    tl_vec3 half = tl_v3_scale(0.5, tl_v3_add(s->a.half, s->b.half));
    for (size_t i = begin; i < begin + f->count; i++) {
        tl_vec3 x = f->kind == TL_FACET_FACE_A ? tl_v3_add(tl_m3_mul(s->rb, p->p[i]), s->d)
                                               : tl_m3_mul(s->ra, p->p[i]);
        double gap =
            f->kind == TL_FACET_EDGES ? to.gap : p->rest[i] + tl_v3_dot(to.normal, x) - to.offset;
        tl_vec3 du = tl_v3_sub(motion(&s->b, tl_v3_sub(x, s->d)), motion(&s->a, x));
        tl_vec3 n = f->kind == TL_FACET_PATCH ? point_normal(&to, p->lean[i]) : to.n;
        double du_n = tl_v3_dot(du, n);
        /* a turn is one that swings the old normal to the new, then one about it: of this the half angle
         * has the tangent half . n */
        turn_vectors(p, i, n, tl_v3_dot(half, n), tangents);
        p->arm[i] = x;
        p->closure[i] = -gap - p->reference[i];
        p->du_n[i] = du_n;
        tl_columns_put(p->du_s, i, tl_v3_madd(du, -du_n, n));
    }
}

/* The contact's own normal, point, area and gap, from its points. */
static void summarize(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    size_t begin = contacts->point_start[c], end = begin + contacts->point_count[c];
    tl_vec3 n = {0, 0, 0}, x = {0, 0, 0};
    double area = 0, gap = INFINITY;
    for (size_t i = begin; i < end; i++) {
        double a = p->area[i], overlap = p->closure[i] + p->reference[i];
        n = tl_v3_madd(n, a, tl_columns_get(p->normal, i));
        x = tl_v3_madd(x, a, p->arm[i]);
        area += a;
        gap = -overlap < gap ? -overlap : gap;
    }
    contacts->area[c] = area;
    contacts->gap[c] = end > begin ? gap : contacts->axis[c].s;
    if (area > 0) {
        uint32_t body = m->blocks.body[contacts->a[c]];
        contacts->normal[c] = tl_v3_unit(n);
        contacts->point[c] = tl_v3_add(tl_body_place(&m->bodies, body), tl_v3_scale(1 / area, x));
    }
}

void tl_contact_follow(tl_model *m, uint32_t c, double dt)
{
    tl_contacts *contacts = &m->detect->contacts;
    const tl_bodies *b = &m->bodies;
    uint32_t body_a = m->blocks.body[contacts->a[c]], body_b = m->blocks.body[contacts->b[c]];
    sight s = {&b->r[body_a], &b->r[body_b], tl_body_apart(b, body_a, body_b),
               moving_of(b->v_moved[body_a], b->w_moved[body_a], dt),
               moving_of(b->v_moved[body_b], b->w_moved[body_b], dt)};
    uint32_t material = contacts->material[c];
    uint32_t tangents = material == TL_NO_ROW ? 0 : m->materials[material].tangents;
    const tl_facet *facets = &contacts->facet[contacts->facet_start[c]];
    for (uint32_t k = 0; k < contacts->facet_count[c]; k++)
        follow_facet(&m->detect->points, &facets[k], contacts->point_start[c] + facets[k].begin, &s,
                     tangents);
    summarize(m, c);
}
