/* field.c - integrals of the pressure field of two blocks: field.h says what it is.
 *
 * On the part of S that belongs to the faces a and b, d_h >= d_a for all others h, and d_a >= 0. It is a polygon in a
 * plane, bounded by a line for each other face. Eight polygons are worked on side by side (field_lanes.c), of one pair
 * or of several.
 *
 * K consists of cells, one for each face, where that face is the nearest. The fields -n d^2 / 2 and -n d have the
 * divergences d and 1 in the cell of a face of normal n. They vanish on the face. So G and V are sums over the
 * polygons between two cells, and over the borders: G = sum |n_i - n_j| / 2 int d^2 dS and V = sum |n_i - n_j| int d
 * dS. No term between cells is negative.
 *
 * Of a block whose faces that bound K meet in a point S alone tells the share in G.
 *
 * Without borders a face has a cell only if it bounds K. From any point of its cell the way along its normal stays in
 * K to the face. So the faces that bounded K at another time are enough for all polygons, while they still enclose K
 * and nothing else. They do while no corner of what they enclose lies beyond another face. Corners on faces of both
 * blocks lie on S, where d = 0, and are looked at here; the others are corners of one block (press.c). Otherwise the
 * faces that bound K are found again, as those of which the others leave some. */
#include "narrow/field.h"

#include "base/inline.h"
#include "narrow/apex.h"
#include "narrow/field_lanes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

#define LANES TL_LANES

static uint32_t real_faces(const tl_field_faces *f)
{
    return f->a + f->b;
}

static uint32_t all_faces(const tl_field_faces *f)
{
    return f->a + f->b + f->border_a + f->border_b;
}

static tl_vec3 lane_vector(const double v[3][LANES], int lane)
{
    return tl_v3(v[0][lane], v[1][lane], v[2][lane]);
}

/* ---------------------------------------------------------------- work ------------------- */

/* Some of the planes of a pair. */
typedef struct list {
    const uint16_t *number;
    uint32_t count;
} list;

/* Polygons as they are found, before they are put together. */
typedef struct mesh_draft {
    bool full; /* there are more than a mesh has room for */
    uint8_t polygons, labels;
    uint8_t own[TL_MESH_POLYGONS][2], sides[TL_MESH_POLYGONS];
    uint8_t label[TL_MESH_SIDES]; /* the plane on the other side of each side; TL_MESH_ZERO: none */
} mesh_draft;

/* The integrals of one pair. */
typedef struct pair {
    const tl_field_faces *faces;
    tl_field_sums *sums;
    uint16_t *number;
    list planes, others; /* planes that bound polygons; faces that are to bound none */
    double one_plane;    /* offset within which planes are one */
    bool beyond;         /* some corner lies beyond one of the others */
    uint64_t found;      /* faces that bound K, when its own faces are looked at */
    mesh_draft *draft;   /* its polygons are noted here; NULL: nowhere */
    tl_apex_faces by[2]; /* what holds the apexes of A and of B */
    tl_apex apex[2];
    double by_force, by_swept;        /* of S: int d x . n dS, int x . n dS */
    double by_power[TL_FIELD_POWERS]; /* and int d^2 x . n dS, int d^3 x . n dS */
} pair;

/* Polygons, eight at a time. */
typedef struct work {
    int filled;
    tl_field_lanes lanes;
    tl_field_parts parts;
    tl_field_bounds bound;
    const pair *laid; /* whose planes are in the lanes that are left; NULL: nobody's */
    pair *of[LANES];
    uint32_t face[LANES], with[LANES]; /* the polygon's two planes */
    uint32_t i[LANES], j[LANES];       /* the same as numbers of those that bound polygons */
} work;

static void free_room(tl_field_scratch *scratch)
{
    free(scratch->line);
    free(scratch->plane);
    free(scratch->number);
    *scratch = (tl_field_scratch){0};
}

static bool make_room(tl_field_scratch *scratch, uint32_t lines, uint32_t numbers)
{
    if (lines <= scratch->lines && numbers <= scratch->numbers)
        return true;
    free_room(scratch);
    scratch->line = aligned_alloc(TL_ALIGN, 2u * lines * sizeof *scratch->line);
    scratch->plane = aligned_alloc(TL_ALIGN, 4u * lines * sizeof *scratch->plane);
    scratch->number = malloc(2u * numbers * sizeof *scratch->number);
    if (!scratch->line || !scratch->plane || !scratch->number)
        return false;
    scratch->lines = 2 * lines;
    scratch->numbers = 2 * numbers;
    return true;
}

