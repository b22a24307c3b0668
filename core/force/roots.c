/* roots.c - numbers at which nothing is missing.
 *
 * Newton's steps, with slopes that are mended by what steps bring (Broyden 1965), or found by differences where that is little. Each step is
 * halved until less is missed. */
#include "force/roots.h"

#include <math.h>

/* Steps that are made at the most, and halvings of each. */
#define STEPS 60
#define HALVINGS 10
/* Step of differences, over the unit. */
#define SMALL 1e-6
/* Share of what is missed that is left after a good step: after another slopes are found anew. */
#define GOOD 0.3
/* What is added to the slopes: the numbers may not tell all. */
#define FAINT 1e-9

typedef struct numbers {
    double v[TL_ROOTS];
} numbers;

/* How fast what is missed falls with each number: [of what][with which]. */
typedef struct slopes {
    double of[TL_ROOTS][TL_ROOTS];
} slopes;

double tl_roots_size(const double x[], int count)
{
    double sum = 0;
    for (int k = 0; k < count; k++)
        sum += x[k] * x[k];
    return sqrt(sum);
}

static double size_of(const numbers *x, int count)
{
    return tl_roots_size(x->v, count);
}

/* Solves slopes x = right, `count` equations, by elimination, the largest of each column first. false: they cannot be solved. */
static bool solve(slopes by, numbers right, int count, numbers *x)
{
    *x = (numbers){{0}};
    for (int j = 0; j < count; j++) {
        int best = j;
        for (int i = j + 1; i < count; i++)
            best = fabs(by.of[i][j]) > fabs(by.of[best][j]) ? i : best;
        for (int k = j; k < count; k++) {
            double was = by.of[j][k];
            by.of[j][k] = by.of[best][k];
            by.of[best][k] = was;
        }
        double was = right.v[j];
        right.v[j] = right.v[best];
        right.v[best] = was;
        for (int i = j + 1; i < count; i++) {
            double share = by.of[i][j] / by.of[j][j];
            for (int k = j; k < count; k++)
                by.of[i][k] -= share * by.of[j][k];
            right.v[i] -= share * right.v[j];
        }
    }
    for (int j = count - 1; j >= 0; j--) {
        double sum = right.v[j];
        for (int k = j + 1; k < count; k++)
            sum -= by.of[j][k] * x->v[k];
        x->v[j] = sum / by.of[j][j];
    }
    return isfinite(size_of(x, count));
}

static slopes plain_slopes(const tl_roots *of)
{
    slopes out = {{{0}}};
    for (int k = 0; k < TL_ROOTS; k++)
        out.of[k][k] = 1 / of->unit;
    return out;
}

/* Slopes at x, where `missed` is, by differences. false: it is not known. */
static bool find_slopes(const tl_roots *of, const numbers *x, const numbers *missed, slopes *out)
{
    double by = SMALL * of->unit;
    for (int j = 0; j < of->count; j++) {
        numbers there = *x, then;
        there.v[j] += by;
        if (!of->miss(of->user, there.v, then.v))
            return false;
        for (int i = 0; i < of->count; i++)
            out->of[i][j] = (missed->v[i] - then.v[i]) / by + (i == j ? FAINT / of->unit : 0);
    }
    return true;
}

/* Goes the step or a share of it, so that less is missed; halves it so often at the most. Returns the share, 0: none. */
static double go(const tl_roots *of, const numbers *step, int halvings, numbers *x, numbers *missed)
{
    double by = 1;
    for (int n = 0; n <= halvings; n++, by *= 0.5) {
        numbers there = *x, then;
        for (int k = 0; k < of->count; k++)
            there.v[k] += by * step->v[k];
        if (!of->miss(of->user, there.v, then.v))
            return 0;
        if (size_of(&then, of->count) < size_of(missed, of->count)) {
            *x = there;
            *missed = then;
            return by;
        }
    }
    return 0;
}

/* Broyden's rule: brings slopes in line with what a share of their step has brought. */
static void mend_slopes(slopes *by, int count, const numbers *step, double share,
                        const numbers *before, const numbers *after)
{
    double square = 0;
    for (int k = 0; k < count; k++)
        square += step->v[k] * step->v[k];
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count && square > 0; j++) {
            double off = (1 - share) * before->v[i] - after->v[i];
            by->of[i][j] += off / share * step->v[j] / square;
        }
}

bool tl_roots_find(const tl_roots *of, double x[TL_ROOTS], double *left)
{
    const int count = of->count;
    numbers here, missed, step;
    slopes by = plain_slopes(of);
    bool fresh = false;
    for (int k = 0; k < TL_ROOTS; k++)
        here.v[k] = x[k];
    if (!of->miss(of->user, here.v, missed.v))
        return false;
    for (int k = 0; k < STEPS && size_of(&missed, count) > TL_ROOTS_EXACT; k++) {
        numbers before = missed;
        double share = 0;
        if (solve(by, missed, count, &step))
            share = go(of, &step, fresh ? HALVINGS : 0, &here, &missed);
        if (share > 0)
            mend_slopes(&by, count, &step, share, &before, &missed);
        if (fresh && size_of(&missed, count) >= of->hopeless * size_of(&before, count))
            break;
        fresh = size_of(&missed, count) > GOOD * size_of(&before, count);
        if (fresh && !find_slopes(of, &here, &missed, &by))
            break;
    }
    for (int k = 0; k < TL_ROOTS; k++)
        x[k] = here.v[k];
    *left = size_of(&missed, count);
    return true;
}
