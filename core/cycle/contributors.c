/* contributors.c - the list of what acts on bodies. Each phase of a step asks all of it. */
#include "cycle/contributors.h"

#include "cycle/contact_forces.h"
#include "cycle/element_forces.h"
#include "cycle/zone_forces.h"
#include "element/elements.h"
#include "segment/segments.h"
#include "zone/zones.h"

/* Those of every model. */
static const tl_contributor *const known[] = {&tl_contacts_act};

_Static_assert(sizeof known / sizeof *known + 3 <= TL_MOST_CONTRIBUTORS, "there is room for all");

void tl_contributors_begin(struct tl_cycle *cycle)
{
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        cycle->contributor[k] = known[k];
}

/* Adds one at the end, or takes it out. */
static void list_if(struct tl_cycle *cycle, const tl_contributor *one, bool acts)
{
    const tl_contributor **at = cycle->contributor, **end = at + TL_MOST_CONTRIBUTORS;
    while (*at && *at != one)
        at++;
    if (!*at && acts && at < end)
        *at = one;
    for (; *at && !acts; at++)
        at[0] = at[1];
}

void tl_contributors_list(tl_model *m)
{
    list_if(m->cycle, &tl_zones_act, tl_model_deforms(m));
    list_if(m->cycle, &tl_segments_act, tl_model_deforms(m));
    list_if(m->cycle, &tl_elements_act, tl_model_has_elements(m));
}

double tl_body_stiffness(const tl_model *m, uint32_t body)
{
    double sum = 0;
    for (tl_contributors with = m->cycle->contributor; *with; with++)
        sum += (*with)->stiffness ? (*with)->stiffness(m, body) : 0;
    return sum;
}

tl_wrench tl_body_pushed(const tl_model *m, uint32_t body)
{
    tl_acting on = {{0, 0, 0}, {0, 0, 0}, 0};
    const bool segments = m->segments && m->segments->structure == m->structure;
    for (tl_contributors with = m->cycle ? m->cycle->contributor : NULL; with && *with; with++)
        if (*with != &tl_contacts_act && (*with)->gather && (*with != &tl_segments_act || segments))
            (*with)->gather(m, body, body + 1, &on);
    return (tl_wrench){on.force, on.moment};
}
