/* soup.c - gathers the faces of a file, and calls its reader. */
#include "soup.h"

#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>

/* Limit: larger files are refused: no model has blocks for them. */
#define MOST_BYTES ((size_t)1 << 30)
/* Constant: digits of a double that matter. */
#define MOST_DIGITS 17

tl_status soup_no_memory(const soup *s)
{
    return s->host->fail(s->host, TL_E_MEMORY, "file '%.200s': out of memory", s->file);
}

tl_status soup_vertex(soup *s, tl_vec3 at, const char *place, size_t number)
{
    double largest = fmax(fmax(fabs(at.x), fabs(at.y)), fabs(at.z));
    if (!tl_v3_finite(at) || largest > LARGEST_COORDINATE)
        return s->host->fail(s->host, TL_E_NUMERIC,
                             "file '%.200s', %s %zu: the corner {%g, %g, %g} is not finite or beyond "
                             "%g; the file is damaged",
                             s->file, place, number, at.x, at.y, at.z, LARGEST_COORDINATE);
    tl_vec3 *vertex =
        s->vertices < MOST_CORNERS ? tl_grown(s->vertex, &s->vertex_capacity, s->vertices + 1, sizeof *vertex) : NULL;
    if (!vertex)
        return soup_no_memory(s);
    s->vertex = vertex;
    s->vertex[s->vertices++] = at;
    s->reach = fmax(s->reach, largest);
    return TL_OK;
}

tl_status soup_face(soup *s, const uint32_t *corner, size_t count)
{
    tl_status status = s->objects ? TL_OK : soup_object(s, "", 0, NULL, 0);
    size_t corners = s->corners + count;
    uint32_t *all = corners < MOST_CORNERS ? tl_grown(s->corner, &s->corner_capacity, corners, sizeof *all) : NULL;
    s->corner = all ? all : s->corner;
    uint32_t *start = tl_grown(s->start, &s->face_capacity, s->faces + 2, sizeof *start);
    s->start = start ? start : s->start;
    if (!all || !start || status != TL_OK)
        return soup_no_memory(s);
    memcpy(s->corner + s->corners, corner, count * sizeof *corner);
    s->start[s->faces++] = (uint32_t)s->corners;
    s->corners = corners;
    s->start[s->faces] = (uint32_t)s->corners;
    return TL_OK;
}

/* Writes a name that is too long: what fits of it, in whole letters of UTF-8, and a number made of all of it (FNV-1a),
 * so that names which differ stay apart. Returns its length. */
static size_t short_name(const char *name, size_t length, char to[LONGEST_NAME + 1])
{
    uint32_t number = 2166136261u;
    for (size_t i = 0; i < length; i++)
        number = (number ^ (unsigned char)name[i]) * 16777619u;
    char tail[10];
    tl_text_print(tail, sizeof tail, "~%08x", number);
    size_t head = LONGEST_NAME - strlen(tail);
    while (head > 0 && ((unsigned char)name[head] & 0xc0) == 0x80)
        head--;
    memcpy(to, name, head);
    memcpy(to + head, tail, strlen(tail) + 1);
    return strlen(to);
}

/* Keeps a name; that of the object before is kept once. */
static bool keep_name(soup *s, const char *name, size_t length, uint32_t before, uint32_t *kept)
{
    char fits[LONGEST_NAME + 1];
    length = name ? length : 0;
    if (length > LONGEST_NAME) {
        s->long_names++;
        length = short_name(name, length, fits);
        name = fits;
    }
    *kept = before;
    if (s->names_length > 0 && strlen(s->names + before) == length &&
        (length == 0 || memcmp(s->names + before, name, length) == 0))
        return true;
    *kept = 0;
    if (length == 0 && s->names_length > 0)
        return true;
    size_t needed = s->names_length + length + 2;
    char *names = needed < MOST_CORNERS ? tl_grown(s->names, &s->names_capacity, needed, 1) : NULL;
    if (!names)
        return false;
    s->names = names;
    if (s->names_length == 0)
        names[s->names_length++] = '\0';
    if (length == 0)
        return true;
    *kept = (uint32_t)s->names_length;
    memcpy(names + *kept, name, length);
    names[*kept + length] = '\0';
    s->names_length += length + 1;
    return true;
}

tl_status soup_object(soup *s, const char *name, size_t length, const char *group, size_t group_length)
{
    bool replaces = s->objects > 0 && s->object[s->objects - 1].face == s->faces;
    file_object *list = tl_grown(s->object, &s->object_capacity, s->objects + 1, sizeof *list);
    if (!list)
        return soup_no_memory(s);
    s->object = list;
    file_object *now = &list[s->objects - replaces];
    const file_object before = s->objects ? list[s->objects - 1] : (file_object){0};
    now->face = (uint32_t)s->faces;
    now->again = 0;
    if (!keep_name(s, name, length, before.name, &now->name) ||
        !keep_name(s, group, group_length, before.group, &now->group))
        return soup_no_memory(s);
    s->objects += !replaces;
    return TL_OK;
}

