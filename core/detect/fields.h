/* fields.h - field contacts from step to step (fields.c). */
#ifndef TL_DETECT_FIELDS_H
#define TL_DETECT_FIELDS_H

#include "contact/tables.h"
#include "model/model.h"
#include "narrow/manifold.h"

/* What is known of a contact before it is looked at. One whose bodies have got other frames stays what it is until its points
 * are in these. */
tl_manifold_before tl_contact_before(const tl_model *m, uint32_t contact, bool reframed);
/* Keeps the region of a field contact. */
void tl_field_keep(tl_press_row *row, const tl_region *region);
/* The faces that bounded the common volume, among those that are listed now; 0: some are not, or none were known. */
uint64_t tl_field_bounding(const tl_press_row *row, const tl_region *region);

typedef enum tl_field_result {
    TL_FIELD_FOUND,
    TL_FIELD_LOST,  /* all is to be looked at */
    TL_FIELD_FAILED /* out of memory */
} tl_field_result;

/* What a field contact is now, by what it keeps, into the thread's manifold. */
tl_field_result tl_field_follow(tl_model *m, uint32_t contact, tl_narrow *room);

#endif
