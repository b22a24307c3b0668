/* field_mesh.c - the polygons of a pressure field from place to place.
 *
 * While two blocks move on, their field mostly keeps its polygons: a corner is where the same planes are nearest, and
 * only its place changes. So the planes of all corners are kept, the mesh. At a new place every corner is found from
 * its planes, three equations. The mesh stands if no plane is nearer to any corner than its own are, and none is
 * passed:
 *
 *     c_h - n_h . x >= d    for all faces h,        c_k - n_k . x >= 0    for all borders k.
 *
 * Then it is all of the field. A polygon is convex, and its sides lie between corners that belong to it. So it is
 * whole, and so is the part of S that it hangs together with. From a point where A is the nearer, the way out through
 * its nearest face stays where A is the nearer. For d_B grows no faster than d_A falls. So each part of S ends on the
 * surface of K, where faces of both blocks meet, and there all corners are known. K has no others than these and those
 * of one block that lie in the other, which are kept, too.
 *
 * With borders, or faces of other parts, the nearest face need not bound K. Then the mesh is that of all cells: the
 * polygons between any two of them, and those at borders. They are a subdivision of K, the upper side of the convex
 * body 0 <= d <= c_h - n_h . x, 0 <= c_k - n_k . x in four dimensions. Each polygon beside a side is there
 * (field.c). So all sides that a corner has lead to corners that are known: the mesh is closed, and K hangs
 * together.
 *
 * Polygons are summed by triangles from their first corner.
 *
 * Slopes. Force and moment are the fluxes of d_A t through S, for t = e_k and e_k x x. Where B moves by a field of ways
 * u, S moves along n by -(n_b . u) / |n_a - n_b|. The divergence of d_A t is -n_a . t. And d_A t is continuous on S,
 * and 0 on its border. So the flux changes by
 *
 *     int over S of (n_a . t) (n_b . u) / |n_a - n_b| dS. */
#include "narrow/field_mesh.h"

#include "base/inline.h"
#include "base/lanes.h"
#include "narrow/apex.h"

#include <math.h>
#include <string.h>
#include <talus/vmath.h>

/* Cost only: corners, and polygons, side by side, as many as tl_lanes_turn turns. A field has some 11 and 8 of them. Of
 * TL_LANES more would stand idle. */
#define LANES 4u

/* Cost only: determinant of a corner's three equations, with normals of length 1 and their differences, below which its
 * place is lost in roundings. */
#define SHARP 1e-5

/* Tolerance: roundings of the largest offset by which a corner may seem to lie outside. */
#define SLACK (4 * TL_FIELD_ONE_PLANE)

/* Tolerance: most by which that grows where planes meet at small angles: corners of a block need it, where more than
 * three do. */
#define MOST_BLURRED 1e3

/* ---------------------------------------------------------------- corners ---------------- */

/* Places of the corners of a mesh, and the depths there: x, y, z, d in a row. */
typedef struct corners {
    double at[TL_MESH_CORNERS][4];
} corners;

enum { MOST_GROUPS = TL_MESH_CORNERS / LANES };

/* Some corners side by side: the same, and how much larger roundings of offsets are there; NaN where planes hardly
 * meet. */
typedef struct corner_lanes {
    double x[LANES], y[LANES], z[LANES], d[LANES], blur[LANES];
} corner_lanes;

/* The planes of a field, n and c in a row. */
typedef struct plane_rows {
    double of[TL_FIELD_KNOWN + 1][4];
} plane_rows;

/* Places corners, also as rows. The first plane of a corner is a face's. The others are as near, or are borders,
 * numbers from `faces` on, and hold it. */
TL_INLINE void place_corners(const plane_rows *restrict rows, const uint8_t *restrict plane, uint32_t faces,
                             bool seamed, corner_lanes *restrict at, double (*restrict to)[4])
{
    double n[4][3][LANES], o[4][LANES], near[4][LANES];
    for (uint32_t k = 0; k < 4; k++) {
        const uint8_t *restrict of = plane + (size_t)k * TL_MESH_CORNERS;
        const double *const row[] = {rows->of[of[0]], rows->of[of[1]], rows->of[of[2]], rows->of[of[3]]};
        tl_lanes_turn(row, n[k][0], n[k][1], n[k][2], o[k]);
        for (uint32_t l = 0; l < LANES && seamed; l++)
            near[k][l] = of[l] < faces || of[l] == TL_MESH_ZERO ? 1.0 : 0.0;
    }
#pragma omp simd
    for (uint32_t l = 0; l < LANES; l++) {
        double a = seamed ? near[1][l] : 1.0, b = seamed ? near[2][l] : 1.0;
        double e = seamed ? near[3][l] : 1.0;
        double ax = n[1][0][l] - a * n[0][0][l], ay = n[1][1][l] - a * n[0][1][l];
        double az = n[1][2][l] - a * n[0][2][l], ao = o[1][l] - a * o[0][l];
        double bx = n[2][0][l] - b * n[0][0][l], by = n[2][1][l] - b * n[0][1][l];
        double bz = n[2][2][l] - b * n[0][2][l], bo = o[2][l] - b * o[0][l];
        double cx = n[3][0][l] - e * n[0][0][l], cy = n[3][1][l] - e * n[0][1][l];
        double cz = n[3][2][l] - e * n[0][2][l], co = o[3][l] - e * o[0][l];
        double ux = by * cz - bz * cy, uy = bz * cx - bx * cz, uz = bx * cy - by * cx;
        double vx = cy * az - cz * ay, vy = cz * ax - cx * az, vz = cx * ay - cy * ax;
        double wx = ay * bz - az * by, wy = az * bx - ax * bz, wz = ax * by - ay * bx;
        double det = ax * ux + ay * uy + az * uz;
        double per = fabs(det) > SHARP ? 1 / det : NAN, far = 1 + fabs(per);
        double x = (ao * ux + bo * vx + co * wx) * per, y = (ao * uy + bo * vy + co * wy) * per;
        double z = (ao * uz + bo * vz + co * wz) * per;
        at->blur[l] = far < MOST_BLURRED ? far : MOST_BLURRED;
        at->x[l] = x;
        at->y[l] = y;
        at->z[l] = z;
        at->d[l] = o[0][l] - (n[0][0][l] * x + n[0][1][l] * y + n[0][2][l] * z);
    }
    const double *const column[] = {at->x, at->y, at->z, at->d};
    tl_lanes_turn(column, to[0], to[1], to[2], to[3]);
}

