/* browser.c - screen "browser": the page of a model, served on the loopback while the model runs.
 *
 * One thread serves all requests, with libmicrohttpd. It waits for four things at once: somebody who connects, a frame
 * or the end from the model's thread, what the library's connections wait for, and watchers without news who go away.
 * Of those the library hears nothing. The model's thread only puts frames and takes commands (mailbox.h).
 *
 * There is no other address than 127.0.0.1. Over ssh: `ssh -L PORT:127.0.0.1:PORT host`. */
#define _GNU_SOURCE /* accept4, POLLRDHUP */
#include "server.h"

#include <talus/version.h>

#include <errno.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

/* s, for those who look to take what they have not got yet, at the end. The tests build it longer. */
#ifndef LAST_LOOK
#define LAST_LOOK 1.0
#endif
/* Bytes of memory of a connection: a request's headers, and a part of a frame. */
#define CONNECTION_MEMORY 131072

typedef struct params {
    int64_t port;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_INT, params, port, "", "port of 127.0.0.1; 0: any that is free, which the address tells",
             .def = {0}, .min = 0, .max = 65535),
};

/* What the model's thread knows of: the server, and how to reach its thread. */
typedef struct browser {
    server s; /* of the server's thread, but for `mail`, between `open` and `close` */
    pthread_t thread;
    int listener, bell; /* sockets; the bell rings when there is a frame, or the end */
    atomic_bool ends;
    char address[64 + TOKEN_TEXT];
} browser;

/* ---------------------------------------------------------------- the server's thread ---- */

static double now_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void let_in(browser *b)
{
    for (;;) {
        struct sockaddr_in from;
        socklen_t length = sizeof from;
        int socket = accept4(b->listener, (struct sockaddr *)&from, &length, SOCK_CLOEXEC | SOCK_NONBLOCK);
        if (socket < 0)
            return;
        /* the library closes it where there are as many as may be */
        MHD_add_connection(b->s.daemon, socket, (const struct sockaddr *)&from, length);
    }
}

/* Watchers that wait go on when there is something for them. */
static void wake_watchers(server *s)
{
    for (size_t i = 0; i < MOST_WATCHERS; i++) {
        seat *own = s->seats[i];
        if (own && own->waits && (own->gone || s->closing || mailbox_behind(s->mail, &own->w))) {
            own->waits = false;
            MHD_resume_connection(own->connection);
        }
    }
}

/* Waits until there is something to do, and no longer than until `deadline`. */
static void wait_for_something(browser *b, double deadline)
{
    enum { LISTENER, BELL, LIBRARY, WATCHERS };
    server *s = &b->s;
    struct pollfd of[WATCHERS + MOST_WATCHERS] = {
        [LISTENER] = {.fd = s->closing ? -1 : b->listener, .events = POLLIN},
        [BELL] = {.fd = b->bell, .events = POLLIN},
        [LIBRARY] = {.fd = MHD_get_daemon_info(s->daemon, MHD_DAEMON_INFO_EPOLL_FD)->epoll_fd, .events = POLLIN}};
    for (size_t i = 0; i < MOST_WATCHERS; i++) {
        bool waits = s->seats[i] && s->seats[i]->waits;
        of[WATCHERS + i] = (struct pollfd){.fd = waits ? s->seats[i]->socket : -1, .events = POLLRDHUP};
    }
    MHD_UNSIGNED_LONG_LONG library;
    double wait = s->closing ? 1e3 * (deadline - now_seconds()) : 1e6;
    if (MHD_get_timeout(s->daemon, &library) == MHD_YES && (double)library < wait)
        wait = (double)library;
    if (poll(of, sizeof of / sizeof *of, wait > 0 ? (int)wait : 0) <= 0)
        return;
    eventfd_t count;
    if (of[BELL].revents)
        eventfd_read(b->bell, &count);
    for (size_t i = 0; i < MOST_WATCHERS; i++)
        if (of[WATCHERS + i].revents)
            s->seats[i]->gone = true;
    if (of[LISTENER].revents)
        let_in(b);
}

static void *serve(void *given)
{
    browser *b = given;
    server *s = &b->s;
    double deadline = 0;
    do {
        wait_for_something(b, deadline);
        if (!s->closing && atomic_load(&b->ends)) {
            s->closing = true;
            deadline = now_seconds() + LAST_LOOK;
        }
        wake_watchers(s);
        MHD_run(s->daemon);
    } while (!s->closing || (mailbox_watchers(s->mail) > 0 && now_seconds() < deadline));
    wake_watchers(s); /* none may be suspended when the library ends */
    MHD_stop_daemon(s->daemon);
    return NULL;
}

/* ---------------------------------------------------------------- beginning -------------- */

static tl_status fail(tl_report *report, tl_status status, const char *what, int error)
{
    snprintf(report->text, sizeof report->text, "%s (%s)", what, strerror(error));
    return status;
}

