/* vtk_contacts.c - the contacts of a frame: POLYDATA with one point and one vertex for each contact.
 *
 * Point data  normal_force   N, compression positive     shear_force   N, vector, on the block of the
 *                                                                     higher id
 *             normal_stress  Pa                          shear_stress  Pa
 *             state          0 elastic, 1 slipping, 2 open, 3 failed
 *             joint          index into the field joint_names, plane its number within the set
 *             area           m2                          gap           m, overlap negative
 *             normal         unit vector, from the lower block id to the higher
 *             contact_id, block_a, block_b               ids
 *             and each state of the laws by its name: the mean of the contact's points, weighted by their areas, or the
 *             sum of a state that goes with the area; NaN where the contact's law has no such state
 *
 * All of a contact is asked for once and kept in the form of the file, array by array. */
#include "io/vtk_contacts.h"

#include "base/error.h"
#include "base/output_file.h"
#include "base/parallel.h"
#include "io/extra_fields.h"
#include "io/pieces.h"
#include "io/vtk_columns.h"
#include "io/vtk_file.h"
#include "query/contact_fields.h"

#include <stdlib.h>

/* Contacts that a thread takes at a time. */
#define CHUNK 512

/* The arrays, in the order of the file; those of the field from FIELDS on. */
enum {
    POINTS,
    VERTICES,
    NORMAL_FORCE,
    SHEAR_FORCE,
    FIELDS,
    NORMAL_STRESS = FIELDS,
    SHEAR_STRESS,
    AREA,
    NORMAL,
    GAP,
    STATE,
    JOINT,
    PLANE,
    CONTACT_ID,
    BLOCK_A,
    BLOCK_B,
    ARRAYS
};

static const tl_vtk_column columns[ARRAYS] = {
    [POINTS] = {NULL, TL_VTK_DOUBLE, 3},
    [VERTICES] = {NULL, TL_VTK_INT, 2},
    [NORMAL_FORCE] = {NULL, TL_VTK_DOUBLE, 1},
    [SHEAR_FORCE] = {NULL, TL_VTK_DOUBLE, 3},
    [NORMAL_STRESS] = {"normal_stress", TL_VTK_DOUBLE, 1},
    [SHEAR_STRESS] = {"shear_stress", TL_VTK_DOUBLE, 1},
    [AREA] = {"area", TL_VTK_DOUBLE, 1},
    [NORMAL] = {"normal", TL_VTK_DOUBLE, 3},
    [GAP] = {"gap", TL_VTK_DOUBLE, 1},
    [STATE] = {"state", TL_VTK_INT, 1},
    [JOINT] = {"joint", TL_VTK_INT, 1},
    [PLANE] = {"plane", TL_VTK_INT, 1},
    [CONTACT_ID] = {"contact_id", TL_VTK_INT, 1},
    [BLOCK_A] = {"block_a", TL_VTK_INT, 1},
    [BLOCK_B] = {"block_b", TL_VTK_INT, 1},
};

typedef struct contacts {
    const tl_model *model;
    uint32_t *rows;
    size_t count;
    tl_vtk_columns columns;
} contacts;

static void fill_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const contacts *all = user;
    const tl_vtk_columns *c = &all->columns;
    for (size_t i = begin; i < end; i++) {
        tl_contact_facts facts = tl_contact_facts_of(all->model, all->rows[i]);
        tl_vtk_set_vec3(c, POINTS, i, facts.point);
        tl_vtk_set_int(c, VERTICES, 2 * i, 1);
        tl_vtk_set_int(c, VERTICES, 2 * i + 1, (uint32_t)i);
        tl_vtk_set_real(c, NORMAL_FORCE, i, facts.normal_force);
        tl_vtk_set_vec3(c, SHEAR_FORCE, i, facts.shear_force);
        tl_vtk_set_real(c, NORMAL_STRESS, i, facts.normal_stress);
        tl_vtk_set_real(c, SHEAR_STRESS, i, facts.shear_stress);
        tl_vtk_set_real(c, AREA, i, facts.area);
        tl_vtk_set_vec3(c, NORMAL, i, facts.normal);
        tl_vtk_set_real(c, GAP, i, facts.gap);
        tl_vtk_set_int(c, STATE, i, facts.state);
        tl_vtk_set_int(c, JOINT, i, facts.tag.joint);
        tl_vtk_set_int(c, PLANE, i, facts.tag.plane);
        tl_vtk_set_int(c, CONTACT_ID, i, facts.id);
        tl_vtk_set_int(c, BLOCK_A, i, facts.a);
        tl_vtk_set_int(c, BLOCK_B, i, facts.b);
        tl_vtk_set_rest(c, all->model, i, all->rows[i], i);
    }
}

static void put_contacts(const contacts *c, tl_output *output)
{
    FILE *file = output->file;
    tl_vtk_header(file, c->model, "contacts", "POLYDATA");
    fprintf(file, "POINTS %zu double\n", c->count);
    tl_vtk_put_column(&c->columns, POINTS, output);
    fprintf(file, "VERTICES %zu %zu\n", c->count, 2 * c->count);
    tl_vtk_put_column(&c->columns, VERTICES, output);
    fprintf(file, "POINT_DATA %zu\nSCALARS normal_force double 1\nLOOKUP_TABLE default\n",
            c->count);
    tl_vtk_put_column(&c->columns, NORMAL_FORCE, output);
    fprintf(file, "VECTORS shear_force double\n");
    tl_vtk_put_column(&c->columns, SHEAR_FORCE, output);
    tl_vtk_put_columns(&c->columns, FIELDS, output);
}

tl_status tl_vtk_contacts(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out)
{
    contacts c = {.model = m};
    tl_status status = tl_contacts_listed(m, &c.rows, &c.count);
    if (status == TL_OK)
        status = tl_vtk_countable(2 * c.count, "contacts", &m->error);
    if (status == TL_OK)
        status = tl_extra_fields_check("write_vtk: contact_fields", parts->contact_fields,
                                       parts->contact_field_count, c.count, "contacts", &m->error);
    if (status == TL_OK)
        status = tl_vtk_columns_make(&c.columns, m, columns, ARRAYS, TL_VTK_DOUBLE, c.count,
                                     parts->contact_fields, parts->contact_field_count);
    if (status == TL_OK) {
        tl_parallel_for(m->pool, c.count, CHUNK, fill_range, &c);
        put_contacts(&c, out->output);
    }
    tl_vtk_columns_free(&c.columns);
    free(c.rows);
    return status;
}
