/* words.h - words and numbers of a text, with their lines. */
#ifndef TERRAIN_WORDS_H
#define TERRAIN_WORDS_H

#include <stdbool.h>
#include <talus/kit.h>

/* Limit: letters of a word. Longer ones are cut. */
#define MOST_LETTERS 63

typedef struct words {
    const char *at;
    size_t line; /* from 1 */
} words;

/* Takes the next word in small letters, of all lines; false at the end. Unprintable letters become '?'. */
static inline bool words_take(words *w, char word[MOST_LETTERS + 1])
{
    size_t length = 0;
    for (; *w->at == ' ' || (*w->at >= '\t' && *w->at <= '\r'); w->at++)
        w->line += *w->at == '\n';
    for (; *w->at && *w->at != ' ' && !(*w->at >= '\t' && *w->at <= '\r'); w->at++)
        if (length < MOST_LETTERS) {
            const char letter = *w->at >= ' ' && *w->at <= '~' ? *w->at : '?';
            word[length++] = letter >= 'A' && letter <= 'Z' ? (char)(letter - 'A' + 'a') : letter;
        }
    word[length] = '\0';
    return length > 0;
}

/* Whether the whole of a word is a number, which may be infinite or none. */
static inline bool word_number(const char *word, double *number)
{
    const char *end = word;
    *number = tl_number_read(word, &end);
    return end != word && *end == '\0';
}

#endif
