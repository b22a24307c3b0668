/* field.c - integrals of the pressure field of two blocks: field.h says what it is.
 *
 * Every polygon lies in a plane and is bounded by lines, one for each other face: on the part of S that belongs to the
 * faces a and b, d_h >= d_a for all others h, and d_a >= 0. Eight polygons are worked on side by side, one in a lane.
 * No polygon is ever clipped: a line bounds the polygon between the crossings with all other lines, and the polygon's
 * integrals are sums over its lines (Green's theorem). So there are no corners to be kept, and no branches.
 *
 * In a polygon's plane: axes t and s, origin where the plane is nearest to the frame's. A line is g . x <= c with a
 * unit normal g, its own points are c g + r (-g_s, g_t) with the place r along it. */
#include "narrow/field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/plugin.h>
#include <talus/vmath.h>

#define LANES TL_LANES

/* Sine of the angle between two lines below which they do not cross: the error of a crossing's place, a rounding over
 * the sine, then becomes as large as what the wrong one of two such lines encloses. */
#define PARALLEL 1e-8
/* Length of a face's normal, within the polygon's plane, below which the face is parallel to the plane. */
#define LEVEL 1e-9
/* Length of n_a - n_b below which two faces look the same way, and have no surface between them. */
#define ALIKE 1e-7
/* Roundings of the largest offset within which two faces that look the same way are one plane. */
#define ONE_PLANE (16 * 2.220446049250313e-16)
/* Place beyond the end of any line. */
#define FAR 1e300

/* Eight polygons. */
typedef struct lanes {
    double n[3][LANES], h[LANES];           /* plane */
    double t[3][LANES], s[3][LANES];        /* axes in it */
    double face_n[3][LANES], face_c[LANES]; /* the face whose depth counts */
    double one[LANES], other[LANES]; /* numbers of the planes that bound the polygon nowhere */
    double own[LANES];               /* 1: bounded by d >= 0 as well */
    double share[LANES];             /* of the integrals: 1; 1/2 for a tie; 0 for none */
    double d0[LANES], dt[LANES], ds[LANES];   /* depth in the plane: d0 + dt x_t + ds x_s */
    double area[LANES], it[LANES], is[LANES]; /* integrals of 1, x_t, x_s, ... */
    double itt[LANES], its[LANES], iss[LANES];
    double deepest[LANES];
} lanes;

/* The lines of eight polygons: columns [line][lane]. */
typedef struct lines {
    size_t count;
    double *gt, *gs, *c; /* unit normal, offset */
    double *from, *to;   /* places between which the line bounds the polygon */
} lines;

static uint32_t real_faces(const tl_field_faces *f)
{
    return f->a + f->b;
}

static uint32_t all_faces(const tl_field_faces *f)
{
    return f->a + f->b + f->border_a + f->border_b;
}

static tl_vec3 normal_of(const tl_field_faces *f, uint32_t i)
{
    return tl_v3(f->n[0][i], f->n[1][i], f->n[2][i]);
}

static tl_vec3 lane_vector(const double v[3][LANES], int lane)
{
    return tl_v3(v[0][lane], v[1][lane], v[2][lane]);
}

/* ---------------------------------------------------------------- lines ------------------ */

/* Axes of the planes without a branch (Duff and others, "Building an orthonormal basis, revisited", 2017), and the
 * depth in them. */
TL_VECTORIZED static void place_axes(lanes *p)
{
    double *restrict n0 = p->n[0], *restrict n1 = p->n[1], *restrict n2 = p->n[2];
#pragma omp simd
    for (unsigned l = 0; l < LANES; l++) {
        double sign = n2[l] >= 0 ? 1.0 : -1.0, a = -1 / (sign + n2[l]), b = n0[l] * n1[l] * a;
        p->t[0][l] = 1 + sign * n0[l] * n0[l] * a;
        p->t[1][l] = sign * b;
        p->t[2][l] = -sign * n0[l];
        p->s[0][l] = b;
        p->s[1][l] = sign + n1[l] * n1[l] * a;
        p->s[2][l] = -n1[l];
        double x = p->face_n[0][l], y = p->face_n[1][l], z = p->face_n[2][l];
        p->d0[l] = p->face_c[l] - p->h[l] * (x * n0[l] + y * n1[l] + z * n2[l]);
        p->dt[l] = -(x * p->t[0][l] + y * p->t[1][l] + z * p->t[2][l]);
        p->ds[l] = -(x * p->s[0][l] + y * p->s[1][l] + z * p->s[2][l]);
    }
}

