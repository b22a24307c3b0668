/* test_stored.c - what a contact presses with is the slope of what it stores, and has no jumps: blocks on faces, edges and
 * corners, deep in and hardly, with a minimum area and without, seen through a model. */
#include "contact/contacts.h"
#include "contact_scene.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "property/exact_axis.h"

#define KN 1e9

static const tl_quat none = {1, 0, 0, 0};
static const double degree = TL_PI / 180;

/* ---------------------------------------------------------------- two blocks ------------- */

/* A block that stays and one that is put about, whose rows are the other way round when `swapped`. */
typedef struct rig {
    tl_model *m;
    bool swapped;
    tl_vec3 start; /* centroid of the one that moves */
} rig;

/* Of the one that moves: its centroid, and its turn. */
typedef struct place {
    tl_vec3 u;
    tl_quat q;
} place;

/* Force on it, moment about its centroid, what is stored; the kind of contact. */
typedef struct load {
    tl_vec3 f, moment;
    double stored;
    uint32_t kind;
} load;

static rig rig_of(tl_poly *still, tl_poly *moved, bool swapped, double least)
{
    rig r = {.m = scene_model(1), .swapped = swapped};
    tl_vec3 away = {0, 0, 100};
    r.start = tl_v3_add(tl_poly_mass(moved).centroid, away);
    if (swapped)
        scene_block(r.m, moved, none, away);
    scene_block(r.m, still, none, tl_v3(0, 0, 0));
    if (!swapped)
        scene_block(r.m, moved, none, away);
    scene_law(r.m, "elastic", KN, KN, -1);
    tl_contact_area area = {.size = sizeof(tl_contact_area), .fraction = 0, .absolute = least > 0 ? least : NAN};
    scene_ok(r.m, tl_model_contact_area(r.m, &area));
    return r;
}

static load rig_load(rig *r, place p)
{
    scene_put(r->m, r->swapped ? 0 : 1, tl_v3_sub(p.u, r->start), p.q);
    scene_forces(r->m);
    load l = {.kind = TL_NO_ROW};
    uint32_t c = scene_contact(r->m, 0, 1);
    if (c == TL_NO_ROW)
        return l;
    const tl_contacts *contacts = &r->m->detect->contacts;
    const tl_points_table *points = &r->m->detect->points;
    l.kind = contacts->facet[c].kind;
    l.f = tl_v3_scale(r->swapped ? -1 : 1, contacts->force[c]);
    l.moment = tl_contact_moment(r->m, c, !r->swapped);
    if (l.kind == TL_FACET_FIELD && contacts->point_count[c]) {
        l.stored = 2 * KN * r->m->detect->press[contacts->press[c]].press.energy;
        return l;
    }
    for (size_t k = 0; k < contacts->point_count[c]; k++) {
        size_t i = tl_point_row(contacts, c, k);
        l.stored += points->f_n[i] * points->f_n[i] / (2 * KN * points->area[i]);
    }
    return l;
}

/* The same of a contact born there, which has no past. */
static load rig_fresh(rig *r, place p)
{
    rig_load(r, (place){r->start, none});
    return rig_load(r, p);
}

/* A place of b beside a, overlapping by a depth. */
static place pressed(scene_pair *p, double depth)
{
    exact_press(p, depth);
    tl_vec3 arm = tl_q_rotate(p->turn, tl_poly_mass(p->b).centroid);
    return (place){tl_v3_add(p->shift, arm), p->turn};
}

/* ---------------------------------------------------------------- shapes ----------------- */

#define HALF 0.4 /* of the edge that lies on a face */

/* A block whose lower edge lies along x, its ends at -HALF and HALF. */
static tl_poly *roof(void)
{
    tl_vec3 p[6] = {{-HALF, 0, 0},    {HALF, 0, 0},     {-0.3, -0.4, 0.5},
                    {-0.3, 0.4, 0.5}, {0.3, -0.4, 0.5}, {0.3, 0.4, 0.5}};
    return scene_hull_shape(p, 6);
}

