/* parts_properties.c - solids that are not convex become convex parts: these fill them, do not overlap, and lie face on
 * face; how many there are does not depend on the order of faces, the attitude or the unit. */
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/seam.h"
#include "solid_shapes.h"

static tl_error error;
static shape s;

static double volume_of(const shape *of, double *area)
{
    double six = 0;
    *area = 0;
    for (size_t f = 0; f < of->faces; f++) {
        const tl_vec3 a = of->vertex[of->loop[of->start[f]]];
        tl_vec3 twice = {0, 0, 0};
        for (uint32_t c = of->start[f] + 1; c + 1 < of->start[f + 1]; c++)
            twice = tl_v3_add(
                twice, tl_v3_cross(tl_v3_sub(of->vertex[of->loop[c]], a), tl_v3_sub(of->vertex[of->loop[c + 1]], a)));
        six += tl_v3_dot(tl_v3_sub(a, of->vertex[0]), twice);
        *area += 0.5 * tl_v3_norm(twice);
    }
    return six / 6;
}

/* Whether a point is inside, by the solid angle of all triangles. */
static int is_inside(const shape *of, tl_vec3 at)
{
    double sum = 0;
    for (size_t f = 0; f < of->faces; f++)
        for (uint32_t c = of->start[f] + 1; c + 1 < of->start[f + 1]; c++) {
            const tl_vec3 x = tl_v3_sub(of->vertex[of->loop[of->start[f]]], at);
            const tl_vec3 y = tl_v3_sub(of->vertex[of->loop[c]], at), z = tl_v3_sub(of->vertex[of->loop[c + 1]], at);
            const double lx = tl_v3_norm(x), ly = tl_v3_norm(y), lz = tl_v3_norm(z);
            sum += atan2(tl_v3_dot(x, tl_v3_cross(y, z)),
                         lx * ly * lz + tl_v3_dot(x, y) * lz + tl_v3_dot(y, z) * lx + tl_v3_dot(z, x) * ly);
        }
    return sum > TL_PI;
}

/* Each point of the solid lies in one part, and others in none. */
static void check_points(const tl_convex_parts *p, int points)
{
    const tl_bounds b = tl_points_bounds(s.vertex, s.vertices);
    const double off = 1e-7 * tl_v3_norm(tl_v3_sub(b.max, b.min));
    for (int i = 0; i < points; i++) {
        const tl_vec3 at = {between(b.min.x, b.max.x), between(b.min.y, b.max.y), between(b.min.z, b.max.z)};
        int in = 0, near = 0;
        for (size_t k = 0; k < p->count; k++) {
            in += tl_poly_contains(p->part[k], at, -off);
            near += tl_poly_contains(p->part[k], at, off);
        }
        if (in == near)
            CHECK_INT(in, is_inside(&s, at));
    }
}

/* What of the faces is not covered by those of other parts is the surface. */
static void check_faces(const tl_convex_parts *p, double surface, double size)
{
    double bare = 0;
    for (size_t i = 0; i < p->count; i++)
        for (uint32_t f = 0; f < p->part[i]->face_count; f++) {
            const double area = tl_poly_face_area(p->part[i], f);
            double covered = 0;
            for (size_t k = 0; k < p->count; k++)
                for (uint32_t g = 0; k != i && g < p->part[k]->face_count; g++) {
                    const tl_plane a = p->part[i]->plane[f], b = p->part[k]->plane[g];
                    double common;
                    if (tl_v3_norm(tl_v3_add(a.normal, b.normal)) > 1e-6 || fabs(a.offset + b.offset) > 1e-6 * size)
                        continue;
                    CHECK(tl_poly_shared_area(p->part[i], f, p->part[k], g, &common));
                    covered += common;
                }
            CHECK(covered <= area * (1 + 1e-7) + 1e-10 * size * size);
            bare += area - covered;
        }
    CHECK_NEAR(bare, surface, 1e-7 * surface);
}

