/* scene_numbers.c - FIEL, LINE and KEYS: extra fields, the numbers of the run, keyblocks. */
#include "io/scene_numbers.h"

#include "io/pieces.h"
#include "io/scene_put.h"

#include <stdio.h>
#include <string.h>
#include <talus/history.h>

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

/* ---------------------------------------------------------------- numbers of histories ----
 *
 * The last samples of the histories of a model. */

/* Units of what a model is asked for by name; the rest has none. */
static const struct {
    const char *name, *unit;
} quantities[] = {
    {"kinetic", "J"}, {"potential", "J"}, {"stored", "J"},         {"friction", "J"},
    {"damping", "J"}, {"external", "J"},  {"max_velocity", "m/s"},
};

static const char *unit_of(const tl_history *h)
{
    size_t count = 0;
    const tl_field *fields = h->source == TL_FROM_BLOCKS     ? tl_block_fields(&count)
                             : h->source == TL_FROM_CONTACTS ? tl_contact_fields(&count)
                                                             : NULL;
    for (size_t i = 0; i < count; i++)
        if (strcmp(fields[i].name, h->asked) == 0)
            return fields[i].unit;
    for (size_t i = 0; h->source == TL_FROM_MODEL && i < sizeof quantities / sizeof *quantities;
         i++)
        if (strcmp(quantities[i].name, h->asked) == 0)
            return quantities[i].unit;
    return "";
}

void tl_scene_histories(const tl_model *m, tl_scene_history_fn fn, void *user)
{
    const tl_history *h;
    for (size_t i = 0; (h = tl_history_at(m, i)) != NULL; i++)
        for (size_t k = 0; k < h->width; k++) {
            char name[TL_HISTORY_NAME + 16];
            snprintf(name, sizeof name, h->width > 1 ? "%s %zu" : "%s", h->name, k + 1);
            fn(user, name, unit_of(h),
               h->count ? h->values[(h->count - 1) * h->width + k] : (double)NAN);
        }
}
