/* energy.c - the energy ledger of the bodies that are free to move.
 *
 * In a central-difference march the sum that is conserved belongs to whole steps. Let v- and v+ be the velocities
 * before and after the kick at step n. The kinetic energy at n is m v-.v+ / 2. The work of a force over a step is the
 * mean of its values at both ends times the motion. So each force's work is booked in two halves: F_n.v- times half of
 * the step before belongs to time n, F_n.v+ times half of the step after belongs to what follows. Elastic energy and
 * slip come from the laws with the same mean. The error of the balance is of the second order in omega dt.
 *
 * Velocities may be set and bodies held, driven or freed between two steps: the kinetic energy this gives or takes
 * counts as external work, and the work until then goes by the motion that was made. So does what partial mass scaling
 * adds to moving bodies and takes from them (added_mass.c). What contacts lose or gain counts likewise when blocks are
 * deleted, made, joined or parted, or laws changed: it is what the sum of that step lacks.
 *
 * Each contributor has a term of its own, by its name: what it stores, and what it has turned to heat. Those of the
 * zones are told by themselves, all others together as `stored` and `friction`. What contributors bring in from outside
 * is external work.
 *
 * The move books its bodies group by group (motion.c), while all that is needed is at hand. */
#include "cycle/energy.h"

#include "contact/detection.h"
#include "cycle/element_forces.h"
#include "cycle/zone_forces.h"

#include <stdio.h>
#include <string.h>
#include <talus/elements.h>

/* The term of a contributor; a new one at the end. Only a file can be full of others: the last one is shared then. */
static tl_energy_term *term_of(tl_ledger *l, const char *name)
{
    tl_energy_term *term = l->term, *last = l->term + TL_MOST_CONTRIBUTORS - 1;
    while (term < last && term->name[0] && strncmp(term->name, name, TL_TERM_NAME - 1) != 0)
        term++;
    if (!term->name[0])
        snprintf(term->name, sizeof term->name, "%s", name);
    return term;
}

/* What all but the zones store, and what zones do. */
typedef struct stored_now {
    double contacts, zones;
} stored_now;

/* Asks all contributors; their sum: stored now, and heat of this step. */
static tl_energies ask_contributors(tl_model *m, stored_now *now)
{
    tl_energies sum = {.stored = 0};
    *now = (stored_now){0, 0};
    for (tl_contributors with = m->cycle->contributor; *with; with++) {
        if (!(*with)->energies)
            continue;
        tl_energies own = (*with)->energies(m);
        tl_energy_term *term = term_of(&m->cycle->ledger, (*with)->name);
        term->stored = own.stored;
        term->heat += own.heat;
        *(*with == &tl_zones_act ? &now->zones : &now->contacts) += own.stored;
        sum.heat += own.heat;
        sum.given += own.given;
    }
    sum.stored = now->contacts + now->zones;
    return sum;
}

/* What zones store and have turned to heat. */
static tl_zone_energy zones_of(const tl_ledger *l)
{
    for (size_t k = 0; k < TL_MOST_CONTRIBUTORS; k++)
        if (strcmp(l->term[k].name, tl_zones_act.name) == 0)
            return (tl_zone_energy){l->term[k].stored, l->term[k].heat};
    return (tl_zone_energy){0, 0};
}

/* Notes the terms at the forces' time. `stored`: by all but zones. */
static void note_terms(tl_ledger *l, const double now[TL_BOOK_COUNT], double stored)
{
    tl_energy *e = &l->energy;
    double at[TL_WORK_COUNT];
    for (int w = 0; w < TL_WORK_COUNT; w++) {
        at[w] = l->work[w] + now[TL_BOOK_UNTIL(w)];
        l->work[w] = at[w] + now[TL_BOOK_AFTER(w)];
    }
    e->kinetic = now[TL_BOOK_KINETIC];
    e->stored = stored;
    e->potential = -at[TL_WORK_GRAVITY];
    e->damping = -at[TL_WORK_DAMPING];
    e->external = at[TL_WORK_EXTERNAL] + l->by_hand + l->given;
    e->friction = 0;
    for (size_t k = 0; k < TL_MOST_CONTRIBUTORS; k++)
        e->friction += strcmp(l->term[k].name, tl_zones_act.name) != 0 ? l->term[k].heat : 0;
}

/* The balance of the terms. `changed`: by something else than the forces of a march. That is what a deleted block's
 * contacts held, or another law of them holds, and what a relaxation does by its own inertia and stops. */
static void balance(tl_ledger *l, bool first, bool changed)
{
    tl_energy *e = &l->energy;
    const tl_zone_energy zones = zones_of(l);
    const double stored = e->stored + zones.strain - l->start_stored;
    const double gains[] = {e->kinetic - l->start_kinetic, e->potential, stored, e->friction + zones.plastic,
                            e->damping};
    double sum = 0, largest = fmax(e->kinetic, l->start_kinetic);
    for (size_t k = 0; k < sizeof gains / sizeof *gains; k++) {
        sum += gains[k];
        largest = fmax(largest, fabs(gains[k]));
    }
    sum -= e->external;
    if (changed) {
        e->external += sum - l->error;
        l->by_hand += sum - l->error;
        sum = l->error;
    }
    l->error = sum;
    /* Not of this moment's terms: where all pass through zero at once the ratio would mean nothing. */
    if (!first)
        l->largest = fmax(l->largest, fmax(largest, fabs(e->external)));
    e->balance = l->largest > 0 ? sum / l->largest : 0;
}

