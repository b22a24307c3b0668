/* page.c - a page for a browser, frame by frame: tl_write_html.
 *
 * What a frame is made of tells scene.h; here it becomes an element of the page (docs/scene_format.md). The frames are in the
 * file only: a model remembers what a reader of the page knows, and how the file ended, so that it goes on with its own
 * page and with no other. */
#include "io/page.h"
#include "io/extra_fields.h"

#include "base/error.h"
#include "base/signals.h"
#include "io/json.h"
#include "io/output_file.h"
#include "io/pack.h"
#include "io/page_file.h"
#include "model/options.h"

#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- pages of a model ------- */

static void pages_destroy(tl_page *page)
{
    while (page) {
        tl_page *next = page->next;
        tl_scene_free(&page->scene);
        free(page->prefix);
        free(page);
        page = next;
    }
}

/* Finds or makes the page of a prefix; NULL when out of memory. */
static tl_page *page_of(tl_model *m, const char *prefix)
{
    tl_page *page = m->pages;
    while (page && strcmp(page->prefix, prefix) != 0)
        page = page->next;
    if (page)
        return page;
    page = calloc(1, sizeof *page);
    char *copy = page ? strdup(prefix) : NULL;
    if (!copy) {
        free(page);
        return NULL;
    }
    page->prefix = copy;
    page->next = m->pages;
    m->pages = page;
    m->pages_destroy = pages_destroy;
    return page;
}

bool tl_page_restore(tl_model *m, const char *prefix, tl_page_end end)
{
    tl_page *page = page_of(m, prefix);
    if (!page)
        return false;
    page->end = end;
    page->scene.sent.frames = (uint32_t)end.frames;
    page->restored = true;
    return true;
}

/* The name at the end of a prefix. */
static const char *name_of(const char *prefix)
{
    const char *slash = strrchr(prefix, '/');
    return slash ? slash + 1 : prefix;
}

/* ---------------------------------------------------------------- an element ------------- */

static void put_attribute(tl_piece *to, const char *name, double value)
{
    tl_json_put(to, " data-");
    tl_json_put(to, name);
    tl_json_put(to, "=\"");
    tl_json_number(to, value);
    tl_json_put(to, "\"");
}

/* The element of the next frame. */
static tl_status make_element(tl_model *m, tl_scene *scene, const tl_html *options,
                              tl_piece *element)
{
    tl_piece chunks = {0};
    tl_scene_facts facts;
    tl_status status = tl_scene_write(scene, m, options, &chunks, &facts);
    if (status == TL_OK)
        status = tl_output_go_on(m);
    if (status == TL_OK) {
        tl_json_put(element, "<script type=\"text/talus\"");
        put_attribute(element, "frame", scene->sent.frames);
        put_attribute(element, "bytes", (double)chunks.length);
        put_attribute(element, "time", facts.time);
        put_attribute(element, "cycle", (double)facts.cycle);
        put_attribute(element, "largest", facts.largest);
        put_attribute(element, "model", facts.news > 0);
        tl_json_put(element, ">");
        status = tl_pack(m, chunks.data, chunks.length, element);
    }
    free(chunks.data);
    if (status != TL_OK)
        return status;
    tl_json_put(element, "</script>\n");
    tl_page_pad(element);
    return element->failed ? tl_fail_memory(&m->error) : TL_OK;
}

/* ---------------------------------------------------------------- a frame ---------------- */

static tl_status check_length(tl_model *m, const tl_page *page, const char *path,
                              const tl_html *options, const tl_piece *element, uint64_t most)
{
    uint64_t at = page->end.frames ? page->end.at : 0;
    uint64_t length = tl_page_length(options->title, at, element);
    if (length <= most)
        return TL_OK;
    return tl_fail(&m->error, TL_E_ARGUMENT,
                   "write_html: with frame %llu '%s' would have %.1f MB, and a page has %.0f MB at "
                   "the most; write frames less often, leave out contacts, or go on under another "
                   "name",
                   (unsigned long long)page->end.frames, path, (double)length / 1e6,
                   (double)most / 1e6);
}

/* Whether the page goes on; else it begins anew. */
static bool goes_on(const tl_page *page, tl_page_stand stand)
{
    return page->end.frames &&
           (stand == TL_PAGE_WHOLE || (stand == TL_PAGE_LONGER && page->restored));
}

static tl_status add_frame(tl_model *m, tl_page *page, const char *path, const tl_html *options,
                           uint64_t most)
{
    tl_page_stand stand = page->end.frames ? tl_page_look(path, &page->end) : TL_PAGE_GONE;
    if (!goes_on(page, stand)) {
        tl_scene_free(&page->scene);
        page->end = (tl_page_end){0};
    }
    tl_piece element = {0};
    tl_status status = make_element(m, &page->scene, options, &element);
    if (status == TL_OK)
        status = check_length(m, page, path, options, &element, most);
    if (status == TL_OK)
        status = tl_output_go_on(m);
    if (status == TL_OK)
        status = page->end.frames ? tl_page_add(m, path, stand, &element, &page->end)
                                  : tl_page_begin(m, path, options->title, &element, &page->end);
    free(element.data);
    if (status != TL_OK)
        return status;
    page->end.frames++;
    page->restored = false;
    tl_scene_accept(&page->scene);
    return TL_OK;
}

/* ---------------------------------------------------------------- what was asked --------- */

static tl_status check(const char *prefix, const tl_html *options, tl_error *error)
{
    size_t length = strlen(prefix);
    if (length == 0 || prefix[length - 1] == '/')
        return tl_fail(error, TL_E_ARGUMENT,
                       "write_html: prefix = '%s' must end in a name for the page, as in 'out/run'",
                       prefix);
    if (options->contacts < TL_HTML_CONTACTS_FEW || options->contacts > TL_HTML_CONTACTS_NONE)
        return tl_fail(error, TL_E_ARGUMENT,
                       "write_html: contacts = %d must be one of tl_html_contacts, 0 to %d",
                       options->contacts, TL_HTML_CONTACTS_NONE);
    tl_status status = tl_extra_fields_check("write_html: block_fields", options->block_fields,
                                             options->block_field_count, TL_ANY_ITEMS, "", error);
    if (status == TL_OK)
        status = tl_extra_fields_check("write_html: contact_fields", options->contact_fields,
                                       options->contact_field_count, TL_ANY_ITEMS, "", error);
    return status;
}

tl_status tl_page_write(tl_model *m, const char *prefix, const tl_html *given, uint64_t most)
{
    tl_html options;
    tl_status status = TL_OPTIONS_READ(tl_html, given, &options, &m->error);
    if (status == TL_OK)
        status = check(prefix, &options, &m->error);
    if (status != TL_OK)
        return status;
    char *own = tl_output_prefix(prefix, ".html"), *path = NULL;
    tl_page *page = own ? page_of(m, own) : NULL;
    if (page && (path = malloc(strlen(own) + sizeof ".html"))) {
        strcpy(path, own);
        strcat(path, ".html");
        options.title = options.title ? options.title : name_of(own);
        sigset_t before;
        tl_signals_hold(&before, false);
        atomic_store(&m->interrupted, false);
        status = add_frame(m, page, path, &options, most);
        tl_signals_release(&before);
    } else {
        status = tl_fail_memory(&m->error);
    }
    if (status == TL_E_IO)
        tl_error_prefix(&m->error, "write_html: ");
    free(path);
    free(own);
    return status;
}

tl_status tl_write_html(tl_model *m, const char *prefix, const tl_html *options)
{
    return tl_page_write(m, prefix, options, TL_PAGE_MOST);
}
