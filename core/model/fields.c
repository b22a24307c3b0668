/* fields.c - what can be asked of a block: its named fields and its shape in place. */
#include "model/model.h"
#include "model/regroup.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <talus/views.h>

enum {
    F_ID,
    F_GROUP,
    F_DENSITY,
    F_VOLUME,
    F_MASS,
    F_INERTIA,
    F_CENTROID,
    F_DISPLACEMENT,
    F_ROTATION,
    F_VELOCITY,
    F_ANGULAR_VELOCITY,
    F_FORCE,
    F_MOMENT,
    F_FIXED,
    F_HIDDEN,
    F_BODY,
    F_SPEED,
    F_KINETIC_ENERGY,
    F_COUNT
};

static const tl_field fields[F_COUNT] = {
    [F_ID] = {"id", TL_FIELD_COUNT, "", "number of the block, never used again"},
    [F_GROUP] = {"group", TL_FIELD_TEXT, "", "name of its group"},
    [F_DENSITY] = {"density", TL_FIELD_SCALAR, "kg/m3", "mass per volume"},
    [F_VOLUME] = {"volume", TL_FIELD_SCALAR, "m3", "volume of the block alone"},
    [F_MASS] = {"mass", TL_FIELD_SCALAR, "kg", "mass of the block alone"},
    [F_INERTIA] = {"inertia", TL_FIELD_SYM3, "kg m2",
                   "inertia of the block about its centroid, in the axes of the model"},
    [F_CENTROID] = {"centroid", TL_FIELD_VEC3, "m", "present place of the centroid"},
    [F_DISPLACEMENT] = {"displacement", TL_FIELD_VEC3, "m",
                        "of the centroid, since creation or reset_displacement"},
    [F_ROTATION] = {"rotation", TL_FIELD_QUAT, "", "unit quaternion w, x, y, z of its body"},
    [F_VELOCITY] = {"velocity", TL_FIELD_VEC3, "m/s", "of the centroid, half a step ago"},
    [F_ANGULAR_VELOCITY] = {"angular_velocity", TL_FIELD_VEC3, "rad/s", "of its body"},
    [F_FORCE] = {"force", TL_FIELD_VEC3, "N", "unbalanced force on its body"},
    [F_MOMENT] = {"moment", TL_FIELD_VEC3, "N m", "unbalanced moment about its body's centroid"},
    [F_FIXED] = {"fixed", TL_FIELD_BOOL, "", "whether its body is held in every component"},
    [F_HIDDEN] = {"hidden", TL_FIELD_BOOL, "", "hidden blocks are not cut"},
    [F_BODY] = {"body", TL_FIELD_COUNT, "", "id of its rigid body: the lowest id of its blocks"},
    [F_SPEED] = {"speed", TL_FIELD_SCALAR, "m/s", "length of the velocity"},
    [F_KINETIC_ENERGY] = {"kinetic_energy", TL_FIELD_SCALAR, "J", "of the block alone"},
};

const tl_field *tl_block_fields(size_t *count)
{
    *count = F_COUNT;
    return fields;
}

static void put_vector(tl_field_value *value, tl_vec3 v)
{
    value->number[0] = v.x;
    value->number[1] = v.y;
    value->number[2] = v.z;
}

static void put_tensor(tl_field_value *value, tl_sym3 t)
{
    const double n[6] = {t.xx, t.yy, t.zz, t.xy, t.yz, t.zx};
    memcpy(value->number, n, sizeof n);
}

static double kinetic_energy(const tl_model *m, uint32_t row)
{
    tl_vec3 w = m->bodies.w[m->blocks.body[row]];
    double mass = m->blocks.density[row] * m->blocks.volume[row];
    return 0.5 * mass * tl_v3_norm2(tl_block_velocity(m, row)) +
           0.5 * tl_v3_dot(w, tl_s3_mul(tl_block_inertia(m, row), w));
}

