/* state_hash.c - a digest of all that the next call depends on: places, velocities, forces and histories, shapes,
 * names, laws, damping and settings. Two models of the same digest go on alike, whatever is done to both.
 *
 * Contacts are taken as the next step will find them, in a copy of the detection. They may have been brought up to
 * the present places already, by a step that failed after that or by a question. That makes no difference. The rates
 * of the bodies are found likewise, where motion follows from rates that were kept. Left out is what is only told:
 * energies, displacements' zero, record of cuts, when contacts began. So is the order of contacts. So is what only
 * saves work: cached axes, the broad phase. The results do not depend on it beyond the caches' margins. A column that
 * few models need counts as zeros where there is none. What follows from the rest and lies in a row with it (a pose's
 * matrix) does no harm. */
#include "base/hash.h"
#include "contact/body_contacts.h"
#include "contact/contacts.h"
#include "contact/store.h"
#include "cycle/cycle_data.h"
#include "cycle/prepare.h"
#include "cycle/timestep.h"
#include "detect/detect.h"
#include "element/follow.h"
#include "element/set.h"
#include "model/loads.h"
#include "model/record.h"
#include "model/scope.h"
#include "model/seats.h"
#include "model/walk.h"
#include "segment/meets.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Whole numbers of the settings, and a few more. */
#define MOST_WORDS 64

static void hash_rows(tl_hash *hash, const tl_table *table, size_t begin, size_t end)
{
    for (size_t i = 0; i < table->column_count; i++) {
        size_t size = table->columns[i].size;
        if (table->columns[i].flags & TL_COLUMN_STATE)
            tl_hash_bytes(hash, (const char *)tl_table_data(table, i) + begin * size, (end - begin) * size);
    }
}

static void hash_text(tl_hash *hash, const char *text)
{
    tl_hash_bytes(hash, text, strlen(text));
}

static void hash_tag(tl_hash *hash, tl_tag tag)
{
    tl_hash_word(hash, (uint64_t)tag.joint << 32 | tag.plane);
}

/* Adds to `sum` one of several things whose order means nothing. */
static void hash_any_order(tl_hash *sum, const tl_hash *one)
{
    sum->a += one->a;
    sum->b += one->b;
}

/* ---------------------------------------------------------------- slices ----------------- */

/* Ids of a slice: what has one of them is digested by itself, and the digests of slices in their order. So slices can
 * be digested apart, wherever they are. */
#define SLICE 4096u

/* Adds rows [begin, end), whose ids lie in one slice. */
typedef void (*rows_fn)(tl_hash *hash, const tl_model *m, uint32_t begin, uint32_t end);

/* Adds the digests of all slices of rows, which are in the order of their ids. */
static void hash_slices(tl_hash *hash, const tl_model *m, const tl_id *id, uint32_t rows, rows_fn add)
{
    for (uint32_t begin = 0, end; begin < rows; begin = end) {
        const uint32_t slice = id[begin] / SLICE;
        tl_hash one = tl_hash_start();
        for (end = begin + 1; end < rows && id[end] / SLICE == slice;)
            end++;
        add(&one, m, begin, end);
        tl_hash_word(hash, slice);
        tl_hash_word(hash, one.a);
        tl_hash_word(hash, one.b);
    }
}

/* ---------------------------------------------------------------- contacts --------------- */

static void hash_point(tl_hash *hash, const tl_points_table *p, size_t row, uint32_t columns)
{
    double late[2 + TL_STATE_COLUMNS];
    late[0] = p->initial ? p->reference[row] : 0;
    late[1] = p->initial ? p->f_n0[row] : 0;
    for (uint32_t k = 0; k < columns; k++)
        late[2 + k] = k < p->state_columns ? p->state[k][row] : 0;
    hash_rows(hash, &p->table, row, row + 1);
    tl_hash_numbers(hash, late, 2 + columns);
}

/* What a field contact keeps beside its points that does not follow from places. It is how far an initial stress
 * moves a face, shear energy beyond that of uniform stress, and the place of its slopes. Zeros count as no row. */