/* Takes the faces of a mask, or all, and the borders for the planes that bound polygons. */
static void choose(pair *p, const uint64_t *mask)
{
    const tl_field_faces *f = p->faces;
    uint32_t count = all_faces(f), chosen = 0, left = count;
    double largest = 0;
    for (uint32_t i = 0; i < count; i++) {
        largest = fmax(largest, fabs(f->c[i]));
        if (!mask || *mask >> i & 1)
            p->number[chosen++] = (uint16_t)i;
        else
            p->number[--left] = (uint16_t)i;
    }
    p->planes = (list){p->number, chosen};
    p->others = (list){p->number + left, count - left};
    p->one_plane = TL_FIELD_ONE_PLANE * largest;
    p->beyond = false;
}

/* ---------------------------------------------------------------- meshes -----------------
 *
 * A new mesh of the polygons (field_mesh.c): their corners by the planes that meet there. */

/* Whether the normal of one line comes before that of another, counterclockwise. */
static bool before(const tl_field_line *line, unsigned lane, size_t i, size_t j)
{
    double it = line[i].gt[lane], is = line[i].gs[lane];
    double jt = line[j].gt[lane], js = line[j].gs[lane];
    bool low_i = is < 0 || (is == 0 && it < 0), low_j = js < 0 || (js == 0 && jt < 0);
    return low_i != low_j ? low_j : it * js - is * jt > 0;
}

/* Adds the polygon of a lane to a draft. `own` are its two planes, `bound` those whose lines come after the first one,
 * which is that of d = 0. */
static void draw_polygon(mesh_draft *draft, const uint16_t own[2], const uint16_t *bound, const tl_field_line *line,
                         size_t lines, unsigned lane)
{
    uint8_t side[TL_MESH_SIDES];
    uint32_t sides = 0;
    draft->full = draft->full || draft->polygons == TL_MESH_POLYGONS;
    for (size_t k = 0; k < lines && !draft->full; k++) {
        if (!(line[k].to[lane] > line[k].from[lane]) || line[k].c[lane] >= TL_FIELD_FAR)
            continue;
        draft->full = draft->labels + sides == TL_MESH_SIDES;
        if (draft->full)
            break;
        uint32_t at = sides++;
        for (; at > 0 && before(line, lane, k, side[at - 1]); at--)
            side[at] = side[at - 1];
        side[at] = (uint8_t)k;
    }
    if (draft->full || sides < 3) /* it has the area of roundings */
        return;
    uint32_t polygon = draft->polygons++;
    draft->own[polygon][0] = (uint8_t)own[0];
    draft->own[polygon][1] = (uint8_t)own[1];
    draft->sides[polygon] = (uint8_t)sides;
    for (uint32_t k = 0; k < sides; k++)
        draft->label[draft->labels++] = side[k] ? (uint8_t)bound[side[k] - 1] : TL_MESH_ZERO;
}

static void sort_planes(uint8_t plane[4])
{
    for (int i = 1; i < 4; i++)
        for (int k = i; k > 0 && plane[k] < plane[k - 1]; k--) {
            uint8_t swap = plane[k];
            plane[k] = plane[k - 1];
            plane[k - 1] = swap;
        }
}

/* Gives all corners in one corner of a block the same planes: three that meet there, and d = 0 where one of them is a
 * face's, or else the face that is the nearest. */
static void name_by_vertex(const tl_field_faces *f, uint8_t plane[4])
{
    for (uint32_t k = 0; f->vertices && k < f->vertices->count; k++) {
        const uint8_t *three = f->vertices->three[k];
        uint8_t other = TL_MESH_ZERO;
        int others = 0;
        for (int i = 0; i < 4; i++)
            if (plane[i] == TL_MESH_ZERO || !(f->vertices->planes[k] >> plane[i] & 1)) {
                other = plane[i];
                others++;
            }
        bool on_face = three[0] < real_faces(f);
        if (others > 1 || (on_face ? other != TL_MESH_ZERO : other >= real_faces(f)))
            continue;
        plane[0] = other;
        memcpy(plane + 1, three, 3);
        return;
    }
}

