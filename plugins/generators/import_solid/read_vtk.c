/* read_vtk.c - polygons of VTK legacy files.
 *
 * A head "# vtk DataFile", a title, ASCII or BINARY and DATASET POLYDATA are followed by POINTS and POLYGONS. Polygons
 * are lists with their counts, or since version 5 OFFSETS and CONNECTIVITY. Numbers of binary files have their highest
 * byte first. Lines and vertices are skipped, and data of points and cells end the reading. */
#include "bytes.h"
#include "text.h"

#include <string.h>
#include <talus/kit.h>

typedef struct reader {
    soup *s;
    char *at, *end;
    size_t line;
    bool binary;
    char word[64];
} reader;

static const struct {
    const char *name;
    number_type type;
} types[] = {{"char", INT8},       {"unsigned_char", UINT8}, {"short", INT16},        {"unsigned_short", UINT16},
             {"int", INT32},       {"unsigned_int", UINT32}, {"long", INT64},         {"unsigned_long", UINT64},
             {"vtkidtype", INT64}, {"vtktypeint64", INT64},  {"vtktypeint32", INT32}, {"float", FLOAT32},
             {"double", FLOAT64}};

/* Takes the next word into r->word; false at the end of the file. */
static bool next_word(reader *r)
{
    size_t length = 0;
    while (r->at < r->end && text_space(*r->at))
        r->line += *r->at++ == '\n';
    while (r->at < r->end && *r->at && !text_space(*r->at)) {
        if (length + 1 < sizeof r->word)
            r->word[length++] = *r->at;
        r->at++;
    }
    r->word[length] = '\0';
    return length > 0;
}

static void skip_line(reader *r)
{
    while (r->at < r->end && *r->at != '\n')
        r->at++;
    r->line += r->at < r->end;
    r->at += r->at < r->end;
}

static tl_status truncated(const reader *r, const char *what)
{
    return SOUP_FAULT(r->s, " ends at line %zu, byte %zu, where %s is expected: it is truncated; export it again",
                      r->line, (size_t)(r->end - r->at), what);
}

static tl_status wrong(const reader *r, const char *what)
{
    return SOUP_FAULT(r->s, ", line %zu: %s is expected, not '%.40s'; the file is damaged, or no VTK legacy file",
                      r->line, what, r->word);
}

static tl_status take_count(reader *r, size_t *count)
{
    return next_word(r) ? text_whole(r->s, r->word, r->line, MOST_CORNERS, count) : truncated(r, "a count");
}

static tl_status take_type(reader *r, number_type *type)
{
    if (!next_word(r))
        return truncated(r, "a type of numbers");
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        if (word_is(r->word, types[i].name)) {
            *type = types[i].type;
            return TL_OK;
        }
    return wrong(r, "a type of numbers");
}

/* Makes sure that binary data of `count` numbers are there; they begin on the next line. */
static tl_status begin_data(reader *r, size_t count, number_type type)
{
    skip_line(r);
    if (r->binary && (size_t)(r->end - r->at) / number_bytes[type] < count)
        return SOUP_FAULT(r->s,
                          ", line %zu: %zu numbers of %zu bytes are announced, but %zu bytes follow; it is truncated; "
                          "export it again",
                          r->line, count, number_bytes[type], (size_t)(r->end - r->at));
    return TL_OK;
}

static tl_status take_number(reader *r, number_type type, double *number)
{
    if (!r->binary)
        return next_word(r) ? text_number(r->s, r->word, r->line, number) : truncated(r, "a number");
    if ((size_t)(r->end - r->at) < number_bytes[type])
        return truncated(r, "a number");
    *number = number_at(r->at, type, true);
    r->at += number_bytes[type];
    return TL_OK;
}

static tl_status take_whole(reader *r, number_type type, size_t most, size_t *whole)
{
    double number = 0;
    *whole = 0;
    if (!r->binary) /* its digits say nothing of coordinates */
        return next_word(r) ? text_whole(r->s, r->word, r->line, most, whole) : truncated(r, "a number");
    tl_status status = take_number(r, type, &number);
    if (status == TL_OK && (!(number >= 0 && number <= (double)most) || floor(number) < number))
        return SOUP_FAULT(r->s, ", byte %zu from its end: %g is not a whole number from 0 to %zu; the file is damaged",
                          (size_t)(r->end - r->at), number, most);
    *whole = status == TL_OK ? (size_t)number : 0;
    return status;
}

static tl_status read_points(reader *r)
{
    size_t count;
    number_type type = FLOAT64;
    tl_status status = take_count(r, &count);
    if (status == TL_OK)
        status = take_type(r, &type);
    if (status == TL_OK)
        status = begin_data(r, 3 * count, type);
    if (status == TL_OK && r->binary)
        r->s->rounding = type == FLOAT32 ? SINGLE_ROUNDING : DOUBLE_ROUNDING;
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        double at[3] = {0, 0, 0};
        for (int k = 0; k < 3 && status == TL_OK; k++)
            status = take_number(r, type, &at[k]);
        if (status == TL_OK)
            status = soup_vertex(r->s, (tl_vec3){at[0], at[1], at[2]}, "point", i + 1);
    }
    return status;
}

