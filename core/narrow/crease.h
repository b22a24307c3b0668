/* crease.h - the point share of edges that lie along each other (crease.c). */
#ifndef TL_NARROW_CREASE_H
#define TL_NARROW_CREASE_H

#include "narrow/facet.h"
#include "narrow/view.h"

/* Adds the facet of two edges along each other within `near`, its points' areas summing to 1, and returns
 * how flush their four faces are by `flush` of the sine between them; 0 and no facet without such edges.
 * The manifold has room for the facet. */
double tl_crease_add(const tl_pair_view *view, double near, double (*flush)(double sine),
                     tl_manifold *m);

#endif
