/* kinds.c - laws, damping, solids and kinds of elements in an archive.
 *
 *     PREFIX.kind      name of the law or damping, "coulomb"
 *     PREFIX.plugin    id and version of its plugin, "talus.coulomb 1.0"
 *     PREFIX.param.X   parameter X: numbers, or the name of its choice
 *     PREFIX.states    names of its states, a line each
 *     PREFIX.scope     of a law that names blocks: its order, how many of two it names, and their groups or TL_NO_ROW
 *     PREFIX.blocks.K  the ids of its side K where that is no group, a bit each
 *     PREFIX.pairs     its pairs of blocks, ids a < b: a 2^32 + b, ascending
 *
 * PREFIX is "damping", or "law.0", "law.1", ... with PREFIX.tag, the joint that it rules, or "solid.0", ... with
 * PREFIX.name, or "element.0", ... with PREFIX.group and PREFIX.placed, the structure for which it was placed. A
 * parameter that is a table is a list of its rows. Parameters are checked as those of a script are. */
#include "state/kinds.h"

#include "base/params.h"
#include "contact/contacts.h"
#include "cycle/cycle_data.h"
#include "cycle/damping.h"
#include "cycle/joint_law.h"
#include "element/life.h"
#include "element/set.h"
#include "force/joint_laws.h"
#include "model/scope.h"
#include "plugin/descriptor.h"
#include "zone/grid.h"
#include "zone/life.h"
#include "zone/solids.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Longest prefix. */
#define PREFIX 32
/* Longest list of names of states, and longest name of a plugin with its version. */
#define NAMES 1024
#define PLUGIN_NAME 256

static void plugin_text(const tl_kind *kind, char text[PLUGIN_NAME])
{
    const tl_plugin *plugin = tl_plugin_of(kind, NULL);
    snprintf(text, PLUGIN_NAME, "%s %s", plugin ? plugin->id : "?", plugin ? plugin->version : "?");
}

static void state_names(const tl_kind *kind, char text[NAMES])
{
    size_t length = 0;
    text[0] = '\0';
    for (uint32_t k = 0; k < kind->state_count && length < NAMES; k++)
        length += (size_t)snprintf(text + length, NAMES - length, "%s\n", tl_kind_state(kind, k)->name);
}

/* ---------------------------------------------------------------- saving ----------------- */

static void put_param(tl_archive_writer *w, const char *prefix, const tl_param *p, const void *params)
{
    char name[TL_CHUNK_NAME];
    const char *at = (const char *)params + p->offset;
    int32_t choice;
    tl_chunk_name(name, "%s.param.%s", prefix, p->name);
    if (p->type == TL_PARAM_STRING) {
        const char *text;
        memcpy(&text, at, sizeof text);
        if (text)
            tl_archive_put_text(w, name, text);
    } else if (p->type == TL_PARAM_POINTS) {
        tl_points rows;
        memcpy(&rows, at, sizeof rows);
        tl_archive_put(w, name, rows.at, sizeof *rows.at, rows.count);
    } else if (p->type == TL_PARAM_ENUM) {
        memcpy(&choice, at, sizeof choice);
        tl_archive_put_text(w, name, p->choices[choice]);
    } else {
        tl_archive_put(w, name, at, tl_param_bytes(p->type), 1);
    }
}

static void put_kind(tl_archive_writer *w, const char *prefix, const tl_kind *kind, const void *params)
{
    char name[TL_CHUNK_NAME], text[NAMES], plugin[PLUGIN_NAME];
    plugin_text(kind, plugin);
    state_names(kind, text);
    tl_archive_put_text(w, tl_chunk_name(name, "%s.kind", prefix), kind->name);
    tl_archive_put_text(w, tl_chunk_name(name, "%s.plugin", prefix), plugin);
    tl_archive_put_text(w, tl_chunk_name(name, "%s.states", prefix), text);
    for (uint32_t k = 0; k < kind->param_count; k++) {
        tl_param p = tl_param_row(kind->params, k, kind->param_stride);
        put_param(w, prefix, &p, params);
    }
}

