/* surface.c - facets of the ground: made of a grid's cells, listed by places in the plan, and clipped there.
 *
 * A cell of a grid has a node at each corner. The diagonal with the higher middle makes two facets of it. So the ground
 * of a cell bulges upward and is one convex part. Where both diagonals are as high, the cell is plane. */
#include "terrain.h"

/* Cost only: facets for each cell of the plan, cells along its longer side, and entries of a facet. */
#define FACETS_PER_CELL 2
#define MOST_CELLS_ALONG 2000
#define MOST_ENTRIES 64
/* Tolerance: relative, of the area of a block in the plan that facets cover, and of that which two of them share. */
#define COVERED 1e-9

/* ---------------------------------------------------------------- plan ------------------- */

static tl_flat flat_of(tl_vec3 p)
{
    return (tl_flat){p.x, p.y};
}

double polygon_area(const polygon *p)
{
    double twice = 0;
    for (uint32_t i = 1; i + 1 < p->count; i++)
        twice += tl_flat_cross(p->at[0], p->at[i], p->at[i + 1]);
    return 0.5 * twice;
}

/* Keeps what is left of the line from a to b. */
static void clip(polygon *p, tl_flat a, tl_flat b)
{
    polygon kept = {.count = 0};
    for (uint32_t i = 0; i < p->count; i++) {
        const tl_flat from = p->at[i], to = p->at[(i + 1) % p->count];
        const double d = tl_flat_cross(a, b, from), e = tl_flat_cross(a, b, to);
        if (d >= 0)
            kept.at[kept.count++] = from;
        if ((d > 0 && e < 0) || (d < 0 && e > 0)) {
            const double t = d / (d - e);
            kept.at[kept.count++] = (tl_flat){from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)};
        }
    }
    *p = kept;
}

static polygon polygon_of(const facet *f)
{
    return (polygon){.at = {flat_of(f->corner[0]), flat_of(f->corner[1]), flat_of(f->corner[2])}, .count = 3};
}

static bool boxes_meet(const facet *f, const tl_bounds *box)
{
    const tl_vec3 *c = f->corner;
    return fmin(c[0].x, fmin(c[1].x, c[2].x)) < box->max.x && fmax(c[0].x, fmax(c[1].x, c[2].x)) > box->min.x &&
           fmin(c[0].y, fmin(c[1].y, c[2].y)) < box->max.y && fmax(c[0].y, fmax(c[1].y, c[2].y)) > box->min.y;
}

polygon facet_in_box(const facet *f, const tl_bounds *box)
{
    polygon p = {.count = 0};
    if (!boxes_meet(f, box))
        return p;
    const tl_flat corner[] = {
        {box->min.x, box->min.y}, {box->max.x, box->min.y}, {box->max.x, box->max.y}, {box->min.x, box->max.y}};
    p = polygon_of(f);
    const double least = ROUNDINGS * fmin(polygon_area(&p), (box->max.x - box->min.x) * (box->max.y - box->min.y));
    for (int i = 0; i < 4 && p.count; i++)
        clip(&p, corner[i], corner[(i + 1) % 4]);
    if (!(polygon_area(&p) > least))
        p.count = 0;
    return p;
}

double facet_height(const facet *f, tl_flat at)
{
    return f->corner[0].z + f->fall[0] * (at.x - f->corner[0].x) + f->fall[1] * (at.y - f->corner[0].y);
}

double facet_width(const facet *f)
{
    const polygon p = polygon_of(f);
    double longest = 0;
    for (int i = 0; i < 3; i++) {
        const double x = p.at[(i + 1) % 3].x - p.at[i].x, y = p.at[(i + 1) % 3].y - p.at[i].y;
        longest = fmax(longest, sqrt(x * x + y * y));
    }
    return 2 * polygon_area(&p) / longest;
}

/* ---------------------------------------------------------------- facets ----------------- */

