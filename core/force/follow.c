/* follow.c - what a step does with every contact whose points stand: gaps, normals and relative motion of its points in the
 * present place.
 *
 * Shear forces are turned with the common plane, exactly from the old normal to the new and by its spin about it; (5) of
 * Hart, Cundall and Lemos (1988) is the first order of this. Two bodies that turn as one make no slip, and their forces turn
 * with them.
 *
 * The points of a patch ride: they lie between where A and B have carried them since they were laid, nearer to B by the share
 * s, `ride` of the facet. The common plane turns with A by s and with B by 1 - s. Then normal forces are the gradient of the energy
 * of the points' overlaps, and the tangent stiffness is symmetric under any normal and shear force. Points that stayed in A's
 * frame with forces along the bisector would give and take energy.
 *
 * The centre of pressure of a field contact moves. Its shear force before the step acted at the old centre, that after it acts at the
 * new one. So the motion is taken half-way between: the work of the mean force is then right to the second order of the step.
 *
 * Eight contacts are worked on side by side (tl_simd_group). What is the same for all points of a contact is brought into
 * matrices first, one in each lane (frames.c), so that what is left for a point are a few products, in loops over
 * columns without a branch. */
#include "force/follow.h"

#include "base/columns.h"
#include "contact/detection.h"
#include "contact/facing.h"
#include "force/frames.h"
#include "force/turning.h"

#include <math.h>
#include <string.h>

/* Closure, over the distance of the point from the body's centroid, up to which walls just touch: roundings of that distance and of the
 * plane's. Else they would decide whether a joint that bears nothing yet is closed, and what slip opens of it. */
#define TOUCHING 1e-14

/* ---------------------------------------------------------------- points ----------------- */

/* Columns of points and lanes, row 0 of both the first of a SIMD group. */
typedef struct columns {
    const double *reference;
    double *p[3], *f_s[3];
    double *arm[3], *normal[3], *closure, *du_n, *du_s[3];
} columns;

static columns columns_at(const tl_points_table *p, size_t row, const tl_point_lanes *t,
                          size_t lane)
{
    return (columns){
        .p = {p->p[0] + row, p->p[1] + row, p->p[2] + row},
        .reference = p->reference ? p->reference + row : t->zero + lane,
        .f_s = {p->f_s[0] + row, p->f_s[1] + row, p->f_s[2] + row},
        .arm = {t->arm[0] + lane, t->arm[1] + lane, t->arm[2] + lane},
        .normal = {t->normal[0] + lane, t->normal[1] + lane, t->normal[2] + lane},
        .closure = t->closure + lane,
        .du_n = t->du_n + lane,
        .du_s = {t->du_s[0] + lane, t->du_s[1] + lane, t->du_s[2] + lane},
    };
}

TL_INLINE void put(double *const column[3], size_t i, tl_vec3 v)
{
    tl_columns_put(column, i, v);
}

TL_VECTORIZED static void follow_points(const columns *c, size_t slots, const tl_frames *restrict f)
{
    for (size_t at = 0; at < slots * TL_LANES; at += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            size_t i = at + l;
            tl_mat3 to = tl_lanes9_get(&f->to, l), motion = tl_lanes9_get(&f->m, l);
            tl_mat3 turn = tl_lanes9_get(&f->turn, l);
            tl_vec3 n = tl_lanes3_get(&f->n, l);
            tl_vec3 x = tl_m3_mul(&to, tl_columns_get(c->p, i));
            tl_vec3 du = tl_v3_add(tl_lanes3_get(&f->way, l), tl_m3_mul(&motion, x));
            double du_n = tl_v3_dot(du, n);
            put(c->arm, i, x);
            put(c->normal, i, n);
            double offset = f->offset[l];
            double closure = offset - tl_v3_dot(tl_lanes3_get(&f->plane, l), x) - c->reference[i];
            c->closure[i] =
                fabs(closure) > TOUCHING * (fabs(offset) + fabs(x.x) + fabs(x.y) + fabs(x.z))
                    ? closure
                    : 0;
            c->du_n[i] = du_n;
            put(c->du_s, i, tl_v3_madd(du, -du_n, n));
            put(c->f_s, i, tl_m3_mul(&turn, tl_columns_get(c->f_s, i)));
        }
}

/* The shear forces of the points of torsion, which lie along the normal: as they are, and how large. */
typedef struct torsions {
    tl_lanes3 force;
    double size[TL_LANES];
} torsions;

TL_VECTORIZED static void read_torsion(const columns *c, const tl_frames *restrict f,
                                       torsions *restrict torsion)
{
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_vec3 force = tl_columns_get(c->f_s, TL_FIELD_TORSION * TL_LANES + l);
        tl_lanes3_put(&torsion->force, l, force);
        torsion->size[l] = tl_v3_dot(force, tl_lanes3_get(&f->last, l));
    }
}

/* What a field contact keeps that its points of torsion are followed by: the radius, and by how much more than at those of shear
 * slip has opened the joint there. Both carry the same normal force. */
typedef struct field_rows {
    double radius[TL_LANES], opened[TL_LANES];
    tl_lanes3 half; /* half of the way of the centre in the step */
} field_rows;

/* The points of torsion of field contacts: what is a shear to the law is the turn about the normal, times the radius. The
 * law is given a normal that is perpendicular to it. While the contact's own does not turn, the force is not made anew: it
 * would be off by a rounding, and never rest. */
