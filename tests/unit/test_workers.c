/* test_workers.c - processes that work: answers of any size in any order, deaths and new starts, ends of both sides, and the file
 * that one process writes. */
#include "base/parallel.h"
#include "check.h"

#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdbool.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <talus/log_file.h>
#include <talus/workers.h>
#include <unistd.h>

#define PATH TALUS_TEST_TMP "/workers.txt"

static char big[3 << 20];

/* Job n < 1000: n bytes. 1000: the process kills itself. 1001: it ends with status 7. 1002: three megabytes. 1003: a count of its own. */
static void work(void *user, uint64_t job, const void **data, size_t *size)
{
    static uint64_t count;
    count++;
    (void)user;
    if (job == 1000)
        kill(getpid(), SIGKILL);
    if (job == 1001)
        _exit(7);
    memset(big, (int)('a' + job % 26), sizeof big);
    *data = job == 1003 ? (const void *)&count : big;
    *size = job == 1003 ? sizeof count : job == 1002 ? sizeof big : (size_t)job;
}

static tl_worker_answer take(tl_workers *w)
{
    tl_worker_answer answer;
    tl_error error;
    do
        CHECK_INT(tl_workers_take(w, 10, &answer, &error), TL_OK);
    while (answer.worker == UINT_MAX);
    return answer;
}

static tl_workers *start(unsigned count)
{
    tl_error error;
    tl_workers *w = NULL;
    CHECK_INT(tl_workers_start(count, work, NULL, &w, &error), TL_OK);
    return w;
}

TEST(every_job_is_answered_once)
{
    tl_error error;
    tl_workers *w = start(3);
    static unsigned char answered[500];
    uint64_t next = 0;
    for (unsigned i = 0; i < 3; i++)
        CHECK_INT(tl_workers_give(w, i, next++, &error), TL_OK);
    for (int taken = 0; taken < 500; taken++) {
        tl_worker_answer a = take(w);
        bool right = a.data && a.size == a.job && a.job < 500;
        for (size_t i = 0; right && i < a.size; i++)
            right = ((const char *)a.data)[i] == (char)('a' + a.job % 26);
        CHECK(right && !answered[a.job]++);
        if (next < 500)
            CHECK_INT(tl_workers_give(w, a.worker, next++, &error), TL_OK);
    }
    CHECK_INT(tl_workers_give(w, 1, 1002, &error), TL_OK);
    tl_worker_answer a = take(w);
    CHECK(a.size == sizeof big && memcmp(a.data, big, sizeof big) != 0 &&
          ((const char *)a.data)[sizeof big - 1] == 'o');
    tl_workers_end(w);
}

TEST(a_worker_that_dies_is_started_anew)
{
    tl_error error;
    tl_workers *w = start(2);
    for (int time = 0; time < 3; time++) {
        CHECK_INT(tl_workers_give(w, 0, 1000, &error), TL_OK);
        tl_worker_answer a = take(w);
        CHECK(!a.data && a.worker == 0 && a.job == 1000 && a.signal == SIGKILL);
        CHECK_INT(tl_workers_give(w, 0, 1001, &error), TL_OK);
        a = take(w);
        CHECK(!a.data && a.signal == 0 && a.code == 7);
    }
    CHECK_INT(tl_workers_give(w, 0, 1003, &error), TL_OK);
    tl_worker_answer a = take(w);
    uint64_t count = 0;
    memcpy(&count, a.data, a.size == sizeof count ? sizeof count : 0);
    CHECK_INT(count, 1); /* a new copy of this process, which has done nothing */
    tl_workers_end(w);
}

TEST(starts_are_refused)
{
    tl_error error;
    tl_workers *w;
    CHECK_INT(tl_workers_start(0, work, NULL, &w, &error), TL_E_ARGUMENT);
    CHECK_TEXT(error.text, "workers = 0 is outside [1, 256]");
    tl_pool *pool = tl_pool_create(3);
    CHECK_INT(tl_workers_start(2, work, NULL, &w, &error), TL_E_STATE);
    CHECK_CONTAINS(error.text, "2 other threads run");
    CHECK(w == NULL);
    tl_pool_destroy(pool);
    tl_workers_end(start(2));
}

/* A process with two workers at work is killed: both end, one in the middle of its job. */
static void wait_for_ever(void *user, uint64_t job, const void **data, size_t *size)
{
    (void)data;
    (void)size;
    const pid_t own = getpid();
    if (write(*(int *)user, &own, sizeof own) == sizeof own && job == 1)
        for (;;)
            pause();
}

TEST(workers_end_with_their_process)
{
    int ends[2];
    CHECK(pipe(ends) == 0);
    const pid_t parent = fork();
    if (parent == 0) {
        tl_error error;
        tl_workers *w;
        close(ends[0]);
        if (tl_workers_start(2, wait_for_ever, &ends[1], &w, &error) == TL_OK)
            for (unsigned i = 0; i < 2; i++)
                tl_workers_give(w, i, i, &error);
        for (;;)
            pause();
    }
    close(ends[1]);
    pid_t worker[2];
    CHECK_INT(read(ends[0], &worker[0], sizeof worker[0]), sizeof worker[0]);
    CHECK_INT(read(ends[0], &worker[1], sizeof worker[1]), sizeof worker[1]);
    kill(parent, SIGKILL);
    waitpid(parent, NULL, 0);
    char rest;
    CHECK_INT(read(ends[0], &rest, 1), 0); /* waits until the last process that has the other end has ended */
    close(ends[0]);
}

static size_t size_of(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 ? (size_t)info.st_size : SIZE_MAX;
}

TEST(one_process_writes_a_log)
{
    tl_error error;
    tl_log_file *file, *other;
    remove(PATH);
    CHECK_INT(tl_log_open(PATH, &file, &error), TL_OK);
    CHECK_INT(tl_log_add(file, "one\ntwo\n", 8, &error), TL_OK);
    CHECK_INT(tl_log_cut(file, 4, &error), TL_OK);
    CHECK_INT(tl_log_add(file, "three\n", 6, &error), TL_OK);
    CHECK_INT(size_of(PATH), 10);
    char *data;
    size_t size;
    CHECK_INT(tl_log_read(file, &data, &size, &error), TL_OK);
    CHECK(size == 10 && memcmp(data, "one\nthree\n", 11) == 0);
    free(data);
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) /* the lock is not inherited */
        _exit(tl_log_open(PATH, &other, &error) == TL_E_STATE && strstr(error.text, "another process writes") ? 0 : 1);
    int status;
    waitpid(child, &status, 0);
    CHECK_INT(status, 0);
    tl_log_close(file);
    CHECK_INT(tl_log_open(PATH, &file, &error), TL_OK);
    tl_log_close(file);
    CHECK_INT(tl_log_open(TALUS_TEST_TMP, &file, &error), TL_E_IO);
    CHECK_INT(tl_log_open("/dev/null", &file, &error), TL_E_IO);
    CHECK_CONTAINS(error.text, "no regular file");
    CHECK(file == NULL);
}

TEST_MAIN(RUN(every_job_is_answered_once), RUN(a_worker_that_dies_is_started_anew), RUN(starts_are_refused),
          RUN(workers_end_with_their_process), RUN(one_process_writes_a_log))
