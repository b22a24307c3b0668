/* Saved models that lie: one number of one chunk of a file is another one, and all checksums are right. Each is refused with one
 * sentence that names the file, or what is wrong in it is found anew. */
#include "contact_scene.h"
#include "cycle/cycle_data.h"
#include "state/archive.h"
#include "state/drives.h"

#include <stdlib.h>
#include <string.h>
#include <talus/state.h>

static const char truth[] = TALUS_TEST_TMP "/truth.talus", lie_path[] = TALUS_TEST_TMP "/lie.talus";

/* What a model may be set to, so that nothing is at its default. */
static void add_settings(tl_model *m)
{
    m->min_area = (tl_min_area_rule){1e-4, 1e-6};
    m->timestep.fraction = 0.5;
    tl_value alpha = {.key = "alpha", .type = TL_VALUE_NUMBER, .number = 0};
    const tl_args without = {&alpha, 1};
    scene_ok(m, tl_model_damping(m, "local", &without));
    const tl_id second = m->blocks.id[1]; /* tables move */
    const tl_load load = {.size = sizeof load, .force = {0, 0, -10}};
    scene_ok(m, tl_blocks_load(m, &second, 1, &load));
    scene_ok(m, tl_write_vtk(m, TALUS_TEST_TMP "/truth", NULL));
    scene_ok(m, tl_blocks_reset_displacement(m, &second, 1));
    const tl_history what = {.name = "kinetic", .asked = "kinetic", .source = TL_FROM_MODEL, .every = 1};
    tl_history *history;
    const double values[2] = {1, 2};
    scene_ok(m, tl_history_add(m, &what, &history));
    for (int k = 0; k < 2; k++) {
        scene_ok(m, tl_history_sample(m, history, &values[k], 1));
        scene_ok(m, tl_model_cycle(m, 10, NULL));
    }
}

/* As if block 2 had been cut out of block 1. */
static void add_edits(tl_model *m)
{
    tl_detect *d = m->detect;
    m->cut_parts = calloc(1, sizeof *m->cut_parts);
    m->splits = calloc(1, sizeof *m->splits);
    d->cut_contacts = calloc(1, sizeof *d->cut_contacts);
    d->cut_points = calloc(1, sizeof *d->cut_points);
    m->face_loads = calloc(1, sizeof *m->face_loads);
    if (!CHECK(m->cut_parts && m->splits && d->cut_contacts && d->cut_points && m->face_loads))
        exit(1);
    m->cut_parts[0] = (tl_cut_part){.id = 2, .root = 1, .r = tl_m3_identity()};
    m->splits[0] = (tl_split){.block = 2, .whole = 1};
    d->cut_contacts[0] = (tl_cut_contact){.a = 1, .b = 2, .law = TL_NO_ROW, .count = 1};
    m->face_loads[0] = (tl_face_load){.block = 2};
    m->face_load_count = m->face_load_capacity = 1;
    m->cut_part_count = m->cut_part_capacity = m->split_count = m->split_capacity = 1;
    d->cut_count = d->cut_capacity = d->cut_point_count = d->cut_point_capacity = 1;
}

/* Two boxes on each other, the lower one held, one that stands on its edge, and one that is driven, after some steps. */
static void save_truth(void)
{
    tl_plugins_load_default();
    tl_model *m = scene_model(1);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(2, 2, 1));
    scene_box(m, tl_v3(0, 0, 1), tl_v3(1, 1, 2));
    scene_block(m, scene_box_shape(0.5, 0.5, 0.5), scene_turn(tl_v3(1, 0, 0), TL_PI / 4),
                tl_v3(1.5, 1.5, 1 + 0.999 * sqrt(0.125)));
    scene_box(m, tl_v3(9, 9, 9), tl_v3(10, 10, 10));
    scene_law(m, "coulomb", 1e8, 1e8, 30);
    scene_ok(m, tl_blocks_fix(m, &m->blocks.id[0], 1, TL_FIX_ALL));
    const tl_drive drive = {.size = sizeof drive, .velocity = {0, 0, 1}};
    scene_ok(m, tl_blocks_drive(m, &m->blocks.id[3], 1, &drive));
    add_settings(m);
    add_edits(m);
    scene_ok(m, tl_model_save(m, truth));
    tl_model_destroy(m);
}

/* Bytes of a chunk, and what they are instead; with none the whole chunk is left out. */
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
        bool written = strcmp(name, "end") != 0; /* the writer adds its own */
        if (told && strcmp(name, told->chunk) == 0) {
            found = told->at + told->bytes <= chunk->size * chunk->items;
            written = told->bytes > 0;
            if (found && written)
                memcpy(data + told->at, told->instead, told->bytes);
        }
        if (written)
            tl_archive_put(&to, name, data, (size_t)chunk->size, (size_t)chunk->items);
        free(data);
    }
    CHECK(found);
    CHECK(tl_archive_end(&to, &error) == TL_OK);
    tl_archive_close(&from);
}

