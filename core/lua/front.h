/* front.h - what the parts of the Lua front end share.
 *
 * Objects. A model is a userdata that owns a tl_model. A block, a contact, a zone or a gridpoint is an *item*: a
 * userdata with its name. Its user value is the model's userdata, so the model outlives it. A selection is a userdata
 * with a list of names, likewise. Items of all types share one implementation, driven by a tl_lua_kind.
 *
 * Errors. Everything here may raise a Lua error, so no local variable holds what only C could free. Memory that must
 * survive a call is a userdata on the stack or owned by one. */
#ifndef TL_LUA_FRONT_H
#define TL_LUA_FRONT_H

#include <lauxlib.h>
#include <lua.h>
#include <talus/number.h>
#include <talus/talus.h>
#include <talus/text.h>
#include <talus/zones.h>

/* A key of a table of arguments that a tl_param cannot express. */
typedef struct tl_lua_key {
    const char *name; /* NULL ends a list */
    const char *type; /* "function(model)" */
    const char *doc;
} tl_lua_key;

typedef struct tl_lua_options {
    int64_t threads; /* default of talus.model; 0: not set */
    bool quiet;      /* no progress line, no remarks */
    /* of runs that are saved as they go */
    double autosave;       /* s between two saves of a run's model; 0: none */
    double save_due;       /* s, of the clock */
    const char *save_path; /* the file of the script's saves; NULL: it has none */
    int64_t shard, shards; /* which of how many processes this is; shards = 0: the only one */
    bool resume;           /* talus.resumed gives the model that was saved last */
} tl_lua_options;

/* Opens the module `talus`. */
TL_API int luaopen_talus(lua_State *L);

/* A list of known names, from which the nearest to a misspelt word is found. */
#define TL_LUA_NAMES 128
typedef struct tl_lua_names {
    const char *at[TL_LUA_NAMES];
    size_t count;
} tl_lua_names;

/* A table of arguments: what may stand in it, and how it is called in messages. */
typedef struct tl_lua_spec {
    const char *context; /* "solve" */
    const tl_param *params;
    size_t count;
    const tl_lua_key *keys; /* further keys, left to the caller; NULL: none */
} tl_lua_spec;

/* Name of the metatable of models. */
#define TL_LUA_MODEL_TYPE "talus.model"

typedef struct tl_lua_model {
    tl_model *model;
    bool probe;                  /* a copy: a run of it is not saved as it goes */
    int64_t next_sample;         /* cycle at which a history is due: history.c */
    bool sampling;               /* a function of a history or of an extra field runs */
    struct tl_lua_viewing *view; /* while it is shown: view.c */
} tl_lua_model;

/* User values of a model's userdata: functions of drives (block.c) and, by their names, of histories (history.c), and
 * what a view shows (view.c). */
enum { TL_LUA_DRIVES = 1, TL_LUA_HISTORIES, TL_LUA_VIEW, TL_LUA_USER_VALUES = 3 };

/* A stretch of time in which Ctrl-C raises an error. Watches may nest. */
typedef struct tl_lua_watch {
    lua_State *outer; /* who listened before */
} tl_lua_watch;

/* Where a run keeps the model on the Lua stack, and the error of a function that it has called. */
enum { TL_LUA_AT_MODEL = 1, TL_LUA_AT_ERROR = 6 };

/* A run of some model: they nest, as a function that one calls may begin a run of another model. */
typedef struct tl_lua_running {
    lua_State *L;
    bool failed; /* a function has; the run is to end */
} tl_lua_running;

struct tl_lua_item;
struct tl_lua_selection;

/* A method of selections: of `plain`, `act` and `ask` the one that is there. */
typedef struct tl_lua_verb {
    const char *name; /* a list ends with name = NULL */
    int arguments;    /* after the selection, nil where none are given */
    tl_status (*plain)(tl_model *model, const tl_id *ids, size_t count); /* of blocks */
    tl_status (*act)(lua_State *L, const struct tl_lua_selection *items);
    /* "hidden": a remark says "no block was hidden" of an empty selection; NULL: none does. */
    const char *done;
    int (*ask)(lua_State *L, const struct tl_lua_selection *items); /* pushes what it gives; 1 */
} tl_lua_verb;

/* Rows of a table. */
#define TL_LUA_COUNT(table) (sizeof(table) / sizeof(table)[0])

/* By what the kernel knows an item. */
typedef union tl_lua_name {
    tl_id block; /* or element */
    tl_contact_name contact;
    tl_zone_name zone; /* or gridpoint */
} tl_lua_name;

