/* joined_faces.c - faces of joined blocks are given in parts that agree, before the blocks are divided into zones.
 *
 * Zones of joined blocks share gridpoints, so both sides of a face between two blocks must have the same triangles.
 * They do where they have the same polygon (zone_faces.c). Blocks of a rock with a tunnel lie on several others by one
 * face. So
 *
 *   - what two faces that lie on each other have in common, a convex polygon, is a part of both;
 *   - what is left of a face is cut along the sides of these parts, outside of them, into convex parts;
 *   - each side of a part gets corners where corners of others lie on it.
 *
 * All corners are numbered by place (zone_places.c), so a corner in the middle of an edge is one for all blocks there.
 * A place nearer to a line than places are to each other lies on it. */
#include "geometry/joined_faces.h"

#include "base/table.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/seam.h"
#include "geometry/zone_places.h"

#include <stdlib.h>
#include <string.h>
#include <talus/vmath.h>

#define NONE UINT32_MAX

/* Tolerance: faces lie flat on each other, and corners are in one place, within this times the size of the body. Joined
 * blocks were cut by one plane, or were placed by coordinates of six digits. */
#define FIT 1e-6
/* Limit: that, as a share of the shortest edge: corners that differ stay apart. */
#define MOST_OF_EDGE 1e-3
/* Tolerance: what faces have in common is nothing below this share of the smaller one. */
#define NOTHING 1e-5

/* A convex polygon: numbers of places, counter-clockwise as seen from outside of the block whose face it is on. */
typedef struct polygon {
    size_t start;
    uint32_t count;
} polygon;

/* What two faces have in common, as the first sees it. */
typedef struct common {
    uint32_t block[2], face[2];
    polygon of;
} common;

/* A part of a face of the block that is being made. */
typedef struct part {
    uint32_t face;
    polygon of;
    bool inside;
} part;

typedef struct splitting {
    const tl_poly *const *blocks;
    const tl_id *id;
    size_t count;
    tl_zone_places places;
    uint32_t *corner; /* numbers of the places of all corners: block b has them from corner_start[b] on */
    size_t *corner_start;
    double shortest;
    uint32_t *index; /* of all polygons */
    size_t index_count, index_room;
    common *common;
    size_t common_count, common_room;
    part *part; /* of one block */
    size_t part_count, part_room;
    polygon *rest, *next; /* of a face: what is not common */
    size_t rest_count, rest_room, next_count, next_room;
    uint32_t *vertex; /* [places] number in the block, or NONE */
    size_t vertex_room;
    tl_error *error;
} splitting;

static tl_vec3 place(const splitting *s, uint32_t number)
{
    return s->places.at[number];
}

static uint32_t corner_of(const splitting *s, polygon of, uint32_t k)
{
    return s->index[of.start + k % of.count];
}

static bool push(splitting *s, polygon *to, uint32_t number)
{
    if (number == NONE || !tl_grow(&s->index, &s->index_room, s->index_count + 1, sizeof *s->index))
        return false;
    if (to->count > 0 && s->index[s->index_count - 1] == number)
        return true;
    s->index[s->index_count++] = number;
    to->count++;
    return true;
}

/* Begins a polygon at the end of the list: it is filled before another one begins. */
static polygon begin(const splitting *s)
{
    return (polygon){s->index_count, 0};
}

static void end(splitting *s, polygon *of)
{
    if (of->count > 1 && s->index[of->start] == s->index[of->start + of->count - 1]) {
        of->count--;
        s->index_count--;
    }
}

/* ---- polygons ---- */

static double area_of(const splitting *s, polygon of, tl_vec3 normal)
{
    double area = 0;
    for (uint32_t k = 1; k + 1 < of.count; k++) {
        const tl_vec3 o = place(s, corner_of(s, of, 0)), a = tl_v3_sub(place(s, corner_of(s, of, k)), o);
        area += 0.5 * tl_v3_dot(normal, tl_v3_cross(a, tl_v3_sub(place(s, corner_of(s, of, k + 1)), o)));
    }
    return area;
}

