/* solve.c - many steps: until a limit is met, the user interrupts, or a callback says so. */
#include "cycle/solve.h"

#include "base/clock.h"
#include "contact/body_contacts.h"
#include "contact/detection.h"
#include "cycle/cycle.h"
#include "cycle/cycle_data.h"
#include "cycle/remarks.h"
#include "cycle/rest.h"
#include "cycle/settle.h"
#include "model/body_shape.h"
#include "model/options.h"
#include "model/rows.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <talus/number.h>

/* ---------------------------------------------------------------- steady failure ----------
 *
 * Telling steady failure from settling.
 *
 * The motion of each free body is followed in legs, each a share of the body's size long. A body fails steadily when it
 * has gone LEGS legs in one direction, none slower than the one before. The mean unbalanced force must push it that
 * way. A body that settles or swings slows down; one that is carried along feels no force. Legs are lengths, so neither
 * the time step nor the damping nor the stiffness decides how far a body has gone when it is found.
 *
 * Blocks on soft joints settle by more than a share of their size. So a leg is not shorter than a share of how far the
 * model may settle: the mean closure of its loaded contacts, weighted by their forces, times the number of blocks on
 * end.
 *
 * Bodies that touched nothing when the run began fall until they land, and tumble on. They are followed only while
 * something bears them, and in longer legs: what is poured has not failed. */

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
/* Tolerance: a leg counts as no slower than the one before from this share of its speed on. */
#define NO_SLOWER 0.95
/* Tolerance: cos of the largest change of direction between legs. */
#define ONE_WAY 0.7
/* Tolerance: unbalanced force over what a body bears, below which such a body lies on something or slides on it. */
#define SUPPORTED 0.5
/* Tolerance: unbalanced force over what a body bears from which it is pushed on: above what is left where a body is
 * carried along. */
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
    /* sums over the samples of these legs: the unbalanced force, and what the body bore */
    tl_vec3 force;
    double borne;
    bool touched; /* something, when the run began */
    bool reached; /* has gone as far as its size asks: the leg may be at its end */
} leg;

/* Watches for steady failure. */
typedef struct tl_watch {
    size_t bodies;
    uint64_t structure;
    int64_t steps;
    double time;   /* in which they were made, s */
    double on_end; /* free blocks on end across the model */
    double least;  /* length of a leg that settlement asks for, when it was last needed, m */
    leg *leg;
    tl_id failing;
} tl_watch;

/* Number of blocks of the mean size across the free bodies. */
static double blocks_on_end(const tl_model *m)
{
    tl_vec3 low = {INFINITY, INFINITY, INFINITY}, high = tl_v3_neg(low);
    tl_addends sizes = {.count = 0};
    double count = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        if (m->bodies.fixed[body] == TL_FIX_ALL)
            continue;
        tl_vec3 x = tl_body_place(&m->bodies, body);
        low = tl_v3(fmin(low.x, x.x), fmin(low.y, x.y), fmin(low.z, x.z));
        high = tl_v3(fmax(high.x, x.x), fmax(high.y, x.y), fmax(high.z, x.z));
        tl_addends_put(&sizes, tl_body_size(m, body));
        count++;
    }
    return count > 0 ? 1 + tl_v3_norm(tl_v3_sub(high, low)) * count / tl_addends_sum(&sizes) : 1;
}

