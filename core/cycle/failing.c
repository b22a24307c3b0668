/* failing.c - tells steady failure from settling.
 *
 * The motion of each free body is followed in legs, each a share of the body's size long. A body fails steadily when it
 * has gone LEGS legs in one direction, none slower than the one before. The mean unbalanced force must push it that
 * way. A body that settles or swings slows down; one that is carried along feels no force. Legs are lengths, so neither
 * the time step nor the damping nor the stiffness decides how far a body has gone when it is found.
 *
 * Blocks on soft joints settle by more than a share of their size. So a leg is not shorter than a share of how far the
 * model may settle: the mean closure of its loaded contacts, weighted by their forces, times the number of blocks on
 * end. Zones of modulus M and volume V, which store U, settle by sqrt(2 U / (M V)) of the extent of their blocks.
 *
 * A deformable body may fail as a whole, as a rigid one does, or be crushed where it stands. So the gridpoint that is
 * the fastest against its body is followed as well, in legs that are a share of the zones there. It is another one once
 * one is faster by far.
 *
 * Bodies that touched nothing when the run began fall until they land, and tumble on. They are followed only while
 * something bears them, and in longer legs: what is poured has not failed. */
#include "cycle/failing.h"

#include "base/columns.h"
#include "base/parallel.h"
#include "contact/body_contacts.h"
#include "cycle/cycle_data.h"
#include "cycle/gridpoint.h"
#include "cycle/meshes.h"
#include "model/body_shape.h"
#include "model/rows.h"
#include "segment/segments.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <talus/elementary.h>

/* Tolerance: steps between two samples of the bodies: few of them make a leg of a body that moves. */
#define SAMPLE_STEPS 5
/* Tolerance: legs in a row, and how long they are together, relative to the size of the body. Stable blocks slip by
 * less as weight comes on. */
#define LEGS 5
#define FAILED_SHARE 0.05
/* Tolerance: the same for a body that has landed. */
#define LANDED_SHARE 1.0
/* Tolerance: the same relative to how far the model may settle: a column under sudden weight settles by about 1.5 of
 * it. */
#define SETTLED_SHARE 3.0
/* Tolerance: movement over a body's size from which rest may hang on the stiffness of joints. Angles change by as much,
 * and docs/how_stiff.md has thrusts near the edge of faces. Test: lua/test_remarks. */
#define MOVED_SHARE 0.01
/* Tolerance: a leg counts as no slower than the one before from this share of its speed on. */
#define NO_SLOWER 0.95
/* Tolerance: cos of the largest change of direction between legs. */
#define ONE_WAY 0.7
/* Tolerance: unbalanced force over what a body bears, below which such a body lies on something or slides on it. */
#define SUPPORTED 0.5
/* Tolerance: unbalanced force over what a body bears from which it is pushed on: above what is left where a body is
 * carried along. */
#define LEAST_PUSH 1e-4

/* Tolerance: how far a gridpoint must go against its body, over the edge of its zones. The share of the body's size
 * counts where that is less. Zones that are strained by more are soon turned inside out. */
#define STRAINED_SHARE 0.25
/* Tolerance: speed of a gridpoint over that of the one that is followed, from which on it is followed instead. */
#define FASTER 2.0

/* A leg of a body or a gridpoint, until now, and those behind it. */
typedef struct leg {
    double size;   /* of the body, m */
    tl_vec3 start; /* displacement when the run began */
    tl_vec3 from;  /* displacement where it began */
    double began;  /* s */
    tl_vec3 way;   /* direction and speed of the leg before */
    double speed;
    uint8_t legs; /* gone, one no slower than the other */
    /* sums over the samples of these legs: the unbalanced force, and what the body bore */
    tl_vec3 force;
    double borne;
    bool touched; /* something, when the run began */
    bool reached; /* has gone as far as its size asks: the leg may be at its end */
} leg;

/* The leg of the gridpoint of a mesh that moves the fastest against its body; TL_NO_ROW: none has. */
typedef struct strained {
    leg leg;
    uint32_t row;
} strained;

