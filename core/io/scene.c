/* scene.c - a frame: what a reader does not know yet of head and blocks, and what is new in every frame.
 *
 * The blocks that were sent are kept in order of id, as rows are. So one walk through both tells what has come,
 * changed and gone. A block's frame is that of its body, moved to the block's own centroid. So the quaternion of its
 * body turns it, and rows need nothing of an earlier frame. */
#include "io/scene.h"

#include "base/parallel.h"
#include "base/params.h"
#include "contact/detection.h"
#include "force/bear.h"
#include "io/extra_fields.h"
#include "io/json.h"
#include "io/scene_elements.h"
#include "io/scene_put.h"
#include "io/scene_zones.h"
#include "io/verdict.h"
#include "model/deformable.h"
#include "model/regroup.h"
#include "model/rows.h"
#include "model/scope.h"
#include "query/contact_fields.h"
#include "query/contact_polygons.h"
#include "query/point_fields.h"
#include "query/touching.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/history.h>
#include <talus/vmath.h>
#include <talus/zones.h>

/* ---------------------------------------------------------------- what is new ------------ */

/* What has come or changed, by row, and gone, by id. */
typedef struct news {
    uint32_t *rows;
    tl_id *gone;
    size_t row_count, gone_count;
} news;

static tl_scene_block block_of(const tl_model *m, uint32_t row)
{
    const tl_blocks *b = &m->blocks;
    return (tl_scene_block){.id = b->id[row],
                            .body = m->bodies.id[b->body[row]],
                            .group = b->group[row],
                            .changed = b->changed[row],
                            .density = b->density[row]};
}

static bool same(const tl_scene_block *a, const tl_scene_block *b)
{
    return a->id == b->id && a->body == b->body && a->group == b->group && a->changed == b->changed &&
           a->density == b->density;
}

/* Lists the blocks as they are in `next`, and what differs from those that were sent. */
static bool compare(tl_scene *scene, const tl_model *m, news *found)
{
    const tl_scene_known *sent = &scene->sent;
    tl_scene_known *next = &scene->next;
    size_t rows = m->blocks.table.rows;
    found->rows = malloc((rows + 1) * sizeof *found->rows);
    found->gone = malloc((sent->count + 1) * sizeof *found->gone);
    if (rows > next->capacity) {
        tl_scene_block *blocks = realloc(next->blocks, rows * sizeof *blocks);
        next->capacity = blocks ? rows : next->capacity;
        next->blocks = blocks ? blocks : next->blocks;
    }
    if (!found->rows || !found->gone || rows > next->capacity)
        return false;
    size_t k = 0;
    for (uint32_t row = 0; row < rows; row++) {
        tl_scene_block now = next->blocks[row] = block_of(m, row);
        while (k < sent->count && sent->blocks[k].id < now.id)
            found->gone[found->gone_count++] = sent->blocks[k++].id;
        bool known = k < sent->count && sent->blocks[k].id == now.id;
        if (!known || !same(&sent->blocks[k], &now))
            found->rows[found->row_count++] = row;
        k += known;
    }
    while (k < sent->count)
        found->gone[found->gone_count++] = sent->blocks[k++].id;
    next->count = rows;
    return true;
}

/* ---------------------------------------------------------------- histories -------------- */

/* Units of what a model is asked for by name; the rest has none. */
#define TERM(name, unit, doc) {#name, unit},
static const struct {
    const char *name, *unit;
} quantities[] = {
    TL_ENERGY(TERM) TL_ZONE_ENERGY(TERM){"max_velocity", "m/s"},
};
#undef TERM

static const char *unit_of(const tl_history *h)
{
    size_t count = 0;
    const tl_field *fields = h->source == TL_FROM_BLOCKS       ? tl_block_fields(&count)
                             : h->source == TL_FROM_CONTACTS   ? tl_contact_fields(&count)
                             : h->source == TL_FROM_ZONES      ? tl_zone_fields(&count)
                             : h->source == TL_FROM_GRIDPOINTS ? tl_gridpoint_fields(&count)
                                                               : NULL;
    for (size_t i = 0; i < count; i++)
        if (strcmp(fields[i].name, h->asked) == 0)
            return fields[i].unit;
    for (size_t i = 0; h->source == TL_FROM_MODEL && i < sizeof quantities / sizeof *quantities; i++)
        if (strcmp(quantities[i].name, h->asked) == 0)
            return quantities[i].unit;
    return "";
}

/* The numbers of all histories: of one with several "NAME 1", "NAME 2" ... */
static void put_histories(tl_piece *to, const tl_model *m)
{
    const tl_history *h;
    const char *between = "";
    for (size_t i = 0; (h = tl_history_at(m, i)) != NULL; i++)
        for (size_t k = 0; k < h->width; k++, between = ", ") {
            char name[TL_HISTORY_NAME + 16];
            snprintf(name, sizeof name, h->width > 1 ? "%s %zu" : "%s", h->name, k + 1);
            tl_json_print(to, "%r{\"name\": %s, \"unit\": %s}", between, name, unit_of(h));
        }
}