static void hash_press(tl_hash *hash, const tl_detect *d, uint32_t contact)
{
    if (d->contacts.press[contact] == TL_NO_ROW)
        return;
    const tl_press_row *row = &d->press[d->contacts.press[contact]];
    const double numbers[] = {row->shift, row->spare[0], row->spare[1], row->opening[0], row->opening[1]};
    if (row->shift == 0 && row->spare[0] == 0 && row->spare[1] == 0)
        return;
    tl_hash_numbers(hash, numbers, sizeof numbers / sizeof *numbers);
    tl_hash_numbers(hash, &row->lean[0].offset, row->leans ? 1 : 0);
    uint32_t faces = row->shifted.a | (uint32_t)row->shifted.b << 16;
    tl_hash_word(hash, row->shift != 0 ? faces : 0);
}

/* Those of some blocks with later ones, in the order of the blocks: which row and lane a contact has depends on when it
 * was made. */
static void hash_contacts(tl_hash *hash, const tl_model *m, uint32_t begin, uint32_t end)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    for (uint32_t block = begin; block < end; block++)
        for (tl_body_contacts at = tl_contacts_of_block(m, block); tl_next_contact(&at);) {
            const uint32_t contact = at.contact;
            if (c->a[contact] != block)
                continue; /* it comes with its other block */
            uint32_t law = c->law[contact], columns = 0;
            if (law != TL_NO_ROW)
                columns = tl_kind_state_columns(m->joint_laws[law].kind);
            tl_hash_word(hash, (uint64_t)m->blocks.id[block] << 32 | m->blocks.id[c->b[contact]]);
            hash_rows(hash, &c->table, contact, contact + 1);
            tl_contact_kind_of(d, contact)->place->hash(hash, d, contact);
            hash_press(hash, d, contact);
            for (uint32_t k = 0; k < c->point_count[contact]; k++)
                hash_point(hash, &d->points, tl_point_row(c, contact, k), columns);
        }
}

static void say_nothing(void *user, const char *text)
{
    (void)user;
    (void)text;
}

/* Rates as the next step will keep them, for contacts as it will find them. */
static tl_status hash_rates(tl_hash *hash, tl_model *m)
{
    double known;
    if (!tl_rates_are_state(m, &known))
        return TL_OK;
    tl_status status = tl_cycle_prepare(m);
    if (status != TL_OK)
        return status;
    size_t bodies = m->bodies.table.rows;
    double *rate = calloc(2 * bodies + 1, sizeof *rate);
    if (!rate)
        return tl_fail_memory(&m->error);
    tl_rates_try(m, known, rate, rate + bodies);
    tl_hash_numbers(hash, rate, tl_scales_all(m) ? 2 * bodies : bodies);
    free(rate);
    return TL_OK;
}

/* Hashes the contacts as the next step will find them. They are found in a copy, or for the first time beside the
 * model. Only a step may bring those of the model up to date. */
static tl_status hash_next_contacts(tl_hash *hash, tl_model *m)
{
    struct tl_detect *own = m->detect, *stepped = m->stepped;
    const struct tl_detect *lasting = tl_detect_lasting(m);
    struct tl_detect *copy = lasting ? tl_detect_copy(lasting) : NULL;
    tl_found_for found_for = m->found_for;
    size_t cut_part_count = m->cut_part_count;
    tl_log_fn log = m->log;
    if (lasting && !copy)
        return tl_fail_memory(&m->error);
    m->detect = copy;
    m->stepped = NULL;
    m->found_for = TL_FOR_STEPS;
    m->log = say_nothing;
    tl_status status = tl_detect_update(m);
    if (status == TL_OK) {
        hash_slices(hash, m, m->blocks.id, (uint32_t)m->blocks.table.rows, hash_contacts);
        status = hash_rates(hash, m);
    }
    m->log = log;
    if (m->detect) /* it need not be the copy any more */
        tl_detect_destroy(m->detect);
    m->detect = own;
    m->stepped = stepped;
    m->found_for = found_for;
    m->cut_part_count = cut_part_count;
    return status;
}

/* ---------------------------------------------------------------- blocks and bodies ------ */

static void hash_shape(tl_hash *hash, const tl_poly *p)
{
    tl_hash_bytes(hash, p->vertex, p->vertex_count * sizeof *p->vertex);
    tl_hash_bytes(hash, p->plane, p->face_count * sizeof *p->plane);
    tl_hash_bytes(hash, p->tag, p->face_count * sizeof *p->tag);
    tl_hash_bytes(hash, p->loop, p->start[p->face_count] * sizeof *p->loop);
}

static void hash_record(tl_hash *hash, const tl_record *record, int axis, double begin)
{
    const double head[] = {axis, begin, record->dt, (double)record->count, record->interval[0].velocity};
    tl_hash_numbers(hash, head, sizeof head / sizeof *head);
    for (size_t i = 0; i < record->count; i++)
        tl_hash_numbers(hash, &record->interval[i].from, 2);
}

