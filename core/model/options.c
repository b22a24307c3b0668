/* options.c - the structs of options: their defaults, and reading what callers give.
 *
 * A struct of options begins with its size in bytes, as the caller's headers have it. Later headers append members only,
 * so the first `size` bytes mean the same in both. The defaults are those of the tables of parameters
 * (functions.c), which tests/unit/test_options.c compares. */
#include "model/options.h"

#include "base/error.h"

#include <math.h>
#include <string.h>

#define UNSET                                                                                      \
    {                                                                                              \
        NAN, NAN, NAN                                                                              \
    }
#define SIZED(type) .size = sizeof(type)

static const tl_model_config model_config = {SIZED(tl_model_config),
                                             .gravity = {0, 0, -9.81},
                                             .seed = 1,
                                             .threads = 1,
                                             .rotation = TL_ROTATION_EXACT,
                                             .reuse_geometry = 1,
                                             .contact_points = TL_POINTS_CONSISTENT};
static const tl_filter filter = {SIZED(tl_filter), .volume = NAN, .edge = NAN, .aspect = NAN};
static const tl_insitu insitu = {SIZED(tl_insitu)};
static const tl_timestep timestep = {SIZED(tl_timestep), .fraction = NAN, .rule = TL_TIMESTEP_BODY,
                                     .dt = NAN};
static const tl_mass_scaling mass_scaling = {SIZED(tl_mass_scaling), .on = 1, .dt = NAN,
                                             .most = NAN};
static const tl_contact_area contact_area = {SIZED(tl_contact_area), .fraction = TL_AREA_FRACTION,
                                             .absolute = NAN};
static const tl_solve solve = {SIZED(tl_solve), .ratio = 1e-5,         .measure = TL_RATIO_LOCAL,
                               .velocity = NAN, .max_cycles = 1000000, .max_time = NAN,
                               .every = 500};
static const tl_block_filter block_filter = {SIZED(tl_block_filter), .fixed = -1};
static const tl_block_set block_set = {SIZED(tl_block_set), .density = NAN, .velocity = UNSET,
                                       .angular_velocity = UNSET};
static const tl_load load = {SIZED(tl_load), .at = UNSET};
static const tl_drive drive = {SIZED(tl_drive)};
static const tl_contact_filter contact_filter = {SIZED(tl_contact_filter)};
static const tl_keyblock_query keyblock_query = {SIZED(tl_keyblock_query), .gravity = UNSET};
static const tl_vtk_parts vtk_parts = {SIZED(tl_vtk_parts), .blocks = 1, .contacts = 1,
                                       .joints = 1};
static const tl_html html = {SIZED(tl_html)};
static const tl_view_options view = {SIZED(tl_view_options), .commands = 1, .share = 0.02};

static const struct {
    const char *name;
    const void *defaults;
    uint32_t size;
} known[TL_OPTIONS_COUNT] = {
    [TL_OPTIONS_OF_tl_model_config] = {"tl_model_config", &model_config, sizeof model_config},
    [TL_OPTIONS_OF_tl_filter] = {"tl_filter", &filter, sizeof filter},
    [TL_OPTIONS_OF_tl_insitu] = {"tl_insitu", &insitu, sizeof insitu},
    [TL_OPTIONS_OF_tl_timestep] = {"tl_timestep", &timestep, sizeof timestep},
    [TL_OPTIONS_OF_tl_mass_scaling] = {"tl_mass_scaling", &mass_scaling, sizeof mass_scaling},
    [TL_OPTIONS_OF_tl_contact_area] = {"tl_contact_area", &contact_area, sizeof contact_area},
    [TL_OPTIONS_OF_tl_solve] = {"tl_solve", &solve, sizeof solve},
    [TL_OPTIONS_OF_tl_block_filter] = {"tl_block_filter", &block_filter, sizeof block_filter},
    [TL_OPTIONS_OF_tl_block_set] = {"tl_block_set", &block_set, sizeof block_set},
    [TL_OPTIONS_OF_tl_load] = {"tl_load", &load, sizeof load},
    [TL_OPTIONS_OF_tl_drive] = {"tl_drive", &drive, sizeof drive},
    [TL_OPTIONS_OF_tl_contact_filter] = {"tl_contact_filter", &contact_filter,
                                         sizeof contact_filter},
    [TL_OPTIONS_OF_tl_keyblock_query] = {"tl_keyblock_query", &keyblock_query,
                                         sizeof keyblock_query},
    [TL_OPTIONS_OF_tl_vtk_parts] = {"tl_vtk_parts", &vtk_parts, sizeof vtk_parts},
    [TL_OPTIONS_OF_tl_html] = {"tl_html", &html, sizeof html},
    [TL_OPTIONS_OF_tl_view_options] = {"tl_view_options", &view, sizeof view},
};

void tl_options_default(tl_options which, void *options, size_t size)
{
    uint32_t own = (uint32_t)size;
    memset(options, 0, size);
    if ((unsigned)which >= TL_OPTIONS_COUNT || size < sizeof own)
        return;
    memcpy(options, known[which].defaults, size < known[which].size ? size : known[which].size);
    memcpy(options, &own, sizeof own);
}

tl_status tl_options_read(tl_options which, const void *given, void *own, tl_error *error)
{
    const char *name = known[which].name;
    uint32_t size = known[which].size;
    memcpy(own, known[which].defaults, size);
    if (!given)
        return TL_OK;
    memcpy(&size, given, sizeof size);
    if (size <= sizeof size)
        return tl_fail(error, TL_E_ARGUMENT,
                       "%s: size = %u must be sizeof(%s); begin with %s_default()", name, size,
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
