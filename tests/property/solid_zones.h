/* solid_zones.h - zones of a solid for property tests: made by a script's parameters, moved by strains. */
#ifndef TALUS_TESTS_SOLID_ZONES_H
#define TALUS_TESTS_SOLID_ZONES_H

#include "base/solid_columns.h"
#include "check.h"
#include "zone/solid.h"

#define ZONES 64

typedef struct zones {
    tl_solid solid;
    _Alignas(TL_ALIGN) double c[TL_ZONE_AT_COUNT][ZONES];
    _Alignas(TL_ALIGN) uint32_t flags[ZONES];
} zones;

/* A solid with numbers for parameters, NAME, VALUE, ... and states as new ones have them. */
static inline int zones_make(zones *z, const char *name, const tl_value *values, size_t count)
{
    tl_error error = {TL_OK, ""};
    memset(z, 0, sizeof *z);
    const tl_kind *kind = tl_plugin_find(TL_KIND_SOLID, name);
    if (!CHECK(kind != NULL))
        return 0;
    const tl_args args = {values, count};
    if (!CHECK_INT(tl_solid_make(kind, &args, NULL, name, &error, &z->solid), TL_OK)) {
        printf("%s\n", error.text);
        return 0;
    }
    for (size_t i = 0; i < ZONES; i++)
        z->c[TL_ZONE_AT_VOLUME][i] = z->c[TL_ZONE_AT_EXTENT][i] = 1;
    return 1;
}

/* A step of the strains in the columns. */
static inline void zones_step(zones *z)
{
    double *state[TL_SOLID_COLUMNS];
    tl_solid_batch batch = tl_solid_batch_of(z->c[0], ZONES, z->flags, state, TL_SOLID_COLUMNS);
    batch.count = ZONES;
    batch.dt = 1e-4;
    tl_report report;
    CHECK_INT(tl_solid_update(&z->solid, &batch, &report), TL_OK);
}

#define STRESS(z, k, i) ((z)->c[TL_ZONE_AT_STRESS + (k)][i])
#define STRAIN(z, k, i) ((z)->c[TL_ZONE_AT_STRAIN + (k)][i])

/* A random number in [-1, 1). */
static inline double zones_any(uint64_t *seed)
{
    return 2 * check_random(seed) - 1;
}

/* Principal values, the largest first, by many sweeps of Jacobi's method, which is not the solids' own. */
static inline void zones_principal(const double s[6], double out[3])
{
    double m[3][3] = {{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}};
    for (int sweep = 0; sweep < 30; sweep++)
        for (int k = 0; k < 3; k++) {
            int p = k, q = (k + 1) % 3, r = (k + 2) % 3;
            double wide = m[p][p] - m[q][q], angle = 0.5 * atan2(wide < 0 ? -2 * m[p][q] : 2 * m[p][q], fabs(wide));
            double c = cos(angle), n = sin(angle), pp = m[p][p], qq = m[q][q], pq = m[p][q], pr = m[p][r], qr = m[q][r];
            m[p][p] = c * c * pp + 2 * c * n * pq + n * n * qq;
            m[q][q] = n * n * pp - 2 * c * n * pq + c * c * qq;
            m[p][q] = m[q][p] = (c * c - n * n) * pq + c * n * (qq - pp);
            m[p][r] = m[r][p] = c * pr + n * qr;
            m[q][r] = m[r][q] = c * qr - n * pr;
        }
    for (int k = 0; k < 3; k++)
        out[k] = m[k][k];
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 2; j++)
            if (out[j] < out[j + 1]) {
                double swap = out[j];
                out[j] = out[j + 1];
                out[j + 1] = swap;
            }
}

#endif