/* Watches for steady failure. */
struct tl_watch {
    size_t bodies;
    uint64_t structure;
    int64_t steps;
    double time;   /* in which they were made, s */
    double on_end; /* free blocks on end across the model */
    double least;  /* length of a leg that settlement asks for, when it was last needed, m */
    leg *leg;
    uint8_t *free;      /* bodies that can move */
    strained *strained; /* of each body; NULL: no block is deformable */
    tl_id failing;
    uint32_t failing_point; /* the gridpoint by which it fails, or TL_NO_ROW */
};

/* How far bodies reach across, m: twice the largest distance of their centroids from the mean of these; of deformable
 * ones, the distance of what is farthest of them. `free`: these bodies; NULL: those that deform. */
static double reach(const tl_model *m, const uint8_t *free)
{
    const tl_bodies *b = &m->bodies;
    tl_addends sum[3] = {{.count = 0}, {.count = 0}, {.count = 0}};
    double count = 0, farthest = 0;
    for (uint32_t body = 0; body < b->table.rows; body++)
        if (free ? free[body] : b->mesh[body]) {
            const tl_vec3 x = tl_body_place(b, body);
            tl_addends_put(&sum[0], x.x);
            tl_addends_put(&sum[1], x.y);
            tl_addends_put(&sum[2], x.z);
            count++;
        }
    const tl_vec3 sums = {tl_addends_sum(&sum[0]), tl_addends_sum(&sum[1]), tl_addends_sum(&sum[2])};
    const tl_vec3 mean = tl_v3_scale(count > 0 ? 1 / count : 0, sums);
    for (uint32_t body = 0; body < b->table.rows; body++)
        if (free ? free[body] : b->mesh[body])
            farthest =
                fmax(farthest, tl_v3_norm(tl_v3_sub(tl_body_place(b, body), mean)) + (free ? 0 : b->radius[body]));
    return 2 * farthest;
}

/* Number of blocks of the mean size across the free bodies. */
static double blocks_on_end(const tl_watch *w, const tl_model *m)
{
    tl_addends sizes = {.count = 0};
    double count = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        if (w->free[body]) {
            tl_addends_put(&sizes, tl_body_size(m, body));
            count++;
        }
    return count > 0 ? 1 + reach(m, w->free) * count / tl_addends_sum(&sizes) : 1;
}

static void begin_leg(leg *l, tl_vec3 at, double time)
{
    l->from = at;
    l->began = time;
    l->reached = false;
}

/* None of the legs behind it counts. */
static void forget_legs(leg *l)
{
    l->legs = 0;
    l->force = tl_v3(0, 0, 0);
    l->borne = 0;
}

/* Where a gridpoint is that is followed: how far it has moved against its body. */
static tl_vec3 strained_by(const tl_model *m, const strained *s)
{
    return tl_gridpoint_strained(m, &m->zones->mesh[m->zones->points.mesh[s->row]], s->row);
}

void tl_watch_end(tl_watch *w)
{
    if (!w)
        return;
    free(w->leg);
    free(w->free);
    free(w->strained);
    free(w);
}

tl_watch *tl_watch_begin(const tl_model *m)
{
    tl_watch *w = calloc(1, sizeof *w);
    if (!w)
        return NULL;
    w->bodies = m->bodies.table.rows;
    w->structure = m->structure;
    w->failing_point = TL_NO_ROW;
    w->leg = calloc(w->bodies + 1, sizeof *w->leg);
    w->free = calloc(w->bodies + 1, sizeof *w->free);
    w->strained = tl_model_deforms(m) ? calloc(w->bodies + 1, sizeof *w->strained) : NULL;
    if (!w->leg || !w->free || (tl_model_deforms(m) && !w->strained)) {
        tl_watch_end(w);
        return NULL;
    }
    for (uint32_t body = 0; body < w->bodies; body++) {
        w->free[body] = tl_body_is_free(m, body);
        w->leg[body].size = tl_body_size(m, body);
        w->leg[body].start = m->bodies.pose[body].u;
        begin_leg(&w->leg[body], m->bodies.pose[body].u, 0);
        if (w->strained)
            w->strained[body].row = TL_NO_ROW;
    }
    w->on_end = blocks_on_end(w, m);
    return w;
}

