/* fab.c - fractures of a .fab file of FracMan (text).
 *
 *     BEGIN FORMAT                  BEGIN FRACTURE
 *         Format = Ascii                1 4 1 1e-7          number, corners, set, properties
 *         XAxis = East                  1 0.0 0.0 0.0       number of the corner, x, y, z
 *         Length_Unit = Meter           ... 4 corners in all
 *     END FORMAT                        0 0.0 0.0 1.0       a normal, which is passed over
 *                                   END FRACTURE
 *
 * Other sections are passed over. A polygon becomes the disc of its area about its centroid, in the plane of its area
 * vector. */
#include "discs.h"

#include <string.h>

/* Limits: corners of a fracture; letters of a word; coordinate, m. */
#define MOST_CORNERS 10000
#define MOST_LETTERS 63
#define FARTHEST 1e9

typedef struct reader {
    const tl_host *host;
    const char *file;
    const char *at;
    discs *all;
    tl_vec3 *corner;
    size_t capacity;
} reader;

/* The next word of the line; false at its end. */
static bool next_word(reader *r, char word[MOST_LETTERS + 1])
{
    size_t length = 0;
    while (*r->at == ' ' || *r->at == '\t' || *r->at == '\r' || *r->at == '=')
        r->at++;
    while (*r->at && !strchr(" \t\r\n=", *r->at)) {
        if (length < MOST_LETTERS)
            word[length++] = *r->at >= ' ' && *r->at <= '~' ? *r->at : '?';
        r->at++;
    }
    word[length] = '\0';
    return length > 0;
}

/* Goes to the next line that is not empty; false at the end. */
static bool next_line(reader *r)
{
    for (;;) {
        r->at += strcspn(r->at, "\n");
        if (!*r->at)
            return false;
        r->at++;
        r->all->line++;
        const char *first = r->at + strspn(r->at, " \t\r");
        if (*first && *first != '\n')
            return true;
    }
}

static bool word_is(const char *given, const char *word)
{
    for (; *given && *word; given++, word++)
        if ((*given >= 'A' && *given <= 'Z' ? *given - 'A' + 'a' : *given) != *word)
            return false;
    return !*given && !*word;
}

/* Reads a number; `what` in the sentence. */
static tl_status next_number(reader *r, const char *what, double *number)
{
    char word[MOST_LETTERS + 1];
    const char *end = word;
    if (!next_word(r, word))
        return r->host->fail(r->host, TL_E_ARGUMENT, "file '%.200s', line %zu: %s is missing", r->file, r->all->line,
                             what);
    *number = tl_number_read(word, &end);
    if (end == word || *end || !(fabs(*number) <= FARTHEST))
        return r->host->fail(r->host, TL_E_ARGUMENT, "file '%.200s', line %zu: %s '%s' is no number within 1e9",
                             r->file, r->all->line, what, word);
    return TL_OK;
}

/* The disc of a polygon: about its middle m, area vector A = sum (a - m) x (b - m) / 2, centroid m + sum |.| (...). */
static tl_status add_polygon(reader *r, size_t count, size_t line)
{
    const tl_vec3 origin = r->corner[0];
    tl_vec3 twice = {0, 0, 0}, moment = {0, 0, 0};
    for (size_t i = 1; i + 1 < count; i++)
        twice = tl_v3_add(twice, tl_v3_cross(tl_v3_sub(r->corner[i], origin), tl_v3_sub(r->corner[i + 1], origin)));
    const double size = tl_v3_norm(twice);
    if (!(size > 0))
        return r->host->fail(r->host, TL_E_GEOMETRY, "file '%.200s', line %zu: the %zu corners enclose no area",
                             r->file, line, count);
    const tl_vec3 normal = tl_v3_unit(twice);
    for (size_t i = 1; i + 1 < count; i++) {
        const tl_vec3 a = tl_v3_sub(r->corner[i], origin), b = tl_v3_sub(r->corner[i + 1], origin);
        moment = tl_v3_madd(moment, tl_v3_dot(tl_v3_cross(a, b), normal) / 3, tl_v3_add(a, b));
    }
    r->all->polygons++;
    return discs_add(r->host, r->all, tl_v3_madd(origin, 1 / size, moment), normal,
                     sqrt(0.5 * size / 3.141592653589793));
}

