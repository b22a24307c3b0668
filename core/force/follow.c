/* follow.c - what a step does with every contact whose points stand: gaps, normals and relative motion of its points in
 * the present place.
 *
 * Shear forces are turned with the common plane, exactly from the old normal to the new and by its spin about it. (5)
 * of Hart, Cundall and Lemos (1988) is the first order of this. Two bodies that turn as one make no slip, and their
 * forces turn with them.
 *
 * The points of a patch ride: they lie between where A and B have carried them since they were laid, nearer to B by the
 * share s, `ride` of the facet. The common plane turns with A by s and with B by 1 - s. Then normal forces are the
 * gradient of the energy of the points' overlaps, and the tangent stiffness is symmetric under any normal and shear
 * force. Points that stayed in A's frame with forces along the bisector would give and take energy.
 *
 * The centre of pressure of a field contact moves. Its shear force before the step acted at the old centre, that after
 * it acts at the new one. So the motion is taken half-way between: the work of the mean force is then right to the
 * second order of the step.
 *
 * Eight contacts are worked on side by side (tl_simd_group). What is the same for all points of a contact is brought
 * into matrices first, one in each lane. For a point a few products are left, without a branch. */
#include "force/follow.h"

#include "base/columns.h"
#include "base/inline.h"
#include "base/series.h"
#include "contact/facing.h"
#include "contact/plane_turn.h"
#include "contact/sides.h"

#include <assert.h>
#include <math.h>
#include <string.h>

/* ---------------------------------------------------------------- frames ------------------
 *
 * How bodies moved in the last step, and facets in the lanes of a SIMD group.
 *
 * What eight contacts need is scattered over their bodies and facets: it is read as rows and transposed, and then
 * worked out for all of them at once. */

/* One contact in each lane, in its present place, and how its points move. */
typedef struct tl_frames {
    tl_lanes9 to; /* of points to their arms */
    tl_lanes3 n, plane;
    double offset[TL_LANES]; /* tl_facing */
    tl_lanes3 last;          /* normal in the last step */
    /* the motion of B against A in the last step at an arm: way + m arm; the spin of the common plane, as axis times
     * the tangent of half its angle: B's by the share by which points stay with A, A's by the rest */
    tl_lanes3 way, half;
    tl_lanes9 m;
    tl_lanes9 turn; /* how shear forces turn, from the last common plane into the present one */
} tl_frames;

/* The bodies of a contact and its facet for each lane. */
typedef struct tl_frame_rows {
    const double *a[TL_LANES], *b[TL_LANES]; /* tl_pose */
    const double *facet[TL_LANES];           /* tl_facet */
    double dt;                               /* of the last step */
} tl_frame_rows;

/* The square of an angle by which a body turned is small enough for the series. */
TL_INLINE bool is_small(double a2)
{
    return a2 < 4 * TL_SERIES_HALF_ANGLE * TL_SERIES_HALF_ANGLE;
}

/* tan(a/2) / a by its series, from the square of a. */
TL_INLINE double tangent_series(double a2)
{
    return 0.5 + a2 * (1. / 24 + a2 * (1. / 240 + a2 * (17. / 40320 + a2 * 31. / 725760)));
}

static double tangent_of(double a2)
{
    return is_small(a2) ? tangent_series(a2) : tl_tan(0.5 * sqrt(a2)) / sqrt(a2);
}

/* What a point has moved beside the centroid, as it acts on its arm from there now: 2 / (1 + h^2) ([h] - [h]^2), where
 * h is axis times the tangent of half the angle of the turn. Exact: rolling contacts gather no slip. */
TL_INLINE tl_mat3 turn_back(tl_vec3 h)
{
    tl_vec3 s = tl_v3_scale(2 / (1 + tl_v3_norm2(h)), h);
    return (tl_mat3){{{s.y * h.y + s.z * h.z, -s.x * h.y - s.z, -s.x * h.z + s.y},
                      {-s.y * h.x + s.z, s.z * h.z + s.x * h.x, -s.y * h.z - s.x},
                      {-s.z * h.x - s.y, -s.z * h.y + s.x, s.x * h.x + s.y * h.y}}};
}

/* ---------------------------------------------------------------- lanes ------------------ */

/* What is known of a contact and its bodies, a lane each, before the lanes work out together what follows from it. */
typedef struct known_lanes {
    double a[TL_POSE_ROW][TL_LANES], b[TL_POSE_ROW][TL_LANES]; /* tl_pose */
    double facet[TL_FACET_ROW][TL_LANES];                      /* tl_facet */
} known_lanes;