TL_VECTORIZED static void follow_torsion(const columns *c, const tl_frames *restrict f,
                                         const field_rows *restrict rows,
                                         const torsions *restrict torsion)
{
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        size_t i = TL_FIELD_TORSION * TL_LANES + l, shear = TL_FIELD_SHEAR * TL_LANES + l;
        tl_mat3 motion = tl_lanes9_get(&f->m, l);
        tl_vec3 n = tl_lanes3_get(&f->n, l);
        tl_vec3 less = tl_m3_mul(&motion, tl_lanes3_get(&rows->half, l));
        double less_n = tl_v3_dot(less, n);
        c->du_n[shear] -= less_n;
        put(c->du_s, shear,
            tl_v3_sub(tl_columns_get(c->du_s, shear), tl_v3_madd(less, -less_n, n)));
        tl_vec3 turn =
            tl_v3(0.5 * (motion.m[2][1] - motion.m[1][2]), 0.5 * (motion.m[0][2] - motion.m[2][0]),
                  0.5 * (motion.m[1][0] - motion.m[0][1]));
        put(c->normal, i, tl_facing_aside(n));
        c->closure[i] -= rows->opened[l];
        put(c->du_s, i, tl_v3_scale(rows->radius[l] * tl_v3_dot(turn, n), n));
        tl_vec3 last = tl_lanes3_get(&f->last, l);
        bool still = (last.x == n.x) & (last.y == n.y) & (last.z == n.z);
        put(c->f_s, i,
            still ? tl_lanes3_get(&torsion->force, l) : tl_v3_scale(torsion->size[l], n));
    }
}

/* ---------------------------------------------------------------- SIMD groups ------------ */

/* Turns the tangent states of a contact's points. */
static void turn_states(tl_model *m, uint32_t contact, tl_vec3 before, tl_vec3 now, tl_vec3 half,
                        uint32_t tangents)
{
    tl_points_table *p = &m->detect->points;
    for (uint32_t k = 0; k + 2 < p->state_columns; k++) {
        double *v[3] = {p->state[k], p->state[k + 1], p->state[k + 2]};
        for (uint32_t j = 0; j < m->detect->contacts.point_count[contact] && tangents >> k & 1;
             j++) {
            size_t row = tl_point_row(&m->detect->contacts, contact, j);
            tl_columns_put(v, row, tl_turn_one(tl_columns_get(v, row), before, now, half));
        }
    }
}

/* The bodies and facets of the contacts of a SIMD group; lanes without one do as another. false when there are none. */
static bool look_up(const tl_model *m, const tl_simd_group *group, tl_frame_rows *rows)
{
    const tl_contacts *c = &m->detect->contacts;
    const tl_pose *pose = m->bodies.pose;
    size_t some = 0;
    while (some < TL_LANES && group->contact[some] == TL_NO_ROW)
        some++;
    rows->dt = m->dt;
    for (size_t l = 0; l < TL_LANES && some < TL_LANES; l++) {
        uint32_t contact = group->contact[group->contact[l] == TL_NO_ROW ? some : l];
        rows->a[l] = &pose[m->blocks.body[c->a[contact]]].r.m[0][0];
        rows->b[l] = &pose[m->blocks.body[c->b[contact]]].r.m[0][0];
        rows->facet[l] = &c->facet[contact].na.x;
    }
    return some < TL_LANES;
}

/* The same of what field contacts keep. */
static void look_up_fields(const tl_model *m, const tl_simd_group *group, field_rows *fields)
{
    const tl_contacts *c = &m->detect->contacts;
    memset(fields, 0, sizeof *fields);
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t contact = group->contact[l];
        uint32_t press = contact == TL_NO_ROW ? TL_NO_ROW : c->press[contact];
        if (press == TL_NO_ROW)
            continue;
        const tl_press_row *row = &m->detect->press[press];
        fields->radius[l] = row->press.radius;
        fields->opened[l] = row->opening[TL_FIELD_TORSION] - row->opening[TL_FIELD_SHEAR];
        if (row->moved_at == m->cycles) {
            const tl_mat3 *turn = &m->bodies.pose[m->blocks.body[c->a[contact]]].r;
            tl_lanes3_put(&fields->half, l, tl_m3_mul(turn, row->half));
        }
    }
}

void tl_simd_group_follow(tl_model *m, const tl_simd_group *group, bool field,
                          const tl_point_lanes *t, size_t lane, uint32_t tangents, tl_arms *arms)
{
    tl_contacts *contacts = &m->detect->contacts;
    columns c = columns_at(&m->detect->points, group->start, t, lane);
    tl_frame_rows rows;
    tl_frames f;
    field_rows fields;
    torsions torsion;
    if (look_up(m, group, &rows)) {
        tl_frames_put(&f, &rows, field, arms);
    } else { /* inert, but finite */
        memset(&f, 0, sizeof f);
        memset(arms, 0, sizeof *arms);
    }
    if (field) {
        look_up_fields(m, group, &fields);
        read_torsion(&c, &f, &torsion);
    }
    follow_points(&c, group->slots, &f);
    if (field)
        follow_torsion(&c, &f, &fields, &torsion);
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t contact = group->contact[l];
        if (contact == TL_NO_ROW)
            continue;
        tl_vec3 n = tl_lanes3_get(&f.n, l);
        if (tangents)
            turn_states(m, contact, contacts->facet[contact].last, n, tl_lanes3_get(&f.half, l),
                        tangents);
        contacts->facet[contact].last = n;
        contacts->new_points[contact] = TL_POINTS_STAY;
    }
}
