/* transfer.c - new contact points in the place of old ones, where the contact polygon has changed or its points have run along it.
 *
 * What points carry belongs to places of the faces: each new point's cell gets the mean of the old cells that it lies on, by their
 * common areas. So sums over the area stay, and nothing goes beyond what there was: a bond that is lost does not come back.
 * Means wear down what varies over the face. So of stresses, and of states that are linear in the force, the plane fitted through the
 * old points is taken out before and put back after, with the same sum and moments: a linear field stays what it is to rounding, and,
 * since the points integrate squares of it exactly, so does its energy; that of what is off the plane can only become less.
 * Sum and moments are taken about the centroids of the areas and follow the area, so a uniform stress stays uniform when the
 * area changes. What comes into contact brings no shear, and what goes takes its own with it: where the area shrinks total shear
 * force follows it, where it grows the force stays; so does the shear's moment about the normal, with the second moment of the area.
 * The shear springs never have more energy than before; what they have less is heat.
 * Points of a part of a block that was cut take the stresses and states at their places: of the nearest, by the plane. */
#include "contact/transfer.h"

#include "base/columns.h"
#include "contact/across_gap.h"
#include "contact/contacts.h"
#include "contact/detection.h"
#include "contact/estate.h"
#include "contact/places.h"
#include "narrow/corner.h"
#include "narrow/view.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct tl_ring {
    tl_ring_cell *cell;   /* by their directions */
    size_t count, around; /* the last ones are inside */
    double inside;        /* their share of the patch */
} tl_ring;

typedef tl_old_point old_point;

/* Makes room for so many points before and after, and what goes with each. */
static bool reserve(tl_narrow_scratch *scratch, size_t count)
{
    if (count <= scratch->old_capacity)
        return true;
    old_point *old = realloc(scratch->old, 2 * count * sizeof *old);
    if (old)
        scratch->old = old;
    double *value = realloc(scratch->value, 4 * count * sizeof *value);
    if (value)
        scratch->value = value;
    tl_ring_cell *cell = realloc(scratch->cell, 2 * count * sizeof *cell);
    if (cell)
        scratch->cell = cell;
    if (!old || !value || !cell)
        return false;
    scratch->old_capacity = 2 * count;
    return true;
}

static const tl_kind *kind_of(const tl_model *m, uint32_t c)
{
    uint32_t law = m->detect->contacts.law[c];
    return law == TL_NO_ROW ? NULL : m->joint_laws[law].kind;
}

/* The points of a contact, in the places where `lanes` has them. */
static void read_points(const tl_model *m, uint32_t c, const tl_point_lanes *lanes, old_point *out)
{
    const tl_contacts *contacts = &m->detect->contacts;
    for (size_t k = 0; k < contacts->point_count[c]; k++)
        out[k] = tl_point_as_old(&m->detect->points, contacts, c, k, tl_columns_get(lanes->arm, k));
}

/* Puts the points of the manifold in the place of a contact's, and reads them: without stress, their states at the beginning. */
static void place_points(tl_model *m, uint32_t c, const tl_manifold *g, const tl_point_lanes *lanes,
                         old_point *fresh)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    contacts->facet[c] = g->facet;
    contacts->point_count[c] = (uint16_t)g->point_count;
    for (size_t k = 0; k < contacts->point_capacity[c]; k++)
        tl_point_clear(p, tl_point_row(contacts, c, k));
    for (size_t k = 0; k < g->point_count; k++) {
        size_t i = tl_point_row(contacts, c, k);
        tl_columns_put(p->p, i, g->points[k].p);
        p->area[i] = g->points[k].area;
        p->key[i] = g->points[k].key;
        tl_point_initial_state(p, i, kind_of(m, c));
    }
    tl_contact_begin(m, c, lanes); /* positions and normals in the present place */
    read_points(m, c, lanes, fresh);
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

/* Turns a vector of an old plane into that of a new one. */
static tl_vec3 into_plane(tl_vec3 v, tl_vec3 from, tl_vec3 to)
{
    v = tl_v3_turn(v, from, to);
    return tl_v3_madd(v, -tl_v3_dot(v, to), to);
}