/* The number of a corner of four planes, which is added when there is none; TL_MESH_CORNERS: there is no room. */
static uint32_t corner_of(const tl_field_faces *f, tl_field_mesh *mesh, const uint8_t own[2], uint8_t one,
                          uint8_t other)
{
    uint8_t plane[4] = {own[0], own[1], one, other};
    name_by_vertex(f, plane);
    sort_planes(plane);
    for (uint32_t corner = 0; corner < mesh->corners; corner++) {
        bool same = true;
        for (int k = 0; k < 4; k++)
            same = same && mesh->plane[k][corner] == plane[k];
        if (same)
            return corner;
    }
    if (mesh->corners == TL_MESH_CORNERS)
        return TL_MESH_CORNERS;
    for (int k = 0; k < 4; k++)
        mesh->plane[k][mesh->corners] = plane[k];
    return mesh->corners++;
}

/* Whether a polygon is part of S. */
static bool on_surface(const tl_field_mesh *mesh, const tl_field_faces *f, uint32_t polygon)
{
    return mesh->own[polygon][0] < f->a && mesh->own[polygon][1] >= f->a && mesh->own[polygon][1] < f->a + f->b;
}

/* Whether another polygon of S has a side between two corners, the other way round. */
static bool has_neighbour(const tl_field_mesh *mesh, const tl_field_faces *f, uint32_t polygon, uint8_t from,
                          uint8_t to)
{
    const uint8_t *loop = mesh->loop;
    for (uint32_t k = 0; k < mesh->polygons; loop += mesh->sides[k++])
        for (uint32_t i = 0; i < mesh->sides[k] && k != polygon && on_surface(mesh, f, k); i++)
            if (loop[i] == to && loop[i + 1 < mesh->sides[k] ? i + 1 : 0] == from)
                return true;
    return false;
}

/* Whether the polygon of two planes has a side between two corners. */
static bool has_side(const tl_field_mesh *mesh, uint8_t one, uint8_t other, uint8_t from, uint8_t to)
{
    const uint8_t *loop = mesh->loop;
    for (uint32_t k = 0; k < mesh->polygons; loop += mesh->sides[k++]) {
        if (mesh->own[k][0] != (one < other ? one : other) || mesh->own[k][1] != (one < other ? other : one))
            continue;
        for (uint32_t i = 0; i < mesh->sides[k]; i++) {
            uint8_t next = loop[i + 1 < mesh->sides[k] ? i + 1 : 0];
            if ((loop[i] == from && next == to) || (loop[i] == to && next == from))
                return true;
        }
    }
    return false;
}

/* Whether all polygons are there that meet in a side of a polygon: of its two planes and that of the label two by two,
 * but for two borders. */
static bool has_all(const tl_field_mesh *mesh, const tl_field_faces *f, uint32_t polygon, uint8_t label, uint8_t from,
                    uint8_t to)
{
    for (int own = 0; own < 2; own++) {
        uint8_t by = mesh->own[polygon][own];
        bool borders = by >= f->a + f->b && label >= f->a + f->b;
        if (!borders && !has_side(mesh, by, label, from, to))
            return false;
    }
    return true;
}

/* Whether the polygons hang together: with seams all of them, else those of S. A side on the surface of K, with d = 0,
 * belongs to one only. The label of a side is that between its corner and the one before. */
static bool hangs_together(const tl_field_mesh *mesh, const uint8_t *label, const tl_field_faces *f)
{
    const uint8_t *loop = mesh->loop;
    for (uint32_t k = 0; k < mesh->polygons; k++) {
        uint32_t sides = mesh->sides[k];
        for (uint32_t i = 0; i < sides; i++) {
            uint8_t from = loop[i ? i - 1 : sides - 1], to = loop[i];
            if (label[i] == TL_MESH_ZERO || !(f->seamed || on_surface(mesh, f, k)))
                continue;
            if (!(f->seamed ? has_all(mesh, f, k, label[i], from, to) : has_neighbour(mesh, f, k, from, to)))
                return false;
        }
        loop += sides;
        label += sides;
    }
    return true;
}

/* Adds the corners of a polygon to the end of a mesh, and its labels to those of the mesh. Sides that begin and end in
 * one corner are left out, and what has no three sides then. false: there is no room. */
