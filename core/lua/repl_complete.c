/* repl_complete.c - completion of names at the prompt.
 *
 * What may stand at the cursor follows from what stands before it.
 *   after `x.` or `x:`: fields and methods of what x is;
 *   in `f{`, `f("..", {`: keys of the table of options of f, or parameters of the plugin that is named;
 *   in quotes: plugins of generate, joint and damping, choices of an option, fields for sum and the like;
 *   else: globals and Lua's words.
 *
 * Names come from the tables that check a script. Nothing of the script is run: x is found by looking up names
 * without metamethods. What a call gives follows from the name of its function. */
#include "lua/repl_complete.h"

#include "lua/block.h"
#include "lua/contact.h"
#include "lua/topics.h"

#include <editline/readline.h>
#include <stdlib.h>
#include <string.h>

#define NAME 64       /* longest name that is heeded, with its zero */
#define LEVELS 32     /* of brackets; deeper ones are not told apart */
#define LONGEST 16384 /* characters of a chunk, for `resolve` calls itself for each `.` of it */

/* One open bracket. */
typedef struct scan_level {
    char bracket;      /* ( { or [ */
    char callee[NAME]; /* the name right before it: of the function that is called; or "" */
    char quoted[NAME]; /* the last text in quotes inside it, of this level; or "" */
    char of[NAME];     /* the key whose value it is: `of = {`; or "" */
    char key[NAME];    /* the key inside it whose value is due: `key = CURSOR`; or "" */
} scan_level;

typedef struct scan_state {
    scan_level levels[LEVELS]; /* levels[0] is no bracket but the whole chunk */
    int depth;                 /* levels[depth] is the innermost */
    char before;               /* last character that counts: of a name 'a', of a text in quotes '"'; 0: none */
    /* the last name, when `before` is 'a'; in quotes: the name right before the quotes, or "" */
    char name[NAME];
    bool in_quotes, in_comment;
} scan_state;

static struct {
    lua_State *L;
    const char *above; /* lines of the chunk above this one, or NULL */
    char **names;      /* matches, from malloc */
    size_t count, capacity, next;
} completion;

/* ---------------------------------------------------------------- matches ---------------- */

static void forget_matches(void)
{
    for (size_t i = 0; i < completion.count; i++)
        free(completion.names[i]);
    completion.count = completion.next = 0;
}

/* Adds a name that begins with the word; one for which there is no memory is left out. */
static void add(const char *word, const char *name)
{
    if (strncmp(name, word, strlen(word)) != 0)
        return;
    for (size_t i = 0; i < completion.count; i++)
        if (strcmp(completion.names[i], name) == 0)
            return;
    if (completion.count == completion.capacity) {
        size_t capacity = completion.capacity ? 2 * completion.capacity : 64;
        char **names = realloc(completion.names, capacity * sizeof *names);
        if (!names)
            return;
        completion.names = names;
        completion.capacity = capacity;
    }
    completion.names[completion.count] = strdup(name);
    completion.count += completion.names[completion.count] != NULL;
}

/* The next match, as libedit asks for them. */
static char *next_match(const char *word, int state)
{
    (void)word;
    if (state == 0)
        completion.next = 0;
    return completion.next < completion.count ? strdup(completion.names[completion.next++]) : NULL;
}

/* ---------------------------------------------------------------- what is declared ------- */

static const tl_lua_topic *find_topic(const char *name)
{
    const tl_lua_topic *topic;
    for (size_t k = 0; (topic = tl_lua_topic_at(k)) != NULL; k++)
        if (strcmp(topic->name, name) == 0)
            return topic;
    return NULL;
}

static void add_params(const char *word, const tl_param *params, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        add(word, params[i].name);
        if (params[i].alias)
            add(word, params[i].alias);
    }
}

/* The choices of the parameter of that name. */
static void add_choices(const char *word, const tl_param *params, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++)
        if (params[i].type == TL_PARAM_ENUM && strcmp(params[i].name, name) == 0)
            for (const char *const *choice = params[i].choices; *choice; choice++)
                add(word, *choice);
}

