/* laws.c - contact forces: gaps and motion of contact points, the laws' plugins, and the sum per contact.
 *
 * A law gets the points of a page at once, all of one material, as the columns themselves; gaps and
 * motion are in the thread's lanes, which stay in the nearest cache from one end to the other. */
#include "cycle/cycle_room.h"

#include <stdio.h>
#include <string.h>

/* Pages a worker takes at a time. */
#define PAGE_CHUNK 2

typedef struct run_job {
    tl_model *m;
    const tl_material *material;
    const tl_run *run;
} run_job;

/* The blocks and joint of the contact that owns a point: "contact of blocks 3 and 7, joint J1:2". */
static void name_contact(tl_model *m, uint32_t c, char *text, size_t size)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const char *joint = tl_tag_name(m, contacts->tag[c]);
    snprintf(text, size, "contact of blocks %u and %u%s%s", contacts->id_a[c], contacts->id_b[c],
             *joint ? ", joint " : " (no joint)", joint);
}

static uint32_t contact_of_point(const tl_contacts *contacts, size_t point)
{
    for (uint32_t c = 0; c < contacts->table.rows; c++)
        if (point >= contacts->point_start[c] &&
            point < contacts->point_start[c] + contacts->point_room[c])
            return c;
    return 0;
}

/* Calls the law on `count` points from `first`; false when it failed. */
static bool call_law(const run_job *job, size_t first, size_t count, const tl_point_lanes *l)
{
    tl_points_table *p = &job->m->detect->points;
    double *state[TL_STATE_COLUMNS] = {NULL};
    for (uint32_t k = 0; k < p->state_columns; k++)
        state[k] = p->state[k] + first;
    tl_law_batch batch = {
        .size = sizeof batch,
        .count = (uint32_t)count,
        .dt = job->m->dt,
        .area = p->area + first,
        .closure = p->closure + first,
        .f_n0 = p->f_n0 + first,
        .normal = {l->normal[0], l->normal[1], l->normal[2]},
        .du_n = l->du_n,
        .du_s = {l->du_s[0], l->du_s[1], l->du_s[2]},
        .f_n = p->f_n + first,
        .f_s = {p->f_s[0] + first, p->f_s[1] + first, p->f_s[2] + first},
        .state = state,
        .flags = p->flags + first,
        .stored = l->stored,
        .dissipated = l->dissipated,
    };
    /* a law need not write its energies: those of the page before are not its own */
    memset(l->stored, 0, count * sizeof *l->stored);
    memset(l->dissipated, 0, count * sizeof *l->dissipated);
    const tl_law_ops *ops = job->material->kind->ops;
    tl_report report = {.size = sizeof report};
    tl_status status = ops->update(job->material->self, &batch, &report);
    if (status != TL_OK)
        tl_cycle_failed(job->m, first, status, first + report.first_bad, report.text);
    return status == TL_OK;
}

/* The couple on B by which the areas of a facet, where they depend on tilt, do work: what the springs
 * gain or lose with their areas, the bodies lose or gain. Areas keep the points' stresses, so the energy
 * stored in them is in proportion. */
static tl_vec3 facet_couple(const tl_facet *f, const double *stored_in, const tl_mat3 *ra)
{
    double stored = 0;
    for (size_t i = f->begin; i < f->begin + (size_t)f->count; i++)
        stored += stored_in[i];
    return tl_v3_scale(stored, tl_m3_mul(ra, f->swing));
}

/* Force on B of a contact's points, and its moment about A's centroid. */
typedef struct sums {
    tl_vec3 force, moment;
} sums;

