/* follow.c - nodes follow their blocks through edits, and what a step needs of elements is made ready.
 *
 * A node of a block that was cut goes to the part that holds its point; on a face that parts share, to the one that it
 * lies deeper in. A node of a block that was deleted gets weight 0 and acts on nothing: its element is detached. */
#include "element/follow.h"

#include "base/columns.h"
#include "base/error.h"
#include "base/inside.h"
#include "element/batch.h"
#include "element/carry.h"
#include "element/memory.h"
#include "element/relay.h"
#include "element/set.h"
#include "element/steady.h"
#include "model/rows.h"
#include "plugin/loader.h"
#include "zone/zones.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- blocks ----------------- */

/* The row of the part of a block that was cut which holds a place where the block was made; TL_NO_ROW: there is no
 * part. */
static uint32_t part_with(const tl_model *m, tl_id block, tl_vec3 began)
{
    uint32_t best = TL_NO_ROW;
    double most = -INFINITY;
    for (size_t k = 0; k < m->cut_out_count; k++) {
        const uint32_t row = m->cut_out[k].whole == block ? tl_block_row_quiet(m, m->cut_out[k].block) : TL_NO_ROW;
        if (row == TL_NO_ROW)
            continue;
        const uint32_t body = m->blocks.body[row];
        const tl_base made = tl_block_made(m, row);
        const tl_mat3 turn = tl_q_matrix(made.turn);
        const tl_vec3 local = tl_m3_tmul(&turn, tl_v3_sub(tl_v3_sub(began, m->bodies.pose[body].x_ref), made.shift));
        const double depth = tl_block_depth(m, row, tl_body_point(&m->bodies, body, local));
        if (depth > most) {
            most = depth;
            best = row;
        }
    }
    return best;
}

/* The row of the block that a node is on now. */
static uint32_t row_of(tl_model *m, size_t row)
{
    tl_node_table *n = &m->elements->nodes;
    uint32_t block = tl_block_row_quiet(m, n->block[row]);
    if (block == TL_NO_ROW) {
        const tl_vec3 began = tl_v3_sub(tl_columns_get(n->rest, row), tl_node_from(n, row));
        block = part_with(m, n->block[row], began);
        if (block != TL_NO_ROW)
            n->block[row] = m->blocks.id[block];
    }
    return block;
}

static void lose(tl_model *m, size_t row)
{
    tl_node_table *n = &m->elements->nodes;
    n->block[row] = TL_GONE;
    n->body[row] = TL_NO_ROW;
    n->weight[row] = 0;
    for (int k = 0; k < 3; k++)
        n->force[k][row] = 0;
}

/* Whether a node lies in no zone though its block has some. */
static bool lacks_zone(const tl_model *m, size_t row)
{
    const tl_node_table *n = &m->elements->nodes;
    if (tl_node_first_point(m, row) == TL_NO_ROW)
        return false;
    const double *share = n->share[row];
    return share[0] == 0 && share[1] == 0 && share[2] == 0 && share[3] == 0;
}

/* false: its block has gone. */
static bool follow_node(tl_model *m, size_t row)
{
    struct tl_elements *e = m->elements;
    tl_node_table *n = &e->nodes;
    if (n->block[row] == TL_NO_ID || n->block[row] == TL_GONE)
        return true;
    const tl_id had = n->block[row];
    const uint32_t block = row_of(m, row);
    if (block == TL_NO_ROW) {
        lose(m, row);
        return false;
    }
    n->body[row] = m->blocks.body[block];
    if (n->block[row] != had || m->blocks.changed[block] > e->followed || lacks_zone(m, row))
        tl_node_reframe(m, row, block);
    return true;
}

