/* laws.c - contact forces: the laws' plugins called on runs of contact points, and the sum per contact.
 *
 * A law gets up to TL_POINT_CHUNK points of one material at once, as the columns themselves. */
#include "cycle/cycle_room.h"

#include <stdio.h>

typedef struct run_job {
    tl_model *m;
    const tl_material *material;
    size_t begin;
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

static void run_law(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)thread;
    const run_job *job = user;
    tl_detect *d = job->m->detect;
    tl_points_table *p = &d->points;
    size_t at = job->begin + begin;
    double *state[TL_STATE_COLUMNS];
    for (int k = 0; k < TL_STATE_COLUMNS; k++)
        state[k] = p->state[k] + at;
    tl_law_batch batch = {.size = sizeof batch,
                          .count = (uint32_t)(end - begin),
                          .dt = job->m->dt,
                          .area = p->area + at,
                          .closure = p->closure + at,
                          .f_n0 = p->f_n0 + at,
                          .normal = {p->normal[0] + at, p->normal[1] + at, p->normal[2] + at},
                          .du_n = p->du_n + at,
                          .du_s = {p->du_s[0] + at, p->du_s[1] + at, p->du_s[2] + at},
                          .f_n = p->f_n + at,
                          .f_s = {p->f_s[0] + at, p->f_s[1] + at, p->f_s[2] + at},
                          .state = state,
                          .flags = p->flags + at,
                          .stored = p->stored + at,
                          .dissipated = p->dissipated + at};
    const tl_law_ops *ops = job->material->kind->ops;
    tl_report report = {.size = sizeof report};
    tl_status status = ops->update(job->material->self, &batch, &report);
    if (status != TL_OK)
        tl_cycle_failed(job->m, job->begin / TL_LANES + chunk, status, at + report.first_bad,
                        report.text);
}

/* The couple on B by which the areas of a facet, where they depend on tilt, do work: what the springs
 * gain or lose with their areas, the bodies lose or gain. Areas keep the points' stresses, so the energy
 * stored in them is in proportion. */
static tl_vec3 facet_couple(const tl_points_table *p, const tl_facet *f, size_t begin,
                            const tl_mat3 *ra)
{
    double stored = 0;
    for (size_t i = begin + f->begin; i < begin + f->begin + f->count; i++)
        stored += p->stored[i];
    return tl_v3_scale(stored, tl_m3_mul(ra, f->swing));
}

/* Sums of a contact's points: the force on B, and the moments about both bodies' centroids. */
static void sum_contact(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    tl_vec3 force = {0, 0, 0}, moment = {0, 0, 0};
    size_t begin = contacts->point_start[c], end = begin + contacts->point_count[c];
    for (size_t i = begin; i < end; i++) {
        double f_n = p->f_n[i];
        tl_vec3 f = {f_n * p->normal[0][i] + p->f_s[0][i], f_n * p->normal[1][i] + p->f_s[1][i],
                     f_n * p->normal[2][i] + p->f_s[2][i]};
        force = tl_v3_add(force, f);
        moment = tl_v3_add(moment, tl_v3_cross(p->arm[i], f));
    }
    tl_vec3 apart =
        tl_body_apart(&m->bodies, m->blocks.body[contacts->a[c]], m->blocks.body[contacts->b[c]]);
    const tl_mat3 *ra = &m->bodies.r[m->blocks.body[contacts->a[c]]];
    const tl_facet *facets = &contacts->facet[contacts->facet_start[c]];
    for (uint32_t k = 0; k < contacts->facet_count[c]; k++)
        if (tl_v3_norm2(facets[k].swing) > 0)
            moment = tl_v3_add(moment, facet_couple(p, &facets[k], begin, ra));
    contacts->force[c] = force;
    contacts->moment_a[c] = tl_v3_neg(moment);
    contacts->moment_b[c] = tl_v3_sub(moment, tl_v3_cross(apart, force));
}

static void sum_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)thread;
    tl_model *m = user;
    tl_contacts *contacts = &m->detect->contacts;
    for (size_t c = begin; c < end; c++) {
        sum_contact(m, (uint32_t)c);
        if (!tl_v3_finite(contacts->force[c]) || !tl_v3_finite(contacts->moment_a[c]))
            tl_cycle_failed(m, chunk, TL_E_NUMERIC, contacts->point_start[c],
                            "the force is not a finite number: is the time step too large, or a "
                            "property out of proportion?");
    }
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
    for (size_t r = 0; r < d->run_count; r++) {
        const tl_run *run = &d->runs[r];
        if (run->material == TL_NO_ROW)
            continue;
        run_job job = {m, &m->materials[run->material], run->begin};
        size_t points = (run->end - run->begin + TL_LANES - 1) / TL_LANES * TL_LANES;
        tl_parallel_for(m->pool, points, TL_POINT_CHUNK, run_law, &job);
    }
    tl_status status = report_failure(m);
    if (status != TL_OK)
        return status;
    tl_parallel_for(m->pool, d->contacts.table.rows, TL_BODY_CHUNK, sum_range, m);
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
