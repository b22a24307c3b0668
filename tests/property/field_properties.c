/* field_properties.c - the pressure field of random pairs of shapes: force and moment are the gradient of the energy,
 * and the energy is that of a brute-force sum. Overlaps go from touching to 0.4 of the size; faces may be borders. */
#include "field_scene.h"
#include "geometry/cut.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "narrow/field.h"

/* Force over the cube of the overlap, a length, below which a pair hardly touches: needles that cross by a corner. */
#define LEAST 1e-3

/* The integral over K that is looked at, and minus its gradient. */
static tl_field_power integral_of(scene *s)
{
    tl_field_sums sums;
    list_scene(s);
    CHECK(field_integrate(&s->planes.faces, &s->pair.scratch.field, &sums));
    return s->power > 1 ? sums.powers[s->power - 2] : (tl_field_power){sums.energy, sums.force, sums.moment};
}

/* The integral after B has been moved along an axis, or turned about the origin, by some way. */
static double energy_after(void *user, int axis, double way, bool turned)
{
    scene *s = user;
    const tl_quat turn = s->pair.turn;
    const tl_vec3 shift = s->pair.shift;
    if (turned) {
        tl_quat q = scene_turn(axis_of(axis), way);
        s->pair.turn = tl_q_mul(q, turn);
        s->pair.shift = tl_v3_add(s->origin, tl_q_rotate(q, tl_v3_sub(shift, s->origin)));
    } else {
        s->pair.shift = tl_v3_madd(shift, way, axis_of(axis));
    }
    double out = integral_of(s).whole;
    s->pair.turn = turn;
    s->pair.shift = shift;
    return out;
}

/* Force and moment may differ from the differences by this. */
#define GRADIENT 1e-6
/* Steps of the differences over the overlap. Rounding spoils the smaller one, a polygon that comes or goes the larger. */
static const double steps[] = {1e-3, 2e-4, 4e-5, 1e-2};

static double worst;

/* How far force and moment are off the differences with a step, relative to the force. */
static double off_by(scene *s, const tl_field_power *sums, double h)
{
    double force = tl_v3_norm(sums->force), size = s->pair.view.size;
    tl_vec3 g = scene_minus_gradient(energy_after, s, h * size, false),
            m = scene_minus_gradient(energy_after, s, h, true);
    return fmax(tl_v3_norm(tl_v3_sub(g, sums->force)) / force, tl_v3_norm(tl_v3_sub(m, sums->moment)) / (force * size));
}

/* false: the blocks do not press on each other. */
static bool check_gradient(scene *s, double depth, uint64_t seed)
{
    const tl_field_power sums = integral_of(s);
    const int power = s->power > 1 ? s->power : 1;
    if (!(tl_v3_norm(sums.force) > LEAST * pow(depth * s->pair.view.size, 2 + power)))
        return false;
    double off = INFINITY;
    for (size_t k = 0; k < sizeof steps / sizeof *steps; k++)
        off = fmin(off, off_by(s, &sums, steps[k] * depth));
    worst = fmax(worst, off);
    if (!CHECK(off < GRADIENT))
        printf("  seed %d, overlap %g: off by %g of %g\n", (int)seed, depth, off, tl_v3_norm(sums.force));
    return true;
}

static double random_depth(uint64_t *seed)
{
    return pow(10, scene_between(seed, -4, log10(0.4)));
}

TEST(force_and_moment_are_the_gradient_of_the_energy)
{
    int cases = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(1000); k++) {
        uint64_t seed = k;
        static scene s;
        double depth = random_depth(&seed);
        make_scene(&s, random_kind(&seed), random_kind(&seed), depth, k % 8 == 0, &seed);
        cases += check_gradient(&s, depth, k);
        free_scene(&s);
    }
    CHECK(cases > check_least(900));
    printf("  %d cases, off by %.1e at the most\n", cases, worst);
}

/* So are those of the integrals of d^2 and d^3, with borders and without. */
TEST(powers_have_gradients)
{
    int cases = 0;
    worst = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(400); k++) {
        uint64_t seed = k + 20000;
        static scene s;
        double depth = pow(10, scene_between(&seed, -2.5, log10(0.4)));
        make_scene(&s, random_kind(&seed), random_kind(&seed), depth, k % 8 == 0, &seed);
        s.power = 2 + (int)(k % 2);
        s.borders = k % 3 == 0;
        for (int i = 0; i < 256; i++)
            s.border_a[i] = s.borders && check_random(&seed) < 0.3;
        cases += check_gradient(&s, depth, k);
        free_scene(&s);
    }
    CHECK(cases > check_least(300));
    printf("  %d cases, off by %.1e at the most\n", cases, worst);
}

