/* stage_loads.h - loads of bodies that are cut, and what their parts get of them. */
#ifndef TL_GENERATE_STAGE_LOADS_H
#define TL_GENERATE_STAGE_LOADS_H

#include "generate/staging.h"

/* Loads of the bodies that a stage cuts. */
typedef struct tl_cut_loads {
    struct tl_cut_load *list;
    size_t count;
    struct tl_cut_face *faces; /* what is on faces of the bodies, by ascending row of their blocks */
    size_t face_count;
    uint32_t *of; /* [staged blocks] the load of the body that it comes from, or TL_NO_ROW */
} tl_cut_loads;

/* Takes them; false when out of memory (the lists are to be freed all the same). */
bool tl_cut_loads_take(const tl_stage *stage, tl_cut_loads *loads);
/* Gives them to the parts, when these have their bodies. `ids` are those of the staged blocks. */
void tl_cut_loads_give(const tl_stage *stage, const tl_id *ids, tl_cut_loads *loads);
void tl_cut_loads_free(tl_cut_loads *loads);

#endif
