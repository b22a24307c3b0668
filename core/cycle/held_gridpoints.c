/* held_gridpoints.c - gridpoints that follow drives, are held along any direction, or are pushed at the surface.
 *
 * Few gridpoints do. All are moved lane by lane first (gridpoints.c), then these are mended. Let P take the part of a
 * vector that is free. Before the kick h the velocity is v0 = w0 + s with s held. After it, it is v* if nothing else
 * holds the gridpoint. A quiet face has the resistance C (zone/outer.c), the gridpoint mass M and damping a:
 *
 *     (A I + h P C P / 2) w1 = A P v* - h P C (w0 + 2 s) / 2,    A = M (1 + a h / 2),    v1 = w1 + s
 *
 * So C acts with the mean of the velocities before and after, and takes energy in a step of any length. */
#include "cycle/held_gridpoints.h"

#include "base/columns.h"
#include "cycle/turn.h"
#include "geometry/polar.h"
#include "zone/driven.h"
#include "zone/held.h"

/* ---------------------------------------------------------------- drives ----------------- */

/* The velocity with which a point on an arm goes, in dt, to where a turn brings it. */
static tl_vec3 turning(tl_quat turn, tl_vec3 arm, double dt)
{
    const tl_vec3 v = tl_v3(turn.x, turn.y, turn.z);
    return tl_v3_scale(2 / dt, tl_v3_cross(v, tl_v3_madd(tl_v3_cross(v, arm), turn.w, arm)));
}

/* Gives the gridpoints of driven bodies the motion of a rigid one about their mean by mass. */
static void drive_bodies(tl_model *m, double dt)
{
    tl_gridpoints *p = &m->zones->points;
    for (size_t k = 0; k < m->zones->mesh_count && dt > 0; k++) {
        const tl_body_mesh *mesh = &m->zones->mesh[k];
        if (!m->bodies.drive[mesh->row])
            continue;
        const tl_drive_record *drive = &m->drives[m->bodies.drive[mesh->row] - 1];
        const tl_quat turn = tl_turn_by(tl_v3_scale(dt, drive->angular_velocity));
        const tl_vec3 at = tl_body_place(&m->bodies, mesh->row);
        for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++) {
            const tl_vec3 arm = tl_v3_sub(tl_gridpoint_place(p, row), at);
            tl_columns_put(p->v, row, tl_v3_add(drive->velocity, turning(turn, arm, dt)));
        }
    }
}

void tl_gridpoints_follow_drives(tl_model *m, double dt)
{
    if (m->drive_count == 0)
        return;
    const tl_gridpoints *p = &m->zones->points;
    drive_bodies(m, dt);
    for (size_t row = 0; p->drive && row < p->table.rows; row++)
        if (p->drive[row])
            tl_columns_put(p->v, row, tl_gridpoint_driven(m, (uint32_t)row, dt));
}

/* A velocity that jumps may turn zones inside out: the steps until that is seen can be undone. */
void tl_gridpoints_expect(tl_model *m)
{
    if (!tl_model_deforms(m))
        return;
    const tl_gridpoints *p = &m->zones->points;
    for (size_t row = 0; p->drive && row < p->table.rows; row++) {
        const tl_vec3 v = tl_columns_get(p->v, row);
        if (p->drive[row] && tl_v3_norm2(tl_v3_sub(tl_gridpoint_driven(m, (uint32_t)row, m->dt), v)) > tl_v3_norm2(v))
            m->zones->steps_kept = TL_STEPS_KEPT;
    }
}

/* ---------------------------------------------------------------- motion ----------------- */

bool tl_gridpoints_mend(const tl_model *m)
{
    const tl_gridpoints *p = &m->zones->points;
    return p->pushed[0] || p->held[0][0];
}

/* Whether a quiet face resists its motion. */
static bool is_quiet(const tl_gridpoints *p, size_t row)
{
    return p->quiet[0] && p->quiet[0][row] + p->quiet[1][row] + p->quiet[2][row] > 0;
}

