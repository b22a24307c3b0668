/* params.h - parameter tables: reading a script's values against them, ranges.
 *
 * tl_args_read and tl_param_range, which a front end needs too, are declared in talus.h. */
#ifndef TL_BASE_PARAMS_H
#define TL_BASE_PARAMS_H

#include "base/number.h"

#include <talus/talus.h>

/* Bytes of the longest text tl_param_range writes. */
#define TL_RANGE_TEXT 96

/* Row `index` of a table whose rows are `stride` bytes apart, copied into the host's own shape. Members that an older
 * table does not have are zero. Stride 0 means sizeof(tl_param). */
tl_param tl_param_row(const tl_param *params, size_t index, size_t stride);

/* Bytes of the member a parameter of this type fills; 0 for an unknown type. */
size_t tl_param_bytes(uint32_t type);

/* True when the parameter has a range at all (min = max = 0 means none). */
bool tl_param_ranged(const tl_param *param);

/* True when `value` is finite and inside the range, open ends left out. */
bool tl_param_in_range(const tl_param *param, double value);

/* Limit: least and largest size of a property of a law or a damping that is not 0, in any units: forces, energies and
 * what laws make of several properties stay finite. Test: lua/test_proportion. */
#define TL_LEAST_PROPERTY 1e-50
#define TL_MOST_PROPERTY 1e50

/* Checks the numbers given for properties of a law or a damping, which the table has taken. Fails with a sentence when
 * one is out of all proportion. */
tl_status tl_args_proportion(const tl_param *params, size_t count, size_t stride, const tl_args *args,
                             const char *context, tl_error *error);

#endif
