/* relay.c - elements that are placed again where blocks have changed or slid.
 *
 * Kinds with `lays_again` lie on what blocks have in common, such as walls of joints. They place again when blocks have
 * come, gone or been cut. So they do when two blocks of one element have slid by SLID of their size. All calls of
 * such a kind are repeated, the last one first. Of elements with one key that of the last call counts. An element
 * keeps the number, states and flags of the one that had its key; its nodes take those of the nearest old node on the
 * same block. An element with a new key takes those of the nearest old one of its call, between three nodes linearly.
 * States that are RESET are those that `place` gives. One of the whole that is SPLIT goes with the weights of the
 * nodes. It comes from the old element with the key, or else from that whose middle is nearest. Where nothing has moved
 * all are the same to the bit. */
#include "element/relay.h"

#include "base/columns.h"
#include "base/error.h"
#include "element/carry.h"
#include "element/life.h"
#include "element/place.h"
#include "element/steady.h"
#include "element/together.h"
#include "plugin/loader.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Tolerance: how far two blocks of an element have slid against each other, over the smaller one's size, when it is
 * placed again. */
#define SLID 1e-3

/* Cost only: steps after which it is looked at how far blocks have slid. */
#define LOOK_EVERY 16

/* ---------------------------------------------------------------- when ------------------- */

/* Whether the first and last node of an element, that have gone apart by `way`, have done so far enough. */
static bool is_far(const tl_model *m, size_t row, tl_vec3 way)
{
    const struct tl_elements *e = m->elements;
    const tl_node_table *n = &e->nodes;
    const uint32_t a = e->table.node_begin[row], b = a + e->table.node_count[row] - 1;
    double size = INFINITY;
    for (int k = 0; k < 2; k++) {
        const uint32_t block = tl_block_row_quiet(m, n->block[k ? b : a]);
        size = block == TL_NO_ROW ? size : fmin(size, m->blocks.size[block]);
    }
    return tl_v3_norm2(way) > SLID * SLID * size * size;
}

/* Whether they had when they were asked for their forces, and still have. What has just been placed again has not: its
 * nodes then have the motion of the last step, but lie where they were placed. `*calm` becomes false if they had. */
static bool has_slid(const tl_model *m, size_t row, bool *calm)
{
    const struct tl_elements *e = m->elements;
    const tl_node_table *n = &e->nodes;
    const uint32_t a = e->table.node_begin[row], b = a + e->table.node_count[row] - 1;
    if (!is_far(m, row, tl_v3_sub(tl_columns_get(n->u, b), tl_columns_get(n->u, a))))
        return false;
    *calm = false;
    return is_far(m, row, tl_v3_sub(tl_node_moved(m, b), tl_node_moved(m, a)));
}

static bool is_due(tl_model *m)
{
    struct tl_elements *e = m->elements;
    bool due = false, calm = true;
    for (size_t k = 0; k < e->set_count && !due; k++)
        due = tl_element_ops_of(&e->set[k])->lays_again && e->set[k].structure != m->structure;
    if (due || m->cycles % LOOK_EVERY != 0 || e->looked == e->asked)
        return due;
    for (size_t row = 0; row < e->table.table.rows && !due; row++)
        due = tl_element_ops_of(&e->set[e->table.set[row]])->lays_again && has_slid(m, row, &calm);
    e->looked = calm ? e->asked : 0; /* their motions change only where they are asked for forces or placed */
    return due;
}

/* ---------------------------------------------------------------- keys ------------------- */

