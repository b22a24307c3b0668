/* read_ply.c - PLY, as text or binary of either byte order.
 *
 * A header lists elements, each with a count and properties: numbers, or lists with a count of their own. Of `vertex`
 * x, y and z are read, of `face` the list vertex_indices or vertex_index. All else is skipped. */
#include "bytes.h"
#include "text.h"

#include <string.h>
#include <talus/kit.h>

/* Limit: most elements of a file, and most properties of one. */
#define MOST_ELEMENTS 32
#define MOST_PROPERTIES 64

typedef enum role { SKIP, X, Y, Z, CORNERS } role;
typedef enum element_kind { OTHER, VERTEX, FACE } element_kind;

typedef struct property {
    number_type type, count_type;
    bool list;
    role role;
} property;

typedef struct element {
    element_kind kind;
    char name[24];
    size_t count, properties;
    property property[MOST_PROPERTIES];
} element;

typedef struct reader {
    soup *s;
    text_line l;
    bool binary, big_endian;
    const char *at, *begin, *end; /* of the binary data: where it is read, the file's first byte, its end */
    size_t elements;
    element element[MOST_ELEMENTS];
    uint32_t corner[MOST_SIDES];
} reader;

static const struct {
    const char *name, *old_name;
    number_type type;
} types[] = {{"char", "int8", INT8},        {"uchar", "uint8", UINT8},     {"short", "int16", INT16},
             {"ushort", "uint16", UINT16},  {"int", "int32", INT32},       {"uint", "uint32", UINT32},
             {"float", "float32", FLOAT32}, {"double", "float64", FLOAT64}};

static tl_status damaged(const reader *r, const char *wanted)
{
    return SOUP_FAULT(r->s, ", line %zu: %s is expected in the header of a PLY; the file is damaged", r->l.number,
                      wanted);
}

static tl_status read_type(const reader *r, const char *word, number_type *type)
{
    for (size_t i = 0; word && i < sizeof types / sizeof *types; i++)
        if (word_is(word, types[i].name) || word_is(word, types[i].old_name)) {
            *type = types[i].type;
            return TL_OK;
        }
    return damaged(r, "the type of a property (char, uchar, short, ushort, int, uint, float, double)");
}

static role role_of(const element *e, const property *p, const char *name)
{
    if (e->kind == VERTEX && !p->list && name[0] && !name[1] && name[0] >= 'x' && name[0] <= 'z')
        return (role)(X + (name[0] - 'x'));
    bool corners = word_is(name, "vertex_indices") || word_is(name, "vertex_index");
    return e->kind == FACE && p->list && corners ? CORNERS : SKIP;
}

static tl_status read_property(reader *r)
{
    if (r->elements == 0)
        return damaged(r, "'element' before 'property'");
    element *e = &r->element[r->elements - 1];
    if (e->properties == MOST_PROPERTIES)
        return SOUP_FAULT(r->s, ", line %zu: an element has more than %d properties", r->l.number, MOST_PROPERTIES);
    property *p = &e->property[e->properties];
    const char *word = line_take(&r->l);
    tl_status status = TL_OK;
    *p = (property){0};
    p->list = word && word_is(word, "list");
    if (p->list) {
        status = read_type(r, line_take(&r->l), &p->count_type);
        word = line_take(&r->l);
        if (status == TL_OK && p->count_type >= FLOAT32)
            status = damaged(r, "a whole type for the count of a list");
    }
    if (status == TL_OK)
        status = read_type(r, word, &p->type);
    const char *name = status == TL_OK ? line_take(&r->l) : NULL;
    if (status == TL_OK && !name)
        status = damaged(r, "the name of a property");
    if (status != TL_OK)
        return status;
    p->role = role_of(e, p, name);
    e->properties++;
    return TL_OK;
}

static tl_status read_element(reader *r)
{
    const char *name = line_take(&r->l), *count = name ? line_take(&r->l) : NULL;
    if (!count)
        return damaged(r, "'element NAME COUNT'");
    if (r->elements == MOST_ELEMENTS)
        return SOUP_FAULT(r->s, ", line %zu: more than %d elements", r->l.number, MOST_ELEMENTS);
    element *e = &r->element[r->elements++];
    e->kind = word_is(name, "vertex") ? VERTEX : word_is(name, "face") ? FACE : OTHER;
    if (word_is(name, "tristrips"))
        return SOUP_FAULT(r->s, ", line %zu: strips of triangles are not read; write faces", r->l.number);
    tl_text_print(e->name, sizeof e->name, "%.20s", name);
    return text_whole(r->s, count, r->l.number, MOST_CORNERS, &e->count);
}

static tl_status read_format(reader *r)
{
    const char *format = line_take(&r->l);
    r->big_endian = format && word_is(format, "binary_big_endian");
    r->binary = r->big_endian || (format && word_is(format, "binary_little_endian"));
    if (r->binary || (format && word_is(format, "ascii")))
        return TL_OK;
    return damaged(r, "'format ascii', 'format binary_little_endian' or 'format binary_big_endian'");
}

