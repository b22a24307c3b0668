/* field.c - integrals of the pressure field of two blocks: field.h says what it is.
 *
 * Every polygon lies in a plane and is bounded by lines, one for each other face: on the part of S that belongs to the
 * faces a and b, d_h >= d_a for all others h, and d_a >= 0. Eight polygons are worked on side by side, one in a lane.
 * No polygon is ever clipped: a line bounds the polygon between the crossings with all other lines, and the polygon's
 * integrals are sums over its lines (Green's theorem). So there are no corners to be kept, and no branches.
 *
 * Cells that meet along a line make three polygons that meet there. So of the pairs of cells that met at another time those
 * that have come to meet are found: a line that bounds a polygon of the cells i and j, and belongs to a face k, bounds
 * polygons of i and k and of j and k as well. The polygons of a convex K hang together by their lines.
 *
 * K consists of cells, one for each face, where that face is the nearest. The fields -n d^2 / 2 and -n d have the
 * divergences d and 1 in the cell of a face of normal n, and vanish on the face. So G and V are sums over the polygons
 * between two cells, G = sum |n_i - n_j| / 2 int d^2 dS and V = sum |n_i - n_j| int d dS, and over the borders. No term
 * between cells is negative.
 *
 * In a polygon's plane: axes t and s, origin where the plane is nearest to the frame's. A line is g . x <= c with a
 * unit normal g, its own points are c g + r (-g_s, g_t) with the place r along it. Integrals are about a corner of the
 * polygon. */
#include "narrow/field.h"

#include <math.h>
#include <stdint.h>
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
/* Slope of d within a polygon's plane from which integrals of d are taken by its gradient. */
#define STEEP 0.1
/* The same from which two faces look so much the same way that what is between them bears nothing: no part of the stiffness. */
#define SAME_WAY 0.5
/* Place beyond the end of any line. */
#define FAR 1e290

