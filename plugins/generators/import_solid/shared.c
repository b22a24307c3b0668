/* shared.c - sides of two solids at one place get one plane, so that their blocks meet flush.
 *
 * Such sides face each other, and their polygons overlap. The corners of one lie within flat + weld of the plane of the
 * other. Sides that hang together so are a group with one plane, if all their corners lie as near to it. Else they keep
 * their own planes: a plane for some of them would tilt them against the others, as in a dome whose stones are in bond.
 * Solids that may touch are found by sweeping along the longest axis. */
#include "solids.h"

#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>

/* Tolerance: normals of sides that face each other differ by less than acos of this from opposite: 18 degrees. */
#define FACING 0.95

typedef struct box {
    tl_vec3 min, max;
} box;

typedef struct pair {
    uint32_t a, b; /* planes */
} pair;

typedef struct finder {
    solids *s;
    double near; /* m: distances that are none */
    box *box;    /* [solids] */
    uint32_t *order;
    uint32_t *owner; /* [planes] solid */
    pair *pair;
    size_t pairs, pair_capacity;
    uint32_t *ring; /* [planes] the next side of the group */
    int axis;
} finder;

static double along(tl_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* The next corner of a side: *face and *h begin with the first face of its solid and that face's first corner. */
static bool next_corner(const finder *f, uint32_t side, uint32_t *face, uint32_t *h, tl_vec3 *at)
{
    const solids *s = f->s;
    const solid *o = &s->solid[f->owner[side]];
    const uint32_t end = solid_faces(s, f->owner[side]);
    while (*face < end && (s->side[*face] != side - o->plane || *h == s->start[*face + 1]))
        *h = s->start[++*face];
    if (*face == end)
        return false;
    *at = s->vertex[o->vertex + s->corner[(*h)++]];
    return true;
}

/* Begins a loop over the corners `at` of a side. */
#define EACH_CORNER(f, side, at)                                                                                       \
    tl_vec3 at;                                                                                                        \
    for (uint32_t face_ = (f)->s->solid[(f)->owner[side]].face, h_ = (f)->s->start[face_];                             \
         next_corner(f, side, &face_, &h_, &at);)

/* ---------------------------------------------------------------- two sides -------------- */

static double farthest_off(const finder *f, uint32_t side, const plane *p)
{
    double off = 0;
    EACH_CORNER(f, side, at)
    off = fmax(off, fabs(plane_above(p, at)));
    return off;
}

static void extent_along(const finder *f, uint32_t side, tl_vec3 axis, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    EACH_CORNER(f, side, at)
    {
        *low = fmin(*low, tl_v3_dot(axis, at));
        *high = fmax(*high, tl_v3_dot(axis, at));
    }
}

/* Whether the edges of side a leave the polygons of a and b without overlap, looking along the plane. */
static bool parted_by(const finder *f, uint32_t a, uint32_t b)
{
    const solids *s = f->s;
    const solid *o = &s->solid[f->owner[a]];
    for (uint32_t face = o->face; face < solid_faces(s, f->owner[a]); face++) {
        if (s->side[face] != a - o->plane)
            continue;
        for (uint32_t h = s->start[face]; h < s->start[face + 1]; h++) {
            uint32_t next = h + 1 < s->start[face + 1] ? h + 1 : s->start[face];
            tl_vec3 edge = tl_v3_sub(s->vertex[o->vertex + s->corner[next]], s->vertex[o->vertex + s->corner[h]]);
            tl_vec3 axis = tl_v3_cross(edge, s->plane[a].normal);
            double length = tl_v3_norm(axis), low_a, high_a, low_b, high_b;
            if (!(length > 0))
                continue;
            axis = tl_v3_scale(1 / length, axis);
            extent_along(f, a, axis, &low_a, &high_a);
            extent_along(f, b, axis, &low_b, &high_b);
            if (fmin(high_a, high_b) - fmax(low_a, low_b) <= f->near)
                return true;
        }
    }
    return false;
}

static bool at_one_place(const finder *f, uint32_t a, uint32_t b)
{
    const plane *p = &f->s->plane[a], *q = &f->s->plane[b];
    return tl_v3_dot(p->normal, q->normal) < -FACING && fmin(farthest_off(f, a, q), farthest_off(f, b, p)) <= f->near &&
           !parted_by(f, a, b) && !parted_by(f, b, a);
}

/* ---------------------------------------------------------------- two solids ------------- */

static bool boxes_meet(const box *a, const box *b, double near)
{
    return a->min.x <= b->max.x + near && b->min.x <= a->max.x + near && a->min.y <= b->max.y + near &&
           b->min.y <= a->max.y + near && a->min.z <= b->max.z + near && b->min.z <= a->max.z + near;
}

/* Whether the plane of a side comes near a box. */
static bool plane_meets(const plane *p, const box *b, double near)
{
    tl_vec3 middle = tl_v3_scale(0.5, tl_v3_add(b->min, b->max)), half = tl_v3_scale(0.5, tl_v3_sub(b->max, b->min));
    double reach = fabs(p->normal.x) * half.x + fabs(p->normal.y) * half.y + fabs(p->normal.z) * half.z;
    return fabs(plane_above(p, middle)) <= reach + near;
}

static tl_status look_at(finder *f, uint32_t i, uint32_t k)
{
    const solids *s = f->s;
    for (uint32_t a = s->solid[i].plane; a < solid_planes(s, i); a++) {
        if (!plane_meets(&s->plane[a], &f->box[k], f->near))
            continue;
        for (uint32_t b = s->solid[k].plane; b < solid_planes(s, k); b++) {
            if (!at_one_place(f, a, b))
                continue;
            pair *list = tl_grown(f->pair, &f->pair_capacity, f->pairs + 1, sizeof *list);
            if (!list)
                return soup_no_memory(&s->soup);
            f->pair = list;
            list[f->pairs++] = (pair){a, b};
        }
    }
    return TL_OK;
}

/* qsort has no argument for it: keys go with the rows. */
typedef struct start {
    double at;
    uint32_t solid;
} start;

static int by_start(const void *left, const void *right)
{
    const start *a = left, *b = right;
    if (a->at < b->at || a->at > b->at)
        return a->at < b->at ? -1 : 1;
    return (a->solid > b->solid) - (a->solid < b->solid);
}

static tl_status sweep(finder *f)
{
    const solids *s = f->s;
    start *list = malloc((s->solids + 1) * sizeof *list);
    size_t open = 0;
    if (!list)
        return soup_no_memory(&s->soup);
    for (uint32_t i = 0; i < s->solids; i++)
        list[i] = (start){along(f->box[i].min, f->axis), i};
    qsort(list, s->solids, sizeof *list, by_start);
    tl_status status = TL_OK;
    for (size_t k = 0; k < s->solids && status == TL_OK; k++) {
        uint32_t now = list[k].solid;
        size_t kept = 0;
        for (size_t j = 0; j < open && status == TL_OK; j++) {
            uint32_t other = f->order[j];
            if (along(f->box[other].max, f->axis) + f->near < list[k].at)
                continue;
            f->order[kept++] = other;
            if (boxes_meet(&f->box[now], &f->box[other], f->near))
                status = look_at(f, other < now ? other : now, other < now ? now : other);
        }
        open = kept;
        f->order[open++] = now;
        if (k % 1024 == 0 && status == TL_OK)
            status = s->host->progress(s->host, 0.5 + 0.2 * (double)k / (double)s->solids);
    }
    free(list);
    return status;
}

/* ---------------------------------------------------------------- groups ----------------- */

static uint32_t root_of(solids *s, uint32_t p)
{
    while (s->plane[p].group != p)
        p = s->plane[p].group = s->plane[s->plane[p].group].group;
    return p;
}

static void join(finder *f, uint32_t a, uint32_t b)
{
    uint32_t next = f->ring[a];
    f->ring[a] = f->ring[b];
    f->ring[b] = next;
    f->s->plane[b > a ? b : a].group = b > a ? a : b;
}

/* The plane fitted to the sides of a group. */
static plane fit_group(const finder *f, uint32_t first)
{
    cloud sum = {.count = 0};
    uint32_t side = first;
    do {
        EACH_CORNER(f, side, at)
        {
            if (!(sum.count > 0))
                sum.zero = at;
            cloud_add(&sum, at);
        }
        side = f->ring[side];
    } while (side != first);
    return cloud_plane(&sum, f->s->plane[first].normal);
}

static bool group_fits(const finder *f, uint32_t first)
{
    const plane fitted = fit_group(f, first);
    uint32_t side = first;
    do {
        if (farthest_off(f, side, &fitted) > f->near)
            return false;
        side = f->ring[side];
    } while (side != first);
    return true;
}

/* Groups of all pairs; those that fit no plane are taken apart. */
static void form_groups(finder *f)
{
    solids *s = f->s;
    for (uint32_t p = 0; p < s->planes; p++)
        f->ring[p] = p;
    for (size_t i = 0; i < f->pairs; i++) {
        uint32_t a = root_of(s, f->pair[i].a), b = root_of(s, f->pair[i].b);
        if (a != b)
            join(f, a, b);
    }
    for (uint32_t p = 0; p < s->planes; p++) {
        if (s->plane[p].group != p || f->ring[p] == p || group_fits(f, p))
            continue;
        for (uint32_t side = p, next; f->ring[side] != side; side = next) {
            next = f->ring[side];
            f->ring[side] = side;
            s->plane[side].group = side;
        }
    }
    for (uint32_t p = 0; p < s->planes; p++) {
        s->plane[p].group = root_of(s, p);
        s->shared += f->ring[p] != p;
        s->solid[f->owner[p]].shared += f->ring[p] != p;
    }
}

static bool begin(finder *f)
{
    solids *s = f->s;
    f->box = malloc((s->solids + 1) * sizeof *f->box);
    f->order = malloc((s->solids + 1) * sizeof *f->order);
    f->owner = malloc((s->planes + 1) * sizeof *f->owner);
    f->ring = malloc((s->planes + 1) * sizeof *f->ring);
    if (!f->box || !f->order || !f->owner || !f->ring)
        return false;
    box all = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t i = 0; i < s->solids; i++) {
        f->box[i] = (box){s->vertex[s->solid[i].vertex], s->vertex[s->solid[i].vertex]};
        for (uint32_t v = s->solid[i].vertex; v < solid_vertices(s, i); v++) {
            f->box[i].min = tl_v3_min(f->box[i].min, s->vertex[v]);
            f->box[i].max = tl_v3_max(f->box[i].max, s->vertex[v]);
        }
        all.min = tl_v3_min(all.min, f->box[i].min);
        all.max = tl_v3_max(all.max, f->box[i].max);
        for (uint32_t p = s->solid[i].plane; p < solid_planes(s, i); p++)
            f->owner[p] = (uint32_t)i;
    }
    tl_vec3 size = tl_v3_sub(all.max, all.min);
    f->axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return true;
}

tl_status shared_find(solids *s)
{
    if (s->solids == 0)
        return TL_OK;
    finder f = {.s = s, .near = s->flat + s->weld};
    tl_status status = begin(&f) ? sweep(&f) : soup_no_memory(&s->soup);
    if (status == TL_OK)
        form_groups(&f);
    free(f.box);
    free(f.order);
    free(f.owner);
    free(f.ring);
    free(f.pair);
    return status;
}
