/* cut_properties.c - more than 200,000 seeded random cuts: whatever the plane, both children are
 * closed, convex polyhedra that share their new vertices bit for bit, and their volumes add up to that
 * of the block that is cut, however thin it is, to 1e-11 of it.
 *
 * Blocks stand about the zero of their frame, as a model keeps them: once by themselves, and once cut
 * in a model at zero and in one a million away. Raw coordinates of a million leave a block of 8 but
 * ten digits: there the topology alone is tested. */
#include "check.h"
#include "cut_planes.h"
#include "generate/stage.h"
#include "generate/stage_commit.h"
#include "generate/staging.h"
#include "geometry/cut.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/polyhedron.h"
#include "model/joints.h"
#include "model/model.h"
#include "staged.h"

#include <float.h>
#include <talus/vmath.h>

/* Volume that a cut may lose, of the block that is cut; and all cuts of a block, of that block. */
#define VOLUME_TOLERANCE 1e-11
/* Faces are plane and corners convex to this times the farthest coordinate of the block all come from. */
#define SHAPE_TOLERANCE (128 * DBL_EPSILON)
/* Side of the first block. */
#define SIDE 8.0
/* Pieces are cut on and on until volume over surface comes below this times SIDE: that of a plate half
 * as thick as the thinnest side that may be cut off the first block. Planes are known to a rounding of
 * the coordinates in which the first block was cut, so much thinner pieces have no eleven digits. */
#define THINNEST (0.5 * TL_POLY_THIN)

enum {
    LIVE = 96, /* blocks kept of one parent */
    ROW = 200  /* cuts tried before the next parent */
};

