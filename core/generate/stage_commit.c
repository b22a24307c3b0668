/* stage_commit.c - a staging set becomes the model's blocks: rows are written, blocks that were cut or
 * deleted go, and blocks that hang together become bodies. All memory is reserved before the model is
 * touched, but for that of the bodies of several blocks. Where there are such, the rows as they were are set aside. */
#include "generate/stage_commit.h"

#include "generate/stage.h"
#include "generate/stage_bodies.h"
#include "generate/stage_cuts.h"
#include "generate/stage_loads.h"
#include "generate/stage_seats.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "model/inertia.h"
#include "model/loads.h"
#include "model/model.h"
#include "model/regroup.h"
#include "model/rows.h"
#include "model/scope.h"
#include "model/slivers.h"

#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- rows ------------------- */

/* Moves a shape so that its centroid is the zero of its frame. Offsets follow from a vertex of the face, which keeps
 * the digits of a shape far from zero. Its size is that of the vertices as they then are, which is found again of them
 * when they have been saved. */
static void centre_shape(tl_poly *shape, tl_vec3 centroid)
{
    for (uint32_t i = 0; i < shape->vertex_count; i++)
        shape->vertex[i] = tl_v3_sub(shape->vertex[i], centroid);
    for (uint32_t f = 0; f < shape->face_count; f++)
        shape->plane[f].offset = tl_v3_dot(shape->plane[f].normal, shape->vertex[shape->loop[shape->start[f]]]);
    tl_poly_find_size(shape);
}

/* What the children of a block take over from it and from its body. */
typedef struct source {
    tl_id id;
    tl_pose pose;
    tl_base base, made;
    tl_vec3 v, w;
    tl_quat q;
    uint32_t group, drive;
    uint8_t fixed;
} source;

static source source_of(const tl_model *m, uint32_t row)
{
    const tl_bodies *b = &m->bodies;
    uint32_t body = m->blocks.body[row];
    return (source){.id = m->blocks.id[row],
                    .base = tl_block_base(m, row),
                    .made = tl_block_made(m, row),
                    .pose = b->pose[body],
                    .v = b->v[body],
                    .w = b->w[body],
                    .q = b->q[body],
                    .group = m->blocks.group[row],
                    .drive = b->drive[body],
                    .fixed = b->fixed[body]};
}

/* Where a block was, as far as the model has such a column: where its source was, about its own centroid `c`; NULL:
 * here. */
static void put_base(tl_base *column, uint32_t row, const tl_base *from, tl_vec3 c)
{
    if (!column)
        return;
    column[row] = from ? *from : (tl_base){{0, 0, 0}, tl_q_identity()};
    const tl_mat3 turn = tl_q_matrix(column[row].turn);
    column[row].shift = tl_v3_add(column[row].shift, tl_v3_sub(tl_m3_mul(&turn, c), c));
}

/* Fills the rows of a new block and of its body. A child moves on as its part of the source did. */
static void put(tl_model *m, const tl_stage_block *block, const source *from, uint32_t group, uint32_t row,
                uint32_t body)
{
    tl_blocks *blocks = &m->blocks;
    tl_bodies *bodies = &m->bodies;
    tl_pose *pose = &bodies->pose[body];
    tl_mass mass = tl_poly_mass(block->shape);
    tl_vec3 c = mass.centroid;
    centre_shape(block->shape, c);
    blocks->id[row] = bodies->id[body] = m->next_id++;
    blocks->body[row] = body;
    blocks->shape[row] = block->shape;
    blocks->group[row] = group;
    blocks->density[row] = block->density;
    blocks->lineage[row] = block->lineage;
    blocks->hidden[row] = block->hidden || block->hide_on_commit;
    blocks->stays[row] = true;
    tl_block_changes(m, row);
    tl_block_came(m, row, mass);
    if (!from) {
        pose->x_ref = c;
        pose->r = tl_m3_identity();
        bodies->q[body] = tl_q_identity();
        bodies->fixed[body] = block->fixed;
        put_base(blocks->base, row, NULL, c);
        put_base(blocks->made, row, NULL, c);
        return;
    }
    tl_vec3 arm = tl_m3_mul(&from->pose.r, c);
    put_base(blocks->base, row, &from->base, c);
    put_base(blocks->made, row, &from->made, c);
    *pose = from->pose;
    pose->x_ref = tl_v3_add(pose->x_ref, c);
    pose->u = tl_v3_add(pose->u, tl_v3_sub(arm, c));
    pose->v_moved = tl_v3_add(pose->v_moved, tl_v3_cross(pose->w_moved, arm));
    bodies->q[body] = from->q;
    bodies->v[body] = tl_v3_add(from->v, tl_v3_cross(from->w, arm));
    bodies->w[body] = from->w;
    bodies->fixed[body] = from->fixed;
    bodies->drive[body] = from->drive;
    if (from->drive)
        m->drives[from->drive - 1].bodies++;
}

