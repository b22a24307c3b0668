/* read.c - discs of a table: x, y, z, dip, dip_direction and radius; and which reader a file needs. */
#include "discs.h"

#include <string.h>

/* Limit: m, of a coordinate or a radius, for shapes keep 1e-9 of their size. */
#define FARTHEST 1e9

tl_status discs_add(const tl_host *host, discs *all, tl_vec3 center, tl_vec3 normal, double radius)
{
    disc *at = (disc *)tl_grown(all->at, &all->capacity, all->count + 1, sizeof *at);
    if (!at)
        return host->fail(host, TL_E_MEMORY, "out of memory for %zu discs", all->count);
    all->at = at;
    at[all->count] = (disc){center, normal.z < 0 ? tl_v3_neg(normal) : normal, radius, 0, all->count};
    all->count++;
    return TL_OK;
}

tl_status table_read(const tl_host *host, const char *file, const char *text, discs *all)
{
    static const tl_csv_column columns[] = {
        {.name = "x", .min = -FARTHEST, .max = FARTHEST}, {.name = "y", .min = -FARTHEST, .max = FARTHEST},
        {.name = "z", .min = -FARTHEST, .max = FARTHEST}, {.name = "dip", .min = 0, .max = 90},
        {.name = "dip_direction", .min = 0, .max = 360},  {.name = "radius", .min = 0, .max = FARTHEST, .above = true}};
    tl_csv table = {.column = columns, .columns = sizeof columns / sizeof *columns};
    tl_status status = TL_OK;
    if (!tl_csv_read(&table, text))
        status = host->fail(host, TL_E_ARGUMENT, "file '%.200s': %s", file, table.why);
    else if (table.rows > MOST_DISCS)
        status =
            host->fail(host, TL_E_ARGUMENT, "file '%.200s' has %zu discs, more than %d", file, table.rows, MOST_DISCS);
    for (size_t i = 0; i < table.rows && status == TL_OK; i++) {
        const double *row = table.at + i * table.columns;
        status = discs_add(host, all, (tl_vec3){row[0], row[1], row[2]}, tl_plane_normal(row[3], row[4]), row[5]);
    }
    free(table.at);
    return status;
}

static bool ends_in(const char *file, const char *ending)
{
    const size_t length = strlen(file), last = strlen(ending);
    if (length < last)
        return false;
    for (size_t i = 0; i < last; i++) {
        const char letter = file[length - last + i];
        if ((letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter) != ending[i])
            return false;
    }
    return true;
}

tl_status discs_read(const tl_host *host, const char *file, discs *all)
{
    char *text;
    size_t length;
    tl_status status = tl_file_bytes(host, file, TL_SITE_FILE, &text, &length);
    if (status == TL_OK && memchr(text, '\0', length))
        status = host->fail(host, TL_E_ARGUMENT, "file '%.200s': it holds a zero byte: it is no text; save it as UTF-8",
                            file);
    if (status == TL_OK)
        status = ends_in(file, ".fab") ? fab_read(host, file, text, all) : table_read(host, file, text, all);
    free(text);
    return status;
}
