/* edit_properties.c - random sequences of edits of cut rock: blocks deleted, joined, parted, hidden, cut and made, laws, minimum
 * areas and fixing changed, with steps in between. After each the contacts are compared with those of a detection that begins
 * anew: what presses where, and by how much. */
#include "contact_scene.h"

#include "contact/detection.h"
#include "contact/places.h"
#include "contact/store.h"
#include "detect/detect.h"
#include "generate/stage.h"
#include "generate/stage_commit.h"
#include "generate/staging.h"
#include "model/joints.h"
#include "model/rows.h"

#define MODELS 240
#define EDITS 14
#define KN 1e8
#define SHAKE 2e-4 /* m and rad */

/* By how much the presses of two contacts may differ, over the blocks' size cubed: two patches, and two fields, that are made anew;
 * and where one goes on by what it knows of its faces, which is good for edges that press by less than this: of SHAKE, by which a
 * face presses; blocks smaller than 1 m feel it more. */
#define ANEW 1e-8
#define ANEW_FIELD 1e-6
#define KEPT 4e-5
/* The same, over the press, of fields, and where one is a patch and the other a field that is nearly one: a contact stays what it is
 * for longer than a new one would be that, and a small block may be pressed far between the two. */
#define OTHER_KIND 0.15
/* The same of two patches, whose points may differ where a corner is hardly one. */
#define CORNERS 2e-3
/* Press, over the size cubed, from which a contact must be there in both: thinner ones may only touch. */
#define SEEN 1e-7

/* Blocks, by id, between which closures have counted from a place of their own, as those of new faces do. A contact that ends, or becomes a
 * field where that leaves no closure, forgets it: a new detection then finds more than the one that goes on. */
#define MOST_IDS 2048
static bool from_elsewhere[MOST_IDS][MOST_IDS];

/* The force of a contact over kn, were it elastic, on B; and its kind and number of points. */
typedef struct press {
    tl_vec3 force;
    uint32_t kind, points;
    bool stressed; /* it has an initial stress, and holds its faces for it: a new detection knows nothing of that */
} press;

static tl_vec3 press_of(tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_mat3 *turn = &m->bodies.pose[m->blocks.body[contacts->a[c]]].r;
    if (contacts->point_count[c] == 0)
        return tl_v3(0, 0, 0);
    if (contacts->facet[c].kind == TL_FACET_FIELD) {
        const tl_press *of = &tl_press_row_of(m, c)->press;
        double size = fmin(m->blocks.size[contacts->a[c]], m->blocks.size[contacts->b[c]]);
        /* with a minimum area a touch has a force; but a pair may sleep over what is no more than that */
        bool touches = of->deepest < 2 * TL_STILL * size;
        return touches ? tl_v3(0, 0, 0) : tl_m3_mul(turn, tl_v3_scale(2, of->force));
    }
    const tl_point_lanes *lanes = &m->detect->lanes[0];
    tl_vec3 sum = {0, 0, 0};
    tl_contact_places(m, c, lanes);
    for (size_t k = 0; k < contacts->point_count[c]; k++) {
        const tl_points_table *p = &m->detect->points;
        size_t i = tl_point_row(contacts, c, k);
        /* closures of new faces count from where they were made */
        double overlap = lanes->closure[k] + (p->reference ? p->reference[i] : 0);
        sum = tl_v3_madd(sum, p->area[i] * fmax(overlap, 0), tl_columns_get(lanes->normal, k));
    }
    return sum;
}

static bool is_stressed(tl_model *m, uint32_t c)
{
    const tl_press_row *row = tl_press_row_of(m, c);
    const tl_points_table *p = &m->detect->points;
    bool stressed = row && row->shift != 0;
    for (size_t k = 0; p->f_n0 && k < m->detect->contacts.point_count[c]; k++)
        stressed = stressed || p->f_n0[tl_point_row(&m->detect->contacts, c, k)] != 0;
    return stressed;
}

static void note_references(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    tl_id a = m->blocks.id[contacts->a[c]], b = m->blocks.id[contacts->b[c]];
    if (!CHECK(a < MOST_IDS && b < MOST_IDS))
        return;
    for (size_t k = 0; p->reference && k < contacts->point_count[c]; k++)
        if (p->reference[tl_point_row(contacts, c, k)] != 0)
            from_elsewhere[a][b] = true;
}