/* Sums up the call, which has made the last rows. */
static void summarize(tl_stage *stage, size_t made)
{
    const tl_model *m = stage->model;
    const tl_extremes all = tl_extremes_of(stage->model);
    tl_generate_summary *s = &stage->summary;
    s->after = tl_block_count(stage->model);
    s->smallest_volume = s->after ? all.volume : 0;
    s->smallest_edge = s->after ? all.edge : 0;
    s->smallest_face = s->after ? all.face : 0;
    if (all.total > 0)
        s->volume_error = fabs(stage->changed_volume - stage->created_volume) / all.total;
    const size_t rows = m->blocks.table.rows;
    for (size_t row = rows - made; row < rows; row++)
        s->slivers += tl_is_sliver(m->blocks.shape[row], m->blocks.volume[row], all.total / (double)s->after);
}

/* Adds what the stage did to the model's record, whose list has room. `ids` are those of the staged blocks. */
static void keep_record(const tl_stage *stage, const tl_id *ids)
{
    tl_cut_record *record = &stage->model->record;
    record->cuts += stage->summary.cuts;
    record->refused += stage->summary.refused;
    record->coincident += stage->summary.coincident;
    record->created += stage->created_volume;
    for (size_t i = 0; i < stage->refused_listed; i++) {
        record->list[record->listed] = stage->refused[i];
        record->list[record->listed++].block = ids[stage->refused[i].block];
    }
}

/* What a commit needs before it changes anything. */
typedef struct commit_scratch {
    unsigned char *keep; /* [rows before] */
    uint32_t *slot;      /* [rows before] of blocks that were cut: place in sources */
    source *sources;     /* of the blocks that were cut */
    size_t source_count;
    tl_id *ids;       /* [staged blocks] their ids in the model */
    tl_split *splits; /* [staged blocks] that were there before */
    size_t split_count;
    tl_cut_loads loads; /* of the bodies that were cut */
    tl_stage_seats seats;
    tl_poly **gone; /* [rows before] shapes that other shapes or blocks take the place of */
    size_t gone_count;
    tl_group_change groups; /* of the blocks that stay */
    tl_group_change parts; /* of the parts that get another group than the whole had; rows are staged blocks at first */
    tl_scope_parts scopes; /* of laws for blocks that were cut */
    tl_aside aside;        /* where there are bodies of several blocks */
    uint32_t *first;       /* [staged bodies] */
    uint32_t *group;       /* [rows] */
} commit_scratch;

/* Whether contacts are kept of blocks: those of their parts take them over. */
static bool has_contacts(const tl_model *m)
{
    return m->detect && m->found_for != TL_FOR_QUERIES;
}

/* Notes what blocks were cut out of, where there is room for it. */
static void keep_cut_parts(const tl_stage *stage, const commit_scratch *scratch)
{
    tl_model *m = stage->model;
    for (size_t i = 0; i < stage->count && has_contacts(m); i++) {
        const tl_stage_block *block = &stage->blocks[i];
        if (!tl_stage_cut(block))
            continue;
        const source *from = &scratch->sources[scratch->slot[block->source]];
        const tl_cut_part *known = tl_cut_part_of(m, from->id);
        tl_cut_part part = {.root = from->id, .r = from->pose.r, .place = tl_v3_add(from->pose.x_ref, from->pose.u)};
        part = known ? *known : part;
        part.id = scratch->ids[i];
        m->cut_parts[m->cut_part_count++] = part;
    }
}