static int compare_keys(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Keys that are taken, ascending. */
typedef struct keys {
    uint64_t *at;
    size_t count, capacity;
} keys;

static bool is_taken(const keys *k, uint64_t key)
{
    return key && k->count && bsearch(&key, k->at, k->count, sizeof key, compare_keys);
}

/* Takes the keys of what has been placed, and leaves out what has a key that was taken before: where all keys of a call
 * were, what has none, too. */
static bool take_keys(keys *k, tl_placing *p)
{
    size_t kept = 0, keyed = 0;
    for (size_t i = 0; i < p->placed_count; i++)
        if (!is_taken(k, p->placed[i].key)) {
            keyed += p->placed[i].key != 0;
            p->placed[kept++] = p->placed[i];
        }
    p->placed_count = kept = keyed == 0 && kept < p->placed_count ? 0 : kept;
    if (!tl_grow(&k->at, &k->capacity, k->count + kept + 1, sizeof *k->at))
        return false;
    for (size_t i = 0; i < kept; i++)
        k->at[k->count++] = p->placed[i].key;
    qsort(k->at, k->count, sizeof *k->at, compare_keys);
    return true;
}

/* Elements without a key go, too, where all of their call that had one have gone: `number` of a set is scratch. */
static void leave_rest(struct tl_elements *e, size_t first, unsigned char *keep)
{
    const tl_element_table *t = &e->table;
    for (size_t k = 0; k < e->set_count; k++)
        e->set[k].number = 0;
    for (size_t row = 0; row < first; row++) /* 1: some have gone; 2: some stay */
        e->set[t->set[row]].number |= !keep[row] ? 1 : t->key[row] ? 2 : 0;
    for (size_t row = 0; row < first; row++)
        if (e->set[t->set[row]].number == 1)
            keep[row] = 0;
}

bool tl_elements_give_way(struct tl_elements *e, size_t first)
{
    const tl_element_table *t = &e->table;
    const size_t rows = t->table.rows;
    const char *plugin = tl_plugin_id(e->set[t->set[first]].kind);
    keys taken = {0};
    unsigned char *keep = malloc(rows + 1);
    const bool enough = keep && tl_grow(&taken.at, &taken.capacity, rows - first + 1, sizeof *taken.at);
    for (size_t row = first; row < rows && enough; row++)
        taken.at[taken.count++] = t->key[row];
    if (enough && taken.count > 1)
        qsort(taken.at, taken.count, sizeof *taken.at, compare_keys);
    for (size_t row = 0; row < rows && enough; row++)
        keep[row] = row >= first || !tl_element_ops_of(&e->set[t->set[row]])->lays_again ||
                    strcmp(tl_plugin_id(e->set[t->set[row]].kind), plugin) != 0 || !is_taken(&taken, t->key[row]);
    if (enough)
        leave_rest(e, first, keep);
    if (enough)
        tl_elements_keep(e, keep, false);
    free(taken.at);
    free(keep);
    return enough;
}

/* ---------------------------------------------------------------- states ----------------- */

/* A row of an element that was, by its set and key. */
typedef struct old_one {
    uint32_t set, row;
    uint64_t key;
} old_one;

static int compare_old(const void *a, const void *b)
{
    const old_one *x = a, *y = b;
    if (x->set != y->set)
        return x->set < y->set ? -1 : 1;
    return (x->key > y->key) - (x->key < y->key);
}

/* The node of an old element on the same block that is nearest to a new one; TL_NO_ROW: none is. */
static uint32_t nearest_node(const tl_node_table *n, uint32_t row, uint32_t begin, uint32_t end)
{
    uint32_t best = TL_NO_ROW;
    double least = INFINITY;
    for (uint32_t k = begin; k < end; k++) {
        const double far = tl_v3_norm2(tl_v3_sub(tl_node_place(n, k), tl_node_place(n, row)));
        if (n->block[k] == n->block[row] && far < least) {
            least = far;
            best = k;
        }
    }
    return best;
}

/* How column `column` of the states of a kind, of nodes or of the whole, passes to elements that are placed again. */
static uint32_t transfer_of(const tl_kind *kind, uint32_t column, bool whole)
{
    for (uint32_t k = 0; k < kind->state_count; k++)
        if ((kind->states[k].kind == TL_STATE_WHOLE) == whole && column-- == 0)
            return kind->states[k].transfer;
    return TL_TRANSFER_RESET; /* the kind has fewer */
}

/* Which columns pass; of the whole also which are shared. */
typedef struct passing {
    bool node[TL_ELEMENT_COLUMNS], whole[TL_ELEMENT_COLUMNS], split[TL_ELEMENT_COLUMNS];
} passing;

static passing passing_of(const tl_kind *kind)
{
    passing p;
    for (uint32_t k = 0; k < TL_ELEMENT_COLUMNS; k++) {
        p.node[k] = transfer_of(kind, k, false) == TL_TRANSFER_COPY;
        p.whole[k] = transfer_of(kind, k, true) == TL_TRANSFER_COPY;
        p.split[k] = transfer_of(kind, k, true) == TL_TRANSFER_SPLIT;
    }
    return p;
}

/* Gives an element what an old one with its key had, and its number. Blocks have moved since forces were last asked
 * for: nodes are given that motion for the step to come. */
static void inherit(tl_model *m, uint32_t row, uint32_t from)
{
    struct tl_elements *e = m->elements;
    tl_element_table *t = &e->table;
    tl_node_table *n = &e->nodes;
    const passing pass = passing_of(e->set[t->set[row]].kind);
    t->id[row] = t->id[from];
    t->flags[row] = t->flags[from] & ~(uint32_t)TL_ELEMENT_DETACHED;
    t->stored[row] = t->stored[from];
    for (uint32_t k = 0; k < t->state_columns; k++)
        if (pass.whole[k])
            t->state[k][row] = t->state[k][from];
    for (uint32_t k = t->node_begin[row]; k < t->node_begin[row] + t->node_count[row]; k++) {
        const uint32_t old = nearest_node(n, k, t->node_begin[from], t->node_begin[from] + t->node_count[from]);
        for (uint32_t c = 0; old != TL_NO_ROW && c < n->state_columns; c++)
            if (pass.node[c])
                n->state[c][k] = n->state[c][old];
        for (int c = 0; old != TL_NO_ROW && c < 3; c++)
            n->force[c][k] = n->weight[old] > 0 ? n->force[c][old] * (n->weight[k] / n->weight[old]) : 0;
        if (old != TL_NO_ROW)
            tl_columns_put(n->u, k, tl_v3_sub(tl_columns_get(n->u, old), tl_node_moved(m, old)));
    }
}

/* An old node or the middle of an old element, by the set of that and a coordinate. */
typedef struct old_place {
    uint32_t set, node, row;
    tl_vec3 at;
} old_place;

static int compare_places(const void *a, const void *b)
{
    const old_place *p = a, *q = b;
    if (p->set != q->set)
        return p->set < q->set ? -1 : 1;
    if (p->at.x != q->at.x)
        return p->at.x < q->at.x ? -1 : 1;
    return (p->node > q->node) - (p->node < q->node);
}

/* Places of elements before some row, in the order of compare_places. */
typedef struct old_places {
    old_place *at;
    size_t count;
} old_places;

static tl_vec3 middle_of(const struct tl_elements *e, uint32_t row)
{
    const uint32_t begin = e->table.node_begin[row], count = e->table.node_count[row];
    tl_vec3 sum = {0, 0, 0};
    for (uint32_t k = begin; k < begin + count; k++)
        sum = tl_v3_add(sum, tl_node_place(&e->nodes, k));
    return tl_v3_scale(1.0 / count, sum);
}

/* Lists all nodes, or middles. */
static bool list_places(const struct tl_elements *e, uint32_t first, bool middles, old_places *list)
{
    const tl_element_table *t = &e->table;
    const size_t nodes = first ? t->node_begin[first - 1] + t->node_count[first - 1] : 0;
    list->at = malloc(((middles ? first : nodes) + 1) * sizeof *list->at);
    for (uint32_t row = 0; row < first && list->at; row++) {
        if (middles)
            list->at[list->count++] = (old_place){t->set[row], row, row, middle_of(e, row)};
        for (uint32_t k = t->node_begin[row]; k < t->node_begin[row] + t->node_count[row] && !middles; k++)
            list->at[list->count++] = (old_place){t->set[row], k, row, tl_node_place(&e->nodes, k)};
    }
    if (list->count > 1)
        qsort(list->at, list->count, sizeof *list->at, compare_places);
    return list->at != NULL;
}

/* The one of a set that is nearest to a place, the first of several; NULL: the set has none. Those whose x is farther
 * off than the nearest so far are not looked at. */
static const old_place *nearest_of_set(const old_places *list, uint32_t set, tl_vec3 place)
{
    const old_place sought = {set, 0, 0, place}, *best = NULL;
    size_t low = 0, high = list->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare_places(&list->at[middle], &sought) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    double least = INFINITY;
    for (int way = -1; way <= 1; way += 2)
        for (size_t i = way > 0 ? low : low - 1; i < list->count && list->at[i].set == set; i += (size_t)way) {
            const old_place *of = &list->at[i];
            if ((of->at.x - place.x) * (of->at.x - place.x) > least)
                break;
            const double far = tl_v3_norm2(tl_v3_sub(of->at, place));
            if (far < least || (far == least && of->node < best->node)) {
                least = far;
                best = of;
            }
        }
    return best;
}

/* Tolerance: how far off the plane of three old nodes a new one lies at most that takes its states from all three, over
 * their distance. Test: lua/test_water. */
#define IN_PLANE 1e-3

/* Limit: how far off 1/2 parts of three nodes are at a place that takes its states from them. On a triangle whose
 * pressure three inner nodes integrate they are so by 1.5. */
#define FARTHEST_PART 1.6

/* Three nodes, and the parts of each by which a state that is linear between them is found at a place. */
typedef struct between {
    uint32_t node[3];
    double part[3];
} between;

/* The three nodes that an old element has on the wall of one of them; false: it has more or fewer, they lie in a line,
 * or the place is off their plane. */
static bool find_between(const tl_model *m, uint32_t row, uint32_t one, uint32_t k, between *of)
{
    const struct tl_elements *e = m->elements;
    const tl_node_table *n = &e->nodes;
    const tl_vec3 outward = tl_node_normal(m, one);
    uint32_t count = 0;
    for (uint32_t i = e->table.node_begin[row]; i < e->table.node_begin[row] + e->table.node_count[row]; i++)
        if (tl_v3_dot(tl_node_normal(m, i), outward) > 0) {
            if (count < 3)
                of->node[count] = i;
            count++;
        }
    if (count != 3)
        return false;
    const tl_vec3 from = tl_node_place(n, of->node[0]);
    const tl_vec3 a = tl_v3_sub(tl_node_place(n, of->node[1]), from),
                  b = tl_v3_sub(tl_node_place(n, of->node[2]), from);
    const tl_vec3 d = tl_v3_sub(tl_node_place(n, k), from), normal = tl_v3_cross(a, b);
    const double area2 = tl_v3_norm2(normal), size2 = fmax(tl_v3_norm2(a), tl_v3_norm2(b));
    const double off = tl_v3_dot(d, normal);
    if (!(area2 > IN_PLANE * IN_PLANE * size2 * size2) || off * off > IN_PLANE * IN_PLANE * size2 * area2)
        return false;
    of->part[1] = tl_v3_dot(tl_v3_cross(d, b), normal) / area2;
    of->part[2] = tl_v3_dot(tl_v3_cross(a, d), normal) / area2;
    of->part[0] = 1 - of->part[1] - of->part[2];
    return fmax(fabs(of->part[0] - 0.5), fmax(fabs(of->part[1] - 0.5), fabs(of->part[2] - 0.5))) < FARTHEST_PART;
}

/* The nodes of an element that has no older one get states from the old element of its set that has the nearest node.
 * It may be on any blocks: parts of blocks that were cut have other names. In the plane of three nodes states go on
 * linearly. So the parts of a wall are pressed as the whole was. */
static void inherit_near(tl_model *m, const old_places *list, uint32_t row)
{
    struct tl_elements *e = m->elements;
    const tl_element_table *t = &e->table;
    tl_node_table *n = &e->nodes;
    const passing pass = passing_of(e->set[t->set[row]].kind);
    for (uint32_t k = t->node_begin[row]; k < t->node_begin[row] + t->node_count[row]; k++) {
        const old_place *best = nearest_of_set(list, t->set[row], tl_node_place(n, k));
        between three = {{0}, {0}};
        const bool linear = best && find_between(m, best->row, best->node, k, &three);
        for (uint32_t c = 0; best && c < n->state_columns; c++) {
            double *state = n->state[c];
            if (!pass.node[c])
                continue;
            state[k] = linear ? three.part[0] * state[three.node[0]] + three.part[1] * state[three.node[1]] +
                                    three.part[2] * state[three.node[2]]
                              : state[best->node];
        }
    }
}

/* What the nodes of an element stand for together. */
static double weight_of(const struct tl_elements *e, uint32_t row)
{
    double sum = 0;
    for (uint32_t k = e->table.node_begin[row]; k < e->table.node_begin[row] + e->table.node_count[row]; k++)
        sum += e->nodes.weight[k];
    return sum;
}

/* Gives an element its part of the states of an old one that are SPLIT. */
static void take_part(struct tl_elements *e, uint32_t row, uint32_t old)
{
    tl_element_table *t = &e->table;
    const passing pass = passing_of(e->set[t->set[row]].kind);
    const double had = weight_of(e, old), part = had > 0 ? weight_of(e, row) / had : 0;
    for (uint32_t k = 0; k < t->state_columns; k++)
        if (pass.split[k])
            t->state[k][row] = part * t->state[k][old];
}

/* Lets new elements, rows from `first` on, inherit from those before. false: out of memory. */
static bool inherit_all(tl_model *m, uint32_t first)
{
    struct tl_elements *e = m->elements;
    const tl_element_table *t = &e->table;
    old_one *list = malloc((first + (size_t)1) * sizeof *list);
    old_places nodes = {NULL, 0}, middles = {NULL, 0};
    const bool enough = list && list_places(e, first, false, &nodes) && list_places(e, first, true, &middles);
    for (uint32_t row = 0; enough && row < first; row++)
        list[row] = (old_one){t->set[row], row, t->key[row]};
    if (enough && first > 1)
        qsort(list, first, sizeof *list, compare_old);
    for (uint32_t row = first; enough && row < t->table.rows; row++) {
        const old_one sought = {t->set[row], row, t->key[row]};
        const old_one *found = first && t->key[row] ? bsearch(&sought, list, first, sizeof *list, compare_old) : NULL;
        const old_place *near = found ? NULL : nearest_of_set(&middles, t->set[row], middle_of(e, row));
        if (found)
            inherit(m, row, found->row);
        else
            inherit_near(m, &nodes, row);
        if (found || near)
            take_part(e, row, found ? found->row : near->row);
    }
    void *const owned[] = {list, nodes.at, middles.at};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++)
        free(owned[k]);
    return enough;
}

