/* copy.h - a second detection in the same state as the first (copy.c). */
#ifndef TL_CONTACT_COPY_H
#define TL_CONTACT_COPY_H

#include "contact/detection.h"
#include "model/model.h"

/* What the next step goes on from, or NULL where that finds all anew: what was found for somebody who asked is no part of it. */
static inline tl_detect *tl_detect_lasting(const tl_model *m)
{
    return m->only_asked ? NULL : m->stepped ? m->stepped : m->detect;
}

/* NULL when out of memory. */
tl_detect *tl_detect_copy(const tl_detect *from);

#endif
