/* test_scene.c - the chunks of a frame: what is sent once, what is sent again, and how long each is.
 *
 * tests/python/test_scene.py reads what is in them, with a reader of its own. */
#include "check.h"

#include "io/page.h"
#include "io/pieces.h"
#include "io/scene.h"
#include "zone/zones.h"
#include "zoned_column.h"

#include <talus/talus.h>
#include <zlib.h>

/* ---------------------------------------------------------------- models ----------------- */

static tl_model *empty_model(int64_t threads)
{
    tl_model_config config = tl_model_config_default();
    config.threads = threads;
    tl_model *m = NULL;
    tl_error error = {TL_OK, ""};
    tl_plugins_load_default();
    CHECK_INT(tl_model_create(&config, &m, &error), TL_OK);
    return m;
}

static void add_box(tl_model *m, double x, double size)
{
    const double min[] = {x, 0, 0}, max[] = {x + size, size, size};
    const tl_value values[] = {{.key = "min", .type = TL_VALUE_NUMBERS, .data = min, .count = 3},
                               {.key = "max", .type = TL_VALUE_NUMBERS, .data = max, .count = 3},
                               {.key = "density", .type = TL_VALUE_NUMBER, .number = 2500}};
    const tl_args args = {values, 3};
    tl_generate_summary summary;
    CHECK_INT(tl_generate(m, "box", &args, &summary), TL_OK);
}

static void cut(tl_model *m, const char *joint, double x)
{
    const double origin[] = {x, 0, 0};
    const tl_value values[] = {{.key = "joint", .type = TL_VALUE_STRING, .text = joint},
                               {.key = "dip", .type = TL_VALUE_NUMBER, .number = 90},
                               {.key = "dip_direction", .type = TL_VALUE_NUMBER, .number = 90},
                               {.key = "origin", .type = TL_VALUE_NUMBERS, .data = origin, .count = 3}};
    const tl_args args = {values, 4};
    tl_generate_summary summary;
    CHECK_INT(tl_generate(m, "joint", &args, &summary), TL_OK);
}

static void set_law(tl_model *m)
{
    const tl_value law[] = {{.key = "kn", .type = TL_VALUE_NUMBER, .number = 1e8},
                            {.key = "ks", .type = TL_VALUE_NUMBER, .number = 1e8}};
    const tl_args args = {law, 2};
    CHECK_INT(tl_joint_law(m, "*", "elastic", &args), TL_OK);
}

/* ---------------------------------------------------------------- chunks ----------------- */

#define MOST_CHUNKS 32

typedef struct frame {
    char letters[MOST_CHUNKS][5];
    const unsigned char *payload[MOST_CHUNKS];
    uint32_t length[MOST_CHUNKS];
    size_t count;
    tl_piece bytes;
    tl_scene_facts facts;
} frame;