/* ---------------------------------------------------------------- order ------------------ */

/* A row, by the number of its element. */
typedef struct numbered {
    tl_id id;
    uint32_t row;
} numbered;

static int compare_ids(const void *a, const void *b)
{
    const tl_id x = ((const numbered *)a)->id, y = ((const numbered *)b)->id;
    return (x > y) - (x < y);
}

/* Room to sort the rows that there are: NULL when out of memory. */
static numbered *room_to_sort(struct tl_elements *e)
{
    numbered *list = malloc((e->table.table.rows + 1) * sizeof *list);
    if (list && tl_table_reserve(&e->table.table, 2 * e->table.table.rows) &&
        tl_table_reserve(&e->nodes.table, 2 * e->nodes.table.rows))
        return list;
    free(list);
    return NULL;
}

/* Puts elements, and their nodes, in the order of their numbers, behind the others, and then moves them down. */
static void sort_rows(struct tl_elements *e, numbered *list)
{
    tl_element_table *t = &e->table;
    const uint32_t rows = (uint32_t)t->table.rows, nodes = (uint32_t)e->nodes.table.rows;
    uint32_t next = nodes;
    for (uint32_t row = 0; row < rows; row++)
        list[row] = (numbered){t->id[row], row};
    if (rows > 1)
        qsort(list, rows, sizeof *list, compare_ids);
    tl_table_resize(&t->table, 2 * (size_t)rows); /* there is room */
    tl_table_resize(&e->nodes.table, 2 * (size_t)nodes);
    for (uint32_t i = 0; i < rows; i++) {
        const uint32_t begin = t->node_begin[list[i].row];
        tl_table_move(&t->table, rows + i, list[i].row);
        t->node_begin[rows + i] = next - nodes;
        for (uint32_t k = 0; k < t->node_count[rows + i]; k++, next++)
            tl_table_move(&e->nodes.table, next, begin + k);
    }
    for (uint32_t i = 0; i < rows; i++)
        tl_table_move(&t->table, i, rows + i);
    for (uint32_t i = 0; i < nodes; i++)
        tl_table_move(&e->nodes.table, i, nodes + i);
    tl_table_resize(&t->table, rows);
    tl_table_resize(&e->nodes.table, nodes);
}

