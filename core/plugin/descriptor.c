/* descriptor.c - checks what a plugin says about itself, and copies it into the host's own shape.
 *
 * The copy is what makes growth harmless: the rest of the kernel indexes dense arrays of today's
 * structs, whatever version of the headers the plugin was built with. A size that cannot belong to the
 * version a plugin claims is refused, since everything behind it would be misread. */
#include "plugin/descriptor.h"

#include "base/error.h"
#include "base/params.h"
#include "base/solid_columns.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* More rows than this in one array are a descriptor that was never initialised. */
#define MOST_ROWS 4096
/* Bytes from one row to the next: ours have some 120, and newer headers may add to them. */
#define MOST_STRIDE 4096
/* Bytes of a struct of parameters: one of MOST_ROWS reals is 32 KiB. */
#define MOST_PARAM_BYTES ((size_t)1 << 20)

/* Sizes of the structs in version 1.0 of the interface: no plugin can have smaller ones. */
enum {
    FIRST_PLUGIN_SIZE = sizeof(tl_plugin),
    FIRST_KIND_SIZE = sizeof(tl_kind),
    FIRST_PARAM_SIZE = sizeof(tl_param),
    FIRST_STATE_SIZE = sizeof(tl_state)
};

/* An operation, and where it lies in its struct. */
typedef struct operation {
    const char *name;
    size_t at;
} operation;

#define AT(ops, name) #name, offsetof(ops, name)

/* The types of kinds: sizes of their operations in version 1.0 and here, what must be there, and what comes in pairs or
 * not at all. */
static const struct {
    const char *name;
    size_t first, ours;
    operation needs[6], pair[2];
} types[] = {
    [TL_KIND_LAW] = {"law",
                     offsetof(tl_law_ops, stateless),
                     sizeof(tl_law_ops),
                     {{AT(tl_law_ops, update)}, {AT(tl_law_ops, stiffness)}},
                     {{AT(tl_law_ops, create)}, {AT(tl_law_ops, destroy)}}},
    [TL_KIND_DAMPING] = {"damping",
                         offsetof(tl_damping_ops, before),
                         sizeof(tl_damping_ops),
                         {{AT(tl_damping_ops, update)}, {AT(tl_damping_ops, step_factor)}},
                         {{AT(tl_damping_ops, create)}, {AT(tl_damping_ops, destroy)}}},
    [TL_KIND_GENERATOR] =
        {"generator", sizeof(tl_generator_ops), sizeof(tl_generator_ops), {{AT(tl_generator_ops, generate)}}, {{0}}},
    [TL_KIND_SCREEN] = {"screen",
                        sizeof(tl_screen_ops),
                        sizeof(tl_screen_ops),
                        {{AT(tl_screen_ops, open)},
                         {AT(tl_screen_ops, address)},
                         {AT(tl_screen_ops, watchers)},
                         {AT(tl_screen_ops, put)},
                         {AT(tl_screen_ops, take)},
                         {AT(tl_screen_ops, close)}},
                        {{0}}},
    [TL_KIND_SOLID] = {"solid",
                       sizeof(tl_solid_ops),
                       sizeof(tl_solid_ops),
                       {{AT(tl_solid_ops, update)}, {AT(tl_solid_ops, moduli)}},
                       {{AT(tl_solid_ops, create)}, {AT(tl_solid_ops, destroy)}}},
    [TL_KIND_ELEMENT] = {"element",
                         offsetof(tl_element_ops, together),
                         sizeof(tl_element_ops),
                         {{AT(tl_element_ops, place)}, {AT(tl_element_ops, update)}, {AT(tl_element_ops, stiffness)}},
                         {{AT(tl_element_ops, create)}, {AT(tl_element_ops, destroy)}}},
};

/* A plugin's headers, as it states them. */
typedef struct version {
    uint32_t minor;
    tl_error *error;
} version;

const char *tl_kind_type_name(uint32_t type)
{
    return type < sizeof types / sizeof *types ? types[type].name : "kind of unknown type";
}

static uint32_t size_of(const void *structure)
{
    uint32_t size;
    memcpy(&size, structure, sizeof size);
    return size;
}

/* A struct's size must fit the version: equal to ours at our minor, no smaller at a newer one, no
 * larger at an older one. */
