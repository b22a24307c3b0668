/* zone_fields.h - the states of zones by number. */
#ifndef TL_QUERY_ZONE_FIELDS_H
#define TL_QUERY_ZONE_FIELDS_H

#include <stdint.h>

/* The number of a zone's state by its flags. */
uint32_t tl_zone_state(uint32_t flags);
/* The name of a number: "elastic" of 0. NULL: there is no such number. */
const char *tl_zone_state_name(uint32_t number);

#endif
