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

/* The beginning of a page, up to its first frame. `live`: of one that a running program serves, which it may ask. */
void tl_page_beginning(tl_piece *to, const char *title, bool live);

/* Adds the text of `bytes` bytes to `out`; it does not depend on the number of threads. */
tl_status tl_pack(tl_model *m, const unsigned char *data, size_t bytes, tl_piece *out);

#endif
