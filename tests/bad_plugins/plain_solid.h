/* plain_solid.h - a solid that does nothing, with one thing wrong. */
#ifndef TESTS_BAD_PLUGINS_PLAIN_SOLID_H
#define TESTS_BAD_PLUGINS_PLAIN_SOLID_H

#include <talus/plugin.h>

typedef struct params {
    double value;
    tl_points table;
} params;

static inline tl_status update(const void *self, const tl_solid_batch *batch, tl_report *report)
{
    (void)self;
    (void)batch;
    (void)report;
    return TL_OK;
}

static inline void moduli(const void *self, double *constrained, double *shear)
{
    (void)self;
    *constrained = *shear = 1;
}

/* A plugin with a solid whose `moduli` is the one given, and what follows: its parameters and states. */
#define PLAIN_SOLID(name_, moduli_, ...)                                                                               \
    static const tl_solid_ops ops = {.size = sizeof ops, .update = update, .moduli = (moduli_)};                       \
    static const tl_kind kind =                                                                                        \
        TL_KIND(TL_KIND_SOLID, ops, .name = (name_), .doc = "A solid for the loader's test.", __VA_ARGS__);            \
    TL_PLUGIN(kind, .id = "bad." name_, .version = "1", .doc = "A plugin for the loader's test.",                      \
              .licence = "BSD-3-Clause")

#endif
