/* ring.c - where the cells of contact points lie in their patch.
 *
 * The patch is the star of the triangles between its centroid and its edges. A point at the centroid has a share of each of them
 * inside; of what lies around it each other point has the part between two rays from the centroid, its cell. The rule of the points
 * (narrow/patch.c) gives cells of edges that lie evenly about their points; by how much those of corners do not adds up to 0 over the
 * patch. The share of the patch that a ray sweeps from one point to the next is that of the triangle between them, for
 * points of corners and of edges are drawn in by the same factors all around. So places and areas of the points alone tell where
 * their cells are. */
#include "contact/ring.h"

#include <math.h>

/* Parts of a patch below this share of it are rounding of the places of points. */
#define SLIVER 1e-11

/* A direction, growing with its angle from 0 to 4. */
static double turn_of(double x, double y)
{
    double sum = fabs(x) + fabs(y), part = sum > 0 ? y / sum : 0;
    return x < 0 ? 2 - part : y < 0 ? 4 + part : part;
}

static double cross(const tl_ring_cell *a, const tl_ring_cell *b)
{
    return a->x * b->y - a->y * b->x;
}

/* Puts cells in their order: by direction, those inside last. */
static void sort(tl_ring_cell *cell, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        tl_ring_cell moved = cell[i];
        size_t at = i;
        for (; at > 0 && cell[at - 1].turn > moved.turn; at--)
            cell[at] = cell[at - 1];
        cell[at] = moved;
    }
}

tl_ring tl_ring_of(tl_ring_cell *cell, size_t count, double place)
{
    tl_ring out = {.cell = cell, .count = count};
    double area[2] = {0};
    for (size_t i = 0; i < count; i++) {
        cell[i].inside = cell[i].x * cell[i].x + cell[i].y * cell[i].y <= place * place;
        cell[i].turn = cell[i].inside ? 8 : turn_of(cell[i].x, cell[i].y);
        area[cell[i].inside] += cell[i].area;
        out.around += !cell[i].inside;
    }
    sort(cell, count);
    out.inside = area[1] / (area[0] + area[1]);
    double swept = 0, begun = 0, off = 0;
    for (size_t i = 0; i < count; i++) {
        bool inside = cell[i].inside;
        cell[i].share = cell[i].area / (inside ? area[0] + area[1] : area[0]);
        cell[i].swept = swept;
        if (!inside)
            swept += fmax(0, cross(&cell[i], &cell[i + 1 < out.around ? i + 1 : 0]));
    }
    for (size_t i = 0; i < out.around; i++) {
        cell[i].swept /= swept > 0 ? swept : 1;
        cell[i].from = begun;
        begun += cell[i].share;
        off += cell[i].swept - 0.5 * (cell[i].from + begun);
    }
    for (size_t i = 0; i < out.around; i++) {
        cell[i].from += off / (double)out.around;
        cell[i].to = cell[i].from + cell[i].share;
    }
    return out;
}

/* What a ray in the direction of a cell's point has swept of a ring, from its first point on. */
static double swept_by(const tl_ring *ring, const tl_ring_cell *ray)
{
    size_t next = 0;
    while (next < ring->around && ring->cell[next].turn <= ray->turn)
        next++;
    const tl_ring_cell *before = &ring->cell[(next ? next : ring->around) - 1];
    const tl_ring_cell *after = &ring->cell[next < ring->around ? next : 0];
    double from = before->swept - (next ? 0 : 1), to = after->swept + (next < ring->around ? 0 : 1);
    double a = fmax(0, cross(before, ray)), b = fmax(0, cross(ray, after));
    return a + b > 0 ? from + a / (a + b) * (to - from) : from;
}

void tl_ring_align(tl_ring *old, const tl_ring *now)
{
    double by = 0;
    for (size_t i = 0; i < old->around && now->around; i++)
        by += swept_by(now, &old->cell[i]) - old->cell[i].swept;
    for (size_t i = 0; i < old->around; i++) {
        old->cell[i].from += by / (double)old->around;
        old->cell[i].to += by / (double)old->around;
    }
}

/* The overlap of two parts of a ring. */
static double overlap(const tl_ring_cell *a, const tl_ring_cell *b)
{
    double sum = 0, way = ceil(a->from - b->to);
    for (int k = 0; k < 2; k++, way++) {
        double common = fmin(a->to, b->to + way) - fmax(a->from, b->from + way);
        sum += common > SLIVER ? common : 0;
    }
    return sum;
}

double tl_ring_common(const tl_ring *now, const tl_ring_cell *a, const tl_ring *old,
                      const tl_ring_cell *b)
{
    double both = fmin(now->inside, old->inside);
    if (a->inside && b->inside)
        return both * (a->share / now->inside) * (b->share / old->inside);
    if (a->inside)
        return (now->inside - both) * (a->share / now->inside) * b->share;
    if (b->inside)
        return (old->inside - both) * (b->share / old->inside) * a->share;
    return (1 - fmax(now->inside, old->inside)) * overlap(a, b);
}
