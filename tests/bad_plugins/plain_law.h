/* plain_law.h - parameters and operations of a law that does nothing and has nothing wrong, for plugins with a fault
 * elsewhere. */
#ifndef TESTS_BAD_PLUGINS_PLAIN_LAW_H
#define TESTS_BAD_PLUGINS_PLAIN_LAW_H

#include "plain.h"

static const tl_param param_table[] = {PLAIN_VALUE};
static const tl_law_ops ops = PLAIN_OPS;

#endif
