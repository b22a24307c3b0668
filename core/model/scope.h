/* scope.h - which contacts a law is for, and which of the laws for a contact rules it. */
#ifndef TL_MODEL_SCOPE_H
#define TL_MODEL_SCOPE_H

#include "model/joints.h"

/* Bytes of the text of a scope, with its terminating zero. */
#define TL_SCOPE_TEXT (sizeof(((tl_model *)NULL)->name))

/* Whether a scope names the blocks of two rows. It names any while it names none. */
bool tl_scope_has_blocks(const tl_model *m, const tl_scope *scope, uint32_t a, uint32_t b);

/* Whether a scope covers a contact of this tag between the blocks of two rows. Rows of TL_NO_ROW: only by the tag. */
bool tl_scope_covers(const tl_model *m, const tl_scope *scope, tl_tag tag, uint32_t a, uint32_t b);

/* Whether the law of one scope goes before that of another where both cover a contact: it names more of the two
 * blocks, or names the joint more closely, or is the later one. */
static inline bool tl_scope_before(const tl_scope *one, const tl_scope *other)
{
    if (one->names != other->names)
        return one->names > other->names;
    const int a = tl_tag_closeness(one->tag), b = tl_tag_closeness(other->tag);
    return a != b ? a > b : one->order > other->order;
}

/* The law that rules a contact of this tag between the blocks of two rows, or NULL. */
const tl_law *tl_law_of(const tl_model *m, tl_tag tag, uint32_t a, uint32_t b);
/* The law of a joint, for contacts whose blocks no law names, or NULL. */
const tl_law *tl_law_of_joint(const tl_model *m, tl_tag tag);
void tl_law_clear(tl_law *law);

/* Whether two scopes are of the same joint and name the same groups and blocks. */
bool tl_scope_same(const tl_scope *one, const tl_scope *other);
/* Whether all contacts of the other one are in a scope, whatever groups and lists hold. */
bool tl_scope_contains(const tl_scope *scope, const tl_scope *other);

/* Reads the caller's scope into `out`, which owns its lists then; fails with a sentence and nothing to free. */
tl_status tl_scope_read(tl_model *m, const tl_law_scope *given, tl_scope *out);
/* false: out of memory, and nothing to free. */
bool tl_scope_copy(const tl_scope *from, tl_scope *out);
void tl_scope_clear(tl_scope *scope);

/* "joint 'J1'", "joint 'J1' between group 'stone' and 12 blocks (first: 3)". */
const char *tl_scope_text(const tl_model *m, const tl_scope *scope, char text[TL_SCOPE_TEXT]);

/* Bytes of the text of a law, with its terminating zero. */
#define TL_LAW_TEXT (TL_SCOPE_TEXT + 48)

/* "coulomb: contacts of group 'stone'". */
const char *tl_law_text(const tl_model *m, const tl_law *law, char text[TL_LAW_TEXT]);

/* The set of the ids of a list; false: out of memory. */
bool tl_id_set_of(const tl_id *ids, size_t count, tl_id_set *out);
static inline bool tl_id_set_has(const tl_id_set *set, tl_id id)
{
    return id / 64 < set->words && (set->word[id / 64] >> (id % 64) & 1) != 0;
}
/* Ids of the set whose blocks live. With `ids` they are written there, ascending. */
size_t tl_id_set_living(const tl_model *m, const tl_id_set *set, tl_id *ids);

/* Whether some law names blocks, and whether some does so by a group. */
bool tl_laws_name_blocks(const tl_model *m);
bool tl_laws_name_groups(const tl_model *m);

/* Contacts that come under other laws, of those who keep their forces (cycle/joint_law.c). */
typedef struct tl_law_change {
    const tl_law **coming; /* [contacts] the law that a contact comes under with forces, or NULL */
    uint32_t *field;       /* [field_count] field contacts that get a law that presses otherwise */
    size_t field_count;
} tl_law_change;

void tl_law_change_free(tl_law_change *change);

/* Blocks that get other groups. */
typedef struct tl_group_change {
    uint32_t *row, *group; /* [count] */
    size_t count;
    tl_law_change laws;
} tl_group_change;

void tl_group_change_free(tl_group_change *change);

/* Who keeps forces of contacts that come under other laws with the groups of their blocks (cycle/joint_law.c). */
typedef struct tl_group_verbs {
    tl_status (*begin)(tl_model *m, tl_group_change *change);
    void (*apply)(tl_model *m, tl_group_change *change);
} tl_group_verbs;

/* Does all of a change of groups that can fail, and then the change. Rows and groups are the caller's to list. */
tl_status tl_group_change_begin(tl_model *m, tl_group_change *change);
void tl_group_change_apply(tl_model *m, tl_group_change *change);

/* A part of a block that is cut, by ids. */
typedef struct tl_part {
    tl_id whole, part;
} tl_part;

/* What scopes become when blocks are cut. */
typedef struct tl_scope_parts {
    tl_part *parts; /* by whole */
    size_t count;
    uint64_t **pairs; /* [laws] in the place of those of a scope; NULL: they stay */
    size_t *pair_count;
} tl_scope_parts;

/* Finds what scopes become, with room for parts of ids below `end`. `cut->parts` belongs to it, too. false: out of
 * memory. */
bool tl_scope_parts_begin(tl_model *m, tl_id end, tl_scope_parts *cut);
/* Lets parts belong to the scopes of their wholes. */
void tl_scope_parts_apply(tl_model *m, tl_scope_parts *cut);
void tl_scope_parts_free(const tl_model *m, tl_scope_parts *cut);

#endif
