/* laws.c - contact forces: gaps and motion of contact points, the laws' plugins, and the sum per contact.
 *
 * A law gets the points of a tile at once, all of one joint law, as the columns themselves; gaps and
 * motion are in the thread's lanes, which stay in the nearest cache from one end to the other. */
#include "force/laws.h"

#include "base/columns.h"
#include "base/law_columns.h"
#include "contact/contacts.h"
#include "contact/detection.h"
#include "contact/handover.h"
#include "contact/pair_view.h"
#include "contact/places.h"
#include "contact/prefetch.h"
#include "force/contact_damping.h"
#include "force/follow.h"
#include "force/joint_laws.h"
#include "force/partly_open.h"
#include "model/law_time.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <talus/number.h>

/* ---------------------------------------------------------------- rest ------------------- */

/* Forces and states of points, column by column; NULL beyond the last. */
static double *carried(const tl_points_table *p, size_t k)
{
    if (k == 0)
        return p->f_n;
    if (k < 4)
        return p->f_s[k - 1];
    return k - 4 < p->state_columns ? p->state[k - 4] : NULL;
}

/* Notes what the points of a tile carry before they are followed. */
static void note_points(const tl_points_table *p, size_t first, size_t count, const tl_point_lanes *t)
{
    for (size_t k = 0; k < 4 + TL_STATE_COLUMNS && carried(p, k); k++)
        memcpy(t->before[k], carried(p, k) + first, count * sizeof *t->before[k]);
    memcpy(t->flags_before, p->flags + first, count * sizeof *t->flags_before);
}

/* Whether they carry the same after their law, to the bit, and it turned nothing to heat. */
static bool as_noted(const tl_points_table *p, size_t first, size_t count, const tl_point_lanes *t)
{
    bool same = memcmp(t->flags_before, p->flags + first, count * sizeof *t->flags_before) == 0;
    for (size_t k = 0; same && k < 4 + TL_STATE_COLUMNS && carried(p, k); k++)
        same = memcmp(t->before[k], carried(p, k) + first, count * sizeof *t->before[k]) == 0;
    for (size_t i = 0; same && i < count; i++)
        same = t->dissipated[i] == 0;
    return same;
}

/* ---------------------------------------------------------------- what laws may return ----
 *
 * What a law may return: states that are numbers, a shear force in the common plane, and no more stiffness
 * than it says.
 *
 * The time step follows from stiffness(). A law that is stiffer blows the model up, which looks like a fault of
 * anything but the law. A contact that begins to carry is therefore asked. Its points are given to the law again, as
 * copies, at rest and moved a little. The rise of the forces is compared with what stiffness() says. That happens
 * where it matters, at the contact's own closure and states, and again whenever the contact has parted, which
 * an unstable one does.
 *
 * States are looked at in every step and shear forces in every eighth, by sums over points; what these find
 * is looked at here, point by point. */

/* Tolerance: component of a point's shear force along the normal, relative to the force of a spring pressed by the
 * block's size. Forces below are rounding, of any direction. Test: lua/test_law_check. */
#define ROUNDING_FORCE 1e-12

/* Limit: how many times stiffer than its word a law may be. Up to this a step that is unstable is the fraction's
 * fault, not the law's. A law that gives a mean for a bound passes. Test: lua/test_law_check. */
#define FAR_STIFFER 10
/* Tolerance: motion of the trial, of what the force came about by: closure, last motion, and how far a spring gives
 * under the initial force and the shear force. An initial stress leaves no closure but rounding. */
#define TRIAL (1. / 16)

/* Copies of what a law gets and gives, of the points of a SIMD group side by side. */
typedef struct trial {
    _Alignas(TL_ALIGN) double c[TL_AT_COUNT][TL_LANES];
    _Alignas(TL_ALIGN) uint32_t flags[TL_LANES];
} trial;

/* One place of each contact of a SIMD group: the row of its first point, and its lane. */
typedef struct place {
    const tl_model *m;
    const tl_law *law;
    const tl_point_lanes *lanes;
    size_t row, lane;
} place;

/* A vector of a point, whose components are three columns from `column` on. */
static tl_vec3 vector_of(const trial *t, int column, size_t l)
{
    return tl_v3(t->c[column][l], t->c[column + 1][l], t->c[column + 2][l]);
}

static void put_vector(trial *t, int column, size_t l, tl_vec3 v)
{
    t->c[column][l] = v.x;
    t->c[column + 1][l] = v.y;
    t->c[column + 2][l] = v.z;
}

