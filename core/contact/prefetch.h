/* prefetch.h - prefetches what SIMD groups will need. */
#ifndef TL_CONTACT_PREFETCH_H
#define TL_CONTACT_PREFETCH_H

#include "contact/detection.h"
#include "model/model.h"

/* Whether there are so many points that prefetching pays. */
bool tl_points_are_far(const tl_detect *d);
/* Prefetches what a SIMD group that comes soon will need to be followed, or to be brought up to date. */
void tl_simd_group_prefetch(const tl_model *m, const tl_simd_group *group);
void tl_simd_group_prefetch_shapes(const tl_model *m, const tl_simd_group *group);
/* Prefetches the contacts' rows, which tell where all that is: for a SIMD group that comes a little later. */
void tl_simd_group_prefetch_contacts(const tl_detect *d, const tl_simd_group *group);

#endif