/* ---------------------------------------------------------------- HEAD --------------------
 *
 * HEAD: what does not change with the blocks, as JSON. */

static void put_fields(tl_piece *to, const tl_extra_field *fields, size_t count, bool more, const char *of)
{
    for (size_t i = 0; i < count; i++)
        tl_json_print(to, "%r{\"name\": %s, \"unit\": %s, \"of\": %s}", more || i ? ", " : "", fields[i].name,
                      fields[i].unit ? fields[i].unit : "", of);
}

/* The friction angle of a law, degrees; NaN where it has none. */
static double friction_of(const tl_law *law)
{
    for (uint32_t i = 0; law && i < law->kind->param_count; i++) {
        tl_param p = tl_param_row(law->kind->params, i, law->kind->param_stride);
        double value;
        if (p.type != TL_PARAM_REAL || strcmp(p.name, "friction") != 0 || strcmp(p.unit, "deg") != 0)
            continue;
        memcpy(&value, (const char *)law->params + p.offset, sizeof value);
        return value;
    }
    return NAN;
}

/* That of all planes and blocks of a joint; NaN where laws may differ. */
static double friction_of_joint(const tl_model *m, uint32_t joint)
{
    double friction = friction_of(tl_law_of_joint(m, (tl_tag){joint, 0}));
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const tl_law *law = &m->joint_laws[i];
        const tl_scope *scope = &law->scope;
        const bool on = scope->tag.joint == joint || (scope->names > 0 && scope->tag.joint == 0);
        if (on && (scope->names > 0 || scope->tag.plane != 0) && !(friction_of(law) == friction))
            return NAN;
    }
    return friction;
}

/* The JSON of the head of the scene's next frame, into `text`. */
static void scene_head(const tl_model *m, const tl_html *options, const tl_scene *scene, tl_piece *text)
{
    const size_t block_fields = options->block_field_count;
    text->length = 0;
    tl_json_print(text,
                  "{\"format\": 2, \"program\": \"Talus " TALUS_VERSION
                  "\", \"title\": %s, \"origin\": %v, \"gravity\": %v, \"size\": %g",
                  options->title ? options->title : "", m->origin, m->config.gravity, scene->next.median);
    if (options->safety_limit > 0)
        tl_json_print(text, ", \"safety_limit\": %g", options->safety_limit);
    tl_json_put(text, ", \"groups\": [");
    for (size_t i = 0; i < m->group_count; i++)
        tl_json_print(text, i ? ", %s" : "%s", m->groups[i]);
    tl_json_put(text, "], \"joints\": [\"\"");
    for (size_t i = 0; i < m->joint_count; i++)
        tl_json_print(text, ", %s", m->joints[i].name);
    tl_json_put(text, "], \"laws\": [\"\"");
    for (size_t i = 0; i < m->joint_law_count; i++) {
        char law[TL_LAW_TEXT];
        tl_json_print(text, ", %s", tl_law_text(m, &m->joint_laws[i], law));
    }
    tl_json_put(text, "], \"friction\": [null");
    for (size_t i = 0; i < m->joint_count; i++) {
        double friction = friction_of_joint(m, (uint32_t)i + 1);
        tl_json_print(text, isfinite(friction) ? ", %g" : ", null", friction);
    }
    tl_json_put(text, "], \"fields\": [");
    put_fields(text, options->block_fields, block_fields, false, "blocks");
    put_fields(text, options->contact_fields, options->contact_field_count, block_fields > 0, "contacts");
    tl_json_put(text, "], \"histories\": [");
    put_histories(text, m);
    tl_json_put(text, "]");
    tl_scene_zones_head(m, text);
    tl_scene_elements_head(m, text);
    tl_json_print(text, "%r%r}", scene->live ? ", \"live\": true" : "",
                  scene->live == TL_SCENE_COMMANDS ? ", \"commands\": true" : "");
}

/* ---------------------------------------------------------------- REFU --------------------
 *
 * REFU: the cuts that were refused so far, those that the model's record lists. */

/* Bytes of one: joint, plane, block, normal, point, thickness, limit. */
#define BYTES 44