static void begin_leg(leg *l, const tl_model *m, uint32_t body, double time)
{
    l->from = m->bodies.pose[body].u;
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

static void watch_end(tl_watch *w)
{
    if (!w)
        return;
    free(w->leg);
    free(w);
}

static tl_watch *watch_begin(const tl_model *m)
{
    tl_watch *w = calloc(1, sizeof *w);
    if (!w)
        return NULL;
    w->bodies = m->bodies.table.rows;
    w->structure = m->structure;
    w->on_end = blocks_on_end(m);
    w->leg = calloc(w->bodies + 1, sizeof *w->leg);
    if (!w->leg) {
        watch_end(w);
        return NULL;
    }
    for (uint32_t body = 0; body < w->bodies; body++) {
        w->leg[body].size = tl_body_size(m, body);
        w->leg[body].start = m->bodies.pose[body].u;
        begin_leg(&w->leg[body], m, body, 0);
    }
    return w;
}

/* ---------------------------------------------------------------- samples ---------------- */

typedef struct sample_job {
    tl_watch *w;
    const tl_model *m;
    atomic_bool reached; /* by some body */
} sample_job;

/* Adds a sample to the leg of a body. */
static void add_sample(leg *l, const tl_watch *w, const tl_model *m, uint32_t body)
{
    double weight = tl_weight_of(&m->bodies, body, tl_v3_norm(m->config.gravity));
    double unbalanced = tl_v3_norm(m->bodies.force[body]);
    double borne = tl_borne(m, body, weight); /* without what rounding carries (rest.c) */
    bool judged = l->touched || (m->cycle->contact_force[body] > 0 && unbalanced < SUPPORTED * borne);
    tl_vec3 gone = tl_v3_sub(m->bodies.pose[body].u, l->from);
    double share = l->touched ? FAILED_SHARE : LANDED_SHARE;
    double length = share / LEGS * l->size, time = w->time - l->began;
    if (!judged) {
        forget_legs(l);
        begin_leg(l, m, body, w->time);
        return;
    }
    double far = tl_v3_norm(gone), whole = fmax(length, w->least);
    if (far < whole && whole < NO_SLOWER * l->speed * time) /* too late by now */
        forget_legs(l);
    l->force = tl_v3_add(l->force, m->bodies.force[body]);
    l->borne += borne;
    l->reached = far >= length;
}

static void sample_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    sample_job *job = user;
    const tl_model *m = job->m;
    bool reached = false;
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        if (m->bodies.fixed[body] == TL_FIX_ALL)
            continue;
        add_sample(&job->w->leg[body], job->w, m, body);
        reached = reached || job->w->leg[body].reached;
    }
    if (reached)
        atomic_store_explicit(&job->reached, true, memory_order_relaxed);
}

/* How far the model may settle, m: see the head of the file. */
static double settlement(const tl_watch *w, const tl_model *m)
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
    const double force = tl_addends_sum(&forces);
    return force > 0 ? w->on_end * tl_addends_sum(&closures) / force : 0;
}

/* Ends the leg of a body, and begins the next. */
static void end_leg(leg *l, const tl_model *m, uint32_t body, double time)
{
    tl_vec3 gone = tl_v3_sub(m->bodies.pose[body].u, l->from), way = tl_v3_unit(gone);
    double speed = tl_v3_norm(gone) / (time - l->began);
    if (speed < NO_SLOWER * l->speed || tl_v3_dot(way, l->way) < ONE_WAY)
        forget_legs(l);
    if (l->legs < LEGS)
        l->legs++;
    l->way = way;
    l->speed = speed;
    begin_leg(l, m, body, time);
}

/* The fastest of the bodies that fail: that have gone all their legs, pushed that way. */
static tl_id find_failing(const tl_watch *w, const tl_model *m)
{
    tl_id failing = TL_NO_ID;
    double fastest = 0;
    for (uint32_t body = 0; body < w->bodies; body++) {
        const leg *l = &w->leg[body];
        double speed = tl_v3_norm(m->bodies.v[body]);
        if (l->legs < LEGS || !(tl_v3_dot(l->force, l->way) > LEAST_PUSH * l->borne) ||
            m->bodies.fixed[body] == TL_FIX_ALL || !(speed > fastest))
            continue;
        fastest = speed;
        failing = m->bodies.id[body];
    }
    return failing;
}

/* Tolerance: speed over that of the fastest body that fails, from which on another fails with it. */
#define FAILS_ALONG 0.1

