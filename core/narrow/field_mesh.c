/* field_mesh.c - the polygons of a pressure field from place to place.
 *
 * While two blocks move on, their field mostly keeps its polygons: a corner is where the same planes are nearest, and only its
 * place changes. So the planes of all corners are kept, the mesh. At a new place every corner is found from its planes, three
 * equations, and the mesh stands if no plane is nearer to any corner than its own are, and none is passed:
 *
 *     c_h - n_h . x >= d    for all faces h.
 *
 * There are no borders. Then it is all of the field. A polygon is convex, and its sides lie between corners that belong to it, so it is whole, and
 * so is the part of S that it hangs together with. From a point where A is the nearer, the way out through its nearest face
 * stays where A is the nearer, for d_B grows no faster than d_A falls: so each part of S ends on the surface of K, where faces of
 * both blocks meet, and there all corners are known: K has no others than these and those of one block that lie in the
 * other, which are kept, too.
 *
 * Polygons are summed by triangles from their first corner. */
#include "narrow/field_mesh.h"

#include "base/inline.h"
#include "narrow/apex.h"
#include "narrow/field_lanes.h"

#include <math.h>
#include <string.h>
#include <talus/vmath.h>

#define LANES TL_LANES

/* Determinant of a corner's three equations, with normals of length 1 and their differences, below which its place is lost in
 * roundings. */
#define SHARP 1e-5

/* Roundings of the largest offset by which a corner may seem to lie outside. */
#define SLACK (4 * TL_FIELD_ONE_PLANE)

/* Most by which that grows where planes meet at small angles: corners of one block need it, where more than three do. */
#define MOST_BLURRED 1e3

/* ---------------------------------------------------------------- corners ---------------- */

/* Places of the corners of a mesh, and the depths there. */
typedef struct corners {
    double x[3][TL_MESH_CORNERS], d[TL_MESH_CORNERS];
} corners;

/* Places and depths of eight corners, and how much larger roundings of offsets are there; NaN where planes hardly meet. */
TL_VECTORIZED static void place_corners(const tl_field_faces *restrict f,
                                        const uint8_t *restrict plane, double *restrict x,
                                        double *restrict y, double *restrict z, double *restrict d,
                                        double *restrict blur)
{
    const double *restrict nx = f->n[0], *restrict ny = f->n[1], *restrict nz = f->n[2];
    const double *restrict c = f->c;
    double n[4][3][LANES], o[4][LANES];
    for (uint32_t k = 0; k < 4; k++)
        for (uint32_t l = 0; l < LANES; l++) {
            uint32_t i = plane[k * TL_MESH_CORNERS + l];
            n[k][0][l] = nx[i];
            n[k][1][l] = ny[i];
            n[k][2][l] = nz[i];
            o[k][l] = c[i];
        }
#pragma omp simd
    for (uint32_t l = 0; l < LANES; l++) {
        double ax = n[1][0][l] - n[0][0][l], ay = n[1][1][l] - n[0][1][l];
        double az = n[1][2][l] - n[0][2][l], ao = o[1][l] - o[0][l];
        double bx = n[2][0][l] - n[0][0][l], by = n[2][1][l] - n[0][1][l];
        double bz = n[2][2][l] - n[0][2][l], bo = o[2][l] - o[0][l];
        double cx = n[3][0][l] - n[0][0][l], cy = n[3][1][l] - n[0][1][l];
        double cz = n[3][2][l] - n[0][2][l], co = o[3][l] - o[0][l];
        double ux = by * cz - bz * cy, uy = bz * cx - bx * cz, uz = bx * cy - by * cx;
        double vx = cy * az - cz * ay, vy = cz * ax - cx * az, vz = cx * ay - cy * ax;
        double wx = ay * bz - az * by, wy = az * bx - ax * bz, wz = ax * by - ay * bx;
        double det = ax * ux + ay * uy + az * uz;
        double per = fabs(det) > SHARP ? 1 / det : NAN, far = 1 + fabs(per);
        blur[l] = far < MOST_BLURRED ? far : MOST_BLURRED;
        x[l] = (ao * ux + bo * vx + co * wx) * per;
        y[l] = (ao * uy + bo * vy + co * wy) * per;
        z[l] = (ao * uz + bo * vz + co * wz) * per;
        d[l] = o[0][l] - (n[0][0][l] * x[l] + n[0][1][l] * y[l] + n[0][2][l] * z[l]);
    }
}

