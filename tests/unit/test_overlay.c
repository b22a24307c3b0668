/* test_overlay.c - what two faces have in common, and three points that integrate functions of the second degree over it. */
#include "check.h"
#include "narrow/overlay.h"

#include <math.h>
#include <stdint.h>

static uint64_t state = 88172645463325252u;

/* Between -1 and 1. */
static double draw(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) / 4503599627370496.0 - 1;
}

static tl_point2 memory[3][64];
static tl_overlay_room room_of(void)
{
    return (tl_overlay_room){memory[0], memory[1], memory[2], 64};
}

/* A frame in space. */
typedef struct frame {
    tl_vec3 origin, e, g, n;
} frame;

static frame draw_frame(void)
{
    frame f = {.origin = {draw() * 10, draw() * 10, draw() * 10}, .n = tl_v3_unit(tl_v3(draw(), draw(), draw() + 0.1))};
    f.e = tl_v3_perpendicular(f.n);
    f.g = tl_v3_cross(f.n, f.e);
    return f;
}

static tl_vec3 at(const frame *f, double x, double y, double z)
{
    return tl_v3_madd(tl_v3_madd(tl_v3_madd(f->origin, x, f->e), y, f->g), z, f->n);
}

/* A square of half width 3 that looks along n, and one that looks back at it from height z. */
static void square(const frame *f, double z, bool back, tl_vec3 out[4])
{
    static const double x[4] = {-3, 3, 3, -3}, y[4] = {-3, -3, 3, 3};
    for (int k = 0; k < 4; k++)
        out[k] = at(f, x[back ? 3 - k : k], y[back ? 3 - k : k], z);
}

/* A function of the second degree of the place in the plane, and its integral over a triangle. */
static double square_of(const double c[6], double x, double y)
{
    return c[0] + c[1] * x + c[2] * y + c[3] * x * x + c[4] * x * y + c[5] * y * y;
}

static double integral(const double c[6], const double x[3], const double y[3])
{
    const double area = 0.5 * ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]));
    double sum = 0; /* the middles of the sides integrate it exactly */
    for (int k = 0; k < 3; k++)
        sum += square_of(c, 0.5 * (x[k] + x[(k + 1) % 3]), 0.5 * (y[k] + y[(k + 1) % 3]));
    return area * sum / 3;
}

/* The integral by the points of an overlay, in the plane of `f`. */
static double by_points(const double c[6], const tl_overlay *o, const frame *f)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const tl_vec3 d = tl_v3_sub(o->on_a[k], f->origin);
        sum += square_of(c, tl_v3_dot(d, f->e), tl_v3_dot(d, f->g));
    }
    return o->area * sum / 3;
}

TEST(three_points_integrate_what_a_triangle_covers)
{
    for (int i = 0; i < 2000; i++) {
        const frame f = draw_frame();
        double x[3], y[3], c[6];
        for (int k = 0; k < 3; k++) {
            x[k] = 2 * draw();
            y[k] = 2 * draw();
        }
        for (int k = 0; k < 6; k++)
            c[k] = draw();
        if ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]) < 1e-3)
            continue;
        tl_vec3 lower[3], upper[4];
        const double gap = 1e-3 * draw();
        for (int k = 0; k < 3; k++)
            lower[k] = at(&f, x[k], y[k], 0);
        square(&f, gap, true, upper);
        tl_overlay_room room = room_of();
        tl_overlay o;
        CHECK(tl_overlay_find(&(tl_outer_face){lower, 3}, &(tl_outer_face){upper, 4}, 0.5, &room, &o));
        CHECK_NEAR(by_points(c, &o, &f), integral(c, x, y), 1e-11);
        for (int k = 0; k < 3; k++)
            CHECK_NEAR(tl_v3_dot(tl_v3_sub(o.on_b[k], o.on_a[k]), o.n), gap, 1e-12);
    }
}

/* Triangles that divide a face have, with another face, pieces whose integrals add up to that of the whole. */
TEST(pieces_add_up)
{
    for (int i = 0; i < 500; i++) {
        const frame f = draw_frame();
        const double px = 2 * draw(), py = 2 * draw();
        double c[6];
        tl_vec3 whole[4], upper[3], part[3];
        for (int k = 0; k < 6; k++)
            c[k] = draw();
        square(&f, 0, false, whole);
        upper[0] = at(&f, 4 * draw(), 4 * draw(), 0);
        upper[1] = at(&f, 4 * draw(), 4 * draw(), 0);
        upper[2] = at(&f, 4 * draw(), 4 * draw(), 0);
        const tl_outer_face above = {upper, 3};
        tl_overlay_room room = room_of();
        tl_overlay o;
        if (!tl_overlay_find(&(tl_outer_face){whole, 4}, &above, 0.5, &room, &o))
            continue;
        const double all = by_points(c, &o, &f), area = o.area;
        double sum = 0, areas = 0;
        for (int k = 0; k < 4; k++) {
            part[0] = whole[k];
            part[1] = whole[(k + 1) % 4];
            part[2] = at(&f, px, py, 0);
            room = room_of();
            if (!tl_overlay_find(&(tl_outer_face){part, 3}, &above, 0.5, &room, &o))
                continue;
            sum += by_points(c, &o, &f);
            areas += o.area;
        }
        CHECK_NEAR(areas, area, 1e-11);
        CHECK_NEAR(sum, all, 1e-10);
    }
}

TEST(faces_that_look_the_same_way_have_nothing)
{
    const frame f = draw_frame();
    tl_vec3 one[4], other[4];
    tl_overlay_room room = room_of();
    tl_overlay o;
    square(&f, 0, false, one);
    square(&f, 0, false, other);
    CHECK(!tl_overlay_find(&(tl_outer_face){one, 4}, &(tl_outer_face){other, 4}, 0.5, &room, &o));
    square(&f, 0, true, other);
    for (int k = 0; k < 4; k++)
        other[k] = tl_v3_madd(other[k], 7, f.e);
    CHECK(!tl_overlay_find(&(tl_outer_face){one, 4}, &(tl_outer_face){other, 4}, 0.5, &room, &o));
}

TEST_MAIN(three_points_integrate_what_a_triangle_covers(), pieces_add_up(), faces_that_look_the_same_way_have_nothing())
