/* press_properties.c - what two blocks press on each other with, through the blend of field and patch: force and moment
 * are the gradient of the energy, and faces that were left out change nothing. */
#include "contact_scene.h"

#include "narrow/press.h"
#include "narrow/press_slope.h"

#include <string.h>

typedef struct scene {
    scene_pair pair;
    double least, margin, shift;
    bool corners;
    int power; /* of which the gradient is looked at; none below 0: the energy */
} scene;

/* The flush faces; where there are none, the first. */
static tl_face_pair shifted_of(const tl_region *r)
{
    return r->flush ? (tl_face_pair){r->flush_a, r->flush_b} : (tl_face_pair){0, 0};
}

static tl_press press_with(scene *s, tl_press_extra *extra)
{
    const tl_pair_view *view = scene_place(&s->pair);
    tl_region region;
    tl_press press;
    CHECK(tl_region_find(view, s->margin * view->size, &s->pair.scratch, &region));
    CHECK(tl_press_find(&(tl_press_query){.view = view,
                                          .region = &region,
                                          .min_area = s->least,
                                          .shift = s->shift,
                                          .shifted = shifted_of(&region),
                                          .corners = s->corners,
                                          .volumes = extra != NULL},
                        1, &s->pair.scratch, &press, extra));
    return press;
}

static tl_press press_of(scene *s)
{
    return press_with(s, NULL);
}

/* An integral over the common volume, as the energy: its whole and minus its gradient. */
static tl_field_power whole_of(scene *s)
{
    tl_press_extra extra;
    tl_press press = press_with(s, s->power < 0 ? NULL : &extra);
    return s->power < 0 ? (tl_field_power){press.energy, press.force, press.moment} : extra.powers[s->power];
}

static tl_vec3 axis_of(int k)
{
    return tl_v3(k == 0, k == 1, k == 2);
}

static double energy_after(void *user, int axis, double way, bool turned)
{
    scene *s = user;
    const tl_quat turn = s->pair.turn;
    const tl_vec3 shift = s->pair.shift;
    if (turned) {
        tl_quat q = scene_turn(axis_of(axis), way);
        s->pair.turn = tl_q_mul(q, turn);
        s->pair.shift = tl_q_rotate(q, shift);
    } else {
        s->pair.shift = tl_v3_madd(shift, way, axis_of(axis));
    }
    double out = whole_of(s).whole;
    s->pair.turn = turn;
    s->pair.shift = shift;
    return out;
}

static double off_by(scene *s, const tl_field_power *press, double h)
{
    double force = tl_v3_norm(press->force), size = s->pair.view.size;
    tl_vec3 g = scene_minus_gradient(energy_after, s, h * size, false),
            m = scene_minus_gradient(energy_after, s, h, true);
    return fmax(tl_v3_norm(tl_v3_sub(g, press->force)) / force,
                tl_v3_norm(tl_v3_sub(m, press->moment)) / (force * size));
}

/* A block on another, its lower face tilted by some degrees over the other's upper one, and in it by a depth. */
static void make_flush(scene *s, double tilt, double depth, uint64_t *seed)
{
    tl_vec3 hinge = tl_v3(scene_between(seed, -1, 1), scene_between(seed, -1, 1), 0);
    tl_quat turn = tl_q_mul(scene_turn(tl_v3_unit(hinge), tilt * 3.14159265358979 / 180),
                            scene_turn(tl_v3(0, 0, 1), scene_between(seed, 0, 3)));
    tl_vec3 shift = tl_v3(scene_between(seed, -0.6, 0.6), scene_between(seed, -0.6, 0.6), 0);
    *s = (scene){.pair = scene_pair_of(scene_box_shape(1, 1.2, 0.8), scene_box_shape(1.4, 1, 1.1), turn, shift)};
    /* down until the lowest corner over the face is so deep */
    const tl_pair_view *view = scene_place(&s->pair);
    double low = INFINITY;
    for (uint32_t k = 0; k < view->b->vertex_count; k++)
        low = fmin(low, view->vertex_b[k].z);
    double top = -INFINITY;
    for (uint32_t k = 0; k < view->a->vertex_count; k++)
        top = fmax(top, view->a->vertex[k].z);
    s->pair.shift.z += top - low - depth;
}

