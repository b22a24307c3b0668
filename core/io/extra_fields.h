/* extra_fields.h - whether numbers that a program adds to a file fit the model. */
#ifndef TL_IO_EXTRA_FIELDS_H
#define TL_IO_EXTRA_FIELDS_H

#include "base/error.h"

#include <talus/output.h>

/* Any number of values. */
#define TL_ANY_ITEMS SIZE_MAX
/* Whether each has a name and values of all `items`, which are `of` ("blocks"). `context` is the function and the
 * option: "write_vtk: block_fields". */
tl_status tl_extra_fields_check(const char *context, const tl_extra_field *fields, size_t count, size_t items,
                                const char *of, tl_error *error);
/* Whether none has the name of something that the file has already. */
tl_status tl_extra_fields_differ(const char *context, const tl_extra_field *fields, size_t count, const char *name,
                                 tl_error *error);

#endif
