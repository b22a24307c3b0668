/* law_points.c - calls a law on a batch as the host would, and watches what it writes to.
 *
 * Behind the padded batch lie lanes that are no one's, and behind the declared states columns. Both hold numbers of
 * several sizes and signs, and others in another call: no addition, product or bound leaves them all as they were. A
 * law that writes there, or to what is const, has overwritten what belongs to others. A law that reads there gives
 * something else with other numbers. So it does when it reads the columns of energies, which are to be written. */
#include "check/law_points.h"

#include "base/inside.h"

#include <math.h>
#include <string.h>

/* Lanes behind the batch that nobody may write to. */
#define GUARD TL_LANES
#define MOST (TL_CHECK_LANES + TL_LANES + GUARD)
#define UNTOUCHED_FLAGS 0xa5a50000u
/* Columns of states that a law may look for, each of its own: twice as many as there may be. */
#define COLUMNS (TL_AT_COUNT + TL_STATE_COLUMNS)

typedef struct buffer {
    _Alignas(TL_ALIGN) double c[COLUMNS][MOST];
    _Alignas(TL_ALIGN) uint32_t flags[MOST];
} buffer;

static void fill(const tl_check_law *law, const tl_check_points *in, const tl_check_batch *of, uint32_t other,
                 buffer *b)
{
    const tl_check_batch inside = {.end = of->padded};
    for (int k = 0; k < COLUMNS; k++) {
        const int state = k - TL_AT_STATE;
        const bool beyond = state >= (int)law->columns, energy = k >= TL_AT_STORED && state < 0;
        const uint32_t what = beyond ? TL_OTHER_STATES : energy ? TL_OTHER_ENERGIES : 0;
        const double padding = state >= 0 ? law->initial[state % TL_STATE_COLUMNS] : k == TL_AT_NORMAL + 2 ? 1.0 : 0;
        tl_check_fill(of, b->c[k], what ? NULL : in->c[k], padding,
                      tl_check_nobodys(k, (other & TL_OTHER_BEHIND) != 0));
        if (what)
            tl_check_fill(&inside, b->c[k], NULL, 0, tl_check_nobodys(k, (other & what) != 0));
    }
    for (size_t l = 0; l < of->end; l++)
        b->flags[l] = l >= of->padded ? UNTOUCHED_FLAGS : l < of->count ? in->flags[tl_check_entry(of, l)] : 0;
}

static const char *find_overwritten(const tl_check_law *law, const buffer *now, const buffer *before, size_t padded)
{
    for (int k = 0; k < COLUMNS; k++) {
        const size_t inside = padded * sizeof now->c[k][0];
        const size_t whole = inside + GUARD * sizeof now->c[k][0];
        if (k < TL_AT_F_N && memcmp(now->c[k], before->c[k], whole) != 0)
            return "a column of what it is given";
        if (k >= TL_AT_STATE + (int)law->columns && memcmp(now->c[k], before->c[k], whole) != 0)
            return "a state that it does not declare";
        if (memcmp((const char *)now->c[k] + inside, (const char *)before->c[k] + inside, whole - inside) != 0)
            return "what lies behind the batch";
    }
    if (memcmp(now->flags + padded, before->flags + padded, GUARD * sizeof now->flags[0]) != 0)
        return "the flags behind the batch";
    return NULL;
}

static bool padding_carries(const buffer *b, size_t count, size_t padded, bool energies)
{
    for (size_t l = count; l < padded; l++)
        for (int k = TL_AT_F_N; k < (energies ? TL_AT_STATE : TL_AT_STORED); k++)
            if (!(b->c[k][l] == 0))
                return true;
    return false;
}

void tl_law_call(const tl_check_law *law, const tl_check_points *in, tl_check_points *out, const size_t *order,
                 size_t begin, size_t count, tl_check_call *call)
{
    size_t padded = (count + TL_LANES - 1) / TL_LANES * TL_LANES;
    buffer now, before;
    double *state[2 * TL_STATE_COLUMNS];
    const tl_check_batch of = {order, begin, count, padded, padded + GUARD};
    fill(law, in, &of, call->other, &now);
    for (int k = 0; k < COLUMNS; k++)
        memcpy(before.c[k], now.c[k], of.end * sizeof now.c[k][0]);
    memcpy(before.flags, now.flags, of.end * sizeof now.flags[0]);
    tl_law_batch batch = tl_law_batch_of(now.c[0], MOST, now.flags, state, 2 * TL_STATE_COLUMNS);
    batch.count = (uint32_t)padded;
    batch.dt = in->dt;
    if (call->no_energies)
        batch.stored = batch.dissipated = NULL;
    call->report = (tl_report){.size = sizeof call->report};
    tl_enter(law->kind, "update");
    call->status = law->ops->update(law->self, &batch, &call->report);
    tl_leave();
    call->overwrote = find_overwritten(law, &now, &before, padded);
    call->padding = padding_carries(&now, count, padded, !call->no_energies);
    for (size_t l = 0; l < count; l++) {
        const size_t i = tl_check_entry(&of, l);
        for (int k = TL_AT_F_N; k < TL_AT_COUNT; k++)
            out->c[k][i] = k - TL_AT_STATE < (int)law->columns ? now.c[k][l] : 0;
        out->flags[i] = now.flags[l];
    }
}

tl_status tl_law_call_all(const tl_check_law *law, const tl_check_points *in, tl_check_points *out)
{
    tl_check_call call = {0};
    *out = *in;
    tl_law_call(law, in, out, NULL, 0, TL_CHECK_POINTS, &call);
    return call.status;
}

void tl_law_begin(const tl_check_law *law, tl_check_points *p, size_t i, double area, tl_vec3 normal)
{
    p->c[TL_AT_AREA][i] = area;
    tl_check_put(p->c[TL_AT_NORMAL], i, normal);
    for (uint32_t k = 0; k < law->columns; k++)
        p->c[TL_AT_STATE + k][i] = law->initial[k];
}

tl_vec3 tl_law_tangent(uint64_t key, tl_vec3 normal, double size)
{
    tl_vec3 any = tl_check_direction(key);
    return tl_v3_scale(size, tl_v3_sub(any, tl_v3_scale(tl_v3_dot(any, normal), normal)));
}
