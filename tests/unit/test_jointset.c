/* test_jointset.c - the statistics of joint sets, discs of finite extent, and what the generators "joint"
 * and "jointset" say about joints that meet nothing. */
#include "base/random.h"
#include "check.h"
#include "model/joints.h"
#include "model/model.h"
#include "values.h"

#include <talus/vmath.h>

enum { SEEDS = 200, PLANES = 15 };

/* A mean is right within three standard errors. */
#define ERRORS 3

static tl_generate_summary generate(tl_model *m, const char *name, const tl_value *values, size_t count)
{
    tl_generate_summary summary = {0};
    tl_args args = {values, count};
    if (!CHECK_INT(tl_generate(m, name, &args, &summary), TL_OK))
        printf("%s\n", tl_model_error(m)->text);
    return summary;
}

static tl_model *model_with_box(int64_t seed, const double *min, const double *max)
{
    tl_model_config config = {.size = sizeof(tl_model_config), .seed = seed, .threads = 1};
    tl_error error;
    tl_model *m;
    if (tl_model_create(&config, &m, &error) != TL_OK)
        exit(1);
    tl_model_log(m, keep_remark, NULL);
    tl_value values[] = {vector("min", min), vector("max", max), number("density", 2000)};
    generate(m, "box", values, 3);
    return m;
}

/* The planes of the joint "J": upward normals, and where each crosses the line through `origin` along
 * `mean`. Returns how many were found. */
static int find_planes(const tl_model *m, tl_vec3 origin, tl_vec3 mean, tl_vec3 *normal, double *offset)
{
    uint32_t wanted = tl_joint_find(m, "J");
    int found = 0;
    for (int k = 0; k < PLANES; k++)
        normal[k] = tl_v3(0, 0, 0);
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        const tl_poly *p = m->blocks.shape[row];
        for (uint32_t f = 0; f < p->face_count; f++) {
            uint32_t k = p->tag[f].plane - 1;
            if (p->tag[f].joint != wanted || k >= PLANES || tl_v3_norm2(normal[k]) > 0)
                continue;
            tl_vec3 n = p->plane[f].normal;
            n = tl_v3_dot(n, mean) > 0 ? n : tl_v3_neg(n);
            tl_vec3 on = tl_model_point(m, m->blocks.body[row], p->vertex[p->loop[p->start[f]]]);
            normal[k] = n;
            offset[k] = tl_v3_dot(n, tl_v3_sub(on, origin)) / tl_v3_dot(n, mean);
            found++;
        }
    }
    return found;
}

typedef struct moments {
    double count, sum, sum2;
} moments;

static void add(moments *s, double x)
{
    s->count++;
    s->sum += x;
    s->sum2 += x * x;
}

/* The mean is within three standard errors of `mean`, the standard deviation within 4 %: about three of
 * its own standard errors for a thousand independent draws of a normal variable, and more of a uniform. */
static void check_moments(const moments *s, double mean, double deviation)
{
    double found = s->sum / s->count;
    CHECK_NEAR(found, mean, ERRORS * deviation / sqrt(s->count));
    CHECK_REL(sqrt(s->sum2 / s->count - found * found), deviation, 0.04);
}

static const double low[3] = {-12, -12, -12}, high[3] = {12, 12, 12}, at[3] = {0.5, -0.25, 1};

/* Gathers the planes of SEEDS models, with dip, direction and gap each in its own moments. */
static void gather(const char *distribution, double spacing_dev, moments *dip, moments *direction, moments *gap)
{
    tl_vec3 mean = tl_plane_normal(35, 140), origin = {at[0], at[1], at[2]}, normal[PLANES];
    double offset[PLANES];
    for (int seed = 1; seed <= SEEDS; seed++) {
        tl_model *m = model_with_box(seed, low, high);
        tl_value values[] = {text("joint", "J"),
                             number("dip", 35),
                             number("dip_dev", 4),
                             number("dip_direction", 140),
                             number("dip_direction_dev", 6),
                             number("spacing", 0.5),
                             number("spacing_dev", spacing_dev),
                             number("number", PLANES),
                             vector("origin", at),
                             text("distribution", distribution)};
        generate(m, "jointset", values, 10);
        CHECK_INT(find_planes(m, origin, mean, normal, offset), PLANES);
        CHECK_NEAR(offset[PLANES / 2], 0, 1e-13);
        for (int k = 0; k < PLANES; k++) {
            add(dip, acos(normal[k].z) * 180 / TL_PI);
            add(direction, atan2(normal[k].x, normal[k].y) * 180 / TL_PI);
            if (k > 0)
                add(gap, offset[k] - offset[k - 1]);
            CHECK(k == 0 || offset[k] > offset[k - 1]);
        }
        tl_model_destroy(m);
    }
}