/* Where the members of a facet and of a pose are in their rows. */
#define AT(type, member) (offsetof(type, member) / sizeof(double))
enum {
    NA = AT(tl_facet, na),
    NB = AT(tl_facet, nb),
    OFFSET = AT(tl_facet, offset),
    LAST = AT(tl_facet, last),
    RIDE = AT(tl_facet, ride),
    LAID_TURN = AT(tl_facet, laid.turn),
    LAID_SHIFT = AT(tl_facet, laid.shift),
    X_REF = AT(tl_pose, x_ref),
    U = AT(tl_pose, u),
    V_MOVED = AT(tl_pose, v_moved),
    W_MOVED = AT(tl_pose, w_moved),
    POSE_DOUBLES = (AT(tl_pose, unused) + 1) / 2 * 2 /* with r at its begin; an even number */
};
static_assert(sizeof(tl_facet) >= TL_FACET_ROW * sizeof(double), "a facet is shorter than its row");
static_assert(sizeof(tl_pose) == TL_POSE_ROW * sizeof(double), "a pose is not its row");
static_assert(sizeof(tl_pose) % TL_ALIGN == 0, "poses do not begin where lines of memory do");
static_assert(AT(tl_pose, r) == 0, "a pose does not begin with its matrix");

/* Wider ones would be taken apart into doubles before the copies of a TL_VECTORIZED function are made. */
typedef double pair __attribute__((vector_size(16)));

/* Puts two doubles of two rows each side by side. */
TL_INLINE void put_pairs(double *first, double *second, const double *left, const double *right)
{
    pair a, b;
    memcpy(&a, left, sizeof a);
    memcpy(&b, right, sizeof b);
    pair low = __builtin_shufflevector(a, b, 0, 2), high = __builtin_shufflevector(a, b, 1, 3);
    memcpy(first, &low, sizeof low);
    memcpy(second, &high, sizeof high);
}

/* Turns `count` doubles, an even number, of a row for each lane into a row of lanes for each double. */
TL_INLINE void transpose(double (*restrict to)[TL_LANES], const double *const *row, size_t count)
{
#pragma GCC unroll 1
    for (size_t k = 0; k < count; k += 2)
        for (size_t l = 0; l < TL_LANES; l += 2)
            put_pairs(&to[k][l], &to[k + 1][l], row[l] + k, row[l + 1] + k);
}

TL_INLINE tl_mat3 difference(const tl_mat3 *a, const tl_mat3 *b)
{
    return (tl_mat3){{{a->m[0][0] - b->m[0][0], a->m[0][1] - b->m[0][1], a->m[0][2] - b->m[0][2]},
                      {a->m[1][0] - b->m[1][0], a->m[1][1] - b->m[1][1], a->m[1][2] - b->m[1][2]},
                      {a->m[2][0] - b->m[2][0], a->m[2][1] - b->m[2][1], a->m[2][2] - b->m[2][2]}}};
}

/* How shear forces turn: from the normal `from` of the last step to n, then by twice the angle of tangent w about that.
 * With h = from x n + w (from + n) that is 1 + p [h] + p q [h]^2, p = 1 / (1 + w^2), q = 1 / (1 + from . n). What has
 * not turned stays, to the bit. */
TL_INLINE void put_turn(tl_frames *f, size_t l, tl_vec3 from)
{
    tl_vec3 n = tl_lanes3_get(&f->n, l);
    double w = tl_v3_dot(tl_lanes3_get(&f->half, l), n), c = 1 + tl_v3_dot(from, n);
    tl_vec3 h = tl_v3_madd(tl_v3_cross(from, n), w, tl_v3_add(from, n));
    tl_vec3 s = tl_v3_scale(1 / (1 + w * w), h), g = tl_v3_scale(1 / (c > 0 ? c : 1), h);
    tl_mat3 turn = {{{1 - (s.y * g.y + s.z * g.z), s.x * g.y - s.z, s.x * g.z + s.y},
                     {s.y * g.x + s.z, 1 - (s.z * g.z + s.x * g.x), s.y * g.z - s.x},
                     {s.z * g.x - s.y, s.z * g.y + s.x, 1 - (s.x * g.x + s.y * g.y)}}};
    /* out of it what is along `from`: rounding would lead out of the plane in the course of many steps */
    tl_vec3 out = tl_v3_scale(tl_v3_norm2(h) > 0 ? 1 : 0, n);
    tl_mat3 along = {{{out.x * from.x, out.x * from.y, out.x * from.z},
                      {out.y * from.x, out.y * from.y, out.y * from.z},
                      {out.z * from.x, out.z * from.y, out.z * from.z}}};
    turn = difference(&turn, &along);
    tl_lanes9_put(&f->turn, l, &turn);
}

