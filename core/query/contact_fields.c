/* contact_fields.c - what can be asked of contacts: which ones, their named fields, a block's
 * neighbours. Values are those of the last step's forces. */
#include "query/contact_fields.h"

#include "contact/body_contacts.h"
#include "contact/index.h"
#include "contact/places.h"
#include "contact/sides.h"
#include "contact/store.h"
#include "detect/detect.h"
#include "model/joints.h"
#include "model/options.h"
#include "model/rows.h"
#include "query/meeting.h"
#include "segment/meets.h"
#include "zone/grid.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/fields.h>

/* The fields: name, kind, unit, what tl_contact_facts has them by (of several numbers the first), and what they are. */
#define CONTACT_FIELDS(FIELD)                                                                                          \
    FIELD(id, COUNT, "", number, "number of the pair of its blocks: that of the older times 2^32, plus the other's")   \
    FIELD(born, COUNT, "", born, "steps made when it began: by this and its blocks a contact is known")                \
    FIELD(blocks, IDS, "", a, "its two blocks, the older first")                                                       \
    FIELD(joint, TEXT, "", tag.joint, "joint and plane (\"J1:3\"), or empty")                                          \
    FIELD(area, SCALAR, "m2", area, "of the common polygon of two faces, or of the surface of pressure")               \
    FIELD(normal, VEC3, "", normal, "unit normal from the first block to the second")                                  \
    FIELD(point, VEC3, "m", point, "centroid of the polygon, or centre of pressure")                                   \
    FIELD(gap, SCALAR, "m", gap, "smallest gap, negative when overlapping")                                            \
    FIELD(normal_force, SCALAR, "N", normal_force, "compression positive")                                             \
    FIELD(shear_force, VEC3, "N", shear_force, "on the second block")                                                  \
    FIELD(normal_stress, SCALAR, "Pa", normal_stress, "normal force over area")                                        \
    FIELD(shear_stress, SCALAR, "Pa", shear_stress, "length of shear force over area")                                 \
    FIELD(shear_displacement, VEC3, "m", shear_displacement,                                                           \
          "of the second block against the first at the point, along the contact: difference of "                      \
          "their displacements")                                                                                       \
    FIELD(state, TEXT, "", state, "\"elastic\", \"slipping\", \"open\" or \"failed\"")                                 \
    FIELD(law, TEXT, "", law, "name of its law, or empty")                                                             \
    FIELD(law_number, COUNT, "", law, "place of its law in model:laws(), or 0")

/* What else files show. */
#define CONTACT_ARRAYS(FIELD)                                                                                          \
    FIELD(plane, COUNT, "", tag.plane, "")                                                                             \
    FIELD(contact_id, COUNT, "", number, "")                                                                           \
    FIELD(block_id, COUNT, "", a, "")                                                                                  \
    FIELD(block_a, COUNT, "", a, "")                                                                                   \
    FIELD(block_b, COUNT, "", b, "")                                                                                   \
    FIELD(slip, SCALAR, "m", slip, "")

#define NUMBER(name, kind, unit, from, doc) F_##name,
#define FIELD(name, kind, unit, from, doc) {#name, TL_FIELD_##kind, unit, doc},
#define OFFSET(name, kind, unit, from, doc) offsetof(tl_contact_facts, from),

enum { CONTACT_FIELDS(NUMBER) F_COUNT };

static const tl_field fields[] = {CONTACT_FIELDS(FIELD) CONTACT_ARRAYS(FIELD)};
static const size_t offsets[] = {CONTACT_FIELDS(OFFSET) CONTACT_ARRAYS(OFFSET)};

const tl_field *tl_contact_fields(size_t *count)
{
    *count = F_COUNT;
    return fields;
}

const tl_field *tl_contact_quantity(const char *name)
{
    const tl_field *of = fields;
    while (strcmp(of->name, name) != 0)
        of++;
    return of;
}