static bool add_polygon(const tl_field_faces *f, const mesh_draft *draft, uint32_t polygon, const uint8_t *label,
                        tl_field_mesh *mesh, uint8_t **loop, uint8_t **labels)
{
    const uint32_t all = draft->sides[polygon];
    uint8_t corner[TL_MESH_SIDES];
    uint32_t sides = 0;
    for (uint32_t i = 0; i < all; i++) {
        uint32_t number = corner_of(f, mesh, draft->own[polygon], label[i], label[i + 1 < all ? i + 1 : 0]);
        if (number == TL_MESH_CORNERS)
            return false;
        corner[i] = (uint8_t)number;
    }
    for (uint32_t i = 0; i < all; i++)
        sides += corner[i] != corner[i ? i - 1 : all - 1];
    if (sides < 3)
        return true;
    for (uint32_t i = 0; i < all; i++)
        if (corner[i] != corner[i ? i - 1 : all - 1]) {
            *(*loop)++ = corner[i];
            *(*labels)++ = label[i];
        }
    memcpy(mesh->own[mesh->polygons], draft->own[polygon], sizeof mesh->own[0]);
    mesh->sides[mesh->polygons++] = (uint8_t)sides;
    return true;
}

/* Where the labels of each polygon of a draft begin, and the order of the polygons in a mesh: those at borders last,
 * and of each sort those with many sides first. For those side by side take as long as the one with the most. */
static void order_polygons(const mesh_draft *draft, const tl_field_faces *faces, uint8_t begin[], uint8_t order[])
{
    uint32_t labels = 0;
    for (uint32_t k = 0; k < draft->polygons; labels += draft->sides[k++]) {
        const bool border = draft->own[k][1] >= real_faces(faces);
        uint32_t at = k;
        begin[k] = (uint8_t)labels;
        for (; at > 0; at--) {
            const uint8_t other = order[at - 1];
            const bool other_border = draft->own[other][1] >= real_faces(faces);
            if (border != other_border ? border : draft->sides[other] >= draft->sides[k])
                break;
            order[at] = other;
        }
        order[at] = (uint8_t)k;
    }
}

/* Makes a mesh of all polygons of a field. It has none when they do not fit together, or are too many. */
static void make_mesh(const mesh_draft *draft, const tl_field_faces *faces, tl_field_mesh *mesh)
{
    uint8_t begin[TL_MESH_POLYGONS], order[TL_MESH_POLYGONS];
    uint8_t labels[TL_MESH_SIDES], *of_mesh = labels, *loop = mesh->loop;
    uint64_t bounding = mesh->bounding;
    memset(mesh, 0, sizeof *mesh);
    mesh->bounding = bounding;
    if (draft->full || draft->polygons == 0 || !faces->inner || faces->inner->count > TL_MESH_INNER)
        return;
    bool fits = true;
    order_polygons(draft, faces, begin, order);
    for (uint32_t k = 0; k < draft->polygons && fits; k++)
        fits = add_polygon(faces, draft, order[k], draft->label + begin[order[k]], mesh, &loop, &of_mesh);
    for (uint32_t k = 0; k < faces->inner->count && fits; k++) {
        const uint8_t *face = faces->inner->face[k];
        fits = corner_of(faces, mesh, face, face[2], TL_MESH_ZERO) < TL_MESH_CORNERS;
    }
    for (uint32_t i = mesh->corners; i % LANES; i++) /* what is left of eight is the first again */
        for (int k = 0; k < 4; k++)
            mesh->plane[k][i] = mesh->plane[k][0];
    if (!fits || !hangs_together(mesh, labels, faces)) {
        memset(mesh, 0, sizeof *mesh);
        mesh->bounding = bounding;
    }
}

/* ---------------------------------------------------------------- sums ------------------- */

static tl_vec3 plus(tl_vec3 sum, double sign, const double v[3][LANES], int l)
{
    return tl_v3_madd(sum, sign, lane_vector(v, l));
}

/* The same in the gradients of the powers of d. */
static void add_power_gradients(const work *w, int l, double sign)
{
    const tl_field_parts *o = &w->parts;
    const double over[] = {o->dd[l], o->cube[l]};
    const tl_vec3 n = lane_vector(w->lanes.n, l);
    for (int k = 0; k < TL_FIELD_POWERS; k++) {
        tl_field_power *to = &w->of[l]->sums->powers[k];
        to->force = tl_v3_madd(to->force, sign * over[k], n);
        to->moment = plus(to->moment, sign, o->power_moment[k], l);
    }
}

/* Adds the sides of cells to the integrals of the powers of d. The fields -n d^3 / 3 and -n d^4 / 4 have the
 * divergences d^2 and d^3. */
static void add_power_sides(work *w, int l, double slope)
{
    tl_field_power *to = w->of[l]->sums->powers;
    if (!w->of[l]->faces->powers)
        return;
    to[0].whole += (1.0 / 3) * slope * w->parts.cube[l];
    to[1].whole += 0.25 * slope * w->parts.fourth[l];
}

