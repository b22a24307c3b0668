/* fuzz_terrain.c - files of the ground with anything in them: an ESRI ASCII grid and an STL. Each is read, or one sentence
 * says why not. Heights are finite or none; triangles are as the plan has them. */
#include "terrain.h"

#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static char sentence[512];

static tl_status fail(const tl_host *host, tl_status status, const char *format, ...)
{
    va_list arguments;
    (void)host;
    va_start(arguments, format);
    tl_text_vprint(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    return status;
}

static void expect(bool good)
{
    if (!good)
        abort();
}

static void expect_told(tl_status status)
{
    expect(status == TL_OK || (sentence[0] != '\0' && !strchr(sentence, '\n')));
}

static void expect_surface(const surface *s)
{
    for (size_t i = 0; i < s->count; i++) {
        const facet *f = &s->at[i];
        expect(f->normal.z > 0 && fabs(tl_v3_norm(f->normal) - 1) < 1e-9);
        expect(facet_width(f) >= 0 && isfinite(f->fall[0]) && isfinite(f->fall[1]));
    }
}

static void read_grid(const tl_host *host, const char *text)
{
    const tl_bounds box = {{-10, -10, 0}, {10, 10, 10}};
    surface s = {.host = host, .file = "fuzz.asc", .scale = 1, .every = 1};
    const tl_status status = esri_read(host, s.file, text, &s.grid);
    expect_told(status);
    for (size_t i = 0; status == TL_OK && i < (size_t)s.grid.rows * s.grid.columns; i++)
        expect(isnan(s.grid.z[i]) || fabs(s.grid.z[i]) <= FARTHEST);
    if (status == TL_OK && surface_of_grid(&s, &box) == TL_OK)
        expect_surface(&s);
    surface_free(&s);
}

static void read_triangles(const tl_host *host, const char *bytes, size_t count)
{
    surface s = {.host = host, .file = "fuzz.stl", .scale = 1, .every = 1};
    const tl_status status = stl_read(&s, bytes, count);
    expect_told(status);
    if (status == TL_OK) {
        expect(s.count > 0);
        expect_surface(&s);
        if (s.count < 1000)
            expect_told(surface_index(&s));
    }
    surface_free(&s);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const tl_host host = {.fail = fail};
    char *text = malloc(size + 1);
    if (!text)
        return 0;
    memcpy(text, data, size);
    text[size] = '\0';
    sentence[0] = '\0';
    if (strlen(text) == size)
        read_grid(&host, text);
    sentence[0] = '\0';
    read_triangles(&host, text, size);
    free(text);
    return 0;
}
