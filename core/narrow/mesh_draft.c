/* mesh_draft.c - a new mesh of the polygons of a pressure field: their corners by the planes that meet there
 * (field_mesh.c). */
#include "narrow/mesh_draft.h"

#include <string.h>

#define LANES TL_LANES

/* Whether the normal of one line comes before that of another, counterclockwise. */
static bool before(const tl_field_line *line, unsigned lane, size_t i, size_t j)
{
    double it = line[i].gt[lane], is = line[i].gs[lane];
    double jt = line[j].gt[lane], js = line[j].gs[lane];
    bool low_i = is < 0 || (is == 0 && it < 0), low_j = js < 0 || (js == 0 && jt < 0);
    return low_i != low_j ? low_j : it * js - is * jt > 0;
}

void tl_mesh_draw(tl_mesh_draft *draft, const uint16_t own[2], const uint16_t *bound,
                  const tl_field_line *line, size_t lines, unsigned lane)
{
    uint8_t side[TL_MESH_SIDES];
    uint32_t sides = 0;
    draft->full = draft->full || draft->polygons == TL_MESH_POLYGONS;
    for (size_t k = 0; k < lines && !draft->full; k++) {
        if (!(line[k].to[lane] > line[k].from[lane]) || line[k].c[lane] >= TL_FIELD_FAR)
            continue;
        draft->full = draft->labels + sides == TL_MESH_SIDES;
        if (draft->full)
            break;
        uint32_t at = sides++;
        for (; at > 0 && before(line, lane, k, side[at - 1]); at--)
            side[at] = side[at - 1];
        side[at] = (uint8_t)k;
    }
    if (draft->full)
        return;
    uint32_t polygon = draft->polygons++;
    draft->own[polygon][0] = (uint8_t)own[0];
    draft->own[polygon][1] = (uint8_t)own[1];
    draft->sides[polygon] = (uint8_t)sides;
    for (uint32_t k = 0; k < sides; k++)
        draft->label[draft->labels++] = side[k] ? (uint8_t)bound[side[k] - 1] : TL_MESH_ZERO;
}

/* The number of a corner of four planes, which is added when there is none; TL_MESH_CORNERS: there is no room. */
static uint32_t corner_of(tl_field_mesh *mesh, const uint8_t own[2], uint8_t one, uint8_t other)
{
    uint8_t plane[4] = {own[0], own[1], one, other};
    for (int i = 1; i < 4; i++)
        for (int k = i; k > 0 && plane[k] < plane[k - 1]; k--) {
            uint8_t swap = plane[k];
            plane[k] = plane[k - 1];
            plane[k - 1] = swap;
        }
    for (uint32_t corner = 0; corner < mesh->corners; corner++) {
        bool same = true;
        for (int k = 0; k < 4; k++)
            same = same && mesh->plane[k][corner] == plane[k];
        if (same)
            return corner;
    }
    if (mesh->corners == TL_MESH_CORNERS)
        return TL_MESH_CORNERS;
    for (int k = 0; k < 4; k++)
        mesh->plane[k][mesh->corners] = plane[k];
    return mesh->corners++;
}

/* Whether a polygon is part of S. */
static bool on_surface(const tl_field_mesh *mesh, const tl_field_faces *f, uint32_t polygon)
{
    return mesh->own[polygon][0] < f->a && mesh->own[polygon][1] >= f->a &&
           mesh->own[polygon][1] < f->a + f->b;
}

/* Whether another polygon of S has a side between two corners, the other way round. */
static bool has_neighbour(const tl_field_mesh *mesh, const tl_field_faces *f, uint32_t polygon,
                          uint8_t from, uint8_t to)
{
    const uint8_t *loop = mesh->loop;
    for (uint32_t k = 0; k < mesh->polygons; loop += mesh->sides[k++])
        for (uint32_t i = 0; i < mesh->sides[k] && k != polygon && on_surface(mesh, f, k); i++)
            if (loop[i] == to && loop[i + 1 < mesh->sides[k] ? i + 1 : 0] == from)
                return true;
    return false;
}

