/* tunnel.c - generator "tunnel": straight lines connect the corners of two end polygons; blocks in the way
 * of the prism between them are cut along its surface. A profile that follows a path makes such a prism for each leg
 * of the path (path.c). The legs are carved one after the other, each from what the legs before have left. What meets
 * a leg is cut by the planes of its ends first, so the sides of two legs never cut the same rock. Where the path turns
 * and climbs at once, these sides lie at small angles to each other and would leave chips.
 *
 * A block whose inside meets the prism is cut by the planes of the sides, in the order of face1's edges. Then it is cut
 * by the planes of the ends. Each cut splits the part outside off. The cuts are no joints: parts of one block outside
 * stay joined where they share a cut face. What is inside leaves the body of its block, gets the group, and can be
 * excavated. A section that is not convex is divided into convex parts, which are carved one after the other; parts of
 * one body inside stay joined too (Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125, section on
 * model generation).
 *
 * A polygon is divided by clipping ears (triangles of three corners in a row that hold no other corner;
 * G. H. Meisters, Am. Math. Monthly 82 (1975) 648-651) and joining what stays convex (S. Hertel and
 * K. Mehlhorn, Lect. Notes Comput. Sci. 158 (1983) 207-218): at most four times the least number of
 * parts. Work grows with the cube of the number of corners.
 *
 * Limits: faces and sides must be plane, and the planes of the ends must not meet within the tunnel. */
#include "path.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <talus/kit.h>
#include <talus/version.h>
#include <talus/vmath.h>

/* The polygon of one end in its own plane. */
typedef struct outline {
    tl_flat *at; /* [count], counter-clockwise as seen against the normal */
    size_t count;
    tl_vec3 normal; /* of unit length */
    tl_vec3 middle; /* mean of the corners */
    double area;
    double spread; /* of the largest triangle of the middle and two corners */
    double bend;   /* largest distance of a corner from the plane */
} outline;

/* Convex parts that make up a polygon: part p has the corners corner[start[p]] .. corner[start[p + 1]]. */
typedef struct division {
    size_t *corner, *start;
    size_t parts;
} division;

typedef struct params {
    tl_points face1, face2;
    tl_points profile, path;
    const char *group;
} params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_POINTS, params, face1, "m", "corners of one end, in order around it", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_POINTS, params, face2, "m",
             "corners of the other end, in the order of those of face1 they are connected with",
             .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_POINTS, params, profile, "m",
             "instead of faces, with path: corners of the section in order, {to the right of the way, up}, from the "
             "path",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_FLAT),
    TL_PARAM(TL_PARAM_POINTS, params, path, "m",
             "points that straight legs connect; closed where the last is the first", .flags = TL_PARAM_OPTIONAL),
    TL_PARAM(TL_PARAM_STRING, params, group, "", "group of what lies inside", .def_text = "tunnel"),
};

/* ---------------------------------------------------------------- section ---------------- */

/* Lays corners into the plane that fits them; false without memory. Corners on one line have the spread 0 and no
 * normal. Free `at`. */
static bool outline_make(const tl_vec3 *corners, size_t count, outline *made)
{
    *made = (outline){.at = malloc((count + 1) * sizeof *made->at), .count = count};
    if (!made->at)
        return false;
    for (size_t i = 0; i < count; i++)
        made->middle = tl_v3_add(made->middle, tl_v3_sub(corners[i], corners[0]));
    made->middle = tl_v3_madd(corners[0], 1.0 / (double)count, made->middle);
    tl_vec3 sum = {0, 0, 0}, widest = {0, 0, 0}; /* twice an area, along its normal */
    for (size_t i = 0; i < count; i++) {
        tl_vec3 d = tl_v3_sub(corners[i], made->middle);
        sum = tl_v3_add(sum, tl_v3_cross(d, tl_v3_sub(corners[(i + 1) % count], made->middle)));
        for (size_t j = i + 1; j < count; j++) {
            tl_vec3 wide = tl_v3_cross(d, tl_v3_sub(corners[j], made->middle));
            widest = tl_v3_norm2(wide) > tl_v3_norm2(widest) ? wide : widest;
        }
    }
    made->area = 0.5 * tl_v3_norm(sum);
    made->spread = 0.5 * tl_v3_norm(widest);
    if (!(made->spread > 0))
        return true;
    /* areas of a polygon that crosses itself may cancel; it still has a plane */
    made->normal = tl_v3_unit(made->area > TUNNEL_FIT * made->spread ? sum : widest);
    tl_vec3 t1 = tl_v3_perpendicular(made->normal), t2 = tl_v3_cross(made->normal, t1);
    for (size_t i = 0; i < count; i++) {
        tl_vec3 d = tl_v3_sub(corners[i], made->middle);
        made->at[i] = (tl_flat){tl_v3_dot(d, t1), tl_v3_dot(d, t2)};
        made->bend = fmax(made->bend, fabs(tl_v3_dot(d, made->normal)));
    }
    return true;
}

