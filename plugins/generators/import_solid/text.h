/* text.h - lines, words and numbers of a text. */
#ifndef IMPORT_SOLID_TEXT_H
#define IMPORT_SOLID_TEXT_H

#include "soup.h"

/* A line that is not empty. Its text is cut up where it stands. */
typedef struct text_line {
    char *next;    /* the text after it */
    char *word;    /* its first word */
    char *rest;    /* what follows */
    size_t number; /* from 1 */
} text_line;

/* Whether a letter is a space of ASCII. */
static inline bool text_space(char letter)
{
    return letter == ' ' || (letter >= '\t' && letter <= '\r');
}

/* A capital letter of ASCII as a small one. */
static inline char text_small(char letter)
{
    return letter >= 'A' && letter <= 'Z' ? (char)(letter - 'A' + 'a') : letter;
}

/* Refuses what holds a zero byte. */
tl_status text_check(const soup *s, const char *text, size_t count);
/* Takes the next word of the rest; NULL when there is none. */
char *line_take(text_line *l);
/* The rest without the spaces around it, and its length. */
const char *line_rest(const text_line *l, size_t *length);
/* Goes to the next line that is not empty; false at the end. */
bool line_next(text_line *l);
/* The same, where a line whose last letters are `joins` goes on in the next one. */
bool line_next_joined(text_line *l, const char *joins);
/* Whether its first word is `word`, in letters of any case. */
bool line_is(const text_line *l, const char *word);
/* Whether two words are one, in letters of any case; `word` has small ones. */
bool word_is(const char *given, const char *word);
/* Reads a word that is a coordinate, and notes its digits. */
tl_status text_number(soup *s, const char *word, size_t line, double *number);
/* Reads a word that is a whole number of at most `most`. */
tl_status text_whole(const soup *s, const char *word, size_t line, size_t most, size_t *number);
/* Takes three numbers of the rest. */
tl_status line_point(soup *s, text_line *l, tl_vec3 *point);

#endif
