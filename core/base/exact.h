/* exact.h - sums that do not depend on the order of what is added, nor on how it is divided among threads.
 *
 * Each number is rounded to a multiple of a coarse unit, and what that leaves to a multiple of a fine unit, 2^52 times
 * smaller. Multiples are added as integers, so exactly. The units are powers of two on a grid that is the same for all
 * sums: those of a sum are the smallest that hold its largest number. So a sum is a function of the set of its numbers
 * alone. What is left out of a number is less than the last bit of the largest.
 *
 * The idea is that of reproducible summation by Demmel and Nguyen (2015, IEEE Trans. Comput. 64, 2060-2070). */
#ifndef TL_BASE_EXACT_H
#define TL_BASE_EXACT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Multiples of the coarse and of the fine unit: 2^32 high + low. All zeros are the empty sum. */
typedef struct tl_exact {
    int64_t high[2], low[2];
    int32_t window; /* which units: exact.c */
    bool endless;   /* something was added that is no finite number: so is the sum */
} tl_exact;

/* Adds numbers: at most 2^31 in all. */
void tl_exact_add(tl_exact *sum, const double *number, size_t count);
/* The same for several sums, whose numbers begin `stride` apart. */
void tl_exact_add_each(tl_exact *sums, size_t sum_count, const double *number, size_t stride, size_t count);
/* Adds what another sum holds. */
void tl_exact_merge(tl_exact *sum, const tl_exact *other);
/* The sum; NaN where something in it was no finite number. */
double tl_exact_value(const tl_exact *sum);

/* A sum whose numbers come one by one. All zeros are the empty one. */
typedef struct tl_addends {
    tl_exact sum;
    size_t count;
    double number[64];
} tl_addends;

static inline void tl_addends_put(tl_addends *a, double number)
{
    a->number[a->count++] = number;
    if (a->count < sizeof a->number / sizeof *a->number)
        return;
    tl_exact_add(&a->sum, a->number, a->count);
    a->count = 0;
}

/* The sum of all that was put. */
double tl_addends_sum(tl_addends *a);

#endif
