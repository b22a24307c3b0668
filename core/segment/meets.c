/* meets.c - which faces may touch by segments, and the segments that they have.
 *
 * Of two blocks that the broad phase lists, one of which is deformable, faces meet that look at each other and are
 * near. All triangles of one that lie over triangles of the other make a segment, closed or open. Segments stand until
 * their sides have slid by a share of a triangle's size, or faces that met no longer do. What points carry goes over:
 *
 *   - a segment of the same two triangles takes over from its own three points, by area;
 *   - another one takes the stress of the nearest old point of its meet;
 *   - of each meet the springs of shear hold no more energy than before.
 */
#include "segment/meets.h"

#include "contact/detection.h"
#include "contact/sides.h"
#include "force/joint_laws.h"
#include "model/joints.h"
#include "narrow/manifold.h"
#include "segment/blend.h"
#include "segment/lay.h"
#include "zone/grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Tolerance: cos of 12 degrees, up to which faces that meet may be tilted: beyond 10 a field contact has all (blend.c).
 */
#define LEAST_FACING 0.97814760073380563
/* Tolerance: distance over the size of the smaller block up to which faces meet. */
#define NEAR 0.02
/* Tolerance: sine of the tilt with which a centre may be farther from the other face: of 12 degrees. */
#define TILTS_BY 0.21
/* Tolerance: cos of 3 degrees, up to which faces are not tilted: a step in which meets are listed comes before 5. */
#define NOT_TILTED 0.99862953475457383

/* Cost only: steps after which meets are listed again, for faces that have tilted or come near. */
#define LIST_EVERY 16

/* ---------------------------------------------------------------- faces ------------------ */

/* A face of a block: its parts, or a rigid polygon; and its centre and vector area now. */
typedef struct face {
    uint32_t block, number;
    const tl_surface_part *part; /* NULL: rigid */
    size_t part_count;
    tl_vec3 centre, area;
    double size;  /* of all its parts, m2 */
    double reach; /* no corner is farther from the centre, m */
} face;

static tl_vec3 corner_of(const tl_model *m, const tl_surface_part *part, int k)
{
    return tl_gridpoint_place(&m->zones->points, part->corner[k]);
}

static void measure_parts(const tl_model *m, face *f)
{
    for (size_t k = 0; k < f->part_count; k++) {
        const tl_vec3 a = corner_of(m, &f->part[k], 0), b = corner_of(m, &f->part[k], 1),
                      c = corner_of(m, &f->part[k], 2);
        const tl_vec3 area = tl_v3_scale(0.5, tl_v3_cross(tl_v3_sub(b, a), tl_v3_sub(c, a)));
        const double size = tl_v3_norm(area);
        f->area = tl_v3_add(f->area, area);
        f->centre = tl_v3_madd(f->centre, size / 3, tl_v3_add(a, tl_v3_add(b, c)));
        f->size += size;
    }
    f->centre = tl_v3_scale(f->size > 0 ? 1 / f->size : 0, f->centre);
    for (size_t k = 0; k < f->part_count; k++)
        for (int i = 0; i < 3; i++)
            f->reach = fmax(f->reach, tl_v3_norm(tl_v3_sub(corner_of(m, &f->part[k], i), f->centre)));
}

static tl_vec3 rigid_corner(const tl_model *m, uint32_t block, uint32_t number, uint32_t k)
{
    const tl_poly *p = m->blocks.shape[block];
    return tl_body_point(&m->bodies, m->blocks.body[block], p->vertex[p->loop[p->start[number] + k]]);
}