/* What a model that was restored has to bear: steps, a cut, a copy. */
static tl_status restored(tl_error *error)
{
    tl_model *m = NULL, *copy = NULL;
    tl_status status = tl_model_restore(lie_path, 1, NULL, NULL, &m, error);
    if (m) {
        scene_ok(m, tl_model_cycle(m, 3, NULL));
        scene_ok(m, tl_generate(m, "joint",
                                TL_ARGS(tl_arg_text("joint", "late"), tl_arg_number("dip", 20),
                                        tl_arg_number("dip_direction", 50), TL_ARG_VECTOR("origin", 0.5, 0.5, 1.5)),
                                NULL));
        scene_ok(m, tl_model_cycle(m, 3, NULL));
        scene_ok(m, tl_model_copy(m, NULL, NULL, &copy));
        tl_model_destroy(copy);
        tl_model_destroy(m);
    }
    return status;
}

static const uint64_t most = UINT64_MAX;
static const int64_t long_ago = INT64_MIN, long_hence = INT64_MAX / 4;
static const uint32_t far_row = 1000000, all_bits = UINT32_MAX;
static const uint16_t far_vertex = 60000, no_vertex = 0;
static const uint64_t odd = 1;
static const uint8_t zero = 0, one = 1, two = 2, four = 4, many = 255, most_planes = 250;
static const int64_t before_all = -1, far_cycle = (int64_t)1 << 40;
static const uint32_t row_0 = 0, row_1 = 1, two_row = 2;
static const char no_end[64] = {"a name of sixty-four characters, none of which is the end of one"};
static_assert(sizeof no_end == TL_STAGE_NAME + 1 && sizeof no_end == TL_HISTORY_NAME + 1,
              "a name that is too long fills the field");
static const char two_lines[] = "one\nother";
static const double none = 0, below = -1, next_to_nothing = 1e-30, infinite = INFINITY;
static const double all_of_it = 1, unknown = NAN, more_than_all = 1.5, farther = 10 * TL_FARTHEST;
static const double huge[3] = {1e300, 0, 0};
static const double no_turn[4] = {0, 0, 0, 0};