static void copy_points(const place *at, trial *t)
{
    const tl_points_table *p = &at->m->detect->points;
    memset(t, 0, sizeof *t);
    for (size_t l = 0; l < TL_LANES; l++) {
        size_t i = at->row + l, k = at->lane + l;
        t->c[TL_AT_AREA][l] = p->area[i];
        t->c[TL_AT_CLOSURE][l] = t->c[TL_AT_EDGE][l] = at->lanes->closure[k];
        t->c[TL_AT_F_N0][l] = p->f_n0 ? p->f_n0[i] : 0;
        t->c[TL_AT_F_N][l] = p->f_n[i];
        t->flags[l] = p->flags[i];
        put_vector(t, TL_AT_NORMAL, l, tl_columns_get(at->lanes->normal, k));
        put_vector(t, TL_AT_F_S, l, tl_columns_get(p->f_s, i));
        for (uint32_t c = 0; c < p->state_columns; c++)
            t->c[TL_AT_STATE + c][l] = p->state[c][i];
    }
}

static bool call(const place *at, trial *t)
{
    double *state[TL_STATE_COLUMNS];
    tl_law_batch batch = tl_law_batch_of(t->c[0], TL_LANES, t->flags, state, TL_STATE_COLUMNS);
    batch.count = TL_LANES;
    batch.dt = tl_law_time(at->m, at->m->dt);
    tl_report report;
    return tl_law_update(at->law, &batch, &report) == TL_OK;
}

/* Forces of the points, from where they are, moved by `move` m along the normal, or along `slide` where it is given. */
static bool try_law(const place *at, const double *move, const tl_vec3 *slide, trial *t)
{
    copy_points(at, t);
    for (size_t l = 0; l < TL_LANES; l++) {
        if (slide) {
            put_vector(t, TL_AT_DU_S, l, tl_v3_scale(move[l], slide[l]));
            continue;
        }
        t->c[TL_AT_CLOSURE][l] = t->c[TL_AT_EDGE][l] += move[l];
        t->c[TL_AT_DU_N][l] = -move[l];
    }
    return call(at, t);
}

/* Stiffness of points, Pa/m, across the joint and along it; 0 of those that are not moved. */
typedef struct slopes {
    double normal[TL_LANES], shear[TL_LANES];
} slopes;

static bool measure(const place *at, const double *move, const tl_vec3 *slide, slopes *found)
{
    trial rest, pressed, slid;
    double none[TL_LANES] = {0};
    if (!try_law(at, none, NULL, &rest) || !try_law(at, move, NULL, &pressed) || !try_law(at, move, slide, &slid))
        return false;
    for (size_t l = 0; l < TL_LANES; l++) {
        double area = rest.c[TL_AT_AREA][l];
        found->normal[l] = found->shear[l] = 0;
        if (!(area > 0) || !(move[l] > 0))
            continue;
        tl_vec3 before = vector_of(&rest, TL_AT_F_S, l), after = vector_of(&slid, TL_AT_F_S, l);
        found->normal[l] = (pressed.c[TL_AT_F_N][l] - rest.c[TL_AT_F_N][l]) / (area * move[l]);
        found->shear[l] = tl_v3_dot(tl_v3_sub(before, after), slide[l]) / (area * move[l]);
    }
    return true;
}

/* Names the first point that is far stiffer than its law says. */
static void compare(tl_failure *failure, const tl_law *law, const tl_simd_group *group, size_t row, const slopes *found)
{
    for (size_t l = 0; l < TL_LANES; l++) {
        bool shear = found->shear[l] > found->normal[l];
        double stiffness = shear ? found->shear[l] : found->normal[l];
        char text[240];
        if (!(stiffness > FAR_STIFFER * tl_law_stiffness(law)) || isinf(stiffness))
            continue; /* where a trial leaves the range of numbers it tells nothing */
        tl_text_print(text, sizeof text,
                      "its %s force rises by %.3g Pa/m here, and its stiffness() gives kn = %.3g and ks = %.3g Pa/m, "
                      "from which the time step follows: they must be upper bounds, or the step is unstable",
                      shear ? "shear" : "normal", stiffness, law->kn, law->ks);
        tl_failure_note(failure, group->start, TL_E_PLUGIN, row + l, text);
    }
}

/* How far springs of a law give under the forces that a point has without closure: initial and shear, m. */
static double given_way(const tl_points_table *p, size_t row, const tl_law *law)
{
    double normal = p->f_n0 && law->kn > 0 ? fabs(p->f_n0[row]) / law->kn : 0;
    double shear = law->ks > 0 ? tl_v3_norm(tl_columns_get(p->f_s, row)) / law->ks : 0;
    return p->area[row] > 0 ? (normal + shear) / p->area[row] : 0;
}

/* Of the points of a SIMD group, whose first is in lane `lane`: whether they are stiffer than the law says, those in
 * the lanes of the mask `begins`, and whether shear forces leave the common plane. */
