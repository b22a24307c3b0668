/* convex_properties.c - thousands of seeded polygons divided into convex parts: the parts are convex, do not overlap, lie in
 * the polygon and add up to it, whichever way round it is given, wherever it lies, with or without corners on straight lines.
 * Polygons that cross or touch themselves are refused. */
#include "check.h"

#include "../../plugins/generators/prism/convex.c"

#define MOST 120
#define TWO_PI 6.28318530717958647692

static double between(uint64_t *seed, double low, double high)
{
    return low + (high - low) * check_random(seed);
}

static size_t whole(uint64_t *seed, size_t low, size_t high)
{
    return low + (size_t)(check_random(seed) * (double)(high - low + 1)) % (high - low + 1);
}

/* ---------------------------------------------------------------- polygons --------------- */

/* Corners at rising angles about the middle. */
static size_t star(uint64_t *seed, tl_flat *at)
{
    size_t n = whole(seed, 3, 60);
    for (size_t i = 0; i < n; i++) {
        double angle = TWO_PI * ((double)i + between(seed, 0, 0.8)) / (double)n;
        double r = between(seed, 0.05, 1);
        at[i] = (tl_flat){r * cos(angle), r * sin(angle)};
    }
    return n;
}

/* A terrain profile over a flat base: heights at rising places, some repeated so that edges are level. */
static size_t profile(uint64_t *seed, tl_flat *at)
{
    size_t n = whole(seed, 2, 50);
    double x = 0, z = 1;
    at[0] = (tl_flat){0, 0};
    for (size_t i = 0; i < n; i++) {
        if (check_random(seed) < 0.6)
            z = between(seed, 0.2, 3);
        at[n - i] = (tl_flat){x, z};
        x += between(seed, 0.1, 1);
    }
    at[n + 1] = at[0];
    at[0] = (tl_flat){at[1].x, 0};
    return n + 2;
}

/* A comb: teeth of a grid, all corners square and many in line. */
static size_t comb(uint64_t *seed, tl_flat *at)
{
    size_t teeth = whole(seed, 1, 12), n = 0;
    at[n++] = (tl_flat){0, 0};
    at[n++] = (tl_flat){2.0 * (double)teeth - 1, 0};
    for (size_t k = teeth; k-- > 0;) {
        double top = (double)whole(seed, 2, 4), x = 2.0 * (double)k;
        at[n++] = (tl_flat){x + 1, top};
        at[n++] = (tl_flat){x, top};
        if (k) {
            at[n++] = (tl_flat){x, 1};
            at[n++] = (tl_flat){x - 1, 1};
        }
    }
    return n;
}

/* A strip that winds inward. */
static size_t spiral(uint64_t *seed, tl_flat *at)
{
    size_t n = whole(seed, 6, 50);
    double turn = between(seed, 0.2, 0.5), width = between(seed, 0.2, 0.6);
    for (size_t i = 0; i < n; i++) {
        double angle = turn * (double)i, r = 1 + angle / TWO_PI;
        at[i] = (tl_flat){r * cos(angle), r * sin(angle)};
        at[2 * n - 1 - i] = (tl_flat){(r + width) * cos(angle), (r + width) * sin(angle)};
    }
    return 2 * n;
}

/* Random points made simple by turning round the stretch between two edges that cross, until none do. */
static size_t tangle(uint64_t *seed, tl_flat *at)
{
    size_t n = whole(seed, 4, 20);
    for (size_t i = 0; i < n; i++)
        at[i] = (tl_flat){between(seed, 0, 1), between(seed, 0, 1)};
    for (bool crossed = true; crossed;) {
        crossed = false;
        for (size_t i = 0; i + 2 < n; i++)
            for (size_t j = i + 2; j < n; j++) {
                tl_flat a = at[i], b = at[i + 1], c = at[j], d = at[(j + 1) % n];
                if ((i == 0 && j == n - 1) || (tl_flat_cross(a, b, c) > 0) == (tl_flat_cross(a, b, d) > 0) ||
                    (tl_flat_cross(c, d, a) > 0) == (tl_flat_cross(c, d, b) > 0))
                    continue;
                for (size_t p = i + 1, q = j; p < q; p++, q--) {
                    tl_flat keep = at[p];
                    at[p] = at[q];
                    at[q] = keep;
                }
                crossed = true;
            }
    }
    return n;
}

