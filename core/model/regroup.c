/* regroup.c - changes of blocks and of the bodies they make: which of them move as one, which go, and what is set.
 *
 * A stale id or a bad value fails the whole call before anything is changed.
 *
 * A new body has the mass, momentum and angular momentum of its parts. Relative motion of the parts is lost, as in a
 * perfectly plastic meeting. Its frame has the attitude of its lowest block's old body, so parting and joining without
 * motion changes nothing but the last digits. */
#include "model/regroup.h"

#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/seam.h"
#include "model/deformable.h"
#include "model/joints.h"
#include "model/loads.h"
#include "model/options.h"
#include "model/rows.h"
#include "model/scope.h"

#include <stdlib.h>
#include <string.h>
#include <talus/number.h>
#include <talus/text.h>

/* Tolerance: relative difference of mass from which a body has lost a block: far above rounding, far below any block
 * that tolerances let exist. */
#define WHOLE 1e-12

tl_sym3 tl_block_inertia(const tl_model *m, uint32_t row)
{
    const tl_mat3 *r = &m->bodies.pose[m->blocks.body[row]].r;
    return tl_s3_scale(m->blocks.density[row], tl_s3_turn(tl_poly_mass(m->blocks.shape[row]).inertia, r));
}

tl_vec3 tl_block_velocity(const tl_model *m, uint32_t row)
{
    uint32_t body = m->blocks.body[row];
    tl_vec3 arm = tl_m3_mul(&m->bodies.pose[body].r, tl_block_local(m, row));
    return tl_v3_add(m->bodies.v[body], tl_v3_cross(m->bodies.w[body], arm));
}

/* What a changed body is made of. */
typedef struct parts {
    double mass;
    tl_vec3 place; /* centroid, relative to the model's origin */
    tl_vec3 momentum, spin;
    uint32_t leader; /* old row of the lowest block's body */
    unsigned fixed;
} parts;

void tl_bodies_groups(const tl_model *m, uint32_t *group)
{
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        group[row] = m->members[m->bodies.member_start[m->blocks.body[row]]];
}

static parts sum_parts(const tl_model *m, const uint32_t *rows, size_t count)
{
    const tl_blocks *b = &m->blocks;
    parts sum = {.leader = b->body[rows[0]]};
    tl_vec3 zero = tl_block_place(m, rows[0]), offset = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        double mass = b->density[rows[i]] * b->volume[rows[i]];
        sum.mass += mass;
        offset = tl_v3_madd(offset, mass, tl_v3_sub(tl_block_place(m, rows[i]), zero));
        sum.momentum = tl_v3_madd(sum.momentum, mass, tl_block_velocity(m, rows[i]));
        sum.fixed |= m->bodies.fixed[b->body[rows[i]]];
    }
    sum.place = tl_v3_madd(zero, 1 / sum.mass, offset);
    for (size_t i = 0; i < count; i++) {
        double mass = b->density[rows[i]] * b->volume[rows[i]];
        tl_vec3 arm = tl_v3_sub(tl_block_place(m, rows[i]), sum.place);
        tl_vec3 own = tl_s3_mul(tl_block_inertia(m, rows[i]), m->bodies.w[b->body[rows[i]]]);
        sum.spin = tl_v3_add(sum.spin, own);
        sum.spin = tl_v3_madd(sum.spin, mass, tl_v3_cross(arm, tl_block_velocity(m, rows[i])));
    }
    return sum;
}

/* A block's shape in the frame of its new body. */
static tl_status new_shape(tl_model *m, const parts *sum, uint32_t row, tl_poly **shape)
{
    const tl_bodies *b = &m->bodies;
    uint32_t old = m->blocks.body[row];
    const tl_mat3 *to = &b->pose[sum->leader].r;
    tl_vec3 shift = tl_m3_tmul(to, tl_v3_sub(tl_body_place(b, old), sum->place));
    tl_mat3 turn = tl_m3_tproduct(to, &b->pose[old].r);
    return tl_poly_transformed(m->blocks.shape[row], old == sum->leader ? NULL : &turn, shift, shape, &m->error);
}

/* The inverse of a body's inertia applied to its angular momentum. */
static tl_vec3 spin_velocity(const tl_bodies *b, uint32_t body, tl_vec3 spin)
{
    tl_quat attitude = tl_q_mul(b->q[body], b->axes[body]);
    tl_vec3 l = tl_q_rotate(tl_q_conj(attitude), spin), i = b->moments[body];
    return tl_q_rotate(attitude, tl_v3(l.x / i.x, l.y / i.y, l.z / i.z));
}