tl_status tl_block_field(tl_model *m, tl_id block, size_t index, tl_field_value *value)
{
    assert(index < F_COUNT);
    uint32_t row = tl_block_row(m, block);
    if (row == TL_NO_ROW)
        return m->error.status;
    const tl_blocks *b = &m->blocks;
    const tl_bodies *bodies = &m->bodies;
    uint32_t body = b->body[row];
    *value = (tl_field_value){{0}, NULL};
    switch (index) {
    case F_ID: value->number[0] = block; break;
    case F_GROUP: value->text = m->groups[b->group[row]]; break;
    case F_DENSITY: value->number[0] = b->density[row]; break;
    case F_VOLUME: value->number[0] = b->volume[row]; break;
    case F_MASS: value->number[0] = b->density[row] * b->volume[row]; break;
    case F_INERTIA: put_tensor(value, tl_block_inertia(m, row)); break;
    case F_CENTROID: put_vector(value, tl_block_centroid(m, row)); break;
    case F_DISPLACEMENT: put_vector(value, tl_block_displacement(m, row)); break;
    case F_ROTATION: {
        tl_quat q = bodies->q[body];
        const double n[4] = {q.w, q.x, q.y, q.z};
        memcpy(value->number, n, sizeof n);
        break;
    }
    case F_VELOCITY: put_vector(value, tl_block_velocity(m, row)); break;
    case F_ANGULAR_VELOCITY: put_vector(value, bodies->w[body]); break;
    case F_FORCE: put_vector(value, bodies->force[body]); break;
    case F_MOMENT: put_vector(value, bodies->moment[body]); break;
    case F_FIXED: value->number[0] = bodies->fixed[body] == TL_FIX_ALL; break;
    case F_HIDDEN: value->number[0] = b->hidden[row] != 0; break;
    case F_BODY: value->number[0] = bodies->id[body]; break;
    case F_SPEED: value->number[0] = tl_v3_norm(tl_block_velocity(m, row)); break;
    case F_KINETIC_ENERGY: value->number[0] = kinetic_energy(m, row); break;
    default: break;
    }
    return TL_OK;
}

/* The faces of a block's shape, and its vertices and normals in its body's frame. */
tl_status tl_block_mesh_local(tl_model *m, tl_id block, tl_block_mesh *mesh)
{
    *mesh = (tl_block_mesh){0};
    uint32_t row = tl_block_row(m, block);
    if (row == TL_NO_ROW)
        return m->error.status;
    const tl_poly *shape = m->blocks.shape[row];
    size_t corners = shape->start[shape->face_count];
    mesh->vertex_count = shape->vertex_count;
    mesh->face_count = shape->face_count;
    mesh->vertices = malloc(shape->vertex_count * sizeof *mesh->vertices);
    mesh->start = malloc((shape->face_count + 1u) * sizeof *mesh->start);
    mesh->loops = malloc(corners * sizeof *mesh->loops);
    mesh->tags = malloc(shape->face_count * sizeof *mesh->tags);
    mesh->normals = malloc(shape->face_count * sizeof *mesh->normals);
    if (!mesh->vertices || !mesh->start || !mesh->loops || !mesh->tags || !mesh->normals) {
        tl_block_mesh_free(mesh);
        return tl_fail_memory(&m->error);
    }
    memcpy(mesh->vertices, shape->vertex, shape->vertex_count * sizeof *mesh->vertices);
    for (size_t f = 0; f <= shape->face_count; f++)
        mesh->start[f] = shape->start[f];
    for (size_t i = 0; i < corners; i++)
        mesh->loops[i] = shape->loop[i];
    memcpy(mesh->tags, shape->tag, shape->face_count * sizeof *mesh->tags);
    for (uint32_t i = 0; i < shape->face_count; i++)
        mesh->normals[i] = shape->plane[i].normal;
    return TL_OK;
}

tl_status tl_block_mesh_get(tl_model *m, tl_id block, tl_block_mesh *mesh)
{
    tl_status status = tl_block_mesh_local(m, block, mesh);
    if (status != TL_OK)
        return status;
    uint32_t body = m->blocks.body[tl_block_row_quiet(m, block)];
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->vertices[i] = tl_model_point(m, body, mesh->vertices[i]);
    for (size_t i = 0; i < mesh->face_count; i++)
        mesh->normals[i] = tl_m3_mul(&m->bodies.pose[body].r, mesh->normals[i]);
    return TL_OK;
}

void tl_block_mesh_free(tl_block_mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->start);
    free(mesh->loops);
    free(mesh->tags);
    free(mesh->normals);
    *mesh = (tl_block_mesh){0};
}
