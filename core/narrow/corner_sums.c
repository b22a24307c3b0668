/* corner_sums.c - the patch of two flush faces with springs at its corners, in the press of a pair.
 *
 * With the areas A_k of the corners and their overlaps o_k, the integrals over the patch are
 *
 *     G_p = 1/4 sum A_k o_k^2,    V_p = sum A_k o_k,    and so on,
 *
 * functions of where B is. As it moves, the overlaps change, and so does the common polygon with its corners and
 * areas. Over the edge of a face that is pressed in one counts as much as the other. Force and moment are minus the
 * gradient of all of that.
 *
 * In the plane of the patch a point of A, at the height h_A over it, goes by v_A = -h_A dm as B moves. For the plane
 * turns with half of B, whose normal changes by dm. One of B goes by v_B, of its own motion less h_B dm. The edges of
 * the polygon are lines of A, of B, or half of each, which go so, and its corners are where they meet. That gives the
 * rates of the corners, of the fan triangles about the centroid, and of the A_k. The shares of corners that are almost
 * straight go with their turning angles. */
#include "narrow/corner_sums.h"

#include "base/table.h"
#include "narrow/common_polygon.h"

#include <talus/vmath.h>

/* Tolerance: sine of the angle between two edges below which where they meet is no corner: it runs along them as they
 * wobble. */
#define ALONG TL_STRAIGHT

/* Of these sums the gradients are wanted. */
enum { ENERGY, VOLUME, POWERS, WHOLES = POWERS + TL_FIELD_POWERS };

/* A motion of B: of a point that goes with it by `way`, and about it. */
typedef struct motion {
    tl_vec3 about, way, turn;
} motion;

/* What the plane of the patch does in a motion: its normal's change in the plane, and that of `secant`. */
typedef struct plane_rate {
    tl_point2 turn;
    double secant;
} plane_rate;

/* What is known of the corners. Those that are almost straight are dropped: those that stay are the first ones of the
 * polygon's. */
typedef struct corners {
    tl_common_polygon polygon;
    size_t count;    /* before any was dropped */
    tl_point2 *at;   /* of each of these */
    tl_point2 *rate; /* and how it goes */
    tl_point2 *of_a; /* how a line of A goes there */
    tl_point2 *more; /* and how much faster one of B */
    double *share_rate;
    uint32_t *edge;   /* that leaves it */
    double *ride;     /* of that: tl_common_edge_ride */
    double *fan_rate; /* of that */
    uint32_t *from;   /* and which one that stays it goes to */
    double *fan, *area, *area_rate;
} corners;

static double overlap_at(const tl_corner_faces *f, tl_vec3 x)
{
    return f->a.offset + f->b.offset - tl_v3_dot(tl_v3_add(f->a.normal, f->b.normal), x);
}

/* ---------------------------------------------------------------- corners ---------------- */

static bool reserve(tl_narrow_scratch *scratch, corners *c)
{
    const size_t n = c->polygon.count, doubles = 15 * n;
    if (!tl_grow(&scratch->corner, &scratch->corner_capacity, doubles + 1, sizeof(double)))
        return false;
    double *at = scratch->corner;
    c->at = (tl_point2 *)(void *)at;
    c->rate = (tl_point2 *)(void *)(at + 2 * n);
    c->ride = at + 4 * n;
    c->fan_rate = at + 5 * n;
    c->fan = at + 6 * n;
    c->area = at + 7 * n;
    c->area_rate = at + 8 * n;
    c->of_a = (tl_point2 *)(void *)(at + 10 * n);
    c->more = (tl_point2 *)(void *)(at + 12 * n);
    c->share_rate = at + 14 * n;
    c->edge = (uint32_t *)(void *)(at + 9 * n);
    c->from = c->edge + n;
    return true;
}

/* Which corners those that stay were, by the edges that leave them. */
static void find_origins(corners *c)
{
    const tl_common_polygon *p = &c->polygon;
    size_t first = 0, k = 0;
    while (c->edge[first] != p->corner[0].edge)
        first++;
    for (size_t step = 0; step < c->count; step++) {
        const size_t i = (first + step) % c->count;
        if (step && k + 1 < p->count && c->edge[i] == p->corner[k + 1].edge)
            k++;
        c->from[i] = (uint32_t)k;
    }
}

