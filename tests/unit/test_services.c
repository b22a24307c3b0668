/* test_services.c - generators through tl_generate: what they make, how they fail, and that a failure
 * leaves no trace. */
#include "check.h"
#include "geometry/measure.h"
#include "model/joints.h"
#include "model/model.h"
#include "values.h"

static tl_model *model_new(int64_t seed)
{
    tl_model_config config = {.size = sizeof(tl_model_config), .seed = seed, .threads = 1};
    tl_error error;
    tl_model *m;
    if (tl_model_create(&config, &m, &error) != TL_OK)
        exit(1);
    tl_model_log(m, keep_remark, NULL);
    return m;
}

static tl_generate_summary generate(tl_model *m, const char *name, const tl_value *values, size_t count)
{
    tl_generate_summary summary = {0};
    tl_args args = {values, count};
    if (!CHECK_INT(tl_generate(m, name, &args, &summary), TL_OK))
        printf("%s\n", tl_model_error(m)->text);
    return summary;
}

static void box(tl_model *m, const double *min, const double *max)
{
    tl_value values[] = {vector("min", min), vector("max", max), number("density", 2000)};
    generate(m, "box", values, 3);
}

static const double zero[3] = {0, 0, 0}, one[3] = {1, 1, 1}, half[3] = {0.5, 0.5, 0.5};

typedef struct set {
    const char *joint;
    double dip, dip_dev, direction, direction_dev, spacing, spacing_dev, number, persistence;
    const double *origin;
} set;

static tl_generate_summary cut_set(tl_model *m, set s)
{
    tl_value values[] = {text("joint", s.joint),
                         number("dip", s.dip),
                         number("dip_dev", s.dip_dev),
                         number("dip_direction", s.direction),
                         number("dip_direction_dev", s.direction_dev),
                         number("spacing", s.spacing),
                         number("spacing_dev", s.spacing_dev),
                         number("number", s.number),
                         number("persistence", s.persistence),
                         vector("origin", s.origin)};
    return generate(m, "jointset", values, 10);
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

TEST(three_orthogonal_sets_divide_a_cube_exactly)
{
    static const double dx[] = {0.25, 0.25, 0.25, 0.25}, dy[] = {0.3, 0.2, 0.2, 0.3};
    static const double dz[] = {0.3, 0.1, 0.1, 0.1, 0.1, 0.3};
    tl_model *m = model_new(1);
    box(m, zero, one);
    cut_set(m, (set){"x", 90, 0, 90, 0, 0.25, 0, 3, 1, half});
    cut_set(m, (set){"y", 90, 0, 0, 0, 0.2, 0, 3, 1, half});
    tl_generate_summary s = cut_set(m, (set){"z", 0, 0, 0, 0, 0.1, 0, 5, 1, half});
    CHECK_INT(s.before, 16);
    CHECK_INT(s.after, 96);
    CHECK_INT(s.cuts, 80);
    CHECK_INT(s.refused, 0);
    CHECK(s.volume_error <= 1e-14);
    CHECK_INT(tl_block_count(m), 96);
    double expected[96], found[96];
    for (int i = 0; i < 96; i++)
        expected[i] = dx[i % 4] * dy[i / 4 % 4] * dz[i / 16];
    if (tl_block_count(m) == 96) {
        memcpy(found, m->blocks.volume, sizeof found);
        qsort(expected, 96, sizeof *expected, ascending);
        qsort(found, 96, sizeof *found, ascending);
        for (int i = 0; i < 96; i++)
            CHECK_REL(found[i], expected[i], 1e-12);
    }
    tl_model_destroy(m);
}

/* Heights of the horizontal faces of a joint: height[plane], for a model that did not move. */
static void face_heights(const tl_model *m, const char *joint, double *height, size_t planes)
{
    uint32_t wanted = tl_joint_find(m, joint);
    for (size_t i = 0; i <= planes; i++)
        height[i] = NAN;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        const tl_poly *p = m->blocks.shape[row];
        for (uint32_t f = 0; f < p->face_count; f++)
            if (p->tag[f].joint == wanted && p->tag[f].plane <= planes)
                height[p->tag[f].plane] = tl_model_point(m, m->blocks.body[row], tl_poly_face_centroid(p, f)).z;
    }
}

TEST(planes_lie_symmetrically_about_the_origin)
{
    static const double low[3] = {-1, -1, -4}, high[3] = {1, 1, 4}, origin[3] = {0.3, -0.2, 0.25};
    for (int count = 1; count <= 15; count += 7) {
        tl_model *m = model_new(1);
        box(m, low, high);
        cut_set(m, (set){"J", 0, 0, 0, 0, 0.3, 0, count, 1, origin});
        CHECK_INT(tl_block_count(m), count + 1);
        double height[16];
        face_heights(m, "J", height, (size_t)count);
        for (int k = 1; k <= count; k++)
            CHECK_NEAR(height[k], 0.25 + (k - 1 - 0.5 * (count - 1)) * 0.3, 1e-14);
        tl_model_destroy(m);
    }
}

