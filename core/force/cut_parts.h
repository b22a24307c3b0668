/* cut_parts.h - the parts of a patch carry what the whole would have carried. */
#ifndef TL_FORCE_CUT_PARTS_H
#define TL_FORCE_CUT_PARTS_H

#include "contact/cut_contacts.h"
#include "model/model.h"

/* Notes what a patch would carry in the next step that ends because a block of it was cut. */
void tl_cut_contact_foresee(tl_model *m, uint32_t contact, tl_cut_contact *cut, const tl_cut_side *a,
                            const tl_cut_side *b);
/* After all parts have taken over their shares: brings them to where they carry what the wholes did. Then nothing more
 * is to be taken over. false: out of memory. */
bool tl_cut_parts_settle(tl_model *m);

#endif
