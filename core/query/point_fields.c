/* point_fields.c - what can be asked of contact points: their fields, by name, and the states of their law. */
#include "query/point_fields.h"

#include "base/columns.h"
#include "contact/detection.h"
#include "contact/index.h"
#include "contact/law_states.h"
#include "contact/places.h"
#include "detect/detect.h"
#include "query/block_fields.h"
#include "query/contact_fields.h"
#include "query/meeting.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/fields.h>

typedef struct tl_value_of {
    size_t field;              /* index; the number of fields for a state */
    const tl_law_state *state; /* or NULL */
    size_t width;              /* numbers a value has */
} tl_value_of;

/* ---------------------------------------------------------------- states of laws ----------
 *
 * The states of the laws in use, by name, and their values at contacts and points.
 *
 * A state has the name that its law declares. Where a field of contacts or points, or an array of the contacts'
 * files, has that name, it is read as law_NAME. Two laws may declare the same name, once a number and once a vector.
 * The later one is then read as LAW_NAME, with the name of the law. */

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

/* First column of the state of a law that an entry stands for, or TL_NO_ROW. */
static uint32_t column_in(const tl_kind *kind, const tl_law_state *of)
{
    for (tl_state_columns at = {0}; tl_state_next(kind, UINT32_MAX, &at);)
        if (strcmp(at.state->name, of->state->name) == 0 && at.count == of->width)
            return at.begin;
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
static void add(tl_law_states *states, const tl_kind *kind, const tl_state_columns *columns)
{
    const tl_state *state = columns->state;
    bool shared = false; /* its name is that of another entry */
    for (size_t i = 0; i < states->count; i++) {
        if (strcmp(states->at[i].state->name, state->name) != 0)
            continue;
        if (states->at[i].width == columns->count)
            return;
        shared = true;
    }
    tl_law_state *entry = &states->at[states->count++];
    *entry = (tl_law_state){.state = state, .width = columns->count};
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
        for (tl_state_columns at = {0}; !seen_before(m, i) && tl_state_next(m->joint_laws[i].kind, UINT32_MAX, &at);)
            add(states, m->joint_laws[i].kind, &at);
    states->column = malloc(m->joint_law_count * states->count * sizeof *states->column);
    if (!states->column) {
        tl_law_states_free(states);
        return tl_fail_memory(&m->error);
    }
    for (size_t i = 0; i < m->joint_law_count; i++)
        for (size_t s = 0; s < states->count; s++)
            states->column[i * states->count + s] = column_in(m->joint_laws[i].kind, &states->at[s]);
    return TL_OK;
}

void tl_law_states_free(tl_law_states *states)
{
    free(states->at);
    free(states->column);
    *states = (tl_law_states){0};
}

/* The entry of a name, or NULL. */
static const tl_law_state *law_states_find(const tl_law_states *states, const char *name)
{
    for (size_t i = 0; i < states->count; i++)
        if (strcmp(states->at[i].name, name) == 0)
            return &states->at[i];
    return NULL;
}

/* ---------------------------------------------------------------- values ----------------- */

/* First column of an entry in the law of a contact, or TL_NO_ROW. */
static uint32_t column_of(const tl_model *m, const tl_law_states *states, const tl_law_state *of, uint32_t contact)
{
    const uint32_t law =
        tl_row_is_meeting(m, contact) ? tl_meeting_named(m, contact).law : m->detect->contacts.law[contact];
    if (law == TL_NO_ROW)
        return TL_NO_ROW;
    return states->column[law * states->count + (size_t)(of - states->at)];
}

/* Whether the law of a contact has the state. */
static bool law_states_has(const tl_model *m, const tl_law_states *states, const tl_law_state *of, uint32_t contact)
{
    return column_of(m, states, of, contact) != TL_NO_ROW;
}

/* A column that no law needs is not kept: all of it is 0. */
static double number_at(const tl_points_table *p, uint32_t column, size_t row)
{
    return column < p->state_columns ? p->state[column][row] : 0;
}

void tl_law_state_of_contact(const tl_model *m, const tl_law_states *states, const tl_law_state *of, uint32_t contact,
                             double value[3])
{
    const tl_points_table *p = &m->detect->points;
    uint32_t column = column_of(m, states, of, contact);
    size_t count = tl_point_count(m, contact);
    bool adds = of->state->transfer == TL_TRANSFER_SPLIT || of->state->transfer == TL_TRANSFER_ENERGY;
    if (tl_row_is_meeting(m, contact) && column != TL_NO_ROW) {
        tl_meeting_state(m, contact, column, of->width, adds, value);
        return;
    }
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

double tl_law_states_slip(const tl_model *m, const tl_law_states *states, uint32_t contact, tl_vec3 shear_displacement)
{
    for (size_t i = 0; i < states->count; i++) {
        const tl_law_state *state = &states->at[i];
        double value[3];
        if (state->width != 1 || strcmp(state->state->name, "slip") != 0 || !law_states_has(m, states, state, contact))
            continue;
        tl_law_state_of_contact(m, states, state, contact, value);
        return value[0];
    }
    return tl_v3_norm(shear_displacement);
}

/* ---------------------------------------------------------------- one field of all --------
 *
 * Fields and states of many blocks or contacts, by name, as one list of numbers. */

/* "a block has no field 'velocty'; did you mean 'velocity'?" */
static tl_status unknown_name(tl_model *m, const char *item, const tl_field *fields, size_t count,
                              const tl_law_states *states, const char *name)
{
    size_t more = states ? states->count : 0;
    const char **names = malloc((count + more + 1) * sizeof *names);
    if (!names)
        return tl_fail_memory(&m->error);
    for (size_t i = 0; i < count; i++)
        names[i] = fields[i].name;
    for (size_t i = 0; i < more; i++)
        names[count + i] = states->at[i].name;
    const char *nearest = tl_nearest_name(name, names, count + more);
    free(names);
    return tl_fail(&m->error, TL_E_NOT_FOUND, "a %s has no field%s '%.80s'%s%s%s", item, states ? " or state" : "",
                   name, nearest ? "; did you mean '" : "", nearest ? nearest : "", nearest ? "'?" : "");
}

/* Looks a name up among fields and, unless NULL, states. `item` is "block". The text `state` is taken for a number;
 * other texts are refused. */
static tl_status value_find(tl_model *m, const char *item, const tl_field *fields, size_t count,
                            const tl_law_states *states, const char *name, tl_value_of *of)
{
    *of = (tl_value_of){.field = count};
    for (size_t i = 0; i < count; i++) {
        if (strcmp(fields[i].name, name) != 0)
            continue;
        of->field = i;
        of->width = strcmp(name, "state") == 0 ? 1 : tl_field_width(fields[i].kind);
        if (of->width == 0)
            return tl_fail(&m->error, TL_E_ARGUMENT, "the field '%s' of a %s is a text, no number", name, item);
        return TL_OK;
    }
    of->state = states ? law_states_find(states, name) : NULL;
    if (!of->state)
        return unknown_name(m, item, fields, count, states, name);
    of->width = of->state->width;
    return TL_OK;
}

/* The same of contacts or their points, which it brings up to date: lists the states of their laws, to be freed in
 * any case. */
static tl_status contact_value_find(tl_model *m, const char *item, const tl_field *fields, size_t count,
                                    tl_law_states *states, const char *name, tl_value_of *of)
{
    *states = (tl_law_states){0};
    tl_status status = tl_detect_refresh(m);
    if (status == TL_OK)
        status = tl_law_states_list(m, states);
    return status == TL_OK ? value_find(m, item, fields, count, states, name, of) : status;
}

tl_status tl_blocks_values(tl_model *m, const tl_id *ids, size_t count, const char *field, double *out, size_t *width)
{
    size_t all;
    const tl_field *fields = tl_block_fields(&all);
    tl_value_of of;
    tl_status status = value_find(m, "block", fields, all, NULL, field, &of);
    if (status != TL_OK)
        return status;
    *width = of.width;
    for (size_t i = 0; i < count && out; i++) {
        tl_field_value value;
        status = tl_block_field(m, ids[i], of.field, &value);
        if (status != TL_OK)
            return status;
        memcpy(out + i * of.width, value.number, of.width * sizeof *out);
    }
    return TL_OK;
}

/* One value of a contact. */
static tl_status contact_value(tl_model *m, const tl_law_states *states, const tl_value_of *of, tl_contact_name contact,
                               double *out)
{
    uint32_t row;
    tl_status status = tl_contact_find(m, contact, &row);
    if (status != TL_OK)
        return status;
    if (of->state) {
        tl_law_state_of_contact(m, states, of->state, row, out);
        return TL_OK;
    }
    size_t all;
    const tl_contact_facts facts = tl_contact_facts_of(m, row);
    tl_contact_numbers(&facts, &tl_contact_fields(&all)[of->field], out);
    return TL_OK;
}

tl_status tl_contacts_values(tl_model *m, const tl_contact_name *contacts, size_t count, const char *name, double *out,
                             size_t *width)
{
    size_t all;
    const tl_field *fields = tl_contact_fields(&all);
    tl_law_states states;
    tl_value_of of;
    tl_status status = contact_value_find(m, "contact", fields, all, &states, name, &of);
    if (status == TL_OK) {
        *width = of.width;
        for (size_t i = 0; i < count && out && status == TL_OK; i++)
            status = contact_value(m, &states, &of, contacts[i], out + i * of.width);
    }
    tl_law_states_free(&states);
    return status;
}

tl_status tl_states_list(tl_model *m, const tl_contact_name *contact, tl_law_state **list, size_t *count)
{
    *list = NULL;
    *count = 0;
    tl_law_states states = {0};
    uint32_t row = TL_NO_ROW;
    tl_status status = contact ? tl_contact_find(m, *contact, &row) : TL_OK;
    if (status == TL_OK)
        status = tl_law_states_list(m, &states);
    if (status != TL_OK)
        return status;
    *list = malloc((states.count + 1) * sizeof **list);
    for (size_t i = 0; i < states.count && *list; i++)
        if (!contact || law_states_has(m, &states, &states.at[i], row))
            (*list)[(*count)++] = states.at[i];
    tl_law_states_free(&states);
    return *list ? TL_OK : tl_fail_memory(&m->error);
}

/* ---------------------------------------------------------------- points ------------------ */

/* Columns of points, of contacts or of segments. */
typedef struct columns {
    const double *area, *f_n, *reference; /* the last may be NULL */
    double *const *f_s, *const *state;
    const uint32_t *flags;
    uint32_t state_columns;
} columns;

static columns columns_of(const tl_model *m, uint32_t contact)
{
    const tl_points_table *p = &m->detect->points;
    if (!tl_row_is_meeting(m, contact))
        return (columns){p->area, p->f_n, p->reference, p->f_s, p->state, p->flags, p->state_columns};
    const tl_segment_points *s = &m->segments->points;
    return (columns){s->area, s->f_n, s->reference, s->f_s, s->state, s->flags, s->state_columns};
}

/* Points that are told of: of segments all, with the forces of their law. */
static size_t count_of(const tl_model *m, uint32_t contact)
{
    return tl_row_is_meeting(m, contact) ? tl_meeting_point_count(m, contact) : tl_point_count(m, contact);
}

/* The fields: name, kind, unit, what they are, and the value of point k of a contact for writer w, in `row` of points
 * p. */
#define POINT_FIELDS(FIELD)                                                                                            \
    FIELD(position, VEC3, "m", "present place of the point", tl_v3_add(w->model->origin, w->place[k]))                 \
    FIELD(area, SCALAR, "m2", "share of the contact's area", p->area[row])                                             \
    FIELD(normal_force, SCALAR, "N", "compression positive", p->f_n[row])                                              \
    FIELD(shear_force, VEC3, "N", "on the second block", tl_columns_get(p->f_s, row))                                  \
    FIELD(gap, SCALAR, "m",                                                                                            \
          "of the walls at the point, negative when overlapping; of a field contact the mean "                         \
          "over its area",                                                                                             \
          w->gap[k])                                                                                                   \
    FIELD(closure, SCALAR, "m", "how far the walls have approached since the law's reference state",                   \
          -w->gap[k] - (p->reference ? p->reference[row] : 0))                                                         \
    FIELD(state, TEXT, "", "\"elastic\", \"slipping\", \"open\" or \"failed\"",                                        \
          tl_contact_state_of_flags(p->flags[row], p->flags[row]))

#define NUMBER(name, kind, unit, doc, value) F_##name,
#define FIELD(name, kind, unit, doc, value) {#name, TL_FIELD_##kind, unit, doc},
#define CASE(name, kind, unit, doc, value)                                                                             \
    case F_##name: TL_FIELD_PUT(w->out, value); break;

enum { POINT_FIELDS(NUMBER) F_COUNT };

static const tl_field fields[F_COUNT] = {POINT_FIELDS(FIELD)};

const tl_field *tl_point_fields(size_t *count)
{
    *count = F_COUNT;
    return fields;
}

tl_status tl_points_start(tl_model *m, const tl_contact_name *contacts, size_t count, size_t *start)
{
    tl_status status = tl_detect_refresh(m);
    start[0] = 0;
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        uint32_t row;
        status = tl_contact_find(m, contacts[i], &row);
        if (status == TL_OK)
            start[i + 1] = start[i] + count_of(m, row);
    }
    return status;
}

/* ---------------------------------------------------------------- columns ---------------- */

/* What is written, and the places and gaps of the points of the contact at hand. */
typedef struct writer {
    const tl_model *model;
    const tl_law_states *states;
    tl_value_of of;
    tl_vec3 *place;
    double *gap;
    size_t capacity;
    double *out;
} writer;

/* Makes room for the places of so many points; false when out of memory. */
static bool reserve(writer *w, size_t count)
{
    if (count <= w->capacity)
        return true;
    free(w->place);
    free(w->gap);
    w->place = malloc(count * sizeof *w->place);
    w->gap = malloc(count * sizeof *w->gap);
    w->capacity = w->place && w->gap ? count : 0;
    return w->capacity > 0;
}

/* Puts the state of a law at a point: NaN where the contact's law has none of that name. A column that no law needs is
 * not kept: all of it is 0. */
static void put_state(const writer *w, uint32_t contact, const columns *p, size_t row)
{
    const uint32_t column = column_of(w->model, w->states, w->of.state, contact);
    for (uint32_t k = 0; k < w->of.width; k++)
        w->out[k] = column == TL_NO_ROW ? NAN : column + k < p->state_columns ? p->state[column + k][row] : 0;
}

static void write_point(writer *w, uint32_t contact, const columns *p, size_t k)
{
    const bool meeting = tl_row_is_meeting(w->model, contact);
    const size_t row = meeting ? tl_meeting_point(w->model, contact, k, &w->place[k], &w->gap[k])
                               : tl_point_row(&w->model->detect->contacts, contact, k);
    switch (w->of.field) {
        POINT_FIELDS(CASE)
    default: put_state(w, contact, p, row);
    }
    w->out += w->of.width;
}

static tl_status write_contact(tl_model *m, writer *w, tl_contact_name name)
{
    uint32_t row;
    tl_status status = tl_contact_find(m, name, &row);
    if (status != TL_OK)
        return status;
    const bool meeting = tl_row_is_meeting(m, row);
    const size_t count = count_of(m, row);
    const columns from = columns_of(m, row);
    if (count == 0)
        return TL_OK;
    if (!reserve(w, meeting ? count : m->detect->contacts.point_count[row]))
        return tl_fail_memory(&m->error);
    if (!meeting && (w->of.field == F_position || w->of.field == F_gap || w->of.field == F_closure))
        tl_contact_point_places(m, row, w->place, w->gap);
    for (size_t k = 0; k < count; k++)
        write_point(w, row, &from, k);
    return TL_OK;
}

tl_status tl_points_values(tl_model *m, const tl_contact_name *contacts, size_t count, const char *name, double *out,
                           size_t *width)
{
    tl_law_states states;
    tl_value_of of;
    tl_status status = contact_value_find(m, "contact point", fields, F_COUNT, &states, name, &of);
    if (status == TL_OK) {
        writer w = {.model = m, .states = &states, .of = of, .out = out};
        *width = of.width;
        for (size_t i = 0; i < count && out && status == TL_OK; i++)
            status = write_contact(m, &w, contacts[i]);
        free(w.place);
        free(w.gap);
    }
    tl_law_states_free(&states);
    return status;
}
