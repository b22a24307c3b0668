/* vtk_numbers.c - types and numbers of a legacy VTK file. Binary ones have their most significant byte first. */
#include "mesh/vtk_numbers.h"

#include <math.h>
#include <string.h>

static const struct {
    const char *name;
    tl_vtk_type type;
} types[] = {
    {"bit", {TL_VTK_BITS, 0}},
    {"char", {TL_VTK_SIGNED, 1}},
    {"signed_char", {TL_VTK_SIGNED, 1}},
    {"unsigned_char", {TL_VTK_UNSIGNED, 1}},
    {"short", {TL_VTK_SIGNED, 2}},
    {"unsigned_short", {TL_VTK_UNSIGNED, 2}},
    {"int", {TL_VTK_SIGNED, 4}},
    {"unsigned_int", {TL_VTK_UNSIGNED, 4}},
    {"long", {TL_VTK_SIGNED, 8}},
    {"unsigned_long", {TL_VTK_UNSIGNED, 8}},
    {"vtktypeint64", {TL_VTK_SIGNED, 8}},
    {"vtktypeuint64", {TL_VTK_UNSIGNED, 8}},
    {"vtkidtype", {TL_VTK_SIGNED, 4}},
    {"float", {TL_VTK_REAL, 4}},
    {"double", {TL_VTK_REAL, 8}},
    {"string", {TL_VTK_TEXT, 0}},
};

tl_status tl_vtk_read_type(tl_vtk *v, const char *what, tl_vtk_type *type)
{
    char word[TL_MESH_WORD];
    if (!tl_mesh_word_here(&v->r->text, word))
        return tl_mesh_fault(&v->r->text, "the type of %s is expected at the end of the line; the file is damaged",
                             what);
    for (size_t k = 0; k < sizeof types / sizeof *types; k++)
        if (tl_mesh_alike(word, types[k].name)) {
            *type = types[k].type;
            return TL_OK;
        }
    return tl_mesh_fault(&v->r->text, "'%.40s', the type of %s, is none of legacy VTK", word, what);
}

tl_status tl_vtk_list_begin(tl_vtk *v, double count, tl_vtk_type type, const char *what)
{
    tl_mesh_text *t = &v->r->text;
    /* as text: a digit, and a space after it; a text may be an empty line */
    const double bytes = type.kind == TL_VTK_TEXT ? 1 : v->binary ? type.bytes : 2;
    if (v->binary || type.kind == TL_VTK_TEXT)
        tl_mesh_next_line(t);
    return type.kind == TL_VTK_BITS ? tl_mesh_room(t, count, v->binary ? 0.125 : 2, what)
                                    : tl_mesh_room(t, count, bytes, what);
}

static double of_bytes(uint64_t bits, tl_vtk_type type)
{
    const int unused = 64 - 8 * (int)type.bytes;
    double number;
    float single;
    const uint32_t low = (uint32_t)bits;
    if (type.kind == TL_VTK_UNSIGNED)
        return (double)bits;
    if (type.kind == TL_VTK_SIGNED) {
        const uint64_t sign = bits >> (63 - unused) & 1;
        return sign ? -(double)((~bits << unused >> unused) + 1) : (double)bits;
    }
    memcpy(&number, &bits, sizeof number);
    memcpy(&single, &low, sizeof single);
    return type.bytes == 8 ? number : (double)single;
}

tl_status tl_vtk_next(tl_vtk *v, tl_vtk_type type, const char *what, double *number)
{
    tl_mesh_text *t = &v->r->text;
    if (!v->binary)
        return tl_mesh_number(t, what, number);
    uint64_t bits = 0;
    if (tl_mesh_left(t) < type.bytes)
        return tl_mesh_truncated(t, what);
    for (uint32_t k = 0; k < type.bytes; k++)
        bits = bits << 8 | (unsigned char)*t->at++;
    *number = of_bytes(bits, type);
    return TL_OK;
}

tl_status tl_vtk_next_whole(tl_vtk *v, tl_vtk_type type, const char *what, double most, double *number)
{
    if (!v->binary)
        return tl_mesh_whole_number(&v->r->text, what, 0, most, number);
    const tl_status status = tl_vtk_next(v, type, what, number);
    if (status == TL_OK && (!(*number >= 0 && *number <= most) || floor(*number) < *number))
        return tl_mesh_fault(&v->r->text,
                             "%s, in the list after this line, is %.17g: it must be a whole number from 0 to %.17g",
                             what, *number, most);
    return status;
}
