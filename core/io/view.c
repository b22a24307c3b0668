/* view.c - a model that is seen while it runs (talus/view.h): which frames a screen gets, and when.
 *
 * A frame has two parts (scene.h): news, and what is so now. Everyone who looks must get news once and in order:
 * head, shapes, blocks that are gone, what was done. News adds up to all that somebody who comes late needs. Where it
 * has grown to several times what the model itself takes, it begins anew. */
#include "base/clock.h"
#include "base/error.h"
#include "base/inside.h"
#include "io/json.h"
#include "io/page.h"
#include "io/pieces.h"
#include "io/scene.h"
#include "io/scene_put.h"
#include "model/options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/plugins.h>
#include <talus/view.h>

/* Constant: frames a second at most. */
#define RATE 25.0
/* News begins anew when what has come since its beginning is longer than that by so many bytes. Below, all of it
 * again is no saving. */
#define GROWN ((size_t)16 << 20)

struct tl_view {
    tl_model *model;
    const tl_kind *kind;
    const tl_screen_ops *ops;
    void *self; /* the screen's */
    char *title;
    double share;
    tl_scene scene;
    tl_piece frame;      /* the last that was made */
    tl_piece told;       /* all that was told, as chunks */
    size_t told_before;  /* bytes of these that have been put */
    size_t first, since; /* bytes of the news when it last began, and after */
    uint32_t watchers;   /* when the last frame was put */
    int64_t cycle;       /* of the model then */
    uint64_t structure;
    double begun; /* clock when the frame was begun that is due, s; 0: none */
    double shown; /* clock when the last one was put, s */
    double cost;  /* of that one, s */
};

/* ---------------------------------------------------------------- opening ---------------- */

/* [worker] for tl_screen_page. */
static int check_command(const char *text, size_t length, char *why, size_t size)
{
    tl_view_command command;
    return tl_view_command_read(text, length, &command, why, size);
}

/* Puts what the screen has reported into the model's error. */
static tl_status refused(const tl_view *v, tl_report *report, tl_status status)
{
    return tl_fail(&v->model->error, status, "view, screen '%s': %s", v->kind->name, tl_report_text(report, status));
}

/* Reads the screen's parameters into memory that it may keep during `open`. */
static tl_status read_params(tl_view *v, const tl_args *given, void **params)
{
    static const tl_args none = {0};
    char context[64];
    snprintf(context, sizeof context, "view, screen '%.32s'", v->kind->name);
    *params = calloc(1, v->kind->params_size + 1);
    if (!*params)
        return tl_fail_memory(&v->model->error);
    return tl_args_read(v->kind->params, v->kind->param_count, v->kind->param_stride, given ? given : &none, false,
                        *params, context, &v->model->error);
}

static tl_status begin(tl_view *v, const tl_args *given, bool commands)
{
    tl_model *m = v->model;
    tl_report report = {.size = sizeof report};
    tl_piece page = {0};
    void *params = NULL;
    tl_status status = read_params(v, given, &params);
    tl_page_beginning(&page, v->title, true);
    if (status == TL_OK && page.failed)
        status = tl_fail_memory(&m->error);
    if (status == TL_OK) {
        const tl_screen_page shown = {.size = sizeof shown,
                                      .text = (const char *)page.data,
                                      .length = page.length,
                                      .commands = commands,
                                      .check = check_command};
        tl_enter(v->kind, "open");
        status = v->ops->open(&shown, params, &v->self, &report);
        tl_leave();
        if (status != TL_OK)
            refused(v, &report, status);
    }
    free(params);
    free(page.data);
    return status;
}

tl_status tl_view_open(tl_model *m, const tl_kind *screen, const tl_args *params, const tl_view_options *given,
                       tl_view **view)
{
    tl_view_options options;
    *view = NULL;
    tl_status status = TL_OPTIONS_READ(tl_view_options, given, &options, &m->error);
    if (status != TL_OK)
        return status;
    if (!(options.share > 0 && options.share <= 1))
        return tl_fail(&m->error, TL_E_ARGUMENT, "view: share = %g must be in (0, 1]", options.share);
    screen = screen ? screen : tl_plugin_kind(TL_KIND_SCREEN, 0);
    if (!screen)
        return tl_fail(&m->error, TL_E_NOT_FOUND,
                       "view: no plugin with a screen is there; build Talus where libmicrohttpd "
                       "is installed, or look at pages written by write_html");
    tl_view *v = calloc(1, sizeof *v);
    const char *title = options.title ? options.title : "Talus";
    if (!v || !(v->title = strdup(title))) {
        free(v);
        return tl_fail_memory(&m->error);
    }
    v->model = m;
    v->kind = screen;
    v->ops = screen->ops;
    v->share = options.share;
    v->scene.live = options.commands ? TL_SCENE_COMMANDS : TL_SCENE_LIVE;
    v->cycle = -1;
    status = begin(v, params, options.commands);
    if (status != TL_OK) {
        free(v->title);
        free(v);
        return status;
    }
    *view = v;
    return TL_OK;
}

const char *tl_view_address(const tl_view *v)
{
    tl_enter(v->kind, "address");
    const char *address = v->ops->address(v->self);
    tl_leave();
    return address;
}

/* ---------------------------------------------------------------- frames ----------------- */

