/* act.c - elements act on their nodes.
 *
 * A thread takes whole elements of one set at a time. A rigid body adds its nodes in the order of (element, node), so
 * sums do not depend on threads. The force f of a node at the arm R p adds the moment R p x f. */
#include "element/act.h"

#include "base/columns.h"
#include "base/inside.h"
#include "element/batch.h"
#include "element/carry.h"
#include "element/steady.h"
#include "element/together.h"
#include "plugin/loader.h"
#include "zone/zones.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <talus/kit.h>

/* ---------------------------------------------------------------- forces ----------------- */

typedef struct apply_job {
    tl_model *m;
    tl_failure *failure;
} apply_job;

/* Where one rigid body has nodes [row, row + count) of its frame, less where it was made: of node `row` in lane i. */
TL_IN_LOOP void carry_run(const tl_node_table *n, const tl_pose *pose, size_t row, uint32_t count,
                          tl_element_lanes *lanes, size_t i)
{
    const double *restrict px = n->local[0] + row, *restrict py = n->local[1] + row, *restrict pz = n->local[2] + row;
    double *restrict x = lanes->du[0] + i, *restrict y = lanes->du[1] + i, *restrict z = lanes->du[2] + i;
    const tl_mat3 r = pose->r;
    const tl_vec3 u = pose->u;
    for (uint32_t l = 0; l < count; l++) {
        const tl_vec3 at = tl_v3_add(u, tl_m3_mul(&r, tl_v3(px[l], py[l], pz[l])));
        x[l] = at.x;
        y[l] = at.y;
        z[l] = at.z;
    }
}

/* The motion of nodes from where carry_run has them. `per`: 1/s. */
TL_IN_LOOP void move_carried(tl_node_table *n, size_t row, uint32_t count, double per, tl_element_lanes *lanes,
                             size_t i)
{
    for (int k = 0; k < 3; k++) {
        const double *restrict base = tl_node_bases(n)[k] + row;
        double *restrict before = n->u[k] + row, *restrict du = lanes->du[k] + i, *restrict v = lanes->v[k] + i;
#pragma omp simd
        for (uint32_t l = 0; l < count; l++) {
            const double now = du[l] - base[l], moved = now - before[l];
            before[l] = now;
            du[l] = moved;
            v[l] = per * moved;
        }
    }
}

/* Their normals likewise. */
TL_IN_LOOP void turn_run(const tl_node_table *n, const tl_mat3 *r, size_t row, uint32_t count, tl_element_lanes *lanes,
                         size_t i)
{
    double *const *own = tl_node_normals(n);
    const double *restrict ox = own[0] + row, *restrict oy = own[1] + row, *restrict oz = own[2] + row;
    for (int k = 0; k < 3; k++) {
        const double x = r->m[k][0], y = r->m[k][1], z = r->m[k][2];
        double *restrict normal = lanes->normal[k] + i;
#pragma omp simd
        for (uint32_t l = 0; l < count; l++) {
            const double turned = x * ox[l] + y * oy[l] + z * oz[l];
            const double none = ox[l] * ox[l] + oy[l] * oy[l] + oz[l] * oz[l];
            normal[l] = none == 0 ? 0 : turned;
        }
    }
}

/* Of a node on the ground or in a zone. */
static void move_other(tl_model *m, uint32_t row, double per, tl_element_lanes *lanes, size_t i)
{
    const tl_vec3 before = tl_columns_get(m->elements->nodes.u, row);
    const tl_vec3 u = tl_node_moved(m, row), du = tl_v3_sub(u, before);
    double *const to[3] = {lanes->du[0] + i, lanes->du[1] + i, lanes->du[2] + i};
    double *const v[3] = {lanes->v[0] + i, lanes->v[1] + i, lanes->v[2] + i};
    double *const normal[3] = {lanes->normal[0] + i, lanes->normal[1] + i, lanes->normal[2] + i};
    tl_columns_put(to, 0, du);
    tl_columns_put(v, 0, tl_v3_scale(per, du));
    tl_columns_put(normal, 0, tl_node_normal(m, row));
    tl_columns_put(m->elements->nodes.u, row, u);
}