tl_status soup_group(soup *s, const char *group, size_t length)
{
    file_object *last = &s->object[s->objects - 1];
    return keep_name(s, group, length, last->group, &last->group) ? TL_OK : soup_no_memory(s);
}

/* A name and the object that has it. */
typedef struct named {
    const char *name;
    uint32_t object;
} named;

static int by_name(const void *left, const void *right)
{
    const named *a = left, *b = right;
    int order = strcmp(a->name, b->name);
    return order != 0 ? order : (a->object > b->object) - (a->object < b->object);
}

/* Counts how often the name of each object came before. */
static tl_status count_names(soup *s)
{
    named *list = malloc((s->objects + 1) * sizeof *list);
    if (!list)
        return soup_no_memory(s);
    for (uint32_t i = 0; i < s->objects; i++)
        list[i] = (named){s->names + s->object[i].name, i};
    qsort(list, s->objects, sizeof *list, by_name);
    for (size_t i = 0; i < s->objects; i++) {
        const bool same = i > 0 && *list[i].name && strcmp(list[i - 1].name, list[i].name) == 0;
        s->object[list[i].object].again = same ? s->object[list[i - 1].object].again + 1 : 0;
    }
    free(list);
    return TL_OK;
}

tl_status soup_check(const soup *s)
{
    for (size_t f = 0; f < s->faces; f++)
        for (uint32_t h = s->start[f]; h < s->start[f + 1]; h++)
            if (s->corner[h] >= s->vertices)
                return SOUP_FAULT(s,
                                  ": face %zu names vertex %u, but there are %zu, counted from 0; the file is damaged",
                                  f + 1, s->corner[h], s->vertices);
    return TL_OK;
}

double soup_resolution(const soup *s)
{
    if (s->rounding > 0)
        return s->rounding * s->reach;
    double unit = 1, power = 1;
    for (int i = 0; i < s->decimals && i < MOST_DIGITS; i++)
        unit /= 10;
    for (; power <= s->reach && power < LARGEST_COORDINATE;)
        power *= 10;
    for (int i = 0; i < s->digits && i < MOST_DIGITS; i++)
        power /= 10;
    return fmax(unit, power);
}

void soup_drop_faces(soup *s)
{
    free(s->vertex);
    free(s->corner);
    free(s->start);
    s->vertex = NULL;
    s->corner = s->start = NULL;
}

void soup_free(soup *s)
{
    soup_drop_faces(s);
    free(s->object);
    free(s->names);
}

/* Whether a file's name ends in `ending`, in letters of any case. */
static bool ends_in(const char *file, const char *ending)
{
    size_t length = strlen(file), tail = strlen(ending);
    if (length < tail)
        return false;
    for (size_t i = 0; i < tail; i++) {
        char letter = file[length - tail + i];
        if ((letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter) != ending[i])
            return false;
    }
    return true;
}

static const struct {
    const char *ending;
    tl_status (*read)(soup *s, char *text, size_t count);
} readers[] = {{".obj", read_obj},   {".stl", read_stl},  {".ply", read_ply},
               {".vtk", read_vtk},   {".dat", read_poly}, {".3ddat", read_poly},
               {".3dec", read_poly}, {".txt", read_poly}, {".json", read_compas}};

tl_status soup_read(soup *s)
{
    for (size_t i = 0; i < sizeof readers / sizeof *readers; i++) {
        if (!ends_in(s->file, readers[i].ending))
            continue;
        char *text;
        size_t count;
        tl_status status = tl_file_bytes(s->host, s->file, MOST_BYTES, &text, &count);
        if (status == TL_OK && count == 0)
            status =
                s->host->fail(s->host, TL_E_GEOMETRY, "file '%.200s' is empty (0 bytes); export it again", s->file);
        if (status == TL_OK)
            status = readers[i].read(s, text, count);
        free(text);
        if (s->objects > 0 && s->object[s->objects - 1].face == s->faces)
            s->objects--; /* a name without faces */
        if (status == TL_OK)
            status = soup_check(s);
        if (status == TL_OK && s->objects > 0)
            status = count_names(s);
        if (status == TL_OK && s->faces == 0)
            status = s->host->fail(s->host, TL_E_GEOMETRY,
                                   "file '%.200s' holds no faces; export the solids with the faces of their surfaces",
                                   s->file);
        return status;
    }
    return s->host->fail(
        s->host, TL_E_ARGUMENT,
        "file '%.200s' does not end in .obj, .stl, .ply, .vtk, .json, .dat, .3ddat, .3dec or .txt; export it so",
        s->file);
}
