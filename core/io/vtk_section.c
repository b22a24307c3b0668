/* vtk_section.c - a section: POLYDATA of the polygons in which a plane cuts rigid blocks, and the zones of deformable
 * ones.
 *
 * Rigid blocks come first, in the order of their rows, then zones in the order of zone_list.h.
 *
 * Cell data   block_id  id of the block
 *             group     index into the field group_names
 *             body      id of its body
 *             hidden    1 when hidden
 *             displacement, displacement_in_plane     of the polygon's middle, m
 *             and where blocks are deformable the arrays of zones (vtk_zones.c): NaN, or -1, of rigid blocks
 * Point data  displacement              m, since creation or the last reset
 *             displacement_in_plane     the same without its part normal to the plane
 *
 * A vertex on the plane counts as above it, so a face that lies in the plane is shown once: of the block, or zone,
 * below. Points closer than TL_POLY_ON times the block's size are one. */
#include "io/vtk_section.h"

#include "base/columns.h"
#include "base/error.h"
#include "io/vtk_file.h"
#include "io/vtk_zones.h"
#include "model/rows.h"
#include "query/block_fields.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <talus/elementary.h>

typedef struct corner {
    tl_vec3 at;    /* of a rigid block in the body's frame, of a zone from the model's origin, m */
    tl_vec3 moved; /* of a zone: its displacement, m */
    double angle;
} corner;

/* The polygons of a section, one after the other. */
typedef struct section {
    tl_vec3 normal;
    corner *corners;
    struct polygon {
        uint32_t row, end; /* of its block; of its corners */
    } * of;
    uint32_t *zone; /* of each polygon its number in the list, or TL_NO_ROW */
    size_t points, point_capacity, polygons, polygon_capacity, zone_capacity;
    tl_zone_list list;
} section;

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

/* Makes room for one more polygon of up to so many corners. */
static bool hold_polygon(section *s, size_t corners)
{
    return tl_grow(&s->corners, &s->point_capacity, s->points + corners, sizeof *s->corners) &&
           tl_grow(&s->of, &s->polygon_capacity, s->polygons + 1, sizeof *s->of) &&
           tl_grow(&s->zone, &s->zone_capacity, s->polygons + 1, sizeof *s->zone);
}

/* Adds the polygon of the `count` corners that lie behind those of the others, if it is one. */
static void add_polygon(section *s, tl_vec3 normal, double on, size_t count, uint32_t row, uint32_t zone)
{
    if (count < 3 || (count = order_corners(normal, on, s->corners + s->points, count)) < 3)
        return;
    s->points += count;
    s->zone[s->polygons] = zone;
    s->of[s->polygons++] = (struct polygon){row, (uint32_t)s->points};
}

static bool cut_blocks(const tl_model *m, tl_plane plane, section *s)
{
    const tl_blocks *b = &m->blocks;
    for (uint32_t row = 0; row < b->table.rows; row++) {
        uint32_t body = b->body[row];
        if (m->zones && m->bodies.mesh[body] != 0)
            continue;
        const tl_poly *shape = b->shape[row];
        tl_plane local = {tl_m3_tmul(&m->bodies.pose[body].r, plane.normal),
                          plane.offset - tl_v3_dot(plane.normal, tl_body_place(&m->bodies, body))};
        if (!hold_polygon(s, shape->edge_count))
            return false;
        size_t count = find_corners(shape, local, s->corners + s->points);
        add_polygon(s, local.normal, TL_POLY_ON * shape->size, count, row, TL_NO_ROW);
    }
    return true;
}

