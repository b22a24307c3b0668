/* histories.c - the histories of a model: names, what they sample, and samples in columns from malloc. */
#include "model/histories.h"

#include <stdlib.h>
#include <string.h>

/* Samples that a new history has room for. */
#define FIRST_CAPACITY 64

static bool is_text(const char *text, size_t capacity)
{
    return memchr(text, '\0', capacity) && tl_text_is_clean(text);
}

const char *tl_history_unsound(const tl_model *m, const tl_history *h)
{
    if (!is_text(h->name, sizeof h->name) || h->name[0] == '\0')
        return "a history has no name of one line of UTF-8";
    if (!is_text(h->asked, sizeof h->asked))
        return "a history asks for what has no name of one line of UTF-8";
    if (h->source > TL_FROM_GRIDPOINTS || h->take > TL_TAKE_MAX || h->every < 1)
        return "a history has an impossible setting";
    if ((h->id_count > 0) != (h->source >= TL_FROM_BLOCKS) || (!h->selection && h->id_count > 1))
        return "a history has too few or too many blocks, contacts, zones or gridpoints";
    for (size_t i = 0; i < m->history_count; i++)
        if (strcmp(m->histories[i]->name, h->name) == 0)
            return "two histories have one name";
    return m->history_count < TL_MOST_HISTORIES ? NULL : "it has too many histories";
}

static void history_free(tl_history *h)
{
    free(h->ids);
    free(h->contacts);
    free(h->zones);
    free(h->weights);
    free(h->cycles);
    free(h->times);
    free(h->values);
    free(h);
}

/* Room in the columns of a history for so many samples of its width; false: out of memory, and they are as they
 * were. */
static bool hold_samples(tl_history *h, size_t capacity)
{
    size_t of_cycles = h->capacity, of_times = h->capacity, of_values = h->capacity;
    if (!tl_fit(&h->cycles, &of_cycles, capacity, sizeof *h->cycles) ||
        !tl_fit(&h->times, &of_times, capacity, sizeof *h->times) ||
        !tl_fit(&h->values, &of_values, capacity, h->width * sizeof *h->values))
        return false;
    h->capacity = capacity;
    return true;
}

tl_history *tl_history_hold(tl_model *m, const tl_history *what, size_t samples)
{
    tl_history **list = realloc(m->histories, (m->history_count + 1) * sizeof *list);
    m->histories = list ? list : m->histories;
    tl_history *h = list ? malloc(sizeof *h) : NULL;
    if (!h)
        return NULL;
    *h = *what;
    const bool zones = h->source >= TL_FROM_ZONES;
    h->ids = h->source == TL_FROM_BLOCKS ? malloc(h->id_count * sizeof *h->ids) : NULL;
    h->contacts = h->source == TL_FROM_CONTACTS ? malloc(h->id_count * sizeof *h->contacts) : NULL;
    h->zones = zones ? malloc(h->id_count * sizeof *h->zones) : NULL;
    h->weights = what->weights ? malloc(h->id_count * sizeof *h->weights) : NULL;
    h->cycles = NULL;
    h->times = h->values = NULL;
    h->capacity = 0;
    if ((h->id_count && !h->ids && !h->contacts && !h->zones) || (what->weights && !h->weights) ||
        (samples && !hold_samples(h, samples))) {
        history_free(h);
        return NULL;
    }
    m->histories[m->history_count++] = h;
    return h;
}

tl_status tl_history_add(tl_model *m, const tl_history *what, tl_history **wanted)
{
    tl_history *unread, **const made = wanted ? wanted : &unread;
    *made = NULL;
    const char *bad = tl_history_unsound(m, what);
    if (bad)
        return tl_fail(&m->error, TL_E_ARGUMENT, "history '%.*s': %s", TL_HISTORY_NAME, what->name, bad);
    tl_history fresh = *what;
    fresh.first = m->cycles;
    fresh.lost = fresh.list = false;
    fresh.width = fresh.count = 0;
    tl_history *h = tl_history_hold(m, &fresh, 0);
    if (!h)
        return tl_fail_memory(&m->error);
    if (h->ids)
        memcpy(h->ids, what->ids, h->id_count * sizeof *h->ids);
    if (h->contacts)
        memcpy(h->contacts, what->contacts, h->id_count * sizeof *h->contacts);
    if (h->zones)
        memcpy(h->zones, what->zones, h->id_count * sizeof *h->zones);
    if (h->weights)
        memcpy(h->weights, what->weights, h->id_count * sizeof *h->weights);
    *made = h;
    return TL_OK;
}

void tl_history_end(tl_model *m, size_t i)
{
    if (i >= m->history_count)
        return;
    history_free(m->histories[i]);
    m->history_count--;
    memmove(m->histories + i, m->histories + i + 1, (m->history_count - i) * sizeof *m->histories);
}

tl_history *tl_history_at(const tl_model *m, size_t i)
{
    return i < m->history_count ? m->histories[i] : NULL;
}

tl_status tl_history_sample(tl_model *m, tl_history *h, const double *values, size_t width)
{
    if (width < 1 || width > TL_HISTORY_WIDEST || (h->count && width != h->width))
        return tl_fail(&m->error, TL_E_ARGUMENT, "history '%s': a sample of %zu numbers, where there must be %zu",
                       h->name, width, h->count ? h->width : 1);
    if (h->count && h->cycles[h->count - 1] >= m->cycles)
        return tl_fail(&m->error, TL_E_ARGUMENT, "history '%s': cycle %lld is sampled already", h->name,
                       (long long)m->cycles);
    h->width = width;
    if (h->count == h->capacity && !hold_samples(h, h->capacity ? 2 * h->capacity : FIRST_CAPACITY))
        return tl_fail_memory(&m->error);
    h->cycles[h->count] = m->cycles;
    h->times[h->count] = m->time;
    memcpy(h->values + h->count * width, values, width * sizeof *values);
    h->count++;
    return TL_OK;
}