const int64_t *tl_contact_long(const tl_contact_facts *facts, const tl_field *of)
{
    switch (offsets[of - fields]) {
    case offsetof(tl_contact_facts, number): return &facts->number;
    case offsetof(tl_contact_facts, born): return &facts->born;
    default: return NULL;
    }
}

size_t tl_contact_numbers(const tl_contact_facts *facts, const tl_field *of, double out[3])
{
    const char *from = (const char *)facts + offsets[of - fields];
    const int64_t *number;
    uint32_t whole[2];
    switch (of->kind) { /* copies of fixed length are not called */
    case TL_FIELD_SCALAR: memcpy(out, from, sizeof *out); return 1;
    case TL_FIELD_VEC3: memcpy(out, from, 3 * sizeof *out); return 3;
    case TL_FIELD_IDS:
        memcpy(whole, from, sizeof whole);
        out[0] = whole[0];
        out[1] = whole[1];
        return 2;
    default:
        memcpy(whole, from, sizeof *whole);
        number = tl_contact_long(facts, of);
        out[0] = number ? (double)*number : whole[0];
        return 1;
    }
}

size_t tl_point_count(const tl_model *m, uint32_t contact)
{
    return tl_row_is_meeting(m, contact) ? 0 : tl_contact_areas(m->detect, contact);
}

static void forces(const tl_model *m, uint32_t c, double *normal, tl_vec3 *shear)
{
    const tl_detect *d = m->detect;
    const tl_points_table *p = &d->points;
    size_t count = tl_point_count(m, c);
    *normal = 0;
    *shear = tl_v3(0, 0, 0);
    for (size_t k = 0; k < count; k++) {
        size_t i = tl_point_row(&d->contacts, c, k);
        *normal += p->f_n[i];
        *shear = tl_v3_add(*shear, tl_v3(p->f_s[0][i], p->f_s[1][i], p->f_s[2][i]));
    }
    /* what a field presses with is not the law's force at its mean overlap, where that is no line */
    if (tl_facet_is_field(&d->contacts.facet[c]) && *normal > 0)
        *normal = tl_v3_norm(tl_v3_sub(d->contacts.force[c], *shear));
}

/* Open when every point is, slipping when some point slips, failed when some bond is lost. */
tl_contact_state tl_contact_state_of_flags(uint32_t any, uint32_t all)
{
    if (all & TL_POINT_OPEN)
        return TL_CONTACT_OPEN;
    if (any & TL_POINT_SLIPPING)
        return TL_CONTACT_SLIPPING;
    return any & TL_POINT_FAILED ? TL_CONTACT_FAILED : TL_CONTACT_ELASTIC;
}

static tl_contact_state state_of(const tl_detect *d, uint32_t c)
{
    uint32_t any = 0, all = TL_POINT_OPEN;
    for (uint32_t k = 0; k < d->contacts.point_count[c]; k++) {
        uint32_t flags = d->points.flags[tl_point_row(&d->contacts, c, k)];
        any |= flags;
        all &= flags;
    }
    return tl_contact_state_of_flags(any, all);
}

const char *tl_state_name(size_t number)
{
    static const char *const names[] = {[TL_CONTACT_ELASTIC] = "elastic",
                                        [TL_CONTACT_SLIPPING] = "slipping",
                                        [TL_CONTACT_OPEN] = "open",
                                        [TL_CONTACT_FAILED] = "failed"};
    return number < sizeof names / sizeof names[0] ? names[number] : NULL;
}
tl_contact_counts tl_model_contact_counts(const tl_model *m)
{
    tl_contact_counts counts = {0, 0, 0};
    const tl_detect *d = tl_detect_lasting(m);
    const size_t rows = d ? d->contacts.table.rows : 0;
    for (uint32_t row = 0; row < rows; row++) {
        if (d->contacts.point_count[row] == 0)
            continue;
        tl_contact_state state = state_of(d, row);
        counts.contacts++;
        counts.slipping += state == TL_CONTACT_SLIPPING;
        counts.open += state == TL_CONTACT_OPEN;
    }
    for (uint32_t row = TL_NO_ROW; d && (row = tl_meeting_next(m, row)) != TL_NO_ROW;) {
        const tl_meeting by = tl_meeting_of(m, row);
        const tl_contact_state state = tl_contact_state_of_flags(by.any, by.all);
        counts.contacts++;
        counts.slipping += state == TL_CONTACT_SLIPPING;
        counts.open += state == TL_CONTACT_OPEN;
    }
    return counts;
}