/* The line in which d_h - k d is zero, for a face or border h; k is 1 for a face, and 0 for a border. Face number -1
 * stands for the line d >= 0. */
TL_VECTORIZED static void place_line(lanes *restrict p, double number, const double normal[3],
                                     double offset, double k, double one_plane, double *restrict gt,
                                     double *restrict gs, double *restrict c)
{
    const double nx = normal[0], ny = normal[1], nz = normal[2];
#pragma omp simd
    for (unsigned l = 0; l < LANES; l++) {
        bool own = number < 0;
        double x = own ? p->face_n[0][l] : nx - k * p->face_n[0][l];
        double y = own ? p->face_n[1][l] : ny - k * p->face_n[1][l];
        double z = own ? p->face_n[2][l] : nz - k * p->face_n[2][l];
        double o = own ? p->face_c[l] : offset - k * p->face_c[l];
        double t = x * p->t[0][l] + y * p->t[1][l] + z * p->t[2][l];
        double s = x * p->s[0][l] + y * p->s[1][l] + z * p->s[2][l];
        o -= p->h[l] * (x * p->n[0][l] + y * p->n[1][l] + z * p->n[2][l]);
        double length = sqrt(t * t + s * s);
        bool none = own ? p->own[l] == 0 : (p->one[l] == number) | (p->other[l] == number);
        bool level = length < LEVEL, gone = none | level;
        double part = o > one_plane ? 1.0 : o < -one_plane ? 0.0 : 0.5;
        p->share[l] *= (none | !level) ? 1.0 : part;
        double per = 1 / length;
        gt[l] = gone ? 0.0 : t * per;
        gs[l] = gone ? 0.0 : s * per;
        c[l] = gone ? FAR : o * per;
    }
}

/* Bounds each of two lines by the other. */
TL_VECTORIZED static void cross_lines(const lines *restrict all)
{
    for (size_t i = 0; i < all->count; i++) {
        const double *restrict it = all->gt + i * LANES, *restrict is = all->gs + i * LANES;
        const double *restrict ic = all->c + i * LANES;
        double *restrict ifrom = all->from + i * LANES, *restrict ito = all->to + i * LANES;
        for (size_t j = i + 1; j < all->count; j++) {
            const double *restrict jt = all->gt + j * LANES, *restrict js = all->gs + j * LANES;
            const double *restrict jc = all->c + j * LANES;
            double *restrict jfrom = all->from + j * LANES, *restrict jto = all->to + j * LANES;
#pragma omp simd
            for (unsigned l = 0; l < LANES; l++) {
                double sine = it[l] * js[l] - is[l] * jt[l], cosine = it[l] * jt[l] + is[l] * js[l];
                double per = 1 / sine;
                double ri = (jc[l] - cosine * ic[l]) * per, rj = (cosine * jc[l] - ic[l]) * per;
                bool up = sine > PARALLEL, down = sine < -PARALLEL, level = !(up | down);
                /* parallel lines: the farther one bounds nothing, and nothing lies between two that exclude each other */
                bool apart = ic[l] + jc[l] < 0, nearer = jc[l] < ic[l];
                bool no_i = level & (cosine > 0 ? nearer : apart);
                bool no_j = level & (cosine > 0 ? !nearer : apart);
                double to_i = up ? ri : FAR, from_i = down ? ri : -FAR;
                double to_j = down ? rj : FAR, from_j = up ? rj : -FAR;
                to_i = no_i ? -FAR : to_i;
                to_j = no_j ? -FAR : to_j;
                ito[l] = ito[l] < to_i ? ito[l] : to_i;
                ifrom[l] = ifrom[l] > from_i ? ifrom[l] : from_i;
                jto[l] = jto[l] < to_j ? jto[l] : to_j;
                jfrom[l] = jfrom[l] > from_j ? jfrom[l] : from_j;
            }
        }
    }
}

