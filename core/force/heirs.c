/* heirs.c - the parts of a patch carry what the whole carried.
 *
 * The parts' points lie elsewhere than those of the whole. What is between these nobody knows: how far slip has opened them, each by another
 * way, what is left of a bond, which of them bear how much shear. So to the closures c and shear tractions t of all parts' points together,
 * as they lie between the points of the whole, a closure and a traction are added,
 *
 *     c + q1 + q2 x + q3 y,    t + (w1 - w3 y, w2 + w3 x)
 *
 * with which they press as the whole would have pressed in the next step, with the same force and moments, and have its shear and
 * torsion. What presses is the law's word, with the motion that it is going to be told of and the cells of patches that are
 * partly open. A point keeps no more shear than it bears: what it loses, others get; and if it slipped it would open the joint.
 *
 * What is carried rises with these six numbers, so Newton's steps find them.
 * Springs are to hold no more energy than those of the whole: of one force and torsion a uniform traction with a twist has the least,
 * so the parts then keep less of t. Where points between those of the whole bear so little that others have to hold more, the least there
 * is serves: what stands goes on standing. Where there are no such numbers, as where all slips, t stays what it is, and three are found. */
#include "force/heirs.h"

#include "base/columns.h"
#include "base/inside.h"
#include "contact/detection.h"
#include "contact/places.h"
#include "contact/transfer.h"
#include "force/partly_open.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What presses on B, and its moment about A's centroid. */
typedef struct tl_word {
    tl_vec3 force, moment;
    double most; /* sum of the magnitudes of the points' normal forces, N */
} tl_word;

/* What is missed falls with each number as fast as by 1 / unit, about, where all is plain. */
typedef struct tl_roots {
    int count;
    double unit;
    double
        hopeless; /* share of what is missed that is left after a step by fresh slopes, from which the search ends */
    /* What is missed with such numbers, up to TL_ROOTS of both; false: it is not known. */
    bool (*miss)(const void *user, const double x[], double missed[]);
    const void *user;
} tl_roots;

/* ---------------------------------------------------------------- what a law says next ----
 *
 * What the law of a patch says that it carries in the step to come.
 *
 * It is asked as in the step, its cells found where some of the patch is apart, but with copies of the points: what it changes is
 * forgotten. Bonds that break in the step break at their points only. */

/* The contact alone in its place of its SIMD group. */
static tl_simd_group alone(const tl_contacts *contacts, uint32_t c, size_t l)
{
    tl_simd_group group = {.start = contacts->point_start[c] - (uint32_t)l,
                           .slots = contacts->point_count[c]};
    for (size_t k = 0; k < TL_LANES; k++)
        group.contact[k] = k == l ? c : TL_NO_ROW;
    return group;
}

/* Takes points from the first lanes to those of their place in a SIMD group; what is beside them carries nothing. */
static void spread(const tl_point_lanes *t, size_t count, size_t l)
{
    double *const column[] = {t->normal[0], t->normal[1], t->normal[2], t->closure,  t->arm[0],
                              t->arm[1],    t->arm[2],    t->du_n,      t->du_s[0],  t->du_s[1],
                              t->du_s[2],   t->before[1], t->before[2], t->before[3]};
    for (size_t j = 0; j < sizeof column / sizeof *column; j++)
        for (size_t k = count; k-- > 0;) { /* none goes to a lane before its own */
            double value = column[j][k];
            for (size_t i = 0; i < TL_LANES; i++)
                column[j][k * TL_LANES + i] = j < 3 || i == l ? value : 0;
        }
}

/* Copies of what the law would change. */
static void copy_points(const tl_points_table *p, size_t first, size_t rows,
                        const tl_point_lanes *t)
{
    memset(t->stored, 0, rows * sizeof *t->stored);
    memset(t->dissipated, 0, rows * sizeof *t->dissipated);
    memcpy(t->before[0], p->f_n + first, rows * sizeof *t->before[0]);
    for (uint32_t s = 0; s < TL_STATE_COLUMNS; s++)
        if (s < p->state_columns)
            memcpy(t->before[4 + s], p->state[s] + first, rows * sizeof *t->before[4 + s]);
        else
            memset(t->before[4 + s], 0, rows * sizeof *t->before[4 + s]);
    memcpy(t->flags_before, p->flags + first, rows * sizeof *t->flags_before);
}

