/* outline.c - the corners of the common polygon of two convex faces, by which corners lie inside which lines.
 *
 * Which edges cross, which corners belong to the polygon and in which order follows from signs alone: an edge
 * of A crosses one of B when its ends lie on two sides of B's line and the other's ends on two sides of A's.
 * A corner of A on a line of B counts as inside, one of B on a line of A as outside, as if B were the larger by
 * a hair; edges along each other then do not cross. The same signs come again step after step, so what they
 * mean is kept in a table. Signs that fit no two convex faces, as rounding may make them, give no outline. */
#include "narrow/outline.h"

#include "narrow/point2.h"

#include <stdbool.h>

typedef struct walk {
    tl_outline *o;
    uint32_t na, nb;
    bool lost; /* the signs fit no polygon */
} walk;

static bool inside(uint64_t bytes, uint32_t corner, uint32_t line)
{
    return bytes >> (8 * corner + line) & 1;
}

static bool inside_all(uint64_t bytes, uint32_t corner, uint32_t lines)
{
    uint32_t all = (1u << lines) - 1;
    return (bytes >> 8 * corner & all) == all;
}

static uint32_t next_of(uint32_t i, uint32_t count)
{
    return i + 1 == count ? 0 : i + 1;
}

static void add(walk *w, uint32_t key, tl_outline_corner corner, uint32_t edge)
{
    tl_outline *o = w->o;
    if (o->count == TL_OUTLINE_CORNERS) {
        w->lost = true;
        return;
    }
    o->key[o->count] = key;
    o->edge[o->count] = (uint8_t)edge;
    o->corner[o->count++] = corner;
}

/* Adds a face's own corner. */
static void add_own(walk *w, uint32_t kind, uint32_t i)
{
    uint8_t at = (uint8_t)(kind == TL_POINT_A ? i : TL_OUTLINE_CORNERS + i);
    add(w, tl_corner_key(kind, i),
        (tl_outline_corner){
            .from = at, .to = at, .over = TL_HEIGHT_OWN, .under = TL_HEIGHT_OWN + 1},
        at);
}

/* Adds the corner where edge i of A crosses line j of B, and polygon goes on along `edge`. */
static void add_crossing(walk *w, uint32_t i, uint32_t j, uint32_t edge)
{
    uint32_t end = next_of(i, w->na);
    add(w, tl_key_of(TL_POINT_CROSSING, i, TL_EDGE_B + j),
        (tl_outline_corner){.from = (uint8_t)i,
                            .to = (uint8_t)end,
                            .over = (uint8_t)(TL_OUTLINE_CORNERS * j + i),
                            .under = (uint8_t)(TL_OUTLINE_CORNERS * j + end)},
        edge);
}

/* Adds the corners of B from its line j to its line `to`, which must all lie inside A; returns their number. */
static uint32_t follow_b(walk *w, uint32_t j, uint32_t to)
{
    uint32_t count = 0;
    for (; j != to && !w->lost; count++) {
        j = next_of(j, w->nb);
        w->lost |= !inside_all(w->o->inside_b, j, w->na);
        add_own(w, TL_POINT_B, j);
    }
    return count;
}

/* The lines of B over which edge i of A comes in and goes out, or nb. */
static void crossings_of(walk *w, uint32_t i, uint32_t *in, uint32_t *out)
{
    const tl_outline *o = w->o;
    uint32_t end = next_of(i, w->na);
    *in = *out = w->nb;
    for (uint32_t j = 0; j < w->nb; j++) {
        bool here = inside(o->inside_a, i, j);
        if (here == inside(o->inside_a, end, j) ||
            inside(o->inside_b, j, i) == inside(o->inside_b, next_of(j, w->nb), i))
            continue;
        uint32_t *line = here ? out : in;
        w->lost |= *line != w->nb;
        *line = j;
    }
}

/* Follows A's edges where they lie inside B, and B's edges from where one goes out to where the next comes
 * in. */