/* Element k and the two behind it as a vector of lane l. */
TL_INLINE tl_vec3 row_vec3(double (*row)[TL_LANES], size_t k, size_t l)
{
    return tl_v3(row[k][l], row[k + 1][l], row[k + 2][l]);
}

TL_INLINE tl_mat3 row_mat3(double (*row)[TL_LANES], size_t l)
{
    return (tl_mat3){
        {{row[0][l], row[1][l], row[2][l]}, {row[3][l], row[4][l], row[5][l]}, {row[6][l], row[7][l], row[8][l]}}};
}

/* Places of the points of the patch in lane l. Arms are then taken from `at`, which costs nothing at each point. */
TL_INLINE void put_places(tl_frames *f, tl_arms *arms, size_t l, double (*facet)[TL_LANES], const tl_mat3 *ra,
                          const tl_mat3 *rb, tl_vec3 d)
{
    tl_mat3 turn = row_mat3(&facet[LAID_TURN], l), moved = tl_lanes9_get(&f->m, l);
    tl_facing_place place = tl_facing_ride(ra, rb, d, &turn, row_vec3(facet, LAID_SHIFT, l), facet[RIDE][l]);
    tl_lanes9_put(&f->to, l, &place.to);
    tl_lanes3_put(&arms->at, l, place.at);
    tl_lanes3_put(&f->way, l, tl_v3_add(tl_lanes3_get(&f->way, l), tl_m3_mul(&moved, place.at)));
    f->offset[l] -= tl_v3_dot(tl_lanes3_get(&f->plane, l), place.at);
}

/* The turn of a body in the last step, in lane l: axis times angle. */
TL_INLINE tl_vec3 turn_of(double (*row)[TL_LANES], size_t l, double dt)
{
    return tl_v3_scale(dt, row_vec3(row, W_MOVED, l));
}

/* tan(a/2) / a of the turns of a body in each lane. */
TL_INLINE void put_tangents(double *restrict tangent, double (*row)[TL_LANES], double dt)
{
    double wide = 0;
#pragma omp simd reduction(+ : wide)
    for (size_t l = 0; l < TL_LANES; l++) {
        double a2 = tl_v3_norm2(turn_of(row, l, dt));
        tangent[l] = tangent_series(a2);
        wide += is_small(a2) ? 0 : 1;
    }
    for (size_t l = 0; wide > 0 && l < TL_LANES; l++)
        tangent[l] = tangent_of(tl_v3_norm2(turn_of(row, l, dt)));
}

/* Motion of B against A in the last step, by half their turns; `d` is the way from A's centroid to B's. */
TL_INLINE void put_motion(tl_frames *f, size_t l, tl_vec3 half_a, tl_vec3 half_b, tl_vec3 way, tl_vec3 d, double ride)
{
    tl_mat3 ma = turn_back(half_a), mb = turn_back(half_b);
    tl_lanes3_put(&f->way, l, tl_v3_sub(way, tl_m3_mul(&mb, d)));
    tl_lanes3_put(&f->half, l, tl_v3_madd(tl_v3_scale(ride, half_a), 1 - ride, half_b));
    tl_mat3 moved = difference(&mb, &ma);
    tl_lanes9_put(&f->m, l, &moved);
}