/* Whether a place comes before another, in the order of x, y and z: -1, 0 or 1. */
static int by_place(tl_vec3 a, tl_vec3 b)
{
    if (a.x != b.x)
        return a.x < b.x ? -1 : 1;
    if (a.y != b.y)
        return a.y < b.y ? -1 : 1;
    return (a.z > b.z) - (a.z < b.z);
}

/* Normal of the corners, of twice the area. */
static tl_vec3 facet_up(const facet *f)
{
    return tl_v3_cross(tl_v3_sub(f->corner[1], f->corner[0]), tl_v3_sub(f->corner[2], f->corner[0]));
}

tl_status surface_add(surface *s, const tl_vec3 corner[3], uint32_t row, uint32_t line)
{
    facet *at = (facet *)tl_grown(s->at, &s->capacity, s->count + 1, sizeof *at);
    if (!at)
        return s->host->fail(s->host, TL_E_MEMORY, "file '%.200s': out of memory for %zu triangles", s->file, s->count);
    s->at = at;
    facet *f = &at[s->count];
    *f = (facet){.row = row, .line = line};
    for (int k = 0; k < 3; k++)
        f->corner[k] = tl_v3_madd(s->translate, s->scale, corner[k]);
    while (by_place(f->corner[0], f->corner[1]) > 0 || by_place(f->corner[0], f->corner[2]) > 0) {
        const tl_vec3 first = f->corner[0];
        f->corner[0] = f->corner[1];
        f->corner[1] = f->corner[2];
        f->corner[2] = first;
    }
    /* of the corners in their last order, up to its sign: another one may round it to the other side */
    tl_vec3 up = facet_up(f);
    if (!(fabs(up.z) > ROUNDINGS * tl_v3_norm(up)))
        return s->host->fail(s->host, TL_E_GEOMETRY,
                             "file '%.200s', triangle %u at {%g, %g, %g}: it is vertical or has no area, and so no "
                             "height of its own; leave out all but the ground's top",
                             s->file, line, f->corner[0].x, f->corner[0].y, f->corner[0].z);
    if (up.z < 0) {
        const tl_vec3 second = f->corner[1];
        f->corner[1] = f->corner[2];
        f->corner[2] = second;
        up = facet_up(f);
    }
    f->normal = tl_v3_unit(up);
    f->fall[0] = -up.x / up.z;
    f->fall[1] = -up.y / up.z;
    s->count++;
    return TL_OK;
}

/* Lines of nodes that are taken: every n-th from the south or west, and the last, which no line is nearer to than n. */
static uint32_t lines_of(uint32_t nodes, uint32_t every)
{
    const uint32_t cells = (nodes - 1) / every;
    return (cells ? cells : 1) + 1;
}

static uint32_t line_at(uint32_t k, uint32_t nodes, uint32_t every)
{
    return k + 1 < lines_of(nodes, every) ? k * every : nodes - 1;
}

/* The range of cells [first, last) that may lie within [low, high] of the model. */
static void cells_within(double low, double high, double first_node, double step, uint32_t lines, uint32_t every,
                         uint32_t *first, uint32_t *last)
{
    const double wide = step * every, cells = (double)(lines - 1);
    *first = (uint32_t)fmin(fmax(floor((low - first_node) / wide) - 1, 0), cells - 1);
    *last = (uint32_t)fmin(fmax(floor((high - first_node) / wide) + 2, 0), cells);
}

/* A node of the grid, its row counted from the south. */
static tl_vec3 node_at(const grid *g, uint32_t row, uint32_t column)
{
    return tl_v3(g->x + g->dx * column, g->y + g->dy * row, g->z[(size_t)(g->rows - 1 - row) * g->columns + column]);
}