/* How far a place lies left of the line from place o to q; 0: on it. */
static double left_of(const splitting *s, uint32_t o, uint32_t q, uint32_t of, tl_vec3 normal)
{
    const tl_vec3 along = tl_v3_sub(place(s, q), place(s, o));
    const double far = tl_v3_dot(normal, tl_v3_cross(along, tl_v3_sub(place(s, of), place(s, o)))) / tl_v3_norm(along);
    return fabs(far) <= s->places.near ? 0 : far;
}

/* What of a polygon lies left of a line (`side` 1) or right of it (-1); no corners where there is nothing. */
static bool keep_side(splitting *s, polygon of, uint32_t o, uint32_t q, tl_vec3 normal, int side, polygon *kept)
{
    bool some = false, enough = true;
    *kept = begin(s);
    for (uint32_t k = 0; enough && k < of.count; k++) {
        const uint32_t here = corner_of(s, of, k), after = corner_of(s, of, k + 1);
        const double h = side * left_of(s, o, q, here, normal), a = side * left_of(s, o, q, after, normal);
        some = some || h > 0;
        if (h >= 0)
            enough = push(s, kept, here);
        if (enough && ((h > 0 && a < 0) || (h < 0 && a > 0))) {
            const tl_vec3 x = tl_v3_madd(place(s, here), h / (h - a), tl_v3_sub(place(s, after), place(s, here)));
            enough = push(s, kept, tl_zone_places_put(&s->places, x));
        }
    }
    end(s, kept);
    if (!some || kept->count < 3) {
        s->index_count = kept->start;
        kept->count = 0;
    }
    return enough;
}

/* The face of a block as a polygon, in its order or in the other one. */
static bool face_polygon(splitting *s, uint32_t block, uint32_t face, bool reversed, polygon *of)
{
    const tl_poly *poly = s->blocks[block];
    const uint32_t n = tl_poly_face_size(poly, face);
    bool enough = true;
    *of = begin(s);
    for (uint32_t k = 0; enough && k < n; k++)
        enough =
            push(s, of, s->corner[s->corner_start[block] + poly->loop[poly->start[face] + (reversed ? n - 1 - k : k)]]);
    return enough;
}

/* What a polygon has in common with another one. */
static bool find_common(splitting *s, polygon of, polygon with, tl_vec3 normal, polygon *both)
{
    bool enough = true;
    *both = of;
    for (uint32_t k = 0; enough && k < with.count && both->count > 0; k++)
        enough = keep_side(s, *both, corner_of(s, with, k), corner_of(s, with, k + 1), normal, 1, both);
    return enough;
}

/* ---- what faces have in common ---- */

static tl_status number_corners(splitting *s)
{
    size_t corners = 0;
    s->corner_start = malloc((s->count + 1) * sizeof *s->corner_start);
    for (size_t b = 0; s->corner_start && b < s->count; b++) {
        s->corner_start[b] = corners;
        corners += s->blocks[b]->vertex_count;
    }
    s->corner = malloc((corners + 1) * sizeof *s->corner);
    if (!s->corner_start || !s->corner)
        return tl_fail_memory(s->error);
    for (size_t b = 0; b < s->count; b++)
        for (uint32_t v = 0; v < s->blocks[b]->vertex_count; v++) {
            const uint32_t put = tl_zone_places_put(&s->places, s->blocks[b]->vertex[v]);
            uint32_t *own = s->corner + s->corner_start[b];
            if (put == NONE)
                return tl_fail_memory(s->error);
            own[v] = put;
        }
    return TL_OK;
}