TEST(a_second_call_goes_on_numbering)
{
    static const double low[3] = {0, 0, 0}, high[3] = {1, 1, 10}, origin[3] = {0, 0, 2};
    static const double other[3] = {0, 0, 6};
    tl_model *m = model_new(1);
    box(m, low, high);
    cut_set(m, (set){"J", 0, 0, 0, 0, 0.5, 0, 2, 1, origin});
    cut_set(m, (set){"J", 0, 0, 0, 0, 0.5, 0, 3, 1, other});
    double height[6];
    face_heights(m, "J", height, 5);
    const double expected[] = {1.75, 2.25, 5.5, 6, 6.5};
    for (int k = 0; k < 5; k++)
        CHECK_NEAR(height[k + 1], expected[k], 1e-14);
    CHECK_INT(m->joints[0].planes, 5);
    tl_model_destroy(m);
}

TEST(spacing_deviates_gap_by_gap_within_its_bounds)
{
    static const double low[3] = {-1, -1, -60}, high[3] = {1, 1, 60};
    for (int count = 100; count <= 101; count++) {
        tl_model *m = model_new(5);
        box(m, low, high);
        cut_set(m, (set){"J", 0, 0, 0, 0, 1, 0.4, count, 1, zero});
        double height[102], least = INFINITY, most = 0, sum = 0;
        face_heights(m, "J", height, (size_t)count);
        for (int k = 2; k <= count; k++) {
            double gap = height[k] - height[k - 1];
            least = fmin(least, gap);
            most = fmax(most, gap);
            sum += gap;
        }
        CHECK(least >= 0.6 && least < 0.65);
        CHECK(most <= 1.4 && most > 1.35);
        /* Five standard deviations of the mean of 100 uniform gaps: 5 * 0.4 / sqrt(3 * 100). */
        CHECK_NEAR(sum / (count - 1), 1, 0.12);
        if (count % 2)
            CHECK_NEAR(height[51], 0, 1e-14);
        else
            CHECK_NEAR(height[50] + height[51], 0, 1e-14);
        tl_model_destroy(m);
    }
}

/* Normals of the planes of a joint, in the order of their numbers. */
static void plane_normals(const tl_model *m, const char *joint, tl_vec3 *normal, size_t planes)
{
    uint32_t wanted = tl_joint_find(m, joint);
    memset(normal, 0, (planes + 1) * sizeof *normal);
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        const tl_poly *p = m->blocks.shape[row];
        for (uint32_t f = 0; f < p->face_count; f++)
            if (p->tag[f].joint == wanted && p->tag[f].plane <= planes)
                normal[p->tag[f].plane] = p->plane[f].normal.z > 0 ? p->plane[f].normal : tl_v3_neg(p->plane[f].normal);
    }
}

TEST(attitudes_deviate_and_do_not_depend_on_other_sets)
{
    static const double low[3] = {-10, -10, -10}, high[3] = {10, 10, 10};
    const set wanted = {"B", 30, 10, 120, 20, 0.5, 0.1, 9, 1, zero};
    tl_vec3 alone[10], second[10], other[10];
    tl_model *m = model_new(3);
    box(m, low, high);
    cut_set(m, wanted);
    plane_normals(m, "B", alone, 9);
    tl_model_destroy(m);
    m = model_new(3);
    box(m, low, high);
    cut_set(m, (set){"A", 80, 5, 20, 5, 3, 0.5, 3, 1, zero});
    cut_set(m, wanted);
    plane_normals(m, "B", second, 9);
    CHECK(memcmp(alone, second, sizeof alone) == 0);
    tl_model_destroy(m);
    m = model_new(4);
    box(m, low, high);
    cut_set(m, wanted);
    plane_normals(m, "B", other, 9);
    CHECK(memcmp(alone + 1, other + 1, sizeof *alone) != 0);
    tl_model_destroy(m);
    for (int k = 1; k <= 9; k++) {
        double dip = acos(alone[k].z) * 180 / TL_PI;
        double direction = atan2(alone[k].x, alone[k].y) * 180 / TL_PI;
        CHECK(dip >= 20 && dip <= 40);
        CHECK(direction >= 100 && direction <= 140);
        CHECK(k == 1 || memcmp(alone + k, alone + k - 1, sizeof *alone) != 0);
    }
}

