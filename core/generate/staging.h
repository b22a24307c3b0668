/* staging.h - the staging set, in which generators create and cut blocks. */
#ifndef TL_GENERATE_STAGING_H
#define TL_GENERATE_STAGING_H

#include "model/model.h"

/* A block of the staging set. It is an untouched one of the model (source, shape not owned) or the same with new tags
 * (retagged). Or it is a child of one (source), or a new one (source TL_NO_ROW, shape in coordinates relative to the
 * origin). Children's shapes are in the frame of their source's body. */
typedef struct tl_stage_block {
    tl_poly *shape;
    uint32_t source;
    uint32_t group;
    double density;
    uint64_t lineage;
    uint32_t body;          /* blocks of one number are one body */
    uint32_t detached_from; /* a body it was taken out of and that has not been settled since, or TL_NO_ROW */
    uint64_t draw;          /* key of the body's draws: the least of its blocks' lineages */
    bool owned, retagged, hidden;
    bool hide_on_commit;
    uint8_t fixed;            /* of a new block: what of its motion is held */
    bool hidden_by_generator; /* while it runs */
    bool multi_block;         /* its body may have other blocks */
    bool needs_reconnect;     /* its body has been cut since it was last known to hang together */
} tl_stage_block;

/* The body in whose frame the shape of a staged block is; TL_NO_ROW: that of the model. */
static inline uint32_t tl_stage_frame(const tl_model *m, const tl_stage_block *block)
{
    return block->source == TL_NO_ROW ? TL_NO_ROW : m->blocks.body[block->source];
}

/* A block that the commit gives a new row, and not one of the model as it was or with other tags. */
static inline bool tl_stage_made(const tl_stage_block *block)
{
    return block->owned && !block->retagged;
}

static inline bool tl_stage_cut(const tl_stage_block *block)
{
    return block->source != TL_NO_ROW && tl_stage_made(block);
}

/* A ball about a staged block, relative to the model's origin: the coarse test of a cut. Kept apart from
 * the blocks, for a plane is tested against all of them and cuts few. */
typedef struct tl_stage_ball {
    tl_vec3 center;
    double radius;
} tl_stage_ball;

typedef struct tl_stage {
    tl_model *model;
    tl_stage_block *blocks;
    tl_stage_ball *balls; /* [capacity] */
    size_t count, capacity;
    size_t *visible; /* [capacity] indices of the blocks that generators see, ascending */
    size_t visible_count;
    uint32_t next_body;
    bool opened;          /* the model's blocks are in it */
    bool committed;       /* its shapes are the model's */
    bool lost;            /* there was no memory for that when a service asked that cannot say so */
    bool needs_reconnect; /* some block does */
    bool regroups;        /* bodies of several blocks are made or changed */
    tl_generate_summary summary;
    double created_volume;   /* less what was deleted */
    double changed_volume;   /* of what a commit has made, less what it replaced */
    tl_refused_cut *refused; /* `block` is an index into blocks until the commit */
    size_t refused_listed;
    /* what to go back to when the stage is dropped */
    size_t joint_count, group_count;
    uint32_t *plane_count;
    bool origin_set;
} tl_stage;

#endif