/* Totals of a set of points: area, its centroid, and of a field and of shear over it. */
typedef struct totals {
    double area;
    tl_vec3 centre, normal;
    tl_vec3 shear;  /* force */
    double torsion; /* moment of the shear about the normal through the centre */
    double polar;   /* second moment of area about it */
    double energy;  /* of the shear springs, times 2 ks */
    tl_vec3 moment; /* of the shear, about A's centroid */
} totals;

static void add_area(totals *t, double area, tl_vec3 arm, tl_vec3 normal)
{
    t->area += area;
    t->centre = tl_v3_madd(t->centre, area, arm);
    t->normal = tl_v3_madd(t->normal, area, normal);
}

static void close_area(totals *t)
{
    if (t->area > 0)
        t->centre = tl_v3_scale(1 / t->area, t->centre);
    t->normal = tl_v3_unit(t->normal);
}

/* Totals of points of this area. */
static totals totals_of(const old_point *point, size_t count)
{
    totals t = {0};
    for (size_t k = 0; k < count; k++)
        add_area(&t, point[k].area, point[k].arm, point[k].normal);
    close_area(&t);
    return t;
}

/* Their shear, anew. */
static void sum_shear(const old_point *point, size_t count, totals *t)
{
    t->shear = t->moment = tl_v3(0, 0, 0);
    t->torsion = t->polar = t->energy = 0;
    for (size_t k = 0; k < count; k++) {
        tl_vec3 across = tl_v3_cross(t->normal, tl_v3_sub(point[k].arm, t->centre));
        tl_vec3 f = tl_v3_scale(point[k].area, point[k].shear);
        t->shear = tl_v3_add(t->shear, f);
        t->torsion += tl_v3_dot(across, f);
        t->polar += point[k].area * tl_v3_norm2(across);
        t->energy += tl_v3_dot(f, point[k].shear);
        t->moment = tl_v3_add(t->moment, tl_v3_cross(point[k].arm, f));
    }
}

/* Distance within which points are one. */
static double place_of(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    return TL_MERGE * fmin(m->blocks.size[contacts->a[c]], m->blocks.size[contacts->b[c]]);
}

/* ---------------------------------------------------------------- rings of cells ----------
 *
 * Where the cells of contact points lie in their patch.
 *
 * The patch is the star of the triangles between its centroid and its edges. A point at the centroid has a share of each of them
 * inside; of what lies around it each other point has the part between two rays from the centroid, its cell. The rule of the points
 * (narrow/patch.c) gives cells of edges that lie evenly about their points; by how much those of corners do not adds up to 0 over the
 * patch. The share of the patch that a ray sweeps from one point to the next is that of the triangle between them, for
 * points of corners and of edges are drawn in by the same factors all around. So places and areas of the points alone tell where
 * their cells are. */

/* Tolerance: parts of a patch below this share of it are rounding of the places of points. */
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

/* Of cells with their points; those within `place` of the centroid are inside. */
static tl_ring tl_ring_of(tl_ring_cell *cell, size_t count, double place)
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

/* Turns an old ring so that its shares count from where those of the new one do. */
static void ring_align(tl_ring *old, const tl_ring *now)
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