static bool ask_word(const tl_model *m, const tl_law *law, size_t first, size_t rows, bool partly,
                     const tl_point_lanes *t)
{
    const tl_points_table *p = &m->detect->points;
    tl_law_batch batch = {.size = sizeof batch,
                          .count = (uint32_t)rows,
                          .dt = m->dt,
                          .area = p->area + first,
                          .closure = t->closure,
                          .f_n0 = p->f_n0 ? p->f_n0 + first : t->zero,
                          .normal = {t->normal[0], t->normal[1], t->normal[2]},
                          .du_n = t->du_n,
                          .du_s = {t->du_s[0], t->du_s[1], t->du_s[2]},
                          .f_n = t->before[0],
                          .f_s = {t->before[1], t->before[2], t->before[3]},
                          .state = &t->before[4],
                          .flags = t->flags_before,
                          .stored = t->stored,
                          .dissipated = t->dissipated,
                          .closure_edge = law->pulls != TL_PULL_NONE ? t->edge : t->closure,
                          .closure_apart = partly ? t->apart : t->zero};
    tl_report report = {.size = sizeof report};
    const tl_law_ops *ops = law->kind->ops;
    tl_enter(law->kind, "update");
    tl_status status = ops->update(law->self, &batch, &report);
    tl_leave();
    return status == TL_OK;
}

/* Exchanges the normal forces of the points for those in the lanes. */
static void exchange(tl_detect *d, uint32_t c, size_t l, const tl_point_lanes *t)
{
    for (size_t k = 0; k < d->contacts.point_count[c]; k++) {
        double *of = &d->points.f_n[tl_point_row(&d->contacts, c, k)], was = *of;
        *of = t->before[0][k * TL_LANES + l];
        t->before[0][k * TL_LANES + l] = was;
    }
}

/* Adds what cells have beside their points, by whose forces they go. */
static void add_cells(tl_model *m, const tl_simd_group *group, size_t l, const tl_point_lanes *t,
                      tl_word *to)
{
    const tl_vec3 turn[TL_LANES] = {{0, 0, 0}}; /* that is for heat alone */
    const tl_law *law = &m->joint_laws[m->detect->contacts.law[group->contact[l]]];
    tl_part_sums all[TL_LANES], *more = &all[l];
    exchange(m->detect, group->contact[l], l, t);
    tl_simd_group_part_sum(m, law, group, t, 0, (tl_part_lanes){1u << l, 0}, turn, all);
    exchange(m->detect, group->contact[l], l, t);
    tl_vec3 force = tl_v3_scale(more->force, tl_columns_get(t->normal, l));
    to->force = tl_v3_add(to->force, force);
    to->moment = tl_v3_add(to->moment, more->moment);
    to->moment = tl_v3_add(to->moment, tl_v3_cross(more->arm, force));
}

/* Asks the law of a patch. In the first lanes are arms, normals, closures and motions of the points, and in `before` from 1 on their shear
 * forces; there those after are given. false: the law failed, or what it says is no number. */
static bool patch_word(tl_model *m, uint32_t c, const tl_point_lanes *t, tl_word *out)
{
    const tl_detect *d = m->detect;
    const tl_law *law = &m->joint_laws[d->contacts.law[c]];
    size_t count = d->contacts.point_count[c], l = d->contacts.point_start[c] % TL_LANES;
    const tl_simd_group group = alone(&d->contacts, c, l);
    *out = (tl_word){.most = 0};
    spread(t, count, l);
    if (law->pulls != TL_PULL_NONE)
        tl_simd_group_edges(m, &group, t, 0);
    const bool partly = tl_simd_group_part(m, law, &group, t, 0).parts != 0;
    copy_points(&d->points, group.start, count * TL_LANES, t);
    if (!ask_word(m, law, group.start, count * TL_LANES, partly, t))
        return false;
    for (size_t k = 0; k < count; k++) {
        size_t i = k * TL_LANES + l;
        double normal = t->before[0][i];
        tl_vec3 force = tl_v3_scale(normal, tl_columns_get(t->normal, i));
        out->force = tl_v3_add(out->force, force);
        out->moment = tl_v3_add(out->moment, tl_v3_cross(tl_columns_get(t->arm, i), force));
        out->most += fabs(normal);
    }
    if (partly)
        add_cells(m, &group, l, t, out);
    for (size_t k = 0; k < count; k++)
        tl_columns_put(&t->before[1], k, tl_columns_get(&t->before[1], k * TL_LANES + l));
    return isfinite(out->most) && tl_v3_finite(out->force) && tl_v3_finite(out->moment);
}