/* The best agreement with differences over ways from 1e-2 to 1e-5 of the depth. */
static double least_off(scene *s, double depth)
{
    const double steps[] = {1e-2, 1e-3, 1e-4, 1e-5};
    const tl_field_power press = whole_of(s);
    double off = INFINITY;
    for (int i = 0; i < 4; i++)
        off = fmin(off, off_by(s, &press, steps[i] * depth));
    return off;
}

/* Of so many flush blocks at tilts and depths up to these, deg and m. */
static void try_gradients(int count, bool corners, double steep, double deep)
{
    int cases = 0, blended = 0;
    double worst = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(count); k++) {
        uint64_t seed = k;
        static scene s;
        double tilt = scene_between(&seed, 0, steep);
        double depth = pow(10, scene_between(&seed, -4, log10(deep)));
        make_flush(&s, tilt, depth, &seed);
        s.least = k % 3 || corners ? 0 : 0.01;
        s.shift = k % 5 ? 0 : 1e-3;
        s.corners = corners;
        s.power = -1;
        tl_press press = press_of(&s);
        for (; tl_v3_norm(press.force) > 1e-6 && s.power < (corners ? TL_PRESS_POWERS : 0); s.power++) {
            double off = least_off(&s, depth);
            worst = fmax(worst, off);
            cases++;
            blended += press.patch > 0 && press.patch < 1;
            if (!CHECK(off < 1e-6))
                printf("  seed %d, tilt %g, overlap %g, patch %g, power %d: off by %g\n", (int)k, tilt, depth,
                       press.patch, s.power, off);
        }
        scene_pair_free(&s.pair);
    }
    printf("  %d cases, %d blended, off by %.1e at the most\n", cases, blended, worst);
    CHECK(cases > check_least(count * 3 / 5));
    CHECK(blended > check_least(count / 8));
}

TEST(force_is_the_gradient_through_the_blend)
{
    try_gradients(1500, false, 0.2, 1e-2);
}

/* With springs at the corners, too, whose areas change as a face is tilted or turns over an edge. */
TEST(force_is_the_gradient_at_corners)
{
    try_gradients(500, true, 12, 0.1);
}

static tl_pair_pose place_of(const scene *s)
{
    return (tl_pair_pose){s->pair.view.turn, s->pair.view.shift};
}

/* Moves B by a part of the overlap: along, and by a turn about the centre of the pressure that moves the rim as far. */
static void nudge(scene *s, const tl_press *at, double part, uint64_t *seed)
{
    double way = part * at->deepest, lever = fmax(2 * at->radius, at->deepest);
    tl_quat turn = scene_turn(scene_direction(seed), way / lever);
    tl_vec3 arm = tl_v3_sub(s->pair.shift, at->point);
    s->pair.turn = tl_q_unit(tl_q_mul(turn, s->pair.turn));
    s->pair.shift = tl_v3_add(at->point, tl_q_rotate(turn, arm));
    s->pair.shift = tl_v3_madd(s->pair.shift, way, scene_direction(seed));
}

/* Of what was found at a place and goes on by its slopes, the error goes with the square of the way; half of it each for the
 * move and the turn. */