static tl_status scene_refused(tl_model *m, tl_piece *out)
{
    const tl_cut_record *record = &m->record;
    size_t n = record->listed;
    unsigned char *to = tl_scene_chunk(out, "REFU", 8 + n * BYTES, &m->error);
    if (!to)
        return m->error.status;
    to = tl_put_u32(to, (uint32_t)(record->refused < UINT32_MAX ? record->refused : UINT32_MAX));
    to = tl_put_u32(to, (uint32_t)n);
    for (size_t i = 0; i < n; i++)
        to = tl_put_u32(to, record->list[i].joint.joint);
    for (size_t i = 0; i < n; i++)
        to = tl_put_u32(to, record->list[i].joint.plane);
    for (size_t i = 0; i < n; i++)
        to = tl_put_u32(to, record->list[i].block);
    for (size_t i = 0; i < n; i++)
        to = tl_put_vec3(to, record->list[i].normal);
    for (size_t i = 0; i < n; i++)
        to = tl_put_vec3(to, tl_v3_sub(record->list[i].point, m->origin));
    for (size_t i = 0; i < n; i++)
        to = tl_put_f32(to, record->list[i].thickness);
    for (size_t i = 0; i < n; i++)
        to = tl_put_f32(to, record->list[i].limit);
    return TL_OK;
}

/* ---------------------------------------------------------------- TOUC --------------------
 *
 * TOUC: the faces with which bodies lie on others. */

/* A body and a direction in which it cannot move: an outward normal. */
typedef struct bound {
    tl_id body;
    tl_vec3 normal;
} bound;

typedef struct bounds {
    bound *at;
    size_t count, capacity;
} bounds;

/* Adds a normal that the body, whose first is at `first`, does not have. false: out of memory. */
static bool add(bounds *list, size_t first, tl_id body, tl_vec3 normal)
{
    for (size_t i = first; i < list->count; i++)
        if (tl_v3_norm(tl_v3_sub(list->at[i].normal, normal)) <= TL_TOUCH_ALONG)
            return true;
    if (!tl_grow(&list->at, &list->capacity, list->count + 1, sizeof *list->at))
        return false;
    list->at[list->count++] = (bound){body, normal};
    return true;
}

/* Rollers bound a body on both sides; of one that is held throughout its faces alone are told. */
static bool add_rollers(const tl_model *m, uint32_t body, bounds *list, size_t first)
{
    tl_vec3 held[3];
    const size_t count = tl_held_axes(m, body, held);
    const tl_id id = m->bodies.id[body];
    bool enough = true;
    for (size_t k = 0; k < count && count < 3; k++)
        enough = enough && add(list, first, id, held[k]) && add(list, first, id, tl_v3_neg(held[k]));
    return enough;
}

static bool add_body(const tl_model *m, const tl_touches *touches, uint32_t body, bounds *list)
{
    const bool now = tl_touches_moved(m, touches, body);
    const size_t first = list->count;
    bool enough = true;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        uint32_t row = m->members[m->bodies.member_start[body] + k];
        for (size_t i = touches->start[row]; i < touches->start[row + 1] && enough; i++)
            enough = add(list, first, m->bodies.id[body], tl_touch_normal(m, &touches->at[i], now));
    }
    return enough && add_rollers(m, body, list, first);
}

static tl_status put(tl_model *m, const bounds *list, tl_piece *out)
{
    unsigned char *to = tl_scene_chunk(out, "TOUC", 4 + 16 * list->count, &m->error);
    if (!to)
        return m->error.status;
    to = tl_put_u32(to, (uint32_t)list->count);
    for (size_t i = 0; i < list->count; i++)
        to = tl_put_u32(to, list->at[i].body);
    for (size_t i = 0; i < list->count; i++)
        to = tl_put_vec3(to, list->at[i].normal);
    return TL_OK;
}

static tl_status scene_touches(tl_model *m, tl_piece *out)
{
    tl_touches touches;
    bounds list = {0};
    tl_status status = tl_touches_find(m, &touches);
    for (uint32_t body = 0; body < m->bodies.table.rows && status == TL_OK; body++)
        if (!add_body(m, &touches, body, &list))
            status = tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = put(m, &list, out);
    tl_touches_free(&touches);
    free(list.at);
    return status;
}

/* Blocks that a thread takes at a time. */
#define BLOCK_CHUNK 1024

/* ---------------------------------------------------------------- shapes ----------------- */

typedef struct shape_counts {
    size_t vertices, faces, corners;
} shape_counts;

typedef struct shape_columns {
    unsigned char *id, *body, *group, *vertices, *faces, *volume, *density, *centroid, *vertex, *joint, *plane,
        *corners, *loop;
} shape_columns;

static void put_shape(shape_columns *to, const tl_model *m, uint32_t row)
{
    const tl_blocks *b = &m->blocks;
    const tl_poly *shape = b->shape[row];
    tl_vec3 local = tl_block_local(m, row);
    to->id = tl_put_u32(to->id, b->id[row]);
    to->body = tl_put_u32(to->body, m->bodies.id[b->body[row]]);
    to->group = tl_put_u32(to->group, b->group[row]);
    to->vertices = tl_put_u32(to->vertices, shape->vertex_count);
    to->faces = tl_put_u32(to->faces, shape->face_count);
    to->volume = tl_put_f32(to->volume, b->volume[row]);
    to->density = tl_put_f32(to->density, b->density[row]);
    to->centroid = tl_put_vec3(to->centroid, tl_v3_sub(tl_block_centroid(m, row), m->origin));
    for (uint32_t v = 0; v < shape->vertex_count; v++)
        to->vertex = tl_put_vec3(to->vertex, tl_v3_sub(shape->vertex[v], local));
    for (uint32_t f = 0; f < shape->face_count; f++) {
        to->joint = tl_put_u32(to->joint, shape->tag[f].joint);
        to->plane = tl_put_u32(to->plane, shape->tag[f].plane);
        to->corners = tl_put_u16(to->corners, tl_poly_face_size(shape, f));
    }
    for (uint32_t i = 0; i < shape->start[shape->face_count]; i++)
        to->loop = tl_put_u16(to->loop, shape->loop[i]);
}