/* Notes for elements what blocks were cut out of, where there is room for it. */
static void keep_cut_out(const tl_stage *stage, const commit_scratch *scratch)
{
    tl_model *m = stage->model;
    const size_t known = m->cut_out_count;
    for (size_t i = 0; m->elements && i < stage->count; i++) {
        if (!tl_stage_cut(&stage->blocks[i]))
            continue;
        tl_split part = {scratch->ids[i], scratch->sources[scratch->slot[stage->blocks[i].source]].id};
        for (size_t k = 0; k < known; k++)
            if (m->cut_out[k].block == part.whole) {
                part.whole = m->cut_out[k].whole;
                break;
            }
        m->cut_out[m->cut_out_count++] = part;
    }
}

/* Whether parts of a body have to go on as it does: after a step, or when something has been put on its contacts. */
static bool goes_on(const tl_model *m)
{
    return m->cycles > 0 || has_contacts(m);
}

/* Lists the blocks that were there before, with the bodies they were in in the last step. */
static void list_wholes(const tl_stage *stage, commit_scratch *scratch)
{
    const tl_model *m = stage->model;
    for (size_t i = 0; i < stage->count && goes_on(m); i++) {
        uint32_t row = stage->blocks[i].source;
        if (row == TL_NO_ROW)
            continue;
        tl_id whole = tl_split_of(m, m->blocks.id[row]);
        whole = whole == TL_NO_ID ? m->bodies.id[m->blocks.body[row]] : whole;
        scratch->splits[scratch->split_count++] = (tl_split){(tl_id)i, whole};
    }
}

static int compare_split(const void *x, const void *y)
{
    const tl_split *p = x, *q = y;
    return (p->block > q->block) - (p->block < q->block);
}

static int compare_whole(const void *x, const void *y)
{
    const tl_split *p = x, *q = y;
    return p->whole != q->whole ? (p->whole > q->whole) - (p->whole < q->whole) : compare_split(x, y);
}

/* Keeps the blocks of the bodies that are several now. The list takes the place of the model's: it has the blocks of
 * that, too. */
static void keep_splits(tl_stage *stage, commit_scratch *scratch)
{
    tl_model *m = stage->model;
    tl_split *all = scratch->splits;
    size_t kept = 0;
    for (size_t i = 0; i < scratch->split_count; i++)
        all[i].block = scratch->ids[all[i].block];
    qsort(all, scratch->split_count, sizeof *all, compare_whole);
    for (size_t from = 0, to; from < scratch->split_count; from = to) {
        bool several = false;
        uint32_t body = m->blocks.body[tl_block_row_quiet(m, all[from].block)];
        for (to = from; to < scratch->split_count && all[to].whole == all[from].whole; to++)
            several = several || m->blocks.body[tl_block_row_quiet(m, all[to].block)] != body;
        for (size_t i = from; several && i < to; i++)
            all[kept++] = all[i];
    }
    if (kept == 0)
        return;
    qsort(all, kept, sizeof *all, compare_split);
    free(m->splits);
    m->splits = all;
    m->split_count = kept;
    m->split_capacity = stage->count + 1;
    scratch->splits = NULL;
}

/* group[row] of the rows whose blocks have the given ids, as tl_bodies_regroup wants it; `first` has room for
 * stage->next_body numbers. */
static void list_groups(const tl_stage *stage, const tl_id *ids, uint32_t *first, uint32_t *group)
{
    const tl_model *m = stage->model;
    for (uint32_t body = 0; body < stage->next_body; body++)
        first[body] = TL_NO_ROW;
    for (size_t i = 0; i < stage->count; i++) {
        uint32_t row = tl_block_row_quiet(m, ids[i]), body = stage->blocks[i].body;
        first[body] = row < first[body] ? row : first[body];
    }
    for (size_t i = 0; i < stage->count; i++)
        group[tl_block_row_quiet(m, ids[i])] = first[stage->blocks[i].body];
}

