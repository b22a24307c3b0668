/* law_strength.c - whether what a law marks as strengths is what its strength is made of.
 *
 * With its strengths divided by F = 0.5 and 2 the law must be taken, and bear 1/F of what it bore: the largest shear
 * force of points that slide under a held normal force, and the largest pull of a point that opens. Steps grow from far
 * below the way on which springs reach the strength to far above it, so the peak is met whatever its way. All ways are
 * 1/F as long, at the same rate.
 *
 * A strength that depends on the way slipped, or on the rate, need not be 1/F of what it was. So most sets of
 * parameters must bear what they should. Nothing is compared where a divided parameter has come to the end of its
 * range. */
#include "check/law_strength.h"

#include "base/strength.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>

/* Points that slide under so many normal stresses. */
#define SLIDING 8
/* Cost only: steps of a path; each is GROWTH times the one before. */
#define STEPS 200
#define GROWTH 1.07
/* Cost only: of so many sets of parameters one is tried. */
#define EVERY 3
/* Constant: the first step over the way on which springs reach the strength. */
#define FIRST 1e-3
/* Tolerance: share by which the strength may be off 1/F. An angle of 60 degrees that is divided as a stress is off by
 * 0.3. Test: unit/test_check. */
#define OFF 0.15
/* Tolerance: share by which the normal force may be off when a shear force counts. */
#define HELD 0.01
/* Cost only: corrections of a step that hold the normal force. */
#define CORRECTIONS 20
/* Constant: s, in which points slide by the way on which springs reach the strength. */
#define LASTS 1.0

/* What points bear at most; NaN where that is not known. */
typedef struct strengths {
    double shear[SLIDING], pull;
} strengths;

static void call(const tl_check_law *law, tl_check_points *now)
{
    tl_check_points in = *now;
    tl_check_call how = {0};
    tl_law_call(law, &in, now, NULL, 0, SLIDING, &how);
}

static void begin(const tl_check_law *law, tl_check_points *now, double stress)
{
    memset(now, 0, sizeof *now);
    for (size_t i = 0; i < SLIDING; i++) {
        tl_law_begin(law, now, i, 1, tl_v3(0, 0, 1));
        now->c[TL_AT_F_N0][i] = stress * (double)(i + 1) / SLIDING;
    }
    call(law, now);
}

static void close_walls(tl_check_points *now, size_t i, double by)
{
    now->c[TL_AT_CLOSURE][i] += by;
    now->c[TL_AT_EDGE][i] += by;
    now->c[TL_AT_DU_N][i] = -by;
}

static void no_motion(tl_check_points *now)
{
    for (size_t i = 0; i < SLIDING; i++) {
        now->c[TL_AT_DU_N][i] = 0;
        tl_check_put(now->c[TL_AT_DU_S], i, tl_v3(0, 0, 0));
    }
}

static double excess_of(const tl_check_points *now, size_t i)
{
    return now->c[TL_AT_F_N][i] - now->c[TL_AT_F_N0][i];
}

/* Moves the walls until all points have the normal forces that they began with. */
static void hold_normal(const tl_check_law *law, tl_check_points *now)
{
    bool held = !(law->kn > 0);
    for (int k = 0; k < CORRECTIONS && !held; k++) {
        no_motion(now);
        now->dt = 0;
        held = true;
        for (size_t i = 0; i < SLIDING; i++) {
            held = held && fabs(excess_of(now, i)) <= 0.1 * HELD * now->c[TL_AT_F_N0][i];
            close_walls(now, i, -excess_of(now, i) / law->kn);
        }
        call(law, now);
    }
}

/* Slides all points; the largest shear force of each. */
static void find_shear(const tl_check_law *law, double factor, strengths *s)
{
    tl_check_points now;
    int at[SLIDING] = {0};
    double size = FIRST * law->slide / factor;
    begin(law, &now, law->stress);
    for (size_t i = 0; i < SLIDING; i++)
        s->shear[i] = 0;
    for (int k = 0; k < STEPS; k++, size *= GROWTH) {
        no_motion(&now);
        for (size_t i = 0; i < SLIDING; i++)
            tl_check_put(now.c[TL_AT_DU_S], i, tl_v3(size, 0, 0));
        now.dt = LASTS * size / law->slide;
        call(law, &now);
        hold_normal(law, &now);
        for (size_t i = 0; i < SLIDING; i++) {
            const double force = tl_v3_norm(tl_check_vec(now.c[TL_AT_F_S], i));
            if (fabs(excess_of(&now, i)) <= HELD * now.c[TL_AT_F_N0][i] && force > s->shear[i]) {
                s->shear[i] = force;
                at[i] = k;
            }
        }
    }
    for (size_t i = 0; i < SLIDING; i++)
        if (at[i] >= STEPS - 1) /* still rising */
            s->shear[i] = NAN;
}