tl_vec3 tl_contact_passed(const tl_model *m, uint32_t contact, tl_vec3 x)
{
    const tl_contacts *c = &m->detect->contacts;
    const tl_sides s = tl_contact_sides(m, contact);
    tl_vec3 moved_a = tl_block_point_displacement(m, c->a[contact], tl_side_local(m, s.a, x));
    return tl_v3_sub(tl_block_point_displacement(m, c->b[contact], tl_side_local(m, s.b, x)), moved_a);
}

int64_t tl_contact_number(tl_contact_name name)
{
    return (int64_t)((uint64_t)name.a << 32 | name.b);
}

static tl_contact_name name_of(const tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    if (tl_row_is_meeting(m, contact)) {
        const tl_meeting by = tl_meeting_named(m, contact);
        return (tl_contact_name){by.a, by.b, by.born};
    }
    return (tl_contact_name){m->blocks.id[c->a[contact]], m->blocks.id[c->b[contact]], c->born[contact]};
}

/* Of blocks that meet by segments. */
static tl_contact_facts facts_of_meeting(const tl_model *m, uint32_t row)
{
    const tl_meeting by = tl_meeting_of(m, row);
    const tl_contact_name name = {by.a, by.b, by.born};
    tl_contact_facts out = {.number = tl_contact_number(name),
                            .born = by.born,
                            .a = by.a,
                            .b = by.b,
                            .tag = by.tag,
                            .law = by.law + 1,
                            .state = tl_contact_state_of_flags(by.any, by.all),
                            .area = by.area,
                            .gap = by.gap,
                            .normal_force = by.pressing,
                            .normal_stress = by.pressing / by.area,
                            .normal = by.normal,
                            .point = tl_v3_add(m->origin, by.point),
                            .shear_force = by.shear,
                            .shear_stress = tl_v3_norm(by.shear) / by.area,
                            .opening = tl_v3_dot(by.passed, by.normal)};
    out.shear_displacement = tl_v3_madd(by.passed, -out.opening, by.normal);
    return out;
}

tl_contact_facts tl_contact_facts_of(const tl_model *m, uint32_t contact)
{
    if (tl_row_is_meeting(m, contact))
        return facts_of_meeting(m, contact);
    const tl_contacts *c = &m->detect->contacts;
    const tl_contact_name name = name_of(m, contact);
    tl_contact_facts out = {.number = tl_contact_number(name),
                            .born = name.born,
                            .a = name.a,
                            .b = name.b,
                            .tag = c->tag[contact],
                            .law = c->law[contact] + 1,
                            .area = c->area[contact],
                            .state = state_of(m->detect, contact)};
    tl_vec3 point;
    forces(m, contact, &out.normal_force, &out.shear_force);
    tl_contact_summary(m, contact, &out.normal, &point, &out.gap);
    out.point = tl_v3_add(m->origin, point);
    tl_vec3 passed = tl_contact_passed(m, contact, point);
    out.opening = tl_v3_dot(passed, out.normal);
    out.shear_displacement = tl_v3_madd(passed, -out.opening, out.normal);
    out.normal_stress = out.area > 0 ? out.normal_force / out.area : 0;
    out.shear_stress = out.area > 0 ? tl_v3_norm(out.shear_force) / out.area : 0;
    return out;
}

/* Brings contacts up to date, and segments where no step has found them yet. */
static tl_status refresh(tl_model *m)
{
    const tl_status status = tl_detect_refresh(m);
    return status == TL_OK ? tl_segments_ask(m) : status;
}

/* A contact without points is kept for those that it may get again, but to whoever asks it has ended. So it is where
 * segments bear all. */
