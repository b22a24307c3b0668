/* mesh_properties.c - the mesh of a pressure field with borders: made at one place, it tells the integrals at others. */
#include "field_scene.h"
#include "narrow/field.h"
#include "narrow/field_mesh.h"

/* Whether two vectors are the same within a length. */
static bool agree(tl_vec3 one, tl_vec3 other, double within)
{
    return scene_apart(one, other) <= within;
}

/* Whether all integrals are the same but for roundings. */
static bool same_sums(const tl_field_sums *one, const tl_field_sums *other, double length)
{
    const double tiny = 1e-9, volume = other->volume, overlap = 4 * other->energy / volume;
    const double force = tiny * (other->pressure + volume);
    const double area = tiny * (other->extent + pow(volume, 2.0 / 3));
    bool same = fabs(one->energy - other->energy) <= tiny * other->energy &&
                fabs(one->volume - other->volume) <= tiny * other->volume &&
                fabs(one->deepest - other->deepest) <= tiny * other->deepest;
    same = same && agree(one->force, other->force, force) && agree(one->moment, other->moment, force * length) &&
           agree(one->through, other->through, force) &&
           agree(one->through_moment, other->through_moment, force * length) && agree(one->swept, other->swept, area) &&
           agree(one->swept_moment, other->swept_moment, area * length) && agree(one->area, other->area, area) &&
           agree(one->pressed, other->pressed, force * length);
    for (int k = 0; k < TL_FIELD_POWERS; k++) {
        const tl_field_power *p = &one->powers[k], *q = &other->powers[k];
        double scale = force * pow(2 * overlap, k + 1);
        same = same && fabs(p->whole - q->whole) <= tiny * q->whole + 1e-300 && agree(p->force, q->force, scale) &&
               agree(p->moment, q->moment, scale * length);
    }
    return same;
}

/* Faces of both blocks chosen at random are borders, some of them seams. */
static void choose_borders(scene *s, uint64_t *seed)
{
    s->borders = true;
    s->power = 2;
    for (int i = 0; i < 256; i++) {
        s->border_a[i] = check_random(seed) < 0.3;
        s->border_b[i] = check_random(seed) < 0.3;
    }
}

static void list_with_seams(scene *s, tl_field_mesh *mesh, const tl_mesh_inner *inner)
{
    tl_field_faces *f = &s->planes.faces;
    list_scene(s);
    f->seam_a = f->border_a / 2;
    f->seam_b = (f->border_b + 1) / 2;
    f->mesh = mesh;
    f->inner = inner;
    f->seamed = true;
}

/* Of blocks with borders the mesh of one place tells all integrals at another, or does not stand there. */
TEST(a_mesh_with_borders_is_all_of_the_field)
{
    const tl_mesh_inner inner = {0};
    int meshes = 0, cases = 0, stand = 0;
    for (uint64_t k = 1; k <= (uint64_t)check_cases(2000); k++) {
        uint64_t seed = k + 31000;
        tl_field_mesh mesh = {0};
        static scene s;
        double depth = pow(10, scene_between(&seed, -4, -0.5));
        make_scene(&s, random_kind(&seed) % 5, random_kind(&seed) % 5, depth, k % 8 == 0, &seed);
        choose_borders(&s, &seed);
        list_with_seams(&s, &mesh, &inner);
        tl_field_sums made, all, found;
        CHECK(field_integrate(&s.planes.faces, &s.pair.scratch.field, &made));
        cases += made.deepest > 0;
        meshes += mesh.polygons > 0;
        for (int step = 0; step < 5 && mesh.polygons > 0; step++) {
            double way = pow(10, scene_between(&seed, -6, -0.5)) * made.deepest;
            if (step > 0) { /* at first it stays */
                s.pair.shift = tl_v3_madd(s.pair.shift, way, scene_direction(&seed));
                s.pair.turn = tl_q_mul(scene_turn(scene_direction(&seed), way), s.pair.turn);
            }
            list_with_seams(&s, &mesh, &inner);
            bool stands = tl_mesh_integrate(&s.planes.faces, &found);
            s.planes.faces.mesh = NULL;
            CHECK(field_integrate(&s.planes.faces, &s.pair.scratch.field, &all));
            if (!stands)
                continue;
            stand++;
            if (all.volume > 1e-9 * pow(s.pair.view.size * depth, 3))
                CHECK(same_sums(&found, &all, s.pair.view.size));
        }
        free_scene(&s);
    }
    printf("  %d cases, %d meshes, which stand at %d places\n", cases, meshes, stand);
    CHECK(meshes > check_least(1500) && stand > 2 * meshes);
}

TEST_MAIN(RUN(a_mesh_with_borders_is_all_of_the_field))
