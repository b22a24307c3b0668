/* talus/poles.h - measured orientations of joints: read from a table, their mean, and draws among them.
 *
 * An orientation is an axis: a pole n and -n are one. The mean after Fisher is taken of the poles on one side of the
 * principal axis of the tensor sum w n n^T. With N the number of poles, weights w of mean 1 and R = |sum w n|:
 *
 *     k = (N - 1) / (N - R),   cos(cone) = 1 - (N - R) / R ((1 / 0.05)^(1 / (N - 1)) - 1)
 *
 * k is the concentration, and the cone about the mean holds the true one with 95 %. Poles are sorted when they are
 * read, so nothing hangs on the order of the lines. */
#ifndef TALUS_POLES_H
#define TALUS_POLES_H

#include <stdlib.h>
#include <talus/csv.h>
#include <talus/distributions.h>
#include <talus/kit.h>

/* Limit: bytes of a file of poles, or of fractures. */
#define TL_SITE_FILE ((size_t)1 << 28)
/* Constant: sweeps of Jacobi's method that make a matrix of 3 x 3 diagonal to the last digit. */
#define TL_JACOBI_SWEEPS 12
/* Limit: passes in which poles are turned to the side of their mean; two are the rule. */
#define TL_POLES_PASSES 20
/* Tolerance: by how much the sum of poles is shorter than their number, relative, where they are one pole but for
 * rounding. Test: lua/test_poles. */
#define TL_POLES_ALIKE 1e-15

/* A plane that was measured. */
typedef struct tl_measured {
    double dip, dip_direction, weight; /* deg, deg, > 0 */
} tl_measured;

/* Columns of a table of poles, in the order of tl_measured. */
#define TL_POLES_COLUMNS                                                                                               \
    {                                                                                                                  \
        {"dip", 0, 90, false, false, 0}, {"dip_direction", 0, 360, false, false, 0},                                   \
        {                                                                                                              \
            "weight", 1e-9, 1e9, false, true, 1                                                                        \
        }                                                                                                              \
    }

typedef struct tl_poles {
    tl_vec3 *normal;
    double *weight; /* of mean 1 */
    size_t count;
} tl_poles;

typedef struct tl_poles_mean {
    tl_vec3 mean;         /* of unit length, upward */
    double resultant;     /* R / N */
    double concentration; /* k; INFINITY of poles that agree, NaN of one pole */
    double cone;          /* deg; NaN of one pole */
} tl_poles_mean;

static inline int tl_measured_order(const void *left, const void *right)
{
    const tl_measured *a = (const tl_measured *)left, *b = (const tl_measured *)right;
    if (a->dip != b->dip)
        return a->dip < b->dip ? -1 : 1;
    if (a->dip_direction != b->dip_direction)
        return a->dip_direction < b->dip_direction ? -1 : 1;
    return (a->weight > b->weight) - (a->weight < b->weight);
}

/* Gives the poles of measured planes, in memory of their own; count 0: there is none. Sorts the planes. */
static inline tl_poles tl_poles_of(tl_measured *planes, size_t count)
{
    tl_poles made = {(tl_vec3 *)malloc((count + 1) * sizeof(tl_vec3)), (double *)malloc((count + 1) * sizeof(double)),
                     count};
    if (!made.normal || !made.weight) {
        free(made.normal);
        free(made.weight);
        return (tl_poles){NULL, NULL, 0};
    }
    double sum = 0;
    qsort(planes, count, sizeof *planes, tl_measured_order);
    for (size_t i = 0; i < count; i++)
        sum += planes[i].weight;
    for (size_t i = 0; i < count; i++) {
        made.normal[i] = tl_plane_normal(planes[i].dip, planes[i].dip_direction);
        made.weight[i] = planes[i].weight * ((double)count / sum);
    }
    return made;
}

static inline void tl_poles_free(tl_poles *poles)
{
    free(poles->normal);
    free(poles->weight);
    *poles = (tl_poles){NULL, NULL, 0};
}

/* One rotation of Jacobi's method, which makes m[p][q] 0. The columns of v become the axes. */
static inline void tl_jacobi_turn(double m[3][3], double v[3][3], int p, int q)
{
    if (m[p][q] == 0)
        return;
    const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
    const double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
    const double c = 1 / sqrt(t * t + 1), s = t * c;
    for (int k = 0; k < 3; k++) {
        const double a = m[k][p], b = m[k][q];
        m[k][p] = c * a - s * b;
        m[k][q] = s * a + c * b;
    }
    for (int k = 0; k < 3; k++) {
        const double a = m[p][k], b = m[q][k];
        m[p][k] = c * a - s * b;
        m[q][k] = s * a + c * b;
        const double x = v[k][p], y = v[k][q];
        v[k][p] = c * x - s * y;
        v[k][q] = s * x + c * y;
    }
}

