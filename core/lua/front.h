/* front.h - what the parts of the Lua front end share.
 *
 * Objects. A model is a userdata that owns a tl_model. A block or a contact is an *item*: a userdata
 * with the model's userdata as its user value (so the model outlives it) and an id. A selection is
 * a userdata with a list of ids, likewise. Items of either type share one implementation, driven
 * by a tl_lua_kind.
 *
 * Errors. Everything here may raise a Lua error, so nothing is held in a local variable that only
 * C could free: memory that must survive a call is a userdata on the stack or owned by one. */
#ifndef TL_LUA_FRONT_H
#define TL_LUA_FRONT_H

#include <lauxlib.h>
#include <lua.h>
#include <talus/number.h>
#include <talus/talus.h>
#include <talus/text.h>

/* A key of a table of arguments that a tl_param cannot express. */
typedef struct tl_lua_key {
    const char *name; /* NULL ends a list */
    const char *type; /* "function(model)" */
    const char *doc;
} tl_lua_key;

/* ---- what a state was asked to do by options or environment: living.c ---- */

typedef struct tl_lua_options {
    int64_t threads; /* default of talus.model; 0: not set */
    bool quiet;      /* no progress line, no remarks */
    /* autosave.c */
    double autosave;       /* s between two saves of a run's model; 0: none */
    double save_due;       /* s, of the clock */
    const char *save_path; /* the file of the script's saves; NULL: it has none */
    bool resume;           /* talus.resumed gives the model that was saved last */
} tl_lua_options;

/* The options of a Lua state, made when first asked for; lives as long as the state. */
tl_lua_options *tl_lua_options_of(lua_State *L);
/* Prints a remark of the kernel on standard error, unless the options, its user data, say quiet. */
void tl_lua_log(void *user, const char *text);
/* Seconds of a clock that never goes back, from a start of its own: only differences mean something. */
double tl_lua_clock(void);
/* Opens the module `talus`. */
TL_API int luaopen_talus(lua_State *L);

/* ---- modules written in Lua: library.c ---- */

extern const tl_lua_key tl_lua_plot_keys[], tl_lua_stereonet_keys[];
/* Lets `require` find them; once a state. */
void tl_lua_library_open(lua_State *L);
/* Has the table at the top of the stack, the module `talus`, load them when they are first used. */
void tl_lua_library_attach(lua_State *L);
/* talus.write_file(path, text) */
int tl_lua_write_file(lua_State *L);

/* ---- errors: fail.c ---- */

/* Raises "file:line: " (of the nearest Lua code up the stack) and a formatted sentence; formats as
 * of lua_pushfstring. The int is for `return tl_lua_fail(...)`. */
int tl_lua_fail(lua_State *L, const char *format, ...);
/* Pushes "file:line: " of the nearest Lua code up the stack, or "". */
void tl_lua_push_where(lua_State *L);
/* The same, but at the line where the Lua function at `index` is defined. */
int tl_lua_fail_in(lua_State *L, int index, const char *format, ...);
/* Raises the sentence of a failed kernel call. */
int tl_lua_raise(lua_State *L, const tl_error *error);

/* A list of known names, from which the nearest to a misspelt word is found. */
#define TL_LUA_NAMES 128
typedef struct tl_lua_names {
    const char *at[TL_LUA_NAMES];
    size_t count;
} tl_lua_names;

void tl_lua_names_add(tl_lua_names *names, const char *name);
void tl_lua_names_list(tl_lua_names *names, const char *const *list);
void tl_lua_names_fields(tl_lua_names *names, const tl_field *fields, size_t count);
/* Raises "WHAT 'WORD' ...; did you mean 'NEAREST'?" or, when none is near, lists the known names. */
int tl_lua_unknown(lua_State *L, const char *what, const char *word, const tl_lua_names *names);

/* ---- conversion: convert.c ---- */

/* A table of arguments: what may stand in it, and how it is called in messages. */
typedef struct tl_lua_spec {
    const char *context; /* "solve" */
    const tl_param *params;
    size_t count;
    const tl_lua_key *keys; /* further keys, left to the caller; NULL: none */
} tl_lua_spec;

