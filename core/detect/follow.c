/* follow.c - what a step does with every contact whose facets stand: gaps, normals and relative motion
 * of its points in the present place.
 *
 * The gap comes from the planes of the faces (or the normal of two edges), carried with their bodies,
 * never from the axis. Shear forces are turned with the common plane, exactly from the old normal to
 * the new and by the bodies' mean spin about it; (5) of Hart, Cundall and Lemos (1988) is the first
 * order of this. Two bodies that turn as one make no slip, and their forces turn with them.
 *
 * Everything that is the same for all points of a facet is brought into matrices first, so that what is
 * left for a point are a few products, in loops over columns without a branch. Of tilted faces each point
 * has a normal of its own. */
#include "detect/detect.h"

/* Angles below which sine and cosine are taken from their series, whose next term is then below
 * rounding. */
#define SERIES_ANGLE 0.1
/* ---------------------------------------------------------------- bodies ----------------- */

/* A body's motion in the last step, as it acts on a point at `arm` from the centroid now: way + m arm.
 * Exact, so a rolling contact and one that is turned as a whole gather no slip. */
static tl_moving moving_of(tl_vec3 v, tl_vec3 w, double dt)
{
    tl_moving out = {.way = tl_v3_scale(dt, v)};
    tl_vec3 t = tl_v3_scale(dt, w); /* axis times angle */
    double a2 = tl_v3_norm2(t);
    double sine, versine, tangent; /* sin a / a, (1 - cos a) / a^2, tan(a/2) / a */
    if (a2 < SERIES_ANGLE * SERIES_ANGLE) {
        sine = 1 - a2 / 6 * (1 - a2 / 20 * (1 - a2 / 42 * (1 - a2 / 72)));
        versine = 0.5 * (1 - a2 / 12 * (1 - a2 / 30 * (1 - a2 / 56 * (1 - a2 / 90))));
        tangent = 0.5 + a2 * (1. / 24 + a2 * (1. / 240 + a2 * (17. / 40320 + a2 * 31. / 725760)));
    } else {
        double a = sqrt(a2);
        sine = sin(a) / a;
        versine = (1 - cos(a)) / a2;
        tangent = tan(0.5 * a) / a;
    }
    out.half = tl_v3_scale(tangent, t);
    /* sine [t] - versine [t]^2 */
    double d = versine * a2;
    out.m = (tl_mat3){{{d - versine * t.x * t.x, -versine * t.x * t.y - sine * t.z,
                        -versine * t.x * t.z + sine * t.y},
                       {-versine * t.y * t.x + sine * t.z, d - versine * t.y * t.y,
                        -versine * t.y * t.z - sine * t.x},
                       {-versine * t.z * t.x - sine * t.y, -versine * t.z * t.y + sine * t.x,
                        d - versine * t.z * t.z}}};
    return out;
}

static void moving_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    (void)thread;
    tl_model *m = user;
    for (size_t i = begin; i < end; i++)
        m->detect->moving[i] = moving_of(m->bodies.v_moved[i], m->bodies.w_moved[i], m->dt);
}

void tl_follow_bodies(tl_model *m)
{
    enum { CHUNK = 256 };
    tl_parallel_for(m->pool, m->bodies.table.rows, CHUNK, moving_range, m);
}

/* ---------------------------------------------------------------- facets ----------------- */

/* Two bodies as a contact sees them: axes of the model, A's centroid as zero. */
typedef struct sight {
    const tl_mat3 *ra, *rb;
    tl_vec3 d; /* from A's centroid to B's */
    tl_poly *const *shapes;
    uint32_t a, b; /* rows of the blocks */
} sight;

/* A facet in its present place: its normals, and the plane a point's gap is measured to. */
typedef struct facing {
    tl_vec3 n;        /* A to B, unit; of a patch the bisector's */
    tl_vec3 mean;     /* patches: the mean of the faces' normals, along n ... */
    tl_vec3 lean;     /* ... and from it to the normal of A's face, and against it to B's */
    double mean2, l2; /* squares of their lengths */
    bool tilted;      /* so that points have normals of their own */
    tl_vec3 plane; /* outward normal of the plane; 0 for edges, whose gap is the same everywhere */
    double offset; /* of the plane, or the gap negated */
    tl_mat3 to;    /* from the frame of its points ... */
    tl_vec3 from;  /* ... and that frame's origin */
} facing;

