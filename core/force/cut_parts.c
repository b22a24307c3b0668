/* cut_parts.c - the parts of a patch carry what the whole carried.
 *
 * The parts' points lie elsewhere than those of the whole. Nobody knows what is between these: how far slip has
 * opened them, each by another way, what is left of a bond, which of them bear how much shear. So a closure and
 * a traction are added to the closures c and shear tractions t of all parts' points,
 *
 *     c + q1 + q2 x + q3 y,    t + (w1 - w3 y, w2 + w3 x)
 *
 * With these they press as the whole would have pressed in the next step, with the same force and moments. They
 * have its shear and torsion, too. The law says what presses, with the motion of the step to come and the cells of
 * patches that are partly open. A point keeps no more shear than it bears: what it loses, others get; and if it
 * slipped it would open the joint.
 *
 * What the parts carry rises with these six numbers, so Newton's steps find them. Slopes are mended by what
 * steps bring (Broyden 1965), or found by differences where that is little. Each step is halved until less is
 * lacking. Springs are to hold no more energy than those of the whole. Of one force and torsion a uniform
 * traction with a twist has the least, so the parts then keep less of t. Where points between those of the
 * whole bear little, others have to hold more. There the least there is serves: what stands goes on standing.
 * Where there are no such numbers, as where all slips, t stays what it is, and three are found. */
#include "force/cut_parts.h"

#include "base/columns.h"
#include "contact/places.h"
#include "contact/shear.h"
#include "contact/sides.h"
#include "contact/store.h"
#include "force/joint_laws.h"
#include "force/partly_open.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What presses on B, and its moment about A's centroid. */
typedef struct pressing {
    tl_vec3 force, moment;
    double most; /* sum of the magnitudes of the points' normal forces, N */
} pressing;

/* ---------------------------------------------------------------- what a law says next ----
 *
 * What the law of a patch says that it carries in the step to come.
 *
 * It is asked as in the step, its cells found where some of the patch is apart. It is given copies of the
 * points: what it changes is forgotten. Bonds that break in the step break at their points only. */