/* Adds the two facets of a cell, unless a node of it is without data. */
static tl_status add_cell(surface *s, const uint32_t row[2], const uint32_t column[2])
{
    const grid *g = &s->grid;
    const tl_vec3 sw = node_at(g, row[0], column[0]), se = node_at(g, row[0], column[1]),
                  nw = node_at(g, row[1], column[0]), ne = node_at(g, row[1], column[1]);
    if (isnan(sw.z + se.z + ne.z + nw.z))
        return TL_OK;
    const bool rising = sw.z + ne.z >= se.z + nw.z; /* the diagonal from south-west to north-east */
    const tl_vec3 first[3] = {sw, se, rising ? ne : nw}, second[3] = {rising ? sw : se, ne, nw};
    tl_status status = surface_add(s, first, g->rows - row[0], column[0] + 1);
    return status == TL_OK ? surface_add(s, second, g->rows - row[0], column[0] + 1) : status;
}

tl_status surface_of_grid(surface *s, const tl_bounds *box)
{
    const grid *g = &s->grid;
    const uint32_t every = s->every, columns = lines_of(g->columns, every), rows = lines_of(g->rows, every);
    uint32_t column[2], row[2];
    tl_status status = TL_OK;
    cells_within((box->min.x - s->translate.x) / s->scale, (box->max.x - s->translate.x) / s->scale, g->x, g->dx,
                 columns, every, &column[0], &column[1]);
    cells_within((box->min.y - s->translate.y) / s->scale, (box->max.y - s->translate.y) / s->scale, g->y, g->dy, rows,
                 every, &row[0], &row[1]);
    for (uint32_t i = row[0]; i < row[1] && status == TL_OK; i++)
        for (uint32_t j = column[0]; j < column[1] && status == TL_OK; j++)
            status = add_cell(s, (const uint32_t[]){line_at(i, g->rows, every), line_at(i + 1, g->rows, every)},
                              (const uint32_t[]){line_at(j, g->columns, every), line_at(j + 1, g->columns, every)});
    return status;
}

/* ---------------------------------------------------------------- places ----------------- */

/* The cells of the plan, first to last, that a range of places meets. */
static void cells_of(const surface *s, tl_flat min, tl_flat max, uint32_t first[2], uint32_t last[2])
{
    const double low[2] = {(min.x - s->x) / s->side, (min.y - s->y) / s->side};
    const double high[2] = {(max.x - s->x) / s->side, (max.y - s->y) / s->side};
    const uint32_t cells[2] = {s->columns, s->rows};
    for (int k = 0; k < 2; k++) {
        first[k] = (uint32_t)fmin(fmax(floor(low[k]), 0), cells[k] - 1);
        last[k] = (uint32_t)fmin(fmax(floor(high[k]), 0), cells[k] - 1);
    }
}

static void cells_of_facet(const surface *s, const facet *f, uint32_t first[2], uint32_t last[2])
{
    const tl_vec3 min = tl_v3_min(f->corner[0], tl_v3_min(f->corner[1], f->corner[2]));
    const tl_vec3 max = tl_v3_max(f->corner[0], tl_v3_max(f->corner[1], f->corner[2]));
    cells_of(s, flat_of(min), flat_of(max), first, last);
}

/* Lays cells over the plan, so large that facets have few entries; returns how many entries there are. */
static size_t lay_cells(surface *s)
{
    tl_vec3 min = s->at[0].corner[0], max = min;
    for (size_t i = 0; i < s->count; i++)
        for (int k = 0; k < 3; k++) {
            min = tl_v3_min(min, s->at[i].corner[k]);
            max = tl_v3_max(max, s->at[i].corner[k]);
        }
    const double wide = max.x - min.x, high = max.y - min.y;
    size_t entries = SIZE_MAX;
    s->x = min.x;
    s->y = min.y;
    s->side = fmax(sqrt(FACETS_PER_CELL * wide * high / (double)s->count), fmax(wide, high) / MOST_CELLS_ALONG);
    for (; entries > MOST_ENTRIES * s->count; s->side *= 2) {
        s->columns = (uint32_t)(wide / s->side) + 1;
        s->rows = (uint32_t)(high / s->side) + 1;
        entries = 0;
        for (size_t i = 0; i < s->count; i++) {
            uint32_t first[2], last[2];
            cells_of_facet(s, &s->at[i], first, last);
            entries += (size_t)(last[0] - first[0] + 1) * (last[1] - first[1] + 1);
        }
    }
    s->side *= 0.5;
    return entries;
}

