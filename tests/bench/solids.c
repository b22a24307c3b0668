/* solids.c - how long it takes to divide a solid of many triangles that is not convex. Run as
 *
 *     ./bootstrap bench solids
 *
 * With "quick" the largest balls are left out.
 *
 * The solid is a ball of 8 n^2 triangles. Some vertices that are not neighbours are pushed in: each of these pits has
 * six reflex edges. Or a part of the ball is rough, or it has cavities, each of twelve reflex edges. The time is to grow
 * little faster than triangles and reflex edges. It is processor time: other work on the machine counts little. */
#include "check.h"
#include "geometry/convex_parts.h"

#include <talus/vmath.h>
#include <time.h>

typedef struct ball {
    tl_vec3 *vertex;
    uint32_t *loop, *start;
    size_t vertices, faces;
} ball;

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The vertex at integer places |i| + |j| + |k| = n of an octahedron; `at` holds the numbers of those that are made. */
static uint32_t vertex_at(ball *b, uint32_t *at, int n, int i, int j, int k)
{
    const size_t side = 2 * (size_t)n + 1;
    uint32_t *number = &at[((size_t)(i + n) * side + (size_t)(j + n)) * 2 + (k < 0)];
    if (*number == UINT32_MAX) {
        *number = (uint32_t)b->vertices;
        b->vertex[b->vertices++] = tl_v3_unit(tl_v3(i, j, k));
    }
    return *number;
}

static void put_triangle(ball *b, uint32_t p, uint32_t q, uint32_t r, int turned)
{
    uint32_t *c = &b->loop[b->start[b->faces]];
    c[0] = p;
    c[1] = turned ? r : q;
    c[2] = turned ? q : r;
    b->start[b->faces + 1] = b->start[b->faces] + 3;
    b->faces++;
}

/* Makes the ball, with capacity for cavities. */
static void make_ball(ball *b, int n, size_t cavities)
{
    const size_t faces = 8 * ((size_t)n * (size_t)n + cavities), side = 2 * (size_t)n + 1;
    uint32_t *at = malloc(2 * side * side * sizeof *at);
    *b = (ball){malloc(faces * sizeof *b->vertex), malloc(3 * faces * sizeof *b->loop),
                malloc((faces + 1) * sizeof *b->start), 0, 0};
    if (!at || !b->vertex || !b->loop || !b->start)
        exit(1);
    memset(at, 0xff, 2 * side * side * sizeof *at);
    b->start[0] = 0;
    for (int oct = 0; oct < 8; oct++) {
        const int x = oct & 1 ? -1 : 1, y = oct & 2 ? -1 : 1, z = oct & 4 ? -1 : 1, turned = x * y * z < 0;
        for (int i = 0; i < n; i++)
            for (int j = 0; i + j < n; j++)
                for (int up = 0; up < 2 && i + j + up < n; up++) {
                    const int k = n - i - j;
                    put_triangle(b, vertex_at(b, at, n, x * (i + up), y * (j + up), z * (k - 2 * up)),
                                 vertex_at(b, at, n, x * (i + 1), y * j, z * (k - 1)),
                                 vertex_at(b, at, n, x * i, y * (j + 1), z * (k - 1)), turned ^ up);
                }
    }
    free(at);
}

/* Pushes vertices in at random, none next to another; gives their number. */
static size_t push_pits(ball *b, size_t pits, double depth)
{
    enum { MOST = 6 }; /* triangles at a vertex */
    uint8_t *near = calloc(b->vertices, 1), *count = calloc(b->vertices, 1);
    uint32_t *face = malloc(MOST * b->vertices * sizeof *face);
    uint64_t seed = 20261130;
    size_t made = 0;
    if (!near || !count || !face)
        exit(1);
    for (uint32_t c = 0; c < 3 * b->faces; c++) {
        const uint32_t v = b->loop[c];
        face[MOST * v + count[v]++] = c / 3;
    }
    for (size_t tries = 0; made < pits && tries < 100 * pits; tries++) {
        const uint32_t v = (uint32_t)((double)b->vertices * check_random(&seed));
        int taken = 0;
        for (int k = 0; k < 3 * count[v]; k++)
            taken = taken || near[b->loop[3 * face[MOST * v + (uint32_t)k / 3] + (uint32_t)k % 3]];
        if (taken)
            continue;
        for (int k = 0; k < 3 * count[v]; k++)
            near[b->loop[3 * face[MOST * v + (uint32_t)k / 3] + (uint32_t)k % 3]] = 1;
        b->vertex[v] = tl_v3_scale(1 - depth * (0.5 + check_random(&seed)), b->vertex[v]);
        made++;
    }
    free(near);
    free(count);
    free(face);
    return made;
}