static void law_check_stiffness(const tl_model *m, tl_failure *failure, const tl_law *law, const tl_simd_group *group,
                                const tl_point_lanes *lanes, size_t lane, unsigned begins)
{
    for (size_t k = 0; k < group->slots; k++) {
        place at = {m, law, lanes, group->start + k * TL_LANES, lane + k * TL_LANES};
        double move[TL_LANES];
        tl_vec3 slide[TL_LANES];
        slopes found;
        for (size_t l = 0; l < TL_LANES; l++) {
            size_t i = at.lane + l;
            tl_vec3 du_s = tl_columns_get(lanes->du_s, i);
            double length = tl_v3_norm(du_s);
            slide[l] = length > 0 ? tl_v3_unit(du_s) : tl_v3_perpendicular(tl_columns_get(lanes->normal, i));
            double way = fabs(lanes->closure[i]) + fabs(lanes->du_n[i]) + length;
            move[l] = begins >> l & 1 ? TRIAL * (way + given_way(&m->detect->points, at.row + l, law)) : 0;
        }
        if (measure(&at, move, slide, &found))
            compare(failure, law, group, at.row, &found);
    }
}

/* Component along the normal of what the law makes of shear forces that lie in their planes, moved as in this step. */
static bool try_in_plane(const place *at, double along[TL_LANES])
{
    trial t;
    copy_points(at, &t);
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_vec3 n = tl_columns_get(at->lanes->normal, at->lane + l);
        tl_vec3 f = tl_columns_get(at->m->detect->points.f_s, at->row + l);
        tl_vec3 du_s = tl_columns_get(at->lanes->du_s, at->lane + l);
        f = tl_v3_madd(f, -tl_v3_dot(f, n), n);
        du_s = tl_v3_madd(du_s, -tl_v3_dot(du_s, n), n);
        put_vector(&t, TL_AT_F_S, l, f);
        put_vector(&t, TL_AT_DU_S, l, du_s);
        t.c[TL_AT_DU_N][l] = at->lanes->du_n[at->lane + l];
    }
    if (!call(at, &t))
        return false;
    for (size_t l = 0; l < TL_LANES; l++)
        along[l] = fabs(tl_v3_dot(vector_of(&t, TL_AT_F_S, l), vector_of(&t, TL_AT_NORMAL, l)));
    return true;
}

/* Whether `along` N is a component along the normal that a shear force in point `row` of contact c must not have. */
static bool is_out_of_plane(const tl_model *m, const tl_law *law, uint32_t c, size_t row, double along)
{
    const tl_points_table *p = &m->detect->points;
    double size = tl_contact_size(m, c);
    double spring = tl_law_stiffness(law) * p->area[row] * size;
    double force = tl_v3_norm(tl_columns_get(p->f_s, row)) + fabs(p->f_n[row]);
    return along > TL_OUT_OF_PLANE * force && along > ROUNDING_FORCE * spring;
}

static void law_check_shear(const tl_model *m, tl_failure *failure, const tl_law *law, const tl_simd_group *group,
                            const tl_point_lanes *lanes, size_t lane)
{
    const tl_points_table *p = &m->detect->points;
    for (size_t i = 0; i < group->slots * TL_LANES; i++) {
        size_t l = i % TL_LANES, row = group->start + i;
        uint32_t c = group->contact[l];
        if (c == TL_NO_ROW || !(p->area[row] > 0))
            continue;
        tl_vec3 f = tl_columns_get(p->f_s, row);
        double along = fabs(tl_v3_dot(f, tl_columns_get(lanes->normal, lane + i))), own[TL_LANES];
        place at = {m, law, lanes, row - l, lane + i - l};
        /* what a new contact polygon leaves of the old one's forces is not the law's */
        if (!is_out_of_plane(m, law, c, row, along) || !try_in_plane(&at, own) ||
            !is_out_of_plane(m, law, c, row, own[l]))
            continue;
        char text[240];
        tl_text_print(text, sizeof text,
                      "its shear force of %.3g N has a component of %.3g N along the normal: it must lie in the common "
                      "plane, to %g of the force",
                      tl_v3_norm(f), along, TL_OUT_OF_PLANE);
        tl_failure_note(failure, group->start, TL_E_PLUGIN, row, text);
    }
}

/* What the law was given for a point, and what it made of it. */
typedef struct point_told {
    double closure, motion, normal, shear;
} point_told;

static point_told told_of(const tl_points_table *p, const tl_point_lanes *lanes, size_t row, size_t lane)
{
    double slip = tl_v3_norm(tl_columns_get(lanes->du_s, lane));
    return (point_told){lanes->closure[lane], fabs(lanes->du_n[lane]) + slip, p->f_n[row],
                        tl_v3_norm(tl_columns_get(p->f_s, row))};
}

/* Names what is no finite number in the force of the contact in a lane of the SIMD group: what the law was given, what
 * it gave, or the sum. */
