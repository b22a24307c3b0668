/* touching.c - the faces of blocks that lie on faces of others, as the contacts have found them: only
 * patches count, for a corner or an edge on a face bounds no half-space of motion that its
 * neighbours do not. */
#include "query/touching.h"

#include "contact/detection.h"

static bool add(tl_touches *touches, const tl_touch *touch)
{
    if (!tl_grow(&touches->at, &touches->capacity, touches->count + 1, sizeof *touches->at))
        return false;
    touches->at[touches->count++] = *touch;
    return true;
}

bool tl_touches_add(const tl_model *m, uint32_t row, tl_touches *touches)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    const tl_poly *shape = m->blocks.shape[row];
    const tl_mat3 *turn = &m->bodies.pose[m->blocks.body[row]].r;
    for (uint32_t e = d->by_block_start[row]; e < d->by_block_start[row + 1]; e++) {
        uint32_t contact = d->by_block[e];
        bool first = c->a[contact] == row;
        const tl_facet *facet = &c->facet[contact];
        if (facet->kind != TL_FACET_PATCH || c->point_count[contact] == 0)
            continue;
        uint32_t face = first ? facet->ia : facet->ib;
        tl_touch touch = {.other = tl_contact_partner(c, contact, row),
                          .normal = tl_m3_mul(turn, shape->plane[face].normal),
                          .area = c->area[contact],
                          .joint = c->tag[contact]};
        if (touch.area > 0 && !add(touches, &touch))
            return false;
    }
    return true;
}