static uint32_t u32(const unsigned char *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static void free_frame(frame *f)
{
    free(f->bytes.data);
    *f = (frame){.count = 0};
}

/* Writes the next frame and finds its chunks, which fill it. */
static tl_status write_frame(frame *f, tl_scene *scene, tl_model *m, const tl_html *options)
{
    const tl_html none = tl_html_default();
    free_frame(f);
    tl_status status = tl_scene_write(scene, m, options ? options : &none, &f->bytes, &f->facts);
    size_t at = 0;
    while (status == TL_OK && at + 8 <= f->bytes.length && f->count < MOST_CHUNKS) {
        memcpy(f->letters[f->count], f->bytes.data + at, 4);
        f->length[f->count] = u32(f->bytes.data + at + 4);
        f->payload[f->count] = f->bytes.data + at + 8;
        at += 8 + ((size_t)f->length[f->count] + 3) / 4 * 4;
        f->count++;
    }
    if (status == TL_OK)
        CHECK_INT(at, f->bytes.length);
    return status;
}

/* "HEAD SHAP FRAM" ... */
static const char *names_of(const frame *f)
{
    static char text[6 * MOST_CHUNKS];
    text[0] = '\0';
    for (size_t i = 0; i < f->count; i++) {
        strcat(text, i ? " " : "");
        strcat(text, f->letters[i]);
    }
    return text;
}

/* The first number of a chunk, which is how many things it has; 0 where there is no such chunk. */
static uint32_t first_of(const frame *f, const char *letters)
{
    for (size_t i = 0; i < f->count; i++)
        if (strcmp(f->letters[i], letters) == 0)
            return u32(f->payload[i] + (strcmp(letters, "FRAM") == 0 ? 16 : 0));
    return 0;
}

static uint32_t length_of(const frame *f, const char *letters)
{
    for (size_t i = 0; i < f->count; i++)
        if (strcmp(f->letters[i], letters) == 0)
            return f->length[i];
    return 0;
}

TEST(what_is_sent_once)
{
    tl_model *m = empty_model(1);
    tl_scene scene = {0};
    frame f = {.count = 0};
    add_box(m, 0, 4);
    cut(m, "east", 1);
    set_law(m);
    CHECK_INT(write_frame(&f, &scene, m, NULL), TL_OK);
    CHECK_TEXT(names_of(&f), "HEAD SHAP TOUC FRAM CONT LAWS LINE FIND DONE");
    CHECK(f.facts.news > 0);
    CHECK_INT(first_of(&f, "SHAP"), 2);
    CHECK_INT(first_of(&f, "TOUC"), 2);
    CHECK_INT(length_of(&f, "TOUC"), 4 + 2 * 16);
    CHECK_INT(first_of(&f, "FRAM"), 2);
    CHECK_INT(first_of(&f, "CONT"), 1);
    CHECK_INT(first_of(&f, "DONE"), 0);
    /* two boxes: 8 vertices, 6 faces, 24 corners each */
    CHECK_INT(length_of(&f, "SHAP"), 16 + 2 * 40 + 16 * 12 + 12 * 10 + 48 * 2);
    CHECK_INT(length_of(&f, "FRAM"), 20 + 2 * 84 + 4);
    CHECK_INT(length_of(&f, "CONT"), 12 + 68 + 4 + 8 + 4 * 12); /* one polygon of four corners */
    CHECK_INT(length_of(&f, "LINE"), 64 + 4);

    CHECK_INT(write_frame(&f, &scene, m, NULL), TL_OK); /* the one before was not sent */
    CHECK_TEXT(names_of(&f), "HEAD SHAP TOUC FRAM CONT LAWS LINE FIND DONE");
    tl_scene_accept(&scene);
    const tl_html without = {.size = sizeof without, .contacts = TL_HTML_CONTACTS_NONE};
    CHECK_INT(write_frame(&f, &scene, m, &without), TL_OK);
    CHECK_TEXT(names_of(&f), "FRAM LINE FIND DONE");
    CHECK(f.facts.news == 0);
    CHECK_INT(first_of(&f, "DONE"), 1);
    tl_scene_accept(&scene);
    tl_model_set_gravity(m, (tl_vec3){0, 1, -9});
    CHECK_INT(write_frame(&f, &scene, m, &without), TL_OK);
    CHECK_TEXT(names_of(&f), "HEAD FRAM LINE FIND DONE");
    CHECK(f.facts.news > 0);
    free_frame(&f);
    tl_scene_free(&scene);
    tl_model_destroy(m);
}

/* Writes and sends a frame without contacts; its chunks. */
static const char *next_frame(frame *f, tl_scene *scene, tl_model *m)
{
    const tl_html without = {.size = sizeof without, .contacts = TL_HTML_CONTACTS_NONE};
    CHECK_INT(write_frame(f, scene, m, &without), TL_OK);
    tl_scene_accept(scene);
    return names_of(f);
}

/* ---------------------------------------------------------------- zones ------------------ */

static float f32(const unsigned char *at)
{
    const uint32_t bits = u32(at);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* The columns of SURF. */
typedef struct surface {
    uint32_t points, zones, triangles;
    const unsigned char *made, *corner, *triangle, *zone, *block;
} surface;

static surface surface_of(const frame *f)
{
    surface s = {0};
    for (size_t i = 0; i < f->count; i++)
        if (strcmp(f->letters[i], "SURF") == 0) {
            const unsigned char *at = f->payload[i];
            CHECK_INT(u32(at), 1);
            s.points = u32(at + 4);
            s.zones = u32(at + 8);
            s.triangles = u32(at + 12);
            CHECK_INT(u32(at + 16), 1);
            CHECK_INT(u32(at + 20), 2); /* the body */
            s.made = at + 36;
            s.corner = s.made + 12 * (size_t)s.points;
            s.triangle = s.corner + 20 * (size_t)s.zones + ((size_t)s.zones * 2 + 3) / 4 * 4;
            s.zone = s.triangle + 12 * (size_t)s.triangles;
            s.block = s.zone + 4 * (size_t)s.triangles;
            CHECK_INT(f->length[i], 36 + (size_t)(s.block - s.made) + 8 * (size_t)s.triangles);
        }
    return s;
}

static tl_vec3 point_of(const unsigned char *places, uint32_t point)
{
    const unsigned char *at = places + 12 * (size_t)point;
    return tl_v3((double)f32(at), (double)f32(at + 4), (double)f32(at + 8));
}

/* The triangles enclose as much as the zones fill, and each is a side of its zone. */
static void check_surface(const surface *s, const unsigned char *places, double volume)
{
    double enclosed = 0, filled = 0;
    for (uint32_t k = 0; k < s->triangles; k++) {
        tl_vec3 x[3];
        const uint32_t zone = u32(s->zone + 4 * (size_t)k);
        int shared = 0;
        for (int c = 0; c < 3; c++) {
            const uint32_t corner = u32(s->triangle + 12 * (size_t)k + 4 * (size_t)c);
            x[c] = point_of(places, corner);
            for (int a = 0; a < 4; a++)
                shared += corner == u32(s->corner + 16 * (size_t)zone + 4 * (size_t)a);
        }
        CHECK_INT(shared, 3);
        CHECK_INT(u32(s->block + 4 * (size_t)k), 2);
        enclosed += tl_v3_dot(x[0], tl_v3_cross(x[1], x[2])) / 6;
    }
    for (uint32_t k = 0; k < s->zones; k++) {
        tl_vec3 x[4];
        for (int a = 0; a < 4; a++)
            x[a] = point_of(places, u32(s->corner + 16 * (size_t)k + 4 * (size_t)a));
        filled += tl_v3_dot(tl_v3_sub(x[1], x[0]), tl_v3_cross(tl_v3_sub(x[2], x[0]), tl_v3_sub(x[3], x[0]))) / 6;
    }
    CHECK_NEAR(enclosed, volume, 1e-3);
    CHECK_NEAR(filled, enclosed, 1e-4);
}

static const unsigned char *payload_of(const frame *f, const char *letters, uint32_t number)
{
    for (size_t i = 0; i < f->count; i++)
        if (strcmp(f->letters[i], letters) == 0 && number-- == 0)
            return f->payload[i];
    return NULL;
}

/* The mesh goes once, and again when it is another; places and numbers of the zones go in every frame. */
TEST(zones_are_sent_with_their_numbers)
{
    tl_model *m = empty_model(2);
    tl_scene scene = {0};
    frame f = {.count = 0};
    tl_solve_result result;
    zoned_column(m, 0.7);
    CHECK_INT(write_frame(&f, &scene, m, NULL), TL_OK);
    CHECK_TEXT(names_of(&f),
               "HEAD SHAP TOUC SURF FRAM SPOS ZFLD ZFLD ZFLD ZFLD ZFLD ZFLD ZFLD ZFLD ZFLD CONT LAWS LINE FIND DONE");
    CHECK(strstr((const char *)f.payload[0], "\"solids\": [\"rock\"]") != NULL);
    const surface s = surface_of(&f);
    CHECK_INT(s.zones, m->zones->mesh[0].zone_end - m->zones->mesh[0].zone_begin);
    check_surface(&s, s.made, 6);
    tl_scene_accept(&scene);
    CHECK_INT(tl_model_cycle(m, 400, &result), TL_OK);
    frame later = {.count = 0};
    CHECK_INT(write_frame(&later, &scene, m, NULL), TL_OK);
    CHECK_TEXT(names_of(&later), "FRAM SPOS ZFLD ZFLD ZFLD ZFLD ZFLD ZFLD ZFLD ZFLD ZFLD CONT LAWS LINE FIND DONE");
    const unsigned char *places = payload_of(&later, "SPOS", 0) + 4, *moved = places + 12 * (size_t)s.points;
    check_surface(&s, places, 6);
    double largest = 0;
    for (uint32_t k = 0; k < s.points; k++) {
        const tl_vec3 u = point_of(moved, k), x = point_of(places, k), made = point_of(s.made, k);
        CHECK(tl_v3_norm(tl_v3_sub(tl_v3_sub(x, made), u)) < 1e-6);
        largest = fmax(largest, tl_v3_norm(u));
    }
    CHECK(largest > 0 && later.facts.largest >= largest * (1 - 1e-6));
    uint32_t yielding = 0;
    for (uint32_t number = 0; number < 9; number++) {
        const unsigned char *field = payload_of(&later, "ZFLD", number);
        CHECK_INT(u32(field), number);
        CHECK_INT(u32(field + 4), s.zones);
        for (uint32_t k = 0; k < s.zones; k++) {
            const uint32_t row = m->zones->row_of[k];
            const double value = (double)f32(field + 8 + 4 * (size_t)k);
            if (number < 6)
                CHECK_NEAR(value, m->zones->zones.stress[number][row], 1e-6 * fabs(value));
            yielding += number == 6 && value > 0;
        }
    }
    CHECK(yielding > 0 && yielding < s.zones);
    free_frame(&f);
    free_frame(&later);
    tl_scene_forget(&scene);
    CHECK_INT(write_frame(&f, &scene, m, NULL), TL_OK);
    CHECK(payload_of(&f, "SURF", 0) != NULL);
    tl_scene_accept(&scene);
    const tl_id column = 2;
    CHECK_INT(tl_blocks_delete(m, &column, 1), TL_OK);
    CHECK_INT(write_frame(&f, &scene, m, NULL), TL_OK);
    CHECK_TEXT(names_of(&f), "HEAD GONE TOUC SURF FRAM CONT LAWS LINE FIND DONE");
    CHECK_INT(u32(payload_of(&f, "SURF", 0)), 0);
    tl_scene_accept(&scene);
    CHECK_INT(write_frame(&f, &scene, m, NULL), TL_OK);
    CHECK(payload_of(&f, "SURF", 0) == NULL);
    free_frame(&f);
    tl_scene_free(&scene);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- changes ---------------- */

TEST(what_has_changed_is_sent_again)
{
    tl_model *m = empty_model(1);
    tl_scene scene = {0};
    frame f = {.count = 0};
    add_box(m, 0, 4);
    add_box(m, 6, 1);
    CHECK_TEXT(next_frame(&f, &scene, m), "HEAD SHAP TOUC FRAM LINE FIND DONE");
    CHECK_TEXT(next_frame(&f, &scene, m), "FRAM LINE FIND DONE");

    cut(m, "east", 2); /* two blocks in the place of the first */
    next_frame(&f, &scene, m);
    CHECK_INT(first_of(&f, "SHAP"), 2);
    CHECK_INT(first_of(&f, "FRAM"), 3);
    CHECK_INT(first_of(&f, "GONE"), 1);

    const tl_id parts[] = {3, 4};
    CHECK_INT(tl_blocks_join(m, parts, 2), TL_OK); /* the median is that of other bodies */
    CHECK_TEXT(next_frame(&f, &scene, m), "HEAD SHAP TOUC FRAM LINE FIND DONE");
    CHECK_INT(first_of(&f, "SHAP"), 2);

    const tl_id small = 2;
    const tl_vec3 unchanged = {NAN, NAN, NAN};
    tl_block_set set = {sizeof set, NAN, "small", unchanged, unchanged, NULL};
    CHECK_INT(tl_blocks_set(m, &small, 1, &set), TL_OK);
    CHECK_TEXT(next_frame(&f, &scene, m), "HEAD SHAP FRAM LINE FIND DONE");
    CHECK_INT(first_of(&f, "SHAP"), 1);
    set.group = NULL;
    set.density = 1000;
    CHECK_INT(tl_blocks_set(m, &small, 1, &set), TL_OK);
    CHECK_TEXT(next_frame(&f, &scene, m), "SHAP FRAM LINE FIND DONE");

    CHECK_INT(tl_blocks_delete(m, &small, 1), TL_OK);
    next_frame(&f, &scene, m);
    CHECK_INT(first_of(&f, "GONE"), 1);
    CHECK_INT(first_of(&f, "SHAP"), 0);
    CHECK_INT(first_of(&f, "FRAM"), 2);
    CHECK_TEXT(next_frame(&f, &scene, m), "FRAM LINE FIND DONE");
    free_frame(&f);
    tl_scene_free(&scene);
    tl_model_destroy(m);
}

TEST(refused_cuts_are_told_when_there_are_more)
{
    tl_model *m = empty_model(1);
    tl_scene scene = {0};
    frame f = {.count = 0};
    add_box(m, 0, 4);
    CHECK_TEXT(next_frame(&f, &scene, m), "HEAD SHAP TOUC FRAM LINE FIND DONE");
    cut(m, "east", 2);
    cut(m, "thin", 2 + 1e-5); /* a sliver of the eastern half */
    CHECK_TEXT(next_frame(&f, &scene, m), "HEAD SHAP GONE REFU TOUC FRAM LINE FIND DONE");
    CHECK_INT(first_of(&f, "REFU"), 1);
    CHECK_INT(length_of(&f, "REFU"), 8 + 44);
    tl_quality q;
    CHECK_INT(tl_model_quality(m, &q), TL_OK);
    CHECK_INT(q.refused_listed, 1);
    const unsigned char *at = f.payload[3];
    CHECK_INT(u32(at + 4), 1);
    CHECK_INT(u32(at + 8), 2);  /* "thin" */
    CHECK_INT(u32(at + 12), 1); /* its plane */
    CHECK_INT(u32(at + 16), q.refused_cuts[0].block);
    CHECK_NEAR(f32(at + 20), 1, 1e-6);                      /* normal */
    CHECK_NEAR(f32(at + 32), 2 + 1e-5 - m->origin.x, 1e-6); /* point */
    CHECK_NEAR(f32(at + 44), q.refused_cuts[0].thickness, 1e-11);
    CHECK_NEAR(f32(at + 48), q.refused_cuts[0].limit, 1e-11);
    CHECK(f.facts.news > 0);
    CHECK_TEXT(next_frame(&f, &scene, m), "FRAM LINE FIND DONE");
    cut(m, "thin", 2 - 1e-5);
    CHECK_INT(write_frame(&f, &scene, m, NULL), TL_OK); /* not sent: it is told again */
    CHECK_INT(first_of(&f, "REFU"), 2);
    CHECK_TEXT(next_frame(&f, &scene, m), "SHAP REFU FRAM LINE FIND DONE"); /* its face takes the joint */
    CHECK_INT(first_of(&f, "REFU"), 2);
    tl_scene_forget(&scene);
    CHECK_TEXT(next_frame(&f, &scene, m), "HEAD SHAP REFU TOUC FRAM LINE FIND DONE");
    free_frame(&f);
    tl_scene_free(&scene);
    tl_model_destroy(m);
}

TEST(an_empty_model_is_a_frame)
{
    tl_model *m = empty_model(1);
    tl_scene scene = {0};
    frame f = {.count = 0};
    CHECK_TEXT(next_frame(&f, &scene, m), "HEAD TOUC FRAM LINE FIND DONE");
    CHECK_INT(first_of(&f, "FRAM"), 0);
    CHECK(f.facts.largest == 0);
    CHECK_INT(write_frame(&f, &scene, m, NULL), TL_OK);
    CHECK_INT(first_of(&f, "CONT"), 0);
    free_frame(&f);
    tl_scene_free(&scene);
    tl_model_destroy(m);
}

TEST(fields_have_a_value_for_each)
{
    tl_model *m = empty_model(1);
    tl_scene scene = {0};
    frame f = {.count = 0};
    add_box(m, 0, 4);
    cut(m, "east", 1);
    const double values[] = {1, NAN, 3};
    tl_extra_field field = {.name = "safety", .unit = "m", .values = values, .count = 2};
    tl_html html = {.size = sizeof html, .block_fields = &field, .block_field_count = 1};
    CHECK_INT(write_frame(&f, &scene, m, &html), TL_OK);
    CHECK_TEXT(names_of(&f), "HEAD SHAP TOUC FRAM FIEL CONT LAWS LINE FIND DONE");
    CHECK_INT(length_of(&f, "FIEL"), 12 + 8);
    field.count = 3;
    CHECK_INT(write_frame(&f, &scene, m, &html), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "'safety' has 3 values, and there are 2 blocks");
    html.block_field_count = 0;
    html.contact_fields = &field;
    html.contact_field_count = 1;
    CHECK_INT(write_frame(&f, &scene, m, &html), TL_E_ARGUMENT);
    CHECK_CONTAINS(tl_model_error(m)->text, "'safety' has 3 values, and there are 1 contacts");
    free_frame(&f);
    tl_scene_free(&scene);
    tl_model_destroy(m);
}

/* ---------------------------------------------------------------- packing ---------------- */

static int digit_of(unsigned char letter)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *at = letter ? strchr(letters, letter) : NULL;
    return at ? (int)(at - letters) : -1;
}

/* The bytes of a text; the caller's. */
static unsigned char *decoded(const tl_piece *text, size_t *bytes)
{
    unsigned char *out = malloc(text->length + 1);
    *bytes = 0;
    for (size_t i = 0; i + 3 < text->length; i += 4) {
        uint32_t bits = 0;
        int fill = (text->data[i + 2] == '=') + (text->data[i + 3] == '=');
        for (int k = 0; k < 4; k++)
            bits = bits << 6 | (uint32_t)(k >= 4 - fill ? 0 : digit_of(text->data[i + (size_t)k]));
        for (int k = 0; k < 3 - fill; k++)
            out[(*bytes)++] = (unsigned char)(bits >> (16 - 8 * k));
    }
    return out;
}

/* Bytes of all kinds: zeros, noise, texts, numbers that count. */
static void fill(unsigned char *data, size_t bytes, uint64_t *state)
{
    for (size_t i = 0; i < bytes; i++)
        switch (i >> 15 & 3) {
        case 0: data[i] = 0; break;
        case 1: data[i] = (unsigned char)(check_random(state) * 256); break;
        case 2: data[i] = (unsigned char)"some words again and again; "[i % 28]; break;
        default: data[i] = (unsigned char)(i >> 2 >> (8 * (i & 3))); break;
        }
}

TEST(what_is_packed_unpacks)
{
    static const size_t sizes[] = {0,      1,      2,      3,      4,      5,      100,    32768,  32769,
                                   196607, 262143, 262144, 262145, 524288, 524289, 700001, 3000000};
    tl_model *one = empty_model(1), *three = empty_model(3);
    uint64_t state = 7;
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        unsigned char *data = malloc(sizes[k] + 1), *out = malloc(sizes[k] + 1);
        tl_piece text = {0}, again = {0};
        fill(data, sizes[k], &state);
        CHECK_INT(tl_pack(one, data, sizes[k], &text), TL_OK);
        CHECK_INT(tl_pack(three, data, sizes[k], &again), TL_OK);
        CHECK(text.length == again.length && memcmp(text.data, again.data, text.length) == 0);
        size_t packed;
        unsigned char *stream = decoded(&text, &packed);
        uLongf length = (uLongf)sizes[k] + 1;
        CHECK_INT(uncompress(out, &length, stream, (uLong)packed), Z_OK);
        CHECK_INT(length, sizes[k]);
        CHECK(memcmp(data, out, sizes[k]) == 0);
        CHECK(sizes[k] < 100000 || packed < sizes[k]);
        free(stream);
        free(text.data);
        free(again.data);
        free(data);
        free(out);
    }
    tl_model_destroy(one);
    tl_model_destroy(three);
}

TEST_MAIN(RUN(what_is_sent_once), RUN(zones_are_sent_with_their_numbers), RUN(what_has_changed_is_sent_again),
          RUN(refused_cuts_are_told_when_there_are_more), RUN(an_empty_model_is_a_frame),
          RUN(fields_have_a_value_for_each), RUN(what_is_packed_unpacks))
