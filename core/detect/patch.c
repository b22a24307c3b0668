/* patch.c - face on face: the contact polygon and its contact points.
 *
 * The two faces are projected along the bisector of their normals into the bisecting plane, where one
 * clips the other (Sutherland and Hodgman 1974). Contact points lie at the polygon's corners, middles
 * of edges and area centroid; with a_i the area of the fan triangle of edge i about the centroid, a
 * corner has the area (a_{i-1} + a_i)/12, a middle a_i/3, the centroid half of all. These weights
 * integrate any linear gap, and its moments, exactly. With points at the corners only, each takes half of
 * its two fan triangles: resultants are right, turning is up to three times too stiff.
 *
 * The gap at a corner opens along the normal of the features that make it: of B's face where a vertex of A
 * stands on it, of A's face where B's vertex does, of both edges where two cross (a point's *lean*);
 * middles and centroid lie between their corners, in this too. With the bisector for all, a force would do
 * work along a smooth tilted face. Areas are those on the faces, not in the bisecting plane, so
 * that the area of a face that lies wholly on another does not change as it tilts.
 *
 * Corners with a turning angle below STRAIGHT are left out. Between STRAIGHT and CORNER the points are
 * a mixture of those with and without the corner, so that a corner that comes or goes while blocks
 * wobble does not change the force. */
#include "detect/detect.h"

#include "base/random.h"

#include <stdlib.h>
#include <string.h>

/* Turning angles, rad, below which a corner is none, and from which it is a full one. */
#define STRAIGHT 1e-4
#define CORNER 2e-3
/* Corners nearer to each other than this times the size are one, and corners nearer to a line that clips lie on
 * it: far below any length that matters, far above rounding. Edges along each other would otherwise cross
 * here and there, and points come and go. */
#define MERGE 1e-7
/* A polygon thinner than this times the size has no area worth a point: faces that only touch along an
 * edge. */
#define THIN 1e-9
/* Longest run of blended corners that is mixed; longer runs belong to round outlines. */
#define BLEND_RUN 3

typedef struct point2 {
    double x, y;
} point2;

typedef struct corner {
    point2 at;
    uint32_t key;  /* of the features that made it */
    uint32_t edge; /* source of the edge that leaves it */
    tl_lean lean;  /* of its gap's normal */
    double height; /* over the line that cuts */
    double share;  /* of the corner in the mixture: 0 .. 1 */
    double fan;    /* area of the fan triangle of the edge that leaves it */
} corner;

/* Room for one clipping. */
struct tl_polygon {
    corner *now, *next;
    point2 *clip;
    size_t room, clip_room;
    double snap2; /* square of the distance up to which a corner lies on a line */
    /* unit, in the patch's plane: across the line where the faces' planes meet, up A's */
    point2 rise;
};

/* Edges of A's face are 0, 1, ..., those of B's face EDGE_B, EDGE_B + 1, ... */
enum { EDGE_B = 1 << 16 };
/* What a point is; with the features that made it, this gives its key. */
enum { POINT_A, POINT_B, POINT_CROSSING, POINT_MIDDLE, POINT_CENTROID };

/* Different features of one contact have different keys: vertices the numbers of A, then those of B ... */
static uint32_t vertex_key(uint32_t kind, uint32_t vertex)
{
    return kind == POINT_A ? vertex : vertex | 1u << 16;
}

/* ... and what two features make a mixture of theirs: a multiplication or two must do, for every point has a
 * key in every step. */
static uint32_t key_of(uint32_t kind, uint32_t one, uint32_t other)
{
    uint64_t x = (kind + UINT64_C(0x9e3779b97f4a7c15) * one) ^ UINT64_C(0xd6e8feb86659fd93) * other;
    return (uint32_t)((x ^ x >> 32) * UINT64_C(0xd6e8feb86659fd93) >> 32);
}

void tl_polygon_free(struct tl_polygon *polygon, tl_patch_points *points)
{
    free(points->p[0]);
    if (!polygon)
        return;
    free(polygon->now);
    free(polygon->next);
    free(polygon->clip);
    free(polygon);
}

