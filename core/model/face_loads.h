/* face_loads.h - what tractions on faces put on blocks, kept so that their parts get their shares: face_loads.c. */
#ifndef TL_MODEL_FACE_LOADS_H
#define TL_MODEL_FACE_LOADS_H

#include "model/model.h"

/* A mass with its centroid, relative to the origin, and its inertia about it. */
typedef struct tl_lump {
    double mass;
    tl_vec3 place;
    tl_sym3 inertia;
} tl_lump;

/* Several together, in two passes: first the masses and places of all, with `close` between, then the inertias of all. */
void tl_lump_add(tl_lump *sum, const tl_lump *part);
void tl_lump_close(tl_lump *sum);
void tl_lump_add_inertia(tl_lump *sum, const tl_lump *part);
/* What a part gets of a force and a moment about the centroid of all, about its own: as much as it needs to go on with all. Sums are kept. */
tl_wrench tl_lump_share(const tl_lump *part, const tl_lump *all, tl_wrench whole);
/* A face of a block as a plate whose mass is its area. */
tl_lump tl_face_plate(const tl_model *m, uint32_t row, uint32_t face);

/* Puts a list, which is the model's from now on, in the place of its own: sorted by block and face, those of one face added up. */
void tl_face_loads_set(tl_model *m, tl_face_load *list, size_t count, size_t capacity);
/* Forgets those of the bodies of blocks; false when out of memory (nothing changed). */
bool tl_face_loads_forget(tl_model *m, const tl_id *ids, size_t count);
/* Adds a force and a moment about a place, relative to the origin, to the load of a body. The load acts at the mean of the places, weighted
 * by the lengths of their forces. */
void tl_load_add(tl_model *m, uint32_t body, tl_wrench more, tl_vec3 place);

#endif
