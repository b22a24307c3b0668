/* field.c - integrals of the pressure field of two blocks: field.h says what it is.
 *
 * On the part of S that belongs to the faces a and b, d_h >= d_a for all others h, and d_a >= 0: a polygon in a plane, bounded
 * by a line for each other face. Eight polygons are worked on side by side (field_lanes.c), of one pair or of several.
 *
 * K consists of cells, one for each face, where that face is the nearest. The fields -n d^2 / 2 and -n d have the
 * divergences d and 1 in the cell of a face of normal n, and vanish on the face. So G and V are sums over the polygons
 * between two cells, G = sum |n_i - n_j| / 2 int d^2 dS and V = sum |n_i - n_j| int d dS, and over the borders. No term
 * between cells is negative.
 *
 * Mostly a corner, an edge or a face is pressed in, and all planes of a block that bound K meet in one point x_0, its apex.
 * There d is homogeneous about x_0 in the cells of this block: (x - x_0) d has the divergence 4 d, x - x_0 has 3, and on the
 * faces both are tangents. So S alone gives the block's share in G, int d (x - x_0) . n dS / 4, and the polygons between its
 * cells are not needed.
 *
 * Without borders a face has a cell only if it bounds K: from any point of its cell the way along its normal stays in K to the
 * face. So the faces that bounded K at another time are enough for all polygons, while they still enclose K and nothing else:
 * while no corner of what they enclose lies beyond another face. Corners on faces of both blocks lie on S, where d = 0, and are
 * looked at here; the others are corners of one block (press.c). Otherwise the faces that bound K are found again, as
 * those of which the others leave some. */
#include "narrow/field.h"

#include "narrow/field_lanes.h"

#include <math.h>
#include <stdlib.h>
#include <talus/vmath.h>

#define LANES TL_LANES

/* Roundings of the largest offset within which two faces that look the same way are one plane. */
#define ONE_PLANE (16 * 2.220446049250313e-16)
/* Slope of d within a polygon's plane from which integrals of d are taken by its gradient. */
#define STEEP 0.1
/* The same from which two faces look so much the same way that what is between them bears nothing: no part of the stiffness. */
#define SAME_WAY 0.5
static uint32_t real_faces(const tl_field_faces *f)
{
    return f->a + f->b;
}

static uint32_t all_faces(const tl_field_faces *f)
{
    return f->a + f->b + f->border_a + f->border_b;
}

static tl_vec3 normal_of(const tl_field_faces *f, uint32_t i)
{
    return tl_v3(f->n[0][i], f->n[1][i], f->n[2][i]);
}

static tl_vec3 lane_vector(const double v[3][LANES], int lane)
{
    return tl_v3(v[0][lane], v[1][lane], v[2][lane]);
}

/* ---------------------------------------------------------------- work ------------------- */

/* A point in which the planes of a block meet, and directions that hold it in them, at right angles to each other. */
typedef struct apex {
    tl_vec3 x, held[3];
    double per[3]; /* 1 / |held|^2 */
    int count;
    bool known;
} apex;

/* Some of the planes of a pair. */
typedef struct list {
    const uint16_t *number;
    uint32_t count;
} list;

/* The integrals of one pair. */
typedef struct pair {
    const tl_field_faces *faces;
    tl_field_sums *sums;
    uint16_t *number;
    list planes, others;       /* planes that bound polygons; faces that are to bound none */
    double one_plane;          /* offset within which planes are one */
    bool beyond;               /* some corner lies beyond one of the others */
    uint64_t found;            /* faces that bound K, when its own faces are looked at */
    apex apex[2];              /* of A and of B */
    double by_force, by_swept; /* of S: int d x . n dS, int x . n dS */
} pair;

/* Planes of the polygons in the lanes: the k-th of each is in row k. */
typedef struct rows {
    tl_field_plane *row;
    uint32_t count[LANES], most;
} rows;

/* Polygons, eight at a time. */
typedef struct work {
    tl_field_line *line;
    bool flat; /* the polygons are K's own faces */
    int filled;
    tl_field_lanes lanes;
    rows planes, others;
    pair *of[LANES];
    uint32_t face[LANES], with[LANES]; /* the polygon's two planes */
} work;

static bool make_room(tl_field_room *room, uint32_t lines, uint32_t numbers)
{
    if (lines <= room->lines && numbers <= room->numbers)
        return true;
    tl_field_free(room);
    room->line = aligned_alloc(TL_ALIGN, 2u * lines * sizeof *room->line);
    room->plane = aligned_alloc(TL_ALIGN, 4u * lines * sizeof *room->plane);
    room->number = malloc(2u * numbers * sizeof *room->number);
    if (!room->line || !room->plane || !room->number)
        return false;
    room->lines = 2 * lines;
    room->numbers = 2 * numbers;
    return true;
}

