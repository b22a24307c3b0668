/* common_polygon.h - the common polygon of two faces on each other. */
#ifndef TL_NARROW_COMMON_POLYGON_H
#define TL_NARROW_COMMON_POLYGON_H

#include "narrow/frame2.h"
#include "narrow/narrow.h"

/* Tolerance: longest run of blended corners that is mixed; longer runs belong to round outlines. */
#define TL_BLEND_RUN 3

/* How far a turning angle is on its way from that of no corner to that of a full one: 0 .. 1 in between. */
static inline double tl_turn_over(double turn)
{
    return (turn - TL_STRAIGHT) / (TL_CORNER - TL_STRAIGHT);
}

/* In A's frame. The corners, and the outlines they come from, are in the thread's scratch until another is found. */
typedef struct tl_common_polygon {
    tl_frame2 frame; /* in the middle between the faces at the centroid */
    tl_plane a, b;
    uint32_t na, nb; /* corners of the faces */
    const tl_outlines *outlines;
    tl_corner *corner; /* counter-clockwise */
    size_t count;      /* 0: the faces have no area in common */
    double area;       /* in the plane of the frame */
    tl_point2 centroid;
    double near; /* corners nearer to each other are one */
} tl_common_polygon;

/* false: out of memory. */
bool tl_common_polygon_find(const tl_pair_view *view, uint32_t fa, uint32_t fb, tl_narrow_scratch *scratch,
                            tl_common_polygon *out);
/* The share by which an edge of the polygon goes along with B: 0 of A's edges, 1 of B's, 0.5 where both have one. */
double tl_common_edge_ride(const tl_common_polygon *of, uint32_t edge);
/* Gives each corner its share, to be blended by its turning angle, and each edge its fan area. Drops corners of share
 * 0, whose fan area goes to the edge before. Returns the number of corners that stay. */
size_t tl_corners_weigh(tl_common_polygon *p, bool blend);
/* Areas of corners, half of the fans beside them. For every two corners that may follow each other in the mixture, the
 * rule of their edge times the chance that they do. */
void tl_corner_areas(const tl_corner *c, const double *fan, size_t count, double *area);

#endif
