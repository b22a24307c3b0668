/* test_contact.c - the life of contacts: birth before touching, death after parting but never in tension,
 * ids that stay, the joint they belong to, the same bits every time and on any number of threads, and
 * reused geometry that agrees with geometry made anew in every step. */
#include "contact/contacts.h"
#include "contact/pair_view.h"
#include "contact_scene.h"
#include "model/rows.h"

#define KN 1e9
#define PILE_KN 3e8

/* ---------------------------------------------------------------- birth and death -------- */

static tl_model *two_cubes(const char *law, double gap)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 1));
    scene_box(m, tl_v3(0, 0, 1 + gap), tl_v3(1, 1, 2 + gap));
    scene_law(m, law, KN, KN, strcmp(law, "elastic") == 0 ? -1 : 30);
    return m;
}

/* Born below the tolerance, before touching and without force; dies beyond 1.5 times the tolerance. */
TEST(contact_is_born_before_touching_and_dies_after)
{
    double tolerance = TL_CONTACT_TOLERANCE, step = 1e-5;
    tl_model *m = two_cubes("coulomb", 3 * tolerance);
    int born = 0, died = 0;
    for (double gap = 3 * tolerance; gap > -1e-4; gap -= step) {
        scene_put(m, 1, tl_v3(0, 0, gap - 3 * tolerance), tl_q_identity());
        scene_forces(m);
        uint32_t c = scene_contact(m, 0, 1);
        if (fabs(gap - tolerance) > step)
            CHECK_INT(c != TL_NO_ROW, gap < tolerance);
        if (c != TL_NO_ROW) {
            CHECK_NEAR(scene_gap(m, c), gap, 1e-12);
            double overlap = gap < 0 ? -gap : 0;
            CHECK_NEAR(scene_force(m, 0, 1).z, KN * overlap, 1e-3);
            born = 1;
        }
    }
    for (double gap = -1e-4; gap < 3 * tolerance; gap += step) {
        scene_put(m, 1, tl_v3(0, 0, gap - 3 * tolerance), tl_q_identity());
        scene_forces(m);
        uint32_t c = scene_contact(m, 0, 1);
        if (fabs(gap - 1.5 * tolerance) > step)
            CHECK_INT(c != TL_NO_ROW, gap < 1.5 * tolerance);
        died = c == TL_NO_ROW;
    }
    CHECK(born && died);
    tl_model_destroy(m);
}

/* However fast it comes: a step that jumps from afar into the other block finds it. */
TEST(fast_block_is_found)
{
    tl_model *m = two_cubes("coulomb", 5);
    scene_forces(m);
    CHECK_INT(m->detect->contacts.table.rows, 0);
    scene_move(m, 1, tl_v3(0.2, 0, -5 - 1e-4), tl_v3(0, 0, 0));
    scene_forces(m);
    CHECK_REL(scene_force(m, 0, 1).z, KN * 0.8 * 1e-4, 1e-9);
    tl_model_destroy(m);
}

/* An elastic joint pulled apart holds on far beyond the tolerance, and pulls. */
TEST(contact_in_tension_does_not_die)
{
    tl_model *m = two_cubes("elastic", 0);
    scene_forces(m);
    m->cycles++;
    for (int i = 1; i <= 200; i++) {
        scene_put(m, 1, tl_v3(0, 0, 1e-4 * i), tl_q_identity());
        scene_forces(m);
        if (!CHECK_INT(m->detect->contacts.table.rows, 1))
            break;
        CHECK_REL(scene_force(m, 0, 1).z, -KN * 1e-4 * i, 1e-9);
        CHECK_INT(m->detect->contacts.born[0], 0);
    }
    /* and back again: the same path */
    scene_put(m, 1, tl_v3(0, 0, -1e-5), tl_q_identity());
    scene_forces(m);
    CHECK_REL(scene_force(m, 0, 1).z, KN * 1e-5, 1e-9);
    tl_model_destroy(m);
}

/* A coulomb contact opens; within the tolerances it goes on, and when the blocks have parted and meet again it is
 * another one. */
