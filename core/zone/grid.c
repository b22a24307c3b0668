/* grid.c - meshes of bodies, as tables.
 *
 * Clusters of a mesh come in the order in which they lie together. As many of them as a parcel holds make one. In a
 * parcel they are sorted by their numbers of zones, so that groups have few inert rows. Rows of a mesh's gridpoints are
 * padded to whole lanes: those beyond its points are fixed and have no zones. */
#include "zone/grid.h"

#include "geometry/measure.h"
#include "zone/solids.h"

#include <stdlib.h>
#include <string.h>
#include <talus/elementary.h>

/* Constant: mass of a row without a gridpoint, kg: it is divided by. */
#define NO_MASS 1.0

uint32_t tl_mesh_of(const tl_model *m, tl_id body)
{
    const uint32_t row = tl_block_row_quiet(m, body);
    return row == TL_NO_ROW ? TL_NO_ROW : m->bodies.mesh[m->blocks.body[row]] - 1;
}

const tl_surface_part *tl_face_parts(const tl_model *m, tl_id block, uint32_t number, size_t *count)
{
    const struct tl_zones *z = m->zones;
    const uint32_t mesh = tl_mesh_of(m, block);
    *count = 0;
    if (mesh == TL_NO_ROW)
        return NULL;
    const tl_surface_part *at = z->part + z->mesh[mesh].part_begin, *end = z->part + z->mesh[mesh].part_end;
    for (const tl_surface_part *beyond = end; at < beyond;) {
        const tl_surface_part *middle = at + (beyond - at) / 2;
        if (middle->block < block || (middle->block == block && middle->face < number))
            at = middle + 1;
        else
            beyond = middle;
    }
    while (at + *count < end && at[*count].block == block && at[*count].face == number)
        ++*count;
    return at;
}

bool tl_blocks_meet(const tl_model *m, uint32_t a, uint32_t b)
{
    const struct tl_zones *z = m->zones;
    const tl_id x = m->blocks.id[a], y = m->blocks.id[b];
    const uint64_t pair = x < y ? (uint64_t)x << 32 | y : (uint64_t)y << 32 | x;
    size_t low = 0, high = z ? z->meeting_count : 0;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (z->meeting[middle] < pair)
            low = middle + 1;
        else
            high = middle;
    }
    return z && low < z->meeting_count && z->meeting[low] == pair;
}

/* ---------------------------------------------------------------- parcels ---------------- */

/* A mesh on its way into the tables: scratch of `tl_zones_add`. */
typedef struct laying {
    tl_model *m;
    struct tl_zones *z; /* the tables: those of the model, or others */
    const tl_grid *grid;
    uint32_t *local;   /* of each of the mesh's points: its number in the parcel, or TL_NO_ROW */
    uint32_t *sorted;  /* clusters of the parcel, by their sizes */
    uint32_t points;   /* that the parcel has */
    uint32_t first;    /* row of the mesh's first gridpoint */
    uint32_t row;      /* of the body */
    uint32_t solid;    /* of clusters, where the grid does not tell */
    tl_grid_block own; /* that of a body which does not list its blocks */
} laying;

/* The block of a cluster. */
static const tl_grid_block *block_of(const laying *l, uint32_t cluster)
{
    const tl_grid_block *of = l->grid->block ? l->grid->block : &l->own;
    while (of->cluster_end <= cluster)
        of++;
    return of;
}

static size_t size_of(const tl_grid *g, uint32_t cluster)
{
    return g->cluster_start[cluster + 1] - g->cluster_start[cluster];
}

/* Gridpoints of a cluster that are not in the parcel yet. */
static uint32_t new_points(const laying *l, uint32_t cluster, bool add)
{
    const tl_grid *g = l->grid;
    uint32_t found = l->points, all = 0, seen[4 * TL_CLUSTER_MOST];
    for (uint32_t k = g->cluster_start[cluster]; k < g->cluster_start[cluster + 1]; k++)
        for (int a = 0; a < 4; a++) {
            const uint32_t point = g->zone[g->cluster_zone[k]][a];
            bool is_new = l->local[point] == TL_NO_ROW;
            for (uint32_t s = 0; !add && s < all; s++)
                is_new = is_new && seen[s] != point;
            if (!is_new)
                continue;
            if (add)
                l->local[point] = found;
            else
                seen[all++] = point;
            found++;
        }
    return found - l->points;
}

