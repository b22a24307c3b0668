/* solids.c - the solids of a model: materials of zones, by their names. */
#include "zone/solids.h"

#include "base/error.h"
#include "base/solid_columns.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

uint32_t tl_solid_find(const tl_model *m, const char *name)
{
    const size_t count = m->zones ? m->zones->solid_count : 0;
    for (size_t k = 0; k < count; k++)
        if (strcmp(m->zones->solid[k].name, name) == 0)
            return (uint32_t)k;
    return TL_NO_ROW;
}

static void clear(tl_named_solid *s)
{
    tl_solid_clear(&s->of);
    free(s->name);
    *s = (tl_named_solid){.name = NULL};
}

void tl_solids_free(struct tl_zones *z)
{
    for (size_t k = 0; k < z->solid_count; k++)
        clear(&z->solid[k]);
    free(z->solid);
}

bool tl_solid_columns(struct tl_zones *z, const tl_solid *solid)
{
    tl_zone_table *t = &z->zones;
    tl_column more[TL_SOLID_COLUMNS];
    uint32_t count = 0;
    for (uint32_t k = t->state_columns; k < solid->columns; k++)
        more[count++] = (tl_column)TL_COLUMN_NEW(t, state[k], TL_COLUMN_STATE | TL_COLUMN_STEP);
    if (count > 0 && !tl_table_widen(&t->table, more, count))
        return false;
    t->state_columns += count;
    return true;
}

/* Whether some of its states turn with the zones. */
static bool turns(const tl_kind *kind)
{
    bool some = false;
    for (uint32_t k = 0; k < kind->state_count; k++)
        some = some || tl_kind_state(kind, k)->kind != TL_STATE_SCALAR;
    return some;
}

/* Makes a solid; what is not given is taken from `from`. */
static tl_status make(tl_model *m, const char *name, const tl_kind *kind, const tl_args *args, const tl_solid *from,
                      tl_named_solid *made)
{
    char context[TL_ERROR_TEXT / 2];
    *made = (tl_named_solid){.name = strdup(name)};
    if (!made->name)
        return tl_fail_memory(&m->error);
    snprintf(context, sizeof context, "solid '%.80s', of kind '%.40s'", name, kind->name);
    const tl_status status = tl_solid_make(kind, args, from, context, &m->error, &made->of);
    if (status != TL_OK)
        clear(made);
    else
        made->turns = turns(kind);
    return status;
}

/* Where the columns of a state of a kind begin; false: it has none of that name and width. */
static bool find_columns(const tl_kind *kind, const tl_state *state, uint32_t *begin)
{
    *begin = 0;
    for (uint32_t k = 0; k < kind->state_count; k++) {
        const tl_state *own = tl_kind_state(kind, k);
        if (strcmp(own->name, state->name) == 0 && own->kind == state->kind)
            return true;
        *begin += tl_state_width(own->kind);
    }
    return false;
}

/* The states of a zone after its kind has changed: those of the same names stay. */
static void carry_states(struct tl_zones *z, uint32_t row, const tl_kind *from, const tl_kind *to)
{
    double old[TL_SOLID_COLUMNS] = {0};
    uint32_t at = 0, begin;
    for (uint32_t k = 0; k < z->zones.state_columns; k++)
        old[k] = z->zones.state[k][row];
    for (uint32_t k = 0; k < to->state_count; k++) {
        const tl_state *state = tl_kind_state(to, k);
        const bool stays = find_columns(from, state, &begin);
        for (uint32_t c = 0; c < tl_state_width(state->kind); c++)
            z->zones.state[at + c][row] = stays ? old[begin + c] : state->initial;
        at += tl_state_width(state->kind);
    }
    for (; at < z->zones.state_columns; at++)
        z->zones.state[at][row] = 0;
}

void tl_solid_carry(struct tl_zones *z, const tl_parcel *parcel, const tl_kind *from, const tl_kind *to)
{
    for (uint32_t g = parcel->group_begin; from != to && g < parcel->group_end; g++)
        for (uint32_t k = 0; k < (uint32_t)z->group[g].depth * TL_LANES; k++)
            carry_states(z, z->group[g].start + k, from, to);
}

/* Puts a solid in the place of an older one of its name, or at the end. Memory suffices. */
static void put(struct tl_zones *z, uint32_t known, tl_named_solid *made)
{
    for (size_t k = 0; known != TL_NO_ROW && k < z->parcels.table.rows; k++)
        if (z->parcels.of[k].solid == known)
            tl_solid_carry(z, &z->parcels.of[k], z->solid[known].of.kind, made->of.kind);
    if (known != TL_NO_ROW)
        clear(&z->solid[known]);
    z->solid[known != TL_NO_ROW ? known : z->solid_count++] = *made;
    z->version++;
}

/* Sets a solid; what is not given is taken from `from`. */
static tl_status set(tl_model *m, const char *name, const tl_kind *kind, const tl_args *args, const tl_solid *from)
{
    struct tl_zones *z = m->zones;
    tl_named_solid made;
    const tl_status status = make(m, name, kind, args, from, &made);
    if (status != TL_OK)
        return status;
    if (!tl_grow(&z->solid, &z->solid_capacity, z->solid_count + 1, sizeof *z->solid) ||
        !tl_solid_columns(z, &made.of)) {
        clear(&made);
        return tl_fail_memory(&m->error);
    }
    put(z, tl_solid_find(m, name), &made);
    return TL_OK;
}

tl_status tl_solid_set(tl_model *m, const char *name, const tl_kind *kind, const tl_args *args)
{
    const uint32_t known = tl_solid_find(m, name);
    const tl_solid *old = known != TL_NO_ROW ? &m->zones->solid[known].of : NULL;
    if (!kind && !old)
        return tl_fail(&m->error, TL_E_NOT_FOUND, "there is no solid '%.80s' in this model yet: name its kind", name);
    const bool same = old && (!kind || kind == old->kind);
    return set(m, name, kind ? kind : old->kind, args, same ? old : NULL);
}

tl_status tl_solid_copy(tl_model *to, const tl_named_solid *from)
{
    return set(to, from->name, from->of.kind, &(tl_args){NULL, 0}, &from->of);
}
