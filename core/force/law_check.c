/* law_check.c - what a law may return: states that are numbers, a shear force in the common plane, and no more stiffness
 * than it says.
 *
 * The time step follows from stiffness(), so a law that is stiffer blows the model up, which looks like a fault of
 * anything but the law. A contact that begins to carry is therefore asked: its points are given to the law again, as
 * copies, at rest and moved a little, and the rise of the forces is compared with what stiffness() says. That happens
 * where it matters, at the contact's own closure and states, and again whenever the contact has parted, which
 * an unstable one does.
 *
 * States are looked at in every step and shear forces in every eighth, by sums over points (laws.c); what these find
 * is looked at here, point by point. */

#include "force/law_check.h"

#include "base/columns.h"
#include "base/inside.h"
#include "contact/detection.h"
#include "contact/points.h"
#include "force/joint_laws.h"

#include <stdio.h>
#include <talus/number.h>

/* Component of a point's shear force along the normal, relative to the force of a spring pressed by the block's size: forces
 * below are rounding, of any direction. */
#define ROUNDING_FORCE 1e-12

/* How many times stiffer than its word a law may be. Up to this a step that is unstable is the fraction's fault, not
 * the law's, and a law that gives a mean for a bound passes. */
#define FAR_STIFFER 10
/* Motion of the trial, of the closure and last motion of the point: small against what the force came about by. */
#define TRIAL (1. / 16)

/* Copies of what a law gets and gives, of the points of a SIMD group side by side. */
typedef struct trial {
    _Alignas(TL_ALIGN) double area[TL_LANES];
    double closure[TL_LANES], f_n0[TL_LANES], normal[3][TL_LANES];
    double du_n[TL_LANES], du_s[3][TL_LANES], f_n[TL_LANES], f_s[3][TL_LANES];
    double state[TL_STATE_COLUMNS][TL_LANES], stored[TL_LANES], dissipated[TL_LANES];
    double apart[TL_LANES];
    _Alignas(TL_ALIGN) uint32_t flags[TL_LANES];
} trial;

/* One place of each contact of a SIMD group: the row of its first point, and its lane. */
typedef struct place {
    const tl_model *m;
    const tl_law *law;
    const tl_point_lanes *lanes;
    size_t row, lane;
} place;

static void copy_points(const place *at, trial *t)
{
    const tl_points_table *p = &at->m->detect->points;
    for (size_t l = 0; l < TL_LANES; l++) {
        size_t i = at->row + l, k = at->lane + l;
        t->area[l] = p->area[i];
        t->closure[l] = at->lanes->closure[k];
        t->f_n0[l] = p->f_n0 ? p->f_n0[i] : 0;
        t->f_n[l] = p->f_n[i];
        t->flags[l] = p->flags[i];
        t->du_n[l] = t->stored[l] = t->dissipated[l] = t->apart[l] = 0;
        for (int c = 0; c < 3; c++) {
            t->normal[c][l] = at->lanes->normal[c][k];
            t->f_s[c][l] = p->f_s[c][i];
            t->du_s[c][l] = 0;
        }
        for (uint32_t c = 0; c < TL_STATE_COLUMNS; c++)
            t->state[c][l] = c < p->state_columns ? p->state[c][i] : 0;
    }
}

static void put_lane(double (*columns)[TL_LANES], size_t l, tl_vec3 v)
{
    columns[0][l] = v.x;
    columns[1][l] = v.y;
    columns[2][l] = v.z;
}

