/* law_trial.c - a call of a law, with what every call must keep to, and whether two gave the same. */
#include "check/law_trial.h"

#include "check/params.h"
#include "check/points.h"

#include <string.h>

bool tl_law_same(const tl_check_points *a, const tl_check_points *b, size_t i, bool energies)
{
    for (int k = TL_AT_F_N; k < TL_AT_COUNT; k++)
        if ((energies || (k != TL_AT_STORED && k != TL_AT_DISSIPATED)) &&
            memcmp(&a->c[k][i], &b->c[k][i], sizeof a->c[k][i]) != 0)
            return false;
    return a->flags[i] == b->flags[i];
}

bool tl_law_call(tl_law_trial *t, const tl_check_points *in, tl_check_points *out,
                 const size_t *order, size_t begin, size_t count, tl_check_call *call)
{
    tl_check_call_law(&t->law.of, in, out, order, begin, count, call);
    if (call->overwrote)
        tl_check_note(t->c, TL_LAW_WRITES, "update() writes to %s", call->overwrote);
    if (call->padding)
        tl_check_note(t->c, TL_LAW_PADDING, "a lane of no area has a force or an energy");
    if (call->status != TL_OK)
        tl_check_note(t->c, TL_LAW_RUNS, "update() fails%s: %s",
                      t->law.of.ops->never_fails ? ", though never_fails is set" : "",
                      tl_report_text(&call->report, call->status));
    return call->status == TL_OK;
}
