/* lean.c - the plane that stands for the lifts of the points of a patch.
 *
 * A field contact has no points that could be lifted each by its own amount: its faces are moved. A plane has
 * three numbers, so force and moments go on where the patch hands over. A plane wall presses with u > 0 over
 * some part of the patch, with the int u and int u x of the patch. Of all overlaps with these the plane one has
 * the least energy, so what is off it is lost, and none is made. Where nothing presses the plane fits the lifts
 * of all points. Each face leans by half of it, and goes with its own body from then on. */
#include "contact/lean.h"

#include "contact/across_gap.h"
#include "contact/cells.h"
#include "contact/pair_view.h"
#include "contact/places.h"
#include "narrow/corner.h"

/* Tolerance: difference of lifts, over the largest, below which they are the same. Test: lua/test_moved_faces. */
#define SAME 1e-12
/* Tolerance: distance from a line within which points are on it, over the root of their area. Test:
 * lua/test_moved_faces. */
#define ON_A_LINE 1e-6
/* Tolerance: planes tried for what bears, and the change over the size at which one is found. */
#define MOST_TRIED 60
#define FOUND 1e-12
/* Size of the smaller block, times this, within which a face that leans may be farther out, per unit of its
 * lean. Both faces lean, about places up to a size away. */
#define LEVER 4

/* Weighted sums of the lifts l over points at x, y in the plane. */
typedef struct sums {
    double w, wx, wy, wl, wxx, wxy, wyy, wxl, wyl, low, high;
} sums;

static void add(sums *s, double w, double x, double y, double l)
{
    s->w += w;
    s->wx += w * x;
    s->wy += w * y;
    s->wl += w * l;
    s->wxx += w * x * x;
    s->wxy += w * x * y;
    s->wyy += w * y * y;
    s->wxl += w * x * l;
    s->wyl += w * y * l;
    s->low = fmin(s->low, l);
    s->high = fmax(s->high, l);
}

/* Where points lie in the plane: about a place, along two axes. */
typedef struct axes {
    tl_vec3 about, t1, t2;
} axes;

/* Sums over the points that press, or over all. Without axes none has a place. */
static sums sums_of(const tl_model *m, uint32_t c, bool pressing, const axes *plane)
{
    const tl_detect *d = m->detect;
    const tl_points_table *p = &d->points;
    sums s = {.low = INFINITY, .high = -INFINITY};
    double lift[TL_LANES], x[2] = {0, 0};
    for (size_t k = 0; k < d->contacts.point_count[c]; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        if (k % TL_LANES == 0)
            tl_contact_point_lifts(m, c, k, lift);
        if (pressing && !(p->f_n[i] > 0))
            continue;
        if (plane) {
            tl_vec3 arm = tl_v3_sub(tl_contact_point_arm(m, c, k), plane->about);
            x[0] = tl_v3_dot(arm, plane->t1);
            x[1] = tl_v3_dot(arm, plane->t2);
        }
        add(&s, p->area[i], x[0], x[1], lift[k % TL_LANES] - (p->reference ? p->reference[i] : 0));
    }
    return s;
}

/* The same over those that press, where any does. */
static sums sums_where_it_presses(const tl_model *m, uint32_t c, const axes *plane)
{
    sums s = sums_of(m, c, true, plane);
    return s.w > 0 ? s : sums_of(m, c, false, plane);
}

double tl_contact_mean_lift(const tl_model *m, uint32_t c)
{
    if (!tl_contact_is_lifted(m, c))
        return 0;
    sums s = sums_where_it_presses(m, c, NULL);
    return s.w > 0 ? s.wl / s.w : 0;
}

/* A plane of lifts: at a place, and its slope along the axes. */
typedef struct fit {
    double mean, slope[2];
    tl_vec3 about;
} fit;

static bool differ(const sums *s)
{
    return s->w > 0 && s->high - s->low > SAME * fmax(fabs(s->low), fabs(s->high));
}

/* The plane that fits the lifts of the points that press, about the mean place of these. false: it has no slope. */
static bool fit_points(const tl_model *m, uint32_t c, const axes *plane, fit *out)
{
    const sums s = sums_where_it_presses(m, c, plane);
    double x = s.wx / s.w, y = s.wy / s.w, l = s.wl / s.w;
    double i11 = s.wxx - s.w * x * x, i12 = s.wxy - s.w * x * y, i22 = s.wyy - s.w * y * y;
    double m1 = s.wxl - s.w * x * l, m2 = s.wyl - s.w * y * l;
    double det = i11 * i22 - i12 * i12, line = ON_A_LINE * ON_A_LINE * s.w * s.w * (i11 + i22);
    if (!(det > line) || !differ(&s))
        return false;
    out->mean = l;
    out->slope[0] = (m1 * i22 - m2 * i12) / det;
    out->slope[1] = (m2 * i11 - m1 * i12) / det;
    out->about = tl_v3_madd(tl_v3_madd(plane->about, x, plane->t1), y, plane->t2);
    return true;
}