/* The spec of a kernel function. */
tl_lua_spec tl_lua_spec_of(const char *function, const tl_lua_key *keys);
/* Converts the table at `index` (nil or none: empty) for the kernel, and pushes one value that
 * must stay on the stack as long as `args` is used. Keys listed in `skip` are left out. */
void tl_lua_args(lua_State *L, int index, const char *context, const tl_lua_key *skip,
                 tl_args *args);
/* Checks the table at `index` against `spec` and fills `out`; see tl_args_read. Pushes one value
 * that must stay on the stack as long as strings in `out` are used. */
void tl_lua_read(lua_State *L, int index, const tl_lua_spec *spec, bool keep, void *out);
/* The same for one value at `index`, given the name `key`. */
void tl_lua_read_one(lua_State *L, int index, const tl_lua_spec *spec, const char *key, void *out);

/* Raises unless the argument is a string without a zero byte. */
const char *tl_lua_text(lua_State *L, int index, const char *function, const char *what);
/* Raises when more than `most` arguments were given (the object itself counted). */
void tl_lua_arity(lua_State *L, int most, const char *function);
/* Pushes the text of the number at `index`, as Lua writes it where there is a decimal point. */
void tl_lua_push_number_text(lua_State *L, int index);
/* "a number", "nil", "a selection of blocks": what the value at `index` is; may push a string. */
const char *tl_lua_describe(lua_State *L, int index);

void tl_lua_push_numbers(lua_State *L, const double *numbers, size_t count);
void tl_lua_push_vec3(lua_State *L, tl_vec3 v);
/* Set a field of the table at the top of the stack. */
void tl_lua_set_number(lua_State *L, const char *name, double number);
void tl_lua_set_count(lua_State *L, const char *name, size_t count);
void tl_lua_set_text(lua_State *L, const char *name, const char *text);
void tl_lua_set_vec3(lua_State *L, const char *name, tl_vec3 v);
/* Adds the shortest text, of so many digits or more, that reads back as the same number. */
void tl_lua_add_number(luaL_Buffer *to, double number, int digits);
/* Pushes a field's value as Lua sees it. */
void tl_lua_push_field(lua_State *L, tl_field_kind kind, const tl_field_value *value);

/* ---- models: living.c, model.c ---- */

/* Name of the metatable of models. */
#define TL_LUA_MODEL_TYPE "talus.model"

typedef struct tl_lua_model {
    tl_model *model;
    bool probe;               /* a copy: a run of it is not saved as it goes */
    int64_t next_sample;      /* cycle at which a history is due: history.c */
    bool sampling;            /* a function of a history or of an extra field runs */
    struct tl_lua_view *view; /* while it is shown: view.c */
} tl_lua_model;

/* User values of a model's userdata: the functions of drives (action.c), those of histories by their names (history.c), what a
 * view shows (view.c). */
enum { TL_LUA_DRIVES = 1, TL_LUA_HISTORIES, TL_LUA_VIEW, TL_LUA_USER_VALUES = 3 };

/* Pushes the function talus.model and makes the metatable of models. */
void tl_lua_model_open(lua_State *L);
/* Pushes an object without a model yet; gives the model that has been put into it its log and its ear for Ctrl-C. */
tl_lua_model *tl_lua_model_push(lua_State *L);
void tl_lua_model_begin(lua_State *L, const tl_lua_model *object);
/* Sets a number of threads by --threads, else by the environment; else it stays. */
void tl_lua_default_threads(lua_State *L, int64_t *threads);
/* The model at index 1; raises, naming the method, when it is something else. */
tl_model *tl_lua_model_of(lua_State *L, const char *method);
/* The model of an item or a selection; raises when it was closed (as the Lua state ends). */
tl_model *tl_lua_living(lua_State *L, const tl_lua_model *owner);
/* Raises the model's error unless `status` is TL_OK. */
void tl_lua_ok(lua_State *L, tl_model *model, tl_status status);