/* A plane through a row of 400 separate blocks. */
TEST(persistence_is_a_probability_for_each_block)
{
    const double persistences[] = {0, 0.3, 1};
    for (int n = 0; n < 3; n++) {
        tl_model *m = model_new(8);
        static const double high[3] = {400, 1, 1}, origin[3] = {200, 0.5, 0.5};
        box(m, zero, high);
        cut_set(m, (set){"columns", 90, 0, 90, 0, 1, 0, 399, 1, origin});
        CHECK_INT(tl_block_count(m), 400);
        tl_generate_summary s = cut_set(m, (set){"J", 0, 0, 0, 0, 1, 0, 1, persistences[n], origin});
        double expected = 400 * persistences[n];
        /* Five standard deviations of the binomial. */
        CHECK_NEAR((double)s.cuts, expected, 5 * sqrt(expected * (1 - persistences[n])));
        tl_model_destroy(m);
    }
}

TEST(hidden_blocks_are_not_cut)
{
    static const double from[3] = {2, 0, 0}, to[3] = {3, 1, 1};
    tl_model *m = model_new(1);
    box(m, zero, one);
    box(m, from, to);
    tl_id first = m->blocks.id[0];
    CHECK_INT(tl_blocks_hide(m, &first, 1, true), TL_OK);
    tl_generate_summary s = cut_set(m, (set){"J", 0, 0, 0, 0, 0.5, 0, 1, 1, half});
    CHECK_INT(s.cuts, 1);
    CHECK_INT(s.after, 3);
    CHECK_INT(tl_block_check(m, first), TL_OK);
    tl_model_destroy(m);
}

TEST(a_polyhedron_is_the_hull_of_its_vertices)
{
    static const double corners[] = {0, 0, 0, 3, 0, 0, 0, 3, 0, 0, 0, 3};
    tl_model *m = model_new(1);
    tl_value values[] = {{.key = "vertices", .type = TL_VALUE_POINTS, .data = corners, .count = 4},
                         number("density", 2400),
                         text("group", "footing")};
    generate(m, "polyhedron", values, 3);
    CHECK_REL(m->blocks.volume[0], 4.5, 1e-14);
    CHECK_TEXT(m->groups[m->blocks.group[0]], "footing");
    CHECK(m->blocks.density[0] == 2400);
    tl_model_destroy(m);
}

/* The call fails with a sentence that contains `part`, and leaves blocks, joints and groups alone. */
static void refused(tl_model *m, const char *name, const tl_value *values, size_t count, const char *part)
{
    size_t blocks = tl_block_count(m), joints = m->joint_count, groups = m->group_count;
    uint32_t planes = joints ? m->joints[0].planes : 0;
    uint64_t structure = m->structure;
    tl_args args = {values, count};
    CHECK(tl_generate(m, name, &args, NULL) != TL_OK);
    CHECK(tl_model_error(m)->status != TL_OK);
    CHECK_CONTAINS(tl_model_error(m)->text, part);
    CHECK_INT(tl_block_count(m), blocks);
    CHECK_INT(m->joint_count, joints);
    CHECK_INT(m->group_count, groups);
    CHECK_INT(joints ? m->joints[0].planes : 0, planes);
    CHECK(m->structure == structure);
}