static tl_status put_shapes(tl_model *m, const uint32_t *rows, size_t count, tl_piece *out)
{
    shape_counts n = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        const tl_poly *shape = m->blocks.shape[rows[i]];
        n.vertices += shape->vertex_count;
        n.faces += shape->face_count;
        n.corners += shape->start[shape->face_count];
    }
    size_t bytes = 16 + count * 40 + n.vertices * 12 + n.faces * 8 + tl_scene_column_bytes(n.faces, 2) +
                   tl_scene_column_bytes(n.corners, 2);
    unsigned char *to = tl_scene_chunk(out, "SHAP", bytes, &m->error);
    if (!to)
        return m->error.status;
    to = tl_put_u32(to, (uint32_t)count);
    to = tl_put_u32(to, (uint32_t)n.vertices);
    to = tl_put_u32(to, (uint32_t)n.faces);
    to = tl_put_u32(to, (uint32_t)n.corners);
    shape_columns columns = {.id = tl_scene_column(&to, count, 4),
                             .body = tl_scene_column(&to, count, 4),
                             .group = tl_scene_column(&to, count, 4),
                             .vertices = tl_scene_column(&to, count, 4),
                             .faces = tl_scene_column(&to, count, 4),
                             .volume = tl_scene_column(&to, count, 4),
                             .density = tl_scene_column(&to, count, 4),
                             .centroid = tl_scene_column(&to, count, 12),
                             .vertex = tl_scene_column(&to, n.vertices, 12),
                             .joint = tl_scene_column(&to, n.faces, 4),
                             .plane = tl_scene_column(&to, n.faces, 4),
                             .corners = tl_scene_column(&to, n.faces, 2),
                             .loop = tl_scene_column(&to, n.corners, 2)};
    for (size_t i = 0; i < count; i++)
        put_shape(&columns, m, rows[i]);
    return TL_OK;
}

/* ---------------------------------------------------------------- places ----------------- */

typedef struct frame {
    const tl_model *model;
    unsigned char *id, *place, *turn, *velocity, *displacement, *rotation, *spin, *unbalanced, *flags;
    double *largest; /* square of the largest displacement, by chunk */
} frame;

enum { HELD = 1, HIDDEN = 2 };

static void put_block(const frame *f, size_t i)
{
    const tl_model *m = f->model;
    const tl_bodies *bodies = &m->bodies;
    uint32_t row = (uint32_t)i, body = m->blocks.body[row];
    tl_vec3 arm = tl_m3_mul(&bodies->pose[body].r, tl_block_local(m, row));
    tl_quat q = bodies->q[body];
    tl_put_u32(f->id + 4 * i, m->blocks.id[row]);
    tl_put_vec3(f->place + 12 * i, tl_v3_add(tl_body_place(bodies, body), arm));
    unsigned char *turn = f->turn + 16 * i;
    turn = tl_put_f32(turn, q.x);
    turn = tl_put_f32(turn, q.y);
    turn = tl_put_f32(turn, q.z);
    tl_put_f32(turn, q.w);
    tl_put_vec3(f->velocity + 12 * i, tl_block_velocity(m, row));
    tl_put_vec3(f->displacement + 12 * i, tl_block_displacement(m, row));
    tl_put_vec3(f->rotation + 12 * i, tl_q_vector(q));
    tl_put_vec3(f->spin + 12 * i, bodies->w[body]);
    tl_put_f32(f->unbalanced + 4 * i, tl_v3_norm(bodies->force[body]));
    tl_put_u8(f->flags + i, (tl_body_is_held(m, body) ? HELD : 0u) | (m->blocks.hidden[row] ? HIDDEN : 0u));
}

static void put_blocks_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)thread;
    const frame *f = user;
    double largest = 0;
    for (size_t i = begin; i < end; i++) {
        put_block(f, i);
        largest = fmax(largest, tl_v3_norm2(tl_block_displacement(f->model, (uint32_t)i)));
    }
    f->largest[chunk] = largest;
}

