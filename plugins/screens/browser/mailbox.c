/* mailbox.c - frames and commands between the thread of the model and the thread of the server. */
#include "mailbox.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* s; longer waits are cut to this. */
#define LONGEST_WAIT 1e6

/* Bytes that do not change any more. Who drops the last count frees them. */
struct piece {
    atomic_size_t holders;
    size_t length;
    unsigned char bytes[];
};

typedef struct command {
    size_t length;
    char text[TL_SCREEN_COMMAND];
} command;

struct mailbox {
    pthread_mutex_t lock;
    pthread_cond_t told; /* a command, or somebody who begins to look */
    atomic_uint watching, waiting;
    /* What follows is read under the lock, and written under it. Frames are written by `put` alone, which therefore
     * reads them without it. */
    piece **news; /* since the last beginning */
    size_t news_count, news_capacity;
    piece *now;
    uint64_t epoch, puts;
    command queue[MAILBOX_COMMANDS];
    size_t first;
    uint64_t arrived, arrivals_told; /* watchers that have joined; those that `take` knows of */
};

static piece *piece_of(const void *bytes, size_t length)
{
    if (length > SIZE_MAX - sizeof(piece))
        return NULL;
    piece *p = malloc(sizeof *p + length);
    if (!p)
        return NULL;
    atomic_init(&p->holders, 1);
    p->length = length;
    if (length > 0)
        memcpy(p->bytes, bytes, length);
    return p;
}

static piece *hold(piece *p)
{
    atomic_fetch_add_explicit(&p->holders, 1, memory_order_relaxed);
    return p;
}

static void drop(piece *p)
{
    if (p && atomic_fetch_sub_explicit(&p->holders, 1, memory_order_acq_rel) == 1)
        free(p);
}

static void drop_all(piece **pieces, size_t count)
{
    for (size_t i = 0; i < count; i++)
        drop(pieces[i]);
    free(pieces);
}

mailbox *mailbox_create(void)
{
    mailbox *m = calloc(1, sizeof *m);
    pthread_condattr_t clock;
    if (!m || pthread_condattr_init(&clock) != 0) {
        free(m);
        return NULL;
    }
    pthread_condattr_setclock(&clock, CLOCK_MONOTONIC);
    pthread_mutex_init(&m->lock, NULL);
    pthread_cond_init(&m->told, &clock);
    pthread_condattr_destroy(&clock);
    return m;
}

void mailbox_destroy(mailbox *m)
{
    if (!m)
        return;
    drop_all(m->news, m->news_count);
    drop(m->now);
    pthread_cond_destroy(&m->told);
    pthread_mutex_destroy(&m->lock);
    free(m);
}

/* ---------------------------------------------------------------- frames ----------------- */

bool mailbox_put(mailbox *m, const tl_screen_frame *frame)
{
    bool begin = frame->begin || m->puts == 0;
    size_t kept = begin ? 0 : m->news_count, added = frame->news_length > 0;
    size_t capacity = begin ? 8 : m->news_capacity;
    while (capacity < kept + added)
        capacity *= 2;
    bool grows = begin || capacity > m->news_capacity;
    piece *now = piece_of(frame->now, frame->now_length);
    piece *fresh = added ? piece_of(frame->news, frame->news_length) : NULL;
    piece **list = grows ? malloc(capacity * sizeof *list) : m->news;
    if (!now || (added && !fresh) || !list) {
        drop(now);
        drop(fresh);
        if (grows)
            free(list);
        return false;
    }
    if (grows && kept > 0)
        memcpy(list, m->news, kept * sizeof *list);
    piece **old_list = m->news, *old_now = m->now;
    size_t old_count = m->news_count;

    pthread_mutex_lock(&m->lock);
    if (added)
        list[kept] = fresh;
    m->news = list;
    m->news_count = kept + added;
    m->news_capacity = capacity;
    m->now = now;
    m->epoch += begin;
    m->puts++;
    pthread_mutex_unlock(&m->lock);

    drop(old_now);
    if (begin)
        drop_all(old_list, old_count);
    else if (grows)
        free(old_list);
    return true;
}

/* Makes the newest frame the one on its way to the watcher. 1: done; 0: it has got that; -1: no memory. */
static int next_frame(mailbox *m, watcher *w)
{
    for (;;) {
        pthread_mutex_lock(&m->lock);
        if (w->put == m->puts) {
            pthread_mutex_unlock(&m->lock);
            return 0;
        }
        size_t from = w->epoch == m->epoch ? w->news : 0, needed = m->news_count - from + 1;
        if (needed <= w->capacity) {
            w->count = w->at = w->offset = 0;
            for (size_t i = from; i < m->news_count; i++)
                w->pieces[w->count++] = hold(m->news[i]);
            w->pieces[w->count++] = hold(m->now);
            w->epoch = m->epoch;
            w->news = m->news_count;
            w->put = m->puts;
            pthread_mutex_unlock(&m->lock);
            return 1;
        }
        pthread_mutex_unlock(&m->lock);
        free(w->pieces); /* nothing is on its way */
        w->capacity = 0;
        w->pieces = malloc(2 * needed * sizeof *w->pieces);
        if (!w->pieces)
            return -1;
        w->capacity = 2 * needed;
    }
}