void tl_field_free(tl_field_room *room)
{
    free(room->line);
    free(room->plane);
    free(room->number);
    *room = (tl_field_room){0};
}

/* Takes the faces of a mask, or all, and the borders for the planes that bound polygons. */
static void choose(pair *p, const uint64_t *mask)
{
    const tl_field_faces *f = p->faces;
    uint32_t count = all_faces(f), chosen = 0, left = count;
    double largest = 0;
    for (uint32_t i = 0; i < count; i++) {
        largest = fmax(largest, fabs(f->c[i]));
        if (!mask || *mask >> i & 1)
            p->number[chosen++] = (uint16_t)i;
        else
            p->number[--left] = (uint16_t)i;
    }
    p->planes = (list){p->number, chosen};
    p->others = (list){p->number + left, count - left};
    p->one_plane = ONE_PLANE * largest;
    p->beyond = false;
}

/* ---------------------------------------------------------------- apex ------------------- */

/* What of a direction does not leave the planes that hold an apex. */
static tl_vec3 within(const apex *p, tl_vec3 way)
{
    for (int i = 0; i < p->count; i++)
        way = tl_v3_madd(way, -p->per[i] * tl_v3_dot(p->held[i], way), p->held[i]);
    return way;
}

/* Finds a point in which the chosen faces of a block meet. From the origin, it goes on to one plane after the other, along
 * those before. */
static apex find_apex(const pair *of, uint32_t begin, uint32_t end)
{
    const tl_field_faces *f = of->faces;
    apex p = {.known = true};
    for (uint32_t k = begin; k < end && p.count < 3; k++) {
        tl_vec3 n = normal_of(f, of->number[k]), way = within(&p, n);
        double sine2 = tl_v3_norm2(way);
        if (sine2 > STEEP * STEEP) {
            p.held[p.count] = way;
            p.per[p.count] = 1 / sine2;
            double off = f->c[of->number[k]] - tl_v3_dot(n, p.x);
            p.x = tl_v3_madd(p.x, off * p.per[p.count++], way);
        }
    }
    for (uint32_t k = begin; k < end && p.known; k++) {
        tl_vec3 n = normal_of(f, of->number[k]);
        p.known = fabs(f->c[of->number[k]] - tl_v3_dot(n, p.x)) <= of->one_plane &&
                  (p.count == 3 || tl_v3_norm2(within(&p, n)) < TL_FIELD_ALIKE * TL_FIELD_ALIKE);
    }
    return p;
}

/* Adds energy and volume of the cells of a block with an apex. Of the points that it may be, that nearest the centre of
 * pressure is taken: roundings of the force count by the way from there. */
static void add_share(pair *of, const apex *p, double out)
{
    tl_field_sums *sums = of->sums;
    if (!p->known || !(sums->pressure > 0))
        return;
    tl_vec3 centre = tl_v3_scale(1 / sums->pressure, sums->pressed);
    tl_vec3 x = tl_v3_add(p->x, within(p, tl_v3_sub(centre, p->x)));
    sums->energy += 0.25 * out * (tl_v3_dot(x, sums->force) - of->by_force);
    sums->volume += (1.0 / 3) * out * (tl_v3_dot(x, sums->swept) - of->by_swept);
}

/* ---------------------------------------------------------------- sums ------------------- */

/* Integrals of 1, d, d^2, d x_t and d x_s over a lane's polygon, times its share. */
typedef struct depths {
    double area, d, dd, dt, ds;
} depths;

static depths depths_of(const tl_field_lanes *p, int l)
{
    double d0 = p->d0[l], t = p->dt[l], s = p->ds[l], part = p->share[l];
    depths o = {.area = part * p->area[l],
                .d = part * (d0 * p->area[l] + t * p->it[l] + s * p->is[l]),
                .dt = part * (d0 * p->it[l] + t * p->itt[l] + s * p->its[l]),
                .ds = part * (d0 * p->is[l] + t * p->its[l] + s * p->iss[l])};
    double slope2 = t * t + s * s;
    bool steep = slope2 > STEEP * STEEP;
    o.dd = steep ? part * p->d2[l] / slope2 : d0 * o.d + t * o.dt + s * o.ds;
    o.d = steep ? part * p->d1[l] / slope2 : o.d;
    return o;
}