static tl_status put_frame(tl_model *m, tl_piece *out, double *largest)
{
    size_t n = m->blocks.table.rows, chunks = (n + BLOCK_CHUNK - 1) / BLOCK_CHUNK;
    frame f = {.model = m, .largest = malloc((chunks + 1) * sizeof *f.largest)};
    if (!f.largest)
        return tl_fail_memory(&m->error);
    unsigned char *to = tl_scene_chunk(out, "FRAM", 20 + 84 * n + tl_scene_column_bytes(n, 1), &m->error);
    if (!to) {
        free(f.largest);
        return m->error.status;
    }
    to = tl_put_f64(to, m->time);
    to = tl_put_f64(to, (double)m->cycles);
    to = tl_put_u32(to, (uint32_t)n);
    f.id = tl_scene_column(&to, n, 4);
    f.place = tl_scene_column(&to, n, 12);
    f.turn = tl_scene_column(&to, n, 16);
    f.velocity = tl_scene_column(&to, n, 12);
    f.displacement = tl_scene_column(&to, n, 12);
    f.rotation = tl_scene_column(&to, n, 12);
    f.spin = tl_scene_column(&to, n, 12);
    f.unbalanced = tl_scene_column(&to, n, 4);
    f.flags = tl_scene_column(&to, n, 1);
    tl_parallel_for(m->pool, n, BLOCK_CHUNK, put_blocks_range, &f);
    double square = 0;
    for (size_t i = 0; i < chunks; i++)
        square = fmax(square, f.largest[i]);
    *largest = sqrt(square);
    free(f.largest);
    return TL_OK;
}

static tl_status put_field(tl_error *error, uint32_t of, size_t number, const double *values, const uint32_t *picked,
                           size_t count, tl_piece *out)
{
    unsigned char *to = tl_scene_chunk(out, "FIEL", 12 + 4 * count, error);
    if (!to)
        return error->status;
    to = tl_put_u32(to, of);
    to = tl_put_u32(to, (uint32_t)number);
    to = tl_put_u32(to, (uint32_t)count);
    for (size_t i = 0; i < count; i++)
        to = tl_put_f32(to, values[picked ? picked[i] : i]);
    return TL_OK;
}

static tl_status put_keyblocks(tl_model *m, const tl_keyblocks *keys, tl_piece *out)
{
    size_t n = keys->count;
    unsigned char *to = tl_scene_chunk(out, "KEYS", 4 + 24 * n, &m->error);
    if (!to)
        return m->error.status;
    to = tl_put_u32(to, (uint32_t)n);
    for (size_t i = 0; i < n; i++)
        to = tl_put_u32(to, keys->blocks[i].block);
    /* in the stream 0 is stable, then the order of tl_keyblock_mode */
    for (size_t i = 0; i < n; i++)
        to = tl_put_u32(to, keys->blocks[i].mode == TL_KEYBLOCK_STABLE ? 0u : (uint32_t)keys->blocks[i].mode + 1u);
    for (size_t i = 0; i < n; i++) /* a stable one has none */
        to = tl_put_f32(to, isfinite(keys->blocks[i].safety) ? keys->blocks[i].safety : NAN);
    for (size_t i = 0; i < n; i++)
        to = tl_put_vec3(to, keys->blocks[i].direction);
    return TL_OK;
}

static tl_status put_run(tl_model *m, const tl_html *options, tl_piece *out)
{
    tl_energy energy;
    tl_status status = tl_model_energy(m, &energy);
    if (status != TL_OK)
        return status;
    tl_balance balance = tl_model_balance(m);
    const double numbers[] = {m->time,        (double)m->cycles, m->dt,          balance.ratio, balance.max_velocity,
                              energy.kinetic, energy.damping,    energy.friction};
    size_t count = sizeof numbers / sizeof numbers[0], values = 0;
    const tl_history *h;
    for (size_t i = 0; (h = tl_history_at(m, i)) != NULL; i++)
        values += h->width;
    unsigned char *to = tl_scene_chunk(out, "LINE", 8 * count + 4 + 8 * values, &m->error);
    if (!to)
        return m->error.status;
    for (size_t i = 0; i < count; i++)
        to = tl_put_f64(to, numbers[i]);
    to = tl_put_u32(to, (uint32_t)values);
    for (size_t i = 0; (h = tl_history_at(m, i)) != NULL; i++)
        for (size_t k = 0; k < h->width; k++) /* of the last sample */
            to = tl_put_f64(to, h->count ? h->values[(h->count - 1) * h->width + k] : (double)NAN);
    return options->keyblocks ? put_keyblocks(m, options->keyblocks, out) : TL_OK;
}

/* Contacts that a thread takes at a time. */
#define CONTACT_CHUNK 512
/* Where there are more contacts, a frame has those that slip. */
#define FEW 20000

/* The columns of CONT: quantities of contacts, and their bytes; of those without a name put_range knows more. */
enum { FORCE = 6, USED = 10, COLUMNS = 12 };