/* Eight polygons. */
typedef struct lanes {
    double n[3][LANES], h[LANES];           /* plane */
    double t[3][LANES], s[3][LANES];        /* axes in it */
    double face_n[3][LANES], face_c[LANES]; /* the face whose depth counts */
    double one[LANES], other[LANES]; /* numbers of the planes that bound the polygon nowhere */
    double share[LANES];             /* of the integrals: 1; 1/2 for a tie; 0 for none */
    double d0[LANES], dt[LANES], ds[LANES];   /* depth in the plane: d0 + dt x_t + ds x_s */
    double origin_t[LANES], origin_s[LANES];  /* a corner; d0 and the rest are about it */
    double area[LANES], it[LANES], is[LANES]; /* integrals of 1, x_t, x_s, ... */
    double itt[LANES], its[LANES], iss[LANES];
    double d1[LANES], d2[LANES]; /* |grad d|^2 times the integrals of d and d^2 */
    double deepest[LANES], deepest_t[LANES], deepest_s[LANES];
    uint64_t bounded[LANES]; /* a bit for each line, the first for d = 0, that bounds the polygon */
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

/* The line in which d_h - k d is zero, for a face or border h; k is 1 for a face, and 0 for a border. */
TL_VECTORIZED static void place_line(lanes *restrict p, double number, const double normal[3],
                                     double offset, double k, double one_plane, double *restrict gt,
                                     double *restrict gs, double *restrict c, double *restrict from,
                                     double *restrict to)
{
    const double nx = normal[0], ny = normal[1], nz = normal[2];
#pragma omp simd
    for (unsigned l = 0; l < LANES; l++) {
        double x = nx - k * p->face_n[0][l], y = ny - k * p->face_n[1][l];
        double z = nz - k * p->face_n[2][l], o = offset - k * p->face_c[l];
        double t = x * p->t[0][l] + y * p->t[1][l] + z * p->t[2][l];
        double s = x * p->s[0][l] + y * p->s[1][l] + z * p->s[2][l];
        o -= p->h[l] * (x * p->n[0][l] + y * p->n[1][l] + z * p->n[2][l]);
        double length = sqrt(t * t + s * s);
        double none = ((p->one[l] == number) | (p->other[l] == number)) ? 1.0 : 0.0;
        double level = length < LEVEL ? 1.0 : 0.0;
        double part = o > one_plane ? 1.0 : 0.5;
        part = o < -one_plane ? 0.0 : part;
        double kept = none > level ? 1.0 : level > 0 ? part : 1.0;
        kept = none > 0 ? 1.0 : kept;
        p->share[l] *= kept;
        double gone = none + level, per = 1 / length;
        gt[l] = gone > 0 ? 0.0 : t * per;
        gs[l] = gone > 0 ? 0.0 : s * per;
        c[l] = gone > 0 ? FAR : o * per;
        from[l] = -FAR;
        to[l] = FAR;
    }
}

/* The line d = 0. A plane parallel to its face has d > 0 or d < 0 everywhere. */
TL_VECTORIZED static void place_own_line(lanes *restrict p, double *restrict gt,
                                         double *restrict gs, double *restrict c,
                                         double *restrict from, double *restrict to)
{
#pragma omp simd
    for (unsigned l = 0; l < LANES; l++) {
        double length = sqrt(p->dt[l] * p->dt[l] + p->ds[l] * p->ds[l]), per = 1 / length;
        double level = length < LEVEL ? 1.0 : 0.0;
        p->share[l] *= level > 0 ? (p->d0[l] > 0 ? 1.0 : 0.0) : 1.0;
        gt[l] = level > 0 ? 0.0 : -p->dt[l] * per;
        gs[l] = level > 0 ? 0.0 : -p->ds[l] * per;
        c[l] = level > 0 ? FAR : p->d0[l] * per;
        from[l] = -FAR;
        to[l] = FAR;
    }
}

/* Bounds each of two lines by the other. Parallel lines cross far away, on the side that leaves nothing of one that the
 * other excludes; of two lines in one place each bounds a half. */
TL_VECTORIZED static void cross_lines(const lines *restrict all)
{
    for (size_t i = 0; i < all->count; i++) {
        const double *restrict it = all->gt + i * LANES, *restrict is = all->gs + i * LANES;
        const double *restrict ic = all->c + i * LANES;
        double from[LANES], to[LANES];
        memcpy(from, all->from + i * LANES, sizeof from);
        memcpy(to, all->to + i * LANES, sizeof to);
        for (size_t j = i + 1; j < all->count; j++) {
            const double *restrict jt = all->gt + j * LANES, *restrict js = all->gs + j * LANES;
            const double *restrict jc = all->c + j * LANES;
            double *restrict jfrom = all->from + j * LANES, *restrict jto = all->to + j * LANES;
#pragma omp simd
            for (unsigned l = 0; l < LANES; l++) {
                double sine = it[l] * js[l] - is[l] * jt[l], cosine = it[l] * jt[l] + is[l] * js[l];
                double least = sine < 0 ? -1 / FAR : 1 / FAR, whole = cosine < 0 ? -1.0 : 1.0;
                bool level = fabs(sine) < PARALLEL;
                double per = 1 / (level ? least : sine);
                cosine = level ? whole : cosine; /* so that both agree which is the nearer */
                double ri = (jc[l] - cosine * ic[l]) * per, rj = (cosine * jc[l] - ic[l]) * per;
                double to_i = per > 0 ? ri : FAR, from_i = per > 0 ? -FAR : ri;
                double to_j = per > 0 ? FAR : rj, from_j = per > 0 ? rj : -FAR;
                to[l] = to[l] < to_i ? to[l] : to_i;
                from[l] = from[l] > from_i ? from[l] : from_i;
                jto[l] = jto[l] < to_j ? jto[l] : to_j;
                jfrom[l] = jfrom[l] > from_j ? jfrom[l] : from_j;
            }
        }
        memcpy(all->from + i * LANES, from, sizeof from);
        memcpy(all->to + i * LANES, to, sizeof to);
    }
}

/* Takes a corner of each polygon for the origin of its plane: far from it nothing would be left of small ones but roundings. */
TL_VECTORIZED static void place_origin(lanes *restrict p, const lines *restrict all)
{
    for (size_t i = 0; i < all->count; i++) {
        const double *restrict gt = all->gt + i * LANES, *restrict gs = all->gs + i * LANES;
        const double *restrict c = all->c + i * LANES;
        const double *restrict from = all->from + i * LANES, *restrict to = all->to + i * LANES;
#pragma omp simd
        for (unsigned l = 0; l < LANES; l++) {
            bool bounds = (to[l] > from[l]) & (c[l] < FAR) & (p->share[l] > 0);
            double f = bounds ? from[l] : 0.0, o = bounds ? c[l] : 0.0;
            p->origin_t[l] = bounds ? o * gt[l] - f * gs[l] : p->origin_t[l];
            p->origin_s[l] = bounds ? o * gs[l] + f * gt[l] : p->origin_s[l];
        }
    }
#pragma omp simd
    for (unsigned l = 0; l < LANES; l++)
        p->d0[l] += p->dt[l] * p->origin_t[l] + p->ds[l] * p->origin_s[l];
}

/* Sums the triangles between the origin and each line's part. */
TL_VECTORIZED static void add_lines(lanes *restrict p, const lines *restrict all)
{
    for (size_t i = 0; i < all->count; i++) {
        const double *restrict gt = all->gt + i * LANES, *restrict gs = all->gs + i * LANES;
        const double *restrict c = all->c + i * LANES;
        const double *restrict from = all->from + i * LANES, *restrict to = all->to + i * LANES;
        const uint64_t bit = i < 64 ? UINT64_C(1) << i : 0;
#pragma omp simd
        for (unsigned l = 0; l < LANES; l++) {
            bool bounds = (to[l] > from[l]) & (c[l] < FAR) & (p->share[l] > 0);
            p->bounded[l] |= bounds ? bit : 0;
            double along = gt[l] * p->origin_s[l] - gs[l] * p->origin_t[l];
            double off = c[l] - (gt[l] * p->origin_t[l] + gs[l] * p->origin_s[l]);
            double f = bounds ? from[l] - along : 0.0, e = bounds ? to[l] - along : 0.0;
            double o = bounds ? off : 0.0;
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
            /* by the divergence of d^2 grad d / 2 and d^3 grad d / 3: nothing cancels in thin slivers far from the origin */
            double up = (gt[l] * p->dt[l] + gs[l] * p->ds[l]) * (e - f);
            p->d1[l] += up * (dp * dp + dp * dq + dq * dq) * (1.0 / 6);
            p->d2[l] += up * (dp * dp + dq * dq) * (dp + dq) * (1.0 / 12);
            double d = dp > dq ? dp : dq, at_t = dp > dq ? pt : qt, at_s = dp > dq ? ps : qs;
            bool more = bounds & (d > p->deepest[l]);
            p->deepest[l] = more ? d : p->deepest[l];
            p->deepest_t[l] = more ? at_t : p->deepest_t[l];
            p->deepest_s[l] = more ? at_s : p->deepest_s[l];
        }
    }
}

/* ---------------------------------------------------------------- work ------------------- */

/* Integrals of polygons, eight at a time. */
typedef struct work {
    const tl_field_faces *faces;
    double one_plane; /* offset within which planes are one */
    lines lines;
    lanes lanes;
    int filled;
    uint32_t face[LANES], with[LANES]; /* the polygon's two planes */
    double length[LANES];         /* |n_a - n_b|; of a border minus the cosine of both planes */
    uint16_t met[TL_FIELD_KNOWN]; /* pairs of cells that meet, where few faces are known */
    tl_field_sums *sums;
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

static bool begin(work *w, const tl_field_faces *f, tl_field_room *room, tl_field_sums *sums)
{
    w->faces = f;
    w->sums = sums;
    w->filled = 0;
    double largest = 0;
    for (uint32_t i = 0; i < all_faces(f); i++)
        largest = fmax(largest, fabs(f->c[i]));
    w->one_plane = ONE_PLANE * largest;
    return make_room(room, f, &w->lines);
}

/* ---------------------------------------------------------------- sums ------------------- */

/* Integrals of 1, d, d^2, d x_t and d x_s over a lane's polygon, times its share. */
typedef struct depths {
    double area, d, dd, dt, ds;
} depths;

static depths depths_of(const lanes *p, int l)
{
    double d0 = p->d0[l], t = p->dt[l], s = p->ds[l], part = p->share[l];
    depths o = {.area = part * p->area[l],
                .d = part * (d0 * p->area[l] + t * p->it[l] + s * p->is[l]),
                .dt = part * (d0 * p->it[l] + t * p->itt[l] + s * p->its[l]),
                .ds = part * (d0 * p->is[l] + t * p->its[l] + s * p->iss[l])};
    double slope2 = t * t + s * s;
    bool steep = slope2 > STEEP * STEEP;
    o.dd = steep ? part * p->d2[l] / slope2 : d0 * o.d + t * o.dt + s * o.ds;
    o.d = steep ? part * p->d1[l] / slope2 : o.d;
    return o;
}

/* The origin times an integral + its first moments about it: int x dS, or int d x dS. */
static tl_vec3 place_of(const lanes *p, int l, double along, double it, double is)
{
    tl_vec3 x = tl_v3_scale(p->h[l] * along, lane_vector(p->n, l));
    x = tl_v3_madd(x, p->origin_t[l] * along + it, lane_vector(p->t, l));
    return tl_v3_madd(x, p->origin_s[l] * along + is, lane_vector(p->s, l));
}

/* Adds int d n dS of a polygon, and int d x cross n dS. */
static void add_force(const lanes *p, int l, const depths *o, double sign, tl_vec3 *force,
                      tl_vec3 *moment)
{
    tl_vec3 n = lane_vector(p->n, l), t = lane_vector(p->t, l), s = lane_vector(p->s, l);
    double ot = p->origin_t[l], os = p->origin_s[l];
    *force = tl_v3_madd(*force, sign * o->d, n);
    /* t cross n = -s, s cross n = t */
    *moment = tl_v3_madd(*moment, sign * (o->ds + os * o->d), t);
    *moment = tl_v3_madd(*moment, -sign * (o->dt + ot * o->d), s);
}

/* A polygon's part in the gradients of G and V. */
static void add_gradient(work *w, int l, const depths *o, double sign)
{
    const lanes *p = &w->lanes;
    tl_field_sums *sums = w->sums;
    tl_vec3 n = lane_vector(p->n, l), t = lane_vector(p->t, l), s = lane_vector(p->s, l);
    double ot = p->origin_t[l], os = p->origin_s[l], part = sign * p->share[l];
    add_force(p, l, o, sign, &sums->force, &sums->moment);
    sums->swept = tl_v3_madd(sums->swept, sign * o->area, n);
    sums->swept_moment = tl_v3_madd(sums->swept_moment, part * p->is[l] + sign * os * o->area, t);
    sums->swept_moment = tl_v3_madd(sums->swept_moment, -part * p->it[l] - sign * ot * o->area, s);
}

/* A polygon of S. */
static void add_surface(work *w, int l, const depths *o)
{
    const lanes *p = &w->lanes;
    tl_field_sums *sums = w->sums;
    double part = p->share[l], ot = p->origin_t[l], os = p->origin_s[l];
    add_gradient(w, l, o, 1);
    sums->area = tl_v3_madd(sums->area, o->area, lane_vector(p->n, l));
    sums->pressure += o->d;
    sums->pressed = tl_v3_add(sums->pressed, place_of(p, l, o->d, o->dt, o->ds));
    sums->extent += o->area;
    sums->first = tl_v3_add(sums->first, place_of(p, l, o->area, part * p->it[l], part * p->is[l]));
    sums->second += (p->h[l] * p->h[l] + ot * ot + os * os) * o->area +
                    part * (p->itt[l] + p->iss[l] + 2 * (ot * p->it[l] + os * p->is[l]));
    sums->stiffness += 2 / fmax(w->length[l], SAME_WAY) * o->area;
    if (p->deepest[l] > sums->deepest) {
        sums->deepest = p->deepest[l];
        sums->deepest_at = place_of(p, l, 1, p->deepest_t[l], p->deepest_s[l]);
    }
}

/* Notes the cells that meet along a polygon and its lines. */
static void note_met(work *w, int l)
{
    uint32_t i = w->face[l], j = w->with[l], real = real_faces(w->faces);
    uint32_t by = (uint32_t)(w->lanes.bounded[l] >> 1) & ((1u << real) - 1);
    w->met[i] |= (uint16_t)(1u << j);
    w->met[j] |= (uint16_t)(1u << i);
    for (; by; by &= by - 1) {
        uint32_t k = (uint32_t)__builtin_ctz(by);
        w->met[i] |= (uint16_t)(1u << k);
        w->met[j] |= (uint16_t)(1u << k);
        w->met[k] |= (uint16_t)(1u << i | 1u << j);
    }
}

static void take(work *w, int l)
{
    const tl_field_faces *f = w->faces;
    if (f->known && w->with[l] < real_faces(f))
        note_met(w, l);
    const depths o = depths_of(&w->lanes, l);
    w->sums->volume += w->length[l] * o.d;
    w->sums->energy += 0.5 * w->length[l] * o.dd;
    bool face_of_b = w->face[l] >= f->a;
    if (w->with[l] < real_faces(f)) {
        if (!face_of_b && w->with[l] >= f->a)
            add_surface(w, l, &o);
        return;
    }
    /* B's motion shifts K's border at a seam of A where A is deeper than B, and the other way round */
    bool border_of_b = w->with[l] >= real_faces(f) + f->border_a;
    if (face_of_b != border_of_b)
        add_gradient(w, l, &o, border_of_b ? -1 : 1);
    uint32_t end = border_of_b ? all_faces(f) : real_faces(f) + f->border_a;
    if (w->with[l] + (border_of_b ? f->seam_b : f->seam_a) >= end)
        add_force(&w->lanes, l, &o, border_of_b ? 1 : -1, &w->sums->through,
                  &w->sums->through_moment);
}

/* ---------------------------------------------------------------- polygons --------------- */

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
    memset(p->origin_t, 0, (size_t)((char *)(p + 1) - (char *)p->origin_t));
    place_axes(p);
    place_own_line(p, all->gt, all->gs, all->c, all->from, all->to);
    for (uint32_t i = 0; i < all_faces(f); i++) {
        const double n[3] = {f->n[0][i], f->n[1][i], f->n[2][i]};
        size_t at = (i + 1u) * LANES;
        place_line(p, i, n, f->c[i], i < real_faces(f), w->one_plane, all->gt + at, all->gs + at,
                   all->c + at, all->from + at, all->to + at);
    }
    cross_lines(all);
    place_origin(p, all);
    add_lines(p, all);
    for (int lane = 0; lane < w->filled; lane++)
        if (p->area[lane] > 0)
            take(w, lane);
    w->filled = 0;
}

/* Puts a polygon into the lanes: in a plane, of the depth of a face, bounded by neither that nor another plane. */
static void put(work *w, tl_vec3 n, double h, uint32_t face, uint32_t with, double length)
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
    p->share[l] = 1;
    w->face[l] = face;
    w->with[l] = with;
    w->length[l] = length;
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
        put(w, tl_v3_scale(1 / length, m), (f->c[a] - f->c[b]) / length, a, b, length);
}

