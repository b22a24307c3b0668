/* persistence_properties.c - thousands of seeds: what a set cuts depends on the seed, its name, its
 * planes and the descent of each block, and on nothing else.
 *
 * Two boxes A and B are cut by sets of three planes that cut one block in two of those in their path. What
 * becomes of A must not change with what else is in the model, with what happens to it later, or with the
 * order in which A and B are cut; sets that cut every block divide A alike in any order. */
#include "check.h"
#include "geometry/measure.h"
#include "model/joints.h"
#include "model/model.h"

#include <talus/vmath.h>

enum { SEEDS = 2000, PLANES = 3, MOST = 512 };

/* Cutting a face in parts moves its area by rounding only; a box has the size 1. */
#define AREA_TOLERANCE 1e-12
/* Cutting in another order computes the same corners from other edges. */
#define VOLUME_TOLERANCE 1e-12

typedef struct scene {
    tl_model *model;
    tl_id a, b; /* the boxes while they are whole */
} scene;

static const double corners[3][2][3] = {{{0, 0, 0}, {1, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}, {{0, 0, 2}, {1, 1, 3}}};
static const char *const groups[] = {"a", "b", "c"};

static void generate(tl_model *m, const char *name, const tl_value *values, size_t count)
{
    tl_args args = {values, count};
    if (tl_generate(m, name, &args, NULL) != TL_OK) {
        CHECK(0);
        printf("%s\n", tl_model_error(m)->text);
    }
}

static tl_id add_box(tl_model *m, int which)
{
    tl_value values[] = {{.key = "min", .type = TL_VALUE_NUMBERS, .data = corners[which][0], .count = 3},
                         {.key = "max", .type = TL_VALUE_NUMBERS, .data = corners[which][1], .count = 3},
                         {.key = "density", .type = TL_VALUE_NUMBER, .number = 1000},
                         {.key = "group", .type = TL_VALUE_STRING, .text = groups[which]}};
    generate(m, "box", values, 4);
    return m->blocks.id[m->blocks.table.rows - 1];
}

static scene open_scene(int64_t seed)
{
    tl_model_config config = {.size = sizeof(tl_model_config), .seed = seed, .threads = 1};
    tl_error error;
    scene s;
    if (tl_model_create(&config, &s.model, &error) != TL_OK)
        exit(1);
    s.a = add_box(s.model, 0);
    s.b = add_box(s.model, 1);
    return s;
}

/* Set `which` has an attitude of its own; all pass through A and B. */
static void cut(const scene *s, int which, double persistence)
{
    static const char *const names[] = {"J1", "J2", "J3"};
    static const double dips[] = {25, 70, 85}, directions[] = {80, 200, 330};
    static const double center[3] = {1.5, 0.5, 0.5};
    tl_value values[] = {{.key = "joint", .type = TL_VALUE_STRING, .text = names[which]},
                         {.key = "dip", .type = TL_VALUE_NUMBER, .number = dips[which]},
                         {.key = "dip_dev", .type = TL_VALUE_NUMBER, .number = 5},
                         {.key = "dip_direction", .type = TL_VALUE_NUMBER, .number = directions[which]},
                         {.key = "dip_direction_dev", .type = TL_VALUE_NUMBER, .number = 5},
                         {.key = "spacing", .type = TL_VALUE_NUMBER, .number = 0.4},
                         {.key = "spacing_dev", .type = TL_VALUE_NUMBER, .number = 0.1},
                         {.key = "number", .type = TL_VALUE_NUMBER, .number = PLANES},
                         {.key = "origin", .type = TL_VALUE_NUMBERS, .data = center, .count = 3},
                         {.key = "persistence", .type = TL_VALUE_NUMBER, .number = persistence}};
    generate(s->model, "jointset", values, 10);
}

/* The volumes of the blocks of a group, in the order of their ids. */
typedef struct pieces {
    int count;
    double volume[MOST];
} pieces;

static pieces pieces_of(const tl_model *m, const char *group)
{
    pieces p = {0};
    for (uint32_t row = 0; row < m->blocks.table.rows && p.count < MOST; row++)
        if (strcmp(m->groups[m->blocks.group[row]], group) == 0)
            p.volume[p.count++] = m->blocks.volume[row];
    return p;
}

static bool same(const pieces *p, const pieces *q)
{
    return p->count == q->count && memcmp(p->volume, q->volume, (size_t)p->count * sizeof *p->volume) == 0;
}

/* Area of the faces of a joint on the blocks of a group. */
static double joint_area(const tl_model *m, const char *joint, const char *group)
{
    uint32_t wanted = tl_joint_find(m, joint);
    double area = 0;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        const tl_poly *p = m->blocks.shape[row];
        for (uint32_t f = 0; f < p->face_count; f++)
            if (p->tag[f].joint == wanted && strcmp(m->groups[m->blocks.group[row]], group) == 0)
                area += tl_poly_face_area(p, f);
    }
    return area;
}

