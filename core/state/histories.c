/* histories.c - the histories of a model in an archive, and in a copy.
 *
 *     histories             what each samples, and how many samples it has; without histories it is not there
 *     histories.K.ids       of its blocks
 *     histories.K.contacts  names of its contacts
 *     histories.K.zones     names of its zones or gridpoints
 *     histories.K.weights   by which their values are multiplied, where it has them
 *     histories.K.cycles    of its samples
 *     histories.K.times     s
 *     histories.K.values    width numbers for each sample
 *
 * Whether there is a value or field of the name that is asked for is looked at by who samples. */

#include "state/histories.h"

#include "model/histories.h"
#include <stdlib.h>
#include <string.h>

/* A history without its lists, as a file keeps it. */
typedef struct history_kept {
    char name[TL_HISTORY_NAME + 1], asked[TL_HISTORY_NAME + 1];
    int64_t every, first;
    uint64_t ids, width, count;
    uint8_t source, take, selection, lost, list, weighs, spare[2];
} history_kept;

/* A list of a history, by its name in a file: "ids" of its blocks ("contacts", "zones"), of its samples "cycles",
 * "times" and "values", and "weights" if it has them. */
typedef struct history_list {
    const char *name;
    void *at;
    size_t size, items;
} history_list;

enum { HISTORY_LISTS = 5, WEIGHTS = 4 };

static unsigned lists_of(const tl_history *h)
{
    return h->weights ? HISTORY_LISTS : WEIGHTS;
}

static history_list history_list_at(const tl_history *h, unsigned k)
{
    switch (k) {
    case 0:
        if (h->source == TL_FROM_ZONES || h->source == TL_FROM_GRIDPOINTS)
            return (history_list){"zones", h->zones, sizeof *h->zones, h->id_count};
        return h->source == TL_FROM_CONTACTS ? (history_list){"contacts", h->contacts, sizeof *h->contacts, h->id_count}
                                             : (history_list){"ids", h->ids, sizeof *h->ids, h->id_count};
    case 1: return (history_list){"cycles", h->cycles, sizeof *h->cycles, h->count};
    case 2: return (history_list){"times", h->times, sizeof *h->times, h->count};
    case WEIGHTS: return (history_list){"weights", h->weights, sizeof *h->weights, h->id_count};
    default: return (history_list){"values", h->values, sizeof *h->values, h->count * h->width};
    }
}

/* ---------------------------------------------------------------- saving ----------------- */

static void keep(const tl_history *h, history_kept *kept)
{
    memcpy(kept->name, h->name, strlen(h->name));
    memcpy(kept->asked, h->asked, strlen(h->asked));
    kept->every = h->every;
    kept->first = h->first;
    kept->ids = h->id_count;
    kept->width = h->width;
    kept->count = h->count;
    kept->source = (uint8_t)h->source;
    kept->take = (uint8_t)h->take;
    kept->selection = h->selection;
    kept->lost = h->lost;
    kept->list = h->list;
    kept->weighs = h->weights != NULL;
}

static void save_histories(const tl_model *m, tl_archive_writer *w)
{
    if (m->history_count == 0)
        return;
    history_kept *kept = calloc(m->history_count, sizeof *kept);
    w->lost = w->lost || !kept;
    for (size_t k = 0; kept && k < m->history_count; k++) {
        keep(m->histories[k], &kept[k]);
        for (unsigned i = 0; i < lists_of(m->histories[k]); i++) {
            char name[TL_CHUNK_NAME];
            const history_list list = history_list_at(m->histories[k], i);
            tl_chunk_name(name, "histories.%zu.%s", k, list.name);
            tl_archive_put(w, name, list.at, list.size, list.items);
        }
    }
    if (kept)
        tl_archive_put(w, "histories", kept, sizeof *kept, m->history_count);
    free(kept);
}

/* ---------------------------------------------------------------- restoring -------------- */

static bool kept_is_sound(const tl_model *m, const history_kept *kept)
{
    return kept->selection <= 1 && kept->lost <= 1 && kept->list <= 1 && kept->weighs <= 1 && kept->first >= 0 &&
           kept->first <= m->cycles && kept->ids <= UINT32_MAX && kept->width <= TL_HISTORY_WIDEST &&
           (kept->width > 0 || kept->count == 0) && (kept->list || kept->width <= 1) &&
           (kept->count == 0 || kept->count - 1 <= (uint64_t)(m->cycles - kept->first));
}

