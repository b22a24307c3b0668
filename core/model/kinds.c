/* kinds.c - plugin kinds as the model sees them: whose they are, and the sentence for one that is not loaded. */
#include "model/model.h"

#include "base/names.h"

#include <stdlib.h>

static const char *const type_names[] = {[TL_KIND_LAW] = "law",
                                         [TL_KIND_DAMPING] = "damping",
                                         [TL_KIND_GENERATOR] = "generator",
                                         [TL_KIND_SCREEN] = "screen"};

const char *tl_plugin_id(const tl_kind *kind)
{
    const tl_plugin *plugin = tl_plugin_of(kind, NULL);
    return plugin ? plugin->id : "?";
}

tl_status tl_kind_unknown(tl_error *error, tl_kind_type type, const char *name)
{
    size_t count = 0;
    while (tl_plugin_kind(type, count))
        count++;
    if (count == 0)
        return tl_fail(
            error, TL_E_NOT_FOUND,
            "unknown %s '%.80s': no %s is loaded; TALUS_PLUGIN_PATH may name the folder of "
            "the plugins",
            type_names[type], name, type_names[type]);
    const char **names = malloc(count * sizeof *names);
    if (!names)
        return tl_fail_memory(error);
    for (size_t i = 0; i < count; i++)
        names[i] = tl_plugin_kind(type, i)->name;
    tl_status status =
        tl_fail_unknown(error, TL_E_NOT_FOUND, "", type_names[type], name, names, count);
    free(names);
    return status;
}

tl_status tl_unknown_kind(tl_model *m, tl_kind_type type, const char *name)
{
    return tl_kind_unknown(&m->error, type, name);
}
