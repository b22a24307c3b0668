/* zoning_properties.c - zones of seeded random blocks: they fill them, match across joints, and do not depend on where a
 * block is or how large. */
#include "cut_planes.h"
#include "geometry/cut.h"
#include "geometry/hull.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "geometry/zoning.h"

static tl_error error;
static tl_zone_scratch *scratch;

/* ---- blocks ---- */

static tl_poly *random_box(void)
{
    tl_poly *box = NULL;
    const double thin = pick(4) ? 0.2 : 0.02;
    const tl_vec3 low = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const tl_vec3 side = {uniform(thin, 2), uniform(thin, 2), uniform(thin, 2)};
    tl_poly_box(low, tl_v3_add(low, side), &box, &error);
    return box;
}

/* A box of whole sides: as many points lie on one circle or sphere as can be. */
static tl_poly *whole_box(void)
{
    tl_poly *box = NULL;
    const tl_vec3 side = {1 + pick(4), 1 + pick(4), 1 + pick(4)};
    tl_poly_box(tl_v3(0, 0, 0), side, &box, &error);
    return box;
}

/* A prism or pyramid, turned. */
static tl_poly *prism(void)
{
    tl_vec3 x[24];
    const uint32_t n = 3 + pick(9);
    const double top = pick(3) ? 1 : uniform(0.05, 0.9), height = uniform(0.1, 2);
    tl_quat q = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(0.1, 1)};
    const tl_mat3 turn = tl_q_matrix(tl_q_unit(q));
    for (uint32_t i = 0; i < n; i++) {
        const double angle = 2 * TL_PI * i / n;
        x[i] = tl_m3_mul(&turn, tl_v3(cos(angle), sin(angle), 0));
        x[n + i] = tl_m3_mul(&turn, tl_v3(top * cos(angle), top * sin(angle), height));
    }
    tl_poly *p = NULL;
    return tl_poly_hull(x, 2 * n, TL_HULL_OF_CORNERS, &p, &error) ? random_box() : p;
}

/* Cuts a block by random planes, some along faces or past corners, which leave short edges and slivers. */
static tl_poly *random_block(void)
{
    tl_poly *p = pick(5) == 0 ? whole_box() : pick(4) == 0 ? prism() : random_box();
    for (uint32_t cuts = pick(6); cuts > 0; cuts--) {
        static const kind kinds[] = {ANY, ANY, ANY, VERTEX, EDGE, DIAGONAL, PARALLEL, GRID};
        tl_plane plane = random_plane(p, kinds[pick(8)]);
        if (pick(4) == 0) /* just past a corner */
            plane.offset = tl_v3_dot(plane.normal, p->vertex[pick(p->vertex_count)]) + p->size * uniform(-0.01, 0.01);
        tl_cut cut;
        if (tl_poly_cut(p, plane, 0, (tl_tag){0, 0}, &cut, &error) || cut.result != TL_CUT_MADE)
            continue;
        const bool keeps_below = pick(2);
        tl_poly_free(p);
        tl_poly_free(keeps_below ? cut.above : cut.below);
        p = keeps_below ? cut.below : cut.above;
    }
    return p;
}

/* A wanted edge for some dozens to some thousands of zones. */
static double random_edge(const tl_poly *p)
{
    const tl_mass mass = tl_poly_mass(p);
    const double zones = 10 * pow(10, uniform(0, 2.3));
    double edge = pow(8.5 * mass.volume / zones, 1.0 / 3), area = 0;
    for (uint32_t f = 0; f < p->face_count; f++)
        area += tl_poly_face_area(p, f);
    return fmax(edge, sqrt(area / zones));
}

/* ---- what holds of every mesh ---- */

static tl_vec3 triangle_area(const tl_zone_mesh *m, const uint32_t v[3])
{
    const tl_vec3 *x = m->point;
    return tl_v3_scale(0.5, tl_v3_cross(tl_v3_sub(x[v[1]], x[v[0]]), tl_v3_sub(x[v[2]], x[v[0]])));
}

/* Every face has triangles that look out of it and add up to its area. */
static void check_faces(const tl_poly *p, const tl_zone_mesh *m)
{
    double area[256] = {0};
    int turned = 0;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const tl_zone_triangle *t = &m->triangle[i];
        const tl_vec3 a = triangle_area(m, t->corner);
        turned += tl_v3_dot(a, p->plane[t->face].normal) <= 0;
        CHECK(i == 0 || m->triangle[i - 1].face <= t->face);
        area[t->face] += tl_v3_norm(a);
    }
    CHECK_INT(turned, 0);
    for (uint32_t f = 0; f < p->face_count; f++)
        CHECK_NEAR(area[f], tl_poly_face_area(p, f), 1e-9 * p->size * p->size);
}