/* A history without lists; that it has weights shows. */
static tl_history history_of(const history_kept *kept)
{
    static double weighs;
    tl_history h = {.every = kept->every,
                    .first = kept->first,
                    .source = (tl_history_source)kept->source,
                    .take = (tl_history_take)kept->take,
                    .selection = kept->selection,
                    .lost = kept->lost,
                    .list = kept->list,
                    .weights = kept->weighs ? &weighs : NULL,
                    .id_count = (size_t)kept->ids,
                    .width = (size_t)kept->width,
                    .count = (size_t)kept->count};
    memcpy(h.name, kept->name, sizeof h.name);
    memcpy(h.asked, kept->asked, sizeof h.asked);
    return h;
}

/* Whether an archive has the lists, of so many items: before there is memory for them. */
static bool has_lists(const tl_archive *a, size_t k, const tl_history *h)
{
    for (unsigned i = 0; i < lists_of(h); i++) {
        char name[TL_CHUNK_NAME];
        const history_list list = history_list_at(h, i);
        tl_chunk_name(name, "histories.%zu.%s", k, list.name);
        if (!tl_archive_has(a, name, list.size, list.items))
            return false;
    }
    return true;
}

static bool samples_are_sound(const tl_model *m, const tl_history *h)
{
    for (size_t i = 0; i < h->count; i++)
        if ((i ? h->cycles[i] <= h->cycles[i - 1] : h->cycles[i] < h->first) || h->cycles[i] > m->cycles ||
            !isfinite(h->times[i]))
            return false;
    bool finite = true;
    for (size_t i = 0; h->weights && i < h->id_count; i++)
        finite = finite && isfinite(h->weights[i]);
    return finite;
}

static bool read_lists(const tl_model *m, const tl_archive *a, size_t k, tl_history *h)
{
    for (unsigned i = 0; i < lists_of(h); i++) {
        char name[TL_CHUNK_NAME];
        const history_list list = history_list_at(h, i);
        tl_chunk_name(name, "histories.%zu.%s", k, list.name);
        if (!tl_archive_get(a, name, list.at, list.size, list.items))
            return false;
    }
    return samples_are_sound(m, h);
}

static tl_status restore_one(tl_model *m, const tl_archive *a, size_t k, const history_kept *kept)
{
    if (!kept_is_sound(m, kept))
        return tl_archive_bad(a, &m->error, "a history has an impossible value");
    const tl_history what = history_of(kept);
    const char *bad = tl_history_unsound(m, &what);
    if (bad)
        return tl_archive_bad(a, &m->error, "%s", bad);
    if (!has_lists(a, k, &what))
        return tl_archive_bad(a, &m->error, "a list of history '%s' is missing or does not fit", what.name);
    tl_history *h = tl_history_hold(m, &what, what.count);
    if (!h)
        return tl_fail_memory(&m->error);
    return read_lists(m, a, k, h) ? TL_OK
                                  : tl_archive_bad(a, &m->error, "the samples of history '%s' do not fit", h->name);
}

static tl_status restore_histories(tl_model *m, const tl_archive *a)
{
    const tl_chunk *chunk = tl_archive_find(a, "histories");
    if (!chunk)
        return TL_OK;
    size_t count = chunk->items <= TL_MOST_HISTORIES ? (size_t)chunk->items : 0;
    history_kept *kept = calloc(count + 1, sizeof *kept);
    if (!kept)
        return tl_fail_memory(&m->error);
    tl_status status = count && tl_archive_get(a, "histories", kept, sizeof *kept, count)
                           ? TL_OK
                           : tl_archive_bad(a, &m->error, "'histories' does not fit");
    for (size_t k = 0; k < count && status == TL_OK; k++)
        status = restore_one(m, a, k, &kept[k]);
    free(kept);
    return status;
}

/* ---------------------------------------------------------------- copying ---------------- */

static tl_status copy_histories(tl_model *to, const tl_model *from)
{
    for (size_t k = 0; k < from->history_count; k++) {
        const tl_history *h = from->histories[k];
        tl_history *copy = tl_history_hold(to, h, h->count);
        if (!copy)
            return tl_fail_memory(&to->error);
        for (unsigned i = 0; i < lists_of(h); i++) {
            const history_list list = history_list_at(h, i);
            if (list.items)
                memcpy(history_list_at(copy, i).at, list.at, list.items * list.size);
        }
    }
    return TL_OK;
}

const tl_state_part tl_histories_part = {save_histories, restore_histories, copy_histories};
