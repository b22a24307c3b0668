/* plane.c - planes of least squares, and vertices moved into them.
 *
 * The plane of points is through their mean, across the direction in which they spread least. A vertex of three sides
 * goes to their intersection. Of more it goes to where the sum of squares of its distances is least; of fewer, or where
 * planes are nearly parallel, the shortest way. The planes are then fitted anew, until all corners lie on them. */
#include "solids.h"

#include <talus/kit.h>

/* Tolerance: corners that miss their plane by less than this times the solid's size lie on it. */
#define ON_PLANE 1e-9
/* Tolerance: of a solid that shares no side they may stay where they are when they miss it by less than this: a block
 * takes as much, and blocks of other files that have the same corners still fit. */
#define AS_GIVEN 8e-5
/* Tolerance: planes are parallel for a vertex where their normals spread by less than this, as the square of a sine. */
#define PARALLEL 1e-3
/* Limit: rounds of fitting and moving. Vertices of three sides need one or two. */
#define ROUNDS 60
/* Tolerance: corners that miss their plane by more than this times the solid's size in the end are refused: half of
 * what a block may. */
#define STILL_OFF 1e-4

void cloud_add(cloud *c, tl_vec3 at)
{
    tl_vec3 p = tl_v3_sub(at, c->zero);
    c->count += 1;
    c->sum = tl_v3_add(c->sum, p);
    c->xx += p.x * p.x;
    c->yy += p.y * p.y;
    c->zz += p.z * p.z;
    c->xy += p.x * p.y;
    c->yz += p.y * p.z;
    c->zx += p.z * p.x;
}

/* Moves the zero of the sums. */
static cloud about(const cloud *c, tl_vec3 zero)
{
    tl_vec3 d = tl_v3_sub(c->zero, zero), s = c->sum;
    cloud out = *c;
    out.zero = zero;
    out.sum = tl_v3_madd(s, c->count, d);
    out.xx += 2 * d.x * s.x + c->count * d.x * d.x;
    out.yy += 2 * d.y * s.y + c->count * d.y * d.y;
    out.zz += 2 * d.z * s.z + c->count * d.z * d.z;
    out.xy += d.x * s.y + d.y * s.x + c->count * d.x * d.y;
    out.yz += d.y * s.z + d.z * s.y + c->count * d.y * d.z;
    out.zx += d.z * s.x + d.x * s.z + c->count * d.z * d.x;
    return out;
}

void cloud_join(cloud *c, const cloud *other)
{
    cloud o = about(other, c->zero);
    c->count += o.count;
    c->sum = tl_v3_add(c->sum, o.sum);
    c->xx += o.xx;
    c->yy += o.yy;
    c->zz += o.zz;
    c->xy += o.xy;
    c->yz += o.yz;
    c->zx += o.zx;
}

/* Eigenvalues and eigenvectors (columns) of a symmetric matrix, by Jacobi's rotations. */
static void eigen(double a[3][3], double v[3][3])
{
    static const int pairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            v[i][j] = i == j;
    for (int round = 0; round < 12; round++) {
        for (int k = 0; k < 3; k++) {
            const int p = pairs[k][0], q = pairs[k][1];
            if (!(fabs(a[p][q]) > 1e-300))
                continue;
            double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
            double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
            double c = 1 / sqrt(t * t + 1), s = t * c;
            for (int i = 0; i < 3; i++) {
                double x = a[i][p], y = a[i][q];
                a[i][p] = c * x - s * y;
                a[i][q] = s * x + c * y;
            }
            for (int i = 0; i < 3; i++) {
                double x = a[p][i], y = a[q][i];
                a[p][i] = c * x - s * y;
                a[q][i] = s * x + c * y;
                x = v[i][p];
                y = v[i][q];
                v[i][p] = c * x - s * y;
                v[i][q] = s * x + c * y;
            }
        }
    }
}

plane cloud_plane(const cloud *c, tl_vec3 toward)
{
    tl_vec3 mean = tl_v3_scale(1 / c->count, c->sum);
    double a[3][3], v[3][3], xy = c->xy - mean.x * c->sum.y, yz = c->yz - mean.y * c->sum.z,
                             zx = c->zx - mean.z * c->sum.x;
    a[0][0] = c->xx - mean.x * c->sum.x;
    a[1][1] = c->yy - mean.y * c->sum.y;
    a[2][2] = c->zz - mean.z * c->sum.z;
    a[0][1] = a[1][0] = xy;
    a[1][2] = a[2][1] = yz;
    a[0][2] = a[2][0] = zx;
    eigen(a, v);
    int least = a[1][1] < a[0][0] ? 1 : 0;
    least = a[2][2] < a[least][least] ? 2 : least;
    plane p = {.normal = tl_v3_unit((tl_vec3){v[0][least], v[1][least], v[2][least]})};
    if (tl_v3_dot(p.normal, toward) < 0)
        p.normal = tl_v3_neg(p.normal);
    p.offset = tl_v3_dot(p.normal, tl_v3_add(c->zero, mean));
    return p;
}

