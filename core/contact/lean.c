/* lean.c - the plane that fits the lifts of the points of a patch.
 *
 * A field contact has no points that could be lifted each by its own amount: its faces are moved. A plane has three numbers, and so
 * force and moment go on where the patch hands over, and its energy but for what the lifts are off the plane. Each face leans by half of
 * it, and goes with its own body from then on. */
#include "contact/lean.h"

#include "contact/across_gap.h"
#include "contact/detection.h"
#include "contact/pair_view.h"
#include "contact/places.h"

/* Difference of lifts, over the largest, below which they are the same. */
#define SAME 1e-12
/* Distance from a line within which points are on it, over the root of their area. */
#define ON_A_LINE 1e-6
/* Size of the smaller block, times this, within which a face that leans may be farther out, per unit of its lean: both lean, about places
 * up to a size away. */
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

/* The slope of the plane about the mean place of the points. false: it has none. */
static bool find_slope(const sums *s, double slope[2])
{
    double x = s->wx / s->w, y = s->wy / s->w, l = s->wl / s->w;
    double i11 = s->wxx - s->w * x * x, i12 = s->wxy - s->w * x * y, i22 = s->wyy - s->w * y * y;
    double m1 = s->wxl - s->w * x * l, m2 = s->wyl - s->w * y * l;
    double det = i11 * i22 - i12 * i12, line = ON_A_LINE * ON_A_LINE * s->w * s->w * (i11 + i22);
    if (!(det > line) || !(s->high - s->low > SAME * fmax(fabs(s->low), fabs(s->high))))
        return false;
    slope[0] = (m1 * i22 - m2 * i12) / det;
    slope[1] = (m2 * i11 - m1 * i12) / det;
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
    const tl_contacts *contacts = &m->detect->contacts;
    tl_pair_view view = tl_pair_view_of(m, contacts->a[c], contacts->b[c]);
    return (tl_pair_pose){view.turn, view.shift};
}

tl_lean tl_contact_lean(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_facet *f = &contacts->facet[c];
    tl_lean out = {.mean = 0};
    if (!tl_contact_is_lifted(m, c))
        return out;
    /* about the mean of both normals: the same whichever block is A */
    axes plane = {.about = tl_contact_point_arm(m, c, 0), .t1 = tl_v3_perpendicular(f->last)};
    plane.t2 = tl_v3_cross(f->last, plane.t1);
    sums s = sums_where_it_presses(m, c, &plane);
    double slope[2];
    out.mean = s.w > 0 ? s.wl / s.w : 0;
    out.leans = s.w > 0 && find_slope(&s, slope);
    if (!out.leans)
        return out;
    const tl_mat3 *turn = &m->bodies.pose[m->blocks.body[contacts->a[c]]].r;
    tl_pair_pose b = pose_of(m, c);
    tl_vec3 g = tl_v3_madd(tl_v3_scale(slope[0], plane.t1), slope[1], plane.t2);
    tl_vec3 x = tl_v3_madd(tl_v3_madd(plane.about, s.wx / s.w, plane.t1), s.wy / s.w, plane.t2);
    g = tl_m3_tmul(turn, g);
    x = tl_m3_tmul(turn, x);
    out.face[0] = leaning(m->blocks.shape[contacts->a[c]]->plane[f->ia], g, x);
    out.face[1] = leaning(m->blocks.shape[contacts->b[c]]->plane[f->ib], tl_m3_tmul(&b.turn, g),
                          tl_m3_tmul(&b.turn, tl_v3_sub(x, b.shift)));
    return out;
}

double tl_lean_at(const tl_model *m, uint32_t c, const tl_plane lean[2], const tl_plane faces[2],
                  tl_vec3 p)
{
    tl_pair_pose b = pose_of(m, c);
    const tl_vec3 at[] = {p, tl_m3_tmul(&b.turn, tl_v3_sub(p, b.shift))};
    double out = 0;
    for (int k = 0; k < 2; k++)
        out += lean[k].offset - faces[k].offset -
               tl_v3_dot(tl_v3_sub(lean[k].normal, faces[k].normal), at[k]);
    return out;
}

double tl_lean_reach(double shift, const tl_plane *face, tl_vec3 n, double size)
{
    double lean = face ? tl_v3_norm(tl_v3_sub(face[0].normal, n)) : 0;
    return fabs(shift) + LEVER * size * lean;
}