static bool is_convex(const tl_flat *at, const size_t *corner, size_t count, double near)
{
    for (size_t i = 0; i < count; i++)
        if (tl_flat_height(at[corner[i]], at[corner[(i + 1) % count]], at[corner[(i + 2) % count]]) < -near)
            return false;
    return true;
}

/* A convex part while parts are being joined. */
typedef struct piece {
    size_t *corner;
    size_t count;
} piece;

/* Joins b to a over an edge they share when the whole is convex; a has room for both. */
static bool join_pieces(const tl_flat *at, piece *a, piece *b, size_t *scratch, double near)
{
    for (size_t i = 0; i < a->count; i++)
        for (size_t j = 0; j < b->count; j++) {
            size_t from = a->corner[i], to = a->corner[(i + 1) % a->count];
            if (b->corner[j] != to || b->corner[(j + 1) % b->count] != from)
                continue;
            size_t count = 0;
            for (size_t k = 0; k < a->count; k++) /* from `to` all the way round to `from` */
                scratch[count++] = a->corner[(i + 1 + k) % a->count];
            for (size_t k = 2; k < b->count; k++) /* those of b between `from` and `to` */
                scratch[count++] = b->corner[(j + k) % b->count];
            if (!is_convex(at, scratch, count, near))
                return false;
            memcpy(a->corner, scratch, count * sizeof *scratch);
            a->count = count;
            b->count = 0;
            return true;
        }
    return false;
}

/* Fills triangles[] with corners in threes; returns their number. `rest` is used up. */
static size_t clip_ears(const outline *section, double near, size_t *rest, piece *triangles)
{
    size_t count = section->count, made = 0;
    while (count >= 3) {
        double height;
        size_t k = tl_polygon_ear(section->at, rest, count, near, &height);
        if (height > near) { /* a corner on a straight line leaves without a triangle */
            piece *t = &triangles[made++];
            t->corner[0] = rest[(k + count - 1) % count];
            t->corner[1] = rest[k];
            t->corner[2] = rest[(k + 1) % count];
            t->count = 3;
        }
        count--;
        for (; k < count; k++)
            rest[k] = rest[k + 1];
    }
    return made;
}

static void join_all(const outline *section, double near, piece *pieces, size_t count, size_t *scratch)
{
    bool joined = true;
    while (joined) {
        joined = false;
        for (size_t i = 0; i < count; i++)
            for (size_t j = i + 1; j < count; j++)
                if (pieces[i].count && pieces[j].count &&
                    join_pieces(section->at, &pieces[i], &pieces[j], scratch, near))
                    joined = true;
    }
}

/* Lists the pieces, each from its lowest corner on. */
static void list_parts(const piece *pieces, size_t count, division *parts)
{
    size_t at = 0;
    for (size_t i = 0; i < count; i++) {
        const piece *p = &pieces[i];
        if (p->count == 0)
            continue;
        size_t lowest = 0;
        for (size_t k = 1; k < p->count; k++)
            lowest = p->corner[k] < p->corner[lowest] ? k : lowest;
        parts->start[parts->parts++] = at;
        for (size_t k = 0; k < p->count; k++)
            parts->corner[at++] = p->corner[(lowest + k) % p->count];
    }
    parts->start[parts->parts] = at;
}

