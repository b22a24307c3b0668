/* contact_scene.h - what the tests of contact detection share: shapes, pairs placed by hand, and small
 * models whose bodies are put where a test wants them. */
#ifndef TALUS_TESTS_CONTACT_SCENE_H
#define TALUS_TESTS_CONTACT_SCENE_H

#include "base/columns.h"
#include "check.h"
#include "contact/detection.h"
#include "contact/places.h"
#include "cycle/contact_forces.h"
#include "cycle/cycle_data.h"
#include "cycle/gather.h"
#include "cycle/prepare.h"
#include "cycle/undo.h"
#include "detect/detect.h"
#include "force/laws.h"
#include "generate/stage.h"
#include "generate/stage_commit.h"
#include "generate/staging.h"
#include "geometry/hull.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "model/joints.h"
#include "narrow/narrow.h"
#include "staged.h"

#define SCENE_UNUSED __attribute__((unused))

/* ---------------------------------------------------------------- random things ---------- */

SCENE_UNUSED static double scene_between(uint64_t *seed, double low, double high)
{
    return low + (high - low) * check_random(seed);
}

/* Uniform on the unit sphere. */
SCENE_UNUSED static tl_vec3 scene_direction(uint64_t *seed)
{
    double z = scene_between(seed, -1, 1), angle = scene_between(seed, 0, 2 * TL_PI);
    double r = sqrt(1 - z * z);
    return tl_v3_unit(tl_v3(r * cos(angle), r * sin(angle), z));
}

SCENE_UNUSED static tl_quat scene_turn(tl_vec3 axis, double angle)
{
    tl_vec3 v = tl_v3_scale(sin(0.5 * angle), tl_v3_unit(axis));
    return tl_q_unit((tl_quat){cos(0.5 * angle), v.x, v.y, v.z});
}

SCENE_UNUSED static tl_quat scene_any_turn(uint64_t *seed)
{
    return scene_turn(scene_direction(seed), scene_between(seed, 0, 2 * TL_PI));
}

/* ---------------------------------------------------------------- shapes ----------------- */

SCENE_UNUSED static tl_poly *scene_box_shape(double x, double y, double z)
{
    tl_error error;
    tl_poly *p;
    if (tl_poly_box(tl_v3(-x / 2, -y / 2, -z / 2), tl_v3(x / 2, y / 2, z / 2), &p, &error) != TL_OK)
        exit(1);
    return p;
}

SCENE_UNUSED static tl_poly *scene_hull_shape(const tl_vec3 *points, size_t count)
{
    tl_error error;
    tl_poly *p;
    if (tl_poly_hull(points, count, TL_HULL_OF_CORNERS, &p, &error) != TL_OK) {
        printf("%s\n", error.text);
        exit(1);
    }
    return p;
}

/* Points on an ellipsoid of half axes `half`. */
SCENE_UNUSED static tl_poly *scene_random_hull(uint64_t *seed, size_t count, tl_vec3 half)
{
    tl_vec3 points[64];
    for (;;) {
        tl_error error;
        tl_poly *p;
        for (size_t i = 0; i < count; i++) {
            tl_vec3 d = scene_direction(seed);
            points[i] = tl_v3(half.x * d.x, half.y * d.y, half.z * d.z);
        }
        if (tl_poly_hull(points, count, TL_HULL_OF_CORNERS, &p, &error) == TL_OK)
            return p;
    }
}

/* A prism along z over the polygon of `sides` corners on a circle, the first at `phase`. */
SCENE_UNUSED static tl_poly *scene_drum(size_t sides, double radius, double height, double phase)
{
    tl_vec3 points[256];
    for (size_t i = 0; i < sides; i++) {
        double a = phase + 2 * TL_PI * (double)i / (double)sides;
        points[i] = tl_v3(radius * cos(a), radius * sin(a), -height / 2);
        points[sides + i] = tl_v3(radius * cos(a), radius * sin(a), height / 2);
    }
    return scene_hull_shape(points, 2 * sides);
}

/* ---------------------------------------------------------------- one pair --------------- */

typedef struct scene_pair {
    tl_poly *a, *b;
    tl_quat turn;
    tl_vec3 shift;
    tl_narrow_scratch scratch;
    tl_pair_view view;
} scene_pair;

static inline double scene_mean_face(const tl_poly *p)
{
    double area = 0;
    for (uint32_t f = 0; f < p->face_count; f++)
        area += tl_poly_face_area(p, f);
    return area / p->face_count;
}

