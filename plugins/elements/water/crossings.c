/* crossings.c - where wet joints meet: along edges of blocks, in lines that sides of their polygons share.
 *
 * Two sides meet when they run alongside each other within their slacks. All that do so, one by one, lie on one line.
 * The ends of sides divide that into crossings. So a long side that faces two short ones has two pieces.
 *
 * Sides are compared within the cells of a grid, so the time grows as their number. */
#include "crossings.h"

/* Tolerance: cosine of the angle between sides that run alongside each other. Test: unit/test_crossings. */
#define ALONGSIDE 0.9
/* Tolerance: ends of sides that are nearer than this share of the shortest side are one end, however wide the slack.
 * Test: unit/test_crossings. */
#define LEAST_PIECE 0.25

/* Cost only: width of a cell of the grid over the mean length of sides; and how far cells are off whole numbers. Sides
 * of regular rock would lie in two cells there. */
#define CELL 0.5
#define OFF 0.3127

/* All sides of the polygons. */
typedef struct sides {
    const flow_polygons *of;
    uint32_t *polygon; /* of each side */
    uint32_t *root;    /* of sides on one line */
    size_t count;
} sides;

static tl_vec3 begin_of(const sides *s, uint32_t k)
{
    return s->of->corner[k];
}

static tl_vec3 end_of(const sides *s, uint32_t k)
{
    const uint32_t p = s->polygon[k];
    return s->of->corner[k + 1 < s->of->first[p + 1] ? k + 1 : s->of->first[p]];
}

static double length_of(const sides *s, uint32_t k)
{
    return tl_v3_norm(tl_v3_sub(end_of(s, k), begin_of(s, k)));
}

/* ---------------------------------------------------------------- lines ------------------ */

static uint32_t root_of(uint32_t *root, uint32_t k)
{
    while (root[k] != k)
        k = root[k] = root[root[k]];
    return k;
}

static void unite(uint32_t *root, uint32_t a, uint32_t b)
{
    const uint32_t x = root_of(root, a), y = root_of(root, b);
    root[x < y ? y : x] = x < y ? x : y;
}

/* Distance of a point from the line through o along the unit vector d. */
static double distance(tl_vec3 o, tl_vec3 d, tl_vec3 x)
{
    const tl_vec3 way = tl_v3_sub(x, o);
    return tl_v3_norm(tl_v3_madd(way, -tl_v3_dot(way, d), d));
}

static bool run_alongside(const sides *s, uint32_t a, uint32_t b)
{
    if (s->polygon[a] == s->polygon[b])
        return false;
    if (length_of(s, a) < length_of(s, b)) {
        const uint32_t k = a;
        a = b;
        b = k;
    }
    const double slack = s->of->slack[s->polygon[a]] + s->of->slack[s->polygon[b]];
    const double length = length_of(s, a), other = length_of(s, b);
    if (!(other > 0))
        return false;
    const tl_vec3 o = begin_of(s, a), d = tl_v3_scale(1 / length, tl_v3_sub(end_of(s, a), o));
    const tl_vec3 from = begin_of(s, b), way = tl_v3_sub(end_of(s, b), from);
    const double along = tl_v3_dot(d, way), at = tl_v3_dot(d, tl_v3_sub(from, o));
    if (fabs(along) < ALONGSIDE * other)
        return false;
    const double low = fmax(0, fmin(at, at + along)), high = fmin(length, fmax(at, at + along));
    if (high - low <= fmin(slack, LEAST_PIECE * other))
        return false;
    const tl_vec3 x = tl_v3_madd(from, (low - at) / along, way), y = tl_v3_madd(from, (high - at) / along, way);
    return distance(o, d, x) <= slack && distance(o, d, y) <= slack;
}

/* A side in a cell of the grid. */
typedef struct entry {
    uint64_t cell;
    uint32_t side;
} entry;

static int compare_entries(const void *a, const void *b)
{
    const entry *x = a, *y = b;
    if (x->cell != y->cell)
        return x->cell < y->cell ? -1 : 1;
    return (x->side > y->side) - (x->side < y->side);
}

typedef struct entries {
    entry *at;
    size_t count, capacity;
} entries;

