/* scene_histories.c - the last samples of the histories of a model. */
#include "io/scene_parts.h"

#include <stdio.h>
#include <string.h>
#include <talus/history.h>

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
