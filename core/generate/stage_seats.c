/* stage_seats.c - parts of blocks that are cut take over the seats of these.
 *
 * A part has a part of the seated face where one of its faces lies in the plane in which that was drawn. One without it
 * is kept behind the plane in which the face is seen. Of two blocks
 * that are both cut each part of the one is seated on each part of the other whose bounds it meets. */
#include "generate/stage_seats.h"

#include "base/table.h"
#include "model/seats.h"

#include <math.h>
#include <stdlib.h>

/* Tolerance: normals of a face and of its parts are off each other by rounding; so are places, over the size. */
#define SAME_FACE 1e-9
#define SAME_PLACE 1e-6

/* A seated pair of which some block goes. Planes are relative to the model's origin, along its axes. */
typedef struct left_seat {
    tl_id block[2];
    uint32_t row[2]; /* before; of a block that goes */
    bool goes[2];
    uint32_t face[2];
    tl_plane drawn[2], plane[2];
} left_seat;

/* A plane of a body's frame as the model has it; and the way back. */
static tl_plane outward(const tl_model *m, uint32_t row, tl_plane plane)
{
    const uint32_t body = m->blocks.body[row];
    const tl_vec3 n = tl_m3_mul(&m->bodies.pose[body].r, plane.normal);
    return (tl_plane){n, plane.offset + tl_v3_dot(n, tl_body_place(&m->bodies, body))};
}

static tl_plane inward(const tl_model *m, uint32_t row, tl_plane plane)
{
    const uint32_t body = m->blocks.body[row];
    const double offset = plane.offset - tl_v3_dot(plane.normal, tl_body_place(&m->bodies, body));
    return (tl_plane){tl_m3_tmul(&m->bodies.pose[body].r, plane.normal), offset};
}

/* How many staged blocks are parts of the block that was in a row. */
static size_t parts_of(const tl_stage *stage, uint32_t row)
{
    size_t count = 0;
    for (size_t i = 0; i < stage->count; i++)
        count += stage->blocks[i].source == row;
    return count;
}

static left_seat left_of(const tl_model *m, const tl_seated *seated, const uint8_t *keep)
{
    left_seat out;
    for (int k = 0; k < 2; k++) {
        const uint32_t row = tl_block_row_quiet(m, seated->block[k]), face = seated->face[k];
        out.block[k] = seated->block[k];
        out.row[k] = row;
        out.goes[k] = !keep[row];
        out.face[k] = face;
        out.drawn[k] = out.plane[k] = (tl_plane){{0, 0, 0}, 0};
        if (face == TL_NO_ROW)
            continue;
        out.drawn[k] = outward(m, row, m->blocks.shape[row]->plane[face]);
        out.plane[k] = outward(m, row, seated->plane[k]);
    }
    return out;
}

bool tl_stage_seats_take(const tl_stage *stage, const uint8_t *keep, size_t rows, tl_stage_seats *seats)
{
    tl_model *m = stage->model;
    *seats = (tl_stage_seats){.count = 0};
    if (m->seats.count == 0 || rows == 0)
        return true;
    seats->list = malloc(m->seats.count * sizeof *seats->list);
    if (!seats->list || !tl_seats_follow(m))
        return false;
    for (size_t i = 0; i < m->seats.count; i++) {
        const left_seat left = left_of(m, &m->seats.list[i], keep);
        if (!left.goes[0] && !left.goes[1])
            continue;
        seats->capacity +=
            (left.goes[0] ? parts_of(stage, left.row[0]) : 1) * (left.goes[1] ? parts_of(stage, left.row[1]) : 1);
        seats->list[seats->count++] = left;
    }
    seats->parts = malloc((seats->capacity + 1) * sizeof *seats->parts);
    return seats->parts && tl_seats_reserve(m, seats->capacity);
}

/* The face of a block that is a part of one that was drawn in a plane; TL_NO_ROW: it has none. */
static uint32_t part_of(const tl_model *m, uint32_t row, tl_plane drawn)
{
    const tl_poly *shape = m->blocks.shape[row];
    const tl_plane own = inward(m, row, drawn);
    for (uint32_t f = 0; f < shape->face_count; f++)
        if (tl_v3_norm2(tl_v3_sub(shape->plane[f].normal, own.normal)) < SAME_FACE * SAME_FACE &&
            fabs(own.offset - shape->plane[f].offset) < SAME_PLACE * shape->size)
            return f;
    return TL_NO_ROW;
}

/* The face of a part that has none of the seated one but crosses its plane, which is to take that plane: the one that
 * is nearest to it in direction. A tip that the cut has left is so. TL_NO_ROW: it lies behind the plane. */
