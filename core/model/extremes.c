/* extremes.c - the volume of all blocks, and the smallest volume, edge and face, kept while blocks come and go: a report on each
 * of many edits must not look at all blocks. They are found anew when a block goes that may have been the smallest. */
#include "model/model.h"

/* A block this near to the smallest may be it: above the rounding of shapes that are turned. */
#define AS_SMALL (1 + 1e-9)

typedef struct measures {
    double volume, edge, face;
} measures;

static measures measure(const tl_model *m, uint32_t row)
{
    const tl_poly *shape = m->blocks.shape[row];
    measures out = {m->blocks.volume[row], tl_poly_shortest_edge(shape), INFINITY};
    for (uint32_t f = 0; f < shape->face_count; f++)
        out.face = fmin(out.face, tl_poly_face_area(shape, f));
    return out;
}

void tl_extremes_add(tl_model *m, uint32_t row)
{
    tl_extremes *x = &m->extremes;
    if (!x->known)
        return;
    measures of = measure(m, row);
    x->total += of.volume;
    x->volume = fmin(x->volume, of.volume);
    x->edge = fmin(x->edge, of.edge);
    x->face = fmin(x->face, of.face);
}

void tl_extremes_drop(tl_model *m, uint32_t row)
{
    tl_extremes *x = &m->extremes;
    if (!x->known)
        return;
    measures of = measure(m, row);
    x->total -= of.volume;
    x->known = of.volume > AS_SMALL * x->volume && of.edge > AS_SMALL * x->edge &&
               of.face > AS_SMALL * x->face;
}

tl_extremes tl_extremes_of(tl_model *m)
{
    tl_extremes *x = &m->extremes;
    if (!x->known) {
        *x = (tl_extremes){true, 0, INFINITY, INFINITY, INFINITY};
        for (uint32_t row = 0; row < m->blocks.table.rows; row++)
            if (m->blocks.stays[row])
                tl_extremes_add(m, row);
    }
    return *x;
}
