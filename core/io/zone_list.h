/* zone_list.h - the zones and gridpoints of all deformable bodies, as files and pictures list them: body by body in the
 * order of their ids, each by its numbers in the body. That is the order of tl_zones_select. */
#ifndef TL_IO_ZONE_LIST_H
#define TL_IO_ZONE_LIST_H

#include "base/kind_states.h"
#include "zone/zones.h"

typedef struct tl_zone_list {
    const struct tl_zones *of;
    size_t meshes, zones, points, parts;
    uint32_t *mesh;                                  /* [meshes] its number in the tables */
    uint32_t *zone_start, *point_start, *part_start; /* [meshes + 1] */
    tl_zone_name *zone_name, *point_name;            /* [zones], [points] */
    uint32_t *row, *parcel, *cluster;                /* [zones]; clusters are counted from 0 */
} tl_zone_list;

/* Lists them; rows are tidy. Freed by tl_zone_list_free, also after a failure: out of memory. */
tl_status tl_zone_list_make(tl_model *m, tl_zone_list *list);
void tl_zone_list_free(tl_zone_list *list);

/* The number in the list of a gridpoint of mesh k of the list, by its row. */
static inline uint32_t tl_zone_list_point(const tl_zone_list *l, size_t k, uint32_t row)
{
    return l->point_start[k] + row - l->of->mesh[l->mesh[k]].point_begin;
}

/* The row of corner a of zone i. */
static inline uint32_t tl_zone_list_corner(const tl_zone_list *l, size_t i, int a)
{
    return l->of->listed[l->of->parcels.of[l->parcel[i]].point_begin + l->of->zones.corner[a][l->row[i]]];
}

/* Rows of the bodies' surface triangles, mesh by mesh: triangle i of mesh k of the list. */
static inline const tl_surface_part *tl_zone_list_part(const tl_zone_list *l, size_t k, size_t i)
{
    return &l->of->part[l->of->mesh[l->mesh[k]].part_begin + i];
}

/* Limit: different states of solids that files and pictures show. */
#define TL_ZONE_STATES 64
/* The states that solids of the model have, each name once, in the order of the solids. Returns how many. */
size_t tl_zone_states(const tl_model *m, const tl_state *states[TL_ZONE_STATES]);

#endif