/* It stands on the unit box about the origin, the middle of its edge at (x, y), and the part of the edge over the box
 * dips in `depth` deep; tilt lifts the end at HALF. */
static place stand(double x, double y, double yaw, double roll, double tilt, double depth)
{
    static tl_vec3 centroid;
    if (centroid.z == 0) {
        tl_poly *p = roof();
        centroid = tl_poly_mass(p).centroid;
        tl_poly_free(p);
    }
    place at = {{x, y, 0}, scene_turn(tl_v3(1, 0, 0), roll)};
    at.q = tl_q_mul(scene_turn(tl_v3(0, -1, 0), tilt), at.q);
    at.q = tl_q_mul(scene_turn(tl_v3(0, 0, 1), yaw), at.q);
    tl_vec3 d = tl_q_rotate(at.q, tl_v3(HALF, 0, 0));
    double t0 = -1, t1 = 1; /* over the box */
    const double low[4] = {-0.5 - x, -0.5 - y, x - 0.5, y - 0.5}, by[4] = {d.x, d.y, -d.x, -d.y};
    for (int k = 0; k < 4; k++) {
        if (by[k] > 0)
            t0 = fmax(t0, low[k] / by[k]);
        else if (by[k] < 0)
            t1 = fmin(t1, low[k] / by[k]);
    }
    at.u.z = 0.5 - depth - fmin(t0 * d.z, t1 * d.z);
    at.u = tl_v3_add(at.u, tl_q_rotate(at.q, centroid));
    return at;
}

/* ---------------------------------------------------------------- slope of the energy ---- */

/* Lengths of small motions over the depth; the best of them counts. */
static const double motions[] = {1e-2, 1e-3, 1e-4};
#define SLOPE 1e-6

/* How far what is stored changes otherwise than by the work of the load, over the force: by moving along and turning about a
 * direction, by differences of fourth order. -1: the contact is not of one kind throughout. */
static double off_slope(rig *r, place at, const load *l, tl_vec3 way, tl_vec3 turn, double h)
{
    double stored[4];
    const double steps[4] = {-2 * h, -h, h, 2 * h};
    for (int k = 0; k < 4; k++) {
        tl_quat q = tl_v3_norm(turn) > 0 ? scene_turn(turn, steps[k] * tl_v3_norm(turn)) : none;
        load n = rig_fresh(r, (place){tl_v3_madd(at.u, steps[k], way), tl_q_mul(q, at.q)});
        if (n.kind != l->kind)
            return -1;
        stored[k] = n.stored;
    }
    double slope = (8 * (stored[2] - stored[1]) - (stored[3] - stored[0])) / (12 * h);
    double work = tl_v3_dot(l->f, way) + tl_v3_dot(l->moment, turn);
    return fabs(slope + work) / tl_v3_norm(l->f);
}

/* The worst of all directions, each with the best length of motions; -1: nothing to be seen. */
static double worst_slope(rig *r, place at, double depth, double *worst)
{
    load l = rig_fresh(r, at);
    if (!(tl_v3_norm(l.f) > 0))
        return -1;
    double most = -1;
    for (int k = 0; k < 6; k++) {
        tl_vec3 axis = {k % 3 == 0, k % 3 == 1, k % 3 == 2}, still = {0, 0, 0};
        double best = INFINITY;
        for (size_t i = 0; i < sizeof motions / sizeof *motions; i++) {
            double off = off_slope(r, at, &l, k < 3 ? axis : still, k < 3 ? still : axis, motions[i] * depth);
            if (off >= 0)
                best = fmin(best, off);
        }
        if (best < INFINITY)
            most = fmax(most, best);
    }
    *worst = fmax(*worst, most);
    return most;
}