/* The share of the patch that is common to a new cell and an old one. */
static double ring_common(const tl_ring *now, const tl_ring_cell *a, const tl_ring *old,
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

/* ---------------------------------------------------------------- fields ------------------ */

/* What a point carries, as columns: shear stress, normal stress, initial normal stress, reference, states of the law. */
enum { SHEAR, NORMAL = 3, INITIAL, REFERENCE, STATES, COLUMNS = STATES + TL_STATE_COLUMNS };

/* How a column is taken over: not at all; as means; as means beside a plane, of any sign or not below 0. */
typedef enum relay_rule { LEFT, MEAN, PLANE, PLANE_ABOVE } relay_rule;

static double *column_of(old_point *point, int column)
{
    double *const of[STATES] = {&point->shear.x, &point->shear.y, &point->shear.z,
                                &point->f_n,     &point->n0,      &point->reference};
    return column < STATES ? of[column] : &point->state[column - STATES];
}

/* Of which old points a new one takes the mean: those with which its cell has area in common; where places are not known, that of the same
 * key; where the old patch is a whole of which this is a part, the nearest. */
typedef enum relay_match { BY_AREA, BY_KEY, NEAREST } relay_match;

/* Old points and new ones of one patch, each with its cell: places are about the centroids. */
typedef struct relay {
    old_point *old, *now;
    tl_ring before, after;
    double *across; /* of each new point: the mean place of the old cells that it lies on */
    double area[2];
    tl_ring_spread spread[2]; /* of the areas before and after */
    bool planes;              /* places tell how stresses vary */
    bool states;              /* are of the law */
    relay_match match;
    relay_rule rule[COLUMNS];
} relay;

/* The cells of points about their centre, and the spread of their areas. */
static tl_ring ring_of(const old_point *point, size_t count, tl_vec3 centre, const tl_vec3 axis[2],
                       double place, tl_ring_cell *cell, tl_ring_spread *out)
{
    for (size_t k = 0; k < count; k++) {
        tl_vec3 arm = tl_v3_sub(point[k].arm, centre);
        double x = tl_v3_dot(arm, axis[0]), y = tl_v3_dot(arm, axis[1]), a = point[k].area;
        cell[k] = (tl_ring_cell){.x = x, .y = y, .area = a, .point = (uint32_t)k};
        out->xx += a * x * x;
        out->xy += a * x * y;
        out->yy += a * y * y;
    }
    return tl_ring_of(cell, count, place);
}

/* Gives the point of a new cell the means of old ones by their weights, to the bit where they are the same, and its flags: those of the
 * heaviest. */
static void take_means(const relay *r, const tl_ring_cell *cell, const double *weight)
{
    old_point *now = &r->now[cell->point];
    double *across = &r->across[2 * cell->point], sum = 0, apart = 0;
    size_t most = 0;
    for (size_t j = 0; j < r->before.count; j++) {
        sum += weight[j];
        most = weight[j] > weight[most] ? j : most;
    }
    old_point *heaviest = &r->old[r->before.cell[most].point];
    across[0] = across[1] = 0;
    for (int column = 0; column < COLUMNS; column++)
        if (r->rule[column] != LEFT)
            *column_of(now, column) = *column_of(heaviest, column);
    for (size_t j = 0; j < r->before.count; j++) {
        const tl_ring_cell *from = &r->before.cell[j];
        double by = weight[j] / sum;
        for (int column = 0; column < COLUMNS && by > 0; column++)
            if (r->rule[column] != LEFT)
                *column_of(now, column) +=
                    by * (*column_of(&r->old[from->point], column) - *column_of(heaviest, column));
        across[0] += by * from->x;
        across[1] += by * from->y;
        apart += r->old[from->point].flags & TL_POINT_APART ? by : 0;
    }
    now->flags = heaviest->flags & ~(uint32_t)TL_POINT_APART;
    now->flags |= apart > 0.5 ? TL_POINT_APART : 0;
}

/* Gives all new points such means. */
static void relay_means(const relay *r, double *weight)
{
    for (size_t k = 0; k < r->after.count; k++) {
        const tl_ring_cell *cell = &r->after.cell[k];
        double sum = 0, least = INFINITY;
        size_t nearest = 0;
        for (size_t j = 0; j < r->before.count; j++) {
            const tl_ring_cell *from = &r->before.cell[j];
            const old_point *old = &r->old[from->point], *now = &r->now[cell->point];
            double apart = tl_v3_norm2(tl_v3_sub(old->arm, now->arm));
            nearest = apart < least ? j : nearest;
            least = fmin(least, apart);
            weight[j] = r->match == BY_AREA ? ring_common(&r->after, cell, &r->before, from)
                                            : r->match == BY_KEY && old->key == now->key;
            sum += weight[j];
        }
        if (!(sum > 0))
            weight[nearest] = 1;
        take_means(r, cell, weight);
    }
}

/* Slopes of a plane. */
typedef struct slopes {
    double x, y;
} slopes;

static slopes slopes_of(const relay *r, int side, double x, double y)
{
    const tl_ring_spread *i = &r->spread[side];
    double det = i->xx * i->yy - i->xy * i->xy;
    return r->planes ? (slopes){(x * i->yy - y * i->xy) / det, (y * i->xx - x * i->xy) / det}
                     : (slopes){0, 0};
}

/* What is added to the means of a column: the plane of the old points less its means, and what restores sum and moments. */
typedef struct addition {
    slopes old, now;
    double level;
} addition;

static addition addition_of(const relay *r, int column)
{
    double sum = 0, x = 0, y = 0, follow = r->area[1] / r->area[0];
    for (size_t j = 0; j < r->before.count; j++) {
        const tl_ring_cell *from = &r->before.cell[j];
        double u = from->area * *column_of(&r->old[from->point], column);
        sum += u;
        x += u * from->x;
        y += u * from->y;
    }
    addition out = {.old = slopes_of(r, 0, x, y)};
    out.now = out.old;
    if (r->match == NEAREST)
        return out;
    double mean = sum / r->area[0], off = 0;
    x *= follow;
    y *= follow;
    for (size_t k = 0; k < r->after.count; k++) {
        const tl_ring_cell *cell = &r->after.cell[k];
        const double *across = &r->across[2 * cell->point];
        double rest = *column_of(&r->now[cell->point], column) - mean - out.old.x * across[0] -
                      out.old.y * across[1];
        off += cell->area * rest;
        x -= cell->area * rest * cell->x;
        y -= cell->area * rest * cell->y;
    }
    out.now = slopes_of(r, 1, x, y);
    out.level = -off / r->area[1];
    return out;
}

static double added(const relay *r, const addition *more, const tl_ring_cell *cell)
{
    const double *across = &r->across[2 * cell->point];
    return more->level + more->now.x * cell->x + more->now.y * cell->y - more->old.x * across[0] -
           more->old.y * across[1];
}

/* Adds to the means of `width` columns, those of a vector or one, the same part of its addition at all points, so that their sum stays:
 * where points have hardly an area, planes through them would ask for any stress. */
static void restore_planes(const relay *r, int column, int width)
{
    addition more[3];
    double largest = 0, part = 1;
    for (int w = 0; w < width; w++)
        more[w] = addition_of(r, column + w);
    for (size_t j = 0; j < r->before.count; j++) {
        double size = 0;
        for (int w = 0; w < width; w++)
            size += *column_of(&r->old[j], column + w) * *column_of(&r->old[j], column + w);
        largest = fmax(largest, sqrt(size));
    }
    for (size_t k = 0; k < r->after.count; k++) {
        const tl_ring_cell *cell = &r->after.cell[k];
        double size = 0, step = added(r, &more[0], cell);
        double value = *column_of(&r->now[cell->point], column);
        for (int w = 0; w < width; w++)
            size += added(r, &more[w], cell) * added(r, &more[w], cell);
        size = sqrt(size);
        part = size > largest ? fmin(part, largest / size) : part;
        if (r->rule[column] == PLANE_ABOVE && value + step < 0)
            part = fmin(part, fmax(0, -value / step));
    }
    for (size_t k = 0; k < r->after.count; k++)
        for (int w = 0; w < width; w++)
            *column_of(&r->now[r->after.cell[k].point], column + w) +=
                part * added(r, &more[w], &r->after.cell[k]);
}

/* Sets the rules of the states of a law, and makes those that go with the area stresses, or with `back` what they were. */
static void rule_states(relay *r, const tl_kind *kind, uint32_t columns, bool back)
{
    static const relay_rule rules[] = {[TL_TRANSFER_COPY] = MEAN,
                                       [TL_TRANSFER_SPLIT] = MEAN,
                                       [TL_TRANSFER_RESET] = LEFT,
                                       [TL_TRANSFER_ENERGY] = LEFT,
                                       [TL_TRANSFER_LIFT] = PLANE_ABOVE};
    uint32_t column = 0;
    for (uint32_t k = 0; kind && k < kind->state_count && column < columns; k++) {
        const tl_state *state = tl_kind_state(kind, k);
        uint32_t end = column + (state->kind == TL_STATE_TANGENT ? 3 : 1);
        for (; column < end; column++) {
            r->rule[STATES + column] = rules[state->transfer];
            bool splits = state->transfer == TL_TRANSFER_SPLIT;
            for (size_t j = 0; j < r->before.count && splits && !back; j++)
                r->old[j].state[column] /= r->old[j].area;
            for (size_t j = 0; j < r->after.count && splits && back; j++)
                r->now[j].state[column] *= r->now[j].area;
        }
    }
}

/* Turns shear stresses and vectors that a law keeps into the plane of the new points. */
static void turn_into_plane(old_point *old, size_t count, const tl_kind *kind, uint32_t columns,
                            tl_vec3 normal)
{
    for (size_t j = 0; j < count; j++) {
        uint32_t column = 0;
        old[j].shear = into_plane(old[j].shear, old[j].normal, normal);
        for (uint32_t k = 0; kind && k < kind->state_count && column < columns; k++) {
            double *v = &old[j].state[column];
            bool vector = tl_kind_state(kind, k)->kind == TL_STATE_TANGENT;
            column += vector ? 3 : 1;
            if (!vector)
                continue;
            tl_vec3 turned = into_plane(tl_v3(v[0], v[1], v[2]), old[j].normal, normal);
            v[0] = turned.x, v[1] = turned.y, v[2] = turned.z;
        }
    }
}

/* Gives new points what old ones of the same patch carried. */
static void relay_fields(tl_model *m, uint32_t c, relay *r, const totals t[2],
                         const tl_narrow_scratch *scratch)
{
    size_t old_count = r->before.count, count = r->after.count, first = 0;
    tl_ring_cell *cell = scratch->cell;
    const tl_kind *kind = r->states ? kind_of(m, c) : NULL;
    uint32_t columns = m->detect->points.state_columns;
    double place = place_of(m, c);
    while (first + 1 < old_count && tl_v3_norm(tl_v3_sub(r->old[first].arm, t[0].centre)) <= place)
        first++;
    tl_vec3 n = t[1].normal, axis[2] = {tl_v3_sub(r->old[first].arm, t[0].centre)};
    axis[0] = tl_v3_madd(axis[0], -tl_v3_dot(axis[0], n), n);
    axis[0] = tl_v3_norm(axis[0]) > 0 ? tl_v3_unit(axis[0]) : tl_v3_perpendicular(n);
    axis[1] = tl_v3_cross(n, axis[0]);
    tl_vec3 centre = r->match == NEAREST ? t[0].centre : t[1].centre;
    r->before = ring_of(r->old, old_count, t[0].centre, axis, place, cell, &r->spread[0]);
    r->after = ring_of(r->now, count, centre, axis, place, cell + old_count, &r->spread[1]);
    ring_align(&r->before, &r->after);
    r->area[0] = t[0].area;
    r->area[1] = t[1].area;
    r->planes = r->planes && tl_ring_spans(&r->spread[0], t[0].area, place) &&
                (r->match == NEAREST || tl_ring_spans(&r->spread[1], t[1].area, place));
    r->across = scratch->value + old_count;
    for (int column = 0; column < STATES; column++)
        r->rule[column] = PLANE;
    turn_into_plane(r->old, old_count, kind, columns, n);
    rule_states(r, kind, columns, false);
    relay_means(r, scratch->value);
    restore_planes(r, SHEAR, 3);
    for (int column = NORMAL; column < COLUMNS; column++)
        if (r->rule[column] >= PLANE)
            restore_planes(r, column, 1);
    rule_states(r, kind, columns, true);
}

/* ---------------------------------------------------------------- shear carried over ------
 *
 * The shear of a contact, and what becomes of it when its area changes. */

tl_contact_motion tl_contact_moved(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    uint32_t body_a = m->blocks.body[contacts->a[c]], body_b = m->blocks.body[contacts->b[c]];
    const tl_pose *a = &m->bodies.pose[body_a], *b = &m->bodies.pose[body_b];
    tl_vec3 apart = tl_body_apart(&m->bodies, body_a, body_b);
    tl_vec3 way = tl_v3_sub(tl_v3_sub(b->v_moved, tl_v3_cross(b->w_moved, apart)), a->v_moved);
    return (tl_contact_motion){tl_v3_scale(m->dt, way),
                               tl_v3_scale(m->dt, tl_v3_sub(b->w_moved, a->w_moved))};
}

tl_shear tl_shear_of(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    const tl_mat3 *turn = &m->bodies.pose[m->blocks.body[contacts->a[c]]].r;
    tl_shear sum = {0};
    for (size_t k = 0; k < contacts->point_count[c]; k++) {
        size_t i = tl_point_row(contacts, c, k);
        tl_vec3 force = tl_columns_get(p->f_s, i), arm = tl_m3_mul(turn, tl_columns_get(p->p, i));
        sum.area += p->area[i];
        sum.energy += p->area[i] > 0 ? tl_v3_norm2(force) / p->area[i] : 0;
        sum.force = tl_v3_add(sum.force, force);
        sum.moment = tl_v3_add(sum.moment, tl_v3_cross(arm, force));
    }
    return sum;
}

/* Notes as heat what the springs have lost, and half of the work in the last step's motion of the forces that are less: the
 * ledger has the mean of the forces at both ends of a step work, and those of its beginning were still whole. */
static void shear_release(tl_model *m, uint32_t c, const tl_shear *before, const tl_shear *now)
{
    tl_contacts *contacts = &m->detect->contacts;
    uint32_t law = contacts->law[c];
    double ks = law == TL_NO_ROW ? 0 : m->joint_laws[law].ks;
    if (!(ks > 0))
        return;
    if (tl_law_has_own_shear(&m->joint_laws[law])) {
        contacts->handed_over[c] = true;
        return;
    }
    tl_contact_motion moved = tl_contact_moved(m, c);
    double work = tl_v3_dot(tl_v3_sub(before->force, now->force), moved.way) +
                  tl_v3_dot(tl_v3_sub(before->moment, now->moment), moved.turn);
    contacts->released[c] += 0.5 * ((before->energy - now->energy) / ks - work);
}

void tl_shear_resized(tl_model *m, uint32_t c, const tl_shear *before, const tl_shear *resized)
{
    tl_points_table *p = &m->detect->points;
    tl_shear now = *resized;
    double keep = now.area > before->area ? before->area / now.area : 1;
    if (keep * keep * now.energy > before->energy)
        keep = sqrt(before->energy / now.energy);
    for (size_t k = 0; keep < 1 && k < m->detect->contacts.point_count[c]; k++) {
        size_t i = tl_point_row(&m->detect->contacts, c, k);
        tl_columns_put(p->f_s, i, tl_v3_scale(keep, tl_columns_get(p->f_s, i)));
    }
    now.energy *= keep * keep;
    now.force = tl_v3_scale(keep, now.force);
    now.moment = tl_v3_scale(keep, now.moment);
    shear_release(m, c, before, &now);
}

static uint32_t energy_column(const tl_model *m, uint32_t c)
{
    uint32_t law = m->detect->contacts.law[c];
    return law == TL_NO_ROW ? TL_NO_ROW : m->joint_laws[law].energy;
}

double tl_shear_kept(const tl_model *m, uint32_t c)
{
    const tl_points_table *p = &m->detect->points;
    uint32_t column = energy_column(m, c);
    double sum = 0;
    for (size_t k = 0; column < p->state_columns && k < m->detect->contacts.point_count[c]; k++)
        sum += p->state[column][tl_point_row(&m->detect->contacts, c, k)];
    return sum;
}

void tl_shear_keep(tl_model *m, uint32_t c, double energy)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    uint32_t column = energy_column(m, c);
    if (column >= p->state_columns)
        return;
    bool field = tl_facet_is_field(&contacts->facet[c]);
    size_t count = field && contacts->point_count[c] ? 1 : contacts->point_count[c];
    double area = 0;
    for (size_t k = 0; k < count; k++)
        area += p->area[tl_point_row(contacts, c, k)];
    for (size_t k = 0; k < count && area > 0; k++) {
        size_t i = tl_point_row(contacts, c, k);
        p->state[column][i] = energy * (p->area[i] / area);
    }
    contacts->released[c] += area > 0 ? 0 : energy;
}