extern const tl_lua_key tl_lua_insitu_keys[];

/* ---- quality of the blocks, keyblocks: quality.c ---- */

/* Pushes the sentence that says which block controls the time step. */
void tl_lua_push_timestep(lua_State *L, const tl_timestep_report *report);
extern const tl_lua_key tl_lua_keyblocks_keys[];
int tl_lua_report(lua_State *L);
int tl_lua_filter(lua_State *L);
int tl_lua_keyblocks(lua_State *L);
/* With the arguments of the method, pushes a userdata that holds a tl_keyblocks as long as it lives; 1. */
int tl_lua_keyblocks_find(lua_State *L);

/* ---- Ctrl-C: interrupt.c ---- */

/* A stretch of time in which Ctrl-C raises an error. Watches may nest. */
typedef struct tl_lua_watch {
    lua_State *outer; /* who listened before */
} tl_lua_watch;

tl_lua_watch tl_lua_watch_begin(lua_State *L);
/* Ends a watch of a call of the kernel. After a Ctrl-C raises "WHAT: stopped by Ctrl-C; OUTCOME", either of which may be "". */
void tl_lua_watch_end(lua_State *L, const tl_lua_watch *watch, const char *what,
                      const char *outcome);
/* The same of a run. But at the prompt it does not raise, so that the run's result is not lost: what comes next on the line
 * does. */
void tl_lua_watch_end_run(lua_State *L, const tl_lua_watch *watch, const char *what);
/* True from a Ctrl-C until its error is raised; for tl_model_interrupt_if. */
bool tl_lua_interrupt_asked(void);
/* Raises that error when there has been a Ctrl-C. */
void tl_lua_interrupt_check(lua_State *L);
/* lua_pcall under a watch. A Ctrl-C for which nothing has raised when it ends is forgotten. */
int tl_lua_watch_call(lua_State *L, int arguments, int results, int handler, bool at_prompt);
/* True when the message of an error of the last such call tells of a Ctrl-C. */
bool tl_lua_interrupted(const char *message);

/* ---- running: running.c, run.c ---- */

/* Where a run keeps the model on the Lua stack, and the error of a function that it has called. */
enum { TL_LUA_AT_MODEL = 1, TL_LUA_AT_ERROR = 6 };

/* A run of some model: they nest, as a function that one calls may begin a run of another model. */
typedef struct tl_lua_running {
    lua_State *L;
    struct tl_lua_running *outer;
    bool failed; /* a function has; the run is to end */
} tl_lua_running;

void tl_lua_running_begin(tl_lua_running *run, lua_State *L);
void tl_lua_running_end(const tl_lua_running *run);
extern const tl_lua_key tl_lua_cycle_keys[], tl_lua_solve_keys[];
int tl_lua_cycle(lua_State *L);
int tl_lua_solve(lua_State *L);
/* The Lua state of the run whose step is being made. */
lua_State *tl_lua_run_state(void);
/* Pops the error on the top of its stack, to be raised again when the run has ended. */
void tl_lua_run_keep_error(void);

/* ---- outer faces: boundary.c ---- */

extern const tl_lua_spec tl_lua_boundary_spec;
extern const tl_lua_key tl_lua_boundary_results[];
int tl_lua_boundary(lua_State *L);
/* The tl_side of a name; raises, beginning with `context`, when there is none. In block.c. */
int32_t tl_lua_side(lua_State *L, const char *context, const char *name);

/* ---- what there is: lists.c ---- */

extern const tl_lua_key tl_lua_joints_results[], tl_lua_laws_results[], tl_lua_groups_results[],
    tl_lua_kinds_results[];
int tl_lua_joints(lua_State *L);
int tl_lua_laws(lua_State *L);
int tl_lua_groups(lua_State *L);
/* Puts talus.laws, talus.dampings and talus.generators into the module at the top of the stack. */
void tl_lua_lists_open(lua_State *L);
/* ---- histories: history.c ---- */