static struct tl_polygon *polygon_room(tl_narrow *room, size_t corners, size_t clip)
{
    if (!room->polygon && !(room->polygon = calloc(1, sizeof *room->polygon)))
        return NULL;
    struct tl_polygon *p = room->polygon;
    if (corners > p->room) {
        free(p->now);
        free(p->next);
        p->now = malloc(2 * corners * sizeof *p->now);
        p->next = malloc(2 * corners * sizeof *p->next);
        p->room = p->now && p->next ? 2 * corners : 0;
    }
    if (clip > p->clip_room) {
        free(p->clip);
        p->clip = malloc(2 * clip * sizeof *p->clip);
        p->clip_room = p->clip ? 2 * clip : 0;
    }
    return corners <= p->room && clip <= p->clip_room ? p : NULL;
}

/* The plane of the patch: origin, two directions in it, its normal (A to B). */
typedef struct frame2 {
    tl_vec3 o, t1, t2, n;
} frame2;

static point2 project(const frame2 *f, tl_vec3 x)
{
    tl_vec3 d = tl_v3_sub(x, f->o);
    return (point2){tl_v3_dot(d, f->t1), tl_v3_dot(d, f->t2)};
}

static double cross2(point2 o, point2 a, point2 b)
{
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/* Square of the distance. */
static double distance2(point2 a, point2 b)
{
    double x = a.x - b.x, y = a.y - b.y;
    return x * x + y * y;
}

static point2 from_to(point2 a, point2 b)
{
    return (point2){b.x - a.x, b.y - a.y};
}

/* How the normal of two crossing edges, a of A's face and b of B's, leans. With both measured from the line in
 * which the faces' planes meet, by angles alpha and beta, it is along M - L sin(alpha + beta)/d - M x L 2 sin alpha
 * sin beta/d, with d = sin(beta - alpha); see tl_lean. Bounded, for edges nearly along each other have no normal. */
static tl_lean lean_of(point2 a, point2 b, point2 rise)
{
    double a_along = a.x * rise.y - a.y * rise.x, a_up = a.x * rise.x + a.y * rise.y;
    double b_along = b.x * rise.y - b.y * rise.x, b_up = b.x * rise.x + b.y * rise.y;
    double d = a_along * b_up - a_up * b_along;
    double face = -(a_along * b_up + a_up * b_along), edge = -2 * a_up * b_up;
    double most = fmax(fabs(d), fmax(fabs(face), 0.5 * fabs(edge)));
    d = d < 0 ? -most : most;
    return most > 0 ? (tl_lean){(float)(face / d), (float)(edge / d)} : (tl_lean){0, 0};
}

/* Of a mean of corners. */
static tl_lean between(tl_lean a, tl_lean b)
{
    return (tl_lean){0.5f * (a.face + b.face), 0.5f * (a.edge + b.edge)};
}

/* What the corner is where edges `one` and `other` meet at `cut`. A meeting of two neighbouring edges
 * of B is B's own vertex. */
static corner meet(uint32_t one, uint32_t other, point2 cut, const point2 *clip, uint32_t count)
{
    corner c = {.at = cut, .edge = other, .lean = {1, 0}};
    if (one >= EDGE_B && other >= EDGE_B) {
        uint32_t i = one - EDGE_B, j = other - EDGE_B;
        if ((i + 1) % count == j || (j + 1) % count == i) {
            uint32_t v = (i + 1) % count == j ? j : i;
            c.at = clip[v];
            c.key = vertex_key(POINT_B, v);
            return c;
        }
    }
    c.key = one < other ? key_of(POINT_CROSSING, one, other) : key_of(POINT_CROSSING, other, one);
    return c;
}

/* Keeps what lies left of the line from clip[j] to clip[j + 1]; returns the number of corners. */
static size_t clip_by(struct tl_polygon *p, size_t count, uint32_t j, uint32_t clip_count)
{
    point2 o = p->clip[j], q = p->clip[j + 1 == clip_count ? 0 : j + 1];
    double low = 0, on2 = p->snap2 * distance2(o, q);
    for (size_t i = 0; i < count; i++) {
        double h = cross2(o, q, p->now[i].at);
        p->now[i].height = h * h > on2 ? h : 0;
        low = p->now[i].height < low ? p->now[i].height : low;
    }
    if (low == 0)
        return count; /* all of it: most lines cut nothing */
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        const corner *here = &p->now[i], *after = &p->now[i + 1 == count ? 0 : i + 1];
        double h = here->height, a = after->height;
        if (h >= 0)
            p->next[kept++] = *here;
        if ((h > 0 && a < 0) || (h < 0 && a > 0) || (h == 0 && a < 0)) {
            double t = h / (h - a);
            point2 cut = {here->at.x + t * (after->at.x - here->at.x),
                          here->at.y + t * (after->at.y - here->at.y)};
            corner c = meet(here->edge, EDGE_B + j, cut, p->clip, clip_count);
            if (h == 0) { /* the line passes through the corner: it only changes its edge */
                p->next[kept - 1].edge = EDGE_B + j;
                continue;
            }
            if (here->edge < EDGE_B)
                c.lean = lean_of(from_to(here->at, after->at), from_to(o, q), p->rise);
            c.edge = h > 0 ? EDGE_B + j : here->edge;
            p->next[kept++] = c;
        }
    }
    corner *swap = p->now;
    p->now = p->next;
    p->next = swap;
    return kept;
}

