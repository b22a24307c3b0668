/* prefetch.h - prefetches what a SIMD group will need, some SIMD groups before: its contacts' bodies, facets and
 * shapes, and its points, a little of each of some twenty columns. The processor's own prefetchers do not foresee these
 * addresses: without this a step out of cache would wait for memory most of the time. */
#ifndef TL_CONTACT_PREFETCH_H
#define TL_CONTACT_PREFETCH_H

#include "base/inline.h"
#include "contact/sides.h"

/* Bytes of points that no longer fit the nearer caches: within them a prefetch gains nothing and costs some percent. */
#define TL_FAR (4u << 20)
/* Bytes that memory hands over at a time. */
#define TL_CACHE_LINE 64

/* Whether there are so many points that prefetching pays. */
static inline bool tl_points_are_far(const tl_detect *d)
{
    return tl_table_bytes(&d->points.table) > TL_FAR;
}

/* The empty asm keeps the compiler from removing a function that only prefetches. */
TL_INLINE void tl_prefetch(const void *from, size_t bytes)
{
    const char *begin = from, *end = begin + bytes;
    for (const char *line = begin - (uintptr_t)from % TL_CACHE_LINE; line < end; line += TL_CACHE_LINE)
        __builtin_prefetch(line);
    __asm__ volatile("");
}

/* Some rows of points. */
static inline void tl_prefetch_points(const tl_points_table *p, size_t first, size_t count)
{
    const double *column[] = {p->p[0],   p->p[1],   p->p[2],   p->area,      p->f_n,
                              p->f_s[0], p->f_s[1], p->f_s[2], p->reference, p->f_n0};
    for (size_t k = 0; k < sizeof column / sizeof *column; k++)
        if (column[k])
            tl_prefetch(column[k] + first, count * sizeof(double));
}

/* What a contact needs in any case; false for one of a block that is gone. */
static inline bool tl_prefetch_bodies(const tl_model *m, uint32_t contact)
{
    const tl_contacts *contacts = &m->detect->contacts;
    uint32_t a = contacts->a[contact], b = contacts->b[contact];
    if (a >= m->blocks.table.rows || b >= m->blocks.table.rows)
        return false;
    const tl_sides sides = tl_contact_sides(m, contact);
    tl_prefetch(tl_side_pose(m, sides.a), sizeof(tl_pose));
    tl_prefetch(tl_side_pose(m, sides.b), sizeof(tl_pose));
    tl_prefetch(&contacts->facet[contact], sizeof *contacts->facet);
    return true;
}

#endif
