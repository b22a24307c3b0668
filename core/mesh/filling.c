/* filling.c - what readers of the formats of meshes fill in. */
#include "mesh/filling.h"

#include "base/table.h"

#include <stdlib.h>
#include <string.h>

tl_status tl_mesh_hold_points(tl_mesh_reading *r, size_t count)
{
    tl_mesh *m = r->mesh;
    if (tl_grow(&m->point, &m->point_room, count, sizeof *m->point) &&
        tl_grow(&m->node, &m->node_room, count, sizeof *m->node))
        return TL_OK;
    return tl_fail_memory(r->text.error);
}

tl_status tl_mesh_add(tl_mesh_reading *r, const uint32_t corner[4], uint32_t number, uint32_t line, tl_mesh_key key)
{
    tl_mesh *m = r->mesh;
    const size_t count = (size_t)m->zone_count + 1;
    if (!tl_grow(&m->zone, &m->zone_room, count, sizeof *m->zone) ||
        !tl_grow(&m->number, &m->number_room, count, sizeof *m->number) ||
        !tl_grow(&m->line, &m->line_room, count, sizeof *m->line) ||
        !tl_grow(&r->key, &r->key_room, count, sizeof *r->key))
        return tl_fail_memory(r->text.error);
    memcpy(m->zone[m->zone_count], corner, sizeof *m->zone);
    m->number[m->zone_count] = number;
    m->line[m->zone_count] = line;
    r->key[m->zone_count++] = key;
    return TL_OK;
}

tl_status tl_mesh_name_group(tl_mesh_reading *r, double group, const char *text, size_t length)
{
    char *copy = malloc(length + 1);
    if (!copy || !tl_grow(&r->name, &r->name_room, r->name_count + 1, sizeof *r->name)) {
        free(copy);
        return tl_fail_memory(r->text.error);
    }
    memcpy(copy, text, length);
    copy[length] = '\0';
    r->name[r->name_count++] = (tl_mesh_name){group, copy};
    return TL_OK;
}
