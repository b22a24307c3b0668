/* Saved models that lie: one number of one chunk of a file is another one, and all checksums are right. Each is refused with one
 * sentence that names the file, or what is wrong in it is found anew. */
#include "contact_scene.h"
#include "state/archive.h"

#include <stdlib.h>
#include <string.h>
#include <talus/state.h>

static const char truth[] = TALUS_TEST_TMP "/truth.talus", lie_path[] = TALUS_TEST_TMP "/lie.talus";

/* As if block 2 had been cut out of block 1, and their contact had been asked for. */
static void add_edits(tl_model *m)
{
    tl_detect *d = m->detect;
    m->heirs = calloc(1, sizeof *m->heirs);
    m->splits = calloc(1, sizeof *m->splits);
    m->asked_ids = calloc(1, sizeof *m->asked_ids);
    d->estates = calloc(1, sizeof *d->estates);
    d->left_points = calloc(1, sizeof *d->left_points);
    if (!CHECK(m->heirs && m->splits && m->asked_ids && d->estates && d->left_points))
        exit(1);
    m->heirs[0] = (tl_heir){.id = 2, .root = 1, .r = tl_m3_identity()};
    m->splits[0] = (tl_split){.block = 2, .whole = 1};
    m->asked_ids[0] = (tl_asked_id){1, 2, 1};
    d->estates[0] = (tl_estate){.a = 1, .b = 2, .law = TL_NO_ROW, .count = 1};
    m->heir_count = m->heir_capacity = m->split_count = m->split_capacity = m->asked_count = 1;
    d->estate_count = d->estate_capacity = d->left_count = d->left_capacity = 1;
    m->next_contact = d->next_contact;
}

/* Two boxes on each other, the lower one held, after some steps. */
static void save_truth(void)
{
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(2, 2, 1));
    scene_box(m, tl_v3(0, 0, 1), tl_v3(1, 1, 2));
    scene_law(m, "coulomb", 1e8, 1e8, 30);
    scene_ok(m, tl_blocks_fix(m, &m->blocks.id[0], 1, TL_FIX_ALL));
    tl_solve_result result;
    scene_ok(m, tl_model_cycle(m, 10, &result));
    add_edits(m);
    scene_ok(m, tl_model_save(m, truth));
    tl_model_destroy(m);
}

/* Bytes of a chunk, and what they are instead. */
typedef struct lie {
    const char *chunk;
    size_t at, bytes;
    const void *instead;
} lie;

static void *unpacked(const tl_archive *from, const tl_chunk *chunk, char name[TL_CHUNK_NAME + 1])
{
    memcpy(name, chunk->name, chunk->name_bytes);
    name[chunk->name_bytes] = '\0';
    void *data = malloc((size_t)(chunk->size * chunk->items) + 1);
    CHECK(data && tl_archive_get(from, name, data, (size_t)chunk->size, (size_t)chunk->items));
    return data;
}

/* Writes the true file once more, with one lie or, for NULL, none. */
static void write_lie(const lie *told)
{
    tl_archive from;
    tl_archive_writer to;
    tl_error error;
    bool found = told == NULL;
    CHECK(tl_archive_open(&from, truth, &error) == TL_OK);
    CHECK(tl_archive_begin(&to, lie_path, &error) == TL_OK);
    for (size_t i = 0; i < from.chunk_count; i++) {
        const tl_chunk *chunk = &from.chunks[i];
        char name[TL_CHUNK_NAME + 1];
        char *data = unpacked(&from, chunk, name);
        if (told && strcmp(name, told->chunk) == 0) {
            found = told->at + told->bytes <= chunk->size * chunk->items;
            if (found)
                memcpy(data + told->at, told->instead, told->bytes);
        }
        if (strcmp(name, "end") != 0) /* the writer adds its own */
            tl_archive_put(&to, name, data, (size_t)chunk->size, (size_t)chunk->items);
        free(data);
    }
    CHECK(found);
    CHECK(tl_archive_end(&to, &error) == TL_OK);
    tl_archive_close(&from);
}

static tl_status restored(tl_error *error)
{
    tl_model *m = NULL;
    tl_status status = tl_model_restore(lie_path, 1, NULL, NULL, &m, error);
    if (m) {
        tl_solve_result result;
        scene_ok(m, tl_model_cycle(m, 3, &result));
        tl_model_destroy(m);
    }
    return status;
}

static const uint64_t most = UINT64_MAX;
static const int64_t long_ago = INT64_MIN;
static const uint32_t far_row = 1000000, all_bits = UINT32_MAX;
static const uint16_t far_vertex = 60000;
static const uint8_t two = 2, many = 255;
static const double none = 0, below = -1, next_to_nothing = 1e-30, infinite = INFINITY;
static const double huge[3] = {1e300, 0, 0};
static const double no_turn[4] = {0, 0, 0, 0};

#define LIE(chunk, at, instead)                                                                    \
    {                                                                                              \
        chunk, at, sizeof(instead), &(instead)                                                     \
    }