/* Of the field contact, and of the first span. */
#define PRESS(member, instead) LIE("detect.press", offsetof(tl_press_row, member), instead)
#define SPAN(member, instead) LIE("detect.layout.spans", offsetof(tl_span, member), instead)
#define LIE(chunk, at, instead)                                                                                        \
    {                                                                                                                  \
        chunk, at, sizeof(instead), &(instead)                                                                         \
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
    LIE("model.config.gravity", 16, infinite),
    LIE("model.config.rotation", 0, all_bits),
    LIE("model.config.reuse_geometry", 0, far_row),
    LIE("model.config.reuse_geometry", 0, all_bits),
    LIE("model.config.contact_points", 0, far_row),
    LIE("model.config.contact_points", 0, all_bits),
    LIE("model.gravity_before", 8, infinite),
    LIE("model.loads_changed", 0, two),
    LIE("model.timestep.rule", 0, all_bits),
    LIE("model.timestep.fraction", 0, none),
    LIE("model.timestep.fraction", 0, farther),
    LIE("model.timestep.dt", 0, none),
    LIE("model.timestep.dt", 0, infinite),
    LIE("model.min_area", 0, infinite),
    LIE("model.min_area", 8, below),
    LIE("model.min_area", 8, infinite),
    LIE("model.origin", 0, infinite),
    LIE("model.time", 0, infinite),
    LIE("model.dt", 0, infinite),
    LIE("model.cycles", 0, long_ago),
    LIE("model.cycles", 0, long_hence),
    LIE("model.gone", 0, far_row),
    LIE("model.added_dt", 0, none),
    LIE("model.added_most", 0, below),
    LIE("model.stage", 0, no_end),
    LIE("model.stage", 0, two_lines),
    /* blocks */
    LIE("blocks.id", 0, row_0),
    LIE("blocks.id", 4, row_1),
    LIE("blocks.density", 8, none),
    LIE("blocks.mean_face", 8, infinite),
    LIE("blocks.body", 8, row_1),
    LIE("blocks.body", 4, row_0),
    LIE("blocks.changed", 8, most),
    LIE("blocks.size", 0, next_to_nothing),
    LIE("blocks.volume", 8, none),
    LIE("blocks.density", 0, infinite),
    LIE("blocks.mean_face", 0, none),
    LIE("blocks.group", 0, far_row),
    LIE("blocks.body", 4, far_row),
    LIE("blocks.id", 4, far_row),
    LIE("blocks.id", 12, far_row), /* of the last */
    LIE("blocks.hidden", 1, two),
    LIE("blocks.stays", 0, two),
    /* bodies */
    LIE("bodies.id", 4, far_row),
    LIE("bodies.mass", 8, none),
    LIE("bodies.moments", 0, none),
    LIE("bodies.radius", 0, none),
    LIE("bodies.q", 0, no_turn),
    LIE("blocks.base", offsetof(tl_base, turn), no_turn),
    LIE("blocks.base", offsetof(tl_base, shift), infinite),
    LIE("bodies.axes", 32, no_turn),
    LIE("bodies.id", 4, row_1),
    LIE("bodies.mass", 0, infinite),
    LIE("bodies.moments", 8, none),
    LIE("bodies.moments", 16, infinite),
    LIE("bodies.round", 0, none),
    LIE("bodies.radius", 8, infinite),
    LIE("bodies.drive", 0, far_row),
    LIE("bodies.load", offsetof(tl_body_load, force), infinite),
    LIE("bodies.load", offsetof(tl_body_load, moment), infinite),
    LIE("bodies.load", offsetof(tl_body_load, arm), infinite),
    LIE("bodies.pose", 0, huge),
    LIE("bodies.pose", offsetof(tl_pose, x_ref), huge),
    LIE("bodies.pose", offsetof(tl_pose, u), infinite),
    LIE("bodies.odometer", 0, below),
    LIE("bodies.fixed", 0, many),
    /* shapes */
    LIE("shapes.vertices", 0, infinite),
    LIE("shapes.loops", 0, far_vertex),
    LIE("shapes.counts", 0, far_row),
    LIE("shapes.tags", 0, far_row),
    LIE("shapes.vertices", 8, farther),
    LIE("shapes.planes", 0, infinite),
    LIE("shapes.planes", 24, infinite),
    LIE("shapes.starts", 0, far_vertex),
    LIE("shapes.starts", 2, no_vertex),
    LIE("shapes.edges", offsetof(tl_edge, a), far_vertex),
    LIE("shapes.edges", offsetof(tl_edge, b), far_vertex),
    LIE("shapes.edges", offsetof(tl_edge, left), far_vertex),
    LIE("shapes.edges", offsetof(tl_edge, right), far_vertex),
    LIE("shapes.counts", 4, far_row),
    LIE("shapes.counts", 8, far_row),
    LIE("shapes.counts", 12, far_row),
    /* pairs and what was seen of blocks */
    LIE("detect.known_blocks", sizeof(tl_known_block), row_1),
    LIE("detect.known_blocks", sizeof(tl_known_block), far_row),
    LIE("detect.pairs", offsetof(tl_pair, b), row_0),
    LIE("detect.pairs", offsetof(tl_pair, b), far_row),
    LIE("detect.pairs", offsetof(tl_pair, contact), row_1),
    LIE("detect.pairs", offsetof(tl_pair, contact), far_row),
    LIE("detect.pairs", offsetof(tl_pair, b), two_row),
    LIE("detect.chunks", offsetof(tl_pair_chunk, found), two),
    /* field contacts */
    LIE("detect.contacts.press", 4, far_row),
    LIE("detect.contacts.press", 4, all_bits),
    LIE("detect.contacts.point_count", 2, one),
    LIE("detect.press_free", 0, row_0),
    PRESS(press.powers, two),
    PRESS(flush, two),
    PRESS(listed, two),
    PRESS(leans, two),
    PRESS(by_slope, two),
    PRESS(refused, two),
    PRESS(shifted.a, far_row),
    PRESS(shifted.b, far_row),
    PRESS(count[0], far_vertex),
    PRESS(count[3], far_vertex),
    PRESS(face[0], far_vertex),
    PRESS(face[1], far_vertex),
    PRESS(mesh.corners, many),
    PRESS(mesh.polygons, many),
    PRESS(mesh.bounding, most),
    PRESS(mesh.apex[0].known, two),
    PRESS(mesh.apex[1].holds, four),
    PRESS(mesh.apex[0].strays, many),
    PRESS(mesh.plane[0][0], most_planes),
    PRESS(mesh.plane[3][0], most_planes),
    PRESS(mesh.own[0][1], most_planes),
    PRESS(mesh.sides[0], two),
    PRESS(mesh.sides[0], many),
    PRESS(mesh.loop[0], many),
    /* contacts */
    LIE("detect.contacts.born", 0, before_all),
    LIE("detect.contacts.born", 0, far_cycle),
    LIE("detect.contacts.held", 0, two),
    LIE("detect.contacts.handed_over", 0, two),
    LIE("detect.contacts.holds_over_gap", 0, two),
    LIE("detect.contacts.new_points", 0, many),
    LIE("detect.contacts.deep", 0, many),
    LIE("detect.contacts.point_capacity", 0, zero),
    LIE("detect.contacts.tag", 0, far_row),
    LIE("detect.contacts.facet", offsetof(tl_facet, kind), far_row),
    LIE("detect.contacts.facet", offsetof(tl_facet, ride), below),
    LIE("detect.contacts.facet", offsetof(tl_facet, ride), more_than_all),
    LIE("detect.contacts.facet", offsetof(tl_facet, ia), far_vertex),
    LIE("detect.contacts.facet", offsetof(tl_facet, ib), far_vertex),
    LIE("detect.contacts.kind", 1, zero),
    SPAN(law, far_row),
    SPAN(held, two),
    SPAN(kind, two),
    SPAN(rest, many),
    SPAN(changed, two),
    SPAN(begin, odd),
    SPAN(end, most),
    SPAN(limit, most),
    SPAN(limit, odd),
    SPAN(group_begin, most),
    SPAN(group_end, most),
    SPAN(group_limit, most),
    LIE("detect.layout.groups", offsetof(tl_simd_group, start), row_1),
    LIE("detect.layout.groups", offsetof(tl_simd_group, slots), row_0),
    LIE("detect.layout.groups", offsetof(tl_simd_group, slots), far_row),
    LIE("detect.layout.groups", offsetof(tl_simd_group, contact), all_bits),
    LIE("detect.laid_at", 0, long_hence),
    LIE("detect.layout.laid_rows", 0, most),
    LIE("detect.layout.added_at", 0, long_hence),
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
    LIE("detect.contacts.kind", 0, two),
    LIE("detect.layout.groups", 0, far_row),
    LIE("detect.laid_at", 0, long_ago),
    /* edits */
    LIE("model.cut_parts", offsetof(tl_cut_part, id), far_row),
    LIE("model.cut_parts", offsetof(tl_cut_part, root), all_bits),
    LIE("model.cut_parts", offsetof(tl_cut_part, r), huge),
    LIE("model.cut_parts", offsetof(tl_cut_part, place), infinite),
    LIE("model.splits", offsetof(tl_split, block), far_row),
    LIE("model.splits", offsetof(tl_split, whole), far_row),
    LIE("detect.cut_contacts", offsetof(tl_cut_contact, first), most),
    LIE("detect.cut_contacts", offsetof(tl_cut_contact, count), far_row),
    LIE("detect.cut_contacts", offsetof(tl_cut_contact, law), far_row),
    LIE("detect.cut_contacts", offsetof(tl_cut_contact, field), two),
    LIE("detect.cut_contacts", offsetof(tl_cut_contact, holds_over_gap), two),
    LIE("detect.cut_contacts", offsetof(tl_cut_contact, reframed), two),
    LIE("model.cut_parts", offsetof(tl_cut_part, root), two_row),
    LIE("model.splits", offsetof(tl_split, block), row_0),
    LIE("model.splits", offsetof(tl_split, whole), row_0),
    LIE("model.face_loads", offsetof(tl_face_load, block), row_0),
    LIE("model.face_loads", offsetof(tl_face_load, block), far_row),
    LIE("model.face_loads", offsetof(tl_face_load, force), infinite),
    LIE("model.face_loads", offsetof(tl_face_load, moment), infinite),
    LIE("detect.cut_contacts", offsetof(tl_cut_contact, count), two_row),
    LIE("detect.cut_contacts", offsetof(tl_cut_contact, pressed), two),
    /* histories */
    LIE("histories", 0, no_end),
    LIE("histories.0.cycles", 0, long_ago),
    LIE("histories.0.cycles", 0, long_hence),
    LIE("histories.0.cycles", 8, none),
    LIE("histories.0.times", 0, infinite),
    /* drives */
    LIE("drives", offsetof(tl_drive_kept, velocity), infinite),
    LIE("drives", offsetof(tl_drive_kept, angular_velocity), infinite),
    LIE("drives", offsetof(tl_drive_kept, velocity_now), infinite),
    LIE("drives", offsetof(tl_drive_kept, angular_velocity_now), infinite),
    /* frames that have been written */
    LIE("frames", 0, most),
    LIE("frames.0.times", 0, infinite),
    LIE("frames.0.parts", 0, all_bits),
    /* the step */
    LIE("cycle.dt", 0, below),
    LIE("cycle.dt", 0, infinite),
    LIE("cycle.all_held", 0, two),
};

