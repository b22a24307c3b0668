/* test_share.c - the point share: blocks that touch by edges and vertices. Force and moment change continuously as an
 * edge that nearly lies on a face rocks, slides and turns over its border, whichever vertex is the lowest; and they are
 * the slope of an energy. Patches beyond contact, and flush ones with little area. */
#include "contact/contacts.h"
#include "contact_scene.h"

#define KN 1e9

static const tl_quat none = {1, 0, 0, 0};

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

/* Force on it, moment about its centroid, energy in the springs. */
typedef struct load {
    tl_vec3 f, moment;
    double area, stored;
} load;

static rig rig_of(tl_poly *still, tl_poly *moved, bool swapped)
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
    return r;
}

static load rig_load(rig *r, place p)
{
    scene_put(r->m, r->swapped ? 0 : 1, tl_v3_sub(p.u, r->start), p.q);
    scene_forces(r->m);
    load l = {0};
    uint32_t c = scene_contact(r->m, 0, 1);
    if (c == TL_NO_ROW)
        return l;
    const tl_contacts *contacts = &r->m->detect->contacts;
    const tl_points_table *points = &r->m->detect->points;
    l.f = tl_v3_scale(r->swapped ? -1 : 1, contacts->force[c]);
    l.moment = tl_contact_moment(r->m, c, !r->swapped);
    l.area = contacts->area[c];
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

/* ---------------------------------------------------------------- jumps ------------------ */

/* Length by which moments compare with forces. */
#define ARM 0.4
/* Steps on a way, share of the way below which what still changes is a jump, and what of the force is looked into. */
#define STEPS 300
#define INSTANT 1e-12
#define SEEN 0.004
/* The common plane jumps where the least overlap passes over to another feature, but what is shared out along it may not.
 * Squared cosine of the angle, 3.1 degrees, within which forces count as along one direction; and the jump that comes
 * of such a turn: 0.055 of the force, and of a moment with a lever of up to 0.5 m. */
#define ALONG2 0.997
#define TURNED 0.07

static double apart(load a, load b)
{
    return fmax(scene_apart(a.f, b.f), scene_apart(a.moment, b.moment) / ARM);
}

static bool along(load a, load b)
{
    double dot = tl_v3_dot(a.f, b.f);
    return dot * dot >= ALONG2 * tl_v3_norm2(a.f) * tl_v3_norm2(b.f);
}

/* A way: the place at t from 0 to 1. */
typedef struct way {
    place (*at)(const struct way *, double t);
    place from, to;
    double roll, yaw, along, depth, value[2];
} way;

static place straight(const way *w, double t)
{
    tl_quat d = tl_q_mul(w->to.q, tl_q_conj(w->from.q));
    tl_vec3 v = {d.x, d.y, d.z};
    double angle = 2 * asin(fmin(1, tl_v3_norm(v)));
    tl_quat q = angle > 0 ? tl_q_mul(scene_turn(v, angle * t), w->from.q) : w->from.q;
    return (place){tl_v3_madd(w->from.u, t, tl_v3_sub(w->to.u, w->from.u)), tl_q_unit(q)};
}

/* The largest jump of force and moment on a way, over the largest force; -1 when there is none. */
static double worst_jump(rig *r, const way *w)
{
    load last = rig_fresh(r, w->at(w, 0));
    double worst = 0, most = tl_v3_norm(last.f);
    for (int i = 0; i < STEPS; i++) {
        double t0 = (double)i / STEPS, t1 = (i + 1.0) / STEPS;
        load l0 = last, l1 = rig_fresh(r, w->at(w, t1));
        last = l1;
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
        if (t1 - t0 <= INSTANT && along(l0, l1))
            worst = fmax(worst, apart(l0, l1));
    }
    return most > 0 ? worst / most : -1;
}

/* ---------------------------------------------------------------- an edge on a face ------ */

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

static const double degree = TL_PI / 180;

/* The tilt goes from value[0] to value[1], by far slower near 0. */
static place rocking(const way *w, double t)
{
    double x = 2 * t - 1, tilt = x * x * x * w->value[1];
    return stand(w->along, 0.03, w->yaw, w->roll, tilt, w->depth);
}

static place sliding(const way *w, double t)
{
    double s = w->value[0] + (w->value[1] - w->value[0]) * t;
    return stand(0.5 + s * cos(w->yaw), 0.03 + s * sin(w->yaw), w->yaw, w->roll, w->along,
                 w->depth);
}

TEST(an_edge_over_a_border_rocks_without_a_jump)
{
    double worst = 0;
    for (int swapped = 0; swapped < 2; swapped++) {
        rig r = rig_of(scene_box_shape(1, 1, 1), roof(), swapped);
        for (int turn = -3; turn <= 3; turn++)
            for (double along_x = 0.25; along_x < 0.7; along_x += 0.2) {
                way w = {.at = rocking, .along = along_x, .depth = 1e-3};
                w.yaw = 20 * turn * degree;
                w.roll = 3 * (turn + 1) * degree;
                w.value[1] = 6 * degree;
                double jump = worst_jump(&r, &w);
                if (!CHECK(jump >= 0 && jump <= TURNED))
                    printf("  yaw %d, middle at %g, swapped %d: %g\n", 20 * turn, along_x, swapped,
                           jump);
                worst = fmax(worst, jump);
            }
        tl_model_destroy(r.m);
    }
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  rocking: %.3g\n", worst);
}

TEST(an_end_passes_over_a_border_without_a_jump)
{
    const double tilts[] = {-6, -3, -1.5, -0.7, -0.2, 0.2, 0.7, 1.5, 3, 6};
    double worst = 0;
    for (int swapped = 0; swapped < 2; swapped++) {
        rig r = rig_of(scene_box_shape(1, 1, 1), roof(), swapped);
        for (int turn = -3; turn <= 3; turn++)
            for (size_t k = 0; k < sizeof tilts / sizeof *tilts; k++) {
                way w = {.at = sliding, .along = tilts[k] * degree, .depth = 5e-3};
                w.yaw = 20 * turn * degree;
                w.roll = 5 * degree;
                w.value[0] = -0.45;
                w.value[1] = 0.35;
                double jump = worst_jump(&r, &w);
                if (!CHECK(jump >= 0 && jump <= TURNED))
                    printf("  yaw %d, tilt %g, swapped %d: %g\n", 20 * turn, tilts[k], swapped,
                           jump);
                worst = fmax(worst, jump);
            }
        tl_model_destroy(r.m);
    }
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  ends: %.3g\n", worst);
}

/* An edge that hangs out over both sides of a box rests on its border whatever of it lies in the face: next to nothing, and
 * not a digit of what does not. */
TEST(an_edge_that_hardly_lies_in_a_face_keeps_its_share)
{
    for (int swapped = 0; swapped < 2; swapped++) {
        rig r = rig_of(scene_box_shape(0.5, 1, 1), roof(), swapped);
        double first = 0;
        for (int k = 2; k <= 15; k++) {
            double tilt = (1 - pow(10, -k)) * degree;
            load l = rig_fresh(&r, stand(0, 0.03, 0.2, 0.1, tilt, 5e-3));
            first = k == 2 ? l.f.z : first;
            CHECK(l.f.z > 0);
            CHECK_NEAR(l.f.z, first, 0.02 * first);
        }
        tl_model_destroy(r.m);
    }
}

/* The unit box, whose top is folded along y by an angle that is hardly there: two faces that are nearly one. */
static tl_poly *folded(double angle)
{
    double rise = 0.25 * tan(angle);
    tl_vec3 p[10] = {{-0.5, -0.5, -0.5}, {0.5, -0.5, -0.5}, {-0.5, 0.5, -0.5}, {0.5, 0.5, -0.5},
                     {-0.5, -0.5, 0.5},  {0.5, -0.5, 0.5},  {-0.5, 0.5, 0.5},  {0.5, 0.5, 0.5},
                     {0, -0.5, 0.5},     {0, 0.5, 0.5}};
    p[8].z = p[9].z = 0.5 + rise;
    return scene_hull_shape(p, 10);
}

/* Ways of the roof's edge on a box that is flat or folded; those with a jump. */
static void random_edges(bool fold, int *ways, int *jumps)
{
    *ways = *jumps = 0;
    for (uint64_t s = 1; s <= 240; s++) {
        uint64_t seed = s;
        tl_poly *box = fold ? folded(0.4 * degree) : scene_box_shape(1, 1, 1);
        rig r = rig_of(box, roof(), s % 2);
        double yaw = scene_between(&seed, 0, TL_PI), roll = scene_between(&seed, -0.4, 0.4);
        double most = (s % 4 < 2 ? 0.9 : 6) * degree, middle = fold ? 0 : 0.5;
        way w = {.at = straight};
        for (int k = 0; k < 2; k++) {
            double x = middle + scene_between(&seed, -0.35, 0.35);
            double y = scene_between(&seed, -0.4, 0.4), tilt = scene_between(&seed, -most, most);
            *(k ? &w.to : &w.from) = stand(x, y, yaw, roll, tilt, scene_between(&seed, 1e-3, 2e-2));
        }
        double jump = worst_jump(&r, &w);
        if (getenv("TALUS_TEST_VERBOSE") && jump > TURNED)
            printf("  seed %d, yaw %.1f, roll %.1f: %.3g\n", (int)s, yaw / degree, roll / degree,
                   jump);
        *ways += jump >= 0;
        *jumps += jump > TURNED;
        tl_model_destroy(r.m);
    }
}

TEST(edges_on_faces_at_random_hardly_jump)
{
    for (int fold = 0; fold < 2; fold++) {
        int ways, jumps;
        random_edges(fold, &ways, &jumps);
        CHECK(ways > 200);
        /* what is left are edges whose end lies at the fold, and which lie only half in the face they come from */
        CHECK(jumps <= (fold ? ways / 10 : 0));
        if (getenv("TALUS_TEST_VERBOSE"))
            printf("  %s: %d ways, %d jumps\n", fold ? "folded" : "edges", ways, jumps);
    }
}

/* A place of b beside a, overlapping by a depth along the axis. */
static place pressed(scene_pair *p, double depth)
{
    scene_press(p, depth);
    tl_vec3 arm = tl_q_rotate(p->turn, tl_poly_mass(p->b).centroid);
    return (place){tl_v3_add(p->shift, arm), p->turn};
}

TEST(hulls_at_random_hardly_jump)
{
    int ways = 0, jumps = 0;
    for (uint64_t s = 1; s <= 300; s++) {
        uint64_t seed = s;
        tl_poly *shape[2];
        for (int k = 0; k < 2; k++)
            shape[k] = scene_random_hull(&seed, 12 + s % 8, tl_v3(0.5, 0.45, 0.4));
        scene_pair p = scene_pair_of(shape[0], shape[1], scene_any_turn(&seed),
                                     tl_v3_scale(1.2, scene_direction(&seed)));
        way w = {.at = straight, .from = pressed(&p, scene_between(&seed, 1e-3, 2e-2))};
        p.turn = tl_q_mul(scene_turn(scene_direction(&seed), 4 * degree), p.turn);
        p.shift = tl_v3_madd(p.shift, 0.1, scene_direction(&seed));
        w.to = pressed(&p, scene_between(&seed, 1e-3, 2e-2));
        tl_narrow_free(&p.room);
        rig r = rig_of(shape[0], shape[1], s % 2);
        double jump = worst_jump(&r, &w);
        if (getenv("TALUS_TEST_VERBOSE") && jump > 0.1)
            printf("  seed %d: %.3g\n", (int)s, jump);
        ways += jump >= 0;
        jumps += jump > 0.1;
        tl_model_destroy(r.m);
    }
    /* several edges and faces within some degrees of each other */
    CHECK(ways == 300);
    CHECK(jumps <= ways / 50);
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  hulls: %d ways, %d jumps\n", ways, jumps);
}

/* ---------------------------------------------------------------- energy ----------------- */

#define LOOP 240 /* steps around a loop */

/* Work of the contact's force and couple on the way round, over the most energy stored; no friction. */
static double loop_work(rig *r, place at, tl_vec3 by[2], tl_vec3 turn[2])
{
    double work = 0, most = 0;
    tl_vec3 u = {0, 0, 0}, h = {0, 0, 0};
    for (int i = 0; i <= LOOP; i++) {
        double a = 2 * TL_PI * i / LOOP, c = cos(a) - 1, s = sin(a);
        tl_vec3 v = tl_v3_madd(tl_v3_scale(c, by[0]), s, by[1]);
        tl_vec3 g = tl_v3_madd(tl_v3_scale(c, turn[0]), s, turn[1]);
        if (i > 0) { /* by the load half-way, where the turn is that of the mean rotation vector */
            place half = {tl_v3_madd(at.u, 0.5, tl_v3_add(u, v)), at.q};
            tl_vec3 mean = tl_v3_scale(0.5, tl_v3_add(g, h)), dg = tl_v3_sub(g, h);
            double angle = tl_v3_norm(mean);
            if (angle > 0)
                half.q = tl_q_mul(scene_turn(mean, angle), at.q);
            load l = rig_fresh(r, half);
            /* spin of a rotation vector that changes: g' + (1 - cos a)/a2 g x g' + ..., */
            tl_vec3 w = tl_v3_madd(dg, 0.5, tl_v3_cross(mean, dg));
            w = tl_v3_madd(w, 1 / 6.0, tl_v3_cross(mean, tl_v3_cross(mean, dg)));
            work += tl_v3_dot(l.f, tl_v3_sub(v, u)) + tl_v3_dot(l.moment, w);
            most = fmax(most, l.stored);
        }
        u = v;
        h = g;
    }
    return most > 0 ? fabs(work) / most : -1;
}

/* Areas fade with tilts, and the couples make up for that: what is left is a circle cut into chords, (2 pi / LOOP)^2 / 12
 * of a few times the energy, and where the common plane jumps on the way. */
#define CHORDS 2e-3

TEST(work_around_a_loop_is_none)
{
    int loops = 0, losing = 0;
    for (uint64_t s = 1; s <= 240; s++) {
        uint64_t seed = s;
        rig r = rig_of(scene_box_shape(1, 1, 1), roof(), s % 2);
        double x = 0.5 + scene_between(&seed, -0.35, 0.35), y = scene_between(&seed, -0.4, 0.4);
        double yaw = scene_between(&seed, 0, TL_PI), roll = scene_between(&seed, -0.4, 0.4);
        double tilt = scene_between(&seed, -4, 4) * degree;
        double depth = scene_between(&seed, 5e-3, 2e-2);
        double by_most = 0.3 * depth, turn_most = (s % 4 < 2 ? 0.1 : 1) * degree;
        tl_vec3 by[2], turn[2];
        for (int k = 0; k < 2; k++) {
            by[k] = tl_v3_scale(by_most, scene_direction(&seed));
            turn[k] = tl_v3_scale(turn_most, scene_direction(&seed));
        }
        double work = loop_work(&r, stand(x, y, yaw, roll, tilt, depth), by, turn);
        if (getenv("TALUS_TEST_VERBOSE") && work > CHORDS)
            printf("  seed %d, yaw %.1f, roll %.1f, tilt %.2f: %.3g\n", (int)s, yaw / degree,
                   roll / degree, tilt / degree, work);
        loops += work >= 0;
        losing += work > CHORDS;
        tl_model_destroy(r.m);
    }
    CHECK(loops > 180);
    CHECK(losing <= loops / 25);
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  %d loops, %d with work\n", loops, losing);
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
        CHECK_REL(l.area, middle.area, TIED);
        CHECK(apart(l, middle) <= TIED * f);
    }
}

