/* watch.c - telling steady failure from settling.
 *
 * The motion of each free body is followed in legs, each a share of the body's size long. A body fails steadily when it
 * has gone LEGS legs in one direction, none of them slower than the one before, and the mean unbalanced force on it
 * pushes it that way. A body that settles or swings slows
 * down; one that is carried along feels no force. Legs are lengths, so neither the time step nor the damping nor the stiffness decides how far
 * a body has gone when it is told.
 *
 * Blocks on soft joints settle by more than a share of their size. So a leg is not shorter than a share of how far the model
 * may settle: the mean closure of its loaded contacts, weighted by their forces, times the number of blocks on end.
 *
 * Bodies that touched nothing when the run began fall until they land, and tumble on. They are followed only while
 * something bears them, and in longer legs: what is poured has not failed. */
#include "cycle/cycle_data.h"

#include "contact/detection.h"
#include "model/body_shape.h"

#include <stdatomic.h>
#include <stdlib.h>

/* Steps between two samples of the bodies: few of them make a leg of a body that moves. */
#define SAMPLE_STEPS 5
/* Legs in a row, and how long they are together, relative to the size of the body. */
#define LEGS 5
#define FAILED_SHARE 0.05
/* The same for a body that has landed. */
#define LANDED_SHARE 1.0
/* The same relative to how far the model may settle: a column under sudden weight settles by about 1.5 of it. */
#define SETTLED_SHARE 3.0
/* A leg counts as no slower than the one before from this share of its speed on. */
#define NO_SLOWER 0.95
/* cos of the largest change of direction between legs. */
#define ONE_WAY 0.7
/* Unbalanced force over what a body bears, below which such a body lies on something or slides on it. */
#define SUPPORTED 0.5
/* Unbalanced force over what a body bears from which it is pushed on: above what is left where a body is carried along. */
#define LEAST_PUSH 1e-4

/* A leg of a body, until now, and those behind it. */
typedef struct leg {
    double size;   /* of the body, m */
    tl_vec3 start; /* displacement when the run began */
    tl_vec3 from;  /* displacement where it began */
    double began;  /* s */
    tl_vec3 way;   /* direction and speed of the leg before */
    double speed;
    uint8_t legs; /* gone, one no slower than the other */
    tl_vec3
        force; /* sum over the samples of these legs of the unbalanced force, and of what the body bore */
    double borne;
    bool touched; /* something, when the run began */
    bool reached; /* has gone as far as its size asks: the leg may be at its end */
} leg;

struct tl_watch {
    size_t bodies;
    uint64_t structure;
    int64_t steps;
    double on_end; /* free blocks on end across the model */
    double least;  /* length of a leg that settlement asks for, when it was last needed, m */
    leg *leg;
    tl_id failing;
};

/* Number of blocks of the mean size across the free bodies. */
static double blocks_on_end(const tl_model *m)
{
    tl_vec3 low = {INFINITY, INFINITY, INFINITY}, high = tl_v3_neg(low);
    double sizes = 0, count = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        if (m->bodies.fixed[body] == TL_FIX_ALL)
            continue;
        tl_vec3 x = tl_body_place(&m->bodies, body);
        low = tl_v3(fmin(low.x, x.x), fmin(low.y, x.y), fmin(low.z, x.z));
        high = tl_v3(fmax(high.x, x.x), fmax(high.y, x.y), fmax(high.z, x.z));
        sizes += tl_body_size(m, body);
        count++;
    }
    return count > 0 ? 1 + tl_v3_norm(tl_v3_sub(high, low)) * count / sizes : 1;
}

static void begin_leg(leg *l, const tl_model *m, uint32_t body)
{
    l->from = m->bodies.pose[body].u;
    l->began = m->time;
    l->reached = false;
}

/* None of the legs behind it counts. */
static void forget_legs(leg *l)
{
    l->legs = 0;
    l->force = tl_v3(0, 0, 0);
    l->borne = 0;
}

tl_watch *tl_watch_begin(const tl_model *m)
{
    tl_watch *w = calloc(1, sizeof *w);
    if (!w)
        return NULL;
    w->bodies = m->bodies.table.rows;
    w->structure = m->structure;
    w->on_end = blocks_on_end(m);
    w->leg = calloc(w->bodies + 1, sizeof *w->leg);
    if (!w->leg) {
        tl_watch_end(w);
        return NULL;
    }
    for (uint32_t body = 0; body < w->bodies; body++) {
        w->leg[body].size = tl_body_size(m, body);
        w->leg[body].start = m->bodies.pose[body].u;
        begin_leg(&w->leg[body], m, body);
    }
    return w;
}

void tl_watch_end(tl_watch *w)
{
    if (!w)
        return;
    free(w->leg);
    free(w);
}

/* ---------------------------------------------------------------- samples ---------------- */

/* Whether a block of the body has contact points, in the first step. */
static bool touches(const tl_model *m, uint32_t body)
{
    const tl_detect *d = m->detect;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        uint32_t row = m->members[m->bodies.member_start[body] + k];
        for (uint32_t e = d->by_block_start[row]; e < d->by_block_start[row + 1]; e++)
            if (d->contacts.point_count[d->by_block[e]] > 0)
                return true;
    }
    return false;
}

/* What contacts carry at an overlap that is rounding (rest.c) does not count. */
static double borne_by(const tl_model *m, uint32_t body)
{
    return tl_borne(m, body, tl_weight_of(&m->bodies, body, tl_v3_norm(m->config.gravity)));
}

