/* flatten_properties.c - faces of seeded blocks, cut into triangles at random, their corners moved off the planes by as much
 * as a mesh misses them: the block has the faces that it had before. */
#include "check.h"
#include "geometry/cut.h"
#include "geometry/flatten.h"
#include "geometry/hull.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/polyhedron.h"

#include <talus/vmath.h>

#define MOST 400

static uint64_t seed = 34;
static tl_error error;

static double uniform(double low, double high)
{
    return low + (high - low) * check_random(&seed);
}

static uint32_t below(uint32_t count)
{
    return (uint32_t)(check_random(&seed) * count);
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

/* A surface as meshes give it. */
typedef struct surface {
    tl_vec3 vertex[MOST];
    tl_plane plane[MOST];
    uint32_t start[MOST + 1];
    uint16_t loop[3 * MOST];
    uint32_t vertices, faces;
} surface;

/* Whether faces and corners are clear: at every edge the surface turns by 10 degrees or more, and none is short. */
static bool is_clear(const tl_poly *p)
{
    for (uint32_t e = 0; e < p->edge_count; e++)
        if (tl_v3_dot(p->plane[p->edge[e].left].normal, p->plane[p->edge[e].right].normal) > cos(10 * TL_PI / 180))
            return false;
    return tl_poly_shortest_edge(p) > 0.03 * p->size && tl_poly_thickness(p) > 0.1 * p->size;
}

/* A box of size about 1, cut by up to seven planes. */
static tl_poly *random_block(void)
{
    for (;;) {
        tl_poly *p = NULL;
        tl_vec3 side = {uniform(0.2, 1), uniform(0.2, 1), uniform(0.2, 1)};
        CHECK_INT(tl_poly_box(tl_v3_scale(-0.5, side), tl_v3_scale(0.5, side), &p, &error), TL_OK);
        for (uint32_t cuts = below(8); cuts > 0; cuts--) {
            tl_cut cut;
            tl_plane plane = {direction(), uniform(0.1, 0.4)};
            CHECK_INT(tl_poly_cut(p, plane, 0, (tl_tag){0, 0}, &cut, &error), TL_OK);
            if (cut.result != TL_CUT_MADE)
                continue;
            tl_poly_free(p);
            tl_poly_free(cut.above);
            p = cut.below;
        }
        if (is_clear(p))
            return p;
        tl_poly_free(p);
    }
}

/* How far corner k of a polygon lies from the line of its neighbours. */
static double ear_height(const surface *s, const uint16_t *loop, uint32_t n, uint32_t k)
{
    tl_vec3 a = s->vertex[loop[(k + n - 1) % n]], b = s->vertex[loop[k]], c = s->vertex[loop[(k + 1) % n]];
    return tl_v3_norm(tl_v3_cross(tl_v3_sub(b, a), tl_v3_sub(c, a))) / tl_v3_norm(tl_v3_sub(c, a));
}

static void add_triangle(surface *s, uint16_t a, uint16_t b, uint16_t c)
{
    uint16_t *to = s->loop + 3 * s->faces;
    uint32_t turn = below(3);
    to[turn] = a, to[(turn + 1) % 3] = b, to[(turn + 2) % 3] = c;
    s->faces++;
    s->start[s->faces] = 3 * s->faces;
}

/* Cuts off corners at random, none of them flat, until a triangle is left. */
static void add_ears(surface *s, uint16_t *loop, uint32_t n)
{
    while (n > 3) {
        /* the triangle cut off is none with a corner on an edge, nor is the one left at last */
        uint32_t k;
        do
            k = below(n);
        while (ear_height(s, loop, n, k) < 1e-6 || (n == 4 && ear_height(s, loop, n, (k + 2) % 4) < 1e-6));
        add_triangle(s, loop[(k + n - 1) % n], loop[k], loop[(k + 1) % n]);
        memmove(loop + k, loop + k + 1, (n - k - 1) * sizeof *loop);
        n--;
    }
    add_triangle(s, loop[0], loop[1], loop[2]);
}

/* Triangles from a point inside the face. */
static void add_fan(surface *s, const uint16_t *loop, uint32_t n)
{
    tl_vec3 middle = {0, 0, 0};
    double all = 0;
    for (uint32_t k = 0; k < n; k++) {
        double share = uniform(0.2, 1);
        all += share;
        middle = tl_v3_madd(middle, share, s->vertex[loop[k]]);
    }
    s->vertex[s->vertices++] = tl_v3_scale(1 / all, middle);
    for (uint32_t k = 0; k < n; k++)
        add_triangle(s, (uint16_t)(s->vertices - 1), loop[k], loop[(k + 1) % n]);
}

/* The faces of p as triangles, where `inner` with points on some edges and faces. */
static void triangulate(const tl_poly *p, bool inner, surface *s)
{
    uint16_t middle[MOST], loop[MOST];
    s->vertices = p->vertex_count;
    s->faces = 0;
    s->start[0] = 0;
    memcpy(s->vertex, p->vertex, p->vertex_count * sizeof *p->vertex);
    for (uint32_t e = 0; e < p->edge_count; e++) {
        middle[e] = UINT16_MAX;
        if (inner && check_random(&seed) < 0.3) {
            tl_vec3 a = p->vertex[p->edge[e].a], b = p->vertex[p->edge[e].b];
            middle[e] = (uint16_t)s->vertices;
            s->vertex[s->vertices++] = tl_v3_madd(a, uniform(0.2, 0.8), tl_v3_sub(b, a));
        }
    }
    for (uint32_t f = 0; f < p->face_count; f++) {
        uint32_t n = 0;
        for (uint32_t h = p->start[f]; h < p->start[f + 1]; h++) {
            uint16_t a = p->loop[h], b = p->loop[tl_poly_after(p, f, h)];
            loop[n++] = a;
            for (uint32_t e = 0; e < p->edge_count; e++)
                if (middle[e] != UINT16_MAX &&
                    ((p->edge[e].a == a && p->edge[e].b == b) || (p->edge[e].a == b && p->edge[e].b == a)))
                    loop[n++] = middle[e];
        }
        if (inner && check_random(&seed) < 0.3)
            add_fan(s, loop, n);
        else
            add_ears(s, loop, n);
    }
}

/* Moves every vertex by up to `most`. */
static void disturb(surface *s, double most)
{
    for (uint32_t v = 0; v < s->vertices; v++)
        s->vertex[v] = tl_v3_madd(s->vertex[v], most * uniform(0, 1), direction());
}

/* Another order of vertices and facets, and another place, attitude and scale. */
static void rearrange(const surface *from, const tl_mat3 *r, double scale, tl_vec3 at, surface *to)
{
    uint16_t name[MOST], row[MOST];
    for (uint32_t v = 0; v < from->vertices; v++)
        name[v] = (uint16_t)v;
    for (uint32_t f = 0; f < from->faces; f++)
        row[f] = (uint16_t)f;
    for (uint32_t v = from->vertices - 1; v > 0; v--) {
        uint32_t w = below(v + 1);
        uint16_t swap = name[v];
        name[v] = name[w], name[w] = swap;
    }
    for (uint32_t f = from->faces - 1; f > 0; f--) {
        uint32_t g = below(f + 1);
        uint16_t swap = row[f];
        row[f] = row[g], row[g] = swap;
    }
    *to = (surface){.vertices = from->vertices, .faces = from->faces};
    for (uint32_t v = 0; v < from->vertices; v++)
        to->vertex[name[v]] = tl_v3_madd(at, scale, tl_m3_mul(r, from->vertex[v]));
    for (uint32_t f = 0; f < from->faces; f++) {
        uint32_t turn = below(3);
        for (uint32_t k = 0; k < 3; k++)
            to->loop[3 * f + (k + turn) % 3] = name[from->loop[3 * row[f] + k]];
        to->start[f + 1] = 3 * f + 3;
    }
}

/* The block of a surface. */
static tl_poly *block_of(surface *s)
{
    tl_poly *p = NULL;
    for (uint32_t f = 0; f < s->faces; f++) {
        tl_vec3 a = s->vertex[s->loop[3 * f]], b = s->vertex[s->loop[3 * f + 1]], c = s->vertex[s->loop[3 * f + 2]];
        tl_vec3 n = tl_v3_unit(tl_v3_cross(tl_v3_sub(b, a), tl_v3_sub(c, a)));
        s->plane[f] = (tl_plane){n, tl_v3_dot(n, a)};
    }
    CHECK_INT(tl_poly_make(s->vertex, s->vertices, s->plane, NULL, s->start, s->loop, s->faces, &p, &error), TL_OK);
    CHECK_INT(tl_poly_flatten(&p, &error), TL_OK);
    return p;
}

static double surface_area(const tl_poly *p)
{
    double area = 0;
    for (uint32_t f = 0; f < p->face_count; f++)
        area += tl_poly_face_area(p, f);
    return area;
}

/* Checks that `p` is the block `wanted` scaled, its corners moved by up to `moved` before that. */
static void expect_block(const tl_poly *p, const tl_poly *wanted, double scale, double moved)
{
    double cube = scale * scale * scale;
    CHECK_INT(p->face_count, wanted->face_count);
    CHECK_INT(p->vertex_count, wanted->vertex_count);
    CHECK_INT(p->edge_count, wanted->edge_count);
    CHECK_NEAR(tl_poly_mass(p).volume, cube * tl_poly_mass(wanted).volume,
               cube * surface_area(wanted) * (2 * moved + 1e-11));
    CHECK_INT(tl_poly_check(p, TL_POLY_BENT, &error), TL_OK);
}

/* Checks that both sides of a random cut are blocks that hold what was cut. */
static void expect_cuts(const tl_poly *p, double moved)
{
    tl_cut cut;
    tl_vec3 n = direction();
    tl_mass mass = tl_poly_mass(p);
    tl_plane plane = {n, tl_v3_dot(n, mass.centroid) + 0.1 * p->size * uniform(-1, 1)};
    CHECK_INT(tl_poly_cut(p, plane, 0, (tl_tag){1, 1}, &cut, &error), TL_OK);
    if (cut.result != TL_CUT_MADE)
        return;
    CHECK_INT(tl_poly_check(cut.below, 10 * TL_POLY_BENT, &error), TL_OK);
    CHECK_INT(tl_poly_check(cut.above, 10 * TL_POLY_BENT, &error), TL_OK);
    CHECK_NEAR(tl_poly_mass(cut.below).volume + tl_poly_mass(cut.above).volume, mass.volume,
               surface_area(p) * (moved + 1e-14 * p->size));
    tl_poly_free(cut.below);
    tl_poly_free(cut.above);
}

/* The least of the longest diagonals of the faces. */
static double smallest_face(const tl_poly *p)
{
    double least = INFINITY;
    for (uint32_t f = 0; f < p->face_count; f++) {
        double size = 0;
        for (uint32_t i = p->start[f]; i < p->start[f + 1]; i++)
            for (uint32_t j = i + 1; j < p->start[f + 1]; j++)
                size = fmax(size, tl_v3_norm(tl_v3_sub(p->vertex[p->loop[i]], p->vertex[p->loop[j]])));
        least = fmin(least, size);
    }
    return least;
}

/* Faces in triangles, with points on edges and faces or without, exact or off their planes by up to 1e-4 of the smallest
 * face; in any order, place and attitude, given by faces or by their corners. */
TEST(triangles_of_faces)
{
    static surface s, t;
    for (int i = 0; i < 3000; i++) {
        tl_poly *wanted = random_block(), *p, *other, *hull = NULL;
        double moved = i % 5 ? smallest_face(wanted) * pow(10, uniform(-8, -4)) : 0;
        triangulate(wanted, i % 2, &s);
        disturb(&s, moved);
        p = block_of(&s);
        expect_block(p, wanted, 1, moved);
        expect_cuts(p, moved);
        tl_quat q = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(0.1, 1)};
        tl_mat3 r = tl_q_matrix(tl_q_unit(q));
        double scale = pow(10, uniform(-2, 2)), away = pow(10, uniform(-1, 4));
        rearrange(&s, &r, scale, tl_v3_scale(scale * away, direction()), &t);
        other = block_of(&t);
        expect_block(other, wanted, scale, moved);
        CHECK_NEAR(tl_poly_mass(other).volume / (scale * scale * scale), tl_poly_mass(p).volume,
                   surface_area(p) * (0.2 * moved + 1e-14 * (1 + away)));
        if (CHECK_INT(tl_poly_hull(t.vertex, t.vertices, TL_HULL_OF_CORNERS, &hull, &error), TL_OK))
            expect_block(hull, wanted, scale, moved);
        tl_poly_free(hull);
        tl_poly_free(p);
        tl_poly_free(other);
        tl_poly_free(wanted);
    }
}