/* The polygons between cells that are known to meet. Where others turn out to, all is done again with these: the sums are
 * always those of the same polygons in the same order. */
static void put_known(work *w)
{
    const tl_field_faces *f = w->faces;
    uint32_t real = real_faces(f), any = 0, missing;
    uint16_t look[TL_FIELD_KNOWN];
    for (uint32_t i = 0; i < real; i++)
        any |= f->known[i];
    for (uint32_t i = 0; i < real; i++)
        look[i] = any ? f->known[i] : UINT16_MAX;
    do {
        *w->sums = (tl_field_sums){0};
        memset(w->met, 0, sizeof w->met);
        for (uint32_t i = 0; i < real; i++)
            for (uint32_t j = i + 1; j < real; j++)
                if (look[i] >> j & 1)
                    put_between(w, i, j);
        flush(w);
        missing = 0;
        for (uint32_t i = 0; i < real; i++) {
            missing |= w->met[i] & ~(uint32_t)look[i];
            look[i] |= w->met[i];
        }
    } while (missing);
    memcpy(f->known, w->met, real * sizeof *f->known);
}

bool tl_field_integrate(const tl_field_faces *f, tl_field_room *room, tl_field_sums *sums)
{
    work w;
    *sums = (tl_field_sums){0};
    if (!begin(&w, f, room, sums))
        return false;
    if (f->known) {
        put_known(&w);
    } else {
        for (uint32_t i = 0; i < real_faces(f); i++)
            for (uint32_t j = i + 1; j < real_faces(f); j++)
                put_between(&w, i, j);
    }
    for (uint32_t k = real_faces(f); k < all_faces(f); k++)
        for (uint32_t i = 0; i < real_faces(f); i++) {
            tl_vec3 n = normal_of(f, k);
            put(&w, n, f->c[k], i, k, -tl_v3_dot(n, normal_of(f, i)));
        }
    flush(&w);
    return true;
}