/* Adds a polygon's part in the gradients of G and V. */
static void add_gradient(work *w, int l, double sign)
{
    if (w->of[l]->faces->powers)
        add_power_gradients(w, l, sign);
    const tl_field_parts *o = &w->parts;
    tl_field_sums *sums = w->of[l]->sums;
    sums->force = plus(sums->force, sign, o->force, l);
    sums->moment = plus(sums->moment, sign, o->moment, l);
    sums->swept = plus(sums->swept, sign, o->swept, l);
    sums->swept_moment = plus(sums->swept_moment, sign, o->swept_moment, l);
}

/* Adds what a polygon of S gives of the energy and volume of the cells on its sides, unless the block has an apex. */
static void add_sides(work *w, int l)
{
    const tl_field_parts *o = &w->parts;
    const tl_field_lanes *p = &w->lanes;
    const tl_vec3 n = lane_vector(p->n, l);
    pair *of = w->of[l];
    of->by_force += p->h[l] * o->d[l];
    of->by_swept += p->h[l] * o->area[l];
    if (of->faces->powers) {
        of->by_power[0] += p->h[l] * o->dd[l];
        of->by_power[1] += p->h[l] * o->cube[l];
    }
    const uint32_t face[] = {w->face[l], w->with[l]};
    for (int of_b = 0; of_b < 2; of_b++) {
        double out = of_b ? -1 : 1; /* n points into the cell of A */
        if (of->apex[of_b].known) {
            tl_apex_add_side(&of->apex[of_b], of->faces, face[of_b], n, out * o->d[l]);
            continue;
        }
        double slope = out * tl_v3_dot(n, tl_field_normal(of->faces, face[of_b]));
        of->sums->energy += 0.5 * slope * o->dd[l];
        of->sums->volume += slope * o->d[l];
        add_power_sides(w, l, slope);
    }
}

/* A polygon of S. */
static void add_surface(work *w, int l)
{
    const tl_field_parts *o = &w->parts;
    tl_field_sums *sums = w->of[l]->sums;
    add_sides(w, l);
    add_gradient(w, l, 1);
    sums->area = plus(sums->area, 1, o->swept, l);
    sums->pressure += o->d[l];
    sums->pressed = plus(sums->pressed, 1, o->pressed, l);
    sums->extent += o->area[l];
    sums->first = plus(sums->first, 1, o->first, l);
    sums->second += o->second[l];
    sums->stiffness += 2 / fmax(w->lanes.length[l], TL_FIELD_SAME_WAY) * o->area[l];
    if (w->lanes.deepest[l] > sums->deepest) {
        sums->deepest = w->lanes.deepest[l];
        sums->deepest_at = lane_vector(o->deepest_at, l);
    }
}

/* What a polygon on a border adds. B's motion shifts K's border at a seam of A where A is deeper than B, and the other
 * way round. */
static void add_border(work *w, int l)
{
    const tl_field_parts *o = &w->parts;
    const tl_field_faces *f = w->of[l]->faces;
    tl_field_sums *sums = w->of[l]->sums;
    bool face_of_b = w->face[l] >= f->a, border_of_b = w->with[l] >= real_faces(f) + f->border_a;
    uint32_t end = border_of_b ? all_faces(f) : real_faces(f) + f->border_a;
    double out = border_of_b ? -1 : 1;
    if (face_of_b != border_of_b)
        add_gradient(w, l, out);
    if (w->with[l] + (border_of_b ? f->seam_b : f->seam_a) < end)
        return;
    if (f->powers)
        add_power_gradients(w, l, -out);
    sums->through = plus(sums->through, -out, o->force, l);
    sums->through_moment = plus(sums->through_moment, -out, o->moment, l);
}

static void take(work *w, int l)
{
    const tl_field_faces *f = w->of[l]->faces;
    if (w->face[l] < f->a && w->with[l] >= f->a && w->with[l] < real_faces(f)) {
        add_surface(w, l);
        return;
    }
    pair *of = w->of[l];
    tl_apex *own = &of->apex[w->face[l] >= f->a];
    if (own->known) { /* a side of a stray's cell */
        const tl_field_lanes *p = &w->lanes;
        const tl_vec3 n = lane_vector(p->n, l);
        tl_apex_add_side(own, f, w->face[l], n, w->parts.d[l]);
        tl_apex_add_side(own, f, w->with[l], n, -w->parts.d[l]);
        return;
    }
    of->sums->volume += w->lanes.length[l] * w->parts.d[l];
    of->sums->energy += 0.5 * w->lanes.length[l] * w->parts.dd[l];
    add_power_sides(w, l, w->lanes.length[l]);
    if (w->with[l] >= real_faces(f))
        add_border(w, l);
}

