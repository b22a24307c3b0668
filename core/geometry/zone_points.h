/* zone_points.h - the points of the zones of one block, while they are laid. */
#ifndef TL_GEOMETRY_ZONE_POINTS_H
#define TL_GEOMETRY_ZONE_POINTS_H

#include "base/error.h"
#include "geometry/delaunay.h"
#include "geometry/point2.h"
#include "geometry/zone_mesh.h"

#include <talus/vmath.h>

/* Cost only: first rooms. All arrays are kept between blocks. */
typedef struct tl_zone_points {
    const tl_poly *poly;
    const tl_shape_zoning *zoning;
    /* The frame: origin at the first vertex, x along the longest edge, y in a face beside it. Rows of `axes`. */
    tl_mat3 axes;
    tl_vec3 centroid; /* in the frame */
    double extent;    /* largest distance of a corner from the centroid */
    double shortest;  /* the shortest part of an edge */

    uint32_t count, corner_end, edge_end, face_end;
    tl_vec3 *place;  /* [count] in the frame */
    tl_vec3 *real;   /* [face_end] as the block's vertices are given */
    double *size;    /* [count] wanted edge */
    double *chance;  /* [count] from 0 to 1, by keys: decides where points lie on one circle or sphere */
    tl_point2 *flat; /* [face_end] x: the share of its edge at which a point lies; x and y: its place in its face */
    size_t place_room, real_room, size_room, chance_room, flat_room;

    uint32_t *edge_start; /* [edge_count + 1] the first point on each edge, from the corner with the lower key */
    uint32_t *edge_at;    /* [2 edge_count] the edge from each place of a loop to the next */
    double *edge_part;    /* [edge_count] shortest part */
    size_t edge_start_room, edge_at_room, edge_part_room;

    tl_plane *plane;     /* [face_count] in the frame, by the corners */
    double *bend;        /* [face_count] by how much corners miss it */
    signed char *turn;   /* [faces of the block] as in tl_delaunay_points */
    uint32_t *face_from; /* [face_count + 1] the first point inside each face */
    size_t plane_room, bend_room, turn_room, face_from_room;

    uint32_t *start, *filled; /* [face_end + 1] as in tl_delaunay_points, and how many are in */
    tl_in_face *in_face;
    size_t start_room, filled_room, in_face_room;
} tl_zone_points;

/* Begins with the corners: frame, planes, centroid. */
tl_status tl_zone_points_begin(tl_zone_points *points, const tl_poly *poly, const tl_shape_zoning *zoning,
                               tl_error *error);
/* Adds a point inside, or on the surface. */
bool tl_zone_points_add(tl_zone_points *points, tl_vec3 place, double size, uint64_t key);
bool tl_zone_points_add_outer(tl_zone_points *points, tl_vec3 place, tl_vec3 real, tl_point2 flat, double size,
                              uint64_t key);
/* Refuses a wanted edge that is none. */
tl_status tl_zone_size_check(double size, tl_vec3 place, tl_error *error);
void tl_zone_points_free(tl_zone_points *points);

/* A difference of places as the block's vertices are given, in the frame, and back. */
static inline tl_vec3 tl_zone_into_frame(const tl_zone_points *p, tl_vec3 real)
{
    return (tl_vec3){p->axes.m[0][0] * real.x + p->axes.m[0][1] * real.y + p->axes.m[0][2] * real.z,
                     p->axes.m[1][0] * real.x + p->axes.m[1][1] * real.y + p->axes.m[1][2] * real.z,
                     p->axes.m[2][0] * real.x + p->axes.m[2][1] * real.y + p->axes.m[2][2] * real.z};
}
static inline uint64_t tl_zone_corner_key(const tl_zone_points *p, uint32_t corner)
{
    return p->zoning->corner_key ? p->zoning->corner_key[corner] : corner;
}
/* The face of the block that a face is a part of. */
static inline uint32_t tl_zone_block_face(const tl_zone_points *p, uint32_t face)
{
    return p->zoning->parts ? p->zoning->parts->face_of[face] : face;
}
/* The least altitude of a zone: 3 volumes over its largest triangle. Negative where it is turned inside out. */
static inline double tl_zone_altitude(tl_vec3 a, tl_vec3 b, tl_vec3 c, tl_vec3 d)
{
    const tl_vec3 ab = tl_v3_sub(b, a), ac = tl_v3_sub(c, a), ad = tl_v3_sub(d, a);
    const tl_vec3 abc = tl_v3_cross(ab, ac), acd = tl_v3_cross(ac, ad), adb = tl_v3_cross(ad, ab);
    const tl_vec3 bcd = tl_v3_add(tl_v3_add(abc, acd), adb);
    const double most =
        tl_larger(tl_larger(tl_v3_norm2(abc), tl_v3_norm2(acd)), tl_larger(tl_v3_norm2(adb), tl_v3_norm2(bcd)));
    return most > 0 ? tl_v3_dot(ab, acd) / sqrt(most) : 0;
}
/* The share of a zone: its least altitude over the wanted edge. */
static inline double tl_zone_share(const tl_zone_points *p, const uint32_t v[4])
{
    const tl_vec3 *x = p->place;
    const double *size = p->size;
    return tl_zone_altitude(x[v[0]], x[v[1]], x[v[2]], x[v[3]]) * 4 /
           (size[v[0]] + size[v[1]] + size[v[2]] + size[v[3]]);
}
/* A place in the frame as the block's vertices are given. */
tl_vec3 tl_zone_out_of_frame(const tl_zone_points *points, tl_vec3 place);

#endif