static int same_bits(tl_vec3 a, tl_vec3 b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* The vertices of the two caps are the same bits in opposite order from the same start. */
static int caps_match(const tl_poly *low, const tl_poly *high)
{
    uint32_t f = low->face_count - 1, g = high->face_count - 1, n = tl_poly_face_size(low, f);
    if (tl_poly_face_size(high, g) != n)
        return 0;
    const uint16_t *a = low->loop + low->start[f], *b = high->loop + high->start[g];
    for (uint32_t i = 0; i < n; i++)
        if (!same_bits(low->vertex[a[i]], high->vertex[b[(n - i) % n]]))
            return 0;
    return 1;
}

/* Every vertex of the parent is, bit for bit, in the child on its side. */
static int vertices_kept(const tl_poly *parent, const tl_poly *low, const tl_poly *high)
{
    for (uint32_t v = 0; v < parent->vertex_count; v++) {
        int found = 0;
        for (uint32_t i = 0; i < low->vertex_count && !found; i++)
            found = same_bits(low->vertex[i], parent->vertex[v]);
        for (uint32_t i = 0; i < high->vertex_count && !found; i++)
            found = same_bits(high->vertex[i], parent->vertex[v]);
        if (!found)
            return 0;
    }
    return 1;
}

/* Cut again by the same plane, a child only finds its cap there. */
static int finds_cap_again(const tl_poly *child, tl_plane plane)
{
    tl_cut again;
    tl_error error;
    if (tl_poly_cut(child, plane, 0, (tl_tag){1, 1}, &again, &error))
        return 0;
    return again.result == TL_CUT_COINCIDENT && again.face == child->face_count - 1;
}

typedef struct tally {
    int cuts, made, refused, coincident, missed;
    double worst; /* volume lost by a cut, of the block that was cut */
} tally;

static void count_result(tally *t, tl_cut_result result)
{
    t->cuts++;
    t->made += result == TL_CUT_MADE;
    t->refused += result == TL_CUT_REFUSED;
    t->missed += result == TL_CUT_MISS;
    t->coincident += result == TL_CUT_COINCIDENT;
}

static void report(const char *name, const tally *t)
{
    printf("    %s: %d cuts, %d made, %d missed, %d coincident, %d too thin, volume to %.1e\n", name, t->cuts, t->made,
           t->missed, t->coincident, t->refused, t->worst);
}

static void check_volume(double sum, double whole, tally *t)
{
    t->worst = fmax(t->worst, fabs(sum - whole) / whole);
    CHECK_REL(sum, whole, VOLUME_TOLERANCE);
}

/* Whether a block is too thin to be cut further. */
static bool is_spent(const tl_poly *p)
{
    double surface = 0;
    for (uint32_t f = 0; f < p->face_count; f++)
        surface += tl_poly_face_area(p, f);
    return tl_poly_mass(p).volume < THINNEST * SIDE * surface;
}

/* `accuracy` is a length. */
static void check_shape(const tl_poly *p, double accuracy)
{
    tl_error error = {0};
    if (!CHECK_INT(tl_poly_check(p, accuracy / p->size, &error), TL_OK))
        printf("    %s\n", error.text);
}

/* ---- blocks by themselves ---- */

/* Only thinness is a reason to refuse. */
static void check_not_made(const tl_poly *p, const tl_cut *cut)
{
    CHECK(!cut->below && !cut->above);
    CHECK(cut->result != TL_CUT_REFUSED || cut->thickness < cut->limit);
    CHECK((cut->result == TL_CUT_COINCIDENT) <= (cut->face < p->face_count));
}

/* Cuts one block and checks the children's shapes. true when made. */
static int cut_and_check(const tl_poly *p, tl_plane plane, double accuracy, tl_cut *cut, tally *t)
{
    tl_error error = {0};
    CHECK_INT(tl_poly_cut(p, plane, 0, (tl_tag){3, 7}, cut, &error), TL_OK);
    count_result(t, cut->result);
    if (cut->result != TL_CUT_MADE) {
        check_not_made(p, cut);
        return 0;
    }
    const tl_poly *child[2] = {cut->below, cut->above};
    for (int i = 0; i < 2; i++) {
        check_shape(child[i], accuracy);
        tl_tag tag = child[i]->tag[child[i]->face_count - 1];
        CHECK(tag.joint == 3 && tag.plane == 7);
        CHECK(finds_cap_again(child[i], plane));
    }
    CHECK(caps_match(child[0], child[1]));
    CHECK(vertices_kept(p, child[0], child[1]));
    return 1;
}

/* Puts a block about the zero of its frame, as a model does with a new one. */
static tl_poly *centred(tl_poly *p)
{
    tl_poly *copy = NULL;
    tl_error error;
    tl_vec3 shift = tl_v3_neg(tl_poly_mass(p).centroid);
    if (!CHECK_INT(tl_poly_transformed(p, NULL, shift, &copy, &error), TL_OK))
        exit(1);
    tl_poly_free(p);
    return copy;
}

/* Cuts random blocks of a box until `cuts` are done; those near zero are centred each time and keep
 * their volume. */
static void cut_boxes(tl_vec3 min, bool near, kind last, int cuts, tally *t)
{
    tl_vec3 max = tl_v3_add(min, tl_v3(SIDE, SIDE, SIDE));
    double accuracy = SHAPE_TOLERANCE * fmax(tl_v3_norm(min), tl_v3_norm(max));
    while (t->cuts < cuts) {
        tl_poly *live[LIVE] = {0};
        tl_error error;
        uint32_t count = 0;
        CHECK_INT(tl_poly_box(min, max, &live[count++], &error), TL_OK);
        for (int i = 0; i < ROW && t->cuts < cuts; i++) {
            tl_poly **p = &live[pick(count)];
            tl_plane plane = random_plane(*p, (kind)pick(last + 1u));
            tl_cut cut;
            if (is_spent(*p) || !cut_and_check(*p, plane, accuracy, &cut, t))
                continue;
            if (near) {
                double sum = tl_poly_mass(cut.below).volume + tl_poly_mass(cut.above).volume;
                check_volume(sum, tl_poly_mass(*p).volume, t);
            }
            tl_poly_free(*p);
            *p = near ? centred(cut.below) : cut.below;
            tl_poly *above = near ? centred(cut.above) : cut.above;
            if (count < LIVE)
                live[count++] = above;
            else
                tl_poly_free(above);
        }
        for (uint32_t i = 0; i < count; i++)
            tl_poly_free(live[i]);
    }
}

TEST(blocks_about_zero)
{
    tally t = {0};
    tl_vec3 corner = {-SIDE / 2, -SIDE / 2, -SIDE / 2};
    cut_boxes(corner, true, GRID, 60000, &t);
    report("about zero", &t);
    CHECK(t.made > t.cuts / 2 && t.coincident > 0);
    tally near = {0};
    cut_boxes(corner, true, TOUCHING, 60000, &near);
    report("about zero, nearly degenerate", &near);
    CHECK(near.made > near.cuts / 2 && near.coincident > 0 && near.refused > 0);
}

TEST(topology_in_coordinates_of_a_million)
{
    tally t = {0};
    cut_boxes(tl_v3(1e6, -1e6, 1e6), false, TOUCHING, 60000, &t);
    printf("    topology in raw coordinates of a million: %d cuts, %d made\n", t.cuts, t.made);
    CHECK(t.made > t.cuts / 2 && t.coincident > 0 && t.refused > 0);
}

/* ---- blocks of a model ---- */

static tl_model *model_of_a_box(tl_vec3 min)
{
    tl_model_config config = {.size = sizeof(tl_model_config), .seed = 1, .threads = 1};
    tl_error error;
    tl_model *m;
    tl_stage stage;
    tl_vec3 max = tl_v3_add(min, tl_v3(SIDE, SIDE, SIDE));
    if (!CHECK_INT(tl_model_create(&config, &m, &error), TL_OK) || !CHECK_INT(stage_begin(m, &stage), TL_OK) ||
        !CHECK_INT(tl_stage_add_box(&stage, min, max, 2600, NULL), TL_OK) || !CHECK_INT(tl_joint_intern(m, "J"), 1) ||
        !CHECK_INT(tl_stage_commit(&stage), TL_OK))
        exit(1);
    return m;
}

/* Cuts the block of one row by a plane given in its frame, with the others hidden. */
static void cut_in_model(tl_model *m, uint32_t row, tl_plane plane, double accuracy, tally *t)
{
    const tl_blocks *b = &m->blocks;
    double whole = tl_poly_mass(b->shape[row]).volume;
    tl_vec3 point = tl_model_point(m, b->body[row], tl_v3_scale(plane.offset, plane.normal));
    tl_stage stage;
    CHECK_INT(stage_begin(m, &stage), TL_OK);
    for (size_t i = 0; i < stage.count; i++)
        stage.blocks[i].hidden_by_generator = i != row;
    CHECK_INT(stage_cut(&stage, plane.normal, point, (tl_tag){1, 1}, 1), TL_OK);
    CHECK_INT(tl_stage_commit(&stage), TL_OK);
    const tl_generate_summary *s = &stage.summary;
    count_result(t, s->cuts         ? TL_CUT_MADE
                    : s->refused    ? TL_CUT_REFUSED
                    : s->coincident ? TL_CUT_COINCIDENT
                                    : TL_CUT_MISS);
    CHECK_INT(s->after, s->before + s->cuts);
    if (s->cuts == 0)
        return;
    /* the two sides are the last rows */
    double sum = 0;
    for (size_t side = s->after - 2; side < s->after; side++) {
        check_shape(b->shape[side], accuracy);
        sum += b->volume[side];
    }
    check_volume(sum, whole, t);
}

static void cut_in_models(const char *name, tl_vec3 min, int cuts)
{
    tally t = {0};
    double accuracy = SHAPE_TOLERANCE * sqrt(3) * SIDE, worst = 0;
    while (t.cuts < cuts) {
        tl_model *m = model_of_a_box(min);
        for (int i = 0; i < ROW && m->blocks.table.rows < LIVE && t.cuts < cuts; i++) {
            uint32_t row = pick((uint32_t)m->blocks.table.rows);
            if (is_spent(m->blocks.shape[row]))
                continue;
            tl_plane plane = random_plane(m->blocks.shape[row], (kind)pick(TOUCHING + 1u));
            cut_in_model(m, row, plane, accuracy, &t);
        }
        double sum = 0;
        for (size_t row = 0; row < m->blocks.table.rows; row++)
            sum += m->blocks.volume[row];
        CHECK_REL(sum, SIDE * SIDE * SIDE, VOLUME_TOLERANCE);
        worst = fmax(worst, fabs(sum / (SIDE * SIDE * SIDE) - 1));
        tl_model_destroy(m);
    }
    report(name, &t);
    printf("      all blocks of a model together: volume to %.1e\n", worst);
    CHECK(t.made > t.cuts / 2 && t.coincident > 0 && t.refused > 0);
}

TEST(blocks_of_a_model)
{
    cut_in_models("model at zero", tl_v3(0, 0, 0), 50000);
    cut_in_models("model at a million", tl_v3(1e6, -1e6, 1e6), 50000);
}

TEST_MAIN(RUN(blocks_about_zero), RUN(topology_in_coordinates_of_a_million), RUN(blocks_of_a_model))