static int has_corner(const uint32_t zone[4], uint32_t point)
{
    return zone[0] == point || zone[1] == point || zone[2] == point || zone[3] == point;
}

/* Zones beside each other share a triangle. What has none beside it is the surface: as many sides as triangles. */
static void check_neighbours(const tl_zone_mesh *m)
{
    uint32_t open = 0;
    int faults = 0;
    for (uint32_t z = 0; z < m->zone_count; z++)
        for (uint32_t i = 0; i < 4; i++) {
            const uint32_t other = m->beside[z][i];
            open += other == UINT32_MAX;
            for (uint32_t k = 0; other != UINT32_MAX && k < 4; k++)
                faults += k != i && !has_corner(m->zone[other], m->zone[z][k]);
            if (other != UINT32_MAX)
                faults += m->beside[other][0] != z && m->beside[other][1] != z && m->beside[other][2] != z &&
                          m->beside[other][3] != z;
        }
    CHECK_INT(faults, 0);
    CHECK_INT(open, m->triangle_count);
}

static void check_mesh(const tl_poly *p, const tl_zone_mesh *m)
{
    double volume = 0;
    int flat = 0;
    for (uint32_t z = 0; z < m->zone_count; z++) {
        const uint32_t *v = m->zone[z];
        const tl_vec3 *x = m->point, a = x[v[0]];
        const double six = tl_v3_dot(tl_v3_sub(x[v[1]], a), tl_v3_cross(tl_v3_sub(x[v[2]], a), tl_v3_sub(x[v[3]], a)));
        flat += !(six > 0);
        volume += six / 6;
    }
    CHECK_INT(flat, 0);
    const double whole = tl_poly_mass(p).volume;
    double area = 0;
    for (uint32_t f = 0; f < p->face_count; f++)
        area += tl_poly_face_area(p, f);
    /* points are rounded where they are */
    const double off = 1e-12 * whole + 4e-15 * area * (p->size + tl_v3_norm(p->vertex[0]));
    CHECK_NEAR(volume, whole, off);
    CHECK_NEAR(m->volume, whole, off);
    CHECK_INT(m->corner_end, p->vertex_count);
    CHECK(m->corner_end <= m->edge_end && m->edge_end <= m->face_end && m->face_end <= m->point_count);
    CHECK(!memcmp(m->point, p->vertex, p->vertex_count * sizeof *p->vertex));
    check_faces(p, m);
    check_neighbours(m);
}

/* Sums of worst shares, for the record. */
static double worst_of_all = INFINITY;

static bool divide(const tl_poly *p, const tl_shape_zoning *zoning, tl_zone_mesh *m)
{
    error.text[0] = 0;
    if (CHECK_INT(tl_zoning_make(p, zoning, scratch, m, &error), TL_OK))
        return true;
    printf("    %s: %u vertices, %u faces, size %g, thickness %g, shortest edge %g, zones of %g\n", error.text,
           p->vertex_count, p->face_count, p->size, tl_poly_thickness(p), tl_poly_shortest_edge(p), zoning->edge);
    return false;
}

TEST(random_blocks_are_filled)
{
    const int cases = check_cases(1000);
    for (int i = 0; i < cases; i++) {
        tl_poly *p = random_block();
        const tl_shape_zoning zoning = {.edge = random_edge(p)};
        tl_zone_mesh m;
        if (divide(p, &zoning, &m)) {
            check_mesh(p, &m);
            worst_of_all = fmin(worst_of_all, m.least_share);
        }
        tl_zone_mesh_free(&m);
        tl_poly_free(p);
    }
}

/* Blocks with coordinates of six digits, whose faces are bent. Hardly any is refused. */
TEST(bent_blocks_are_filled)
{
    const int cases = check_cases(300);
    int refused = 0;
    for (int i = 0; i < cases; i++) {
        tl_poly *p = random_block(), *bent = NULL;
        const double step = 1e-6 * p->size;
        for (uint32_t v = 0; v < p->vertex_count; v++) {
            tl_vec3 *x = &p->vertex[v];
            *x = tl_v3(step * floor(x->x / step), step * floor(x->y / step), step * floor(x->z / step));
        }
        if (!tl_poly_hull(p->vertex, p->vertex_count, TL_HULL_OF_CORNERS, &bent, &error)) {
            tl_zone_mesh m;
            const double edge = random_edge(bent);
            if (tl_zoning_make(bent, &(tl_shape_zoning){.edge = edge}, scratch, &m, &error)) {
                refused++;
            } else {
                CHECK_NEAR(m.volume, tl_poly_mass(bent).volume, 1e-5 * p->size * p->size * p->size);
                CHECK(m.least_altitude > 0);
                check_neighbours(&m);
            }
            tl_zone_mesh_free(&m);
        }
        tl_poly_free(bent);
        tl_poly_free(p);
    }
    CHECK(refused <= cases / 100);
}

