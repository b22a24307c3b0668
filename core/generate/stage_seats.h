/* stage_seats.h - parts of blocks that are cut take over the seats of these. */
#ifndef TL_GENERATE_STAGE_SEATS_H
#define TL_GENERATE_STAGE_SEATS_H

#include "generate/staging.h"

/* Seated pairs of which a block is replaced by its parts, and room for those of the parts. */
typedef struct tl_stage_seats {
    struct left_seat *list;
    size_t count;
    tl_seated *parts;
    size_t capacity;
} tl_stage_seats;

/* Notes them, with all blocks still there. `keep`: [rows] whether a block stays. false: out of memory; the lists are to
 * be freed all the same. */
bool tl_stage_seats_take(const tl_stage *stage, const uint8_t *keep, size_t rows, tl_stage_seats *seats);
/* Seats the parts, whose ids are known: `ids` are those of the staged blocks. */
void tl_stage_seats_give(const tl_stage *stage, const tl_id *ids, tl_stage_seats *seats);
void tl_stage_seats_free(tl_stage_seats *seats);

#endif
