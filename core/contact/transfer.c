/* transfer.c - new contact points in the place of old ones, where the contact polygon has changed or its points
 * have run along it.
 *
 * What points carry belongs to places of the faces. A new point gets the mean of the old points, by the areas
 * that its cell has in common with theirs. So sums over the area stay, and nothing goes beyond what there was:
 * a bond that is lost does not come back.
 *
 * Means wear down what varies over the face. So of stresses, and of states that are linear in the force, the
 * plane fitted through the old points is taken out before. It is put back after, with the same sum and moments. A
 * linear field stays what it is to rounding. So does its energy, for the points integrate squares of it
 * exactly; that of what is off the plane can only become less. Sum and moments are taken about the centroids of
 * the areas and follow the area, so a uniform stress stays uniform when the area changes.
 *
 * Area that comes into contact brings no shear, and area that goes takes its own. Where the area shrinks total
 * shear force follows it, where it grows the force stays. The shear's moment about the normal does so with the
 * second moment of the area. The shear springs never have more energy than before; what they have less is heat.
 *
 * Points of a part of a block that was cut take the stresses and states at their places: of the nearest, by the
 * plane. */
#include "contact/transfer.h"

#include "base/columns.h"
#include "contact/across_gap.h"
#include "contact/contacts.h"
#include "contact/cut_contacts.h"
#include "contact/pair_view.h"
#include "contact/places.h"
#include "contact/shear.h"
#include "narrow/corner.h"
#include "narrow/frame2.h"
#include "narrow/view.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The cell of a point: its share of the patch. That of the centroid lies inside; the others follow each other
 * around it. */
typedef struct tl_ring_cell {
    double x, y, area; /* of the point, about the centroid of the patch */
    uint32_t point;
    bool inside;
    double share;    /* of the patch, or of what lies around the centroid */
    double turn;     /* direction of the point from the centroid, 0 to 4 */
    double swept;    /* share of the patch from the first cell's point to this one's */
    double from, to; /* where the cell begins and ends, as `swept` */
    double weight;   /* of an old cell in the means of the point that is looked at */
    tl_point2 mean;  /* of a new cell: the mean place of the old ones that it lies on */
} ring_cell;

typedef struct ring {
    ring_cell *cell; /* by their directions */
    size_t around;   /* the ones after these are inside */
    double inside;   /* their share of the patch */
} ring;

/* Second moments of areas about their centroid. */
typedef struct spread {
    double xx, xy, yy;
} spread;

/* Whether points span a plane. Within about `place` of a line slopes would be quotients of rounding. */
static bool spans(const spread *i, double area, double place)
{
    return i->xx * i->yy - i->xy * i->xy > area * place * place * (i->xx + i->yy);
}

typedef tl_old_point old_point;

/* Makes room for so many points before and after, and their cells. */
static bool reserve(tl_narrow_scratch *scratch, size_t count)
{
    return tl_grow(&scratch->old, &scratch->old_capacity, count, sizeof *scratch->old) &&
           tl_grow(&scratch->cell, &scratch->cell_capacity, count, sizeof *scratch->cell);
}

/* The points of a contact, in the places where `lanes` has them. */
static void read_points(const tl_model *m, uint32_t c, const tl_point_lanes *lanes, old_point *out)
{
    const tl_contacts *contacts = &m->detect->contacts;
    for (size_t k = 0; k < contacts->point_count[c]; k++)
        out[k] = tl_point_as_old(&m->detect->points, contacts, c, k, tl_columns_get(lanes->arm, k));
}

