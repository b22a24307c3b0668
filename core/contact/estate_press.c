/* estate_press.c - the parts of a patch that slip has opened press as the whole did.
 *
 * Slip opens each point of a patch by another way, and where its stiff walls are held apart by a few of its points, what is between the
 * others is open. The parts' points lie elsewhere: between the points of the whole, where nothing is known. So of the closures
 *
 *     c(x) + q . (1, x, y)
 *
 * of all parts' points together, c as it lies between the points of the whole, that q is taken with which the closures of what is
 * closed have the sum over the area that they had, and, where all points of the whole were closed, the same moments: few points
 * that bear all say little of how closures change between the others. This is the least of a convex function of q, found by
 * Newton's steps. */
#include "contact/estate_press.h"

#include "base/columns.h"
#include "contact/across_gap.h"
#include "contact/estate.h"
#include "contact/places.h"
#include "model/inertia.h"

#include <math.h>

/* Steps that are made at the most: each finds which points are closed, and few of them change. */
#define STEPS 30
/* Error that is none, over the sum. */
#define EXACT 1e-12
/* What a closure adds to the sum where it is open, over what it adds where it is closed: so little that it only says which way to go where
 * too few points are closed. */
#define FAINT 1e-9
/* Areas that are the same, over each other: parts that lack some of the whole go by what is between its points alone. */
#define SAME 1e-3

static tl_vec3 basis(const tl_pressing *p, tl_vec3 place)
{
    tl_vec3 arm = tl_v3_sub(place, p->centre);
    return tl_v3(1, tl_v3_dot(arm, p->along[0]), tl_v3_dot(arm, p->along[1]));
}

/* What the whole pressed with. */
static void measure_whole(const tl_detect *d, const tl_estate *estate, tl_pressing *p)
{
    const tl_old_point *points = &d->left_points[estate->first];
    *p = (tl_pressing){.error = INFINITY};
    for (size_t k = 0; k < estate->count; k++) {
        p->area += points[k].area;
        p->centre = tl_v3_madd(p->centre, points[k].area, points[k].arm);
    }
    p->centre = tl_v3_scale(p->area > 0 ? 1 / p->area : 0, p->centre);
    bool closed = p->area > 0;
    for (size_t k = 0; k < estate->count; k++)
        closed = closed && points[k].closure > 0;
    if (closed) {
        p->along[0] = tl_v3_scale(1 / sqrt(p->area), tl_v3_perpendicular(estate->face[0]));
        p->along[1] = tl_v3_cross(estate->face[0], p->along[0]);
    }
    for (size_t k = 0; k < estate->count; k++)
        p->whole = tl_v3_madd(p->whole, points[k].area * fmax(0, points[k].closure),
                              basis(p, points[k].arm));
}

/* Calls what is to be done for each point of the patches that have taken over from one that slip has opened, with the place of the point,
 * its closure, and its row. */
static void for_points(tl_model *m,
                       void (*visit)(tl_model *m, tl_pressing *p, tl_vec3 at, double c, size_t i))
{
    const tl_detect *d = m->detect;
    const tl_contacts *contacts = &d->contacts;
    const tl_point_lanes *lanes = &d->lanes[0];
    double lift[TL_LANES];
    for (uint32_t c = 0; c < contacts->table.rows; c++) {
        tl_estate *estate = tl_estate_taken(m, c);
        if (!estate || !estate->opened)
            continue;
        tl_vec3 from = tl_body_place(&m->bodies, m->blocks.body[contacts->a[c]]);
        tl_contact_places(m, c, lanes);
        for (size_t k = 0; k < contacts->point_count[c]; k++) {
            if (k % TL_LANES == 0)
                tl_contact_point_lifts(m, c, k, lift);
            visit(m, &d->pressings[estate - d->estates],
                  tl_v3_add(from, tl_columns_get(lanes->arm, k)),
                  lanes->closure[k] + lift[k % TL_LANES], tl_point_row(contacts, c, k));
        }
    }
}

/* Adds a point to the sums. */
static void add_point(tl_model *m, tl_pressing *p, tl_vec3 at, double c, size_t i)
{
    tl_vec3 by = basis(p, at);
    double area = m->detect->points.area[i], closure = c + tl_v3_dot(p->more, by);
    double share = area * (closure > 0 ? 1 : FAINT);
    p->taken += area;
    p->parts = tl_v3_madd(p->parts, closure > 0 ? area * closure : 0, by);
    p->rise[0] = tl_v3_madd(p->rise[0], share, by);
    p->rise[1] = tl_v3_madd(p->rise[1], share * by.y, by);
    p->rise[2] = tl_v3_madd(p->rise[2], share * by.z, by);
}

/* Gives a point the closure that has been found, in its reference. */
static void give_point(tl_model *m, tl_pressing *p, tl_vec3 at, double c, size_t i)
{
    (void)c;
    m->detect->points.reference[i] -= tl_v3_dot(p->best, basis(p, at));
}

/* Keeps `more` if its error is the least, and makes it better by Newton's step. true: it is not exact yet. */
static bool improve(tl_pressing *p)
{
    tl_vec3 lacks = tl_v3_sub(p->whole, p->parts);
    double error = tl_v3_norm(lacks);
    if (!(fabs(p->taken - p->area) < SAME * p->area))
        return false;
    if (error < p->error) {
        p->error = error;
        p->best = p->more;
    }
    for (int k = 0; k < 3; k++)
        p->rise[k] = tl_v3_madd(p->rise[k], FAINT * p->area, tl_v3(k == 0, k == 1, k == 2));
    p->more = tl_v3_add(p->more, tl_solve3(p->rise[0], p->rise[1], p->rise[2], lacks));
    return error > EXACT * p->whole.x;
}

bool tl_estates_press_reserve(tl_detect *d)
{
    return tl_fit(&d->pressings, &d->pressing_capacity, d->estate_count, sizeof *d->pressings);
}

void tl_estates_press(tl_model *m)
{
    tl_detect *d = m->detect;
    bool any = false;
    for (size_t i = 0; i < d->estate_count; i++) {
        any = any || d->estates[i].opened;
        measure_whole(d, &d->estates[i], &d->pressings[i]);
    }
    if (!d->points.reference)
        return;
    for (int step = 0; any && step < STEPS; step++) {
        for (size_t i = 0; i < d->estate_count; i++) {
            tl_pressing *p = &d->pressings[i];
            p->taken = 0;
            p->parts = p->rise[0] = p->rise[1] = p->rise[2] = tl_v3(0, 0, 0);
        }
        for_points(m, add_point);
        any = false;
        for (size_t i = 0; i < d->estate_count; i++)
            any = (d->estates[i].opened && improve(&d->pressings[i])) || any;
    }
    for_points(m, give_point);
}
