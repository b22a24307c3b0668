/* page_asset.h - the page that shows a scene, without frames: page_asset.c, which scripts/tools/page_asset.py makes of the
 * files in viewer/. */
#ifndef TL_IO_PAGE_ASSET_H
#define TL_IO_PAGE_ASSET_H

/* The text up to the title and the text after it, line by line; NULL ends each. */
extern const char *const tl_page_before[], *const tl_page_after[];

#endif
