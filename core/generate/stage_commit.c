/* stage_commit.c - a staging set becomes the model's blocks: rows are written, blocks that were cut or
 * deleted go, and blocks that hang together become bodies. All memory is reserved before the model is
 * touched, but for that of the bodies of several blocks. Where there are such, the rows as they were are set aside. */
#include "generate/stage_commit.h"

#include "generate/stage.h"
#include "generate/stage_bodies.h"
#include "generate/stage_cuts.h"
#include "generate/stage_seats.h"
#include "geometry/make.h"
#include "geometry/measure.h"
#include "model/inertia.h"
#include "model/loads.h"
#include "model/model.h"
#include "model/regroup.h"
#include "model/rows.h"
#include "model/slivers.h"

#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------- loads ------------------
 *
 * Loads of bodies that are cut go to their parts.
 *
 * What tractions have put on a face goes to the parts of the face. Of the rest, what has a point goes to the
 * part that has the point. What has none acts on the body as a whole, and its force F and moment M are spread over the
 * parts as weight is. With the mass m, the inertia I and the centroid r of the whole, each part p gets
 *
 *     F_p = m_p (F/m + alpha x (r_p - r)),    M_p = I_p alpha,    I alpha = M
 *
 * so that the parts go on as the whole, and what their joint carries stays. Sums of force and moment are those of the
 * whole.
 *
 * Of a load that comes of a traction on a face, force F and moment M about the centroid c of the face are noted. Parts
 * of the face get what brings a uniform plate along that F and M act on: with the area A and its second moments I, each
 * part p
 *
 *     F_p = A_p (F/A + w x (c_p - c)),    M_p = I_p w,    I w = M
 *
 * A traction that is uniform, or normal to the face and linear, is the same on each part. */

/* Tolerance: normals of a face and of its parts are off each other by rounding; so are places, over the size. */
#define SAME_FACE 1e-9
#define SAME_PLACE 1e-6
/* Tolerance: share of what is on faces up to which what is left of a load is rounding. */
#define NOTHING 1e-12

typedef struct cut_load {
    tl_body_load load;
    tl_wrench before; /* of the last step, where loads have been set since */
    bool changed;     /* that was another */
    tl_vec3 point;    /* where the load acts, relative to the origin */
    bool placed;      /* it has been given a point */
    tl_wrench rest;   /* of the load beside what is on faces, about that point; its force and moment otherwise */
    double on_faces;  /* sum of the lengths of the forces there */
    tl_lump sum;
    uint32_t nearest; /* row of the block that has the point, or is nearest to it */
    double distance;
} cut_load;

/* What is on a face of a block that may be cut. */
typedef struct cut_face {
    tl_face_load load;
    uint32_t row; /* of the block before */
    cut_load *of;
    tl_vec3 normal;
    tl_lump plate, sum; /* of the face, and of its parts */
} cut_face;

/* The owner frees the three lists. */
typedef struct cut_loads {
    cut_load *list;
    size_t count;
    cut_face *faces; /* what is on faces of the bodies, by ascending row of their blocks */
    size_t face_count;
    uint32_t *of; /* [staged blocks] the load of the body that it comes from, or TL_NO_ROW */
} cut_loads;

/* ---------------------------------------------------------------- lumps ------------------
 *
 * Several together, in two passes: the masses and places of all, then `lump_close`, then the inertias of all. */

static void lump_add(tl_lump *sum, const tl_lump *part)
{
    sum->mass += part->mass;
    sum->place = tl_v3_madd(sum->place, part->mass, part->place);
}

static void lump_close(tl_lump *sum)
{
    if (sum->mass > 0)
        sum->place = tl_v3_scale(1 / sum->mass, sum->place);
}

static void lump_add_inertia(tl_lump *sum, const tl_lump *part)
{
    tl_vec3 arm = tl_v3_sub(part->place, sum->place);
    sum->inertia = tl_s3_madd(sum->inertia, 1, tl_inertia_about(part->inertia, part->mass, arm));
}

/* What a part gets, about its centroid, of a force and a moment about that of all, to go on with all. Sums are kept. */
static tl_wrench lump_share(const tl_lump *part, const tl_lump *all, tl_wrench whole)
{
    const tl_sym3 *a = &all->inertia;
    tl_vec3 turn =
        tl_solve3(tl_v3(a->xx, a->xy, a->zx), tl_v3(a->xy, a->yy, a->yz), tl_v3(a->zx, a->yz, a->zz), whole.moment);
    tl_vec3 goes = tl_v3_scale(1 / all->mass, whole.force);
    goes = tl_v3_add(goes, tl_v3_cross(turn, tl_v3_sub(part->place, all->place)));
    return (tl_wrench){tl_v3_scale(part->mass, goes), tl_s3_mul(part->inertia, turn)};
}

