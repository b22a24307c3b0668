/* record_file.c - records of ground motion in files.
 *
 * A file is lines of numbers with blanks, commas or semicolons between them. Lines that are no numbers throughout are
 * skipped before the first sample: titles, names of columns. Afterwards only empty lines and those with # are. The
 * header of PEER's AT2 and VT2 files tells the number of samples and their distance,
 *
 *     NPTS=  4000, DT=   .0050 SEC          or        4000    0.0050    NPTS, DT
 *
 * and all numbers after it are samples, whatever their number in a line. "UNITS OF G" and "UNITS OF CM/S" are read,
 * too. */
#include "model/record.h"

#include "base/error.h"
#include "base/file_bytes.h"
#include "base/table.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>

/* Limit: larger files are refused; a sample has up to some 20 bytes. */
#define MOST_BYTES ((size_t)1 << 30)
/* Tolerance: difference of two times in a file, over the first one: they are printed with few digits. */
#define EVEN 0.05
/* Most numbers of a line that may be columns. */
#define COLUMNS 64

typedef struct reading {
    const char *file, *at;
    size_t line;
    tl_record_options options;
    double stated; /* number of samples that the header tells; 0: none */
    bool block;    /* there is such a header: all numbers are samples */
    double *sample;
    size_t count, capacity;
    double first_time, last_time, step;
    tl_error *error;
} reading;

static tl_status fault(const reading *r, const char *what)
{
    return tl_fail(r->error, TL_E_IO, "file '%.200s', line %zu: %s", r->file, r->line, what);
}

static bool is_gap(char letter)
{
    return letter == ' ' || letter == '\t' || letter == ',' || letter == ';' || letter == '\r';
}

/* The numbers of the line at `at`, at most COLUMNS of them kept. Gives how many there are, or SIZE_MAX for a line that
 * is something else; *end is its end. */
static size_t numbers_of(const char *at, double number[COLUMNS], const char **end)
{
    size_t count = 0;
    bool other = false;
    while (*at && *at != '\n') {
        if (is_gap(*at)) {
            at++;
            continue;
        }
        const char *after;
        const double value = tl_number_read(at, &after);
        other = other || after == at || !(is_gap(*after) || *after == '\n' || !*after);
        if (!other && count < COLUMNS)
            number[count] = value;
        count++;
        at = after;
        while (*at && *at != '\n' && !is_gap(*at))
            at++;
    }
    *end = at;
    return other ? SIZE_MAX : count;
}

/* The place after a word of a line, capital letters or not; NULL: it is not there. */
static const char *after_word(const char *line, const char *end, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = line; at + length <= end; at++) {
        size_t k = 0;
        while (k < length && toupper((unsigned char)at[k]) == word[k])
            k++;
        if (k == length)
            return at + length;
    }
    return NULL;
}

/* The number after a name and "=". NaN: there is none. */
static double value_after(const char *at)
{
    const char *end;
    while (at && (is_gap(*at) || *at == '='))
        at++;
    const double value = at ? tl_number_read(at, &end) : NAN;
    return at && end != at ? value : NAN;
}

/* What a line of the header tells. */
static void read_header(reading *r, const char *line, const char *end)
{
    const char *count = after_word(line, end, "NPTS"), *step = after_word(line, end, "DT");
    const bool velocity = r->options.quantity == TL_RECORD_VELOCITY;
    if (r->options.unit == TL_RECORD_UNIT_OWN && after_word(line, end, "UNITS OF G") && !velocity)
        r->options.unit = TL_RECORD_UNIT_G;
    if (r->options.unit == TL_RECORD_UNIT_OWN && after_word(line, end, "UNITS OF CM/S"))
        r->options.unit = velocity ? TL_RECORD_UNIT_CM_S : TL_RECORD_UNIT_CM_S2;
    if (!count || !step)
        return;
    double stated = value_after(count), dt = value_after(step);
    if (!(stated > 0)) { /* before their names */
        const char *next, *at = line;
        while (is_gap(*at))
            at++;
        stated = tl_number_read(at, &next);
        while (is_gap(*next))
            next++;
        dt = tl_number_read(next, &at);
    }
    r->stated = stated;
    r->block = true;
    if (r->options.dt == 0 && dt > 0)
        r->options.dt = dt;
}

static tl_status add(reading *r, double sample)
{
    char text[160];
    if (!isfinite(sample)) {
        tl_text_print(text, sizeof text, "sample %zu is %g, which must be a finite number", r->count + 1, sample);
        return fault(r, text);
    }
    if (r->count >= TL_RECORD_MOST) {
        tl_text_print(text, sizeof text, "there are more than %d samples", TL_RECORD_MOST);
        return fault(r, text);
    }
    if (!tl_grow(&r->sample, &r->capacity, r->count + 1, sizeof *r->sample))
        return tl_fail_memory(r->error);
    r->sample[r->count++] = sample;
    return TL_OK;
}

