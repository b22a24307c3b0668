/* walls.c - the polygons in which a face of one block faces one of another, of different bodies.
 *
 * Both faces are seen along their mean normal n, which is unit and points from A to B. Their common outline is a convex
 * polygon. Its corners lie on each wall where a line along n meets that. The opening at a corner is the distance along
 * n from A's wall to B's. Its mean over the area is exact for plane walls: the fan rule. Of a deformable block each
 * triangle of a face is a wall. All walls are sought, also of one body: any may hide another (near_walls.c). */
#include "element/walls.h"

#include "base/error.h"
#include "element/near_walls.h"
#include "geometry/measure.h"
#include "geometry/point2.h"
#include "model/joints.h"
#include "narrow/flush.h"
#include "zone/grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elementary.h>

#define DEGREE (3.14159265358979323846 / 180)
#define MOST_CORNERS TL_POLY_MAX_VERTICES
/* Limit: joints that a filter names. */
#define MOST_JOINTS 64

/* What is looked for. */
typedef struct search {
    tl_placing *p;
    double gap, least_cosine;
    bool any;
    tl_tag joint[MOST_JOINTS];
    size_t joints;
    tl_wall_sides *sides; /* of each polygon */
    size_t side_capacity;
} search;

/* ---------------------------------------------------------------- walls of one block ----- */

static bool put_flat(tl_flats *f, const tl_flat *one, const tl_vec3 *corner, size_t count)
{
    if (!tl_grow(&f->at, &f->capacity, f->count + 1, sizeof *f->at) ||
        !tl_grow(&f->corner, &f->corner_capacity, f->corner_count + count, sizeof *f->corner))
        return false;
    f->at[f->count] = *one;
    f->at[f->count].corner = f->corner_count;
    f->at[f->count++].count = count;
    memcpy(f->corner + f->corner_count, corner, count * sizeof *corner);
    f->corner_count += count;
    return true;
}

static bool put_face(tl_flats *f, uint32_t row, uint32_t face, tl_vec3 *scratch)
{
    const tl_model *m = f->m;
    const tl_poly *shape = m->blocks.shape[row];
    const uint32_t body = m->blocks.body[row];
    const tl_vec3 n = tl_m3_mul(&m->bodies.pose[body].r, shape->plane[face].normal);
    const double offset = shape->plane[face].offset + tl_v3_dot(n, tl_body_place(&m->bodies, body));
    const tl_flat one = {m->blocks.id[row], row, face, shape->tag[face], {n, offset}, 0, 0};
    const size_t count = tl_poly_face_size(shape, face);
    for (size_t i = 0; i < count; i++)
        scratch[i] = tl_body_point(&m->bodies, body, shape->vertex[shape->loop[shape->start[face] + i]]);
    return put_flat(f, &one, scratch, count);
}

static bool put_triangles(tl_flats *f, uint32_t row, uint32_t face)
{
    const tl_model *m = f->m;
    size_t count;
    const tl_surface_part *part = tl_face_parts(m, m->blocks.id[row], face, &count);
    bool enough = true;
    for (size_t k = 0; part && k < count && enough; k++) {
        tl_vec3 x[3];
        for (int a = 0; a < 3; a++)
            x[a] = tl_gridpoint_place(&m->zones->points, part[k].corner[a]);
        const tl_vec3 n = tl_v3_unit(tl_v3_cross(tl_v3_sub(x[1], x[0]), tl_v3_sub(x[2], x[0])));
        const tl_flat one = {m->blocks.id[row],       row, face, m->blocks.shape[row]->tag[face],
                             {n, tl_v3_dot(n, x[0])}, 0,   0};
        enough = put_flat(f, &one, x, 3);
    }
    return enough;
}

static void widen(tl_bounds *box, tl_vec3 x)
{
    box->min = tl_v3(fmin(box->min.x, x.x), fmin(box->min.y, x.y), fmin(box->min.z, x.z));
    box->max = tl_v3(fmax(box->max.x, x.x), fmax(box->max.y, x.y), fmax(box->max.z, x.z));
}

