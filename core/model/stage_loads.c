/* stage_loads.c - loads of bodies that a staging set cuts go to their parts.
 *
 * A load with a point goes to the part that has the point. One without a point acts on the body as a whole, and its force F and moment M
 * are spread over the parts as weight is: with the mass m, the inertia I and the centroid r of the whole, each part p gets
 *
 *     F_p = m_p (F/m + alpha x (r_p - r)),    M_p = I_p alpha,    I alpha = M
 *
 * so that the parts go on as the whole, and what their joint carries stays. Sums of force and moment are those of the whole. */
#include "model/stage_loads.h"

#include "model/inertia.h"
#include "model/wrench.h"

#include <stdlib.h>

/* What the blocks of a cut body sum up to. */
typedef struct mass_sum {
    double mass;
    tl_vec3 place; /* centroid, relative to the origin */
    tl_sym3 inertia;
} mass_sum;

struct tl_cut_load {
    tl_body_load load;
    tl_wrench before; /* of the last step, where loads have been set since */
    tl_vec3 point;    /* where the load acts, relative to the origin */
    bool placed;      /* it has been given a point */
    mass_sum sum;
    uint32_t nearest; /* row of the block that has the point, or is nearest to it */
    double distance;
};

static bool is_cut(const tl_stage_block *block)
{
    return block->source != TL_NO_ROW && block->owned && !block->retagged;
}

static tl_cut_load load_of(const tl_model *m, uint32_t body)
{
    const tl_bodies *b = &m->bodies;
    tl_body_load load = b->load[body];
    tl_vec3 arm = tl_m3_mul(&b->pose[body].r, load.arm);
    return (tl_cut_load){.load = load,
                         .before = b->load_before[body],
                         .placed = !tl_v3_is_zero(load.arm),
                         .point = tl_v3_add(tl_body_place(b, body), arm),
                         .nearest = TL_NO_ROW,
                         .distance = INFINITY};
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
        if (!is_cut(&stage->blocks[i]) || slot[m->blocks.body[row]] != TL_NO_ROW)
            continue;
        slot[m->blocks.body[row]] = (uint32_t)loads->count;
        loads->list[loads->count++] = load_of(m, m->blocks.body[row]);
    }
    for (size_t i = 0; enough && i < stage->count; i++) {
        uint32_t row = stage->blocks[i].source;
        loads->of[i] = row == TL_NO_ROW ? TL_NO_ROW : slot[m->blocks.body[row]];
    }
    free(slot);
    return enough;
}

/* ---------------------------------------------------------------- given ------------------ */

typedef void visit_fn(tl_model *m, uint32_t row, tl_cut_load *load);

/* Visits the blocks that bodies with loads have become, in their order. */
static void visit(const tl_stage *stage, const tl_id *ids, tl_cut_loads *loads, visit_fn *each)
{
    tl_model *m = stage->model;
    for (size_t i = 0; i < stage->count; i++)
        if (loads->of[i] != TL_NO_ROW && m->row_of[ids[i]] != TL_NO_ROW)
            each(m, m->row_of[ids[i]], &loads->list[loads->of[i]]);
}

static tl_vec3 place_of(const tl_model *m, uint32_t row)
{
    uint32_t body = m->blocks.body[row];
    return tl_v3_add(tl_body_place(&m->bodies, body),
                     tl_m3_mul(&m->bodies.pose[body].r, tl_block_local(m, row)));
}

static double mass_of(const tl_model *m, uint32_t row)
{
    return m->blocks.density[row] * m->blocks.volume[row];
}

/* How far a place lies before the faces of a block; negative inside. */
static double distance_of(const tl_model *m, uint32_t row, tl_vec3 place)
{
    const tl_poly *shape = m->blocks.shape[row];
    uint32_t body = m->blocks.body[row];
    tl_vec3 x =
        tl_m3_tmul(&m->bodies.pose[body].r, tl_v3_sub(place, tl_body_place(&m->bodies, body)));
    double most = -INFINITY;
    for (uint32_t f = 0; f < shape->face_count; f++)
        most = fmax(most, tl_v3_dot(shape->plane[f].normal, x) - shape->plane[f].offset);
    return most;
}

