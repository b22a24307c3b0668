/* values.c - fields and states of many blocks or contacts, by name, as one list of numbers. */
#include "query/values.h"

#include "contact/index.h"
#include "detect/detect.h"
#include "query/contact_fields.h"

#include <stdlib.h>
#include <string.h>
#include <talus/fields.h>

size_t tl_field_width(tl_field_kind kind)
{
    switch (kind) {
    case TL_FIELD_VEC3: return 3;
    case TL_FIELD_QUAT: return 4;
    case TL_FIELD_SYM3: return 6;
    case TL_FIELD_IDS: return 2;
    case TL_FIELD_TEXT: return 0;
    default: return 1;
    }
}

/* "a block has no field 'velocty'; did you mean 'velocity'?" */
static tl_status unknown_name(tl_model *m, const char *item, const tl_field *fields, size_t count,
                              const tl_law_states *states, const char *name)
{
    size_t more = states ? states->count : 0;
    const char **names = malloc((count + more + 1) * sizeof *names);
    if (!names)
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < count; i++)
        names[i] = fields[i].name;
    for (size_t i = 0; i < more; i++)
        names[count + i] = states->at[i].name;
    const char *nearest = tl_nearest_name(name, names, count + more);
    free(names);
    return tl_fail(&m->error, TL_E_NOT_FOUND, "a %s has no field%s '%.80s'%s%s%s", item,
                   states ? " or state" : "", name, nearest ? "; did you mean '" : "",
                   nearest ? nearest : "", nearest ? "'?" : "");
}

tl_status tl_value_find(tl_model *m, const char *item, const tl_field *fields, size_t count,
                        const tl_law_states *states, const char *name, tl_value_of *of)
{
    *of = (tl_value_of){.field = count};
    for (size_t i = 0; i < count; i++) {
        if (strcmp(fields[i].name, name) != 0)
            continue;
        of->field = i;
        of->width = strcmp(name, "state") == 0 ? 1 : tl_field_width(fields[i].kind);
        if (of->width == 0)
            return tl_fail(&m->error, TL_E_ARGUMENT, "the field '%s' of a %s is a text, no number",
                           name, item);
        return TL_OK;
    }
    of->state = states ? tl_law_states_find(states, name) : NULL;
    if (!of->state)
        return unknown_name(m, item, fields, count, states, name);
    of->width = of->state->width;
    return TL_OK;
}

tl_status tl_contact_value_find(tl_model *m, const char *item, const tl_field *fields, size_t count,
                                tl_law_states *states, const char *name, tl_value_of *of)
{
    *states = (tl_law_states){0};
    tl_status status = tl_detect_refresh(m);
    if (status == TL_OK)
        status = tl_law_states_list(m, states);
    return status == TL_OK ? tl_value_find(m, item, fields, count, states, name, of) : status;
}

tl_status tl_contact_find(tl_model *m, tl_id contact, uint32_t *row)
{
    *row = tl_contact_row(m->detect, contact);
    if (*row == TL_NO_ROW)
        return tl_fail(&m->error, TL_E_STALE, "contact %u no longer exists: its blocks have parted",
                       contact);
    return TL_OK;
}

tl_status tl_blocks_values(tl_model *m, const tl_id *ids, size_t count, const char *field,
                           double *out, size_t *width)
{
    size_t all;
    const tl_field *fields = tl_block_fields(&all);
    tl_value_of of;
    tl_status status = tl_value_find(m, "block", fields, all, NULL, field, &of);
    if (status != TL_OK)
        return status;
    *width = of.width;
    for (size_t i = 0; i < count && out; i++) {
        tl_field_value value;
        status = tl_block_field(m, ids[i], of.field, &value);
        if (status != TL_OK)
            return status;
        memcpy(out + i * of.width, value.number, of.width * sizeof *out);
    }
    return TL_OK;
}

/* One value of a contact. */
static tl_status contact_value(tl_model *m, const tl_law_states *states, const tl_value_of *of,
                               bool is_state, tl_id contact, double *out)
{
    uint32_t row;
    tl_status status = tl_contact_find(m, contact, &row);
    if (status != TL_OK)
        return status;
    if (of->state) {
        tl_law_state_of_contact(m, states, of->state, row, out);
        return TL_OK;
    }
    if (is_state) {
        *out = tl_contact_facts_of(m, row).state;
        return TL_OK;
    }
    tl_field_value value;
    status = tl_contact_field(m, contact, of->field, &value);
    if (status == TL_OK)
        memcpy(out, value.number, of->width * sizeof *out);
    return status;
}

tl_status tl_contacts_values(tl_model *m, const tl_id *ids, size_t count, const char *name,
                             double *out, size_t *width)
{
    size_t all;
    const tl_field *fields = tl_contact_fields(&all);
    tl_law_states states;
    tl_value_of of;
    tl_status status = tl_contact_value_find(m, "contact", fields, all, &states, name, &of);
    if (status == TL_OK) {
        *width = of.width;
        bool is_state = strcmp(name, "state") == 0;
        for (size_t i = 0; i < count && out && status == TL_OK; i++)
            status = contact_value(m, &states, &of, is_state, ids[i], out + i * of.width);
    }
    tl_law_states_free(&states);
    return status;
}

tl_status tl_states_list(tl_model *m, tl_id contact, tl_law_state **list, size_t *count)
{
    *list = NULL;
    *count = 0;
    tl_law_states states = {0};
    uint32_t row = TL_NO_ROW;
    tl_status status = contact == TL_NO_ID ? TL_OK : tl_detect_refresh(m);
    if (status == TL_OK && contact != TL_NO_ID)
        status = tl_contact_find(m, contact, &row);
    if (status == TL_OK)
        status = tl_law_states_list(m, &states);
    if (status != TL_OK)
        return status;
    *list = malloc((states.count + 1) * sizeof **list);
    for (size_t i = 0; i < states.count && *list; i++)
        if (contact == TL_NO_ID || tl_law_states_has(m, &states, &states.at[i], row))
            (*list)[(*count)++] = states.at[i];
    tl_law_states_free(&states);
    return *list ? TL_OK : tl_fail_memory(&m->error);
}
