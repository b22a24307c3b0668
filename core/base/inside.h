/* inside.h - which function of a plugin each thread is in, so that a crash can be told to be a plugin's
 * (plugin/crash.c). Calls of plugins do not nest. */
#ifndef TL_BASE_INSIDE_H
#define TL_BASE_INSIDE_H

#include <talus/plugin.h>

typedef struct tl_inside {
    const char *function; /* "update"; NULL: in none */
    const tl_kind *kind;  /* whose function, or NULL */
    const char *path;     /* without a kind: the file */
} tl_inside;

extern _Thread_local tl_inside tl_inside_plugin;

/* Before and after a call of a kind's function. */
static inline void tl_enter(const tl_kind *kind, const char *function)
{
    tl_inside_plugin.kind = kind;
    tl_inside_plugin.function = function;
}

static inline void tl_leave(void)
{
    tl_inside_plugin.function = NULL;
}

/* Bytes of the stack on which a thread's signals are handled when its own has run out. A handler needs some KB of
 * registers, and more. */
#define TL_SIGNAL_STACK 65536

#endif
