/* terrain.c - generator "terrain": the ground, a surface z(x, y) of triangles, divides the visible blocks.
 *
 * Only blocks that the surface passes are cut. Cuts are no joints. A piece over triangles whose planes z_j bound a
 * ground that bulges upward,
 *
 *     z(x, y) = min over j of z_j(x, y),
 *
 * is cut by these planes one after the other, and what is below all of them is one part. Any other piece is cut by the
 * vertical plane through a side of a triangle, the one that leaves the fewest triangles on each side. So a piece is at
 * the least the vertical prism of one triangle, and one that the surface does not pass is cut no further. Parts below
 * stay one body where they hang together. Those above leave it and get the group, as do blocks above.
 *
 * Limits: the surface covers the bounds of each visible block in the plan. A plane that would leave a sliver, by the
 * limit of all cuts, does not cut. */
#include "terrain.h"

#include <talus/version.h>

/* Tolerance: a triangle narrower in the plan than this times the size of a block that it cuts is refused. It is ten
 * times the thickness, relative to a block's size, below which the host cuts nothing. */
#define THIN 1e-4
/* Tolerance: planes that bound a bulge each remove at least this times the size of the piece, or nothing: four times
 * the thickness below which the host cuts nothing. Less is cut prism by prism. */
#define REMOVED 4e-5
/* Cost only: triangles whose sides are tried for a vertical cut. */
#define MOST_TRIED 128

typedef struct params {
    const char *file;
    double scale;
    tl_vec3 translate;
    const char *group;
    int64_t every;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, params, file, "", "heights of the ground: ESRI ASCII grid (.asc), or STL (.stl)",
             .flags = TL_PARAM_REQUIRED | TL_PARAM_FILE),
    TL_PARAM(TL_PARAM_REAL, params, scale, "", "factor on coordinates and heights: 0.001 for millimetres", .def = {1},
             .flags = TL_PARAM_MIN_OPEN, .min = 0, .max = INFINITY),
    TL_PARAM(TL_PARAM_VEC3, params, translate, "m", "added to the scaled coordinates", .def = {0, 0, 0}),
    TL_PARAM(TL_PARAM_STRING, params, group, "", "group of what lies above the ground", .def_text = "air"),
    TL_PARAM(TL_PARAM_INT, params, every, "", "takes every n-th row and column of a grid, and the last", .def = {1},
             .min = 1, .max = MOST_LINES),
};

/* What part of a piece lies in the prism of a triangle. */
enum { IS_BELOW = 1, IS_ABOVE = 2 };

/* A triangle over the piece at hand. */
typedef struct over {
    uint32_t facet;
    int parts; /* IS_BELOW, IS_ABOVE or both */
    polygon in_plan;
    double z[MOST_CORNERS]; /* height at each corner */
    double low, high;       /* of these */
} over;

/* A piece to be looked at, with its triangles from `start` on in `list`. */
typedef struct job {
    size_t index, start, count;
} job;

/* A part above, and the body that its block was of. */
typedef struct part {
    uint32_t body;
    size_t index;
} part;

typedef struct carving {
    const tl_host *host;
    surface *ground;
    uint32_t body;     /* of the block at hand */
    uint32_t *scratch; /* [triangles] */
    uint32_t *list;
    size_t list_count, list_capacity;
    job *jobs;
    size_t job_count, job_capacity;
    over *over;
    size_t over_capacity;
    part *above;
    size_t above_count, above_capacity;
    uint32_t *below; /* bodies with a part below */
    size_t below_count, below_capacity;
    size_t blocks_cut, parts_below;
} carving;

static tl_status fail_memory(const carving *c)
{
    return c->host->fail(c->host, TL_E_MEMORY, "out of memory");
}

/* ---------------------------------------------------------------- jobs ------------------- */

static tl_status push_job(carving *c, size_t index, const uint32_t *list, size_t count)
{
    uint32_t *all = (uint32_t *)tl_grown(c->list, &c->list_capacity, c->list_count + count, sizeof *all);
    if (!all)
        return fail_memory(c);
    c->list = all;
    job *jobs = (job *)tl_grown(c->jobs, &c->job_capacity, c->job_count + 1, sizeof *jobs);
    if (!jobs)
        return fail_memory(c);
    c->jobs = jobs;
    memcpy(all + c->list_count, list, count * sizeof *all);
    jobs[c->job_count++] = (job){index, c->list_count, count};
    c->list_count += count;
    return TL_OK;
}

