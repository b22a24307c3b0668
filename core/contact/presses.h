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

#endif
