/* check.c - the conformance check of a plugin's file: each of its kinds, each check of its type. */
#include "check/damping.h"
#include "check/element.h"
#include "check/generator.h"
#include "check/law.h"
#include "check/screen.h"
#include "check/solid.h"

#include <stdlib.h>
#include <string.h>

static tl_status check_kind(tl_checker *c, const tl_check_type *of, tl_check_fn tell, void *user, size_t *faults)
{
    tl_status status = of->check(c);
    if (status != TL_OK)
        return status;
    for (int i = 0; of->rules[i].name; i++) {
        tl_check_finding finding = {.kind = c->kind,
                                    .check = of->rules[i].name,
                                    .doc = of->rules[i].doc,
                                    .fault = tl_check_failed(c, i) ? c->fault[i] : NULL};
        *faults += finding.fault != NULL;
        if (tell)
            tell(user, &finding);
    }
    return TL_OK;
}

/* The plugin that the file was loaded as; NULL when it is another file's. */
static const tl_plugin *loaded_from(const char *path)
{
    for (size_t i = tl_plugin_record_count(); i-- > 0;) {
        tl_plugin_record record = tl_plugin_record_at(i);
        if (record.plugin && strcmp(record.path, path) == 0)
            return record.plugin;
    }
    return NULL;
}

/* A given value that no kind of the file has a parameter for is a slip of the pen. */
static tl_status check_given(const tl_plugin *plugin, const tl_args *args, tl_error *error)
{
    for (size_t i = 0; args && i < args->count; i++) {
        const char *key = args->values[i].key;
        bool known = false;
        for (uint32_t k = 0; k < plugin->kind_count; k++)
            for (uint32_t p = 0; p < plugin->kinds[k].param_count; p++) {
                const tl_param *param = &plugin->kinds[k].params[p];
                known |= strcmp(param->name, key) == 0 || (param->alias && strcmp(param->alias, key) == 0);
            }
        if (!known)
            return tl_fail(error, TL_E_ARGUMENT, "no kind of plugin '%s' has a parameter '%s'", plugin->id, key);
    }
    return TL_OK;
}

tl_status tl_plugin_check(const char *path, const tl_args *args, tl_check_fn tell, void *user, size_t *faults,
                          tl_error *error)
{
    static const tl_check_type *const of[] = {[TL_KIND_LAW] = &tl_check_laws,
                                              [TL_KIND_DAMPING] = &tl_check_dampings,
                                              [TL_KIND_GENERATOR] = &tl_check_generators,
                                              [TL_KIND_SCREEN] = &tl_check_screens,
                                              [TL_KIND_SOLID] = &tl_check_solids,
                                              [TL_KIND_ELEMENT] = &tl_check_elements};
    *faults = 0;
    const tl_plugin *plugin = loaded_from(path);
    tl_status status = plugin ? TL_OK : tl_plugin_load(path, error);
    if (status == TL_OK && !plugin)
        plugin = loaded_from(path);
    if (status == TL_OK)
        status = check_given(plugin, args, error);
    for (uint32_t i = 0; status == TL_OK && i < plugin->kind_count; i++) {
        const tl_kind *kind = &plugin->kinds[i];
        tl_checker *c = calloc(1, sizeof *c);
        if (!c)
            return tl_fail_memory(error);
        c->kind = kind;
        c->args = args;
        c->error = error;
        status = check_kind(c, of[kind->type], tell, user, faults);
        free(c);
    }
    return status;
}
