/* help.c - `talus help` and `talus plugins`. They are printed from the tables that check what a script gives,
 * so the help cannot say otherwise than the check. */
#define _GNU_SOURCE /* strcasestr */
#include "lua/help.h"

#include "lua/contact.h"
#include "lua/fail.h"
#include "lua/topics.h"

#include <stdio.h>
#include <string.h>
#include <talus/fields.h>

#define WIDTH 88
#define NAME_COLUMNS 18
/* A word of so many letters with another first one is not a misspelt name. */
#define SHORT 4

/* Prints a text from column `indent` on, broken at spaces; the cursor is at column `at`. */
static void print_wrapped(const char *text, int indent, int at)
{
    bool first = true;
    while (*text) {
        int length = (int)strcspn(text, " ");
        if (!first && at + 1 + length > WIDTH) {
            putchar('\n');
            at = 0;
            first = true;
        }
        int gap = first ? indent - at : 1;
        at += printf("%*s%.*s", gap > 0 ? gap : 0, "", length, text);
        text += length + (text[length] == ' ');
        first = false;
    }
    putchar('\n');
}

/* A name in its column, and a text beside it. */
static void print_row(const char *name, const char *text)
{
    int at = printf("  %-*s", NAME_COLUMNS, name);
    if (strlen(name) >= NAME_COLUMNS) {
        putchar('\n');
        at = 0;
    }
    print_wrapped(text, NAME_COLUMNS + 2, at);
}

/* ---------------------------------------------------------------- rows of a page ---------- */

/* A row of a page: a name, what it is, and what it is for. A heading has only itself. */
typedef struct row {
    const char *heading;
    const char *name, *alias; /* alias: another name, or NULL */
    const char *type, *doc;   /* type: "" where there is none */
} row;

/* What is done with each row of a page. */
typedef void (*row_call)(const row *r, void *user);

static void default_text(const tl_param *param, char *text, size_t size)
{
    const double *d = param->def;
    if (param->flags & TL_PARAM_REQUIRED)
        snprintf(text, size, "required");
    else if (param->flags & TL_PARAM_OPTIONAL || param->type == TL_PARAM_POINTS)
        snprintf(text, size, "may be left out");
    else if (param->type == TL_PARAM_BOOL)
        snprintf(text, size, "default %s", d[0] != 0.0 ? "true" : "false");
    else if (param->type == TL_PARAM_ENUM)
        snprintf(text, size, "default \"%s\"", param->choices[(int)d[0]]);
    else if (param->type == TL_PARAM_VEC3)
        tl_text_print(text, size, "default {%g, %g, %g}", d[0], d[1], d[2]);
    else if (param->type == TL_PARAM_STRING)
        snprintf(text, size, "default \"%s\"", param->def_text ? param->def_text : "");
    else
        tl_text_print(text, size, "default %.10g", d[0]);
}

/* "number, deg, in [0, 90), default 0", or the choices of an enum. */
static void type_text(const tl_param *param, char *text, size_t size)
{
    static const char *const types[] = {"number", "whole number",   "true or false",  "one of",
                                        "vector", "text in quotes", "list of vectors"};
    char range[80] = "", given[120];
    bool flat = param->type == TL_PARAM_POINTS && param->flags & TL_PARAM_FLAT;
    size_t n = (size_t)snprintf(text, size, "%s", flat ? "list of {number, number}" : types[param->type]);
    for (size_t i = 0; param->type == TL_PARAM_ENUM && param->choices[i] && n < size; i++)
        n += (size_t)snprintf(text + n, size - n, "%s \"%s\"", i ? "," : "", param->choices[i]);
    tl_param_range(param, range, sizeof range);
    default_text(param, given, sizeof given);
    bool interval = range[0] == '[' || range[0] == '(';
    if (n < size)
        snprintf(text + n, size - n, "%s%s%s%s%s, %s", param->unit && param->unit[0] ? ", " : "",
                 param->unit ? param->unit : "", range[0] ? ", " : "", interval ? "in " : "", range, given);
}

static void walk_params(const tl_param *params, size_t count, row_call call, void *user)
{
    for (size_t i = 0; i < count; i++) {
        char text[400];
        type_text(&params[i], text, sizeof text);
        call(&(row){NULL, params[i].name, params[i].alias, text, params[i].doc}, user);
    }
}