TL_VECTORIZED static void place_corners_of_faces(const plane_rows *restrict rows, const uint8_t *restrict plane,
                                                 corner_lanes *restrict at, double (*restrict to)[4])
{
    place_corners(rows, plane, 0, false, at, to);
}

TL_VECTORIZED static void place_seamed_corners(const plane_rows *restrict rows, const uint8_t *restrict plane,
                                               uint32_t faces, corner_lanes *restrict at, double (*restrict to)[4])
{
    place_corners(rows, plane, faces, true, at, to);
}

/* Four columns of so many planes become rows, with those that fill up the last lanes. */
TL_VECTORIZED static void put_planes(const tl_field_faces *restrict f, uint32_t count, plane_rows *restrict rows)
{
    for (uint32_t k = 0; k < count; k += LANES) {
        const double *const column[] = {f->n[0] + k, f->n[1] + k, f->n[2] + k, f->c + k};
        tl_lanes_turn(column, rows->of[k], rows->of[k + 1], rows->of[k + 2], rows->of[k + 3]);
    }
    for (uint32_t axis = 0; axis < 4; axis++)
        rows->of[TL_MESH_ZERO][axis] = 0;
}

/* The largest of some offsets. */
TL_VECTORIZED static double largest_offset(const double *restrict c, uint32_t count)
{
    const uint32_t whole = count / LANES * LANES;
    double most[LANES] = {0}, largest = 0;
    for (uint32_t k = 0; k < whole; k += LANES)
        for (uint32_t l = 0; l < LANES; l++)
            most[l] = fabs(c[k + l]) > most[l] ? fabs(c[k + l]) : most[l];
    for (uint32_t l = 0; l < LANES; l++)
        largest = most[l] > largest ? most[l] : largest;
    for (uint32_t k = whole; k < count; k++)
        largest = fabs(c[k]) > largest ? fabs(c[k]) : largest;
    return largest;
}

/* By how much the nearest of some planes is farther from each corner than d, before that is compared. */
TL_VECTORIZED static void find_nearest(const plane_rows *restrict rows, uint32_t first, uint32_t end,
                                       const corner_lanes *restrict at, uint32_t groups,
                                       double (*restrict least)[LANES])
{
    for (uint32_t g = 0; g < groups; g++)
        for (uint32_t l = 0; l < LANES; l++)
            least[g][l] = INFINITY;
    for (uint32_t k = first; k < end; k++) {
        const double nx = rows->of[k][0], ny = rows->of[k][1], nz = rows->of[k][2], c = rows->of[k][3];
        for (uint32_t g = 0; g < groups; g++)
#pragma omp simd
            for (uint32_t l = 0; l < LANES; l++) {
                double over = c - (nx * at[g].x[l] + ny * at[g].y[l] + nz * at[g].z[l]);
                least[g][l] = least[g][l] < over ? least[g][l] : over;
            }
    }
}

/* Whether none of the planes from `first` to before `end` is nearer to any corner than d, or than 0 where they are
 * borders. Allowed is a slack that grows with the roundings. */
static bool corners_hold(const plane_rows *rows, uint32_t first, uint32_t end, bool borders, const corner_lanes *at,
                         uint32_t groups, double slack)
{
    double least[MOST_GROUPS][LANES];
    bool all = true;
    find_nearest(rows, first, end, at, groups, least);
    for (uint32_t g = 0; g < groups; g++)
        for (uint32_t l = 0; l < LANES; l++)
            all &= least[g][l] - (borders ? 0 : at[g].d[l]) >= -slack * at[g].blur[l];
    return all;
}