/* How far a block has gone from a place, m, and the turn there, of the frame of its new body. */
typedef struct gone {
    tl_vec3 moved;
    tl_quat turn;
} gone;

/* A block of a body that is made anew: from where its displacements count, and from where it was made. */
typedef struct member {
    uint32_t row;
    gone base, made;
} member;

/* A new body, of the members from `start` on. */
typedef struct new_body {
    parts parts;
    uint32_t start, count;
    uint32_t body; /* its new row */
} new_body;

/* What changes: bodies that stay as they are are only moved to other rows. */
typedef struct regroup {
    uint32_t *of;         /* [blocks] of the lowest block of a group: its size, then its number */
    unsigned char *stays; /* [bodies + new bodies] */
    uint32_t *now;        /* [bodies] new rows of those that stay */
    member *members;      /* [member_count] body by body */
    tl_poly **shapes;     /* [member_count] theirs, in the frames of the new bodies */
    size_t member_count;
    new_body *new_bodies; /* in the order of their lowest blocks */
    uint32_t *at;
    size_t new_body_count;
} regroup;

static void regroup_free(regroup *r)
{
    for (size_t i = 0; r->shapes && i < r->member_count; i++)
        tl_poly_free(r->shapes[i]);
    free(r->of);
    free(r->stays);
    free(r->now);
    free(r->members);
    free(r->shapes);
    free(r->new_bodies);
    free(r->at);
}

/* Whether a body still consists of all the blocks it was measured with. */
static bool is_whole(const tl_model *m, uint32_t body)
{
    double mass = 0;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        uint32_t row = m->members[m->bodies.member_start[body] + k];
        mass += m->blocks.density[row] * m->blocks.volume[row];
    }
    return fabs(mass - m->bodies.mass[body]) <= WHOLE * mass;
}

/* Whether the blocks of a body are a group, as r->of has their sizes. */
static bool stays(const tl_model *m, const regroup *r, const uint32_t *group, uint32_t body)
{
    const uint32_t *rows = &m->members[m->bodies.member_start[body]];
    uint32_t count = m->bodies.member_count[body];
    if (r->of[group[rows[0]]] != count || !is_whole(m, body))
        return false;
    for (uint32_t k = 1; k < count; k++)
        if (group[rows[k]] != group[rows[0]])
            return false;
    return true;
}

/* Finds the bodies that stay, and counts what is made anew. */
static bool sort_bodies(const tl_model *m, const uint32_t *group, regroup *r)
{
    size_t blocks = m->blocks.table.rows, bodies = m->bodies.table.rows;
    r->of = calloc(blocks + 1, sizeof *r->of);
    r->now = malloc((bodies + 1) * sizeof *r->now);
    r->stays = malloc(bodies + blocks + 1);
    if (!r->of || !r->now || !r->stays)
        return false;
    for (uint32_t row = 0; row < blocks; row++)
        r->of[group[row]]++;
    for (uint32_t body = 0; body < bodies; body++)
        r->stays[body] = stays(m, r, group, body);
    for (uint32_t row = 0; row < blocks; row++) {
        bool changes = !r->stays[m->blocks.body[row]];
        r->member_count += changes;
        r->new_body_count += changes && group[row] == row;
    }
    return true;
}

static gone gone_from(const tl_model *m, uint32_t row, tl_base from, uint32_t leader)
{
    const tl_quat *q = m->bodies.q;
    const uint32_t body = m->blocks.body[row];
    const tl_quat turn = body == leader ? from.turn : tl_q_mul(from.turn, tl_q_mul(tl_q_conj(q[body]), q[leader]));
    return (gone){tl_block_point_moved(m, row, &from, tl_block_local(m, row)), turn};
}

/* The place from which a block, in its new body, has gone as far as it had in the old one. */
static tl_base place_before(const tl_model *m, uint32_t row, const gone *by)
{
    tl_base from = {{0, 0, 0}, by->turn};
    from.shift = tl_v3_sub(tl_block_point_moved(m, row, &from, tl_block_local(m, row)), by->moved);
    return from;
}

