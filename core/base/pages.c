/* pages.c - see pages.h. */
#define _DEFAULT_SOURCE /* madvise */
#include "base/pages.h"

#include <stdint.h>
#include <sys/mman.h>

/* Bytes of a large page of x86-64 and of most others. */
#define LARGE ((size_t)2 << 20)

void tl_pages_large(void *memory, size_t bytes)
{
#ifdef MADV_HUGEPAGE
    uintptr_t begin = ((uintptr_t)memory + LARGE - 1) / LARGE * LARGE;
    uintptr_t end = ((uintptr_t)memory + bytes) / LARGE * LARGE;
    if (begin < end)
        (void)madvise((void *)begin, end - begin, MADV_HUGEPAGE); /* if it fails, nothing changes */
#else
    (void)memory;
    (void)bytes;
#endif
}
