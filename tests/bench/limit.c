/* limit.c - what this machine could do at best: the memory's bandwidth, a contact law alone, the law with
 * the gathering of forces and a velocity update, and the geometry of two faces, each as bare loops over
 * columns, in cache and out of it.
 *
 *     bench_limit [quick]
 *
 * Prints rows of CSV as the workloads do. The kernels leave out all that a program must decide (who
 * touches whom, which law, what became of a contact), so no program reaches them; compiled for the very
 * machine, with reassociation, which a program that gives the same bits everywhere cannot use.
 *
 *   triad    a = b + s c, 24 bytes an element
 *   law      relative velocity at the contact, normal force, shear force turned with the plane, Coulomb
 *   step     law, then each body gathers force and moment of its contacts and gets a new velocity
 *   clip     the common area of two convex quadrilaterals, its centroid and mean depth, from two rotations
 *
 * The median of several repetitions counts. */
#include "base/parallel.h"
#include "base/random.h"
#include "base/table.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define REPS_MOST 9
#define SECONDS 0.05 /* a repetition takes at least */

static int reps = REPS_MOST;

/* Of one thread the processor time, which other programs disturb less; of several the clock. */
static clockid_t ticking = CLOCK_THREAD_CPUTIME_ID;

static double now(void)
{
    struct timespec t;
    clock_gettime(ticking, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void *columns(size_t bytes)
{
    size_t rounded = (bytes + TL_ALIGN - 1) / TL_ALIGN * TL_ALIGN;
    void *data = aligned_alloc(TL_ALIGN, rounded);
    if (!data) {
        fprintf(stderr, "limit: no memory for %zu bytes\n", bytes);
        exit(1);
    }
    memset(data, 0, rounded);
    return data;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Keeps the compiler from leaving out work whose result nobody reads. */
static void keep(const void *data)
{
    __asm__ volatile("" : : "r"(data) : "memory");
}

/* ---------------------------------------------------------------- timing ----------------- */

typedef void (*kernel_fn)(void *data, tl_pool *pool);

/* Median seconds of one pass. */
static double seconds(kernel_fn kernel, void *data, tl_pool *pool)
{
    double t[REPS_MOST];
    kernel(data, pool);
    double began = now();
    kernel(data, pool);
    int passes = (int)fmin(1e6, ceil(SECONDS / fmax(now() - began, 1e-9)));
    for (int r = 0; r < reps; r++) {
        began = now();
        for (int i = 0; i < passes; i++) {
            kernel(data, pool);
            keep(data);
        }
        t[r] = (now() - began) / passes;
    }
    qsort(t, (size_t)reps, sizeof t[0], compare);
    return t[reps / 2];
}

static void row(const char *kernel, const char *where, size_t items, unsigned threads, double rate, const char *unit)
{
    printf("limit %s,%s,%zu,%u,%.5g,%s\n", kernel, where, items, threads, rate, unit);
    fflush(stdout);
}

/* Items in chunks, one a thread. */
static void share(tl_pool *pool, size_t count, tl_range_fn range, void *data)
{
    unsigned threads = tl_pool_threads(pool);
    if (threads == 1)
        range(data, 0, count, 0, 0);
    else
        tl_parallel_for(pool, count, (count + threads - 1) / threads, range, data);
}

/* ---------------------------------------------------------------- triad ------------------ */

typedef struct triad {
    size_t count;
    double *a, *b, *c;
} triad;

static void triad_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    (void)thread;
    const triad *t = user;
    double *restrict a = t->a;
    const double *restrict b = t->b, *restrict c = t->c;
    for (size_t i = begin; i < end; i++)
        a[i] = b[i] + 3.0 * c[i];
}

static void triad_pass(void *data, tl_pool *pool)
{
    share(pool, ((const triad *)data)->count, triad_range, data);
}

static void run_triad(tl_pool *pool, const char *where, size_t count)
{
    triad t = {count, columns(8 * count), columns(8 * count), columns(8 * count)};
    double s = seconds(triad_pass, &t, pool);
    row("triad", where, count, tl_pool_threads(pool), 24e-9 * (double)count / s, "GB/s");
    free(t.a);
    free(t.b);
    free(t.c);
}

/* ---------------------------------------------------------------- law and gather --------- */

enum { VX, VY, VZ, WX, WY, WZ, X, Y, Z, BODY_COLUMNS };
enum { PX, PY, PZ, NX, NY, NZ, AREA, KN, KS, FN, SX, SY, SZ, FX, FY, FZ, CONTACT_COLUMNS };

/* A cubic lattice of bodies, neighbours in contact. */
typedef struct lattice {
    size_t bodies, contacts;
    double *body[BODY_COLUMNS], *contact[CONTACT_COLUMNS];
    uint32_t *a, *b;      /* bodies of a contact */
    uint32_t *start, *of; /* contacts of a body: 2 contact + side */
} lattice;

static const double DT = 1e-4, FRICTION = 0.6;
/* Scales the velocity update, so that forces stay what they are over any number of passes. */
static const double FEEDBACK = 1e-12, DECAY = 0.999;

static void law_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    (void)thread;
    const lattice *s = user;
    const uint32_t *restrict ia = s->a, *restrict ib = s->b;
    double *const *v = s->body;
    double *const *c = s->contact;
    const double *restrict px = c[PX], *restrict py = c[PY], *restrict pz = c[PZ];
    const double *restrict nx = c[NX], *restrict ny = c[NY], *restrict nz = c[NZ];
    const double *restrict area = c[AREA], *restrict kn = c[KN], *restrict ks = c[KS];
    double *restrict fn = c[FN], *restrict sx = c[SX], *restrict sy = c[SY], *restrict sz = c[SZ];
    double *restrict fx = c[FX], *restrict fy = c[FY], *restrict fz = c[FZ];
    const double *restrict vx = v[VX], *restrict vy = v[VY], *restrict vz = v[VZ];
    const double *restrict wx = v[WX], *restrict wy = v[WY], *restrict wz = v[WZ];
    const double *restrict x = v[X], *restrict y = v[Y], *restrict z = v[Z];
#pragma omp simd
    for (size_t i = begin; i < end; i++) {
        uint32_t a = ia[i], b = ib[i];
        double rax = px[i] - x[a], ray = py[i] - y[a], raz = pz[i] - z[a];
        double rbx = px[i] - x[b], rby = py[i] - y[b], rbz = pz[i] - z[b];
        double ux = vx[b] - vx[a] + wy[b] * rbz - wz[b] * rby - wy[a] * raz + wz[a] * ray;
        double uy = vy[b] - vy[a] + wz[b] * rbx - wx[b] * rbz - wz[a] * rax + wx[a] * raz;
        double uz = vz[b] - vz[a] + wx[b] * rby - wy[b] * rbx - wx[a] * ray + wy[a] * rax;
        double un = ux * nx[i] + uy * ny[i] + uz * nz[i];
        double normal = fmax(fn[i] - kn[i] * area[i] * DT * un, 0);
        /* the shear force into the present plane, its length kept */
        double out = sx[i] * nx[i] + sy[i] * ny[i] + sz[i] * nz[i];
        double before = sx[i] * sx[i] + sy[i] * sy[i] + sz[i] * sz[i];
        double tx = sx[i] - out * nx[i], ty = sy[i] - out * ny[i], tz = sz[i] - out * nz[i];
        double turned = sqrt(before / (tx * tx + ty * ty + tz * tz + 1e-300));
        double k = ks[i] * area[i] * DT;
        tx = tx * turned - k * (ux - un * nx[i]);
        ty = ty * turned - k * (uy - un * ny[i]);
        tz = tz * turned - k * (uz - un * nz[i]);
        double limit = FRICTION * normal, shear = sqrt(tx * tx + ty * ty + tz * tz + 1e-300);
        double cap = fmin(limit / shear, 1);
        fn[i] = normal;
        sx[i] = tx * cap;
        sy[i] = ty * cap;
        sz[i] = tz * cap;
        fx[i] = sx[i] + normal * nx[i];
        fy[i] = sy[i] + normal * ny[i];
        fz[i] = sz[i] + normal * nz[i];
    }
}

static void gather_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    (void)thread;
    const lattice *s = user;
    double *const *v = s->body;
    double *const *c = s->contact;
    for (size_t b = begin; b < end; b++) {
        double f[6] = {0};
        for (uint32_t k = s->start[b]; k < s->start[b + 1]; k++) {
            size_t i = s->of[k] >> 1;
            double sign = s->of[k] & 1 ? 1.0 : -1.0;
            double gx = sign * c[FX][i], gy = sign * c[FY][i], gz = sign * c[FZ][i];
            double rx = c[PX][i] - v[X][b], ry = c[PY][i] - v[Y][b], rz = c[PZ][i] - v[Z][b];
            f[0] += gx;
            f[1] += gy;
            f[2] += gz;
            f[3] += ry * gz - rz * gy;
            f[4] += rz * gx - rx * gz;
            f[5] += rx * gy - ry * gx;
        }
        for (int k = 0; k < 6; k++)
            v[VX + k][b] = DECAY * (v[VX + k][b] + FEEDBACK * f[k]);
    }
}

