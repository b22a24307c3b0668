/* bracket.c - which factor of a grid a search tries next.
 *
 * A bracket is widened, twice as far each time, until one end holds and the other fails. Then it is halved until these
 * are neighbours. */
#include "safety/bracket.h"

/* Limit: places that are looked for ahead. */
#define MOST_AHEAD 256

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
    return some_holds && b->fails - b->holds > 1 ? b->holds + (b->fails - b->holds) / 2 : -1;
}

void tl_bracket_take(tl_bracket *b, int64_t at, bool holds)
{
    b->tried++;
    if (holds)
        b->holds = at;
    else
        b->fails = at;
}

size_t tl_bracket_ahead(const tl_bracket *b, int64_t *places, size_t most)
{
    tl_bracket open[MOST_AHEAD]; /* searches as they may be, soonest first */
    size_t count = 0, begin = 0, end = 0;
    open[end++] = *b;
    while (begin < end && count < most) {
        tl_bracket now = open[begin++];
        const int64_t at = tl_bracket_next(&now);
        bool listed = false;
        for (size_t i = 0; i < count; i++)
            listed = listed || places[i] == at;
        if (at >= 0 && !listed)
            places[count++] = at;
        for (int holds = 0; at >= 0 && holds < 2 && end < MOST_AHEAD; holds++) {
            open[end] = now;
            tl_bracket_take(&open[end++], at, holds > 0);
        }
    }
    return count;
}