static size_t name_length(const char *text)
{
    size_t length = 0;
    while (tl_scan_is_name(text[length]))
        length++;
    return length;
}

static void copy(char *name, const char *from, size_t length)
{
    length = length < NAME ? length : NAME - 1;
    memcpy(name, from, length);
    name[length] = 0;
}

/* The name with which a text begins. */
static void add_first(const char *word, const char *text)
{
    char name[NAME];
    copy(name, text, name_length(text));
    if (name[0])
        add(word, name);
}

/* The texts in quotes that a text has: "one of \"line\", \"points\"". */
static void add_quoted(const char *word, const char *text)
{
    const char *begin = strchr(text, '"'), *end;
    for (; begin && (end = strchr(begin + 1, '"')) != NULL; begin = strchr(end + 1, '"'))
        if (end == begin + 1 + name_length(begin + 1))
            add_first(word, begin + 1);
}

/* The choices of a key, which its type or description tells. */
static void add_told(const char *word, const tl_lua_key *keys, const char *name)
{
    for (; keys && keys->name; keys++)
        if (strcmp(keys->name, name) == 0) {
            add_quoted(word, keys->type);
            add_quoted(word, keys->doc);
        }
}

static void add_plugins(const char *word, tl_kind_type type)
{
    const tl_kind *kind;
    for (size_t i = 0; (kind = tl_plugin_kind(type, i)) != NULL; i++)
        add(word, kind->name);
}

static void add_keys(const char *word, const tl_lua_key *keys)
{
    for (; keys && keys->name; keys++)
        add(word, keys->name);
}

static void add_fields(const char *word, const tl_lua_kind *kind)
{
    size_t count;
    const tl_field *fields = kind->fields(&count);
    for (size_t i = 0; i < count; i++)
        add(word, fields[i].name);
    add_keys(word, kind->extra_keys);
}

/* Fields of the model, which its topic tells as "model.time, model.cycles". */
static void add_model_fields(const char *word)
{
    static const char mark[] = "model.";
    const tl_lua_topic *topic = find_topic("model");
    for (const tl_lua_key *key = topic ? topic->verbs : NULL; key && key->name; key++)
        for (const char *at = key->name; (at = strstr(at, mark)) != NULL;)
            add_first(word, at += sizeof mark - 1);
}

/* ---------------------------------------------------------------- the line before the cursor ---
 *
 * Reads an unfinished piece of Lua up to the cursor: which brackets are open, what is called with them, whether
 * the cursor is in quotes. It need not judge what it reads; text in long brackets is taken for code. */

bool tl_scan_is_name(char c)
{
    return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

static void open_bracket(scan_state *scan, char bracket)
{
    if (scan->depth + 1 == LEVELS)
        return;
    scan_level *outer = &scan->levels[scan->depth], *inner = outer + 1;
    *inner = (scan_level){.bracket = bracket};
    if (scan->before == 'a')
        copy(inner->callee, scan->name, strlen(scan->name));
    else if (scan->before == '=')
        copy(inner->of, outer->key, strlen(outer->key));
    scan->depth++;
}

/* A character that is no part of a name, of quotes or of a comment. */
static void read_sign(scan_state *scan, char c)
{
    scan_level *level = &scan->levels[scan->depth];
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

/* Reads the first `length` characters of the text. */
static void scan_text(const char *text, size_t length, scan_state *scan)
{
    *scan = (scan_state){0};
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
            end = i + name_length(text + i);
            copy(scan->name, text + i, end - i);
            scan->before = 'a';
        } else if (c != ' ' && c != '\t' && c != '\n')
            read_sign(scan, c);
        i = end;
    }
}

static size_t scan_back(const char *text, size_t end)
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

/* ---------------------------------------------------------------- what an expression is -- */