/* ---------------------------------------------------------------- polygons --------------- */

/* Puts a plane into a row, in the lanes from `lane` on. */
TL_INLINE void fill(tl_field_plane *restrict row, int lane, const double n[3], double c, double face)
{
#pragma omp simd
    for (int l = 0; l < (int)LANES; l++) {
        bool mine = l >= lane;
        row->n[0][l] = mine ? n[0] : row->n[0][l];
        row->n[1][l] = mine ? n[1] : row->n[1][l];
        row->n[2][l] = mine ? n[2] : row->n[2][l];
        row->c[l] = mine ? c : row->c[l];
        row->face[l] = mine ? face : row->face[l];
    }
}

/* Puts the first `count` of some planes into the lanes from `lane` on. */
TL_VECTORIZED static void lay_rows(tl_field_rows *r, int lane, const tl_field_faces *f, const list *from,
                                   uint32_t count)
{
    const double none[3] = {0};
    uint32_t most = count > r->most ? count : r->most;
    for (uint32_t k = 0; k < most; k++) {
        if (k >= r->most)
            fill(&r->row[k], 0, none, TL_FIELD_FAR, 0);
        uint32_t i = k < count ? from->number[k] : 0;
        const double n[3] = {f->n[0][i], f->n[1][i], f->n[2][i]};
        if (k < count)
            fill(&r->row[k], lane, n, f->c[i], i < real_faces(f));
        else
            fill(&r->row[k], lane, none, TL_FIELD_FAR, 0);
    }
    r->most = most;
}

/* How many planes bound a polygon of a pair: all but its own. */
static uint32_t bounds(const work *w, const pair *of)
{
    return of->planes.count - (w->bound.flat ? 1 : 2);
}

/* The planes that bound a polygon in whose own two are the i-th and j-th of its pair. The last of all come in their
 * place. */
static void list_bounds(const work *w, const pair *of, uint32_t i, uint32_t j, uint16_t in_place[2])
{
    const uint32_t own[] = {i, j}, count = bounds(w, of);
    uint32_t last = count;
    for (int k = 0; k < (i == j ? 1 : 2); k++) {
        if (own[k] >= count)
            continue;
        while (last == i || last == j)
            last++;
        in_place[k] = of->number[last++];
    }
}

/* Takes a polygon's own planes out of its lane. */
static void take_out(work *w, int lane, const pair *of, uint32_t i, uint32_t j)
{
    const tl_field_faces *f = of->faces;
    const uint32_t own[] = {i, j}, count = bounds(w, of);
    uint16_t in_place[2];
    list_bounds(w, of, i, j, in_place);
    for (int k = 0; k < (i == j ? 1 : 2); k++) {
        if (own[k] >= count)
            continue;
        tl_field_plane *row = &w->bound.planes.row[own[k]];
        uint32_t plane = in_place[k];
        for (int axis = 0; axis < 3; axis++)
            row->n[axis][lane] = f->n[axis][plane];
        row->c[lane] = f->c[plane];
        row->face[lane] = plane < real_faces(f);
    }
}

/* Notes the polygon in a lane for a mesh. */
static void draw(work *w, int lane)
{
    const size_t lines = w->bound.lines;
    const pair *of = w->of[lane];
    const uint32_t count = bounds(w, of), i = w->i[lane], j = w->j[lane];
    const uint16_t own[] = {(uint16_t)w->face[lane], (uint16_t)w->with[lane]};
    uint16_t bound[TL_FIELD_KNOWN], in_place[2];
    for (uint32_t k = 0; k < count; k++)
        bound[k] = of->number[k];
    list_bounds(w, of, i, j, in_place);
    if (i < count)
        bound[i] = in_place[0];
    if (j < count)
        bound[j] = in_place[1];
    draw_polygon(of->draft, own, bound, w->bound.line, count + 1 < lines ? count + 1 : lines, (unsigned)lane);
}

