/* page_file.h - the file of a page: its beginning, and frames added at its end (page_file.c). */
#ifndef TL_IO_PAGE_FILE_H
#define TL_IO_PAGE_FILE_H

#include "io/page.h"

/* What stands of a page when a frame is to be added. */
typedef enum tl_page_stand {
    TL_PAGE_GONE,   /* the file is not the one that was left */
    TL_PAGE_WHOLE,  /* it is as it was left */
    TL_PAGE_LONGER, /* it is, but more has been added since */
} tl_page_stand;

tl_page_stand tl_page_look(const char *path, const tl_page_end *end);
/* Bytes of a page with such an element as its only frame, or after a page that ends at `at`. */
uint64_t tl_page_length(const char *title, uint64_t at, const tl_piece *element);
/* Writes the page with its first frame under a new name and renames it. */
tl_status tl_page_begin(tl_model *m, const char *path, const char *title, const tl_piece *element,
                        tl_page_end *end);
/* Adds a frame, in place where the page stands whole; where it is longer, to a copy of what was left. */
tl_status tl_page_add(tl_model *m, const char *path, tl_page_stand stand, const tl_piece *element,
                      tl_page_end *end);
/* The beginning of a page, up to its first frame. `live`: of one that a running program serves, which it may ask. */
void tl_page_beginning(tl_piece *to, const char *title, bool live);
/* Pads an element so that the next thing in the file begins at a multiple of four bytes. */
void tl_page_pad(tl_piece *element);

#endif
