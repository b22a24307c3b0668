/* renew.c - the patches of a rank made anew at once, a contact in each lane.
 *
 * Most contacts are two faces on each other and stay so. What eight of them need is laid side by side (patch_batch.c)
 * and comes out as the rank has its points: slot by slot. Lanes whose polygon has changed, and contacts that are
 * something else, are brought up to date one by one (update.c). */
#include "detect/renew.h"

#include "contact/detection.h"
#include "contact/points.h"
#include "detect/update.h"
#include "narrow/manifold.h"
#include "narrow/patch_batch.h"

#include <string.h>

/* Adds a contact's pair of faces to a batch; false when they are none for it. */
static bool add_to_batch(const tl_model *m, uint32_t c, uint32_t lane, tl_patch_batch *batch)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_facet *f = &contacts->facet[contacts->facet_start[c]];
    uint32_t a = contacts->a[c], b = contacts->b[c];
    if (!tl_contact_is_patch(m, c) ||
        !tl_batch_takes(m->blocks.shape[a], f->ia, m->blocks.shape[b], f->ib) ||
        !isnan(tl_area_rule_of(m, contacts->tag[c]).absolute))
        return false;
    double size = m->blocks.size[a] < m->blocks.size[b] ? m->blocks.size[a] : m->blocks.size[b];
    tl_batch_add(batch, lane, m->blocks.shape[a], f->ia, m->blocks.shape[b], f->ib, size,
                 TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * size);
    uint32_t body_a = m->blocks.body[a], body_b = m->blocks.body[b];
    tl_batch_between(batch, lane, &m->bodies.pose[body_a].r, &m->bodies.pose[body_b].r,
                     tl_body_apart(&m->bodies, body_a, body_b));
    return true;
}

/* Lanes whose patch takes the place of the contact's, 1 or 0, and the area it gets. */
typedef struct taken {
    double mine[TL_LANES], area[TL_LANES];
    bool all;
} taken;

TL_INLINE double choose(double yes, double a, double b)
{
    return yes > 0 ? a : b;
}

TL_INLINE void refit_lean(int16_t *restrict steps, const float *restrict lean, float step)
{
#pragma omp simd
    for (uint32_t l = 0; l < TL_LANES; l++)
        steps[l] = tl_lean_steps(lean[l], step);
}

/* Puts a point of each lane that is taken in the place of the table's: stress stays, force follows the area. */
TL_VECTORIZED static void refit_slot(tl_points_table *p, size_t row, const tl_batch_point *point,
                                     taken *restrict t)
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
    if (t->all) {
        refit_lean(p->lean_face + row, point->face, TL_LEAN_FACE_STEP);
        refit_lean(p->lean_edge + row, point->edge, TL_LEAN_EDGE_STEP);
    }
    for (uint32_t l = 0; l < TL_LANES && !t->all; l++)
        if (t->mine[l] > 0)
            tl_point_set_lean(p, row + l, (tl_lean){point->face[l], point->edge[l]});
}

/* Puts the patches of the lanes that are taken, which all have so many points, in the place of the contacts'. */
static void refit(tl_points_table *p, size_t row, const tl_patch_batch *batch, tl_batch_counts n,
                  taken *t)
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

/* What else a contact keeps of its patch. */
static void note_patch(tl_model *m, uint32_t c, double area)
{
    tl_contacts *contacts = &m->detect->contacts;
    contacts->area[c] = area;
    contacts->fresh[c] = true;
    tl_contact_allow_reuse(m, c, false);
}

/* Puts patches into the place of those of the rank that have the same points, and takes their lanes out of `in`: lanes
 * of as many points together. */
static void take_patches(tl_model *m, const tl_rank *rank, const tl_patch_batch *batch,
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
        if (n[l].all == contacts->point_count[rank->contact[l]] &&
            tl_batch_has_keys(batch, l, n[l], p->key + rank->start + l, TL_LANES))
            same |= 1u << l;
    }
    *in &= ~same;
    for (uint32_t l = 0; same; l++) {
        taken t;
        uint32_t now = 0;
        for (uint32_t k = 0; k < TL_LANES; k++) {
            bool like = same >> k & 1 && same >> l & 1 && n[k].all == n[l].all &&
                        n[k].corners == n[l].corners;
            t.mine[k] = like;
            now |= (uint32_t)like << k;
        }
        if (!now)
            continue;
        t.all = now == (1u << TL_LANES) - 1;
        refit(p, rank->start, batch, n[l], &t);
        for (uint32_t k = 0; k < TL_LANES; k++)
            if (now >> k & 1)
                note_patch(m, rank->contact[k], t.area[k]);
        same &= ~now;
    }
}

bool tl_rank_update(tl_model *m, const tl_rank *rank, unsigned thread)
{
    tl_patch_batch *batch = NULL;
    uint32_t in = 0, others = 0;
    for (uint32_t l = 0; l < TL_LANES; l++) {
        uint32_t c = rank->contact[l];
        if (c == TL_NO_ROW || tl_contact_stands(m, c))
            continue;
        if (!batch && !(batch = tl_batch_room(&m->detect->narrow[thread],
                                              m->config.contact_points == TL_POINTS_CORNERS,
                                              TL_FLUSH_TILT2))) {
            m->detect->narrow[thread].failed = true;
            return true;
        }
        if (add_to_batch(m, c, l, batch))
            in |= 1u << l;
        else
            others |= 1u << l;
    }
    if (in & (in - 1)) { /* one alone is no batch */
        tl_batch_lay(batch);
        take_patches(m, rank, batch, &in);
    }
    for (uint32_t l = 0; l < TL_LANES; l++)
        if ((in | others) >> l & 1)
            tl_contact_update(m, rank->contact[l], thread);
    return batch;
}