/* Of a drive's functions it is only told that they are there: what they do is the script's. */
static void hash_drive(tl_hash *hash, const tl_drive *drive)
{
    const double parts[] = {drive->velocity.x,         drive->velocity.y,         drive->velocity.z,
                            drive->angular_velocity.x, drive->angular_velocity.y, drive->angular_velocity.z};
    tl_hash_numbers(hash, parts, sizeof parts / sizeof *parts);
    tl_hash_word(hash, (uint64_t)(drive->velocity_at != NULL) << 1 | (uint64_t)(drive->angular_velocity_at != NULL));
    for (int k = 0; k < 3; k++)
        if (drive->record[k])
            hash_record(hash, drive->record[k], k, drive->record_begin);
    if (tl_drive_has_gradient(drive)) {
        tl_hash_numbers(hash, &drive->gradient[0][0], 9);
        tl_hash_numbers(hash, &drive->at.x, 3);
    }
}

static void hash_blocks(tl_hash *hash, const tl_model *m, uint32_t begin, uint32_t end)
{
    hash_rows(hash, &m->blocks.table, begin, end);
    for (uint32_t row = begin; row < end; row++) {
        hash_text(hash, m->groups[m->blocks.group[row]]);
        hash_shape(hash, m->blocks.shape[row]);
    }
}

static void hash_bodies(tl_hash *hash, const tl_model *m, uint32_t begin, uint32_t end)
{
    hash_rows(hash, &m->bodies.table, begin, end);
    for (uint32_t body = begin; body < end; body++) {
        tl_body_load load = tl_load_of(&m->bodies, body);
        tl_hash_bytes(hash, &load, sizeof load);
        if (tl_load_changed(m, body))
            tl_hash_bytes(hash, &m->bodies.load_before[body], sizeof *m->bodies.load_before);
        if (m->bodies.drive[body])
            hash_drive(hash, &m->drives[m->bodies.drive[body] - 1].drive);
    }
}

/* The faces of a seated pair, and where they are by the blocks' own centroids. */
static void hash_seated(tl_hash *hash, const tl_model *m, const tl_seated *seated)
{
    const uint32_t row[] = {tl_block_row_quiet(m, seated->block[0]), tl_block_row_quiet(m, seated->block[1])};
    if (row[0] == TL_NO_ROW || row[1] == TL_NO_ROW)
        return;
    tl_hash_word(hash, (uint64_t)seated->block[0] << 32 | seated->block[1]);
    for (int k = 0; k < 2; k++) {
        const tl_block_frame now = tl_block_frame_of(m, row[k]);
        const tl_plane plane = tl_plane_reframed(seated->plane[k], &seated->frame[k], &now);
        const double numbers[] = {plane.normal.x, plane.normal.y, plane.normal.z, plane.offset};
        tl_hash_word(hash, seated->face[k]);
        tl_hash_numbers(hash, numbers, seated->face[k] == TL_NO_ROW ? 0 : 4);
    }
}

static void hash_rock(tl_hash *hash, const tl_model *m)
{
    hash_slices(hash, m, m->blocks.id, (uint32_t)m->blocks.table.rows, hash_blocks);
    hash_slices(hash, m, m->bodies.id, (uint32_t)m->bodies.table.rows, hash_bodies);
    for (size_t i = 0; i < m->split_count; i++)
        tl_hash_word(hash, (uint64_t)m->splits[i].block << 32 | m->splits[i].whole);
    for (size_t i = 0; i < m->seats.count; i++)
        hash_seated(hash, m, &m->seats.list[i]);
    for (size_t i = 0; i < m->face_load_count; i++)
        if (tl_block_row_quiet(m, m->face_loads[i].block) != TL_NO_ROW)
            tl_hash_bytes(hash, &m->face_loads[i], sizeof m->face_loads[i]);
}

/* ---------------------------------------------------------------- deformable blocks ------ */

