/* contact_beta.h - how much contacts are damped. */
#ifndef TL_CYCLE_CONTACT_BETA_H
#define TL_CYCLE_CONTACT_BETA_H

#include "model/model.h"

/* Damping of a contact over its stiffness, s; 0: there is none. */
static inline double tl_contact_beta(const tl_model *m)
{
    double beta = 0;
    const tl_damping_ops *ops = m->damping && !m->relaxing ? m->damping->ops : NULL;
    if (ops && ops->contact)
        ops->contact(m->damping_self, &beta);
    return beta;
}

#endif