/* Whether no plane is nearer to any of eight corners than its own, by more than a slack that grows with the roundings. */
TL_VECTORIZED static bool corners_hold(const tl_field_faces *restrict f, uint32_t planes,
                                       const double *restrict x, const double *restrict y,
                                       const double *restrict z, const double *restrict d,
                                       const double *restrict blur, double slack)
{
    double least[LANES];
    for (uint32_t l = 0; l < LANES; l++)
        least[l] = INFINITY;
    for (uint32_t k = 0; k < planes; k++) {
        const double nx = f->n[0][k], ny = f->n[1][k], nz = f->n[2][k], c = f->c[k];
#pragma omp simd
        for (uint32_t l = 0; l < LANES; l++) {
            double over = c - (nx * x[l] + ny * y[l] + nz * z[l]);
            least[l] = least[l] < over ? least[l] : over;
        }
    }
    bool all = true;
    for (uint32_t l = 0; l < LANES; l++)
        all &= least[l] - d[l] >= -slack * blur[l];
    return all;
}

/* Whether the mesh stands; then its corners are in `at`. */
static bool mesh_holds(const tl_field_faces *f, corners *at)
{
    const tl_field_mesh *mesh = f->mesh;
    const uint32_t planes = f->a + f->b;
    double blur[LANES], largest = 0;
    for (int axis = 0; axis < 3; axis++)
        f->n[axis][TL_MESH_ZERO] = 0;
    f->c[TL_MESH_ZERO] = 0;
    for (uint32_t k = 0; k < planes; k++)
        largest = fmax(largest, fabs(f->c[k]));
    for (uint32_t i = 0; i < mesh->corners; i += LANES) {
        double *x = at->x[0] + i, *y = at->x[1] + i, *z = at->x[2] + i, *d = at->d + i;
        place_corners(f, mesh->plane[0] + i, x, y, z, d, blur);
        if (!corners_hold(f, planes, x, y, z, d, blur, SLACK * largest))
            return false;
    }
    return true;
}

/* ---------------------------------------------------------------- polygons --------------- */

/* A corner of each of eight polygons. */
typedef struct polygon_corner {
    double x[3][LANES], d[LANES];
} polygon_corner;

/* Integrals over polygons: of 1, d, d^2, x, d x, x . x. */
typedef struct integrals {
    double area[LANES], d[LANES], dd[LANES], x[3][LANES], dx[3][LANES], xx[LANES];
} integrals;

/* Eight polygons. */
typedef struct polygons {
    const uint8_t *loop[LANES];
    uint32_t sides[LANES], most;
    double n[3][LANES], length[LANES]; /* n_i - n_j, then divided by its length, and that */
    double surface[LANES];             /* 1: of S, 0: between cells of one block */
    double cells[LANES]; /* how many of the cells beside it have their energy from their sides */
    integrals of;
} polygons;