static void walk_keys(const tl_lua_key *keys, row_call call, void *user)
{
    for (; keys && keys->name; keys++)
        call(&(row){NULL, keys->name, NULL, keys->type, keys->doc}, user);
}

/* ---------------------------------------------------------------- functions -------------- */

static const char *topic_doc(const tl_lua_topic *topic)
{
    const char *doc = topic->doc;
    if (topic->function)
        tl_function_params(topic->function, NULL, &doc);
    return doc;
}

/* What a field is as Lua sees it: push_field of item.c. */
static const char *const field_types[] = {[TL_FIELD_SCALAR] = "number",
                                          [TL_FIELD_COUNT] = "whole number",
                                          [TL_FIELD_BOOL] = "true or false",
                                          [TL_FIELD_VEC3] = "vector",
                                          [TL_FIELD_QUAT] = "list of 4 numbers",
                                          [TL_FIELD_SYM3] = "{xx =, yy =, zz =, xy =, yz =, zx =}",
                                          [TL_FIELD_TEXT] = "text",
                                          [TL_FIELD_IDS] = "list of 2 blocks"};

static void walk_fields(const char *item, const tl_field *(*list)(size_t *count), row_call call, void *user)
{
    size_t count;
    const tl_field *fields = list(&count);
    char text[80];
    snprintf(text, sizeof text, "Fields of a %s:", item);
    call(&(row){.heading = text}, user);
    for (size_t i = 0; i < count; i++) {
        bool unit = fields[i].unit && fields[i].unit[0];
        snprintf(text, sizeof text, "%s%s%s", field_types[fields[i].kind], unit ? ", " : "",
                 unit ? fields[i].unit : "");
        call(&(row){NULL, fields[i].name, NULL, text, fields[i].doc}, user);
    }
}

static const char *plugin_word(tl_kind_type type)
{
    static const char *const words[] = {"law", "damping", "generator", "screen", "solid", "element"};
    return words[type];
}

/* The rows of the page of a function. */
static void walk_topic(const tl_lua_topic *topic, row_call call, void *user)
{
    tl_lua_spec spec = tl_lua_topic_spec(topic);
    if (spec.count || spec.keys)
        call(&(row){.heading = "Parameters:"}, user);
    walk_params(spec.params, spec.count, call, user);
    walk_keys(spec.keys, call, user);
    if (topic->kind) {
        walk_fields(topic->kind->item, topic->kind->fields, call, user);
        walk_keys(topic->kind->extra_keys, call, user);
    }
    if (topic->kind == &tl_lua_contact_kind)
        walk_fields("contact point", tl_point_fields, call, user);
    if (topic->verbs) {
        char title[80];
        snprintf(title, sizeof title, "%s:", topic->title);
        call(&(row){.heading = title}, user);
        walk_keys(topic->verbs, call, user);
    }
}

/* The rows of the page of a plugin. */
static void walk_kind(const tl_kind *kind, row_call call, void *user)
{
    if (kind->param_count)
        call(&(row){.heading = "Parameters:"}, user);
    walk_params(kind->params, kind->param_count, call, user);
    if (kind->state_count)
        call(&(row){.heading = kind->type == TL_KIND_LAW     ? "States of a contact point:"
                               : kind->type == TL_KIND_SOLID ? "States of a zone:"
                                                             : "States:"},
             user);
    for (uint32_t i = 0; i < kind->state_count; i++)
        call(&(row){NULL, kind->states[i].name, NULL, "", kind->states[i].doc}, user);
}

/* ---------------------------------------------------------------- printed pages ----------- */

static void print_called(const row *r, void *user)
{
    (void)user;
    if (r->heading) {
        printf("\n%s\n", r->heading);
        return;
    }
    char name[80];
    const char *doc = r->doc ? r->doc : "";
    snprintf(name, sizeof name, "%s%s%s", r->name, r->alias ? ", " : "", r->alias ? r->alias : "");
    print_row(name, r->type[0] ? r->type : doc);
    if (r->type[0])
        print_wrapped(doc, NAME_COLUMNS + 2, 0);
}

static void print_kinds(tl_kind_type type)
{
    const tl_kind *kind;
    for (size_t i = 0; (kind = tl_plugin_kind(type, i)) != NULL; i++)
        print_row(kind->name, kind->doc);
}

