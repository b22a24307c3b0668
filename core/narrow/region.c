/* region.c - which faces of two blocks bound what they have in common.
 *
 * A face that lies wholly outside one face of the other block bounds nothing of the common volume K, and may be left
 * out. The faces that stay enclose K and nothing else, as long as there is a K. For the way from a point of K out of
 * it may lead through a face that was left out. The point on that face would lie in the other block. By how far the
 * face lies outside, so far may the pair move and the face be left out still.
 *
 * Where a block has seams, the nearest face of a point in K need not bound K. No point of K lies deeper than the least
 * overlap. A face is left out if it is farther away than that from the whole of the other block. */
#include "narrow/region.h"

#include "base/table.h"

#include <stdlib.h>
#include <string.h>
#include <talus/plugin.h>

/* Tolerance: cosine of the angle, 15 degrees, within which two faces face each other. Two of one block meet in a blunt
 * edge. */
#define FACING 0.96592582628906831

/* The planes of a block in A's frame, as columns, and where the other block lies along each of them. */
typedef struct planes {
    const tl_poly *poly;
    const tl_vec3 *vertex;
    size_t count;
    double *x, *y, *z, *c;
    double *low, *high; /* of the other block's vertices, over the plane */
    double *outside;    /* of each face: how far it lies outside one face of the other block */
    size_t faces;       /* the first planes are those of faces, the others of faces of other parts (seam.c) */
} planes;

/* 0, TL_COVERED or TL_SEAM. */
static int covered(const planes *p, size_t f)
{
    return f < p->faces ? p->poly->covered[f] : 0;
}

static size_t padded(size_t faces)
{
    return (faces + TL_LANES - 1) / TL_LANES * TL_LANES;
}

static bool reserve(tl_narrow_scratch *scratch, size_t doubles, size_t faces)
{
    if (doubles > scratch->plane_capacity) {
        double *plane = aligned_alloc(TL_ALIGN, 2 * doubles * sizeof *plane);
        if (!plane)
            return false;
        free(scratch->plane);
        scratch->plane = plane;
        scratch->plane_capacity = 2 * doubles;
    }
    return tl_grow(&scratch->face, &scratch->face_capacity, faces, sizeof *scratch->face);
}

static void fill(planes *p, size_t f, tl_plane plane)
{
    p->x[f] = plane.normal.x;
    p->y[f] = plane.normal.y;
    p->z[f] = plane.normal.z;
    p->c[f] = plane.offset;
    p->low[f] = INFINITY;
    p->high[f] = -INFINITY;
}

/* The columns of a block, in memory from `at` on. */
static planes columns_of(const tl_pair_view *view, bool of_b, double *at)
{
    const tl_poly *poly = of_b ? view->b : view->a;
    const size_t step = padded(poly->plane_count);
    planes p = {.poly = poly,
                .vertex = of_b ? view->vertex_b : poly->vertex,
                .count = poly->plane_count,
                .faces = poly->face_count,
                .x = at,
                .y = at + step,
                .z = at + 2 * step,
                .c = at + 3 * step,
                .low = at + 4 * step,
                .high = at + 5 * step,
                .outside = at + 6 * step};
    for (size_t f = 0; f < p.count; f++)
        fill(&p, f, tl_view_plane(view, of_b, (uint32_t)f));
    for (size_t f = p.count; f < step; f++)
        fill(&p, f, (tl_plane){{0, 0, 0}, INFINITY});
    return p;
}

/* How high the vertices of a block lie over eight planes, from number g on, of the other block. */
TL_VECTORIZED static void vertex_heights(const planes *restrict q, size_t g, const tl_vec3 *vertex, size_t count,
                                         double (*restrict height)[TL_LANES])
{
    const double *restrict x = q->x + g, *restrict y = q->y + g, *restrict z = q->z + g;
    const double *restrict c = q->c + g;
    double *restrict low = q->low + g, *restrict high = q->high + g;
    for (size_t i = 0; i < count; i++) {
        const tl_vec3 v = vertex[i];
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            double h = x[l] * v.x + y[l] * v.y + z[l] * v.z - c[l];
            height[i][l] = h;
            low[l] = h < low[l] ? h : low[l];
            high[l] = h > high[l] ? h : high[l];
        }
    }
}