/* Opens a point; its largest pull. */
static void find_pull(const tl_check_law *law, double factor, strengths *s)
{
    tl_check_points now;
    int at = 0;
    double size = FIRST * law->closure / factor;
    begin(law, &now, 0);
    s->pull = 0;
    for (int k = 0; k < STEPS; k++, size *= GROWTH) {
        no_motion(&now);
        for (size_t i = 0; i < SLIDING; i++)
            close_walls(&now, i, -size);
        now.dt = LASTS * size / law->closure;
        call(law, &now);
        if (-now.c[TL_AT_F_N][0] > s->pull) {
            s->pull = -now.c[TL_AT_F_N][0];
            at = k;
        }
    }
    if (at >= STEPS - 1)
        s->pull = NAN;
}

static void find(const tl_check_law *law, double factor, strengths *s)
{
    find_shear(law, factor, s);
    find_pull(law, factor, s);
}

/* Whether a strength is as it should be; one that is not known is. */
static bool is_right(double before, double after, double factor)
{
    return !(fabs(after * factor - before) > OFF * before);
}

/* Whether all strengths are; else `text` tells of the first that is not. */
static bool compare(const strengths *before, const strengths *after, double factor, double stress, char *text,
                    size_t size)
{
    if (!is_right(before->pull, after->pull, factor)) {
        tl_text_print(text, size, "with strengths divided by %g a pull of %g Pa is borne, not %g Pa", factor,
                      after->pull, before->pull / factor);
        return false;
    }
    for (size_t i = 0; i < SLIDING; i++)
        if (!is_right(before->shear[i], after->shear[i], factor)) {
            tl_text_print(text, size, "with strengths divided by %g a shear of %g Pa is borne under %g Pa, not %g Pa",
                          factor, after->shear[i], stress * (double)(i + 1) / SLIDING, before->shear[i] / factor);
            return false;
        }
    return true;
}

/* Whether a parameter that was divided has come to the end of its range. */
static bool is_clamped(const tl_kind *kind, const void *params)
{
    bool some = false;
    for (uint32_t i = 0; i < kind->param_count; i++) {
        const tl_param p = kind->params[i];
        double value;
        if (p.type != TL_PARAM_REAL || !(p.flags & (TL_PARAM_STRENGTH | TL_PARAM_STRENGTH_DIVISOR)))
            continue;
        memcpy(&value, (const char *)params + p.offset, sizeof value);
        some = some || value >= p.max;
    }
    return some;
}

/* Tries one factor. */
static tl_status try_factor(tl_checker *c, const strengths *before, const void *params, double factor,
                            tl_check_open_fn open, tl_check_close_fn close, tl_check_seen *seen)
{
    const tl_kind *kind = c->kind;
    tl_check_law law;
    tl_args args;
    void *held, *divided = malloc(kind->params_size + 1);
    tl_error error = {.status = TL_OK};
    strengths after;
    if (!tl_strengths_divide(kind, params, factor, &args, &held) || !divided) {
        free(held);
        free(divided);
        return tl_fail_memory(c->error);
    }
    memcpy(divided, params, kind->params_size);
    tl_status status =
        tl_args_read(kind->params, kind->param_count, kind->param_stride, &args, true, divided, "strengths", &error);
    if (status == TL_OK) {
        status = open(c, divided, &law);
        if (status == TL_OK) {
            find(&law, factor, &after);
            char text[sizeof seen->strengths];
            const bool tried = !is_clamped(kind, divided);
            const bool right = !tried || compare(before, &after, factor, law.stress, text, sizeof text);
            seen->divided += tried;
            if (!right && seen->wrong++ == 0)
                memcpy(seen->strengths, text, sizeof text);
            close(&law);
        }
    }
    if (status != TL_OK)
        tl_check_note(c, TL_LAW_STRENGTHS, "create() refuses the same parameters with strengths divided by %g: %s",
                      factor, error.status != TL_OK ? error.text : c->error->text);
    free(held);
    free(divided);
    return TL_OK;
}

tl_status tl_law_check_strengths(tl_checker *c, const tl_check_law *law, const void *params, tl_check_open_fn open,
                                 tl_check_close_fn close, tl_check_seen *seen)
{
    static const double factors[] = {0.5, 2};
    strengths before;
    tl_status status = TL_OK;
    if (!tl_kind_has_strength(c->kind) || c->set % EVERY != 0)
        return TL_OK;
    find(law, 1, &before);
    for (size_t k = 0; k < sizeof factors / sizeof *factors && status == TL_OK; k++)
        status = try_factor(c, &before, params, factors[k], open, close, seen);
    return status;
}

void tl_law_tell_strengths(tl_checker *c, const tl_check_seen *seen)
{
    if (2 * seen->wrong > seen->divided)
        tl_check_note(c, TL_LAW_STRENGTHS,
                      "%s, and likewise in %d of %d trials; mark all strengths and only these: TL_PARAM_STRENGTH, and "
                      "TL_PARAM_STRENGTH_ANGLE of angles",
                      seen->strengths, seen->wrong, seen->divided);
}
