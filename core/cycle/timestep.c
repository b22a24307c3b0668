/* timestep.c - the stable time step.
 *
 * "paper": dt = FRAC 2 (M_min / (2 K_max))^1/2, K_max the largest max(kn, ks) A_c of a contact (27).
 * "body":  the least over bodies of FRAC 2 (1 / (2 sum k (1/M + r^2/I)))^1/2, the sum over the body's
 *          contact points of stiffness k at distance r from the centroid, I the smallest moment of inertia:
 *          no motion of the body and its neighbours is faster, so FRAC 1 is stable.
 * Mass scaling gives every free body the bound of the one that has the most.
 * Where no free body is in contact, the stiffest law on the largest face of a free block stands in for
 * K. */
#include "cycle/cycle_room.h"

/* The step in use is kept while the rule gives one between it and this many times it: a step that
 * changes all the time would cost accuracy. */
#define STEP_GROWTH 1.1

/* Steps after which mass scaling looks at the bodies' stiffness again even when no contact has come or
 * gone: areas may have grown. */
#define LOOK_EVERY 64

static double law_stiffness(const tl_model *m, uint32_t material)
{
    const tl_material *law = &m->materials[material];
    return fmax(law->kn, law->ks);
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

static bool all_held(const tl_model *m)
{
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        if (m->bodies.fixed[body] != TL_FIX_ALL)
            return false;
    return true;
}

static double largest_free_face(const tl_model *m)
{
    double largest = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        if (!counts(m, body))
            continue;
        for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
            const tl_poly *shape = m->blocks.shape[m->members[m->bodies.member_start[body] + k]];
            for (uint32_t f = 0; f < shape->face_count; f++)
                largest = fmax(largest, tl_poly_face_area(shape, f));
        }
    }
    return largest;
}

/* M or I over 2 K of the body, or of the smallest mass and the stiffest contact, that controls the step. */
typedef struct bound {
    double least;
    uint32_t body;    /* row, or TL_NO_ROW */
    uint32_t contact; /* row of the contact, or TL_NO_ROW */
    double stiffness;
} bound;

/* M_min / (2 K_max), with K_max over the contacts of free bodies. */
static bound paper_rule(const tl_model *m)
{
    const tl_contacts *c = &m->detect->contacts;
    bound out = {.body = TL_NO_ROW, .contact = TL_NO_ROW};
    for (uint32_t i = 0; i < c->table.rows; i++) {
        if (c->material[i] == TL_NO_ROW ||
            (!counts(m, m->blocks.body[c->a[i]]) && !counts(m, m->blocks.body[c->b[i]])))
            continue;
        double k = law_stiffness(m, c->material[i]) * c->area[i];
        if (k > out.stiffness) {
            out.stiffness = k;
            out.contact = i;
        }
    }
    if (out.contact == TL_NO_ROW)
        out.stiffness = stiffest_law(m) * largest_free_face(m);
    double mass = INFINITY;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        if (counts(m, body) && m->bodies.mass[body] < mass) {
            mass = m->bodies.mass[body];
            out.body = body;
        }
    out.least = mass / (2 * out.stiffness);
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
        centre = tl_m3_tmul(&m->bodies.r[in_b ? b : a], apart);
    sums out = {0, 0};
    size_t begin = contacts->point_start[c] + f->begin;
    for (size_t i = begin; i < begin + f->count; i++) {
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
    *k = *k_r2 = 0;
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
                *k += stiffness * next.area;
                *k_r2 += stiffness * next.area_r2;
            }
        }
    }
}

/* 1 / (2 sum k (1/M + r^2/I)) of a body; infinite without contacts. */
static double body_bound(const tl_model *m, uint32_t body, double *stiffness)
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
    return 1 / (2 * rate);
}