/* What acts on the surface of a mesh, and drives its gridpoints. */
static void hash_outer(tl_hash *hash, const tl_model *m, const tl_body_mesh *mesh)
{
    const struct tl_zones *z = m->zones;
    for (size_t k = 0; k < z->outer_count; k++) {
        tl_outer_part of = z->outer[k];
        if (of.part < mesh->part_begin || of.part >= mesh->part_end)
            continue;
        if (of.drive)
            hash_drive(hash, &m->drives[of.drive - 1].drive);
        if (of.quiet)
            hash_text(hash, z->solid[of.solid].name);
        of.part -= mesh->part_begin;
        of.drive = of.solid = 0;
        tl_hash_bytes(hash, &of, sizeof of);
    }
    for (uint32_t row = mesh->point_begin; z->points.drive && row < mesh->point_end; row++)
        if (z->points.drive[row]) {
            tl_hash_word(hash, row - mesh->point_begin);
            hash_drive(hash, &m->drives[z->points.drive[row] - 1].drive);
        }
}

static void hash_mesh(tl_hash *hash, const tl_model *m, const tl_body_mesh *mesh)
{
    const struct tl_zones *z = m->zones;
    hash_rows(hash, &z->points.table, mesh->point_begin, mesh->point_end);
    hash_outer(hash, m, mesh);
    for (uint32_t k = mesh->parcel_begin; k < mesh->parcel_end; k++) {
        const tl_parcel *of = &z->parcels.of[k];
        const tl_named_solid *solid = &z->solid[of->solid];
        hash_text(hash, solid->name);
        hash_text(hash, solid->of.kind->name);
        tl_hash_word(hash, of->block);
        hash_rows(hash, &z->parcels.table, k, k + 1);
        for (uint32_t g = of->group_begin; g < of->group_end; g++) {
            const size_t begin = z->group[g].start, end = begin + (size_t)z->group[g].depth * TL_LANES;
            for (int a = 0; a < 4; a++)
                tl_hash_bytes(hash, z->zones.corner[a] + begin, (end - begin) * sizeof **z->zones.corner);
            hash_rows(hash, &z->zones.table, begin, end);
        }
    }
}

/* In the order of the bodies. */
static void hash_meshes(tl_hash *hash, const tl_model *m)
{
    tl_hash sum = {0, 0};
    for (size_t k = 0; k < m->zones->mesh_count; k++) {
        tl_hash one = tl_hash_start();
        tl_hash_word(&one, m->zones->mesh[k].body);
        hash_mesh(&one, m, &m->zones->mesh[k]);
        hash_any_order(&sum, &one);
    }
    tl_hash_word(hash, sum.a);
    tl_hash_word(hash, sum.b);
}

/* In no order: which rows they have depends on the laws that there are. */
static void hash_segments(tl_hash *hash, const tl_model *m)
{
    const struct tl_segments *s = m->segments;
    tl_hash sum = {0, 0};
    for (size_t row = 0; row < s->table.table.rows; row++) {
        const tl_segment *of = &s->table.of[row];
        if (of->meet == TL_NO_ROW)
            continue;
        const tl_meet *meet = &s->meet[of->meet];
        tl_hash one = tl_hash_start();
        tl_hash_word(&one, (uint64_t)meet->a << 32 | meet->b);
        tl_hash_word(&one, (uint64_t)meet->face_a << 32 | meet->face_b);
        tl_hash_word(&one, (uint64_t)of->key[0] << 32 | of->key[1]);
        tl_hash_numbers(&one, &meet->share, 1);
        hash_rows(&one, &s->table.table, row, row + 1);
        for (size_t k = 0; k < TL_SEGMENT_POINTS; k++) {
            const size_t point = tl_segment_point_row(row, k);
            hash_rows(&one, &s->points.table, point, point + 1);
        }
        hash_any_order(&sum, &one);
    }
    tl_hash_word(hash, sum.a);
    tl_hash_word(hash, sum.b);
}

/* ---------------------------------------------------------------- elements --------------- */

/* What only some nodes have: zeros count as no column. */
static void hash_node(tl_hash *hash, const tl_node_table *n, size_t row)
{
    static const double none[4] = {0, 0, 0, 0};
    const tl_vec3 from = tl_node_from(n, row), outward = tl_node_outward(n, row);
    tl_hash_numbers(hash, &from.x, 3);
    tl_hash_numbers(hash, &outward.x, 3);
    tl_hash_numbers(hash, n->share ? n->share[row] : none, 4);
}

