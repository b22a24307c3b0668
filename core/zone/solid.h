/* solid.h - a solid with its properties: its plugin, and what that has made of them. */
#ifndef TL_ZONE_SOLID_H
#define TL_ZONE_SOLID_H

#include "base/error.h"

#include <talus/talus.h>

typedef struct tl_solid {
    const tl_kind *kind;
    void *params;              /* the plugin's params struct; its tables lie in `rows` */
    tl_vec3 *rows;             /* of all tables */
    void *self;                /* what its create made, or params */
    uint32_t columns;          /* of its states */
    double constrained, shear; /* Pa, upper bounds of K + 4 G / 3 and of G */
} tl_solid;

/* Makes a solid of a plugin's kind and arguments; with `from`, properties not given are taken from it. `context` begins
 * the sentence of an error. On failure *out is empty. */
tl_status tl_solid_make(const tl_kind *kind, const tl_args *args, const tl_solid *from, const char *context,
                        tl_error *error, tl_solid *out);
void tl_solid_clear(tl_solid *solid);
/* What zones store at a stress, J/m3. `count` is a multiple of TL_LANES. A solid without an operation for it is asked
 * for an update without strain; what it changes in that is dropped. */
void tl_solid_energy(const tl_solid *solid, uint32_t count, const double *const stress[6], double *const *state,
                     double *stored);
/* Asks a solid for the stresses of zones. */
tl_status tl_solid_update(const tl_solid *solid, const tl_solid_batch *batch, tl_report *report);

#endif
