/* groups.h - things in groups: each names another one of its group, and the first of a group itself. */
#ifndef TL_BASE_GROUPS_H
#define TL_BASE_GROUPS_H

#include <stdint.h>

/* The first of the group of one. */
static inline uint32_t tl_first_of(uint32_t *of, uint32_t one)
{
    while (of[one] != one)
        one = of[one] = of[of[one]];
    return one;
}

/* Makes two groups one; its first is the lower of their first. */
static inline void tl_put_together(uint32_t *of, uint32_t one, uint32_t other)
{
    uint32_t a = tl_first_of(of, one), b = tl_first_of(of, other);
    of[a > b ? a : b] = a > b ? b : a;
}

#endif
