/* talus/law_test.h - a joint law tried on one contact point, as a joint is in a laboratory.
 *
 * The point stands for an area of 1 m2 between two flat walls. It is led through a path of legs. A constant
 * normal stress, surroundings of constant normal stiffness or a given closure press it together. Joint stresses and
 * closure are compression positive. Shear stress and shear displacement of the upper wall have the same sign where the
 * joint resists. */
#ifndef TALUS_LAW_TEST_H
#define TALUS_LAW_TEST_H

#include <talus/plugin.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tl_args tl_args;

/* Most steps of a test: some seconds of work. */
#define TL_LAW_TEST_STEPS 10000000

/* One leg of the path, made in equal steps. Values are those at its end; NaN: as at its beginning. */
typedef struct tl_law_leg {
    double shear;         /* m */
    double closure;       /* m, of a test by closure only */
    double normal_stress; /* Pa, of a test by normal stress only */
    double time;          /* s, > 0; NaN: its length over the speed, or 1 s of a leg without length */
    double speed;         /* m/s, > 0; NaN: the test's */
    int64_t steps;        /* 0: the test's */
} tl_law_leg;

typedef struct tl_law_test {
    const char *law;       /* name of a law that is loaded */
    const tl_args *params; /* its parameters */
    double normal_stress;  /* Pa; NaN: the test is by closure, which begins at 0 */
    /* Pa/m, >= 0; NaN: 0. With K > 0 the normal stress is normal_stress + K (closure at the start - closure). */
    double stiffness;
    double speed;  /* m/s */
    int64_t steps; /* of a leg */
    int64_t every; /* steps from one point of the curve to the next; the end of a leg is one */
    const tl_law_leg *path;
    size_t count;
} tl_law_test;

/* A point of the curve; per m2 of the joint. */
typedef struct tl_law_point {
    double time;          /* s */
    double shear;         /* m, displacement */
    double shear_stress;  /* Pa */
    double normal_stress; /* Pa */
    double closure;       /* m */
    double work;          /* J/m2, of the walls; what was stored at the start is counted */
    double stored, heat;  /* J/m2, as the law tells them; heat is summed up */
    double state[TL_STATE_COLUMNS];
    uint32_t flags; /* TL_POINT_* */
} tl_law_point;

/* Number of points of the curve: the start, and those of the legs. Fails on a path that cannot be walked. */
TL_API tl_status tl_law_test_points(const tl_law_test *test, size_t *points, tl_error *error);
/* Runs the test. `points` has room for that many; `ends`, unless NULL, gets for each leg the index of its last point,
 * and `law` the kind that was tried. Shear acts along x, the normal is z: a tangent state has its columns in this
 * order. */
TL_API tl_status tl_law_test_run(const tl_law_test *test, tl_law_point *points, size_t *ends, const tl_kind **law,
                                 tl_error *error);

#ifdef __cplusplus
}
#endif
#endif