static void measure_rigid(const tl_model *m, face *f)
{
    const uint32_t count = tl_poly_face_size(m->blocks.shape[f->block], f->number);
    const tl_vec3 first = rigid_corner(m, f->block, f->number, 0);
    for (uint32_t k = 1; k + 1 < count; k++)
        f->area = tl_v3_madd(f->area, 0.5,
                             tl_v3_cross(tl_v3_sub(rigid_corner(m, f->block, f->number, k), first),
                                         tl_v3_sub(rigid_corner(m, f->block, f->number, k + 1), first)));
    f->size = tl_v3_norm(f->area);
    for (uint32_t k = 0; k < count; k++)
        f->centre = tl_v3_madd(f->centre, 1.0 / count, rigid_corner(m, f->block, f->number, k));
    for (uint32_t k = 0; k < count; k++)
        f->reach = fmax(f->reach, tl_v3_norm(tl_v3_sub(rigid_corner(m, f->block, f->number, k), f->centre)));
}

static face face_of(const tl_model *m, uint32_t block, uint32_t number)
{
    face f = {.block = block, .number = number};
    f.part = tl_face_parts(m, m->blocks.id[block], number, &f.part_count);
    if (f.part)
        measure_parts(m, &f);
    else
        measure_rigid(m, &f);
    return f;
}

/* Whether a face lies on other blocks of its body with all of its triangles. */
static bool is_inside(const face *f)
{
    return f->part && f->part_count == 0;
}

/* The cosine of the tilt between the mean planes of two faces. */
static double tilt_cosine(const face *a, const face *b)
{
    return -tl_v3_dot(tl_v3_unit(a->area), tl_v3_unit(b->area));
}

/* Whether two faces look at each other and are near: the centre of one is near the plane of the other. */
static bool faces_meet(const tl_model *m, const face *a, const face *b)
{
    const tl_vec3 apart = tl_v3_sub(b->centre, a->centre);
    const double near = NEAR * fmin(m->blocks.size[a->block], m->blocks.size[b->block]);
    const double of_b = fabs(tl_v3_dot(apart, tl_v3_unit(a->area))), of_a = fabs(tl_v3_dot(apart, tl_v3_unit(b->area)));
    return tilt_cosine(a, b) > LEAST_FACING && fmin(of_a, of_b) < near + TILTS_BY * fmin(a->reach, b->reach) &&
           tl_v3_norm(apart) < a->reach + b->reach + near;
}

/* ---------------------------------------------------------------- depth ------------------ */

/* Tolerance: how much deeper than along another face the blocks may overlap along one that touches, and what of their
 * size beside: as of patches (narrow/manifold.c). Test: property/deform_properties. */
#define DEEPER 4.0
#define DEEPER_SIZE 1e-3

/* How deep a block reaches behind a face of another one, m; its shape is that as made. */
static double depth_behind(const tl_model *m, uint32_t block, uint32_t number, uint32_t other)
{
    const uint32_t body = m->blocks.body[block];
    const tl_vec3 n = tl_m3_mul(&m->bodies.pose[body].r, m->blocks.shape[block]->plane[number].normal);
    const tl_vec3 on = rigid_corner(m, block, number, 0);
    const tl_poly *p = m->blocks.shape[other];
    double least = INFINITY;
    for (uint32_t k = 0; k < p->vertex_count; k++) {
        const tl_vec3 x = tl_body_point(&m->bodies, m->blocks.body[other], p->vertex[k]);
        least = fmin(least, tl_v3_dot(n, tl_v3_sub(x, on)));
    }
    return -least;
}

/* ---------------------------------------------------------------- meets ------------------ */

/* A list of meets on its way. Each face is measured once, when it is first asked for; until then its reach is below 0.
 */
typedef struct listing {
    const tl_model *m;
    tl_meet *list;
    size_t count, capacity;
    face *face;
    size_t *start;    /* of each block, in `face` */
    double *depth[2]; /* of each face of two blocks: how deep the other block reaches behind it, m */
} listing;

