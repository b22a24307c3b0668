/* test_patch.c - face on face: areas and moments of the contact points against an independent clipping,
 * stiffness against turning, and that a wobble of the blocks does not make the force jump. */
#include "contact/contacts.h"
#include "contact_scene.h"
#include "narrow/manifold.h"
#include "narrow/press.h"

/* ---------------------------------------------------------------- reference -------------- */

typedef struct flat {
    double x, y;
} flat;

/* Area, first and second moments of area. */
typedef struct moments {
    double area, x, y, xx, yy, xy;
} moments;

static double side_of(flat a, flat b, flat p)
{
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

static int inside(const flat *polygon, size_t count, flat p)
{
    for (size_t i = 0; i < count; i++)
        if (side_of(polygon[i], polygon[(i + 1) % count], p) < 0)
            return 0;
    return 1;
}

static flat centre;

static int by_angle(const void *a, const void *b)
{
    const flat *p = a, *q = b;
    double u = atan2(p->y - centre.y, p->x - centre.x), v = atan2(q->y - centre.y, q->x - centre.x);
    return (u > v) - (u < v);
}

/* Green's theorem. */
static moments polygon_moments(const flat *p, size_t count)
{
    moments m = {0};
    for (size_t i = 0; i < count; i++) {
        flat a = p[i], b = p[(i + 1) % count];
        double c = a.x * b.y - b.x * a.y;
        m.area += c / 2;
        m.x += c * (a.x + b.x) / 6;
        m.y += c * (a.y + b.y) / 6;
        m.xx += c * (a.x * a.x + a.x * b.x + b.x * b.x) / 12;
        m.yy += c * (a.y * a.y + a.y * b.y + b.y * b.y) / 12;
        m.xy += c * (2 * a.x * a.y + a.x * b.y + b.x * a.y + 2 * b.x * b.y) / 24;
    }
    return m;
}

/* Of the common part of two convex polygons: all its possible corners, sorted by angle. */
static moments common_moments(const flat *a, size_t na, const flat *b, size_t nb)
{
    flat all[512];
    size_t count = 0;
    for (size_t i = 0; i < na; i++)
        if (inside(b, nb, a[i]))
            all[count++] = a[i];
    for (size_t j = 0; j < nb; j++)
        if (inside(a, na, b[j]))
            all[count++] = b[j];
    for (size_t i = 0; i < na; i++)
        for (size_t j = 0; j < nb; j++) {
            flat p = a[i], q = a[(i + 1) % na], r = b[j], s = b[(j + 1) % nb];
            double h = side_of(r, s, p), k = side_of(r, s, q);
            double u = side_of(p, q, r), v = side_of(p, q, s);
            if (h * k < 0 && u * v < 0)
                all[count++] = (flat){p.x + h / (h - k) * (q.x - p.x), p.y + h / (h - k) * (q.y - p.y)};
        }
    if (count < 3)
        return (moments){0};
    centre = (flat){0, 0};
    for (size_t i = 0; i < count; i++)
        centre = (flat){centre.x + all[i].x / (double)count, centre.y + all[i].y / (double)count};
    qsort(all, count, sizeof *all, by_angle);
    return polygon_moments(all, count);
}

static moments point_moments(const tl_manifold *m)
{
    moments out = {0};
    for (size_t i = 0; i < m->point_count; i++) {
        const tl_contact_point *p = &m->points[i];
        out.area += p->area;
        out.x += p->area * p->p.x;
        out.y += p->area * p->p.y;
        out.xx += p->area * p->p.x * p->p.x;
        out.yy += p->area * p->p.y * p->p.y;
        out.xy += p->area * p->p.x * p->p.y;
    }
    return out;
}

/* ---------------------------------------------------------------- weights ---------------- */

static const tl_touch_rule any_reach = {.reach = INFINITY};

static tl_manifold *build_by(scene_pair *p, const tl_touch_rule *rule)
{
    const tl_manifold_before none = {.kind = TL_FACET_PATCH};
    const tl_pair_view *view = scene_place(p);
    tl_region region;
    CHECK(tl_region_find(view, TL_LIST_MARGIN * view->size, &p->scratch, &region));
    CHECK(tl_manifold_find(view, &region, rule, &none, &p->scratch));
    return &p->scratch.manifold;
}

/* Builds the manifold of B standing on A, both prisms along z of height 1. */
static const tl_manifold *build(scene_pair *p)
{
    tl_manifold *m = build_by(p, &any_reach);
    CHECK_INT(m->facet.kind, TL_FACET_PATCH);
    return m;
}

static void same_moments(moments found, moments want, double tolerance, double reach)
{
    double a = want.area;
    CHECK_NEAR(found.area, a, tolerance * a);
    CHECK_NEAR(found.x, want.x, tolerance * a * reach);
    CHECK_NEAR(found.y, want.y, tolerance * a * reach);
    CHECK_NEAR(found.xx, want.xx, tolerance * a * reach * reach);
    CHECK_NEAR(found.yy, want.yy, tolerance * a * reach * reach);
    CHECK_NEAR(found.xy, want.xy, tolerance * a * reach * reach);
}

static void outline(flat *out, size_t sides, double radius, double phase, double x, double y)
{
    for (size_t i = 0; i < sides; i++) {
        double a = phase + 2 * TL_PI * (double)i / (double)sides;
        out[i] = (flat){x + radius * cos(a), y + radius * sin(a)};
    }
}

/* Sum, first and second moments of the points' areas are those of the common polygon, exactly. */
TEST(points_integrate_the_common_polygon)
{
    static const size_t sides[] = {3, 4, 5, 6, 8, 13};
    uint64_t seed = 3;
    int built = 0;
    for (int i = 0; i < 4000; i++) {
        size_t na = sides[(size_t)(6 * check_random(&seed))];
        size_t nb = sides[(size_t)(6 * check_random(&seed))];
        double ra = scene_between(&seed, 0.3, 2), rb = scene_between(&seed, 0.3, 2);
        double phase_a = scene_between(&seed, 0, 7), twist = scene_between(&seed, 0, 7);
        double x = scene_between(&seed, -1, 1), y = scene_between(&seed, -1, 1);
        flat a[16], b[16];
        outline(a, na, ra, phase_a, 0, 0);
        outline(b, nb, rb, twist, x, y);
        moments want = common_moments(a, na, b, nb);
        if (want.area < 1e-3)
            continue;
        scene_pair p = scene_pair_of(scene_drum(na, ra, 1, phase_a), scene_drum(nb, rb, 1, 0),
                                     scene_turn(tl_v3(0, 0, 1), twist), tl_v3(x, y, 1 - 1e-5));
        const tl_manifold *m = build(&p);
        same_moments(point_moments(m), want, 1e-12, 2);
        for (size_t k = 0; k < m->point_count; k++) {
            CHECK(m->points[k].area > 0);
            for (size_t l = 0; l < k; l++)
                CHECK(m->points[k].key != m->points[l].key);
        }
        built++;
        scene_pair_free(&p);
    }
    CHECK(built > 2000);
}

/* Twins of 64 sides, twisted from nothing to a side: every corner turn and every near coincidence. */
TEST(drums_of_many_sides_keep_their_area)
{
    uint64_t seed = 8;
    for (int i = 0; i < 400; i++) {
        double twist = i == 0 ? 0 : pow(10, scene_between(&seed, -17, -1));
        flat a[128], b[128];
        size_t sides = i % 2 ? 64 : 120;
        outline(a, sides, 1, 0, 0, 0);
        outline(b, sides, 1, twist, 0, 0);
        double x = i % 4 < 2 ? 0 : pow(10, scene_between(&seed, -17, -1));
        for (size_t k = 0; k < sides; k++)
            b[k].x += x;
        scene_pair p = scene_pair_of(scene_drum(sides, 1, 1, 0), scene_drum(sides, 1, 1, 0),
                                     scene_turn(tl_v3(0, 0, 1), twist), tl_v3(x, 0, 1 - 1e-5));
        const tl_manifold *m = build(&p);
        double whole = polygon_moments(a, sides).area;
        moments found = point_moments(m);
        /* nearly coincident, the reference is all of the face; corners nearer than 1e-7 are merged */
        moments want = fmax(twist, x) > 1e-6 ? common_moments(a, sides, b, sides) : polygon_moments(a, sides);
        CHECK_NEAR(found.area, want.area, 4e-6 * whole);
        CHECK_NEAR(found.xx, want.xx, 1e-3 * whole);
        CHECK_NEAR(found.yy, want.yy, 1e-3 * whole);
        scene_pair_free(&p);
    }
}

/* ---------------------------------------------------------------- stiffness -------------- */

#define KN 1e9
#define OVERLAP 1e-4

/* A block A (fixed below) and B standing on its top with the usual overlap. */
static tl_model *stand(tl_poly *a, tl_poly *b, double twist, double x, double y, const char *law)
{
    tl_model *m = scene_model(1);
    scene_block(m, a, tl_q_identity(), tl_v3(0, 0, 0));
    scene_block(m, b, scene_turn(tl_v3(0, 0, 1), twist), tl_v3(x, y, 1 - OVERLAP));
    scene_law(m, law, KN, KN, strcmp(law, "elastic") == 0 ? -1 : 30);
    return m;
}

/* K / (kn I) = 1 about both axes of the polygon and the diagonal. */
static void check_stiffness(tl_poly *a, tl_poly *b, double twist, double x, double y)
{
    tl_model *m = stand(a, b, twist, x, y, "elastic");
    scene_forces(m);
    const tl_detect *d = m->detect;
    if (!CHECK_INT(d->contacts.table.rows, 1)) {
        tl_model_destroy(m);
        return;
    }
    /* I from the points is that of the polygon: points_integrate_the_common_polygon */
    tl_vec3 c = {0, 0, 0};
    double area = 0;
    for (uint32_t i = 0; i < d->contacts.point_count[0]; i++) {
        size_t at = tl_point_row(&d->contacts, 0, i);
        double w = d->points.area[at];
        c = tl_v3_madd(c, w, scene_arm(m, at));
        area += w;
    }
    c = tl_v3_scale(1 / area, c);
    for (int k = 0; k < 4; k++) {
        tl_vec3 axis = tl_v3(cos(k * TL_PI / 4), sin(k * TL_PI / 4), 0);
        tl_vec3 across = tl_v3_cross(tl_v3(0, 0, 1), axis);
        double inertia = 0;
        for (uint32_t i = 0; i < d->contacts.point_count[0]; i++) {
            size_t at = tl_point_row(&d->contacts, 0, i);
            double arm = tl_v3_dot(across, tl_v3_sub(scene_arm(m, at), c));
            inertia += d->points.area[at] * arm * arm;
        }
        /* turn B about an axis through the polygon's centroid, which therefore stays */
        double angle = 1e-6;
        tl_vec3 apart = tl_sides_apart(m, (tl_sides){0, 1}), arm = tl_v3_sub(apart, c);
        tl_quat turn = scene_turn(axis, angle), q = m->bodies.q[1];
        tl_vec3 u = m->bodies.pose[1].u;
        tl_vec3 before = d->contacts.force[0], about = tl_contact_moment(m, 0, false);
        scene_put(m, 1, tl_v3_add(u, tl_v3_sub(tl_q_rotate(turn, arm), arm)), tl_q_mul(turn, q));
        scene_forces(m);
        tl_vec3 force = d->contacts.force[0];
        /* moment of the change of force on B about the centroid of the polygon */
        tl_vec3 change = tl_v3_sub(about, tl_contact_moment(m, 0, false)); /* on B, about A's centroid */
        change = tl_v3_sub(change, tl_v3_cross(c, tl_v3_sub(force, before)));
        CHECK_NEAR(-tl_v3_dot(change, axis) / (KN * inertia * angle), 1, 2e-4);
        CHECK_NEAR(force.z / before.z, 1, 1e-5);
        scene_put(m, 1, u, q);
        scene_forces(m);
    }
    tl_model_destroy(m);
}

TEST(turning_stiffness_is_exact_about_every_axis)
{
    check_stiffness(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1), 0, 0, 0);
    check_stiffness(scene_box_shape(3, 3, 1), scene_drum(3, 1, 1, 0.3), 0, 0, 0);
    check_stiffness(scene_box_shape(3, 3, 1), scene_drum(6, 1, 1, 0.1), 0, 0.2, 0);
    check_stiffness(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1), 0.4, 0.3, 0.2);
    check_stiffness(scene_box_shape(1, 2, 1), scene_drum(5, 0.8, 1, 0), 0.7, -0.2, 0.5);
}

