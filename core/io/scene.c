/* scene.c - a frame: what a reader does not know yet of head and blocks, and what is new in every frame.
 *
 * The blocks that were sent are kept in order of id, as rows are. So one walk through both tells what has come,
 * changed and gone. */
#include "io/scene.h"

#include "base/params.h"
#include "io/extra_fields.h"
#include "io/json.h"
#include "io/pieces.h"
#include "io/scene_chunks.h"
#include "io/scene_put.h"
#include "io/verdict.h"
#include "model/joints.h"
#include "model/rows.h"
#include "query/touching.h"

#include <stdlib.h>
#include <string.h>

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
    return a->id == b->id && a->body == b->body && a->group == b->group &&
           a->changed == b->changed && a->density == b->density;
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

/* ---------------------------------------------------------------- HEAD --------------------
 *
 * HEAD: what does not change with the blocks, as JSON. */

static void put_fields(tl_piece *to, const tl_extra_field *fields, size_t count, bool more,
                       const char *of)
{
    for (size_t i = 0; i < count; i++)
        tl_json_print(to, "%r{\"name\": %s, \"unit\": %s, \"of\": %s}", more || i ? ", " : "",
                      fields[i].name, fields[i].unit ? fields[i].unit : "", of);
}

/* A list that is begun, of named things with units. */
typedef struct named_list {
    tl_piece *to;
    bool begun;
} named_list;

static void put_history(void *user, const char *name, const char *unit, double value)
{
    (void)value;
    named_list *l = user;
    tl_json_print(l->to, "%r{\"name\": %s, \"unit\": %s}", l->begun ? ", " : "", name, unit);
    l->begun = true;
}

/* The friction angle of a law, degrees; NaN where it has none. */
static double friction_of(const tl_law *law)
{
    for (uint32_t i = 0; law && i < law->kind->param_count; i++) {
        tl_param p = tl_param_row(law->kind->params, i, law->kind->param_stride);
        double value;
        if (p.type != TL_PARAM_REAL || strcmp(p.name, "friction") != 0 ||
            strcmp(p.unit, "deg") != 0)
            continue;
        memcpy(&value, (const char *)law->params + p.offset, sizeof value);
        return value;
    }
    return NAN;
}

/* That of all planes of a joint; NaN where they differ. */
static double friction_of_joint(const tl_model *m, uint32_t joint)
{
    double friction = friction_of(tl_law_of(m, (tl_tag){joint, 0}));
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const tl_law *law = &m->joint_laws[i];
        if (law->tag.joint == joint && law->tag.plane != 0 && !(friction_of(law) == friction))
            return NAN;
    }
    return friction;
}

/* The JSON of the head of the scene's next frame, into `text`. */
static void scene_head(const tl_model *m, const tl_html *options, const tl_scene *scene,
                       tl_piece *text)
{
    const size_t block_fields = options->block_field_count;
    text->length = 0;
    tl_json_print(text,
                  "{\"format\": 1, \"program\": \"Talus " TALUS_VERSION
                  "\", \"title\": %s, \"origin\": %v, \"gravity\": %v, \"size\": %g",
                  options->title ? options->title : "", m->origin, m->config.gravity,
                  scene->next.median);
    if (options->safety_limit > 0)
        tl_json_print(text, ", \"safety_limit\": %g", options->safety_limit);
    tl_json_put(text, ", \"groups\": [");
    for (size_t i = 0; i < m->group_count; i++)
        tl_json_print(text, i ? ", %s" : "%s", m->groups[i]);
    tl_json_put(text, "], \"joints\": [\"\"");
    for (size_t i = 0; i < m->joint_count; i++)
        tl_json_print(text, ", %s", m->joints[i].name);
    tl_json_put(text, "], \"friction\": [null");
    for (size_t i = 0; i < m->joint_count; i++) {
        double friction = friction_of_joint(m, (uint32_t)i + 1);
        tl_json_print(text, isfinite(friction) ? ", %g" : ", null", friction);
    }
    tl_json_put(text, "], \"fields\": [");
    put_fields(text, options->block_fields, block_fields, false, "blocks");
    put_fields(text, options->contact_fields, options->contact_field_count, block_fields > 0,
               "contacts");
    tl_json_put(text, "], \"histories\": [");
    tl_scene_histories(m, put_history, &(named_list){text, false});
    tl_json_print(text, "]%r%r}", scene->live ? ", \"live\": true" : "",
                  scene->live == TL_SCENE_COMMANDS ? ", \"commands\": true" : "");
}

