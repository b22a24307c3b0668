/* placing.h - what a call of a kind places, and the lists that services have given it. */
#ifndef TL_ELEMENT_PLACING_H
#define TL_ELEMENT_PLACING_H

#include "element/elements.h"

/* An element that is to be made. */
typedef struct tl_placed {
    uint32_t set; /* among those of the call */
    uint32_t node_count;
    uint64_t key;
    size_t node, node_state, state; /* where its nodes, and the states of these and of the whole, begin */
} tl_placed;

/* Finds outer faces. A module above gives it: NULL, there are none to ask for. */
typedef tl_status (*tl_faces_fn)(tl_model *m, const char *group, tl_vec3 facing, double angle, tl_element_face **faces,
                                 tl_vec3 **corners, size_t *count);

/* What one call, or one that is repeated, places. */
typedef struct tl_placing {
    tl_element_host host;
    tl_model *m;
    tl_faces_fn find_faces;
    const tl_kind *kind;
    uint32_t set;
    tl_placed *placed;
    tl_element_node *node; /* of all elements, one after the other */
    double *number;        /* states */
    size_t placed_count, placed_capacity, node_count, node_capacity, number_count, number_capacity;
    tl_line_node *line; /* lists that services have given */
    tl_element_face *face;
    tl_vec3 *face_corner;
    tl_element_wall *wall;
    tl_vec3 *wall_corner;
    size_t line_capacity, wall_count, wall_capacity, wall_corner_count, wall_corner_capacity;
} tl_placing;

#endif