/* I of a unit square is 1/12: the moments of the model are those of the beam, in absolute terms. */
TEST(unit_square_resists_by_one_twelfth)
{
    tl_model *m = stand(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1), 0, 0, 0, "elastic");
    scene_forces(m);
    double angle = 1e-6;
    tl_vec3 arm = {0, 0, 0.5};
    tl_quat turn = scene_turn(tl_v3(1, 0, 0), angle);
    scene_put(m, 1, tl_v3_sub(tl_q_rotate(turn, arm), arm), turn);
    scene_forces(m);
    tl_vec3 moment = tl_contact_moment(m, 0, false);
    CHECK_REL(moment.x, KN * angle / 12, 1e-3);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- wobble ----------------- */

typedef struct load {
    tl_vec3 force, moment;
} load;

/* Force and moment on B with B tilted and then turned about z by `wobble`. */
static load at_wobble(tl_model *m, double tilt, double wobble, tl_vec3 lift)
{
    tl_quat q = tl_q_mul(scene_turn(tl_v3(0, 0, 1), wobble), scene_turn(tl_v3(1, 0.3, 0), tilt));
    scene_put(m, 1, lift, q);
    scene_forces(m);
    return (load){m->detect->contacts.force[0], tl_contact_moment(m, 0, true)};
}