static bool is_listed(const tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    return c->point_count[contact] > 0 && !tl_blocks_meet(m, c->a[contact], c->b[contact]);
}

/* Fails with the sentence that says why a contact is no more. */
static tl_status fail_ended(tl_model *m, tl_contact_name contact)
{
    const uint32_t a = tl_block_row_quiet(m, contact.a), b = tl_block_row_quiet(m, contact.b);
    char why[80] = "its blocks have parted";
    if (a == TL_NO_ROW && b == TL_NO_ROW)
        snprintf(why, sizeof why, "its blocks were cut or deleted");
    else if (a == TL_NO_ROW || b == TL_NO_ROW)
        snprintf(why, sizeof why, "block %u was cut or deleted", a == TL_NO_ROW ? contact.a : contact.b);
    else if (m->blocks.body[a] == m->blocks.body[b])
        snprintf(why, sizeof why, "its blocks were joined into one body");
    return tl_fail(&m->error, TL_E_STALE, "contact of blocks %u and %u no longer exists: %s", contact.a, contact.b,
                   why);
}

tl_status tl_contact_find(tl_model *m, tl_contact_name contact, uint32_t *row)
{
    tl_status status = refresh(m);
    if (status != TL_OK)
        return status;
    *row = tl_meeting_row(m, contact.a, contact.b);
    if (*row == TL_NO_ROW)
        *row = tl_contact_row(m, contact.a, contact.b);
    if (*row == TL_NO_ROW || !(tl_row_is_meeting(m, *row) || is_listed(m, *row)))
        return fail_ended(m, contact);
    const int64_t born = name_of(m, *row).born;
    if (born != contact.born)
        return tl_fail(&m->error, TL_E_STALE,
                       "contact of blocks %u and %u no longer exists: its blocks have parted, or were one body, and "
                       "have met again after cycle %lld",
                       contact.a, contact.b, (long long)born);
    return TL_OK;
}

tl_status tl_contact_field(tl_model *m, tl_contact_name contact, size_t index, tl_field_value *value)
{
    assert(index < F_COUNT);
    uint32_t row;
    tl_status status = tl_contact_find(m, contact, &row);
    if (status != TL_OK)
        return status;
    const tl_contact_facts facts = tl_contact_facts_of(m, row);
    *value = (tl_field_value){{0}, NULL};
    if (fields[index].kind != TL_FIELD_TEXT)
        tl_contact_numbers(&facts, &fields[index], value->number);
    else if (index == F_joint)
        value->text = tl_tag_name(m, facts.tag);
    else if (index == F_state)
        value->text = tl_state_name(facts.state);
    else
        value->text = facts.law == 0 ? "" : m->joint_laws[facts.law - 1].kind->name;
    return TL_OK;
}

/* ---------------------------------------------------------------- lists ------------------ */

tl_status tl_contacts_listed(tl_model *m, uint32_t **rows, size_t *count, size_t *meetings)
{
    *rows = NULL;
    *count = *meetings = 0;
    tl_status status = refresh(m);
    if (status != TL_OK)
        return status;
    const tl_contacts *c = &m->detect->contacts;
    const size_t meets = m->segments ? m->segments->meet_count : 0;
    uint32_t *list = malloc((c->table.rows + meets + 1) * sizeof *list);
    if (!list)
        return tl_fail_memory(&m->error);
    for (uint32_t block = 0; block < m->blocks.table.rows; block++)
        for (tl_body_contacts at = tl_contacts_of_block(m, block); tl_next_contact(&at);)
            if (c->a[at.contact] == block && is_listed(m, at.contact))
                list[(*count)++] = at.contact;
    for (uint32_t row = TL_NO_ROW; (row = tl_meeting_next(m, row)) != TL_NO_ROW; ++*meetings)
        list[(*count)++] = row;
    *rows = list;
    return TL_OK;
}