static void law_pass(void *data, tl_pool *pool)
{
    share(pool, ((const lattice *)data)->contacts, law_range, data);
}

static void step_pass(void *data, tl_pool *pool)
{
    law_pass(data, pool);
    share(pool, ((const lattice *)data)->bodies, gather_range, data);
}

static void lattice_contact(lattice *s, uint32_t a, uint32_t b, int axis)
{
    size_t i = s->contacts++;
    double *const *c = s->contact;
    s->a[i] = a;
    s->b[i] = b;
    for (int k = 0; k < 3; k++) {
        c[PX + k][i] = s->body[X + k][a] + (k == axis ? 0.5 : 0.01);
        c[NX + k][i] = k == axis;
        c[SX + k][i] = k == axis ? 0 : 10;
    }
    c[AREA][i] = 1;
    c[KN][i] = 1e9;
    c[KS][i] = 5e8;
    c[FN][i] = 1e4;
    s->start[a + 1]++;
    s->start[b + 1]++;
}

static lattice lattice_make(uint32_t n)
{
    lattice s = {.bodies = (size_t)n * n * n};
    size_t most = 3 * (size_t)n * n * (n - 1);
    for (int k = 0; k < BODY_COLUMNS; k++)
        s.body[k] = columns(8 * s.bodies);
    for (int k = 0; k < CONTACT_COLUMNS; k++)
        s.contact[k] = columns(8 * most);
    s.a = columns(4 * most);
    s.b = columns(4 * most);
    s.start = columns(4 * (s.bodies + 1));
    s.of = columns(8 * most);
    const uint32_t stride[3] = {1, n, n * n};
    for (uint32_t b = 0; b < s.bodies; b++)
        for (int k = 0; k < 3; k++) {
            s.body[X + k][b] = b / stride[k] % n;
            s.body[VX + k][b] = 1e-6 * ((double)(b * 2654435761u) / 4294967296.0 - 0.5);
        }
    for (uint32_t b = 0; b < s.bodies; b++)
        for (int k = 0; k < 3; k++)
            if (b / stride[k] % n + 1 < n)
                lattice_contact(&s, b, b + stride[k], k);
    for (size_t b = 0; b < s.bodies; b++)
        s.start[b + 1] += s.start[b];
    uint32_t *fill = columns(4 * s.bodies);
    memcpy(fill, s.start, 4 * s.bodies);
    for (uint32_t i = 0; i < s.contacts; i++) {
        s.of[fill[s.a[i]]++] = 2 * i;
        s.of[fill[s.b[i]]++] = 2 * i + 1;
    }
    free(fill);
    return s;
}