/* Adds a force and a moment about a place, relative to the origin, to the load of a body. The load acts at the mean of
 * the places, weighted by the lengths of their forces. */
static void add_load(tl_model *m, uint32_t body, tl_wrench more, tl_vec3 place)
{
    tl_body_load *load = &m->bodies.load[body];
    const tl_mat3 *r = &m->bodies.pose[body].r;
    tl_vec3 to = tl_v3_sub(place, tl_body_place(&m->bodies, body)), at = tl_m3_mul(r, load->arm);
    double had = tl_v3_norm(load->force), has = tl_v3_norm(more.force), all = had + has;
    if (had == 0) { /* without roundings */
        *load = (tl_body_load){more.force, tl_v3_add(load->moment, more.moment), tl_m3_tmul(r, to)};
        return;
    }
    tl_vec3 arm = tl_v3_add(tl_v3_scale(had, at), tl_v3_scale(has, to));
    arm = tl_v3_scale(all > 0 ? 1 / all : 0, arm);
    tl_vec3 moment = tl_v3_add(load->moment, tl_v3_cross(at, load->force));
    moment = tl_v3_add(moment, tl_v3_add(more.moment, tl_v3_cross(to, more.force)));
    load->force = tl_v3_add(load->force, more.force);
    load->moment = tl_v3_sub(moment, tl_v3_cross(arm, load->force));
    load->arm = tl_m3_tmul(r, arm);
}

/* ---------------------------------------------------------------- taken ------------------ */

static cut_load load_of(const tl_model *m, uint32_t body)
{
    const tl_bodies *b = &m->bodies;
    tl_body_load load = b->load[body];
    return (cut_load){.load = load,
                      .before = b->load_before[body],
                      .changed = tl_load_changed(m, body),
                      .rest = {load.force, load.moment},
                      .placed = !tl_v3_is_zero(load.arm),
                      .point = tl_body_point(b, body, load.arm),
                      .nearest = TL_NO_ROW,
                      .distance = INFINITY};
}

/* What is on the faces of a block before, by its row: the first and the next. Faces ascend with their rows. */
static cut_face *faces_of(const cut_loads *loads, uint32_t row)
{
    size_t low = 0, high = loads->face_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (loads->faces[middle].row < row)
            low = middle + 1;
        else
            high = middle;
    }
    return low < loads->face_count && loads->faces[low].row == row ? &loads->faces[low] : NULL;
}

static cut_face *next_of(const cut_loads *loads, cut_face *face)
{
    cut_face *next = face + 1;
    return next < loads->faces + loads->face_count && next->row == face->row ? next : NULL;
}

/* Adds `sign` times what is on a face to the rest of the load. */
static void add_to_rest(const cut_face *face, double sign)
{
    tl_wrench *rest = &face->of->rest;
    tl_vec3 arm = tl_v3_sub(face->plate.place, face->of->point);
    rest->force = tl_v3_madd(rest->force, sign, face->load.force);
    rest->moment = tl_v3_madd(rest->moment, sign, face->load.moment);
    rest->moment = tl_v3_madd(rest->moment, sign, tl_v3_cross(arm, face->load.force));
}

/* Takes what is on faces of the bodies out of their loads; room for what their parts get of it. */
static bool take_faces(const tl_stage *stage, const uint32_t *slot, cut_loads *loads)
{
    tl_model *m = stage->model;
    size_t most = 0;
    loads->faces = malloc((m->face_load_count + 1) * sizeof *loads->faces);
    for (size_t i = 0; loads->faces && i < m->face_load_count; i++) {
        const tl_face_load *f = &m->face_loads[i];
        uint32_t row = tl_block_row_quiet(m, f->block);
        if (row == TL_NO_ROW || slot[m->blocks.body[row]] == TL_NO_ROW || f->face >= m->blocks.shape[row]->face_count)
            continue;
        cut_load *of = &loads->list[slot[m->blocks.body[row]]];
        cut_face *face = &loads->faces[loads->face_count++];
        const tl_mat3 *r = &m->bodies.pose[m->blocks.body[row]].r;
        *face = (cut_face){.load = *f, .row = row, .of = of, .plate = tl_face_plate(m, row, f->face)};
        face->normal = tl_m3_mul(r, m->blocks.shape[row]->plane[f->face].normal);
        add_to_rest(face, -1);
        of->on_faces += tl_v3_norm(f->force);
    }
    for (size_t i = 0; loads->faces && i < stage->count; i++)
        for (cut_face *f = faces_of(loads, stage->blocks[i].source); f; f = next_of(loads, f))
            most++;
    return loads->faces &&
           tl_grow(&m->face_loads, &m->face_load_capacity, m->face_load_count + most, sizeof *m->face_loads);
}

/* Takes the loads of the bodies that a stage has cut; false when out of memory (the lists are to be freed all the
 * same). */
