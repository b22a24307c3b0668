/* partly_open.c - patches of which some corners are apart: their pressure integrated exactly.
 *
 * Over the part of a patch that is closed, the overlap o is linear and the pressure kn o. Its force, moment and energy are
 *
 *     N = kn int o dA,    M = kn int o x dA cross n,    U = kn / 2 int o^2 dA
 *
 * by a fan of triangles of the polygon, clipped where o = 0. The points, which stay where they are and keep their shear, have
 * too little or too much of it. Their closures are scaled so that their forces add up to N; what the moment and the energy
 * differ by is added to those of the contact.
 *
 * A patch of k corners has 2 k + 1 points drawn in towards the centroid: k between corners, k at corners, and the centroid
 * (patch.c). So its corners follow from its points. */
#include "force/partly_open.h"

#include "base/columns.h"
#include "contact/detection.h"
#include "narrow/frame2.h"

#include <math.h>
#include <string.h>

/* Corners of the patches that are looked at; others are left as they are. */
#define MOST_CORNERS 16

typedef struct corner {
    tl_vec3 x;
    double o;
} corner;

/* A lane's patch: where its points are in the lanes and in the table. */
typedef struct patch {
    const tl_points_table *p;
    const tl_point_lanes *lanes;
    size_t lane, row, count;
    uint32_t faces; /* their key, which is in all of its points' */
} patch;

static tl_vec3 arm_of(const patch *of, size_t k)
{
    return tl_columns_get(of->lanes->arm, of->lane + k * TL_LANES);
}

static double closure_of(const patch *of, size_t k)
{
    return of->lanes->closure[of->lane + k * TL_LANES];
}

static uint32_t key_of(const patch *of, size_t k)
{
    return of->p->key[of->row + k * TL_LANES] ^ of->faces;
}

/* Whether the points are those of the corners, of every two neighbours and of the centroid: some may have had no area. */
static bool are_all(const patch *of, size_t corners)
{
    bool all = key_of(of, 2 * corners) == tl_key_of(TL_POINT_CENTROID, 0, 0);
    for (size_t k = 0; k < corners && all; k++)
        all = key_of(of, k) == tl_key_of(TL_POINT_MIDDLE, key_of(of, corners + k),
                                         key_of(of, corners + (k + 1) % corners));
    return all;
}

/* The corners, in order, from the points; 0 for a patch whose points are others. */
static size_t corners_of(const patch *of, corner *out)
{
    size_t corners = (of->count - 1) / 2;
    if (of->count % 2 == 0 || corners < 3 || corners > MOST_CORNERS || !are_all(of, corners))
        return 0;
    const tl_point_rule rule = tl_point_rule_of(false);
    double per = 1 / rule.reach, o = closure_of(of, of->count - 1);
    tl_vec3 centre = arm_of(of, of->count - 1);
    for (size_t k = 0; k < corners; k++) {
        tl_vec3 out_there = tl_v3_sub(arm_of(of, corners + k), centre);
        out[k].x = tl_v3_madd(centre, per, out_there);
        out[k].o = o + per * (closure_of(of, corners + k) - o);
    }
    return corners;
}

/* Keeps what is closed. */
static size_t clip(const corner *in, size_t count, corner *out)
{
    size_t kept = 0;
    for (size_t k = 0; k < count; k++) {
        const corner *a = &in[k], *b = &in[(k + 1) % count];
        if (a->o >= 0)
            out[kept++] = *a;
        if ((a->o < 0) != (b->o < 0)) {
            double t = a->o / (a->o - b->o);
            out[kept++] = (corner){tl_v3_madd(a->x, t, tl_v3_sub(b->x, a->x)), 0};
        }
    }
    return kept;
}

/* Integrals of o, o x and o^2 / 2. */
typedef struct integrals {
    double o, half_o2, area;
    tl_vec3 ox;
} integrals;

static integrals integrate(const corner *c, size_t count)
{
    integrals out = {0};
    for (size_t k = 2; k < count; k++) {
        const corner *p = &c[0], *q = &c[k - 1], *r = &c[k];
        double area = 0.5 * tl_v3_norm(tl_v3_cross(tl_v3_sub(q->x, p->x), tl_v3_sub(r->x, p->x)));
        double sum = p->o + q->o + r->o;
        tl_vec3 all = tl_v3_add(p->x, tl_v3_add(q->x, r->x));
        tl_vec3 own = tl_v3_madd(tl_v3_madd(tl_v3_scale(p->o, p->x), q->o, q->x), r->o, r->x);
        out.area += area;
        out.o += area / 3 * sum;
        out.ox = tl_v3_madd(out.ox, area / 12, tl_v3_madd(own, sum, all));
        out.half_o2 += area / 24 * (p->o * p->o + q->o * q->o + r->o * r->o + sum * sum);
    }
    return out;
}

/* The same of the points. */
static integrals of_points(const patch *of)
{
    integrals out = {0};
    for (size_t k = 0; k < of->count; k++) {
        double area = of->p->area[of->row + k * TL_LANES], o = fmax(0, closure_of(of, k));
        out.area += area;
        out.o += area * o;
        out.ox = tl_v3_madd(out.ox, area * o, arm_of(of, k));
        out.half_o2 += 0.5 * area * o * o;
    }
    return out;
}

