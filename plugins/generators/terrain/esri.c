/* esri.c - ESRI ASCII grids:
 *
 *     ncols 3                          columns, rows
 *     nrows 2
 *     xllcorner 1000                   the south-west corner of the first cell; or xllcenter, yllcenter: its middle
 *     yllcorner 2000
 *     cellsize 5                       or dx and dy
 *     NODATA_value -9999               -9999 where it is left out; nan as well
 *     12 13 14                         the first row is the northern one
 *     11 12 -9999
 *
 * A number is the height of the middle of its cell. */
#include "terrain.h"
#include "words.h"

/* Default: heights of this number are none. */
#define NO_DATA (-9999.0)
/* Tolerance: relative difference of a height from a NODATA_value beyond all heights, which fewer digits make, as of
 * -3.4028234663852886e+38. Test: lua/test_terrain. */
#define SAME_DIGITS 1e-5

enum { COLUMNS, ROWS, X_CORNER, Y_CORNER, X_CENTER, Y_CENTER, SIZE, DX, DY, NONE, KEYS };
static const char *const keys[KEYS] = {"ncols",     "nrows",    "xllcorner", "yllcorner", "xllcenter",
                                       "yllcenter", "cellsize", "dx",        "dy",        "nodata_value"};

typedef struct header {
    double value[KEYS];
    bool given[KEYS];
} header;

static tl_status read_key(const tl_host *host, const char *file, words *w, int key, header *h)
{
    char word[MOST_LETTERS + 1];
    const size_t line = w->line;
    const bool any = words_take(w, word);
    if (h->given[key])
        return host->fail(host, TL_E_ARGUMENT, "file '%.200s', line %zu: %s is given twice", file, line, keys[key]);
    h->given[key] = true;
    if (!any || !word_number(word, &h->value[key]))
        return host->fail(host, TL_E_ARGUMENT, "file '%.200s', line %zu: %s '%s' is no number", file, line, keys[key],
                          word);
    const double v = h->value[key];
    if (key <= ROWS && !(v >= 2 && v <= MOST_LINES && v == floor(v)))
        return host->fail(host, TL_E_ARGUMENT, "file '%.200s', line %zu: %s = %g is no whole number in [2, %d]", file,
                          line, keys[key], v, MOST_LINES);
    if (key >= SIZE && key <= DY && !(v > 0 && v <= FARTHEST))
        return host->fail(host, TL_E_ARGUMENT, "file '%.200s', line %zu: %s = %g is outside (0, 1e9]", file, line,
                          keys[key], v);
    if (key >= X_CORNER && key <= Y_CENTER && !(fabs(v) <= FARTHEST))
        return host->fail(host, TL_E_ARGUMENT, "file '%.200s', line %zu: %s = %g is outside [-1e9, 1e9]", file, line,
                          keys[key], v);
    return TL_OK;
}

/* Reads keys up to the first height, which it leaves. */
static tl_status read_header(const tl_host *host, const char *file, words *w, header *h)
{
    char word[MOST_LETTERS + 1];
    tl_status status = TL_OK;
    if (strncmp(w->at, "\xef\xbb\xbf", 3) == 0) /* UTF-8's mark */
        w->at += 3;
    while (status == TL_OK) {
        const words before = *w;
        int key = 0;
        if (!words_take(w, word))
            return TL_OK;
        while (key < KEYS && strcmp(word, keys[key]) != 0)
            key++;
        if (key == KEYS && strchr("+-.0123456789", *word)) {
            *w = before;
            return TL_OK;
        }
        status = key < KEYS ? read_key(host, file, w, key, h)
                            : host->fail(host, TL_E_ARGUMENT,
                                         "file '%.200s', line %zu: '%s' is no key of an ESRI ASCII grid: these are "
                                         "ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize and "
                                         "NODATA_value",
                                         file, w->line, word);
    }
    return status;
}

