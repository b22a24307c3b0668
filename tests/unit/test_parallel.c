/* Every chunk of a loop is done once, whole, and before the loop returns, on any number of threads: also when
 * loops are tiny, when there are more threads than processors, and when the workers had gone to sleep. */
#include "base/parallel.h"
#include "check.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define MOST 5000

typedef struct record {
    unsigned char done[MOST];
    size_t count, chunk;
    unsigned threads;
    double *sums;
    atomic_uint wrong;
} record;

static void do_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    record *r = user;
    size_t whole = begin + r->chunk;
    if (begin != chunk * r->chunk || end != (whole < r->count ? whole : r->count) || thread >= r->threads)
        atomic_fetch_add(&r->wrong, 1);
    double sum = 0;
    for (size_t i = begin; i < end; i++) {
        r->done[i]++;
        sum += 1 / (1 + (double)i);
    }
    r->sums[chunk] = sum;
}

/* One loop; the sum over its chunks in their order. */
static double run_loop(tl_pool *pool, record *r, size_t count, size_t chunk)
{
    memset(r->done, 0, sizeof r->done);
    r->count = count;
    r->chunk = chunk;
    tl_parallel_for(pool, count, chunk, do_range, r);
    for (size_t i = 0; i < MOST; i++)
        if (r->done[i] != (i < count))
            atomic_fetch_add(&r->wrong, 1);
    double sum = 0;
    for (size_t i = 0; i * chunk < count; i++)
        sum += r->sums[i];
    return sum;
}

static const unsigned threads[] = {1, 2, 3, 5, 8, 16};
#define THREADS (sizeof threads / sizeof *threads)

TEST(every_chunk_is_done_once)
{
    static const size_t counts[] = {0, 1, 7, 8, 9, 64, 1000, MOST}, chunks[] = {1, 8, 64, MOST};
    static double sums[MOST];
    for (size_t t = 0; t < THREADS; t++) {
        tl_pool *pool = tl_pool_create(threads[t]);
        static record r;
        r = (record){.threads = threads[t], .sums = sums};
        CHECK(pool != NULL && tl_pool_threads(pool) == threads[t]);
        for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
            for (size_t k = 0; k < sizeof chunks / sizeof *chunks; k++)
                run_loop(pool, &r, counts[i], chunks[k]);
        CHECK_INT(atomic_load(&r.wrong), 0);
        tl_pool_destroy(pool);
    }
}

/* A worker that is late for one loop must not take anything of it into the next. */
TEST(loops_that_follow_each_other_do_not_mix)
{
    static double sums[MOST];
    double expected[40] = {0};
    for (size_t t = 0; t < THREADS; t++) {
        tl_pool *pool = tl_pool_create(threads[t]);
        static record r;
        r = (record){.threads = threads[t], .sums = sums};
        unsigned differ = 0;
        for (size_t loop = 0; loop < 4000; loop++) {
            double sum = run_loop(pool, &r, 1 + 37 * (loop % 40), 1 + loop % 40 % 7);
            if (t == 0)
                expected[loop % 40] = sum;
            differ += sum != expected[loop % 40];
        }
        CHECK_INT(atomic_load(&r.wrong), 0);
        CHECK_INT(differ, 0);
        tl_pool_destroy(pool);
    }
}

TEST(workers_that_sleep_are_woken)
{
    static double sums[MOST];
    const struct timespec nap = {.tv_nsec = 1000000}; /* far longer than a worker spins */
    tl_pool *pool = tl_pool_create(3);
    static record r;
    r = (record){.threads = 3, .sums = sums};
    for (int i = 0; i < 50; i++) {
        nanosleep(&nap, NULL);
        run_loop(pool, &r, 1000, 10);
    }
    CHECK_INT(atomic_load(&r.wrong), 0);
    nanosleep(&nap, NULL);
    tl_pool_destroy(pool); /* which wakes them, too */
}

static void sleep_in_second(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)end;
    (void)thread;
    const struct timespec nap = {.tv_nsec = 2000000};
    if (chunk % 2 == 1)
        nanosleep(&nap, NULL);
    ((unsigned char *)user)[begin] = 1;
}

TEST(the_caller_waits_for_a_slow_worker)
{
    tl_pool *pool = tl_pool_create(2);
    for (int i = 0; i < 20; i++) {
        unsigned char done[4] = {0};
        tl_parallel_for(pool, 4, 1, sleep_in_second, done);
        CHECK(done[0] && done[1] && done[2] && done[3]);
    }
    tl_pool_destroy(pool);
}

TEST_MAIN(RUN(every_chunk_is_done_once), RUN(loops_that_follow_each_other_do_not_mix),
          RUN(workers_that_sleep_are_woken), RUN(the_caller_waits_for_a_slow_worker))