/* What contacts store before anything has moved, but under an initial stress: their blocks were made so. */
static void note_overlaps(const tl_model *m, tl_ledger *l)
{
    const tl_contacts *c = &m->detect->contacts;
    tl_addends overlaps = {.count = 0};
    double most = 0;
    for (uint32_t row = 0; row < c->table.rows && !m->detect->points.initial; row++) {
        const double stored = c->stored[row] > 0 ? c->stored[row] : 0;
        tl_addends_put(&overlaps, stored);
        if (stored <= most)
            continue;
        most = stored;
        l->overlap_a = m->blocks.id[c->a[row]];
        l->overlap_b = m->blocks.id[c->b[row]];
    }
    l->overlaps += tl_addends_sum(&overlaps);
}

/* What all threads have booked in this step. */
static void sum_booked(tl_model *m, double now[TL_BOOK_COUNT])
{
    tl_booked *all = m->cycle->booked;
    for (int k = 0; k < TL_BOOK_COUNT; k++) {
        for (unsigned t = 1; t < tl_pool_threads(m->pool); t++)
            tl_exact_merge(&all->sum[k], &all[t].sum[k]);
        now[k] = tl_exact_value(&all->sum[k]);
    }
}

void tl_balance_note(tl_model *m)
{
    const double error = fabs(m->cycle->ledger.energy.balance), most = m->timestep.error;
    const double left = fmax(0, fmin(1, 2 * (1 - error / most)));
    m->detect->balance_left =
        m->timestep.rule == TL_TIMESTEP_BALANCE && !m->relaxing && m->cycle->ledger.started ? left : 0;
}

void tl_energy_close(tl_model *m)
{
    tl_ledger *l = &m->cycle->ledger;
    double now[TL_BOOK_COUNT];
    sum_booked(m, now);
    stored_now stored;
    const tl_energies own = ask_contributors(m, &stored);
    const bool first = !l->started, edited = !first && (l->structure != m->structure || l->laws != m->laws);
    if (first) {
        note_overlaps(m, l);
        l->start_kinetic = now[TL_BOOK_KINETIC] - now[TL_BOOK_FIRST];
        /* what a law lets go of an initial stress before anything has moved was stored, too */
        l->start_stored = own.stored + own.heat;
        l->started = true;
    } else {
        l->by_hand += now[TL_BOOK_MOTION0] - l->motion; /* the same sum as then, so 0 when nobody touched it */
    }
    l->motion = now[TL_BOOK_MOTION2];
    l->structure = m->structure;
    l->laws = m->laws;
    m->cycle->kinetic_before = now[TL_BOOK_MOTION0];
    l->given += own.given;
    note_terms(l, now, stored.contacts);
    balance(l, first, edited || m->relaxing);
    tl_balance_note(m);
}

tl_status tl_model_energy(tl_model *m, tl_energy *energy)
{
    *energy = m->cycle ? m->cycle->ledger.energy : (tl_energy){0};
    return TL_OK;
}

tl_status tl_model_zone_energy(tl_model *m, tl_zone_energy *energy)
{
    *energy = m->cycle ? zones_of(&m->cycle->ledger) : (tl_zone_energy){0};
    return TL_OK;
}

tl_status tl_model_element_energy(tl_model *m, tl_element_energy *energy)
{
    *energy = (tl_element_energy){0, 0, 0};
    const tl_ledger *l = m->cycle ? &m->cycle->ledger : NULL;
    for (size_t k = 0; l && k < TL_MOST_CONTRIBUTORS; k++)
        if (strcmp(l->term[k].name, tl_elements_act.name) == 0)
            *energy = (tl_element_energy){l->term[k].stored, l->term[k].heat, l->given};
    return TL_OK;
}

/* w.I w, J. */
static double spin_energy2(const tl_model *m, uint32_t body)
{
    const tl_bodies *b = &m->bodies;
    tl_vec3 w = tl_q_rotate(tl_q_conj(tl_q_mul(b->q[body], b->axes[body])), b->w[body]);
    if (m->config.rotation == TL_ROTATION_PAPER)
        return b->round[body] * tl_v3_norm2(w);
    tl_vec3 i = b->moments[body];
    return i.x * w.x * w.x + i.y * w.y * w.y + i.z * w.z * w.z;
}

double tl_body_energy(const tl_model *m, uint32_t body, unsigned held)
{
    const tl_bodies *b = &m->bodies;
    const double spin = held & TL_FIX_ROTATION ? 0 : spin_energy2(m, body);
    return 0.5 * tl_energy_scale(m->cycle, body) * (b->mass[body] * tl_v3_norm2(tl_free_part(b->v[body], held)) + spin);
}