static uint32_t solid_of(const laying *l, uint32_t cluster)
{
    return l->grid->cluster_solid ? l->grid->cluster_solid[cluster] : l->solid;
}

/* How many clusters from `first` on make a parcel: its gridpoints get their numbers. */
static uint32_t gather_clusters(laying *l, uint32_t first)
{
    const tl_grid *g = l->grid;
    const size_t most = block_of(l, first)->cluster_end;
    const uint32_t solid = solid_of(l, first);
    size_t zones = 0;
    uint32_t end = first;
    for (size_t k = 0; k < g->point_count; k++)
        l->local[k] = TL_NO_ROW;
    l->points = 0;
    while (end < most && solid_of(l, end) == solid) {
        const size_t more = size_of(g, end);
        if (zones + more > TL_PARCEL_ZONES * 9 / 10 || l->points + new_points(l, end, false) > TL_PARCEL_POINTS)
            break;
        l->points += new_points(l, end, true);
        zones += more;
        end++;
    }
    return end;
}

/* Sorts clusters by their sizes, the largest first, those of one size as they are. */
static void sort_clusters(laying *l, uint32_t first, uint32_t end)
{
    uint32_t at = 0;
    for (size_t size = TL_CLUSTER_MOST; size > 0; size--)
        for (uint32_t k = first; k < end; k++)
            if (size_of(l->grid, k) == size)
                l->sorted[at++] = k;
}

/* The volume of a zone as made, m3. */
static double volume_of(const tl_grid *g, uint32_t zone)
{
    const uint32_t *c = g->zone[zone];
    return tl_tetrahedron_volume((tl_vec3[4]){g->point[c[0]], g->point[c[1]], g->point[c[2]], g->point[c[3]]});
}

/* Puts zone `number` of the mesh in a row. */
static void put_zone(const laying *l, size_t row, uint32_t zone, bool inert)
{
    tl_zone_table *t = &l->z->zones;
    for (int a = 0; a < 4; a++)
        t->corner[a][row] = (uint16_t)l->local[l->grid->zone[zone][a]];
    t->number[row] = inert ? TL_NO_ROW : zone;
    if (!inert)
        l->z->row_of[l->z->row_of_count + zone] = (uint32_t)row;
}

/* Fills a group, from a row on, with up to TL_LANES clusters of a parcel. */
static void lay_group(const laying *l, const uint32_t *cluster, uint32_t count, size_t *row)
{
    const tl_grid *g = l->grid;
    struct tl_zones *z = l->z;
    tl_zone_group *group = &z->group[z->group_count++];
    *group = (tl_zone_group){.start = (uint32_t)*row, .depth = (uint8_t)size_of(g, cluster[0])};
    *row += (size_t)group->depth * TL_LANES;
    for (uint32_t lane = 0; lane < TL_LANES; lane++) {
        const uint32_t of = cluster[lane < count ? lane : 0], begin = g->cluster_start[of];
        const size_t size = lane < count ? size_of(g, of) : 0;
        double volume = 0;
        for (size_t k = 0; k < group->depth; k++)
            put_zone(l, group->start + TL_LANES * k + lane, g->cluster_zone[begin + (k < size ? k : 0)], k >= size);
        for (size_t k = 0; k < size; k++)
            volume += volume_of(g, g->cluster_zone[begin + k]);
        group->count[lane] = (uint8_t)size;
        group->extent[lane] = size > 0 ? tl_cbrt(volume) : 1;
    }
}

