/* bear.c - what a law bears at the points of a contact.
 *
 * The law is asked as in a step, with copies of the points: initial normal forces and shear forces are those that are
 * given, the closure counts from the present place and nothing moves. What it gives back is what it bears.
 *
 * A law whose slip opens the joint answers to more shear than it bears by slipping, and so presses more than is given:
 * as much more as was asked for too much. No wall has moved, so that is none of what it bears. Such points are asked
 * again for a share of the shear, until they press as is given: the surplus goes with the share in a line for a law
 * that is linear, and is squeezed in for others. */
#include "force/bear.h"

#include "base/columns.h"
#include "contact/detection.h"
#include "contact/places.h"
#include "force/joint_laws.h"

/* Tolerance: share of a normal force that a law may add to it by rounding. */
#define SAME_FORCE 1e-12
/* Tolerance: how often points are asked again, at the most, and a share of the shear that is found. */
#define MOST_ASKED 12
#define FOUND 1e-10

/* Columns of lanes of points that are asked again, shares of the shear: asked for, the largest borne, the least not
 * borne; and by how much the law pressed more at that. */
typedef struct shares {
    double *now, *borne, *beyond, *surplus;
} shares;

static shares shares_of(const tl_point_lanes *l)
{
    return (shares){l->lift, l->hold, l->apart, l->arm[1]};
}

/* The columns of lanes in which the copies are: those in which a law's forces are noted elsewhere, and the arms. */
static void copy_points(const tl_model *m, uint32_t c, const tl_traction *given, const tl_point_lanes *l, size_t lanes)
{
    const tl_detect *d = m->detect;
    const tl_points_table *p = &d->points;
    for (size_t k = 0; k < lanes; k++) {
        bool there = k < d->contacts.point_count[c];
        size_t i = there ? tl_point_row(&d->contacts, c, k) : 0;
        double area = there ? p->area[i] : 0;
        double part = there ? area * shares_of(l).now[k] : 0;
        tl_vec3 shear = there ? tl_v3_scale(part, given[k].shear) : tl_v3(0, 0, 0);
        l->arm[0][k] = area;
        l->edge[k] = there ? area * given[k].normal : 0;
        l->before[0][k] = l->edge[k];
        tl_columns_put(&l->before[1], k, shear);
        tl_columns_put(l->du_s, k, tl_v3(0, 0, 0));
        l->closure[k] = l->du_n[k] = l->stored[k] = l->dissipated[k] = 0;
        l->flags_before[k] = there ? p->flags[i] : 0;
        for (uint32_t s = 0; s < TL_STATE_COLUMNS; s++)
            l->before[4 + s][k] = there && s < p->state_columns ? p->state[s][i] : 0;
        for (int axis = 0; axis < 3 && !there; axis++)
            l->normal[axis][k] = l->normal[axis][0];
    }
}

/* Asks the law for the shares of the shear. */
static bool ask(const tl_model *m, uint32_t c, const tl_traction *given, tl_traction *borne, double *stored)
{
    const tl_detect *d = m->detect;
    const tl_point_lanes *l = &d->lanes[0];
    const tl_law *law = &m->joint_laws[d->contacts.law[c]];
    size_t count = d->contacts.point_count[c], lanes = (count + TL_LANES - 1) / TL_LANES * TL_LANES;
    copy_points(m, c, given, l, lanes);
    tl_law_batch batch = tl_lanes_batch(m, l, lanes);
    batch.area = l->arm[0];
    batch.f_n0 = l->edge;
    batch.closure_edge = batch.closure_apart = l->closure; /* none: 0 as well */
    tl_report report;
    tl_status status = tl_law_update(law, &batch, &report);
    *stored = 0;
    for (size_t k = 0; k < count && status == TL_OK; k++) {
        double area = l->arm[0][k], per = area > 0 ? 1 / area : 0;
        borne[k].normal = per * l->before[0][k];
        borne[k].shear = tl_v3_scale(per, tl_columns_get(&l->before[1], k));
        *stored += l->stored[k];
        if (!isfinite(borne[k].normal) || !tl_v3_finite(borne[k].shear))
            return false;
    }
    return status == TL_OK;
}

/* By how much a point presses more than is given. */
static double surplus_of(const tl_traction *given, const tl_traction *borne)
{
    double press = fmax(given->normal, 0), more = borne->normal - press;
    return more > SAME_FORCE * borne->normal ? more : 0;
}

