/* follow.h - nodes follow their blocks through edits, and what a step needs of elements is made ready. */
#ifndef TL_ELEMENT_FOLLOW_H
#define TL_ELEMENT_FOLLOW_H

#include "element/elements.h"

/* Lets nodes follow blocks that have been cut, joined or deleted; tells of elements that are detached. Nothing where
 * no block has changed since. TL_E_MEMORY: nothing has changed. */
tl_status tl_elements_follow(tl_model *m);
/* Follows; lists the nodes of each body and the shares of threads, and asks the kinds for stiffnesses, where these are
 * not known. TL_E_MEMORY: nothing has changed. TL_E_PLUGIN for a stiffness that is none. */
tl_status tl_elements_ready(tl_model *m);

#endif
