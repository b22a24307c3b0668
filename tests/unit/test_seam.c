/* test_seam.c - seams inside bodies of several blocks: which faces are marked, and that a block
 * slides over a seam as over one piece. */
#include "check.h"
#include "geometry/hull.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/polyhedron.h"
#include "geometry/seam.h"

#include <talus/talus.h>
#include <talus/vmath.h>

static tl_error error;

static tl_poly *box(double x0, double x1, double z0, double z1)
{
    tl_poly *p = NULL;
    CHECK_INT(tl_poly_box(tl_v3(x0, 0, z0), tl_v3(x1, 1, z1), &p, &error), TL_OK);
    return p;
}

static unsigned covered(const tl_poly *p)
{
    unsigned n = 0;
    for (uint32_t f = 0; f < p->face_count; f++)
        n += p->covered[f] != 0;
    return n;
}

/* Of these, how many lie on faces that are covered, too. */
static unsigned seams(const tl_poly *p)
{
    unsigned n = 0;
    for (uint32_t f = 0; f < p->face_count; f++)
        n += p->covered[f] == TL_SEAM;
    return n;
}

TEST(equal_boxes_share_one_face)
{
    tl_poly *parts[] = {box(0, 1, 0, 1), box(1, 2, 0, 1)};
    CHECK_INT(tl_poly_mark_seams(parts, 2, &error), TL_OK);
    for (int i = 0; i < 2; i++) {
        CHECK_INT(covered(parts[i]), 1);
        CHECK_INT(seams(parts[i]), 1);
        tl_poly_free(parts[i]);
    }
}

TEST(a_step_covers_only_the_lower_box)
{
    /* the higher box's side is covered by half: it stays a side of the body */
    tl_poly *parts[] = {box(0, 1, 0, 1), box(1, 2, 0, 2)};
    CHECK_INT(tl_poly_mark_seams(parts, 2, &error), TL_OK);
    CHECK_INT(covered(parts[0]), 1);
    CHECK_INT(covered(parts[1]), 0);
    CHECK_INT(seams(parts[0]), 0);
    for (int i = 0; i < 2; i++)
        tl_poly_free(parts[i]);
}

TEST(two_boxes_cover_the_side_of_a_third)
{
    tl_poly *parts[] = {box(0, 1, 0, 2), box(1, 2, 0, 1), box(1, 2, 1, 2)};
    CHECK_INT(tl_poly_mark_seams(parts, 3, &error), TL_OK);
    CHECK_INT(covered(parts[0]), 1);
    CHECK_INT(covered(parts[1]), 2);
    CHECK_INT(covered(parts[2]), 2);
    CHECK_INT(seams(parts[0]), 1);
    CHECK_INT(seams(parts[1]), 2);
    for (int i = 0; i < 3; i++)
        tl_poly_free(parts[i]);
}

/* Whether a box and one on it, `thick` high, lie on each other: `gap` apart, `off` along x and leaning by `lean` about y. Seams are
 * marked where they fit. */
static bool lies_on(double gap, double off, double lean, double thick)
{
    tl_poly *parts[] = {box(0, 1, -thick, 0), NULL}, *on = box(off, off + 1, gap, gap + thick);
    const tl_mat3 turn = {{{cos(lean), 0, sin(lean)}, {0, 1, 0}, {-sin(lean), 0, cos(lean)}}};
    CHECK_INT(tl_poly_transformed(on, &turn, tl_v3(0, 0, 0), &parts[1], &error), TL_OK);
    CHECK_INT(tl_poly_mark_seams(parts, 2, &error), TL_OK);
    bool fits = gap == 0 && off == 0 && lean == 0;
    double area[2];
    for (int i = 0; i < 2; i++) {
        CHECK_INT(covered(parts[i]), fits);
        CHECK(tl_poly_shared_area(parts[i], i ? 4 : 5, parts[!i], i ? 5 : 4, &area[i]));
    }
    CHECK_INT(area[0] > 0.9, area[1] > 0.9);
    tl_poly_free(on);
    for (int i = 0; i < 2; i++)
        tl_poly_free(parts[i]);
    return area[0] > 0.9;
}