/* One for each kind of thing that is looked at. */
static const lie lies[] = {
    /* settings */
    LIE("model.structure", 0, most),
    LIE("model.constraints", 0, most),
    LIE("model.laws", 0, most),
    LIE("model.config.rotation", 0, far_row),
    LIE("model.config.gravity", 0, infinite),
    LIE("model.timestep.rule", 0, far_row),
    LIE("model.timestep.fraction", 0, below),
    LIE("model.min_area", 0, below),
    LIE("model.said", 0, all_bits),
    LIE("model.dt", 0, below),
    /* blocks */
    LIE("blocks.changed", 8, most),
    LIE("blocks.size", 0, next_to_nothing),
    LIE("blocks.volume", 8, none),
    LIE("blocks.density", 0, infinite),
    LIE("blocks.mean_face", 0, none),
    LIE("blocks.group", 0, far_row),
    LIE("blocks.body", 4, far_row),
    LIE("blocks.id", 4, far_row),
    LIE("blocks.hidden", 1, two),
    LIE("blocks.stays", 0, two),
    /* bodies */
    LIE("bodies.id", 4, far_row),
    LIE("bodies.mass", 8, none),
    LIE("bodies.moments", 0, none),
    LIE("bodies.radius", 0, none),
    LIE("bodies.q", 0, no_turn),
    LIE("bodies.axes", 32, no_turn),
    LIE("bodies.pose", 0, huge),
    LIE("bodies.odometer", 0, below),
    LIE("bodies.fixed", 0, many),
    /* shapes */
    LIE("shapes.vertices", 0, infinite),
    LIE("shapes.loops", 0, far_vertex),
    LIE("shapes.counts", 0, far_row),
    LIE("shapes.tags", 0, far_row),
    /* contacts */
    LIE("detect.structure", 0, most),
    LIE("detect.known_blocks", 4, far_row),
    LIE("detect.pairs", 0, far_row),
    LIE("detect.contacts.a", 0, far_row),
    LIE("detect.contacts.b", 0, far_row),
    LIE("detect.contacts.pair", 0, far_row),
    LIE("detect.contacts.law", 0, far_row),
    LIE("detect.contacts.press", 0, far_row),
    LIE("detect.contacts.point_start", 0, far_row),
    LIE("detect.contacts.point_count", 0, far_vertex),
    LIE("detect.contacts.pending", 0, many),
    LIE("detect.contacts.field", 0, two),
    LIE("detect.layout.groups", 0, far_row),
    LIE("detect.laid_at", 0, long_ago),
    /* edits */
    LIE("model.heirs", offsetof(tl_heir, id), far_row),
    LIE("model.heirs", offsetof(tl_heir, root), all_bits),
    LIE("model.asked_ids", offsetof(tl_asked_id, a), far_row),
    LIE("model.heirs", offsetof(tl_heir, r), huge),
    LIE("model.next_contact", 0, all_bits),
    LIE("model.heirs", offsetof(tl_heir, place), infinite),
    LIE("model.splits", offsetof(tl_split, block), far_row),
    LIE("model.splits", offsetof(tl_split, whole), far_row),
    LIE("detect.estates", offsetof(tl_estate, first), most),
    LIE("detect.next_contact", 0, far_row),
    LIE("detect.estates", offsetof(tl_estate, count), far_row),
    LIE("model.asked_ids", offsetof(tl_asked_id, contact), far_row),
    LIE("detect.estates", offsetof(tl_estate, law), far_row),
    LIE("detect.estates", offsetof(tl_estate, field), two),
    LIE("detect.estates", offsetof(tl_estate, holds_over_gap), two),
    LIE("detect.estates", offsetof(tl_estate, reframed), two),
    /* the step */
    LIE("cycle.all_held", 0, two),
};

/* What is found anew before it is used, and what only chooses how much room there is. */
static const lie harmless[] = {
    LIE("detect.spare_share", 0, most),
    LIE("cycle.reaction_of", 0, far_row),
    LIE("cycle.sums", 0, infinite),
};

TEST(what_is_true_is_restored)
{
    tl_error error;
    save_truth();
    write_lie(NULL);
    CHECK(restored(&error) == TL_OK);
}

TEST(a_lie_is_refused)
{
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        tl_error error = {0};
        write_lie(&lies[i]);
        tl_status status = restored(&error);
        if (status != TL_E_ARGUMENT)
            printf("%s, byte %zu: status %d, %s\n", lies[i].chunk, lies[i].at, status, error.text);
        CHECK(status == TL_E_ARGUMENT);
        CHECK_CONTAINS(error.text, "cannot restore");
        CHECK_CONTAINS(error.text, "lie.talus");
    }
}

TEST(what_does_not_matter_is_restored)
{
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++) {
        tl_error error;
        write_lie(&harmless[i]);
        CHECK(restored(&error) == TL_OK);
    }
}

TEST_MAIN(RUN(what_is_true_is_restored), RUN(a_lie_is_refused),
          RUN(what_does_not_matter_is_restored))
