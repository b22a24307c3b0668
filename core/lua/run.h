/* run.h - cycle and solve. */
#ifndef TL_LUA_RUN_H
#define TL_LUA_RUN_H

#include "lua/front.h"

/* Ratios kept for their trend. */
#define TL_LUA_TREND 64

typedef struct tl_lua_progress {
    bool on, terminal;
    bool drawn;                              /* a line stands on the terminal */
    double period, began, shown, next_count; /* s, of the clock */
    int64_t first_cycle, shown_cycle;        /* when it began; when the line was last written */
    double first_time, shown_time;           /* s, of the model */
    tl_contact_counts counts;
    double at[TL_LUA_TREND], log_ratio[TL_LUA_TREND];
    int kept;
} tl_lua_progress;

/* Raises when the environment's TALUS_PROGRESS makes no sense. */
void tl_lua_progress_begin(lua_State *L, tl_lua_progress *p, const tl_model *model);
/* Takes the line off the terminal. */
void tl_lua_progress_clear(tl_lua_progress *p);
/* For tl_model_watch_generate, with a tl_lua_progress. */
void tl_lua_progress_generate(void *progress, const tl_generate_progress *done);

extern const tl_lua_topic tl_lua_run_topics[];

#endif
