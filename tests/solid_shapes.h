/* solid_shapes.h - seeded random solids that are not convex, as faces: of cells, of sections, round ones. */
#ifndef TALUS_TESTS_SOLID_SHAPES_H
#define TALUS_TESTS_SOLID_SHAPES_H

#include "check.h"
#include "geometry/convex_parts.h"

#include <math.h>
#include <string.h>
#include <talus/vmath.h>

enum { MOST_V = 8192, MOST_C = 65536, MOST_F = 16384 };

typedef struct shape {
    tl_vec3 vertex[MOST_V];
    uint32_t loop[MOST_C], start[MOST_F + 1];
    tl_tag tag[MOST_F];
    size_t vertices, faces;
} shape;

static uint64_t shape_seed = 20261130;

static double between(double low, double high)
{
    return low + (high - low) * check_random(&shape_seed);
}

static inline uint32_t below(uint32_t n)
{
    return (uint32_t)(n * check_random(&shape_seed));
}

static inline void clear(shape *s)
{
    s->vertices = s->faces = 0;
    s->start[0] = 0;
}

static uint32_t put_vertex(shape *s, tl_vec3 at)
{
    s->vertex[s->vertices] = at;
    return (uint32_t)s->vertices++;
}

static void put_face(shape *s, const uint32_t *corner, size_t n)
{
    memcpy(s->loop + s->start[s->faces], corner, n * sizeof *corner);
    s->tag[s->faces] = (tl_tag){1, 1};
    s->faces++;
    s->start[s->faces] = s->start[s->faces - 1] + (uint32_t)n;
}

static void put_quad(shape *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    put_face(s, (const uint32_t[4]){a, b, c, d}, 4);
}

static inline tl_solid_surface surface_of(const shape *s)
{
    return (tl_solid_surface){.vertices = s->vertex,
                              .vertex_count = s->vertices,
                              .start = s->start,
                              .loops = s->loop,
                              .face_count = s->faces,
                              .tags = s->tag};
}

/* ---- cells ---- */

enum { SIDE = 6 };

typedef struct cells {
    int full[SIDE + 2][SIDE + 2][SIDE + 2]; /* with empty ones around */
    double line[3][SIDE + 1];
    uint32_t number[SIDE + 1][SIDE + 1][SIDE + 1];
} cells;

/* Whether the cells about each line of the grid meet in faces: no edge has four. */
static int sound_edges(const cells *c)
{
    for (int k = 0; k < 3; k++)
        for (int x = 0; x < SIDE + 2; x++)
            for (int y = 0; y < SIDE + 2; y++)
                for (int z = 0; z < SIDE + 2; z++) {
                    const int d[3] = {x, y, z}, a = (k + 1) % 3, b = (k + 2) % 3;
                    if (d[a] == 0 || d[b] == 0)
                        continue;
                    int at[4];
                    for (int q = 0; q < 4; q++) {
                        int e[3] = {x, y, z};
                        e[a] -= q & 1;
                        e[b] -= q >> 1;
                        at[q] = c->full[e[0]][e[1]][e[2]];
                    }
                    if (at[0] == at[3] && at[1] == at[2] && at[0] != at[1])
                        return 0;
                }
    return 1;
}

static uint32_t corner_number(cells *c, shape *s, int x, int y, int z)
{
    if (c->number[x][y][z] == UINT32_MAX)
        c->number[x][y][z] = put_vertex(s, tl_v3(c->line[0][x], c->line[1][y], c->line[2][z]));
    return c->number[x][y][z];
}

static void put_cell_face(cells *c, shape *s, const int cell[3], int axis, int high)
{
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    uint32_t corner[4];
    for (int q = 0; q < 4; q++) {
        int e[3] = {cell[0] - 1, cell[1] - 1, cell[2] - 1};
        const int r = high ? q : 3 - q;
        e[axis] += high;
        e[a] += r == 1 || r == 2;
        e[b] += r >= 2;
        corner[q] = corner_number(c, s, e[0], e[1], e[2]);
    }
    put_face(s, corner, 4);
}

static void surface_of_cells(cells *c, shape *s)
{
    clear(s);
    memset(c->number, 0xff, sizeof c->number);
    for (int x = 1; x <= SIDE; x++)
        for (int y = 1; y <= SIDE; y++)
            for (int z = 1; z <= SIDE; z++)
                for (int k = 0; c->full[x][y][z] && k < 6; k++) {
                    const int cell[3] = {x, y, z}, step = k % 2 ? 1 : -1;
                    int e[3] = {x, y, z};
                    e[k / 2] += step;
                    if (!c->full[e[0]][e[1]][e[2]])
                        put_cell_face(c, s, cell, k / 2, step > 0);
                }
}

