/* resolid.c - zones get another solid. They keep their stress, and the states that both solids have by the same names.
 *
 * A parcel is of one solid. Where all zones of each parcel get the same one, parcels change theirs and that is all.
 * Otherwise the zones of that mesh are laid anew: into clusters that do not reach across solids, and parcels that end
 * where the solid changes. Gridpoints stay as they are, and zones keep their numbers. All that is laid goes into other
 * tables, with the other meshes as they are. They then take the place of those before. */
#include "zone/resolid.h"

#include "base/error.h"
#include "model/rows.h"
#include "zone/grid.h"
#include "zone/outer.h"
#include "zone/solids.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/zones.h>

/* One call. Zones are counted as in `row_of`: mesh by mesh, by their numbers. */
typedef struct changing {
    tl_model *m;
    struct tl_zones *z;
    uint32_t *parcel;     /* of each zone */
    uint32_t *wanted;     /* the solid that each zone is to have */
    uint8_t *split;       /* of each mesh: zones of one of its parcels get different solids */
    bool some_split;      /* of some mesh */
    bool some_changed;    /* a zone gets another solid than it has */
    struct tl_zones laid; /* the new tables, and a list of the meshes */
} changing;

/* ---------------------------------------------------------------- what is wanted --------- */

/* Lists the parcels of all zones, and the solids that they have. */
static bool list_zones(changing *c)
{
    const struct tl_zones *z = c->z;
    c->parcel = malloc((z->row_of_count + 1) * sizeof *c->parcel);
    c->wanted = malloc((z->row_of_count + 1) * sizeof *c->wanted);
    c->split = calloc(z->mesh_count + 1, 1);
    if (!c->parcel || !c->wanted || !c->split)
        return false;
    for (uint32_t k = 0; k < z->parcels.table.rows; k++) {
        const tl_parcel *of = &z->parcels.of[k];
        for (uint32_t g = of->group_begin; g < of->group_end; g++)
            for (uint32_t i = 0; i < (uint32_t)z->group[g].depth * TL_LANES; i++) {
                const uint32_t number = z->zones.number[z->group[g].start + i];
                if (number == TL_NO_ROW)
                    continue;
                c->parcel[z->mesh[of->mesh].zone_begin + number] = k;
                c->wanted[z->mesh[of->mesh].zone_begin + number] = of->solid;
            }
    }
    return true;
}

/* The first zone of a parcel. */
static uint32_t first_of(const struct tl_zones *z, const tl_parcel *of)
{
    return z->mesh[of->mesh].zone_begin + z->zones.number[z->group[of->group_begin].start];
}

/* Notes which meshes have parcels of which zones get different solids. */
static void find_split(changing *c)
{
    const struct tl_zones *z = c->z;
    for (size_t k = 0; k < z->row_of_count && !c->some_changed; k++)
        c->some_changed = c->wanted[k] != z->parcels.of[c->parcel[k]].solid;
    for (uint32_t mesh = 0; mesh < z->mesh_count; mesh++) {
        for (uint32_t k = z->mesh[mesh].zone_begin; k < z->mesh[mesh].zone_end && !c->split[mesh]; k++)
            c->split[mesh] = c->wanted[k] != c->wanted[first_of(z, &z->parcels.of[c->parcel[k]])];
        c->some_split = c->some_split || c->split[mesh];
    }
}

/* ---------------------------------------------------------------- whole parcels ---------- */

/* Gives a parcel of some tables the solid that all its zones get. What it stores is NaN then, until it is known. */
static void change_parcel(const changing *c, struct tl_zones *to, uint32_t parcel, uint32_t solid)
{
    tl_parcel *of = &to->parcels.of[parcel];
    if (of->solid == solid)
        return;
    tl_solid_carry(to, of, c->z->solid[of->solid].of.kind, c->z->solid[solid].of.kind);
    of->solid = solid;
    to->parcels.stored[parcel] = NAN;
}

static void change_parcels(const changing *c)
{
    struct tl_zones *z = c->z;
    for (uint32_t k = 0; k < z->parcels.table.rows; k++)
        change_parcel(c, z, k, c->wanted[first_of(z, &z->parcels.of[k])]);
}

/* ---------------------------------------------------------------- meshes that stay ------- */