static void lattice_free(lattice *s)
{
    for (int k = 0; k < BODY_COLUMNS; k++)
        free(s->body[k]);
    for (int k = 0; k < CONTACT_COLUMNS; k++)
        free(s->contact[k]);
    free(s->a);
    free(s->b);
    free(s->start);
    free(s->of);
}

static void run_lattice(tl_pool *pool, const char *where, uint32_t n)
{
    lattice s = lattice_make(n);
    unsigned threads = tl_pool_threads(pool);
    double count = (double)s.contacts;
    row("law", where, s.contacts, threads, count / seconds(law_pass, &s, pool), "contacts/s");
    row("step", where, s.contacts, threads, count / seconds(step_pass, &s, pool), "contacts/s");
    lattice_free(&s);
}

/* ---------------------------------------------------------------- clip ------------------- */

/* Of a pair: the place of A's frame of the face, its two axes, the quad in it; B's normal and vertices, each in
 * its body's frame; then what is found. */
enum {
    ORIGIN,
    AXIS_E = ORIGIN + 3,
    AXIS_G = AXIS_E + 3,
    QUAD_A = AXIS_G + 3,
    NORMAL_B = QUAD_A + 8,
    QUAD_B = NORMAL_B + 3,
    FOUND = QUAD_B + 12,
    PAIR_COLUMNS = FOUND + 4
};
enum { ROTATION, PLACE = 9, FRAME_COLUMNS = 12 };

