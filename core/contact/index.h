/* index.h - the contacts of a block, and the contact of two. */
#ifndef TL_CONTACT_INDEX_H
#define TL_CONTACT_INDEX_H

#include "contact/detection.h"
#include "model/model.h"

/* Lists the contacts of each block, and notes whether some have no rows for points; after contacts have come, gone or
 * been given room. false when out of memory. */
bool tl_contacts_index(tl_model *m);
/* Contacts have gone, or rows of contacts or blocks have changed: all are to be listed anew. */
void tl_contacts_unlist(tl_detect *d);
/* Row of the contact of two blocks, by their ids, when contacts are listed; TL_NO_ROW: they have none. */
uint32_t tl_contact_row(const tl_model *m, tl_id a, tl_id b);

#endif