static tl_status label(carving *c, size_t index, bool above)
{
    if (above) {
        part *all = (part *)tl_grown(c->above, &c->above_capacity, c->above_count + 1, sizeof *all);
        if (!all)
            return fail_memory(c);
        c->above = all;
        all[c->above_count++] = (part){c->body, index};
        return TL_OK;
    }
    c->parts_below++;
    if (c->below_count && c->below[c->below_count - 1] == c->body)
        return TL_OK;
    uint32_t *all = (uint32_t *)tl_grown(c->below, &c->below_capacity, c->below_count + 1, sizeof *all);
    if (!all)
        return fail_memory(c);
    c->below = all;
    all[c->below_count++] = c->body;
    return TL_OK;
}

/* ---------------------------------------------------------------- pieces ----------------- */

static double size_of(const tl_bounds *box)
{
    return tl_v3_norm(tl_v3_sub(box->max, box->min));
}

/* Heights that differ by less, m, are the same: roundings of the coordinates of the file. */
static double near_of(const tl_bounds *box)
{
    const double reach = fmax(tl_v3_norm(box->min), tl_v3_norm(box->max));
    return fmax(ROUNDINGS * size_of(box), 16 * DBL_EPSILON * reach);
}

/* Clips a triangle to the box of a piece; false where they have no area in common. */
static bool lay_over(const surface *ground, uint32_t number, const tl_bounds *box, over *o)
{
    const facet *f = &ground->at[number];
    *o = (over){.facet = number, .in_plan = facet_in_box(f, box), .low = INFINITY, .high = -INFINITY};
    for (uint32_t k = 0; k < o->in_plan.count; k++) {
        o->z[k] = facet_height(f, o->in_plan.at[k]);
        o->low = fmin(o->low, o->z[k]);
        o->high = fmax(o->high, o->z[k]);
    }
    return o->in_plan.count > 0;
}

/* The vertical half space inside of side k of a triangle. */
static tl_half_space side_of(const facet *f, int k)
{
    const tl_vec3 a = f->corner[k], b = f->corner[(k + 1) % 3];
    return (tl_half_space){tl_v3_unit(tl_v3(b.y - a.y, a.x - b.x, 0)), a};
}

/* Which parts of a piece lie in the prism of a triangle. */
static tl_status find_parts(const carving *c, size_t index, const tl_bounds *box, over *o)
{
    const facet *f = &c->ground->at[o->facet];
    tl_half_space space[4] = {side_of(f, 0), side_of(f, 1), side_of(f, 2), {f->normal, f->corner[0]}};
    const bool only_below = box->max.z <= o->low, only_above = box->min.z >= o->high;
    bool meets = false;
    tl_status status = TL_OK;
    if (only_below || only_above) {
        status = c->host->meets(c->host, index, space, 3, &meets);
        o->parts = !meets ? 0 : only_below ? IS_BELOW : IS_ABOVE;
        return status;
    }
    status = c->host->meets(c->host, index, space, 4, &meets);
    o->parts = meets ? IS_BELOW : 0;
    space[3].normal = tl_v3_neg(f->normal);
    if (status == TL_OK)
        status = c->host->meets(c->host, index, space, 4, &meets);
    o->parts |= meets ? IS_ABOVE : 0;
    return status;
}

/* Lists the triangles over a piece in c->over, and *count of them. *parts tells what parts it has in all. */
static tl_status lay_all(carving *c, const job *j, const tl_bounds *box, size_t *count, int *parts)
{
    over *all = (over *)tl_grown(c->over, &c->over_capacity, j->count + 1, sizeof *all);
    if (!all)
        return fail_memory(c);
    c->over = all;
    size_t laid = 0;
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < j->count; i++)
        if (lay_over(c->ground, c->list[j->start + i], box, &all[laid])) {
            low = fmin(low, all[laid].low);
            high = fmax(high, all[laid].high);
            laid++;
        }
    *count = laid;
    *parts = box->max.z <= low ? IS_BELOW : box->min.z >= high ? IS_ABOVE : 0;
    if (*parts)
        return TL_OK;
    tl_status status = TL_OK;
    *count = 0;
    for (size_t i = 0; i < laid && status == TL_OK; i++) {
        status = find_parts(c, j->index, box, &all[i]);
        *parts |= all[i].parts;
        if (all[i].parts)
            all[(*count)++] = all[i];
    }
    return status;
}

/* Whether the planes of all triangles that have a part above bound the ground of a piece up to the height `top`. Where
 * a triangle i has a part below, z_i <= z_j for each such plane j; or i has no part above and top <= z_j. Each plane
 * that is not that of others removes enough to be cut. */