typedef struct pairs {
    size_t count, frames;
    double *frame[FRAME_COLUMNS];
    uint32_t *a, *b;
    double *column[PAIR_COLUMNS];
} pairs;

/* Pairs are clipped eight at a time. */
enum { LANES = 8 };
typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef int64_t mask __attribute__((vector_size(8 * LANES)));

static inline lanes choose(mask m, lanes yes, lanes no)
{
    return (lanes)((m & (mask)yes) | (~m & (mask)no));
}

static inline lanes read_lanes(const double *column, size_t i)
{
    lanes x;
    memcpy(&x, column + i, sizeof x);
    return x;
}

static inline void write_lanes(double *column, size_t i, lanes x)
{
    memcpy(column + i, &x, sizeof x);
}

typedef struct v3 {
    lanes x, y, z;
} v3;

static inline lanes dot(v3 a, v3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline v3 load(double *const *column, size_t i)
{
    return (v3){read_lanes(column[0], i), read_lanes(column[1], i), read_lanes(column[2], i)};
}

typedef struct frames {
    lanes at[FRAME_COLUMNS];
} frames;

static inline frames gather_frames(double *const *column, const uint32_t *body)
{
    frames f;
    for (int k = 0; k < FRAME_COLUMNS; k++)
        for (int l = 0; l < LANES; l++)
            f.at[k][l] = column[k][body[l]];
    return f;
}

static inline v3 turn(const frames *f, v3 p)
{
    const lanes *r = f->at;
    return (v3){r[0] * p.x + r[1] * p.y + r[2] * p.z, r[3] * p.x + r[4] * p.y + r[5] * p.z,
                r[6] * p.x + r[7] * p.y + r[8] * p.z};
}

typedef struct corner {
    lanes x, y;
} corner;

typedef struct quad {
    corner at[4]; /* counter-clockwise */
} quad;

typedef struct integral {
    lanes area, x, y; /* twice the area, six times the first moments */
} integral;

/* Adds the boundary integral over the part of p -> q inside the quad. What lies on an edge of it is inside if
 * `border` is above 0, so that edges of two quads that coincide count once. */
static inline integral inside(integral sum, corner p, corner q, const quad *c, double border)
{
    lanes t0 = {0}, t1 = t0 + 1.0, none = t0 - 1.0;
    for (int k = 0; k < 4; k++) {
        corner a = c->at[k], b = c->at[(k + 1) & 3];
        lanes ex = b.x - a.x, ey = b.y - a.y;
        lanes dp = ex * (p.y - a.y) - ey * (p.x - a.x), dq = ex * (q.y - a.y) - ey * (q.x - a.x);
        lanes t = dp / (dp - dq);
        mask enters = (mask)(dq > dp), leaves = (mask)(dq < dp);
        mask outside = ~(enters | leaves) & (mask)(dp + border < 0);
        t0 = choose(enters & (mask)(t > t0), t, t0);
        t1 = choose(outside, none, choose(leaves & (mask)(t < t1), t, t1));
    }
    lanes ux = p.x + t0 * (q.x - p.x), uy = p.y + t0 * (q.y - p.y);
    lanes wx = p.x + t1 * (q.x - p.x), wy = p.y + t1 * (q.y - p.y);
    lanes cross = choose((mask)(t1 > t0), ux * wy - uy * wx, (lanes){0});
    return (integral){sum.area + cross, sum.x + cross * (ux + wx), sum.y + cross * (uy + wy)};
}

/* Borders for which a point on an edge is inside or outside, relative to quads of about 1 m. */
static const double WITH_BORDER = 1e-12, WITHOUT_BORDER = -1e-12;

/* The common area as an integral around it: the edges of each quad inside the other. */
static inline integral common(const quad *a, const quad *b)
{
    integral sum = {{0}, {0}, {0}};
    for (int k = 0; k < 4; k++) {
        sum = inside(sum, a->at[k], a->at[(k + 1) & 3], b, WITH_BORDER);
        sum = inside(sum, b->at[k], b->at[(k + 1) & 3], a, WITHOUT_BORDER);
    }
    return sum;
}

static void clip_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    (void)thread;
    const pairs *s = user;
    double *const *c = s->column;
    for (size_t i = begin; i < end; i += LANES) {
        frames fa = gather_frames(s->frame, s->a + i), fb = gather_frames(s->frame, s->b + i);
        v3 e = turn(&fa, load(c + AXIS_E, i)), g = turn(&fa, load(c + AXIS_G, i));
        v3 n = {e.y * g.z - e.z * g.y, e.z * g.x - e.x * g.z, e.x * g.y - e.y * g.x};
        v3 o = turn(&fa, load(c + ORIGIN, i)), m = turn(&fb, load(c + NORMAL_B, i)), first = {0};
        v3 apart = {fb.at[PLACE] - fa.at[PLACE] - o.x, fb.at[PLACE + 1] - fa.at[PLACE + 1] - o.y,
                    fb.at[PLACE + 2] - fa.at[PLACE + 2] - o.z};
        quad qa, qb;
        for (int k = 0; k < 4; k++) {
            v3 r = turn(&fb, load(c + QUAD_B + 3 * k, i));
            v3 p = {r.x + apart.x, r.y + apart.y, r.z + apart.z};
            first = k ? first : p;
            qb.at[k] = (corner){dot(p, e), dot(p, g)};
            qa.at[k] = (corner){read_lanes(c[QUAD_A + 2 * k], i), read_lanes(c[QUAD_A + 2 * k + 1], i)};
        }
        integral sum = common(&qa, &qb);
        lanes third = 1.0 / (3.0 * sum.area + 1e-300), x = sum.x * third, y = sum.y * third;
        /* B's plane over the centroid, along A's normal */
        lanes gap = (dot(first, m) - x * dot(e, m) - y * dot(g, m)) / dot(n, m);
        write_lanes(c[FOUND], i, 0.5 * sum.area);
        write_lanes(c[FOUND + 1], i, x);
        write_lanes(c[FOUND + 2], i, y);
        write_lanes(c[FOUND + 3], i, -gap);
    }
}