/* Faces of both blocks chosen at random bound them as seams do. */
TEST(borders_do_work_as_well)
{
    int cases = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(250); k++) {
        uint64_t seed = k + 5000;
        static scene s;
        double depth = random_depth(&seed);
        make_scene(&s, random_kind(&seed) % 5, random_kind(&seed) % 5, depth, false, &seed);
        s.borders = true;
        for (int i = 0; i < 256; i++) {
            s.border_a[i] = check_random(&seed) < 0.3;
            s.border_b[i] = k % 2 && check_random(&seed) < 0.3;
        }
        cases += check_gradient(&s, depth, k);
        free_scene(&s);
    }
    CHECK(cases > check_least(170));
}

/* Integrates the field of A, or of the part of A below a plane, or above it, whose face in that plane is a seam. */
static tl_field_sums sums_of_part(scene *s, tl_vec3 n, double offset, double side)
{
    planes *p = &s->planes;
    tl_field_sums sums;
    list_scene(s);
    if (side != 0) {
        uint32_t i = p->faces.a + p->faces.b;
        p->number[0][i] = side * n.x;
        p->number[1][i] = side * n.y;
        p->number[2][i] = side * n.z;
        p->number[3][i] = side * offset;
        p->faces.border_a = p->faces.seam_a = 1;
    }
    CHECK(field_integrate(&p->faces, &s->pair.scratch.field, &sums));
    return sums;
}

/* The energies and forces of two parts are those of the whole; what passes through the seam is taken from the one and
 * given to the other. */
TEST(what_passes_through_a_seam_stays_in_the_body)
{
    int cases = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(400); k++) {
        uint64_t seed = k + 9000;
        static scene s;
        double depth = random_depth(&seed);
        make_scene(&s, random_kind(&seed) % 5, random_kind(&seed) % 5, depth, false, &seed);
        s.apart = true; /* all faces are listed */
        tl_vec3 n = scene_direction(&seed);
        double offset = scene_between(&seed, -0.3, 0.3) * depth;
        tl_field_sums whole = sums_of_part(&s, n, offset, 0);
        tl_field_sums below = sums_of_part(&s, n, offset, 1);
        tl_field_sums above = sums_of_part(&s, n, offset, -1);
        double force = tl_v3_norm(whole.force), size = cbrt(whole.volume);
        if (force > 0 && below.volume > 1e-3 * whole.volume && above.volume > 1e-3 * whole.volume) {
            cases++;
            CHECK_REL(below.energy + above.energy, whole.energy, 1e-9);
            CHECK(tl_v3_norm(below.through) > 0);
            tl_vec3 sum = tl_v3_add(below.force, above.force);
            CHECK_NEAR(tl_v3_norm(tl_v3_sub(sum, whole.force)), 0, 1e-8 * force);
            sum = tl_v3_add(below.through, above.through);
            CHECK_NEAR(tl_v3_norm(sum), 0, 1e-8 * force);
            sum = tl_v3_sub(tl_v3_add(below.moment, above.moment), whole.moment);
            CHECK_NEAR(tl_v3_norm(sum), 0, 1e-8 * force * size);
            sum = tl_v3_add(below.through_moment, above.through_moment);
            CHECK_NEAR(tl_v3_norm(sum), 0, 1e-8 * force * size);
        }
        free_scene(&s);
    }
    CHECK(cases > check_least(200));
}

/* The depth of a point in both blocks, 0 outside. */
static double depth_at(const tl_field_faces *f, tl_vec3 x)
{
    double depth = INFINITY;
    for (uint32_t i = 0; i < f->a + f->b; i++)
        depth = fmin(depth, f->c[i] - tl_v3_dot(tl_v3(f->n[0][i], f->n[1][i], f->n[2][i]), x));
    return fmax(depth, 0);
}

