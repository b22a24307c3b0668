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

/* Sets a solid; what is not given is taken from `from`. */
static tl_status set(tl_model *m, const char *name, const tl_kind *kind, const tl_args *args, const tl_solid *from)
{
    struct tl_zones *z = m->zones;
    const uint32_t known = tl_solid_find(m, name);
    tl_named_solid made = {.name = strdup(name)};
    char context[TL_ERROR_TEXT / 2];
    if (!made.name)
        return tl_fail_memory(&m->error);
    snprintf(context, sizeof context, "solid '%.80s', of kind '%.40s'", name, kind->name);
    tl_status status = tl_solid_make(kind, args, from, context, &m->error, &made.of);
    if (status == TL_OK && !(tl_grow(&z->solid, &z->solid_capacity, z->solid_count + 1, sizeof *z->solid) &&
                             tl_solid_columns(z, &made.of)))
        status = tl_fail_memory(&m->error);
    if (status != TL_OK) {
        clear(&made);
        return status;
    }
    made.turns = turns(made.of.kind);
    if (known != TL_NO_ROW)
        clear(&z->solid[known]);
    z->solid[known != TL_NO_ROW ? known : z->solid_count++] = made;
    z->version++;
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