TEST(which_vertex_is_the_lowest_does_not_matter)
{
    for (int swapped = 0; swapped < 2; swapped++) {
        /* an edge, over the face and over its border */
        rig r = rig_of(scene_box_shape(1, 1, 1), roof(), swapped);
        check_ties(&r, stand(0, 0.03, 0.3, 0.1, 0, 1e-3));
        check_ties(&r, stand(0.4, 0.03, 0.3, 0.1, 0, 1e-3));
        check_ties(&r, stand(0.45, 0.4, 0.8, 0.1, 0, 1e-3)); /* over a corner */
        tl_model_destroy(r.m);
        /* the hexagon of a prism, on all of it, over a border, and sunk in deep over a corner, which has little area */
        r = rig_of(scene_box_shape(1, 1, 1), scene_drum(6, 0.3, 0.5, 0.2), swapped);
        check_ties(&r, (place){{0.1, 0, 0.75 - 1e-3}, none});
        check_ties(&r, (place){{0.6, 0, 0.75 - 1e-3}, none});
        check_ties(&r, (place){{0.68, 0.68, 0.75 - 6e-3}, none});
        tl_model_destroy(r.m);
    }
}

/* ---------------------------------------------------------------- flush faces ------------ */

/* A unit cube's corner over a part of 0.03 x 0.03 of another one's face, far below the minimum area: next to nothing
 * holds it while it is hardly in, but the minimum area does before it is 2 % in. */
