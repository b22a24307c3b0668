/* pages.h - large memory in large pages. */
#ifndef TL_BASE_PAGES_H
#define TL_BASE_PAGES_H

#include <stddef.h>

/* Asks the system to keep allocated memory in large pages, as far as it has not been written to yet. A loop over many
 * columns then has the address of each at hand. Nothing where there is no such thing, or for little memory. Not for
 * what realloc will be asked to move: it would copy. */
void tl_pages_large(void *memory, size_t bytes);

#endif
