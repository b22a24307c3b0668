/* common_polygon.h - the common polygon of two faces on each other. */
#ifndef TL_NARROW_COMMON_POLYGON_H
#define TL_NARROW_COMMON_POLYGON_H

#include "narrow/frame2.h"
#include "narrow/narrow.h"

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
bool tl_common_polygon_find(const tl_pair_view *view, uint32_t fa, uint32_t fb,
                            tl_narrow_scratch *scratch, tl_common_polygon *out);
/* The share by which an edge of the polygon goes along with B: 0 of A's edges, 1 of B's, 0.5 where both have one. */
double tl_common_edge_ride(const tl_common_polygon *of, uint32_t edge);
/* The same of its points: that of the fan area over edges of B. When B moves by u in the plane, the centroid moves by
 * this times u, in the mean over the directions of u. */
double tl_common_polygon_ride(const tl_common_polygon *of);
/* Gives each corner its share, to be blended by its turning angle, and each edge its fan area. Drops corners of share
 * 0, whose fan area goes to the edge before. Returns the number of corners that stay. */
size_t tl_corners_weigh(tl_common_polygon *p, bool blend);
/* Areas of corners, half of the fans beside them. For every two corners that may follow each other in the mixture, the
 * rule of their edge times the chance that they do. */
void tl_corner_areas(const tl_corner *c, const double *fan, size_t count, double *area);
/* Adds to the rates of the areas what the rates of the shares make of them. */
void tl_corner_areas_add(const tl_corner *c, const double *fan, const double *share_rate,
                         size_t count, double *rate);
/* How the share of a corner goes with its turning angle, 1/rad. */
double tl_corner_share_slope(tl_point2 before, tl_point2 here, tl_point2 after);

#endif