/* false: out of memory. */
static bool listing_begin(listing *l, const tl_model *m)
{
    size_t all = 0, most = 0;
    *l = (listing){.m = m, .start = malloc((m->blocks.table.rows + 1) * sizeof *l->start)};
    for (size_t row = 0; l->start && row < m->blocks.table.rows; row++) {
        const size_t faces = m->blocks.shape[row]->face_count;
        l->start[row] = all;
        all += faces;
        most = faces > most ? faces : most;
    }
    l->face = malloc((all + 1) * sizeof *l->face);
    for (int side = 0; side < 2; side++)
        l->depth[side] = malloc((most + 1) * sizeof *l->depth[side]);
    for (size_t k = 0; l->face && k < all; k++)
        l->face[k].reach = -1;
    return l->start && l->face && l->depth[0] && l->depth[1];
}

/* Leaves the list itself. */
static void listing_end(listing *l)
{
    free(l->face);
    free(l->start);
    free(l->depth[0]);
    free(l->depth[1]);
}

static const face *measured(listing *l, uint32_t block, uint32_t number)
{
    face *at = &l->face[l->start[block] + number];
    if (at->reach < 0)
        *at = face_of(l->m, block, number);
    return at;
}

/* Finds the depths behind the faces of two blocks that no joined block covers. Returns that up to which faces touch:
 * behind others the blocks lie side by side. */
static double find_depths(listing *l, uint32_t a, uint32_t b)
{
    const tl_model *m = l->m;
    double least = INFINITY;
    for (int side = 0; side < 2; side++) {
        const uint32_t block = side ? b : a, other = side ? a : b;
        for (uint32_t k = 0; k < m->blocks.shape[block]->face_count; k++) {
            if (m->blocks.shape[block]->covered[k])
                continue;
            l->depth[side][k] = depth_behind(m, block, k, other);
            least = fmin(least, l->depth[side][k]);
        }
    }
    return DEEPER * fmax(least, 0) + DEEPER_SIZE * fmin(m->blocks.size[a], m->blocks.size[b]);
}

/* Adds the meet of two faces, if they meet. false: out of memory. */
static bool list_faces(listing *l, const face *a, const face *b)
{
    const tl_model *m = l->m;
    if (is_inside(a) || is_inside(b) || !faces_meet(m, a, b))
        return true;
    if (!tl_grow(&l->list, &l->capacity, l->count + 1, sizeof *l->list))
        return false;
    l->list[l->count++] = (tl_meet){
        .a = m->blocks.id[a->block],
        .b = m->blocks.id[b->block],
        .face_a = a->number,
        .face_b = b->number,
        .tag = tl_flush_tag(m->blocks.shape[a->block]->tag[a->number], m->blocks.shape[b->block]->tag[b->number]),
        .born = -1,
        .stale = true,
        .share = 0.5,
        .tilted = tilt_cosine(a, b) < NOT_TILTED,
        .alone = true,
        .size = fmin(a->size, b->size),
        .counts = 1,
        .flat = 1};
    return true;
}

/* Adds the meets of two blocks. false: out of memory. */
static bool list_pair(listing *l, uint32_t a, uint32_t b)
{
    const tl_poly *pa = l->m->blocks.shape[a], *pb = l->m->blocks.shape[b];
    const double most = find_depths(l, a, b);
    bool enough = true;
    for (uint32_t i = 0; i < pa->face_count; i++)
        for (uint32_t k = 0; enough && k < pb->face_count && !pa->covered[i]; k++)
            if (!pb->covered[k] && !(l->depth[0][i] > most && l->depth[1][k] > most))
                enough = list_faces(l, measured(l, a, i), measured(l, b, k));
    return enough;
}

static int compare_meets(const void *x, const void *y)
{
    const tl_meet *a = x, *b = y;
    if (a->a != b->a)
        return a->a < b->a ? -1 : 1;
    if (a->b != b->b)
        return a->b < b->b ? -1 : 1;
    if (a->face_a != b->face_a)
        return a->face_a < b->face_a ? -1 : 1;
    return (a->face_b > b->face_b) - (a->face_b < b->face_b);
}