TEST(slopes_go_on_with_the_press)
{
    int cases = 0;
    double worst = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(1000); k++) {
        uint64_t seed = k + 70000;
        static scene s;
        make_flush(&s, k % 2 ? scene_between(&seed, 0, 0.3) : scene_between(&seed, 1, 50),
                   pow(10, scene_between(&seed, -5, -2)), &seed);
        s.least = k % 3 ? 0 : 0.01;
        s.shift = k % 5 ? 0 : 1e-3;
        s.margin = 0.01;
        tl_press at = press_of(&s);
        tl_press_slope slope;
        tl_region region;
        const tl_pair_view *view = scene_place(&s.pair);
        const tl_pair_pose from = place_of(&s);
        CHECK(tl_region_find(view, s.margin * view->size, &s.pair.scratch, &region));
        const tl_face_pair shifted = shifted_of(&region);
        if (at.area > 0) {
            CHECK(tl_press_slope_find(
                &(tl_press_query){
                    .view = view, .region = &region, .min_area = s.least, .shift = s.shift, .shifted = shifted},
                &at, &s.pair.scratch, &slope));
            CHECK(slope.known);
            nudge(&s, &at, 0.5 * TL_PRESS_NEAR * (1 - 1e-5), &seed); /* short of it for rounding */
            tl_press found = press_of(&s);
            const tl_pair_pose to = place_of(&s);
            tl_press near;
            CHECK(tl_press_near(&at, &slope, &from, &to, TL_PRESS_NEAR, &near));
            double force = tl_v3_norm(found.force), size = s.pair.view.size;
            double off =
                fmax(scene_apart(near.force, found.force), scene_apart(near.moment, found.moment) / size) / force;
            off = fmax(off, fabs(near.energy / found.energy - 1));
            off = fmax(off, fabs(near.area / found.area - 1));
            off = fmax(off, fabs(near.deepest / found.deepest - 1));
            off = fmax(off, scene_apart(near.point, found.point) / size);
            worst = fmax(worst, off);
            if (!CHECK(off < 4 * TL_PRESS_NEAR * TL_PRESS_NEAR))
                printf("  seed %d, patch %g, overlap %g, radius %g: off by %g\n", (int)k, at.patch, at.deepest,
                       at.radius, off);
            cases++;
        }
        scene_pair_free(&s.pair);
    }
    printf("  %d cases, off by %.1e at the most\n", cases, worst);
    CHECK(cases > check_least(500));
}

/* The slopes that a mesh tells, of which differences over a way of `part` of the overlap are made. */
static double slopes_off(scene *s, const tl_press *at, const tl_field_slope *field, double part)
{
    const tl_press_slope slope = tl_press_slope_of(at, field);
    const double lever = tl_press_lever(at), way = part * at->deepest, size = s->pair.view.size;
    const tl_quat turn = s->pair.turn;
    const tl_vec3 shift = s->pair.shift;
    double off = 0, largest = 0;
    for (int axis = 0; axis < 6; axis++) {
        tl_press side[2];
        const double by = axis < 3 ? way : way / lever;
        for (int k = 0; k < 2; k++) {
            const tl_quat q = axis < 3 ? (tl_quat){1, 0, 0, 0} : scene_turn(axis_of(axis - 3), k ? by : -by);
            s->pair.turn = tl_q_mul(q, turn);
            s->pair.shift = tl_v3_add(at->point, tl_q_rotate(q, tl_v3_sub(shift, at->point)));
            if (axis < 3)
                s->pair.shift = tl_v3_madd(shift, k ? by : -by, axis_of(axis));
            side[k] = press_of(s);
        }
        s->pair.turn = turn;
        s->pair.shift = shift;
        const double per = 1 / (2 * by), scale = axis < 3 ? 1 : 1 / lever;
        tl_vec3 force = tl_v3_scale(per, tl_v3_sub(side[1].force, side[0].force));
        tl_vec3 moment = tl_v3_scale(per, tl_v3_sub(side[1].moment, side[0].moment));
        largest = fmax(largest, scale * tl_v3_norm(force));
        off = fmax(off, scale * scene_apart(force, slope.force[axis]));
        off = fmax(off, scale * scene_apart(moment, slope.moment[axis]) / size);
    }
    return off / largest;
}

static tl_poly *shape_of(uint64_t *seed, int kind)
{
    switch (kind) {
    case 0: return scene_box_shape(1, 1, 1);
    case 1: return scene_random_hull(seed, 14, tl_v3(0.6, 0.6, 0.6));
    case 2: return scene_box_shape(2, 2, 0.2);
    case 3: return scene_random_hull(seed, 40, tl_v3(0.5, 0.7, 0.6));
    default: return scene_random_hull(seed, 5, tl_v3(0.6, 0.6, 0.6));
    }
}

