/* json.c - reads JSON (RFC 8259) into a tree. Texts are unescaped where they stand; of \u escapes those of
 * one byte (up to 007f) are taken. */
#include "json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>

/* Lists within lists: more is no block model, and would exhaust the stack. */
#define MOST_DEPTH 16
/* Letters of the file that a message repeats. */
#define MOST_SHOWN 12
#define MOST_BYTES ((size_t)2 << 30)

typedef struct parser {
    json_tree *tree;
    char *at;
    size_t line;
} parser;

static tl_status damaged(const parser *p, const char *wanted)
{
    const json_tree *t = p->tree;
    if (!*p->at)
        return t->host->fail(t->host, TL_E_GEOMETRY,
                             "file '%.200s' ends at line %zu where %s is expected: it is truncated", t->file, p->line,
                             wanted);
    int shown = 0; /* letters of what is there instead, within the line */
    while (shown < MOST_SHOWN && (unsigned char)p->at[shown] >= ' ')
        shown++;
    return t->host->fail(t->host, TL_E_GEOMETRY,
                         "file '%.200s', line %zu: %s is expected, not '%.*s'; the file is damaged, or no JSON",
                         t->file, p->line, wanted, shown, p->at);
}

static void skip_space(parser *p)
{
    for (; *p->at == ' ' || *p->at == '\t' || *p->at == '\r' || *p->at == '\n'; p->at++)
        p->line += *p->at == '\n';
}

/* Index of a new node; 0 without memory. */
static size_t add_node(parser *p)
{
    json_tree *t = p->tree;
    json *nodes = tl_grown(t->nodes, &t->capacity, t->count + 2, sizeof *nodes);
    if (!nodes)
        return 0;
    t->nodes = nodes;
    t->nodes[++t->count] = (json){.line = p->line};
    return t->count;
}

/* The value of the letter after a backslash; '\0' for an unknown one. Moves past it. */
static char unescape(parser *p)
{
    static const char letters[] = "\"\\/bfnrt", values[] = "\"\\/\b\f\n\r\t";
    const char *found = *p->at ? strchr(letters, *p->at) : NULL;
    if (found) {
        p->at++;
        return values[found - letters];
    }
    if (*p->at != 'u' || strspn(p->at + 1, "0123456789abcdefABCDEF") < 4)
        return '\0';
    char digits[5] = {p->at[1], p->at[2], p->at[3], p->at[4], '\0'};
    long code = strtol(digits, NULL, 16);
    if (code > 127)
        return '\0';
    p->at += 5;
    return (char)code;
}

static tl_status read_text(parser *p, const char **text)
{
    if (*p->at != '"')
        return damaged(p, "a text in quotes");
    char *to = ++p->at;
    *text = to;
    while (*p->at != '"') {
        if ((unsigned char)*p->at < ' ')
            return damaged(p, "a closing quote");
        if (*p->at != '\\') {
            *to++ = *p->at++;
            continue;
        }
        p->at++;
        *to = unescape(p);
        if (!*to++)
            return damaged(p, "one of \"\\/bfnrt, or u0001 to u007f,");
    }
    *to = '\0';
    p->at++;
    return TL_OK;
}

/* Digits as JSON has them: no sign but '-', no hexadecimals, infinities or names. */
static tl_status read_number(parser *p, json *node)
{
    size_t length = strspn(p->at, "+-.eE0123456789");
    const char *end = p->at;
    if ((*p->at == '-' || (*p->at >= '0' && *p->at <= '9')) && length > 0)
        node->number = tl_number_read(p->at, &end);
    if (end == p->at || (size_t)(end - p->at) != length || !isfinite(node->number))
        return damaged(p, "a finite number or another value");
    node->type = JSON_NUMBER;
    p->at += length;
    return TL_OK;
}

static bool take_word(parser *p, const char *word)
{
    size_t length = strlen(word);
    if (strncmp(p->at, word, length) != 0)
        return false;
    p->at += length;
    return true;
}

static tl_status read_value(parser *p, size_t index, int depth);

/* The items of a list or an object, up to the bracket that closes it. */
static tl_status read_items(parser *p, size_t index, int depth)
{
    bool object = *p->at == '{';
    char closing = object ? '}' : ']';
    p->tree->nodes[index].type = object ? JSON_OBJECT : JSON_LIST;
    p->at++;
    skip_space(p);
    size_t last = 0;
    for (bool more = *p->at != closing; more;) {
        size_t item = add_node(p);
        if (!item)
            return p->tree->host->fail(p->tree->host, TL_E_MEMORY, "out of memory");
        const char *key = NULL;
        tl_status status = object ? read_text(p, &key) : TL_OK;
        skip_space(p);
        if (status == TL_OK && object && *p->at != ':')
            status = damaged(p, "':'");
        p->at += status == TL_OK && object;
        if (status == TL_OK)
            status = read_value(p, item, depth + 1);
        if (status != TL_OK)
            return status;
        json *nodes = p->tree->nodes;
        nodes[item].key = key;
        *(last ? &nodes[last].next : &nodes[index].first) = item;
        last = item;
        nodes[index].count++;
        more = *p->at == ',';
        if (!more && *p->at != closing)
            return damaged(p, object ? "',' or '}'" : "',' or ']'");
        p->at += more;
        skip_space(p);
    }
    p->at++;
    return TL_OK;
}

/* A value and the space around it. */
static tl_status read_value(parser *p, size_t index, int depth)
{
    skip_space(p);
    json *node = &p->tree->nodes[index];
    node->line = p->line;
    tl_status status = TL_OK;
    if (*p->at == '{' || *p->at == '[') {
        status = depth < MOST_DEPTH ? read_items(p, index, depth) : damaged(p, "less than 16 lists within each other");
    } else if (*p->at == '"') {
        node->type = JSON_TEXT;
        status = read_text(p, &node->text);
    } else if (take_word(p, "true")) {
        node->type = JSON_BOOL;
        node->number = 1;
    } else if (take_word(p, "false")) {
        node->type = JSON_BOOL;
    } else if (!take_word(p, "null")) {
        status = read_number(p, node);
    }
    if (status == TL_OK)
        skip_space(p);
    return status;
}

tl_status json_read(json_tree *t, char **text)
{
    size_t count;
    tl_status status = tl_file_bytes(t->host, t->file, MOST_BYTES, text, &count);
    if (status != TL_OK)
        return status;
    parser p = {.tree = t, .at = *text, .line = 1};
    if (!add_node(&p))
        return t->host->fail(t->host, TL_E_MEMORY, "out of memory");
    status = read_value(&p, 1, 0);
    if (status == TL_OK && (*p.at || p.at != *text + count))
        status =
            t->host->fail(t->host, TL_E_GEOMETRY,
                          "file '%.200s', line %zu: something follows the end; the file is damaged", t->file, p.line);
    return status;
}

const json *json_first(const json_tree *t, const json *list)
{
    return list->first ? &t->nodes[list->first] : NULL;
}

const json *json_next(const json_tree *t, const json *item)
{
    return item->next ? &t->nodes[item->next] : NULL;
}

const json *json_get(const json_tree *t, const json *object, const char *key)
{
    if (object->type != JSON_OBJECT)
        return NULL;
    for (const json *item = json_first(t, object); item; item = json_next(t, item))
        if (strcmp(item->key, key) == 0)
            return item;
    return NULL;
}