void tl_contact_place_points(tl_model *m, uint32_t c, const tl_manifold *g, const tl_point_lanes *lanes)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    contacts->facet[c] = g->facet;
    if (contacts->point_count[c] == 0) /* its blocks meet, or meet again */
        contacts->born[c] = m->cycles;
    contacts->point_count[c] = (uint16_t)g->point_count;
    for (size_t k = 0; k < contacts->point_capacity[c]; k++)
        tl_point_clear(p, tl_point_row(contacts, c, k));
    for (size_t k = 0; k < g->point_count; k++) {
        size_t i = tl_point_row(contacts, c, k);
        tl_columns_put(p->p, i, g->points[k].p);
        p->area[i] = g->points[k].area;
        p->key[i] = g->points[k].key;
        tl_point_initial_state(p, i, tl_law_kind(m, contacts->law[c]));
    }
    contacts->facet[c].last = tl_contact_places(m, c, lanes);
}

/* Gives the points of a contact what they carry. */
static void write_points(tl_model *m, uint32_t c, const old_point *fresh)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    for (size_t k = 0; k < contacts->point_count[c]; k++) {
        size_t i = tl_point_row(contacts, c, k);
        const old_point *now = &fresh[k];
        tl_columns_put(p->f_s, i, tl_v3_scale(now->area, now->shear));
        p->f_n[i] = now->area * now->f_n;
        if (p->f_n0) {
            p->f_n0[i] = now->area * now->n0;
            p->reference[i] = now->reference;
        }
        p->flags[i] = now->flags;
        for (uint32_t s = 0; s < p->state_columns; s++)
            p->state[s][i] = now->state[s];
    }
}

/* Area of points, its centroid, and their mean normal. */
static tl_shear area_of(const old_point *point, size_t count)
{
    tl_shear t = {.area = 0};
    for (size_t k = 0; k < count; k++) {
        t.area += point[k].area;
        t.centre = tl_v3_madd(t.centre, point[k].area, point[k].arm);
        t.normal = tl_v3_madd(t.normal, point[k].area, point[k].normal);
    }
    if (t.area > 0)
        t.centre = tl_v3_scale(1 / t.area, t.centre);
    t.normal = tl_v3_unit(t.normal);
    return t;
}

/* Their shear, anew. */
static void sum_shear(const old_point *point, size_t count, tl_shear *t)
{
    t->force = t->moment = tl_v3(0, 0, 0);
    t->torsion = t->polar = t->energy = 0;
    for (size_t k = 0; k < count; k++) {
        tl_vec3 across = tl_v3_cross(t->normal, tl_v3_sub(point[k].arm, t->centre));
        tl_vec3 f = tl_v3_scale(point[k].area, point[k].shear);
        t->force = tl_v3_add(t->force, f);
        t->torsion += tl_v3_dot(across, f);
        t->polar += point[k].area * tl_v3_norm2(across);
        t->energy += tl_v3_dot(f, point[k].shear);
        t->moment = tl_v3_add(t->moment, tl_v3_cross(point[k].arm, f));
    }
}

/* Distance within which points are one. */
static double place_of(const tl_model *m, uint32_t c)
{
    return TL_MERGE * tl_contact_size(m, c);
}

/* ---------------------------------------------------------------- rings of cells ----------
 *
 * Where the cells of contact points lie in their patch.
 *
 * The patch is the star of the triangles between its centroid and its edges. A point at the centroid has a
 * share of each of them inside. Each other point has a cell of what lies around it: the part between two rays
 * from the centroid. By the rule of the points (narrow/patch.c) the cells of edges lie evenly about their
 * points. Those of corners do not, by amounts that add up to 0 over the patch. The share of the patch that a
 * ray sweeps from one point to the next is that of the triangle between them: points of corners and of edges
 * are drawn in by the same factors all around. So places and areas of the points alone tell where their cells
 * are. */

/* Tolerance: parts of a patch below this share of it are rounding of the places of points. */
#define SLIVER 1e-11

/* A direction, growing with its angle from 0 to 4. */
static double turn_of(double x, double y)
{
    double sum = fabs(x) + fabs(y), part = sum > 0 ? y / sum : 0;
    return x < 0 ? 2 - part : y < 0 ? 4 + part : part;
}

static double cross(const ring_cell *a, const ring_cell *b)
{
    return a->x * b->y - a->y * b->x;
}