/* Adds rows of a table to the end of another one with the same columns. */
static bool add_rows(tl_table *to, const tl_table *from, size_t first, size_t count)
{
    const size_t at = to->rows;
    if (!tl_table_reserve(to, at + count) || !tl_table_resize(to, at + count))
        return false;
    for (size_t k = 0; k < to->column_count; k++) {
        const size_t size = to->columns[k].size;
        memcpy((char *)tl_table_data(to, k) + at * size, (const char *)tl_table_data(from, k) + first * size,
               count * size);
    }
    return true;
}

/* Moves what the parcels of a mesh name to where it has been copied. */
static void shift_parcels(struct tl_zones *to, const tl_body_mesh *mesh, uint32_t groups, uint32_t rows,
                          uint32_t listed)
{
    for (uint32_t k = mesh->parcel_begin; k < mesh->parcel_end; k++) {
        tl_parcel *of = &to->parcels.of[k];
        of->group_begin += groups;
        of->group_end += groups;
        of->point_begin += listed;
        of->point_end += listed;
        for (uint32_t g = of->group_begin; g < of->group_end; g++)
            to->group[g].start += rows;
    }
    for (uint32_t k = mesh->zone_begin; k < mesh->zone_end; k++)
        to->row_of[k] += rows;
}

/* Copies the zones of a mesh to the new tables; differences of row numbers wrap around where they fall. */
static bool copy_mesh(changing *c, uint32_t mesh)
{
    const struct tl_zones *z = c->z;
    struct tl_zones *to = &c->laid;
    const tl_body_mesh *from = &z->mesh[mesh];
    const tl_parcel *first = &z->parcels.of[from->parcel_begin], *last = &z->parcels.of[from->parcel_end - 1];
    const size_t groups = last->group_end - first->group_begin, listed = last->point_end - first->point_begin;
    const size_t zones = from->zone_end - from->zone_begin, parcels = from->parcel_end - from->parcel_begin;
    const tl_zone_group *end = &z->group[last->group_end - 1];
    const uint32_t row = z->group[first->group_begin].start, rows = end->start + end->depth * (uint32_t)TL_LANES - row;
    const uint32_t row_shift = (uint32_t)to->zones.table.rows - row;
    const uint32_t group_shift = (uint32_t)to->group_count - first->group_begin;
    const uint32_t listed_shift = (uint32_t)to->listed_count - first->point_begin;
    if (!tl_grow(&to->group, &to->group_capacity, to->group_count + groups, sizeof *to->group) ||
        !tl_grow(&to->listed, &to->listed_capacity, to->listed_count + listed, sizeof *to->listed) ||
        !tl_grow(&to->row_of, &to->row_of_capacity, to->row_of_count + zones, sizeof *to->row_of) ||
        !add_rows(&to->zones.table, &z->zones.table, row, rows) ||
        !add_rows(&to->parcels.table, &z->parcels.table, from->parcel_begin, parcels))
        return false;
    memcpy(to->group + to->group_count, z->group + first->group_begin, groups * sizeof *to->group);
    memcpy(to->listed + to->listed_count, z->listed + first->point_begin, listed * sizeof *to->listed);
    memcpy(to->row_of + to->row_of_count, z->row_of + from->zone_begin, zones * sizeof *to->row_of);
    to->group_count += groups;
    to->listed_count += listed;
    to->row_of_count += zones;
    to->mesh[mesh].parcel_begin = (uint32_t)(to->parcels.table.rows - parcels);
    to->mesh[mesh].parcel_end = (uint32_t)to->parcels.table.rows;
    shift_parcels(to, &to->mesh[mesh], group_shift, row_shift, listed_shift);
    for (uint32_t k = 0; k < parcels; k++)
        change_parcel(c, to, to->mesh[mesh].parcel_begin + k, c->wanted[first_of(z, first + k)]);
    return true;
}

/* ---------------------------------------------------------------- meshes laid anew ------- */

/* The zones of a mesh on their way into clusters. */
typedef struct mesh_zones {
    const tl_body_mesh *mesh;
    uint32_t count;
    tl_vec3 *point;
    uint32_t (*zone)[4], (*beside)[4];
    uint32_t *side_start, *side; /* sides of zones, 4 zone + corner opposite, by their lowest points */
    tl_zone_clusters made;
    uint32_t *cluster_start, *cluster_zone, *cluster_solid; /* by blocks, and by solids */
    tl_grid_block *block;
    size_t block_count;
} mesh_zones;

