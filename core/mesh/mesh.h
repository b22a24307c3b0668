/* mesh.h - tetrahedra of a file, made by another program or written by Talus.
 *
 * A side of a tetrahedron is named by the corner that lies opposite. Tetrahedra of one *region* have the same group,
 * and the same entity or block, in the file. */
#ifndef TL_MESH_MESH_H
#define TL_MESH_MESH_H

#include <stddef.h>
#include <talus/plugin.h>

/* Most tetrahedra and most points: sides are numbered in 32 bits. */
#define TL_MESH_MOST 0x3fffffffu
#define TL_MESH_NONE UINT32_MAX

typedef struct tl_mesh {
    const char *file; /* its name, of the caller */
    const char *cell; /* what it calls a tetrahedron */
    tl_vec3 *point;   /* [point_count] */
    uint32_t *node;   /* [point_count] the file's numbers of them */
    uint32_t point_count;
    uint32_t (*zone)[4]; /* [zone_count] points; every volume is positive */
    uint32_t *number;    /* [zone_count] the file's numbers of them */
    uint32_t *line;      /* [zone_count] where they are; 0: the file is binary */
    uint32_t *region;    /* [zone_count] */
    uint32_t zone_count;
    char **group; /* [region_count] its name; "": it has none */
    uint32_t region_count;
    size_t point_room, node_room, zone_room, number_room, line_room;
} tl_mesh;

#endif
