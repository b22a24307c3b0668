/* expect.c - what a rank will need, asked of the memory some ranks before: its contacts' bodies, facets and shapes, and its
 * points, a little of each of some twenty columns. The processor sees none of that coming; out of cache a step would
 * wait for memory most of the time. */
#include "contact/expect.h"

#include "base/inline.h"

#include <stdint.h>

/* Bytes of points that no longer fit the nearer caches: within them asking gains nothing and costs some percent. */
#define FAR (4u << 20)
/* Bytes that memory hands over at a time. */
#define LINE 64
/* Bytes of most shapes: one of eight corners and six faces. */
#define SHAPE 704

bool tl_points_are_far(const tl_detect *d)
{
    return tl_table_bytes(&d->points.table) > FAR;
}

/* The statement without effect keeps compilers from taking what only asks for memory for nothing, and leaving it out. */
TL_INLINE void expect(const void *from, size_t bytes)
{
    const char *begin = from, *end = begin + bytes;
    for (const char *line = begin - (uintptr_t)from % LINE; line < end; line += LINE)
        __builtin_prefetch(line);
    __asm__ volatile("");
}

static void expect_points(const tl_points_table *p, size_t first, size_t count)
{
    const double *column[] = {p->p[0],   p->p[1],   p->p[2],   p->area,      p->f_n,
                              p->f_s[0], p->f_s[1], p->f_s[2], p->reference, p->f_n0};
    for (size_t k = 0; k < sizeof column / sizeof *column; k++)
        if (column[k])
            expect(column[k] + first, count * sizeof(double));
}

/* What a contact needs in both cases; false for one of a block that is gone. */
static bool expect_bodies(const tl_model *m, uint32_t contact)
{
    const tl_contacts *contacts = &m->detect->contacts;
    uint32_t a = contacts->a[contact], b = contacts->b[contact];
    if (a >= m->blocks.table.rows || b >= m->blocks.table.rows)
        return false;
    expect(&m->bodies.pose[m->blocks.body[a]], sizeof *m->bodies.pose);
    expect(&m->bodies.pose[m->blocks.body[b]], sizeof *m->bodies.pose);
    expect(&contacts->facet[contacts->facet_start[contact]], sizeof *contacts->facet);
    return true;
}

void tl_rank_expect(const tl_model *m, const tl_rank *rank)
{
    const tl_points_table *p = &m->detect->points;
    size_t count = (size_t)rank->slots * TL_LANES;
    for (size_t l = 0; l < TL_LANES; l++)
        if (rank->contact[l] != TL_NO_ROW)
            expect_bodies(m, rank->contact[l]);
    expect_points(p, rank->start, count);
    expect(p->flags + rank->start, count * sizeof *p->flags);
}

void tl_rank_expect_contacts(const tl_detect *d, const tl_rank *rank)
{
    const tl_contacts *c = &d->contacts;
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t i = rank->contact[l];
        if (i == TL_NO_ROW)
            continue;
        expect(&c->a[i], sizeof *c->a);
        expect(&c->b[i], sizeof *c->b);
        expect(&c->tag[i], sizeof *c->tag);
        expect(&c->material[i], sizeof *c->material);
        expect(&c->axis[i], sizeof *c->axis);
        expect(&c->search[i], sizeof *c->search);
        expect(&c->until[i], sizeof *c->until);
        expect(&c->facet_start[i], sizeof *c->facet_start);
        expect(&c->facet_count[i], sizeof *c->facet_count);
        expect(&c->point_count[i], sizeof *c->point_count);
        expect(&c->lone[i], sizeof *c->lone);
    }
}

void tl_rank_expect_shapes(const tl_model *m, const tl_rank *rank)
{
    const tl_points_table *p = &m->detect->points;
    const tl_contacts *contacts = &m->detect->contacts;
    size_t count = (size_t)rank->slots * TL_LANES;
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t contact = rank->contact[l];
        if (contact == TL_NO_ROW || !expect_bodies(m, contact))
            continue;
        expect(m->blocks.shape[contacts->a[contact]], SHAPE);
        expect(m->blocks.shape[contacts->b[contact]], SHAPE);
    }
    expect_points(p, rank->start, count);
    expect(p->lean_face + rank->start, count * sizeof *p->lean_face);
    expect(p->lean_edge + rank->start, count * sizeof *p->lean_edge);
    expect(p->key + rank->start, count * sizeof *p->key);
}
