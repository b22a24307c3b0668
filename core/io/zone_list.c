/* zone_list.c - see zone_list.h. */
#include "io/zone_list.h"

#include "base/error.h"

#include <stdlib.h>
#include <string.h>

/* Numbers of the meshes in the order of their bodies. */
static void sort_meshes(const struct tl_zones *z, uint32_t *list)
{
    for (uint32_t k = 0; k < z->mesh_count; k++) {
        uint32_t at = k;
        for (; at > 0 && z->mesh[list[at - 1]].body > z->mesh[k].body; at--)
            list[at] = list[at - 1];
        list[at] = k;
    }
}

/* Lists the zones of mesh k. Gives the number of the next cluster. */
static uint32_t list_zones(tl_zone_list *l, size_t k, uint32_t cluster)
{
    const struct tl_zones *z = l->of;
    const tl_body_mesh *mesh = &z->mesh[l->mesh[k]];
    for (uint32_t p = mesh->parcel_begin; p < mesh->parcel_end; p++)
        for (uint32_t g = z->parcels.of[p].group_begin; g < z->parcels.of[p].group_end; g++)
            for (uint32_t lane = 0; lane < TL_LANES; lane++) {
                const tl_zone_group *group = &z->group[g];
                for (uint32_t i = 0; i < group->count[lane]; i++) {
                    const uint32_t row = group->start + TL_LANES * i + lane;
                    const uint32_t at = l->zone_start[k] + z->zones.number[row];
                    l->zone_name[at] = (tl_zone_name){mesh->body, z->zones.number[row]};
                    l->row[at] = row;
                    l->parcel[at] = p;
                    l->cluster[at] = cluster;
                }
                cluster += group->count[lane] > 0;
            }
    return cluster;
}

static bool make_room(tl_zone_list *l)
{
    l->zone_name = malloc((l->zones + 1) * sizeof *l->zone_name);
    l->point_name = malloc((l->points + 1) * sizeof *l->point_name);
    l->row = malloc((l->zones + 1) * sizeof *l->row);
    l->parcel = malloc((l->zones + 1) * sizeof *l->parcel);
    l->cluster = malloc((l->zones + 1) * sizeof *l->cluster);
    return l->zone_name && l->point_name && l->row && l->parcel && l->cluster;
}

/* Counts what each mesh has. */
static bool list_meshes(tl_zone_list *l)
{
    const struct tl_zones *z = l->of;
    l->meshes = z ? z->mesh_count : 0;
    l->mesh = malloc((l->meshes + 1) * sizeof *l->mesh);
    l->zone_start = calloc(l->meshes + 1, sizeof *l->zone_start);
    l->point_start = calloc(l->meshes + 1, sizeof *l->point_start);
    l->part_start = calloc(l->meshes + 1, sizeof *l->part_start);
    if (!l->mesh || !l->zone_start || !l->point_start || !l->part_start)
        return false;
    if (z)
        sort_meshes(z, l->mesh);
    for (size_t k = 0; k < l->meshes; k++) {
        const tl_body_mesh *mesh = &z->mesh[l->mesh[k]];
        l->zone_start[k + 1] = l->zone_start[k] + mesh->zone_end - mesh->zone_begin;
        l->point_start[k + 1] = l->point_start[k] + mesh->point_end - mesh->point_begin;
        l->part_start[k + 1] = l->part_start[k] + mesh->part_end - mesh->part_begin;
    }
    l->zones = l->zone_start[l->meshes];
    l->points = l->point_start[l->meshes];
    l->parts = l->part_start[l->meshes];
    return true;
}

tl_status tl_zone_list_make(tl_model *m, tl_zone_list *list)
{
    *list = (tl_zone_list){.of = m->zones};
    if (!list_meshes(list) || !make_room(list))
        return tl_fail_memory(&m->error);
    uint32_t cluster = 0;
    for (size_t k = 0; k < list->meshes; k++) {
        const tl_id body = m->zones->mesh[list->mesh[k]].body;
        cluster = list_zones(list, k, cluster);
        for (uint32_t i = list->point_start[k]; i < list->point_start[k + 1]; i++)
            list->point_name[i] = (tl_zone_name){body, i - list->point_start[k]};
    }
    return TL_OK;
}

void tl_zone_list_free(tl_zone_list *list)
{
    free(list->mesh);
    free(list->zone_start);
    free(list->point_start);
    free(list->part_start);
    free(list->zone_name);
    free(list->point_name);
    free(list->row);
    free(list->parcel);
    free(list->cluster);
    *list = (tl_zone_list){0};
}

static bool is_among(const tl_state *const *states, size_t count, const char *name)
{
    bool found = false;
    for (size_t k = 0; k < count && !found; k++)
        found = strcmp(states[k]->name, name) == 0;
    return found;
}

size_t tl_zone_states(const tl_model *m, const tl_state *states[TL_ZONE_STATES])
{
    const struct tl_zones *z = m->zones;
    size_t count = 0;
    for (size_t i = 0; z && i < z->solid_count; i++)
        for (uint32_t k = 0; k < z->solid[i].of.kind->state_count && count < TL_ZONE_STATES; k++) {
            const tl_state *state = tl_kind_state(z->solid[i].of.kind, k);
            if (!is_among(states, count, state->name))
                states[count++] = state;
        }
    return count;
}