static const struct {
    const char *quantity;
    size_t bytes;
} columns[COLUMNS] = {{"block_a", 4}, {"block_b", 4}, {"joint", 4},         {"plane", 4},
                      {"point", 12},  {"normal", 12}, [FORCE] = {NULL, 12}, {"area", 4},
                      {"gap", 4},     {"slip", 4},    [USED] = {NULL, 4},   {"state", 1}};

typedef struct contacts {
    tl_model *model;
    uint32_t *rows;          /* of contacts with points, in the order of their blocks */
    tl_contact_facts *facts; /* of each */
    size_t listed, meetings; /* of all, those by segments are the last */
    uint32_t *picked;        /* of these, the contacts of the frame */
    size_t count;
    tl_law_states states;
    const tl_field *of[COLUMNS];
    unsigned char *at[COLUMNS];
} contacts;

/* ---------------------------------------------------------------- contacts --------------- */

static void find_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const contacts *c = user;
    for (size_t i = begin; i < end; i++)
        c->facts[i] = tl_contact_facts_of(c->model, c->rows[i]);
}

static void pick(contacts *c, int32_t choice)
{
    bool all = choice == TL_HTML_CONTACTS_ALL || (choice == TL_HTML_CONTACTS_FEW && c->listed <= FEW);
    for (size_t i = 0; i < c->listed; i++)
        if (all || c->facts[i].state == TL_CONTACT_SLIPPING)
            c->picked[c->count++] = (uint32_t)i;
}

static void put_quantity(const tl_contact_facts *facts, const tl_field *of, size_t bytes, unsigned char *to)
{
    double value[3];
    tl_contact_numbers(facts, of, value);
    if (of->kind == TL_FIELD_VEC3)
        tl_put_vec3(to, tl_v3(value[0], value[1], value[2]));
    else if (of->kind == TL_FIELD_SCALAR)
        tl_put_f32(to, value[0]);
    else if (bytes == 1)
        tl_put_u8(to, (uint32_t)value[0]);
    else
        tl_put_u32(to, (uint32_t)value[0]);
}

static void put_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const contacts *c = user;
    for (size_t i = begin; i < end; i++) {
        tl_contact_facts facts = c->facts[c->picked[i]];
        facts.slip = tl_law_states_slip(c->model, &c->states, c->rows[c->picked[i]], facts.shear_displacement);
        facts.point = tl_v3_sub(facts.point, c->model->origin);
        for (size_t k = 0; k < COLUMNS; k++)
            if (c->of[k])
                put_quantity(&facts, c->of[k], columns[k].bytes, c->at[k] + columns[k].bytes * i);
        tl_put_vec3(c->at[FORCE] + 12 * i, tl_v3_madd(facts.shear_force, facts.normal_force, facts.normal));
    }
}

/* The polygons, contact by contact. */
static void put_polygons(const tl_contact_polygons *p, unsigned char *to)
{
    for (size_t i = 0; i < p->contacts; i++)
        for (uint32_t k = p->first[i]; k < p->first[i + 1]; k++)
            to = tl_put_u32(to, (uint32_t)i);
    for (size_t k = 0; k < p->polygons; k++)
        to = tl_put_u32(to, p->start[k + 1] - p->start[k]);
    for (size_t k = 0; k < p->corners; k++)
        to = tl_put_vec3(to, p->corner[k]);
}

static tl_status put_columns(contacts *c, const tl_contact_polygons *p, tl_piece *out)
{
    size_t n = c->count;
    size_t bytes = 12 + 68 * n + tl_scene_column_bytes(n, 1) + 8 * p->polygons + 12 * p->corners;
    unsigned char *to = tl_scene_chunk(out, "CONT", bytes, &c->model->error);
    if (!to)
        return c->model->error.status;
    to = tl_put_u32(to, (uint32_t)n);
    to = tl_put_u32(to, (uint32_t)p->polygons);
    to = tl_put_u32(to, (uint32_t)p->corners);
    for (size_t k = 0; k < COLUMNS; k++) {
        c->of[k] = columns[k].quantity ? tl_contact_quantity(columns[k].quantity) : NULL;
        c->at[k] = tl_scene_column(&to, n, columns[k].bytes);
    }
    tl_parallel_for(c->model->pool, n, CONTACT_CHUNK, put_range, c);
    for (size_t i = 0; i < n; i++) /* the law is asked, on one thread */
        tl_put_f32(c->at[USED] + 4 * i, c->picked[i] < c->listed - c->meetings
                                            ? tl_contact_shear_used(c->model, c->rows[c->picked[i]])
                                            : (double)NAN);
    put_polygons(p, to);
    return TL_OK;
}

/* Which law each contact of CONT has: its place among "laws" of the head. */
static tl_status put_laws(const contacts *c, tl_piece *out)
{
    unsigned char *to = tl_scene_chunk(out, "LAWS", 4 + 4 * c->count, &c->model->error);
    if (!to)
        return c->model->error.status;
    to = tl_put_u32(to, (uint32_t)c->count);
    for (size_t i = 0; i < c->count; i++)
        to = tl_put_u32(to, c->facts[c->picked[i]].law);
    return TL_OK;
}

