/* pair_view.h - the view of two blocks of a model. */
#ifndef TL_CONTACT_PAIR_VIEW_H
#define TL_CONTACT_PAIR_VIEW_H

#include "contact/sides.h"
#include "narrow/narrow.h"
#include "narrow/view.h"

/* View of two blocks as they have these sides, of two by themselves, and of those of a contact. */
tl_pair_view tl_pair_view_at(const tl_model *m, uint32_t a, uint32_t b, tl_sides sides);
static inline tl_pair_view tl_pair_view_of(const tl_model *m, uint32_t a, uint32_t b)
{
    return tl_pair_view_at(m, a, b, tl_pair_sides(m, a, b));
}
static inline tl_pair_view tl_contact_view(const tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    return tl_pair_view_at(m, c->a[contact], c->b[contact], tl_contact_sides(m, contact));
}
/* Size of the smaller block of a contact. */
static inline double tl_contact_size(const tl_model *m, uint32_t contact)
{
    const tl_contacts *contacts = &m->detect->contacts;
    return fmin(m->blocks.size[contacts->a[contact]], m->blocks.size[contacts->b[contact]]);
}
/* Whether a patch of two faces, of blocks a and b, has its points at its corners. */
bool tl_pair_at_corners(const tl_model *m, uint32_t a, uint32_t face_a, uint32_t b, uint32_t face_b);
/* How a pair of a joint is to touch, whose faces may carry a force across a gap of `over`, m. */
tl_touch_rule tl_touch_rule_of(const tl_model *m, uint32_t a, uint32_t b, const tl_pair_view *view, tl_tag tag,
                               double over);
/* Where the sides of a contact are against each other. */
tl_spot tl_spot_of(const tl_model *m, tl_sides sides, double remaining);
/* How far points within `radius` of the centroid of B have moved since `then`, at the most: what the rounding of the
 * spot may hide is counted. */
double tl_spot_moved(const tl_model *m, const tl_spot *then, tl_sides sides, double radius);

#endif