/* Sums the triangles between the origin and each line's part. */
TL_VECTORIZED static void add_lines(lanes *restrict p, const lines *restrict all)
{
    for (size_t i = 0; i < all->count; i++) {
        const double *restrict gt = all->gt + i * LANES, *restrict gs = all->gs + i * LANES;
        const double *restrict c = all->c + i * LANES;
        const double *restrict from = all->from + i * LANES, *restrict to = all->to + i * LANES;
#pragma omp simd
        for (unsigned l = 0; l < LANES; l++) {
            bool bounds = (to[l] > from[l]) & (c[l] < FAR) & (p->share[l] > 0);
            double f = bounds ? from[l] : 0.0, e = bounds ? to[l] : 0.0, o = bounds ? c[l] : 0.0;
            double w = 0.5 * o * (e - f);
            double pt = o * gt[l] - f * gs[l], ps = o * gs[l] + f * gt[l];
            double qt = o * gt[l] - e * gs[l], qs = o * gs[l] + e * gt[l];
            p->area[l] += w;
            p->it[l] += w * (pt + qt) * (1.0 / 3);
            p->is[l] += w * (ps + qs) * (1.0 / 3);
            p->itt[l] += w * (pt * pt + pt * qt + qt * qt) * (1.0 / 6);
            p->iss[l] += w * (ps * ps + ps * qs + qs * qs) * (1.0 / 6);
            p->its[l] += w * (2 * (pt * ps + qt * qs) + pt * qs + qt * ps) * (1.0 / 12);
            double dp = p->d0[l] + p->dt[l] * pt + p->ds[l] * ps;
            double dq = p->d0[l] + p->dt[l] * qt + p->ds[l] * qs;
            double d = dp > dq ? dp : dq;
            d = bounds ? d : 0.0;
            p->deepest[l] = p->deepest[l] > d ? p->deepest[l] : d;
        }
    }
}

/* ---------------------------------------------------------------- polygons --------------- */

/* Integrals of polygons, eight at a time. */
typedef struct work {
    const tl_field_faces *faces;
    double one_plane; /* offset within which planes are one */
    lines lines;
    lanes lanes;
    int filled;
    void (*take)(struct work *w, int lane); /* what to do with a polygon's integrals */
    uint32_t face[LANES], with[LANES];      /* the polygon's two planes */
    double per[LANES];                      /* 1 / |n_a - n_b| */
    tl_field_sums *sums;
    tl_field_volume *volume;
} work;

static bool make_room(tl_field_room *room, const tl_field_faces *f, lines *all)
{
    size_t count = all_faces(f) + 1u, need = 5 * count * LANES;
    if (need > room->count) {
        double *numbers = aligned_alloc(TL_ALIGN, 2 * need * sizeof *numbers);
        if (!numbers)
            return false;
        free(room->numbers);
        room->numbers = numbers;
        room->count = 2 * need;
    }
    double *at = room->numbers;
    *all = (lines){.count = count,
                   .gt = at,
                   .gs = at + count * LANES,
                   .c = at + 2 * count * LANES,
                   .from = at + 3 * count * LANES,
                   .to = at + 4 * count * LANES};
    return true;
}

void tl_field_free(tl_field_room *room)
{
    free(room->numbers);
    *room = (tl_field_room){0};
}

static bool begin(work *w, const tl_field_faces *f, tl_field_room *room)
{
    *w = (work){.faces = f};
    double largest = 0;
    for (uint32_t i = 0; i < all_faces(f); i++)
        largest = fmax(largest, fabs(f->c[i]));
    w->one_plane = ONE_PLANE * largest;
    return make_room(room, f, &w->lines);
}

