/* file_bytes.h - reads whole files. */
#ifndef TL_BASE_FILE_BYTES_H
#define TL_BASE_FILE_BYTES_H

#include <stddef.h>
#include <talus/types.h>

/* Reads a regular file of at most `most` bytes: *count bytes, and a zero byte after them. Free *bytes, which begins as
 * NULL, after a failure too. */
tl_status tl_file_read(const char *file, size_t most, char **bytes, size_t *count, tl_error *error);

#endif