/* `field` is a constant at each call. */
TL_INLINE void put_all(tl_frames *restrict f, const tl_frame_rows *restrict rows, bool field, tl_arms *restrict arms)
{
    double tangent_a[TL_LANES], tangent_b[TL_LANES];
    known_lanes p;
    transpose(p.a, rows->a, POSE_DOUBLES);
    transpose(p.b, rows->b, POSE_DOUBLES);
    transpose(p.facet, rows->facet, field ? TL_FIELD_ROW : TL_FACET_ROW);
    put_tangents(tangent_a, p.a, rows->dt);
    put_tangents(tangent_b, p.b, rows->dt);
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_vec3 d =
            tl_apart(row_vec3(p.a, X_REF, l), row_vec3(p.a, U, l), row_vec3(p.b, X_REF, l), row_vec3(p.b, U, l));
        tl_vec3 v = tl_v3_sub(row_vec3(p.b, V_MOVED, l), row_vec3(p.a, V_MOVED, l));
        double ride = field ? 0.5 : p.facet[RIDE][l];
        put_motion(f, l, tl_v3_scale(tangent_a[l], turn_of(p.a, l, rows->dt)),
                   tl_v3_scale(tangent_b[l], turn_of(p.b, l, rows->dt)), tl_v3_scale(rows->dt, v), d, ride);
        tl_mat3 ra = row_mat3(p.a, l), rb = row_mat3(p.b, l);
        tl_vec3 na = tl_m3_mul(&ra, row_vec3(p.facet, NA, l));
        tl_vec3 nb = tl_m3_mul(&rb, row_vec3(p.facet, NB, l));
        tl_facing to =
            field ? tl_facing_field(na, p.facet[OFFSET][l]) : tl_facing_patch(na, nb, d, p.facet[OFFSET][l], ride);
        tl_lanes3_put(&f->n, l, to.n);
        tl_lanes3_put(&arms->push, l, to.push);
        tl_lanes3_put(&f->plane, l, to.plane);
        f->offset[l] = to.offset;
        if (field)
            tl_lanes9_put(&f->to, l, &ra);
        else
            put_places(f, arms, l, p.facet, &ra, &rb, d);
        tl_lanes3_put(&f->last, l, row_vec3(p.facet, LAST, l));
        put_turn(f, l, row_vec3(p.facet, LAST, l));
    }
}

TL_VECTORIZED static void put_patches(tl_frames *restrict f, const tl_frame_rows *restrict rows, tl_arms *restrict arms)
{
    put_all(f, rows, false, arms);
}

TL_VECTORIZED static void put_fields(tl_frames *restrict f, const tl_frame_rows *restrict rows, tl_arms *restrict arms)
{
    put_all(f, rows, true, arms);
}

/* ---------------------------------------------------------------- points ----------------- */

/* Tolerance: closure, over the distance of the point from the body's centroid, up to which walls just touch: roundings
 * of that distance and of the plane's. Else they would decide whether a joint that bears nothing yet is closed, and
 * what slip opens of it. Test: lua/test_touching_walls. */
#define TOUCHING 1e-14

/* Columns of points and lanes, row 0 of both the first of a SIMD group. */
typedef struct columns {
    const double *reference;
    double *p[3], *f_s[3];
    double *arm[3], *normal[3], *closure, *du_n, *du_s[3];
} columns;

static columns columns_at(const tl_points_table *p, size_t row, const tl_point_lanes *t, size_t lane)
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
            tl_columns_put(c->arm, i, x);
            tl_columns_put(c->normal, i, n);
            double offset = f->offset[l];
            double closure = offset - tl_v3_dot(tl_lanes3_get(&f->plane, l), x) - c->reference[i];
            c->closure[i] = fabs(closure) > TOUCHING * (fabs(offset) + fabs(x.x) + fabs(x.y) + fabs(x.z)) ? closure : 0;
            c->du_n[i] = du_n;
            tl_columns_put(c->du_s, i, tl_v3_madd(du, -du_n, n));
            tl_columns_put(c->f_s, i, tl_m3_mul(&turn, tl_columns_get(c->f_s, i)));
        }
}

/* The shear forces of the points of torsion, which lie along the normal: as they are, and how large. */
typedef struct torsions {
    tl_lanes3 force;
    double size[TL_LANES];
} torsions;

TL_VECTORIZED static void read_torsion(const columns *c, const tl_frames *restrict f, torsions *restrict torsion)
{
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_vec3 force = tl_columns_get(c->f_s, TL_FIELD_TORSION * TL_LANES + l);
        tl_lanes3_put(&torsion->force, l, force);
        torsion->size[l] = tl_v3_dot(force, tl_lanes3_get(&f->last, l));
    }
}

/* What a field contact keeps that its points of torsion are followed by: the radius, and by how much more than at those
 * of shear slip has opened the joint there. Both carry the same normal force. */
typedef struct field_rows {
    double radius[TL_LANES], opened[TL_LANES];
    tl_lanes3 half; /* half of the way of the centre in the step */
} field_rows;

/* The points of torsion of field contacts: what is a shear to the law is the turn about the normal, times the radius.
 * The law is given a normal that is perpendicular to it. While the contact's own does not turn, the force is not made
 * anew: it would be off by a rounding, and never rest. */