/* ---------------------------------------------------------------- samples ---------------- */

typedef struct sample_job {
    tl_watch *w;
    const tl_model *m;
    atomic_bool reached; /* by some body */
} sample_job;

/* What is followed: how far it has gone, the unbalanced force on it, what it bears, and whether something else than its
 * weight acts on it. */
typedef struct sample {
    tl_vec3 gone, force;
    double borne;
    bool held;
} sample;

/* Of a body, without what rounding carries (rest.c). */
static sample sample_of(const tl_model *m, uint32_t body, const tl_mesh_whole *whole)
{
    const tl_vec3 gone = m->bodies.pose[body].u;
    if (whole)
        return (sample){gone, whole->force, fmax(whole->borne, whole->weight), whole->borne > 0};
    const double weight = tl_weight_of(&m->bodies, body, tl_v3_norm(m->config.gravity));
    return (sample){gone, m->bodies.force[body], tl_borne(m, body, weight), m->cycle->contact_force[body] > 0};
}

/* Adds a sample to a leg that is so long; what touched nothing when the run began goes longer ones. */
static void add_sample(leg *l, const tl_watch *w, const sample *now, double length)
{
    double unbalanced = tl_v3_norm(now->force);
    bool judged = l->touched || (now->held && unbalanced < SUPPORTED * now->borne);
    tl_vec3 gone = tl_v3_sub(now->gone, l->from);
    double time = w->time - l->began;
    if (!judged) {
        forget_legs(l);
        begin_leg(l, now->gone, w->time);
        return;
    }
    double far = tl_v3_norm(gone), whole = fmax(length, w->least);
    if (far < whole && whole < NO_SLOWER * l->speed * time) /* too late by now */
        forget_legs(l);
    l->force = tl_v3_add(l->force, now->force);
    l->borne += now->borne;
    l->reached = far >= length;
}

static double leg_of(const leg *l)
{
    return (l->touched ? FAILED_SHARE : LANDED_SHARE) / LEGS * l->size;
}

/* Mean edge of the zones of a gridpoint, m: of regular ones of their mean volume. */
static double zone_edge(const tl_model *m, const tl_body_mesh *mesh, size_t row)
{
    const tl_gridpoints *p = &m->zones->points;
    const double density = m->bodies.mass[mesh->row] / tl_body_volume(m, mesh->row);
    const double volume = 4 * p->mass[row] / (density * p->zones[row]);
    return tl_cbrt(6 * sqrt(2) * volume);
}

/* Follows the gridpoint that moves the fastest against its body. */
static void choose_point(strained *s, const tl_watch *w, const tl_model *m, const tl_body_mesh *mesh,
                         const tl_mesh_whole *whole)
{
    const tl_gridpoints *p = &m->zones->points;
    double fastest2 = 0, own2 = 0;
    uint32_t fastest = TL_NO_ROW;
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++) {
        const double v2 = tl_v3_norm2(tl_v3_sub(tl_columns_get(p->v, row), whole->velocity));
        own2 = row == s->row ? v2 : own2;
        if (!(v2 > fastest2) || tl_gridpoint_is_held(p, row))
            continue;
        fastest2 = v2;
        fastest = row;
    }
    const bool other = fastest != TL_NO_ROW && (s->row == TL_NO_ROW || fastest2 > FASTER * FASTER * own2);
    if (s->leg.legs > 0 || !other)
        return;
    s->row = fastest;
    s->leg = (leg){.size = w->leg[mesh->row].size, .touched = w->leg[mesh->row].touched};
    begin_leg(&s->leg, strained_by(m, s), w->time);
}