/* Gives the points the force of the closed part: scaled, or where none of them is closed all to the nearest. */
static void share_force(const patch *of, double force, double points)
{
    double *closure = of->lanes->closure + of->lane;
    size_t nearest = 0;
    for (size_t k = 0; k < of->count; k++) {
        nearest = closure[k * TL_LANES] > closure[nearest * TL_LANES] ? k : nearest;
        closure[k * TL_LANES] *= points > 0 && closure[k * TL_LANES] > 0 ? force / points : 1;
    }
    if (!(points > 0))
        closure[nearest * TL_LANES] = force / of->p->area[of->row + nearest * TL_LANES];
}

static void part(const patch *of, tl_partly_open *out, size_t l)
{
    corner all[MOST_CORNERS], closed[2 * MOST_CORNERS];
    size_t corners = corners_of(of, all), open = 0;
    for (size_t k = 0; k < corners; k++)
        open += all[k].o < 0;
    if (open == 0 || open == corners)
        return;
    integrals exact = integrate(closed, clip(all, corners, closed)), was = of_points(of);
    /* areas are those on the faces */
    double by = was.area / integrate(all, corners).area;
    share_force(of, by * exact.o, was.o);
    integrals now = of_points(of);
    tl_vec3 n = tl_columns_get(of->lanes->normal, of->lane);
    tl_vec3 more = tl_v3_sub(tl_v3_scale(by, exact.ox), now.ox);
    out->any = true;
    out->moment[l] = tl_v3_cross(more, n);
    out->energy[l] = by * exact.half_o2 - now.half_o2;
}

/* Lanes some of whose points, or of whose corners beyond them, may be closed and others apart: a bit each. */
static uint32_t mixed(const tl_points_table *p, const tl_simd_group *group, const tl_point_lanes *t,
                      size_t lane)
{
    double low[TL_LANES], high[TL_LANES];
    uint32_t out = 0;
    for (size_t l = 0; l < TL_LANES; l++) {
        low[l] = INFINITY;
        high[l] = -INFINITY;
    }
    for (size_t at = 0; at < (size_t)group->slots * TL_LANES; at += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            double o = t->closure[lane + at + l];
            bool there = p->area[group->start + at + l] > 0;
            low[l] = (there & (o < low[l])) ? o : low[l];
            high[l] = (there & (o > high[l])) ? o : high[l];
        }
    for (size_t l = 0; l < TL_LANES; l++) {
        double beyond = (high[l] - low[l]) * (1 / tl_point_rule_of(false).reach - 1);
        out |= (uint32_t)(low[l] - beyond < 0 && high[l] + beyond > 0) << l;
    }
    return out;
}

bool tl_part_applies(const tl_model *m, const tl_law *law)
{
    return m->config.contact_points != TL_POINTS_CORNERS && law->pulls != TL_PULL_ANY;
}

/* Whether no point of a contact may carry a force across a gap. */
static bool closes(const tl_model *m, const tl_law *law, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    for (size_t k = 0; k < contacts->point_count[c]; k++) {
        size_t i = tl_point_row(contacts, c, k);
        if (p->f_n0 && (p->f_n0[i] != 0 || p->reference[i] != 0))
            return false;
        if (law->pulls == TL_PULL_BONDED && !(p->flags[i] & TL_POINT_FAILED))
            return false;
    }
    return true;
}

void tl_simd_group_part(const tl_model *m, const tl_law *law, const tl_simd_group *group,
                        const tl_point_lanes *t, size_t lane, tl_partly_open *out)
{
    const tl_points_table *p = &m->detect->points;
    out->any = false;
    for (uint32_t left = mixed(p, group, t, lane); left; left &= left - 1) {
        size_t l = (size_t)__builtin_ctz(left);
        uint32_t c = group->contact[l];
        if (c == TL_NO_ROW || !closes(m, law, c))
            continue;
        if (!out->any)
            for (size_t k = 0; k < TL_LANES; k++) {
                out->moment[k] = tl_v3(0, 0, 0);
                out->energy[k] = 0;
            }
        const tl_facet *f = &m->detect->contacts.facet[c];
        const patch of = {.p = p,
                          .lanes = t,
                          .lane = lane + l,
                          .row = group->start + l,
                          .count = m->detect->contacts.point_count[c],
                          .faces = tl_key_of(0, f->ia, f->ib)};
        part(&of, out, l);
    }
}

/* Whether the points of a contact are drawn in from corners and edges towards the last of them. */
static bool has_centroid(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_facet *f = &contacts->facet[c];
    size_t count = contacts->point_count[c];
    if (f->kind != TL_FACET_PATCH || count % 2 == 0 || count < 7)
        return false;
    return m->detect->points.key[tl_point_row(contacts, c, count - 1)] ==
           tl_centroid_key(f->ia, f->ib);
}

void tl_simd_group_edges(const tl_model *m, const tl_simd_group *group, const tl_point_lanes *t,
                         size_t lane)
{
    const tl_point_rule rule = tl_point_rule_of(false);
    size_t rows = (size_t)group->slots * TL_LANES;
    memcpy(t->edge + lane, t->closure + lane, rows * sizeof *t->edge);
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t c = group->contact[l];
        if (c == TL_NO_ROW || !has_centroid(m, c))
            continue;
        size_t last = m->detect->contacts.point_count[c] - 1u, corners = last / 2;
        const double *closure = t->closure + lane + l;
        double centre = closure[last * TL_LANES];
        for (size_t k = 0; k < last; k++)
            t->edge[lane + l + k * TL_LANES] =
                centre + (closure[k * TL_LANES] - centre) / (k < corners ? rule.out : rule.reach);
    }
}
