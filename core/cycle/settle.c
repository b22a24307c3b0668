/* settle.c - how a relaxation brings the bodies of a step nearer to rest.
 *
 * Kinetic stops come first: nothing is braked until the forces of all bodies together work against the motion, and then
 * every body is stopped (P. A. Cundall 1976; M. R. Barnes, Computers and Structures 30 (1988) 685-695). Each body has
 * the inertia that suits one step, and the step is as long as it may be. So blocks find each other, slip and open by
 * steps that laws can follow. What next to nothing bears goes its own way: it falls, by its own mass (loose.h), and is
 * stopped where it lands. In a trial of a factor, and where some block is deformable, what slides on goes on, too.
 *
 * What is soft among what is stiff takes the root of the ratio of both in steps: a joint that presses on its edge,
 * columns, slivers. Once no body is far from equilibrium, leaps are tried: motions that would bring equilibrium by the
 * secants of the contacts (secants.c). A leap is a step like any other: laws follow the motion, and the next forces say
 * how good it was. With E the energy,
 *
 *     ratio = fall of E / fall expected = (F_0 + F_1).s / 2 over F_0.s - s.K s / 2
 *
 * With a ratio near 1 the next one is held less, with a bad one more (Levenberg and Marquardt). Where leaps are too
 * short, since contacts slip, the next one takes along some of the last motion (Polyak). No body is carried
 * farther at once than some of the closures that its contacts have: friction, opening and bonds follow their path.
 * Leaps end when they bring the model no nearer to rest. Then stops have their turn, each time for longer. Many bodies
 * leap along conjugate ways instead (conjugate.c).
 *
 * A leap is put as damping. With alpha = 2 / h (23) takes all of the old velocity and half of the kick. The damping's
 * force makes of it what is wanted. */
#include "cycle/settle.h"

#include "base/columns.h"
#include "contact/detection.h"
#include "cycle/conjugate.h"
#include "cycle/contact_beta.h"
#include "cycle/cycle_data.h"
#include "cycle/energy.h"
#include "cycle/gridpoints.h"
#include "cycle/loose.h"
#include "cycle/rest.h"
#include "cycle/secants.h"

#include <math.h>
#include <string.h>

/* Tolerance: motion over a block's size up to which geometry is kept: this times the average ratio, at most the
 * second. */
#define STILL_PER_RATIO 0.1
#define STILL_MOST 1e-3
/* Tolerance: local ratio at which the next part of the loads comes on. */
#define NEXT_PART 1e-3
/* Cost only: of more bodies than these the leaps are conjugate ways: what secants ask of all contacts then takes longer
 * than the steps that they spare. */
#define MOST_BY_SECANTS 6000
/* Tolerance: local ratio from which leaps are tried. */
#define NEAR_REST 0.02
/* Tolerance: the same of many bodies. */
#define MANY_NEAR_REST 0.1
/* Tolerance: average ratio below which the model as a whole is near rest. */
#define CALM 1e-2
/* Tolerance: way in a step that a body may fall by its own mass once something has borne it, over that of its landing;
 * and what each further step makes of it. */
#define LANDING 0.1
#define FALL_GROWTH 1.1
/* Cost only: stops before the first leap, between two spells of leaps, and leaps of a spell; the latter grow. */
#define FIRST_STOPS 30
#define STOPS 30
#define LEAPS 200
#define GROWTH 1.5
/* Cost only: growth of the span of stops after leaps that brought nothing. */
#define IDLE_GROWTH 4.0
/* Limit: of these spans. */
#define MOST_SPAN 1000000
/* Tolerance: the hold of a leap: at first, at least, and above which leaps are no better than stops. */
#define HOLD_FIRST 1.0
#define HOLD_LEAST 1e-9
#define HOLD_MOST 2.0
/* Tolerance: ratio below which a leap is bad, above which it is good, and what that makes of the hold. */
#define BAD 0.25
#define GOOD 0.75
#define MORE_HOLD 8.0
#define LESS_HOLD 0.25
/* Tolerance: work left by a leap beyond what was expected, over what it began with. From then on the next leap takes
 * more of the last motion along; and the largest share of that motion. */
#define SOFTER 0.5
#define MOST_MOMENTUM 0.9
/* Tolerance: leaps in a row that may bring nothing: neither half of the unbalanced force, nor a good one that was
 * made shorter. */
#define MOST_IDLE 15
#define NEARER 0.5
#define IDLE_RATIO 0.5
/* Tolerance: leaps of many bodies in a row that may bring nothing: each is one iteration. */
#define MOST_IDLE_WAYS 60
/* Tolerance: way over its radius that leaps may carry a body in all. What goes farther may slide or topple: that is for
 * stops to tell. */
