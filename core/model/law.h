/* law.h - a joint's law: its plugin, its properties, and what they mean for contacts. */
#ifndef TL_MODEL_LAW_H
#define TL_MODEL_LAW_H

#include "base/table.h"
#include "geometry/polyhedron.h"

#include <talus/plugin.h>

/* A law with its properties, for a joint: for "*" (joint 0), for a set (plane 0) or for one plane. */
typedef struct tl_law {
    tl_tag tag;
    const tl_kind *kind;
    void *params; /* the plugin's params struct */
    void *self;   /* what its create made, or params */
    double kn, ks;
    uint32_t tangents; /* bit k: states k, k + 1, k + 2 are a vector in the common plane */
    uint32_t columns;  /* of states that are to be kept */
    bool splits;       /* some state goes with the area */
    uint32_t energy;   /* column of what shear holds beyond its springs, or TL_NO_ROW */
    uint32_t pulls;    /* TL_PULL_* */
} tl_law;

/* Whether what presses has the force kn A u, or else whether the law tells of the energy it has. */
static inline bool tl_law_is_linear(const tl_law *law)
{
    return ((const tl_law_ops *)law->kind->ops)->linear != 0;
}

static inline bool tl_law_presses(const tl_law *law)
{
    return !tl_law_is_linear(law) && ((const tl_law_ops *)law->kind->ops)->pressed;
}

/* Whether its shear springs may hold more than f^2 / (2 ks area): it keeps an energy of its own, or a stress beside
 * the force. */
static inline bool tl_law_has_own_shear(const tl_law *law)
{
    return law->energy != TL_NO_ROW || law->tangents;
}

/* Whether slip may open a joint. */
static inline bool tl_law_opens(const tl_law *law)
{
    return law->columns > 0 && ((const tl_law_ops *)law->kind->ops)->across_gap;
}

#endif
