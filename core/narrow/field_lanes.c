/* field_lanes.c - eight polygons of a pressure field side by side, one in a lane.
 *
 * Every polygon lies in a plane and is bounded by lines, one for each other plane. No polygon is ever clipped: a line
 * bounds the polygon between the crossings with all other lines. The polygon's integrals are sums over its lines
 * (Green's theorem). So there are no corners to be kept, and no branches.
 *
 * In a polygon's plane: axes t and s, origin where the plane is nearest to the frame's. A line is g . x <= c with a
 * unit normal g. Its own points are c g + r (-g_s, g_t) with the place r along it. Integrals are about a corner of the
 * polygon. */
#include "narrow/field_lanes.h"

#include "base/inline.h"

#include <math.h>
#include <string.h>

#define LANES TL_LANES

/* Tolerance: sine of the angle between two lines below which they do not cross. The error of a crossing's place, a
 * rounding over the sine, then becomes as large as what the wrong one of two such lines encloses. */
#define PARALLEL 1e-8
/* Tolerance: length of a face's normal, within the polygon's plane, below which the face is parallel to the plane.
 * Test: property/field_properties, property/press_properties. */
#define PARALLEL_FACE 1e-9
/* Place beyond the end of any line. */
#define FAR TL_FIELD_FAR
/* Tolerance: length, m, of a line that has no end: where it is crossed at all, by parallel lines far away. */
#define ENDLESS 1e145

/* ---------------------------------------------------------------- lines ------------------ */

/* Unit normals of the planes, the depth in them, and axes without a branch (Duff and others, "Building an orthonormal
 * basis, revisited", 2017). */
