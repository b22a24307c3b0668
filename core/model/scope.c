/* scope.c - which contacts a law is for, and which of the laws for a contact rules it.
 *
 * A law is for the contacts of a joint: for all, or for those with one block that it names, or with two. Blocks are
 * named by a group, which is looked up when it is asked for, or by a list of ids. Ids are never used again, so lists
 * need not hear of blocks that are deleted. Parts of a block that is cut have new ids, which are added.
 *
 * The law that names more rules a contact: first by how many of the two blocks it names, then by how closely it names
 * the joint (plane, set, "*"), then the later one. */
#include "model/scope.h"

#include "base/inside.h"
#include "model/joints.h"
#include "model/options.h"
#include "model/rows.h"

#include <stdlib.h>
#include <string.h>
#include <talus/fields.h>
#include <talus/number.h>

/* ---------------------------------------------------------------- sets of ids ------------- */

static bool widen(tl_id_set *set, tl_id end)
{
    const size_t words = (size_t)end / 64 + 1;
    if (words <= set->words)
        return true;
    uint64_t *word = realloc(set->word, words * sizeof *word);
    if (!word)
        return false;
    memset(word + set->words, 0, (words - set->words) * sizeof *word);
    *set = (tl_id_set){word, words};
    return true;
}

static void put_id(tl_id_set *set, tl_id id)
{
    set->word[id / 64] |= (uint64_t)1 << (id % 64);
}

bool tl_id_set_of(const tl_id *ids, size_t count, tl_id_set *out)
{
    tl_id last = 0;
    for (size_t i = 0; i < count; i++)
        last = ids[i] > last ? ids[i] : last;
    *out = (tl_id_set){NULL, 0};
    if (!widen(out, last))
        return false;
    for (size_t i = 0; i < count; i++)
        put_id(out, ids[i]);
    return true;
}

size_t tl_id_set_living(const tl_model *m, const tl_id_set *set, tl_id *ids)
{
    size_t count = 0;
    for (size_t row = 0; row < m->blocks.table.rows; row++)
        if (m->blocks.stays[row] && tl_id_set_has(set, m->blocks.id[row])) {
            if (ids)
                ids[count] = m->blocks.id[row];
            count++;
        }
    return count;
}

/* Whether two sets have the same ids. One may have more words, of zeros. */
static bool same_ids(const tl_id_set *one, const tl_id_set *other)
{
    const size_t words = one->words > other->words ? one->words : other->words;
    for (size_t i = 0; i < words; i++)
        if ((i < one->words ? one->word[i] : 0) != (i < other->words ? other->word[i] : 0))
            return false;
    return true;
}

/* ---------------------------------------------------------------- pairs ------------------- */

static uint64_t pair_of(tl_id a, tl_id b)
{
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

static int compare_pairs(const void *x, const void *y)
{
    const uint64_t *p = x, *q = y;
    return (*p > *q) - (*p < *q);
}

/* Sorts pairs, and drops those that are there twice. */
static size_t tidy_pairs(uint64_t *pairs, size_t count)
{
    size_t kept = 0;
    if (count > 1)
        qsort(pairs, count, sizeof *pairs, compare_pairs);
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || pairs[kept - 1] != pairs[i])
            pairs[kept++] = pairs[i];
    return kept;
}

/* ---------------------------------------------------------------- what it covers ---------- */

static bool has_block(const tl_model *m, const tl_scope_side *side, uint32_t row)
{
    return side->group != TL_NO_ROW ? m->blocks.group[row] == side->group
                                    : tl_id_set_has(&side->list, m->blocks.id[row]);
}

bool tl_scope_has_blocks(const tl_model *m, const tl_scope *s, uint32_t a, uint32_t b)
{
    if (s->names == 0)
        return true;
    if (a == TL_NO_ROW || b == TL_NO_ROW)
        return false;
    if (s->pairs) {
        const uint64_t pair = pair_of(m->blocks.id[a], m->blocks.id[b]);
        return bsearch(&pair, s->pairs, s->pair_count, sizeof pair, compare_pairs) != NULL;
    }
    if (s->names == 1)
        return has_block(m, &s->side[0], a) || has_block(m, &s->side[0], b);
    return (has_block(m, &s->side[0], a) && has_block(m, &s->side[1], b)) ||
           (has_block(m, &s->side[0], b) && has_block(m, &s->side[1], a));
}