static tl_status check_size(const version *v, const char *what, uint32_t size, size_t first, size_t ours)
{
    const uint32_t host_minor = TL_ABI_MINOR;
    bool fits = size == ours;
    if (v->minor < host_minor)
        fits = size >= first && size <= ours;
    else if (v->minor > host_minor)
        fits = size >= ours;
    if (fits)
        return TL_OK;
    return tl_fail(v->error, TL_E_PLUGIN, "%s has size %u, which is not that of ABI %u.%u (%zu here)", what, size,
                   TL_ABI_MAJOR, v->minor, ours);
}

/* Copies `count` rows that are `stride` apart into a dense array of rows of `ours` bytes. */
static tl_status copy_rows(const version *v, const char *what, const void *rows, uint32_t count, uint32_t stride,
                           size_t first, size_t ours, void **copy)
{
    *copy = NULL;
    if (count == 0)
        return TL_OK;
    if (!rows || count > MOST_ROWS)
        return tl_fail(v->error, TL_E_PLUGIN, "%s: a list of %u rows %s", what, count,
                       rows ? "is too long" : "is missing");
    char *to = calloc(count, ours);
    if (!to)
        return tl_fail_memory(v->error);
    for (uint32_t i = 0; i < count; i++) {
        const char *row = (const char *)rows + (size_t)i * stride;
        uint32_t size = size_of(row);
        tl_status status = check_size(v, what, size, first, ours);
        if (status == TL_OK && (stride < size || stride > MOST_STRIDE || stride % sizeof(void *) != 0))
            status = tl_fail(v->error, TL_E_PLUGIN, "%s: stride %u does not fit rows of %u bytes", what, stride, size);
        if (status != TL_OK) {
            free(to);
            return status;
        }
        memcpy(to + i * ours, row, size < ours ? size : ours);
    }
    *copy = to;
    return TL_OK;
}

/* ---------------------------------------------------------------- parameters ------------- */

static bool same(const char *a, const char *b)
{
    return a && b && strcmp(a, b) == 0;
}

static bool names_clash(const tl_param *a, const tl_param *b)
{
    return same(a->name, b->name) || same(a->name, b->alias) || same(a->alias, b->name) || same(a->alias, b->alias);
}

/* True for [a-z][a-z0-9_]*, the form of every name a script uses as a key. */
static bool name_is_valid(const char *name)
{
    if (!name || name[0] < 'a' || name[0] > 'z')
        return false;
    return name[strspn(name, "abcdefghijklmnopqrstuvwxyz0123456789_")] == '\0';
}

static tl_status check_choices(const tl_param *p, tl_error *error)
{
    size_t count = 0;
    while (p->choices && p->choices[count])
        count++;
    if (count == 0)
        return tl_fail(error, TL_E_PLUGIN, "parameter '%s' is an enum without choices", p->name);
    if (!(p->def[0] >= 0 && p->def[0] < (double)count))
        return tl_fail(error, TL_E_PLUGIN, "parameter '%s': its default %g is none of %zu choices", p->name, p->def[0],
                       count);
    return TL_OK;
}

static tl_status check_default(const tl_param *p, tl_error *error)
{
    if (p->type == TL_PARAM_ENUM)
        return check_choices(p, error);
    bool numeric = p->type == TL_PARAM_REAL || p->type == TL_PARAM_INT || p->type == TL_PARAM_VEC3;
    if (!numeric || p->flags & (TL_PARAM_REQUIRED | TL_PARAM_OPTIONAL))
        return isfinite(p->def[0]) ? TL_OK
                                   : tl_fail(error, TL_E_PLUGIN, "parameter '%s': its default is not finite", p->name);
    for (int i = 0; i < (p->type == TL_PARAM_VEC3 ? 3 : 1); i++) {
        char number[TL_NUMBER_TEXT], range[TL_RANGE_TEXT];
        tl_number_text(p->def[i], number);
        tl_param_range(p, range, sizeof range);
        if (!tl_param_in_range(p, p->def[i]))
            return tl_fail(error, TL_E_PLUGIN, "parameter '%s': its default %s is outside its own range %s", p->name,
                           number, range[0] ? range : "of finite numbers");
        if (p->type == TL_PARAM_INT && floor(p->def[i]) < p->def[i])
            return tl_fail(error, TL_E_PLUGIN, "parameter '%s': its default %s is not whole", p->name, number);
    }
    return TL_OK;
}