/* Whether the mesh stands; then its corners are in `at`, and the planes in `rows`. */
static bool mesh_holds(const tl_field_faces *f, plane_rows *rows, corners *at)
{
    const tl_field_mesh *mesh = f->mesh;
    const uint32_t planes = f->a + f->b, all = planes + f->border_a + f->border_b;
    const uint32_t groups = (mesh->corners + LANES - 1) / LANES;
    const double slack = SLACK * largest_offset(f->c, all);
    corner_lanes lanes[MOST_GROUPS];
    put_planes(f, all, rows);
    for (uint32_t g = 0; g < groups; g++) {
        const uint8_t *plane = mesh->plane[0] + (size_t)g * LANES;
        if (f->seamed)
            place_seamed_corners(rows, plane, planes, &lanes[g], at->at + (size_t)g * LANES);
        else
            place_corners_of_faces(rows, plane, &lanes[g], at->at + (size_t)g * LANES);
    }
    return corners_hold(rows, 0, planes, false, lanes, groups, slack) &&
           (all == planes || corners_hold(rows, planes, all, true, lanes, groups, slack));
}

/* ---------------------------------------------------------------- polygons --------------- */

/* A corner of each of some polygons side by side. */
typedef struct polygon_corner {
    double x[3][LANES], d[LANES];
} polygon_corner;

/* Integrals over polygons: of 1, d, d^2, x, d x, x . x. */
typedef struct integrals {
    double area[LANES], d[LANES], dd[LANES], x[3][LANES], dx[3][LANES], xx[LANES];
} integrals;

/* Second moments of these: xx, yy, zz, xy, yz, zx. */
typedef struct second_moments {
    double of[6][LANES];
} second_moments;

/* Some polygons side by side. */
typedef struct polygons {
    const uint8_t *loop[LANES];
    uint32_t sides[LANES], most;
    uint8_t own[LANES][2];             /* the two planes */
    double on[LANES];                  /* 0: what fills up the lanes */
    double face[2][3][LANES];          /* n_i and n_j */
    double n[3][LANES], length[LANES]; /* n_i - n_j, then divided by its length, and that */
    double
        gradient[LANES]; /* 1: of S, 0: between cells of one block; of a border the sign of its part in the gradient */
    double cells[LANES]; /* how many of the cells beside it have their energy from their sides */
    integrals of;
} polygons;

/* The k-th corners of polygons; of one that has fewer, its last. */
TL_INLINE void take_corner(const corners *at, const polygons *p, uint32_t k, polygon_corner *out)
{
    const double *row[LANES];
    for (uint32_t l = 0; l < LANES; l++)
        row[l] = at->at[p->loop[l][k < p->sides[l] ? k : p->sides[l] - 1]];
    tl_lanes_turn(row, out->x[0], out->x[1], out->x[2], out->d);
}

/* Adds a triangle of each polygon. */
TL_INLINE void add_triangle(const polygons *p, const polygon_corner *u, const polygon_corner *v,
                            const polygon_corner *w, integrals *s)
{
#pragma omp simd
    for (uint32_t l = 0; l < LANES; l++) {
        double ux = u->x[0][l], uy = u->x[1][l], uz = u->x[2][l], ud = u->d[l];
        double vx = v->x[0][l], vy = v->x[1][l], vz = v->x[2][l], vd = v->d[l];
        double wx = w->x[0][l], wy = w->x[1][l], wz = w->x[2][l], wd = w->d[l];
        double ax = vx - ux, ay = vy - uy, az = vz - uz;
        double bx = wx - ux, by = wy - uy, bz = wz - uz;
        double twice =
            p->n[0][l] * (ay * bz - az * by) + p->n[1][l] * (az * bx - ax * bz) + p->n[2][l] * (ax * by - ay * bx);
        double third = twice * (1.0 / 6), twelfth = twice * (1.0 / 24);
        double x = ux + vx + wx, y = uy + vy + wy, z = uz + vz + wz, d = ud + vd + wd;
        double squares = ux * ux + uy * uy + uz * uz + vx * vx + vy * vy + vz * vz + wx * wx + wy * wy + wz * wz;
        s->area[l] += 0.5 * twice;
        s->d[l] += third * d;
        s->dd[l] += twelfth * (d * d + ud * ud + vd * vd + wd * wd);
        s->x[0][l] += third * x;
        s->x[1][l] += third * y;
        s->x[2][l] += third * z;
        s->dx[0][l] += twelfth * (d * x + ud * ux + vd * vx + wd * wx);
        s->dx[1][l] += twelfth * (d * y + ud * uy + vd * vy + wd * wy);
        s->dx[2][l] += twelfth * (d * z + ud * uz + vd * vz + wd * wz);
        s->xx[l] += twelfth * (x * x + y * y + z * z + squares);
    }
}

