/* page.h - the pages that a model has written (page.c). */
#ifndef TL_IO_PAGE_H
#define TL_IO_PAGE_H

#include "io/scene.h"

#include "base/hash.h"

/* Longest page, bytes: what a browser opens without trouble. */
#define TL_PAGE_MOST 200000000

/* Most bytes at the end of a page that are compared. */
#define TL_PAGE_CHECKED 4096

/* How a page was left: it goes on only where it still is so. */
typedef struct tl_page_end {
    uint64_t frames;
    uint64_t at;      /* bytes in front of what ends the file */
    uint64_t checked; /* so many of these, the last ones, ... */
    tl_hash digest;   /* ... have this digest */
} tl_page_end;

/* A model keeps a list of these. */
typedef struct tl_page {
    struct tl_page *next;
    char *prefix;
    tl_page_end end;
    bool restored; /* by tl_page_restore, and no frame has been added since */
    tl_scene scene;
} tl_page;

/* As tl_write_html, for a longest page of `most` bytes. */
tl_status tl_page_write(tl_model *m, const char *prefix, const tl_html *options, uint64_t most);
/* Adds to a model a page that its file was left with; what comes next goes on with it, from there on. False when out of
 * memory. */
bool tl_page_restore(tl_model *m, const char *prefix, tl_page_end end);

#endif
