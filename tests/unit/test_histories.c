/* Histories in the kernel: what a list takes, and that no file with an impossible one is restored. */
#include "check.h"
#include "model/model.h"

#include <stdlib.h>
#include <string.h>
#include <talus/talus.h>
#include <unistd.h>

static char path[512];

static tl_model *make(void)
{
    tl_error error;
    tl_model *m = NULL;
    const tl_model_config config = tl_model_config_default();
    CHECK(tl_model_create(&config, &m, &error) == TL_OK);
    return m;
}

/* A history of two samples of three numbers, of blocks 1 and 2. */
static tl_history *add(tl_model *m)
{
    tl_id ids[] = {1, 2};
    tl_history what = {.name = "cubes",
                       .asked = "displacement",
                       .every = 5,
                       .source = TL_FROM_BLOCKS,
                       .selection = true,
                       .id_count = 2,
                       .ids = ids};
    tl_history *h = NULL;
    CHECK(tl_history_add(m, &what, &h) == TL_OK);
    CHECK(tl_history_sample(m, h, (const double[]){1, 2, 3}, 3) == TL_OK);
    h->list = true;
    m->cycles = 5;
    m->time = 0.5;
    CHECK(tl_history_sample(m, h, (const double[]){NAN, -2, INFINITY}, 3) == TL_OK);
    return h;
}

static bool says(const tl_model *m, const char *part)
{
    return strstr(tl_model_error(m)->text, part) != NULL;
}

TEST(a_list_of_histories)
{
    tl_model *m = make();
    tl_history *h = add(m), *other = NULL;
    tl_id id = 1;
    const double numbers[TL_HISTORY_WIDEST + 1] = {0};
    CHECK(tl_history_at(m, 0) == h && tl_history_at(m, 1) == NULL && h->count == 2 && h->first == 0);
    CHECK(tl_history_sample(m, h, numbers, 3) == TL_E_ARGUMENT && says(m, "cycle 5 is sampled"));
    m->cycles = 6;
    CHECK(tl_history_sample(m, h, numbers, 2) == TL_E_ARGUMENT && says(m, "there must be 3"));
    CHECK(h->count == 2 && h->width == 3);
    const struct {
        tl_history what;
        const char *part;
    } bad[] = {
        {{.name = "", .every = 1}, "no name of one line"},
        {{.name = "a\nb", .every = 1}, "no name of one line"},
        {{.name = "cubes", .every = 1}, "two histories have one name"},
        {{.name = "k", .every = 0}, "impossible setting"},
        {{.name = "k", .every = 1, .take = 4}, "impossible setting"},
        {{.name = "k", .every = 1, .source = 6}, "impossible setting"},
        {{.name = "k", .every = 1, .source = TL_FROM_BLOCKS}, "too few"},
        {{.name = "k", .every = 1, .source = TL_FROM_MODEL, .id_count = 1, .ids = &id}, "too many"},
        {{.name = "k", .every = 1, .source = TL_FROM_BLOCKS, .id_count = 2, .ids = &id}, "too many"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        CHECK(tl_history_add(m, &bad[i].what, &other) == TL_E_ARGUMENT && says(m, bad[i].part));
    const tl_history wide = {.name = "wide", .every = 1};
    CHECK(tl_history_add(m, &wide, &other) == TL_OK);
    CHECK(tl_history_sample(m, other, numbers, TL_HISTORY_WIDEST + 1) == TL_E_ARGUMENT);
    CHECK(tl_history_sample(m, other, numbers, 0) == TL_E_ARGUMENT && other->count == 0);
    size_t before = tl_model_memory(m).other;
    CHECK(tl_history_sample(m, other, numbers, TL_HISTORY_WIDEST) == TL_OK);
    CHECK(tl_model_memory(m).other >= before + sizeof numbers - sizeof *numbers);
    tl_history_end(m, 0);
    CHECK(tl_history_at(m, 0) == other && tl_history_at(m, 1) == NULL);
    tl_history_end(m, 1);
    tl_model_destroy(m);
}

static tl_status store(tl_model *m, tl_model **restored, tl_error *error)
{
    CHECK(tl_model_save(m, path) == TL_OK);
    return tl_model_restore(path, 1, NULL, NULL, restored, error);
}

TEST(copies_and_files_have_them)
{
    tl_model *m = make(), *other[2];
    tl_error error;
    const tl_history *h = add(m);
    CHECK(tl_model_copy(m, NULL, NULL, &other[0]) == TL_OK);
    CHECK(store(m, &other[1], &error) == TL_OK);
    for (int k = 0; k < 2; k++) {
        const tl_history *o = tl_history_at(other[k], 0);
        CHECK(o && !tl_history_at(other[k], 1) && strcmp(o->name, h->name) == 0 && strcmp(o->asked, h->asked) == 0 &&
              o->every == 5 && o->first == 0 && o->selection && o->list && !o->lost && o->source == h->source &&
              o->take == h->take);
        CHECK(o->id_count == 2 && memcmp(o->ids, h->ids, 2 * sizeof *h->ids) == 0);
        CHECK(o->count == 2 && o->width == 3 && memcmp(o->cycles, h->cycles, 2 * sizeof *h->cycles) == 0 &&
              memcmp(o->times, h->times, 2 * sizeof *h->times) == 0 &&
              memcmp(o->values, h->values, 6 * sizeof *h->values) == 0);
        tl_model_destroy(other[k]);
    }
    tl_model_destroy(m);
}

/* Histories that no model has, as a file could have them. */
static void spoil(tl_history *h, int how)
{
    switch (how) {
    case 0: strcpy(h->name, "a\nb"); break;
    case 1: h->name[0] = '\0'; break;
    case 2: strcpy(h->asked, "a\tb"); break;
    case 3: h->every = 0; break;
    case 4: h->first = -1; break;
    case 5: h->first = 6; break;
    case 6: h->first = 1; break;
    case 7: h->source = (tl_history_source)9; break;
    case 8: h->take = (tl_history_take)9; break;
    case 9: h->selection = false; break;
    case 10: h->id_count = 0; break;
    case 11: h->list = false; break;
    case 12: h->cycles[1] = 6; break;
    case 13: h->cycles[1] = 0; break;
    case 14: h->cycles[0] = -1; break;
    case 15: h->times[0] = NAN; break;
    default: break;
    }
}

TEST(impossible_histories_are_refused)
{
    for (int how = 0; how < 16; how++) {
        tl_model *m = make(), *restored = NULL;
        tl_error error = {.status = TL_OK};
        spoil(add(m), how);
        CHECK(store(m, &restored, &error) == TL_E_ARGUMENT && restored == NULL &&
              strstr(error.text, "the file is damaged: "));
        tl_model_destroy(m);
    }
}

TEST(clean)
{
    remove(path);
}

TEST(name_the_file)
{
    snprintf(path, sizeof path, "%s/test_histories_%d.talus", TALUS_TEST_TMP, (int)getpid());
}

TEST_MAIN(RUN(name_the_file), RUN(a_list_of_histories), RUN(copies_and_files_have_them),
          RUN(impossible_histories_are_refused), RUN(clean))
