/* memory_failure.c - lets allocations fail, for tests: loaded before all else (LD_PRELOAD) it stands in the place of the C
 * library's allocator, and a Lua script that requires it tells it when to fail.
 *
 *     local memory = require "memory_failure"
 *     memory.fail(n)         -- the n-th allocation from now on fails, ...
 *     memory.fail(n, true)   -- ... or it and all that follow
 *     count = memory.stop()  -- no more failures; how many allocations were asked for since
 *
 * What is asked for to grow something counts, what is given back does not. All threads count together. */
#define _GNU_SOURCE /* RTLD_NEXT */
#include <dlfcn.h>
#include <errno.h>
#include <lauxlib.h>
#include <lua.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* What dlsym itself asks for while the real functions are looked up. */
#define EARLY 65536
static _Alignas(64) char early[EARLY];
static size_t early_used;

static struct {
    void *(*malloc)(size_t);
    void *(*calloc)(size_t, size_t);
    void *(*realloc)(void *, size_t);
    void *(*aligned_alloc)(size_t, size_t);
    int (*posix_memalign)(void **, size_t, size_t);
    void (*free)(void *);
} next;

static atomic_bool armed;
static atomic_long asked, fails_at;
static atomic_bool for_good;

/* A pointer to a function, from one to an object: C has no cast for it. */
#define LOOK_UP(name)                                                                                                  \
    do {                                                                                                               \
        void *found = dlsym(RTLD_NEXT, #name);                                                                         \
        memcpy(&next.name, &found, sizeof found);                                                                      \
    } while (0)

static void look_up(void)
{
    static bool looking;
    if (next.free || looking)
        return;
    looking = true;
    LOOK_UP(malloc);
    LOOK_UP(calloc);
    LOOK_UP(realloc);
    LOOK_UP(aligned_alloc);
    LOOK_UP(posix_memalign);
    LOOK_UP(free);
}

static void *take_early(size_t size)
{
    size = (size + 63) / 64 * 64;
    if (size > EARLY - early_used)
        abort();
    void *at = early + early_used;
    early_used += size;
    return at;
}

static bool is_early(const void *p)
{
    return (const char *)p >= early && (const char *)p < early + EARLY;
}

static bool fails(void)
{
    if (!atomic_load_explicit(&armed, memory_order_relaxed))
        return false;
    long now = atomic_fetch_add(&asked, 1) + 1, at = atomic_load(&fails_at);
    if (now != at && !(now > at && atomic_load(&for_good)))
        return false;
    errno = ENOMEM;
    return true;
}

void *malloc(size_t size)
{
    look_up();
    if (!next.malloc)
        return take_early(size);
    return fails() ? NULL : next.malloc(size);
}

void *calloc(size_t count, size_t size)
{
    look_up();
    if (!next.calloc)
        return take_early(count * size); /* zero since the start */
    return fails() ? NULL : next.calloc(count, size);
}

void *realloc(void *p, size_t size)
{
    look_up();
    if (is_early(p)) {
        void *to = malloc(size);
        size_t left = (size_t)(early + EARLY - (char *)p);
        return to ? memcpy(to, p, size < left ? size : left) : NULL;
    }
    return fails() ? NULL : next.realloc(p, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    look_up();
    return fails() ? NULL : next.aligned_alloc(alignment, size);
}

int posix_memalign(void **p, size_t alignment, size_t size)
{
    look_up();
    return fails() ? ENOMEM : next.posix_memalign(p, alignment, size);
}

void free(void *p)
{
    if (!p || is_early(p))
        return;
    look_up();
    next.free(p);
}

static int fail(lua_State *L)
{
    atomic_store(&fails_at, (long)luaL_checkinteger(L, 1));
    atomic_store(&for_good, lua_toboolean(L, 2));
    atomic_store(&asked, 0);
    atomic_store(&armed, true);
    return 0;
}

static int stop(lua_State *L)
{
    atomic_store(&armed, false);
    lua_pushinteger(L, (lua_Integer)atomic_load(&asked));
    return 1;
}

__attribute__((visibility("default"))) int luaopen_memory_failure(lua_State *L)
{
    const luaL_Reg functions[] = {{"fail", fail}, {"stop", stop}, {NULL, NULL}};
    luaL_newlib(L, functions);
    return 1;
}