/* Lists the members of the new bodies, in the order of the lowest blocks, and gives all bodies their new rows. */
static bool list_made(const tl_model *m, const uint32_t *group, regroup *r)
{
    uint32_t kept = 0, count = 0, start = 0;
    r->members = malloc((r->member_count + 1) * sizeof *r->members);
    r->shapes = calloc(r->member_count + 1, sizeof *r->shapes);
    r->new_bodies = calloc(r->new_body_count + 1, sizeof *r->new_bodies);
    r->at = malloc((r->new_body_count + 1) * sizeof *r->at);
    if (!r->members || !r->shapes || !r->new_bodies || !r->at)
        return false;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        uint32_t body = m->blocks.body[row];
        if (r->stays[body]) {
            if (m->members[m->bodies.member_start[body]] == row)
                r->now[body] = count + kept++;
            continue;
        }
        if (group[row] == row) {
            r->new_bodies[count].start = start;
            r->new_bodies[count].body = r->at[count] = count + kept;
            start += r->of[row];
            r->of[row] = count++;
        }
        new_body *one = &r->new_bodies[r->of[group[row]]];
        const uint32_t leader = m->blocks.body[group[row]];
        r->members[one->start + one->count++] = (member){row, gone_from(m, row, tl_block_base(m, row), leader),
                                                         gone_from(m, row, tl_block_made(m, row), leader)};
    }
    memset(r->stays + m->bodies.table.rows, 1, count);
    return true;
}

/* What a new body is made of, and the shapes of its blocks in its frame, with their seams. */
static tl_status make_body(tl_model *m, regroup *r, new_body *one)
{
    uint32_t *rows = malloc((one->count + 1) * sizeof *rows);
    if (!rows)
        return tl_fail_memory(&m->error);
    for (uint32_t k = 0; k < one->count; k++)
        rows[k] = r->members[one->start + k].row;
    one->parts = sum_parts(m, rows, one->count);
    tl_status status = TL_OK;
    for (uint32_t k = 0; k < one->count && status == TL_OK; k++)
        status = new_shape(m, &one->parts, rows[k], &r->shapes[one->start + k]);
    free(rows);
    if (status == TL_OK)
        status = tl_poly_mark_seams(r->shapes + one->start, one->count, &m->error);
    return status == TL_OK ? tl_poly_share_planes(r->shapes + one->start, one->count, &m->error) : status;
}

