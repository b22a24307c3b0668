/* gridpoints.c - what a user does to gridpoints: holds and loads them, gives them velocities, asks what holds them. */
#include "base/columns.h"
#include "model/loads.h"
#include "model/options.h"
#include "zone/columns.h"
#include "zone/driven.h"
#include "zone/grid.h"
#include "zone/held.h"

#include <talus/zones.h>

/* The row of a gridpoint, or TL_NO_ROW with a sentence. */
static uint32_t row_of(tl_model *m, tl_zone_name name)
{
    const uint32_t mesh = tl_mesh_of(m, name.body);
    const tl_body_mesh *of = mesh != TL_NO_ROW ? &m->zones->mesh[mesh] : NULL;
    if (of && name.number < of->point_end - of->point_begin)
        return of->point_begin + name.number;
    tl_fail(&m->error, TL_E_STALE, "block %u has no gridpoint %u", name.body, name.number);
    return TL_NO_ROW;
}

/* Whether all names are those of gridpoints, and the model may be changed. */
static tl_status check(tl_model *m, const tl_zone_name *names, size_t count, const char *what)
{
    const tl_status status = tl_model_may_set(m, what);
    for (size_t k = 0; status == TL_OK && k < count; k++)
        if (row_of(m, names[k]) == TL_NO_ROW)
            return m->error.status;
    return status;
}

/* Ends the drive of a gridpoint. */
static void leave_drive(tl_model *m, uint32_t row)
{
    tl_gridpoints *p = &m->zones->points;
    if (!p->drive || !p->drive[row])
        return;
    m->drives[p->drive[row] - 1].bodies--;
    p->drive[row] = 0;
}

static tl_status change_fixing(tl_model *m, const tl_zone_name *names, size_t count, uint32_t hold, uint32_t let)
{
    const tl_status status = check(m, names, count, "hold gridpoints");
    if (status != TL_OK)
        return status;
    if ((hold | let) > (TL_FIX_X | TL_FIX_Y | TL_FIX_Z))
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "gridpoints are held along x, y and z alone: they have no rotation (%u was given)", hold | let);
    for (size_t k = 0; k < count; k++) {
        const uint32_t row = row_of(m, names[k]);
        tl_gridpoints *p = &m->zones->points;
        p->fixed[row] = (uint8_t)((p->fixed[row] | hold) & ~let);
        for (int d = 0; let && d < 2 && p->held[0][0]; d++)
            tl_columns_put(p->held[d], row, tl_v3(0, 0, 0));
        if (let)
            leave_drive(m, row);
    }
    if (count > 0)
        m->zones->rated_for = 0; /* others may be the stiffest that move */
    m->constraints += count > 0;
    return TL_OK;
}

tl_status tl_gridpoints_fix(tl_model *m, const tl_zone_name *names, size_t count, uint32_t what)
{
    return change_fixing(m, names, count, what, 0);
}

tl_status tl_gridpoints_free(tl_model *m, const tl_zone_name *names, size_t count, uint32_t what)
{
    return change_fixing(m, names, count, 0, what);
}

tl_status tl_gridpoints_load(tl_model *m, const tl_zone_name *names, size_t count, tl_vec3 force)
{
    tl_status status = check(m, names, count, "load gridpoints");
    if (status == TL_OK && !tl_v3_finite(force))
        status = tl_fail(&m->error, TL_E_ARGUMENT, "a load on gridpoints must be a finite force");
    if (status == TL_OK && count > 0 && !tl_gridpoints_hold_loads(&m->zones->points))
        status = tl_fail_memory(&m->error);
    for (size_t k = 0; status == TL_OK && k < count; k++)
        tl_columns_put(m->zones->points.load, row_of(m, names[k]), force);
    m->constraints += status == TL_OK && count > 0;
    return status;
}

