/* block_zones.c - the zones of one block on their way into the tables: mesh, clusters, surface. */
#include "zone/block_zones.h"

#include "geometry/zoning.h"

#include <stdlib.h>
#include <string.h>

/* Lists of the free sides of zones by their lowest points: side `4 zone + corner` lies opposite the corner. */
typedef struct free_sides {
    uint32_t *start, *side;
} free_sides;

static uint32_t lowest_of(const tl_zone_mesh *mesh, uint32_t side)
{
    uint32_t lowest = UINT32_MAX;
    for (uint32_t a = 0; a < 4; a++)
        if (a != side % 4 && mesh->zone[side / 4][a] < lowest)
            lowest = mesh->zone[side / 4][a];
    return lowest;
}

static bool list_free_sides(const tl_zone_mesh *mesh, free_sides *sides)
{
    sides->start = calloc((size_t)mesh->point_count + 2, sizeof *sides->start);
    sides->side = malloc(((size_t)mesh->triangle_count + 1) * sizeof *sides->side);
    if (!sides->start || !sides->side)
        return false;
    for (uint32_t s = 0; s < 4 * mesh->zone_count; s++)
        if (mesh->beside[s / 4][s % 4] == UINT32_MAX)
            sides->start[lowest_of(mesh, s) + 2]++;
    for (uint32_t p = 0; p < mesh->point_count; p++)
        sides->start[p + 2] += sides->start[p + 1];
    for (uint32_t s = 0; s < 4 * mesh->zone_count; s++)
        if (mesh->beside[s / 4][s % 4] == UINT32_MAX)
            sides->side[sides->start[lowest_of(mesh, s) + 1]++] = s;
    return true;
}

/* Whether a side of a zone has the corners of a triangle. */
static bool is_side(const tl_zone_mesh *mesh, uint32_t side, const uint32_t corner[3])
{
    int shared = 0;
    for (uint32_t a = 0; a < 4; a++)
        for (int k = 0; a != side % 4 && k < 3; k++)
            shared += mesh->zone[side / 4][a] == corner[k];
    return shared == 3;
}

/* The point of a triangle's zone that is no corner of it. */
static uint32_t apex_of(const tl_zone_mesh *mesh, const free_sides *sides, const uint32_t corner[3])
{
    uint32_t lowest = corner[0];
    for (int k = 1; k < 3; k++)
        if (corner[k] < lowest)
            lowest = corner[k];
    for (uint32_t k = sides->start[lowest]; k < sides->start[lowest + 1]; k++)
        if (is_side(mesh, sides->side[k], corner))
            return mesh->zone[sides->side[k] / 4][sides->side[k] % 4];
    return UINT32_MAX;
}

/* Lists the triangles of the surface. `parts`: faces are given in parts, or NULL. `inside`: those that lie on other
 * blocks, or NULL. */
static tl_status list_surface(tl_block_zones *of, const tl_zone_parts *parts, const uint8_t *inside, tl_error *error)
{
    const tl_zone_mesh *mesh = &of->mesh;
    free_sides sides;
    of->surface = malloc(((size_t)mesh->triangle_count + 1) * sizeof *of->surface);
    const bool enough = list_free_sides(mesh, &sides) && of->surface;
    bool whole = true;
    for (uint32_t t = 0; enough && t < mesh->triangle_count; t++) {
        const tl_zone_triangle *from = &mesh->triangle[t];
        tl_surface_part *to = &of->surface[of->surface_count];
        if (from->face == TL_ZONE_BETWEEN || (inside && inside[from->face]))
            continue;
        *to = (tl_surface_part){.face = parts ? parts->face_of[from->face] : from->face, .block = of->block};
        memcpy(to->corner, from->corner, sizeof to->corner);
        to->apex = apex_of(mesh, &sides, from->corner);
        whole = whole && to->apex != UINT32_MAX;
        of->surface_count++;
    }
    free(sides.start);
    free(sides.side);
    if (enough && !whole)
        return tl_fail(error, TL_E_GEOMETRY, "its zones do not end at its faces");
    return enough ? TL_OK : tl_fail_memory(error);
}

/* Clusters of the zones. */
static tl_status gather(tl_block_zones *of, tl_error *error)
{
    return tl_zone_clusters_make((const uint32_t(*)[4])of->mesh.zone, (const uint32_t(*)[4])of->mesh.beside,
                                 of->mesh.zone_count, &of->clusters, error);
}

static tl_status named(tl_status status, const tl_block_zones *of, tl_error *error)
{
    return status == TL_OK ? TL_OK : tl_error_prefix(error, "block %u: ", of->block);
}

tl_status tl_block_zones_take(tl_block_zones *of, tl_id block, tl_zone_mesh *mesh, tl_error *error)
{
    *of = (tl_block_zones){.block = block, .mesh = *mesh};
    *mesh = (tl_zone_mesh){0};
    return named(gather(of, error), of, error);
}

tl_status tl_block_zones_surface(tl_block_zones *of, tl_error *error)
{
    return named(list_surface(of, NULL, NULL, error), of, error);
}

tl_status tl_block_zones_make(tl_block_zones *of, tl_id block, const tl_poly *shape, const tl_shape_zoning *zoning,
                              const uint8_t *inside, tl_zone_scratch *scratch, tl_error *error)
{
    *of = (tl_block_zones){.block = block};
    tl_status status = tl_zoning_make(shape, zoning, scratch, &of->mesh, error);
    if (status == TL_OK)
        status = gather(of, error);
    if (status == TL_OK)
        status = list_surface(of, zoning->parts, inside, error);
    return named(status, of, error);
}

void tl_block_zones_free(tl_block_zones *of)
{
    tl_zone_mesh_free(&of->mesh);
    tl_zone_clusters_free(&of->clusters);
    free(of->surface);
    *of = (tl_block_zones){0};
}
