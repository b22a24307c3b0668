/* solid.c - the solids of a model, as a program or a script names and changes them. */
#include "plugin/loader.h"
#include "zone/life.h"
#include "zone/solids.h"

#include <string.h>
#include <talus/zones.h>

tl_status tl_model_solid(tl_model *m, const char *name, const char *kind, const tl_args *properties)
{
    static const tl_args none = {NULL, 0};
    tl_status status = tl_model_may_set(m, "set a solid");
    if (status != TL_OK)
        return status;
    if (!name[0] || strlen(name) >= TL_SOLID_NAME)
        return tl_fail(&m->error, TL_E_ARGUMENT, "the name of a solid must have 1 to %d bytes ('%.160s' has %zu)",
                       TL_SOLID_NAME - 1, name, strlen(name));
    const tl_kind *of = kind ? tl_plugin_find(TL_KIND_SOLID, kind) : NULL;
    if (kind && !of)
        return tl_kind_unknown(&m->error, TL_KIND_SOLID, kind);
    status = tl_zones_begin(m);
    return status == TL_OK ? tl_solid_set(m, name, of, properties ? properties : &none) : status;
}

size_t tl_solid_count(const tl_model *m)
{
    return m->zones ? m->zones->solid_count : 0;
}

tl_solid_info tl_solid_at(const tl_model *m, size_t index)
{
    const tl_named_solid *solid = &m->zones->solid[index];
    return (tl_solid_info){solid->name, solid->of.kind, solid->of.params};
}
