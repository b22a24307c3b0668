/* zone_places.c - places that are numbered: those that are near each other count as one.
 *
 * A place has the number of the first that is nearer than `near`. Places are found by cubes of 2 near: what is within
 * `near` of a place lies in at most eight of them. */
#include "geometry/zone_places.h"

#include "base/random.h"
#include "base/table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

#define NONE UINT32_MAX
/* Cost only: buckets to begin with. */
#define FEW 64

static size_t bucket_of(const tl_zone_places *p, double x, double y, double z)
{
    const uint64_t key = tl_key(tl_key((uint64_t)(int64_t)x, (uint64_t)(int64_t)y), (uint64_t)(int64_t)z);
    return (size_t)key & (p->buckets - 1);
}

static void put_in(tl_zone_places *p, uint32_t place)
{
    const double side = 2 * p->near;
    const tl_vec3 at = p->at[place];
    uint32_t *last = &p->last[bucket_of(p, floor(at.x / side), floor(at.y / side), floor(at.z / side))];
    p->before[place] = *last;
    *last = place;
}

/* Room for a place more, with buckets enough. */
static bool make_room(tl_zone_places *p)
{
    if (!tl_grow(&p->at, &p->at_room, (size_t)p->count + 1, sizeof *p->at) ||
        !tl_grow(&p->before, &p->before_room, (size_t)p->count + 1, sizeof *p->before))
        return false;
    if (p->count < p->buckets)
        return true;
    const size_t buckets = p->buckets ? 2 * p->buckets : FEW;
    uint32_t *last = realloc(p->last, buckets * sizeof *last);
    if (!last)
        return false;
    p->last = last;
    p->buckets = buckets;
    memset(last, 0xff, buckets * sizeof *last);
    for (uint32_t place = 0; place < p->count; place++)
        put_in(p, place);
    return true;
}

/* The first place that is near; NONE: there is none. */
static uint32_t find(const tl_zone_places *p, tl_vec3 at)
{
    const double side = 2 * p->near;
    uint32_t found = NONE;
    for (int k = 0; k < 8; k++) {
        const double x = floor((at.x + (k & 1 ? p->near : -p->near)) / side);
        const double y = floor((at.y + (k & 2 ? p->near : -p->near)) / side);
        const double z = floor((at.z + (k & 4 ? p->near : -p->near)) / side);
        for (uint32_t n = p->last[bucket_of(p, x, y, z)]; n != NONE; n = p->before[n])
            if (n < found && tl_v3_norm2(tl_v3_sub(p->at[n], at)) < p->near * p->near)
                found = n;
    }
    return found;
}

uint32_t tl_zone_places_put(tl_zone_places *p, tl_vec3 at)
{
    if (!make_room(p))
        return NONE;
    const uint32_t found = find(p, at);
    if (found != NONE)
        return found;
    p->at[p->count] = at;
    put_in(p, p->count);
    return p->count++;
}

void tl_zone_places_free(tl_zone_places *p)
{
    free(p->at);
    free(p->last);
    free(p->before);
    *p = (tl_zone_places){0};
}