TEST(what_was_joined_after_it_had_settled_shows_no_seam)
{
    CHECK(lies_on(0, 0, 0, 1));
    CHECK(lies_on(1e-3, 2e-3, 0, 1));
    CHECK(lies_on(-5e-3, 2e-3, 0, 1));
    CHECK(lies_on(0, 2e-3, 5e-3, 1));
    CHECK(!lies_on(3e-3, 0, 0, 1));
    CHECK(!lies_on(-3e-2, 0, 0, 1));
    CHECK(!lies_on(0, 0, 2e-2, 1));
    /* the outer faces of thin plates on each other look at each other through both */
    tl_poly *plates[] = {box(0, 1, -1e-3, 0), box(0, 1, 0, 1e-3)};
    double area;
    CHECK(tl_poly_shared_area(plates[0], 4, plates[1], 5, &area) && area == 0);
    for (int i = 0; i < 2; i++)
        tl_poly_free(plates[i]);
}

/* ---------------------------------------------------------------- sliding ---------------- */

/* Depth of a point below the outer faces of a part and the planes it has of other parts. */
static double depth_in(const tl_poly *p, tl_vec3 x)
{
    double least = INFINITY;
    for (uint32_t f = 0; f < p->plane_count; f++)
        if (f >= p->face_count || !p->covered[f])
            least = fmin(least, p->plane[f].offset - tl_v3_dot(p->plane[f].normal, x));
    return least;
}

TEST(the_depth_in_the_parts_of_a_box_is_that_in_the_box)
{
    tl_poly *whole = box(0, 2, 0, 1);
    tl_poly *parts[] = {box(0, 0.2, 0, 1), box(0.2, 2, 0, 0.7), box(0.2, 2, 0.7, 1)};
    CHECK_INT(tl_poly_mark_seams(parts, 3, &error), TL_OK);
    CHECK_INT(tl_poly_share_planes(parts, 3, &error), TL_OK);
    for (int i = 0; i < 3; i++) {
        tl_bounds b = tl_poly_bounds(parts[i]);
        for (int k = 0; k < 64; k++) {
            tl_vec3 t = tl_v3((k % 4 + 0.5) / 4, (k / 4 % 4 + 0.5) / 4, (k / 16 + 0.5) / 4);
            tl_vec3 x = tl_v3(b.min.x + t.x * (b.max.x - b.min.x), t.y, b.min.z + t.z * (b.max.z - b.min.z));
            CHECK_NEAR(depth_in(parts[i], x), depth_in(whole, x), 1e-15);
        }
    }
    for (int i = 0; i < 3; i++)
        tl_poly_free(parts[i]);
    tl_poly_free(whole);
}

TEST(a_part_gets_no_plane_that_cuts_it_nor_one_that_is_never_near)
{
    /* an L: the step's upper face cuts the column, and its far end is farther from the column than the column's own side */
    tl_poly *parts[] = {box(0, 0.3, 0, 1), box(0.3, 1, 0, 0.3)};
    CHECK_INT(tl_poly_mark_seams(parts, 2, &error), TL_OK);
    CHECK_INT(tl_poly_share_planes(parts, 2, &error), TL_OK);
    CHECK_INT(parts[0]->plane_count, parts[0]->face_count);
    /* sharing anew changes nothing, nor does a copy lose any */
    CHECK_INT(tl_poly_share_planes(parts, 2, &error), TL_OK);
    tl_poly *copy = tl_poly_copy(parts[1]);
    CHECK_INT(copy->plane_count, parts[1]->plane_count);
    tl_poly_free(copy);
    for (int i = 0; i < 2; i++)
        tl_poly_free(parts[i]);
}

static void make_box(tl_model *m, tl_vec3 min, tl_vec3 max)
{
    const tl_value values[] = {{.key = "min", .type = TL_VALUE_NUMBERS, .data = &min.x, .count = 3},
                               {.key = "max", .type = TL_VALUE_NUMBERS, .data = &max.x, .count = 3},
                               {.key = "density", .type = TL_VALUE_NUMBER, .number = 2000}};
    const tl_args args = {values, 3};
    if (!CHECK_INT(tl_generate(m, "box", &args, NULL), TL_OK))
        printf("%s\n", tl_model_error(m)->text);
}

static void count_remark(void *user, const char *text)
{
    *(int *)user += strstr(text, "outer face") != NULL;
}