TEST(edges_press_by_the_slope_of_what_they_store)
{
    double worst = 0;
    int cases = 0;
    for (uint64_t s = 1; s <= (uint64_t)check_cases(130); s++) {
        uint64_t seed = s;
        rig r = rig_of(scene_box_shape(1, 1, 1), roof(), s % 2, s % 3 ? 0 : 0.01);
        double x = 0.5 + scene_between(&seed, -0.35, 0.35), y = scene_between(&seed, -0.4, 0.4);
        double yaw = scene_between(&seed, 0, TL_PI), roll = scene_between(&seed, -0.4, 0.4);
        double tilt = scene_between(&seed, -4, 4) * degree;
        double depth = pow(10, scene_between(&seed, -4, -1.5));
        double off = worst_slope(&r, stand(x, y, yaw, roll, tilt, depth), depth, &worst);
        if (!CHECK(off < SLOPE))
            printf("  seed %d: off by %g\n", (int)s, off);
        cases += off >= 0;
        tl_model_destroy(r.m);
    }
    CHECK(cases > check_least(80));
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  edges: %d cases, off by %.2g\n", cases, worst);
}

TEST(hulls_press_by_the_slope_of_what_they_store)
{
    double worst = 0;
    int cases = 0;
    for (uint64_t s = 1; s <= (uint64_t)check_cases(120); s++) {
        uint64_t seed = s;
        tl_poly *shape[2];
        for (int k = 0; k < 2; k++)
            shape[k] = scene_random_hull(&seed, 12 + s % 8, tl_v3(0.5, 0.45, 0.4));
        scene_pair p =
            scene_pair_of(shape[0], shape[1], scene_any_turn(&seed), tl_v3_scale(1.2, scene_direction(&seed)));
        double depth = pow(10, scene_between(&seed, -4, -1));
        place at = pressed(&p, depth);
        tl_narrow_scratch_free(&p.scratch);
        rig r = rig_of(shape[0], shape[1], s % 2, s % 3 ? 0 : 0.01);
        double off = worst_slope(&r, at, depth, &worst);
        if (!CHECK(off < SLOPE))
            printf("  seed %d: off by %g\n", (int)s, off);
        cases += off >= 0;
        tl_model_destroy(r.m);
    }
    CHECK(cases > check_least(110));
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  hulls: %d cases, off by %.2g\n", cases, worst);
}

/* ---------------------------------------------------------------- jumps ------------------ */

/* Length by which moments compare with forces. */
#define ARM 0.4
/* Steps on a path, share of the path below which what still changes is a jump, and what of the force is looked into: a patch that
 * takes over where faces lie flush knows nothing of the load along their borders, half of their overlap over the root of their
 * area. */
#define STEPS 300
#define INSTANT 1e-12
#define SEEN 1e-3

static double apart(load a, load b)
{
    return fmax(scene_apart(a.f, b.f), scene_apart(a.moment, b.moment) / ARM);
}

/* A path: the place at t from 0 to 1. */
typedef struct motion_path {
    place (*at)(const struct motion_path *, double t);
    place from, to;
    double roll, yaw, along, depth, value[2];
} motion_path;

static place straight(const motion_path *w, double t)
{
    tl_quat d = tl_q_mul(w->to.q, tl_q_conj(w->from.q));
    tl_vec3 v = {d.x, d.y, d.z};
    double angle = 2 * asin(fmin(1, tl_v3_norm(v)));
    tl_quat q = angle > 0 ? tl_q_mul(scene_turn(v, angle * t), w->from.q) : w->from.q;
    return (place){tl_v3_madd(w->from.u, t, tl_v3_sub(w->to.u, w->from.u)), tl_q_unit(q)};
}

