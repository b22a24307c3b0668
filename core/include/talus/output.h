/* talus/output.h - files of a model: frames for ParaView, block models. A file appears whole or not at all. */
#ifndef TALUS_OUTPUT_H
#define TALUS_OUTPUT_H

#include <talus/plugin.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

struct tl_model;
struct tl_halfspace;

/* Writes the next frame of the section of all blocks by a plane: PREFIX_section_NNNNNN.vtk and its index. */
TL_API tl_status tl_write_section(struct tl_model *model, const char *prefix,
                                  const struct tl_halfspace *plane);

/* The files of a frame. */
typedef struct tl_vtk_parts {
    uint32_t size; /* sizeof(tl_vtk_parts) */
    int32_t blocks, contacts, joints;
} tl_vtk_parts;
/* Writes the next frame of the series PREFIX: PREFIX_blocks_NNNNNN.vtk, _contacts_ and _joints_, or those of `parts`, and
 * PREFIX_{blocks,contacts,joints}.vtk.series. Folders are made as needed. Files of one number are of one frame. */
TL_API tl_status tl_write_vtk(struct tl_model *model, const char *prefix,
                              const tl_vtk_parts *parts);

/* Writes all blocks as they stand into a JSON file (docs/block_model.md), from which the generator of
 * that format makes them again. */
TL_API tl_status tl_write_blocks(struct tl_model *model, const char *path);

/* Writes a file of `length` bytes, whole or not at all, making the folders on the way. Only a regular file is replaced. */
TL_API tl_status tl_write_file(const char *path, const void *data, size_t length, tl_error *error);

#ifdef __cplusplus
}
#endif
#endif
