/* vtk_section.c - a section: POLYDATA of the polygons in which a plane cuts the blocks.
 *
 * Cell data   block_id  id of the block
 *             group     index into the field group_names
 *             body      id of its body
 *             hidden    1 when hidden
 *             displacement, displacement_in_plane     of the polygon's middle, m
 * Point data  displacement              m, since creation or the last reset
 *             displacement_in_plane     the same without its part normal to the plane
 *
 * A vertex on the plane counts as above it, so a face that lies in the plane is shown once: of the
 * block below. Points closer than TL_POLY_ON times the block's size are one. */
#include "io/vtk_section.h"

#include "base/error.h"
#include "io/pieces.h"
#include "io/vtk_file.h"

#include <stdlib.h>

typedef struct corner {
    tl_vec3 at; /* in the body's frame */
    double angle;
} corner;

/* The polygons of a section, one after the other. */
typedef struct section {
    tl_vec3 normal;
    corner *corners;
    uint32_t *row, *end; /* [polygons] block row; end of its corners */
    size_t points, point_capacity, polygons, row_capacity, end_capacity;
} section;

static bool reserve_corners(section *s, size_t corners)
{
    return tl_grow(&s->corners, &s->point_capacity, s->points + corners, sizeof *s->corners) &&
           tl_grow(&s->row, &s->row_capacity, s->polygons + 1, sizeof *s->row) &&
           tl_grow(&s->end, &s->end_capacity, s->polygons + 1, sizeof *s->end);
}

static int by_angle(const void *a, const void *b)
{
    double x = ((const corner *)a)->angle, y = ((const corner *)b)->angle;
    return (x > y) - (x < y);
}

/* Where the edges of a shape pass from below the plane to above. */
static size_t find_corners(const tl_poly *p, tl_plane plane, corner *list)
{
    double on = TL_POLY_ON * p->size;
    size_t count = 0;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        tl_vec3 a = p->vertex[p->edge[e].a], b = p->vertex[p->edge[e].b];
        double da = tl_v3_dot(plane.normal, a) - plane.offset;
        double db = tl_v3_dot(plane.normal, b) - plane.offset;
        if ((da < -on) == (db < -on))
            continue;
        double t = fmin(1, fmax(0, da / (da - db)));
        list[count++].at = tl_v3_madd(a, t, tl_v3_sub(b, a));
    }
    return count;
}

/* Brings the corners of a convex polygon into order, counter-clockwise as seen from above the plane,
 * each once; returns how many are left. */
static size_t order_corners(tl_vec3 normal, double on, corner *list, size_t count)
{
    tl_vec3 sum = {0, 0, 0};
    for (size_t i = 0; i < count; i++)
        sum = tl_v3_add(sum, tl_v3_sub(list[i].at, list[0].at));
    tl_vec3 middle = tl_v3_madd(list[0].at, 1.0 / (double)count, sum);
    tl_vec3 t1 = tl_v3_perpendicular(normal), t2 = tl_v3_cross(normal, t1);
    for (size_t i = 0; i < count; i++) {
        tl_vec3 arm = tl_v3_sub(list[i].at, middle);
        list[i].angle = tl_atan2(tl_v3_dot(arm, t2), tl_v3_dot(arm, t1));
    }
    qsort(list, count, sizeof *list, by_angle);
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || tl_v3_norm(tl_v3_sub(list[i].at, list[kept - 1].at)) > on)
            list[kept++] = list[i];
    while (kept > 1 && tl_v3_norm(tl_v3_sub(list[kept - 1].at, list[0].at)) <= on)
        kept--;
    return kept;
}

static bool cut_blocks(const tl_model *m, tl_plane plane, section *s)
{
    const tl_blocks *b = &m->blocks;
    for (uint32_t row = 0; row < b->table.rows; row++) {
        uint32_t body = b->body[row];
        const tl_poly *shape = b->shape[row];
        tl_plane local = {tl_m3_tmul(&m->bodies.pose[body].r, plane.normal),
                          plane.offset - tl_v3_dot(plane.normal, tl_body_place(&m->bodies, body))};
        if (!reserve_corners(s, shape->edge_count))
            return false;
        corner *list = s->corners + s->points;
        size_t count = find_corners(shape, local, list);
        if (count < 3 ||
            (count = order_corners(local.normal, TL_POLY_ON * shape->size, list, count)) < 3)
            continue;
        s->points += count;
        s->row[s->polygons] = row;
        s->end[s->polygons++] = (uint32_t)s->points;
    }
    return true;
}