static bool bulges(const carving *c, size_t count, double top, double near, double enough)
{
    for (size_t i = 0; i < count; i++) {
        const over *o = &c->over[i];
        double removed = INFINITY; /* by the plane of i, at the middle of the triangle's corners */
        for (size_t j = 0; j < count && (o->parts & IS_BELOW); j++) {
            if (j == i || !(c->over[j].parts & IS_ABOVE))
                continue;
            const facet *f = &c->ground->at[c->over[j].facet];
            double sum = 0, widest = 0, least = 0, lowest = INFINITY;
            for (uint32_t k = 0; k < o->in_plan.count; k++) {
                const double z = facet_height(f, o->in_plan.at[k]), gap = z - o->z[k];
                sum += gap;
                widest = fmax(widest, gap);
                least = fmin(least, gap);
                lowest = fmin(lowest, z);
            }
            if (least < -near && !(o->parts == IS_BELOW && lowest >= top))
                return false;
            if (widest > near)
                removed = fmin(removed, sum / o->in_plan.count);
        }
        if (o->parts == (IS_BELOW | IS_ABOVE) && removed < enough)
            return false;
    }
    return true;
}

/* Cuts a piece by the planes of all triangles that have a part above. */
static tl_status cut_bulge(carving *c, size_t index, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!(c->over[i].parts & IS_ABOVE))
            continue;
        const facet *f = &c->ground->at[c->over[i].facet];
        size_t above;
        tl_status status = c->host->cut_block(c->host, index, f->normal, f->corner[0], &above);
        if (status == TL_OK && above != SIZE_MAX)
            status = label(c, above, true);
        if (status != TL_OK)
            return status;
        tl_block_info info = {.size = sizeof info};
        if (above == SIZE_MAX) {
            c->host->block_info(c->host, index, &info);
            if (tl_v3_dot(f->normal, tl_v3_sub(info.centroid, f->corner[0])) > 0)
                return label(c, index, true);
        }
    }
    return label(c, index, false);
}

/* How far a polygon reaches to both sides of the line of a side. */
static void reach_of(const over *o, const tl_half_space *side, double *least, double *most)
{
    *least = INFINITY;
    *most = -INFINITY;
    for (uint32_t k = 0; k < o->in_plan.count; k++) {
        const double d = side->normal.x * (o->in_plan.at[k].x - side->point.x) +
                         side->normal.y * (o->in_plan.at[k].y - side->point.y);
        *least = fmin(*least, d);
        *most = fmax(*most, d);
    }
}

/* Finds the side with the fewest triangles on each side of its line; false without one that divides them. */
static bool find_side(const carving *c, size_t count, double near, tl_half_space *best)
{
    const size_t step = count / MOST_TRIED + 1;
    size_t least_score = SIZE_MAX;
    for (size_t i = 0; i < count; i += step)
        for (int k = 0; k < 3; k++) {
            const tl_half_space side = side_of(&c->ground->at[c->over[i].facet], k);
            size_t in = 0, out = 0;
            for (size_t j = 0; j < count; j++) {
                double least, most;
                reach_of(&c->over[j], &side, &least, &most);
                in += least < -near;
                out += most > near;
            }
            const size_t score = (in > out ? in : out) + (in + out - count); /* those on both sides count twice */
            if (in < count && out < count && in > 0 && out > 0 && score < least_score) {
                least_score = score;
                *best = side;
            }
        }
    return least_score != SIZE_MAX;
}

/* Hands the triangles on one side of a vertical plane to a piece. */
static tl_status push_side(carving *c, size_t index, size_t count, const tl_half_space *side, bool inside, double near)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        double least, most;
        reach_of(&c->over[i], side, &least, &most);
        if (inside ? least < -near : most > near)
            c->scratch[kept++] = c->over[i].facet;
    }
    return push_job(c, index, c->scratch, kept);
}

/* Cuts a piece by a vertical plane into two that are looked at later. */
static tl_status cut_upright(carving *c, size_t index, size_t count, const tl_half_space *side, double near)
{
    size_t outside;
    bool inside = true;
    tl_status status = c->host->cut_block(c->host, index, side->normal, side->point, &outside);
    if (status == TL_OK && outside == SIZE_MAX) {
        tl_block_info info = {.size = sizeof info};
        c->host->block_info(c->host, index, &info);
        inside = tl_v3_dot(side->normal, tl_v3_sub(info.centroid, side->point)) < 0;
    } else if (status == TL_OK) {
        status = push_side(c, outside, count, side, false, near);
    }
    return status == TL_OK ? push_side(c, index, count, side, inside, near) : status;
}

