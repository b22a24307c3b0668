/* report.c - what was done to the objects of a file, and why some were refused. */
#include "solids.h"

#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>

/* Limit: reasons that a failed call tells. */
#define REASONS_TOLD 2
#define REASON_TEXT 400

const char *object_name(const solids *s, uint32_t object, uint32_t shell, char *text)
{
    const char *name = s->soup.names + s->soup.object[object].name;
    if (*name && s->soup.object[object].again)
        tl_text_print(text, NAME_TEXT, "%s (%u)", name, s->soup.object[object].again + 1);
    else if (*name)
        tl_text_print(text, NAME_TEXT, "%s", name);
    else
        tl_text_print(text, NAME_TEXT, "%u", object + 1);
    size_t length = strlen(text);
    if (s->done[object].shells > 1)
        tl_text_print(text + length, NAME_TEXT - length, "/%u", shell + 1);
    return text;
}

tl_status refuse_object(solids *s, uint32_t object, double needs, const char *format, ...)
{
    char text[REASON_TEXT];
    va_list arguments;
    va_start(arguments, format);
    tl_text_vprint(text, sizeof text, format, arguments);
    va_end(arguments);
    refusal *list = tl_grown(s->refusal, &s->refusal_capacity, s->refusals + 1, sizeof *list);
    if (!list)
        return soup_no_memory(&s->soup);
    s->refusal = list;
    char *reason = malloc(strlen(text) + 1);
    if (!reason)
        return soup_no_memory(&s->soup);
    memcpy(reason, text, strlen(text) + 1);
    list[s->refusals++] = (refusal){object, reason, needs};
    return TL_OK;
}

static int by_object(const void *left, const void *right)
{
    const refusal *a = left, *b = right;
    return a->object != b->object ? (a->object > b->object) - (a->object < b->object) : strcmp(a->reason, b->reason);
}

tl_status refusals_check(const solids *s)
{
    if (s->refusals == 0)
        return TL_OK;
    qsort(s->refusal, s->refusals, sizeof *s->refusal, by_object);
    char text[TL_ERROR_TEXT] = "", name[NAME_TEXT];
    size_t objects = 0;
    double needs = 0;
    for (size_t i = 0; i < s->refusals; i++) {
        const refusal *r = &s->refusal[i];
        needs = fmax(needs, r->needs);
        if (i > 0 && r->object == r[-1].object)
            continue;
        objects++;
        size_t length = strlen(text);
        if (objects <= REASONS_TOLD)
            tl_text_print(text + length, sizeof text - length, "%sobject '%s'%.240s", length ? "; " : "",
                          object_name(s, r->object, 0, name), r->reason);
    }
    if (s->skip && objects < s->soup.objects)
        return TL_OK;
    char more[80] = "";
    if (objects > REASONS_TOLD)
        tl_text_print(more, sizeof more, "; and more");
    char all[100] = "";
    if (needs > 0 && s->refusals > 1)
        tl_text_print(all, sizeof all, "; flat = %.3g would take %s that are off their planes", needs,
                      s->soup.objects > 1 ? "all" : "all solids");
    if (s->soup.objects > 1)
        return SOUP_FAULT(&s->soup, ": %zu of %zu objects are refused (skip = true leaves them out): %s%s%s", objects,
                          s->soup.objects, text, more, all);
    return SOUP_FAULT(&s->soup, ": %s%s", text, all);
}

static tl_status note_count(const solids *s, const char *object, const char *key, size_t count)
{
    return count ? s->host->note(s->host, object, key, (double)count, NULL) : TL_OK;
}

static tl_status note_object(const solids *s, uint32_t object, const char *name)
{
    const done *d = &s->done[object];
    tl_status status = note_count(s, name, "welded", d->welded);
    if (status == TL_OK)
        status = note_count(s, name, "collapsed", d->collapsed);
    if (status == TL_OK)
        status = note_count(s, name, "between", d->between);
    if (status == TL_OK)
        status = note_count(s, name, "merged", d->merged);
    if (status == TL_OK)
        status = note_count(s, name, "turned", d->turned);
    if (status == TL_OK)
        status = note_count(s, name, "inside_out", d->inside_out);
    if (status == TL_OK && d->shells > 1)
        status = note_count(s, name, "shells", d->shells);
    return status;
}

