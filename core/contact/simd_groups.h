/* simd_groups.h - the lanes of contacts in spans and SIMD groups (simd_groups.c). */
#ifndef TL_CONTACT_SIMD_GROUPS_H
#define TL_CONTACT_SIMD_GROUPS_H

#include "contact/detection.h"

/* `need` and one in `share` more, or `least` more. */
static inline size_t tl_with_spare(size_t need, size_t share, size_t least)
{
    size_t more = need / share;
    return need + (more > least ? more : least);
}

/* Gives contacts that are sorted by spans their lanes in an empty layout: sets the start and room of each by the
 * room it wants, with one in `share` to spare; *points is the number of rows. false when out of memory. */
bool tl_layout_make(tl_layout *layout, tl_contacts *contacts, size_t share, size_t *points);
void tl_layout_free(tl_layout *layout);
/* A free lane of a contact's span with room for so many points, taken for it; NULL when there is none. */
tl_simd_group *tl_simd_group_take(tl_detect *d, uint32_t points, uint32_t contact, uint32_t *lane);
/* Notes that a contact's lane belongs to that row, or to none. */
void tl_simd_group_note(tl_detect *d, uint32_t contact, uint32_t row);

#endif