/* The k-th corners of eight polygons; of one that has fewer, its last. */
TL_INLINE void take_corner(const corners *at, const polygons *p, uint32_t k, polygon_corner *out)
{
    for (uint32_t l = 0; l < LANES; l++) {
        uint32_t corner = p->loop[l][k < p->sides[l] ? k : p->sides[l] - 1];
        out->x[0][l] = at->x[0][corner];
        out->x[1][l] = at->x[1][corner];
        out->x[2][l] = at->x[2][corner];
        out->d[l] = at->d[corner];
    }
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
        double twice = p->n[0][l] * (ay * bz - az * by) + p->n[1][l] * (az * bx - ax * bz) +
                       p->n[2][l] * (ax * by - ay * bx);
        double third = twice * (1.0 / 6), twelfth = twice * (1.0 / 24);
        double x = ux + vx + wx, y = uy + vy + wy, z = uz + vz + wz, d = ud + vd + wd;
        double squares =
            ux * ux + uy * uy + uz * uz + vx * vx + vy * vy + vz * vz + wx * wx + wy * wy + wz * wz;
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

/* Integrates over eight polygons by triangles from their first corners. */
TL_VECTORIZED static void integrate_polygons(const corners *restrict at, polygons *restrict p)
{
    polygon_corner u, v, w;
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
    take_corner(at, p, 1, &v);
    for (uint32_t k = 2; k < p->most; k++) {
        take_corner(at, p, k, &w);
        add_triangle(p, &u, &v, &w, &s);
        v = w;
    }
    p->of = s;
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
    GIVEN
};

/* Adds it to what others have given. */
TL_VECTORIZED static void add_given(const polygons *restrict p, double (*restrict out)[LANES])
{
    const integrals *restrict s = &p->of;
#pragma omp simd
    for (uint32_t l = 0; l < LANES; l++) {
        double nx = p->n[0][l], ny = p->n[1][l], nz = p->n[2][l], length = p->length[l];
        bool any = s->area[l] > 0, on = any & (p->surface[l] > 0);
        double area = on ? s->area[l] : 0.0, d = on ? s->d[l] : 0.0;
        double x = on ? s->x[0][l] : 0.0, y = on ? s->x[1][l] : 0.0, z = on ? s->x[2][l] : 0.0;
        double px = on ? s->dx[0][l] : 0.0, py = on ? s->dx[1][l] : 0.0;
        double pz = on ? s->dx[2][l] : 0.0, half = any ? 0.5 * p->cells[l] * length : 0.0;
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
        out[SECOND][l] += on ? s->xx[l] : 0.0;
        double wide = length > TL_FIELD_SAME_WAY ? length : TL_FIELD_SAME_WAY;
        out[STIFFNESS][l] += 2 / wide * area;
        out[BY_FORCE][l] += px * nx + py * ny + pz * nz;
        out[BY_SWEPT][l] += x * nx + y * ny + z * nz;
        out[ENERGY][l] += 0.5 * half * s->dd[l];
        out[VOLUME][l] += half * s->d[l];
    }
}

/* Sum of eight lanes. */
TL_VECTORIZED static void sum_lanes(double (*restrict given)[LANES], double *restrict sum)
{
    for (int k = 0; k < GIVEN; k++) {
        const double *v = given[k];
        sum[k] = ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
    }
}

/* Loops, planes and sides of the polygons from number `first` on; how many they are. Those left over are the last again. */
static uint32_t begin_polygons(const tl_field_faces *f, const tl_apex apex[2], uint32_t first,
                               const uint8_t **loop, polygons *p)
{
    const tl_field_mesh *mesh = f->mesh;
    uint32_t count = mesh->polygons - first;
    count = count < LANES ? count : LANES;
    p->most = 0;
    for (uint32_t l = 0; l < LANES; l++) {
        uint32_t k = first + (l < count ? l : count - 1);
        uint32_t i = mesh->own[k][0], j = mesh->own[k][1];
        tl_vec3 w = tl_v3_sub(tl_field_normal(f, i), tl_field_normal(f, j));
        p->sides[l] = mesh->sides[k];
        p->most = p->sides[l] > p->most ? p->sides[l] : p->most;
        p->loop[l] = *loop;
        *loop += l + 1 < count || l + 1 == LANES ? p->sides[l] : 0;
        p->n[0][l] = w.x;
        p->n[1][l] = w.y;
        p->n[2][l] = w.z;
        p->surface[l] = i < f->a && j >= f->a ? 1.0 : 0.0;
        double cells = (apex[i >= f->a].known ? 0 : 1) + (apex[j >= f->a].known ? 0 : 1);
        p->cells[l] = l < count ? cells : 0.0;
        p->surface[l] *= l < count ? 1.0 : 0.0;
    }
    return count;
}

/* Adds the sides of cells that pass by an apex. */
static void add_strays(const tl_field_faces *f, const polygons *p, uint32_t first, uint32_t count,
                       tl_apex apex[2])
{
    for (uint32_t l = 0; l < count; l++) {
        uint32_t i = f->mesh->own[first + l][0], j = f->mesh->own[first + l][1];
        tl_vec3 n = {p->n[0][l], p->n[1][l], p->n[2][l]};
        if (!(p->of.area[l] > 0))
            continue;
        tl_apex_add_side(&apex[i >= f->a], f, i, n, p->of.d[l]);
        tl_apex_add_side(&apex[j >= f->a], f, j, n, -p->of.d[l]);
    }
}

/* The deepest corner of S: faces of both blocks meet there. Of the four planes, in ascending order, d = 0 is the last. */
static void find_deepest(const tl_field_faces *f, const corners *at, tl_field_sums *sums)
{
    const tl_field_mesh *mesh = f->mesh;
    for (uint32_t k = 0; k < mesh->corners; k++) {
        uint32_t first = mesh->plane[0][k], third = mesh->plane[2][k], last = mesh->plane[3][k];
        bool both = first < f->a && (third >= f->a || (last >= f->a && last != TL_MESH_ZERO));
        if (!both || !(at->d[k] > sums->deepest))
            continue;
        sums->deepest = at->d[k];
        sums->deepest_at = tl_v3(at->x[0][k], at->x[1][k], at->x[2][k]);
    }
}

bool tl_mesh_integrate(const tl_field_faces *f, tl_field_sums *sums)
{
    const tl_field_mesh *mesh = f->mesh;
    corners at;
    polygons p;
    double given[GIVEN][LANES], sum[GIVEN];
    if (!mesh || mesh->polygons == 0)
        return false;
    bool strays = mesh->apex[0].strays || mesh->apex[1].strays;
    if ((strays && !f->energy_only) || !mesh_holds(f, &at)) /* their cells tell no volume */
        return false;
    const uint8_t *loop = mesh->loop;
    tl_apex apex[] = {tl_apex_find(f, &mesh->apex[0]), tl_apex_find(f, &mesh->apex[1])};
    memset(given, 0, sizeof given);
    for (uint32_t first = 0; first < mesh->polygons; first += LANES) {
        uint32_t count = begin_polygons(f, apex, first, &loop, &p);
        integrate_polygons(&at, &p);
        add_given(&p, given);
        if (strays)
            add_strays(f, &p, first, count, apex);
    }
    sum_lanes(given, sum);
    *sums = (tl_field_sums){
        .energy = sum[ENERGY],
        .volume = sum[VOLUME],
        .force = {sum[FORCE], sum[FORCE + 1], sum[FORCE + 2]},
        .moment = {sum[MOMENT], sum[MOMENT + 1], sum[MOMENT + 2]},
        .swept = {sum[SWEPT], sum[SWEPT + 1], sum[SWEPT + 2]},
        .swept_moment = {sum[SWEPT_MOMENT], sum[SWEPT_MOMENT + 1], sum[SWEPT_MOMENT + 2]},
        .pressure = sum[PRESSURE],
        .pressed = {sum[PRESSED], sum[PRESSED + 1], sum[PRESSED + 2]},
        .extent = sum[EXTENT],
        .first = {sum[FIRST], sum[FIRST + 1], sum[FIRST + 2]},
        .second = sum[SECOND],
        .stiffness = sum[STIFFNESS]};
    sums->area = sums->swept;
    find_deepest(f, &at, sums);
    tl_apex_add_shares(apex, f, sum[BY_FORCE], sum[BY_SWEPT], sums);
    return true;
}

/* ---------------------------------------------------------------- a new mesh ------------- */

/* Whether the normal of one line comes before that of another, counterclockwise. */
static bool before(const tl_field_line *line, unsigned lane, size_t i, size_t j)
{
    double it = line[i].gt[lane], is = line[i].gs[lane];
    double jt = line[j].gt[lane], js = line[j].gs[lane];
    bool low_i = is < 0 || (is == 0 && it < 0), low_j = js < 0 || (js == 0 && jt < 0);
    return low_i != low_j ? low_j : it * js - is * jt > 0;
}

void tl_mesh_draw(tl_mesh_draft *draft, const uint16_t own[2], const uint16_t *bound,
                  const tl_field_line *line, size_t lines, unsigned lane)
{
    uint8_t side[TL_MESH_SIDES];
    uint32_t sides = 0;
    draft->full = draft->full || draft->polygons == TL_MESH_POLYGONS;
    for (size_t k = 0; k < lines && !draft->full; k++) {
        if (!(line[k].to[lane] > line[k].from[lane]) || line[k].c[lane] >= TL_FIELD_FAR)
            continue;
        draft->full = draft->labels + sides == TL_MESH_SIDES;
        if (draft->full)
            break;
        uint32_t at = sides++;
        for (; at > 0 && before(line, lane, k, side[at - 1]); at--)
            side[at] = side[at - 1];
        side[at] = (uint8_t)k;
    }
    if (draft->full)
        return;
    uint32_t polygon = draft->polygons++;
    draft->own[polygon][0] = (uint8_t)own[0];
    draft->own[polygon][1] = (uint8_t)own[1];
    draft->sides[polygon] = (uint8_t)sides;
    for (uint32_t k = 0; k < sides; k++)
        draft->label[draft->labels++] = side[k] ? (uint8_t)bound[side[k] - 1] : TL_MESH_ZERO;
}

/* The number of a corner of four planes, which is added when there is none; TL_MESH_CORNERS: there is no room. */
static uint32_t corner_of(tl_field_mesh *mesh, const uint8_t own[2], uint8_t one, uint8_t other)
{
    uint8_t plane[4] = {own[0], own[1], one, other};
    for (int i = 1; i < 4; i++)
        for (int k = i; k > 0 && plane[k] < plane[k - 1]; k--) {
            uint8_t swap = plane[k];
            plane[k] = plane[k - 1];
            plane[k - 1] = swap;
        }
    for (uint32_t corner = 0; corner < mesh->corners; corner++) {
        bool same = true;
        for (int k = 0; k < 4; k++)
            same = same && mesh->plane[k][corner] == plane[k];
        if (same)
            return corner;
    }
    if (mesh->corners == TL_MESH_CORNERS)
        return TL_MESH_CORNERS;
    for (int k = 0; k < 4; k++)
        mesh->plane[k][mesh->corners] = plane[k];
    return mesh->corners++;
}

/* Whether a polygon is part of S. */
static bool on_surface(const tl_field_mesh *mesh, const tl_field_faces *f, uint32_t polygon)
{
    return mesh->own[polygon][0] < f->a && mesh->own[polygon][1] >= f->a &&
           mesh->own[polygon][1] < f->a + f->b;
}

/* Whether another polygon of S has a side between two corners, the other way round. */
static bool has_neighbour(const tl_field_mesh *mesh, const tl_field_faces *f, uint32_t polygon,
                          uint8_t from, uint8_t to)
{
    const uint8_t *loop = mesh->loop;
    for (uint32_t k = 0; k < mesh->polygons; loop += mesh->sides[k++])
        for (uint32_t i = 0; i < mesh->sides[k] && k != polygon && on_surface(mesh, f, k); i++)
            if (loop[i] == to && loop[i + 1 < mesh->sides[k] ? i + 1 : 0] == from)
                return true;
    return false;
}

/* Whether each side of S that is not on the surface of K, with d = 0, belongs to two polygons. The label of a side is that
 * between its corner and the one before. */
static bool hangs_together(const tl_field_mesh *mesh, const tl_mesh_draft *draft,
                           const tl_field_faces *f)
{
    const uint8_t *loop = mesh->loop, *label = draft->label;
    for (uint32_t k = 0; k < mesh->polygons; k++) {
        uint32_t sides = mesh->sides[k];
        for (uint32_t i = 0; i < sides && on_surface(mesh, f, k); i++)
            if (label[i] != TL_MESH_ZERO &&
                !has_neighbour(mesh, f, k, loop[i ? i - 1 : sides - 1], loop[i]))
                return false;
        loop += sides;
        label += sides;
    }
    return true;
}

void tl_mesh_make(const tl_mesh_draft *draft, const tl_field_faces *faces, tl_field_mesh *mesh)
{
    const uint8_t *label = draft->label;
    uint8_t *loop = mesh->loop;
    uint64_t bounding = mesh->bounding;
    memset(mesh, 0, sizeof *mesh);
    mesh->bounding = bounding;
    if (draft->full || draft->polygons == 0 || !faces->inner || faces->inner->count > TL_MESH_INNER)
        return;
    bool fits = true;
    for (uint32_t k = 0; k < draft->polygons && fits; k++) {
        uint32_t sides = draft->sides[k];
        memcpy(mesh->own[k], draft->own[k], sizeof mesh->own[k]);
        mesh->sides[k] = (uint8_t)sides;
        fits = sides > 2;
        for (uint32_t i = 0; i < sides && fits; i++) {
            uint32_t corner =
                corner_of(mesh, draft->own[k], label[i], label[i + 1 < sides ? i + 1 : 0]);
            fits = corner < TL_MESH_CORNERS;
            *loop++ = (uint8_t)corner;
        }
        label += sides;
    }
    for (uint32_t k = 0; k < faces->inner->count && fits; k++) {
        const uint8_t *face = faces->inner->face[k];
        fits = corner_of(mesh, face, face[2], TL_MESH_ZERO) < TL_MESH_CORNERS;
    }
    for (uint32_t i = mesh->corners; i % LANES; i++) /* what is left of eight is the first again */
        for (int k = 0; k < 4; k++)
            mesh->plane[k][i] = mesh->plane[k][0];
    mesh->polygons = draft->polygons;
    if (!fits || !hangs_together(mesh, draft, faces)) {
        memset(mesh, 0, sizeof *mesh);
        mesh->bounding = bounding;
    }
}