/* Lists the meets of all pairs, in the order of their ids. */
static tl_meet *list_meets(const tl_model *m, size_t *count, bool *enough)
{
    listing l;
    *enough = listing_begin(&l, m);
    for (size_t k = 0; *enough && k < m->detect->pair_count; k++) {
        const uint32_t a = m->detect->pairs[k].a, b = m->detect->pairs[k].b;
        const bool seen = !m->blocks.hidden[a] && !m->blocks.hidden[b] && m->blocks.body[a] != m->blocks.body[b];
        if (seen && tl_blocks_deform_either(m, a, b))
            *enough = list_pair(&l, a, b);
    }
    listing_end(&l);
    if (l.count > 0)
        qsort(l.list, l.count, sizeof *l.list, compare_meets);
    *count = l.count;
    return l.list;
}

/* ---------------------------------------------------------------- segments --------------- */

/* Two faces, or parts of them: a rigid face has one part, itself. */
typedef struct face_parts {
    const face *of[2];
    size_t at[2];
} face_parts;

/* Lays two parts over each other. `scratch`: room for the corners of a rigid one. false: nothing in common. */
static bool lay_over(const tl_model *m, const face_parts *p, double share, tl_vec3 *scratch, tl_overlay_room *room,
                     tl_overlay *over)
{
    tl_vec3 corner[2][3];
    tl_outer_face outer[2];
    for (int s = 0; s < 2; s++) {
        const face *of = p->of[s];
        if (of->part) {
            for (int c = 0; c < 3; c++)
                corner[s][c] = corner_of(m, &of->part[p->at[s]], c);
            outer[s] = (tl_outer_face){corner[s], 3};
        } else {
            const uint32_t count = tl_poly_face_size(m->blocks.shape[of->block], of->number);
            for (uint32_t c = 0; c < count; c++)
                scratch[c] = rigid_corner(m, of->block, of->number, c);
            outer[s] = (tl_outer_face){scratch, count};
        }
    }
    return tl_overlay_find(&outer[0], &outer[1], share, room, over);
}

/* ---------------------------------------------------------------- boxes ------------------ */

/* Tolerance: distance over the reach of two faces by which boxes of parts must be apart beyond doubt: rounding of the
 * projection is far below. */
#define APART_SURELY 1e-9

static size_t parts_of(const face *f)
{
    return f->part ? f->part_count : 1;
}

/* Corner c of a part of a face. */
static tl_vec3 part_corner(const tl_model *m, const face *f, size_t part, size_t c)
{
    return f->part ? corner_of(m, &f->part[part], (int)c) : rigid_corner(m, f->block, f->number, (uint32_t)c);
}

/* The box of a part of a face, in a frame whose third axis goes along an outward normal: `sign` -1 means inward. */
static tl_part_box box_of(const tl_model *m, const face *f, size_t part, const tl_vec3 axis[3], double sign)
{
    tl_part_box box = {.low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}};
    const size_t corners = f->part ? 3 : tl_poly_face_size(m->blocks.shape[f->block], f->number);
    const tl_vec3 first = part_corner(m, f, part, 0);
    tl_vec3 area = {0, 0, 0};
    for (size_t c = 0; c < corners; c++) {
        const tl_vec3 x = part_corner(m, f, part, c);
        for (int k = 0; k < 3; k++) {
            const double at = tl_v3_dot(axis[k], tl_v3_sub(x, f->centre));
            box.low[k] = at < box.low[k] ? at : box.low[k];
            box.high[k] = at > box.high[k] ? at : box.high[k];
        }
        if (c + 1 < corners)
            area = tl_v3_add(area, tl_v3_cross(tl_v3_sub(x, first), tl_v3_sub(part_corner(m, f, part, c + 1), first)));
    }
    const double up = sign * tl_v3_dot(axis[2], area), x = tl_v3_dot(axis[0], area), y = tl_v3_dot(axis[1], area);
    box.slope = up > 0 ? sqrt(x * x + y * y) / up : INFINITY;
    return box;
}

