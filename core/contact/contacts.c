/* contacts.c - the tables of contacts and contact points, and how they are laid out.
 *
 * The points of a joint law are one span of rows, so a law is called on the columns themselves; a span has room for a
 * few contacts more. Laying out anew sorts the contacts by joint law, apart those between bodies that are held still,
 * and by blocks. Contacts of a law that has no span yet get one behind the others, and nothing else moves. */
#include "contact/contacts.h"

#include "contact/sides.h"

#include "base/columns.h"
#include "base/inline.h"
#include "base/parallel.h"
#include "contact/index.h"
#include "contact/pair_view.h"
#include "contact/places.h"
#include "contact/store.h"
#include "model/joints.h"
#include "model/scope.h"
#include "zone/grid.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- SIMD groups -------------
 *
 * Which contacts lie side by side, in the lanes of which SIMD group, and where their points begin.
 *
 * Contacts of about as many points share a SIMD group, which has room in each lane for as many points as its largest
 * contact. They are looked for among neighbours in the order of blocks, so that what a group needs lies close together
 * in memory. Each joint law has a span of SIMD groups for patches and one for field contacts. Contacts between bodies
 * that are held still have spans of their own. New contacts get a free lane near the end of the span, or the first lane
 * of a new group there. */

/* Contacts, one after the other, among which those of as many points are put together. */
#define WINDOW 1024
/* SIMD groups at the end of a span that are looked through for a free lane, ... */
#define LOOK_BACK 16
/* ... in which no more than so many points are left to spare. */
#define MOST_SPARE 8
/* Points more than it needs that a contact may grow by in a SIMD group that is begun for it. */
#define GROWTH 2
/* Rows and SIMD groups that are left to spare in a span at least; and rows in one that is added to a layout. */
#define SPARE_POINTS 1024
#define SPARE_GROUPS 16
#define SPARE_ADDED 128

/* A contact that is to get a lane, and the points that it wants room for. */
typedef struct lane_request {
    uint32_t points, row;
} lane_request;

/* By room, largest first, then by row. */
static int compare_requests(const void *x, const void *y)
{
    const lane_request *p = x, *q = y;
    if (p->points != q->points)
        return p->points > q->points ? -1 : 1;
    return (p->row > q->row) - (p->row < q->row);
}

/* `need` and one in `share` more, or `least` more. */
static size_t with_spare(size_t need, size_t share, size_t least)
{
    size_t more = need / share;
    return need + (more > least ? more : least);
}

static tl_simd_group *begin_group(tl_layout *layout, tl_span *span, uint32_t slots)
{
    tl_simd_group *group = &layout->groups[span->group_end++];
    *group = (tl_simd_group){.start = (uint32_t)span->end, .slots = slots};
    for (uint32_t l = 0; l < TL_LANES; l++)
        group->contact[l] = TL_NO_ROW;
    span->end += (size_t)slots * TL_LANES;
    return group;
}

/* Sorts the requests of a span, window by window. Returns the rows that they need. */
static size_t sort_requests(lane_request *requests, size_t count)
{
    size_t rows = 0;
    for (size_t i = 0; i < count; i += WINDOW)
        qsort(&requests[i], count - i < WINDOW ? count - i : WINDOW, sizeof *requests, compare_requests);
    for (size_t i = 0; i < count; i += TL_LANES) /* the largest of a group is its first */
        rows += (size_t)requests[i].points * TL_LANES;
    return rows;
}

/* Begins the SIMD groups of a span for sorted requests. */
static void begin_groups(tl_layout *layout, tl_span *span, const lane_request *requests, size_t count)
{
    tl_simd_group *group = NULL;
    for (size_t i = 0; i < count; i++) {
        if (i % TL_LANES == 0)
            group = begin_group(layout, span, requests[i].points);
        group->contact[i % TL_LANES] = requests[i].row;
    }
}

static bool is_of_span(const tl_contacts *c, uint32_t row, const tl_span *span)
{
    return c->law[row] == span->law && c->held[row] == span->held && c->kind[row] == span->kind;
}

/* Adds a span behind the others: for contacts as that in a row, and for requests, which it sorts. It has one in `share`
 * rows and SIMD groups to spare, and so many rows at least. NULL when out of memory. */
