/* vtk_arrays.c - arrays of a legacy VTK file. Those of cells that tell groups and blocks are kept.
 *
 *     group      group, material, region, physical, gmsh:physical, CellEntityIds or medit:ref: the first of these that
 *                there is, whole numbers or texts
 *     block      block_id, gmsh:geometrical
 *     names      group_names, texts: those of the groups 0, 1, ... (Talus's own files)
 *
 * Texts are a line each, with bytes as %41; in binary files their length comes first. */
#include "mesh/vtk_arrays.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Limit: bytes of a text that is kept. Longer ones are no names. */
#define LONGEST_TEXT 256
/* Limit: names of groups. Each cell's is looked for among all. */
#define MOST_NAMES 4096
/* Limit: numbers of one value. */
#define WIDEST 1024

static const char *const group_arrays[] = {"group",         "material",      "region",   "physical",
                                           "gmsh:physical", "CellEntityIds", "medit:ref"};
static const char *const part_arrays[] = {"block_id", "gmsh:geometrical"};

/* What an array is kept for. */
typedef enum use { NOTHING, GROUPS, PARTS, NAMES } use;

/* ---------------------------------------------------------------- texts ------------------ */

static int digit_of(char letter)
{
    if (letter >= '0' && letter <= '9')
        return letter - '0';
    letter = (char)(letter | 0x20);
    return letter >= 'a' && letter <= 'f' ? letter - 'a' + 10 : -1;
}

/* Bytes of a text in a binary file; how many of them its head takes. */
static size_t length_of(const tl_mesh_text *t, size_t *head)
{
    static const size_t heads[] = {8, 4, 2, 1};
    const size_t left = tl_mesh_left(t);
    uint64_t length = 0;
    *head = left > 0 ? heads[(unsigned char)*t->at >> 6] : 1;
    if (left < *head)
        return SIZE_MAX;
    for (size_t k = 0; k < *head; k++)
        length = length << 8 | (unsigned char)(k == 0 ? *t->at & 0x3f : t->at[k]);
    return length <= left - *head ? (size_t)length : SIZE_MAX;
}

/* The next text; what is beyond LONGEST_TEXT is left out. */
static tl_status next_text(tl_vtk *v, char text[LONGEST_TEXT], size_t *length)
{
    tl_mesh_text *t = &v->r->text;
    *length = 0;
    if (v->binary) {
        size_t head;
        const size_t bytes = length_of(t, &head);
        if (bytes == SIZE_MAX)
            return tl_mesh_truncated(t, "a text");
        *length = bytes < LONGEST_TEXT ? bytes : LONGEST_TEXT - 1;
        memcpy(text, t->at + head, *length);
        t->at += head + bytes;
        return TL_OK;
    }
    if (tl_mesh_left(t) == 0)
        return tl_mesh_truncated(t, "a text");
    for (const char *at = t->at; at < t->end && *at != '\n' && *at != '\r' && *length + 1 < LONGEST_TEXT; at++) {
        const int high = *at == '%' && t->end - at > 2 ? digit_of(at[1]) : -1, low = high < 0 ? -1 : digit_of(at[2]);
        text[(*length)++] = low < 0 ? *at : (char)(16 * high + low);
        at += low < 0 ? 0 : 2;
    }
    tl_mesh_next_line(t);
    return TL_OK;
}

/* The number of a name, which is added unless it is there. */
static tl_status intern(tl_vtk *v, const char *text, size_t length, double *number)
{
    tl_mesh_reading *r = v->r;
    for (size_t k = 0; k < r->name_count; k++)
        if (strlen(r->name[k].text) == length && memcmp(r->name[k].text, text, length) == 0) {
            *number = r->name[k].group;
            return TL_OK;
        }
    *number = (double)r->name_count;
    return tl_mesh_name_group(r, *number, text, length);
}

static tl_status read_texts(tl_vtk *v, double count, use of)
{
    tl_status status = TL_OK;
    for (size_t k = 0; status == TL_OK && (double)k < count; k++) {
        char text[LONGEST_TEXT];
        size_t length;
        status = next_text(v, text, &length);
        if (status == TL_OK && of == NAMES && !v->named)
            status = tl_mesh_name_group(v->r, (double)k, text, length);
        if (status != TL_OK || of != GROUPS)
            continue;
        if (v->r->name_count >= MOST_NAMES)
            return tl_mesh_fault(&v->r->text, "cells have more than %d names of groups", MOST_NAMES);
        status = intern(v, text, length, &v->group[k].group);
    }
    v->named = v->named || of == NAMES || of == GROUPS;
    return status;
}

