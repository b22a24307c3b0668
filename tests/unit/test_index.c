/* test_index.c - the lists of the contacts of each block, while contacts come, go and grow, against lists made from
 * nothing. */
#include "contact/index.h"
#include "contact_scene.h"
#include "detect/detect.h"

#define BLOCKS 60
#define STEPS 400
#define WIDTH 5.0 /* m, of the cube in which blocks of about 1 m wander */

static uint32_t partner_of(const tl_contacts *c, uint32_t contact, uint32_t block)
{
    return c->a[contact] == block ? c->b[contact] : c->a[contact];
}

/* Each list has its block's contacts, all of them, ascending by partner. */
static void check_lists(const tl_model *m)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    uint32_t rows = (uint32_t)m->blocks.table.rows, *count = calloc(rows, sizeof *count);
    size_t bare = 0, wrong = 0;
    for (uint32_t i = 0; i < c->table.rows; i++) {
        count[c->a[i]]++;
        count[c->b[i]]++;
        bare += c->point_capacity[i] == 0;
    }
    CHECK_INT(d->by_block_start[0], 0);
    for (uint32_t row = 0; row < rows; row++) {
        uint32_t begin = d->by_block_start[row], end = d->by_block_start[row + 1];
        wrong += end - begin != count[row];
        for (uint32_t e = begin; e < end; e++) {
            uint32_t i = d->by_block[e];
            if (!CHECK(i < c->table.rows))
                continue;
            wrong += c->a[i] != row && c->b[i] != row;
            wrong += e > begin && partner_of(c, i, row) <= partner_of(c, d->by_block[e - 1], row);
        }
    }
    CHECK_INT(wrong, 0);
    CHECK_INT(d->any_without_rows, bare > 0);
    free(count);
}

static tl_vec3 any_place(uint64_t *seed, double half)
{
    return tl_v3(scene_between(seed, -half, half), scene_between(seed, -half, half), scene_between(seed, -half, half));
}

static void add_block(tl_model *m, uint64_t *seed)
{
    tl_vec3 half = {scene_between(seed, 0.3, 0.6), scene_between(seed, 0.3, 0.6), scene_between(seed, 0.3, 0.6)};
    tl_vec3 at = any_place(seed, 0.5 * WIDTH);
    scene_box(m, tl_v3_sub(at, half), tl_v3_add(at, half));
}

/* Moves all blocks a little, back from the walls of their cube. */
static void wander(tl_model *m, uint64_t *seed)
{
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        tl_vec3 by = any_place(seed, 0.02);
        by = tl_v3_madd(by, -0.01 / WIDTH, tl_body_place(&m->bodies, body));
        scene_move(m, body, by, any_place(seed, 0.02));
    }
}

static tl_model *crowd(uint64_t *seed)
{
    tl_model *m = scene_model(1);
    for (int i = 0; i < BLOCKS; i++)
        add_block(m, seed);
    scene_law(m, "elastic", 1e6, 1e6, -1);
    scene_forces(m);
    check_lists(m);
    return m;
}

/* Contacts that began after the last step. */
static size_t begun_now(const tl_model *m)
{
    size_t count = 0;
    for (uint32_t i = 0; i < m->detect->contacts.table.rows; i++)
        count += m->detect->contacts.born[i] == m->cycles;
    return count;
}

TEST(contacts_of_blocks_are_listed)
{
    uint64_t seed = 7;
    tl_model *m = crowd(&seed);
    size_t only_births = 0, several = 0, deaths = 0;
    for (int i = 0; i < STEPS; i++) {
        size_t rows = m->detect->contacts.table.rows;
        m->cycles++;
        wander(m, &seed);
        if (i % 50 == 49)
            add_block(m, &seed);
        scene_forces(m);
        check_lists(m);
        size_t born = begun_now(m), now = m->detect->contacts.table.rows;
        only_births += born > 0 && now == rows + born;
        several += born > 1 && now == rows + born;
        deaths += now < rows + born;
    }
    /* all of that has happened */
    CHECK(only_births > 20 && several > 5 && deaths > 20);
    tl_model_destroy(m);
}

/* Where blocks have come and memory has run out before contacts were listed, whoever asks next gets lists of them, or is
 * refused again. */
TEST(lists_after_a_step_without_memory)
{
    uint64_t seed = 11;
    tl_model *m = crowd(&seed);
    const tl_id a = m->blocks.id[m->detect->contacts.a[0]], b = m->blocks.id[m->detect->contacts.b[0]];
    for (int i = 0; i < 5; i++) {
        add_block(m, &seed);
        m->detect->narrow[0].failed = true; /* as when there is no room for what a contact needs */
        CHECK_INT(tl_detect_refresh(m), TL_E_MEMORY);
        scene_ok(m, tl_detect_refresh(m));
        check_lists(m);
        CHECK(tl_contact_row(m, a, b) != TL_NO_ROW);
    }
    tl_model_destroy(m);
}

TEST_MAIN(RUN(contacts_of_blocks_are_listed), RUN(lists_after_a_step_without_memory))