/* Adds a sample of the gridpoint that is followed. */
static void sample_point(strained *s, const tl_watch *w, const tl_model *m, const tl_body_mesh *mesh)
{
    const tl_gridpoints *p = &m->zones->points;
    const double borne = tl_gridpoint_borne(m, s->row, tl_v3_norm(m->config.gravity));
    const tl_vec3 force = tl_free_part(tl_columns_get(p->force, s->row), p->fixed[s->row]);
    const sample now = {strained_by(m, s), force, borne, p->touched[s->row] > 0 || p->fixed[s->row]};
    const double length = fmin(leg_of(&s->leg), STRAINED_SHARE / LEGS * zone_edge(m, mesh, s->row));
    add_sample(&s->leg, w, &now, length);
}

static bool sample_body(tl_watch *w, const tl_model *m, uint32_t body)
{
    const tl_body_mesh *mesh = tl_mesh_of_body(m, body);
    tl_mesh_whole whole;
    if (mesh)
        whole = tl_mesh_whole_of(m, mesh);
    const sample now = sample_of(m, body, mesh ? &whole : NULL);
    add_sample(&w->leg[body], w, &now, leg_of(&w->leg[body]));
    if (!mesh)
        return w->leg[body].reached;
    strained *s = &w->strained[body];
    choose_point(s, w, m, mesh, &whole);
    if (s->row != TL_NO_ROW)
        sample_point(s, w, m, mesh);
    return w->leg[body].reached || (s->row != TL_NO_ROW && s->leg.reached);
}

static void sample_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    sample_job *job = user;
    bool reached = false;
    for (uint32_t body = (uint32_t)begin; body < end; body++)
        if (job->w->free[body])
            reached = sample_body(job->w, job->m, body) || reached;
    if (reached)
        atomic_store_explicit(&job->reached, true, memory_order_relaxed);
}

/* How far segments may close, as contacts do. */
static void add_segments(const tl_model *m, tl_addends *forces, tl_addends *closures)
{
    const struct tl_segments *s = m->segments;
    for (uint32_t row = 0; s && row < s->table.table.rows; row++) {
        if (s->table.of[row].meet == TL_NO_ROW || !(s->table.bears[row] > 0))
            continue;
        const uint32_t number = s->meet[s->table.of[row].meet].law;
        const tl_law *law = number == TL_NO_ROW ? NULL : &m->joint_laws[number];
        const double k = !law ? 0 : law->ks > 0 && law->ks < law->kn ? law->ks : law->kn, f = s->table.bears[row];
        tl_addends_put(forces, f);
        tl_addends_put(closures, k > 0 && s->table.area[row] > 0 ? f * f / (k * s->table.area[row]) : 0);
    }
}

/* How far zones may settle, m. */
static double settlement_of_zones(const tl_model *m)
{
    const struct tl_zones *z = m->zones;
    double stored = 0, stiff = 0;
    for (size_t k = 0; z && k < z->mesh_count; k++) {
        const tl_body_mesh *mesh = &z->mesh[k];
        const double volume = tl_body_volume(m, mesh->row);
        for (uint32_t j = mesh->parcel_begin; j < mesh->parcel_end; j++)
            stored += z->parcels.stored[j];
        stiff += volume * z->solid[z->parcels.of[mesh->parcel_begin].solid].of.constrained;
    }
    return stored > 0 && stiff > 0 ? sqrt(2 * stored / stiff) * reach(m, NULL) : 0;
}

double tl_watch_on_end(const tl_watch *w)
{
    return w->on_end;
}

/* How far the model may settle, m: see the head of the file. */
double tl_watch_settlement(const tl_watch *w, const tl_model *m)
{
    const tl_contacts *c = &m->detect->contacts;
    tl_addends forces = {.count = 0}, closures = {.count = 0};
    for (uint32_t i = 0; i < c->table.rows; i++) {
        double f = tl_v3_norm(c->force[i]);
        if (!(f > 0) || c->held[i])
            continue;
        const tl_law *law = &m->joint_laws[c->law[i]];
        double k = law->ks > 0 && law->ks < law->kn ? law->ks : law->kn;
        tl_addends_put(&forces, f);
        tl_addends_put(&closures, k > 0 && c->area[i] > 0 ? f * f / (k * c->area[i]) : 0);
    }
    add_segments(m, &forces, &closures);
    const double force = tl_addends_sum(&forces), zones = settlement_of_zones(m);
    return (force > 0 ? w->on_end * tl_addends_sum(&closures) / force : 0) + zones;
}

