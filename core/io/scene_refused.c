/* scene_refused.c - REFU: the cuts that were refused so far, those that the model's record lists. */
#include "io/scene_parts.h"
#include "io/scene_put.h"

/* Bytes of one: joint, plane, block, normal, point, thickness, limit. */
#define BYTES 44

tl_status tl_scene_refused(tl_model *m, tl_piece *out)
{
    const tl_cut_record *record = &m->record;
    size_t n = record->listed;
    unsigned char *to = tl_scene_chunk(out, "REFU", 8 + n * BYTES, &m->error);
    if (!to)
        return m->error.status;
    to = tl_put_u32(to, (uint32_t)(record->refused < UINT32_MAX ? record->refused : UINT32_MAX));
    to = tl_put_u32(to, (uint32_t)n);
    for (size_t i = 0; i < n; i++)
        to = tl_put_u32(to, record->list[i].joint.joint);
    for (size_t i = 0; i < n; i++)
        to = tl_put_u32(to, record->list[i].joint.plane);
    for (size_t i = 0; i < n; i++)
        to = tl_put_u32(to, record->list[i].block);
    for (size_t i = 0; i < n; i++)
        to = tl_put_vec3(to, record->list[i].normal);
    for (size_t i = 0; i < n; i++)
        to = tl_put_vec3(to, tl_v3_sub(record->list[i].point, m->origin));
    for (size_t i = 0; i < n; i++)
        to = tl_put_f32(to, record->list[i].thickness);
    for (size_t i = 0; i < n; i++)
        to = tl_put_f32(to, record->list[i].limit);
    return TL_OK;
}
