/* timestep.c - the stable time step.
 *
 * "paper": dt = FRAC 2 (M_min / (2 K_max))^1/2, K_max the largest max(kn, ks) A_c of a contact (27).
 * "body":  the least over bodies of FRAC 2 (1 / (2 sum k (1/M + r^2/I)))^1/2, the sum over the body's
 *          contact points of stiffness k at distance r from the centroid, I the smallest moment of inertia:
 *          no motion of the body and its neighbours is faster, so FRAC 1 is stable.
 * Mass scaling gives every free body the bound of the one that has the most.
 * What a body adds up over its contact points is its rate. Rates are kept from step to step, and made anew where contacts
 * changed: where nothing moves by more than areas are reused for, they cost nothing.
 * Where no free body is in contact, the stiffest law on the largest face of a free block stands in for
 * K. */
#include "cycle/cycle_room.h"

#include <string.h>

/* The step in use is kept while the rule gives one between it and this many times it: a step that
 * changes all the time would cost accuracy. */
#define STEP_GROWTH 1.1

/* Steps after which mass scaling looks at the stiffness of all bodies again, even when no contact has come or
 * gone: areas may have grown. */
#define LOOK_EVERY 64

static double law_stiffness(const tl_model *m, uint32_t material)
{
    const tl_material *law = &m->materials[material];
    return law->kn > law->ks ? law->kn : law->ks;
}

static double stiffest_law(const tl_model *m)
{
    double k = 0;
    for (size_t i = 0; i < m->material_count; i++)
        k = fmax(k, law_stiffness(m, (uint32_t)i));
    return k;
}

/* Whether a body counts for the rules: one that can move or, where none can, any. */
static bool counts(const tl_model *m, uint32_t body)
{
    return m->cycle->all_held || m->bodies.fixed[body] != TL_FIX_ALL;
}

/* What the rules ask of all bodies, looked up again when one has come, gone, been held or got another mass. */
static void count_bodies(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    struct tl_counted *to = &c->counted;
    uint64_t version = 1 + m->structure + m->constraints;
    if (to->version == version)
        return;
    const tl_bodies *b = &m->bodies;
    *to = (struct tl_counted){version, INFINITY, TL_NO_ROW, -1};
    c->all_held = true;
    for (uint32_t body = 0; body < b->table.rows && c->all_held; body++)
        c->all_held = b->fixed[body] == TL_FIX_ALL;
    for (uint32_t body = 0; body < b->table.rows; body++) {
        if (counts(m, body) && b->mass[body] < to->least_mass) {
            to->least_mass = b->mass[body];
            to->lightest = body;
        }
    }
}

static double largest_free_face(tl_model *m)
{
    double largest = 0;
    if (m->cycle->counted.largest_face >= 0)
        return m->cycle->counted.largest_face;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        if (!counts(m, body))
            continue;
        for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
            const tl_poly *shape = m->blocks.shape[m->members[m->bodies.member_start[body] + k]];
            for (uint32_t f = 0; f < shape->face_count; f++)
                largest = fmax(largest, tl_poly_face_area(shape, f));
        }
    }
    m->cycle->counted.largest_face = largest;
    return largest;
}

/* M or I over 2 K of the body, or of the smallest mass and the stiffest contact, that controls the step. */
typedef struct bound {
    double least;
    uint32_t body;    /* row, or TL_NO_ROW */
    uint32_t contact; /* row of the contact, or TL_NO_ROW */
    double stiffness;
} bound;

/* The worst row of contacts or bodies that a thread has met, and how bad it is. Whoever met it, of several
 * that are equally bad the first row counts: which thread took which rows makes no difference. */
typedef struct worst {
    double value, stiffness;
    uint32_t row;
} worst;

typedef struct search {
    tl_model *m;
    bool slowest; /* the lowest rate is looked for, not the highest */
    bool kept; /* rates are kept in their column, and made anew only where contacts have changed */
    bool all;  /* all rates are made anew */
    worst of[TL_MAX_THREADS];
} search;

static void keep_worst(worst *w, worst other)
{
    if (other.value > w->value || (other.value == w->value && other.row < w->row))
        *w = other;
}

