/* ring.h - where the cells of contact points lie in their patch, and how those of new points lie on those of old ones (ring.c). */
#ifndef TL_CONTACT_RING_H
#define TL_CONTACT_RING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The cell of a point: its share of the patch. That of the centroid lies inside; around it the others follow each other. */
typedef struct tl_ring_cell {
    double x, y, area; /* of the point, about the centroid of the patch */
    uint32_t point;
    bool inside;
    double share;    /* of the patch, or of what lies around the centroid */
    double turn;     /* direction of the point from the centroid, 0 to 4 */
    double swept;    /* share of the patch from the first cell's point to this one's */
    double from, to; /* where the cell begins and ends, as `swept` */
} tl_ring_cell;

typedef struct tl_ring {
    tl_ring_cell *cell;   /* by their directions */
    size_t count, around; /* the last ones are inside */
    double inside;        /* their share of the patch */
} tl_ring;

/* Second moments of areas about their centroid: xx, xy, yy. */
typedef struct tl_ring_spread {
    double xx, xy, yy;
} tl_ring_spread;

/* Whether points span a plane; within about `place` of a line slopes would be quotients of rounding. */
static inline bool tl_ring_spans(const tl_ring_spread *i, double area, double place)
{
    return i->xx * i->yy - i->xy * i->xy > area * place * place * (i->xx + i->yy);
}

/* Of cells with their points; those within `place` of the centroid are inside. */
tl_ring tl_ring_of(tl_ring_cell *cell, size_t count, double place);
/* Turns an old ring so that its shares count from where those of the new one do. */
void tl_ring_align(tl_ring *old, const tl_ring *now);
/* The share of the patch that is common to a new cell and an old one. */
double tl_ring_common(const tl_ring *now, const tl_ring_cell *of_now, const tl_ring *old,
                      const tl_ring_cell *of_old);

#endif