/* Adds the second moments of a triangle of each polygon. */
TL_INLINE void add_second_moments(const polygons *p, const polygon_corner *u, const polygon_corner *v,
                                  const polygon_corner *w, second_moments *s)
{
#pragma omp simd
    for (uint32_t l = 0; l < LANES; l++) {
        double ux = u->x[0][l], uy = u->x[1][l], uz = u->x[2][l];
        double vx = v->x[0][l], vy = v->x[1][l], vz = v->x[2][l];
        double wx = w->x[0][l], wy = w->x[1][l], wz = w->x[2][l];
        double ax = vx - ux, ay = vy - uy, az = vz - uz;
        double bx = wx - ux, by = wy - uy, bz = wz - uz;
        double twelfth = (1.0 / 24) * (p->n[0][l] * (ay * bz - az * by) + p->n[1][l] * (az * bx - ax * bz) +
                                       p->n[2][l] * (ax * by - ay * bx));
        double x = ux + vx + wx, y = uy + vy + wy, z = uz + vz + wz;
        s->of[0][l] += twelfth * (x * x + ux * ux + vx * vx + wx * wx);
        s->of[1][l] += twelfth * (y * y + uy * uy + vy * vy + wy * wy);
        s->of[2][l] += twelfth * (z * z + uz * uz + vz * vz + wz * wz);
        s->of[3][l] += twelfth * (x * y + ux * uy + vx * vy + wx * wy);
        s->of[4][l] += twelfth * (y * z + uy * uz + vy * vz + wy * wz);
        s->of[5][l] += twelfth * (z * x + uz * ux + vz * vx + wz * wx);
    }
}

/* Integrals over polygons: of d^2, d^3 and d^4, and of d^2 x and d^3 x. */
typedef struct power_integrals {
    double cube[LANES], fourth[LANES], x[TL_FIELD_POWERS][3][LANES];
} power_integrals;

/* Adds a triangle of each polygon: see sum_powers of field_lanes.c. */
TL_INLINE void add_triangle_powers(const polygons *p, const polygon_corner *u, const polygon_corner *v,
                                   const polygon_corner *w, power_integrals *s)
{
    const polygon_corner *corner[] = {u, v, w};
#pragma omp simd
    for (uint32_t l = 0; l < LANES; l++) {
        double ax = v->x[0][l] - u->x[0][l], bx = w->x[0][l] - u->x[0][l];
        double ay = v->x[1][l] - u->x[1][l], by = w->x[1][l] - u->x[1][l];
        double az = v->x[2][l] - u->x[2][l], bz = w->x[2][l] - u->x[2][l];
        double twice =
            p->n[0][l] * (ay * bz - az * by) + p->n[1][l] * (az * bx - ax * bz) + p->n[2][l] * (ax * by - ay * bx);
        double a = u->d[l], b = v->d[l], c = w->d[l], a2 = a * a;
        double h1 = a + b, h2 = a2 + b * h1, h3 = a * a2 + b * h2, h4 = a2 * a2 + b * h3;
        h1 += c;
        h2 += c * h1;
        h3 += c * h2;
        h4 += c * h3;
        s->cube[l] += twice * h3 * (1.0 / 20);
        s->fourth[l] += twice * h4 * (1.0 / 30);
        for (int k = 0; k < 3; k++) {
            double d = corner[k]->d[l], square = h2 + d * (h1 + d);
            double one = twice * square * (1.0 / 60), two = twice * (h3 + d * square) * (1.0 / 120);
            for (int axis = 0; axis < 3; axis++) {
                s->x[0][axis][l] += one * corner[k]->x[axis][l];
                s->x[1][axis][l] += two * corner[k]->x[axis][l];
            }
        }
    }
}

/* The same of higher powers of d, after that. */
TL_VECTORIZED static void integrate_powers(const corners *restrict at, const polygons *restrict p,
                                           power_integrals *restrict out)
{
    polygon_corner u, v, w;
    power_integrals s;
    memset(&s, 0, sizeof s);
    take_corner(at, p, 0, &u);
    take_corner(at, p, 1, &v);
    for (uint32_t k = 2; k < p->most; k++) {
        take_corner(at, p, k, &w);
        add_triangle_powers(p, &u, &v, &w, &s);
        v = w;
    }
    *out = s;
}

/* Integrates over polygons by triangles from their first corners; their second moments, too, if they are wanted.
 */
TL_INLINE void integrate_triangles(const corners *restrict at, polygons *restrict p, second_moments *restrict second)
{
    polygon_corner u, side[2];
    integrals s;
    memset(&s, 0, sizeof s);
#pragma omp simd
    for (uint32_t l = 0; l < LANES; l++) {
        double x = p->n[0][l], y = p->n[1][l], z = p->n[2][l];
        double length = sqrt(x * x + y * y + z * z), per = 1 / length;
        p->length[l] = length;
        p->n[0][l] = x * per;
        p->n[1][l] = y * per;
        p->n[2][l] = z * per;
    }
    take_corner(at, p, 0, &u);
    take_corner(at, p, 1, &side[1]);
    for (uint32_t k = 2; k < p->most; k++) {
        polygon_corner *w = &side[k % 2];
        const polygon_corner *v = &side[(k + 1) % 2];
        take_corner(at, p, k, w);
        add_triangle(p, &u, v, w, &s);
        if (second)
            add_second_moments(p, &u, v, w, second);
    }
    p->of = s;
}

TL_VECTORIZED static void integrate_polygons(const corners *restrict at, polygons *restrict p)
{
    integrate_triangles(at, p, NULL);
}

TL_VECTORIZED static void integrate_second_moments(const corners *restrict at, polygons *restrict p,
                                                   second_moments *restrict out)
{
    second_moments s;
    memset(&s, 0, sizeof s);
    integrate_triangles(at, p, &s);
    *out = s;
}

