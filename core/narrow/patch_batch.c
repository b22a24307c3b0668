/* patch_batch.c - face on face for several pairs at once: the patches of patch.c, a pair in each lane.
 *
 * One patch is a long chain of things that wait for each other. A lane for each of several pairs fills the waiting,
 * and the vectors. Heights of all corners over all lines of the other face tell by their signs which polygon it is.
 * Its corners are then placed from those of the faces. Where corners stand clear of each other and turn enough to be
 * full, every point is what patch.c makes it, to the bit. The others are left to it. A lane's patch does not depend on
 * what is in other lanes: corners and edges beyond its last have no length, and add nothing. */
#include "narrow/patch_batch.h"

#include "narrow/common_polygon.h"

#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- outlines ----------------
 *
 * The corners of the common polygon of two convex faces, by which corners lie inside which lines.
 *
 * Which edges cross, which corners belong to the polygon and in which order follows from signs alone. An edge of A
 * crosses one of B when the ends of each lie on two sides of the other's line. A corner of A on a line of B counts as
 * inside, one of B on a line of A as outside. Edges along each other then do not cross. The same signs come again step
 * after step, so what they mean is kept in a table. Signs that fit no two convex faces, as rounding may make them,
 * give no outline. */

typedef struct walk {
    tl_outline *o;
    uint32_t na, nb;
    bool lost; /* the signs fit no polygon */
} walk;

static bool inside(uint64_t bytes, uint32_t corner, uint32_t line)
{
    return bytes >> (8 * corner + line) & 1;
}

static bool inside_all(uint64_t bytes, uint32_t corner, uint32_t lines)
{
    uint32_t all = (1u << lines) - 1;
    return (bytes >> 8 * corner & all) == all;
}

static uint32_t next_of(uint32_t i, uint32_t count)
{
    return i + 1 == count ? 0 : i + 1;
}

static void add(walk *w, uint32_t key, tl_outline_corner corner, uint32_t edge)
{
    tl_outline *o = w->o;
    if (o->count == TL_OUTLINE_CORNERS) {
        w->lost = true;
        return;
    }
    o->key[o->count] = key;
    o->edge[o->count] = (uint8_t)edge;
    o->corner[o->count++] = corner;
}

/* Adds a face's own corner. */
static void add_own(walk *w, uint32_t kind, uint32_t i)
{
    uint8_t at = (uint8_t)(kind == TL_POINT_A ? i : TL_OUTLINE_CORNERS + i);
    add(w, tl_corner_key(kind, i),
        (tl_outline_corner){.from = at, .to = at, .over = TL_HEIGHT_OWN, .under = TL_HEIGHT_OWN + 1}, at);
}

/* Adds the corner where edge i of A crosses line j of B, and polygon goes on along `edge`. */
static void add_crossing(walk *w, uint32_t i, uint32_t j, uint32_t edge)
{
    uint32_t end = next_of(i, w->na);
    add(w, tl_key_of(TL_POINT_CROSSING, i, TL_EDGE_B + j),
        (tl_outline_corner){.from = (uint8_t)i,
                            .to = (uint8_t)end,
                            .over = (uint8_t)(TL_OUTLINE_CORNERS * j + i),
                            .under = (uint8_t)(TL_OUTLINE_CORNERS * j + end)},
        edge);
}

/* Adds the corners of B from its line j to its line `to`, which must all lie inside A; returns their number. */
static uint32_t follow_b(walk *w, uint32_t j, uint32_t to)
{
    uint32_t count = 0;
    for (; j != to && !w->lost; count++) {
        j = next_of(j, w->nb);
        w->lost |= !inside_all(w->o->inside_b, j, w->na);
        add_own(w, TL_POINT_B, j);
    }
    return count;
}

/* The lines of B over which edge i of A comes in and goes out, or nb. */
static void crossings_of(walk *w, uint32_t i, uint32_t *in, uint32_t *out)
{
    const tl_outline *o = w->o;
    uint32_t end = next_of(i, w->na);
    *in = *out = w->nb;
    for (uint32_t j = 0; j < w->nb; j++) {
        bool here = inside(o->inside_a, i, j);
        if (here == inside(o->inside_a, end, j) ||
            inside(o->inside_b, j, i) == inside(o->inside_b, next_of(j, w->nb), i))
            continue;
        uint32_t *line = here ? out : in;
        w->lost |= *line != w->nb;
        *line = j;
    }
}