/* The corners of two faces, and their areas; there may be none. false: out of memory. */
static bool find_corners(const tl_pair_view *view, const tl_corner_faces *faces, tl_narrow_scratch *scratch, corners *c)
{
    tl_common_polygon *p = &c->polygon;
    if (!tl_common_polygon_find(view, faces->fa, faces->fb, scratch, p) || !reserve(scratch, c))
        return false;
    c->count = p->count;
    if (c->count == 0)
        return true;
    for (size_t i = 0; i < c->count; i++) {
        c->at[i] = p->corner[i].at;
        c->edge[i] = p->corner[i].edge;
    }
    tl_corners_weigh(p, true);
    find_origins(c);
    for (size_t i = 0; i < p->count; i++)
        c->fan[i] = p->corner[i].fan;
    tl_corner_areas(p->corner, c->fan, p->count, c->area);
    return true;
}

/* ---------------------------------------------------------------- rates ------------------ */

static tl_vec3 way_at(const motion *by, tl_vec3 x)
{
    return tl_v3_add(by->way, tl_v3_cross(by->turn, tl_v3_sub(x, by->about)));
}

static tl_point2 in_plane(const tl_frame2 *f, tl_vec3 x)
{
    return (tl_point2){tl_v3_dot(x, f->t1), tl_v3_dot(x, f->t2)};
}

static plane_rate plane_rate_of(const tl_common_polygon *p, const motion *by)
{
    const tl_vec3 apart = tl_v3_sub(p->a.normal, p->b.normal);
    const double inverse = 1 / tl_v3_norm(apart);
    const tl_vec3 change = tl_v3_scale(-inverse, tl_v3_cross(by->turn, p->b.normal));
    return (plane_rate){in_plane(&p->frame, change), -p->frame.secant * tl_v3_dot(p->frame.n, change)};
}

/* How high a plane lies over a place of the patch's plane. */
static double height_of(tl_plane plane, const tl_frame2 *f, tl_vec3 x)
{
    return (plane.offset - tl_v3_dot(plane.normal, x)) / tl_v3_dot(plane.normal, f->n);
}

/* How fast lines go there that are A's, and how much faster those that are B's. */
static void find_rates(const tl_common_polygon *p, const motion *by, const plane_rate *plane, tl_point2 at,
                       tl_point2 *of_a, tl_point2 *more)
{
    const tl_frame2 *f = &p->frame;
    const tl_vec3 x = tl_frame2_point(f, at);
    const double a = height_of(p->a, f, x), b = height_of(p->b, f, x);
    const tl_point2 way = in_plane(f, way_at(by, tl_v3_madd(x, b, f->n)));
    *of_a = (tl_point2){-a * plane->turn.x, -a * plane->turn.y};
    *more = (tl_point2){way.x - b * plane->turn.x - of_a->x, way.y - b * plane->turn.y - of_a->y};
}

/* The rate of the corner where two edges of the directions u and v meet, which go with B by the shares `before` and
 * `after`. */
static tl_point2 rate_of_meeting(tl_point2 u, tl_point2 v, double before, double after, tl_point2 of_a, tl_point2 more)
{
    const double across = u.x * v.y - u.y * v.x;
    const double lengths = sqrt((u.x * u.x + u.y * u.y) * (v.x * v.x + v.y * v.y));
    double share = before, along = 0;
    if (fabs(across) > ALONG * lengths)
        along = (after - before) * (more.x * v.y - more.y * v.x) / across;
    else
        share = 0.5 * (before + after);
    return (tl_point2){of_a.x + share * more.x + along * u.x, of_a.y + share * more.y + along * u.y};
}

static size_t after(const corners *c, size_t i)
{
    return i + 1 == c->count ? 0 : i + 1;
}

static size_t before(const corners *c, size_t i)
{
    return i ? i - 1 : c->count - 1;
}

static void find_corner_rates(const corners *c, const motion *by, const plane_rate *plane)
{
    for (size_t i = 0; i < c->count; i++) {
        const size_t last = before(c, i), next = after(c, i);
        const tl_point2 here = c->at[i];
        find_rates(&c->polygon, by, plane, here, &c->of_a[i], &c->more[i]);
        c->rate[i] = rate_of_meeting(tl_from_to(c->at[last], here), tl_from_to(here, c->at[next]), c->ride[last],
                                     c->ride[i], c->of_a[i], c->more[i]);
    }
}

static double cross(tl_point2 a, tl_point2 b)
{
    return a.x * b.y - a.y * b.x;
}

/* How fast the line of an edge turns. */
static double turn_of(const corners *c, size_t i)
{
    const size_t next = after(c, i);
    const double ride = c->ride[i];
    const tl_point2 u = tl_from_to(c->at[i], c->at[next]);
    const tl_point2 a = tl_from_to(c->of_a[i], c->of_a[next]);
    const tl_point2 b = tl_from_to(c->more[i], c->more[next]);
    const tl_point2 way = {a.x + ride * b.x, a.y + ride * b.y};
    return cross(u, way) / (u.x * u.x + u.y * u.y);
}

