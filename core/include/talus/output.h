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
struct tl_keyblocks;

/* Writes the next frame of the section of all blocks by a plane: PREFIX_section_NNNNNN.vtk and its index. */
TL_API tl_status tl_write_section(struct tl_model *model, const char *prefix, const struct tl_halfspace *plane);

/* A number of each block or of each contact, beside their fields. */
typedef struct tl_extra_field {
    const char *name, *unit; /* unit: NULL or "" for none */
    const double *values;    /* in the order of tl_blocks_select or tl_contacts_select, of all; NaN: none */
    size_t count;
} tl_extra_field;

/* The files of a frame, and what is added to their arrays. */
typedef struct tl_vtk_parts {
    uint32_t size; /* sizeof(tl_vtk_parts) */
    int32_t blocks, contacts, joints;
    const tl_extra_field *block_fields, *contact_fields; /* the latter go to contacts and joints */
    size_t block_field_count, contact_field_count;
    int32_t zones;                     /* since 1.10: of deformable blocks, where there are any */
    const tl_extra_field *zone_fields; /* since 1.10: of each zone of all blocks, as tl_zones_select gives them */
    size_t zone_field_count;           /* since 1.10 */
    int32_t elements;                  /* since 1.13: where there are any */
} tl_vtk_parts;
/* Writes the next frame of the series PREFIX: PREFIX_blocks_NNNNNN.vtk, _contacts_, _joints_ and, where blocks are
 * deformable, _zones_, and where there are elements, _elements_, or those of `parts`. For each there is a list, as
 * PREFIX_blocks.vtk.series. Folders are made as needed. Files of one number are of one frame. */
TL_API tl_status tl_write_vtk(struct tl_model *model, const char *prefix, const tl_vtk_parts *parts);

/* Which contacts a frame of a page has. */
typedef enum tl_html_contacts {
    TL_HTML_CONTACTS_FEW, /* all, where there are 20,000 at the most, else those that slip */
    TL_HTML_CONTACTS_ALL,
    TL_HTML_CONTACTS_SLIPPING, /* those in the state "slipping" */
    TL_HTML_CONTACTS_NONE
} tl_html_contacts;

/* What a page shows beside the blocks and the histories of the model. */
typedef struct tl_html {
    uint32_t size;     /* sizeof(tl_html) */
    int32_t contacts;  /* tl_html_contacts */
    const char *title; /* NULL: the name at the end of the prefix */
    const tl_extra_field *block_fields, *contact_fields;
    size_t block_field_count, contact_field_count;
    const struct tl_keyblocks *keyblocks; /* NULL: none */
    double safety_limit;                  /* factor of safety that is asked for, marked in the legend; 0: none */
} tl_html;
/* Adds a frame to the page PREFIX.html, for a browser (docs/screen.md). The first frame of a model replaces what is
 * there. Later ones go on with the page where it is as the model left it, else they begin it anew. A page of more than
 * 200 MB is refused (TL_E_ARGUMENT). */
TL_API tl_status tl_write_html(struct tl_model *model, const char *prefix, const tl_html *options);

/* Writes all blocks as they stand into a JSON file (docs/block_model.md), from which the generator `blocks` makes them
 * again. A name that ends in .obj, .stl, .ply or .vtk gets their surfaces in that format, which the generator `import`
 * and other programs read. */
TL_API tl_status tl_write_blocks(struct tl_model *model, const char *path);

/* Writes a file of `length` bytes, whole or not at all, making the folders on the way. Only a regular file is
 * replaced. */
TL_API tl_status tl_write_file(const char *path, const void *data, size_t length, tl_error *error);

#ifdef __cplusplus
}
#endif
#endif