static bool begin_zones(const changing *c, uint32_t mesh, mesh_zones *a)
{
    const tl_body_mesh *of = &c->z->mesh[mesh];
    const size_t points = of->point_end - of->point_begin, zones = of->zone_end - of->zone_begin;
    *a = (mesh_zones){.mesh = of, .count = (uint32_t)zones};
    a->point = malloc((points + 1) * sizeof *a->point);
    a->zone = malloc((zones + 1) * sizeof *a->zone);
    a->beside = malloc((zones + 1) * sizeof *a->beside);
    a->side_start = calloc(points + 2, sizeof *a->side_start);
    a->side = malloc((4 * zones + 1) * sizeof *a->side);
    a->cluster_start = malloc((zones + 1) * sizeof *a->cluster_start);
    a->cluster_zone = malloc((zones + 1) * sizeof *a->cluster_zone);
    a->cluster_solid = malloc((zones + 1) * sizeof *a->cluster_solid);
    a->block = malloc((zones + 1) * sizeof *a->block);
    return a->point && a->zone && a->beside && a->side_start && a->side && a->cluster_start && a->cluster_zone &&
           a->cluster_solid && a->block;
}

static void end_zones(mesh_zones *a)
{
    void *const owned[] = {a->point,         a->zone,         a->beside,        a->side_start, a->side,
                           a->cluster_start, a->cluster_zone, a->cluster_solid, a->block};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    tl_zone_clusters_free(&a->made);
}

static const tl_parcel *parcel_of(const changing *c, const mesh_zones *a, uint32_t zone)
{
    return &c->z->parcels.of[c->parcel[a->mesh->zone_begin + zone]];
}

static uint32_t solid_of(const changing *c, const mesh_zones *a, uint32_t zone)
{
    return c->wanted[a->mesh->zone_begin + zone];
}

/* Corners of the zones, places of gridpoints where they were made, and which zones each block has. */
static void list_corners(const changing *c, mesh_zones *a)
{
    const struct tl_zones *z = c->z;
    const tl_gridpoints *p = &z->points;
    for (uint32_t row = a->mesh->point_begin; row < a->mesh->point_end; row++)
        a->point[row - a->mesh->point_begin] = tl_v3(p->ref[0][row], p->ref[1][row], p->ref[2][row]);
    for (uint32_t k = 0; k < a->count; k++) {
        const tl_parcel *of = parcel_of(c, a, k);
        const uint32_t row = z->row_of[a->mesh->zone_begin + k];
        for (int i = 0; i < 4; i++)
            a->zone[k][i] = z->listed[of->point_begin + z->zones.corner[i][row]] - a->mesh->point_begin;
        if (a->block_count == 0 || a->block[a->block_count - 1].block != of->block)
            a->block[a->block_count++] = (tl_grid_block){.block = of->block};
        a->block[a->block_count - 1].zone_end = k + 1;
    }
}

/* The corners of a side, ascending. */
static void corners_of(const mesh_zones *a, uint32_t side, uint32_t corner[3])
{
    int count = 0;
    for (uint32_t i = 0; i < 4; i++) {
        int at = count;
        if (i == side % 4)
            continue;
        for (; at > 0 && corner[at - 1] > a->zone[side / 4][i]; at--)
            corner[at] = corner[at - 1];
        corner[at] = a->zone[side / 4][i];
        count++;
    }
}

/* Whether two zones may be of one cluster. */
static bool go_together(const changing *c, const mesh_zones *a, uint32_t k, uint32_t other)
{
    return solid_of(c, a, k) == solid_of(c, a, other) && parcel_of(c, a, k)->block == parcel_of(c, a, other)->block;
}

