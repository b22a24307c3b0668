/* estate_press.h - the parts of a patch that slip has opened press as the whole did (estate_press.c). */
#ifndef TL_CONTACT_ESTATE_PRESS_H
#define TL_CONTACT_ESTATE_PRESS_H

#include "contact/detection.h"
#include "model/model.h"

/* Makes room for what is known of each whole meanwhile; false when out of memory. */
bool tl_estates_press_reserve(tl_detect *d);
/* After all parts have taken over their shares: brings the closures of their points in line with those of the whole. */
void tl_estates_press(tl_model *m);

#endif