/* Lists of vertices with their counts, or since version 5 offsets and then vertices. Those of faces are kept. */
static tl_status add_lists(reader *r, const size_t *list, size_t count, bool faces)
{
    uint32_t corner[MOST_SIDES];
    if (!faces)
        return TL_OK;
    if (count < 3 || count > MOST_SIDES)
        return SOUP_FAULT(r->s, ", line %zu: a polygon of %zu corners; it must have 3 to %d", r->line, count,
                          MOST_SIDES);
    for (size_t i = 0; i < count; i++)
        corner[i] = (uint32_t)list[i];
    return soup_face(r->s, corner, count);
}

static tl_status read_counted(reader *r, size_t cells, size_t size, bool faces)
{
    size_t list[MOST_SIDES], count;
    tl_status status = begin_data(r, size, INT32);
    for (size_t i = 0; i < cells && status == TL_OK; i++) {
        status = take_whole(r, INT32, MOST_CORNERS, &count);
        for (size_t k = 0; k < count && status == TL_OK; k++)
            status = take_whole(r, INT32, MOST_CORNERS, &list[k < MOST_SIDES ? k : 0]);
        if (status == TL_OK)
            status = add_lists(r, list, count, faces);
    }
    return status;
}

/* OFFSETS and CONNECTIVITY; `offsets` is one more than there are cells. */
static tl_status read_offsets(reader *r, size_t offsets, size_t size, bool faces)
{
    number_type type = INT64;
    size_t list[MOST_SIDES], capacity = 0, *offset = NULL;
    tl_status status = take_type(r, &type);
    if (status == TL_OK)
        status = begin_data(r, offsets, type);
    for (size_t i = 0; i < offsets && status == TL_OK; i++) {
        size_t *more = tl_grown(offset, &capacity, i + 1, sizeof *more);
        status = more ? TL_OK : soup_no_memory(r->s);
        offset = more ? more : offset;
        if (status == TL_OK)
            status = take_whole(r, type, size, &offset[i]);
        if (status == TL_OK && i > 0 && offset[i] < offset[i - 1])
            status =
                SOUP_FAULT(r->s, ", line %zu: the offsets of the polygons do not rise; the file is damaged", r->line);
    }
    if (status == TL_OK && (!next_word(r) || !word_is(r->word, "connectivity")))
        status = wrong(r, "CONNECTIVITY");
    if (status == TL_OK)
        status = take_type(r, &type);
    if (status == TL_OK)
        status = begin_data(r, size, type);
    for (size_t i = 0; i + 1 < offsets && status == TL_OK; i++) {
        size_t count = offset[i + 1] - offset[i];
        for (size_t k = 0; k < count && status == TL_OK; k++)
            status = take_whole(r, type, MOST_CORNERS, &list[k < MOST_SIDES ? k : 0]);
        if (status == TL_OK)
            status = add_lists(r, list, count, faces);
    }
    free(offset);
    return status;
}

static tl_status read_cells(reader *r, bool faces)
{
    size_t cells, size;
    tl_status status = take_count(r, &cells);
    if (status == TL_OK)
        status = take_count(r, &size);
    if (status != TL_OK)
        return status;
    char *before = r->at;
    const size_t before_line = r->line;
    if (next_word(r) && word_is(r->word, "offsets"))
        return cells > 0 ? read_offsets(r, cells, size, faces) : TL_OK;
    r->at = before;
    r->line = before_line;
    return read_counted(r, cells, size, faces);
}

static tl_status read_head(reader *r)
{
    if (!next_word(r) || strcmp(r->word, "#") != 0 || !next_word(r) || !word_is(r->word, "vtk"))
        return SOUP_FAULT(r->s, " is no VTK legacy file: it does not begin with '%s'", "# vtk DataFile");
    skip_line(r);
    skip_line(r); /* the title */
    if (!next_word(r))
        return truncated(r, "ASCII or BINARY");
    r->binary = word_is(r->word, "binary");
    if (!r->binary && !word_is(r->word, "ascii"))
        return wrong(r, "ASCII or BINARY");
    if (!next_word(r) || !word_is(r->word, "dataset"))
        return wrong(r, "DATASET");
    if (!next_word(r) || !word_is(r->word, "polydata"))
        return SOUP_FAULT(r->s,
                          ", line %zu: the data set is '%.40s', not POLYDATA; write its surface, or read its "
                          "tetrahedra by the generator 'zones'",
                          r->line, r->word);
    return TL_OK;
}

tl_status read_vtk(soup *s, char *text, size_t count)
{
    reader r = {.s = s, .at = text, .end = text + count, .line = 1};
    tl_status status = read_head(&r);
    while (status == TL_OK && next_word(&r)) {
        if (word_is(r.word, "point_data") || word_is(r.word, "cell_data"))
            break;
        if (word_is(r.word, "points"))
            status = read_points(&r);
        else if (word_is(r.word, "polygons"))
            status = read_cells(&r, true);
        else if (word_is(r.word, "lines") || word_is(r.word, "vertices"))
            status = read_cells(&r, false);
        else if (word_is(r.word, "triangle_strips"))
            status = SOUP_FAULT(s, ", line %zu: strips of triangles are not read; write polygons", r.line);
        else if (word_is(r.word, "metadata")) /* lines up to an empty one */
            for (skip_line(&r); r.at < r.end && *r.at != '\n' && *r.at != '\r';)
                skip_line(&r);
        else
            status = wrong(&r, "POINTS, POLYGONS, LINES, VERTICES, POINT_DATA or CELL_DATA");
    }
    return status;
}