/* Finds the zone beside each side that may be in one cluster with its zone. */
static void find_beside(const changing *c, mesh_zones *a)
{
    const uint32_t points = a->mesh->point_end - a->mesh->point_begin;
    uint32_t one[3], other[3], *start = a->side_start;
    for (uint32_t s = 0; s < 4 * a->count; s++) {
        corners_of(a, s, one);
        start[one[0] + 2]++;
        a->beside[s / 4][s % 4] = UINT32_MAX;
    }
    for (uint32_t p = 0; p < points; p++)
        start[p + 2] += start[p + 1];
    for (uint32_t s = 0; s < 4 * a->count; s++) {
        corners_of(a, s, one);
        a->side[start[one[0] + 1]++] = s;
    }
    for (uint32_t p = 0; p < points; p++)
        for (uint32_t i = start[p]; i < start[p + 1]; i++)
            for (uint32_t j = i + 1; j < start[p + 1]; j++) {
                const uint32_t s = a->side[i], t = a->side[j];
                corners_of(a, s, one);
                corners_of(a, t, other);
                if (memcmp(one, other, sizeof one) != 0 || !go_together(c, a, s / 4, t / 4))
                    continue;
                a->beside[s / 4][s % 4] = t / 4;
                a->beside[t / 4][t % 4] = s / 4;
            }
}

/* Puts the clusters of each block in the order of their solids. */
static void sort_clusters(const changing *c, mesh_zones *a)
{
    uint32_t at = 0, begin = 0, clusters = 0;
    for (size_t b = 0; b < a->block_count; b++) {
        uint32_t end = begin;
        while (end < a->made.count && a->made.zone[a->made.start[end]] < a->block[b].zone_end)
            end++;
        for (uint32_t solid = 0; solid < c->z->solid_count; solid++)
            for (uint32_t k = begin; k < end; k++) {
                const uint32_t first = a->made.start[k], size = a->made.start[k + 1] - first;
                if (solid_of(c, a, a->made.zone[first]) != solid)
                    continue;
                a->cluster_start[clusters] = at;
                a->cluster_solid[clusters++] = solid;
                memcpy(a->cluster_zone + at, a->made.zone + first, size * sizeof *a->cluster_zone);
                at += size;
            }
        a->block[b].cluster_end = clusters;
        begin = end;
    }
    a->cluster_start[clusters] = at;
}

/* The zone that a row of a group stands for: its own or, of an inert one, that of which it is a copy. */
static uint32_t zone_of_row(const struct tl_zones *z, const tl_zone_group *g, uint32_t row)
{
    const uint32_t lane = (row - g->start) % TL_LANES;
    const uint32_t number = z->zones.number[row];
    return number != TL_NO_ROW ? number : z->zones.number[g->start + (g->count[lane] > 0 ? lane : 0)];
}

/* Gives the zones of a mesh that has been laid their stress, flags and states. */
static void take_over(changing *c, const mesh_zones *a, uint32_t mesh)
{
    const struct tl_zones *z = c->z;
    struct tl_zones *to = &c->laid;
    double most = 0;
    for (uint32_t k = a->mesh->parcel_begin; k < a->mesh->parcel_end; k++)
        most = fmax(most, z->parcels.most_strain[k]);
    for (uint32_t k = to->mesh[mesh].parcel_begin; k < to->mesh[mesh].parcel_end; k++) {
        const tl_parcel *of = &to->parcels.of[k];
        to->parcels.stored[k] = NAN;
        to->parcels.most_strain[k] = most;
        for (uint32_t g = of->group_begin; g < of->group_end; g++)
            for (uint32_t i = 0; i < (uint32_t)to->group[g].depth * TL_LANES; i++) {
                const uint32_t row = to->group[g].start + i, zone = zone_of_row(to, &to->group[g], row);
                const uint32_t old = z->row_of[a->mesh->zone_begin + zone];
                for (int s = 0; s < 6; s++)
                    to->zones.stress[s][row] = z->zones.stress[s][old];
                to->zones.flags[row] = z->zones.flags[old];
                tl_solid_carry_row(&z->zones, old, z->solid[parcel_of(c, a, zone)->solid].of.kind, &to->zones, row,
                                   z->solid[of->solid].of.kind);
            }
    }
}

