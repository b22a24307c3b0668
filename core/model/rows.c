/* rows.c - rows of blocks and bodies, and what is derived from shapes: volume, mass, inertia.
 *
 * The paper's one moment of inertia (20) is printed without its coefficient. Talus takes 0.4 m r^2, that of a ball,
 * with r the mean distance from centroid to vertices. */
#include "model/rows.h"

#include "model/body_shape.h"
#include "model/deformable.h"
#include "model/inertia.h"
#include "model/loads.h"

#include <stdlib.h>
#include <string.h>

/* Constant: inertia (20) of the paper over m r^2, that of a ball. The paper does not print it. */
#define ROUND_COEFFICIENT 0.4

bool tl_rows_reserve(tl_model *m, size_t count)
{
    if (!tl_table_reserve(&m->blocks.table, count) || !tl_table_reserve(&m->bodies.table, count))
        return false;
    /* by an eighth more than is needed: blocks may come one by one */
    return count + 1 <= m->member_capacity ||
           tl_fit(&m->members, &m->member_capacity, count + count / 8 + 1, sizeof *m->members);
}

void tl_rows_refresh(tl_model *m)
{
    tl_blocks *blocks = &m->blocks;
    tl_bodies *bodies = &m->bodies;
    for (uint32_t body = 0; body < bodies->table.rows; body++)
        bodies->member_count[body] = 0;
    for (uint32_t row = 0; row < blocks->table.rows; row++)
        bodies->member_count[blocks->body[row]]++;
    uint32_t start = 0;
    for (uint32_t body = 0; body < bodies->table.rows; body++) {
        bodies->member_start[body] = start;
        start += bodies->member_count[body];
        bodies->member_count[body] = 0;
    }
    for (uint32_t row = 0; row < blocks->table.rows; row++) {
        uint32_t body = blocks->body[row];
        m->members[bodies->member_start[body] + bodies->member_count[body]++] = row;
    }
    m->structure++;
}

/* Removes the blocks with keep[row] == 0, and bodies left without blocks. Their shapes are the caller's. */
static void rows_keep(tl_model *m, const unsigned char *keep)
{
    tl_blocks *blocks = &m->blocks;
    tl_bodies *bodies = &m->bodies;
    size_t body_count = bodies->table.rows;
    /* The two lists written here are rebuilt by tl_rows_refresh: they serve as scratch until then. */
    uint32_t *new_row = m->members;
    for (size_t body = 0; body < body_count; body++)
        bodies->member_count[body] = 0;
    for (uint32_t row = 0; row < blocks->table.rows; row++) {
        if (keep[row])
            bodies->member_count[blocks->body[row]]++;
    }
    uint32_t kept = 0;
    for (uint32_t body = 0; body < body_count; body++) {
        new_row[body] = bodies->member_count[body] ? kept++ : TL_NO_ROW;
        if (new_row[body] == TL_NO_ROW)
            tl_drive_leave(m, body);
    }
    for (uint32_t row = 0; row < blocks->table.rows; row++)
        blocks->body[row] = new_row[blocks->body[row]];
    tl_table_keep(&blocks->table, keep);
    for (uint32_t body = 0; body < body_count; body++)
        if (new_row[body] != TL_NO_ROW && new_row[body] != body)
            tl_table_move(&bodies->table, new_row[body], body);
    bodies->table.rows = kept;
    tl_rows_refresh(m);
    for (uint32_t body = 0; body < kept; body++)
        bodies->id[body] = blocks->id[m->members[bodies->member_start[body]]];
}

void tl_rows_tidy(tl_model *m)
{
    if (m->gone)
        rows_keep(m, m->blocks.stays); /* what is read of it has not moved yet */
    m->gone = 0;
    if (m->zone_verbs)
        m->zone_verbs->follow(m);
    if (m->segments_follow)
        m->segments_follow(m);
}

/* Derives a block's size and mean face from its shape, whose volume is given. */
static void measure_block(tl_model *m, uint32_t row, double volume)
{
    tl_blocks *b = &m->blocks;
    const tl_poly *shape = b->shape[row];
    b->volume[row] = volume;
    b->size[row] = tl_cbrt(volume);
    double area = 0;
    for (uint32_t face = 0; face < shape->face_count; face++)
        area += tl_poly_face_area(shape, face);
    b->mean_face[row] = area / shape->face_count;
}

/* What a body sums over its blocks. */
typedef struct body_sum {
    tl_sym3 inertia;
    double mass, distance, radius;
    size_t vertices;
} body_sum;

/* Adds a block, whose mass properties at density 1 are about the body's centroid. */
static void add_block(body_sum *sum, const tl_poly *shape, double density, const tl_mass *one)
{
    sum->mass += density * one->volume;
    sum->inertia = tl_s3_madd(sum->inertia, density, tl_inertia_about(one->inertia, one->volume, one->centroid));
    for (uint32_t v = 0; v < shape->vertex_count; v++) {
        double r = tl_v3_norm(shape->vertex[v]);
        sum->distance += r;
        sum->radius = r > sum->radius ? r : sum->radius;
    }
    sum->vertices += shape->vertex_count;
}