static void draw_lines(cells *c, int even)
{
    for (int k = 0; k < 3; k++)
        for (int i = 0; i <= SIDE; i++)
            c->line[k][i] = i ? c->line[k][i - 1] + (even ? 1 : between(0.3, 1.5)) : 0;
}

/* A union of cells that hang together over faces, in n^3 of them; gives their number. */
static inline int cell_solid(shape *s, int n, int even)
{
    static cells c;
    int count = 0;
    do {
        memset(c.full, 0, sizeof c.full);
        c.full[1][1][1] = 1;
        const int wanted = 2 + (int)below((uint32_t)(n * n * n - 2));
        count = 1;
        for (int tries = 0; count < wanted && tries < 4000; tries++) {
            const int x = 1 + (int)below((uint32_t)n), y = 1 + (int)below((uint32_t)n), z = 1 + (int)below((uint32_t)n);
            if (c.full[x][y][z] || !(c.full[x - 1][y][z] || c.full[x + 1][y][z] || c.full[x][y - 1][z] ||
                                     c.full[x][y + 1][z] || c.full[x][y][z - 1] || c.full[x][y][z + 1]))
                continue;
            c.full[x][y][z] = 1;
            count++;
        }
    } while (!sound_edges(&c));
    draw_lines(&c, even);
    surface_of_cells(&c, s);
    return count;
}

/* Named unions of cells: rows of '#' in layers parted by '/', rows parted by ' '. */
static inline void cells_of(shape *s, const char *rows)
{
    static cells c;
    memset(&c, 0, sizeof c);
    int x = 1, y = 1, z = 1;
    for (; *rows; rows++) {
        if (*rows == ' ') {
            y++;
            x = 1;
        } else if (*rows == '/') {
            z++;
            x = y = 1;
        } else
            c.full[x++][y][z] = *rows == '#';
    }
    draw_lines(&c, 1);
    surface_of_cells(&c, s);
}

/* ---- sections and round solids ---- */

/* A section between two circles of n corners, out at radii[0..n) and in at radii[n..2n) or, where `hole` is 0, without a
 * hole; moved along z and tapered. */
static inline void extruded(shape *s, uint32_t n, const double *radii, int hole, double height, double taper)
{
    clear(s);
    for (uint32_t k = 0; k < (hole ? 4 : 2) * n; k++) {
        const uint32_t i = k % n, level = k / n % 2, inner = k / n / 2;
        const double angle = 2 * TL_PI * i / n, r = radii[inner * n + i] * (level ? taper : 1);
        put_vertex(s, tl_v3(r * cos(angle), r * sin(angle), level * height));
    }
    uint32_t low[64], high[64];
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t j = (i + 1) % n;
        put_quad(s, i, j, n + j, n + i);
        low[i] = n - 1 - i;
        high[i] = n + i;
        if (!hole)
            continue;
        put_quad(s, 2 * n + j, 2 * n + i, 3 * n + i, 3 * n + j);
        put_quad(s, i, 2 * n + i, 2 * n + j, j);
        put_quad(s, n + i, n + j, 3 * n + j, 3 * n + i);
    }
    if (!hole) {
        put_face(s, low, n);
        put_face(s, high, n);
    }
}

/* A ball of 8 4^level triangles with radii drawn for each vertex. */
static inline void star_solid(shape *s, int level, double rough)
{
    clear(s);
    const int n = 1 << level;
    static uint32_t at[33][33][33];
    memset(at, 0xff, sizeof at);
    for (int oct = 0; oct < 8; oct++) {
        const int sx = oct & 1 ? -1 : 1, sy = oct & 2 ? -1 : 1, sz = oct & 4 ? -1 : 1;
        for (int i = 0; i <= n; i++)
            for (int j = 0; i + j <= n; j++) {
                const int k = n - i - j;
                uint32_t *v = &at[16 + sx * i][16 + sy * j][16 + sz * k];
                if (*v == UINT32_MAX)
                    *v = put_vertex(s, tl_v3_scale(between(1 - rough, 1), tl_v3_unit(tl_v3(sx * i, sy * j, sz * k))));
            }
        for (int i = 0; i < n; i++)
            for (int j = 0; i + j < n; j++)
                for (int up = 0; up < 2 && i + j + up < n; up++) {
                    const int k = n - i - j;
                    const int p[3][3] = {{i + up, j + up, k - 2 * up}, {i + 1, j, k - 1}, {i, j + 1, k - 1}};
                    uint32_t c[3];
                    for (int q = 0; q < 3; q++)
                        c[q] = at[16 + sx * p[q][0]][16 + sy * p[q][1]][16 + sz * p[q][2]];
                    if ((sx * sy * sz > 0) == (up == 0))
                        put_face(s, c, 3);
                    else
                        put_face(s, (const uint32_t[3]){c[0], c[2], c[1]}, 3);
                }
    }
}