typedef struct sample_job {
    tl_watch *w;
    const tl_model *m;
    atomic_bool reached; /* by some body */
} sample_job;

/* Adds a sample to the leg of a body. */
static void add_sample(leg *l, double least, const tl_model *m, uint32_t body)
{
    double unbalanced = tl_v3_norm(m->bodies.force[body]), borne = borne_by(m, body);
    bool judged =
        l->touched || (m->cycle->contact_force[body] > 0 && unbalanced < SUPPORTED * borne);
    tl_vec3 gone = tl_v3_sub(m->bodies.pose[body].u, l->from);
    double share = l->touched ? FAILED_SHARE : LANDED_SHARE;
    double length = share / LEGS * l->size, time = m->time - l->began;
    if (!judged) {
        forget_legs(l);
        begin_leg(l, m, body);
        return;
    }
    double far = tl_v3_norm(gone), whole = fmax(length, least);
    if (far < whole && whole < NO_SLOWER * l->speed * time) /* too late by now */
        forget_legs(l);
    l->force = tl_v3_add(l->force, m->bodies.force[body]);
    l->borne += borne;
    l->reached = far >= length;
}

static void sample_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    (void)thread;
    sample_job *job = user;
    const tl_model *m = job->m;
    bool reached = false;
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        if (m->bodies.fixed[body] == TL_FIX_ALL)
            continue;
        add_sample(&job->w->leg[body], job->w->least, m, body);
        reached = reached || job->w->leg[body].reached;
    }
    if (reached)
        atomic_store_explicit(&job->reached, true, memory_order_relaxed);
}

/* How far the model may settle, m: see the head of the file. */
static double settlement(const tl_watch *w, const tl_model *m)
{
    const tl_contacts *c = &m->detect->contacts;
    double force = 0, force_closure = 0;
    for (uint32_t i = 0; i < c->table.rows; i++) {
        double f = tl_v3_norm(c->force[i]);
        if (!(f > 0) || c->held[i])
            continue;
        const tl_law *law = &m->joint_laws[c->law[i]];
        double k = law->ks > 0 && law->ks < law->kn ? law->ks : law->kn;
        force += f;
        force_closure += k > 0 && c->area[i] > 0 ? f * f / (k * c->area[i]) : 0;
    }
    return force > 0 ? w->on_end * force_closure / force : 0;
}

/* Ends the leg of a body, and begins the next. */
static void end_leg(leg *l, const tl_model *m, uint32_t body)
{
    tl_vec3 gone = tl_v3_sub(m->bodies.pose[body].u, l->from), way = tl_v3_unit(gone);
    double speed = tl_v3_norm(gone) / (m->time - l->began);
    if (speed < NO_SLOWER * l->speed || tl_v3_dot(way, l->way) < ONE_WAY)
        forget_legs(l);
    if (l->legs < LEGS)
        l->legs++;
    l->way = way;
    l->speed = speed;
    begin_leg(l, m, body);
}

/* Whether a body has gone all its legs, pushed that way. */
static bool fails(const leg *l)
{
    return l->legs == LEGS && tl_v3_dot(l->force, l->way) > LEAST_PUSH * l->borne;
}

/* The fastest of the bodies that fail. */
static tl_id find_failing(const tl_watch *w, const tl_model *m)
{
    tl_id failing = TL_NO_ID;
    double fastest = 0;
    for (uint32_t body = 0; body < w->bodies; body++) {
        if (!fails(&w->leg[body]) || m->bodies.fixed[body] == TL_FIX_ALL)
            continue;
        double speed = tl_v3_norm(m->bodies.v[body]);
        if (speed > fastest) {
            fastest = speed;
            failing = m->bodies.id[body];
        }
    }
    return failing;
}

tl_id tl_watch_step(tl_watch *w, const tl_model *m)
{
    if (w->structure != m->structure)
        return w->failing;
    if (w->steps++ == 0)
        for (uint32_t body = 0; body < w->bodies; body++)
            w->leg[body].touched = touches(m, body);
    if (w->steps % SAMPLE_STEPS != 0)
        return w->failing;
    sample_job job = {.w = w, .m = m};
    tl_parallel_for(m->pool, w->bodies, TL_READ_CHUNK, sample_range, &job);
    if (job.reached)
        w->least = SETTLED_SHARE / LEGS * settlement(w, m);
    for (uint32_t body = 0; body < w->bodies && job.reached; body++)
        if (w->leg[body].reached && m->bodies.fixed[body] != TL_FIX_ALL &&
            tl_v3_norm(tl_v3_sub(m->bodies.pose[body].u, w->leg[body].from)) >= w->least)
            end_leg(&w->leg[body], m, body);
    w->failing = find_failing(w, m);
    return w->failing;
}

tl_id tl_watch_gone(const tl_watch *w, const tl_model *m, double *way, double *size)
{
    double most = FAILED_SHARE, least = SETTLED_SHARE * settlement(w, m);
    tl_id gone = TL_NO_ID;
    for (uint32_t body = 0; body < w->bodies && w->structure == m->structure; body++) {
        const leg *l = &w->leg[body];
        double far = tl_v3_norm(tl_v3_sub(m->bodies.pose[body].u, l->start));
        if (!l->touched || m->bodies.fixed[body] == TL_FIX_ALL || far < least ||
            !(far > most * l->size))
            continue;
        most = far / l->size;
        *way = far;
        *size = l->size;
        gone = m->bodies.id[body];
    }
    return gone;
}
