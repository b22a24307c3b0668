/* chain.c - the displacements of the steel of a bolt: of a chain of springs with limits.
 *
 * Newton passes with the three-band matrix find them. What gave in the step before is taken to give on, with no
 * stiffness at all. So one pass is enough as a rule. More are where springs begin to give or hold again. Steel that
 * yields beside grout that slips can make the passes turn in a circle, or a piece hang on nothing: then w is found
 * directly.
 *
 * Let L_k(w) be the tension behind node k with which the nodes up to k are in equilibrium when node k is at w. It rises
 * with w in straight pieces, between its *knots*:
 *
 *     L_0(w) = plate(w) + pull + grout_0(w),    L_k+1(w) = grout_k+1(w) + N,    N = L_k(w - N / stiff - plastic)
 *
 * with |N| <= yield, which cuts off the knots beyond. Let node k be between low_k and high_k where that is so. At the
 * end L = 0 gives w, and going back,
 *
 *     w_k = w_k+1 - N_k / stiff - plastic, within low_k and high_k.
 *
 * The way of solving is that of Johnson, J. Comp. Graph. Stat. 22 (2013) 246-260, for another chain of this kind. */
#include "chain.h"

#include <math.h>
#include <string.h>

/* Limit: Newton passes before w is found directly, and after that, against rounding. Test: lua/test_bolts_at_random. */
#define PASSES 6
/* Limit: parts of one pass that are tried; the part that is reached is good enough. Test: lua/test_bolts_at_random. */
#define SEARCH 12
/* Tolerance: of the unbalance along a pass at its beginning, how much may be left with the other sign at its end. Test:
 * lua/test_bolts_at_random. */
#define OVERSHOT 0.5
/* Tolerance: relative to the largest force of the bolt, the unbalance with which the passes end. */
#define BALANCED 1e-11
/* Tolerance: the same, relative to what rounding of w makes with the stiffest part. Test: lua/test_bolt. */
#define ROUNDED 1e-15
/* Cost only: over a limit, forces from which on a spring is taken to give, as it gave in the step before. */
#define GIVES (1 - 1e-12)

static inline double within(double x, double limit)
{
    return larger(-limit, smaller(limit, x));
}

static inline double size(double x)
{
    return x < 0 ? -x : x;
}

/* Largest values in lanes. clang does not do that, and would warn. */
#ifdef __clang__
#define LARGEST(...)
#else
#define PRAGMA(text) _Pragma(#text)
#define LARGEST(...) PRAGMA(omp simd reduction(max : __VA_ARGS__))
#endif

/* Forces of the grout at the present w, and of the steel. Gives the largest one. */
TL_VECTORIZED static double respond_all(chain *c)
{
    const uint32_t n = c->count;
    double most = 0;
    LARGEST(most)
    for (uint32_t k = 0; k < n; k++) {
        const double trial = c->hold[k] * (c->w[k] - c->rock[k] - c->slip[k]);
        const double force = within(trial, c->bears[k]);
        c->grout_trial[k] = trial;
        c->grout[k] = force;
        c->grout_tangent[k] = size(trial) < GIVES * c->bears[k] ? c->hold[k] : 0;
        most = larger(most, size(force));
    }
    LARGEST(most)
    for (uint32_t k = 0; k < n - 1; k++) {
        const double trial = c->stiff[k] * (c->w[k + 1] - c->w[k] - c->plastic[k]);
        const double force = within(trial, c->limit[k]);
        c->tension_trial[k] = trial;
        c->tension[k] = force;
        c->tension_tangent[k] = size(trial) < GIVES * c->limit[k] ? c->stiff[k] : 0;
        most = larger(most, size(force));
    }
    return most;
}