static uint32_t crossing_face(const tl_poly *shape, tl_plane plane, double *height)
{
    uint32_t best = 0;
    *height = -INFINITY;
    for (uint32_t v = 0; v < shape->vertex_count; v++)
        *height = fmax(*height, tl_v3_dot(plane.normal, shape->vertex[v]) - plane.offset);
    for (uint32_t f = 1; f < shape->face_count; f++)
        if (tl_v3_dot(shape->plane[f].normal, plane.normal) > tl_v3_dot(shape->plane[best].normal, plane.normal))
            best = f;
    return *height > 0 ? best : TL_NO_ROW;
}

/* One side of a pair of parts: the block in a row takes the face of the seat. false: it lies away from it. */
static bool take_side(const tl_model *m, const left_seat *left, int side, uint32_t row, int to, tl_seated *out)
{
    out->block[to] = m->blocks.id[row];
    out->frame[to] = tl_block_frame_of(m, row);
    out->plane[to] = (tl_plane){{0, 0, 0}, 0};
    out->face[to] = left->face[side];
    if (left->face[side] == TL_NO_ROW)
        return true;
    out->plane[to] = inward(m, row, left->plane[side]);
    out->face[to] = part_of(m, row, left->drawn[side]);
    if (out->face[to] != TL_NO_ROW)
        return true;
    double height;
    out->face[to] = crossing_face(m->blocks.shape[row], out->plane[to], &height);
    return height > -2 * m->seats.reach;
}

static void bounds_of(const tl_model *m, uint32_t row, tl_vec3 *low, tl_vec3 *high)
{
    const tl_poly *shape = m->blocks.shape[row];
    const double skin = m->seats.reach + SAME_PLACE * shape->size;
    for (uint32_t v = 0; v < shape->vertex_count; v++) {
        const tl_vec3 x = tl_body_point(&m->bodies, m->blocks.body[row], shape->vertex[v]);
        *low = v ? tl_v3_min(*low, x) : x;
        *high = v ? tl_v3_max(*high, x) : x;
    }
    *low = tl_v3_sub(*low, tl_v3(skin, skin, skin));
    *high = tl_v3_add(*high, tl_v3(skin, skin, skin));
}

static bool may_touch(const tl_model *m, uint32_t a, uint32_t b)
{
    tl_vec3 low[2], high[2];
    bounds_of(m, a, &low[0], &high[0]);
    bounds_of(m, b, &low[1], &high[1]);
    return low[0].x <= high[1].x && low[1].x <= high[0].x && low[0].y <= high[1].y && low[1].y <= high[0].y &&
           low[0].z <= high[1].z && low[1].z <= high[0].z;
}

/* Seats the blocks in two rows as the seat of their wholes says, if they touch there. */
static void give_pair(const tl_model *m, const left_seat *left, const uint32_t row[2], tl_stage_seats *seats)
{
    const int swap = m->blocks.id[row[0]] > m->blocks.id[row[1]];
    tl_seated *out = &seats->parts[seats->capacity];
    if (row[0] != row[1] && may_touch(m, row[0], row[1]) && take_side(m, left, 0, row[0], swap, out) &&
        take_side(m, left, 1, row[1], 1 - swap, out) && (out->face[0] & out->face[1]) != TL_NO_ROW)
        seats->capacity++;
}

/* The next staged block, from number `i` on, that has taken the place of one side; SIZE_MAX: there is none. One that
 * stays is the only one. */
static size_t next_part(const tl_stage *stage, const tl_id *ids, const left_seat *left, int side, size_t i,
                        uint32_t *row)
{
    if (!left->goes[side]) {
        *row = tl_block_row_quiet(stage->model, left->block[side]);
        return i == 0 && *row != TL_NO_ROW ? 0 : SIZE_MAX;
    }
    for (; i < stage->count; i++)
        if (stage->blocks[i].source == left->row[side]) {
            *row = tl_block_row_quiet(stage->model, ids[i]);
            if (*row != TL_NO_ROW)
                return i;
        }
    return SIZE_MAX;
}

void tl_stage_seats_give(const tl_stage *stage, const tl_id *ids, tl_stage_seats *seats)
{
    tl_model *m = stage->model;
    if (seats->count == 0)
        return;
    seats->capacity = 0; /* from now on: parts that have been seated */
    for (size_t k = 0; k < seats->count; k++) {
        const left_seat *left = &seats->list[k];
        uint32_t row[2];
        for (size_t i = next_part(stage, ids, left, 0, 0, &row[0]); i != SIZE_MAX;
             i = next_part(stage, ids, left, 0, i + 1, &row[0]))
            for (size_t j = next_part(stage, ids, left, 1, 0, &row[1]); j != SIZE_MAX;
                 j = next_part(stage, ids, left, 1, j + 1, &row[1]))
                give_pair(m, left, row, seats);
    }
    tl_seats_put(m, seats->parts, seats->capacity);
}

void tl_stage_seats_free(tl_stage_seats *seats)
{
    free(seats->list);
    free(seats->parts);
}
