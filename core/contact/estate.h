/* estate.h - what a contact leaves to those of its blocks' parts when a block of it is cut. */
#ifndef TL_CONTACT_ESTATE_H
#define TL_CONTACT_ESTATE_H

#include "contact/detection.h"
#include "model/model.h"

/* A block of a contact as detection knew it, with the frame of its body. */
typedef struct tl_testator {
    tl_id id;
    const tl_mat3 *r;
    tl_vec3 place;
    uint32_t body; /* that has its motion: its own, or that of a part */
    bool reframed; /* that is another frame than the contact's */
} tl_testator;

/* Makes room for so many estates and points more; false when out of memory (nothing changed). */
bool tl_estates_reserve(tl_detect *d, size_t estates, size_t points);
/* Points that a contact would leave. */
uint32_t tl_estate_size(const tl_detect *d, uint32_t contact);
/* Keeps what a contact leaves; there is room for it. */
void tl_estate_keep(tl_model *m, uint32_t contact, const tl_testator *a, const tl_testator *b);
/* After it is kept: the contact that ends takes nothing of it along. */
void tl_estate_leave(tl_model *m, uint32_t contact);
/* Puts estates in the order in which they are looked up. */
void tl_estates_sort(tl_detect *d);
/* What the contact of two blocks has left, a < b; NULL: nothing. */
tl_estate *tl_estate_left(const tl_detect *d, tl_id a, tl_id b);
/* What a new contact of two blocks takes over, of which one at least is a part of one that was cut; NULL: nothing. */
const tl_estate *tl_estate_of(const tl_model *m, uint32_t block_a, uint32_t block_b);
/* Whether blocks of two rows take over from a patch that held across a gap. */
bool tl_estate_holds(const tl_model *m, uint32_t block_a, uint32_t block_b);
/* Tilt, as a sine, up to which they take over as a patch from one that bore a force; 0: there is none. */
double tl_estate_tilt(const tl_model *m, uint32_t block_a, uint32_t block_b);
/* The faces of two blocks that are parts of the faces of the patch that they take over from, or of those that the field contact had
 * moved out; false: they have none. */
bool tl_estate_faces(const tl_model *m, uint32_t block_a, uint32_t block_b, uint32_t *face_a,
                     uint32_t *face_b);
/* How far these are moved out, m; 0: there are none. */
double tl_estate_shift(const tl_model *m, uint32_t block_a, uint32_t block_b, tl_face_pair *faces);
/* The same for a contact on these faces: not of a patch, if they are no parts of its faces. */
const tl_estate *tl_estate_on(const tl_model *m, uint32_t block_a, uint32_t block_b,
                              const tl_facet *facet);
/* Point k of an estate as an old point of a contact. */
tl_old_point tl_estate_point(const tl_model *m, const tl_estate *estate, uint32_t contact,
                             size_t k);
/* Whether the contact's law is of the kind that has kept the states of the estate's points. */
bool tl_estate_is_of_law(const tl_model *m, const tl_estate *estate, uint32_t contact);
/* Whether the first block of a contact is of the estate's first block: else its shear is the other way round. */
bool tl_estate_same_way(const tl_model *m, const tl_estate *estate, uint32_t contact);
/* What a contact that has its points takes over of the estate's energy of shear beyond springs, J: by its share of the area. */
double tl_estate_kept(const tl_model *m, const tl_estate *estate, uint32_t contact);
/* The estate that a patch has taken a share of, or NULL. */
tl_estate *tl_estate_taken(const tl_model *m, uint32_t contact);
/* After all parts have taken over their shares: together they carry what the whole did, and no more energy. */
void tl_estates_balance(tl_model *m);
/* Sums what new contacts carry from the beginning, until the laws say it. */
void tl_estates_sum(tl_model *m);
/* All have been taken over. */
void tl_estates_end(tl_detect *d);

#endif