static void write_measures(tl_bodies *b, uint32_t body, const body_sum *sum)
{
    double mean = sum->distance / (double)sum->vertices;
    b->mass[body] = sum->mass;
    b->face_rate[body] = 0;
    b->round[body] = ROUND_COEFFICIENT * sum->mass * mean * mean;
    b->radius[body] = sum->radius;
    tl_principal_axes(sum->inertia, &b->moments[body], &b->axes[body]);
}

void tl_body_measure(tl_model *m, uint32_t body)
{
    const uint32_t *members = &m->members[m->bodies.member_start[body]];
    body_sum sum = {0};
    for (uint32_t i = 0; i < m->bodies.member_count[body]; i++) {
        const tl_poly *shape = m->blocks.shape[members[i]];
        tl_mass one = tl_poly_mass(shape);
        add_block(&sum, shape, m->blocks.density[members[i]], &one);
    }
    write_measures(&m->bodies, body, &sum);
}

static tl_status check_measure(tl_error *error, const char *name, double value, const char *unit)
{
    if (value >= TL_LEAST_MEASURE && value <= TL_MOST_MEASURE)
        return TL_OK;
    return tl_fail(error, TL_E_NUMERIC,
                   "a block would have the %s %g %s, outside [%g, %g]: are its size or density in the wrong unit?",
                   name, isnan(value) ? (double)NAN : value, unit, TL_LEAST_MEASURE, TL_MOST_MEASURE);
}

tl_status tl_check_measures(tl_error *error, const tl_poly *shape, double density)
{
    tl_mass mass = tl_poly_mass(shape);
    tl_status status = check_measure(error, "volume", mass.volume, "m3");
    if (status == TL_OK)
        status = check_measure(error, "mass", density * mass.volume, "kg");
    const double moments[3] = {mass.inertia.xx, mass.inertia.yy, mass.inertia.zz};
    for (int k = 0; k < 3 && status == TL_OK; k++)
        status = check_measure(error, "moment of inertia", density * moments[k], "kg m2");
    return status;
}

/* ---------------------------------------------------------------- the smallest of all -----
 *
 * The volume of all blocks, and the smallest volume, edge and face, kept while blocks come and go. A report on each
 * of many edits must not look at all blocks. They are found anew when a block goes that may have been the smallest. */

/* Tolerance: a block this near to the smallest may be it: above the rounding of shapes that are turned. */
#define AS_SMALL (1 + 1e-9)

typedef struct measures {
    double volume, edge, face;
} measures;

static measures measure(const tl_model *m, uint32_t row)
{
    const tl_poly *shape = m->blocks.shape[row];
    return (measures){m->blocks.volume[row], tl_poly_shortest_edge(shape), tl_poly_smallest_face(shape)};
}

/* A block has come. */
static void extremes_add(tl_model *m, uint32_t row)
{
    tl_extremes *x = &m->extremes;
    if (!x->known)
        return;
    measures of = measure(m, row);
    x->total += of.volume;
    x->volume = fmin(x->volume, of.volume);
    x->edge = fmin(x->edge, of.edge);
    x->face = fmin(x->face, of.face);
}

void tl_extremes_drop(tl_model *m, uint32_t row)
{
    tl_extremes *x = &m->extremes;
    if (!x->known)
        return;
    measures of = measure(m, row);
    x->total -= of.volume;
    x->known = of.volume > AS_SMALL * x->volume && of.edge > AS_SMALL * x->edge && of.face > AS_SMALL * x->face;
}

tl_extremes tl_extremes_of(tl_model *m)
{
    tl_extremes *x = &m->extremes;
    if (!x->known) {
        *x = (tl_extremes){true, 0, INFINITY, INFINITY, INFINITY};
        for (uint32_t row = 0; row < m->blocks.table.rows; row++)
            if (m->blocks.stays[row])
                extremes_add(m, row);
    }
    return *x;
}

void tl_block_came(tl_model *m, uint32_t row, tl_mass mass)
{
    const uint32_t body = m->blocks.body[row];
    body_sum sum = {0};
    measure_block(m, row, mass.volume);
    mass.centroid = tl_v3(0, 0, 0);
    add_block(&sum, m->blocks.shape[row], m->blocks.density[row], &mass);
    write_measures(&m->bodies, body, &sum);
    m->bodies.member_start[body] = row; /* every block before is a member of one body */
    m->bodies.member_count[body] = 1;
    m->members[row] = row;
    extremes_add(m, row);
}

static int compare_sizes(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

bool tl_median_size(const tl_model *m, double *median)
{
    size_t n = 0;
    double *sizes = malloc((m->bodies.table.rows + 1) * sizeof *sizes);
    if (!sizes)
        return false;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        if (m->bodies.fixed[body] != TL_FIX_ALL || m->bodies.mesh[body] > 0)
            sizes[n++] = tl_body_size(m, body);
    for (uint32_t body = 0; n == 0 && body < m->bodies.table.rows; body++) /* nothing is free: of all */
        sizes[body] = tl_body_size(m, body);
    n = n > 0 ? n : m->bodies.table.rows;
    qsort(sizes, n, sizeof *sizes, compare_sizes);
    *median = n ? sizes[n / 2] : 0;
    free(sizes);
    return true;
}
