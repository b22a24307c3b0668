/* expect.h - what ranks will need, asked of the memory before (expect.c). */
#ifndef TL_CONTACT_EXPECT_H
#define TL_CONTACT_EXPECT_H

#include "contact/detection.h"
#include "model/model.h"

/* Whether it is worth asking the memory for what ranks need before they do. */
bool tl_points_are_far(const tl_detect *d);
/* Asks for what a rank that comes soon will need to be followed, or to be brought up to date. */
void tl_rank_expect(const tl_model *m, const tl_rank *rank);
void tl_rank_expect_shapes(const tl_model *m, const tl_rank *rank);
/* Asks for what tells where that is: for a rank that comes a little later. */
void tl_rank_expect_contacts(const tl_detect *d, const tl_rank *rank);

#endif