/* Keeps the blocks that fail with the one found, how much rock that is, and where it goes. */
static tl_status list_failing(const tl_watch *w, tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    const uint32_t row = tl_block_row_quiet(m, w->failing);
    if (row == TL_NO_ROW || w->structure != m->structure)
        return TL_OK;
    if (!tl_fit(&c->fails, &c->fails_capacity, m->blocks.table.rows, sizeof *c->fails))
        return tl_fail_memory(&m->error);
    const double speed = tl_v3_norm(m->bodies.v[m->blocks.body[row]]);
    tl_addends volume = {.count = 0}, way[3] = {{.count = 0}, {.count = 0}, {.count = 0}};
    c->fails_count = 0;
    for (uint32_t i = 0; i < m->blocks.table.rows; i++) {
        const uint32_t body = m->blocks.body[i];
        const tl_vec3 gone = tl_v3_sub(m->bodies.pose[body].u, w->leg[body].start);
        const bool along = m->bodies.fixed[body] != TL_FIX_ALL && tl_v3_norm(m->bodies.v[body]) >= FAILS_ALONG * speed;
        if (!along && i != row)
            continue;
        c->fails[c->fails_count++] = m->blocks.id[i];
        const double own = m->blocks.volume[i];
        tl_addends_put(&volume, own);
        tl_addends_put(&way[0], own * gone.x);
        tl_addends_put(&way[1], own * gone.y);
        tl_addends_put(&way[2], own * gone.z);
    }
    c->fails_volume = tl_addends_sum(&volume);
    c->fails_way = tl_v3_unit(tl_v3(tl_addends_sum(&way[0]), tl_addends_sum(&way[1]), tl_addends_sum(&way[2])));
    return TL_OK;
}

/* After each step; gives the id of the block that fails steadily, or 0. */
static tl_id watch_step(tl_watch *w, const tl_model *m)
{
    if (w->structure != m->structure)
        return w->failing;
    w->time += m->dt;
    if (tl_has_leapt(m)) { /* that says nothing of speeds */
        for (uint32_t body = 0; body < w->bodies; body++) {
            forget_legs(&w->leg[body]);
            begin_leg(&w->leg[body], m, body, w->time);
        }
        return w->failing = TL_NO_ID;
    }
    if (w->steps++ == 0)
        for (uint32_t body = 0; body < w->bodies; body++)
            w->leg[body].touched = tl_body_has_points(m, body);
    if (w->steps % SAMPLE_STEPS != 0)
        return w->failing;
    sample_job job = {.w = w, .m = m};
    tl_parallel_for(m->pool, w->bodies, TL_READ_CHUNK, sample_range, &job);
    if (job.reached)
        w->least = SETTLED_SHARE / LEGS * settlement(w, m);
    for (uint32_t body = 0; body < w->bodies && job.reached; body++)
        if (w->leg[body].reached && m->bodies.fixed[body] != TL_FIX_ALL &&
            tl_v3_norm(tl_v3_sub(m->bodies.pose[body].u, w->leg[body].from)) >= w->least)
            end_leg(&w->leg[body], m, body, w->time);
    w->failing = find_failing(w, m);
    return w->failing;
}

/* ---------------------------------------------------------------- runs -------------------- */

static const char *const reason_names[] = {
    [TL_SOLVE_RATIO] = "ratio",     [TL_SOLVE_CYCLES] = "cycles",       [TL_SOLVE_TIME] = "time",
    [TL_SOLVE_STOP] = "stop",       [TL_SOLVE_INTERRUPT] = "interrupt", [TL_SOLVE_VELOCITY] = "velocity",
    [TL_SOLVE_FAILURE] = "failure", [TL_SOLVE_OVERLAP] = "overlap",     [TL_SOLVE_REST] = "rest"};

const char *tl_solve_reason_name(tl_solve_reason reason)
{
    return reason_names[reason];
}

