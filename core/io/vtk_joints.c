/* vtk_joints.c - the joint faces of a frame: POLYDATA of polygons, one for each block face that a
 * joint made (so two for each place where two blocks still touch).
 *
 * Cell data  joint     index into the field joint_names
 *            plane     number of the plane within its joint set
 *            block_id  id of the block the face belongs to
 * Point data displacement  m, as in the file of the blocks */
#include "io/vtk_data.h"
#include "io/vtk_file.h"

typedef struct face_ref {
    uint32_t row, face;
} face_ref;

/* Steps to the next tagged face at or after `at`; false past the last. */
static bool find_face(const tl_blocks *b, face_ref *at)
{
    for (; at->row < b->table.rows; at->row++, at->face = 0)
        for (; at->face < b->shape[at->row]->face_count; at->face++)
            if (b->shape[at->row]->tag[at->face].joint != 0)
                return true;
    return false;
}

static void put_shape(const tl_model *m, size_t polygons, size_t points, FILE *file)
{
    const tl_blocks *b = &m->blocks;
    fprintf(file, "POINTS %zu double\n", points);
    for (face_ref at = {0, 0}; find_face(b, &at); at.face++) {
        const tl_poly *shape = b->shape[at.row];
        for (uint32_t i = shape->start[at.face]; i < shape->start[at.face + 1]; i++)
            tl_vtk_vec3(file, tl_model_point(m, b->body[at.row], shape->vertex[shape->loop[i]]));
    }
    fprintf(file, "\nPOLYGONS %zu %zu\n", polygons, polygons + points);
    int32_t next = 0;
    for (face_ref at = {0, 0}; find_face(b, &at); at.face++) {
        int32_t size = (int32_t)tl_poly_face_size(b->shape[at.row], at.face);
        tl_vtk_int(file, size);
        for (int32_t i = 0; i < size; i++)
            tl_vtk_int(file, next++);
    }
    tl_vtk_line(file);
}

static void put_data(const tl_model *m, size_t polygons, size_t points, FILE *file)
{
    const tl_blocks *b = &m->blocks;
    fprintf(file, "CELL_DATA %zu\nSCALARS joint int 1\nLOOKUP_TABLE default\n", polygons);
    for (face_ref at = {0, 0}; find_face(b, &at); at.face++)
        tl_vtk_int(file, (int32_t)b->shape[at.row]->tag[at.face].joint);
    tl_vtk_line(file);
    tl_vtk_field(file, "FieldData", 2);
    tl_vtk_array(file, "plane", 1, polygons, TL_VTK_INT);
    for (face_ref at = {0, 0}; find_face(b, &at); at.face++)
        tl_vtk_int(file, (int32_t)b->shape[at.row]->tag[at.face].plane);
    tl_vtk_line(file);
    tl_vtk_array(file, "block_id", 1, polygons, TL_VTK_INT);
    for (face_ref at = {0, 0}; find_face(b, &at); at.face++)
        tl_vtk_int(file, (int32_t)b->id[at.row]);
    tl_vtk_line(file);

    fprintf(file, "POINT_DATA %zu\nVECTORS displacement double\n", points);
    for (face_ref at = {0, 0}; find_face(b, &at); at.face++) {
        const tl_poly *shape = b->shape[at.row];
        for (uint32_t i = shape->start[at.face]; i < shape->start[at.face + 1]; i++)
            tl_vtk_vec3(file,
                        tl_block_point_displacement(m, at.row, shape->vertex[shape->loop[i]]));
    }
    tl_vtk_line(file);
}

tl_status tl_vtk_joints(tl_model *m, FILE *file)
{
    const tl_blocks *b = &m->blocks;
    size_t polygons = 0, points = 0;
    for (face_ref at = {0, 0}; find_face(b, &at); at.face++) {
        polygons++;
        points += tl_poly_face_size(b->shape[at.row], at.face);
    }
    tl_status status = tl_vtk_countable(polygons + points, "joint faces", &m->error);
    if (status != TL_OK)
        return status;
    tl_vtk_header(file, m, "joint faces", "POLYDATA");
    put_shape(m, polygons, points, file);
    put_data(m, polygons, points, file);
    return TL_OK;
}
