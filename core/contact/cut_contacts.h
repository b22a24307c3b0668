/* cut_contacts.h - what a contact leaves to those of its blocks' parts when a block of it is cut. */
#ifndef TL_CONTACT_CUT_CONTACTS_H
#define TL_CONTACT_CUT_CONTACTS_H

#include "contact/detection.h"
#include "model/model.h"

/* A block of a contact as detection knew it, with the frame of its side. */
typedef struct tl_cut_side {
    tl_id id;
    const tl_mat3 *r;
    tl_vec3 place;
    uint32_t side; /* that has its motion: its own, or that of a part */
    bool reframed; /* that is another frame than the contact's */
} tl_cut_side;

/* Puts them in the order in which they are looked up. */
void tl_cut_contacts_sort(tl_detect *d);
/* What a new contact of two blocks takes over from, one at least a part of a block that was cut; NULL: nothing. */
tl_cut_contact *tl_cut_contact_of(const tl_model *m, uint32_t block_a, uint32_t block_b);
/* Tilt, as a sine, up to which they take over as a patch from one that bore a force; 0: there is none. */
double tl_cut_contact_tilt(const tl_model *m, uint32_t block_a, uint32_t block_b);
/* The faces of two blocks that are parts of the faces of the whole, as a field contact had moved them out.
 * false: they have none. */
bool tl_cut_contact_faces(const tl_model *m, uint32_t block_a, uint32_t block_b, tl_face_pair *faces);
/* How far these are moved out, m; 0: there are none. */
double tl_cut_contact_shift(const tl_model *m, uint32_t block_a, uint32_t block_b, tl_face_pair *faces);
/* What a contact takes over from that is on these faces: not from a patch, if they are no parts of its faces. */
tl_cut_contact *tl_cut_contact_on(const tl_model *m, uint32_t contact, const tl_facet *facet);
/* Point k of it as an old point of a contact. */
tl_old_point tl_cut_contact_point(const tl_model *m, const tl_cut_contact *cut, uint32_t contact, size_t k);
/* Whether the contact's law is of the kind that has kept the states of the points. */
bool tl_cut_contact_is_of_law(const tl_model *m, const tl_cut_contact *cut, uint32_t contact);
/* 1 when the contact's first block is a part of `a`; else -1, and its shear is the other way round. */
double tl_cut_contact_sign(const tl_model *m, const tl_cut_contact *cut, uint32_t contact);
/* The share of the whole's area that an area is, at the most 1. */
static inline double tl_cut_contact_share(const tl_cut_contact *cut, double area)
{
    return cut->whole.area > 0 ? fmin(1, area / cut->whole.area) : 0;
}
/* What a contact that has its points takes over of the energy of shear beyond springs, J: by its share of the area. */
double tl_cut_contact_kept(const tl_model *m, const tl_cut_contact *cut, uint32_t contact);

#endif