TEST(uniform_deviations_have_their_moments)
{
    moments dip = {0}, direction = {0}, gap = {0};
    gather("uniform", 0.3, &dip, &direction, &gap);
    check_moments(&dip, 35, 4 / sqrt(3));
    check_moments(&direction, 140, 6 / sqrt(3));
    check_moments(&gap, 0.5, 0.3 / sqrt(3));
}

/* Standard deviation of a unit normal variable cut off at +-c:
 * sqrt(1 - 2 c phi(c) / erf(c / sqrt 2)). */
static double cut_off(double c)
{
    return sqrt(1 - 2 * c * exp(-c * c / 2) / sqrt(2 * TL_PI) / erf(c / sqrt(2)));
}

TEST(normal_deviations_have_their_moments)
{
    moments dip = {0}, direction = {0}, gap = {0}, wide = {0};
    gather("normal", 0.1, &dip, &direction, &gap);
    check_moments(&dip, 35, 4 * cut_off(3));
    check_moments(&direction, 140, 6 * cut_off(3));
    check_moments(&gap, 0.5, 0.1 * cut_off(3));
    /* a gap is cut off where it would vanish, and keeps its mean */
    gather("normal", 0.4, &dip, &direction, &wide);
    check_moments(&wide, 0.5, 0.4 * cut_off(0.5 / 0.4));
}

/* E cos t = coth k - 1/k, E cos^2 t = 1 - 2 (coth k - 1/k) / k; the azimuth is even. */
TEST(fisher_poles_have_their_moments)
{
    tl_vec3 mean = tl_plane_normal(35, 140), origin = {at[0], at[1], at[2]}, normal[PLANES];
    tl_vec3 e = tl_v3_perpendicular(mean), f = tl_v3_cross(mean, e);
    static const double ks[] = {30, 1000};
    for (int n = 0; n < 2; n++) {
        double k = ks[n], offset[PLANES], mu = 1 / tanh(k) - 1 / k;
        double deviation = sqrt(1 - 2 * mu / k - mu * mu), count = 0;
        double sum = 0, sum_e = 0, sum_f = 0;
        for (int seed = 1; seed <= SEEDS; seed++) {
            tl_model *m = model_with_box(seed, low, high);
            tl_value values[] = {
                text("joint", "J"),       number("dip", 35),    number("dip_direction", 140),   number("spacing", 0.5),
                number("number", PLANES), vector("origin", at), text("distribution", "fisher"), number("fisher_k", k)};
            generate(m, "jointset", values, 8);
            CHECK_INT(find_planes(m, origin, mean, normal, offset), PLANES);
            for (int i = 0; i < PLANES; i++) {
                sum += tl_v3_dot(normal[i], mean);
                sum_e += tl_v3_dot(normal[i], e);
                sum_f += tl_v3_dot(normal[i], f);
                count++;
            }
            tl_model_destroy(m);
        }
        CHECK_NEAR(sum / count, mu, ERRORS * deviation / sqrt(count));
        /* each part across the mean has the variance (1 - E cos^2 t) / 2 = mu / k */
        CHECK_NEAR(sum_e / count, 0, ERRORS * sqrt(mu / k / count));
        CHECK_NEAR(sum_f / count, 0, ERRORS * sqrt(mu / k / count));
    }
}

/* What a set drew before there was a choice of distributions stays as it was: 2 u - 1 of the draw keyed
 * by seed, set's name, plane and quantity. */
