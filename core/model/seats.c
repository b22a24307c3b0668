/* seats.c - pairs of blocks that are taken as fitting.
 *
 * A pair is seated by geometry alone: its two blocks see each other with a face moved into another plane. So its energy
 * is that of two blocks of these shapes, wherever they go, and no law, contact or point knows of it. */
#include "model/seats.h"

#include "geometry/make.h"
#include "geometry/moved_face.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Tolerance: what the square of a unit vector of a file may be off 1. */
#define UNIT 1e-6
/* Limit: distance of a face from the zero of its frame, over how far the block reaches. */
#define FAR 2.0

tl_plane tl_plane_reframed(tl_plane plane, const tl_block_frame *from, const tl_block_frame *to)
{
    if (memcmp(from, to, sizeof *from) == 0)
        return plane;
    tl_vec3 n = tl_q_rotate(tl_q_conj(to->turn), tl_q_rotate(from->turn, plane.normal));
    double height = plane.offset - tl_v3_dot(plane.normal, from->centroid);
    return (tl_plane){n, height + tl_v3_dot(n, to->centroid)};
}

static int order(const tl_seated *x, const tl_seated *y)
{
    for (int k = 0; k < 2; k++)
        if (x->block[k] != y->block[k])
            return x->block[k] < y->block[k] ? -1 : 1;
    return 0;
}

static int compare(const void *x, const void *y)
{
    return order(x, y);
}

const tl_seated *tl_seated_of(const tl_model *m, tl_id a, tl_id b)
{
    const tl_seated wanted = {.block = {a < b ? a : b, a < b ? b : a}};
    return m->seats.count ? bsearch(&wanted, m->seats.list, m->seats.count, sizeof wanted, compare) : NULL;
}

bool tl_block_is_seated(const tl_model *m, tl_id block)
{
    bool any = false;
    for (size_t i = 0; i < m->seats.count; i++)
        any = any || m->seats.list[i].block[0] == block || m->seats.list[i].block[1] == block;
    return any;
}

bool tl_seats_reserve(tl_model *m, size_t more)
{
    return tl_grow(&m->seats.list, &m->seats.capacity, m->seats.count + more, sizeof *m->seats.list);
}

void tl_seats_put(tl_model *m, const tl_seated *more, size_t count)
{
    tl_seats *s = &m->seats;
    const size_t before = s->count;
    size_t kept = before;
    for (size_t k = 0; k < count; k++) {
        tl_seated *old = before ? bsearch(&more[k], s->list, before, sizeof *more, compare) : NULL;
        *(old ? old : &s->list[kept++]) = more[k];
    }
    s->count = kept;
    qsort(s->list, kept, sizeof *s->list, compare);
    s->made_for = 0;
}

/* ---------------------------------------------------------------- shapes ----------------- */

static void free_shapes(tl_seats *s)
{
    for (size_t k = 0; k < 2 * s->made; k++)
        tl_poly_free(s->shape[k]);
    free(s->shape);
    free(s->first);
    s->shape = NULL;
    s->first = NULL;
    s->made = 0;
    s->made_for = 0;
}

void tl_seats_free(tl_seats *s)
{
    free_shapes(s);
    free(s->list);
}

size_t tl_seats_bytes(const tl_model *m)
{
    const tl_seats *s = &m->seats;
    size_t bytes = s->made ? 2 * s->made * sizeof *s->shape + (m->blocks.table.rows + 1) * sizeof *s->first : 0;
    for (size_t k = 0; k < 2 * s->made; k++)
        bytes += s->shape[k] ? tl_poly_bytes(s->shape[k]) : 0;
    return bytes;
}

/* Drops pairs of blocks that have gone. */
static void drop_gone(tl_model *m)
{
    tl_seats *s = &m->seats;
    size_t kept = 0;
    for (size_t i = 0; i < s->count; i++)
        if (tl_block_row_quiet(m, s->list[i].block[0]) != TL_NO_ROW &&
            tl_block_row_quiet(m, s->list[i].block[1]) != TL_NO_ROW)
            s->list[kept++] = s->list[i];
    s->count = kept;
}

