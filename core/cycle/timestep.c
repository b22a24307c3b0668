/* timestep.c - the stable time step.
 *
 * "paper": dt = FRAC 2 (M_min / (2 K_max))^1/2, K_max the largest max(kn, ks) A_c of a contact (27).
 * "body":  dt = FRAC 2 (1 / (2 rate))^1/2 with the highest rate of a body: no motion of a body and its
 *          neighbours is faster, so FRAC 1 is stable.
 * "balance": as "body", with as much of the step as the energy balance allows.
 * By either rule no body's step is longer than its largest face allows, whatever areas its contacts have.
 * A step that would carry or turn a block too far is made shorter (limits.c). The one in use stays, for the steps after
 * that. Mass scaling gives every free body the bound of the one that has the most. With a step asked for it adds
 * inertia to the bodies that need it (added_mass.c), and takes that step. */
#include "cycle/timestep.h"

#include "base/columns.h"
#include "contact/sides.h"
#include "cycle/added_mass.h"
#include "cycle/contact_beta.h"
#include "cycle/energy.h"
#include "cycle/gridpoint.h"
#include "cycle/gridpoints.h"
#include "cycle/limits.h"
#include "cycle/prepare.h"
#include "cycle/remarks.h"
#include "cycle/sliver.h"
#include "detect/detect.h"
#include "element/act.h"
#include "element/follow.h"
#include "force/joint_laws.h"
#include "model/options.h"

#include <stdio.h>
#include <string.h>
#include <talus/zones.h>

/* ---------------------------------------------------------------- rates -------------------
 *
 * What each body asks of the time step: its rate.
 *
 * The rate of a body is sum k (1/M + r^2/I) over its contact points: k the stiffness of a point at distance r from the
 * centroid, I the smallest moment of inertia. Twice the highest rate is no less than the square of any frequency.
 * Mass scaling has two rates instead: sum 2 k/M of the translation and sum 2 k r^2/I of the rotation. They scale masses
 * and moments of inertia each by itself. Since |v + w r|^2 <= 2 (|v|^2 + |w r|^2), twice the higher one is no less
 * either. So what turns easily, as a slender block, is not made too heavy to move.
 *
 * A step that shrinks while a body lands costs energy, so a body finds the step that its landing needs beforehand: no
 * rate is below that of the body standing on its largest face. The law is the stiffest of its contacts or, without a
 * contact, of the model. A part of that is enough where it stands on corners or edges, with overlaps o, and these go on
 * with a velocity v. The part is the further overlap v / omega over o, omega^2 being the rate on the face, within FLOOR
 * and 1. So a contact whose area vanishes, or that is about to be another, never makes the step long. The stiffness of
 * corners and edges counts as it will be when they are pressed in twice as deep.
 *
 * Rates are kept from step to step and made anew where contacts have changed. Where nothing moves by more than areas
 * are reused for, they cost nothing. Who asks for the rates above some limit only is spared most of the rest: a body
 * asks for no more than it would with the areas of its contacts as far away as its farthest corner. Kept rates follow
 * from the contacts as they were when the body was rated, not as they are: where the step follows from them they are
 * part of the model's state. */

/* Tolerance: part of its largest face that a body stands on at least, if it rests on corners and edges. A longer step
 * would shrink while it lands. */
#define FLOOR 0.15
/* Tolerance: steps after which mass scaling rates all bodies again, even when no contact has come or gone: areas may
 * have grown. */
#define RECHECK_STEPS 64

/* The stiffness of the stiffest law, Pa/m. */
static double stiffest_law(const tl_model *m)
{
    double k = 0;
    for (size_t i = 0; i < m->joint_law_count; i++)
        k = fmax(k, tl_law_stiffness(&m->joint_laws[i]));
    return k;
}

/* ---------------------------------------------------------------- search ----------------- */

/* A search for the row of the largest value: user data of a parallel loop, and the first member of what a search adds
 * to it. Of rows with equal values the first one counts, whichever thread took it. */
typedef struct row_search {
    tl_model *m;
    tl_row_value found[TL_MAX_THREADS];
} row_search;

static void keep_extreme(tl_row_value *kept, tl_row_value other)
{
    if (other.value > kept->value || (other.value == kept->value && other.row < kept->row))
        *kept = other;
}

static tl_row_value row_search_run(row_search *s, size_t rows, size_t chunk, tl_range_fn range)
{
    unsigned threads = tl_pool_threads(s->m->pool);
    for (unsigned t = 0; t < threads; t++)
        s->found[t] = (tl_row_value){-INFINITY, TL_NO_ROW};
    tl_parallel_for(s->m->pool, rows, chunk, range, s);
    for (unsigned t = 1; t < threads; t++)
        keep_extreme(&s->found[0], s->found[t]);
    return s->found[0];
}

/* ---------------------------------------------------------------- areas ------------------ */