static bound body_rule(const tl_model *m)
{
    bound out = {INFINITY, TL_NO_ROW, TL_NO_ROW, 0};
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        double k = 0, least = counts(m, body) ? body_bound(m, body, &k) : INFINITY;
        if (least < out.least)
            out = (bound){least, body, TL_NO_ROW, k};
    }
    return out.body == TL_NO_ROW ? paper_rule(m) : out; /* no moving body touches another */
}

/* Scales the inertia of the free bodies up to the bound of the one that needs it least. */
static bound scale_inertia(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    const tl_bodies *b = &m->bodies;
    uint64_t version = 1 + m->detect->changes + (uint64_t)m->cycles / LOOK_EVERY + m->constraints +
                       m->laws + m->structure;
    bound out = {c->scaled_step, TL_NO_ROW, TL_NO_ROW, 0};
    if (version == c->scaled_for)
        return out;
    double most = 0;
    for (uint32_t body = 0; body < b->table.rows; body++) {
        double k = 0, least = counts(m, body) ? body_bound(m, body, &k) : INFINITY;
        c->scale[body] = least; /* for the second pass */
        if (isfinite(least) && least > most) {
            most = least;
            out = (bound){least, body, TL_NO_ROW, k};
        }
    }
    if (!(most > 0))
        out = paper_rule(m);
    for (uint32_t body = 0; body < b->table.rows; body++)
        c->scale[body] = isfinite(c->scale[body]) ? most / c->scale[body] : 1;
    c->scaled_for = version;
    c->scaled_step = out.least;
    return out;
}

static bound controlling(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    c->all_held = all_held(m);
    if (m->mass_scaling)
        return scale_inertia(m);
    for (size_t body = 0; body < c->table.rows; body++)
        c->scale[body] = 1;
    c->scaled_for = 0;
    return m->timestep.rule == TL_TIMESTEP_BODY ? body_rule(m) : paper_rule(m);
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

static tl_status choose(tl_model *m, double *dt, bound *by)
{
    struct tl_cycle *c = m->cycle;
    tl_status status = check_plugins(m);
    if (status != TL_OK)
        return status;
    *by = controlling(m);
    if (!isnan(m->timestep.dt)) {
        *dt = c->dt = m->timestep.dt;
        return TL_OK;
    }
    double fresh = m->timestep.fraction * damping_factor(m) * 2 * sqrt(by->least);
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
    bound by;
    return choose(m, dt, &by);
}

tl_status tl_model_timestep(tl_model *m, const tl_timestep *timestep)
{
    if (!(timestep->fraction > 0 && timestep->fraction <= TL_FRACTION_MOST))
        return tl_fail(&m->error, TL_E_ARGUMENT, "timestep: fraction = %g is outside (0, %g]",
                       timestep->fraction, TL_FRACTION_MOST);
    if (!isnan(timestep->dt) && !(timestep->dt > 0 && isfinite(timestep->dt)))
        return tl_fail(&m->error, TL_E_ARGUMENT, "timestep: dt = %g s must be > 0", timestep->dt);
    m->timestep = *timestep;
    if (m->cycle)
        m->cycle->dt = 0;
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
    double in_use = c->dt, scaled_step = c->scaled_step;
    uint64_t scaled_for = c->scaled_for;
    c->scaled_for = 0; /* look anew, so that the body can be named */
    bound by;
    status = choose(m, &report->dt, &by);
    c->dt = in_use;
    c->scaled_for = scaled_for;
    c->scaled_step = scaled_step;
    if (status != TL_OK || by.body == TL_NO_ROW)
        return status;
    report->block = m->bodies.id[by.body];
    report->mass = m->bodies.mass[by.body];
    report->stiffness = by.stiffness;
    if (by.contact != TL_NO_ROW) {
        /* the paper's rule joins the smallest mass and the stiffest contact, wherever they are */
        const tl_contacts *contacts = &m->detect->contacts;
        bool a_free = counts(m, m->blocks.body[contacts->a[by.contact]]);
        report->partner = a_free ? contacts->id_a[by.contact] : contacts->id_b[by.contact];
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
