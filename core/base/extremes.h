/* extremes.h - the larger and the smaller of two numbers, the same on every machine. Of fmax and fmin few compilers
 * make one instruction, and of two zeros of different sign they may give either. */
#ifndef TL_BASE_EXTREMES_H
#define TL_BASE_EXTREMES_H

/* The second where neither is larger, so of two zeros; where one is NaN, the second. */
static inline double tl_larger(double a, double b)
{
    return a > b ? a : b;
}

/* The second where neither is smaller, so of two zeros; where one is NaN, the second. */
static inline double tl_smaller(double a, double b)
{
    return a < b ? a : b;
}

#endif
