/* test_views.c - columns without a copy: they hold what the fields tell, and the structure tells when rows change. */
#include "check.h"
#include "values.h"

#include <stdlib.h>
#include <talus/views.h>
#include <talus/vmath.h>

static void create_box(tl_model *m, double x, double z)
{
    const double min[] = {x, 0, z}, max[] = {x + 1, 1, z + 1};
    const tl_value values[] = {vector("min", min), vector("max", max), number("density", 2000 + 100 * z)};
    tl_args args = {values, 3};
    tl_generate_summary summary;
    CHECK_INT(tl_generate(m, "box", &args, &summary), TL_OK);
}

/* Three stacked boxes far from zero, the lowest held. */
static tl_model *stack(void)
{
    tl_model_config config = tl_model_config_default();
    config.gravity = (tl_vec3){1, 0, -10};
    tl_model *m = NULL;
    tl_error error = {TL_OK, ""};
    tl_plugins_load_default();
    CHECK_INT(tl_model_create(&config, &m, &error), TL_OK);
    create_box(m, 1e6, 0);
    create_box(m, 1e6 + 0.3, 1);
    create_box(m, 1e6 + 0.6, 2);
    const tl_value law[] = {{.key = "kn", .type = TL_VALUE_NUMBER, .number = 1e8},
                            {.key = "ks", .type = TL_VALUE_NUMBER, .number = 1e8}};
    const tl_args args = {law, 2};
    CHECK_INT(tl_joint_law(m, "*", "elastic", &args), TL_OK);
    const tl_id base = 1;
    CHECK_INT(tl_blocks_fix(m, &base, 1, TL_FIX_ALL), TL_OK);
    return m;
}

static size_t field_index(const tl_field *fields, size_t count, const char *name)
{
    size_t i = 0;
    while (i < count && strcmp(fields[i].name, name) != 0)
        i++;
    CHECK(i < count);
    return i;
}

static void field_of(tl_model *m, tl_id block, const char *name, double out[6])
{
    size_t count;
    const tl_field *fields = tl_block_fields(&count);
    tl_field_value value;
    CHECK_INT(tl_block_field(m, block, field_index(fields, count, name), &value), TL_OK);
    memcpy(out, value.number, sizeof value.number);
}

/* Row by row a view of bodies of one block each is the field of that block. */
static void compare(tl_model *m, tl_view v, const tl_block_views *blocks, const char *name)
{
    for (size_t i = 0; i < blocks->id.count; i++) {
        double value[6];
        field_of(m, blocks->id.data[i], name, value);
        for (size_t k = 0; k < v.width; k++)
            CHECK_NEAR(v.data[v.stride * blocks->body.data[i] + k], value[k], 0);
    }
}

TEST(views_are_the_fields)
{
    tl_model *m = stack();
    tl_solve_result result;
    CHECK_INT(tl_model_cycle(m, 40, &result), TL_OK);
    tl_block_views blocks = tl_view_blocks(m);
    tl_body_views bodies = tl_view_bodies(m);
    CHECK_INT(blocks.id.count, 3);
    CHECK_INT(bodies.id.count, 3);
    compare(m, bodies.displacement, &blocks, "displacement");
    compare(m, bodies.rotation, &blocks, "rotation");
    compare(m, bodies.velocity, &blocks, "velocity");
    compare(m, bodies.angular_velocity, &blocks, "angular_velocity");
    compare(m, bodies.force, &blocks, "force");
    compare(m, bodies.moment, &blocks, "moment");
    compare(m, bodies.mass, &blocks, "mass");
    for (size_t i = 0; i < 3; i++) {
        double value[6];
        field_of(m, blocks.id.data[i], "centroid", value);
        CHECK_NEAR(tl_view_place(&bodies, i).x, value[0], 1e-9);
        CHECK_NEAR(tl_view_place(&bodies, i).z, value[2], 1e-9);
        field_of(m, blocks.id.data[i], "volume", value);
        CHECK_NEAR(blocks.volume.data[blocks.volume.stride * i], value[0], 0);
        field_of(m, blocks.id.data[i], "density", value);
        CHECK_NEAR(blocks.density.data[i], value[0], 0);
    }
    CHECK(bodies.displacement.data[bodies.displacement.stride * 2 + 2] < 0);
    tl_model_destroy(m);
}

/* Forces of contacts add up with the weight to the unbalanced force. */
TEST(contact_forces_balance)
{
    tl_model *m = stack();
    tl_solve_result result;
    CHECK_INT(tl_model_cycle(m, 40, &result), TL_OK);
    tl_contact_views c;
    CHECK_INT(tl_view_contacts(m, &c), TL_OK);
    CHECK_INT(c.a.count, 2);
    tl_body_views bodies = tl_view_bodies(m);
    double sum[3][3] = {{0}};
    for (size_t i = 0; i < c.a.count; i++) {
        CHECK(c.a.data[i] < c.b.data[i]);
        CHECK(c.area.data[c.area.stride * i] > 0.4);
        for (size_t k = 0; k < 3; k++) {
            sum[c.b.data[i]][k] += c.force.data[c.force.stride * i + k];
            sum[c.a.data[i]][k] -= c.force.data[c.force.stride * i + k];
        }
    }
    for (size_t body = 1; body < 3; body++) {
        double mass = bodies.mass.data[body];
        const double weight[] = {mass, 0, -10 * mass};
        for (size_t k = 0; k < 3; k++)
            CHECK_NEAR(bodies.force.data[bodies.force.stride * body + k], sum[body][k] + weight[k], 1e-9 * mass);
    }
    tl_model_destroy(m);
}

