/* test_held.c - contacts between bodies that are held still: passed over once they rest, as if they had been followed. */
#include "contact/contacts.h"
#include "contact/store.h"
#include "contact_scene.h"
#include "cycle/cycle.h"
#include "cycle/cycle_data.h"
#include "detect/detect.h"

#include <stdatomic.h>
#include <string.h>

#define SIDE 4 /* blocks along an edge of the wall */
#define BLOCKS (SIDE * SIDE * SIDE)

static tl_id id_of(const tl_model *m, size_t row)
{
    return m->blocks.id[row];
}

static void fix(tl_model *m, size_t row)
{
    tl_id id = id_of(m, row);
    scene_ok(m, tl_blocks_fix(m, &id, 1, TL_FIX_ALL));
}

static void let_go(tl_model *m, size_t row)
{
    tl_id id = id_of(m, row);
    scene_ok(m, tl_blocks_free(m, &id, 1));
}

/* Unit cubes a little into each other, all but those on top held, under coulomb and gravity that leans. Aside stand two
 * held ones, onto which another falls. */
static tl_model *wall(int64_t threads)
{
    tl_model *m = scene_model(threads);
    for (int z = 0; z < SIDE; z++)
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                tl_vec3 at = {0.9999 * x, 0.9998 * y, 0.9997 * z};
                scene_box(m, at, tl_v3_add(at, tl_v3(1, 1, 1)));
            }
    for (int z = 0; z < 3; z++) {
        tl_vec3 at = {-9, 0, z < 2 ? 0.9997 * z : 2.1};
        scene_box(m, at, tl_v3_add(at, tl_v3(1, 1, 1)));
    }
    scene_law(m, "coulomb", 1e8, 1e8, 30);
    scene_ok(m, tl_model_damping(m, "local", NULL));
    m->config.gravity = tl_v3(2, 1, -9);
    for (size_t row = 0; row < BLOCKS - SIDE * SIDE; row++)
        fix(m, row);
    fix(m, BLOCKS);
    fix(m, BLOCKS + 1);
    return m;
}

static size_t resting_points(const tl_model *m)
{
    size_t points = 0;
    const tl_layout *layout = &m->detect->layout;
    for (size_t r = 0; r < layout->span_count; r++)
        if (tl_span_rests(m, &layout->spans[r]))
            points += layout->spans[r].end - layout->spans[r].begin;
    return points;
}

/* What a user does between steps: the same to both twins. */
static void meddle(tl_model *m, uint64_t seed)
{
    size_t row = (size_t)(check_random(&seed) * BLOCKS);
    tl_id id = id_of(m, row);
    tl_vec3 v = tl_v3_scale(0.1, scene_direction(&seed));
    switch ((int)(check_random(&seed) * 8)) {
    case 0:
    case 1: fix(m, row); break;
    case 2:
    case 3: let_go(m, row); break;
    case 4:
        scene_ok(
            m, tl_blocks_drive(m, &id, 1,
                               &(tl_drive){.size = sizeof(tl_drive), .velocity = v, .angular_velocity = tl_v3_neg(v)}));
        break;
    case 5:
        scene_ok(m, tl_blocks_set(m, &id, 1,
                                  &(tl_block_set){.size = sizeof(tl_block_set),
                                                  .density = NAN,
                                                  .velocity = v,
                                                  .angular_velocity = tl_v3(NAN, NAN, NAN)}));
        break;
    case 6: scene_law(m, "coulomb", 1e8 * (1 + check_random(&seed)), 1e8, 20 + 20 * check_random(&seed)); break;
    default:
        scene_ok(m, tl_model_insitu(m, &(tl_insitu){.size = sizeof(tl_insitu),
                                                    .stress = {.xx = -2e5 * check_random(&seed),
                                                               .yy = -1e5,
                                                               .zz = -1e5,
                                                               .xy = 1e5 * check_random(&seed)}}));
    }
}

