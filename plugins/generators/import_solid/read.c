/* read.c - reads the surface in a file.
 *
 * STL, binary: 80 bytes, the number of triangles (32 bits), then for each 12 little-endian floats (normal and three
 * corners) and 2 bytes. Text: "facet normal", "outer loop", three times "vertex x y z", "endloop", "endfacet", each on
 * a line of its own, between "solid" and "endsolid"; there may be several solids. The normals of the file are not used:
 * the order of the corners says which side is outside.
 *
 * OBJ: corners (v) and faces (f). A face has three corners or more, each a number of a vertex counted from 1, or from
 * the last one when negative. What follows a slash (texture, normal) is left aside, as are names, groups, materials,
 * lines and points. */
#include "mesh.h"

#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>

/* A whole file, followed by a zero byte. */
typedef struct bytes {
    char *at;
    size_t count;
} bytes;

/* A line that is not empty. Its text is cut up where it stands. */
typedef struct line {
    char *next;    /* the text after it */
    char *word;    /* its first word */
    char *rest;    /* what follows */
    size_t number; /* from 1 */
} line;

/* ---------------------------------------------------------------- files and lines -------- */

/* Larger files are refused: no model has blocks for them. */
#define MOST_BYTES ((size_t)512 << 20)

/* Whether a letter is a space of ASCII. */
static bool text_space(char letter)
{
    return letter == ' ' || (letter >= '\t' && letter <= '\r');
}

/* A capital letter of ASCII as a small one. */
static char text_small(char letter)
{
    return letter >= 'A' && letter <= 'Z' ? (char)(letter - 'A' + 'a') : letter;
}

/* Refuses what holds a zero byte. */
static tl_status text_check(const mesh *m, const bytes *data)
{
    if (memchr(data->at, '\0', data->count))
        return m->host->fail(m->host, TL_E_GEOMETRY, "file '%.200s' holds a zero byte: it is damaged, or no text",
                             m->file);
    return TL_OK;
}

/* Takes the next word of the rest; NULL when there is none. */
static char *line_take(line *l)
{
    while (text_space(*l->rest))
        l->rest++;
    if (!*l->rest)
        return NULL;
    char *word = l->rest;
    while (*l->rest && !text_space(*l->rest))
        l->rest++;
    if (*l->rest)
        *l->rest++ = '\0';
    return word;
}

/* Goes to the next line that is not empty; false at the end. */
static bool line_next(line *l)
{
    while (*l->next) {
        char *at = l->next, *end = at + strcspn(at, "\n");
        l->next = *end ? end + 1 : end;
        *end = '\0';
        l->number++;
        l->rest = at;
        l->word = line_take(l);
        if (l->word)
            return true;
    }
    return false;
}

/* Whether its first word is `word`, in letters of any case. */
static bool line_is(const line *l, const char *word)
{
    const char *at = l->word;
    while (*at && text_small(*at) == *word)
        at++, word++;
    return *at == *word;
}

/* Takes three numbers of the rest. */
static tl_status line_point(const mesh *m, line *l, tl_vec3 *point)
{
    double number[3];
    for (int i = 0; i < 3; i++) {
        char *word = line_take(l);
        const char *end = word;
        if (word)
            number[i] = tl_number_read(word, &end);
        if (end == word || *end)
            return MESH_FAULT(m, ", line %zu: three numbers are expected after '%.40s'%s%.40s%s", l->number, l->word,
                              word ? ", not '" : ", the line ends", word ? word : "", word ? "'" : "");
    }
    *point = (tl_vec3){number[0], number[1], number[2]};
    return TL_OK;
}

/* ---------------------------------------------------------------- STL -------------------- */

#define HEADER_BYTES 84
#define TRIANGLE_BYTES 50