/* Whether contacts of parts with another group than that of the whole are to keep their forces. */
static bool parts_keep_forces(const tl_model *m)
{
    return m->group_verbs && tl_laws_name_groups(m) && has_contacts(m);
}

/* Lists the blocks that get another group: those that stay and, where their contacts keep forces, parts. */
static void list_regrouped(const tl_stage *stage, tl_group_change *groups, tl_group_change *parts)
{
    const tl_model *m = stage->model;
    for (size_t i = 0; i < stage->count; i++) {
        const tl_stage_block *block = &stage->blocks[i];
        if (block->source == TL_NO_ROW || m->blocks.group[block->source] == block->group)
            continue;
        const bool is_part = tl_stage_made(block);
        if (is_part && !(tl_stage_cut(block) && parts_keep_forces(m)))
            continue;
        tl_group_change *list = is_part ? parts : groups;
        list->row[list->count] = is_part ? (uint32_t)i : block->source;
        list->group[list->count++] = block->group;
    }
}

static bool reserve_regrouped(tl_group_change *change, size_t count)
{
    change->row = malloc((count + 1) * sizeof *change->row);
    change->group = malloc((count + 1) * sizeof *change->group);
    return change->row && change->group;
}

/* Gives parts their groups, with the forces of contacts that come under other laws by that. Until then they have the
 * group of the whole, and their contacts take over what its contacts carried. */
static void regroup_parts(tl_stage *stage, commit_scratch *scratch)
{
    tl_model *m = stage->model;
    tl_group_change *parts = &scratch->parts;
    if (parts->count == 0)
        return;
    for (size_t i = 0; i < parts->count; i++)
        parts->row[i] = tl_block_row_quiet(m, scratch->ids[parts->row[i]]);
    if (tl_group_change_begin(m, parts) == TL_OK) {
        tl_group_change_apply(m, parts);
        return;
    }
    for (size_t i = 0; i < parts->count; i++)
        m->blocks.group[parts->row[i]] = parts->group[i];
    m->laws++;
    tl_model_say(m, "there was no memory to keep the forces of parts that come under another law by their group");
}

/* Begins what changes for laws: the blocks that get another group, and the parts of blocks that are cut. */
static tl_status begin_laws(const tl_stage *stage, size_t made, commit_scratch *scratch)
{
    tl_model *m = stage->model;
    tl_group_change *groups = &scratch->groups;
    tl_scope_parts *scopes = &scratch->scopes;
    scopes->parts = malloc((made + 1) * sizeof *scopes->parts);
    if (!reserve_regrouped(groups, stage->count) || !reserve_regrouped(&scratch->parts, stage->count) || !scopes->parts)
        return tl_fail_memory(&m->error);
    tl_id id = m->next_id; /* as add_made() gives them */
    for (size_t i = 0; i < stage->count; i++) {
        const tl_stage_block *block = &stage->blocks[i];
        if (!tl_stage_made(block))
            continue;
        if (tl_stage_cut(block))
            scopes->parts[scopes->count++] = (tl_part){m->blocks.id[block->source], id};
        id++;
    }
    list_regrouped(stage, groups, &scratch->parts);
    if (tl_laws_name_blocks(m) && !tl_scope_parts_begin(m, id, scopes))
        return tl_fail_memory(&m->error);
    return groups->count ? tl_group_change_begin(m, groups) : TL_OK;
}

static void free_laws(const tl_model *m, commit_scratch *scratch)
{
    tl_group_change_free(&scratch->groups);
    tl_group_change_free(&scratch->parts);
    tl_scope_parts_free(m, &scratch->scopes);
}

static void free_scratch(commit_scratch *scratch)
{
    tl_stage_seats_free(&scratch->seats);
    tl_cut_loads_free(&scratch->loads);
    free(scratch->splits);
    free(scratch->keep);
    free(scratch->slot);
    free(scratch->sources);
    free(scratch->ids);
    free(scratch->gone);
    free(scratch->first);
    free(scratch->group);
}

