/* grid_signs.c - on which side of a plane, of a sphere, of a circle a point is, by whole numbers.
 *
 * Differences are at most 2^40. A determinant of three of them is at most (sqrt 3 2^40)^3 < 2^123 and the lift
 * |x|^2 - w less than 2^82. The sum of four products of both is less than 2^207, so it fits 256 bits.
 *
 *     orient   (b - a) . ((c - a) x (d - a))
 *     sphere   al |b c d| - bl |c d a| + cl |d a b| - dl |a b c|      places relative to p, l = |x|^2 - w + w_p
 *     circle   al |b c| + bl |c a| + cl |a b|
 *
 * After Edelsbrunner and Shah 1996, "Incremental topological flipping works for regular triangulations". */
#include "geometry/grid_signs.h"

#include <stdbool.h>
#include <stdint.h>

__extension__ typedef __int128 wide_int;
__extension__ typedef unsigned __int128 wide_word;

/* 2^128 high + low. */
typedef struct long_int {
    wide_int high;
    wide_word low;
} long_int;

/* The product of two magnitudes below 2^127. */
static long_int product_of_words(wide_word a, wide_word b)
{
    const wide_word half = UINT64_MAX;
    const wide_word low = (a & half) * (b & half), high = (a >> 64) * (b >> 64);
    const wide_word one = (a >> 64) * (b & half), other = (a & half) * (b >> 64);
    const wide_word middle = (low >> 64) + (one & half) + (other & half);
    return (long_int){(wide_int)(high + (one >> 64) + (other >> 64) + (middle >> 64)), (middle << 64) | (low & half)};
}

static void subtract(long_int *sum, long_int term)
{
    const wide_word low = sum->low - term.low;
    sum->high -= term.high + (low > sum->low);
    sum->low = low;
}

static void add(long_int *sum, long_int term)
{
    sum->low += term.low;
    sum->high += term.high + (sum->low < term.low);
}

static void add_product(long_int *sum, wide_int a, wide_int b)
{
    const long_int term = product_of_words((wide_word)(a < 0 ? -a : a), (wide_word)(b < 0 ? -b : b));
    if ((a < 0) == (b < 0))
        add(sum, term);
    else
        subtract(sum, term);
}

static int sign_of(long_int sum)
{
    if (sum.high < 0)
        return -1;
    return sum.high > 0 || sum.low > 0;
}

/* A place relative to another, with its lift. */
typedef struct arrow {
    wide_int x[3];
    wide_int lift;
} arrow;

static arrow from_to(const tl_site *p, const tl_site *a)
{
    arrow d = {{(wide_int)(a->x - p->x), (wide_int)(a->y - p->y), (wide_int)(a->z - p->z)},
               (wide_int)p->weight - (wide_int)a->weight};
    for (int i = 0; i < 3; i++)
        d.lift += d.x[i] * d.x[i];
    return d;
}

static wide_int determinant(const arrow *a, const arrow *b, const arrow *c)
{
    return a->x[0] * (b->x[1] * c->x[2] - b->x[2] * c->x[1]) + a->x[1] * (b->x[2] * c->x[0] - b->x[0] * c->x[2]) +
           a->x[2] * (b->x[0] * c->x[1] - b->x[1] * c->x[0]);
}

int tl_orient_exactly(const tl_site *a, const tl_site *b, const tl_site *c, const tl_site *d)
{
    const arrow ab = from_to(a, b), ac = from_to(a, c), ad = from_to(a, d);
    const wide_int six = determinant(&ab, &ac, &ad);
    return (six > 0) - (six < 0);
}

int tl_sphere_exactly(const tl_site *a, const tl_site *b, const tl_site *c, const tl_site *d, const tl_site *p)
{
    const arrow pa = from_to(p, a), pb = from_to(p, b), pc = from_to(p, c), pd = from_to(p, d);
    long_int inside = {0, 0};
    add_product(&inside, pa.lift, determinant(&pb, &pc, &pd));
    add_product(&inside, -pb.lift, determinant(&pc, &pd, &pa));
    add_product(&inside, pc.lift, determinant(&pd, &pa, &pb));
    add_product(&inside, -pd.lift, determinant(&pa, &pb, &pc));
    return sign_of(inside);
}

int tl_circle_exactly(const tl_site2 *a, const tl_site2 *b, const tl_site2 *c, const tl_site2 *p)
{
    const tl_site2 *corner[3] = {a, b, c};
    wide_int x[3], y[3], lift[3];
    for (int i = 0; i < 3; i++) {
        x[i] = (wide_int)(corner[i]->x - p->x);
        y[i] = (wide_int)(corner[i]->y - p->y);
        lift[i] = x[i] * x[i] + y[i] * y[i] + (wide_int)p->weight - (wide_int)corner[i]->weight;
    }
    long_int inside = {0, 0};
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        add_product(&inside, lift[i], x[j] * y[k] - y[j] * x[k]);
    }
    return sign_of(inside);
}
