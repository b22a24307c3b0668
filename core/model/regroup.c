/* regroup.c - which blocks move as one: bodies made from parts and parted again.
 *
 * A new body has the mass, momentum and angular momentum of its parts; relative motion of the parts is
 * lost, as in a perfectly plastic meeting. Its frame has the attitude of its lowest block's old body, so
 * parting and joining without motion changes nothing but the last digits. */
#include "model/model.h"

#include <stdlib.h>
#include <string.h>

/* Relative difference of mass from which a body has lost a block: far above rounding, far below any block
 * that tolerances let exist. */
#define WHOLE 1e-12

/* R I R^T */
static tl_sym3 turned(tl_sym3 t, const tl_mat3 *r)
{
    tl_vec3 row[3];
    for (int i = 0; i < 3; i++)
        row[i] = tl_s3_mul(t, tl_v3(r->m[i][0], r->m[i][1], r->m[i][2]));
    tl_vec3 x = {r->m[0][0], r->m[0][1], r->m[0][2]};
    tl_vec3 y = {r->m[1][0], r->m[1][1], r->m[1][2]};
    tl_vec3 z = {r->m[2][0], r->m[2][1], r->m[2][2]};
    return (tl_sym3){tl_v3_dot(x, row[0]), tl_v3_dot(y, row[1]), tl_v3_dot(z, row[2]),
                     tl_v3_dot(x, row[1]), tl_v3_dot(y, row[2]), tl_v3_dot(z, row[0])};
}

tl_sym3 tl_block_inertia(const tl_model *m, uint32_t row)
{
    tl_sym3 t =
        turned(tl_poly_mass(m->blocks.shape[row]).inertia, &m->bodies.pose[m->blocks.body[row]].r);
    double d = m->blocks.density[row];
    return (tl_sym3){d * t.xx, d * t.yy, d * t.zz, d * t.xy, d * t.yz, d * t.zx};
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

/* A block's centroid, relative to the model's origin. */
static tl_vec3 part_place(const tl_model *m, uint32_t row)
{
    uint32_t body = m->blocks.body[row];
    return tl_v3_add(tl_body_place(&m->bodies, body),
                     tl_m3_mul(&m->bodies.pose[body].r, tl_block_local(m, row)));
}

static parts sum_parts(const tl_model *m, const uint32_t *rows, size_t count)
{
    const tl_blocks *b = &m->blocks;
    parts sum = {.leader = b->body[rows[0]]};
    tl_vec3 zero = part_place(m, rows[0]), offset = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        double mass = b->density[rows[i]] * b->volume[rows[i]];
        sum.mass += mass;
        offset = tl_v3_madd(offset, mass, tl_v3_sub(part_place(m, rows[i]), zero));
        sum.momentum = tl_v3_madd(sum.momentum, mass, tl_block_velocity(m, rows[i]));
        sum.fixed |= m->bodies.fixed[b->body[rows[i]]];
    }
    sum.place = tl_v3_madd(zero, 1 / sum.mass, offset);
    for (size_t i = 0; i < count; i++) {
        double mass = b->density[rows[i]] * b->volume[rows[i]];
        tl_vec3 arm = tl_v3_sub(part_place(m, rows[i]), sum.place);
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
    tl_vec3 shift =
        tl_m3_tmul(&b->pose[sum->leader].r, tl_v3_sub(tl_body_place(b, old), sum->place));
    tl_mat3 turn;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const tl_mat3 *to = &b->pose[sum->leader].r, *from = &b->pose[old].r;
            turn.m[i][j] = to->m[0][i] * from->m[0][j] + to->m[1][i] * from->m[1][j] +
                           to->m[2][i] * from->m[2][j];
        }
    return tl_poly_transformed(m->blocks.shape[row], old == sum->leader ? NULL : &turn, shift,
                               shape, &m->error);
}