/* Enters facets into their cells; without `facet` it only counts them. */
static void enter(surface *s, bool count)
{
    for (size_t i = s->count; i-- > 0;) { /* from the last, so that lists ascend */
        uint32_t first[2], last[2];
        cells_of_facet(s, &s->at[i], first, last);
        for (uint32_t row = first[1]; row <= last[1]; row++)
            for (uint32_t column = first[0]; column <= last[0]; column++) {
                uint32_t *at = &s->start[(size_t)row * s->columns + column];
                if (count)
                    ++*at;
                else
                    s->facet[--*at] = (uint32_t)i;
            }
    }
}

/* Refuses facets that have an area in common in the plan. */
static tl_status check_overlap(const surface *s, const facet *a, const facet *b)
{
    const tl_bounds box = {tl_v3_min(b->corner[0], tl_v3_min(b->corner[1], b->corner[2])),
                           tl_v3_max(b->corner[0], tl_v3_max(b->corner[1], b->corner[2]))};
    if (!boxes_meet(a, &box))
        return TL_OK;
    polygon p = polygon_of(a);
    const polygon other = polygon_of(b);
    const double least = COVERED * fmin(polygon_area(&p), polygon_area(&other));
    for (int k = 0; k < 3 && p.count; k++)
        clip(&p, other.at[k], other.at[(k + 1) % 3]);
    if (!(polygon_area(&p) > least))
        return TL_OK;
    return s->host->fail(s->host, TL_E_GEOMETRY,
                         "file '%.200s': triangles %u and %u lie one above the other at x = %g, y = %g: the surface "
                         "overhangs or is closed; leave out all but the ground's top",
                         s->file, a->line, b->line, p.at[0].x, p.at[0].y);
}

static tl_status check_overlaps(const surface *s)
{
    tl_status status = TL_OK;
    const size_t cells = (size_t)s->columns * s->rows;
    for (size_t k = 0; k < cells; k++)
        for (uint32_t i = s->start[k]; i < s->start[k + 1]; i++)
            for (uint32_t j = i + 1; j < s->start[k + 1] && status == TL_OK; j++)
                status = check_overlap(s, &s->at[s->facet[i]], &s->at[s->facet[j]]);
    return status;
}

static int by_corners(const void *left, const void *right)
{
    const facet *a = (const facet *)left, *b = (const facet *)right;
    int order = 0;
    for (int k = 0; k < 3 && order == 0; k++)
        order = by_place(a->corner[k], b->corner[k]);
    return order;
}

tl_status surface_index(surface *s)
{
    if (s->count == 0)
        return TL_OK;
    qsort(s->at, s->count, sizeof *s->at, by_corners); /* cuts do not depend on the order of the file */
    const size_t entries = lay_cells(s), cells = (size_t)s->columns * s->rows;
    s->start = (uint32_t *)calloc(cells + 1, sizeof *s->start);
    s->facet = (uint32_t *)malloc((entries + 1) * sizeof *s->facet);
    s->seen = (uint8_t *)calloc(s->count, 1);
    if (!s->start || !s->facet || !s->seen || entries > UINT32_MAX)
        return s->host->fail(s->host, TL_E_MEMORY, "file '%.200s': out of memory for %zu triangles", s->file, s->count);
    enter(s, true);
    for (size_t k = 1; k <= cells; k++)
        s->start[k] += s->start[k - 1];
    enter(s, false);
    return s->grid.z ? TL_OK : check_overlaps(s);
}

static int ascending(const void *left, const void *right)
{
    const uint32_t a = *(const uint32_t *)left, b = *(const uint32_t *)right;
    return (a > b) - (a < b);
}