/* ---------------------------------------------------------------- numbers ---------------- */

static tl_status keep_value(tl_vtk *v, use of, const char *name, size_t cell, double value)
{
    if (!(fabs(value) <= INT32_MAX) || floor(value) < value)
        return tl_mesh_fault(&v->r->text, "'%.40s' of cell %zu is %.17g: groups are whole numbers, or texts", name,
                             cell, value);
    *(of == GROUPS ? &v->group[cell].group : &v->group[cell].part) = value;
    return TL_OK;
}

/* Passes over the numbers of an array, or keeps them. */
static tl_status read_numbers(tl_vtk *v, double count, tl_vtk_type type, use of, const char *name)
{
    tl_mesh_text *t = &v->r->text;
    tl_status status = TL_OK;
    if (v->binary && of == NOTHING) {
        const double bytes = type.kind == TL_VTK_BITS ? floor((count + 7) / 8) : count * type.bytes;
        if (bytes > (double)tl_mesh_left(t))
            return tl_mesh_truncated(t, "an array");
        t->at += (size_t)bytes;
        return TL_OK;
    }
    for (size_t k = 0; status == TL_OK && (double)k < count; k++) {
        double value;
        status = tl_vtk_next(v, type, "a number of an array", &value);
        if (status == TL_OK && of != NOTHING)
            status = keep_value(v, of, name, k, value);
    }
    return status;
}

static int rank_of(const char *name, const char *const *list, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (tl_mesh_alike(name, list[k]))
            return (int)(count - k);
    return 0;
}

/* What an array is kept for, by its name. */
static use use_of(tl_vtk *v, const char *name, tl_vtk_type type, double width, double rows)
{
    const int group = rank_of(name, group_arrays, sizeof group_arrays / sizeof *group_arrays);
    const int part = rank_of(name, part_arrays, sizeof part_arrays / sizeof *part_arrays);
    if (tl_mesh_alike(name, "group_names") && type.kind == TL_VTK_TEXT)
        return NAMES;
    if (!v->of_cells || width > 1 || rows < (double)v->cells || rows > (double)v->cells || type.kind == TL_VTK_BITS)
        return NOTHING;
    if (group > v->group_rank) {
        v->group_rank = group;
        return GROUPS;
    }
    if (part > v->part_rank && type.kind != TL_VTK_TEXT) {
        v->part_rank = part;
        return PARTS;
    }
    return NOTHING;
}

static tl_status read_values(tl_vtk *v, const char *name, tl_vtk_type type, double width, double rows)
{
    const tl_status status = tl_vtk_list_begin(v, width * rows, type, "values of an array");
    if (status != TL_OK)
        return status;
    const use of = use_of(v, name, type, width, rows);
    return type.kind == TL_VTK_TEXT ? read_texts(v, width * rows, of) : read_numbers(v, width * rows, type, of, name);
}

/* ---------------------------------------------------------------- what there may be ------ */

/* Lines up to an empty one. */
static void skip_metadata(tl_mesh_text *t)
{
    char word[TL_MESH_WORD];
    do
        tl_mesh_next_line(t);
    while (tl_mesh_word_here(t, word));
}

static tl_status read_name(tl_vtk *v, char name[TL_MESH_WORD])
{
    return tl_mesh_word_here(&v->r->text, name)
               ? TL_OK
               : tl_mesh_fault(&v->r->text, "the name of an array is expected at the end of the line");
}

static tl_status read_field_array(tl_vtk *v)
{
    tl_mesh_text *t = &v->r->text;
    char name[TL_MESH_WORD];
    double width, rows;
    tl_vtk_type type;
    bool more = tl_mesh_word(t, name);
    while (more && tl_mesh_alike(name, "METADATA")) { /* of the array before */
        skip_metadata(t);
        more = tl_mesh_word(t, name);
    }
    if (!more)
        return tl_mesh_truncated(t, "an array");
    tl_status status = tl_mesh_whole_number(t, "how many numbers a value has", 0, WIDEST, &width);
    if (status == TL_OK)
        status = tl_mesh_whole_number(t, "how many values an array has", 0, UINT32_MAX, &rows);
    if (status == TL_OK)
        status = tl_vtk_read_type(v, "an array", &type);
    return status == TL_OK ? read_values(v, name, type, width, rows) : status;
}

static tl_status read_field(tl_vtk *v)
{
    tl_mesh_text *t = &v->r->text;
    char name[TL_MESH_WORD];
    double count;
    tl_status status = read_name(v, name);
    if (status == TL_OK)
        status = tl_mesh_whole_number(t, "the number of arrays", 0, UINT16_MAX, &count);
    for (double k = 0; status == TL_OK && k < count; k++)
        status = read_field_array(v);
    return status;
}