/* ---------------------------------------------------------------- shear ------------------- */

/* Points' shear stresses become `keep` times what they are and a uniform traction and a twist. */
static void add_traction(old_point *point, size_t count, const totals *now, double keep,
                         tl_vec3 traction, double twist)
{
    for (size_t k = 0; k < count; k++) {
        tl_vec3 arm = tl_v3_sub(point[k].arm, now->centre);
        tl_vec3 stress = tl_v3_madd(traction, twist, tl_v3_cross(now->normal, arm));
        stress = tl_v3_madd(stress, keep, point[k].shear);
        point[k].shear = tl_v3_madd(stress, -tl_v3_dot(stress, point[k].normal), point[k].normal);
    }
}

/* Brings the energy of the shear springs down to `most`. Of all stresses of the same force and torsion a uniform traction
 * with a twist has the least energy, and what else there is has an energy of its own: that is made less. */
static void limit_energy(old_point *point, size_t count, totals *now, double most, bool turns)
{
    sum_shear(point, count, now);
    if (!(now->energy > most))
        return;
    double twist = turns ? now->torsion / now->polar : 0;
    double least = tl_v3_norm2(now->shear) / now->area + twist * twist * now->polar;
    double rest = now->energy - least, keep = sqrt(fmax(0, most - least) / fmax(rest, DBL_MIN));
    keep = fmin(keep, 1);
    add_traction(point, count, now, keep, tl_v3_scale((1 - keep) / now->area, now->shear),
                 (1 - keep) * twist);
    sum_shear(point, count, now);
    if (now->energy > most) { /* a torsion too large for it */
        add_traction(point, count, now, sqrt(most / now->energy), tl_v3(0, 0, 0), 0);
        sum_shear(point, count, now);
    }
}

