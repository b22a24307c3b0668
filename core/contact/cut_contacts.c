/* cut_contacts.c - what a contact leaves to those of its blocks' parts when a block of it is cut.
 *
 * A part of a wall carries what it carried before: stresses, law states, an initial stress. So a contact that
 * ends because a block of it was cut leaves its points. Each contact between parts of the two blocks takes over
 * its share of them when it is made, in the same detection. Which block a part comes from, its root, the model
 * tells (tl_cut_part). */
#include "contact/cut_contacts.h"

#include "base/columns.h"
#include "contact/contacts.h"
#include "contact/pair_view.h"
#include "contact/shear.h"
#include "narrow/flush.h"

#include <stdlib.h>

/* Tolerance: normals of a part's face and of the whole's are off each other by rounding. */
#define SAME_FACE 1e-9

static int compare(const void *x, const void *y)
{
    const tl_cut_contact *p = x, *q = y;
    return tl_pair_order(p->a, p->b, q->a, q->b);
}

void tl_cut_contacts_sort(tl_detect *d)
{
    if (d->cut_count > 1)
        qsort(d->cut_contacts, d->cut_count, sizeof *d->cut_contacts, compare);
}

/* ---------------------------------------------------------------- taken over ------------- */

static tl_id root_of(const tl_model *m, uint32_t row)
{
    const tl_cut_part *part = tl_cut_part_of(m, m->blocks.id[row]);
    return part ? part->root : m->blocks.id[row];
}

tl_cut_contact *tl_cut_contact_of(const tl_model *m, uint32_t block_a, uint32_t block_b)
{
    const tl_detect *d = m->detect;
    if (d->cut_count == 0)
        return NULL;
    tl_id a = root_of(m, block_a), b = root_of(m, block_b);
    tl_cut_contact wanted = {.a = a < b ? a : b, .b = a < b ? b : a};
    return bsearch(&wanted, d->cut_contacts, d->cut_count, sizeof wanted, compare);
}

double tl_cut_contact_tilt(const tl_model *m, uint32_t block_a, uint32_t block_b)
{
    const tl_cut_contact *cut = tl_cut_contact_of(m, block_a, block_b);
    tl_face_pair faces;
    if (!cut || !cut->pressed)
        return 0;
    bool corners =
        tl_cut_contact_faces(m, block_a, block_b, &faces) && tl_pair_at_corners(m, block_a, faces.a, block_b, faces.b);
    return tl_flush_limits_of(corners).field_tilt;
}

/* The face that a block has for another one with an outward normal; TL_NO_ROW: it has none. A convex block has one at
 * the most. */
static uint32_t face_of(const tl_model *m, uint32_t block, uint32_t other, tl_vec3 normal)
{
    const tl_poly *shape = tl_pair_shape(m, block, other);
    tl_vec3 n = tl_m3_tmul(tl_side_rotation(m, tl_block_side(m, block)), normal);
    for (uint32_t f = 0; f < shape->face_count; f++)
        if (tl_v3_norm2(tl_v3_sub(shape->plane[f].normal, n)) < SAME_FACE * SAME_FACE)
            return f;
    return TL_NO_ROW;
}

/* How far a face that a block has for another one lies beyond a place, along its normal. */
static double beyond(const tl_model *m, uint32_t block, uint32_t other, uint32_t face, tl_vec3 place)
{
    const tl_plane *plane = &tl_pair_shape(m, block, other)->plane[face];
    return plane->offset - tl_v3_dot(plane->normal, tl_side_local(m, tl_block_side(m, block), place));
}

/* Faces parallel to those of the whole are parts of them, but for one that a cut has made inside the whole.
 * That one lies behind the whole's face, so it overlaps the other block's by less. */
bool tl_cut_contact_faces(const tl_model *m, uint32_t block_a, uint32_t block_b, tl_face_pair *faces)
{
    const tl_cut_contact *cut = tl_cut_contact_of(m, block_a, block_b);
    if (!cut)
        return false;
    bool other_way = root_of(m, block_a) != cut->a;
    uint32_t face_a = face_of(m, block_a, block_b, cut->face[other_way]);
    uint32_t face_b = face_of(m, block_b, block_a, cut->face[!other_way]);
    if (face_a == TL_NO_ROW || face_b == TL_NO_ROW)
        return false;
    *faces = (tl_face_pair){(uint16_t)face_a, (uint16_t)face_b};
    tl_vec3 first = m->detect->cut_points[cut->first].arm;
    double overlap = beyond(m, block_a, block_b, face_a, first) + beyond(m, block_b, block_a, face_b, first);
    double size = fmin(m->blocks.size[block_a], m->blocks.size[block_b]);
    return fabs(overlap - cut->overlap) < TL_STILL * size;
}

double tl_cut_contact_shift(const tl_model *m, uint32_t block_a, uint32_t block_b, tl_face_pair *faces)
{
    const tl_cut_contact *cut = tl_cut_contact_of(m, block_a, block_b);
    if (cut && cut->shift != 0 && tl_cut_contact_faces(m, block_a, block_b, faces))
        return cut->shift;
    *faces = (tl_face_pair){0, 0};
    return 0;
}

/* Whether a contact on a facet is on parts of the faces of the whole. */
static bool is_on(const tl_model *m, uint32_t c, const tl_facet *facet)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_face_pair faces;
    return tl_cut_contact_faces(m, contacts->a[c], contacts->b[c], &faces) && faces.a == facet->ia &&
           faces.b == facet->ib;
}

tl_cut_contact *tl_cut_contact_on(const tl_model *m, uint32_t c, const tl_facet *facet)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_cut_contact *cut = tl_cut_contact_of(m, contacts->a[c], contacts->b[c]);
    return cut && (cut->field || is_on(m, c, facet)) ? cut : NULL;
}

bool tl_cut_contact_is_of_law(const tl_model *m, const tl_cut_contact *cut, uint32_t c)
{
    return tl_law_kind(m, cut->law) == tl_law_kind(m, m->detect->contacts.law[c]);
}

double tl_cut_contact_sign(const tl_model *m, const tl_cut_contact *cut, uint32_t c)
{
    return root_of(m, m->detect->contacts.a[c]) == cut->a ? 1 : -1;
}

double tl_cut_contact_kept(const tl_model *m, const tl_cut_contact *cut, uint32_t c)
{
    return tl_cut_contact_is_of_law(m, cut, c)
               ? cut->kept * tl_cut_contact_share(cut, tl_contact_area_of_points(m->detect, c))
               : 0;
}

/* The same as the other block sees it. */
static void turn_round(const tl_kind *kind, tl_old_point *point)
{
    point->normal = tl_v3_neg(point->normal);
    point->shear = tl_v3_neg(point->shear);
    for (tl_state_columns at = {0}; tl_state_next(kind, TL_STATE_COLUMNS, &at);)
        for (uint32_t w = at.begin; w < at.begin + at.count && at.count == 3; w++)
            point->state[w] = -point->state[w];
}

tl_old_point tl_cut_contact_point(const tl_model *m, const tl_cut_contact *cut, uint32_t c, size_t k)
{
    const tl_detect *d = m->detect;
    tl_old_point out = d->cut_points[cut->first + k];
    if (cut->field && out.reference != 0 && !is_on(m, c, &d->contacts.facet[c]))
        out.reference = 0;
    out.arm = tl_v3_sub(out.arm, tl_side_place(m, tl_contact_sides(m, c).a));
    if (tl_cut_contact_sign(m, cut, c) < 0)
        turn_round(tl_law_kind(m, cut->law), &out);
    return out;
}