TEST(contacts_go_on_until_their_blocks_part)
{
    tl_model *m = two_cubes("coulomb", -1e-4);
    scene_box(m, tl_v3(5, 0, 0), tl_v3(6, 1, 1));
    scene_box(m, tl_v3(5, 0, 1), tl_v3(6, 1, 2));
    scene_forces(m);
    m->cycles++;
    for (int i = 0; i < 20; i++) { /* wobble, so that the polygon changes all the time */
        scene_put(m, 1, tl_v3(1e-3 * (i % 3), 0, 5e-4), scene_turn(tl_v3(0, 0, 1), 0.02 * i));
        scene_forces(m);
        uint32_t c = scene_contact(m, 0, 1);
        if (CHECK(c != TL_NO_ROW))
            CHECK_INT(m->detect->contacts.born[c], 0);
    }
    scene_put(m, 1, tl_v3(0, 0, 0.1), tl_q_identity());
    scene_forces(m);
    CHECK_INT(scene_contact(m, 0, 1), TL_NO_ROW);
    scene_put(m, 1, tl_v3(0, 0, 0), tl_q_identity());
    scene_forces(m);
    uint32_t c = scene_contact(m, 0, 1);
    if (CHECK(c != TL_NO_ROW))
        CHECK_INT(m->detect->contacts.born[c], 1);
    CHECK_INT(m->detect->contacts.born[scene_contact(m, 2, 3)], 0);
    tl_model_destroy(m);
}

/* Deleting and creating blocks leaves the contacts of the others as they are. */
TEST(contacts_survive_changes_of_other_blocks)
{
    tl_model *m = scene_model(1);
    for (int i = 0; i < 6; i++)
        scene_box(m, tl_v3(0, 0, i * (1 - 1e-4)), tl_v3(1, 1, i * (1 - 1e-4) + 1));
    scene_law(m, "coulomb", KN, KN, 30);
    scene_forces(m);
    CHECK_INT(m->detect->contacts.table.rows, 5);
    m->cycles++;
    tl_id gone = m->blocks.id[1];
    scene_ok(m, tl_blocks_delete(m, &gone, 1));
    scene_box(m, tl_v3(3, 0, 0), tl_v3(4, 1, 1));
    scene_forces(m);
    CHECK_INT(m->detect->contacts.table.rows, 3);
    uint32_t c = scene_contact(m, 3, 4);
    if (CHECK(c != TL_NO_ROW)) {
        CHECK_INT(m->detect->contacts.born[c], 0);
        CHECK_REL(scene_force(m, 3, 4).z, KN * 1e-4, 1e-8);
    }
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- joints ----------------- */

static const char *joint_between(tl_model *m, uint32_t a, uint32_t b)
{
    uint32_t c = scene_contact(m, a, b);
    return c == TL_NO_ROW ? "no contact" : tl_tag_name(m, m->detect->contacts.tag[c]);
}

/* Cuts give their joint; blocks made apart have none; a face without a joint on one with: the joint. */
TEST(contact_takes_the_joint_of_the_touching_faces)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 2));
    scene_cut(m, "bed", tl_v3(0, 0, 1), tl_v3(0, 0, 1));
    scene_cut(m, "bed", tl_v3(0, 0, 1), tl_v3(0, 0, 1.5));
    scene_box(m, tl_v3(0, 0, 2), tl_v3(1, 1, 3));  /* on the uncut top: nothing */
    scene_box(m, tl_v3(0, 0, -1), tl_v3(1, 1, 0)); /* below the uncut bottom */
    scene_law(m, "coulomb", KN, KN, 30);
    scene_forces(m);
    CHECK_INT(m->detect->contacts.table.rows, 4);
    /* rows: blocks 0, 1, 2 are the cut ones, of ascending id */
    int bed1 = 0, bed2 = 0, nothing = 0;
    for (uint32_t c = 0; c < m->detect->contacts.table.rows; c++) {
        const char *name = tl_tag_name(m, m->detect->contacts.tag[c]);
        bed1 += strcmp(name, "bed:1") == 0;
        bed2 += strcmp(name, "bed:2") == 0;
        nothing += *name == 0;
    }
    CHECK_INT(bed1, 1);
    CHECK_INT(bed2, 1);
    CHECK_INT(nothing, 2);
    tl_model_destroy(m);
    /* a block made on a cut face takes the cut's joint */
    m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 2));
    scene_cut(m, "fault", tl_v3(0, 0, 1), tl_v3(0, 0, 1));
    uint32_t top = tl_block_centroid(m, 0).z > 1 ? 0U : 1U;
    tl_id id = m->blocks.id[top];
    scene_ok(m, tl_blocks_delete(m, &id, 1));
    scene_box(m, tl_v3(0.2, 0.2, 1), tl_v3(0.8, 0.8, 2));
    scene_law(m, "coulomb", KN, KN, 30);
    scene_forces(m);
    CHECK_TEXT(joint_between(m, 0, 1), "fault:1");
    tl_model_destroy(m);
}

