/* parallel.c - see parallel.h.
 *
 * The loops of a step follow each other within microseconds, so none may cost a system call: threads that wait
 * spin for a while, and sleep only when nothing has come by then; whoever has something for a sleeper wakes it.
 *
 * A thread takes a chunk by counting down the ticket, which holds the number of the loop, too: one that
 * comes late, from a loop that is over, finds a ticket with nothing on it or takes a chunk of the new loop,
 * never one of the old. So a loop ends as soon as its chunks are done, whether or not all threads have
 * seen it: where there are more threads than processors, nobody waits for one that does not run. What
 * describes a loop does not change while a chunk of it is out. */
#include "base/parallel.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

/* How many looks a waiting thread takes before it sleeps: some 50 microseconds, as long as it takes
 * to put a thread to sleep and wake it. */
#define SPIN_LOOKS 1000

/* Bytes apart at which two threads do not disturb each other's memory: two cache lines, which
 * processors fetch in pairs. */
#define APART 128

/* Low half of a ticket: chunks that are left; high half: the loop. */
#define LEFT_MASK 0xffffffffu
#define LOOP_UNIT ((uint64_t)1 << 32)

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
    atomic_uint sleepers;      /* workers that wait for `wake` */
    atomic_bool caller_sleeps; /* and the caller for `done` */
    atomic_bool ending;
    /* the loop; written while no chunk is out */
    size_t count, chunk, chunks;
    tl_range_fn fn;
    void *user;
    _Alignas(APART) _Atomic uint64_t ticket;
    _Alignas(APART) _Atomic size_t unfinished; /* chunks that are not done */
};

/* Tells the processor that this is a loop that waits: it saves power, and a sibling thread runs faster. */
static void relax(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("yield");
#endif
}

static bool has_chunks(tl_pool *pool)
{
    return atomic_load(&pool->ticket) & LEFT_MASK;
}

/* Takes a chunk off the ticket; false when none is left. */
static bool take_chunk(tl_pool *pool, size_t *chunk)
{
    uint64_t ticket = atomic_load(&pool->ticket);
    while (ticket & LEFT_MASK)
        if (atomic_compare_exchange_weak(&pool->ticket, &ticket, ticket - 1)) {
            *chunk = pool->chunks - (size_t)(ticket & LEFT_MASK);
            return true;
        }
    return false;
}

static void do_chunk(tl_pool *pool, size_t chunk, unsigned thread)
{
    size_t begin = chunk * pool->chunk, end = begin + pool->chunk;
    pool->fn(pool->user, begin, end < pool->count ? end : pool->count, chunk, thread);
}

/* Works until no chunk is left; returns true when the last of the loop was done here. */
static bool do_chunks(tl_pool *pool, unsigned thread)
{
    size_t chunk;
    bool last = false;
    while (take_chunk(pool, &chunk)) {
        do_chunk(pool, chunk, thread);
        last = atomic_fetch_sub(&pool->unfinished, 1) == 1;
    }
    return last;
}

/* Waits for a loop; false at the end of the pool. */
static bool await_loop(tl_pool *pool)
{
    for (int look = 0; look < SPIN_LOOKS; look++) {
        if (has_chunks(pool))
            return true;
        if (atomic_load_explicit(&pool->ending, memory_order_relaxed))
            return false;
        relax();
    }
    pthread_mutex_lock(&pool->lock);
    /* counted before the last look, as the caller looks for sleepers after it has made the ticket: one
     * of the two sees the other */
    atomic_fetch_add(&pool->sleepers, 1);
    while (!has_chunks(pool) && !atomic_load(&pool->ending))
        pthread_cond_wait(&pool->wake, &pool->lock);
    atomic_fetch_sub(&pool->sleepers, 1);
    pthread_mutex_unlock(&pool->lock);
    return !atomic_load(&pool->ending);
}

static void *work(void *argument)
{
    struct worker *worker = argument;
    tl_pool *pool = worker->pool;
    while (await_loop(pool)) {
        if (do_chunks(pool, worker->number) && atomic_load(&pool->caller_sleeps)) {
            pthread_mutex_lock(&pool->lock);
            pthread_cond_signal(&pool->done);
            pthread_mutex_unlock(&pool->lock);
        }
    }
    return NULL;
}

static void wake_sleepers(tl_pool *pool)
{
    if (atomic_load(&pool->sleepers) == 0)
        return;
    pthread_mutex_lock(&pool->lock);
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
}

tl_pool *tl_pool_create(unsigned threads)
{
    tl_pool *pool = aligned_alloc(APART, sizeof *pool);
    struct worker *workers = calloc(threads, sizeof *workers);
    if (!pool || !workers) {
        free(pool);
        free(workers);
        return NULL;
    }
    *pool = (tl_pool){.workers = workers, .threads = 1};
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
    wake_sleepers(pool);
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

/* Waits until all chunks are done that other threads have taken. */
static void await_chunks(tl_pool *pool)
{
    for (int look = 0; look < SPIN_LOOKS; look++) {
        if (atomic_load(&pool->unfinished) == 0)
            return;
        relax();
    }
    pthread_mutex_lock(&pool->lock);
    atomic_store(&pool->caller_sleeps, true);
    while (atomic_load(&pool->unfinished) != 0)
        pthread_cond_wait(&pool->done, &pool->lock);
    atomic_store(&pool->caller_sleeps, false);
    pthread_mutex_unlock(&pool->lock);
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
    if (pool->threads == 1 || pool->chunks == 1) {
        for (size_t i = 0; i < pool->chunks; i++)
            do_chunk(pool, i, 0);
        return;
    }
    atomic_store(&pool->unfinished, pool->chunks);
    uint64_t loop = (atomic_load(&pool->ticket) & ~(uint64_t)LEFT_MASK) + LOOP_UNIT;
    atomic_store(&pool->ticket, loop + pool->chunks);
    wake_sleepers(pool);
    if (!do_chunks(pool, 0))
        await_chunks(pool);
}
