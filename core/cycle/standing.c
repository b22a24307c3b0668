/* standing.c - how the model stands: at rest, failed, or on its way. */
#include "cycle/standing.h"

#include "cycle/cycle_data.h"
#include "cycle/rest.h"

/* Tolerance: the local ratio below which a model is at rest that has not been asked to come to one. */
#define REST_RATIO 1e-5
/* Tolerance: share of sum |F| |v| that the power of the unbalanced forces is where they push bodies on. */
#define PUSHES 0.5
/* Tolerance: unbalanced forces over what bodies bear below which nothing accelerates that could be told from
 * settling. */
#define LEAST_UNBALANCED 1e-3

/* Whether the unbalanced forces push bodies on, the way they go. */
static bool accelerates(const tl_model *m)
{
    const tl_bodies *b = &m->bodies;
    const double gravity = tl_v3_norm(m->config.gravity);
    tl_addends power = {.count = 0}, most = {.count = 0}, unbalanced = {.count = 0}, borne = {.count = 0};
    for (uint32_t body = 0; body < b->table.rows; body++) {
        if (b->fixed[body] == TL_FIX_ALL)
            continue;
        double force = tl_v3_norm(b->force[body]);
        tl_addends_put(&power, tl_v3_dot(b->force[body], b->v[body]));
        tl_addends_put(&most, force * tl_v3_norm(b->v[body]));
        tl_addends_put(&unbalanced, force);
        tl_addends_put(&borne, tl_borne(m, body, tl_weight_of(b, body, gravity)));
    }
    return tl_addends_sum(&power) > PUSHES * tl_addends_sum(&most) &&
           tl_addends_sum(&unbalanced) > LEAST_UNBALANCED * tl_addends_sum(&borne);
}

tl_standing tl_model_stands(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    if (!c || m->cycles == 0)
        return TL_STANDING_UNKNOWN;
    const uint32_t worst = c->sums.worst; /* to ask changes nothing */
    const bool rests = tl_at_rest(m, TL_RATIO_LOCAL, c->rest_ratio > 0 ? c->rest_ratio : REST_RATIO);
    c->sums.worst = worst;
    if (rests)
        return TL_STANDING_AT_REST;
    if (c->failing != TL_NO_ID)
        return TL_STANDING_FAILED;
    return accelerates(m) ? TL_STANDING_ACCELERATING : TL_STANDING_MOVING;
}

tl_id tl_model_failing(const tl_model *m)
{
    return m->cycle ? m->cycle->failing : TL_NO_ID;
}