/* Two different joints on flush faces: the one created first, whichever block it is on. One plane of each
 * joint cuts one box, and one half of each box is set against the other's. */
TEST(of_two_joints_the_older_one_rules)
{
    for (int order = 0; order < 2; order++) {
        tl_model *m = scene_model(1);
        scene_box(m, tl_v3(0, 0, 0), tl_v3(1, 1, 2));
        scene_box(m, tl_v3(5, 0, 3), tl_v3(6, 1, 5));
        scene_cut(m, "older", tl_v3(0, 0, 1), tl_v3(0, 0, order ? 4 : 1));
        scene_cut(m, "younger", tl_v3(0, 0, 1), tl_v3(0, 0, order ? 1 : 4));
        scene_law(m, "coulomb", KN, KN, 30);
        /* the lower half of the first box below the upper half of the second */
        tl_id gone[2];
        size_t count = 0;
        for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
            double z = tl_block_centroid(m, row).z;
            if ((z > 1 && z < 2) || (z > 3 && z < 4))
                gone[count++] = m->blocks.id[row];
        }
        CHECK_INT(count, 2);
        scene_ok(m, tl_blocks_delete(m, gone, count));
        tl_rows_tidy(m);
        uint32_t upper = tl_block_centroid(m, 0).z > 3 ? 0U : 1U;
        scene_put(m, m->blocks.body[upper], tl_v3(-5, 0, -3), tl_q_identity());
        scene_forces(m);
        CHECK_TEXT(joint_between(m, 0, 1), "older:1");
        tl_model_destroy(m);
    }
}

/* ---------------------------------------------------------------- piles ------------------ */

/* A pile of hulls and boxes over a floor, above each other with gaps, so that it falls together. */
static tl_model *pile(int64_t threads, int reuse)
{
    tl_model *m = scene_model(threads);
    m->config.reuse_geometry = reuse;
    scene_box(m, tl_v3(-4, -4, -1), tl_v3(4, 4, 0));
    uint64_t seed = 12;
    for (int i = 0; i < 60; i++) {
        tl_vec3 place = {1.16 * (i % 4) - 1.74, 1.16 * (i / 4 % 4) - 1.74, 0.505 + 1.005 * (i / 16)};
        tl_poly *shape = i % 3 ? scene_random_hull(&seed, 12, tl_v3(0.5, 0.5, 0.5)) : scene_box_shape(1, 1, 1);
        tl_quat turn = i % 3 ? scene_any_turn(&seed) : scene_turn(tl_v3(0, 0, 1), 0.02 * i);
        scene_block(m, shape, turn, place);
    }
    scene_law(m, "coulomb", PILE_KN, PILE_KN, 30);
    tl_id floor = m->blocks.id[0];
    scene_ok(m, tl_blocks_fix(m, &floor, 1, TL_FIX_ALL));
    scene_ok(m, tl_model_set_gravity(m, tl_v3(1, 0.5, -10)));
    tl_args nothing = {NULL, 0};
    scene_ok(m, tl_model_damping(m, "local", &nothing));
    return m;
}

static void run(tl_model *m, int64_t cycles)
{
    tl_solve_result result;
    scene_ok(m, tl_model_cycle(m, cycles, &result));
}

TEST(same_bits_twice_and_on_two_threads)
{
    char hash[3][33];
    size_t contacts = 0;
    for (int i = 0; i < 3; i++) {
        tl_model *m = pile(i == 2 ? 2 : 1, 1);
        run(m, 2500);
        scene_ok(m, tl_state_hash(m, hash[i]));
        contacts = m->detect->contacts.table.rows;
        tl_model_destroy(m);
    }
    CHECK(contacts > 30);
    CHECK_TEXT(hash[1], hash[0]);
    CHECK_TEXT(hash[2], hash[0]);
}

