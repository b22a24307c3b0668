/* history.h - what the parts of histories share: history.c makes them, history_sample.c samples, history_file.c tells. */
#ifndef TL_LUA_HISTORY_H
#define TL_LUA_HISTORY_H

#include "front.h"

/* Most numbers a sample may have. */
#define TL_HISTORY_WIDEST 64
#define TL_HISTORY_NAME 63

/* User values of a history. */
enum { TL_HISTORY_FUNCTION = 1, TL_HISTORY_FOLLOWED, TL_HISTORY_USER_VALUES = 2 };

typedef enum tl_history_source { TL_FROM_FUNCTION, TL_FROM_MODEL, TL_FROM_ITEMS } tl_history_source;

typedef enum tl_history_take {
    TL_TAKE_MEAN,
    TL_TAKE_SUM,
    TL_TAKE_MIN,
    TL_TAKE_MAX
} tl_history_take;

typedef struct tl_history {
    char name[TL_HISTORY_NAME + 1];
    int64_t every, first; /* steps between samples; the cycle of the first one */
    tl_history_source source;
    size_t index; /* of what is asked of the model, or of the field */
    tl_history_take take;
    bool selection;                   /* the items are a selection, not one block or contact */
    bool lost;                        /* it was told that an item no longer exists */
    bool list;                        /* a sample is a list, even of one number */
    size_t width, count, room;        /* numbers of a sample; samples; room for them */
    int64_t *cycles;                  /* of each sample */
    double *times, *values;           /* s; width numbers for each sample */
    double latest[TL_HISTORY_WIDEST]; /* what is being sampled */
} tl_history;

/* Pushes the list of the histories of the model at index 1 and gives its length. */
lua_Integer tl_histories_push(lua_State *L);
/* History i of the list at `list`; it stays in the list, so the pointer may outlive the stack. */
tl_history *tl_history_at(lua_State *L, int list, lua_Integer i);
/* Names a quantity that a model can be asked for, from 0; NULL past the last one. */
const char *tl_history_quantity(size_t i);
/* Takes a sample of the history at the top of the stack, which is popped, while the model may only be read: as lua_pcall. */
int tl_history_sample(lua_State *L, int model_index);

#endif
