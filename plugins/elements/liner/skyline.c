/* skyline.c - L D L^t within the skyline of a symmetric matrix (Jennings 1966). */
#include "skyline.h"

/* Tolerance: pivot over the entry of the diagonal that it comes from, below which it is rounding. Test:
 * lua/test_liner. */
#define NO_PIVOT 1e-11

/* In four sums, which do not wait for each other. */
static inline double dot(const double *a, const double *b, size_t count)
{
    double sum[4] = {0, 0, 0, 0};
    size_t k = 0;
    for (; k + 4 <= count; k += 4)
        for (size_t i = 0; i < 4; i++)
            sum[i] += a[k + i] * b[k + i];
    for (; k < count; k++)
        sum[0] += a[k] * b[k];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

void skyline_factorise(skyline *s)
{
    for (uint32_t i = 0; i < s->count; i++) {
        double *row = s->entry + s->at[i];
        const uint32_t from = s->first[i];
        for (uint32_t j = from; j < i; j++) {
            const uint32_t low = from > s->first[j] ? from : s->first[j];
            if (low < j)
                row[j - from] -= dot(row + (low - from), s->entry + s->at[j] + (low - s->first[j]), j - low);
        }
        double pivot = s->diagonal[i];
        for (uint32_t j = from; j < i; j++) {
            const double whole = row[j - from];
            row[j - from] = whole * s->diagonal[j];
            pivot -= whole * row[j - from];
        }
        s->diagonal[i] = pivot > NO_PIVOT * s->diagonal[i] ? 1 / pivot : 0;
    }
}

void skyline_solve(const skyline *s, double *x)
{
    for (uint32_t i = 0; i < s->count; i++)
        x[i] -= dot(s->entry + s->at[i], x + s->first[i], i - s->first[i]);
    for (uint32_t i = 0; i < s->count; i++)
        x[i] *= s->diagonal[i];
    for (uint32_t i = s->count; i-- > 0;) {
        const double *row = s->entry + s->at[i];
        const double own = x[i];
        for (uint32_t j = s->first[i]; j < i; j++)
            x[j] -= row[j - s->first[i]] * own;
    }
}
