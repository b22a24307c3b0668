/* joints.h - polygons of wet joints, for all kinds of water. */
#ifndef WATER_JOINTS_H
#define WATER_JOINTS_H

#include <talus/kit.h>

/* Corners of a polygon, at the most: those of two faces, and one more by a cut. */
#define MOST_CORNERS 256
/* Tolerance: degrees by which the normals of two walls may be off opposite. */
#define MOST_TILT 5.0
/* Constant: a joint that is dry is remembered until it is so many times as wide open as where it ran dry. */
#define FORGOTTEN 10.0

/* A polygon on both walls: corner i of one is opposite to corner i of the other. */
typedef struct joint_polygon {
    tl_vec3 at[2][MOST_CORNERS];
    size_t count;
} joint_polygon;

/* Area, centroid and two axes a, b for which a a^t + b b^t are the second moments per area, halfway between the
 * walls. */
typedef struct joint_moments {
    double area;
    tl_vec3 centroid, normal, a, b;
} joint_moments;

/* Halfway between the walls. */
tl_vec3 joint_middle(const joint_polygon *p, size_t i);
joint_moments joint_moments_of(const joint_polygon *p, tl_vec3 normal);
/* The name of a wall: its blocks, faces, and which one it is of those. */
uint64_t joint_key(const tl_element_wall *w, uint32_t which);
bool joint_same_faces(const tl_element_wall *a, const tl_element_wall *b);
/* Where a line along n through x meets wall k. */
tl_vec3 joint_on_wall(const tl_element_wall *w, int k, tl_vec3 n, tl_vec3 x);

#endif