/* Fills `off` but for the plate and the pull at node 0. Gives its largest size. */
TL_VECTORIZED static double balance(chain *c)
{
    const uint32_t last = c->count - 1;
    double most = 0;
    c->off[0] = (last > 0 ? c->tension[0] : 0) + (-c->plate - c->pull) - c->grout[0];
    LARGEST(most)
    for (uint32_t k = 1; k < last; k++) {
        c->off[k] = c->tension[k] - c->tension[k - 1] - c->grout[k];
        most = larger(most, size(c->off[k]));
    }
    if (last > 0)
        c->off[last] = -c->tension[last - 1] - c->grout[last];
    return larger(most, larger(size(c->off[0]), size(c->off[last])));
}

/* Unbalance that rounding of displacements explains, N. */
TL_VECTORIZED static double rounding_of(const chain *c)
{
    double stiff = c->plate_stiff, moved = size(c->seat);
    LARGEST(stiff, moved)
    for (uint32_t k = 0; k < c->count; k++) {
        stiff = larger(stiff, c->hold[k]);
        moved = larger(moved, larger(larger(size(c->w[k]), size(c->rock[k])), size(c->slip[k])));
    }
    LARGEST(stiff)
    for (uint32_t k = 0; k < c->count - 1; k++)
        stiff = larger(stiff, c->stiff[k]);
    return ROUNDED * stiff * moved;
}

/* Forces at the present w, and the unbalance. Whether the steel is in equilibrium. */
static bool respond(chain *c)
{
    c->plate_trial = c->plate_stiff * (c->w[0] - c->rock[0] - c->seat);
    c->plate = larger(0, smaller(c->plate_limit, c->plate_trial));
    c->plate_tangent = c->plate_trial >= 0 && c->plate_trial < GIVES * c->plate_limit ? c->plate_stiff : 0;
    const double most = respond_all(c);
    c->enough = BALANCED * larger(fabs(c->pull) + c->plate, most) + c->rounding;
    return balance(c) <= c->enough;
}

/* Grout beyond its bond falls to the residual; whether some has. */
static bool wear(chain *c)
{
    bool wears = false;
    for (uint32_t k = 0; k < c->count; k++)
        if (c->worn[k] == 0 && fabs(c->grout_trial[k]) > c->bond[k]) {
            c->worn[k] = 1;
            c->bears[k] = c->residual[k];
            wears = wears || c->residual[k] < c->bond[k];
        }
    return wears;
}

/* What is left of the nodes on one side of a node when they are eliminated. */
typedef struct side_left {
    double before, alone, part, carried; /* N/m of the segment to it; shares of that and of the step; N / (N/m) */
    double loose;                        /* N, largest load of a piece that nothing holds */
} side_left;

/* Eliminates node k, whose next segment has the stiffness `after`: its step is step[k] + over[k] times that of the next
 * node. */
static inline void eliminate(const chain *c, uint32_t k, double own, double after, side_left *r, double *step,
                             double *over)
{
    own += r->before * r->alone;
    const double pivot = own + after, inverse = pivot > 0 ? 1 / pivot : 0;
    r->carried = c->off[k] + r->part * r->carried;
    r->loose = pivot > 0 ? r->loose : larger(r->loose, size(r->carried));
    step[k] = r->carried * inverse;
    r->part = over[k] = after * inverse;
    r->alone = own * inverse;
    r->before = after;
}

/* The step of w of a Newton pass: elimination in the three bands from both ends to the middle, and back. false: a piece
 * that bears a load hangs on nothing. */
static bool find_step(const chain *c, double *step)
{
    double over[TL_ELEMENT_NODES];
    const uint32_t n = c->count, middle = n / 2;
    const double *grout = c->grout_tangent, *segment = c->tension_tangent;
    side_left left = {0, 1, 0, 0, 0}, right = {0, 1, 0, 0, 0};
    for (uint32_t k = 0; k < middle; k++) {
        const uint32_t j = n - 1 - k;
        eliminate(c, k, grout[k] + (k == 0 ? c->plate_tangent : 0), segment[k], &left, step, over);
        if (j > middle)
            eliminate(c, j, grout[j], segment[j - 1], &right, step, over);
    }
    const double own = grout[middle] + (middle == 0 ? c->plate_tangent : 0);
    const double pivot = own + left.before * left.alone + right.before * right.alone;
    const double carried = c->off[middle] + left.part * left.carried + right.part * right.carried;
    step[middle] = pivot > 0 ? carried / pivot : 0;
    double before = step[middle], after = before;
    for (uint32_t k = middle, j = middle + 1; k > 0; j++) { /* both ways at a time */
        k--;
        step[k] = before = step[k] + over[k] * before;
        if (j < n)
            step[j] = after = step[j] + over[j] * after;
    }
    return larger(left.loose, right.loose) <= c->enough && (pivot > 0 || size(carried) <= c->enough);
}

