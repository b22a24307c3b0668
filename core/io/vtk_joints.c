/* vtk_joints.c - the joints of a frame: POLYDATA of polygons, one for each place where two blocks touch (contacts that are not
 * flush have several), and one for each face that a joint made and on which no contact lies any more. So what joints do shows
 * once and where it happens.
 *
 * Cell data  joint     index into the field joint_names; 0 where neither face was made by a joint
 *            plane     number of the plane within its joint set
 *            block_id, block_b   the blocks, the older first; block_b 0: a face without contact, of block_id
 *            contact_id          0: a face without contact
 *            state     0 elastic, 1 slipping, 2 open, 3 failed; 4 a face without contact
 *            normal_stress, shear_stress   Pa      normal_force   N, compression positive
 *            shear_force         N, vector, on block_b
 *            shear_displacement  m, vector: of block_b against block_id since creation or the last reset
 *            slip      m, the state "slip" of the contact's law, where it keeps one, else the length of shear_displacement
 *            area      m2 of the contact, of the face where there is none
 *            and each state of the laws by its name, one called as an array above with law_ in front; NaN where there is none
 * Point data displacement  m, that of block_id, as in the file of the blocks
 *
 * Without contact, stresses, forces and slip are 0. */
#include "io/vtk_joints.h"

#include "base/error.h"
#include "base/parallel.h"
#include "contact/detection.h"
#include "geometry/measure.h"
#include "io/extra_fields.h"
#include "io/pieces.h"
#include "io/vtk_columns.h"
#include "io/vtk_file.h"
#include "query/contact_fields.h"
#include "query/contact_polygons.h"
#include "query/point_fields.h"

#include <stdlib.h>

/* Polygons that a thread takes at a time. */
#define CHUNK 512
/* `state` of a face without contact. */
#define NO_CONTACT 4u

/* The columns of polygons, in the order of the file. */
enum {
    JOINT,
    FIELDS,
    PLANE = FIELDS,
    BLOCK_A,
    BLOCK_B,
    CONTACT,
    STATE,
    NORMAL_STRESS,
    SHEAR_STRESS,
    NORMAL_FORCE,
    SHEAR_FORCE,
    SHEAR_DISPLACEMENT,
    SLIP,
    AREA,
    COLUMNS
};

static const tl_vtk_column columns[COLUMNS] = {
    [JOINT] = {NULL, TL_VTK_INT, 1},
    [PLANE] = {"plane", TL_VTK_INT, 1},
    [BLOCK_A] = {"block_id", TL_VTK_INT, 1},
    [BLOCK_B] = {"block_b", TL_VTK_INT, 1},
    [CONTACT] = {"contact_id", TL_VTK_INT, 1},
    [STATE] = {"state", TL_VTK_INT, 1},
    [NORMAL_STRESS] = {"normal_stress", TL_VTK_FLOAT, 1},
    [SHEAR_STRESS] = {"shear_stress", TL_VTK_FLOAT, 1},
    [NORMAL_FORCE] = {"normal_force", TL_VTK_FLOAT, 1},
    [SHEAR_FORCE] = {"shear_force", TL_VTK_FLOAT, 3},
    [SHEAR_DISPLACEMENT] = {"shear_displacement", TL_VTK_FLOAT, 3},
    [SLIP] = {"slip", TL_VTK_FLOAT, 1},
    [AREA] = {"area", TL_VTK_FLOAT, 1},
};

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
    uint32_t
        *corner; /* [face_count + 1] number of a face's first corner, after those of the contacts */
    tl_vtk_columns columns;
} joints;

/* ---------------------------------------------------------------- what there is ---------- */