static void put_scope(tl_archive_writer *w, const char *prefix, const tl_scope *s)
{
    char name[TL_CHUNK_NAME];
    const uint64_t head[] = {s->order, s->names, s->side[0].group, s->side[1].group};
    tl_archive_put(w, tl_chunk_name(name, "%s.scope", prefix), head, sizeof *head, 4);
    if (s->pairs)
        tl_archive_put(w, tl_chunk_name(name, "%s.pairs", prefix), s->pairs, sizeof *s->pairs, s->pair_count);
    for (uint32_t k = 0; k < 2; k++)
        if (s->side[k].list.word)
            tl_archive_put(w, tl_chunk_name(name, "%s.blocks.%u", prefix, k), s->side[k].list.word,
                           sizeof *s->side[k].list.word, s->side[k].list.words);
}

static void save_laws(const tl_model *m, tl_archive_writer *w)
{
    uint64_t count = m->joint_law_count;
    tl_archive_put(w, "laws", &count, sizeof count, 1);
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const tl_law *law = &m->joint_laws[i];
        char prefix[PREFIX], name[TL_CHUNK_NAME];
        snprintf(prefix, sizeof prefix, "law.%zu", i);
        tl_archive_put(w, tl_chunk_name(name, "%s.tag", prefix), &law->scope.tag, sizeof law->scope.tag, 1);
        if (law->scope.names > 0)
            put_scope(w, prefix, &law->scope);
        put_kind(w, prefix, law->kind, law->params);
    }
}

static void save_damping(const tl_model *m, tl_archive_writer *w)
{
    if (!m->damping)
        return;
    put_kind(w, "damping", m->damping, m->damping_params);
    tl_archive_put(w, "damping.state", m->damping_state, sizeof *m->damping_state, m->damping->state_count);
}

static void save_solids(const tl_model *m, tl_archive_writer *w)
{
    const uint64_t count = m->zones ? m->zones->solid_count : 0;
    if (count > 0)
        tl_archive_put(w, "solids", &count, sizeof count, 1);
    for (uint64_t k = 0; k < count; k++) {
        const tl_named_solid *solid = &m->zones->solid[k];
        char prefix[PREFIX], name[TL_CHUNK_NAME];
        snprintf(prefix, sizeof prefix, "solid.%" PRIu64, k);
        tl_archive_put_text(w, tl_chunk_name(name, "%s.name", prefix), solid->name);
        put_kind(w, prefix, solid->of.kind, solid->of.params);
    }
}

static void save_elements(const tl_model *m, tl_archive_writer *w)
{
    if (!m->elements)
        return;
    const uint64_t count = m->elements->set_count;
    tl_archive_put(w, "elements", &count, sizeof count, 1);
    for (uint64_t k = 0; k < count; k++) {
        const tl_element_set *set = &m->elements->set[k];
        char prefix[PREFIX], name[TL_CHUNK_NAME];
        snprintf(prefix, sizeof prefix, "element.%" PRIu64, k);
        tl_archive_put(w, tl_chunk_name(name, "%s.group", prefix), &set->group, sizeof set->group, 1);
        tl_archive_put(w, tl_chunk_name(name, "%s.placed", prefix), &set->structure, sizeof set->structure, 1);
        put_kind(w, prefix, set->kind, set->params);
    }
}

/* ---------------------------------------------------------------- restoring -------------- */

/* Finds the law or damping of a prefix among the plugins, and sees that it is the same one. */
static tl_status find_kind(tl_model *m, const tl_archive *a, const char *prefix, tl_kind_type type,
                           const tl_kind **kind)
{
    char name[PLUGIN_NAME], plugin[PLUGIN_NAME], now[PLUGIN_NAME], states[NAMES], states_now[NAMES];
    char chunk[TL_CHUNK_NAME];
    if (!tl_archive_text(a, tl_chunk_name(chunk, "%s.kind", prefix), name, sizeof name) ||
        !tl_archive_text(a, tl_chunk_name(chunk, "%s.plugin", prefix), plugin, sizeof plugin))
        return tl_archive_bad(a, &m->error, "'%s' is missing", prefix);
    const char *what = tl_kind_type_name(type);
    *kind = tl_plugin_find(type, name);
    if (!*kind)
        return tl_fail(&m->error, TL_E_NOT_FOUND,
                       "cannot restore '%.200s': its %s '%.80s' is of the plugin %.120s, which is not "
                       "loaded: load it with --plugin, or name its folder in TALUS_PLUGIN_PATH",
                       a->path, what, name, plugin);
    plugin_text(*kind, now);
    if (strcmp(plugin, now) != 0)
        return tl_fail(&m->error, TL_E_STATE,
                       "cannot restore '%.200s': its %s '%.80s' is of the plugin %.120s, and %.120s is "
                       "loaded: load the plugin in the version that the file was saved with",
                       a->path, what, name, plugin, now);
    state_names(*kind, states_now);
    if (!tl_archive_text(a, tl_chunk_name(chunk, "%s.states", prefix), states, sizeof states) ||
        strcmp(states, states_now) != 0)
        return tl_archive_bad(a, &m->error, "%s '%s' has other states", what, name);
    return TL_OK;
}

