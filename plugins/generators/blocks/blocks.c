/* blocks.c - generator "blocks": the blocks of a JSON file, as docs/block_model.md describes it and model:write_blocks
 * writes it. Names that the description does not know are left aside, so that other programs may add their own. */
#include "json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>
#include <talus/version.h>

#define FORMAT "talus block model"
#define VERSION 1
/* Most planes of a joint set and most corners of a block: what the model takes. */
#define MOST_PLANES 1e6
#define MOST_CORNERS 4096
#define MOST_LOOPS (4 * MOST_CORNERS)
/* Bytes of a sentence. */
#define WRONG_TEXT 256

typedef struct params {
    const char *file;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, params, file, "", "block model in JSON", .flags = TL_PARAM_REQUIRED | TL_PARAM_FILE),
};

/* A block's body number and its index, to be sorted. */
typedef struct member {
    double body;
    size_t index;
} member;

typedef struct joint_name {
    const char *name;
    uint32_t number;
    double planes;
} joint_name;

typedef struct reader {
    const tl_host *host;
    json_tree tree;
    joint_name *joints;
    size_t joint_count;
    member *members;
    size_t block_count;
    /* of the block at hand */
    tl_vec3 vertex[MOST_CORNERS];
    uint32_t start[MOST_CORNERS + 1], loop[MOST_LOOPS];
    tl_tag tag[MOST_CORNERS];
} reader;

static const char *const type_names[] = {"null",   "true or false", "a number", "a text in quotes",
                                         "a list", "an object"};

/* Refuses the file, with a sentence on one of its lines. */
static TL_PRINTF(3, 4) tl_status wrong(const reader *r, size_t line, const char *format, ...)
{
    char text[WRONG_TEXT];
    va_list arguments;
    va_start(arguments, format);
    tl_text_vprint(text, sizeof text, format, arguments);
    va_end(arguments);
    return r->host->fail(r->host, TL_E_GEOMETRY, "file '%.200s', line %zu: %s", r->tree.file, line, text);
}

/* The item `key` of an object, which is of this type if it is there; NULL where it is not. */
static tl_status look_for(const reader *r, const json *object, const char *key, json_type type, const json **item)
{
    *item = json_get(&r->tree, object, key);
    if (!*item || (*item)->type == type)
        return TL_OK;
    return wrong(r, (*item)->line, "'%s' must be %s", key, type_names[type]);
}

/* The same of one that must be there. */
static tl_status take(const reader *r, const json *object, const char *key, json_type type, const json **item)
{
    tl_status status = look_for(r, object, key, type, item);
    if (status == TL_OK && !*item)
        return wrong(r, object->line, "'%s' is missing; it is %s", key, type_names[type]);
    return status;
}

/* A whole number in [low, high], or `fallback` when it is not there and there is a fallback >= low. */
static tl_status take_whole(const reader *r, const json *object, const char *key, double low, double high,
                            double fallback, double *number)
{
    const json *item;
    tl_status status = (fallback >= low ? look_for : take)(r, object, key, JSON_NUMBER, &item);
    *number = status == TL_OK && item ? item->number : fallback;
    if (status != TL_OK || !item || (*number >= low && *number <= high && !(floor(*number) < *number)))
        return status;
    return wrong(r, item->line, "%s = %g is not a whole number in [%g, %g]", key, *number, low, high);
}

/* ---------------------------------------------------------------- joints ----------------- */

static tl_status read_joints(reader *r, const json *root)
{
    const json *list;
    tl_status status = look_for(r, root, "joints", JSON_LIST, &list);
    if (status != TL_OK || !list)
        return status;
    r->joints = calloc(list->count + 1, sizeof *r->joints);
    if (!r->joints)
        return r->host->fail(r->host, TL_E_MEMORY, "out of memory");
    for (const json *item = json_first(&r->tree, list); item; item = json_next(&r->tree, item)) {
        joint_name *joint = &r->joints[r->joint_count];
        const json *name;
        status = take(r, item, "name", JSON_TEXT, &name);
        if (status == TL_OK)
            status = take_whole(r, item, "planes", 0, MOST_PLANES, -1, &joint->planes);
        if (status == TL_OK)
            status = r->host->joint(r->host, name->text, &joint->number);
        if (status != TL_OK)
            return status;
        joint->name = name->text;
        r->joint_count++;
        for (double taken = 0; taken < joint->planes;)
            taken = r->host->next_plane(r->host, joint->number);
    }
    return TL_OK;
}