/* Texts are shown on terminals. */
static bool any_unclean(const char *a, const char *b)
{
    return !tl_text_is_clean(a) || !tl_text_is_clean(b);
}

static tl_status unclean(tl_error *error, const char *what, const char *name)
{
    return tl_fail(error, TL_E_PLUGIN, "%s '%s' has a control character in its unit or doc", what, name);
}

static tl_status check_param(const tl_kind *kind, uint32_t index, tl_error *error)
{
    const tl_param *p = &kind->params[index];
    size_t bytes = tl_param_bytes(p->type);
    if (!name_is_valid(p->name) || (p->alias && !name_is_valid(p->alias)))
        return tl_fail(error, TL_E_PLUGIN, "parameter %u has a bad name or alias ('%.60s')", index + 1,
                       p->name ? p->name : "");
    if (!p->unit || !p->doc)
        return tl_fail(error, TL_E_PLUGIN, "parameter '%s' has no %s", p->name,
                       p->doc ? "unit (\"\" for a pure number)" : "doc");
    if (any_unclean(p->unit, p->doc))
        return unclean(error, "parameter", p->name);
    if (bytes == 0)
        return tl_fail(error, TL_E_PLUGIN, "parameter '%s' has the unknown type %u", p->name, p->type);
    bool table = kind->type == TL_KIND_SOLID && p->type == TL_PARAM_POINTS;
    if (table && !(p->flags & TL_PARAM_FLAT))
        return tl_fail(error, TL_E_PLUGIN,
                       "parameter '%s' is a list of points in space: a solid takes tables, with TL_PARAM_FLAT",
                       p->name);
    bool kept = kind->type == TL_KIND_ELEMENT;
    if (kind->type != TL_KIND_GENERATOR && !table && !kept &&
        (p->type == TL_PARAM_STRING || p->type == TL_PARAM_POINTS))
        return tl_fail(error, TL_E_PLUGIN,
                       "parameter '%s' is a %s, which lives only as long as the call: a %s cannot keep it", p->name,
                       p->type == TL_PARAM_STRING ? "string" : "list of points", tl_kind_type_name(kind->type));
    if (p->offset > kind->params_size || bytes > kind->params_size - p->offset)
        return tl_fail(error, TL_E_PLUGIN, "parameter '%s' lies at bytes %zu to %zu, outside its struct of %zu",
                       p->name, p->offset, p->offset + bytes, kind->params_size);
    if (isnan(p->min) || isnan(p->max) || p->min > p->max)
        return tl_fail(error, TL_E_PLUGIN, "parameter '%s' has the empty range %g to %g", p->name, p->min, p->max);
    if (p->flags & TL_PARAM_REQUIRED && p->flags & TL_PARAM_OPTIONAL)
        return tl_fail(error, TL_E_PLUGIN, "parameter '%s' is both required and optional", p->name);
    for (uint32_t i = 0; i < index; i++)
        if (names_clash(p, &kind->params[i]))
            return tl_fail(error, TL_E_PLUGIN, "parameters '%s' and '%s' share a name", kind->params[i].name, p->name);
    return check_default(p, error);
}

/* ---------------------------------------------------------------- states and operations -- */

/* Whether kinds of that type may have such states. */
static bool state_fits(uint32_t type, uint32_t state)
{
    switch (type) {
    case TL_KIND_LAW: return state == TL_STATE_SCALAR || state == TL_STATE_TANGENT;
    case TL_KIND_SOLID: return state == TL_STATE_SCALAR || state == TL_STATE_AXIS || state == TL_STATE_TENSOR;
    case TL_KIND_ELEMENT: return state == TL_STATE_SCALAR || state == TL_STATE_WHOLE;
    default: return state == TL_STATE_SCALAR;
    }
}

