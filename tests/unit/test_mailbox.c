/* test_mailbox.c - frames and commands between threads, in the screen "browser". */
#include "mailbox.h"

#include "check.h"

#include <pthread.h>
#include <stdatomic.h>
#include <time.h>

static bool put(mailbox *m, bool begin, const char *news, const char *now)
{
    const tl_screen_frame frame = {.size = sizeof frame,
                                   .begin = begin,
                                   .news = news,
                                   .news_length = strlen(news),
                                   .now = now,
                                   .now_length = strlen(now)};
    return mailbox_put(m, &frame);
}

/* All there is for the watcher, read `step` bytes at a time, as a text. */
static const char *read_all(mailbox *m, watcher *w, size_t step)
{
    static char text[4096];
    size_t length = 0;
    for (;;) {
        ptrdiff_t given = mailbox_read(m, w, text + length, step);
        if (given <= 0 || length + (size_t)given + step >= sizeof text) {
            CHECK_INT(given, 0);
            break;
        }
        length += (size_t)given;
    }
    text[length] = '\0';
    return text;
}

/* ---------------------------------------------------------------- frames ----------------- */

TEST(a_watcher_gets_all_news_and_what_there_is_now)
{
    for (size_t step = 1; step < 20; step += 6) {
        mailbox *m = mailbox_create();
        watcher first, late;
        CHECK_INT(mailbox_watchers(m), 0);
        mailbox_join(m, &first);
        CHECK_INT(mailbox_watchers(m), 1);
        CHECK(!mailbox_behind(m, &first));
        CHECK_TEXT(read_all(m, &first, step), "");
        CHECK(put(m, true, "[blocks]", "(0)"));
        CHECK(mailbox_behind(m, &first));
        CHECK_TEXT(read_all(m, &first, step), "[blocks](0)");
        CHECK(!mailbox_behind(m, &first));
        CHECK(put(m, false, "", "(1)"));
        CHECK(put(m, false, "[cut]", "(2)"));
        CHECK(put(m, false, "", "(3)"));
        CHECK(put(m, false, "[gone]", "(4)"));
        CHECK_TEXT(read_all(m, &first, step), "[cut][gone](4)");
        mailbox_join(m, &late);
        CHECK_INT(mailbox_watchers(m), 2);
        CHECK_TEXT(read_all(m, &late, step), "[blocks][cut][gone](4)");
        CHECK(put(m, false, "", "(5)"));
        CHECK_TEXT(read_all(m, &first, step), "(5)");
        CHECK_TEXT(read_all(m, &late, step), "(5)");
        mailbox_leave(m, &first);
        mailbox_leave(m, &late);
        CHECK_INT(mailbox_watchers(m), 0);
        mailbox_destroy(m);
    }
}

TEST(a_beginning_takes_the_place_of_all_before_it)
{
    mailbox *m = mailbox_create();
    watcher first, late;
    mailbox_join(m, &first);
    put(m, true, "[a]", "(0)");
    put(m, false, "[b]", "(1)");
    CHECK_TEXT(read_all(m, &first, 100), "[a][b](1)");
    put(m, false, "[c]", "(2)");
    put(m, true, "[A]", "(3)");
    put(m, false, "[B]", "(4)");
    CHECK_TEXT(read_all(m, &first, 100), "[A][B](4)");
    mailbox_join(m, &late);
    CHECK_TEXT(read_all(m, &late, 100), "[A][B](4)");
    put(m, true, "", "(5)"); /* a model without blocks */
    CHECK_TEXT(read_all(m, &first, 100), "(5)");
    CHECK_TEXT(read_all(m, &late, 100), "(5)");
    put(m, true, "", "");
    CHECK(mailbox_behind(m, &first));
    CHECK_TEXT(read_all(m, &first, 100), "");
    CHECK(!mailbox_behind(m, &first));
    mailbox_leave(m, &first);
    mailbox_leave(m, &late);
    mailbox_destroy(m);
}

TEST(a_frame_on_its_way_stays_whole)
{
    mailbox *m = mailbox_create();
    watcher w;
    char part[6] = "";
    mailbox_join(m, &w);
    put(m, true, "[blocks]", "(0)");
    CHECK_INT(mailbox_read(m, &w, part, 5), 5);
    CHECK_TEXT(part, "[bloc");
    put(m, false, "[cut]", "(1)");
    put(m, true, "[other]", "(2)");
    put(m, false, "[more]", "(3)");
    CHECK(mailbox_behind(m, &w));
    CHECK_TEXT(read_all(m, &w, 3), "ks](0)[other][more](3)");
    put(m, false, "", "(4)");
    CHECK_INT(mailbox_read(m, &w, part, 0), 0);
    CHECK_INT(mailbox_read(m, &w, part, 1), 1);
    mailbox_leave(m, &w); /* in the middle */
    mailbox_destroy(m);
}