TEST(uniform_draws_are_those_of_the_keys)
{
    tl_model *m = model_with_box(77, low, high);
    tl_value values[] = {text("joint", "J"),
                         number("dip", 35),
                         number("dip_dev", 4),
                         number("dip_direction", 140),
                         number("dip_direction_dev", 6),
                         number("spacing", 0.5),
                         number("number", PLANES)};
    generate(m, "jointset", values, 7);
    tl_vec3 mean = tl_plane_normal(35, 140), normal[PLANES];
    double offset[PLANES];
    CHECK_INT(find_planes(m, tl_v3(0, 0, 0), mean, normal, offset), PLANES);
    for (int i = 0; i < PLANES; i++) {
        uint64_t key = tl_key(tl_key_text(tl_key(1, 77), "J"), (uint64_t)i + 1);
        double dip = 35 + 4 * (2 * tl_uniform(tl_key(key, 0)) - 1);
        double direction = 140 + 6 * (2 * tl_uniform(tl_key(key, 1)) - 1);
        tl_vec3 expected = tl_plane_normal(dip, direction);
        CHECK(memcmp(&normal[i], &expected, sizeof expected) == 0);
    }
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- discs ------------------ */

/* Distance of (y, z) from the unit square whose lower corner is (i, j). */
static double square_distance(double y, double z, int i, int j)
{
    double dy = fmax(fmax(i - y, y - (i + 1)), 0), dz = fmax(fmax(j - z, z - (j + 1)), 0);
    return sqrt(dy * dy + dz * dz);
}

/* A wall of 8 x 8 columns of unit section is cut by upright discs; a column is cut when the disc
 * reaches into its section. */
TEST(a_disc_cuts_the_blocks_it_reaches_into)
{
    static const double corner[3] = {0, 0, 0}, top[3] = {1, 8, 8}, middle[3] = {0, 4, 4};
    uint64_t seed = 11;
    for (int n = 0; n < 200; n++) {
        tl_model *m = model_with_box(1, corner, top);
        tl_value rows[] = {text("joint", "rows"), number("dip", 90),   number("dip_direction", 0),
                           number("spacing", 1),  number("number", 7), vector("origin", middle)};
        generate(m, "jointset", rows, 6);
        rows[1].number = 0;
        generate(m, "jointset", rows, 6);
        CHECK_INT(tl_block_count(m), 64);
        double center[3] = {0.3 + 0.4 * check_random(&seed), 10 * check_random(&seed) - 1,
                            10 * check_random(&seed) - 1};
        double radius = 0.05 + 4 * check_random(&seed);
        if (n == 0) /* touching a face of a column is not reaching into it */
            center[1] = center[2] = 2, radius = 1;
        size_t expected = 0;
        for (int i = 0; i < 8; i++)
            for (int j = 0; j < 8; j++)
                expected += square_distance(center[1], center[2], i, j) < radius;
        tl_value disc[] = {text("joint", "D"), number("dip", 90), number("dip_direction", 90), vector("origin", center),
                           number("radius", radius)};
        remark[0] = '\0';
        CHECK_INT(generate(m, "joint", disc, 5).cuts, expected);
        CHECK((remark[0] != '\0') == (expected == 0));
        CHECK(n > 0 || expected == 4);
        tl_model_destroy(m);
    }
}

/* A disc inside a block cuts it through; one whose plane falls on a face tags it where it lies. */
TEST(a_disc_cuts_a_block_through_or_falls_on_its_face)
{
    static const double corner[3] = {0, 0, 0}, top[3] = {1, 1, 1}, inside[3] = {0.5, 0.5, 0.5};
    static const double beside[3] = {3, 0.5, 1}, on[3] = {0.5, 0.5, 1};
    tl_model *m = model_with_box(1, corner, top);
    tl_value disc[] = {text("joint", "D"), number("dip", 0), number("dip_direction", 0), vector("origin", inside),
                       number("radius", 1e-3)};
    CHECK_INT(generate(m, "joint", disc, 5).cuts, 1);
    CHECK_NEAR(m->blocks.volume[0], 0.5, 1e-14);
    disc[3] = vector("origin", beside);
    CHECK_INT(generate(m, "joint", disc, 5).coincident, 0);
    disc[3] = vector("origin", on);
    CHECK_INT(generate(m, "joint", disc, 5).coincident, 1);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- mistakes --------------- */

static void refused(tl_model *m, const char *name, const tl_value *values, size_t count, const char *part)
{
    char before[33], after[33];
    size_t joints = m->joint_count;
    CHECK_INT(tl_state_hash(m, before), TL_OK);
    tl_args args = {values, count};
    CHECK(tl_generate(m, name, &args, NULL) != TL_OK);
    CHECK_CONTAINS(tl_model_error(m)->text, part);
    CHECK_INT(tl_state_hash(m, after), TL_OK);
    CHECK_TEXT(after, before);
    CHECK_INT(m->joint_count, joints);
}

TEST(a_joint_that_meets_nothing_is_remarked)
{
    static const double corner[3] = {0, 0, 0}, top[3] = {1, 1, 1}, far[3] = {0, 0, 50};
    static const double inside[3] = {0.5, 0.5, 0.5};
    tl_model *m = model_with_box(1, corner, top);
    tl_value values[] = {text("joint", "J1"),   number("dip", 0),     number("dip_direction", 0),
                         vector("origin", far), number("number", 15), number("spacing", 1)};
    generate(m, "jointset", values, 6);
    CHECK_TEXT(remark, "generator 'jointset': joint set 'J1': none of its 15 planes meets a visible "
                       "block");
    remark[0] = '\0';
    generate(m, "joint", values, 4);
    CHECK_TEXT(remark, "generator 'joint': joint 'J1': its plane meets no visible block");
    CHECK_INT(tl_block_count(m), 1);
    CHECK_INT(m->joints[0].planes, 16);
    /* persistence 0 leaves every block whole, but they were met */
    remark[0] = '\0';
    tl_value missed[] = {text("joint", "J1"), number("dip", 10), number("dip_direction", 0), vector("origin", inside),
                         number("persistence", 0)};
    CHECK_INT(generate(m, "joint", missed, 5).cuts, 0);
    CHECK_TEXT(remark, "");
    tl_model_destroy(m);
}

TEST(mistakes_are_refused)
{
    static const double corner[3] = {0, 0, 0}, top[3] = {1, 1, 1};
    tl_model *m = model_with_box(1, corner, top);
    tl_value v[] = {text("joint", "J"), number("dip", 10), number("dip_direction", 0), number("spacing", 0),
                    number("number", 3)};
    refused(m, "jointset", v, 5, "generator 'jointset': spacing = 0 m must be > 0");
    v[3].number = 1;
    v[4].number = 0;
    refused(m, "jointset", v, 5, "number = 0 is outside [1, 10000]");
    v[4].number = 10001;
    refused(m, "jointset", v, 5, "number = 10001 is outside [1, 10000]");
    v[4] = text("distribution", "fisher");
    refused(m, "jointset", v, 5, "distribution = 'fisher' needs fisher_k");
    v[4] = text("distribution", "norml");
    refused(m, "jointset", v, 5, "did you mean 'normal'?");
    v[4] = number("fisher_k", 10);
    refused(m, "jointset", v, 5, "fisher_k = 10 goes with distribution = 'fisher' only");
    v[4] = number("radius", 0);
    refused(m, "jointset", v, 5, "radius = 0 m must be > 0");
    refused(m, "joint", v, 5, "unknown parameter 'spacing'");
    tl_value f[] = {text("joint", "J"),
                    number("dip", 10),
                    number("dip_direction", 0),
                    number("spacing", 1),
                    text("distribution", "fisher"),
                    number("fisher_k", 0),
                    number("dip_direction_dev", 2)};
    refused(m, "jointset", f, 6, "fisher_k = 0 is outside (0, 1e+09]");
    f[5].number = 10;
    refused(m, "jointset", f, 7, "dip_direction_dev = 2 deg does not go with distribution = 'fisher'");
    tl_model_destroy(m);
}

int main(void)
{
    tl_plugins_load_default();
    RUN(uniform_deviations_have_their_moments);
    RUN(normal_deviations_have_their_moments);
    RUN(fisher_poles_have_their_moments);
    RUN(uniform_draws_are_those_of_the_keys);
    RUN(a_disc_cuts_the_blocks_it_reaches_into);
    RUN(a_disc_cuts_a_block_through_or_falls_on_its_face);
    RUN(a_joint_that_meets_nothing_is_remarked);
    RUN(mistakes_are_refused);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