/* Marks the seams of a new body on the new shapes of its parts. */
static tl_status mark_seams(tl_model *m, const uint32_t *rows, size_t count, tl_poly **shapes)
{
    tl_poly **polys = malloc(count * sizeof *polys);
    if (!polys)
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < count; i++)
        polys[i] = shapes[rows[i]];
    tl_status status = tl_poly_mark_seams(polys, count, &m->error);
    free(polys);
    return status;
}

/* The inverse of a body's inertia applied to its angular momentum. */
static tl_vec3 spin_velocity(const tl_bodies *b, uint32_t body, tl_vec3 spin)
{
    tl_quat attitude = tl_q_mul(b->q[body], b->axes[body]);
    tl_vec3 l = tl_q_rotate(tl_q_conj(attitude), spin), i = b->moments[body];
    return tl_q_rotate(attitude, tl_v3(l.x / i.x, l.y / i.y, l.z / i.z));
}

typedef struct regroup {
    tl_poly **shapes;   /* [blocks] new shapes, NULL where nothing changes */
    parts *parts;       /* [groups] */
    uint32_t *rows;     /* [blocks] block rows, group by group */
    uint32_t *start;    /* [groups + 1] into rows */
    uint32_t *group_of; /* [blocks] number of the group whose lowest block this is */
    size_t groups;
    tl_vec3 *displacement; /* [blocks] */
} regroup;

static void regroup_free(regroup *r, size_t blocks)
{
    for (size_t i = 0; r->shapes && i < blocks; i++)
        tl_poly_free(r->shapes[i]);
    free(r->shapes);
    free(r->parts);
    free(r->rows);
    free(r->start);
    free(r->group_of);
    free(r->displacement);
}

