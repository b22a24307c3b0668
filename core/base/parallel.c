/* parallel.c - see parallel.h. Workers spin briefly for the next loop before they sleep, because
 * the loops of a step follow each other within microseconds. */
#include "base/parallel.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

/* How many looks a waiting thread takes before it sleeps: some tens of microseconds. */
#define SPIN_LOOKS 4000

struct worker {
    tl_pool *pool;
    unsigned number;
    pthread_t thread;
};

struct tl_pool {
    unsigned threads;
    struct worker *workers;
    pthread_mutex_t lock;
    pthread_cond_t wake, done;
    atomic_uint generation; /* counts loops */
    atomic_uint working;    /* workers still in the loop */
    atomic_bool ending;
    atomic_size_t next; /* the next chunk to take */
    size_t count, chunk, chunks;
    tl_range_fn fn;
    void *user;
};

static void take_chunks(tl_pool *pool, unsigned thread)
{
    for (;;) {
        size_t chunk = atomic_fetch_add_explicit(&pool->next, 1, memory_order_relaxed);
        if (chunk >= pool->chunks)
            return;
        size_t begin = chunk * pool->chunk, end = begin + pool->chunk;
        pool->fn(pool->user, begin, end < pool->count ? end : pool->count, chunk, thread);
    }
}

static unsigned await_loop(tl_pool *pool, unsigned seen)
{
    for (int look = 0; look < SPIN_LOOKS; look++)
        if (atomic_load(&pool->generation) != seen)
            return atomic_load(&pool->generation);
    pthread_mutex_lock(&pool->lock);
    while (atomic_load(&pool->generation) == seen)
        pthread_cond_wait(&pool->wake, &pool->lock);
    pthread_mutex_unlock(&pool->lock);
    return atomic_load(&pool->generation);
}

static void *work(void *argument)
{
    struct worker *worker = argument;
    tl_pool *pool = worker->pool;
    unsigned seen = 0;
    for (;;) {
        seen = await_loop(pool, seen);
        if (atomic_load(&pool->ending))
            return NULL;
        take_chunks(pool, worker->number);
        if (atomic_fetch_sub(&pool->working, 1) == 1) {
            pthread_mutex_lock(&pool->lock);
            pthread_cond_signal(&pool->done);
            pthread_mutex_unlock(&pool->lock);
        }
    }
}

/* Starts a loop (or the end) for all workers. */
static void announce(tl_pool *pool)
{
    pthread_mutex_lock(&pool->lock);
    atomic_fetch_add(&pool->generation, 1);
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
}

tl_pool *tl_pool_create(unsigned threads)
{
    tl_pool *pool = calloc(1, sizeof *pool);
    struct worker *workers = calloc(threads, sizeof *workers);
    if (!pool || !workers) {
        free(pool);
        free(workers);
        return NULL;
    }
    pool->workers = workers;
    pool->threads = 1;
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pthread_cond_init(&pool->done, NULL);
    for (; pool->threads < threads; pool->threads++) {
        struct worker *worker = &workers[pool->threads];
        worker->pool = pool;
        worker->number = pool->threads;
        if (pthread_create(&worker->thread, NULL, work, worker) != 0) {
            tl_pool_destroy(pool);
            return NULL;
        }
    }
    return pool;
}

void tl_pool_destroy(tl_pool *pool)
{
    if (!pool)
        return;
    atomic_store(&pool->ending, true);
    announce(pool);
    for (unsigned i = 1; i < pool->threads; i++)
        pthread_join(pool->workers[i].thread, NULL);
    pthread_mutex_destroy(&pool->lock);
    pthread_cond_destroy(&pool->wake);
    pthread_cond_destroy(&pool->done);
    free(pool->workers);
    free(pool);
}

unsigned tl_pool_threads(const tl_pool *pool)
{
    return pool->threads;
}

void tl_parallel_for(tl_pool *pool, size_t count, size_t chunk, tl_range_fn fn, void *user)
{
    if (count == 0)
        return;
    pool->count = count;
    pool->chunk = chunk;
    pool->chunks = (count + chunk - 1) / chunk;
    pool->fn = fn;
    pool->user = user;
    atomic_store(&pool->next, 0);
    if (pool->threads == 1 || pool->chunks == 1) {
        take_chunks(pool, 0);
        return;
    }
    atomic_store(&pool->working, pool->threads - 1);
    announce(pool);
    take_chunks(pool, 0);
    for (int look = 0; look < SPIN_LOOKS; look++)
        if (atomic_load(&pool->working) == 0)
            return;
    pthread_mutex_lock(&pool->lock);
    while (atomic_load(&pool->working) != 0)
        pthread_cond_wait(&pool->done, &pool->lock);
    pthread_mutex_unlock(&pool->lock);
}
