/* json.h - a JSON text as a tree. */
#ifndef BLOCKS_JSON_H
#define BLOCKS_JSON_H

#include <stdbool.h>
#include <talus/plugin.h>

typedef enum json_type { JSON_NULL, JSON_BOOL, JSON_NUMBER, JSON_TEXT, JSON_LIST, JSON_OBJECT } json_type;

typedef struct json {
    json_type type;
    const char *key;    /* in an object */
    const char *text;   /* of a text */
    double number;      /* of a number; 0 or 1 of a bool */
    size_t first, next; /* index of the first item, and of the item after this one; 0: none */
    size_t count;       /* items */
    size_t line;        /* it begins at, from 1 */
} json;

/* nodes[1] is the whole; texts lie in the text that was read. */
typedef struct json_tree {
    const tl_host *host;
    const char *file;
    json *nodes;
    size_t count, capacity;
} json_tree;

/* Reads a file. `text` holds what the tree's texts point to. Both are the caller's to free, also after a failure. */
tl_status json_read(json_tree *tree, char **text);
/* The item of this name in an object; NULL when there is none. */
const json *json_get(const json_tree *tree, const json *object, const char *key);
/* The first item, and the one after; NULL when there is none. */
const json *json_first(const json_tree *tree, const json *list);
const json *json_next(const json_tree *tree, const json *item);

#endif