/* Presses of all contacts, [rows x rows] of blocks. */
static press *presses(tl_model *m, size_t rows)
{
    const tl_contacts *c = &m->detect->contacts;
    press *out = calloc(rows * rows, sizeof *out);
    for (uint32_t i = 0; i < c->table.rows; i++) {
        CHECK(c->a[i] < c->b[i] && c->b[i] < rows);
        CHECK(m->blocks.body[c->a[i]] != m->blocks.body[c->b[i]]);
        note_references(m, i);
        out[c->a[i] * rows + c->b[i]] =
            (press){press_of(m, i), (uint32_t)c->facet[i].kind, c->point_count[i], is_stressed(m, i)};
    }
    return out;
}

/* The lists of contacts by block are those of the contacts, in the order of partners. */
static void check_lists(const tl_model *m)
{
    const tl_detect *d = m->detect;
    const tl_contacts *c = &d->contacts;
    size_t rows = m->blocks.table.rows;
    CHECK_INT(d->by_block_start[rows], 2 * c->table.rows);
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t e = d->by_block_start[row]; e < d->by_block_start[row + 1]; e++) {
            uint32_t contact = d->by_block[e];
            CHECK(c->a[contact] == row || c->b[contact] == row);
            if (e > d->by_block_start[row])
                CHECK(tl_contact_partner(c, d->by_block[e - 1], row) < tl_contact_partner(c, contact, row));
        }
    for (uint32_t i = 0; i < d->pair_count; i++) {
        const tl_pair *p = &d->pairs[i];
        CHECK(p->a < p->b && p->b < rows);
        if (i)
            CHECK(p[-1].a < p->a || (p[-1].a == p->a && p[-1].b < p->b));
        if (!tl_pair_is_apart(p))
            CHECK(c->a[p->contact] == p->a && c->b[p->contact] == p->b && c->pair[p->contact] == i);
    }
}

/* Whether two presses of blocks of that size are the same. */
static bool are_same(const press *x, const press *y, double size, bool kept)
{
    double unit = size * size * size, size_y = tl_v3_norm(y->force) / unit;
    bool other = kept || x->kind != y->kind || x->points != y->points;
    double allowed = x->kind == TL_FACET_FIELD ? ANEW_FIELD + OTHER_KIND * size_y : ANEW + CORNERS * size_y;
    if (other)
        allowed = KEPT / fmin(size, 1) + OTHER_KIND * size_y;
    return scene_apart(x->force, y->force) <= (allowed + (size_y < SEEN ? SEEN : 0)) * unit;
}

/* Contacts that press by `x` are those that press by `y`. Returns how many press. */
static size_t check_presses(const tl_model *m, const press *x, const press *y, bool kept)
{
    size_t rows = m->blocks.table.rows, pressing = 0;
    for (uint32_t a = 0; a < rows; a++)
        for (uint32_t b = a + 1; b < rows; b++) {
            const press *one = &x[a * rows + b], *other = &y[a * rows + b];
            double size = fmin(m->blocks.size[a], m->blocks.size[b]);
            pressing += tl_v3_norm(other->force) > SEEN * size * size * size;
            bool forgot = one->points == 0 && from_elsewhere[m->blocks.id[a]][m->blocks.id[b]];
            if (one->stressed || forgot)
                continue;
            if (!CHECK(are_same(one, other, size, kept)))
                printf("blocks %u and %u of size %g press by %g, anew by %g\n", m->blocks.id[a], m->blocks.id[b], size,
                       tl_v3_norm(one->force), tl_v3_norm(other->force));
        }
    return pressing;
}

/* Presses of the contacts of another detection, which goes. */
static press *presses_of(tl_model *m, tl_detect *other)
{
    tl_detect *own = m->detect;
    m->detect = other;
    scene_ok(m, tl_detect_update(m));
    press *out = presses(m, m->blocks.table.rows);
    tl_detect_destroy(m->detect);
    m->detect = own;
    return out;
}

/* The same contacts, with the same presses, as a detection finds that begins now. Returns how many press. */
static size_t compare(tl_model *m)
{
    if (tl_detect_update(m) != TL_OK)
        return 0; /* too deep, and refused in both */
    check_lists(m);
    tl_detect *copy = tl_detect_copy(m->detect);
    for (uint32_t c = 0; c < copy->contacts.table.rows; c++)
        copy->contacts.points_valid_to[c] = copy->contacts.faces_valid_to[c] = -INFINITY;
    press *kept = presses(m, m->blocks.table.rows), *made = presses_of(m, copy);
    press *anew = presses_of(m, NULL);
    size_t pressing = check_presses(m, made, anew, false);
    check_presses(m, kept, anew, true);
    free(kept);
    free(made);
    free(anew);
    return pressing;
}

/* ---------------------------------------------------------------- edits ------------------ */