/* The largest jump of force and moment on a path, over the largest force; -1 when there is none. `kinds`: kinds met. */
static double worst_jump(rig *r, const motion_path *w, uint32_t *kinds)
{
    load last = rig_fresh(r, w->at(w, 0));
    double worst = 0, most = tl_v3_norm(last.f);
    *kinds = 0;
    for (int i = 0; i < STEPS; i++) {
        double t0 = (double)i / STEPS, t1 = (i + 1.0) / STEPS;
        load l0 = last, l1 = rig_fresh(r, w->at(w, t1));
        last = l1;
        *kinds |= l1.kind == TL_NO_ROW ? 0 : 1u << l1.kind;
        most = fmax(most, tl_v3_norm(l1.f));
        while (t1 - t0 > INSTANT && apart(l0, l1) > fmax(SEEN * most, worst)) {
            double t = 0.5 * (t0 + t1);
            load l = rig_fresh(r, w->at(w, t));
            if (apart(l0, l) > apart(l, l1)) {
                t1 = t;
                l1 = l;
            } else {
                t0 = t;
                l0 = l;
            }
        }
        if (t1 - t0 <= INSTANT)
            worst = fmax(worst, apart(l0, l1));
    }
    return most > 0 ? worst / most : -1;
}

/* The tilt goes from value[0] to value[1], by far slower near 0. */
static place rocking(const motion_path *w, double t)
{
    double x = 2 * t - 1, tilt = x * x * x * w->value[1];
    return stand(w->along, 0.03, w->yaw, w->roll, tilt, w->depth);
}

static place sliding(const motion_path *w, double t)
{
    double s = w->value[0] + (w->value[1] - w->value[0]) * t;
    return stand(0.5 + s * cos(w->yaw), 0.03 + s * sin(w->yaw), w->yaw, w->roll, w->along, w->depth);
}

/* Checks that nothing jumps on a path; what jumps, with the value that tells the path from others. */
static double no_jump(rig *r, const motion_path *w, const char *name, double value, int swapped)
{
    uint32_t kinds;
    double jump = worst_jump(r, w, &kinds);
    if (!CHECK(jump == 0))
        printf("  yaw %g, %s %g, swapped %d: %g\n", w->yaw / degree, name, value, swapped, jump);
    return jump;
}

TEST(an_edge_over_a_border_rocks_without_a_jump)
{
    double worst = 0;
    for (int swapped = 0; swapped < 2; swapped++) {
        rig r = rig_of(scene_box_shape(1, 1, 1), roof(), swapped, 0);
        for (int turn = -3; turn <= 3; turn++)
            for (double along_x = 0.25; along_x < 0.7; along_x += 0.2) {
                motion_path w = {.at = rocking, .along = along_x, .depth = 1e-3};
                w.yaw = 20 * turn * degree;
                w.roll = 3 * (turn + 1) * degree;
                w.value[1] = 6 * degree;
                worst = fmax(worst, no_jump(&r, &w, "middle at", along_x, swapped));
            }
        tl_model_destroy(r.m);
    }
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  rocking: %.3g\n", worst);
}

TEST(an_end_passes_over_a_border_without_a_jump)
{
    const double tilts[] = {-6, -1.5, -0.2, 0.2, 1.5, 6};
    double worst = 0;
    for (int swapped = 0; swapped < 2; swapped++) {
        rig r = rig_of(scene_box_shape(1, 1, 1), roof(), swapped, 0);
        for (int turn = -3; turn <= 3; turn++)
            for (size_t k = 0; k < sizeof tilts / sizeof *tilts; k++) {
                motion_path w = {.at = sliding, .along = tilts[k] * degree, .depth = 5e-3};
                w.yaw = 20 * turn * degree;
                w.roll = 5 * degree;
                w.value[0] = -0.45;
                w.value[1] = 0.35;
                worst = fmax(worst, no_jump(&r, &w, "tilt", tilts[k], swapped));
            }
        tl_model_destroy(r.m);
    }
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  ends: %.3g\n", worst);
}