/* An unbalance along a step, J: it falls to 0 at the best part of it. */
static double along(const chain *c, const double *off, const double *step)
{
    double sum = 0;
    for (uint32_t k = 0; k < c->count; k++)
        sum += off[k] * step[k];
    return sum;
}

/* Goes a part of a step on from `from`. Whether the steel is in equilibrium there. */
static bool go(chain *c, const double *from, const double *step, double part)
{
    for (uint32_t k = 0; k < c->count; k++)
        c->w[k] = from[k] + part * step[k];
    return respond(c);
}

/* A Newton pass from where forces and unbalance are known, by a step. Where it goes too far, beyond where the energy
 * along the step is least, it goes back. Whether the steel is in equilibrium. */
static bool advance(chain *c, const double *step)
{
    double from[TL_ELEMENT_NODES], off[TL_ELEMENT_NODES], least = 0, most = 1;
    memcpy(from, c->w, c->count * sizeof *from);
    memcpy(off, c->off, c->count * sizeof *off);
    if (go(c, from, step, 1))
        return true;
    const double begin = along(c, off, step);
    double low = begin, high = along(c, c->off, step);
    for (int k = 0; k < SEARCH && high < -OVERSHOT * begin; k++) {
        const double part = k % 3 == 2 ? 0.5 * (least + most) : least + (most - least) * low / (low - high);
        if (go(c, from, step, part))
            return true;
        const double at = along(c, c->off, step);
        if (fabs(at) <= OVERSHOT * begin)
            break;
        *(at > 0 ? &least : &most) = part;
        *(at > 0 ? &low : &high) = at;
    }
    return false;
}

/* ---------------------------------------------------------------- direct ----------------- */

typedef struct knot {
    double w, n; /* m, N */
} knot;

/* L_k: constant before its first knot and after its last. */
typedef struct curve {
    uint32_t count;
    double level; /* N, where it has no knots */
    knot at[2 * TL_ELEMENT_NODES + 4];
} curve;

static double curve_at(const curve *f, double w)
{
    if (f->count == 0)
        return f->level;
    uint32_t i = 0;
    while (i < f->count && f->at[i].w < w)
        i++;
    if (i == 0 || i == f->count)
        return f->at[i ? i - 1 : 0].n;
    const knot a = f->at[i - 1], b = f->at[i];
    return a.n + (b.n - a.n) * (w - a.w) / (b.w - a.w);
}

/* Where it reaches n, from below (`rises`: the first place) or from above (the last). */
static double place_of(const curve *f, double n, bool rises)
{
    uint32_t i = 0;
    while (i < f->count && (rises ? f->at[i].n < n : f->at[i].n <= n))
        i++;
    if (f->count == 0 || i == 0)
        return -INFINITY;
    if (i == f->count)
        return INFINITY;
    const knot a = f->at[i - 1], b = f->at[i];
    return a.w + (n - a.n) * (b.w - a.w) / (b.n - a.n);
}

/* A spring that bears nothing at w and from `least` to `most`. */
typedef struct holder {
    double w, stiff, least, most;
} holder;

static double force_of(const holder *h, double w)
{
    return larger(h->least, smaller(h->most, h->stiff * (w - h->w)));
}