/* Bits of faces with a flush contact, face by face of all blocks; `first` is where a block's begin. NULL: out of memory. */
static unsigned char *mark_touching(const joints *j, const size_t *first, size_t faces)
{
    const tl_contacts *c = &j->model->detect->contacts;
    unsigned char *touching = calloc(faces + 1, 1);
    for (size_t i = 0; touching && i < j->contacts; i++) {
        uint32_t row = j->rows[i];
        if (!tl_facet_is_patch(&c->facet[row]))
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

/* ---------------------------------------------------------------- cell data -------------- */

static void fill_contact(const joints *j, size_t i)
{
    const tl_vtk_columns *c = &j->columns;
    uint32_t row = j->rows[j->contact[i]];
    tl_contact_facts facts = tl_contact_facts_of(j->model, row);
    tl_vtk_set_int(c, JOINT, i, facts.tag.joint);
    tl_vtk_set_int(c, PLANE, i, facts.tag.plane);
    tl_vtk_set_int(c, BLOCK_A, i, facts.a);
    tl_vtk_set_int(c, BLOCK_B, i, facts.b);
    tl_vtk_set_int(c, CONTACT, i, facts.id);
    tl_vtk_set_int(c, STATE, i, facts.state);
    tl_vtk_set_real(c, NORMAL_STRESS, i, facts.normal_stress);
    tl_vtk_set_real(c, SHEAR_STRESS, i, facts.shear_stress);
    tl_vtk_set_real(c, NORMAL_FORCE, i, facts.normal_force);
    tl_vtk_set_vec3(c, SHEAR_FORCE, i, facts.shear_force);
    tl_vtk_set_vec3(c, SHEAR_DISPLACEMENT, i, facts.shear_displacement);
    tl_vtk_set_real(c, SLIP, i,
                    tl_law_states_slip(j->model, &c->states, row, facts.shear_displacement));
    tl_vtk_set_real(c, AREA, i, facts.area);
    tl_vtk_set_rest(c, j->model, i, row, j->contact[i]);
}

static void fill_face(const joints *j, size_t i)
{
    const tl_vtk_columns *c = &j->columns;
    const face *of = &j->faces[i - j->of.polygons];
    const tl_poly *shape = j->model->blocks.shape[of->block];
    tl_vtk_set_int(c, JOINT, i, shape->tag[of->face].joint);
    tl_vtk_set_int(c, PLANE, i, shape->tag[of->face].plane);
    tl_vtk_set_int(c, BLOCK_A, i, j->model->blocks.id[of->block]);
    tl_vtk_set_int(c, BLOCK_B, i, 0);
    tl_vtk_set_int(c, CONTACT, i, 0);
    tl_vtk_set_int(c, STATE, i, NO_CONTACT);
    for (size_t k = NORMAL_STRESS; k < AREA; k++)
        for (unsigned w = 0; w < columns[k].width; w++)
            tl_vtk_set_real(c, k, columns[k].width * i + w, 0);
    tl_vtk_set_real(c, AREA, i, tl_poly_face_area(shape, of->face));
    tl_vtk_set_rest(c, j->model, i, TL_NO_ROW, 0);
}

static void fill_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    const joints *j = user;
    for (size_t i = begin; i < end; i++)
        if (i < j->of.polygons)
            fill_contact(j, i);
        else
            fill_face(j, i);
}

/* ---------------------------------------------------------------- points ----------------- */

/* Puts where a corner of a polygon is, or how far it has moved with the first block. */
typedef unsigned char *(*corner_fn)(const tl_model *m, uint32_t block, tl_vec3 local,
                                    unsigned char *to);

static unsigned char *put_place(const tl_model *m, uint32_t block, tl_vec3 local, unsigned char *to)
{
    return tl_vtk_put_vec3(to, tl_model_point(m, m->blocks.body[block], local));
}

static unsigned char *put_displacement(const tl_model *m, uint32_t block, tl_vec3 local,
                                       unsigned char *to)
{
    return tl_vtk_put_float3(to, tl_block_point_displacement(m, block, local));
}

static unsigned char *put_contact(const joints *j, size_t i, corner_fn of, unsigned char *to)
{
    const tl_model *m = j->model;
    uint32_t block = m->detect->contacts.a[j->rows[j->contact[i]]], body = m->blocks.body[block];
    for (uint32_t k = j->of.start[i]; k < j->of.start[i + 1]; k++) {
        to = of(m, block, tl_body_local(&m->bodies, body, j->of.corner[k]), to);
    }
    return to;
}

static unsigned char *put_face(const joints *j, size_t i, corner_fn of, unsigned char *to)
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
static inline void fill_corners(const joints *j, size_t begin, size_t end, tl_piece *piece,
                                corner_fn of, size_t each)
{
    size_t bytes = (first_corner(j, end) - first_corner(j, begin)) * each;
    unsigned char *to = tl_piece_reserve(piece, bytes);
    for (size_t i = begin; to && i < end; i++)
        to = i < j->of.polygons ? put_contact(j, i, of, to) : put_face(j, i, of, to);
    piece->length += to ? bytes : 0;
}

static void fill_places(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_corners(user, begin, end, piece, put_place, TL_VTK_VEC3_BYTES);
}

static void fill_displacements(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    fill_corners(user, begin, end, piece, put_displacement, TL_VTK_FLOAT3_BYTES);
}

static void fill_polygons(const void *user, size_t begin, size_t end, tl_piece *piece)
{
    const joints *j = user;
    size_t numbers = end - begin + first_corner(j, end) - first_corner(j, begin);
    unsigned char *to = tl_piece_reserve(piece, numbers * TL_VTK_INT_BYTES);
    for (size_t i = begin; to && i < end; i++) {
        size_t first = first_corner(j, i), next = first_corner(j, i + 1);
        to = tl_vtk_put_int(to, (int32_t)(next - first));
        for (size_t k = first; k < next; k++)
            to = tl_vtk_put_int(to, (int32_t)k);
    }
    piece->length += to ? numbers * TL_VTK_INT_BYTES : 0;
}

/* ---------------------------------------------------------------- the file --------------- */

/* A list that is made of the polygons, `bytes` in all. */
static tl_status put_list(const joints *j, tl_pieces *out, size_t bytes, tl_piece_fn fn)
{
    size_t polygons = polygons_of(j);
    tl_status status = tl_pieces_write(out, polygons, 1 + bytes / (polygons + 1), fn, j);
    tl_vtk_line(out->output->file);
    return status;
}

static tl_status put_joints(const joints *j, tl_pieces *out)
{
    FILE *file = out->output->file;
    size_t polygons = polygons_of(j), points = corners_of(j);
    tl_vtk_header(file, j->model, "joints", "POLYDATA");
    fprintf(file, "POINTS %zu double\n", points);
    tl_status status = put_list(j, out, points * TL_VTK_VEC3_BYTES, fill_places);
    fprintf(file, "POLYGONS %zu %zu\n", polygons, polygons + points);
    if (status == TL_OK)
        status = put_list(j, out, (polygons + points) * TL_VTK_INT_BYTES, fill_polygons);
    fprintf(file, "CELL_DATA %zu\nSCALARS joint int 1\nLOOKUP_TABLE default\n", polygons);
    tl_vtk_put_column(&j->columns, JOINT, out->output);
    tl_vtk_put_columns(&j->columns, FIELDS, out->output);
    fprintf(file, "POINT_DATA %zu\nVECTORS displacement float\n", points);
    return status == TL_OK ? put_list(j, out, points * TL_VTK_FLOAT3_BYTES, fill_displacements)
                           : status;
}

static tl_status find_polygons(tl_model *m, joints *j)
{
    tl_status status = tl_contacts_listed(m, &j->rows, &j->contacts);
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
        status =
            tl_extra_fields_check("write_vtk: contact_fields", parts->contact_fields,
                                  parts->contact_field_count, j.contacts, "contacts", &m->error);
    if (status == TL_OK)
        status = tl_vtk_columns_make(&j.columns, m, columns, COLUMNS, TL_VTK_FLOAT, polygons_of(&j),
                                     parts->contact_fields, parts->contact_field_count);
    if (status == TL_OK) {
        tl_parallel_for(m->pool, polygons_of(&j), CHUNK, fill_range, &j);
        status = put_joints(&j, out);
    }
    tl_vtk_columns_free(&j.columns);
    tl_contact_polygons_free(&j.of);
    free(j.contact);
    free(j.faces);
    free(j.corner);
    free(j.rows);
    return status;
}
