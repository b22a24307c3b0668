/* law_columns.h - contact points as columns of one array, for those who call a law on points of their own making. */
#ifndef TL_BASE_LAW_COLUMNS_H
#define TL_BASE_LAW_COLUMNS_H

#include <talus/plugin.h>

/* Columns of a batch. */
enum {
    TL_AT_AREA,
    TL_AT_CLOSURE,
    TL_AT_F_N0,
    TL_AT_NORMAL,
    TL_AT_DU_N = TL_AT_NORMAL + 3,
    TL_AT_DU_S,
    TL_AT_EDGE = TL_AT_DU_S + 3,
    TL_AT_APART,
    TL_AT_F_N, /* from here on the law writes */
    TL_AT_F_S,
    TL_AT_STORED = TL_AT_F_S + 3,
    TL_AT_DISSIPATED,
    TL_AT_STATE,
    TL_AT_COUNT = TL_AT_STATE + TL_STATE_COLUMNS
};

/* A batch of the columns from `first` on, `stride` numbers apart. `state` gets where the columns of `states` states
 * are. */
static inline tl_law_batch tl_law_batch_of(double *first, size_t stride, uint32_t *flags, double **state, int states)
{
    tl_law_batch batch = {.size = sizeof batch,
                          .area = first + TL_AT_AREA * stride,
                          .closure = first + TL_AT_CLOSURE * stride,
                          .f_n0 = first + TL_AT_F_N0 * stride,
                          .du_n = first + TL_AT_DU_N * stride,
                          .f_n = first + TL_AT_F_N * stride,
                          .state = state,
                          .flags = flags,
                          .stored = first + TL_AT_STORED * stride,
                          .dissipated = first + TL_AT_DISSIPATED * stride,
                          .closure_edge = first + TL_AT_EDGE * stride,
                          .closure_apart = first + TL_AT_APART * stride};
    for (size_t k = 0; k < 3; k++) {
        batch.normal[k] = first + (TL_AT_NORMAL + k) * stride;
        batch.du_s[k] = first + (TL_AT_DU_S + k) * stride;
        batch.f_s[k] = first + (TL_AT_F_S + k) * stride;
    }
    for (int k = 0; k < states; k++)
        state[k] = first + (size_t)(TL_AT_STATE + k) * stride;
    return batch;
}

#endif