/* ---------------------------------------------------------------- FIND --------------------
 *
 * FIND: how the model stands, as JSON. */

/* The JSON of FIND, the verdict, with the state hash unless that is NULL, into `text`. */
static void scene_finding(const tl_verdict *v, const char *hash, tl_piece *text)
{
    char sentence[512];
    tl_verdict_text(v, sentence, sizeof sentence);
    tl_json_print(text,
                  "{\"standing\": %s, \"text\": %s, \"stage\": %s, \"closed\": %g, \"moved\": %g, "
                  "\"contacts\": %g, \"slipping\": %g",
                  tl_standing_name(v->standing), sentence, v->stage, v->closed, (double)v->moved,
                  (double)v->contacts, (double)v->slipping);
    if (hash)
        tl_json_print(text, ", \"hash\": %s", hash);
    tl_json_put(text, "}");
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
        enough =
            enough && add(list, first, id, held[k]) && add(list, first, id, tl_v3_neg(held[k]));
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

/* ---------------------------------------------------------------- chunks ----------------- */

tl_status tl_scene_bytes(tl_model *m, const char letters[5], const void *data, size_t bytes,
                         tl_piece *out)
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
        status = tl_scene_shapes(m, found.rows, found.row_count, out);
    if (status == TL_OK && found.gone_count)
        status = put_gone(m, &found, out);
    if (status == TL_OK && scene->sent.refused != m->record.refused)
        status = scene_refused(m, out);
    scene->next.refused = m->record.refused;
    if (status == TL_OK)
        status = put_touches(scene, m, out);
    free(found.rows);
    free(found.gone);
    return status;
}

static tl_status put_block_fields(tl_model *m, const tl_html *options, tl_piece *out)
{
    size_t rows = m->blocks.table.rows;
    tl_status status = tl_extra_fields_check("block_fields", options->block_fields,
                                             options->block_field_count, rows, "blocks", &m->error);
    for (size_t i = 0; status == TL_OK && i < options->block_field_count; i++)
        status = tl_scene_field(&m->error, 0, i, options->block_fields[i].values, NULL, rows, out);
    return status;
}

/* A page is kept: it tells which model it is of. */
static tl_status put_finding(const tl_scene *scene, tl_model *m, const tl_verdict *verdict,
                             tl_piece *out)
{
    char hash[33];
    tl_piece text = {0};
    tl_status status = scene->live ? TL_OK : tl_state_hash(m, hash);
    if (status != TL_OK)
        return status;
    scene_finding(verdict, scene->live ? NULL : hash, &text);
    status = text.failed ? tl_fail_memory(&m->error)
                         : tl_scene_bytes(m, "FIND", text.data, text.length, out);
    free(text.data);
    return status;
}

/* ---------------------------------------------------------------- the frame -------------- */

tl_status tl_scene_write(tl_scene *scene, tl_model *m, const tl_html *options, tl_piece *out,
                         tl_scene_facts *facts)
{
    tl_rows_tidy(m);
    tl_scene_known *next = &scene->next;
    size_t begin = out->length;
    next->frames = scene->sent.frames + 1;
    next->median = scene->sent.median;
    if ((scene->sent.frames == 0 || scene->sent.structure != m->structure) &&
        !tl_median_size(m, &next->median))
        return tl_fail_memory(&m->error);
    next->structure = m->structure;
    *facts = (tl_scene_facts){.time = m->time, .cycle = m->cycles};
    tl_status status = put_news(scene, m, options, out);
    facts->news = out->length - begin;
    if (status == TL_OK)
        status = tl_scene_blocks(m, out, &facts->largest);
    if (status == TL_OK)
        status = put_block_fields(m, options, out);
    tl_verdict verdict;
    if (status == TL_OK)
        status = tl_scene_contacts(m, options, next->median, out, &verdict);
    if (status == TL_OK)
        status = tl_scene_run(m, options, out);
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