/* ---------------------------------------------------------------- roots -------------------
 *
 * Numbers at which nothing is missing.
 *
 * Newton's steps, with slopes that are mended by what steps bring (Broyden 1965), or found by differences where that is little. Each step is
 * halved until less is missed. */

/* Tolerance: steps that are made at the most, and halvings of each. Test: lua/test_curved_slides. */
#define STEPS 60
#define HALVINGS 10
/* Tolerance: step of differences, over the unit. */
#define SMALL 1e-6
/* Tolerance: share of what is missed that is left after a good step. After another slopes are found anew. */
#define GOOD 0.3
/* Tolerance: what is added to the slopes: the numbers may not tell all. */
#define FAINT 1e-9

typedef struct numbers {
    double v[TL_ROOTS];
} numbers;

/* How fast what is missed falls with each number: [of what][with which]. */
typedef struct slopes {
    double of[TL_ROOTS][TL_ROOTS];
} slopes;

/* The root of the sum of squares. */
static double roots_size(const double x[], int count)
{
    double sum = 0;
    for (int k = 0; k < count; k++)
        sum += x[k] * x[k];
    return sqrt(sum);
}

static double size_of(const numbers *x, int count)
{
    return roots_size(x->v, count);
}

/* Solves slopes x = right, `count` equations, by elimination, the largest of each column first. false: they cannot be solved. */
static bool solve(slopes by, numbers right, int count, numbers *x)
{
    *x = (numbers){{0}};
    for (int j = 0; j < count; j++) {
        int best = j;
        for (int i = j + 1; i < count; i++)
            best = fabs(by.of[i][j]) > fabs(by.of[best][j]) ? i : best;
        for (int k = j; k < count; k++) {
            double was = by.of[j][k];
            by.of[j][k] = by.of[best][k];
            by.of[best][k] = was;
        }
        double was = right.v[j];
        right.v[j] = right.v[best];
        right.v[best] = was;
        for (int i = j + 1; i < count; i++) {
            double share = by.of[i][j] / by.of[j][j];
            for (int k = j; k < count; k++)
                by.of[i][k] -= share * by.of[j][k];
            right.v[i] -= share * right.v[j];
        }
    }
    for (int j = count - 1; j >= 0; j--) {
        double sum = right.v[j];
        for (int k = j + 1; k < count; k++)
            sum -= by.of[j][k] * x->v[k];
        x->v[j] = sum / by.of[j][j];
    }
    return isfinite(size_of(x, count));
}

static slopes plain_slopes(const tl_roots *of)
{
    slopes out = {{{0}}};
    for (int k = 0; k < TL_ROOTS; k++)
        out.of[k][k] = 1 / of->unit;
    return out;
}

/* Slopes at x, where `missed` is, by differences. false: it is not known. */
static bool find_slopes(const tl_roots *of, const numbers *x, const numbers *missed, slopes *out)
{
    double by = SMALL * of->unit;
    for (int j = 0; j < of->count; j++) {
        numbers there = *x, then;
        there.v[j] += by;
        if (!of->miss(of->user, there.v, then.v))
            return false;
        for (int i = 0; i < of->count; i++)
            out->of[i][j] = (missed->v[i] - then.v[i]) / by + (i == j ? FAINT / of->unit : 0);
    }
    return true;
}

/* Goes the step or a share of it, so that less is missed; halves it so often at the most. Returns the share, 0: none. */
static double go(const tl_roots *of, const numbers *step, int halvings, numbers *x, numbers *missed)
{
    double by = 1;
    for (int n = 0; n <= halvings; n++, by *= 0.5) {
        numbers there = *x, then;
        for (int k = 0; k < of->count; k++)
            there.v[k] += by * step->v[k];
        if (!of->miss(of->user, there.v, then.v))
            return 0;
        if (size_of(&then, of->count) < size_of(missed, of->count)) {
            *x = there;
            *missed = then;
            return by;
        }
    }
    return 0;
}

