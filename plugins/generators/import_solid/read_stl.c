/* read_stl.c - STL, as text or binary. Each solid of a text is an object.
 *
 * Binary: 80 bytes, the number of triangles (32 bits), then for each 12 little-endian floats (normal and three corners)
 * and 2 bytes. Text: "facet normal", "outer loop", three times "vertex x y z", "endloop", "endfacet", on lines of their
 * own or not, between "solid NAME" and "endsolid". The normals of the file are not used: the order of the corners tells
 * them. */
#include "bytes.h"
#include "text.h"

#include <string.h>
#include <talus/kit.h>

#define HEADER_BYTES 84
#define TRIANGLE_BYTES 50

static tl_status add_triangle(soup *s)
{
    uint32_t last = (uint32_t)s->vertices;
    return soup_face(s, (uint32_t[3]){last - 3, last - 2, last - 1}, 3);
}

static tl_status read_binary(soup *s, const char *bytes, size_t triangles)
{
    tl_status status = TL_OK;
    s->rounding = SINGLE_ROUNDING;
    for (size_t i = 0; i < triangles && status == TL_OK; i++) {
        const char *at = bytes + HEADER_BYTES + i * TRIANGLE_BYTES + 12;
        for (int k = 0; k < 3 && status == TL_OK; k++, at += 12) {
            tl_vec3 p = {number_at(at, FLOAT32, false), number_at(at + 4, FLOAT32, false),
                         number_at(at + 8, FLOAT32, false)};
            status = soup_vertex(s, p, "triangle", i + 1);
        }
        if (status == TL_OK)
            status = add_triangle(s);
    }
    return status;
}

/* What comes after each other; after the last FACET again, or "endsolid". A line begins with one of them. */
enum { FACET, OUTER, FIRST, SECOND, THIRD, END_LOOP, END_FACET, STATES };
static const char *const words[STATES] = {"facet", "outer", "vertex", "vertex", "vertex", "endloop", "endfacet"};

static tl_status unexpected(const soup *s, const text_line *l, const char *wanted)
{
    return SOUP_FAULT(s, ", line %zu: '%s' is expected, not '%.40s'; the file is damaged", l->number, wanted, l->word);
}

static tl_status read_part(soup *s, text_line *l, int *state, bool *inside)
{
    tl_vec3 p;
    if (!*inside) {
        *inside = line_is(l, "solid");
        size_t length;
        const char *name = line_rest(l, &length);
        return *inside ? soup_object(s, name, length, name, length) : unexpected(s, l, "solid");
    }
    if (*state == FACET && line_is(l, "endsolid")) {
        *inside = false;
        return TL_OK;
    }
    if (!line_is(l, words[*state]))
        return unexpected(s, l, words[*state]);
    tl_status status = TL_OK;
    if (*state >= FIRST && *state <= THIRD) {
        status = line_point(s, l, &p);
        if (status == TL_OK)
            status = soup_vertex(s, p, "line", l->number);
    }
    if (status == TL_OK && *state == END_FACET)
        status = add_triangle(s);
    *state = (*state + 1) % STATES;
    return status;
}

/* Goes to the next part in the rest of the line; false where it holds none. */
static bool goes_on(text_line *l, int state)
{
    do
        l->word = line_take(l);
    while (l->word && !line_is(l, words[state]) && !(state == FACET && line_is(l, "endsolid")));
    return l->word != NULL;
}

static tl_status read_line(soup *s, text_line *l, int *state, bool *inside)
{
    const bool name = !*inside;
    tl_status status = read_part(s, l, state, inside);
    while (status == TL_OK && !name && *inside && goes_on(l, *state))
        status = read_part(s, l, state, inside);
    return status;
}

static tl_status read_text(soup *s, char *text, size_t count)
{
    tl_status status = text_check(s, text, count);
    text_line l = {.next = text};
    int state = FACET;
    bool inside = false;
    while (status == TL_OK && line_next(&l))
        status = read_line(s, &l, &state, &inside);
    if (status == TL_OK && inside)
        return SOUP_FAULT(s, " ends at line %zu where '%s' is expected: it is truncated; export it again", l.number,
                          state == FACET ? "endsolid" : words[state]);
    return status;
}

/* Some programs begin binary files with "solid" too: the size decides. */
tl_status read_stl(soup *s, char *text, size_t count)
{
    size_t triangles = count >= HEADER_BYTES ? (size_t)number_at(text + HEADER_BYTES - 4, UINT32, false) : 0;
    size_t whole = HEADER_BYTES + triangles * TRIANGLE_BYTES;
    if (count >= HEADER_BYTES && count == whole)
        return read_binary(s, text, triangles);
    const char *begin = text;
    while (text_space(*begin))
        begin++;
    if (strncmp(begin, "solid", 5) == 0 && !memchr(text, '\0', count))
        return read_text(s, text, count);
    if (count < HEADER_BYTES)
        return SOUP_FAULT(s, " is no STL: it holds %zu bytes and does not begin with 'solid'", count);
    return SOUP_FAULT(s, " says it has %zu triangles, which take %zu bytes, but holds %zu bytes: it is %s, or no STL",
                      triangles, whole, count, count < whole ? "truncated" : "damaged");
}