/* Makes the ball rough above a height: radii 1 - depth to 1. */
static size_t roughen(ball *b, double height, double depth)
{
    uint64_t seed = 20261130;
    size_t made = 0;
    for (size_t v = 0; v < b->vertices; v++)
        if (b->vertex[v].z > height) {
            b->vertex[v] = tl_v3_scale(1 - depth * check_random(&seed), b->vertex[v]);
            made++;
        }
    return made;
}

/* Puts cavities into the ball: octahedra at places of a lattice, each a little off it. */
static size_t add_cavities(ball *b, size_t count)
{
    static const int corner[8][3] = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2},
                                     {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
    static const int way[6][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    const double step = cbrt(3 / (double)count);
    uint64_t seed = 20261130;
    size_t made = 0;
    for (double z = -0.9; z < 0.9; z += step)
        for (double y = -0.9; y < 0.9; y += step)
            for (double x = -0.9; x < 0.9 && made < count; x += step) {
                const uint32_t base = (uint32_t)b->vertices;
                double off[3];
                for (int k = 0; k < 3; k++)
                    off[k] = 0.2 * step * check_random(&seed);
                const tl_vec3 at = {x + off[0], y + off[1], z + off[2]};
                if (tl_v3_norm(at) > 0.9)
                    continue;
                for (int k = 0; k < 6; k++)
                    b->vertex[b->vertices++] = tl_v3_madd(at, 0.3 * step, tl_v3(way[k][0], way[k][1], way[k][2]));
                for (int f = 0; f < 8; f++)
                    put_triangle(b, base + (uint32_t)corner[f][0], base + (uint32_t)corner[f][1],
                                 base + (uint32_t)corner[f][2], 1);
                made++;
            }
    return made;
}

typedef enum kind { PITS, ROUGH, CAVITIES } kind;

static void time_ball(int n, kind what, size_t count)
{
    ball b;
    make_ball(&b, n, what == CAVITIES ? count : 0);
    const size_t made = what == PITS       ? push_pits(&b, count, 4.0 / n)
                        : what == CAVITIES ? add_cavities(&b, count)
                                           : roughen(&b, 1 - 2 * (double)count / (double)b.vertices, 2.0 / n);
    const tl_solid_surface given = {
        .vertices = b.vertex, .vertex_count = b.vertices, .start = b.start, .loops = b.loop, .face_count = b.faces};
    tl_convex_parts parts;
    tl_error error;
    const double began = seconds();
    if (tl_convex_parts_make(&given, &parts, &error) != TL_OK) {
        printf("%s\n", error.text);
        exit(1);
    }
    printf("%7zu triangles, %6zu of them, %6zu reflex edges: %7zu parts in %7.2f s\n", b.faces, made,
           parts.reflex_edges, parts.count, seconds() - began);
    fflush(stdout);
    tl_convex_parts_free(&parts);
    free(b.vertex);
    free(b.loop);
    free(b.start);
}

int main(int count, char **given)
{
    const int largest = count > 1 && strcmp(given[1], "quick") == 0 ? 56 : 112;
    static const char *name[] = {"pits", "rough", "cavities"};
    static const size_t most[][2] = {{PITS, 167}, {PITS, 4000}, {ROUGH, 16000}, {CAVITIES, 2000}};
    for (size_t k = 0; k < sizeof most / sizeof *most; k++) {
        printf("%s\n", name[most[k][0]]);
        for (int n = 28; n <= largest; n *= 2)
            time_ball(n, (kind)most[k][0], most[k][1] * (size_t)(n * n) / (112 * 112));
    }
    return 0;
}