static tl_status put_contacts(contacts *c, tl_piece *out)
{
    tl_contact_polygons polygons = {0};
    uint32_t *rows = malloc((c->count + 1) * sizeof *rows);
    for (size_t i = 0; rows && i < c->count; i++)
        rows[i] = c->rows[c->picked[i]];
    tl_status status =
        rows ? tl_contact_polygons_find(c->model, rows, c->count, &polygons) : tl_fail_memory(&c->model->error);
    if (status == TL_OK)
        status = put_columns(c, &polygons, out);
    if (status == TL_OK)
        status = put_laws(c, out);
    tl_contact_polygons_free(&polygons);
    free(rows);
    return status;
}

static tl_status put_contact_fields(const contacts *c, const tl_html *options, tl_piece *out)
{
    tl_error *error = &c->model->error;
    size_t first = options->block_field_count, count = options->contact_field_count;
    tl_status status =
        tl_extra_fields_check("contact_fields", options->contact_fields, count, c->listed, "contacts", error);
    for (size_t i = 0; status == TL_OK && i < count; i++)
        status = put_field(error, 1, first + i, options->contact_fields[i].values, c->picked, c->count, out);
    return status;
}

static tl_status put_contact_chunks(tl_model *m, const tl_html *options, double median, tl_piece *out,
                                    tl_verdict *verdict)
{
    const bool wanted = options->contacts != TL_HTML_CONTACTS_NONE;
    contacts c = {.model = m};
    tl_status status = tl_contacts_listed(m, &c.rows, &c.listed, &c.meetings);
    if (status == TL_OK)
        status = tl_law_states_list(m, &c.states);
    if (status == TL_OK) {
        c.facts = malloc((c.listed + 1) * sizeof *c.facts);
        c.picked = malloc((c.listed + 1) * sizeof *c.picked);
        if (!c.facts || !c.picked)
            status = tl_fail_memory(&m->error);
    }
    if (status == TL_OK) {
        tl_parallel_for(m->pool, c.listed, CONTACT_CHUNK, find_range, &c);
        status = tl_verdict_of(m, median, c.rows, c.facts, c.listed, verdict);
    }
    if (status == TL_OK && wanted) {
        pick(&c, options->contacts);
        status = put_contacts(&c, out);
    }
    if (status == TL_OK && wanted)
        status = put_contact_fields(&c, options, out);
    tl_law_states_free(&c.states);
    free(c.picked);
    free(c.facts);
    free(c.rows);
    return status;
}

/* ---------------------------------------------------------------- chunks ----------------- */

tl_status tl_scene_bytes(tl_model *m, const char letters[5], const void *data, size_t bytes, tl_piece *out)
{
    size_t before = out->length;
    unsigned char *to = tl_scene_chunk(out, letters, tl_scene_column_bytes(bytes, 1), &m->error);
    if (!to)
        return m->error.status;
    tl_put_u32(out->data + before + 4, (uint32_t)bytes); /* what follows is no more of it */
    memcpy(to, data, bytes);
    return TL_OK;
}

static bool same_piece(const tl_piece *a, const tl_piece *b)
{
    return a->length == b->length && (a->length == 0 || memcmp(a->data, b->data, a->length) == 0);
}

/* HEAD where it is not the one that was sent. */
static tl_status put_head(tl_scene *scene, tl_model *m, const tl_html *options, tl_piece *out)
{
    const tl_piece *sent = &scene->sent.head;
    tl_piece *head = &scene->next.head;
    scene_head(m, options, scene, head);
    if (head->failed) {
        head->failed = false; /* another frame may have the memory */
        return tl_fail_memory(&m->error);
    }
    if (same_piece(sent, head))
        return TL_OK;
    return tl_scene_bytes(m, "HEAD", head->data, head->length, out);
}

static tl_status put_gone(tl_model *m, const news *found, tl_piece *out)
{
    size_t n = found->gone_count;
    unsigned char *to = tl_scene_chunk(out, "GONE", 4 + 4 * n, &m->error);
    if (!to)
        return m->error.status;
    to = tl_put_u32(to, (uint32_t)n);
    for (size_t i = 0; i < n; i++)
        to = tl_put_u32(to, found->gone[i]);
    return TL_OK;
}

/* TOUC where it is not the one that was sent. */
static tl_status put_touches(tl_scene *scene, tl_model *m, tl_piece *out)
{
    tl_piece *next = &scene->next.touches;
    next->length = 0;
    next->failed = false; /* another frame may have the memory */
    tl_status status = scene_touches(m, next);
    if (status != TL_OK || same_piece(next, &scene->sent.touches))
        return status;
    unsigned char *to = tl_piece_add(out, next->length);
    if (!to)
        return tl_fail_memory(&m->error);
    memcpy(to, next->data, next->length);
    return TL_OK;
}