static void joint_plane(tl_model *m, tl_vec3 normal, tl_vec3 point, double radius)
{
    tl_stage stage;
    size_t met = 0;
    scene_ok(m, stage_begin(m, &stage));
    uint32_t number = tl_joint_intern(m, "J");
    tl_tag tag = {number, ++m->joints[number - 1].planes};
    const tl_fracture disc = tl_fracture_disc(normal, point, radius);
    scene_ok(m, tl_stage_cut_fracture(&stage, &disc, tag, 1, &met));
    scene_ok(m, tl_stage_commit(&stage));
}

static tl_model *rock(uint64_t *seed)
{
    tl_model *m = scene_model(1);
    m->config.reuse_geometry = check_random(seed) < 0.5;
    scene_law(m, "coulomb", KN, 0.5 * KN, 30);
    scene_box(m, tl_v3(0, 0, 0), tl_v3(3, 3, 2));
    int planes = 3 + (int)(4 * check_random(seed));
    for (int i = 0; i < planes; i++)
        joint_plane(m, scene_direction(seed),
                    tl_v3(scene_between(seed, 0, 3), scene_between(seed, 0, 3), scene_between(seed, 0, 2)),
                    (double)INFINITY);
    scene_box(m, tl_v3(-2, -2, -1), tl_v3(5, 5, 0));
    tl_id floor = m->blocks.id[m->blocks.table.rows - 1];
    scene_ok(m, tl_blocks_fix(m, &floor, 1, TL_FIX_ALL));
    tl_args none = {0};
    scene_ok(m, tl_model_damping(m, "local", &none));
    return m;
}

/* Moves the blocks a little, so that they overlap and part. */
static void shake(tl_model *m, uint64_t *seed)
{
    tl_rows_tidy(m);
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        if (m->bodies.fixed[body] != TL_FIX_ALL)
            scene_move(m, body, tl_v3_scale(SHAKE, scene_direction(seed)), tl_v3_scale(SHAKE, scene_direction(seed)));
}

static tl_id any_block(const tl_model *m, uint64_t *seed)
{
    return m->blocks.id[(size_t)(check_random(seed) * (double)m->blocks.table.rows)];
}

/* The blocks of a contact; false when there is none. */
static bool any_pair(tl_model *m, uint64_t *seed, tl_id pair[2])
{
    scene_ok(m, tl_detect_refresh(m));
    const tl_contacts *c = &m->detect->contacts;
    if (c->table.rows == 0)
        return false;
    size_t i = (size_t)(check_random(seed) * (double)c->table.rows);
    pair[0] = m->blocks.id[c->a[i]];
    pair[1] = m->blocks.id[c->b[i]];
    return true;
}

static void delete_some(tl_model *m, uint64_t *seed)
{
    for (int i = 0; i < 3 && m->blocks.table.rows > 4; i++) {
        tl_id id = any_block(m, seed);
        if (tl_block_row_quiet(m, id) != TL_NO_ROW && check_random(seed) < 0.6)
            scene_ok(m, tl_blocks_delete(m, &id, 1));
    }
}

/* A box on the floor beside the others, where none has been. */
static void add_box(tl_model *m)
{
    double column = m->next_id % 7, row = m->next_id / 7 % 7;
    bool free_place = column < 2 || column > 4 || row < 2 || row > 4;
    tl_vec3 at = {column - 2, row - 2, -1e-4}, size = {1 + 1e-5, 1 - 1e-5, 0.7};
    for (uint32_t i = 0; i < m->blocks.table.rows; i++)
        if (tl_v3_norm(tl_v3_sub(tl_block_centroid(m, i), tl_v3_madd(at, 0.5, size))) < 0.8)
            free_place = false;
    if (free_place)
        scene_box(m, at, tl_v3_add(at, size));
}

static void edit(tl_model *m, uint64_t *seed)
{
    tl_id id, pair[2];
    tl_rows_tidy(m);
    id = any_block(m, seed);
    switch ((int)(10 * check_random(seed))) {
    case 0: delete_some(m, seed); break;
    case 1:
        if (any_pair(m, seed, pair))
            scene_ok(m, tl_blocks_join(m, pair, 2));
        break;
    case 2: scene_ok(m, tl_blocks_unjoin(m, &id, 1)); break;
    case 3: scene_ok(m, tl_blocks_hide(m, &id, 1, check_random(seed) < 0.5)); break;
    case 4:
        joint_plane(m, scene_direction(seed), tl_block_centroid(m, tl_block_row_quiet(m, id)),
                    check_random(seed) < 0.7 ? 0.1 : (double)INFINITY);
        break;
    case 5: add_box(m); break;
    case 6: scene_law(m, "coulomb", KN, 0.5 * KN, scene_between(seed, 20, 40)); break;
    case 7:
        scene_ok(m, tl_model_contact_area(m, &(tl_contact_area){sizeof(tl_contact_area), 1e-3, NAN, NULL}));
        compare(m);
        scene_ok(m, tl_model_contact_area(m, &(tl_contact_area){sizeof(tl_contact_area), 0, NAN, NULL}));
        break;
    case 8: scene_ok(m, tl_blocks_fix(m, &id, 1, TL_FIX_ALL)); break;
    default: scene_ok(m, tl_blocks_free(m, &id, 1)); break;
    }
}

