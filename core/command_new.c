/* command_new.c - `talus new law|damping|generator|solid|element NAME [FOLDER]`: a plugin that builds and works.
 *
 * The files are those of share/talus/templates/TYPE of an installation, or of templates/TYPE beside the program of a
 * build. NAME stands in the place of my_TYPE in names and texts. */
#define _GNU_SOURCE /* realpath */
#include "commands.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <talus/plugins.h>
#include <unistd.h>

#define USAGE                                                                                                          \
    "talus: usage: talus new law|damping|generator|solid|element NAME [FOLDER]\n"                                      \
    "Writes a plugin that builds and works into the new folder FOLDER, or NAME: CMakeLists.txt,\n"                     \
    "NAME.c, test_NAME.lua and README.md.\n"

/* Longest name: it becomes names of files and targets. */
#define MOST_NAME 60
/* Bytes of the longest template. */
#define MOST_TEXT (1 << 16)

/* Types that have a template; NULL: one that has none. */
static const char *const types[] = {[TL_KIND_LAW] = "law",
                                    [TL_KIND_DAMPING] = "damping",
                                    [TL_KIND_GENERATOR] = "generator",
                                    [TL_KIND_SOLID] = "solid",
                                    [TL_KIND_ELEMENT] = "element"};

typedef struct project {
    tl_kind_type type;
    const char *name, *folder;
    char word[24];            /* my_law */
    char templates[PATH_MAX]; /* folder of the type's */
    char prefix[PATH_MAX];    /* where Talus is installed; "": not installed */
} project;

/* ---------------------------------------------------------------- what is asked for ------ */

static bool read_type(const char *word, tl_kind_type *type)
{
    for (int i = 0; i <= TL_KIND_ELEMENT; i++)
        if (types[i] && strcmp(word, types[i]) == 0) {
            *type = (tl_kind_type)i;
            return true;
        }
    return tl_command_fail("new: '%s' is not law, damping, generator, solid or element", word);
}

/* A name of a kind, that no kind has, and that CMake lets a target have. */
static bool check_name(tl_kind_type type, const char *name)
{
    static const char *const taken[] = {"all",     "test",  "help",       "clean",         "install",
                                        "package", "check", "edit_cache", "rebuild_cache", "m"};
    size_t length = strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789_");
    if (!islower((unsigned char)name[0]) || name[length] || length > MOST_NAME)
        return tl_command_fail("new: the name '%s' must be small letters, digits and _, up to 60, and begin with a "
                               "letter",
                               name);
    for (size_t i = 0; i < sizeof taken / sizeof *taken; i++)
        if (strcmp(name, taken[i]) == 0)
            return tl_command_fail("new: the name '%s' means something else to CMake or to the plugin", name);
    if (tl_plugins_load_default() != TL_OK)
        return tl_command_fail("new: out of memory while the plugins are loaded");
    if (tl_plugin_find(type, name))
        return tl_command_fail("new: a %s '%s' is there already; take another name", types[type], name);
    return true;
}

