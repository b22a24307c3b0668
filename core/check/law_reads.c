/* law_reads.c - what a law gives depends on its states and parameters, each of them, and on nothing that is not its own.
 *
 * A state is given another value, that of another point, and a parameter another one of its range; with some set of parameters,
 * at some point of some step, the result must be another one to the bit. */
#include "check/law_reads.h"

#include "check/checker.h"
#include "check/law_normal.h"
#include "check/law_trial.h"
#include "check/params.h"
#include "check/points.h"

#include <math.h>
#include <string.h>

void tl_law_check_reads(tl_law_trial *t)
{
    static const struct {
        uint32_t what;
        const char *text;
    } places[] = {{TL_OTHER_STATES, "a state that it does not declare"},
                  {TL_OTHER_BEHIND, "what lies behind the batch"},
                  {TL_OTHER_ENERGIES, "what the columns of energies held before, which are to be "
                                      "written"}};
    if (tl_check_failed(t->c, TL_LAW_READS))
        return;
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        tl_check_points out = t->in;
        tl_check_call call = {.other = places[k].what};
        if (!tl_law_call(t, &t->in, &out, NULL, 0, TL_CHECK_POINTS, &call))
            return;
        for (size_t i = 0; i < TL_CHECK_POINTS; i++)
            if (!tl_law_same(&t->out, &out, i, true))
                tl_check_note(t->c, TL_LAW_READS, "what update() gives depends on %s",
                              places[k].text);
    }
}

/* Columns of a state: its first, and the one behind its last. */
static uint32_t width_of(const tl_kind *kind, uint32_t state)
{
    return kind->states[state].kind == TL_STATE_TANGENT ? 3 : 1;
}

/* Where the next point's value of a state takes the place of each point's: what depends on it. */
static void see_state(tl_law_trial *t, uint32_t first, uint32_t width)
{
    const uint32_t bits = ((1u << width) - 1) << first;
    tl_check_points in = t->in, out, a, b;
    tl_check_gaps gaps, others;
    tl_check_call call = {0};
    bool moved[TL_CHECK_POINTS];
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        moved[i] = false;
        for (uint32_t k = first; k < first + width; k++) {
            const double *state = t->in.c[TL_AT_STATE + k];
            in.c[TL_AT_STATE + k][i] =
                width > 1 ? -0.5 * state[i] : state[(i + 1) % TL_CHECK_POINTS];
            moved[i] |= in.c[TL_AT_STATE + k][i] != state[i];
        }
    }
    out = in;
    if (!tl_law_call(t, &in, &out, NULL, 0, TL_CHECK_POINTS, &call))
        return;
    tl_law_gaps(&t->law, &t->in, &gaps);
    tl_law_gaps(&t->law, &in, &others);
    a = t->out;
    b = out;
    for (uint32_t k = first; k < first + width; k++) /* all but the state itself */
        memset(a.c[TL_AT_STATE + k], 0, sizeof a.c[0]),
            memset(b.c[TL_AT_STATE + k], 0, sizeof b.c[0]);
    for (size_t i = 0; i < TL_CHECK_POINTS; i++) {
        if (!moved[i])
            continue;
        bool gap = gaps.lift[i] != others.lift[i] || gaps.hold[i] != others.hold[i];
        if (gap || !tl_law_same(&a, &b, i, true))
            t->seen->read |= bits;
        if (!tl_law_same(&t->out, &out, i, true))
            t->seen->kept |= bits;
    }
}

void tl_law_see_states(tl_law_trial *t)
{
    const tl_law_ops *ops = t->law.of.ops;
    uint32_t first = 0;
    if (ops->stateless && ops->stateless(t->law.of.self))
        return;
    for (uint32_t i = 0; i < t->c->kind->state_count; i++) {
        uint32_t width = width_of(t->c->kind, i);
        if (!(t->seen->read >> first & 1))
            see_state(t, first, width);
        first += width;
    }
}

void tl_law_see_params(tl_law_trial *t, tl_check_law varied[], const bool open[])
{
    for (uint32_t k = 0; k < t->c->kind->param_count && k < TL_CHECK_PARAMS; k++) {
        if (!open[k] || t->seen->matters[k])
            continue;
        tl_check_points out = t->in;
        tl_check_call call = {0};
        tl_check_gaps gaps, others;
        tl_check_call_law(&varied[k].of, &t->in, &out, NULL, 0, TL_CHECK_POINTS, &call);
        tl_law_gaps(&t->law, &t->out, &gaps);
        tl_law_gaps(&varied[k], &t->out, &others);
        bool other = call.status != TL_OK || memcmp(&gaps, &others, sizeof gaps) != 0;
        for (size_t i = 0; i < TL_CHECK_POINTS && !other; i++)
            other = !tl_law_same(&t->out, &out, i, true);
        t->seen->matters[k] |= other;
    }
}

void tl_law_tell_unseen(tl_checker *c, const tl_check_seen *seen)
{
    const tl_kind *kind = c->kind;
    uint32_t column = 0;
    c->params_text[0] = '\0';
    for (uint32_t i = 0; i < kind->state_count; i++) {
        const tl_state *state = &kind->states[i];
        uint32_t width = width_of(kind, i), bits = (1u << width) - 1;
        if (!(seen->written >> column & bits))
            tl_check_note(c, TL_LAW_STATES,
                          "state '%s' is declared and was never written, with any of %d sets of "
                          "parameters",
                          state->name, TL_CHECK_SETS);
        else if (!(seen->kept >> column & bits) && state->transfer != TL_TRANSFER_RESET)
            tl_check_note(c, TL_LAW_STATES,
                          "state '%s' is written and never read: nothing depends on what it was. "
                          "Where that is meant, "
                          "declare it as TL_TRANSFER_RESET",
                          state->name);
        else if (!(seen->read >> column & bits) && state->transfer != TL_TRANSFER_RESET)
            tl_check_note(
                c, TL_LAW_STATES,
                "state '%s' is written, but no force, energy, flag or other state depends on "
                "it. Where that is meant, declare it as TL_TRANSFER_RESET",
                state->name);
        column += width;
    }
    for (uint32_t k = 0; k < kind->param_count && k < TL_CHECK_PARAMS; k++)
        if (!seen->matters[k] && tl_check_asked(c, k))
            tl_check_note(c, TL_LAW_PARAMETERS,
                          "parameter '%s' has no effect: another value gives the same forces, "
                          "energies, states and "
                          "stiffness with all of %d sets of parameters",
                          kind->params[k].name, TL_CHECK_SETS);
    if (seen->heats && !seen->slips)
        tl_check_note(c, TL_LAW_FLAGS,
                      "shear is turned to heat, but no point is ever flagged as slipping");
}
