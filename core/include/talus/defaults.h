/* talus/defaults.h - the defaults of the structs of options of talus.h, which includes this header.
 *
 *     tl_solve solve = tl_solve_default();
 *     solve.ratio = 1e-4;
 */
#ifndef TALUS_DEFAULTS_H
#define TALUS_DEFAULTS_H

#include <talus/talus.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The structs of options. Each has a function of its name with _default, tl_solve_default() and so on. */
#define TL_OPTIONS(X)                                                                                                  \
    X(tl_model_config)                                                                                                 \
    X(tl_law_scope)                                                                                                    \
    X(tl_filter)                                                                                                       \
    X(tl_insitu)                                                                                                       \
    X(tl_seat)                                                                                                         \
    X(tl_timestep)                                                                                                     \
    X(tl_mass_scaling)                                                                                                 \
    X(tl_contact_area)                                                                                                 \
    X(tl_solve)                                                                                                        \
    X(tl_relax)                                                                                                        \
    X(tl_block_filter)                                                                                                 \
    X(tl_block_set)                                                                                                    \
    X(tl_load)                                                                                                         \
    X(tl_drive)                                                                                                        \
    X(tl_contact_filter)                                                                                               \
    X(tl_keyblock_query)                                                                                               \
    X(tl_safety)                                                                                                       \
    X(tl_vtk_parts)                                                                                                    \
    X(tl_html)                                                                                                         \
    X(tl_view_options)

typedef enum tl_options {
#define TL_OPTIONS_ITEM(type) TL_OPTIONS_OF_##type,
    TL_OPTIONS(TL_OPTIONS_ITEM)
#undef TL_OPTIONS_ITEM
        TL_OPTIONS_COUNT
} tl_options;

/* Writes the defaults of a struct of options of `size` bytes, and its size. Members that this library does not know
 * become 0. The functions below call it with the size that the caller's headers give. */
TL_API void tl_options_default(tl_options which, void *options, size_t size);

#define TL_OPTIONS_ITEM(type)                                                                                          \
    static inline type type##_default(void)                                                                            \
    {                                                                                                                  \
        type options;                                                                                                  \
        tl_options_default(TL_OPTIONS_OF_##type, &options, sizeof options);                                            \
        return options;                                                                                                \
    }
TL_OPTIONS(TL_OPTIONS_ITEM)
#undef TL_OPTIONS_ITEM

#ifdef __cplusplus
}
#endif
#endif