/* Divides a polygon that does not cross itself into convex parts; a convex one is left whole with its corners in order.
 * False without memory. Free `corner` and `start`. */
static bool outline_divide(const outline *section, double near, division *parts)
{
    size_t n = section->count;
    *parts =
        (division){.corner = malloc(3 * n * sizeof *parts->corner), .start = malloc((n + 1) * sizeof *parts->start)};
    size_t *rest = calloc(2 * n, sizeof *rest), *store = malloc(n * n * sizeof *store);
    piece *pieces = calloc(n, sizeof *pieces);
    bool enough = parts->corner && parts->start && rest && store && pieces;
    if (enough) {
        for (size_t i = 0; i < n; i++) {
            rest[i] = i;
            pieces[i] = (piece){store + i * n, 0};
        }
        if (is_convex(section->at, rest, n, near)) {
            memcpy(pieces[0].corner, rest, n * sizeof *rest);
            pieces[0].count = n;
            list_parts(pieces, 1, parts);
        } else {
            size_t count = clip_ears(section, near, rest, pieces);
            join_all(section, near, pieces, count, rest + n);
            list_parts(pieces, count, parts);
        }
    }
    free(rest);
    free(store);
    free(pieces);
    return enough;
}

/* ---------------------------------------------------------------- prism ------------------ */

/* The prism: for each convex part of the section the half spaces that hold it. */
typedef struct prism {
    tl_points face1, face2;
    double near;
    outline ends[2];
    division parts;
    tl_half_space *spaces; /* those of part p from space[p] on */
    size_t *space;         /* [parts + 1] */
} prism;

static void free_prism(prism *p)
{
    free(p->ends[0].at);
    free(p->ends[1].at);
    free(p->parts.corner);
    free(p->parts.start);
    free(p->spaces);
    free(p->space);
}

static tl_status fail_memory(const tl_host *host)
{
    return host->fail(host, TL_E_MEMORY, "out of memory");
}

/* ---------------------------------------------------------------- checks ----------------- */

/* Diagonal of the bounds of both ends. */
static double size_of(const prism *p)
{
    tl_vec3 min = p->face1.at[0], max = min;
    for (size_t i = 0; i < p->face1.count; i++) {
        min = tl_v3_min(min, tl_v3_min(p->face1.at[i], p->face2.at[i]));
        max = tl_v3_max(max, tl_v3_max(p->face1.at[i], p->face2.at[i]));
    }
    return tl_v3_norm(tl_v3_sub(max, min));
}

static tl_status check_face(const tl_host *host, const tl_points *face, const char *name, double near, outline *made)
{
    for (size_t i = 0; i < face->count; i++)
        for (size_t j = i + 1; j < face->count; j++)
            if (tl_v3_norm(tl_v3_sub(face->at[i], face->at[j])) < near)
                return host->fail(host, TL_E_GEOMETRY, "%s has the same place {%g, %g, %g} as corners %zu and %zu",
                                  name, face->at[i].x, face->at[i].y, face->at[i].z, i + 1, j + 1);
    if (!outline_make(face->at, face->count, made))
        return fail_memory(host);
    size_t one, other, n = face->count;
    double longest = 0;
    for (size_t i = 0; i < n; i++)
        longest = fmax(longest, tl_v3_norm(tl_v3_sub(face->at[i], made->middle)));
    bool is_line = made->spread <= near * longest;
    if (!is_line && made->bend > near)
        return host->fail(host, TL_E_GEOMETRY,
                          "%s is warped: a corner lies %g m off the plane that fits it, more than "
                          "%g m; give corners in one plane",
                          name, made->bend, near);
    if (!is_line && tl_polygon_crosses(made->at, n, near, &one, &other))
        return host->fail(host, TL_E_GEOMETRY,
                          "%s crosses or touches itself: its edge from corner %zu to %zu meets that "
                          "from corner %zu to %zu",
                          name, one + 1, (one + 1) % n + 1, other + 1, (other + 1) % n + 1);
    if (is_line || made->area <= near * longest)
        return host->fail(host, TL_E_GEOMETRY, "%s has no area: %g m2", name, made->area);
    return TL_OK;
}