static tl_status read_tag(const reader *r, const json *face, tl_tag *tag)
{
    *tag = (tl_tag){0, 0};
    const json *name;
    tl_status status = look_for(r, face, "joint", JSON_TEXT, &name);
    if (status != TL_OK || !name)
        return status;
    for (size_t i = 0; i < r->joint_count; i++) {
        if (strcmp(r->joints[i].name, name->text) != 0)
            continue;
        double plane;
        status = take_whole(r, face, "plane", 1, r->joints[i].planes, 0, &plane);
        if (status == TL_OK)
            *tag = (tl_tag){r->joints[i].number, (uint32_t)plane};
        return status;
    }
    return wrong(r, name->line, "joint '%.80s' is not among the file's joints", name->text);
}

/* ---------------------------------------------------------------- blocks ----------------- */

static tl_status read_vertices(reader *r, const json *block, tl_block_shape *shape)
{
    const json *list;
    tl_status status = take(r, block, "vertices", JSON_LIST, &list);
    if (status != TL_OK)
        return status;
    if (list->count > MOST_CORNERS)
        return wrong(r, list->line, "a block has more than 4096 vertices");
    for (const json *item = json_first(&r->tree, list); item; item = json_next(&r->tree, item)) {
        double at[3];
        int count = 0;
        if (item->type == JSON_LIST && item->count == 3)
            for (const json *x = json_first(&r->tree, item); x; x = json_next(&r->tree, x))
                if (x->type == JSON_NUMBER)
                    at[count++] = x->number;
        if (count != 3)
            return wrong(r, item->line, "a vertex must be a list of three numbers");
        r->vertex[shape->vertex_count++] = (tl_vec3){at[0], at[1], at[2]};
    }
    shape->vertices = r->vertex;
    return TL_OK;
}

static tl_status read_face(reader *r, const json *face, tl_block_shape *shape)
{
    const json *list;
    tl_status status = take(r, face, "vertices", JSON_LIST, &list);
    if (status == TL_OK)
        status = read_tag(r, face, &r->tag[shape->face_count]);
    if (status != TL_OK)
        return status;
    uint32_t end = r->start[shape->face_count];
    if (list->count > MOST_LOOPS - end)
        return wrong(r, list->line, "the faces of a block have too many corners");
    for (const json *item = json_first(&r->tree, list); item; item = json_next(&r->tree, item)) {
        double v = item->type == JSON_NUMBER ? item->number : -1;
        if (!(v >= 0 && v < (double)shape->vertex_count) || floor(v) < v)
            return wrong(r, item->line, "a corner must be the number of one of the block's vertices, from 0");
        r->loop[end++] = (uint32_t)v;
    }
    r->start[++shape->face_count] = end;
    return TL_OK;
}

static tl_status read_faces(reader *r, const json *block, tl_block_shape *shape)
{
    const json *list;
    tl_status status = take(r, block, "faces", JSON_LIST, &list);
    if (status != TL_OK)
        return status;
    if (list->count > MOST_CORNERS)
        return wrong(r, list->line, "a block has more than 4096 faces");
    for (const json *item = json_first(&r->tree, list); item && status == TL_OK; item = json_next(&r->tree, item))
        status = read_face(r, item, shape);
    shape->start = r->start;
    shape->loops = r->loop;
    shape->tags = r->tag;
    return status;
}

static tl_status read_fixed(const reader *r, const json *block, uint32_t *fixed)
{
    static const char *const names[] = {"x", "y", "z", "rotation"};
    const json *list;
    tl_status status = look_for(r, block, "fixed", JSON_LIST, &list);
    if (status != TL_OK || !list)
        return status;
    for (const json *item = json_first(&r->tree, list); item; item = json_next(&r->tree, item)) {
        uint32_t bit = 0;
        for (uint32_t i = 0; i < 4 && item->type == JSON_TEXT; i++)
            bit |= strcmp(item->text, names[i]) == 0 ? 1u << i : 0;
        if (!bit)
            return wrong(r, item->line, "'fixed' lists some of \"x\", \"y\", \"z\" and \"rotation\"");
        *fixed |= bit;
    }
    return TL_OK;
}

