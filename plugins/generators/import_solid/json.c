/* json.c - walks a JSON text. Nothing is allocated, so that a file takes no more memory than it has bytes. */
#include "json.h"

#include <string.h>
#include <talus/kit.h>

/* Limit: lists within lists: more would exhaust the stack. */
#define MOST_DEPTH 64

typedef struct checker {
    const soup *s;
    const char *begin, *end;
} checker;

static const char *skip_space(const char *at)
{
    while (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r')
        at++;
    return at;
}

size_t json_line(const char *text, const char *at)
{
    size_t line = 1;
    for (; text < at; text++)
        line += *text == '\n';
    return line;
}

static tl_status damaged(const checker *c, const char *at, const char *wanted)
{
    size_t line = json_line(c->begin, at);
    if (at >= c->end)
        return SOUP_FAULT(c->s, " ends at line %zu where %s is expected: it is truncated; export it again", line,
                          wanted);
    return SOUP_FAULT(c->s, ", line %zu: %s is expected at '%.20s'; the file is damaged, or no JSON", line, wanted, at);
}

static tl_status check_text(const checker *c, const char **at)
{
    const char *p = *at + 1;
    for (; *p != '"'; p++) {
        if ((unsigned char)*p < ' ')
            return damaged(c, p, "the quote at the end of a text");
        p += *p == '\\' && p[1] != '\0';
    }
    *at = p + 1;
    return TL_OK;
}

static tl_status check_plain(const checker *c, const char **at)
{
    static const char *const words[] = {"true", "false", "null", "NaN", "Infinity", "-Infinity"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        size_t length = strlen(words[i]);
        if (strncmp(*at, words[i], length) == 0) {
            *at += length;
            return TL_OK;
        }
    }
    const char *p = *at + (**at == '-');
    if (*p < '0' || *p > '9')
        return damaged(c, *at, "a value");
    while ((*p >= '0' && *p <= '9') || *p == '.' || *p == 'e' || *p == 'E' || *p == '+' || *p == '-')
        p++;
    *at = p;
    return TL_OK;
}

static tl_status check_value(const checker *c, const char **at, int depth);

static tl_status check_items(const checker *c, const char **at, int depth)
{
    bool object = **at == '{', more = true;
    const char closing = object ? '}' : ']';
    if (depth >= MOST_DEPTH)
        return damaged(c, *at, "less than 64 lists within each other");
    *at = skip_space(*at + 1);
    if (**at == closing) {
        ++*at;
        return TL_OK;
    }
    while (more) {
        tl_status status = TL_OK;
        if (object) {
            status = **at == '"' ? check_text(c, at) : damaged(c, *at, "a name in quotes");
            *at = skip_space(*at);
            if (status == TL_OK && **at != ':')
                status = damaged(c, *at, "':'");
            *at += status == TL_OK;
        }
        if (status == TL_OK)
            status = check_value(c, at, depth + 1);
        if (status != TL_OK)
            return status;
        more = **at == ',';
        if (!more && **at != closing)
            return damaged(c, *at, object ? "',' or '}'" : "',' or ']'");
        *at = more ? skip_space(*at + 1) : *at + 1;
    }
    return TL_OK;
}

/* A value and the space around it. */
static tl_status check_value(const checker *c, const char **at, int depth)
{
    *at = skip_space(*at);
    tl_status status = **at == '{' || **at == '[' ? check_items(c, at, depth)
                       : **at == '"'              ? check_text(c, at)
                                                  : check_plain(c, at);
    *at = skip_space(*at);
    return status;
}

tl_status json_check(const soup *s, const char *text, size_t count, const char **value)
{
    const checker c = {s, text, text + count};
    const char *at = text;
    if (count >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0)
        at += 3;
    *value = skip_space(at);
    tl_status status = check_value(&c, &at, 0);
    if (status == TL_OK && at != c.end)
        status = damaged(&c, at, "the end of the file");
    return status;
}

static const char *end_of_text(const char *at)
{
    for (at++; *at != '"'; at++)
        at += *at == '\\';
    return at + 1;
}

const char *json_end(const char *at)
{
    size_t depth = 0;
    do {
        if (*at == '"') {
            at = end_of_text(at);
            continue;
        }
        depth += *at == '{' || *at == '[';
        depth -= *at == '}' || *at == ']';
        bool plain = depth == 0 && *at != '}' && *at != ']';
        at++;
        if (plain)
            while (*at && !strchr(" \t\r\n,]}", *at))
                at++;
    } while (depth > 0);
    return at;
}

const char *json_first(const char *at)
{
    if (*at != '{' && *at != '[')
        return NULL;
    at = skip_space(at + 1);
    return *at == '}' || *at == ']' ? NULL : at;
}

const char *json_value(const char *key)
{
    return skip_space(skip_space(end_of_text(key)) + 1);
}

const char *json_next(const char *item, bool object)
{
    const char *at = skip_space(json_end(object ? json_value(item) : item));
    return *at == ',' ? skip_space(at + 1) : NULL;
}

bool json_is(const char *at, const char *text)
{
    size_t length = strlen(text);
    return *at == '"' && strncmp(at + 1, text, length) == 0 && at[1 + length] == '"';
}

const char *json_get(const char *object, const char *key)
{
    if (!object || *object != '{')
        return NULL;
    for (const char *item = json_first(object); item; item = json_next(item, true))
        if (json_is(item, key))
            return json_value(item);
    return NULL;
}