#define MOST_CARRIED 0.02
/* Tolerance: closures, of the body or the mean one, by which a leap carries a body at the most. */
#define CLOSURES 50.0

/* Tolerance: ways in a row in one direction after which a body goes on where others stop; its speed over the highest of
 * these ways; and cos of the largest change of direction. What settles becomes slower from stop to stop. */
#define WAYS 6
#define AS_FAST 0.3
#define ONE_WAY 0.7

void tl_settle_begin(tl_model *m, int64_t load_steps)
{
    for (size_t body = 0; body < m->bodies.table.rows; body++) {
        m->bodies.fall[body] = INFINITY;
        if (m->bodies.going)
            m->bodies.going[body] = (tl_going){.from = m->bodies.pose[body].u};
    }
    if (tl_contact_beta(m) > 0)
        tl_contact_beta_changes(m);
    m->relaxing = true;
    if (m->detect)
        tl_balance_note(m); /* the balance of the motion so far is none of a relaxation's */
    m->cycle->settling = (tl_settling){.share = 1 / (double)load_steps,
                                       .part = 1,
                                       .parts = load_steps,
                                       .stops = FIRST_STOPS,
                                       .stop_span = STOPS,
                                       .leap_span = LEAPS,
                                       .hold = HOLD_FIRST};
}

void tl_settle_end(tl_model *m)
{
    tl_bodies *b = &m->bodies;
    for (size_t i = 0; i < b->table.rows; i++) {
        b->v[i] = tl_v3_sub(b->v[i], tl_free_part(b->v[i], b->fixed[i]));
        if (!(b->fixed[i] & TL_FIX_ROTATION))
            b->w[i] = tl_v3(0, 0, 0);
    }
    tl_gridpoints_stop(m);
    m->relaxing = false;
    if (tl_contact_beta(m) > 0)
        tl_contact_beta_changes(m);
    m->still = 0;
    m->dt = 0; /* what follows begins from rest */
    struct tl_cycle *c = m->cycle;
    if (!c) /* a file may lack it */
        return;
    c->secant_count = c->conjugate_count = 0;
    c->dt = c->mass_scale = 0; /* step, masses and rates are others from now on */
    c->stiffness_rates.version = 0;
}

void tl_settle_loads(tl_model *m)
{
    tl_settling *s = &m->cycle->settling;
    if (s->part >= s->parts || !tl_at_rest(m, TL_RATIO_LOCAL, NEXT_PART))
        return;
    s->part++;
    s->share = s->part < s->parts ? (double)s->part / (double)s->parts : 1;
    s->came = m->cycles;
}

bool tl_settle_bears_all(const tl_model *m)
{
    const tl_settling *s = &m->cycle->settling;
    return s->part >= s->parts && s->came < m->cycles;
}

static bool may_leap(const tl_model *m)
{
    return !tl_model_deforms(m);
}

static bool goes_by_secants(const tl_model *m)
{
    return m->bodies.table.rows <= MOST_BY_SECANTS;
}

bool tl_settle_prepare(tl_model *m)
{
    if (!m->relaxing || !may_leap(m))
        return true;
    return goes_by_secants(m) ? tl_secants_prepare(m) : tl_conjugate_prepare(m);
}

/* ---------------------------------------------------------------- stops ------------------ */

static void put_none(struct tl_cycle *c, double alpha)
{
    for (size_t i = 0; i < c->table.rows; i++)
        c->alpha[i] = alpha;
    for (int k = 0; k < 3; k++) {
        memset(c->damping_force[k], 0, c->table.rows * sizeof *c->damping_force[k]);
        memset(c->damping_moment[k], 0, c->table.rows * sizeof *c->damping_moment[k]);
    }
}

/* The velocities so far are lost, with half of the kick: what follows begins from rest. */
static double all_lost(const tl_model *m, double dt)
{
    return 2 / (0.5 * (m->dt + dt));
}

static void stop_all(tl_model *m, double dt)
{
    put_none(m->cycle, all_lost(m, dt));
}

/* Whether a body goes on where all others stop: it has gone one way from stop to stop, about as fast as ever; then as
 * long as it becomes faster. */