/* 1 over mass and smallest moment of inertia; 0 for a rotation that is held. */
typedef struct inverse_inertia {
    double mass, moment;
} inverse_inertia;

static inverse_inertia inverse_of(const tl_model *m, uint32_t body)
{
    const tl_bodies *b = &m->bodies;
    tl_vec3 i = tl_moments_of(m, body);
    double least = fmin(i.x, fmin(i.y, i.z));
    return (inverse_inertia){1 / b->mass[body], b->fixed[body] & TL_FIX_ROTATION ? 0 : 1 / least};
}

static double rate_of(tl_spread on, inverse_inertia per)
{
    return on.sum * per.mass + on.r2 * per.moment;
}

/* A triangle, about the zero of its frame. */
static tl_spread triangle(tl_vec3 a, tl_vec3 b, tl_vec3 c)
{
    double area = 0.5 * tl_v3_norm(tl_v3_cross(tl_v3_sub(b, a), tl_v3_sub(c, a)));
    double squares = tl_v3_norm2(a) + tl_v3_norm2(b) + tl_v3_norm2(c) + tl_v3_norm2(tl_v3_add(a, tl_v3_add(b, c)));
    return (tl_spread){area, area * squares / 12};
}

static tl_spread face_of(const tl_poly *shape, uint32_t face)
{
    const uint16_t *loop = shape->loop + shape->start[face];
    tl_spread out = {0, 0};
    for (uint32_t i = 2; i < tl_poly_face_size(shape, face); i++) {
        tl_spread next = triangle(shape->vertex[loop[0]], shape->vertex[loop[i - 1]], shape->vertex[loop[i]]);
        out.sum += next.sum;
        out.r2 += next.r2;
    }
    return out;
}

/* Tolerance: area over the largest one by which another face is less than that: above roundings of a turned shape.
 * Test: lua/test_timestep. */
#define AS_LARGE 1e-6

/* The largest face of a body that does not lie on another of its blocks; of several the arms of the farthest. */
static tl_spread largest_face(const tl_model *m, uint32_t body)
{
    tl_spread largest = {0, 0};
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        const tl_poly *shape = m->blocks.shape[tl_body_blocks(m, body)[k]];
        for (uint32_t f = 0; f < shape->face_count; f++) {
            tl_spread face = shape->covered[f] ? (tl_spread){0, 0} : face_of(shape, f);
            if (face.sum > (1 + AS_LARGE) * largest.sum)
                largest = face;
            else if (face.sum > (1 - AS_LARGE) * largest.sum)
                largest.r2 = fmax(largest.r2, face.r2);
        }
    }
    return largest;
}

/* ---------------------------------------------------------------- one body --------------- */

static tl_holding holding_of(const tl_model *m, uint32_t body)
{
    tl_holding sum = {.law = 0};
    for (tl_contributors with = m->cycle->contributor; *with; with++)
        if ((*with)->hold)
            (*with)->hold(m, body, tl_rates_points(m), &sum);
    return sum;
}

/* A bound of that which is found faster. */
static tl_holding most_holding_of(const tl_model *m, uint32_t body)
{
    tl_holding sum = {.law = 0};
    for (tl_contributors with = m->cycle->contributor; *with; with++)
        if ((*with)->hold_most)
            (*with)->hold_most(m, body, &sum);
        else if ((*with)->hold)
            (*with)->hold(m, body, true, &sum);
    return sum;
}

static double approach_of(const tl_model *m, uint32_t body)
{
    double most = 0;
    for (tl_contributors with = m->cycle->contributor; *with; with++)
        most = fmax(most, (*with)->approach ? (*with)->approach(m, body) : 0);
    return most;
}

static double law_on_face(tl_holding of, double stiffest)
{
    return of.law > 0 ? of.law : stiffest;
}

/* The part of its largest face on which a body stands at least, for the rate on all of it. */
static double least_part(const tl_model *m, uint32_t body, const tl_holding *of, double face)
{
    double more = of->presses ? approach_of(m, body) / sqrt(face) : 1;
    return fmin(fmax(more, FLOOR), 1);
}

/* What a body asks of the step: in all or, with mass scaling, by translation and by rotation, each for itself. */
typedef struct step_rates {
    double rate, turn;
} step_rates;

/* ---------------------------------------------------------------- dampers ---------------- */

static double damping_factor(const tl_model *m)
{
    if (!m->damping || m->relaxing)
        return 1;
    const tl_damping_ops *ops = m->damping->ops;
    tl_enter(m->damping, "step_factor");
    double factor = ops->step_factor ? ops->step_factor(m->damping_self) : 1;
    tl_leave();
    return factor;
}

/* One over the critical step for which inertia is added, 1/s; 0: none is. */
static double added_share(const tl_model *m)
{
    return tl_adds_mass(m) ? tl_timestep_fraction(m) * damping_factor(m) / m->added_dt : 0;
}

