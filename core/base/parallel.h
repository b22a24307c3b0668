/* parallel.h - a parallel for over ranges on a fixed pool of threads.
 *
 * The range is divided into chunks of a fixed size that does not depend on the number of threads. So what a chunk
 * computes is the same for any number of them. Sums over a range are exact (exact.h), or made per chunk and added in
 * chunk order by the caller. */
#ifndef TL_BASE_PARALLEL_H
#define TL_BASE_PARALLEL_H

#include <pthread.h>
#include <talus/plugin.h>

#define TL_MAX_THREADS 256

typedef struct tl_pool tl_pool;

/* Work on rows [begin, end); chunk is the number of the chunk, thread that of the thread (from 0). */
typedef void (*tl_range_fn)(void *user, size_t begin, size_t end, size_t chunk, unsigned thread);

/* A pool of `threads` threads, the caller counted; NULL when it cannot be made. */
tl_pool *tl_pool_create(unsigned threads);
void tl_pool_destroy(tl_pool *pool);
unsigned tl_pool_threads(const tl_pool *pool);
/* Calls `fn` for every chunk of [0, count) and returns when all are done. */
void tl_parallel_for(tl_pool *pool, size_t count, size_t chunk, tl_range_fn fn, void *user);

/* The first failure of a parallel phase, by chunk, and the point or row it came from. */
typedef struct tl_failure {
    pthread_mutex_t lock; /* whoever keeps the struct makes and destroys it */
    tl_error error;
    size_t chunk, point;
} tl_failure;

/* Notes a failure, on any thread; that of the lowest chunk counts. */
void tl_failure_note(tl_failure *failure, size_t chunk, tl_status status, size_t point, const char *text);

#endif