static void law_check_forces(const tl_model *m, tl_failure *failure, const tl_law *law, const tl_simd_group *group,
                             const tl_point_lanes *lanes, size_t lane, size_t contact)
{
    const tl_points_table *p = &m->detect->points;
    char text[300];
    double largest = 0;
    size_t row = group->start + contact;
    snprintf(text, sizeof text, "the force is not a finite number: the areas of its points are 0");
    for (size_t k = 0; k < group->slots; k++, row += TL_LANES) {
        if (!(p->area[row] > 0))
            continue;
        point_told at = told_of(p, lanes, row, lane + row - group->start);
        largest = fmax(largest, fmax(fabs(at.normal), at.shear));
        bool sound = isfinite(at.closure) && isfinite(at.motion);
        if (sound && isfinite(at.normal) && isfinite(at.shear)) {
            tl_text_print(text, sizeof text,
                          "the force is not a finite number: those of its points are, up to %.3g N, but not their sum "
                          "or moment; with kn = %.3g and ks = %.3g Pa/m, is a property out of proportion?",
                          largest, law->kn, law->ks);
            continue;
        }
        tl_text_print(text, sizeof text,
                      "the force is not a finite number: %s a normal force of %.3g N and a shear force of %.3g N for a "
                      "closure of %.3g m, a motion of %.3g m in the last step and an area of %.3g m2: look at %s",
                      sound ? "the law gives" : "it is", at.normal, at.shear, at.closure, at.motion, p->area[row],
                      sound ? "its properties" : "places and velocities of the blocks");
        break;
    }
    row = row < group->start + group->slots * TL_LANES ? row : group->start + contact;
    tl_failure_note(failure, group->start, TL_E_NUMERIC, row, text);
}

/* Name of the state whose column it is. */
static const char *state_name(const tl_kind *kind, uint32_t column)
{
    tl_state_columns at = {0};
    while (tl_state_next(kind, column + 1, &at))
        if (column < at.begin + at.count)
            return at.state->name;
    return "?";
}

/* Of `count` points from row `first`: whether their states are numbers. */
static void law_check_states(const tl_model *m, tl_failure *failure, const tl_law *law, size_t first, size_t count)
{
    const tl_points_table *p = &m->detect->points;
    for (uint32_t c = 0; c < law->columns; c++)
        for (size_t i = first; i < first + count; i++) {
            char text[200];
            if (isfinite(p->state[c][i]) || !(p->area[i] > 0))
                continue;
            tl_text_print(text, sizeof text, "it leaves %g in its state '%.40s', which must be a finite number",
                          p->state[c][i], state_name(law->kind, c));
            tl_failure_note(failure, first, TL_E_PLUGIN, i, text);
            return;
        }
}

/* ---------------------------------------------------------------- laws -------------------- */

/* Cost only: steps after which shear forces are looked at again for components along the normals. A law that has them
 * has them all the time, and every step would cost 3 % of its instructions. */
#define SHEAR_EVERY 8

/* SIMD groups a worker takes at a time. */
#define GROUP_CHUNK 12

typedef struct span_job {
    tl_model *m;
    const tl_law_phase *phase;
    const tl_law *law;
    const tl_span *span;
    const tl_kind_force *kind;
    /* of a span of bodies held still: some of it is not what it was; else NULL */
    atomic_bool *changed;
} span_job;

/* Whether the law is given closures at outermost fibres: only what pulls can tell. */
static bool has_edges(const span_job *job)
{
    return job->kind->cells && job->law->pulls != TL_PULL_NONE;
}

/* Calls the law on `count` points from `first`, some of which are `partly` open; false when it failed. */
static bool call_law(const span_job *job, size_t first, size_t count, bool partly, const tl_point_lanes *l)
{
    tl_points_table *p = &job->m->detect->points;
    double *state[TL_STATE_COLUMNS];
    for (uint32_t k = 0; k < TL_STATE_COLUMNS; k++)
        state[k] = k < p->state_columns ? p->state[k] + first : l->zero;
    tl_law_batch batch = {
        .size = sizeof batch,
        .count = (uint32_t)count,
        .dt = tl_law_time(job->m, job->m->dt),
        .area = p->area + first,
        .closure = l->closure,
        .f_n0 = p->f_n0 ? p->f_n0 + first : l->zero,
        .normal = {l->normal[0], l->normal[1], l->normal[2]},
        .du_n = l->du_n,
        .du_s = {l->du_s[0], l->du_s[1], l->du_s[2]},
        .f_n = p->f_n + first,
        .f_s = {p->f_s[0] + first, p->f_s[1] + first, p->f_s[2] + first},
        .state = state,
        .flags = p->flags + first,
        .stored = l->stored,
        .dissipated = l->dissipated,
        .closure_edge = has_edges(job) ? l->edge : l->closure,
        .closure_apart = partly ? l->apart : l->zero,
    };
    /* a law need not write its energies: those of the tile before are not its own */
    memset(l->stored, 0, count * sizeof *l->stored);
    memset(l->dissipated, 0, count * sizeof *l->dissipated);
    tl_report report;
    tl_status status = tl_law_update(job->law, &batch, &report);
    /* the plugin's word: there need not be such a point */
    size_t bad = report.first_bad < count ? report.first_bad : 0;
    if (status != TL_OK)
        tl_failure_note(job->phase->failure, first, status, first + bad, tl_report_text(&report, status));
    return status == TL_OK;
}