static bool is_frame(const tl_block_frame *f)
{
    const double turn = f->turn.w * f->turn.w + f->turn.x * f->turn.x + f->turn.y * f->turn.y + f->turn.z * f->turn.z;
    return tl_v3_finite(f->centroid) && fabs(turn - 1) < UNIT;
}

/* Whether a side of a pair names a face, near the block, that there is. */
static bool side_is_sound(const tl_model *m, const tl_seated *seated, int side)
{
    const uint32_t row = tl_block_row_quiet(m, seated->block[side]), face = seated->face[side];
    const tl_plane *plane = &seated->plane[side];
    if (row == TL_NO_ROW || face == TL_NO_ROW)
        return true;
    const double far = tl_v3_norm(seated->frame[side].centroid) + m->blocks.shape[row]->size;
    return face < m->blocks.shape[row]->face_count && fabs(tl_v3_norm2(plane->normal) - 1) < UNIT &&
           fabs(plane->offset) <= FAR * far && is_frame(&seated->frame[side]);
}

bool tl_seats_sound(const tl_model *m)
{
    const tl_seats *s = &m->seats;
    for (size_t i = 0; i < s->count; i++) {
        const tl_seated *one = &s->list[i];
        if (one->block[0] == TL_NO_ID || one->block[0] >= one->block[1] || one->block[1] >= m->next_id ||
            (i && order(&s->list[i - 1], one) >= 0) || !side_is_sound(m, one, 0) || !side_is_sound(m, one, 1))
            return false;
    }
    return true;
}

/* The shape of one block of a pair, whose plane comes into the present frame of its body. */
static bool make_shape(tl_model *m, tl_seated *seated, int side, tl_poly **shape)
{
    const uint32_t row = tl_block_row_quiet(m, seated->block[side]);
    const tl_block_frame now = tl_block_frame_of(m, row);
    *shape = NULL;
    if (seated->face[side] == TL_NO_ROW)
        return true;
    seated->plane[side] = tl_plane_reframed(seated->plane[side], &seated->frame[side], &now);
    seated->frame[side] = now;
    *shape = tl_poly_move_face(m->blocks.shape[row], seated->face[side], seated->plane[side], &m->seats.reach);
    return *shape != NULL;
}

static void list_first(tl_model *m)
{
    tl_seats *s = &m->seats;
    size_t i = 0;
    for (uint32_t row = 0; row <= m->blocks.table.rows; row++) {
        while (row < m->blocks.table.rows && i < s->count && s->list[i].block[0] < m->blocks.id[row])
            i++;
        s->first[row] = (uint32_t)(row < m->blocks.table.rows ? i : s->count);
    }
}

bool tl_seats_follow(tl_model *m)
{
    tl_seats *s = &m->seats;
    if (s->count == 0 || s->made_for == m->structure + 1)
        return true;
    free_shapes(s);
    drop_gone(m);
    s->reach = 0;
    s->shape = malloc((2 * s->count + 1) * sizeof(tl_poly *));
    s->first = malloc((m->blocks.table.rows + 1) * sizeof *s->first);
    bool made = s->shape && s->first;
    for (size_t i = 0; made && i < s->count; i++, s->made++) {
        tl_poly **of = &s->shape[2 * i];
        made = make_shape(m, &s->list[i], 0, &of[0]);
        if (made && !make_shape(m, &s->list[i], 1, &of[1])) {
            tl_poly_free(of[0]);
            made = false;
        }
        if (!made)
            break;
    }
    if (!made) {
        free_shapes(s);
        return false;
    }
    list_first(m);
    s->made_for = m->structure + 1;
    return true;
}

const tl_poly *tl_seated_shape(const tl_model *m, uint32_t row, uint32_t other)
{
    const tl_seats *s = &m->seats;
    if (s->made_for != m->structure + 1)
        return m->blocks.shape[row];
    const uint32_t low = row < other ? row : other;
    const tl_id high = m->blocks.id[row < other ? other : row];
    for (uint32_t i = s->first[low]; i < s->first[low + 1]; i++)
        if (s->list[i].block[1] == high) {
            const tl_poly *shape = s->shape[2 * i + (row > other)];
            return shape ? shape : m->blocks.shape[row];
        }
    return m->blocks.shape[row];
}
