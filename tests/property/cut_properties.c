/* cut_properties.c - 200,000 seeded random cuts: whatever the plane, both children are
 * closed, convex polyhedra that share their new vertices bit for bit and add up to the parent. */
#include "check.h"
#include "geometry/polyhedron.h"

#include <float.h>
#include <talus/vmath.h>

/* Cuts move no volume but rounding's: of the sums, and of the coordinates (coarse far from zero)
 * times the surface. */
#define VOLUME_TOLERANCE 1e-11

enum { LIVE = 96 }; /* blocks kept of one parent */

static uint64_t seed = 20240607;

static double uniform(double low, double high)
{
    return low + (high - low) * check_random(&seed);
}

static uint32_t pick(uint32_t n)
{
    return (uint32_t)(check_random(&seed) * n);
}

static tl_vec3 direction(void)
{
    for (;;) {
        tl_vec3 v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        double n = tl_v3_norm(v);
        if (n > 0.1 && n <= 1)
            return tl_v3_unit(v);
    }
}

static tl_vec3 inner_point(const tl_poly *p)
{
    tl_vec3 sum = {0, 0, 0};
    double total = 0;
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        double w = uniform(0, 1);
        sum = tl_v3_madd(sum, w, tl_v3_sub(p->vertex[v], p->vertex[0]));
        total += w;
    }
    return tl_v3_madd(p->vertex[0], 1 / total, sum);
}

static tl_plane plane_through(tl_vec3 normal, tl_vec3 point)
{
    return (tl_plane){normal, tl_v3_dot(normal, point)};
}

typedef enum kind {
    ANY,      /* through a random inner point */
    VERTEX,   /* through a vertex */
    EDGE,     /* through an edge */
    DIAGONAL, /* through three vertices */
    PARALLEL, /* along a face, at any depth */
    GRID,     /* normal to an axis, at a multiple of 1/64 of the first block's side */
    TILTED,   /* nearly along a face: cuts of this kind leave faces that almost coincide */
    TOUCHING  /* passes a vertex by about the tolerance: the cap is off its plane by that much */
} kind;

static tl_plane random_plane(const tl_poly *p, kind which)
{
    tl_vec3 a = p->vertex[pick(p->vertex_count)], inside = inner_point(p);
    tl_plane face = p->plane[pick(p->face_count)];
    tl_edge edge = p->edge[pick(p->edge_count)];
    switch (which) {
    case VERTEX: return plane_through(direction(), a);
    case EDGE: {
        tl_vec3 along = tl_v3_sub(p->vertex[edge.b], p->vertex[edge.a]);
        tl_vec3 n = tl_v3_cross(along, tl_v3_sub(inside, p->vertex[edge.a]));
        return plane_through(tl_v3_unit(n), p->vertex[edge.a]);
    }
    case DIAGONAL: {
        tl_vec3 b = p->vertex[pick(p->vertex_count)], c = p->vertex[pick(p->vertex_count)];
        tl_vec3 n = tl_v3_unit(tl_v3_cross(tl_v3_sub(b, a), tl_v3_sub(c, a)));
        return tl_v3_norm(n) > 0 ? plane_through(n, a) : plane_through(direction(), a);
    }
    case PARALLEL: return plane_through(pick(2) ? face.normal : tl_v3_neg(face.normal), inside);
    case TILTED: {
        double tilt = pow(10, uniform(-12, -2));
        return plane_through(tl_v3_unit(tl_v3_madd(face.normal, tilt, direction())), inside);
    }
    case GRID: {
        static const tl_vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        tl_vec3 n = axes[pick(3)];
        return (tl_plane){n, 0.125 * floor(8 * tl_v3_dot(n, inside) + 0.5)};
    }
    case TOUCHING: {
        tl_plane plane = plane_through(direction(), a);
        plane.offset += TL_POLY_ON * p->size * uniform(-2, 2);
        return plane;
    }
    case ANY: break;
    }
    return plane_through(direction(), inside);
}

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
    if (tl_poly_cut(child, plane, (tl_tag){1, 1}, &again, &error))
        return 0;
    return again.result == TL_CUT_COINCIDENT && again.face == child->face_count - 1;
}

typedef struct tally {
    int cuts, made, refused, coincident, missed;
    double worst;
} tally;

/* Deviation from planarity and convexity allowed in lengths of the first block. */
static double shape_tolerance;

/* Whether planes may pass vertices by about the tolerance. */
static int warped;