static void go_round(walk *w)
{
    uint32_t corners_b = 0, inside_b = 0, none = w->nb, first_in = none, left_over = none;
    bool on = inside_all(w->o->inside_a, 0, w->nb), began_on = on;
    for (uint32_t i = 0; i < w->na && !w->lost; i++) {
        uint32_t in, out;
        crossings_of(w, i, &in, &out);
        w->lost |= on != inside_all(w->o->inside_a, i, w->nb) || (on && in != none);
        if (on)
            add_own(w, TL_POINT_A, i);
        if (in != none) {
            if (left_over != none)
                corners_b += follow_b(w, left_over, in);
            else
                first_in = in;
            left_over = none;
            add_crossing(w, i, in, i);
            on = true;
        }
        if (out != none) {
            w->lost |= !on;
            add_crossing(w, i, out, TL_OUTLINE_CORNERS + out);
            left_over = out;
            on = false;
        }
    }
    if (left_over != none && first_in != none)
        corners_b += follow_b(w, left_over, first_in);
    for (uint32_t j = 0; j < w->nb; j++)
        inside_b += inside_all(w->o->inside_b, j, w->na);
    if (w->o->count == 0 && inside_b == w->nb) { /* B lies within A */
        for (; corners_b < w->nb; corners_b++)
            add_own(w, TL_POINT_B, corners_b);
    }
    w->lost |= on != began_on || corners_b != inside_b || (left_over != none) != (first_in != none);
}

static void find(tl_outline *o, uint32_t na, uint32_t nb)
{
    walk w = {.o = o, .na = na, .nb = nb};
    go_round(&w);
    uint32_t count = o->count;
    if (w.lost || count < 3) {
        o->count = 0;
        return;
    }
    for (uint32_t k = count; k < TL_OUTLINE_CORNERS; k++)
        o->corner[k] = o->corner[0];
    for (uint32_t k = 0; k < count; k++)
        o->middle_key[k] = tl_key_of(TL_POINT_MIDDLE, o->key[k], o->key[next_of(k, count)]);
}

/* Of corners on lines, byte i for corner i: the edges both of whose ends are on a line. */
static uint64_t along(uint64_t on, uint32_t count)
{
    return on & (on >> 8 | (on & UINT64_C(0xff)) << 8 * (count - 1));
}

/* Bit i: byte i has a bit. */
static uint32_t bytes_with_bits(uint64_t x)
{
    x |= x >> 4;
    x |= x >> 2;
    x |= x >> 1; /* bit 0 of a byte: any of its bits */
    return (uint32_t)((x & UINT64_C(0x0101010101010101)) * UINT64_C(0x0102040810204080) >> 56);
}

/* Bit i: bit i of some byte. */
static uint32_t bits_of_bytes(uint64_t x)
{
    x |= x >> 32;
    x |= x >> 16;
    x |= x >> 8;
    return (uint32_t)(x & 0xff);
}

tl_outline_shared tl_outline_shared_of(uint32_t na, uint32_t nb, uint64_t on_a, uint64_t on_b)
{
    uint64_t a = along(on_a, na), b = along(on_b, nb);
    return (tl_outline_shared){.a = bytes_with_bits(a) | bits_of_bytes(b),
                               .b = bits_of_bytes(a) | bytes_with_bits(b)};
}

const tl_outline *tl_outline_of(tl_outline *cache, uint32_t na, uint32_t nb, uint64_t inside_a,
                                uint64_t inside_b)
{
    uint32_t sides = na << 8 | nb;
    uint64_t mix =
        (inside_a ^ sides) * UINT64_C(0x9e3779b97f4a7c15) ^ inside_b * UINT64_C(0xd6e8feb86659fd93);
    tl_outline *o = &cache[(mix ^ mix >> 29) * UINT64_C(0xd6e8feb86659fd93) >> 57];
    if (o->sides == sides && o->inside_a == inside_a && o->inside_b == inside_b)
        return o;
    *o = (tl_outline){.sides = sides, .inside_a = inside_a, .inside_b = inside_b};
    find(o, na, nb);
    return o;
}
