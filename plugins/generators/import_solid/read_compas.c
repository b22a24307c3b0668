/* read_compas.c - meshes that compas, compas_assembly and compas_dem write in JSON, wherever they stand in the file:
 *
 *     {"vertex": {"0": {"x": 0, "y": 0, "z": 0}, ...}, "face": {"0": [0, 1, 2], ...}}     a mesh
 *     {"vertices": [[0, 0, 0], ...], "faces": [[0, 1, 2], ...]}                           a polyhedron
 *
 * The wrappers "data" and "value" with their "dtype", nodes of graphs, elements and lists are gone through. Each mesh
 * is an object. It is named by the last key around it that is no wrapper's. It is in the group "support" where
 * "is_support" is true. A "transformation" beside or around a mesh moves it. Edges and contacts are left aside. */
#include "json.h"
#include "text.h"

#include <string.h>
#include <talus/kit.h>

/* Constant: group of the objects that carry the others. */
#define SUPPORT "support"

/* A vertex's key and its index among the soup's. */
typedef struct keyed {
    uint32_t key, vertex;
} keyed;

/* What holds around a place in the file. */
typedef struct surroundings {
    const char *key; /* of the object; NULL: none */
    bool support;
    double matrix[3][4];
} surroundings;

typedef struct reader {
    soup *s;
    const char *text;
    keyed *key;
    size_t keys, key_capacity;
    uint32_t corner[MOST_SIDES];
} reader;

static tl_status wrong(const reader *r, const char *at, const char *wanted)
{
    return SOUP_FAULT(r->s, ", line %zu: %s is expected at '%.20s'; the file is damaged", json_line(r->text, at),
                      wanted, at);
}

/* A number, as it stands or between quotes; NULL is none. */
static bool read_number(reader *r, const char *at, double *number, bool place)
{
    const char *end;
    if (!at)
        return false;
    *number = tl_number_read(at, &end);
    if (end == at)
        return false;
    if (place) {
        char word[40];
        size_t length = (size_t)(end - at) < sizeof word - 1 ? (size_t)(end - at) : sizeof word - 1;
        memcpy(word, at, length);
        word[length] = '\0';
        text_number(r->s, word, 0, number);
        *number = tl_number_read(at, &end);
    }
    return true;
}

/* A key or a vertex's number, 0 or "0". */
static bool read_key(const char *at, uint32_t *key)
{
    uint64_t value = 0;
    bool quoted = *at == '"';
    at += quoted;
    const char *begin = at;
    for (; *at >= '0' && *at <= '9' && value < MOST_CORNERS; at++)
        value = 10 * value + (uint64_t)(*at - '0');
    *key = (uint32_t)value;
    return at != begin && value < MOST_CORNERS && (quoted ? *at == '"' : !strchr(".eE", *at) || !*at);
}

static tl_status add_vertex(reader *r, const char *at, uint32_t key, const double *given, const surroundings *around)
{
    double moved[3];
    keyed *list = tl_grown(r->key, &r->key_capacity, r->keys + 1, sizeof *list);
    if (!list)
        return soup_no_memory(r->s);
    r->key = list;
    list[r->keys++] = (keyed){key, (uint32_t)r->s->vertices};
    for (int i = 0; i < 3; i++)
        moved[i] = around->matrix[i][0] * given[0] + around->matrix[i][1] * given[1] + around->matrix[i][2] * given[2] +
                   around->matrix[i][3];
    return isfinite(moved[0] + moved[1] + moved[2])
               ? soup_vertex(r->s, (tl_vec3){moved[0], moved[1], moved[2]}, "vertex", r->keys)
               : wrong(r, at, "a vertex of finite numbers");
}

static tl_status read_vertices(reader *r, const char *list, const surroundings *around)
{
    static const char *const axes[] = {"x", "y", "z"};
    const bool object = *list == '{';
    uint32_t key = 0;
    r->keys = 0;
    for (const char *item = json_first(list); item; item = json_next(item, object), key++) {
        const char *value = object ? json_value(item) : item, *x = *value == '[' ? json_first(value) : NULL;
        double at[3] = {0, 0, 0};
        if (object && !read_key(item, &key))
            return wrong(r, item, "the number of a vertex");
        for (int i = 0; i < 3; i++) {
            const char *word = *value == '[' ? x : json_get(value, axes[i]);
            if (!read_number(r, word, &at[i], true) && (word || *value == '['))
                return wrong(r, value, "a vertex of three numbers");
            x = x ? json_next(x, false) : NULL;
        }
        tl_status status = add_vertex(r, item, key, at, around);
        if (status != TL_OK)
            return status;
    }
    return TL_OK;
}

static int by_key(const void *left, const void *right)
{
    const keyed *a = left, *b = right;
    return (a->key > b->key) - (a->key < b->key);
}

