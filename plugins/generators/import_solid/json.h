/* json.h - a JSON text as it stands, without a tree: checked once, then walked from item to item. */
#ifndef IMPORT_SOLID_JSON_H
#define IMPORT_SOLID_JSON_H

#include "soup.h"

/* Refuses a text that is no JSON (RFC 8259), with its line. Gives the place of its value. */
tl_status json_check(const soup *s, const char *text, size_t count, const char **value);

/* What follows is for a text that was checked. `at` is the place of a value. */

/* The place behind a value. */
const char *json_end(const char *at);
/* The first item of a list or an object, and the item after; NULL when there is none, or the value is neither. Of an
 * object an item is its key, and json_value the value of that. */
const char *json_first(const char *at);
const char *json_next(const char *item, bool object);
const char *json_value(const char *key);
/* The value of a key in an object; NULL when it is not there. */
const char *json_get(const char *object, const char *key);
/* Whether a text is `text`. */
bool json_is(const char *at, const char *text);
/* The line of a place, from 1. */
size_t json_line(const char *text, const char *at);

#endif
