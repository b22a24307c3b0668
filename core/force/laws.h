/* laws.h - contact forces: the laws of the contacts of a model, and the sum per contact. */
#ifndef TL_FORCE_LAWS_H
#define TL_FORCE_LAWS_H

#include "base/parallel.h"
#include "contact/kind.h"
#include "contact/layout.h"
#include "model/model.h"

/* Energy in the contact points of a SIMD group, and turned to heat in this step. */
typedef struct tl_group_energy {
    double stored, dissipated;
} tl_group_energy;

/* What the laws give the step besides forces, and what the step does before they overwrite anything. */
typedef struct tl_law_phase {
    tl_failure *failure;
    tl_group_energy *energy; /* of each SIMD group of the layout */
    /* keeps what the points of some SIMD groups and their contacts carry; on any thread */
    void (*keep)(tl_model *m, const tl_simd_group *groups, size_t count);
} tl_law_phase;

/* Of each contact of a SIMD group: force on B of its points, their moment about A's centroid, and the energies of
 * their springs and slip. */
typedef struct tl_group_sums {
    double force[3][TL_LANES], moment[3][TL_LANES], stored[TL_LANES], dissipated[TL_LANES];
    double holds_over_gap[TL_LANES]; /* above 0 when a force acts across a gap */
    double odd
        [TL_LANES]; /* 0, NaN when the force or moment is not finite, 1 when shear forces may leave their planes */
} tl_group_sums;

/* Patches and field contacts, from places to forces. */
extern const tl_kind_force tl_patch_force, tl_field_force;

/* Calls the laws on their spans of contact points and sums forces per contact. */
tl_status tl_laws_apply(tl_model *m, const tl_law_phase *phase);
/* Every contact has a law, or a sentence that names one that has not. */
tl_status tl_laws_check(tl_model *m);

/* Limit: component of a shear force along the normal, relative to the whole force of the point. It holds for all
 * points of a contact together before they are looked at one by one. The host's own reaches 4e-7 where normals change
 * from point to point. Test: lua/test_law_check. */
#define TL_OUT_OF_PLANE 1e-4

#endif
