/* skyline.c - the lowest eigenvalues of a symmetric matrix that is kept within its skyline.
 *
 * Subspace iteration (Bathe and Wilson, Int. J. Numer. Meth. Eng. 6, 1973): p vectors X are replaced by
 * Y = A^-1 X, made orthonormal, Q. With B = L D^(1/2), so that A = B B^T, Q^T A Q = (B^T Q)^T (B^T Q) is a small
 * matrix. Its eigenvectors V give the next X = Q V. An error falls by lambda_k / lambda_(p + 1) with each pass. One
 * order of sums throughout: the same bits anywhere. */
#include "base/skyline.h"

#include "base/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Tolerance: change of an eigenvalue in a pass, relative to it, from which on it stands: the vectors are then known to
 * about the root of it. Test: lua/test_modes. */
#define STANDS 1e-13
/* Limit: passes; each gains a digit or so, unless eigenvalues lie close at the end of the subspace. */
#define PASSES 200
/* Limit: sweeps of Jacobi's method; it takes six or seven. */
#define SWEEPS 60

bool tl_skyline_make(tl_skyline *a, size_t size, size_t *first)
{
    *a = (tl_skyline){.size = size,
                      .first = first,
                      .start = malloc((size + 1) * sizeof *a->start),
                      .diagonal = calloc(size + 1, sizeof *a->diagonal)};
    size_t count = 0;
    for (size_t i = 0; a->start && i < size; i++) {
        a->start[i] = count;
        count += i - first[i];
    }
    a->entry = calloc(count + 1, sizeof *a->entry);
    return a->start && a->entry && a->diagonal;
}

void tl_skyline_free(tl_skyline *a)
{
    free(a->first);
    free(a->start);
    free(a->entry);
    free(a->diagonal);
    *a = (tl_skyline){.size = 0};
}

/* y = D^(1/2) L^T x, of a factorised matrix. */
static void multiply_transposed(const tl_skyline *a, const double *x, double *y)
{
    memcpy(y, x, a->size * sizeof *y);
    for (size_t i = 0; i < a->size; i++) {
        const double *row = a->entry + a->start[i];
        for (size_t k = a->first[i]; k < i; k++)
            y[k] += row[k - a->first[i]] * x[i];
    }
    for (size_t i = 0; i < a->size; i++)
        y[i] /= sqrt(a->diagonal[i]);
}

/* ---------------------------------------------------------------- small matrices ---------- */

/* Turns rows and columns p and q of h, and the columns of v, so that h[p][q] becomes 0. */
static void rotate(double *h, double *v, size_t n, size_t p, size_t q)
{
    const double off = h[p * n + q], theta = (h[q * n + q] - h[p * n + p]) / (2 * off);
    const double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
    const double c = 1 / sqrt(t * t + 1), s = t * c;
    for (size_t k = 0; k < n; k++) {
        const double a = h[k * n + p], b = h[k * n + q];
        h[k * n + p] = c * a - s * b;
        h[k * n + q] = s * a + c * b;
    }
    for (size_t k = 0; k < n; k++) {
        const double a = h[p * n + k], b = h[q * n + k];
        h[p * n + k] = c * a - s * b;
        h[q * n + k] = s * a + c * b;
    }
    for (size_t k = 0; k < n; k++) {
        const double a = v[k * n + p], b = v[k * n + q];
        v[k * n + p] = c * a - s * b;
        v[k * n + q] = s * a + c * b;
    }
}

/* Eigenvectors of h as columns of v; its eigenvalues are then its diagonal. */
static void diagonalise(double *h, double *v, size_t n)
{
    for (size_t k = 0; k < n * n; k++)
        v[k] = k % (n + 1) == 0;
    bool left = true;
    for (int sweep = 0; left && sweep < SWEEPS; sweep++) {
        left = false;
        for (size_t p = 0; p < n; p++)
            for (size_t q = p + 1; q < n; q++) {
                const double size = fabs(h[p * n + p]) + fabs(h[q * n + q]);
                if (size + fabs(h[p * n + q]) == size)
                    continue;
                rotate(h, v, n, p, q);
                left = true;
            }
    }
}

/* ---------------------------------------------------------------- subspaces --------------- */