/* A closed or open pipe of `sides` along a plane arc of `turns` of a circle in `segments`, mitred. */
static inline void pipe(shape *s, uint32_t sides, uint32_t segments, double turns, double radius)
{
    clear(s);
    const int closed = turns >= 1;
    const uint32_t rings = segments + !closed;
    for (uint32_t k = 0; k < rings; k++) {
        const double along = 2 * TL_PI * turns * k / segments;
        for (uint32_t i = 0; i < sides; i++) {
            const double angle = 2 * TL_PI * (i + 0.3) / sides, r = 1 + radius * cos(angle);
            put_vertex(s, tl_v3(r * cos(along), r * sin(along), radius * sin(angle)));
        }
    }
    for (uint32_t k = 0; k < segments; k++)
        for (uint32_t i = 0; i < sides; i++) {
            const uint32_t a = k * sides, b = (k + 1) % rings * sides, j = (i + 1) % sides;
            put_quad(s, a + i, b + i, b + j, a + j);
        }
    uint32_t first[64], last[64];
    for (uint32_t i = 0; i < sides && !closed; i++) {
        first[i] = i;
        last[i] = segments * sides + sides - 1 - i;
    }
    if (!closed) {
        put_face(s, first, sides);
        put_face(s, last, sides);
    }
}

/* ---- changes ---- */

/* Divides all faces of four corners by a diagonal. */
static inline void triangulate(shape *s)
{
    static shape t;
    t = *s;
    s->faces = 0;
    for (size_t f = 0; f < t.faces; f++) {
        const uint32_t *c = t.loop + t.start[f];
        if (t.start[f + 1] - t.start[f] != 4) {
            put_face(s, c, t.start[f + 1] - t.start[f]);
            continue;
        }
        const uint32_t turn = below(2);
        put_face(s, (const uint32_t[3]){c[turn], c[1 + turn], c[2 + turn]}, 3);
        put_face(s, (const uint32_t[3]){c[2 + turn], c[(3 + turn) % 4], c[turn]}, 3);
    }
}

static inline void move(shape *s, double size, tl_vec3 shift)
{
    const tl_quat q = tl_q_unit((tl_quat){between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)});
    const tl_mat3 r = tl_q_matrix(q);
    for (size_t v = 0; v < s->vertices; v++)
        s->vertex[v] = tl_v3_add(shift, tl_v3_scale(size, tl_m3_mul(&r, s->vertex[v])));
}

/* Puts faces and vertices into another order, and begins each face at another corner. */
static inline void shuffle(shape *s)
{
    static shape t;
    static uint32_t order[MOST_F], name[MOST_V];
    t = *s;
    for (uint32_t i = 0; i < s->faces; i++)
        order[i] = i;
    for (uint32_t i = 0; i < s->vertices; i++)
        name[i] = i;
    for (uint32_t i = (uint32_t)s->faces; i > 1; i--) {
        const uint32_t j = below(i), held = order[j];
        order[j] = order[i - 1];
        order[i - 1] = held;
    }
    for (uint32_t i = (uint32_t)s->vertices; i > 1; i--) {
        const uint32_t j = below(i), held = name[j];
        name[j] = name[i - 1];
        name[i - 1] = held;
    }
    for (uint32_t v = 0; v < s->vertices; v++)
        s->vertex[name[v]] = t.vertex[v];
    s->faces = 0;
    for (uint32_t i = 0; i < t.faces; i++) {
        uint32_t c[64];
        const uint32_t f = order[i], n = t.start[f + 1] - t.start[f], turn = below(n);
        for (uint32_t k = 0; k < n; k++)
            c[k] = name[t.loop[t.start[f] + (k + turn) % n]];
        put_face(s, c, n);
    }
}

#endif
