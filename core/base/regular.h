/* regular.h - whether a file can be read to its end: a pipe waits for who writes, a device may never end. */
#ifndef TL_BASE_REGULAR_H
#define TL_BASE_REGULAR_H

#include <stdbool.h>

/* What stands at `path`, links followed, when it is there and not a regular file: "a pipe"; else NULL. Opens
 * nothing. */
const char *tl_not_regular(const char *path);

#endif
