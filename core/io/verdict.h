/* verdict.h - how a model stands, by facts of its contacts that are known already. */
#ifndef TL_IO_VERDICT_H
#define TL_IO_VERDICT_H

#include "query/contact_fields.h"

/* The median of the sizes of the bodies that are not held, m; 0 of none. false: out of memory. */
bool tl_median_size(const tl_model *m, double *median);
/* tl_model_verdict with that, and with the rows and the facts of all contacts with points. */
tl_status tl_verdict_of(tl_model *m, double median, const uint32_t *rows, const tl_contact_facts *facts, size_t count,
                        tl_verdict *out);

#endif
