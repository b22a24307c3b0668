/* block_fields.c - what can be asked of a block: its named fields. */
#include "query/block_fields.h"

#include "base/columns.h"
#include "model/deformable.h"
#include "model/regroup.h"
#include "query/zone_at.h"
#include "zone/grid.h"

#include <assert.h>
#include <string.h>
#include <talus/fields.h>

/* The mesh of a block's body; NULL: it is rigid. */
static const tl_body_mesh *mesh_of(const tl_model *m, uint32_t body)
{
    const uint32_t mesh = tl_mesh_of(m, m->bodies.id[body]);
    return mesh != TL_NO_ROW ? &m->zones->mesh[mesh] : NULL;
}

/* The mean velocity of a mesh, by mass. */
static tl_vec3 mean_velocity(const tl_model *m, const tl_body_mesh *mesh)
{
    const tl_gridpoints *p = &m->zones->points;
    tl_vec3 sum = {0, 0, 0};
    double mass = 0;
    for (uint32_t k = mesh->point_begin; k < mesh->point_end; k++) {
        sum = tl_v3_madd(sum, p->mass[k], tl_columns_get(p->v, k));
        mass += p->mass[k];
    }
    return tl_v3_scale(1 / mass, sum);
}

/* The kinetic energy of a mesh per mass, J/kg. */
static double mean_energy(const tl_model *m, const tl_body_mesh *mesh)
{
    const tl_gridpoints *p = &m->zones->points;
    double sum = 0, mass = 0;
    for (uint32_t k = mesh->point_begin; k < mesh->point_end; k++) {
        sum += 0.5 * p->mass[k] * tl_v3_norm2(tl_columns_get(p->v, k));
        mass += p->mass[k];
    }
    return sum / mass;
}

static tl_vec3 velocity(const tl_model *m, uint32_t row)
{
    const tl_body_mesh *mesh = mesh_of(m, m->blocks.body[row]);
    return mesh ? mean_velocity(m, mesh) : tl_block_velocity(m, row);
}

static double kinetic_energy(const tl_model *m, uint32_t row)
{
    const tl_body_mesh *mesh = mesh_of(m, m->blocks.body[row]);
    const double mass = m->blocks.density[row] * m->blocks.volume[row];
    if (mesh)
        return mass * mean_energy(m, mesh);
    const tl_vec3 w = m->bodies.w[m->blocks.body[row]];
    return 0.5 * mass * tl_v3_norm2(tl_block_velocity(m, row)) +
           0.5 * tl_v3_dot(w, tl_s3_mul(tl_block_inertia(m, row), w));
}

static double zones_of(const tl_model *m, uint32_t body)
{
    const tl_body_mesh *mesh = mesh_of(m, body);
    return mesh ? mesh->zone_end - mesh->zone_begin : 0;
}

static double gridpoints_of(const tl_model *m, uint32_t body)
{
    const tl_body_mesh *mesh = mesh_of(m, body);
    return mesh ? mesh->point_end - mesh->point_begin : 0;
}

static double held_of(const tl_model *m, uint32_t body)
{
    const unsigned some = mesh_of(m, body) ? 0 : m->bodies.fixed[body];
    return tl_body_is_held(m, body) ? TL_FIX_ALL : some;
}

/* The fields: name, kind, unit, what they are, and their value. It is that of the block in `row` of the blocks b, or
 * of its `body`. */