/* Ends a leg, and begins the next. */
static void end_leg(leg *l, tl_vec3 at, double time)
{
    tl_vec3 gone = tl_v3_sub(at, l->from), way = tl_v3_unit(gone);
    double speed = tl_v3_norm(gone) / (time - l->began);
    if (speed < NO_SLOWER * l->speed || tl_v3_dot(way, l->way) < ONE_WAY)
        forget_legs(l);
    if (l->legs < LEGS)
        l->legs++;
    l->way = way;
    l->speed = speed;
    begin_leg(l, at, time);
}

/* Ends the legs of a body that are as long as settlement asks for. */
static void end_legs(tl_watch *w, const tl_model *m, uint32_t body)
{
    leg *l = &w->leg[body];
    const tl_vec3 at = m->bodies.pose[body].u;
    if (l->reached && tl_v3_norm(tl_v3_sub(at, l->from)) >= w->least)
        end_leg(l, at, w->time);
    if (!w->strained || w->strained[body].row == TL_NO_ROW || !w->strained[body].leg.reached)
        return;
    leg *s = &w->strained[body].leg;
    const tl_vec3 by = strained_by(m, &w->strained[body]);
    if (tl_v3_norm(tl_v3_sub(by, s->from)) >= w->least)
        end_leg(s, by, w->time);
}

static bool is_failing(const leg *l)
{
    return l->legs >= LEGS && tl_v3_dot(l->force, l->way) > LEAST_PUSH * l->borne;
}

/* Finds the fastest of the bodies that fail: that have gone all their legs, pushed that way. */
static void find_failing(tl_watch *w, const tl_model *m)
{
    double fastest = 0;
    w->failing = TL_NO_ID;
    w->failing_point = TL_NO_ROW;
    for (uint32_t body = 0; body < w->bodies; body++) {
        const strained *s = w->strained ? &w->strained[body] : NULL;
        const bool whole = is_failing(&w->leg[body]), part = s && s->row != TL_NO_ROW && is_failing(&s->leg);
        double speed = whole || part ? tl_body_speed(m, body) : 0;
        if (part)
            speed = fmax(speed, tl_v3_norm(tl_columns_get(m->zones->points.v, s->row)));
        if (!w->free[body] || !(speed > fastest))
            continue;
        fastest = speed;
        w->failing = m->bodies.id[body];
        w->failing_point = whole ? TL_NO_ROW : s->row;
    }
}

/* Tolerance: speed over that of the fastest body that fails, from which on another fails with it. */
#define FAILS_ALONG 0.1

/* Of a block that fails: how far its body has gone, or the gridpoint by which it fails. */
static tl_vec3 way_of(const tl_watch *w, const tl_model *m, uint32_t body)
{
    const bool by_point = w->failing_point != TL_NO_ROW && m->bodies.id[body] == w->failing;
    return by_point ? strained_by(m, &w->strained[body]) : tl_v3_sub(m->bodies.pose[body].u, w->leg[body].start);
}

