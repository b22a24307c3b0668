/* mesh.h - triangles over faces of blocks, for a liner. */
#ifndef LINER_MESH_H
#define LINER_MESH_H

#include <talus/plugin.h>

#include <stdbool.h>

/* Limit: triangles of one patch. */
#define PATCH_TRIANGLES (TL_ELEMENT_MANY / 3)

/* Corners are counter-clockwise from outside of the rock; `face` is that of the list. */
typedef struct mesh_triangle {
    uint32_t node[3], face;
} mesh_triangle;

typedef struct mesh {
    tl_vec3 *at; /* m, of nodes */
    size_t nodes, node_capacity;
    mesh_triangle *of;
    size_t count, capacity;
    uint32_t *patch; /* [patches + 1], where patches of triangles begin */
    size_t patches, patch_capacity;
} mesh;

/* Covers faces, which are convex, by triangles whose sides are `spacing` long at most. Corners of faces that lie closer
 * to each other than a part of the spacing are one node. Nodes of a patch ascend along it. false: out of memory; free
 * it in any case. */
bool mesh_make(mesh *m, const tl_element_face *faces, size_t count, double spacing);
void mesh_free(mesh *m);

/* Places of triangles and nodes along the longest way through a patch: numbers its nodes from 0 on in that order, into
 * `number` [3 for each triangle]. */
bool mesh_number(const mesh *m, size_t patch, uint32_t *number);

#endif
