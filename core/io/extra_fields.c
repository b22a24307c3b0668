/* extra_fields.c - see extra_fields.h. */
#include "io/extra_fields.h"

#include <string.h>

tl_status tl_extra_fields_check(const char *context, const tl_extra_field *fields, size_t count, size_t items,
                                const char *of, tl_error *error)
{
    for (size_t i = 0; i < count; i++) {
        if (!fields[i].name || !*fields[i].name || (!fields[i].values && fields[i].count))
            return tl_fail(error, TL_E_ARGUMENT, "%s: field %zu must have a name and values", context, i + 1);
        if (items != TL_ANY_ITEMS && fields[i].count != items)
            return tl_fail(error, TL_E_ARGUMENT, "%s: '%s' has %zu values, and there are %zu %s", context,
                           fields[i].name, fields[i].count, items, of);
    }
    return TL_OK;
}

tl_status tl_extra_fields_differ(const char *context, const tl_extra_field *fields, size_t count, const char *name,
                                 tl_error *error)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(fields[i].name, name) == 0)
            return tl_fail(error, TL_E_ARGUMENT, "%s: the file has an array '%s' already; give the field another name",
                           context, name);
    return TL_OK;
}
