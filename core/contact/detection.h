/* detection.h - all that is kept of pairs and contacts. */
#ifndef TL_CONTACT_DETECTION_H
#define TL_CONTACT_DETECTION_H

#include "base/exact.h"
#include "contact/layout.h"
#include "contact/old_point.h"
#include "contact/pair.h"
#include "contact/tables.h"
#include "model/model.h"

/* A block that detection knows, and the row of its body. */
typedef struct tl_known_block {
    tl_id id;
    uint32_t body;
} tl_known_block;

/* What a contact that is to be made begins with: found when its pair was tested. */
typedef struct tl_birth {
    uint32_t pair, kind;
    tl_tag tag;
    uint32_t points;
    double valid;  /* way that its faces hold for, m */
    bool overlaps; /* its blocks do, by enough to be told */
    bool deep;     /* by too much: overlap.c */
} tl_birth;

/* Of the pairs that a thread has tested last, in their order, until the contacts are made. */
typedef struct tl_births {
    tl_birth *list;
    size_t count, capacity;
    size_t next; /* to be made */
} tl_births;

typedef struct tl_detect {
    const struct tl_contact_kind *const *kinds; /* by the numbers of their facets */
    uint32_t kind_count;
    tl_pair *pairs;
    size_t pair_count, pair_capacity;
    tl_pair_chunk *chunks;
    size_t chunk_capacity;
    bool listed;           /* pairs have been listed */
    uint64_t lists;        /* how many times */
    bool rows_changed;     /* since contacts were laid out */
    bool any_without_rows; /* there may be contacts without rows for points */
    double reach;          /* half the skin of the broad phase */
    /* share of the error of the energy balance that is left for contacts in motion to go by slopes: 1 .. 0; by the rule
     * balance of the time step only */
    double balance_left;
    double *odometer_0; /* of each body, when the broad phase was made */
    size_t odometer_capacity;
    tl_known_block
        *known_blocks; /* of each row of blocks, at the last update: finds the block again after rows have changed */
    size_t known_block_count, known_block_capacity;
    float
        *path; /* of each block: path length since the broad phase was made, rounded up: no vertex has moved farther */
    size_t path_capacity;
    float longest_path; /* of all blocks */
    uint8_t *touched;   /* bodies whose contacts came, went or grew since the time step was chosen */
    size_t touched_capacity;
    bool any_touched;
    uint64_t structure, laws, rules, constraints; /* of the model, when last seen */
    int32_t contact_points;                       /* likewise */
    /* bodies held still all of whose contacts rest, so that the sums of their forces stand; `any_idle` false: none */
    uint8_t *idle;
    size_t idle_capacity;
    bool any_idle;
    tl_contacts contacts, spare;
    tl_press_row *press; /* of field contacts: contacts.c */
    size_t press_count, press_capacity;
    uint32_t press_free; /* the first free row; valid when there are rows */
    tl_points_table points, spare_points;
    double parted;      /* shear energy of contacts that ended since the ledger was closed, J: heat */
    tl_addends parting; /* of those that end while contacts are settled */
    int64_t laid_at;    /* steps made when contacts were laid out */
    size_t spare_share; /* 1 / this of rows, points and facets were added to spare; 0: never yet */
    tl_layout layout;
    uint32_t *by_block, *by_block_start; /* contacts of each block: index.c */
    size_t by_block_capacity, by_start_capacity;
    uint32_t indexed; /* rows of contacts that are listed; TL_NO_ROW: the lists are out of date */
    /* that have ended because a block was cut, until those of the parts are made: cut_contacts.c */
    tl_cut_contact *cut_contacts;
    tl_old_point *cut_points;
    size_t cut_count, cut_capacity, cut_point_count, cut_point_capacity;
    tl_births *births;         /* [threads] */
    bool stepped;              /* a step has used contacts */
    tl_narrow_scratch *narrow; /* [threads] */
    tl_point_lanes *lanes;     /* [threads]: a tile, or the largest SIMD group */
    size_t lane_capacity;
    unsigned threads;
} tl_detect;

/* Whether a block has come or changed since the detection looked. */
static inline bool tl_block_is_new(const tl_model *m, uint32_t row)
{
    return m->blocks.changed[row] > m->detect->structure;
}

/* Motion over the size of a block that changes no geometry. */
static inline double tl_still_share(const tl_model *m)
{
    return m->still > TL_STILL ? m->still : TL_STILL;
}

/* What a field contact keeps beside its points; NULL: nothing. */
static inline tl_press_row *tl_press_row_of(const tl_model *m, uint32_t contact)
{
    uint32_t row = m->detect->contacts.press[contact];
    return row == TL_NO_ROW ? NULL : &m->detect->press[row];
}

#endif
