/* overlap.c - blocks that overlap so deeply that no contact can tell how to part them.
 *
 * An overlap is measured along the normal of the face along which it is least (region.h). Two lengths limit what it
 * means. At half the sum of both bodies' widths along that normal their middles have met: the way out is on the far
 * side. At the diameter of the smaller body that one is wholly inside the other. A seam is no way out. But where parts
 * have only a sliver in common along one, they do not overlap deeply whatever the way along their faces.
 *
 * A contact that is born so deep comes of blocks that were placed into each other, or thrown into each other in one
 * step: nobody knows which way they came. One that was born at the surface and sinks in is followed on its way: soft
 * contacts of vertices and edges let stones sink in by a diameter. It is given up only when the smaller block is gone
 * inside the larger. So is a block that is wholly inside at the birth of the contact, for nothing presses it. A step
 * that finds such an overlap fails before its forces are made. Two blocks that are both held may overlap as they like:
 * nothing comes of it.
 *
 * The overlap is known wherever the faces of a pair are listed, so the test costs next to nothing. They are listed
 * after a motion of TL_LIST_MARGIN of the size at the latest (update.c). The faces of a contact that is marked are
 * listed in every step. The mark tells which limit was exceeded, and stays until the overlap is within that limit. So
 * what was born too deep stays refused, and what has sunk in is still followed when blocks elsewhere come or go. */
#include "detect/overlap.h"

#include "contact/contacts.h"
#include "contact/pair_view.h"
#include "narrow/narrow.h"

#include <stdio.h>

/* Limit: deepest overlap of a contact at its birth, over the shorter of the two lengths. Beyond it rounding and the
 * shapes decide which way out is the shorter one. Test: lua/test_limits. */
#define TL_DEEPEST_BORN 0.9
/* Limit: deepest overlap of any contact over the diameter of the smaller block. Stones that fall on soft edge contacts
 * (kn 1e7) come to 1.06. Test: lua/test_limits. */
#define TL_DEEPEST 1.25

/* Extent of a body along a direction in its frame. */
static double width_along(const tl_model *m, uint32_t body, tl_vec3 n)
{
    double least = INFINITY, most = -INFINITY;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        const tl_poly *part = m->blocks.shape[tl_body_blocks(m, body)[k]];
        for (uint32_t i = 0; i < part->vertex_count; i++) {
            double x = tl_v3_dot(n, part->vertex[i]);
            least = fmin(least, x);
            most = fmax(most, x);
        }
    }
    return most - least;
}

/* How deep a pair may overlap. `n` is in the frame of A's body. */
static double deepest(const tl_model *m, const tl_pair_view *view, tl_vec3 n, uint32_t a, uint32_t b, bool born)
{
    uint32_t body_a = m->blocks.body[a], body_b = m->blocks.body[b];
    double diameter = 2 * fmin(m->bodies.radius[body_a], m->bodies.radius[body_b]);
    if (!born)
        return TL_DEEPEST * diameter;
    double middles = 0.5 * (width_along(m, body_a, n) + width_along(m, body_b, tl_m3_tmul(&view->turn, n)));
    return TL_DEEPEST_BORN * fmin(middles, diameter);
}

/* Whether all corners of a block lie behind all faces of another with these normals and origin in the same frame. */
static bool lies_behind(const tl_vec3 *corner, uint32_t corners, const tl_poly *other, const tl_vec3 *normal,
                        size_t stride, tl_vec3 origin)
{
    for (uint32_t f = 0; f < other->face_count; f++) {
        tl_vec3 n = *(const tl_vec3 *)(const void *)((const char *)normal + f * stride);
        double offset = other->plane[f].offset + tl_v3_dot(n, origin);
        for (uint32_t i = 0; i < corners; i++)
            if (tl_v3_dot(n, corner[i]) > offset)
                return false;
    }
    return true;
}