static tl_status check_state(const tl_kind *kind, uint32_t index, tl_error *error)
{
    const tl_state *s = &kind->states[index];
    if (!name_is_valid(s->name))
        return tl_fail(error, TL_E_PLUGIN, "state %u has a bad name ('%.60s')", index + 1, s->name ? s->name : "");
    if (!s->unit || !s->doc)
        return tl_fail(error, TL_E_PLUGIN, "state '%s' has no %s", s->name, s->doc ? "unit" : "doc");
    if (any_unclean(s->unit, s->doc))
        return unclean(error, "state", s->name);
    if (s->kind > TL_STATE_WHOLE || s->transfer > TL_TRANSFER_LIFT)
        return tl_fail(error, TL_E_PLUGIN, "state '%s' has the unknown %s %u", s->name,
                       s->kind > TL_STATE_WHOLE ? "kind" : "transfer",
                       s->kind > TL_STATE_WHOLE ? s->kind : s->transfer);
    if (!state_fits(kind->type, s->kind))
        return tl_fail(error, TL_E_PLUGIN, "state '%s' of a %s must be a scalar%s", s->name,
                       tl_kind_type_name(kind->type),
                       kind->type == TL_KIND_LAW       ? " or a tangent"
                       : kind->type == TL_KIND_SOLID   ? ", an axis or a tensor"
                       : kind->type == TL_KIND_ELEMENT ? ", of a node or of the whole"
                                                       : "");
    const bool anew =
        kind->type == TL_KIND_ELEMENT &&
        (s->transfer == TL_TRANSFER_RESET || (s->transfer == TL_TRANSFER_SPLIT && s->kind == TL_STATE_WHOLE));
    if ((kind->type == TL_KIND_SOLID || kind->type == TL_KIND_ELEMENT) && s->transfer != TL_TRANSFER_COPY && !anew)
        return tl_fail(error, TL_E_PLUGIN, "state '%s' of %s must have TL_TRANSFER_COPY: %s stay what they are",
                       s->name, kind->type == TL_KIND_SOLID ? "a solid" : "an element",
                       kind->type == TL_KIND_SOLID ? "zones" : "nodes");
    if (s->kind == TL_STATE_AXIS && s->initial != 0)
        return tl_fail(error, TL_E_PLUGIN, "state '%s' is an axis: it must begin at 0", s->name);
    if (s->transfer == TL_TRANSFER_ENERGY && (s->kind != TL_STATE_SCALAR || s->initial != 0))
        return tl_fail(error, TL_E_PLUGIN, "state '%s' is an energy: it must be a scalar that begins at 0", s->name);
    if (!isfinite(s->initial))
        return tl_fail(error, TL_E_PLUGIN, "state '%s': its initial value is not finite", s->name);
    for (uint32_t i = 0; i < index; i++) {
        if (same(s->name, kind->states[i].name))
            return tl_fail(error, TL_E_PLUGIN, "two states have the name '%s'", s->name);
        if (s->transfer == TL_TRANSFER_ENERGY && kind->states[i].transfer == TL_TRANSFER_ENERGY)
            return tl_fail(error, TL_E_PLUGIN, "states '%s' and '%s' are both energies of shear", kind->states[i].name,
                           s->name);
    }
    return TL_OK;
}

static bool is_there(const void *ops, const operation *o)
{
    void (*function)(void);
    memcpy(&function, (const char *)ops + o->at, sizeof function);
    return o->name && function;
}

static tl_status check_ops(uint32_t type, const void *ops, tl_error *error)
{
    const operation *missing = NULL, *pair = types[type].pair;
    for (const operation *o = types[type].needs; o < types[type].needs + 6 && o->name; o++)
        missing = missing || is_there(ops, o) ? missing : o;
    if (!missing && is_there(ops, &pair[0]) != is_there(ops, &pair[1]))
        missing = is_there(ops, &pair[0]) ? &pair[1] : &pair[0];
    return missing ? tl_fail(error, TL_E_PLUGIN, "its operation '%s' is missing", missing->name) : TL_OK;
}

/* Copies the operations into a block of their own. */
static tl_status copy_ops(const version *v, tl_kind *kind)
{
    const void *given = kind->ops;
    const size_t ours = types[kind->type].ours;
    kind->ops = NULL;
    if (!given)
        return tl_fail(v->error, TL_E_PLUGIN, "it has no operations");
    uint32_t size = size_of(given);
    tl_status status = check_size(v, "ops", size, types[kind->type].first, ours);
    if (status != TL_OK)
        return status;
    void *ops = calloc(1, ours);
    if (!ops)
        return tl_fail_memory(v->error);
    memcpy(ops, given, size < ours ? size : ours);
    tl_damping_ops *damping = kind->type == TL_KIND_DAMPING ? ops : NULL;
    if (damping && size == types[TL_KIND_DAMPING].first) /* cannot say so */
        damping->before = v->minor == 1;
    if (damping && v->minor < 3) /* what it has there is padding */
        damping->never_fails = false;
    kind->ops = ops;
    return check_ops(kind->type, ops, v->error);
}

