/* contributors.c - the list of what acts on bodies. Each phase of a step asks all of it. */
#include "cycle/contributors.h"

#include "cycle/contact_forces.h"
#include "cycle/gridpoints.h"

/* Those of every model. */
static const tl_contributor *const known[] = {&tl_contacts_act};

_Static_assert(sizeof known / sizeof *known + 1 <= TL_MOST_CONTRIBUTORS, "there is room for all");

void tl_contributors_begin(struct tl_cycle *cycle)
{
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        cycle->contributor[k] = known[k];
}

void tl_contributors_list(tl_model *m)
{
    const tl_contributor **at = m->cycle->contributor;
    while (*at && *at != &tl_zones_act)
        at++;
    if (!*at && tl_model_deforms(m) && at < m->cycle->contributor + TL_MOST_CONTRIBUTORS)
        *at = &tl_zones_act;
    for (; *at && !tl_model_deforms(m); at++) /* its meshes have gone */
        at[0] = at[1];
}

double tl_body_stiffness(const tl_model *m, uint32_t body)
{
    double sum = 0;
    for (tl_contributors with = m->cycle->contributor; *with; with++)
        sum += (*with)->stiffness ? (*with)->stiffness(m, body) : 0;
    return sum;
}