/* Fills the view of a pair for its present turn and shift. */
SCENE_UNUSED static tl_pair_view *scene_place(scene_pair *p)
{
    p->view = (tl_pair_view){.a = p->a, .b = p->b};
    p->view.turn = tl_q_matrix(p->turn);
    p->view.shift = p->shift;
    p->view.size = cbrt(fmin(tl_poly_mass(p->a).volume, tl_poly_mass(p->b).volume));
    p->view.mean_face = fmin(scene_mean_face(p->a), scene_mean_face(p->b));
    if (!tl_pair_place(&p->view, &p->scratch))
        exit(1);
    return &p->view;
}

SCENE_UNUSED static scene_pair scene_pair_of(tl_poly *a, tl_poly *b, tl_quat turn, tl_vec3 shift)
{
    return (scene_pair){.a = a, .b = b, .turn = turn, .shift = shift};
}

SCENE_UNUSED static void scene_pair_free(scene_pair *p)
{
    tl_narrow_scratch_free(&p->scratch);
    tl_poly_free(p->a);
    tl_poly_free(p->b);
}

/* Minus the gradient of an energy of `user` by the moves, or turns, of B along or about the axes, by differences of fourth
 * order over h. */
SCENE_UNUSED static tl_vec3 scene_minus_gradient(double (*energy)(void *user, int axis, double way, bool turned),
                                                 void *user, double h, bool turned)
{
    double out[3];
    for (int k = 0; k < 3; k++) {
        double near = energy(user, k, h, turned) - energy(user, k, -h, turned);
        double far = energy(user, k, 2 * h, turned) - energy(user, k, -2 * h, turned);
        out[k] = -(8 * near - far) / (12 * h);
    }
    return tl_v3(out[0], out[1], out[2]);
}

/* ---------------------------------------------------------------- models ----------------- */

static inline void scene_hush(void *user, const char *text)
{
    (void)user;
    (void)text;
}

SCENE_UNUSED static tl_model *scene_model(int64_t threads)
{
    static int loaded;
    tl_error error;
    if (!loaded++) {
        const char *const names[] = {"elastic", "coulomb", "coulomb_tensile", "local"};
        for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
            char path[1024];
            snprintf(path, sizeof path, "%s/%s.so", TALUS_TEST_PLUGIN_DIR, names[i]);
            if (tl_plugin_load(path, &error) != TL_OK)
                printf("%s\n", error.text);
        }
    }
    tl_model_config config = {.size = sizeof(tl_model_config), .seed = 1, .threads = threads, .reuse_geometry = 1};
    tl_model *m;
    if (tl_model_create(&config, &m, &error) != TL_OK)
        exit(1);
    tl_model_log(m, scene_hush, NULL);
    return m;
}

static inline int scene_ok(tl_model *m, tl_status status)
{
    if (status != TL_OK)
        printf("%s\n", tl_model_error(m)->text);
    return CHECK_INT(status, TL_OK);
}

SCENE_UNUSED static void scene_box(tl_model *m, tl_vec3 min, tl_vec3 max)
{
    tl_stage stage;
    scene_ok(m, stage_begin(m, &stage));
    scene_ok(m, tl_stage_add_box(&stage, min, max, 2000, "box"));
    scene_ok(m, tl_stage_commit(&stage));
}

/* A block of the shape of `p` (freed), turned and moved. */
SCENE_UNUSED static void scene_block(tl_model *m, tl_poly *p, tl_quat turn, tl_vec3 shift)
{
    tl_vec3 *points = malloc(p->vertex_count * sizeof *points);
    for (uint32_t i = 0; i < p->vertex_count; i++)
        points[i] = tl_v3_add(tl_q_rotate(turn, p->vertex[i]), shift);
    tl_stage stage;
    scene_ok(m, stage_begin(m, &stage));
    scene_ok(m, tl_stage_add_hull(&stage, points, p->vertex_count, 2000, "hull"));
    scene_ok(m, tl_stage_commit(&stage));
    free(points);
    tl_poly_free(p);
}

SCENE_UNUSED static void scene_law(tl_model *m, const char *law, double kn, double ks, double friction)
{
    tl_value values[] = {{.key = "kn", .type = TL_VALUE_NUMBER, .number = kn},
                         {.key = "ks", .type = TL_VALUE_NUMBER, .number = ks},
                         {.key = "friction", .type = TL_VALUE_NUMBER, .number = friction}};
    tl_args args = {values, friction < 0 ? 2 : 3};
    scene_ok(m, tl_joint_law(m, "*", law, &args));
}

