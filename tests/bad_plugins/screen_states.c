/* screen_states.c - a screen that declares a state. */
#include "plain_screen.h"

static const tl_screen_ops ops = {.size = sizeof ops,
                                  .open = open_screen,
                                  .address = address,
                                  .watchers = watchers,
                                  .put = put,
                                  .take = take,
                                  .close = close_screen};
static const tl_state states[] = {TL_STATE(TL_STATE_SCALAR, "brightness", "", "of the picture")};
static const tl_kind kind =
    TL_KIND(TL_KIND_SCREEN, ops, .name = "screen_states", .doc = "A screen for the loader's test.",
            TL_KIND_STATES(states));

TL_PLUGIN_SINCE(7, kind, .id = "bad.screen_states", .version = "1",
                .doc = "A plugin for the loader's test.", .licence = "BSD-3-Clause");
