/* shell.h - a patch of a shell on springs: finds its displacements, and the forces on what holds it. */
#ifndef LINER_SHELL_H
#define LINER_SHELL_H

#include "facet.h"

#include <stdbool.h>
#include <talus/plugin.h>
#include <talus/skyline.h>

/* How a corner is held by the rock: not at all, by the bond, or as it presses on it. */
enum { SHELL_FREE, SHELL_BONDED, SHELL_PRESSED };
/* How a facet is torn: not at all; cracked on one face, so it bears no moment; or through, so it bears nothing. */
enum { SHELL_SOUND, SHELL_HINGE, SHELL_THROUGH };

typedef struct shell_material {
    facet_stiffness facet;
    double thickness;     /* m */
    double normal, shear; /* Pa/m, of the bond */
} shell_material;

/* Facets that hang together, from the place where they were installed on: turned by `turn` about `middle`, which moved
 * by `shift`. */
typedef struct shell_part {
    double weight;                              /* m2 of the facets that tell its motion; 0: nothing holds it */
    tl_vec3 middle, shift, net, moment, spread; /* net: of forces, what rounding has left */
    tl_mat3 sum, turn;
} shell_part;

/* Lies in the memory that the host keeps. Corners are those of the element, three for each facet. */
typedef struct shell {
    uint32_t corners, nodes;
    bool laid, factorised;
    tl_skyline matrix;
    uint16_t *node;                      /* [corners] node of the shell */
    uint16_t *side;                      /* [corners] freedom of the side across a corner */
    uint16_t *freedom;                   /* [nodes] first freedom of a node */
    uint16_t *part;                      /* [nodes] which of `of` */
    unsigned char *held, *torn, *counts; /* of corners and facets; whether a facet tells the motion of its part */
    double *sign;                        /* [corners] of the rotation of a side */
    facet *facet;
    shell_part *of;     /* [nodes] */
    double *q;          /* m and rad, freedoms, as if parts had not moved */
    tl_vec3 *d, *force; /* [corners] displacement of the rock, m, and force of the rock on the shell, N, likewise */
} shell;

/* Bytes for a patch: element e of a batch whose column `number` has the nodes of the shell. */
size_t shell_bytes(const tl_element_batch *b, uint32_t e, const double *number);
/* The shell in memory that is 0 or has been opened before. */
shell *shell_open(void *memory, const tl_element_batch *b, uint32_t e, const double *number);

/* Says how it is held and torn: `held` of corners, `torn` of facets. */
void shell_hold(shell *s, const tl_element_batch *b, uint32_t e, const shell_material *of, const unsigned char *held,
                const unsigned char *torn);
/* Finds where it is and what holds it. Gives the energy of shell and bond, J. */
double shell_solve(shell *s, const tl_element_batch *b, uint32_t e, const shell_material *of);

/* Stresses of the bond at a corner, Pa: tension positive; gap < 0 presses. */
void shell_bond(const shell *s, const shell_material *of, uint32_t corner, double *tension, double *shear);
/* Membrane forces, N/m, and moments, N m/m, of a facet in its plane. */
void shell_stress(const shell *s, const shell_material *of, uint32_t triangle, double force[3], double moment[3]);
/* Forces on the rock, N, into the batch. They and their moments add up to zero. */
void shell_push(const shell *s, const tl_element_batch *b, uint32_t e);

#endif
