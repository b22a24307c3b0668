/* talus/view.h - a model that is seen while it runs: part of talus/talus.h.
 *
 * A plugin of the type *screen* shows it and brings back commands, as text; here is what frames are made of and what
 * commands mean. A command is only read, never done: the caller does it between two steps, and tells what was done.
 *
 *     tl_view_open(model, screen, NULL, &options, &view);
 *     in every step      if (tl_view_due(view, 0)) tl_view_show(view, &html);
 *     between two steps  while (tl_view_take(view, 0, &command)) ...
 *     tl_view_close(view);
 *
 * All functions are called on the model's thread but tl_view_command_read, which any thread may call. Nothing here
 * changes the model. */
#ifndef TALUS_VIEW_H
#define TALUS_VIEW_H

#include <talus/plugin.h>
#include <talus/types.h>
#include <talus/values.h>

#ifdef __cplusplus
extern "C" {
#endif

struct tl_model;
struct tl_html;
typedef struct tl_view tl_view;

/* ---------------------------------------------------------------- commands --------------- */

typedef enum tl_view_op {
    TL_VIEW_PAUSE,
    TL_VIEW_GO,
    TL_VIEW_STEP, /* `steps`, then pause */
    TL_VIEW_HIDE, /* from here to unjoin: `blocks`; of show none means all */
    TL_VIEW_SHOW,
    TL_VIEW_FIX,
    TL_VIEW_FREE,
    TL_VIEW_DELETE,
    TL_VIEW_JOIN,
    TL_VIEW_UNJOIN,
    TL_VIEW_CUT,      /* all visible blocks, by a plane of `joint` */
    TL_VIEW_FRICTION, /* `value`, degrees, of `joint` */
    TL_VIEW_VTK,      /* a frame for ParaView */
    TL_VIEW_SNAPSHOT, /* the model saved */
    TL_VIEW_SAFETY    /* its factor of safety, found on copies */
} tl_view_op;

/* Longest name of a joint in a command, bytes with the 0; as many block ids as it can have. */
#define TL_VIEW_JOINT 128
#define TL_VIEW_BLOCKS 256

typedef struct tl_view_command {
    tl_view_op op;
    int64_t steps; /* >= 1 */
    tl_id blocks[TL_VIEW_BLOCKS];
    size_t block_count;
    char joint[TL_VIEW_JOINT];
    double value;
    double dip, dip_direction; /* degrees, [0, 90] and [0, 360] */
    tl_vec3 origin;            /* a point of the plane, m */
} tl_view_command;

/* Reads a command: one JSON object with "op" and what that asks for, {"op": "delete", "blocks": [3, 5]}. 1, or 0 with a
 * sentence in `why`. A pure function. */
TL_API int tl_view_command_read(const char *text, size_t length, tl_view_command *command, char *why, size_t size);
/* The name of an op, as in a command. */
TL_API const char *tl_view_op_name(tl_view_op op);

/* ---------------------------------------------------------------- views ------------------ */

typedef struct tl_view_options {
    uint32_t size;     /* sizeof(tl_view_options) */
    int32_t commands;  /* whether commands are taken */
    const char *title; /* of the page; NULL: none */
    double share;      /* most of the time that goes into frames, (0, 1] */
} tl_view_options;

/* What the model does, as it is told to those who look. */
typedef enum tl_view_state {
    TL_VIEW_RUNNING,
    TL_VIEW_PAUSED,  /* in a run */
    TL_VIEW_WAITING, /* before the script goes on */
    TL_VIEW_ENDED    /* told by tl_view_close: a run that ends without it has broken off */
} tl_view_state;

/* Begins to show a model. `screen`: a kind of the type TL_KIND_SCREEN; NULL: the first there is. `params`: its
 * parameters by name; NULL: none. Nothing is seen before the first tl_view_show. TL_E_NOT_FOUND when no plugin has a
 * screen. */
TL_API tl_status tl_view_open(struct tl_model *model, const tl_kind *screen, const tl_args *params,
                              const tl_view_options *options, tl_view **view);
/* Where to look. Valid until tl_view_close. */
TL_API const char *tl_view_address(const tl_view *view);
/* Whether a frame is wanted: somebody looks, something has changed, and enough time has passed since the last one. That
 * is 1/25 s, and so much more that frames take no more than their share of the time. `worth`: seconds of work that end
 * now, for which a frame is due at once if it takes no more than that share of them: 0 within a run, INFINITY when
 * nothing else is to be done. */
TL_API bool tl_view_due(tl_view *view, double worth);
/* Shows the model as it is. `html`: what of it; its title is not read. */
TL_API tl_status tl_view_show(tl_view *view, const struct tl_html *html);
/* Takes the next command, waiting for it at most `seconds`. Also false when somebody begins to look. */
TL_API bool tl_view_take(tl_view *view, double seconds, tl_view_command *command);
/* Tells with the next frame what the model does and, unless NULL, the line that was done or the sentence why a command
 * was not. */
TL_API tl_status tl_view_tell(tl_view *view, tl_view_state state, const char *line, const char *refused);
/* Ends it; NULL is ignored. Those who look get what was shown last. Before the model is destroyed. */
TL_API void tl_view_close(tl_view *view);

#ifdef __cplusplus
}
#endif
#endif
