/* scene_chunks.c - SHAP, FRAM, CONT, FIEL, LINE and KEYS: shapes once, the rest in every frame.
 *
 * A block's frame is that of its body, moved to the block's own centroid. So the quaternion of its body turns it, and
 * rows need nothing of an earlier frame. */
#include "io/scene_chunks.h"

#include "base/parallel.h"
#include "contact/detection.h"
#include "force/bear.h"
#include "io/extra_fields.h"
#include "io/pieces.h"
#include "io/scene_put.h"
#include "io/verdict.h"
#include "model/regroup.h"
#include "query/contact_fields.h"
#include "query/contact_polygons.h"
#include "query/point_fields.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/history.h>
#include <talus/vmath.h>

/* Blocks that a thread takes at a time. */
#define BLOCK_CHUNK 1024

/* ---------------------------------------------------------------- shapes ----------------- */

typedef struct shape_counts {
    size_t vertices, faces, corners;
} shape_counts;

typedef struct shape_columns {
    unsigned char *id, *body, *group, *vertices, *faces, *volume, *density, *centroid, *vertex,
        *joint, *plane, *corners, *loop;
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

tl_status tl_scene_shapes(tl_model *m, const uint32_t *rows, size_t count, tl_piece *out)
{
    shape_counts n = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        const tl_poly *shape = m->blocks.shape[rows[i]];
        n.vertices += shape->vertex_count;
        n.faces += shape->face_count;
        n.corners += shape->start[shape->face_count];
    }
    size_t bytes = 16 + count * 40 + n.vertices * 12 + n.faces * 8 +
                   tl_scene_column_bytes(n.faces, 2) + tl_scene_column_bytes(n.corners, 2);
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
    unsigned char *id, *place, *turn, *velocity, *displacement, *rotation, *spin, *unbalanced,
        *flags;
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
    tl_put_u8(f->flags + i, (bodies->fixed[body] == TL_FIX_ALL ? HELD : 0u) |
                                (m->blocks.hidden[row] ? HIDDEN : 0u));
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

tl_status tl_scene_blocks(tl_model *m, tl_piece *out, double *largest)
{
    size_t n = m->blocks.table.rows, chunks = (n + BLOCK_CHUNK - 1) / BLOCK_CHUNK;
    frame f = {.model = m, .largest = malloc((chunks + 1) * sizeof *f.largest)};
    if (!f.largest)
        return tl_fail_memory(&m->error);
    unsigned char *to =
        tl_scene_chunk(out, "FRAM", 20 + 84 * n + tl_scene_column_bytes(n, 1), &m->error);
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

tl_status tl_scene_field(tl_error *error, uint32_t of, size_t number, const double *values,
                         const uint32_t *picked, size_t count, tl_piece *out)
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
        to = tl_put_u32(to, keys->blocks[i].mode == TL_KEYBLOCK_STABLE
                                ? 0u
                                : (uint32_t)keys->blocks[i].mode + 1u);
    for (size_t i = 0; i < n; i++) /* a stable one has none */
        to = tl_put_f32(to, isfinite(keys->blocks[i].safety) ? keys->blocks[i].safety : NAN);
    for (size_t i = 0; i < n; i++)
        to = tl_put_vec3(to, keys->blocks[i].direction);
    return TL_OK;
}

static void count_history(void *user, const char *name, const char *unit, double value)
{
    (void)name, (void)unit, (void)value;
    ++*(size_t *)user;
}

static void put_history(void *user, const char *name, const char *unit, double value)
{
    (void)name, (void)unit;
    unsigned char **to = user;
    *to = tl_put_f64(*to, value);
}

tl_status tl_scene_run(tl_model *m, const tl_html *options, tl_piece *out)
{
    tl_energy energy;
    tl_status status = tl_model_energy(m, &energy);
    if (status != TL_OK)
        return status;
    tl_balance balance = tl_model_balance(m);
    const double numbers[] = {m->time,        (double)m->cycles,    m->dt,
                              balance.ratio,  balance.max_velocity, energy.kinetic,
                              energy.damping, energy.friction};
    size_t count = sizeof numbers / sizeof numbers[0], k = 0;
    tl_scene_histories(m, count_history, &k);
    unsigned char *to = tl_scene_chunk(out, "LINE", 8 * count + 4 + 8 * k, &m->error);
    if (!to)
        return m->error.status;
    for (size_t i = 0; i < count; i++)
        to = tl_put_f64(to, numbers[i]);
    to = tl_put_u32(to, (uint32_t)k);
    tl_scene_histories(m, put_history, &to);
    return options->keyblocks ? put_keyblocks(m, options->keyblocks, out) : TL_OK;
}

/* ---------------------------------------------------------------- numbers of histories ----
 *
 * The last samples of the histories of a model. */

/* Units of what a model is asked for by name; the rest has none. */
static const struct {
    const char *name, *unit;
} quantities[] = {
    {"kinetic", "J"}, {"potential", "J"}, {"stored", "J"},         {"friction", "J"},
    {"damping", "J"}, {"external", "J"},  {"max_velocity", "m/s"},
};

static const char *unit_of(const tl_history *h)
{
    size_t count = 0;
    const tl_field *fields = h->source == TL_FROM_BLOCKS     ? tl_block_fields(&count)
                             : h->source == TL_FROM_CONTACTS ? tl_contact_fields(&count)
                                                             : NULL;
    for (size_t i = 0; i < count; i++)
        if (strcmp(fields[i].name, h->asked) == 0)
            return fields[i].unit;
    for (size_t i = 0; h->source == TL_FROM_MODEL && i < sizeof quantities / sizeof *quantities;
         i++)
        if (strcmp(quantities[i].name, h->asked) == 0)
            return quantities[i].unit;
    return "";
}

void tl_scene_histories(const tl_model *m, tl_scene_history_fn fn, void *user)
{
    const tl_history *h;
    for (size_t i = 0; (h = tl_history_at(m, i)) != NULL; i++)
        for (size_t k = 0; k < h->width; k++) {
            char name[TL_HISTORY_NAME + 16];
            snprintf(name, sizeof name, h->width > 1 ? "%s %zu" : "%s", h->name, k + 1);
            fn(user, name, unit_of(h),
               h->count ? h->values[(h->count - 1) * h->width + k] : (double)NAN);
        }
}

/* Contacts that a thread takes at a time. */
#define CONTACT_CHUNK 512
/* Where there are more contacts, a frame has those that slip. */
#define FEW 20000

/* The columns of CONT: quantities of contacts, and their bytes; of those without a name put_range knows more. */
enum { FORCE = 7, USED = 11, COLUMNS = 13 };

static const struct {
    const char *quantity;
    size_t bytes;
} columns[COLUMNS] = {{"id", 4},    {"block_a", 4}, {"block_b", 4}, {"joint", 4},
                      {"plane", 4}, {"point", 12},  {"normal", 12}, [FORCE] = {NULL, 12},
                      {"area", 4},  {"gap", 4},     {"slip", 4},    [USED] = {NULL, 4},
                      {"state", 1}};

typedef struct contacts {
    tl_model *model;
    uint32_t *rows;          /* of contacts with points, in order of id */
    tl_contact_facts *facts; /* of each */
    size_t listed;
    uint32_t *picked; /* of these, the contacts of the frame */
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
    bool all =
        choice == TL_HTML_CONTACTS_ALL || (choice == TL_HTML_CONTACTS_FEW && c->listed <= FEW);
    for (size_t i = 0; i < c->listed; i++)
        if (all || c->facts[i].state == TL_CONTACT_SLIPPING)
            c->picked[c->count++] = (uint32_t)i;
}

static void put_quantity(const tl_contact_facts *facts, const tl_field *of, size_t bytes,
                         unsigned char *to)
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
        facts.slip = tl_law_states_slip(c->model, &c->states, c->rows[c->picked[i]],
                                        facts.shear_displacement);
        facts.point = tl_v3_sub(facts.point, c->model->origin);
        for (size_t k = 0; k < COLUMNS; k++)
            if (c->of[k])
                put_quantity(&facts, c->of[k], columns[k].bytes, c->at[k] + columns[k].bytes * i);
        tl_put_vec3(c->at[FORCE] + 12 * i,
                    tl_v3_madd(facts.shear_force, facts.normal_force, facts.normal));
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
    size_t bytes = 12 + 72 * n + tl_scene_column_bytes(n, 1) + 8 * p->polygons + 12 * p->corners;
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
        tl_put_f32(c->at[USED] + 4 * i, tl_contact_shear_used(c->model, c->rows[c->picked[i]]));
    put_polygons(p, to);
    return TL_OK;
}