/* The plane of the side between corners i and j of both ends. */
static tl_status side_plane(const tl_host *host, const prism *p, size_t i, size_t j, tl_half_space *side)
{
    const tl_vec3 *a = p->face1.at, *b = p->face2.at;
    tl_vec3 across = tl_v3_cross(tl_v3_sub(b[j], a[i]), tl_v3_sub(b[i], a[j]));
    if (!(tl_v3_norm(across) > p->near * p->near))
        return host->fail(host, TL_E_GEOMETRY, "the side between corners %zu and %zu has no area or crosses itself",
                          i + 1, j + 1);
    side->normal = tl_v3_unit(across);
    side->point =
        tl_v3_scale(0.25, tl_v3_add(tl_v3_sub(a[j], a[i]), tl_v3_add(tl_v3_sub(b[i], a[i]), tl_v3_sub(b[j], a[i]))));
    side->point = tl_v3_add(a[i], side->point);
    double warp = fabs(tl_v3_dot(side->normal, tl_v3_sub(a[i], side->point)));
    warp = fmax(warp, fabs(tl_v3_dot(side->normal, tl_v3_sub(a[j], side->point))));
    if (warp > p->near)
        return host->fail(host, TL_E_GEOMETRY,
                          "the side between corners %zu and %zu is warped by %g m, more than %g m: the corners of "
                          "face2 must be in the order of those of face1, and the sides plane%s",
                          i + 1, j + 1, warp, p->near,
                          p->parts.parts > 1 ? ", those between its convex parts too" : "");
    return TL_OK;
}

/* How far a corner of a part sticks out of a half space (positive), at most; and the least. */
static void reach(const prism *p, size_t part, const tl_half_space *space, double *least, double *most)
{
    *least = INFINITY;
    *most = -INFINITY;
    const tl_points *faces[2] = {&p->face1, &p->face2};
    for (size_t k = p->parts.start[part]; k < p->parts.start[part + 1]; k++)
        for (int f = 0; f < 2; f++) {
            tl_vec3 d = tl_v3_sub(faces[f]->at[p->parts.corner[k]], space->point);
            double out = tl_v3_dot(space->normal, d);
            *least = fmin(*least, out);
            *most = fmax(*most, out);
        }
}

/* Turns a half space so that the part lies in it; false when it lies on both sides. */
static bool face_outward(const prism *p, size_t part, tl_half_space *space)
{
    double least, most;
    reach(p, part, space, &least, &most);
    if (most > -least) {
        space->normal = tl_v3_neg(space->normal);
        reach(p, part, space, &least, &most);
    }
    return most <= 2 * p->near && least < -2 * p->near;
}

/* The half spaces of one part: its sides in order, then the two ends. */
static tl_status bound_part(const tl_host *host, prism *p, size_t part)
{
    size_t from = p->parts.start[part], n = p->parts.start[part + 1] - from;
    tl_half_space *spaces = p->spaces + p->space[part];
    for (size_t k = 0; k < n; k++) {
        size_t i = p->parts.corner[from + k], j = p->parts.corner[from + (k + 1) % n];
        tl_status status = side_plane(host, p, i, j, &spaces[k]);
        if (status != TL_OK)
            return status;
        if (!face_outward(p, part, &spaces[k]))
            return host->fail(host, TL_E_GEOMETRY,
                              "face1 and face2 do not fit: the side between corners %zu and %zu runs through the "
                              "tunnel; give face2 the corners that correspond to those of face1, in their order",
                              i + 1, j + 1);
    }
    for (size_t end = 0; end < 2; end++) {
        spaces[n + end] = (tl_half_space){p->ends[end].normal, p->ends[end].middle};
        if (!face_outward(p, part, &spaces[n + end]))
            return host->fail(host, TL_E_GEOMETRY,
                              "the plane of face%zu runs through the tunnel: the ends must lie "
                              "apart, each on one side of the other",
                              end + 1);
    }
    return TL_OK;
}

