/* joint_laws.h - a law and its properties, for a joint. */
#ifndef TL_FORCE_JOINT_LAWS_H
#define TL_FORCE_JOINT_LAWS_H

#include "contact/layout.h"
#include "model/model.h"

/* The larger of a law's kn and ks, Pa/m. */
static inline double tl_law_stiffness(const tl_law *law)
{
    return law->kn > law->ks ? law->kn : law->ks;
}

/* A law and its properties that belong to no model; `context` begins the sentence of an error. */
tl_status tl_law_make(const tl_kind *kind, const tl_args *args, const char *context,
                      tl_error *error, tl_law *out);
/* Points in the first `count` lanes, with copies of what a law changes in `before`. The caller gives areas, initial forces, and
 * the closures of edges and of what is apart. */
tl_law_batch tl_lanes_batch(const tl_model *m, const tl_point_lanes *lanes, size_t count);
/* Asks a law for the forces of points. */
tl_status tl_law_update(const tl_law *law, const tl_law_batch *batch, tl_report *report);
/* Makes the law of a joint from a plugin's law and arguments; with `from`, properties not given are taken from it. */
tl_status tl_law_make_for(tl_model *m, tl_tag tag, const char *joint, const tl_kind *kind,
                          const tl_args *args, const tl_law *from, tl_law *out);
/* Adds the columns that a law needs of the points of contacts; false when out of memory. */
bool tl_law_reserve(tl_model *m, const tl_law *law);
/* Whether a contact comes under another stiffness, curve or plugin by a law, and has forces that are to stay. */
bool tl_law_rebases(const tl_model *m, const tl_law *law, uint32_t contact);
/* Keeps the forces of the patches among these. What all of them have stored is not known any more. */
void tl_law_rebase(tl_model *m, const tl_law *law);
/* Points whose joint law becomes one of another kind begin with the new kind's states. */
void tl_law_reset(tl_model *m, uint32_t law, const tl_kind *kind);

#endif