/* ---- the same elsewhere, and larger ---- */

static bool same_lists(const tl_zone_mesh *a, const tl_zone_mesh *b)
{
    return a->point_count == b->point_count && a->zone_count == b->zone_count &&
           a->triangle_count == b->triangle_count && a->face_end == b->face_end && a->edge_end == b->edge_end &&
           !memcmp(a->zone, b->zone, a->zone_count * sizeof *a->zone) &&
           !memcmp(a->triangle, b->triangle, a->triangle_count * sizeof *a->triangle);
}

static void change(tl_poly *p, double scale, tl_vec3 move)
{
    for (uint32_t v = 0; v < p->vertex_count; v++)
        p->vertex[v] = tl_v3_madd(move, scale, p->vertex[v]);
    for (uint32_t f = 0; f < p->face_count; f++)
        p->plane[f].offset = scale * p->plane[f].offset + tl_v3_dot(p->plane[f].normal, move);
    tl_poly_find_size(p);
}

/* Rounds vertices so that a block can be moved without another rounding. */
static void round_vertices(tl_poly *p)
{
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        tl_vec3 *x = &p->vertex[v];
        *x = tl_v3(0x1p-31 * floor(0x1p31 * x->x), 0x1p-31 * floor(0x1p31 * x->y), 0x1p-31 * floor(0x1p31 * x->z));
    }
}

TEST(the_same_anywhere_and_of_any_size)
{
    const int cases = check_cases(300);
    for (int i = 0; i < cases; i++) {
        tl_poly *p = random_block();
        round_vertices(p);
        tl_shape_zoning zoning = {.edge = random_edge(p)};
        tl_zone_mesh m, moved, larger;
        if (divide(p, &zoning, &m)) {
            change(p, 1, tl_v3(0x1p20, -0x1p20, 0x1p19));
            if (divide(p, &zoning, &moved))
                CHECK(same_lists(&m, &moved));
            change(p, 1, tl_v3(-0x1p20, 0x1p20, -0x1p19));
            change(p, 1024, tl_v3(0, 0, 0));
            zoning.edge *= 1024;
            if (divide(p, &zoning, &larger)) {
                CHECK(same_lists(&m, &larger));
                for (uint32_t k = 0; k < m.point_count; k++)
                    CHECK_NEAR(tl_v3_norm(tl_v3_sub(larger.point[k], tl_v3_scale(1024, m.point[k]))), 0, 0);
            }
            tl_zone_mesh_free(&moved);
            tl_zone_mesh_free(&larger);
        }
        tl_zone_mesh_free(&m);
        tl_poly_free(p);
    }
}

/* ---- both sides of a joint ---- */

static int by_place(const void *left, const void *right)
{
    return memcmp(left, right, sizeof(tl_vec3));
}

static int by_places(const void *left, const void *right)
{
    return memcmp(left, right, 3 * sizeof(tl_vec3));
}

/* Places of the corners of all triangles of a face, in an order of their own. Returns the number of triangles. */
static uint32_t places_of(const tl_zone_mesh *m, uint32_t face, tl_vec3 (*places)[3], uint32_t most)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < m->triangle_count && count < most; i++)
        if (m->triangle[i].face == face) {
            for (int k = 0; k < 3; k++)
                places[count][k] = m->point[m->triangle[i].corner[k]];
            qsort(places[count++], 3, sizeof(tl_vec3), by_place);
        }
    qsort(places, count, sizeof *places, by_places);
    return count;
}

/* The face of a part that the cut has made: its corners are all in the other part, too. */
static uint32_t cap_of(const tl_poly *p, const tl_poly *other)
{
    for (uint32_t f = 0; f < p->face_count; f++) {
        bool common = true;
        for (uint32_t h = p->start[f]; h < p->start[f + 1]; h++) {
            bool found = false;
            for (uint32_t v = 0; v < other->vertex_count; v++)
                found = found || !memcmp(&p->vertex[p->loop[h]], &other->vertex[v], sizeof(tl_vec3));
            common = common && found;
        }
        if (common)
            return f;
    }
    return UINT32_MAX;
}

