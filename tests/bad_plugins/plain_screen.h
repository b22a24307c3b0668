/* plain_screen.h - operations of a screen that shows nothing, for plugins that have one of them wrong and the rest right. */
#ifndef TESTS_BAD_PLUGINS_PLAIN_SCREEN_H
#define TESTS_BAD_PLUGINS_PLAIN_SCREEN_H

#include <talus/plugin.h>

static inline tl_status open_screen(const tl_screen_page *page, const void *params, void **self,
                                    tl_report *report)
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

#endif
