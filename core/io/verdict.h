/* verdict.h - how a model stands, by facts of its contacts that are known already. */
#ifndef TL_IO_VERDICT_H
#define TL_IO_VERDICT_H

#include "query/contact_fields.h"

/* tl_model_verdict with the median of the sizes of bodies (tl_median_size), and with the rows and the facts of all
 * contacts. Blocks that meet by segments are among them (tl_contacts_listed). */
tl_status tl_verdict_of(tl_model *m, double median, const uint32_t *rows, const tl_contact_facts *facts, size_t count,
                        tl_verdict *out);

#endif