static tl_status lay_anew(changing *c, uint32_t mesh)
{
    mesh_zones a;
    tl_status status = begin_zones(c, mesh, &a) ? TL_OK : tl_fail_memory(&c->m->error);
    if (status == TL_OK) {
        list_corners(c, &a);
        find_beside(c, &a);
        status = tl_zone_clusters_make((const uint32_t(*)[4])a.zone, (const uint32_t(*)[4])a.beside, a.count, &a.made,
                                       &c->m->error);
    }
    if (status == TL_OK) {
        sort_clusters(c, &a);
        const tl_grid grid = {.point = a.point,
                              .point_count = a.mesh->point_end - a.mesh->point_begin,
                              .zone = (const uint32_t(*)[4])a.zone,
                              .zone_count = a.count,
                              .cluster_start = a.cluster_start,
                              .cluster_zone = a.cluster_zone,
                              .cluster_count = a.made.count,
                              .cluster_solid = a.cluster_solid,
                              .block = a.block,
                              .block_count = a.block_count};
        if (tl_zones_lay(c->m, &c->laid, mesh, &grid))
            take_over(c, &a, mesh);
        else
            status = tl_fail_memory(&c->m->error);
    }
    end_zones(&a);
    return status;
}

/* ---------------------------------------------------------------- all of them ------------ */

/* Makes tables without rows, and a list of the meshes. */
static bool begin_tables(changing *c)
{
    struct tl_zones *to = &c->laid;
    const struct tl_zones *z = c->z;
    to->mesh = malloc((z->mesh_count + 1) * sizeof *to->mesh);
    if (!to->mesh || !tl_table_copy(&to->zones.table, &to->zones, &z->zones.table) ||
        !tl_table_copy(&to->parcels.table, &to->parcels, &z->parcels.table))
        return false;
    tl_table_resize(&to->zones.table, 0);
    tl_table_resize(&to->parcels.table, 0);
    to->zones.state_columns = z->zones.state_columns;
    memcpy(to->mesh, z->mesh, z->mesh_count * sizeof *to->mesh);
    to->mesh_count = z->mesh_count;
    return true;
}

/* Exchanges two lists with their counts and capacities. */
#define SWAP(type, a, b)                                                                                               \
    do {                                                                                                               \
        type swapped = a;                                                                                              \
        a = b;                                                                                                         \
        b = swapped;                                                                                                   \
    } while (0)

/* Puts the new tables in the place of those before, which are freed with what is left. */
static void exchange(changing *c)
{
    struct tl_zones *z = c->z, *to = &c->laid;
    SWAP(tl_zone_table, z->zones, to->zones);
    SWAP(tl_parcels, z->parcels, to->parcels);
    z->zones.table.owner = &z->zones;
    to->zones.table.owner = &to->zones;
    z->parcels.table.owner = &z->parcels;
    to->parcels.table.owner = &to->parcels;
    SWAP(tl_zone_group *, z->group, to->group);
    SWAP(size_t, z->group_count, to->group_count);
    SWAP(size_t, z->group_capacity, to->group_capacity);
    SWAP(uint32_t *, z->listed, to->listed);
    SWAP(size_t, z->listed_count, to->listed_count);
    SWAP(size_t, z->listed_capacity, to->listed_capacity);
    SWAP(uint32_t *, z->row_of, to->row_of);
    SWAP(size_t, z->row_of_capacity, to->row_of_capacity);
    memcpy(z->mesh, to->mesh, z->mesh_count * sizeof *z->mesh);
    tl_zones_index(z, 0);
}

static void end_tables(struct tl_zones *laid)
{
    tl_table_free(&laid->zones.table);
    tl_table_free(&laid->parcels.table);
    free(laid->group);
    free(laid->listed);
    free(laid->slot);
    free(laid->row_of);
    free(laid->mesh);
}

/* Lays all meshes into new tables, and puts these in. */
static tl_status lay_all(changing *c)
{
    struct tl_zones *z = c->z, *to = &c->laid;
    tl_status status = begin_tables(c) ? TL_OK : tl_fail_memory(&c->m->error);
    for (uint32_t mesh = 0; status == TL_OK && mesh < z->mesh_count; mesh++)
        if (c->split[mesh])
            status = lay_anew(c, mesh);
        else if (!copy_mesh(c, mesh))
            status = tl_fail_memory(&c->m->error);
    if (status == TL_OK && !(tl_grow(&z->slot, &z->slot_capacity, to->listed_count, sizeof *z->slot) &&
                             tl_grow(&z->use, &z->use_capacity, to->listed_count, sizeof *z->use)))
        status = tl_fail_memory(&c->m->error);
    if (status == TL_OK)
        exchange(c);
    end_tables(to);
    return status;
}