/* ---------------------------------------------------------------- again ------------------ */

/* Asks all sets that are placed again, the last one first. */
static tl_status ask_all(tl_model *m, tl_placing *of)
{
    struct tl_elements *e = m->elements;
    keys taken = {0};
    tl_status status = TL_OK;
    for (size_t k = e->set_count; k-- > 0 && status == TL_OK;) {
        if (!tl_element_ops_of(&e->set[k])->lays_again)
            continue;
        of[k].host.again = 1;
        status = tl_placing_ask(&of[k], &e->set[k], 0);
        if (status == TL_OK && !take_keys(&taken, &of[k]))
            status = tl_fail_memory(&m->error);
    }
    free(taken.at);
    return status;
}

/* Puts new elements in the place of old ones. */
static tl_status replace(tl_model *m, tl_placing *of, unsigned char *keep)
{
    struct tl_elements *e = m->elements;
    const uint32_t before = (uint32_t)e->table.table.rows;
    const size_t nodes = e->nodes.table.rows;
    tl_status status = TL_OK;
    tl_steady_let_go(m);
    for (size_t k = 0; k < e->set_count && status == TL_OK; k++)
        status = tl_placing_commit(&of[k], (uint32_t)k);
    numbered *list = status == TL_OK ? room_to_sort(e) : NULL;
    if (status == TL_OK && !(list && inherit_all(m, before)))
        status = tl_fail_memory(&m->error);
    if (status == TL_OK)
        status = tl_elements_together(m, before, false);
    if (status != TL_OK) {
        free(list);
        tl_table_resize(&e->table.table, before);
        tl_table_resize(&e->nodes.table, nodes);
        return status;
    }
    for (size_t row = 0; row < e->table.table.rows; row++)
        keep[row] = row >= before || !tl_element_ops_of(&e->set[e->table.set[row]])->lays_again;
    for (size_t k = 0; k < e->set_count; k++)
        e->set[k].structure = m->structure;
    tl_elements_keep(e, keep, false);
    sort_rows(e, list);
    free(list);
    return TL_OK;
}

tl_status tl_elements_lay_again(tl_model *m)
{
    struct tl_elements *e = m->elements;
    if (!is_due(m))
        return TL_OK;
    tl_placing *of = calloc(e->set_count + 1, sizeof *of);
    size_t rows = e->table.table.rows;
    tl_status status = of ? TL_OK : tl_fail_memory(&m->error);
    for (size_t k = 0; of && k < e->set_count; k++)
        tl_placing_begin(&of[k], m, NULL);
    if (status == TL_OK)
        status = ask_all(m, of);
    for (size_t k = 0; of && k < e->set_count; k++)
        rows += of[k].placed_count;
    unsigned char *keep = status == TL_OK ? malloc(rows + 1) : NULL;
    if (status == TL_OK)
        status = keep ? replace(m, of, keep) : tl_fail_memory(&m->error);
    for (size_t k = 0; of && k < e->set_count; k++)
        tl_placing_free(&of[k]);
    free(keep);
    free(of);
    return status;
}
