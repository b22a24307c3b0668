/* body_zones.c - the zones of a body on their way into the tables: those of all its blocks.
 *
 * The faces of joined blocks are given in parts that agree (joined_faces.c). So both sides of what two blocks have in
 * common get the same points, to the bit, and the same triangles: points in one place become one gridpoint, and the
 * blocks hang together as one solid does. A block that does not end at the edges of parts asks for more corners on
 * them. Then all are divided anew. At last each triangle between two blocks must have its like on the other side. */
#include "zone/body_zones.h"

#include "base/random.h"
#include "geometry/joined_faces.h"
#include "geometry/measure.h"
#include "zone/block_zones.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Limit: how often the blocks of a body are divided for corners that were asked for. Each time halves an edge. */
#define MOST_ROUNDS 12

/* Tolerance: a triangle nearer than this times its size to a block lies on it. */
#define ON_ANOTHER 1e-6

#define NONE UINT32_MAX

/* The blocks of one body while they are divided. */
typedef struct joining {
    tl_model *m;
    const uint32_t *rows; /* of the blocks */
    size_t count;
    const tl_shape_zoning *zoning;
    const tl_corner_keys *keys;
    tl_zone_scratch *scratch;
    const tl_poly **shape;
    tl_id *id;
    tl_joined_faces splits;
    uint64_t *place_key; /* of each place */
    size_t place_key_room;
    tl_vec3 *more; /* places that were asked for */
    size_t more_count, more_room;
    tl_block_zones *made;
    uint32_t **number; /* of each block: its points' numbers in the body */
} joining;

/* ---------------------------------------------------------------- dividing --------------- */

/* Keys of places: those of the first corners there, and for other places ones that no corner has. */
static bool find_keys(joining *j)
{
    const uint32_t places = j->splits.place_count;
    const uint64_t all = j->keys->start[j->m->blocks.table.rows];
    if (!tl_grow(&j->place_key, &j->place_key_room, places, sizeof *j->place_key))
        return false;
    for (uint32_t k = 0; k < places; k++)
        j->place_key[k] = all + k;
    for (size_t b = 0; b < j->count; b++)
        for (uint32_t v = 0; v < j->splits.block[b].how.corner_count; v++) {
            uint64_t *key = &j->place_key[j->splits.block[b].place[v]];
            if (*key >= all)
                *key = j->keys->of[j->keys->start[j->rows[b]] + v];
        }
    return true;
}

static bool ask_for_more(joining *j)
{
    size_t count;
    const tl_vec3 *at = tl_zoning_crossed(j->scratch, &count);
    if (!tl_grow(&j->more, &j->more_room, j->more_count + count, sizeof *j->more))
        return false;
    for (size_t k = 0; k < count; k++)
        j->more[j->more_count++] = at[k];
    return true;
}

/* Divides one block; `again`: it asks for more corners. */
static tl_status divide_block(joining *j, size_t b, bool *again)
{
    tl_model *m = j->m;
    const tl_joined_block *of = &j->splits.block[b];
    tl_shape_zoning zoning = *j->zoning;
    uint64_t *key = malloc((of->poly->vertex_count + 1) * sizeof *key);
    if (!key)
        return tl_fail_memory(&m->error);
    for (uint32_t v = 0; v < of->poly->vertex_count; v++)
        key[v] = j->place_key[of->place[v]];
    zoning.corner_key = key;
    zoning.parts = &of->how;
    tl_status status = tl_block_zones_make(&j->made[b], j->id[b], of->poly, &zoning, of->inside, j->scratch, &m->error);
    size_t crossed;
    tl_zoning_crossed(j->scratch, &crossed);
    if (status == TL_E_GEOMETRY && crossed > 0) {
        *again = true;
        m->error.status = TL_OK;
        status = ask_for_more(j) ? TL_OK : tl_fail_memory(&m->error);
    }
    free(key);
    return status;
}

