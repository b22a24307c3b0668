/* solve.h - the network of wet joints while its pressures are found: solve.c, and stored.c for what is stored. */
#ifndef WATER_SOLVE_H
#define WATER_SOLVE_H

#include "flow.h"

/* Tolerance: residual of the equations over that of the heads, where iterations end. What is left over is water that is
 * lost, and apertures that differ a hundredfold make it a millionfold larger. Test: lua/test_flow. */
#define FLOW_CONVERGED 1e-13

/* A drain in a cell. */
typedef struct flow_hit {
    uint32_t cell, drain;
    double conductance, phi; /* m3/s/Pa, Pa */
} flow_hit;

/* What a cell is while water is stored: stored.c. */
enum { FLOW_FULL, FLOW_PARTLY, FLOW_EMPTY };

typedef struct flow_net {
    const flow_params *p;
    const tl_element_batch *b;
    size_t cells, sides, crossings;
    uint32_t *first;          /* of the sides of a cell, [cells + 1] */
    uint32_t *crossing;       /* of a side */
    double *t;                /* of a side, m3/s/Pa */
    uint32_t *head;           /* of a crossing: row of the element + 1; 0: none */
    double *given;            /* of a crossing: its potential where it has a head, Pa */
    double *sum, *phi;        /* of a crossing: of t; its potential in the last product */
    double *x, *r, *way, *y;  /* of a cell: potential, Pa; residual, direction and product */
    double *pivot, *z;        /* of a cell: of the preconditioner; the residual as that has it, Pa */
    double *share, *later;    /* of a crossing: 1 / sum, 0 where it has a head; t of cells that are yet to come */
    double *extra, *diagonal; /* of a cell: of drains and storage; of the matrix, 0: its potential is given */
    double *leak, *linked;    /* of a cell: of drains; of the matrix without storage */
    double *source;           /* of a cell: right side without storage, m3/s */
    double *mean;             /* of a cell: potential by which it has flowed since the last call, Pa */
    double *width;            /* of a cell, m: aperture */
    double *level;            /* of a cell: its potential where the pressure is 0, Pa */
    unsigned char *closed, *open, *drained;
    flow_hit *drain;
    size_t hits, hit_capacity;
    uint32_t *head_row, *drain_row; /* of the elements that are heads and drains: they may be anywhere */
    size_t head_count, drain_count;
    double base; /* Pa: potentials count from it */
    double step; /* s; 0: none */
    bool flows;  /* flows are found: time has passed, or some have none yet */
} flow_net;

/* Solves the equations with `extra` and `diagonal` for the right side `r`, from `x`. false: they do not converge. */
bool flow_iterate(flow_net *n);
/* y = A x with `extra`, the heads 0. */
void flow_multiply(flow_net *n, const double *x, double *y);
/* What flows out of each cell at the potentials x, m3/s: to its sides and drains. Over all cells the sum is what leaves
 * at heads and drains, to rounding. `phi` has the potentials of crossings then. */
void flow_out(flow_net *n, const double *x, double *out);
/* Whether an element is a joint that water flows in. */
bool flow_is_wet(const flow_net *n, size_t e);
/* Follows stored water for the time since the last call. TL_E_NUMERIC: it does not converge; or TL_E_MEMORY. */
tl_status flow_follow(flow_net *n);
/* Counts the water of joints where it has not been counted yet. A new part of a joint is as full as that was. */
void flow_count_water(flow_net *n);

#endif