bool tl_scope_covers(const tl_model *m, const tl_scope *s, tl_tag tag, uint32_t a, uint32_t b)
{
    return tl_tag_matches(s->tag, tag) && tl_scope_has_blocks(m, s, a, b);
}

static bool same_side(const tl_scope_side *one, const tl_scope_side *other)
{
    return one->group == other->group && (one->group != TL_NO_ROW || same_ids(&one->list, &other->list));
}

static bool same_pairs(const tl_scope *one, const tl_scope *other)
{
    return one->pairs && other->pairs && one->pair_count == other->pair_count &&
           memcmp(one->pairs, other->pairs, one->pair_count * sizeof *one->pairs) == 0;
}

bool tl_scope_same(const tl_scope *one, const tl_scope *other)
{
    const tl_scope_side *p = one->side, *q = other->side;
    if (one->tag.joint != other->tag.joint || one->tag.plane != other->tag.plane || one->names != other->names)
        return false;
    if (one->pairs || other->pairs)
        return same_pairs(one, other);
    if (one->names == 2)
        return (same_side(&p[0], &q[0]) && same_side(&p[1], &q[1])) ||
               (same_side(&p[0], &q[1]) && same_side(&p[1], &q[0]));
    return one->names == 0 || same_side(&p[0], &q[0]);
}

bool tl_scope_contains(const tl_scope *s, const tl_scope *other)
{
    if (!tl_tag_matches(s->tag, other->tag))
        return false;
    const tl_scope inside = {.tag = s->tag,
                             .names = other->names,
                             .pairs = other->pairs,
                             .pair_count = other->pair_count,
                             .side = {other->side[0], other->side[1]}};
    if (s->names == 0 || tl_scope_same(s, &inside))
        return true;
    return s->names == 1 && other->names == 2 && !other->pairs &&
           (same_side(&s->side[0], &other->side[0]) || same_side(&s->side[0], &other->side[1]));
}

bool tl_laws_name_blocks(const tl_model *m)
{
    for (size_t i = 0; i < m->joint_law_count; i++)
        if (m->joint_laws[i].scope.names > 0)
            return true;
    return false;
}

bool tl_laws_name_groups(const tl_model *m)
{
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const tl_scope *s = &m->joint_laws[i].scope;
        for (uint32_t k = 0; k < s->names && !s->pairs; k++)
            if (s->side[k].group != TL_NO_ROW)
                return true;
    }
    return false;
}

const tl_law *tl_law_of(const tl_model *m, tl_tag tag, uint32_t a, uint32_t b)
{
    const tl_law *best = NULL;
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const tl_law *one = &m->joint_laws[i];
        if ((!best || tl_scope_before(&one->scope, &best->scope)) && tl_scope_covers(m, &one->scope, tag, a, b))
            best = one;
    }
    return best;
}

const tl_law *tl_law_of_joint(const tl_model *m, tl_tag tag)
{
    return tl_law_of(m, tag, TL_NO_ROW, TL_NO_ROW);
}

/* ---------------------------------------------------------------- lists ------------------- */

static bool copy_ids(const tl_id_set *from, tl_id_set *out)
{
    uint64_t *word = malloc((from->words + 1) * sizeof *word);
    if (!word)
        return false;
    if (from->words)
        memcpy(word, from->word, from->words * sizeof *word);
    *out = (tl_id_set){word, from->words};
    return true;
}

bool tl_scope_copy(const tl_scope *from, tl_scope *out)
{
    *out = *from;
    out->side[0].list = out->side[1].list = (tl_id_set){NULL, 0};
    out->pairs = NULL;
    bool enough = true;
    for (int k = 0; k < 2 && enough; k++)
        enough = !from->side[k].list.word || copy_ids(&from->side[k].list, &out->side[k].list);
    if (enough && from->pairs) {
        out->pairs = malloc((from->pair_count + 1) * sizeof *out->pairs);
        enough = out->pairs != NULL;
        if (enough)
            memcpy(out->pairs, from->pairs, from->pair_count * sizeof *out->pairs);
    }
    if (!enough)
        tl_scope_clear(out);
    return enough;
}

