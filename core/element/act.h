/* act.h - elements act on their nodes. */
#ifndef TL_ELEMENT_ACT_H
#define TL_ELEMENT_ACT_H

#include "element/elements.h"
#include "model/contributor.h"

/* Asks all kinds for the forces at the present places. The first failure is told with its element; the step is then to
 * be undone. */
tl_status tl_elements_apply(tl_model *m, tl_failure *failure);
/* The force of all nodes on each body, force[rows of bodies], N, at the present places. Nothing changes by it.
 * TL_E_MEMORY, or a failure of a kind. */
tl_status tl_elements_sum(tl_model *m, tl_vec3 *force);
/* Adds what nodes do to rigid bodies. */
void tl_elements_gather(const tl_model *m, uint32_t begin, uint32_t end, tl_acting *on);
/* Adds what nodes do to gridpoints. */
void tl_elements_push(tl_model *m);
/* Adds how stiff gridpoints are held, N/m, and to damping[rows of gridpoints] how they are damped, N s/m. */
void tl_elements_stiffen(tl_model *m, double *damping);
/* The sum of the stiffnesses of the nodes on a rigid body, N/m. */
double tl_elements_stiffness(const tl_model *m, uint32_t body);
/* How nodes hold a rigid body: stiffness and damping. */
void tl_elements_hold(const tl_model *m, uint32_t body, tl_holding *sum);
/* The largest stiffness, N/m, and damping, N s/m, of a node on a body that can move. */
double tl_elements_stiffest(const tl_model *m, double *damping);
/* What all elements hold, and have turned to heat and brought in during the step, J. */
tl_energies tl_elements_energies(tl_model *m);

#endif