static size_t (*const kinds[])(uint64_t *, tl_flat *) = {star, profile, comb, spiral, tangle};

static size_t make(uint64_t *seed, size_t kind, tl_flat *at)
{
    size_t n = kinds[kind % 5](seed, at);
    double angle = check_random(seed) < 0.5 ? 0 : between(seed, 0, TWO_PI);
    double scale = check_random(seed) < 0.5 ? 1 : between(seed, 1e-3, 1e3);
    tl_flat to = {between(seed, -1e3, 1e3), between(seed, -1e3, 1e3)};
    for (size_t i = 0; i < n; i++) {
        tl_flat p = at[i];
        at[i] = (tl_flat){scale * (cos(angle) * p.x - sin(angle) * p.y + to.x),
                          scale * (sin(angle) * p.x + cos(angle) * p.y + to.y)};
    }
    return n;
}

static double twice_area(const tl_flat *at, size_t n)
{
    double sum = 0;
    for (size_t i = 2; i < n; i++)
        sum += tl_flat_cross(at[0], at[i - 1], at[i]);
    return sum;
}

static double extent_of(const tl_flat *at, size_t n)
{
    double extent = 0;
    for (size_t i = 1; i < n; i++)
        extent = fmax(extent, tl_flat_apart(at[0], at[i]));
    return extent;
}

/* ---------------------------------------------------------------- properties ------------- */

/* How many parts hold a point. */
static int parts_with(const tl_flat *at, const convex_parts *parts, tl_flat p)
{
    int holding = 0;
    for (size_t k = 0; k < parts->parts; k++) {
        const size_t *c = parts->corner + parts->start[k];
        size_t n = parts->start[k + 1] - parts->start[k];
        bool inside = true;
        for (size_t i = 0; i < n && inside; i++)
            inside = tl_flat_cross(at[c[i]], at[c[(i + 1) % n]], p) > 0;
        holding += inside;
    }
    return holding;
}

/* By the number of edges that a ray from it crosses. */
static bool is_inside(const tl_flat *at, size_t n, tl_flat p)
{
    bool inside = false;
    for (size_t i = 0, j = n - 1; i < n; j = i++)
        if ((at[i].y > p.y) != (at[j].y > p.y) &&
            p.x < at[i].x + (p.y - at[i].y) / (at[j].y - at[i].y) * (at[j].x - at[i].x))
            inside = !inside;
    return inside;
}

static double off_edges(const tl_flat *at, const size_t *corner, size_t n, tl_flat p)
{
    double least = INFINITY;
    for (size_t i = 0; i < n; i++)
        least = fmin(least, tl_flat_off_segment(at[corner[i]], at[corner[(i + 1) % n]], p));
    return least;
}

/* Points that are not on the border of a part are in one part when in the polygon, else in none. */
static int misplaced(uint64_t *seed, const tl_flat *at, size_t n, const convex_parts *parts)
{
    int wrong = 0;
    double extent = extent_of(at, n);
    for (int k = 0; k < 60; k++) {
        tl_flat p = {at[0].x + extent * between(seed, -1, 1), at[0].y + extent * between(seed, -1, 1)};
        double near = INFINITY;
        for (size_t q = 0; q < parts->parts; q++)
            near = fmin(near, off_edges(at, parts->corner + parts->start[q], parts->start[q + 1] - parts->start[q], p));
        if (near > 1e-6 * extent)
            wrong += parts_with(at, parts, p) != is_inside(at, n, p);
    }
    return wrong;
}

/* Corners that turn inward, of a polygon that may be given clockwise. */
static size_t reflex(const tl_flat *at, size_t n)
{
    size_t count = 0;
    double sign = twice_area(at, n) > 0 ? 1 : -1;
    for (size_t i = 0; i < n; i++)
        count += sign * tl_flat_height(at[i], at[(i + 1) % n], at[(i + 2) % n]) < -1e-9 * extent_of(at, n);
    return count;
}