/* Integrates the polygons in the lanes. */
static void integrate_batch(work *w)
{
    tl_field_lanes *p = &w->lanes;
    if (!w->filled)
        return;
    for (int lane = w->filled; lane < (int)LANES; lane++)
        p->share[lane] = 0; /* what is left there is of earlier ones */
    tl_field_integrate_lanes(p, &w->bound, &w->parts);
    for (int lane = 0; lane < w->filled; lane++) {
        pair *of = w->of[lane];
        of->beyond = of->beyond || w->bound.beyond >> lane & 1;
        if (!(p->area[lane] > 0))
            continue;
        if (w->bound.flat)
            of->found |= UINT64_C(1) << w->face[lane];
        else
            take(w, lane);
        if (of->draft && !w->bound.flat)
            draw(w, lane);
        of->beyond = of->beyond || p->open[lane] > 0;
    }
    w->filled = 0;
    w->laid = NULL;
    w->bound.planes.most = w->bound.others.most = 0;
}

/* Puts a polygon into the lanes: in a plane, of the depth of the pair's i-th plane, bounded by neither that nor the
 * j-th. */
static void put(work *w, pair *of, tl_vec3 n, double h, uint32_t i, uint32_t j, bool between, double length)
{
    tl_field_lanes *p = &w->lanes;
    int l = w->filled++;
    uint32_t face = of->number[i];
    if (w->laid != of) {
        lay_rows(&w->bound.planes, l, of->faces, &of->planes, bounds(w, of));
        lay_rows(&w->bound.others, l, of->faces, &of->others, of->others.count);
        w->laid = of;
    }
    tl_vec3 m = tl_field_normal(of->faces, face);
    p->n[0][l] = n.x;
    p->n[1][l] = n.y;
    p->n[2][l] = n.z;
    p->h[l] = h;
    p->between[l] = between;
    p->length[l] = length;
    p->face_n[0][l] = m.x;
    p->face_n[1][l] = m.y;
    p->face_n[2][l] = m.z;
    p->face_c[l] = of->faces->c[face];
    p->one_plane[l] = of->one_plane;
    p->share[l] = 1;
    w->of[l] = of;
    w->face[l] = face;
    w->with[l] = of->number[j];
    w->i[l] = i;
    w->j[l] = j;
    take_out(w, l, of, i, j);
    if (w->filled == (int)LANES)
        integrate_batch(w);
}

/* Whether the polygon between the cells of two faces of the block is needed. */
static bool apex_needs(const tl_apex *p, uint32_t face, uint32_t other)
{
    bool needed = !p->known;
    for (uint32_t k = 0; k < p->strays; k++)
        needed = needed || p->stray[k] == face || p->stray[k] == other;
    return needed;
}

/* The surface between the cells of two faces, where both are the nearest. */
static void put_between(work *w, pair *of, uint32_t i, uint32_t j)
{
    const tl_field_faces *f = of->faces;
    uint32_t a = of->number[i], b = of->number[j];
    tl_vec3 m = tl_v3_sub(tl_field_normal(f, a), tl_field_normal(f, b));
    put(w, of, m, f->c[a] - f->c[b], i, j, true, 0);
}

/* The polygons between the cells of the chosen faces, of which all may be known to bound K, and at borders. */
static void put_pair(work *w, pair *of, bool only_bounding)
{
    const tl_field_faces *f = of->faces;
    const uint16_t *number = of->number;
    uint32_t a = 0, real = 0;
    *of->sums = (tl_field_sums){0};
    while (real < of->planes.count && number[real] < real_faces(f))
        a += number[real++] < f->a;
    /* a face that bounds nothing of K may be far from it, and so would the apex be */
    of->apex[0] = of->apex[1] = (tl_apex){.known = false};
    of->by[0] = of->by[1] = (tl_apex_faces){.known = false};
    if (only_bounding) {
        of->by[0] = tl_apex_choose(f, number, a, of->one_plane);
        of->by[1] = tl_apex_choose(f, number + a, real - a, of->one_plane);
        of->apex[0] = tl_apex_find(f, &of->by[0]);
        of->apex[1] = tl_apex_find(f, &of->by[1]);
    }
    of->by_force = of->by_swept = of->by_power[0] = of->by_power[1] = 0;
    for (uint32_t i = 0; i < real; i++)
        for (uint32_t j = i + 1; j < real; j++)
            if ((i < a) != (j < a) || apex_needs(&of->apex[i >= a], number[i], number[j]))
                put_between(w, of, i, j);
    for (uint32_t k = real_faces(f); k < all_faces(f); k++)
        for (uint32_t face = 0; face < real_faces(f); face++) {
            tl_vec3 n = tl_field_normal(f, k);
            put(w, of, n, f->c[k], face, k, false, -tl_v3_dot(n, tl_field_normal(f, face)));
        }
}

