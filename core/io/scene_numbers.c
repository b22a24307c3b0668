/* scene_numbers.c - FIEL, LINE and KEYS: extra fields, the numbers of the run, keyblocks. */
#include "io/scene_parts.h"
#include "io/scene_put.h"

tl_status tl_scene_field(tl_error *error, uint32_t of, size_t number, const double *values,
                         const uint32_t *picked, size_t count, tl_piece *out)
{
    unsigned char *to = tl_scene_chunk(out, "FIEL", 12 + 4 * count, error);
    if (!to)
        return error->status;
    to = tl_put_u32(to, of);
    to = tl_put_u32(to, (uint32_t)number);
    to = tl_put_u32(to, (uint32_t)count);
    for (size_t i = 0; i < count; i++)
        to = tl_put_f32(to, values[picked ? picked[i] : i]);
    return TL_OK;
}

static tl_status put_keyblocks(tl_model *m, const tl_keyblocks *keys, tl_piece *out)
{
    size_t n = keys->count;
    unsigned char *to = tl_scene_chunk(out, "KEYS", 4 + 24 * n, &m->error);
    if (!to)
        return m->error.status;
    to = tl_put_u32(to, (uint32_t)n);
    for (size_t i = 0; i < n; i++)
        to = tl_put_u32(to, keys->blocks[i].block);
    /* in the stream 0 is stable, then the order of tl_keyblock_mode */
    for (size_t i = 0; i < n; i++)
        to = tl_put_u32(to, keys->blocks[i].mode == TL_KEYBLOCK_STABLE
                                ? 0u
                                : (uint32_t)keys->blocks[i].mode + 1u);
    for (size_t i = 0; i < n; i++) /* a stable one has none */
        to = tl_put_f32(to, isfinite(keys->blocks[i].safety) ? keys->blocks[i].safety : NAN);
    for (size_t i = 0; i < n; i++)
        to = tl_put_vec3(to, keys->blocks[i].direction);
    return TL_OK;
}

static void count_history(void *user, const char *name, const char *unit, double value)
{
    (void)name, (void)unit, (void)value;
    ++*(size_t *)user;
}

static void put_history(void *user, const char *name, const char *unit, double value)
{
    (void)name, (void)unit;
    unsigned char **to = user;
    *to = tl_put_f64(*to, value);
}

tl_status tl_scene_run(tl_model *m, const tl_html *options, tl_piece *out)
{
    tl_energy energy;
    tl_status status = tl_model_energy(m, &energy);
    if (status != TL_OK)
        return status;
    tl_balance balance = tl_model_balance(m);
    const double numbers[] = {m->time,        (double)m->cycles,    m->dt,
                              balance.ratio,  balance.max_velocity, energy.kinetic,
                              energy.damping, energy.friction};
    size_t count = sizeof numbers / sizeof numbers[0], k = 0;
    tl_scene_histories(m, count_history, &k);
    unsigned char *to = tl_scene_chunk(out, "LINE", 8 * count + 4 + 8 * k, &m->error);
    if (!to)
        return m->error.status;
    for (size_t i = 0; i < count; i++)
        to = tl_put_f64(to, numbers[i]);
    to = tl_put_u32(to, (uint32_t)k);
    tl_scene_histories(m, put_history, &to);
    return options->keyblocks ? put_keyblocks(m, options->keyblocks, out) : TL_OK;
}
