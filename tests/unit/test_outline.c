/* test_outline.c - the corners of the common polygon of two faces, by which corners lie inside which lines. */
#include "check.h"
#include "narrow/patch_batch.h"

static tl_outline table[TL_OUTLINES];

/* Two squares, corners counter-clockwise from the lower left: A of side 2 about zero, B of half side h about x, y. */
static const tl_outline *squares(double h, double x, double y)
{
    static const double sx[] = {-1, 1, 1, -1}, sy[] = {-1, -1, 1, 1};
    uint64_t inside_a = 0, inside_b = 0;
    for (uint32_t i = 0; i < 4; i++)
        for (uint32_t j = 0; j < 4; j++) {
            double dx = sx[(j + 1) % 4] - sx[j], dy = sy[(j + 1) % 4] - sy[j];
            double ax = sx[i] - (x + h * sx[j]), ay = sy[i] - (y + h * sy[j]);
            double bx = x + h * sx[i] - sx[j], by = y + h * sy[i] - sy[j];
            inside_a |= (uint64_t)(dx * ay - dy * ax >= 0) << (8 * i + j);
            inside_b |= (uint64_t)(dx * by - dy * bx > 0) << (8 * i + j);
        }
    return tl_outline_of(table, 4, 4, inside_a, inside_b);
}

static void own(const tl_outline *o, uint32_t k, uint32_t number)
{
    CHECK_INT(o->corner[k].from, number);
    CHECK_INT(o->corner[k].to, number);
}

static void crossing(const tl_outline *o, uint32_t k, uint32_t from, uint32_t line)
{
    CHECK_INT(o->corner[k].from, from);
    CHECK_INT(o->corner[k].to, (from + 1) % 4);
    CHECK_INT(o->corner[k].over, TL_OUTLINE_CORNERS * line + from);
    CHECK_INT(o->corner[k].under, TL_OUTLINE_CORNERS * line + (from + 1) % 4);
}

TEST(one_square_in_the_other)
{
    const tl_outline *o = squares(0.5, 0.1, 0.1);
    CHECK_INT(o->count, 4);
    for (uint32_t k = 0; k < 4; k++)
        own(o, k, TL_OUTLINE_CORNERS + k);
    o = squares(2, 0.1, 0.1);
    CHECK_INT(o->count, 4);
    for (uint32_t k = 0; k < 4; k++)
        own(o, k, k);
    o = squares(1, 0, 0); /* on each other */
    CHECK_INT(o->count, 4);
    for (uint32_t k = 0; k < 4; k++)
        own(o, k, k);
}

TEST(squares_that_overlap)
{
    const tl_outline *o = squares(1, 0.5, 0.5); /* over a corner */
    CHECK_INT(o->count, 4);
    crossing(o, 0, 1, 0);
    own(o, 1, 2);
    crossing(o, 2, 2, 3);
    own(o, 3, TL_OUTLINE_CORNERS);
    for (uint32_t k = 4; k < TL_OUTLINE_CORNERS; k++)
        CHECK_INT(memcmp(&o->corner[k], &o->corner[0], sizeof o->corner[0]), 0);
    o = squares(1, 0.5, 0); /* along an edge */
    CHECK_INT(o->count, 4);
    crossing(o, 0, 0, 3);
    own(o, 1, 1);
    own(o, 2, 2);
    crossing(o, 3, 2, 3);
}

TEST(signs_without_an_outline)
{
    CHECK_INT(squares(1, 3, 0)->count, 0); /* apart */
    uint64_t seed = 5;
    int found = 0;
    for (int i = 0; i < 20000; i++) { /* of no two squares: nothing, or at least what a polygon could be */
        uint64_t a = (uint64_t)(check_random(&seed) * 4294967296.) & 0x0f0f0f0f;
        uint64_t b = (uint64_t)(check_random(&seed) * 4294967296.) & 0x0f0f0f0f;
        const tl_outline *o = tl_outline_of(table, 4, 4, a, b);
        CHECK(o->count == 0 || (o->count >= 3 && o->count <= TL_OUTLINE_CORNERS));
        CHECK(o->inside_a == a && o->inside_b == b);
        found += o->count > 0;
    }
    CHECK(found < 2000);
}

TEST_MAIN(RUN(one_square_in_the_other), RUN(squares_that_overlap), RUN(signs_without_an_outline))