static size_t merge_near(struct tl_polygon *p, size_t count, double near)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || distance2(p->now[i].at, p->now[kept - 1].at) > near * near)
            p->now[kept++] = p->now[i];
        else
            p->now[kept - 1].edge = p->now[i].edge;
    while (kept > 1 && distance2(p->now[kept - 1].at, p->now[0].at) <= near * near)
        kept--;
    return kept;
}

/* Area and area centroid, taken about a corner. */
static double area_of(const corner *c, size_t count, point2 *centroid)
{
    double area = 0, x = 0, y = 0;
    for (size_t i = 1; i + 1 < count; i++) {
        double a = 0.5 * cross2(c[0].at, c[i].at, c[i + 1].at);
        area += a;
        x += a * ((c[i].at.x - c[0].at.x) + (c[i + 1].at.x - c[0].at.x)) / 3;
        y += a * ((c[i].at.y - c[0].at.y) + (c[i + 1].at.y - c[0].at.y)) / 3;
    }
    if (area > 0)
        *centroid = (point2){c[0].at.x + x / area, c[0].at.y + y / area};
    return area;
}

static double smooth(double x)
{
    return x <= 0 ? 0 : x >= 1 ? 1 : x * x * (3 - 2 * x);
}

/* Share of a corner by its turning angle. */
static double corner_share(point2 before, point2 here, point2 after)
{
    double uv = distance2(before, here) * distance2(here, after), s = cross2(before, here, after);
    double ahead =
        (here.x - before.x) * (after.x - here.x) + (here.y - before.y) * (after.y - here.y);
    if (s > 0 &&
        (ahead <= 0 || s * s >= CORNER * CORNER * uv)) /* the sine is less than the angle */
        return 1;
    double turn = asin(fmin(1, fmax(-1, s / sqrt(uv))));
    turn = ahead < 0 ? TL_PI - turn : turn;
    return smooth((turn - STRAIGHT) / (CORNER - STRAIGHT));
}

/* Gives each corner its share by its turning angle and each edge its fan area; drops corners of share
 * 0, whose fan area goes to the edge before. Returns the number of corners, and whether all are full. */
static size_t weigh_corners(corner *c, size_t count, point2 centroid, bool *full)
{
    size_t blended = 0, solid = 0, kept = 0;
    for (size_t i = 0; i < count; i++) {
        point2 before = c[i ? i - 1 : count - 1].at, here = c[i].at;
        point2 after = c[i + 1 == count ? 0 : i + 1].at;
        c[i].share = corner_share(before, here, after);
        double fan = 0.5 * cross2(centroid, here, after);
        c[i].fan = fan > 0 ? fan : 0;
        blended += c[i].share < 1;
        solid += c[i].share >= 1;
    }
    *full = blended == 0;
    if (*full)
        return count;
    if (solid < 3 || blended > 2 * solid)
        for (size_t i = 0; i < count; i++)
            c[i].share = 1; /* a round outline: its small turns are no wobble */
    size_t first = 0;
    while (c[first].share < 1)
        first++;
    if (first) { /* begin at a full corner, so that what is dropped has one before it */
        for (size_t turns = 0; turns < first; turns++) {
            corner head = c[0];
            memmove(c, c + 1, (count - 1) * sizeof *c);
            c[count - 1] = head;
        }
    }
    for (size_t i = 0; i < count; i++)
        if (c[i].share > 0)
            c[kept++] = c[i];
        else
            c[kept - 1].fan += c[i].fan;
    return kept;
}