/* The largest height over one of the planes of a face's lowest vertex; of a face that lies outside by more than the
 * margin no more than that. */
TL_VECTORIZED static void find_outside(const tl_poly *poly, size_t faces, double margin,
                                       const double (*restrict height)[TL_LANES], double *restrict outside)
{
    for (size_t f = 0; f < faces; f++) {
        double low[TL_LANES], most = outside[f];
        if (most > margin)
            continue;
        memcpy(low, height[poly->loop[poly->start[f]]], sizeof low);
        for (uint32_t k = poly->start[f] + 1; k < poly->start[f + 1]; k++) {
            const double *restrict h = height[poly->loop[k]];
#pragma omp simd
            for (size_t l = 0; l < TL_LANES; l++)
                low[l] = h[l] < low[l] ? h[l] : low[l];
        }
        for (size_t l = 0; l < TL_LANES; l++)
            most = low[l] > most ? low[l] : most;
        outside[f] = most;
    }
}

/* Where the faces of p lie over the planes of q. `height` has room for p's vertices. */
static void find_heights(const planes *p, const planes *q, double margin, double (*height)[TL_LANES])
{
    for (size_t f = 0; f < p->count; f++)
        p->outside[f] = -INFINITY;
    for (size_t g = 0; g < q->count; g += TL_LANES) {
        vertex_heights(q, g, p->vertex, p->poly->vertex_count, height);
        find_outside(p->poly, p->faces, margin, (const double(*)[TL_LANES])height, p->outside);
    }
}

/* The plane over which the other block lies highest; borders do not count for the least overlap, for walls of a seam
 * press on nothing. */
static double highest(const planes *p, bool borders, size_t *face)
{
    double gap = -INFINITY;
    for (size_t f = 0; f < p->count; f++)
        if (p->low[f] > gap && (borders || !covered(p, f))) {
            gap = p->low[f];
            *face = f;
        }
    return gap;
}

/* The gap, with its normal: apart by any face, or overlapping by the least along a real one. Along a seam it may be
 * less. */
static void find_gap(const planes *a, const planes *b, tl_region *out)
{
    size_t face_a = 0, face_b = 0;
    double gap_a = highest(a, true, &face_a), gap_b = highest(b, true, &face_b);
    out->gap_with_borders = fmax(gap_a, gap_b);
    if (!(out->gap_with_borders > 0)) {
        gap_a = highest(a, false, &face_a);
        gap_b = highest(b, false, &face_b);
    }
    out->gap = fmax(gap_a, gap_b);
    out->n = gap_a >= gap_b ? tl_v3(a->x[face_a], a->y[face_a], a->z[face_a])
                            : tl_v3(-b->x[face_b], -b->y[face_b], -b->z[face_b]);
}

/* Adds the faces of a block that are covered so; returns how many. */
static uint32_t list(const planes *p, int how, bool seams, double margin, double deepest, uint16_t *face)
{
    uint32_t count = 0;
    for (size_t f = 0; f < p->count; f++) {
        if (covered(p, f) != how)
            continue;
        bool away = seams && !how ? -p->high[f] > deepest + 2 * margin : p->outside[f] > margin;
        if (!away)
            face[count++] = (uint16_t)f;
    }
    return count;
}

/* Adds the borders of a block, the seams behind the others. */
static uint32_t list_borders(const planes *p, bool seams, double margin, uint16_t *face)
{
    uint32_t count = list(p, TL_COVERED, seams, margin, 0, face);
    return count + list(p, TL_SEAM, seams, margin, 0, face + count);
}

static double cosine(const planes *p, size_t i, const planes *q, size_t j)
{
    return p->x[i] * q->x[j] + p->y[i] * q->y[j] + p->z[i] * q->z[j];
}

/* The flush faces: of the two that overlap the least, the most parallel where several do. Those count as well that
 * meet them in blunt edges: the most parallel of all are taken. So the choice changes where two tilts are the same.
 * Planes of other parts count, but are not chosen. */
