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
 * Each contributor has a term of its own, by its name: what it stores, and what it has turned to heat.
 *
 * The move books its bodies group by group (motion.c), while all that is needed is at hand. */
#include "cycle/energy.h"

#include "contact/detection.h"
#include "cycle/cycle_data.h"

#include <stdio.h>
#include <string.h>

/* Until now and after it, of a kind of work. */
#define UNTIL(kind) (TL_BOOK_WORK + 2 * (kind))
#define AFTER(kind) (UNTIL(kind) + 1)

/* What a force and a moment on a body do, each in the half step before and the one after. Lane i of a group, and number
 * `at` of the chunk. */
TL_INLINE double work_until(const tl_work *work, size_t i, const tl_body_group *g, tl_vec3 force, tl_vec3 moment)
{
    return work->until * (tl_v3_dot(force, tl_lanes3_get(&g->moved, i)) + tl_v3_dot(moment, tl_lanes3_get(&g->w0, i)));
}

TL_INLINE double work_after(const tl_work *work, size_t i, const tl_body_group *g, tl_vec3 force, tl_vec3 moment)
{
    return work->after * (tl_v3_dot(force, tl_lanes3_get(&g->v1, i)) + tl_v3_dot(moment, tl_lanes3_get(&g->w1, i)));
}

/* Kinetic energies. With v- and v+ the mean at the forces' time is v- + s (v+ - v-). s is the share of the step before
 * in both half steps. What two unequal halves spread about it is taken out. */
TL_INLINE void book_kinetic(tl_work *work, size_t at, size_t i, const tl_body_group *g, double share)
{
    double scale = g->energy_scale[i], mass = scale * g->mass[i], spread = share * (1 - share);
    tl_vec3 v0 = tl_lanes3_get(&g->v0, i), v1 = tl_lanes3_get(&g->v1, i), dv = tl_v3_sub(v1, v0);
    tl_vec3 w0 = tl_lanes3_get(&g->spin0, i), dw = tl_v3_sub(tl_lanes3_get(&g->spin1, i), w0);
    tl_vec3 l0 = tl_lanes3_get(&g->momentum0, i);
    tl_vec3 dl = tl_v3_sub(tl_lanes3_get(&g->momentum1, i), l0);
    tl_vec3 v = tl_v3_madd(v0, share, dv), w = tl_v3_madd(w0, share, dw);
    tl_vec3 l = tl_v3_madd(l0, share, dl);
    double dv2 = mass * tl_v3_norm2(dv), dw2 = scale * tl_v3_dot(dw, dl);
    work->book[TL_BOOK_KINETIC][at] = 0.5 * (mass * tl_v3_norm2(v) + scale * tl_v3_dot(w, l) - spread * (dv2 + dw2));
    /* The first kick from rest is half of one: what the whole one would have spread is missing from
     * the sum ever after. */
    work->book[TL_BOOK_FIRST][at] = 0.5 * (dv2 + dw2);
    work->book[TL_BOOK_MOTION0][at] = 0.5 * (mass * tl_v3_norm2(v0) + scale * g->turning0[i]);
    work->book[TL_BOOK_MOTION2][at] = 0.5 * (mass * tl_v3_norm2(v1) + scale * g->turning2[i]);
    /* a velocity set since the last step meets this kick, too */
    tl_vec3 set = tl_v3_sub(v0, tl_lanes3_get(&g->moved, i));
    work->book[UNTIL(TL_WORK_EXTERNAL)][at] = share * mass * tl_v3_dot(set, dv);
    work->book[AFTER(TL_WORK_EXTERNAL)][at] = 0;
}

/* A kick may have two unequal halves, s and 1 - s of it. Then the works of all that changes a velocity by dv miss
 * m (2 s - 1) dv^2 / 2 of what the kinetic energy becomes. For forces, which hardly change in a step, that is next to
 * nothing. A damping that stops bodies takes what it makes more of it, dv^2 - dF^2 with dv = dF + dD. */
TL_INLINE void book_uneven(tl_work *work, size_t at, size_t i, const tl_body_group *g)
{
    tl_vec3 slowed = tl_v3_add(tl_lanes3_get(&g->v0, i), tl_lanes3_get(&g->v1, i));
    tl_vec3 braked = tl_v3_add(tl_lanes3_get(&g->momentum0, i), tl_lanes3_get(&g->momentum1, i));
    double span = work->until + work->after, share = work->until / span;
    double by = -0.5 * g->alpha[i] * span;
    tl_vec3 dv = tl_v3_sub(tl_lanes3_get(&g->v1, i), tl_lanes3_get(&g->v0, i));
    tl_vec3 dw = tl_v3_sub(tl_lanes3_get(&g->spin1, i), tl_lanes3_get(&g->spin0, i));
    tl_vec3 turned = tl_v3_add(tl_lanes3_get(&g->spin1, i), tl_lanes3_get(&g->spin0, i));
    double moved = by * (2 * tl_v3_dot(dv, slowed) - by * tl_v3_norm2(slowed));
    double spun = by * (2 * tl_v3_dot(dw, braked) - by * tl_v3_dot(turned, braked));
    double more = fmax(g->scale[i] * g->mass[i] * moved, 0) + fmax(g->turn_scale[i] * spun, 0);
    double missed = (share - 0.5) * more;
    work->book[UNTIL(TL_WORK_DAMPING)][at] += share * missed;
    work->book[AFTER(TL_WORK_DAMPING)][at] += (1 - share) * missed;
}