/* The columns of the file, from its first line of numbers. */
static tl_status choose_column(reading *r, size_t count)
{
    char text[160];
    if (r->block)
        return TL_OK;
    if (r->options.column == 0 && count <= 2)
        r->options.column = (int64_t)count;
    if (r->options.column >= 1 && r->options.column <= (int64_t)count)
        return TL_OK;
    if (r->options.column == 0)
        tl_text_print(text, sizeof text, "it has %zu numbers: say with column which of them is the record", count);
    else
        tl_text_print(text, sizeof text, "it has %zu numbers, but column = %lld is asked for", count,
                      (long long)r->options.column);
    return fault(r, text);
}

/* Times are even, or the record is none. */
static tl_status note_time(reading *r, double time)
{
    char text[200];
    if (r->count == 1)
        r->first_time = time;
    if (r->count == 2)
        r->step = time - r->first_time;
    if (r->count >= 2 && !(fabs(time - r->last_time - r->step) <= EVEN * r->step)) {
        tl_text_print(text, sizeof text,
                      "its time %g s is %g s after the one before, and the first two are %g s apart: a record has even "
                      "steps; give dt if the first column is no time",
                      time, time - r->last_time, r->step);
        return fault(r, text);
    }
    r->last_time = time;
    return TL_OK;
}

static tl_status take_line(reading *r, const double *number, size_t count)
{
    tl_status status = r->count == 0 ? choose_column(r, count) : TL_OK;
    if (count > COLUMNS)
        return fault(r, "it has too many numbers: records have up to 64 in a line");
    if (r->block) {
        for (size_t k = 0; status == TL_OK && k < count; k++)
            if ((double)r->count < r->stated)
                status = add(r, number[k]);
        return status;
    }
    if (status == TL_OK && (int64_t)count < r->options.column)
        return fault(r, "it has fewer numbers than the first line of numbers");
    if (status == TL_OK)
        status = add(r, number[r->options.column - 1]);
    if (status == TL_OK && r->options.dt == 0 && r->options.column > 1)
        status = note_time(r, number[0]);
    return status;
}

static tl_status read_lines(reading *r)
{
    tl_status status = TL_OK;
    if (strncmp(r->at, "\xef\xbb\xbf", 3) == 0) /* UTF-8's mark */
        r->at += 3;
    for (r->line = 1; status == TL_OK && *r->at; r->line++) {
        double number[COLUMNS];
        const char *end, *begin = r->at;
        const size_t count = numbers_of(begin, number, &end);
        while (is_gap(*begin))
            begin++;
        if (count == SIZE_MAX && r->count == 0)
            read_header(r, begin, end);
        else if (count == SIZE_MAX && *begin != '#')
            status = fault(r, "it is no line of numbers, as those before it are");
        else if (count != SIZE_MAX && count > 0)
            status = take_line(r, number, count);
        r->at = *end ? end + 1 : end;
    }
    r->line--;
    return status;
}

/* dt of the times, which have few digits each. */
static void find_step(reading *r)
{
    if (r->options.dt == 0 && !r->block && r->options.column > 1 && r->count > 1)
        r->options.dt = (r->last_time - r->first_time) / (double)(r->count - 1);
}

static tl_status check_count(const reading *r)
{
    char text[200];
    if (r->count == 0)
        return tl_fail(r->error, TL_E_IO, "file '%.200s' has no samples: it must have lines of numbers", r->file);
    if (r->block && (double)r->count < r->stated) {
        tl_text_print(text, sizeof text, "it ends after %zu of the %.0f samples that NPTS tells", r->count, r->stated);
        return fault(r, text);
    }
    if (r->options.dt == 0)
        return tl_fail(r->error, TL_E_ARGUMENT,
                       "file '%.200s' does not tell the time between its samples: give dt in s", r->file);
    return TL_OK;
}

tl_status tl_record_of_text(const char *file, const char *text, size_t length, const tl_record_options *options,
                            tl_record **record, tl_error *error)
{
    reading r = {.file = file, .at = text, .options = *options, .error = error};
    *record = NULL;
    if (strlen(text) < length)
        return tl_fail(error, TL_E_IO, "file '%.200s' is no text: it has a zero byte", file);
    tl_status status = read_lines(&r);
    if (status == TL_OK) {
        find_step(&r);
        status = check_count(&r);
    }
    if (status == TL_OK && (status = tl_record_make(r.sample, r.count, &r.options, record, error)) != TL_OK)
        tl_error_prefix(error, "file '%.200s': ", file);
    free(r.sample);
    return status;
}

tl_status tl_record_read(const tl_record_options *options, tl_record **record, tl_error *error)
{
    char *bytes = NULL;
    size_t count = 0;
    *record = NULL;
    tl_status status = tl_file_read(options->file, MOST_BYTES, &bytes, &count, error);
    if (status == TL_OK)
        status = tl_record_of_text(options->file, bytes, count, options, record, error);
    free(bytes);
    return status;
}
