/* broad.c - the broad phase: a uniform grid that turns bounds into candidate pairs.
 *
 * Cells are as large as the median extent, or so much larger that there are no more cells than blocks: a scattered
 * model needs no huge grid. A block is entered in every cell its bounds overlap. Blocks lie beside each other, so those
 * of all sizes come to a few entries a cell. Two blocks that share several cells are reported once, from the cell that
 * holds the low corner of their common bounds. Bounds are grown by `reach`, so the list holds until some body has moved
 * that far, and by half of the block's own contact tolerance: a pair's is that of its smaller block, so a huge block
 * must not make the small ones neighbours of each other.
 *
 * After edits only the blocks that have come or changed are entered, and the others looked up among them. */
#include "detect/broad.h"

#include "detect/pairs.h"
#include "geometry/measure.h"

#include <stdlib.h>
#include <string.h>

/* Cost only: skin over the median extent: the motion that the list of pairs is good for. */
#define SKIN_EXTENTS 0.1
/* Cost only: margin of the ball about a body, far above roundings of its radius and of places. */
#define BALL_MARGIN 1e-9

/* Cost only: pairs up to which they are sorted by insertion. */
#define FEW_PAIRS 32

/* What a list of pairs is made with: nothing of it is kept. */
struct tl_broad {
    uint32_t *row; /* of each block that is entered, ascending */
    size_t count;
    tl_bounds *bounds; /* of each, grown */
    double *extent;
    uint32_t *cell_start, *entries; /* entries: numbers of blocks that are entered */
    size_t cell_capacity, entry_capacity;
    tl_pair *next; /* the list being made */
    size_t next_capacity;
    tl_bounds all;
    double reach, cell;
    uint32_t n[3];
};

typedef struct cell_range {
    uint32_t lo[3], hi[3];
} cell_range;

static void release(struct tl_broad *g)
{
    free(g->row);
    free(g->bounds);
    free(g->extent);
    free(g->cell_start);
    free(g->entries);
    free(g->next);
}

/* Enters all blocks, or those that have come or changed. */
static bool enter(const tl_model *m, struct tl_broad *g, bool all)
{
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        g->count += all || tl_block_is_new(m, row);
    g->row = malloc((g->count + 1) * sizeof *g->row);
    g->bounds = malloc((g->count + 1) * sizeof *g->bounds);
    g->extent = malloc((g->count + 1) * sizeof *g->extent);
    if (!g->row || !g->bounds || !g->extent)
        return false;
    g->count = 0;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        if (all || tl_block_is_new(m, row))
            g->row[g->count++] = row;
    return true;
}

static tl_bounds block_bounds(const tl_model *m, uint32_t row)
{
    const tl_poly *shape = m->blocks.shape[row];
    uint32_t body = m->blocks.body[row];
    const tl_mat3 *r = &m->bodies.pose[body].r;
    tl_vec3 x = tl_m3_mul(r, shape->vertex[0]);
    tl_bounds b = {x, x};
    for (uint32_t i = 1; i < shape->vertex_count; i++) {
        x = tl_m3_mul(r, shape->vertex[i]);
        b.min = tl_v3_min(b.min, x);
        b.max = tl_v3_max(b.max, x);
    }
    tl_vec3 place = tl_body_place(&m->bodies, body);
    return (tl_bounds){tl_v3_add(b.min, place), tl_v3_add(b.max, place)};
}