/* Follows A's edges where they lie inside B, and B's edges from where one goes out to where the next comes in. */
static void go_round(walk *w)
{
    uint32_t corners_b = 0, inside_b = 0, none = w->nb, first_in = none, left_over = none;
    bool on = inside_all(w->o->inside_a, 0, w->nb), began_on = on;
    for (uint32_t i = 0; i < w->na && !w->lost; i++) {
        uint32_t in, out;
        crossings_of(w, i, &in, &out);
        w->lost |= on != inside_all(w->o->inside_a, i, w->nb) || (on && in != none);
        if (on)
            add_own(w, TL_POINT_A, i);
        if (in != none) {
            if (left_over != none)
                corners_b += follow_b(w, left_over, in);
            else
                first_in = in;
            left_over = none;
            add_crossing(w, i, in, i);
            on = true;
        }
        if (out != none) {
            w->lost |= !on;
            add_crossing(w, i, out, TL_OUTLINE_CORNERS + out);
            left_over = out;
            on = false;
        }
    }
    if (left_over != none && first_in != none)
        corners_b += follow_b(w, left_over, first_in);
    for (uint32_t j = 0; j < w->nb; j++)
        inside_b += inside_all(w->o->inside_b, j, w->na);
    if (w->o->count == 0 && inside_b == w->nb) { /* B lies within A */
        for (; corners_b < w->nb; corners_b++)
            add_own(w, TL_POINT_B, corners_b);
    }
    w->lost |= on != began_on || corners_b != inside_b || (left_over != none) != (first_in != none);
}

static void find(tl_outline *o, uint32_t na, uint32_t nb)
{
    walk w = {.o = o, .na = na, .nb = nb};
    go_round(&w);
    uint32_t count = o->count;
    if (w.lost || count < 3) {
        o->count = 0;
        return;
    }
    for (uint32_t k = count; k < TL_OUTLINE_CORNERS; k++)
        o->corner[k] = o->corner[0];
    for (uint32_t k = 0; k < count; k++)
        o->middle_key[k] = tl_key_of(TL_POINT_MIDDLE, o->key[k], o->key[next_of(k, count)]);
}

/* Of corners on lines, byte i for corner i: the edges both of whose ends are on a line. */
static uint64_t along(uint64_t on, uint32_t count)
{
    return on & (on >> 8 | (on & UINT64_C(0xff)) << 8 * (count - 1));
}

/* Bit i: byte i has a bit. */
static uint32_t bytes_with_bits(uint64_t x)
{
    x |= x >> 4;
    x |= x >> 2;
    x |= x >> 1; /* bit 0 of a byte: any of its bits */
    return (uint32_t)((x & UINT64_C(0x0101010101010101)) * UINT64_C(0x0102040810204080) >> 56);
}

/* Bit i: bit i of some byte. */
static uint32_t bits_of_bytes(uint64_t x)
{
    x |= x >> 32;
    x |= x >> 16;
    x |= x >> 8;
    return (uint32_t)(x & 0xff);
}

/* Edges that lie along each other, a bit each: A's, and from bit TL_OUTLINE_CORNERS on B's. By which corners lie on
 * which lines, as with `inside_a` and `inside_b`. */
static uint32_t coinciding_edges(uint32_t na, uint32_t nb, uint64_t on_a, uint64_t on_b)
{
    uint64_t a = along(on_a, na), b = along(on_b, nb);
    return (bytes_with_bits(a) | bits_of_bytes(b)) | (bits_of_bytes(a) | bytes_with_bits(b)) << TL_OUTLINE_CORNERS;
}