/* ---------------------------------------------------------------- kinds and plugins ------ */

static tl_status check_rows(const tl_kind *kind, tl_error *error)
{
    tl_status status = TL_OK;
    bool solid = kind->type == TL_KIND_SOLID;
    bool element = kind->type == TL_KIND_ELEMENT;
    uint32_t columns = 0, whole = 0, most = solid ? TL_SOLID_COLUMNS : element ? TL_ELEMENT_COLUMNS : TL_STATE_COLUMNS;
    for (uint32_t i = 0; i < kind->param_count && status == TL_OK; i++)
        status = check_param(kind, i, error);
    if (status != TL_OK)
        return status;
    if ((kind->type == TL_KIND_GENERATOR || kind->type == TL_KIND_SCREEN) && kind->state_count > 0)
        return tl_fail(error, TL_E_PLUGIN, "a %s has no states, this one declares %u", tl_kind_type_name(kind->type),
                       kind->state_count);
    for (uint32_t i = 0; i < kind->state_count && status == TL_OK; i++) {
        status = check_state(kind, i, error);
        whole += kind->states[i].kind == TL_STATE_WHOLE;
        columns += kind->states[i].kind == TL_STATE_WHOLE ? 0 : tl_state_width(kind->states[i].kind);
    }
    if (status != TL_OK)
        return status;
    if (whole > TL_ELEMENT_COLUMNS || (element && columns > most))
        return tl_fail(error, TL_E_PLUGIN, "it has %u states of nodes and %u of the whole; %u of each at the most",
                       columns, whole, TL_ELEMENT_COLUMNS);
    if (columns > most)
        return tl_fail(error, TL_E_PLUGIN, "its states take %u columns (a scalar 1, %s); %u at the most", columns,
                       solid ? "an axis 3, a tensor 6" : "a tangent 3", most);
    return TL_OK;
}

/* Replaces the arrays and operations of a kind by copies in the host's shape. What cannot be copied
 * is NULL afterwards, so that the kind can be freed in any case. */
static tl_status copy_kind(const version *v, tl_kind *kind)
{
    const tl_param *params = kind->params;
    const tl_state *states = kind->states;
    void *own_params = NULL, *own_states = NULL;
    tl_status status = copy_rows(v, "a parameter", params, kind->param_count, kind->param_stride, FIRST_PARAM_SIZE,
                                 sizeof *params, &own_params);
    if (status == TL_OK)
        status = copy_rows(v, "a state", states, kind->state_count, kind->state_stride, FIRST_STATE_SIZE,
                           sizeof *states, &own_states);
    kind->params = own_params;
    kind->states = own_states;
    kind->param_stride = sizeof *params;
    kind->state_stride = sizeof *states;
    if (status == TL_OK)
        return copy_ops(v, kind);
    kind->ops = NULL;
    return status;
}

static tl_status check_kind(const tl_plugin *plugin, uint32_t index, tl_error *error)
{
    const tl_kind *kind = &plugin->kinds[index];
    if (!name_is_valid(kind->name))
        return tl_fail(error, TL_E_PLUGIN, "kind %u has the bad name '%.60s': small letters, digits and _ only",
                       index + 1, kind->name ? kind->name : "");
    if (!kind->doc)
        return tl_fail(error, TL_E_PLUGIN, "%s '%s' has no doc", tl_kind_type_name(kind->type), kind->name);
    if (!tl_text_is_clean(kind->doc))
        return unclean(error, tl_kind_type_name(kind->type), kind->name);
    if (kind->params_size > MOST_PARAM_BYTES)
        return tl_fail(error, TL_E_PLUGIN,
                       "%s '%s' has a params_size of %zu bytes; %zu at the most: is it sizeof its "
                       "struct of parameters?",
                       tl_kind_type_name(kind->type), kind->name, kind->params_size, MOST_PARAM_BYTES);
    for (uint32_t i = 0; i < index; i++)
        if (plugin->kinds[i].type == kind->type && same(plugin->kinds[i].name, kind->name))
            return tl_fail(error, TL_E_PLUGIN, "it holds two %ss named '%s'", tl_kind_type_name(kind->type),
                           kind->name);
    return TL_OK;
}

