/* scene_contacts.h - CONT and the extra fields of contacts. */
#ifndef TL_IO_SCENE_CONTACTS_H
#define TL_IO_SCENE_CONTACTS_H

#include "io/pieces.h"

#include <talus/output.h>

/* CONT and the FIEL of contacts, where they are wanted; and the verdict, by blocks of the median size. */
tl_status tl_scene_contacts(tl_model *m, const tl_html *options, double median, tl_piece *out,
                            tl_verdict *verdict);

#endif