static void clip_pass(void *data, tl_pool *pool)
{
    share(pool, ((const pairs *)data)->count, clip_range, data);
}

/* Unit squares on top of each other, the upper ones offset by up to half a side and turned at random. */
static pairs pairs_make(size_t count)
{
    pairs s = {.count = count, .frames = count + 1};
    for (int k = 0; k < FRAME_COLUMNS; k++)
        s.frame[k] = columns(8 * s.frames);
    for (int k = 0; k < PAIR_COLUMNS; k++)
        s.column[k] = columns(8 * count);
    s.a = columns(4 * count);
    s.b = columns(4 * count);
    for (uint32_t i = 0; i < s.frames; i++) {
        double angle = 0.5 * tl_uniform(3u * i), sine = sin(angle), cosine = cos(angle);
        const double frame[FRAME_COLUMNS] = {
            cosine,   -sine, 0, sine, cosine, 0, 0, 0, 1, 0.5 * tl_uniform(3u * i + 1), 0.5 * tl_uniform(3u * i + 2),
            0.999 * i};
        for (int k = 0; k < FRAME_COLUMNS; k++)
            s.frame[k][i] = frame[k];
    }
    static const double square[8] = {-0.5, -0.5, 0.5, -0.5, 0.5, 0.5, -0.5, 0.5};
    for (uint32_t i = 0; i < count; i++) {
        s.a[i] = i;
        s.b[i] = i + 1;
        s.column[ORIGIN + 2][i] = 0.5;
        s.column[AXIS_E][i] = s.column[AXIS_G + 1][i] = 1;
        s.column[NORMAL_B + 2][i] = -1;
        for (int k = 0; k < 8; k++)
            s.column[QUAD_A + k][i] = square[k];
        for (int k = 0; k < 4; k++) {
            s.column[QUAD_B + 3 * k][i] = square[2 * k];
            s.column[QUAD_B + 3 * k + 1][i] = square[2 * k + 1];
            s.column[QUAD_B + 3 * k + 2][i] = -0.5;
        }
    }
    return s;
}