/* "SCALARS name type width", then "LOOKUP_TABLE name". */
static tl_status read_scalars(tl_vtk *v)
{
    tl_mesh_text *t = &v->r->text;
    char name[TL_MESH_WORD], word[TL_MESH_WORD];
    double width = 1;
    tl_vtk_type type;
    tl_status status = read_name(v, name);
    if (status == TL_OK)
        status = tl_vtk_read_type(v, "an array", &type);
    if (status == TL_OK && tl_mesh_word_here(t, word))
        width = word[0] >= '1' && word[0] <= '9' && word[1] == '\0' ? word[0] - '0' : 0;
    if (status == TL_OK && width < 1)
        return tl_mesh_fault(t, "SCALARS have 1 to 9 numbers, not '%.40s'", word);
    const tl_mesh_text here = *t;
    if (status == TL_OK && !(tl_mesh_word(t, word) && tl_mesh_alike(word, "LOOKUP_TABLE")))
        *t = here;
    else if (status == TL_OK)
        status = read_name(v, word);
    return status == TL_OK ? read_values(v, name, type, width, v->data) : status;
}

/* "NAME name type", of so many numbers a value; 0: they come after the name. */
static tl_status read_attribute(tl_vtk *v, double width)
{
    char name[TL_MESH_WORD];
    tl_vtk_type type;
    tl_status status = read_name(v, name);
    if (status == TL_OK && width < 1)
        status = tl_mesh_whole_number(&v->r->text, "how many numbers a value has", 1, WIDEST, &width);
    if (status == TL_OK)
        status = tl_vtk_read_type(v, "an array", &type);
    return status == TL_OK ? read_values(v, name, type, width, v->data) : status;
}

/* Colours: "COLOR_SCALARS name width", and "LOOKUP_TABLE name rows" of four. In binary files each is a byte. */
static tl_status read_colours(tl_vtk *v, bool table)
{
    const tl_vtk_type type = {TL_VTK_UNSIGNED, 1};
    char name[TL_MESH_WORD];
    double count;
    tl_status status = read_name(v, name);
    if (status == TL_OK)
        status = tl_mesh_whole_number(&v->r->text, "how many colours there are", 0, UINT32_MAX, &count);
    if (status != TL_OK)
        return status;
    return read_values(v, "", type, table ? 4 : count, table ? count : v->data);
}

static tl_status begin_data(tl_vtk *v, bool of_cells)
{
    const double rows = of_cells ? (double)v->cells : (double)v->r->mesh->point_count;
    tl_status status = tl_mesh_whole_number(&v->r->text, "how many values arrays have", 0, UINT32_MAX, &v->data);
    if (status == TL_OK && (v->data < rows || v->data > rows))
        return tl_mesh_fault(&v->r->text, "arrays of %s have %.17g values, but there are %.17g; the file is damaged",
                             of_cells ? "cells" : "points", v->data, rows);
    v->of_cells = of_cells;
    return status;
}

tl_status tl_vtk_read_array(tl_vtk *v, const char *word)
{
    static const struct {
        const char *name;
        double width;
    } attributes[] = {{"VECTORS", 3},
                      {"NORMALS", 3},
                      {"TENSORS", 9},
                      {"TENSORS6", 6},
                      {"GLOBAL_IDS", 1},
                      {"PEDIGREE_IDS", 1},
                      {"TEXTURE_COORDINATES", 0}};
    if (tl_mesh_alike(word, "CELL_DATA") || tl_mesh_alike(word, "POINT_DATA"))
        return begin_data(v, tl_mesh_alike(word, "CELL_DATA"));
    if (tl_mesh_alike(word, "FIELD"))
        return read_field(v);
    if (tl_mesh_alike(word, "SCALARS"))
        return read_scalars(v);
    if (tl_mesh_alike(word, "COLOR_SCALARS") || tl_mesh_alike(word, "LOOKUP_TABLE"))
        return read_colours(v, tl_mesh_alike(word, "LOOKUP_TABLE"));
    if (tl_mesh_alike(word, "METADATA")) {
        skip_metadata(&v->r->text);
        return TL_OK;
    }
    for (size_t k = 0; k < sizeof attributes / sizeof *attributes; k++)
        if (tl_mesh_alike(word, attributes[k].name))
            return read_attribute(v, attributes[k].width);
    return tl_mesh_fault(&v->r->text,
                         "'%.40s' begins nothing that a legacy VTK file of an UNSTRUCTURED_GRID may have; the file is "
                         "damaged",
                         word);
}
