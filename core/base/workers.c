/* workers.c - processes that work for this one, made by fork.
 *
 * Each has a pair of sockets with this process. A job is its number, 8 bytes. An answer is its size, 8 bytes, and the
 * bytes. The end of a worker closes its socket, which is seen as its death. A worker ends when its socket is closed. On
 * Linux the system ends it as well when this process has ended. */
#include "base/error.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <talus/workers.h>
#include <time.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

/* Limit: bytes of an answer. */
#define MOST_BYTES ((uint64_t)1 << 30)
/* Limit: seconds of one wait. */
#define MOST_SECONDS 1e6
/* Constant: bytes of the size in front of an answer. */
#define HEAD sizeof(uint64_t)
/* Cost only: how often threads that end are looked for once more, and after how many nanoseconds. */
#define MOMENTS 100
#define MOMENT 1000000

/* Constant: threads of a process that has started none. The thread sanitizer has one of its own. */
#define OWN_THREADS 1
#if defined(__SANITIZE_THREAD__)
#undef OWN_THREADS
#define OWN_THREADS 2
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#undef OWN_THREADS
#define OWN_THREADS 2
#endif
#endif

typedef struct worker {
    pid_t process; /* 0: there is none */
    int socket;    /* -1: there is none */
    bool busy;
    uint64_t job;
    char *buffer; /* the size and what has come of the answer */
    size_t length, capacity;
} worker;

struct tl_workers {
    tl_worker_fn work;
    void *user;
    unsigned count;
    worker of[];
};

/* ---------------------------------------------------------------- in a worker ------------ */

/* Sends or receives all bytes; false at the end of the socket. */
static bool send_all(int socket, const void *data, size_t size)
{
    const char *at = data;
    while (size > 0) {
        const ssize_t sent = send(socket, at, size, MSG_NOSIGNAL);
        if (sent < 0 && errno != EINTR)
            return false;
        at += sent > 0 ? sent : 0;
        size -= sent > 0 ? (size_t)sent : 0;
    }
    return true;
}

static bool receive_all(int socket, void *data, size_t size)
{
    char *at = data;
    while (size > 0) {
        const ssize_t got = recv(socket, at, size, 0);
        if (got == 0 || (got < 0 && errno != EINTR))
            return false;
        at += got > 0 ? got : 0;
        size -= got > 0 ? (size_t)got : 0;
    }
    return true;
}

/* What a worker does until its socket ends. Ctrl-C is for the process that it works for. */
static _Noreturn void work_until_end(const tl_workers *w, int socket, pid_t parent)
{
    signal(SIGINT, SIG_IGN);
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    for (unsigned i = 0; i < w->count; i++)
        if (w->of[i].socket >= 0)
            close(w->of[i].socket);
    uint64_t job;
    while (getppid() == parent && receive_all(socket, &job, sizeof job)) {
        const void *data = NULL;
        size_t size = 0;
        w->work(w->user, job, &data, &size);
        fflush(NULL);
        const uint64_t head = size;
        if (!send_all(socket, &head, sizeof head) || !send_all(socket, data, size))
            break;
    }
    _exit(EXIT_SUCCESS);
}

/* ---------------------------------------------------------------- for workers ------------ */

/* The threads of this process, where the system tells; else OWN_THREADS. */
static unsigned count_threads(void)
{
    DIR *tasks = opendir("/proc/self/task");
    unsigned count = 0;
    for (struct dirent *entry; tasks && (entry = readdir(tasks));)
        count += entry->d_name[0] != '.';
    if (tasks)
        closedir(tasks);
    return count > 0 ? count : OWN_THREADS;
}

/* The same once threads that end have gone: the system lists one for a moment after it was waited for. */
static unsigned count_lasting_threads(void)
{
    const struct timespec moment = {.tv_nsec = MOMENT};
    unsigned threads = count_threads();
    for (int i = 0; threads > OWN_THREADS && i < MOMENTS; i++) {
        nanosleep(&moment, NULL);
        threads = count_threads();
    }
    return threads;
}

static tl_status fork_worker(tl_workers *w, unsigned index, tl_error *error)
{
    int pair[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, pair) != 0)
        return tl_fail(error, TL_E_IO, "worker %u cannot be started: %s", index + 1, strerror(errno));
    fcntl(pair[0], F_SETFD, FD_CLOEXEC);
    fcntl(pair[1], F_SETFD, FD_CLOEXEC);
    fflush(NULL); /* text that waits is written once */
    const pid_t parent = getpid(), process = fork();
    if (process == 0) {
        close(pair[0]);
        work_until_end(w, pair[1], parent);
    }
    const int code = errno;
    close(pair[1]);
    if (process < 0) {
        close(pair[0]);
        return tl_fail(error, TL_E_IO, "worker %u cannot be started: %s", index + 1, strerror(code));
    }
    worker *made = &w->of[index];
    made->process = process;
    made->socket = pair[0];
    made->length = 0;
    return TL_OK;
}

