/* stress.h - initial stress: tractions on the face patches that exist now. */
#ifndef TL_FORCE_STRESS_H
#define TL_FORCE_STRESS_H

#include "model/model.h"

/* The stress at a height. */
tl_sym3 tl_insitu_stress(const tl_insitu *s, double z);
/* Puts it on a contact, whose points have initial forces (tl_detect_hold_initial). */
void tl_insitu_load(tl_model *m, const tl_insitu *s, uint32_t contact);

#endif