/* Keys of a newer block: corners of the older one have its numbers. */
static void keys_by(const tl_poly *newer, const tl_poly *older, uint64_t *key)
{
    for (uint32_t v = 0; v < newer->vertex_count; v++) {
        key[v] = 5000 + v;
        for (uint32_t w = 0; w < older->vertex_count; w++)
            if (!memcmp(&newer->vertex[v], &older->vertex[w], sizeof(tl_vec3)))
                key[v] = w;
    }
}

/* A wanted edge that doubles with the distance from the origin. */
static double farther_is_coarser(const void *edge, tl_vec3 place)
{
    return *(const double *)edge * (1 + tl_v3_norm(place));
}

TEST(both_sides_of_a_joint_have_the_same_triangles)
{
    enum { MOST = 4000 };
    static tl_vec3 ours[MOST][3], theirs[MOST][3];
    const int cases = check_cases(500);
    int compared = 0;
    for (int i = 0; i < cases; i++) {
        tl_poly *p = random_block();
        const double edge = random_edge(p);
        tl_cut cut;
        if (tl_poly_cut(p, random_plane(p, pick(3) ? PARALLEL : ANY), 0, (tl_tag){1, 1}, &cut, &error) ||
            cut.result != TL_CUT_MADE) {
            tl_poly_free(p);
            continue;
        }
        uint64_t key[512];
        keys_by(cut.above, cut.below, key);
        tl_zone_mesh below, above = {0};
        tl_shape_zoning zoning = {.edge = edge, .size = i % 3 ? NULL : farther_is_coarser, .user = &edge};
        const bool divided = divide(cut.below, &zoning, &below);
        zoning.corner_key = key;
        if (divided && divide(cut.above, &zoning, &above)) {
            const uint32_t count = places_of(&below, cap_of(cut.below, cut.above), ours, MOST);
            CHECK(count > 0);
            CHECK_INT(places_of(&above, cap_of(cut.above, cut.below), theirs, MOST), count);
            CHECK(!memcmp(ours, theirs, count * sizeof *ours));
            compared++;
        }
        tl_zone_mesh_free(&below);
        tl_zone_mesh_free(&above);
        tl_poly_free(cut.below);
        tl_poly_free(cut.above);
        tl_poly_free(p);
    }
    CHECK(compared > cases / 2);
}

/* ---- triangles of faces ---- */

/* No point of a face lies in the circle of a triangle there, but for the weights of points: a search through all. */
TEST(triangles_are_those_of_delaunay)
{
    const int cases = check_cases(100);
    for (int i = 0; i < cases; i++) {
        tl_poly *p = random_block();
        const tl_shape_zoning zoning = {.edge = random_edge(p)};
        tl_zone_mesh m;
        int inside = 0;
        if (divide(p, &zoning, &m))
            for (uint32_t t = 0; t < m.triangle_count; t++) {
                const uint32_t face = m.triangle[t].face, *v = m.triangle[t].corner;
                const tl_vec3 a = m.point[v[0]], ab = tl_v3_sub(m.point[v[1]], a), ac = tl_v3_sub(m.point[v[2]], a);
                const tl_vec3 n = tl_v3_cross(ab, ac);
                const tl_vec3 out = tl_v3_add(tl_v3_scale(tl_v3_norm2(ac), tl_v3_cross(n, ab)),
                                              tl_v3_scale(tl_v3_norm2(ab), tl_v3_cross(ac, n)));
                const tl_vec3 centre = tl_v3_madd(a, 0.5 / tl_v3_norm2(n), out);
                const double radius = tl_v3_norm(tl_v3_sub(centre, a));
                for (uint32_t q = 0; q < m.triangle_count; q++)
                    for (int k = 0; k < 3 && m.triangle[q].face == face; k++) {
                        const double d = tl_v3_norm(tl_v3_sub(m.point[m.triangle[q].corner[k]], centre));
                        inside += radius * radius - d * d > 2e-3 * zoning.edge * zoning.edge;
                    }
            }
        CHECK_INT(inside, 0);
        tl_zone_mesh_free(&m);
        tl_poly_free(p);
    }
}

int main(void)
{
    scratch = tl_zone_scratch_create();
    RUN(random_blocks_are_filled);
    RUN(bent_blocks_are_filled);
    RUN(the_same_anywhere_and_of_any_size);
    RUN(both_sides_of_a_joint_have_the_same_triangles);
    RUN(triangles_are_those_of_delaunay);
    tl_zone_scratch_free(scratch);
    printf("worst share %.4f\n", worst_of_all);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