/* Where the edges of a zone pass from below the plane to above. */
static size_t find_zone_corners(const tl_zone_list *l, size_t zone, tl_plane plane, double on, corner *list)
{
    const tl_gridpoints *points = &l->of->points;
    tl_vec3 x[4], u[4];
    double d[4];
    size_t count = 0;
    for (int a = 0; a < 4; a++) {
        const uint32_t row = tl_zone_list_corner(l, zone, a);
        x[a] = tl_gridpoint_place(points, row);
        u[a] = tl_columns_get(points->u, row);
        d[a] = tl_v3_dot(plane.normal, x[a]) - plane.offset;
    }
    for (int a = 0; a < 4; a++)
        for (int b = a + 1; b < 4; b++) {
            if ((d[a] < -on) == (d[b] < -on))
                continue;
            const double t = fmin(1, fmax(0, d[a] / (d[a] - d[b])));
            list[count].at = tl_v3_madd(x[a], t, tl_v3_sub(x[b], x[a]));
            list[count++].moved = tl_v3_madd(u[a], t, tl_v3_sub(u[b], u[a]));
        }
    return count;
}

/* A plane cuts no more edges of a zone. */
#define ZONE_CORNERS 4

static bool cut_zones(const tl_model *m, tl_plane plane, section *s)
{
    const tl_zone_list *l = &s->list;
    for (size_t zone = 0; zone < l->zones; zone++) {
        const uint32_t row = tl_block_row_quiet(m, l->of->parcels.of[l->parcel[zone]].block);
        const double on = TL_POLY_ON * m->blocks.shape[row]->size;
        if (!hold_polygon(s, ZONE_CORNERS))
            return false;
        const size_t count = find_zone_corners(l, zone, plane, on, s->corners + s->points);
        add_polygon(s, plane.normal, on, count, row, (uint32_t)zone);
    }
    return true;
}

/* Where corner `at` of a polygon is. */
static tl_vec3 corner_place(const tl_model *m, const section *s, size_t polygon, size_t at)
{
    return s->zone[polygon] == TL_NO_ROW ? tl_model_point(m, m->blocks.body[s->of[polygon].row], s->corners[at].at)
                                         : tl_v3_add(m->origin, s->corners[at].at);
}

static tl_vec3 corner_moved(const tl_model *m, const section *s, size_t polygon, size_t at)
{
    return s->zone[polygon] == TL_NO_ROW ? tl_block_point_displacement(m, s->of[polygon].row, s->corners[at].at)
                                         : s->corners[at].moved;
}

static void write_int(FILE *file, int32_t value)
{
    unsigned char bytes[TL_VTK_INT_BYTES];
    tl_vtk_put_int(bytes, value);
    fwrite(bytes, 1, sizeof bytes, file);
}

static void write_vec3(FILE *file, tl_vec3 value)
{
    unsigned char bytes[TL_VTK_VEC3_BYTES];
    tl_vtk_put_vec3(bytes, value);
    fwrite(bytes, 1, sizeof bytes, file);
}

static void put_polygons(const tl_model *m, const section *s, FILE *file)
{
    fprintf(file, "POINTS %zu double\n", s->points);
    size_t at = 0;
    for (size_t i = 0; i < s->polygons; i++)
        for (; at < s->of[i].end; at++)
            write_vec3(file, corner_place(m, s, i, at));
    fprintf(file, "\nPOLYGONS %zu %zu\n", s->polygons, s->polygons + s->points);
    int32_t next = 0;
    for (size_t i = 0; i < s->polygons; i++) {
        write_int(file, (int32_t)s->of[i].end - next);
        while (next < (int32_t)s->of[i].end)
            write_int(file, next++);
    }
    tl_vtk_line(file);
}

static tl_vec3 in_plane(tl_vec3 normal, tl_vec3 v)
{
    return tl_v3_madd(v, -tl_v3_dot(v, normal), normal);
}

static tl_vec3 middle_displacement(const tl_model *m, const section *s, size_t polygon)
{
    size_t begin = polygon ? s->of[polygon - 1].end : 0, end = s->of[polygon].end;
    tl_vec3 sum = {0, 0, 0};
    if (s->zone[polygon] != TL_NO_ROW) { /* it is linear in a zone */
        for (size_t at = begin; at < end; at++)
            sum = tl_v3_add(sum, s->corners[at].moved);
        return tl_v3_scale(1.0 / (double)(end - begin), sum);
    }
    for (size_t at = begin; at < end; at++)
        sum = tl_v3_add(sum, tl_v3_sub(s->corners[at].at, s->corners[begin].at));
    tl_vec3 middle = tl_v3_madd(s->corners[begin].at, 1.0 / (double)(end - begin), sum);
    return tl_block_point_displacement(m, s->of[polygon].row, middle);
}

