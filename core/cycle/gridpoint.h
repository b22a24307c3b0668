/* gridpoint.h - one gridpoint in a step: the mass that moves it, and what it bears. */
#ifndef TL_CYCLE_GRIDPOINT_H
#define TL_CYCLE_GRIDPOINT_H

#include "base/columns.h"
#include "base/extremes.h"
#include "cycle/borne.h"
#include "cycle/cycle_data.h"
#include "zone/zones.h"

/* What partial mass scaling makes of a gridpoint's mass: energies count it. With `holds` for what holds it, its rate
 * holds / mass is then no higher than the limit. */
static inline double tl_gridpoint_energy_scale(const tl_model *m, size_t row)
{
    const tl_gridpoints *p = &m->zones->points;
    const double limit = m->cycle->adds ? m->cycle->added.point_limit : 0;
    const double scale = limit > 0 ? p->holds[row] / p->mass[row] / limit : 1;
    return scale > 1 ? scale : 1;
}

/* What mass scaling of either kind makes of it. */
static inline double tl_gridpoint_scale(const tl_model *m, size_t row)
{
    const tl_gridpoints *p = &m->zones->points;
    if (!(m->cycle->mass_scale > 0))
        return tl_gridpoint_energy_scale(m, row);
    return p->holds[row] > 0 ? m->cycle->mass_scale * p->holds[row] / p->mass[row] : 1;
}

/* The user's, N. */
static inline tl_vec3 tl_gridpoint_load(const tl_gridpoints *p, size_t row)
{
    return p->load[0] ? tl_columns_get(p->load, row) : tl_v3(0, 0, 0);
}

static inline double tl_gridpoint_weight(const tl_gridpoints *p, size_t row, double gravity)
{
    return p->mass[row] * gravity + tl_v3_norm(tl_gridpoint_load(p, row));
}

/* What a gridpoint bears, N, under gravity of that size: forces on it or, where these are more, its weight and load;
 * at the least what rounding of its place would bring. */
static inline double tl_gridpoint_borne(const tl_model *m, size_t row, double gravity)
{
    const tl_gridpoints *p = &m->zones->points;
    const double weight = tl_gridpoint_weight(p, row, gravity);
    return tl_larger(tl_larger(p->bears[row], weight), p->rounded[row]);
}

/* By its body and its number there. */
static inline tl_zone_name tl_gridpoint_name(const tl_model *m, uint32_t row)
{
    const tl_body_mesh *mesh = &m->zones->mesh[m->zones->points.mesh[row]];
    return (tl_zone_name){mesh->body, row - mesh->point_begin};
}

/* Whether all components of a gridpoint are held. */
static inline bool tl_gridpoint_is_held(const tl_gridpoints *p, size_t row)
{
    return p->fixed[row] == (TL_FIX_X | TL_FIX_Y | TL_FIX_Z);
}

#endif
