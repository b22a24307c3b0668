/* kinds.h - the kinds of contact that there are. */
#ifndef TL_DETECT_KINDS_H
#define TL_DETECT_KINDS_H

#include "contact/kind.h"

/* By the numbers of their facets. */
extern const tl_contact_kind *const tl_contact_kinds[TL_FACET_KINDS];

#endif
