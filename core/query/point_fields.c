/* point_fields.c - what can be asked of contact points: their fields, by name, and the states of their law. */
#include "contact/index.h"
#include "contact/places.h"
#include "detect/detect.h"
#include "query/contact_fields.h"
#include "query/law_states.h"
#include "query/values.h"

#include <stdlib.h>
#include <talus/fields.h>

enum { F_POSITION, F_AREA, F_NORMAL_FORCE, F_SHEAR_FORCE, F_GAP, F_CLOSURE, F_STATE, F_COUNT };

static const tl_field fields[F_COUNT] = {
    [F_POSITION] = {"position", TL_FIELD_VEC3, "m", "present place of the point"},
    [F_AREA] = {"area", TL_FIELD_SCALAR, "m2", "share of the contact's area"},
    [F_NORMAL_FORCE] = {"normal_force", TL_FIELD_SCALAR, "N", "compression positive"},
    [F_SHEAR_FORCE] = {"shear_force", TL_FIELD_VEC3, "N", "on the second block"},
    [F_GAP] = {"gap", TL_FIELD_SCALAR, "m",
               "of the walls at the point, negative when overlapping; of a field contact the mean "
               "over its area"},
    [F_CLOSURE] = {"closure", TL_FIELD_SCALAR, "m",
                   "how far the walls have approached since the law's reference state"},
    [F_STATE] = {"state", TL_FIELD_TEXT, "", "\"elastic\", \"slipping\", \"open\" or \"failed\""},
};

const tl_field *tl_point_fields(size_t *count)
{
    *count = F_COUNT;
    return fields;
}

tl_status tl_points_start(tl_model *m, const tl_id *contacts, size_t count, size_t *start)
{
    tl_status status = tl_detect_refresh(m);
    start[0] = 0;
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        uint32_t row;
        status = tl_contact_find(m, contacts[i], &row);
        if (status == TL_OK)
            start[i + 1] = start[i] + tl_point_count(m, row);
    }
    return status;
}

/* ---------------------------------------------------------------- columns ---------------- */

/* What is written, and the places and gaps of the points of the contact at hand. */
typedef struct writer {
    const tl_model *model;
    size_t field; /* or F_COUNT: a state */
    const tl_law_states *states;
    const tl_law_state *state;
    tl_vec3 *place;
    double *gap;
    size_t capacity;
    double *out;
} writer;

static double *put_vector(double *out, tl_vec3 v)
{
    *out++ = v.x;
    *out++ = v.y;
    *out++ = v.z;
    return out;
}

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

static void write_point(writer *w, uint32_t contact, size_t k)
{
    const tl_points_table *p = &w->model->detect->points;
    size_t row = tl_point_row(&w->model->detect->contacts, contact, k);
    switch (w->field) {
    case F_POSITION: w->out = put_vector(w->out, tl_v3_add(w->model->origin, w->place[k])); break;
    case F_AREA: *w->out++ = p->area[row]; break;
    case F_NORMAL_FORCE: *w->out++ = p->f_n[row]; break;
    case F_SHEAR_FORCE:
        w->out = put_vector(w->out, tl_v3(p->f_s[0][row], p->f_s[1][row], p->f_s[2][row]));
        break;
    case F_GAP: *w->out++ = w->gap[k]; break;
    case F_CLOSURE: *w->out++ = -w->gap[k] - (p->reference ? p->reference[row] : 0); break;
    case F_STATE: *w->out++ = tl_contact_state_of_flags(p->flags[row], p->flags[row]); break;
    default:
        tl_law_state_at_point(w->model, w->states, w->state, contact, k, w->out);
        w->out += w->state->width;
    }
}

static tl_status write_contact(tl_model *m, writer *w, tl_id id)
{
    uint32_t row;
    tl_status status = tl_contact_find(m, id, &row);
    if (status != TL_OK)
        return status;
    if (w->field == F_POSITION || w->field == F_GAP || w->field == F_CLOSURE) {
        if (!reserve(w, m->detect->contacts.point_count[row]))
            return tl_fail_memory(&m->error);
        tl_contact_point_places(m, row, w->place, w->gap);
    }
    for (size_t k = 0; k < tl_point_count(m, row); k++)
        write_point(w, row, k);
    return TL_OK;
}

tl_status tl_points_values(tl_model *m, const tl_id *contacts, size_t count, const char *name,
                           double *out, size_t *width)
{
    tl_law_states states;
    tl_value_of of;
    tl_status status =
        tl_contact_value_find(m, "contact point", fields, F_COUNT, &states, name, &of);
    if (status == TL_OK) {
        writer w = {
            .model = m, .field = of.field, .states = &states, .state = of.state, .out = out};
        *width = of.width;
        for (size_t i = 0; i < count && out && status == TL_OK; i++)
            status = write_contact(m, &w, contacts[i]);
        free(w.place);
        free(w.gap);
    }
    tl_law_states_free(&states);
    return status;
}
