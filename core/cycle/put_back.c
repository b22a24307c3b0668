/* put_back.c - a model that has only settled, as it was before its blocks moved.
 *
 * On soft joints blocks settle by millimetres and more, each by another way. With stiffer joints the contacts that
 * there are may keep their forces, and fit. But a block may slide over a step between two others that have settled
 * apart. There is a new contact, whose closure is that of the soft joints. A stiff joint presses there with many times
 * the weight. So a copy with stiffer joints begins as the model was cut, and settles anew. */
#include "cycle/put_back.h"

#include "contact/detection.h"
#include "contact/store.h"

/* Whether joints know nothing but their stresses: these come again as the blocks settle. */
static bool keeps_nothing(const tl_detect *d)
{
    const tl_points_table *p = &d->points;
    bool nothing = !p->initial && p->state_columns == 0;
    for (uint32_t i = 0; i < d->contacts.table.rows && nothing; i++)
        for (size_t k = 0; k < d->contacts.point_count[i]; k++)
            nothing = nothing && !(p->flags[tl_point_row(&d->contacts, i, k)] & TL_POINT_FAILED);
    return nothing;
}

bool tl_may_put_back(const tl_model *m, double most)
{
    const tl_bodies *b = &m->bodies;
    const tl_detect *d = tl_detect_lasting(m);
    if (m->cycles == 0)
        return true;
    bool may = !tl_model_deforms(m) && !m->elements && (!d || keeps_nothing(d));
    for (uint32_t body = 0; body < b->table.rows && may; body++)
        may = tl_v3_norm(b->pose[body].u) <= (b->fixed[body] == TL_FIX_ALL ? 0 : most);
    return may;
}

void tl_put_back(tl_model *copy)
{
    tl_bodies *b = &copy->bodies;
    if (copy->cycles == 0)
        return;
    for (uint32_t body = 0; body < b->table.rows; body++) {
        b->pose[body].u = b->v[body] = b->w[body] = tl_v3(0, 0, 0);
        b->pose[body].v_moved = b->pose[body].w_moved = tl_v3(0, 0, 0);
        b->pose[body].r = tl_m3_identity();
        b->q[body] = tl_q_identity();
    }
    if (copy->cycle)
        copy->cycle_destroy(copy->cycle);
    if (copy->detect)
        copy->detect_destroy(copy->detect);
    if (copy->stepped)
        copy->detect_destroy(copy->stepped);
    copy->cycle = NULL;
    copy->detect = copy->stepped = NULL;
    copy->found_for = TL_FOR_STEPS;
}
