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
#include "base/error.h"
#include "base/pages.h"
#include "io/vtk_data.h"
#include "io/vtk_file.h"
#include "query/contact_fields.h"
#include "query/law_states.h"

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

typedef struct array {
    const char *name, *type;
    unsigned components;
} array;

static const array arrays[ARRAYS] = {
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
    unsigned char *memory, *at[ARRAYS]; /* of the arrays, as they are in the file */
    tl_law_states states;
    unsigned char *states_at; /* their arrays, one after the other */
} contacts;

static size_t bytes_of(size_t a)
{
    return arrays[a].components *
           (arrays[a].type[0] == 'i' ? (size_t)TL_VTK_INT_BYTES : sizeof(double));
}

static void put_double(const contacts *c, size_t a, size_t i, double value)
{
    tl_vtk_put_double(c->at[a] + i * sizeof value, value);
}

static void put_vec3(const contacts *c, size_t a, size_t i, tl_vec3 value)
{
    tl_vtk_put_vec3(c->at[a] + i * TL_VTK_VEC3_BYTES, value);
}

static void put_int(const contacts *c, size_t a, size_t i, uint32_t value)
{
    tl_vtk_put_int(c->at[a] + i * TL_VTK_INT_BYTES, (int32_t)value);
}

/* Puts the states of a contact, the i-th, into their arrays. */
static void put_states(const contacts *c, size_t i)
{
    unsigned char *values = c->states_at;
    for (size_t s = 0; s < c->states.count; s++) {
        const tl_law_state *state = &c->states.at[s];
        double value[3];
        tl_law_state_of_contact(c->model, &c->states, state, c->rows[i], value);
        for (size_t w = 0; w < state->width; w++)
            tl_vtk_put_double(values + (i * state->width + w) * sizeof(double), value[w]);
        values += c->count * state->width * sizeof(double);
    }
}

static void fill_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const contacts *c = user;
    for (size_t i = begin; i < end; i++) {
        tl_contact_facts facts = tl_contact_facts_of(c->model, c->rows[i]);
        put_vec3(c, POINTS, i, facts.point);
        put_int(c, VERTICES, 2 * i, 1);
        put_int(c, VERTICES, 2 * i + 1, (uint32_t)i);
        put_double(c, NORMAL_FORCE, i, facts.normal_force);
        put_vec3(c, SHEAR_FORCE, i, facts.shear_force);
        put_double(c, NORMAL_STRESS, i, facts.normal_stress);
        put_double(c, SHEAR_STRESS, i, facts.shear_stress);
        put_double(c, AREA, i, facts.area);
        put_vec3(c, NORMAL, i, facts.normal);
        put_double(c, GAP, i, facts.gap);
        put_int(c, STATE, i, facts.state);
        put_int(c, JOINT, i, facts.tag.joint);
        put_int(c, PLANE, i, facts.tag.plane);
        put_int(c, CONTACT_ID, i, facts.id);
        put_int(c, BLOCK_A, i, facts.a);
        put_int(c, BLOCK_B, i, facts.b);
        put_states(c, i);
    }
}

/* Asks for all contacts; false when out of memory. */
static bool fill_arrays(contacts *c, tl_model *m)
{
    size_t bytes = 0;
    for (size_t a = 0; a < ARRAYS; a++)
        bytes += c->count * bytes_of(a);
    for (size_t s = 0; s < c->states.count; s++)
        bytes += c->count * c->states.at[s].width * sizeof(double);
    c->memory = malloc(bytes + 1);
    if (!c->memory)
        return false;
    tl_pages_large(c->memory, bytes);
    unsigned char *at = c->memory;
    for (size_t a = 0; a < ARRAYS; a++) {
        c->at[a] = at;
        at += c->count * bytes_of(a);
    }
    c->states_at = at;
    tl_parallel_for(m->pool, c->count, CHUNK, fill_range, c);
    return true;
}

static void put_array(const contacts *c, size_t a, tl_output *output)
{
    if (arrays[a].name)
        tl_vtk_array(output->file, arrays[a].name, arrays[a].components, c->count, arrays[a].type);
    tl_output_put(output, c->at[a], c->count * bytes_of(a));
    tl_vtk_line(output->file);
}

static void put_state_arrays(const contacts *c, tl_output *output)
{
    const unsigned char *values = c->states_at;
    for (size_t s = 0; s < c->states.count; s++) {
        const tl_law_state *state = &c->states.at[s];
        size_t bytes = c->count * state->width * sizeof(double);
        tl_vtk_array(output->file, state->name, state->width, c->count, TL_VTK_DOUBLE);
        tl_output_put(output, values, bytes);
        tl_vtk_line(output->file);
        values += bytes;
    }
}

static void put_contacts(const contacts *c, tl_output *output)
{
    FILE *file = output->file;
    tl_vtk_header(file, c->model, "contacts", "POLYDATA");
    fprintf(file, "POINTS %zu double\n", c->count);
    put_array(c, POINTS, output);
    fprintf(file, "VERTICES %zu %zu\n", c->count, 2 * c->count);
    put_array(c, VERTICES, output);
    fprintf(file, "POINT_DATA %zu\nSCALARS normal_force double 1\nLOOKUP_TABLE default\n",
            c->count);
    put_array(c, NORMAL_FORCE, output);
    fprintf(file, "VECTORS shear_force double\n");
    put_array(c, SHEAR_FORCE, output);
    tl_vtk_field(file, "FieldData", ARRAYS - FIELDS + c->states.count);
    for (size_t a = FIELDS; a < ARRAYS; a++)
        put_array(c, a, output);
    put_state_arrays(c, output);
}

tl_status tl_vtk_contacts(tl_model *m, tl_pieces *out)
{
    contacts c = {.model = m};
    tl_status status = tl_contacts_listed(m, &c.rows, &c.count);
    if (status == TL_OK)
        status = tl_vtk_countable(2 * c.count, "contacts", &m->error);
    if (status == TL_OK)
        status = tl_law_states_list(m, &c.states);
    if (status == TL_OK && !fill_arrays(&c, m))
        status = tl_fail_memory(&m->error);
    if (status == TL_OK)
        put_contacts(&c, out->output);
    tl_law_states_free(&c.states);
    free(c.memory);
    free(c.rows);
    return status;
}