/* What is found anew before it is used, and what only chooses how much room there is. */
static const lie harmless[] = {
    LIE("detect.spare_share", 0, most),
    LIE("cycle.reaction_of", 0, far_row),
    LIE("cycle.stiffness_rates", offsetof(struct tl_stiffness_rates, body), far_row),
    LIE("cycle.step_bounds.lightest", 0, far_row),
    LIE("cycle.added", offsetof(struct tl_added, worst), far_row),
    LIE("cycle.sums", offsetof(tl_sums, worst), far_row),
    LIE("cycle.sums", 0, infinite),
    /* at the bounds */
    LIE("model.min_area", 0, none),
    LIE("model.min_area", 8, none),
    LIE("model.min_area", 8, unknown),
    LIE("model.timestep.fraction", 0, all_of_it),
    LIE("model.timestep.fraction", 0, more_than_all),
    LIE("model.timestep.fraction", 0, unknown),
    LIE("model.dt", 0, none),
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

/* A chunk is missing: the file is refused, or the model is one that never had it. */
TEST(what_is_left_out_is_missed_or_not_needed)
{
    tl_archive from;
    tl_error error;
    size_t refused = 0;
    CHECK(tl_archive_open(&from, truth, &error) == TL_OK);
    for (size_t i = 0; i < from.chunk_count; i++) {
        char name[TL_CHUNK_NAME + 1];
        memcpy(name, from.chunks[i].name, from.chunks[i].name_bytes);
        name[from.chunks[i].name_bytes] = '\0';
        if (strcmp(name, "end") == 0)
            continue;
        write_lie(&(lie){.chunk = name});
        tl_status status = restored(&error);
        refused += status != TL_OK;
        if (status != TL_OK)
            CHECK_CONTAINS(error.text, "cannot restore");
    }
    CHECK(refused > from.chunk_count / 2);
    tl_archive_close(&from);
}

/* A law or a damping of which nothing is known here. */
TEST(what_is_not_loaded_is_named)
{
    static const char other = 'x';
    static const lie unknowns[] = {LIE("law.0.kind", 0, other), LIE("damping.kind", 0, other)};
    for (size_t i = 0; i < sizeof unknowns / sizeof *unknowns; i++) {
        tl_error error = {0};
        write_lie(&unknowns[i]);
        CHECK_INT(restored(&error), TL_E_NOT_FOUND);
        CHECK_CONTAINS(error.text, i == 0 ? "its law 'xoulomb'" : "its damping 'x");
        CHECK_CONTAINS(error.text, "which is not loaded: load it with --plugin");
    }
}

/* No row of a body that is kept lies beyond the last one, where it would be used. */
static bool rows_are_there(const tl_model *m)
{
    const struct tl_cycle *c = m->cycle;
    const uint32_t kept[] = {c->sums.worst, c->added.worst,
                             c->step_bounds.version ? c->step_bounds.lightest : TL_NO_ROW,
                             c->stiffness_rates.version ? c->stiffness_rates.body : TL_NO_ROW};
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++)
        if (kept[i] != TL_NO_ROW && kept[i] >= m->bodies.table.rows)
            return false;
    return true;
}

