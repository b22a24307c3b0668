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
tl_status tl_law_make(const tl_kind *kind, const tl_args *args, const char *context, tl_error *error, tl_law *out);
/* Points in the first `count` lanes, with copies of what a law changes in `before`. The caller gives areas, initial
 * forces, and the closures of edges and of what is apart. */
tl_law_batch tl_lanes_batch(const tl_model *m, const tl_point_lanes *lanes, size_t count);
/* Asks a law for the forces of points. */
tl_status tl_law_update(const tl_law *law, const tl_law_batch *batch, tl_report *report);
/* Makes a law from a plugin's law and arguments; with `from`, properties not given are taken from it. What the scope
 * lists belongs to it then; after a failure still to the caller. */
tl_status tl_law_make_for(tl_model *m, const tl_scope *scope, const tl_kind *kind, const tl_args *args,
                          const tl_law *from, tl_law *out);

#endif