static void find_flush(const planes *a, const planes *b, tl_region *out)
{
    const uint16_t *of_a = out->face, *of_b = out->face + out->a;
    uint16_t first_a = 0, first_b = 0;
    double most = -1, gap = -INFINITY, facing = -1;
    for (uint32_t k = 0; k < out->a; k++)
        for (uint32_t m = 0; m < out->b; m++) {
            double g = fmax(a->low[of_a[k]], b->low[of_b[m]]);
            double c = -cosine(a, of_a[k], b, of_b[m]);
            if (c < FACING || g < gap || (g == gap && c <= facing))
                continue;
            out->flush = true;
            gap = g;
            facing = c;
            first_a = of_a[k];
            first_b = of_b[m];
        }
    for (uint32_t k = 0; k < out->a && out->flush; k++)
        for (uint32_t m = 0; m < out->b; m++) {
            double c = -cosine(a, of_a[k], b, of_b[m]);
            if (c <= most || of_a[k] >= a->faces || of_b[m] >= b->faces || cosine(a, of_a[k], a, first_a) < FACING ||
                cosine(b, of_b[m], b, first_b) < FACING)
                continue;
            most = c;
            out->flush_a = of_a[k];
            out->flush_b = of_b[m];
        }
    out->flush = most > -1;
    out->flush_gap = fmax(a->low[out->flush_a], b->low[out->flush_b]);
}

/* Puts the faces that meet the flush one in blunt edges before the others of a block; how many they are, with it. The
 * least by which one falls behind it. */
static uint32_t gather_blunt(const planes *p, uint16_t *face, uint32_t count, uint16_t flush, double *lead)
{
    uint32_t blunt = 0;
    for (uint32_t k = 0; k < count; k++) {
        uint16_t f = face[k];
        if (cosine(p, f, p, flush) < FACING)
            continue;
        if (f != flush)
            *lead = fmin(*lead, p->low[flush] - p->low[f]);
        for (uint32_t m = k; m > blunt; m--)
            face[m] = face[m - 1];
        face[blunt++] = f;
    }
    return blunt;
}

/* By how much all other faces that face each other fall behind the flush ones. */
static void find_leads(const planes *a, const planes *b, tl_region *out, uint16_t *face)
{
    uint16_t *of_b = face + out->a;
    out->flush_lead = out->blunt_lead = INFINITY;
    out->blunt_a = gather_blunt(a, face, out->a, out->flush_a, &out->blunt_lead);
    out->blunt_b = gather_blunt(b, of_b, out->b, out->flush_b, &out->blunt_lead);
    for (uint32_t k = 0; k < out->a; k++)
        for (uint32_t m = 0; m < out->b; m++)
            if ((k >= out->blunt_a || m >= out->blunt_b) && cosine(a, face[k], b, of_b[m]) <= -FACING)
                out->flush_lead = fmin(out->flush_lead, out->flush_gap - fmax(a->low[face[k]], b->low[of_b[m]]));
}

/* The planes of both blocks, and room for the heights of vertices. */
typedef struct both {
    planes a, b;
    double (*height)[TL_LANES];
} both;

static bool place_planes(const tl_pair_view *view, tl_narrow_scratch *scratch, both *out)
{
    const size_t count_a = view->a->plane_count, count_b = view->b->plane_count;
    const size_t rows_a = padded(count_a), rows_b = padded(count_b);
    uint32_t vertices = view->a->vertex_count > view->b->vertex_count ? view->a->vertex_count : view->b->vertex_count;
    if (!reserve(scratch, 7 * (rows_a + rows_b) + TL_LANES * (size_t)vertices, count_a + count_b))
        return false;
    *out = (both){.a = columns_of(view, false, scratch->plane),
                  .b = columns_of(view, true, scratch->plane + 7 * rows_a),
                  .height = (double(*)[TL_LANES])(scratch->plane + 7 * (rows_a + rows_b))};
    return true;
}

bool tl_region_gap(const tl_pair_view *view, tl_narrow_scratch *scratch, tl_region_lows *out)
{
    both of;
    tl_region region = {0};
    if (!place_planes(view, scratch, &of))
        return false;
    for (size_t g = 0; g < of.b.count; g += TL_LANES)
        vertex_heights(&of.b, g, of.a.vertex, of.a.poly->vertex_count, of.height);
    for (size_t g = 0; g < of.a.count; g += TL_LANES)
        vertex_heights(&of.a, g, of.b.vertex, of.b.poly->vertex_count, of.height);
    find_gap(&of.a, &of.b, &region);
    *out = (tl_region_lows){.b_over_a = of.a.low, .a_over_b = of.b.low, .gap = region.gap, .n = region.n};
    return true;
}

