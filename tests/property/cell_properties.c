/* cell_properties.c - the cells of a patch: wholly closed they have the force, the moment and the energy of their points, whatever the lifts of
 * these; partly open, force and moments are the gradient of the energy. */
#include "check.h"

#include "contact/cells.h"
#include "contact/lean.h"
#include "narrow/frame2.h"

#include <math.h>
#include <string.h>

static uint64_t seed = 20261127;

static double between(double low, double high)
{
    return low + (high - low) * check_random(&seed);
}

enum { MOST_CORNERS = 16, MOST_POINTS = 2 * MOST_CORNERS + 1 };

/* A patch in the plane z = 0, about its centroid, with all that cells are found from. */
typedef struct scene {
    _Alignas(64) double area[MOST_POINTS * TL_LANES];
    double arm[3][MOST_POINTS], normal[3][MOST_POINTS], lift[MOST_POINTS];
    tl_cell cell[MOST_POINTS];
    tl_points_table points;
    tl_point_lanes lanes;
    tl_cell_patch patch;
    double size;
} scene;

/* The closure o + x s_x + y s_y. */
typedef struct overlap {
    double o, x, y;
} overlap;

static size_t count_of(const scene *s)
{
    return 2 * s->patch.corners + 1;
}

static void put_point(scene *s, size_t k, tl_vec3 at, double area)
{
    for (int axis = 0; axis < 3; axis++)
        s->arm[axis][k] = (&at.x)[axis];
    s->area[k * TL_LANES] = area;
}

/* Corners on an ellipse, moved so that their centroid is at 0. */
static void draw_corners(tl_vec3 *corner, size_t n)
{
    const double flat = between(0.1, 1), turn = between(0, 6.3);
    double twice = 0;
    tl_vec3 centre = {0, 0, 0};
    for (size_t k = 0; k < n; k++) {
        double angle = 6.283185307179586 * ((double)k + between(0, 0.7)) / (double)n, x = cos(angle);
        double y = flat * sin(angle);
        corner[k] = tl_v3(x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn), 0);
    }
    for (size_t k = 0; k < n; k++) {
        tl_vec3 a = corner[k], b = corner[(k + 1) % n];
        double cross = a.x * b.y - a.y * b.x;
        twice += cross;
        centre = tl_v3_madd(centre, cross / 3, tl_v3_add(a, b));
    }
    for (size_t k = 0; k < n; k++)
        corner[k] = tl_v3_madd(corner[k], -1 / twice, centre);
}

/* The points of patch.c: 16/75, 36/75 and 7/75 of the triangles of the centroid and the edges. */
static void lay(scene *s, size_t n)
{
    tl_vec3 corner[MOST_CORNERS];
    double all = 0, triangle[MOST_CORNERS];
    draw_corners(corner, n);
    for (size_t k = 0; k < n; k++) {
        tl_vec3 a = corner[k], b = corner[(k + 1) % n];
        triangle[k] = 0.5 * (a.x * b.y - a.y * b.x);
        all += triangle[k];
    }
    for (size_t k = 0; k < n; k++) {
        tl_vec3 middle = tl_v3_scale(0.5, tl_v3_add(corner[k], corner[(k + 1) % n]));
        put_point(s, k, tl_v3_scale(5. / 6, middle), 36. / 75 * triangle[k]);
        put_point(s, n + k, tl_v3_scale(5. / 8, corner[k]), 16. / 75 * (triangle[k] + triangle[(k + n - 1) % n]));
    }
    put_point(s, 2 * n, tl_v3(0, 0, 0), 7. / 75 * all);
    s->size = sqrt(all);
    s->points = (tl_points_table){.area = s->area};
    s->lanes = (tl_point_lanes){.lift = s->lift, .cell = s->cell};
    for (int axis = 0; axis < 3; axis++) {
        s->lanes.arm[axis] = s->arm[axis];
        s->lanes.normal[axis] = s->normal[axis];
        for (size_t k = 0; k <= 2 * n; k++)
            s->normal[axis][k] = axis == 2;
    }
    s->patch = (tl_cell_patch){.p = &s->points, .lanes = &s->lanes, .stride = 1, .corners = n};
}

