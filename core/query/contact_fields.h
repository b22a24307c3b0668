/* contact_fields.h - all that can be told of a contact, at once: for lists of many. */
#ifndef TL_QUERY_CONTACT_FIELDS_H
#define TL_QUERY_CONTACT_FIELDS_H

#include "model/model.h"

typedef enum tl_contact_state {
    TL_CONTACT_ELASTIC,
    TL_CONTACT_SLIPPING,
    TL_CONTACT_OPEN,
    TL_CONTACT_FAILED,
    TL_NO_CONTACT /* of a face on which there is none */
} tl_contact_state;

/* As of the last step's forces. */
typedef struct tl_contact_facts {
    int64_t number, born; /* tl_contact_number; steps made when it began */
    tl_id a, b;           /* its older block and its younger */
    tl_tag tag;
    uint32_t law; /* place in the list of laws, from 1; 0: none */
    tl_contact_state state;
    double area, gap;                   /* m2; m, overlap negative */
    double normal_force;                /* N, compression positive */
    double normal_stress, shear_stress; /* Pa */
    tl_vec3 normal, point;              /* from a to b; m, in the user's coordinates */
    tl_vec3 shear_force;                /* N, on b */
    tl_vec3 shear_displacement;         /* of b against a, across the normal, m */
    double opening;                     /* of b away from a, along the normal, m */
    double slip;                        /* m: 0 until tl_law_states_slip has told it (point_fields.h) */
} tl_contact_facts;

/* A field of contacts, or what else files show of them, by a name that there is. */
const tl_field *tl_contact_quantity(const char *name);
/* Its whole number of 64 bits; NULL: it is none. */
const int64_t *tl_contact_long(const tl_contact_facts *facts, const tl_field *of);
/* Puts its numbers; of a text the number that stands for it. Returns how many. */
size_t tl_contact_numbers(const tl_contact_facts *facts, const tl_field *of, double out[3]);

/* Points of a contact that are told of: all of a patch, and of a field contact the one at the centre of its pressure.
 * The other one, of torsion, has the same normal force once more. Those of segments are counted by meeting.h. */
size_t tl_point_count(const tl_model *m, uint32_t contact);
/* What a law's flags mean: those that some point has, and those that all have. */
tl_contact_state tl_contact_state_of_flags(uint32_t any, uint32_t all);
/* Of a row of contacts that are up to date: tl_contacts_listed. Changes nothing, so several threads may ask. */
tl_contact_facts tl_contact_facts_of(const tl_model *m, uint32_t contact);
/* How far a contact's second block has gone from the first since displacements began to count, m. It is told of a
 * point of both that is now at x, relative to the model's origin. */
tl_vec3 tl_contact_passed(const tl_model *m, uint32_t contact, tl_vec3 x);
/* Brings the contacts up to date and finds the row of one; TL_E_STALE with a sentence when it is gone. */
tl_status tl_contact_find(tl_model *m, tl_contact_name contact, uint32_t *row);
/* Brings the contacts up to date and gives the rows of those with points, in the order of their blocks. Behind them
 * come those of blocks that meet by segments (meeting.h), `*meetings` of all `*count`. The caller frees the list. */
tl_status tl_contacts_listed(tl_model *m, uint32_t **rows, size_t *count, size_t *meetings);

#endif