tl_status tl_watch_list(const tl_watch *w, tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    const uint32_t row = tl_block_row_quiet(m, w->failing);
    if (row == TL_NO_ROW || w->structure != m->structure)
        return TL_OK;
    if (!tl_fit(&c->fails, &c->fails_capacity, m->blocks.table.rows, sizeof *c->fails))
        return tl_fail_memory(&m->error);
    const double speed = tl_body_speed(m, m->blocks.body[row]);
    tl_addends volume = {.count = 0}, way[3] = {{.count = 0}, {.count = 0}, {.count = 0}};
    c->fails_count = 0;
    for (uint32_t i = 0; i < m->blocks.table.rows; i++) {
        const uint32_t body = m->blocks.body[i];
        const bool along = w->free[body] && tl_body_speed(m, body) >= FAILS_ALONG * speed;
        if (!along && i != row)
            continue;
        const tl_vec3 gone = way_of(w, m, body);
        c->fails[c->fails_count++] = m->blocks.id[i];
        const double own = m->blocks.volume[i];
        tl_addends_put(&volume, own);
        tl_addends_put(&way[0], own * gone.x);
        tl_addends_put(&way[1], own * gone.y);
        tl_addends_put(&way[2], own * gone.z);
    }
    c->fails_volume = tl_addends_sum(&volume);
    c->fails_way = tl_v3_unit(tl_v3(tl_addends_sum(&way[0]), tl_addends_sum(&way[1]), tl_addends_sum(&way[2])));
    c->fails_strained = w->failing_point != TL_NO_ROW;
    if (c->fails_strained)
        c->fails_at = tl_v3_add(m->origin, tl_gridpoint_place(&m->zones->points, w->failing_point));
    return TL_OK;
}

/* Whether something touches a body: a contact with points or a segment; or some of its gridpoints are held. */
static bool is_touched(const tl_model *m, uint32_t body)
{
    const struct tl_segments *s = m->segments;
    const tl_body_mesh *mesh = tl_mesh_of_body(m, body);
    if (tl_body_has_points(m, body) || (s && s->body_start[body + 1] > s->body_start[body]))
        return true;
    bool touched = false;
    for (uint32_t row = mesh ? mesh->point_begin : 0; mesh && !touched && row < mesh->point_end; row++)
        touched = m->zones->points.fixed[row] || (s && s->use_start[row + 1] > s->use_start[row]);
    return touched;
}

tl_id tl_watch_step(tl_watch *w, const tl_model *m)
{
    if (w->structure != m->structure)
        return w->failing;
    w->time += m->dt;
    if (tl_has_leapt(m)) { /* that says nothing of speeds; models that deform never leap */
        for (uint32_t body = 0; body < w->bodies; body++) {
            forget_legs(&w->leg[body]);
            begin_leg(&w->leg[body], m->bodies.pose[body].u, w->time);
        }
        return w->failing = TL_NO_ID;
    }
    if (w->steps++ == 0)
        for (uint32_t body = 0; body < w->bodies; body++)
            w->leg[body].touched = is_touched(m, body);
    if (w->steps % SAMPLE_STEPS != 0)
        return w->failing;
    sample_job job = {.w = w, .m = m};
    tl_parallel_for(m->pool, w->bodies, TL_READ_CHUNK, sample_range, &job);
    if (job.reached)
        w->least = SETTLED_SHARE / LEGS * tl_watch_settlement(w, m);
    for (uint32_t body = 0; body < w->bodies && job.reached; body++)
        if (w->free[body])
            end_legs(w, m, body);
    find_failing(w, m);
    return w->failing;
}

/* The body that has gone the farthest over its size, beyond a share of that and a length. */
static tl_gone farthest(const tl_watch *w, const tl_model *m, double share, double least)
{
    tl_gone out = {TL_NO_ROW, 0, share};
    for (uint32_t body = 0; body < w->bodies && w->structure == m->structure; body++) {
        const leg *l = &w->leg[body];
        double far = tl_v3_norm(tl_v3_sub(m->bodies.pose[body].u, l->start));
        if (!l->touched || !w->free[body] || far < least || !(far > out.share * l->size))
            continue;
        out = (tl_gone){body, far, far / l->size};
    }
    return out;
}

tl_gone tl_watch_gone(const tl_watch *w, const tl_model *m)
{
    return farthest(w, m, FAILED_SHARE, SETTLED_SHARE * tl_watch_settlement(w, m));
}

tl_gone tl_watch_moved(const tl_watch *w, const tl_model *m)
{
    return farthest(w, m, MOVED_SHARE, 0);
}
