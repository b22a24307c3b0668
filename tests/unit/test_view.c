/* test_view.c - what a screen is given: news once and in order, all of it again where it has grown, and when frames are due.
 *
 * The screen of this test keeps what it gets. */
#include "check.h"

#include <talus/talus.h>

/* ---------------------------------------------------------------- a screen --------------- */

static struct {
    unsigned char *news; /* of all frames since the last that began anew */
    size_t news_length;
    unsigned char now[1 << 16];
    size_t now_length;
    int frames, begun, open;
    uint32_t watchers;
    const char *command; /* that take gives next */
    int fails;
    char page[64];
    int check; /* what the page says of the command "{" */
} screen;

static tl_status open_screen(const tl_screen_page *page, const void *params, void **self, tl_report *report)
{
    char why[64];
    (void)params;
    if (screen.fails) {
        snprintf(report->text, sizeof report->text, "no %s", "light");
        return TL_E_IO;
    }
    screen.open++;
    screen.check = page->check("{", 1, why, sizeof why);
    const char *rule = strstr(page->text, "connect-src");
    snprintf(screen.page, sizeof screen.page, "%.18s", rule ? rule : "");
    *self = &screen;
    return TL_OK;
}

static const char *address(const void *self)
{
    (void)self;
    return "somewhere";
}

static uint32_t watchers(const void *self)
{
    (void)self;
    return screen.watchers;
}

static tl_status put(void *self, const tl_screen_frame *frame, tl_report *report)
{
    (void)self;
    if (screen.fails) {
        snprintf(report->text, sizeof report->text, "no %s", "room");
        return TL_E_MEMORY;
    }
    screen.frames++;
    screen.begun += frame->begin != 0;
    if (frame->begin)
        screen.news_length = 0;
    screen.news = realloc(screen.news, screen.news_length + frame->news_length + 1);
    if (frame->news_length)
        memcpy(screen.news + screen.news_length, frame->news, frame->news_length);
    screen.news_length += frame->news_length;
    screen.now_length = frame->now_length < sizeof screen.now ? frame->now_length : 0;
    memcpy(screen.now, frame->now, screen.now_length);
    return TL_OK;
}

static int take(void *self, char *text, size_t room, double seconds)
{
    (void)self, (void)seconds;
    if (!screen.command)
        return 0;
    snprintf(text, room, "%s", screen.command);
    screen.command = NULL;
    return 1;
}

static void close_screen(void *self)
{
    (void)self;
    screen.open--;
}

static const tl_screen_ops ops = {sizeof ops, open_screen, address, watchers, put, take, close_screen};
static const tl_kind kind = TL_KIND(TL_KIND_SCREEN, ops, .name = "memory", .doc = "Keeps all.");

/* ---------------------------------------------------------------- a model ---------------- */

static tl_model *model_of_box(void)
{
    tl_model_config config = tl_model_config_default();
    tl_model *m = NULL;
    tl_error error = {TL_OK, ""};
    tl_plugins_load_default();
    CHECK_INT(tl_model_create(&config, &m, &error), TL_OK);
    const double low[] = {0, 0, 0}, high[] = {4, 4, 4};
    const tl_value values[] = {tl_arg_numbers("min", low, 3), tl_arg_numbers("max", high, 3),
                               tl_arg_number("density", 2500)};
    const tl_args args = {values, 3};
    tl_generate_summary summary;
    CHECK_INT(tl_generate(m, "box", &args, &summary), TL_OK);
    return m;
}

static void cut(tl_model *m, double x)
{
    const double origin[] = {x, 0, 0};
    const tl_value values[] = {tl_arg_text("joint", "east"), tl_arg_number("dip", 90),
                               tl_arg_number("dip_direction", 90), tl_arg_numbers("origin", origin, 3)};
    const tl_args args = {values, 4};
    tl_generate_summary summary;
    CHECK_INT(tl_generate(m, "joint", &args, &summary), TL_OK);
}

static tl_view *open_view(tl_model *m)
{
    tl_view_options options = tl_view_options_default();
    tl_view *view = NULL;
    options.title = "a <b>";
    options.share = 1;
    memset(&screen, 0, sizeof screen);
    CHECK_INT(tl_view_open(m, &kind, NULL, &options, &view), TL_OK);
    return view;
}

static void end(tl_model *m, tl_view *view)
{
    tl_view_close(view);
    CHECK_INT(screen.open, 0);
    free(screen.news);
    screen.news = NULL;
    tl_model_destroy(m);
}