/* Writes the row of a new body over that of its leader. */
static void write_body(tl_model *m, const parts *sum, uint32_t body)
{
    tl_bodies *b = &m->bodies;
    b->pose[body].x_ref = sum->place;
    b->pose[body].u = tl_v3(0, 0, 0);
    b->fixed[body] = (uint8_t)sum->fixed;
    tl_vec3 v = tl_v3_scale(1 / sum->mass, sum->momentum);
    b->v[body] =
        tl_v3(sum->fixed & TL_FIX_X ? 0 : v.x, sum->fixed & TL_FIX_Y ? 0 : v.y, sum->fixed & TL_FIX_Z ? 0 : v.z);
    if (b->force_before)
        b->force_before[body] = b->moment_before[body] = tl_v3(0, 0, 0);
    if (b->fall)
        b->fall[body] = INFINITY;
    if (b->load_before)
        b->load_before[body] = (tl_wrench){{0, 0, 0}, {0, 0, 0}};
    if (b->load)
        b->load[body] = (tl_body_load){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
}

/* Room for bodies, and for what only blocks of joined bodies have. */
static bool reserve_rows(tl_model *m, const regroup *r)
{
    tl_blocks *blocks = &m->blocks;
    return tl_table_reserve(&m->bodies.table, m->bodies.table.rows + 2 * r->new_body_count) &&
           TL_COLUMN_NEED(&blocks->table, blocks, local, 0) && tl_blocks_hold_base(m) && tl_blocks_hold_made(m);
}

/* Rows of the new bodies, in between those that stay; the others go. */
static void write_rows(tl_model *m, regroup *r)
{
    tl_blocks *blocks = &m->blocks;
    tl_table *bodies = &m->bodies.table;
    size_t old = bodies->rows;
    tl_table_resize(bodies, old + r->new_body_count);
    for (size_t i = 0; i < r->new_body_count; i++) {
        const new_body *one = &r->new_bodies[i];
        uint32_t lowest = r->members[one->start].row;
        tl_table_move(bodies, old + i, blocks->body[lowest]);
        write_body(m, &one->parts, (uint32_t)(old + i));
        m->bodies.id[old + i] = blocks->id[lowest];
    }
    for (uint32_t row = 0; row < blocks->table.rows; row++)
        if (r->stays[blocks->body[row]])
            blocks->body[row] = r->now[blocks->body[row]];
    for (size_t i = 0; i < r->new_body_count; i++)
        for (uint32_t k = 0; k < r->new_bodies[i].count; k++)
            blocks->body[r->members[r->new_bodies[i].start + k].row] = r->new_bodies[i].body;
    tl_table_keep(bodies, r->stays);
    tl_table_insert(bodies, r->at, r->new_body_count);
}

/* Puts the new shapes into the place of the old ones. */
static void write_shapes(tl_model *m, regroup *r)
{
    tl_blocks *blocks = &m->blocks;
    for (size_t i = 0; i < r->member_count; i++) {
        uint32_t row = r->members[i].row;
        tl_poly_free(blocks->shape[row]);
        blocks->shape[row] = r->shapes[i];
        r->shapes[i] = NULL;
        blocks->local[row] = tl_poly_mass(blocks->shape[row]).centroid;
        tl_block_changes(m, row);
    }
}

/* Mass, inertia and motion of a new body, and what its blocks have been displaced by. */
static void finish_body(tl_model *m, const regroup *r, const new_body *one)
{
    tl_blocks *blocks = &m->blocks;
    tl_bodies *bodies = &m->bodies;
    tl_body_measure(m, one->body);
    bodies->w[one->body] =
        one->parts.fixed & TL_FIX_ROTATION ? tl_v3(0, 0, 0) : spin_velocity(bodies, one->body, one->parts.spin);
    bodies->pose[one->body].v_moved = bodies->v[one->body];
    bodies->pose[one->body].w_moved = bodies->w[one->body];
    for (uint32_t k = 0; k < one->count; k++) {
        const member *of = &r->members[one->start + k];
        if (one->count == 1)
            blocks->local[of->row] = tl_v3(0, 0, 0);
        blocks->base[of->row] = place_before(m, of->row, &of->base);
        blocks->made[of->row] = place_before(m, of->row, &of->made);
    }
}

/* Refuses to make bodies of zones anew. */
static tl_status check_zones(tl_model *m, const regroup *r)
{
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        if (m->bodies.mesh[body] && !r->stays[body])
            return tl_fail(&m->error, TL_E_STATE, "block %u is deformable and cannot be joined to others, nor parted",
                           m->bodies.id[body]);
    return TL_OK;
}

tl_status tl_bodies_regroup(tl_model *m, const uint32_t *group)
{
    regroup r = {0};
    tl_status status = sort_bodies(m, group, &r) ? check_zones(m, &r) : tl_fail_memory(&m->error);
    bool changes = status == TL_OK && r.new_body_count > 0;
    if (changes && !(list_made(m, group, &r) && reserve_rows(m, &r)))
        status = tl_fail_memory(&m->error);
    for (size_t i = 0; i < r.new_body_count && status == TL_OK; i++)
        status = make_body(m, &r, &r.new_bodies[i]);
    if (changes && status == TL_OK) { /* from here on nothing can fail */
        write_rows(m, &r);
        write_shapes(m, &r);
        tl_rows_refresh(m);
        for (size_t i = 0; i < r.new_body_count; i++)
            finish_body(m, &r, &r.new_bodies[i]);
        tl_drives_recount(m);
    }
    regroup_free(&r);
    return status;
}

/* Changes group[row], by which rows of blocks are chosen. */
typedef tl_status change_fn(tl_model *m, const unsigned char *chosen, uint32_t *group);

/* Makes the bodies anew by their groups as they are, and then changed. */
static tl_status regroup_by(tl_model *m, const tl_id *ids, size_t count, change_fn *change)
{
    size_t blocks = m->blocks.table.rows;
    uint32_t *group = malloc((blocks + 1) * sizeof *group);
    unsigned char *chosen = calloc(blocks + 1, 1);
    tl_status status = group && chosen ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK) {
        tl_bodies_groups(m, group);
        for (size_t i = 0; i < count; i++)
            chosen[tl_block_row_quiet(m, ids[i])] = 1;
        status = change(m, chosen, group);
    }
    if (status == TL_OK)
        status = tl_bodies_regroup(m, group);
    free(group);
    free(chosen);
    return status;
}

/* Takes the chosen blocks out of their bodies. What is left of these falls into the groups that hang together over
 * shared faces. So do bodies that have lost blocks since they were measured. */
static tl_status split_groups(tl_model *m, const unsigned char *chosen, uint32_t *group)
{
    const tl_bodies *b = &m->bodies;
    size_t blocks = m->blocks.table.rows;
    tl_poly **polys = malloc((blocks + 1) * sizeof *polys);
    uint32_t *rows = malloc((blocks + 1) * sizeof *rows);
    uint32_t *label = malloc((blocks + 1) * sizeof *label);
    tl_status status = polys && rows && label ? TL_OK : tl_fail_memory(&m->error);
    for (uint32_t body = 0; body < b->table.rows && status == TL_OK; body++) {
        uint32_t count = 0;
        for (uint32_t k = 0; k < b->member_count[body]; k++) {
            uint32_t row = m->members[b->member_start[body] + k];
            if (chosen[row]) {
                group[row] = row;
            } else {
                polys[count] = m->blocks.shape[row];
                rows[count++] = row;
            }
        }
        if (count == 0 || (count == b->member_count[body] && is_whole(m, body)))
            continue;
        status = tl_poly_connected(polys, count, NULL, NULL, label, &m->error);
        for (uint32_t k = 0; k < count && status == TL_OK; k++)
            group[rows[k]] = rows[label[k]];
    }
    free(polys);
    free(rows);
    free(label);
    return status;
}