/* Point after point: the same order for every width of the processor's vectors. */
TL_VECTORIZED static void add_points(const tl_points_table *p, const tl_point_lanes *t, size_t row, size_t lane,
                                     size_t slots, const tl_arms *restrict arms, tl_group_sums *restrict out)
{
    const double *f_n = p->f_n + row, *f_x = p->f_s[0] + row, *f_y = p->f_s[1] + row;
    const double *f_z = p->f_s[2] + row, *x = t->arm[0] + lane, *y = t->arm[1] + lane;
    const double *z = t->arm[2] + lane, *stored = t->stored + lane, *heat = t->dissipated + lane;
    const double *closure = t->closure + lane;
    const double *reference = p->reference ? p->reference + row : t->zero + lane;
    tl_group_sums s = {0};
    for (size_t at = 0; at < slots * TL_LANES; at += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            size_t i = at + l;
            double gx = f_x[i] + f_n[i] * arms->push.x[l];
            double gy = f_y[i] + f_n[i] * arms->push.y[l];
            double gz = f_z[i] + f_n[i] * arms->push.z[l];
            s.force[0][l] += gx;
            s.force[1][l] += gy;
            s.force[2][l] += gz;
            s.moment[0][l] += y[i] * gz - z[i] * gy;
            s.moment[1][l] += z[i] * gx - x[i] * gz;
            s.moment[2][l] += x[i] * gy - y[i] * gx;
            double apart = closure[i] + reference[i] < 0 ? f_n[i] : 0;
            s.holds_over_gap[l] += f_n[i] < 0 ? -f_n[i] : apart;
            s.stored[l] += stored[i];
            s.dissipated[l] += heat[i];
        }
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_vec3 f = {s.force[0][l], s.force[1][l], s.force[2][l]};
        tl_vec3 more = tl_v3_cross(tl_lanes3_get(&arms->at, l), f);
        s.moment[0][l] += more.x;
        s.moment[1][l] += more.y;
        s.moment[2][l] += more.z;
        double moment = s.moment[0][l] + s.moment[1][l] + s.moment[2][l];
        s.odd[l] = 0 * (s.force[0][l] + s.force[1][l] + s.force[2][l]) + 0 * moment;
    }
    *out = s;
}

/* Adds 1 to what is odd of a contact whose shear forces may leave their planes. A loop of its own: add_points has no
 * register left. */
TL_VECTORIZED static void sum_tilts(const tl_points_table *p, const tl_point_lanes *t, size_t row, size_t lane,
                                    size_t slots, tl_group_sums *restrict out)
{
    const double *f_x = p->f_s[0] + row, *f_y = p->f_s[1] + row, *f_z = p->f_s[2] + row;
    const double *n_x = t->normal[0] + lane, *n_y = t->normal[1] + lane, *n_z = t->normal[2] + lane;
    double along[TL_LANES] = {0};
    for (size_t at = 0; at < slots * TL_LANES; at += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            size_t i = at + l;
            along[l] += fabs(f_x[i] * n_x[i] + f_y[i] * n_y[i] + f_z[i] * n_z[i]);
        }
#pragma omp simd
    for (size_t l = 0; l < TL_LANES; l++) {
        double force = fabs(out->force[0][l]) + fabs(out->force[1][l]) + fabs(out->force[2][l]);
        out->odd[l] += along[l] > TL_OUT_OF_PLANE * force ? 1 : 0;
    }
}

/* 0, or NaN when a state of the points is not finite. */
TL_VECTORIZED static double odd_states(const tl_points_table *p, uint32_t columns, size_t first, size_t count)
{
    double odd[TL_LANES] = {0}, sum = 0;
    for (uint32_t c = 0; c < columns; c++) {
        const double *state = p->state[c] + first;
        for (size_t at = 0; at < count; at += TL_LANES)
#pragma omp simd
            for (size_t l = 0; l < TL_LANES; l++)
                odd[l] += 0 * state[at + l];
    }
    for (size_t l = 0; l < TL_LANES; l++)
        sum += odd[l];
    return sum;
}

static double sum_over_lanes(const double *lane)
{
    return ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7]));
}

/* Names what is wrong in a SIMD group of which a sum is odd. */
static void report_odd(const span_job *job, const tl_simd_group *group, const tl_group_sums *sum,
                       const tl_point_lanes *t, size_t lane)
{
    for (size_t l = 0; l < TL_LANES; l++)
        if (isnan(sum->odd[l]) && group->contact[l] != TL_NO_ROW)
            law_check_forces(job->m, job->phase->failure, job->law, group, t, lane, l);
    law_check_shear(job->m, job->phase->failure, job->law, group, t, lane);
}