/* Notes what two faces have in common. */
static tl_status add_common(splitting *s, const common *faces)
{
    const tl_poly *a = s->blocks[faces->block[0]], *b = s->blocks[faces->block[1]];
    const uint32_t fa = faces->face[0], fb = faces->face[1];
    const tl_vec3 normal = a->plane[fa].normal;
    polygon of, with, both;
    if (!face_polygon(s, faces->block[0], fa, false, &of) || !face_polygon(s, faces->block[1], fb, true, &with) ||
        !find_common(s, of, with, normal, &both))
        return tl_fail_memory(s->error);
    const double smaller = fmin(tl_poly_face_area(a, fa), tl_poly_face_area(b, fb));
    if (both.count == 0 || area_of(s, both, normal) <= NOTHING * smaller)
        return TL_OK;
    double off = 0;
    for (uint32_t k = 0; k < with.count; k++)
        off = fmax(off, fabs(tl_v3_dot(normal, place(s, corner_of(s, with, k))) - a->plane[fa].offset));
    if (off > s->places.near)
        return tl_fail(
            s->error, TL_E_GEOMETRY,
            "blocks %u and %u were joined with up to %.3g m between their faces: joined blocks get zones only "
            "where faces lie on each other within %.3g m",
            s->id[faces->block[0]], s->id[faces->block[1]], off, s->places.near);
    if (!tl_grow(&s->common, &s->common_room, s->common_count + 1, sizeof *s->common))
        return tl_fail_memory(s->error);
    s->common[s->common_count] = *faces;
    s->common[s->common_count++].of = both;
    return TL_OK;
}

static bool boxes_apart(const tl_bounds *a, const tl_bounds *b, double slack)
{
    return a->min.x > b->max.x + slack || b->min.x > a->max.x + slack || a->min.y > b->max.y + slack ||
           b->min.y > a->max.y + slack || a->min.z > b->max.z + slack || b->min.z > a->max.z + slack;
}

static tl_status compare_blocks(splitting *s, uint32_t a, uint32_t b)
{
    tl_status status = TL_OK;
    for (uint32_t i = 0; i < s->blocks[a]->face_count; i++)
        for (uint32_t k = 0; !status && k < s->blocks[b]->face_count; k++) {
            double uncovered = 0;
            const common faces = {.block = {a, b}, .face = {i, k}};
            if (tl_poly_faces_meet(s->blocks[a], i, s->blocks[b], k, &uncovered))
                status = add_common(s, &faces);
        }
    return status;
}

static tl_status find_all_common(splitting *s)
{
    tl_bounds *box = malloc((s->count + 1) * sizeof *box);
    tl_status status = box ? TL_OK : tl_fail_memory(s->error);
    for (size_t b = 0; !status && b < s->count; b++)
        box[b] = tl_poly_bounds(s->blocks[b]);
    for (uint32_t a = 0; !status && a < s->count; a++)
        for (uint32_t b = a + 1; !status && b < s->count; b++)
            if (!boxes_apart(&box[a], &box[b], 0.01 * fmin(s->blocks[a]->size, s->blocks[b]->size)))
                status = compare_blocks(s, a, b);
    free(box);
    return status;
}

/* ---- parts of one block ---- */

static bool add_part(splitting *s, uint32_t face, polygon of, bool inside)
{
    if (!tl_grow(&s->part, &s->part_room, s->part_count + 1, sizeof *s->part))
        return false;
    s->part[s->part_count++] = (part){face, of, inside};
    return true;
}

static bool add_next(splitting *s, polygon of)
{
    if (!tl_grow(&s->next, &s->next_room, s->next_count + 1, sizeof *s->next))
        return false;
    s->next[s->next_count++] = of;
    return true;
}

/* Takes a common part out of what is left of a face. */
static bool take_out(splitting *s, polygon common_part, tl_vec3 normal)
{
    bool enough = true;
    s->next_count = 0;
    for (size_t r = 0; enough && r < s->rest_count; r++) {
        polygon in = s->rest[r], both, out;
        enough = find_common(s, in, common_part, normal, &both);
        if (enough && both.count == 0) {
            enough = add_next(s, in);
            continue;
        }
        for (uint32_t k = 0; enough && k < common_part.count && in.count > 0; k++) {
            const uint32_t o = corner_of(s, common_part, k), q = corner_of(s, common_part, k + 1);
            enough = keep_side(s, in, o, q, normal, -1, &out) && (out.count == 0 || add_next(s, out)) &&
                     keep_side(s, in, o, q, normal, 1, &in);
        }
    }
    polygon *swap = s->rest;
    const size_t room = s->rest_room;
    s->rest = s->next;
    s->rest_count = s->next_count;
    s->rest_room = s->next_room;
    s->next = swap;
    s->next_room = room;
    return enough;
}

