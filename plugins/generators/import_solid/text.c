/* text.c - lines, words and numbers of a text. */
#include "text.h"

#include <string.h>
#include <talus/kit.h>

tl_status text_check(const soup *s, const char *text, size_t count)
{
    const char *zero = memchr(text, '\0', count);
    if (zero)
        return s->host->fail(s->host, TL_E_GEOMETRY,
                             "file '%.200s' holds a zero byte at byte %zu: it is damaged, or no text", s->file,
                             (size_t)(zero - text) + 1);
    return TL_OK;
}

char *line_take(text_line *l)
{
    while (text_space(*l->rest))
        l->rest++;
    if (!*l->rest)
        return NULL;
    char *word = l->rest;
    while (*l->rest && !text_space(*l->rest))
        l->rest++;
    if (*l->rest)
        *l->rest++ = '\0';
    return word;
}

const char *line_rest(const text_line *l, size_t *length)
{
    const char *at = l->rest;
    while (text_space(*at))
        at++;
    *length = strlen(at);
    while (*length > 0 && text_space(at[*length - 1]))
        --*length;
    return at;
}

/* Whether the line from `at` to `end` ends in `joins`; blanks that then. */
static bool goes_on(char *at, char *end, const char *joins)
{
    size_t length = strlen(joins);
    while (end > at && text_space(end[-1]))
        end--;
    if (length == 0 || (size_t)(end - at) < length || memcmp(end - length, joins, length) != 0)
        return false;
    memset(end - length, ' ', length);
    return true;
}

bool line_next_joined(text_line *l, const char *joins)
{
    while (*l->next) {
        char *at = l->next, *end = at + strcspn(at, "\n");
        l->number++;
        for (char *from = at; *end && goes_on(from, end, joins); l->number++) {
            *end = ' ';
            from = end;
            end += strcspn(end, "\n");
        }
        l->next = *end ? end + 1 : end;
        *end = '\0';
        l->rest = at;
        l->word = line_take(l);
        if (l->word)
            return true;
    }
    return false;
}

bool line_next(text_line *l)
{
    return line_next_joined(l, "");
}

bool word_is(const char *given, const char *word)
{
    while (*given && text_small(*given) == *word)
        given++, word++;
    return *given == *word;
}

bool line_is(const text_line *l, const char *word)
{
    return word_is(l->word, word);
}

/* Notes how many digits a number has after the point, and in all. */
static void note_digits(soup *s, const char *word)
{
    int decimals = 0, digits = 0, power = 0, sign = 1;
    bool point = false;
    for (; *word && *word != 'e' && *word != 'E'; word++) {
        if (*word == '.')
            point = true;
        else if (*word >= '0' && *word <= '9') {
            digits += digits > 0 || *word != '0';
            decimals += point;
        }
    }
    if (*word) {
        word++;
        sign = *word == '-' ? -1 : 1;
        for (word += *word == '-' || *word == '+'; *word >= '0' && *word <= '9' && power < 1000; word++)
            power = 10 * power + (*word - '0');
    }
    decimals -= sign * power;
    s->decimals = decimals > s->decimals ? decimals : s->decimals;
    s->digits = digits > s->digits ? digits : s->digits;
}

tl_status text_number(soup *s, const char *word, size_t line, double *number)
{
    const char *end = word;
    *number = tl_number_read(word, &end);
    if (end != word && *end == '\0') {
        note_digits(s, word);
        return TL_OK;
    }
    const char *remedy = end != word && *end == ',' && end[1] >= '0' && end[1] <= '9'
                             ? "write a point in the place of the decimal comma"
                             : "the file is damaged";
    return SOUP_FAULT(s, ", line %zu: '%.40s' is not a number; %s", line, word, remedy);
}

tl_status text_whole(const soup *s, const char *word, size_t line, size_t most, size_t *number)
{
    size_t value = 0;
    const char *at = word;
    for (; *at >= '0' && *at <= '9' && value <= most; at++)
        value = 10 * value + (size_t)(*at - '0');
    *number = value;
    if (at != word && !*at && value <= most)
        return TL_OK;
    return SOUP_FAULT(s, ", line %zu: '%.40s' is not a whole number from 0 to %zu; the file is damaged", line, word,
                      most);
}

tl_status line_point(soup *s, text_line *l, tl_vec3 *point)
{
    double number[3];
    for (int i = 0; i < 3; i++) {
        const char *word = line_take(l);
        if (!word)
            return SOUP_FAULT(s, ", line %zu: three numbers are expected after '%.40s', the line ends", l->number,
                              l->word);
        tl_status status = text_number(s, word, l->number, &number[i]);
        if (status != TL_OK)
            return status;
    }
    *point = (tl_vec3){number[0], number[1], number[2]};
    return TL_OK;
}
