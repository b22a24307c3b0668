/* text.h - a text file line by line. */
#ifndef IMPORT_SOLID_TEXT_H
#define IMPORT_SOLID_TEXT_H

#include "mesh.h"

/* A line that is not empty. Its text is cut up where it stands. */
typedef struct line {
    char *next;    /* the text after it */
    char *word;    /* its first word */
    char *rest;    /* what follows */
    size_t number; /* from 1 */
} line;

/* Whether a letter is a space of ASCII; a capital letter of ASCII as a small one. */
bool text_space(char letter);
char text_small(char letter);
/* Refuses what holds a zero byte. */
tl_status text_check(const tl_host *host, const char *file, const bytes *data);
/* Goes to the next line that is not empty; false at the end. */
bool line_next(line *l);
/* Whether its first word is `word`, in letters of any case. */
bool line_is(const line *l, const char *word);
/* Takes the next word of the rest; NULL when there is none. */
char *line_take(line *l);
/* Takes three numbers of the rest. */
tl_status line_point(const tl_host *host, const char *file, line *l, tl_vec3 *point);

#endif
