/* flow.h - element "flow": water that flows in joints. */
#ifndef WATER_FLOW_H
#define WATER_FLOW_H

#include <talus/kit.h>

typedef struct flow_params {
    double aperture, residual, maximum, viscosity, unit_weight, bulk, initial_head, drain_gap;
    const char *apertures, *joints;
    tl_points heads, drains;
    int64_t every;
    int32_t steady;
} flow_params;

enum { FLOW_PARAMS = 14, FLOW_STATES = 15 };
extern const tl_param flow_param_table[FLOW_PARAMS];
extern const tl_state flow_state_table[FLOW_STATES];
extern const tl_element_ops flow_ops;

/* States of a node. A corner of the first wall is where a side of the polygon begins: it bears the side's crossing. */
enum { FLOW_PRESSURE, FLOW_SOURCE, FLOW_TOUCHING, FLOW_CROSSING };
/* States of the whole. */
enum {
    FLOW_AREA,
    FLOW_OPENING,
    FLOW_DRY,
    FLOW_APERTURE,
    FLOW_FLOW,
    FLOW_HEAD,
    FLOW_ROLE,
    FLOW_CLOSED,
    FLOW_TIME,
    FLOW_WATER,
    FLOW_VOID
};
/* What an element is. A head has two nodes, the corners of its box; a drain the ends of its line, with its radius as
 * their weight. */
enum { FLOW_JOINT, FLOW_AT_HEAD, FLOW_AT_DRAIN };

/* Constant: radius of a square cell at which the pressure of a well in it is that of the cell, over its width (Peaceman
 * 1978). */
#define FLOW_WELL_RADIUS 0.2

/* Whether a place is in a box. */
bool flow_in_box(tl_vec3 least, tl_vec3 most, tl_vec3 x);
/* Whether the line from a to b passes the polygon with the normal n, of which three or more corners are given in their
 * order; then *z is the height of that place, m. */
bool flow_drain_meets(const tl_vec3 *corner, size_t count, tl_vec3 n, tl_vec3 a, tl_vec3 b, double *z);
/* Marks the cells whose network has neither a head nor a drain; cells that are marked before are in none. Cell i has
 * the sides first[i] .. first[i + 1], side k lies at crossing[k]. `open` tells which crossings have a head, `drained`
 * which cells a drain. false: out of memory. */
bool flow_find_closed(size_t cells, const uint32_t *first, const uint32_t *crossing, size_t crossings,
                      const unsigned char *open, const unsigned char *drained, unsigned char *closed);

/* The operation `together` of the kind: finds pressures and flows. */
tl_status flow_solve(const void *self, const tl_element_batch *batch, tl_report *report);

#endif
