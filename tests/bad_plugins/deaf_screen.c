/* deaf_screen.c - a screen without `take`. */
#include "plain_screen.h"

static const tl_screen_ops ops = {.size = sizeof ops,
                                  .open = open_screen,
                                  .address = address,
                                  .watchers = watchers,
                                  .put = put,
                                  .close = close_screen};
static const tl_kind kind =
    TL_KIND(TL_KIND_SCREEN, ops, .name = "deaf", .doc = "A screen for the loader's test.");

TL_PLUGIN_SINCE(7, kind, .id = "bad.deaf_screen", .version = "1",
                .doc = "A plugin for the loader's test.", .licence = "BSD-3-Clause");