/* Brings shear force and torsion to what they are to be: what comes into contact brings none, what goes takes its own with it; a
 * twist goes with the second moment of area as traction does with the area. The springs get no more energy than there was. */
static void correct_shear(old_point *point, size_t count, totals *now, const totals *before,
                          bool turns)
{
    sum_shear(point, count, now);
    double area = fmin(1, now->area / before->area);
    double polar = before->polar > 0 ? fmin(1, now->polar / before->polar) : 1;
    tl_vec3 want = tl_v3_scale(area, tl_v3_turn(before->shear, before->normal, now->normal));
    tl_vec3 force = tl_v3_sub(want, now->shear);
    double twist = turns ? (polar * before->torsion - now->torsion) / now->polar : 0;
    add_traction(point, count, now, 1, tl_v3_scale(1 / now->area, force), twist);
    limit_energy(point, count, now, before->energy, turns);
}

/* Notes what has become of the shear. */
static void release(tl_model *m, uint32_t c, const totals *before, const totals *now, bool reframed)
{
    tl_shear old = {.energy = before->energy, .force = before->shear, .moment = before->moment};
    tl_shear fresh = {.energy = now->energy, .force = now->shear, .moment = now->moment};
    if (reframed) /* the last step's motion was that of other bodies */
        fresh.force = old.force, fresh.moment = old.moment;
    shear_release(m, c, &old, &fresh);
}

