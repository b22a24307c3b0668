/* talus/skyline.h - symmetric matrices kept row by row, from the first entry to the diagonal, and their equations.
 *
 * A = L D L^T fills nothing outside the skyline (Jennings 1966). One order of sums throughout: the same bits
 * anywhere. */
#ifndef TALUS_SKYLINE_H
#define TALUS_SKYLINE_H

#include <stddef.h>

typedef struct tl_skyline {
    size_t size;      /* rows */
    size_t *first;    /* [size] column of the first entry of each row */
    size_t *start;    /* [size] where rows begin in `entry` */
    double *entry;    /* below the diagonal; once it is factorised, L without its diagonal of 1 */
    double *diagonal; /* [size] of the matrix; once it is factorised, 1 / pivot, or 0 */
} tl_skyline;

/* In four sums, which do not wait for each other. */
static inline double tl_skyline_dot(const double *a, const double *b, size_t count)
{
    double sum[4] = {0, 0, 0, 0};
    size_t k = 0;
    for (; k + 4 <= count; k += 4)
        for (size_t i = 0; i < 4; i++)
            sum[i] += a[k + i] * b[k + i];
    for (; k < count; k++)
        sum[0] += a[k] * b[k];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/* Replaces A by L and D. A pivot of at most `least` >= 0 times the entry of the diagonal that it comes from belongs to
 * a motion that nothing resists: that freedom stays 0. Returns how many such pivots there are; 0: A is positive
 * definite. */
static inline size_t tl_skyline_factor(tl_skyline *a, double least)
{
    size_t none = 0;
    for (size_t i = 0; i < a->size; i++) {
        double *row = a->entry + a->start[i];
        const size_t from = a->first[i];
        for (size_t j = from; j < i; j++) {
            const size_t low = from > a->first[j] ? from : a->first[j];
            if (low < j)
                row[j - from] -=
                    tl_skyline_dot(row + (low - from), a->entry + a->start[j] + (low - a->first[j]), j - low);
        }
        double pivot = a->diagonal[i];
        for (size_t j = from; j < i; j++) {
            const double whole = row[j - from];
            row[j - from] = whole * a->diagonal[j];
            pivot -= whole * row[j - from];
        }
        const int stands = pivot > least * a->diagonal[i] && pivot > 0;
        a->diagonal[i] = stands ? 1 / pivot : 0;
        none += !stands;
    }
    return none;
}

/* Replaces x by the solution of L D L^T x = b. */
static inline void tl_skyline_solve(const tl_skyline *a, double *x)
{
    for (size_t i = 0; i < a->size; i++)
        x[i] -= tl_skyline_dot(a->entry + a->start[i], x + a->first[i], i - a->first[i]);
    for (size_t i = 0; i < a->size; i++)
        x[i] *= a->diagonal[i];
    for (size_t i = a->size; i-- > 0;) {
        const double *row = a->entry + a->start[i];
        const double own = x[i];
        for (size_t j = a->first[i]; j < i; j++)
            x[j] -= row[j - a->first[i]] * own;
    }
}

#endif