tl_status tl_workers_start(unsigned count, tl_worker_fn work, void *user, tl_workers **workers, tl_error *error)
{
    *workers = NULL;
    if (count < 1 || count > TL_MOST_WORKERS)
        return tl_fail(error, TL_E_ARGUMENT, "workers = %u is outside [1, %d]", count, TL_MOST_WORKERS);
    const unsigned threads = count_lasting_threads();
    if (threads > OWN_THREADS)
        return tl_fail(error, TL_E_STATE,
                       "%u other threads run, of a model with several threads or of a screen, and workers cannot be "
                       "started beside them: give models threads = 1 and close screens",
                       threads - OWN_THREADS);
    tl_workers *w = calloc(1, sizeof *w + count * sizeof *w->of);
    if (!w)
        return tl_fail_memory(error);
    *w = (tl_workers){.work = work, .user = user, .count = count};
    for (unsigned i = 0; i < count; i++)
        w->of[i].socket = -1;
    tl_status status = TL_OK;
    for (unsigned i = 0; i < count && status == TL_OK; i++)
        status = fork_worker(w, i, error);
    if (status == TL_OK)
        *workers = w;
    else
        tl_workers_end(w);
    return status;
}

/* Takes the end of a worker: its status. */
static int bury(worker *one)
{
    int status = 0;
    close(one->socket);
    while (waitpid(one->process, &status, 0) < 0 && errno == EINTR)
        ;
    one->socket = -1;
    one->process = 0;
    return status;
}

tl_status tl_workers_give(tl_workers *workers, unsigned index, uint64_t job, tl_error *error)
{
    worker *one = &workers->of[index];
    for (int attempt = 0; attempt < 2; attempt++) {
        tl_status status = one->socket < 0 ? fork_worker(workers, index, error) : TL_OK;
        if (status != TL_OK)
            return status;
        if (send_all(one->socket, &job, sizeof job)) {
            one->busy = true;
            one->job = job;
            one->length = 0;
            return TL_OK;
        }
        bury(one); /* it died while it was idle */
    }
    return tl_fail(error, TL_E_IO, "worker %u ends as soon as it is started", index + 1);
}

/* Bytes of a worker's answer with its head, as far as they are known. */
static size_t expected(const worker *one)
{
    uint64_t size = 0;
    if (one->length >= HEAD)
        memcpy(&size, one->buffer, HEAD);
    return HEAD + (size_t)size;
}

/* Reads what there is of an answer. *ended: the worker has died. */
static tl_status read_some(worker *one, bool *ended, tl_error *error)
{
    *ended = false;
    while (one->length < HEAD || one->length < expected(one)) {
        const size_t needed = expected(one);
        if (needed - HEAD > MOST_BYTES)
            return tl_fail(error, TL_E_STATE, "the answer to job %llu is larger than %llu bytes",
                           (unsigned long long)one->job, (unsigned long long)MOST_BYTES);
        if (one->capacity < needed) {
            char *more = realloc(one->buffer, needed);
            if (!more)
                return tl_fail_memory(error);
            one->buffer = more;
            one->capacity = needed;
        }
        const ssize_t got = recv(one->socket, one->buffer + one->length, needed - one->length, MSG_DONTWAIT);
        if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR))
            return TL_OK;
        *ended = got <= 0;
        if (*ended)
            return TL_OK;
        one->length += (size_t)got;
    }
    return TL_OK;
}

/* Takes what a worker has sent; its answer when that is whole, or its death. */
static tl_status hear(tl_workers *w, unsigned index, tl_worker_answer *answer, tl_error *error)
{
    worker *one = &w->of[index];
    bool ended;
    tl_status status = read_some(one, &ended, error);
    if (status != TL_OK || (!ended && (one->length < HEAD || one->length < expected(one))))
        return status;
    *answer = (tl_worker_answer){.worker = index, .job = one->job};
    one->busy = false;
    if (!ended) {
        answer->data = one->buffer + HEAD;
        answer->size = one->length - HEAD;
        return TL_OK;
    }
    const int end = bury(one);
    answer->signal = WIFSIGNALED(end) ? WTERMSIG(end) : 0;
    answer->code = WIFEXITED(end) ? WEXITSTATUS(end) : 0;
    return TL_OK;
}

tl_status tl_workers_take(tl_workers *workers, double seconds, tl_worker_answer *answer, tl_error *error)
{
    struct pollfd set[TL_MOST_WORKERS];
    unsigned index[TL_MOST_WORKERS];
    nfds_t count = 0;
    *answer = (tl_worker_answer){.worker = UINT_MAX};
    for (unsigned i = 0; i < workers->count; i++)
        if (workers->of[i].busy) {
            index[count] = i;
            set[count++] = (struct pollfd){.fd = workers->of[i].socket, .events = POLLIN};
        }
    const double wait = seconds < MOST_SECONDS ? seconds : MOST_SECONDS;
    const int ready = poll(set, count, (int)(1e3 * wait));
    if (ready < 0 && errno != EINTR && errno != EAGAIN)
        return tl_fail(error, TL_E_IO, "workers cannot be waited for: %s", strerror(errno));
    for (nfds_t i = 0; i < count && ready > 0 && answer->worker == UINT_MAX; i++)
        if (set[i].revents) {
            tl_status status = hear(workers, index[i], answer, error);
            if (status != TL_OK)
                return status;
        }
    return TL_OK;
}

void tl_workers_end(tl_workers *workers)
{
    if (!workers)
        return;
    for (unsigned i = 0; i < workers->count; i++)
        if (workers->of[i].process > 0)
            kill(workers->of[i].process, SIGKILL);
    for (unsigned i = 0; i < workers->count; i++) {
        if (workers->of[i].process > 0)
            bury(&workers->of[i]);
        free(workers->of[i].buffer);
    }
    free(workers);
}