TL_VECTORIZED static void follow_torsion(const columns *c, const tl_frames *restrict f, const field_rows *restrict rows,
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
        tl_columns_put(c->du_s, shear, tl_v3_sub(tl_columns_get(c->du_s, shear), tl_v3_madd(less, -less_n, n)));
        tl_vec3 turn = tl_v3(0.5 * (motion.m[2][1] - motion.m[1][2]), 0.5 * (motion.m[0][2] - motion.m[2][0]),
                             0.5 * (motion.m[1][0] - motion.m[0][1]));
        tl_columns_put(c->normal, i, tl_facing_aside(n));
        c->closure[i] -= rows->opened[l];
        tl_columns_put(c->du_s, i, tl_v3_scale(rows->radius[l] * tl_v3_dot(turn, n), n));
        tl_vec3 last = tl_lanes3_get(&f->last, l);
        bool still = (last.x == n.x) & (last.y == n.y) & (last.z == n.z);
        tl_columns_put(c->f_s, i, still ? tl_lanes3_get(&torsion->force, l) : tl_v3_scale(torsion->size[l], n));
    }
}

/* ---------------------------------------------------------------- SIMD groups ------------ */

/* Turns the tangent states of a contact's points. */
static void turn_states(tl_model *m, uint32_t contact, tl_vec3 before, tl_vec3 now, tl_vec3 half, uint32_t tangents)
{
    tl_points_table *p = &m->detect->points;
    for (uint32_t k = 0; k + 2 < p->state_columns; k++) {
        double *v[3] = {p->state[k], p->state[k + 1], p->state[k + 2]};
        for (uint32_t j = 0; j < m->detect->contacts.point_count[contact] && tangents >> k & 1; j++) {
            size_t row = tl_point_row(&m->detect->contacts, contact, j);
            tl_columns_put(v, row, tl_turn_one(tl_columns_get(v, row), before, now, half));
        }
    }
}

/* The bodies and facets of the contacts of a SIMD group; lanes without one do as another. false when there are none. */
static bool look_up(const tl_model *m, const tl_simd_group *group, tl_frame_rows *rows)
{
    size_t some = 0;
    while (some < TL_LANES && group->contact[some] == TL_NO_ROW)
        some++;
    rows->dt = m->dt;
    for (size_t l = 0; l < TL_LANES && some < TL_LANES; l++) {
        uint32_t contact = group->contact[group->contact[l] == TL_NO_ROW ? some : l];
        const tl_sides s = tl_contact_sides(m, contact);
        rows->a[l] = &tl_side_rotation(m, s.a)->m[0][0];
        rows->b[l] = &tl_side_rotation(m, s.b)->m[0][0];
        rows->facet[l] = &m->detect->contacts.facet[contact].na.x;
    }
    return some < TL_LANES;
}

/* The same of what field contacts keep. */
static void look_up_fields(const tl_model *m, const tl_simd_group *group, field_rows *fields)
{
    memset(fields, 0, sizeof *fields);
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t contact = group->contact[l];
        uint32_t press = contact == TL_NO_ROW ? TL_NO_ROW : m->detect->contacts.press[contact];
        if (press == TL_NO_ROW)
            continue;
        const tl_press_row *row = &m->detect->press[press];
        fields->radius[l] = row->press.radius;
        fields->opened[l] = row->opening[TL_FIELD_TORSION] - row->opening[TL_FIELD_SHEAR];
        if (row->moved_at == m->cycles)
            tl_lanes3_put(&fields->half, l, tl_side_arm(m, tl_contact_sides(m, contact).a, row->half));
    }
}

void tl_simd_group_follow(tl_model *m, const tl_simd_group *group, bool field, const tl_point_lanes *t, size_t lane,
                          uint32_t tangents, tl_arms *arms)
{
    tl_contacts *contacts = &m->detect->contacts;
    columns c = columns_at(&m->detect->points, group->start, t, lane);
    tl_frame_rows rows;
    tl_frames f;
    field_rows fields;
    torsions torsion;
    if (look_up(m, group, &rows)) {
        (field ? put_fields : put_patches)(&f, &rows, arms);
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
            turn_states(m, contact, contacts->facet[contact].last, n, tl_lanes3_get(&f.half, l), tangents);
        contacts->facet[contact].last = n;
        contacts->new_points[contact] = TL_POINTS_STAY;
    }
}
