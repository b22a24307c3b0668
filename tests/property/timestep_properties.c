/* timestep_properties.c - the time step of many models: cut rock and hulls that touch in all ways, from millimetres to
 * kilometres, with stiffnesses over eight decades.
 *
 * However little its contacts cover, no free body is given a longer step than a contact on FLOOR of its largest face would
 * allow by (27); the step follows units, density and stiffness as it must. Who asks for rates above some limit only gets the same
 * highest one, and of no body less than it asks for. */
#include "contact_scene.h"
#include "cycle/prepare.h"
#include "cycle/timestep.h"
#include "detect/detect.h"
#include "generate/stage.h"
#include "generate/stage_commit.h"
#include "generate/staging.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "model/joints.h"

#define MODELS 300
#define FLOOR 0.15
#define FRACTION 0.4
#define ROUNDING 1e-12
#define UNITS 1e-6 /* contacts are found anew in other units, and rounded otherwise */

/* In what a model is written down, and how heavy and stiff it is. */
typedef struct scale {
    double length, density, stiffness;
} scale;

static const scale as_is = {1, 1, 1};

typedef struct recipe {
    uint64_t seed;
    bool rock;
    double size, density, kn; /* m, kg/m3, Pa/m */
    int32_t rule, rotation;
    double minimum_area;
} recipe;

static recipe draw(uint64_t *seed)
{
    recipe r = {.rock = check_random(seed) < 0.5,
                .size = pow(10, scene_between(seed, -3, 3)),
                .density = pow(10, scene_between(seed, 2, 4)),
                .kn = pow(10, scene_between(seed, 4, 12)),
                .rule = check_random(seed) < 0.7 ? TL_TIMESTEP_BODY : TL_TIMESTEP_PAPER,
                .rotation = check_random(seed) < 0.7 ? TL_ROTATION_EXACT : TL_ROTATION_PAPER,
                .minimum_area = check_random(seed) < 0.5 ? 0 : 0.01};
    r.seed = 1 + (uint64_t)(1e9 * check_random(seed));
    return r;
}

/* A cube cut by planes through its inside. */
static void add_rock(tl_stage *stage, tl_model *m, uint64_t *seed, double size, double density)
{
    double h = 0.5 * size;
    scene_ok(m, tl_stage_add_box(stage, tl_v3(-h, -h, -h), tl_v3(h, h, h), density, "rock"));
    int planes = 3 + (int)(5 * check_random(seed));
    for (int i = 0; i < planes; i++) {
        tl_vec3 at = {scene_between(seed, -h, h), scene_between(seed, -h, h), scene_between(seed, -h, h)};
        tl_tag tag = {1, (uint32_t)i + 1};
        scene_ok(m, stage_cut(stage, scene_direction(seed), at, tag, 1));
    }
}

/* Hulls about the places of a lattice: some apart, some touch by a corner or an edge, some overlap. */
static void add_hulls(tl_stage *stage, tl_model *m, uint64_t *seed, double size, double density)
{
    double r = 0.28 * size;
    for (int i = 0; i < 8; i++) {
        tl_vec3 at = {(i % 2 - 0.5) * 0.5 * size, (i / 2 % 2 - 0.5) * 0.5 * size, (i / 4 - 0.5) * 0.5 * size};
        tl_vec3 half = {r * scene_between(seed, 0.2, 1.1), r * scene_between(seed, 0.2, 1.1),
                        r * scene_between(seed, 0.2, 1.1)};
        tl_poly *p = scene_random_hull(seed, 9, half);
        tl_quat turn = scene_any_turn(seed);
        tl_vec3 points[9];
        for (uint32_t k = 0; k < p->vertex_count; k++)
            points[k] = tl_v3_add(tl_q_rotate(turn, p->vertex[k]), at);
        scene_ok(m, tl_stage_add_hull(stage, points, p->vertex_count, density, "hull"));
        tl_poly_free(p);
    }
}

