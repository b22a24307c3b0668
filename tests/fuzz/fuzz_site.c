/* fuzz_site.c - files of fractures and of measured planes with anything in them: each reader makes of it what it says, or one
 * sentence. What is read is finite and within its ranges; the area of a disc in a box is at most that of the disc. */
#include "discs.h"

#include <stdarg.h>
#include <stdint.h>
#include <string.h>

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

#ifdef FUZZ_poles
static void read_text(const tl_host *host, const char *text)
{
    static const tl_csv_column columns[] = TL_POLES_COLUMNS;
    tl_csv table = {.column = columns, .columns = 3};
    (void)host;
    if (tl_csv_read(&table, text)) {
        tl_poles poles = tl_poles_of((tl_measured *)(void *)table.at, table.rows);
        const tl_poles_mean mean = tl_poles_mean_of(poles.normal, poles.weight, poles.count);
        expect(fabs(tl_v3_norm(mean.mean) - 1) < 1e-9 && mean.resultant >= 0 && mean.resultant <= 1);
        expect(tl_v3_finite(tl_poles_pick(&poles, 0.5)));
        tl_poles_free(&poles);
    } else {
        expect(table.why[0] != '\0' && !strchr(table.why, '\n'));
    }
    free(table.at);
}
#else
static void read_text(const tl_host *host, const char *text)
{
    const tl_bounds box = {{-1, -2, -3}, {4, 5, 6}};
    discs all = {0};
#ifdef FUZZ_fab
    const tl_status status = fab_read(host, "fuzz.fab", text, &all);
#else
    const tl_status status = table_read(host, "fuzz.csv", text, &all);
#endif
    expect(status == TL_OK ? all.count > 0 : sentence[0] != '\0' && !strchr(sentence, '\n'));
    for (size_t i = 0; i < all.count; i++) {
        const disc *d = &all.at[i];
        const double area = disc_area_in_box(d, &box), whole = 3.141592653589793 * d->radius * d->radius;
        expect(tl_v3_finite(d->center) && fabs(tl_v3_norm(d->normal) - 1) < 1e-9 && d->radius > 0);
        expect(area >= 0 && area <= whole * (1 + 1e-9) + 1e-6 && area < 200);
    }
    free(all.at);
}
#endif

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
        read_text(&host, text);
    free(text);
    return 0;
}