/* What takes velocities of half a step ago, beside the springs of bodies. */
typedef struct damped_by {
    double beta;  /* s, of contacts: tl_contact_beta */
    double share; /* 1/s, one over the step that inertia is added for; 0: rates are for each body's own step */
} damped_by;

/* The rate at which contacts alone would ask for as short a step as springs of that rate and dampers. Let C be the sum
 * of c (1/M + r^2/I) and of beta times the rate of contacts. A step is stable if
 *
 *     rate dt^2 + 2 C dt <= 2,    so dt <= 2 / w,    w = (2 rate + C^2)^(1/2) + C
 *
 * and with contacts alone C = beta rate. So rate' = (rate + 2 C / dt) / (1 + 2 beta / dt). */
static double damped_rate(damped_by by, double rate, double c)
{
    if (by.share > 0)
        return (rate + 2 * by.share * c) / (1 + 2 * by.share * by.beta);
    const double w = sqrt(2 * rate + c * c) + c;
    return 0.5 * w * w / (1 + by.beta * w);
}

/* All but elements count as contacts: what a body stands on, if that is more, as well. */
static double damped_rate_of(damped_by by, double rate, const tl_holding *of, inverse_inertia per)
{
    const double c = rate_of(of->damping, per) + by.beta * (rate - rate_of(of->undamped, per));
    return damped_rate(by, rate, c);
}

/* With mass scaling of all each rate has its own dampers, and contacts are taken to hold all the rest; velocities do
 * not count in a relaxation. */
static step_rates damped_rates(const tl_model *m, damped_by by, step_rates of, const tl_holding *hold,
                               inverse_inertia per)
{
    const tl_spread c = hold->damping;
    if (m->relaxing || !(c.sum > 0 || (by.beta > 0 && hold->undamped.sum > 0)))
        return of;
    if (!tl_scales_all(m))
        return (step_rates){damped_rate_of(by, of.rate, hold, per), 0};
    const damped_by plain = {0, 0};
    return (step_rates){damped_rate(plain, of.rate, 2 * c.sum * per.mass),
                        damped_rate(plain, of.turn, 2 * c.r2 * per.moment)};
}

/* ---------------------------------------------------------------- one body's rates -------- */

static step_rates body_rate(const tl_model *m, uint32_t body, double stiffest, damped_by by)
{
    tl_holding of = holding_of(m, body);
    inverse_inertia per = inverse_of(m, body);
    double law = law_on_face(of, stiffest), face = law * m->bodies.face_rate[body];
    double turn = law * m->bodies.face_turn[body];
    double pushed = of.stiffness.sum * per.mass, turned = of.stiffness.r2 * per.moment;
    bool more = tl_scales_all(m) ? pushed < face - turn || turned < turn : pushed + turned < face;
    double part = more ? least_part(m, body, &of, face) : 0;
    step_rates all = {2 * fmax(pushed, part * (face - turn)), 2 * fmax(turned, part * turn)};
    if (!tl_scales_all(m))
        all = (step_rates){fmax(pushed + turned, part * face), 0};
    return damped_rates(m, by, all, &of, per);
}

/* What a body's rate is no higher than, from what is known of its contacts at once. */
static double most_rate(const tl_model *m, uint32_t body, double stiffest, damped_by by)
{
    tl_holding most = most_holding_of(m, body);
    double on_face = law_on_face(most, stiffest) * m->bodies.face_rate[body];
    const inverse_inertia per = inverse_of(m, body);
    const step_rates all = {fmax(rate_of(most.stiffness, per), on_face), 0};
    return damped_rates(m, by, all, &most, per).rate;
}

/* The stiffness that a body's rate comes from, N/m: of its contacts, or of the part of its largest face that counts. */
static double rate_stiffness(const tl_model *m, uint32_t body)
{
    tl_holding of = holding_of(m, body);
    double law = law_on_face(of, stiffest_law(m)), face = law * m->bodies.face_rate[body];
    double part = least_part(m, body, &of, face);
    if (rate_of(of.stiffness, inverse_of(m, body)) < part * face)
        return part * law * largest_face(m, body).sum;
    return of.stiffness.sum;
}

/* ---------------------------------------------------------------- all bodies ------------- */

/* The rates of bodies that stand on their largest face, for a stiffness per area of 1. Only those that have come or
 * changed are unknown. Where points do not count, as by the paper's rule, turning does not either. */
static void face_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const tl_model *m = user;
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        if (m->bodies.face_rate[body] != 0)
            continue;
        const tl_spread face = largest_face(m, body);
        const inverse_inertia per = inverse_of(m, body);
        m->bodies.face_rate[body] = tl_rates_points(m) ? rate_of(face, per) : face.sum * per.mass;
        m->bodies.face_turn[body] = face.r2 * per.moment;
    }
}

