/* quality.c - how good the blocks are that cutting made: volume kept, the smallest and the thinnest of
 * them, slivers, and the cuts that were refused.
 *
 * Volumes are summed without rounding (base/exact.h). What shows as an error of a million blocks is then that of the
 * cuts and not of the sum. */
#include "base/exact.h"
#include "geometry/measure.h"
#include "model/model.h"
#include "model/rows.h"
#include "model/slivers.h"

static void note_smallest(tl_extreme *extreme, double value, tl_id block)
{
    if (extreme->block == TL_NO_ID || value < extreme->value)
        *extreme = (tl_extreme){value, block};
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
    tl_addends volume = {.count = 0};
    for (uint32_t row = 0; row < b->table.rows; row++) {
        const tl_poly *shape = b->shape[row];
        tl_id id = b->id[row];
        tl_addends_put(&volume, b->volume[row]);
        note_smallest(&quality->smallest_volume, b->volume[row], id);
        note_smallest(&quality->smallest_edge, tl_poly_shortest_edge(shape), id);
        note_smallest(&quality->smallest_face, tl_poly_smallest_face(shape), id);
        double aspect = tl_poly_diameter(shape) / tl_poly_thickness(shape);
        if (aspect > quality->worst_aspect.value)
            quality->worst_aspect = (tl_extreme){aspect, id};
    }
    quality->volume = tl_addends_sum(&volume);
    tl_addends_put(&volume, record->deleted);
    tl_addends_put(&volume, -record->created);
    if (quality->volume > 0)
        quality->volume_error = fabs(tl_addends_sum(&volume)) / quality->volume;
    tl_sliver_limits slivers;
    const tl_status status = tl_slivers_by_shape(m, &slivers);
    quality->slivers = slivers.count;
    quality->sliver_share = slivers.share;
    quality->sliver_gain = slivers.gain;
    return status;
}