/* Where the nodes of a chunk have gone since the last step: those on one body that follow each other at a time. */
TL_VECTORIZED static void move_nodes(tl_model *m, const tl_element_chunk *of, tl_element_lanes *lanes)
{
    tl_node_table *n = &m->elements->nodes;
    const double per = m->dt > 0 && !m->relaxing ? 1 / m->dt : 0;
    for (int k = 0; k < 3 && !n->outward[0]; k++)
        memset(lanes->normal[k], 0, (of->node_end - of->node_begin) * sizeof(double));
    uint32_t first = of->node_begin; /* of those on rigid bodies that follow each other */
    for (uint32_t row = first, end; row < of->node_end; row = end) {
        const uint32_t body = n->body[row], i = row - of->node_begin;
        for (end = row + 1; end < of->node_end && n->body[end] == body;)
            end++;
        if (body != TL_NO_ROW && !m->bodies.mesh[body]) {
            carry_run(n, &m->bodies.pose[body], row, end - row, lanes, i);
            if (n->outward[0])
                turn_run(n, &m->bodies.pose[body].r, row, end - row, lanes, i);
            continue;
        }
        move_carried(n, first, row - first, per, lanes, first - of->node_begin);
        for (uint32_t k = row; k < end; k++)
            move_other(m, k, per, lanes, k - of->node_begin);
        first = end;
    }
    move_carried(n, first, of->node_end - first, per, lanes, first - of->node_begin);
}

/* Whether no number of a chunk is odd: sums of zeros, which are found fast. */
TL_VECTORIZED static bool is_sound(const struct tl_elements *e, const tl_element_chunk *of)
{
    double sum[TL_LANES] = {0};
    for (int k = 0; k < 3; k++) {
        const double *restrict force = e->nodes.force[k];
        uint32_t row = of->node_begin;
        for (; row + TL_LANES <= of->node_end; row += TL_LANES)
            for (uint32_t l = 0; l < TL_LANES; l++)
                sum[l] += 0 * force[row + l];
        for (; row < of->node_end; row++)
            sum[0] += 0 * force[row];
    }
    for (uint32_t row = of->begin; row < of->end; row++)
        sum[0] += 0 * (e->table.stored[row] + e->table.lost[row] + e->table.given[row]);
    double all = 0;
    for (uint32_t l = 0; l < TL_LANES; l++)
        all += sum[l];
    return all == 0;
}

/* The first element of a chunk whose forces or energies are not finite; `end`: there is none. */
static uint32_t find_odd(const struct tl_elements *e, const tl_element_chunk *of)
{
    const tl_element_table *t = &e->table;
    for (uint32_t row = is_sound(e, of) ? of->end : of->begin; row < of->end; row++) {
        double sum = t->stored[row] + t->lost[row] + t->given[row];
        for (uint32_t k = t->node_begin[row]; k < t->node_begin[row] + t->node_count[row]; k++)
            sum += 0 * (e->nodes.force[0][k] + e->nodes.force[1][k] + e->nodes.force[2][k]);
        if (!isfinite(sum))
            return row;
    }
    return of->end;
}

/* Counts what was whole and is broken now. */
static void count_broken(tl_element_chunk *of, const uint32_t *before, const uint32_t *now)
{
    of->broke = 0;
    for (uint32_t i = of->end - of->begin; i-- > 0;)
        if (~before[i] & now[i] & (uint32_t)TL_ELEMENT_BROKEN) {
            of->broke++;
            of->first_broke = of->begin + i;
        }
}

static void apply_chunk(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)end, (void)thread;
    const apply_job *job = user;
    struct tl_elements *e = job->m->elements;
    tl_element_chunk *of = &e->chunk[begin];
    const tl_element_set *set = &e->set[of->set];
    of->broke = 0;
    if (of->steady && e->resting) {
        memset(e->table.given + of->begin, 0, (of->end - of->begin) * sizeof *e->table.given);
        return;
    }
    tl_report report = {.size = sizeof report};
    tl_element_lanes lanes;
    const tl_element_batch batch = tl_element_batch_of(job->m, of, &lanes);
    move_nodes(job->m, of, &lanes);
    memset(batch.lost, 0, batch.count * sizeof *batch.lost);
    memset(batch.given, 0, batch.count * sizeof *batch.given);
    memcpy(lanes.flags, batch.flags, batch.count * sizeof *batch.flags);
    tl_enter(set->kind, "update");
    tl_status status = tl_element_ops_of(set)->update(set->self, &batch, &report);
    tl_leave();
    count_broken(of, lanes.flags, batch.flags);
    const char *text =
        status == TL_OK ? "it gives a force or an energy that is not finite" : tl_report_text(&report, status);
    uint32_t row = of->begin + (report.first_bad < batch.count ? (uint32_t)report.first_bad : 0);
    if (status == TL_OK) {
        row = find_odd(e, of);
        status = row < of->end ? TL_E_NUMERIC : TL_OK;
    }
    if (status != TL_OK)
        tl_failure_note(job->failure, chunk, status, row, text);
}

