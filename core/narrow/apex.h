/* apex.h - a point in which the planes of a block meet that bound the common volume (apex.c). */
#ifndef TL_NARROW_APEX_H
#define TL_NARROW_APEX_H

#include "narrow/field_faces.h"

/* Faces that may pass by the point in which the others meet. */
#define TL_APEX_STRAYS 2

/* The point, and directions that hold it in the planes, at right angles to each other. */
typedef struct tl_apex {
    tl_vec3 x, held[3];
    double per[3]; /* 1 / |held|^2 */
    int count;
    bool known;
    uint32_t stray[TL_APEX_STRAYS], strays; /* faces that pass by, and the volumes of their cells */
    double volume[TL_APEX_STRAYS];
} tl_apex;

/* Of the surface S, about the origin: int d n dS, int n dS, int d x . n dS, int x . n dS. */
typedef struct tl_apex_surface {
    tl_vec3 force, swept;
    double by_force, by_swept;
} tl_apex_surface;

/* What the cells of a block give of G and of the volume. */
typedef struct tl_apex_gives {
    double energy, volume;
} tl_apex_gives;

/* The apex of some faces of a block, all of which bound K. Planes are one within the offset `one_plane`. Faces that pass by are
 * allowed where the volume is not wanted. */
tl_apex tl_apex_find(const tl_field_faces *f, const uint16_t *face, uint32_t count,
                     double one_plane);
/* Whether the polygon between the cells of two faces of the block is needed. */
bool tl_apex_needs(const tl_apex *p, uint32_t face, uint32_t other);
/* Adds a side of the cell of a face that passes by: int d dS over it, and its normal into the cell. */
void tl_apex_add_side(tl_apex *p, const tl_field_faces *f, uint32_t face, tl_vec3 n, double d);
/* What a block gives by its apex; nothing without one. */
tl_apex_gives tl_apex_share(const tl_apex *p, const tl_field_faces *f, bool of_b,
                            const tl_apex_surface *s, tl_vec3 centre);

#endif