/* Corners, edges and faces of two blocks pressed into each other: the mesh tells the slopes of force and moment. The
 * best agreement with differences over ways from 1e-3 to 1e-5 of the overlap. And the energy goes on by them as far as
 * moving contacts use them, wrong by no more than what that tolerance says. */
TEST(a_mesh_tells_the_slopes)
{
    int cases = 0;
    double worst = 0, energy = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(1000); k++) {
        uint64_t seed = k + 90000;
        static scene s;
        tl_quat turn = scene_turn(scene_direction(&seed), scene_between(&seed, 0, 3));
        tl_vec3 away = scene_direction(&seed);
        s = (scene){.pair = scene_pair_of(shape_of(&seed, (int)(k % 5)), shape_of(&seed, (int)(k / 5 % 5)), turn,
                                          tl_v3_scale(4, away)),
                    .margin = 0.01,
                    .power = -1};
        tl_region region;
        const tl_pair_view *view = scene_place(&s.pair);
        const double depth = pow(10, scene_between(&seed, -4, -1.5));
        for (int i = 0; i < 10; i++) { /* together until they overlap so much */
            CHECK(tl_region_find(view, s.margin * view->size, &s.pair.scratch, &region));
            double along = fmax(0.1, tl_v3_dot(region.n, away));
            s.pair.shift = tl_v3_madd(s.pair.shift, -(region.gap + depth) / along, away);
            view = scene_place(&s.pair);
        }
        CHECK(tl_region_find(view, s.margin * view->size, &s.pair.scratch, &region));
        tl_field_mesh mesh = {0};
        tl_field_slope field;
        region.mesh = &mesh;
        tl_press at;
        const tl_pair_pose from = place_of(&s);
        CHECK(tl_press_find(&(tl_press_query){.view = view, .region = &region, .slope = &field}, 1, &s.pair.scratch,
                            &at, NULL));
        if (at.area > 0 && field.known) {
            double off = INFINITY;
            for (double part = 1e-3; part > 5e-6; part *= 0.1)
                off = fmin(off, slopes_off(&s, &at, &field, part));
            worst = fmax(worst, off);
            if (!CHECK(off < 1e-5))
                printf("  seed %d, overlap %g: slopes off by %g\n", (int)k, at.deepest, off);
            cases++;
            const tl_press_slope slope = tl_press_slope_of(&at, &field);
            nudge(&s, &at, 0.5 * TL_PRESS_REACH * (1 - 1e-5), &seed);
            const tl_press found = press_of(&s);
            const tl_pair_pose to = place_of(&s);
            tl_press near;
            CHECK(tl_press_near(&at, &slope, &from, &to, TL_PRESS_REACH, &near));
            energy = fmax(energy, fabs(near.energy / found.energy - 1));
        }
        scene_pair_free(&s.pair);
    }
    printf("  %d cases, slopes off by %.1e, energies by %.1e at the most\n", cases, worst, energy);
    CHECK(cases > check_least(300) && energy < 1e-4);
}

/* All faces give the same as those listed; and a list made with a margin holds while the pair moves by it. */
TEST(faces_left_out_do_not_matter)
{
    int cases = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(3000); k++) {
        uint64_t seed = k;
        static scene s;
        s = (scene){.pair = scene_pair_of(shape_of(&seed, (int)(k % 5)), shape_of(&seed, (int)(k / 5 % 5)),
                                          scene_any_turn(&seed),
                                          tl_v3_scale(scene_between(&seed, 0.4, 1.2), scene_direction(&seed)))};
        const tl_pair_view *view = scene_place(&s.pair);
        tl_region region;
        tl_press some, all;
        double margin = 0.01 * view->size;
        CHECK(tl_region_find(view, margin, &s.pair.scratch, &region));
        s.pair.shift = tl_v3_madd(s.pair.shift, margin, scene_direction(&seed));
        view = scene_place(&s.pair);
        CHECK(tl_press_find(&(tl_press_query){.view = view, .region = &region}, 1, &s.pair.scratch, &some, NULL));
        s.margin = 1e3;
        all = press_of(&s);
        double force = tl_v3_norm(all.force);
        cases += force > 0;
        /* of a plate that is pierced nothing is left of the force but roundings */
        double pressed = force > 0 ? fmax(force, all.energy / all.deepest) : 0;
        CHECK_NEAR(tl_v3_norm(tl_v3_sub(some.force, all.force)), 0, 1e-9 * pressed);
        CHECK_NEAR(tl_v3_norm(tl_v3_sub(some.moment, all.moment)), 0, 1e-9 * pressed);
        CHECK_NEAR(some.energy, all.energy, 1e-9 * all.energy);
        scene_pair_free(&s.pair);
    }
    CHECK(cases > check_least(1000));
}