static void hide(const scene *s, tl_id block, bool hidden)
{
    CHECK_INT(tl_blocks_hide(s->model, &block, 1, hidden), TL_OK);
}

TEST(later_sets_change_no_earlier_cut)
{
    int cut_at_all = 0;
    for (int seed = 1; seed <= SEEDS; seed++) {
        scene s = open_scene(seed);
        cut(&s, 0, 0.5);
        double before = joint_area(s.model, "J1", "a");
        cut(&s, 1, 0.5);
        cut(&s, 2, 0.5);
        CHECK_NEAR(joint_area(s.model, "J1", "a"), before, AREA_TOLERANCE * (1 + before));
        cut_at_all += before > 0;
        tl_model_destroy(s.model);
    }
    CHECK(cut_at_all > SEEDS / 2 && cut_at_all < SEEDS);
}

TEST(other_blocks_change_no_cut)
{
    int differ = 0;
    for (int seed = 1; seed <= SEEDS; seed++) {
        scene s = open_scene(seed);
        cut(&s, 0, 0.5);
        cut(&s, 1, 0.5);
        pieces a = pieces_of(s.model, "a"), b = pieces_of(s.model, "b");
        tl_model_destroy(s.model);
        differ += a.count != b.count;

        s = open_scene(seed);
        CHECK_INT(tl_blocks_delete(s.model, &s.b, 1), TL_OK);
        add_box(s.model, 2);
        cut(&s, 0, 0.5);
        cut(&s, 1, 0.5);
        pieces alone = pieces_of(s.model, "a");
        CHECK(same(&alone, &a));
        tl_model_destroy(s.model);
    }
    /* the boxes are not cut alike, or nothing was shown */
    CHECK(differ > SEEDS / 4);
}

TEST(separate_blocks_are_cut_in_any_order)
{
    for (int seed = 1; seed <= SEEDS; seed++) {
        pieces a[2], b[2];
        for (int order = 0; order < 2; order++) {
            scene s = open_scene(seed);
            tl_id second = order == 0 ? s.b : s.a;
            hide(&s, second, true);
            cut(&s, order, 0.5); /* J1 through A, J2 through B */
            hide(&s, second, false);
            tl_id *ids;
            size_t count;
            tl_block_filter rest = {
                .size = sizeof(tl_block_filter), .group = order == 0 ? "a" : "b", .fixed = -1, .hidden = -1};
            CHECK_INT(tl_blocks_select(s.model, &rest, &ids, &count), TL_OK);
            CHECK_INT(tl_blocks_hide(s.model, ids, count, true), TL_OK);
            cut(&s, 1 - order, 0.5);
            free(ids);
            a[order] = pieces_of(s.model, "a");
            b[order] = pieces_of(s.model, "b");
            tl_model_destroy(s.model);
        }
        CHECK(same(&a[0], &a[1]));
        CHECK(same(&b[0], &b[1]));
    }
}

static int ascending(const void *left, const void *right)
{
    double x = *(const double *)left, y = *(const double *)right;
    return (x > y) - (x < y);
}

TEST(persistent_sets_divide_alike_in_any_order)
{
    static const int orders[3][3] = {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}};
    for (int seed = 1; seed <= SEEDS / 10; seed++) {
        pieces p[3];
        for (int n = 0; n < 3; n++) {
            scene s = open_scene(seed);
            for (int k = 0; k < 3; k++)
                cut(&s, orders[n][k], 1);
            p[n] = pieces_of(s.model, "a");
            qsort(p[n].volume, (size_t)p[n].count, sizeof *p[n].volume, ascending);
            tl_model_destroy(s.model);
        }
        for (int n = 1; n < 3; n++) {
            CHECK_INT(p[n].count, p[0].count);
            for (int i = 0; i < p[n].count && i < p[0].count; i++)
                CHECK_NEAR(p[n].volume[i], p[0].volume[i], VOLUME_TOLERANCE);
        }
    }
}

int main(void)
{
    tl_plugins_load_default();
    RUN(later_sets_change_no_earlier_cut);
    RUN(other_blocks_change_no_cut);
    RUN(separate_blocks_are_cut_in_any_order);
    RUN(persistent_sets_divide_alike_in_any_order);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