extern const tl_lua_spec tl_lua_history_spec;
extern const tl_lua_key tl_lua_histories_fields[];
int tl_lua_history(lua_State *L);
int tl_lua_histories(lua_State *L);
int tl_lua_write_histories(lua_State *L);
/* Finds when the next sample of the model at `model_index` is due. */
void tl_lua_histories_due(lua_State *L, int model_index);
/* Takes the samples that are due; false, with the error on the top of the stack, when one fails. */
bool tl_lua_histories_sample(lua_State *L, int model_index);
/* The functions that histories of the model at `from` sample are those of its copy at `to` as well: history_again.c. */
void tl_lua_histories_share(lua_State *L, int from, int to);
/* Checks the option `histories` of the table at index 2, if there is one: functions by name. */
void tl_lua_histories_given(lua_State *L);
/* Gives the histories of the restored model at `model_index` their functions, of that option, or raises: what a history asks
 * for is not there. */
void tl_lua_histories_again(lua_State *L, const char *path, int model_index);

/* ---- parameters in force: parameters.c ---- */

extern const tl_lua_key tl_lua_parameters_fields[];
int tl_lua_parameters(lua_State *L);

/* ---- what a model costs: cost.c ---- */

extern const tl_lua_key tl_lua_profile_fields[], tl_lua_memory_fields[];
int tl_lua_profile(lua_State *L);
int tl_lua_memory(lua_State *L);

/* ---- how a model stands: verdict.c ---- */

extern const tl_lua_key tl_lua_verdict_fields[];
int tl_lua_stage(lua_State *L);
int tl_lua_verdict(lua_State *L);

/* ---- a joint law alone: law_test.c ---- */

extern const tl_lua_key tl_lua_law_test_keys[], tl_lua_law_test_results[];
int tl_lua_law_test(lua_State *L);

/* ---- items and selections: item.c, selection.c ---- */

/* What differs between blocks and contacts. */
typedef struct tl_lua_kind {
    const char *item, *items;               /* "block", "blocks": words in messages */
    const char *item_type, *selection_type; /* names of the metatables */
    const tl_field *(*fields)(size_t *count);
    tl_status (*field)(tl_model *model, tl_id id, size_t index, tl_field_value *value);
    /* Fields of many by name: tl_blocks_values, tl_contacts_values. */
    tl_status (*values)(tl_model *model, const tl_id *ids, size_t count, const char *name,
                        double *out, size_t *width);
    /* Pushes a field that `fields` cannot express; false when it has none of that name. The item is
     * at index 1 and its model's userdata at index 3. */
    bool (*extra)(lua_State *L, tl_model *model, tl_id id, const char *name);
    const tl_lua_key *extra_keys;
    const luaL_Reg *verbs; /* methods of selections beyond those both types have */
} tl_lua_kind;

/* Types of items and selections. */
#define TL_LUA_BLOCK "talus.block"
#define TL_LUA_BLOCKS "talus.blocks"
#define TL_LUA_CONTACT "talus.contact"
#define TL_LUA_CONTACTS "talus.contacts"

typedef struct tl_lua_item {
    const tl_lua_kind *kind;
    tl_lua_model *owner;
    tl_id id;
} tl_lua_item;

typedef struct tl_lua_selection {
    const tl_lua_kind *kind;
    tl_lua_model *owner;
    tl_id *ids; /* from malloc */
    size_t count;
} tl_lua_selection;

/* Makes the metatables of a kind's items and selections. */
void tl_lua_item_open(lua_State *L, const tl_lua_kind *kind);
void tl_lua_selection_open(lua_State *L, const tl_lua_kind *kind);
/* The kind of the items of an open type. */
const tl_lua_kind *tl_lua_item_kind(lua_State *L, const char *type);
/* Pushes an item of an open type; `model_index` is where the model's userdata is. */
void tl_lua_item_push(lua_State *L, const char *type, int model_index, tl_id id);
/* Sets a field of the table at the top of the stack to a block of the model at index 1; of TL_NO_ID there is none. */
void tl_lua_set_block(lua_State *L, const char *name, tl_id id);
/* The table at the top of the stack has a block in the field `name`, pushed before a call: makes it the one of that id,
 * without needing memory; TL_NO_ID: takes it out. */