TEST(what_does_not_matter_is_restored)
{
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++) {
        tl_error error;
        tl_model *m = NULL;
        write_lie(&harmless[i]);
        if (!CHECK_INT(tl_model_restore(lie_path, 1, NULL, NULL, &m, &error), TL_OK))
            continue;
        CHECK(rows_are_there(m));
        CHECK_INT(tl_model_cycle(m, 1, NULL), TL_OK);
        tl_model_destroy(m);
    }
}

/* A file whose bytes the system does not give. */
TEST(what_cannot_be_read_is_refused)
{
    tl_error error = {0};
    tl_model *m = NULL;
    FILE *file = fopen("/proc/self/mem", "rb"); /* of Linux */
    if (!file)
        return;
    fclose(file);
    CHECK_INT(tl_model_restore("/proc/self/mem", 1, NULL, NULL, &m, &error), TL_E_IO);
    CHECK_CONTAINS(error.text, "cannot restore '/proc/self/mem': ");
    CHECK(m == NULL);
}

TEST_MAIN(RUN(what_is_true_is_restored), RUN(a_lie_is_refused), RUN(what_is_left_out_is_missed_or_not_needed),
          RUN(what_is_not_loaded_is_named), RUN(what_does_not_matter_is_restored), RUN(what_cannot_be_read_is_refused))
