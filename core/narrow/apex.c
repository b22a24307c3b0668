/* apex.c - the energy of a block's cells from the surface S alone: see field.h.
 *
 * Mostly a corner, an edge or a face is pressed in. Then all planes of a block that bound K meet in one point x_0, its
 * apex. There d is homogeneous about x_0 in the cells of this block. (x - x_0) d has the divergence 4 d, x - x_0 has
 * 3, and on the faces both are tangents. So S alone gives the block's share in G, int d (x - x_0) . n dS / 4, and the
 * polygons between its cells are not needed. The same holds of d^n, with n + 3 for 4. A face q that passes by x_0 at
 * the depth d_q adds d_q V_q / 4, with the volume V_q of its cell. For that the polygons between this cell and the
 * others are needed. */
#include "narrow/apex.h"

#include "narrow/field_lanes.h"

#include <math.h>
#include <talus/vmath.h>

/* What of a direction does not leave the planes that hold an apex: nothing of three. */
static tl_vec3 within(const tl_apex *p, tl_vec3 way)
{
    if (p->count == 3)
        return tl_v3(0, 0, 0);
    for (int i = 0; i < p->count; i++)
        way = tl_v3_madd(way, -p->per[i] * tl_v3_dot(p->held[i], way), p->held[i]);
    return way;
}

/* Whether an apex lies in a plane, and all points that it may be do. */
static bool holds(const tl_apex *p, const tl_field_faces *f, uint32_t face, double one_plane)
{
    tl_vec3 n = tl_field_normal(f, face);
    return fabs(f->c[face] - tl_v3_dot(n, p->x)) <= one_plane &&
           (p->count == 3 || tl_v3_norm2(within(p, n)) < TL_FIELD_ALIKE * TL_FIELD_ALIKE);
}

/* From where it is, the point goes on to one plane more, along those before; false: the plane has nearly their
 * directions. */
static bool hold(tl_apex *p, const tl_field_faces *f, uint32_t face, double least2)
{
    tl_vec3 n = tl_field_normal(f, face), way = within(p, n);
    double sine2 = tl_v3_norm2(way);
    if (!(sine2 > least2))
        return false;
    p->held[p->count] = way;
    p->per[p->count] = 1 / sine2;
    p->x = tl_v3_madd(p->x, (f->c[face] - tl_v3_dot(n, p->x)) * p->per[p->count], way);
    p->count++;
    return true;
}

tl_apex_faces tl_apex_choose(const tl_field_faces *f, const uint16_t *face, uint32_t count, double one_plane)
{
    tl_apex p = {.count = 0};
    tl_apex_faces out = {.known = true};
    uint32_t left[TL_FIELD_KNOWN], more = 0;
    for (uint32_t k = 0; k < count; k++) {
        if (p.count < 3 && hold(&p, f, face[k], TL_FIELD_STEEP * TL_FIELD_STEEP))
            out.held[out.holds++] = (uint8_t)face[k];
        else
            left[more++] = face[k];
    }
    for (uint32_t k = 0; k < more && out.known; k++)
        if (!holds(&p, f, left[k], one_plane)) {
            out.known = f->energy_only && out.strays < TL_APEX_STRAYS;
            if (out.known)
                out.stray[out.strays++] = (uint8_t)left[k];
        }
    return out;
}

/* The point in which three planes meet. */
static tl_vec3 meeting(const tl_field_faces *f, const uint8_t face[3])
{
    const tl_vec3 a = tl_field_normal(f, face[0]), b = tl_field_normal(f, face[1]), c = tl_field_normal(f, face[2]);
    const tl_vec3 bc = tl_v3_cross(b, c), ca = tl_v3_cross(c, a), ab = tl_v3_cross(a, b);
    const tl_vec3 sum = tl_v3_madd(tl_v3_madd(tl_v3_scale(f->c[face[0]], bc), f->c[face[1]], ca), f->c[face[2]], ab);
    return tl_v3_scale(1 / tl_v3_dot(a, bc), sum);
}

tl_apex tl_apex_find(const tl_field_faces *f, const tl_apex_faces *by)
{
    tl_apex p = {.known = by->known, .strays = by->strays};
    if (by->known && by->holds == 3) {
        p.x = meeting(f, by->held);
        p.count = 3;
    }
    for (uint32_t k = 0; k < by->holds && by->known && p.count < 3; k++)
        hold(&p, f, by->held[k], 0);
    for (uint32_t k = 0; k < by->strays; k++)
        p.stray[k] = by->stray[k];
    return p;
}

/* The flux of -n_face d, whose divergence is 1 in the cell, and which vanishes on the face. */
void tl_apex_add_side(tl_apex *p, const tl_field_faces *f, uint32_t face, tl_vec3 n, double d)
{
    for (uint32_t k = 0; k < p->strays; k++)
        if (p->stray[k] == face)
            p->volume[k] += tl_v3_dot(n, tl_field_normal(f, face)) * d;
}

/* Of the points that an apex may be, that nearest the centre of pressure is taken. Roundings of the force count by the
 * way from there. */
void tl_apex_add_shares(const tl_apex apex[2], const tl_field_faces *f, double by_force, double by_swept,
                        const double by_power[TL_FIELD_POWERS], tl_field_sums *sums)
{
    if (!(sums->pressure > 0))
        return;
    tl_vec3 centre = tl_v3_scale(1 / sums->pressure, sums->pressed);
    for (int of_b = 0; of_b < 2; of_b++) {
        const tl_apex *p = &apex[of_b];
        if (!p->known)
            continue;
        double side = of_b ? -1 : 1; /* n points into the cells of A */
        tl_vec3 x = tl_v3_add(p->x, within(p, tl_v3_sub(centre, p->x)));
        sums->energy += 0.25 * side * (tl_v3_dot(x, sums->force) - by_force);
        sums->volume += (1.0 / 3) * side * (tl_v3_dot(x, sums->swept) - by_swept);
        for (int k = 0; k < TL_FIELD_POWERS && f->powers; k++)
            sums->powers[k].whole += side * (tl_v3_dot(x, sums->powers[k].force) - by_power[k]) / (5 + k);
        for (uint32_t k = 0; k < p->strays; k++) {
            uint32_t face = p->stray[k];
            sums->energy += 0.25 * (f->c[face] - tl_v3_dot(tl_field_normal(f, face), x)) * p->volume[k];
        }
    }
}