/* How the share of a corner goes with its turning angle, 1/rad. */
static double share_slope(tl_point2 before, tl_point2 here, tl_point2 after)
{
    tl_point2 u = tl_from_to(before, here), v = tl_from_to(here, after);
    double uv = (u.x * u.x + u.y * u.y) * (v.x * v.x + v.y * v.y);
    double x = tl_turn_over(tl_asin(fmin(1, fmax(-1, (u.x * v.y - u.y * v.x) / sqrt(uv)))));
    return x <= 0 || x >= 1 ? 0 : 6 * x * (1 - x) / (TL_CORNER - TL_STRAIGHT);
}

/* The rates of the shares of those that stay, by what their edges turn. */
static void find_share_rates(const corners *c)
{
    const tl_corner *corner = c->polygon.corner;
    for (size_t i = 0; i < c->count; i++) {
        const size_t k = c->from[i], last = before(c, i);
        if (c->edge[i] != corner[k].edge)
            continue;
        c->share_rate[k] = 0;
        if (corner[k].share < 1)
            c->share_rate[k] =
                (turn_of(c, i) - turn_of(c, last)) * share_slope(c->at[last], c->at[i], c->at[after(c, i)]);
    }
}

/* The rate of the centroid: of the mean of the triangles at the first corner. */
static tl_point2 centroid_rate(const corners *c)
{
    double area = 0, rate = 0;
    tl_point2 first = {0, 0}, change = {0, 0};
    for (size_t i = 1; i + 1 < c->count; i++) {
        tl_point2 u = tl_from_to(c->at[0], c->at[i]), v = tl_from_to(c->at[0], c->at[i + 1]);
        tl_point2 du = tl_from_to(c->rate[0], c->rate[i]);
        tl_point2 dv = tl_from_to(c->rate[0], c->rate[i + 1]);
        double a = cross(u, v), da = cross(du, v) + cross(u, dv);
        area += a;
        rate += da;
        first.x += a * (u.x + v.x);
        first.y += a * (u.y + v.y);
        change.x += da * (u.x + v.x) + a * (du.x + dv.x);
        change.y += da * (u.y + v.y) + a * (du.y + dv.y);
    }
    double by = 1 / (3 * area), less = rate / area;
    return (tl_point2){c->rate[0].x + by * (change.x - less * first.x),
                       c->rate[0].y + by * (change.y - less * first.y)};
}

/* Adds to the rates of the areas what the rates of the shares make of them. */
static void add_by_shares(const tl_corner *c, const double *fan, const double *share_rate, size_t count, double *rate)
{
    for (size_t i = 0; i < count; i++) {
        double chance = c[i].share, more = share_rate[i], between = 0;
        for (size_t step = 1; step <= count && chance > 0; step++) {
            size_t j = (i + step) % count;
            bool last = step > TL_BLEND_RUN;
            double share = last ? 1 : c[j].share, grows = last ? 0 : share_rate[j];
            between += fan[(i + step - 1) % count];
            double half = 0.5 * between * (more * share + chance * grows);
            rate[i] += half;
            rate[j] += half;
            more = more * (1 - share) - chance * grows;
            chance *= 1 - share;
        }
    }
}

/* The rates of the areas of those that stay, in the plane. */
static void find_area_rates(const corners *c)
{
    const tl_common_polygon *p = &c->polygon;
    const tl_point2 moves = centroid_rate(c);
    for (size_t k = 0; k < p->count; k++)
        c->fan_rate[k] = 0;
    for (size_t i = 0; i < c->count; i++) {
        const size_t next = after(c, i);
        tl_point2 u = tl_from_to(p->centroid, c->at[i]), v = tl_from_to(p->centroid, c->at[next]);
        tl_point2 du = tl_from_to(moves, c->rate[i]), dv = tl_from_to(moves, c->rate[next]);
        c->fan_rate[c->from[i]] += 0.5 * (cross(du, v) + cross(u, dv));
    }
    tl_corner_areas(p->corner, c->fan_rate, p->count, c->area_rate);
    find_share_rates(c);
    add_by_shares(p->corner, c->fan, c->share_rate, p->count, c->area_rate);
}

/* The rate of the overlap at a place of the plane that moves. */
static double overlap_rate(const tl_corner_faces *f, const tl_frame2 *plane, const motion *by, tl_vec3 x,
                           tl_point2 rate)
{
    const tl_point2 slope = in_plane(plane, tl_v3_add(f->a.normal, f->b.normal));
    return tl_v3_dot(f->b.normal, way_at(by, x)) - slope.x * rate.x - slope.y * rate.y;
}

