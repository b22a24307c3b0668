/* talus/workers.h - processes that work for this one: each is a copy of it, made by fork, and does jobs by numbers.
 *
 *     tl_workers_start(4, work, user, &workers, &error);
 *     for each worker w: tl_workers_give(workers, w, next++, &error);
 *     while (open jobs) { tl_workers_take(workers, 0.2, &answer, &error); use(answer); give the worker its next job; }
 *     tl_workers_end(workers);
 *
 * A worker has all that this process had when it was started, and what it changes is its own. So a job is to hang on
 * its number only; then the answers are the same for any number of workers. A worker that has died is started anew
 * when it gets its next job. Workers end with this process, however that ends.
 *
 * A copy has one thread only. So start refuses a process with several: what they hold would be held for ever. */
#ifndef TALUS_WORKERS_H
#define TALUS_WORKERS_H

#include <stdint.h>
#include <talus/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Limit: workers of one call. */
#define TL_MOST_WORKERS 256

typedef struct tl_workers tl_workers;

/* Does a job in a worker: its answer is `*size` bytes at `*data`, valid until the next call. It never returns to the
 * program's code: leave by return or by an end of the process, which counts as a death. */
typedef void (*tl_worker_fn)(void *user, uint64_t job, const void **data, size_t *size);

typedef struct tl_worker_answer {
    unsigned worker; /* from 0 */
    uint64_t job;
    const void *data; /* valid until the worker gets its next job; NULL: it died */
    size_t size;
    int signal; /* by which it died; 0: it ended by itself, with the status `code` */
    int code;
} tl_worker_answer;

/* Starts `count` workers in [1, TL_MOST_WORKERS]. Text that waits for its output is written first. TL_E_STATE when
 * other threads run in this process: of a model with several threads, or of a screen. */
TL_API tl_status tl_workers_start(unsigned count, tl_worker_fn work, void *user, tl_workers **workers, tl_error *error);
/* Gives an idle worker a job; one that has died is started anew. */
TL_API tl_status tl_workers_give(tl_workers *workers, unsigned worker, uint64_t job, tl_error *error);
/* Waits for the next answer, or death, of any worker, `seconds` at the most. answer->worker is UINT_MAX when there was
 * none in time, or a signal came. */
TL_API tl_status tl_workers_take(tl_workers *workers, double seconds, tl_worker_answer *answer, tl_error *error);
/* Ends all workers at once, and frees; NULL is left alone. */
TL_API void tl_workers_end(tl_workers *workers);

#ifdef __cplusplus
}
#endif
#endif