static void put_knot(curve *f, double w)
{
    const double n = curve_at(f, w);
    uint32_t i = f->count++;
    for (; i > 0 && f->at[i - 1].w > w; i--)
        f->at[i] = f->at[i - 1];
    f->at[i] = (knot){w, n};
}

static void add_holder(curve *f, holder h)
{
    if (!(h.stiff > 0 && h.most > h.least))
        return;
    put_knot(f, h.w + h.least / h.stiff);
    put_knot(f, h.w + h.most / h.stiff);
    for (uint32_t i = 0; i < f->count; i++)
        f->at[i].n += force_of(&h, f->at[i].w);
}

/* Cuts off what is beyond a limit of the tension; between which places node k must be. false: it is always beyond. */
static bool cut_off(curve *f, double limit, double *low, double *high)
{
    const double first = f->count ? f->at[0].n : f->level, last = f->count ? f->at[f->count - 1].n : f->level;
    if (first > limit || last < -limit)
        return false;
    *low = first < -limit ? place_of(f, -limit, true) : -INFINITY;
    *high = last > limit ? place_of(f, limit, false) : INFINITY;
    uint32_t kept = 0, begin = 0;
    while (begin < f->count && f->at[begin].n < -limit)
        begin++;
    if (begin > 0)
        f->at[kept++] = (knot){*low, -limit};
    for (; begin < f->count && f->at[begin].n <= limit; begin++)
        f->at[kept++] = f->at[begin];
    if (last > limit)
        f->at[kept++] = (knot){*high, limit};
    f->count = kept;
    return true;
}

static holder grout_of(const chain *c, uint32_t k)
{
    return (holder){c->rock[k] + c->slip[k], c->hold[k], -c->bears[k], c->bears[k]};
}

/* Finds w with the limits as they are. */
static bool find_directly(chain *c)
{
    double low[TL_ELEMENT_NODES], high[TL_ELEMENT_NODES], w[TL_ELEMENT_NODES];
    const uint32_t n = c->count;
    curve f;
    f.count = 0;
    f.level = c->pull;
    add_holder(&f, (holder){c->rock[0] + c->seat, c->plate_stiff, 0, c->plate_limit});
    add_holder(&f, grout_of(c, 0));
    for (uint32_t k = 0; k + 1 < n; k++) {
        if (!cut_off(&f, c->limit[k], &low[k], &high[k]))
            return false;
        for (uint32_t i = 0; i < f.count; i++)
            f.at[i].w += f.at[i].n / c->stiff[k] + c->plastic[k];
        add_holder(&f, grout_of(c, k + 1));
    }
    if (!cut_off(&f, 0, &low[n - 1], &high[n - 1]))
        return false;
    w[n - 1] = larger(low[n - 1], smaller(high[n - 1], c->w[n - 1]));
    double tension = 0;
    for (uint32_t k = n - 1; k-- > 0;) {
        const holder h = grout_of(c, k + 1);
        tension -= h.stiff > 0 ? force_of(&h, w[k + 1]) : 0;
        w[k] = larger(low[k], smaller(high[k], w[k + 1] - tension / c->stiff[k] - c->plastic[k]));
    }
    memcpy(c->w, w, n * sizeof *w);
    return true;
}

/* ---------------------------------------------------------------- both ------------------- */

/* Newton passes until the steel is in equilibrium; false: it is not after all of them, or a piece hangs on nothing. */
static bool pass(chain *c)
{
    double step[TL_ELEMENT_NODES];
    bool balanced = respond(c);
    for (int k = 0; k < PASSES && !balanced; k++) {
        if (!find_step(c, step))
            return false;
        balanced = advance(c, step);
    }
    return balanced;
}

/* With the limits as they are. */
static bool settle(chain *c)
{
    if (pass(c))
        return true;
    if (!find_directly(c))
        return false;
    pass(c); /* against rounding */
    return true;
}

bool chain_solve(chain *c)
{
    c->rounding = rounding_of(c);
    do { /* each time grout wears that was not worn */
        if (!settle(c))
            return false;
    } while (wear(c));
    return true;
}
