/* file_bytes.c - reads whole files. */
#include "base/file_bytes.h"

#include "base/error.h"
#include "base/regular.h"
#include "base/table.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

/* Bytes that are read at a time, at the least. */
#define PART ((size_t)64 << 10)

static tl_status fail_file(const char *file, const char *what, tl_error *error)
{
    return tl_fail(error, TL_E_IO, "file '%.200s' cannot be %s: %s", file, what, strerror(errno));
}

tl_status tl_file_read(const char *file, size_t most, char **bytes, size_t *count, tl_error *error)
{
    const char *other = tl_not_regular(file);
    size_t room = 0;
    tl_status status = TL_OK;
    *count = 0;
    if (other)
        return tl_fail(error, TL_E_IO, "file '%.200s' is %s: only regular files are read", file, other);
    FILE *stream = fopen(file, "rb");
    if (!stream)
        return fail_file(file, "opened", error);
    while (status == TL_OK && !feof(stream)) {
        if (!tl_grow(bytes, &room, *count + PART, 1)) {
            status = tl_fail_memory(error);
            break;
        }
        *count += fread(*bytes + *count, 1, room - 1 - *count, stream);
        if (ferror(stream))
            status = fail_file(file, "read", error);
        else if (*count > most)
            status = tl_fail(error, TL_E_IO, "file '%.200s' is larger than %zu bytes; divide it", file, most);
    }
    fclose(stream);
    if (status == TL_OK)
        (*bytes)[*count] = '\0';
    return status;
}
