/* fields.h - field contacts from step to step. */
#ifndef TL_DETECT_FIELDS_H
#define TL_DETECT_FIELDS_H

#include "contact/layout.h"
#include "contact/tables.h"
#include "model/model.h"
#include "narrow/field.h"
#include "narrow/manifold.h"

/* What is known of a contact before it is looked at. One whose bodies have got other frames stays what it is until its
 * points are in these. */
tl_manifold_before tl_contact_before(const tl_model *m, uint32_t contact, bool reframed, const tl_point_lanes *lanes);
/* Tolerance: how far walls may part, over how far they are lifted, before the lift is forgotten. As far again they
 * ride on what has opened them. Test: lua/test_insitu. */
#define TL_PARTED 2
/* Keeps the region of a field contact; whether it lay still when that was found. */
void tl_field_keep(tl_press_row *row, const tl_pair_view *view, const tl_region *region, bool calm);
/* What is known of the field, with the numbers that its faces have in a list made anew; nothing where one is not in
 * it. */
tl_field_mesh tl_field_listed_anew(const tl_press_row *row, const tl_region *region);

/* Finds the press of a field contact where its blocks are now, with its shift, and forgets what is known of others.
 * false: out of memory. */
bool tl_field_press_anew(tl_model *m, uint32_t contact, tl_narrow_scratch *scratch);
/* Whether a contact was a field contact in the last step and still has its list of faces; how long it has is found anew
 * when it may have run out. */
bool tl_field_goes_on(tl_model *m, uint32_t contact);

typedef enum tl_field_result {
    TL_FIELD_FOUND,
    TL_FIELD_LOST,  /* all is to be looked at */
    TL_FIELD_FAILED /* out of memory */
} tl_field_result;

/* Some field contacts on their way through a step. */
typedef struct tl_field_batch {
    uint32_t contact[TL_FIELD_PAIRS], count;
    bool near[TL_FIELD_PAIRS], failed; /* goes by slopes; out of memory */
    tl_press press[TL_FIELD_PAIRS];    /* of those that go by slopes */
    /* of those that do not, one after the other */
    tl_press found[TL_FIELD_PAIRS];
    tl_press_extra extra[TL_FIELD_PAIRS];
    tl_pair_view view[TL_FIELD_PAIRS];
    tl_region region[TL_FIELD_PAIRS];
    tl_press_query query[TL_FIELD_PAIRS];
    tl_field_slope slope[TL_FIELD_PAIRS];
    uint32_t asked;
} tl_field_batch;

/* Finds the presses of the contacts of a batch, which go on. */
void tl_fields_follow(tl_model *m, tl_field_batch *batch, tl_narrow_scratch *scratch);
/* What its k-th contact is now, into the thread's manifold; in ascending order. */
tl_field_result tl_field_take(tl_model *m, tl_field_batch *batch, uint32_t k, tl_narrow_scratch *scratch);

#endif