/* A parameter as read, and storage for what it points to. */
typedef struct read_param {
    double numbers[3];
    char text[PLUGIN_NAME];
    void *rows; /* of a table or a text; from malloc */
} read_param;

/* A table. An empty one was not given. */
static bool read_rows(const tl_archive *a, const char *name, const tl_param *p, read_param *r, tl_value *value,
                      bool *given)
{
    const tl_chunk *chunk = tl_archive_find(a, name);
    if (!chunk || chunk->size != sizeof(tl_vec3) || chunk->items > SIZE_MAX / sizeof(tl_vec3))
        return false;
    const size_t count = (size_t)chunk->items;
    *given = count > 0;
    if (count == 0)
        return true;
    r->rows = malloc(count * sizeof(tl_vec3));
    value->type = p->flags & TL_PARAM_FLAT ? TL_VALUE_FLAT : TL_VALUE_POINTS;
    value->data = r->rows;
    value->count = count;
    return r->rows && tl_archive_get(a, name, r->rows, sizeof(tl_vec3), count);
}

/* A text; one that is not there was not given. */
static bool read_text(const tl_archive *a, const char *name, read_param *r, tl_value *value, bool *given)
{
    const tl_chunk *chunk = tl_archive_find(a, name);
    *given = chunk != NULL;
    value->type = TL_VALUE_STRING;
    if (!chunk)
        return true;
    if (chunk->size != 1 || chunk->items >= SIZE_MAX)
        return false;
    value->text = r->rows = malloc((size_t)chunk->items + 1);
    return r->rows && tl_archive_text(a, name, r->rows, (size_t)chunk->items + 1) && tl_text_is_utf8(r->rows);
}

/* Reads a parameter as a script would give it. false: it is not there. `*given` is false for one that was left out. */
static bool read_one(const tl_archive *a, const char *prefix, const tl_param *p, read_param *r, tl_value *value,
                     bool *given)
{
    char name[TL_CHUNK_NAME];
    int64_t whole;
    int32_t yes;
    tl_chunk_name(name, "%s.param.%s", prefix, p->name);
    *given = true;
    *value = (tl_value){.key = p->name, .type = TL_VALUE_NUMBER};
    switch (p->type) {
    case TL_PARAM_INT:
        if (!tl_archive_get(a, name, &whole, sizeof whole, 1))
            return false;
        value->number = (double)whole;
        return true;
    case TL_PARAM_BOOL:
        value->type = TL_VALUE_BOOL;
        if (!tl_archive_get(a, name, &yes, sizeof yes, 1))
            return false;
        value->number = yes != 0;
        return true;
    case TL_PARAM_POINTS: return read_rows(a, name, p, r, value, given);
    case TL_PARAM_STRING: return read_text(a, name, r, value, given);
    case TL_PARAM_ENUM:
        value->type = TL_VALUE_STRING;
        value->text = r->text;
        return tl_archive_text(a, name, r->text, sizeof r->text);
    case TL_PARAM_VEC3:
        value->type = TL_VALUE_NUMBERS;
        value->data = r->numbers;
        value->count = 3;
        *given = tl_archive_get(a, name, r->numbers, sizeof r->numbers, 1);
        break;
    default: *given = tl_archive_get(a, name, r->numbers, sizeof *r->numbers, 1); value->number = r->numbers[0];
    }
    bool there = *given;
    if (there && (p->flags & TL_PARAM_OPTIONAL) && isnan(r->numbers[0]))
        *given = false;
    return there;
}

static tl_status read_params(tl_model *m, const tl_archive *a, const char *prefix, const tl_kind *kind,
                             read_param *storage, tl_value *values, tl_args *args)
{
    *args = (tl_args){values, 0};
    for (uint32_t k = 0; k < kind->param_count; k++) {
        tl_param p = tl_param_row(kind->params, k, kind->param_stride);
        bool given;
        if (!read_one(a, prefix, &p, &storage[k], &values[args->count], &given))
            return tl_archive_bad(a, &m->error, "parameter '%s' of %s is missing", p.name, kind->name);
        args->count += given;
    }
    return TL_OK;
}

