/* vtk_contacts.c - the contacts of a frame, and its joints.
 *
 * Contacts are POLYDATA with one point and one vertex for each contact.
 *
 * Point data  normal_force   N, compression positive     shear_force   N, vector, on the block of the
 *                                                                     higher id
 *             normal_stress  Pa                          shear_stress  Pa
 *             state          0 elastic, 1 slipping, 2 open, 3 failed
 *             joint          index into the field joint_names, plane its number within the set
 *             law            index into the field law_names
 *             area           m2                          gap           m, overlap negative
 *             normal         unit vector, from the lower block id to the higher
 *             contact_id, block_a, block_b               ids
 *             and each state of the laws by its name: the mean of the contact's points, weighted by their areas, or the
 *             sum of a state that goes with the area; NaN where the contact's law has no such state
 *
 * All of a contact is asked for once and kept in the form of the file, array by array.
 *
 * Joints are POLYDATA of polygons. There is one for each place where two blocks touch; contacts that are not flush
 * have several. There is one for each face that a joint made and on which no contact lies any more. So what joints do
 * shows once and where it happens.
 *
 * Cell data  joint     index into the field joint_names; 0 where neither face was made by a joint
 *            plane     number of the plane within its joint set
 *            law       index into the field law_names; 0: a face without contact
 *            block_id, block_b   the blocks, the older first; block_b 0: a face without contact, of block_id
 *            contact_id          0: a face without contact
 *            state     0 elastic, 1 slipping, 2 open, 3 failed; 4 a face without contact
 *            normal_stress, shear_stress   Pa      normal_force   N, compression positive
 *            shear_force         N, vector, on block_b
 *            shear_displacement  m, vector: of block_b against block_id since creation or the last reset
 *            slip      m, the state "slip" of the contact's law, where it keeps one, else the length of
 *                      shear_displacement
 *            area      m2 of the contact, of the face where there is none
 *            and each state of the laws by its name, one called as an array above with law_ in front; NaN where there
 *            is none
 * Point data displacement  m, that of block_id, as in the file of the blocks
 *
 * Without contact, stresses, forces and slip are 0. */
#include "io/vtk_contacts.h"

#include "base/error.h"
#include "base/output_file.h"
#include "base/parallel.h"
#include "base/table.h"
#include "contact/sides.h"
#include "geometry/measure.h"
#include "io/extra_fields.h"
#include "io/vtk_file.h"
#include "query/contact_fields.h"
#include "query/contact_polygons.h"
#include "query/meeting.h"
#include "query/point_fields.h"

#include <math.h>
#include <stdlib.h>

#define CONTEXT "write_vtk: contact_fields"
/* Contacts, or polygons, that a thread takes at a time. */
#define CHUNK 512

/* ---------------------------------------------------------------- columns ----------------
 *
 * Arrays of a file that are filled row by row, by several threads, and written one after the other. */

/* Quantities of contacts in the order of a file, of which the first have headings of their own, and the type of its
 * real numbers. */
typedef struct array_list {
    const char *const *names;
    size_t count, headed;
    const char *real_type;
} array_list;

static const char *const contact_arrays[] = {"point", "normal_force", "shear_force", "normal_stress", "shear_stress",
                                             "area",  "normal",       "gap",         "state",         "joint",
                                             "plane", "law",          "contact_id",  "block_a",       "block_b"};
static const char *const joint_arrays[] = {"joint",        "plane",        "law",         "block_id",
                                           "block_b",      "contact_id",   "state",       "normal_stress",
                                           "shear_stress", "normal_force", "shear_force", "shear_displacement",
                                           "slip",         "area"};

enum { POINTS, NORMAL_FORCE, SHEAR_FORCE, CONTACT_HEADED };
enum { JOINT, JOINT_HEADED };

#define NAMES(list) list, sizeof(list) / sizeof *(list)

static const array_list contact_list = {NAMES(contact_arrays), CONTACT_HEADED, TL_VTK_DOUBLE};
static const array_list joint_list = {NAMES(joint_arrays), JOINT_HEADED, TL_VTK_FLOAT};

/* An array: its name, its type in the file, and the numbers of a row. */
typedef struct column {
    const char *name, *type;
    size_t width;
    const tl_field *quantity; /* of contacts, or NULL */
    unsigned char *at;        /* as it is in the file */
} column;

/* The quantities of a list, after them a column for each state of the laws, and then one for each field that the
 * program adds. A state is called law_NAME where a quantity has its name. */
typedef struct columns {
    column *list;
    size_t given, headed, count, rows;
    unsigned char *memory;
    tl_law_states states;
    const tl_extra_field *fields;
    size_t field_count;
} columns;

