/* solid_columns.h - zones as columns of one array, for those who call a solid on zones of their own making. */
#ifndef TL_BASE_SOLID_COLUMNS_H
#define TL_BASE_SOLID_COLUMNS_H

#include "base/kind_states.h"

/* Columns of a batch. */
enum {
    TL_ZONE_AT_VOLUME,
    TL_ZONE_AT_EXTENT,
    TL_ZONE_AT_STRAIN,
    TL_ZONE_AT_STRESS = TL_ZONE_AT_STRAIN + 6, /* from here on the solid writes */
    TL_ZONE_AT_STORED = TL_ZONE_AT_STRESS + 6,
    TL_ZONE_AT_DISSIPATED,
    TL_ZONE_AT_STATE,
    TL_ZONE_AT_COUNT = TL_ZONE_AT_STATE + TL_SOLID_COLUMNS
};

/* A batch of the columns from `first` on, `stride` numbers apart. `state` gets where the columns of `states` states
 * are. */
static inline tl_solid_batch tl_solid_batch_of(double *first, size_t stride, uint32_t *flags, double **state,
                                               int states)
{
    tl_solid_batch batch = {.size = sizeof batch,
                            .volume = first + TL_ZONE_AT_VOLUME * stride,
                            .extent = first + TL_ZONE_AT_EXTENT * stride,
                            .state = state,
                            .flags = flags,
                            .stored = first + TL_ZONE_AT_STORED * stride,
                            .dissipated = first + TL_ZONE_AT_DISSIPATED * stride};
    for (size_t k = 0; k < 6; k++) {
        batch.strain[k] = first + (TL_ZONE_AT_STRAIN + k) * stride;
        batch.stress[k] = first + (TL_ZONE_AT_STRESS + k) * stride;
    }
    for (int k = 0; k < states; k++)
        state[k] = first + (size_t)(TL_ZONE_AT_STATE + k) * stride;
    return batch;
}

#endif
