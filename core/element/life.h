/* life.h - the tables of elements come and go. */
#ifndef TL_ELEMENT_LIFE_H
#define TL_ELEMENT_LIFE_H

#include "element/elements.h"

/* Gives a model tables of elements, unless it has them. false: out of memory. */
bool tl_elements_begin(tl_model *m);
void tl_elements_free(struct tl_elements *e);
/* Takes out the elements for which keep[row] is 0 and, with `sets`, the sets that have none left by that. */
void tl_elements_keep(struct tl_elements *e, const unsigned char *keep, bool sets);
/* The row of an element, or TL_NO_ROW. */
uint32_t tl_element_row(const tl_model *m, tl_id id);

#endif