/* Vertices of the mesh in the body's frame, brought to the body's place, are those of the mesh in place. */
TEST(meshes_move_with_their_bodies)
{
    tl_model *m = stack();
    tl_solve_result result;
    uint64_t before = tl_structure(m);
    tl_block_mesh first, local, placed;
    CHECK_INT(tl_block_mesh_local(m, 3, &first), TL_OK);
    CHECK_INT(tl_model_cycle(m, 60, &result), TL_OK);
    CHECK(tl_structure(m) == before);
    CHECK_INT(tl_block_mesh_local(m, 3, &local), TL_OK);
    CHECK_INT(tl_block_mesh_get(m, 3, &placed), TL_OK);
    tl_body_views bodies = tl_view_bodies(m);
    const double *q = bodies.rotation.data + 2 * bodies.rotation.stride;
    tl_mat3 r = tl_q_matrix((tl_quat){q[0], q[1], q[2], q[3]});
    CHECK(fabs(q[2]) > 1e-9);
    CHECK_INT(local.vertex_count, 8);
    for (size_t i = 0; i < local.vertex_count; i++) {
        CHECK_NEAR(local.vertices[i].x, first.vertices[i].x, 0);
        tl_vec3 at = tl_v3_add(tl_view_place(&bodies, 2), tl_m3_mul(&r, local.vertices[i]));
        CHECK_NEAR(tl_v3_norm(tl_v3_sub(at, placed.vertices[i])), 0, 1e-9);
    }
    for (size_t f = 0; f < local.face_count; f++)
        CHECK_NEAR(tl_v3_norm(tl_v3_sub(tl_m3_mul(&r, local.normals[f]), placed.normals[f])), 0, 1e-12);
    tl_block_mesh_free(&placed);
    CHECK_INT(tl_block_mesh_local(m, 99, &placed), TL_E_STALE);
    tl_block_mesh_free(&first);
    tl_block_mesh_free(&local);
    tl_model_destroy(m);
}

TEST(the_structure_tells_of_rows)
{
    tl_model *m = stack();
    uint64_t was = tl_structure(m);
    CHECK(tl_structure(m) == was);
    tl_solve_result result;
    CHECK_INT(tl_model_cycle(m, 5, &result), TL_OK);
    const tl_id top = 3, pair[] = {2, 3};
    tl_load load = tl_load_default();
    load.force = tl_v3(1, 0, 0);
    CHECK_INT(tl_blocks_load(m, &top, 1, &load), TL_OK);
    CHECK_INT(tl_blocks_hide(m, &top, 1, false), TL_OK);
    CHECK(tl_structure(m) == was);
    CHECK_INT(tl_blocks_load(m, &top, 1, &(tl_load){sizeof(tl_load), {0, 0, 0}, {0, 0, 0}, {NAN, NAN, NAN}}), TL_OK);
    CHECK_INT(tl_blocks_join(m, pair, 2), TL_OK);
    CHECK(tl_structure(m) != was);
    tl_block_views blocks = tl_view_blocks(m);
    CHECK_INT(blocks.body.data[1], blocks.body.data[2]);
    CHECK_INT(tl_view_bodies(m).id.count, 2);
    was = tl_structure(m);
    create_box(m, 1e6 + 5, 0);
    CHECK(tl_structure(m) != was);
    was = tl_structure(m);
    const tl_id last = 4;
    CHECK_INT(tl_blocks_delete(m, &last, 1), TL_OK);
    CHECK_INT(tl_view_blocks(m).id.count, 3);
    CHECK(tl_structure(m) != was);
    tl_model_destroy(m);
}

TEST(an_empty_model_has_empty_views)
{
    tl_model_config config = tl_model_config_default();
    tl_model *m = NULL;
    tl_error error = {TL_OK, ""};
    CHECK_INT(tl_model_create(&config, &m, &error), TL_OK);
    tl_contact_views contacts;
    CHECK_INT(tl_view_contacts(m, &contacts), TL_OK);
    CHECK_INT(contacts.a.count, 0);
    CHECK_INT(tl_view_blocks(m).id.count, 0);
    CHECK_INT(tl_view_bodies(m).displacement.count, 0);
    tl_model_destroy(m);
}

TEST_MAIN(RUN(views_are_the_fields), RUN(contact_forces_balance), RUN(meshes_move_with_their_bodies),
          RUN(the_structure_tells_of_rows), RUN(an_empty_model_has_empty_views))