static void rates_count(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    struct tl_step_bounds *to = &c->step_bounds;
    struct tl_step_bounds now = {.version = 1 + m->structure + m->constraints,
                                 .constraints = m->constraints,
                                 .rotation = m->config.rotation,
                                 .points = tl_rates_points(m),
                                 .least_mass = INFINITY,
                                 .lightest = TL_NO_ROW};
    if (to->version == now.version && to->rotation == now.rotation && to->points == now.points)
        return;
    const tl_bodies *b = &m->bodies;
    c->all_held = true;
    for (uint32_t body = 0; body < b->table.rows && c->all_held; body++)
        c->all_held = b->fixed[body] == TL_FIX_ALL;
    c->all_held = c->all_held && !tl_model_deforms(m);
    for (uint32_t body = 0; body < b->table.rows; body++)
        if (tl_body_counts(m, body) && b->mass[body] < now.least_mass) {
            now.least_mass = b->mass[body];
            now.lightest = body;
        }
    bool anew = to->version == 0 || to->constraints != now.constraints || to->rotation != now.rotation ||
                to->points != now.points;
    if (anew && b->table.rows > 0)
        memset(b->face_rate, 0, b->table.rows * sizeof *b->face_rate);
    tl_parallel_for(m->pool, b->table.rows, TL_BODY_CHUNK, face_range, m);
    *to = now;
}

/* Which rates a search makes anew, and what it needs for that. */
typedef struct rate_search {
    row_search search;
    double stiffest; /* of the model's laws */
    damped_by by;
    bool kept; /* rates are kept in their column, and made anew only where contacts have changed */
    bool all;  /* all rates are made anew */
    /* of a body that asks for no more than this, what it asks for at the most will do; 0: of none */
    double known;
} rate_search;

static rate_search rate_search_of(tl_model *m, double known)
{
    return (rate_search){
        .search.m = m, .stiffest = stiffest_law(m), .by = {tl_contact_beta(m), added_share(m)}, .known = known};
}

static step_rates rate_for(const rate_search *s, uint32_t body)
{
    const tl_model *m = s->search.m;
    if (!tl_body_counts(m, body))
        return (step_rates){0, 0};
    double most = s->known > 0 ? most_rate(m, body, s->stiffest, s->by) : INFINITY;
    return most <= s->known ? (step_rates){most, 0} : body_rate(m, body, s->stiffest, s->by);
}

static void rate_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    rate_search *s = user;
    const tl_model *m = s->search.m;
    double *kept = m->cycle->rate;
    const uint8_t *touched = m->detect->touched;
    tl_row_value found = {-INFINITY, TL_NO_ROW};
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        step_rates of = {kept[body], m->cycle->turn_rate[body]};
        if (!s->kept || s->all || touched[body])
            of = rate_for(s, body);
        if (s->kept) {
            kept[body] = of.rate;
            m->cycle->turn_rate[body] = of.turn;
        }
        double value = tl_scales_all(m) ? -of.rate : of.rate;
        if (of.rate > 0 && value > found.value)
            found = (tl_row_value){value, body};
    }
    keep_extreme(&s->search.found[thread], found);
}

/* Notes the bodies whose contacts have points as new as that: TL_POINTS_*. true when there are any. */
static bool touch_new_points(tl_model *m, uint8_t least)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    bool any = false;
    for (size_t i = 0; i < c->table.rows; i++) {
        if (c->new_points[i] < least)
            continue;
        const tl_sides on = tl_contact_bodies(m, (uint32_t)i);
        d->touched[on.a] = d->touched[on.b] = true;
        any = true;
        if (c->point_count[i] == 0) /* the laws will not see it */
            c->new_points[i] = TL_POINTS_STAY;
    }
    return any;
}

/* Where contact points count, bodies are rated anew when a contact has points that were placed in this step. Else, and
 * with mass scaling, when one has gone or has other points; with mass scaling all are, now and then. */
static tl_row_value rates_keep(tl_model *m, double known)
{
    struct tl_cycle *c = m->cycle;
    tl_detect *d = m->detect;
    struct tl_stiffness_rates now = {.version = 1 + m->structure + m->constraints + m->laws +
                                                (m->elements ? m->elements->version : 0),
                                     .recheck = tl_scales_all(m) ? 1 + m->cycles / RECHECK_STEPS : 0,
                                     .rotation = m->config.rotation};
    bool all = now.version != c->stiffness_rates.version || now.recheck != c->stiffness_rates.recheck ||
               now.rotation != c->stiffness_rates.rotation || (known > 0 && !(c->dt > 0)); /* it may be another one */
    bool placed = tl_rates_points(m) && !tl_scales_all(m);
    bool some = touch_new_points(m, placed ? TL_POINTS_PLACED : TL_POINTS_OTHERS);
    if (all || some || d->any_touched) {
        rate_search s = rate_search_of(m, known);
        s.kept = true;
        s.all = all;
        tl_row_value found = row_search_run(&s.search, m->bodies.table.rows, TL_BODY_CHUNK, rate_range);
        memset(d->touched, 0, m->bodies.table.rows);
        d->any_touched = false;
        now.extreme = fabs(found.value);
        now.body = found.row;
        c->stiffness_rates = now;
    }
    return (tl_row_value){c->stiffness_rates.extreme, c->stiffness_rates.body};
}