#define BLOCK_FIELDS(FIELD)                                                                                            \
    FIELD(id, COUNT, "", "number of the block, never used again", b->id[row])                                          \
    FIELD(group, TEXT, "", "name of its group", b->group[row])                                                         \
    FIELD(density, SCALAR, "kg/m3", "mass per volume", b->density[row])                                                \
    FIELD(volume, SCALAR, "m3", "volume of the block alone", b->volume[row])                                           \
    FIELD(mass, SCALAR, "kg", "mass of the block alone", b->density[row] * b->volume[row])                             \
    FIELD(inertia, SYM3, "kg m2", "inertia of the block about its centroid, in the axes of the model",                 \
          tl_block_inertia(m, row))                                                                                    \
    FIELD(centroid, VEC3, "m", "present place of the centroid", tl_block_centroid(m, row))                             \
    FIELD(displacement, VEC3, "m", "of the centroid, since creation or reset_displacement",                            \
          tl_block_displacement(m, row))                                                                               \
    FIELD(rotation, QUAT, "", "unit quaternion w, x, y, z of its body", bodies->q[body])                               \
    FIELD(velocity, VEC3, "m/s", "of the centroid, half a step ago; of a deformable block the mean of its body",       \
          velocity(m, row))                                                                                            \
    FIELD(angular_velocity, VEC3, "rad/s", "of its body; 0 of a deformable one", bodies->w[body])                      \
    FIELD(force, VEC3, "N", "unbalanced force on its body", bodies->force[body])                                       \
    FIELD(moment, VEC3, "N m", "unbalanced moment about its body's centroid", bodies->moment[body])                    \
    FIELD(fixed, BOOL, "", "whether its body, or all its gridpoints, are held in every component",                     \
          tl_body_is_held(m, body))                                                                                    \
    FIELD(held, COUNT, "", "components of its body that are held: 1 x, 2 y, 4 z, 8 rotation, added up",                \
          held_of(m, body))                                                                                            \
    FIELD(hidden, BOOL, "", "hidden blocks are not cut", b->hidden[row] != 0)                                          \
    FIELD(body, COUNT, "", "id of its rigid body: the lowest id of its blocks", bodies->id[body])                      \
    FIELD(speed, SCALAR, "m/s", "length of the velocity", tl_v3_norm(velocity(m, row)))                                \
    FIELD(kinetic_energy, SCALAR, "J", "of the block alone; of a deformable body the share by its mass",               \
          kinetic_energy(m, row))                                                                                      \
    FIELD(deformable, BOOL, "", "whether it has zones", mesh_of(m, body) != NULL)                                      \
    FIELD(zones, COUNT, "", "of its body", zones_of(m, body))                                                          \
    FIELD(gridpoints, COUNT, "", "of its body", gridpoints_of(m, body))                                                \
    FIELD(stress, SYM3, "Pa", "mean over its zones, by volume; nan of a rigid block",                                  \
          tl_mesh_mean(m, mesh_of(m, body), b->id[row], tl_zone_stress))                                               \
    FIELD(strain, SYM3, "", "mean logarithmic strain of these zones; nan of a rigid block",                            \
          tl_mesh_mean(m, mesh_of(m, body), b->id[row], tl_zone_strain))

/* What else files show. */
#define BLOCK_ARRAYS(FIELD)                                                                                            \
    FIELD(rotation_vector, VEC3, "rad", "axis times angle", tl_q_vector(bodies->q[body]))                              \
    FIELD(displacement_size, SCALAR, "m", "length of the displacement", tl_v3_norm(tl_block_displacement(m, row)))

#define NUMBER(name, kind, unit, doc, value) F_##name,
#define FIELD(name, kind, unit, doc, value) {#name, TL_FIELD_##kind, unit, doc},
#define CASE(name, kind, unit, doc, value)                                                                             \
    case F_##name: TL_FIELD_PUT(out, value); break;

enum { BLOCK_FIELDS(NUMBER) F_COUNT, F_BEFORE_ARRAYS = F_COUNT - 1, BLOCK_ARRAYS(NUMBER) F_ALL };

static const tl_field fields[F_ALL] = {BLOCK_FIELDS(FIELD) BLOCK_ARRAYS(FIELD)};

const tl_field *tl_block_fields(size_t *count)
{
    *count = F_COUNT;
    return fields;
}

const tl_field *tl_block_quantity(const char *name)
{
    const tl_field *of = fields;
    while (strcmp(of->name, name) != 0)
        of++;
    return of;
}

void tl_block_numbers(const tl_model *m, uint32_t row, const tl_field *of, double out[6])
{
    const tl_blocks *b = &m->blocks;
    const tl_bodies *bodies = &m->bodies;
    const uint32_t body = b->body[row];
    switch (of - fields) {
        BLOCK_FIELDS(CASE)
        BLOCK_ARRAYS(CASE)
    default: break;
    }
}

size_t tl_field_width(tl_field_kind kind)
{
    switch (kind) {
    case TL_FIELD_VEC3: return 3;
    case TL_FIELD_QUAT: return 4;
    case TL_FIELD_SYM3: return 6;
    case TL_FIELD_IDS: return 2;
    case TL_FIELD_TEXT: return 0;
    default: return 1;
    }
}

tl_status tl_block_field(tl_model *m, tl_id block, size_t index, tl_field_value *value)
{
    assert(index < F_COUNT);
    uint32_t row = tl_block_row(m, block);
    if (row == TL_NO_ROW)
        return m->error.status;
    *value = (tl_field_value){{0}, NULL};
    if (fields[index].kind == TL_FIELD_TEXT)
        value->text = m->groups[m->blocks.group[row]];
    else
        tl_block_numbers(m, row, &fields[index], value->number);
    return TL_OK;
}
