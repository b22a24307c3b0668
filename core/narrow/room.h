/* room.h - the memory that the geometry of a pair works in (room.c). */
#ifndef TL_NARROW_ROOM_H
#define TL_NARROW_ROOM_H

#include "narrow/narrow.h"

/* Frees what a room holds, not the room. */
void tl_narrow_free(tl_narrow *room);

/* Makes room for `count` points more; false when out of memory. */
bool tl_manifold_reserve(tl_manifold *m, size_t count);
#endif
