/* talus/solid_test.h - a solid tried on one zone, as rock is in a laboratory.
 *
 * The zone is led through a path of legs. In each leg every component is either driven, to a strain, or held, to a
 * stress; the strains of those that are held are sought in every step. The zone does not turn. Stress and strain are
 * positive in tension, their components in the order xx yy zz xy yz zx; xy, yz and zx of a strain are those of the
 * tensor, half the angle. Strains are sums of increments. */
#ifndef TALUS_SOLID_TEST_H
#define TALUS_SOLID_TEST_H

#include <talus/plugin.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tl_args tl_args;

/* Most steps of a test: some seconds of work. */
#define TL_SOLID_TEST_STEPS 10000000

/* One leg of the path, made in equal steps. Values are those at its end. A component is driven where its strain is
 * given; else it is held, at its stress as it is where that is NaN. */
typedef struct tl_solid_leg {
    tl_sym3 strain; /* NaN: not driven */
    tl_sym3 stress; /* Pa; NaN: held as it is */
    int64_t steps;  /* 0: the test's */
} tl_solid_leg;

typedef struct tl_solid_test {
    const char *solid;     /* name of a solid that is loaded */
    const tl_args *params; /* its parameters */
    tl_sym3 stress;        /* Pa, at the start */
    double extent;         /* m, of the zone */
    int64_t steps;         /* of a leg */
    int64_t every;         /* steps from one point of the curve to the next; the end of a leg is one */
    const tl_solid_leg *path;
    size_t count;
} tl_solid_test;

/* A point of the curve. */
typedef struct tl_solid_point {
    double strain[6], stress[6];
    double work;               /* J/m3, of the stresses; what was stored at the start is counted */
    double stored, dissipated; /* J/m3, as the solid tells them; what is dissipated is summed up */
    double state[TL_SOLID_COLUMNS];
    uint32_t flags; /* TL_ZONE_* */
} tl_solid_point;

/* Number of points of the curve: the start, and those of the legs. Fails on a path that cannot be walked. */
TL_API tl_status tl_solid_test_points(const tl_solid_test *test, size_t *points, tl_error *error);
/* Runs the test. `points` has room for that many; `ends`, unless NULL, gets for each leg the index of its last point,
 * and `solid` the kind that was tried. */
TL_API tl_status tl_solid_test_run(const tl_solid_test *test, tl_solid_point *points, size_t *ends,
                                   const tl_kind **solid, tl_error *error);

#ifdef __cplusplus
}
#endif
#endif