const tl_outline *tl_outline_of(tl_outline *cache, uint32_t na, uint32_t nb, uint64_t inside_a, uint64_t inside_b)
{
    uint32_t sides = na << 8 | nb;
    uint64_t mix = (inside_a ^ sides) * UINT64_C(0x9e3779b97f4a7c15) ^ inside_b * UINT64_C(0xd6e8feb86659fd93);
    tl_outline *o = &cache[(mix ^ mix >> 29) * UINT64_C(0xd6e8feb86659fd93) >> 57];
    if (o->sides == sides && o->inside_a == inside_a && o->inside_b == inside_b)
        return o;
    *o = (tl_outline){.sides = sides, .inside_a = inside_a, .inside_b = inside_b};
    find(o, na, nb);
    return o;
}

/* ---------------------------------------------------------------- batches ----------------- */

#define CORNERS TL_OUTLINE_CORNERS
#define EACH_LANE(l) for (uint32_t l = 0; l < TL_LANES; l++)

tl_patch_batch *tl_batch_begin(tl_narrow_scratch *scratch, bool corners, double steep)
{
    if (!scratch->batch) {
        scratch->batch = aligned_alloc(64, (sizeof *scratch->batch + 63) / 64 * 64);
        if (!scratch->batch)
            return NULL;
        memset(scratch->batch, 0, sizeof *scratch->batch);
    }
    scratch->batch->used = 0;
    scratch->batch->rule = tl_point_rule_of(corners);
    scratch->batch->steep = steep;
    return scratch->batch;
}

static void take_face(tl_lanes3 *corner, uint32_t lane, const tl_poly *p, uint32_t face, bool backward)
{
    const uint16_t *loop = p->loop + p->start[face];
    uint32_t count = tl_poly_face_size(p, face);
    for (uint32_t i = 0; i < count; i++)
        tl_lanes3_put(&corner[i], lane, p->vertex[loop[backward ? count - 1 - i : i]]);
}

/* Corners from `count` to `most` as the first. */
static void fill_face(tl_lanes3 *corner, uint32_t lane, uint32_t count, uint32_t most)
{
    for (uint32_t i = count; i < most; i++)
        tl_lanes3_put(&corner[i], lane, tl_lanes3_get(&corner[0], lane));
}

void tl_batch_add(tl_patch_batch *batch, uint32_t lane, const tl_poly *a, uint32_t fa, const tl_poly *b, uint32_t fb,
                  double size, double reach)
{
    batch->used |= 1u << lane;
    batch->na[lane] = tl_poly_face_size(a, fa);
    batch->nb[lane] = tl_poly_face_size(b, fb);
    batch->faces[lane] = tl_key_of(0, fa, fb);
    take_face(batch->a, lane, a, fa, false);
    take_face(batch->b, lane, b, fb, true);
    tl_lanes3_put(&batch->normal_a, lane, a->plane[fa].normal);
    tl_lanes3_put(&batch->normal_b, lane, b->plane[fb].normal);
    batch->offset_a[lane] = a->plane[fa].offset;
    batch->offset_b[lane] = b->plane[fb].offset;
    batch->near[lane] = TL_MERGE * size;
    batch->least[lane] = TL_MERGE * (a->size > b->size ? a->size : b->size) * size;
    batch->reach[lane] = reach;
}

/* The plane of a patch, in lanes. */
typedef struct frames {
    tl_lanes3 o, t1, t2, n;
    tl_batch1 secant, rest, rest_x, rest_y;
} frames;

/* What a corner of the polygon is placed by: see tl_outline_corner. */
typedef struct corner_source {
    tl_batch1 px, py, qx, qy, h, g;
} corner_source;

/* What is computed on the way. Corners of A in the plane of the patch come first, then those of B. Heights of corner i
 * of A over line j of B are in row CORNERS j + i. */
typedef struct work {
    _Alignas(64) frames frame;
    tl_batch1 x[2 * CORNERS], y[2 * CORNERS]; /* of the faces */
    tl_batch1 height[CORNERS * CORNERS + 2];
    uint64_t inside_a[TL_LANES], inside_b[TL_LANES], on_a[TL_LANES], on_b[TL_LANES];
    /* of the polygon: corners, the first once more after the last; edges from corner k - 1 to k in row k */
    tl_batch1 count, px[CORNERS + 1], py[CORNERS + 1], fan[CORNERS + 1];
    tl_batch1 cx, cy, area;  /* centroid; area in the plane */
    tl_batch1 of_b[CORNERS]; /* share by which the edge that leaves corner k is B's */
    corner_source source[CORNERS];
    uint32_t na, nb, corners; /* most of any lane */
} work;