/* The direction, upward and of unit length, for which sum w (n . d)^2 is largest. */
static inline tl_vec3 tl_poles_axis(const tl_vec3 *normal, const double *weight, size_t count)
{
    double m[3][3] = {{0}}, v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (size_t i = 0; i < count; i++) {
        const double n[3] = {normal[i].x, normal[i].y, normal[i].z};
        for (int k = 0; k < 9; k++)
            m[k / 3][k % 3] += weight[i] * n[k / 3] * n[k % 3];
    }
    for (int sweep = 0; sweep < TL_JACOBI_SWEEPS; sweep++) {
        tl_jacobi_turn(m, v, 0, 1);
        tl_jacobi_turn(m, v, 0, 2);
        tl_jacobi_turn(m, v, 1, 2);
    }
    int best = 0;
    for (int k = 1; k < 3; k++)
        best = m[k][k] > m[best][best] ? k : best;
    const tl_vec3 axis = tl_v3_unit((tl_vec3){v[0][best], v[1][best], v[2][best]});
    return axis.z < 0 ? tl_v3_neg(axis) : axis;
}

/* The mean of `count` >= 1 poles after Fisher; weights of mean 1. */
static inline tl_poles_mean tl_poles_mean_of(const tl_vec3 *normal, const double *weight, size_t count)
{
    tl_vec3 mean = tl_poles_axis(normal, weight, count), sum = {0, 0, 0};
    for (int pass = 0; pass < TL_POLES_PASSES; pass++) {
        tl_vec3 next = {0, 0, 0};
        for (size_t i = 0; i < count; i++)
            next = tl_v3_madd(next, tl_v3_dot(normal[i], mean) < 0 ? -weight[i] : weight[i], normal[i]);
        const bool same = next.x == sum.x && next.y == sum.y && next.z == sum.z;
        sum = next;
        mean = tl_v3_unit(sum);
        if (same)
            break;
    }
    const double n = (double)count, length = tl_v3_norm(sum), lack = fmax(n - length, 0);
    const double share = count > 1 ? tl_expm1(2.995732273553991 / (n - 1)) : NAN; /* ln 20 */
    const double cosine = fmax(1 - lack / length * share, -1);
    tl_poles_mean made;
    made.mean = mean.z < 0 ? tl_v3_neg(mean) : mean;
    made.resultant = fmin(length / n, 1);
    made.concentration = count < 2 ? NAN : lack <= TL_POLES_ALIKE * n ? INFINITY : (n - 1) / lack;
    made.cone = count < 2 ? NAN : 57.29577951308232 * tl_atan2(sqrt(fmax(1 - cosine * cosine, 0)), cosine);
    return made;
}

/* The pole at u in (0, 1), each with the probability of its weight. */
static inline tl_vec3 tl_poles_pick(const tl_poles *poles, double u)
{
    double rest = u * (double)poles->count;
    size_t i = 0;
    while (i + 1 < poles->count && rest >= poles->weight[i])
        rest -= poles->weight[i++];
    return poles->normal[i];
}

/* Reads a file of poles for a generator. Free *poles in any case. */
static inline tl_status tl_poles_read(const tl_host *host, const char *file, tl_poles *poles)
{
    static const tl_csv_column columns[] = TL_POLES_COLUMNS;
    tl_csv table;
    memset(&table, 0, sizeof table);
    table.column = columns;
    table.columns = sizeof columns / sizeof *columns;
    char *text;
    size_t length;
    tl_status status = tl_file_bytes(host, file, TL_SITE_FILE, &text, &length);
    if (status == TL_OK && memchr(text, '\0', length))
        status = host->fail(host, TL_E_ARGUMENT,
                            "poles '%.200s': it holds a zero byte: it is no text; save it as UTF-8", file);
    if (status == TL_OK && !tl_csv_read(&table, text))
        status = host->fail(host, TL_E_ARGUMENT, "poles '%.200s': %s", file, table.why);
    if (status == TL_OK) {
        *poles = tl_poles_of((tl_measured *)(void *)table.at, table.rows);
        if (poles->count == 0)
            status = host->fail(host, TL_E_MEMORY, "poles '%.200s': out of memory", file);
    }
    free(table.at);
    free(text);
    return status;
}

#endif