/* (23) takes out alpha m (v- + v+) / 2 over the kick, m as mass scaling makes it, besides what the damping's force
 * does. */
TL_INLINE void book_damping(tl_work *work, size_t at, size_t i, const tl_body_group *g)
{
    double alpha = 0.5 * g->alpha[i] * g->scale[i], turning = 0.5 * g->alpha[i] * g->turn_scale[i];
    tl_vec3 slowed = tl_v3_add(tl_lanes3_get(&g->v0, i), tl_lanes3_get(&g->v1, i));
    tl_vec3 braked = tl_v3_add(tl_lanes3_get(&g->momentum0, i), tl_lanes3_get(&g->momentum1, i));
    tl_vec3 force = tl_v3_madd(tl_lanes3_get(&g->damping_force, i), -alpha * g->mass[i], slowed);
    tl_vec3 moment = tl_lanes3_get(&g->damping_moment, i);
    work->book[UNTIL(TL_WORK_DAMPING)][at] =
        work_until(work, i, g, force, moment) - work->until * turning * tl_v3_dot(braked, tl_lanes3_get(&g->spin0, i));
    work->book[AFTER(TL_WORK_DAMPING)][at] =
        work_after(work, i, g, force, moment) - work->after * turning * tl_v3_dot(braked, tl_lanes3_get(&g->spin1, i));
}

/* The work of loads, and of what holds some components of a body's motion at a velocity. */
static void book_load(tl_work *work, size_t at, size_t i, const tl_body_group *g, const tl_model *m)
{
    const tl_bodies *b = &m->bodies;
    uint32_t body = g->body[i];
    unsigned fixed = b->fixed[body];
    if (fixed == 0 && !m->loads_changed && !tl_body_loaded(b, body))
        return;
    work->external = true;
    tl_wrench load = tl_acting_load(m, body);
    tl_vec3 force = load.force, moment = load.moment;
    double *until = &work->book[UNTIL(TL_WORK_EXTERNAL)][at], *after = &work->book[AFTER(TL_WORK_EXTERNAL)][at];
    *until += work_until(work, i, g, force, moment);
    *after += work_after(work, i, g, force, moment);
    if (fixed == 0)
        return;
    tl_reaction by = tl_reaction_on(m->cycle, body);
    force = tl_v3_add(tl_v3_madd(by.force, b->mass[body], m->cycle->gravity), force);
    moment = tl_v3_add(by.moment, moment);
    force = tl_v3(fixed & TL_FIX_X ? -force.x : 0, fixed & TL_FIX_Y ? -force.y : 0, fixed & TL_FIX_Z ? -force.z : 0);
    moment = fixed & TL_FIX_ROTATION ? tl_v3_neg(moment) : tl_v3(0, 0, 0);
    *until += work_until(work, i, g, force, moment);
    *after += work_after(work, i, g, force, moment);
}

TL_VECTORIZED static void book_lanes(tl_work *restrict work, size_t first, const tl_body_group *restrict g,
                                     tl_vec3 gravity, bool damped)
{
    const tl_vec3 none = {0, 0, 0};
    double share = work->until / (work->until + work->after);
    for (size_t i = 0; i < TL_LANES; i++) {
        tl_vec3 weight = tl_v3_scale(g->mass[i], gravity);
        book_kinetic(work, first + i, i, g, share);
        work->book[UNTIL(TL_WORK_GRAVITY)][first + i] = work_until(work, i, g, weight, none);
        work->book[AFTER(TL_WORK_GRAVITY)][first + i] = work_after(work, i, g, weight, none);
    }
    for (size_t i = 0; damped && i < TL_LANES; i++)
        book_damping(work, first + i, i, g);
    for (size_t i = 0; damped && work->until != work->after && i < TL_LANES; i++)
        book_uneven(work, first + i, i, g);
}

void tl_energy_book(const tl_model *m, const tl_body_group *g, size_t first, tl_work *work)
{
    book_lanes(work, first, g, m->cycle->gravity, m->damping != NULL);
    for (size_t i = 0; i < g->count; i++)
        book_load(work, first + i, i, g, m);
}

void tl_energy_book_held(const tl_model *m, uint32_t body, tl_vec3 moved, tl_vec3 turned, tl_work *work)
{
    const tl_bodies *b = &m->bodies;
    /* what moves the body works against the contacts' reaction */
    tl_reaction by = tl_reaction_on(m->cycle, body);
    const size_t k = work->held_count++;
    work->held[0][k] = -work->until * (tl_v3_dot(by.force, moved) + tl_v3_dot(by.moment, turned));
    work->held[1][k] = -work->after * (tl_v3_dot(by.force, b->v[body]) + tl_v3_dot(by.moment, b->w[body]));
}

