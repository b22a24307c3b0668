/* pair.c - which tetrahedra of a mesh hang together: those that have a side in common.
 *
 * Sides are listed by the lowest of their points, so that a list is short. */
#include "mesh/pair.h"

#include <stdlib.h>
#include <talus/number.h>

const uint8_t tl_mesh_side[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

const char *tl_mesh_where(const tl_mesh *m, uint32_t zone, char text[TL_MESH_WHERE])
{
    if (m->line[zone] > 0)
        tl_text_print(text, TL_MESH_WHERE, "file '%.200s', line %u: %s %u", m->file, m->line[zone], m->cell,
                      m->number[zone]);
    else
        tl_text_print(text, TL_MESH_WHERE, "file '%.200s': %s %u", m->file, m->cell, m->number[zone]);
    return text;
}

void tl_mesh_side_corners(const tl_mesh *m, uint32_t side, uint32_t corner[3])
{
    for (int k = 0; k < 3; k++)
        corner[k] = m->zone[side / 4][tl_mesh_side[side % 4][k]];
}

static uint32_t lowest_of(const tl_mesh *m, uint32_t side)
{
    uint32_t v[3];
    tl_mesh_side_corners(m, side, v);
    const uint32_t low = v[0] < v[1] ? v[0] : v[1];
    return low < v[2] ? low : v[2];
}

/* How two sides lie on each other: 0 they do not, 1 face to face, -1 their tetrahedra are on the same side. */
static int meet(const tl_mesh *m, uint32_t a, uint32_t b)
{
    uint32_t v[3], w[3];
    tl_mesh_side_corners(m, a, v);
    tl_mesh_side_corners(m, b, w);
    for (int k = 0; k < 3; k++) {
        if (w[k] != v[0])
            continue;
        const uint32_t after = w[(k + 1) % 3], before = w[(k + 2) % 3];
        return after == v[2] && before == v[1] ? 1 : after == v[1] && before == v[2] ? -1 : 0;
    }
    return 0;
}

static tl_status refuse(const tl_mesh *m, uint32_t a, uint32_t b, const char *what, tl_error *error)
{
    char where[TL_MESH_WHERE];
    uint32_t v[3];
    tl_mesh_side_corners(m, a, v);
    const tl_vec3 x = m->point[v[0]];
    return tl_fail(error, TL_E_GEOMETRY, "%s and %s %u %s of the points %u, %u and %u near {%g, %g, %g}; mend the mesh",
                   tl_mesh_where(m, a / 4, where), m->cell, m->number[b / 4], what, m->node[v[0]], m->node[v[1]],
                   m->node[v[2]], x.x, x.y, x.z);
}

/* Pairs a side with one of those listed after it. */
static tl_status pair_side(const tl_mesh *m, const uint32_t *owner, const uint32_t *list, uint32_t count, uint32_t *on,
                           tl_error *error)
{
    const uint32_t side = list[0];
    for (uint32_t k = 1; k < count; k++) {
        const int how = owner[side / 4] == owner[list[k] / 4] ? meet(m, side, list[k]) : 0;
        if (how == 0)
            continue;
        if (how < 0)
            return refuse(m, side, list[k], "overlap: they lie on the same side of the triangle", error);
        if (on[side] != TL_MESH_NONE || on[list[k]] != TL_MESH_NONE)
            return refuse(m, side, list[k], "are not the only two at the side", error);
        on[side] = list[k];
        on[list[k]] = side;
    }
    return TL_OK;
}

tl_status tl_mesh_pair(const tl_mesh *m, const uint32_t *owner, uint32_t *on, tl_error *error)
{
    const uint32_t sides = 4 * m->zone_count;
    uint32_t *start = calloc((size_t)m->point_count + 2, sizeof *start);
    uint32_t *list = malloc(((size_t)sides + 1) * sizeof *list);
    tl_status status = start && list ? TL_OK : tl_fail_memory(error);
    for (uint32_t s = 0; status == TL_OK && s < sides; s++) {
        on[s] = TL_MESH_NONE;
        if (owner[s / 4] != TL_MESH_NONE)
            start[lowest_of(m, s) + 2]++;
    }
    for (uint32_t p = 0; status == TL_OK && p < m->point_count; p++)
        start[p + 2] += start[p + 1];
    for (uint32_t s = 0; status == TL_OK && s < sides; s++)
        if (owner[s / 4] != TL_MESH_NONE)
            list[start[lowest_of(m, s) + 1]++] = s;
    for (uint32_t p = 0; status == TL_OK && p < m->point_count; p++)
        for (uint32_t k = start[p]; status == TL_OK && k < start[p + 1]; k++)
            status = pair_side(m, owner, list + k, start[p + 1] - k, on, error);
    free(start);
    free(list);
    return status;
}