/* What stands before a point or colon; VALUE is on the top of the stack, and only then is anything. */
typedef enum object_type { UNKNOWN, VALUE, MODEL, BLOCKS, CONTACTS, BLOCK, CONTACT } object_type;

static const char *const type_names[] = {[MODEL] = TL_LUA_MODEL_TYPE,
                                         [BLOCKS] = TL_LUA_BLOCKS,
                                         [CONTACTS] = TL_LUA_CONTACTS,
                                         [BLOCK] = TL_LUA_BLOCK,
                                         [CONTACT] = TL_LUA_CONTACT};

static object_type resolve(lua_State *L, const char *text, size_t end);

/* Pops a value of one of our own types and says which it is; leaves any other. */
static object_type classify(lua_State *L)
{
    for (object_type t = MODEL; t <= CONTACT; t++)
        if (luaL_testudata(L, -1, type_names[t])) {
            lua_pop(L, 1);
            return t;
        }
    return VALUE;
}

/* Replaces the table on the top of the stack by what it has under the key there. */
static object_type look_up(lua_State *L)
{
    if (!lua_istable(L, -2)) {
        lua_pop(L, 2);
        return UNKNOWN;
    }
    lua_rawget(L, -2);
    lua_remove(L, -2);
    return classify(L);
}

static size_t name_begin(const char *text, size_t end)
{
    while (end > 0 && tl_scan_is_name(text[end - 1]))
        end--;
    return end;
}

/* A name, alone or after a point: text[begin] to text[end - 1]. */
static object_type resolve_name(lua_State *L, const char *text, size_t begin, size_t end)
{
    bool member = begin > 0 && text[begin - 1] == '.';
    if (begin > 0 && text[begin - 1] == ':')
        return UNKNOWN;
    if (!member)
        lua_pushglobaltable(L);
    else if (resolve(L, text, begin - 1) != VALUE)
        return UNKNOWN;
    lua_pushlstring(L, text + begin, end - begin);
    return look_up(L);
}

/* The call whose brackets begin at `begin`: by the function's name. A method of a selection that is no topic of its own
 * gives the selection. */
static object_type resolve_call(lua_State *L, const char *text, size_t begin)
{
    char name[NAME];
    while (begin > 0 && text[begin - 1] == ' ')
        begin--;
    size_t at = name_begin(text, begin);
    if (at == begin || begin - at >= sizeof name)
        return UNKNOWN;
    copy(name, text + at, begin - at);
    const tl_lua_topic *topic = find_topic(name);
    if (topic && topic->kind)
        return topic->kind == &tl_lua_block_kind ? BLOCKS : CONTACTS;
    if (topic && strncmp(topic->usage, "model = ", 8) == 0)
        return MODEL;
    if (at == 0 || text[at - 1] != ':')
        return UNKNOWN;
    object_type of = resolve(L, text, at - 1);
    if (of == VALUE)
        lua_pop(L, 1);
    return of == BLOCKS || of == CONTACTS ? of : UNKNOWN;
}

static object_type resolve_index(lua_State *L, const char *text, size_t begin, size_t end)
{
    object_type of = resolve(L, text, begin);
    if (of == BLOCKS || of == CONTACTS)
        return of == BLOCKS ? BLOCK : CONTACT;
    if (of != VALUE)
        return UNKNOWN;
    char *rest;
    long index = strtol(text + begin + 1, &rest, 10);
    if (rest != text + end - 1) {
        lua_pop(L, 1);
        return UNKNOWN;
    }
    lua_pushinteger(L, index);
    return look_up(L);
}

/* What the expression that ends before `end` is. */
static object_type resolve(lua_State *L, const char *text, size_t end)
{
    luaL_checkstack(L, 8, "completion");
    while (end > 0 && text[end - 1] == ' ')
        end--;
    if (end == 0)
        return UNKNOWN;
    size_t begin = name_begin(text, end);
    if (begin < end)
        return resolve_name(L, text, begin, end);
    begin = scan_back(text, end);
    if (begin == end)
        return UNKNOWN;
    return text[end - 1] == ']' ? resolve_index(L, text, begin, end) : resolve_call(L, text, begin);
}