/* What the solids [from, to) of an object had done to them together. */
static tl_status note_solids(const solids *s, const char *name, size_t from, size_t to)
{
    size_t made_plane = 0, shared = 0, parts = 0;
    double move = 0;
    for (size_t i = from; i < to; i++) {
        made_plane += s->solid[i].made_plane;
        shared += s->solid[i].shared;
        parts += s->solid[i].parts;
        move = fmax(move, s->solid[i].move);
    }
    tl_status status = note_count(s, name, "made_plane", made_plane);
    if (status == TL_OK)
        status = note_count(s, name, "shared", shared);
    if (status == TL_OK && move > 0)
        status = s->host->note(s->host, name, "move", move, NULL);
    if (status == TL_OK && parts > to - from)
        status = note_count(s, name, "parts", parts);
    return status;
}

static tl_status note_whole(const solids *s, size_t blocks, size_t refused)
{
    const tl_host *h = s->host;
    const struct {
        const char *key;
        double number;
    } rows[] = {{"objects", (double)s->soup.objects},
                {"solids", (double)s->solids},
                {"blocks", (double)blocks},
                {"refused", (double)refused},
                {"weld", s->weld},
                {"flat", s->flat},
                {"made_plane", (double)s->made_plane},
                {"shared", (double)s->shared},
                {"move", s->largest_move},
                {"left_aside", (double)s->soup.unread},
                {"long_names", (double)s->soup.long_names}};
    tl_status status = TL_OK;
    for (size_t i = 0; i < sizeof rows / sizeof *rows && status == TL_OK; i++)
        status = h->note(h, NULL, rows[i].key, rows[i].number, NULL);
    return status;
}

static void say(const solids *s, size_t blocks, size_t refused)
{
    char name[NAME_TEXT], moved[160] = "", left[120] = "";
    if (s->made_plane > 0)
        tl_text_print(moved, sizeof moved, "; %zu faces made plane, by %.3g m at most, of '%s'", s->made_plane,
                      s->largest_move,
                      object_name(s, s->solid[s->moved_most].object, s->solid[s->moved_most].shell, name));
    if (refused || s->soup.unread)
        tl_text_print(left, sizeof left, "; %zu objects refused, %zu other commands left aside", refused,
                      s->soup.unread);
    s->host->log(s->host, "%zu blocks of %zu objects; weld = %.3g m (%s), flat = %.3g m (%s)%s; %zu faces shared%s",
                 blocks, s->soup.objects, s->weld, s->weld_from, s->flat, s->flat_from, moved, s->shared, left);
    if (s->soup.long_names)
        s->host->log(s->host, "%zu names of objects or groups are longer than %d letters; their ends are now a number",
                     s->soup.long_names, LONGEST_NAME);
}

tl_status report_write(solids *s, size_t blocks)
{
    char name[NAME_TEXT];
    size_t at = 0, refused = 0, r = 0;
    for (size_t i = 0; i < s->refusals; i++)
        refused += i == 0 || s->refusal[i].object != s->refusal[i - 1].object;
    tl_status status = note_whole(s, blocks, refused);
    for (uint32_t object = 0; object < s->soup.objects && status == TL_OK; object++) {
        size_t from = at;
        while (at < s->solids && s->solid[at].object == object)
            at++;
        const uint32_t shells = s->done[object].shells;
        s->done[object].shells = 1; /* the row is of the whole object */
        object_name(s, object, 0, name);
        s->done[object].shells = shells;
        status = note_object(s, object, name);
        if (status == TL_OK)
            status = note_solids(s, name, from, at);
        for (; r < s->refusals && s->refusal[r].object <= object; r++) {
            if (status == TL_OK)
                status = s->host->note(s->host, name, "refused", 0, s->refusal[r].reason);
            if (status == TL_OK && s->refusal[r].needs > 0)
                status = s->host->note(s->host, name, "needs_flat", s->refusal[r].needs, NULL);
        }
    }
    if (status == TL_OK)
        say(s, blocks, refused);
    return status;
}