/* Lists the walls of all blocks. Faces inside of a body are none. */
static bool list_flats(tl_flats *f, double gap)
{
    const tl_model *m = f->m;
    const size_t rows = m->blocks.table.rows;
    tl_vec3 *scratch = malloc(MOST_CORNERS * sizeof *scratch);
    f->first = malloc((rows + 1) * sizeof *f->first);
    f->box = malloc((rows + 1) * sizeof *f->box);
    bool enough = scratch && f->first && f->box;
    for (uint32_t row = 0; row < rows && enough; row++) {
        const tl_poly *shape = m->blocks.shape[row];
        f->first[row] = f->count;
        for (uint32_t face = 0; face < shape->face_count && enough; face++)
            if (tl_block_deforms(m, row))
                enough = put_triangles(f, row, face);
            else if (!shape->covered[face])
                enough = put_face(f, row, face, scratch);
        f->box[row] = (tl_bounds){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
        for (size_t k = f->first[row]; k < f->count; k++)
            for (size_t i = 0; i < f->at[k].count; i++)
                widen(&f->box[row], f->corner[f->at[k].corner + i]);
        const tl_vec3 more = tl_v3(0.5 * gap, 0.5 * gap, 0.5 * gap);
        f->box[row].min = tl_v3_sub(f->box[row].min, more);
        f->box[row].max = tl_v3_add(f->box[row].max, more);
    }
    if (enough)
        f->first[rows] = f->count;
    free(scratch);
    return enough;
}

/* ---------------------------------------------------------------- one pair of walls ------ */

/* A frame in which walls are seen: z along n. */
typedef struct frame {
    tl_vec3 at, x, y, n;
} frame;

static frame frame_of(tl_vec3 at, tl_vec3 n)
{
    const tl_vec3 x = tl_v3_perpendicular(n);
    return (frame){at, x, tl_v3_cross(n, x), n};
}

static tl_point2 seen(const frame *f, tl_vec3 x)
{
    const tl_vec3 d = tl_v3_sub(x, f->at);
    return (tl_point2){tl_v3_dot(d, f->x), tl_v3_dot(d, f->y)};
}

/* Where the line along n through a point of the frame meets a plane. */
static tl_vec3 on_plane(const frame *f, tl_point2 q, tl_plane plane)
{
    const tl_vec3 x = tl_v3_madd(tl_v3_madd(f->at, q.x, f->x), q.y, f->y);
    const double t = (plane.offset - tl_v3_dot(plane.normal, x)) / tl_v3_dot(plane.normal, f->n);
    return tl_v3_madd(x, t, f->n);
}

/* The common outline of two walls; its corners are in *out. */
static size_t common(tl_flats *f, const frame *in, const tl_flat *a, const tl_flat *b, const tl_point2 **out)
{
    const size_t most = a->count + b->count;
    for (int k = 0; k < 3; k++)
        if (!tl_grow(&f->point[k], &f->point_capacity[k], most, sizeof *f->point[k]))
            return SIZE_MAX;
    tl_point2 *now = f->point[0], *next = f->point[1], *by = f->point[2];
    for (size_t i = 0; i < a->count; i++)
        now[i] = seen(in, f->corner[a->corner + i]);
    for (size_t i = 0; i < b->count; i++)
        by[i] = seen(in, f->corner[b->corner + i]);
    const size_t count = tl_polygon_common(&now, &next, a->count, by, b->count);
    *out = now;
    return count;
}

/* Area, and mean over it of a number that is linear between the corners. */
static double mean_over(const tl_point2 *q, const double *value, size_t count, double *area)
{
    double sum = 0, twice = 0;
    for (size_t i = 2; i < count; i++) {
        const double part = tl_cross2(q[0], q[i - 1], q[i]);
        twice += part;
        sum += part * (value[0] + value[i - 1] + value[i]) / 3;
    }
    *area = 0.5 * twice;
    return twice > 0 ? sum / twice : 0;
}

static tl_point2 middle_of(const tl_point2 *q, size_t count)
{
    tl_point2 sum = {0, 0};
    for (size_t i = 0; i < count; i++)
        sum = (tl_point2){sum.x + q[i].x / (double)count, sum.y + q[i].y / (double)count};
    return sum;
}

/* Whether walls that overlap are those of two thin blocks on each other, and look away from each other. Then the
 * overlap is at least what both blocks measure. */
static bool look_away(const tl_flats *f, const frame *in, const tl_flat *a, const tl_flat *b, const tl_point2 *q,
                      size_t count, double overlap)
{
    const tl_point2 middle = middle_of(q, count);
    const tl_vec3 back = tl_v3_neg(in->n);
    return overlap > tl_flats_depth(f, a->row, on_plane(in, middle, a->plane), back) ||
           overlap > tl_flats_depth(f, b->row, on_plane(in, middle, b->plane), in->n);
}

static const char *joint_name(const tl_model *m, tl_tag tag)
{
    return tag.joint ? m->joints[tag.joint - 1].name : "";
}

/* Adds the polygon of two walls that face each other, if there is one. */
static bool put_wall(search *s, tl_flats *f, const tl_flat *a, const tl_flat *b, bool meant)
{
    tl_placing *p = s->p;
    const tl_model *m = f->m;
    const frame in = frame_of(f->corner[a->corner], tl_v3_unit(tl_v3_sub(a->plane.normal, b->plane.normal)));
    const tl_point2 *q;
    const size_t count = common(f, &in, a, b, &q);
    if (count == SIZE_MAX || !tl_grow(&f->point[3], &f->point_capacity[3], count, sizeof *f->point[3]))
        return false;
    if (count < 3)
        return true;
    if (!tl_grow(&p->wall_corner, &p->wall_corner_capacity, p->wall_corner_count + 2 * count, sizeof *p->wall_corner) ||
        !tl_grow(&p->wall, &p->wall_capacity, p->wall_count + 1, sizeof *p->wall) ||
        !tl_grow(&s->sides, &s->side_capacity, p->wall_count + 1, sizeof *s->sides))
        return false;
    double *opening = &f->point[3][0].x, area;
    tl_vec3 *on_a = p->wall_corner + p->wall_corner_count, *on_b = on_a + count;
    for (size_t i = 0; i < count; i++) {
        const tl_vec3 xa = on_plane(&in, q[i], a->plane), xb = on_plane(&in, q[i], b->plane);
        opening[i] = tl_v3_dot(in.n, tl_v3_sub(xb, xa));
        on_a[i] = tl_v3_add(m->origin, xa);
        on_b[i] = tl_v3_add(m->origin, xb);
    }
    const double mean = mean_over(q, opening, count, &area);
    const double size = fmin(m->blocks.size[a->row], m->blocks.size[b->row]);
    if (!(area > TL_WALL_NO_AREA * size * size) || fabs(mean) > s->gap)
        return true;
    if (area > TL_WALL_LEAST_HIDDEN * size * size && mean < 0 && look_away(f, &in, a, b, q, count, -mean))
        return true;
    s->sides[p->wall_count] = (tl_wall_sides){{(size_t)(a - f->at), (size_t)(b - f->at)}, meant};
    p->wall[p->wall_count++] = (tl_element_wall){.block = {a->block, b->block},
                                                 .face = {a->face, b->face},
                                                 .joint = joint_name(m, tl_flush_tag(a->tag, b->tag)),
                                                 .normal = {a->plane.normal, b->plane.normal},
                                                 .corner_count = count,
                                                 .area = area,
                                                 .opening = mean};
    p->wall_corner_count += 2 * count;
    return true;
}

static bool is_meant(const search *s, tl_tag tag)
{
    bool meant = s->any;
    for (size_t k = 0; k < s->joints && !meant; k++)
        meant = tl_tag_matches(s->joint[k], tag);
    return meant;
}

static bool try_pair(search *s, tl_flats *f, uint32_t row, uint32_t other)
{
    const uint32_t a_row = row < other ? row : other, b_row = row < other ? other : row;
    const bool apart = f->m->blocks.body[row] != f->m->blocks.body[other];
    bool enough = true;
    if (!tl_bounds_meet(&f->box[row], &f->box[other]))
        return true;
    for (size_t i = f->first[a_row]; i < f->first[a_row + 1]; i++)
        for (size_t k = f->first[b_row]; k < f->first[b_row + 1] && enough; k++) {
            const tl_flat *a = &f->at[i], *b = &f->at[k];
            if (-tl_v3_dot(a->plane.normal, b->plane.normal) >= s->least_cosine)
                enough = put_wall(s, f, a, b, apart && is_meant(s, tl_flush_tag(a->tag, b->tag)));
        }
    return enough;
}

/* ---------------------------------------------------------------- all pairs -------------- */

/* Rows by the low x of their boxes. */
typedef struct by_x {
    double x;
    uint32_t row;
} by_x;

static int compare_x(const void *a, const void *b)
{
    const by_x *p = a, *q = b;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    return p->row < q->row ? -1 : p->row > q->row;
}

static bool try_all(search *s, tl_flats *f)
{
    const size_t rows = f->m->blocks.table.rows;
    by_x *at = malloc((rows + 1) * sizeof *at);
    bool enough = at != NULL;
    for (uint32_t row = 0; row < rows && enough; row++)
        at[row] = (by_x){f->box[row].min.x, row};
    if (enough && rows > 1)
        qsort(at, rows, sizeof *at, compare_x);
    for (size_t i = 0; i < rows && enough; i++)
        for (size_t k = i + 1; k < rows && at[k].x <= f->box[at[i].row].max.x && enough; k++)
            enough = try_pair(s, f, at[i].row, at[k].row);
    free(at);
    return enough;
}

/* By blocks and faces; triangles of one face in the order of the search, which is that of their corners. */
static int compare_walls(const void *a, const void *b)
{
    const tl_element_wall *x = a, *y = b;
    for (int k = 0; k < 2; k++)
        if (x->block[k] != y->block[k])
            return x->block[k] < y->block[k] ? -1 : 1;
    for (int k = 0; k < 2; k++)
        if (x->face[k] != y->face[k])
            return x->face[k] < y->face[k] ? -1 : 1;
    return x->corners[0] < y->corners[0] ? -1 : x->corners[0] > y->corners[0];
}

static tl_status read_joints(search *s, const char *names)
{
    tl_model *m = s->p->m;
    char name[256];
    while (*names) {
        const size_t length = strcspn(names, ",");
        if (length >= sizeof name || s->joints == MOST_JOINTS)
            return tl_fail(&m->error, TL_E_ARGUMENT, "joints names more than %d joints, or one of more than %zu bytes",
                           MOST_JOINTS, sizeof name - 1);
        memcpy(name, names, length);
        name[length] = '\0';
        tl_tag tag = {0, 0};
        const tl_status status = tl_joint_parse(m, name, &tag);
        if (status != TL_OK)
            return status;
        s->any = s->any || tag.joint == 0;
        s->joint[s->joints++] = tag;
        names += length + (names[length] == ',');
    }
    return TL_OK;
}

/* Tells each polygon where its corners are, now that the list has found its place. */
static void find_corners(tl_placing *p)
{
    for (size_t k = 0, corner = 0; k < p->wall_count; k++) {
        p->wall[k].corners[0] = p->wall_corner + corner;
        p->wall[k].corners[1] = p->wall_corner + corner + p->wall[k].corner_count;
        corner += 2 * p->wall[k].corner_count;
    }
}

tl_status tl_walls_find(tl_placing *p, const tl_wall_filter *filter)
{
    tl_model *m = p->m;
    search s = {.p = p, .gap = filter->gap};
    tl_flats f = {.m = m};
    p->wall_count = p->wall_corner_count = 0;
    if (!(filter->gap >= 0 && isfinite(filter->gap)) || !(filter->angle >= 0 && filter->angle <= 45))
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "walls: gap = %g m must be at least 0 and finite, angle = %g degrees in [0, 45]", filter->gap,
                       filter->angle);
    const tl_status status = read_joints(&s, filter->joints);
    if (status != TL_OK)
        return status;
    s.least_cosine = tl_cos(filter->angle * DEGREE);
    bool enough = list_flats(&f, s.gap) && try_all(&s, &f);
    if (enough) {
        find_corners(p);
        enough = tl_walls_keep_near(p, &f, s.sides);
        find_corners(p);
    }
    if (enough && p->wall_count > 1)
        qsort(p->wall, p->wall_count, sizeof *p->wall, compare_walls);
    void *const owned[] = {f.at, f.corner, f.first, f.box, f.point[0], f.point[1], f.point[2], f.point[3], s.sides};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    return enough ? TL_OK : tl_fail_memory(&m->error);
}