static tl_model *build(recipe r, scale s)
{
    tl_model *m = scene_model(1);
    uint64_t seed = r.seed;
    double size = r.size * s.length, density = r.density * s.density;
    tl_stage stage;
    m->config.rotation = r.rotation;
    tl_joint_intern(m, "J");
    scene_ok(m, stage_begin(m, &stage));
    (r.rock ? add_rock : add_hulls)(&stage, m, &seed, size, density);
    scene_ok(m, tl_stage_commit(&stage));
    scene_law(m, "elastic", r.kn * s.stiffness, 0.5 * r.kn * s.stiffness, -1);
    scene_ok(m, tl_model_contact_area(m, &(tl_contact_area){sizeof(tl_contact_area), r.minimum_area, NAN, NULL}));
    scene_ok(m, tl_model_timestep(m, &(tl_timestep){sizeof(tl_timestep), FRACTION, r.rule, NAN, 0, 0}));
    tl_id first = m->blocks.id[0];
    if (check_random(&seed) < 0.5)
        scene_ok(m, tl_blocks_fix(m, &first, 1, TL_FIX_ALL));
    return m;
}

/* The step that (27) gives for a body on FLOOR of its largest face: the shortest of the free bodies' and the longest. */
static void face_steps(const tl_model *m, double kn, double *shortest, double *longest)
{
    *shortest = INFINITY;
    *longest = 0;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        uint32_t body = m->blocks.body[row];
        const tl_poly *shape = m->blocks.shape[row];
        double largest = 0;
        for (uint32_t f = 0; f < shape->face_count; f++)
            largest = fmax(largest, tl_poly_face_area(shape, f));
        if (m->bodies.fixed[body] == TL_FIX_ALL && m->bodies.table.rows > 1)
            continue;
        double dt = FRACTION * 2 * sqrt(m->bodies.mass[body] / (2 * kn * FLOOR * largest));
        *shortest = fmin(*shortest, dt);
        *longest = fmax(*longest, dt);
    }
}

static double step_of(tl_model *m)
{
    double dt = 0;
    scene_ok(m, tl_model_dt(m, &dt));
    return dt;
}

static double step_at(recipe r, scale s)
{
    tl_model *m = build(r, s);
    double dt = step_of(m);
    tl_model_destroy(m);
    return dt;
}

TEST(no_step_is_longer_than_its_floor_allows)
{
    uint64_t seed = 5;
    for (int i = 0; i < MODELS; i++) {
        recipe r = draw(&seed);
        tl_model *m = build(r, as_is);
        double shortest, longest;
        face_steps(m, r.kn, &shortest, &longest);
        double dt = step_of(m);
        CHECK(dt > 0 && dt <= shortest * (1 + ROUNDING));
        /* mass scaling makes all as slow as the slowest, which has that bound, too */
        scene_ok(m, tl_model_mass_scaling(m, &(tl_mass_scaling){sizeof(tl_mass_scaling), 1, NAN, NAN}));
        double scaled = step_of(m);
        if (r.rule == TL_TIMESTEP_BODY)
            CHECK(scaled >= dt * (1 - ROUNDING));
        CHECK(scaled > 0 && scaled <= longest * (1 + ROUNDING));
        tl_model_destroy(m);
    }
}

/* In millimetres a density is 1e-9 of that in metres, and a stiffness, kg mm/s2 over mm3, 1e-6. */
TEST(the_step_follows_units_density_and_stiffness)
{
    uint64_t seed = 6;
    for (int i = 0; i < MODELS; i++) {
        recipe r = draw(&seed);
        double dt = step_at(r, as_is);
        CHECK_REL(step_at(r, (scale){1, 4, 1}), 2 * dt, ROUNDING);
        CHECK_REL(step_at(r, (scale){1, 1, 4}), dt / 2, ROUNDING);
        CHECK_REL(step_at(r, (scale){1e3, 1e-9, 1e-6}), dt, UNITS);
        CHECK_REL(step_at(r, (scale){4, 1, 1}), 2 * dt, ROUNDING);
    }
}

/* A block slides off another, along an edge or over a corner, until nothing is left of their contact, and beyond, with
 * contacts that are kept and with contacts found anew: no step is shorter than on the face it stood on, or on its largest. */