/* Whether the polygon of two planes has a side between two corners. */
static bool has_side(const tl_field_mesh *mesh, uint8_t one, uint8_t other, uint8_t from,
                     uint8_t to)
{
    const uint8_t *loop = mesh->loop;
    for (uint32_t k = 0; k < mesh->polygons; loop += mesh->sides[k++]) {
        if (mesh->own[k][0] != (one < other ? one : other) ||
            mesh->own[k][1] != (one < other ? other : one))
            continue;
        for (uint32_t i = 0; i < mesh->sides[k]; i++) {
            uint8_t next = loop[i + 1 < mesh->sides[k] ? i + 1 : 0];
            if ((loop[i] == from && next == to) || (loop[i] == to && next == from))
                return true;
        }
    }
    return false;
}

/* Whether all polygons are there that meet in a side of a polygon: of its two planes and that of the label two by two,
 * but for two borders. */
static bool has_all(const tl_field_mesh *mesh, const tl_field_faces *f, uint32_t polygon,
                    uint8_t label, uint8_t from, uint8_t to)
{
    for (int own = 0; own < 2; own++) {
        uint8_t by = mesh->own[polygon][own];
        bool borders = by >= f->a + f->b && label >= f->a + f->b;
        if (!borders && !has_side(mesh, by, label, from, to))
            return false;
    }
    return true;
}

/* Whether the polygons hang together: with seams all of them, else those of S. A side on the surface of K, with d = 0,
 * belongs to one only. The label of a side is that between its corner and the one before. */
static bool hangs_together(const tl_field_mesh *mesh, const tl_mesh_draft *draft,
                           const tl_field_faces *f)
{
    const uint8_t *loop = mesh->loop, *label = draft->label;
    for (uint32_t k = 0; k < mesh->polygons; k++) {
        uint32_t sides = mesh->sides[k];
        for (uint32_t i = 0; i < sides; i++) {
            uint8_t from = loop[i ? i - 1 : sides - 1], to = loop[i];
            if (label[i] == TL_MESH_ZERO || !(f->seamed || on_surface(mesh, f, k)))
                continue;
            if (!(f->seamed ? has_all(mesh, f, k, label[i], from, to)
                            : has_neighbour(mesh, f, k, from, to)))
                return false;
        }
        loop += sides;
        label += sides;
    }
    return true;
}

void tl_mesh_make(const tl_mesh_draft *draft, const tl_field_faces *faces, tl_field_mesh *mesh)
{
    const uint8_t *label = draft->label;
    uint8_t *loop = mesh->loop;
    uint64_t bounding = mesh->bounding;
    memset(mesh, 0, sizeof *mesh);
    mesh->bounding = bounding;
    if (draft->full || draft->polygons == 0 || !faces->inner || faces->inner->count > TL_MESH_INNER)
        return;
    bool fits = true;
    for (uint32_t k = 0; k < draft->polygons && fits; k++) {
        uint32_t sides = draft->sides[k];
        memcpy(mesh->own[k], draft->own[k], sizeof mesh->own[k]);
        mesh->sides[k] = (uint8_t)sides;
        fits = sides > 2;
        for (uint32_t i = 0; i < sides && fits; i++) {
            uint32_t corner =
                corner_of(mesh, draft->own[k], label[i], label[i + 1 < sides ? i + 1 : 0]);
            fits = corner < TL_MESH_CORNERS;
            *loop++ = (uint8_t)corner;
        }
        label += sides;
    }
    for (uint32_t k = 0; k < faces->inner->count && fits; k++) {
        const uint8_t *face = faces->inner->face[k];
        fits = corner_of(mesh, face, face[2], TL_MESH_ZERO) < TL_MESH_CORNERS;
    }
    for (uint32_t i = mesh->corners; i % LANES; i++) /* what is left of eight is the first again */
        for (int k = 0; k < 4; k++)
            mesh->plane[k][i] = mesh->plane[k][0];
    mesh->polygons = draft->polygons;
    if (!fits || !hangs_together(mesh, draft, faces)) {
        memset(mesh, 0, sizeof *mesh);
        mesh->bounding = bounding;
    }
}