static double normal_force(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    double force = 0;
    for (uint32_t k = 0; k < contacts->point_count[c]; k++)
        force += m->detect->points.f_n[tl_point_row(contacts, c, k)];
    return force;
}

/* Contacts in the present place, without motion: closures alone count. */
static void look_again(tl_model *m, int reuse)
{
    double dt = m->dt;
    m->dt = 0;
    m->config.reuse_geometry = reuse;
    scene_forces(m);
    m->dt = dt;
    m->config.reuse_geometry = 1;
}

/* Another model, with the bodies at the same places, that has never seen another place. */
static tl_model *twin(const tl_model *m)
{
    tl_model *fresh = pile(1, 0);
    for (uint32_t b = 0; b < m->bodies.table.rows; b++) {
        scene_put(fresh, b, m->bodies.pose[b].u, m->bodies.q[b]);
        fresh->bodies.pose[b].r = m->bodies.pose[b].r;
    }
    return fresh;
}

static double largest_force(const tl_model *m)
{
    double most = 0;
    for (uint32_t c = 0; c < m->detect->contacts.table.rows; c++)
        most = fmax(most, normal_force(m, c));
    return most;
}

/* What of a difference of forces is beyond what a motion of 1e-6 of the size (within which areas are
 * reused) may change the area: that times the polygon's perimeter, about 8 roots of its area. */
static double beyond_reuse(const tl_model *m, uint32_t row, double difference)
{
    double area = m->detect->contacts.area[row];
    return difference - PILE_KN * fabs(scene_gap(m, row)) * 8 * sqrt(area) * 1e-6;
}

/* A settling pile with births and deaths. Reused geometry gives the forces of geometry made anew, where a patch is not found
 * to be a field contact by now, or the other way round. A twin without history finds the same closed contacts, and the same
 * forces where they are of the same kind: a field contact of the pile becomes a patch later than one is born. */
TEST(reused_geometry_agrees_with_new_geometry)
{
    tl_model *m = pile(1, 1);
    double worst = 0, worst_twin = 0;
    int compared = 0, alike = 0, followed = 0, kept = 0;
    for (int round = 0; round < 40; round++) {
        run(m, 250);
        double reused[1024];
        uint32_t before[1024];
        look_again(m, 1);
        const tl_contacts *c = &m->detect->contacts;
        size_t rows = c->table.rows;
        for (uint32_t row = 0; row < rows; row++) {
            reused[row] = normal_force(m, row);
            before[row] = c->facet[row].kind;
        }
        for (uint32_t row = 0; row < rows; row++)
            /* and the kind and the faces, too */
            m->detect->contacts.faces_valid_to[row] = -INFINITY;
        look_again(m, 0);
        if (!CHECK_INT(c->table.rows, rows))
            continue;
        tl_model *fresh = twin(m);
        look_again(fresh, 0);
        double scale = largest_force(m);
        for (uint32_t row = 0; row < rows; row++) {
            double force = normal_force(m, row);
            followed++;
            if (before[row] == c->facet[row].kind) {
                kept++;
                worst = fmax(worst, beyond_reuse(m, row, fabs(reused[row] - force)) / scale);
            }
            uint32_t other = scene_contact(fresh, c->a[row], c->b[row]);
            if (scene_gap(m, row) >= 0 || !CHECK(other != TL_NO_ROW))
                continue;
            compared++;
            if (c->facet[row].kind != fresh->detect->contacts.facet[other].kind)
                continue;
            alike++;
            worst_twin = fmax(worst_twin, fabs(normal_force(fresh, other) - force) / scale);
        }
        const tl_contacts *f = &fresh->detect->contacts;
        for (uint32_t row = 0; row < f->table.rows; row++)
            if (scene_gap(fresh, row) < 0)
                CHECK(scene_contact(m, f->a[row], f->b[row]) != TL_NO_ROW);
        tl_model_destroy(fresh);
    }
    unsigned later = 0;
    for (uint32_t c = 0; c < m->detect->contacts.table.rows; c++)
        later += m->detect->contacts.born[c] > 0;
    CHECK(compared > 1000);
    CHECK(alike > 0.9 * compared);
    CHECK(kept > 0.99 * followed);
    CHECK(later > 10); /* some began on the way */
    CHECK(worst <= 1e-5);
    CHECK(worst_twin <= 1e-5);
    if (getenv("TALUS_TEST_VERBOSE"))
        printf("  compared %d (%d), %u later, worst %.3g, of the twin %.3g\n", compared, alike, later, worst,
               worst_twin);
    tl_model_destroy(m);
}