static void sum_patches(const tl_model *m, const tl_law *law, const tl_simd_group *group, const tl_point_lanes *t,
                        size_t lane, const tl_arms *arms, tl_group_sums *out)
{
    (void)law;
    add_points(&m->detect->points, t, group->start, lane, group->slots, arms, out);
}

static void follow_patches(tl_model *m, const tl_simd_group *group, const tl_point_lanes *t, size_t lane,
                           uint32_t tangents, tl_arms *arms)
{
    tl_simd_group_follow(m, group, false, t, lane, tangents, arms);
}

/* The sum over points, of other forces. */
static void damp_patches(const tl_model *m, const tl_simd_group *group, const tl_point_lanes *t, size_t lane,
                         const tl_arms *arms, tl_group_sums *out)
{
    (void)m;
    const tl_points_table damping = {.f_n = t->before[0], .f_s = {t->before[1], t->before[2], t->before[3]}};
    add_points(&damping, t, lane, lane, group->slots, arms, out);
}

const tl_kind_force tl_patch_force = {
    .cells = true, .follow = follow_patches, .sum = sum_patches, .damp = damp_patches};

/* Adds what partly open patches have beside their points. Gives the lanes that slip has opened. */
static uint32_t add_parts(const span_job *job, const tl_simd_group *group, const tl_point_lanes *t, size_t lane,
                          tl_part_lanes parts, const tl_arms *arms, tl_group_sums *sum)
{
    tl_part_sums more[TL_LANES];
    tl_vec3 turn[TL_LANES];
    for (uint32_t left = parts.parts | parts.held; left; left &= left - 1) {
        size_t l = (size_t)__builtin_ctz(left);
        turn[l] = tl_contact_moved(job->m, group->contact[l]).turn;
    }
    const tl_found_lanes found = tl_simd_group_part_sum(job->m, job->law, group, t, lane, parts, turn, more);
    for (uint32_t left = found.parts; left; left &= left - 1) {
        size_t l = (size_t)__builtin_ctz(left);
        tl_vec3 force = tl_v3_scale(more[l].force, tl_lanes3_get(&arms->push, l));
        tl_vec3 arm = tl_v3_add(tl_lanes3_get(&arms->at, l), more[l].arm);
        tl_vec3 moment = tl_v3_add(more[l].moment, tl_v3_cross(arm, force));
        for (int axis = 0; axis < 3; axis++) {
            sum->force[axis][l] += (&force.x)[axis];
            sum->moment[axis][l] += (&moment.x)[axis];
        }
        sum->stored[l] += more[l].stored;
        sum->dissipated[l] += more[l].dissipated;
    }
    return found.opened;
}

/* Forces of the contacts of a SIMD group, whose first point is in lane `lane`, and the heat of each. Whether any of
 * that is not 0. */
static bool sum_group(const span_job *job, const tl_simd_group *group, const tl_point_lanes *t, size_t lane,
                      tl_part_lanes parts, const tl_arms *arms, double heat[TL_LANES])
{
    tl_model *m = job->m;
    tl_contacts *contacts = &m->detect->contacts;
    unsigned begins = 0; /* lanes of contacts that carried nothing in the step before */
    uint32_t opened = 0;
    tl_group_sums sum;
    job->kind->sum(m, job->law, group, t, lane, arms, &sum);
    if (parts.parts | parts.held)
        opened = add_parts(job, group, t, lane, parts, arms, &sum);
    if (m->cycles % SHEAR_EVERY == 0 && job->kind->cells)
        sum_tilts(&m->detect->points, t, group->start, lane, group->slots, &sum);
    bool any_heat = false;
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t c = group->contact[l];
        heat[l] = 0;
        if (c == TL_NO_ROW)
            continue; /* what its rows hold means nothing, after a step that failed not even a number */
        tl_vec3 force = tl_v3(sum.force[0][l], sum.force[1][l], sum.force[2][l]);
        tl_vec3 moment = tl_v3(sum.moment[0][l], sum.moment[1][l], sum.moment[2][l]);
        heat[l] = sum.dissipated[l] + contacts->released[c];
        if (contacts->handed_over[c] || (opened >> l & 1))
            heat[l] = tl_contact_lost(m, c, force, moment, sum.stored[l]);
        if (contacts->heat)
            contacts->heat[c] = heat[l];
        any_heat |= heat[l] != 0;
        contacts->stored[c] = sum.stored[l];
        contacts->handed_over[c] = false;
        contacts->released[c] = 0;
        contacts->holds_over_gap[c] = sum.holds_over_gap[l] > 0;
        if (tl_v3_is_zero(contacts->force[c]) && !tl_v3_is_zero(force))
            begins |= 1u << l;
        contacts->force[c] = force;
        contacts->moment[c] = moment;
    }
    if (sum_over_lanes(sum.odd) != 0)
        report_odd(job, group, &sum, t, lane);
    if (begins) {
        law_check_shear(m, job->phase->failure, job->law, group, t, lane);
        law_check_stiffness(m, job->phase->failure, job->law, group, t, lane, begins);
    }
    return any_heat;
}