static bool call(const place *at, trial *t)
{
    const tl_law_ops *ops = at->law->kind->ops;
    double *state[TL_STATE_COLUMNS];
    for (int c = 0; c < TL_STATE_COLUMNS; c++)
        state[c] = t->state[c];
    tl_law_batch batch = {.size = sizeof batch,
                          .count = TL_LANES,
                          .dt = at->m->dt,
                          .area = t->area,
                          .closure = t->closure,
                          .f_n0 = t->f_n0,
                          .normal = {t->normal[0], t->normal[1], t->normal[2]},
                          .du_n = t->du_n,
                          .du_s = {t->du_s[0], t->du_s[1], t->du_s[2]},
                          .f_n = t->f_n,
                          .f_s = {t->f_s[0], t->f_s[1], t->f_s[2]},
                          .state = state,
                          .flags = t->flags,
                          .stored = t->stored,
                          .dissipated = t->dissipated,
                          .closure_edge = t->closure,
                          .closure_apart = t->apart};
    tl_report report = {.size = sizeof report};
    tl_enter(at->law->kind, "update");
    tl_status status = ops->update(at->law->self, &batch, &report);
    tl_leave();
    return status == TL_OK;
}

/* Forces of the points, from where they are, moved by `move` m along the normal, or along `slide` where it is given. */
static bool try_law(const place *at, const double *move, const tl_vec3 *slide, trial *t)
{
    copy_points(at, t);
    for (size_t l = 0; l < TL_LANES; l++) {
        t->closure[l] += slide ? 0 : move[l];
        t->du_n[l] = slide ? 0 : -move[l];
        put_lane(t->du_s, l, slide ? tl_v3_scale(move[l], slide[l]) : tl_v3(0, 0, 0));
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
    if (!try_law(at, none, NULL, &rest) || !try_law(at, move, NULL, &pressed) ||
        !try_law(at, move, slide, &slid))
        return false;
    for (size_t l = 0; l < TL_LANES; l++) {
        double area = rest.area[l];
        found->normal[l] = found->shear[l] = 0;
        if (!(area > 0) || !(move[l] > 0))
            continue;
        tl_vec3 before = tl_v3(rest.f_s[0][l], rest.f_s[1][l], rest.f_s[2][l]);
        tl_vec3 after = tl_v3(slid.f_s[0][l], slid.f_s[1][l], slid.f_s[2][l]);
        found->normal[l] = (pressed.f_n[l] - rest.f_n[l]) / (area * move[l]);
        found->shear[l] = tl_v3_dot(tl_v3_sub(before, after), slide[l]) / (area * move[l]);
    }
    return true;
}

/* Names the first point that is far stiffer than its law says. */
static void compare(tl_failure *failure, const tl_law *law, const tl_simd_group *group, size_t row,
                    const slopes *found)
{
    for (size_t l = 0; l < TL_LANES; l++) {
        bool shear = found->shear[l] > found->normal[l];
        double stiffness = shear ? found->shear[l] : found->normal[l];
        char text[240];
        if (!(stiffness > FAR_STIFFER * tl_law_stiffness(law)) || isinf(stiffness))
            continue; /* where a trial leaves the range of numbers it tells nothing */
        tl_text_print(
            text, sizeof text,
            "its %s force rises by %.3g Pa/m here, and its stiffness() gives kn = %.3g and ks "
            "= %.3g Pa/m, from "
            "which the time step follows: they must be upper bounds, or the step is unstable",
            shear ? "shear" : "normal", stiffness, law->kn, law->ks);
        tl_failure_note(failure, group->start, TL_E_PLUGIN, row + l, text);
    }
}

void tl_law_check_stiffness(const tl_model *m, tl_failure *failure, const tl_law *law,
                            const tl_simd_group *group, const tl_point_lanes *lanes, size_t lane,
                            unsigned begins)
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
            slide[l] = length > 0 ? tl_v3_unit(du_s)
                                  : tl_v3_perpendicular(tl_columns_get(lanes->normal, i));
            move[l] = begins >> l & 1
                          ? TRIAL * (fabs(lanes->closure[i]) + fabs(lanes->du_n[i]) + length)
                          : 0;
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
        put_lane(t.f_s, l, f);
        put_lane(t.du_s, l, du_s);
        t.du_n[l] = at->lanes->du_n[at->lane + l];
    }
    if (!call(at, &t))
        return false;
    for (size_t l = 0; l < TL_LANES; l++)
        along[l] = fabs(t.f_s[0][l] * t.normal[0][l] + t.f_s[1][l] * t.normal[1][l] +
                        t.f_s[2][l] * t.normal[2][l]);
    return true;
}