static bool is_folder(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

/* Where the templates are, seen from the program's own file. */
static bool find_templates(project *p)
{
    static const char *const places[] = {"/templates", "/../share/talus/templates"};
    char here[PATH_MAX], file[PATH_MAX + 64];
    ssize_t length = readlink("/proc/self/exe", here, sizeof here - 1);
    char *slash = NULL;
    if (length > 0) {
        here[length] = '\0';
        slash = strrchr(here, '/');
    }
    if (slash)
        *slash = '\0';
    for (size_t i = 0; slash && i < sizeof places / sizeof *places; i++) {
        snprintf(file, sizeof file, "%s%s/%s", here, places[i], types[p->type]);
        if (!is_folder(file) || !realpath(file, p->templates))
            continue;
        snprintf(file, sizeof file, "%s/../lib/cmake/talus", here);
        if (is_folder(file)) {
            snprintf(file, sizeof file, "%s/..", here);
            if (!realpath(file, p->prefix))
                p->prefix[0] = '\0';
        }
        return true;
    }
    return tl_command_fail("new: the templates are in none of the places known from %s", slash ? here : "the program");
}

/* ---------------------------------------------------------------- writing ---------------- */

/* A text with NAME in the place of my_TYPE. */
static void write_filled(const project *p, const char *text, FILE *to)
{
    size_t length = strlen(p->word);
    const char *next;
    while ((next = strstr(text, p->word)) != NULL) {
        fwrite(text, 1, (size_t)(next - text), to);
        fputs(p->name, to);
        text = next + length;
    }
    fputs(text, to);
}

/* The path of a file in the new folder; `pattern` has a %s where the name comes. */
static void place_of(const char *folder, const char *pattern, const char *name, char path[PATH_MAX + 128])
{
    const char *at = strstr(pattern, "%s");
    int before = at ? (int)(at - pattern) : (int)strlen(pattern);
    snprintf(path, PATH_MAX + 128, "%s/%.*s%s%s", folder, before, pattern, at ? name : "", at ? at + 2 : "");
}

/* talus.write_file(path, text) */
static bool write_file(const project *p, const char *pattern)
{
    char from[PATH_MAX + 128], to[PATH_MAX + 128];
    char *text = calloc(1, MOST_TEXT);
    place_of(p->templates, pattern, p->word, from);
    place_of(p->folder, pattern, p->name, to);
    FILE *in = text ? fopen(from, "rb") : NULL;
    size_t bytes = in ? fread(text, 1, MOST_TEXT - 1, in) : 0;
    int whole = in && bytes > 0 && !ferror(in) && feof(in);
    if (in)
        fclose(in);
    if (!whole) {
        free(text);
        return tl_command_fail("new: the template %s cannot be read", from);
    }
    FILE *out = fopen(to, "wbx");
    if (!out) {
        free(text);
        return tl_command_fail("new: %s cannot be written: %s", to, strerror(errno));
    }
    write_filled(p, text, out);
    free(text);
    int written = !ferror(out);
    written = fclose(out) == 0 && written;
    return written || tl_command_fail("new: %s cannot be written", to);
}

static const char *const patterns[] = {"CMakeLists.txt", "%s.c", "test_%s.lua", "README.md"};
enum { FILES = sizeof patterns / sizeof *patterns };

/* All files or none. */
static bool write_project(const project *p)
{
    char path[PATH_MAX + 128];
    if (mkdir(p->folder, 0777) != 0)
        return tl_command_fail("new: the folder %s cannot be made: %s", p->folder, strerror(errno));
    int written = 0;
    while (written < FILES && write_file(p, patterns[written]))
        written++;
    if (written == FILES)
        return true;
    for (int i = 0; i <= written; i++) {
        place_of(p->folder, patterns[i], p->name, path);
        unlink(path);
    }
    rmdir(p->folder);
    return false;
}

/* A name as a shell takes it for one word. */
static void print_word(const char *text)
{
    bool plain = text[strcspn(text, " \t\n\"'\\$`!&|;<>()[]{}*?#~")] == '\0';
    if (plain) {
        fputs(text, stdout);
        return;
    }
    putchar('\'');
    for (; *text; text++)
        *text == '\'' ? fputs("'\\''", stdout) : putchar(*text);
    putchar('\'');
}

/* A line for the shell, with names in the places of %s. */
static void print_command(const char *format, const char *a, const char *b)
{
    const char *names[] = {a, a, b};
    size_t next = 0;
    for (const char *c = format; *c; c++)
        if (*c == '%' && next < 3) {
            print_word(names[next++]);
            c++;
        } else {
            putchar(*c);
        }
}

static void tell_next(const project *p)
{
    printf("made %s:\n", p->folder);
    for (int i = 0; i < FILES; i++) {
        char path[PATH_MAX + 128];
        place_of(p->folder, patterns[i], p->name, path);
        printf("  %s\n", path);
    }
    if (!p->prefix[0])
        printf("To build it, install Talus first: cmake --install BUILD --prefix PREFIX\n");
    puts("Next:");
    print_command("  cmake -S %s -B %s/build -DCMAKE_PREFIX_PATH=%s\n", p->folder, p->prefix[0] ? p->prefix : "PREFIX");
    print_command("  cmake --build %s/build\n", p->folder, "");
    print_command("  ctest --test-dir %s/build --output-on-failure\n", p->folder, "");
}

int tl_command_new(int argc, char **argv)
{
    project p = {.type = TL_KIND_LAW};
    if (argc < 2 || argc > 3) {
        fputs(USAGE, stderr);
        return EXIT_FAILURE;
    }
    p.name = argv[1];
    p.folder = argc > 2 ? argv[2] : argv[1];
    if (!read_type(argv[0], &p.type) || !check_name(p.type, p.name))
        return EXIT_FAILURE;
    if (strlen(p.folder) >= PATH_MAX || p.folder[0] == '\0') {
        tl_command_fail("new: the name of the folder is %s", p.folder[0] ? "too long" : "empty");
        return EXIT_FAILURE;
    }
    snprintf(p.word, sizeof p.word, "my_%s", types[p.type]);
    if (!find_templates(&p) || !write_project(&p))
        return EXIT_FAILURE;
    tell_next(&p);
    return EXIT_SUCCESS;
}