static void pairs_free(pairs *s)
{
    for (int k = 0; k < FRAME_COLUMNS; k++)
        free(s->frame[k]);
    for (int k = 0; k < PAIR_COLUMNS; k++)
        free(s->column[k]);
    free(s->a);
    free(s->b);
}

/* The mean area must be that of the common area of such squares, or the kernel does not do its work. */
static void check_areas(const pairs *s)
{
    double sum = 0, depth = 0;
    for (size_t i = 0; i < s->count; i++) {
        sum += s->column[FOUND][i];
        depth = fmax(depth, fabs(s->column[FOUND + 3][i] - 1e-3));
    }
    double mean = sum / (double)s->count;
    if (!(mean > 0.5 && mean < 0.9) || depth > 1e-9) {
        fprintf(stderr, "limit: clip found a mean area of %g m2, depth wrong by %g m\n", mean, depth);
        exit(1);
    }
}

static void run_clip(tl_pool *pool, const char *where, size_t count)
{
    pairs s = pairs_make(count);
    double t = seconds(clip_pass, &s, pool);
    check_areas(&s);
    row("clip", where, count, tl_pool_threads(pool), (double)count / t, "contacts/s");
    pairs_free(&s);
}

/* ---------------------------------------------------------------- all -------------------- */

/* Sizes: within a second-level cache of 1 MiB, and far beyond any last-level cache a core has to itself. */
enum { TRIAD_IN = 1 << 14, LATTICE_IN = 11, CLIP_IN = 2000 };
enum { TRIAD_OUT = 1 << 25, LATTICE_OUT = 70, CLIP_OUT = 1000000 };

int main(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "quick") == 0)
        reps = 3;
    puts("workload,size,contacts,threads,rate,unit");
    for (unsigned threads = 1; threads <= 2; threads++) {
        ticking = threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC;
        tl_pool *pool = tl_pool_create(threads);
        if (!pool)
            return 1;
        run_triad(pool, "in cache", TRIAD_IN);
        run_triad(pool, "out of cache", TRIAD_OUT);
        run_lattice(pool, "in cache", LATTICE_IN);
        run_lattice(pool, "out of cache", LATTICE_OUT);
        run_clip(pool, "in cache", CLIP_IN);
        run_clip(pool, "out of cache", CLIP_OUT);
        tl_pool_destroy(pool);
    }
    return 0;
}