/* Lists the parts of a face: what it has in common with others, and what is left. */
static bool list_face(splitting *s, uint32_t block, uint32_t face)
{
    const tl_poly *poly = s->blocks[block];
    const tl_vec3 normal = poly->plane[face].normal;
    const size_t first = s->part_count;
    polygon whole;
    bool enough = face_polygon(s, block, face, false, &whole);
    double left = enough ? area_of(s, whole, normal) : 0;
    const double nothing = NOTHING * left;
    for (size_t c = 0; enough && c < s->common_count; c++) {
        const common *of = &s->common[c];
        const int side = of->block[0] == block && of->face[0] == face ? 0 : 1;
        if (of->block[side] != block || of->face[side] != face)
            continue;
        polygon own = side ? begin(s) : of->of;
        for (uint32_t k = of->of.count; enough && side && k > 0; k--)
            enough = push(s, &own, corner_of(s, of->of, k - 1));
        left -= enough ? area_of(s, own, normal) : 0;
        enough = enough && add_part(s, face, own, true);
    }
    if (left <= nothing)
        return enough;
    enough = enough && tl_grow(&s->rest, &s->rest_room, 1, sizeof *s->rest);
    if (enough)
        s->rest[0] = whole;
    s->rest_count = 1;
    for (size_t p = first, inner = s->part_count; enough && p < inner; p++)
        enough = take_out(s, s->part[p].of, normal);
    for (size_t r = 0; enough && r < s->rest_count; r++)
        enough = add_part(s, face, s->rest[r], false);
    return enough;
}

/* ---- corners on the sides of parts ---- */

typedef struct on_side {
    double share; /* of the side */
    uint32_t place;
} on_side;

static int compare_shares(const void *x, const void *y)
{
    const double a = ((const on_side *)x)->share, b = ((const on_side *)y)->share;
    return (a > b) - (a < b);
}

/* Puts the places that lie on the side from o to q behind o. `near`: those near the block. */
static bool push_side(splitting *s, polygon *to, uint32_t o, uint32_t q, const uint32_t *near, size_t count,
                      on_side *list)
{
    const tl_vec3 from = place(s, o), along = tl_v3_sub(place(s, q), from);
    const double length2 = tl_v3_norm2(along), most2 = s->places.near * s->places.near;
    size_t found = 0;
    for (size_t k = 0; k < count; k++) {
        const tl_vec3 arm = tl_v3_sub(place(s, near[k]), from);
        const double share = tl_v3_dot(arm, along) / length2;
        if (near[k] != o && near[k] != q && share > 0 && share < 1 &&
            tl_v3_norm2(tl_v3_madd(arm, -share, along)) <= most2)
            list[found++] = (on_side){share, near[k]};
    }
    if (found > 0)
        qsort(list, found, sizeof *list, compare_shares);
    bool enough = push(s, to, o);
    for (size_t k = 0; enough && k < found; k++)
        enough = push(s, to, list[k].place);
    return enough;
}

/* Gives the sides of all parts of a block the corners that lie on them. */
static bool add_corners(splitting *s, uint32_t block)
{
    const tl_bounds box = tl_poly_bounds(s->blocks[block]);
    const double slack = s->places.near;
    uint32_t *near = malloc((s->places.count + 1) * sizeof *near);
    on_side *list = malloc((s->places.count + 1) * sizeof *list);
    size_t count = 0;
    for (uint32_t k = 0; near && k < s->places.count; k++) {
        const tl_bounds one = {place(s, k), place(s, k)};
        if (!boxes_apart(&one, &box, slack))
            near[count++] = k;
    }
    bool enough = near && list;
    for (size_t p = 0; enough && p < s->part_count; p++) {
        const polygon of = s->part[p].of;
        polygon made = begin(s);
        for (uint32_t k = 0; enough && k < of.count; k++)
            enough = push_side(s, &made, corner_of(s, of, k), corner_of(s, of, k + 1), near, count, list);
        s->part[p].of = made;
    }
    free(near);
    free(list);
    return enough;
}

/* ---- blocks of parts ---- */

