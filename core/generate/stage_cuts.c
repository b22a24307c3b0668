/* stage_cuts.c - blocks that cannot be cut: those that turn by a drive, and deformable ones. */
#include "generate/stage_cuts.h"

#include <stdlib.h>

/* Whether a body is driven to turn. */
static bool is_turned(const tl_model *m, uint32_t body)
{
    if (!m->bodies.drive[body])
        return false;
    const tl_drive *drive = &m->drives[m->bodies.drive[body] - 1].drive;
    return drive->angular_velocity_at || !tl_v3_is_zero(drive->angular_velocity);
}

/* Refuses to part a body that is driven to turn: its parts would all have the velocity of its centroid, and turn about
 * their own. */
static tl_status check_turned(const tl_stage *stage)
{
    tl_model *m = stage->model;
    bool any = false;
    for (uint32_t body = 0; body < m->bodies.table.rows && stage->opened && !any; body++)
        any = is_turned(m, body);
    if (!any)
        return TL_OK;
    uint32_t *becomes = malloc((m->bodies.table.rows + 1) * sizeof *becomes);
    if (!becomes)
        return tl_fail_memory(&m->error);
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        becomes[body] = TL_NO_ROW;
    tl_status status = TL_OK;
    for (size_t i = 0; i < stage->count && status == TL_OK; i++) {
        const tl_stage_block *block = &stage->blocks[i];
        uint32_t body = tl_stage_frame(m, block);
        if (body == TL_NO_ROW || !is_turned(m, body))
            continue;
        if (becomes[body] == TL_NO_ROW)
            becomes[body] = block->body;
        else if (becomes[body] != block->body)
            status = tl_fail(&m->error, TL_E_STATE,
                             "block %u is driven with an angular velocity and cannot be cut in two: "
                             "the parts would turn about centroids of their own; cut it before it is "
                             "driven, or free it, cut it and drive the parts",
                             m->blocks.id[block->source]);
    }
    free(becomes);
    return status;
}

/* Refuses to take some of its blocks out of a body that has zones. */
static tl_status check_bodies(const tl_stage *stage)
{
    tl_model *m = stage->model;
    unsigned char *kept = calloc(m->blocks.table.rows + 1, 1);
    tl_status status = kept ? TL_OK : tl_fail_memory(&m->error);
    for (size_t i = 0; kept && i < stage->count; i++)
        if (stage->blocks[i].source != TL_NO_ROW)
            kept[stage->blocks[i].source] = 1;
    for (uint32_t row = 0; row < m->blocks.table.rows && status == TL_OK; row++) {
        const uint32_t body = m->blocks.body[row], *rows = tl_body_blocks(m, body);
        if (kept[row] || !m->bodies.mesh[body])
            continue;
        for (uint32_t k = 0; k < m->bodies.member_count[body] && status == TL_OK; k++)
            if (kept[rows[k]])
                status =
                    tl_fail(&m->error, TL_E_STATE,
                            "block %u is deformable and joined to block %u, which stays: it cannot be taken away; take "
                            "it away before it gets zones",
                            m->blocks.id[row], m->blocks.id[rows[k]]);
    }
    free(kept);
    return status;
}

/* Refuses to cut blocks that have zones. */
static tl_status check_zones(const tl_stage *stage)
{
    tl_model *m = stage->model;
    for (size_t i = 0; i < stage->count; i++) {
        const tl_stage_block *block = &stage->blocks[i];
        if (tl_stage_made(block) && block->source != TL_NO_ROW && tl_block_deforms(m, block->source))
            return tl_fail(&m->error, TL_E_STATE,
                           "block %u is deformable and cannot be cut; cut it before it gets zones",
                           m->blocks.id[block->source]);
    }
    return stage->opened ? check_bodies(stage) : TL_OK;
}

tl_status tl_stage_check_cuts(const tl_stage *stage)
{
    const tl_status status = check_turned(stage);
    return status == TL_OK ? check_zones(stage) : status;
}