/* What the polygons in the lanes give, in columns of lanes: the vectors' components, then the others. */
enum {
    FORCE = 0,
    MOMENT = 3,
    SWEPT = 6,
    SWEPT_MOMENT = 9,
    PRESSED = 12,
    FIRST = 15,
    PRESSURE = 18,
    EXTENT,
    SECOND,
    STIFFNESS,
    BY_FORCE,
    BY_SWEPT,
    ENERGY,
    VOLUME,
    GIVEN = (VOLUME + 4) / 4 * 4 /* with what fills up four: sum_lanes */
};

/* Adds it to what others have given. */
TL_VECTORIZED static void add_given(const polygons *restrict p, double (*restrict out)[LANES])
{
    const integrals *restrict s = &p->of;
#pragma omp simd
    for (uint32_t l = 0; l < LANES; l++) {
        double nx = p->n[0][l], ny = p->n[1][l], nz = p->n[2][l], length = p->length[l];
        bool any = s->area[l] > 0;
        double on = any ? p->gradient[l] : 0.0, area = on * s->area[l], d = on * s->d[l];
        double x = on * s->x[0][l], y = on * s->x[1][l], z = on * s->x[2][l];
        double px = on * s->dx[0][l], py = on * s->dx[1][l], pz = on * s->dx[2][l];
        double half = any ? 0.5 * p->cells[l] * length : 0.0;
        out[FORCE][l] += d * nx;
        out[FORCE + 1][l] += d * ny;
        out[FORCE + 2][l] += d * nz;
        out[MOMENT][l] += py * nz - pz * ny;
        out[MOMENT + 1][l] += pz * nx - px * nz;
        out[MOMENT + 2][l] += px * ny - py * nx;
        out[SWEPT][l] += area * nx;
        out[SWEPT + 1][l] += area * ny;
        out[SWEPT + 2][l] += area * nz;
        out[SWEPT_MOMENT][l] += y * nz - z * ny;
        out[SWEPT_MOMENT + 1][l] += z * nx - x * nz;
        out[SWEPT_MOMENT + 2][l] += x * ny - y * nx;
        out[PRESSED][l] += px;
        out[PRESSED + 1][l] += py;
        out[PRESSED + 2][l] += pz;
        out[FIRST][l] += x;
        out[FIRST + 1][l] += y;
        out[FIRST + 2][l] += z;
        out[PRESSURE][l] += d;
        out[EXTENT][l] += area;
        out[SECOND][l] += on * s->xx[l];
        double wide = length > TL_FIELD_SAME_WAY ? length : TL_FIELD_SAME_WAY;
        out[STIFFNESS][l] += 2 / wide * area;
        out[BY_FORCE][l] += px * nx + py * ny + pz * nz;
        out[BY_SWEPT][l] += x * nx + y * ny + z * nz;
        out[ENERGY][l] += 0.5 * half * s->dd[l];
        out[VOLUME][l] += half * s->d[l];
    }
}

/* The same of a power of d, in columns of lanes. */
enum { POWER_FORCE = 0, POWER_MOMENT = 3, BY_POWER = 6, POWER, POWER_GIVEN };

TL_VECTORIZED static void add_power(const polygons *restrict p, const double *restrict over,
                                    const double *restrict next, const double (*restrict moment)[LANES], double per,
                                    double (*restrict out)[LANES])
{
#pragma omp simd
    for (uint32_t l = 0; l < LANES; l++) {
        double nx = p->n[0][l], ny = p->n[1][l], nz = p->n[2][l];
        bool any = p->of.area[l] > 0;
        double on = any ? p->gradient[l] : 0.0, d = on * over[l];
        double x = on * moment[0][l], y = on * moment[1][l], z = on * moment[2][l];
        out[POWER_FORCE][l] += d * nx;
        out[POWER_FORCE + 1][l] += d * ny;
        out[POWER_FORCE + 2][l] += d * nz;
        out[POWER_MOMENT][l] += y * nz - z * ny;
        out[POWER_MOMENT + 1][l] += z * nx - x * nz;
        out[POWER_MOMENT + 2][l] += x * ny - y * nx;
        out[BY_POWER][l] += x * nx + y * ny + z * nz;
        out[POWER][l] += any ? per * p->cells[l] * p->length[l] * next[l] : 0.0;
    }
}

static void add_powers(const corners *at, const polygons *p, double given[TL_FIELD_POWERS][POWER_GIVEN][LANES])
{
    power_integrals all;
    const power_integrals *s = &all;
    integrate_powers(at, p, &all);
    add_power(p, p->of.dd, s->cube, s->x[0], 1.0 / 6, given[0]);
    add_power(p, s->cube, s->fourth, s->x[1], 1.0 / 8, given[1]);
}

/* Slopes of force and moment, rows, by ways and turns, columns. */
enum { SLOPES = 36 };

