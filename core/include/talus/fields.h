/* talus/fields.h - reading much at once: a field of many blocks or contacts, contact points, states of laws.
 *
 * Values are those of the last step's forces; units and signs are those of the fields (tl_block_fields,
 * tl_contact_fields, tl_point_fields). Nothing here changes a model. Ids may be in any order; a stale one fails the
 * call with TL_E_STALE. */
#ifndef TALUS_FIELDS_H
#define TALUS_FIELDS_H

#include <talus/talus.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Numbers that a field of a kind has: 1, 3 of a vector, 4 of a quaternion, 6 of a tensor, 2 of ids, 0 of a text. */
TL_API size_t tl_field_width(tl_field_kind kind);

/* Writes a field of blocks, by its name: component k of the field of ids[i] to out[width * i + k]. `*width` is set;
 * with `out` NULL that is all. TL_E_NOT_FOUND for an unknown name, TL_E_ARGUMENT for a field that is a text. */
TL_API tl_status tl_blocks_values(tl_model *model, const tl_id *ids, size_t count, const char *field, double *out,
                                  size_t *width);

/* The same of contacts. `name` is a field, or a state of a law (NaN where the contact's law has no such state): the
 * mean of the contact's points, weighted by their areas, or the sum of a state that goes with the area
 * (TL_TRANSFER_SPLIT, TL_TRANSFER_ENERGY). `state` is a number here: 0 elastic, 1 slipping, 2 open, 3 failed. */
TL_API tl_status tl_contacts_values(tl_model *model, const tl_contact_name *contacts, size_t count, const char *name,
                                    double *out, size_t *width);

/* ---------------------------------------------------------------- contact points --------- */

/* The fields a contact point has. A patch of two faces has several points, whose forces add up to the contact's. A
 * field contact has one, at the centre of its pressure. */
TL_API const tl_field *tl_point_fields(size_t *count);
/* Counts the points of contacts: those of contacts[i] have the places start[i] to start[i + 1] - 1 in what
 * tl_points_values writes. `start` has count + 1 entries. */
TL_API tl_status tl_points_start(tl_model *model, const tl_contact_name *contacts, size_t count, size_t *start);
/* Writes a field, or a state, of the points of contacts, contact after contact; as tl_contacts_values. */
TL_API tl_status tl_points_values(tl_model *model, const tl_contact_name *contacts, size_t count, const char *name,
                                  double *out, size_t *width);

/* ---------------------------------------------------------------- states of laws --------- */

/* "elastic", "slipping", "open" or "failed" of 0 to 3; NULL of other numbers. */
TL_API const char *tl_state_name(size_t number);

#define TL_STATE_NAME 136

/* A state of a law by the name it is read by. That is its own name; "law_NAME" where a field or an array of the
 * files has that name; "LAW_NAME" of a law where an earlier one has the same name for another width. */
typedef struct tl_law_state {
    char name[TL_STATE_NAME];
    size_t width;          /* 1, or 3 of a vector */
    const tl_state *state; /* as the first law declares it that has it */
} tl_law_state;

/* Lists the states of the laws that the model's joints have or, with `contact` not NULL, those of that contact's law.
 * The list is the caller's, to be freed with free(). */
TL_API tl_status tl_states_list(tl_model *model, const tl_contact_name *contact, tl_law_state **list, size_t *count);

/* ---------------------------------------------------------------- what there is ---------- */

/* A joint set. */
typedef struct tl_joint_info {
    const char *name; /* valid until the model changes */
    uint32_t planes;
    const tl_kind *law; /* that of the set as a whole, or NULL while it has none */
} tl_joint_info;

/* The number of joint sets. */
TL_API size_t tl_joint_count(const tl_model *model);
/* Of joint set `index`, in the order they were made. */
TL_API tl_joint_info tl_joint_at(const tl_model *model, size_t index);

/* A law that was set. */
typedef struct tl_law_info {
    tl_tag joint; /* of a set (plane 0), of a plane, or of "*" (joint 0) */
    const tl_kind *law;
    const void *params; /* its parameters now, at the offsets of law->params */
} tl_law_info;

/* The number of laws that were set. */
TL_API size_t tl_law_count(const tl_model *model);
/* Law `index`, in the order in which joints were given one: below tl_law_count. */
TL_API tl_law_info tl_law_at(const tl_model *model, size_t index);

/* Names of groups, also of those that no block has any more. */
TL_API size_t tl_group_count(const tl_model *model);
/* The name of group `index`, in the order in which they came, below tl_group_count; valid as long as the model. */
TL_API const char *tl_group_name(const tl_model *model, size_t index);
/* Counts the blocks, also hidden ones, of each group and adds up their volumes, m3: [tl_group_count] each. */
TL_API void tl_groups_tally(tl_model *model, size_t *blocks, double *volumes);

#ifdef __cplusplus
}
#endif
#endif
