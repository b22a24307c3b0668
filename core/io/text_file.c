/* text_file.c - a file whose bytes are all there already. */
#include "base/output_file.h"
#include "base/signals.h"

#include <talus/output.h>

static tl_status write_output(const char *path, const void *data, size_t length, tl_error *error)
{
    tl_output output = {0};
    tl_status status = tl_output_open(&output, path, error);
    if (status == TL_OK) {
        tl_output_put(&output, data, length);
        status = tl_output_finish(&output, error);
    }
    if (status == TL_OK)
        status = tl_output_commit(&output, error);
    tl_output_drop(&output);
    return status;
}

tl_status tl_write_file(const char *path, const void *data, size_t length, tl_error *error)
{
    sigset_t before;
    tl_signals_hold(&before, false);
    tl_status status = write_output(path, data, length, error);
    tl_signals_release(&before);
    return status;
}