double plane_above(const plane *p, tl_vec3 at)
{
    return tl_v3_dot(p->normal, at) - p->offset;
}

uint32_t solid_vertices(const solids *s, size_t i)
{
    return i + 1 < s->solids ? s->solid[i + 1].vertex : (uint32_t)s->vertices;
}

uint32_t solid_faces(const solids *s, size_t i)
{
    return i + 1 < s->solids ? s->solid[i + 1].face : (uint32_t)s->faces;
}

uint32_t solid_planes(const solids *s, size_t i)
{
    return i + 1 < s->solids ? s->solid[i + 1].plane : (uint32_t)s->planes;
}

/* ---------------------------------------------------------------- moving ----------------- */

/* The normal equations of a vertex: planes that it shall lie on. */
typedef struct pull {
    double a[3][3], b[3];
} pull;

typedef struct mover {
    solids *s;
    cloud *sum;      /* [planes] */
    uint8_t *binds;  /* [planes] it has four corners or more, or is shared */
    pull *pull;      /* [most vertices of a solid] */
    tl_vec3 *before; /* the vertices as they were read */
} mover;

/* The size of a solid: twice the largest distance from its first vertex. */
static double size_of(const solids *s, size_t i)
{
    double size2 = 0;
    for (uint32_t v = s->solid[i].vertex; v < solid_vertices(s, i); v++)
        size2 = fmax(size2, tl_v3_norm2(tl_v3_sub(s->vertex[v], s->vertex[s->solid[i].vertex])));
    return sqrt(size2);
}

/* How far the corners of a solid may miss their planes. */
static double on_plane(const solids *s, size_t i)
{
    return (s->solid[i].shared || s->solid[i].reflex ? ON_PLANE : AS_GIVEN) * size_of(s, i);
}

/* Fits the planes of all sides that bind. */
static void fit_planes(mover *m)
{
    solids *s = m->s;
    for (size_t p = 0; p < s->planes; p++)
        m->sum[p].count = 0;
    for (size_t i = 0; i < s->solids; i++) {
        const solid *o = &s->solid[i];
        for (uint32_t f = o->face; f < solid_faces(s, i); f++) {
            uint32_t group = s->plane[o->plane + s->side[f]].group;
            for (uint32_t h = s->start[f]; h < s->start[f + 1]; h++) {
                tl_vec3 at = s->vertex[o->vertex + s->corner[h]];
                if (!(m->sum[group].count > 0))
                    m->sum[group] = (cloud){.zero = at};
                cloud_add(&m->sum[group], at);
            }
        }
    }
    for (size_t p = 0; p < s->planes; p++)
        if (m->sum[p].count > 0) {
            plane fitted = cloud_plane(&m->sum[p], s->plane[p].normal);
            s->plane[p].normal = fitted.normal;
            s->plane[p].offset = fitted.offset;
        }
    for (size_t p = 0; p < s->planes; p++) {
        const plane *of = &s->plane[s->plane[p].group];
        bool same = tl_v3_dot(of->normal, s->plane[p].normal) > 0;
        s->plane[p].normal = same ? of->normal : tl_v3_neg(of->normal);
        s->plane[p].offset = same ? of->offset : -of->offset;
    }
}

/* The shortest move of a vertex that its planes ask for. */
static tl_vec3 move_of(const pull *given)
{
    double a[3][3], v[3][3], most = 0;
    tl_vec3 move = {0, 0, 0};
    memcpy(a, given->a, sizeof a);
    eigen(a, v);
    for (int k = 0; k < 3; k++)
        most = fmax(most, a[k][k]);
    for (int k = 0; k < 3; k++) {
        if (!(a[k][k] > PARALLEL * most))
            continue;
        double along = (v[0][k] * given->b[0] + v[1][k] * given->b[1] + v[2][k] * given->b[2]) / a[k][k];
        move = tl_v3_madd(move, along, (tl_vec3){v[0][k], v[1][k], v[2][k]});
    }
    return move;
}