static tl_status put_contacts(contacts *c, tl_piece *out)
{
    tl_contact_polygons polygons = {0};
    uint32_t *rows = malloc((c->count + 1) * sizeof *rows);
    for (size_t i = 0; rows && i < c->count; i++)
        rows[i] = c->rows[c->picked[i]];
    tl_status status = rows ? tl_contact_polygons_find(c->model, rows, c->count, &polygons)
                            : tl_fail_memory(&c->model->error);
    if (status == TL_OK)
        status = put_columns(c, &polygons, out);
    tl_contact_polygons_free(&polygons);
    free(rows);
    return status;
}

static tl_status put_fields(const contacts *c, const tl_html *options, tl_piece *out)
{
    tl_error *error = &c->model->error;
    size_t first = options->block_field_count, count = options->contact_field_count;
    tl_status status = tl_extra_fields_check("contact_fields", options->contact_fields, count,
                                             c->listed, "contacts", error);
    for (size_t i = 0; status == TL_OK && i < count; i++)
        status = tl_scene_field(error, 1, first + i, options->contact_fields[i].values, c->picked,
                                c->count, out);
    return status;
}

tl_status tl_scene_contacts(tl_model *m, const tl_html *options, double median, tl_piece *out,
                            tl_verdict *verdict)
{
    const bool wanted = options->contacts != TL_HTML_CONTACTS_NONE;
    contacts c = {.model = m};
    tl_status status = tl_contacts_listed(m, &c.rows, &c.listed);
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
        status = put_fields(&c, options, out);
    tl_law_states_free(&c.states);
    free(c.picked);
    free(c.facts);
    free(c.rows);
    return status;
}