/* p vectors of n numbers, one after the other, and what a pass needs. */
typedef struct subspace {
    size_t n, p;
    double *x, *y, *h, *v, *value;
    size_t *order;
} subspace;

static bool subspace_make(subspace *s, size_t n, size_t count)
{
    const size_t more = count < 8 ? count : 8;
    s->n = n;
    s->p = count + more + 2 < n ? count + more + 2 : n;
    s->x = malloc(s->p * n * sizeof *s->x);
    s->y = malloc(s->p * n * sizeof *s->y);
    s->h = malloc(s->p * s->p * sizeof *s->h);
    s->v = malloc(s->p * s->p * sizeof *s->v);
    s->value = calloc(s->p, sizeof *s->value);
    s->order = malloc(s->p * sizeof *s->order);
    if (!s->x || !s->y || !s->h || !s->v || !s->value || !s->order)
        return false;
    for (size_t k = 0; k < s->p * n; k++)
        s->x[k] = tl_uniform(tl_key(k / n, k % n)) - 0.5;
    return true;
}

static void subspace_free(subspace *s)
{
    free(s->x);
    free(s->y);
    free(s->h);
    free(s->v);
    free(s->value);
    free(s->order);
}

/* Makes the vectors orthonormal; each is projected twice, so that roundings of the first time are gone. */
static void make_orthonormal(subspace *s)
{
    for (size_t k = 0; k < s->p; k++) {
        double *at = s->x + k * s->n;
        for (int twice = 0; twice < 2; twice++)
            for (size_t j = 0; j < k; j++) {
                const double by = tl_skyline_dot(at, s->x + j * s->n, s->n);
                for (size_t i = 0; i < s->n; i++)
                    at[i] -= by * s->x[j * s->n + i];
            }
        const double length = sqrt(tl_skyline_dot(at, at, s->n));
        for (size_t i = 0; i < s->n && length > 0; i++)
            at[i] /= length;
    }
}

/* Columns of v by ascending eigenvalue. */
static void sort_values(subspace *s)
{
    for (size_t k = 0; k < s->p; k++) {
        size_t at = k;
        const double value = s->h[k * s->p + k];
        for (; at > 0 && s->h[s->order[at - 1] * (s->p + 1)] > value; at--)
            s->order[at] = s->order[at - 1];
        s->order[at] = k;
    }
}

/* One pass. Whether the lowest `count` values stand. */
static bool go_on(subspace *s, const tl_skyline *a, size_t count)
{
    for (size_t k = 0; k < s->p; k++)
        tl_skyline_solve(a, s->x + k * s->n);
    make_orthonormal(s);
    for (size_t k = 0; k < s->p; k++)
        multiply_transposed(a, s->x + k * s->n, s->y + k * s->n);
    for (size_t i = 0; i < s->p; i++)
        for (size_t j = 0; j <= i; j++)
            s->h[i * s->p + j] = s->h[j * s->p + i] = tl_skyline_dot(s->y + i * s->n, s->y + j * s->n, s->n);
    diagonalise(s->h, s->v, s->p);
    sort_values(s);
    memset(s->y, 0, s->p * s->n * sizeof *s->y);
    bool stands = true;
    for (size_t k = 0; k < s->p; k++) {
        const size_t column = s->order[k];
        for (size_t j = 0; j < s->p; j++)
            for (size_t i = 0; i < s->n; i++)
                s->y[k * s->n + i] += s->v[j * s->p + column] * s->x[j * s->n + i];
        const double value = s->h[column * (s->p + 1)];
        stands = stands && (k >= count || fabs(value - s->value[k]) <= STANDS * fabs(value));
        s->value[k] = value;
    }
    memcpy(s->x, s->y, s->p * s->n * sizeof *s->x);
    return stands;
}

bool tl_skyline_lowest(const tl_skyline *a, size_t count, double *value, double *vector)
{
    subspace s = {.n = 0};
    const bool made = subspace_make(&s, a->size, count);
    for (int pass = 0; made && pass < PASSES; pass++)
        if (go_on(&s, a, count))
            break;
    if (made) {
        memcpy(value, s.value, count * sizeof *value);
        memcpy(vector, s.x, count * a->size * sizeof *vector);
    }
    subspace_free(&s);
    return made;
}