/* Finds the boxes of all parts of two faces, in one frame: those of A, then those of B. false: out of memory. */
static bool find_boxes(tl_model *m, const face *a, const face *b)
{
    struct tl_segments *s = m->segments;
    const size_t count_a = parts_of(a), count = count_a + parts_of(b);
    if (!tl_grow(&s->box, &s->box_capacity, count, sizeof *s->box))
        return false;
    const tl_vec3 n = tl_v3_unit(a->area), e = tl_v3_perpendicular(n), axis[3] = {e, tl_v3_cross(n, e), n};
    const tl_vec3 apart = tl_v3_sub(b->centre, a->centre);
    for (size_t k = 0; k < count; k++)
        s->box[k] = k < count_a ? box_of(m, a, k, axis, 1) : box_of(m, b, k - count_a, axis, -1);
    for (size_t k = count_a; k < count; k++)
        for (int i = 0; i < 3; i++) {
            s->box[k].low[i] += tl_v3_dot(axis[i], apart);
            s->box[k].high[i] += tl_v3_dot(axis[i], apart);
        }
    return true;
}

/* Whether two parts have nothing in common beyond doubt. They are projected along a direction between their normals:
 * over their distance in height that goes aside by no more than the steeper slope. `margin`: for rounding, m. */
static bool boxes_apart(const tl_part_box *a, const tl_part_box *b, double margin)
{
    double wide = -INFINITY;
    for (int k = 0; k < 2; k++) {
        const double before = a->low[k] - b->high[k], behind = b->low[k] - a->high[k];
        wide = before > wide ? before : wide;
        wide = behind > wide ? behind : wide;
    }
    if (!(wide > margin))
        return false;
    const double above = a->high[2] - b->low[2], below = b->high[2] - a->low[2];
    const double height = above > below ? above : below, slope = a->slope > b->slope ? a->slope : b->slope;
    return wide > margin + height * slope;
}

/* ---------------------------------------------------------------- segments of meets ------ */

/* Notes a segment of two parts, or of a part and a rigid face, that lie over each other. false: out of memory. */
static bool note_segment(tl_model *m, tl_laying *l, uint32_t meet, const face *a, size_t i, const face *b, size_t k)
{
    tl_new_segment made = {.meet = meet, .key = {(uint32_t)i, (uint32_t)k}};
    struct tl_segments *to = m->segments;
    if (!lay_over(m, &(face_parts){{a, b}, {i, k}}, to->meet[meet].share, to->corner, &to->room, &made.over))
        return true;
    const face *of[2] = {a, b};
    const size_t at[2] = {i, k};
    for (int s = 0; s < 2; s++) {
        const uint32_t body = m->blocks.body[of[s]->block];
        tl_segment_side *side = s ? &made.b : &made.a;
        for (int c = 0; c < 3; c++)
            side->at[c] = of[s]->part ? of[s]->part[at[s]].corner[c] : c ? TL_NO_ROW : body;
        if (!of[s]->part)
            *(s ? &made.normal_b : &made.normal_a) = m->blocks.shape[of[s]->block]->plane[of[s]->number].normal;
    }
    return tl_laying_add(l, &made);
}

/* Corners that scratch for a pair of faces has room for. */
static size_t corners_for(const tl_model *m, const face *a, const face *b)
{
    const size_t na = a->part ? 3 : tl_poly_face_size(m->blocks.shape[a->block], a->number);
    const size_t nb = b->part ? 3 : tl_poly_face_size(m->blocks.shape[b->block], b->number);
    return na + nb + 4;
}

