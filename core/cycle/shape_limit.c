/* shape_limit.c - no block bends so far that contact by its edges and corners no longer knows where they are.
 *
 * Contact by edges and corners takes a block's shape as one that turns and strains as a whole. The surface of a block
 * has corners of triangles, with places X as made and displacements u. Their closest affine motion, by least squares,
 * is
 *
 *     u = c + G (X - X_c),    G = sum (u - c) (X - X_c)' (sum (X - X_c) (X - X_c)')^-1
 *
 * with X_c and c the means. The departure of the block is the largest |u - c - G (X - X_c)|. A corner of several
 * triangles counts by each of them. Blocks that meet others by segments alone are free to bend: segments lie where
 * gridpoints are. */
#include "cycle/shape_limit.h"

#include "base/columns.h"
#include "base/parallel.h"
#include "contact/detection.h"
#include "cycle/cycle_data.h"
#include "geometry/polar.h"
#include "zone/grid.h"

#include <math.h>
#include <talus/number.h>

/* Limit: departure over the size of a block. Its edges and corners are off by as much. */
#define MOST_DEPARTURE 0.05
/* Cost only: steps after which shapes are measured again. A block swings in bending over many more. */
#define MEASURE_EVERY 256
/* Tolerance: share of the trace that is added to the sum of squares. Places in one plane tell nothing of the gradient
 * across it, and ask nothing of it. */
#define IN_PLANE 1e-9

/* The closest affine motion of the corners of some triangles. */
typedef struct affine {
    tl_vec3 at, moved; /* means of places as made and of displacements, m */
    tl_mat3 gradient;  /* of the displacement */
} affine;

static affine fit(const tl_gridpoints *p, const tl_surface_part *part, size_t count)
{
    affine out = {.gradient = {{{0}}}};
    double squares[3][3] = {{0}}, products[3][3] = {{0}}, trace = 0;
    const double each = 1 / (3.0 * (double)count);
    for (size_t k = 0; k < 3 * count; k++) {
        const uint32_t row = part[k / 3].corner[k % 3];
        out.at = tl_v3_madd(out.at, each, tl_columns_get(p->ref, row));
        out.moved = tl_v3_madd(out.moved, each, tl_columns_get(p->u, row));
    }
    for (size_t k = 0; k < 3 * count; k++) {
        const uint32_t row = part[k / 3].corner[k % 3];
        const tl_vec3 x = tl_v3_sub(tl_columns_get(p->ref, row), out.at);
        const tl_vec3 u = tl_v3_sub(tl_columns_get(p->u, row), out.moved);
        const double at[3] = {x.x, x.y, x.z}, by[3] = {u.x, u.y, u.z};
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                squares[i][j] += at[i] * at[j];
                products[i][j] += by[i] * at[j];
            }
    }
    for (int i = 0; i < 3; i++)
        trace += squares[i][i];
    tl_mat3 sum, with;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            sum.m[i][j] = squares[i][j] + (i == j ? IN_PLANE * trace : 0);
            with.m[i][j] = products[i][j];
        }
    const tl_mat3 inverse = tl_m3_inverse(&sum);
    out.gradient = tl_m3_product(&with, &inverse);
    return out;
}

/* The largest departure of a block's surface, m, and where: from the model's origin. */
static double departure_of(const tl_gridpoints *p, const tl_surface_part *part, size_t count, tl_vec3 *where)
{
    const affine by = fit(p, part, count);
    double most = 0;
    for (size_t k = 0; k < 3 * count; k++) {
        const uint32_t row = part[k / 3].corner[k % 3];
        const tl_vec3 x = tl_v3_sub(tl_columns_get(p->ref, row), by.at);
        const tl_vec3 u = tl_v3_sub(tl_columns_get(p->u, row), by.moved);
        const double off = tl_v3_norm(tl_v3_sub(u, tl_m3_mul(&by.gradient, x)));
        if (off > most) {
            most = off;
            *where = tl_gridpoint_place(p, row);
        }
    }
    return most;
}

/* Whether a block may touch one of another body by edges or corners: it is near, and they do not meet by segments
 * alone. */
static bool may_press(const tl_model *m, uint32_t block)
{
    for (size_t k = 0; k < m->detect->pair_count; k++) {
        const uint32_t a = m->detect->pairs[k].a, b = m->detect->pairs[k].b;
        if ((a == block || b == block) && !m->blocks.hidden[a] && !m->blocks.hidden[b] &&
            m->blocks.body[a] != m->blocks.body[b] && !tl_blocks_meet(m, a, b))
            return true;
    }
    return false;
}

/* The triangles of one block of a mesh, which come together. */
static void check_block(tl_model *m, size_t mesh, const tl_surface_part *part, size_t count)
{
    const uint32_t row = tl_block_row_quiet(m, part->block);
    tl_vec3 where = {0, 0, 0};
    const double departure = departure_of(&m->zones->points, part, count, &where);
    if (row == TL_NO_ROW || departure <= MOST_DEPARTURE * m->blocks.size[row] || !may_press(m, row))
        return;
    const tl_vec3 at = tl_v3_add(m->origin, where);
    char text[TL_ERROR_TEXT / 2];
    tl_text_print(
        text, sizeof text,
        "block %u has bent: at (%.4g, %.4g, %.4g) its surface lies %.3g m off, %.3g %% of its size, from its "
        "shape turned and strained as a whole, by which its edges and corners touch others; up to %.3g %% are "
        "allowed: cut it into several blocks and join them",
        part->block, at.x, at.y, at.z, departure, 100 * departure / m->blocks.size[row], 100 * MOST_DEPARTURE);
    tl_failure_note(&m->cycle->failure, mesh, TL_E_NUMERIC, row, text);
}

static void check_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk, (void)thread;
    tl_model *m = user;
    const struct tl_zones *z = m->zones;
    for (size_t k = begin; k < end; k++)
        for (size_t first = z->mesh[k].part_begin, next; first < z->mesh[k].part_end; first = next) {
            for (next = first; next < z->mesh[k].part_end && z->part[next].block == z->part[first].block;)
                next++;
            check_block(m, k, &z->part[first], next - first);
        }
}

tl_status tl_shapes_check(tl_model *m)
{
    if (!tl_model_deforms(m) || m->cycles % MEASURE_EVERY != 0)
        return TL_OK;
    tl_parallel_for(m->pool, m->zones->mesh_count, 1, check_range, m);
    tl_failure *failure = &m->cycle->failure;
    const tl_status status = failure->error.status;
    failure->error.status = TL_OK;
    if (status == TL_OK)
        return TL_OK;
    return tl_fail(&m->error, status, "cycle %lld: %s", (long long)m->cycles + 1, failure->error.text);
}
