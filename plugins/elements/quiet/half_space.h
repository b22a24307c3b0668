/* half_space.h - what the kinds "quiet", "free_field" and "incoming" share: rock that was cut off behind a face, waves
 * that come in through it, and points of a face. */
#ifndef HALF_SPACE_H
#define HALF_SPACE_H

#include <talus/kit.h>

/* Limit: nodes of a face. Three of A / 3 have the second moments of its area. */
#define POINTS 3

/* ---------------------------------------------------------------- waves ------------------ */

/* Displacements and velocities at equal times; in between cubic. */
typedef struct wave {
    double begin, dt;
    size_t count; /* samples; 0: no wave */
    double *sample;
} wave;

/* Reads numbers with blanks between them; how many, or SIZE_MAX when there is something else. `to` may be NULL. */
size_t half_space_numbers(const char *text, double *to);
/* What `create` of a kind makes of its parameters begins with the waves. Frees such a thing. */
void half_space_destroy(void *self);
/* Makes one of `size` bytes, 0 behind the waves; on failure `*self` is NULL. */
tl_status half_space_create(const char *const input[3], size_t size, void **self, tl_report *report);
/* Refuses what has not either kn and ks, or both velocities in their order; NaN is left out. */
tl_status half_space_check(double kn, double ks, double p_velocity, double s_velocity, tl_report *report);
/* Refuses shear waves that are faster than pressure waves; NaN is left out. */
tl_status half_space_order(double p_velocity, double s_velocity, tl_report *report);

/* How far the waves move in a step that ends at `time`, m. */
tl_vec3 half_space_came(const wave w[3], double time, double dt);

/* Their velocities at a time, m/s. */
tl_vec3 half_space_speed(const wave w[3], double time);

/* The row of a face in a list of `count` rows of `width` numbers, which begin with block and face. NULL: it is not in
 * it. Rows and faces that are asked for go by ascending blocks and faces; `from` begins at 0. */
const double *half_space_row(const double *rows, size_t width, size_t count, size_t *from, const tl_element_face *f);

/* Three points of a polygon in its plane, of weight A / 3 each, with its centroid and second moments. */
void half_space_points(const tl_element_face *f, tl_vec3 at[POINTS]);

/* ---------------------------------------------------------------- rock ------------------- */

/* Stiffness k and impedance z of a unit area, across the face and along it. a = k dt / (2 z) is the part of the way of
 * the block by which the dashpot follows in half a step; inverse = 1 / (1 + a). */
typedef struct half_space {
    double k[2], z[2], a[2], inverse[2];
} half_space;

/* Of rock whose lattice of blocks has the stiffnesses kn and ks, Pa/m; height m, density kg/m3. */
static inline half_space half_space_of(double kn, double ks, double height, double density, double dt)
{
    const double mass = density * height;
    half_space h = {.k = {2 * kn, 2 * ks}, .z = {sqrt(kn * mass), sqrt(ks * mass)}};
    for (int i = 0; i < 2; i++) {
        h.a[i] = 0.5 * dt * h.k[i] / h.z[i];
        h.inverse[i] = 1 / (1 + h.a[i]);
    }
    return h;
}

/* The stiffnesses of a lattice with blocks of that height: kn and ks or, where they are NaN, those of rock that has
 * waves of the velocities p and s. */
static inline half_space half_space_rock(double kn, double ks, double p, double s, double height, double density,
                                         double dt)
{
    const double modulus = density / height;
    return half_space_of(isnan(kn) ? modulus * p * p : kn, isnan(kn) ? modulus * s * s : ks, height, density, dt);
}

/* c[0] of a vector across a face and c[1] of it along the face. */
static inline tl_vec3 half_space_parts(const double c[2], tl_vec3 x, tl_vec3 n)
{
    return tl_v3_madd(tl_v3_scale(c[1], x), (c[0] - c[1]) * tl_v3_dot(x, n), n);
}

/* The same form, x . (c x). */
static inline double half_space_square(const double c[2], tl_vec3 x, tl_vec3 n)
{
    const double across = tl_v3_dot(x, n);
    return c[1] * tl_v3_dot(x, x) + (c[0] - c[1]) * across * across;
}

/* Where the dashpot is at the end of a step: from s, with the node at u after it moved by du, and waves by `in`.
 *
 *     s1 (1 + a) = s + 2 in + a (u0 - s + u1) */
static inline tl_vec3 half_space_follow(const half_space *h, tl_vec3 s, tl_vec3 u, tl_vec3 du, tl_vec3 in, tl_vec3 n)
{
    const tl_vec3 p = tl_v3_madd(s, 2, in), r = tl_v3_add(tl_v3_sub(u, s), tl_v3_sub(u, du));
    const double pn = tl_v3_dot(p, n), rn = tl_v3_dot(r, n);
    const double across = h->inverse[0] * (pn + h->a[0] * rn) - h->inverse[1] * (pn + h->a[1] * rn);
    return tl_v3_madd(tl_v3_scale(h->inverse[1], tl_v3_madd(p, h->a[1], r)), across, n);
}

#endif
