/* text.c - takes a text file apart into lines, words and numbers. */
#include "text.h"

#include <string.h>
#include <talus/number.h>

bool text_space(char letter)
{
    return letter == ' ' || (letter >= '\t' && letter <= '\r');
}

char text_small(char letter)
{
    return letter >= 'A' && letter <= 'Z' ? (char)(letter - 'A' + 'a') : letter;
}

tl_status text_check(const tl_host *host, const char *file, const bytes *data)
{
    if (memchr(data->at, '\0', data->count))
        return host->fail(host, TL_E_GEOMETRY,
                          "file '%.200s' holds a zero byte: it is damaged, or no text", file);
    return TL_OK;
}

bool line_next(line *l)
{
    while (*l->next) {
        char *at = l->next, *end = at + strcspn(at, "\n");
        l->next = *end ? end + 1 : end;
        *end = '\0';
        l->number++;
        l->rest = at;
        l->word = line_take(l);
        if (l->word)
            return true;
    }
    return false;
}

bool line_is(const line *l, const char *word)
{
    const char *at = l->word;
    while (*at && text_small(*at) == *word)
        at++, word++;
    return *at == *word;
}

char *line_take(line *l)
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

tl_status line_point(const tl_host *host, const char *file, line *l, tl_vec3 *point)
{
    double number[3];
    for (int i = 0; i < 3; i++) {
        char *word = line_take(l);
        const char *end = word;
        if (word)
            number[i] = tl_number_read(word, &end);
        if (end == word || *end)
            return host->fail(host, TL_E_GEOMETRY,
                              "file '%.200s', line %zu: three numbers are expected after '%.40s'%s"
                              "%.40s%s",
                              file, l->number, l->word, word ? ", not '" : ", the line ends",
                              word ? word : "", word ? "'" : "");
    }
    *point = (tl_vec3){number[0], number[1], number[2]};
    return TL_OK;
}
