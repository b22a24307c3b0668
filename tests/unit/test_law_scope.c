/* test_law_scope.c - laws by groups and lists for those who embed: what is given is told again, and what is refused. */
#include "contact_scene.h"

#include <talus/fields.h>

#define BLOCKS 4

static tl_value number(const char *key, double value)
{
    return (tl_value){.key = key, .type = TL_VALUE_NUMBER, .number = value};
}

static tl_status set_law(tl_model *m, const tl_law_scope *scope, double friction)
{
    const tl_value values[] = {number("kn", 1e9), number("ks", 1e9), number("friction", friction)};
    return tl_joint_law_for(m, scope, "coulomb", &(tl_args){values, 3});
}

/* A row of blocks, the first two of which are in a group. */
static tl_model *row_of_blocks(tl_id *ids)
{
    tl_model *m = scene_model(1);
    for (int i = 0; i < BLOCKS; i++) {
        scene_box(m, tl_v3(i, 0, 0), tl_v3(i + 1, 1, 1));
        ids[i] = (tl_id)(i + 1);
    }
    tl_block_set values = tl_block_set_default();
    values.group = "stone";
    CHECK_INT(tl_blocks_set(m, ids, 2, &values), TL_OK);
    return m;
}

static void is_told(tl_model *m, const tl_id *ids)
{
    tl_law_scope scope = tl_law_scope_default(), told;
    CHECK_INT(set_law(m, &scope, 30), TL_OK); /* of all */
    scope.group[0] = "stone";
    scope.blocks[1] = &ids[2];
    scope.block_count[1] = 2;
    CHECK_INT(set_law(m, &scope, 31), TL_OK);
    const tl_contact_name pairs[] = {{ids[1], ids[0], 0}, {ids[2], ids[3], 0}, {ids[0], ids[1], 0}};
    scope = tl_law_scope_default();
    scope.contacts = pairs;
    scope.contact_count = 3;
    CHECK_INT(set_law(m, &scope, 32), TL_OK);
    CHECK_INT((int)tl_law_count(m), 3);
    CHECK_INT(tl_law_names_blocks(m, 0), false);
    CHECK_INT(tl_law_names_blocks(m, 1), true);

    CHECK_INT(tl_law_scope_get(m, 1, &told), TL_OK);
    CHECK_TEXT(told.joint, "*");
    CHECK_TEXT(told.group[0], "stone");
    CHECK_INT((int)told.block_count[1], 2);
    CHECK_INT((int)told.blocks[1][1], (int)ids[3]);
    CHECK_INT(set_law(m, &told, 33), TL_OK); /* the same law */
    tl_law_scope_free(&told);
    CHECK_INT((int)tl_law_count(m), 3);

    CHECK_INT(tl_law_scope_get(m, 2, &told), TL_OK);
    CHECK_INT((int)told.contact_count, 2);
    CHECK_INT((int)told.contacts[0].a, (int)ids[0]);
    CHECK_INT((int)told.contacts[1].b, (int)ids[3]);
    tl_law_scope_free(&told);
}

static void is_refused(tl_model *m, const tl_id *ids)
{
    const size_t laws = tl_law_count(m);
    tl_law_scope scope = tl_law_scope_default();
    scope.group[0] = "stones";
    CHECK_INT(set_law(m, &scope, 30), TL_E_NOT_FOUND);
    CHECK_CONTAINS(tl_model_error(m)->text, "no block is in the group 'stones'; did you mean 'stone'");
    scope.group[0] = "stone";
    scope.blocks[0] = ids;
    scope.block_count[0] = 1;
    CHECK_INT(set_law(m, &scope, 30), TL_E_ARGUMENT);
    scope.group[0] = NULL;
    scope.block_count[0] = 0;
    CHECK_INT(set_law(m, &scope, 30), TL_E_ARGUMENT);
    const tl_id none = 1000;
    scope.blocks[0] = &none;
    scope.block_count[0] = 1;
    CHECK_INT(set_law(m, &scope, 30) != TL_OK, true);
    scope = tl_law_scope_default();
    scope.size = 0;
    CHECK_INT(set_law(m, &scope, 30), TL_E_ARGUMENT);
    CHECK_INT((int)tl_law_count(m), (int)laws);
}

TEST(what_is_given_is_told_again)
{
    tl_id ids[BLOCKS];
    tl_model *m = row_of_blocks(ids);
    is_told(m, ids);
    scene_ok(m, tl_model_cycle(m, 1, NULL));
    tl_model_destroy(m);
}

TEST(what_is_refused_changes_nothing)
{
    tl_id ids[BLOCKS];
    tl_model *m = row_of_blocks(ids);
    is_refused(m, ids);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(what_is_given_is_told_again), RUN(what_is_refused_changes_nothing))
