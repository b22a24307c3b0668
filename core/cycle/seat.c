/* seat.c - blocks as drawn are taken as fitting: gaps and overlaps up to limits become the state without force.
 *
 * Pairs that do not fit get planes for their faces in which they do (detect/fit.c), as of which they see themselves
 * (model/seats.h). Their blocks then touch, and have no volume in common, to rounding. Contacts begin without force. */
#include "base/columns.h"
#include "contact/across_gap.h"
#include "contact/contacts.h"
#include "contact/places.h"
#include "contact/store.h"
#include "cycle/cycle_data.h"
#include "cycle/undo.h"
#include "detect/detect.h"
#include "detect/fit.h"
#include "geometry/measure.h"
#include "model/body_shape.h"
#include "model/options.h"
#include "model/seats.h"
#include "segment/meets.h"
#include "zone/grid.h"

#include <stdlib.h>

/* Default: limits of gap and overlap over the mean size of the blocks. */
#define USUAL 0.01
/* Limit: share of a block's least thickness by which a face of it may be drawn back. Test: lua/test_seat_limits. */
#define MOST_THIN 0.25

/* Pairs that stay as drawn for one reason. */
typedef struct left_out {
    size_t count;
    tl_seat_beyond first; /* by the blocks' ids */
    double gap, overlap;  /* the largest, m */
} left_out;

typedef struct seating {
    tl_model *m;
    tl_fit_limits limits;
    tl_seated *made;
    size_t made_count, made_capacity;
    tl_seat_result *out;
    size_t beyond_capacity;
    left_out far, thin;          /* beyond the limits; of which a face would be drawn back too far */
    double area;                 /* of those to be made */
    tl_id deformable, neighbour; /* a pair that cannot be seated, or TL_NO_ID */
} seating;

/* ---------------------------------------------------------------- one pair --------------- */

/* Whether faces of a pair would be drawn back too far for how thin its blocks are. */
static bool is_too_thin(const tl_model *m, uint32_t a, uint32_t b, const tl_pair_fit *fit)
{
    return fit->drawn[0] > MOST_THIN * tl_least_thickness(m, a) || fit->drawn[1] > MOST_THIN * tl_least_thickness(m, b);
}

static int compare_beyond(const void *x, const void *y)
{
    const tl_seat_beyond *p = x, *q = y;
    return p->a != q->a ? (p->a > q->a) - (p->a < q->a) : (p->b > q->b) - (p->b < q->b);
}

static bool note_beyond(seating *s, uint32_t a, uint32_t b, const tl_pair_fit *now, left_out *why)
{
    tl_seat_result *out = s->out;
    const tl_seat_beyond pair = {s->m->blocks.id[a], s->m->blocks.id[b], now->gap, now->overlap};
    if (!tl_grow(&out->beyond, &s->beyond_capacity, out->beyond_count + 1, sizeof *out->beyond))
        return false;
    out->beyond[out->beyond_count++] = pair;
    if (why->count++ == 0 || compare_beyond(&pair, &why->first) < 0)
        why->first = pair;
    why->gap = fmax(why->gap, pair.gap);
    why->overlap = fmax(why->overlap, pair.overlap);
    return true;
}

/* Adds a pair to those that are to be seated. */
static bool note_seat(seating *s, uint32_t a, uint32_t b, const tl_pair_fit *now)
{
    const tl_model *m = s->m;
    tl_seat_result *out = s->out;
    if (!tl_grow(&s->made, &s->made_capacity, s->made_count + 1, sizeof *s->made))
        return false;
    s->made[s->made_count++] = (tl_seated){.block = {m->blocks.id[a], m->blocks.id[b]},
                                           .face = {now->face[0], now->face[1]},
                                           .plane = {now->plane[0], now->plane[1]},
                                           .frame = {tl_block_frame_of(m, a), tl_block_frame_of(m, b)}};
    out->contacts++;
    out->largest_gap = fmax(out->largest_gap, now->gap);
    out->largest_overlap = fmax(out->largest_overlap, now->overlap);
    out->mean_gap += now->area * now->mean_gap;
    out->mean_overlap += now->area * now->mean_overlap;
    s->area += now->area;
    return true;
}

/* Seats a pair, unless it fits as it is. What is new is measured from the blocks as drawn. false: out of memory, or a
 * block is deformable. */