/* "HEAD SHAP TOUC LIVE" of chunks one after the other. */
static const char *names_of(const unsigned char *data, size_t length)
{
    static char names[256];
    size_t at = 0, out = 0;
    for (names[0] = '\0'; at + 8 <= length && out + 6 < sizeof names;) {
        uint32_t bytes;
        memcpy(&bytes, data + at + 4, 4); /* the machines of the tests put the least byte first */
        out += (size_t)sprintf(names + out, "%s%.4s", out ? " " : "", (const char *)data + at);
        at += 8 + ((size_t)bytes + 3) / 4 * 4;
    }
    CHECK_INT(at, length);
    return names;
}

/* ---------------------------------------------------------------- tests ------------------ */

TEST(news_adds_up_to_all_there_is_to_know)
{
    tl_model *m = model_of_box();
    tl_view *view = open_view(m);
    tl_html html = tl_html_default();
    html.contacts = TL_HTML_CONTACTS_NONE;
    CHECK_TEXT(tl_view_address(view), "somewhere");
    CHECK_TEXT(screen.page, "connect-src 'self'");
    CHECK_INT(screen.check, 0);
    CHECK_INT(tl_view_tell(view, TL_VIEW_WAITING, NULL, NULL), TL_OK);
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    CHECK_TEXT(names_of(screen.news, screen.news_length), "HEAD SHAP TOUC LIVE");
    CHECK_TEXT(names_of(screen.now, screen.now_length), "FRAM LINE FIND DONE");
    CHECK_CONTAINS((const char *)screen.news + 8, "\"live\": true, \"commands\": true");
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    CHECK_TEXT(names_of(screen.news, screen.news_length), "HEAD SHAP TOUC LIVE");
    cut(m, 1);
    CHECK_INT(tl_view_tell(view, TL_VIEW_RUNNING, "a \"line\"", NULL), TL_OK);
    CHECK_INT(tl_view_tell(view, TL_VIEW_RUNNING, NULL, "why"), TL_OK);
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    CHECK_TEXT(names_of(screen.news, screen.news_length), "HEAD SHAP TOUC LIVE HEAD SHAP GONE TOUC LIVE LIVE");
    CHECK_INT(screen.begun, 1);
    end(m, view);
}

/* Whatever texts have in them, the page reads UTF-8. */
TEST(texts_are_shown_in_utf8)
{
    tl_model *m = model_of_box();
    tl_view *view = open_view(m);
    tl_html html = tl_html_default();
    CHECK_INT(tl_view_tell(view, TL_VIEW_RUNNING, "\xe6\x96\xad \xe6\x96", "\xff\x1b\n"), TL_OK);
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    screen.news[screen.news_length] = '\0';
    const char *live = NULL;
    for (size_t i = 0; i + 4 < screen.news_length; i++)
        if (memcmp(screen.news + i, "LIVE", 4) == 0)
            live = (const char *)screen.news + i + 8;
    CHECK_CONTAINS(live, "\"line\": \"\xe6\x96\xad \\ufffd\\ufffd\", \"refused\": \"\\ufffd\\u001b\\u000a\"");
    end(m, view);
}

TEST(a_frame_that_is_not_taken_is_shown_again)
{
    tl_model *m = model_of_box();
    tl_view *view = open_view(m);
    tl_html html = tl_html_default();
    html.contacts = TL_HTML_CONTACTS_NONE;
    CHECK_INT(tl_view_tell(view, TL_VIEW_RUNNING, "line", NULL), TL_OK);
    screen.fails = 1;
    CHECK_INT(tl_view_show(view, &html), TL_E_MEMORY);
    CHECK_TEXT(tl_model_error(m)->text, "view, screen 'memory': no room");
    screen.fails = 0;
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    CHECK_TEXT(names_of(screen.news, screen.news_length), "HEAD SHAP TOUC LIVE");
    cut(m, 1);
    screen.fails = 1;
    CHECK_INT(tl_view_show(view, &html), TL_E_MEMORY);
    screen.fails = 0;
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    CHECK_TEXT(names_of(screen.news, screen.news_length), "HEAD SHAP TOUC LIVE HEAD SHAP GONE TOUC");
    end(m, view);
}

/* Told lines of 16 MB more than the beginning: then news begins anew, with all of them. */
TEST(news_that_has_grown_begins_anew)
{
    tl_model *m = model_of_box();
    tl_view *view = open_view(m);
    tl_html html = tl_html_default();
    char *line = malloc(1 << 20);
    memset(line, 'x', (1 << 20) - 1);
    line[(1 << 20) - 1] = '\0';
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    size_t told = 0;
    for (int i = 0; i < 40 && screen.begun == 1; i++) {
        CHECK_INT(tl_view_tell(view, TL_VIEW_RUNNING, line, NULL), TL_OK);
        told++;
        CHECK_INT(tl_view_show(view, &html), TL_OK);
    }
    CHECK_INT(screen.begun, 2);
    CHECK(told > 16 && told < 20);
    CHECK(screen.news_length > told << 20 && screen.news_length < (told << 20) + (1 << 16));
    size_t again = 0;
    for (; again < 80 && screen.begun == 2; again++) {
        CHECK_INT(tl_view_tell(view, TL_VIEW_RUNNING, line, NULL), TL_OK);
        CHECK_INT(tl_view_show(view, &html), TL_OK);
    }
    CHECK(again > 16 + told && again < 20 + told); /* what it began with counts */
    free(line);
    end(m, view);
}

