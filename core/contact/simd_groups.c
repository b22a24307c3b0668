/* simd_groups.c - which contacts lie side by side, in the lanes of which SIMD group, and where their points begin.
 *
 * Contacts of about as many points share a SIMD group, which has room in each lane for as many points as its largest contact.
 * They are looked for among neighbours in the order of blocks, so that what a group needs lies close together in memory.
 * Each joint law has a span of SIMD groups for patches and one for field contacts, and others for contacts between bodies
 * that are held still. New contacts get a free lane near the end of the span, or the first lane of a new group there. */
#include "contact/simd_groups.h"

#include "model/model.h"

#include <stdlib.h>

/* Contacts, one after the other, among which those of as many points are put together. */
#define WINDOW 1024
/* SIMD groups at the end of a span that are looked through for a free lane, ... */
#define LOOK_BACK 16
/* ... in which no more than so many points are left to spare. */
#define MOST_SPARE 8
/* Points more than it needs that a contact may grow by in a SIMD group that is begun for it. */
#define GROWTH 2
/* Rows and SIMD groups that are left to spare in a span at least. */
#define SPARE_POINTS 1024
#define SPARE_GROUPS 16

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

static tl_simd_group *begin_group(tl_layout *layout, tl_span *span, uint32_t slots)
{
    tl_simd_group *group = &layout->groups[span->group_end++];
    *group = (tl_simd_group){.start = (uint32_t)span->end, .slots = slots};
    for (uint32_t l = 0; l < TL_LANES; l++)
        group->contact[l] = TL_NO_ROW;
    span->end += (size_t)slots * TL_LANES;
    return group;
}

/* Gives a window of contacts their lanes. */
static void assign_lanes(tl_layout *layout, tl_contacts *c, tl_span *span, lane_request *requests,
                         size_t count)
{
    if (count > 1)
        qsort(requests, count, sizeof *requests, compare_requests);
    tl_simd_group *group = NULL;
    for (size_t i = 0; i < count; i++) {
        uint32_t lane = (uint32_t)(i % TL_LANES), row = requests[i].row;
        if (lane == 0)
            group = begin_group(layout, span, requests[i].points);
        group->contact[lane] = row;
        c->point_start[row] = group->start + lane;
        c->point_capacity[row] = (uint16_t)group->slots;
    }
}

static bool is_of_span(const tl_contacts *c, uint32_t row, const tl_span *span)
{
    return c->law[row] == span->law && c->held[row] == span->held && c->field[row] == span->field;
}

/* Lays the span of the contacts from `row` on that are of it; returns the row behind them. */
static uint32_t lay_span(tl_layout *layout, tl_contacts *c, tl_span *span, uint32_t row)
{
    lane_request requests[WINDOW];
    size_t count = 0;
    for (; row < c->table.rows && is_of_span(c, row, span); row++) {
        c->point_start[row] = 0;
        if (c->point_capacity[row])
            requests[count++] = (lane_request){c->point_capacity[row], row};
        if (count == WINDOW) {
            assign_lanes(layout, c, span, requests, count);
            count = 0;
        }
    }
    assign_lanes(layout, c, span, requests, count);
    return row;
}

bool tl_layout_make(tl_layout *layout, tl_contacts *c, size_t share, size_t *points)
{
    uint32_t rows = (uint32_t)c->table.rows;
    *points = 0;
    size_t groups = 0;
    for (uint32_t row = 0; row < rows;) {
        if (!tl_grow(&layout->spans, &layout->span_capacity, layout->span_count + 1,
                     sizeof *layout->spans))
            return false;
        tl_span *span = &layout->spans[layout->span_count++];
        *span = (tl_span){.law = c->law[row],
                          .held = c->held[row],
                          .field = c->field[row],
                          .begin = *points,
                          .group_begin = groups};
        size_t count = 0;
        for (uint32_t i = row; i < rows && is_of_span(c, i, span); i++)
            count += c->point_capacity[i] > 0;
        span->end = span->begin;
        span->group_end = groups;
        /* every window but the last of a span is full */
        size_t full = (count + TL_LANES - 1) / TL_LANES;
        span->group_limit = groups = groups + tl_with_spare(full, share, SPARE_GROUPS);
        if (!tl_grow(&layout->groups, &layout->group_capacity, groups, sizeof *layout->groups))
            return false;
        row = lay_span(layout, c, span, row);
        span->limit = span->begin + tl_with_spare(span->end - span->begin, share, SPARE_POINTS);
        span->limit = (span->limit + TL_LANES - 1) / TL_LANES * TL_LANES;
        *points = span->limit;
    }
    return true;
}

void tl_layout_free(tl_layout *layout)
{
    free(layout->spans);
    free(layout->groups);
    *layout = (tl_layout){0};
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

tl_simd_group *tl_simd_group_take(tl_detect *d, uint32_t points, uint32_t contact, uint32_t *lane)
{
    tl_span *span = span_of(d, contact);
    if (!span)
        return NULL;
    span->rest = TL_SPAN_WOKEN;
    for (size_t r = span->group_end, back = 0; r-- > span->group_begin && back < LOOK_BACK;
         back++) {
        tl_simd_group *group = &d->layout.groups[r];
        if (group->slots >= points && group->slots <= points + MOST_SPARE &&
            take_lane(group, contact, lane))
            return group;
    }
    size_t rows = (size_t)(points + GROWTH) * TL_LANES;
    if (span->group_end == span->group_limit || span->end + rows > span->limit ||
        rows > d->lane_capacity)
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
    size_t low = span->group_begin,
           high = span->group_end - 1; /* the last that begins there or before */
    while (low < high) {
        size_t middle = (low + high + 1) / 2;
        if (d->layout.groups[middle].start <= start)
            low = middle;
        else
            high = middle - 1;
    }
    return &d->layout.groups[low];
}

void tl_simd_group_note(tl_detect *d, uint32_t contact, uint32_t row)
{
    uint32_t start = d->contacts.point_start[contact];
    if (d->contacts.point_capacity[contact])
        group_at(d, start)->contact[start % TL_LANES] = row;
}