static size_t bytes_of(const column *of)
{
    const bool is_long = of->type[0] == 'd' || of->type[0] == 'v';
    return of->width * (is_long ? sizeof(double) : sizeof(float));
}

static column column_of(const tl_field *of, const char *real_type)
{
    static const tl_contact_facts any;
    const bool whole = of->kind != TL_FIELD_SCALAR && of->kind != TL_FIELD_VEC3;
    return (column){.name = of->name,
                    .type = tl_contact_long(&any, of) ? TL_VTK_LONG
                            : whole                   ? TL_VTK_INT
                                                      : real_type,
                    .width = of->kind == TL_FIELD_VEC3 ? 3 : 1,
                    .quantity = of};
}

/* A state that is called as one of the given columns is called law_NAME here. */
static void rename_states(columns *c)
{
    for (size_t s = 0; s < c->states.count; s++)
        for (size_t k = c->headed; k < c->given; k++) {
            tl_law_state *state = &c->states.at[s];
            if (strcmp(c->list[k].name, state->name) == 0)
                snprintf(state->name, sizeof state->name, "law_%s", c->list[k].name);
        }
}

static bool list_columns(columns *c, const array_list *list)
{
    c->count = c->given + c->states.count + c->field_count;
    column *next = c->list = malloc((c->count + 1) * sizeof *c->list);
    if (!next)
        return false;
    for (size_t k = 0; k < c->given; k++)
        *next++ = column_of(tl_contact_quantity(list->names[k]), list->real_type);
    rename_states(c);
    for (size_t s = 0; s < c->states.count; s++)
        *next++ = (column){.name = c->states.at[s].name, .type = list->real_type, .width = c->states.at[s].width};
    for (size_t f = 0; f < c->field_count; f++)
        *next++ = (column){.name = c->fields[f].name, .type = TL_VTK_DOUBLE, .width = 1};
    return true;
}

static bool make_memory(columns *c)
{
    size_t bytes = 0;
    for (size_t k = 0; k < c->count; k++)
        bytes += c->rows * bytes_of(&c->list[k]);
    unsigned char *at = c->memory = malloc(bytes + 1);
    if (!at)
        return false;
    tl_pages_large(at, bytes);
    for (size_t k = 0; k < c->count; k++) {
        c->list[k].at = at;
        at += c->rows * bytes_of(&c->list[k]);
    }
    return true;
}

static tl_status make_columns(columns *c, tl_model *m, const array_list *list, size_t rows, const tl_vtk_parts *parts,
                              size_t contacts)
{
    const tl_extra_field *fields = parts->contact_fields;
    const size_t count = parts->contact_field_count;
    *c = (columns){.given = list->count, .headed = list->headed, .rows = rows, .fields = fields, .field_count = count};
    tl_status status = tl_extra_fields_check(CONTEXT, fields, count, contacts, "contacts", &m->error);
    if (status == TL_OK)
        status = tl_law_states_list(m, &c->states);
    if (status == TL_OK && !list_columns(c, list))
        status = tl_fail_memory(&m->error);
    for (size_t k = list->headed; status == TL_OK && k < c->count - count; k++)
        status = tl_extra_fields_differ(CONTEXT, fields, count, c->list[k].name, &m->error);
    if (status == TL_OK && !make_memory(c))
        status = tl_fail_memory(&m->error);
    return status;
}

static void free_columns(columns *c)
{
    tl_law_states_free(&c->states);
    free(c->list);
    free(c->memory);
    *c = (columns){0};
}

static void set_numbers(const column *of, size_t row, const double *value)
{
    unsigned char *to = of->at + row * bytes_of(of);
    const tl_vec3 vector = {value[0], of->width == 3 ? value[1] : 0, of->width == 3 ? value[2] : 0};
    switch (of->type[0]) {
    case 'd': of->width == 3 ? tl_vtk_put_vec3(to, vector) : tl_vtk_put_double(to, value[0]); break;
    case 'f': of->width == 3 ? tl_vtk_put_float3(to, vector) : tl_vtk_put_float(to, value[0]); break;
    default: tl_vtk_put_int(to, (int32_t)(uint32_t)value[0]);
    }
}