/* Makes the given blocks bodies by themselves. What is left of their bodies, and of others that lost blocks since they
 * were measured, falls into groups that hang together over faces. */
static tl_status fall_apart(tl_model *m, const tl_id *ids, size_t count)
{
    return regroup_by(m, ids, count, split_groups);
}

/* Makes bodies anew whose blocks were cut off or changed their mass. */
static tl_status mend_bodies(tl_model *m)
{
    bool whole = true;
    for (uint32_t body = 0; body < m->bodies.table.rows && whole; body++)
        whole = is_whole(m, body);
    return whole ? TL_OK : fall_apart(m, NULL, 0);
}

/* Whether some of the blocks are parts of bodies of several. */
static bool some_joined(const tl_model *m, const tl_id *ids, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (m->bodies.member_count[m->blocks.body[tl_block_row_quiet(m, ids[i])]] > 1)
            return true;
    return false;
}

/* Deletes a block that has no part in a body of several. Its row goes with others. */
static void delete_block(tl_model *m, tl_id id)
{
    uint32_t row = tl_block_row_quiet(m, id);
    if (row == TL_NO_ROW) /* named twice */
        return;
    m->record.deleted += m->blocks.volume[row];
    tl_extremes_drop(m, row);
    tl_drive_leave(m, m->blocks.body[row]);
    tl_poly_free(m->blocks.shape[row]);
    m->blocks.shape[row] = NULL;
    m->blocks.stays[row] = false;
    m->gone++;
}

/* Refuses to delete a part of a deformable body. */
static tl_status check_meshes(tl_model *m, const tl_id *ids, size_t count)
{
    unsigned char *chosen = calloc(m->blocks.table.rows + 1, 1);
    tl_status status = chosen ? TL_OK : tl_fail_memory(&m->error);
    for (size_t i = 0; i < count && status == TL_OK; i++)
        chosen[tl_block_row_quiet(m, ids[i])] = 1;
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        const uint32_t row = tl_block_row_quiet(m, ids[i]), body = m->blocks.body[row];
        for (uint32_t k = 0; m->bodies.mesh[body] && k < m->bodies.member_count[body] && status == TL_OK; k++) {
            const uint32_t other = m->members[m->bodies.member_start[body] + k];
            if (!chosen[other])
                status =
                    tl_fail(&m->error, TL_E_STATE,
                            "cannot delete block %u: it is deformable and joined to block %u, which would stay; delete "
                            "blocks of a body before they get zones, or all of them",
                            ids[i], m->blocks.id[other]);
        }
    }
    free(chosen);
    return status;
}

/* Takes blocks out of their bodies, but those whose bodies have zones: these go whole. */
static tl_status leave_bodies(tl_model *m, const tl_id *ids, size_t count)
{
    tl_status status = check_meshes(m, ids, count);
    tl_id *rigid = status == TL_OK ? malloc((count + 1) * sizeof *rigid) : NULL;
    size_t rigid_count = 0;
    if (status == TL_OK && !rigid)
        status = tl_fail_memory(&m->error);
    for (size_t i = 0; i < count && status == TL_OK; i++)
        if (!m->bodies.mesh[m->blocks.body[tl_block_row_quiet(m, ids[i])]])
            rigid[rigid_count++] = ids[i];
    if (status == TL_OK && rigid_count > 0)
        status = fall_apart(m, rigid, rigid_count);
    free(rigid);
    return status;
}

tl_status tl_blocks_delete(tl_model *m, const tl_id *ids, size_t count)
{
    tl_status status = tl_model_may_change(m, "delete blocks");
    if (status == TL_OK)
        status = tl_blocks_check(m, ids, count);
    if (status == TL_OK && some_joined(m, ids, count)) {
        tl_rows_tidy(m);
        status = leave_bodies(m, ids, count);
    }
    for (size_t i = 0; i < count && status == TL_OK; i++)
        delete_block(m, ids[i]);
    return status;
}

/* ---------------------------------------------------------------- verbs ------------------ */