static bool seat_pair(seating *s, uint32_t a, uint32_t b)
{
    tl_pair_fit now;
    if (!tl_fit_measure(s->m, a, b, false, s->limits, &now))
        return false;
    if (now.how == TL_FIT_WELL || now.how == TL_FIT_APART)
        return true;
    if (tl_blocks_deform_either(s->m, a, b)) {
        const bool first = tl_block_deforms(s->m, a);
        s->deformable = s->m->blocks.id[first ? a : b];
        s->neighbour = s->m->blocks.id[first ? b : a];
        return false;
    }
    const tl_pair_fit fits = now;
    const bool seated = tl_seated_of(s->m, s->m->blocks.id[a], s->m->blocks.id[b]) != NULL;
    if (seated && !tl_fit_measure(s->m, a, b, true, s->limits, &now))
        return false;
    if (is_too_thin(s->m, a, b, &fits))
        return note_beyond(s, a, b, &fits, &s->thin);
    if (fits.gap > s->limits.gap || fits.overlap > s->limits.overlap)
        return note_beyond(s, a, b, &fits, &s->far);
    return now.how == TL_FIT_APART || note_seat(s, a, b, &now);
}

/* ---------------------------------------------------------------- all of them ------------ */

/* Looks at all pairs that the broad phase lists. */
static bool seat_pairs(seating *s)
{
    const tl_detect *d = s->m->detect;
    for (size_t i = 0; i < d->pair_count; i++)
        if (!seat_pair(s, d->pairs[i].a, d->pairs[i].b))
            return false;
    if (s->out->beyond_count)
        qsort(s->out->beyond, s->out->beyond_count, sizeof *s->out->beyond, compare_beyond);
    s->out->mean_gap /= s->area > 0 ? s->area : 1;
    s->out->mean_overlap /= s->area > 0 ? s->area : 1;
    return true;
}

/* Finds the contacts. Overlaps are told by what follows, and not one by one. */
static tl_status find_contacts(tl_model *m)
{
    const uint32_t said = m->said;
    m->said |= 1u << TL_REMARK_OVERLAP;
    const tl_status status = tl_detect_update(m);
    m->said = said;
    return status;
}

/* Lists the pairs up to the limit of gaps. */
static tl_status list_pairs(tl_model *m, double gap)
{
    m->seats.search_gap = gap;
    if (m->detect)
        m->detect->listed = false;
    const tl_status status = find_contacts(m);
    m->seats.search_gap = 0;
    return status;
}

/* Puts the seated pairs into the model, and finds their contacts. */
static tl_status put_seats(seating *s)
{
    tl_model *m = s->m;
    if (s->made_count == 0)
        return TL_OK;
    if (!tl_seats_reserve(m, s->made_count))
        return tl_fail_memory(&m->error);
    tl_seats_put(m, s->made, s->made_count);
    for (size_t i = 0; i < s->made_count; i++)
        for (int k = 0; k < 2; k++)
            tl_block_changes(m, tl_block_row_quiet(m, s->made[i].block[k]));
    m->structure++;
    return find_contacts(m);
}

/* Takes all force out of a contact; what slip has opened stays opened. */
static void free_contact(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    tl_press_row *row = tl_press_row_of(m, c);
    const bool patch = tl_facet_is_patch(&contacts->facet[c]);
    double opening[TL_LANES];
    tl_contact_places(m, c, &m->detect->lanes[0]);
    for (size_t i = 0; i < contacts->point_count[c]; i++) {
        const size_t point = tl_point_row(contacts, c, i);
        if (i % TL_LANES == 0)
            tl_contact_point_openings(m, c, i, opening);
        p->f_n[point] = 0;
        tl_columns_put(p->f_s, point, tl_v3(0, 0, 0));
        if (!p->initial)
            continue;
        p->reference[point] = patch ? opening[i % TL_LANES] : 0;
        p->f_n0[point] = 0;
    }
    if (row) {
        row->shift = row->spare[0] = row->spare[1] = 0;
        row->leans = false;
    }
    contacts->force[c] = contacts->moment[c] = tl_v3(0, 0, 0);
    contacts->stored[c] = NAN;
}

static bool some_opened(tl_model *m)
{
    bool some = false;
    for (uint32_t c = 0; c < m->detect->contacts.table.rows; c++)
        some = some || tl_contact_opens(m, c);
    return some;
}

/* The words for one, or for more. */
static const char *plural(size_t count, const char *one, const char *more)
{
    return count == 1 ? one : more;
}