/* What differs between blocks, contacts, zones, gridpoints and elements. */
typedef struct tl_lua_kind {
    const char *item, *items;                       /* "block", "blocks": words in messages */
    const char *item_type, *selection_type;         /* names of the metatables */
    size_t name_size;                               /* bytes of a name */
    lua_Integer (*number)(const tl_lua_name *name); /* by which a script knows it: its id */
    const char *bearer;                             /* "law", "solid": what declares its states */
    const tl_field *(*fields)(size_t *count);
    tl_status (*field)(tl_model *model, const struct tl_lua_item *item, size_t index, tl_field_value *value);
    /* A field of a selection by its name, as tl_blocks_values. NULL: only its width is asked for. */
    tl_status (*values)(tl_model *model, const struct tl_lua_selection *of, const char *name, double *out,
                        size_t *width);
    /* Pushes a field that `fields` cannot express; false when it has none of that name. The item is
     * at index 1 and its model's userdata at index 3. */
    bool (*extra)(lua_State *L, tl_model *model, const struct tl_lua_item *item, const char *name);
    const tl_lua_key *extra_keys;
    const tl_lua_verb *verbs; /* methods of selections beyond those both types have */
} tl_lua_kind;

/* Types of items and selections. */
#define TL_LUA_BLOCK "talus.block"
#define TL_LUA_BLOCKS "talus.blocks"
#define TL_LUA_CONTACT "talus.contact"
#define TL_LUA_CONTACTS "talus.contacts"
#define TL_LUA_ZONE "talus.zone"
#define TL_LUA_ZONES "talus.zones"
#define TL_LUA_GRIDPOINT "talus.gridpoint"
#define TL_LUA_GRIDPOINTS "talus.gridpoints"
#define TL_LUA_ELEMENT "talus.element"
#define TL_LUA_ELEMENTS "talus.elements"

typedef struct tl_lua_item {
    const tl_lua_kind *kind;
    tl_lua_model *owner;
    tl_lua_name name;
} tl_lua_item;

typedef struct tl_lua_selection {
    const tl_lua_kind *kind;
    tl_lua_model *owner;
    void *names; /* [count], from malloc: tl_id, tl_contact_name or tl_zone_name */
    size_t count;
} tl_lua_selection;

/* What a drive's functions hang on: block.c. */
typedef struct tl_lua_anchor {
    bool ended;
} tl_lua_anchor;

/* Which user values of an anchor are its functions. */
enum { TL_LUA_VELOCITY = 1, TL_LUA_ANGULAR_VELOCITY, TL_LUA_MOTIONS = 2 };

/* Keys of a table with fields that a script adds. */
#define TL_LUA_FIELD_KEYS                                                                                              \
    {"block_fields", "{\"FIELD\", NAME = \"FIELD\", {[id] = number} or function(block)}",                              \
     "numbers of each block to colour by: fields of blocks, tables of numbers by ids, and functions that give a "      \
     "number, or nil for none"},                                                                                       \
    {                                                                                                                  \
        "contact_fields", "{\"FIELD\", NAME = \"FIELD\" or function(contact)}",                                        \
            "numbers of each contact, likewise: fields of contacts, states of their laws, "                            \
            "functions"                                                                                                \
    }

/* Keys of a table that says what a page shows. */
#define TL_LUA_PAGE_KEYS                                                                                               \
    {"contacts", "true, false or \"slipping\"",                                                                        \
     "which contacts the frame has; when left out all, where there are 20000 at the most, and "                        \
     "else those that slip"},                                                                                          \
        TL_LUA_FIELD_KEYS,                                                                                             \
        {"keyblocks", "{friction =, cohesion =, gravity =}",                                                           \
         "parameters of model:keyblocks, whose modes and factors of safety are shown as well"},                        \
    {                                                                                                                  \
        "safety_limit", "number", "factor of safety that is asked for: the legend marks it"                            \
    }

/* A function: how it is called, and what the help tells of it. Its parameters are of the table that checks them. */
typedef struct tl_lua_topic {
    const char *name, *usage, *doc; /* a list ends with name = NULL */
    const char *function;           /* of the kernel, whose parameters it takes; or NULL */
    const tl_lua_spec *spec;        /* of the front end; or NULL */
    const tl_lua_key *keys;         /* further parameters; or NULL */
    const tl_lua_kind *kind;        /* what a selection it gives is of; or NULL */
    const char *title;              /* heading of `verbs` */
    const tl_lua_key *verbs;        /* methods or fields of what it gives; or NULL */
    bool has_type;
    tl_kind_type type; /* plugins it takes by name, if has_type */
    /* A method of models: the model is at index 1, and `arguments` values after it, nil where none is given. */
    int (*method)(lua_State *L, tl_model *model);
    int arguments;
    lua_CFunction call; /* a function of the module */
} tl_lua_topic;

#endif
