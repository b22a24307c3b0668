/* heirs.h - the parts of a patch carry what the whole would have carried. */
#ifndef TL_FORCE_HEIRS_H
#define TL_FORCE_HEIRS_H

#include "contact/estate.h"
#include "contact/layout.h"
#include "model/model.h"

#include <stdbool.h>

/* Notes in its estate what a patch would carry in the next step that ends because a block of it was cut. */
void tl_estate_weigh(tl_model *m, uint32_t contact, tl_estate *estate, const tl_testator *a,
                     const tl_testator *b);
/* After all parts have taken over their shares: brings them to where they carry the same. false: out of memory. */
bool tl_heirs_carry(tl_model *m);

/* Most numbers that are looked for. */
#define TL_ROOTS 6
/* Tolerance: error over the forces that is none. */
#define TL_ROOTS_EXACT 1e-11

#endif