/* A face that is moved out by half of a slope about a point. */
static tl_plane leaning(tl_plane face, tl_vec3 slope, tl_vec3 about)
{
    tl_vec3 n = tl_v3_madd(face.normal, -0.5, slope);
    double length = tl_v3_norm(n), offset = face.offset - 0.5 * tl_v3_dot(slope, about);
    return (tl_plane){tl_v3_scale(1 / length, n), offset / length};
}

/* Turn and place of B's frame in A's. */
static tl_pair_pose pose_of(const tl_model *m, uint32_t c)
{
    tl_pair_view view = tl_contact_view(m, c);
    return (tl_pair_pose){view.turn, view.shift};
}

/* ---------------------------------------------------------------- what bears -------------- */

/* Of a part of the plane: its area, first and second moments. */
typedef struct moments {
    double one, x, y, xx, xy, yy;
} moments;

/* Adds those of the triangle of the centroid and an edge from p to q. */
static void add_edge(moments *to, tl_point2 p, tl_point2 q)
{
    double twice = p.x * q.y - p.y * q.x, third = twice / 6, twelfth = twice / 24;
    double x = p.x + q.x, y = p.y + q.y;
    to->one += 0.5 * twice;
    to->x += third * x;
    to->y += third * y;
    to->xx += twelfth * (p.x * p.x + q.x * q.x + x * x);
    to->xy += twelfth * (p.x * p.y + q.x * q.y + x * y);
    to->yy += twelfth * (p.y * p.y + q.y * q.y + y * y);
}

/* A linear overlap, by its value at the centroid and its slope. Or a force and moments over a stiffness: int u,
 * int u x, int u y. */
typedef struct linear {
    double one, x, y;
} linear;

static tl_point2 corner_of(const tl_cell_patch *of, const axes *plane, size_t k)
{
    tl_vec3 at = tl_cell_corner(of, k % of->corners);
    return (tl_point2){tl_v3_dot(at, plane->t1), tl_v3_dot(at, plane->t2)};
}

/* Of the part of a patch where u > 0. */
static moments pressed_moments(const tl_cell_patch *of, const axes *plane, const linear *u)
{
    moments out = {.one = 0};
    tl_point2 p = corner_of(of, plane, 0), first = {0, 0}, last = {0, 0};
    bool any = false;
    double here = u->one + u->x * p.x + u->y * p.y;
    for (size_t k = 0; k < of->corners; k++) {
        tl_point2 q = corner_of(of, plane, k + 1), cut = p, to = q;
        double there = u->one + u->x * q.x + u->y * q.y, share = here / (here - there);
        tl_point2 zero = {p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)};
        if (here > 0 || there > 0) {
            cut = here > 0 ? p : zero;
            to = there > 0 ? q : zero;
            if (any)
                add_edge(&out, last, cut);
            else
                first = cut;
            add_edge(&out, cut, to);
            last = to;
            any = true;
        }
        p = q;
        here = there;
    }
    add_edge(&out, last, first);
    return out;
}

/* The linear overlap over a part that has the integrals `sum`. false: the part is too thin. */
static bool solve(const moments *of, const linear *sum, linear *u)
{
    double x = of->x / of->one, y = of->y / of->one;
    double xx = of->xx - of->x * x, xy = of->xy - of->x * y, yy = of->yy - of->y * y;
    double mx = sum->x - sum->one * x, my = sum->y - sum->one * y, det = xx * yy - xy * xy;
    if (!(of->one > 0) || !(det > ON_A_LINE * ON_A_LINE * of->one * of->one * (xx + yy)))
        return false;
    u->x = (mx * yy - my * xy) / det;
    u->y = (my * xx - mx * xy) / det;
    u->one = sum->one / of->one - u->x * x - u->y * y;
    return true;
}

/* The overlap u whose closed part, int max(0, u), has the integrals `sum`. Each step takes the one that has
 * them over the part where the last one is closed: Newton's method for the least of int max(0, u)^2 / 2 - sum
 * u. false: none is found. */
static bool find_bearing(const tl_cell_patch *of, const axes *plane, const linear *sum, linear *u)
{
    *u = (linear){1, 0, 0};
    for (int k = 0; k < MOST_TRIED; k++) {
        const linear last = *u;
        const moments part = pressed_moments(of, plane, u);
        if (!solve(&part, sum, u))
            return false;
        double size = sqrt(part.one),
               change = fabs(u->one - last.one) + size * (fabs(u->x - last.x) + fabs(u->y - last.y));
        if (change <= FOUND * (fabs(u->one) + size * (fabs(u->x) + fabs(u->y))))
            return true;
    }
    return false;
}