bool tl_region_find(const tl_pair_view *view, double margin, tl_narrow_scratch *scratch, tl_region *out)
{
    both of;
    *out = (tl_region){0};
    if (!place_planes(view, scratch, &of))
        return false;
    const planes a = of.a, b = of.b;
    find_heights(&a, &b, margin, of.height);
    find_heights(&b, &a, margin, of.height);
    find_gap(&a, &b, out);
    uint16_t *face = scratch->face;
    bool seams = view->a->seams || view->b->seams;
    double deepest = fmax(-out->gap, 0);
    out->face = face;
    out->a = list(&a, 0, seams, margin, deepest, face);
    out->b = list(&b, 0, seams, margin, deepest, face += out->a);
    out->border_a = list_borders(&a, seams, margin, face += out->b);
    out->border_b = list_borders(&b, seams, margin, face += out->border_a);
    find_flush(&a, &b, out);
    if (out->flush)
        find_leads(&a, &b, out, scratch->face);
    return true;
}

void tl_region_choose_flush(const tl_pair_view *view, tl_region *out)
{
    double most = -1;
    for (uint32_t k = 0; k < out->blunt_a; k++)
        for (uint32_t m = 0; m < out->blunt_b; m++) {
            uint16_t i = out->face[k], j = out->face[out->a + m];
            double c = -tl_v3_dot(view->a->plane[i].normal, view->normal_b[j]);
            bool faces = i < view->a->face_count && j < view->b->face_count;
            if (faces && c > most) {
                most = c;
                out->flush_a = i;
                out->flush_b = j;
            }
        }
}

/* The listed faces of one block: those that bound the common volume, from the left, and the others, from the right. */
typedef struct sides {
    tl_plane plane[TL_FIELD_KNOWN];
    uint16_t face[TL_FIELD_KNOWN];
    uint32_t bounding, other;
} sides;

static void split(const tl_pair_view *view, const tl_region *r, bool of_b, sides *s)
{
    uint32_t begin = of_b ? r->a : 0, end = begin + (of_b ? r->b : r->a);
    s->bounding = 0;
    s->other = TL_FIELD_KNOWN;
    for (uint32_t k = begin; k < end; k++) {
        uint32_t at = r->mesh->bounding >> k & 1 ? s->bounding++ : --s->other;
        uint16_t f = r->face[k];
        s->face[at] = f;
        s->plane[at] = tl_view_plane(view, of_b, f);
    }
}

static bool lies_within(const sides *s, tl_vec3 v)
{
    for (uint32_t k = 0; k < s->bounding; k++)
        if (tl_v3_dot(s->plane[k].normal, v) > s->plane[k].offset)
            return false;
    return true;
}

/* Whether the corners of a block, of sides `own`, that lie in another, of sides `s`, lie on or beyond none of the
 * others. */
static bool agree(const tl_poly *p, const tl_vec3 *vertex, const sides *own, const sides *s)
{
    for (uint32_t m = own->other; m < TL_FIELD_KNOWN; m++)
        for (uint32_t h = p->start[own->face[m]]; h < p->start[own->face[m] + 1u]; h++)
            if (lies_within(s, vertex[p->loop[h]]))
                return false;
    for (uint32_t i = 0; i < p->vertex_count && s->other < TL_FIELD_KNOWN; i++) {
        if (!lies_within(s, vertex[i]))
            continue;
        for (uint32_t m = s->other; m < TL_FIELD_KNOWN; m++)
            if (tl_v3_dot(s->plane[m].normal, vertex[i]) > s->plane[m].offset)
                return false;
    }
    return true;
}

bool tl_region_corners_agree(const tl_pair_view *view, const tl_region *region)
{
    sides a, b;
    if (region->a > TL_FIELD_KNOWN || region->b > TL_FIELD_KNOWN)
        return false;
    split(view, region, false, &a);
    split(view, region, true, &b);
    return agree(view->a, view->a->vertex, &a, &b) && agree(view->b, view->vertex_b, &b, &a);
}

double tl_region_tilt(const tl_pair_view *view, uint32_t face_a, uint32_t face_b)
{
    return tl_v3_norm(tl_v3_cross(view->a->plane[face_a].normal, view->normal_b[face_b]));
}