TEST(hulls_at_random_do_not_jump)
{
    double worst = 0;
    for (uint64_t s = 1; s <= (uint64_t)check_cases(150); s++) {
        uint64_t seed = s;
        tl_poly *shape[2];
        for (int k = 0; k < 2; k++)
            shape[k] = scene_random_hull(&seed, 12 + s % 8, tl_v3(0.5, 0.45, 0.4));
        scene_pair p =
            scene_pair_of(shape[0], shape[1], scene_any_turn(&seed), tl_v3_scale(1.2, scene_direction(&seed)));
        motion_path w = {.at = straight, .from = pressed(&p, scene_between(&seed, 1e-3, 2e-2))};
        p.turn = tl_q_mul(scene_turn(scene_direction(&seed), 4 * degree), p.turn);
        p.shift = tl_v3_madd(p.shift, 0.1, scene_direction(&seed));
        w.to = pressed(&p, scene_between(&seed, 1e-3, 2e-2));
        tl_narrow_scratch_free(&p.scratch);
        rig r = rig_of(shape[0], shape[1], s % 2, s % 3 ? 0 : 0.01);
        uint32_t kinds;
        double jump = worst_jump(&r, &w, &kinds);
        if (!CHECK(jump == 0))
            printf("  seed %d: %g\n", (int)s, jump);
        worst = fmax(worst, jump);
        tl_model_destroy(r.m);
    }
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  hulls: %.3g\n", worst);
}

/* A box lies on a blunt ridge and rocks from one side of it to the other: it lies flush on one side, on the ridge, and on the
 * other side. */
static place over_ridge(const motion_path *w, double t)
{
    double tilt = w->value[0] + (w->value[1] - w->value[0]) * t;
    tl_quat q = scene_turn(tl_v3(0, 0, 1), w->yaw);
    q = tl_q_mul(scene_turn(tl_v3(1, 0, 0), tilt), q);
    return (place){tl_v3_add(tl_v3(0, 0, -w->depth), tl_q_rotate(q, tl_v3(w->along, 0.05, 0.25))), q};
}

TEST(patches_come_in_without_a_jump)
{
    const double depths[] = {1e-4, 5e-4, 3e-3, 1e-2};
    double worst = 0;
    int both = 0;
    for (int slope = 4; slope <= 16; slope += 3)
        for (int turn = 0; turn < 4; turn++)
            for (int deep = 0; deep < 4; deep++) {
                double drop = 0.6 * tan(slope * degree);
                tl_vec3 p[8] = {{-1, 0, 0},       {1, 0, 0},       {-1, -0.6, -drop}, {1, -0.6, -drop},
                                {-1, 0.6, -drop}, {1, 0.6, -drop}, {-1, 0, -1},       {1, 0, -1}};
                rig r = rig_of(scene_hull_shape(p, 8), scene_box_shape(0.6, 0.6, 0.5), turn % 2, 0);
                motion_path w = {.at = over_ridge, .yaw = 0.25 * turn, .depth = depths[deep]};
                w.along = turn % 3 ? 0.1 : 1.27;
                w.value[0] = -(w.value[1] = (slope + 2) * degree);
                uint32_t kinds;
                double jump = worst_jump(&r, &w, &kinds);
                both += kinds == 3;
                if (!CHECK(jump == 0))
                    printf("  slope %d, yaw %g, depth %g: %g\n", slope, w.yaw, w.depth, jump);
                worst = fmax(worst, jump);
                tl_model_destroy(r.m);
            }
    CHECK(both > 10);
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  ridge: %.3g, %d of both kinds\n", worst, both);
}

/* ---------------------------------------------------------------- ties ------------------- */

/* A share of a tilt of TIE over a length of 1, in relation to the depth. */
#define TIE 1e-9
#define TIED 1e-5

/* What turns by TIE about any direction changes nothing, whichever vertex becomes the lowest by it. */
static void check_ties(rig *r, place at)
{
    load middle = rig_fresh(r, at);
    double f = tl_v3_norm(middle.f);
    CHECK(f > 0);
    for (int k = 0; k < 12; k++) {
        double a = TL_PI * k / 6 + 0.1;
        place near = {at.u, tl_q_mul(scene_turn(tl_v3(cos(a), sin(a), 0), TIE), at.q)};
        load l = rig_fresh(r, near);
        CHECK_INT(l.kind, middle.kind);
        CHECK(apart(l, middle) <= TIED * f);
    }
}