TEST(flush_faces_of_little_area_sink_in_some_percent)
{
    const double side = 0.03, minimum = 0.01;
    rig r = rig_of(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1), false);
    double last = 0;
    for (double depth = 1e-4; depth < 0.028; depth += 1e-4) {
        place at = {{1 - side, 1 - side, 1 - depth}, none};
        load fresh = rig_fresh(&r, at);
        CHECK(fresh.f.z > last);
        if (depth < 0.0049)
            CHECK_REL(fresh.f.z, KN * side * side * depth, 1e-6);
        if (depth > 0.02)
            CHECK_REL(fresh.f.z, KN * minimum * depth, 1e-6);
        last = fresh.f.z;
    }
    /* nor does it matter that it was a patch and nothing else before: it gets its share as it sinks in, in steps of less
     * than a percent of the minimum area */
    rig_fresh(&r, (place){{1 - side, 1 - side, 1 - 1e-4}, none});
    for (double depth = 1e-4; depth < 0.028; depth += 1e-4) {
        place at = {{1 - side, 1 - side, 1 - depth}, none};
        load followed = rig_load(&r, at);
        rig other = rig_of(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1), false);
        CHECK_NEAR(followed.f.z, rig_load(&other, at).f.z, 0.005 * KN * minimum * depth);
        tl_model_destroy(other.m);
    }
    tl_model_destroy(r.m);
}