TEST(many_news_come_in_their_order)
{
    mailbox *m = mailbox_create();
    watcher w;
    mailbox_join(m, &w);
    char news[16], expected[4096] = "";
    for (int i = 0; i < 500; i++) {
        snprintf(news, sizeof news, "%d,", i);
        strcat(expected, news);
        CHECK(put(m, i == 0, news, "."));
    }
    strcat(expected, ".");
    CHECK_TEXT(read_all(m, &w, 64), expected);
    mailbox_leave(m, &w);
    mailbox_destroy(m);
}

/* ---------------------------------------------------------------- commands --------------- */

TEST(commands_come_in_their_order_and_no_more_than_there_is_room_for)
{
    mailbox *m = mailbox_create();
    char text[TL_SCREEN_COMMAND], expected[16], longest[TL_SCREEN_COMMAND + 1];
    CHECK_INT(mailbox_take(m, text, sizeof text, 0), 0);
    for (int round = 0; round < 3; round++) {
        for (int i = 0; i < MAILBOX_COMMANDS; i++) {
            snprintf(expected, sizeof expected, "%d", i);
            CHECK(mailbox_post(m, expected, strlen(expected)));
        }
        CHECK(!mailbox_post(m, "one more", 8));
        for (int i = 0; i < MAILBOX_COMMANDS - round; i++) { /* the queue goes round */
            snprintf(expected, sizeof expected, "%d", i);
            CHECK_INT(mailbox_take(m, text, sizeof text, i % 2), 1);
            CHECK_TEXT(text, expected);
        }
        for (int i = 0; i < round; i++)
            CHECK_INT(mailbox_take(m, text, sizeof text, 0), 1);
        CHECK_INT(mailbox_take(m, text, sizeof text, 0), 0);
    }
    memset(longest, 'x', sizeof longest);
    CHECK(!mailbox_post(m, longest, TL_SCREEN_COMMAND));
    CHECK(mailbox_post(m, longest, TL_SCREEN_COMMAND - 1));
    CHECK_INT(mailbox_take(m, text, TL_SCREEN_COMMAND - 1, 0), 0); /* no room: it stays */
    CHECK_INT(mailbox_take(m, text, sizeof text, 0), 1);
    CHECK_INT(strlen(text), TL_SCREEN_COMMAND - 1);
    mailbox_destroy(m);
}

TEST(waiting_ends)
{
    mailbox *m = mailbox_create();
    char text[TL_SCREEN_COMMAND];
    CHECK_INT(mailbox_take(m, text, sizeof text, 0.05), 0);
    CHECK_INT(mailbox_take(m, text, sizeof text, -1), 0);
    CHECK_INT(mailbox_take(m, text, sizeof text, (double)NAN), 0);
    mailbox_destroy(m);
}

/* What another thread does, at some time. */
typedef struct deed {
    mailbox *m;
    watcher w;
    bool joins;
} deed;

static void *do_later(void *given)
{
    deed *d = given;
    const struct timespec some = {0, 20000000};
    nanosleep(&some, NULL);
    if (d->joins)
        mailbox_join(d->m, &d->w);
    else
        mailbox_post(d->m, "go", 2);
    return NULL;
}

TEST(waiting_is_ended_by_a_command_and_by_one_who_begins_to_look)
{
    mailbox *m = mailbox_create();
    char text[TL_SCREEN_COMMAND] = "";
    pthread_t thread;
    deed posts = {.m = m}, joins = {.m = m, .joins = true};
    CHECK_INT(pthread_create(&thread, NULL, do_later, &posts), 0);
    CHECK_INT(mailbox_take(m, text, sizeof text, (double)INFINITY), 1);
    CHECK_TEXT(text, "go");
    pthread_join(thread, NULL);
    CHECK_INT(pthread_create(&thread, NULL, do_later, &joins), 0);
    CHECK_INT(mailbox_take(m, text, sizeof text, 1e300), 0);
    CHECK_INT(mailbox_watchers(m), 1);
    pthread_join(thread, NULL);
    CHECK_INT(mailbox_take(m, text, sizeof text, 0.05), 0); /* that one is known now */
    mailbox_leave(m, &joins.w);
    /* one who came before the waiting began was not told of either */
    mailbox_join(m, &joins.w);
    CHECK_INT(mailbox_take(m, text, sizeof text, 0), 0);
    CHECK_INT(mailbox_take(m, text, sizeof text, 1e300), 0);
    mailbox_leave(m, &joins.w);
    mailbox_destroy(m);
}

