/* clock.h - what time it is, to tell how long things take. */
#ifndef TL_BASE_CLOCK_H
#define TL_BASE_CLOCK_H

#include <time.h>

/* Constant: s. */
#define TL_NANOSECOND 1e-9

/* Seconds since some moment in the past; it never goes back. Needs _POSIX_C_SOURCE. */
static inline double tl_clock(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + TL_NANOSECOND * (double)t.tv_nsec;
}

#endif