static void end_pair(pair *of)
{
    tl_apex_add_shares(of->apex, of->faces, of->by_force, of->by_swept, of->by_power, of->sums);
}

static void integrate(work *w, pair *of, const uint64_t *mask)
{
    choose(of, mask);
    put_pair(w, of, mask);
    integrate_batch(w);
    end_pair(of);
}

/* The faces that bound K: those of which something lies within all others. */
static uint64_t find_bounding(work *w, pair *of)
{
    const tl_field_faces *f = of->faces;
    choose(of, NULL);
    w->bound.flat = true;
    of->found = 0;
    for (uint32_t i = 0; i < real_faces(f); i++)
        put(w, of, tl_field_normal(f, i), f->c[i], i, i, false, 0);
    integrate_batch(w);
    w->bound.flat = false;
    return of->found;
}

/* ---------------------------------------------------------------- pairs ------------------ */

/* Whether somebody keeps what is known of a pair. */
static bool is_kept(const tl_field_faces *f)
{
    return f->mesh && !f->seamed && real_faces(f) <= TL_FIELD_KNOWN;
}

static bool is_known(const tl_field_faces *f)
{
    return is_kept(f) && f->mesh->bounding;
}

/* Begins to note polygons. */
static void begin_draft(pair *of, mesh_draft *draft)
{
    of->draft = of->faces->inner ? draft : NULL;
    draft->full = false;
    draft->polygons = draft->labels = 0;
}

/* A pair of which it is not known which faces bound K, or not any more. */
static void integrate_anew(work *w, pair *of, mesh_draft *draft)
{
    const tl_field_faces *f = of->faces;
    of->draft = NULL;
    if (is_kept(f)) {
        f->mesh->polygons = 0;
        f->mesh->bounding = find_bounding(w, of);
        begin_draft(of, draft);
        integrate(w, of, &f->mesh->bounding);
        if (!of->beyond)
            return;
        f->mesh->bounding = 0; /* K is so thin that a face was lost in roundings */
        of->draft = NULL;
    }
    if (f->mesh && f->seamed && all_faces(f) <= TL_FIELD_KNOWN)
        begin_draft(of, draft);
    integrate(w, of, NULL);
}

/* An empty work for pairs of so many planes. false: out of memory. */
static bool begin_work(work *w, const tl_field_faces *const faces[], uint32_t count, tl_field_scratch *scratch)
{
    uint32_t most = 0, all = 0;
    w->bound.flat = false;
    w->filled = 0;
    w->laid = NULL;
    w->bound.planes.most = w->bound.others.most = 0;
    w->bound.powers = false;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t planes = all_faces(faces[k]);
        w->bound.powers = w->bound.powers || faces[k]->powers;
        most = planes > most ? planes : most;
        all += planes;
    }
    if (!make_room(scratch, most + 1, all))
        return false;
    w->bound.line = scratch->line;
    w->bound.planes.row = scratch->plane;
    w->bound.others.row = scratch->plane + scratch->lines;
    return true;
}

bool tl_field_integrate(const tl_field_faces *const faces[], tl_field_sums *const sums[], uint32_t count,
                        tl_field_scratch *scratch)
{
    pair pairs[TL_FIELD_PAIRS];
    mesh_draft drafts[TL_FIELD_PAIRS];
    work w; /* the lanes are filled before they are read */
    if (!begin_work(&w, faces, count, scratch))
        return false;
    uint32_t all = 0;
    for (uint32_t k = 0; k < count; k++) {
        pairs[k].faces = faces[k];
        pairs[k].sums = sums[k];
        pairs[k].number = scratch->number + all;
        pairs[k].draft = NULL;
        all += all_faces(faces[k]);
        if (!is_known(faces[k]))
            continue;
        begin_draft(&pairs[k], &drafts[k]);
        choose(&pairs[k], &faces[k]->mesh->bounding);
        put_pair(&w, &pairs[k], true);
    }
    integrate_batch(&w);
    for (uint32_t k = 0; k < count; k++) {
        bool known = is_known(faces[k]);
        if (known)
            end_pair(&pairs[k]);
        if (!known || pairs[k].beyond)
            integrate_anew(&w, &pairs[k], &drafts[k]);
        if (pairs[k].draft && !pairs[k].beyond) {
            make_mesh(pairs[k].draft, faces[k], faces[k]->mesh);
            faces[k]->mesh->apex[0] = pairs[k].by[0];
            faces[k]->mesh->apex[1] = pairs[k].by[1];
        }
    }
    return true;
}
