/* law.h - a joint's law: which contacts it is for, its plugin, its properties, and what they mean for contacts; and
 * the minimum areas of a joint. */
#ifndef TL_MODEL_LAW_H
#define TL_MODEL_LAW_H

#include "base/table.h"
#include "geometry/polyhedron.h"

#include <talus/plugin.h>

/* Ids of blocks: bit id % 64 of word id / 64. */
typedef struct tl_id_set {
    uint64_t *word;
    size_t words;
} tl_id_set;

/* Blocks that a scope names: those that are in a group now, or those of a list with the parts they are cut into. */
typedef struct tl_scope_side {
    uint32_t group; /* index into the model's groups, or TL_NO_ROW */
    tl_id_set list; /* without a group */
} tl_scope_side;

/* Which contacts a law is for: those of a joint, between blocks that it names (scope.c). */
typedef struct tl_scope {
    tl_tag tag;            /* "*" (joint 0), a set (plane 0) or one plane */
    uint32_t names;        /* how many of a contact's two blocks it names: 0, 1 or 2 */
    tl_scope_side side[2]; /* the first `names` of them count; not where there are pairs */
    uint64_t *pairs;       /* of ids a < b: a 2^32 + b, ascending; NULL: it names none */
    size_t pair_count;
    uint64_t order; /* counts the laws that were named for blocks: the later wins */
} tl_scope;

/* A law with its properties, for a joint or for a part of its contacts. */
typedef struct tl_law {
    tl_scope scope;
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

/* A rule for the minimum area of field contacts. */
typedef struct tl_min_area_rule {
    double fraction;
    double absolute; /* NaN: by the fraction */
} tl_min_area_rule;

typedef struct tl_joint_min_area {
    tl_tag tag;
    tl_min_area_rule rule;
} tl_joint_min_area;

/* Whether a point of that state may pull. `flags`: TL_POINT_*. */
static inline bool tl_law_may_pull(const tl_law *law, uint32_t flags)
{
    return law->pulls == TL_PULL_ANY || (law->pulls == TL_PULL_BONDED && !(flags & TL_POINT_FAILED));
}

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