ptrdiff_t mailbox_read(mailbox *m, watcher *w, void *to, size_t room)
{
    size_t given = 0;
    while (given == 0) {
        while (w->at < w->count && given < room) {
            const piece *p = w->pieces[w->at];
            size_t left = p->length - w->offset, part = left < room - given ? left : room - given;
            memcpy((char *)to + given, p->bytes + w->offset, part);
            given += part;
            w->offset += part;
            if (w->offset == p->length) {
                drop(w->pieces[w->at++]);
                w->offset = 0;
            }
        }
        if (given > 0 || room == 0)
            break;
        int more = next_frame(m, w);
        if (more <= 0)
            return more;
    }
    return (ptrdiff_t)given;
}

bool mailbox_behind(mailbox *m, const watcher *w)
{
    pthread_mutex_lock(&m->lock);
    bool behind = w->at < w->count || w->put != m->puts;
    pthread_mutex_unlock(&m->lock);
    return behind;
}

/* ---------------------------------------------------------------- watchers --------------- */

uint32_t mailbox_watchers(const mailbox *m)
{
    return atomic_load_explicit(&m->watching, memory_order_relaxed);
}

void mailbox_join(mailbox *m, watcher *w)
{
    *w = (watcher){0};
    pthread_mutex_lock(&m->lock);
    atomic_fetch_add_explicit(&m->watching, 1, memory_order_relaxed);
    m->arrived++;
    pthread_cond_signal(&m->told);
    pthread_mutex_unlock(&m->lock);
}

void mailbox_leave(mailbox *m, watcher *w)
{
    while (w->at < w->count)
        drop(w->pieces[w->at++]);
    free(w->pieces);
    *w = (watcher){0};
    atomic_fetch_sub_explicit(&m->watching, 1, memory_order_relaxed);
}

/* ---------------------------------------------------------------- commands --------------- */

bool mailbox_post(mailbox *m, const char *text, size_t length)
{
    pthread_mutex_lock(&m->lock);
    unsigned waiting = atomic_load_explicit(&m->waiting, memory_order_relaxed);
    bool room = waiting < MAILBOX_COMMANDS && length < TL_SCREEN_COMMAND;
    if (room) {
        command *c = &m->queue[(m->first + waiting) % MAILBOX_COMMANDS];
        memcpy(c->text, text, length);
        c->length = length;
        atomic_store_explicit(&m->waiting, waiting + 1, memory_order_relaxed);
        pthread_cond_signal(&m->told);
    }
    pthread_mutex_unlock(&m->lock);
    return room;
}

/* The time of the monotonic clock `seconds` from now. */
static struct timespec time_after(double seconds)
{
    struct timespec at;
    clock_gettime(CLOCK_MONOTONIC, &at);
    double wait = seconds < LONGEST_WAIT ? seconds : LONGEST_WAIT;
    at.tv_sec += (time_t)wait;
    at.tv_nsec += (long)((wait - (double)(time_t)wait) * 1e9);
    if (at.tv_nsec >= 1000000000) {
        at.tv_sec++;
        at.tv_nsec -= 1000000000;
    }
    return at;
}

/* Waits for a command or a watcher that `take` does not know of yet; the lock is held. */
static void wait_for_news(mailbox *m, double seconds)
{
    const struct timespec until = time_after(seconds);
    int timed_out = 0;
    while (atomic_load_explicit(&m->waiting, memory_order_relaxed) == 0 && m->arrived == m->arrivals_told && !timed_out)
        timed_out = pthread_cond_timedwait(&m->told, &m->lock, &until);
    m->arrivals_told = m->arrived;
}

int mailbox_take(mailbox *m, char *text, size_t room, double seconds)
{
    bool waits = seconds > 0;
    if (!waits && atomic_load_explicit(&m->waiting, memory_order_relaxed) == 0)
        return 0;
    int taken = 0;
    pthread_mutex_lock(&m->lock);
    if (waits && atomic_load_explicit(&m->waiting, memory_order_relaxed) == 0)
        wait_for_news(m, seconds);
    unsigned waiting = atomic_load_explicit(&m->waiting, memory_order_relaxed);
    const command *c = &m->queue[m->first];
    if (waiting > 0 && c->length < room) {
        memcpy(text, c->text, c->length);
        text[c->length] = '\0';
        m->first = (m->first + 1) % MAILBOX_COMMANDS;
        atomic_store_explicit(&m->waiting, waiting - 1, memory_order_relaxed);
        taken = 1;
    }
    pthread_mutex_unlock(&m->lock);
    return taken;
}