/* Lays a parcel of the clusters from `first` on, its zones from a row on, and says which cluster is the next. */
static uint32_t lay_parcel(laying *l, uint32_t first, uint32_t parcel, size_t *row, uint32_t mesh)
{
    struct tl_zones *z = l->z;
    const uint32_t end = gather_clusters(l, first), count = end - first;
    tl_parcel of = {.mesh = mesh,
                    .solid = solid_of(l, first),
                    .block = block_of(l, first)->block,
                    .group_begin = (uint32_t)z->group_count};
    sort_clusters(l, first, end);
    for (uint32_t k = 0; k < count; k += TL_LANES)
        lay_group(l, l->sorted + k, count - k < TL_LANES ? count - k : TL_LANES, row);
    of.group_end = (uint32_t)z->group_count;
    of.point_begin = (uint32_t)z->listed_count;
    of.point_end = of.point_begin + l->points;
    for (uint32_t p = 0; p < l->grid->point_count; p++)
        if (l->local[p] != TL_NO_ROW)
            z->listed[of.point_begin + l->local[p]] = l->first + p;
    z->listed_count = of.point_end;
    z->parcels.of[parcel] = of;
    return end;
}

/* ---------------------------------------------------------------- gridpoints ------------- */

static void put_points(const laying *l, size_t padded, uint32_t mesh)
{
    const tl_grid *g = l->grid;
    tl_gridpoints *p = &l->z->points;
    for (size_t k = 0; k < padded; k++) {
        const tl_vec3 at = g->point[k < g->point_count ? k : 0];
        p->ref[0][l->first + k] = at.x;
        p->ref[1][l->first + k] = at.y;
        p->ref[2][l->first + k] = at.z;
        p->mesh[l->first + k] = mesh;
        p->mass[l->first + k] = k < g->point_count ? 0 : NO_MASS;
        p->fixed[l->first + k] = k < g->point_count ? 0 : TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
    }
    const tl_grid_block *of = block_of(l, 0);
    for (uint32_t zone = 0; zone < g->zone_count; zone++) {
        while (zone >= of->zone_end)
            of++;
        const double mass = of->density * volume_of(g, zone) / 4;
        for (int a = 0; a < 4; a++) {
            const uint32_t row = l->first + g->zone[zone][a];
            p->mass[row] += mass;
            p->zones[row]++;
        }
    }
}

bool tl_zones_index(struct tl_zones *z, uint32_t mesh)
{
    const size_t end = z->points.table.rows, listed_end = z->listed_count;
    if (!tl_grow(&z->use_start, &z->use_start_capacity, end + 1, sizeof *z->use_start) ||
        !tl_grow(&z->use, &z->use_capacity, listed_end, sizeof *z->use))
        return false;
    if (mesh == 0)
        z->use_start[0] = 0;
    if (mesh >= z->mesh_count)
        return true;
    /* each item of the list is a slot of one gridpoint: gridpoints from `begin` on have those from `listed` on */
    const tl_body_mesh *first = &z->mesh[mesh];
    const size_t begin = first->point_begin, listed = mesh > 0 ? z->parcels.of[first->parcel_begin].point_begin : 0;
    uint32_t *start = z->use_start;
    for (size_t p = begin; p <= end; p++)
        start[p] = 0;
    for (size_t k = listed; k < listed_end; k++)
        start[z->listed[k] + 1]++;
    start[begin] = (uint32_t)listed;
    for (size_t p = begin; p < end; p++)
        start[p + 1] += start[p];
    for (size_t k = listed; k < listed_end; k++)
        z->use[start[z->listed[k]]++] = (uint32_t)k;
    memmove(start + begin + 1, start + begin, (end - begin) * sizeof *start);
    start[begin] = (uint32_t)listed;
    for (size_t k = first->part_begin; k < z->part_count; k++)
        for (int a = 0; a < 3; a++)
            z->points.bare[z->part[k].corner[a]] = 1;
    return true;
}

