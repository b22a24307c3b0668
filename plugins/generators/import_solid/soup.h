/* soup.h - the faces of a file, as its reader gives them: polygons of vertices, object by object. */
#ifndef IMPORT_SOLID_SOUP_H
#define IMPORT_SOLID_SOUP_H

#include <stdbool.h>
#include <talus/plugin.h>

/* Limit: coordinates beyond this, in the units of the file, are taken for a fault of it. */
#define LARGEST_COORDINATE 1e30
/* Limit: most corners of all faces together: indices have 32 bits. */
#define MOST_CORNERS 0x7fffffffu
/* Limit: most corners of one face. */
#define MOST_SIDES 4096
/* Limit: longest name of an object or a group, in bytes. The end of a longer one is replaced by a number that tells it
 * from others. */
#define LONGEST_NAME 63
#define NONE UINT32_MAX

/* A run of faces that are one object in the file. */
typedef struct file_object {
    uint32_t name, group; /* of the soup's names; 0: it has none */
    uint32_t face;        /* its first one; its last one is before the next object's first */
    uint32_t again;       /* how many objects before it have its name */
} file_object;

/* The corners of face f are corner[start[f]] .. corner[start[f + 1] - 1], indices into vertex. */
typedef struct soup {
    const tl_host *host;
    const char *file;
    tl_vec3 *vertex;
    size_t vertices, vertex_capacity;
    uint32_t *corner;
    size_t corners, corner_capacity;
    uint32_t *start;
    size_t faces, face_capacity;
    file_object *object;
    size_t objects, object_capacity;
    char *names; /* texts, each with a 0; the first is empty */
    size_t names_length, names_capacity;
    double reach;         /* largest coordinate */
    int decimals, digits; /* most digits after the point, and of a number, in a text */
    double rounding;      /* of binary numbers, relative; 0: it is a text */
    size_t unread;        /* commands of the file that are none of solids */
    size_t long_names;    /* how often a name was too long */
} soup;

/* Refuses the file, with a sentence that goes on behind its name. */
#define SOUP_FAULT(s, text, ...) (s)->host->fail((s)->host, TL_E_GEOMETRY, "file '%.200s'" text, (s)->file, __VA_ARGS__)

tl_status soup_no_memory(const soup *s);
/* Adds a vertex; an unusable coordinate is refused with the place (a line, vertex or triangle) it stands at. */
tl_status soup_vertex(soup *s, tl_vec3 at, const char *place, size_t number);
/* Adds a face of `count` corners to the last object; the first one if there is none. */
tl_status soup_face(soup *s, const uint32_t *corner, size_t count);
/* Begins an object. One without faces is replaced by the next. `group` may be NULL. */
tl_status soup_object(soup *s, const char *name, size_t length, const char *group, size_t group_length);
/* Gives the last object a group. */
tl_status soup_group(soup *s, const char *group, size_t length);
/* Refuses faces with a corner that is none of the vertices. */
tl_status soup_check(const soup *s);
/* How exact the coordinates are written: a unit of the last digit. */
double soup_resolution(const soup *s);
/* Frees vertices and faces, once all objects are closed. */
void soup_drop_faces(soup *s);
void soup_free(soup *s);

/* Reads s->file by the ending of its name. */
tl_status soup_read(soup *s);

/* The readers, of a whole file's bytes with a 0 at their end. Texts are cut up where they stand. */
tl_status read_obj(soup *s, char *text, size_t count);
tl_status read_stl(soup *s, char *text, size_t count);
tl_status read_ply(soup *s, char *text, size_t count);
tl_status read_vtk(soup *s, char *text, size_t count);
tl_status read_poly(soup *s, char *text, size_t count);
tl_status read_compas(soup *s, char *text, size_t count);

#endif
