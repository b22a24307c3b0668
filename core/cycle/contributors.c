/* contributors.c - the list of what acts on bodies, and each phase's question to all of it. */
#include "cycle/contributors.h"

#include "cycle/contact_forces.h"

/* Those of every model. */
static const tl_contributor *const known[] = {&tl_contacts_act};

_Static_assert(sizeof known / sizeof *known <= TL_MOST_CONTRIBUTORS, "there is room for all");

/* The contributors of a model; NULL ends them. */
typedef const tl_contributor *const *tl_list;

static tl_list list_of(const tl_model *m)
{
    return m->cycle->contributor;
}

void tl_contributors_begin(struct tl_cycle *cycle)
{
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        cycle->contributor[k] = known[k];
}

tl_status tl_contributors_prepare(tl_model *m)
{
    tl_status status = TL_OK;
    for (tl_list with = list_of(m); *with && status == TL_OK; with++)
        if ((*with)->prepare)
            status = (*with)->prepare(m);
    return status;
}

tl_status tl_contributors_apply(tl_model *m)
{
    tl_status status = TL_OK;
    for (tl_list with = list_of(m); *with && status == TL_OK; with++)
        if ((*with)->apply)
            status = (*with)->apply(m);
    return status;
}

void tl_contributors_gather(const tl_model *m, uint32_t begin, uint32_t end, tl_acting *on)
{
    for (uint32_t k = 0; k < end - begin; k++)
        on[k] = (tl_acting){.magnitude = 0};
    for (tl_list with = list_of(m); *with; with++)
        if ((*with)->gather)
            (*with)->gather(m, begin, end, on);
}

double tl_body_stiffness(const tl_model *m, uint32_t body)
{
    double sum = 0;
    for (tl_list with = list_of(m); *with; with++)
        sum += (*with)->stiffness ? (*with)->stiffness(m, body) : 0;
    return sum;
}

tl_holding tl_body_held(const tl_model *m, uint32_t body, bool points)
{
    tl_holding sum = {.law = 0};
    for (tl_list with = list_of(m); *with; with++)
        if ((*with)->hold)
            (*with)->hold(m, body, points, &sum);
    return sum;
}

tl_holding tl_body_held_most(const tl_model *m, uint32_t body)
{
    tl_holding sum = {.law = 0};
    for (tl_list with = list_of(m); *with; with++)
        if ((*with)->hold_most)
            (*with)->hold_most(m, body, &sum);
        else if ((*with)->hold)
            (*with)->hold(m, body, true, &sum);
    return sum;
}

double tl_body_approach(const tl_model *m, uint32_t body)
{
    double most = 0;
    for (tl_list with = list_of(m); *with; with++)
        most = fmax(most, (*with)->approach ? (*with)->approach(m, body) : 0);
    return most;
}

tl_energies tl_contributors_energies(tl_model *m)
{
    tl_energies sum = {0, 0};
    for (tl_list with = list_of(m); *with; with++) {
        tl_energies own = (*with)->energies ? (*with)->energies(m) : (tl_energies){0, 0};
        sum.stored += own.stored;
        sum.heat += own.heat;
    }
    return sum;
}
