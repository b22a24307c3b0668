/* mailbox.h - frames and commands between the thread of the model and the thread of the server.
 *
 * The model's side puts frames and takes commands; it waits for no reader. What is put is copied once, into pieces that
 * never change and that whoever reads them holds by a count. A watcher gets frames one by one, each whole: the news
 * that it has not got yet, and what there is now. While one is on its way to it newer ones are passed over, but for
 * their news. */
#ifndef TALUS_BROWSER_MAILBOX_H
#define TALUS_BROWSER_MAILBOX_H

#include <talus/plugin.h>

#include <stdbool.h>
#include <stddef.h>

/* Commands that wait at most. */
#define MAILBOX_COMMANDS 64

typedef struct mailbox mailbox;
typedef struct piece piece;

/* One who looks: how far it has got, and the frame on its way to it. */
typedef struct watcher {
    uint64_t epoch; /* count of beginnings */
    uint64_t put;   /* of the frame that it was given last */
    size_t news;    /* of the epoch, that it was given */
    piece **pieces; /* of the frame on its way; those before `at` are let go */
    size_t capacity, count, at;
    size_t offset; /* in the piece `at` */
} watcher;

/* NULL: no memory. */
mailbox *mailbox_create(void);
/* All watchers have left. */
void mailbox_destroy(mailbox *m);

/* [model] False: no memory, and all is as before. */
bool mailbox_put(mailbox *m, const tl_screen_frame *frame);
/* [model] As tl_screen_ops has it. */
int mailbox_take(mailbox *m, char *text, size_t room, double seconds);
/* [any] Watchers that have joined and not left. */
uint32_t mailbox_watchers(const mailbox *m);

/* [server] */
void mailbox_join(mailbox *m, watcher *w);
void mailbox_leave(mailbox *m, watcher *w);
/* [server] The next bytes for the watcher, `room` at the most. 0: it has got all there is; -1: no memory. */
ptrdiff_t mailbox_read(mailbox *m, watcher *w, void *to, size_t room);
/* [server] Whether mailbox_read would give something. */
bool mailbox_behind(mailbox *m, const watcher *w);
/* [server] Hands a command on, of fewer bytes than TL_SCREEN_COMMAND. False: as many wait as may. */
bool mailbox_post(mailbox *m, const char *text, size_t length);

#endif