/* Puts cells in their order: by direction, those inside last. */
static void sort(ring_cell *cell, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        ring_cell moved = cell[i];
        size_t at = i;
        for (; at > 0 && cell[at - 1].turn > moved.turn; at--)
            cell[at] = cell[at - 1];
        cell[at] = moved;
    }
}

/* Of cells with their points; those within `place` of the centroid are inside. */
static ring ring_of_cells(ring_cell *cell, size_t count, double place)
{
    ring out = {.cell = cell};
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
static double swept_by(const ring *of, const ring_cell *ray)
{
    size_t next = 0;
    while (next < of->around && of->cell[next].turn <= ray->turn)
        next++;
    const ring_cell *before = &of->cell[(next ? next : of->around) - 1];
    const ring_cell *after = &of->cell[next < of->around ? next : 0];
    double from = before->swept - (next ? 0 : 1), to = after->swept + (next < of->around ? 0 : 1);
    double a = fmax(0, cross(before, ray)), b = fmax(0, cross(ray, after));
    return a + b > 0 ? from + a / (a + b) * (to - from) : from;
}

/* Turns an old ring so that its shares count from where those of the new one do. */
static void ring_align(ring *old, const ring *now)
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
static double overlap(const ring_cell *a, const ring_cell *b)
{
    double sum = 0, way = ceil(a->from - b->to);
    for (int k = 0; k < 2; k++, way++) {
        double common = fmin(a->to, b->to + way) - fmax(a->from, b->from + way);
        sum += common > SLIVER ? common : 0;
    }
    return sum;
}

/* The share of the patch that is common to a new cell and an old one. */
static double ring_common(const ring *now, const ring_cell *a, const ring *old, const ring_cell *b)
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

/* ---------------------------------------------------------------- fields ------------------ */

/* How a column is taken over: not at all; as means; as means beside a plane, of any sign or not below 0. */
typedef enum relay_rule { LEFT, MEAN, PLANE, PLANE_ABOVE } relay_rule;

/* Which old points a new one takes the mean of. Those with which its cell has area in common; that of the same
 * key, where places are not known; the nearest, for a part of the old patch. */
typedef enum relay_match { BY_AREA, BY_KEY, NEAREST } relay_match;

/* Old points and new ones of one patch, each with its cell: places are about the centroids. */
typedef struct relay {
    old_point *old, *now;
    size_t old_count, count;
    const tl_shear *total; /* before and after */
    ring before, after;
    spread spread[2]; /* of the areas before and after */
    bool planes;      /* places tell how stresses vary */
    bool states;      /* are of the law */
    relay_match match;
    relay_rule rule[TL_OLD_COLUMNS];
} relay;

/* The cells of points about their centre, and the spread of their areas. */
static ring ring_of(const old_point *point, size_t count, tl_vec3 centre, const tl_vec3 axis[2], double place,
                    ring_cell *cell, spread *out)
{
    for (size_t k = 0; k < count; k++) {
        tl_vec3 arm = tl_v3_sub(point[k].arm, centre);
        double x = tl_v3_dot(arm, axis[0]), y = tl_v3_dot(arm, axis[1]), a = point[k].area;
        cell[k] = (ring_cell){.x = x, .y = y, .area = a, .point = (uint32_t)k};
        out->xx += a * x * x;
        out->xy += a * x * y;
        out->yy += a * y * y;
    }
    return ring_of_cells(cell, count, place);
}

/* Gives the point of a new cell the means of old ones by their weights, to the bit where they are the same. Its
 * flags are those of the heaviest. */
static void take_means(const relay *r, ring_cell *cell)
{
    old_point *now = &r->now[cell->point];
    const ring_cell *from = r->before.cell;
    double sum = 0, apart = 0;
    size_t most = 0;
    for (size_t j = 0; j < r->old_count; j++) {
        sum += from[j].weight;
        most = from[j].weight > from[most].weight ? j : most;
    }
    old_point *heaviest = &r->old[from[most].point];
    cell->mean = (tl_point2){0, 0};
    for (int column = 0; column < TL_OLD_COLUMNS; column++)
        if (r->rule[column] != LEFT)
            now->column[column] = heaviest->column[column];
    for (size_t j = 0; j < r->old_count; j++, from++) {
        double by = from->weight / sum;
        for (int column = 0; column < TL_OLD_COLUMNS && by > 0; column++)
            if (r->rule[column] != LEFT)
                now->column[column] += by * (r->old[from->point].column[column] - heaviest->column[column]);
        cell->mean.x += by * from->x;
        cell->mean.y += by * from->y;
        apart += r->old[from->point].flags & TL_POINT_APART ? by : 0;
    }
    now->flags = heaviest->flags & ~(uint32_t)TL_POINT_APART;
    now->flags |= apart > 0.5 ? TL_POINT_APART : 0;
}

/* Gives all new points such means. */
static void relay_means(const relay *r)
{
    for (size_t k = 0; k < r->count; k++) {
        ring_cell *cell = &r->after.cell[k];
        double sum = 0, least = INFINITY;
        size_t nearest = 0;
        for (size_t j = 0; j < r->old_count; j++) {
            ring_cell *from = &r->before.cell[j];
            const old_point *old = &r->old[from->point], *now = &r->now[cell->point];
            double apart = tl_v3_norm2(tl_v3_sub(old->arm, now->arm));
            nearest = apart < least ? j : nearest;
            least = fmin(least, apart);
            from->weight = r->match == BY_AREA ? ring_common(&r->after, cell, &r->before, from)
                                               : r->match == BY_KEY && old->key == now->key;
            sum += from->weight;
        }
        if (!(sum > 0))
            r->before.cell[nearest].weight = 1;
        take_means(r, cell);
    }
}

static tl_point2 slopes_of(const relay *r, int side, double x, double y)
{
    const spread *i = &r->spread[side];
    double det = i->xx * i->yy - i->xy * i->xy;
    return r->planes ? (tl_point2){(x * i->yy - y * i->xy) / det, (y * i->xx - x * i->xy) / det} : (tl_point2){0, 0};
}

/* What is added to the means of a column: the plane of the old points less its means, and what restores sum and
 * moments. */
typedef struct addition {
    tl_point2 old, now; /* slopes */
    double level;
} addition;

static addition addition_of(const relay *r, int column)
{
    double sum = 0, x = 0, y = 0, follow = r->total[1].area / r->total[0].area;
    for (size_t j = 0; j < r->old_count; j++) {
        const ring_cell *from = &r->before.cell[j];
        double u = from->area * r->old[from->point].column[column];
        sum += u;
        x += u * from->x;
        y += u * from->y;
    }
    addition out = {.old = slopes_of(r, 0, x, y)};
    out.now = out.old;
    if (r->match == NEAREST)
        return out;
    double mean = sum / r->total[0].area, off = 0;
    x *= follow;
    y *= follow;
    for (size_t k = 0; k < r->count; k++) {
        const ring_cell *cell = &r->after.cell[k];
        double rest = r->now[cell->point].column[column] - mean - out.old.x * cell->mean.x - out.old.y * cell->mean.y;
        off += cell->area * rest;
        x -= cell->area * rest * cell->x;
        y -= cell->area * rest * cell->y;
    }
    out.now = slopes_of(r, 1, x, y);
    out.level = -off / r->total[1].area;
    return out;
}

static double added(const addition *more, const ring_cell *cell)
{
    return more->level + more->now.x * cell->x + more->now.y * cell->y - more->old.x * cell->mean.x -
           more->old.y * cell->mean.y;
}

/* Adds to the means of `width` columns, those of a vector or one, a part of their additions. It is the same at all
 * points, so that the sum stays. Where points have hardly an area, planes through them would ask for any stress. */
static void restore_planes(const relay *r, int column, int width)
{
    addition more[3];
    double largest = 0, part = 1;
    for (int w = 0; w < width; w++)
        more[w] = addition_of(r, column + w);
    for (size_t j = 0; j < r->old_count; j++) {
        double size = 0;
        for (int w = 0; w < width; w++)
            size += r->old[j].column[column + w] * r->old[j].column[column + w];
        largest = fmax(largest, sqrt(size));
    }
    for (size_t k = 0; k < r->count; k++) {
        const ring_cell *cell = &r->after.cell[k];
        double size = 0, step = added(&more[0], cell);
        double value = r->now[cell->point].column[column];
        for (int w = 0; w < width; w++)
            size += added(&more[w], cell) * added(&more[w], cell);
        size = sqrt(size);
        part = size > largest ? fmin(part, largest / size) : part;
        if (r->rule[column] == PLANE_ABOVE && value + step < 0)
            part = fmin(part, fmax(0, -value / step));
    }
    for (size_t k = 0; k < r->count; k++)
        for (int w = 0; w < width; w++)
            r->now[r->after.cell[k].point].column[column + w] += part * added(&more[w], &r->after.cell[k]);
}

/* Sets the rules of the states of a law. Makes those that go with the area stresses, or with `back` what they were. */
static void rule_states(relay *r, const tl_kind *kind, uint32_t columns, bool back)
{
    static const relay_rule rules[] = {[TL_TRANSFER_COPY] = MEAN,
                                       [TL_TRANSFER_SPLIT] = MEAN,
                                       [TL_TRANSFER_RESET] = LEFT,
                                       [TL_TRANSFER_ENERGY] = LEFT,
                                       [TL_TRANSFER_LIFT] = PLANE_ABOVE};
    for (tl_state_columns at = {0}; tl_state_next(kind, columns, &at);)
        for (uint32_t w = at.begin; w < at.begin + at.count; w++) {
            r->rule[TL_OLD_STATES + w] = rules[at.state->transfer];
            bool splits = at.state->transfer == TL_TRANSFER_SPLIT;
            for (size_t j = 0; j < r->old_count && splits && !back; j++)
                r->old[j].state[w] /= r->old[j].area;
            for (size_t j = 0; j < r->count && splits && back; j++)
                r->now[j].state[w] *= r->now[j].area;
        }
}

/* Axes of the plane of the new points; the first leads to an old point off the centre, where there is one. */
static void find_axes(const relay *r, double place, tl_vec3 axis[2])
{
    size_t first = 0;
    tl_vec3 centre = r->total[0].centre, n = r->total[1].normal;
    while (first + 1 < r->old_count && tl_v3_norm(tl_v3_sub(r->old[first].arm, centre)) <= place)
        first++;
    axis[0] = tl_v3_sub(r->old[first].arm, centre);
    axis[0] = tl_v3_madd(axis[0], -tl_v3_dot(axis[0], n), n);
    axis[0] = tl_v3_norm(axis[0]) > 0 ? tl_v3_unit(axis[0]) : tl_v3_perpendicular(n);
    axis[1] = tl_v3_cross(n, axis[0]);
}

/* Gives new points what old ones of the same patch carried. */
static void relay_fields(tl_model *m, uint32_t c, relay *r, const tl_narrow_scratch *scratch)
{
    const tl_shear *t = r->total;
    const tl_kind *kind = r->states ? tl_law_kind(m, m->detect->contacts.law[c]) : NULL;
    uint32_t columns = m->detect->points.state_columns;
    double place = place_of(m, c);
    tl_vec3 axis[2], centre = r->match == NEAREST ? t[0].centre : t[1].centre;
    find_axes(r, place, axis);
    r->before = ring_of(r->old, r->old_count, t[0].centre, axis, place, scratch->cell, &r->spread[0]);
    r->after = ring_of(r->now, r->count, centre, axis, place, scratch->cell + r->old_count, &r->spread[1]);
    ring_align(&r->before, &r->after);
    r->planes = r->planes && spans(&r->spread[0], t[0].area, place) &&
                (r->match == NEAREST || spans(&r->spread[1], t[1].area, place));
    for (int column = 0; column < TL_OLD_STATES; column++)
        r->rule[column] = PLANE;
    for (size_t j = 0; j < r->old_count; j++) {
        r->old[j].shear = tl_into_plane(r->old[j].shear, r->old[j].normal, t[1].normal);
        tl_states_turn(kind, columns, r->old[j].state, r->old[j].normal, t[1].normal);
    }
    rule_states(r, kind, columns, false);
    relay_means(r);
    restore_planes(r, TL_OLD_SHEAR, 3);
    for (int column = TL_OLD_NORMAL; column < TL_OLD_COLUMNS; column++)
        if (r->rule[column] >= PLANE)
            restore_planes(r, column, 1);
    rule_states(r, kind, columns, true);
}

/* ---------------------------------------------------------------- shear ------------------- */

/* Points' shear stresses become `keep` times what they are and a uniform traction and a twist. */
static void add_traction(old_point *point, size_t count, const tl_shear *now, double keep, tl_vec3 traction,
                         double twist)
{
    for (size_t k = 0; k < count; k++) {
        tl_vec3 arm = tl_v3_sub(point[k].arm, now->centre);
        tl_vec3 stress = tl_v3_madd(traction, twist, tl_v3_cross(now->normal, arm));
        stress = tl_v3_madd(stress, keep, point[k].shear);
        point[k].shear = tl_v3_madd(stress, -tl_v3_dot(stress, point[k].normal), point[k].normal);
    }
}

/* Brings the energy of the shear springs down to `most`. A uniform traction with a twist has the least energy of all
 * stresses of the same force and torsion. Stresses beside it have an energy of their own, which is made less. */
static void limit_energy(old_point *point, size_t count, tl_shear *now, double most, bool turns)
{
    sum_shear(point, count, now);
    if (!(now->energy > most))
        return;
    double twist = turns ? now->torsion / now->polar : 0;
    double least = tl_v3_norm2(now->force) / now->area + twist * twist * now->polar;
    double rest = now->energy - least, keep = sqrt(fmax(0, most - least) / fmax(rest, DBL_MIN));
    keep = fmin(keep, 1);
    add_traction(point, count, now, keep, tl_v3_scale((1 - keep) / now->area, now->force), (1 - keep) * twist);
    sum_shear(point, count, now);
    if (now->energy > most) { /* a torsion too large for it */
        add_traction(point, count, now, sqrt(most / now->energy), tl_v3(0, 0, 0), 0);
        sum_shear(point, count, now);
    }
}

/* Brings shear force and torsion to what they are to be. Area that comes brings none, area that goes takes its
 * own. A twist goes with the second moment of area as traction does with the area. The springs get no more
 * energy than there was. */
static void correct_shear(old_point *point, size_t count, tl_shear *now, const tl_shear *before, bool turns)
{
    sum_shear(point, count, now);
    double area = fmin(1, now->area / before->area);
    double polar = before->polar > 0 ? fmin(1, now->polar / before->polar) : 1;
    tl_vec3 want = tl_v3_scale(area, tl_v3_turn(before->force, before->normal, now->normal));
    tl_vec3 force = tl_v3_sub(want, now->force);
    double twist = turns ? (polar * before->torsion - now->torsion) / now->polar : 0;
    add_traction(point, count, now, 1, tl_v3_scale(1 / now->area, force), twist);
    limit_energy(point, count, now, before->energy, turns);
}

/* ---------------------------------------------------------------- new contacts ------------ */

/* Adds what slip has opened at new points, by states of other places, to their references. So what was between
 * the points of the whole is between the walls. */
static void refer_to_openings(tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    double opening[TL_LANES];
    bool opens = p->reference && tl_contact_opens(m, c);
    for (size_t k = 0; k < contacts->point_count[c] && opens; k++) {
        if (k % TL_LANES == 0)
            tl_contact_point_openings(m, c, k, opening);
        p->reference[tl_point_row(contacts, c, k)] += opening[k % TL_LANES];
    }
}

/* Finds the old points, of the contact or of the whole that it is a part of, and behind them the new ones. */
static void gather(tl_model *m, uint32_t c, const tl_cut_contact *cut, const tl_narrow_scratch *scratch,
                   const tl_point_lanes *lanes, relay *r)
{
    r->old = scratch->old;
    r->now = scratch->old + r->old_count;
    tl_contact_places(m, c, lanes); /* old points have gone along with A, in whose frame they are */
    read_points(m, c, lanes, r->old);
    tl_contact_place_points(m, c, &scratch->manifold, lanes);
    for (size_t k = 0; cut && k < r->old_count; k++)
        r->old[k] = tl_cut_contact_point(m, cut, c, k);
    read_points(m, c, lanes, r->now);
}

/* A new contact of parts of a block takes its share of what the whole carried: the stresses at its own points.
 * Where its area is more than that of the whole, it carries no more than there was. */
static void take_share(tl_model *m, uint32_t c, const tl_cut_contact *cut, const tl_narrow_scratch *scratch, relay *r)
{
    const tl_shear *t = r->total;
    r->planes = !cut->reframed;
    r->states = tl_cut_contact_is_of_law(m, cut, c);
    r->match = NEAREST;
    relay_fields(m, c, r, scratch);
    double keep = t[0].area < t[1].area ? t[0].area / t[1].area : 1;
    for (size_t k = 0; k < r->count; k++) {
        r->now[k].shear = tl_v3_scale(keep, r->now[k].shear);
        r->now[k].f_n *= keep;
        r->now[k].n0 *= keep;
        r->now[k].flags = r->states ? r->now[k].flags : 0;
    }
    write_points(m, c, r->now);
    refer_to_openings(m, c);
    tl_shear_keep(m, c, tl_cut_contact_kept(m, cut, c));
}

/* The points take over from those that the contact had. `kept`: the energy that shear held beyond its springs. */
static void take_over(tl_model *m, uint32_t c, const tl_narrow_scratch *scratch, relay *r, tl_shear t[2], double kept)
{
    sum_shear(r->old, r->old_count, &t[0]);
    if (r->count > 0 && t[0].area > 0) {
        r->planes = !scratch->reframed;
        r->states = true;
        r->match = scratch->reframed ? BY_KEY : BY_AREA;
        relay_fields(m, c, r, scratch);
        correct_shear(r->now, r->count, &t[1], &t[0], r->planes);
    }
    write_points(m, c, r->now);
    tl_shear_keep(m, c, kept);
    if (scratch->reframed) { /* the last step's motion was that of other bodies */
        t[1].force = t[0].force;
        t[1].moment = t[0].moment;
    }
    tl_shear_release(m, c, &t[0], &t[1]);
}

bool tl_contact_transfer(tl_model *m, uint32_t c, tl_narrow_scratch *scratch, const tl_point_lanes *lanes)
{
    const tl_manifold *g = &scratch->manifold;
    size_t old_count = m->detect->contacts.point_count[c];
    const tl_cut_contact *cut = old_count ? NULL : tl_cut_contact_on(m, c, &g->facet);
    double kept = tl_shear_kept(m, c);
    relay r = {.old_count = cut ? cut->count : old_count, .count = g->point_count};
    if (!reserve(scratch, r.old_count + r.count))
        return false;
    gather(m, c, cut, scratch, lanes, &r);
    tl_shear t[2] = {area_of(r.old, r.old_count), area_of(r.now, r.count)};
    r.total = t;
    if (old_count > 0)
        take_over(m, c, scratch, &r, t, kept);
    else if (cut && r.count > 0)
        take_share(m, c, cut, scratch, &r);
    else
        tl_contact_begin_law(m, c, tl_law_kind(m, m->detect->contacts.law[c]), lanes);
    return true;
}
