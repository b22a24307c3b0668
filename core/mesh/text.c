/* text.c - words, numbers and lines of a mesh's file. */
#include "mesh/text.h"

#include <math.h>
#include <string.h>
#include <talus/number.h>

/* Limit: coordinates beyond this, m, are a fault of the file. */
#define FARTHEST 1e30

static bool is_space(char letter)
{
    return letter == ' ' || (letter >= '\t' && letter <= '\r');
}

/* Takes the word at which the text stands. */
static bool take(tl_mesh_text *t, char word[TL_MESH_WORD])
{
    size_t length = 0;
    for (; t->at < t->end && !is_space(*t->at); t->at++)
        if (length + 1 < TL_MESH_WORD)
            word[length++] = *t->at;
    word[length] = '\0';
    return length > 0;
}

bool tl_mesh_word(tl_mesh_text *t, char word[TL_MESH_WORD])
{
    for (; t->at < t->end && is_space(*t->at); t->at++)
        t->line += *t->at == '\n';
    return take(t, word);
}

bool tl_mesh_word_here(tl_mesh_text *t, char word[TL_MESH_WORD])
{
    while (t->at < t->end && is_space(*t->at) && *t->at != '\n')
        t->at++;
    return take(t, word);
}

void tl_mesh_next_line(tl_mesh_text *t)
{
    while (t->at < t->end && *t->at != '\n')
        t->at++;
    if (t->at < t->end) {
        t->at++;
        t->line++;
    }
}

tl_status tl_mesh_fault(const tl_mesh_text *t, const char *format, ...)
{
    char text[TL_ERROR_TEXT];
    va_list arguments;
    va_start(arguments, format);
    tl_text_vprint(text, sizeof text, format, arguments);
    va_end(arguments);
    return tl_fail(t->error, TL_E_GEOMETRY, "file '%.200s', line %zu: %s", t->file, t->line, text);
}

tl_status tl_mesh_truncated(const tl_mesh_text *t, const char *wanted)
{
    return tl_fail(t->error, TL_E_GEOMETRY, "file '%.200s' ends at line %zu where %s is expected: it is truncated",
                   t->file, t->line, wanted);
}

tl_status tl_mesh_number(tl_mesh_text *t, const char *what, double *number)
{
    char word[TL_MESH_WORD];
    if (!tl_mesh_word(t, word))
        return tl_mesh_truncated(t, what);
    const char *end = word;
    *number = tl_number_read(word, &end);
    if (end == word || *end)
        return tl_mesh_fault(t, "%s is expected, a number, not '%.40s'; the file is damaged", what, word);
    return TL_OK;
}

tl_status tl_mesh_whole_number(tl_mesh_text *t, const char *what, double least, double most, double *number)
{
    const tl_status status = tl_mesh_number(t, what, number);
    if (status != TL_OK)
        return status;
    if (!(*number >= least && *number <= most) || floor(*number) < *number)
        return tl_mesh_fault(t, "%s is %.17g: it must be a whole number from %.17g to %.17g", what, *number, least,
                             most);
    return TL_OK;
}

tl_status tl_mesh_room(const tl_mesh_text *t, double count, double bytes, const char *things)
{
    /* the last of a text ends without a space */
    if (count * bytes <= (double)tl_mesh_left(t) + 1)
        return TL_OK;
    return tl_mesh_fault(t, "%.17g %s are announced, but only %zu bytes follow: the file is truncated or damaged",
                         count, things, tl_mesh_left(t));
}

tl_status tl_mesh_check_place(const tl_mesh_text *t, tl_vec3 at, const char *node, size_t number)
{
    if (fabs(at.x) <= FARTHEST && fabs(at.y) <= FARTHEST && fabs(at.z) <= FARTHEST)
        return TL_OK;
    return tl_mesh_fault(t, "%s %zu is at {%g, %g, %g}: coordinates must be finite and at most %g; the file is damaged",
                         node, number, at.x, at.y, at.z, FARTHEST);
}

static char small(char letter)
{
    return letter >= 'A' && letter <= 'Z' ? (char)(letter - 'A' + 'a') : letter;
}

bool tl_mesh_alike(const char *a, const char *b)
{
    while (*a && small(*a) == small(*b))
        a++, b++;
    return *a == '\0' && *b == '\0';
}