static worst find_worst(search *s, size_t rows, size_t chunk, tl_range_fn range)
{
    unsigned threads = tl_pool_threads(s->m->pool);
    for (unsigned t = 0; t < threads; t++)
        s->of[t] = (worst){-INFINITY, 0, TL_NO_ROW};
    tl_parallel_for(s->m->pool, rows, chunk, range, s);
    for (unsigned t = 1; t < threads; t++)
        keep_worst(&s->of[0], s->of[t]);
    return s->of[0];
}

static void stiffest_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    search *s = user;
    const tl_model *m = s->m;
    const tl_contacts *c = &m->detect->contacts;
    worst found = {-INFINITY, 0, TL_NO_ROW};
    for (uint32_t i = (uint32_t)begin; i < end; i++) {
        if (c->material[i] == TL_NO_ROW)
            continue;
        double k = law_stiffness(m, c->material[i]) * c->area[i];
        /* most are not stiffer: what is dearer to know is asked last */
        if (k > found.value &&
            (counts(m, m->blocks.body[c->a[i]]) || counts(m, m->blocks.body[c->b[i]])))
            found = (worst){k, k, i};
    }
    keep_worst(&s->of[thread], found);
}

/* M_min / (2 K_max), with K_max over the contacts of free bodies. */
static bound paper_rule(tl_model *m)
{
    const struct tl_counted *counted = &m->cycle->counted;
    search s = {.m = m};
    worst stiffest =
        find_worst(&s, m->detect->contacts.table.rows, TL_CONTACT_CHUNK, stiffest_range);
    bound out = {
        .body = counted->lightest, .contact = stiffest.row, .stiffness = stiffest.stiffness};
    if (out.contact == TL_NO_ROW)
        out.stiffness = stiffest_law(m) * largest_free_face(m);
    out.least = counted->least_mass / (2 * out.stiffness);
    return out;
}

/* Area of a facet's points, and that times their squared distance from a body's centroid. */
typedef struct sums {
    double area, area_r2;
} sums;

static sums facet_stiffness(const tl_model *m, uint32_t c, const tl_facet *f, bool of_b)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    uint32_t a = m->blocks.body[contacts->a[c]], b = m->blocks.body[contacts->b[c]];
    /* points are kept in one body's frame; the other's centroid in it */
    bool in_b = f->kind == TL_FACET_FACE_A;
    tl_vec3 apart = tl_body_apart(&m->bodies, in_b ? b : a, in_b ? a : b), centre = {0, 0, 0};
    if (in_b != of_b)
        centre = tl_m3_tmul(&m->bodies.pose[in_b ? b : a].r, apart);
    sums out = {0, 0};
    for (uint32_t k = f->begin; k < f->begin + (uint32_t)f->count; k++) {
        size_t i = tl_point_row(contacts, c, k);
        out.area += p->area[i];
        out.area_r2 += p->area[i] * tl_v3_norm2(tl_v3_sub(tl_columns_get(p->p, i), centre));
    }
    return out;
}

/* Sums of k and k r^2 over the contact points of a body. */
static void body_stiffness(const tl_model *m, uint32_t body, double *k, double *k_r2)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    double sum = 0, sum_r2 = 0;
    for (uint32_t j = 0; j < m->bodies.member_count[body]; j++) {
        uint32_t row = m->members[m->bodies.member_start[body] + j];
        for (uint32_t e = d->by_block_start[row]; e < d->by_block_start[row + 1]; e++) {
            uint32_t i = d->by_block[e];
            if (c->material[i] == TL_NO_ROW)
                continue;
            double stiffness = law_stiffness(m, c->material[i]);
            for (uint32_t f = 0; f < c->facet_count[i]; f++) {
                const tl_facet *facet = &c->facet[c->facet_start[i] + f];
                sums next = facet_stiffness(m, i, facet, c->b[i] == row);
                sum += stiffness * next.area;
                sum_r2 += stiffness * next.area_r2;
            }
        }
    }
    *k = sum;
    *k_r2 = sum_r2;
}

/* sum k (1/M + r^2/I) of a body: 0 without contacts. */
static double body_rate(const tl_model *m, uint32_t body, double *stiffness)
{
    const tl_bodies *b = &m->bodies;
    double k_r2;
    body_stiffness(m, body, stiffness, &k_r2);
    double rate = *stiffness / b->mass[body];
    if (!(b->fixed[body] & TL_FIX_ROTATION)) {
        tl_vec3 i = b->moments[body];
        rate += k_r2 / (m->config.rotation == TL_ROTATION_PAPER ? b->round[body]
                                                                : fmin(i.x, fmin(i.y, i.z)));
    }
    return rate;
}