static tl_span *add_span(tl_layout *layout, const tl_contacts *c, uint32_t row, lane_request *requests, size_t count,
                         size_t share, size_t spare)
{
    const tl_span last = layout->span_count ? layout->spans[layout->span_count - 1] : (tl_span){.limit = 0};
    const size_t begin = last.limit, group_begin = last.group_limit;
    const size_t rows = with_spare(sort_requests(requests, count), share, spare);
    const size_t groups = with_spare((count + TL_LANES - 1) / TL_LANES, share, SPARE_GROUPS);
    if (!tl_grow(&layout->spans, &layout->span_capacity, layout->span_count + 1, sizeof *layout->spans) ||
        !tl_grow(&layout->groups, &layout->group_capacity, group_begin + groups, sizeof *layout->groups))
        return NULL;
    tl_span *span = &layout->spans[layout->span_count++];
    *span = (tl_span){.law = c->law[row],
                      .held = c->held[row],
                      .kind = c->kind[row],
                      .begin = begin,
                      .end = begin,
                      .limit = begin + (rows + TL_LANES - 1) / TL_LANES * TL_LANES,
                      .group_begin = group_begin,
                      .group_end = group_begin,
                      .group_limit = group_begin + groups};
    return span;
}

/* Gives contacts that are sorted by spans their lanes in an empty layout: sets the start and room of each by the
 * room it wants, with one in `share` to spare. false when out of memory. */
static bool make_layout(tl_layout *layout, tl_contacts *c, size_t share)
{
    const uint32_t rows = (uint32_t)c->table.rows;
    lane_request *requests = malloc((rows + 1) * sizeof *requests);
    bool enough = requests != NULL;
    for (uint32_t row = 0; row < rows && enough;) {
        const uint32_t first = row;
        const tl_span like = {.law = c->law[first], .held = c->held[first], .kind = c->kind[first]};
        size_t count = 0;
        for (; row < rows && is_of_span(c, row, &like); row++) {
            c->point_start[row] = 0;
            if (c->point_capacity[row])
                requests[count++] = (lane_request){c->point_capacity[row], row};
        }
        tl_span *span = add_span(layout, c, first, requests, count, share, SPARE_POINTS);
        enough = span != NULL;
        if (!enough)
            break;
        begin_groups(layout, span, requests, count);
        for (size_t r = span->group_begin; r < span->group_end; r++)
            for (uint32_t l = 0; l < TL_LANES && layout->groups[r].contact[l] != TL_NO_ROW; l++) {
                c->point_start[layout->groups[r].contact[l]] = layout->groups[r].start + l;
                c->point_capacity[layout->groups[r].contact[l]] = (uint16_t)layout->groups[r].slots;
            }
    }
    free(requests);
    layout->laid_rows = layout->span_count ? layout->spans[layout->span_count - 1].limit : 0;
    return enough;
}

static tl_span *span_of(tl_detect *d, uint32_t contact)
{
    for (size_t r = 0; r < d->layout.span_count; r++)
        if (is_of_span(&d->contacts, contact, &d->layout.spans[r]))
            return &d->layout.spans[r];
    return NULL;
}

static bool take_lane(tl_simd_group *group, uint32_t contact, uint32_t *lane)
{
    for (uint32_t l = 0; l < TL_LANES; l++)
        if (group->contact[l] == TL_NO_ROW) {
            group->contact[l] = contact;
            *lane = l;
            return true;
        }
    return false;
}

/* A free lane of a span with room for so many points, taken for a contact; NULL when there is none. */
static tl_simd_group *take_group(tl_detect *d, tl_span *span, uint32_t points, uint32_t contact, uint32_t *lane)
{
    for (size_t r = span->group_end, back = 0; r-- > span->group_begin && back < LOOK_BACK; back++) {
        tl_simd_group *group = &d->layout.groups[r];
        if (group->slots >= points && group->slots <= points + MOST_SPARE && take_lane(group, contact, lane))
            return group;
    }
    size_t rows = (size_t)(points + GROWTH) * TL_LANES;
    if (span->group_end == span->group_limit || span->end + rows > span->limit || rows > d->lane_capacity)
        return NULL;
    tl_simd_group *group = begin_group(&d->layout, span, points + GROWTH);
    take_lane(group, contact, lane);
    return group;
}