/* Leaves out the kinds of a type that this host does not know; the note tells of the first. */
static void drop_unknown(tl_plugin *plugin, tl_kind *kinds, char note[TL_NOTE_TEXT])
{
    uint32_t kept = 0, given = plugin->kind_count;
    for (uint32_t i = 0; i < given; i++) {
        if (kinds[i].type <= TL_KIND_ELEMENT)
            kinds[kept++] = kinds[i];
        else if (i == kept)
            snprintf(note, TL_NOTE_TEXT,
                     "kind %u, '%.60s', is of the unknown type %u and is left out: this Talus knows "
                     "laws (%d), dampings (%d), generators (%d), screens (%d), solids (%d) and elements (%d)",
                     i + 1, kinds[i].name ? kinds[i].name : "", kinds[i].type, TL_KIND_LAW, TL_KIND_DAMPING,
                     TL_KIND_GENERATOR, TL_KIND_SCREEN, TL_KIND_SOLID, TL_KIND_ELEMENT);
    }
    size_t length = strlen(note);
    if (given - kept > 1)
        snprintf(note + length, TL_NOTE_TEXT - length, "; so are %u more", given - kept - 1);
    plugin->kind_count = kept;
}

/* Reads the kinds one after the other. Those not yet read are cut off on failure. */
static tl_status read_kinds(const version *v, tl_plugin *plugin, tl_kind *kinds)
{
    uint32_t count = plugin->kind_count;
    for (uint32_t i = 0; i < count; i++) {
        tl_kind *kind = &kinds[i];
        plugin->kind_count = i;
        tl_status status = check_kind(plugin, i, v->error);
        if (status != TL_OK)
            return status;
        plugin->kind_count = i + 1;
        status = copy_kind(v, kind);
        if (status == TL_OK)
            status = check_rows(kind, v->error);
        if (status != TL_OK) {
            if (status == TL_E_PLUGIN)
                tl_error_prefix(v->error, "%s '%s': ", tl_kind_type_name(kind->type), kind->name);
            return status;
        }
    }
    return TL_OK;
}

tl_status tl_descriptor_read(const tl_plugin *given, tl_plugin **plugin, char note[TL_NOTE_TEXT], tl_error *error)
{
    *plugin = NULL;
    note[0] = '\0';
    version v = {given->abi_minor, error};
    tl_status status = check_size(&v, "its descriptor", given->size, FIRST_PLUGIN_SIZE, sizeof *given);
    if (status != TL_OK)
        return status;
    if (!given->id || !given->id[0] || !given->version || !given->doc || !given->licence)
        return tl_fail(error, TL_E_PLUGIN, "its descriptor lacks an id, version, doc or licence");
    if (any_unclean(given->id, given->version) || any_unclean(given->doc, given->licence))
        return tl_fail(error, TL_E_PLUGIN,
                       "its id, version, doc or licence has a control character in it; its id is '%.60s'", given->id);
    if (given->kind_count == 0)
        return tl_fail(error, TL_E_PLUGIN, "it holds no law, damping, generator, screen or solid");
    void *kinds;
    status = copy_rows(&v, "a kind", given->kinds, given->kind_count, given->kind_stride, FIRST_KIND_SIZE,
                       sizeof(tl_kind), &kinds);
    if (status != TL_OK)
        return status;
    tl_plugin *copy = malloc(sizeof *copy);
    if (!copy) {
        free(kinds);
        return tl_fail_memory(error);
    }
    memcpy(copy, given, sizeof *copy);
    copy->kinds = kinds;
    copy->kind_stride = sizeof(tl_kind);
    drop_unknown(copy, kinds, note);
    tl_text_clean(note, TL_NOTE_TEXT);
    status = copy->kind_count > 0 ? read_kinds(&v, copy, kinds)
                                  : tl_fail(error, TL_E_PLUGIN, "it holds nothing of use: %s", note);
    if (status == TL_OK)
        *plugin = copy;
    else
        tl_descriptor_free(copy);
    return status;
}

void tl_descriptor_free(tl_plugin *plugin)
{
    if (!plugin)
        return;
    for (uint32_t i = 0; i < plugin->kind_count; i++) {
        const tl_kind *kind = &plugin->kinds[i];
        free((void *)(uintptr_t)kind->params);
        free((void *)(uintptr_t)kind->states);
        free((void *)(uintptr_t)kind->ops);
    }
    free((void *)(uintptr_t)plugin->kinds);
    free(plugin);
}
