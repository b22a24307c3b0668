/* rates.c - what each body asks of the time step: its rate.
 *
 * The rate of a body is sum k (1/M + r^2/I) over its contact points: k the stiffness of a point at distance r from the
 * centroid, I the smallest moment of inertia. Twice the highest rate is no less than the square of any frequency.
 * Mass scaling has two rates instead: sum 2 k/M of the translation and sum 2 k r^2/I of the rotation, which scale masses
 * and moments of inertia each by itself. Since |v + w r|^2 <= 2 (|v|^2 + |w r|^2), twice the higher one is no less
 * either. So what turns easily, as a slender block, is not made too heavy to move.
 *
 * A body that lands finds the step that its landing needs, for a step that shrinks while a body lands costs energy: no rate is
 * below that of the body standing on its largest face under the stiffest law of its contacts, or, without a contact, of
 * the model. Where it stands on corners or edges, with overlaps o, and these go on with a velocity v, a part of that is
 * enough: the further overlap v / omega over o, omega^2 being the rate on the face, within FLOOR and 1. So a contact whose
 * area vanishes, or that is about to be another, never makes the step long. The stiffness of corners and edges counts as it will be when they are pressed
 * in twice as deep.
 *
 * Rates are kept from step to step and made anew where contacts have changed. Where nothing moves by more than areas are
 * reused for, they cost nothing. Who asks for the rates above some limit only is spared most of the rest: a body asks for no more
 * than it would with the areas of its contacts as far away as its farthest corner. Kept rates follow from the contacts as they
 * were when the body was rated, not as they are:
 * where the step follows from them they are part of the model's state. */
#include "cycle/rates.h"

#include "base/columns.h"
#include "contact/detection.h"
#include "force/joint_laws.h"

#include <string.h>

/* Part of its largest face that a body stands on at least, if it rests on corners and edges: */
#define FLOOR 0.15
/* Stiffness of a corner that is pressed in twice as deep, over what it is. */
#define TWICE_AS_DEEP 4
/* Steps after which mass scaling rates all bodies again, even when no contact has come or gone: areas may have
 * grown. */
#define RECHECK_STEPS 64

double tl_stiffest_law(const tl_model *m)
{
    double k = 0;
    for (size_t i = 0; i < m->joint_law_count; i++)
        k = fmax(k, tl_law_stiffness(&m->joint_laws[i]));
    return k;
}

bool tl_rates_points(const tl_model *m)
{
    return tl_mass_scaled(m) || m->timestep.rule == TL_TIMESTEP_BODY;
}

/* ---------------------------------------------------------------- search ----------------- */

static void keep_extreme(tl_row_value *kept, tl_row_value other)
{
    if (other.value > kept->value || (other.value == kept->value && other.row < kept->row))
        *kept = other;
}

void tl_row_search_note(tl_row_search *s, unsigned thread, tl_row_value found)
{
    if (found.row != TL_NO_ROW)
        keep_extreme(&s->found[thread], found);
}

tl_row_value tl_row_search_run(tl_row_search *s, size_t rows, size_t chunk, tl_range_fn range)
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

/* An area, and its second moment about a body's centroid. */
typedef struct area_sums {
    double area, area_r2;
} area_sums;

/* 1 over mass and smallest moment of inertia; 0 for a rotation that is held. */
typedef struct inverse_inertia {
    double mass, moment;
} inverse_inertia;

static inverse_inertia inverse_of(const tl_model *m, uint32_t body)
{
    const tl_bodies *b = &m->bodies;
    tl_vec3 i = b->moments[body];
    double least =
        m->config.rotation == TL_ROTATION_PAPER ? b->round[body] : fmin(i.x, fmin(i.y, i.z));
    return (inverse_inertia){1 / b->mass[body], b->fixed[body] & TL_FIX_ROTATION ? 0 : 1 / least};
}

static double rate_of(area_sums on, inverse_inertia per)
{
    return on.area * per.mass + on.area_r2 * per.moment;
}