/* ---------------------------------------------------------------- places ----------------- */

/* The names that a table on the top of the stack has, which is popped. */
static void add_table(lua_State *L, const char *word)
{
    if (lua_istable(L, -1))
        for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1))
            if (lua_type(L, -2) == LUA_TSTRING)
                add(word, lua_tostring(L, -2));
    lua_pop(L, 1);
}

/* Methods of a type: its __index has a table of them among its upvalues. */
static void add_methods(lua_State *L, const char *word, const char *type)
{
    luaL_getmetatable(L, type);
    if (lua_istable(L, -1) && lua_getfield(L, -1, "__index") == LUA_TFUNCTION) {
        for (int i = 1; lua_getupvalue(L, -1, i); i++)
            add_table(L, word);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

static void complete_member(lua_State *L, const char *word, const char *text, size_t end, char sign)
{
    object_type of = resolve(L, text, end);
    if (of == VALUE && lua_isstring(L, -1) && sign == ':') {
        lua_getglobal(L, "string");
        add_table(L, word);
    } else if (of == VALUE)
        add_table(L, word);
    else if (sign == ':' && (of == MODEL || of == BLOCKS || of == CONTACTS))
        add_methods(L, word, type_names[of]);
    else if (sign == '.' && of == MODEL)
        add_model_fields(word);
    else if (sign == '.' && (of == BLOCK || of == CONTACT))
        add_fields(word, of == BLOCK ? &tl_lua_block_kind : &tl_lua_contact_kind);
}

static void complete_global(lua_State *L, const char *word)
{
    static const char *const words[] = {
        "and", "break", "do",  "else", "elseif", "end",    "false",  "for",  "function", "goto",  "if",
        "in",  "local", "nil", "not",  "or",     "repeat", "return", "then", "true",     "until", "while",
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        add(word, words[i]);
    lua_pushglobaltable(L);
    add_table(L, word);
}

/* The call in whose table of options the cursor is, directly or in a list of such tables, and the plugin it names. */
static const tl_lua_topic *options_of(const scan_state *scan, const tl_kind **kind)
{
    int depth = scan->depth;
    const scan_level *level = &scan->levels[depth];
    *kind = NULL;
    if (level->bracket != '{')
        return NULL;
    while (level->bracket == '{' && !level->callee[0] && !level->of[0])
        level = &scan->levels[--depth];
    const tl_lua_topic *topic = level->callee[0] ? find_topic(level->callee) : NULL;
    if (topic && topic->has_type)
        *kind = tl_plugin_find(topic->type, level->quoted);
    return topic;
}

/* A key of the options; false when the cursor is in none. */
static bool complete_key(const char *word, const scan_state *scan)
{
    const tl_kind *kind;
    const tl_lua_topic *topic = options_of(scan, &kind);
    if (!topic || (scan->before != '{' && scan->before != ',' && scan->before != ';'))
        return false;
    tl_lua_spec spec = tl_lua_topic_spec(topic);
    add_params(word, spec.params, spec.count);
    add_keys(word, spec.keys);
    if (kind)
        add_params(word, kind->params, kind->param_count);
    const tl_kind *any;
    bool all = topic->has_type && !kind && topic->type == TL_KIND_LAW; /* joint("J1", {...}) */
    for (size_t i = 0; all && (any = tl_plugin_kind(topic->type, i)) != NULL; i++)
        add_params(word, any->params, any->param_count);
    return true;
}

static void add_all_fields(const char *word)
{
    add_fields(word, &tl_lua_block_kind);
    add_fields(word, &tl_lua_contact_kind);
}

static void complete_quotes(const char *word, const scan_state *scan)
{
    const scan_level *level = &scan->levels[scan->depth];
    const tl_kind *kind;
    const tl_lua_topic *topic = options_of(scan, &kind);
    if (topic && scan->before == '=') {
        tl_lua_spec spec = tl_lua_topic_spec(topic);
        add_choices(word, spec.params, spec.count, level->key);
        add_told(word, spec.keys, level->key);
        if (strcmp(level->key, "field") == 0)
            add_all_fields(word);
        if (kind)
            add_choices(word, kind->params, kind->param_count, level->key);
        return;
    }
    static const char *const of_fields[] = {"sum", "max", "min", "values"};
    const char *callee = scan->name[0] ? scan->name : level->bracket == '(' ? level->callee : "";
    topic = find_topic(callee);
    if (topic && topic->has_type)
        add_plugins(word, topic->type);
    for (size_t i = 0; i < sizeof of_fields / sizeof *of_fields; i++)
        if (strcmp(callee, of_fields[i]) == 0)
            add_all_fields(word);
}

/* The word after `help`. */
static void complete_topic(const char *word)
{
    const tl_lua_topic *topic;
    for (size_t k = 0; (topic = tl_lua_topic_at(k)) != NULL; k++)
        add(word, topic->name);
    for (int type = TL_KIND_LAW; type <= TL_KIND_ELEMENT; type++)
        add_plugins(word, (tl_kind_type)type);
}

/* Whether the line is `help WORD`, or talus.help "WORD". */
static bool asks_help(const char *text, const scan_state *scan)
{
    const scan_level *level = &scan->levels[scan->depth];
    if (scan->in_quotes)
        return strcmp(scan->name[0] ? scan->name : level->callee, "help") == 0;
    return scan->depth == 0 && scan->before == 'a' && strcmp(scan->name, "help") == 0 && strncmp(text, "help ", 5) == 0;
}

/* Runs protected. Argument: the word, as a light userdata, with which the line ends that is typed. */
static int complete(lua_State *L)
{
    size_t length;
    const char *word = lua_touserdata(L, 1), *above = completion.above;
    lua_pushstring(L, above ? above : "");
    lua_pushstring(L, above ? "\n" : "");
    lua_pushlstring(L, rl_line_buffer, (size_t)(rl_point - (int)strlen(word)));
    lua_concat(L, 3);
    const char *text = lua_tolstring(L, -1, &length);
    scan_state scan;
    if (length > LONGEST)
        return 0;
    scan_text(text, length, &scan);
    if (asks_help(text, &scan))
        complete_topic(word);
    else if (scan.in_quotes)
        complete_quotes(word, &scan);
    else if (scan.in_comment)
        return 0;
    else if (scan.before == '.' || scan.before == ':')
        complete_member(L, word, text, length - 1, scan.before);
    else if (!complete_key(word, &scan))
        complete_global(L, word);
    return 0;
}

/* ---------------------------------------------------------------- libedit ---------------- */

static char **on_tabulator(const char *word, int start, int end)
{
    (void)start;
    (void)end;
    lua_State *L = completion.L;
    int top = lua_gettop(L);
    forget_matches();
    if (!lua_checkstack(L, 8))
        return NULL;
    lua_pushcfunction(L, complete);
    lua_pushlightuserdata(L, (void *)(uintptr_t)word);
    lua_pcall(L, 1, 0, 0); /* for want of memory there are fewer names */
    lua_settop(L, top);
    rl_attempted_completion_over = 1; /* no names of files */
    return completion.count ? rl_completion_matches(word, next_match) : NULL;
}

void tl_repl_complete(lua_State *L, const char *above)
{
    /* whatever no name is made of */
    static char breaks[] = " \t\n\"'`\\@$><=;|&{}()[],.:+-*/%^#~!?";
    completion.L = L;
    completion.above = above;
    rl_attempted_completion_function = on_tabulator;
    rl_basic_word_break_characters = breaks;
    rl_completer_word_break_characters = breaks;
    rl_completion_append_character = '\0';
}