/* No force changes while nothing moves, bit for bit. Without slip, whose flag tells of the last motion; and the forces of
 * points that have opened are -0 until they are turned for the first time. */
TEST(asking_again_changes_nothing)
{
    tl_model *m = pile(1, 1);
    scene_law(m, "coulomb", PILE_KN, PILE_KN, 89);
    run(m, 800);
    m->dt = 0;
    scene_forces(m);
    scene_forces(m);
    char before[33], after[33];
    scene_ok(m, tl_state_hash(m, before));
    for (int i = 0; i < 3; i++)
        scene_forces(m);
    scene_ok(m, tl_state_hash(m, after));
    CHECK_TEXT(after, before);
    tl_model_destroy(m);
}

/* Contacts of which there is something to be asked: others are near only. */
static size_t with_points(const tl_model *m)
{
    size_t count = 0;
    for (uint32_t c = 0; c < m->detect->contacts.table.rows; c++)
        count += m->detect->contacts.point_count[c] > 0;
    return count;
}

/* Runs a pile in which blocks are deleted and made on the way; with `ask` contacts are asked for after
 * every change. */
static void run_changing(int ask, char *hash)
{
    tl_model *m = pile(1, 1);
    for (int round = 0; round < 12; round++) {
        run(m, 150);
        tl_id gone = m->blocks.id[1 + (size_t)round * 3];
        scene_ok(m, tl_blocks_delete(m, &gone, 1));
        if (round % 3 == 0) {
            double x = 0.9 * round - 5;
            scene_box(m, tl_v3(x, 3, 4e-4), tl_v3(x + 0.8, 3.8, 0.8));
        }
        tl_contact_filter all = {.size = sizeof(tl_contact_filter), .joint = NULL};
        tl_contact_name *names = NULL;
        size_t count = 0;
        for (int again = 0; again < 2 && ask; again++) {
            scene_ok(m, tl_contacts_select(m, &all, &names, &count));
            CHECK_INT(count, with_points(m));
            free(names);
        }
    }
    run(m, 10);
    scene_ok(m, tl_state_hash(m, hash));
    tl_model_destroy(m);
}

TEST(queries_between_changes_do_not_change_results)
{
    char asked[33], quiet[33];
    run_changing(1, asked);
    run_changing(0, quiet);
    CHECK_TEXT(asked, quiet);
}

/* Old points are read when the new ones take their place. */
TEST(growing_contacts_have_room_for_what_they_had)
{
    for (int grown = 0; grown < 4; grown++) {
        tl_model *m = two_cubes("coulomb", -1e-4);
        scene_forces(m);
        tl_contacts *c = &m->detect->contacts;
        uint32_t points = c->point_count[0];
        CHECK(points > 1);
        bool fewer = grown & 1;
        c->pending[0] = TL_PENDING_GROW;
        m->detect->pairs[c->pair[0]].want_points = (uint16_t)(fewer ? 1 : points + 8);
        if (grown & 2)
            CHECK_INT(tl_contacts_repack(m), TL_OK);
        else
            CHECK(tl_contacts_place(m->detect, m->cycles));
        CHECK(c->point_capacity[0] >= (fewer ? points : points + 8));
        CHECK_INT(c->point_count[0], points);
        c->pending[0] = TL_PENDING_NONE;
        tl_model_destroy(m);
    }
}

TEST_MAIN(RUN(growing_contacts_have_room_for_what_they_had), RUN(contact_is_born_before_touching_and_dies_after),
          RUN(fast_block_is_found), RUN(contact_in_tension_does_not_die), RUN(contacts_go_on_until_their_blocks_part),
          RUN(contacts_survive_changes_of_other_blocks), RUN(contact_takes_the_joint_of_the_touching_faces),
          RUN(of_two_joints_the_older_one_rules), RUN(same_bits_twice_and_on_two_threads),
          RUN(reused_geometry_agrees_with_new_geometry), RUN(asking_again_changes_nothing),
          RUN(queries_between_changes_do_not_change_results))
