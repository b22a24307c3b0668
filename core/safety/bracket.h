/* bracket.h - which factor of a grid a search tries next, by what has been found: no more than these numbers. */
#ifndef TL_SAFETY_BRACKET_H
#define TL_SAFETY_BRACKET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Places on a grid of factors. A search begins with `first`, and with `second` once that holds. */
typedef struct tl_bracket {
    int64_t lowest, last;  /* of the grid */
    int64_t holds, fails;  /* the largest that holds, lowest - 1: none; the least that fails, last + 1: none */
    int64_t first, second; /* second = first: there is none */
    int64_t width;         /* from one place to the next while only one end is known */
    int64_t tried;         /* places so far */
    bool by_steps;         /* a trial begins with the last one that holds */
    bool sure;             /* `fails` was tried from `holds`, its neighbour */
} tl_bracket;

/* The place to be tried next, or -1: neighbours hold and fail, or the grid ends. */
int64_t tl_bracket_next(tl_bracket *b);
/* Whether what fails at a place fails for good: it is the next one above the largest that holds. */
bool tl_bracket_is_sure(const tl_bracket *b, int64_t at);
/* Takes what was found at a place. */
void tl_bracket_take(tl_bracket *b, int64_t at, bool holds);
/* The places that come next as long as all fail, soonest first: at most `most`. */
size_t tl_bracket_ahead(const tl_bracket *b, int64_t *places, size_t most);

#endif