/* Enters a side into the cells of width h that its box touches. */
static bool enter(const sides *s, uint32_t k, double h, entries *list)
{
    const double slack = s->of->slack[s->polygon[k]];
    const tl_vec3 grow = tl_v3(slack, slack, slack), a = begin_of(s, k), b = end_of(s, k);
    const tl_vec3 off = tl_v3(OFF, OFF, OFF);
    const tl_vec3 low = tl_v3_add(off, tl_v3_scale(1 / h, tl_v3_sub(tl_v3_min(a, b), grow)));
    const tl_vec3 high = tl_v3_add(off, tl_v3_scale(1 / h, tl_v3_add(tl_v3_max(a, b), grow)));
    for (double x = floor(low.x); x <= high.x; x++)
        for (double y = floor(low.y); y <= high.y; y++)
            for (double z = floor(low.z); z <= high.z; z++) {
                if (list->count == list->capacity) {
                    const size_t more = list->capacity ? 2 * list->capacity : 1024;
                    entry *at = realloc(list->at, more * sizeof *at);
                    if (!at)
                        return false;
                    list->at = at;
                    list->capacity = more;
                }
                const uint64_t cell = (uint64_t)(int64_t)x * 0x9e3779b97f4a7c15u ^
                                      (uint64_t)(int64_t)y * 0xbf58476d1ce4e5b9u ^
                                      (uint64_t)(int64_t)z * 0x94d049bb133111ebu;
                list->at[list->count++] = (entry){cell, k};
            }
    return true;
}

/* Finds which sides lie on one line. */
static bool find_lines(sides *s)
{
    entries list = {0};
    double sum = 0, most = 0;
    bool enough = true;
    for (uint32_t k = 0; k < s->count; k++) {
        s->root[k] = k;
        sum += length_of(s, k);
        most = fmax(most, s->of->slack[s->polygon[k]]);
    }
    const double h = fmax(CELL * sum / (double)s->count, 4 * most);
    for (uint32_t k = 0; k < s->count && enough; k++)
        enough = enter(s, k, h, &list);
    if (enough)
        qsort(list.at, list.count, sizeof *list.at, compare_entries);
    for (size_t i = 0; enough && i < list.count; i++)
        for (size_t k = i + 1; k < list.count && list.at[k].cell == list.at[i].cell; k++)
            if (root_of(s->root, list.at[i].side) != root_of(s->root, list.at[k].side) &&
                run_alongside(s, list.at[i].side, list.at[k].side))
                unite(s->root, list.at[i].side, list.at[k].side);
    free(list.at);
    return enough;
}

/* ---------------------------------------------------------------- pieces ----------------- */

/* A side by its line. */
typedef struct member {
    uint32_t root, side;
} member;

static int compare_members(const void *a, const void *b)
{
    const member *x = a, *y = b;
    if (x->root != y->root)
        return x->root < y->root ? -1 : 1;
    return (x->side > y->side) - (x->side < y->side);
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* A line with its sides. */
typedef struct line {
    const sides *s;
    const member *with;
    size_t count;
    tl_vec3 origin, along;
    double *end; /* where crossings begin and end, ascending */
    size_t ends;
} line;

static double place_on(const line *l, tl_vec3 x)
{
    return tl_v3_dot(l->along, tl_v3_sub(x, l->origin));
}

/* The number of the end that a place on the line belongs to. */
static size_t nearest_end(const line *l, double place)
{
    size_t low = 0, high = l->ends - 1;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        if (l->end[middle] <= place)
            low = middle;
        else
            high = middle;
    }
    return place - l->end[low] <= l->end[high] - place ? low : high;
}

/* Finds the ends on a line. */
static void find_ends(line *l)
{
    double longest = 0, shortest = INFINITY, slack = 0;
    for (size_t i = 0; i < l->count; i++) {
        const uint32_t k = l->with[i].side;
        const double length = length_of(l->s, k);
        if (length > longest) {
            longest = length;
            l->origin = begin_of(l->s, k);
            l->along = tl_v3_unit(tl_v3_sub(end_of(l->s, k), l->origin));
        }
        shortest = fmin(shortest, length);
        slack = fmax(slack, l->s->of->slack[l->s->polygon[k]]);
    }
    for (size_t i = 0; i < l->count; i++) {
        l->end[2 * i] = place_on(l, begin_of(l->s, l->with[i].side));
        l->end[2 * i + 1] = place_on(l, end_of(l->s, l->with[i].side));
    }
    const double near = fmin(2 * slack, LEAST_PIECE * shortest);
    qsort(l->end, 2 * l->count, sizeof *l->end, compare_numbers);
    l->ends = 0;
    for (size_t i = 0; i < 2 * l->count; i++)
        if (l->ends == 0 || l->end[i] - l->end[l->ends - 1] > near)
            l->end[l->ends++] = l->end[i];
}

/* Pieces that are collected. */
typedef struct pieces {
    flow_piece *at;
    size_t count, capacity;
} pieces;

