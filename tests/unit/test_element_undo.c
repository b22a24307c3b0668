/* test_element_undo.c - a step that a kind of element fails is undone, and made again it goes on to the same bits. */
#include "contact_scene.h"
#include "cycle/prepare.h"
#include "element/life.h"
#include "element/place.h"
#include "element/set.h"
#include "model/joints.h"

#include <talus/elements.h>

/* A spring of 1e5 N/m along z from the ground to a block, which counts its updates in a state. */
static int64_t fails_at = -1; /* update that fails; -1: none */
static _Atomic int64_t asked;

static tl_status place(const tl_element_host *host, const void *params)
{
    const tl_element_node node = {1, {0, 0, 0}, {0, 0, 0}, 1};
    (void)params;
    return host->add(host, &(tl_new_element){.size = sizeof(tl_new_element), .nodes = &node, .count = 1});
}

static tl_status update(const void *self, const tl_element_batch *b, tl_report *report)
{
    (void)self;
    for (uint32_t i = 0; i < b->start[b->count]; i++) {
        b->force[2][i] = -1e5 * b->u[2][i];
        b->state[0][i] += 1;
    }
    snprintf(report->text, sizeof report->text, "it tore");
    return asked++ == fails_at ? TL_E_NUMERIC : TL_OK;
}

static void stiffness(const void *self, const tl_element_batch *b, double *k, double *c)
{
    (void)self, (void)c;
    for (uint32_t i = 0; i < b->start[b->count]; i++)
        k[i] = 1e5;
}

static const tl_element_ops ops = {.size = sizeof ops, .place = place, .update = update, .stiffness = stiffness};
static const tl_state states[] = {TL_STATE(TL_STATE_SCALAR, "updates", "", "how many there were")};
static const tl_kind kind =
    TL_KIND(TL_KIND_ELEMENT, ops, .name = "torn", .doc = "For this test.", TL_KIND_STATES(states));

static tl_model *hanging(void)
{
    tl_model *m = scene_model(1);
    CHECK_INT(tl_model_set_gravity(m, tl_v3(0, 0, -10)), TL_OK);
    scene_box(m, tl_v3(-0.5, -0.5, -0.5), tl_v3(0.5, 0.5, 0.5));
    CHECK(tl_elements_begin(m));
    struct tl_elements *e = m->elements;
    CHECK(tl_grow(&e->set, &e->set_capacity, 1, sizeof *e->set));
    CHECK_INT(tl_element_set_make(&kind, &(tl_args){NULL, 0}, NULL, "torn", &m->error, &e->set[0]), TL_OK);
    CHECK(tl_elements_hold_states(e, 1, 0));
    tl_group_intern(m, "");
    e->set_count = 1;
    tl_placing p;
    tl_placing_begin(&p, m, NULL);
    CHECK_INT(tl_placing_ask(&p, &e->set[0], 0), TL_OK);
    CHECK_INT(tl_placing_commit(&p, 0), TL_OK);
    tl_placing_free(&p);
    asked = 0;
    fails_at = -1;
    return m;
}

TEST(a_step_that_an_element_fails_is_undone)
{
    char hash[2][33], before[33], after[33];
    for (int k = 0; k < 2; k++) {
        tl_model *m = hanging();
        tl_solve_result result;
        scene_ok(m, tl_model_cycle(m, 10, &result));
        if (k == 1) {
            scene_ok(m, tl_state_hash(m, before));
            fails_at = asked;
            CHECK_INT(tl_model_cycle(m, 5, &result), TL_E_NUMERIC);
            CHECK_CONTAINS(tl_model_error(m)->text, "it tore");
            CHECK_CONTAINS(tl_model_error(m)->text, "element 1, 'torn'");
            scene_ok(m, tl_state_hash(m, after));
            CHECK_TEXT(after, before);
            fails_at = -1;
        }
        scene_ok(m, tl_model_cycle(m, 5, &result));
        CHECK(m->elements->nodes.state[0][0] == 15);
        scene_ok(m, tl_state_hash(m, hash[k]));
        tl_model_destroy(m);
    }
    CHECK_TEXT(hash[1], hash[0]);
}

TEST_MAIN(RUN(a_step_that_an_element_fails_is_undone))