/* The SIMD group a contact has a lane of, by where its points begin. */
static tl_simd_group *group_at(tl_detect *d, uint32_t start)
{
    const tl_span *span = d->layout.spans;
    while (start >= span->end)
        span++;
    size_t low = span->group_begin, high = span->group_end - 1; /* the last that begins there or before */
    while (low < high) {
        size_t middle = (low + high + 1) / 2;
        if (d->layout.groups[middle].start <= start)
            low = middle;
        else
            high = middle - 1;
    }
    return &d->layout.groups[low];
}

/* Notes that a contact's lane belongs to that row, or to none. */
static void note_lane(tl_detect *d, uint32_t contact, uint32_t row)
{
    uint32_t start = d->contacts.point_start[contact];
    if (d->contacts.point_capacity[contact])
        group_at(d, start)->contact[start % TL_LANES] = row;
}

/* ---------------------------------------------------------------- points ------------------
 *
 * Contact points: cleared, and the states of their law, begun or carried over.
 *
 * A state is copied, split by area, or reset when the point's polygon changes, as its law declares. */

void tl_point_clear(tl_points_table *p, size_t i)
{
    p->area[i] = p->f_n[i] = 0;
    if (p->f_n0)
        p->f_n0[i] = p->reference[i] = 0;
    p->flags[i] = p->key[i] = 0;
    for (int k = 0; k < 3; k++)
        p->p[k][i] = p->f_s[k][i] = 0;
    for (uint32_t k = 0; k < p->state_columns; k++)
        p->state[k][i] = 0;
}

void tl_point_resize(tl_points_table *p, size_t i, double area)
{
    double by = area / p->area[i];
    p->area[i] = area;
    if (by == 1)
        return;
    p->f_n[i] *= by;
    if (p->f_n0)
        p->f_n0[i] *= by;
    for (int s = 0; s < 3; s++)
        p->f_s[s][i] *= by;
}

tl_old_point tl_point_as_old(const tl_points_table *p, const tl_contacts *c, uint32_t contact, size_t k, tl_vec3 arm)
{
    size_t i = tl_point_row(c, contact, k);
    double per_area = p->area[i] > 0 ? 1 / p->area[i] : 0;
    tl_old_point out = {.arm = arm,
                        .normal = c->facet[contact].last,
                        .shear = tl_v3_scale(per_area, tl_columns_get(p->f_s, i)),
                        .area = p->area[i],
                        .f_n = per_area * p->f_n[i],
                        .n0 = p->f_n0 ? per_area * p->f_n0[i] : 0,
                        .reference = p->f_n0 ? p->reference[i] : 0,
                        .key = p->key[i],
                        .flags = p->flags[i]};
    for (uint32_t s = 0; s < p->state_columns; s++)
        out.state[s] = p->state[s][i];
    return out;
}

void tl_point_initial_state(tl_points_table *p, size_t i, const tl_kind *kind)
{
    for (uint32_t k = 0; k < p->state_columns; k++)
        p->state[k][i] = 0;
    for (tl_state_columns at = {0}; tl_state_next(kind, p->state_columns, &at);)
        if (at.count == 1)
            p->state[at.begin][i] = at.state->initial;
}

void tl_point_take_state(tl_points_table *p, size_t i, const tl_kind *kind, const double *old, double old_area,
                         bool stays)
{
    for (tl_state_columns at = {0}; tl_state_next(kind, p->state_columns, &at);) {
        uint32_t rule = at.state->transfer;
        double scale = 1;
        if (rule == TL_TRANSFER_SPLIT)
            scale = old_area > 0 ? p->area[i] / old_area : 0;
        if (stays || (rule != TL_TRANSFER_RESET && rule != TL_TRANSFER_ENERGY))
            for (uint32_t w = at.begin; w < at.begin + at.count; w++)
                p->state[w][i] = scale * old[w];
    }
}

void tl_states_turn(const tl_kind *kind, uint32_t columns, double *state, tl_vec3 from, tl_vec3 to)
{
    for (tl_state_columns at = {0}; tl_state_next(kind, columns, &at);) {
        double *v = &state[at.begin];
        if (at.count < 3)
            continue;
        tl_vec3 turned = tl_into_plane(tl_v3(v[0], v[1], v[2]), from, to);
        v[0] = turned.x, v[1] = turned.y, v[2] = turned.z;
    }
}