/* Refuses bodies that are driven or loaded: what would become of that is the user's to say. */
static tl_status check_parts(tl_model *m, const tl_id *ids, size_t count, const char *verb)
{
    tl_status status = tl_model_may_change(m, verb);
    if (status == TL_OK)
        tl_rows_tidy(m);
    if (status == TL_OK)
        status = tl_blocks_check_rigid(m, ids, count, verb, "join or unjoin blocks before they get zones");
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        uint32_t row = tl_block_row(m, ids[i]);
        if (row == TL_NO_ROW)
            return m->error.status;
        uint32_t body = m->blocks.body[row];
        bool loaded = tl_body_loaded(&m->bodies, body);
        if (m->bodies.drive[body] || loaded)
            status =
                tl_fail(&m->error, TL_E_STATE, "cannot %s: block %u is %s; take that off first and set it again after",
                        verb, ids[i], loaded ? "loaded" : "driven");
    }
    return status;
}

/* Every body with a block chosen comes along whole. */
static tl_status join_groups(tl_model *m, const unsigned char *chosen, uint32_t *group)
{
    const tl_bodies *b = &m->bodies;
    uint32_t lowest = TL_NO_ROW;
    for (uint32_t body = 0; body < b->table.rows; body++) {
        const uint32_t *rows = &m->members[b->member_start[body]];
        bool joins = false;
        for (uint32_t k = 0; k < b->member_count[body]; k++)
            joins = joins || chosen[rows[k]];
        if (joins && lowest == TL_NO_ROW)
            lowest = rows[0]; /* bodies are in the order of their lowest blocks */
        for (uint32_t k = 0; joins && k < b->member_count[body]; k++)
            group[rows[k]] = lowest;
    }
    return TL_OK;
}

/* Chosen blocks go alone; what is left of a body is named by its lowest remaining block. */
static tl_status part_groups(tl_model *m, const unsigned char *chosen, uint32_t *group)
{
    const tl_bodies *b = &m->bodies;
    for (uint32_t body = 0; body < b->table.rows; body++) {
        const uint32_t *rows = &m->members[b->member_start[body]];
        uint32_t lowest = TL_NO_ROW;
        for (uint32_t k = 0; k < b->member_count[body]; k++) {
            if (!chosen[rows[k]] && lowest == TL_NO_ROW)
                lowest = rows[k];
            group[rows[k]] = chosen[rows[k]] ? rows[k] : lowest;
        }
    }
    return TL_OK;
}

tl_status tl_blocks_join(tl_model *m, const tl_id *ids, size_t count)
{
    tl_status status = check_parts(m, ids, count, "join blocks");
    return status == TL_OK && count > 1 ? regroup_by(m, ids, count, join_groups) : status;
}

/* Refuses bodies whose parts could fly off faster than any model can run with. */
static tl_status check_spin(tl_model *m, const tl_id *ids, size_t count)
{
    const tl_bodies *b = &m->bodies;
    for (size_t i = 0; i < count; i++) {
        uint32_t body = m->blocks.body[tl_block_row_quiet(m, ids[i])];
        double speed = tl_v3_norm(b->v[body]) + tl_v3_norm(b->w[body]) * b->radius[body];
        if (b->member_count[body] > 1 && !(speed <= TL_FASTEST))
            return tl_fail(&m->error, TL_E_NUMERIC,
                           "cannot unjoin blocks: parts of the body of block %u move at up to %g "
                           "m/s, and no model can run with more than %g: set its velocities first",
                           ids[i], speed, TL_FASTEST);
    }
    return TL_OK;
}

tl_status tl_blocks_unjoin(tl_model *m, const tl_id *ids, size_t count)
{
    tl_status status = check_parts(m, ids, count, "unjoin blocks");
    if (status == TL_OK)
        status = check_spin(m, ids, count);
    return status == TL_OK && count > 0 ? regroup_by(m, ids, count, part_groups) : status;
}

/* ---------------------------------------------------------------- rows set aside ----------
 *
 * What a change of many rows needs so that it can be taken back: copies of the rows as they were. The model must look
 * as if nothing had been tried, to the counts of changes, by which caches tell that they are out of date. */

bool tl_rows_set_aside(tl_model *m, tl_aside *aside)
{
    tl_rows_tidy(m);
    aside->blocks = m->blocks;
    aside->bodies = m->bodies;
    bool blocks = tl_table_copy(&aside->blocks.table, &aside->blocks, &m->blocks.table);
    bool bodies = tl_table_copy(&aside->bodies.table, &aside->bodies, &m->bodies.table);
    if (!blocks || !bodies) {
        tl_table_free(&aside->blocks.table);
        tl_table_free(&aside->bodies.table);
        return false;
    }
    aside->next_id = m->next_id;
    aside->structure = m->structure;
    aside->constraints = m->constraints;
    tl_drives_hold(m, true);
    return true;
}

