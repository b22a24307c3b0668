/* contact_beta.h - how much contacts are damped. */
#ifndef TL_CYCLE_CONTACT_BETA_H
#define TL_CYCLE_CONTACT_BETA_H

#include "cycle/cycle_data.h"
#include "zone/zones.h"

/* Damping of a contact over its stiffness, s; 0: there is none. */
static inline double tl_contact_beta(const tl_model *m)
{
    double beta = 0;
    const tl_damping_ops *ops = m->damping && !m->relaxing ? m->damping->ops : NULL;
    if (ops && ops->contact)
        ops->contact(m->damping_self, &beta);
    return beta;
}

/* It is about to be another one, or was: bodies and gridpoints are rated anew in the next step. */
static inline void tl_contact_beta_changes(tl_model *m)
{
    if (m->cycle)
        m->cycle->stiffness_rates.version = 0;
    if (m->zones)
        m->zones->rated_for = 0;
}

#endif