/* Divides the solid at hand and checks the parts; gives their number. `off`: m that its faces are off being flat. */
static size_t divide_bent(const char *name, int points, double off)
{
    tl_convex_parts p;
    const tl_solid_surface given = surface_of(&s);
    if (!CHECK_INT(tl_convex_parts_make(&given, &p, &error), TL_OK)) {
        printf("%s: %s\n", name, error.text);
        return 0;
    }
    double area, sum = 0;
    const double volume = volume_of(&s, &area);
    const tl_bounds b = tl_points_bounds(s.vertex, s.vertices);
    for (size_t i = 0; i < p.count; i++) {
        sum += tl_poly_mass(p.part[i]).volume;
        /* what is flat to the solid may be much to a small part */
        const double slack = 1e-7 + (off > 0 ? 10 * fmax(off, 1e-8) / p.part[i]->size : 0);
        if (!CHECK_INT(tl_poly_check(p.part[i], slack, &error), TL_OK))
            printf("%s: %s\n", name, error.text);
        CHECK(off > 0 || tl_poly_thickness(p.part[i]) > 1e-4 * p.part[i]->size);
    }
    if (!CHECK_NEAR(sum, volume, 1e-9 * volume + off * area))
        printf("%s\n", name);
    if (off <= 0)
        check_faces(&p, area, tl_v3_norm(tl_v3_sub(b.max, b.min)));
    check_points(&p, points);
    const size_t count = p.count;
    if (!CHECK(count <= 2 * p.reflex_edges + 1))
        printf("%s: %zu parts, %zu reflex edges\n", name, count, p.reflex_edges);
    tl_convex_parts_free(&p);
    return count;
}

static size_t divide(const char *name, int points)
{
    return divide_bent(name, points, 0);
}

/* Divides the solid as it is, and moved, turned, in another unit and order. */
static size_t divide_twice(const char *name, int points)
{
    const size_t count = divide(name, points);
    static const double unit[4] = {1, 1e-3, 25.4, 1e4};
    const double size = unit[below(4)];
    move(&s, size, tl_v3_scale(size, tl_v3(between(-5, 5), between(-5, 5), between(-5, 5))));
    if (below(2))
        triangulate(&s);
    shuffle(&s);
    CHECK_INT(divide(name, points / 2), count);
    return count;
}

TEST(known_counts)
{
    static const struct {
        const char *name, *rows;
        size_t least, most;
    } known[] = {{"L", "## #", 2, 2},
                 {"U", "### #.#", 3, 3},
                 {"T", "### .#.", 2, 3},
                 {"cross", ".#. ### .#.", 3, 3},
                 {"corner", "## #./#. ..", 3, 3},
                 {"pocket", "### ### ###/### #.# ###", 5, 5},
                 {"frame", "### #.# ###", 4, 4},
                 {"cavity", "### ### ###/### #.# ###/### ### ###", 6, 6},
                 {"comb", "##### #.#.#", 4, 4},
                 {"three dimensional cross", "... .#. .../.#. ### .#./... .#. ...", 5, 5}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        cells_of(&s, known[i].rows);
        const size_t count = divide_twice(known[i].name, 50);
        if (!CHECK(count >= known[i].least && count <= known[i].most))
            printf("%s: %zu parts\n", known[i].name, count);
    }
    double radii[64];
    for (int i = 0; i < 24; i++)
        radii[i] = i < 12 ? 2 : 1;
    extruded(&s, 12, radii, 1, 1, 1);
    CHECK_INT(divide_twice("ring", 50), 12);
    pipe(&s, 8, 2, 0.25, 0.2);
    CHECK_INT(divide_twice("elbow", 50), 2);
    pipe(&s, 8, 10, 1, 0.2);
    CHECK_INT(divide_twice("torus", 50), 10);
}

TEST(unions_of_cells)
{
    size_t parts = 0, filled = 0;
    for (int i = 0; i < check_cases(600); i++) {
        const int n = 2 + (int)below(3), full = cell_solid(&s, n, (int)below(2));
        char name[64];
        snprintf(name, sizeof name, "cells %d", i);
        const size_t count = divide_twice(name, 20);
        CHECK(count <= (size_t)full);
        parts += count;
        filled += (size_t)full;
    }
    printf("%zu cells are %zu parts\n", filled, parts);
}

TEST(sections)
{
    for (int i = 0; i < check_cases(300); i++) {
        double radii[64];
        const uint32_t n = 5 + below(20);
        const int hole = (int)below(2);
        for (uint32_t k = 0; k < 2 * n; k++)
            radii[k] = k < n ? between(1, 2.5) : between(0.3, 0.8);
        extruded(&s, n, radii, hole, between(0.1, 3), below(2) ? 1 : between(0.5, 1));
        if (hole)
            triangulate(&s);
        char name[64];
        snprintf(name, sizeof name, "section %d", i);
        divide_twice(name, 20);
    }
}