/* Integrates the polygons in the lanes. */
static void flush(work *w)
{
    const tl_field_faces *f = w->faces;
    lanes *p = &w->lanes;
    lines *all = &w->lines;
    if (!w->filled)
        return;
    for (int lane = w->filled; lane < (int)LANES;
         lane++) /* what is left there is of earlier ones */
        p->share[lane] = 0;
    memset(p->area, 0, (size_t)((char *)(p + 1) - (char *)p->area));
    place_axes(p);
    for (uint32_t i = 0; i <= all_faces(f); i++) {
        bool own = i == all_faces(f);
        const double n[3] = {own ? 0 : f->n[0][i], own ? 0 : f->n[1][i], own ? 0 : f->n[2][i]};
        place_line(p, own ? -1.0 : (double)i, n, own ? 0 : f->c[i], i < real_faces(f), w->one_plane,
                   all->gt + i * LANES, all->gs + i * LANES, all->c + i * LANES);
    }
    for (size_t k = 0; k < all->count * LANES; k++) {
        all->from[k] = -FAR;
        all->to[k] = FAR;
    }
    cross_lines(all);
    add_lines(p, all);
    for (int lane = 0; lane < w->filled; lane++)
        if (p->area[lane] > 0)
            w->take(w, lane);
    w->filled = 0;
}

/* Puts a polygon into the lanes: in a plane, of the depth of a face, bounded by neither of two planes. */
static void put(work *w, tl_vec3 n, double h, uint32_t face, uint32_t with, double per, bool own)
{
    lanes *p = &w->lanes;
    int l = w->filled++;
    tl_vec3 m = normal_of(w->faces, face);
    p->n[0][l] = n.x;
    p->n[1][l] = n.y;
    p->n[2][l] = n.z;
    p->h[l] = h;
    p->face_n[0][l] = m.x;
    p->face_n[1][l] = m.y;
    p->face_n[2][l] = m.z;
    p->face_c[l] = w->faces->c[face];
    p->one[l] = face;
    p->other[l] = with;
    p->own[l] = own;
    p->share[l] = 1;
    w->face[l] = face;
    w->with[l] = with;
    w->per[l] = per;
    if (w->filled == (int)LANES)
        flush(w);
}

/* The surface between the cells of two faces, where both are the nearest. */
static void put_between(work *w, uint32_t a, uint32_t b)
{
    const tl_field_faces *f = w->faces;
    tl_vec3 m = tl_v3_sub(normal_of(f, a), normal_of(f, b));
    double length = tl_v3_norm(m);
    if (length > ALIKE)
        put(w, tl_v3_scale(1 / length, m), (f->c[a] - f->c[b]) / length, a, b, 1 / length, true);
}

/* The part of a border where a face is the nearest. */
static void put_border(work *w, uint32_t border, uint32_t face)
{
    put(w, normal_of(w->faces, border), w->faces->c[border], face, border, 0, true);
}

/* ---------------------------------------------------------------- the surface ------------ */

/* int d x dS of a lane, without its share along n: along t and s. */
static void depth_moments(const lanes *p, int l, double *d, double *t, double *s)
{
    *d = p->d0[l] * p->area[l] + p->dt[l] * p->it[l] + p->ds[l] * p->is[l];
    *t = p->d0[l] * p->it[l] + p->dt[l] * p->itt[l] + p->ds[l] * p->its[l];
    *s = p->d0[l] * p->is[l] + p->dt[l] * p->its[l] + p->ds[l] * p->iss[l];
}

/* h n + (first moments): int x dS. */
static tl_vec3 place_of(const lanes *p, int l, double along, double it, double is)
{
    tl_vec3 x = tl_v3_scale(p->h[l] * along, lane_vector(p->n, l));
    x = tl_v3_madd(x, it, lane_vector(p->t, l));
    return tl_v3_madd(x, is, lane_vector(p->s, l));
}

static void add_force(work *w, int l, double sign)
{
    const lanes *p = &w->lanes;
    double d, dt, ds, part = sign * p->share[l];
    depth_moments(p, l, &d, &dt, &ds);
    tl_vec3 n = lane_vector(p->n, l), t = lane_vector(p->t, l), s = lane_vector(p->s, l);
    w->sums->force = tl_v3_madd(w->sums->force, part * d, n);
    /* t cross n = -s, s cross n = t */
    w->sums->moment = tl_v3_madd(w->sums->moment, part * ds, t);
    w->sums->moment = tl_v3_madd(w->sums->moment, -part * dt, s);
}