/* Finds the blocks that stay and those that were cut. */
static bool sort_rows(const tl_stage *stage, size_t old, commit_scratch *scratch)
{
    scratch->keep = calloc(old + 1, 1);
    scratch->slot = malloc((old + 1) * sizeof *scratch->slot);
    if (!scratch->keep || !scratch->slot)
        return false;
    for (size_t row = 0; row < old; row++)
        scratch->slot[row] = TL_NO_ROW;
    for (size_t i = 0; i < stage->count; i++) {
        const tl_stage_block *block = &stage->blocks[i];
        if (block->source == TL_NO_ROW)
            continue;
        if (!tl_stage_made(block))
            scratch->keep[block->source] = 1;
        else if (scratch->slot[block->source] == TL_NO_ROW)
            scratch->slot[block->source] = (uint32_t)scratch->source_count++;
    }
    scratch->sources = malloc((scratch->source_count + 1) * sizeof *scratch->sources);
    return scratch->sources != NULL;
}

/* Room in the model's record for the cuts that were refused. */
static bool reserve_record(const tl_stage *stage)
{
    tl_cut_record *record = &stage->model->record;
    if (stage->refused_listed == 0)
        return true;
    size_t listed = record->listed + stage->refused_listed;
    tl_refused_cut *list = realloc(record->list, listed * sizeof *list);
    if (list)
        record->list = list;
    return list != NULL;
}

/* `old`: rows that the stage may replace, none of one that has not been opened. */
static bool reserve_scratch(tl_stage *stage, size_t old, size_t made, commit_scratch *scratch)
{
    size_t rows = stage->model->blocks.table.rows + made;
    scratch->ids = malloc((stage->count + 1) * sizeof *scratch->ids);
    scratch->splits = malloc((stage->count + 1) * sizeof *scratch->splits);
    scratch->gone = malloc((old + 1) * sizeof *scratch->gone);
    if (stage->regroups) {
        scratch->first = malloc((stage->next_body + (size_t)1) * sizeof *scratch->first);
        scratch->group = malloc((old + made + 1) * sizeof *scratch->group);
    }
    return sort_rows(stage, old, scratch) && scratch->ids && scratch->splits && scratch->gone &&
           (!stage->regroups || (scratch->first && scratch->group)) && rows < TL_NO_ROW && reserve_record(stage) &&
           tl_cut_loads_take(stage, &scratch->loads) &&
           tl_stage_seats_take(stage, scratch->keep, old, &scratch->seats) &&
           (!has_contacts(stage->model) ||
            tl_grow(&stage->model->cut_parts, &stage->model->cut_part_capacity, stage->model->cut_part_count + made,
                    sizeof *stage->model->cut_parts)) &&
           (!stage->model->elements || tl_grow(&stage->model->cut_out, &stage->model->cut_out_capacity,
                                               stage->model->cut_out_count + made, sizeof *stage->model->cut_out)) &&
           tl_rows_reserve(stage->model, rows) &&
           (!stage->regroups || tl_rows_set_aside(stage->model, &scratch->aside));
}

/* Writes what the stage changed of the blocks that stay, and drops those it replaces; what their
 * children take over is kept aside. So new rows are written where they stay. */
