/* box_tree.c - which of many boxes hold a point, or meet another box.
 *
 * The boxes are sorted by their middles along the longest side of what they span, and halved, again and again. Range k
 * has the halves 2 k + 1 and 2 k + 2. */
#include "geometry/box_tree.h"

#include "geometry/measure.h"

#include <math.h>
#include <stdlib.h>

/* Cost only: ranges of so few boxes are not halved. */
#define FEW 4

/* A range of boxes, [begin, end) of the order. */
typedef struct range {
    uint32_t number, begin, end;
} range;

/* Most ranges that wait to be halved: one for each halving of 2^32 boxes. */
#define DEEPEST 40

typedef struct middle {
    double at;
    uint32_t box;
} middle;

static int by_middle(const void *a, const void *b)
{
    const middle *x = a, *y = b;
    if (x->at < y->at || x->at > y->at)
        return x->at < y->at ? -1 : 1;
    return (x->box > y->box) - (x->box < y->box);
}

static tl_bounds united(tl_bounds a, const tl_bounds *b)
{
    return (tl_bounds){{fmin(a.min.x, b->min.x), fmin(a.min.y, b->min.y), fmin(a.min.z, b->min.z)},
                       {fmax(a.max.x, b->max.x), fmax(a.max.y, b->max.y), fmax(a.max.z, b->max.z)}};
}

static void sort_range(tl_box_tree *t, middle *list, const range *r)
{
    const tl_bounds *all = &t->all[r->number];
    const double side[3] = {all->max.x - all->min.x, all->max.y - all->min.y, all->max.z - all->min.z};
    const int axis = side[0] >= side[1] && side[0] >= side[2] ? 0 : side[1] >= side[2] ? 1 : 2;
    for (uint32_t k = r->begin; k < r->end; k++) {
        const tl_bounds *b = &t->box[t->order[k]];
        list[k].box = t->order[k];
        list[k].at = axis == 0 ? b->min.x + b->max.x : axis == 1 ? b->min.y + b->max.y : b->min.z + b->max.z;
    }
    qsort(list + r->begin, r->end - r->begin, sizeof *list, by_middle);
    for (uint32_t k = r->begin; k < r->end; k++)
        t->order[k] = list[k].box;
}

static uint32_t half_of(const range *r)
{
    return r->begin + (r->end - r->begin) / 2;
}

bool tl_box_tree_make(tl_box_tree *t, const tl_bounds *box, uint32_t count)
{
    range todo[DEEPEST] = {{0, 0, count}};
    int left = 1;
    /* ranges of one level differ by one box at the most: the last number is below 2^(levels + 1) */
    size_t ranges = 1;
    while (ranges < count)
        ranges *= 2;
    middle *list = malloc(((size_t)count + 1) * sizeof *list);
    *t = (tl_box_tree){.box = box,
                       .count = count,
                       .order = malloc(((size_t)count + 1) * sizeof *t->order),
                       .all = malloc(2 * ranges * sizeof *t->all)};
    const bool enough = list && t->order && t->all;
    for (uint32_t k = 0; enough && k < count; k++)
        t->order[k] = k;
    while (enough && count > 0 && left > 0) {
        const range r = todo[--left];
        t->all[r.number] = box[t->order[r.begin]];
        for (uint32_t k = r.begin; k < r.end; k++)
            t->all[r.number] = united(t->all[r.number], &box[t->order[k]]);
        if (r.end - r.begin <= FEW)
            continue;
        sort_range(t, list, &r);
        todo[left++] = (range){2 * r.number + 2, half_of(&r), r.end};
        todo[left++] = (range){2 * r.number + 1, r.begin, half_of(&r)};
    }
    free(list);
    if (!enough)
        tl_box_tree_free(t);
    return enough;
}

void tl_box_tree_free(tl_box_tree *t)
{
    free(t->order);
    free(t->all);
    *t = (tl_box_tree){0};
}

void tl_box_tree_meet(const tl_box_tree *t, const tl_bounds *with, void (*fn)(void *user, uint32_t box), void *user)
{
    range todo[DEEPEST] = {{0, 0, t->count}};
    int left = t->count > 0;
    while (left > 0) {
        const range r = todo[--left];
        if (!tl_bounds_meet(&t->all[r.number], with))
            continue;
        if (r.end - r.begin > FEW) {
            todo[left++] = (range){2 * r.number + 2, half_of(&r), r.end};
            todo[left++] = (range){2 * r.number + 1, r.begin, half_of(&r)};
            continue;
        }
        for (uint32_t k = r.begin; k < r.end; k++)
            if (tl_bounds_meet(&t->box[t->order[k]], with))
                fn(user, t->order[k]);
    }
}

void tl_box_tree_ask(const tl_box_tree *t, tl_vec3 at, void (*fn)(void *user, uint32_t box), void *user)
{
    tl_box_tree_meet(t, &(tl_bounds){at, at}, fn, user);
}
