/* repl_scan.c - reads an unfinished piece of Lua up to the cursor: which brackets are open, who is called with them, and
 * whether the cursor is in quotes. It need not judge what it reads; text in long brackets is taken for code. */
#include "repl_scan.h"

#include <string.h>

bool tl_scan_is_name(char c)
{
    return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

static void copy(char *name, const char *from, size_t length)
{
    length = length < TL_SCAN_NAME ? length : TL_SCAN_NAME - 1;
    memcpy(name, from, length);
    name[length] = 0;
}

static void open_bracket(tl_scan *scan, char bracket)
{
    if (scan->depth + 1 == TL_SCAN_LEVELS)
        return;
    tl_scan_level *outer = &scan->levels[scan->depth], *inner = outer + 1;
    *inner = (tl_scan_level){.bracket = bracket};
    if (scan->before == 'a')
        copy(inner->callee, scan->name, strlen(scan->name));
    else if (scan->before == '=')
        copy(inner->of, outer->key, strlen(outer->key));
    scan->depth++;
}

/* A character that is no part of a name, of quotes or of a comment. */
static void read_sign(tl_scan *scan, char c)
{
    tl_scan_level *level = &scan->levels[scan->depth];
    if (c == '(' || c == '{' || c == '[')
        open_bracket(scan, c);
    else if ((c == ')' || c == '}' || c == ']') && scan->depth > 0)
        scan->depth--;
    else if (c == '=')
        copy(level->key, scan->name, scan->before == 'a' ? strlen(scan->name) : 0);
    else if (c == ',' || c == ';')
        level->key[0] = 0;
    scan->before = c;
}

/* Where the quotes that begin at `at` end, or `length` when the cursor is in them. */
static size_t end_of_quotes(const char *text, size_t at, size_t length)
{
    size_t i = at + 1;
    while (i < length && text[i] != text[at] && text[i] != '\n')
        i += text[i] == '\\' ? 2 : 1;
    return i < length ? i : length;
}

void tl_scan_text(const char *text, size_t length, tl_scan *scan)
{
    *scan = (tl_scan){0};
    for (size_t i = 0; i < length;) {
        char c = text[i];
        size_t end = i + 1;
        if (c == '-' && end < length && text[end] == '-') {
            const char *line = memchr(text + i, '\n', length - i);
            scan->in_comment = !line;
            end = line ? (size_t)(line - text) : length;
        } else if (c == '"' || c == '\'') {
            end = end_of_quotes(text, i, length);
            scan->in_quotes = end == length;
            if (scan->in_quotes) {
                if (scan->before != 'a')
                    scan->name[0] = 0;
                return;
            }
            copy(scan->levels[scan->depth].quoted, text + i + 1, end - i - 1);
            scan->before = '"';
            end++;
        } else if (tl_scan_is_name(c)) {
            while (end < length && tl_scan_is_name(text[end]))
                end++;
            copy(scan->name, text + i, end - i);
            scan->before = 'a';
        } else if (c != ' ' && c != '\t' && c != '\n')
            read_sign(scan, c);
        i = end;
    }
}

size_t tl_scan_back(const char *text, size_t end)
{
    int open = 0;
    for (size_t i = end; i-- > 0;) {
        char c = text[i];
        if (c == '"' || c == '\'') {
            size_t begin = i;
            while (begin > 0 && text[begin - 1] != c)
                begin--;
            if (begin == 0)
                return end;
            i = begin - 1;
        } else if (c == ')' || c == '}' || c == ']')
            open++;
        else if (c == '(' || c == '{' || c == '[')
            open--;
        if (open <= 0)
            return open == 0 && i + 1 < end ? i : end;
    }
    return end;
}