static bool is_held_along(const tl_gridpoints *p, size_t row)
{
    return p->held[0][0] && tl_v3_norm2(tl_columns_get(p->held[0], row)) > 0;
}

/* What resists a velocity there, N. */
static tl_vec3 resistance(const tl_gridpoints *p, size_t row, tl_vec3 v)
{
    double *const *c = p->quiet;
    return tl_v3(c[0][row] * v.x + c[3][row] * v.y + c[5][row] * v.z,
                 c[3][row] * v.x + c[1][row] * v.y + c[4][row] * v.z,
                 c[5][row] * v.x + c[4][row] * v.y + c[2][row] * v.z);
}

/* The free part of the velocity that resistance leaves, `free` without it. */
static tl_vec3 resisted(const tl_gridpoints *p, size_t row, const tl_point_moved *by, tl_vec3 w0, tl_vec3 free)
{
    const double half = 0.5 * by->kick, slow = by->mass * (1 + by->alpha * half);
    const tl_vec3 held = tl_v3_sub(by->v0, w0);
    tl_mat3 matrix;
    for (int j = 0; j < 3; j++) {
        const tl_vec3 axis = tl_v3(j == 0, j == 1, j == 2);
        const tl_vec3 moved = resistance(p, row, tl_gridpoint_free_part(p, row, axis));
        const tl_vec3 column = tl_v3_madd(tl_v3_scale(slow, axis), half, tl_gridpoint_free_part(p, row, moved));
        matrix.m[0][j] = column.x;
        matrix.m[1][j] = column.y;
        matrix.m[2][j] = column.z;
    }
    const tl_vec3 against = tl_gridpoint_free_part(p, row, resistance(p, row, tl_v3_madd(w0, 2, held)));
    const tl_mat3 inverse = tl_m3_inverse(&matrix);
    const tl_vec3 right = tl_v3_madd(tl_v3_scale(slow, free), -half, against);
    return tl_gridpoint_free_part(p, row, tl_m3_mul(&inverse, right));
}

static void book_work(const tl_gridpoints *p, size_t row, const tl_point_moved *by, tl_work_kind kind, tl_vec3 force,
                      size_t lane, double book[TL_BOOK_COUNT][TL_LANES])
{
    book[TL_BOOK_UNTIL(kind)][lane] += by->until * tl_v3_dot(force, tl_columns_get(p->moved, row));
    book[TL_BOOK_AFTER(kind)][lane] += by->after * tl_v3_dot(force, tl_columns_get(p->v, row));
}

void tl_gridpoint_mend(const tl_model *m, size_t row, const tl_point_moved *by, size_t lane,
                       double book[TL_BOOK_COUNT][TL_LANES])
{
    const tl_gridpoints *p = &m->zones->points;
    const bool quiet = is_quiet(p, row), along = is_held_along(p, row);
    if (quiet || along) {
        const tl_vec3 as_if = tl_columns_get(p->v, row), w0 = tl_gridpoint_free_part(p, row, by->v0);
        tl_vec3 free = tl_gridpoint_free_part(p, row, as_if);
        if (quiet)
            free = resisted(p, row, by, w0, free);
        const tl_vec3 v1 = tl_v3_add(tl_v3_sub(by->v0, w0), free);
        tl_columns_put(p->v, row, v1);
        tl_columns_put(p->u, row, tl_v3_madd(tl_columns_get(p->u, row), by->drift, tl_v3_sub(v1, as_if)));
    }
    if (quiet) {
        const tl_vec3 mean = tl_v3_scale(0.5, tl_v3_add(by->v0, tl_columns_get(p->v, row)));
        const tl_vec3 force = tl_gridpoint_free_part(p, row, resistance(p, row, mean));
        book_work(p, row, by, TL_WORK_DAMPING, tl_v3_neg(force), lane, book);
    }
    if (along)
        book_work(p, row, by, TL_WORK_EXTERNAL, tl_columns_get(p->rolled, row), lane, book);
    if (p->pushed[0])
        book_work(p, row, by, TL_WORK_EXTERNAL, tl_columns_get(p->pushed, row), lane, book);
}