static bool goes_on(const tl_model *m, uint32_t body, tl_vec3 v)
{
    tl_going *of = &m->bodies.going[body];
    const tl_vec3 at = m->bodies.pose[body].u, way = tl_v3_sub(at, of->from);
    const double speed = tl_v3_norm(v), along = tl_v3_dot(way, of->way);
    const bool same = along > ONE_WAY * tl_v3_norm(way) * tl_v3_norm(of->way) && tl_v3_dot(v, way) > 0;
    const int32_t ways = same ? of->ways + 1 : 0;
    const double fastest = same ? fmax(of->fastest, speed) : speed;
    const bool on = of->on ? same && speed >= of->speed : ways >= WAYS && speed >= AS_FAST * fastest;
    *of = (tl_going){at, way, speed, fastest, ways, on};
    return on;
}

/* Finds what goes on where all others stop. Of rigid bodies its alpha is left at 0. */
static void let_go_on(tl_model *m, double lost)
{
    const tl_bodies *b = &m->bodies;
    for (uint32_t body = 0; body < b->table.rows; body++) {
        tl_mesh_motion *of = b->mesh[body] ? &m->zones->motion[b->mesh[body] - 1] : NULL;
        const bool held = !of && b->fixed[body] == TL_FIX_ALL;
        const bool on = !held && goes_on(m, body, of ? of->velocity : b->v[body]);
        if (of)
            of->goes_on = on;
        m->cycle->alpha[body] = on ? 0 : lost;
    }
}

/* Stops all but loose bodies when these together work against the motion, and each loose one when it does. Where some
 * block is deformable, or a trial asks for it, what slides on goes on. */
static void move_on(tl_model *m, double dt)
{
    struct tl_cycle *c = m->cycle;
    const tl_bodies *b = &m->bodies;
    const double gravity = tl_v3_norm(m->config.gravity), lost = all_lost(m, dt);
    const bool stop = c->sums.power < 0, deforms = tl_model_deforms(m);
    put_none(c, stop ? lost : 0);
    if (stop && m->bodies.going && (deforms || c->slides_on))
        let_go_on(m, lost);
    if (deforms)
        tl_gridpoints_brake(m, stop, lost, 0.5 * (m->dt + dt));
    for (uint32_t body = 0; c->settling.calm && body < b->table.rows; body++)
        if (b->fixed[body] != TL_FIX_ALL && tl_body_is_loose(m, body, tl_weight_of(b, body, gravity)))
            c->alpha[body] = tl_body_power(m, body) < 0 ? lost : 0;
}

/* ---------------------------------------------------------------- leaps ------------------ */

static double way_of(const tl_model *m, uint32_t body)
{
    const double *x = m->cycle->leap[body].motion;
    double way2 = x[0] * x[0] + x[1] * x[1] + x[2] * x[2], turn2 = x[3] * x[3] + x[4] * x[4] + x[5] * x[5];
    return sqrt(way2) + m->bodies.radius[body] * sqrt(turn2);
}

/* What a body bears, N, over the stiffness that its inertia stands for, N/m. */
typedef struct closure {
    double bears, size;
} closure;

static closure closure_of(const tl_model *m, uint32_t body, double dt, double gravity)
{
    const double stiffness = m->bodies.mass[body] * tl_inertia_scale(m->cycle, body) / (dt * dt);
    const double bears = tl_borne(m, body, tl_weight_of(&m->bodies, body, gravity));
    return (closure){bears, bears / stiffness};
}

/* The mean closure of the free bodies, by what they bear. */
static double mean_closure(const tl_model *m, double dt, double gravity)
{
    tl_addends closures = {.count = 0}, bears = {.count = 0};
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        const bool held = m->bodies.fixed[body] == TL_FIX_ALL;
        const closure of = held ? (closure){0, 0} : closure_of(m, body, dt, gravity);
        tl_addends_put(&closures, of.bears * of.size);
        tl_addends_put(&bears, of.bears);
    }
    const double all = tl_addends_sum(&bears);
    return all > 0 ? tl_addends_sum(&closures) / all : 0;
}

/* Makes the motions shorter where one would go too far: those of loose bodies by themselves, others all alike. Returns
 * the part that is left. */
static double shorten(const tl_model *m, double dt)
{
    const double gravity = tl_v3_norm(m->config.gravity), mean = mean_closure(m, dt, gravity);
    double part = 1;
    for (int loose = 0; loose < 2; loose++)
        for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
            if (m->bodies.fixed[body] == TL_FIX_ALL)
                continue;
            const closure of = closure_of(m, body, dt, gravity);
            const double most = CLOSURES * fmax(of.size, mean), way = way_of(m, body);
            if (!(part * way > most) ||
                tl_body_is_loose(m, body, tl_weight_of(&m->bodies, body, gravity)) != (bool)loose)
                continue;
            if (!loose)
                part = most / way;
            for (int k = 0; loose && k < 6; k++)
                m->cycle->leap[body].motion[k] *= most / (part * way);
        }
    return part;
}

