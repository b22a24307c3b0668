/* lanes.h - vectors, quaternions and matrices of TL_LANES things side by side, component by component. A loop over
 * lanes reads and writes them as whole vectors of the processor. */
#ifndef TL_BASE_LANES_H
#define TL_BASE_LANES_H

#include "base/inline.h"

#include <talus/plugin.h>
#include <talus/vmath.h>

typedef struct tl_lanes3 {
    double x[TL_LANES], y[TL_LANES], z[TL_LANES];
} tl_lanes3;

typedef struct tl_lanes4 {
    double w[TL_LANES], x[TL_LANES], y[TL_LANES], z[TL_LANES];
} tl_lanes4;

/* Four numbers side by side, half of the lanes or a row. */
typedef double tl_four __attribute__((vector_size(32), aligned(8), may_alias));

typedef struct tl_lanes9 {
    double m[3][3][TL_LANES];
} tl_lanes9;

TL_INLINE tl_vec3 tl_lanes3_get(const tl_lanes3 *from, size_t lane)
{
    return (tl_vec3){from->x[lane], from->y[lane], from->z[lane]};
}

TL_INLINE void tl_lanes3_put(tl_lanes3 *to, size_t lane, tl_vec3 v)
{
    to->x[lane] = v.x;
    to->y[lane] = v.y;
    to->z[lane] = v.z;
}

TL_INLINE tl_quat tl_lanes4_get(const tl_lanes4 *from, size_t lane)
{
    return (tl_quat){from->w[lane], from->x[lane], from->y[lane], from->z[lane]};
}

TL_INLINE void tl_lanes4_put(tl_lanes4 *to, size_t lane, tl_quat q)
{
    to->w[lane] = q.w;
    to->x[lane] = q.x;
    to->y[lane] = q.y;
    to->z[lane] = q.z;
}

/* From and to TL_LANES vectors that follow each other. */
TL_INLINE void tl_lanes3_load(tl_lanes3 *restrict to, const tl_vec3 *restrict from)
{
    for (size_t i = 0; i < TL_LANES; i++)
        tl_lanes3_put(to, i, from[i]);
}

TL_INLINE void tl_lanes3_store(const tl_lanes3 *restrict from, tl_vec3 *restrict to)
{
    for (size_t i = 0; i < TL_LANES; i++)
        to[i] = tl_lanes3_get(from, i);
}

TL_INLINE void tl_lanes4_load(tl_lanes4 *restrict to, const tl_quat *restrict from)
{
    for (size_t i = 0; i < TL_LANES; i++)
        tl_lanes4_put(to, i, from[i]);
}

TL_INLINE void tl_lanes4_store(const tl_lanes4 *restrict from, tl_quat *restrict to)
{
    for (size_t i = 0; i < TL_LANES; i++)
        to[i] = tl_lanes4_get(from, i);
}

/* From rows that follow each other of a column, and of a vector's three. */
TL_INLINE void tl_lanes_load(double *restrict to, const double *restrict from)
{
    for (size_t i = 0; i < TL_LANES; i++)
        to[i] = from[i];
}

TL_INLINE void tl_lanes3_load_columns(tl_lanes3 *restrict to, double *const column[3], size_t first)
{
    tl_lanes_load(to->x, column[0] + first);
    tl_lanes_load(to->y, column[1] + first);
    tl_lanes_load(to->z, column[2] + first);
}

/* Zeros. Of a loop that stores them compilers make a fill of memory, which begins slowly. */
TL_INLINE void tl_lanes_clear(double to[TL_LANES])
{
    const tl_four zero = {0, 0, 0, 0};
    *(tl_four *)to = zero;
    *(tl_four *)(to + 4) = zero;
}

/* Four rows of four numbers become four columns: x gets the first of each row, w the last. */
TL_INLINE void tl_lanes_turn(const double *const row[4], double *restrict x, double *restrict y, double *restrict z,
                             double *restrict w)
{
    const tl_four a = *(const tl_four *)row[0], b = *(const tl_four *)row[1];
    const tl_four c = *(const tl_four *)row[2], d = *(const tl_four *)row[3];
    const tl_four even_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6),
                  odd_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const tl_four even_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6),
                  odd_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    *(tl_four *)x = __builtin_shufflevector(even_ab, even_cd, 0, 1, 4, 5);
    *(tl_four *)y = __builtin_shufflevector(odd_ab, odd_cd, 0, 1, 4, 5);
    *(tl_four *)z = __builtin_shufflevector(even_ab, even_cd, 2, 3, 6, 7);
    *(tl_four *)w = __builtin_shufflevector(odd_ab, odd_cd, 2, 3, 6, 7);
}

