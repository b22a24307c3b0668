/* apex.h - the point in which the planes of one block meet that bound what two blocks have in common. */
#ifndef TL_NARROW_APEX_H
#define TL_NARROW_APEX_H

#include "narrow/field_sums.h"

/* The point, and directions that hold it in the planes, at right angles to each other. */
typedef struct tl_apex {
    tl_vec3 x, held[3];
    double per[3]; /* 1 / |held|^2 */
    int count;
    bool known;
    uint32_t stray[TL_APEX_STRAYS], strays; /* faces that pass by, and the volumes of their cells */
    double volume[TL_APEX_STRAYS];
} tl_apex;

/* Which of some faces of a block, all of which bound K, hold an apex. Planes are one within the offset `one_plane`.
 * Faces that pass by are allowed where the volume is not wanted. */
tl_apex_faces tl_apex_choose(const tl_field_faces *f, const uint16_t *face, uint32_t count, double one_plane);
/* The apex of faces that have been chosen, here or at another place. */
tl_apex tl_apex_find(const tl_field_faces *f, const tl_apex_faces *by);
/* Adds a side of the cell of a face that passes by: int d dS over it, and its normal into the cell. */
void tl_apex_add_side(tl_apex *p, const tl_field_faces *f, uint32_t face, tl_vec3 n, double d);
/* Adds what both blocks give by their apexes to the energy, the volume and, where they are wanted, the powers of d. Of
 * S: int d x . n dS, int x . n dS, int d^2 x . n dS, int d^3 x . n dS. */
void tl_apex_add_shares(const tl_apex apex[2], const tl_field_faces *f, double by_force, double by_swept,
                        const double by_power[TL_FIELD_POWERS], tl_field_sums *sums);

#endif