/* A triangle, about the zero of its frame. */
static area_sums triangle(tl_vec3 a, tl_vec3 b, tl_vec3 c)
{
    double area = 0.5 * tl_v3_norm(tl_v3_cross(tl_v3_sub(b, a), tl_v3_sub(c, a)));
    double squares = tl_v3_norm2(a) + tl_v3_norm2(b) + tl_v3_norm2(c) +
                     tl_v3_norm2(tl_v3_add(a, tl_v3_add(b, c)));
    return (area_sums){area, area * squares / 12};
}

static area_sums face_of(const tl_poly *shape, uint32_t face)
{
    const uint16_t *loop = shape->loop + shape->start[face];
    area_sums out = {0, 0};
    for (uint32_t i = 2; i < tl_poly_face_size(shape, face); i++) {
        area_sums next =
            triangle(shape->vertex[loop[0]], shape->vertex[loop[i - 1]], shape->vertex[loop[i]]);
        out.area += next.area;
        out.area_r2 += next.area_r2;
    }
    return out;
}

/* Area over the largest one by which another face is less than that: above roundings of a turned shape. */
#define AS_LARGE 1e-6

/* The largest face of a body that does not lie on another of its blocks; of several the arms of the farthest. */
static area_sums largest_face(const tl_model *m, uint32_t body)
{
    area_sums largest = {0, 0};
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        const tl_poly *shape = m->blocks.shape[m->members[m->bodies.member_start[body] + k]];
        for (uint32_t f = 0; f < shape->face_count; f++) {
            area_sums face = shape->covered[f] ? (area_sums){0, 0} : face_of(shape, f);
            if (face.area > (1 + AS_LARGE) * largest.area)
                largest = face;
            else if (face.area > (1 - AS_LARGE) * largest.area)
                largest.area_r2 = fmax(largest.area_r2, face.area_r2);
        }
    }
    return largest;
}

/* The points of a contact about the centroid of B's or of A's body. */
static area_sums points_of(const tl_model *m, uint32_t c, bool of_b)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    uint32_t a = m->blocks.body[contacts->a[c]], b = m->blocks.body[contacts->b[c]];
    tl_vec3 centre = {0, 0, 0};
    if (of_b)
        centre = tl_m3_tmul(&m->bodies.pose[a].r, tl_body_apart(&m->bodies, a, b));
    area_sums out = {0, 0};
    if (contacts->facet[c].kind == TL_FACET_FIELD) {
        const tl_press *press = &m->detect->press[contacts->press[c]].press;
        double r2 = tl_v3_norm2(tl_v3_sub(press->point, centre)) + press->radius * press->radius;
        double stiffness = TWICE_AS_DEEP * press->stiffness;
        return (area_sums){stiffness, stiffness * r2};
    }
    for (uint32_t k = 0; k < contacts->point_count[c]; k++) {
        size_t i = tl_point_row(contacts, c, k);
        out.area += p->area[i];
        out.area_r2 += p->area[i] * tl_v3_norm2(tl_v3_sub(tl_columns_get(p->p, i), centre));
    }
    return out;
}

/* ---------------------------------------------------------------- one body --------------- */

/* Stiffness of a body's contact points and its second moment, and the stiffest of their laws; 0 without contacts. */
typedef struct contact_sums {
    area_sums stiffness;
    double law;
    bool has_points; /* some have points */
} contact_sums;

/* Where a contact presses in A's frame, and its overlap there. A patch, whose area counts before it touches, has besides its
 * overlap the gap at which it is born: with that, blocks that come faster may press on by other faces. */
static double overlap_of(const tl_model *m, uint32_t c, double law, tl_vec3 *at)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    if (contacts->facet[c].kind == TL_FACET_FIELD) {
        const tl_press *press = &m->detect->press[contacts->press[c]].press;
        *at = press->point;
        return press->overlap;
    }
    uint32_t count = contacts->point_count[c];
    *at = tl_v3(0, 0, 0);
    for (uint32_t k = 0; k < count; k++)
        *at = tl_v3_madd(*at, 1.0 / count, tl_columns_get(p->p, tl_point_row(contacts, c, k)));
    double size = fmin(m->blocks.size[contacts->a[c]], m->blocks.size[contacts->b[c]]);
    return tl_v3_norm(contacts->force[c]) / (law * contacts->area[c]) + TL_CONTACT_TOLERANCE * size;
}