/* Lists the groups in the order of their lowest blocks. */
static bool list_groups(const tl_model *m, const uint32_t *group, regroup *r)
{
    size_t blocks = m->blocks.table.rows;
    *r = (regroup){.shapes = calloc(blocks + 1, sizeof *r->shapes),
                   .parts = calloc(blocks + 1, sizeof *r->parts),
                   .rows = calloc(blocks + 1, sizeof *r->rows),
                   .start = calloc(blocks + 2, sizeof *r->start),
                   .group_of = calloc(blocks + 1, sizeof *r->group_of),
                   .displacement = calloc(blocks + 1, sizeof *r->displacement)};
    if (!r->shapes || !r->parts || !r->rows || !r->start || !r->group_of || !r->displacement)
        return false;
    for (uint32_t row = 0; row < blocks; row++)
        if (group[row] == row)
            r->group_of[row] = (uint32_t)r->groups++;
    for (uint32_t row = 0; row < blocks; row++)
        r->start[r->group_of[group[row]] + 1]++;
    for (size_t g = 0; g < r->groups; g++)
        r->start[g + 1] += r->start[g];
    uint32_t *fill = malloc((r->groups + 1) * sizeof *fill);
    if (!fill)
        return false;
    memcpy(fill, r->start, r->groups * sizeof *fill);
    for (uint32_t row = 0; row < blocks; row++)
        r->rows[fill[r->group_of[group[row]]]++] = row;
    free(fill);
    return true;
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

/* True when the group is a body already. */
static bool stays(const tl_model *m, const regroup *r, size_t g)
{
    uint32_t count = r->start[g + 1] - r->start[g], body = m->blocks.body[r->rows[r->start[g]]];
    if (m->bodies.member_count[body] != count || !is_whole(m, body))
        return false;
    for (uint32_t k = r->start[g]; k < r->start[g + 1]; k++)
        if (m->blocks.body[r->rows[k]] != body)
            return false;
    return true;
}

/* Writes the row of a new body over that of its leader. */
static void write_body(tl_model *m, const parts *sum, uint32_t body)
{
    tl_bodies *b = &m->bodies;
    b->pose[body].x_ref = sum->place;
    b->pose[body].u = tl_v3(0, 0, 0);
    b->fixed[body] = (uint8_t)sum->fixed;
    tl_vec3 v = tl_v3_scale(1 / sum->mass, sum->momentum);
    b->v[body] = tl_v3(sum->fixed & TL_FIX_X ? 0 : v.x, sum->fixed & TL_FIX_Y ? 0 : v.y,
                       sum->fixed & TL_FIX_Z ? 0 : v.z);
    if (b->force_before)
        b->force_before[body] = b->moment_before[body] = tl_v3(0, 0, 0);
    if (b->load)
        b->load[body] = (tl_body_load){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
}

/* Room for bodies, and for what only blocks of joined bodies have. */
static bool make_room(tl_model *m, size_t bodies)
{
    tl_blocks *blocks = &m->blocks;
    return tl_table_reserve(&m->bodies.table, bodies) &&
           TL_COLUMN_NEED(&blocks->table, blocks, local, 0) &&
           TL_COLUMN_NEED(&blocks->table, blocks, base, 0);
}

tl_status tl_bodies_regroup(tl_model *m, const uint32_t *group)
{
    tl_blocks *blocks = &m->blocks;
    tl_bodies *bodies = &m->bodies;
    size_t count = blocks->table.rows;
    regroup r;
    bool room = list_groups(m, group, &r) && make_room(m, 2 * count + 1);
    tl_status status = room ? TL_OK : tl_fail_memory(&m->error);
    for (size_t g = 0; g < r.groups && status == TL_OK; g++) {
        if (stays(m, &r, g))
            continue;
        r.parts[g] = sum_parts(m, &r.rows[r.start[g]], r.start[g + 1] - r.start[g]);
        for (uint32_t k = r.start[g]; k < r.start[g + 1] && status == TL_OK; k++)
            status = new_shape(m, &r.parts[g], r.rows[k], &r.shapes[r.rows[k]]);
        if (status == TL_OK)
            status = mark_seams(m, &r.rows[r.start[g]], r.start[g + 1] - r.start[g], r.shapes);
    }
    if (status != TL_OK) {
        regroup_free(&r, count);
        return status;
    }
    /* From here on nothing can fail. New bodies go behind the old rows, group by group, then the old
     * rows go: rows are in order of the groups' lowest blocks. */
    size_t old = bodies->table.rows;
    for (uint32_t row = 0; row < count; row++)
        r.displacement[row] = tl_block_displacement(m, row);
    tl_table_resize(&bodies->table, old + r.groups);
    for (size_t g = 0; g < r.groups; g++) {
        uint32_t body = (uint32_t)(old + g);
        tl_table_move(&bodies->table, body, blocks->body[r.rows[r.start[g]]]);
        if (r.parts[g].mass > 0)
            write_body(m, &r.parts[g], body);
    }
    for (size_t g = 0; g < r.groups; g++)
        for (uint32_t k = r.start[g]; k < r.start[g + 1]; k++)
            blocks->body[r.rows[k]] = (uint32_t)g;
    for (size_t g = 0; g < r.groups; g++) {
        tl_table_move(&bodies->table, g, old + g);
        bodies->id[g] = blocks->id[r.rows[r.start[g]]];
    }
    bodies->table.rows = r.groups;
    for (uint32_t row = 0; row < count; row++) {
        if (!r.shapes[row])
            continue;
        tl_poly_free(blocks->shape[row]);
        blocks->shape[row] = r.shapes[row];
        r.shapes[row] = NULL;
        blocks->local[row] = tl_poly_mass(blocks->shape[row]).centroid;
    }
    tl_rows_refresh(m);
    for (uint32_t g = 0; g < r.groups; g++) {
        if (!(r.parts[g].mass > 0))
            continue;
        tl_body_measure(m, g);
        bodies->w[g] = r.parts[g].fixed & TL_FIX_ROTATION
                           ? tl_v3(0, 0, 0)
                           : spin_velocity(bodies, g, r.parts[g].spin);
        bodies->pose[g].v_moved = bodies->v[g];
        bodies->pose[g].w_moved = bodies->w[g];
        for (uint32_t k = r.start[g]; k < r.start[g + 1]; k++) {
            uint32_t row = r.rows[k];
            if (r.start[g + 1] - r.start[g] == 1)
                blocks->local[row] = tl_v3(0, 0, 0);
            blocks->base[row] = tl_v3(0, 0, 0);
            blocks->base[row] = tl_v3_sub(tl_block_displacement(m, row), r.displacement[row]);
        }
    }
    tl_drives_recount(m);
    m->constraints++;
    regroup_free(&r, count);
    return TL_OK;
}

tl_status tl_bodies_fall_apart(tl_model *m, const unsigned char *keep, uint32_t *group)
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
            if (keep[row]) {
                polys[count] = m->blocks.shape[row];
                rows[count++] = row;
            } else {
                group[row] = row;
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

tl_status tl_bodies_mend(tl_model *m)
{
    bool whole = true;
    for (uint32_t body = 0; body < m->bodies.table.rows && whole; body++)
        whole = is_whole(m, body);
    if (whole)
        return TL_OK;
    size_t blocks = m->blocks.table.rows;
    unsigned char *keep = malloc(blocks + 1);
    uint32_t *group = malloc((blocks + 1) * sizeof *group);
    tl_status status = keep && group ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK) {
        memset(keep, 1, blocks);
        tl_bodies_groups(m, group);
        status = tl_bodies_fall_apart(m, keep, group);
    }
    if (status == TL_OK)
        status = tl_bodies_regroup(m, group);
    free(keep);
    free(group);
    return status;
}

/* ---------------------------------------------------------------- verbs ------------------ */

/* Refuses bodies that are driven or loaded: what would become of that is the user's to say. */
static tl_status check_parts(tl_model *m, const tl_id *ids, size_t count, const char *verb)
{
    tl_status status = tl_model_may_change(m, verb);
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        uint32_t row = tl_block_row(m, ids[i]);
        if (row == TL_NO_ROW)
            return m->error.status;
        uint32_t body = m->blocks.body[row];
        bool loaded = tl_body_loaded(&m->bodies, body);
        if (m->bodies.drive[body] || loaded)
            status =
                tl_fail(&m->error, TL_E_STATE,
                        "cannot %s: block %u is %s; take that off first and set it again after",
                        verb, ids[i], loaded ? "loaded" : "driven");
    }
    return status;
}

/* Regroups with group[] changed by `change`, which is told the rows of the blocks given. */
static tl_status regroup_by(tl_model *m, const tl_id *ids, size_t count,
                            void (*change)(const tl_model *, const unsigned char *, uint32_t *))
{
    size_t blocks = m->blocks.table.rows;
    uint32_t *group = malloc((blocks + 1) * sizeof *group);
    unsigned char *chosen = calloc(blocks + 1, 1);
    tl_status status = group && chosen ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK) {
        tl_bodies_groups(m, group);
        for (size_t i = 0; i < count; i++)
            chosen[m->row_of[ids[i]]] = 1;
        change(m, chosen, group);
        status = tl_bodies_regroup(m, group);
    }
    free(group);
    free(chosen);
    return status;
}

/* Every body with a block chosen comes along whole. */
static void join_groups(const tl_model *m, const unsigned char *chosen, uint32_t *group)
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
}

/* Chosen blocks go alone; what is left of a body is named by its lowest remaining block. */
static void part_groups(const tl_model *m, const unsigned char *chosen, uint32_t *group)
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
}

tl_status tl_blocks_join(tl_model *m, const tl_id *ids, size_t count)
{
    tl_status status = check_parts(m, ids, count, "join blocks");
    return status == TL_OK && count > 1 ? regroup_by(m, ids, count, join_groups) : status;
}

tl_status tl_blocks_unjoin(tl_model *m, const tl_id *ids, size_t count)
{
    tl_status status = check_parts(m, ids, count, "unjoin blocks");
    return status == TL_OK && count > 0 ? regroup_by(m, ids, count, part_groups) : status;
}