/* Adds those of the polygons in the lanes. `a`, `b`: normals of the faces of A and of B. */
TL_VECTORIZED static void add_slopes(const polygons *restrict p, const second_moments *restrict second,
                                     double (*restrict a)[LANES], double (*restrict b)[LANES],
                                     double (*restrict out)[LANES])
{
    const double(*restrict q)[LANES] = second->of;
#pragma omp simd
    for (uint32_t l = 0; l < LANES; l++) {
        bool any = p->of.area[l] > 0;
        double per = any ? p->gradient[l] / p->length[l] : 0.0, area = per * p->of.area[l];
        double x = per * p->of.x[0][l], y = per * p->of.x[1][l], z = per * p->of.x[2][l];
        double xx = per * q[0][l], yy = per * q[1][l], zz = per * q[2][l];
        double xy = per * q[3][l], yz = per * q[4][l], zx = per * q[5][l];
        double na[3] = {a[0][l], a[1][l], a[2][l]}, nb[3] = {b[0][l], b[1][l], b[2][l]};
        /* int x cross n of both faces */
        double ma[3] = {y * na[2] - z * na[1], z * na[0] - x * na[2], x * na[1] - y * na[0]};
        double mb[3] = {y * nb[2] - z * nb[1], z * nb[0] - x * nb[2], x * nb[1] - y * nb[0]};
        /* int x_i (x cross n_b), i the first index */
        double m[3][3] = {{xy * nb[2] - zx * nb[1], zx * nb[0] - xx * nb[2], xx * nb[1] - xy * nb[0]},
                          {yy * nb[2] - yz * nb[1], yz * nb[0] - xy * nb[2], xy * nb[1] - yy * nb[0]},
                          {yz * nb[2] - zz * nb[1], zz * nb[0] - zx * nb[2], zx * nb[1] - yz * nb[0]}};
        for (int k = 0; k < 3; k++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            for (int to = 0; to < 3; to++) {
                out[6 * k + to][l] += area * na[k] * nb[to];
                out[6 * k + 3 + to][l] += na[k] * mb[to];
                out[18 + 6 * k + to][l] += ma[k] * nb[to];
                out[18 + 6 * k + 3 + to][l] += m[i][to] * na[j] - m[j][to] * na[i];
            }
        }
    }
}

TL_VECTORIZED static void clear_lanes(uint32_t count, double (*restrict given)[LANES])
{
    for (uint32_t k = 0; k < count; k++)
        for (uint32_t l = 0; l < LANES; l++)
            given[k][l] = 0;
}

/* Sums of all lanes of some columns, as many as fours have. */
TL_VECTORIZED static void sum_lanes(int count, double (*restrict given)[LANES], double *restrict sum)
{
    for (int k = 0; k < count; k += 4) {
        double x[4], y[4], z[4], w[4];
        const double *const column[] = {given[k], given[k + 1], given[k + 2], given[k + 3]};
        tl_lanes_turn(column, x, y, z, w);
#pragma omp simd
        for (uint32_t i = 0; i < 4; i++)
            sum[k + (int)i] = (x[i] + y[i]) + (z[i] + w[i]);
    }
}

/* Loops and sides of the polygons from number `first` on, before `end`; how many they are. Those left over are the
 * last again. */
static uint32_t begin_loops(const tl_field_mesh *mesh, uint32_t first, uint32_t end, const uint8_t **loop, polygons *p)
{
    const uint32_t count = end - first < LANES ? end - first : LANES;
    const uint8_t *next = *loop;
    p->most = 0;
    for (uint32_t l = 0; l < count; l++) {
        const uint32_t k = first + l;
        p->loop[l] = next;
        p->sides[l] = mesh->sides[k];
        p->most = p->sides[l] > p->most ? p->sides[l] : p->most;
        next += p->sides[l];
        p->own[l][0] = mesh->own[k][0];
        p->own[l][1] = mesh->own[k][1];
        p->on[l] = 1;
    }
    *loop = next;
    for (uint32_t l = count; l < LANES; l++) {
        p->loop[l] = p->loop[count - 1];
        p->sides[l] = p->sides[count - 1];
        p->own[l][0] = p->own[count - 1][0];
        p->own[l][1] = p->own[count - 1][1];
        p->on[l] = 0;
    }
    return count;
}

/* The normals of one of the two planes of each polygon in the lanes. */
TL_INLINE void take_normals(const plane_rows *restrict rows, const polygons *restrict p, int which,
                            double (*restrict n)[LANES])
{
    double offset[LANES];
    const double *const row[] = {rows->of[p->own[0][which]], rows->of[p->own[1][which]], rows->of[p->own[2][which]],
                                 rows->of[p->own[3][which]]};
    tl_lanes_turn(row, n[0], n[1], n[2], offset);
}

/* n_i - n_j of the polygons in the lanes, and both. */
TL_VECTORIZED static void put_normals(const plane_rows *restrict rows, polygons *restrict p)
{
    take_normals(rows, p, 0, p->face[0]);
    take_normals(rows, p, 1, p->face[1]);
    for (int axis = 0; axis < 3; axis++)
#pragma omp simd
        for (uint32_t l = 0; l < LANES; l++)
            p->n[axis][l] = p->face[0][axis][l] - p->face[1][axis][l];
}