/* Number by number: copies of structs would keep loops from becoming vectors. */
TL_INLINE tl_frame2 frame_at(const frames *f, uint32_t l)
{
    tl_frame2 out;
    out.o.x = f->o.x[l], out.o.y = f->o.y[l], out.o.z = f->o.z[l];
    out.n.x = f->n.x[l], out.n.y = f->n.y[l], out.n.z = f->n.z[l];
    out.t1.x = f->t1.x[l], out.t1.y = f->t1.y[l], out.t1.z = f->t1.z[l];
    out.t2.x = f->t2.x[l], out.t2.y = f->t2.y[l], out.t2.z = f->t2.z[l];
    out.secant = f->secant[l];
    out.rest = f->rest[l], out.rest_x = f->rest_x[l], out.rest_y = f->rest_y[l];
    return out;
}

TL_INLINE tl_plane plane_at(const tl_lanes3 *normal, const tl_batch1 offset, uint32_t l)
{
    tl_plane out;
    out.normal.x = normal->x[l], out.normal.y = normal->y[l], out.normal.z = normal->z[l];
    out.offset = offset[l];
    return out;
}

/* Turn and shift: tl_pair_view_of in lanes. */
TL_INLINE void view(tl_patch_batch *b)
{
    double *shift[3] = {b->shift.x, b->shift.y, b->shift.z};
    for (int i = 0; i < 3; i++) {
        const double *restrict r0 = b->r_a.m[0][i], *restrict r1 = b->r_a.m[1][i];
        const double *restrict r2 = b->r_a.m[2][i];
        double *restrict way = shift[i];
        for (int j = 0; j < 3; j++) {
            double *restrict turn = b->turn.m[i][j];
#pragma omp simd
            EACH_LANE(l)
            turn[l] = r0[l] * b->r_b.m[0][j][l] + r1[l] * b->r_b.m[1][j][l] + r2[l] * b->r_b.m[2][j][l];
        }
#pragma omp simd
        EACH_LANE(l)
        way[l] = r0[l] * b->apart.x[l] + r1[l] * b->apart.y[l] + r2[l] * b->apart.z[l];
    }
}

/* Planes of the patches; lanes too steep are not laid. */
TL_INLINE void lay_frames(tl_patch_batch *b, work *w)
{
    double steep = b->steep;
#pragma omp simd
    EACH_LANE(l)
    {
        tl_mat3 turn = tl_lanes9_get(&b->turn, l);
        tl_plane own = plane_at(&b->normal_b, b->offset_b, l);
        tl_plane placed = tl_plane_placed(&turn, tl_lanes3_get(&b->shift, l), own);
        tl_vec3 na = tl_lanes3_get(&b->normal_a, l);
        tl_frame2 f = tl_frame2_of(na, placed.normal, tl_lanes3_get(&b->a[0], l));
        tl_lanes3_put(&w->frame.o, l, f.o);
        tl_lanes3_put(&w->frame.n, l, f.n);
        tl_lanes3_put(&w->frame.t1, l, f.t1);
        tl_lanes3_put(&w->frame.t2, l, f.t2);
        w->frame.secant[l] = f.secant;
        tl_lanes3_put(&b->placed_b, l, placed.normal);
        b->placed_offset[l] = placed.offset;
        b->laid[l] = (uint64_t) !(tl_tilt2(na, placed.normal) > steep);
    }
}

/* Brings corner i of both faces into the plane of the patch. */
TL_INLINE void project_a(tl_patch_batch *b, work *w, uint32_t i)
{
#pragma omp simd
    EACH_LANE(l)
    {
        tl_frame2 f = frame_at(&w->frame, l);
        tl_vec3 v = tl_lanes3_get(&b->a[i], l);
        tl_point2 at = tl_frame2_project(&f, v);
        w->x[i][l] = at.x;
        w->y[i][l] = at.y;
    }
}

