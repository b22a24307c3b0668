/* talus/csv.h - tables of numbers in text: a line of names, then rows, separated by commas, semicolons or tabs.
 *
 * Columns are found by their names, in letters of any case; those that are not asked for are passed over. Empty lines,
 * lines of separators only and lines that begin with # are left out. A cell in quotes may hold separators. Where cells
 * are not separated by commas, numbers may have decimal commas: all of a file, or none. Every fault is a sentence with
 * its line and column. */
#ifndef TALUS_CSV_H
#define TALUS_CSV_H

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>

/* Limit: columns of a file, and rows, beyond which it is refused. */
#define TL_CSV_COLUMNS 64
#define TL_CSV_ROWS ((size_t)1 << 26)
/* Bytes of a sentence. */
#define TL_CSV_WHY 256

/* A column that is asked for. */
typedef struct tl_csv_column {
    const char *name; /* small letters */
    double min, max;  /* what a value must be within; INFINITY where all may be */
    bool above;       /* a value must be > min */
    bool optional;    /* the file may be without it: all values are `absent` */
    double absent;
} tl_csv_column;

/* A file that is read. */
typedef struct tl_csv {
    const tl_csv_column *column;
    size_t columns;
    double *at; /* [rows][columns], from malloc */
    size_t rows, capacity;
    size_t line; /* from 1 */
    char separator;
    char decimal;                  /* the decimal sign of the numbers so far, 0: there was none */
    size_t cells;                  /* of a line */
    size_t wanted[TL_CSV_COLUMNS]; /* of each cell the column, or `columns` */
    char why[TL_CSV_WHY];          /* a sentence after a fault */
} tl_csv;

static inline bool tl_csv_space(char letter)
{
    return letter == ' ' || letter == '\r' || letter == '\t';
}

/* What follows a text in quotes at `at`, in which a quote is doubled; `at` where there is none that ends in this line.
 */
static inline const char *tl_csv_quoted(const char *at)
{
    for (const char *end = at + 1; *at == '"' && *end && *end != '\n'; end++)
        if (*end == '"' && *++end != '"')
            return end;
    return at;
}

/* The cell at `at` without spaces and quotes around it: its length in *length. Gives where the cell ends. */
static inline const char *tl_csv_cell(const tl_csv *c, const char **at, size_t *length)
{
    const char *begin = *at;
    while (tl_csv_space(*begin) && *begin != c->separator)
        begin++;
    const char *end = tl_csv_quoted(begin);
    while (*end && *end != '\n' && *end != c->separator)
        end++;
    const char *next = end;
    while (end > begin && tl_csv_space(end[-1]))
        end--;
    if (end - begin >= 2 && *begin == '"' && end[-1] == '"') {
        begin++;
        end--;
    }
    *at = begin;
    *length = (size_t)(end - begin);
    return next;
}

/* Whether a cell has a column's name; a space or - counts as _. */
static inline bool tl_csv_is(const char *cell, size_t length, const char *name)
{
    for (size_t i = 0; i < length; i++) {
        char letter = cell[i];
        letter = letter >= 'A' && letter <= 'Z' ? (char)(letter - 'A' + 'a') : letter;
        letter = letter == ' ' || letter == '-' ? '_' : letter;
        if (!name[i] || letter != name[i])
            return false;
    }
    return !name[length];
}

/* The separator of the line of names: what comes first. */
static inline char tl_csv_separator(const char *text)
{
    const size_t ahead = strcspn(text, ",;\t\n");
    return text[ahead] && text[ahead] != '\n' ? text[ahead] : ',';
}

/* A cell or a line, printable, and cut off to `room` bytes. */
static inline void tl_csv_show(const char *cell, size_t length, char *shown, size_t room)
{
    size_t i = 0;
    while (length > 0 && tl_csv_space(cell[length - 1]))
        length--;
    for (; i < length && i + 1 < room; i++)
        shown[i] = cell[i] >= ' ' && cell[i] <= '~' ? cell[i] : '?';
    shown[i] = '\0';
}

/* Takes the decimal sign of a number, and makes a point of a comma. false after a fault: the file has both. */
static inline bool tl_csv_decimal(tl_csv *c, char *text, const char *column, const char *shown)
{
    char *comma = c->separator == ',' ? NULL : strchr(text, ','), *point = strchr(text, '.');
    if (!comma && !point)
        return true;
    const char sign = comma ? ',' : '.';
    if ((c->decimal && c->decimal != sign) || (comma && point)) {
        tl_text_print(c->why, sizeof c->why,
                      "line %zu, column '%s': '%s': numbers are to have decimal points or decimal commas, not both",
                      c->line, column, shown);
        return false;
    }
    c->decimal = sign;
    if (comma)
        *comma = '.';
    return true;
}