/* Puts the file's name before a sentence that does not bear it. */
static tl_status tell_path(tl_model *m, const tl_archive *a, tl_status status)
{
    return status == TL_OK || status == TL_E_MEMORY ? status
                                                    : tl_error_prefix(&m->error, "cannot restore '%.200s': ", a->path);
}

static tl_status restore_set(tl_model *m, const tl_kind *kind, const tl_args *args)
{
    struct tl_elements *e = m->elements;
    if (!tl_grow(&e->set, &e->set_capacity, e->set_count + 1, sizeof *e->set) ||
        !tl_elements_hold_states(e, tl_element_columns(kind, false), tl_element_columns(kind, true)))
        return tl_fail_memory(&m->error);
    const tl_status status = tl_element_set_make(kind, args, NULL, kind->name, &m->error, &e->set[e->set_count]);
    e->set_count += status == TL_OK;
    return status;
}

/* Makes what a prefix says: a law of that scope into `law`, a solid of that name, the last set of elements, or the
 * model's damping. */
static tl_status restore_kind(tl_model *m, const tl_archive *a, const char *prefix, tl_kind_type type,
                              const tl_scope *scope, tl_law *law, const char *solid)
{
    const tl_kind *kind = NULL;
    tl_status status = find_kind(m, a, prefix, type, &kind);
    if (status != TL_OK)
        return status;
    read_param *storage = calloc(kind->param_count + 1u, sizeof *storage);
    tl_value *values = calloc(kind->param_count + 1u, sizeof *values);
    tl_args args;
    status = storage && values ? read_params(m, a, prefix, kind, storage, values, &args) : tl_fail_memory(&m->error);
    if (status == TL_OK && law) {
        status = tell_path(m, a, tl_law_make_for(m, scope, kind, &args, NULL, law));
    } else if (status == TL_OK && type == TL_KIND_ELEMENT) {
        status = tell_path(m, a, restore_set(m, kind, &args));
    } else if (status == TL_OK) {
        status = tell_path(m, a, solid ? tl_solid_set(m, solid, kind, &args) : tl_damping_make(m, kind, &args, NULL));
    }
    for (uint32_t k = 0; storage && k < kind->param_count; k++)
        free(storage[k].rows);
    free(storage);
    free(values);
    return status;
}

/* Reads a list of numbers; TL_E_ARGUMENT when there are none. */
static tl_status read_words(tl_model *m, const tl_archive *a, const char *name, uint64_t **out, size_t *count)
{
    *count = tl_archive_items(a, name);
    if (*count == 0 || !tl_archive_has(a, name, sizeof **out, *count))
        return TL_E_ARGUMENT;
    *out = malloc(*count * sizeof **out);
    if (!*out)
        return tl_fail_memory(&m->error);
    return tl_archive_get(a, name, *out, sizeof **out, *count) ? TL_OK : TL_E_ARGUMENT;
}

/* The list of a side of a scope, or its group. */
static tl_status read_side(tl_model *m, const tl_archive *a, const char *prefix, uint32_t k, uint64_t group,
                           tl_scope_side *side)
{
    char name[TL_CHUNK_NAME];
    if (group < m->group_count) {
        side->group = (uint32_t)group;
        return TL_OK;
    }
    if (group != TL_NO_ROW)
        return TL_E_ARGUMENT;
    tl_chunk_name(name, "%s.blocks.%u", prefix, k);
    tl_status status = read_words(m, a, name, &side->list.word, &side->list.words);
    return status == TL_OK && side->list.words > (size_t)m->next_id / 64 + 1 ? TL_E_ARGUMENT : status;
}

static tl_status read_pairs(tl_model *m, const tl_archive *a, const char *name, tl_scope *s)
{
    tl_status status = read_words(m, a, name, &s->pairs, &s->pair_count);
    for (size_t i = 0; status == TL_OK && i < s->pair_count; i++)
        if (s->pairs[i] >> 32 >= (uint32_t)s->pairs[i] || (i > 0 && s->pairs[i - 1] >= s->pairs[i]))
            status = TL_E_ARGUMENT;
    return status;
}