/* Room for overlays of polygons of so many corners together. */
static bool make_overlay_room(tl_overlay_room *room, tl_point2 **memory, size_t need)
{
    if (need <= room->capacity)
        return true;
    tl_point2 *all = malloc(3 * need * sizeof *all);
    if (!all)
        return false;
    free(*memory);
    *memory = all;
    *room = (tl_overlay_room){all, all + need, all + 2 * need, need};
    return true;
}

/* Room for the corners of the faces of a meet. */
static bool make_room(tl_model *m, const face *a, const face *b)
{
    struct tl_segments *s = m->segments;
    const size_t need = corners_for(m, a, b);
    return tl_grow(&s->corner, &s->corner_capacity, need, sizeof *s->corner) &&
           make_overlay_room(&s->room, &s->room_memory, need);
}

/* Tolerance: share of a face that counts as left out when all is covered: two faces that cover each other share their
 * outline. */
#define LEFT_OUT 1e-6

/* How far the outline of an area that two faces have in common is B's: by what of each is left out. */
static double share_of(double common, const face *a, const face *b)
{
    const double out_a = fmax(1 - common / a->size, 0) + LEFT_OUT, out_b = fmax(1 - common / b->size, 0) + LEFT_OUT;
    return out_a / (out_a + out_b);
}

/* The distance by which boxes of the parts of two faces must be apart. */
static double margin_of(const face *a, const face *b)
{
    return APART_SURELY * (a->reach + b->reach);
}

/* The area that two faces have in common, m2. Their boxes are known. */
static double common_area(tl_model *m, const face *a, const face *b)
{
    const tl_part_box *box = m->segments->box;
    const double margin = margin_of(a, b);
    double sum = 0;
    tl_overlay over;
    for (size_t i = 0; i < parts_of(a); i++)
        for (size_t k = 0; k < parts_of(b); k++)
            if (!boxes_apart(&box[i], &box[parts_of(a) + k], margin) &&
                lay_over(m, &(face_parts){{a, b}, {i, k}}, 0.5, m->segments->corner, &m->segments->room, &over))
                sum += over.area;
    return sum;
}

/* Notes the segments of a meet, in the order of their parts. */
static bool find_segments(tl_model *m, tl_laying *l, uint32_t number)
{
    tl_meet *meet = &m->segments->meet[number];
    const face a = face_of(m, tl_block_row_quiet(m, meet->a), meet->face_a);
    const face b = face_of(m, tl_block_row_quiet(m, meet->b), meet->face_b);
    bool enough = make_room(m, &a, &b) && find_boxes(m, &a, &b);
    const tl_part_box *box = m->segments->box;
    const double margin = margin_of(&a, &b);
    if (enough)
        meet->share = share_of(meet->area > 0 ? meet->area : common_area(m, &a, &b), &a, &b);
    for (size_t i = 0; enough && i < parts_of(&a); i++)
        for (size_t k = 0; enough && k < parts_of(&b); k++)
            if (!boxes_apart(&box[i], &box[parts_of(&a) + k], margin))
                enough = note_segment(m, l, number, &a, i, &b, k);
    return enough;
}

/* Lists the pairs of blocks that meet by segments alone. false: out of memory. */
static bool list_meeting(tl_model *m)
{
    const struct tl_segments *s = m->segments;
    struct tl_zones *z = m->zones;
    if (!tl_grow(&z->meeting, &z->meeting_capacity, s->meet_count + 1, sizeof *z->meeting))
        return false;
    z->meeting_count = 0;
    for (size_t k = 0; k < s->meet_count; k++) {
        const uint64_t pair = (uint64_t)s->meet[k].a << 32 | s->meet[k].b;
        if (s->meet[k].area > 0 && s->meet[k].alone &&
            (z->meeting_count == 0 || z->meeting[z->meeting_count - 1] != pair))
            z->meeting[z->meeting_count++] = pair;
    }
    return true;
}