/* Checks the ends and divides the section. */
static tl_status lay_prism(const tl_host *host, prism *p)
{
    size_t n = p->face1.count;
    if (n < 3 || p->face2.count < 3)
        return host->fail(host, TL_E_ARGUMENT, "%s has %zu corners; at least 3 are needed", n < 3 ? "face1" : "face2",
                          n < 3 ? n : p->face2.count);
    if (n != p->face2.count)
        return host->fail(host, TL_E_ARGUMENT,
                          "face1 has %zu corners and face2 %zu: lines connect them, so there must be as many", n,
                          p->face2.count);
    p->near = TUNNEL_FIT * size_of(p);
    double farthest = 0;
    for (size_t i = 0; i < n; i++)
        farthest = fmax(farthest, tl_v3_norm(tl_v3_sub(p->face1.at[i], p->face2.at[i])));
    if (farthest <= p->near)
        return host->fail(host, TL_E_GEOMETRY, "face1 and face2 are the same: the tunnel has no length");
    tl_status status = check_face(host, &p->face1, "face1", p->near, &p->ends[0]);
    if (status == TL_OK)
        status = check_face(host, &p->face2, "face2", p->near, &p->ends[1]);
    if (status == TL_OK && !outline_divide(&p->ends[0], p->near, &p->parts))
        status = fail_memory(host);
    return status;
}

/* The half spaces of all parts. */
static tl_status bound_prism(const tl_host *host, prism *p)
{
    size_t sides = p->parts.start[p->parts.parts];
    p->spaces = malloc((sides + 2 * p->parts.parts) * sizeof *p->spaces);
    p->space = malloc((p->parts.parts + 1) * sizeof *p->space);
    if (!p->spaces || !p->space)
        return fail_memory(host);
    for (size_t part = 0; part <= p->parts.parts; part++)
        p->space[part] = p->parts.start[part] + 2 * part;
    tl_status status = TL_OK;
    for (size_t part = 0; part < p->parts.parts && status == TL_OK; part++)
        status = bound_part(host, p, part);
    return status;
}

/* ---------------------------------------------------------------- legs ------------------- */

/* The prisms of the legs in a row: one between two faces. */
typedef struct tunnel {
    tunnel_path path;
    prism *leg; /* [legs] */
    size_t legs;
} tunnel;

static void free_tunnel(tunnel *t)
{
    for (size_t k = 0; k < t->legs; k++)
        free_prism(&t->leg[k]);
    free(t->leg);
    free(t->path.corners);
}

/* Exactly one of the two ways of giving a tunnel. */
static tl_status check_given(const tl_host *host, const params *p)
{
    const bool faces = p->face1.count || p->face2.count;
    const struct {
        const char *name;
        const tl_points *points;
        bool wanted;
    } lists[] = {{"face1", &p->face1, faces},
                 {"face2", &p->face2, faces},
                 {"profile", &p->profile, !faces},
                 {"path", &p->path, !faces}};
    for (size_t i = 0; i < 4; i++)
        if ((lists[i].points->count > 0) != lists[i].wanted)
            return host->fail(host, TL_E_ARGUMENT, "%s is %s: a tunnel has face1 and face2, or profile and path",
                              lists[i].name, lists[i].wanted ? "missing" : "one too many");
    return TL_OK;
}

/* Size of the profile and the longest leg together. */
static double extent_of(const params *p)
{
    tl_vec3 min = p->profile.at[0], max = min;
    double longest = 0;
    for (size_t i = 1; i < p->profile.count; i++) {
        min = tl_v3_min(min, p->profile.at[i]);
        max = tl_v3_max(max, p->profile.at[i]);
    }
    for (size_t k = 1; k < p->path.count; k++)
        longest = fmax(longest, tl_v3_norm(tl_v3_sub(p->path.at[k], p->path.at[k - 1])));
    return tl_v3_norm(tl_v3_sub(max, min)) + longest;
}