static void compare(tl_model *m, tl_model *twin)
{
    char one[33], other[33];
    scene_ok(m, tl_state_hash(m, one));
    scene_ok(twin, tl_state_hash(twin, other));
    CHECK(strcmp(one, other) == 0);
    tl_energy e, f;
    tl_model_energy(m, &e);
    tl_model_energy(twin, &f);
    CHECK(memcmp(&e, &f, sizeof e) == 0);
    size_t wrong = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        if (m->bodies.fixed[body]) {
            tl_reaction r = tl_reaction_on(m->cycle, body), s = tl_reaction_on(twin->cycle, body);
            wrong += memcmp(&r, &s, sizeof r) != 0;
        }
    for (uint32_t i = 0; i < m->detect->contacts.table.rows; i++)
        wrong += memcmp(&m->detect->contacts.force[i], &twin->detect->contacts.force[i], sizeof(tl_vec3)) != 0;
    CHECK_INT(wrong, 0);
}

/* A model that passes contacts over and one that is made to follow all of them in every step are the same to the bit,
 * through whatever is done to them between steps. */
TEST(at_rest_is_as_followed)
{
    tl_model *m = wall(1), *twin = wall(3);
    uint64_t seed = 3;
    size_t rested = 0, idle = 0, steps = 0;
    for (int turn = 0; turn < 60; turn++) {
        int count = 1 + (int)(12 * check_random(&seed));
        for (int k = 0; k < count; k++) {
            scene_ok(m, tl_step(m));
            if (twin->detect)
                tl_held_wake(twin);
            scene_ok(twin, tl_step(twin));
            rested += resting_points(m) > 0;
            idle += m->detect->any_idle;
            CHECK_INT(resting_points(twin), 0);
            steps++;
        }
        compare(m, twin);
        uint64_t how = (uint64_t)(1e9 * check_random(&seed));
        meddle(m, how);
        meddle(twin, how);
    }
    CHECK(rested > steps / 3 && idle > steps / 3);
    tl_model_destroy(m);
    tl_model_destroy(twin);
}

/* A block that lands on one whose contacts all rest is borne by it: the reaction that holds that one tells. */
TEST(landing_on_what_rests)
{
    tl_model *m = wall(1), *twin = wall(1);
    uint32_t under = BLOCKS + 1;
    bool idle = false, borne = false;
    for (int k = 0; k < 20000 && !borne; k++) {
        scene_ok(m, tl_step(m));
        if (twin->detect)
            tl_held_wake(twin);
        scene_ok(twin, tl_step(twin));
        idle = idle || (m->detect->any_idle && m->detect->idle[m->blocks.body[under]]);
        borne = tl_v3_norm(scene_force(m, under, under + 1)) > 0;
    }
    CHECK(idle && borne);
    compare(m, twin);
    tl_model_destroy(m);
    tl_model_destroy(twin);
}

/* With their geometry made anew in every step none is passed over. */
TEST(recomputed_geometry_is_followed)
{
    tl_model *m = wall(1);
    for (int k = 0; k < 5; k++)
        scene_ok(m, tl_step(m));
    CHECK(resting_points(m) > 0);
    tl_model_set_reuse_geometry(m, false);
    scene_ok(m, tl_step(m));
    CHECK_INT(resting_points(m), 0);
    tl_model_destroy(m);
}

/* A contact that is freed goes on from the force it had: none of it is lost, none comes. */
TEST(freed_contacts_keep_their_forces)
{
    tl_model *m = wall(1);
    for (int k = 0; k < 50; k++)
        scene_ok(m, tl_step(m));
    uint32_t a = 0, b = SIDE * SIDE; /* one above the other */
    tl_vec3 before = scene_force(m, a, b);
    CHECK(tl_v3_norm(before) > 1e4);
    let_go(m, b);
    scene_ok(m, tl_step(m));
    CHECK_NEAR(scene_apart(scene_force(m, a, b), before), 0, 0);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- laws ------------------- */

static atomic_size_t seen_points;
static double until; /* age from which a point no longer changes, s */
static double heat;  /* of a point in a step, J */

/* Counts the points it is given, and how long each has been there. */
static tl_status ageing_update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)self;
    (void)report;
    for (size_t i = 0; i < batch->count; i++) {
        batch->f_n[i] = 1e8 * batch->area[i] * fmax(batch->closure[i], 0);
        batch->dissipated[i] = heat;
        if (batch->area[i] > 0) {
            seen_points++;
            batch->state[0][i] = fmin(batch->state[0][i] + batch->dt, until);
        }
    }
    return TL_OK;
}