/* A box lies on a blunt ridge and rocks from one side of it to the other, sunk in so far that it lies on both sides, or
 * less: neither a patch that comes near, with all of its gaps open yet, nor one that is hardly parallel yet takes
 * anything from what stands on the ridge. */
static place over_ridge(const way *w, double t)
{
    double tilt = w->value[0] + (w->value[1] - w->value[0]) * t;
    tl_quat q = scene_turn(tl_v3(0, 0, 1), w->yaw);
    q = tl_q_mul(scene_turn(tl_v3(1, 0, 0), tilt), q);
    return (place){tl_v3_add(tl_v3(0, 0, -w->depth), tl_q_rotate(q, tl_v3(w->along, 0.05, 0.25))),
                   q};
}

TEST(patches_come_in_without_a_jump)
{
    const double depths[] = {5e-4, 3e-3, 1e-2};
    double worst = 0;
    for (int slope = 4; slope <= 16; slope += 3)
        for (int turn = 0; turn < 4; turn++)
            for (int deep = 0; deep < 3; deep++) {
                double drop = 0.6 * tan(slope * degree);
                tl_vec3 p[8] = {{-1, 0, 0},       {1, 0, 0},        {-1, -0.6, -drop},
                                {1, -0.6, -drop}, {-1, 0.6, -drop}, {1, 0.6, -drop},
                                {-1, 0, -1},      {1, 0, -1}};
                rig r = rig_of(scene_hull_shape(p, 8), scene_box_shape(0.6, 0.6, 0.5), turn % 2);
                way w = {.at = over_ridge, .yaw = 0.25 * turn, .depth = depths[deep]};
                w.along = turn % 3 ? 0.1 : 1.27; /* with hardly more than the minimum area */
                w.value[0] = -(w.value[1] = (slope + 2) * degree);
                double jump = worst_jump(&r, &w);
                if (!CHECK(jump >= 0 && jump <= TURNED))
                    printf("  slope %d, yaw %g, depth %g: %g\n", slope, w.yaw, w.depth, jump);
                worst = fmax(worst, jump);
                tl_model_destroy(r.m);
            }
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  ridge: %.3g\n", worst);
}

TEST_MAIN(RUN(an_edge_over_a_border_rocks_without_a_jump),
          RUN(an_end_passes_over_a_border_without_a_jump),
          RUN(an_edge_that_hardly_lies_in_a_face_keeps_its_share),
          RUN(edges_on_faces_at_random_hardly_jump), RUN(hulls_at_random_hardly_jump),
          RUN(work_around_a_loop_is_none), RUN(which_vertex_is_the_lowest_does_not_matter),
          RUN(flush_faces_of_little_area_sink_in_some_percent), RUN(patches_come_in_without_a_jump))