void tl_scope_clear(tl_scope *s)
{
    free(s->side[0].list.word);
    free(s->side[1].list.word);
    free(s->pairs);
    *s = (tl_scope){.names = 0};
}

void tl_law_clear(tl_law *law)
{
    tl_scope_clear(&law->scope);
    if (!law->kind)
        return;
    const tl_law_ops *ops = law->kind->ops;
    if (ops->destroy && law->self != law->params) {
        tl_enter(law->kind, "destroy");
        ops->destroy(law->self);
        tl_leave();
    }
    free(law->params);
    *law = (tl_law){0};
}

/* ---------------------------------------------------------------- reading ----------------- */

/* The number of a group that some block is in; fails with the nearest name. */
static tl_status find_group(tl_model *m, const char *name, uint32_t *group)
{
    size_t *blocks = calloc(m->group_count + 1, sizeof *blocks);
    const char **names = malloc((m->group_count + 1) * sizeof *names);
    size_t count = 0;
    *group = TL_NO_ROW;
    for (size_t row = 0; blocks && row < m->blocks.table.rows; row++)
        blocks[m->blocks.group[row]] += m->blocks.stays[row] != 0;
    for (size_t i = 0; blocks && names && i < m->group_count; i++) {
        if (blocks[i] == 0)
            continue;
        names[count++] = m->groups[i];
        if (strcmp(m->groups[i], name) == 0)
            *group = (uint32_t)i;
    }
    tl_status status = blocks && names ? TL_OK : tl_fail_memory(&m->error);
    if (status == TL_OK && *group == TL_NO_ROW && count == 0) {
        status =
            tl_fail(&m->error, TL_E_NOT_FOUND, "no block is in the group '%.80s': the model has no blocks yet", name);
    } else if (status == TL_OK && *group == TL_NO_ROW) {
        const char *nearest = tl_nearest_name(name, names, count);
        status = tl_fail(&m->error, TL_E_NOT_FOUND, "no block is in the group '%.80s'; %s '%.80s'", name,
                         nearest ? "did you mean" : "the first of the model's groups is", nearest ? nearest : names[0]);
    }
    free(names);
    free(blocks);
    return status;
}

static tl_status read_side(tl_model *m, const tl_law_scope *given, int k, tl_scope *out)
{
    tl_scope_side *side = &out->side[out->names];
    if (given->group[k] && given->blocks[k])
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "the law names both a group, '%.80s', and blocks for one side: give one", given->group[k]);
    if (!given->group[k] && !given->blocks[k])
        return TL_OK;
    out->names++;
    if (given->group[k])
        return find_group(m, given->group[k], &side->group);
    if (given->block_count[k] == 0)
        return tl_fail(&m->error, TL_E_ARGUMENT, "the law is for no block: the selection is empty");
    tl_status status = tl_blocks_check(m, given->blocks[k], given->block_count[k]);
    return status != TL_OK || tl_id_set_of(given->blocks[k], given->block_count[k], &side->list)
               ? status
               : tl_fail_memory(&m->error);
}

static tl_status read_pairs(tl_model *m, const tl_law_scope *given, tl_scope *out)
{
    if (out->names > 0)
        return tl_fail(&m->error, TL_E_ARGUMENT, "the law names both contacts and blocks: give one of them");
    if (given->contact_count == 0)
        return tl_fail(&m->error, TL_E_ARGUMENT, "the law is for no contact: the selection is empty");
    out->names = 2;
    out->pairs = malloc(given->contact_count * sizeof *out->pairs);
    if (!out->pairs)
        return tl_fail_memory(&m->error);
    tl_status status = TL_OK;
    for (size_t i = 0; i < given->contact_count && status == TL_OK; i++) {
        const tl_id ids[2] = {given->contacts[i].a, given->contacts[i].b};
        status = tl_blocks_check(m, ids, 2);
        out->pairs[i] = pair_of(ids[0], ids[1]);
    }
    out->pair_count = tidy_pairs(out->pairs, given->contact_count);
    return status;
}