TEST(frames_are_due_when_somebody_looks_and_something_is_new)
{
    tl_model *m = model_of_box();
    tl_view *view = open_view(m);
    tl_html html = tl_html_default();
    CHECK(!tl_view_due(view, INFINITY)); /* nobody looks */
    screen.watchers = 1;
    CHECK(tl_view_due(view, INFINITY));
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    CHECK(!tl_view_due(view, INFINITY)); /* nothing is new */
    screen.watchers = 2;
    CHECK(tl_view_due(view, INFINITY)); /* but to somebody */
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    CHECK_INT(tl_view_tell(view, TL_VIEW_PAUSED, NULL, NULL), TL_OK);
    CHECK(tl_view_due(view, INFINITY));
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    cut(m, 1);
    CHECK(tl_view_due(view, INFINITY));
    while (!tl_view_due(view, 0)) /* until 1/25 s has passed */
        continue;
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    screen.watchers = 0;
    cut(m, 2);
    CHECK(!tl_view_due(view, INFINITY));
    end(m, view);
}

/* However short frames are: most of many steps show none, and with a small share of the time not even the second one comes. */
TEST(frames_take_their_share_and_no_more)
{
    tl_model *m = model_of_box();
    tl_view *view = open_view(m);
    tl_html html = tl_html_default();
    screen.watchers = 1;
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    int shown = 0;
    for (int i = 0; i < 1000; i++) {
        CHECK_INT(tl_view_tell(view, TL_VIEW_RUNNING, NULL, NULL), TL_OK);
        if (tl_view_due(view, 0)) {
            CHECK_INT(tl_view_show(view, &html), TL_OK);
            shown++;
        }
    }
    CHECK(shown < 500);
    end(m, view);

    m = model_of_box();
    tl_view_options options = tl_view_options_default();
    memset(&screen, 0, sizeof screen);
    screen.watchers = 1;
    options.share = 1e-9;
    CHECK_INT(tl_view_open(m, &kind, NULL, &options, &view), TL_OK);
    CHECK(tl_view_due(view, INFINITY));
    CHECK_INT(tl_view_show(view, &html), TL_OK);
    cut(m, 1);
    CHECK(!tl_view_due(view, 0));
    CHECK(!tl_view_due(view, 1e-3)); /* what ends is not worth it */
    CHECK(tl_view_due(view, 1e12));
    end(m, view);
}

TEST(commands_come_as_they_are_meant)
{
    tl_model *m = model_of_box();
    tl_view *view = open_view(m);
    tl_view_command command;
    CHECK(!tl_view_take(view, 0, &command));
    screen.command = "{\"op\":\"step\",\"n\":5}";
    CHECK(tl_view_take(view, 0, &command));
    CHECK_INT(command.op, TL_VIEW_STEP);
    CHECK_INT(command.steps, 5);
    screen.command = "{\"op\":\"rm\"}"; /* that the screen should have refused */
    CHECK(!tl_view_take(view, 0, &command));
    end(m, view);
}

TEST(a_view_that_cannot_begin_leaves_nothing)
{
    tl_model *m = model_of_box();
    tl_view_options options = tl_view_options_default();
    tl_view *view = (tl_view *)&screen;
    memset(&screen, 0, sizeof screen);
    screen.fails = 1;
    CHECK_INT(tl_view_open(m, &kind, NULL, &options, &view), TL_E_IO);
    CHECK(view == NULL);
    CHECK_TEXT(tl_model_error(m)->text, "view, screen 'memory': no light");
    options.share = 2;
    CHECK_INT(tl_view_open(m, &kind, NULL, &options, &view), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "share = 2 must be in (0, 1]");
    const tl_value port = tl_arg_number("prot", 80);
    const tl_args args = {&port, 1};
    screen.fails = 0;
    CHECK_INT(tl_view_open(m, &kind, &args, NULL, &view), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "prot");
    CHECK_INT(screen.open, 0);
    tl_view_close(NULL);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(news_adds_up_to_all_there_is_to_know), RUN(texts_are_shown_in_utf8),
          RUN(a_frame_that_is_not_taken_is_shown_again), RUN(news_that_has_grown_begins_anew),
          RUN(frames_are_due_when_somebody_looks_and_something_is_new), RUN(frames_take_their_share_and_no_more),
          RUN(commands_come_as_they_are_meant), RUN(a_view_that_cannot_begin_leaves_nothing))
