/* help_search.c - which pages of the help speak of a word that is the name of none. */
#include "help_search.h"

#include <ctype.h>
#include <string.h>
#include <talus/fields.h>

/* Whether a text has the word, in any letters. */
static bool says(const char *text, const char *word)
{
    size_t length = strlen(word);
    for (; text && *text; text++) {
        size_t same = 0;
        while (same < length &&
               tolower((unsigned char)text[same]) == tolower((unsigned char)word[same]))
            same++;
        if (same == length)
            return true;
    }
    return false;
}

static bool params_say(const tl_param *params, size_t count, size_t stride, const char *word)
{
    bool any = false;
    for (size_t i = 0; i < count && !any; i++) {
        const tl_param *param = (const tl_param *)(const void *)((const char *)params + i * stride);
        any = says(param->name, word) || says(param->doc, word);
    }
    return any;
}

static bool keys_say(const tl_lua_key *keys, const char *word)
{
    bool any = false;
    for (; keys && keys->name && !any; keys++)
        any = says(keys->name, word) || says(keys->doc, word);
    return any;
}

static bool fields_say(const tl_field *(*list)(size_t *count), const char *word)
{
    size_t count;
    const tl_field *fields = list(&count);
    bool any = false;
    for (size_t i = 0; i < count && !any; i++)
        any = says(fields[i].name, word) || says(fields[i].doc, word);
    return any;
}

bool tl_lua_topic_says(const tl_lua_topic *topic, const char *word)
{
    size_t count = topic->spec ? topic->spec->count : 0;
    const tl_param *params = topic->spec ? topic->spec->params : NULL;
    const char *doc = topic->doc;
    if (topic->function)
        params = tl_function_params(topic->function, &count, &doc);
    const tl_lua_key *keys = topic->spec ? topic->spec->keys : topic->keys;
    return says(topic->usage, word) || says(doc, word) ||
           params_say(params, count, sizeof(tl_param), word) || keys_say(keys, word) ||
           keys_say(topic->verbs, word) ||
           (topic->kind &&
            (fields_say(topic->kind->fields, word) || keys_say(topic->kind->extra_keys, word)));
}

bool tl_lua_topic_names(const tl_lua_topic *topic, const char *word)
{
    const size_t length = strlen(word);
    for (const tl_lua_key *key = topic->verbs; key && key->name; key++)
        for (const char *at = strchr(key->name, ':'); at; at = strchr(at + 1, ':'))
            if (strncmp(at + 1, word, length) == 0 &&
                (at[1 + length] == '(' || at[1 + length] == '{'))
                return true;
    return false;
}

bool tl_lua_kind_says(const tl_kind *kind, const char *word)
{
    bool any = says(kind->doc, word) ||
               params_say(kind->params, kind->param_count, kind->param_stride, word);
    for (uint32_t i = 0; i < kind->state_count && !any; i++) {
        const char *at = (const char *)kind->states + i * (size_t)kind->state_stride;
        const tl_state *state = (const tl_state *)(const void *)at;
        any = says(state->name, word) || says(state->doc, word);
    }
    return any;
}
