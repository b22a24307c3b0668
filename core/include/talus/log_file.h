/* talus/log_file.h - a file to which one process at a time adds lines. */
#ifndef TALUS_LOG_FILE_H
#define TALUS_LOG_FILE_H

#include <stdint.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tl_log_file tl_log_file;

/* Opens a file for adding lines, makes it and its folders if need be, and locks it until it is closed or this process
 * ends. TL_E_STATE when another process has the lock, TL_E_IO when it is no regular file or cannot be written. */
TL_API tl_status tl_log_open(const char *path, tl_log_file **file, tl_error *error);
/* Reads all of it, in memory of its own, to be freed. The file is not to be opened and closed in another way meanwhile:
 * the system takes the lock away then. */
TL_API tl_status tl_log_read(tl_log_file *file, char **data, size_t *size, tl_error *error);
/* Cuts the file to its first `size` bytes. */
TL_API tl_status tl_log_cut(tl_log_file *file, uint64_t size, tl_error *error);
/* Adds bytes at the end, with one call of the system unless that takes fewer. */
TL_API tl_status tl_log_add(tl_log_file *file, const void *data, size_t size, tl_error *error);
/* Closes; NULL is left alone. */
TL_API void tl_log_close(tl_log_file *file);

#ifdef __cplusplus
}
#endif
#endif