/* Fills what a patch needs. */
static void face_patch(const tl_facet *f, const sight *s, facing *out)
{
    tl_vec3 na = tl_m3_mul(s->ra, f->na), nb = tl_m3_mul(s->rb, f->nb);
    out->to = *s->ra;
    out->from = tl_v3(0, 0, 0);
    out->plane = nb;
    out->offset = f->offset + tl_v3_dot(nb, s->d);
    out->mean = tl_v3_scale(0.5, tl_v3_sub(na, nb));
    out->lean = tl_v3_scale(0.5, tl_v3_add(na, nb));
    out->mean2 = tl_v3_norm2(out->mean);
    out->l2 = tl_v3_norm2(out->lean);
    out->n = tl_v3_scale(1 / sqrt(out->mean2), out->mean);
    out->tilted = out->l2 > TL_FLUSH * TL_FLUSH;
}

/* Fills what vertices on a face of A, or of B, need. */
static void face_vertices(const tl_facet *f, const sight *s, facing *out)
{
    bool on_a = f->kind == TL_FACET_FACE_A;
    out->plane = on_a ? tl_m3_mul(s->ra, f->na) : tl_m3_mul(s->rb, f->nb);
    out->offset = f->offset + (on_a ? 0 : tl_v3_dot(out->plane, s->d));
    out->n = on_a ? out->plane : tl_v3_neg(out->plane);
    out->to = on_a ? *s->rb : *s->ra;
    out->from = on_a ? s->d : tl_v3(0, 0, 0);
    out->tilted = false;
}

static void face_edges(const tl_facet *f, const sight *s, facing *out)
{
    const tl_poly *a = s->shapes[s->a], *b = s->shapes[s->b];
    const tl_edge *ea = &a->edge[f->ia], *eb = &b->edge[f->ib];
    tl_vec3 from_a = a->vertex[ea->a], from_b = b->vertex[eb->a];
    tl_vec3 along_a = tl_m3_mul(s->ra, tl_v3_sub(a->vertex[ea->b], from_a));
    tl_vec3 along_b = tl_m3_mul(s->rb, tl_v3_sub(b->vertex[eb->b], from_b));
    tl_vec3 foot_a = tl_m3_mul(s->ra, from_a);
    tl_vec3 foot_b = tl_v3_add(tl_m3_mul(s->rb, from_b), s->d);
    /* the side was settled when the facet was made: along_a x along_b, turned outward, is n */
    tl_vec3 side = tl_m3_mul(s->ra, f->na);
    if (!tl_edge_normal(along_a, along_b, side, &out->n))
        out->n = side;
    out->plane = tl_v3(0, 0, 0);
    out->offset = -tl_v3_dot(out->n, tl_v3_sub(foot_b, foot_a));
    out->to = *s->ra;
    out->from = tl_v3(0, 0, 0);
    out->tilted = false;
}

static void face_facet(const tl_facet *f, const sight *s, facing *out)
{
    if (f->kind == TL_FACET_PATCH)
        face_patch(f, s, out);
    else if (f->kind == TL_FACET_EDGES)
        face_edges(f, s, out);
    else
        face_vertices(f, s, out);
}

static sight sight_of(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    uint32_t a = m->blocks.body[contacts->a[c]], b = m->blocks.body[contacts->b[c]];
    return (sight){.ra = &m->bodies.r[a],
                   .rb = &m->bodies.r[b],
                   .d = tl_body_apart(&m->bodies, a, b),
                   .shapes = m->blocks.shape,
                   .a = contacts->a[c],
                   .b = contacts->b[c]};
}

/* The unit normal of a point that leans so; m2 and l2 are the squares of the two vectors. */
static inline tl_vec3 leaning(tl_vec3 mean, tl_vec3 lean, double m2, double l2, tl_lean by)
{
    double l = by.face, k = by.edge;
    tl_vec3 n = tl_v3_madd(tl_v3_madd(mean, l, lean), k, tl_v3_cross(mean, lean));
    return tl_v3_scale(1 / sqrt(m2 + l2 * (l * l + k * k * m2)), n);
}

/* To the bit what a step made of the same mean and lean: a point that rests is not turned. */
tl_vec3 tl_facet_last_normal(const tl_facet *f, tl_lean lean)
{
    double l2 = tl_v3_norm2(f->last_lean);
    if (l2 == 0)
        return f->last;
    return leaning(f->last, f->last_lean, tl_v3_norm2(f->last), l2, lean);
}

static void note_normals(tl_facet *f, const facing *to)
{
    f->last = to->tilted ? to->mean : to->n;
    f->last_lean = to->tilted ? to->lean : tl_v3(0, 0, 0);
}

