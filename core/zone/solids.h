/* solids.h - the solids of a model: materials of zones, by their names. */
#ifndef TL_ZONE_SOLIDS_H
#define TL_ZONE_SOLIDS_H

#include "zone/zones.h"

/* Bytes of a solid's name, with its end, at the most. */
#define TL_SOLID_NAME 128

/* The number of a solid, or TL_NO_ROW. */
uint32_t tl_solid_find(const tl_model *m, const char *name);
/* Fails: there is no solid of that name. Tells the nearest one there is. */
tl_status tl_solid_missing(tl_model *m, const char *name);
/* Sets a solid: with `kind` a new one or another in its place, without it only parameters of one that there is. */
tl_status tl_solid_set(tl_model *m, const char *name, const tl_kind *kind, const tl_args *args);
/* Gives a model a solid as another one has it. */
tl_status tl_solid_copy(tl_model *to, const tl_named_solid *from);
/* Gives a copy of the model `from` the solids that `from` has, with their strengths divided by `factor`. */
tl_status tl_solids_weaken(tl_model *m, const tl_model *from, double factor);
/* Gives the zones the columns of states that a solid needs. false: out of memory. */
bool tl_solid_columns(struct tl_zones *z, const tl_solid *solid);
/* Gives the zones of a parcel, whose kind of solid changes, the states of the new kind: those that have the same names
 * stay. */
void tl_solid_carry(struct tl_zones *z, const tl_parcel *parcel, const tl_kind *from, const tl_kind *to);
/* The same for one row of a table of zones, from a row of it or of another with as many columns of states. */
void tl_solid_carry_row(const tl_zone_table *from, uint32_t from_row, const tl_kind *had, tl_zone_table *to,
                        uint32_t to_row, const tl_kind *has);
/* What the zones of a parcel store by their stress and solid, J. */
double tl_parcel_stored(const struct tl_zones *z, const tl_parcel *parcel);
void tl_solids_free(struct tl_zones *z);

#endif