tl_status tl_elements_follow(tl_model *m)
{
    struct tl_elements *e = m->elements;
    if (!e || (e->followed == m->structure && e->zones == (m->zones ? m->zones->version : 0)))
        return TL_OK;
    if ((tl_model_deforms(m) && !tl_nodes_hold_zones(&e->nodes)) ||
        ((tl_model_deforms(m) || m->blocks.made) && !tl_nodes_hold_base(&e->nodes)) ||
        (m->blocks.made && e->nodes.outward[0] && !tl_nodes_hold_normals(&e->nodes, true)))
        return tl_fail_memory(&m->error);
    tl_steady_let_go(m);
    const tl_element_table *t = &e->table;
    size_t detached = 0;
    tl_id first = TL_NO_ID;
    for (size_t row = 0; row < t->table.rows; row++) {
        bool whole = true;
        for (uint32_t k = 0; k < t->node_count[row]; k++)
            whole = follow_node(m, t->node_begin[row] + k) && whole;
        if (whole || t->flags[row] & TL_ELEMENT_DETACHED || tl_element_ops_of(&e->set[t->set[row]])->lays_again)
            continue;
        t->flags[row] |= TL_ELEMENT_DETACHED;
        first = detached++ ? first : t->id[row];
    }
    e->followed = m->structure;
    e->zones = m->zones ? m->zones->version : 0;
    e->version++;
    m->cut_out_count = 0;
    if (detached)
        tl_model_say(m,
                     "elements: %zu of them, the first with id %u, ha%s lost a block that was deleted: nodes there act "
                     "on nothing any more",
                     detached, first, detached == 1 ? "s" : "ve");
    return TL_OK;
}

/* ---------------------------------------------------------------- lists ------------------ */

/* Shares of threads: whole elements of one set, of at most TL_ELEMENT_NODES nodes together. */
static bool list_chunks(struct tl_elements *e)
{
    const tl_element_table *t = &e->table;
    e->chunk_count = 0;
    e->any_steady = false;
    e->all_steady = true;
    for (uint32_t row = 0; row < t->table.rows; row++) {
        tl_element_chunk *last = e->chunk_count ? &e->chunk[e->chunk_count - 1] : NULL;
        const uint32_t end = t->node_begin[row] + t->node_count[row];
        if (last && last->set == t->set[row] && end - last->node_begin <= TL_ELEMENT_NODES) {
            last->end = row + 1;
            last->node_end = end;
            continue;
        }
        if (!tl_grow(&e->chunk, &e->chunk_capacity, e->chunk_count + 1, sizeof *e->chunk))
            return false;
        const bool steady = e->carried_count == 0 && tl_element_ops_of(&e->set[t->set[row]])->steady;
        e->any_steady = e->any_steady || steady;
        e->all_steady = e->all_steady && steady;
        e->chunk[e->chunk_count++] =
            (tl_element_chunk){t->set[row], row, row + 1, t->node_begin[row], end, steady, 0, TL_NO_ROW};
    }
    return true;
}

static bool is_used(const tl_model *m, uint32_t row)
{
    return m->elements->nodes.body[row] != TL_NO_ROW && tl_node_first_point(m, row) == TL_NO_ROW;
}

/* Appends the nodes of chunks that are steady, or of those that are not, to the lists of their bodies. */
static void use_chunks(tl_model *m, bool steady)
{
    struct tl_elements *e = m->elements;
    for (size_t k = 0; k < e->chunk_count; k++)
        for (uint32_t row = e->chunk[k].node_begin; row < e->chunk[k].node_end && e->chunk[k].steady == steady; row++)
            if (is_used(m, row))
                e->use[e->use_start[e->nodes.body[row] + 1]++] = row;
}

/* The nodes in zones. */
static bool list_carried(tl_model *m)
{
    struct tl_elements *e = m->elements;
    e->carried_count = 0;
    for (uint32_t row = 0; row < e->nodes.table.rows && tl_model_deforms(m); row++) {
        if (tl_node_first_point(m, row) == TL_NO_ROW)
            continue;
        if (!tl_grow(&e->carried, &e->carried_capacity, e->carried_count + 1, sizeof *e->carried))
            return false;
        e->carried[e->carried_count++] = row;
    }
    return true;
}

/* The nodes in zones, shares of threads, and the nodes of each rigid body. */
static bool list_nodes(tl_model *m)
{
    struct tl_elements *e = m->elements;
    const tl_node_table *n = &e->nodes;
    const size_t bodies = m->bodies.table.rows, nodes = n->table.rows;
    if (!tl_fit(&e->use, &e->use_capacity, nodes, sizeof *e->use) ||
        !tl_fit(&e->steady_start, &e->steady_start_capacity, bodies + 1, sizeof *e->steady_start) ||
        !tl_fit(&e->use_start, &e->use_start_capacity, bodies + 2, sizeof *e->use_start))
        return false;
    memset(e->use_start, 0, (bodies + 2) * sizeof *e->use_start);
    if (!list_carried(m))
        return false;
    for (uint32_t row = 0; row < nodes; row++)
        if (is_used(m, row))
            e->use_start[n->body[row] + 2]++;
    if (!list_chunks(e))
        return false;
    for (size_t body = 0; body < bodies; body++)
        e->use_start[body + 2] += e->use_start[body + 1];
    use_chunks(m, false);
    memcpy(e->steady_start, e->use_start + 1, bodies * sizeof *e->steady_start);
    use_chunks(m, true);
    return true;
}