TEST(mistakes_leave_the_model_as_it_was)
{
    static const double flat[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    tl_model *m = model_new(1);
    box(m, zero, one);
    cut_set(m, (set){"J", 0, 0, 0, 0, 0.5, 0, 1, 1, half});
    refused(m, "bix", NULL, 0, "unknown generator 'bix'; did you mean 'box'? (known: blocks, box, ");
    tl_value upside[] = {vector("min", one), vector("max", zero), number("density", 1)};
    refused(m, "box", upside, 3, "generator 'box' of plugin 'talus.box': max.x = 0 m must be > min.x = 1 m");
    tl_value weightless[] = {vector("min", zero), vector("max", one), number("density", 0)};
    refused(m, "box", weightless, 3, "generator 'box': density = 0 kg/m3 must be > 0");
    tl_value plane[] = {{.key = "vertices", .type = TL_VALUE_POINTS, .data = flat, .count = 4}, number("density", 1)};
    refused(m, "polyhedron", plane, 2, "generator 'polyhedron' of plugin 'talus.polyhedron': ");
    plane[0].count = 3;
    refused(m, "polyhedron", plane, 2, "generator 'polyhedron' of plugin 'talus.polyhedron': ");
    plane[0].count = 0;
    refused(m, "polyhedron", plane, 2, "generator 'polyhedron' of plugin 'talus.polyhedron': ");
    tl_value set_values[] = {text("joint", "K"), number("dip", 10), number("dip_direction", 10), number("spacing", 0.1),
                             number("spacing_dev", 0.1)};
    refused(m, "jointset", set_values, 5,
            "generator 'jointset' of plugin 'talus.jointset': spacing_dev = 0.1 m must be < "
            "spacing = 0.1 m");
    refused(m, "jointset", set_values, 3, "generator 'jointset': parameter 'spacing' is missing");
    set_values[0].text = "K:1";
    refused(m, "joint", set_values, 3, "generator 'joint' of plugin 'talus.joint': joint = 'K:1' is not a name");
    set_values[0].text = "";
    refused(m, "joint", set_values, 3, "generator 'joint' of plugin 'talus.joint': joint = '' is not a name");
    set_values[1].number = 91;
    refused(m, "joint", set_values, 3, "generator 'joint': dip = 91 deg is outside [0, 90]");
    tl_model_destroy(m);
}

TEST(a_generator_that_fails_half_way_leaves_no_trace)
{
    tl_error error = {TL_OK, ""};
    if (!CHECK_INT(tl_plugin_load(TALUS_BAD_PLUGIN_DIR "/half_way.so", &error), TL_OK))
        printf("%s\n", error.text);
    static const char *const modes[] = {"fail", "silent", "normal", "tag", "persistence", "density"};
    static const char *const reasons[] = {"went half way",
                                          "no reason given (status 3: a shape is degenerate",
                                          "which is not of unit length",
                                          "it cuts by plane 2 of joint 1, which it did not ask for",
                                          "persistence = 1.5 is outside [0, 1]",
                                          "density = nan kg/m3 must be > 0"};
    /* In an empty model, and in one with blocks. */
    for (int filled = 0; filled < 2; filled++) {
        tl_model *m = model_new(1);
        if (filled)
            box(m, zero, one);
        for (int i = 0; i < 6; i++) {
            tl_value mode = text("mode", modes[i]);
            char part[200];
            snprintf(part, sizeof part, "generator 'half_way' of plugin 'bad.half_way': ");
            refused(m, "half_way", &mode, 1, part);
            refused(m, "half_way", &mode, 1, reasons[i]);
        }
        CHECK(m->origin_set == (filled != 0));
        tl_model_destroy(m);
    }
}

TEST(the_host_describes_the_blocks_it_holds)
{
    tl_model *m = model_new(1);
    tl_value mode = text("mode", "look");
    refused(m, "half_way", &mode, 1,
            "generator 'half_way' of plugin 'bad.half_way': 2 blocks of volume 6.000000 from "
            "10,10,10 to 11,12,13");
    CHECK_CONTAINS(remark, "generator 'half_way': 2 blocks");
    box(m, zero, one);
    cut_set(m, (set){"J", 90, 0, 90, 0, 0.25, 0, 3, 1, half});
    refused(m, "half_way", &mode, 1,
            "generator 'half_way' of plugin 'bad.half_way': 6 blocks of volume 7.000000 from 0,0,0 "
            "to 11,12,13");
    tl_model_destroy(m);
}

TEST(normals_are_exact_along_the_axes)
{
    tl_vec3 n = tl_plane_normal(90, 90);
    CHECK(n.x == 1 && n.y == 0 && n.z == 0);
    n = tl_plane_normal(90, 270);
    CHECK(n.x == -1 && n.y == 0 && n.z == 0 && !signbit(n.y) && !signbit(n.z));
    n = tl_plane_normal(90, 180);
    CHECK(n.x == 0 && n.y == -1 && n.z == 0);
    n = tl_plane_normal(90, 360);
    CHECK(n.x == 0 && n.y == 1 && n.z == 0);
    n = tl_plane_normal(0, 123);
    CHECK(n.x == 0 && n.y == 0 && n.z == 1);
    uint64_t seed = 6;
    for (int i = 0; i < 1000; i++) {
        double dip = 200 * check_random(&seed) - 50, direction = 800 * check_random(&seed) - 400;
        double d = dip * TL_PI / 180, a = direction * TL_PI / 180;
        n = tl_plane_normal(dip, direction);
        CHECK_NEAR(n.x, sin(d) * sin(a), 1e-14);
        CHECK_NEAR(n.y, sin(d) * cos(a), 1e-14);
        CHECK_NEAR(n.z, cos(d), 1e-14);
        CHECK_NEAR(tl_v3_norm(n), 1, 4e-16);
    }
}

int main(void)
{
    tl_plugins_load_default();
    RUN(three_orthogonal_sets_divide_a_cube_exactly);
    RUN(planes_lie_symmetrically_about_the_origin);
    RUN(a_second_call_goes_on_numbering);
    RUN(spacing_deviates_gap_by_gap_within_its_bounds);
    RUN(attitudes_deviate_and_do_not_depend_on_other_sets);
    RUN(persistence_is_a_probability_for_each_block);
    RUN(hidden_blocks_are_not_cut);
    RUN(a_polyhedron_is_the_hull_of_its_vertices);
    RUN(mistakes_leave_the_model_as_it_was);
    RUN(a_generator_that_fails_half_way_leaves_no_trace);
    RUN(the_host_describes_the_blocks_it_holds);
    RUN(normals_are_exact_along_the_axes);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