void tl_lua_item_rename(lua_State *L, const char *name, tl_id id);
/* Pushes an empty selection, to be filled with a list that then belongs to it. */
tl_lua_selection *tl_lua_selection_push(lua_State *L, const tl_lua_kind *kind, int model_index);
/* The selection of a type at index 1, raising when it is something else. */
tl_lua_selection *tl_lua_selection_of(lua_State *L, const char *type, const char *items,
                                      const char *method);
/* Keeps those of the selection at `selection_index` for which the function at `function_index`
 * answers true. */
void tl_lua_selection_filter(lua_State *L, int selection_index, int function_index);

/* selection:values(field): values.c */
int tl_lua_selection_values(lua_State *L, const tl_lua_selection *selection);

/* ---- blocks and contacts: block.c, contact.c, points.c ---- */

/* Push the points of a contact, a list of tables, and the states of its law, a table. */
void tl_lua_push_contact_points(lua_State *L, tl_model *model, tl_id contact);
void tl_lua_push_contact_states(lua_State *L, tl_model *model, tl_id contact);

extern const tl_lua_kind tl_lua_block_kind, tl_lua_contact_kind;
extern const tl_lua_spec tl_lua_blocks_spec, tl_lua_contacts_spec, tl_lua_fix_spec, tl_lua_set_spec;
/* Methods of the model. */
int tl_lua_blocks(lua_State *L);
int tl_lua_contacts(lua_State *L);

/* ---- what verbs of blocks share: verb.c ---- */

/* The selection of blocks at index 1, of a verb that takes `most` arguments with it. */
tl_lua_selection *tl_lua_blocks_self(lua_State *L, int most, const char *method);
/* Raises on failure; otherwise answers with the selection itself. */
int tl_lua_blocks_done(lua_State *L, const tl_lua_selection *blocks, tl_status status);
/* The same of a verb that is of no use to an empty selection: a remark says so, "VERB: ...: no block was DONE". */
int tl_lua_blocks_acted(lua_State *L, const tl_lua_selection *blocks, const char *verb,
                        const char *done, tl_status status);

/* ---- loads and drives: action.c ---- */

/* What a drive's functions hang on: action.c. */
typedef struct tl_lua_anchor {
    bool ended;
} tl_lua_anchor;

extern const tl_lua_key tl_lua_drive_keys[];
int tl_lua_blocks_load(lua_State *L);
int tl_lua_blocks_drive(lua_State *L);
int tl_lua_blocks_reaction(lua_State *L);
/* Pushes the reaction of a selection; 1. */
int tl_lua_push_reaction(lua_State *L, const tl_lua_selection *blocks);

/* Pushes a new anchor and hangs it on the model at `model_index`; it counts as ended until the kernel has taken it. */
tl_lua_anchor *tl_lua_anchor_push(lua_State *L, int model_index);
/* The functions of a drive for the anchor `a`, which is at the top of the stack: those that it has. */
void tl_lua_anchor_drive(lua_State *L, tl_lua_anchor *a, tl_drive *drive);
/* Which user values of an anchor are its functions. */
enum { TL_LUA_VELOCITY = 1, TL_LUA_ANGULAR_VELOCITY, TL_LUA_MOTIONS = 2 };

/* ---- copies and files: state.c ---- */

extern const tl_lua_key tl_lua_restore_keys[];
int tl_lua_copy(lua_State *L);
int tl_lua_save(lua_State *L);
int tl_lua_restore(lua_State *L);
int tl_lua_resumed(lua_State *L);

/* ---- runs that are saved as they go: autosave.c ---- */

/* The file of a script's saves, SCRIPT.autosave.talus, from malloc; NULL when out of memory. */
char *tl_lua_autosave_path(const char *script);
/* Between two steps of a run: saves the model when it is time to. */
void tl_lua_autosave(tl_lua_options *options, tl_model *model);

