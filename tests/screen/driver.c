/* driver.c - the model's side of a screen, told by lines what to do: tests/python/test_screen_server.py talks to it.
 *
 *     driver PLUGIN.so
 *
 *     open PORT COMMANDS          "at ADDRESS", or "failed SENTENCE"
 *     put BEGIN NEWS NOW          a frame with so many bytes of payload: "put K", its number
 *     run COUNT PERIOD NEWS NOW   so many frames, PERIOD ms after each other; a command is echoed when it comes, as
 *                                 "took TEXT". Then "ran"
 *     take SECONDS                "took TEXT" or "none"
 *     wait COUNT                  until so many look: "watchers COUNT"
 *     close                       "closed"
 *
 * Frame number k is, in chunks of docs/scene_format.md: "NEWS" when it has any, "NOWF" and "DONE". Each payload is the
 * number k, then bytes k mod 251. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/plugin.h>
#include <time.h>

static const char page_text[] = "<!doctype html><title>M\xc3\xbcller's page</title>";

static int check(const char *text, size_t length, char *why, size_t room)
{
    if (length > 1 && text[0] == '{' && text[length - 1] == '}')
        return 1;
    snprintf(why, room, "'%.*s' is no command: it is one JSON object", (int)length, text);
    return 0;
}

typedef struct driver {
    const tl_screen_ops *ops;
    void *self;
    uint32_t puts;
    unsigned char *news, *now;
} driver;

static void nap(double ms)
{
    const struct timespec t = {(time_t)(ms / 1e3), (long)(1e6 * (ms - 1e3 * (double)(time_t)(ms / 1e3)))};
    if (ms > 0)
        nanosleep(&t, NULL);
}

/* Writes a chunk with `length` bytes of payload, a multiple of 4 from 4 on; the bytes it takes. */
static size_t write_chunk(unsigned char *to, const char *name, uint32_t number, uint32_t length)
{
    memcpy(to, name, 4);
    memcpy(to + 4, &length, 4);
    memcpy(to + 8, &number, 4);
    memset(to + 12, (int)(number % 251), length - 4);
    return 8 + (size_t)length;
}

static int put(driver *d, int begin, uint32_t news, uint32_t now)
{
    tl_report report = {.size = sizeof report};
    d->news = realloc(d->news, 16 + (size_t)news);
    d->now = realloc(d->now, 32 + (size_t)now);
    if (!d->news || !d->now)
        return 0;
    tl_screen_frame frame = {.size = sizeof frame, .begin = begin != 0, .news = d->news, .now = d->now};
    frame.news_length = news > 0 ? write_chunk(d->news, "NEWS", d->puts, news) : 0;
    frame.now_length = write_chunk(d->now, "NOWF", d->puts, now);
    frame.now_length += write_chunk(d->now + frame.now_length, "DONE", d->puts, 4);
    d->puts++;
    return d->ops->put(d->self, &frame, &report) == TL_OK;
}

static int take(driver *d, double seconds)
{
    char text[TL_SCREEN_COMMAND];
    int taken = d->ops->take(d->self, text, sizeof text, seconds);
    if (taken)
        printf("took %s\n", text);
    return taken;
}

static void run(driver *d, int count, double period, uint32_t news, uint32_t now)
{
    for (int i = 0; i < count; i++) {
        put(d, 0, news, now);
        take(d, 0);
        nap(period);
    }
    puts("ran");
}

static void open_screen(driver *d, int64_t port, uint32_t commands)
{
    tl_report report = {.size = sizeof report};
    char *text = strdup(page_text); /* valid during `open` only */
    const tl_screen_page page = {
        .size = sizeof page, .text = text, .length = strlen(page_text), .commands = commands, .check = check};
    d->puts = 0;
    if (d->ops->open(&page, &port, &d->self, &report) == TL_OK)
        printf("at %s\n", d->ops->address(d->self));
    else
        printf("failed %s\n", report.text);
    free(text);
}

static void wait_for(driver *d, uint32_t count)
{
    while (d->ops->watchers(d->self) != count)
        nap(5);
    printf("watchers %u\n", count);
}

static void obey(driver *d, const char *line)
{
    const uint32_t next = d->puts;
    long a, b, c, e;
    double number;
    if (sscanf(line, "open %ld %ld", &a, &b) == 2)
        open_screen(d, a, (uint32_t)b);
    else if (sscanf(line, "put %ld %ld %ld", &a, &b, &c) == 3)
        printf(put(d, (int)a, (uint32_t)b, (uint32_t)c) ? "put %u\n" : "no memory\n", next);
    else if (sscanf(line, "run %ld %lf %ld %ld", &a, &number, &c, &e) == 4)
        run(d, (int)a, number, (uint32_t)c, (uint32_t)e);
    else if (sscanf(line, "take %lf", &number) == 1) {
        if (!take(d, number))
            puts("none");
    } else if (sscanf(line, "wait %ld", &a) == 1)
        wait_for(d, (uint32_t)a);
    else if (strncmp(line, "close", 5) == 0) {
        d->ops->close(d->self);
        puts("closed");
    } else
        printf("what is %s\n", line);
    fflush(stdout);
}

int main(int argc, char **argv)
{
    void *handle = argc == 2 ? dlopen(argv[1], RTLD_NOW) : NULL;
    void *symbol = handle ? dlsym(handle, "tl_plugin_entry") : NULL;
    tl_plugin_entry_fn entry;
    memcpy(&entry, &symbol, sizeof entry);
    const tl_plugin *plugin = symbol ? entry(TL_ABI_MAJOR, TL_ABI_MINOR) : NULL;
    if (!plugin || plugin->kind_count != 1 || plugin->kinds[0].type != TL_KIND_SCREEN) {
        fprintf(stderr, "driver: give a plugin with a screen: %s\n", argc == 2 ? dlerror() : "");
        return 1;
    }
    driver d = {.ops = plugin->kinds[0].ops};
    char line[256];
    while (fgets(line, sizeof line, stdin))
        obey(&d, line);
    free(d.news);
    free(d.now);
    return 0;
}