static void print_topic(const tl_lua_topic *topic)
{
    printf("%s\n", topic->usage);
    print_wrapped(topic_doc(topic), 2, 0);
    walk_topic(topic, print_called, NULL);
    if (topic->has_type) {
        printf("\nThe %ss loaded (talus help NAME tells their parameters):\n", plugin_word(topic->type));
        print_kinds(topic->type);
    }
}

static void print_kind(const tl_kind *kind)
{
    printf("%s '%s'\n", plugin_word((tl_kind_type)kind->type), kind->name);
    print_wrapped(kind->doc, 2, 0);
    walk_kind(kind, print_called, NULL);
}

static void print_overview(void)
{
    printf("Talus %s: three-dimensional distinct elements for jointed rock\n\n", TALUS_VERSION);
    puts("  talus SCRIPT.lua [ARGUMENT...]   run a script\n"
         "  talus run [--autosave MINUTES] [--resume] SCRIPT.lua [ARGUMENT...]\n"
         "                                   the same, saved as it goes: talus help resumed\n"
         "  talus convert [--up y] FILE [SCRIPT.lua]\n"
         "                                   write a data file of 3DEC as a script; talus run FILE.3ddat runs it\n"
         "  talus                            type Lua line by line\n"
         "  talus -e CHUNK                   run a piece of Lua\n"
         "  talus help [TOPIC]               this page, a function, or a plugin\n"
         "  talus plugins                    what is loaded, and what was refused and why\n"
         "  talus new law|damping|generator|solid|element NAME [FOLDER]\n"
         "                                   a folder with a plugin to change, that builds and "
         "works\n"
         "  talus check FILE.so [NAME=VALUE...]\n"
         "                                   whether a plugin keeps the rules that plugins must "
         "keep\n"
         "  talus --version                  version, plugin interface, compiler, build\n"
         "\n"
         "  --threads N      threads of a model that does not say itself\n"
         "  --quiet          no progress line and no remarks\n"
         "  --plugin PATH    load one more plugin\n"
         "  -v               show the calls that led to an error\n"
         "\nFunctions:");
    const tl_lua_topic *topic;
    for (size_t k = 0; (topic = tl_lua_topic_at(k)) != NULL; k++)
        print_row(topic->name, topic_doc(topic));
    for (int type = TL_KIND_LAW; type <= TL_KIND_ELEMENT; type++) {
        static const char *const titles[] = {"Laws", "Dampings", "Generators", "Screens", "Solids", "Elements"};
        printf("\n%s:\n", titles[type]);
        print_kinds((tl_kind_type)type);
    }
}

/* ---------------------------------------------------------------- the nearest page --------
 *
 * Which pages of the help speak of a word that is the name of none. */

/* Whether a text has the word, in any letters. */
static bool says(const char *text, const char *word)
{
    return text && strcasestr(text, word);
}

/* A word that is looked for, and whether a page has it. */
typedef struct sought {
    const char *word;
    bool said;
} sought;

static void seek_word(const row *r, void *user)
{
    sought *s = user;
    s->said = s->said || says(r->name, s->word) || says(r->doc, s->word);
}

static bool topic_says(const tl_lua_topic *topic, const char *word)
{
    sought s = {word, says(topic->usage, word) || says(topic_doc(topic), word)};
    walk_topic(topic, seek_word, &s);
    return s.said;
}

static bool kind_says(const tl_kind *kind, const char *word)
{
    sought s = {word, says(kind->doc, word)};
    walk_kind(kind, seek_word, &s);
    return s.said;
}

/* Whether the word is a verb of what the page is of. */
static bool names_verb(const tl_lua_topic *topic, const char *word)
{
    const size_t length = strlen(word);
    for (const tl_lua_key *key = topic->verbs; key && key->name; key++)
        for (const char *at = strchr(key->name, ':'); at; at = strchr(at + 1, ':'))
            if (strncmp(at + 1, word, length) == 0 && (at[1 + length] == '(' || at[1 + length] == '{'))
                return true;
    return false;
}

/* ---------------------------------------------------------------- entry ------------------ */

/* Names of pages, one after the other. */
typedef struct page_list {
    char text[160];
    size_t count;
} page_list;

