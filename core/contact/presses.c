/* presses.c - what field contacts keep beside their points, in rows that stay where they are. A row that is given back is the
 * next to be taken. */
#include "contact/presses.h"

#include <string.h>

uint32_t tl_press_take(tl_detect *d)
{
    uint32_t row = d->press_free;
    if (d->press_count == 0)
        row = d->press_free = TL_NO_ROW;
    if (row != TL_NO_ROW) {
        d->press_free = d->press[row].next_free;
    } else {
        if (!tl_grow(&d->press, &d->press_capacity, d->press_count + 1, sizeof *d->press))
            return TL_NO_ROW;
        row = (uint32_t)d->press_count++;
    }
    memset(&d->press[row], 0, sizeof *d->press);
    return row;
}

void tl_press_give_back(tl_detect *d, uint32_t row)
{
    if (row == TL_NO_ROW)
        return;
    d->press[row].next_free = d->press_free;
    d->press_free = row;
}

void tl_press_shift_faces(tl_model *m, uint32_t c, tl_face_pair faces)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_press_row *row = tl_press_row_of(m, c);
    row->shifted = faces;
    row->shifted_at[0] = m->blocks.shape[contacts->a[c]]->plane[faces.a];
    row->shifted_at[1] = m->blocks.shape[contacts->b[c]]->plane[faces.b];
}
