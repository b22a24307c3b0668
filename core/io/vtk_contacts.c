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
 *
 * All of it comes from the contact fields of talus.h, by name. */
#include "base/error.h"
#include "io/vtk_data.h"
#include "io/vtk_file.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

typedef struct contacts {
    tl_model *model;
    FILE *file;
    const tl_id *ids;
    size_t count;
} contacts;

static const char *const state_names[] = {"elastic", "slipping", "open", "failed"};

static size_t field_index(const char *name, size_t *components)
{
    size_t count;
    const tl_field *fields = tl_contact_fields(&count);
    size_t index = 0;
    while (index < count && strcmp(fields[index].name, name) != 0)
        index++;
    assert(index < count);
    *components = fields[index].kind == TL_FIELD_VEC3 ? 3 : 1;
    return index;
}

/* The numbers of one field, contact after contact. */
static tl_status put_numbers(const contacts *c, const char *field)
{
    size_t components;
    size_t index = field_index(field, &components);
    for (size_t i = 0; i < c->count; i++) {
        tl_field_value value;
        tl_status status = tl_contact_field(c->model, c->ids[i], index, &value);
        if (status != TL_OK)
            return status;
        for (size_t k = 0; k < components; k++)
            tl_vtk_double(c->file, value.number[k]);
    }
    tl_vtk_line(c->file);
    return TL_OK;
}

static tl_status put_array(const contacts *c, const char *field)
{
    size_t components;
    field_index(field, &components);
    tl_vtk_array(c->file, field, components, c->count, TL_VTK_DOUBLE);
    return put_numbers(c, field);
}

static tl_status put_blocks(const contacts *c, const char *name, size_t which)
{
    size_t components;
    size_t index = field_index("blocks", &components);
    tl_vtk_array(c->file, name, 1, c->count, TL_VTK_INT);
    for (size_t i = 0; i < c->count; i++) {
        tl_field_value value;
        tl_status status = tl_contact_field(c->model, c->ids[i], index, &value);
        if (status != TL_OK)
            return status;
        tl_vtk_int(c->file, (int32_t)value.number[which]);
    }
    tl_vtk_line(c->file);
    return TL_OK;
}

static tl_status put_ids(const contacts *c)
{
    tl_vtk_array(c->file, "contact_id", 1, c->count, TL_VTK_INT);
    for (size_t i = 0; i < c->count; i++)
        tl_vtk_int(c->file, (int32_t)c->ids[i]);
    tl_vtk_line(c->file);
    tl_status status = put_blocks(c, "block_a", 0);
    return status == TL_OK ? put_blocks(c, "block_b", 1) : status;
}

static int32_t state_number(const char *text)
{
    const int32_t count = sizeof state_names / sizeof *state_names;
    int32_t number = 0;
    while (number < count && strcmp(text, state_names[number]) != 0)
        number++;
    assert(number < count);
    return number;
}

static tl_status put_state(const contacts *c)
{
    size_t components;
    size_t index = field_index("state", &components);
    tl_vtk_array(c->file, "state", 1, c->count, TL_VTK_INT);
    for (size_t i = 0; i < c->count; i++) {
        tl_field_value value;
        tl_status status = tl_contact_field(c->model, c->ids[i], index, &value);
        if (status != TL_OK)
            return status;
        tl_vtk_int(c->file, state_number(value.text));
    }
    tl_vtk_line(c->file);
    return TL_OK;
}

/* The field holds "J1:3", or "" where no joint made the faces. */
static tl_status joint_tag(const contacts *c, size_t contact, tl_tag *tag)
{
    size_t components;
    tl_field_value value;
    size_t index = field_index("joint", &components);
    tl_status status = tl_contact_field(c->model, c->ids[contact], index, &value);
    *tag = (tl_tag){0, 0};
    if (status == TL_OK && value.text[0] != '\0')
        status = tl_joint_parse(c->model, value.text, tag);
    return status;
}

static tl_status put_joint(const contacts *c, const char *name, bool plane)
{
    tl_vtk_array(c->file, name, 1, c->count, TL_VTK_INT);
    for (size_t i = 0; i < c->count; i++) {
        tl_tag tag;
        tl_status status = joint_tag(c, i, &tag);
        if (status != TL_OK)
            return status;
        tl_vtk_int(c->file, (int32_t)(plane ? tag.plane : tag.joint));
    }
    tl_vtk_line(c->file);
    return TL_OK;
}

static tl_status put_shape(const contacts *c)
{
    fprintf(c->file, "POINTS %zu double\n", c->count);
    tl_status status = put_numbers(c, "point");
    fprintf(c->file, "VERTICES %zu %zu\n", c->count, 2 * c->count);
    for (size_t i = 0; i < c->count; i++) {
        tl_vtk_int(c->file, 1);
        tl_vtk_int(c->file, (int32_t)i);
    }
    tl_vtk_line(c->file);
    return status;
}

static tl_status put_data(const contacts *c)
{
    static const char *const reals[] = {"normal_stress", "shear_stress", "area", "normal", "gap"};
    const size_t real_count = sizeof reals / sizeof *reals;

    fprintf(c->file, "POINT_DATA %zu\nSCALARS normal_force double 1\nLOOKUP_TABLE default\n",
            c->count);
    tl_status status = put_numbers(c, "normal_force");
    fprintf(c->file, "VECTORS shear_force double\n");
    if (status == TL_OK)
        status = put_numbers(c, "shear_force");
    tl_vtk_field(c->file, "FieldData", real_count + 6);
    for (size_t i = 0; status == TL_OK && i < real_count; i++)
        status = put_array(c, reals[i]);
    if (status == TL_OK)
        status = put_state(c);
    if (status == TL_OK)
        status = put_joint(c, "joint", false);
    if (status == TL_OK)
        status = put_joint(c, "plane", true);
    return status == TL_OK ? put_ids(c) : status;
}

tl_status tl_vtk_contacts(tl_model *m, FILE *file)
{
    tl_id *ids = NULL;
    contacts c = {.model = m, .file = file};
    tl_contact_filter every = {0};
    tl_status status = tl_contacts_select(m, &every, &ids, &c.count);
    if (status != TL_OK)
        return status;
    c.ids = ids;
    status = tl_vtk_countable(2 * c.count, "contacts", &m->error);
    if (status == TL_OK) {
        tl_vtk_header(file, m, "contacts", "POLYDATA");
        status = put_shape(&c);
    }
    if (status == TL_OK)
        status = put_data(&c);
    free(ids);
    return status;
}