static void set_row(const columns *c, const tl_model *m, size_t row, const tl_contact_facts *facts, uint32_t contact,
                    size_t number)
{
    const column *of = c->list;
    for (size_t k = 0; k < c->given; k++, of++) {
        double value[3];
        const int64_t *whole = tl_contact_long(facts, of->quantity);
        if (whole) {
            tl_vtk_put_long(of->at + row * bytes_of(of), *whole);
            continue;
        }
        tl_contact_numbers(facts, of->quantity, value);
        set_numbers(of, row, value);
    }
    for (size_t s = 0; s < c->states.count; s++, of++) {
        double value[3] = {NAN, NAN, NAN};
        if (contact != TL_NO_ROW)
            tl_law_state_of_contact(m, &c->states, &c->states.at[s], contact, value);
        set_numbers(of, row, value);
    }
    for (size_t f = 0; f < c->field_count; f++, of++) {
        double value = contact == TL_NO_ROW ? NAN : c->fields[f].values[number];
        set_numbers(of, row, &value);
    }
}

static void put_column(const columns *c, size_t k, tl_output *output)
{
    tl_output_put(output, c->list[k].at, c->rows * bytes_of(&c->list[k]));
    tl_vtk_line(output->file);
}

static void put_columns(const columns *c, tl_output *output)
{
    tl_vtk_field(output->file, "FieldData", c->count - c->headed);
    for (size_t k = c->headed; k < c->count; k++) {
        const column *of = &c->list[k];
        tl_vtk_array(output->file, of->name, of->width, c->rows, of->type);
        put_column(c, k, output);
    }
}

/* ---------------------------------------------------------------- contacts --------------- */

typedef struct contacts {
    const tl_model *model;
    uint32_t *rows;
    size_t count;
    columns columns;
} contacts;

static void fill_contacts(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const contacts *c = user;
    for (size_t i = begin; i < end; i++) {
        const tl_contact_facts facts = tl_contact_facts_of(c->model, c->rows[i]);
        set_row(&c->columns, c->model, i, &facts, c->rows[i], i);
    }
}

/* A vertex for each contact. */
static void fill_vertices(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    (void)user;
    unsigned char *to = tl_piece_add(piece, 2 * (end - begin) * TL_VTK_INT_BYTES);
    for (size_t i = begin; to && i < end; i++)
        to = tl_vtk_put_int(tl_vtk_put_int(to, 1), (int32_t)i);
}

static tl_status put_contacts(const contacts *c, tl_pieces *out)
{
    FILE *file = out->output->file;
    tl_vtk_header(file, c->model, "contacts", "POLYDATA", true);
    fprintf(file, "POINTS %zu double\n", c->count);
    put_column(&c->columns, POINTS, out->output);
    fprintf(file, "VERTICES %zu %zu\n", c->count, 2 * c->count);
    tl_status status = tl_vtk_list(out, c->count, 2 * c->count * TL_VTK_INT_BYTES, fill_vertices, c);
    fprintf(file, "POINT_DATA %zu\nSCALARS normal_force double 1\nLOOKUP_TABLE default\n", c->count);
    put_column(&c->columns, NORMAL_FORCE, out->output);
    fprintf(file, "VECTORS shear_force double\n");
    put_column(&c->columns, SHEAR_FORCE, out->output);
    put_columns(&c->columns, out->output);
    return status;
}

tl_status tl_vtk_contacts(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out)
{
    contacts c = {.model = m};
    size_t meetings;
    tl_status status = tl_contacts_listed(m, &c.rows, &c.count, &meetings);
    if (status == TL_OK)
        status = tl_vtk_countable(2 * c.count, "contacts", &m->error);
    if (status == TL_OK)
        status = make_columns(&c.columns, m, &contact_list, c.count, parts, c.count);
    if (status == TL_OK) {
        tl_parallel_for(m->pool, c.count, CHUNK, fill_contacts, &c);
        status = put_contacts(&c, out);
    }
    free_columns(&c.columns);
    free(c.rows);
    return status;
}

/* ---------------------------------------------------------------- joints ----------------- */

/* A face that a joint made. */
typedef struct face {
    uint32_t block, face;
} face;

/* The polygons of the contacts, then the faces without one. */
typedef struct joints {
    const tl_model *model;
    uint32_t *rows; /* of contacts */
    size_t contacts;
    tl_contact_polygons of;
    uint32_t *contact; /* [of.polygons] number of its contact in rows */
    face *faces;
    size_t face_count;
    uint32_t *corner; /* [face_count + 1] number of a face's first corner, after those of the contacts */
    columns columns;
} joints;

/* Bits of faces with a flush contact, face by face of all blocks; `first` is where a block's begin. NULL: out of
 * memory. */
static unsigned char *mark_touching(const joints *j, const size_t *first, size_t faces)
{
    const tl_contacts *c = &j->model->detect->contacts;
    unsigned char *touching = calloc(faces + 1, 1);
    for (size_t i = 0; touching && i < j->contacts; i++) {
        uint32_t row = j->rows[i];
        if (tl_row_is_meeting(j->model, row)) {
            tl_meeting_mark(j->model, row, first, touching);
            continue;
        }
        if (c->facet[row].kind != TL_FACET_PATCH)
            continue;
        touching[first[c->a[row]] + c->facet[row].ia] = 1;
        touching[first[c->b[row]] + c->facet[row].ib] = 1;
    }
    return touching;
}

