/* follow.c - meshes follow their bodies: when rows move, and when bodies go. */
#include "zone/follow.h"

#include "model/loads.h"
#include "zone/grid.h"
#include "zone/outer.h"

#include <string.h>

/* What a mesh takes of each table, and how far it moves down. */
typedef struct span {
    size_t begin, end, shift;
} span;

typedef struct spans {
    span points, parcels, groups, zones, listed, numbers, parts;
} spans;

static size_t padded(size_t points)
{
    return (points + TL_LANES - 1) / TL_LANES * TL_LANES;
}

static size_t zones_from(const struct tl_zones *z, size_t group)
{
    return group < z->group_count ? z->group[group].start : z->zones.table.rows;
}

/* A mesh begins where the last one ends; `to`: where its items go. */
static spans spans_of(const struct tl_zones *z, const tl_body_mesh *mesh, const spans *to)
{
    const tl_parcel *first = &z->parcels.of[mesh->parcel_begin], *last = &z->parcels.of[mesh->parcel_end - 1];
    return (spans){
        .points = {mesh->point_begin, padded(mesh->point_end), mesh->point_begin - to->points.begin},
        .parcels = {mesh->parcel_begin, mesh->parcel_end, mesh->parcel_begin - to->parcels.begin},
        .groups = {first->group_begin, last->group_end, first->group_begin - to->groups.begin},
        .zones = {zones_from(z, first->group_begin), zones_from(z, last->group_end),
                  zones_from(z, first->group_begin) - to->zones.begin},
        .listed = {first->point_begin, last->point_end, first->point_begin - to->listed.begin},
        .numbers = {mesh->zone_begin, mesh->zone_end, mesh->zone_begin - to->numbers.begin},
        .parts = {mesh->part_begin, mesh->part_end, mesh->part_begin - to->parts.begin},
    };
}

static void move_rows(tl_table *table, span of)
{
    for (size_t row = of.begin; of.shift > 0 && row < of.end; row++)
        tl_table_move(table, row - of.shift, row);
}

static void move_parcels(struct tl_zones *z, const spans *of, uint32_t mesh)
{
    for (size_t k = of->parcels.begin - of->parcels.shift; k < of->parcels.end - of->parcels.shift; k++) {
        tl_parcel *parcel = &z->parcels.of[k];
        parcel->mesh = mesh;
        parcel->group_begin -= (uint32_t)of->groups.shift;
        parcel->group_end -= (uint32_t)of->groups.shift;
        parcel->point_begin -= (uint32_t)of->listed.shift;
        parcel->point_end -= (uint32_t)of->listed.shift;
    }
    for (size_t k = of->groups.begin; k < of->groups.end; k++) {
        z->group[k - of->groups.shift] = z->group[k];
        z->group[k - of->groups.shift].start -= (uint32_t)of->zones.shift;
    }
}

static void move_lists(struct tl_zones *z, const spans *of)
{
    for (size_t k = of->listed.begin; k < of->listed.end; k++) {
        z->listed[k - of->listed.shift] = z->listed[k] - (uint32_t)of->points.shift;
        z->slot[k - of->listed.shift] = z->slot[k];
    }
    for (size_t k = of->numbers.begin; k < of->numbers.end; k++)
        z->row_of[k - of->numbers.shift] = z->row_of[k] - (uint32_t)of->zones.shift;
    for (size_t k = of->parts.begin; k < of->parts.end; k++) {
        tl_surface_part *part = &z->part[k - of->parts.shift];
        *part = z->part[k];
        for (int a = 0; a < 3; a++)
            part->corner[a] -= (uint32_t)of->points.shift;
        part->apex -= (uint32_t)of->points.shift;
    }
}

