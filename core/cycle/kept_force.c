/* kept_force.c - field contacts that come under another law keep their normal force.
 *
 * What an edge or a corner presses with follows from how far it overlaps; what can be chosen is how far the two faces are moved out
 * (detect/fields.c). So they are moved, outward or inward, until the new law gives the force of the last step. The force grows with
 * the way, from nothing where the faces part. */
#include "cycle/kept_force.h"

#include "base/columns.h"
#include "contact/across_gap.h"
#include "contact/points.h"
#include "contact/presses.h"
#include "detect/fields.h"
#include "force/field_press.h"

/* Force that is missed, of the force. */
#define CLOSE 1e-13
#define MOST_TRIES 100

/* A contact under its new law. */
typedef struct trial {
    tl_model *m;
    uint32_t contact;
    const tl_law *law;
    double state[TL_STATE_COLUMNS], wanted;
    bool failed;
} trial;

/* How much larger than wanted the force is with a shift. */
static double excess(trial *t, double shift)
{
    tl_press_row *row = tl_press_row_of(t->m, t->contact);
    row->shift = shift;
    t->failed = t->failed || !tl_field_press_anew(t->m, t->contact, &t->m->detect->narrow[0]);
    return t->failed ? 0 : tl_press_force(t->law, row, t->state) - t->wanted;
}

/* Moves the faces until the force is that wanted: between two shifts with less and with more, by the rule of false position after
 * Illinois. */
static void find_shift(trial *t)
{
    const tl_press_row *row = tl_press_row_of(t->m, t->contact);
    double a = row->shift, at_a = excess(t, a), way = row->press.overlap, b = a, at_b = at_a;
    for (int k = 0; k < MOST_TRIES && !t->failed && (at_a < 0) == (at_b < 0); k++, way *= 2) {
        a = b;
        at_a = at_b;
        b += at_a < 0 ? way : -way;
        at_b = excess(t, b);
    }
    for (int k = 0; k < MOST_TRIES && !t->failed && fabs(at_b) > CLOSE * t->wanted; k++) {
        double c = (a * at_b - b * at_a) / (at_b - at_a), at_c = excess(t, c);
        if ((at_c < 0) == (at_b < 0)) {
            at_a *= 0.5;
        } else {
            a = b;
            at_a = at_b;
        }
        b = c;
        at_b = at_c;
    }
}

/* What the new law keeps of the first point of a contact that may have been under another one. */
static void read_state(trial *t)
{
    const tl_model *m = t->m;
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    const tl_kind *kind = t->law->kind;
    bool kept = m->joint_laws[contacts->law[t->contact]].kind == kind && t->law->columns > 0;
    size_t i = tl_point_row(contacts, t->contact, TL_FIELD_SHEAR);
    uint32_t column = 0;
    for (uint32_t k = 0; k < p->state_columns && kept; k++)
        t->state[k] = p->state[k][i];
    for (uint32_t k = 0; k < kind->state_count && !kept; k++) {
        const tl_state *state = tl_kind_state(kind, k);
        bool tangent = state->kind == TL_STATE_TANGENT;
        t->state[column] = tangent ? 0 : state->initial;
        column += tangent ? 3 : 1;
    }
}

/* What slip has opened, as the new law has it, is in the shift already. */
static void note_openings(trial *t)
{
    const tl_contacts *contacts = &t->m->detect->contacts;
    tl_press_row *row = tl_press_row_of(t->m, t->contact);
    double opening[TL_LANES] = {0};
    if (tl_law_opens(t->law) && t->m->joint_laws[contacts->law[t->contact]].kind == t->law->kind)
        tl_law_point_openings(t->m, t->law, t->contact, 0, opening);
    for (size_t k = 0; k < TL_FIELD_POINTS; k++)
        row->opening[k] = opening[k];
    row->opened = row->paid = 0;
}

bool tl_may_keep_field_force(tl_model *m, uint32_t c)
{
    tl_contacts *contacts = &m->detect->contacts;
    tl_press_row *row = tl_press_row_of(m, c);
    const tl_press_row kept = *row;
    const double faces = contacts->faces_valid_to[c], points = contacts->points_valid_to[c];
    bool enough = tl_field_press_anew(m, c, &m->detect->narrow[0]);
    *row = kept;
    contacts->faces_valid_to[c] = faces;
    contacts->points_valid_to[c] = points;
    return enough;
}

/* Shear and torsion stay what they are, on the area that presses now. */
static void keep_shear(trial *t, double radius)
{
    const tl_contacts *contacts = &t->m->detect->contacts;
    const tl_points_table *p = &t->m->detect->points;
    const size_t torsion = tl_point_row(contacts, t->contact, TL_FIELD_TORSION);
    const tl_press *press = &tl_press_row_of(t->m, t->contact)->press;
    if (!(press->area > 0 && press->radius > 0))
        return;
    p->area[tl_point_row(contacts, t->contact, TL_FIELD_SHEAR)] = p->area[torsion] = press->area;
    tl_columns_put(p->f_s, torsion,
                   tl_v3_scale(radius / press->radius, tl_columns_get(p->f_s, torsion)));
}

bool tl_keep_field_force(tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const size_t first = tl_point_row(contacts, c, TL_FIELD_SHEAR);
    const tl_points_table *p = &m->detect->points;
    const double radius = tl_press_row_of(m, c)->press.radius;
    const tl_vec3 shear = {p->f_s[0][first], p->f_s[1][first], p->f_s[2][first]};
    trial t = {.m = m, .contact = c, .law = tl_law_of(m, contacts->tag[c])};
    t.wanted = tl_v3_norm(tl_v3_sub(contacts->force[c], shear));
    read_state(&t);
    note_openings(&t);
    if (t.wanted > 0 && tl_press_row_of(m, c)->press.overlap > 0)
        find_shift(&t);
    if (!t.failed)
        keep_shear(&t, radius);
    return !t.failed;
}