/* Broyden's rule: brings slopes in line with what a share of their step has brought. */
static void mend_slopes(slopes *by, int count, const numbers *step, double share,
                        const numbers *before, const numbers *after)
{
    double square = 0;
    for (int k = 0; k < count; k++)
        square += step->v[k] * step->v[k];
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count && square > 0; j++) {
            double off = (1 - share) * before->v[i] - after->v[i];
            by->of[i][j] += off / share * step->v[j] / square;
        }
}

/* Goes from x to where the least is missed that is found, and tells how much that is. false: it is not known somewhere. */
static bool roots_find(const tl_roots *of, double x[TL_ROOTS], double *left)
{
    const int count = of->count;
    numbers here, missed, step;
    slopes by = plain_slopes(of);
    bool fresh = false;
    for (int k = 0; k < TL_ROOTS; k++)
        here.v[k] = x[k];
    if (!of->miss(of->user, here.v, missed.v))
        return false;
    for (int k = 0; k < STEPS && size_of(&missed, count) > TL_ROOTS_EXACT; k++) {
        numbers before = missed;
        double share = 0;
        if (solve(by, missed, count, &step))
            share = go(of, &step, fresh ? HALVINGS : 0, &here, &missed);
        if (share > 0)
            mend_slopes(&by, count, &step, share, &before, &missed);
        if (fresh && size_of(&missed, count) >= of->hopeless * size_of(&before, count))
            break;
        fresh = size_of(&missed, count) > GOOD * size_of(&before, count);
        if (fresh && !find_slopes(of, &here, &missed, &by))
            break;
    }
    for (int k = 0; k < TL_ROOTS; k++)
        x[k] = here.v[k];
    *left = size_of(&missed, count);
    return true;
}

/* ---------------------------------------------------------------- parts ------------------- */

/* Tolerance: error over the forces with which the numbers are found, and that which a good step leaves no hope
 * with. */
#define FOUND 1e-8
#define HOPELESS 0.9
/* Tolerance: passes in which a law is asked until no point has more shear than it bears, and the share by which one
 * may have more. */
#define PASSES 12
#define TOO_MUCH 1e-9
/* Tolerance: slope of what a point bears over what it has, up to which it tells where both are the same. */
#define STEEP 0.9
/* Tolerance: share of t by which parts keep less each time. Their springs may hold more energy by the second share,
 * and by the third if there is no way with less. Test: lua/test_cut_keeps. */
#define LESS 0.25
#define MORE_ENERGY 5e-4
#define MOST_ENERGY 0.5
/* Tolerance: areas that are the same, over each other: parts that lack some of the whole go by what is between its
 * points alone. */
#define SAME_AREA 1e-3

/* The point of a part: its shear force and how much closure it gets, and the magnitudes of the shear that the law was asked with the time
 * before and of what it answered; 0: none. */
typedef struct given {
    tl_vec3 shear;
    double closure, asked, borne;
} given;

/* What is looked for, N, or what the parts lack, over the forces of the whole. */
typedef struct six {
    double v[TL_CARRIED];
} six;

/* The patches that have taken over from one estate, and the points of all of them. */
typedef struct heirs {
    tl_model *m;
    const tl_estate *estate;
    const uint32_t *contact;
    size_t count;
    given *points;
    double keep; /* share of their shear that they keep beside what they are given */
    int sought; /* numbers that are looked for: TL_CARRIED, or those of closure, and they keep all shear, whether they bear it or not */
    six from;   /* where a search begins, and, after it, where it has come to */
} heirs;

/* The root of 12 over the area of a patch: of a square, x and y times that are 1 in the mean of their squares. */
static double per_length(const tl_carried *p)
{
    return sqrt(12 / p->area);
}

/* 1, x, y of a place. */
static tl_vec3 basis(const tl_carried *p, tl_vec3 place)
{
    tl_vec3 arm = tl_v3_scale(per_length(p), tl_v3_sub(place, p->centre));
    return tl_v3(1, tl_v3_dot(arm, p->along[0]), tl_v3_dot(arm, p->along[1]));
}

