/* parallel.c - see parallel.h.
 *
 * The loops of a step follow each other within microseconds, so none may cost a system call. Threads that wait spin
 * for a while, and sleep only when nothing has come by then. Whoever has something for a sleeper wakes it.
 *
 * Each thread has its part of the chunks, the same part of every loop. So what it works on stays in its cache. When
 * it is through it takes what others have left. A chunk is taken by counting down a ticket,
 * which holds the number of the loop, too. A thread may come late, from a loop that is over. It finds nothing on the
 * ticket, or takes a chunk of the new loop, never one of the old. So a loop ends as soon as its chunks are done,
 * whether or not all threads have seen it. Where there are more threads than processors, nobody waits for one that
 * does not run. What describes a loop does not change while a chunk of it is out. */
#define _XOPEN_SOURCE 700 /* sigaltstack */
#include "base/parallel.h"

#include "base/error.h"
#include "base/inside.h"
#include "base/signals.h"

#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>

/* How many looks a waiting thread takes before it sleeps. They take some 50 microseconds, as sleep and waking do. */
#define SPIN_LOOKS 1000

/* Bytes apart at which two threads do not disturb each other's memory: two cache lines, which
 * processors fetch in pairs. */
#define APART 128

/* Low half of a ticket: chunks that are left; high half: the loop. */
#define LEFT_MASK 0xffffffffu
#define LOOP_UNIT ((uint64_t)1 << 32)

struct worker {
    _Alignas(APART) _Atomic uint64_t ticket; /* for the thread's part */
    tl_pool *pool;
    unsigned number;
    pthread_t thread;
};

