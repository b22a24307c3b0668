/* presses.h - what field contacts keep beside their points. */
#ifndef TL_CONTACT_PRESSES_H
#define TL_CONTACT_PRESSES_H

#include "contact/detection.h"
#include "model/model.h"

/* The row of a contact; NULL: it has none. */
static inline tl_press_row *tl_press_row_of(const tl_model *m, uint32_t contact)
{
    uint32_t row = m->detect->contacts.press[contact];
    return row == TL_NO_ROW ? NULL : &m->detect->press[row];
}
/* A free row for a field contact; TL_NO_ROW when out of memory. */
uint32_t tl_press_take(tl_detect *d);
/* Says which faces of a contact's blocks its shift moves out. */
void tl_press_shift_faces(tl_model *m, uint32_t contact, tl_face_pair faces);
/* Gives a row back; TL_NO_ROW is none. */
void tl_press_give_back(tl_detect *d, uint32_t row);

#endif