/* ---------------------------------------------------------------- points ----------------- */

/* Points worked on side by side: vectors of the processor, or two or four of an older one's. */
enum { WIDE = 8, NARROW = 4 };

/* Columns of points and lanes, row 0 of both the same point. */
typedef struct columns {
    const tl_lean *lean;
    const double *reference;
    double *p[3], *rest, *closure, *f_s[3];
    double *arm[3], *normal[3], *du_n, *du_s[3];
} columns;

static columns columns_at(const tl_points_table *p, size_t point, const tl_point_lanes *l)
{
    return (columns){
        .p = {p->p[0] + point, p->p[1] + point, p->p[2] + point},
        .rest = p->rest + point,
        .lean = p->lean + point,
        .reference = p->reference + point,
        .closure = p->closure + point,
        .f_s = {p->f_s[0] + point, p->f_s[1] + point, p->f_s[2] + point},
        .arm = {l->arm[0], l->arm[1], l->arm[2]},
        .normal = {l->normal[0], l->normal[1], l->normal[2]},
        .du_n = l->du_n,
        .du_s = {l->du_s[0], l->du_s[1], l->du_s[2]},
    };
}

/* The motion of B against A in the last step at an arm from A's centroid: way + m arm; and the mean spin
 * of both, as axis times the tangent of half its angle. */
typedef struct slip {
    tl_vec3 way, half;
    tl_mat3 m;
    double carry; /* half; 0 for points placed after that motion */
} slip;

static slip slip_of(const tl_moving *a, const tl_moving *b, tl_vec3 d)
{
    slip out;
    out.way = tl_v3_sub(tl_v3_sub(b->way, a->way), tl_m3_mul(&b->m, d));
    out.half = tl_v3_scale(0.5, tl_v3_add(a->half, b->half));
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out.m.m[i][j] = b->m.m[i][j] - a->m.m[i][j];
    return out;
}

/* Arms, normals and closures of `width` points from row i: one of the two widths and kinds below. */
static inline __attribute__((always_inline)) void place_block(const columns *c, size_t i,
                                                              const uint32_t width, const facing *f,
                                                              const bool tilted)
{
    const tl_mat3 *r = &f->to;
#pragma omp simd
    for (uint32_t k = 0; k < width; k++) {
        double px = c->p[0][i + k], py = c->p[1][i + k], pz = c->p[2][i + k];
        double x = (r->m[0][0] * px + r->m[0][1] * py + r->m[0][2] * pz) + f->from.x;
        double y = (r->m[1][0] * px + r->m[1][1] * py + r->m[1][2] * pz) + f->from.y;
        double z = (r->m[2][0] * px + r->m[2][1] * py + r->m[2][2] * pz) + f->from.z;
        c->arm[0][i + k] = x;
        c->arm[1][i + k] = y;
        c->arm[2][i + k] = z;
        c->closure[i + k] = (f->offset - c->rest[i + k]) -
                            (f->plane.x * x + f->plane.y * y + f->plane.z * z) -
                            c->reference[i + k];
        tl_vec3 n = f->n;
        if (tilted)
            n = leaning(f->mean, f->lean, f->mean2, f->l2, c->lean[i + k]);
        c->normal[0][i + k] = n.x;
        c->normal[1][i + k] = n.y;
        c->normal[2][i + k] = n.z;
    }
}

/* Relative motion of placed points, along their normals and across. */
static inline __attribute__((always_inline)) void move_block(const columns *c, size_t i,
                                                             const uint32_t width, const slip *s)
{
#pragma omp simd
    for (uint32_t k = 0; k < width; k++) {
        double ax = c->arm[0][i + k], ay = c->arm[1][i + k], az = c->arm[2][i + k];
        double nx = c->normal[0][i + k], ny = c->normal[1][i + k], nz = c->normal[2][i + k];
        double x = s->way.x + (s->m.m[0][0] * ax + s->m.m[0][1] * ay + s->m.m[0][2] * az);
        double y = s->way.y + (s->m.m[1][0] * ax + s->m.m[1][1] * ay + s->m.m[1][2] * az);
        double z = s->way.z + (s->m.m[2][0] * ax + s->m.m[2][1] * ay + s->m.m[2][2] * az);
        double n = x * nx + y * ny + z * nz;
        c->du_n[i + k] = n;
        c->du_s[0][i + k] = x - n * nx;
        c->du_s[1][i + k] = y - n * ny;
        c->du_s[2][i + k] = z - n * nz;
    }
}