/* A column of two blocks that overlap by 2e-3, between blocks that are held, has no outer face above or below when it is one body. */
TEST(insitu_feels_no_seam_of_what_was_joined_after_it_had_settled)
{
    int remarks = 0;
    tl_model *m;
    const tl_model_config config = {.size = sizeof(tl_model_config), .seed = 1, .threads = 1};
    CHECK_INT(tl_model_create(&config, &m, &error), TL_OK);
    tl_model_log(m, count_remark, &remarks);
    make_box(m, tl_v3(0, 0, -1), tl_v3(1, 1, 0));
    make_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1.002));
    make_box(m, tl_v3(1e-3, 0, 1), tl_v3(1 + 1e-3, 1, 2));
    make_box(m, tl_v3(0, 0, 2), tl_v3(1, 1, 3));
    const tl_id held[] = {1, 4}, column[] = {2, 3};
    CHECK_INT(tl_blocks_join(m, column, 2), TL_OK);
    const tl_value law[] = {{.key = "kn", .type = TL_VALUE_NUMBER, .number = 1e9},
                            {.key = "ks", .type = TL_VALUE_NUMBER, .number = 1e9},
                            {.key = "friction", .type = TL_VALUE_NUMBER, .number = 30}};
    const tl_args args = {law, 3};
    CHECK_INT(tl_joint_law(m, "*", "coulomb", &args), TL_OK);
    CHECK_INT(tl_blocks_fix(m, held, 2, TL_FIX_ALL), TL_OK);
    tl_insitu insitu = tl_insitu_default();
    insitu.stress.zz = -1e6;
    CHECK_INT(tl_model_insitu(m, &insitu), TL_OK);
    CHECK_INT(remarks, 0);
    tl_model_destroy(m);
}

static double field(tl_model *m, tl_id block, const char *name, int component)
{
    size_t count;
    const tl_field *fields = tl_block_fields(&count);
    tl_field_value value = {{NAN}, NULL};
    for (size_t i = 0; i < count; i++)
        if (strcmp(fields[i].name, name) == 0)
            tl_block_field(m, block, i, &value);
    return value.number[component];
}

/* A smooth block that slides over two joined boxes, or over one of the same size: its velocity along the
 * slide, and the largest change of it met on the way. */
static double slide(int pieces, double kn, double *place)
{
    tl_model *m;
    const tl_model_config config = {
        .size = sizeof(tl_model_config), .gravity = {0, 0, -10}, .seed = 1, .threads = 1, .reuse_geometry = 1};
    CHECK_INT(tl_model_create(&config, &m, &error), TL_OK);
    if (pieces == 2) {
        make_box(m, tl_v3(0, 0, 0), tl_v3(2, 1, 1));
        make_box(m, tl_v3(2, 0, 0), tl_v3(4, 1, 1));
        const tl_id both[] = {1, 2};
        CHECK_INT(tl_blocks_join(m, both, 2), TL_OK);
    } else {
        make_box(m, tl_v3(0, 0, 0), tl_v3(4, 1, 1));
    }
    tl_id slider = (tl_id)pieces + 1, base = 1;
    make_box(m, tl_v3(0.9, 0.3, 1), tl_v3(1.5, 0.7, 1.3));
    const tl_value law[] = {{.key = "kn", .type = TL_VALUE_NUMBER, .number = kn},
                            {.key = "ks", .type = TL_VALUE_NUMBER, .number = kn},
                            {.key = "friction", .type = TL_VALUE_NUMBER, .number = 0}};
    const tl_args args = {law, 3};
    CHECK_INT(tl_joint_law(m, "*", "coulomb", &args), TL_OK);
    CHECK_INT(tl_blocks_fix(m, &base, 1, TL_FIX_ALL), TL_OK);
    tl_block_set set = {
        .size = sizeof(tl_block_set), .density = NAN, .velocity = {0.5, 0, 0}, .angular_velocity = {NAN, NAN, NAN}};
    CHECK_INT(tl_blocks_set(m, &slider, 1, &set), TL_OK);
    double worst = 0;
    tl_solve_result result;
    const int cycles = (int)(10 * sqrt(kn / 1e7));
    const tl_timestep step = {sizeof(tl_timestep), 0.1, TL_TIMESTEP_PAPER, 1e-2 / cycles, 0, 0};
    CHECK_INT(tl_model_timestep(m, &step), TL_OK);
    for (int k = 0; k < 200; k++) {
        CHECK_INT(tl_model_cycle(m, cycles, &result), TL_OK);
        worst = fmax(worst, fabs(field(m, slider, "velocity", 0) - 0.5));
    }
    *place = field(m, slider, "displacement", 0);
    tl_model_destroy(m);
    return worst;
}

