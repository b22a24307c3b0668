/* record.h - records of ground motion as data: what is kept of one. */
#ifndef TL_MODEL_RECORD_H
#define TL_MODEL_RECORD_H

#include <talus/record.h>

/* An interval between two samples: accelerations at its ends, m/s2; velocity and displacement at its begin. */
typedef struct tl_record_interval {
    double from, to, velocity, displacement;
} tl_record_interval;

struct tl_record {
    double dt;
    size_t count;                 /* intervals */
    tl_record_interval *interval; /* count + 1: the last one is the end, with accelerations of 0 */
    size_t holders;
};

/* Makes one of the accelerations of intervals, which are finite, and the velocity at the begin. NULL: out of memory. */
tl_record *tl_record_new(double dt, size_t count);
/* Integrates the accelerations of its intervals, from the first velocity. */
void tl_record_integrate(tl_record *record);
bool tl_record_is_finite(const tl_record *record);

#endif