/* Speed at which the blocks of a contact come together there, over their overlap. */
static double approach_of(const tl_model *m, uint32_t c, double law)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_bodies *bodies = &m->bodies;
    uint32_t a = m->blocks.body[contacts->a[c]], b = m->blocks.body[contacts->b[c]];
    tl_vec3 point;
    double overlap = overlap_of(m, c, law, &point);
    tl_vec3 arm = tl_m3_mul(&bodies->pose[a].r, point);
    tl_vec3 arm_b = tl_v3_sub(arm, tl_body_apart(bodies, a, b));
    tl_vec3 v_a = tl_v3_add(bodies->v[a], tl_v3_cross(bodies->w[a], arm));
    tl_vec3 v_b = tl_v3_add(bodies->v[b], tl_v3_cross(bodies->w[b], arm_b));
    double closing = tl_v3_dot(tl_v3_sub(v_a, v_b), contacts->facet[c].last);
    return overlap > 0 ? fabs(closing) / overlap : INFINITY;
}

/* Contacts without area have a law, too. `points`: their stiffness is asked for as well. */
static contact_sums add_contacts(const tl_model *m, uint32_t body, bool points)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    contact_sums out = {{0, 0}, 0, false};
    for (uint32_t j = 0; j < m->bodies.member_count[body]; j++) {
        uint32_t row = m->members[m->bodies.member_start[body] + j];
        for (uint32_t e = d->by_block_start[row]; e < d->by_block_start[row + 1]; e++) {
            uint32_t i = d->by_block[e];
            if (c->law[i] == TL_NO_ROW)
                continue;
            double law = tl_law_stiffness(&m->joint_laws[c->law[i]]);
            out.law = fmax(out.law, law);
            if (points && c->point_count[i] > 0) {
                area_sums next = points_of(m, i, c->b[i] == row);
                out.has_points = true;
                out.stiffness.area += law * next.area;
                out.stiffness.area_r2 += law * next.area_r2;
            }
        }
    }
    return out;
}

static double law_on_face(contact_sums of, double stiffest)
{
    return of.law > 0 ? of.law : stiffest;
}

/* Highest speed at which a contact of a body goes on, over its overlap, 1/s. */
static double highest_approach(const tl_model *m, uint32_t body)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    double out = 0;
    for (uint32_t j = 0; j < m->bodies.member_count[body]; j++) {
        uint32_t row = m->members[m->bodies.member_start[body] + j];
        for (uint32_t e = d->by_block_start[row]; e < d->by_block_start[row + 1]; e++) {
            uint32_t i = d->by_block[e];
            if (c->law[i] == TL_NO_ROW || c->point_count[i] == 0)
                continue;
            out = fmax(out, approach_of(m, i, tl_law_stiffness(&m->joint_laws[c->law[i]])));
        }
    }
    return out;
}

/* The part of its largest face on which a body stands at least, for the rate on all of it. */
static double least_part(const tl_model *m, uint32_t body, const contact_sums *of, double face)
{
    double more = of->has_points ? highest_approach(m, body) / sqrt(face) : 1;
    return fmin(fmax(more, FLOOR), 1);
}

/* What a body asks of the step: in all or, with mass scaling, by translation and by rotation, each for itself. */
typedef struct step_rates {
    double rate, turn;
} step_rates;

static step_rates body_rate(const tl_model *m, uint32_t body, double stiffest)
{
    contact_sums of = add_contacts(m, body, tl_rates_points(m));
    inverse_inertia per = inverse_of(m, body);
    double law = law_on_face(of, stiffest), face = law * m->bodies.face_rate[body];
    double turn = law * m->bodies.face_turn[body],
           part = 0; /* where the contacts ask for more anyway */
    double pushed = of.stiffness.area * per.mass, turned = of.stiffness.area_r2 * per.moment;
    bool more = m->mass_scaling ? pushed < face - turn || turned < turn : pushed + turned < face;
    if (more)
        part = least_part(m, body, &of, face);
    if (!m->mass_scaling)
        return (step_rates){fmax(pushed + turned, part * face), 0};
    return (step_rates){2 * fmax(pushed, part * (face - turn)), 2 * fmax(turned, part * turn)};
}