void tl_contact_begin_law(tl_model *m, uint32_t contact, const tl_kind *kind, const tl_point_lanes *lanes)
{
    tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    double size = tl_contact_size(m, contact);
    tl_contact_places(m, contact, lanes);
    for (size_t k = 0; k < c->point_count[contact]; k++) {
        size_t i = tl_point_row(c, contact, k);
        bool apart = c->facet[contact].kind == TL_FACET_FIELD || /* edges and corners have no bonds */
                     (lanes->closure[k] < -TL_STILL * size && !(d->points.f_n[i] < 0));
        tl_point_initial_state(&d->points, i, kind);
        d->points.flags[i] = apart ? TL_POINT_APART : 0;
    }
}

/* ---------------------------------------------------------------- held on held ------------
 *
 * Contacts between two bodies that are held still: told apart from the others, and left alone at rest.
 *
 * Such contacts have spans of their own. Their gaps and areas do not change, so they are followed only until a step
 * finds that their laws leave them exactly as they were. Laws are functions of their points' parameters, states and
 * motion, so every later step would find the same, and the whole span is passed over. A law that goes on with time at
 * rest keeps its span followed. Whatever could change that wakes all such spans: blocks that are fixed, freed, driven
 * or given a velocity, that come or go, another law or initial stress, another contact in the span. */

static bool is_still(const tl_model *m, uint32_t body)
{
    const tl_bodies *b = &m->bodies;
    const bool deforms = b->mesh[body] != 0;
    return !deforms && b->fixed[body] == TL_FIX_ALL && b->drive[body] == 0 && tl_v3_is_zero(b->v[body]) &&
           tl_v3_is_zero(b->w[body]);
}

/* Whether the bodies of two blocks are held still. */
static bool blocks_held_still(const tl_model *m, uint32_t a, uint32_t b)
{
    return is_still(m, m->blocks.body[a]) && is_still(m, m->blocks.body[b]);
}

/* Bodies none of whose contacts can change the sum of their forces. */
static void find_idle(tl_model *m)
{
    tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        d->idle[body] = is_still(m, body);
    for (uint32_t i = 0; i < c->table.rows; i++) {
        if (c->held[i])
            continue;
        const tl_sides on = tl_contact_bodies(m, i);
        d->idle[on.a] = d->idle[on.b] = false;
    }
}

void tl_held_wake(tl_model *m)
{
    tl_detect *d = m->detect;
    for (size_t r = 0; r < d->layout.span_count; r++)
        d->layout.spans[r].rest = TL_SPAN_WOKEN;
    d->any_idle = false;
}

void tl_held_sort(tl_model *m)
{
    tl_contacts *c = &m->detect->contacts;
    for (uint32_t row = 0; row < c->table.rows; row++) {
        if (c->pending[row] == TL_PENDING_DIE)
            continue;
        bool held = blocks_held_still(m, c->a[row], c->b[row]);
        if (held != c->held[row] && c->pending[row] == TL_PENDING_NONE)
            c->pending[row] = TL_PENDING_MOVE;
        c->held[row] = held;
    }
    tl_held_wake(m);
}

void tl_held_followed(tl_model *m)
{
    tl_detect *d = m->detect;
    bool rests = false, all = true;
    for (size_t r = 0; r < d->layout.span_count; r++) {
        tl_span *span = &d->layout.spans[r];
        if (!span->held || span->rest == TL_SPAN_RESTS)
            continue;
        /* the first step may still have met motion from before the bodies were held */
        span->rest = span->rest == TL_SPAN_WOKEN || span->changed ? TL_SPAN_FOLLOWED : TL_SPAN_RESTS;
        rests = rests || span->rest == TL_SPAN_RESTS;
        all = all && span->rest == TL_SPAN_RESTS;
    }
    if (!rests || !all)
        return;
    find_idle(m);
    d->any_idle = true;
}

/* ---------------------------------------------------------------- presses -----------------
 *
 * What field contacts keep beside their points, in rows that stay where they are. A row that is given back is the next
 * to be taken. */

uint32_t tl_press_take(tl_detect *d)
{
    uint32_t row = d->press_free;
    if (d->press_count == 0)
        row = d->press_free = TL_NO_ROW;
    if (row != TL_NO_ROW) {
        d->press_free = d->press[row].next_free;
    } else {
        if (!tl_grow(&d->press, &d->press_capacity, d->press_count + 1, sizeof *d->press))
            return TL_NO_ROW;
        row = (uint32_t)d->press_count++;
    }
    memset(&d->press[row], 0, sizeof *d->press);
    return row;
}