/* Numbers the vertices of a block: its corners first. */
static bool number_vertices(splitting *s, uint32_t block, tl_joined_block *to, uint32_t *count)
{
    const uint32_t corners = s->blocks[block]->vertex_count;
    if (!tl_grow(&s->vertex, &s->vertex_room, s->places.count, sizeof *s->vertex))
        return false;
    memset(s->vertex, 0xff, s->places.count * sizeof *s->vertex);
    *count = 0;
    for (uint32_t v = 0; v < corners; v++)
        s->vertex[s->corner[s->corner_start[block] + v]] = (*count)++;
    for (size_t p = 0; p < s->part_count; p++)
        for (uint32_t k = 0; k < s->part[p].of.count; k++) {
            uint32_t *number = &s->vertex[corner_of(s, s->part[p].of, k)];
            if (*number == NONE)
                *number = (*count)++;
        }
    to->place = malloc((*count + 1) * sizeof *to->place);
    for (uint32_t k = 0; to->place && k < s->places.count; k++)
        if (s->vertex[k] != NONE)
            to->place[s->vertex[k]] = k;
    return to->place != NULL;
}

/* What a polyhedron is made of. */
typedef struct lists {
    tl_vec3 *vertex;
    tl_plane *plane;
    uint32_t *start;
    uint16_t *loop;
} lists;

static bool make_lists(lists *l, uint32_t vertices, size_t faces, size_t corners)
{
    *l = (lists){.vertex = malloc((vertices + 1) * sizeof *l->vertex),
                 .plane = malloc((faces + 1) * sizeof *l->plane),
                 .start = malloc((faces + 2) * sizeof *l->start),
                 .loop = malloc((corners + 1) * sizeof *l->loop)};
    return l->vertex && l->plane && l->start && l->loop;
}

/* Makes the polyhedron of a block's parts. */
static tl_status make_block(splitting *s, uint32_t block, tl_joined_block *to)
{
    uint32_t vertices = 0, at = 0;
    size_t corners = 0;
    lists l = {0};
    for (size_t p = 0; p < s->part_count; p++)
        corners += s->part[p].of.count;
    to->face_of = malloc((s->part_count + 1) * sizeof *to->face_of);
    to->inside = malloc(s->part_count + 1);
    if (!to->face_of || !to->inside || !number_vertices(s, block, to, &vertices))
        return tl_fail_memory(s->error);
    if (vertices > TL_POLY_MAX_VERTICES || s->part_count > TL_POLY_MAX_FACES)
        return tl_fail(s->error, TL_E_GEOMETRY,
                       "block %u has %u corners and %zu parts of faces with those that it is "
                       "joined to: at most %d and %d",
                       s->id[block], vertices, s->part_count, TL_POLY_MAX_VERTICES, TL_POLY_MAX_FACES);
    if (!make_lists(&l, vertices, s->part_count, corners)) {
        free(l.vertex), free(l.plane), free(l.start), free(l.loop);
        return tl_fail_memory(s->error);
    }
    for (uint32_t v = 0; v < vertices; v++)
        l.vertex[v] = place(s, to->place[v]);
    for (size_t p = 0; p < s->part_count; p++) {
        const part *of = &s->part[p];
        l.start[p] = at;
        l.plane[p] = s->blocks[block]->plane[of->face];
        to->face_of[p] = of->face;
        to->inside[p] = of->inside;
        for (uint32_t k = 0; k < of->of.count; k++)
            l.loop[at++] = (uint16_t)s->vertex[corner_of(s, of->of, k)];
    }
    l.start[s->part_count] = at;
    tl_error why = {0}; /* of counts that do not fit */
    const tl_status status =
        tl_poly_make(l.vertex, vertices, l.plane, NULL, l.start, l.loop, s->part_count, &to->poly, &why);
    free(l.vertex), free(l.plane), free(l.start), free(l.loop);
    to->how = (tl_zone_parts){s->blocks[block]->vertex_count, to->face_of, s->shortest};
    if (status == TL_E_GEOMETRY)
        return tl_fail(
            s->error, TL_E_GEOMETRY,
            "the faces of block %u do not fit those of the blocks that it is joined to within %.3g m: give its "
            "corners more digits, or cut it off by planes",
            s->id[block], s->places.near);
    return status == TL_OK ? TL_OK : tl_fail_memory(s->error);
}

/* ---- all ---- */

