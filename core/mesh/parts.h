/* parts.h - the convex solids that a mesh fills. */
#ifndef TL_MESH_PARTS_H
#define TL_MESH_PARTS_H

#include "base/error.h"
#include "mesh/mesh.h"

typedef struct tl_mesh_parts {
    tl_mesh mesh;
    tl_mesh_part *list; /* in the order of their first tetrahedra */
    size_t count;
    tl_vec3 *corner; /* of all */
    size_t corner_count, list_room, corner_room;
} tl_mesh_parts;

/* Reads a file, and finds the parts: tetrahedra of one region that hang together. TL_E_GEOMETRY also for a part that is
 * not convex. Free *parts in any case. */
tl_status tl_mesh_parts_read(const char *file, tl_mesh_parts *parts, tl_error *error);
void tl_mesh_parts_free(tl_mesh_parts *parts);

#endif