/* Notes what the leap is to bring: the part of the motions found that is made. */
static void expect(tl_model *m, double part)
{
    tl_settling *s = &m->cycle->settling;
    tl_addends power = {.count = 0}, held = {.count = 0};
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        const bool free = m->bodies.fixed[body] != TL_FIX_ALL;
        const tl_leap_body *of = &m->cycle->leap[body];
        const tl_vec3 f = m->bodies.force[body], t = m->bodies.moment[body];
        const double *x = of->motion;
        double by = f.x * x[0] + f.y * x[1] + f.z * x[2] + t.x * x[3] + t.y * x[4] + t.z * x[5], more = 0;
        for (int k = 0; k < 6; k++)
            more += of->hold[k] * x[k] * x[k];
        tl_addends_put(&power, free ? by : 0);
        tl_addends_put(&held, free ? more : 0);
    }
    const double all = tl_addends_sum(&power);
    s->power = part * all;
    s->expected = part * all - 0.5 * part * part * (all - tl_addends_sum(&held));
    s->limited = part < 1;
    double farthest = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        if (m->bodies.fixed[body] != TL_FIX_ALL)
            farthest = fmax(farthest, part * way_of(m, body) / m->bodies.radius[body]);
    s->carried += farthest;
}

void tl_settle_move(tl_model *m, uint32_t body, tl_vec3 v, tl_vec3 w, double dt)
{
    struct tl_cycle *c = m->cycle;
    const tl_bodies *b = &m->bodies;
    const double mass = b->mass[body] * tl_step_scale(m, body), turning = tl_turn_scale(c, body);
    const double h = 0.5 * (m->dt + dt);
    const tl_quat to_model = tl_q_mul(b->q[body], b->axes[body]);
    const tl_vec3 moments = tl_moments_of(m, body), own = tl_q_rotate(tl_q_conj(to_model), w);
    tl_vec3 spin = tl_q_rotate(to_model, tl_v3(moments.x * own.x, moments.y * own.y, moments.z * own.z));
    if (m->config.rotation == TL_ROTATION_PAPER)
        spin = tl_v3_scale(moments.x, w);
    tl_wrench by = {b->force[body], b->moment[body]};
    if (tl_loads_lag(m)) {
        const tl_wrench lag = tl_load_lag(m, body);
        by = (tl_wrench){tl_v3_sub(by.force, lag.force), tl_v3_sub(by.moment, lag.moment)};
    }
    c->alpha[body] = all_lost(m, dt);
    tl_columns_put(c->damping_force, body, tl_v3_sub(tl_v3_scale(2 * mass / h, v), by.force));
    tl_columns_put(c->damping_moment, body, tl_v3_sub(tl_v3_scale(2 * turning / h, spin), by.moment));
}

/* Adds a share of the motion of the last leap. */
static void go_on(tl_model *m, double share)
{
    const tl_bodies *b = &m->bodies;
    for (uint32_t body = 0; share > 0 && body < b->table.rows; body++) {
        double *x = m->cycle->leap[body].motion;
        const double by = share * m->dt;
        const double last[6] = {b->v[body].x, b->v[body].y, b->v[body].z, b->w[body].x, b->w[body].y, b->w[body].z};
        for (int k = 0; k < 6 && b->fixed[body] != TL_FIX_ALL; k++)
            x[k] += by * last[k];
    }
}

static void leap(tl_model *m, double dt)
{
    struct tl_cycle *c = m->cycle;
    if (goes_by_secants(m)) {
        tl_leap_find(m, dt, c->settling.hold);
        go_on(m, c->settling.momentum);
    } else
        tl_conjugate_find(m, dt);
    const double part = shorten(m, dt);
    expect(m, part);
    if (!goes_by_secants(m) && part < 1)
        tl_conjugate_begin(m); /* what was made is no way that is known */
    put_none(c, all_lost(m, dt));
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        const double *x = c->leap[body].motion, by = part / dt;
        if (m->bodies.fixed[body] != TL_FIX_ALL)
            tl_settle_move(m, body, tl_v3(by * x[0], by * x[1], by * x[2]), tl_v3(by * x[3], by * x[4], by * x[5]), dt);
    }
}

