/* test_principal.c - principal moments and axes. */
#include "check.h"
#include "geometry/measure.h"
#include "geometry/polyhedron.h"

#include <talus/vmath.h>

/* |R diag(moments) R' - tensor| over the trace. */
static double residual(tl_sym3 t, tl_vec3 moments, tl_quat axes)
{
    tl_mat3 r = tl_q_matrix(axes);
    double worst = 0;
    for (int i = 0; i < 3; i++) {
        tl_vec3 axis = {r.m[0][i], r.m[1][i], r.m[2][i]};
        double moment = i == 0 ? moments.x : i == 1 ? moments.y : moments.z;
        tl_vec3 off = tl_v3_madd(tl_s3_mul(t, axis), -moment, axis);
        worst = fmax(worst, tl_v3_norm(off));
    }
    return worst / (t.xx + t.yy + t.zz);
}

static int is_identity(tl_quat q)
{
    return q.w == 1 && q.x == 0 && q.y == 0 && q.z == 0;
}

TEST(diagonal_in_order_is_left_alone)
{
    tl_vec3 m;
    tl_quat q;
    tl_principal_axes((tl_sym3){.xx = 0.1, .yy = 0.7, .zz = 1.3}, &m, &q);
    CHECK(m.x == 0.1 && m.y == 0.7 && m.z == 1.3);
    CHECK(is_identity(q));
    /* Equal moments keep the given axes too, and so do products at the level of rounding. */
    tl_principal_axes((tl_sym3){.xx = 1, .yy = 1, .zz = 1, .xy = 3e-17, .zx = -2e-17}, &m, &q);
    CHECK(m.x == 1 && m.y == 1 && m.z == 1);
    CHECK(is_identity(q));
}

TEST(diagonal_is_only_put_in_order)
{
    static const double value[3] = {0.3, 1.1, 1.2};
    static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int i = 0; i < 6; i++) {
        tl_sym3 t = {.xx = value[order[i][0]], .yy = value[order[i][1]], .zz = value[order[i][2]]};
        tl_vec3 m;
        tl_quat q;
        tl_principal_axes(t, &m, &q);
        CHECK(m.x == 0.3 && m.y == 1.1 && m.z == 1.2);
        CHECK_NEAR(residual(t, m, q), 0, 1e-15);
        CHECK_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-15);
        CHECK(q.w >= 0);
    }
}

/* Tensors made from chosen moments and a random rotation give these moments back. */
TEST(random_tensors)
{
    uint64_t seed = 17;
    for (int i = 0; i < 20000; i++) {
        double spread = pow(10, -4 * check_random(&seed));
        double a = spread * check_random(&seed), b = check_random(&seed);
        /* Every fourth tensor has two moments equal or nearly so. */
        if (i % 4 == 0)
            b = a * (1 + (i % 8 ? 1e-14 * check_random(&seed) : 0));
        double third = fmax(a, b) + fmin(a, b) * check_random(&seed);
        tl_vec3 want = {fmin(a, b), fmax(a, b), third};
        tl_quat turn = tl_q_unit((tl_quat){check_random(&seed) - 0.5, check_random(&seed) - 0.5,
                                           check_random(&seed) - 0.5, check_random(&seed) - 0.5});
        tl_mat3 r = tl_q_matrix(turn);
        double t[3][3];
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                t[j][k] =
                    r.m[j][0] * want.x * r.m[k][0] + r.m[j][1] * want.y * r.m[k][1] + r.m[j][2] * want.z * r.m[k][2];
        tl_sym3 tensor = {t[0][0], t[1][1], t[2][2], t[0][1], t[1][2], t[2][0]};
        tl_vec3 m;
        tl_quat q;
        tl_principal_axes(tensor, &m, &q);
        double trace = want.x + want.y + want.z;
        CHECK(m.x <= m.y && m.y <= m.z);
        CHECK_NEAR(m.x, want.x, 1e-14 * trace);
        CHECK_NEAR(m.y, want.y, 1e-14 * trace);
        CHECK_NEAR(m.z, want.z, 1e-14 * trace);
        CHECK_NEAR(residual(tensor, m, q), 0, 1e-14);
        CHECK_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-15);
    }
}

TEST_MAIN(RUN(diagonal_in_order_is_left_alone), RUN(diagonal_is_only_put_in_order), RUN(random_tensors))