static void forget_blocks(joining *j)
{
    for (size_t b = 0; j->made && b < j->count; b++)
        tl_block_zones_free(&j->made[b]);
    tl_joined_faces_free(&j->splits);
}

/* Divides all blocks; `again`: some ask for more corners. */
static tl_status divide_blocks(joining *j, bool *again)
{
    tl_model *m = j->m;
    *again = false;
    tl_status status = tl_joined_faces_make(j->shape, j->id, j->count, j->more, j->more_count, &j->splits, &m->error);
    if (status == TL_OK && !find_keys(j))
        status = tl_fail_memory(&m->error);
    for (size_t b = 0; status == TL_OK && b < j->count; b++) {
        status = tl_model_go_on(m);
        if (status == TL_OK)
            status = divide_block(j, b, again);
    }
    return status;
}

static tl_status divide_until_whole(joining *j)
{
    bool again = true;
    tl_status status = TL_OK;
    for (int round = 0; status == TL_OK && again && round < MOST_ROUNDS; round++) {
        forget_blocks(j);
        status = divide_blocks(j, &again);
    }
    if (status == TL_OK && again)
        return tl_fail(
            &j->m->error, TL_E_GEOMETRY,
            "the zones of block %u and those of the blocks that it is joined to do not end at each other's edges: "
            "choose another edge of zones",
            j->id[0]);
    return status;
}

/* ---------------------------------------------------------------- one mesh --------------- */

/* Points by their places, to the bit: buckets of a table that is less than half full. */
typedef struct same_places {
    uint32_t *number; /* [mask + 1] */
    size_t mask;
} same_places;

static size_t bucket_of(const same_places *t, tl_vec3 x)
{
    const double coordinate[3] = {x.x + 0.0, x.y + 0.0, x.z + 0.0}; /* there is one zero */
    uint64_t word[3];
    memcpy(word, coordinate, sizeof word);
    return (size_t)tl_key(tl_key(tl_mix64(word[0]), word[1]), word[2]) & t->mask;
}

/* The number of a surface point: that of one in the same place, or the next. */
static uint32_t number_at(same_places *t, tl_vec3 x, tl_body_zones *to)
{
    size_t bucket = bucket_of(t, x);
    while (t->number[bucket] != NONE && !tl_v3_is_zero(tl_v3_sub(to->point[t->number[bucket]], x)))
        bucket = (bucket + 1) & t->mask;
    if (t->number[bucket] == NONE) {
        t->number[bucket] = to->point_count;
        to->point[to->point_count++] = x;
    }
    return t->number[bucket];
}

/* Numbers the points of all blocks. */
static bool number_points(joining *j, tl_body_zones *to)
{
    same_places t = {NULL, 15};
    size_t all = 0;
    for (size_t b = 0; b < j->count; b++)
        all += j->made[b].mesh.point_count;
    while (t.mask < 2 * all)
        t.mask = 2 * t.mask + 1;
    t.number = malloc((t.mask + 1) * sizeof *t.number);
    to->point = malloc((all + 1) * sizeof *to->point);
    bool enough = t.number && to->point;
    if (enough)
        memset(t.number, 0xff, (t.mask + 1) * sizeof *t.number);
    for (size_t b = 0; enough && b < j->count; b++) {
        const tl_zone_mesh *mesh = &j->made[b].mesh;
        j->number[b] = malloc((mesh->point_count + 1) * sizeof **j->number);
        enough = j->number[b] != NULL;
        for (uint32_t p = 0; enough && p < mesh->point_count; p++) {
            if (p < mesh->face_end) {
                j->number[b][p] = number_at(&t, mesh->point[p], to);
            } else {
                j->number[b][p] = to->point_count;
                to->point[to->point_count++] = mesh->point[p];
            }
        }
    }
    free(t.number);
    return enough;
}