/* ---- pages: page.c; extra fields of files and pages: extra_fields.c ---- */

/* Keys of a table with fields that a script adds. */
#define TL_LUA_FIELD_KEYS                                                                          \
    {"block_fields", "{\"FIELD\", NAME = \"FIELD\" or function(block)}",                           \
     "numbers of each block to colour by: fields of blocks, and functions that give a number, or " \
     "nil for none"},                                                                              \
    {                                                                                              \
        "contact_fields", "{\"FIELD\", NAME = \"FIELD\" or function(contact)}",                    \
            "numbers of each contact, likewise: fields of contacts, states of their laws, "        \
            "functions"                                                                            \
    }

/* Keys of a table that says what a page shows. */
#define TL_LUA_PAGE_KEYS                                                                           \
    {"contacts", "true, false or \"slipping\"",                                                    \
     "which contacts the frame has; when left out all, where there are 20000 at the most, and "    \
     "else those that slip"},                                                                      \
        TL_LUA_FIELD_KEYS,                                                                         \
        {"keyblocks", "{friction =, cohesion =, gravity =}",                                       \
         "parameters of model:keyblocks, whose modes and factors of safety are shown as well"},    \
    {                                                                                              \
        "safety_limit", "number", "factor of safety that is asked for: the legend marks it"        \
    }

extern const tl_lua_key tl_lua_page_keys[];
extern const tl_lua_key tl_lua_field_keys[];
int tl_lua_write_html(lua_State *L);
/* Reads these of the table at `given`, if there is one, for a page of the model at index 1. Pushes values that must stay on the
 * stack as long as they are used. */
void tl_lua_page_read(lua_State *L, int given, const char *context, tl_html *html);

/* The extra fields that the table at `table` asks for under `key`: {"field", name = "field", name = function(item) ... end}, of
 * all blocks or all contacts (`kind`) of the model at index 1. `context` names the method. Pushes one value, which must stay on
 * the stack as long as they are used. */
const tl_extra_field *tl_lua_extra_fields(lua_State *L, int table, const char *key,
                                          const char *context, const tl_lua_kind *kind,
                                          size_t *count);

/* ---- seen while it runs: view.c ---- */

extern const tl_lua_key tl_lua_view_keys[];
int tl_lua_view(lua_State *L);
/* After a step of the model at index 1: shows it when it is time to; `worth` as of tl_view_due. A function of the script that
 * fails is told, and asked no more. False, with the error on the top of the stack, after a Ctrl-C. */
bool tl_lua_view_step(lua_State *L, double worth);
/* Before a step: does what those who look want, and waits while they want it to; false likewise. */
bool tl_lua_view_between(lua_State *L);
/* As the model goes, which is at index 1. */
void tl_lua_view_end(lua_State *L, tl_lua_model *owner);

/* ---- help: help.c, topics.c ---- */

/* One function in the help: how it is called, and where its parameters are declared. */
typedef struct tl_lua_topic {
    const char *name, *usage, *doc;
    const char *function;     /* of the kernel, whose parameters it takes; or NULL */
    const tl_lua_spec *spec;  /* of the front end; or NULL */
    const tl_lua_key *keys;   /* further parameters; or NULL */
    const tl_lua_kind *kind;  /* what a selection it gives is of; or NULL */
    const char *title;        /* heading of `verbs` */
    const tl_lua_key *verbs;  /* methods or fields of what it gives; or NULL */
    const tl_kind_type *type; /* plugins it takes by name; or NULL */
} tl_lua_topic;

/* All functions in the order of the reference; the last has no name. */
extern const tl_lua_topic tl_lua_topics[];

/* Prints help on a topic, or the overview for NULL; false when there is none of that name, with a
 * sentence in `error`. */
bool tl_lua_help(const char *topic, tl_error *error);
/* Prints what plugins are loaded and what was refused. */
void tl_lua_help_plugins(void);

/* ---- undeclared globals: strict.c ---- */

/* From now on reading a global that was never assigned raises. */
void tl_lua_strict(lua_State *L);

#endif
