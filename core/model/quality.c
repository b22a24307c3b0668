/* quality.c - how good the blocks are that cutting made: volume kept, the smallest and the thinnest of
 * them, and the cuts that were refused.
 *
 * Volumes are summed with the rounding carried along (Neumaier). What shows as an error of a million blocks is then
 * that of the cuts and not of the sum. */
#include "geometry/measure.h"
#include "model/model.h"
#include "model/rows.h"

/* A sum and what its rounding lost. */
typedef struct careful_sum {
    double sum, lost;
} careful_sum;

static void add(careful_sum *s, double term)
{
    double sum = s->sum + term;
    s->lost += fabs(s->sum) >= fabs(term) ? (s->sum - sum) + term : (term - sum) + s->sum;
    s->sum = sum;
}

static void note_smallest(tl_extreme *extreme, double value, tl_id block)
{
    if (extreme->block == TL_NO_ID || value < extreme->value)
        *extreme = (tl_extreme){value, block};
}

static double smallest_face(const tl_poly *shape)
{
    double smallest = INFINITY;
    for (uint32_t f = 0; f < shape->face_count; f++)
        smallest = fmin(smallest, tl_poly_face_area(shape, f));
    return smallest;
}

tl_status tl_model_quality(tl_model *m, tl_quality *quality)
{
    tl_rows_tidy(m);
    const tl_blocks *b = &m->blocks;
    const tl_cut_record *record = &m->record;
    *quality = (tl_quality){.blocks = b->table.rows,
                            .bodies = m->bodies.table.rows,
                            .cuts = record->cuts,
                            .refused = record->refused,
                            .coincident = record->coincident,
                            .refused_cuts = record->list,
                            .refused_listed = record->listed};
    careful_sum volume = {0, 0};
    for (uint32_t row = 0; row < b->table.rows; row++) {
        const tl_poly *shape = b->shape[row];
        tl_id id = b->id[row];
        add(&volume, b->volume[row]);
        note_smallest(&quality->smallest_volume, b->volume[row], id);
        note_smallest(&quality->smallest_edge, tl_poly_shortest_edge(shape), id);
        note_smallest(&quality->smallest_face, smallest_face(shape), id);
        double aspect = tl_poly_diameter(shape) / tl_poly_thickness(shape);
        if (aspect > quality->worst_aspect.value)
            quality->worst_aspect = (tl_extreme){aspect, id};
    }
    quality->volume = volume.sum + volume.lost;
    add(&volume, record->deleted);
    add(&volume, -record->created);
    if (quality->volume > 0)
        quality->volume_error = fabs(volume.sum + volume.lost) / quality->volume;
    return TL_OK;
}