static double across(const double *lane)
{
    return (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

/* Four sums side by side, added in the end: the same order for every width of the processor's vectors. Lanes
 * past the last point are inert. */
TL_VECTORIZED static sums sum_points(const tl_points_table *p, size_t begin, size_t count,
                                     const tl_point_lanes *l, size_t lane)
{
    const double *f_n = p->f_n + begin, *f_x = p->f_s[0] + begin, *f_y = p->f_s[1] + begin;
    const double *f_z = p->f_s[2] + begin, *n_x = l->normal[0] + lane, *n_y = l->normal[1] + lane;
    const double *n_z = l->normal[2] + lane, *x = l->arm[0] + lane, *y = l->arm[1] + lane;
    const double *z = l->arm[2] + lane;
    double fx[TL_POINT_ROUND] = {0}, fy[TL_POINT_ROUND] = {0}, fz[TL_POINT_ROUND] = {0};
    double mx[TL_POINT_ROUND] = {0}, my[TL_POINT_ROUND] = {0}, mz[TL_POINT_ROUND] = {0};
    for (size_t i = 0; i < count; i += TL_POINT_ROUND)
#pragma omp simd
        for (size_t k = 0; k < TL_POINT_ROUND; k++) {
            double gx = f_x[i + k] + f_n[i + k] * n_x[i + k];
            double gy = f_y[i + k] + f_n[i + k] * n_y[i + k];
            double gz = f_z[i + k] + f_n[i + k] * n_z[i + k];
            fx[k] += gx;
            fy[k] += gy;
            fz[k] += gz;
            mx[k] += y[i + k] * gz - z[i + k] * gy;
            my[k] += z[i + k] * gx - x[i + k] * gz;
            mz[k] += x[i + k] * gy - y[i + k] * gx;
        }
    return (sums){{across(fx), across(fy), across(fz)}, {across(mx), across(my), across(mz)}};
}

/* The sums of a contact, with the couples of its facets, about both bodies' centroids. Lane 0 is point
 * `first`. */
static void sum_contact(tl_model *m, uint32_t c, const tl_point_lanes *l, size_t first)
{
    tl_contacts *contacts = &m->detect->contacts;
    size_t begin = contacts->point_start[c];
    sums sum = sum_points(&m->detect->points, begin, contacts->point_count[c], l, begin - first);
    uint32_t a = m->blocks.body[contacts->a[c]];
    const tl_facet *facets = &contacts->facet[contacts->facet_start[c]];
    for (uint32_t k = 0; k < contacts->facet_count[c]; k++)
        if (tl_v3_norm2(facets[k].swing) > 0)
            sum.moment = tl_v3_add(
                sum.moment, facet_couple(&facets[k], l->stored + (begin - first), &m->bodies.r[a]));
    contacts->force[c] = sum.force;
    contacts->moment[c] = sum.moment;
    if (!tl_v3_finite(sum.force) || !tl_v3_finite(sum.moment))
        tl_cycle_failed(m, begin, TL_E_NUMERIC, begin,
                        "the force is not a finite number: is the time step too large, or a "
                        "property out of proportion?");
}

/* Energy in the points of a page, and turned to heat there in this step. */
TL_VECTORIZED static tl_page_energy page_energy(const tl_point_lanes *l, size_t count)
{
    const double *stored = l->stored, *dissipated = l->dissipated;
    double s[TL_LANES] = {0}, d[TL_LANES] = {0};
    for (size_t i = 0; i < count; i += TL_LANES)
#pragma omp simd
        for (size_t k = 0; k < TL_LANES; k++) {
            s[k] += stored[i + k];
            d[k] += dissipated[i + k];
        }
    return (tl_page_energy){across(s) + across(s + 4), across(d) + across(d + 4)};
}

/* From the places of the bodies to the forces of the contacts on a page. */
static void force_page(const run_job *job, size_t page, const tl_point_lanes *l)
{
    tl_model *m = job->m;
    tl_points_table *p = &m->detect->points;
    size_t first = page * TL_PAGE, end = first + TL_PAGE;
    const uint32_t *owner = p->owner + first / TL_POINT_ROUND;
    job->m->cycle->page_energy[page] = (tl_page_energy){0, 0};
    if (*owner == TL_OWNED_BEFORE)
        return;
    while (end < job->run->end && p->owner[end / TL_POINT_ROUND] == TL_OWNED_BEFORE)
        end += TL_PAGE;
    end = end < job->run->end ? end : (job->run->end + TL_LANES - 1) / TL_LANES * TL_LANES;
    size_t count = end - first, groups = (count + TL_POINT_ROUND - 1) / TL_POINT_ROUND;
    tl_contacts_follow(m, first, count, l);
    if (!call_law(job, first, count, l))
        return;
    for (size_t g = 0; g < groups; g++)
        if (owner[g] < TL_OWNED_BEFORE)
            sum_contact(m, owner[g], l, first);
    m->cycle->page_energy[page] = page_energy(l, count);
}

static void force_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    const run_job *job = user;
    for (size_t page = begin; page < end; page++)
        force_page(job, job->run->begin / TL_PAGE + page, &job->m->detect->lanes[thread]);
}

void tl_cycle_failed(tl_model *m, size_t chunk, tl_status status, size_t point, const char *text)
{
    struct tl_cycle *cycle = m->cycle;
    pthread_mutex_lock(&cycle->failure_lock);
    if (cycle->failure.status == TL_OK || chunk < cycle->failure_chunk) {
        cycle->failure_chunk = chunk;
        cycle->failure_point = point;
        tl_fail(&cycle->failure, status, "%s", text);
    }
    pthread_mutex_unlock(&cycle->failure_lock);
}

/* Turns a failure in a parallel phase into the model's error, with the contact it came from. */
static tl_status report_failure(tl_model *m)
{
    struct tl_cycle *cycle = m->cycle;
    if (cycle->failure.status == TL_OK)
        return TL_OK;
    char name[320];
    uint32_t c = contact_of_point(&m->detect->contacts, cycle->failure_point);
    uint32_t material = m->detect->contacts.material[c];
    name_contact(m, c, name, sizeof name);
    tl_fail(&m->error, cycle->failure.status, "cycle %lld, law '%s', %s: %s",
            (long long)m->cycles + 1, m->materials[material].kind->name, name, cycle->failure.text);
    cycle->failure.status = TL_OK;
    return m->error.status;
}

tl_status tl_laws_apply(tl_model *m)
{
    tl_detect *d = m->detect;
    struct tl_cycle *cycle = m->cycle;
    if (!tl_grow(&cycle->page_energy, &cycle->page_room, d->points.table.rows / TL_PAGE,
                 sizeof *cycle->page_energy))
        return tl_fail_memory(&m->error);
    tl_follow_bodies(m);
    for (size_t r = 0; r < d->run_count; r++) {
        const tl_run *run = &d->runs[r];
        if (run->material == TL_NO_ROW)
            continue;
        run_job job = {m, &m->materials[run->material], run};
        size_t pages = (run->end - run->begin + TL_PAGE - 1) / TL_PAGE;
        tl_parallel_for(m->pool, pages, PAGE_CHUNK, force_range, &job);
    }
    return report_failure(m);
}

tl_status tl_laws_check(tl_model *m)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    bool lawless = false; /* almost never: the contacts are then looked through for one to name */
    for (size_t r = 0; r < d->run_count; r++)
        lawless = lawless || d->runs[r].material == TL_NO_ROW;
    for (uint32_t i = 0; lawless && i < c->table.rows; i++) {
        if (c->material[i] != TL_NO_ROW || c->point_count[i] == 0)
            continue;
        char name[320];
        name_contact(m, i, name, sizeof name);
        return tl_fail(&m->error, TL_E_STATE,
                       "%s has no law: set one with model:joint(\"*\", ...) or for that joint",
                       name);
    }
    return TL_OK;
}
