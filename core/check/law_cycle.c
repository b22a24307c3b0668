/* law_cycle.c - closed paths of closure and shear: a law may take energy on them, and must not give any.
 *
 *     W = sum of (f_n + f_n')/2 d(closure) - (f_s + f_s')/2 . du_s  >= 0      over a closed path, J
 *
 * Every point begins and ends at closure 0 and without force, on a path of straight parts of its own: closing, opening,
 * small and large shear, out of the plane of those before as well. The work is a sum of means, so where a force bends it is
 * wrong by its change within a small step; the bound allows for that. */
#include "check/law.h"

#include <math.h>
#include <string.h>

/* Corners of a path, and steps from one to the next. */
#define CORNERS 7
#define STEPS 300
/* Work that may seem to be given, relative to the work of all steps: the error of the sum. */
#define ERROR 2e-3

/* A place on a path, relative to where it begins. */
typedef struct place {
    double closure;
    tl_vec3 slide;
} place;

static place corner_of(const tl_checker *c, const tl_check_law *law, size_t point, int corner,
                       tl_vec3 normal)
{
    if (corner == 0 || corner == CORNERS)
        return (place){0, tl_v3(0, 0, 0)};
    uint64_t key = tl_key(tl_key(tl_key(1971, (uint64_t)c->set), point), (uint64_t)corner);
    tl_vec3 any = tl_check_direction(tl_key(key, 1));
    double size = law->slide * tl_check_scale(tl_key(key, 2), -1.5, 1);
    any = tl_v3_sub(any, tl_v3_scale(tl_v3_dot(any, normal), normal));
    return (place){law->closure * tl_check_between(tl_key(key, 3), point % 2 ? -0.3 : 0.05, 1),
                   tl_v3_scale(size, any)};
}

static void begin(const tl_checker *c, const tl_check_law *law, tl_check_points *p)
{
    memset(p, 0, sizeof *p);
    p->dt = TL_CHECK_DT;
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        uint64_t key = tl_key(tl_key(1976, (uint64_t)c->set), i);
        p->c[TL_AT_AREA][i] = tl_check_scale(tl_key(key, 1), -1, 1);
        tl_check_put(p, TL_AT_NORMAL, i, tl_check_direction(tl_key(key, 2)));
        for (uint32_t k = 0; k < law->of.columns; k++)
            p->c[TL_AT_STATE + k][i] = law->of.initial[k];
    }
}

/* One step of all points towards the corner's end; adds the work and its size. */
static bool step(const tl_check_law *law, tl_check_points *p, const place *from, const place *to,
                 int number, double *work, double *size)
{
    tl_check_points in = *p;
    tl_check_call call = {0};
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        double closure = from[i].closure + (to[i].closure - from[i].closure) * (number + 1) / STEPS;
        tl_vec3 du = tl_v3_scale(1.0 / STEPS, tl_v3_sub(to[i].slide, from[i].slide));
        in.c[TL_AT_DU_N][i] = p->c[TL_AT_CLOSURE][i] - closure;
        in.c[TL_AT_CLOSURE][i] = in.c[TL_AT_EDGE][i] = closure;
        tl_check_put(&in, TL_AT_DU_S, i, du);
    }
    tl_check_points out = in;
    tl_check_call_law(&law->of, &in, &out, NULL, 0, TL_CHECK_POINTS, &call);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        tl_vec3 mean = tl_v3_scale(
            0.5, tl_v3_add(tl_check_vec(&in, TL_AT_F_S, i), tl_check_vec(&out, TL_AT_F_S, i)));
        double across = -0.5 * (in.c[TL_AT_F_N][i] + out.c[TL_AT_F_N][i]) * in.c[TL_AT_DU_N][i];
        double along = -tl_v3_dot(mean, tl_check_vec(&in, TL_AT_DU_S, i));
        work[i] += across + along;
        size[i] += fabs(across) + fabs(along);
    }
    *p = out;
    return call.status == TL_OK;
}

void tl_check_cycles(tl_checker *c, const tl_check_law *law)
{
    tl_check_points p;
    place from[TL_CHECK_POINTS], to[TL_CHECK_POINTS];
    double work[TL_CHECK_POINTS] = {0}, size[TL_CHECK_POINTS] = {0};
    if (tl_check_failed(c, TL_LAW_CYCLE))
        return;
    begin(c, law, &p);
    for (int corner = 0; corner < CORNERS; corner++) {
        for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
            tl_vec3 normal = tl_check_vec(&p, TL_AT_NORMAL, i);
            from[i] = corner_of(c, law, i, corner, normal);
            to[i] = corner_of(c, law, i, corner + 1, normal);
        }
        for (int number = 0; number < STEPS; number++)
            if (!step(law, &p, from, to, number, work, size))
                return;
    }
    for (size_t i = 0; i < TL_CHECK_POINTS; i++)
        if (work[i] < -ERROR * size[i])
            tl_check_note(
                c, TL_LAW_CYCLE,
                "%.3g J come out of a closed path of motion on which %.3g J went in and out",
                -work[i], size[i]);
}
