/* sound.c - whether zones that were read from a file fit together. The file may hold anything. What is used as the
 * number of a row, a corner or a solid must be one. Places and masses are what they can be. */
#include "zone/sound.h"

#include <math.h>

static bool points_are_sound(const struct tl_zones *z)
{
    const tl_gridpoints *p = &z->points;
    bool sound = p->table.rows % TL_LANES == 0 && p->table.rows < TL_NO_ROW;
    for (size_t row = 0; sound && row < p->table.rows; row++) {
        for (int k = 0; k < 3; k++)
            sound = sound && fabs(p->ref[k][row]) <= TL_FARTHEST && fabs(p->u[k][row]) <= TL_FARTHEST;
        sound = sound && p->mass[row] >= TL_LEAST_MEASURE && p->mass[row] <= TL_MOST_MEASURE &&
                p->mesh[row] < z->mesh_count && p->fixed[row] <= (TL_FIX_X | TL_FIX_Y | TL_FIX_Z) &&
                p->stiffness[row] >= 0;
    }
    return sound;
}

/* Ranges that follow each other from 0 on, up to an end. */
static bool follows(uint32_t begin, uint32_t end, uint32_t *next)
{
    const bool sound = begin == *next && end >= begin;
    *next = end;
    return sound;
}

static bool groups_are_sound(const struct tl_zones *z)
{
    size_t row = 0;
    bool sound = true;
    for (size_t k = 0; sound && k < z->group_count; k++) {
        const tl_zone_group *g = &z->group[k];
        sound = g->start == row && g->depth > 0 && g->depth <= TL_CLUSTER_MOST;
        row += (size_t)g->depth * TL_LANES;
        for (size_t l = 0; l < TL_LANES; l++)
            sound = sound && g->count[l] <= g->depth && isfinite(g->extent[l]);
    }
    return sound && row == z->zones.table.rows;
}

/* Whether a block is one of the body of a mesh. */
static bool has_block(const tl_model *m, const tl_body_mesh *mesh, tl_id block)
{
    const uint32_t row = tl_block_row_quiet(m, block);
    return row != TL_NO_ROW && m->blocks.body[row] == mesh->row;
}

static bool parcels_are_sound(const tl_model *m, const struct tl_zones *z)
{
    uint32_t groups = 0, points = 0;
    bool sound = true;
    for (size_t k = 0; sound && k < z->parcels.table.rows; k++) {
        const tl_parcel *of = &z->parcels.of[k];
        sound = of->mesh < z->mesh_count && of->solid < z->solid_count && has_block(m, &z->mesh[of->mesh], of->block) &&
                follows(of->group_begin, of->group_end, &groups) && groups <= z->group_count &&
                of->group_end > of->group_begin && follows(of->point_begin, of->point_end, &points) &&
                points <= z->listed_count && of->point_end - of->point_begin <= TL_PARCEL_POINTS;
        for (uint32_t g = of->group_begin; sound && g < of->group_end; g++)
            for (size_t row = z->group[g].start; row < z->group[g].start + (size_t)z->group[g].depth * TL_LANES; row++)
                for (int a = 0; a < 4; a++)
                    sound = sound && z->zones.corner[a][row] < of->point_end - of->point_begin;
    }
    for (size_t k = 0; sound && k < z->listed_count; k++)
        sound = z->listed[k] < z->points.table.rows;
    return sound && groups == z->group_count && points == z->listed_count;
}

static bool meshes_are_sound(const tl_model *m, const struct tl_zones *z)
{
    uint32_t points = 0, parcels = 0, zones = 0, parts = 0;
    bool sound = true;
    for (size_t k = 0; sound && k < z->mesh_count; k++) {
        const tl_body_mesh *mesh = &z->mesh[k];
        uint32_t padded = (mesh->point_end + TL_LANES - 1) / TL_LANES * TL_LANES;
        sound = mesh->row < m->bodies.table.rows && m->bodies.id[mesh->row] == mesh->body &&
                m->bodies.fixed[mesh->row] == TL_FIX_ALL && mesh->point_end <= padded &&
                follows(mesh->point_begin, padded, &points) && mesh->point_end > mesh->point_begin &&
                follows(mesh->parcel_begin, mesh->parcel_end, &parcels) && mesh->parcel_end > mesh->parcel_begin &&
                follows(mesh->zone_begin, mesh->zone_end, &zones) && follows(mesh->part_begin, mesh->part_end, &parts);
    }
    return sound && points == z->points.table.rows && parcels == z->parcels.table.rows && zones == z->row_of_count &&
           parts == z->part_count;
}

static bool parts_are_sound(const tl_model *m, const struct tl_zones *z)
{
    bool sound = true;
    for (size_t k = 0; sound && k < z->row_of_count; k++)
        sound = z->row_of[k] < z->zones.table.rows;
    for (size_t k = 0; sound && k < z->part_count; k++) {
        const tl_surface_part *part = &z->part[k];
        const uint32_t row = tl_block_row_quiet(m, part->block);
        sound = row != TL_NO_ROW && part->face < m->blocks.shape[row]->face_count;
        for (int c = 0; c < 3; c++)
            sound = sound && part->corner[c] < z->points.table.rows;
        sound = sound && part->apex < z->points.table.rows;
    }
    return sound;
}

static bool outer_is_sound(const struct tl_zones *z)
{
    bool sound = true;
    for (size_t k = 0; sound && k < z->outer_count; k++) {
        const tl_outer_part *of = &z->outer[k];
        double bare = 0;
        for (int i = 0; i < 6; i++)
            bare += of->bare.of[i];
        const tl_vec3 all = tl_v3(bare + of->density, of->at, tl_v3_norm2(of->along));
        sound = of->part < z->part_count && (k == 0 || of->part > z->outer[k - 1].part) && of->solid < z->solid_count &&
                of->fixed <= (TL_FIX_X | TL_FIX_Y | TL_FIX_Z) && of->density >= 0 && tl_v3_finite(all) &&
                z->points.pushed[0] && (!of->quiet || z->points.quiet[0]) &&
                (tl_v3_norm2(of->along) == 0 || z->points.held[0][0]) && (!of->drive || z->points.drive);
    }
    return sound;
}

const char *tl_zones_unsound(const tl_model *m, const struct tl_zones *z)
{
    if (z->mesh_count >= TL_NO_ROW || !points_are_sound(z))
        return "a gridpoint has an impossible value";
    if (!meshes_are_sound(m, z))
        return "meshes do not fit their bodies";
    if (!groups_are_sound(z) || !parcels_are_sound(m, z))
        return "zones do not fit their meshes";
    if (!parts_are_sound(m, z))
        return "the surface of a mesh does not fit its block";
    return outer_is_sound(z) ? NULL : "what acts on the surface of a mesh has an impossible value";
}