static void take_back(tl_model *m, const tl_aside *aside)
{
    tl_table_free(&m->blocks.table);
    tl_table_free(&m->bodies.table);
    m->blocks = aside->blocks;
    m->bodies = aside->bodies;
    m->blocks.table.owner = &m->blocks;
    m->bodies.table.owner = &m->bodies;
    m->next_id = aside->next_id;
    m->extremes.known = false;
    tl_rows_refresh(m);
    m->structure = aside->structure;
    m->constraints = aside->constraints;
}

void tl_rows_settle(tl_model *m, tl_aside *aside, bool changed)
{
    if (changed) {
        tl_table_free(&aside->blocks.table);
        tl_table_free(&aside->bodies.table);
    } else {
        take_back(m, aside);
    }
    tl_drives_hold(m, false);
}

/* ---------------------------------------------------------------- what is seen ----------- */

tl_status tl_blocks_hide(tl_model *m, const tl_id *ids, size_t count, bool hidden)
{
    tl_status status = tl_blocks_check(m, ids, count);
    if (status != TL_OK)
        return status;
    for (size_t i = 0; i < count; i++)
        m->blocks.hidden[tl_block_row_quiet(m, ids[i])] = hidden;
    return TL_OK;
}

static void displacement_from_now(tl_model *m, uint32_t row)
{
    uint32_t body = m->blocks.body[row];
    m->blocks.base[row] = (tl_base){m->bodies.pose[body].u, m->bodies.q[body]};
}

tl_status tl_blocks_reset_displacement(tl_model *m, const tl_id *ids, size_t count)
{
    tl_status status = tl_blocks_check(m, ids, count);
    if (status != TL_OK)
        return status;
    if (count && !tl_blocks_hold_base(m))
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < count; i++)
        displacement_from_now(m, tl_block_row_quiet(m, ids[i]));
    return TL_OK;
}

tl_status tl_model_stage(tl_model *m, const char *name)
{
    tl_rows_tidy(m);
    if (strlen(name) > TL_STAGE_NAME || !tl_text_is_clean(name))
        return tl_fail(&m->error, TL_E_ARGUMENT, "stage: the name '%s' must be one line of UTF-8 of at most %d bytes",
                       tl_text_is_utf8(name) ? name : "...", TL_STAGE_NAME);
    const size_t rows = m->blocks.table.rows;
    if (rows && !tl_blocks_hold_base(m))
        return tl_fail_memory(&m->error);
    for (uint32_t row = 0; row < rows; row++)
        displacement_from_now(m, row);
    tl_text_print(m->stage, sizeof m->stage, "%s", name);
    return TL_OK;
}

/* ---------------------------------------------------------------- what is set ------------ */

static bool given(tl_vec3 v)
{
    return !(isnan(v.x) && isnan(v.y) && isnan(v.z));
}

static tl_status check_set(tl_model *m, const tl_id *ids, size_t count, const tl_block_set *set)
{
    if (!isnan(set->density) && !(set->density > 0 && isfinite(set->density)))
        return tl_fail(&m->error, TL_E_ARGUMENT, "set: density = %g kg/m3 must be > 0", set->density);
    for (size_t i = 0; i < count && !isnan(set->density); i++) {
        tl_status status = tl_check_measures(&m->error, m->blocks.shape[tl_block_row_quiet(m, ids[i])], set->density);
        if (status != TL_OK)
            return tl_error_prefix(&m->error, "set: density = %g kg/m3, block %u: ", set->density, ids[i]);
    }
    if (set->group && !tl_text_is_utf8(set->group))
        return tl_fail(&m->error, TL_E_ARGUMENT, "set: group = '%s' is not a text in UTF-8", set->group);
    const tl_vec3 none = {0, 0, 0};
    return tl_check_motion(&m->error, "set", given(set->velocity) ? set->velocity : none,
                           given(set->angular_velocity) ? set->angular_velocity : none);
}

/* Blocks of one body that are given a velocity: their mass, and its first moment about the body's centroid. */
typedef struct moved_parts {
    double mass;
    tl_vec3 moment;
} moved_parts;

/* Gives the bodies of the blocks their motion. What gets the velocity is the common centroid of those of its blocks
 * that are listed: of one block its own. `moved`: [bodies], zeros, or NULL when all bodies are of one block. */