static void put_shape(const tl_model *m, const section *s, FILE *file)
{
    fprintf(file, "POINTS %zu double\n", s->points);
    size_t at = 0;
    for (size_t i = 0; i < s->polygons; i++)
        for (; at < s->end[i]; at++)
            tl_vtk_vec3(file, tl_model_point(m, m->blocks.body[s->row[i]], s->corners[at].at));
    fprintf(file, "\nPOLYGONS %zu %zu\n", s->polygons, s->polygons + s->points);
    int32_t next = 0;
    for (size_t i = 0; i < s->polygons; i++) {
        tl_vtk_int(file, (int32_t)s->end[i] - next);
        while (next < (int32_t)s->end[i])
            tl_vtk_int(file, next++);
    }
    tl_vtk_line(file);
}

static tl_vec3 in_plane(tl_vec3 normal, tl_vec3 v)
{
    return tl_v3_madd(v, -tl_v3_dot(v, normal), normal);
}

static tl_vec3 middle_displacement(const tl_model *m, const section *s, size_t polygon)
{
    size_t begin = polygon ? s->end[polygon - 1] : 0, end = s->end[polygon];
    tl_vec3 sum = {0, 0, 0};
    for (size_t at = begin; at < end; at++)
        sum = tl_v3_add(sum, tl_v3_sub(s->corners[at].at, s->corners[begin].at));
    tl_vec3 middle = tl_v3_madd(s->corners[begin].at, 1.0 / (double)(end - begin), sum);
    return tl_block_point_displacement(m, s->row[polygon], middle);
}

static void put_cell_data(const tl_model *m, const section *s, FILE *file)
{
    const tl_blocks *b = &m->blocks;
    fprintf(file, "CELL_DATA %zu\nSCALARS block_id int 1\nLOOKUP_TABLE default\n", s->polygons);
    for (size_t i = 0; i < s->polygons; i++)
        tl_vtk_int(file, (int32_t)b->id[s->row[i]]);
    fprintf(file, "\nVECTORS displacement double\n");
    for (size_t i = 0; i < s->polygons; i++)
        tl_vtk_vec3(file, middle_displacement(m, s, i));
    tl_vtk_line(file);
    tl_vtk_field(file, "FieldData", 4);
    tl_vtk_array(file, "group", 1, s->polygons, TL_VTK_INT);
    for (size_t i = 0; i < s->polygons; i++)
        tl_vtk_int(file, (int32_t)b->group[s->row[i]]);
    tl_vtk_line(file);
    tl_vtk_array(file, "body", 1, s->polygons, TL_VTK_INT);
    for (size_t i = 0; i < s->polygons; i++)
        tl_vtk_int(file, (int32_t)m->bodies.id[b->body[s->row[i]]]);
    tl_vtk_line(file);
    tl_vtk_array(file, "hidden", 1, s->polygons, TL_VTK_INT);
    for (size_t i = 0; i < s->polygons; i++)
        tl_vtk_int(file, b->hidden[s->row[i]] != 0);
    tl_vtk_line(file);
    tl_vtk_array(file, "displacement_in_plane", 3, s->polygons, TL_VTK_DOUBLE);
    for (size_t i = 0; i < s->polygons; i++)
        tl_vtk_vec3(file, in_plane(s->normal, middle_displacement(m, s, i)));
    tl_vtk_line(file);
}

static void put_point_data(const tl_model *m, const section *s, FILE *file)
{
    fprintf(file, "POINT_DATA %zu\nVECTORS displacement double\n", s->points);
    for (size_t i = 0, at = 0; i < s->polygons; i++)
        for (; at < s->end[i]; at++)
            tl_vtk_vec3(file, tl_block_point_displacement(m, s->row[i], s->corners[at].at));
    tl_vtk_line(file);
    tl_vtk_field(file, "FieldData", 1);
    tl_vtk_array(file, "displacement_in_plane", 3, s->points, TL_VTK_DOUBLE);
    for (size_t i = 0, at = 0; i < s->polygons; i++)
        for (; at < s->end[i]; at++)
            tl_vtk_vec3(file, in_plane(s->normal, tl_block_point_displacement(m, s->row[i],
                                                                              s->corners[at].at)));
    tl_vtk_line(file);
}

tl_status tl_vtk_section(tl_model *m, tl_plane plane, tl_pieces *out)
{
    FILE *file = out->output->file;
    section s = {.normal = plane.normal};
    tl_status status = cut_blocks(m, plane, &s) ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = tl_vtk_countable(s.polygons + s.points, "section", &m->error);
    if (status == TL_OK) {
        tl_vtk_header(file, m, "section", "POLYDATA");
        put_shape(m, &s, file);
        put_cell_data(m, &s, file);
        put_point_data(m, &s, file);
    }
    free(s.corners);
    free(s.row);
    free(s.end);
    return status;
}