/* Reads the line of names at `text`; gives what follows, NULL after a fault. */
static inline const char *tl_csv_names(tl_csv *c, const char *text)
{
    bool seen[TL_CSV_COLUMNS] = {false};
    const char *line = text;
    c->separator = tl_csv_separator(text);
    for (bool more = true; more;) {
        size_t length, i = 0;
        const char *cell = text;
        text = tl_csv_cell(c, &cell, &length);
        while (i < c->columns && !tl_csv_is(cell, length, c->column[i].name))
            i++;
        if (c->cells == TL_CSV_COLUMNS || (i < c->columns && seen[i])) {
            tl_text_print(c->why, sizeof c->why, "line %zu names %s", c->line,
                          c->cells == TL_CSV_COLUMNS ? "more than 64 columns" : "a column twice");
            return NULL;
        }
        if (i < c->columns)
            seen[i] = true;
        c->wanted[c->cells++] = i;
        more = *text == c->separator;
        text += more;
    }
    for (size_t i = 0; i < c->columns; i++)
        if (!seen[i] && !c->column[i].optional) {
            char shown[64];
            tl_csv_show(line, (size_t)(text - line), shown, sizeof shown);
            tl_text_print(c->why, sizeof c->why,
                          "line %zu does not name a column '%s', but has '%s': the first line is to name the columns",
                          c->line, c->column[i].name, shown);
            return NULL;
        }
    return text;
}

/* Reads a cell that is a number of column i; false after a fault. */
static inline bool tl_csv_number(tl_csv *c, const char *cell, size_t length, size_t i, double *value)
{
    const tl_csv_column *column = &c->column[i];
    char text[64] = "", shown[32];
    const char *end = text;
    tl_csv_show(cell, length, shown, sizeof shown);
    if (length < sizeof text) {
        memcpy(text, cell, length);
        text[length] = '\0';
        if (!tl_csv_decimal(c, text, column->name, shown))
            return false;
        *value = tl_number_read(text, &end);
    }
    if (end == text || *end || !isfinite(*value)) {
        tl_text_print(c->why, sizeof c->why, "line %zu, column '%s': %s%s%s%s", c->line, column->name,
                      length ? "'" : "the cell is empty", shown, length ? "' is no number" : "",
                      strchr(text, ',') && c->separator == ',' ? ": decimal commas need semicolons between cells" : "");
        return false;
    }
    if (*value < column->min || *value > column->max || (column->above && *value <= column->min)) {
        if (isinf(column->max))
            tl_text_print(c->why, sizeof c->why, "line %zu, column '%s': %s must be %s %g", c->line, column->name,
                          shown, column->above ? ">" : ">=", column->min);
        else
            tl_text_print(c->why, sizeof c->why, "line %zu, column '%s': %s is outside %c%g, %g]", c->line,
                          column->name, shown, column->above ? '(' : '[', column->min, column->max);
        return false;
    }
    return true;
}

/* Reads the row at `text`; gives what follows, NULL after a fault. */
static inline const char *tl_csv_row(tl_csv *c, const char *text)
{
    if (c->rows == c->capacity) {
        const size_t capacity = c->capacity ? 2 * c->capacity : 64;
        double *at = c->rows < TL_CSV_ROWS ? (double *)realloc(c->at, capacity * c->columns * sizeof *at) : NULL;
        if (!at) {
            tl_text_print(c->why, sizeof c->why, "line %zu: out of memory", c->line);
            return NULL;
        }
        c->at = at;
        c->capacity = capacity;
    }
    double *row = c->at + c->rows * c->columns;
    for (size_t i = 0; i < c->columns; i++)
        row[i] = c->column[i].absent;
    size_t cells = 0;
    for (bool more = true; more;) {
        size_t length;
        const char *cell = text;
        text = tl_csv_cell(c, &cell, &length);
        const size_t i = cells < c->cells ? c->wanted[cells] : c->columns;
        if (i < c->columns && !tl_csv_number(c, cell, length, i, &row[i]))
            return NULL;
        cells++;
        more = *text == c->separator;
        text += more;
    }
    if (cells != c->cells) {
        tl_text_print(c->why, sizeof c->why, "line %zu has %zu cell%s, the line of names has %zu%s", c->line, cells,
                      cells == 1 ? "" : "s", c->cells,
                      c->separator == ',' ? " (decimal commas need semicolons between cells)" : "");
        return NULL;
    }
    c->rows++;
    return text;
}

/* Reads a text that ends in a zero byte; `column` and `columns` of *c are given. false with a sentence in `why`. Free
 * `at` in any case. */
static inline bool tl_csv_read(tl_csv *c, const char *text)
{
    if (strncmp(text, "\xef\xbb\xbf", 3) == 0) /* UTF-8's mark */
        text += 3;
    for (c->line = 1; text && *text; c->line++) {
        const char *at = text, *full;
        while (tl_csv_space(*at))
            at++;
        for (full = at; tl_csv_space(*full) || (c->cells && *full == c->separator);)
            full++;
        if (*at == '#' || *full == '\n' || !*full)
            text = at + strcspn(at, "\n");
        else
            text = c->cells ? tl_csv_row(c, text) : tl_csv_names(c, text);
        if (text && *text == '\n')
            text++;
    }
    if (!text)
        return false;
    if (c->rows == 0)
        tl_text_print(c->why, sizeof c->why, c->cells ? "it has no row after the line of names" : "it is empty");
    return c->rows > 0;
}

#endif
