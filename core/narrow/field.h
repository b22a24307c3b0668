/* field.h - the pressure field of two convex blocks: energy, force and moment of what they have in common.
 *
 * The depth d(x) of a point in a block is its least distance from the planes of the block's faces. Blocks A and B with
 * the common volume K store the energy
 *
 *     U = 2 kn G,    G = int over K of min(d_A, d_B) dV
 *
 * (after Elandt, Drumwright, Sherman and Ruina, IROS 2019: "A pressure field model for fast, robust approximation of
 * net contact force and moment between nominally rigid objects"). Its gradient is a traction on the surface S inside K
 * where d_A = d_B = d. S is plane where face a of A and face b of B are the nearest:
 *
 *     force on B = 2 kn int over S of d n dS,    n = (n_a - n_b) / |n_a - n_b|
 *
 * Two flush faces of common area A that overlap by o give U = kn A o^2 / 2 and the force kn A o.
 *
 * A *border* is a face that bounds K and does not count for the depth. The gradient then has a share on the borders,
 * too. A seam is a border where the next part of a joined body begins. There K gets in motion what the K of the next
 * part loses. The force of the pair is the gradient and what passes through. The sum over the parts is the gradient of
 * the body's energy.
 *
 * Normals are unit vectors that point out of their block; a face's plane is n . x = c. All is in one frame, whose
 * origin should lie near K. The relative error of the sums is some roundings of the distance from it over the size of
 * K. */
#ifndef TL_NARROW_FIELD_H
#define TL_NARROW_FIELD_H

#include "narrow/field_sums.h"

#include <talus/plugin.h>

/* Memory that the functions below work in; zero at first. */
typedef struct tl_field_scratch {
    struct tl_field_line *line;
    struct tl_field_plane *plane;
    uint16_t *number;
    uint32_t lines, numbers;
} tl_field_scratch;

/* Pairs that are integrated together. */
#define TL_FIELD_PAIRS TL_LANES

/* All integrals of up to TL_FIELD_PAIRS pairs, and new meshes. false: out of memory. */
bool tl_field_integrate(const tl_field_faces *const faces[], tl_field_sums *const sums[], uint32_t count,
                        tl_field_scratch *scratch);

#endif