/* The triangle with the largest area over the piece comes first. */
static void bring_largest(carving *c, size_t count)
{
    size_t largest = 0;
    for (size_t i = 1; i < count; i++)
        if (polygon_area(&c->over[i].in_plan) > polygon_area(&c->over[largest].in_plan))
            largest = i;
    c->over[0] = c->over[largest];
}

/* Looks at a piece: it is below or above, or it is cut. */
static tl_status work_off(carving *c, job j)
{
    tl_block_info info = {.size = sizeof info};
    c->host->block_info(c->host, j.index, &info);
    size_t count = 0;
    int parts = 0;
    tl_status status = lay_all(c, &j, &info.bounds, &count, &parts);
    c->list_count = j.start;
    if (status != TL_OK)
        return status;
    if (parts == IS_BELOW || parts == IS_ABOVE)
        return label(c, j.index, parts == IS_ABOVE);
    const double near = near_of(&info.bounds);
    if (bulges(c, count, info.bounds.max.z, near, REMOVED * size_of(&info.bounds)))
        return cut_bulge(c, j.index, count);
    tl_half_space side;
    if (find_side(c, count, near, &side))
        return cut_upright(c, j.index, count, &side, near);
    bring_largest(c, count); /* triangles that share all but roundings of the plan */
    return cut_bulge(c, j.index, 1);
}

/* ---------------------------------------------------------------- blocks ----------------- */

/* Refuses triangles that are too narrow for cuts of a block. */
static tl_status check_width(const carving *c, const tl_bounds *box, const uint32_t *list, size_t count)
{
    const surface *s = c->ground;
    const double needed = THIN * size_of(box);
    for (size_t i = 0; i < count; i++) {
        const facet *f = &s->at[list[i]];
        const double width = facet_width(f);
        if (width >= needed)
            continue;
        if (f->row)
            return c->host->fail(c->host, TL_E_GEOMETRY,
                                 "file '%.200s', row %u, column %u: the triangle is %g m wide in the plan, less than "
                                 "%g of the size %g m of the block at {%g, %g, %g}; set every = %.0f",
                                 s->file, f->row, f->line, width, THIN, size_of(box), box->min.x, box->min.y,
                                 box->min.z, ceil((double)s->every * needed / width));
        return c->host->fail(c->host, TL_E_GEOMETRY,
                             "file '%.200s', triangle %u: it is %g m wide in the plan, less than %g of the size %g m "
                             "of the block at {%g, %g, %g}; make a surface of larger triangles",
                             s->file, f->line, width, THIN, size_of(box), box->min.x, box->min.y, box->min.z);
    }
    return TL_OK;
}

static tl_status carve(carving *c, size_t block)
{
    tl_block_info info = {.size = sizeof info};
    c->host->block_info(c->host, block, &info);
    c->body = info.body;
    const size_t count = surface_list(c->ground, &info.bounds, c->scratch), blocks = c->host->block_count(c->host);
    tl_status status = surface_covers(c->ground, &info.bounds, c->scratch, count);
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        over o;
        lay_over(c->ground, c->scratch[i], &info.bounds, &o);
        low = fmin(low, o.low);
        high = fmax(high, o.high);
    }
    if (status == TL_OK && info.bounds.max.z > low && info.bounds.min.z < high)
        status = check_width(c, &info.bounds, c->scratch, count);
    if (status == TL_OK)
        status = push_job(c, block, c->scratch, count);
    while (status == TL_OK && c->job_count > 0)
        status = work_off(c, c->jobs[--c->job_count]);
    c->blocks_cut += c->host->block_count(c->host) > blocks;
    return status;
}

static int by_body(const void *left, const void *right)
{
    const part *a = (const part *)left, *b = (const part *)right;
    if (a->body != b->body)
        return a->body < b->body ? -1 : 1;
    return (a->index > b->index) - (a->index < b->index);
}

static int by_number(const void *left, const void *right)
{
    const uint32_t a = *(const uint32_t *)left, b = *(const uint32_t *)right;
    return (a > b) - (a < b);
}

/* Gives parts above their group, and takes them out of bodies that have parts below. */
static tl_status set_free(carving *c, const char *group)
{
    const tl_host *host = c->host;
    size_t *index = (size_t *)malloc((c->above_count + 1) * sizeof *index);
    tl_status status = index ? TL_OK : fail_memory(c);
    if (c->above_count)
        qsort(c->above, c->above_count, sizeof *c->above, by_body);
    if (c->below_count)
        qsort(c->below, c->below_count, sizeof *c->below, by_number);
    for (size_t from = 0, to; from < c->above_count && status == TL_OK; from = to) {
        const uint32_t body = c->above[from].body;
        for (to = from; to < c->above_count && c->above[to].body == body && status == TL_OK; to++) {
            index[to - from] = c->above[to].index;
            status = host->set_group(host, c->above[to].index, group);
        }
        if (status == TL_OK && c->below_count && bsearch(&body, c->below, c->below_count, sizeof *c->below, by_number))
            status = host->part(host, index, to - from);
    }
    free(index);
    return status;
}