/* Puts the cells of a patch into the lanes, with overlaps of its faces and lifts from these. false: it has none. */
static bool find_cells(const tl_model *m, uint32_t c, const tl_point_lanes *lanes, tl_cell_patch *of)
{
    const tl_detect *d = m->detect;
    const double *reference = d->points.reference;
    if (!tl_cell_patch_of(m, c, lanes, 0, 1, of) || !tl_cell_patch_is_whole(of))
        return false;
    tl_contact_places(m, c, lanes);
    double lift[TL_LANES];
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        double from = reference ? reference[tl_point_row(&d->contacts, c, k)] : 0;
        if (k % TL_LANES == 0)
            tl_contact_point_lifts(m, c, k, lift);
        lanes->cell[k].lift = lift[k % TL_LANES] - from;
        lanes->cell[k].closure = lanes->closure[k] + from;
    }
    tl_cells_find(of, false);
    return true;
}

/* What presses of a patch, and its overlap before anything lifts it. */
static linear sum_pressed(const tl_cell_patch *of, const axes *plane, linear *overlap)
{
    linear out = {0, 0, 0};
    tl_vec3 moment = {0, 0, 0};
    for (size_t k = 0; k <= 2 * of->corners; k++) {
        const tl_cell *cell = &of->lanes->cell[tl_cell_lane(of, k)];
        out.one += cell->pressed_volume;
        moment = tl_v3_add(moment, cell->pressed);
    }
    out.x = tl_v3_dot(moment, plane->t1);
    out.y = tl_v3_dot(moment, plane->t2);
    const tl_vec3 slope = tl_cells_overlap_slope(of);
    const double centre = of->lanes->cell[tl_cell_lane(of, 2 * of->corners)].closure;
    *overlap = (linear){centre, tl_v3_dot(slope, plane->t1), tl_v3_dot(slope, plane->t2)};
    return out;
}

/* The plane of lifts with which a wall bears what the patch does: the same force, at the same place. false:
 * nothing presses, or the patch has no cells. */
static bool fit_bearing(const tl_model *m, uint32_t c, const tl_point_lanes *lanes, const axes *plane, fit *out)
{
    tl_cell_patch of;
    linear overlap, u;
    if (!find_cells(m, c, lanes, &of))
        return false;
    const linear sum = sum_pressed(&of, plane, &overlap);
    if (!(sum.one > 0) || !find_bearing(&of, plane, &sum, &u))
        return false;
    out->about = tl_cell_arm(&of, 2 * of.corners);
    out->mean = u.one - overlap.one;
    out->slope[0] = u.x - overlap.x;
    out->slope[1] = u.y - overlap.y;
    return true;
}

tl_lean tl_contact_lean(const tl_model *m, uint32_t c, const tl_point_lanes *lanes)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_facet *f = &contacts->facet[c];
    tl_lean out = {.mean = 0};
    if (!tl_contact_is_lifted(m, c))
        return out;
    /* about the mean of both normals: the same whichever block is A */
    axes plane = {.about = tl_contact_point_arm(m, c, 0), .t1 = tl_v3_perpendicular(f->last)};
    plane.t2 = tl_v3_cross(f->last, plane.t1);
    sums s = sums_of(m, c, false, &plane);
    fit by = {.mean = 0};
    out.leans = differ(&s) && (fit_bearing(m, c, lanes, &plane, &by) || fit_points(m, c, &plane, &by));
    out.mean = out.leans ? by.mean : tl_contact_mean_lift(m, c);
    if (!out.leans)
        return out;
    const tl_mat3 *turn = tl_side_rotation(m, tl_contact_sides(m, c).a);
    tl_pair_pose b = pose_of(m, c);
    tl_vec3 g = tl_v3_madd(tl_v3_scale(by.slope[0], plane.t1), by.slope[1], plane.t2);
    tl_vec3 x = tl_m3_tmul(turn, by.about);
    g = tl_m3_tmul(turn, g);
    out.face[0] = leaning(tl_pair_shape(m, contacts->a[c], contacts->b[c])->plane[f->ia], g, x);
    out.face[1] = leaning(tl_pair_shape(m, contacts->b[c], contacts->a[c])->plane[f->ib], tl_m3_tmul(&b.turn, g),
                          tl_m3_tmul(&b.turn, tl_v3_sub(x, b.shift)));
    return out;
}

double tl_lean_reach(double shift, const tl_plane *face, tl_vec3 n, double size)
{
    double lean = face ? tl_v3_norm(tl_v3_sub(face[0].normal, n)) : 0;
    return fabs(shift) + LEVER * size * lean;
}