static tl_status check_header(const tl_host *host, const char *file, const header *h)
{
    const bool needed[][2] = {{h->given[COLUMNS], false},
                              {h->given[ROWS], false},
                              {h->given[X_CORNER], h->given[X_CENTER]},
                              {h->given[Y_CORNER], h->given[Y_CENTER]},
                              {h->given[SIZE], h->given[DX] && h->given[DY]}};
    static const char *const names[] = {"ncols", "nrows", "xllcorner", "yllcorner", "cellsize"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (!needed[i][0] && !needed[i][1])
            return host->fail(host, TL_E_ARGUMENT, "file '%.200s': %s is missing: the file is no ESRI ASCII grid", file,
                              names[i]);
        if (needed[i][0] && needed[i][1])
            return host->fail(host, TL_E_ARGUMENT, "file '%.200s': %s is given in two ways: keep one", file, names[i]);
    }
    if (h->value[COLUMNS] * h->value[ROWS] > MOST_NODES)
        return host->fail(host, TL_E_ARGUMENT, "file '%.200s': %g heights are more than %d: clip it to the model", file,
                          h->value[COLUMNS] * h->value[ROWS], MOST_NODES);
    return TL_OK;
}

static bool is_none(double z, double none)
{
    if (isnan(none))
        return isnan(z);
    return z == none || (isfinite(none) && fabs(none) > FARTHEST && fabs(z - none) <= SAME_DIGITS * fabs(none));
}

static tl_status read_heights(const tl_host *host, const char *file, words *w, double none, grid *g)
{
    char word[MOST_LETTERS + 1];
    for (uint32_t row = 0; row < g->rows; row++)
        for (uint32_t column = 0; column < g->columns; column++) {
            double z;
            if (!words_take(w, word))
                return host->fail(host, TL_E_ARGUMENT,
                                  "file '%.200s' ends before row %u, column %u of %u rows and %u columns: it is "
                                  "truncated",
                                  file, row + 1, column + 1, g->rows, g->columns);
            if (!word_number(word, &z) || (!is_none(z, none) && !(fabs(z) <= FARTHEST)))
                return host->fail(host, TL_E_ARGUMENT,
                                  "file '%.200s', row %u, column %u: the height '%s' is no number in [-1e9, 1e9]%s",
                                  file, row + 1, column + 1, word, strchr(word, ',') ? ": write decimal points" : "");
            g->z[(size_t)row * g->columns + column] = is_none(z, none) ? NAN : z;
        }
    if (words_take(w, word))
        return host->fail(host, TL_E_ARGUMENT, "file '%.200s', line %zu: '%s' is beyond %u rows of %u heights", file,
                          w->line, word, g->rows, g->columns);
    return TL_OK;
}

tl_status esri_read(const tl_host *host, const char *file, const char *text, grid *made)
{
    words w = {text, 1};
    header h = {.value = {[NONE] = NO_DATA}};
    tl_status status = read_header(host, file, &w, &h);
    if (status == TL_OK)
        status = check_header(host, file, &h);
    if (status != TL_OK)
        return status;
    *made = (grid){.columns = (uint32_t)h.value[COLUMNS],
                   .rows = (uint32_t)h.value[ROWS],
                   .dx = h.value[h.given[SIZE] ? SIZE : DX],
                   .dy = h.value[h.given[SIZE] ? SIZE : DY]};
    made->x = h.given[X_CENTER] ? h.value[X_CENTER] : h.value[X_CORNER] + 0.5 * made->dx;
    made->y = h.given[Y_CENTER] ? h.value[Y_CENTER] : h.value[Y_CORNER] + 0.5 * made->dy;
    const size_t nodes = (size_t)made->columns * made->rows;
    if (strlen(w.at) < 2 * nodes - 1) /* a height and the space before the next one */
        return host->fail(host, TL_E_ARGUMENT, "file '%.200s' holds fewer than %zu heights (ncols x nrows): truncated?",
                          file, nodes);
    made->z = (double *)malloc(nodes * sizeof *made->z);
    if (!made->z)
        return host->fail(host, TL_E_MEMORY, "file '%.200s': out of memory for %zu heights", file, nodes);
    return read_heights(host, file, &w, h.value[NONE], made);
}
