/* standing.c - how the model stands: at rest, failed, or on its way; and how far its joints' closing under load moves blocks. */
#include "cycle/standing.h"

#include "cycle/cycle_data.h"

#include "contact/detection.h"
#include "model/body_shape.h"

/* The local ratio below which a model is at rest that has not been asked to come to one. */
#define REST_RATIO 1e-5
/* Share of sum |F| |v| that the power of the unbalanced forces is where they push bodies on. */
#define PUSHES 0.5
/* Unbalanced forces over what bodies bear below which nothing accelerates that could be told from settling. */
#define LEAST_UNBALANCED 1e-3
/* A column under sudden weight settles by about 1.5 times its closure. */
#define SUDDEN 2.0

double tl_blocks_on_end(const tl_model *m)
{
    tl_vec3 low = {INFINITY, INFINITY, INFINITY}, high = tl_v3_neg(low);
    double sizes = 0, count = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        if (m->bodies.fixed[body] == TL_FIX_ALL)
            continue;
        tl_vec3 x = tl_body_place(&m->bodies, body);
        low = tl_v3(fmin(low.x, x.x), fmin(low.y, x.y), fmin(low.z, x.z));
        high = tl_v3(fmax(high.x, x.x), fmax(high.y, x.y), fmax(high.z, x.z));
        sizes += tl_body_size(m, body);
        count++;
    }
    return count > 0 ? 1 + tl_v3_norm(tl_v3_sub(high, low)) * count / sizes : 1;
}

double tl_settlement(const tl_model *m, double on_end)
{
    const tl_contacts *c = &m->detect->contacts;
    double force = 0, force_closure = 0;
    for (uint32_t i = 0; i < c->table.rows; i++) {
        double f = tl_v3_norm(c->force[i]);
        if (!(f > 0) || c->held[i])
            continue;
        const tl_law *law = &m->joint_laws[c->law[i]];
        double k = law->ks > 0 && law->ks < law->kn ? law->ks : law->kn;
        force += f;
        force_closure += k > 0 && c->area[i] > 0 ? f * f / (k * c->area[i]) : 0;
    }
    return force > 0 ? on_end * force_closure / force : 0;
}

double tl_closed_by_weight(const tl_model *m)
{
    return m->detect ? SUDDEN * tl_settlement(m, tl_blocks_on_end(m)) : 0;
}

/* Whether the unbalanced forces push bodies on, the way they go. */
static bool accelerates(const tl_model *m)
{
    const tl_bodies *b = &m->bodies;
    const double gravity = tl_v3_norm(m->config.gravity);
    double power = 0, most = 0, unbalanced = 0, borne = 0;
    for (uint32_t body = 0; body < b->table.rows; body++) {
        if (b->fixed[body] == TL_FIX_ALL)
            continue;
        double force = tl_v3_norm(b->force[body]);
        power += tl_v3_dot(b->force[body], b->v[body]);
        most += force * tl_v3_norm(b->v[body]);
        unbalanced += force;
        borne += tl_borne(m, body, tl_weight_of(b, body, gravity));
    }
    return power > PUSHES * most && unbalanced > LEAST_UNBALANCED * borne;
}

tl_standing tl_model_stands(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    if (!c || m->cycles == 0)
        return TL_STANDING_UNKNOWN;
    const uint32_t worst = c->sums.worst; /* to ask changes nothing */
    const bool rests =
        tl_at_rest(m, TL_RATIO_LOCAL, c->rest_ratio > 0 ? c->rest_ratio : REST_RATIO);
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