static tl_status follow_path(const tl_host *host, const params *p, tunnel_path *made)
{
    if (p->profile.count < 3)
        return host->fail(host, TL_E_ARGUMENT, "profile has %zu corners; at least 3 are needed", p->profile.count);
    if (p->path.count < 2)
        return host->fail(host, TL_E_ARGUMENT, "path has 1 point; at least 2 are needed");
    const double near = TUNNEL_FIT * extent_of(p);
    outline section = {.at = NULL};
    tl_status status = check_face(host, &p->profile, "profile", near, &section);
    free(section.at);
    return status == TL_OK ? tunnel_path_lay(host, &p->profile, &p->path, near, made) : status;
}

/* Gives both sides of a joint the same plane, to the last bit. */
static void share_plane(const outline *from, outline *to)
{
    to->normal = from->normal;
    to->middle = from->middle;
}

static tl_status make_tunnel(const tl_host *host, const params *p, tunnel *t)
{
    tl_status status = check_given(host, p);
    if (status == TL_OK && p->path.count)
        status = follow_path(host, p, &t->path);
    const size_t legs = t->path.corners ? t->path.legs : 1, n = p->profile.count;
    if (status == TL_OK && !(t->leg = calloc(legs, sizeof *t->leg)))
        status = fail_memory(host);
    t->legs = t->leg ? legs : 0;
    for (size_t k = 0; k < t->legs && status == TL_OK; k++) {
        const tl_vec3 *ends = t->path.corners;
        t->leg[k].face1 = ends ? (tl_points){ends + 2 * n * k, n} : p->face1;
        t->leg[k].face2 = ends ? (tl_points){ends + 2 * n * k + n, n} : p->face2;
        status = lay_prism(host, &t->leg[k]);
    }
    for (size_t k = 0; k < t->legs && status == TL_OK; k++) {
        if (k > 0)
            share_plane(&t->leg[k - 1].ends[1], &t->leg[k].ends[0]);
        if (k > 0 && k + 1 == t->legs && t->path.closed)
            share_plane(&t->leg[0].ends[0], &t->leg[k].ends[1]);
        status = bound_prism(host, &t->leg[k]);
    }
    return status;
}

/* ---------------------------------------------------------------- carving ---------------- */

/* A piece inside and the body that its block was of. */
typedef struct inner {
    uint32_t body;
    size_t index;
} inner;

typedef struct carving {
    uint32_t body; /* of the block in hand before the first cut, once `cut` */
    bool cut, ends_first;
    size_t *outer; /* pieces of the block in hand that may meet parts to come */
    size_t outer_count, outer_capacity;
    inner *inside;
    size_t inside_count, inside_capacity;
} carving;

static bool add_outer(carving *c, size_t index)
{
    size_t *outer = tl_grown(c->outer, &c->outer_capacity, c->outer_count + 1, sizeof *outer);
    if (!outer)
        return false;
    c->outer = outer;
    outer[c->outer_count++] = index;
    return true;
}

static bool add_inside(carving *c, uint32_t body, size_t index)
{
    inner *inside = tl_grown(c->inside, &c->inside_capacity, c->inside_count + 1, sizeof *inside);
    if (!inside)
        return false;
    c->inside = inside;
    inside[c->inside_count++] = (inner){body, index};
    return true;
}

/* Splits off what of a piece lies outside a part: beyond its sides and then its ends, or the ends first. */
static tl_status peel(const tl_host *host, const prism *p, size_t part, size_t index, carving *c)
{
    const size_t from = p->space[part], count = p->space[part + 1] - from;
    for (size_t k = 0; k < count; k++) {
        const tl_half_space *space = &p->spaces[from + (c->ends_first ? (k + count - 2) % count : k)];
        size_t above;
        tl_status status = host->cut_block(host, index, space->normal, space->point, &above);
        if (status != TL_OK)
            return status;
        if (above != SIZE_MAX && !add_outer(c, above))
            return fail_memory(host);
    }
    return TL_OK;
}