/* Largest relative change of force or moment between neighbouring wobbles, and over all. */
static void wobble(tl_model *m, double tilt, tl_vec3 lift, double *jump, double *most)
{
    load start = at_wobble(m, tilt, 0, lift), last = start;
    double force = tl_v3_norm(start.force);
    *jump = *most = 0;
    for (int sign = -1; sign <= 1; sign += 2) {
        last = start;
        for (double w = 1e-10; w < 1.2e-2; w *= 1.03) {
            load now = at_wobble(m, tilt, sign * w, lift);
            double step = fmax(scene_apart(now.force, last.force), scene_apart(now.moment, last.moment));
            double all = fmax(scene_apart(now.force, start.force), scene_apart(now.moment, start.moment));
            *jump = fmax(*jump, step / force);
            *most = fmax(*most, all / force);
            last = now;
        }
    }
}

/* Equal cubes stacked exactly: a wobble of 1e-9 adds corners to the polygon. */
TEST(wobble_of_a_closed_patch_changes_little)
{
    for (int reuse = 0; reuse < 2; reuse++) {
        tl_model *m = stand(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1), 0, 0, 0, "coulomb");
        m->config.reuse_geometry = reuse;
        double jump, most;
        wobble(m, 0, tl_v3(0, 0, 0), &jump, &most);
        CHECK(jump <= 1e-3);
        CHECK(most <= 0.02); /* the area itself shrinks by about the wobble */
        if (getenv("TALUS_TEST_VERBOSE"))
            printf("  closed: jump %.3g, most %.3g\n", jump, most);
        tl_model_destroy(m);
    }
}

