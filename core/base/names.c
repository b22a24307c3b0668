/* names.c - see names.h. Distance: optimal string alignment (Levenshtein's three edits and the swap of
 * two neighbours), the edits of a typing error. */
#include "base/names.h"

#include "base/error.h"

#include <stdio.h>
#include <string.h>

/* Longer words are not typing errors of a parameter's name; the bound keeps the table on the stack. */
#define LONGEST_WORD 63
/* More names than this are not listed in a sentence. */
#define MOST_LISTED 24
/* Letters from which on the beginning of a name counts as a hint at it ("fric"). */
#define SHORTEST_PREFIX 3

static int lower(char c)
{
    return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
}

static size_t min3(size_t a, size_t b, size_t c)
{
    size_t m = a < b ? a : b;
    return m < c ? m : c;
}

size_t tl_edit_distance(const char *a, const char *b)
{
    size_t rows = strlen(a), columns = strlen(b);
    if (rows > LONGEST_WORD || columns > LONGEST_WORD)
        return SIZE_MAX;
    /* Three rows of the table: of i - 2, i - 1 and i letters of a. */
    size_t table[3][LONGEST_WORD + 1];
    for (size_t j = 0; j <= columns; j++)
        table[0][j] = j;
    for (size_t i = 1; i <= rows; i++) {
        size_t *row = table[i % 3], *above = table[(i + 2) % 3], *second = table[(i + 1) % 3];
        row[0] = i;
        for (size_t j = 1; j <= columns; j++) {
            size_t replace = above[j - 1] + (lower(a[i - 1]) != lower(b[j - 1]));
            row[j] = min3(above[j] + 1, row[j - 1] + 1, replace);
            bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
            if (swapped && second[j - 2] + 1 < row[j])
                row[j] = second[j - 2] + 1;
        }
    }
    return table[rows % 3][columns];
}

static bool begins_with(const char *name, const char *word, size_t length)
{
    for (size_t i = 0; i < length; i++)
        if (lower(name[i]) != lower(word[i]))
            return false;
    return true;
}

const char *tl_nearest_name(const char *word, const char *const *names, size_t count)
{
    size_t length = strlen(word);
    /* A third of the letters may be wrong, but not the only one. */
    size_t best = length < 2 ? 1 : (length + 2) / 3 + 1;
    const char *nearest = NULL;
    for (size_t i = 0; i < count; i++) {
        size_t distance = tl_edit_distance(word, names[i]);
        if (distance > 1 && length >= SHORTEST_PREFIX && begins_with(names[i], word, length))
            distance = 1;
        if (distance < best) {
            best = distance;
            nearest = names[i];
        }
    }
    return nearest;
}

static void list_names(char *text, size_t size, const char *const *names, size_t count)
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; i < count && used < size; i++) {
        int n = snprintf(text + used, size - used, "%s%s", i ? ", " : "", names[i]);
        used += n > 0 ? (size_t)n : 0;
    }
}

tl_status tl_fail_unknown(tl_error *error, tl_status status, const char *context, const char *what, const char *word,
                          const char *const *names, size_t count)
{
    char hint[96] = "", known[TL_ERROR_TEXT / 2] = "";
    const char *nearest = tl_nearest_name(word, names, count);
    if (nearest)
        snprintf(hint, sizeof hint, "; did you mean '%s'?", nearest);
    if (count > 0 && count <= MOST_LISTED)
        list_names(known, sizeof known, names, count);
    const char *open = known[0] ? " (known: " : "", *close = known[0] ? ")" : "";
    return tl_fail(error, status, "%sunknown %s '%.80s'%s%s%s%s", context, what, word, hint, open, known, close);
}
