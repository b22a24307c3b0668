/* prefetch.c - prefetches what a SIMD group will need, some SIMD groups before: its contacts' bodies, facets and
 * shapes, and its points, a little of each of some twenty columns. The processor's own prefetchers do not foresee these
 * addresses: without this a step out of cache would wait for memory most of the time. */
#include "contact/prefetch.h"

#include "base/inline.h"

#include <stdint.h>

/* Bytes of points that no longer fit the nearer caches: within them a prefetch gains nothing and costs some percent. */
#define FAR (4u << 20)
/* Bytes that memory hands over at a time. */
#define LINE 64
/* Bytes of most shapes: one of eight corners and six faces. */
#define SHAPE 704

bool tl_points_are_far(const tl_detect *d)
{
    return tl_table_bytes(&d->points.table) > FAR;
}

/* The empty asm keeps the compiler from removing a function that only prefetches. */
TL_INLINE void prefetch(const void *from, size_t bytes)
{
    const char *begin = from, *end = begin + bytes;
    for (const char *line = begin - (uintptr_t)from % LINE; line < end; line += LINE)
        __builtin_prefetch(line);
    __asm__ volatile("");
}

static void prefetch_points(const tl_points_table *p, size_t first, size_t count)
{
    const double *column[] = {p->p[0],   p->p[1],   p->p[2],   p->area,      p->f_n,
                              p->f_s[0], p->f_s[1], p->f_s[2], p->reference, p->f_n0};
    for (size_t k = 0; k < sizeof column / sizeof *column; k++)
        if (column[k])
            prefetch(column[k] + first, count * sizeof(double));
}

/* What a contact needs in both cases; false for one of a block that is gone. */
static bool prefetch_bodies(const tl_model *m, uint32_t contact)
{
    const tl_contacts *contacts = &m->detect->contacts;
    uint32_t a = contacts->a[contact], b = contacts->b[contact];
    if (a >= m->blocks.table.rows || b >= m->blocks.table.rows)
        return false;
    prefetch(&m->bodies.pose[m->blocks.body[a]], sizeof *m->bodies.pose);
    prefetch(&m->bodies.pose[m->blocks.body[b]], sizeof *m->bodies.pose);
    prefetch(&contacts->facet[contact], sizeof *contacts->facet);
    return true;
}

void tl_simd_group_prefetch(const tl_model *m, const tl_simd_group *group)
{
    const tl_points_table *p = &m->detect->points;
    size_t count = (size_t)group->slots * TL_LANES;
    for (size_t l = 0; l < TL_LANES; l++)
        if (group->contact[l] != TL_NO_ROW)
            prefetch_bodies(m, group->contact[l]);
    prefetch_points(p, group->start, count);
    prefetch(p->flags + group->start, count * sizeof *p->flags);
}

void tl_simd_group_prefetch_contacts(const tl_detect *d, const tl_simd_group *group)
{
    const tl_contacts *c = &d->contacts;
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t i = group->contact[l];
        if (i == TL_NO_ROW)
            continue;
        prefetch(&c->a[i], sizeof *c->a);
        prefetch(&c->b[i], sizeof *c->b);
        prefetch(&c->tag[i], sizeof *c->tag);
        prefetch(&c->law[i], sizeof *c->law);
        prefetch(&c->faces_valid_to[i], sizeof *c->faces_valid_to);
        prefetch(&c->points_valid_to[i], sizeof *c->points_valid_to);
        prefetch(&c->facet[i], sizeof *c->facet);
        prefetch(&c->point_count[i], sizeof *c->point_count);
    }
}

void tl_simd_group_prefetch_shapes(const tl_model *m, const tl_simd_group *group)
{
    const tl_points_table *p = &m->detect->points;
    const tl_contacts *contacts = &m->detect->contacts;
    size_t count = (size_t)group->slots * TL_LANES;
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t contact = group->contact[l];
        if (contact == TL_NO_ROW || !prefetch_bodies(m, contact))
            continue;
        prefetch(m->blocks.shape[contacts->a[contact]], SHAPE);
        prefetch(m->blocks.shape[contacts->b[contact]], SHAPE);
    }
    prefetch_points(p, group->start, count);
    prefetch(p->key + group->start, count * sizeof *p->key);
}
