/* columns.h - vectors that are kept as three columns. */
#ifndef TL_BASE_COLUMNS_H
#define TL_BASE_COLUMNS_H

#include <talus/vmath.h>

/* Row i of a vector kept as three columns. */
static inline tl_vec3 tl_columns_get(double *const column[3], size_t i)
{
    return tl_v3(column[0][i], column[1][i], column[2][i]);
}

static inline void tl_columns_put(double *const column[3], size_t i, tl_vec3 v)
{
    column[0][i] = v.x;
    column[1][i] = v.y;
    column[2][i] = v.z;
}

#endif