/* Lists the parts of all faces of a block. */
static tl_status list_block(splitting *s, uint32_t block)
{
    s->part_count = 0;
    bool enough = true;
    for (uint32_t f = 0; enough && f < s->blocks[block]->face_count; f++)
        enough = list_face(s, block, f);
    return enough ? TL_OK : tl_fail_memory(s->error);
}

static double edge_length(const tl_poly *poly, uint32_t edge)
{
    return tl_v3_norm(tl_v3_sub(poly->vertex[poly->edge[edge].a], poly->vertex[poly->edge[edge].b]));
}

/* The shortest edge of all blocks. */
static double shortest_edge(const tl_joined_faces *splits)
{
    double shortest = INFINITY;
    for (size_t b = 0; b < splits->count; b++) {
        const tl_poly *poly = splits->block[b].poly;
        for (uint32_t e = 0; e < poly->edge_count; e++)
            shortest =
                fmin(shortest, tl_v3_norm(tl_v3_sub(poly->vertex[poly->edge[e].a], poly->vertex[poly->edge[e].b])));
    }
    return shortest;
}

static tl_status make_all(splitting *s, const tl_vec3 *more, size_t more_count, tl_joined_faces *splits)
{
    tl_status status = number_corners(s);
    if (status == TL_OK)
        status = find_all_common(s);
    /* what is left of faces is cut at new places, which others must know before any gets its corners */
    for (uint32_t b = 0; status == TL_OK && b < s->count; b++)
        status = list_block(s, b);
    for (size_t k = 0; status == TL_OK && k < more_count; k++)
        if (tl_zone_places_put(&s->places, more[k]) == NONE)
            status = tl_fail_memory(s->error);
    for (uint32_t b = 0; status == TL_OK && b < s->count; b++) {
        const size_t indices = s->index_count;
        status = list_block(s, b);
        if (status == TL_OK && !add_corners(s, b))
            status = tl_fail_memory(s->error);
        if (status == TL_OK)
            status = make_block(s, b, &splits->block[b]);
        s->index_count = indices;
    }
    splits->place_count = s->places.count;
    if (status == TL_OK)
        for (size_t b = 0; b < s->count; b++)
            splits->block[b].how.shortest = shortest_edge(splits);
    return status;
}

/* How near places are that are one. */
static double nearness(const tl_poly *const *blocks, size_t count)
{
    tl_bounds all = tl_poly_bounds(blocks[0]);
    double shortest = INFINITY;
    for (size_t b = 0; b < count; b++) {
        const tl_bounds own = tl_poly_bounds(blocks[b]);
        all.min = tl_v3_min(all.min, own.min);
        all.max = tl_v3_max(all.max, own.max);
        for (uint32_t e = 0; e < blocks[b]->edge_count; e++)
            shortest = fmin(shortest, edge_length(blocks[b], e));
    }
    return fmin(FIT * tl_v3_norm(tl_v3_sub(all.max, all.min)), MOST_OF_EDGE * shortest);
}

tl_status tl_joined_faces_make(const tl_poly *const *blocks, const tl_id *id, size_t count, const tl_vec3 *more,
                               size_t more_count, tl_joined_faces *splits, tl_error *error)
{
    splitting s = {.blocks = blocks, .id = id, .count = count, .error = error};
    *splits = (tl_joined_faces){.block = calloc(count + 1, sizeof *splits->block), .count = count};
    if (!splits->block)
        return tl_fail_memory(error);
    s.places.near = nearness(blocks, count);
    const tl_status status = make_all(&s, more, more_count, splits);
    tl_zone_places_free(&s.places);
    free(s.corner);
    free(s.corner_start);
    free(s.index);
    free(s.common);
    free(s.part);
    free(s.rest);
    free(s.next);
    free(s.vertex);
    return status;
}

void tl_joined_faces_free(tl_joined_faces *splits)
{
    for (size_t b = 0; splits->block && b < splits->count; b++) {
        tl_joined_block *block = &splits->block[b];
        tl_poly_free(block->poly);
        free(block->place);
        free(block->inside);
        free(block->face_of);
    }
    free(splits->block);
    *splits = (tl_joined_faces){0};
}