static bool any(const double *number, size_t count)
{
    bool some = false;
    for (size_t i = 0; i < count; i++)
        some |= number[i] != 0;
    return some;
}

void tl_energy_chunk(tl_model *m, unsigned thread, const tl_work *work, size_t count)
{
    tl_exact *sum = m->cycle->booked[thread].sum;
    if (work->held_count > 0)
        tl_exact_add_each(sum + TL_BOOK_EXTERNAL, 2, work->held[0], TL_BODY_CHUNK, work->held_count);
    if (count == 0)
        return;
    tl_exact_add_each(sum, TL_BOOK_EXTERNAL, work->book[0], TL_BODY_CHUNK, count);
    if (work->external || any(work->book[TL_BOOK_EXTERNAL], count))
        tl_exact_add_each(sum + TL_BOOK_EXTERNAL, 2, work->book[TL_BOOK_EXTERNAL], TL_BODY_CHUNK, count);
    if (m->damping)
        tl_exact_add_each(sum + TL_BOOK_DAMPING, 2, work->book[TL_BOOK_DAMPING], TL_BODY_CHUNK, count);
    if (!(work->until > 0))
        tl_exact_add(&sum[TL_BOOK_FIRST], work->book[TL_BOOK_FIRST], count);
}

/* ---------------------------------------------------------------- the balance ------------ */

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

/* Asks all contributors; their sum: stored now, and heat of this step. */
static tl_energies ask_contributors(tl_model *m)
{
    tl_energies sum = {0, 0};
    for (tl_contributors with = m->cycle->contributor; *with; with++) {
        if (!(*with)->energies)
            continue;
        tl_energies own = (*with)->energies(m);
        tl_energy_term *term = term_of(&m->cycle->ledger, (*with)->name);
        term->stored = own.stored;
        term->heat += own.heat;
        sum.stored += own.stored;
        sum.heat += own.heat;
    }
    return sum;
}

/* Notes the terms at the forces' time. */
static void note_terms(tl_ledger *l, const double now[TL_BOOK_COUNT], double stored)
{
    tl_energy *e = &l->energy;
    double at[TL_WORK_COUNT];
    for (int w = 0; w < TL_WORK_COUNT; w++) {
        at[w] = l->work[w] + now[UNTIL(w)];
        l->work[w] = at[w] + now[AFTER(w)];
    }
    e->kinetic = now[TL_BOOK_KINETIC];
    e->stored = stored;
    e->potential = -at[TL_WORK_GRAVITY];
    e->damping = -at[TL_WORK_DAMPING];
    e->external = at[TL_WORK_EXTERNAL] + l->by_hand;
    e->friction = 0;
    for (size_t k = 0; k < TL_MOST_CONTRIBUTORS; k++)
        e->friction += l->term[k].heat;
}

/* The balance of the terms. `changed`: by something else than forces. */
static void balance(tl_ledger *l, bool first, bool changed)
{
    tl_energy *e = &l->energy;
    const double gains[] = {e->kinetic - l->start_kinetic, e->potential, e->stored - l->start_stored, e->friction,
                            e->damping};
    double sum = 0, largest = fmax(e->kinetic, l->start_kinetic);
    for (size_t k = 0; k < sizeof gains / sizeof *gains; k++) {
        sum += gains[k];
        largest = fmax(largest, fabs(gains[k]));
    }
    sum -= e->external;
    if (changed && !first) { /* what a deleted block's contacts held, or another law of them holds */
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

bool tl_energy_pushed(const tl_model *m, tl_overlap_push *by)
{
    const tl_ledger *l = &m->cycle->ledger;
    const tl_energy *e = &l->energy;
    *by = (tl_overlap_push){l->overlap_a, l->overlap_b, l->overlaps - e->stored, fmax(0, e->external - e->potential)};
    return by->gave > by->others;
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

void tl_energy_begin(tl_model *m)
{
    for (unsigned t = 0; t < tl_pool_threads(m->pool); t++)
        m->cycle->booked[t] = (tl_booked){{{.window = 0}}};
}

void tl_energy_close(tl_model *m)
{
    tl_ledger *l = &m->cycle->ledger;
    double now[TL_BOOK_COUNT];
    sum_booked(m, now);
    const tl_energies own = ask_contributors(m);
    const bool first = !l->started, changed = l->structure != m->structure || l->laws != m->laws;
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
    note_terms(l, now, own.stored);
    balance(l, first, changed);
}

tl_status tl_model_energy(tl_model *m, tl_energy *energy)
{
    *energy = m->cycle ? m->cycle->ledger.energy : (tl_energy){0};
    return TL_OK;
}

double tl_spin_energy2(const tl_model *m, uint32_t body)
{
    const tl_bodies *b = &m->bodies;
    tl_vec3 w = tl_q_rotate(tl_q_conj(tl_q_mul(b->q[body], b->axes[body])), b->w[body]);
    if (m->config.rotation == TL_ROTATION_PAPER)
        return b->round[body] * tl_v3_norm2(w);
    tl_vec3 i = b->moments[body];
    return i.x * w.x * w.x + i.y * w.y * w.y + i.z * w.z * w.z;
}