static tl_status put_news(tl_scene *scene, tl_model *m, const tl_html *options, tl_piece *out)
{
    news found = {0};
    tl_status status = compare(scene, m, &found) ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = put_head(scene, m, options, out);
    if (status == TL_OK && found.row_count)
        status = put_shapes(m, found.rows, found.row_count, out);
    if (status == TL_OK && found.gone_count)
        status = put_gone(m, &found, out);
    if (status == TL_OK && scene->sent.refused != m->record.refused)
        status = scene_refused(m, out);
    scene->next.refused = m->record.refused;
    if (status == TL_OK)
        status = put_touches(scene, m, out);
    if (status == TL_OK)
        status = tl_scene_surface(m, scene->sent.surface, &scene->next.surface, out);
    free(found.rows);
    free(found.gone);
    return status;
}

static tl_status put_block_fields(tl_model *m, const tl_html *options, tl_piece *out)
{
    size_t rows = m->blocks.table.rows;
    tl_status status = tl_extra_fields_check("block_fields", options->block_fields, options->block_field_count, rows,
                                             "blocks", &m->error);
    for (size_t i = 0; status == TL_OK && i < options->block_field_count; i++)
        status = put_field(&m->error, 0, i, options->block_fields[i].values, NULL, rows, out);
    return status;
}

/* FIND: how the model stands, as JSON. A page is kept: it tells which model it is of. */
static tl_status put_finding(const tl_scene *scene, tl_model *m, const tl_verdict *v, tl_piece *out)
{
    char hash[33], sentence[512];
    tl_piece text = {0};
    tl_status status = scene->live ? TL_OK : tl_state_hash(m, hash);
    if (status != TL_OK)
        return status;
    tl_verdict_text(v, sentence, sizeof sentence);
    tl_json_print(&text,
                  "{\"standing\": %s, \"text\": %s, \"stage\": %s, \"closed\": %g, \"moved\": %g, \"contacts\": %g, "
                  "\"slipping\": %g",
                  tl_standing_name(v->standing), sentence, v->stage, v->closed, (double)v->moved, (double)v->contacts,
                  (double)v->slipping);
    if (!scene->live)
        tl_json_print(&text, ", \"hash\": %s", hash);
    tl_json_put(&text, "}");
    status = text.failed ? tl_fail_memory(&m->error) : tl_scene_bytes(m, "FIND", text.data, text.length, out);
    free(text.data);
    return status;
}

/* ---------------------------------------------------------------- the frame -------------- */

tl_status tl_scene_write(tl_scene *scene, tl_model *m, const tl_html *options, tl_piece *out, tl_scene_facts *facts)
{
    tl_rows_tidy(m);
    tl_scene_known *next = &scene->next;
    size_t begin = out->length;
    next->frames = scene->sent.frames + 1;
    next->median = scene->sent.median;
    if ((scene->sent.frames == 0 || scene->sent.structure != m->structure) && !tl_median_size(m, &next->median))
        return tl_fail_memory(&m->error);
    next->structure = m->structure;
    *facts = (tl_scene_facts){.time = m->time, .cycle = m->cycles};
    tl_status status = put_news(scene, m, options, out);
    facts->news = out->length - begin;
    if (status == TL_OK)
        status = put_frame(m, out, &facts->largest);
    if (status == TL_OK)
        status = tl_scene_zones(m, out, &facts->largest);
    if (status == TL_OK)
        status = tl_scene_elements(m, out);
    if (status == TL_OK)
        status = put_block_fields(m, options, out);
    tl_verdict verdict;
    if (status == TL_OK)
        status = put_contact_chunks(m, options, next->median, out, &verdict);
    if (status == TL_OK)
        status = put_run(m, options, out);
    if (status == TL_OK)
        status = put_finding(scene, m, &verdict, out);
    unsigned char *to = status == TL_OK ? tl_scene_chunk(out, "DONE", 4, &m->error) : NULL;
    if (!to)
        return m->error.status;
    tl_put_u32(to, scene->sent.frames);
    return TL_OK;
}

void tl_scene_accept(tl_scene *scene)
{
    tl_scene_known sent = scene->sent;
    scene->sent = scene->next;
    scene->next = sent;
}

void tl_scene_forget(tl_scene *scene)
{
    scene->sent.count = scene->sent.head.length = scene->sent.touches.length = 0;
    scene->sent.frames = 0;
    scene->sent.refused = 0;
    scene->sent.surface = (tl_hash){0, 0};
}

static void free_known(tl_scene_known *known)
{
    free(known->blocks);
    free(known->head.data);
    free(known->touches.data);
}

void tl_scene_free(tl_scene *scene)
{
    free_known(&scene->sent);
    free_known(&scene->next);
    *scene = (tl_scene){0};
}