/* Tilted, so that only a part of the points is closed: all of the force hangs on which points there
 * are. Without blending of corners this jumps by 25 to 50 %. */
TEST(wobble_of_a_half_open_patch_does_not_jump)
{
    static const double tilts[] = {2e-4, 3e-4, 5e-4, 1e-3};
    for (int k = 0; k < 4; k++) {
        tl_model *m = stand(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1), 0, 0, 0, "coulomb");
        m->config.reuse_geometry = 0;
        double jump, most;
        wobble(m, tilts[k], tl_v3(0, 0, 0), &jump, &most);
        CHECK(jump <= 5e-3);
        CHECK(most <= 0.05);
        if (getenv("TALUS_TEST_VERBOSE"))
            printf("  tilt %g: jump %.3g, most %.3g\n", tilts[k], jump, most);
        tl_model_destroy(m);
    }
}

/* A wobble below the smallest turning angle of a corner changes nothing but by itself. */
TEST(tiny_wobble_leaves_the_rule_alone)
{
    tl_model *m = stand(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1), 0, 0, 0, "coulomb");
    m->config.reuse_geometry = 0;
    load start = at_wobble(m, 3e-4, 0, tl_v3(0, 0, 0));
    for (double w = 1e-10; w < 0.9e-4; w *= 1.5)
        for (int sign = -1; sign <= 1; sign += 2) {
            load now = at_wobble(m, 3e-4, sign * w, tl_v3(0, 0, 0));
            CHECK(scene_apart(now.force, start.force) <= 10 * w * tl_v3_norm(start.force));
            CHECK(scene_apart(now.moment, start.moment) <= 10 * w * tl_v3_norm(start.force));
        }
    tl_model_destroy(m);
}