/* The first shares to ask for again, from what the whole has come to; how many points press more than is given. A
 * strength that goes with the pressure falls to that of the given one; any more that it has is found. */
static size_t begin_shares(const tl_traction *given, const tl_traction *borne, size_t count, const shares *s)
{
    size_t left = 0;
    for (size_t k = 0; k < count; k++) {
        double surplus = surplus_of(&given[k], &borne[k]), size = tl_v3_norm(given[k].shear);
        if (!(surplus > 0) || !(size > 0))
            continue;
        double falls = fmax(given[k].normal, 0) / borne[k].normal;
        s->borne[k] = fmin(1, falls * tl_v3_norm(borne[k].shear) / size);
        s->beyond[k] = 1;
        s->surplus[k] = surplus;
        s->now[k] = 0.5 * (s->borne[k] + 1);
        left++;
    }
    return left;
}

/* The next shares, from what the last have come to; how many are not found. */
static size_t next_shares(const tl_traction *given, const tl_traction *borne, size_t count, const shares *s)
{
    size_t left = 0;
    for (size_t k = 0; k < count; k++) {
        if (!(s->beyond[k] - s->borne[k] > FOUND))
            continue;
        double surplus = surplus_of(&given[k], &borne[k]), now = s->now[k], line = NAN;
        if (surplus > 0) {
            line = now - surplus * (s->beyond[k] - now) / (s->surplus[k] - surplus);
            s->beyond[k] = now;
            s->surplus[k] = surplus;
        } else {
            s->borne[k] = now;
        }
        double least = s->borne[k], most = s->beyond[k];
        s->now[k] = line >= least && line < most ? line : 0.5 * (least + most);
        left++;
    }
    return left;
}

bool tl_contact_bear(const tl_model *m, uint32_t c, const tl_traction *given, tl_traction *borne, double *stored)
{
    const tl_point_lanes *l = &m->detect->lanes[0];
    size_t count = m->detect->contacts.point_count[c];
    const shares s = shares_of(l);
    tl_contact_places(m, c, l);
    for (size_t k = 0; k < count; k++)
        s.now[k] = s.borne[k] = s.beyond[k] = 1;
    if (!ask(m, c, given, borne, stored))
        return false;
    size_t left = begin_shares(given, borne, count, &s);
    if (left == 0)
        return true;
    for (int asked = 0; asked < MOST_ASKED && left > 0; asked++) {
        if (!ask(m, c, given, borne, stored))
            return false;
        left = next_shares(given, borne, count, &s);
    }
    for (size_t k = 0; k < count; k++)
        s.now[k] = s.borne[k];
    return ask(m, c, given, borne, stored);
}

/* Tolerance: times that a law is asked for the shear that there is: more than any law bears that has a limit. */
#define BEYOND 1e6
/* Points taken at a time: those of most contacts. */
enum { MOST_TOLD = 64 };

double tl_contact_shear_used(const tl_model *m, uint32_t c)
{
    const tl_detect *d = m->detect;
    const size_t all = d->contacts.point_count[c];
    const bool field = tl_facet_is_field(&d->contacts.facet[c]);
    tl_traction given[MOST_TOLD], borne[MOST_TOLD];
    double carried = 0, most = 0, stored;
    if (all == 0 || all > MOST_TOLD || d->contacts.law[c] == TL_NO_ROW)
        return NAN;
    for (size_t k = 0; k < all; k++) {
        const size_t i = tl_point_row(&d->contacts, c, k);
        const double per = d->points.area[i] > 0 ? 1 / d->points.area[i] : 0;
        const double times = field && k != TL_FIELD_SHEAR ? 0 : BEYOND * per; /* torsion is no shear */
        given[k] = (tl_traction){d->points.f_n[i] * per, tl_v3_scale(times, tl_columns_get(d->points.f_s, i))};
    }
    if (!tl_contact_bear(m, c, given, borne, &stored))
        return NAN;
    for (size_t k = 0; k < all; k++) {
        const double area = d->points.area[tl_point_row(&d->contacts, c, k)];
        carried += area * tl_v3_norm(given[k].shear) / BEYOND;
        most += area * tl_v3_norm(borne[k].shear);
    }
    /* a law that weakens may bear less than it has just carried */
    return carried > 0 && most < 0.5 * BEYOND * carried ? fmin(1, carried / most) : NAN;
}