TL_INLINE void project_b(tl_patch_batch *b, work *w, uint32_t j)
{
#pragma omp simd
    EACH_LANE(l)
    {
        tl_frame2 f = frame_at(&w->frame, l);
        tl_mat3 turn = tl_lanes9_get(&b->turn, l);
        tl_vec3 v = tl_v3_add(tl_m3_mul(&turn, tl_lanes3_get(&b->b[j], l)), tl_lanes3_get(&b->shift, l));
        tl_point2 at = tl_frame2_project(&f, v);
        w->x[CORNERS + j][l] = at.x;
        w->y[CORNERS + j][l] = at.y;
    }
}

/* Notes which corners of a face, from row `first` on, lie inside or on the line from row `from` to row `to`. It does
 * so in bit `bit` of each corner's byte. Those on the line lie inside unless it is `strict`. */
TL_INLINE void note_inside(const tl_patch_batch *b, work *w, uint32_t first, uint32_t count, uint32_t from, uint32_t to,
                           uint32_t bit, bool strict)
{
    uint64_t *restrict inside = strict ? w->inside_b : w->inside_a;
    uint64_t *restrict on_line = strict ? w->on_b : w->on_a;
    tl_batch1 on, dx, dy;
#pragma omp simd
    EACH_LANE(l)
    {
        dx[l] = w->x[to][l] - w->x[from][l];
        dy[l] = w->y[to][l] - w->y[from][l];
        on[l] = b->near[l] * b->near[l] * (dx[l] * dx[l] + dy[l] * dy[l]);
    }
    for (uint32_t i = 0; i < count; i++) {
        const double *restrict x = w->x[first + i], *restrict y = w->y[first + i];
        const double *restrict ox = w->x[from], *restrict oy = w->y[from];
        double *restrict height = w->height[CORNERS * bit + i];
        uint64_t one = UINT64_C(1) << (8 * i + bit);
#pragma omp simd
        EACH_LANE(l)
        {
            double h = dx[l] * (y[l] - oy[l]) - dy[l] * (x[l] - ox[l]);
            if (!strict)
                height[l] = h;
            double square = h * fabs(h); /* roots cost more */
            inside[l] |= one & -(uint64_t)(strict ? square > on[l] : square >= -on[l]);
            on_line[l] |= one & -(uint64_t)(fabs(square) <= on[l]);
        }
    }
}

/* Which corners lie inside which lines. Lines beyond a face's last have no length; rows beyond the last corner
 * of any lane are not looked at. */
TL_VECTORIZED static void find_inside(tl_patch_batch *b, work *w)
{
    view(b);
    lay_frames(b, w);
#pragma omp simd
    EACH_LANE(l)
    {
        w->height[TL_HEIGHT_OWN][l] = 0;
        w->height[TL_HEIGHT_OWN + 1][l] = -1;
        w->inside_a[l] = w->inside_b[l] = w->on_a[l] = w->on_b[l] = 0;
    }
    for (uint32_t i = 0; i < w->na; i++)
        project_a(b, w, i);
    for (uint32_t j = 0; j < w->nb; j++)
        project_b(b, w, j);
    for (uint32_t j = 0; j < w->nb; j++)
        note_inside(b, w, 0, w->na, CORNERS + j, CORNERS + (j + 1 < w->nb ? j + 1 : 0), j, false);
    for (uint32_t i = 0; i < w->na; i++)
        note_inside(b, w, CORNERS, w->nb, i, i + 1 < w->na ? i + 1 : 0, i, true);
}

/* Notes which edges of the outline of lane l are B's; edges beyond its last have no length. */
static void note_edges(const tl_patch_batch *b, work *w, uint32_t l, uint64_t on_a, uint64_t on_b)
{
    const tl_outline *o = &b->outline[l];
    const uint32_t coincide = coinciding_edges(b->na[l], b->nb[l], on_a, on_b);
    for (uint32_t k = 0; k < o->count; k++)
        w->of_b[k][l] = tl_edge_ride(o->edge[k] >= CORNERS, coincide >> o->edge[k] & 1);
}

