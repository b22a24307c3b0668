/* held.h - in which directions gridpoints are held. */
#ifndef TL_ZONE_HELD_H
#define TL_ZONE_HELD_H

#include "base/columns.h"
#include "zone/zones.h"

/* Tolerance: sine of the angle between a direction and what is held already, below which it holds nothing more. Faces
 * that bend by less than that hold their gridpoints along one direction. Test: unit/test_zone_boundaries. */
#define TL_HELD_ALREADY 1e-2

/* The components of a vector that `fixed` leaves free. */
static inline tl_vec3 tl_free_axes(tl_vec3 v, unsigned fixed)
{
    return tl_v3(fixed & TL_FIX_X ? 0 : v.x, fixed & TL_FIX_Y ? 0 : v.y, fixed & TL_FIX_Z ? 0 : v.z);
}

/* The part of a vector along which a gridpoint is not held. The directions come one after the other, each without what
 * is held before it. */
static inline tl_vec3 tl_gridpoint_free_part(const tl_gridpoints *p, size_t row, tl_vec3 v)
{
    const unsigned fixed = p->fixed[row];
    tl_vec3 before = {0, 0, 0};
    v = tl_free_axes(v, fixed);
    for (int k = 0; p->held[0][0] && k < 2; k++) {
        tl_vec3 n = tl_free_axes(tl_columns_get(p->held[k], row), fixed);
        n = tl_v3_madd(n, -tl_v3_dot(n, before), before);
        const double size = tl_v3_norm(n);
        if (size < TL_HELD_ALREADY)
            continue;
        before = tl_v3_scale(1 / size, n);
        v = tl_v3_madd(v, -tl_v3_dot(v, before), before);
    }
    return v;
}

/* The part of a vector along which directions hold a gridpoint, beside axes. */
static inline tl_vec3 tl_gridpoint_held_along(const tl_gridpoints *p, size_t row, tl_vec3 v)
{
    return tl_v3_sub(tl_free_axes(v, p->fixed[row]), tl_gridpoint_free_part(p, row, v));
}

/* The force with which what holds a gridpoint acts on it, N: its unbalanced force has what directions do in it, and has
 * not what axes do. */
static inline tl_vec3 tl_gridpoint_reaction(const tl_gridpoints *p, size_t row)
{
    const tl_vec3 force = tl_columns_get(p->force, row);
    const tl_vec3 axes = tl_v3_sub(tl_free_axes(force, p->fixed[row]), force);
    return p->held[0][0] ? tl_v3_add(axes, tl_columns_get(p->rolled, row)) : axes;
}

#endif