/* Turns vectors of the old common plane into the new, whose normals all points share. A turn is axis times
 * the tangent of half its angle: no trigonometry, no growth. */
static inline __attribute__((always_inline)) void turn_block(double *const v[3], size_t i,
                                                             const uint32_t width,
                                                             const tl_mat3 *turn, tl_vec3 n)
{
#pragma omp simd
    for (uint32_t k = 0; k < width; k++) {
        double vx = v[0][i + k], vy = v[1][i + k], vz = v[2][i + k];
        double x = turn->m[0][0] * vx + turn->m[0][1] * vy + turn->m[0][2] * vz;
        double y = turn->m[1][0] * vx + turn->m[1][1] * vy + turn->m[1][2] * vz;
        double z = turn->m[2][0] * vx + turn->m[2][1] * vy + turn->m[2][2] * vz;
        double off = x * n.x + y * n.y + z * n.z;
        v[0][i + k] = x - off * n.x;
        v[1][i + k] = y - off * n.y;
        v[2][i + k] = z - off * n.z;
    }
}

/* The turn that swings the plane of normal `from` into that of `to`, then by twice the angle whose tangent
 * is `twist` about it. */
static tl_vec3 turn_between(tl_vec3 from, tl_vec3 to, double twist)
{
    double c = 1 + tl_v3_dot(from, to);
    tl_vec3 swing = c > 0 ? tl_v3_scale(1 / c, tl_v3_cross(from, to)) : tl_v3(0, 0, 0);
    /* swing is perpendicular to `to`: the product of the two half turns has no scalar part to divide by */
    return tl_v3_madd(tl_v3_madd(swing, twist, to), twist, tl_v3_cross(to, swing));
}

static tl_mat3 matrix_of(tl_vec3 g)
{
    const double g2 = tl_v3_norm2(g), s = 2 / (1 + g2), d = 1 - s * g2;
    const tl_vec3 h = tl_v3_scale(s, g);
    return (tl_mat3){{{d + h.x * g.x, h.x * g.y - h.z, h.x * g.z + h.y},
                      {h.y * g.x + h.z, d + h.y * g.y, h.y * g.z - h.x},
                      {h.z * g.x - h.y, h.z * g.y + h.x, d + h.z * g.z}}};
}

/* Turns one vector of the old common plane of a point into its new one, where each point has a normal of its
 * own. */
static inline tl_vec3 turn_one(tl_vec3 v, tl_vec3 from, tl_vec3 n, tl_vec3 half)
{
    tl_vec3 g = turn_between(from, n, tl_v3_dot(half, n));
    double g2 = tl_v3_norm2(g);
    tl_vec3 t = tl_v3_cross(g, v);
    t = tl_v3_madd(v, 2 / (1 + g2), tl_v3_add(t, tl_v3_cross(g, t)));
    /* what has not turned stays as it is, to the bit */
    return tl_v3_madd(t, g2 > 0 ? -tl_v3_dot(t, n) : 0, n);
}

/* Points of a tilted patch. Its features move: a vertex of A with A (lean -1), one of B with B (lean 1), what
 * lies between with both; so do the points until the patch is made anew, and the gap opens along the point's
 * normal. */
static inline __attribute__((always_inline)) void tilted_block(const columns *c, size_t i,
                                                               const uint32_t width,
                                                               const facing *f, const slip *s,
                                                               tl_vec3 last, tl_vec3 last_lean)
{
    const double last2 = tl_v3_norm2(last), last_l2 = tl_v3_norm2(last_lean);
    const tl_mat3 *r = &f->to;
    const tl_vec3 na = tl_v3_add(f->mean, f->lean), cross = tl_v3_cross(f->mean, f->lean);
#pragma omp simd
    for (uint32_t k = 0; k < width; k++) {
        size_t at = i + k;
        tl_lean by = c->lean[at];
        tl_vec3 x = tl_m3_mul(r, tl_v3(c->p[0][at], c->p[1][at], c->p[2][at]));
        tl_vec3 n = leaning(f->mean, f->lean, f->mean2, f->l2, by);
        tl_vec3 du = tl_v3_add(s->way, tl_m3_mul(&s->m, x));
        double du_n = tl_v3_dot(du, n);
        /* with the features that made it, along the faces; where two edges cross, also up the faces by
         * how far one edge has slid over the other */
        tl_vec3 go = tl_v3_scale(s->carry * (1 + (double)by.face), du);
        go = tl_v3_madd(go, s->carry * by.edge * tl_v3_dot(cross, du) / f->l2, f->lean);
        tl_vec3 along = tl_m3_tmul(r, go);
        x = tl_v3_add(x, go);
        c->p[0][at] += along.x;
        c->p[1][at] += along.y;
        c->p[2][at] += along.z;
        c->rest[at] += tl_v3_dot(na, go);
        c->closure[at] = (f->offset - c->rest[at]) - tl_v3_dot(f->plane, x) - c->reference[at];
        c->arm[0][at] = x.x;
        c->arm[1][at] = x.y;
        c->arm[2][at] = x.z;
        c->normal[0][at] = n.x;
        c->normal[1][at] = n.y;
        c->normal[2][at] = n.z;
        c->du_n[at] = du_n;
        c->du_s[0][at] = du.x - du_n * n.x;
        c->du_s[1][at] = du.y - du_n * n.y;
        c->du_s[2][at] = du.z - du_n * n.z;
        tl_vec3 from = last_l2 > 0 ? leaning(last, last_lean, last2, last_l2, by) : last;
        tl_vec3 v = turn_one(tl_v3(c->f_s[0][at], c->f_s[1][at], c->f_s[2][at]), from, n, s->half);
        c->f_s[0][at] = v.x;
        c->f_s[1][at] = v.y;
        c->f_s[2][at] = v.z;
    }
}

