/* test_secants.c - the stiffness of a contact by its last motion: K s is the change of force that a step has shown, where
 * a block rocks on its edge, so that the first guess is wrong; K stays symmetric and positive; and a leap with it brings
 * a block that stands on springs to equilibrium at once. */
#include "../contact_scene.h"
#include "contact/places.h"
#include "cycle/cycle.h"
#include "cycle/cycle_data.h"
#include "cycle/prepare.h"
#include "cycle/secants.h"
#include "detect/detect.h"

#define KN 1e9 /* Pa/m */

/* A cube on a fixed plate, on which gravity pulls at some slant: from 1/3 on the joint opens at an edge. */
static tl_model *cube_at(double slant)
{
    tl_model *m = scene_model(1);
    m->config.gravity = tl_v3(9.81 * slant, 0, -9.81);
    scene_box(m, tl_v3(-3, -3, -1), tl_v3(4, 4, 0));
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_law(m, "coulomb", KN, 0.5 * KN, 60);
    tl_id base = m->blocks.id[0];
    scene_ok(m, tl_blocks_fix(m, &base, 1, TL_FIX_ALL));
    for (int i = 0; i < 40; i++)
        scene_ok(m, tl_step(m));
    return m;
}

/* Contact forces at the present places, which the last step's motion has led to. */
static void find_forces(tl_model *m)
{
    scene_ok(m, tl_cycle_prepare(m));
    scene_ok(m, tl_detect_update(m));
    const tl_contributor *contacts = m->cycle->contributor[0];
    if (contacts->prepare)
        scene_ok(m, contacts->prepare(m));
    scene_ok(m, contacts->apply(m));
}

/* The motion of B at the contact's place in the last step. */
static void way_of(const tl_model *m, const tl_secant *s, double way[6])
{
    const tl_contact_motion by = tl_contact_moved(m, 0);
    const tl_vec3 arm = tl_v3(s->arm_a[0], s->arm_a[1], s->arm_a[2]), v = tl_v3_add(by.way, tl_v3_cross(by.turn, arm));
    const double all[6] = {v.x, v.y, v.z, by.turn.x, by.turn.y, by.turn.z};
    memcpy(way, all, sizeof all);
}

/* What a secant says that a motion changes. */
static void times(const tl_secant *s, const double way[6], double out[6])
{
    for (int i = 0; i < 6; i++) {
        out[i] = 0;
        for (int j = 0; j < 6; j++)
            for (int k = 0; k < 6; k++)
                out[i] += s->root[i][k] * s->root[j][k] * way[j];
    }
}

static double dot6(const double a[6], const double b[6])
{
    double sum = 0;
    for (int i = 0; i < 6; i++)
        sum += a[i] * b[i];
    return sum;
}

static bool any_slips(const tl_model *m)
{
    const tl_contacts *c = &m->detect->contacts;
    bool any = false;
    for (size_t i = 0; i < c->point_count[0]; i++)
        any = any || (m->detect->points.flags[tl_point_row(c, 0, i)] & TL_POINT_SLIPPING);
    return any;
}

TEST(secants_have_the_change_of_force_of_the_last_step)
{
    int softer = 0, exact = 0, slipping = 0;
    for (int k = 0; k < 12; k++) {
        tl_model *m = cube_at(0.04 * k);
        CHECK(tl_secants_prepare(m));
        tl_secants_begin(m);
        const tl_secant before = m->cycle->secant[0];
        find_forces(m);
        tl_secants_follow(m);
        const tl_secant *s = &m->cycle->secant[0];
        double way[6], first[6], now[6], change[6], worst = 0, most = 0;
        way_of(m, s, way);
        times(&before, way, first);
        times(s, way, now);
        for (int i = 0; i < 6; i++) {
            change[i] = before.force[i] - s->force[i];
            worst = fmax(worst, fabs(now[i] - change[i]));
            most = fmax(most, fabs(change[i]));
        }
        CHECK(most > 0);
        const double keeps = any_slips(m) ? 1 : 0.1;
        slipping += keeps == 1;
        if (dot6(change, way) >= keeps * dot6(first, way)) {
            CHECK_NEAR(worst, 0, 1e-9 * most);
            exact++;
            softer += dot6(change, way) < 0.98 * dot6(first, way);
        } else { /* less than a tenth is not believed at once, nor less at all of what slips */
            CHECK_REL(dot6(now, way), keeps * dot6(first, way), 1e-9);
        }
        tl_model_destroy(m);
    }
    CHECK(exact >= 5);
    CHECK(slipping >= 1);
    CHECK(softer >= 1); /* or the first guess would have done */
}

TEST(a_leap_over_linear_contacts_is_the_way_to_equilibrium)
{
    tl_model *m = cube_at(0);
    CHECK(tl_secants_prepare(m));
    tl_secants_begin(m);
    tl_leap_find(m, m->dt, 1e-12);
    const double *x = m->cycle->leap[1].motion;
    const double weight = m->bodies.mass[1] * 9.81, borne = m->detect->contacts.force[0].z;
    CHECK_NEAR(x[2], (borne - weight) / KN, 1e-6 * weight / KN); /* 1 m2 */
    for (int i = 0; i < 6; i++) {
        CHECK(i == 2 || fabs(x[i]) < 1e-9 * weight / KN);
        CHECK(m->cycle->leap[0].motion[i] == 0); /* the plate is held */
    }
    tl_model_destroy(m);
}

TEST_MAIN(RUN(secants_have_the_change_of_force_of_the_last_step),
          RUN(a_leap_over_linear_contacts_is_the_way_to_equilibrium))
