/* rest.c - whether the model is at rest: the unbalanced force ratios, and the motion that is left.
 *
 * A mean over all bodies says nothing of a small one among large ones that slides. So a solve ends, unless it is told
 * to look at another measure, when every single body is at rest:
 *
 *     |F| and |M| / r  <  ratio B          its unbalanced force, and moment over its radius
 *     (m v.v + w.I w) / 2  <  U times the smaller of ratio and S ratio^2
 *
 * with what the body bears, B: the sum of its contact forces, or its weight and load where these are more. B is at
 * least what its contacts carry at an overlap that is rounding. U = B^2 / (2 K) is the energy that B stores in the
 * springs of its contacts, of stiffness K. Without it a body that swings would be at rest each time it passes through
 * equilibrium. So would one that flies or slides on without a force. A body that swings on a spring of stiffness K with
 * the force ratio B has ratio^2 U. The whole may swing more softly than its contacts by S (SOFTER). A body without
 * contacts has its share, by mass, of the energy stored in all contacts for U. */
#include "cycle/rest.h"

#include "cycle/borne.h"
#include "cycle/contributors.h"
#include "cycle/energy.h"
#include "cycle/meshes.h"

#include <stdatomic.h>

/* Tolerance: how much softer than the contacts of one body the whole may swing, as a column of 30 blocks does. So much
 * more energy goes with the same force. Test: lua/test_rest. */
#define SOFTER 1e3

/* Kinetic energy over the energy that it is compared with, up to which a ratio takes it for rest. */
static double kinetic_share(double ratio)
{
    return ratio * (SOFTER * ratio < 1 ? SOFTER * ratio : 1);
}

/* Weight and loads of the bodies that can move. */
static double weight_of_all(const tl_model *m)
{
    const tl_bodies *b = &m->bodies;
    const double gravity = tl_v3_norm(m->config.gravity);
    tl_addends weight = {.count = 0};
    for (size_t body = 0; body < b->table.rows; body++)
        if (b->fixed[body] != TL_FIX_ALL)
            tl_addends_put(&weight, tl_weight_of(b, (uint32_t)body, gravity));
    return tl_addends_sum(&weight);
}

/* A sum over the bodies, over that of their contact forces or, without any, their weight. */
static double ratio_of(const tl_model *m, double sum)
{
    const double contact = m->cycle->sums.contact_force;
    const double against = contact > 0 ? contact : weight_of_all(m);
    return against > 0 ? sum / against : 0;
}

static double unbalanced_ratio(const tl_model *m, tl_ratio_measure measure)
{
    const tl_sums *s = &m->cycle->sums;
    if (measure == TL_RATIO_LOCAL)
        return s->local;
    return ratio_of(m, measure == TL_RATIO_MAXIMUM ? s->largest * (double)s->bodies : s->unbalanced);
}

tl_balance tl_model_balance(const tl_model *m)
{
    if (!m->cycle || m->cycles == 0)
        return (tl_balance){NAN, NAN, NAN, NAN};
    return (tl_balance){.ratio = unbalanced_ratio(m, TL_RATIO_AVERAGE),
                        .ratio_maximum = unbalanced_ratio(m, TL_RATIO_MAXIMUM),
                        .ratio_local = unbalanced_ratio(m, TL_RATIO_LOCAL),
                        .max_velocity = sqrt(m->cycle->sums.max_speed2)};
}

typedef struct rest_job {
    const tl_model *m;
    double ratio, gravity;
    double stored;           /* energy in all contacts per mass of the free bodies, J/kg */
    _Atomic uint32_t moving; /* the first body that does; TL_NO_ROW: none */
} rest_job;

static bool moves(const rest_job *job, uint32_t body)
{
    const tl_model *m = job->m;
    const tl_bodies *b = &m->bodies;
    double kinetic = tl_body_energy(m, body, m->bodies.fixed[body]);
    if (kinetic == 0)
        return false;
    double stiffness = tl_body_stiffness(m, body);
    double bears = tl_borne(m, body, tl_weight_of(b, body, job->gravity));
    bears = fmax(bears, tl_least_borne(b, body, stiffness));
    double stored = stiffness > 0 ? 0.5 * bears * bears / stiffness : b->mass[body] * job->stored;
    return !(kinetic < kinetic_share(job->ratio) * stored);
}

static void rest_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    (void)thread;
    rest_job *job = user;
    uint32_t body = (uint32_t)begin, first = atomic_load(&job->moving);
    while (body < end && (job->m->bodies.fixed[body] == TL_FIX_ALL || !moves(job, body)))
        body++;
    while (body < end && body < first && !atomic_compare_exchange_weak(&job->moving, &first, body)) {
    }
}

/* Whether no body moves any more than `ratio` allows. The first that does is the worst. Looked at only when forces are
 * in equilibrium. */
static bool all_rest(tl_model *m, double ratio)
{
    tl_addends free = {.count = 0};
    for (size_t body = 0; body < m->bodies.table.rows; body++)
        tl_addends_put(&free, m->bodies.fixed[body] == TL_FIX_ALL ? 0 : m->bodies.mass[body]);
    const double mass = tl_addends_sum(&free);
    tl_energy energy;
    tl_model_energy(m, &energy);
    rest_job job = {.m = m,
                    .ratio = ratio,
                    .gravity = tl_v3_norm(m->config.gravity),
                    .stored = mass > 0 ? energy.stored / mass : 0,
                    .moving = TL_NO_ROW};
    tl_parallel_for(m->pool, m->bodies.table.rows, TL_READ_CHUNK, rest_range, &job);
    const uint32_t mesh = tl_mesh_moving(m, kinetic_share(ratio)), moving = job.moving < mesh ? job.moving : mesh;
    if (moving == TL_NO_ROW)
        return true;
    m->cycle->sums.worst = moving;
    return false;
}

bool tl_at_rest(tl_model *m, tl_ratio_measure measure, double ratio)
{
    if (measure == TL_RATIO_LOCAL)
        return m->cycle->sums.worst_ratio < ratio && all_rest(m, ratio);
    /* moments, each over its body's radius: a block that spins up is not in equilibrium */
    return unbalanced_ratio(m, measure) < ratio && ratio_of(m, m->cycle->sums.turning) < ratio;
}
