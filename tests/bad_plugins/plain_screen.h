/* plain_screen.h - operations of a screen that shows nothing, for plugins that have one of them wrong and the rest right. */
#ifndef TESTS_BAD_PLUGINS_PLAIN_SCREEN_H
#define TESTS_BAD_PLUGINS_PLAIN_SCREEN_H

#include <talus/plugin.h>

static inline tl_status open_screen(const tl_screen_page *page, const void *params, void **self, tl_report *report)
{
    static char nothing;
    (void)page;
    (void)params;
    (void)report;
    *self = &nothing;
    return TL_OK;
}

static inline const char *address(const void *self)
{
    (void)self;
    return "nowhere";
}

static inline uint32_t watchers(const void *self)
{
    (void)self;
    return 0;
}

static inline tl_status put(void *self, const tl_screen_frame *frame, tl_report *report)
{
    (void)self;
    (void)frame;
    (void)report;
    return TL_OK;
}

static inline int take(void *self, char *text, size_t room, double seconds)
{
    (void)self;
    (void)text;
    (void)room;
    (void)seconds;
    return 0;
}

static inline void close_screen(void *self)
{
    (void)self;
}

/* A plugin of one screen with these functions, which takes commands by `take_`; what else its kind has follows. */
#define PLAIN_SCREEN(name_, take_, ...)                                                                                \
    static const tl_screen_ops ops = {sizeof ops, open_screen, address, watchers, put, take_, close_screen};           \
    static const tl_kind kind =                                                                                        \
        TL_KIND(TL_KIND_SCREEN, ops, .name = (name_), .doc = "A screen for the loader's test.", __VA_ARGS__);          \
    TL_PLUGIN_SINCE(7, kind, .id = "bad." name_, .version = "1", .doc = "A plugin for the loader's test.",             \
                    .licence = "BSD-3-Clause")

#endif
