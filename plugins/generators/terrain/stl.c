/* stl.c - triangles of an STL, as text or binary. The normals of the file are not used.
 *
 * Binary: 80 bytes, the number of triangles (32 bits), then for each 12 little-endian floats (normal and three corners)
 * and 2 bytes. Text: words, of which "facet", "vertex" with three numbers, and "endfacet" count. */
#include "terrain.h"
#include "words.h"

#define HEADER_BYTES ((size_t)84)
#define TRIANGLE_BYTES ((size_t)50)

static uint32_t word_at(const char *at)
{
    uint32_t word = 0;
    for (int i = 0; i < 4; i++)
        word |= (uint32_t)(unsigned char)at[i] << 8 * i;
    return word;
}

static double float_at(const char *at)
{
    const uint32_t word = word_at(at);
    float value;
    memcpy(&value, &word, sizeof value);
    return (double)value;
}

static tl_status check_corner(const surface *s, tl_vec3 p, size_t number)
{
    if (fabs(p.x) <= FARTHEST && fabs(p.y) <= FARTHEST && fabs(p.z) <= FARTHEST)
        return TL_OK;
    return s->host->fail(s->host, TL_E_ARGUMENT,
                         "file '%.200s', triangle %zu: the corner {%g, %g, %g} is outside [-1e9, 1e9]", s->file, number,
                         p.x, p.y, p.z);
}

static tl_status read_binary(surface *s, const char *bytes, size_t triangles)
{
    tl_status status = TL_OK;
    for (size_t i = 0; i < triangles && status == TL_OK; i++) {
        const char *at = bytes + HEADER_BYTES + i * TRIANGLE_BYTES + 12;
        tl_vec3 corner[3];
        for (int k = 0; k < 3 && status == TL_OK; k++, at += 12) {
            corner[k] = tl_v3(float_at(at), float_at(at + 4), float_at(at + 8));
            status = check_corner(s, corner[k], i + 1);
        }
        if (status == TL_OK)
            status = surface_add(s, corner, 0, (uint32_t)(i + 1));
    }
    return status;
}

static tl_status read_vertex(const surface *s, words *w, size_t number, tl_vec3 *corner)
{
    char word[MOST_LETTERS + 1];
    double x[3];
    for (int k = 0; k < 3; k++)
        if (!words_take(w, word) || !word_number(word, &x[k]))
            return s->host->fail(s->host, TL_E_ARGUMENT, "file '%.200s', line %zu: the coordinate '%s' is no number",
                                 s->file, w->line, word);
    *corner = tl_v3(x[0], x[1], x[2]);
    return check_corner(s, *corner, number);
}

static tl_status read_text(surface *s, const char *text)
{
    words w = {text, 1};
    char word[MOST_LETTERS + 1] = "";
    tl_vec3 corner[3];
    int corners = -1; /* of the facet; -1: outside */
    tl_status status = TL_OK;
    while (status == TL_OK && words_take(&w, word)) {
        const bool begin = strcmp(word, "facet") == 0, vertex = strcmp(word, "vertex") == 0,
                   end = strcmp(word, "endfacet") == 0;
        if ((begin && corners >= 0) || (vertex && (corners < 0 || corners > 2)) || (end && corners != 3))
            return s->host->fail(s->host, TL_E_ARGUMENT,
                                 "file '%.200s', line %zu: '%s' where a facet has %d of 3 corners: it is damaged",
                                 s->file, w.line, word, corners < 0 ? 0 : corners);
        if (begin)
            corners = 0;
        else if (vertex)
            status = read_vertex(s, &w, s->count + 1, &corner[corners++]);
        else if (end)
            status = surface_add(s, corner, 0, (uint32_t)(s->count + 1));
        if (end)
            corners = -1;
    }
    if (status == TL_OK && corners >= 0)
        return s->host->fail(s->host, TL_E_ARGUMENT, "file '%.200s' ends in triangle %zu: it is truncated", s->file,
                             s->count + 1);
    return status;
}

tl_status stl_read(surface *s, const char *bytes, size_t count)
{
    const size_t triangles = count >= HEADER_BYTES ? word_at(bytes + HEADER_BYTES - 4) : 0;
    const size_t whole = HEADER_BYTES + triangles * TRIANGLE_BYTES;
    tl_status status;
    if (count >= HEADER_BYTES && count == whole)
        status = read_binary(s, bytes, triangles);
    else if (count >= 5 && memcmp(bytes, "solid", 5) == 0 && !memchr(bytes, '\0', count))
        status = read_text(s, bytes);
    else if (count < HEADER_BYTES)
        return s->host->fail(s->host, TL_E_ARGUMENT,
                             "file '%.200s' is no STL: %zu bytes that do not begin with 'solid'", s->file, count);
    else
        return s->host->fail(s->host, TL_E_ARGUMENT,
                             "file '%.200s' says it has %zu triangles, which take %zu bytes, but holds %zu: it is "
                             "truncated, or no STL",
                             s->file, triangles, whole, count);
    if (status == TL_OK && s->count == 0)
        return s->host->fail(s->host, TL_E_ARGUMENT, "file '%.200s' has no triangle", s->file);
    return status;
}