tl_status tl_gridpoints_velocity(tl_model *m, const tl_zone_name *names, size_t count, const tl_vec3 *velocity)
{
    tl_status status = check(m, names, count, "set velocities");
    for (size_t k = 0; status == TL_OK && k < count; k++)
        if (!tl_v3_finite(velocity[k]))
            status = tl_fail(&m->error, TL_E_ARGUMENT, "the velocity of a gridpoint must be finite");
    for (size_t k = 0; status == TL_OK && k < count; k++) {
        leave_drive(m, row_of(m, names[k]));
        tl_columns_put(m->zones->points.v, row_of(m, names[k]), velocity[k]);
    }
    if (status == TL_OK && count > 0)
        m->zones->steps_kept = TL_STEPS_KEPT;
    return status;
}

/* Whether a motion can be prescribed: it is finite, and no block is driven whole. */
static tl_status check_drive(tl_model *m, const tl_zone_name *names, size_t count, const tl_drive *drive)
{
    tl_status status = tl_check_motion(&m->error, "drive", drive->velocity, drive->angular_velocity);
    if (status == TL_OK && !tl_v3_finite(drive->at))
        status = tl_fail(&m->error, TL_E_ARGUMENT, "drive: at must be a finite point");
    for (int i = 0; status == TL_OK && i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (!isfinite(drive->gradient[i][j]))
                status = tl_fail(&m->error, TL_E_ARGUMENT, "drive: gradient[%d][%d] = %g 1/s must be finite", i + 1,
                                 j + 1, drive->gradient[i][j]);
    for (size_t k = 0; status == TL_OK && k < count; k++)
        if (m->bodies.drive[m->zones->mesh[tl_mesh_of(m, names[k].body)].row])
            status = tl_fail(&m->error, TL_E_STATE, "drive: block %u is driven whole; let it go with %s first",
                             names[k].body, tl_words(m, "selection:free", "tl_blocks_free"));
    if (status == TL_OK && (!tl_v3_is_zero(drive->angular_velocity) || drive->angular_velocity_at))
        status = tl_fail(&m->error, TL_E_ARGUMENT,
                         "drive: gridpoints do not turn; give a gradient for an angular "
                         "velocity");
    return status;
}

static void follow_drive(tl_model *m, uint32_t row, uint32_t index)
{
    tl_gridpoints *p = &m->zones->points;
    leave_drive(m, row);
    for (int d = 0; d < 2 && p->held[0][0]; d++)
        tl_columns_put(p->held[d], row, tl_v3(0, 0, 0));
    p->fixed[row] = TL_FIX_X | TL_FIX_Y | TL_FIX_Z;
    p->drive[row] = index;
    m->drives[index - 1].bodies++;
    tl_columns_put(p->v, row, tl_gridpoint_driven(m, row, 0));
}

tl_status tl_gridpoints_drive(tl_model *m, const tl_zone_name *names, size_t count, const tl_drive *given)
{
    tl_drive drive;
    tl_status status = TL_OPTIONS_READ(tl_drive, given, &drive, &m->error);
    if (status == TL_OK)
        status = check(m, names, count, "drive gridpoints");
    if (status == TL_OK)
        status = check_drive(m, names, count, &drive);
    if (status != TL_OK || count == 0)
        return status;
    const uint32_t index = tl_gridpoints_hold_drives(&m->zones->points) ? tl_drive_new(m, &drive) : 0;
    if (index == 0)
        return tl_fail_memory(&m->error);
    for (size_t k = 0; k < count; k++)
        follow_drive(m, row_of(m, names[k]), index);
    m->zones->rated_for = 0; /* others may be the stiffest that move */
    m->zones->steps_kept = TL_STEPS_KEPT;
    m->constraints++;
    return TL_OK;
}

tl_status tl_gridpoints_reaction(tl_model *m, const tl_zone_name *names, size_t count, tl_vec3 *force)
{
    *force = tl_v3(0, 0, 0);
    for (size_t k = 0; k < count; k++) {
        const uint32_t row = row_of(m, names[k]);
        if (row == TL_NO_ROW)
            return m->error.status;
        *force = tl_v3_add(*force, tl_gridpoint_reaction(&m->zones->points, row));
    }
    return TL_OK;
}