static int compare_double(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double longest(tl_bounds b)
{
    tl_vec3 d = tl_v3_sub(b.max, b.min);
    return fmax(d.x, fmax(d.y, d.z));
}

static cell_range range_of(const struct tl_broad *g, const tl_bounds *b)
{
    tl_vec3 low = g->all.min;
    const double lo[3] = {b->min.x - low.x, b->min.y - low.y, b->min.z - low.z};
    const double hi[3] = {b->max.x - low.x, b->max.y - low.y, b->max.z - low.z};
    cell_range r;
    for (int k = 0; k < 3; k++) {
        double top = g->n[k] - 1.0;
        r.lo[k] = (uint32_t)fmin(fmax(floor(lo[k] / g->cell), 0), top);
        r.hi[k] = (uint32_t)fmin(fmax(floor(hi[k] / g->cell), 0), top);
    }
    return r;
}

static size_t cell_index(const struct tl_broad *g, uint32_t x, uint32_t y, uint32_t z)
{
    return ((size_t)z * g->n[1] + y) * g->n[0] + x;
}

/* By how much the bounds of a block are grown: by what faces of seated pairs are moved, too. */
static double growth_of(const tl_model *m, const struct tl_broad *g, uint32_t row)
{
    double tolerance = TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * m->blocks.size[row];
    return g->reach + 0.5 * tolerance + m->seats.reach + 0.5 * m->seats.search_gap;
}

static tl_bounds grown(tl_bounds b, double growth)
{
    tl_vec3 skin = {growth, growth, growth};
    return (tl_bounds){tl_v3_sub(b.min, skin), tl_v3_add(b.max, skin)};
}

/* Chooses cell size and counts, and measures the grown bounds. `reach` is found where all blocks are entered. */
static tl_status measure(tl_model *m, struct tl_broad *g, bool whole)
{
    size_t count = g->count;
    g->all = (tl_bounds){{0, 0, 0}, {0, 0, 0}};
    for (size_t i = 0; i < count; i++) {
        tl_bounds b = g->bounds[i] = block_bounds(m, g->row[i]);
        g->extent[i] = longest(b);
        g->all.min = i ? tl_v3_min(g->all.min, b.min) : b.min;
        g->all.max = i ? tl_v3_max(g->all.max, b.max) : b.max;
    }
    qsort(g->extent, count, sizeof *g->extent, compare_double);
    double median = count ? g->extent[count / 2] : 1;
    g->reach = whole ? 0.5 * SKIN_EXTENTS * median : m->detect->reach;
    for (size_t i = 0; i < count; i++) {
        g->bounds[i] = grown(g->bounds[i], growth_of(m, g, g->row[i]));
        g->all.min = tl_v3_min(g->all.min, g->bounds[i].min);
        g->all.max = tl_v3_max(g->all.max, g->bounds[i].max);
    }
    tl_vec3 span = tl_v3_sub(g->all.max, g->all.min);
    /* no place is infinite, as limits.c sees to; what follows becomes whole numbers, so it is made sure of here */
    if (!isfinite(span.x) || !isfinite(span.y) || !isfinite(span.z) || !(median > 0))
        return tl_fail(&m->error, TL_E_NUMERIC,
                       "the blocks reach over %g, %g, %g m, which is more than numbers can tell", span.x, span.y,
                       span.z);
    for (g->cell = median;; g->cell *= 1.25) {
        double nx = floor(span.x / g->cell) + 1, ny = floor(span.y / g->cell) + 1;
        double nz = floor(span.z / g->cell) + 1;
        if (nx * ny * nz > (double)count + 1)
            continue;
        g->n[0] = (uint32_t)nx;
        g->n[1] = (uint32_t)ny;
        g->n[2] = (uint32_t)nz;
        return TL_OK;
    }
}

/* Lists the blocks in their cells (a counting sort; rows ascend in a cell). */
static tl_status fill(tl_model *m, struct tl_broad *g)
{
    size_t cells = (size_t)g->n[0] * g->n[1] * g->n[2], total = 0;
    if (!tl_grow(&g->cell_start, &g->cell_capacity, cells + 2, sizeof *g->cell_start))
        return tl_fail_memory(&m->error);
    memset(g->cell_start, 0, (cells + 2) * sizeof *g->cell_start);
    uint32_t *start = g->cell_start + 1; /* shifted: filling moves each start to its end */
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < g->count; i++) {
            cell_range r = range_of(g, &g->bounds[i]);
            for (uint32_t z = r.lo[2]; z <= r.hi[2]; z++)
                for (uint32_t y = r.lo[1]; y <= r.hi[1]; y++)
                    for (uint32_t x = r.lo[0]; x <= r.hi[0]; x++) {
                        size_t cell = cell_index(g, x, y, z);
                        if (pass == 0)
                            start[cell]++;
                        else
                            g->entries[start[cell]++] = i;
                    }
        }
        if (pass == 1)
            break;
        for (size_t cell = 0; cell < cells; cell++) {
            uint32_t here = start[cell];
            start[cell] = (uint32_t)total;
            total += here;
        }
        if (!tl_grow(&g->entries, &g->entry_capacity, total + 1, sizeof *g->entries))
            return tl_fail_memory(&m->error);
    }
    return TL_OK; /* now entries of cell c are [cell_start[c], cell_start[c + 1]) */
}

static bool push(struct tl_broad *g, size_t *count, tl_pair pair)
{
    if (!tl_grow(&g->next, &g->next_capacity, *count + 1, sizeof *g->next))
        return false;
    g->next[(*count)++] = pair;
    return true;
}