static bool take_loads(const tl_stage *stage, cut_loads *loads)
{
    const tl_model *m = stage->model;
    size_t bodies = m->bodies.table.rows;
    *loads = (cut_loads){.count = 0};
    if (!m->bodies.load || !stage->opened)
        return true;
    uint32_t *slot = malloc((bodies + 1) * sizeof *slot);
    loads->of = malloc((stage->count + 1) * sizeof *loads->of);
    loads->list = malloc((bodies + 1) * sizeof *loads->list);
    bool enough = slot && loads->of && loads->list;
    for (size_t body = 0; enough && body < bodies; body++)
        slot[body] = TL_NO_ROW;
    for (size_t i = 0; enough && i < stage->count; i++) {
        uint32_t row = stage->blocks[i].source;
        if (!tl_stage_cut(&stage->blocks[i]) || slot[m->blocks.body[row]] != TL_NO_ROW)
            continue;
        slot[m->blocks.body[row]] = (uint32_t)loads->count;
        loads->list[loads->count++] = load_of(m, m->blocks.body[row]);
    }
    for (size_t i = 0; enough && i < stage->count; i++) {
        uint32_t row = stage->blocks[i].source;
        loads->of[i] = row == TL_NO_ROW ? TL_NO_ROW : slot[m->blocks.body[row]];
    }
    enough = enough && take_faces(stage, slot, loads);
    free(slot);
    return enough;
}

/* ---------------------------------------------------------------- given ------------------ */

typedef void visit_fn(tl_model *m, uint32_t row, cut_load *load);

/* Visits the blocks that bodies with loads have become, in their order. */
static void visit(const tl_stage *stage, const tl_id *ids, cut_loads *loads, visit_fn *each)
{
    tl_model *m = stage->model;
    for (size_t i = 0; i < stage->count; i++)
        if (loads->of[i] != TL_NO_ROW && tl_block_row_quiet(m, ids[i]) != TL_NO_ROW)
            each(m, tl_block_row_quiet(m, ids[i]), &loads->list[loads->of[i]]);
}

static tl_lump lump_of(const tl_model *m, uint32_t row)
{
    return (tl_lump){m->blocks.density[row] * m->blocks.volume[row], tl_block_place(m, row), tl_block_inertia(m, row)};
}

/* How far a place lies before the faces of a block; negative inside. */
static double distance_of(const tl_model *m, uint32_t row, tl_vec3 place)
{
    const tl_poly *shape = m->blocks.shape[row];
    tl_vec3 x = tl_body_local(&m->bodies, m->blocks.body[row], place);
    double most = -INFINITY;
    for (uint32_t f = 0; f < shape->face_count; f++)
        most = fmax(most, tl_v3_dot(shape->plane[f].normal, x) - shape->plane[f].offset);
    return most;
}