static uint32_t read_word(const char *at)
{
    const unsigned char *b = (const unsigned char *)at;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static double read_float(const char *at)
{
    uint32_t word = read_word(at);
    float value;
    memcpy(&value, &word, sizeof value);
    return (double)value;
}

static tl_status add_triangle(mesh *m)
{
    uint32_t last = (uint32_t)m->vertices;
    return mesh_add_face(m, (uint32_t[3]){last - 3, last - 2, last - 1}, 3);
}

static tl_status read_binary(mesh *m, const bytes *data, size_t triangles)
{
    tl_status status = TL_OK;
    for (size_t i = 0; i < triangles && status == TL_OK; i++) {
        const char *at = data->at + HEADER_BYTES + i * TRIANGLE_BYTES + 12;
        for (int k = 0; k < 3 && status == TL_OK; k++, at += 12) {
            tl_vec3 p = {read_float(at), read_float(at + 4), read_float(at + 8)};
            status = mesh_add_vertex(m, p, "triangle", i + 1);
        }
        if (status == TL_OK)
            status = add_triangle(m);
    }
    return status;
}

/* What a line of the text must begin with, in order; after LAST comes FACET again, or "endsolid". */
enum { FACET, OUTER, FIRST, SECOND, THIRD, END_LOOP, END_FACET, STATES };
static const char *const words[STATES] = {"facet", "outer", "vertex", "vertex", "vertex", "endloop", "endfacet"};

static tl_status unexpected(const mesh *m, const line *l, const char *wanted)
{
    return MESH_FAULT(m, ", line %zu: '%s' is expected, not '%.40s'; the file is damaged", l->number, wanted, l->word);
}

static tl_status read_stl_line(mesh *m, line *l, int *state, bool *inside)
{
    tl_vec3 p;
    if (!*inside) {
        *inside = line_is(l, "solid");
        return *inside ? TL_OK : unexpected(m, l, "solid");
    }
    if (*state == FACET && line_is(l, "endsolid")) {
        *inside = false;
        return TL_OK;
    }
    if (!line_is(l, words[*state]))
        return unexpected(m, l, words[*state]);
    tl_status status = TL_OK;
    if (*state >= FIRST && *state <= THIRD) {
        status = line_point(m, l, &p);
        if (status == TL_OK)
            status = mesh_add_vertex(m, p, "line", l->number);
    }
    if (status == TL_OK && *state == END_FACET)
        status = add_triangle(m);
    *state = (*state + 1) % STATES;
    return status;
}

static tl_status read_text(mesh *m, const bytes *data)
{
    tl_status status = text_check(m, data);
    line l = {.next = data->at};
    int state = FACET;
    bool inside = false;
    while (status == TL_OK && line_next(&l))
        status = read_stl_line(m, &l, &state, &inside);
    if (status == TL_OK && inside)
        return MESH_FAULT(m, " ends at line %zu where '%s' is expected: it is truncated", l.number,
                          state == FACET ? "endsolid" : words[state]);
    return status;
}

/* Some programs begin binary files with "solid" too: the size decides. */
static tl_status read_stl(mesh *m, const bytes *data)
{
    size_t triangles = data->count >= HEADER_BYTES ? read_word(data->at + HEADER_BYTES - 4) : 0;
    size_t whole = HEADER_BYTES + triangles * TRIANGLE_BYTES;
    if (data->count >= HEADER_BYTES && data->count == whole)
        return read_binary(m, data, triangles);
    const char *begin = data->at;
    while (text_space(*begin))
        begin++;
    bool text = strncmp(begin, "solid", 5) == 0 && !memchr(data->at, '\0', data->count);
    if (text)
        return read_text(m, data);
    if (data->count < HEADER_BYTES)
        return MESH_FAULT(m, " is no STL: it holds %zu bytes and does not begin with 'solid'", data->count);
    return MESH_FAULT(m, " says it has %zu triangles, which take %zu bytes, but holds %zu bytes: it is %s, or no STL",
                      triangles, whole, data->count, data->count < whole ? "truncated" : "damaged");
}

/* ---------------------------------------------------------------- OBJ -------------------- */

/* Most corners of one face. */
#define MOST_SIDES 4096

static const char *const ignored[] = {"vt",        "vn",     "vp",     "g",        "o",       "s", "mg",
                                      "usemtl",    "mtllib", "usemap", "maplib",   "l",       "p", "shadow_obj",
                                      "trace_obj", "lod",    "bevel",  "c_interp", "d_interp"};

/* Index of the vertex a word of a face names, or NONE. */
static uint32_t vertex_of(const mesh *m, const char *word)
{
    char *end;
    long long number = strtoll(word, &end, 10);
    long long count = (long long)m->vertices;
    if (end == word || (*end && *end != '/') || number == 0 || number > count || number < -count)
        return NONE;
    return (uint32_t)(number > 0 ? number - 1 : count + number);
}

static tl_status read_face(mesh *m, line *l)
{
    uint32_t corner[MOST_SIDES];
    size_t count = 0;
    for (char *word; (word = line_take(l)) != NULL && *word != '#'; count++) {
        if (count == MOST_SIDES)
            return MESH_FAULT(m, ", line %zu: a face has more than %d corners", l->number, MOST_SIDES);
        corner[count] = vertex_of(m, word);
        if (corner[count] == NONE)
            return MESH_FAULT(m,
                              ", line %zu: '%.40s' names none of the %zu vertices given before it; the file is damaged",
                              l->number, word, m->vertices);
    }
    if (count < 3)
        return MESH_FAULT(m, ", line %zu: a face of %zu corners; it must have 3 or more", l->number, count);
    return mesh_add_face(m, corner, count);
}

static tl_status read_obj_line(mesh *m, line *l)
{
    if (*l->word == '#')
        return TL_OK;
    if (line_is(l, "f"))
        return read_face(m, l);
    if (line_is(l, "v")) {
        tl_vec3 p;
        tl_status status = line_point(m, l, &p);
        return status == TL_OK ? mesh_add_vertex(m, p, "line", l->number) : status;
    }
    for (size_t i = 0; i < sizeof ignored / sizeof *ignored; i++)
        if (line_is(l, ignored[i]))
            return TL_OK;
    return MESH_FAULT(m, ", line %zu: '%.40s' is not a word of OBJ; the file is damaged, or no OBJ", l->number,
                      l->word);
}

static tl_status read_obj(mesh *m, const bytes *data)
{
    tl_status status = text_check(m, data);
    line l = {.next = data->at};
    while (status == TL_OK && line_next(&l))
        status = read_obj_line(m, &l);
    return status;
}

/* ---------------------------------------------------------------- either ----------------- */

/* Whether a file's name ends in `ending`, in letters of any case. */
static bool ends_in(const char *file, const char *ending)
{
    size_t length = strlen(file), tail = strlen(ending);
    if (length < tail)
        return false;
    for (size_t i = 0; i < tail; i++)
        if (text_small(file[length - tail + i]) != ending[i])
            return false;
    return true;
}

tl_status mesh_read(mesh *m)
{
    bool stl = ends_in(m->file, ".stl");
    bytes data;
    if (!stl && !ends_in(m->file, ".obj"))
        return m->host->fail(m->host, TL_E_ARGUMENT, "file '%.200s' does not end in .stl or .obj", m->file);
    tl_status status = tl_file_bytes(m->host, m->file, MOST_BYTES, &data.at, &data.count);
    if (status == TL_OK)
        status = stl ? read_stl(m, &data) : read_obj(m, &data);
    free(data.at);
    return status;
}