/* Whether `along` N is a component along the normal that a shear force in point `row` of contact c must not have. */
static bool is_out_of_plane(const tl_model *m, const tl_law *law, uint32_t c, size_t row,
                            double along)
{
    const tl_points_table *p = &m->detect->points;
    const tl_contacts *contacts = &m->detect->contacts;
    double size = fmin(m->blocks.size[contacts->a[c]], m->blocks.size[contacts->b[c]]);
    double spring = tl_law_stiffness(law) * p->area[row] * size;
    double force = tl_v3_norm(tl_columns_get(p->f_s, row)) + fabs(p->f_n[row]);
    return along > TL_OUT_OF_PLANE * force && along > ROUNDING_FORCE * spring;
}

void tl_law_check_shear(const tl_model *m, tl_failure *failure, const tl_law *law,
                        const tl_simd_group *group, const tl_point_lanes *lanes, size_t lane)
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
        tl_text_print(
            text, sizeof text,
            "its shear force of %.3g N has a component of %.3g N along the normal: it must "
            "lie in the common plane, to %g of the force",
            tl_v3_norm(f), along, TL_OUT_OF_PLANE);
        tl_failure_note(failure, group->start, TL_E_PLUGIN, row, text);
    }
}

/* What the law was given for a point, and what it made of it. */
typedef struct point_told {
    double closure, motion, normal, shear;
} point_told;

static point_told told_of(const tl_points_table *p, const tl_point_lanes *lanes, size_t row,
                          size_t lane)
{
    double slip = tl_v3_norm(tl_columns_get(lanes->du_s, lane));
    return (point_told){lanes->closure[lane], fabs(lanes->du_n[lane]) + slip, p->f_n[row],
                        tl_v3_norm(tl_columns_get(p->f_s, row))};
}

void tl_law_check_forces(const tl_model *m, tl_failure *failure, const tl_law *law,
                         const tl_simd_group *group, const tl_point_lanes *lanes, size_t lane,
                         size_t contact)
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
            tl_text_print(
                text, sizeof text,
                "the force is not a finite number: those of its points are, up to %.3g N, but "
                "not their sum or moment; with kn = %.3g and ks = %.3g Pa/m, is a property "
                "out of proportion?",
                largest, law->kn, law->ks);
            continue;
        }
        tl_text_print(
            text, sizeof text,
            "the force is not a finite number: %s a normal force of %.3g N and a shear force "
            "of %.3g N for a closure of %.3g m, a motion of %.3g m in the last step and an "
            "area of %.3g m2: look at %s",
            sound ? "the law gives" : "it is", at.normal, at.shear, at.closure, at.motion,
            p->area[row], sound ? "its properties" : "places and velocities of the blocks");
        break;
    }
    row = row < group->start + group->slots * TL_LANES ? row : group->start + contact;
    tl_failure_note(failure, group->start, TL_E_NUMERIC, row, text);
}

/* Name of the state whose column it is. */
static const char *state_name(const tl_kind *kind, uint32_t column)
{
    uint32_t at = 0;
    for (uint32_t k = 0; k < kind->state_count; k++) {
        at += tl_kind_state(kind, k)->kind == TL_STATE_TANGENT ? 3 : 1;
        if (column < at)
            return tl_kind_state(kind, k)->name;
    }
    return "?";
}

void tl_law_check_states(const tl_model *m, tl_failure *failure, const tl_law *law, size_t first,
                         size_t count)
{
    const tl_points_table *p = &m->detect->points;
    for (uint32_t c = 0; c < law->columns; c++)
        for (size_t i = first; i < first + count; i++) {
            char text[200];
            if (isfinite(p->state[c][i]) || !(p->area[i] > 0))
                continue;
            tl_text_print(text, sizeof text,
                          "it leaves %g in its state '%.40s', which must be a finite number",
                          p->state[c][i], state_name(law->kind, c));
            tl_failure_note(failure, first, TL_E_PLUGIN, i, text);
            return;
        }
}