void tl_rates_try(tl_model *m, double known, double *rate, double *turn_rate)
{
    struct tl_cycle *c = m->cycle;
    struct tl_stiffness_rates kept = c->stiffness_rates;
    double *own = c->rate, *own_turn = c->turn_rate;
    rates_count(m);
    for (size_t body = 0; body < m->bodies.table.rows; body++) {
        rate[body] = own[body];
        turn_rate[body] = own_turn[body];
    }
    c->rate = rate;
    c->turn_rate = turn_rate;
    rates_keep(m, known);
    c->rate = own;
    c->turn_rate = own_turn;
    c->stiffness_rates = kept;
}

tl_row_value tl_rates_anew(tl_model *m, double known)
{
    rate_search s = rate_search_of(m, known);
    tl_row_value found = row_search_run(&s.search, m->bodies.table.rows, TL_BODY_CHUNK, rate_range);
    return (tl_row_value){fabs(found.value), found.row};
}

/* ---------------------------------------------------------------- steps ------------------- */

/* Tolerance: the step in use is kept while the rule gives one between it and this many times it. A step that changes
 * all the time would cost accuracy. */
#define STEP_GROWTH 1.1

/* Limit: a given step is far too long from this many times the stable one on. The stable one is safe by up to the
 * square root of 2. */
#define TOO_LONG 2

/* Cost only: steps after which a given step is compared with the stable one again. */
#define COMPARE_EVERY 64

/* Tolerance: rate over that of a push from which on turning is what makes a body fast. Of a cube on a face it is some
 * 2.5. */
#define MOSTLY 4.0

/* M or I over 2 K of the body, or of the smallest mass and the stiffest contact, that controls the step. */
typedef struct bound {
    double least;
    uint32_t body;    /* row, or TL_NO_ROW: there is no bound */
    uint32_t contact; /* row of the contact, or TL_NO_ROW */
    double stiffness;
    uint32_t point; /* row of the gridpoint, or TL_NO_ROW */
} bound;

static const bound no_bound = {INFINITY, TL_NO_ROW, TL_NO_ROW, 0, TL_NO_ROW};

static void stiffest_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    row_search *s = user;
    const tl_model *m = s->m;
    const tl_contacts *c = &m->detect->contacts;
    tl_row_value found = {0, TL_NO_ROW};
    for (uint32_t i = (uint32_t)begin; i < end; i++) {
        if (c->law[i] == TL_NO_ROW)
            continue;
        double k = tl_law_stiffness(&m->joint_laws[c->law[i]]) * c->area[i];
        /* most are not stiffer: what is dearer to know is asked last */
        if (k > found.value &&
            (tl_body_counts(m, tl_contact_bodies(m, i).a) || tl_body_counts(m, tl_contact_bodies(m, i).b)))
            found = (tl_row_value){k, i};
    }
    keep_extreme(&s->found[thread], found);
}

/* M_min / (2 K_max), with K_max over contacts and nodes of free bodies, and less by the strongest damper of a node; no
 * bound where there is none. */
static bound paper_rule(tl_model *m)
{
    const struct tl_step_bounds *bounds = &m->cycle->step_bounds;
    row_search s = {.m = m};
    double c;
    tl_row_value stiffest = row_search_run(&s, m->detect->contacts.table.rows, TL_CONTACT_CHUNK, stiffest_range);
    const double node = tl_elements_stiffest(m, &c), beta = tl_contact_beta(m);
    c = m->relaxing ? 0 : c;
    const double damped = damped_rate((damped_by){beta, 0}, node / bounds->least_mass, c / bounds->least_mass);
    const double least = beta > 0 || c > 0 ? 0.5 / damped : bounds->least_mass / (2 * node);
    if (node + c > 0 && !(stiffest.row != TL_NO_ROW && bounds->least_mass / (2 * stiffest.value) <= least))
        return (bound){least, bounds->lightest, TL_NO_ROW, node, TL_NO_ROW};
    if (stiffest.row == TL_NO_ROW)
        return no_bound;
    return (bound){bounds->least_mass / (2 * stiffest.value), bounds->lightest, stiffest.row, stiffest.value,
                   TL_NO_ROW};
}

