/* pair_view.h - the view of two blocks of a model. */
#ifndef TL_CONTACT_PAIR_VIEW_H
#define TL_CONTACT_PAIR_VIEW_H

#include "contact/detection.h"
#include "model/model.h"
#include "narrow/narrow.h"
#include "narrow/view.h"

/* View of two blocks, and the odometers of their bodies, summed. */
tl_pair_view tl_pair_view_of(const tl_model *m, uint32_t a, uint32_t b);
static inline double tl_pair_odometer(const tl_model *m, uint32_t a, uint32_t b)
{
    return m->bodies.odometer[m->blocks.body[a]] + m->bodies.odometer[m->blocks.body[b]];
}
/* The same of the blocks of a contact, and the size of the smaller one. */
static inline tl_pair_view tl_contact_view(const tl_model *m, uint32_t contact)
{
    return tl_pair_view_of(m, m->detect->contacts.a[contact], m->detect->contacts.b[contact]);
}
static inline double tl_contact_odometer(const tl_model *m, uint32_t contact)
{
    return tl_pair_odometer(m, m->detect->contacts.a[contact], m->detect->contacts.b[contact]);
}
static inline double tl_contact_size(const tl_model *m, uint32_t contact)
{
    const tl_contacts *contacts = &m->detect->contacts;
    return fmin(m->blocks.size[contacts->a[contact]], m->blocks.size[contacts->b[contact]]);
}
/* Whether a patch of two faces, of blocks a and b, has its points at its corners. */
bool tl_pair_at_corners(const tl_model *m, uint32_t a, uint32_t face_a, uint32_t b, uint32_t face_b);
/* How a pair of a joint is to touch, whose faces may carry a force across a gap of `over`, m. */
tl_touch_rule tl_touch_rule_of(const tl_model *m, const tl_pair_view *view, tl_tag tag, double over);

#endif