/* Carves the pieces in hand of a block: those that meet the part are inside as far as they lie in it. */
static tl_status carve_part(const tl_host *host, const prism *p, size_t part, size_t block, carving *c)
{
    size_t pieces = c->outer_count, kept = 0;
    for (size_t i = 0; i < pieces; i++) {
        size_t index = c->outer[i];
        bool meets;
        tl_status status =
            host->meets(host, index, p->spaces + p->space[part], p->space[part + 1] - p->space[part], &meets);
        if (status != TL_OK)
            return status;
        if (!meets) {
            c->outer[kept++] = index;
            continue;
        }
        if (!c->cut) {
            tl_block_info info = {.size = sizeof info};
            host->block_info(host, block, &info);
            c->body = info.body;
            c->cut = true;
        }
        if (!add_inside(c, c->body, index))
            return fail_memory(host);
        status = peel(host, p, part, index, c);
        if (status != TL_OK)
            return status;
    }
    memmove(c->outer + kept, c->outer + pieces, (c->outer_count - pieces) * sizeof *c->outer);
    c->outer_count -= pieces - kept;
    return TL_OK;
}

/* Carves one block and the pieces it falls into. */
static tl_status carve(const tl_host *host, const tunnel *t, size_t block, carving *c)
{
    c->outer_count = 0;
    c->cut = false;
    tl_status status = add_outer(c, block) ? TL_OK : fail_memory(host);
    for (size_t k = 0; k < t->legs; k++)
        for (size_t part = 0; part < t->leg[k].parts.parts && status == TL_OK; part++)
            status = carve_part(host, &t->leg[k], part, block, c);
    return status;
}

static int compare_inner(const void *x, const void *y)
{
    const inner *a = x, *b = y;
    if (a->body != b->body)
        return a->body < b->body ? -1 : 1;
    return (a->index > b->index) - (a->index < b->index);
}

/* Gives what is inside its group, and takes it out of the bodies outside. */
static tl_status set_free(const tl_host *host, const char *group, carving *c)
{
    qsort(c->inside, c->inside_count, sizeof *c->inside, compare_inner);
    for (size_t from = 0, to; from < c->inside_count; from = to) {
        c->outer_count = 0;
        for (to = from; to < c->inside_count && c->inside[to].body == c->inside[from].body; to++) {
            tl_status status = host->set_group(host, c->inside[to].index, group);
            if (status != TL_OK)
                return status;
            if (!add_outer(c, c->inside[to].index))
                return fail_memory(host);
        }
        tl_status status = host->part(host, c->outer, c->outer_count);
        if (status != TL_OK)
            return status;
    }
    return TL_OK;
}

static tl_status generate(const tl_host *host, const void *given)
{
    const params *wanted = given;
    tunnel t = {.leg = NULL};
    carving c = {.outer = NULL};
    tl_status status = make_tunnel(host, wanted, &t);
    c.ends_first = t.legs > 1;
    size_t blocks = host->block_count(host);
    for (size_t i = 0; i < blocks && status == TL_OK; i++) {
        status = carve(host, &t, i, &c);
        if (status == TL_OK)
            status = host->progress(host, (double)(i + 1) / (double)blocks);
    }
    if (status == TL_OK && c.inside_count == 0) {
        tl_vec3 from = t.leg[0].ends[0].middle, to = t.leg[t.legs - 1].ends[1].middle;
        status = host->fail(host, TL_E_GEOMETRY,
                            "the tunnel meets no visible block: it runs from {%g, %g, %g} to {%g, %g, %g}", from.x,
                            from.y, from.z, to.x, to.y, to.z);
    }
    if (status == TL_OK)
        status = set_free(host, wanted->group, &c);
    free_tunnel(&t);
    free(c.outer);
    free(c.inside);
    return status;
}

static const tl_kind kind = TL_GENERATOR_KIND(
    generate, .name = "tunnel", .doc = "Cuts the visible blocks in the way of a tunnel along its surface.",
    TL_KIND_PARAMS(params, param_table));

/* It needs the services for single blocks, which came with minor 1. */
TL_PLUGIN_SINCE(1, kind, .id = "talus.tunnel", .version = TALUS_VERSION, .doc = "Tunnel generator.",
                .licence = "BSD-3-Clause");