/* Rates of the bodies, and the extreme one. */
static void rate_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    search *s = user;
    const tl_model *m = s->m;
    double *kept = m->cycle->rate, k;
    const uint8_t *touched = m->detect->touched;
    worst found = {-INFINITY, 0, TL_NO_ROW};
    for (uint32_t body = (uint32_t)begin; body < end; body++) {
        double rate = kept[body];
        if (!s->kept || s->all || touched[body])
            rate = counts(m, body) ? body_rate(m, body, &k) : 0;
        if (s->kept)
            kept[body] = rate;
        double value = s->slowest ? -rate : rate;
        if (rate > 0 && value > found.value)
            found = (worst){value, 0, body};
    }
    keep_worst(&s->of[thread], found);
}

/* Notes the bodies whose contacts have other points than in the step before; true when there are any. */
static bool touch_fresh(tl_model *m)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    bool any = false;
    for (size_t i = 0; i < c->table.rows; i++) {
        if (!c->fresh[i])
            continue;
        d->touched[m->blocks.body[c->a[i]]] = true;
        d->touched[m->blocks.body[c->b[i]]] = true;
        any = true;
        c->fresh[i] = c->point_count[i] > 0; /* without points the laws will not see it */
    }
    return any;
}

/* M or I over 2 K of the fastest body, with mass scaling of the slowest, from rates that are kept. By the rule, bodies are
 * rated anew when one of their contacts has points that were placed in this step; with mass scaling, when a contact has
 * come, gone or grown, and all now and then. */
static double kept_least(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    tl_detect *d = m->detect;
    struct tl_rated now = {.version = 1 + m->structure + m->constraints + m->laws,
                           .look = m->mass_scaling ? m->cycles / LOOK_EVERY : 0,
                           .rotation = m->config.rotation};
    bool all = now.version != c->rated.version || now.look != c->rated.look ||
               now.rotation != c->rated.rotation;
    bool some = !m->mass_scaling && touch_fresh(m);
    if (all || some || d->any_touched) {
        search s = {.m = m, .slowest = m->mass_scaling, .kept = true, .all = all};
        worst found = find_worst(&s, m->bodies.table.rows, TL_BODY_CHUNK, rate_range);
        memset(d->touched, 0, m->bodies.table.rows);
        d->any_touched = false;
        now.extreme = fabs(found.value);
        now.body = found.row;
        c->rated = now;
    }
    return c->rated.body == TL_NO_ROW ? paper_rule(m).least : 0.5 / c->rated.extreme;
}

static bool rates_bodies(const tl_model *m)
{
    return m->mass_scaling || m->timestep.rule == TL_TIMESTEP_BODY;
}

/* What controls the step, looked at anew. */
static bound controlling(tl_model *m)
{
    if (!rates_bodies(m))
        return paper_rule(m);
    search s = {.m = m, .slowest = m->mass_scaling};
    worst found = find_worst(&s, m->bodies.table.rows, TL_BODY_CHUNK, rate_range);
    if (found.row == TL_NO_ROW)
        return paper_rule(m); /* no moving body touches another */
    bound out = {.least = 0.5 / fabs(found.value), .body = found.row, .contact = TL_NO_ROW};
    double k_r2;
    body_stiffness(m, found.row, &out.stiffness, &k_r2);
    return out;
}

static double damping_factor(const tl_model *m)
{
    if (!m->damping)
        return 1;
    const tl_damping_ops *ops = m->damping->ops;
    return ops->step_factor ? ops->step_factor(m->damping_self) : 1;
}

/* A plugin's factor and stiffness are its word: refused when they cannot be. */
static tl_status check_plugins(tl_model *m)
{
    double factor = damping_factor(m);
    if (!(factor > 0 && factor <= 1))
        return tl_fail(&m->error, TL_E_PLUGIN,
                       "damping '%s' gives the step factor %g, which is outside (0, 1]",
                       m->damping->name, factor);
    for (size_t i = 0; i < m->material_count; i++)
        if (!isfinite(law_stiffness(m, (uint32_t)i)))
            return tl_fail(&m->error, TL_E_PLUGIN, "law '%s' gives a stiffness that is not finite",
                           m->materials[i].kind->name);
    return TL_OK;
}