/* Marks [block rows] which are in a list; NULL for no list. */
static unsigned char *mark(tl_model *m, const tl_id *ids, size_t count, tl_status *status)
{
    unsigned char *marks = calloc(m->blocks.table.rows + 1, 1);
    if (!marks) {
        *status = tl_fail_memory(&m->error);
        return NULL;
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t row = tl_block_row(m, ids[i]);
        if (row == TL_NO_ROW) {
            *status = m->error.status;
            break;
        }
        marks[row] = 1;
    }
    return marks;
}

static tl_tag tag_of(const tl_model *m, uint32_t contact)
{
    return tl_row_is_meeting(m, contact) ? tl_meeting_named(m, contact).tag : m->detect->contacts.tag[contact];
}

static bool is_between(const unsigned char *ma, const unsigned char *mb, uint32_t a, uint32_t b)
{
    return !ma || !mb || (ma[a] && mb[b]) || (ma[b] && mb[a]);
}

static int compare_names(const void *x, const void *y)
{
    const tl_contact_name *a = x, *b = y;
    return a->a != b->a ? (a->a > b->a) - (a->a < b->a) : (a->b > b->b) - (a->b < b->b);
}

tl_status tl_contacts_select(tl_model *m, const tl_contact_filter *given, tl_contact_name **names, size_t *count)
{
    *names = NULL;
    *count = 0;
    tl_tag joint = {0, 0};
    tl_contact_filter filter;
    uint32_t *rows = NULL;
    size_t all = 0, meetings = 0;
    tl_contact_name *list = NULL;
    tl_status status = TL_OPTIONS_READ(tl_contact_filter, given, &filter, &m->error);
    if (status == TL_OK)
        status = tl_contacts_listed(m, &rows, &all, &meetings);
    if (status == TL_OK && filter.joint)
        status = tl_joint_parse(m, filter.joint, &joint);
    unsigned char *ma = NULL, *mb = NULL;
    if (status == TL_OK && filter.between_a)
        ma = mark(m, filter.between_a, filter.count_a, &status);
    if (status == TL_OK && filter.between_b)
        mb = mark(m, filter.between_b, filter.count_b, &status);
    if (status == TL_OK && !(list = malloc((all + 1) * sizeof *list)))
        status = tl_fail_memory(&m->error);
    for (size_t i = 0; status == TL_OK && i < all; i++) {
        const tl_contact_name name = name_of(m, rows[i]);
        if (tl_tag_matches(joint, tag_of(m, rows[i])) &&
            is_between(ma, mb, tl_block_row_quiet(m, name.a), tl_block_row_quiet(m, name.b)))
            list[(*count)++] = name;
    }
    if (meetings > 0 && meetings < all) /* these come behind the others */
        qsort(list, *count, sizeof *list, compare_names);
    free(rows);
    free(ma);
    free(mb);
    *names = list;
    return status;
}

tl_status tl_block_neighbours(tl_model *m, tl_id block, tl_id **ids, size_t *count)
{
    *ids = NULL;
    *count = 0;
    tl_rows_tidy(m);
    uint32_t row = tl_block_row(m, block);
    if (row == TL_NO_ROW)
        return m->error.status;
    tl_status status = refresh(m);
    if (status != TL_OK)
        return status;
    const tl_contacts *c = &m->detect->contacts;
    tl_body_contacts at = tl_contacts_of_block(m, row);
    const size_t meets = m->segments ? m->segments->meet_count : 0;
    tl_id *list = malloc(((size_t)(at.end - at.next) + meets + 1) * sizeof *list);
    if (!list)
        return tl_fail_memory(&m->error);
    while (tl_next_contact(&at))
        if (is_listed(m, at.contact))
            list[(*count)++] = m->blocks.id[tl_contact_partner(c, at.contact, row)];
    for (uint32_t meeting = TL_NO_ROW; (meeting = tl_meeting_next(m, meeting)) != TL_NO_ROW;) {
        const tl_meeting by = tl_meeting_named(m, meeting);
        if (by.a == block || by.b == block)
            list[(*count)++] = by.a == block ? by.b : by.a;
    }
    *ids = list;
    return TL_OK;
}