static void drop_replaced(tl_stage *stage, size_t old, commit_scratch *scratch)
{
    tl_model *m = stage->model;
    for (size_t i = 0; i < stage->count; i++) {
        tl_stage_block *block = &stage->blocks[i];
        if (tl_stage_made(block))
            continue;
        scratch->ids[i] = m->blocks.id[block->source];
        if (block->retagged) {
            scratch->gone[scratch->gone_count++] = m->blocks.shape[block->source];
            m->blocks.shape[block->source] = block->shape;
            tl_block_changes(m, block->source);
        }
    }
    /* a drive goes on for the children though none of its bodies is left in between */
    for (uint32_t row = 0; row < old; row++)
        if (scratch->slot[row] != TL_NO_ROW) {
            scratch->sources[scratch->slot[row]] = source_of(m, row);
            uint32_t drive = m->bodies.drive[m->blocks.body[row]];
            if (drive)
                m->drives[drive - 1].bodies++;
        }
    for (uint32_t row = 0; row < old; row++)
        if (!scratch->keep[row]) {
            scratch->gone[scratch->gone_count++] = m->blocks.shape[row];
            stage->changed_volume -= m->blocks.volume[row];
            tl_extremes_drop(m, row);
            m->blocks.stays[row] = false;
            m->gone++;
        }
    if (old)
        tl_rows_tidy(m);
}

/* Adds the blocks that were made, each as a body of its own. */
static void add_made(tl_stage *stage, size_t made, commit_scratch *scratch)
{
    tl_model *m = stage->model;
    uint32_t row = (uint32_t)m->blocks.table.rows, body = (uint32_t)m->bodies.table.rows;
    tl_table_resize(&m->blocks.table, row + made);
    tl_table_resize(&m->bodies.table, body + made);
    for (size_t i = 0; i < stage->count; i++) {
        const tl_stage_block *block = &stage->blocks[i];
        if (!tl_stage_made(block))
            continue;
        scratch->ids[i] = m->next_id;
        const source *from = block->source == TL_NO_ROW ? NULL : &scratch->sources[scratch->slot[block->source]];
        const uint32_t group = tl_stage_cut(block) && scratch->parts.count ? from->group : block->group;
        put(m, block, from, group, row, body++);
        stage->changed_volume += m->blocks.volume[row];
        row++;
    }
    for (size_t i = 0; i < scratch->source_count; i++)
        if (scratch->sources[i].drive)
            m->drives[scratch->sources[i].drive - 1].bodies--;
    m->structure++;
}

tl_status tl_stage_commit(tl_stage *stage)
{
    tl_model *m = stage->model;
    size_t old = stage->opened ? m->blocks.table.rows : 0, made = 0;
    for (size_t i = 0; i < stage->count; i++)
        made += tl_stage_made(&stage->blocks[i]);
    commit_scratch scratch = {0};
    tl_status status = tl_stage_settle(stage);
    if (status == TL_OK)
        status = tl_stage_check_cuts(stage);
    if (status == TL_OK)
        status = begin_laws(stage, made, &scratch);
    if (status == TL_OK && !reserve_scratch(stage, old, made, &scratch))
        status = tl_fail_memory(&m->error);
    if (status != TL_OK) {
        free_laws(m, &scratch);
        free_scratch(&scratch);
        tl_stage_end(stage);
        return status;
    }
    /* From here on nothing can fail but the grouping of blocks into bodies, for want of memory. */
    list_wholes(stage, &scratch);
    if (scratch.groups.count)
        tl_group_change_apply(m, &scratch.groups);
    drop_replaced(stage, old, &scratch);
    add_made(stage, made, &scratch);
    summarize(stage, made);
    if (stage->regroups) {
        list_groups(stage, scratch.ids, scratch.first, scratch.group);
        status = tl_bodies_regroup(m, scratch.group);
        tl_rows_settle(m, &scratch.aside, status == TL_OK);
    }
    if (status == TL_OK) {
        tl_cut_loads_give(stage, scratch.ids, &scratch.loads);
        keep_record(stage, scratch.ids);
        keep_cut_parts(stage, &scratch);
        keep_cut_out(stage, &scratch);
        keep_splits(stage, &scratch);
        tl_stage_seats_give(stage, scratch.ids, &scratch.seats);
        if (tl_laws_name_blocks(m))
            tl_scope_parts_apply(m, &scratch.scopes);
        for (size_t i = 0; i < scratch.gone_count; i++)
            tl_poly_free(scratch.gone[i]);
        regroup_parts(stage, &scratch);
        stage->committed = true;
    }
    free_laws(m, &scratch);
    free_scratch(&scratch);
    tl_stage_end(stage);
    return status;
}