/* Volume of what two blocks have in common, by cutting one by the faces of the other. */
static double volume_in_common(const scene *s)
{
    const tl_pair_view *view = &s->pair.view;
    tl_error error;
    tl_poly *left = NULL;
    CHECK_INT(tl_poly_transformed(view->a, NULL, tl_v3(0, 0, 0), &left, &error), TL_OK);
    double volume = 0;
    for (uint32_t f = 0; f < view->b->face_count && left; f++) {
        tl_vec3 n = view->normal_b[f];
        tl_plane plane = {n, view->b->plane[f].offset + tl_v3_dot(n, view->shift)};
        tl_cut cut;
        CHECK_INT(tl_poly_cut(left, plane, 0, (tl_tag){0, 0}, &cut, &error), TL_OK);
        if (cut.result == TL_CUT_MADE) {
            tl_poly_free(left);
            tl_poly_free(cut.above);
            left = cut.below;
        } else if (cut.result != TL_CUT_MISS || tl_v3_dot(n, left->vertex[0]) > plane.offset) {
            volume = cut.result == TL_CUT_MISS ? 0 : NAN; /* all of it is outside; too thin to be cut */
            tl_poly_free(left);
            left = NULL;
        }
    }
    if (left)
        volume = tl_poly_mass(left).volume;
    tl_poly_free(left);
    return volume;
}

TEST(volume_is_that_of_what_is_left_by_cuts)
{
    int cases = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(400); k++) {
        uint64_t seed = k + 7000;
        static scene s;
        make_scene(&s, random_kind(&seed), random_kind(&seed), scene_between(&seed, 0.02, 0.4), false, &seed);
        list_scene(&s);
        tl_field_sums found;
        CHECK(field_integrate(&s.planes.faces, &s.pair.scratch.field, &found));
        double volume = volume_in_common(&s);
        /* what is cut of a bent face is not what lies under its plane */
        bool flat = tl_poly_check(s.pair.view.a, TL_POLY_ON, NULL) == TL_OK &&
                    tl_poly_check(s.pair.view.b, TL_POLY_ON, NULL) == TL_OK;
        if (!isnan(volume) && flat) {
            CHECK_NEAR(found.volume, volume, 1e-9 * volume);
            cases += volume > 0;
        }
        free_scene(&s);
    }
    CHECK(cases > check_least(300));
}

/* The energy by a sum over a grid of cells: its error goes with the square of their size. */
TEST(energy_is_that_of_a_sum)
{
    enum { CELLS = 70 };
    const double half = 0.9, cell = 2 * half / CELLS;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(20); k++) {
        uint64_t seed = k + 9000;
        static scene s;
        make_scene(&s, random_kind(&seed) % 2, random_kind(&seed) % 2, 0.3, false, &seed);
        s.power = 2;
        list_scene(&s);
        tl_field_sums found;
        CHECK(field_integrate(&s.planes.faces, &s.pair.scratch.field, &found));
        double sum = 0, square = 0, cube = 0;
        for (int i = 0; i < CELLS * CELLS * CELLS; i++) {
            tl_vec3 at = tl_v3(i % CELLS + 0.5, i / CELLS % CELLS + 0.5, i / CELLS / CELLS + 0.5);
            tl_vec3 x = tl_v3_sub(tl_v3_scale(cell, at), tl_v3(half, half, half));
            double d = depth_at(&s.planes.faces, x), part = d * cell * cell * cell;
            sum += part;
            square += d * part;
            cube += d * d * part;
        }
        CHECK_REL(found.energy, sum, 0.04);
        CHECK_REL(found.powers[0].whole, square, 0.04);
        CHECK_REL(found.powers[1].whole, cube, 0.05);
        free_scene(&s);
    }
}

/* Where the faces of a block that bound K meet in a point, or all but two do, the surface gives the energy; of all faces, the
 * polygons between them do. */
TEST(energy_from_the_surface_is_that_from_all)
{
    int cases = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(3000); k++) {
        uint64_t seed = k + 15000;
        tl_field_mesh mesh = {0};
        static scene s;
        make_scene(&s, random_kind(&seed), random_kind(&seed), pow(10, scene_between(&seed, -4, -0.5)), false, &seed);
        s.power = 2;
        list_scene(&s);
        tl_field_sums all, few;
        tl_field_faces *f = &s.planes.faces;
        CHECK(field_integrate(f, &s.pair.scratch.field, &all));
        f->mesh = &mesh;
        f->energy_only = k % 2;
        f->powers = !f->energy_only;
        CHECK(field_integrate(f, &s.pair.scratch.field, &few));
        if (all.deepest > 0 && mesh.bounding) {
            CHECK_REL(few.energy, all.energy, 1e-9);
            if (!f->energy_only)
                CHECK_REL(few.volume, all.volume, 1e-9);
            for (int i = 0; i < TL_FIELD_POWERS && f->powers; i++)
                CHECK_REL(few.powers[i].whole, all.powers[i].whole, 1e-9);
            CHECK_NEAR(scene_apart(few.force, all.force), 0, 1e-9 * all.pressure);
            cases++;
        }
        f->mesh = NULL;
        f->energy_only = false;
        free_scene(&s);
    }
    CHECK(cases > check_least(2000));
}