/* Reads the fracture whose first line is begun: its number, corners, and what is passed over. */
static tl_status read_fracture(reader *r)
{
    double number, corners, x[3];
    const size_t line = r->all->line;
    tl_status status = next_number(r, "the number of the fracture", &number);
    if (status == TL_OK)
        status = next_number(r, "the number of corners", &corners);
    if (status != TL_OK)
        return status;
    if (!(corners >= 3 && corners <= MOST_CORNERS) || corners != floor(corners))
        return r->host->fail(r->host, TL_E_ARGUMENT,
                             "file '%.200s', line %zu: %g is not a number of corners in [3, %d]", r->file, line,
                             corners, MOST_CORNERS);
    const size_t count = (size_t)corners;
    tl_vec3 *corner = (tl_vec3 *)tl_grown(r->corner, &r->capacity, count, sizeof *corner);
    if (!corner)
        return r->host->fail(r->host, TL_E_MEMORY, "file '%.200s': out of memory", r->file);
    r->corner = corner;
    for (size_t i = 0; i <= count; i++) {
        if (!next_line(r))
            return r->host->fail(r->host, TL_E_ARGUMENT,
                                 "file '%.200s' ends in the fracture of line %zu: it is damaged", r->file, line);
        status = next_number(r, i < count ? "the number of a corner" : "the 0 before the normal", &number);
        for (int k = 0; k < 3 && status == TL_OK; k++)
            status = next_number(r, i < count ? "a coordinate" : "a component of the normal", &x[k]);
        if (status != TL_OK)
            return status;
        if (i < count)
            corner[i] = (tl_vec3){x[0], x[1], x[2]};
    }
    if (r->all->count >= MOST_DISCS)
        return r->host->fail(r->host, TL_E_ARGUMENT, "file '%.200s' has more than %d fractures", r->file, MOST_DISCS);
    return add_polygon(r, count, line);
}

/* Reads a line of the section FORMAT: only text, metres and x to the east are read. */
static tl_status read_format(reader *r, const char *key)
{
    static const char *const expected[][3] = {
        {"format", "ascii", "Ascii"}, {"length_unit", "meter", "Meter"}, {"xaxis", "east", "East"}};
    char value[MOST_LETTERS + 1];
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        if (word_is(key, expected[i][0]) && next_word(r, value) && !word_is(value, expected[i][1]))
            return r->host->fail(r->host, TL_E_ARGUMENT,
                                 "file '%.200s', line %zu: %s = %s is not read: write the file with %s = %s", r->file,
                                 r->all->line, key, value, key, expected[i][2]);
    return TL_OK;
}

tl_status fab_read(const tl_host *host, const char *file, const char *text, discs *all)
{
    enum { OUTSIDE, FORMAT, FRACTURE, OTHER } section = OUTSIDE;
    reader r = {.host = host, .file = file, .at = text, .all = all};
    char word[MOST_LETTERS + 1];
    tl_status status = TL_OK;
    all->line = 1;
    bool more = *text != '\0';
    while (more && status == TL_OK) {
        const char *begin = r.at;
        const bool any = next_word(&r, word);
        if (any && word_is(word, "begin")) {
            next_word(&r, word);
            section = word_is(word, "format") ? FORMAT : word_is(word, "fracture") ? FRACTURE : OTHER;
        } else if (any && word_is(word, "end")) {
            section = OUTSIDE;
        } else if (any && section == FORMAT) {
            status = read_format(&r, word);
        } else if (any && section == FRACTURE) {
            r.at = begin;
            status = read_fracture(&r);
        }
        more = next_line(&r);
    }
    if (status == TL_OK && all->count == 0)
        status = host->fail(host, TL_E_ARGUMENT,
                            "file '%.200s' has no fracture between BEGIN FRACTURE and END FRACTURE", file);
    free(r.corner);
    return status;
}