tl_status tl_scope_read(tl_model *m, const tl_law_scope *given, tl_scope *out)
{
    tl_law_scope read;
    *out = (tl_scope){.side = {{.group = TL_NO_ROW}, {.group = TL_NO_ROW}}};
    tl_status status = TL_OPTIONS_READ(tl_law_scope, given, &read, &m->error);
    if (status == TL_OK)
        status = tl_joint_parse(m, read.joint ? read.joint : "*", &out->tag);
    for (int k = 0; k < 2 && status == TL_OK; k++)
        status = read_side(m, &read, k, out);
    if (status == TL_OK && read.contacts)
        status = read_pairs(m, &read, out);
    for (size_t i = 0; i < m->joint_law_count && out->names > 0; i++)
        out->order = m->joint_laws[i].scope.order > out->order ? m->joint_laws[i].scope.order : out->order;
    out->order += out->names > 0;
    if (status != TL_OK)
        tl_scope_clear(out);
    return status;
}

/* ---------------------------------------------------------------- telling ----------------- */

tl_joint_info tl_joint_at(const tl_model *m, size_t index)
{
    const tl_law *law = tl_law_of_joint(m, (tl_tag){(uint32_t)index + 1, 0});
    return (tl_joint_info){
        .name = m->joints[index].name, .planes = m->joints[index].planes, .law = law ? law->kind : NULL};
}

size_t tl_law_count(const tl_model *m)
{
    return m->joint_law_count;
}

tl_law_info tl_law_at(const tl_model *m, size_t index)
{
    const tl_law *law = &m->joint_laws[index];
    return (tl_law_info){.joint = law->scope.tag, .law = law->kind, .params = law->params};
}

static bool list_blocks(const tl_model *m, const tl_id_set *set, const tl_id **ids, size_t *count)
{
    *count = tl_id_set_living(m, set, NULL);
    tl_id *list = malloc((*count + 1) * sizeof *list);
    if (list)
        tl_id_set_living(m, set, list);
    *ids = list;
    return list != NULL;
}

/* The pairs whose blocks live. */
static bool list_pairs(const tl_model *m, const tl_scope *s, tl_law_scope *out)
{
    tl_contact_name *list = malloc((s->pair_count + 1) * sizeof *list);
    for (size_t i = 0; list && i < s->pair_count; i++) {
        const tl_id a = (tl_id)(s->pairs[i] >> 32), b = (tl_id)s->pairs[i];
        if (tl_block_row_quiet(m, a) != TL_NO_ROW && tl_block_row_quiet(m, b) != TL_NO_ROW)
            list[out->contact_count++] = (tl_contact_name){.a = a, .b = b};
    }
    out->contacts = list;
    return list != NULL;
}

bool tl_law_names_blocks(const tl_model *m, size_t index)
{
    return m->joint_laws[index].scope.names > 0;
}

tl_status tl_law_scope_get(tl_model *m, size_t index, tl_law_scope *out)
{
    tl_rows_tidy(m);
    const tl_scope *s = &m->joint_laws[index].scope;
    *out = tl_law_scope_default();
    out->joint = tl_pattern_name(m, s->tag);
    bool enough = !s->pairs || list_pairs(m, s, out);
    for (uint32_t k = 0; k < s->names && !s->pairs && enough; k++) {
        if (s->side[k].group != TL_NO_ROW)
            out->group[k] = m->groups[s->side[k].group];
        else
            enough = list_blocks(m, &s->side[k].list, &out->blocks[k], &out->block_count[k]);
    }
    if (enough)
        return TL_OK;
    tl_law_scope_free(out);
    return tl_fail_memory(&m->error);
}

void tl_law_scope_free(tl_law_scope *scope)
{
    free((void *)(uintptr_t)scope->blocks[0]);
    free((void *)(uintptr_t)scope->blocks[1]);
    free((void *)(uintptr_t)scope->contacts);
    *scope = tl_law_scope_default();
}