/* Takes the load off the block's body, and adds its mass. */
static void begin(tl_model *m, uint32_t row, tl_cut_load *of)
{
    uint32_t body = m->blocks.body[row];
    double mass = mass_of(m, row), distance = distance_of(m, row, of->point);
    m->bodies.load[body] = (tl_body_load){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    m->bodies.load_before[body] = (tl_wrench){{0, 0, 0}, {0, 0, 0}};
    of->sum.mass += mass;
    of->sum.place = tl_v3_madd(of->sum.place, mass, place_of(m, row));
    if (distance < of->distance) {
        of->distance = distance;
        of->nearest = row;
    }
}

static void add_inertia(tl_model *m, uint32_t row, tl_cut_load *of)
{
    tl_vec3 d = tl_v3_sub(place_of(m, row), of->sum.place);
    tl_sym3 add = tl_inertia_about(tl_block_inertia(m, row), mass_of(m, row), d);
    tl_sym3 *to = &of->sum.inertia;
    *to = (tl_sym3){to->xx + add.xx, to->yy + add.yy, to->zz + add.zz,
                    to->xy + add.xy, to->yz + add.yz, to->zx + add.zx};
}

/* The angular acceleration that a moment gives to a body without a spin. */
static tl_vec3 turned_by(tl_sym3 a, tl_vec3 moment)
{
    return tl_solve3(tl_v3(a.xx, a.xy, a.zx), tl_v3(a.xy, a.yy, a.yz), tl_v3(a.zx, a.yz, a.zz),
                     moment);
}

/* The share of a block in a wrench on the whole, about the centroid of the block's body. */
static tl_wrench share_of(const tl_model *m, uint32_t row, const mass_sum *sum, tl_wrench whole)
{
    tl_vec3 turn = turned_by(sum->inertia, whole.moment), place = place_of(m, row);
    tl_vec3 arm = tl_v3_sub(place, tl_body_place(&m->bodies, m->blocks.body[row]));
    tl_vec3 a = tl_v3_scale(1 / sum->mass, whole.force);
    a = tl_v3_add(a, tl_v3_cross(turn, tl_v3_sub(place, sum->place)));
    tl_vec3 force = tl_v3_scale(mass_of(m, row), a);
    tl_vec3 moment = tl_s3_mul(tl_block_inertia(m, row), turn);
    return (tl_wrench){force, tl_v3_add(moment, tl_v3_cross(arm, force))};
}

static tl_wrench added(tl_wrench a, tl_wrench b)
{
    return (tl_wrench){tl_v3_add(a.force, b.force), tl_v3_add(a.moment, b.moment)};
}

/* Gives a block's body the block's part of the load. */
static void give(tl_model *m, uint32_t row, tl_cut_load *of)
{
    uint32_t body = m->blocks.body[row];
    tl_body_load *load = &m->bodies.load[body];
    if (m->loads_changed)
        m->bodies.load_before[body] =
            added(m->bodies.load_before[body], share_of(m, row, &of->sum, of->before));
    if (!of->placed) {
        tl_wrench part = share_of(m, row, &of->sum, (tl_wrench){of->load.force, of->load.moment});
        load->force = tl_v3_add(load->force, part.force);
        load->moment = tl_v3_add(load->moment, part.moment);
    } else if (row == of->nearest) {
        tl_vec3 arm = tl_v3_sub(of->point, tl_body_place(&m->bodies, body));
        *load = (tl_body_load){of->load.force, of->load.moment,
                               tl_m3_tmul(&m->bodies.pose[body].r, arm)};
    }
}

/* The mean place is the sum over the mass. */
static void close_sums(tl_cut_loads *loads)
{
    for (size_t k = 0; k < loads->count; k++) {
        mass_sum *sum = &loads->list[k].sum;
        if (sum->mass > 0)
            sum->place = tl_v3_scale(1 / sum->mass, sum->place);
    }
}

void tl_cut_loads_give(const tl_stage *stage, const tl_id *ids, tl_cut_loads *loads)
{
    if (loads->count == 0)
        return;
    visit(stage, ids, loads, begin);
    close_sums(loads);
    visit(stage, ids, loads, add_inertia);
    visit(stage, ids, loads, give);
}

void tl_cut_loads_free(tl_cut_loads *loads)
{
    free(loads->of);
    free(loads->list);
    *loads = (tl_cut_loads){.count = 0};
}
