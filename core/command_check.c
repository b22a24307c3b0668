/* command_check.c - `talus check FILE.so [NAME=VALUE...]`: the conformance check of a plugin, told line by line. */
#include "commands.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/check.h>
#include <talus/number.h>

#define USAGE                                                                                                          \
    "talus: usage: talus check FILE.so [NAME=VALUE...]\n"                                                              \
    "Tries each law, damping, generator, screen and solid of the file, with its defaults, the values\n"                \
    "given and drawn ones: a number, true, false, a list as 1,2,3, points as 0,0,0;1,0,0, tables as\n"                 \
    "0,1;2,3 or a text.\n"

/* Numbers of a list. */
#define MOST_NUMBERS 64

/* A value with the room that its key and its list need. */
typedef struct word {
    char key[64];
    double numbers[MOST_NUMBERS];
} word;

/* Reads "1,2,3", or "0,0,0;1,0,0" in rows; the count, or 0 when the text is something else. Rows of two, "0,1;2,3", are
 * those of a table, `*flat`, and get a third number, 0. */
static size_t read_numbers(const char *text, double *numbers, bool *flat)
{
    const char *row = strchr(text, ';'), *comma = strchr(text, ',');
    size_t count = 0;
    *flat = row && comma && comma < row && !memchr(comma + 1, ',', (size_t)(row - comma - 1));
    while (count < MOST_NUMBERS) {
        const char *end;
        numbers[count] = tl_number_read(text, &end);
        count++;
        if (*flat && count % 3 == 2 && count < MOST_NUMBERS)
            numbers[count++] = 0;
        if (end == text || (*end && *end != ',' && *end != ';') || (*end == ';' && count % 3 != 0))
            return 0;
        if (!*end)
            return count;
        text = end + 1;
    }
    return 0;
}

static bool read_word(const char *text, word *w, tl_value *value)
{
    const char *equals = strchr(text, '=');
    if (!equals || equals == text || (size_t)(equals - text) >= sizeof w->key)
        return tl_command_fail("check: '%s' is not NAME=VALUE", text);
    memcpy(w->key, text, (size_t)(equals - text));
    w->key[equals - text] = '\0';
    bool flat;
    size_t count = read_numbers(equals + 1, w->numbers, &flat);
    if (count == 1)
        *value = tl_arg_number(w->key, w->numbers[0]);
    else if (count > 1 && !strchr(equals, ';'))
        *value = tl_arg_numbers(w->key, w->numbers, count);
    else if (count > 1 && count % 3 == 0) {
        *value = tl_arg_numbers(w->key, w->numbers, count / 3);
        value->type = flat ? TL_VALUE_FLAT : TL_VALUE_POINTS;
    } else if (strcmp(equals + 1, "true") == 0 || strcmp(equals + 1, "false") == 0)
        *value = tl_arg_bool(w->key, equals[1] == 't');
    else
        *value = tl_arg_text(w->key, equals + 1);
    return true;
}

typedef struct listing {
    const tl_kind *kind; /* whose heading was written last */
    size_t checks;
} listing;

static void tell(void *user, const tl_check_finding *f)
{
    static const char *const types[] = {"law", "damping", "generator", "screen", "solid", "element"};
    listing *list = user;
    if (list->kind != f->kind) {
        const char *path;
        const tl_plugin *plugin = tl_plugin_of(f->kind, &path);
        printf("%s '%s' of plugin '%s' (%s)\n", types[f->kind->type], f->kind->name, plugin ? plugin->id : "",
               path ? path : "");
        list->kind = f->kind;
    }
    list->checks++;
    printf("  %-6s %-13s %s\n", f->fault ? "FAULT" : "ok", f->check, f->doc);
    if (f->fault)
        printf("         %s\n", f->fault);
}

int tl_command_check(int argc, char **argv)
{
    if (argc < 1) {
        fputs(USAGE, stderr);
        return EXIT_FAILURE;
    }
    int given = argc - 1;
    word *words = calloc((size_t)given + 1, sizeof *words);
    tl_value *values = calloc((size_t)given + 1, sizeof *values);
    bool readable = words && values;
    for (int i = 0; i < given && readable; i++)
        readable = read_word(argv[i + 1], &words[i], &values[i]);
    tl_error error = {TL_OK, "out of memory"};
    listing list = {NULL, 0};
    size_t faults = 0;
    const tl_args args = {values, (size_t)given};
    tl_status status = TL_E_ARGUMENT;
    if (readable) {
        status = tl_plugin_check(argv[0], &args, tell, &list, &faults, &error);
        if (status == TL_OK)
            printf("%zu checks, %zu fault%s\n", list.checks, faults, faults == 1 ? "" : "s");
        else
            tl_command_fail("check: %s%s", error.text,
                            status == TL_E_ARGUMENT ? "; values are given as NAME=VALUE" : "");
    }
    free(words);
    free(values);
    return status == TL_OK && faults == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