/* Adds `sign` times a force with its moment about a place. */
static void add_force(const tl_carried *p, tl_vec3 force, tl_vec3 moment, tl_vec3 place,
                      double sign, double sum[])
{
    double over = sign * per_length(p);
    moment = tl_v3_add(moment, tl_v3_cross(tl_v3_sub(place, p->centre), force));
    sum[0] += sign * tl_v3_dot(force, p->normal);
    sum[1] -= over * tl_v3_dot(moment, p->along[1]);
    sum[2] += over * tl_v3_dot(moment, p->along[0]);
    sum[3] += sign * tl_v3_dot(force, p->along[0]);
    sum[4] += sign * tl_v3_dot(force, p->along[1]);
    sum[5] += over * tl_v3_dot(moment, p->normal);
}

/* A point's motion in the last step as the law is told it, into lane k. */
static void put_motion(const tl_point_lanes *lanes, size_t k, tl_vec3 du)
{
    tl_vec3 n = tl_columns_get(lanes->normal, k);
    lanes->du_n[k] = tl_v3_dot(du, n);
    tl_columns_put(lanes->du_s, k, tl_v3_madd(du, -lanes->du_n[k], n));
}

/* ---------------------------------------------------------------- the whole -------------- */

/* Where a patch is. false: it carried nothing in the last step. */
static bool find_measures(const tl_old_point *points, const tl_estate *estate, tl_carried *p)
{
    double carried = 0;
    *p = (tl_carried){.normal = estate->face[0]};
    for (size_t k = 0; k < estate->count; k++) {
        p->area += points[k].area;
        p->centre = tl_v3_madd(p->centre, points[k].area, points[k].arm);
        carried += points[k].area * (fabs(points[k].f_n) + tl_v3_norm(points[k].shear));
    }
    p->centre = tl_v3_scale(p->area > 0 ? 1 / p->area : 0, p->centre);
    p->along[0] = tl_v3_perpendicular(p->normal);
    p->along[1] = tl_v3_cross(p->normal, p->along[0]);
    return p->area > 0 && carried > 0;
}

/* How far a body has carried a place in the last step. */
static tl_vec3 carried_by(const tl_model *m, uint32_t body, tl_vec3 place)
{
    const tl_pose *pose = &m->bodies.pose[body];
    tl_vec3 arm = tl_v3_sub(place, tl_body_place(&m->bodies, body));
    return tl_v3_scale(m->dt, tl_v3_add(pose->v_moved, tl_v3_cross(pose->w_moved, arm)));
}

void tl_estate_weigh(tl_model *m, uint32_t c, tl_estate *estate, const tl_testator *a,
                     const tl_testator *b)
{
    const tl_old_point *points = &m->detect->left_points[estate->first];
    const tl_point_lanes *lanes = &m->detect->lanes[0];
    double ride = m->detect->contacts.facet[c].ride;
    tl_vec3 n = tl_v3_unit(
        tl_v3_sub(tl_v3_scale(ride, estate->face[0]), tl_v3_scale(1 - ride, estate->face[1])));
    tl_carried *p = &estate->carried;
    if (!find_measures(points, estate, p) || estate->field || estate->law == TL_NO_ROW)
        return;
    for (size_t k = 0; k < estate->count; k++) {
        tl_vec3 place = points[k].arm;
        tl_columns_put(lanes->arm, k, tl_v3_sub(place, a->place));
        tl_columns_put(lanes->normal, k, n);
        tl_columns_put(&lanes->before[1], k, tl_v3_scale(points[k].area, points[k].shear));
        lanes->closure[k] = points[k].closure;
        put_motion(lanes, k,
                   tl_v3_sub(carried_by(m, b->body, place), carried_by(m, a->body, place)));
    }
    tl_word word;
    if (!patch_word(m, c, lanes, &word))
        return;
    add_force(p, word.force, word.moment, a->place, 1, p->sum);
    for (size_t k = 0; k < estate->count; k++) {
        tl_vec3 shear = tl_v3_scale(points[k].area, points[k].shear);
        add_force(p, shear, tl_v3(0, 0, 0), points[k].arm, 1, p->sum);
        p->most += tl_v3_norm(shear);
        p->energy += points[k].area * tl_v3_norm2(points[k].shear);
    }
    p->most += word.most;
}

/* ---------------------------------------------------------------- the parts -------------- */