/* By name: which numbers kinds, groups and states have depends on what was there before. */
static void hash_elements(tl_hash *hash, const tl_model *m)
{
    const struct tl_elements *e = m->elements;
    if (!e || (e->next_id == 1 && e->set_count == 0)) /* there have been none, but for calls that failed */
        return;
    const tl_element_table *t = &e->table;
    tl_hash_word(hash, e->next_id);
    for (size_t k = 0; k < e->set_count; k++) {
        hash_text(hash, e->set[k].kind->name);
        hash_text(hash, m->groups[e->set[k].group]);
        tl_element_set_hash(&e->set[k], hash);
    }
    for (size_t row = 0; row < t->table.rows; row++) {
        tl_hash_word(hash, t->set[row]);
        hash_rows(hash, &t->table, row, row + 1);
    }
    hash_rows(hash, &e->nodes.table, 0, e->nodes.table.rows);
    for (size_t row = 0; row < e->nodes.table.rows; row++)
        hash_node(hash, &e->nodes, row);
    hash_rows(hash, &e->steady.table, 0, e->steady.table.rows);
}

/* ---------------------------------------------------------------- settings --------------- */

/* The blocks that a law names, those that live, and how many such laws were named before it. */
static void hash_scope(tl_hash *hash, const tl_model *m, const tl_scope *s)
{
    uint64_t before = 0;
    for (size_t i = 0; i < m->joint_law_count; i++)
        before += m->joint_laws[i].scope.names > 0 && m->joint_laws[i].scope.order < s->order;
    tl_hash_word(hash, before);
    tl_hash_word(hash, s->names);
    for (size_t i = 0; i < s->pair_count; i++)
        if (tl_block_row_quiet(m, (tl_id)(s->pairs[i] >> 32)) != TL_NO_ROW &&
            tl_block_row_quiet(m, (tl_id)s->pairs[i]) != TL_NO_ROW)
            tl_hash_word(hash, s->pairs[i]);
    tl_hash sum = {0, 0}; /* of the two sides in any order */
    for (uint32_t k = 0; k < s->names && !s->pairs; k++) {
        const tl_scope_side *side = &s->side[k];
        tl_hash one = tl_hash_start();
        hash_text(&one, side->group != TL_NO_ROW ? m->groups[side->group] : "");
        for (size_t row = 0; row < m->blocks.table.rows && side->group == TL_NO_ROW; row++)
            if (tl_id_set_has(&side->list, m->blocks.id[row]))
                tl_hash_word(&one, m->blocks.id[row]);
        hash_any_order(&sum, &one);
    }
    tl_hash_word(hash, sum.a);
    tl_hash_word(hash, sum.b);
}

static void hash_laws(tl_hash *hash, const tl_model *m)
{
    tl_hash sum = {0, 0};
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const tl_law *law = &m->joint_laws[i];
        tl_hash one = tl_hash_start();
        hash_tag(&one, law->scope.tag);
        if (law->scope.names > 0)
            hash_scope(&one, m, &law->scope);
        hash_text(&one, law->kind->name);
        tl_hash_bytes(&one, law->params, law->kind->params_size);
        hash_any_order(&sum, &one);
    }
    for (size_t i = 0; i < m->joint_min_area_count; i++) {
        tl_hash one = tl_hash_start();
        hash_tag(&one, m->joint_min_areas[i].tag);
        tl_hash_numbers(&one,
                        (const double[]){m->joint_min_areas[i].rule.fraction, m->joint_min_areas[i].rule.absolute}, 2);
        hash_any_order(&sum, &one);
    }
    tl_hash_word(hash, sum.a);
    tl_hash_word(hash, sum.b);
}

static void hash_damping(tl_hash *hash, const tl_model *m)
{
    const tl_damping_ops *ops = m->damping->ops;
    const tl_bodies *b = &m->bodies;
    hash_text(hash, m->damping->name);
    tl_hash_bytes(hash, m->damping_params, m->damping->params_size);
    tl_hash_bytes(hash, m->damping_state, m->damping->state_count * sizeof *m->damping_state);
    if (!ops->before)
        return;
    tl_hash_bytes(hash, b->force_before, b->table.rows * sizeof *b->force_before);
    tl_hash_bytes(hash, b->moment_before, b->table.rows * sizeof *b->moment_before);
}

/* The real numbers of a struct of settings; of the share of the critical step the one in use. */
static void hash_reals(tl_hash *hash, const tl_model *m, const tl_settings *of)
{
    for (size_t i = 0; i < of->count; i++) {
        const uint32_t type = of->params[i].type;
        const double *at = tl_setting_at(m, of, i), fraction = tl_timestep_fraction(m);
        if (at == &m->timestep.error && m->timestep.rule != TL_TIMESTEP_BALANCE)
            continue; /* it makes no difference then */
        if (at == &m->timestep.zone_fraction && !tl_model_deforms(m))
            continue;
        if (at && (type == TL_PARAM_REAL || type == TL_PARAM_VEC3))
            tl_hash_numbers(hash, at == &m->timestep.fraction ? &fraction : at, type == TL_PARAM_VEC3 ? 3 : 1);
    }
}