/* ---------------------------------------------------------------- damping ---------------- */

static tl_point_forces forces_before(const tl_point_lanes *t)
{
    return (tl_point_forces){t->before[0], {t->before[1], t->before[2], t->before[3]}};
}

/* Whether contacts of a span are damped: those that are held still do not move anything. */
static bool is_damped(const span_job *job)
{
    return job->phase->damping && !job->changed;
}

/* Damping forces of the points of a tile, and what they do to the contacts of its SIMD groups. */
static void damp_tile(const span_job *job, const tl_simd_group *groups, size_t count, size_t points,
                      const tl_point_lanes *t, const tl_arms *arms)
{
    const tl_points_table *p = &job->m->detect->points;
    const size_t first = groups->start;
    const tl_damped_points of = {points,          p->area + first,
                                 p->f_n + first,  {p->f_s[0] + first, p->f_s[1] + first, p->f_s[2] + first},
                                 t->du_n,         {t->du_s[0], t->du_s[1], t->du_s[2]},
                                 p->flags + first};
    const tl_point_forces forces = forces_before(t);
    tl_damping_of_points(job->law, &of, job->phase->damping_rate, &forces);
    for (size_t r = 0; r < count; r++) {
        tl_group_sums sum;
        job->kind->damp(job->m, &groups[r], t, groups[r].start - first, &arms[r], &sum);
        for (size_t l = 0; l < TL_LANES; l++)
            if (groups[r].contact[l] != TL_NO_ROW)
                job->phase->damping[groups[r].contact[l]] =
                    (tl_wrench){tl_v3(sum.force[0][l], sum.force[1][l], sum.force[2][l]),
                                tl_v3(sum.moment[0][l], sum.moment[1][l], sum.moment[2][l])};
    }
}

/* ---------------------------------------------------------------- tiles ------------------ */

static size_t tile_points(const tl_simd_group *groups, size_t count)
{
    return groups[count - 1].start + (size_t)groups[count - 1].slots * TL_LANES - groups->start;
}

/* Prefetches what a SIMD group that comes soon will need to be followed. */
static void prefetch_group(const tl_model *m, const tl_simd_group *group)
{
    const tl_points_table *p = &m->detect->points;
    size_t count = (size_t)group->slots * TL_LANES;
    for (size_t l = 0; l < TL_LANES; l++)
        if (group->contact[l] != TL_NO_ROW)
            tl_prefetch_bodies(m, group->contact[l]);
    tl_prefetch_points(p, group->start, count);
    tl_prefetch(p->flags + group->start, count * sizeof *p->flags);
}

/* From the places of the bodies to the forces of the contacts of some SIMD groups, which follow each other. `soon`: how
 * many come next, for which the memory is asked on the way. */
static void force_tile(const span_job *job, const tl_simd_group *groups, size_t count, size_t soon,
                       const tl_point_lanes *t, tl_exact *heats)
{
    size_t first = groups->start, points = 0;
    tl_part_lanes part[GROUP_CHUNK];
    uint32_t any = 0;
    tl_arms arms[GROUP_CHUNK];
    job->phase->keep(job->m, groups, count);
    if (job->changed)
        note_points(&job->m->detect->points, first, tile_points(groups, count), t);
    for (size_t r = 0; r < count; r++) {
        if (r < soon)
            prefetch_group(job->m, &groups[count + r]);
        job->kind->follow(job->m, &groups[r], t, points, job->law->tangents, &arms[r]);
        if (has_edges(job))
            tl_simd_group_edges(job->m, &groups[r], t, points);
        part[r] =
            job->kind->cells ? tl_simd_group_part(job->m, job->law, &groups[r], t, points) : (tl_part_lanes){0, 0};
        any |= part[r].parts;
        points += (size_t)groups[r].slots * TL_LANES;
    }
    for (size_t r = 0; any && r < count; r++)
        if (!part[r].parts)
            memset(t->apart + (groups[r].start - first), 0, (size_t)groups[r].slots * TL_LANES * sizeof *t->apart);
    if (is_damped(job)) {
        const tl_point_forces forces = forces_before(t);
        const tl_points_table *p = &job->m->detect->points;
        tl_damping_note(p->f_n, p->f_s, first, points, &forces);
    }
    if (!call_law(job, first, points, any != 0, t))
        return;
    if (is_damped(job))
        damp_tile(job, groups, count, points, t, arms);
    if (odd_states(&job->m->detect->points, job->law->columns, first, points) != 0)
        law_check_states(job->m, job->phase->failure, job->law, first, points);
    double heat[GROUP_CHUNK][TL_LANES];
    bool any_heat = false;
    for (size_t r = 0; r < count; r++) {
        size_t lane = groups[r].start - first;
        any_heat |= sum_group(job, &groups[r], t, lane, part[r], &arms[r], heat[r]);
    }
    if (any_heat)
        tl_exact_add(heats, heat[0], count * TL_LANES);
    /* what is passed over makes no heat */
    if (job->changed && (any_heat || !as_noted(&job->m->detect->points, first, points, t)))
        atomic_store_explicit(job->changed, true, memory_order_relaxed);
}

