/* points.c - contact points: cleared, and the states of their law, begun or carried over.
 *
 * A state is copied, split by area, or reset when the point's polygon changes, as its law declares. */
#include "contact/points.h"

#include "base/columns.h"

const tl_state *tl_kind_state(const tl_kind *kind, uint32_t k)
{
    return (const tl_state *)(const void *)((const char *)kind->states +
                                            (size_t)k * kind->state_stride);
}

static uint32_t state_width(const tl_state *state)
{
    return state->kind == TL_STATE_TANGENT ? 3 : 1;
}

uint32_t tl_kind_state_columns(const tl_kind *kind)
{
    uint32_t columns = 0;
    for (uint32_t k = 0; k < kind->state_count; k++)
        columns += state_width(tl_kind_state(kind, k));
    return columns;
}

void tl_point_clear(tl_points_table *p, size_t i)
{
    p->area[i] = p->f_n[i] = 0;
    if (p->f_n0)
        p->f_n0[i] = p->reference[i] = 0;
    p->flags[i] = p->key[i] = 0;
    for (int k = 0; k < 3; k++)
        p->p[k][i] = p->f_s[k][i] = 0;
    for (uint32_t k = 0; k < p->state_columns; k++)
        p->state[k][i] = 0;
}

tl_old_point tl_point_as_old(const tl_points_table *p, const tl_contacts *c, uint32_t contact,
                             size_t k, tl_vec3 arm)
{
    size_t i = tl_point_row(c, contact, k);
    double per_area = p->area[i] > 0 ? 1 / p->area[i] : 0;
    tl_old_point out = {.arm = arm,
                        .normal = c->facet[contact].last,
                        .shear = tl_v3_scale(per_area, tl_columns_get(p->f_s, i)),
                        .area = p->area[i],
                        .f_n = per_area * p->f_n[i],
                        .n0 = p->f_n0 ? per_area * p->f_n0[i] : 0,
                        .reference = p->f_n0 ? p->reference[i] : 0,
                        .key = p->key[i],
                        .flags = p->flags[i]};
    for (uint32_t s = 0; s < p->state_columns; s++)
        out.state[s] = p->state[s][i];
    return out;
}

void tl_point_load(tl_points_table *p, size_t i, const tl_sym3 *stress, tl_vec3 n, double closure,
                   double opening)
{
    tl_vec3 traction = tl_s3_mul(*stress, n);
    double normal = tl_v3_dot(n, traction);
    tl_vec3 shear = tl_v3_madd(traction, -normal, n);
    p->reference[i] += closure + opening;
    p->f_n0[i] = p->f_n[i] = -normal * p->area[i];
    tl_columns_put(p->f_s, i, tl_v3_scale(-p->area[i], shear));
    p->flags[i] = 0;
}

void tl_point_initial_state(tl_points_table *p, size_t i, const tl_kind *kind)
{
    for (uint32_t k = 0; k < p->state_columns; k++)
        p->state[k][i] = 0;
    uint32_t column = 0;
    for (uint32_t k = 0; kind && k < kind->state_count && column < p->state_columns; k++) {
        const tl_state *state = tl_kind_state(kind, k);
        if (state->kind == TL_STATE_SCALAR)
            p->state[column][i] = state->initial;
        column += state_width(state);
    }
}

void tl_point_begin(tl_points_table *p, size_t i, const tl_kind *kind)
{
    p->flags[i] = 0;
    tl_point_initial_state(p, i, kind);
}

/* Scales the split states to the new area; with `reset` false, states to be reset are kept. Energies go by their sum: tl_shear_keep. */
static void take_state(tl_points_table *p, size_t i, const tl_kind *kind, const double *old,
                       double old_area, bool reset)
{
    uint32_t column = 0;
    for (uint32_t k = 0; kind && k < kind->state_count && column < p->state_columns; k++) {
        const tl_state *state = tl_kind_state(kind, k);
        uint32_t width = state_width(state);
        double scale = 1;
        if (state->transfer == TL_TRANSFER_SPLIT)
            scale = old_area > 0 ? p->area[i] / old_area : 0;
        bool anew = state->transfer == TL_TRANSFER_RESET || state->transfer == TL_TRANSFER_ENERGY;
        if (!anew || !reset)
            for (uint32_t w = 0; w < width; w++)
                p->state[column + w][i] = scale * old[column + w];
        column += width;
    }
}

void tl_point_take_state(tl_points_table *p, size_t i, const tl_kind *kind, const double *old,
                         double old_area)
{
    take_state(p, i, kind, old, old_area, true);
}

void tl_point_keep_state(tl_points_table *p, size_t i, const tl_kind *kind, const double *old,
                         double old_area)
{
    take_state(p, i, kind, old, old_area, false);
}

void tl_point_clear_vectors(tl_points_table *p, size_t i, const tl_kind *kind)
{
    uint32_t column = 0;
    for (uint32_t k = 0; kind && k < kind->state_count && column < p->state_columns; k++) {
        const tl_state *state = tl_kind_state(kind, k);
        if (state->kind == TL_STATE_TANGENT)
            tl_columns_put(&p->state[column], i, tl_v3(0, 0, 0));
        column += state_width(state);
    }
}

void tl_point_turn_states(tl_points_table *p, size_t i, const tl_kind *kind, tl_vec3 from,
                          tl_vec3 to)
{
    uint32_t column = 0;
    bool turned = from.x != to.x || from.y != to.y || from.z != to.z;
    for (uint32_t k = 0; kind && turned && k < kind->state_count && column < p->state_columns;
         k++) {
        const tl_state *state = tl_kind_state(kind, k);
        if (state->kind == TL_STATE_TANGENT) {
            tl_vec3 v = tl_v3_turn(tl_columns_get(&p->state[column], i), from, to);
            tl_columns_put(&p->state[column], i, tl_v3_madd(v, -tl_v3_dot(v, to), to));
        }
        column += state_width(state);
    }
}

bool tl_points_hold_initial(tl_points_table *p)
{
    if (p->initial)
        return true;
    const tl_column columns[] = {TL_COLUMN_NEW(p, reference, TL_COLUMN_STEP),
                                 TL_COLUMN_NEW(p, f_n0, TL_COLUMN_STEP)};
    p->initial = tl_table_widen(&p->table, columns, 2);
    return p->initial;
}

bool tl_points_hold_states(tl_points_table *p, uint32_t columns)
{
    tl_column more[TL_STATE_COLUMNS];
    uint32_t count = 0;
    for (uint32_t k = p->state_columns; k < columns; k++)
        more[count++] = (tl_column)TL_COLUMN_NEW(p, state[k], TL_COLUMN_STEP);
    if (count && !tl_table_widen(&p->table, more, count))
        return false;
    p->state_columns += count;
    return true;
}