/* Moves a body by hand, as a step would have: its odometer runs. */
SCENE_UNUSED static void scene_move(tl_model *m, uint32_t body, tl_vec3 by, tl_vec3 rotation)
{
    tl_bodies *b = &m->bodies;
    double angle = tl_v3_norm(rotation);
    b->pose[body].u = tl_v3_add(b->pose[body].u, by);
    if (angle > 0) {
        b->q[body] = tl_q_unit(tl_q_mul(scene_turn(rotation, angle), b->q[body]));
        b->pose[body].r = tl_q_matrix(b->q[body]);
    }
    b->odometer[body] += tl_v3_norm(by) + angle * b->radius[body];
}

/* Puts a body at a place and attitude, with the motion from where it was on the odometer. */
SCENE_UNUSED static void scene_put(tl_model *m, uint32_t body, tl_vec3 u, tl_quat q)
{
    tl_bodies *b = &m->bodies;
    tl_quat d = tl_q_mul(q, tl_q_conj(b->q[body]));
    double angle = 2 * asin(fmin(1, tl_v3_norm(tl_v3(d.x, d.y, d.z))));
    b->odometer[body] += tl_v3_norm(tl_v3_sub(u, b->pose[body].u)) + angle * b->radius[body];
    b->pose[body].u = u;
    b->q[body] = q;
    b->pose[body].r = tl_q_matrix(q);
}

/* Contacts and their forces in the present place; nothing moves. With m->dt > 0 the bodies' velocities
 * count as the motion since the last call. */
SCENE_UNUSED static void scene_forces(tl_model *m)
{
    tl_status status = tl_cycle_prepare(m);
    if (status == TL_OK)
        status = tl_undo_begin(m);
    if (status == TL_OK)
        status = tl_detect_update(m);
    if (status == TL_OK)
        status = tl_laws_check(m);
    if (status == TL_OK)
        status = tl_contacts_act.apply(m);
    if (scene_ok(m, status) && CHECK(tl_gather_prepare(m)))
        tl_gather(m);
}

/* Row of the contact of two block rows, or TL_NO_ROW. */
SCENE_UNUSED static uint32_t scene_contact(const tl_model *m, uint32_t a, uint32_t b)
{
    const tl_contacts *c = &m->detect->contacts;
    for (uint32_t i = 0; i < c->table.rows; i++)
        if (c->a[i] == a && c->b[i] == b)
            return i;
    return TL_NO_ROW;
}

/* Force on the second block of a pair, zero without a contact. */
SCENE_UNUSED static tl_vec3 scene_force(const tl_model *m, uint32_t a, uint32_t b)
{
    uint32_t c = scene_contact(m, a, b);
    return c == TL_NO_ROW ? tl_v3(0, 0, 0) : m->detect->contacts.force[c];
}

SCENE_UNUSED static double scene_apart(tl_vec3 a, tl_vec3 b)
{
    return tl_v3_norm(tl_v3_sub(a, b));
}

/* The smallest gap of a contact's points when forces were last computed. */
static inline double scene_gap(const tl_model *m, uint32_t contact)
{
    tl_vec3 normal, point;
    double gap;
    tl_contact_summary(m, contact, &normal, &point, &gap);
    return gap;
}

/* From A's body's centroid to a point of contact 0, axes of the model, in the present place. */
static inline tl_vec3 scene_arm(const tl_model *m, size_t point)
{
    const tl_point_lanes *lanes = &m->detect->lanes[0];
    tl_contact_places(m, 0, lanes);
    return tl_columns_get(lanes->arm, (point - m->detect->contacts.point_start[0]) / TL_LANES);
}

/* Cuts all visible blocks by the plane through a point, the next one of its joint set. */
SCENE_UNUSED static void scene_cut(tl_model *m, const char *joint, tl_vec3 normal, tl_vec3 point)
{
    tl_stage stage;
    scene_ok(m, stage_begin(m, &stage));
    uint32_t number = tl_joint_intern(m, joint);
    tl_tag tag = {number, ++m->joints[number - 1].planes};
    scene_ok(m, stage_cut(&stage, tl_v3_unit(normal), point, tag, 1));
    scene_ok(m, tl_stage_commit(&stage));
}

#endif
