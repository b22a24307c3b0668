/* corner_keys.c - numbers of the corners of blocks by place.
 *
 * A corner gets the key of the first corner before it that is nearer than `near`, in the order of blocks and their
 * corners. Places are found by cells of 2 near: within `near` of a place lie at most eight of them. */
#include "zone/corner_keys.h"

#include "base/random.h"

#include <math.h>
#include <stdlib.h>

/* Tolerance: corners nearer than this times the size of the smallest block are in one place. */
#define SAME_PLACE 1e-7

/* Corners by cells: the last one of each bucket, and the one before each in its bucket. */
typedef struct cells {
    tl_vec3 *place; /* of each corner, from the model's origin, m */
    size_t *last, *before;
    size_t mask;
    double near;
    tl_corner_keys *keys;
} cells;

#define NONE SIZE_MAX

static double lowest(double x, double near, int up)
{
    return floor((x + (up ? near : -near)) / (2 * near));
}

static size_t bucket_of(const cells *c, double x, double y, double z)
{
    const uint64_t key = tl_key(tl_key((uint64_t)(int64_t)x, (uint64_t)(int64_t)y), (uint64_t)(int64_t)z);
    return (size_t)key & c->mask;
}

/* The first corner among those before `corner` that is in its place, or NONE. */
static size_t first_there(const cells *c, size_t corner)
{
    const tl_vec3 at = c->place[corner];
    size_t found = NONE;
    for (int k = 0; k < 8; k++) {
        const double x = lowest(at.x, c->near, k & 1), y = lowest(at.y, c->near, k & 2),
                     z = lowest(at.z, c->near, k & 4);
        for (size_t n = c->last[bucket_of(c, x, y, z)]; n != NONE; n = c->before[n])
            if (n < found && tl_v3_norm2(tl_v3_sub(c->place[n], at)) < c->near * c->near)
                found = n;
    }
    return found;
}

static void put_in(cells *c, size_t corner)
{
    const double side = 2 * c->near;
    const tl_vec3 at = c->place[corner];
    size_t *last = &c->last[bucket_of(c, floor(at.x / side), floor(at.y / side), floor(at.z / side))];
    c->before[corner] = *last;
    *last = corner;
}

static bool is_among(const uint64_t *key, size_t count, uint64_t wanted)
{
    for (size_t k = 0; k < count; k++)
        if (key[k] == wanted)
            return true;
    return false;
}

/* Gives the corners of a block their keys. */
static void number_block(const tl_model *m, cells *c, uint32_t row)
{
    const tl_poly *shape = m->blocks.shape[row];
    const size_t start = c->keys->start[row];
    for (uint32_t v = 0; v < shape->vertex_count; v++) {
        const size_t corner = start + v;
        c->place[corner] = tl_body_point(&m->bodies, m->blocks.body[row], shape->vertex[v]);
        const size_t first = first_there(c, corner);
        const uint64_t key = first == NONE ? corner : c->keys->of[first];
        c->keys->of[corner] = is_among(c->keys->of + start, v, key) ? corner : key;
        put_in(c, corner);
    }
}

static bool make_cells(cells *c, size_t corners)
{
    size_t buckets = 16;
    while (buckets < corners)
        buckets *= 2;
    c->mask = buckets - 1;
    c->place = calloc(corners + 1, sizeof *c->place);
    c->before = calloc(corners + 1, sizeof *c->before);
    c->last = malloc(buckets * sizeof *c->last);
    for (size_t k = 0; c->last && k < buckets; k++)
        c->last[k] = NONE;
    return c->place && c->before && c->last;
}

bool tl_corner_keys_make(const tl_model *m, tl_corner_keys *keys)
{
    const size_t rows = m->blocks.table.rows;
    size_t corners = 0;
    cells c = {.near = INFINITY, .keys = keys};
    *keys = (tl_corner_keys){.start = calloc(rows + 1, sizeof *keys->start)};
    for (size_t row = 0; keys->start && row < rows; row++) {
        keys->start[row] = corners;
        if (!m->blocks.stays[row])
            continue;
        corners += m->blocks.shape[row]->vertex_count;
        c.near = fmin(c.near, SAME_PLACE * m->blocks.size[row]);
    }
    keys->of = malloc((corners + 1) * sizeof *keys->of);
    const bool enough = keys->start && keys->of && make_cells(&c, corners);
    for (uint32_t row = 0; enough && row < rows; row++)
        if (m->blocks.stays[row])
            number_block(m, &c, row);
    free(c.place);
    free(c.before);
    free(c.last);
    if (enough)
        keys->start[rows] = corners;
    else
        tl_corner_keys_free(keys);
    return enough;
}

void tl_corner_keys_free(tl_corner_keys *keys)
{
    free(keys->of);
    free(keys->start);
    *keys = (tl_corner_keys){0};
}