typedef struct progress {
    const tl_solve *solve;
    tl_solve_result *result;
    int64_t cycles_0;
    double time_0, wall_0;
} progress;

/* Id of the body that is farthest from equilibrium by the local measure, or TL_NO_ID. */
static tl_id worst_body(const tl_model *m)
{
    uint32_t worst = m->cycle->sums.worst;
    return worst == TL_NO_ROW ? TL_NO_ID : m->bodies.id[worst];
}

static void measure(const tl_model *m, const progress *p)
{
    tl_solve_result *r = p->result;
    const tl_balance now = tl_model_balance(m);
    r->ratio = now.ratio;
    r->ratio_maximum = now.ratio_maximum;
    r->ratio_local = now.ratio_local;
    r->worst = worst_body(m);
    r->max_velocity = now.max_velocity;
    r->cycles = m->cycles - p->cycles_0;
    r->time = m->time;
    r->wall = tl_clock() - p->wall_0;
}

/* Calls the user's functions after a step; true when one of them ends the run. */
static bool call_back(tl_model *m, const tl_solve *s, int64_t done, tl_status *status)
{
    const bool due = s->every > 0 && done % s->every == 0;
    bool stop = false;
    m->running = true;
    if (s->each)
        *status = s->each(s->user, m);
    if (*status == TL_OK && due && s->progress)
        *status = s->progress(s->user, m);
    if (*status == TL_OK && due && s->stop)
        stop = s->stop(s->user, m);
    m->running = false;
    return stop || *status != TL_OK;
}

static bool at_rest(tl_model *m, const progress *p)
{
    bool rests =
        (!m->relaxing || tl_settle_bears_all(m)) && tl_at_rest(m, (tl_ratio_measure)p->solve->measure, p->solve->ratio);
    p->result->worst = worst_body(m); /* where forces balance, one that still moves */
    return rests;
}

/* What blocks that were made overlapping have pushed with: those that did the most, the energy that is no longer
 * stored, and what gravity and all else have done, J. */
typedef struct overlap_push {
    tl_id a, b;
    double gave, others;
} overlap_push;

/* Whether they have given off more than all else has. */
static bool overlaps_push(const tl_model *m, overlap_push *by)
{
    const tl_ledger *l = &m->cycle->ledger;
    const tl_energy *e = &l->energy;
    *by = (overlap_push){l->overlap_a, l->overlap_b, l->overlaps - e->stored, fmax(0, e->external - e->potential)};
    return by->gave > by->others;
}

/* True when the run is over; sets the reason. */
static bool ended(tl_model *m, const progress *p, tl_status *status)
{
    const tl_solve *s = p->solve;
    int64_t done = m->cycles - p->cycles_0;
    tl_solve_reason *reason = &p->result->reason;
    if (call_back(m, s, done, status))
        *reason = TL_SOLVE_STOP;
    else if (tl_model_interrupted(m))
        *reason = TL_SOLVE_INTERRUPT;
    else if (s->ratio > 0 && at_rest(m, p))
        *reason = TL_SOLVE_RATIO;
    else if (done > 1 && p->result->max_velocity < s->velocity) /* from rest the first is zero */
        *reason = TL_SOLVE_VELOCITY;
    else if (s->stop_at_failure && p->result->failing)
        *reason = overlaps_push(m, &(overlap_push){0}) ? TL_SOLVE_OVERLAP : TL_SOLVE_FAILURE;
    else if (done >= s->max_cycles)
        *reason = TL_SOLVE_CYCLES;
    else if (m->time - p->time_0 >= s->max_time)
        *reason = TL_SOLVE_TIME;
    else
        return false;
    return true;
}