/* Lists the joints' faces that are not marked. */
static bool list_faces(joints *j, const size_t *first, const unsigned char *touching, size_t faces)
{
    const tl_blocks *b = &j->model->blocks;
    size_t count = 0, corner = 0;
    j->faces = malloc((faces + 1) * sizeof *j->faces);
    j->corner = malloc((faces + 1) * sizeof *j->corner);
    if (!j->faces || !j->corner)
        return false;
    for (uint32_t row = 0; row < b->table.rows; row++)
        for (uint32_t f = 0; f < b->shape[row]->face_count; f++)
            if (b->shape[row]->tag[f].joint != 0 && !touching[first[row] + f]) {
                j->faces[count] = (face){row, f};
                j->corner[count++] = (uint32_t)corner;
                corner += tl_poly_face_size(b->shape[row], f);
            }
    j->corner[count] = (uint32_t)corner;
    j->face_count = count;
    return true;
}

static bool find_faces(joints *j)
{
    const tl_blocks *b = &j->model->blocks;
    size_t *first = malloc((b->table.rows + 1) * sizeof *first), faces = 0;
    if (!first)
        return false;
    for (size_t row = 0; row < b->table.rows; row++) {
        first[row] = faces;
        faces += b->shape[row]->face_count;
    }
    unsigned char *touching = mark_touching(j, first, faces);
    bool found = touching && list_faces(j, first, touching, faces);
    free(touching);
    free(first);
    return found;
}

/* Notes of each polygon its contact. */
static bool note_contacts(joints *j)
{
    j->contact = malloc((j->of.polygons + 1) * sizeof *j->contact);
    for (size_t i = 0; j->contact && i < j->contacts; i++)
        for (uint32_t p = j->of.first[i]; p < j->of.first[i + 1]; p++)
            j->contact[p] = (uint32_t)i;
    return j->contact;
}

static size_t polygons_of(const joints *j)
{
    return j->of.polygons + j->face_count;
}

static size_t corners_of(const joints *j)
{
    return j->of.corners + j->corner[j->face_count];
}

static void fill_contact(const joints *j, size_t i)
{
    uint32_t row = j->rows[j->contact[i]];
    tl_contact_facts facts = tl_contact_facts_of(j->model, row);
    facts.slip = tl_law_states_slip(j->model, &j->columns.states, row, facts.shear_displacement);
    set_row(&j->columns, j->model, i, &facts, row, j->contact[i]);
}

static void fill_face(const joints *j, size_t i)
{
    const face *of = &j->faces[i - j->of.polygons];
    const tl_poly *shape = j->model->blocks.shape[of->block];
    const tl_contact_facts facts = {.a = j->model->blocks.id[of->block],
                                    .tag = shape->tag[of->face],
                                    .state = TL_NO_CONTACT,
                                    .area = tl_poly_face_area(shape, of->face)};
    set_row(&j->columns, j->model, i, &facts, TL_NO_ROW, 0);
}

static void fill_polygon_rows(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const joints *j = user;
    for (size_t i = begin; i < end; i++)
        if (i < j->of.polygons)
            fill_contact(j, i);
        else
            fill_face(j, i);
}

/* Vectors of the corners of a segment's outline, as points that move as its first block does as a whole. */
static unsigned char *put_segment(const joints *j, size_t i, uint32_t contact, tl_vtk_point_fn of, unsigned char *to)
{
    const tl_model *m = j->model;
    const uint32_t block = tl_block_row_quiet(m, tl_meeting_named(m, contact).a), body = m->blocks.body[block];
    for (uint32_t k = j->of.start[i]; k < j->of.start[i + 1]; k++) {
        const tl_vec3 arm = tl_v3_sub(j->of.corner[k], tl_body_place(&m->bodies, body));
        to = of(m, block, tl_m3_tmul(&m->bodies.pose[body].r, arm), to);
    }
    return to;
}

/* Vectors of the corners of a contact's polygon, as points of its first block. */
static unsigned char *put_contact(const joints *j, size_t i, tl_vtk_point_fn of, unsigned char *to)
{
    const tl_model *m = j->model;
    const uint32_t contact = j->rows[j->contact[i]];
    if (tl_row_is_meeting(m, contact))
        return put_segment(j, i, contact, of, to);
    const uint32_t side = tl_contact_sides(m, contact).a;
    for (uint32_t k = j->of.start[i]; k < j->of.start[i + 1]; k++)
        to = of(m, m->detect->contacts.a[contact], tl_side_local(m, side, j->of.corner[k]), to);
    return to;
}

