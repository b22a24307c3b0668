/* fuzz_record.c - files of records with anything in them: each is read, and asked, or makes one sentence. The first byte
 * chooses the options. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <talus/talus.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* What would trap: a motion that is no number. */
static void ask(const tl_record *record)
{
    const double end = tl_record_dt(record) * (double)tl_record_count(record), period = 1;
    double out;
    tl_error error;
    for (int k = -1; k < 5; k++) {
        const double t = 0.3 * k * end;
        if (!(tl_record_velocity(record, t) - tl_record_velocity(record, t) == 0))
            abort();
        (void)tl_record_acceleration(record, t);
        (void)tl_record_displacement(record, t);
    }
    (void)tl_record_arias(record);
    if (tl_record_count(record) < 100 && tl_record_dt(record) < 1)
        (void)tl_record_spectrum(record, 0.05, &period, 1, &out, &error);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0)
        return 0;
    char *text = malloc(size);
    if (!text)
        return 0;
    memcpy(text, data + 1, size - 1);
    text[size - 1] = '\0';
    tl_record_options options = {.scale = 1,
                                 .dt = data[0] & 1 ? 0.01 : 0,
                                 .quantity = data[0] >> 1 & 1,
                                 .baseline = (data[0] >> 2) % 3,
                                 .band = {data[0] & 16 ? 0.5 : 0, data[0] & 16 ? 20 : 0},
                                 .column = data[0] >> 5};
    tl_record *record;
    tl_error error = {.status = TL_OK};
    if (tl_record_of_text("fuzz", text, size - 1, &options, &record, &error) == TL_OK) {
        ask(record);
        tl_record_let_go(record);
    } else if (!error.text[0] || strlen(error.text) + 1 >= sizeof error.text || record) {
        abort();
    }
    free(text);
    return 0;
}