static void give_press_back(tl_detect *d, uint32_t row)
{
    if (row == TL_NO_ROW)
        return;
    d->press[row].next_free = d->press_free;
    d->press_free = row;
}

/* ---------------------------------------------------------------- tables ------------------ */

/* Where contacts are laid out anew, there is room for a share more of them, and of the points of each span, than is
 * needed. The share is 1 / SPARE_CALM first. It is doubled, up to 1 / SPARE_BUSY, each time that a layout did not last
 * LAYOUT_LASTS steps, as of blocks that fall or slide. It is halved each time that it did. SPARE_ROWS are left to spare
 * at least. */
#define SPARE_CALM 64
#define SPARE_BUSY 8
#define LAYOUT_LASTS 100
#define SPARE_ROWS 64
/* Cost only: spans that are added take one row of points for so many in use, at most. They leave as many
 * lanes empty in the spans from which their contacts come. */
#define MOST_ADDED 2
/* Cost only: how many steps laying out takes as long as. All are laid out anew once empty lanes have cost as much. */
#define LAYOUT_STEPS 8

uint32_t tl_law_row(const tl_model *m, tl_tag tag, uint32_t a, uint32_t b)
{
    const tl_law *law = tl_law_of(m, tag, a, b);
    return law ? (uint32_t)(law - m->joint_laws) : TL_NO_ROW;
}

bool tl_contact_append(tl_model *m, uint32_t pair, uint32_t kind, double valid, tl_tag tag, size_t want_points)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    uint32_t row = (uint32_t)c->table.rows;
    if (!tl_table_resize(&c->table, row + 1u))
        return false;
    tl_pair *p = &d->pairs[pair];
    c->born[row] = m->cycles;
    c->a[row] = p->a;
    c->b[row] = p->b;
    c->pair[row] = pair;
    c->tag[row] = tag;
    c->law[row] = tl_law_row(m, tag, p->a, p->b);
    c->facet[row] = (tl_facet){.kind = kind};
    c->kind[row] = (uint8_t)kind;
    c->press[row] = TL_NO_ROW;
    c->points_valid_to[row] = tl_contact_odometer(m, row);
    c->faces_valid_to[row] = c->points_valid_to[row] + valid;
    c->spot[row] = tl_spot_of(m, tl_contact_sides(m, row), valid);
    c->pending[row] = TL_PENDING_GROW;
    c->deep[row] = TL_DEEP_NOT;
    c->held[row] = blocks_held_still(m, p->a, p->b);
    d->idle[m->blocks.body[p->a]] = d->idle[m->blocks.body[p->b]] = false;
    p->contact = row;
    p->want_points = (uint16_t)want_points;
    return true;
}

typedef struct place {
    uint32_t law, held, kind, a, b, row;
} place;

static place place_of(const tl_contacts *c, uint32_t row)
{
    return (place){c->law[row], c->held[row], c->kind[row], c->a[row], c->b[row], row};
}

/* Whether two contacts are of different spans. */
static bool are_apart(const place *p, const place *q)
{
    return p->law != q->law || p->held != q->held || p->kind != q->kind;
}

static int compare_place(const void *x, const void *y)
{
    const place *p = x, *q = y;
    if (p->law != q->law)
        return p->law < q->law ? -1 : 1;
    if (p->held != q->held)
        return p->held < q->held ? -1 : 1;
    if (p->kind != q->kind)
        return p->kind < q->kind ? -1 : 1;
    return tl_pair_order(p->a, p->b, q->a, q->b);
}

/* Living contacts in their new order. */
static place *sorted(const tl_contacts *c, size_t *count)
{
    place *list = malloc((c->table.rows + 1) * sizeof *list);
    *count = 0;
    for (uint32_t row = 0; list && row < c->table.rows; row++)
        if (c->pending[row] != TL_PENDING_DIE)
            list[(*count)++] = place_of(c, row);
    if (list && *count > 1)
        qsort(list, *count, sizeof *list, compare_place);
    return list;
}

/* Room a contact is to get. What it has now must fit, too, for it is read when the new takes its place. */
static uint32_t wanted_points(const tl_detect *d, uint32_t row)
{
    const tl_contacts *c = &d->contacts;
    uint32_t want = d->pairs[c->pair[row]].want_points, have = c->point_count[row];
    return want > have ? want : have;
}