/* Reads which blocks a law names; one that names none has no such chunk. */
static tl_status restore_scope(tl_model *m, const tl_archive *a, const char *prefix, tl_scope *s)
{
    uint64_t head[4];
    char name[TL_CHUNK_NAME], pairs[TL_CHUNK_NAME];
    if (!tl_archive_find(a, tl_chunk_name(name, "%s.scope", prefix)))
        return TL_OK;
    tl_status status =
        tl_archive_get(a, name, head, sizeof *head, 4) && head[1] >= 1 && head[1] <= 2 ? TL_OK : TL_E_ARGUMENT;
    const bool of_pairs = tl_archive_find(a, tl_chunk_name(pairs, "%s.pairs", prefix)) != NULL;
    if (status == TL_OK && of_pairs)
        status = head[1] == 2 ? read_pairs(m, a, pairs, s) : TL_E_ARGUMENT;
    for (uint32_t k = 0; status == TL_OK && !of_pairs && k < head[1]; k++)
        status = read_side(m, a, prefix, k, head[2 + k], &s->side[k]);
    if (status == TL_E_ARGUMENT)
        return tl_archive_bad(a, &m->error, "the blocks of '%s' do not fit", prefix);
    if (status == TL_OK) {
        s->order = head[0];
        s->names = (uint32_t)head[1];
    }
    return status;
}

static tl_status restore_laws(tl_model *m, const tl_archive *a)
{
    uint64_t count;
    if (!tl_archive_get(a, "laws", &count, sizeof count, 1) || count > a->chunk_count)
        return tl_archive_bad(a, &m->error, "'laws' is missing");
    m->joint_laws = calloc((size_t)count + 1, sizeof *m->joint_laws);
    if (!m->joint_laws)
        return tl_fail_memory(&m->error);
    while (m->joint_law_count < count) {
        char prefix[PREFIX], name[TL_CHUNK_NAME];
        snprintf(prefix, sizeof prefix, "law.%zu", m->joint_law_count);
        tl_scope scope = {.side = {{.group = TL_NO_ROW}, {.group = TL_NO_ROW}}};
        if (!tl_archive_get(a, tl_chunk_name(name, "%s.tag", prefix), &scope.tag, sizeof scope.tag, 1) ||
            scope.tag.joint > m->joint_count || (scope.tag.joint == 0 && scope.tag.plane > 0))
            return tl_archive_bad(a, &m->error, "'%s' is missing", prefix);
        tl_status status = restore_scope(m, a, prefix, &scope);
        if (status == TL_OK)
            status = restore_kind(m, a, prefix, TL_KIND_LAW, &scope, &m->joint_laws[m->joint_law_count], NULL);
        if (status != TL_OK) {
            tl_scope_clear(&scope);
            return status;
        }
        m->joint_law_count++;
    }
    tl_laws_follow_groups(m);
    return TL_OK;
}

static tl_status restore_damping(tl_model *m, const tl_archive *a)
{
    if (!tl_archive_find(a, "damping.kind"))
        return TL_OK;
    tl_status status = restore_kind(m, a, "damping", TL_KIND_DAMPING, NULL, NULL, NULL);
    if (status != TL_OK)
        return status;
    if (!tl_archive_get(a, "damping.state", m->damping_state, sizeof *m->damping_state, m->damping->state_count))
        return tl_archive_bad(a, &m->error, "'damping.state' is missing");
    return TL_OK;
}

static tl_status restore_solids(tl_model *m, const tl_archive *a)
{
    uint64_t count;
    if (!tl_archive_find(a, "solids"))
        return TL_OK;
    if (!tl_archive_get(a, "solids", &count, sizeof count, 1) || count > a->chunk_count)
        return tl_archive_bad(a, &m->error, "'solids' does not fit");
    tl_status status = tl_zones_begin(m);
    for (uint64_t k = 0; k < count && status == TL_OK; k++) {
        char prefix[PREFIX], chunk[TL_CHUNK_NAME], name[TL_SOLID_NAME];
        snprintf(prefix, sizeof prefix, "solid.%" PRIu64, k);
        if (!tl_archive_text(a, tl_chunk_name(chunk, "%s.name", prefix), name, sizeof name) ||
            tl_solid_find(m, name) != TL_NO_ROW)
            return tl_archive_bad(a, &m->error, "'%s' is missing or does not fit", prefix);
        status = restore_kind(m, a, prefix, TL_KIND_SOLID, NULL, NULL, name);
    }
    return status;
}

