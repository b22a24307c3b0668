/* test_contact_kind.c - kinds of contact come from a table: a third one, pads between cubes that are 1 m wide, is found, followed, summed,
 * bounded, shown and saved as patches and field contacts are. All of it is this file, and a line in a table. */
#include "contact/kinds.h"
#include "contact/transfer.h"
#include "contact_scene.h"
#include "detect/kinds.h"
#include "narrow/manifold.h"
#include "query/contact_polygons.h"

#include <talus/defaults.h>
#include <talus/state.h>

enum { PAD = TL_FACET_KINDS, KINDS };
static const double AREA = 0.25, KN = 1e7, G = 10;
static uint64_t note; /* that pads keep */
static int shown;     /* times that one was */

/* ---------------------------------------------------------------- the kind --------------- */

static void hash(tl_hash *to, const tl_detect *d, uint32_t c)
{
    tl_patch_place.hash(to, d, c);
    tl_hash_word(to, note);
}

static bool show(tl_model *m, uint32_t c, const tl_pair_view *view, tl_narrow_scratch *scratch, tl_surface *surface)
{
    shown++;
    return tl_patch_place.show(m, c, view, scratch, surface);
}

static bool claims(const tl_model *m, uint32_t a, uint32_t b)
{
    return m->blocks.shape[a]->face_count == 6 && m->blocks.shape[b]->face_count == 6;
}

/* The face of a cube that looks up or down. */
static uint32_t face_along(const tl_poly *shape, double z)
{
    uint32_t face = 0;
    while (shape->plane[face].normal.z * z < 0.9)
        face++;
    return face;
}

/* One point in the middle of the top of A, under the cube B. */
static bool find(const tl_model *m, const tl_pair_view *view, tl_narrow_scratch *scratch)
{
    (void)m;
    tl_manifold *g = &scratch->manifold;
    if (!tl_manifold_reserve(g, 1))
        return false;
    uint16_t ia = (uint16_t)face_along(view->a, 1), ib = (uint16_t)face_along(view->b, -1);
    const tl_plane *pa = &view->a->plane[ia], *pb = &view->b->plane[ib];
    g->facet = (tl_facet){.kind = PAD,
                          .na = pa->normal,
                          .nb = pb->normal,
                          .offset = pa->offset + pb->offset,
                          .laid = {view->turn, view->shift},
                          .ia = ia,
                          .ib = ib};
    g->point_count = 1;
    g->points[0] = (tl_contact_point){.p = tl_v3(0, 0, pa->offset), .area = AREA};
    return true;
}

static bool take(tl_model *m, uint32_t c, bool same, tl_narrow_scratch *scratch, const tl_point_lanes *lanes)
{
    (void)same;
    return tl_contact_transfer(m, c, scratch, lanes);
}

static tl_kind_place place;
static tl_kind_force force;
static const tl_kind_make make = {.claims = claims, .find = find, .take = take};
static const tl_contact_kind pad = {.name = "pad", .place = &place, .force = &force, .make = &make};
static const tl_contact_kind *kinds[KINDS];

static void know_pads(tl_model *m)
{
    place = tl_patch_place;
    place.hash = hash;
    place.show = show;
    force = tl_patch_force;
    force.cells = false;
    memcpy(kinds, tl_contact_kinds, sizeof tl_contact_kinds);
    kinds[PAD] = &pad;
    scene_ok(m, tl_detect_update(m));
    m->detect->kinds = kinds;
    m->detect->kind_count = KINDS;
}

/* ---------------------------------------------------------------- what becomes of it ----- */

/* A cube that stands on another, come to rest. */
static tl_model *resting(bool on_pads)
{
    tl_model *m = scene_model(2);
    tl_solve_result result;
    CHECK_INT(tl_model_set_gravity(m, tl_v3(0, 0, -G)), TL_OK);
    if (on_pads) /* before there are blocks */
        know_pads(m);
    scene_box(m, tl_v3(-0.5, -0.5, -1), tl_v3(0.5, 0.5, 0));
    scene_box(m, tl_v3(-0.5, -0.5, 0), tl_v3(0.5, 0.5, 1));
    const tl_id base = 1;
    scene_ok(m, tl_blocks_fix(m, &base, 1, TL_FIX_ALL));
    scene_law(m, "coulomb", KN, KN, 30);
    scene_ok(m, tl_model_damping(m, "local", &(tl_args){NULL, 0}));
    const tl_solve solve = tl_solve_default();
    scene_ok(m, tl_model_solve(m, &solve, &result));
    CHECK_INT(result.reason, TL_SOLVE_RATIO);
    return m;
}

TEST(a_cube_rests_on_its_pad)
{
    tl_model *m = resting(true);
    const tl_detect *d = m->detect;
    tl_energy energy, of_patch;
    uint32_t c = scene_contact(m, 0, 1);
    CHECK_INT(d->contacts.table.rows, 1);
    CHECK_INT(d->contacts.facet[c].kind, PAD);
    CHECK_INT(d->layout.spans[0].kind, PAD);
    CHECK_NEAR(d->contacts.area[c], AREA, 0);
    double weight = m->bodies.mass[1] * G;
    CHECK_REL(d->contacts.force[c].z, weight, 1e-4);
    CHECK_REL(scene_gap(m, c), -weight / (KN * AREA), 1e-4);
    scene_ok(m, tl_model_energy(m, &energy));
    CHECK_REL(energy.stored, 0.5 * weight * weight / (KN * AREA), 1e-3);
    tl_model_destroy(m);
    m = resting(false);
    scene_ok(m, tl_model_energy(m, &of_patch));
    CHECK_NEAR(energy.balance, of_patch.balance, 1e-3);
    tl_model_destroy(m);
}

TEST(what_it_keeps_is_state_and_what_it_is_is_shown)
{
    tl_model *m = resting(true);
    char before[33], after[33];
    scene_ok(m, tl_state_hash(m, before));
    note++;
    scene_ok(m, tl_state_hash(m, after));
    CHECK(strcmp(before, after) != 0);
    tl_contact_polygons polygons;
    const uint32_t row = scene_contact(m, 0, 1);
    scene_ok(m, tl_contact_polygons_find(m, &row, 1, &polygons));
    CHECK_INT(shown, 1);
    tl_contact_polygons_free(&polygons);
    tl_model_destroy(m);
}

/* A program that does not know it says so of a file that has one. */
TEST(a_file_with_one_is_read_where_it_is_known)
{
    tl_model *m = resting(true), *again = NULL;
    tl_error error;
    const char *path = "test_contact_kind.talus";
    scene_ok(m, tl_model_save(m, path));
    CHECK(tl_model_restore(path, 1, NULL, NULL, &again, &error) != TL_OK);
    CHECK_CONTAINS(error.text, "cannot restore");
    CHECK_INT(remove(path), 0);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(a_cube_rests_on_its_pad), RUN(what_it_keeps_is_state_and_what_it_is_is_shown),
          RUN(a_file_with_one_is_read_where_it_is_known))