/* Copies one column of a contact's points, of which each lies TL_LANES rows behind the one before. */
TL_INLINE void copy_lane(char *to, const char *from, size_t size, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        memcpy(to + i * TL_LANES * size, from + i * TL_LANES * size, size);
}

/* Copies a contact's points from one table to other rows of another, or of the same. */
static void copy_points(const tl_points_table *from, size_t row, tl_points_table *to, size_t start, uint32_t count)
{
    for (size_t k = 0; k < from->table.column_count && count; k++) {
        size_t size = from->table.columns[k].size;
        char *target = (char *)tl_table_data(&to->table, k) + start * size;
        const char *source = (const char *)tl_table_data(&from->table, k) + row * size;
        if (size == sizeof(double)) /* as most have: a copy of a size that is known is no call */
            copy_lane(target, source, sizeof(double), count);
        else if (size == sizeof(uint32_t))
            copy_lane(target, source, sizeof(uint32_t), count);
        else
            copy_lane(target, source, size, count);
    }
}

/* A contact that has lost its points carries nothing. Without a lane for points no law will say so, nor book the
 * heat. */
static void leave_lane(tl_detect *d, tl_contacts *c, uint32_t row)
{
    c->point_capacity[row] = 0;
    c->force[row] = c->moment[row] = tl_v3(0, 0, 0);
    c->holds_over_gap[row] = false;
    c->stored[row] = 0;
    tl_addends_put(&d->parting, (c->share ? c->share[row] : 1) * c->released[row]);
    c->released[row] = 0;
}

/* Copies a contact into the spare table, with the room for points it is to get. */
static void copy_contact(tl_detect *d, uint32_t from, uint32_t to)
{
    tl_contacts *c = &d->contacts, *fresh = &d->spare;
    for (size_t k = 0; k < c->table.column_count; k++) {
        size_t size = c->table.columns[k].size;
        memcpy((char *)tl_table_data(&fresh->table, k) + to * size,
               (const char *)tl_table_data(&c->table, k) + from * size, size);
    }
    uint32_t want = tl_pending_waits(c->pending[from]) ? wanted_points(d, from) : c->point_count[from];
    bool busy = d->spare_share < SPARE_CALM; /* what has grown may grow again */
    bool keeps = busy && c->point_count[from] > 0 && c->pending[from] != TL_PENDING_MOVE;
    uint32_t capacity = keeps && c->point_capacity[from] > want ? c->point_capacity[from] : want;
    fresh->point_capacity[to] = (uint16_t)capacity;
}

static void swap_tables(tl_detect *d)
{
    tl_contacts contacts = d->contacts;
    d->contacts = d->spare;
    d->spare = contacts;
    tl_points_table points = d->points;
    d->points = d->spare_points;
    d->spare_points = points;
    d->contacts.table.owner = &d->contacts;
    d->spare.table.owner = &d->spare;
    d->points.table.owner = &d->points;
    d->spare_points.table.owner = &d->spare_points;
}

static void choose_spare(tl_detect *d, int64_t cycles)
{
    size_t share = d->spare_share;
    if (share == 0)
        share = SPARE_CALM;
    else if (cycles - d->laid_at >= LAYOUT_LASTS)
        share = 2 * share < SPARE_CALM ? 2 * share : SPARE_CALM;
    else
        share = share / 2 > SPARE_BUSY ? share / 2 : SPARE_BUSY;
    d->spare_share = share;
    d->laid_at = cycles;
}

static void free_spare(tl_detect *d)
{
    tl_table_free(&d->spare.table);
    tl_table_free(&d->spare_points.table);
}

void tl_contacts_free_spare(tl_detect *d, int64_t cycles)
{
    if (d->spare.table.capacity > 0 && cycles - d->laid_at >= LAYOUT_LASTS)
        free_spare(d);
}

/* Cost only: contacts that a thread copies at a time. */
#define COPY_CHUNK 1024

/* Contacts in their new order. Each is copied to rows of its own. */
typedef struct new_order {
    tl_detect *d;
    const place *list;
} new_order;

static void copy_contacts(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const new_order *order = user;
    for (size_t i = begin; i < end; i++)
        copy_contact(order->d, order->list[i].row, (uint32_t)i);
}

