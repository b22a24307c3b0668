/* Where wet joints meet (plugins/elements/water/crossings.c): ends that are off, short sides, sides at an angle. */
#include "check.h"

#include "../../plugins/elements/water/crossings.c"

/* Polygons of four corners or fewer, by x, y, z; a NaN ends one early. */
static flow_crossings find(const double (*corners)[4][3], size_t count, double slack, size_t *all)
{
    static tl_vec3 corner[64];
    static uint32_t first[17];
    static double slacks[16];
    uint32_t k = 0;
    for (size_t i = 0; i < count; i++) {
        first[i] = k;
        slacks[i] = slack;
        for (int c = 0; c < 4 && !isnan(corners[i][c][0]); c++)
            corner[k++] = tl_v3(corners[i][c][0], corners[i][c][1], corners[i][c][2]);
    }
    first[count] = k;
    const flow_polygons of = {corner, first, slacks, count};
    flow_crossings found;
    CHECK(flow_crossings_find(&of, &found));
    *all = k;
    return found;
}

/* How many sides, or parts of them, lie at a crossing that is another polygon's, too. */
static size_t count_shared(const flow_crossings *f, size_t all)
{
    size_t shared = 0;
    for (uint32_t i = 0; i < f->first[all]; i++) {
        bool same = false;
        for (uint32_t k = 0; k < f->first[all]; k++)
            same = same || (i != k && f->piece[i].crossing == f->piece[k].crossing);
        shared += same;
    }
    return shared;
}

/* Two squares below meet two above along one line, with ends that are off by less than the slack. */
TEST(ends_within_the_slack_are_one)
{
    static const double squares[4][4][3] = {{{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {0, -1, 0}},
                                            {{1.0005, 0, 0}, {2, 0, 0}, {2, -1, 0}, {1.0005, -1, 0}},
                                            {{0, 0, 0}, {0, 0, 1}, {0.9997, 0, 1}, {0.9997, 0, 0}},
                                            {{1.0001, 0, 0}, {1.0001, 0, 1}, {2, 0, 1}, {2, 0, 0}}};
    size_t all;
    flow_crossings f = find(squares, 4, 1e-3, &all);
    CHECK_INT(f.first[all], 16); /* none is cut */
    /* two on the line, one each between neighbours, and eight sides of one polygon */
    CHECK_INT(f.count, 2 + 2 + 8);
    CHECK_INT(count_shared(&f, all), 4 + 4);
    flow_crossings_free(&f);
}

/* Sides that are shorter than the slack meet, and stay apart from their neighbours on the line. */
TEST(short_sides_meet)
{
    static const double strips[4][4][3] = {{{0, 0, 0}, {0.01, 0, 0}, {0.01, -1, 0}, {0, -1, 0}},
                                           {{0.01, 0, 0}, {0.02, 0, 0}, {0.02, -1, 0}, {0.01, -1, 0}},
                                           {{0, 0, 0}, {0, 0, 1}, {0.01, 0, 1}, {0.01, 0, 0}},
                                           {{0.01, 0, 0}, {0.01, 0, 1}, {0.02, 0, 1}, {0.02, 0, 0}}};
    size_t all;
    flow_crossings f = find(strips, 4, 0.004, &all);
    CHECK_INT(f.first[all], 16);
    CHECK_INT(f.count, 2 + 2 + 8);
    /* the first short sides below and above are at one crossing, the second ones at another */
    CHECK_INT(f.piece[f.first[0]].crossing, f.piece[f.first[11]].crossing);
    CHECK_INT(f.piece[f.first[4]].crossing, f.piece[f.first[15]].crossing);
    CHECK(f.piece[f.first[0]].crossing != f.piece[f.first[4]].crossing);
    flow_crossings_free(&f);
}

/* So do two that are shorter than both slacks. */
TEST(shortest_sides_meet)
{
    static const double wedges[2][4][3] = {{{0, 0, 0}, {0.01, 0, 0}, {1, -1, 0}, {-1, -1, 0}},
                                           {{0, 0, 0}, {-1, 0, 1}, {1, 0, 1}, {0.01, 0, 0}}};
    size_t all;
    flow_crossings f = find(wedges, 2, 0.008, &all);
    CHECK_INT(f.count, 7);
    CHECK_INT(f.piece[f.first[0]].crossing, f.piece[f.first[7]].crossing);
    flow_crossings_free(&f);
}

/* A corner that is cut off within the slack does not bring the sides beside it onto one line. */
TEST(sides_at_an_angle_do_not_meet)
{
    static const double squares[3][4][3] = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                            {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}},
                                            {{1, 0.0005, 0}, {0.9995, 0, 0}, {2, -1, 0}, {NAN, 0, 0}}};
    size_t all;
    flow_crossings f = find(squares, 3, 1e-3, &all);
    CHECK_INT(f.first[all], 11);
    CHECK_INT(f.count, 10);
    CHECK_INT(count_shared(&f, all), 2);
    flow_crossings_free(&f);
}

TEST_MAIN(RUN(ends_within_the_slack_are_one), RUN(short_sides_meet), RUN(shortest_sides_meet),
          RUN(sides_at_an_angle_do_not_meet))
