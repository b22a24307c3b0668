/* memory.h - what kinds keep of their elements between steps, and nobody saves. */
#ifndef TL_ELEMENT_MEMORY_H
#define TL_ELEMENT_MEMORY_H

#include "element/elements.h"

/* Gives each element the memory that its kind asks for, all 0. Chunks must be listed. false: out of memory. */
bool tl_elements_remember(tl_model *m);
void tl_elements_forget(struct tl_elements *e);
/* Bytes of all that, of the sets and of their parameters. What a kind makes of these is its own. */
size_t tl_elements_bytes(const struct tl_elements *e);

#endif
