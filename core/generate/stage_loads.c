/* stage_loads.c - loads of bodies that are cut go to their parts.
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
#include "generate/stage_loads.h"

#include "geometry/measure.h"
#include "model/inertia.h"
#include "model/loads.h"
#include "model/model.h"
#include "model/regroup.h"

#include <stdlib.h>
#include <string.h>

/* Tolerance: normals of a face and of its parts are off each other by rounding; so are places, over the size. */
#define SAME_FACE 1e-9
#define SAME_PLACE 1e-6
/* Tolerance: share of what is on faces up to which what is left of a load is rounding. */
#define NOTHING 1e-12

typedef struct tl_cut_load {
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
typedef struct tl_cut_face {
    tl_face_load load;
    uint32_t row; /* of the block before */
    cut_load *of;
    tl_vec3 normal;
    tl_lump plate, sum; /* of the face, and of its parts */
} cut_face;

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
static cut_face *faces_of(const tl_cut_loads *loads, uint32_t row)
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

static cut_face *next_of(const tl_cut_loads *loads, cut_face *face)
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
static bool take_faces(const tl_stage *stage, const uint32_t *slot, tl_cut_loads *loads)
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

bool tl_cut_loads_take(const tl_stage *stage, tl_cut_loads *loads)
{
    const tl_model *m = stage->model;
    size_t bodies = m->bodies.table.rows;
    *loads = (tl_cut_loads){.count = 0};
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
static void visit(const tl_stage *stage, const tl_id *ids, tl_cut_loads *loads, visit_fn *each)
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
static void visit_parts(const tl_stage *stage, const tl_id *ids, const tl_cut_loads *loads, visit_part_fn *each)
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
static void drop_faces(tl_model *m, const tl_cut_loads *loads)
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
static void sum_faces(const tl_stage *stage, const tl_id *ids, const tl_cut_loads *loads)
{
    visit_parts(stage, ids, loads, begin_face);
    for (size_t k = 0; k < loads->face_count; k++) {
        lump_close(&loads->faces[k].sum);
        if (!(loads->faces[k].sum.mass > 0))
            add_to_rest(&loads->faces[k], 1);
    }
    visit_parts(stage, ids, loads, add_face_inertia);
}

static void give_faces(const tl_stage *stage, const tl_id *ids, const tl_cut_loads *loads)
{
    tl_model *m = stage->model;
    if (loads->face_count == 0)
        return;
    drop_faces(m, loads);
    visit_parts(stage, ids, loads, give_face);
    tl_face_loads_set(m, m->face_loads, m->face_load_count, m->face_load_capacity);
}

void tl_cut_loads_give(const tl_stage *stage, const tl_id *ids, tl_cut_loads *loads)
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

void tl_cut_loads_free(tl_cut_loads *loads)
{
    free(loads->of);
    free(loads->list);
    free(loads->faces);
}
