/* renew.c - the patches of a SIMD group made anew at once, a contact in each lane.
 *
 * Most contacts are two faces on each other and stay so. What eight of them need is laid side by side (patch_batch.c)
 * and comes out as the SIMD group has its points: slot by slot. Lanes whose polygon has changed, and contacts that are
 * something else, are brought up to date one by one (update.c). */
#include "detect/renew.h"

#include "base/columns.h"
#include "contact/detection.h"
#include "contact/places.h"
#include "contact/shear.h"
#include "detect/fields.h"
#include "detect/update.h"
#include "narrow/flush.h"
#include "narrow/patch_batch.h"
#include "narrow/press.h"

#include <string.h>

/* Adds a contact's pair of faces to a batch; false when they are none for it. `corners`: the batch has points at corners only. */
static bool add_to_batch(tl_model *m, uint32_t c, uint32_t lane, bool corners,
                         tl_patch_batch *batch)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_facet *f = &contacts->facet[c];
    uint32_t a = contacts->a[c], b = contacts->b[c];
    if (!tl_contact_is_patch(m, c) ||
        (corners && !tl_at_corners(m->blocks.shape[a], f->ia, m->blocks.shape[b], f->ib)) ||
        !tl_batch_takes(m->blocks.shape[a], f->ia, m->blocks.shape[b], f->ib))
        return false;
    double size = m->blocks.size[a] < m->blocks.size[b] ? m->blocks.size[a] : m->blocks.size[b];
    tl_batch_add(batch, lane, m->blocks.shape[a], f->ia, m->blocks.shape[b], f->ib, size,
                 contacts->holds_over_gap[c] ? INFINITY
                                             : TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * size);
    uint32_t body_a = m->blocks.body[a], body_b = m->blocks.body[b];
    tl_batch_between(batch, lane, &m->bodies.pose[body_a].r, &m->bodies.pose[body_b].r,
                     tl_body_apart(&m->bodies, body_a, body_b));
    return true;
}

/* Lanes whose patch takes the place of the contact's, 1 or 0, and the area it gets. */
typedef struct patch_choice {
    double mine[TL_LANES], area[TL_LANES];
} patch_choice;

TL_INLINE double choose(double yes, double a, double b)
{
    return yes > 0 ? a : b;
}

/* Puts a point of each lane that is taken in the place of the table's: stress stays, force follows the area. */
TL_VECTORIZED static void refit_slot(tl_points_table *p, size_t row, const tl_batch_point *point,
                                     patch_choice *restrict t)
{
    double *restrict x = p->p[0] + row, *restrict y = p->p[1] + row, *restrict z = p->p[2] + row;
    double *restrict f_x = p->f_s[0] + row, *restrict f_y = p->f_s[1] + row;
    double *restrict f_z = p->f_s[2] + row, *restrict f_n = p->f_n + row;
    double *restrict area = p->area + row, scale[TL_LANES];
#pragma omp simd
    for (uint32_t l = 0; l < TL_LANES; l++) {
        double old = area[l], now = choose(t->mine[l], point->area[l], old);
        double by = choose(t->mine[l], now / choose(t->mine[l], old, 1), 1);
        x[l] = choose(t->mine[l], point->p.x[l], x[l]);
        y[l] = choose(t->mine[l], point->p.y[l], y[l]);
        z[l] = choose(t->mine[l], point->p.z[l], z[l]);
        f_x[l] *= by;
        f_y[l] *= by;
        f_z[l] *= by;
        f_n[l] *= by;
        area[l] = now;
        t->area[l] += now;
        scale[l] = by;
    }
    for (uint32_t l = 0; l < TL_LANES && p->f_n0; l++)
        p->f_n0[row + l] *= scale[l];
}