/* Puts the places of a part's points into the first lanes; where their arms begin. */
static tl_vec3 find_places(const tl_model *m, uint32_t c, const tl_point_lanes *lanes)
{
    tl_contact_places(m, c, lanes);
    return tl_body_place(&m->bodies, m->blocks.body[m->detect->contacts.a[c]]);
}

static double sign_of(const heirs *of, uint32_t c)
{
    return tl_estate_same_way(of->m, of->estate, c) ? 1 : -1;
}

/* Gives the points of a part closure and shear beside what they have taken over. */
static void begin_points(const heirs *of, const double more[], uint32_t c, given *points)
{
    const tl_detect *d = of->m->detect;
    const tl_point_lanes *lanes = &d->lanes[0];
    const tl_carried *p = &of->estate->carried;
    const double *q = more, *w = more + TL_CARRIED_PRESS;
    double kn = of->m->joint_laws[d->contacts.law[c]].kn;
    tl_vec3 from = find_places(of->m, c, lanes);
    for (size_t k = 0; k < d->contacts.point_count[c]; k++) {
        size_t row = tl_point_row(&d->contacts, c, k);
        tl_vec3 at = basis(p, tl_v3_add(from, tl_columns_get(lanes->arm, k)));
        tl_vec3 n = tl_columns_get(lanes->normal, k);
        tl_vec3 t = tl_v3_scale(w[0] - w[2] * at.z, p->along[0]);
        t = tl_v3_madd(t, w[1] + w[2] * at.y, p->along[1]);
        t = tl_v3_madd(t, -tl_v3_dot(t, n), n);
        double share = sign_of(of, c) * d->points.area[row] / p->area;
        points[k] = (given){
            .shear =
                tl_v3_madd(tl_v3_scale(of->keep, tl_columns_get(d->points.f_s, row)), share, t),
            .closure = kn > 0 ? (q[0] + q[1] * at.y + q[2] * at.z) / (kn * p->area) : 0,
        };
    }
}

/* Asks the law of a part, with its motion, or as if it stood; false: it failed. */
static bool ask(const heirs *of, uint32_t c, bool moves, const given *points, tl_word *word)
{
    const tl_point_lanes *lanes = &of->m->detect->lanes[0];
    const tl_contact_motion moved = tl_contact_moved(of->m, c);
    find_places(of->m, c, lanes);
    for (size_t k = 0; k < of->m->detect->contacts.point_count[c]; k++) {
        tl_vec3 arm = tl_columns_get(lanes->arm, k);
        tl_vec3 du = tl_v3_add(moved.way, tl_v3_cross(moved.turn, arm));
        lanes->closure[k] += points[k].closure;
        tl_columns_put(&lanes->before[1], k, points[k].shear);
        put_motion(lanes, k, moves ? du : tl_v3(0, 0, 0));
    }
    return patch_word(of->m, c, lanes, word);
}

/* Gives a point only so much shear as it bears: where its answer, as a line in what it has, is just that. true: it had
 * more. */
static bool give_less(given *p, double borne)
{
    double asked = tl_v3_norm(p->shear), to = borne;
    if (!(borne < (1 - TOO_MUCH) * asked))
        return false;
    if (p->asked > asked) {
        double slope = (p->borne - borne) / (p->asked - asked);
        double met = (borne - slope * asked) / (1 - slope);
        to = slope >= 0 && slope < STEEP && met > 0 ? met : borne;
    }
    p->asked = asked;
    p->borne = borne;
    p->shear = tl_v3_scale(to / asked, p->shear);
    return true;
}

/* Takes from the points of a part the shear that they do not bear where nothing moves. false: the law failed. */
static bool give_borne(const heirs *of, uint32_t c, given *points)
{
    const tl_point_lanes *lanes = &of->m->detect->lanes[0];
    bool again = true;
    tl_word word;
    for (int pass = 0; again && pass < PASSES; pass++) {
        if (!ask(of, c, false, points, &word))
            return false;
        again = false;
        for (size_t k = 0; k < of->m->detect->contacts.point_count[c]; k++)
            again =
                give_less(&points[k], tl_v3_norm(tl_columns_get(&lanes->before[1], k))) || again;
    }
    return true;
}