/* Turns vectors of points one by one. */
static void turn_points(const columns *c, double *const v[3], size_t begin, uint32_t count,
                        const tl_facet *f, tl_vec3 half)
{
    for (size_t i = begin; i < begin + count; i++)
        tl_columns_put(v, i,
                       turn_one(tl_columns_get(v, i), tl_facet_last_normal(f, c->lean[i]),
                                tl_columns_get(c->normal, i), half));
}

static inline __attribute__((always_inline)) void level_block(const columns *c, size_t i,
                                                              const uint32_t width, const facing *f,
                                                              const slip *moved,
                                                              const tl_mat3 *turn)
{
    place_block(c, i, width, f, false);
    move_block(c, i, width, moved);
    if (turn)
        turn_block(c->f_s, i, width, turn, f->n);
}

/* What the points of a facet do in a step that all have one normal; shear stays where `turn` is NULL. */
TL_VECTORIZED static void follow_level(const columns *c, size_t i, size_t end, const facing *f,
                                       const slip *moved, const tl_mat3 *turn)
{
    for (; i + WIDE <= end; i += WIDE)
        level_block(c, i, WIDE, f, moved, turn);
    for (; i + NARROW <= end; i += NARROW)
        level_block(c, i, NARROW, f, moved, turn);
    for (; i < end; i++)
        level_block(c, i, 1, f, moved, turn);
}

TL_VECTORIZED static void follow_tilted(const columns *c, size_t i, size_t end, const facing *f,
                                        const slip *moved, tl_vec3 last, tl_vec3 last_lean)
{
    for (; i + NARROW <= end; i += NARROW)
        tilted_block(c, i, NARROW, f, moved, last, last_lean);
    for (; i < end; i++)
        tilted_block(c, i, 1, f, moved, last, last_lean);
}

/* ---------------------------------------------------------------- contacts --------------- */

void tl_contact_places(const tl_model *m, uint32_t contact, const tl_point_lanes *l)
{
    const tl_contacts *contacts = &m->detect->contacts;
    columns c = columns_at(&m->detect->points, contacts->point_start[contact], l);
    c.closure = c.du_n; /* that of the last step's forces stays */
    sight s = sight_of(m, contact);
    for (uint32_t k = 0; k < contacts->facet_count[contact]; k++) {
        const tl_facet *f = &contacts->facet[contacts->facet_start[contact] + k];
        facing to;
        face_facet(f, &s, &to);
        for (size_t i = f->begin; i < f->begin + (size_t)f->count; i++)
            place_block(&c, i, 1, &to, to.tilted);
    }
}

void tl_contact_begin(tl_model *m, uint32_t contact, const tl_point_lanes *l)
{
    tl_contacts *contacts = &m->detect->contacts;
    columns c = columns_at(&m->detect->points, contacts->point_start[contact], l);
    sight s = sight_of(m, contact);
    for (uint32_t k = 0; k < contacts->facet_count[contact]; k++) {
        tl_facet *f = &contacts->facet[contacts->facet_start[contact] + k];
        facing to;
        face_facet(f, &s, &to);
        for (size_t i = f->begin; i < f->begin + (size_t)f->count; i++)
            place_block(&c, i, 1, &to, to.tilted);
        note_normals(f, &to);
    }
}