/* How far the corners of a solid miss the planes that bind them. With `pulls` these are gathered. */
static double gather(mover *m, size_t i, bool pulls)
{
    const solids *s = m->s;
    const solid *o = &s->solid[i];
    double off = 0;
    if (pulls)
        memset(m->pull, 0, (solid_vertices(s, i) - o->vertex) * sizeof *m->pull);
    for (uint32_t f = o->face; f < solid_faces(s, i); f++) {
        const plane *p = &s->plane[o->plane + s->side[f]];
        if (!m->binds[o->plane + s->side[f]])
            continue;
        const double n[3] = {p->normal.x, p->normal.y, p->normal.z};
        for (uint32_t h = s->start[f]; h < s->start[f + 1]; h++) {
            double above = plane_above(p, s->vertex[o->vertex + s->corner[h]]);
            off = fmax(off, fabs(above));
            pull *to = &m->pull[s->corner[h]];
            for (int k = 0; k < 3 && pulls; k++) {
                to->b[k] -= above * n[k];
                for (int l = 0; l < 3; l++)
                    to->a[k][l] += n[k] * n[l];
            }
        }
    }
    return off;
}

/* Moves the vertices of all solids that are off; gives whether some are. */
static bool move_vertices(mover *m)
{
    solids *s = m->s;
    bool moved = false;
    for (size_t i = 0; i < s->solids; i++) {
        const solid *o = &s->solid[i];
        if (gather(m, i, false) <= on_plane(s, i))
            continue;
        moved = true;
        gather(m, i, true);
        for (uint32_t v = o->vertex; v < solid_vertices(s, i); v++)
            s->vertex[v] = tl_v3_add(s->vertex[v], move_of(&m->pull[v - o->vertex]));
    }
    return moved;
}

/* Counts the sides that were off, and which bind. */
static void begin(mover *m)
{
    solids *s = m->s;
    for (size_t i = 0; i < s->solids; i++) {
        solid *o = &s->solid[i];
        for (uint32_t f = o->face; f < solid_faces(s, i); f++) {
            uint32_t p = o->plane + s->side[f];
            bool again = f > o->face && s->side[f] == s->side[f - 1];
            m->binds[p] |= again || s->start[f + 1] - s->start[f] > 3 || s->plane[p].group != p;
            m->binds[s->plane[p].group] |= s->plane[p].group != p;
        }
    }
    fit_planes(m);
    for (size_t i = 0; i < s->solids; i++) {
        solid *o = &s->solid[i];
        const double on = ON_PLANE * size_of(s, i);
        if (gather(m, i, false) <= on_plane(s, i))
            continue;
        uint32_t last = NONE;
        for (uint32_t f = o->face; f < solid_faces(s, i); f++) {
            const plane *p = &s->plane[o->plane + s->side[f]];
            bool off = false;
            for (uint32_t h = s->start[f]; h < s->start[f + 1] && m->binds[o->plane + s->side[f]]; h++)
                off = off || fabs(plane_above(p, s->vertex[o->vertex + s->corner[h]])) > on;
            o->made_plane += off && s->side[f] != last;
            last = off ? s->side[f] : last;
        }
        s->made_plane += o->made_plane;
    }
}

/* Measures moves, and refuses solids of which corners are still off. */
static tl_status end(mover *m)
{
    solids *s = m->s;
    tl_status status = TL_OK;
    for (size_t i = 0; i < s->solids && status == TL_OK; i++) {
        solid *o = &s->solid[i];
        const double off = gather(m, i, false), size = size_of(s, i);
        o->off = off;
        for (uint32_t v = o->vertex; v < solid_vertices(s, i); v++)
            o->move = fmax(o->move, tl_v3_norm(tl_v3_sub(s->vertex[v], m->before[v])));
        if (o->move > s->largest_move) {
            s->largest_move = o->move;
            s->moved_most = (uint32_t)i;
        }
        if (off <= STILL_OFF * size)
            continue;
        o->refused = true;
        status = refuse_object(s, o->object, 0,
                               ": its faces cannot all be plane, one is still off by %.3g m: more than three meet at a "
                               "corner; divide it into triangles",
                               off);
    }
    return status;
}

tl_status planes_make(solids *s)
{
    size_t most = 0;
    if (s->solids == 0)
        return TL_OK;
    for (size_t i = 0; i < s->solids; i++)
        most = solid_vertices(s, i) - s->solid[i].vertex > most ? solid_vertices(s, i) - s->solid[i].vertex : most;
    mover m = {.s = s,
               .sum = malloc((s->planes + 1) * sizeof *m.sum),
               .binds = calloc(s->planes + 1, 1),
               .pull = malloc((most + 1) * sizeof *m.pull),
               .before = malloc((s->vertices + 1) * sizeof *m.before)};
    bool good = m.sum && m.binds && m.pull && m.before;
    if (good) {
        memcpy(m.before, s->vertex, s->vertices * sizeof *m.before);
        begin(&m);
        for (int round = 0; round < ROUNDS && move_vertices(&m); round++)
            fit_planes(&m);
    }
    tl_status status = good ? end(&m) : soup_no_memory(&s->soup);
    free(m.sum);
    free(m.binds);
    free(m.pull);
    free(m.before);
    return status;
}