/* Puts the patches of the lanes that are taken, which all have so many points, in the place of the contacts'. */
static void refit(tl_points_table *p, size_t row, const tl_patch_batch *batch, tl_batch_counts n,
                  patch_choice *t)
{
    for (uint32_t l = 0; l < TL_LANES; l++)
        t->area[l] = 0;
    for (uint32_t k = 0; k < n.middles; k++, row += TL_LANES)
        refit_slot(p, row, &batch->middles[k], t);
    for (uint32_t k = 0; k < n.corners; k++, row += TL_LANES)
        refit_slot(p, row, &batch->corners[k], t);
    if (n.centroid)
        refit_slot(p, row, &batch->centroid, t);
}

/* The shear of the points of a SIMD group, summed over those of each lane: energy times 2 ks, and force. */
typedef struct shear_lanes {
    double energy[TL_LANES];
    tl_lanes3 force;
} shear_lanes;

TL_VECTORIZED static void sum_shear(const tl_points_table *p, size_t row, uint32_t slots,
                                    shear_lanes *restrict out)
{
    const double *restrict f_x = p->f_s[0] + row, *restrict f_y = p->f_s[1] + row;
    const double *restrict f_z = p->f_s[2] + row, *restrict area = p->area + row;
    shear_lanes sum = {0};
    for (size_t at = 0; at < (size_t)slots * TL_LANES; at += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            double x = f_x[at + l], y = f_y[at + l], z = f_z[at + l];
            sum.force.x[l] += x;
            sum.force.y[l] += y;
            sum.force.z[l] += z;
            sum.energy[l] += (x * x + y * y + z * z) / choose(area[at + l], area[at + l], 1);
        }
    *out = sum;
}

/* Lanes whose area is to change, a bit each. */
static uint32_t changing(const tl_contacts *contacts, const tl_simd_group *group,
                         const tl_patch_batch *batch, uint32_t now)
{
    uint32_t changed = 0;
    for (uint32_t l = 0; l < TL_LANES; l++)
        if (now >> l & 1) {
            double area = contacts->area[group->contact[l]];
            changed |= (uint32_t)(fabs(batch->area[l] - area) > TL_SAME_AREA * area) << l;
        }
    return changed;
}

/* The shear of lane l. All of it acts at the centroid: an area that changes by as little as those of a batch takes no
 * more of a twist's heat than goes unseen. */
static tl_shear shear_in(const shear_lanes *s, const tl_patch_batch *batch, uint32_t l, double area)
{
    tl_mat3 turn = tl_lanes9_get(&batch->r_a, l);
    tl_vec3 arm = tl_m3_mul(&turn, tl_lanes3_get(&batch->centroid.p, l));
    tl_vec3 force = tl_lanes3_get(&s->force, l);
    return (tl_shear){area, s->energy[l], force, tl_v3_cross(arm, force)};
}

/* What else a contact keeps of its patch. */
static void note_patch(tl_model *m, uint32_t c, const tl_patch_batch *batch, uint32_t l,
                       double area)
{
    tl_contacts *contacts = &m->detect->contacts;
    contacts->area[c] = area;
    contacts->facet[c].ride = batch->ride[l];
    contacts->facet[c].laid.turn = tl_lanes9_get(&batch->turn, l);
    contacts->facet[c].laid.shift = tl_lanes3_get(&batch->shift, l);
    contacts->new_points[c] = TL_POINTS_PLACED;
    tl_contact_allow_reuse(m, c);
}

/* Puts the patches of some lanes, a bit each, into the place of their contacts'. */
static void take_lanes(tl_model *m, const tl_simd_group *group, const tl_patch_batch *batch,
                       tl_batch_counts n, uint32_t now, patch_choice *t)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    uint32_t changed = changing(contacts, group, batch, now);
    shear_lanes before, after;
    if (changed)
        sum_shear(p, group->start, n.all, &before);
    refit(p, group->start, batch, n, t);
    if (changed)
        sum_shear(p, group->start, n.all, &after);
    for (uint32_t l = 0; l < TL_LANES; l++) {
        uint32_t c = group->contact[l];
        if (changed >> l & 1) {
            tl_shear old = shear_in(&before, batch, l, contacts->area[c]);
            tl_shear fresh = shear_in(&after, batch, l, t->area[l]);
            tl_shear_resized(m, c, &old, &fresh);
        }
        if (now >> l & 1)
            note_patch(m, c, batch, l, t->area[l]);
    }
}