/* What controls the step. `report`: looked at anew, and the stiffness as well; nothing is kept then. */
static bound controlling(tl_model *m, bool report)
{
    tl_row_value fastest = report ? tl_rates_anew(m, 0) : rates_keep(m, 0);
    bound out = {INFINITY, fastest.row, TL_NO_ROW, 0, TL_NO_ROW};
    if (fastest.row != TL_NO_ROW)
        out.least = 0.5 / fastest.value;
    if (!tl_rates_points(m)) {
        bound paper = paper_rule(m);
        if (paper.least <= out.least)
            out = paper;
    }
    if (report && out.body != TL_NO_ROW && out.contact == TL_NO_ROW)
        out.stiffness = rate_stiffness(m, out.body);
    return out;
}

/* Tolerance: share of the critical step in a relaxation. */
#define RELAX_FRACTION 0.9

double tl_timestep_fraction(const tl_model *m)
{
    if (m->relaxing)
        return RELAX_FRACTION;
    if (!isnan(m->timestep.fraction))
        return m->timestep.fraction;
    const double fractions[] = {[TL_TIMESTEP_PAPER] = TL_PAPER_FRACTION,
                                [TL_TIMESTEP_BODY] = TL_BODY_FRACTION,
                                [TL_TIMESTEP_BALANCE] = TL_BALANCE_FRACTION};
    return fractions[m->timestep.rule];
}

/* What the rule balance leaves of the critical step: all of it while there is half of the error left, and half of it
 * when there is none. */
static double balance_factor(const tl_model *m)
{
    const double left = m->detect ? m->detect->balance_left : 0;
    return m->timestep.rule == TL_TIMESTEP_BALANCE && !m->relaxing ? 0.5 * (1 + left) : 1;
}

/* The longest stable step with damping of contacts, over the one without it, `critical` s: (1 + l^2)^(1/2) - l. */
static double contact_factor(const tl_model *m, double critical)
{
    const double beta = tl_contact_beta(m), l = critical > 0 ? beta / critical : 0;
    return beta > 0 ? 1 / (sqrt(1 + l * l) + l) : 1;
}

/* The highest rate that is stable at the step for which inertia is added, 1/s2. */
static double rate_limit(const tl_model *m)
{
    const double share = added_share(m);
    return 2 * share * share / (1 + 2 * tl_contact_beta(m) * share);
}

bool tl_rates_are_state(const tl_model *m, double *known)
{
    *known = tl_adds_mass(m) ? rate_limit(m) : 0;
    return tl_mass_scaled(m) || (tl_rates_points(m) && isnan(tl_given_step(m)));
}

/* A plugin's factor is its word: refused when it cannot be. */
static tl_status check_factor(tl_model *m)
{
    double factor = damping_factor(m);
    if (!(factor > 0 && factor <= 1))
        return tl_fail(&m->error, TL_E_PLUGIN, "damping '%s' gives the step factor %g, which is outside (0, 1]",
                       m->damping->name, factor);
    return TL_OK;
}

/* Why no step follows from the model. */
static tl_status no_step(tl_model *m, double dt)
{
    const char *way_out =
        tl_words(m, "a step with model:timestep{ dt = ... }", "a step with dt of tl_model_timestep()");
    const char *joint = tl_words(m, "model:joint(\"*\", ...)", "tl_joint_law()");
    if (m->joint_law_count == 0)
        return tl_fail(&m->error, TL_E_STATE,
                       "no time step follows from the model: no law says how stiff a contact is; set "
                       "a law with %s or %s",
                       joint, way_out);
    if (!(stiffest_law(m) > 0))
        return tl_fail(&m->error, TL_E_STATE,
                       "no time step follows from the model: kn and ks of all laws are 0; set a "
                       "stiffness with %s or %s",
                       joint, way_out);
    return tl_fail(&m->error, TL_E_STATE,
                   "no time step follows from the model: by its masses and stiffnesses it would be %g "
                   "s; check the units of density, sizes and kn, or set %s",
                   dt, way_out);
}

/* Notes whether the given step is far above the longest that is stable whatever the rule, that of the body with the
 * highest rate. Looks when there are more contacts than ever, and now and then: an impact lasts one such step. */