/* ---------------------------------------------------------------- threads ---------------- */

#define FRAMES 2000
#define READERS 3

/* A frame as numbers: the news are 'n' and their number, what there is now 'f', its number and so many bytes. */
typedef struct reader {
    mailbox *m;
    atomic_bool *ends;
    uint32_t last, frames, news, faults;
} reader;

typedef struct mark {
    uint32_t what, number;
} mark;

/* Reads marks whole; false when there is nothing. */
static bool read_mark(reader *r, watcher *w, mark *to)
{
    size_t length = 0;
    while (length < sizeof *to) {
        ptrdiff_t given = mailbox_read(r->m, w, (char *)to + length, sizeof *to - length);
        if (given <= 0) {
            r->faults += length > 0;
            return false;
        }
        length += (size_t)given;
    }
    return true;
}

static void *read_on(void *given)
{
    reader *r = given;
    watcher w;
    uint32_t next = UINT32_MAX; /* news that must come next; those of a beginning are numbered from its own */
    const struct timespec moment = {0, 50000};
    mark k = {0, 0};
    mailbox_join(r->m, &w);
    for (bool last = false; !last;) {
        last = atomic_load(r->ends);
        while (read_mark(r, &w, &k)) {
            if (k.what == 'b' || k.what == 'n') {
                r->faults += k.what == 'n' && k.number != next;
                next = k.number + 1;
                r->news++;
            } else {
                r->faults += k.what != 'f' || k.number < r->last || next > k.number + 1;
                r->last = k.number;
                r->frames++;
                for (uint32_t i = 0; i < k.number % 50; i++) {
                    mark filler;
                    r->faults += !read_mark(r, &w, &filler) || filler.number != k.number;
                }
            }
        }
        if (k.number % 97 == 5) { /* some leave and come back */
            mailbox_leave(r->m, &w);
            mailbox_join(r->m, &w);
            next = UINT32_MAX;
        }
        mailbox_post(r->m, "step", 4);
        nanosleep(&moment, NULL);
    }
    mailbox_leave(r->m, &w);
    return NULL;
}

TEST(readers_on_other_threads_get_whole_frames_in_order)
{
    mailbox *m = mailbox_create();
    atomic_bool ends = false;
    reader readers[READERS] = {{0}};
    pthread_t threads[READERS];
    char text[TL_SCREEN_COMMAND];
    size_t taken = 0;
    for (int i = 0; i < READERS; i++) {
        readers[i] = (reader){.m = m, .ends = &ends};
        CHECK_INT(pthread_create(&threads[i], NULL, read_on, &readers[i]), 0);
    }
    for (uint32_t k = 0; k < FRAMES; k++) {
        bool begins = k % 500 == 0;
        mark news = {begins ? 'b' : 'n', k}, now[51];
        for (uint32_t i = 0; i < 51; i++)
            now[i] = (mark){i == 0 ? 'f' : 'x', k};
        const tl_screen_frame frame = {.size = sizeof frame,
                                       .begin = begins,
                                       .news = &news,
                                       .news_length = sizeof news,
                                       .now = now,
                                       .now_length = (1 + k % 50) * sizeof now[0]};
        CHECK(mailbox_put(m, &frame));
        while (mailbox_take(m, text, sizeof text, k % 100 == 0 ? 1e-4 : 0))
            taken += strcmp(text, "step") == 0;
        CHECK(mailbox_watchers(m) <= READERS);
    }
    atomic_store(&ends, true);
    for (int i = 0; i < READERS; i++) {
        pthread_join(threads[i], NULL);
        CHECK_INT(readers[i].faults, 0);
        CHECK_INT(readers[i].last, FRAMES - 1);
        CHECK(readers[i].frames > 0 && readers[i].news > 0);
    }
    CHECK(taken > 0);
    CHECK_INT(mailbox_watchers(m), 0);
    mailbox_destroy(m);
}

TEST_MAIN(RUN(a_watcher_gets_all_news_and_what_there_is_now), RUN(a_beginning_takes_the_place_of_all_before_it),
          RUN(a_frame_on_its_way_stays_whole), RUN(many_news_come_in_their_order),
          RUN(commands_come_in_their_order_and_no_more_than_there_is_room_for), RUN(waiting_ends),
          RUN(waiting_is_ended_by_a_command_and_by_one_who_begins_to_look),
          RUN(readers_on_other_threads_get_whole_frames_in_order))