static bool have_run(const tl_model *m, uint32_t c, const tl_patch_batch *batch, uint32_t l,
                     tl_batch_counts n)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_pair_pose now = {tl_lanes9_get(&batch->turn, l), tl_lanes3_get(&batch->shift, l)};
    tl_contact_run run = tl_contact_run_to(&contacts->facet[c], &now);
    for (uint32_t k = 0; k < n.all; k++) {
        const tl_batch_point *point = k < n.middles               ? &batch->middles[k]
                                      : k < n.middles + n.corners ? &batch->corners[k - n.middles]
                                                                  : &batch->centroid;
        tl_contact_run_add(&run, tl_columns_get(m->detect->points.p, tl_point_row(contacts, c, k)),
                           tl_lanes3_get(&point->p, l));
    }
    return tl_contact_has_run(&run, batch->near[l]);
}

/* Puts patches into the place of those of the SIMD group that have the same points, and takes their lanes out of `in`: lanes
 * of as many points together. */
static void take_patches(tl_model *m, const tl_simd_group *group, const tl_patch_batch *batch,
                         uint32_t *in)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    tl_batch_counts n[TL_LANES];
    uint32_t same = 0;
    for (uint32_t l = 0; l < TL_LANES; l++) {
        if (!(*in >> l & 1) || !batch->laid[l])
            continue;
        n[l] = tl_batch_count(batch, l);
        if (n[l].all == contacts->point_count[group->contact[l]] &&
            tl_batch_has_keys(batch, l, n[l], p->key + group->start + l, TL_LANES) &&
            !have_run(m, group->contact[l], batch, l, n[l]))
            same |= 1u << l;
    }
    *in &= ~same;
    for (uint32_t l = 0; same; l++) {
        patch_choice t;
        uint32_t now = 0;
        for (uint32_t k = 0; k < TL_LANES; k++) {
            bool like = same >> k & 1 && same >> l & 1 && n[k].all == n[l].all &&
                        n[k].corners == n[l].corners;
            t.mine[k] = like;
            now |= (uint32_t)like << k;
        }
        if (!now)
            continue;
        take_lanes(m, group, batch, n[l], now, &t);
        same &= ~now;
    }
}

bool tl_simd_group_update(tl_model *m, const tl_simd_group *group, unsigned thread)
{
    tl_patch_batch *batch = NULL;
    bool any = false;
    uint32_t in = 0, others = 0, fields[TL_LANES], field_count = 0;
    bool corners = m->config.contact_points == TL_POINTS_CORNERS;
    double tilt = tl_flush_limits_of(corners).points_tilt, steep = tilt * tilt;
    for (uint32_t l = 0; l < TL_LANES; l++) {
        uint32_t c = group->contact[l];
        if (c == TL_NO_ROW || tl_contact_points_hold(m, c))
            continue;
        any = true;
        if (tl_field_goes_on(m, c)) {
            fields[field_count++] = c;
            continue;
        }
        if (!batch && !(batch = tl_batch_begin(&m->detect->narrow[thread], corners, steep))) {
            m->detect->narrow[thread].failed = true;
            return true;
        }
        if (add_to_batch(m, c, l, corners, batch))
            in |= 1u << l;
        else
            others |= 1u << l;
    }
    if (in) {
        tl_batch_lay(batch);
        take_patches(m, group, batch, &in);
    }
    for (uint32_t l = 0; l < TL_LANES; l++)
        if ((in | others) >> l & 1)
            tl_contact_update(m, group->contact[l], thread);
    if (field_count)
        tl_contacts_follow(m, fields, field_count, thread);
    return any;
}
