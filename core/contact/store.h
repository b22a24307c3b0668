/* store.h - what belongs to the detection as a whole. */
#ifndef TL_CONTACT_STORE_H
#define TL_CONTACT_STORE_H

#include "base/walk.h"
#include "contact/detection.h"
#include "contact/kind.h"
#include "model/model.h"

/* A detection without pairs and contacts, for so many threads, that knows some kinds of contact; NULL when out of
 * memory. */
tl_detect *tl_detect_make(unsigned threads, const tl_contact_kind *const *kinds, uint32_t count);
void tl_detect_destroy(tl_detect *d);
/* Makes sure that points have initial forces and the overlaps they belong to, or so many columns of states; false when
 * out of memory (nothing changed). */
bool tl_detect_hold_initial(tl_detect *d);
bool tl_detect_hold_states(tl_detect *d, uint32_t columns);
/* Makes sure that contacts have what those of deformable blocks need; likewise. */
bool tl_detect_hold_carriers(tl_detect *d);

/* All that contacts of cut blocks have left has been taken over. */
void tl_cut_contacts_end(tl_detect *d);
/* Gives the lanes of all threads room for a tile, or the largest SIMD group of a layout; false when out of memory. */
bool tl_detect_make_lanes(tl_detect *d, const tl_layout *layout);

/* What the next step goes on from, or NULL where that finds all anew: what was found for somebody who asked is no part
 * of it. */
static inline tl_detect *tl_detect_lasting(const tl_model *m)
{
    return m->found_for == TL_FOR_STEPS ? m->detect : m->stepped;
}

/* NULL when out of memory. */
tl_detect *tl_detect_copy(const tl_detect *from);

/* Visits what a detection keeps. The scratch of its threads is not among it. */
void tl_detect_walk(tl_detect *d, const tl_walk *walk);

/* Forgets what was found of contacts that are to be made. */
void tl_births_end(tl_detect *d);

#endif