static void take_surface(work *w, int l)
{
    const lanes *p = &w->lanes;
    tl_field_sums *sums = w->sums;
    double d, dt, ds, part = p->share[l];
    add_force(w, l, 1);
    depth_moments(p, l, &d, &dt, &ds);
    tl_vec3 n = lane_vector(p->n, l), t = lane_vector(p->t, l), s = lane_vector(p->s, l);
    sums->area = tl_v3_madd(sums->area, part * p->area[l], n);
    sums->area_moment = tl_v3_madd(sums->area_moment, part * p->is[l], t);
    sums->area_moment = tl_v3_madd(sums->area_moment, -part * p->it[l], s);
    sums->pressure += part * d;
    sums->pressed = tl_v3_madd(sums->pressed, part, place_of(p, l, d, dt, ds));
    sums->extent += part * p->area[l];
    sums->first = tl_v3_madd(sums->first, part, place_of(p, l, p->area[l], p->it[l], p->is[l]));
    sums->second += part * (p->h[l] * p->h[l] * p->area[l] + p->itt[l] + p->iss[l]);
    sums->stiffness += part * 2 * w->per[l] * p->area[l];
    sums->deepest = fmax(sums->deepest, p->deepest[l]);
    sums->polygons++;
}

static void take_border(work *w, int l)
{
    const tl_field_faces *f = w->faces;
    add_force(w, l, w->with[l] < real_faces(f) + f->border_a ? 1 : -1);
}

bool tl_field_surface(const tl_field_faces *f, tl_field_room *room, tl_field_sums *sums)
{
    work w;
    *sums = (tl_field_sums){0};
    if (!begin(&w, f, room))
        return false;
    w.sums = sums;
    w.take = take_surface;
    for (uint32_t a = 0; a < f->a; a++)
        for (uint32_t b = 0; b < f->b; b++)
            put_between(&w, a, f->a + b);
    flush(&w);
    /* B's motion shifts K's border at a seam of A where A is deeper than B, and the other way round */
    w.take = take_border;
    for (uint32_t k = real_faces(f); k < all_faces(f); k++) {
        bool of_a = k < real_faces(f) + f->border_a;
        for (uint32_t i = of_a ? f->a : 0; i < (of_a ? real_faces(f) : f->a); i++)
            put_border(&w, k, i);
    }
    flush(&w);
    return true;
}

/* ---------------------------------------------------------------- the volume ------------- */

/* K consists of cells, one for each face: where that face is the nearest. Over a cell with the borders j, each a
 * plane at distance h_j of the origin, V = 1/3 sum h_j A_j and int n . x dV = 1/4 sum h_j int n . x dS. Adds the share
 * of one border, at a signed distance, to the cell of a face. */
static void add_cell(work *w, int l, uint32_t face, double distance)
{
    const lanes *p = &w->lanes;
    double part = p->share[l];
    tl_vec3 x = place_of(p, l, p->area[l], p->it[l], p->is[l]);
    double volume = part * distance * p->area[l] / 3;
    w->volume->volume += volume;
    w->volume->energy += w->faces->c[face] * volume -
                         part * 0.25 * distance * tl_v3_dot(normal_of(w->faces, face), x);
}

/* The surface between two cells bounds both; its normal goes from the second face's to the first's. */
static void take_between(work *w, int l)
{
    add_cell(w, l, w->face[l], -w->lanes.h[l]);
    add_cell(w, l, w->with[l], w->lanes.h[l]);
}

static void take_outside(work *w, int l)
{
    add_cell(w, l, w->face[l], w->lanes.h[l]);
}

bool tl_field_integrate(const tl_field_faces *f, tl_field_room *room, tl_field_volume *volume)
{
    work w;
    *volume = (tl_field_volume){0};
    if (!begin(&w, f, room))
        return false;
    w.volume = volume;
    w.take = take_between;
    for (uint32_t i = 0; i < real_faces(f); i++)
        for (uint32_t j = i + 1; j < real_faces(f); j++)
            put_between(&w, i, j);
    flush(&w);
    w.take = take_outside;
    for (uint32_t i = 0; i < real_faces(f); i++) {
        put(&w, normal_of(f, i), f->c[i], i, i, 0, false);
        for (uint32_t k = real_faces(f); k < all_faces(f); k++)
            put_border(&w, k, i);
    }
    flush(&w);
    return true;
}