/* Whether the last leap of many bodies leaves reason for another. */
static bool go_conjugate(const struct tl_cycle *c, tl_settling *s)
{
    if (c->sums.unbalanced < NEARER * s->goal) {
        s->goal = c->sums.unbalanced;
        s->gained = 1;
        s->idle = 0;
    } else
        s->idle++;
    return s->idle <= MOST_IDLE_WAYS && c->sums.worst_ratio < TL_LOOSE && s->carried < MOST_CARRIED && --s->leaps > 0;
}

/* Whether the last leap leaves reason for another. */
static bool leap_again(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    tl_settling *s = &c->settling;
    if (!goes_by_secants(m))
        return go_conjugate(c, s);
    const double after = m->dt * c->sums.power; /* work of the forces that are left, were the leap made again */
    if (after < 0)
        s->momentum = 0;
    else if (after > 2 * s->expected - s->power + SOFTER * s->power)
        s->momentum = fmin(1 - 0.5 * (1 - s->momentum), MOST_MOMENTUM);
    const double fall = 0.5 * (s->power + after), ratio = s->expected > 0 ? fall / s->expected : -1;
    const bool nearer = c->sums.unbalanced < NEARER * s->goal;
    s->hold *= ratio < BAD ? MORE_HOLD : ratio > GOOD ? LESS_HOLD : 1;
    s->hold = fmax(s->hold, HOLD_LEAST);
    if (nearer) {
        s->goal = c->sums.unbalanced;
        s->gained = 1;
    }
    if (nearer || (s->limited && ratio >= IDLE_RATIO))
        s->idle = nearer ? 0 : s->idle;
    else
        s->idle++;
    return s->idle <= MOST_IDLE && s->hold <= HOLD_MOST && s->carried < MOST_CARRIED && --s->leaps > 0;
}

/* After a spell of leaps. */
static void rest_from_leaps(tl_settling *s)
{
    s->leapt = false;
    s->stop_span = (int64_t)fmin((s->gained ? GROWTH : IDLE_GROWTH) * (double)s->stop_span, MOST_SPAN);
    s->stops = s->stop_span;
    s->leap_span = (int64_t)fmin(GROWTH * (double)s->leap_span, MOST_SPAN);
}

static bool begin_leaps(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    tl_settling *s = &c->settling;
    if (s->stops > 0)
        s->stops--;
    const bool secants = goes_by_secants(m);
    if (s->stops > 0 || !(c->sums.worst_ratio < (secants ? NEAR_REST : MANY_NEAR_REST)) || !may_leap(m) ||
        tl_loads_lag(m) || s->carried >= MOST_CARRIED)
        return false;
    if (!secants && !(c->sums.power < 0)) /* a stop loses no motion that goes on */
        return false;
    s->leapt = true;
    s->leaps = s->leap_span;
    s->idle = 0;
    s->gained = 0;
    s->hold = HOLD_FIRST;
    s->momentum = 0;
    s->goal = c->sums.unbalanced;
    if (secants)
        tl_secants_begin(m);
    else
        tl_conjugate_begin(m);
    return true;
}

/* What has landed comes down by smaller steps when it falls again, and by larger ones the longer it falls. */
static void note_landings(tl_model *m, double dt)
{
    const tl_bodies *b = &m->bodies;
    const double gravity = tl_v3_norm(m->config.gravity);
    for (uint32_t body = 0; body < b->table.rows; body++) {
        const double weight = tl_weight_of(b, body, gravity), way = tl_v3_norm(b->v[body]) * m->dt;
        const double least = weight * dt * dt / (b->mass[body] * tl_inertia_scale(m->cycle, body));
        if (tl_body_falls(m, body, weight))
            b->fall[body] *= FALL_GROWTH;
        else if (way * LANDING < b->fall[body])
            b->fall[body] = fmax(way * LANDING, least);
    }
}

tl_status tl_settle(tl_model *m, double dt)
{
    struct tl_cycle *c = m->cycle;
    tl_settling *s = &c->settling;
    const double ratio = tl_model_balance(m).ratio;
    m->still = isfinite(ratio) ? fmin(STILL_PER_RATIO * ratio, STILL_MOST) : 0;
    if (!(dt > 0))
        return TL_OK;
    note_landings(m, dt);
    if (s->leapt) {
        if (goes_by_secants(m))
            tl_secants_follow(m);
        if (leap_again(m) && !tl_loads_lag(m)) {
            leap(m, dt);
            return TL_OK;
        }
        rest_from_leaps(s);
        stop_all(m, dt);
        return TL_OK;
    }
    if (begin_leaps(m)) {
        s->calm = false;
        leap(m, dt);
        return TL_OK;
    }
    move_on(m, dt);
    s->calm = ratio < CALM;
    return TL_OK;
}