/* Everything a point needs to become one. */
typedef struct patch {
    frame2 frame;
    tl_plane a, b;               /* in A's frame */
    double rest, rest_x, rest_y; /* distance from A's face over the plane of the patch */
    double weight;               /* from area in the plane of the patch to area of the points */
    double corner,
        middle;     /* of the fan triangle of an edge: the share of each end, of its middle */
    uint32_t faces; /* key of the two faces */
    tl_patch_points *out;
} patch;

/* Adds a point for which there is room; without area it would carry nothing, and have no stress. */
static inline void add_point(const patch *p, point2 at, tl_lean lean, double area, uint32_t key)
{
    const frame2 *f = &p->frame;
    tl_patch_points *out = p->out;
    size_t i = out->count;
    out->p[0][i] = f->o.x + at.x * f->t1.x + at.y * f->t2.x;
    out->p[1][i] = f->o.y + at.x * f->t1.y + at.y * f->t2.y;
    out->p[2][i] = f->o.z + at.x * f->t1.z + at.y * f->t2.z;
    out->rest[i] = p->rest + at.x * p->rest_x + at.y * p->rest_y;
    out->lean[i] = lean;
    out->area[i] = p->weight * area;
    out->key[i] = p->faces ^ key;
    out->count += p->weight * area > 0;
}

/* Adds middles and corners when all corners are full. */
static void add_full_edges(const patch *p, const corner *c, size_t count)
{
    for (size_t i = 0; i < count && p->middle > 0; i++) {
        const corner *next = &c[i + 1 == count ? 0 : i + 1];
        point2 middle = {0.5 * (c[i].at.x + next->at.x), 0.5 * (c[i].at.y + next->at.y)};
        add_point(p, middle, between(c[i].lean, next->lean), p->middle * c[i].fan,
                  key_of(POINT_MIDDLE, c[i].key, next->key));
    }
    for (size_t i = 0; i < count; i++) {
        double fans = c[i ? i - 1 : count - 1].fan + c[i].fan;
        add_point(p, c[i].at, c[i].lean, p->corner * fans, c[i].key);
    }
}

/* The same with a mixture: for every two corners that may follow each other in the mixture, the rule
 * of their edge, times the chance that they do. */
static void add_edges(const patch *p, corner *c, size_t count, double *corner_area)
{
    memset(corner_area, 0, count * sizeof *corner_area);
    for (size_t i = 0; i < count; i++) {
        double chance = c[i].share, fan = 0;
        for (size_t step = 1; step <= count && chance > 0; step++) {
            size_t j = (i + step) % count;
            fan += c[(i + step - 1) % count].fan;
            double share = step > BLEND_RUN ? 1 : c[j].share;
            double area = chance * share * fan;
            if (area > 0) {
                point2 middle = {0.5 * (c[i].at.x + c[j].at.x), 0.5 * (c[i].at.y + c[j].at.y)};
                add_point(p, middle, between(c[i].lean, c[j].lean), p->middle * area,
                          key_of(POINT_MIDDLE, c[i].key, c[j].key));
                corner_area[i] += p->corner * area;
                corner_area[j] += p->corner * area;
            }
            chance *= 1 - share;
        }
    }
    for (size_t i = 0; i < count; i++)
        add_point(p, c[i].at, c[i].lean, corner_area[i], c[i].key);
}

/* Loads both outlines, counter-clockwise seen against the patch normal, and clips. */
static size_t clip_faces(const tl_pair_view *view, uint32_t fa, uint32_t fb, const frame2 *frame,
                         struct tl_polygon *p)
{
    const tl_poly *a = view->a, *b = view->b;
    uint32_t na = tl_poly_face_size(a, fa), nb = tl_poly_face_size(b, fb);
    for (uint32_t i = 0; i < na; i++) {
        uint16_t v = a->loop[a->start[fa] + i];
        p->now[i] = (corner){.at = project(frame, a->vertex[v]),
                             .key = vertex_key(POINT_A, v),
                             .edge = i,
                             .lean = {-1, 0}};
    }
    for (uint32_t i = 0; i < nb; i++)
        p->clip[i] = project(frame, view->vertex_b[b->loop[b->start[fb] + nb - 1 - i]]);
    size_t count = na;
    for (uint32_t j = 0; j < nb && count; j++)
        count = clip_by(p, count, j, nb);
    return count;
}