TL_VECTORIZED static void place_axes(tl_field_lanes *restrict p)
{
    double *restrict n0 = p->n[0], *restrict n1 = p->n[1], *restrict n2 = p->n[2];
#pragma omp simd
    for (unsigned l = 0; l < LANES; l++) {
        double length = sqrt(n0[l] * n0[l] + n1[l] * n1[l] + n2[l] * n2[l]);
        bool between = p->between[l] > 0, alike = between & (length <= TL_FIELD_ALIKE);
        double per = between ? 1 / length : 1.0;
        p->h[l] = between ? p->h[l] / length : p->h[l];
        p->length[l] = between ? length : p->length[l];
        p->share[l] = alike ? 0.0 : p->share[l];
        n0[l] *= per;
        n1[l] *= per;
        n2[l] *= per;
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

/* The line in which d_h - k d is zero, for a plane h; k is 1 for a face between cells, else 0. */
TL_VECTORIZED static void draw_line(tl_field_lanes *restrict p, const tl_field_plane *restrict h, double between,
                                    tl_field_line *restrict line)
{
#pragma omp simd
    for (unsigned l = 0; l < LANES; l++) {
        double k = between * h->face[l];
        double x = h->n[0][l] - k * p->face_n[0][l], y = h->n[1][l] - k * p->face_n[1][l];
        double z = h->n[2][l] - k * p->face_n[2][l], o = h->c[l] - k * p->face_c[l];
        double t = x * p->t[0][l] + y * p->t[1][l] + z * p->t[2][l];
        double s = x * p->s[0][l] + y * p->s[1][l] + z * p->s[2][l];
        o -= p->h[l] * (x * p->n[0][l] + y * p->n[1][l] + z * p->n[2][l]);
        double length = sqrt(t * t + s * s), per = 1 / length;
        double none = h->c[l] >= FAR ? 1.0 : 0.0, parallel = length < PARALLEL_FACE ? 1.0 : 0.0;
        double part = o > p->one_plane[l] ? 1.0 : 0.5;
        part = o < -p->one_plane[l] ? 0.0 : part;
        double kept = parallel > 0 ? part : 1.0, gone = none + parallel;
        p->share[l] *= none > 0 ? 1.0 : kept;
        line->gt[l] = gone > 0 ? 0.0 : t * per;
        line->gs[l] = gone > 0 ? 0.0 : s * per;
        line->c[l] = gone > 0 ? FAR : o * per;
        line->from[l] = -FAR;
        line->to[l] = FAR;
    }
}

/* The line d = 0. A plane parallel to its face has d > 0 or d < 0 everywhere. */
TL_VECTORIZED static void draw_own_line(tl_field_lanes *restrict p, tl_field_line *restrict line)
{
#pragma omp simd
    for (unsigned l = 0; l < LANES; l++) {
        double length = sqrt(p->dt[l] * p->dt[l] + p->ds[l] * p->ds[l]), per = 1 / length;
        double parallel = length < PARALLEL_FACE ? 1.0 : 0.0;
        p->share[l] *= parallel > 0 ? (p->d0[l] > 0 ? 1.0 : 0.0) : 1.0;
        line->gt[l] = parallel > 0 ? 0.0 : -p->dt[l] * per;
        line->gs[l] = parallel > 0 ? 0.0 : -p->ds[l] * per;
        line->c[l] = parallel > 0 ? FAR : p->d0[l] * per;
        line->from[l] = -FAR;
        line->to[l] = FAR;
    }
}

/* Bounds each of two lines by the other. Parallel lines cross far away, on the side that leaves nothing of one that
 * the other excludes. Of two lines in one place each bounds a half. */
TL_VECTORIZED static void cross_lines(tl_field_line *line, size_t count)
{
    for (size_t a = 0; a < count; a++) {
        const tl_field_line *restrict i = &line[a];
        double from[LANES], to[LANES];
        memcpy(from, i->from, sizeof from);
        memcpy(to, i->to, sizeof to);
        for (size_t b = a + 1; b < count; b++) {
            tl_field_line *restrict j = &line[b];
#pragma omp simd
            for (unsigned l = 0; l < LANES; l++) {
                double sine = i->gt[l] * j->gs[l] - i->gs[l] * j->gt[l];
                double cosine = i->gt[l] * j->gt[l] + i->gs[l] * j->gs[l];
                double least = sine < 0 ? -1 / FAR : 1 / FAR, whole = cosine < 0 ? -1.0 : 1.0;
                bool parallel = fabs(sine) < PARALLEL;
                double per = 1 / (parallel ? least : sine);
                cosine = parallel ? whole : cosine; /* so that both agree which is the nearer */
                double ri = (j->c[l] - cosine * i->c[l]) * per;
                double rj = (cosine * j->c[l] - i->c[l]) * per;
                double to_i = per > 0 ? ri : FAR, from_i = per > 0 ? -FAR : ri;
                double to_j = per > 0 ? FAR : rj, from_j = per > 0 ? rj : -FAR;
                to[l] = to[l] < to_i ? to[l] : to_i;
                from[l] = from[l] > from_i ? from[l] : from_i;
                j->to[l] = j->to[l] < to_j ? j->to[l] : to_j;
                j->from[l] = j->from[l] > from_j ? j->from[l] : from_j;
            }
        }
        memcpy(line[a].from, from, sizeof from);
        memcpy(line[a].to, to, sizeof to);
    }
}

/* Draws the lines of some planes, the first of `line`, and finds between which places they bound the polygons; how
 * many lines there are. */
static size_t draw(tl_field_lanes *p, const tl_field_plane *planes, uint32_t count, bool flat, tl_field_line *line)
{
    size_t lines = 0;
    place_axes(p);
    if (!flat)
        draw_own_line(p, &line[lines++]);
    for (uint32_t k = 0; k < count; k++)
        draw_line(p, &planes[k], flat ? 0 : 1, &line[lines++]);
    cross_lines(line, lines);
    return lines;
}

/* Adds 1 to the lanes of which a corner at one end of the line d = 0 lies beyond a plane. */
TL_VECTORIZED static void count_beyond(const tl_field_lanes *restrict p, const tl_field_plane *restrict h,
                                       const tl_field_line *restrict own, double *restrict count)
{
#pragma omp simd
    for (unsigned l = 0; l < LANES; l++) {
        bool bounds = (own->to[l] > own->from[l]) & (own->c[l] < FAR) & (p->share[l] > 0);
        double t = own->c[l] * own->gt[l] - own->from[l] * own->gs[l];
        double s = own->c[l] * own->gs[l] + own->from[l] * own->gt[l];
        double x = p->h[l] * p->n[0][l] + t * p->t[0][l] + s * p->s[0][l];
        double y = p->h[l] * p->n[1][l] + t * p->t[1][l] + s * p->s[1][l];
        double z = p->h[l] * p->n[2][l] + t * p->t[2][l] + s * p->s[2][l];
        bool within = x * h->n[0][l] + y * h->n[1][l] + z * h->n[2][l] <= h->c[l];
        count[l] += (bounds & !within) ? 1.0 : 0.0;
    }
}

/* Lanes, a bit each, of which a corner with d = 0 lies beyond one of some planes. */
static uint32_t corners_beyond(const tl_field_lanes *p, const tl_field_plane *planes, uint32_t count,
                               const tl_field_line *own)
{
    double beyond[LANES] = {0};
    uint32_t out = 0;
    for (uint32_t k = 0; k < count; k++) {
        count_beyond(p, &planes[k], own, beyond);
    }
    for (unsigned l = 0; l < LANES; l++)
        out |= (uint32_t)(beyond[l] > 0) << l;
    return out;
}

/* ---------------------------------------------------------------- integrals -------------- */

/* Takes a corner of each polygon for the origin of its plane: far from it nothing would be left of small ones but
 * roundings. */
TL_VECTORIZED static void place_origin(tl_field_lanes *restrict p, const tl_field_line *restrict line, size_t count)
{
    for (const tl_field_line *restrict i = line; i < line + count; i++) {
#pragma omp simd
        for (unsigned l = 0; l < LANES; l++) {
            bool bounds = (i->to[l] > i->from[l]) & (i->c[l] < FAR) & (p->share[l] > 0);
            double f = bounds ? i->from[l] : 0.0, o = bounds ? i->c[l] : 0.0;
            p->open[l] = (bounds & (i->to[l] - i->from[l] > ENDLESS)) ? 1.0 : p->open[l];
            p->origin_t[l] = bounds ? o * i->gt[l] - f * i->gs[l] : p->origin_t[l];
            p->origin_s[l] = bounds ? o * i->gs[l] + f * i->gt[l] : p->origin_s[l];
        }
    }
#pragma omp simd
    for (unsigned l = 0; l < LANES; l++)
        p->d0[l] += p->dt[l] * p->origin_t[l] + p->ds[l] * p->origin_s[l];
}

/* The triangle between the origin of a polygon and the part of a line that bounds it. It has corners p and q, with
 * their depths, its area, and the slope of d across the line times the length of the part. Where the line bounds
 * nothing, p and q are the origin. */
typedef struct triangle {
    double pt, ps, qt, qs, dp, dq, area, up;
    bool bounds;
} triangle;

TL_INLINE triangle triangle_of(const tl_field_lanes *p, const tl_field_line *i, unsigned l)
{
    bool bounds = (i->to[l] > i->from[l]) & (i->c[l] < FAR) & (p->share[l] > 0);
    double along = i->gt[l] * p->origin_s[l] - i->gs[l] * p->origin_t[l];
    double off = i->c[l] - (i->gt[l] * p->origin_t[l] + i->gs[l] * p->origin_s[l]);
    double f = bounds ? i->from[l] - along : 0.0, e = bounds ? i->to[l] - along : 0.0;
    double o = bounds ? off : 0.0;
    double pt = o * i->gt[l] - f * i->gs[l], ps = o * i->gs[l] + f * i->gt[l];
    double qt = o * i->gt[l] - e * i->gs[l], qs = o * i->gs[l] + e * i->gt[l];
    return (triangle){.pt = pt,
                      .ps = ps,
                      .qt = qt,
                      .qs = qs,
                      .dp = p->d0[l] + p->dt[l] * pt + p->ds[l] * ps,
                      .dq = p->d0[l] + p->dt[l] * qt + p->ds[l] * qs,
                      .area = 0.5 * o * (e - f),
                      .up = (i->gt[l] * p->dt[l] + i->gs[l] * p->ds[l]) * (e - f),
                      .bounds = bounds};
}

/* Sums the triangles between the origin and each line's part. */
TL_VECTORIZED static void add_lines(tl_field_lanes *restrict p, const tl_field_line *restrict line, size_t count)
{
    for (const tl_field_line *restrict i = line; i < line + count; i++) {
#pragma omp simd
        for (unsigned l = 0; l < LANES; l++) {
            const triangle of = triangle_of(p, i, l);
            double w = of.area, pt = of.pt, ps = of.ps, qt = of.qt, qs = of.qs;
            double dp = of.dp, dq = of.dq, up = of.up;
            p->area[l] += w;
            p->it[l] += w * (pt + qt) * (1.0 / 3);
            p->is[l] += w * (ps + qs) * (1.0 / 3);
            p->itt[l] += w * (pt * pt + pt * qt + qt * qt) * (1.0 / 6);
            p->iss[l] += w * (ps * ps + ps * qs + qs * qs) * (1.0 / 6);
            p->its[l] += w * (2 * (pt * ps + qt * qs) + pt * qs + qt * ps) * (1.0 / 12);
            /* by the divergence of d^2 grad d / 2 and d^3 grad d / 3: nothing cancels in thin slivers far from the
             * origin */
            p->d1[l] += up * (dp * dp + dp * dq + dq * dq) * (1.0 / 6);
            p->d2[l] += up * (dp * dp + dq * dq) * (dp + dq) * (1.0 / 12);
            double d = dp > dq ? dp : dq, at_t = dp > dq ? pt : qt, at_s = dp > dq ? ps : qs;
            bool more = of.bounds & (d > p->deepest[l]);
            p->deepest[l] = more ? d : p->deepest[l];
            p->deepest_t[l] = more ? at_t : p->deepest_t[l];
            p->deepest_s[l] = more ? at_s : p->deepest_s[l];
        }
    }
}

/* Integrates the polygons that these lines bound. */
static void sum_lines(tl_field_lanes *p, const tl_field_line *line, size_t count)
{
    memset(p->origin_t, 0, sizeof *p - offsetof(tl_field_lanes, origin_t));
    place_origin(p, line, count);
    add_lines(p, line, count);
}

/* x n + y t + z s of a lane. */
TL_INLINE void put_vector(const tl_field_lanes *p, double to[3][LANES], unsigned l, double x, double y, double z)
{
    to[0][l] = x * p->n[0][l] + y * p->t[0][l] + z * p->s[0][l];
    to[1][l] = x * p->n[1][l] + y * p->t[1][l] + z * p->s[1][l];
    to[2][l] = x * p->n[2][l] + y * p->t[2][l] + z * p->s[2][l];
}

/* What the polygons give whose lines have been summed. */
TL_VECTORIZED static void share_polygons(const tl_field_lanes *restrict p, tl_field_parts *restrict out)
{
#pragma omp simd
    for (unsigned l = 0; l < LANES; l++) {
        double d0 = p->d0[l], t = p->dt[l], s = p->ds[l], part = p->share[l];
        double ot = p->origin_t[l], os = p->origin_s[l], h = p->h[l];
        double area = part * p->area[l], it = part * p->it[l], is = part * p->is[l];
        double flat = d0 * area + t * it + s * is;
        double dt = part * (d0 * p->it[l] + t * p->itt[l] + s * p->its[l]);
        double ds = part * (d0 * p->is[l] + t * p->its[l] + s * p->iss[l]);
        double slope2 = t * t + s * s;
        bool steep = slope2 > TL_FIELD_STEEP * TL_FIELD_STEEP;
        double per = part / (steep ? slope2 : 1.0);
        double d = steep ? p->d1[l] * per : flat;
        out->area[l] = area;
        out->d[l] = d;
        out->dd[l] = steep ? p->d2[l] * per : d0 * flat + t * dt + s * ds;
        put_vector(p, out->force, l, d, 0, 0);
        /* t cross n = -s, s cross n = t */
        put_vector(p, out->moment, l, 0, ds + os * d, -(dt + ot * d));
        put_vector(p, out->swept, l, area, 0, 0);
        put_vector(p, out->swept_moment, l, 0, is + os * area, -(it + ot * area));
        put_vector(p, out->pressed, l, h * d, ot * d + dt, os * d + ds);
        put_vector(p, out->first, l, h * area, ot * area + it, os * area + is);
        out->second[l] = (h * h + ot * ot + os * os) * area + part * (p->itt[l] + p->iss[l]) + 2 * (ot * it + os * is);
        put_vector(p, out->deepest_at, l, h, ot + p->deepest_t[l], os + p->deepest_s[l]);
    }
}

/* ---------------------------------------------------------------- powers ----------------- */

/* Sums of products of n numbers are those of all ways to choose n with repetition, h_n. Over a triangle of area w with
 * the depths a, b, c: int d^n dS = 2 w h_n(a, b, c) / ((n + 1) (n + 2)). The integral of d^n x is the sum over its
 * corners of 2 w x_a h_n(a, b, c, a) / ((n + 1) (n + 2) (n + 3)). */
TL_VECTORIZED static void sum_powers(tl_field_lanes *restrict p, const tl_field_line *restrict line, size_t count)
{
    for (const tl_field_line *restrict i = line; i < line + count; i++) {
#pragma omp simd
        for (unsigned l = 0; l < LANES; l++) {
            const triangle of = triangle_of(p, i, l);
            double w = of.area, pt = of.pt, ps = of.ps, qt = of.qt, qs = of.qs;
            double d = p->d0[l], dp = of.dp, dq = of.dq, up = of.up;
            double p2 = dp * dp, p4 = p2 * p2, h1 = dp + dq, h2 = p2 + dq * h1;
            double h3 = dp * p2 + dq * h2, h4 = p4 + dq * h3, h5 = dp * p4 + dq * h4;
            p->steep[0][l] += up * h4 * (1.0 / 20);
            p->steep[1][l] += up * h5 * (1.0 / 30);
            h1 += d;
            h2 += d * h1;
            h3 += d * h2;
            h4 += d * h3;
            p->flat[0][l] += w * h3 * (1.0 / 10);
            p->flat[1][l] += w * h4 * (1.0 / 15);
            double by_p = h2 + dp * (h1 + dp), by_q = h2 + dq * (h1 + dq);
            p->power_t[0][l] += w * (by_p * pt + by_q * qt) * (1.0 / 30);
            p->power_s[0][l] += w * (by_p * ps + by_q * qs) * (1.0 / 30);
            by_p = h3 + dp * by_p;
            by_q = h3 + dq * by_q;
            p->power_t[1][l] += w * (by_p * pt + by_q * qt) * (1.0 / 60);
            p->power_s[1][l] += w * (by_p * ps + by_q * qs) * (1.0 / 60);
        }
    }
}

TL_VECTORIZED static void share_powers(const tl_field_lanes *restrict p, tl_field_parts *restrict out)
{
#pragma omp simd
    for (unsigned l = 0; l < LANES; l++) {
        double part = p->share[l], slope2 = p->dt[l] * p->dt[l] + p->ds[l] * p->ds[l];
        bool steep = slope2 > TL_FIELD_STEEP * TL_FIELD_STEEP;
        double per = part / (steep ? slope2 : 1.0);
        double cube = steep ? p->steep[0][l] * per : part * p->flat[0][l];
        double ot = p->origin_t[l], os = p->origin_s[l], dd = out->dd[l];
        out->cube[l] = cube;
        out->fourth[l] = steep ? p->steep[1][l] * per : part * p->flat[1][l];
        put_vector(p, out->power_moment[0], l, 0, part * p->power_s[0][l] + os * dd,
                   -(part * p->power_t[0][l] + ot * dd));
        put_vector(p, out->power_moment[1], l, 0, part * p->power_s[1][l] + os * cube,
                   -(part * p->power_t[1][l] + ot * cube));
    }
}

/* After both: the integrals of higher powers of d. */
static void add_powers(tl_field_lanes *p, const tl_field_line *line, size_t count, tl_field_parts *out)
{
    memset(p->flat, 0, offsetof(tl_field_lanes, origin_t) - offsetof(tl_field_lanes, flat));
    sum_powers(p, line, count);
    share_powers(p, out);
}

/* ---------------------------------------------------------------- all of it -------------- */

void tl_field_integrate_lanes(tl_field_lanes *p, tl_field_bounds *by, tl_field_parts *out)
{
    by->lines = draw(p, by->planes.row, by->planes.most, by->flat, by->line);
    by->beyond = corners_beyond(p, by->others.row, by->others.most, by->line);
    sum_lines(p, by->line, by->lines);
    share_polygons(p, out);
    if (by->powers)
        add_powers(p, by->line, by->lines, out);
}