struct tl_pool {
    unsigned threads;
    struct worker *workers; /* the caller is number 0 */
    pthread_mutex_t lock;
    pthread_cond_t wake, done;
    atomic_uint sleepers;      /* workers that wait for `wake` */
    atomic_bool caller_sleeps; /* and the caller for `done` */
    atomic_bool ending;
    /* the loop; written while no chunk is out */
    unsigned parts; /* among as many threads */
    uint64_t loop;
    size_t count, chunk, chunks;
    tl_range_fn fn;
    void *user;
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

/* The first chunk of a thread's part. */
static size_t part_begin(const tl_pool *pool, unsigned part)
{
    return pool->chunks * part / pool->parts;
}

static bool has_chunks(struct worker *of)
{
    return atomic_load(&of->ticket) & LEFT_MASK;
}

/* Takes a chunk of a thread's part; false when none is left. */
static bool take_chunk(struct worker *of, size_t *chunk)
{
    uint64_t ticket = atomic_load(&of->ticket);
    while (ticket & LEFT_MASK)
        if (atomic_compare_exchange_weak(&of->ticket, &ticket, ticket - 1)) {
            *chunk = part_begin(of->pool, of->number + 1) - (size_t)(ticket & LEFT_MASK);
            return true;
        }
    return false;
}

static void do_chunk(tl_pool *pool, size_t chunk, unsigned thread)
{
    size_t begin = chunk * pool->chunk, end = begin + pool->chunk;
    pool->fn(pool->user, begin, end < pool->count ? end : pool->count, chunk, thread);
}

/* Works until no chunk is left; returns true when the loop ended with what was done here. */
static bool do_chunks(tl_pool *pool, unsigned thread)
{
    size_t chunk, done = 0;
    for (unsigned k = 0; k < pool->threads; k++) {
        struct worker *of = &pool->workers[(thread + k) % pool->threads];
        for (; take_chunk(of, &chunk); done++)
            do_chunk(pool, chunk, thread);
    }
    return done > 0 && atomic_fetch_sub(&pool->unfinished, done) == done;
}

/* Waits for a loop with a part for this thread; false at the end of the pool. */
static bool await_loop(tl_pool *pool, struct worker *self)
{
    for (int look = 0; look < SPIN_LOOKS; look++) {
        if (has_chunks(self))
            return true;
        if (atomic_load_explicit(&pool->ending, memory_order_relaxed))
            return false;
        relax();
    }
    pthread_mutex_lock(&pool->lock);
    /* counted before the last look, as the caller looks for sleepers after it has made the tickets: one
     * of the two sees the other */
    atomic_fetch_add(&pool->sleepers, 1);
    while (!has_chunks(self) && !atomic_load(&pool->ending))
        pthread_cond_wait(&pool->wake, &pool->lock);
    atomic_fetch_sub(&pool->sleepers, 1);
    pthread_mutex_unlock(&pool->lock);
    return !atomic_load(&pool->ending);
}

static void *work(void *argument)
{
    struct worker *worker = argument;
    tl_pool *pool = worker->pool;
    /* for a handler of signals that asks for another stack, should a law use up this one */
    char spare[TL_SIGNAL_STACK];
    stack_t own = {.ss_sp = spare, .ss_size = sizeof spare}, before;
    bool placed = sigaltstack(&own, &before) == 0;
    while (await_loop(pool, worker)) {
        if (do_chunks(pool, worker->number) && atomic_load(&pool->caller_sleeps)) {
            pthread_mutex_lock(&pool->lock);
            pthread_cond_signal(&pool->done);
            pthread_mutex_unlock(&pool->lock);
        }
    }
    if (placed)
        sigaltstack(&before, NULL);
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

/* Ends a pool of which `started` threads run, the caller counted. */
static void end_pool(tl_pool *pool, unsigned started)
{
    atomic_store(&pool->ending, true);
    wake_sleepers(pool);
    for (unsigned i = 1; i < started; i++)
        pthread_join(pool->workers[i].thread, NULL);
    pthread_mutex_destroy(&pool->lock);
    pthread_cond_destroy(&pool->wake);
    pthread_cond_destroy(&pool->done);
    free(pool->workers);
    free(pool);
}

/* Starts the workers with the signals that end a program blocked: the thread that calls the library takes them, when
 * it is ready to (io/output_file.c). Returns how many threads run, the caller counted. */
static unsigned start_workers(tl_pool *pool)
{
    sigset_t before;
    tl_signals_hold(&before, true);
    unsigned started = 1;
    while (started < pool->threads &&
           pthread_create(&pool->workers[started].thread, NULL, work, &pool->workers[started]) == 0)
        started++;
    tl_signals_release(&before);
    return started;
}

tl_pool *tl_pool_create(unsigned threads)
{
    tl_pool *pool = aligned_alloc(APART, sizeof *pool);
    struct worker *workers = aligned_alloc(APART, threads * sizeof *workers);
    if (!pool || !workers) {
        free(pool);
        free(workers);
        return NULL;
    }
    *pool = (tl_pool){.workers = workers, .threads = threads};
    for (unsigned i = 0; i < threads; i++)
        workers[i] = (struct worker){.pool = pool, .number = i};
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pthread_cond_init(&pool->done, NULL);
    unsigned started = start_workers(pool);
    if (started == threads)
        return pool;
    end_pool(pool, started);
    return NULL;
}

void tl_pool_destroy(tl_pool *pool)
{
    if (pool)
        end_pool(pool, pool->threads);
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
    pool->parts = pool->chunks < pool->threads ? (unsigned)pool->chunks : pool->threads;
    pool->loop += LOOP_UNIT;
    atomic_store(&pool->unfinished, pool->chunks);
    for (unsigned i = 0; i < pool->parts; i++)
        atomic_store(&pool->workers[i].ticket, pool->loop + part_begin(pool, i + 1) - part_begin(pool, i));
    wake_sleepers(pool);
    if (!do_chunks(pool, 0))
        await_chunks(pool);
}

/* ---------------------------------------------------------------- failures that count -----
 *
 * Of several failures in a parallel phase, the one of the lowest chunk counts, whichever thread meets it. */

void tl_failure_note(tl_failure *f, size_t chunk, tl_status status, size_t point, const char *text)
{
    pthread_mutex_lock(&f->lock);
    if (f->error.status == TL_OK || chunk < f->chunk) {
        f->chunk = chunk;
        f->point = point;
        tl_fail(&f->error, status, "%s", text);
    }
    pthread_mutex_unlock(&f->lock);
}