/* The outlines; lanes without one are not laid. */
static void find_outlines(tl_patch_batch *b, work *w)
{
    static const uint64_t each = UINT64_C(0x0101010101010101);
    w->corners = 0;
    const tl_outline *some = NULL;
    for (uint32_t l = 0; l < TL_LANES; l++) {
        w->count[l] = 0;
        for (uint32_t k = 0; k < CORNERS; k++)
            w->of_b[k][l] = 0;
        if (!(b->used >> l & 1))
            continue;
        uint32_t na = b->na[l], nb = b->nb[l];
        uint64_t lines_a = each * ((1u << na) - 1), lines_b = each * ((1u << nb) - 1);
        uint64_t of_a = lines_b & ~UINT64_C(0) >> (64 - 8 * na);
        uint64_t of_b = lines_a & ~UINT64_C(0) >> (64 - 8 * nb);
        uint64_t inside_a = w->inside_a[l] & of_a, inside_b = w->inside_b[l] & of_b;
        const tl_outline *o = tl_outline_of(b->found, na, nb, inside_a, inside_b);
        b->outline[l] = *o; /* another lane's may take its place */
        note_edges(b, w, l, w->on_a[l] & of_a, w->on_b[l] & of_b);
        some = &b->outline[l];
        b->laid[l] &= o->count > 0;
        w->count[l] = o->count;
        w->corners = o->count > w->corners ? o->count : w->corners;
    }
    for (uint32_t l = 0; l < TL_LANES; l++)
        if (!(b->used >> l & 1))
            b->outline[l] = *some;
    b->alike = true;
    for (uint32_t l = 1; l < TL_LANES; l++)
        b->alike = b->alike && b->outline[l].count == b->outline[0].count &&
                   memcmp(b->outline[l].corner, b->outline[0].corner, sizeof b->outline[0].corner) == 0;
}

/* Looks up what corner k is placed by where it is of the same features in all lanes. */
static void find_row(const tl_outline_corner *c, work *w, uint32_t k)
{
    corner_source *e = &w->source[k];
    memcpy(e->px, w->x[c->from], sizeof e->px);
    memcpy(e->py, w->y[c->from], sizeof e->py);
    memcpy(e->qx, w->x[c->to], sizeof e->qx);
    memcpy(e->qy, w->y[c->to], sizeof e->qy);
    memcpy(e->h, w->height[c->over], sizeof e->h);
    memcpy(e->g, w->height[c->under], sizeof e->g);
}

/* Looks up what the corners are placed by. */
static void find_ends(const tl_patch_batch *b, work *w)
{
    for (uint32_t k = 0; k < w->corners && b->alike; k++)
        find_row(&b->outline[0].corner[k], w, k);
    for (uint32_t l = 0; l < TL_LANES && !b->alike; l++)
        for (uint32_t k = 0; k < w->corners; k++) {
            const tl_outline_corner *c = &b->outline[l].corner[k];
            corner_source *e = &w->source[k];
            e->px[l] = w->x[c->from][l];
            e->py[l] = w->y[c->from][l];
            e->qx[l] = w->x[c->to][l];
            e->qy[l] = w->y[c->to][l];
            e->h[l] = w->height[c->over][l];
            e->g[l] = w->height[c->under][l];
        }
}

/* Places corner k of the polygons. */
TL_INLINE void place(work *w, uint32_t k)
{
    const corner_source *e = &w->source[k];
#pragma omp simd
    EACH_LANE(l)
    {
        tl_point2 p = {e->px[l], e->py[l]}, q = {e->qx[l], e->qy[l]};
        tl_point2 at = tl_part_way(p, q, e->h[l], e->g[l]);
        w->px[k][l] = at.x;
        w->py[k][l] = at.y;
    }
}