/* Loss of digits that may come of an origin as far away as a block is large: its roundings over the size of K. */
#define FAR_ORIGIN 1e-14

/* However small what two blocks have in common, its centre is found as well from afar: the moment of its force about it, the
 * place, and the radius. */
TEST(a_far_origin_moves_nothing)
{
    int cases = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(400); k++) {
        uint64_t seed = k + 12000;
        static scene s;
        make_scene(&s, random_kind(&seed) % 4, random_kind(&seed) % 4, pow(10, scene_between(&seed, -5, -1)), false,
                   &seed);
        tl_field_sums near, far;
        tl_vec3 by = scene_direction(&seed);
        list_scene(&s);
        CHECK(field_integrate(&s.planes.faces, &s.pair.scratch.field, &near));
        s.origin = tl_v3_add(s.origin, by);
        list_scene(&s);
        CHECK(field_integrate(&s.planes.faces, &s.pair.scratch.field, &far));
        double force = tl_v3_norm(near.force), length = cbrt(near.volume);
        if (near.volume > 0) {
            double off = FAR_ORIGIN / length;
            CHECK_NEAR(scene_apart(far.force, near.force), 0, 100 * off * force);
            CHECK_REL(far.energy, near.energy, 100 * off);
            CHECK_REL(far.volume, near.volume, 100 * off);
            tl_vec3 centre = tl_v3_scale(1 / near.pressure, near.pressed);
            tl_vec3 same = tl_v3_add(by, tl_v3_scale(1 / far.pressure, far.pressed));
            double reach = sqrt(near.second / near.extent);
            CHECK_NEAR(scene_apart(same, centre), 0, 100 * off * reach);
            tl_vec3 about = tl_v3_add(far.moment, tl_v3_cross(by, far.force));
            CHECK_NEAR(scene_apart(about, near.moment), 0, 100 * off * force);
            cases++;
        }
        free_scene(&s);
    }
    CHECK(cases > check_least(300));
}

/* Two flush cubes: U = kn A o^2 / 2 and F = kn A o but for what their borders take, of the order of o over the side. */
TEST(flush_faces_have_the_force_of_springs)
{
    static scene s;
    for (int k = -6; k < -1; k++) {
        double o = pow(10, k);
        s = (scene){.pair = scene_pair_of(scene_box_shape(1, 1, 1), scene_box_shape(3, 3, 1), tl_q_identity(),
                                          tl_v3(0.2, 0.1, 1 - o))};
        s.origin = tl_v3(0.1, 0, 0.5);
        list_scene(&s);
        tl_field_sums sums;
        CHECK(field_integrate(&s.planes.faces, &s.pair.scratch.field, &sums));
        CHECK_REL(sums.volume, o, 1e-9);
        CHECK_REL(2 * sums.energy, 0.5 * o * o, 2 * o);
        CHECK_REL(2 * sums.force.z, o, 2 * o);
        CHECK_REL(sums.area.z, 1.0, 4 * o);
        CHECK_NEAR(sums.force.x, 0, 1e-9 * o);
        CHECK_NEAR(sums.force.y, 0, 1e-9 * o);
        CHECK_REL(sums.deepest, 0.5 * o, 1e-9);
        free_scene(&s);
    }
}

/* Whatever seams, nothing is carried where nothing is in common; and nothing depends on the order of the blocks. */
TEST(blocks_that_only_touch_have_no_force)
{
    for (uint64_t k = 1; k <= (uint64_t)check_cases(400); k++) {
        uint64_t seed = k + 20000;
        static scene s;
        make_scene(&s, random_kind(&seed) % 5, random_kind(&seed) % 5, -1e-9, k % 2, &seed);
        list_scene(&s);
        tl_field_sums sums;
        CHECK(field_integrate(&s.planes.faces, &s.pair.scratch.field, &sums));
        CHECK_NEAR(tl_v3_norm(sums.force), 0, 0);
        free_scene(&s);
    }
}

TEST_MAIN(RUN(force_and_moment_are_the_gradient_of_the_energy), RUN(powers_have_gradients),
          RUN(borders_do_work_as_well), RUN(what_passes_through_a_seam_stays_in_the_body),
          RUN(volume_is_that_of_what_is_left_by_cuts), RUN(energy_is_that_of_a_sum),
          RUN(energy_from_the_surface_is_that_from_all), RUN(flush_faces_have_the_force_of_springs),
          RUN(blocks_that_only_touch_have_no_force), RUN(a_far_origin_moves_nothing))