static int convex_corners(const tl_flat *at, const convex_parts *parts)
{
    int wrong = 0;
    for (size_t p = 0; p < parts->parts; p++) {
        const size_t *c = parts->corner + parts->start[p];
        size_t n = parts->start[p + 1] - parts->start[p];
        wrong += n < 3;
        for (size_t i = 0; i < n; i++)
            wrong += !(tl_flat_cross(at[c[i]], at[c[(i + 1) % n]], at[c[(i + 2) % n]]) > 0);
    }
    return wrong;
}

/* Thinnest part: least extent along the normal of an edge, over the polygon's extent. */
static double check_parts(uint64_t *seed, const tl_flat *at, size_t n, const convex_parts *parts)
{
    double sum = 0, extent = extent_of(at, n), thinnest = INFINITY;
    for (size_t p = 0; p < parts->parts; p++) {
        const size_t *c = parts->corner + parts->start[p];
        size_t count = parts->start[p + 1] - parts->start[p];
        sum += area_of(at, c, count);
        for (size_t i = 0; i < count; i++) {
            double farthest = 0, length = tl_flat_apart(at[c[i]], at[c[(i + 1) % count]]);
            for (size_t j = 0; j < count; j++)
                farthest = fmax(farthest, tl_flat_cross(at[c[i]], at[c[(i + 1) % count]], at[c[j]]));
            thinnest = fmin(thinnest, farthest / length / extent);
        }
    }
    CHECK_NEAR(sum, fabs(twice_area(at, n)), 1e-9 * extent * extent);
    CHECK_INT(convex_corners(at, parts), 0);
    CHECK_INT(misplaced(seed, at, n, parts), 0);
    size_t inward = reflex(at, n);
    CHECK(parts->parts <= 2 * inward + 1); /* Hertel and Mehlhorn */
    CHECK(inward > 0 || parts->parts == 1);
    return thinnest;
}

TEST(parts_make_up_the_polygon)
{
    uint64_t seed = 20261123;
    size_t divided = 0, refused = 0;
    for (size_t k = 0; k < 6000; k++) {
        tl_flat at[MOST], turned[MOST];
        size_t n = make(&seed, k, at), one, other;
        convex_parts parts;
        convex_status status = convex_divide(at, n, &parts, &one, &other);
        if (status != CONVEX_DONE) {
            /* corners that came too near to others */
            CHECK(status == CONVEX_CROSSES || status == CONVEX_COINCIDE);
            refused++;
            continue;
        }
        divided++;
        check_parts(&seed, at, n, &parts);
        for (size_t i = 0; i < n; i++)
            turned[i] = at[n - 1 - i];
        convex_parts back;
        if (CHECK_INT(convex_divide(turned, n, &back, &one, &other), CONVEX_DONE)) {
            check_parts(&seed, turned, n, &back);
            free(back.corner);
            free(back.start);
        }
        free(parts.corner);
        free(parts.start);
    }
    printf("divided %zu, refused %zu\n", divided, refused);
    CHECK(refused < 60);
}

/* Corners in the middle of edges change nothing but are no corners of convex parts. */
TEST(corners_on_lines_do_not_count)
{
    uint64_t seed = 7;
    for (size_t k = 0; k < 2000; k++) {
        tl_flat at[MOST], more[2 * MOST];
        size_t n = make(&seed, k, at), m = 0, one, other;
        for (size_t i = 0; i < n; i++) {
            tl_flat b = at[(i + 1) % n];
            double t = between(&seed, 0.2, 0.8);
            more[m++] = at[i];
            more[m++] = (tl_flat){at[i].x + t * (b.x - at[i].x), at[i].y + t * (b.y - at[i].y)};
        }
        convex_parts plain, rich;
        if (convex_divide(at, n, &plain, &one, &other) != CONVEX_DONE)
            continue;
        convex_status status = convex_divide(more, m, &rich, &one, &other);
        if (status == CONVEX_DONE) {
            check_parts(&seed, more, m, &rich);
            CHECK_INT(rich.parts, plain.parts);
            for (size_t i = 0; i < rich.start[rich.parts]; i++)
                CHECK(rich.corner[i] % 2 == 0);
            free(rich.corner);
            free(rich.start);
        } else {
            CHECK_INT(status, CONVEX_CROSSES); /* new points of two edges near each other */
        }
        free(plain.corner);
        free(plain.start);
    }
}