/* Whether all corners are full, and far enough from each other; areas and centroids. */
TL_INLINE void weigh(tl_patch_batch *b, work *w)
{
    tl_batch1 ux = {0}, uy = {0}, sx = {0}, sy = {0}; /* the edge before; sums */
#pragma omp simd
    EACH_LANE(l)
    w->area[l] = 0;
    for (uint32_t k = 0; k < w->corners; k++) {
        double number = k;
#pragma omp simd
        EACH_LANE(l)
        {
            double x = w->px[k + 1][l] - w->px[k][l], y = w->py[k + 1][l] - w->py[k][l];
            ux[l] = number + 1 == w->count[l] ? x : ux[l];
            uy[l] = number + 1 == w->count[l] ? y : uy[l];
        }
    }
    for (uint32_t k = 0; k < w->corners; k++) {
        double number = k;
#pragma omp simd
        EACH_LANE(l)
        {
            double x = w->px[k + 1][l] - w->px[k][l], y = w->py[k + 1][l] - w->py[k][l];
            double length2 = x * x + y * y, uv = (ux[l] * ux[l] + uy[l] * uy[l]) * length2;
            double turn = ux[l] * y - uy[l] * x, ahead = ux[l] * x + uy[l] * y;
            bool full = (turn > 0) & ((ahead <= 0) | (turn * turn >= TL_CORNER * TL_CORNER * uv));
            full = full | (b->rule.middle > 0);
            bool clear = full & (length2 > b->near[l] * b->near[l]);
            b->laid[l] &= (uint64_t)(clear | (number >= w->count[l]));
            ux[l] = x;
            uy[l] = y;
        }
#pragma omp simd
        EACH_LANE(l)
        {
            tl_point2 o = {w->px[0][l], w->py[0][l]}, p = {w->px[k][l], w->py[k][l]};
            tl_point2 q = {w->px[k + 1][l], w->py[k + 1][l]};
            double a = 0.5 * tl_cross2(o, p, q);
            w->area[l] += a;
            sx[l] += a * ((p.x - o.x) + (q.x - o.x));
            sy[l] += a * ((p.y - o.y) + (q.y - o.y));
        }
    }
#pragma omp simd
    EACH_LANE(l)
    {
        double share = 1 / (3 * w->area[l]);
        w->cx[l] = w->px[0][l] + sx[l] * share;
        w->cy[l] = w->py[0][l] + sy[l] * share;
        b->laid[l] &= (uint64_t)(w->area[l] > b->least[l]);
    }
}

/* Fan triangles about the centroids, which all must have an area, and the share of it over edges of B. */
TL_INLINE void lay_fans(tl_patch_batch *b, work *w)
{
    tl_batch1 whole, of_b;
#pragma omp simd
    EACH_LANE(l)
    w->fan[0][l] = whole[l] = of_b[l] = 0;
    for (uint32_t k = 0; k < w->corners; k++) {
        double number = k;
#pragma omp simd
        EACH_LANE(l)
        {
            tl_point2 o = {w->cx[l], w->cy[l]}, p = {w->px[k][l], w->py[k][l]};
            tl_point2 q = {w->px[k + 1][l], w->py[k + 1][l]};
            double fan = 0.5 * tl_cross2(o, p, q);
            w->fan[k + 1][l] = fan;
            whole[l] += fan;
            of_b[l] += fan * w->of_b[k][l];
            w->fan[0][l] = number + 1 == w->count[l] ? fan : w->fan[0][l];
            b->laid[l] &= (uint64_t)((fan > 0) | (number >= w->count[l]));
        }
    }
#pragma omp simd
    EACH_LANE(l)
    b->ride[l] = of_b[l] / whole[l];
}

/* Moves the planes into the middle between the faces; patches with every gap beyond reach are not laid. */
TL_INLINE void move_between(tl_patch_batch *b, work *w)
{
    tl_batch1 least, at, gx, gy;
#pragma omp simd
    EACH_LANE(l)
    {
        tl_frame2 f = frame_at(&w->frame, l);
        tl_plane of_a = plane_at(&b->normal_a, b->offset_a, l);
        tl_plane of_b = plane_at(&b->placed_b, b->placed_offset, l);
        tl_point2 centroid = {w->cx[l], w->cy[l]};
        tl_frame2_move(&f, of_a, of_b, centroid);
        tl_patch_gap gap = tl_patch_gap_of(&f, of_b);
        w->frame.o.x[l] = f.o.x;
        w->frame.o.y[l] = f.o.y;
        w->frame.o.z[l] = f.o.z;
        w->frame.rest[l] = f.rest;
        w->frame.rest_x[l] = f.rest_x;
        w->frame.rest_y[l] = f.rest_y;
        least[l] = INFINITY;
        at[l] = gap.at;
        gx[l] = gap.x;
        gy[l] = gap.y;
    }
    for (uint32_t k = 0; k < w->corners; k++) {
#pragma omp simd
        EACH_LANE(l)
        {
            double gap = at[l] + w->px[k][l] * gx[l] + w->py[k][l] * gy[l];
            least[l] = gap < least[l] ? gap : least[l];
        }
    }
#pragma omp simd
    EACH_LANE(l)
    b->laid[l] &= (uint64_t) !(least[l] > b->reach[l]);
}

