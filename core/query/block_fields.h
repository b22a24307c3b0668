/* block_fields.h - the numbers of fields, and of the arrays of files, of blocks. */
#ifndef TL_QUERY_BLOCK_FIELDS_H
#define TL_QUERY_BLOCK_FIELDS_H

#include "model/model.h"

static inline void tl_put_number(double *to, double value)
{
    *to = value;
}

static inline void tl_put_vector(double *to, tl_vec3 v)
{
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

static inline void tl_put_quaternion(double *to, tl_quat q)
{
    to[0] = q.w;
    tl_put_vector(to + 1, tl_v3(q.x, q.y, q.z));
}

static inline void tl_put_tensor(double *to, tl_sym3 t)
{
    tl_put_vector(to, tl_v3(t.xx, t.yy, t.zz));
    tl_put_vector(to + 3, tl_v3(t.xy, t.yz, t.zx));
}

/* Puts a value of any kind in the order of tl_field_value. */
#define TL_FIELD_PUT(to, value)                                                                                        \
    _Generic((value), tl_vec3                                                                                          \
             : tl_put_vector, tl_quat                                                                                  \
             : tl_put_quaternion, tl_sym3                                                                              \
             : tl_put_tensor, default                                                                                  \
             : tl_put_number)((to), (value))

/* A field of blocks, or what else files show of them, by a name that there is. */
const tl_field *tl_block_quantity(const char *name);
/* Puts its numbers; of a text the number that stands for it. */
void tl_block_numbers(const tl_model *m, uint32_t row, const tl_field *of, double out[6]);

#endif
