/* views.c - the columns of a model as they are kept: views without a copy, and when rows have changed. */
#include "contact/detection.h"
#include "detect/detect.h"
#include "model/rows.h"
#include "zone/grid.h"

#include <talus/views.h>

/* A column whose rows lie `bytes` apart. */
static tl_view view(const void *data, size_t bytes, size_t count, size_t width)
{
    return (tl_view){data, count, bytes / sizeof(double), width};
}

static tl_index_view indices(const uint32_t *data, size_t count)
{
    return (tl_index_view){data, count};
}

uint64_t tl_structure(tl_model *m)
{
    tl_rows_tidy(m);
    return m->structure;
}

tl_block_views tl_view_blocks(tl_model *m)
{
    tl_rows_tidy(m);
    const tl_blocks *b = &m->blocks;
    size_t count = b->table.rows;
    return (tl_block_views){.id = indices(b->id, count),
                            .body = indices(b->body, count),
                            .volume = view(b->volume, sizeof *b->volume, count, 1),
                            .density = view(b->density, sizeof *b->density, count, 1)};
}

tl_body_views tl_view_bodies(tl_model *m)
{
    tl_rows_tidy(m);
    const tl_bodies *b = &m->bodies;
    size_t n = b->table.rows;
    const tl_pose *pose = b->pose;
    return (tl_body_views){
        .origin = m->origin,
        .id = indices(b->id, n),
        .reference = view(pose ? &pose->x_ref : NULL, sizeof *pose, n, 3),
        .displacement = view(pose ? &pose->u : NULL, sizeof *pose, n, 3),
        .rotation = view(b->q, sizeof *b->q, n, 4),
        .velocity = view(b->v, sizeof *b->v, n, 3),
        .angular_velocity = view(b->w, sizeof *b->w, n, 3),
        .force = view(b->force, sizeof *b->force, n, 3),
        .moment = view(b->moment, sizeof *b->moment, n, 3),
        .mass = view(b->mass, sizeof *b->mass, n, 1),
    };
}

tl_status tl_view_contacts(tl_model *m, tl_contact_views *views)
{
    *views = (tl_contact_views){0};
    tl_status status = tl_detect_refresh(m);
    if (status != TL_OK)
        return status;
    const tl_contacts *c = &m->detect->contacts;
    size_t n = c->table.rows;
    *views = (tl_contact_views){.a = indices(c->a, n),
                                .b = indices(c->b, n),
                                .force = view(c->force, sizeof *c->force, n, 3),
                                .area = view(c->area, sizeof *c->area, n, 1)};
    return TL_OK;
}

tl_status tl_view_gridpoints(tl_model *m, tl_id block, tl_gridpoint_views *views)
{
    *views = (tl_gridpoint_views){.origin = m->origin};
    tl_rows_tidy(m);
    const uint32_t row = tl_block_row(m, block);
    if (row == TL_NO_ROW)
        return m->error.status;
    const uint32_t mesh = tl_mesh_of(m, m->bodies.id[m->blocks.body[row]]);
    if (mesh == TL_NO_ROW)
        return TL_OK;
    const tl_gridpoints *p = &m->zones->points;
    const size_t first = m->zones->mesh[mesh].point_begin, n = m->zones->mesh[mesh].point_end - first;
    for (int k = 0; k < 3; k++) {
        views->reference[k] = view(p->ref[k] + first, sizeof(double), n, 1);
        views->displacement[k] = view(p->u[k] + first, sizeof(double), n, 1);
        views->velocity[k] = view(p->v[k] + first, sizeof(double), n, 1);
        views->force[k] = view(p->force[k] + first, sizeof(double), n, 1);
    }
    views->mass = view(p->mass + first, sizeof(double), n, 1);
    return TL_OK;
}