/* Calls the function before a step; false when the run is over. What it makes or takes away is watched anew. */
static bool call_between(tl_model *m, const progress *p, tl_watch **watch, tl_status *status)
{
    uint64_t structure = m->structure;
    *status = p->solve->between(p->solve->user, m);
    if (*status == TL_OK && *watch && m->structure != structure) {
        watch_end(*watch);
        *watch = watch_begin(m);
        *status = *watch ? TL_OK : tl_fail_memory(&m->error);
    }
    if (*status == TL_OK && !tl_model_interrupted(m))
        return true;
    p->result->reason = *status == TL_OK ? TL_SOLVE_INTERRUPT : TL_SOLVE_STOP;
    return false;
}

/* The call that a remark is of. */
static const char *run_name(const tl_model *m)
{
    return m->relaxing ? "relax" : "solve";
}

static void say_failure(tl_model *m, const tl_solve_result *r)
{
    uint32_t row = tl_block_row_quiet(m, r->failing);
    double speed = row == TL_NO_ROW ? 0 : tl_v3_norm(m->bodies.v[m->blocks.body[row]]);
    overlap_push push;
    if (overlaps_push(m, &push)) {
        tl_model_say(m,
                     "%s: an overlap pushes the model apart: blocks that were made overlapping have given off %.3g "
                     "J, most of it blocks %u and %u, and gravity and loads %.3g J; block %u moves on at %.3g m/s; "
                     "that is no word on whether it stands: make them apart, or with smaller overlaps",
                     run_name(m), push.gave, push.a, push.b, push.others, r->failing, speed);
        return;
    }
    char at[40] = ""; /* by the masses of a relaxation a speed means nothing */
    if (!m->relaxing)
        tl_text_print(at, sizeof at, " at %.3g m/s", speed);
    tl_model_say(m,
                 "%s: the model fails: block %u moves on%s without slowing down (unbalanced force ratio: local %.3g, "
                 "average %.3g)",
                 run_name(m), r->failing, at, r->ratio_local, r->ratio);
}

/* At rest, but not where the run began: what slid until it met something may be no equilibrium of what was asked for.
 * Names the body that has gone the farthest over its size, of those that touched something then. */
static void say_gone(tl_model *m, const tl_watch *w)
{
    double way = 0, most = FAILED_SHARE, least = SETTLED_SHARE * settlement(w, m);
    uint32_t gone = TL_NO_ROW;
    for (uint32_t body = 0; body < w->bodies && w->structure == m->structure; body++) {
        const leg *l = &w->leg[body];
        double far = tl_v3_norm(tl_v3_sub(m->bodies.pose[body].u, l->start));
        if (!l->touched || m->bodies.fixed[body] == TL_FIX_ALL || far < least || !(far > most * l->size))
            continue;
        most = far / l->size;
        way = far;
        gone = body;
    }
    if (gone != TL_NO_ROW)
        tl_model_say(
            m, "%s: at rest, but not where it began: block %u has moved by %.3g m in this run, %.2g times its size",
            run_name(m), m->bodies.id[gone], way, most);
}

/* Neither at rest nor failing: of a run that was to find out which. */
static void say_undecided(tl_model *m, const tl_solve *solve, const tl_solve_result *r)
{
    bool cycles = r->reason == TL_SOLVE_CYCLES;
    const tl_balance now = tl_model_balance(m);
    const double of[] = {now.ratio, now.ratio_maximum, now.ratio_local}; /* by tl_ratio_measure */
    if (tl_model_says(m, TL_REMARK_UNDECIDED))
        tl_model_say(m,
                     "%s: ended by %s = %.9g, neither at rest (ratio %.3g, asked for %.3g) nor failing: that is no "
                     "word on whether it stands",
                     run_name(m), cycles ? "max_cycles" : "max_time",
                     cycles ? (double)solve->max_cycles : solve->max_time, of[solve->measure], solve->ratio);
}