static bool make_lists(const joining *j, tl_body_zones *to)
{
    size_t zones = 0, clusters = 0, parts = 0;
    for (size_t b = 0; b < j->count; b++) {
        zones += j->made[b].mesh.zone_count;
        clusters += j->made[b].clusters.count;
        parts += j->made[b].surface_count;
    }
    to->zone = malloc((zones + 1) * sizeof *to->zone);
    to->cluster_zone = malloc((zones + 1) * sizeof *to->cluster_zone);
    to->cluster_start = malloc((clusters + 1) * sizeof *to->cluster_start);
    to->surface = malloc((parts + 1) * sizeof *to->surface);
    to->block = malloc((j->count + 1) * sizeof *to->block);
    return to->zone && to->cluster_zone && to->cluster_start && to->surface && to->block;
}

static void add_block(const joining *j, size_t b, tl_body_zones *to)
{
    const tl_block_zones *from = &j->made[b];
    const uint32_t *number = j->number[b], zones = to->zone_count;
    for (uint32_t z = 0; z < from->mesh.zone_count; z++)
        for (int a = 0; a < 4; a++)
            to->zone[zones + z][a] = number[from->mesh.zone[z][a]];
    for (uint32_t k = 0; k < from->mesh.zone_count; k++)
        to->cluster_zone[zones + k] = zones + from->clusters.zone[k];
    for (uint32_t c = 0; c < from->clusters.count; c++)
        to->cluster_start[to->cluster_count++] = zones + from->clusters.start[c];
    to->zone_count += from->mesh.zone_count;
    to->cluster_start[to->cluster_count] = to->zone_count;
    for (uint32_t k = 0; k < from->surface_count; k++) {
        tl_surface_part *part = &to->surface[to->surface_count++];
        *part = from->surface[k];
        for (int a = 0; a < 3; a++)
            part->corner[a] = number[part->corner[a]];
        part->apex = number[part->apex];
    }
    to->block[to->block_count++] =
        (tl_grid_block){from->block, j->m->blocks.density[j->rows[b]], to->zone_count, to->cluster_count};
    to->least_altitude = fmin(to->least_altitude, from->mesh.least_altitude);
    if (from->mesh.least_share < to->least_share) {
        to->least_share = from->mesh.least_share;
        to->worst = from->block;
    }
}

/* ---------------------------------------------------------------- check ------------------ */

/* A triangle between two blocks: its gridpoints, ascending. */
typedef struct between {
    uint32_t point[3];
    tl_id block;
} between;

static int compare_triangles(const void *x, const void *y)
{
    const between *a = x, *b = y;
    for (int k = 0; k < 3; k++)
        if (a->point[k] != b->point[k])
            return a->point[k] < b->point[k] ? -1 : 1;
    return (a->block > b->block) - (a->block < b->block);
}

static between sorted(const uint32_t *number, const uint32_t corner[3], tl_id block)
{
    between t = {{number[corner[0]], number[corner[1]], number[corner[2]]}, block};
    for (int k = 0; k < 3; k++) {
        const int low = k < 2 ? k : 0;
        if (t.point[low] > t.point[low + 1]) {
            const uint32_t swap = t.point[low];
            t.point[low] = t.point[low + 1];
            t.point[low + 1] = swap;
        }
    }
    return t;
}

static tl_status refuse_between(tl_model *m, tl_id block)
{
    return tl_fail(&m->error, TL_E_GEOMETRY,
                   "block %u: its zones do not fit those of the blocks that it is joined to: their faces are not flat, "
                   "or their triangles are not the same",
                   block);
}

/* The triangles of all blocks by their corners, or those on faces between blocks only, sorted. They are to be freed.
 * NULL: out of memory. */
static between *list_triangles(const joining *j, bool all, size_t *count)
{
    size_t most = 0;
    for (size_t b = 0; b < j->count; b++)
        most += j->made[b].mesh.triangle_count;
    between *list = malloc((most + 1) * sizeof *list);
    *count = 0;
    for (size_t b = 0; b < j->count && list; b++)
        for (uint32_t t = 0; t < j->made[b].mesh.triangle_count; t++) {
            const tl_zone_triangle *of = &j->made[b].mesh.triangle[t];
            if (all || j->splits.block[b].inside[of->face])
                list[(*count)++] = sorted(j->number[b], of->corner, j->id[b]);
        }
    if (list && *count > 0)
        qsort(list, *count, sizeof *list, compare_triangles);
    return list;
}