/* Meets of blocks that have got other shapes, or zones, are laid anew. */
static void mark_changed(tl_model *m)
{
    struct tl_segments *s = m->segments;
    for (size_t k = 0; k < s->meet_count; k++) {
        const uint32_t a = tl_block_row_quiet(m, s->meet[k].a), b = tl_block_row_quiet(m, s->meet[k].b);
        s->meet[k].stale =
            s->meet[k].stale || m->blocks.changed[a] > s->structure || m->blocks.changed[b] > s->structure;
    }
}

/* Lays the segments that have been found: in their rows, where nothing is in the way. false: out of memory. */
static bool lay_found(tl_model *m, tl_laying *l, bool others)
{
    const bool in_place = !others && tl_laying_fits(m, l);
    if (in_place)
        tl_renew_segments(m, l);
    return in_place || tl_lay_segments(m, l);
}

tl_status tl_segments_find(tl_model *m)
{
    if (!tl_model_deforms(m))
        return TL_OK;
    if (!m->segments && !tl_segments_begin(m))
        return tl_fail_memory(&m->error);
    struct tl_segments *s = m->segments;
    const bool anew = m->cycles % LIST_EVERY == 0 || s->structure != m->structure || s->zones != m->zones->version ||
                      s->lists != m->detect->lists;
    const bool others = s->version == 0 || s->structure != m->structure || s->zones != m->zones->version ||
                        s->laws != m->laws; /* rows, parts or laws are others */
    bool some = anew || others, enough = true;
    tl_laying l;
    tl_laying_begin(&l);
    for (size_t row = 0; row < s->table.table.rows; row++)
        if (s->table.slid[row] && s->table.of[row].meet != TL_NO_ROW)
            s->meet[s->table.of[row].meet].stale = true;
    if (anew) {
        size_t count;
        tl_meet *list = list_meets(m, &count, &enough);
        if (enough)
            tl_laying_change_meets(m, &l, list, count);
        else
            free(list);
        mark_changed(m);
    }
    for (size_t k = 0; k < s->meet_count; k++)
        some = some || s->meet[k].stale;
    for (uint32_t k = 0; enough && some && k < s->meet_count; k++)
        if (s->meet[k].stale)
            enough = find_segments(m, &l, k);
    if (enough && some)
        enough = lay_found(m, &l, others);
    enough = enough && tl_grow(&s->blend, &s->blend_capacity, s->meet_count + 1, sizeof *s->blend);
    if (enough && (tl_blends_find(m) || some))
        enough = list_meeting(m);
    tl_laying_end(&l);
    if (!enough)
        return tl_fail_memory(&m->error);
    s->structure = m->structure;
    s->laws = m->laws;
    s->zones = m->zones->version;
    s->lists = m->detect->lists;
    return TL_OK;
}

tl_status tl_segments_ask(tl_model *m)
{
    const struct tl_segments *s = m->segments;
    const bool found = s && s->structure == m->structure && s->laws == m->laws && s->zones == m->zones->version &&
                       s->lists == m->detect->lists;
    if (!tl_model_deforms(m) || (s && !s->asked) || found)
        return TL_OK;
    tl_segments_forget_asked(m);
    const tl_status status = tl_segments_find(m);
    if (m->segments)
        m->segments->asked = true;
    return status;
}

void tl_segments_forget_asked(tl_model *m)
{
    if (!m->segments || !m->segments->asked)
        return;
    tl_segments_free(m->segments);
    m->segments = NULL;
    m->segments_follow = NULL;
    m->zones->meeting_count = 0;
}

/* ---------------------------------------------------------------- covers ----------------- */

/* The list of covers on its way. */
typedef struct covering {
    const tl_model *m;
    tl_cover *list;
    size_t count, capacity;
    tl_vec3 *corner;
    size_t corner_capacity;
    tl_overlay_room room;
    tl_point2 *memory;
} covering;

static uint32_t part_row(const tl_model *m, const face *f, size_t k)
{
    return f->part ? (uint32_t)(f->part - m->zones->part + (ptrdiff_t)k) : TL_NO_ROW;
}