/* ---------------------------------------------------------------- text -------------------- */

/* Bytes of the text of a side. */
#define SIDE_TEXT 80

static void side_text(const tl_model *m, const tl_scope_side *side, char text[SIDE_TEXT])
{
    if (side->group != TL_NO_ROW) {
        tl_text_print(text, SIDE_TEXT, "group '%.60s'", m->groups[side->group]);
        return;
    }
    const size_t count = tl_id_set_living(m, &side->list, NULL);
    tl_id first = 0;
    for (size_t row = 0; row < m->blocks.table.rows && first == 0; row++)
        if (m->blocks.stays[row] && tl_id_set_has(&side->list, m->blocks.id[row]))
            first = m->blocks.id[row];
    if (count > 1)
        tl_text_print(text, SIDE_TEXT, "%zu blocks (first: %u)", count, first);
    else if (count == 1)
        tl_text_print(text, SIDE_TEXT, "block %u", first);
    else
        tl_text_print(text, SIDE_TEXT, "blocks that are gone");
}

/* "joint 'J1:3'", with what follows it. */
static void joint_text(const tl_model *m, tl_tag tag, const char *behind, char text[SIDE_TEXT + 40])
{
    const char *joint = tag.joint ? m->joints[tag.joint - 1].name : "*";
    if (tag.plane)
        tl_text_print(text, SIDE_TEXT + 40, "joint '%.80s:%u'%s", joint, tag.plane, behind);
    else
        tl_text_print(text, SIDE_TEXT + 40, "joint '%.80s'%s", joint, behind);
}

const char *tl_scope_text(const tl_model *m, const tl_scope *s, char text[TL_SCOPE_TEXT])
{
    char joint[SIDE_TEXT + 40] = "", one[SIDE_TEXT], other[SIDE_TEXT];
    if (s->names == 0 || s->tag.joint)
        joint_text(m, s->tag, s->names ? ", " : "", joint);
    if (s->names == 0) {
        tl_text_print(text, TL_SCOPE_TEXT, "%s", joint);
        return text;
    }
    if (s->pairs) {
        tl_text_print(text, TL_SCOPE_TEXT, "%s%zu pairs of blocks (first: %u and %u)", joint, s->pair_count,
                      (tl_id)(s->pairs[0] >> 32), (tl_id)s->pairs[0]);
        return text;
    }
    side_text(m, &s->side[0], one);
    if (s->names == 1) {
        tl_text_print(text, TL_SCOPE_TEXT, "%scontacts of %s", joint, one);
        return text;
    }
    side_text(m, &s->side[1], other);
    tl_text_print(text, TL_SCOPE_TEXT, "%scontacts between %s and %s", joint, one, other);
    return text;
}

const char *tl_law_text(const tl_model *m, const tl_law *law, char text[TL_LAW_TEXT])
{
    char scope[TL_SCOPE_TEXT];
    tl_text_print(text, TL_LAW_TEXT, "%.40s: %s", law->kind->name, tl_scope_text(m, &law->scope, scope));
    return text;
}

/* ---------------------------------------------------------------- groups ------------------ */

void tl_law_change_free(tl_law_change *change)
{
    free(change->coming);
    free(change->field);
    *change = (tl_law_change){NULL, NULL, 0};
}

void tl_group_change_free(tl_group_change *change)
{
    free(change->row);
    free(change->group);
    tl_law_change_free(&change->laws);
}

tl_status tl_group_change_begin(tl_model *m, tl_group_change *change)
{
    change->laws = (tl_law_change){NULL, NULL, 0};
    return m->group_verbs && tl_laws_name_groups(m) ? m->group_verbs->begin(m, change) : TL_OK;
}

void tl_group_change_apply(tl_model *m, tl_group_change *change)
{
    if (m->group_verbs && tl_laws_name_groups(m)) {
        m->group_verbs->apply(m, change);
        return;
    }
    for (size_t i = 0; i < change->count; i++)
        m->blocks.group[change->row[i]] = change->group[i];
}

/* ---------------------------------------------------------------- cuts -------------------- */