/* ---------------------------------------------------------------- new contacts ------------ */

/* What slip has opened at points of other places than the law's states are of is not what it has opened there: the references make up
 * for it, so that what was between the points of the whole is between the walls. */
static void refer_to_openings(tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    tl_points_table *p = &m->detect->points;
    double opening[TL_LANES];
    if (!p->reference || !tl_contact_opens(m, c))
        return;
    for (size_t first = 0; first < contacts->point_count[c]; first += TL_LANES) {
        tl_contact_point_openings(m, c, first, opening);
        for (size_t l = 0; l < TL_LANES && first + l < contacts->point_count[c]; l++)
            p->reference[tl_point_row(contacts, c, first + l)] += opening[l];
    }
}

/* A contact that was made for parts of a block takes its share over of what that of the whole carried: the stresses at its own
 * points. Where the area has become more than that of the estate, of which nothing is known, it carries no more than there was. */
static void take_share(tl_model *m, uint32_t c, const tl_estate *estate,
                       const tl_narrow_scratch *scratch)
{
    size_t old_count = estate->count, count = m->detect->contacts.point_count[c];
    old_point *old = scratch->old, *fresh = old + old_count;
    for (size_t k = 0; k < old_count; k++)
        old[k] = tl_estate_point(m, estate, c, k);
    const totals t[2] = {totals_of(old, old_count), totals_of(fresh, count)};
    relay r = {.old = old,
               .now = fresh,
               .before.count = old_count,
               .after.count = count,
               .planes = !estate->reframed,
               .states = tl_estate_is_of_law(m, estate, c),
               .match = NEAREST};
    relay_fields(m, c, &r, t, scratch);
    double keep = t[0].area < t[1].area ? t[0].area / t[1].area : 1;
    for (size_t k = 0; k < count; k++) {
        fresh[k].shear = tl_v3_scale(keep, fresh[k].shear);
        fresh[k].f_n *= keep;
        fresh[k].n0 *= keep;
        fresh[k].flags = r.states ? fresh[k].flags : 0;
    }
    write_points(m, c, fresh);
    refer_to_openings(m, c);
    tl_shear_keep(m, c, tl_estate_kept(m, estate, c));
}

