/* talus/vmath.h - inline vector, matrix and quaternion mathematics on the types of types.h.
 *
 * Every function is pure and evaluates in one fixed order, so results are the same bits wherever they are computed
 * (build with -ffp-contract=off). Names: tl_v3_* vectors, tl_m3_* matrices, tl_q_* quaternions. */
#ifndef TALUS_VMATH_H
#define TALUS_VMATH_H

#include <math.h>
#include <talus/elementary.h>
#include <talus/types.h>

#define TL_PI 3.14159265358979323846

static inline tl_vec3 tl_v3(double x, double y, double z)
{
    return (tl_vec3){x, y, z};
}

static inline tl_vec3 tl_v3_add(tl_vec3 a, tl_vec3 b)
{
    return (tl_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline tl_vec3 tl_v3_sub(tl_vec3 a, tl_vec3 b)
{
    return (tl_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline tl_vec3 tl_v3_scale(double s, tl_vec3 a)
{
    return (tl_vec3){s * a.x, s * a.y, s * a.z};
}

/* a + s b */
static inline tl_vec3 tl_v3_madd(tl_vec3 a, double s, tl_vec3 b)
{
    return (tl_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline tl_vec3 tl_v3_neg(tl_vec3 a)
{
    return (tl_vec3){-a.x, -a.y, -a.z};
}

static inline double tl_v3_dot(tl_vec3 a, tl_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline tl_vec3 tl_v3_cross(tl_vec3 a, tl_vec3 b)
{
    return (tl_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double tl_v3_norm2(tl_vec3 a)
{
    return tl_v3_dot(a, a);
}

static inline double tl_v3_norm(tl_vec3 a)
{
    return sqrt(tl_v3_dot(a, a));
}

/* a / |a|, or the zero vector when a is zero. */
static inline tl_vec3 tl_v3_unit(tl_vec3 a)
{
    double n = tl_v3_norm(a);
    return n > 0 ? tl_v3_scale(1 / n, a) : (tl_vec3){0, 0, 0};
}

static inline tl_vec3 tl_v3_min(tl_vec3 a, tl_vec3 b)
{
    return (tl_vec3){a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}

static inline tl_vec3 tl_v3_max(tl_vec3 a, tl_vec3 b)
{
    return (tl_vec3){a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}

static inline int tl_v3_finite(tl_vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

static inline int tl_v3_is_zero(tl_vec3 a)
{
    return a.x == 0 && a.y == 0 && a.z == 0;
}

/* Some unit vector perpendicular to the unit vector n (the same one for the same n). */
static inline tl_vec3 tl_v3_perpendicular(tl_vec3 n)
{
    double ax = fabs(n.x), ay = fabs(n.y), az = fabs(n.z);
    tl_vec3 e = ax <= ay && ax <= az ? tl_v3(1, 0, 0) : ay <= az ? tl_v3(0, 1, 0) : tl_v3(0, 0, 1);
    return tl_v3_unit(tl_v3_cross(n, e));
}

static inline tl_mat3 tl_m3_identity(void)
{
    return (tl_mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

static inline tl_vec3 tl_m3_mul(const tl_mat3 *a, tl_vec3 v)
{
    return (tl_vec3){a->m[0][0] * v.x + a->m[0][1] * v.y + a->m[0][2] * v.z,
                     a->m[1][0] * v.x + a->m[1][1] * v.y + a->m[1][2] * v.z,
                     a->m[2][0] * v.x + a->m[2][1] * v.y + a->m[2][2] * v.z};
}

/* transpose(a) v */
static inline tl_vec3 tl_m3_tmul(const tl_mat3 *a, tl_vec3 v)
{
    return (tl_vec3){a->m[0][0] * v.x + a->m[1][0] * v.y + a->m[2][0] * v.z,
                     a->m[0][1] * v.x + a->m[1][1] * v.y + a->m[2][1] * v.z,
                     a->m[0][2] * v.x + a->m[1][2] * v.y + a->m[2][2] * v.z};
}

static inline tl_vec3 tl_m3_row(const tl_mat3 *a, int i)
{
    return (tl_vec3){a->m[i][0], a->m[i][1], a->m[i][2]};
}

static inline tl_vec3 tl_m3_column(const tl_mat3 *a, int j)
{
    return (tl_vec3){a->m[0][j], a->m[1][j], a->m[2][j]};
}

static inline tl_mat3 tl_m3_of_rows(tl_vec3 x, tl_vec3 y, tl_vec3 z)
{
    return (tl_mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
}

/* a b */
static inline tl_mat3 tl_m3_product(const tl_mat3 *a, const tl_mat3 *b)
{
    return tl_m3_of_rows(tl_m3_tmul(b, tl_m3_row(a, 0)), tl_m3_tmul(b, tl_m3_row(a, 1)),
                         tl_m3_tmul(b, tl_m3_row(a, 2)));
}

/* transpose(a) b */
static inline tl_mat3 tl_m3_tproduct(const tl_mat3 *a, const tl_mat3 *b)
{
    return tl_m3_of_rows(tl_m3_tmul(b, tl_m3_column(a, 0)), tl_m3_tmul(b, tl_m3_column(a, 1)),
                         tl_m3_tmul(b, tl_m3_column(a, 2)));
}

/* a transpose(b) */
static inline tl_mat3 tl_m3_product_t(const tl_mat3 *a, const tl_mat3 *b)
{
    return tl_m3_of_rows(tl_m3_mul(b, tl_m3_row(a, 0)), tl_m3_mul(b, tl_m3_row(a, 1)), tl_m3_mul(b, tl_m3_row(a, 2)));
}

static inline tl_vec3 tl_s3_mul(tl_sym3 a, tl_vec3 v)
{
    return (tl_vec3){a.xx * v.x + a.xy * v.y + a.zx * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
                     a.zx * v.x + a.yz * v.y + a.zz * v.z};
}

static inline tl_sym3 tl_s3_scale(double s, tl_sym3 a)
{
    return (tl_sym3){s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.yz, s * a.zx};
}

/* a + s b */
static inline tl_sym3 tl_s3_madd(tl_sym3 a, double s, tl_sym3 b)
{
    return (tl_sym3){a.xx + s * b.xx, a.yy + s * b.yy, a.zz + s * b.zz,
                     a.xy + s * b.xy, a.yz + s * b.yz, a.zx + s * b.zx};
}

/* r a transpose(r): the tensor in the axes that the rotation r leads to. */
static inline tl_sym3 tl_s3_turn(tl_sym3 a, const tl_mat3 *r)
{
    tl_vec3 x = tl_m3_row(r, 0), y = tl_m3_row(r, 1), z = tl_m3_row(r, 2);
    tl_vec3 ax = tl_s3_mul(a, x), ay = tl_s3_mul(a, y), az = tl_s3_mul(a, z);
    return (tl_sym3){tl_v3_dot(x, ax), tl_v3_dot(y, ay), tl_v3_dot(z, az),
                     tl_v3_dot(x, ay), tl_v3_dot(y, az), tl_v3_dot(z, ax)};
}

static inline tl_quat tl_q_identity(void)
{
    return (tl_quat){1, 0, 0, 0};
}

static inline tl_quat tl_q_mul(tl_quat a, tl_quat b)
{
    return (tl_quat){a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                     a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

static inline tl_quat tl_q_conj(tl_quat a)
{
    return (tl_quat){a.w, -a.x, -a.y, -a.z};
}

static inline tl_quat tl_q_unit(tl_quat a)
{
    double s = 1 / sqrt(a.w * a.w + a.x * a.x + a.y * a.y + a.z * a.z);
    return (tl_quat){s * a.w, s * a.x, s * a.y, s * a.z};
}

/* Axis times angle, rad, at most pi. */
static inline tl_vec3 tl_q_vector(tl_quat q)
{
    tl_vec3 v = {q.x, q.y, q.z};
    double sine = tl_v3_norm(v), sign = q.w < 0 ? -1 : 1;
    double angle = 2 * tl_atan2(sine, sign * q.w);
    return tl_v3_scale(sine > 0 ? sign * angle / sine : 2, v);
}

/* The rotation matrix of a unit quaternion: world = R local. Exactly the identity for (1,0,0,0). */
static inline tl_mat3 tl_q_matrix(tl_quat q)
{
    double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
    double xy = q.x * q.y, yz = q.y * q.z, zx = q.z * q.x;
    double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    return (tl_mat3){{{1 - 2 * (yy + zz), 2 * (xy - wz), 2 * (zx + wy)},
                      {2 * (xy + wz), 1 - 2 * (xx + zz), 2 * (yz - wx)},
                      {2 * (zx - wy), 2 * (yz + wx), 1 - 2 * (xx + yy)}}};
}

static inline tl_vec3 tl_q_rotate(tl_quat q, tl_vec3 v)
{
    tl_vec3 u = {q.x, q.y, q.z};
    tl_vec3 t = tl_v3_scale(2, tl_v3_cross(u, v));
    return tl_v3_add(tl_v3_madd(v, q.w, t), tl_v3_cross(u, t));
}

/* The vector v turned by the rotation that takes unit vector a to unit vector b on the shortest
 * way. For a = -b, where that way is not unique, v is returned unchanged. */
static inline tl_vec3 tl_v3_turn(tl_vec3 v, tl_vec3 a, tl_vec3 b)
{
    tl_vec3 w = tl_v3_cross(a, b);
    double c = 1 + tl_v3_dot(a, b);
    if (!(c > 0))
        return v;
    tl_vec3 t = tl_v3_cross(w, v);
    return tl_v3_add(tl_v3_add(v, t), tl_v3_scale(1 / c, tl_v3_cross(w, t)));
}

/* Sine of (degrees + 90 quarter), exact at multiples of 90 degrees. The angle is brought within 45
 * degrees of a multiple of 90 first, which rounds nothing. */
static inline double tl_sin_quarter(double degrees, int quarter)
{
    if (!isfinite(degrees))
        return degrees - degrees;
    double r = fmod(degrees, 360);
    double turns = floor((r + 45) / 90);
    double x = (r - 90 * turns) * (TL_PI / 180);
    switch (((int)turns + quarter) & 3) {
    case 0: return tl_sin(x);
    case 1: return tl_cos(x);
    case 2: return -tl_sin(x);
    default: return -tl_cos(x);
    }
}

static inline double tl_sin_degrees(double degrees)
{
    return tl_sin_quarter(degrees, 0);
}

static inline double tl_cos_degrees(double degrees)
{
    return tl_sin_quarter(degrees, 1);
}

/* Upward unit normal of a plane of this dip (0-90 below horizontal) and dip direction (clockwise from north, +y), in
 * degrees. It is (sin dip sin dd, sin dip cos dd, cos dip). Planes along the axes come out exactly so, and no
 * component is -0. */
static inline tl_vec3 tl_plane_normal(double dip, double dip_direction)
{
    double s = tl_sin_degrees(dip);
    return (tl_vec3){s * tl_sin_degrees(dip_direction) + 0.0, s * tl_cos_degrees(dip_direction) + 0.0,
                     tl_cos_degrees(dip) + 0.0};
}

#endif