/* Puts a point at x, y of the planes. */
TL_INLINE void put_point(tl_batch_point *out, const work *w, const double *x, const double *y)
{
#pragma omp simd
    EACH_LANE(l)
    {
        tl_frame2 f = frame_at(&w->frame, l);
        tl_point2 at = {x[l], y[l]};
        tl_lanes3_put(&out->p, l, tl_frame2_point(&f, at));
    }
}

/* The points of corner k and of the middle of the edge that leaves it. */
TL_INLINE void put_edge(tl_patch_batch *b, const work *w, uint32_t k)
{
    tl_batch_point *middle = &b->middles[k], *corner = &b->corners[k];
    double of_middle = b->rule.middle, of_corner = b->rule.corner, reach = b->rule.reach;
    double out = b->rule.out;
    tl_batch1 mx, my, x, y;
#pragma omp simd
    EACH_LANE(l)
    {
        mx[l] = tl_drawn_in(out, w->cx[l], 0.5 * (w->px[k][l] + w->px[k + 1][l]));
        my[l] = tl_drawn_in(out, w->cy[l], 0.5 * (w->py[k][l] + w->py[k + 1][l]));
        x[l] = tl_drawn_in(reach, w->cx[l], w->px[k][l]);
        y[l] = tl_drawn_in(reach, w->cy[l], w->py[k][l]);
        middle->area[l] = w->frame.secant[l] * (of_middle * w->fan[k + 1][l]);
        corner->area[l] = w->frame.secant[l] * (of_corner * (w->fan[k][l] + w->fan[k + 1][l]));
    }
    put_point(middle, w, mx, my);
    put_point(corner, w, x, y);
}

TL_INLINE void put_centroid(tl_patch_batch *b, const work *w)
{
    tl_batch_point *out = &b->centroid;
    double share = b->rule.centroid;
#pragma omp simd
    EACH_LANE(l)
    {
        out->area[l] = w->frame.secant[l] * (share * w->area[l]);
        b->area[l] = w->frame.secant[l] * w->area[l];
    }
    put_point(out, w, w->cx, w->cy);
}

/* From outlines to points. */
TL_VECTORIZED static void lay(tl_patch_batch *b, work *w)
{
    for (uint32_t k = 0; k < w->corners; k++)
        place(w, k);
#pragma omp simd
    EACH_LANE(l)
    {
        w->px[w->corners][l] = w->px[0][l];
        w->py[w->corners][l] = w->py[0][l];
    }
    weigh(b, w);
    lay_fans(b, w);
    move_between(b, w);
    put_centroid(b, w);
    for (uint32_t k = 0; k < w->corners; k++)
        put_edge(b, w, k);
}

void tl_batch_lay(tl_patch_batch *batch)
{
    _Alignas(64) work w;
    w.na = w.nb = 0;
    for (uint32_t l = 0; l < TL_LANES; l++) {
        bool used = batch->used >> l & 1;
        w.na = used && batch->na[l] > w.na ? batch->na[l] : w.na;
        w.nb = used && batch->nb[l] > w.nb ? batch->nb[l] : w.nb;
    }
    for (uint32_t l = 0; l < TL_LANES; l++) {
        fill_face(batch->a, l, batch->na[l], w.na);
        fill_face(batch->b, l, batch->nb[l], w.nb);
    }
    find_inside(batch, &w);
    find_outlines(batch, &w);
    find_ends(batch, &w);
    lay(batch, &w);
}
