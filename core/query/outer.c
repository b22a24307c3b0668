/* outer.c - the parts of faces that lie on no other block, and integrals over them.
 *
 * From a face's polygon the common parts with the faces that lie on it are taken away: those of contact patches, and those
 * of other blocks of the body in the same plane. Blocks do not overlap, so neither do these parts. Each is a convex polygon,
 * over which polynomials of the second degree are integrated exactly: by triangles, at the middles of their edges. */
#include "query/outer.h"

#include "contact/detection.h"

#include <stdlib.h>

/* Share of a face that may be left bare for roundings, and tolerance of blocks of a body that fit: those of seams. */
#define UNCOVERED 1e-5
#define FIT 1e-6

typedef struct flat {
    double u, v;
} flat;

static flat flatten(const tl_outer_face *f, tl_vec3 x)
{
    tl_vec3 d = tl_v3_sub(x, f->o);
    return (flat){tl_v3_dot(d, f->t1), tl_v3_dot(d, f->t2)};
}

static double turn(flat o, flat a, flat b)
{
    return (a.u - o.u) * (b.v - o.v) - (a.v - o.v) * (b.u - o.u);
}

/* Place of corner i of a face, relative to the model's origin. */
static tl_vec3 corner_at(const tl_model *m, uint32_t row, uint32_t face, uint32_t i)
{
    const tl_poly *p = m->blocks.shape[row];
    uint32_t body = m->blocks.body[row];
    tl_vec3 local = p->vertex[p->loop[p->start[face] + i]];
    return tl_v3_add(tl_body_place(&m->bodies, body), tl_m3_mul(&m->bodies.pose[body].r, local));
}

/* Adds `sign` times the integrals over a polygon. */
static void add_polygon(tl_area_sums *s, const flat *c, size_t count, double sign)
{
    for (size_t i = 1; i + 1 < count; i++) {
        double third = sign * turn(c[0], c[i], c[i + 1]) / 6;
        const flat corner[3] = {c[0], c[i], c[i + 1]};
        for (int k = 0; k < 3; k++) {
            double u = 0.5 * (corner[k].u + corner[(k + 1) % 3].u);
            double v = 0.5 * (corner[k].v + corner[(k + 1) % 3].v);
            s->a += third;
            s->u += third * u;
            s->v += third * v;
            s->uu += third * u * u;
            s->uv += third * u * v;
            s->vv += third * v * v;
        }
    }
}

/* Keeps what lies left of the line from o to q; returns the number of corners. */
static size_t keep_left(const flat *in, size_t count, flat o, flat q, flat *out)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        flat here = in[i], after = in[(i + 1) % count];
        double h = turn(o, q, here), a = turn(o, q, after);
        if (h >= 0)
            out[kept++] = here;
        if ((h > 0 && a < 0) || (h < 0 && a > 0)) {
            double t = h / (h - a);
            out[kept++] = (flat){here.u + t * (after.u - here.u), here.v + t * (after.v - here.v)};
        }
    }
    return kept;
}

/* Takes away what a face has in common with one that looks at it, as seen along its normal. */
static tl_status take_away(tl_model *m, tl_outer_face *f, uint32_t row, uint32_t face)
{
    uint32_t mine = tl_poly_face_size(m->blocks.shape[f->row], f->face);
    uint32_t its = tl_poly_face_size(m->blocks.shape[row], face);
    size_t capacity = mine + its;
    flat *now = malloc(2 * capacity * sizeof *now), *next = now + capacity;
    if (!now)
        return tl_fail_memory(&m->error);
    flat *memory = now;
    size_t count = mine;
    for (uint32_t i = 0; i < mine; i++)
        now[i] = flatten(f, corner_at(m, f->row, f->face, i));
    for (uint32_t i = 0; i < its && count; i++) {
        /* its loop runs the other way round as seen from here */
        flat o = flatten(f, corner_at(m, row, face, (i + 1) % its));
        flat q = flatten(f, corner_at(m, row, face, i));
        count = keep_left(now, count, o, q, next);
        flat *swap = now;
        now = next;
        next = swap;
    }
    add_polygon(&f->sums, now, count, -1);
    free(memory);
    return TL_OK;
}

/* Takes away the patches of contacts. */
static tl_status take_contacts(tl_model *m, tl_outer_face *f)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    tl_status status = TL_OK;
    for (uint32_t e = d->by_block_start[f->row]; e < d->by_block_start[f->row + 1]; e++) {
        uint32_t i = d->by_block[e];
        const tl_facet *facet = &c->facet[i];
        bool first = c->a[i] == f->row;
        if (status == TL_OK && facet->kind == TL_FACET_PATCH && c->point_count[i] &&
            (first ? facet->ia : facet->ib) == f->face)
            status =
                take_away(m, f, tl_contact_partner(c, i, f->row), first ? facet->ib : facet->ia);
    }
    return status;
}

/* Whether two faces of a body's blocks, in the body's frame, lie in one plane and face each other. */
static bool face_each_other(const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb)
{
    tl_plane p = a->plane[fa], q = b->plane[fb];
    return tl_v3_norm(tl_v3_add(p.normal, q.normal)) < FIT &&
           fabs(p.offset + q.offset) < FIT * fmin(a->size, b->size);
}

/* Takes away what lies on other blocks of the body. */
static tl_status take_members(tl_model *m, tl_outer_face *f)
{
    const tl_poly *shape = m->blocks.shape[f->row];
    uint32_t body = m->blocks.body[f->row];
    const uint32_t *member = m->members + m->bodies.member_start[body];
    for (uint32_t i = 0; i < m->bodies.member_count[body]; i++) {
        const tl_poly *other = m->blocks.shape[member[i]];
        for (uint32_t g = 0; g < other->face_count && member[i] != f->row; g++) {
            tl_status status = TL_OK;
            if (face_each_other(shape, f->face, other, g))
                status = take_away(m, f, member[i], g);
            if (status != TL_OK)
                return status;
        }
    }
    return TL_OK;
}

tl_status tl_outer_measure(tl_model *m, uint32_t row, uint32_t face, tl_outer_face *out)
{
    const tl_poly *shape = m->blocks.shape[row];
    *out = (tl_outer_face){.row = row, .face = face};
    out->normal = tl_m3_mul(&m->bodies.pose[m->blocks.body[row]].r, shape->plane[face].normal);
    out->t1 = tl_v3_perpendicular(out->normal);
    out->t2 = tl_v3_cross(out->normal, out->t1);
    out->o = corner_at(m, row, face, 0);
    uint32_t count = tl_poly_face_size(shape, face);
    flat *corners = malloc(count * sizeof *corners);
    if (!corners)
        return tl_fail_memory(&m->error);
    for (uint32_t i = 0; i < count; i++)
        corners[i] = flatten(out, corner_at(m, row, face, i));
    add_polygon(&out->sums, corners, count, 1);
    free(corners);
    double whole = out->sums.a;
    tl_status status = take_contacts(m, out);
    if (status == TL_OK)
        status = take_members(m, out);
    if (out->sums.a <= UNCOVERED * whole)
        out->sums = (tl_area_sums){0};
    return status;
}

tl_vec3 tl_outer_centroid(const tl_outer_face *f)
{
    double u = f->sums.u / f->sums.a, v = f->sums.v / f->sums.a;
    return tl_v3_madd(tl_v3_madd(f->o, u, f->t1), v, f->t2);
}