void tl_zones_trim(struct tl_zones *z)
{
    const size_t points = z->points.table.rows + 1;
    tl_trim(&z->group, &z->group_capacity, z->group_count, sizeof *z->group);
    tl_trim(&z->listed, &z->listed_capacity, z->listed_count, sizeof *z->listed);
    tl_trim(&z->slot, &z->slot_capacity, z->listed_count, sizeof *z->slot);
    tl_trim(&z->use, &z->use_capacity, z->listed_count, sizeof *z->use);
    tl_trim(&z->use_start, &z->use_start_capacity, points, sizeof *z->use_start);
    tl_trim(&z->row_of, &z->row_of_capacity, z->row_of_count, sizeof *z->row_of);
    tl_trim(&z->part, &z->part_capacity, z->part_count, sizeof *z->part);
}

/* ---------------------------------------------------------------- a mesh comes ----------- */

/* What a mesh adds to the tables. */
typedef struct sizes {
    size_t points, parcels, groups, rows, listed;
} sizes;

/* Adds what the clusters of a parcel take; they are sorted. */
static void count_parcel(const laying *l, uint32_t count, sizes *all)
{
    for (uint32_t k = 0; k < count; k += TL_LANES) {
        all->groups++;
        all->rows += TL_LANES * size_of(l->grid, l->sorted[k]);
    }
    all->parcels++;
    all->listed += l->points;
}

/* Makes room for zones. */
static bool reserve_zones(laying *l, const sizes *more)
{
    struct tl_zones *z = l->z;
    return tl_table_reserve(&z->zones.table, z->zones.table.rows + more->rows) &&
           tl_table_reserve(&z->parcels.table, z->parcels.table.rows + more->parcels) &&
           tl_grow(&z->group, &z->group_capacity, z->group_count + more->groups, sizeof *z->group) &&
           tl_grow(&z->listed, &z->listed_capacity, z->listed_count + more->listed, sizeof *z->listed) &&
           tl_grow(&z->slot, &z->slot_capacity, z->listed_count + more->listed, sizeof *z->slot) &&
           tl_grow(&z->row_of, &z->row_of_capacity, z->row_of_count + l->grid->zone_count, sizeof *z->row_of);
}

/* Makes room for all else of a mesh. */
static bool reserve_rest(laying *l, const sizes *more)
{
    struct tl_zones *z = l->z;
    const size_t points = z->points.table.rows + more->points;
    return tl_table_reserve(&z->points.table, points) &&
           tl_grow(&z->part, &z->part_capacity, z->part_count + l->grid->part_count, sizeof *z->part) &&
           tl_grow(&z->mesh, &z->mesh_capacity, z->mesh_count + 1, sizeof *z->mesh) &&
           tl_grow(&z->use_start, &z->use_start_capacity, points + 1, sizeof *z->use_start) &&
           tl_grow(&z->use, &z->use_capacity, z->listed_count + more->listed, sizeof *z->use);
}

/* Makes room for the zones of a mesh, and counts what it adds. */
static bool make_room(laying *l, sizes *more)
{
    const tl_grid *g = l->grid;
    l->local = malloc((g->point_count + 1) * sizeof *l->local);
    l->sorted = malloc((g->cluster_count + 1) * sizeof *l->sorted);
    if (!l->local || !l->sorted)
        return false;
    *more = (sizes){.points = (g->point_count + TL_LANES - 1) / TL_LANES * TL_LANES};
    for (uint32_t first = 0, end; first < g->cluster_count; first = end) {
        end = gather_clusters(l, first);
        sort_clusters(l, first, end);
        count_parcel(l, end - first, more);
    }
    return reserve_zones(l, more);
}

/* Lays the zones of a mesh that has its gridpoints. There is room. */
static void lay_zones(laying *l, tl_body_mesh *mesh, uint32_t number, const sizes *more)
{
    struct tl_zones *z = l->z;
    mesh->parcel_begin = (uint32_t)z->parcels.table.rows;
    mesh->zone_begin = (uint32_t)z->row_of_count;
    l->first = mesh->point_begin;
    tl_table_resize(&z->parcels.table, z->parcels.table.rows + more->parcels);
    tl_table_resize(&z->zones.table, z->zones.table.rows + more->rows);
    uint32_t parcel = mesh->parcel_begin, first = 0;
    size_t row = z->zones.table.rows - more->rows;
    while (first < l->grid->cluster_count)
        first = lay_parcel(l, first, parcel++, &row, number);
    z->row_of_count += l->grid->zone_count;
    mesh->parcel_end = parcel;
    mesh->zone_end = (uint32_t)z->row_of_count;
}