static tl_status read_header(reader *r)
{
    bool format = false;
    if (!line_next(&r->l) || !line_is(&r->l, "ply"))
        return SOUP_FAULT(r->s, " is no PLY: it does not begin with '%s'", "ply");
    while (line_next(&r->l)) {
        tl_status status = TL_OK;
        if (line_is(&r->l, "end_header"))
            return format ? TL_OK : damaged(r, "'format'");
        if (line_is(&r->l, "format")) {
            status = read_format(r);
            format = true;
        } else if (line_is(&r->l, "element")) {
            status = read_element(r);
        } else if (line_is(&r->l, "property")) {
            status = read_property(r);
        } else if (!line_is(&r->l, "comment") && !line_is(&r->l, "obj_info")) {
            status = damaged(r, "'element', 'property', 'comment' or 'end_header'");
        }
        if (status != TL_OK)
            return status;
    }
    return SOUP_FAULT(r->s, " ends at line %zu within the header: it is truncated; export it again", r->l.number);
}

/* ---------------------------------------------------------------- data ------------------- */

static tl_status truncated(const reader *r, const element *e, size_t row)
{
    return SOUP_FAULT(r->s, " ends in %s %zu of the %zu it announces: it is truncated; export it again", e->name,
                      row + 1, e->count);
}

/* The next number. */
static tl_status take(reader *r, const element *e, size_t row, number_type type, bool place, double *number)
{
    if (r->binary) {
        if ((size_t)(r->end - r->at) < number_bytes[type])
            return truncated(r, e, row);
        *number = number_at(r->at, type, r->big_endian);
        r->at += number_bytes[type];
        return TL_OK;
    }
    const char *word = line_take(&r->l);
    if (!word)
        return SOUP_FAULT(r->s, ", line %zu: %s %zu ends before all its properties are given; the file is damaged",
                          r->l.number, e->name, row + 1);
    int decimals = r->s->decimals, digits = r->s->digits;
    tl_status status = text_number(r->s, word, r->l.number, number);
    if (!place) { /* only coordinates tell how exact a file is */
        r->s->decimals = decimals;
        r->s->digits = digits;
    }
    return status;
}

static tl_status take_list(reader *r, const element *e, size_t row, const property *p)
{
    double count, number;
    tl_status status = take(r, e, row, p->count_type, false, &count);
    if (status != TL_OK)
        return status;
    bool corners = p->role == CORNERS;
    if (!(count >= (corners ? 3 : 0) && count <= (corners ? MOST_SIDES : MOST_CORNERS)) || floor(count) < count)
        return SOUP_FAULT(r->s, ": a list of %s %zu has %g entries; of corners it must be 3 to %d; the file is damaged",
                          e->name, row + 1, count, MOST_SIDES);
    for (size_t i = 0; i < (size_t)count && status == TL_OK; i++) {
        status = take(r, e, row, p->type, false, &number);
        if (status != TL_OK || !corners)
            continue;
        if (!(number >= 0 && number < MOST_CORNERS) || floor(number) < number)
            return SOUP_FAULT(r->s, ": %s %zu names vertex %g; the file is damaged", e->name, row + 1, number);
        r->corner[i] = (uint32_t)number;
    }
    return status == TL_OK && corners ? soup_face(r->s, r->corner, (size_t)count) : status;
}

static tl_status read_row(reader *r, const element *e, size_t row)
{
    double at[3] = {0, 0, 0}, number;
    if (!r->binary && !line_next(&r->l))
        return truncated(r, e, row);
    r->l.rest = r->binary ? NULL : r->l.word;
    if (!r->binary) { /* the first word was cut off: it is taken once more */
        char *end = r->l.word + strlen(r->l.word);
        if (end + 1 < r->l.next)
            *end = ' ';
    }
    for (size_t k = 0; k < e->properties; k++) {
        const property *p = &e->property[k];
        bool place = p->role >= X && p->role <= Z;
        tl_status status = p->list ? take_list(r, e, row, p) : take(r, e, row, p->type, place, &number);
        if (status != TL_OK)
            return status;
        if (place)
            at[p->role - X] = number;
    }
    return e->kind == VERTEX ? soup_vertex(r->s, (tl_vec3){at[0], at[1], at[2]}, "vertex", row + 1) : TL_OK;
}

/* Whether a vertex has a place and a face corners. */
static tl_status check_element(reader *r, const element *e)
{
    unsigned roles = 0;
    for (size_t k = 0; k < e->properties; k++) {
        roles |= 1u << e->property[k].role;
        if (e->property[k].role >= X && e->property[k].role <= Z && r->binary)
            r->s->rounding = e->property[k].type == FLOAT64 ? DOUBLE_ROUNDING : SINGLE_ROUNDING;
    }
    if (e->properties == 0 || (e->kind == VERTEX && (roles & 14) != 14) || (e->kind == FACE && !(roles & 16)))
        return SOUP_FAULT(r->s, ": the element '%s' has no %s; the file is damaged, or holds no surface", e->name,
                          e->kind == VERTEX ? "x, y and z"
                          : e->kind == FACE ? "vertex_indices"
                                            : "properties");
    return TL_OK;
}

tl_status read_ply(soup *s, char *text, size_t count)
{
    reader *r = calloc(1, sizeof *r);
    if (!r)
        return soup_no_memory(s);
    r->s = s;
    r->l.next = text;
    r->begin = text;
    r->end = text + count;
    tl_status status = read_header(r);
    r->at = r->l.next; /* behind the line of end_header */
    if (status == TL_OK && !r->binary)
        status = text_check(s, r->l.next, (size_t)(r->end - r->l.next));
    for (size_t i = 0; i < r->elements && status == TL_OK; i++) {
        status = check_element(r, &r->element[i]);
        for (size_t row = 0; row < r->element[i].count && status == TL_OK; row++)
            status = read_row(r, &r->element[i], row);
    }
    free(r);
    return status;
}