/* The points of a new contact. */
static bool begin_points(tl_model *m, uint32_t c, tl_narrow_scratch *scratch,
                         const tl_point_lanes *lanes)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_manifold *g = &scratch->manifold;
    const tl_estate *estate = tl_estate_on(m, contacts->a[c], contacts->b[c], &g->facet);
    size_t old_count = estate ? estate->count : 0;
    if (!reserve(scratch, old_count + g->point_count))
        return false;
    place_points(m, c, g, lanes, scratch->old + old_count);
    if (estate && g->point_count > 0) {
        take_share(m, c, estate, scratch);
        return true;
    }
    double size = fmin(m->blocks.size[contacts->a[c]], m->blocks.size[contacts->b[c]]);
    for (size_t k = 0; k < g->point_count; k++)
        m->detect->points.flags[tl_point_row(contacts, c, k)] =
            lanes->closure[k] < -TL_STILL * size ? TL_POINT_APART : 0;
    return true;
}

bool tl_contact_transfer(tl_model *m, uint32_t c, tl_narrow_scratch *scratch,
                         const tl_point_lanes *lanes)
{
    const tl_manifold *g = &scratch->manifold;
    size_t old_count = m->detect->contacts.point_count[c], count = g->point_count;
    if (old_count == 0)
        return begin_points(m, c, scratch, lanes);
    if (!reserve(scratch, old_count + count))
        return false;
    old_point *old = scratch->old, *fresh = old + old_count;
    tl_contact_places(m, c, lanes); /* old points have gone along with A, in whose frame they are */
    read_points(m, c, lanes, old);
    double kept = tl_shear_kept(m, c);
    place_points(m, c, g, lanes, fresh);
    totals t[2] = {totals_of(old, old_count), totals_of(fresh, count)};
    sum_shear(old, old_count, &t[0]);
    if (count > 0 && t[0].area > 0) {
        relay r = {.old = old,
                   .now = fresh,
                   .before.count = old_count,
                   .after.count = count,
                   .planes = !scratch->reframed,
                   .states = true,
                   .match = scratch->reframed ? BY_KEY : BY_AREA};
        relay_fields(m, c, &r, t, scratch);
        correct_shear(fresh, count, &t[1], &t[0], r.planes);
    }
    write_points(m, c, fresh);
    tl_shear_keep(m, c, kept);
    release(m, c, &t[0], &t[1], scratch->reframed);
    return true;
}
