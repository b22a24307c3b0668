/* file.c - reads a whole file into memory. */
#include "mesh.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Larger files are refused: no model has blocks for them. */
#define MOST_BYTES ((size_t)512 << 20)
#define FIRST_BYTES ((size_t)64 << 10)

static tl_status read_all(const tl_host *host, const char *file, FILE *stream, bytes *data)
{
    size_t capacity = 0;
    while (!feof(stream)) {
        if (data->count + 1 >= capacity) {
            capacity = capacity ? 2 * capacity : FIRST_BYTES;
            char *more = realloc(data->at, capacity);
            if (!more)
                return host->fail(host, TL_E_MEMORY, "file '%.200s': out of memory", file);
            data->at = more;
        }
        data->count += fread(data->at + data->count, 1, capacity - 1 - data->count, stream);
        if (ferror(stream))
            return host->fail(host, TL_E_IO, "file '%.200s' cannot be read: %s", file,
                              strerror(errno));
        if (data->count > MOST_BYTES)
            return host->fail(host, TL_E_IO, "file '%.200s' is larger than %zu bytes; divide it",
                              file, MOST_BYTES);
    }
    data->at[data->count] = '\0';
    return TL_OK;
}

tl_status file_read(const tl_host *host, const char *file, bytes *data)
{
    *data = (bytes){NULL, 0};
    FILE *stream = fopen(file, "rb");
    if (!stream)
        return host->fail(host, TL_E_IO, "file '%.200s' cannot be opened: %s", file,
                          strerror(errno));
    tl_status status = read_all(host, file, stream, data);
    fclose(stream);
    if (status != TL_OK) {
        free(data->at);
        data->at = NULL;
    }
    return status;
}