/* A contact presses no farther away than the farthest corner of the body, over the radius of that: overlaps come on top. */
#define BEYOND 1.05

/* What a body's rate is no higher than, from the areas of its contacts alone. */
static double most_rate(const tl_model *m, uint32_t body, double stiffest)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    area_sums stiffness = {0, 0};
    double law = 0, radius = BEYOND * m->bodies.radius[body];
    for (uint32_t j = 0; j < m->bodies.member_count[body]; j++) {
        uint32_t row = m->members[m->bodies.member_start[body] + j];
        for (uint32_t e = d->by_block_start[row]; e < d->by_block_start[row + 1]; e++) {
            uint32_t i = d->by_block[e];
            if (c->law[i] == TL_NO_ROW)
                continue;
            area_sums on = {c->area[i], c->area[i] * radius * radius};
            if (c->facet[i].kind == TL_FACET_FIELD) /* what is known of it at once is closer */
                on = points_of(m, i, c->b[i] == row);
            double k = tl_law_stiffness(&m->joint_laws[c->law[i]]);
            law = fmax(law, k);
            stiffness.area += k * on.area;
            stiffness.area_r2 += k * on.area_r2;
        }
    }
    double on_face = (law > 0 ? law : stiffest) * m->bodies.face_rate[body];
    return fmax(rate_of(stiffness, inverse_of(m, body)), on_face);
}

double tl_rate_stiffness(const tl_model *m, uint32_t body)
{
    contact_sums of = add_contacts(m, body, tl_rates_points(m));
    double law = law_on_face(of, tl_stiffest_law(m)), face = law * m->bodies.face_rate[body];
    double part = least_part(m, body, &of, face);
    if (rate_of(of.stiffness, inverse_of(m, body)) < part * face)
        return part * law * largest_face(m, body).area;
    return of.stiffness.area;
}

double tl_rate_law(const tl_model *m, uint32_t body)
{
    return law_on_face(add_contacts(m, body, false), tl_stiffest_law(m));
}

/* ---------------------------------------------------------------- all bodies ------------- */

/* The rate of a body that stands on its largest face, for a stiffness per area of 1. Where points do not count, as by the
 * paper's rule, turning does not either. */
static step_rates rate_on_face(const tl_model *m, uint32_t body)
{
    area_sums face = largest_face(m, body);
    inverse_inertia per = inverse_of(m, body);
    return (step_rates){tl_rates_points(m) ? rate_of(face, per) : face.area * per.mass,
                        face.area_r2 * per.moment};
}

/* Of the bodies of which it is not known: those that have come or changed. */
static void face_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const tl_model *m = user;
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        if (m->bodies.face_rate[body] != 0)
            continue;
        step_rates on_face = rate_on_face(m, body);
        m->bodies.face_rate[body] = on_face.rate;
        m->bodies.face_turn[body] = on_face.turn;
    }
}

void tl_rates_count(tl_model *m)
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
    for (uint32_t body = 0; body < b->table.rows; body++) {
        if (tl_body_counts(m, body) && b->mass[body] < now.least_mass) {
            now.least_mass = b->mass[body];
            now.lightest = body;
        }
    }
    bool anew = to->version == 0 || to->constraints != now.constraints ||
                to->rotation != now.rotation || to->points != now.points;
    if (anew && b->table.rows > 0)
        memset(b->face_rate, 0, b->table.rows * sizeof *b->face_rate);
    tl_parallel_for(m->pool, b->table.rows, TL_BODY_CHUNK, face_range, m);
    *to = now;
}

/* Which rates a search makes anew, and what it needs for that. */
typedef struct rate_search {
    tl_row_search search;
    double stiffest; /* of the model's laws */
    bool kept; /* rates are kept in their column, and made anew only where contacts have changed */
    bool all;  /* all rates are made anew */
    double
        known; /* of a body that asks for no more than this, what it asks for at the most will do; 0: of none */
} rate_search;

