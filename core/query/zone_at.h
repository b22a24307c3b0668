/* zone_at.h - a zone where it is. */
#ifndef TL_QUERY_ZONE_AT_H
#define TL_QUERY_ZONE_AT_H

#include "geometry/measure.h"
#include "zone/zones.h"

/* A zone where it is: its mesh, row and parcel, and the places of its corners now and as made. */
typedef struct tl_zone_at {
    const tl_model *m;
    const tl_body_mesh *mesh;
    const tl_parcel *parcel;
    uint32_t row;
    tl_vec3 x[4], ref[4];
} tl_zone_at;

/* A zone by its number in its mesh. */
tl_zone_at tl_zone_at_number(const tl_model *m, const tl_body_mesh *mesh, uint32_t number);
tl_vec3 tl_zone_centroid(const tl_zone_at *at);
tl_sym3 tl_zone_stress(const tl_zone_at *at);
/* Logarithmic strain, ln V of F = V R, in the axes of the model. */
tl_sym3 tl_zone_strain(const tl_zone_at *at);
/* The mean of stress or strain over the zones of a block in a mesh, by volume; NaN of none. */
tl_sym3 tl_mesh_mean(const tl_model *m, const tl_body_mesh *mesh, tl_id block, tl_sym3 (*of)(const tl_zone_at *));

#endif