/* Whether each triangle between two blocks is one of both. */
static tl_status check_between(const joining *j)
{
    size_t count, bad = 0;
    between *list = list_triangles(j, false, &count);
    if (!list)
        return tl_fail_memory(&j->m->error);
    while (bad < count && bad + 1 < count && memcmp(list[bad].point, list[bad + 1].point, sizeof list->point) == 0)
        bad += 2;
    const tl_id block = bad < count ? list[bad].block : 0;
    free(list);
    return bad == count ? TL_OK : refuse_between(j->m, block);
}

/* ---------------------------------------------------------------- meshes of files -------- */

static bool is_of_both(const between *list, size_t count, const between *wanted)
{
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare_triangles(&list[middle], wanted) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    const size_t size = sizeof wanted->point;
    return (low > 0 && memcmp(list[low - 1].point, wanted->point, size) == 0) ||
           (low + 1 < count && memcmp(list[low + 1].point, wanted->point, size) == 0);
}

/* Whether the middle of a triangle lies on another block of the body. */
static bool lies_on_another(const joining *j, size_t block, const tl_zone_triangle *t)
{
    const tl_vec3 *x = j->made[block].mesh.point;
    const tl_vec3 sum = tl_v3_add(tl_v3_add(x[t->corner[0]], x[t->corner[1]]), x[t->corner[2]]);
    for (size_t b = 0; b < j->count; b++)
        if (b != block && tl_poly_contains(j->shape[b], tl_v3_scale(1.0 / 3, sum), ON_ANOTHER * j->shape[b]->size))
            return true;
    return false;
}

/* Marks those triangles of a block that are another's as well. */
static tl_status mark_between(const joining *j, size_t block, const between *list, size_t count)
{
    tl_zone_mesh *mesh = &j->made[block].mesh;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const between wanted = sorted(j->number[block], mesh->triangle[t].corner, j->id[block]);
        if (is_of_both(list, count, &wanted))
            mesh->triangle[t].face = TL_ZONE_BETWEEN;
        else if (lies_on_another(j, block, &mesh->triangle[t]))
            return refuse_between(j->m, j->id[block]);
    }
    return TL_OK;
}

/* Takes the triangles between two blocks out of the surface. */
static tl_status open_between(const joining *j)
{
    size_t count;
    between *list = list_triangles(j, true, &count);
    if (!list)
        return tl_fail_memory(&j->m->error);
    tl_status status = TL_OK;
    for (size_t b = 0; status == TL_OK && b < j->count; b++)
        status = mark_between(j, b, list, count);
    free(list);
    return status;
}

/* ---------------------------------------------------------------- all -------------------- */

static tl_status list_blocks(joining *j)
{
    tl_model *m = j->m;
    j->shape = malloc((j->count + 1) * sizeof *j->shape);
    j->id = malloc((j->count + 1) * sizeof *j->id);
    j->made = calloc(j->count + 1, sizeof *j->made);
    j->number = calloc(j->count + 1, sizeof *j->number);
    if (!j->shape || !j->id || !j->made || !j->number)
        return tl_fail_memory(&m->error);
    for (size_t b = 0; b < j->count; b++) {
        j->shape[b] = m->blocks.shape[j->rows[b]];
        j->id[b] = m->blocks.id[j->rows[b]];
    }
    return TL_OK;
}

/* The blocks have zones: numbers their points, and puts all together. `given`: surfaces are still to be listed. */
static tl_status join_blocks(joining *j, bool given, tl_body_zones *to)
{
    tl_model *m = j->m;
    tl_status status = number_points(j, to) ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = given ? open_between(j) : check_between(j);
    for (size_t b = 0; given && status == TL_OK && b < j->count; b++)
        status = tl_block_zones_surface(&j->made[b], &m->error);
    if (status == TL_OK && !make_lists(j, to))
        status = tl_fail_memory(&m->error);
    for (size_t b = 0; status == TL_OK && b < j->count; b++)
        add_block(j, b, to);
    return status;
}