/* The same with the planes of polygons between cells. */
static uint32_t begin_polygons(const tl_field_faces *f, const plane_rows *rows, const tl_apex apex[2], uint32_t first,
                               uint32_t end, const uint8_t **loop, polygons *p)
{
    const double cell[] = {apex[0].known ? 0.0 : 1.0, apex[1].known ? 0.0 : 1.0};
    const uint32_t count = begin_loops(f->mesh, first, end, loop, p);
    for (uint32_t l = 0; l < LANES; l++) {
        const bool i_of_b = p->own[l][0] >= f->a, j_of_b = p->own[l][1] >= f->a;
        p->cells[l] = p->on[l] * (cell[i_of_b] + cell[j_of_b]);
        p->gradient[l] = i_of_b == j_of_b ? 0.0 : p->on[l]; /* the first plane has the lower number */
    }
    put_normals(rows, p);
    return count;
}

/* The same of polygons at borders, and what they have instead of the length of n_i - n_j. With what sign they pass on
 * through a seam what presses, if they do (add_border of field.c). */
static void begin_borders(const tl_field_faces *f, uint32_t first, const uint8_t **loop, polygons *p,
                          double slope[LANES], double through[LANES])
{
    const tl_field_mesh *mesh = f->mesh;
    const uint32_t faces = f->a + f->b, of_b = faces + f->border_a;
    const uint32_t count = begin_loops(mesh, first, mesh->polygons, loop, p);
    for (uint32_t l = 0; l < LANES; l++) {
        uint32_t k = first + (l < count ? l : count - 1);
        uint32_t face = mesh->own[k][0], border = mesh->own[k][1];
        bool last = border >= of_b, crosses = (face >= f->a) != last;
        uint32_t end = last ? of_b + f->border_b : of_b, seams = last ? f->seam_b : f->seam_a;
        double on = l < count ? 1.0 : 0.0, out = last ? -on : on;
        tl_vec3 n = tl_field_normal(f, border);
        p->n[0][l] = n.x;
        p->n[1][l] = n.y;
        p->n[2][l] = n.z;
        p->cells[l] = 2 * on; /* all of the flux is of one cell */
        p->gradient[l] = crosses ? out : 0.0;
        slope[l] = -tl_v3_dot(n, tl_field_normal(f, face));
        through[l] = border + seams >= end ? -out : 0.0;
    }
}

static bool is_stray(const tl_apex *apex, uint32_t face)
{
    bool found = false;
    for (uint32_t k = 0; k < apex->strays; k++)
        found |= apex->stray[k] == face;
    return found;
}

/* Adds the sides of cells that pass by an apex. */
static void add_strays(const tl_field_faces *f, const polygons *p, uint32_t first, uint32_t count, tl_apex apex[2])
{
    for (uint32_t l = 0; l < count; l++) {
        uint32_t i = f->mesh->own[first + l][0], j = f->mesh->own[first + l][1];
        if (!(p->of.area[l] > 0) || !(is_stray(&apex[i >= f->a], i) || is_stray(&apex[j >= f->a], j)))
            continue;
        tl_vec3 n = {p->n[0][l], p->n[1][l], p->n[2][l]};
        tl_apex_add_side(&apex[i >= f->a], f, i, n, p->of.d[l]);
        tl_apex_add_side(&apex[j >= f->a], f, j, n, -p->of.d[l]);
    }
}

/* Integrates over polygons with their slopes. */
static void integrate_slopes(const corners *at, polygons *p, double slopes[SLOPES][LANES])
{
    second_moments second;
    integrate_second_moments(at, p, &second);
    add_slopes(p, &second, p->face[0], p->face[1], slopes);
}

static void put_slopes(double slopes[SLOPES][LANES], tl_field_slope *out)
{
    double sum[SLOPES];
    sum_lanes(SLOPES, slopes, sum);
    for (int by = 0; by < 6; by++) {
        out->force[by] = (tl_vec3){sum[by], sum[6 + by], sum[12 + by]};
        out->moment[by] = (tl_vec3){sum[18 + by], sum[24 + by], sum[30 + by]};
    }
    out->known = true;
}

/* Whether a corner lies on S: faces of both blocks meet there. The four planes are in ascending order. */
static bool is_on_surface(const tl_field_faces *f, uint32_t corner)
{
    const tl_field_mesh *mesh = f->mesh;
    bool of_b = false;
    for (int i = 1; i < 4; i++)
        of_b = of_b || mesh->plane[i][corner] - f->a < f->b; /* false where the number is less */
    return of_b && mesh->plane[0][corner] < f->a;
}

/* The deepest corner of S. */
static void find_deepest(const tl_field_faces *f, const corners *at, tl_field_sums *sums)
{
    uint32_t deepest = TL_MESH_CORNERS;
    for (uint32_t k = 0; k < f->mesh->corners; k++)
        if (at->at[k][3] > sums->deepest && is_on_surface(f, k)) {
            sums->deepest = at->at[k][3];
            deepest = k;
        }
    if (deepest < TL_MESH_CORNERS)
        sums->deepest_at = tl_v3(at->at[deepest][0], at->at[deepest][1], at->at[deepest][2]);
}