static double closure_at(const overlap *u, const scene *s, size_t k)
{
    return u->o + u->x * s->arm[0][k] + u->y * s->arm[1][k];
}

/* int u, int u x, int u y and half of int u^2 over what presses. */
typedef struct sums {
    double volume, x, y, energy;
} sums;

static sums sums_of(scene *s, const overlap *u)
{
    sums out = {0, 0, 0, 0};
    for (size_t k = 0; k < count_of(s); k++) {
        s->cell[k].closure = closure_at(u, s, k);
        s->cell[k].lift = s->lift[k];
    }
    tl_cells_find(&s->patch, false);
    for (size_t k = 0; k < count_of(s); k++) {
        out.volume += s->cell[k].pressed_volume;
        out.x += s->cell[k].pressed.x;
        out.y += s->cell[k].pressed.y;
        out.energy += 0.5 * s->cell[k].pressed_second;
    }
    return out;
}

static sums sums_of_points(const scene *s, const overlap *u)
{
    sums out = {0, 0, 0, 0};
    for (size_t k = 0; k < count_of(s); k++) {
        double closure = closure_at(u, s, k) + s->lift[k], area = s->area[k * TL_LANES];
        out.volume += area * closure;
        out.x += area * closure * s->arm[0][k];
        out.y += area * closure * s->arm[1][k];
        out.energy += 0.5 * area * closure * closure;
    }
    return out;
}

static void draw_lifts(scene *s, double most)
{
    for (size_t k = 0; k < count_of(s); k++)
        s->lift[k] = between(0, most);
}

/* Wholly closed, over random lifts. */
static void try_closed(scene *s)
{
    const overlap u = {between(20, 30), between(-1, 1), between(-1, 1)};
    draw_lifts(s, 5);
    const sums cells = sums_of(s, &u), points = sums_of_points(s, &u);
    const double volume = points.volume, arm = volume * s->size;
    CHECK_NEAR(cells.volume, points.volume, 1e-13 * volume);
    CHECK_NEAR(cells.x, points.x, 1e-13 * arm);
    CHECK_NEAR(cells.y, points.y, 1e-13 * arm);
    CHECK_NEAR(cells.energy, points.energy, 1e-13 * points.energy);
}

/* Lifts that lie in a plane are an overlap more, open or closed. */
static void try_plane(scene *s)
{
    const overlap by = {between(-1, 1), between(-1, 1), between(-1, 1)};
    overlap u = {between(-0.5, 0.5), between(-1, 1), between(-1, 1)};
    for (size_t k = 0; k < count_of(s); k++)
        s->lift[k] = closure_at(&by, s, k);
    const sums lifted = sums_of(s, &u);
    memset(s->lift, 0, sizeof s->lift);
    u = (overlap){u.o + by.o, u.x + by.x, u.y + by.y};
    const sums plain = sums_of(s, &u);
    CHECK_NEAR(lifted.volume, plain.volume, 1e-12 * s->size * s->size);
    CHECK_NEAR(lifted.energy, plain.energy, 1e-12 * s->size * s->size);
}

/* Central differences of the energy, whatever is closed. */
static void try_gradient(scene *s)
{
    const double h = 1e-5;
    overlap u = {between(-1.5, 0.5), between(-1, 1), between(-1, 1)};
    draw_lifts(s, 1);
    const sums here = sums_of(s, &u);
    const double have[3] = {here.volume, here.x, here.y};
    for (int k = 0; k < 3; k++) {
        double *of = k == 0 ? &u.o : k == 1 ? &u.x : &u.y, was = *of;
        *of = was + h;
        double after = sums_of(s, &u).energy;
        *of = was - h;
        double before = sums_of(s, &u).energy;
        *of = was;
        CHECK_NEAR((after - before) / (2 * h), have[k], 1e-8 * s->size * s->size);
    }
}

TEST(cells)
{
    static scene s;
    for (int k = 0; k < check_cases(3000); k++) {
        lay(&s, 3 + (size_t)k % (MOST_CORNERS - 2));
        try_closed(&s);
        try_plane(&s);
        try_gradient(&s);
    }
}

TEST_MAIN(RUN(cells))
