/* scene_put.h - numbers in the chunks of a scene: least significant byte first, and finite. */
#ifndef TL_IO_SCENE_PUT_H
#define TL_IO_SCENE_PUT_H

#include "io/pieces.h"

#include <float.h>
#include <string.h>

/* Each gives where the next number goes. */
static inline unsigned char *tl_put_u8(unsigned char *to, uint32_t value)
{
    *to = (unsigned char)value;
    return to + 1;
}

static inline unsigned char *tl_put_u16(unsigned char *to, uint32_t value)
{
    to[0] = (unsigned char)value;
    to[1] = (unsigned char)(value >> 8);
    return to + 2;
}

static inline unsigned char *tl_put_u32(unsigned char *to, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        to[i] = (unsigned char)(value >> (8 * i));
    return to + 4;
}

/* What does not fit becomes the largest number that does; NaN stays. */
static inline unsigned char *tl_put_f32(unsigned char *to, double value)
{
    float single = (float)(value > (double)FLT_MAX    ? (double)FLT_MAX
                           : value < -(double)FLT_MAX ? -(double)FLT_MAX
                                                      : value);
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    return tl_put_u32(to, bits);
}

static inline unsigned char *tl_put_f64(unsigned char *to, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    tl_put_u32(to, (uint32_t)bits);
    return tl_put_u32(to + 4, (uint32_t)(bits >> 32));
}

static inline unsigned char *tl_put_vec3(unsigned char *to, tl_vec3 value)
{
    to = tl_put_f32(to, value.x);
    to = tl_put_f32(to, value.y);
    return tl_put_f32(to, value.z);
}

/* ---- chunks ---- */

/* Bytes of a column, up to the next multiple of four. */
static inline size_t tl_scene_column_bytes(size_t count, size_t bytes)
{
    return (count * bytes + 3) / 4 * 4;
}

/* Gives the column at *next and goes on behind it. */
static inline unsigned char *tl_scene_column(unsigned char **next, size_t count, size_t bytes)
{
    unsigned char *column = *next;
    *next += tl_scene_column_bytes(count, bytes);
    return column;
}

/* Adds a chunk of `bytes` zeros, a multiple of four, and gives the place of its payload, which is good until more is
 * added; NULL with an error when there is no memory, or more than a chunk can count. */
static inline unsigned char *tl_scene_chunk(tl_piece *out, const char letters[5], size_t bytes, tl_error *error)
{
    if (bytes > UINT32_MAX) {
        tl_fail(error, TL_E_ARGUMENT, "cannot show the model: its %s chunk would have %zu bytes, and may have %u",
                letters, bytes, UINT32_MAX);
        return NULL;
    }
    unsigned char *to = tl_piece_add(out, 8 + bytes);
    if (!to) {
        tl_fail_memory(error);
        return NULL;
    }
    memcpy(to, letters, 4);
    tl_put_u32(to + 4, (uint32_t)bytes);
    memset(to + 8, 0, bytes);
    return to + 8;
}

#endif
