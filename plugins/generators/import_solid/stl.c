/* stl.c - reads STL, binary and text.
 *
 * Binary: 80 bytes, the number of triangles (32 bits), then for each 12 little-endian floats (normal and
 * three corners) and 2 bytes. Text: "facet normal", "outer loop", three times "vertex x y z", "endloop",
 * "endfacet", each on a line of its own, between "solid" and "endsolid"; there may be several solids. The
 * normals of the file are not used: the order of the corners says which side is outside. */
#include "mesh.h"
#include "text.h"

#include <string.h>

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
static const char *const words[STATES] = {"facet",  "outer",   "vertex",  "vertex",
                                          "vertex", "endloop", "endfacet"};

static tl_status unexpected(const mesh *m, const line *l, const char *wanted)
{
    return m->host->fail(
        m->host, TL_E_GEOMETRY,
        "file '%.200s', line %zu: '%s' is expected, not '%.40s'; the file is damaged", m->file,
        l->number, wanted, l->word);
}

static tl_status read_line(mesh *m, line *l, int *state, bool *inside)
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
        status = line_point(m->host, m->file, l, &p);
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
    tl_status status = text_check(m->host, m->file, data);
    line l = {.next = data->at};
    int state = FACET;
    bool inside = false;
    while (status == TL_OK && line_next(&l))
        status = read_line(m, &l, &state, &inside);
    if (status == TL_OK && inside)
        return m->host->fail(
            m->host, TL_E_GEOMETRY,
            "file '%.200s' ends at line %zu where '%s' is expected: it is truncated", m->file,
            l.number, state == FACET ? "endsolid" : words[state]);
    return status;
}

/* Some programs begin binary files with "solid" too: the size decides. */
tl_status stl_read(mesh *m, const bytes *data)
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
        return m->host->fail(m->host, TL_E_GEOMETRY,
                             "file '%.200s' is no STL: it holds %zu bytes and does not begin with "
                             "'solid'",
                             m->file, data->count);
    return m->host->fail(m->host, TL_E_GEOMETRY,
                         "file '%.200s' says it has %zu triangles, which take %zu bytes, but holds "
                         "%zu bytes: it is %s, or no STL",
                         m->file, triangles, whole, data->count,
                         data->count < whole ? "truncated" : "damaged");
}
