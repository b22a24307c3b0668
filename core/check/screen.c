/* screen.c - the conformance check of screens.
 *
 * A screen is opened twice in a row with the given and default parameters. It is told of frames that nobody sees, asked
 * for commands that nobody gives, and closed. What reaches those who look only a test that looks can tell. */
#include "check/screen.h"

#include "base/clock.h"
#include "base/inside.h"

#include <stdlib.h>
#include <string.h>

/* Constant: s that `take` is let wait. It may wait longer on a busy machine. */
#define WAIT 0.05
/* Bytes of what it must not write to, behind the room for a command. */
#define GUARD 64
#define UNTOUCHED 0x5a

enum { OPENS, ADDRESS, NOBODY, SHOWS, WAITS, WRITES };

static const tl_check_rule rules[] = {
    [OPENS] = {"opens", "open() returns TL_OK, again after close()"},
    [ADDRESS] = {"address", "address() gives a text"},
    [NOBODY] = {"nobody looks", "watchers() is 0"},
    [SHOWS] = {"shows", "put() returns TL_OK, for empty frames too"},
    [WAITS] = {"waits", "take() gives no command, and waits as long as it is told to"},
    [WRITES] = {"writes", "parameters are not written to, and take() writes to its room only"},
    {NULL, NULL},
};

/* No text is a command: nobody gives one. */
static int check_command(const char *text, size_t length, char *why, size_t room)
{
    (void)text;
    (void)length;
    if (room > 0)
        why[0] = '\0';
    return 0;
}

/* The page is gone after `open`. */
static tl_status open_screen(tl_checker *c, const void *params, void **self)
{
    static const char text[] = "<!doctype html><title>check</title>";
    const tl_screen_ops *ops = c->kind->ops;
    char *copy = malloc(sizeof text);
    tl_report report = {.size = sizeof report};
    if (!copy)
        return tl_fail_memory(c->error);
    memcpy(copy, text, sizeof text);
    const tl_screen_page page = {
        .size = sizeof page, .text = copy, .length = sizeof text - 1, .commands = 1, .check = check_command};
    tl_enter(c->kind, "open");
    tl_status status = ops->open(&page, params, self, &report);
    tl_leave();
    memset(copy, UNTOUCHED, sizeof text);
    free(copy);
    if (status != TL_OK)
        return tl_fail(c->error, status, "'%s' cannot be tried: %s", c->kind->name, tl_report_text(&report, status));
    return TL_OK;
}

static void try_frames(tl_checker *c, void *self)
{
    static const char *const news[] = {"HEAD\4\0\0\0{}  ", "", "GONE\4\0\0\0\0\0\0\0", ""};
    static const size_t lengths[] = {12, 0, 12, 0};
    const tl_screen_ops *ops = c->kind->ops;
    for (uint32_t i = 0; i < sizeof news / sizeof *news; i++) {
        tl_report report = {.size = sizeof report};
        const tl_screen_frame frame = {.size = sizeof frame,
                                       .begin = i % 3 == 0,
                                       .news = news[i],
                                       .news_length = lengths[i],
                                       .now = "DONE\4\0\0\0\0\0\0\0",
                                       .now_length = i < 3 ? 12 : 0};
        tl_enter(c->kind, "put");
        tl_status status = ops->put(self, &frame, &report);
        tl_leave();
        if (status != TL_OK)
            tl_check_note(c, SHOWS, "put() fails at frame %u: %s", i, tl_report_text(&report, status));
    }
}

static void try_commands(tl_checker *c, void *self)
{
    const tl_screen_ops *ops = c->kind->ops;
    char text[TL_SCREEN_COMMAND + GUARD];
    memset(text, UNTOUCHED, sizeof text);
    for (int i = 0; i < 2; i++) {
        double wait = i * WAIT, begun = tl_clock();
        tl_enter(c->kind, "take");
        int taken = ops->take(self, text, TL_SCREEN_COMMAND, wait);
        tl_leave();
        double took = tl_clock() - begun;
        if (taken)
            tl_check_note(c, WAITS, "take() gives %d, and nobody has asked for anything", taken);
        else if (took < wait)
            tl_check_note(c, WAITS, "take() is told to wait %g s, and waits %g s", wait, took);
    }
    for (size_t i = TL_SCREEN_COMMAND; i < sizeof text; i++)
        if (text[i] != UNTOUCHED)
            tl_check_note(c, WRITES, "take() writes to what lies behind its room");
}

static void run_trial(tl_checker *c, void *self)
{
    const tl_screen_ops *ops = c->kind->ops;
    const char *address = ops->address(self);
    if (!address || !address[0] || !memchr(address, '\0', TL_ERROR_TEXT))
        tl_check_note(c, ADDRESS, "address() gives %s", address ? "no text of use" : "NULL");
    try_frames(c, self);
    try_commands(c, self);
    uint32_t watchers = ops->watchers(self);
    if (watchers > 0)
        tl_check_note(c, NOBODY, "watchers() = %u", watchers);
    tl_enter(c->kind, "close");
    ops->close(self);
    tl_leave();
}

static tl_status check_kind(tl_checker *c)
{
    size_t size = c->kind->params_size;
    char *params = malloc(2 * size + 1);
    void *held = NULL, *self = NULL;
    tl_status status = params ? tl_check_params(c, 0, TL_CHECK_NONE, params, &held) : tl_fail_memory(c->error);
    if (status == TL_OK)
        memcpy(params + size, params, size);
    for (int i = 0; status == TL_OK && i < 2; i++) {
        status = open_screen(c, params, &self);
        if (status == TL_OK)
            run_trial(c, self);
        else if (i > 0) {
            tl_check_note(c, OPENS, "open() after close(): %s", c->error->text);
            status = TL_OK;
        }
    }
    if (status == TL_OK && memcmp(params + size, params, size) != 0)
        tl_check_note(c, WRITES, "the screen writes to its parameters");
    free(held);
    free(params);
    return status;
}

const tl_check_type tl_check_screens = {rules, check_kind};