/* Moves a pair by less than `most`, turns about B's origin counted at its size. */
static double wander(scene *s, double most, uint64_t *seed)
{
    double way = most * pow(10, scene_between(seed, -3, 0)), size = s->pair.view.size;
    tl_quat turn = scene_turn(scene_direction(seed), 0.25 * way / size);
    s->pair.turn = tl_q_unit(tl_q_mul(turn, s->pair.turn));
    s->pair.shift = tl_v3_madd(s->pair.shift, 0.5 * way, scene_direction(seed));
    return way;
}

/* A pair that wanders about while its list holds, by less or more than its overlap, and comes apart at times: which faces bound
 * the common volume in the last place is a help in the next, and changes nothing. */
TEST(faces_that_bounded_before_change_nothing)
{
    int cases = 0, changes = 0, forgotten = 0, stood = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(1000); k++) {
        uint64_t seed = k + 40000;
        const bool powers = k % 3 == 0;
        tl_field_mesh mesh = {0};
        static scene s;
        s = (scene){.pair = scene_pair_of(shape_of(&seed, (int)(k % 5)), shape_of(&seed, (int)(k / 5 % 5)),
                                          scene_any_turn(&seed),
                                          tl_v3_scale(scene_between(&seed, 0.2, 1.2), scene_direction(&seed)))};
        const tl_pair_view *view = scene_place(&s.pair);
        tl_region region;
        tl_press with, without;
        tl_press_extra extra_with, extra_without;
        double left = (k % 2 ? 0.02 : 0.3) * view->size;
        CHECK(tl_region_find(view, left, &s.pair.scratch, &region));
        for (double way = 0; left > 0; way = wander(&s, 0.2 * view->size, &seed), left -= way) {
            uint64_t before = mesh.bounding;
            const tl_field_mesh mesh_before = mesh;
            /* a minimum area that comes and goes: volumes are wanted with it */
            double least = k % 4 == 0 && check_random(&seed) < 0.3 ? 0.01 * view->size * view->size : 0;
            view = scene_place(&s.pair);
            region.mesh = NULL;
            CHECK(
                tl_press_find(&(tl_press_query){.view = view, .region = &region, .min_area = least, .volumes = powers},
                              1, &s.pair.scratch, &without, &extra_without));
            region.mesh = &mesh;
            forgotten += before && !tl_region_corners_agree(view, &region);
            CHECK(
                tl_press_find(&(tl_press_query){.view = view, .region = &region, .min_area = least, .volumes = powers},
                              1, &s.pair.scratch, &with, &extra_with));
            /* a plate that sticks out on both sides as far is pressed by nothing, but for roundings */
            if (tl_v3_norm(without.force) < 1e-9 * without.energy / without.deepest)
                continue;
            cases += before && without.deepest > 0;
            changes += before && before != mesh.bounding;
            stood += mesh.polygons > 0 && memcmp(&mesh, &mesh_before, sizeof mesh) == 0;
            double force = tl_v3_norm(without.force);
            double pressed = force > 0 ? fmax(force, without.energy / without.deepest) : 0;
            CHECK_NEAR(scene_apart(with.force, without.force), 0, 1e-9 * pressed);
            CHECK_NEAR(scene_apart(with.moment, without.moment), 0, 1e-9 * pressed);
            CHECK_NEAR(with.stiffness, without.stiffness, 1e-9 * without.stiffness);
            CHECK_NEAR(with.energy, without.energy, 1e-9 * without.energy);
            CHECK_NEAR(with.deepest, without.deepest, 1e-9 * without.deepest);
            for (int i = 0; i < TL_PRESS_POWERS && powers && force > 0; i++) {
                const tl_field_power *one = &extra_with.powers[i], *two = &extra_without.powers[i];
                CHECK_NEAR(one->whole, two->whole, 1e-9 * two->whole);
                CHECK_NEAR(scene_apart(one->force, two->force), 0, 1e-9 * two->whole / without.deepest);
            }
        }
        scene_pair_free(&s.pair);
    }
    CHECK(cases > check_least(2500));
    CHECK(changes > check_least(100));
    CHECK(forgotten > check_least(40));
    CHECK(stood > check_least(1500));
    printf("  %d places, other faces %d times, by a corner %d times, the same polygons %d times\n", cases, changes,
           forgotten, stood);
}