/* ---------------------------------------------------------------- generate --------------- */

static bool ends_in(const char *file, const char *ending)
{
    const size_t length = strlen(file), last = strlen(ending);
    for (size_t i = 0; i < last; i++) {
        const char letter = length < last ? '\0' : file[length - last + i];
        if ((letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter) != ending[i])
            return false;
    }
    return true;
}

static tl_status read_ground(const tl_host *host, const params *p, const tl_bounds *box, surface *s)
{
    const bool is_stl = ends_in(p->file, ".stl");
    char *bytes = NULL;
    size_t count;
    if (!is_stl && !ends_in(p->file, ".asc"))
        return host->fail(host, TL_E_ARGUMENT,
                          "file '%.200s' ends neither in .asc, an ESRI ASCII grid, nor in .stl, triangles", p->file);
    if (is_stl && p->every > 1)
        return host->fail(host, TL_E_ARGUMENT, "every = %d is for grids: leave it out for '%.200s'", (int)p->every,
                          p->file);
    tl_status status = tl_file_bytes(host, p->file, MOST_BYTES, &bytes, &count);
    if (status == TL_OK && is_stl)
        status = stl_read(s, bytes, count);
    else if (status == TL_OK && memchr(bytes, '\0', count))
        status = host->fail(host, TL_E_ARGUMENT, "file '%.200s' holds a zero byte: it is no text", p->file);
    else if (status == TL_OK)
        status = esri_read(host, p->file, bytes, &s->grid);
    free(bytes);
    if (status == TL_OK && s->grid.z)
        status = surface_of_grid(s, box);
    return status == TL_OK ? surface_index(s) : status;
}

static tl_status find_box(const tl_host *host, tl_bounds *box)
{
    const size_t count = host->block_count(host);
    for (size_t i = 0; i < count; i++) {
        tl_block_info info = {.size = sizeof info};
        host->block_info(host, i, &info);
        box->min = i == 0 ? info.bounds.min : tl_v3_min(box->min, info.bounds.min);
        box->max = i == 0 ? info.bounds.max : tl_v3_max(box->max, info.bounds.max);
    }
    return count ? TL_OK : host->fail(host, TL_E_STATE, "there is no visible block: create blocks first");
}

static tl_status tell(const carving *c)
{
    const struct {
        const char *key;
        size_t number;
    } notes[] = {
        {"triangles", c->ground->count}, {"cut", c->blocks_cut}, {"below", c->parts_below}, {"above", c->above_count}};
    tl_status status = TL_OK;
    for (size_t i = 0; i < sizeof notes / sizeof *notes && status == TL_OK; i++)
        status = c->host->note(c->host, NULL, notes[i].key, (double)notes[i].number, NULL);
    return status;
}

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = (const params *)given;
    tl_bounds box = {{0, 0, 0}, {0, 0, 0}};
    surface ground = {
        .host = host, .file = p->file, .scale = p->scale, .translate = p->translate, .every = (uint32_t)p->every};
    carving c = {.host = host, .ground = &ground};
    tl_status status = find_box(host, &box);
    if (status == TL_OK)
        status = read_ground(host, p, &box, &ground);
    c.scratch = (uint32_t *)malloc((ground.count + 1) * sizeof *c.scratch);
    if (status == TL_OK && !c.scratch)
        status = fail_memory(&c);
    const size_t blocks = host->block_count(host);
    for (size_t i = 0; i < blocks && status == TL_OK; i++) {
        status = carve(&c, i);
        if (status == TL_OK)
            status = host->progress(host, (double)(i + 1) / (double)blocks);
    }
    if (status == TL_OK)
        status = set_free(&c, p->group);
    if (status == TL_OK)
        status = tell(&c);
    surface_free(&ground);
    free(c.scratch);
    free(c.list);
    free(c.jobs);
    free(c.over);
    free(c.above);
    free(c.below);
    return status;
}

static const tl_kind kind = TL_GENERATOR_KIND(
    generate, .name = "terrain", .doc = "Divides the visible blocks by the ground, a grid or triangles of a file.",
    TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(11, kind, .id = "talus.terrain", .version = TALUS_VERSION, .doc = "Terrain generator.",
                .licence = "BSD-3-Clause");