/* Slides over a seam, with a change of velocity of at most `change`, m/s, for the 2 s it takes. */
static void check_slide(double kn, double change)
{
    double one, two;
    CHECK_NEAR(slide(1, kn, &one), 0, 1e-9);
    CHECK_NEAR(slide(2, kn, &two), 0, change);
    CHECK_NEAR(one, 1.0, 1e-3);
    CHECK_NEAR(two, one, 2 * change);
}

/* Whether a box and one on it hang together, `gap` apart and leaning by `lean` about y, of sizes of `unit`, in either order. */
static bool hang_together(double gap, double lean, double unit)
{
    uint32_t label[2][2];
    tl_poly *low = box(0, 1, -1, 0), *on = box(0.25, 0.75, gap, gap + 1), *part[2];
    const tl_mat3 turn = {
        {{unit * cos(lean), 0, unit * sin(lean)}, {0, unit, 0}, {unit * -sin(lean), 0, unit * cos(lean)}}};
    const tl_mat3 scale = {{{unit, 0, 0}, {0, unit, 0}, {0, 0, unit}}};
    tl_vec3 corner[2][8];
    for (int i = 0; i < 8; i++) {
        corner[0][i] = tl_m3_mul(&scale, low->vertex[i]);
        corner[1][i] = tl_m3_mul(&turn, on->vertex[i]);
    }
    for (int k = 0; k < 2; k++)
        CHECK_INT(tl_poly_hull(corner[k], 8, TL_HULL_OF_CORNERS, &part[k], &error), TL_OK);
    tl_poly *const other[2] = {part[1], part[0]};
    CHECK_INT(tl_poly_connected(part, 2, NULL, NULL, label[0], &error), TL_OK);
    CHECK_INT(tl_poly_connected(other, 2, NULL, NULL, label[1], &error), TL_OK);
    CHECK_INT(label[0][0] == label[0][1], label[1][0] == label[1][1]);
    bool together = label[0][0] == label[0][1];
    tl_poly *const all[4] = {low, on, part[0], part[1]};
    for (int k = 0; k < 4; k++)
        tl_poly_free(all[k]);
    return together;
}

/* Blocks that had settled on each other before they were joined overlap, lean and part a little: their body stays one. */
TEST(parts_hang_together_however_they_had_settled)
{
    for (double unit = 1e-3; unit < 1e4; unit *= 1e3) {
        CHECK(hang_together(0, 0, unit));
        CHECK(hang_together(-8e-3, 0, unit));
        CHECK(!hang_together(-5e-2, 0, unit));
        CHECK(hang_together(8e-4, 0, unit));
        CHECK(!hang_together(5e-3, 0, unit));
        CHECK(hang_together(-1e-3, 8e-3, unit));
        CHECK(hang_together(1e-3, 8e-3, unit)); /* by the edge that is down */
        CHECK(!hang_together(-1e-3, 2e-2, unit));
    }
}

TEST(a_block_slides_over_a_seam_as_over_one_piece)
{
    check_slide(1e8, 1e-9);
    check_slide(1e9, 1e-9);
}

/* In by up to 1.2 mm. While less of the block lies on the next piece than some 200 times that is wide, the piece presses as
 * the field does, whose energy is less than that of a patch by kn o^3 / 12 for each metre of its edges: that much kinetic
 * energy the block has more, at the most, until it is over. */
TEST(a_block_slides_over_a_seam_on_a_soft_joint)
{
    const double kn = 1e7, mass = 144, overlap = 2 * mass * 10 / (kn * 0.24), edges = 2.0;
    check_slide(kn, kn * edges * overlap * overlap * overlap / 12 / (mass * 0.5));
}

int main(void)
{
    tl_plugins_load_default();
    RUN(equal_boxes_share_one_face);
    RUN(a_step_covers_only_the_lower_box);
    RUN(two_boxes_cover_the_side_of_a_third);
    RUN(what_was_joined_after_it_had_settled_shows_no_seam);
    RUN(insitu_feels_no_seam_of_what_was_joined_after_it_had_settled);
    RUN(the_depth_in_the_parts_of_a_box_is_that_in_the_box);
    RUN(a_part_gets_no_plane_that_cuts_it_nor_one_that_is_never_near);
    RUN(parts_hang_together_however_they_had_settled);
    RUN(a_block_slides_over_a_seam_as_over_one_piece);
    RUN(a_block_slides_over_a_seam_on_a_soft_joint);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