/* Adds what a part is going to press with, and its shear. false: the law failed. */
static bool weigh_part(const heirs *of, const double more[], uint32_t c, given *points,
                       double sum[])
{
    const tl_point_lanes *lanes = &of->m->detect->lanes[0];
    const tl_carried *p = &of->estate->carried;
    double sign = sign_of(of, c);
    tl_word word;
    begin_points(of, more, c, points);
    if ((of->sought == TL_CARRIED && !give_borne(of, c, points)) ||
        !ask(of, c, true, points, &word))
        return false;
    tl_vec3 from = find_places(of->m, c, lanes);
    add_force(p, word.force, word.moment, from, sign, sum);
    for (size_t k = 0; k < of->m->detect->contacts.point_count[c]; k++) {
        tl_vec3 place = tl_v3_add(from, tl_columns_get(lanes->arm, k));
        add_force(p, points[k].shear, tl_v3(0, 0, 0), place, sign, sum);
    }
    return true;
}

/* What the parts lack of what the whole carried. false: a law failed. */
static bool weigh(const heirs *of, const double more[], six *lacks)
{
    const tl_carried *p = &of->estate->carried;
    double sum[TL_CARRIED] = {0};
    given *points = of->points;
    for (size_t i = 0; i < of->count; i++) {
        if (!weigh_part(of, more, of->contact[i], points, sum))
            return false;
        points += of->m->detect->contacts.point_count[of->contact[i]];
    }
    for (int k = 0; k < TL_CARRIED; k++)
        lacks->v[k] = (p->sum[k] - sum[k]) / p->most;
    return true;
}

/* ---------------------------------------------------------------- search ----------------- */

static bool miss(const void *user, const double more[], double missed[])
{
    const heirs *of = user;
    six lacks;
    bool known = weigh(of, more, &lacks);
    memcpy(missed, lacks.v, sizeof lacks.v);
    return known;
}

/* Looks for the numbers with which the parts lack the least, and gives the points what goes with them. *found: they lack nothing. false: a
 * law failed. */
static bool search(heirs *of, bool *found)
{
    const tl_roots roots = {
        .count = of->sought,
        .unit = of->estate->carried.most,
        .hopeless = of->sought == TL_CARRIED ? HOPELESS : 1, /* then three are looked for */
        .miss = miss,
        .user = of};
    double left;
    if (!roots_find(&roots, of->from.v, &left))
        return false;
    six lacks;
    *found = left <= FOUND;
    return weigh(of, of->from.v, &lacks);
}

/* ---------------------------------------------------------------- giving ----------------- */

/* Puts what has been found into the points. */
static void give(const heirs *of)
{
    const tl_detect *d = of->m->detect;
    const given *point = of->points;
    for (size_t i = 0; i < of->count; i++)
        for (size_t k = 0; k < d->contacts.point_count[of->contact[i]]; k++, point++) {
            size_t row = tl_point_row(&d->contacts, of->contact[i], k);
            tl_columns_put(d->points.f_s, row, point->shear);
            d->points.reference[row] -= point->closure;
        }
}

/* The parts' area, and the energy of the shear that has been found, times 2 ks. */
static double sum_area(const heirs *of, double *energy)
{
    const tl_detect *d = of->m->detect;
    const given *point = of->points;
    double sum = 0;
    *energy = 0;
    for (size_t i = 0; i < of->count; i++)
        for (size_t k = 0; k < d->contacts.point_count[of->contact[i]]; k++, point++) {
            double area = d->points.area[tl_point_row(&d->contacts, of->contact[i], k)];
            sum += area;
            *energy += area > 0 ? tl_v3_norm2(point->shear) / area : 0;
        }
    return sum;
}

/* Looks for all six numbers, from some, with ever less of t, and gives the points what goes with them, which may have so much more
 * energy. *done: it has. false: a law failed. */
static bool carry_six(heirs *of, six from, double more, bool *done)
{
    const tl_carried *whole = &of->estate->carried;
    double least = (1 + more) * whole->energy, best = -1, energy;
    bool found = true;
    *done = false;
    of->sought = TL_CARRIED;
    for (of->keep = 1; found && of->keep >= 0; of->keep -= LESS) {
        of->from = from;
        if (!search(of, &found))
            return false;
        sum_area(of, &energy);
        *done = found && energy <= (1 + MORE_ENERGY) * whole->energy;
        if (*done)
            break;
        if (found && energy < least) {
            least = energy;
            best = of->keep;
        }
    }
    if (!*done && best >= 0) {
        of->keep = best;
        of->from = from;
        *done = search(of, &found);
    }
    if (*done)
        give(of);
    return true;
}