TEST(which_vertex_is_the_lowest_does_not_matter)
{
    for (int swapped = 0; swapped < 2; swapped++) {
        /* an edge, over the face and over its border */
        rig r = rig_of(scene_box_shape(1, 1, 1), roof(), swapped, 0);
        check_ties(&r, stand(0, 0.03, 0.3, 0.1, 0, 1e-3));
        check_ties(&r, stand(0.4, 0.03, 0.3, 0.1, 0, 1e-3));
        check_ties(&r, stand(0.45, 0.4, 0.8, 0.1, 0, 1e-3)); /* over a corner */
        tl_model_destroy(r.m);
        /* the hexagon of a prism, on all of it, over a border, and over a corner */
        r = rig_of(scene_box_shape(1, 1, 1), scene_drum(6, 0.3, 0.5, 0.2), swapped, 0);
        check_ties(&r, (place){{0.1, 0, 0.75 - 1e-3}, none});
        check_ties(&r, (place){{0.6, 0, 0.75 - 1e-3}, none});
        check_ties(&r, (place){{0.68, 0.68, 0.75 - 6e-3}, none});
        tl_model_destroy(r.m);
    }
}

/* ---------------------------------------------------------------- minimum area ----------- */

/* U = kn / 2 s^2 (A_e^2 + A_m^2)^(1/2), s the mean overlap. Of the corner of a cube that is in a face by d, s = (3^(1/2) - 1)/2 d
 * and the area A_e = 3 / (3 - 3^(1/2)) d^2. */
static double corner_force(double least, double d)
{
    double s = 0.5 * (sqrt(3) - 1), area = 3 / (3 - sqrt(3)) * d * d;
    double both = sqrt(area * area + least * least);
    return KN * s * s * d * (both + area * area / both);
}

TEST(a_minimum_area_joins_that_of_a_corner)
{
    const double least = 0.01;
    rig r = rig_of(scene_box_shape(4, 4, 1), scene_box_shape(1, 1, 1), false, least);
    tl_vec3 corner = tl_v3_unit(tl_v3(1, 1, 1)), down = {0, 0, -1};
    tl_quat q = scene_turn(tl_v3_cross(corner, down), acos(tl_v3_dot(corner, down)));
    for (double d = 1e-6; d < 0.3; d *= 3) {
        load l = rig_fresh(&r, (place){{0.1, 0.2, 0.5 + sqrt(0.75) - d}, q});
        CHECK_REL(l.f.z, corner_force(least, d), 1e-8);
    }
    tl_model_destroy(r.m);
}

/* The minimum area over that of faces up to which they may be a patch, which does without it. */
#define PATCH 0.05

/* A unit cube's corner over a part of another one's face. */
TEST(a_minimum_area_joins_that_of_a_face)
{
    const double least = 0.01, depth = 1e-5;
    rig r = rig_of(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1), false, least);
    for (double side = 0.03; side < 1; side *= 1.5) {
        load l = rig_fresh(&r, (place){{1 - side, 1 - side, 1 - depth}, none});
        double area = side * side, both = sqrt(area * area + least * least);
        CHECK_INT(l.kind, least > PATCH * area ? TL_FACET_FIELD : TL_FACET_PATCH);
        CHECK_REL(l.f.z, KN * depth * (l.kind == TL_FACET_FIELD ? both : area), 1e-9);
    }
    tl_model_destroy(r.m);
}

TEST_MAIN(RUN(edges_press_by_the_slope_of_what_they_store), RUN(hulls_press_by_the_slope_of_what_they_store),
          RUN(an_edge_over_a_border_rocks_without_a_jump), RUN(an_end_passes_over_a_border_without_a_jump),
          RUN(hulls_at_random_do_not_jump), RUN(patches_come_in_without_a_jump),
          RUN(which_vertex_is_the_lowest_does_not_matter), RUN(a_minimum_area_joins_that_of_a_corner),
          RUN(a_minimum_area_joins_that_of_a_face))