/* ---------------------------------------------------------------- sums ------------------- */

/* Adds what an area with an overlap stores: to G, to V, and to the integrals of d^2 and d^3. */
static void add_wholes(double area, double o, double sum[WHOLES])
{
    sum[ENERGY] += area * o * o / 4;
    sum[VOLUME] += area * o;
    sum[POWERS] += area * o * o * o / 12;
    sum[POWERS + 1] += area * o * o * o * o / 32;
}

/* How fast that changes with the overlap. */
static void add_slopes(double area, double o, double rate, double sum[WHOLES])
{
    sum[ENERGY] += area * o * rate / 2;
    sum[VOLUME] += area * rate;
    sum[POWERS] += area * o * o * rate / 4;
    sum[POWERS + 1] += area * o * o * o * rate / 8;
}

/* Rates of all sums in a motion. */
static void find_sum_rates(const corners *c, const tl_corner_faces *faces, const motion *by, double sum[WHOLES])
{
    const tl_common_polygon *p = &c->polygon;
    const plane_rate plane = plane_rate_of(p, by);
    find_corner_rates(c, by, &plane);
    find_area_rates(c);
    for (int k = 0; k < WHOLES; k++)
        sum[k] = 0;
    for (size_t i = 0; i < c->count; i++) {
        const size_t k = c->from[i];
        if (c->edge[i] != p->corner[k].edge)
            continue; /* it was dropped */
        const tl_vec3 x = tl_frame2_point(&p->frame, c->at[i]);
        const double o = overlap_at(faces, x);
        const double area = p->frame.secant * c->area[k];
        const double more = p->frame.secant * c->area_rate[k] + plane.secant * c->area[k];
        if (!(o > 0))
            continue;
        add_wholes(more, o, sum);
        add_slopes(area, o, overlap_rate(faces, &p->frame, by, x, c->rate[i]), sum);
    }
}

/* Puts what is one component of the gradients. */
static void put_slopes(const double rate[WHOLES], int axis, tl_field_sums *out)
{
    tl_vec3 *const force[] = {&out->force, &out->swept, &out->powers[0].force, &out->powers[1].force};
    tl_vec3 *const moment[] = {&out->moment, &out->swept_moment, &out->powers[0].moment, &out->powers[1].moment};
    for (int k = 0; k < WHOLES; k++)
        (&(axis < 3 ? force[k] : moment[k])->x)[axis % 3] = -rate[k];
}

bool tl_corner_sums_find(const tl_pair_view *view, const tl_corner_faces *faces, tl_vec3 origin,
                         tl_narrow_scratch *scratch, tl_field_sums *out)
{
    corners c;
    double sum[WHOLES] = {0};
    *out = (tl_field_sums){0};
    if (!find_corners(view, faces, scratch, &c))
        return false;
    const tl_frame2 *frame = &c.polygon.frame;
    for (size_t i = 0; i < c.polygon.count; i++) {
        const tl_vec3 place = tl_frame2_point(frame, c.polygon.corner[i].at);
        const tl_vec3 x = tl_v3_sub(place, origin);
        const double area = frame->secant * c.area[i], overlap = overlap_at(faces, place);
        const double half = 0.5 * area * overlap;
        if (!(overlap > 0))
            continue;
        add_wholes(area, overlap, sum);
        out->area = tl_v3_madd(out->area, area, frame->n);
        out->pressure += half;
        out->pressed = tl_v3_madd(out->pressed, half, x);
        out->extent += area;
        out->first = tl_v3_madd(out->first, area, x);
        out->second += area * tl_v3_norm2(x);
        out->stiffness += area;
    }
    out->energy = sum[ENERGY];
    out->volume = sum[VOLUME];
    for (int k = 0; k < TL_FIELD_POWERS; k++)
        out->powers[k].whole = sum[POWERS + k];
    return true;
}

bool tl_corner_sums_slopes(const tl_pair_view *view, const tl_corner_faces *faces, tl_vec3 origin,
                           tl_narrow_scratch *scratch, tl_field_sums *sums)
{
    corners c;
    if (!find_corners(view, faces, scratch, &c))
        return false;
    for (size_t i = 0; i < c.count; i++)
        c.ride[i] = tl_common_edge_ride(&c.polygon, c.edge[i]);
    for (int axis = 0; axis < 6; axis++) {
        motion by = {.about = origin};
        double rate[WHOLES];
        (&(axis < 3 ? &by.way : &by.turn)->x)[axis % 3] = 1;
        find_sum_rates(&c, faces, &by, rate);
        put_slopes(rate, axis, sums);
    }
    return true;
}