/* A prism over points of a circle stays as round as it is. */
TEST(drums)
{
    static tl_vec3 x[1000];
    for (int i = 0; i < 300; i++) {
        uint32_t n = 3 + (uint32_t)pow(10, uniform(0, 2.69));
        double height = pow(10, uniform(-1, 0.5)), angle = 0, sum = 0, step[500];
        for (uint32_t k = 0; k < n; k++)
            sum += step[k] = uniform(0.5, 1);
        for (uint32_t k = 0; k < n; k++, angle += 2 * TL_PI * step[k] / sum) {
            x[2 * k] = tl_v3(cos(angle), sin(angle), 0);
            x[2 * k + 1] = tl_v3(cos(angle), sin(angle), height);
        }
        tl_poly *p = NULL;
        CHECK_INT(tl_poly_hull(x, 2 * n, TL_HULL_OF_CORNERS, &p, &error), TL_OK);
        CHECK_INT(p->face_count, n + 2);
        tl_poly_free(p);
    }
}

/* A box with a rounded edge of narrow faces: those that hardly miss a side join it, and the sides stay where they are. */
TEST(rounded_edges)
{
    for (int i = 0; i < 300; i++) {
        tl_vec3 x[200];
        uint32_t n = 0, steps = 2 + below(60);
        double radius = pow(10, uniform(-2, -0.5));
        for (int side = 0; side < 2; side++) {
            x[n++] = tl_v3(0, side, 0);
            x[n++] = tl_v3(1, side, 0);
            x[n++] = tl_v3(0, side, 1);
            for (uint32_t k = 0; k <= steps; k++) {
                double angle = 0.5 * TL_PI * k / steps;
                x[n++] = tl_v3(1 - radius * (1 - cos(angle)), side, 1 - radius * (1 - sin(angle)));
            }
        }
        tl_poly *p = NULL, *box = NULL;
        CHECK_INT(tl_poly_hull(x, n, TL_HULL_OF_CORNERS, &p, &error), TL_OK);
        CHECK_INT(tl_poly_box(tl_v3(0, 0, 0), tl_v3(1, 1, 1), &box, &error), TL_OK);
        for (uint32_t f = 0; f < 6; f++) {
            int found = 0;
            for (uint32_t g = 0; g < p->face_count; g++)
                found += tl_v3_norm2(tl_v3_sub(p->plane[g].normal, box->plane[f].normal)) == 0 &&
                         p->plane[g].offset == box->plane[f].offset;
            CHECK_INT(found, 1);
        }
        double round = radius * radius * (1 - 0.25 * TL_PI), flat = radius * (0.5 * TL_PI / steps);
        CHECK_NEAR(tl_poly_mass(p).volume, 1 - round, radius * flat * flat + 2 * TL_POLY_BENT);
        tl_poly_free(p);
        tl_poly_free(box);
    }
}

TEST_MAIN(RUN(triangles_of_faces), RUN(drums), RUN(rounded_edges))
