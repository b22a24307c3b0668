/* text_file.c - a file whose bytes are all there already. */
#include "base/output_file.h"

#include <talus/output.h>

typedef struct all_bytes {
    const void *data;
    size_t length;
} all_bytes;

static tl_status put(tl_output *output, void *user)
{
    const all_bytes *all = user;
    tl_output_put(output, all->data, all->length);
    return TL_OK;
}

tl_status tl_write_file(const char *path, const void *data, size_t length, tl_error *error)
{
    return tl_output_whole(path, put, &(all_bytes){data, length}, error);
}