static void say_seated(const seating *s, bool given)
{
    tl_model *m = s->m;
    const tl_seat_result *r = s->out;
    const left_out *far = &s->far, *thin = &s->thin;
    tl_model_say(
        m,
        "seat: %zu contact%s made to fit, with gaps up to %.3g m (mean %.3g m) and overlaps up to %.3g m (mean "
        "%.3g m); limits: gap = %.3g, overlap = %.3g%s",
        r->contacts, plural(r->contacts, " was", "s were"), r->largest_gap, r->mean_gap, r->largest_overlap,
        r->mean_overlap, r->gap, r->overlap, given ? "" : ", of the blocks' mean size 1 %");
    if (far->count)
        tl_model_say(m,
                     "seat: %zu %s beyond the limits (first: blocks %u and %u, with a gap of %.3g m and an overlap of "
                     "%.3g m) and %s as drawn: draw them otherwise, or give larger limits (gap = %.3g, overlap = %.3g "
                     "would hold all)",
                     far->count, plural(far->count, "pair of blocks lies", "pairs of blocks lie"), far->first.a,
                     far->first.b, far->first.gap, far->first.overlap, plural(far->count, "stays", "stay"),
                     fmax(1.01 * far->gap, r->gap), fmax(1.01 * far->overlap, r->overlap));
    if (thin->count)
        tl_model_say(m,
                     "seat: %zu %s too deep for %s thickness (first: blocks %u and %u, by %.3g m) and %s as drawn: a "
                     "block gives way by a quarter of its thickness at the most, whatever the limits; draw them apart, "
                     "or delete a block that is there twice",
                     thin->count, plural(thin->count, "pair of blocks overlaps", "pairs of blocks overlap"),
                     plural(thin->count, "its", "their"), thin->first.a, thin->first.b, thin->first.overlap,
                     plural(thin->count, "stays", "stay"));
}

static double mean_size(const tl_model *m)
{
    double sum = 0;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        sum += m->blocks.size[row];
    return m->blocks.table.rows ? sum / (double)m->blocks.table.rows : 0;
}

/* All of it, with the limits known. */
static tl_status seat_all(tl_model *m, seating *s)
{
    tl_segments_forget_asked(m);
    tl_status status = list_pairs(m, s->limits.gap);
    if (status != TL_OK)
        return status;
    const bool looked = seat_pairs(s);
    if (s->deformable)
        return tl_fail(&m->error, TL_E_STATE,
                       "seat: block %u is deformable and does not fit block %u, and only rigid blocks are seated: draw "
                       "its neighbours so that they fit, or give smaller limits",
                       s->deformable, s->neighbour);
    if (!looked)
        return tl_fail_memory(&m->error);
    status = put_seats(s);
    if (status == TL_OK && some_opened(m) && !tl_detect_hold_initial(m->detect))
        status = tl_fail_memory(&m->error);
    if (status != TL_OK)
        return status;
    const tl_contacts *contacts = &m->detect->contacts;
    for (uint32_t c = 0; c < contacts->table.rows; c++)
        if (!tl_blocks_deform_either(m, contacts->a[c], contacts->b[c]))
            free_contact(m, c);
    m->split_count = 0; /* what new faces hold the parts of a cut by is gone */
    m->laws++;          /* contacts hold another energy */
    tl_undo_by_hand(m);
    tl_held_wake(m);
    return TL_OK;
}

tl_status tl_model_seat(tl_model *m, const tl_seat *given, tl_seat_result *result)
{
    tl_seat seat;
    tl_seat_result found = {.beyond = NULL};
    tl_status status = TL_OPTIONS_READ(tl_seat, given, &seat, &m->error);
    if (status == TL_OK)
        status = tl_model_may_change(m, "seat blocks");
    if (status == TL_OK)
        status = tl_model_may_set(m, "seat blocks");
    if (status != TL_OK)
        return status;
    const double usual = USUAL * mean_size(m);
    found.gap = isnan(seat.gap) ? usual : seat.gap;
    found.overlap = isnan(seat.overlap) ? usual : seat.overlap;
    if (!(found.gap >= 0) || !(found.overlap >= 0) || !isfinite(found.gap) || !isfinite(found.overlap))
        return tl_fail(&m->error, TL_E_ARGUMENT, "seat: gap and overlap must be lengths of at least 0 m");
    seating s = {.m = m, .limits = {found.gap, found.overlap}, .out = &found};
    status = seat_all(m, &s);
    free(s.made);
    if (status == TL_OK)
        say_seated(&s, !isnan(seat.gap) && !isnan(seat.overlap));
    if (status == TL_OK && result)
        *result = found;
    else
        free(found.beyond);
    return status;
}