static void set_motion(tl_model *m, const tl_id *ids, size_t count, const tl_block_set *set, moved_parts *moved)
{
    tl_bodies *b = &m->bodies;
    for (size_t i = 0; i < count; i++) {
        uint32_t row = tl_block_row_quiet(m, ids[i]), body = m->blocks.body[row];
        if (b->mesh[body]) {
            m->zone_verbs->move(m, body, set->velocity, set->angular_velocity);
            continue;
        }
        if (given(set->velocity) && moved) {
            double mass = m->blocks.density[row] * m->blocks.volume[row];
            tl_vec3 arm = tl_m3_mul(&b->pose[body].r, tl_block_local(m, row));
            moved[body].mass += mass;
            moved[body].moment = tl_v3_madd(moved[body].moment, mass, arm);
        }
        if (given(set->angular_velocity))
            b->w[body] = set->angular_velocity;
        if (given(set->velocity) || given(set->angular_velocity))
            tl_load_begins_anew(m, body);
    }
    for (size_t i = 0; i < count && given(set->velocity); i++) {
        uint32_t body = m->blocks.body[tl_block_row_quiet(m, ids[i])];
        if (b->mesh[body])
            continue;
        b->v[body] = set->velocity;
        if (moved && b->member_count[body] > 1)
            b->v[body] = tl_v3_sub(set->velocity,
                                   tl_v3_cross(b->w[body], tl_v3_scale(1 / moved[body].mass, moved[body].moment)));
    }
}

/* Gives the zones of blocks another solid; what else is set cannot fail then. Deformable blocks keep their density. */
static tl_status set_solid(tl_model *m, const tl_id *ids, size_t count, const tl_block_set *set)
{
    if (!isnan(set->density))
        return tl_fail(&m->error, TL_E_ARGUMENT, "set: give density before the blocks get zones, and solid after it");
    if (!m->zone_verbs)
        return tl_fail(&m->error, TL_E_ARGUMENT, "there is no solid '%.80s': name it with %s first", set->solid,
                       tl_words(m, "model:solid", "tl_model_solid"));
    return m->zone_verbs->resolid(m, ids, count, set->solid);
}

/* Begins the change by which blocks get a group. */
static tl_status list_change(tl_model *m, const tl_id *ids, size_t count, uint32_t group, tl_group_change *change)
{
    tl_rows_tidy(m);
    change->row = malloc((count + 1) * sizeof *change->row);
    change->group = malloc((count + 1) * sizeof *change->group);
    if (!change->row || !change->group)
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < count; i++) {
        change->row[i] = tl_block_row_quiet(m, ids[i]);
        change->group[i] = group;
    }
    change->count = count;
    return tl_group_change_begin(m, change);
}

tl_status tl_blocks_set(tl_model *m, const tl_id *ids, size_t count, const tl_block_set *values)
{
    tl_block_set read;
    const tl_block_set *set = &read;
    tl_status status = TL_OPTIONS_READ(tl_block_set, values, &read, &m->error);
    if (status == TL_OK)
        status = tl_model_may_set(m, "set properties of blocks");
    if (status == TL_OK && isnan(set->density))
        status = tl_blocks_check(m, ids, count);
    else if (status == TL_OK)
        status = tl_blocks_check_rigid(m, ids, count, "set density", "set it before it gets zones");
    if (status == TL_OK)
        status = check_set(m, ids, count, set);
    if (status != TL_OK)
        return status;
    uint32_t group = 0;
    if (set->group && (group = tl_group_intern(m, set->group)) == UINT32_MAX)
        return tl_fail_memory(&m->error);
    tl_group_change change = {.count = 0};
    if (set->group && (status = list_change(m, ids, count, group, &change)) != TL_OK) {
        tl_group_change_free(&change);
        return status;
    }
    tl_aside aside;
    bool joined = some_joined(m, ids, count), mends = !isnan(set->density) && joined;
    moved_parts *moved = joined ? calloc(m->bodies.table.rows, sizeof *moved) : NULL;
    if ((joined && !moved) || (mends && !tl_rows_set_aside(m, &aside))) {
        tl_group_change_free(&change);
        free(moved);
        return tl_fail_memory(&m->error);
    }
    if (set->solid && (status = set_solid(m, ids, count, set)) != TL_OK) {
        tl_group_change_free(&change);
        free(moved);
        return status;
    }
    tl_group_change_apply(m, &change);
    tl_group_change_free(&change);
    for (size_t i = 0; i < count; i++) {
        uint32_t row = tl_block_row_quiet(m, ids[i]), body = m->blocks.body[row];
        if (!isnan(set->density)) {
            m->blocks.density[row] = set->density;
            if (m->bodies.member_count[body] == 1)
                tl_body_measure(m, body);
        }
    }
    set_motion(m, ids, count, set, moved);
    free(moved);
    m->constraints++;
    if (!mends)
        return TL_OK;
    status = mend_bodies(m); /* a body of several blocks has another centroid now */
    tl_rows_settle(m, &aside, status == TL_OK);
    return status;
}