static void copy_points_of_contacts(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const new_order *order = user;
    tl_detect *d = order->d;
    for (size_t i = begin; i < end; i++) {
        const uint32_t row = order->list[i].row;
        copy_points(&d->points, d->contacts.point_start[row], &d->spare_points, d->spare.point_start[i],
                    d->contacts.point_count[row]);
        d->pairs[d->spare.pair[i]].contact = (uint32_t)i;
    }
}

/* Points of the contacts in their new order, in the spare table; nothing can fail any more. */
static void move_points(tl_model *m, const new_order *order)
{
    tl_detect *d = m->detect;
    tl_parallel_for(m->pool, d->spare.table.rows, COPY_CHUNK, copy_points_of_contacts, (void *)(uintptr_t)order);
    for (uint32_t i = 0; i < d->spare.table.rows; i++)
        if (d->spare.point_capacity[i] == 0)
            leave_lane(d, &d->spare, i);
}

bool tl_contacts_scattered(const tl_detect *d, int64_t cycles)
{
    const tl_layout *layout = &d->layout;
    const size_t rows = layout->span_count ? layout->spans[layout->span_count - 1].limit : 0;
    return rows > layout->laid_rows && (double)(cycles - layout->added_at) * (double)(rows - layout->laid_rows) >=
                                           LAYOUT_STEPS * (double)layout->laid_rows;
}

tl_status tl_contacts_repack(tl_model *m)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts, *fresh = &d->spare;
    size_t count;
    place *list = sorted(c, &count);
    if (!list)
        return tl_fail_memory(&m->error);
    choose_spare(d, m->cycles);
    fresh->table.rows = 0;
    d->spare_points.table.rows = 0;
    bool there = tl_table_reserve(&fresh->table, with_spare(count, d->spare_share, SPARE_ROWS)) &&
                 tl_table_resize(&fresh->table, count);
    new_order order = {d, list};
    if (there)
        tl_parallel_for(m->pool, count, COPY_CHUNK, copy_contacts, &order);
    tl_layout layout = {0};
    there = there && make_layout(&layout, fresh, d->spare_share) && tl_detect_make_lanes(d, &layout) &&
            layout.laid_rows <= UINT32_MAX && tl_table_resize(&d->spare_points.table, layout.laid_rows);
    if (there)
        move_points(m, &order);
    free(list);
    if (!there) {
        tl_layout_free(&layout);
        return tl_fail_memory(&m->error);
    }
    tl_layout_free(&d->layout);
    d->layout = layout;
    swap_tables(d);
    if (d->spare_share == SPARE_CALM) /* else they are laid out anew soon again */
        free_spare(d);
    tl_contacts_unlist(d);
    return tl_contacts_index(m) ? TL_OK : tl_fail_memory(&m->error);
}

/* Leaves a contact's lane empty. */
static void clear_points(tl_detect *d, uint32_t contact)
{
    note_lane(d, contact, TL_NO_ROW);
    for (size_t k = 0; k < d->contacts.point_capacity[contact]; k++)
        tl_point_clear(&d->points, tl_point_row(&d->contacts, contact, k));
}

/* Moves a contact's points to a lane that was taken for it. */
static void move_lane(tl_detect *d, uint32_t row, const tl_simd_group *group, uint32_t lane)
{
    tl_contacts *c = &d->contacts;
    copy_points(&d->points, c->point_start[row], &d->points, group->start + lane, c->point_count[row]);
    clear_points(d, row);
    c->point_start[row] = group->start + lane;
    c->point_capacity[row] = (uint16_t)group->slots;
}

/* Moves a contact's points, if it has or wants any, to a lane of its span with the room it wants; false when there is
 * none. */
static bool place_contact(tl_detect *d, uint32_t row)
{
    tl_contacts *c = &d->contacts;
    uint32_t points = wanted_points(d, row), lane;
    if (!points) { /* its lane may be of another span */
        clear_points(d, row);
        leave_lane(d, c, row);
        return true;
    }
    tl_span *span = span_of(d, row);
    if (!span)
        return false;
    span->rest = TL_SPAN_WOKEN;
    if (c->point_capacity[row] >= points && c->point_start[row] >= span->begin && c->point_start[row] < span->end)
        return true;
    const tl_simd_group *group = take_group(d, span, points, row, &lane);
    if (group)
        move_lane(d, row, group, lane);
    return group != NULL;
}