/* Notes two parts that lie on each other, for both. false: out of memory. */
static bool note_cover(covering *c, const face_parts *p)
{
    const tl_model *m = c->m;
    const face *a = p->of[0], *b = p->of[1];
    tl_overlay over;
    double gap = 0;
    if (!lay_over(m, p, 0.5, c->corner, &c->room, &over))
        return true;
    for (int k = 0; k < TL_SEGMENT_POINTS; k++)
        gap += tl_v3_dot(tl_v3_sub(over.on_b[k], over.on_a[k]), over.n) / TL_SEGMENT_POINTS;
    if (gap > TL_CONTACT_TOLERANCE * fmin(m->blocks.size[a->block], m->blocks.size[b->block]))
        return true;
    if (!tl_grow(&c->list, &c->capacity, c->count + 2, sizeof *c->list))
        return false;
    const uint32_t x = part_row(m, a, p->at[0]), y = part_row(m, b, p->at[1]);
    tl_cover *of_a = &c->list[c->count++], *of_b = &c->list[c->count++];
    *of_a = (tl_cover){a->block, a->number, x, b->block, b->number, y, over.area, {{0, 0, 0}}};
    *of_b = (tl_cover){b->block, b->number, y, a->block, a->number, x, over.area, {{0, 0, 0}}};
    memcpy(of_a->at, over.on_a, sizeof of_a->at);
    memcpy(of_b->at, over.on_b, sizeof of_b->at);
    return true;
}

static bool cover_faces(covering *c, const face *a, const face *b)
{
    const size_t need = corners_for(c->m, a, b);
    bool enough = tl_grow(&c->corner, &c->corner_capacity, need, sizeof *c->corner) &&
                  make_overlay_room(&c->room, &c->memory, need);
    for (size_t i = 0; enough && i < parts_of(a); i++)
        for (size_t k = 0; enough && k < parts_of(b); k++)
            enough = note_cover(c, &(face_parts){{a, b}, {i, k}});
    return enough;
}

static bool cover_blocks(covering *c, uint32_t a, uint32_t b)
{
    const tl_poly *pa = c->m->blocks.shape[a], *pb = c->m->blocks.shape[b];
    bool enough = true;
    for (uint32_t i = 0; i < pa->face_count; i++) {
        const face fa = face_of(c->m, a, i);
        for (uint32_t k = 0; enough && k < pb->face_count; k++) {
            const face fb = face_of(c->m, b, k);
            if (!pa->covered[i] && !pb->covered[k] && faces_meet(c->m, &fa, &fb))
                enough = cover_faces(c, &fa, &fb);
        }
    }
    return enough;
}

static int compare_covers(const void *x, const void *y)
{
    const tl_cover *a = x, *b = y;
    const uint32_t p[5] = {a->block, a->face, a->part, a->other_block, a->other_part};
    const uint32_t q[5] = {b->block, b->face, b->part, b->other_block, b->other_part};
    for (int k = 0; k < 5; k++)
        if (p[k] != q[k])
            return p[k] < q[k] ? -1 : 1;
    return 0;
}

bool tl_meets_cover(const tl_model *m, tl_cover **list, size_t *count)
{
    covering c = {.m = m};
    bool enough = true;
    for (size_t k = 0; enough && m->detect && k < m->detect->pair_count; k++) {
        const uint32_t a = m->detect->pairs[k].a, b = m->detect->pairs[k].b;
        if (m->blocks.body[a] != m->blocks.body[b] && tl_blocks_deform_either(m, a, b))
            enough = cover_blocks(&c, a, b);
    }
    if (c.count > 0)
        qsort(c.list, c.count, sizeof *c.list, compare_covers);
    free(c.corner);
    free(c.memory);
    *list = c.list;
    *count = c.count;
    return enough;
}