static void judge_step(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    size_t contacts = m->detect->contacts.table.rows;
    bool due = c->dt <= 0 || m->cycles % COMPARE_EVERY == 0 || contacts > c->contacts;
    c->contacts = contacts > c->contacts ? contacts : c->contacts;
    if (!due || c->all_held || tl_scales_all(m))
        return;
    double far_above = TOO_LONG / m->timestep.dt, bearable = 2 * far_above * far_above;
    bearable /= 1 + 2 * tl_contact_beta(m) * far_above;
    tl_row_value fastest = tl_rates_anew(m, bearable);
    double stable = 2 * sqrt(0.5 / fastest.value);
    stable *= contact_factor(m, stable);
    double zones = 2 * sqrt(tl_gridpoints_least(m));
    zones *= contact_factor(m, zones);
    c->long_step = (fastest.row != TL_NO_ROW && fastest.value > bearable) || m->timestep.dt > TOO_LONG * zones;
    if (!c->long_step || !tl_model_says(m, TL_REMARK_STEP))
        return;
    char name[64];
    const bool by_zones = fastest.row == TL_NO_ROW || zones < stable;
    const uint32_t point = by_zones ? m->zones->highest : TL_NO_ROW;
    if (by_zones)
        snprintf(name, sizeof name, "gridpoint %u of block %u", tl_gridpoint_name(m, point).number,
                 tl_gridpoint_name(m, point).body);
    else
        snprintf(name, sizeof name, "block %u", m->bodies.id[fastest.row]);
    stable = by_zones ? zones : stable;
    tl_model_say(m,
                 "timestep: dt = %g s is %.3g times the longest stable step, %.3g s, which %s sets: contact forces "
                 "will grow without bound; give a shorter one, or leave dt out",
                 m->timestep.dt, m->timestep.dt / stable, stable, name);
}

/* The step that inertia is added for, or a shorter one that is given as well. */
static tl_status choose_added(tl_model *m, double *dt, bool report)
{
    struct tl_cycle *c = m->cycle;
    double wanted = m->added_dt, given = tl_given_step(m);
    if (given > wanted)
        return tl_fail(&m->error, TL_E_STATE,
                       "timestep: dt = %g s is longer than %g s, the dt of mass_scaling; give one of "
                       "them only, or the longer one to mass_scaling",
                       given, wanted);
    if (!report) {
        const double limit = rate_limit(m), share = m->timestep.zone_fraction / tl_timestep_fraction(m);
        rates_keep(m, limit);
        tl_gridpoints_least(m); /* what holds each of them */
        tl_status status = tl_added_find(m, (tl_rate_limits){limit, 2 * share * share * limit});
        if (status != TL_OK)
            return status;
        c->mass_scale = 0;
        c->long_step = false;
    }
    *dt = c->dt = isnan(given) ? wanted : given;
    return TL_OK;
}

/* Without damping of contacts a share of the longest stable step has the bound share^2 times `own`. This is what comes
 * to it with damping, so that contact_factor gives that share. */
static double more_damped(const tl_model *m, double own, double share)
{
    const double critical = 2 * sqrt(own);
    return 0.5 * tl_contact_beta(m) * share * (1 - share) * critical * contact_factor(m, critical);
}

/* With what gridpoints ask for: `least` is a square of a step, over 4, for all of the critical step. Where they control
 * it `by`, which may be NULL, is told. */
static double with_zones(tl_model *m, double least, bound *by)
{
    const double own = tl_gridpoints_least(m), share = m->timestep.zone_fraction / tl_timestep_fraction(m);
    if (!isfinite(own))
        return least;
    const bool all = tl_scales_all(m);
    const double asked = all ? own : share * share * own + more_damped(m, own, share);
    if (isfinite(least) && (all ? least >= asked : least <= asked))
        return least;
    if (by) {
        const uint32_t point = all ? m->zones->lowest : m->zones->highest;
        const uint32_t body = m->zones->mesh[m->zones->points.mesh[point]].row;
        *by = (bound){asked, body, TL_NO_ROW, m->zones->points.holds[point], point};
    }
    return asked;
}

/* The step; 0 where nothing can move or does. A report gets `by`, what controls it, and leaves the inertia alone. */
static tl_status choose(tl_model *m, double *dt, bound *by)
{
    struct tl_cycle *c = m->cycle;
    tl_status status = check_factor(m);
    if (status != TL_OK)
        return status;
    rates_count(m);
    if (tl_adds_mass(m)) {
        if (by)
            *by = no_bound;
        return choose_added(m, dt, by != NULL);
    }
    c->adds = false;
    bool given = !isnan(tl_given_step(m));
    double least = 0;
    if (by) {
        *by = controlling(m, true);
        least = with_zones(m, by->least, by);
    } else if (tl_scales_all(m) || !given) {
        least = with_zones(m, controlling(m, false).least, NULL);
        c->mass_scale = tl_scales_all(m) && isfinite(least) ? least : 0;
    } else {
        tl_gridpoints_least(m); /* what holds each of them counts at rest, too */
        c->mass_scale = 0;
    }
    if (given) {
        if (!by)
            judge_step(m);
        *dt = c->dt = tl_given_step(m);
        return TL_OK;
    }
    c->long_step = false;
    double fresh = tl_timestep_fraction(m) * balance_factor(m) * damping_factor(m) * 2 * sqrt(least);
    fresh *= contact_factor(m, 2 * sqrt(least));
    if (!(isfinite(fresh) && fresh > 0)) {
        *dt = 0;
        return tl_model_moves(m) ? no_step(m, fresh) : TL_OK;
    }
    if (!by && !tl_scales_all(m))
        tl_sliver_remark(m);
    if (!(c->dt > 0) || fresh < c->dt || fresh > STEP_GROWTH * c->dt)
        c->dt = fresh;
    *dt = c->dt;
    uint32_t body;
    status = tl_travel_shorten(m, dt, &body);
    if (by && body != TL_NO_ROW)
        *by = (bound){0.25 * *dt * *dt, body, TL_NO_ROW, 0, TL_NO_ROW};
    return status;
}