/* The step. A report asks `by` what controls it, and leaves the scale of the inertia alone. */
static tl_status choose(tl_model *m, double *dt, bound *by)
{
    struct tl_cycle *c = m->cycle;
    tl_status status = check_plugins(m);
    if (status != TL_OK)
        return status;
    count_bodies(m);
    bool given = !isnan(m->timestep.dt);
    double least = 0;
    if (by) {
        *by = controlling(m);
        least = by->least;
    } else if (m->mass_scaling || !given) {
        least = rates_bodies(m) ? kept_least(m) : paper_rule(m).least;
        c->scaled = m->mass_scaling ? least : 0;
    } else {
        c->scaled = 0;
    }
    if (given) {
        *dt = c->dt = m->timestep.dt;
        return TL_OK;
    }
    double fresh = m->timestep.fraction * damping_factor(m) * 2 * sqrt(least);
    if (c->all_held && !(isfinite(fresh) && fresh > 0))
        fresh = 1; /* nothing moves and nothing is stiff: any step will do */
    if (!isfinite(fresh) || !(fresh > 0))
        return tl_fail(
            &m->error, TL_E_STATE,
            "no time step follows from the model: no law says how stiff a contact is; set "
            "a law with model:joint(\"*\", ...) or a step with model:timestep{ dt = ... }");
    if (!(c->dt > 0) || fresh < c->dt || fresh > STEP_GROWTH * c->dt)
        c->dt = fresh;
    *dt = c->dt;
    return TL_OK;
}

tl_status tl_timestep_choose(tl_model *m, double *dt)
{
    return choose(m, dt, NULL);
}

tl_status tl_model_timestep(tl_model *m, const tl_timestep *timestep)
{
    if (!(timestep->fraction > 0 && timestep->fraction <= TL_FRACTION_MOST))
        return tl_fail(&m->error, TL_E_ARGUMENT, "timestep: fraction = %g is outside (0, %g]",
                       timestep->fraction, TL_FRACTION_MOST);
    if (!isnan(timestep->dt) && !(timestep->dt > 0 && isfinite(timestep->dt)))
        return tl_fail(&m->error, TL_E_ARGUMENT, "timestep: dt = %g s must be > 0", timestep->dt);
    m->timestep = *timestep;
    if (m->cycle) {
        m->cycle->dt = 0;
        m->cycle->rated.version = 0; /* another rule asks something else of contacts */
    }
    return TL_OK;
}

tl_status tl_model_mass_scaling(tl_model *m, bool on)
{
    m->mass_scaling = on;
    m->constraints++;
    if (m->cycle)
        m->cycle->dt = 0;
    return TL_OK;
}

bool tl_model_mass_scaled(const tl_model *m)
{
    return m->mass_scaling;
}

tl_status tl_model_timestep_report(tl_model *m, tl_timestep_report *report)
{
    *report = (tl_timestep_report){0};
    tl_status status = tl_cycle_prepare(m);
    if (status == TL_OK)
        status = tl_detect_refresh(m);
    if (status != TL_OK)
        return status;
    struct tl_cycle *c = m->cycle;
    double in_use = c->dt;
    bound by;
    status = choose(m, &report->dt, &by);
    c->dt = in_use;
    if (status != TL_OK || by.body == TL_NO_ROW)
        return status;
    report->block = m->bodies.id[by.body];
    report->mass = m->bodies.mass[by.body];
    report->stiffness = by.stiffness;
    if (by.contact != TL_NO_ROW) {
        /* the paper's rule joins the smallest mass and the stiffest contact, wherever they are */
        const tl_contacts *contacts = &m->detect->contacts;
        bool a_free = counts(m, m->blocks.body[contacts->a[by.contact]]);
        report->partner = m->blocks.id[a_free ? contacts->a[by.contact] : contacts->b[by.contact]];
    }
    return TL_OK;
}

tl_status tl_model_dt(tl_model *m, double *dt)
{
    tl_timestep_report report;
    tl_status status = tl_model_timestep_report(m, &report);
    *dt = report.dt;
    return status;
}
