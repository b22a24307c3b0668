/* renew.h - the facets of a SIMD group brought up to the present place (renew.c). */
#ifndef TL_DETECT_RENEW_H
#define TL_DETECT_RENEW_H

#include "contact/layout.h"
#include "model/model.h"

/* Brings the facets of the contacts of a SIMD group up to the present place, if they are stale; `pending` tells what is left
 * to do. false when none was. */
bool tl_simd_group_update(tl_model *m, const tl_simd_group *group, unsigned thread);

#endif
