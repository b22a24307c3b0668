/* bear.c - what a law bears at the points of a contact.
 *
 * The law is asked as in a step, with copies of the points: initial normal forces and shear forces are those that are given, the
 * closure counts from the present place and nothing moves. What it gives back is what it bears. */
#include "force/bear.h"

#include "base/columns.h"
#include "base/inside.h"
#include "contact/detection.h"
#include "contact/places.h"

/* The columns of lanes in which the copies are: those in which a law's forces are noted elsewhere, and the arms. */
static void copy_points(const tl_model *m, uint32_t c, const tl_traction *given,
                        const tl_point_lanes *l, size_t lanes)
{
    const tl_detect *d = m->detect;
    const tl_points_table *p = &d->points;
    for (size_t k = 0; k < lanes; k++) {
        bool there = k < d->contacts.point_count[c];
        size_t i = there ? tl_point_row(&d->contacts, c, k) : 0;
        double area = there ? p->area[i] : 0;
        tl_vec3 shear = there ? tl_v3_scale(area, given[k].shear) : tl_v3(0, 0, 0);
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

bool tl_contact_bear(const tl_model *m, uint32_t c, const tl_traction *given, tl_traction *borne,
                     double *stored)
{
    const tl_detect *d = m->detect;
    const tl_point_lanes *l = &d->lanes[0];
    const tl_law *law = &m->joint_laws[d->contacts.law[c]];
    size_t count = d->contacts.point_count[c], lanes = (count + TL_LANES - 1) / TL_LANES * TL_LANES;
    tl_contact_places(m, c, l);
    copy_points(m, c, given, l, lanes);
    tl_law_batch batch = {.size = sizeof batch,
                          .count = (uint32_t)lanes,
                          .dt = m->dt,
                          .area = l->arm[0],
                          .closure = l->closure,
                          .f_n0 = l->edge,
                          .normal = {l->normal[0], l->normal[1], l->normal[2]},
                          .du_n = l->du_n,
                          .du_s = {l->du_s[0], l->du_s[1], l->du_s[2]},
                          .f_n = l->before[0],
                          .f_s = {l->before[1], l->before[2], l->before[3]},
                          .state = &l->before[4],
                          .flags = l->flags_before,
                          .stored = l->stored,
                          .dissipated = l->dissipated,
                          .closure_edge = l->closure,
                          .closure_apart = l->closure}; /* none: 0 as well */
    tl_report report = {.size = sizeof report};
    const tl_law_ops *ops = law->kind->ops;
    tl_enter(law->kind, "update");
    tl_status status = ops->update(law->self, &batch, &report);
    tl_leave();
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