static unsigned char *put_face(const joints *j, size_t i, tl_vtk_point_fn of, unsigned char *to)
{
    const face *one = &j->faces[i - j->of.polygons];
    const tl_poly *shape = j->model->blocks.shape[one->block];
    for (uint32_t k = shape->start[one->face]; k < shape->start[one->face + 1]; k++)
        to = of(j->model, one->block, shape->vertex[shape->loop[k]], to);
    return to;
}

/* Number of a polygon's first corner. */
static size_t first_corner(const joints *j, size_t i)
{
    return i < j->of.polygons ? j->of.start[i] : j->of.corners + j->corner[i - j->of.polygons];
}

/* A vector of each corner of polygons. */
static inline void fill_corners(const joints *j, size_t begin, size_t end, tl_piece *piece, tl_vtk_point_fn of,
                                size_t each)
{
    unsigned char *to = tl_piece_add(piece, (first_corner(j, end) - first_corner(j, begin)) * each);
    for (size_t i = begin; to && i < end; i++)
        to = i < j->of.polygons ? put_contact(j, i, of, to) : put_face(j, i, of, to);
}

static void fill_places(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_corners(user, begin, end, piece, tl_vtk_put_place, TL_VTK_VEC3_BYTES);
}

static void fill_displacements(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_corners(user, begin, end, piece, tl_vtk_put_moved, TL_VTK_FLOAT3_BYTES);
}

static void fill_polygons(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const joints *j = user;
    size_t numbers = end - begin + first_corner(j, end) - first_corner(j, begin);
    unsigned char *to = tl_piece_add(piece, numbers * TL_VTK_INT_BYTES);
    for (size_t i = begin; to && i < end; i++) {
        size_t first = first_corner(j, i), next = first_corner(j, i + 1);
        to = tl_vtk_put_int(to, (int32_t)(next - first));
        for (size_t k = first; k < next; k++)
            to = tl_vtk_put_int(to, (int32_t)k);
    }
}

static tl_status put_joints(const joints *j, tl_pieces *out)
{
    FILE *file = out->output->file;
    size_t polygons = polygons_of(j), points = corners_of(j);
    tl_vtk_header(file, j->model, "joints", "POLYDATA", true);
    fprintf(file, "POINTS %zu double\n", points);
    tl_status status = tl_vtk_list(out, polygons, points * TL_VTK_VEC3_BYTES, fill_places, j);
    fprintf(file, "POLYGONS %zu %zu\n", polygons, polygons + points);
    if (status == TL_OK)
        status = tl_vtk_list(out, polygons, (polygons + points) * TL_VTK_INT_BYTES, fill_polygons, j);
    fprintf(file, "CELL_DATA %zu\nSCALARS joint int 1\nLOOKUP_TABLE default\n", polygons);
    put_column(&j->columns, JOINT, out->output);
    put_columns(&j->columns, out->output);
    fprintf(file, "POINT_DATA %zu\nVECTORS displacement float\n", points);
    return status == TL_OK ? tl_vtk_list(out, polygons, points * TL_VTK_FLOAT3_BYTES, fill_displacements, j) : status;
}

static tl_status find_polygons(tl_model *m, joints *j)
{
    size_t meetings;
    tl_status status = tl_contacts_listed(m, &j->rows, &j->contacts, &meetings);
    if (status == TL_OK)
        status = tl_contact_polygons_find(m, j->rows, j->contacts, &j->of);
    if (status == TL_OK && !(note_contacts(j) && find_faces(j)))
        status = tl_fail_memory(&m->error);
    return status;
}

tl_status tl_vtk_joints(tl_model *m, const tl_vtk_parts *parts, tl_pieces *out)
{
    joints j = {.model = m};
    tl_status status = find_polygons(m, &j);
    if (status == TL_OK)
        status = tl_vtk_countable(polygons_of(&j) + corners_of(&j), "joints", &m->error);
    if (status == TL_OK)
        status = make_columns(&j.columns, m, &joint_list, polygons_of(&j), parts, j.contacts);
    if (status == TL_OK) {
        tl_parallel_for(m->pool, polygons_of(&j), CHUNK, fill_polygon_rows, &j);
        status = put_joints(&j, out);
    }
    free_columns(&j.columns);
    tl_contact_polygons_free(&j.of);
    free(j.contact);
    free(j.faces);
    free(j.corner);
    free(j.rows);
    return status;
}
