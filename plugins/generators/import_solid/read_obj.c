/* read_obj.c - Wavefront OBJ: corners (v) and faces (f). A face has three corners or more, each a number of a vertex
 * counted from 1, or from the last one when negative. What follows a slash (texture, normal) is left aside, as are
 * materials, lines and points.
 *
 * Objects are what stands after each line `o`, with the group that the last line `g` names. Where a file has one line
 * `o` or none, they are what stands after each line `g`. */
#include "text.h"

#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>

static const char *const ignored[] = {"vt",        "vn",     "vp",     "s",        "mg",      "usemtl",
                                      "mtllib",    "usemap", "maplib", "l",        "p",       "shadow_obj",
                                      "trace_obj", "lod",    "bevel",  "c_interp", "d_interp"};

typedef struct reader {
    soup *s;
    text_line l;
    bool by_group;            /* objects are told apart by g */
    const char *name, *group; /* that were given last, or NULL */
    size_t name_length, group_length;
} reader;

/* Whether more than one line begins with the word `o`. */
static bool has_objects(const char *text)
{
    int count = 0;
    for (const char *at = text; *at && count < 2; at += *at == '\n') {
        while (text_space(*at) && *at != '\n')
            at++;
        count += (*at == 'o' || *at == 'O') && text_space(at[1]);
        at += strcspn(at, "\n");
    }
    return count > 1;
}

/* Index of the vertex a word of a face names, or NONE. */
static uint32_t vertex_of(const soup *s, const char *word)
{
    char *end;
    long long number = strtoll(word, &end, 10);
    long long count = (long long)s->vertices;
    if (end == word || (*end && *end != '/') || number == 0 || number > count || number < -count)
        return NONE;
    return (uint32_t)(number > 0 ? number - 1 : count + number);
}

static tl_status read_face(soup *s, text_line *l)
{
    uint32_t corner[MOST_SIDES];
    size_t count = 0;
    for (char *word; (word = line_take(l)) != NULL && *word != '#'; count++) {
        if (count == MOST_SIDES)
            return SOUP_FAULT(s, ", line %zu: a face has more than %d corners", l->number, MOST_SIDES);
        corner[count] = vertex_of(s, word);
        if (corner[count] == NONE)
            return SOUP_FAULT(s,
                              ", line %zu: '%.40s' names none of the %zu vertices given before it; the file is damaged",
                              l->number, word, s->vertices);
    }
    if (count < 3)
        return SOUP_FAULT(s, ", line %zu: a face of %zu corners; it must have 3 or more", l->number, count);
    return soup_face(s, corner, count);
}

static tl_status read_line(reader *r)
{
    soup *s = r->s;
    text_line *l = &r->l;
    size_t length;
    if (*l->word == '#')
        return TL_OK;
    if (line_is(l, "f"))
        return read_face(s, l);
    if (line_is(l, "v")) {
        tl_vec3 p;
        tl_status status = line_point(s, l, &p);
        return status == TL_OK ? soup_vertex(s, p, "line", l->number) : status;
    }
    if (line_is(l, "g")) {
        r->group = line_rest(l, &length);
        r->group_length = length;
        if (r->by_group)
            return soup_object(s, r->group, length, r->group, length);
        bool begun = s->objects > 0 && s->object[s->objects - 1].face < s->faces;
        return r->name && !begun ? soup_object(s, r->name, r->name_length, r->group, length) : TL_OK;
    }
    if (line_is(l, "o")) {
        r->name = line_rest(l, &length);
        r->name_length = length;
        bool own = r->by_group || !r->group; /* the object is its own group */
        return soup_object(s, r->name, length, own ? r->name : r->group, own ? length : r->group_length);
    }
    for (size_t i = 0; i < sizeof ignored / sizeof *ignored; i++)
        if (line_is(l, ignored[i]))
            return TL_OK;
    return SOUP_FAULT(s, ", line %zu: '%.40s' is not a word of OBJ; the file is damaged, or no OBJ", l->number,
                      l->word);
}

tl_status read_obj(soup *s, char *text, size_t count)
{
    tl_status status = text_check(s, text, count);
    reader r = {.s = s, .l = {.next = text}, .by_group = !has_objects(text)};
    while (status == TL_OK && line_next_joined(&r.l, "\\"))
        status = read_line(&r);
    return status;
}