/* Parcels that have changed store what their stress is worth to their solids. */
static void store(struct tl_zones *z)
{
    for (size_t k = 0; k < z->parcels.table.rows; k++)
        if (isnan(z->parcels.stored[k]))
            z->parcels.stored[k] = tl_parcel_stored(z, &z->parcels.of[k]);
}

/* Gives all zones what they are to have. */
static tl_status change(changing *c)
{
    tl_status status = TL_OK;
    find_split(c);
    if (!c->some_changed)
        return TL_OK;
    if (c->some_split)
        status = lay_all(c);
    else
        change_parcels(c);
    if (status != TL_OK)
        return status;
    store(c->z);
    tl_outer_find_solids(c->z);
    c->z->version++;
    c->m->laws++; /* the balance takes the change of what is stored for one by hand */
    return TL_OK;
}

/* The number of a solid that zones are to get; its states have columns then. */
static tl_status find_solid(tl_model *m, const char *solid, uint32_t *number)
{
    *number = m->zones ? tl_solid_find(m, solid) : TL_NO_ROW;
    if (*number == TL_NO_ROW)
        return tl_solid_missing(m, solid);
    return tl_solid_columns(m->zones, &m->zones->solid[*number].of) ? TL_OK : tl_fail_memory(&m->error);
}

static tl_status begin(changing *c, tl_model *m, const char *solid, uint32_t *number)
{
    *c = (changing){.m = m, .z = m->zones};
    tl_status status = tl_model_may_set(m, "give zones another solid");
    if (status != TL_OK)
        return status;
    tl_rows_tidy(m);
    status = find_solid(m, solid, number);
    return status != TL_OK || list_zones(c) ? status : tl_fail_memory(&m->error);
}

static tl_status end(changing *c, tl_status status)
{
    free(c->parcel);
    free(c->wanted);
    free(c->split);
    return status;
}

/* ---------------------------------------------------------------- which zones ------------ */

tl_status tl_zones_solid(tl_model *m, const tl_zone_name *names, size_t count, const char *solid)
{
    changing c;
    uint32_t number;
    tl_status status = begin(&c, m, solid, &number);
    for (size_t k = 0; status == TL_OK && k < count; k++) {
        const uint32_t mesh = tl_mesh_of(m, names[k].body);
        const tl_body_mesh *of = mesh != TL_NO_ROW ? &c.z->mesh[mesh] : NULL;
        if (!of || names[k].number >= of->zone_end - of->zone_begin)
            status = tl_fail(&m->error, TL_E_STALE, "block %u has no zone %u", names[k].body, names[k].number);
        else
            c.wanted[of->zone_begin + names[k].number] = number;
    }
    return end(&c, status == TL_OK && count > 0 ? change(&c) : status);
}

/* Marks the rows of blocks, which must be deformable. */
static tl_status mark_blocks(tl_model *m, const tl_id *blocks, size_t count, uint8_t *marked)
{
    for (size_t k = 0; k < count; k++) {
        const uint32_t row = tl_block_row(m, blocks[k]);
        if (row == TL_NO_ROW)
            return m->error.status;
        if (!tl_block_deforms(m, row))
            return tl_fail(&m->error, TL_E_STATE, "block %u has no solid: it is rigid; give it zones first, with %s",
                           blocks[k], tl_words(m, "selection:deformable", "tl_blocks_deform"));
        marked[row] = 1;
    }
    return TL_OK;
}

tl_status tl_blocks_resolid(tl_model *m, const tl_id *blocks, size_t count, const char *solid)
{
    changing c;
    uint32_t number;
    tl_status status = begin(&c, m, solid, &number);
    uint8_t *marked = calloc(m->blocks.table.rows + 1, 1);
    if (status == TL_OK)
        status = marked ? mark_blocks(m, blocks, count, marked) : tl_fail_memory(&m->error);
    for (size_t k = 0; status == TL_OK && k < c.z->row_of_count; k++)
        if (marked[tl_block_row_quiet(m, c.z->parcels.of[c.parcel[k]].block)])
            c.wanted[k] = number;
    free(marked);
    return end(&c, status == TL_OK && count > 0 ? change(&c) : status);
}
