/* bracket.c - which factor of a grid a search tries next.
 *
 * A bracket is widened, twice as far each time, until one end holds and the other fails. Then it is halved until these
 * are neighbours. Trials that begin with the last one that holds may fail from far below, and hold from their
 * neighbour: the one at the upper end is then made once more from there. */
#include "safety/bracket.h"

int64_t tl_bracket_next(tl_bracket *b)
{
    const bool some_holds = b->holds >= b->lowest, some_fails = b->fails <= b->last;
    if (b->tried == 0)
        return b->first;
    if (b->tried == 1 && some_holds && b->second > b->holds)
        return b->second;
    if (!some_fails) {
        b->width *= 2;
        return b->holds >= b->last ? -1 : b->holds + b->width < b->last ? b->holds + b->width : b->last;
    }
    if (!some_holds && b->fails > b->lowest) {
        b->width *= 2;
        return b->fails - b->width > b->lowest ? b->fails - b->width : b->lowest;
    }
    if (b->fails - b->holds > 1)
        return b->holds + (b->fails - b->holds) / 2;
    return b->sure ? -1 : b->fails;
}

bool tl_bracket_is_sure(const tl_bracket *b, int64_t at)
{
    return at == b->holds + 1 || !b->by_steps;
}

void tl_bracket_take(tl_bracket *b, int64_t at, bool holds)
{
    b->tried++;
    if (!holds) {
        b->sure = tl_bracket_is_sure(b, at);
        b->fails = at;
        return;
    }
    b->holds = at;
    if (b->fails > at)
        return;
    b->fails = b->last + 1; /* it failed from farther below only */
    b->width = 1;
}

size_t tl_bracket_ahead(const tl_bracket *b, int64_t *places, size_t most)
{
    tl_bracket now = *b;
    size_t count = 0;
    for (int64_t at = tl_bracket_next(&now); at >= 0 && count < most; at = tl_bracket_next(&now)) {
        places[count++] = at;
        tl_bracket_take(&now, at, false);
    }
    return count;
}
