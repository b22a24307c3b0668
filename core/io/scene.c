/* scene.c - a frame: what a reader does not know yet of head and blocks, and what is new in every frame.
 *
 * The blocks that were sent are kept in order of id, as rows are, so one walk through both tells what has come, changed
 * and gone. */
#include "io/scene.h"

#include "io/extra_fields.h"
#include "io/scene_parts.h"
#include "io/scene_put.h"
#include "io/verdict.h"

#include <stdlib.h>

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
    tl_scene_head(m, options, scene, head);
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
    tl_status status = tl_scene_touches(m, next);
    if (status != TL_OK || same_piece(next, &scene->sent.touches))
        return status;
    unsigned char *to = tl_piece_reserve(out, next->length);
    if (!to)
        return tl_fail_memory(&m->error);
    memcpy(to, next->data, next->length);
    out->length += next->length;
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
        status = tl_scene_refused(m, out);
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
    tl_scene_finding(verdict, scene->live ? NULL : hash, &text);
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