/* What the end of a run means for whether the model stands. A stop function has its own reason. */
static void say_end(tl_model *m, const tl_solve *solve, const tl_watch *watch, const tl_solve_result *r)
{
    bool rests = r->reason == TL_SOLVE_RATIO || r->reason == TL_SOLVE_VELOCITY;
    bool limit = r->reason == TL_SOLVE_CYCLES || r->reason == TL_SOLVE_TIME;
    if (r->failing && r->reason != TL_SOLVE_STOP)
        say_failure(m, r);
    else if (rests && watch)
        say_gone(m, watch);
    else if (limit && solve->ratio > 0 && tl_is_damped(m))
        say_undecided(m, solve, r);
}

tl_status tl_solve_run(tl_model *m, const tl_solve *solve, tl_solve_result *wanted)
{
    tl_solve_result unread, *const result = wanted ? wanted : &unread;
    tl_rows_tidy(m);
    *result = (tl_solve_result){.reason = TL_SOLVE_CYCLES, .time = m->time, .measure = solve->measure};
    if (m->running || m->reading)
        return tl_fail(&m->error, TL_E_STATE, "cycle and solve cannot be called from a function that a run has called");
    progress p = {solve, result, m->cycles, m->time, tl_clock()};
    tl_watch *watch = NULL;
    if ((solve->ratio > 0 || solve->stop_at_failure) && !(watch = watch_begin(m)))
        return tl_fail_memory(&m->error);
    atomic_store(&m->interrupted, false);
    tl_remark_units(m);
    tl_status status = TL_OK;
    while (result->cycles < solve->max_cycles) {
        if (solve->between && !call_between(m, &p, &watch, &status))
            break;
        status = tl_step(m);
        if (status != TL_OK)
            break;
        measure(m, &p);
        if (watch)
            m->cycle->failing = result->failing = watch_step(watch, m);
        if (solve->ratio > 0)
            m->cycle->rest_ratio = solve->ratio;
        if (ended(m, &p, &status))
            break;
    }
    if (status == TL_OK)
        say_end(m, solve, watch, result);
    if (status == TL_OK && result->failing && watch)
        status = list_failing(watch, m);
    watch_end(watch);
    return status;
}

/* Other steps than those of a relaxation that a save was made in. */
static void end_relaxation(tl_model *m)
{
    if (m->relaxing && !m->running && !m->reading)
        tl_settle_end(m);
}

tl_status tl_model_solve(tl_model *m, const tl_solve *given, tl_solve_result *result)
{
    tl_solve solve;
    tl_status status = TL_OPTIONS_READ(tl_solve, given, &solve, &m->error);
    if (status != TL_OK)
        return status;
    const bool waits_for_rest = solve.ratio > 0 || solve.velocity > 0;
    if (!m->damping && waits_for_rest && tl_model_says(m, TL_REMARK_UNDAMPED))
        tl_model_say(
            m,
            "solve: the model has no damping and may never come to rest; %s finds where it rests, %s damps its motion",
            tl_words(m, "model:relax{}", "tl_model_relax()"),
            tl_words(m, "model:damping(\"local\")", "tl_model_damping() with \"local\""));
    end_relaxation(m);
    return tl_solve_run(m, &solve, result);
}

tl_status tl_model_cycle_calling(tl_model *m, int64_t cycles, const tl_solve *calls, tl_solve_result *result)
{
    if (cycles < 0)
        return tl_fail(&m->error, TL_E_ARGUMENT, "cycle: %lld must be >= 0", (long long)cycles);
    tl_solve plain = calls ? *calls : tl_solve_default();
    plain.max_cycles = cycles;
    plain.max_time = plain.velocity = NAN;
    plain.measure = TL_RATIO_LOCAL;
    plain.ratio = plain.stop_at_failure = 0;
    end_relaxation(m);
    return tl_solve_run(m, &plain, result);
}

tl_status tl_model_cycle(tl_model *m, int64_t cycles, tl_solve_result *result)
{
    return tl_model_cycle_calling(m, cycles, NULL, result);
}