/* Cuts one block and checks what comes of it. true when made. */
static int cut_and_check(const tl_poly *p, tl_plane plane, double tolerance, tl_cut *cut, tally *t)
{
    tl_error error = {0};
    CHECK_INT(tl_poly_cut(p, plane, (tl_tag){3, 7}, cut, &error), TL_OK);
    t->cuts++;
    t->refused += cut->result == TL_CUT_REFUSED;
    t->missed += cut->result == TL_CUT_MISS;
    t->coincident += cut->result == TL_CUT_COINCIDENT;
    if (cut->result != TL_CUT_MADE) {
        CHECK(!cut->below && !cut->above);
        /* Only thinness is a reason to refuse. */
        double low = INFINITY, high = -INFINITY;
        for (uint32_t v = 0; v < p->vertex_count; v++) {
            double d = tl_v3_dot(plane.normal, p->vertex[v]) - plane.offset;
            low = fmin(low, d);
            high = fmax(high, d);
        }
        CHECK(fmin(-low, high) < TL_POLY_THIN * p->size);
        CHECK((cut->result == TL_CUT_COINCIDENT) <= (cut->face < p->face_count));
        return 0;
    }
    t->made++;
    const tl_poly *child[2] = {cut->below, cut->above};
    double sum = 0, volume = tl_poly_mass(p).volume;
    for (int i = 0; i < 2; i++) {
        if (!CHECK_INT(tl_poly_check(child[i], shape_tolerance / child[i]->size, &error), TL_OK))
            printf("    %s\n", error.text);
        sum += tl_poly_mass(child[i]).volume;
        tl_tag tag = child[i]->tag[child[i]->face_count - 1];
        CHECK(tag.joint == 3 && tag.plane == 7);
        CHECK(warped || finds_cap_again(child[i], plane));
    }
    CHECK(caps_match(child[0], child[1]));
    CHECK(vertices_kept(p, child[0], child[1]));
    t->worst = fmax(t->worst, fabs(sum - volume) / volume);
    CHECK_NEAR(sum, volume, tolerance);
    return 1;
}

/* Cuts random blocks of a box of side 8 placed at `offset` until `cuts` are done. Faces may be off
 * their planes by `warp`, which the volume then feels in proportion to the surface. */
static void cut_at_random(tl_vec3 offset, int cuts, kind last, double warp, tally *t)
{
    tl_vec3 corner = tl_v3_add(offset, tl_v3(8, 8, 8));
    double rounding = DBL_EPSILON * tl_v3_norm(corner);
    while (t->cuts < cuts) {
        tl_poly *live[LIVE] = {0};
        tl_error error;
        uint32_t count = 0;
        CHECK_INT(tl_poly_box(offset, corner, &live[count++], &error), TL_OK);
        shape_tolerance = TL_POLY_ON * live[0]->size + 16 * rounding;
        warped = warp > 0;
        for (int i = 0; i < 200 && t->cuts < cuts; i++) {
            uint32_t which = pick(count);
            tl_plane plane = random_plane(live[which], (kind)pick(last + 1u));
            double size = live[which]->size, surface = 6 * size * size;
            double tolerance =
                VOLUME_TOLERANCE * tl_poly_mass(live[which]).volume + (rounding + warp) * surface;
            tl_cut cut;
            if (!cut_and_check(live[which], plane, tolerance, &cut, t))
                continue;
            tl_poly_free(live[which]);
            live[which] = cut.below;
            if (count < LIVE)
                live[count++] = cut.above;
            else
                tl_poly_free(cut.above);
        }
        for (uint32_t i = 0; i < count; i++)
            tl_poly_free(live[i]);
    }
}

static void report(const char *name, const tally *t)
{
    printf("    %s: %d cuts, %d made, %d missed, %d coincident, %d too thin, volume to %.1e\n",
           name, t->cuts, t->made, t->missed, t->coincident, t->refused, t->worst);
}

TEST(random_cuts_near_zero)
{
    tally t = {0};
    cut_at_random(tl_v3(0, 0, 0), 45000, GRID, 0, &t);
    report("near zero", &t);
    CHECK(t.made > t.cuts / 2 && t.coincident > 0);
}

TEST(random_cuts_far_from_zero)
{
    tally t = {0};
    cut_at_random(tl_v3(1e6, -1e6, 1e6), 45000, GRID, 0, &t);
    report("at 1e6", &t);
    CHECK(t.made > t.cuts / 2 && t.coincident > 0);
}

TEST(nearly_degenerate_cuts)
{
    tally t = {0};
    cut_at_random(tl_v3(0, 0, 0), 50000, TOUCHING, TL_POLY_ON, &t);
    cut_at_random(tl_v3(1e6, -1e6, 1e6), 110000, TOUCHING, TL_POLY_ON, &t);
    report("nearly degenerate", &t);
    CHECK(t.made > t.cuts / 2 && t.coincident > 0 && t.refused > 0);
}

TEST_MAIN(RUN(random_cuts_near_zero), RUN(random_cuts_far_from_zero), RUN(nearly_degenerate_cuts))