TEST(drums_wobble_without_jumps)
{
    tl_model *m = stand(scene_drum(64, 1, 1, 0), scene_drum(64, 1, 1, 0), 0, 0, 0, "coulomb");
    m->config.reuse_geometry = 0;
    double jump, most;
    wobble(m, 0, tl_v3(0, 0, 0), &jump, &most);
    CHECK(jump <= 1e-3);
    CHECK(most <= 5e-3);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- touching along an edge -- */

TEST(faces_that_share_only_an_edge_have_no_points)
{
    static const double shifts[][3] = {{1, 0, 1},         {1, 1, 1},         {1, 0.3, 1},
                                       {1 - 1e-11, 0, 1}, {1, 0, 1 - 1e-11}, {1 - 1e-12, 1, 1}};
    for (size_t i = 0; i < sizeof shifts / sizeof *shifts; i++) {
        scene_pair p = scene_pair_of(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1), tl_q_identity(),
                                     tl_v3(shifts[i][0], shifts[i][1], shifts[i][2]));
        const tl_touch_rule rule = {.min_area = 0.01, .reach = 1.5e-3};
        CHECK_INT(build_by(&p, &rule)->point_count, 0);
        scene_pair_free(&p);
    }
}

/* A patch whose planes are farther apart than the reach is left out. */
TEST(patch_beyond_the_reach_is_left_out)
{
    scene_pair p =
        scene_pair_of(scene_box_shape(1, 1, 1), scene_box_shape(1, 1, 1), tl_q_identity(), tl_v3(0, 0, 1.002));
    tl_touch_rule rule = {.reach = 0.0019};
    CHECK_INT(build_by(&p, &rule)->point_count, 0);
    rule.reach = 0.0021;
    CHECK_NEAR(point_moments(build_by(&p, &rule)).area, 1, 1e-14);
    scene_pair_free(&p);
}

/* A block whose bottom goes on beyond a blunt edge of 3 degrees presses there, too: what is found presses as all of it
 * does, to a thousandth, and is a patch where the edge makes no difference. */
TEST(what_presses_beyond_a_blunt_edge_counts)
{
    const double rise = 0.3 * tan(3 * TL_PI / 180);
    const tl_vec3 points[] = {{-0.5, -0.5, -0.5},      {0.5, -0.5, -0.5},      {-0.5, 0.5, -0.5}, {0.5, 0.5, -0.5},
                              {0.8, -0.5, rise - 0.5}, {0.8, 0.5, rise - 0.5}, {-0.5, -0.5, 0.5}, {0.8, -0.5, 0.5},
                              {-0.5, 0.5, 0.5},        {0.8, 0.5, 0.5}};
    static const double overlaps[] = {1e-6, 1e-5, 1e-4, 1e-3, 3e-3};
    int patches = 0;
    for (size_t i = 0; i < sizeof overlaps / sizeof *overlaps; i++) {
        double o = overlaps[i];
        scene_pair p =
            scene_pair_of(scene_box_shape(3, 3, 1), scene_hull_shape(points, 10), tl_q_identity(), tl_v3(0, 0, 1 - o));
        const tl_manifold *m = build_by(&p, &any_reach);
        bool patch = m->facet.kind == TL_FACET_PATCH;
        double found = patch ? o * point_moments(m).area : 2 * tl_v3_norm(m->press->force);
        tl_region region;
        tl_press all;
        CHECK(tl_region_find(&p.view, TL_LIST_MARGIN * p.view.size, &p.scratch, &region));
        CHECK(tl_press_find(&(tl_press_query){.view = &p.view, .region = &region}, 1, &p.scratch, &all, NULL));
        CHECK_REL(found, 2 * tl_v3_norm(all.force), 1e-3);
        patches += patch;
        scene_pair_free(&p);
    }
    CHECK(patches > 0);
}

TEST_MAIN(RUN(points_integrate_the_common_polygon), RUN(drums_of_many_sides_keep_their_area),
          RUN(turning_stiffness_is_exact_about_every_axis), RUN(unit_square_resists_by_one_twelfth),
          RUN(wobble_of_a_closed_patch_changes_little), RUN(wobble_of_a_half_open_patch_does_not_jump),
          RUN(tiny_wobble_leaves_the_rule_alone), RUN(drums_wobble_without_jumps),
          RUN(faces_that_share_only_an_edge_have_no_points), RUN(patch_beyond_the_reach_is_left_out),
          RUN(what_presses_beyond_a_blunt_edge_counts))