/* Whether a span that was added last may stay. */
static bool has_room(const tl_layout *layout, const tl_span *span)
{
    size_t used = 0;
    for (const tl_span *laid = layout->spans; laid < span && laid->begin < layout->laid_rows; laid++)
        used += laid->end - laid->begin;
    return span->limit - layout->laid_rows <= used / MOST_ADDED && span->limit <= UINT32_MAX;
}

/* Adds a span for some contacts, of one law and kind, and moves their points there; false when there is no room. */
static bool move_to_new_span(tl_detect *d, const place *list, size_t count, lane_request *requests, int64_t cycles)
{
    tl_layout *layout = &d->layout;
    uint32_t most = 0;
    for (size_t i = 0; i < count; i++) {
        requests[i] = (lane_request){wanted_points(d, list[i].row), list[i].row};
        most = requests[i].points > most ? requests[i].points : most;
    }
    tl_span *span = add_span(layout, &d->contacts, list->row, requests, count, d->spare_share, SPARE_ADDED);
    if (!span)
        return false;
    if ((size_t)most * TL_LANES > d->lane_capacity || !has_room(layout, span) ||
        !tl_table_resize(&d->points.table, span->limit)) {
        layout->span_count--;
        return false;
    }
    begin_groups(layout, span, requests, count);
    for (size_t r = span->group_begin; r < span->group_end; r++)
        for (uint32_t l = 0; l < TL_LANES && layout->groups[r].contact[l] != TL_NO_ROW; l++)
            move_lane(d, layout->groups[r].contact[l], &layout->groups[r], l);
    layout->added_at = cycles;
    return true;
}

/* Whether a contact that has come under another law, or is held now, is of a span that there is none of yet. For
 * contacts that are born or grow all are laid out anew. */
static bool lacks_span(tl_detect *d, uint32_t row)
{
    return d->contacts.pending[row] == TL_PENDING_MOVE && wanted_points(d, row) > 0 && !span_of(d, row);
}

/* Makes the spans that such contacts lack, in the order of a layout. false when there is no room. */
static bool add_spans(tl_detect *d, int64_t cycles)
{
    const tl_contacts *c = &d->contacts;
    size_t count = 0;
    for (uint32_t row = 0; row < c->table.rows; row++)
        count += lacks_span(d, row);
    if (count == 0 || d->layout.span_count == 0)
        return count == 0;
    place *list = malloc(count * sizeof *list);
    lane_request *requests = malloc(count * sizeof *requests);
    bool enough = list && requests;
    size_t listed = 0;
    for (uint32_t row = 0; row < c->table.rows && enough; row++)
        if (lacks_span(d, row))
            list[listed++] = place_of(c, row);
    if (enough)
        qsort(list, count, sizeof *list, compare_place);
    for (size_t first = 0, end; first < count && enough; first = end) {
        for (end = first + 1; end < count && !are_apart(&list[first], &list[end]);)
            end++;
        enough = move_to_new_span(d, &list[first], end - first, requests, cycles);
    }
    free(list);
    free(requests);
    return enough;
}

bool tl_contacts_place(tl_detect *d, int64_t cycles)
{
    bool enough = add_spans(d, cycles);
    for (uint32_t row = (uint32_t)d->contacts.table.rows; row-- > 0 && enough;)
        if (d->contacts.pending[row] != TL_PENDING_NONE)
            enough = place_contact(d, row);
    return enough;
}

void tl_contact_remove(tl_detect *d, uint32_t row)
{
    tl_contacts *c = &d->contacts;
    uint32_t last = (uint32_t)c->table.rows - 1;
    clear_points(d, row);
    give_press_back(d, c->press[row]);
    tl_contacts_unlist(d);
    if (c->pair[row] < d->pair_count && d->pairs[c->pair[row]].contact == row)
        d->pairs[c->pair[row]].contact = TL_PAIR_APART;
    if (row != last) {
        tl_table_move(&c->table, row, last);
        d->pairs[c->pair[row]].contact = row;
        note_lane(d, row, row);
    }
    c->table.rows = last;
}

void tl_contact_describe(tl_model *m, uint32_t contact, char *text, size_t size)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const char *joint = tl_tag_name(m, contacts->tag[contact]);
    snprintf(text, size, "contact of blocks %u and %u%s%s", m->blocks.id[contacts->a[contact]],
             m->blocks.id[contacts->b[contact]], *joint ? ", joint " : " (no joint)", joint);
}