/* Adds a page, while there is room for it and three dots. */
static void list_page(page_list *pages, const char *name)
{
    size_t length = strlen(pages->text), room = sizeof pages->text - length;
    bool fits = strlen(", ") + strlen(name) + sizeof ", ..." <= room;
    if (strcmp(pages->text + (length < 3 ? 0 : length - 3), "...") == 0)
        return;
    snprintf(pages->text + length, room, "%s%s", length ? ", " : "", fits ? name : "...");
    pages->count++;
}

/* Tells of a word that is the name of no page: the nearest name, or the pages that speak of it. */
static bool unknown_topic(const char *word, tl_error *error)
{
    tl_lua_names names = {0};
    page_list pages = {0}, verbs = {0}; /* that speak of it; whose verb it is */
    const tl_lua_topic *topic;
    for (size_t k = 0; (topic = tl_lua_topic_at(k)) != NULL; k++) {
        tl_lua_names_add(&names, topic->name);
        if (names_verb(topic, word))
            list_page(&verbs, topic->name);
        if (topic_says(topic, word))
            list_page(&pages, topic->name);
    }
    for (int type = TL_KIND_LAW; type <= TL_KIND_ELEMENT; type++) {
        const tl_kind *kind;
        for (size_t i = 0; (kind = tl_plugin_kind((tl_kind_type)type, i)) != NULL; i++) {
            tl_lua_names_add(&names, kind->name);
            if (kind_says(kind, word))
                list_page(&pages, kind->name);
        }
    }
    if (verbs.count > 0)
        pages = verbs;
    const char *nearest = tl_nearest_name(word, names.at, names.count);
    size_t length = strlen(word), other = nearest ? strlen(nearest) : 0;
    bool misspelt = nearest && !verbs.count && strncmp(word, nearest, length < other ? length : other) == 0;
    error->status = TL_E_NOT_FOUND;
    if (misspelt || (nearest && pages.count == 0 && (length > SHORT || word[0] == nearest[0])))
        snprintf(error->text, sizeof error->text, "there is no help on '%s'; did you mean '%s'?", word, nearest);
    else if (pages.count > 0)
        snprintf(error->text, sizeof error->text, "there is no page '%s'; these speak of it (talus help NAME): %s",
                 word, pages.text);
    else
        snprintf(error->text, sizeof error->text,
                 "there is no help on '%s', and no page speaks of it; `talus help` lists all", word);
    return false;
}

bool tl_lua_help(const char *word, tl_error *error)
{
    int found = 0;
    if (!word) {
        print_overview();
        return true;
    }
    const tl_lua_topic *topic;
    for (size_t k = 0; (topic = tl_lua_topic_at(k)) != NULL; k++)
        if (strcmp(topic->name, word) == 0 && ++found)
            print_topic(topic);
    for (int type = TL_KIND_LAW; type <= TL_KIND_ELEMENT; type++) {
        const tl_kind *kind = tl_plugin_find((tl_kind_type)type, word);
        if (kind && found++)
            putchar('\n');
        if (kind)
            print_kind(kind);
    }
    return found || unknown_topic(word, error);
}

void tl_lua_help_plugins(void)
{
    size_t count = tl_plugin_record_count(), refused = 0;
    for (size_t i = 0; i < count; i++) {
        tl_plugin_record record = tl_plugin_record_at(i);
        if (!record.plugin) {
            refused++;
            continue;
        }
        printf("%s %s  %s\n", record.plugin->id, record.plugin->version, record.path);
        for (uint32_t k = 0; k < record.plugin->kind_count; k++) {
            const tl_kind *kind = &record.plugin->kinds[k];
            printf("    %s '%s'\n", plugin_word((tl_kind_type)kind->type), kind->name);
        }
        if (record.note)
            printf("    note: %s\n", record.note);
    }
    if (count == refused)
        puts("No plugin is loaded; set TALUS_PLUGIN_PATH to the folder they are in.");
    for (size_t i = 0; i < count && refused; i++) {
        tl_plugin_record record = tl_plugin_record_at(i);
        if (!record.plugin)
            printf("%s: %s: %s\n", record.reason ? "refused" : "note", record.path,
                   record.reason ? record.reason : record.note);
    }
}