/* Rows of TL_ROW numbers. Four of them, less tl_four others, become three columns: x, y, z of the first three
 * numbers of each. */
#define TL_ROW 8
TL_INLINE void tl_lanes_apart(const double *rows, const uint16_t of[4], const uint16_t from[4], double *restrict x,
                              double *restrict y, double *restrict z)
{
#define TL_ROWS_APART(i)                                                                                               \
    (*(const tl_four *)(rows + TL_ROW * (size_t)of[i]) - *(const tl_four *)(rows + TL_ROW * (size_t)from[i]))
    const tl_four a = TL_ROWS_APART(0), b = TL_ROWS_APART(1), c = TL_ROWS_APART(2), d = TL_ROWS_APART(3);
#undef TL_ROWS_APART
    const tl_four even_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6),
                  odd_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const tl_four even_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6),
                  odd_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    *(tl_four *)x = __builtin_shufflevector(even_ab, even_cd, 0, 1, 4, 5);
    *(tl_four *)y = __builtin_shufflevector(odd_ab, odd_cd, 0, 1, 4, 5);
    *(tl_four *)z = __builtin_shufflevector(even_ab, even_cd, 2, 3, 6, 7);
}

/* The same of rows that nothing is taken from. */
TL_INLINE void tl_lanes_turn3(const double *rows, const uint32_t of[4], double *restrict xyz)
{
    const tl_four a = *(const tl_four *)(rows + TL_ROW * (size_t)of[0]),
                  b = *(const tl_four *)(rows + TL_ROW * (size_t)of[1]);
    const tl_four c = *(const tl_four *)(rows + TL_ROW * (size_t)of[2]),
                  d = *(const tl_four *)(rows + TL_ROW * (size_t)of[3]);
    const tl_four even_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6),
                  odd_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const tl_four even_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6),
                  odd_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    *(tl_four *)xyz = __builtin_shufflevector(even_ab, even_cd, 0, 1, 4, 5);
    *(tl_four *)(xyz + TL_LANES) = __builtin_shufflevector(odd_ab, odd_cd, 0, 1, 4, 5);
    *(tl_four *)(xyz + 2 * TL_LANES) = __builtin_shufflevector(even_ab, even_cd, 2, 3, 6, 7);
}

/* Four columns of four numbers are added to four rows: the first of each to the first row. The rows may be the same
 * one. */
TL_INLINE void tl_lanes_add_rows(double *const row[4], const double *x, const double *y, const double *z,
                                 const double *w)
{
    const tl_four a = *(const tl_four *)x, b = *(const tl_four *)y, c = *(const tl_four *)z, d = *(const tl_four *)w;
    const tl_four even_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6),
                  odd_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    const tl_four even_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6),
                  odd_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    *(tl_four *)row[0] += __builtin_shufflevector(even_ab, even_cd, 0, 1, 4, 5);
    *(tl_four *)row[1] += __builtin_shufflevector(odd_ab, odd_cd, 0, 1, 4, 5);
    *(tl_four *)row[2] += __builtin_shufflevector(even_ab, even_cd, 2, 3, 6, 7);
    *(tl_four *)row[3] += __builtin_shufflevector(odd_ab, odd_cd, 2, 3, 6, 7);
}

/* Matrices element by element, not in loops: a loop over lanes with loops in it does not become SIMD code. */
TL_INLINE tl_mat3 tl_lanes9_get(const tl_lanes9 *from, size_t lane)
{
    return (tl_mat3){{{from->m[0][0][lane], from->m[0][1][lane], from->m[0][2][lane]},
                      {from->m[1][0][lane], from->m[1][1][lane], from->m[1][2][lane]},
                      {from->m[2][0][lane], from->m[2][1][lane], from->m[2][2][lane]}}};
}

TL_INLINE void tl_lanes9_put(tl_lanes9 *to, size_t lane, const tl_mat3 *m)
{
    to->m[0][0][lane] = m->m[0][0];
    to->m[0][1][lane] = m->m[0][1];
    to->m[0][2][lane] = m->m[0][2];
    to->m[1][0][lane] = m->m[1][0];
    to->m[1][1][lane] = m->m[1][1];
    to->m[1][2][lane] = m->m[1][2];
    to->m[2][0][lane] = m->m[2][0];
    to->m[2][1][lane] = m->m[2][1];
    to->m[2][2][lane] = m->m[2][2];
}

#endif
