/* plain.h - a law that does nothing, in parts, for plugins that have one of them wrong and the rest right. */
#ifndef TESTS_BAD_PLUGINS_PLAIN_H
#define TESTS_BAD_PLUGINS_PLAIN_H

#include <talus/plugin.h>

typedef struct params {
    double value;
} params;

/* A row of a table of parameters. */
#define PLAIN_VALUE TL_PARAM(TL_PARAM_REAL, params, value, "Pa", "some value", .def = {1}, .min = 0, .max = 2)

static inline tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)self;
    (void)batch;
    (void)report;
    return TL_OK;
}

static inline void stiffness(const void *self, double *kn, double *ks)
{
    (void)self;
    *kn = *ks = 1;
}

/* The operations; a kind with them and a table of parameters; and a plugin with that kind. */
#define PLAIN_OPS                                                                                                      \
    {                                                                                                                  \
        .size = sizeof(tl_law_ops), .update = update, .stiffness = stiffness                                           \
    }
#define PLAIN_KIND(name_, ...)                                                                                         \
    TL_KIND(TL_KIND_LAW, ops, .name = (name_), .doc = "A law for the loader's test.", __VA_ARGS__)
#define PLAIN_PLUGIN(id_)                                                                                              \
    TL_PLUGIN(kind, .id = (id_), .version = "1", .doc = "A plugin for the loader's test.", .licence = "BSD-3-Clause")

/* A plugin whose descriptor claims another size or version. */
#define PLAIN_PLUGIN_CLAIMS(size_, major_, minor_, id_)                                                                \
    TL_PLUGIN_EXPORT const tl_plugin *tl_plugin_entry(uint32_t host_major, uint32_t host_minor)                        \
    {                                                                                                                  \
        static const tl_plugin plugin = {.size = (size_),                                                              \
                                         .abi_major = (major_),                                                        \
                                         .abi_minor = (minor_),                                                        \
                                         .id = (id_),                                                                  \
                                         .version = "1",                                                               \
                                         .doc = "A plugin for the loader's test.",                                     \
                                         .licence = "BSD-3-Clause",                                                    \
                                         .kinds = &kind,                                                               \
                                         .kind_count = 1,                                                              \
                                         .kind_stride = sizeof kind};                                                  \
        (void)host_major;                                                                                              \
        (void)host_minor;                                                                                              \
        return &plugin;                                                                                                \
    }                                                                                                                  \
    _Static_assert(sizeof(kind) == sizeof(tl_kind), "one kind")

#endif
