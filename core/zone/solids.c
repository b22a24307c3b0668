/* solids.c - the solids of a model: materials of zones, by their names. */
#include "zone/solids.h"

#include "base/error.h"
#include "base/solid_columns.h"
#include "base/strength.h"
#include "geometry/measure.h"

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

tl_status tl_solid_missing(tl_model *m, const char *name)
{
    const size_t count = m->zones ? m->zones->solid_count : 0;
    const char **names = malloc((count + 1) * sizeof *names);
    for (size_t k = 0; names && k < count; k++)
        names[k] = m->zones->solid[k].name;
    const char *nearest = names ? tl_nearest_name(name, names, count) : NULL;
    free(names);
    if (nearest)
        return tl_fail(&m->error, TL_E_ARGUMENT, "there is no solid '%.80s'; did you mean '%.80s'?", name, nearest);
    return tl_fail(&m->error, TL_E_ARGUMENT, "there is no solid '%.80s': name it with %s first", name,
                   tl_words(m, "model:solid", "tl_model_solid"));
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

void tl_solid_carry_row(const tl_zone_table *from, uint32_t from_row, const tl_kind *had, tl_zone_table *to,
                        uint32_t to_row, const tl_kind *has)
{
    double old[TL_SOLID_COLUMNS] = {0};
    uint32_t at = 0, begin;
    for (uint32_t k = 0; k < from->state_columns; k++)
        old[k] = from->state[k][from_row];
    for (uint32_t k = 0; k < has->state_count; k++) {
        const tl_state *state = tl_kind_state(has, k);
        const bool stays = find_columns(had, state, &begin);
        for (uint32_t c = 0; c < tl_state_width(state->kind); c++)
            to->state[at + c][to_row] = stays ? old[begin + c] : state->initial;
        at += tl_state_width(state->kind);
    }
    for (; at < to->state_columns; at++)
        to->state[at][to_row] = 0;
}

void tl_solid_carry(struct tl_zones *z, const tl_parcel *parcel, const tl_kind *from, const tl_kind *to)
{
    for (uint32_t g = parcel->group_begin; from != to && g < parcel->group_end; g++)
        for (uint32_t k = 0; k < (uint32_t)z->group[g].depth * TL_LANES; k++)
            tl_solid_carry_row(&z->zones, z->group[g].start + k, from, &z->zones, z->group[g].start + k, to);
}

/* The present volume of a zone, m3; 0 of an inert row. */
static double volume_of(const struct tl_zones *z, const tl_parcel *of, size_t row)
{
    tl_vec3 x[4];
    for (int a = 0; a < 4; a++)
        x[a] = tl_gridpoint_place(&z->points, z->listed[of->point_begin + z->zones.corner[a][row]]);
    return z->zones.number[row] != TL_NO_ROW ? tl_tetrahedron_volume(x) : 0;
}

double tl_parcel_stored(const struct tl_zones *z, const tl_parcel *parcel)
{
    const tl_solid *solid = &z->solid[parcel->solid].of;
    double sum = 0;
    for (uint32_t g = parcel->group_begin; g < parcel->group_end; g++) {
        const size_t start = z->group[g].start, rows = (size_t)z->group[g].depth * TL_LANES;
        double each[TL_CLUSTER_MOST * TL_LANES] = {0};
        const double *stress[6];
        double *state[TL_SOLID_COLUMNS];
        for (int k = 0; k < 6; k++)
            stress[k] = z->zones.stress[k] + start;
        for (uint32_t k = 0; k < solid->columns; k++)
            state[k] = z->zones.state[k] + start;
        tl_solid_energy(solid, (uint32_t)rows, stress, state, each);
        for (size_t i = 0; i < rows; i++)
            sum += each[i] * volume_of(z, parcel, start + i);
    }
    return sum;
}

/* Puts a solid in the place of an older one. Its zones keep their stress, so they store another energy. */
static void replace(tl_model *m, uint32_t known, const tl_named_solid *made)
{
    struct tl_zones *z = m->zones;
    tl_named_solid old = z->solid[known];
    bool changed = false;
    z->solid[known] = *made;
    for (size_t k = 0; k < z->parcels.table.rows; k++) {
        const tl_parcel *parcel = &z->parcels.of[k];
        if (parcel->solid != known)
            continue;
        tl_solid_carry(z, parcel, old.of.kind, made->of.kind);
        z->parcels.stored[k] = tl_parcel_stored(z, parcel);
        changed = true;
    }
    clear(&old);
    m->laws += changed; /* the balance takes the change for one by hand */
}

/* Puts a solid in the place of an older one of its name, or at the end. Memory suffices. */
static void put(tl_model *m, uint32_t known, const tl_named_solid *made)
{
    struct tl_zones *z = m->zones;
    if (known != TL_NO_ROW)
        replace(m, known, made);
    else
        z->solid[z->solid_count++] = *made;
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
    put(m, tl_solid_find(m, name), &made);
    return TL_OK;
}

tl_status tl_solid_set(tl_model *m, const char *name, const tl_kind *kind, const tl_args *args)
{
    const uint32_t known = tl_solid_find(m, name);
    const tl_solid *old = known != TL_NO_ROW ? &m->zones->solid[known].of : NULL;
    if (!kind && !old)
        return tl_fail(&m->error, TL_E_NOT_FOUND,
                       "there is no solid '%.80s' in this model yet: name its kind, as in %s(%s\"%.80s\", \"elastic\", "
                       "%s)",
                       name, tl_words(m, "model:solid", "tl_model_solid"), tl_words(m, "", "model, "), name,
                       tl_words(m, "{...}", "properties"));
    const bool same = old && (!kind || kind == old->kind);
    return set(m, name, kind ? kind : old->kind, args, same ? old : NULL);
}

tl_status tl_solid_copy(tl_model *to, const tl_named_solid *from)
{
    return set(to, from->name, from->of.kind, &(tl_args){NULL, 0}, &from->of);
}

tl_status tl_solids_weaken(tl_model *m, const tl_model *from, double factor)
{
    tl_status status = TL_OK;
    for (size_t k = 0; from->zones && k < from->zones->solid_count && status == TL_OK; k++) {
        const tl_named_solid *solid = &from->zones->solid[k];
        tl_args args;
        void *held;
        if (!tl_kind_has_strength(solid->of.kind))
            continue;
        status = tl_strengths_divide(solid->of.kind, solid->of.params, factor, &args, &held)
                     ? set(m, solid->name, solid->of.kind, &args, &solid->of)
                     : tl_fail_memory(&m->error);
        free(held);
    }
    return status;
}
