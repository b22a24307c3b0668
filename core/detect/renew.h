/* renew.h - the facets of a rank brought up to the present place (renew.c). */
#ifndef TL_DETECT_RENEW_H
#define TL_DETECT_RENEW_H

#include "contact/layout.h"
#include "model/model.h"

/* Brings the facets of the contacts of a rank up to the present place, if they are stale; `pending` tells what is left
 * to do. false when none was. */
bool tl_rank_update(tl_model *m, const tl_rank *rank, unsigned thread);

#endif