/* ---------------------------------------------------------------- stiffness -------------- */

/* Asks the kind of a chunk for the stiffnesses of its nodes, and for their damping. */
static tl_status rate_chunk(tl_model *m, const tl_element_chunk *of, double *damping)
{
    struct tl_elements *e = m->elements;
    const tl_element_set *set = &e->set[of->set];
    tl_node_table *n = &e->nodes;
    tl_element_lanes lanes;
    const tl_element_batch batch = tl_element_batch_of(m, of, &lanes);
    tl_element_lanes_stop(&lanes, of->node_end - of->node_begin);
    memset(n->k + of->node_begin, 0, (of->node_end - of->node_begin) * sizeof *n->k);
    tl_enter(set->kind, "stiffness");
    tl_element_ops_of(set)->stiffness(set->self, &batch, n->k + of->node_begin, damping + of->node_begin);
    tl_leave();
    for (uint32_t row = of->node_begin; row < of->node_end; row++)
        if (!(n->k[row] >= 0 && isfinite(n->k[row]) && damping[row] >= 0 && isfinite(damping[row])))
            return tl_fail(
                &m->error, TL_E_PLUGIN,
                "element '%s' of plugin '%s': its stiffness() gives %g N/m and %g N s/m; both must be finite "
                "and at least 0",
                set->kind->name, tl_plugin_id(set->kind), n->k[row], damping[row]);
    return TL_OK;
}

/* Keeps how nodes are damped, where some are. false: out of memory. */
static bool keep_damping(tl_node_table *n, const double *damping)
{
    bool any = n->c != NULL;
    for (size_t row = 0; row < n->table.rows && !any; row++)
        any = damping[row] > 0;
    if (any && !tl_nodes_hold_damping(n))
        return false;
    if (any)
        memcpy(n->c, damping, n->table.rows * sizeof *n->c);
    return true;
}

static tl_status rate_all(tl_model *m)
{
    struct tl_elements *e = m->elements;
    double *damping = calloc(e->nodes.table.rows + 1, sizeof *damping);
    tl_status status = damping ? TL_OK : tl_fail_memory(&m->error);
    for (size_t k = 0; k < e->chunk_count && status == TL_OK; k++)
        status = rate_chunk(m, &e->chunk[k], damping);
    if (status == TL_OK && !keep_damping(&e->nodes, damping))
        status = tl_fail_memory(&m->error);
    free(damping);
    return status;
}

static void note_most(struct tl_elements *e)
{
    e->most_k = e->most_c = 0;
    for (size_t row = 0; row < e->nodes.table.rows; row++) {
        e->most_k = fmax(e->most_k, e->nodes.k[row]);
        e->most_c = fmax(e->most_c, tl_node_damping(&e->nodes, row));
    }
}

tl_status tl_elements_ready(tl_model *m)
{
    struct tl_elements *e = m->elements;
    if (!e)
        return TL_OK;
    tl_rows_tidy(m); /* lists below hold rows of bodies */
    tl_status status = tl_elements_follow(m);
    if (status == TL_OK)
        status = tl_elements_lay_again(m);
    if (status != TL_OK)
        return status;
    const bool anew = e->listed != e->version;
    if (anew) {
        if (!list_nodes(m) || !tl_steady_fit(m))
            return tl_fail_memory(&m->error);
        e->listed = e->version;
        e->remembered = 0;
    }
    if (e->remembered != e->version) {
        if (!tl_elements_remember(m))
            return tl_fail_memory(&m->error);
        e->remembered = e->version;
    }
    if (e->rated != e->version)
        status = rate_all(m);
    if (status == TL_OK)
        e->rated = e->version;
    if (anew && status == TL_OK)
        note_most(e);
    return status;
}