/* The plane of the patch, through a point of A's face. */
static void lay_frame(patch *p, tl_vec3 through)
{
    frame2 *f = &p->frame;
    f->n = tl_v3_unit(tl_v3_sub(p->a.normal, p->b.normal));
    f->o = through;
    f->t1 = tl_v3_perpendicular(f->n);
    f->t2 = tl_v3_cross(f->n, f->t1);
}

/* Moves the plane of the patch into the middle between the two faces at the centroid, and notes how far A's
 * face is from it; returns the cosine of its tilt against either. */
static double move_between(patch *p, point2 centroid)
{
    frame2 *f = &p->frame;
    tl_vec3 x = tl_v3_madd(tl_v3_madd(f->o, centroid.x, f->t1), centroid.y, f->t2);
    double up = tl_v3_dot(p->b.normal, x) - p->b.offset;
    double down = tl_v3_dot(p->a.normal, x) - p->a.offset;
    double slope = tl_v3_dot(f->n, p->a.normal);
    f->o = tl_v3_madd(f->o, 0.5 * (up - down) / slope, f->n);
    p->rest = tl_v3_dot(p->a.normal, f->o) - p->a.offset;
    p->rest_x = tl_v3_dot(p->a.normal, f->t1);
    p->rest_y = tl_v3_dot(p->a.normal, f->t2);
    return slope;
}

/* Makes room for `count` points. */
static bool reserve(tl_patch_points *out, size_t count)
{
    if (count <= out->room)
        return true;
    size_t room = 2 * count;
    double *block = room > UINT16_MAX
                        ? NULL
                        : malloc(room * (5 * sizeof(double) + sizeof(tl_lean) + sizeof(uint32_t)));
    if (!block)
        return false;
    free(out->p[0]);
    for (int k = 0; k < 3; k++)
        out->p[k] = block + (size_t)k * room;
    out->rest = block + 3 * room;
    out->area = block + 4 * room;
    out->lean = (tl_lean *)(void *)(block + 5 * room);
    out->key = (uint32_t *)(void *)(out->lean + room);
    out->room = room;
    return true;
}

/* Smallest gap: of a polygon, at a corner. */
static double nearest_gap(const patch *p, const corner *c, size_t count)
{
    const frame2 *f = &p->frame;
    double g = p->rest + tl_v3_dot(p->b.normal, f->o) - p->b.offset, nearest = INFINITY;
    double x = p->rest_x + tl_v3_dot(p->b.normal, f->t1);
    double y = p->rest_y + tl_v3_dot(p->b.normal, f->t2);
    for (size_t i = 0; i < count; i++) {
        double gap = g + c[i].at.x * x + c[i].at.y * y;
        nearest = gap < nearest ? gap : nearest;
    }
    return nearest;
}

static point2 rise_of(const frame2 *f, tl_vec3 na, tl_vec3 nb)
{
    tl_vec3 up = tl_v3_unit(tl_v3_add(na, nb));
    return (point2){tl_v3_dot(up, f->t1), tl_v3_dot(up, f->t2)};
}

/* Of the centroid, which is a mean of the corners by their fan triangles. */
static tl_lean mean_lean(const corner *c, size_t count)
{
    double face = 0, edge = 0, area = 0;
    for (size_t i = 0; i < count; i++) {
        double fans = c[i ? i - 1 : count - 1].fan + c[i].fan;
        face += fans * c[i].lean.face;
        edge += fans * c[i].lean.edge;
        area += fans;
    }
    return (tl_lean){(float)(face / area), (float)(edge / area)};
}