/* Whether two edges without a common corner cross, by the signs of triangles alone. */
static bool crosses(const tl_flat *at, size_t n)
{
    for (size_t i = 0; i + 2 < n; i++)
        for (size_t j = i + 2; j < n; j++) {
            tl_flat a = at[i], b = at[i + 1], c = at[j], d = at[(j + 1) % n];
            if ((i != 0 || j != n - 1) && (tl_flat_cross(a, b, c) > 0) != (tl_flat_cross(a, b, d) > 0) &&
                (tl_flat_cross(c, d, a) > 0) != (tl_flat_cross(c, d, b) > 0))
                return true;
        }
    return false;
}

/* Two corners that have changed their places mostly make edges cross: then it is refused, and only then. */
TEST(what_crosses_itself_is_refused)
{
    uint64_t seed = 99;
    size_t crossing = 0, simple = 0;
    for (size_t k = 0; k < 4000; k++) {
        tl_flat at[MOST];
        size_t n = make(&seed, k, at), one = SIZE_MAX, other = SIZE_MAX;
        size_t i = whole(&seed, 0, n - 1), j = whole(&seed, 0, n - 1);
        tl_flat keep = at[i];
        at[i] = at[j];
        at[j] = keep;
        convex_parts parts;
        convex_status status = convex_divide(at, n, &parts, &one, &other);
        if (crosses(at, n)) {
            crossing++;
            CHECK(status == CONVEX_CROSSES || status == CONVEX_COINCIDE);
            CHECK(one < n && other < n && parts.corner == NULL);
        } else if (status == CONVEX_DONE) {
            simple++;
            check_parts(&seed, at, n, &parts);
            free(parts.corner);
            free(parts.start);
        }
    }
    printf("crossing %zu, simple %zu\n", crossing, simple);
    CHECK(crossing > 1000 && simple > 100);
}

TEST(touching_folded_and_flat_ones_are_refused)
{
    convex_parts parts;
    size_t one, other;
    /* a square with a square hole, joined by a cut there and back */
    const tl_flat keyhole[] = {{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}};
    CHECK_INT(convex_divide(keyhole, 10, &parts, &one, &other), CONVEX_CROSSES);
    const tl_flat spike[] = {{0, 0}, {2, 0}, {1, 0}, {1, 1}};
    CHECK_INT(convex_divide(spike, 4, &parts, &one, &other), CONVEX_CROSSES);
    const tl_flat pinched[] = {{0, 0}, {2, 0}, {1, 1}, {2, 2}, {0, 2}, {1, 1}};
    CHECK_INT(convex_divide(pinched, 6, &parts, &one, &other), CONVEX_CROSSES);
    const tl_flat twice[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    CHECK_INT(convex_divide(twice, 5, &parts, &one, &other), CONVEX_COINCIDE);
    CHECK(one == 4 && other == 0);
    const tl_flat line[] = {{0, 0}, {1, 0}, {2, 0}};
    CHECK(convex_divide(line, 3, &parts, &one, &other) != CONVEX_DONE);
    const tl_flat thin[] = {{0, 0}, {1, 0}, {1, 1e-7}, {0, 1e-7}};
    CHECK_INT(convex_divide(thin, 4, &parts, &one, &other), CONVEX_COINCIDE);
    CHECK_INT(convex_divide(line, 2, &parts, &one, &other), CONVEX_EMPTY);
}

/* An L is two parts, a slope with a berm as many as its inward corners and one. */
TEST(few_parts)
{
    convex_parts parts;
    size_t one, other;
    const tl_flat letter[] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    CHECK_INT(convex_divide(letter, 6, &parts, &one, &other), CONVEX_DONE);
    CHECK_INT(parts.parts, 2);
    free(parts.corner);
    free(parts.start);
    const tl_flat slope[] = {{0, 0}, {100, 0}, {100, 20}, {70, 20}, {60, 40}, {50, 40}, {40, 60}, {0, 60}};
    CHECK_INT(convex_divide(slope, 8, &parts, &one, &other), CONVEX_DONE);
    CHECK_INT(parts.parts, 3);
    free(parts.corner);
    free(parts.start);
}

TEST_MAIN(RUN(parts_make_up_the_polygon), RUN(corners_on_lines_do_not_count), RUN(what_crosses_itself_is_refused),
          RUN(touching_folded_and_flat_ones_are_refused), RUN(few_parts))