/* A quantity of the blocks that is a whole number. */
static void put_whole(const tl_model *m, const section *s, const char *name, FILE *file)
{
    for (size_t i = 0; i < s->polygons; i++) {
        double value[6];
        tl_block_numbers(m, s->of[i].row, tl_block_quantity(name), value);
        write_int(file, (int32_t)(uint32_t)value[0]);
    }
    tl_vtk_line(file);
}

static void put_section_cells(const tl_model *m, const section *s, FILE *file)
{
    fprintf(file, "CELL_DATA %zu\nSCALARS block_id int 1\nLOOKUP_TABLE default\n", s->polygons);
    put_whole(m, s, "id", file);
    fprintf(file, "VECTORS displacement double\n");
    for (size_t i = 0; i < s->polygons; i++)
        write_vec3(file, middle_displacement(m, s, i));
    tl_vtk_line(file);
    tl_vtk_field(file, "FieldData", 4);
    static const char *const names[] = {"group", "body", "hidden"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        tl_vtk_array(file, names[k], 1, s->polygons, TL_VTK_INT);
        put_whole(m, s, names[k], file);
    }
    tl_vtk_array(file, "displacement_in_plane", 3, s->polygons, TL_VTK_DOUBLE);
    for (size_t i = 0; i < s->polygons; i++)
        write_vec3(file, in_plane(s->normal, middle_displacement(m, s, i)));
    tl_vtk_line(file);
}

/* Displacements of the points, or what they are in the plane. */
static void put_displacements(const tl_model *m, const section *s, bool all, FILE *file)
{
    for (size_t i = 0, at = 0; i < s->polygons; i++)
        for (; at < s->of[i].end; at++) {
            tl_vec3 moved = corner_moved(m, s, i, at);
            write_vec3(file, all ? moved : in_plane(s->normal, moved));
        }
    tl_vtk_line(file);
}

static void put_point_data(const tl_model *m, const section *s, FILE *file)
{
    fprintf(file, "POINT_DATA %zu\nVECTORS displacement double\n", s->points);
    put_displacements(m, s, true, file);
    tl_vtk_field(file, "FieldData", 1);
    tl_vtk_array(file, "displacement_in_plane", 3, s->points, TL_VTK_DOUBLE);
    put_displacements(m, s, false, file);
}

static tl_status find_polygons(tl_model *m, tl_plane plane, section *s)
{
    tl_status status = cut_blocks(m, plane, s) ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK && tl_model_deforms(m)) {
        status = tl_zone_list_make(m, &s->list);
        if (status == TL_OK && !cut_zones(m, plane, s))
            status = tl_fail_memory(&m->error);
    }
    return status == TL_OK ? tl_vtk_countable(s->polygons + s->points, "section", &m->error) : status;
}

tl_status tl_vtk_section(tl_model *m, tl_plane plane, tl_pieces *out)
{
    FILE *file = out->output->file;
    section s = {.normal = plane.normal};
    tl_status status = find_polygons(m, plane, &s);
    if (status == TL_OK) {
        tl_vtk_header(file, m, "section", "POLYDATA", false);
        put_polygons(m, &s, file);
        put_section_cells(m, &s, file);
        if (tl_model_deforms(m))
            status = tl_vtk_picked_zones(m, &s.list, s.zone, s.polygons, out);
    }
    if (status == TL_OK)
        put_point_data(m, &s, file);
    free(s.corners);
    free(s.of);
    free(s.zone);
    tl_zone_list_free(&s.list);
    return status;
}