static tl_status read_block(reader *r, const json *block)
{
    tl_block_shape shape = {.size = sizeof shape};
    member *m = &r->members[r->block_count];
    const json *density, *group = NULL, *hidden = NULL;
    tl_status status = take(r, block, "density", JSON_NUMBER, &density);
    if (status == TL_OK)
        status = look_for(r, block, "group", JSON_TEXT, &group);
    if (status == TL_OK)
        status = look_for(r, block, "hidden", JSON_BOOL, &hidden);
    if (status == TL_OK)
        status = take_whole(r, block, "body", 0, 1e15, 0, &m->body);
    if (status == TL_OK)
        status = read_fixed(r, block, &shape.fixed);
    if (status == TL_OK)
        status = read_vertices(r, block, &shape);
    if (status == TL_OK)
        status = read_faces(r, block, &shape);
    if (status != TL_OK)
        return status;
    shape.density = density->number;
    shape.group = group ? group->text : "";
    shape.hidden = hidden && hidden->number > 0;
    m->index = r->host->block_count(r->host);
    r->block_count++;
    return r->host->create_block(r->host, &shape);
}

/* ---------------------------------------------------------------- bodies ----------------- */

static int by_body(const void *left, const void *right)
{
    const member *a = left, *b = right;
    if (a->body < b->body || a->body > b->body)
        return a->body < b->body ? -1 : 1;
    return (a->index > b->index) - (a->index < b->index);
}

/* Joins the blocks of one body number; 0 is none. */
static tl_status join_bodies(reader *r)
{
    size_t *indices = malloc((r->block_count + 1) * sizeof *indices);
    if (!indices)
        return r->host->fail(r->host, TL_E_MEMORY, "out of memory");
    qsort(r->members, r->block_count, sizeof *r->members, by_body);
    tl_status status = TL_OK;
    for (size_t from = 0, to = 0; from < r->block_count && status == TL_OK; from = to) {
        size_t count = 0;
        for (; to < r->block_count &&
               by_body(&(member){r->members[to].body, 0}, &(member){r->members[from].body, 0}) == 0;
             to++)
            indices[count++] = r->members[to].index;
        if (count > 1 && r->members[from].body > 0)
            status = r->host->join(r->host, indices, count);
    }
    free(indices);
    return status;
}

/* ---------------------------------------------------------------- the file --------------- */

static tl_status check_head(const reader *r, const json *root)
{
    const json *format = json_get(&r->tree, root, "format");
    const json *version = json_get(&r->tree, root, "version");
    if (!format || format->type != JSON_TEXT || strcmp(format->text, FORMAT) != 0)
        return wrong(r, root->line, "the file is no block model: it lacks \"format\": \"" FORMAT "\"");
    if (!version || version->type != JSON_NUMBER || version->number < VERSION || version->number > VERSION)
        return wrong(r, root->line, "the block model is not of version 1, which alone can be read");
    return TL_OK;
}

static tl_status read_model(reader *r)
{
    const json *root = &r->tree.nodes[1], *list;
    tl_status status = check_head(r, root);
    if (status == TL_OK)
        status = read_joints(r, root);
    if (status == TL_OK)
        status = take(r, root, "blocks", JSON_LIST, &list);
    if (status != TL_OK)
        return status;
    r->members = malloc((list->count + 1) * sizeof *r->members);
    if (!r->members)
        return r->host->fail(r->host, TL_E_MEMORY, "out of memory");
    for (const json *item = json_first(&r->tree, list); item && status == TL_OK; item = json_next(&r->tree, item)) {
        status = read_block(r, item);
        if (status == TL_OK)
            status = r->host->progress(r->host, (double)r->block_count / (double)list->count);
    }
    return status == TL_OK ? join_bodies(r) : status;
}

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    reader *r = calloc(1, sizeof *r);
    if (!r)
        return host->fail(host, TL_E_MEMORY, "out of memory");
    r->host = host;
    r->tree = (json_tree){.host = host, .file = p->file};
    char *text = NULL;
    tl_status status = json_read(&r->tree, &text);
    if (status == TL_OK)
        status = read_model(r);
    free(text);
    free(r->tree.nodes);
    free(r->joints);
    free(r->members);
    free(r);
    return status;
}

static const tl_kind kind =
    TL_GENERATOR_KIND(generate, .name = "blocks", .doc = "Creates the blocks of a block model in JSON.",
                      TL_KIND_PARAMS(params, param_table));

TL_PLUGIN(kind, .id = "talus.blocks", .version = TALUS_VERSION, .doc = "Block model generator.",
          .licence = "BSD-3-Clause");