static void ageing_stiffness(const void *self, double *kn, double *ks)
{
    (void)self;
    *kn = *ks = 1e8;
}

/* The law of the scene's contacts, with a state. */
static tl_kind ageing_kind(tl_model *m, const tl_law_ops *ops)
{
    static const tl_state states[] = {{.name = "age", .kind = TL_STATE_SCALAR, .transfer = TL_TRANSFER_COPY}};
    tl_kind kind = *m->joint_laws[0].kind;
    kind.states = states;
    kind.state_count = 1;
    kind.state_stride = sizeof *states;
    kind.ops = ops;
    scene_ok(m, tl_detect_refresh(m));
    CHECK(tl_detect_hold_states(m->detect, 1));
    m->joint_laws[0].columns = 1;
    return kind;
}

/* How many points the law was given in a step, after many; and the least age of a point. `warm`: the law makes heat. */
static size_t points_a_step(double age, double warm, double *least, size_t *all)
{
    static const tl_law_ops ops = {.size = sizeof ops, .update = ageing_update, .stiffness = ageing_stiffness};
    tl_model *m = wall(1);
    tl_law *law = &m->joint_laws[0];
    const tl_kind *kind = law->kind;
    tl_kind ageing = ageing_kind(m, &ops);
    law->kind = &ageing;
    until = age;
    heat = warm;
    for (int k = 0; k < 50; k++)
        scene_ok(m, tl_step(m));
    seen_points = 0;
    scene_ok(m, tl_step(m));
    const tl_contacts *c = &m->detect->contacts;
    *least = INFINITY;
    *all = 0;
    for (uint32_t i = 0; i < c->table.rows; i++)
        for (size_t k = 0; k < c->point_count[i] && c->held[i]; k++) {
            size_t at = tl_point_row(c, i, k);
            if (!(m->detect->points.area[at] > 0)) /* the rim of a field contact that has none */
                continue;
            *least = fmin(*least, m->detect->points.state[0][at]);
            ++*all;
        }
    law->kind = kind;
    tl_model_destroy(m);
    return seen_points;
}

/* A law that goes on at rest is asked in every step; one that does not is not asked again, nor one that has ended. */
TEST(laws_that_go_on_are_followed)
{
    double never, ended, on;
    size_t held, free_points = points_a_step(0, 0, &never, &held);
    CHECK(held > 500 && free_points > 50);
    CHECK_NEAR(never, 0, 0);
    CHECK_INT(points_a_step(INFINITY, 0, &on, &held), held + free_points);
    CHECK_INT(points_a_step(0.1 * on, 0, &ended, &held), free_points);
    CHECK_INT(points_a_step(0, 1, &never, &held), held + free_points);
    CHECK_NEAR(ended, 0.1 * on, 0);
}

/* A step that fails while some contacts rest is taken back: what rests has not been kept, and need not be. Under a gravity
 * so large the step fails when forces are known. */
TEST(failed_steps_leave_what_rests)
{
    char before[33], after[33];
    tl_model *m = wall(1);
    tl_vec3 gravity = m->config.gravity;
    for (int k = 0; k < 20; k++)
        scene_ok(m, tl_step(m));
    for (int k = 0; k < 3; k++) {
        CHECK(resting_points(m) > 0);
        m->config.gravity = tl_v3(0, 0, -1e30);
        scene_ok(m, tl_state_hash(m, before));
        CHECK(tl_step(m) != TL_OK);
        scene_ok(m, tl_state_hash(m, after));
        CHECK(strcmp(before, after) == 0);
        m->config.gravity = gravity;
        scene_ok(m, tl_step(m));
    }
    tl_model_destroy(m);
}

TEST_MAIN(RUN(at_rest_is_as_followed), RUN(landing_on_what_rests), RUN(recomputed_geometry_is_followed),
          RUN(freed_contacts_keep_their_forces), RUN(laws_that_go_on_are_followed), RUN(failed_steps_leave_what_rests))
