/* section.c - the section of a tunnel: its plane, whether it crosses itself, and its convex parts.
 *
 * A polygon is divided by clipping ears (triangles of three corners in a row that hold no other corner;
 * G. H. Meisters, Am. Math. Monthly 82 (1975) 648-651) and joining what stays convex (S. Hertel and
 * K. Mehlhorn, Lect. Notes Comput. Sci. 158 (1983) 207-218): at most four times the least number of
 * parts. Work grows with the cube of the number of corners. */
#include "section.h"

#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

static double turn(flat a, flat b, flat c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static double apart(flat a, flat b)
{
    double x = b.x - a.x, y = b.y - a.y;
    return sqrt(x * x + y * y);
}

bool outline_make(const tl_vec3 *corners, size_t count, outline *made)
{
    *made = (outline){.at = malloc((count + 1) * sizeof *made->at), .count = count};
    if (!made->at)
        return false;
    for (size_t i = 0; i < count; i++)
        made->middle = tl_v3_add(made->middle, tl_v3_sub(corners[i], corners[0]));
    made->middle = tl_v3_madd(corners[0], 1.0 / (double)count, made->middle);
    tl_vec3 sum = {0, 0, 0}, widest = {0, 0, 0}; /* twice an area, along its normal */
    for (size_t i = 0; i < count; i++) {
        tl_vec3 d = tl_v3_sub(corners[i], made->middle);
        sum = tl_v3_add(sum, tl_v3_cross(d, tl_v3_sub(corners[(i + 1) % count], made->middle)));
        for (size_t j = i + 1; j < count; j++) {
            tl_vec3 wide = tl_v3_cross(d, tl_v3_sub(corners[j], made->middle));
            widest = tl_v3_norm2(wide) > tl_v3_norm2(widest) ? wide : widest;
        }
    }
    made->area = 0.5 * tl_v3_norm(sum);
    made->spread = 0.5 * tl_v3_norm(widest);
    if (!(made->spread > 0))
        return true;
    /* areas of a polygon that crosses itself may cancel; it still has a plane */
    made->normal = tl_v3_unit(made->area > FIT * made->spread ? sum : widest);
    tl_vec3 t1 = tl_v3_perpendicular(made->normal), t2 = tl_v3_cross(made->normal, t1);
    for (size_t i = 0; i < count; i++) {
        tl_vec3 d = tl_v3_sub(corners[i], made->middle);
        made->at[i] = (flat){tl_v3_dot(d, t1), tl_v3_dot(d, t2)};
        made->bend = fmax(made->bend, fabs(tl_v3_dot(d, made->normal)));
    }
    return true;
}

/* Distance of c from the segment ab. */
static double off_segment(flat a, flat b, flat c)
{
    double length2 = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
    double t = length2 > 0 ? ((c.x - a.x) * (b.x - a.x) + (c.y - a.y) * (b.y - a.y)) / length2 : 0;
    t = fmin(1, fmax(0, t));
    return apart((flat){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}, c);
}

static bool segments_meet(flat a, flat b, flat c, flat d, double near)
{
    if ((turn(a, b, c) > 0) != (turn(a, b, d) > 0) && (turn(c, d, a) > 0) != (turn(c, d, b) > 0))
        return true;
    return off_segment(a, b, c) < near || off_segment(a, b, d) < near ||
           off_segment(c, d, a) < near || off_segment(c, d, b) < near;
}

bool outline_crosses(const outline *section, double near, size_t *one, size_t *other)
{
    const flat *at = section->at;
    size_t n = section->count;
    for (size_t i = 0; i < n; i++)
        for (size_t j = i + 1; j < n; j++) {
            flat a = at[i], b = at[(i + 1) % n], c = at[j], d = at[(j + 1) % n];
            bool meet;
            if (j == i + 1 || (i == 0 && j == n - 1)) {
                /* neighbours share a corner; the far ends must keep off the other edge */
                flat far1 = j == i + 1 ? a : b, far2 = j == i + 1 ? d : c;
                meet = off_segment(c, d, far1) < near || off_segment(a, b, far2) < near;
            } else {
                meet = segments_meet(a, b, c, d, near);
            }
            if (meet) {
                *one = i;
                *other = j;
                return true;
            }
        }
    return false;
}

/* How far b lies outward from the line from a to c: negative where the polygon turns inward. */
static double bulge(flat a, flat b, flat c)
{
    return turn(a, b, c) / fmax(apart(a, c), fmax(apart(a, b), apart(b, c)));
}

static bool is_convex(const flat *at, const size_t *corner, size_t count, double near)
{
    for (size_t i = 0; i < count; i++)
        if (bulge(at[corner[i]], at[corner[(i + 1) % count]], at[corner[(i + 2) % count]]) < -near)
            return false;
    return true;
}

/* Whether the corners before, at and after place k of the rest make a triangle without other corners. */
static bool is_ear(const flat *at, const size_t *rest, size_t count, size_t k, double near)
{
    size_t i = rest[(k + count - 1) % count], j = rest[k], l = rest[(k + 1) % count];
    flat a = at[i], b = at[j], c = at[l];
    if (bulge(a, b, c) <= near)
        return false;
    for (size_t m = 0; m < count; m++) {
        flat p = at[rest[m]];
        if (rest[m] != i && rest[m] != j && rest[m] != l && turn(a, b, p) >= 0 &&
            turn(b, c, p) >= 0 && turn(c, a, p) >= 0)
            return false;
    }
    return true;
}

/* The place of an ear, or of a corner on a straight line, which leaves without a triangle. */
static size_t find_ear(const flat *at, const size_t *rest, size_t count, double near,
                       bool *flat_one)
{
    *flat_one = false;
    for (size_t k = 0; k < count; k++)
        if (is_ear(at, rest, count, k, near))
            return k;
    *flat_one = true;
    size_t flattest = 0;
    double least = INFINITY;
    for (size_t k = 0; k < count; k++) {
        double b =
            fabs(bulge(at[rest[(k + count - 1) % count]], at[rest[k]], at[rest[(k + 1) % count]]));
        if (b < least) {
            least = b;
            flattest = k;
        }
    }
    return flattest;
}

/* A convex part while parts are being joined. */
typedef struct piece {
    size_t *corner;
    size_t count;
} piece;

/* Joins b to a over an edge they share when the whole is convex; a has room for both. */
static bool join_pieces(const flat *at, piece *a, piece *b, size_t *scratch, double near)
{
    for (size_t i = 0; i < a->count; i++)
        for (size_t j = 0; j < b->count; j++) {
            size_t from = a->corner[i], to = a->corner[(i + 1) % a->count];
            if (b->corner[j] != to || b->corner[(j + 1) % b->count] != from)
                continue;
            size_t count = 0;
            for (size_t k = 0; k < a->count; k++) /* from `to` all the way round to `from` */
                scratch[count++] = a->corner[(i + 1 + k) % a->count];
            for (size_t k = 2; k < b->count; k++) /* those of b between `from` and `to` */
                scratch[count++] = b->corner[(j + k) % b->count];
            if (!is_convex(at, scratch, count, near))
                return false;
            memcpy(a->corner, scratch, count * sizeof *scratch);
            a->count = count;
            b->count = 0;
            return true;
        }
    return false;
}

/* Fills triangles[] with corners in threes; returns their number. `rest` is used up. */
static size_t clip_ears(const outline *section, double near, size_t *rest, piece *triangles)
{
    size_t count = section->count, made = 0;
    while (count >= 3) {
        bool flat_one;
        size_t k = find_ear(section->at, rest, count, near, &flat_one);
        if (!flat_one) {
            piece *t = &triangles[made++];
            t->corner[0] = rest[(k + count - 1) % count];
            t->corner[1] = rest[k];
            t->corner[2] = rest[(k + 1) % count];
            t->count = 3;
        }
        count--;
        for (; k < count; k++)
            rest[k] = rest[k + 1];
    }
    return made;
}

static void join_all(const outline *section, double near, piece *pieces, size_t count,
                     size_t *scratch)
{
    bool joined = true;
    while (joined) {
        joined = false;
        for (size_t i = 0; i < count; i++)
            for (size_t j = i + 1; j < count; j++)
                if (pieces[i].count && pieces[j].count &&
                    join_pieces(section->at, &pieces[i], &pieces[j], scratch, near))
                    joined = true;
    }
}

/* Lists the pieces, each from its lowest corner on. */
static void list_parts(const piece *pieces, size_t count, division *parts)
{
    size_t at = 0;
    for (size_t i = 0; i < count; i++) {
        const piece *p = &pieces[i];
        if (p->count == 0)
            continue;
        size_t lowest = 0;
        for (size_t k = 1; k < p->count; k++)
            lowest = p->corner[k] < p->corner[lowest] ? k : lowest;
        parts->start[parts->parts++] = at;
        for (size_t k = 0; k < p->count; k++)
            parts->corner[at++] = p->corner[(lowest + k) % p->count];
    }
    parts->start[parts->parts] = at;
}

bool outline_divide(const outline *section, double near, division *parts)
{
    size_t n = section->count;
    *parts = (division){.corner = malloc(3 * n * sizeof *parts->corner),
                        .start = malloc((n + 1) * sizeof *parts->start)};
    size_t *rest = malloc(2 * n * sizeof *rest), *store = malloc(n * n * sizeof *store);
    piece *pieces = malloc(n * sizeof *pieces);
    bool enough = parts->corner && parts->start && rest && store && pieces;
    if (enough) {
        for (size_t i = 0; i < n; i++) {
            rest[i] = i;
            pieces[i] = (piece){store + i * n, 0};
        }
        if (is_convex(section->at, rest, n, near)) {
            memcpy(pieces[0].corner, rest, n * sizeof *rest);
            pieces[0].count = n;
            list_parts(pieces, 1, parts);
        } else {
            size_t count = clip_ears(section, near, rest, pieces);
            join_all(section, near, pieces, count, rest + n);
            list_parts(pieces, count, parts);
        }
    }
    free(rest);
    free(store);
    free(pieces);
    return enough;
}