/* The three of closure alone, with all of t. false: a law failed. */
static bool carry_press(heirs *of, six from)
{
    bool found;
    of->keep = 1;
    of->sought = TL_CARRIED_PRESS;
    of->from = from;
    return search(of, &found);
}

/* From none, or from what presses as the whole: a way to all six may lead over that. */
static void carry(heirs *of)
{
    const tl_carried *whole = &of->estate->carried;
    const six none = {{0}};
    six lacks;
    double energy;
    bool done;
    if (!weigh(of, none.v, &lacks) || !(roots_size(lacks.v, TL_CARRIED) > TL_ROOTS_EXACT) ||
        !(fabs(sum_area(of, &energy) - whole->area) < SAME_AREA * whole->area))
        return;
    if (!carry_six(of, none, MOST_ENERGY, &done) || done || !carry_press(of, none))
        return;
    const six press = of->from;
    if (!carry_six(of, press, MORE_ENERGY, &done) || done)
        return;
    if (carry_press(of, press))
        give(of);
}

/* ---------------------------------------------------------------- all -------------------- */

/* A contact that has taken over from an estate. */
typedef struct heir {
    const tl_estate *estate;
    uint32_t contact;
} heir;

/* By estate; contacts ascend in each. */
static int compare(const void *x, const void *y)
{
    const heir *p = x, *q = y;
    if (p->estate != q->estate)
        return (p->estate > q->estate) - (p->estate < q->estate);
    return (p->contact > q->contact) - (p->contact < q->contact);
}

/* Lists them, unless `out` is NULL; returns how many there are. *points: how many points they have. */
static size_t list(const tl_model *m, heir *out, size_t *points)
{
    const tl_contacts *contacts = &m->detect->contacts;
    size_t count = 0;
    *points = 0;
    for (uint32_t c = 0; c < contacts->table.rows; c++) {
        const tl_estate *estate = tl_estate_taken(m, c);
        if (!estate || !(estate->carried.most > 0))
            continue;
        if (out)
            out[count] = (heir){estate, c};
        count++;
        *points += contacts->point_count[c];
    }
    return count;
}

/* Forgets what patches carried whose parts are not all patches of its law: what they take over of it is not known yet. */
static void forget_mixed(tl_model *m)
{
    tl_detect *d = m->detect;
    for (uint32_t c = 0; c < d->contacts.table.rows; c++) {
        const tl_estate *estate = tl_estate_of(m, d->contacts.a[c], d->contacts.b[c]);
        bool field = tl_facet_is_field(&d->contacts.facet[c]);
        if (estate && d->contacts.point_count[c] > 0 &&
            (field || !tl_estate_is_of_law(m, estate, c)))
            d->estates[estate - d->estates].carried.most = 0;
    }
}

/* Those of each estate, in their order. */
static void carry_all(tl_model *m, const heir *all, size_t count, uint32_t *contact, given *points)
{
    for (size_t i = 0; i < count; i++)
        contact[i] = all[i].contact;
    for (size_t first = 0, end = 0; first < count; first = end) {
        const tl_estate *estate = all[first].estate;
        while (end < count && all[end].estate == estate)
            end++;
        carry(&(heirs){.m = m,
                       .estate = estate,
                       .contact = contact + first,
                       .count = end - first,
                       .points = points,
                       .keep = 1,
                       .sought = TL_CARRIED});
    }
}

bool tl_heirs_carry(tl_model *m)
{
    if (m->detect->estate_count == 0)
        return true;
    forget_mixed(m);
    size_t most = 0, count = list(m, NULL, &most);
    heir *all = malloc((count + 1) * sizeof *all);
    uint32_t *contact = malloc((count + 1) * sizeof *contact);
    given *points = malloc((most + 1) * sizeof *points);
    bool there = all && contact && points;
    if (there) {
        list(m, all, &most);
        if (count > 1)
            qsort(all, count, sizeof *all, compare);
        carry_all(m, all, count, contact, points);
    }
    free(all);
    free(contact);
    free(points);
    return there;
}