double tl_patch_lay(const tl_pair_view *view, uint32_t fa, uint32_t fb, double weight,
                    const tl_share_rule *rule, tl_narrow *room)
{
    const tl_poly *a = view->a, *b = view->b;
    /* each clip adds a corner, or two where rounding makes it cross a straight run of corners twice */
    size_t most = (size_t)tl_poly_face_size(a, fa) + 2 * (size_t)tl_poly_face_size(b, fb) + 4;
    struct tl_polygon *p = polygon_room(room, most, tl_poly_face_size(b, fb));
    room->patch.count = 0;
    if (!p) {
        room->manifold.failed = true;
        return 0;
    }
    patch one = {.corner = rule->corners ? 0.5 : 1. / 12,
                 .middle = rule->corners ? 0 : 1. / 3,
                 .faces = key_of(0, fa, fb),
                 .out = &room->patch,
                 .a = a->plane[fa]};
    one.b.normal = view->normal_b[fb];
    one.b.offset = b->plane[fb].offset + tl_v3_dot(one.b.normal, view->shift);
    lay_frame(&one, a->vertex[a->loop[a->start[fa]]]);
    p->snap2 = MERGE * MERGE * view->size * view->size;
    p->rise = rise_of(&one.frame, one.a.normal, one.b.normal);

    double size = fmax(a->size, b->size);
    size_t count = merge_near(p, clip_faces(view, fa, fb, &one.frame, p), MERGE * view->size);
    point2 centroid = {0, 0};
    double area = count >= 3 ? area_of(p->now, count, &centroid) : 0;
    if (!(area > THIN * size * view->size))
        return 0;
    one.weight = weight / move_between(&one, centroid);
    if (nearest_gap(&one, p->now, count) > rule->reach)
        return 0;
    bool full;
    count = weigh_corners(p->now, count, centroid, &full);
    /* a middle for every two corners that may follow each other, the corners, the centroid */
    if (!reserve(one.out, full ? 2 * count + 1 : (BLEND_RUN + 2) * count + 1)) {
        room->manifold.failed = true;
        return 0;
    }
    if (full)
        add_full_edges(&one, p->now, count);
    else /* the clipping is over: its room is free */
        add_edges(&one, p->now, count, (double *)(void *)p->next);
    add_point(&one, centroid, mean_lean(p->now, count), (1 - 2 * one.corner - one.middle) * area,
              key_of(POINT_CENTROID, 0, 0));
    return one.weight * area;
}

double tl_patch_add(const tl_pair_view *view, uint32_t fa, uint32_t fb, double weight,
                    tl_vec3 swing, const tl_share_rule *rule, tl_narrow *room)
{
    double area = tl_patch_lay(view, fa, fb, weight, rule, room);
    tl_manifold *m = &room->manifold;
    const tl_patch_points *from = &room->patch;
    if (!(area > 0) || !tl_manifold_reserve(m, from->count))
        return 0;
    tl_plane plane = view->b->plane[fb];
    tl_facet facet = {.kind = TL_FACET_PATCH,
                      .ia = (uint16_t)fa,
                      .ib = (uint16_t)fb,
                      .begin = (uint16_t)m->point_count,
                      .count = (uint16_t)from->count,
                      .na = view->a->plane[fa].normal,
                      .nb = plane.normal,
                      .offset = view->a->plane[fa].offset + plane.offset};
    tl_facet_set_swing(&facet, swing);
    m->facets[m->facet_count++] = facet;
    for (size_t i = 0; i < from->count; i++)
        m->points[m->point_count++] = (tl_contact_point){.p = tl_columns_get(from->p, i),
                                                         .lean = from->lean[i],
                                                         .area = from->area[i],
                                                         .key = from->key[i]};
    return area;
}

bool tl_segment_over_face(tl_vec3 p, tl_vec3 q, const tl_vec3 *corners, size_t count, tl_vec3 n,
                          double slack, double *t0, double *t1)
{
    *t0 = 0;
    *t1 = 1;
    for (size_t i = 0; i < count; i++) {
        tl_vec3 c = corners[i], d = corners[i + 1 == count ? 0 : i + 1];
        tl_vec3 inward = tl_v3_unit(tl_v3_cross(n, tl_v3_sub(d, c)));
        double hp = tl_v3_dot(inward, tl_v3_sub(p, c)) + slack;
        double hq = tl_v3_dot(inward, tl_v3_sub(q, c)) + slack;
        if (hp < 0 && hq < 0)
            return false;
        if (hp < 0)
            *t0 = fmax(*t0, hp / (hp - hq));
        else if (hq < 0)
            *t1 = fmin(*t1, hp / (hp - hq));
    }
    return *t0 <= *t1;
}
