/* columns.c - columns of gridpoints that are made when they are needed: few meshes have them. */
#include "zone/columns.h"

bool tl_gridpoints_hold_damping(tl_gridpoints *p, bool before)
{
    bool enough = TL_COLUMN_NEED(&p->table, p, alpha, 0);
    for (int k = 0; k < 3; k++) {
        enough = enough && TL_COLUMN_NEED(&p->table, p, damping[k], 0);
        enough = enough && (!before || TL_COLUMN_NEED(&p->table, p, force_before[k], TL_COLUMN_STEP));
    }
    return enough;
}

bool tl_gridpoints_hold_loads(tl_gridpoints *p)
{
    bool enough = true;
    for (int k = 0; k < 3; k++)
        enough = enough && TL_COLUMN_NEED(&p->table, p, load[k], TL_COLUMN_STATE);
    return enough;
}

bool tl_gridpoints_hold_pushed(tl_gridpoints *p)
{
    bool enough = true;
    for (int k = 0; k < 3; k++)
        enough = enough && TL_COLUMN_NEED(&p->table, p, pushed[k], 0);
    return enough;
}

bool tl_gridpoints_hold_quiet(tl_gridpoints *p)
{
    bool enough = true;
    for (int k = 0; k < 6; k++)
        enough = enough && TL_COLUMN_NEED(&p->table, p, quiet[k], 0);
    return enough;
}

bool tl_gridpoints_hold_directions(tl_gridpoints *p)
{
    bool enough = true;
    for (int k = 0; k < 3; k++)
        enough = enough && TL_COLUMN_NEED(&p->table, p, rolled[k], TL_COLUMN_STEP);
    for (int d = 1; d >= 0; d--) /* the first component of the first one comes last: it tells that all are there */
        for (int k = 2; k >= 0; k--)
            enough = enough && TL_COLUMN_NEED(&p->table, p, held[d][k], TL_COLUMN_STATE);
    return enough;
}

bool tl_gridpoints_hold_drives(tl_gridpoints *p)
{
    return TL_COLUMN_NEED(&p->table, p, drive, 0);
}