static tl_status restore_elements(tl_model *m, const tl_archive *a)
{
    uint64_t count;
    if (!tl_archive_find(a, "elements"))
        return TL_OK;
    if (!tl_archive_get(a, "elements", &count, sizeof count, 1) || count > a->chunk_count)
        return tl_archive_bad(a, &m->error, "'elements' does not fit");
    tl_status status = tl_elements_begin(m) ? TL_OK : tl_fail_memory(&m->error);
    for (uint64_t k = 0; k < count && status == TL_OK; k++) {
        char prefix[PREFIX], group[TL_CHUNK_NAME], placed[TL_CHUNK_NAME];
        tl_element_set had;
        snprintf(prefix, sizeof prefix, "element.%" PRIu64, k);
        tl_chunk_name(group, "%s.group", prefix);
        tl_chunk_name(placed, "%s.placed", prefix);
        if (!tl_archive_get(a, group, &had.group, sizeof had.group, 1) || had.group >= m->group_count ||
            !tl_archive_get(a, placed, &had.structure, sizeof had.structure, 1))
            return tl_archive_bad(a, &m->error, "'%s' is missing or does not fit", prefix);
        status = restore_kind(m, a, prefix, TL_KIND_ELEMENT, NULL, NULL, NULL);
        if (status == TL_OK) {
            m->elements->set[k].group = had.group;
            m->elements->set[k].structure = had.structure;
        }
    }
    return status;
}

/* ---------------------------------------------------------------- copying ---------------- */

static tl_status copy_laws(tl_model *to, const tl_model *from)
{
    if (from->joint_law_count == 0)
        return TL_OK;
    to->joint_laws = calloc(from->joint_law_count, sizeof *to->joint_laws);
    if (!to->joint_laws)
        return tl_fail_memory(&to->error);
    for (size_t i = 0; i < from->joint_law_count; i++) {
        const tl_law *law = &from->joint_laws[i];
        tl_scope scope;
        if (!tl_scope_copy(&law->scope, &scope))
            return tl_fail_memory(&to->error);
        tl_status status =
            tl_law_make_for(to, &scope, law->kind, &(tl_args){NULL, 0}, law, &to->joint_laws[to->joint_law_count]);
        if (status != TL_OK) {
            tl_scope_clear(&scope);
            return status;
        }
        to->joint_law_count++;
    }
    tl_laws_follow_groups(to);
    return TL_OK;
}

static tl_status copy_damping(tl_model *to, const tl_model *from)
{
    if (!from->damping)
        return TL_OK;
    tl_status status = tl_damping_make(to, from->damping, &(tl_args){NULL, 0}, from->damping_params);
    if (status == TL_OK && from->damping->state_count)
        memcpy(to->damping_state, from->damping_state, from->damping->state_count * sizeof *to->damping_state);
    return status;
}

static tl_status copy_solids(tl_model *to, const tl_model *from)
{
    tl_status status = from->zones ? tl_zones_begin(to) : TL_OK;
    for (size_t k = 0; from->zones && k < from->zones->solid_count && status == TL_OK; k++)
        status = tl_solid_copy(to, &from->zones->solid[k]);
    return status;
}

static tl_status copy_elements(tl_model *to, const tl_model *from)
{
    if (from->elements && !tl_elements_begin(to))
        return tl_fail_memory(&to->error);
    tl_status status = TL_OK;
    for (size_t k = 0; from->elements && k < from->elements->set_count && status == TL_OK; k++) {
        const tl_element_set *set = &from->elements->set[k];
        struct tl_elements *e = to->elements;
        if (!tl_grow(&e->set, &e->set_capacity, k + 1, sizeof *e->set) ||
            !tl_elements_hold_states(e, from->elements->nodes.state_columns, from->elements->table.state_columns))
            return tl_fail_memory(&to->error);
        status = tl_element_set_make(set->kind, &(tl_args){NULL, 0}, set, set->kind->name, &to->error, &e->set[k]);
        e->set_count += status == TL_OK;
    }
    return status;
}

const tl_state_part tl_laws_part = {save_laws, restore_laws, copy_laws};
const tl_state_part tl_damping_part = {save_damping, restore_damping, copy_damping};
const tl_state_part tl_solids_part = {save_solids, restore_solids, copy_solids};
const tl_state_part tl_elements_part = {save_elements, restore_elements, copy_elements};