/* The contact alone in its place of its SIMD group. */
static tl_simd_group alone(const tl_contacts *contacts, uint32_t c, size_t l)
{
    tl_simd_group group = {.start = contacts->point_start[c] - (uint32_t)l, .slots = contacts->point_count[c]};
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
static void copy_points(const tl_points_table *p, size_t first, size_t rows, const tl_point_lanes *t)
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
static void add_cells(tl_model *m, const tl_simd_group *group, size_t l, const tl_point_lanes *t, pressing *to)
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

/* Asks the law of a patch. Arms, normals, closures and motions of the points are in the first lanes, and in
 * `before` from 1 on their shear forces before and after. false: the law failed, or what it says is no number. */
static bool ask_patch(tl_model *m, uint32_t c, const tl_point_lanes *t, pressing *out)
{
    const tl_detect *d = m->detect;
    const tl_law *law = &m->joint_laws[d->contacts.law[c]];
    size_t count = d->contacts.point_count[c], l = d->contacts.point_start[c] % TL_LANES;
    const tl_simd_group group = alone(&d->contacts, c, l);
    *out = (pressing){.most = 0};
    spread(t, count, l);
    if (law->pulls != TL_PULL_NONE)
        tl_simd_group_edges(m, &group, t, 0);
    const bool partly = tl_simd_group_part(m, law, &group, t, 0).parts != 0;
    copy_points(&d->points, group.start, count * TL_LANES, t);
    tl_law_batch batch = tl_lanes_batch(m, t, count * TL_LANES);
    batch.area = d->points.area + group.start;
    batch.f_n0 = d->points.f_n0 ? d->points.f_n0 + group.start : t->zero;
    batch.closure_edge = law->pulls != TL_PULL_NONE ? t->edge : t->closure;
    batch.closure_apart = partly ? t->apart : t->zero;
    tl_report report;
    if (tl_law_update(law, &batch, &report) != TL_OK)
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

/* ---------------------------------------------------------------- sums ------------------- */

/* Numbers that are looked for, N, or what the parts lack, over the forces of the whole. */
typedef struct six {
    double v[TL_NEXT_SUMS];
} six;

/* The root of 12 over the area of a patch: of a square, x and y times that are 1 in the mean of their squares. */
static double per_length(const tl_cut_contact *cut)
{
    return sqrt(12 / cut->whole.area);
}

/* 1, x, y of a place. */
static tl_vec3 basis(const tl_cut_contact *cut, tl_vec3 place)
{
    tl_vec3 arm = tl_v3_scale(per_length(cut), tl_v3_sub(place, cut->whole.centre));
    return tl_v3(1, tl_v3_dot(arm, cut->next.along[0]), tl_v3_dot(arm, cut->next.along[1]));
}

/* Adds `sign` times a force with its moment about a place. */
static void add_force(const tl_cut_contact *cut, tl_vec3 force, tl_vec3 moment, tl_vec3 place, double sign,
                      double sum[])
{
    double over = sign * per_length(cut);
    moment = tl_v3_add(moment, tl_v3_cross(tl_v3_sub(place, cut->whole.centre), force));
    sum[0] += sign * tl_v3_dot(force, cut->face[0]);
    sum[1] -= over * tl_v3_dot(moment, cut->next.along[1]);
    sum[2] += over * tl_v3_dot(moment, cut->next.along[0]);
    sum[3] += sign * tl_v3_dot(force, cut->next.along[0]);
    sum[4] += sign * tl_v3_dot(force, cut->next.along[1]);
    sum[5] += over * tl_v3_dot(moment, cut->face[0]);
}

/* A point's motion in the last step as the law is told it, into lane k. */
static void put_motion(const tl_point_lanes *lanes, size_t k, tl_vec3 du)
{
    tl_vec3 n = tl_columns_get(lanes->normal, k);
    lanes->du_n[k] = tl_v3_dot(du, n);
    tl_columns_put(lanes->du_s, k, tl_v3_madd(du, -lanes->du_n[k], n));
}

/* How far a side has carried a place in the last step. */
static tl_vec3 carried_by(const tl_model *m, uint32_t side, tl_vec3 place)
{
    const tl_pose *pose = tl_side_pose(m, side);
    tl_vec3 arm = tl_v3_sub(place, tl_side_place(m, side));
    return tl_v3_scale(m->dt, tl_v3_add(pose->v_moved, tl_v3_cross(pose->w_moved, arm)));
}

void tl_cut_contact_foresee(tl_model *m, uint32_t c, tl_cut_contact *cut, const tl_cut_side *a, const tl_cut_side *b)
{
    const tl_old_point *points = &m->detect->cut_points[cut->first];
    const tl_point_lanes *lanes = &m->detect->lanes[0];
    double ride = m->detect->contacts.facet[c].ride, most = 0;
    tl_vec3 n = tl_v3_unit(tl_v3_sub(tl_v3_scale(ride, cut->face[0]), tl_v3_scale(1 - ride, cut->face[1])));
    cut->next.along[0] = tl_v3_perpendicular(cut->face[0]);
    cut->next.along[1] = tl_v3_cross(cut->face[0], cut->next.along[0]);
    for (size_t k = 0; k < cut->count; k++)
        most += points[k].area * (fabs(points[k].f_n) + tl_v3_norm(points[k].shear));
    if (!(cut->whole.area > 0 && most > 0) || cut->field || cut->law == TL_NO_ROW)
        return;
    for (size_t k = 0; k < cut->count; k++) {
        tl_vec3 place = points[k].arm;
        tl_columns_put(lanes->arm, k, tl_v3_sub(place, a->place));
        tl_columns_put(lanes->normal, k, n);
        tl_columns_put(&lanes->before[1], k, tl_v3_scale(points[k].area, points[k].shear));
        lanes->closure[k] = points[k].closure;
        put_motion(lanes, k, tl_v3_sub(carried_by(m, b->side, place), carried_by(m, a->side, place)));
    }
    pressing press;
    if (!ask_patch(m, c, lanes, &press))
        return;
    add_force(cut, press.force, press.moment, a->place, 1, cut->next.sum);
    for (size_t k = 0; k < cut->count; k++) {
        tl_vec3 shear = tl_v3_scale(points[k].area, points[k].shear);
        add_force(cut, shear, tl_v3(0, 0, 0), points[k].arm, 1, cut->next.sum);
        cut->next.most += tl_v3_norm(shear);
    }
    cut->next.most += press.most;
}

/* ---------------------------------------------------------------- parts ------------------ */

/* Tolerance: times that a law is asked at the most until no point has more shear than it bears; by which share it may
 * have more. */
#define PASSES 12
#define TOO_MUCH 1e-9
/* Tolerance: slope of what a point bears over what it has, up to which it tells where both are the same. */
#define STEEP 0.9

/* The point of a part: its shear force and how much closure it gets. `asked`, `borne`: magnitudes of the shear
 * that the law was asked with the time before, and of its answer; 0: none. */
typedef struct given {
    tl_vec3 shear;
    double closure, asked, borne;
} given;

/* A patch that has taken over from one of the whole. */
typedef struct part {
    const tl_cut_contact *cut;
    uint32_t contact;
} part;

/* All parts of one whole, and their points. */
typedef struct parts {
    tl_model *m;
    const tl_cut_contact *cut;
    const part *part;
    size_t count;
    given *points;
    double keep; /* share of their shear that they keep beside what they are given */
    /* Numbers that are looked for: all six, or those of closure, when points keep shear whether they bear it or not. */
    int sought;
    six at; /* where a search begins, and, after it, where it has come to */
} parts;

static size_t point_count(const parts *of, size_t i)
{
    return of->m->detect->contacts.point_count[of->part[i].contact];
}

/* Puts the places of a part's points into the first lanes; where their arms begin. */
static tl_vec3 find_places(const tl_model *m, uint32_t c, const tl_point_lanes *lanes)
{
    tl_contact_places(m, c, lanes);
    return tl_side_place(m, tl_contact_sides(m, c).a);
}

/* Gives the points of a part closure and shear beside what they have taken over. */
static void begin_points(const parts *of, const six *more, uint32_t c, given *points)
{
    const tl_detect *d = of->m->detect;
    const tl_point_lanes *lanes = &d->lanes[0];
    const tl_vec3 *along = of->cut->next.along;
    const double *q = more->v, *w = more->v + TL_NEXT_PRESS, area = of->cut->whole.area;
    double kn = of->m->joint_laws[d->contacts.law[c]].kn;
    tl_vec3 from = find_places(of->m, c, lanes);
    for (size_t k = 0; k < d->contacts.point_count[c]; k++) {
        size_t row = tl_point_row(&d->contacts, c, k);
        tl_vec3 at = basis(of->cut, tl_v3_add(from, tl_columns_get(lanes->arm, k)));
        tl_vec3 n = tl_columns_get(lanes->normal, k);
        tl_vec3 t = tl_v3_scale(w[0] - w[2] * at.z, along[0]);
        t = tl_v3_madd(t, w[1] + w[2] * at.y, along[1]);
        t = tl_v3_madd(t, -tl_v3_dot(t, n), n);
        double share = tl_cut_contact_sign(of->m, of->cut, c) * d->points.area[row] / area;
        points[k] = (given){
            .shear = tl_v3_madd(tl_v3_scale(of->keep, tl_columns_get(d->points.f_s, row)), share, t),
            .closure = kn > 0 ? (q[0] + q[1] * at.y + q[2] * at.z) / (kn * area) : 0,
        };
    }
}

/* Asks the law of a part, with its motion, or as if it stood; false: it failed. */
static bool ask(const parts *of, uint32_t c, bool moves, const given *points, pressing *press)
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
    return ask_patch(of->m, c, lanes, press);
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
static bool give_borne(const parts *of, uint32_t c, given *points)
{
    const tl_point_lanes *lanes = &of->m->detect->lanes[0];
    bool again = true;
    pressing press;
    for (int pass = 0; again && pass < PASSES; pass++) {
        if (!ask(of, c, false, points, &press))
            return false;
        again = false;
        for (size_t k = 0; k < of->m->detect->contacts.point_count[c]; k++)
            again = give_less(&points[k], tl_v3_norm(tl_columns_get(&lanes->before[1], k))) || again;
    }
    return true;
}

/* Adds what a part is going to press with, and its shear. false: the law failed. */
static bool add_part(const parts *of, const six *more, uint32_t c, given *points, double sum[])
{
    const tl_point_lanes *lanes = &of->m->detect->lanes[0];
    double sign = tl_cut_contact_sign(of->m, of->cut, c);
    pressing press;
    begin_points(of, more, c, points);
    if ((of->sought == TL_NEXT_SUMS && !give_borne(of, c, points)) || !ask(of, c, true, points, &press))
        return false;
    tl_vec3 from = find_places(of->m, c, lanes);
    add_force(of->cut, press.force, press.moment, from, sign, sum);
    for (size_t k = 0; k < of->m->detect->contacts.point_count[c]; k++) {
        tl_vec3 place = tl_v3_add(from, tl_columns_get(lanes->arm, k));
        add_force(of->cut, points[k].shear, tl_v3(0, 0, 0), place, sign, sum);
    }
    return true;
}

/* What the parts lack, with some numbers, of what the whole carried. false: a law failed. */
static bool find_lack(const parts *of, const six *more, six *lacks)
{
    const tl_next_step *next = &of->cut->next;
    double sum[TL_NEXT_SUMS] = {0};
    given *points = of->points;
    for (size_t i = 0; i < of->count; i++) {
        if (!add_part(of, more, of->part[i].contact, points, sum))
            return false;
        points += point_count(of, i);
    }
    for (int k = 0; k < TL_NEXT_SUMS; k++)
        lacks->v[k] = (next->sum[k] - sum[k]) / next->most;
    return true;
}

/* ---------------------------------------------------------------- search ----------------- */

/* Tolerance: tolerance: over the forces: what is lacking by this is not, and error with which the numbers are found. */
#define EXACT 1e-11
#define FOUND 1e-8
/* Steps that are made at the most, and halvings of each. */
#define STEPS 60
#define HALVINGS 10
/* Tolerance: step of differences, over the forces. */
#define SMALL 1e-6
/* Tolerance: share of what is lacking that is left after a good step: after another slopes are found anew. And after a
 * step with fresh slopes that leaves no hope. */
#define GOOD 0.3
#define HOPELESS 0.9
/* Tolerance: what is added to the slopes: the numbers may not tell all. */
#define FAINT 1e-9

/* How fast what is lacking falls with each number: [of what][with which]. Behind them there is a column for `solve`. */
typedef struct slopes {
    double of[TL_NEXT_SUMS][TL_NEXT_SUMS + 1];
} slopes;

/* The root of the sum of squares. */
static double size_of(const six *x, int count)
{
    double sum = 0;
    for (int k = 0; k < count; k++)
        sum += x->v[k] * x->v[k];
    return sqrt(sum);
}

/* Solves slopes x = right, `count` equations, by elimination, the largest of each column first. false: they cannot be
 * solved. */
static bool solve(slopes by, const six *right, int count, six *x)
{
    *x = (six){{0}};
    for (int i = 0; i < count; i++)
        by.of[i][count] = right->v[i];
    for (int j = 0; j < count; j++) {
        int best = j;
        for (int i = j + 1; i < count; i++)
            best = fabs(by.of[i][j]) > fabs(by.of[best][j]) ? i : best;
        for (int k = j; k <= count; k++) {
            double was = by.of[j][k];
            by.of[j][k] = by.of[best][k];
            by.of[best][k] = was;
        }
        for (int i = j + 1; i < count; i++) {
            double share = by.of[i][j] / by.of[j][j];
            for (int k = j; k <= count; k++)
                by.of[i][k] -= share * by.of[j][k];
        }
    }
    for (int j = count - 1; j >= 0; j--) {
        double sum = by.of[j][count];
        for (int k = j + 1; k < count; k++)
            sum -= by.of[j][k] * x->v[k];
        x->v[j] = sum / by.of[j][j];
    }
    return isfinite(size_of(x, count));
}

/* Slopes where parts lack `lacks`, by differences. false: a law failed. */
static bool find_slopes(const parts *of, const six *lacks, slopes *out)
{
    double unit = of->cut->next.most, by = SMALL * unit;
    for (int j = 0; j < of->sought; j++) {
        six there = of->at, then;
        there.v[j] += by;
        if (!find_lack(of, &there, &then))
            return false;
        for (int i = 0; i < of->sought; i++)
            out->of[i][j] = (lacks->v[i] - then.v[i]) / by + (i == j ? FAINT / unit : 0);
    }
    return true;
}

/* Goes the step or a share of it, so that less is lacking; halves it so often at the most. Returns the share,
 * 0: none. */
static double go(parts *of, const six *step, int halvings, six *lacks)
{
    double by = 1;
    for (int n = 0; n <= halvings; n++, by *= 0.5) {
        six there = of->at, then;
        for (int k = 0; k < TL_NEXT_SUMS; k++)
            there.v[k] += by * step->v[k];
        if (!find_lack(of, &there, &then))
            return 0;
        if (size_of(&then, of->sought) < size_of(lacks, of->sought)) {
            of->at = there;
            *lacks = then;
            return by;
        }
    }
    return 0;
}

/* Broyden's rule: brings slopes in line with what a share of their step has brought. */
static void mend_slopes(slopes *by, int count, const six *step, double share, const six *before, const six *after)
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

/* Looks for the numbers with which the parts lack the least, and gives the points what goes with them. *found:
 * they lack nothing. false: a law failed. */
static bool search(parts *of, bool *found)
{
    const int count = of->sought;
    const double hopeless = count == TL_NEXT_SUMS ? HOPELESS : 1; /* then three are looked for */
    six lacks, step;
    slopes by = {{{0}}};
    bool fresh = false;
    for (int k = 0; k < TL_NEXT_SUMS; k++) /* where all is plain */
        by.of[k][k] = 1 / of->cut->next.most;
    if (!find_lack(of, &of->at, &lacks))
        return false;
    for (int k = 0; k < STEPS && size_of(&lacks, count) > EXACT; k++) {
        const six before = lacks;
        double share = 0;
        if (solve(by, &lacks, count, &step))
            share = go(of, &step, fresh ? HALVINGS : 0, &lacks);
        if (share > 0)
            mend_slopes(&by, count, &step, share, &before, &lacks);
        if (fresh && size_of(&lacks, count) >= hopeless * size_of(&before, count))
            break;
        fresh = size_of(&lacks, count) > GOOD * size_of(&before, count);
        if (fresh && !find_slopes(of, &lacks, &by))
            break;
    }
    *found = size_of(&lacks, count) <= FOUND;
    return find_lack(of, &of->at, &lacks);
}

/* ---------------------------------------------------------------- giving ----------------- */

/* Tolerance: share of t by which parts keep less each time. Shares by which their springs may hold more energy, and by
 * which they may if there is no way with less. Test: lua/test_cut_keeps. */
#define LESS 0.25
#define MORE_ENERGY 5e-4
#define MOST_ENERGY 0.5
/* Tolerance: areas that are the same, over each other: parts that lack some of the whole go by what is between its
 * points alone. */
#define SAME_AREA 1e-3

/* Puts what has been found into the points. */
static void give(const parts *of)
{
    const tl_detect *d = of->m->detect;
    const given *point = of->points;
    for (size_t i = 0; i < of->count; i++)
        for (size_t k = 0; k < point_count(of, i); k++, point++) {
            size_t row = tl_point_row(&d->contacts, of->part[i].contact, k);
            tl_columns_put(d->points.f_s, row, point->shear);
            d->points.reference[row] -= point->closure;
        }
}

/* The parts' area, and the energy of the shear that has been found. */
static tl_shear sum_given(const parts *of)
{
    const tl_detect *d = of->m->detect;
    const given *point = of->points;
    tl_shear sum = {.area = 0};
    for (size_t i = 0; i < of->count; i++)
        for (size_t k = 0; k < point_count(of, i); k++, point++)
            tl_shear_add(&sum, d->points.area[tl_point_row(&d->contacts, of->part[i].contact, k)], tl_v3(0, 0, 0),
                         point->shear);
    return sum;
}

/* Looks for all six numbers, from some, with ever less of t, and gives the points what goes with them. They may
 * have so much more energy. *done: it has. false: a law failed. */
static bool correct_all(parts *of, six from, double more, bool *done)
{
    const double whole = of->cut->whole.energy;
    double least = (1 + more) * whole, best = -1;
    bool found = true;
    *done = false;
    of->sought = TL_NEXT_SUMS;
    for (of->keep = 1; found && of->keep >= 0; of->keep -= LESS) {
        of->at = from;
        if (!search(of, &found))
            return false;
        double energy = sum_given(of).energy;
        *done = found && energy <= (1 + MORE_ENERGY) * whole;
        if (*done)
            break;
        if (found && energy < least) {
            least = energy;
            best = of->keep;
        }
    }
    if (!*done && best >= 0) {
        of->keep = best;
        of->at = from;
        *done = search(of, &found);
    }
    if (*done)
        give(of);
    return true;
}

/* The three of closure alone, with all of t. false: a law failed. */
static bool correct_press(parts *of, six from)
{
    bool found;
    of->keep = 1;
    of->sought = TL_NEXT_PRESS;
    of->at = from;
    return search(of, &found);
}

/* From none, or from what presses as the whole: a way to all six may lead over that. */
static void correct(parts *of)
{
    const double area = of->cut->whole.area;
    const six none = {{0}};
    six lacks;
    bool done;
    if (!find_lack(of, &none, &lacks) || !(size_of(&lacks, TL_NEXT_SUMS) > EXACT) ||
        !(fabs(sum_given(of).area - area) < SAME_AREA * area))
        return;
    if (!correct_all(of, none, MOST_ENERGY, &done) || done || !correct_press(of, none))
        return;
    const six press = of->at;
    if (!correct_all(of, press, MORE_ENERGY, &done) || done)
        return;
    if (correct_press(of, press))
        give(of);
}

/* By whole; contacts ascend in each. */
static int compare(const void *x, const void *y)
{
    const part *p = x, *q = y;
    if (p->cut != q->cut)
        return (p->cut > q->cut) - (p->cut < q->cut);
    return (p->contact > q->contact) - (p->contact < q->contact);
}

/* Forgets what patches carried whose parts are not all patches of its law: what they take over is not known yet. */
static void forget_mixed(tl_model *m)
{
    tl_detect *d = m->detect;
    for (uint32_t c = 0; c < d->contacts.table.rows; c++) {
        tl_cut_contact *cut = tl_cut_contact_of(m, d->contacts.a[c], d->contacts.b[c]);
        if (cut && d->contacts.point_count[c] > 0 &&
            (tl_facet_is_field(&d->contacts.facet[c]) || !tl_cut_contact_is_of_law(m, cut, c)))
            cut->next.most = 0;
    }
}

/* What a contact has taken over from; not a field contact from a patch. */
static tl_cut_contact *source_of(const tl_model *m, uint32_t c)
{
    tl_cut_contact *cut = tl_cut_contact_on(m, c, &m->detect->contacts.facet[c]);
    return cut && (cut->field || !tl_facet_is_field(&m->detect->contacts.facet[c])) ? cut : NULL;
}

/* The patch that a patch has taken a share of, or NULL. */
static tl_cut_contact *patch_taken(const tl_model *m, uint32_t c)
{
    tl_cut_contact *cut = source_of(m, c);
    return cut && !cut->field ? cut : NULL;
}

/* Lists the parts of all wholes; returns how many there are. *points: how many points they have. */
static size_t list(const tl_model *m, part *out, size_t *points)
{
    const tl_contacts *contacts = &m->detect->contacts;
    size_t count = 0;
    *points = 0;
    for (uint32_t c = 0; c < contacts->table.rows; c++) {
        const tl_cut_contact *cut = patch_taken(m, c);
        if (!cut || !(cut->next.most > 0))
            continue;
        out[count++] = (part){cut, c};
        *points += contacts->point_count[c];
    }
    if (count > 1)
        qsort(out, count, sizeof *out, compare);
    return count;
}

/* Brings all parts to where they carry the same as the whole. `points`: memory for as many as list() told. */
static void correct_wholes(tl_model *m, const part *all, size_t count, given *points)
{
    for (size_t first = 0, end = 0; first < count; first = end) {
        while (end < count && all[end].cut == all[first].cut)
            end++;
        correct(&(parts){.m = m,
                         .cut = all[first].cut,
                         .part = all + first,
                         .count = end - first,
                         .points = points,
                         .keep = 1,
                         .sought = TL_NEXT_SUMS});
    }
}

/* ---------------------------------------------------------------- all parts -------------- */

/* Adds what the patches of the parts carry; of parts of a field contact, the areas with which they have taken over. */
static void sum_taken(tl_model *m)
{
    tl_detect *d = m->detect;
    for (size_t i = 0; i < d->cut_count; i++)
        d->cut_contacts[i].taken = (tl_shear){.area = 0};
    for (uint32_t c = 0; c < d->contacts.table.rows; c++) {
        tl_cut_contact *cut = source_of(m, c);
        double sign = cut ? tl_cut_contact_sign(m, cut, c) : 0;
        if (cut && cut->field)
            cut->taken.area += fmin(tl_contact_area_of_points(d, c), cut->whole.area);
        for (size_t k = 0; cut && !cut->field && k < d->contacts.point_count[c]; k++) {
            size_t i = tl_point_row(&d->contacts, c, k);
            tl_vec3 force = tl_v3_scale(sign, tl_columns_get(d->points.f_s, i));
            tl_shear_add(&cut->taken, d->points.area[i], tl_v3(0, 0, 0), force);
        }
    }
}

/* Parts that touch on a larger area than the whole have each taken over what was on all of it. They share it. */
static void share_out(const tl_model *m, uint32_t c, const tl_cut_contact *cut)
{
    const tl_detect *d = m->detect;
    const tl_points_table *p = &d->points;
    if (!(cut->taken.area > cut->whole.area))
        return;
    double by = cut->whole.area / cut->taken.area;
    for (size_t k = 0; k < d->contacts.point_count[c]; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        p->f_n[i] *= by;
        if (p->f_n0)
            p->f_n0[i] *= by;
        tl_columns_put(p->f_s, i, tl_v3_scale(by, tl_columns_get(p->f_s, i)));
    }
}

/* Shear forces of a patch become `keep` times what they are, and a force over an area more. */
static void add_traction(const tl_detect *d, uint32_t c, double keep, tl_vec3 force, double over)
{
    for (size_t k = 0; k < d->contacts.point_count[c]; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        tl_vec3 now = tl_v3_scale(keep, tl_columns_get(d->points.f_s, i));
        tl_columns_put(d->points.f_s, i, tl_v3_madd(now, d->points.area[i] / over, force));
    }
}

/* Adds a uniform traction to a patch, of which its share, in its plane, makes up for what the parts lack. */
static void add_lacking(const tl_model *m, uint32_t c, const tl_cut_contact *cut)
{
    const tl_shear *whole = &cut->whole, *taken = &cut->taken;
    tl_vec3 lacks = tl_v3_sub(tl_v3_scale(tl_cut_contact_share(cut, taken->area), whole->force), taken->force);
    tl_vec3 n = m->detect->contacts.facet[c].last;
    lacks = tl_v3_scale(tl_cut_contact_sign(m, cut, c), lacks);
    lacks = tl_v3_madd(lacks, -tl_v3_dot(lacks, n), n);
    if (taken->area > 0)
        add_traction(m->detect, c, 1, lacks, taken->area);
}

/* Where the parts' springs have more energy than the whole's had, brings their stresses nearer to the mean. Of
 * one force a uniform stress has the least. */
static void limit_energy(const tl_model *m, uint32_t c, const tl_cut_contact *cut)
{
    const tl_shear *taken = &cut->taken;
    double most = cut->whole.energy * tl_cut_contact_share(cut, taken->area);
    if (!(taken->energy > most))
        return;
    double least = tl_v3_norm2(taken->force) / taken->area;
    double keep = sqrt(fmax(0, most - least) / fmax(taken->energy - least, DBL_MIN));
    double sign = tl_cut_contact_sign(m, cut, c);
    add_traction(m->detect, c, keep, tl_v3_scale(sign * (1 - keep) / taken->area, taken->force), 1);
}

/* After all parts have taken over their shares: together they carry what the whole did, and no more energy. */
static void balance(tl_model *m)
{
    tl_detect *d = m->detect;
    for (int step = 0; step < 2; step++) {
        sum_taken(m);
        for (uint32_t c = 0; c < d->contacts.table.rows; c++) {
            const tl_cut_contact *cut = source_of(m, c);
            if (cut && step == 0)
                (cut->field ? share_out : add_lacking)(m, c, cut);
            else if (cut && !cut->field)
                limit_energy(m, c, cut);
        }
    }
}

/* Sums what new contacts carry from the beginning, until the laws say it. */
static void sum_forces(tl_model *m)
{
    tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    const tl_point_lanes *lanes = &m->detect->lanes[0];
    for (uint32_t c = 0; c < contacts->table.rows; c++) {
        if (!tl_cut_contact_of(m, contacts->a[c], contacts->b[c]))
            continue;
        tl_contact_places(m, c, lanes);
        tl_shear sum = {.area = 0};
        for (size_t k = 0; k < contacts->point_count[c]; k++) {
            size_t i = tl_point_row(contacts, c, k);
            tl_vec3 n = tl_columns_get(lanes->normal, k);
            tl_shear_add(&sum, p->area[i], tl_columns_get(lanes->arm, k),
                         tl_v3_madd(tl_columns_get(p->f_s, i), p->f_n[i], n));
        }
        contacts->force[c] = sum.force;
        contacts->moment[c] = sum.moment;
    }
}

/* false: out of memory, and nothing has changed. */
static bool settle_parts(tl_model *m)
{
    forget_mixed(m);
    size_t most = 0, count = 0;
    part *all = malloc((m->detect->contacts.table.rows + 1) * sizeof *all);
    if (all)
        count = list(m, all, &most);
    given *points = malloc((most + 1) * sizeof *points);
    bool there = all && points;
    if (there) {
        balance(m);
        correct_wholes(m, all, count, points);
        sum_forces(m);
    }
    free(all);
    free(points);
    return there;
}

bool tl_cut_parts_settle(tl_model *m)
{
    if (m->detect->cut_count > 0 && !settle_parts(m))
        return false;
    tl_cut_contacts_end(m->detect);
    return true;
}
