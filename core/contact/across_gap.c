/* across_gap.c - what contact points carry where their walls are apart.
 *
 * A point presses at closures above -lift. It is lifted by an initial force, f_n0 / (kn A), and by what slip
 * has opened; a law for which that is otherwise tells so itself. A bond holds a share of the tension beyond. A
 * law that does not tell knows nothing of areas that are apart in part: it has bonds, but its force is that of
 * the closed part alone. */
#include "contact/across_gap.h"

#include "base/inside.h"

#include <math.h>
#include <string.h>

/* Points gathered at a time. */
#define SOME (2 * TL_LANES)

static _Alignas(TL_ALIGN) const double zeros[SOME];

/* Of a batch whose columns area, f_n0, state and flags are there. */
static void across_gap(const tl_law *law, const tl_law_batch *batch, double *restrict lift, double *restrict hold)
{
    const tl_law_ops *ops = law->kind->ops;
    if (ops->across_gap) {
        tl_enter(law->kind, "across_gap");
        ops->across_gap(law->self, batch, lift, hold);
        tl_leave();
        return;
    }
    const double *restrict area = batch->area, *restrict f_n0 = batch->f_n0;
    const uint32_t *restrict flags = batch->flags;
    const double kn = law->kn;
    const uint32_t lost = law->pulls == TL_PULL_ANY ? TL_POINT_APART : TL_POINT_APART | TL_POINT_FAILED;
    for (uint32_t i = 0; i < batch->count; i++) {
        double spring = kn * area[i];
        lift[i] = f_n0[i] / (spring > 0 ? spring : 1);
        hold[i] = law->pulls == TL_PULL_NONE || flags[i] & lost ? 0 : 1;
    }
}

void tl_points_across_gap(const tl_law *law, const tl_points_table *p, size_t first, size_t count, double *lift,
                          double *hold)
{
    const tl_law_ops *ops = law->kind->ops;
    double *state[TL_STATE_COLUMNS];
    for (size_t at = 0; at < count; at += SOME) {
        size_t some = count - at < SOME ? count - at : SOME, row = first + at;
        for (uint32_t k = 0; k < TL_STATE_COLUMNS; k++)
            state[k] = k < p->state_columns ? p->state[k] + row : (double *)(uintptr_t)zeros;
        const tl_law_batch batch = {.size = sizeof batch,
                                    .count = (uint32_t)some,
                                    .area = p->area + row,
                                    .f_n0 = p->f_n0 ? p->f_n0 + row : zeros,
                                    .state = state,
                                    .flags = p->flags + row};
        across_gap(law, &batch, lift + at, hold + at);
        for (size_t k = 0; k < some && !ops->across_gap; k++)
            hold[at + k] = 0;
    }
}

/* Some points of a contact as columns. */
typedef struct sample {
    _Alignas(TL_ALIGN) double area[TL_LANES];
    double f_n0[TL_LANES], state[TL_STATE_COLUMNS][TL_LANES], lift[TL_LANES], hold[TL_LANES];
    double reference[TL_LANES];
    _Alignas(TL_ALIGN) uint32_t flags[TL_LANES];
} sample;

/* Asks a law for TL_LANES points from `first`, with the initial forces there are, or without. Points beyond the
 * last have no area. States are there that the law keeps. */
static void ask_points(const tl_model *m, const tl_law *law, uint32_t c, size_t first, bool initial, sample *s)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    double *state[TL_STATE_COLUMNS];
    for (size_t l = 0; l < TL_LANES; l++) {
        bool is = first + l < contacts->point_count[c];
        size_t i = is ? tl_point_row(contacts, c, first + l) : 0;
        s->area[l] = is ? p->area[i] : 0;
        s->f_n0[l] = is && p->f_n0 && initial ? p->f_n0[i] : 0;
        s->reference[l] = is && p->reference ? p->reference[i] : 0;
        s->flags[l] = is ? p->flags[i] : 0;
        for (uint32_t k = 0; k < law->columns; k++)
            s->state[k][l] = is ? p->state[k][i] : 0;
    }
    for (uint32_t k = 0; k < TL_STATE_COLUMNS; k++)
        state[k] = k < law->columns ? s->state[k] : (double *)(uintptr_t)zeros;
    const tl_law_batch batch = {
        .size = sizeof batch, .count = TL_LANES, .area = s->area, .f_n0 = s->f_n0, .state = state, .flags = s->flags};
    across_gap(law, &batch, s->lift, s->hold);
}

static const tl_law *law_of(const tl_model *m, uint32_t c)
{
    uint32_t row = m->detect->contacts.law[c];
    return row == TL_NO_ROW ? NULL : &m->joint_laws[row];
}

tl_contact_across tl_contact_across_gap(const tl_model *m, uint32_t c)
{
    const tl_detect *d = m->detect;
    const tl_law *law = law_of(m, c);
    tl_contact_across out = {.most = 0};
    if (!tl_contact_is_lifted(m, c))
        return out;
    out.whole = true;
    for (size_t first = 0; first < d->contacts.point_count[c]; first += TL_LANES) {
        sample s;
        ask_points(m, law, c, first, true, &s);
        for (size_t l = 0; l < TL_LANES && s.area[l] > 0; l++) {
            out.most = fmax(out.most, s.lift[l] - s.reference[l]);
            out.bonded = out.bonded || s.hold[l] > 0;
            out.whole = out.whole && s.hold[l] >= 1;
        }
    }
    return out;
}

/* The lifts of TL_LANES points from `first`, with those of initial forces or without. They are 0 without a law
 * and beyond the last point. */
static void find_lifts(const tl_model *m, const tl_law *law, uint32_t c, size_t first, bool initial,
                       double lift[TL_LANES])
{
    sample s;
    memset(lift, 0, TL_LANES * sizeof *lift);
    if (!law)
        return;
    ask_points(m, law, c, first, initial, &s);
    for (size_t l = 0; l < TL_LANES && s.area[l] > 0; l++)
        lift[l] = s.lift[l];
}

void tl_law_point_openings(const tl_model *m, const tl_law *law, uint32_t c, size_t first, double opening[TL_LANES])
{
    find_lifts(m, law, c, first, false, opening);
}

void tl_contact_point_lifts(const tl_model *m, uint32_t c, size_t first, double lift[TL_LANES])
{
    find_lifts(m, law_of(m, c), c, first, true, lift);
}