static tl_status begin_listening(browser *b, int64_t port, tl_report *report)
{
    struct sockaddr_in at = {
        .sin_family = AF_INET, .sin_port = htons((uint16_t)port), .sin_addr = {htonl(INADDR_LOOPBACK)}};
    socklen_t length = sizeof at;
    int yes = 1;
    b->listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (b->listener < 0)
        return fail(report, TL_E_IO, "no socket can be opened", errno);
    /* A port whose last connections are still being closed may be taken; one that is listened to may not. */
    setsockopt(b->listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (bind(b->listener, (const struct sockaddr *)&at, sizeof at) != 0 ||
        listen(b->listener, 2 * MOST_CONNECTIONS) != 0) {
        if (errno == EADDRINUSE && port > 0)
            snprintf(report->text, sizeof report->text,
                     "port %d of 127.0.0.1 is in use; give another one, or 0 for any that is free", (int)port);
        else
            snprintf(report->text, sizeof report->text,
                     "port %d of 127.0.0.1 cannot be listened to (%s); give another one, or 0 for any that is free",
                     (int)port, strerror(errno));
        return TL_E_IO;
    }
    if (getsockname(b->listener, (struct sockaddr *)&at, &length) != 0)
        return fail(report, TL_E_IO, "the system does not tell the port", errno);
    snprintf(b->address, sizeof b->address, "http://127.0.0.1:%u/?token=%s", (unsigned)ntohs(at.sin_port), b->s.token);
    return TL_OK;
}

static tl_status begin_server(browser *b, const tl_screen_page *page, tl_report *report)
{
    server *s = &b->s;
    s->commands = page->commands != 0;
    s->check = page->check;
    s->page_length = page->length;
    s->page = malloc(page->length + 1);
    s->mail = mailbox_create();
    if (!s->page || !s->mail)
        return TL_E_MEMORY;
    memcpy(s->page, page->text, page->length);
    s->daemon = MHD_start_daemon(MHD_USE_EPOLL | MHD_ALLOW_SUSPEND_RESUME | MHD_USE_NO_LISTEN_SOCKET, 0, NULL, NULL,
                                 answer_request, s, MHD_OPTION_NOTIFY_COMPLETED, request_ended, s,
                                 MHD_OPTION_NOTIFY_CONNECTION, connection_changed, s, MHD_OPTION_CONNECTION_LIMIT,
                                 2U * MOST_CONNECTIONS, MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)SILENCE,
                                 MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)CONNECTION_MEMORY,
                                 MHD_OPTION_STRICT_FOR_CLIENT, 1, MHD_OPTION_SIGPIPE_HANDLED_BY_APP, 1, MHD_OPTION_END);
    if (!s->daemon)
        return fail(report, TL_E_IO, "libmicrohttpd does not start", errno);
    return TL_OK;
}

/* The thread handles no signal: Ctrl-C is the main thread's, and SIGPIPE nobody's. */
static int begin_thread(browser *b)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int error = pthread_create(&b->thread, NULL, serve, b);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return error;
}

static void free_browser(browser *b)
{
    if (b->listener >= 0)
        close(b->listener);
    if (b->bell >= 0)
        close(b->bell);
    mailbox_destroy(b->s.mail);
    free(b->s.page);
    free(b);
}

static tl_status open_browser(const tl_screen_page *page, const void *given, void **self, tl_report *report)
{
    const params *p = given;
    browser *b = calloc(1, sizeof *b);
    if (!b)
        return TL_E_MEMORY;
    b->listener = -1;
    b->bell = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    tl_status status = TL_OK;
    if (b->bell < 0)
        status = fail(report, TL_E_IO, "no event can be opened", errno);
    else if (!token_draw(b->s.token))
        status = fail(report, TL_E_IO, "the system gives no random numbers", errno);
    if (status == TL_OK)
        status = begin_listening(b, p->port, report);
    if (status == TL_OK)
        status = begin_server(b, page, report);
    int error = status == TL_OK ? begin_thread(b) : 0;
    if (error) {
        MHD_stop_daemon(b->s.daemon);
        status = fail(report, TL_E_MEMORY, "the server's thread cannot be started", error);
    }
    if (status != TL_OK) {
        free_browser(b);
        return status;
    }
    *self = b;
    return TL_OK;
}

/* ---------------------------------------------------------------- the model's thread ----- */

static const char *address(const void *self)
{
    return ((const browser *)self)->address;
}

static uint32_t watchers(const void *self)
{
    return mailbox_watchers(((const browser *)self)->s.mail);
}

static tl_status put(void *self, const tl_screen_frame *frame, tl_report *report)
{
    browser *b = self;
    if (!mailbox_put(b->s.mail, frame)) {
        snprintf(report->text, sizeof report->text, "no memory for a frame of %zu bytes",
                 frame->news_length + frame->now_length);
        return TL_E_MEMORY;
    }
    eventfd_write(b->bell, 1);
    return TL_OK;
}

static int take(void *self, char *text, size_t room, double seconds)
{
    return mailbox_take(((browser *)self)->s.mail, text, room, seconds);
}

static void close_browser(void *self)
{
    browser *b = self;
    atomic_store(&b->ends, true);
    eventfd_write(b->bell, 1);
    pthread_join(b->thread, NULL);
    free_browser(b);
}

static const tl_screen_ops ops = {sizeof ops, open_browser, address, watchers, put, take, close_browser};

static const tl_kind kind =
    TL_KIND(TL_KIND_SCREEN, ops, .name = "browser", .doc = "Serves the page to browsers on this machine, at 127.0.0.1.",
            TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(7, kind, .id = "talus.browser", .version = TALUS_VERSION, .doc = "Screen in a browser.",
                .licence = "BSD-3-Clause");
