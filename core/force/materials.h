/* materials.h - a law and its properties, for a joint (materials.c). */
#ifndef TL_FORCE_MATERIALS_H
#define TL_FORCE_MATERIALS_H

#include "model/model.h"

/* The larger of a law's kn and ks, Pa/m. */
static inline double tl_law_stiffness(const tl_material *law)
{
    return law->kn > law->ks ? law->kn : law->ks;
}

/* A law and its properties that belong to no model; `context` begins the sentence of an error. */
tl_status tl_law_make(const tl_kind *kind, const tl_args *args, const char *context,
                      tl_error *error, tl_material *out);
/* Makes a material from a law and arguments; with `from`, properties not given are taken from it. */
tl_status tl_material_make(tl_model *m, tl_tag tag, const char *joint, const tl_kind *kind,
                           const tl_args *args, const tl_material *from, tl_material *out);
/* Makes room for what a material needs of the points of contacts; false when out of memory. */
bool tl_material_reserve(tl_model *m, const tl_material *material);
/* Keeps the forces of the contacts that come under another stiffness or law by it. */
void tl_material_rebase(tl_model *m, const tl_material *material);
/* Points whose law changes its kind under the same material begin with the new law's states. */
void tl_material_reset(tl_model *m, uint32_t material, const tl_kind *kind);

#endif