/* The origin times an integral + its first moments about it: int x dS, or int d x dS. */
static tl_vec3 place_of(const tl_field_lanes *p, int l, double along, double it, double is)
{
    tl_vec3 x = tl_v3_scale(p->h[l] * along, lane_vector(p->n, l));
    x = tl_v3_madd(x, p->origin_t[l] * along + it, lane_vector(p->t, l));
    return tl_v3_madd(x, p->origin_s[l] * along + is, lane_vector(p->s, l));
}

/* Adds int d n dS of a polygon, and int d x cross n dS. */
static void add_force(const tl_field_lanes *p, int l, const depths *o, double sign, tl_vec3 *force,
                      tl_vec3 *moment)
{
    tl_vec3 n = lane_vector(p->n, l), t = lane_vector(p->t, l), s = lane_vector(p->s, l);
    double ot = p->origin_t[l], os = p->origin_s[l];
    *force = tl_v3_madd(*force, sign * o->d, n);
    /* t cross n = -s, s cross n = t */
    *moment = tl_v3_madd(*moment, sign * (o->ds + os * o->d), t);
    *moment = tl_v3_madd(*moment, -sign * (o->dt + ot * o->d), s);
}

/* A polygon's part in the gradients of G and V. */
static void add_gradient(work *w, int l, const depths *o, double sign)
{
    const tl_field_lanes *p = &w->lanes;
    tl_field_sums *sums = w->of[l]->sums;
    tl_vec3 n = lane_vector(p->n, l), t = lane_vector(p->t, l), s = lane_vector(p->s, l);
    double ot = p->origin_t[l], os = p->origin_s[l], part = sign * p->share[l];
    add_force(p, l, o, sign, &sums->force, &sums->moment);
    sums->swept = tl_v3_madd(sums->swept, sign * o->area, n);
    sums->swept_moment = tl_v3_madd(sums->swept_moment, part * p->is[l] + sign * os * o->area, t);
    sums->swept_moment = tl_v3_madd(sums->swept_moment, -part * p->it[l] - sign * ot * o->area, s);
}

/* Adds what a polygon of S gives of the energy and volume of the cells on its sides, unless the block has an apex. */
static void add_sides(work *w, int l, const depths *o)
{
    const tl_vec3 n = lane_vector(w->lanes.n, l);
    pair *of = w->of[l];
    of->by_force += w->lanes.h[l] * o->d;
    of->by_swept += w->lanes.h[l] * o->area;
    const uint32_t face[] = {w->face[l], w->with[l]};
    for (int of_b = 0; of_b < 2; of_b++) {
        if (of->apex[of_b].known)
            continue;
        double slope = (of_b ? -1 : 1) * tl_v3_dot(n, normal_of(of->faces, face[of_b]));
        of->sums->energy += 0.5 * slope * o->dd;
        of->sums->volume += slope * o->d;
    }
}

/* A polygon of S. */
static void add_surface(work *w, int l, const depths *o)
{
    const tl_field_lanes *p = &w->lanes;
    tl_field_sums *sums = w->of[l]->sums;
    double part = p->share[l], ot = p->origin_t[l], os = p->origin_s[l];
    add_sides(w, l, o);
    add_gradient(w, l, o, 1);
    sums->area = tl_v3_madd(sums->area, o->area, lane_vector(p->n, l));
    sums->pressure += o->d;
    sums->pressed = tl_v3_add(sums->pressed, place_of(p, l, o->d, o->dt, o->ds));
    sums->extent += o->area;
    sums->first = tl_v3_add(sums->first, place_of(p, l, o->area, part * p->it[l], part * p->is[l]));
    sums->second += (p->h[l] * p->h[l] + ot * ot + os * os) * o->area +
                    part * (p->itt[l] + p->iss[l] + 2 * (ot * p->it[l] + os * p->is[l]));
    sums->stiffness += 2 / fmax(w->lanes.length[l], SAME_WAY) * o->area;
    if (p->deepest[l] > sums->deepest) {
        sums->deepest = p->deepest[l];
        sums->deepest_at = place_of(p, l, 1, p->deepest_t[l], p->deepest_s[l]);
    }
}

/* What a polygon on a border adds. B's motion shifts K's border at a seam of A where A is deeper than B, and the other way
 * round. */
static void add_border(work *w, int l, const depths *o)
{
    const tl_field_faces *f = w->of[l]->faces;
    tl_field_sums *sums = w->of[l]->sums;
    bool face_of_b = w->face[l] >= f->a, border_of_b = w->with[l] >= real_faces(f) + f->border_a;
    uint32_t end = border_of_b ? all_faces(f) : real_faces(f) + f->border_a;
    double out = border_of_b ? -1 : 1;
    if (face_of_b != border_of_b)
        add_gradient(w, l, o, out);
    if (w->with[l] + (border_of_b ? f->seam_b : f->seam_a) >= end)
        add_force(&w->lanes, l, o, -out, &sums->through, &sums->through_moment);
}