/* SIMD groups in tiles, as many as fit. */
static void force_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    const span_job *job = user;
    const tl_simd_group *groups = job->m->detect->layout.groups + job->span->group_begin;
    const tl_point_lanes *t = &job->m->detect->lanes[thread];
    size_t asked = tl_points_are_far(job->m->detect) ? job->span->group_end - job->span->group_begin : 0;
    while (begin < end) {
        size_t count = 1, points = (size_t)groups[begin].slots * TL_LANES;
        while (begin + count < end && (points += (size_t)groups[begin + count].slots * TL_LANES) <= TL_TILE)
            count++;
        force_tile(job, &groups[begin], count, asked > begin + count ? asked - begin - count : 0, t,
                   &job->phase->heat[thread]);
        begin += count;
    }
}

/* Where a step failed: the law, and the contact or TL_NO_ROW. */
typedef struct failed_at {
    const tl_law *law;
    uint32_t contact;
} failed_at;

/* The contact in a lane of a SIMD group or, where that is padding, the first one of the SIMD group; TL_NO_ROW: all
 * are. */
static uint32_t contact_near(const tl_simd_group *group, size_t lane)
{
    uint32_t c = group->contact[lane];
    for (size_t l = 0; c == TL_NO_ROW && l < TL_LANES; l++)
        c = group->contact[l];
    return c;
}

static failed_at find_failed(const tl_model *m, size_t point)
{
    const tl_layout *layout = &m->detect->layout;
    const tl_span *span = layout->spans;
    while (point >= span->end)
        span++;
    size_t k = span->group_begin;
    while (point - layout->groups[k].start >= (size_t)layout->groups[k].slots * TL_LANES)
        k++;
    const tl_simd_group *group = &layout->groups[k];
    uint32_t contact = contact_near(group, (point - group->start) % TL_LANES);
    return (failed_at){&m->joint_laws[span->law], contact};
}

/* Turns a failure in a parallel phase into the model's error, with the contact it came from. */
static tl_status report_failure(tl_model *m, tl_failure *failure)
{
    if (failure->error.status == TL_OK)
        return TL_OK;
    char name[320] = "a point of no contact";
    failed_at at = find_failed(m, failure->point);
    const tl_kind *kind = at.law->kind;
    const tl_plugin *plugin = tl_plugin_of(kind, NULL);
    if (at.contact != TL_NO_ROW)
        tl_contact_describe(m, at.contact, name, sizeof name);
    tl_fail(&m->error, failure->error.status, "cycle %lld, law '%s' of plugin '%s', %s: %s", (long long)m->cycles + 1,
            kind->name, plugin ? plugin->id : "?", name, failure->error.text);
    failure->error.status = TL_OK;
    return m->error.status;
}

tl_status tl_laws_apply(tl_model *m, const tl_law_phase *phase)
{
    tl_detect *d = m->detect;
    for (size_t r = 0; r < d->layout.span_count; r++) {
        tl_span *span = &d->layout.spans[r];
        if (span->law == TL_NO_ROW || tl_span_rests(m, span))
            continue;
        atomic_bool changed = false;
        span_job job = {.m = m,
                        .phase = phase,
                        .law = &m->joint_laws[span->law],
                        .span = span,
                        .kind = d->kinds[span->kind]->force,
                        .changed = span->held ? &changed : NULL};
        tl_parallel_for(m->pool, span->group_end - span->group_begin, GROUP_CHUNK, force_range, &job);
        span->changed = changed;
    }
    return report_failure(m, phase->failure);
}

tl_status tl_laws_check(tl_model *m)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    bool lawless = false; /* almost never: the contacts are then looked through for one to name */
    for (size_t r = 0; r < d->layout.span_count; r++)
        lawless = lawless || d->layout.spans[r].law == TL_NO_ROW;
    for (uint32_t i = 0; lawless && i < c->table.rows; i++) {
        if (c->law[i] != TL_NO_ROW || c->point_count[i] == 0 || c->held[i])
            continue;
        char name[320];
        tl_contact_describe(m, i, name, sizeof name);
        return tl_fail(&m->error, TL_E_STATE, "%s has no law: set one with %s or for that joint", name,
                       tl_words(m, "model:joint(\"*\", ...)", "tl_joint_law() for \"*\""));
    }
    return TL_OK;
}