/* Takes the load off the block's body, and adds its mass. */
static void begin(tl_model *m, uint32_t row, cut_load *of)
{
    uint32_t body = m->blocks.body[row];
    double distance = distance_of(m, row, of->point);
    tl_lump lump = lump_of(m, row);
    m->bodies.load[body] = (tl_body_load){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    m->bodies.load_before[body] = (tl_wrench){{0, 0, 0}, {0, 0, 0}};
    lump_add(&of->sum, &lump);
    if (distance < of->distance) {
        of->distance = distance;
        of->nearest = row;
    }
}

static void add_inertia(tl_model *m, uint32_t row, cut_load *of)
{
    tl_lump lump = lump_of(m, row);
    lump_add_inertia(&of->sum, &lump);
}

/* Whether there is something of a load beside what is on faces. */
static bool has_rest(const cut_load *of)
{
    const tl_sym3 *i = &of->sum.inertia;
    double size = sqrt((i->xx + i->yy + i->zz) / of->sum.mass);
    return of->on_faces == 0 || tl_v3_norm(of->rest.force) > NOTHING * of->on_faces ||
           tl_v3_norm(of->rest.moment) > NOTHING * size * of->on_faces;
}

/* Adds to the load of a body what acts on all of it, without a point. */
static void give_whole(tl_model *m, uint32_t body, tl_wrench part, tl_vec3 place)
{
    tl_body_load *load = &m->bodies.load[body];
    tl_vec3 arm = tl_v3_sub(place, tl_body_place(&m->bodies, body));
    load->force = tl_v3_add(load->force, part.force);
    load->moment = tl_v3_add(load->moment, part.moment);
    load->moment = tl_v3_add(load->moment, tl_v3_cross(arm, part.force));
}

/* Gives a block's body the block's part of what is on no face. */
static void give(tl_model *m, uint32_t row, cut_load *of)
{
    uint32_t body = m->blocks.body[row];
    tl_lump lump = lump_of(m, row);
    if (!has_rest(of))
        return;
    if (!of->placed)
        give_whole(m, body, lump_share(&lump, &of->sum, of->rest), lump.place);
    else if (row == of->nearest)
        add_load(m, body, of->rest, of->point);
}

/* What the block's body had of the load in the last step: as it has of it now, where that was the same. */
static void give_before(tl_model *m, uint32_t row, cut_load *of)
{
    uint32_t body = m->blocks.body[row];
    tl_wrench *before = &m->bodies.load_before[body];
    if (!m->loads_changed)
        return;
    if (!of->changed) {
        *before = tl_load_wrench(&m->bodies, body);
        return;
    }
    tl_lump lump = lump_of(m, row);
    tl_wrench part = lump_share(&lump, &of->sum, of->before);
    tl_vec3 arm = tl_v3_sub(lump.place, tl_body_place(&m->bodies, body));
    before->force = tl_v3_add(before->force, part.force);
    before->moment = tl_v3_add(before->moment, part.moment);
    before->moment = tl_v3_add(before->moment, tl_v3_cross(arm, part.force));
}

/* ---------------------------------------------------------------- faces ------------------ */

/* The face of a block that is a part of one; TL_NO_ROW: it has none. */
static uint32_t part_of(const tl_model *m, uint32_t row, const cut_face *face)
{
    const tl_poly *shape = m->blocks.shape[row];
    uint32_t body = m->blocks.body[row];
    tl_vec3 n = tl_m3_tmul(&m->bodies.pose[body].r, face->normal);
    tl_vec3 x = tl_body_local(&m->bodies, body, face->plate.place);
    for (uint32_t f = 0; f < shape->face_count; f++)
        if (tl_v3_norm2(tl_v3_sub(shape->plane[f].normal, n)) < SAME_FACE * SAME_FACE &&
            fabs(tl_v3_dot(n, x) - shape->plane[f].offset) < SAME_PLACE * shape->size)
            return f;
    return TL_NO_ROW;
}

typedef void visit_part_fn(tl_model *m, uint32_t row, uint32_t part, cut_face *face);

/* Visits the parts of faces, in the order of their blocks. */
static void visit_parts(const tl_stage *stage, const tl_id *ids, const cut_loads *loads, visit_part_fn *each)
{
    tl_model *m = stage->model;
    for (size_t i = 0; i < stage->count; i++) {
        uint32_t row = loads->of[i] == TL_NO_ROW ? TL_NO_ROW : tl_block_row_quiet(m, ids[i]);
        cut_face *f = row == TL_NO_ROW ? NULL : faces_of(loads, stage->blocks[i].source);
        for (; f; f = next_of(loads, f)) {
            uint32_t part = part_of(m, row, f);
            if (part != TL_NO_ROW)
                each(m, row, part, f);
        }
    }
}

static void begin_face(tl_model *m, uint32_t row, uint32_t part, cut_face *face)
{
    tl_lump plate = tl_face_plate(m, row, part);
    lump_add(&face->sum, &plate);
}

static void add_face_inertia(tl_model *m, uint32_t row, uint32_t part, cut_face *face)
{
    tl_lump plate = tl_face_plate(m, row, part);
    lump_add_inertia(&face->sum, &plate);
}

static void give_face(tl_model *m, uint32_t row, uint32_t part, cut_face *face)
{
    tl_lump plate = tl_face_plate(m, row, part);
    tl_wrench whole = {face->load.force, face->load.moment};
    tl_vec3 arm = tl_v3_sub(face->plate.place, face->sum.place);
    whole.moment = tl_v3_add(whole.moment, tl_v3_cross(arm, whole.force));
    tl_wrench share = lump_share(&plate, &face->sum, whole);
    add_load(m, m->blocks.body[row], share, plate.place);
    m->face_loads[m->face_load_count++] = (tl_face_load){m->blocks.id[row], part, share.force, share.moment};
}

/* Forgets what was on the faces of the bodies before: it has come off them. */
static void drop_faces(tl_model *m, const cut_loads *loads)
{
    size_t kept = 0, k = 0;
    for (size_t i = 0; i < m->face_load_count; i++) {
        const tl_face_load *f = &m->face_loads[i];
        bool taken =
            k < loads->face_count && f->block == loads->faces[k].load.block && f->face == loads->faces[k].load.face;
        if (taken)
            k++;
        else
            m->face_loads[kept++] = *f;
    }
    m->face_load_count = kept;
}

/* Sums the parts of each face up. What is on one without parts goes as the rest does. */
static void sum_faces(const tl_stage *stage, const tl_id *ids, const cut_loads *loads)
{
    visit_parts(stage, ids, loads, begin_face);
    for (size_t k = 0; k < loads->face_count; k++) {
        lump_close(&loads->faces[k].sum);
        if (!(loads->faces[k].sum.mass > 0))
            add_to_rest(&loads->faces[k], 1);
    }
    visit_parts(stage, ids, loads, add_face_inertia);
}

static void give_faces(const tl_stage *stage, const tl_id *ids, const cut_loads *loads)
{
    tl_model *m = stage->model;
    if (loads->face_count == 0)
        return;
    drop_faces(m, loads);
    visit_parts(stage, ids, loads, give_face);
    tl_face_loads_set(m, m->face_loads, m->face_load_count, m->face_load_capacity);
}

/* Gives them to the parts, when these have their bodies. `ids` are those of the staged blocks. */
static void give_loads(const tl_stage *stage, const tl_id *ids, cut_loads *loads)
{
    if (loads->count == 0)
        return;
    visit(stage, ids, loads, begin);
    for (size_t k = 0; k < loads->count; k++)
        lump_close(&loads->list[k].sum);
    visit(stage, ids, loads, add_inertia);
    sum_faces(stage, ids, loads);
    visit(stage, ids, loads, give);
    give_faces(stage, ids, loads);
    visit(stage, ids, loads, give_before);
}

/* ---------------------------------------------------------------- rows ------------------- */

/* Moves a shape so that its centroid is the zero of its frame. Offsets follow from a vertex of the face, which keeps
 * the digits of a shape far from zero. Its size is that of the vertices as they then are, which is found again of them
 * when they have been saved. */
static void centre_shape(tl_poly *shape, tl_vec3 centroid)
{
    for (uint32_t i = 0; i < shape->vertex_count; i++)
        shape->vertex[i] = tl_v3_sub(shape->vertex[i], centroid);
    for (uint32_t f = 0; f < shape->face_count; f++)
        shape->plane[f].offset = tl_v3_dot(shape->plane[f].normal, shape->vertex[shape->loop[shape->start[f]]]);
    tl_poly_find_size(shape);
}

/* What the children of a block take over from it and from its body. */
typedef struct source {
    tl_id id;
    tl_pose pose;
    tl_base base, made;
    tl_vec3 v, w;
    tl_quat q;
    uint32_t drive;
    uint8_t fixed;
} source;

static source source_of(const tl_model *m, uint32_t row)
{
    const tl_bodies *b = &m->bodies;
    uint32_t body = m->blocks.body[row];
    return (source){.id = m->blocks.id[row],
                    .base = tl_block_base(m, row),
                    .made = tl_block_made(m, row),
                    .pose = b->pose[body],
                    .v = b->v[body],
                    .w = b->w[body],
                    .q = b->q[body],
                    .drive = b->drive[body],
                    .fixed = b->fixed[body]};
}

/* Where a block was, as far as the model has such a column: where its source was, about its own centroid `c`; NULL:
 * here. */
static void put_base(tl_base *column, uint32_t row, const tl_base *from, tl_vec3 c)
{
    if (!column)
        return;
    column[row] = from ? *from : (tl_base){{0, 0, 0}, tl_q_identity()};
    const tl_mat3 turn = tl_q_matrix(column[row].turn);
    column[row].shift = tl_v3_add(column[row].shift, tl_v3_sub(tl_m3_mul(&turn, c), c));
}

/* Fills the rows of a new block and of its body. A child moves on as its part of the source did. */
static void put(tl_model *m, const tl_stage_block *block, const source *from, uint32_t row, uint32_t body)
{
    tl_blocks *blocks = &m->blocks;
    tl_bodies *bodies = &m->bodies;
    tl_pose *pose = &bodies->pose[body];
    tl_mass mass = tl_poly_mass(block->shape);
    tl_vec3 c = mass.centroid;
    centre_shape(block->shape, c);
    blocks->id[row] = bodies->id[body] = m->next_id++;
    blocks->body[row] = body;
    blocks->shape[row] = block->shape;
    blocks->group[row] = block->group;
    blocks->density[row] = block->density;
    blocks->lineage[row] = block->lineage;
    blocks->hidden[row] = block->hidden || block->hide_on_commit;
    blocks->stays[row] = true;
    tl_block_changes(m, row);
    tl_block_came(m, row, mass);
    if (!from) {
        pose->x_ref = c;
        pose->r = tl_m3_identity();
        bodies->q[body] = tl_q_identity();
        bodies->fixed[body] = block->fixed;
        put_base(blocks->base, row, NULL, c);
        put_base(blocks->made, row, NULL, c);
        return;
    }
    tl_vec3 arm = tl_m3_mul(&from->pose.r, c);
    put_base(blocks->base, row, &from->base, c);
    put_base(blocks->made, row, &from->made, c);
    *pose = from->pose;
    pose->x_ref = tl_v3_add(pose->x_ref, c);
    pose->u = tl_v3_add(pose->u, tl_v3_sub(arm, c));
    pose->v_moved = tl_v3_add(pose->v_moved, tl_v3_cross(pose->w_moved, arm));
    bodies->q[body] = from->q;
    bodies->v[body] = tl_v3_add(from->v, tl_v3_cross(from->w, arm));
    bodies->w[body] = from->w;
    bodies->fixed[body] = from->fixed;
    bodies->drive[body] = from->drive;
    if (from->drive)
        m->drives[from->drive - 1].bodies++;
}

/* Sums up the call, which has made the last rows. */
static void summarize(tl_stage *stage, size_t made)
{
    const tl_model *m = stage->model;
    const tl_extremes all = tl_extremes_of(stage->model);
    tl_generate_summary *s = &stage->summary;
    s->after = tl_block_count(stage->model);
    s->smallest_volume = s->after ? all.volume : 0;
    s->smallest_edge = s->after ? all.edge : 0;
    s->smallest_face = s->after ? all.face : 0;
    if (all.total > 0)
        s->volume_error = fabs(stage->changed_volume - stage->created_volume) / all.total;
    const size_t rows = m->blocks.table.rows;
    for (size_t row = rows - made; row < rows; row++)
        s->slivers += tl_is_sliver(m->blocks.shape[row], m->blocks.volume[row], all.total / (double)s->after);
}

/* Adds what the stage did to the model's record, whose list has room. `ids` are those of the staged blocks. */
static void keep_record(const tl_stage *stage, const tl_id *ids)
{
    tl_cut_record *record = &stage->model->record;
    record->cuts += stage->summary.cuts;
    record->refused += stage->summary.refused;
    record->coincident += stage->summary.coincident;
    record->created += stage->created_volume;
    for (size_t i = 0; i < stage->refused_listed; i++) {
        record->list[record->listed] = stage->refused[i];
        record->list[record->listed++].block = ids[stage->refused[i].block];
    }
}

/* What a commit needs before it changes anything. */
typedef struct commit_scratch {
    unsigned char *keep; /* [rows before] */
    uint32_t *slot;      /* [rows before] of blocks that were cut: place in sources */
    source *sources;     /* of the blocks that were cut */
    size_t source_count;
    tl_id *ids;       /* [staged blocks] their ids in the model */
    tl_split *splits; /* [staged blocks] that were there before */
    size_t split_count;
    cut_loads loads; /* of the bodies that were cut */
    tl_stage_seats seats;
    tl_poly **gone; /* [rows before] shapes that other shapes or blocks take the place of */
    size_t gone_count;
    tl_aside aside;  /* where there are bodies of several blocks */
    uint32_t *first; /* [staged bodies] */
    uint32_t *group; /* [rows] */
} commit_scratch;

/* Whether contacts are kept of blocks: those of their parts take them over. */
static bool has_contacts(const tl_model *m)
{
    return m->detect && m->found_for != TL_FOR_QUERIES;
}

/* Notes what blocks were cut out of, where there is room for it. */
static void keep_cut_parts(const tl_stage *stage, const commit_scratch *scratch)
{
    tl_model *m = stage->model;
    for (size_t i = 0; i < stage->count && has_contacts(m); i++) {
        const tl_stage_block *block = &stage->blocks[i];
        if (!tl_stage_cut(block))
            continue;
        const source *from = &scratch->sources[scratch->slot[block->source]];
        const tl_cut_part *known = tl_cut_part_of(m, from->id);
        tl_cut_part part = {.root = from->id, .r = from->pose.r, .place = tl_v3_add(from->pose.x_ref, from->pose.u)};
        part = known ? *known : part;
        part.id = scratch->ids[i];
        m->cut_parts[m->cut_part_count++] = part;
    }
}

/* Whether parts of a body have to go on as it does: after a step, or when something has been put on its contacts. */
static bool goes_on(const tl_model *m)
{
    return m->cycles > 0 || has_contacts(m);
}

/* Lists the blocks that were there before, with the bodies they were in in the last step. */
static void list_wholes(const tl_stage *stage, commit_scratch *scratch)
{
    const tl_model *m = stage->model;
    for (size_t i = 0; i < stage->count && goes_on(m); i++) {
        uint32_t row = stage->blocks[i].source;
        if (row == TL_NO_ROW)
            continue;
        tl_id whole = tl_split_of(m, m->blocks.id[row]);
        whole = whole == TL_NO_ID ? m->bodies.id[m->blocks.body[row]] : whole;
        scratch->splits[scratch->split_count++] = (tl_split){(tl_id)i, whole};
    }
}

static int compare_split(const void *x, const void *y)
{
    const tl_split *p = x, *q = y;
    return (p->block > q->block) - (p->block < q->block);
}

static int compare_whole(const void *x, const void *y)
{
    const tl_split *p = x, *q = y;
    return p->whole != q->whole ? (p->whole > q->whole) - (p->whole < q->whole) : compare_split(x, y);
}

/* Keeps the blocks of the bodies that are several now. The list takes the place of the model's: it has the blocks of
 * that, too. */
static void keep_splits(tl_stage *stage, commit_scratch *scratch)
{
    tl_model *m = stage->model;
    tl_split *all = scratch->splits;
    size_t kept = 0;
    for (size_t i = 0; i < scratch->split_count; i++)
        all[i].block = scratch->ids[all[i].block];
    qsort(all, scratch->split_count, sizeof *all, compare_whole);
    for (size_t from = 0, to; from < scratch->split_count; from = to) {
        bool several = false;
        uint32_t body = m->blocks.body[tl_block_row_quiet(m, all[from].block)];
        for (to = from; to < scratch->split_count && all[to].whole == all[from].whole; to++)
            several = several || m->blocks.body[tl_block_row_quiet(m, all[to].block)] != body;
        for (size_t i = from; several && i < to; i++)
            all[kept++] = all[i];
    }
    if (kept == 0)
        return;
    qsort(all, kept, sizeof *all, compare_split);
    free(m->splits);
    m->splits = all;
    m->split_count = kept;
    m->split_capacity = stage->count + 1;
    scratch->splits = NULL;
}

/* group[row] of the rows whose blocks have the given ids, as tl_bodies_regroup wants it; `first` has room for
 * stage->next_body numbers. */
static void list_groups(const tl_stage *stage, const tl_id *ids, uint32_t *first, uint32_t *group)
{
    const tl_model *m = stage->model;
    for (uint32_t body = 0; body < stage->next_body; body++)
        first[body] = TL_NO_ROW;
    for (size_t i = 0; i < stage->count; i++) {
        uint32_t row = tl_block_row_quiet(m, ids[i]), body = stage->blocks[i].body;
        first[body] = row < first[body] ? row : first[body];
    }
    for (size_t i = 0; i < stage->count; i++)
        group[tl_block_row_quiet(m, ids[i])] = first[stage->blocks[i].body];
}

static void free_scratch(commit_scratch *scratch)
{
    tl_stage_seats_free(&scratch->seats);
    free(scratch->loads.of);
    free(scratch->loads.list);
    free(scratch->loads.faces);
    free(scratch->splits);
    free(scratch->keep);
    free(scratch->slot);
    free(scratch->sources);
    free(scratch->ids);
    free(scratch->gone);
    free(scratch->first);
    free(scratch->group);
}

/* Finds the blocks that stay and those that were cut. */
static bool sort_rows(const tl_stage *stage, size_t old, commit_scratch *scratch)
{
    scratch->keep = calloc(old + 1, 1);
    scratch->slot = malloc((old + 1) * sizeof *scratch->slot);
    if (!scratch->keep || !scratch->slot)
        return false;
    for (size_t row = 0; row < old; row++)
        scratch->slot[row] = TL_NO_ROW;
    for (size_t i = 0; i < stage->count; i++) {
        const tl_stage_block *block = &stage->blocks[i];
        if (block->source == TL_NO_ROW)
            continue;
        if (!tl_stage_made(block))
            scratch->keep[block->source] = 1;
        else if (scratch->slot[block->source] == TL_NO_ROW)
            scratch->slot[block->source] = (uint32_t)scratch->source_count++;
    }
    scratch->sources = malloc((scratch->source_count + 1) * sizeof *scratch->sources);
    return scratch->sources != NULL;
}

/* Room in the model's record for the cuts that were refused. */
static bool reserve_record(const tl_stage *stage)
{
    tl_cut_record *record = &stage->model->record;
    if (stage->refused_listed == 0)
        return true;
    size_t listed = record->listed + stage->refused_listed;
    tl_refused_cut *list = realloc(record->list, listed * sizeof *list);
    if (list)
        record->list = list;
    return list != NULL;
}

/* `old`: rows that the stage may replace, none of one that has not been opened. */
static bool reserve_scratch(tl_stage *stage, size_t old, size_t made, commit_scratch *scratch)
{
    size_t rows = stage->model->blocks.table.rows + made;
    scratch->ids = malloc((stage->count + 1) * sizeof *scratch->ids);
    scratch->splits = malloc((stage->count + 1) * sizeof *scratch->splits);
    scratch->gone = malloc((old + 1) * sizeof *scratch->gone);
    if (stage->regroups) {
        scratch->first = malloc((stage->next_body + (size_t)1) * sizeof *scratch->first);
        scratch->group = malloc((old + made + 1) * sizeof *scratch->group);
    }
    return sort_rows(stage, old, scratch) && scratch->ids && scratch->splits && scratch->gone &&
           (!stage->regroups || (scratch->first && scratch->group)) && rows < TL_NO_ROW && reserve_record(stage) &&
           take_loads(stage, &scratch->loads) && tl_stage_seats_take(stage, scratch->keep, old, &scratch->seats) &&
           (!has_contacts(stage->model) ||
            tl_grow(&stage->model->cut_parts, &stage->model->cut_part_capacity, stage->model->cut_part_count + made,
                    sizeof *stage->model->cut_parts)) &&
           tl_rows_reserve(stage->model, rows) &&
           (!stage->regroups || tl_rows_set_aside(stage->model, &scratch->aside));
}

/* Writes what the stage changed of the blocks that stay, and drops those it replaces; what their
 * children take over is kept aside. So new rows are written where they stay. */
static void drop_replaced(tl_stage *stage, size_t old, commit_scratch *scratch)
{
    tl_model *m = stage->model;
    for (size_t i = 0; i < stage->count; i++) {
        tl_stage_block *block = &stage->blocks[i];
        if (tl_stage_made(block))
            continue;
        scratch->ids[i] = m->blocks.id[block->source];
        m->blocks.group[block->source] = block->group;
        if (block->retagged) {
            scratch->gone[scratch->gone_count++] = m->blocks.shape[block->source];
            m->blocks.shape[block->source] = block->shape;
            tl_block_changes(m, block->source);
        }
    }
    /* a drive goes on for the children though none of its bodies is left in between */
    for (uint32_t row = 0; row < old; row++)
        if (scratch->slot[row] != TL_NO_ROW) {
            scratch->sources[scratch->slot[row]] = source_of(m, row);
            uint32_t drive = m->bodies.drive[m->blocks.body[row]];
            if (drive)
                m->drives[drive - 1].bodies++;
        }
    for (uint32_t row = 0; row < old; row++)
        if (!scratch->keep[row]) {
            scratch->gone[scratch->gone_count++] = m->blocks.shape[row];
            stage->changed_volume -= m->blocks.volume[row];
            tl_extremes_drop(m, row);
            m->blocks.stays[row] = false;
            m->gone++;
        }
    if (old)
        tl_rows_tidy(m);
}

/* Adds the blocks that were made, each as a body of its own. */
static void add_made(tl_stage *stage, size_t made, commit_scratch *scratch)
{
    tl_model *m = stage->model;
    uint32_t row = (uint32_t)m->blocks.table.rows, body = (uint32_t)m->bodies.table.rows;
    tl_table_resize(&m->blocks.table, row + made);
    tl_table_resize(&m->bodies.table, body + made);
    for (size_t i = 0; i < stage->count; i++) {
        const tl_stage_block *block = &stage->blocks[i];
        if (!tl_stage_made(block))
            continue;
        scratch->ids[i] = m->next_id;
        const source *from = block->source == TL_NO_ROW ? NULL : &scratch->sources[scratch->slot[block->source]];
        put(m, block, from, row, body++);
        stage->changed_volume += m->blocks.volume[row];
        row++;
    }
    for (size_t i = 0; i < scratch->source_count; i++)
        if (scratch->sources[i].drive)
            m->drives[scratch->sources[i].drive - 1].bodies--;
    m->structure++;
}

tl_status tl_stage_commit(tl_stage *stage)
{
    tl_model *m = stage->model;
    size_t old = stage->opened ? m->blocks.table.rows : 0, made = 0;
    for (size_t i = 0; i < stage->count; i++)
        made += tl_stage_made(&stage->blocks[i]);
    commit_scratch scratch = {0};
    tl_status status = tl_stage_settle(stage);
    if (status == TL_OK)
        status = tl_stage_check_cuts(stage);
    if (status == TL_OK && !reserve_scratch(stage, old, made, &scratch))
        status = tl_fail_memory(&m->error);
    if (status != TL_OK) {
        free_scratch(&scratch);
        tl_stage_end(stage);
        return status;
    }
    /* From here on nothing can fail but the grouping of blocks into bodies, for want of memory. */
    list_wholes(stage, &scratch);
    drop_replaced(stage, old, &scratch);
    add_made(stage, made, &scratch);
    summarize(stage, made);
    if (stage->regroups) {
        list_groups(stage, scratch.ids, scratch.first, scratch.group);
        status = tl_bodies_regroup(m, scratch.group);
        tl_rows_settle(m, &scratch.aside, status == TL_OK);
    }
    if (status == TL_OK) {
        give_loads(stage, scratch.ids, &scratch.loads);
        keep_record(stage, scratch.ids);
        keep_cut_parts(stage, &scratch);
        keep_splits(stage, &scratch);
        tl_stage_seats_give(stage, scratch.ids, &scratch.seats);
        for (size_t i = 0; i < scratch.gone_count; i++)
            tl_poly_free(scratch.gone[i]);
        stage->committed = true;
    }
    free_scratch(&scratch);
    tl_stage_end(stage);
    return status;
}
