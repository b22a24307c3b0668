/* zone_fields.h - what can be asked of zones and gridpoints. */
#ifndef TL_QUERY_ZONE_FIELDS_H
#define TL_QUERY_ZONE_FIELDS_H

#include "model/model.h"
#include "zone/name.h"

/* The fields a zone has, and a gridpoint, in the order of the reference; `*count` of them. */
const tl_field *tl_zone_fields(size_t *count);
const tl_field *tl_gridpoint_fields(size_t *count);

/* The number of a zone's state by its flags, and the name of a number: "elastic" is 0. NULL: there is no such number. */
uint32_t tl_zone_state(uint32_t flags);
const char *tl_zone_state_name(uint32_t number);

/* Which zones; all that is set must hold. */
typedef struct tl_zone_filter {
    uint32_t size;       /* sizeof(tl_zone_filter) */
    const tl_id *blocks; /* of these; NULL: of all */
    size_t block_count;
    const char *solid; /* NULL: of any */
    int32_t plastic;   /* 1: that have ever yielded, 0: that have not, -1: both */
} tl_zone_filter;

/* Names of the zones, or gridpoints, that pass, in the order of bodies and numbers; freed with free(). */
tl_status tl_zones_select(tl_model *model, const tl_zone_filter *filter, tl_zone_name **names, size_t *count);
tl_status tl_gridpoints_select(tl_model *model, const tl_zone_filter *filter, tl_zone_name **names, size_t *count);

/* The value of field `index` of a zone, or a gridpoint. TL_E_STALE for one that is no more. */
tl_status tl_zone_field(tl_model *model, tl_zone_name zone, size_t index, tl_field_value *value);
tl_status tl_gridpoint_field(tl_model *model, tl_zone_name gridpoint, size_t index, tl_field_value *value);

/* Writes a field, by its name: component k of that of names[i] to out[width * i + k]. `*width` is set; with `out` NULL
 * that is all. Of zones `name` may be a state of their solids, NaN of one that has it not. TL_E_NOT_FOUND for an
 * unknown name, TL_E_ARGUMENT for a field that is a text. */
tl_status tl_zones_values(tl_model *model, const tl_zone_name *names, size_t count, const char *name, double *out,
                          size_t *width);
tl_status tl_gridpoints_values(tl_model *model, const tl_zone_name *names, size_t count, const char *name, double *out,
                               size_t *width);

#endif
