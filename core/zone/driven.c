/* driven.c - how driven gridpoints move.
 *
 * A drive has a velocity c, and a gradient L about a point a. A gridpoint is at x now. Its velocity v in a step h is
 * what the drive gives in the middle of its way:
 *
 *     v = c + L (x + v h / 2 - a),    v = (I - L h / 2)^-1 (c + L (x - a))
 *
 * A gradient without symmetric part turns what it drives without a change of lengths. */
#include "zone/driven.h"

#include "geometry/polar.h"
#include "model/loads.h"

tl_vec3 tl_gridpoint_driven(const tl_model *m, uint32_t row, double dt)
{
    const tl_gridpoints *p = &m->zones->points;
    const tl_drive_record *record = &m->drives[p->drive[row] - 1];
    const tl_drive *drive = &record->drive;
    if (!tl_drive_has_gradient(drive))
        return record->velocity;
    tl_mat3 gradient, slowed;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            gradient.m[i][j] = drive->gradient[i][j];
            slowed.m[i][j] = (i == j) - 0.5 * dt * drive->gradient[i][j];
        }
    const tl_vec3 arm = tl_v3_sub(tl_v3_add(tl_gridpoint_place(p, row), m->origin), drive->at);
    const tl_vec3 now = tl_v3_add(record->velocity, tl_m3_mul(&gradient, arm));
    const tl_mat3 inverse = tl_m3_inverse(&slowed);
    return tl_m3_mul(&inverse, now);
}
