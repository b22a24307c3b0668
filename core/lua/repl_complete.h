/* repl_complete.h - completion of names at the prompt. */
#ifndef TL_LUA_REPL_COMPLETE_H
#define TL_LUA_REPL_COMPLETE_H

#include <lua.h>
#include <stdbool.h>
#include <stddef.h>

/* From now on the tabulator completes names of the state. */
void tl_repl_complete_with(lua_State *L);
/* The lines of the chunk that stand above the one that is typed; NULL: none. Must live while that line is read. */
void tl_repl_complete_after(const char *text);

#define TL_SCAN_NAME 64   /* longest name that is heeded, with its zero */
#define TL_SCAN_LEVELS 32 /* of brackets; deeper ones are not told apart */

/* One open bracket. */
typedef struct tl_scan_level {
    char bracket;              /* ( { or [ */
    char callee[TL_SCAN_NAME]; /* the name right before it: of the function that is called; or "" */
    char quoted[TL_SCAN_NAME]; /* the last text in quotes inside it, of this level; or "" */
    char of[TL_SCAN_NAME];     /* the key whose value it is: `of = {`; or "" */
    char key[TL_SCAN_NAME];    /* the key inside it whose value is due: `key = CURSOR`; or "" */
} tl_scan_level;

typedef struct tl_scan {
    tl_scan_level levels[TL_SCAN_LEVELS]; /* levels[0] is no bracket but the whole chunk */
    int depth;                            /* levels[depth] is the innermost */
    char before; /* last character that counts: of a name 'a', of a text in quotes '"'; 0: none */
    /* the last name, when `before` is 'a'; in quotes: the name right before the quotes, or "" */
    char name[TL_SCAN_NAME];
    bool in_quotes, in_comment;
} tl_scan;

/* Where the bracket that ends before `end` begins, and a text in quotes likewise; `end` when it does not. */
bool tl_scan_is_name(char c);

#endif
