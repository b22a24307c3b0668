/* options.c - the structs of options: their defaults, and reading what callers give.
 *
 * A struct of options begins with its size in bytes, as the caller's headers have it. Later headers append members
 * only, so the first `size` bytes mean the same in both. The defaults are those of the tables of parameters
 * (functions.c). */
#include "model/options.h"

#include "base/error.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define UNSET                                                                                                          \
    {                                                                                                                  \
        NAN, NAN, NAN                                                                                                  \
    }

/* Defaults of what no table of parameters has. */
static const tl_block_filter block_filter = {.fixed = -1, .above_count = 1, .below_count = 1};
static const tl_safety safety = {.step = 0.02};
static const tl_block_set block_set = {.density = NAN, .velocity = UNSET, .angular_velocity = UNSET};

/* A struct: the function whose table has its defaults, or they themselves; all else is zero. */
#define KNOWN(type, function, defaults) [TL_OPTIONS_OF_##type] = {#type, function, defaults, sizeof(type)}

static const struct {
    const char *name, *function;
    const void *defaults;
    uint32_t size;
} known[TL_OPTIONS_COUNT] = {
    KNOWN(tl_model_config, "model", NULL),
    KNOWN(tl_law_scope, NULL, NULL),
    KNOWN(tl_filter, "filter", NULL),
    KNOWN(tl_insitu, "insitu", NULL),
    KNOWN(tl_seat, "seat", NULL),
    KNOWN(tl_timestep, "timestep", NULL),
    KNOWN(tl_mass_scaling, "mass_scaling", NULL),
    KNOWN(tl_contact_area, "contact_area", NULL),
    KNOWN(tl_solve, "solve", NULL),
    KNOWN(tl_relax, "relax", NULL),
    KNOWN(tl_block_filter, NULL, &block_filter),
    KNOWN(tl_block_set, NULL, &block_set),
    KNOWN(tl_load, "load", NULL),
    KNOWN(tl_drive, NULL, NULL),
    KNOWN(tl_contact_filter, NULL, NULL),
    KNOWN(tl_keyblock_query, "keyblocks", NULL),
    KNOWN(tl_safety, "factor_of_safety", &safety),
    KNOWN(tl_vtk_parts, "write_vtk", NULL),
    KNOWN(tl_html, NULL, NULL),
    KNOWN(tl_view_options, "view", NULL),
};

/* Bytes that no struct of options has more of. */
#define LARGEST 256

/* Puts the defaults of a struct, of its own size, into it. */
static void put_defaults(tl_options which, void *own)
{
    const uint32_t size = known[which].size;
    assert(size <= LARGEST);
    memset(own, 0, size);
    if (known[which].defaults)
        memcpy(own, known[which].defaults, size);
    if (known[which].function) {
        size_t count;
        const tl_param *params = tl_function_params(known[which].function, &count, NULL);
        tl_args_read(params, count, sizeof *params, NULL, false, own, "", NULL);
    }
    memcpy(own, &size, sizeof size);
}

void tl_options_default(tl_options which, void *options, size_t size)
{
    uint32_t own = (uint32_t)size;
    uint64_t all[LARGEST / sizeof(uint64_t)];
    memset(options, 0, size);
    if ((unsigned)which >= TL_OPTIONS_COUNT || size < sizeof own)
        return;
    put_defaults(which, all);
    memcpy(options, all, size < known[which].size ? size : known[which].size);
    memcpy(options, &own, sizeof own);
}

tl_status tl_options_read(tl_options which, const void *given, void *own, tl_error *error)
{
    const char *name = known[which].name;
    uint32_t size = known[which].size;
    put_defaults(which, own);
    if (!given)
        return TL_OK;
    memcpy(&size, given, sizeof size);
    if (size <= sizeof size)
        return tl_fail(error, TL_E_ARGUMENT, "%s: size = %u must be sizeof(%s); begin with %s_default()", name, size,
                       name, name);
    if (size > known[which].size)
        return tl_fail(error, TL_E_ARGUMENT,
                       "%s: size = %u is more than the %u bytes that this Talus, %s, knows; the "
                       "program was built with headers of a newer one",
                       name, size, known[which].size, TALUS_VERSION);
    memcpy(own, given, size);
    memcpy(own, &known[which].size, sizeof size);
    return TL_OK;
}

const char *tl_version(void)
{
    return TALUS_VERSION;
}

tl_status tl_check_choice(tl_error *error, const char *name, int value, int most)
{
    if (value >= 0 && value <= most)
        return TL_OK;
    return tl_fail(error, TL_E_ARGUMENT, "%s = %d must be one of 0 to %d", name, value, most);
}