static bool put_piece(pieces *p, double from, size_t crossing)
{
    if (p->count == p->capacity) {
        const size_t more = p->capacity ? 2 * p->capacity : 1024;
        flow_piece *at = realloc(p->at, more * sizeof *at);
        if (!at)
            return false;
        p->at = at;
        p->capacity = more;
    }
    p->at[p->count++] = (flow_piece){from, (uint32_t)crossing};
    return true;
}

/* Adds the pieces of one side of a line whose crossings are numbered from `base` on. A side that is shorter than what
 * separates ends is a piece of the crossing it lies in. */
static bool cut_side(const line *l, uint32_t side, size_t base, pieces *p)
{
    const double a = place_on(l, begin_of(l->s, side)), b = place_on(l, end_of(l->s, side));
    size_t from = nearest_end(l, a), to = nearest_end(l, b);
    if (from == to) {
        from -= from + 1 == l->ends;
        return put_piece(p, 0, base + from);
    }
    bool enough = put_piece(p, 0, base + (from < to ? from : from - 1));
    while (enough && (from < to ? from + 1 < to : from > to + 1)) {
        from += from < to ? 1 : (size_t)-1;
        enough = put_piece(p, (l->end[from] - a) / (b - a), base + (from < to ? from : from - 1));
    }
    return enough;
}

/* Cuts all sides, line by line; where[k] says where the pieces of side k begin. */
static bool cut_all(const sides *s, const member *list, double *end, pieces *p, uint32_t *where, size_t *crossings)
{
    bool enough = true;
    for (size_t i = 0, next; i < s->count && enough; i = next) {
        for (next = i + 1; next < s->count && list[next].root == list[i].root;)
            next++;
        line l = {.s = s, .with = list + i, .count = next - i, .end = end};
        find_ends(&l);
        for (size_t k = i; k < next && enough; k++) {
            where[list[k].side] = (uint32_t)p->count;
            enough = l.ends > 1 ? cut_side(&l, list[k].side, *crossings, p) : put_piece(p, 0, *crossings);
        }
        *crossings += l.ends > 1 ? l.ends - 1 : 1;
    }
    return enough;
}

/* Puts the pieces into the order of the sides. */
static bool order_pieces(const sides *s, const member *list, const pieces *p, const uint32_t *where, flow_crossings *to)
{
    uint32_t *count = calloc(s->count + 1, sizeof *count);
    to->piece = malloc((p->count + 1) * sizeof *to->piece);
    to->first = malloc((s->count + 1) * sizeof *to->first);
    const bool enough = count && to->piece && to->first;
    for (size_t i = 0; enough && i < s->count; i++)
        count[list[i].side] = (i + 1 < s->count ? where[list[i + 1].side] : (uint32_t)p->count) - where[list[i].side];
    uint32_t at = 0;
    for (size_t k = 0; enough && k < s->count; k++) {
        to->first[k] = at;
        memcpy(to->piece + at, p->at + where[k], count[k] * sizeof *to->piece);
        at += count[k];
    }
    if (enough)
        to->first[s->count] = at;
    free(count);
    return enough;
}

bool flow_crossings_find(const flow_polygons *of, flow_crossings *found)
{
    sides s = {.of = of, .count = of->first[of->count]};
    pieces p = {0};
    *found = (flow_crossings){0};
    s.polygon = malloc((s.count + 1) * sizeof *s.polygon);
    s.root = malloc((s.count + 1) * sizeof *s.root);
    member *list = malloc((s.count + 1) * sizeof *list);
    double *end = malloc((2 * s.count + 1) * sizeof *end);
    uint32_t *where = malloc((s.count + 1) * sizeof *where);
    bool enough = s.polygon && s.root && list && end && where;
    for (uint32_t i = 0; enough && i < of->count; i++)
        for (uint32_t k = of->first[i]; k < of->first[i + 1]; k++)
            s.polygon[k] = i;
    enough = enough && (s.count == 0 || find_lines(&s));
    for (uint32_t k = 0; enough && k < s.count; k++)
        list[k] = (member){root_of(s.root, k), k};
    if (enough && s.count > 1)
        qsort(list, s.count, sizeof *list, compare_members);
    enough = enough && cut_all(&s, list, end, &p, where, &found->count) && order_pieces(&s, list, &p, where, found);
    void *const owned[] = {s.polygon, s.root, list, end, where, p.at};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    return enough;
}

void flow_crossings_free(flow_crossings *found)
{
    free(found->piece);
    free(found->first);
    *found = (flow_crossings){0};
}