/* ---------------------------------------------------------------- tests ------------------ */

TEST(an_edit_leaves_what_a_new_detection_finds)
{
    uint64_t seed = 1;
    size_t pressing = 0;
    for (int i = 0; i < check_cases(MODELS); i++) {
        tl_model *m = rock(&seed);
        tl_solve_result result;
        memset(from_elsewhere, 0, sizeof from_elsewhere);
        shake(m, &seed);
        scene_ok(m, tl_model_cycle(m, 5, &result));
        for (int k = 0; k < EDITS; k++) {
            int edits = 1 + (int)(3 * check_random(&seed));
            for (int e = 0; e < edits; e++)
                edit(m, &seed);
            pressing += compare(m);
            int64_t steps = (int64_t)(4 * check_random(&seed));
            if (tl_model_cycle(m, steps, &result) != TL_OK)
                break; /* what was pressed too deep cannot go on */
            if (check_random(&seed) < 0.3)
                shake(m, &seed);
            pressing += compare(m);
        }
        tl_model_destroy(m);
    }
    printf("%zu presses compared\n", pressing);
    CHECK(pressing > (size_t)(500 * check_cases(MODELS)));
}

/* A joined body runs on from the odometer of one of its parts. */
TEST(a_contact_of_a_body_that_had_run_far_is_followed)
{
    tl_model *m = scene_model(1);
    scene_law(m, "coulomb", KN, KN, 30);
    for (int i = 0; i < 3; i++)
        scene_box(m, tl_v3(i, 0, 0), tl_v3(i + 1, 1, 1));
    m->bodies.odometer[1] = 1e3;
    scene_ok(m, tl_detect_update(m));
    const tl_id pair[2] = {m->blocks.id[0], m->blocks.id[1]};
    scene_ok(m, tl_blocks_join(m, pair, 2));
    scene_ok(m, tl_detect_update(m));
    scene_move(m, m->blocks.body[1], tl_v3(0, 0.1, 0), tl_v3(0, 0, 0));
    scene_ok(m, tl_detect_update(m));
    CHECK_NEAR(m->detect->contacts.area[scene_contact(m, 1, 2)], 0.9, 1e-12);
    tl_model_destroy(m);
}

/* Edits one after the other make the same model as rows that are tidied after each, to the bit. */
TEST(untidy_rows_change_nothing)
{
    uint64_t seed = 7;
    for (int i = 0; i < check_cases(20); i++) {
        char hash[2][33];
        uint64_t from = seed;
        for (int tidy = 0; tidy < 2; tidy++) {
            seed = from;
            tl_model *m = rock(&seed);
            tl_solve_result result;
            scene_ok(m, tl_model_cycle(m, 3, &result));
            for (int k = 0; k < 4; k++) {
                tl_id id = 1 + (tl_id)(check_random(&seed) * (double)(m->next_id - 1));
                if (tl_block_row_quiet(m, id) != TL_NO_ROW)
                    scene_ok(m, tl_blocks_delete(m, &id, 1));
                if (tidy)
                    tl_rows_tidy(m);
                double x = scene_between(&seed, -1, 4);
                tl_stage stage;
                scene_ok(m, tl_stage_begin_empty(m, &stage));
                scene_ok(m, tl_stage_add_box(&stage, tl_v3(x, x, 3.0 + 2 * k), tl_v3(x + 1, x + 1, 4.0 + 2 * k), 2000,
                                             "box"));
                scene_ok(m, tl_stage_commit(&stage));
            }
            scene_ok(m, tl_model_cycle(m, 3, &result));
            scene_ok(m, tl_state_hash(m, hash[tidy]));
            tl_model_destroy(m);
        }
        CHECK_TEXT(hash[0], hash[1]);
    }
}

TEST_MAIN(RUN(an_edit_leaves_what_a_new_detection_finds), RUN(untidy_rows_change_nothing),
          RUN(a_contact_of_a_body_that_had_run_far_is_followed))
