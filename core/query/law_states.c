/* law_states.c - the states of the laws in use, by name, and their values at contacts and points.
 *
 * A state has the name that its law declares. Where a field of contacts or points, or an array of the contacts' files, has
 * that name, it is read as law_NAME. Two laws may declare the same name, once a number and once a vector: the later one is
 * then read as LAW_NAME, with the name of the law. */
#include "query/law_states.h"

#include "contact/detection.h"
#include "query/contact_fields.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Names that are taken besides the fields of contacts: fields of points, and arrays of the contacts' files. */
static const char *const more_names[] = {"position", "closure",    "points",  "states",
                                         "plane",    "contact_id", "block_a", "block_b"};

static bool is_taken(const char *name)
{
    size_t count;
    const tl_field *fields = tl_contact_fields(&count);
    for (size_t i = 0; i < count; i++)
        if (strcmp(fields[i].name, name) == 0)
            return true;
    for (size_t i = 0; i < sizeof more_names / sizeof more_names[0]; i++)
        if (strcmp(more_names[i], name) == 0)
            return true;
    return false;
}

static uint32_t width_of(const tl_state *state)
{
    return state->kind == TL_STATE_TANGENT ? 3 : 1;
}

static const tl_state *state_at(const tl_kind *kind, uint32_t k)
{
    return (const tl_state *)(const void *)((const char *)kind->states +
                                            (size_t)k * kind->state_stride);
}

/* First column of the state of a law that an entry stands for, or TL_NO_ROW. */
static uint32_t column_in(const tl_kind *kind, const tl_law_state *of)
{
    uint32_t column = 0;
    for (uint32_t k = 0; k < kind->state_count; k++) {
        const tl_state *state = state_at(kind, k);
        if (strcmp(state->name, of->state->name) == 0 && width_of(state) == of->width)
            return column;
        column += width_of(state);
    }
    return TL_NO_ROW;
}

/* Whether an earlier joint law is of this kind. */
static bool seen_before(const tl_model *m, size_t law)
{
    for (size_t i = 0; i < law; i++)
        if (m->joint_laws[i].kind == m->joint_laws[law].kind)
            return true;
    return false;
}

/* Adds a state of a law unless an entry stands for it. There is room. */
static void add(tl_law_states *states, const tl_kind *kind, const tl_state *state)
{
    bool shared = false; /* its name is that of another entry */
    for (size_t i = 0; i < states->count; i++) {
        if (strcmp(states->at[i].state->name, state->name) != 0)
            continue;
        if (states->at[i].width == width_of(state))
            return;
        shared = true;
    }
    tl_law_state *entry = &states->at[states->count++];
    *entry = (tl_law_state){.state = state, .width = width_of(state)};
    snprintf(entry->name, sizeof entry->name, "%.60s%s%.60s",
             shared                  ? kind->name
             : is_taken(state->name) ? "law"
                                     : "",
             shared || is_taken(state->name) ? "_" : "", state->name);
}

tl_status tl_law_states_list(tl_model *m, tl_law_states *states)
{
    *states = (tl_law_states){0};
    size_t most = 0;
    for (size_t i = 0; i < m->joint_law_count; i++)
        if (!seen_before(m, i))
            most += m->joint_laws[i].kind->state_count;
    if (most == 0)
        return TL_OK;
    states->at = malloc(most * sizeof *states->at);
    if (!states->at)
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < m->joint_law_count; i++)
        for (uint32_t k = 0; k < m->joint_laws[i].kind->state_count && !seen_before(m, i); k++)
            add(states, m->joint_laws[i].kind, state_at(m->joint_laws[i].kind, k));
    states->column = malloc(m->joint_law_count * states->count * sizeof *states->column);
    if (!states->column) {
        tl_law_states_free(states);
        return tl_fail_memory(&m->error);
    }
    for (size_t i = 0; i < m->joint_law_count; i++)
        for (size_t s = 0; s < states->count; s++)
            states->column[i * states->count + s] =
                column_in(m->joint_laws[i].kind, &states->at[s]);
    return TL_OK;
}

void tl_law_states_free(tl_law_states *states)
{
    free(states->at);
    free(states->column);
    *states = (tl_law_states){0};
}

const tl_law_state *tl_law_states_find(const tl_law_states *states, const char *name)
{
    for (size_t i = 0; i < states->count; i++)
        if (strcmp(states->at[i].name, name) == 0)
            return &states->at[i];
    return NULL;
}

/* ---------------------------------------------------------------- values ----------------- */

/* First column of an entry in the law of a contact, or TL_NO_ROW. */
static uint32_t column_of(const tl_model *m, const tl_law_states *states, const tl_law_state *of,
                          uint32_t contact)
{
    uint32_t law = m->detect->contacts.law[contact];
    if (law == TL_NO_ROW)
        return TL_NO_ROW;
    return states->column[law * states->count + (size_t)(of - states->at)];
}

bool tl_law_states_has(const tl_model *m, const tl_law_states *states, const tl_law_state *of,
                       uint32_t contact)
{
    return column_of(m, states, of, contact) != TL_NO_ROW;
}

/* A column that no law needs is not kept: all of it is 0. */
static double number_at(const tl_points_table *p, uint32_t column, size_t row)
{
    return column < p->state_columns ? p->state[column][row] : 0;
}

void tl_law_state_at_point(const tl_model *m, const tl_law_states *states, const tl_law_state *of,
                           uint32_t contact, size_t k, double value[3])
{
    uint32_t column = column_of(m, states, of, contact);
    size_t row = tl_point_row(&m->detect->contacts, contact, k);
    for (size_t w = 0; w < of->width; w++)
        value[w] =
            column == TL_NO_ROW ? NAN : number_at(&m->detect->points, column + (uint32_t)w, row);
}

void tl_law_state_of_contact(const tl_model *m, const tl_law_states *states, const tl_law_state *of,
                             uint32_t contact, double value[3])
{
    const tl_points_table *p = &m->detect->points;
    uint32_t column = column_of(m, states, of, contact);
    size_t count = tl_point_count(m, contact);
    bool adds =
        of->state->transfer == TL_TRANSFER_SPLIT || of->state->transfer == TL_TRANSFER_ENERGY;
    double area = 0, sum[3] = {0, 0, 0};
    for (size_t k = 0; k < count && column != TL_NO_ROW; k++) {
        size_t row = tl_point_row(&m->detect->contacts, contact, k);
        double weight = adds ? 1 : p->area[row];
        area += weight;
        for (size_t w = 0; w < of->width; w++)
            sum[w] += weight * number_at(p, column + (uint32_t)w, row);
    }
    for (size_t w = 0; w < of->width; w++)
        value[w] = column == TL_NO_ROW ? NAN : adds ? sum[w] : area > 0 ? sum[w] / area : 0;
}

double tl_law_states_slip(const tl_model *m, const tl_law_states *states, uint32_t contact,
                          tl_vec3 shear_displacement)
{
    for (size_t i = 0; i < states->count; i++) {
        const tl_law_state *state = &states->at[i];
        double value[3];
        if (state->width != 1 || strcmp(state->state->name, "slip") != 0 ||
            !tl_law_states_has(m, states, state, contact))
            continue;
        tl_law_state_of_contact(m, states, state, contact, value);
        return value[0];
    }
    return tl_v3_norm(shear_displacement);
}
