/* plain_law.h - parameters and functions of a law that does nothing and has nothing wrong, for plugins with a fault
 * elsewhere. */
#ifndef TESTS_BAD_PLUGINS_PLAIN_LAW_H
#define TESTS_BAD_PLUGINS_PLAIN_LAW_H

#include <talus/plugin.h>

typedef struct params {
    double value;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_REAL, params, value, "Pa", "some value", .def = {1}, .min = 0, .max = 2),
};

static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)self;
    (void)batch;
    (void)report;
    return TL_OK;
}

static void stiffness(const void *self, double *kn, double *ks)
{
    (void)self;
    *kn = *ks = 1;
}

static const tl_law_ops ops = {.size = sizeof ops, .update = update, .stiffness = stiffness};

#endif
