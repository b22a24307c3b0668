/* zone_near.c - whether points that have been taken are near a place.
 *
 * Cells are found by a hash of their level and numbers. Slots that several cells share cost time only: distances are
 * compared, and whether a point lies within one does not depend on the order. */
#include "geometry/zone_near.h"

#include "base/random.h"
#include "base/table.h"

#include <math.h>
#include <stdlib.h>

#define NONE UINT32_MAX

/* Cost only: slots to begin with, and points a slot before these are doubled. */
#define FIRST_SLOTS 1024
#define CROWDED 2

struct tl_near_point {
    tl_vec3 place;
    uint32_t level, next;
};

static size_t slot_of(const tl_zone_near *n, uint32_t level, int64_t x, int64_t y, int64_t z)
{
    const uint64_t key = tl_key(tl_key((uint64_t)x * 0x100000001u + level, (uint64_t)y), (uint64_t)z);
    return (size_t)key & (n->slots - 1);
}

static int64_t cell_of(double at, double side)
{
    return (int64_t)floor(at / side);
}

static double side_of(const tl_zone_near *n, uint32_t level)
{
    return ldexp(n->side, -(int)level);
}

static void put_into_slot(tl_zone_near *n, uint32_t i)
{
    struct tl_near_point *p = &n->point[i];
    const double side = side_of(n, p->level);
    const size_t slot =
        slot_of(n, p->level, cell_of(p->place.x, side), cell_of(p->place.y, side), cell_of(p->place.z, side));
    p->next = n->first[slot];
    n->first[slot] = i;
}

static bool set_slots(tl_zone_near *n, size_t slots)
{
    if (!tl_grow(&n->first, &n->first_room, slots, sizeof *n->first))
        return false;
    n->slots = slots;
    for (size_t i = 0; i < slots; i++)
        n->first[i] = NONE;
    for (uint32_t i = 0; i < n->count; i++)
        put_into_slot(n, i);
    return true;
}

bool tl_zone_near_begin(tl_zone_near *n, double side)
{
    n->side = side;
    n->count = n->levels = 0;
    return set_slots(n, FIRST_SLOTS);
}

bool tl_zone_near_add(tl_zone_near *n, uint32_t level, tl_vec3 place)
{
    if (n->count == NONE - 1 || !tl_grow(&n->point, &n->point_room, (size_t)n->count + 1, sizeof *n->point))
        return false;
    n->point[n->count] = (struct tl_near_point){place, level, NONE};
    n->levels = level >= n->levels ? level + 1 : n->levels;
    n->count++;
    if (n->count > CROWDED * n->slots)
        return set_slots(n, 2 * n->slots);
    put_into_slot(n, n->count - 1);
    return true;
}

static bool any_in_cell(const tl_zone_near *n, size_t slot, tl_vec3 at, double distance)
{
    for (uint32_t i = n->first[slot]; i != NONE; i = n->point[i].next) {
        const tl_vec3 q = n->point[i].place;
        const double x = q.x - at.x, y = q.y - at.y, z = q.z - at.z;
        if (x * x + y * y + z * z < distance * distance)
            return true;
    }
    return false;
}

bool tl_zone_near_any(const tl_zone_near *n, tl_vec3 at, double distance)
{
    for (uint32_t level = 0; level < n->levels; level++) {
        const double side = side_of(n, level);
        const int64_t x1 = cell_of(at.x + distance, side), y1 = cell_of(at.y + distance, side);
        const int64_t z1 = cell_of(at.z + distance, side);
        for (int64_t x = cell_of(at.x - distance, side); x <= x1; x++)
            for (int64_t y = cell_of(at.y - distance, side); y <= y1; y++)
                for (int64_t z = cell_of(at.z - distance, side); z <= z1; z++)
                    if (any_in_cell(n, slot_of(n, level, x, y, z), at, distance))
                        return true;
    }
    return false;
}

void tl_zone_near_free(tl_zone_near *n)
{
    free(n->point);
    free(n->first);
    *n = (tl_zone_near){0};
}