/* Puts its whole numbers; where the next goes. */
static int64_t *put_words(int64_t *to, const tl_model *m, const tl_settings *of)
{
    for (size_t i = 0; i < of->count; i++) {
        const uint32_t type = of->params[i].type;
        const void *at = tl_setting_at(m, of, i);
        if (at && type == TL_PARAM_INT)
            memcpy(to++, at, sizeof *to);
        else if (at && (type == TL_PARAM_BOOL || type == TL_PARAM_ENUM))
            *to++ = *(const int32_t *)at;
    }
    return to;
}

/* How a relaxation goes. The secants of its leaps follow from the steps that these numbers stand for. */
static void hash_settling(tl_hash *hash, const tl_model *m)
{
    const tl_settling *s = &m->cycle->settling;
    const int64_t words[] = {s->part,      s->parts, s->came,  s->stops,   s->stop_span, s->leaps,
                             s->leap_span, s->idle,  s->leapt, s->limited, s->calm,      s->gained};
    tl_hash_numbers(
        hash, (const double[]){m->still, s->share, s->hold, s->power, s->expected, s->goal, s->carried, s->momentum},
        8);
    tl_hash_bytes(hash, words, sizeof words);
    if (m->relaxing && m->bodies.fall)
        tl_hash_bytes(hash, m->bodies.fall, m->bodies.table.rows * sizeof *m->bodies.fall);
    if (m->relaxing && m->bodies.going)
        tl_hash_bytes(hash, m->bodies.going, m->bodies.table.rows * sizeof *m->bodies.going);
}

static void hash_settings(tl_hash *hash, const tl_model *m)
{
    const struct tl_cycle *c = m->cycle;
    const tl_settings config = tl_config_settings(), timestep = tl_timestep_settings();
    /* c->dt, the step in use, stays while it is hardly too short */
    tl_hash_numbers(hash, (const double[]){m->time, m->dt, c ? c->dt : 0, c ? c->kinetic_before : 0}, 4);
    tl_hash_numbers(hash, &m->origin.x, 3);
    hash_reals(hash, m, &config);
    hash_reals(hash, m, &timestep);
    tl_hash_numbers(hash, (const double[]){m->min_area.fraction, m->min_area.absolute}, 2);
    int64_t words[MOST_WORDS] = {m->cycles, m->next_id};
    assert(config.count + timestep.count + 4 <= MOST_WORDS);
    int64_t *next = put_words(put_words(words + 2, m, &config), m, &timestep);
    *next++ = m->mass_scaling;
    *next++ = m->origin_set;
    tl_hash_bytes(hash, words, (size_t)(next - words) * sizeof *words);
    if (m->gravity_changed && !tl_v3_is_zero(tl_v3_sub(m->config.gravity, m->gravity_before)))
        tl_hash_numbers(hash, &m->gravity_before.x, 3);
    if (tl_adds_mass(m))
        tl_hash_numbers(hash, (const double[]){m->added_dt, m->added_most}, 2);
    for (size_t i = 0; i < m->joint_count; i++) {
        hash_text(hash, m->joints[i].name);
        tl_hash_word(hash, m->joints[i].planes);
    }
    hash_laws(hash, m);
    if (m->damping)
        hash_damping(hash, m);
    if (m->relaxing && c)
        hash_settling(hash, m);
}

tl_status tl_state_hash(tl_model *m, char text[33])
{
    tl_hash hash = tl_hash_start();
    tl_segments_forget_asked(m);
    tl_status status = tl_elements_ready(m);
    if (status != TL_OK)
        return status;
    status = hash_next_contacts(&hash, m);
    if (status != TL_OK)
        return status;
    hash_settings(&hash, m);
    hash_rock(&hash, m);
    if (tl_model_deforms(m))
        hash_meshes(&hash, m);
    if (m->segments && m->segments->meet_count > 0)
        hash_segments(&hash, m);
    hash_elements(&hash, m);
    snprintf(text, 33, "%016" PRIx64 "%016" PRIx64, hash.a, hash.b);
    return TL_OK;
}
