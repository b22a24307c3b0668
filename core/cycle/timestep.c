/* timestep.c - the stable time step.
 *
 * "paper": dt = FRAC 2 (M_min / (2 K_max))^1/2, K_max the largest max(kn, ks) A_c of a contact (27).
 * "body":  the least over bodies of FRAC 2 (M / (2 K))^1/2 for translation, with K the sum over the
 *          body's contacts, and for rotation, with I the smallest moment of inertia and K r^2 summed over
 *          contact points.
 * Where no free body is in contact, the stiffest law on the largest face of a free block stands in for
 * K. */
#include "cycle/cycle_room.h"

/* The step in use is kept while the rule gives one between it and this many times it: a step that
 * changes all the time would cost accuracy. */
#define STEP_GROWTH 1.1

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

static double largest_free_face(const tl_model *m)
{
    double largest = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        if (m->bodies.fixed[body] == TL_FIX_ALL)
            continue;
        for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
            const tl_poly *shape = m->blocks.shape[m->members[m->bodies.member_start[body] + k]];
            for (uint32_t f = 0; f < shape->face_count; f++)
                largest = fmax(largest, tl_poly_face_area(shape, f));
        }
    }
    return largest;
}

/* M_min / (2 K_max) */
static double paper_rule(const tl_model *m)
{
    const tl_contacts *c = &m->detect->contacts;
    double k = 0;
    for (uint32_t i = 0; i < c->table.rows; i++)
        if (c->material[i] != TL_NO_ROW)
            k = fmax(k, law_stiffness(m, c->material[i]) * c->area[i]);
    if (!(k > 0))
        k = stiffest_law(m) * largest_free_face(m);
    return m->cycle->sums.smallest_mass / (2 * k);
}

/* Sums of K and K r^2 over the contact points of a body. */
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
            tl_vec3 apart = {0, 0, 0};
            if (c->b[i] == row)
                apart = tl_body_apart(&m->bodies, m->blocks.body[c->a[i]], body);
            for (uint32_t p = c->point_start[i]; p < c->point_start[i] + c->point_count[i]; p++) {
                double one = stiffness * d->points.area[p];
                *k += one;
                *k_r2 += one * tl_v3_norm2(tl_v3_sub(d->points.arm[p], apart));
            }
        }
    }
}

static double body_rule(const tl_model *m)
{
    const tl_bodies *b = &m->bodies;
    double least = INFINITY;
    for (uint32_t body = 0; body < b->table.rows; body++) {
        if (b->fixed[body] == TL_FIX_ALL)
            continue;
        double k, k_r2;
        body_stiffness(m, body, &k, &k_r2);
        if (k > 0)
            least = fmin(least, b->mass[body] / (2 * k));
        if (k_r2 > 0 && !(b->fixed[body] & TL_FIX_ROTATION)) {
            tl_vec3 i = b->moments[body];
            double inertia = m->config.rotation == TL_ROTATION_PAPER ? b->round[body]
                                                                     : fmin(i.x, fmin(i.y, i.z));
            least = fmin(least, inertia / (2 * k_r2));
        }
    }
    /* No moving body touches another, though fixed ones may touch each other. */
    if (!isfinite(least))
        least = m->cycle->sums.smallest_mass / (2 * stiffest_law(m) * largest_free_face(m));
    return least;
}

static double damping_factor(const tl_model *m)
{
    if (!m->damping)
        return 1;
    const tl_damping_ops *ops = m->damping->ops;
    return ops->step_factor ? ops->step_factor(m->damping_self) : 1;
}

tl_status tl_timestep_choose(tl_model *m, double *dt)
{
    struct tl_cycle *c = m->cycle;
    if (!isnan(m->timestep.dt)) {
        *dt = c->dt = m->timestep.dt;
        return TL_OK;
    }
    if (!isfinite(c->sums.smallest_mass)) { /* nothing moves: any step will do */
        *dt = c->dt > 0 ? c->dt : 1;
        return TL_OK;
    }
    double least = m->timestep.rule == TL_TIMESTEP_BODY ? body_rule(m) : paper_rule(m);
    double fresh = m->timestep.fraction * damping_factor(m) * 2 * sqrt(least);
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

tl_status tl_model_timestep(tl_model *m, const tl_timestep *timestep)
{
    if (!(timestep->fraction > 0 && timestep->fraction <= 1))
        return tl_fail(&m->error, TL_E_ARGUMENT, "timestep: fraction = %g is outside (0, 1]",
                       timestep->fraction);
    if (!isnan(timestep->dt) && !(timestep->dt > 0 && isfinite(timestep->dt)))
        return tl_fail(&m->error, TL_E_ARGUMENT, "timestep: dt = %g s must be > 0", timestep->dt);
    m->timestep = *timestep;
    if (m->cycle)
        m->cycle->dt = 0;
    return TL_OK;
}

tl_status tl_model_dt(tl_model *m, double *dt)
{
    tl_status status = tl_cycle_prepare(m);
    if (status == TL_OK)
        status = tl_detect_refresh(m);
    if (status != TL_OK)
        return status;
    if (m->cycles == 0)
        tl_gather(m);
    double in_use = m->cycle->dt;
    status = tl_timestep_choose(m, dt);
    m->cycle->dt = in_use;
    return status;
}