/* Asks all kinds, but for steady ones that rest. */
static tl_status ask_all(tl_model *m, tl_failure *failure)
{
    struct tl_elements *e = m->elements;
    apply_job job = {m, failure};
    tl_parallel_for(m->pool, e->chunk_count, 1, apply_chunk, &job);
    const tl_status status = failure->error.status;
    failure->error.status = TL_OK;
    if (status == TL_OK)
        return TL_OK;
    const uint32_t row = (uint32_t)failure->point;
    const tl_kind *kind = e->set[e->table.set[row]].kind;
    return tl_fail(&m->error, status, "cycle %lld, element %u, '%s' of plugin '%s': %s", (long long)m->cycles + 1,
                   e->table.id[row], kind->name, tl_plugin_id(kind), failure->error.text);
}

/* Says which elements have broken in this step: a line for those of a kind and group that follow each other. */
static void say_broken(tl_model *m)
{
    const struct tl_elements *e = m->elements;
    for (size_t k = 0; k < e->chunk_count;) {
        const tl_element_set *set = &e->set[e->chunk[k].set], *other = set;
        uint32_t broke = 0, first = 0;
        while (other->kind == set->kind && other->group == set->group) {
            if (broke == 0)
                first = e->chunk[k].first_broke;
            broke += e->chunk[k].broke;
            if (++k == e->chunk_count)
                break;
            other = &e->set[e->chunk[k].set];
        }
        if (broke == 0)
            continue;
        const char *group = m->groups[set->group];
        tl_model_say(m, "cycle %lld: %u element%s '%s'%s%s%s ha%s broken, %s %u", (long long)m->cycles + 1, broke,
                     broke == 1 ? "" : "s", set->kind->name, *group ? " of group '" : "", group, *group ? "'" : "",
                     broke == 1 ? "s" : "ve", broke == 1 ? "id" : "the first with id", e->table.id[first]);
    }
}

tl_status tl_elements_apply(tl_model *m, tl_failure *failure)
{
    struct tl_elements *e = m->elements;
    const bool due = tl_elements_together_due(m);
    e->resting = e->any_steady && !due && tl_steady_keeps(m);
    if (e->any_steady && !e->resting)
        tl_steady_bring(m);
    if (!e->resting || !e->all_steady)
        e->asked++;
    tl_status status = due ? tl_elements_together(m, 0, true) : TL_OK;
    if (status == TL_OK)
        status = ask_all(m, failure);
    if (e->any_steady && !e->resting && status == TL_OK)
        tl_steady_take(m);
    if (status == TL_OK)
        say_broken(m);
    return status;
}

/* The tables as they were; empty, when out of memory. */
typedef struct kept {
    tl_element_table table;
    tl_node_table nodes;
} kept;

tl_status tl_elements_sum(tl_model *m, tl_vec3 *force)
{
    struct tl_elements *e = m->elements;
    tl_failure failure = {.error = {.status = TL_OK}};
    const bool rested = e->resting;
    e->resting = false;
    kept had = {.table = e->table, .nodes = e->nodes};
    const bool enough = tl_table_copy(&had.table.table, &had.table, &e->table.table) &&
                        tl_table_copy(&had.nodes.table, &had.nodes, &e->nodes.table);
    tl_status status = enough ? TL_OK : tl_fail_memory(&m->error);
    pthread_mutex_init(&failure.lock, NULL);
    if (status == TL_OK)
        status = ask_all(m, &failure);
    e->resting = rested;
    pthread_mutex_destroy(&failure.lock);
    for (size_t row = 0; status == TL_OK && row < e->nodes.table.rows; row++)
        if (e->nodes.body[row] != TL_NO_ROW)
            force[e->nodes.body[row]] = tl_v3_add(force[e->nodes.body[row]], tl_columns_get(e->nodes.force, row));
    for (size_t k = 0; enough && k < e->table.table.column_count; k++)
        memcpy(tl_table_data(&e->table.table, k), tl_table_data(&had.table.table, k),
               e->table.table.rows * e->table.table.columns[k].size);
    for (size_t k = 0; enough && k < e->nodes.table.column_count; k++)
        memcpy(tl_table_data(&e->nodes.table, k), tl_table_data(&had.nodes.table, k),
               e->nodes.table.rows * e->nodes.table.columns[k].size);
    tl_table_free(&had.table.table);
    tl_table_free(&had.nodes.table);
    return status;
}

static void gather_body(const tl_model *m, uint32_t body, tl_acting *on)
{
    const struct tl_elements *e = m->elements;
    const uint32_t first = e->use_start[body];
    if (first == e->use_start[body + 1])
        return;
    const tl_mat3 r = m->bodies.pose[body].r;
    const uint32_t end = tl_steady_add(m, body, on) ? e->steady_start[body] : e->use_start[body + 1];
    tl_vec3 force = on->force, moment = on->moment;
    double magnitude = on->magnitude;
    for (uint32_t k = first; k < end; k++) {
        const uint32_t row = e->use[k];
        const tl_vec3 f = tl_columns_get(e->nodes.force, row);
        force = tl_v3_add(force, f);
        moment = tl_v3_add(moment, tl_v3_cross(tl_m3_mul(&r, tl_columns_get(e->nodes.local, row)), f));
        magnitude += tl_v3_norm(f);
    }
    on->force = force;
    on->moment = moment;
    on->magnitude = magnitude;
}