size_t surface_list(surface *s, const tl_bounds *box, uint32_t *list)
{
    uint32_t first[2], last[2];
    size_t count = 0, kept = 0;
    if (s->count == 0)
        return 0;
    cells_of(s, flat_of(box->min), flat_of(box->max), first, last);
    for (uint32_t row = first[1]; row <= last[1]; row++)
        for (uint32_t column = first[0]; column <= last[0]; column++) {
            const size_t k = (size_t)row * s->columns + column;
            for (uint32_t i = s->start[k]; i < s->start[k + 1]; i++)
                if (!s->seen[s->facet[i]]) {
                    s->seen[s->facet[i]] = 1;
                    list[count++] = s->facet[i];
                }
        }
    for (size_t i = 0; i < count; i++) {
        s->seen[list[i]] = 0;
        if (facet_in_box(&s->at[list[i]], box).count)
            list[kept++] = list[i];
    }
    qsort(list, kept, sizeof *list, ascending);
    return kept;
}

/* Names the first node without data in a box in the plan that is grown by a cell. */
static tl_status name_gap(const surface *s, const tl_bounds *box)
{
    const grid *g = &s->grid;
    const double wide = g->dx * s->every, high = g->dy * s->every;
    for (uint32_t row = g->rows; row-- > 0;)
        for (uint32_t column = 0; column < g->columns; column++) {
            const tl_vec3 node = node_at(g, row, column);
            const double x = s->translate.x + s->scale * node.x, y = s->translate.y + s->scale * node.y;
            if (isnan(node.z) && x > box->min.x - s->scale * wide && x < box->max.x + s->scale * wide &&
                y > box->min.y - s->scale * high && y < box->max.y + s->scale * high)
                return s->host->fail(s->host, TL_E_GEOMETRY,
                                     "file '%.200s', row %u, column %u: the height at x = %g, y = %g is NODATA, and a "
                                     "block lies there; fill the grid or make the model smaller",
                                     s->file, g->rows - row, column + 1, x, y);
        }
    const tl_vec3 first = node_at(g, 0, 0), last = node_at(g, g->rows - 1, g->columns - 1);
    return s->host->fail(s->host, TL_E_GEOMETRY,
                         "file '%.200s': its heights are at x in [%g, %g] and y in [%g, %g], and a block reaches over "
                         "x in [%g, %g] and y "
                         "in [%g, %g]; give a larger grid, or mend scale and translate",
                         s->file, s->translate.x + s->scale * first.x, s->translate.x + s->scale * last.x,
                         s->translate.y + s->scale * first.y, s->translate.y + s->scale * last.y, box->min.x,
                         box->max.x, box->min.y, box->max.y);
}

tl_status surface_covers(const surface *s, const tl_bounds *box, const uint32_t *list, size_t count)
{
    const double wide = box->max.x - box->min.x, high = box->max.y - box->min.y;
    const double reach = fmax(fmax(fabs(box->min.x), fabs(box->max.x)), fmax(fabs(box->min.y), fabs(box->max.y)));
    double covered = 0;
    for (size_t i = 0; i < count; i++) {
        const polygon p = facet_in_box(&s->at[list[i]], box);
        covered += polygon_area(&p);
    }
    const double open = wide * high - covered;
    if (open <= COVERED * wide * high + 16 * DBL_EPSILON * reach * (wide + high))
        return TL_OK;
    if (s->grid.z)
        return name_gap(s, box);
    return s->host->fail(s->host, TL_E_GEOMETRY,
                         "file '%.200s': its triangles leave %g m2 of %g m2 open of the plan of a block over x in [%g, "
                         "%g] and y in [%g, %g]; close the hole, give a larger surface, or mend scale and translate",
                         s->file, open, wide * high, box->min.x, box->max.x, box->min.y, box->max.y);
}

void surface_free(surface *s)
{
    free(s->at);
    free(s->grid.z);
    free(s->start);
    free(s->facet);
    free(s->seen);
}