/* Turns the tangent states of a facet's points. */
static void turn_states(tl_points_table *p, size_t first, const columns *c, size_t begin,
                        const tl_facet *f, tl_vec3 half, uint32_t tangents)
{
    for (uint32_t k = 0; k + 2 < p->state_columns; k++) {
        double *v[3] = {p->state[k] + first, p->state[k + 1] + first, p->state[k + 2] + first};
        if (tangents >> k & 1)
            turn_points(c, v, begin, f->count, f, half);
    }
}

static void follow_contact(tl_model *m, uint32_t contact, const columns *c, size_t first)
{
    tl_contacts *contacts = &m->detect->contacts;
    uint32_t a = m->blocks.body[contacts->a[contact]], b = m->blocks.body[contacts->b[contact]];
    sight s = sight_of(m, contact);
    slip moved = slip_of(&m->detect->moving[a], &m->detect->moving[b], s.d);
    moved.carry = contacts->fresh[contact] ? 0 : 0.5;
    contacts->fresh[contact] = false;
    uint32_t tangents = m->materials[contacts->material[contact]].tangents;
    uint32_t facets = contacts->facet_count[contact];
    tl_facet *f = &contacts->facet[contacts->facet_start[contact]];
    for (tl_facet *last = f + facets; f < last; f++) {
        size_t begin = contacts->point_start[contact] - first + f->begin;
        facing to;
        face_facet(f, &s, &to);
        /* a lone facet works on inert lanes up to a whole group: there is room for them */
        size_t end = begin + f->count;
        if (facets == 1)
            end = begin + (f->count + TL_POINT_ROUND - 1u) / TL_POINT_ROUND * TL_POINT_ROUND;
        if (to.tilted) {
            follow_tilted(c, begin, end, &to, &moved, f->last, f->last_lean);
        } else if (tl_v3_norm2(f->last_lean) > 0) { /* tilted until now */
            follow_level(c, begin, end, &to, &moved, NULL);
            turn_points(c, c->f_s, begin, f->count, f, moved.half);
        } else {
            tl_vec3 by = turn_between(f->last, to.n, tl_v3_dot(moved.half, to.n));
            bool turns = tl_v3_norm2(by) > 0; /* what has not turned stays as it is, to the bit */
            tl_mat3 turn;
            if (turns)
                turn = matrix_of(by);
            follow_level(c, begin, end, &to, &moved, turns ? &turn : NULL);
        }
        if (tangents)
            turn_states(&m->detect->points, first, c, begin, f, moved.half, tangents);
        note_normals(f, &to);
    }
}

void tl_contacts_follow(tl_model *m, size_t first, size_t points, const tl_point_lanes *l)
{
    const uint32_t *owner = m->detect->points.owner + first / TL_POINT_ROUND;
    columns c = columns_at(&m->detect->points, first, l);
    for (size_t g = 0; g * TL_POINT_ROUND < points; g++)
        if (owner[g] < TL_OWNED_BEFORE)
            follow_contact(m, owner[g], &c, first);
}

void tl_contact_summary(const tl_model *m, uint32_t contact, tl_vec3 *normal, tl_vec3 *point,
                        double *gap)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    size_t start = contacts->point_start[contact];
    uint32_t body = m->blocks.body[contacts->a[contact]];
    sight s = sight_of(m, contact);
    tl_vec3 n = {0, 0, 0}, x = {0, 0, 0};
    double area = 0;
    *gap = contacts->point_count[contact] ? INFINITY : contacts->axis[contact].s;
    for (uint32_t k = 0; k < contacts->facet_count[contact]; k++) {
        const tl_facet *f = &contacts->facet[contacts->facet_start[contact] + k];
        bool on_b = f->kind == TL_FACET_FACE_A;
        for (size_t i = start + f->begin; i < start + f->begin + f->count; i++) {
            tl_vec3 at = tl_m3_mul(on_b ? s.rb : s.ra, tl_columns_get(p->p, i));
            n = tl_v3_madd(n, p->area[i], tl_facet_last_normal(f, p->lean[i]));
            x = tl_v3_madd(x, p->area[i], on_b ? tl_v3_add(at, s.d) : at);
            area += p->area[i];
            *gap = fmin(*gap, -(p->closure[i] + p->reference[i]));
        }
    }
    *normal = tl_v3_unit(n);
    *point = tl_v3_madd(tl_body_place(&m->bodies, body), area > 0 ? 1 / area : 0, x);
}