static step_rates rate_for(const rate_search *s, uint32_t body)
{
    const tl_model *m = s->search.m;
    if (!tl_body_counts(m, body))
        return (step_rates){0, 0};
    double most = s->known > 0 ? most_rate(m, body, s->stiffest) : INFINITY;
    return most <= s->known ? (step_rates){most, 0} : body_rate(m, body, s->stiffest);
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
        double value = m->mass_scaling ? -of.rate : of.rate;
        if (of.rate > 0 && value > found.value)
            found = (tl_row_value){value, body};
    }
    tl_row_search_note(&s->search, thread, found);
}

/* Notes the bodies whose contacts have points that were placed in this step or, beyond that, others than before; true when there are
 * any. */
static bool touch_new_points(tl_model *m, uint8_t least)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    bool any = false;
    for (size_t i = 0; i < c->table.rows; i++) {
        if (c->new_points[i] < least)
            continue;
        d->touched[m->blocks.body[c->a[i]]] = true;
        d->touched[m->blocks.body[c->b[i]]] = true;
        any = true;
        if (c->point_count[i] == 0) /* the laws will not see it */
            c->new_points[i] = TL_POINTS_STAY;
    }
    return any;
}

/* Where contact points count, bodies are rated anew when one of their contacts has points that were placed in this step;
 * otherwise, and with mass scaling, when a contact has gone or has other points; with mass scaling, all now and then. */
tl_row_value tl_rates_keep(tl_model *m, double known)
{
    struct tl_cycle *c = m->cycle;
    tl_detect *d = m->detect;
    struct tl_stiffness_rates now = {.version = 1 + m->structure + m->constraints + m->laws,
                                     .recheck = m->mass_scaling ? m->cycles / RECHECK_STEPS : 0,
                                     .rotation = m->config.rotation};
    bool all = now.version != c->stiffness_rates.version ||
               now.recheck != c->stiffness_rates.recheck ||
               now.rotation != c->stiffness_rates.rotation ||
               (known > 0 && !(c->dt > 0)); /* it may be another one */
    bool placed = tl_rates_points(m) && !m->mass_scaling;
    bool some = touch_new_points(m, placed ? TL_POINTS_PLACED : TL_POINTS_OTHERS);
    if (all || some || d->any_touched) {
        rate_search s = {.search.m = m,
                         .stiffest = tl_stiffest_law(m),
                         .kept = true,
                         .all = all,
                         .known = known};
        tl_row_value found =
            tl_row_search_run(&s.search, m->bodies.table.rows, TL_BODY_CHUNK, rate_range);
        memset(d->touched, 0, m->bodies.table.rows);
        d->any_touched = false;
        now.extreme = fabs(found.value);
        now.body = found.row;
        c->stiffness_rates = now;
    }
    return (tl_row_value){c->stiffness_rates.extreme, c->stiffness_rates.body};
}

bool tl_rates_are_state(const tl_model *m)
{
    return tl_mass_scaled(m) || (tl_rates_points(m) && isnan(m->timestep.dt));
}

void tl_rates_try(tl_model *m, double known, double *rate, double *turn_rate)
{
    struct tl_cycle *c = m->cycle;
    struct tl_stiffness_rates kept = c->stiffness_rates;
    double *own = c->rate, *own_turn = c->turn_rate;
    tl_rates_count(m);
    for (size_t body = 0; body < m->bodies.table.rows; body++)
        rate[body] = own[body], turn_rate[body] = own_turn[body];
    c->rate = rate;
    c->turn_rate = turn_rate;
    tl_rates_keep(m, known);
    c->rate = own;
    c->turn_rate = own_turn;
    c->stiffness_rates = kept;
}

tl_row_value tl_rates_anew(tl_model *m, double known)
{
    rate_search s = {.search.m = m, .stiffest = tl_stiffest_law(m), .known = known};
    tl_row_value found =
        tl_row_search_run(&s.search, m->bodies.table.rows, TL_BODY_CHUNK, rate_range);
    return (tl_row_value){fabs(found.value), found.row};
}
