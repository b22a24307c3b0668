/* blank_screen.c - a screen with nothing wrong that shows nothing. */
#include "plain_screen.h"

static const tl_screen_ops ops = {.size = sizeof ops,
                                  .open = open_screen,
                                  .address = address,
                                  .watchers = watchers,
                                  .put = put,
                                  .take = take,
                                  .close = close_screen};
static const tl_kind kind =
    TL_KIND(TL_KIND_SCREEN, ops, .name = "blank", .doc = "A screen for the loader's test.");

TL_PLUGIN_SINCE(7, kind, .id = "bad.blank_screen", .version = "1",
                .doc = "A plugin for the loader's test.", .licence = "BSD-3-Clause");