static int compare_parts(const void *x, const void *y)
{
    const tl_part *p = x, *q = y;
    return p->whole != q->whole ? (p->whole > q->whole) - (p->whole < q->whole)
                                : (p->part > q->part) - (p->part < q->part);
}

/* The parts of a block: from `*begin` on, so many. */
static size_t parts_of(const tl_scope_parts *cut, tl_id whole, size_t *begin)
{
    size_t low = 0, high = cut->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (cut->parts[middle].whole < whole)
            low = middle + 1;
        else
            high = middle;
    }
    *begin = low;
    while (low < cut->count && cut->parts[low].whole == whole)
        low++;
    return low - *begin;
}

/* Pairs of the parts of two blocks, or of one and the other; with `to` they are written there. */
static size_t part_pairs(const tl_scope_parts *cut, uint64_t pair, uint64_t *to)
{
    const tl_id a = (tl_id)(pair >> 32), b = (tl_id)pair;
    size_t from_a, from_b, of_a = parts_of(cut, a, &from_a), of_b = parts_of(cut, b, &from_b), count = 0;
    for (size_t i = 0; i < (of_a ? of_a : 1); i++)
        for (size_t k = 0; k < (of_b ? of_b : 1); k++, count++)
            if (to)
                to[count] = pair_of(of_a ? cut->parts[from_a + i].part : a, of_b ? cut->parts[from_b + k].part : b);
    return count;
}

/* The pairs of a scope when blocks are cut; false: out of memory. */
static bool cut_pairs(const tl_scope *s, const tl_scope_parts *cut, uint64_t **pairs, size_t *count)
{
    size_t all = 0;
    for (size_t i = 0; i < s->pair_count; i++)
        all += part_pairs(cut, s->pairs[i], NULL);
    *pairs = malloc((all + 1) * sizeof **pairs);
    if (!*pairs)
        return false;
    all = 0;
    for (size_t i = 0; i < s->pair_count; i++)
        all += part_pairs(cut, s->pairs[i], *pairs + all);
    *count = tidy_pairs(*pairs, all);
    return true;
}

bool tl_scope_parts_begin(tl_model *m, tl_id end, tl_scope_parts *cut)
{
    if (cut->count > 1)
        qsort(cut->parts, cut->count, sizeof *cut->parts, compare_parts);
    cut->pairs = calloc(m->joint_law_count + 1, sizeof *cut->pairs);
    cut->pair_count = calloc(m->joint_law_count + 1, sizeof *cut->pair_count);
    bool enough = cut->pairs && cut->pair_count;
    for (size_t i = 0; i < m->joint_law_count && cut->count && enough; i++) {
        tl_scope *s = &m->joint_laws[i].scope;
        if (s->pairs)
            enough = cut_pairs(s, cut, &cut->pairs[i], &cut->pair_count[i]);
        for (uint32_t k = 0; k < s->names && enough && !s->pairs; k++)
            enough = s->side[k].group != TL_NO_ROW || widen(&s->side[k].list, end);
    }
    return enough;
}

void tl_scope_parts_apply(tl_model *m, tl_scope_parts *cut)
{
    for (size_t i = 0; i < m->joint_law_count && cut->count; i++) {
        tl_scope *s = &m->joint_laws[i].scope;
        if (cut->pairs[i]) {
            free(s->pairs);
            s->pairs = cut->pairs[i];
            s->pair_count = cut->pair_count[i];
            cut->pairs[i] = NULL;
        }
        for (uint32_t k = 0; k < s->names && !s->pairs; k++)
            for (size_t p = 0; p < cut->count && s->side[k].group == TL_NO_ROW; p++)
                if (tl_id_set_has(&s->side[k].list, cut->parts[p].whole))
                    put_id(&s->side[k].list, cut->parts[p].part);
    }
}

void tl_scope_parts_free(const tl_model *m, tl_scope_parts *cut)
{
    for (size_t i = 0; i < m->joint_law_count && cut->pairs; i++)
        free(cut->pairs[i]);
    free(cut->pairs);
    free(cut->pair_count);
    free(cut->parts);
}