static void take(work *w, int l)
{
    const tl_field_faces *f = w->of[l]->faces;
    const depths o = depths_of(&w->lanes, l);
    if (w->face[l] < f->a && w->with[l] >= f->a && w->with[l] < real_faces(f)) {
        add_surface(w, l, &o);
        return;
    }
    w->of[l]->sums->volume += w->lanes.length[l] * o.d;
    w->of[l]->sums->energy += 0.5 * w->lanes.length[l] * o.dd;
    if (w->with[l] >= real_faces(f))
        add_border(w, l, &o);
}

/* ---------------------------------------------------------------- polygons --------------- */

/* Puts some of a pair's planes into a lane, but for two. */
static void put_planes(rows *r, int lane, const tl_field_faces *f, const list *from, uint32_t one,
                       uint32_t other)
{
    tl_field_plane *to = r->row;
    for (const uint16_t *i = from->number; i < from->number + from->count; i++) {
        if (*i == one || *i == other)
            continue;
        for (int k = 0; k < 3; k++)
            to->n[k][lane] = f->n[k][*i];
        to->c[lane] = f->c[*i];
        to->face[lane] = *i < real_faces(f);
        to++;
    }
    r->count[lane] = (uint32_t)(to - r->row);
    r->most = r->count[lane] > r->most ? r->count[lane] : r->most;
}

/* Fills up the lanes that have fewer planes than others, or no polygon. */
static void fill_up(rows *r, int filled)
{
    for (int lane = 0; lane < (int)LANES; lane++)
        for (uint32_t k = lane < filled ? r->count[lane] : 0; k < r->most; k++) {
            r->row[k].n[0][lane] = r->row[k].n[1][lane] = r->row[k].n[2][lane] = 0;
            r->row[k].c[lane] = TL_FIELD_FAR;
            r->row[k].face[lane] = 0;
        }
}

/* Integrates the polygons in the lanes. */
static void flush(work *w)
{
    tl_field_lanes *p = &w->lanes;
    if (!w->filled)
        return;
    for (int lane = w->filled; lane < (int)LANES; lane++)
        p->share[lane] = 0; /* what is left there is of earlier ones */
    fill_up(&w->planes, w->filled);
    fill_up(&w->others, w->filled);
    size_t lines = tl_field_draw(p, w->planes.row, w->planes.most, w->flat, w->line);
    uint32_t beyond = tl_field_corners_beyond(p, w->others.row, w->others.most, w->line);
    tl_field_sum_lines(p, w->line, lines);
    for (int lane = 0; lane < w->filled; lane++) {
        pair *of = w->of[lane];
        of->beyond = of->beyond || beyond >> lane & 1;
        if (!(p->area[lane] > 0))
            continue;
        if (w->flat)
            of->found |= UINT64_C(1) << w->face[lane];
        else
            take(w, lane);
        of->beyond = of->beyond || p->open[lane] > 0;
    }
    w->filled = 0;
    w->planes.most = w->others.most = 0;
}

/* Puts a polygon into the lanes: in a plane, of the depth of a face, bounded by neither that nor another plane. */
static void put(work *w, pair *of, tl_vec3 n, double h, uint32_t face, uint32_t with, bool between,
                double length)
{
    tl_field_lanes *p = &w->lanes;
    int l = w->filled++;
    tl_vec3 m = normal_of(of->faces, face);
    p->n[0][l] = n.x;
    p->n[1][l] = n.y;
    p->n[2][l] = n.z;
    p->h[l] = h;
    p->face_n[0][l] = m.x;
    p->face_n[1][l] = m.y;
    p->face_n[2][l] = m.z;
    p->face_c[l] = of->faces->c[face];
    p->one_plane[l] = of->one_plane;
    p->share[l] = 1;
    w->of[l] = of;
    w->face[l] = face;
    w->with[l] = with;
    p->between[l] = between;
    p->length[l] = length;
    put_planes(&w->planes, l, of->faces, &of->planes, face, with);
    put_planes(&w->others, l, of->faces, &of->others, face, with);
    if (w->filled == (int)LANES)
        flush(w);
}

/* The surface between the cells of two faces, where both are the nearest. */
static void put_between(work *w, pair *of, uint32_t a, uint32_t b)
{
    const tl_field_faces *f = of->faces;
    tl_vec3 m = tl_v3_sub(normal_of(f, a), normal_of(f, b));
    put(w, of, m, f->c[a] - f->c[b], a, b, true, 0);
}