TEST(a_contact_that_vanishes_never_makes_the_step_long)
{
    uint64_t seed = 7;
    for (int i = 0; i < MODELS; i++) {
        recipe r = draw(&seed);
        tl_vec3 side = {r.size * scene_between(&seed, 0.2, 1), r.size * scene_between(&seed, 0.2, 1),
                        r.size * scene_between(&seed, 0.2, 1)};
        bool corner = check_random(&seed) < 0.5;
        double depth = 1e-4 * r.size, on_it = 0, shortest, longest;
        tl_model *m = scene_model(1);
        scene_block(m, scene_box_shape(r.size, r.size, r.size), scene_turn(tl_v3(0, 0, 1), 0),
                    tl_v3(0, 0, -0.5 * r.size));
        scene_block(m, scene_box_shape(side.x, side.y, side.z), scene_turn(tl_v3(0, 0, 1), 0),
                    tl_v3(0, 0, 0.5 * side.z - depth));
        scene_law(m, "elastic", r.kn, r.kn, -1);
        scene_ok(m, tl_model_contact_area(m, &(tl_contact_area){sizeof(tl_contact_area), r.minimum_area, NAN, NULL}));
        scene_ok(m, tl_model_timestep(m, &(tl_timestep){sizeof(tl_timestep), FRACTION, r.rule, NAN, 0, 0}));
        scene_ok(m, tl_blocks_fix(m, &m->blocks.id[0], 1, TL_FIX_ALL));
        face_steps(m, r.kn, &shortest, &longest);
        scene_put(m, 1, tl_v3(0, 0, 5 * r.size), scene_turn(tl_v3(0, 0, 1), 0));
        double afloat = step_of(m); /* as on its largest face */
        double off_x = 0.5 * (r.size + side.x), off_y = 0.5 * (r.size + side.y);
        for (double left = 1; left > 1e-15; left *= 0.1) {
            /* the last one stands beside it */
            double kept = left > 2e-15 ? left : -1;
            tl_vec3 at = {off_x - kept * side.x, corner ? off_y - kept * side.y : 0, 0}, dt = {0};
            scene_put(m, 1, at, scene_turn(tl_v3(0, 0, 1), 0));
            scene_ok(m, tl_cycle_prepare(m));
            scene_ok(m, tl_detect_update(m));
            scene_ok(m, tl_timestep_choose(m, &dt.x)); /* from rates that are kept */
            dt.y = step_of(m);                         /* and from rates made anew */
            if (left > 0.5)
                on_it = dt.x;
            double least = fmin(on_it, afloat);
            CHECK(dt.x >= least * (1 - ROUNDING) && dt.x <= shortest * (1 + ROUNDING));
            CHECK(dt.y >= least * (1 - ROUNDING) && dt.y <= shortest * (1 + ROUNDING));
        }
        tl_model_destroy(m);
    }
}

/* Rates of all bodies, those up to `known` from above only. */
static double *rates_of(tl_model *m, double known)
{
    double *rate = calloc(2 * m->bodies.table.rows + 1, sizeof *rate);
    tl_rates_try(m, known, rate, rate + m->bodies.table.rows);
    return rate;
}

TEST(rates_above_a_limit_are_those_of_all)
{
    uint64_t seed = 8;
    int skipped = 0;
    for (int i = 0; i < MODELS; i++) {
        recipe r = draw(&seed);
        tl_model *m = build(r, as_is);
        step_of(m);
        double *exact = rates_of(m, 0);
        tl_row_value highest = tl_rates_anew(m, 0);
        double known = highest.value * pow(10, scene_between(&seed, -2, 1));
        double *told = rates_of(m, known);
        tl_row_value found = tl_rates_anew(m, known);
        CHECK(found.value > known ? found.value == highest.value && found.row == highest.row : highest.value <= known);
        for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
            CHECK(told[body] == exact[body] || (told[body] > exact[body] && told[body] <= known));
            skipped += told[body] > exact[body];
        }
        free(exact);
        free(told);
        tl_model_destroy(m);
    }
    CHECK(skipped > MODELS);
}

TEST_MAIN(RUN(no_step_is_longer_than_its_floor_allows), RUN(the_step_follows_units_density_and_stiffness),
          RUN(a_contact_that_vanishes_never_makes_the_step_long), RUN(rates_above_a_limit_are_those_of_all))