/* Pairs of a block with those entered in the cells of its bounds; if it is one of them, with rows above its own. */
static bool pairs_of(const tl_model *m, struct tl_broad *g, uint32_t row, const tl_bounds *mine, bool entered,
                     size_t *count)
{
    cell_range r = range_of(g, mine);
    for (uint32_t z = r.lo[2]; z <= r.hi[2]; z++)
        for (uint32_t y = r.lo[1]; y <= r.hi[1]; y++)
            for (uint32_t x = r.lo[0]; x <= r.hi[0]; x++) {
                size_t cell = cell_index(g, x, y, z);
                for (uint32_t e = g->cell_start[cell]; e < g->cell_start[cell + 1]; e++) {
                    const tl_bounds *its = &g->bounds[g->entries[e]];
                    uint32_t other = g->row[g->entries[e]];
                    if ((entered && other <= row) || !tl_bounds_meet(mine, its) ||
                        m->blocks.body[row] == m->blocks.body[other])
                        continue;
                    cell_range q = range_of(g, its);
                    if (x != (q.lo[0] > r.lo[0] ? q.lo[0] : r.lo[0]) || y != (q.lo[1] > r.lo[1] ? q.lo[1] : r.lo[1]) ||
                        z != (q.lo[2] > r.lo[2] ? q.lo[2] : r.lo[2]))
                        continue;
                    const tl_pair pair = {.a = row < other ? row : other,
                                          .b = row < other ? other : row,
                                          .contact = TL_PAIR_APART,
                                          .wake = -1};
                    if (!push(g, count, pair))
                        return false;
                }
            }
    return true;
}

/* Whether a block may be near those that are entered, by the ball of its body. */
static bool may_meet(const tl_model *m, const struct tl_broad *g, uint32_t row)
{
    uint32_t body = m->blocks.body[row];
    tl_vec3 place = tl_body_place(&m->bodies, body);
    double radius = m->bodies.radius[body] * (1 + BALL_MARGIN) + BALL_MARGIN * tl_v3_norm(place);
    tl_bounds ball = grown((tl_bounds){place, place}, radius + growth_of(m, g, row));
    return tl_bounds_meet(&ball, &g->all);
}

/* Pairs of the blocks that are entered with those that are not. */
static bool pairs_with_others(const tl_model *m, struct tl_broad *g, size_t *count)
{
    size_t next = 0;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        if (next < g->count && g->row[next] == row) {
            next++;
            continue;
        }
        if (!may_meet(m, g, row))
            continue;
        tl_bounds bounds = grown(block_bounds(m, row), growth_of(m, g, row));
        if (tl_bounds_meet(&bounds, &g->all) && !pairs_of(m, g, row, &bounds, false, count))
            return false;
    }
    return true;
}

static int compare_pair(const void *a, const void *b)
{
    const tl_pair *x = a, *y = b;
    return tl_pair_order(x->a, x->b, y->a, y->b);
}

/* Sorts a few pairs by insertion, as those of one block mostly are. */
static void sort_pairs(tl_pair *list, size_t count)
{
    if (count > FEW_PAIRS) {
        qsort(list, count, sizeof *list, compare_pair);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        const tl_pair pair = list[i];
        size_t to = i;
        for (; to > 0 && compare_pair(&list[to - 1], &pair) > 0; to--)
            list[to] = list[to - 1];
        list[to] = pair;
    }
}

/* Lists the candidate pairs, sorted: blocks that are entered ascend, and each is the first one of its pairs. */
static tl_status list_pairs(tl_model *m, struct tl_broad *g, bool whole, size_t *count)
{
    *count = 0;
    bool enough = tl_grow(&g->next, &g->next_capacity, whole ? m->detect->pair_count : 1, sizeof *g->next);
    for (uint32_t i = 0; i < g->count && enough; i++) {
        const size_t first = *count;
        enough = pairs_of(m, g, g->row[i], &g->bounds[i], true, count);
        if (*count > first)
            sort_pairs(g->next + first, *count - first);
    }
    if (enough && !whole)
        enough = pairs_with_others(m, g, count);
    if (!enough)
        return tl_fail_memory(&m->error);
    if (!whole)
        sort_pairs(g->next, *count);
    return TL_OK;
}

/* Reserves the chunks of so many pairs, none of which is known to sleep; false: out of memory. */
static bool restart_chunks(tl_detect *d, size_t pairs)
{
    const size_t chunks = pairs / TL_PAIR_CHUNK + 1;
    if (!tl_fit(&d->chunks, &d->chunk_capacity, chunks, sizeof *d->chunks))
        return false;
    for (size_t i = 0; i < chunks; i++)
        d->chunks[i] = (tl_pair_chunk){.wake = -INFINITY};
    return true;
}

/* Merges the old list into the new one: what was known of a pair stays, and a pair with a contact stays whatever its
 * bounds say. The old list goes: a list lasts for many steps, and two would take as much memory as the shapes. */
