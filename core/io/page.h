/* page.h - the pages that a model has written. */
#ifndef TL_IO_PAGE_H
#define TL_IO_PAGE_H

#include "io/pieces.h"
#include "model/model.h"
#include "state/outputs.h"

/* Longest page, bytes: what a browser opens without trouble. */
#define TL_PAGE_MOST 200000000

/* As tl_write_html, for a longest page of `most` bytes. */
tl_status tl_page_write(tl_model *m, const char *prefix, const tl_html *options, uint64_t most);

/* What stands of a page when a frame is to be added. */
typedef enum tl_page_stand {
    TL_PAGE_GONE,   /* the file is not the one that was left */
    TL_PAGE_WHOLE,  /* it is as it was left */
    TL_PAGE_LONGER, /* it is, but more has been added since */
} tl_page_stand;

/* Adds a frame, in place where the page stands whole; where it is longer, to a copy of what was left. */
/* The beginning of a page, up to its first frame. `live`: of one that a running program serves, which it may ask. */
void tl_page_beginning(tl_piece *to, const char *title, bool live);

/* Adds the text of `bytes` bytes to `out`; it does not depend on the number of threads. */
tl_status tl_pack(tl_model *m, const unsigned char *data, size_t bytes, tl_piece *out);

#endif