tl_status tl_timestep_choose(tl_model *m, double *dt)
{
    return choose(m, dt, NULL);
}

tl_status tl_model_timestep(tl_model *m, const tl_timestep *given)
{
    tl_timestep timestep;
    tl_status status = TL_OPTIONS_READ(tl_timestep, given, &timestep, &m->error);
    if (status == TL_OK)
        status = tl_model_may_set(m, "set timestep");
    if (status != TL_OK)
        return status;
    if (!isnan(timestep.fraction) && !(timestep.fraction >= TL_FRACTION_LEAST && timestep.fraction <= TL_FRACTION_MOST))
        return tl_fail(&m->error, TL_E_ARGUMENT, "timestep: fraction = %g is outside [%g, %g]", timestep.fraction,
                       TL_FRACTION_LEAST, TL_FRACTION_MOST);
    if (!isnan(timestep.dt) && !(timestep.dt >= TL_STEP_LEAST && timestep.dt <= 1 / TL_STEP_LEAST))
        return tl_fail(&m->error, TL_E_ARGUMENT, "timestep: dt = %g s is outside [%g, %g]", timestep.dt, TL_STEP_LEAST,
                       1 / TL_STEP_LEAST);
    if (!(timestep.error >= 0 && timestep.error <= 1))
        return tl_fail(&m->error, TL_E_ARGUMENT, "timestep: error = %g is outside [0, 1]", timestep.error);
    m->timestep = timestep;
    m->timestep.error = timestep.error > 0 ? timestep.error : TL_BALANCE_ERROR;
    m->timestep.zone_fraction = timestep.zone_fraction > 0 ? timestep.zone_fraction : 1;
    if (m->cycle && m->detect)
        tl_balance_note(m);
    if (m->cycle) {
        m->cycle->dt = 0;
        m->cycle->stiffness_rates.version = 0; /* another rule asks something else of contacts */
    }
    return TL_OK;
}

/* What controls the step, and the step, s. */
static tl_status report_bound(tl_model *m, bound *by, double *dt)
{
    *by = no_bound;
    tl_status status = tl_cycle_prepare(m);
    if (status == TL_OK)
        status = tl_detect_refresh(m);
    if (status == TL_OK)
        status = tl_elements_ready(m);
    if (status != TL_OK)
        return status;
    const double in_use = m->cycle->dt;
    status = choose(m, dt, by);
    m->cycle->dt = in_use;
    return status;
}

/* What of a block is so fast. */
static tl_step_by cause_of(const bound *by, double mass)
{
    if (by->point != TL_NO_ROW)
        return TL_STEP_BY_ZONES;
    if (!(by->stiffness > 0))
        return TL_STEP_BY_SPEED;
    const bool turns = by->contact == TL_NO_ROW && 0.5 / by->least > MOSTLY * by->stiffness / mass;
    return turns ? TL_STEP_BY_TURN : TL_STEP_BY_PUSH;
}

tl_status tl_model_timestep_report(tl_model *m, tl_timestep_report *report)
{
    *report = (tl_timestep_report){0};
    bound by;
    const tl_status status = report_bound(m, &by, &report->dt);
    if (status != TL_OK || by.body == TL_NO_ROW)
        return status;
    report->block = m->bodies.id[by.body];
    report->mass = by.point == TL_NO_ROW ? m->bodies.mass[by.body] : m->zones->points.mass[by.point];
    report->stiffness = by.stiffness;
    report->by = (int32_t)cause_of(&by, report->mass);
    if (by.contact != TL_NO_ROW) {
        /* the paper's rule joins the smallest mass and the stiffest contact, wherever they are */
        const tl_contacts *contacts = &m->detect->contacts;
        bool a_free = tl_body_counts(m, tl_contact_bodies(m, by.contact).a);
        report->partner = m->blocks.id[a_free ? contacts->a[by.contact] : contacts->b[by.contact]];
    }
    return TL_OK;
}

tl_status tl_model_timestep_gridpoint(tl_model *m, tl_zone_name *name)
{
    *name = (tl_zone_name){TL_NO_ID, 0};
    bound by;
    double dt;
    const tl_status status = report_bound(m, &by, &dt);
    if (status == TL_OK && by.point != TL_NO_ROW)
        *name = tl_gridpoint_name(m, by.point);
    return status;
}

tl_status tl_model_dt(tl_model *m, double *dt)
{
    tl_timestep_report report;
    tl_status status = tl_model_timestep_report(m, &report);
    *dt = report.dt;
    return status;
}