/* Moves what acts on the triangles of a mesh: those of the list before `*from` have been passed, `kept` stay. */
static size_t move_outer(struct tl_zones *z, const spans *of, size_t *from, size_t kept)
{
    while (*from < z->outer_count && z->outer[*from].part < of->parts.begin)
        ++*from;
    for (; *from < z->outer_count && z->outer[*from].part < of->parts.end; ++*from) {
        z->outer[kept] = z->outer[*from];
        z->outer[kept++].part -= (uint32_t)of->parts.shift;
    }
    return kept;
}

/* Moves a mesh down to where the last one that stays has ended. */
static void move_mesh(struct tl_zones *z, uint32_t number, const spans *of)
{
    tl_body_mesh *mesh = &z->mesh[number];
    move_rows(&z->points.table, of->points);
    move_rows(&z->parcels.table, of->parcels);
    move_rows(&z->zones.table, of->zones);
    move_parcels(z, of, number);
    move_lists(z, of);
    for (size_t row = of->points.begin - of->points.shift; row < of->points.end - of->points.shift; row++)
        z->points.mesh[row] = number;
    mesh->point_begin -= (uint32_t)of->points.shift;
    mesh->point_end -= (uint32_t)of->points.shift;
    mesh->parcel_begin -= (uint32_t)of->parcels.shift;
    mesh->parcel_end -= (uint32_t)of->parcels.shift;
    mesh->zone_begin -= (uint32_t)of->numbers.shift;
    mesh->zone_end -= (uint32_t)of->numbers.shift;
    mesh->part_begin -= (uint32_t)of->parts.shift;
    mesh->part_end -= (uint32_t)of->parts.shift;
}

static void add_size(span *to, span of)
{
    to->begin += of.end - of.begin;
}

/* Where the next mesh goes. */
static void go_on(spans *to, const spans *of)
{
    add_size(&to->points, of->points);
    add_size(&to->parcels, of->parcels);
    add_size(&to->groups, of->groups);
    add_size(&to->zones, of->zones);
    add_size(&to->listed, of->listed);
    add_size(&to->numbers, of->numbers);
    add_size(&to->parts, of->parts);
}

/* Takes out the meshes of bodies that have gone. */
static void keep_meshes(tl_model *m, struct tl_zones *z)
{
    spans to;
    memset(&to, 0, sizeof to);
    uint32_t kept = 0;
    size_t from = 0, outer = 0;
    for (uint32_t k = 0; k < z->mesh_count; k++) {
        const spans of = spans_of(z, &z->mesh[k], &to);
        if (tl_block_row_quiet(m, z->mesh[k].body) == TL_NO_ROW)
            continue;
        outer = move_outer(z, &of, &from, outer);
        z->mesh[kept] = z->mesh[k];
        move_mesh(z, kept++, &of);
        go_on(&to, &of);
    }
    if (kept == z->mesh_count)
        return;
    z->mesh_count = kept;
    tl_table_resize(&z->points.table, to.points.begin);
    tl_table_resize(&z->parcels.table, to.parcels.begin);
    tl_table_resize(&z->zones.table, to.zones.begin);
    z->group_count = to.groups.begin;
    z->listed_count = to.listed.begin;
    z->row_of_count = to.numbers.begin;
    z->part_count = to.parts.begin;
    z->outer_count = outer;
    tl_outer_forget(&z->points);
    tl_drives_recount(m);
    tl_zones_index(z, 0); /* there is room: there were more */
    z->version++;
}

void tl_zones_follow(tl_model *m)
{
    struct tl_zones *z = m->zones;
    if (z->followed == m->structure)
        return;
    keep_meshes(m, z);
    for (uint32_t row = 0; row < m->bodies.table.rows; row++)
        m->bodies.mesh[row] = 0;
    for (uint32_t k = 0; k < z->mesh_count; k++) {
        z->mesh[k].row = m->blocks.body[tl_block_row_quiet(m, z->mesh[k].body)];
        m->bodies.mesh[z->mesh[k].row] = k + 1;
    }
    z->followed = m->structure;
}