/* A block whose lower side is folded along y by an angle, its lowest edge at the origin. */
static tl_poly *folded(double degrees)
{
    double rise = 0.5 * tan(degrees * TL_PI / 180);
    tl_vec3 p[10];
    for (int k = 0; k < 10; k++) {
        double x = k % 5 == 4 ? 0 : k % 5 < 2 ? -0.5 : 0.5;
        double z = k % 5 == 4 ? 0 : k % 2 ? 1 : k % 5 < 2 ? rise : 0;
        p[k] = tl_v3(x, k < 5 ? -0.5 : 0.5, z);
    }
    return scene_hull_shape(p, 10);
}

/* Which of two faces beside each other lies flush may change while a list of faces holds. */
TEST(faces_that_become_flush_are_found_in_an_old_list)
{
    int cases = 0, blended = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(1000); k++) {
        uint64_t seed = k;
        double angle = scene_between(&seed, 1, 12), tilt = scene_between(&seed, 0, 0.2);
        double depth = pow(10, scene_between(&seed, -5, -3));
        static scene s;
        bool swapped = k % 2, other = check_random(&seed) < 0.5; /* the fold's other face */
        tl_vec3 hinge = {0, 1, 0}, up = {0, 0, swapped ? -0.5 + depth : 0.5 - depth};
        tl_quat was = scene_turn(hinge, (other ? -angle : 0) * TL_PI / 180);
        tl_quat is = tl_q_mul(scene_turn(hinge, tilt * TL_PI / 180), was);
        tl_poly *plate = scene_box_shape(3, 3, 1), *block = folded(angle);
        s = (scene){.pair = swapped ? scene_pair_of(block, plate, tl_q_conj(was), tl_q_rotate(tl_q_conj(was), up))
                                    : scene_pair_of(plate, block, was, up)};
        tl_region region;
        tl_press some, all;
        const tl_pair_view *view = scene_place(&s.pair);
        s.margin = 0.005;
        CHECK(tl_region_find(view, s.margin * view->size, &s.pair.scratch, &region));
        s.pair.turn = swapped ? tl_q_conj(is) : is;
        s.pair.shift = swapped ? tl_q_rotate(tl_q_conj(is), up) : up;
        view = scene_place(&s.pair);
        tl_region_choose_flush(view, &region);
        CHECK(tl_press_find(&(tl_press_query){.view = view, .region = &region}, 1, &s.pair.scratch, &some, NULL));
        all = press_of(&s);
        double force = tl_v3_norm(all.force);
        cases += force > 0;
        blended += all.patch > 0;
        CHECK_NEAR(some.patch, all.patch, 1e-9);
        CHECK_NEAR(scene_apart(some.force, all.force), 0, 1e-9 * force);
        CHECK_NEAR(some.energy, all.energy, 1e-9 * all.energy);
        scene_pair_free(&s.pair);
    }
    CHECK(cases > check_least(900));
    CHECK(blended > check_least(300));
}

TEST_MAIN(RUN(force_is_the_gradient_through_the_blend), RUN(force_is_the_gradient_at_corners),
          RUN(slopes_go_on_with_the_press), RUN(a_mesh_tells_the_slopes), RUN(faces_left_out_do_not_matter),
          RUN(faces_that_bounded_before_change_nothing), RUN(faces_that_become_flush_are_found_in_an_old_list))