static tl_status merge(tl_model *m, struct tl_broad *g, size_t fresh)
{
    tl_detect *d = m->detect;
    size_t count = fresh;
    for (size_t i = 0, j = 0; i < d->pair_count; i++) {
        const tl_pair *old = &d->pairs[i];
        while (j < fresh && compare_pair(&g->next[j], old) < 0)
            j++;
        if (j < fresh && compare_pair(&g->next[j], old) == 0) {
            g->next[j] = *old;
            if (tl_pair_is_apart(old)) /* path lengths begin anew */
                g->next[j].wake = tl_pair_wake_at((double)old->wake - tl_pair_path(d, old));
        } else if (!tl_pair_is_apart(old) && !push(g, &count, *old)) {
            return tl_fail_memory(&m->error);
        }
    }
    if (count > fresh)
        qsort(g->next, count, sizeof *g->next, compare_pair);
    if (!restart_chunks(d, count))
        return tl_fail_memory(&m->error);
    tl_pair *trimmed = count ? realloc(g->next, count * sizeof *trimmed) : NULL;
    free(d->pairs);
    d->pairs = trimmed ? trimmed : g->next;
    d->pair_capacity = trimmed ? count : g->next_capacity;
    d->pair_count = count;
    g->next = NULL;
    for (uint32_t i = 0; i < count; i++)
        if (!tl_pair_is_apart(&d->pairs[i]))
            d->contacts.pair[d->pairs[i].contact] = i;
    return TL_OK;
}

/* Those of a sorted list that are not in the detection's, to its beginning; returns their number. */
static size_t unknown_pairs(const tl_detect *d, tl_pair *list, size_t count)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (d->pair_count == 0 || !bsearch(&list[i], d->pairs, d->pair_count, sizeof *list, compare_pair))
            list[kept++] = list[i];
    return kept;
}

/* Puts pairs in between the others: from the last one on, what lies behind it moves up. */
static tl_status insert(tl_model *m, struct tl_broad *g, size_t fresh)
{
    tl_detect *d = m->detect;
    fresh = unknown_pairs(d, g->next, fresh);
    size_t from = d->pair_count, to = from + fresh;
    if (!tl_fit(&d->pairs, &d->pair_capacity, to, sizeof *d->pairs) || !restart_chunks(d, to))
        return tl_fail_memory(&m->error);
    while (fresh) {
        bool old = from && compare_pair(&d->pairs[from - 1], &g->next[fresh - 1]) > 0;
        d->pairs[--to] = old ? d->pairs[--from] : g->next[--fresh];
        if (!tl_pair_is_apart(&d->pairs[to]))
            d->contacts.pair[d->pairs[to].contact] = (uint32_t)to;
        d->pair_count += !old;
    }
    return TL_OK;
}

/* Candidate pairs of all blocks, or of those that have come or changed, into g->next. */
static tl_status find(tl_model *m, struct tl_broad *g, bool whole, size_t *count)
{
    if (!enter(m, g, whole))
        return tl_fail_memory(&m->error);
    *count = 0;
    if (!whole && g->count == 0)
        return TL_OK;
    tl_status status = measure(m, g, whole);
    if (status == TL_OK)
        status = fill(m, g);
    return status == TL_OK ? list_pairs(m, g, whole, count) : status;
}

/* Adds the pairs of blocks that have come or changed. */
static tl_status add_pairs(tl_model *m)
{
    struct tl_broad g = {0};
    size_t fresh;
    tl_status status = find(m, &g, false, &fresh);
    if (status == TL_OK && fresh)
        status = insert(m, &g, fresh);
    release(&g);
    return status;
}

/* Reserves what is kept of the blocks and bodies of the model; their path lengths begin at 0. */
static tl_status restart_paths(tl_model *m)
{
    tl_detect *d = m->detect;
    size_t blocks = m->blocks.table.rows, bodies = m->bodies.table.rows;
    if (!tl_fit(&d->odometer_0, &d->odometer_capacity, bodies + 1, sizeof *d->odometer_0) ||
        !tl_fit(&d->touched, &d->touched_capacity, bodies + 1, sizeof *d->touched) ||
        !tl_fit(&d->idle, &d->idle_capacity, bodies + 1, sizeof *d->idle) ||
        !tl_fit(&d->path, &d->path_capacity, blocks + 1, sizeof *d->path))
        return tl_fail_memory(&m->error);
    for (size_t body = 0; body < bodies; body++)
        d->odometer_0[body] = m->bodies.odometer[body];
    for (size_t row = 0; row < blocks; row++)
        d->path[row] = 0;
    d->longest_path = 0;
    return TL_OK;
}

static tl_status list_anew(tl_model *m)
{
    struct tl_broad g = {0};
    size_t fresh;
    tl_status status = find(m, &g, true, &fresh);
    if (status == TL_OK)
        status = merge(m, &g, fresh);
    double reach = g.reach;
    release(&g);
    if (status != TL_OK)
        return status;
    m->detect->reach = reach;
    m->detect->listed = true;
    m->detect->lists++;
    return restart_paths(m);
}

tl_status tl_broad_update(tl_model *m, bool edits)
{
    const tl_detect *d = m->detect;
    if (!d->listed || (double)d->longest_path > d->reach)
        return list_anew(m);
    return edits ? add_pairs(m) : TL_OK;
}