static uint32_t count_watchers(const tl_view *v)
{
    tl_enter(v->kind, "watchers");
    uint32_t watchers = v->ops->watchers(v->self);
    tl_leave();
    return watchers;
}

/* Whether what was put last is not what there is. */
static bool is_behind(const tl_view *v, uint32_t watchers)
{
    const tl_model *m = v->model;
    return v->cycle != m->cycles || v->structure != m->structure || v->told_before < v->told.length ||
           watchers > v->watchers;
}

bool tl_view_due(tl_view *v, double worth)
{
    uint32_t watchers = count_watchers(v);
    if (watchers == 0 || !is_behind(v, watchers)) {
        v->watchers = watchers;
        return false;
    }
    v->begun = tl_clock();
    return v->cost < v->share * worth || v->begun - v->shown >= fmax(1 / RATE, v->cost * (1 / v->share - 1));
}

/* Gives the screen the frame that was made, of which the first bytes are news. */
static tl_status put(tl_view *v, size_t news, bool first)
{
    tl_report report = {.size = sizeof report};
    const tl_screen_frame frame = {.size = sizeof frame,
                                   .begin = first,
                                   .news = v->frame.data,
                                   .news_length = news,
                                   .now = v->frame.data + news,
                                   .now_length = v->frame.length - news};
    tl_enter(v->kind, "put");
    tl_status status = v->ops->put(v->self, &frame, &report);
    tl_leave();
    return status == TL_OK ? TL_OK : refused(v, &report, status);
}

/* Puts what was told between the news and the rest of the frame. */
static tl_status insert_told(tl_view *v, size_t news, size_t from)
{
    size_t bytes = v->told.length - from, rest = v->frame.length - news;
    if (bytes == 0)
        return TL_OK;
    if (!tl_piece_reserve(&v->frame, bytes))
        return tl_fail_memory(&v->model->error);
    memmove(v->frame.data + news + bytes, v->frame.data + news, rest);
    memcpy(v->frame.data + news, v->told.data + from, bytes);
    v->frame.length += bytes;
    return TL_OK;
}

tl_status tl_view_show(tl_view *v, const tl_html *given)
{
    tl_model *m = v->model;
    tl_html html;
    tl_scene_facts facts;
    tl_status status = TL_OPTIONS_READ(tl_html, given, &html, &m->error);
    if (status != TL_OK)
        return status;
    html.title = v->title;
    /* where news has piled up all of it is told anew */
    bool first = v->scene.sent.frames == 0 || v->since > v->first + GROWN;
    if (first)
        tl_scene_forget(&v->scene);
    v->frame.length = 0;
    v->frame.failed = false;
    status = tl_scene_write(&v->scene, m, &html, &v->frame, &facts);
    size_t from = first ? 0 : v->told_before, news = facts.news + v->told.length - from;
    if (status == TL_OK)
        status = insert_told(v, facts.news, from);
    uint32_t watchers = count_watchers(v);
    if (status == TL_OK)
        status = put(v, news, first);
    if (status != TL_OK)
        return status;
    tl_scene_accept(&v->scene);
    v->first = first ? news : v->first;
    v->since = first ? 0 : v->since + news;
    v->told_before = v->told.length;
    v->watchers = watchers;
    v->cycle = m->cycles;
    v->structure = m->structure;
    v->shown = tl_clock();
    v->cost = v->begun > 0 ? v->shown - v->begun : 0;
    v->begun = 0;
    return TL_OK;
}

/* ---------------------------------------------------------------- commands --------------- */

bool tl_view_take(tl_view *v, double seconds, tl_view_command *command)
{
    char text[TL_SCREEN_COMMAND], why[TL_ERROR_TEXT];
    tl_enter(v->kind, "take");
    int taken = v->ops->take(v->self, text, sizeof text, seconds);
    tl_leave();
    if (!taken)
        return false;
    text[sizeof text - 1] = '\0';
    if (tl_view_command_read(text, strlen(text), command, why, sizeof why))
        return true;
    tl_model_say(v->model, "view: a command is left out: %s", why); /* a screen that did not check it */
    return false;
}

tl_status tl_view_tell(tl_view *v, tl_view_state state, const char *line, const char *refused)
{
    static const char *const states[] = {"running", "paused", "waiting", "ended"};
    tl_model *m = v->model;
    tl_piece text = {0};
    tl_json_print(&text, "{\"state\": %s", states[state]);
    if (line)
        tl_json_print(&text, ", \"line\": %s", line);
    if (refused)
        tl_json_print(&text, ", \"refused\": %s", refused);
    tl_json_put(&text, "}");
    tl_status status =
        text.failed ? tl_fail_memory(&m->error) : tl_scene_bytes(m, "LIVE", text.data, text.length, &v->told);
    v->told.failed = false; /* another time there may be memory */
    free(text.data);
    return status;
}

/* ---------------------------------------------------------------- the end ---------------- */

void tl_view_close(tl_view *v)
{
    if (!v)
        return;
    /* the last state: fields of the caller's may be gone */
    const tl_html html = tl_html_default();
    if (tl_view_tell(v, TL_VIEW_ENDED, NULL, NULL) == TL_OK && count_watchers(v) > 0)
        (void)tl_view_show(v, &html);
    tl_enter(v->kind, "close");
    v->ops->close(v->self);
    tl_leave();
    tl_scene_free(&v->scene);
    free(v->frame.data);
    free(v->told.data);
    free(v->title);
    free(v);
}
