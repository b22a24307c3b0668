/* scene_touches.c - TOUC: the faces with which bodies lie on others. */
#include "io/scene_parts.h"
#include "io/scene_put.h"
#include "query/touching.h"

#include <stdlib.h>

/* A body and a direction in which it cannot move: an outward normal. */
typedef struct bound {
    tl_id body;
    tl_vec3 normal;
} bound;

typedef struct bounds {
    bound *at;
    size_t count, capacity;
} bounds;

/* Adds a normal that the body, whose first is at `first`, does not have. false: out of memory. */
static bool add(bounds *list, size_t first, tl_id body, tl_vec3 normal)
{
    for (size_t i = first; i < list->count; i++)
        if (tl_v3_norm(tl_v3_sub(list->at[i].normal, normal)) <= TL_TOUCH_ALONG)
            return true;
    if (!tl_grow(&list->at, &list->capacity, list->count + 1, sizeof *list->at))
        return false;
    list->at[list->count++] = (bound){body, normal};
    return true;
}

/* Rollers bound a body on both sides; of one that is held throughout its faces alone are told. */
static bool add_rollers(const tl_model *m, uint32_t body, bounds *list, size_t first)
{
    tl_vec3 held[3];
    const size_t count = tl_held_axes(m, body, held);
    const tl_id id = m->bodies.id[body];
    bool enough = true;
    for (size_t k = 0; k < count && count < 3; k++)
        enough =
            enough && add(list, first, id, held[k]) && add(list, first, id, tl_v3_neg(held[k]));
    return enough;
}

static bool add_body(const tl_model *m, const tl_touches *touches, uint32_t body, bounds *list)
{
    const bool now = tl_touches_moved(m, touches, body);
    const size_t first = list->count;
    bool enough = true;
    for (uint32_t k = 0; k < m->bodies.member_count[body]; k++) {
        uint32_t row = m->members[m->bodies.member_start[body] + k];
        for (size_t i = touches->start[row]; i < touches->start[row + 1] && enough; i++)
            enough = add(list, first, m->bodies.id[body], tl_touch_normal(m, &touches->at[i], now));
    }
    return enough && add_rollers(m, body, list, first);
}

static tl_status put(tl_model *m, const bounds *list, tl_piece *out)
{
    unsigned char *to = tl_scene_chunk(out, "TOUC", 4 + 16 * list->count, &m->error);
    if (!to)
        return m->error.status;
    to = tl_put_u32(to, (uint32_t)list->count);
    for (size_t i = 0; i < list->count; i++)
        to = tl_put_u32(to, list->at[i].body);
    for (size_t i = 0; i < list->count; i++)
        to = tl_put_vec3(to, list->at[i].normal);
    return TL_OK;
}

tl_status tl_scene_touches(tl_model *m, tl_piece *out)
{
    tl_touches touches;
    bounds list = {0};
    tl_status status = tl_touches_find(m, &touches);
    for (uint32_t body = 0; body < m->bodies.table.rows && status == TL_OK; body++)
        if (!add_body(m, &touches, body, &list))
            status = tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = put(m, &list, out);
    tl_touches_free(&touches);
    free(list.at);
    return status;
}