static tl_status read_face(reader *r, const char *list)
{
    size_t count = 0;
    if (*list != '[')
        return *list == 'n' ? TL_OK : wrong(r, list, "a list of vertices");
    for (const char *item = json_first(list); item; item = json_next(item, false), count++) {
        keyed wanted = {0, 0};
        const keyed *found = r->keys > 0 && read_key(item, &wanted.key)
                                 ? bsearch(&wanted, r->key, r->keys, sizeof wanted, by_key)
                                 : NULL;
        if (!found || count == MOST_SIDES)
            return wrong(r, item, "the number of one of the vertices of the mesh");
        r->corner[count] = found->vertex;
    }
    return count < 3 ? wrong(r, list, "a face of 3 corners or more") : soup_face(r->s, r->corner, count);
}

static tl_status read_mesh(reader *r, const char *vertices, const char *faces, const surroundings *around)
{
    size_t length = around->key ? (size_t)(json_end(around->key) - around->key) - 2 : 0;
    const char *group = around->support ? SUPPORT : NULL;
    tl_status status = soup_object(r->s, around->key ? around->key + 1 : "", length, group, group ? strlen(group) : 0);
    if (status == TL_OK)
        status = read_vertices(r, vertices, around);
    if (r->keys > 0)
        qsort(r->key, r->keys, sizeof *r->key, by_key);
    const bool object = *faces == '{';
    for (const char *item = json_first(faces); item && status == TL_OK; item = json_next(item, object))
        status = read_face(r, object ? json_value(item) : item);
    return status;
}

/* Puts the transformation of an object before those around it; what has none changes nothing. */
static tl_status read_transformation(reader *r, const char *at, surroundings *here)
{
    const char *matrix = at ? json_get(at, "data") : NULL;
    double all[4][4], product[3][4];
    matrix = json_get(matrix ? matrix : at, "matrix");
    if (!matrix || *matrix != '[')
        return TL_OK;
    const char *row = json_first(matrix);
    for (int i = 0; i < 4; i++) {
        const char *item = row ? json_first(row) : NULL;
        for (int j = 0; j < 4; j++) {
            if (!read_number(r, item, &all[i][j], false))
                return wrong(r, matrix, "a matrix of 4 x 4 numbers");
            item = json_next(item, false);
        }
        row = json_next(row, false);
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            product[i][j] = here->matrix[i][0] * all[0][j] + here->matrix[i][1] * all[1][j] +
                            here->matrix[i][2] * all[2][j] + (j == 3 ? here->matrix[i][3] : 0);
    memcpy(here->matrix, product, sizeof product);
    return TL_OK;
}

static bool is_one_of(const char *key, const char *const *words)
{
    for (; *words; words++)
        if (json_is(key, *words))
            return true;
    return false;
}

static tl_status read_value(reader *r, const char *at, surroundings here)
{
    static const char *const aside[] = {"edge",     "adjacency",  "halfedge",     "edgedata", "facedata",
                                        "contacts", "interfaces", "interactions", NULL};
    static const char *const wrappers[] = {"data",   "value",      "geometry",      "graph",    "node",
                                           "block",  "blocks",     "elements",      "assembly", "mesh",
                                           "meshes", "attributes", "modelgeometry", NULL};
    const bool object = *at == '{';
    if (!object && *at != '[')
        return TL_OK;
    if (object) {
        const char *support = NULL, *transformation = NULL, *vertices = NULL, *faces = NULL;
        for (const char *item = json_first(at); item; item = json_next(item, true)) {
            const char *value = json_value(item);
            support = json_is(item, "is_support") ? value : support;
            transformation = json_is(item, "transformation") ? value : transformation;
            vertices = json_is(item, "vertex") || json_is(item, "vertices") ? value : vertices;
            faces = json_is(item, "face") || json_is(item, "faces") ? value : faces;
        }
        here.support |= support && *support == 't';
        tl_status status = read_transformation(r, transformation, &here);
        if (status != TL_OK)
            return status;
        if (vertices && faces && json_first(vertices) && json_first(faces))
            return read_mesh(r, vertices, faces, &here);
    }
    for (const char *item = json_first(at); item; item = json_next(item, object)) {
        surroundings inside = here;
        if (object && is_one_of(item, aside))
            continue;
        if (object && !is_one_of(item, wrappers))
            inside.key = item;
        tl_status status = read_value(r, object ? json_value(item) : item, inside);
        if (status != TL_OK)
            return status;
    }
    return TL_OK;
}

tl_status read_compas(soup *s, char *text, size_t count)
{
    reader *r = calloc(1, sizeof *r);
    if (!r)
        return soup_no_memory(s);
    const char *value;
    r->s = s;
    r->text = text;
    tl_status status = json_check(s, text, count, &value);
    if (status == TL_OK && json_is(json_get(value, "format") ? json_get(value, "format") : "", "talus block model"))
        status = SOUP_FAULT(s, " is a block model of Talus: read it by the generator '%s'", "blocks");
    if (status == TL_OK)
        status = read_value(r, value, (surroundings){.matrix = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}});
    free(r->key);
    free(r);
    return status;
}
