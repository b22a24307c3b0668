/* obj.c - reads the corners (v) and faces (f) of a Wavefront OBJ file. A face has three corners or more,
 * each a number of a vertex counted from 1, or from the last one when negative; what follows a slash
 * (texture, normal) is left aside, as are names, groups, materials, lines and points. */
#include "text.h"

#include <stdlib.h>

/* Most corners of one face. */
#define MOST_SIDES 4096

static const char *const ignored[] = {"vt",     "vn",    "vp",       "g",          "o",
                                      "s",      "mg",    "usemtl",   "mtllib",     "usemap",
                                      "maplib", "l",     "p",        "shadow_obj", "trace_obj",
                                      "lod",    "bevel", "c_interp", "d_interp"};

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
            return m->host->fail(m->host, TL_E_GEOMETRY,
                                 "file '%.200s', line %zu: a face has more than %d corners",
                                 m->file, l->number, MOST_SIDES);
        corner[count] = vertex_of(m, word);
        if (corner[count] == NONE)
            return m->host->fail(m->host, TL_E_GEOMETRY,
                                 "file '%.200s', line %zu: '%.40s' names none of the %zu vertices "
                                 "given before it; the file is damaged",
                                 m->file, l->number, word, m->vertices);
    }
    if (count < 3)
        return m->host->fail(
            m->host, TL_E_GEOMETRY,
            "file '%.200s', line %zu: a face of %zu corners; it must have 3 or more", m->file,
            l->number, count);
    return mesh_add_face(m, corner, count);
}

static tl_status read_line(mesh *m, line *l)
{
    if (*l->word == '#')
        return TL_OK;
    if (line_is(l, "f"))
        return read_face(m, l);
    if (line_is(l, "v")) {
        tl_vec3 p;
        tl_status status = line_point(m->host, m->file, l, &p);
        return status == TL_OK ? mesh_add_vertex(m, p, "line", l->number) : status;
    }
    for (size_t i = 0; i < sizeof ignored / sizeof *ignored; i++)
        if (line_is(l, ignored[i]))
            return TL_OK;
    return m->host->fail(
        m->host, TL_E_GEOMETRY,
        "file '%.200s', line %zu: '%.40s' is not a word of OBJ; the file is damaged, "
        "or no OBJ",
        m->file, l->number, l->word);
}

tl_status obj_read(mesh *m, const bytes *data)
{
    tl_status status = text_check(m->host, m->file, data);
    line l = {.next = data->at};
    while (status == TL_OK && line_next(&l))
        status = read_line(m, &l);
    return status;
}