static void forget(joining *j)
{
    forget_blocks(j);
    for (size_t b = 0; j->number && b < j->count; b++)
        free(j->number[b]);
    free(j->number);
    free(j->made);
    free(j->id);
    free(j->shape);
    free(j->place_key);
    free(j->more);
}

static tl_status divide_joined(joining *j, tl_body_zones *to)
{
    tl_status status = list_blocks(j);
    if (status == TL_OK)
        status = divide_until_whole(j);
    if (status == TL_OK)
        status = join_blocks(j, false, to);
    forget(j);
    return status;
}

/* Divides a block that is a body by itself. */
static tl_status divide_alone(const joining *j, tl_body_zones *to)
{
    tl_model *m = j->m;
    const uint32_t row = j->rows[0];
    tl_shape_zoning zoning = *j->zoning;
    tl_block_zones made;
    zoning.corner_key = j->keys->of + j->keys->start[row];
    to->block = malloc(sizeof *to->block);
    if (!to->block)
        return tl_fail_memory(&m->error);
    const tl_status status =
        tl_block_zones_make(&made, m->blocks.id[row], m->blocks.shape[row], &zoning, NULL, j->scratch, &m->error);
    if (status == TL_OK) {
        *to = (tl_body_zones){.point = made.mesh.point,
                              .point_count = made.mesh.point_count,
                              .zone = made.mesh.zone,
                              .zone_count = made.mesh.zone_count,
                              .cluster_start = made.clusters.start,
                              .cluster_zone = made.clusters.zone,
                              .cluster_count = made.clusters.count,
                              .surface = made.surface,
                              .surface_count = made.surface_count,
                              .block = to->block,
                              .block_count = 1,
                              .least_altitude = made.mesh.least_altitude,
                              .least_share = made.mesh.least_share,
                              .worst = made.block};
        to->block[0] = (tl_grid_block){made.block, m->blocks.density[row], to->zone_count, to->cluster_count};
        made.mesh.point = NULL;
        made.mesh.zone = NULL;
        made.clusters = (tl_zone_clusters){0};
        made.surface = NULL;
    }
    tl_block_zones_free(&made);
    return status;
}

tl_status tl_body_zones_make(tl_model *m, uint32_t body, const tl_shape_zoning *zoning, const tl_corner_keys *keys,
                             tl_zone_scratch *scratch, tl_body_zones *zones)
{
    joining j = {.m = m,
                 .rows = tl_body_blocks(m, body),
                 .count = m->bodies.member_count[body],
                 .zoning = zoning,
                 .keys = keys,
                 .scratch = scratch};
    *zones = (tl_body_zones){.least_altitude = INFINITY, .least_share = INFINITY};
    return j.count > 1 ? divide_joined(&j, zones) : divide_alone(&j, zones);
}

tl_status tl_body_zones_take(tl_model *m, uint32_t body, tl_zone_mesh *mesh, tl_body_zones *to)
{
    joining j = {.m = m, .rows = tl_body_blocks(m, body), .count = m->bodies.member_count[body]};
    *to = (tl_body_zones){.least_altitude = INFINITY, .least_share = INFINITY};
    tl_status status = list_blocks(&j);
    for (size_t b = 0; status == TL_OK && b < j.count; b++)
        status = tl_block_zones_take(&j.made[b], j.id[b], &mesh[j.rows[b]], &m->error);
    if (status == TL_OK)
        status = join_blocks(&j, true, to);
    forget(&j);
    return status;
}

void tl_body_zones_free(tl_body_zones *z)
{
    free(z->point);
    free(z->zone);
    free(z->cluster_start);
    free(z->cluster_zone);
    free(z->surface);
    free(z->block);
    *z = (tl_body_zones){0};
}
