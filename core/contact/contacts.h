/* contacts.h - the tables of contacts and contact points, and how they are laid out (contacts.c). */
#ifndef TL_CONTACT_CONTACTS_H
#define TL_CONTACT_CONTACTS_H

#include "contact/detection.h"
#include "model/model.h"

void tl_contacts_init(tl_contacts *contacts, tl_points_table *points);
void tl_point_lanes_init(tl_point_lanes *lanes);
/* Gives the threads' lanes room for `capacity` points; false when out of memory. */
bool tl_detect_hold_lanes(tl_detect *d, size_t capacity);
/* The same for a tile, or the largest SIMD group of a layout, for every thread. */
bool tl_detect_make_lanes(tl_detect *d, const tl_layout *layout);
/* Adds a patch or a field contact of a pair, without points, wanting room for some, whose faces hold for a path length of `valid`;
 * false when out of memory. */
bool tl_contact_append(tl_model *m, uint32_t pair, bool field, double valid, tl_tag tag,
                       size_t want_points);
/* Lays contacts and points out anew: without those with TL_PENDING_DIE, sorted by joint law and blocks,
 * each with the room it wants at least. */
tl_status tl_contacts_repack(tl_model *m);
/* Gives back the room that contacts came from when they were laid out anew last, once the layout has lasted. */
void tl_contacts_free_spare(tl_detect *d, int64_t cycles);
/* The points of a contact begin under a law. Walls that are apart and do not pull on each other are not bonded by it. */
void tl_contact_begin_law(tl_model *m, uint32_t contact, const tl_kind *kind);
/* Moves a contact's points, if it has or wants any, to a lane with the room it wants, in its span;
 * false when there is none: lay all out anew. */
bool tl_contact_place(tl_detect *d, uint32_t contact);
/* Takes a contact out; the last one gets its row. */
void tl_contact_remove(tl_detect *d, uint32_t contact);
/* Index of the joint law that rules a tag, or TL_NO_ROW. */
uint32_t tl_law_row(const tl_model *m, tl_tag tag);
/* "contact of blocks 3 and 7, joint J1:2" */
void tl_contact_name(tl_model *m, uint32_t contact, char *text, size_t size);
/* Moment of a contact's forces on A, or on B, about that block's body's centroid. */
static inline tl_vec3 tl_contact_moment(const tl_model *m, uint32_t contact, bool on_b)
{
    const tl_contacts *c = &m->detect->contacts;
    if (!on_b)
        return tl_v3_neg(c->moment[contact]);
    tl_vec3 apart =
        tl_body_apart(&m->bodies, m->blocks.body[c->a[contact]], m->blocks.body[c->b[contact]]);
    return tl_v3_sub(c->moment[contact], tl_v3_cross(apart, c->force[contact]));
}

#endif