bool tl_overlap_is_whole(const tl_pair_view *view, const tl_region *region)
{
    const tl_poly *a = view->a, *b = view->b;
    if (!(region->gap_with_borders < 0))
        return false;
    return lies_behind(a->vertex, a->vertex_count, b, view->normal_b, sizeof(tl_vec3), view->shift) ||
           lies_behind(view->vertex_b, b->vertex_count, a, &a->plane[0].normal, sizeof(tl_plane), tl_v3(0, 0, 0));
}

bool tl_overlap_is_deep(const tl_model *m, const tl_pair_view *view, const tl_region *region, uint32_t a, uint32_t b,
                        bool born)
{
    if (!(region->gap_with_borders < -TL_SHALLOW * view->size))
        return false;
    return -region->gap > deepest(m, view, region->n, a, b, born) || (born && tl_overlap_is_whole(view, region));
}

void tl_overlap_mark(tl_contacts *contacts, uint32_t contact, bool born)
{
    contacts->deep[contact] = born ? TL_DEEP_BORN : TL_DEEP_SUNK;
    contacts->faces_valid_to[contact] = TL_OUTDATED;
}

/* The region of a contact's blocks; false: out of memory. */
static bool find_region(tl_model *m, uint32_t contact, tl_pair_view *view, tl_region *region)
{
    tl_narrow_scratch *scratch = &m->detect->narrow[0];
    *view = tl_contact_view(m, contact);
    return tl_pair_place(view, scratch) && tl_region_find(view, 0, scratch, region);
}

bool tl_overlap_measure(tl_model *m, uint32_t contact, tl_overlap_share *out)
{
    const tl_contacts *c = &m->detect->contacts;
    tl_pair_view view;
    tl_region region;
    if (!find_region(m, contact, &view, &region))
        return false;
    const tl_sides bodies = tl_contact_bodies(m, contact);
    double of_a = width_along(m, bodies.a, region.n);
    double of_b = width_along(m, bodies.b, tl_m3_tmul(&view.turn, region.n));
    *out = (tl_overlap_share){-region.gap, fmin(of_a, of_b), of_a < of_b ? c->a[contact] : c->b[contact]};
    return true;
}

static tl_status report(tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    tl_pair_view view;
    tl_region region;
    if (!find_region(m, contact, &view, &region))
        return tl_fail_memory(&m->error);
    char name[320];
    tl_contact_describe(m, contact, name, sizeof name);
    bool born = c->deep[contact] == TL_DEEP_BORN;
    if (born && tl_overlap_is_whole(&view, &region))
        return tl_fail(
            &m->error, TL_E_NUMERIC,
            "cycle %lld, %s: one lies wholly inside the other, so no contact can part them: delete or move one if they "
            "were placed so, or give a higher stiffness or a lower velocity if it was carried there",
            (long long)m->cycles + 1, name);
    return tl_fail(
        &m->error, TL_E_NUMERIC,
        "cycle %lld, %s: they overlap by %.3g m, more than the %.3g m up to which a contact can tell how to part them: "
        "were they placed into each other, is a stiffness too low for what presses, or the time step too large?",
        (long long)m->cycles + 1, name, -region.gap, deepest(m, &view, region.n, c->a[contact], c->b[contact], born));
}

tl_status tl_overlaps_check(tl_model *m)
{
    tl_detect *d = m->detect;
    tl_contacts *c = &d->contacts;
    bool any = false;
    for (unsigned i = 0; i < d->threads; i++)
        any = any || d->narrow[i].deep;
    if (!any)
        return TL_OK;
    uint32_t first = TL_NO_ROW;
    bool marked = false;
    for (uint32_t row = 0; row < c->table.rows; row++) {
        marked = marked || c->deep[row] != TL_DEEP_NOT;
        if (c->deep[row] == TL_DEEP_NOT || tl_blocks_fixed(m, c->a[row], c->b[row]))
            continue;
        c->points_valid_to[row] = TL_OUTDATED; /* look again when the step is repeated */
        first = first == TL_NO_ROW ? row : first;
    }
    if (first != TL_NO_ROW)
        return report(m, first);
    for (unsigned i = 0; i < d->threads; i++)
        d->narrow[i].deep = marked;
    return TL_OK;
}
