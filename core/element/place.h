/* place.h - a kind places its elements: what it asks of the host, and what comes of it. */
#ifndef TL_ELEMENT_PLACE_H
#define TL_ELEMENT_PLACE_H

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

/* Begins, without elements; free it with tl_placing_free. */
void tl_placing_begin(tl_placing *p, tl_model *m, tl_faces_fn find_faces);
/* Asks the kind of a set to place its elements, which get the number `set`. */
tl_status tl_placing_ask(tl_placing *p, const tl_element_set *of, uint32_t set);
/* Appends rows for all that has been placed; set k of the call is set `first_set` + k of the model. Nothing has changed
 * when it fails: TL_E_MEMORY. */
tl_status tl_placing_commit(tl_placing *p, uint32_t first_set);
void tl_placing_free(tl_placing *p);

/* Lists walls (walls.c). */
tl_status tl_walls_find(tl_placing *p, const tl_wall_filter *filter);
/* Lists nodes on a line (line.c). */
tl_status tl_line_find(tl_placing *p, tl_vec3 from, tl_vec3 to, double spacing, size_t *count);

#endif