void tl_elements_gather(const tl_model *m, uint32_t begin, uint32_t end, tl_acting *on)
{
    for (uint32_t body = begin; tl_elements_are_listed(m) && body < end; body++)
        gather_body(m, body, &on[body - begin]);
}

void tl_elements_push(tl_model *m)
{
    const struct tl_elements *e = m->elements;
    tl_gridpoints *p = &m->zones->points;
    for (size_t i = 0; e && i < e->carried_count; i++) {
        const uint32_t row = e->carried[i], first = tl_node_first_point(m, row);
        const tl_vec3 f = tl_columns_get(e->nodes.force, row);
        for (int a = 0; a < 4; a++) {
            const uint32_t point = first + e->nodes.point[row][a];
            const tl_vec3 part = tl_v3_scale(e->nodes.share[row][a], f);
            tl_columns_put(p->force, point, tl_v3_add(tl_columns_get(p->force, point), part));
            p->bears[point] += tl_v3_norm(part);
            p->touched[point] += tl_v3_norm(part);
        }
    }
}

/* ---------------------------------------------------------------- stiffness -------------- */

/* What holds two gridpoints to each other is twice as stiff for them as for one that it holds to the ground. */
void tl_elements_stiffen(tl_model *m, double *damping)
{
    const struct tl_elements *e = m->elements;
    for (size_t i = 0; e && i < e->carried_count; i++) {
        const uint32_t row = e->carried[i], first = tl_node_first_point(m, row);
        const double *share = e->nodes.share[row];
        const double all = fabs(share[0]) + fabs(share[1]) + fabs(share[2]) + fabs(share[3]);
        const double c = tl_node_damping(&e->nodes, row);
        for (int a = 0; a < 4; a++) {
            const uint32_t point = first + e->nodes.point[row][a];
            m->zones->points.holds[point] += 2 * e->nodes.k[row] * all * fabs(share[a]);
            damping[point] += 2 * c * all * fabs(share[a]);
        }
    }
}

double tl_elements_stiffness(const tl_model *m, uint32_t body)
{
    const struct tl_elements *e = m->elements;
    double sum = 0;
    for (uint32_t k = 0; tl_elements_are_listed(m) && k < e->use_start[body + 1] - e->use_start[body]; k++)
        sum += e->nodes.k[e->use[e->use_start[body] + k]];
    return sum;
}

void tl_elements_hold(const tl_model *m, uint32_t body, tl_holding *sum)
{
    const struct tl_elements *e = m->elements;
    if (!tl_elements_are_listed(m) || (e->most_k == 0 && e->most_c == 0))
        return;
    for (uint32_t k = e->use_start[body]; k < e->use_start[body + 1]; k++) {
        const uint32_t row = e->use[k];
        const double arm2 = tl_v3_norm2(tl_columns_get(e->nodes.local, row)), c = tl_node_damping(&e->nodes, row);
        sum->stiffness.sum += e->nodes.k[row];
        sum->stiffness.r2 += e->nodes.k[row] * arm2;
        sum->undamped.sum += e->nodes.k[row];
        sum->undamped.r2 += e->nodes.k[row] * arm2;
        sum->damping.sum += c;
        sum->damping.r2 += c * arm2;
    }
}

double tl_elements_stiffest(const tl_model *m, double *damping)
{
    const struct tl_elements *e = m->elements;
    double most = 0;
    *damping = 0;
    for (size_t row = 0; e && row < e->nodes.table.rows; row++) {
        const uint32_t body = e->nodes.body[row];
        if (body == TL_NO_ROW || m->bodies.fixed[body] == TL_FIX_ALL)
            continue;
        most = fmax(most, e->nodes.k[row]);
        *damping = fmax(*damping, tl_node_damping(&e->nodes, row));
    }
    return most;
}

/* ---------------------------------------------------------------- energy ----------------- */

tl_energies tl_elements_energies(tl_model *m)
{
    const tl_element_table *t = &m->elements->table;
    tl_energies sum = {.stored = 0};
    const bool rest = m->elements->resting && m->elements->all_steady; /* all of these are 0 */
    for (size_t row = 0; row < t->table.rows && !rest; row++) {
        sum.stored += t->stored[row];
        sum.heat += t->lost[row];
        sum.given += t->given[row];
    }
    sum.given += tl_steady_given(m);
    return sum;
}
