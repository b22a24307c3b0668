/* talus/elements.h - elements of a model: bolts, water between walls, and what else kinds of plugins put on blocks.
 *
 * An element acts on its nodes, which are points of blocks or of the ground. Its kind is from a plugin. Elements have
 * ids from 1, which are never used twice in a model. */
#ifndef TALUS_ELEMENTS_H
#define TALUS_ELEMENTS_H

#include <talus/talus.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Puts elements on the blocks as they are now: one call of the kind for each of `count` lists of parameters, all or
 * none. `group` is a name for them, "" for none. `ids`, freed with free(), and `made` tell what has come; both may be
 * NULL. TL_E_NOT_FOUND for an unknown kind, TL_E_ARGUMENT for a bad parameter, TL_E_STATE in a run, and what the kind
 * refuses; the sentence names the entry, counted from 1, where there are several. */
TL_API tl_status tl_model_element(tl_model *model, const char *kind, const tl_args *args, size_t count,
                                  const char *group, tl_id **ids, size_t *made);

/* Where the nodes would be, one element after the other, m; nothing is placed. Fails as tl_model_element does. `places`
 * is freed with free(). */
TL_API tl_status tl_model_element_places(tl_model *model, const char *kind, const tl_args *args, size_t count,
                                         tl_vec3 **places, size_t *nodes);

/* Likewise the mean place of the nodes of each element, m. */
TL_API tl_status tl_model_element_middles(tl_model *model, const char *kind, const tl_args *args, size_t count,
                                          tl_vec3 **places, size_t *elements);

/* Which elements; all that is set must hold. */
typedef struct tl_element_filter {
    uint32_t size;     /* sizeof(tl_element_filter) */
    const char *kind;  /* NULL: of any */
    const char *group; /* NULL: of any */
    tl_id block;       /* with a node on this block; 0: on any */
} tl_element_filter;

/* Ids of the elements that pass, ascending; freed with free(). TL_E_MEMORY. */
TL_API tl_status tl_elements_select(tl_model *model, const tl_element_filter *filter, tl_id **ids, size_t *count);

typedef struct tl_element_info {
    const tl_kind *kind;
    const void *params; /* its parameters now, at the offsets of kind->params */
    const char *group;
    size_t nodes;
    uint32_t flags;     /* TL_ELEMENT_* */
    double stored;      /* J */
    double lost, given; /* J, in the last step */
} tl_element_info;

/* What an element is; valid until the model changes. TL_E_STALE for one that is no more. */
TL_API tl_status tl_element_get(tl_model *model, tl_id element, tl_element_info *info);

typedef struct tl_element_node_info {
    tl_id block;            /* 0: the ground, or its block has been deleted */
    tl_vec3 rest, position; /* where it was when installed, and is now, m */
    tl_vec3 force;          /* on the block, in the last step, N */
    double weight;          /* m or m2 that it stands for */
} tl_element_node_info;

/* Node `index` of an element, from 0. TL_E_STALE, or TL_E_ARGUMENT for an index that is too high. */
TL_API tl_status tl_element_node_get(tl_model *model, tl_id element, size_t index, tl_element_node_info *node);

/* The value of a state of the element's kind, or of "stored", "lost", "given" of the whole, or of "weight" of a node:
 * of node `index` or, with SIZE_MAX, of the whole. TL_E_NOT_FOUND for an unknown name. */
TL_API tl_status tl_element_value(tl_model *model, tl_id element, size_t index, const char *name, double *value);
/* Writes a state. TL_E_ARGUMENT for a value that is not finite. */
TL_API tl_status tl_element_put(tl_model *model, tl_id element, size_t index, const char *name, double value);

/* The fields that an element has, in the order of the reference; `*count` of them. */
TL_API const tl_field *tl_element_fields(size_t *count);
/* The value of field `index` of an element. TL_E_STALE for one that is no more. */
TL_API tl_status tl_element_field(tl_model *model, tl_id element, size_t index, tl_field_value *value);
/* Writes a field that is a number, or a state of the whole, by its name: that of elements[i] to out[i]. It is NaN where
 * the kind has no such state. `*width` becomes 1; with `out` NULL that is all. TL_E_NOT_FOUND for an unknown name. */
TL_API tl_status tl_elements_values(tl_model *model, const tl_id *elements, size_t count, const char *name, double *out,
                                    size_t *width);

/* Writes what elements between the walls of contacts tell: of contacts[i] to out[i] a state by its name. Elements count
 * whose first node is on a face of one of its blocks and whose last one is on a face of the other. Of several it is the
 * mean, weighted by what their nodes stand for; so it is of the nodes where the state is one of nodes. Elements whose
 * state `unless`, of the whole, is not 0 are left out; NULL: none is. NaN where there is no element or no such state.
 * TL_E_STALE for a contact that is no more. */
TL_API tl_status tl_contacts_element_values(tl_model *model, const tl_contact_name *contacts, size_t count,
                                            const char *name, const char *unless, double *out);

/* Changes parameters of elements: those that are given, of each. Elements keep their states. TL_E_ARGUMENT for a
 * parameter by which they were placed. All or none. */
TL_API tl_status tl_elements_set(tl_model *model, const tl_id *elements, size_t count, const tl_args *args);
/* Takes elements away. What they hold counts as work by hand. TL_E_STALE for one that is no more; then none goes. */
TL_API tl_status tl_elements_delete(tl_model *model, const tl_id *elements, size_t count);

/* Has all elements do at once what those of one call do together, as in the steps in which they are due: after their
 * states have been written. What kinds refuse; then states that have been changed stay so. */
TL_API tl_status tl_elements_renew(tl_model *model);

typedef struct tl_element_energy {
    double stored, lost, given; /* J: held now; turned to heat and brought in from outside until now */
} tl_element_energy;

/* What elements hold and have done so far: parts of the balance of tl_model_energy. */
TL_API tl_status tl_model_element_energy(tl_model *model, tl_element_energy *energy);

#ifdef __cplusplus
}
#endif
#endif