TEST(stars)
{
    for (int i = 0; i < check_cases(200); i++) {
        star_solid(&s, (int)below(3), between(0.05, 0.5));
        char name[64];
        snprintf(name, sizeof name, "star %d", i);
        divide(name, 20);
        shuffle(&s);
        divide(name, 5);
    }
}

TEST(pipes)
{
    for (int i = 0; i < check_cases(100); i++) {
        const uint32_t segments = 3 + below(10);
        pipe(&s, 3 + below(12), segments, below(2) ? 1 : between(0.1, 0.8), between(0.05, 0.5));
        char name[64];
        snprintf(name, sizeof name, "pipe %d", i);
        CHECK(divide_twice(name, 20) <= 2 * segments);
    }
}

/* Puts a star turned inside out into the solid at hand. */
static void add_cavity(double size, tl_vec3 at)
{
    static shape solid, cavity;
    solid = s;
    star_solid(&s, (int)below(2), between(0.05, 0.4));
    cavity = s;
    s = solid;
    const uint32_t base = (uint32_t)s.vertices;
    for (size_t v = 0; v < cavity.vertices; v++)
        put_vertex(&s, tl_v3_madd(at, size, cavity.vertex[v]));
    for (size_t f = 0; f < cavity.faces; f++) {
        const uint32_t *c = cavity.loop + cavity.start[f];
        put_face(&s, (const uint32_t[3]){base + c[0], base + c[2], base + c[1]}, 3);
    }
}

/* Stars with up to three rough cavities, in any unit, up to 10^4 sizes away. */
TEST(cavities)
{
    for (int i = 0; i < check_cases(100); i++) {
        star_solid(&s, 1 + (int)below(2), between(0.05, 0.3));
        const int count = 1 + (int)below(3);
        for (int k = 0; k < count; k++)
            add_cavity(between(0.05, 0.17), tl_v3(k == 0 ? -0.18 : 0.18, k == 2 ? 0.18 : -0.18, between(-0.1, 0.1)));
        const double unit[] = {1, 1e-4, 1e4}, size = unit[below(3)];
        move(&s, size, tl_v3_scale(size * (below(2) ? 1 : 1e4), tl_v3(between(-1, 1), between(-1, 1), between(-1, 1))));
        char name[64];
        snprintf(name, sizeof name, "cavities %d", i);
        divide_bent(name, 20, 1e-11 * size);
    }
}

/* Unions of cells, as triangles with corners off by 10^-11 to 10^-4 of a cell: faces bend inward by next to nothing. */
TEST(bent_faces)
{
    for (int i = 0; i < check_cases(400); i++) {
        cell_solid(&s, 2 + (int)below(3), (int)below(2));
        triangulate(&s);
        const double off = pow(10, between(-11, -4));
        for (size_t v = 0; v < s.vertices; v++)
            s.vertex[v] =
                tl_v3_add(s.vertex[v], tl_v3_scale(off, tl_v3(between(-1, 1), between(-1, 1), between(-1, 1))));
        char name[64];
        snprintf(name, sizeof name, "bent faces %d, off by %g", i, off);
        divide_bent(name, 20, fmin(off, 1e-6));
    }
}

/* Thin steps: a union of cells of which some are 10^-8 to 10^-4 thick. */
TEST(thin_steps)
{
    for (int i = 0; i < check_cases(200); i++) {
        cells_of(&s, below(2) ? "### ###/##. #.." : "### ###/### #.#/.#. ...");
        const double thin = pow(10, between(-7, -4)), level = (double)(1 + below(2));
        for (size_t v = 0; v < s.vertices; v++)
            s.vertex[v].z = s.vertex[v].z > level ? s.vertex[v].z - 1 + thin : s.vertex[v].z;
        char name[64];
        snprintf(name, sizeof name, "thin steps %d, %g thick", i, thin);
        divide_bent(name, 20, 1e-12);
    }
}

TEST_MAIN(RUN(known_counts), RUN(unions_of_cells), RUN(sections), RUN(stars), RUN(pipes), RUN(cavities),
          RUN(bent_faces), RUN(thin_steps))