/* The polygons between the cells of the chosen faces, of which all may be known to bound K, and at borders. */
static void put_pair(work *w, pair *of, bool only_bounding)
{
    const tl_field_faces *f = of->faces;
    const uint16_t *number = of->number;
    uint32_t a = 0, real = 0;
    *of->sums = (tl_field_sums){0};
    while (real < of->planes.count && number[real] < real_faces(f))
        a += number[real++] < f->a;
    /* a face that bounds nothing of K may be far from it, and so would the apex be */
    of->apex[0] = only_bounding ? find_apex(of, 0, a) : (apex){0};
    of->apex[1] = only_bounding ? find_apex(of, a, real) : (apex){0};
    of->by_force = of->by_swept = 0;
    for (uint32_t i = 0; i < real; i++)
        for (uint32_t j = i + 1; j < real; j++)
            if ((i < a) != (j < a) || !of->apex[i >= a].known)
                put_between(w, of, number[i], number[j]);
    for (uint32_t k = real_faces(f); k < all_faces(f); k++)
        for (uint32_t face = 0; face < real_faces(f); face++) {
            tl_vec3 n = normal_of(f, k);
            put(w, of, n, f->c[k], face, k, false, -tl_v3_dot(n, normal_of(f, face)));
        }
}

static void end_pair(pair *of)
{
    add_share(of, &of->apex[0], 1);
    add_share(of, &of->apex[1], -1);
}

static void integrate(work *w, pair *of, const uint64_t *mask)
{
    choose(of, mask);
    put_pair(w, of, mask);
    flush(w);
    end_pair(of);
}

/* The faces that bound K: those of which something lies within all others. */
static uint64_t find_bounding(work *w, pair *of)
{
    const tl_field_faces *f = of->faces;
    choose(of, NULL);
    w->flat = true;
    of->found = 0;
    for (uint32_t i = 0; i < real_faces(f); i++)
        put(w, of, normal_of(f, i), f->c[i], i, i, false, 0);
    flush(w);
    w->flat = false;
    return of->found;
}

/* ---------------------------------------------------------------- pairs ------------------ */

/* Whether somebody keeps which faces of a pair bound K. */
static bool is_kept(const tl_field_faces *f)
{
    return f->bounding && all_faces(f) == real_faces(f) && real_faces(f) <= TL_FIELD_KNOWN;
}

static bool is_known(const tl_field_faces *f)
{
    return is_kept(f) && *f->bounding;
}

/* A pair of which it is not known which faces bound K, or not any more. */
static void integrate_anew(work *w, pair *of)
{
    const tl_field_faces *f = of->faces;
    if (is_kept(f)) {
        *f->bounding = find_bounding(w, of);
        integrate(w, of, f->bounding);
        if (!of->beyond)
            return;
        *f->bounding = 0; /* K is so thin that a face was lost in roundings */
    }
    integrate(w, of, NULL);
}

bool tl_field_integrate_all(const tl_field_faces *const faces[], tl_field_sums *const sums[],
                            uint32_t count, tl_field_room *room)
{
    pair pairs[TL_FIELD_PAIRS];
    work w; /* the lanes are filled before they are read */
    w.flat = false;
    w.filled = 0;
    w.planes.most = w.others.most = 0;
    uint32_t most = 0, all = 0;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t planes = all_faces(faces[k]);
        most = planes > most ? planes : most;
        all += planes;
    }
    if (!make_room(room, most + 1, all))
        return false;
    w.line = room->line;
    w.planes.row = room->plane;
    w.others.row = room->plane + room->lines;
    all = 0;
    for (uint32_t k = 0; k < count; k++) {
        pairs[k].faces = faces[k];
        pairs[k].sums = sums[k];
        pairs[k].number = room->number + all;
        all += all_faces(faces[k]);
        if (!is_known(faces[k]))
            continue;
        choose(&pairs[k], faces[k]->bounding);
        put_pair(&w, &pairs[k], true);
    }
    flush(&w);
    for (uint32_t k = 0; k < count; k++) {
        bool known = is_known(faces[k]);
        if (known)
            end_pair(&pairs[k]);
        if (!known || pairs[k].beyond)
            integrate_anew(&w, &pairs[k]);
    }
    return true;
}

bool tl_field_integrate(const tl_field_faces *faces, tl_field_room *room, tl_field_sums *sums)
{
    return tl_field_integrate_all(&faces, &sums, 1, room);
}