static tl_vec3 vector_of(const double sum[GIVEN], int column)
{
    return (tl_vec3){sum[column], sum[column + 1], sum[column + 2]};
}

/* Adds the polygons at borders, from number `first` on. */
static void add_borders(const tl_field_faces *f, const corners *at, uint32_t first, const uint8_t *loop,
                        double powers[TL_FIELD_POWERS][POWER_GIVEN][LANES], tl_field_sums *sums)
{
    polygons p;
    double slope[LANES], through[LANES], sum[GIVEN];
    double given[GIVEN][LANES] = {{0}}, passed[GIVEN][LANES] = {{0}};
    for (; first < f->mesh->polygons; first += LANES) {
        begin_borders(f, first, &loop, &p, slope, through);
        integrate_polygons(at, &p);
        memcpy(p.length, slope, sizeof slope);
        add_given(&p, given);
        for (uint32_t l = 0; l < LANES; l++)
            p.gradient[l] += through[l];
        if (f->powers)
            add_powers(at, &p, powers);
        memcpy(p.gradient, through, sizeof through);
        add_given(&p, passed);
    }
    sum_lanes(GIVEN, given, sum);
    sums->energy += sum[ENERGY];
    sums->volume += sum[VOLUME];
    sums->force = tl_v3_add(sums->force, vector_of(sum, FORCE));
    sums->moment = tl_v3_add(sums->moment, vector_of(sum, MOMENT));
    sums->swept = tl_v3_add(sums->swept, vector_of(sum, SWEPT));
    sums->swept_moment = tl_v3_add(sums->swept_moment, vector_of(sum, SWEPT_MOMENT));
    sum_lanes(GIVEN, passed, sum);
    sums->through = vector_of(sum, FORCE);
    sums->through_moment = vector_of(sum, MOMENT);
}

/* How many polygons lie between cells; the others are at borders. */
static uint32_t between_cells(const tl_field_faces *f)
{
    uint32_t count = f->mesh->polygons;
    while (f->seamed && count > 0 && f->mesh->own[count - 1][1] >= f->a + f->b)
        count--;
    return count;
}

bool tl_mesh_integrate(const tl_field_faces *f, tl_field_sums *sums)
{
    const tl_field_mesh *mesh = f->mesh;
    plane_rows rows;
    corners at;
    polygons p;
    double given[GIVEN][LANES], sum[GIVEN], by_power[TL_FIELD_POWERS];
    double powers[TL_FIELD_POWERS][POWER_GIVEN][LANES], slopes[SLOPES][LANES];
    tl_field_slope *slope = f->seamed ? NULL : f->slope;
    if (!mesh || mesh->polygons == 0)
        return false;
    bool strays = mesh->apex[0].strays || mesh->apex[1].strays;
    if ((strays && !f->energy_only) || !mesh_holds(f, &rows, &at)) /* their cells tell no volume */
        return false;
    const uint8_t *loop = mesh->loop;
    tl_apex apex[] = {tl_apex_find(f, &mesh->apex[0]), tl_apex_find(f, &mesh->apex[1])};
    clear_lanes(GIVEN, given);
    if (f->powers)
        clear_lanes(TL_FIELD_POWERS * POWER_GIVEN, powers[0]);
    if (slope)
        clear_lanes(SLOPES, slopes);
    const uint32_t between = between_cells(f);
    for (uint32_t first = 0; first < between; first += LANES) {
        uint32_t count = begin_polygons(f, &rows, apex, first, between, &loop, &p);
        if (slope)
            integrate_slopes(&at, &p, slopes);
        else
            integrate_polygons(&at, &p);
        add_given(&p, given);
        if (f->powers)
            add_powers(&at, &p, powers);
        if (strays)
            add_strays(f, &p, first, count, apex);
    }
    sum_lanes(GIVEN, given, sum);
    *sums = (tl_field_sums){.energy = sum[ENERGY],
                            .volume = sum[VOLUME],
                            .force = vector_of(sum, FORCE),
                            .moment = vector_of(sum, MOMENT),
                            .swept = vector_of(sum, SWEPT),
                            .swept_moment = vector_of(sum, SWEPT_MOMENT),
                            .pressure = sum[PRESSURE],
                            .pressed = vector_of(sum, PRESSED),
                            .extent = sum[EXTENT],
                            .first = vector_of(sum, FIRST),
                            .second = sum[SECOND],
                            .stiffness = sum[STIFFNESS]};
    sums->area = sums->swept;
    find_deepest(f, &at, sums);
    if (slope)
        put_slopes(slopes, slope);
    if (between < mesh->polygons)
        add_borders(f, &at, between, loop, powers, sums);
    for (int k = 0; k < TL_FIELD_POWERS && f->powers; k++) {
        double all[POWER_GIVEN];
        sum_lanes(POWER_GIVEN, powers[k], all);
        sums->powers[k] = (tl_field_power){
            .whole = all[POWER], .force = {all[0], all[1], all[2]}, .moment = {all[3], all[4], all[5]}};
        by_power[k] = all[BY_POWER];
    }
    tl_apex_add_shares(apex, f, sum[BY_FORCE], sum[BY_SWEPT], by_power, sums);
    return true;
}
