/* roots.h - numbers at which nothing is missing (roots.c). */
#ifndef TL_FORCE_ROOTS_H
#define TL_FORCE_ROOTS_H

#include <stdbool.h>

/* Most numbers that are looked for. */
#define TL_ROOTS 6
/* What is missing by this is not missing. */
#define TL_ROOTS_EXACT 1e-11

/* What is missed falls with each number as fast as by 1 / unit, about, where all is plain. */
typedef struct tl_roots {
    int count;
    double unit;
    double
        hopeless; /* share of what is missed that is left after a step by fresh slopes, from which the search ends */
    /* What is missed with such numbers, up to TL_ROOTS of both; false: it is not known. */
    bool (*miss)(const void *user, const double x[], double missed[]);
    const void *user;
} tl_roots;

/* The root of the sum of squares. */
double tl_roots_size(const double x[], int count);
/* Goes from x to where the least is missed that is found, and tells how much that is. false: it is not known somewhere. */
bool tl_roots_find(const tl_roots *of, double x[TL_ROOTS], double *left);

#endif
