/* server.h - what the requests and the loop of the server share. All of it belongs to the server's thread, but for what
 * is said to be the model's. */
#ifndef TALUS_BROWSER_SERVER_H
#define TALUS_BROWSER_SERVER_H

#include "guard.h"
#include "mailbox.h"

#include <microhttpd.h>

/* Who can look at once; connections that are served, so that those who look can also command. As many more are let in
 * and get 503 for an answer; the others are closed at once. */
#define MOST_WATCHERS 8
#define MOST_CONNECTIONS 12

/* s without a byte after which a request is given up. The tests build it shorter. */
#ifndef SILENCE
#define SILENCE 10
#endif

/* A watcher's connection. */
typedef struct seat {
    struct server *server;
    struct MHD_Connection *connection;
    int socket;
    watcher w;
    bool waits; /* it has got all there is, and is suspended */
    bool gone;  /* the other end has closed */
} seat;

typedef struct server {
    char token[TOKEN_TEXT];
    char *page; /* HTML */
    size_t page_length;
    bool commands;
    int (*check)(const char *text, size_t length, char *why, size_t room);
    mailbox *mail;
    struct MHD_Daemon *daemon;
    unsigned connections;
    seat *seats[MOST_WATCHERS];
    bool closing; /* who has got all there is gets the end */
} server;

/* requests.c: answers to requests, as libmicrohttpd calls for them. `cls` is the server. */
enum MHD_Result answer_request(void *cls, struct MHD_Connection *connection, const char *path, const char *method,
                               const char *version, const char *data, size_t *size, void **request);
void request_ended(void *cls, struct MHD_Connection *connection, void **request, enum MHD_RequestTerminationCode how);
void connection_changed(void *cls, struct MHD_Connection *connection, void **context,
                        enum MHD_ConnectionNotificationCode what);

#endif