/* Lays a mesh for which there is room. */
static void lay_mesh(laying *l, tl_id body, const sizes *more)
{
    struct tl_zones *z = l->z;
    const uint32_t number = (uint32_t)z->mesh_count++;
    tl_body_mesh *mesh = &z->mesh[number];
    *mesh = (tl_body_mesh){.body = body,
                           .row = l->row,
                           .made_u = l->m->bodies.pose[l->row].u,
                           .made_q = l->m->bodies.q[l->row],
                           .point_begin = (uint32_t)z->points.table.rows,
                           .part_begin = (uint32_t)z->part_count};
    l->first = mesh->point_begin;
    tl_table_resize(&z->points.table, z->points.table.rows + more->points);
    put_points(l, more->points, number);
    lay_zones(l, mesh, number, more);
    mesh->point_end = mesh->point_begin + (uint32_t)l->grid->point_count;
    for (size_t k = 0; k < l->grid->part_count; k++) {
        tl_surface_part *part = &z->part[z->part_count++];
        *part = l->grid->part[k];
        for (int a = 0; a < 3; a++)
            part->corner[a] += l->first;
        part->apex += l->first;
    }
    mesh->part_end = (uint32_t)z->part_count;
    z->version++;
}

static laying laying_of(tl_model *m, struct tl_zones *z, tl_id body, const tl_grid *grid, uint32_t solid)
{
    return (laying){.m = m,
                    .z = z,
                    .grid = grid,
                    .row = m->blocks.body[tl_block_row_quiet(m, body)],
                    .solid = solid,
                    .own = {body, grid->density, grid->zone_count, grid->cluster_count}};
}

tl_status tl_zones_add(tl_model *m, tl_id body, const tl_grid *grid, uint32_t solid)
{
    struct tl_zones *z = m->zones;
    laying l = laying_of(m, z, body, grid, solid);
    sizes more;
    const bool enough = make_room(&l, &more) && tl_solid_columns(z, &z->solid[solid].of) && reserve_rest(&l, &more);
    if (enough) {
        lay_mesh(&l, body, &more);
        tl_zones_index(z, (uint32_t)z->mesh_count - 1);
        m->bodies.fixed[l.row] = TL_FIX_ALL; /* its gridpoints move it */
        m->bodies.mesh[l.row] = (uint32_t)z->mesh_count;
        m->constraints++;
    }
    free(l.local);
    free(l.sorted);
    return enough ? TL_OK : tl_fail_memory(&m->error);
}

bool tl_zones_lay(tl_model *m, struct tl_zones *to, uint32_t mesh, const tl_grid *grid)
{
    laying l = laying_of(m, to, to->mesh[mesh].body, grid, TL_NO_ROW);
    sizes more;
    const bool enough = make_room(&l, &more);
    if (enough)
        lay_zones(&l, &to->mesh[mesh], mesh, &more);
    free(l.local);
    free(l.sorted);
    return enough;
}

void tl_zones_end_at(tl_model *m, uint32_t meshes)
{
    struct tl_zones *z = m->zones;
    if (meshes >= z->mesh_count)
        return;
    const tl_body_mesh *first = &z->mesh[meshes];
    const tl_parcel *parcel = &z->parcels.of[first->parcel_begin];
    tl_table_resize(&z->zones.table, z->group[parcel->group_begin].start);
    z->group_count = parcel->group_begin;
    z->listed_count = parcel->point_begin;
    tl_table_resize(&z->parcels.table, first->parcel_begin);
    tl_table_resize(&z->points.table, first->point_begin);
    z->row_of_count = first->zone_begin;
    z->part_count = first->part_begin;
    for (uint32_t k = meshes; k < z->mesh_count; k++)
        m->bodies.mesh[z->mesh[k].row] = 0;
    z->mesh_count = meshes;
    z->version++;
}
