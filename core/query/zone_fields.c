/* zone_fields.c - what can be asked of zones and gridpoints: which ones, their named fields, states of their solids. */
#include "query/zone_fields.h"

#include "base/columns.h"
#include "base/error.h"
#include "base/solid_columns.h"
#include "geometry/measure.h"
#include "model/rows.h"
#include "query/block_fields.h"
#include "query/zone_at.h"
#include "zone/grid.h"
#include "zone/solids.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/fields.h>
#include <talus/zones.h>

/* ---------------------------------------------------------------- one zone --------------- */

/* Principal stresses, the largest (tension) first. */
static tl_vec3 principal_of(const tl_zone_at *at)
{
    tl_vec3 ascending;
    tl_quat axes;
    tl_principal_axes(tl_zone_stress(at), &ascending, &axes);
    return tl_v3(ascending.z, ascending.y, ascending.x);
}

static double mean_of(const tl_zone_at *at)
{
    const tl_sym3 s = tl_zone_stress(at);
    return (s.xx + s.yy + s.zz) / 3;
}

/* sqrt(3 J2), of the deviator: that of a uniaxial stress is the stress. */
static double deviator_of(const tl_zone_at *at)
{
    const tl_sym3 s = tl_zone_stress(at);
    const double a = s.xx - s.yy, b = s.yy - s.zz, c = s.zz - s.xx;
    return sqrt(0.5 * (a * a + b * b + c * c) + 3 * (s.xy * s.xy + s.yz * s.yz + s.zx * s.zx));
}

/* In the order in which a zone is told to be in one of them. */
static const struct {
    uint32_t flag;
    const char *name;
} states[] = {
    {0, "elastic"},
    {TL_ZONE_SHEAR, "shear"},
    {TL_ZONE_TENSION, "tension"},
    {TL_ZONE_JOINT, "joint"},
    {TL_ZONE_SHEAR_PAST, "shear past"},
    {TL_ZONE_TENSION_PAST, "tension past"},
    {TL_ZONE_JOINT_PAST, "joint past"},
};

enum { STATES = sizeof states / sizeof *states };

uint32_t tl_zone_state(uint32_t flags)
{
    for (uint32_t k = 1; k < STATES; k++)
        if (flags & states[k].flag)
            return k;
    return 0;
}

const char *tl_zone_state_name(uint32_t number)
{
    return number < STATES ? states[number].name : NULL;
}

/* ---------------------------------------------------------------- fields ----------------- */

/* A number of its own among all zones, or gridpoints: its body's id times 2^32, and its number. */
static double id_of(tl_id body, uint32_t number)
{
    return 4294967296.0 * body + number;
}

/* The number of a block's group. */
static double group_of(const tl_model *m, tl_id block)
{
    return m->blocks.group[tl_block_row_quiet(m, block)];
}

#define ZONE_FIELDS(FIELD)                                                                                             \
    FIELD(id, COUNT, "", "of its own among all zones: 4294967296 times the first block of its body, and its number",   \
          id_of(at->mesh->body, z->zones.number[at->row]))                                                             \
    FIELD(block, COUNT, "", "block that it is of: as a block in Lua, as its id in values", at->parcel->block)          \
    FIELD(number, COUNT, "", "its number in the block, or in the body of several joined blocks, from 0",               \
          z->zones.number[at->row])                                                                                    \
    FIELD(group, TEXT, "", "group of the block", group_of(at->m, at->parcel->block))                                   \
    FIELD(solid, TEXT, "", "name of its solid", at->parcel->solid)                                                     \
    FIELD(centroid, VEC3, "m", "present place of its centroid", tl_zone_centroid(at))                                  \
    FIELD(volume, SCALAR, "m3", "present volume", tl_tetrahedron_volume(at->x))                                        \
    FIELD(stress, SYM3, "Pa", "Cauchy stress, tension positive", tl_zone_stress(at))                                   \
    FIELD(strain, SYM3, "", "logarithmic strain since it was made", tl_zone_strain(at))                                \
    FIELD(principal, VEC3, "Pa", "principal stresses, the largest first", principal_of(at))                            \
    FIELD(mean, SCALAR, "Pa", "mean stress", mean_of(at))                                                              \
    FIELD(deviator, SCALAR, "Pa", "sqrt(3 J2): of a uniaxial stress its size", deviator_of(at))                        \
    FIELD(state, TEXT, "", "\"elastic\", \"shear\", \"tension\" or \"joint\" now, or \"shear past\" ...",              \
          tl_zone_state(z->zones.flags[at->row]))                                                                      \
    FIELD(plastic, BOOL, "", "whether it has ever yielded", z->zones.flags[at->row] != 0)

#define POINT_FIELDS(FIELD)                                                                                            \
    FIELD(id, COUNT, "",                                                                                               \
          "of its own among all gridpoints: 4294967296 times the first block of its body, and its number",             \
          id_of(mesh->body, row - mesh->point_begin))                                                                  \
    FIELD(block, COUNT, "", "block that it is of, or the first of its body: as a block in Lua, as its id in values",   \
          mesh->body)                                                                                                  \
    FIELD(number, COUNT, "", "its number in the block, or in the body of several joined blocks, from 0",               \
          row - mesh->point_begin)                                                                                     \
    FIELD(group, TEXT, "", "group of the block", group_of(m, mesh->body))                                              \
    FIELD(position, VEC3, "m", "present place", tl_v3_add(m->origin, tl_gridpoint_place(p, row)))                      \
    FIELD(displacement, VEC3, "m", "since it was made", tl_columns_get(p->u, row))                                     \
    FIELD(velocity, VEC3, "m/s", "half a step ago", tl_columns_get(p->v, row))                                         \
    FIELD(force, VEC3, "N", "unbalanced", tl_columns_get(p->force, row))                                               \
    FIELD(mass, SCALAR, "kg", "a quarter of that of each of its zones", p->mass[row])                                  \
    FIELD(fixed, COUNT, "", "components that are held: 1 x, 2 y, 4 z, added up", p->fixed[row])                        \
    FIELD(surface, BOOL, "", "whether it is on the surface of its body", p->bare[row] != 0)

#define NUMBER(prefix, name) prefix##name,
#define ZONE_NUMBER(name, kind, unit, doc, value) NUMBER(Z_, name)
#define POINT_NUMBER(name, kind, unit, doc, value) NUMBER(P_, name)
#define FIELD(name, kind, unit, doc, value) {#name, TL_FIELD_##kind, unit, doc},
#define ZONE_CASE(name, kind, unit, doc, value)                                                                        \
    case Z_##name:                                                                                                     \
        TL_FIELD_PUT(out, value);                                                                                      \
        break;
#define POINT_CASE(name, kind, unit, doc, value)                                                                       \
    case P_##name: TL_FIELD_PUT(out, value); break;

enum { ZONE_FIELDS(ZONE_NUMBER) Z_COUNT };
enum { POINT_FIELDS(POINT_NUMBER) P_COUNT };

static const tl_field zone_fields[] = {ZONE_FIELDS(FIELD)};
static const tl_field point_fields[] = {POINT_FIELDS(FIELD)};

const tl_field *tl_zone_fields(size_t *count)
{
    *count = Z_COUNT;
    return zone_fields;
}

const tl_field *tl_gridpoint_fields(size_t *count)
{
    *count = P_COUNT;
    return point_fields;
}

static void zone_numbers(const tl_zone_at *at, size_t field, double out[6])
{
    const struct tl_zones *z = at->m->zones;
    switch (field) {
        ZONE_FIELDS(ZONE_CASE)
    default: break;
    }
}

static void point_numbers(const tl_model *m, const tl_body_mesh *mesh, uint32_t row, size_t field, double out[6])
{
    const tl_gridpoints *p = &m->zones->points;
    switch (field) {
        POINT_FIELDS(POINT_CASE)
    default: break;
    }
}

/* ---------------------------------------------------------------- selections ------------- */

/* A selection on its way. */
typedef struct search {
    tl_model *m;
    const tl_zone_filter *f;
    bool points;      /* gridpoints are looked for, not zones */
    uint32_t solid;   /* of which zones are to be */
    uint8_t *wanted;  /* of each row of blocks, whether it is asked for */
    uint8_t *reached; /* of each row of gridpoints, whether a zone of such a block has it */
} search;

static bool block_passes(const tl_model *m, uint32_t row, const tl_zone_filter *f)
{
    const bool grouped = !f->group || strcmp(tl_group_name(m, m->blocks.group[row]), f->group) == 0;
    return grouped && (f->blocks || !m->blocks.hidden[row]);
}

static bool parcel_passes(const search *s, const tl_parcel *parcel)
{
    return s->wanted[tl_block_row_quiet(s->m, parcel->block)];
}

/* Marks the gridpoints of zones of the blocks that are asked for. */
static void reach_points(search *s)
{
    const struct tl_zones *z = s->m->zones;
    for (size_t k = 0; k < z->parcels.table.rows; k++) {
        const tl_parcel *parcel = &z->parcels.of[k];
        for (uint32_t p = parcel->point_begin; p < parcel->point_end && parcel_passes(s, parcel); p++)
            s->reached[z->listed[p]] = 1;
    }
}

/* Marks the blocks of which zones may pass, and their gridpoints. */
static tl_status mark_blocks(search *s)
{
    const struct tl_zones *z = s->m->zones;
    const size_t rows = s->m->blocks.table.rows;
    s->wanted = calloc(rows + 1, 1);
    s->reached = calloc(z->points.table.rows + 1, 1);
    if (!s->wanted || !s->reached)
        return tl_fail_memory(&s->m->error);
    for (uint32_t row = 0; !s->f->blocks && row < rows; row++)
        s->wanted[row] = block_passes(s->m, row, s->f);
    for (size_t k = 0; s->f->blocks && k < s->f->block_count; k++) {
        const uint32_t row = tl_block_row(s->m, s->f->blocks[k]);
        if (row == TL_NO_ROW)
            return s->m->error.status;
        s->wanted[row] = block_passes(s->m, row, s->f);
    }
    if (s->points)
        reach_points(s);
    return TL_OK;
}

/* Whether some block of a mesh is asked for. */
static bool mesh_passes(const search *s, const tl_body_mesh *mesh)
{
    const uint32_t *rows = tl_body_blocks(s->m, mesh->row);
    bool some = false;
    for (uint32_t k = 0; k < s->m->bodies.member_count[mesh->row]; k++)
        some = some || s->wanted[rows[k]];
    return some;
}

static bool in_box(const tl_bounds *box, tl_vec3 p)
{
    return p.x >= box->min.x && p.y >= box->min.y && p.z >= box->min.z && p.x <= box->max.x && p.y <= box->max.y &&
           p.z <= box->max.z;
}

/* Tolerance: by how much a point may lie outside of a zone and still be on a side of it, as a share of its volume. */
#define ON_A_SIDE 1e-12

/* Whether a point lies in a zone, or on a side of it. */
static bool zone_contains(const tl_zone_at *at, tl_vec3 p)
{
    const tl_vec3 q = tl_v3_sub(p, at->m->origin);
    const double least = -ON_A_SIDE * tl_tetrahedron_volume(at->x);
    bool inside = true;
    for (int a = 0; a < 4; a++) {
        tl_vec3 x[4];
        memcpy(x, at->x, sizeof x);
        x[a] = q;
        inside = inside && tl_tetrahedron_volume(x) >= least;
    }
    return inside;
}

static bool zone_passes(const search *s, const tl_body_mesh *mesh, uint32_t number, tl_vec3 *where)
{
    const tl_zone_at at = tl_zone_at_number(s->m, mesh, number);
    const tl_zone_filter *f = s->f;
    *where = tl_zone_centroid(&at);
    return parcel_passes(s, at.parcel) &&
           (f->plastic < 0 || (f->plastic != 0) == (s->m->zones->zones.flags[at.row] != 0)) &&
           (!f->solid || at.parcel->solid == s->solid) && (!f->inside || in_box(f->inside, *where)) &&
           (!f->containing || zone_contains(&at, *f->containing));
}

static bool point_passes(const search *s, const tl_body_mesh *mesh, uint32_t number, tl_vec3 *where)
{
    const tl_gridpoints *p = &s->m->zones->points;
    const uint32_t row = mesh->point_begin + number;
    const tl_zone_filter *f = s->f;
    *where = tl_v3_add(s->m->origin, tl_gridpoint_place(p, row));
    return s->reached[row] && p->zones[row] > 0 && (f->fixed < 0 || (f->fixed != 0) == (p->fixed[row] != 0)) &&
           (f->surface < 0 || (f->surface != 0) == (p->bare[row] != 0)) && (!f->inside || in_box(f->inside, *where));
}

/* Meshes in the order of their bodies: a list of their numbers, from malloc. */
static uint32_t *meshes_in_order(const struct tl_zones *z)
{
    uint32_t *list = malloc((z->mesh_count + 1) * sizeof *list);
    for (uint32_t k = 0; list && k < z->mesh_count; k++) {
        uint32_t at = k;
        for (; at > 0 && z->mesh[list[at - 1]].body > z->mesh[k].body; at--)
            list[at] = list[at - 1];
        list[at] = k;
    }
    return list;
}

/* Takes in what passes of a mesh: all, or what is nearer to a point than what was found. false: out of memory. */
static bool take_mesh(const search *s, const tl_body_mesh *mesh, tl_zone_name **names, size_t *count, size_t *capacity,
                      double *nearest)
{
    const uint32_t end = s->points ? mesh->point_end - mesh->point_begin : mesh->zone_end - mesh->zone_begin;
    if (!tl_grow(names, capacity, *count + end + 1, sizeof **names))
        return false;
    for (uint32_t number = 0; number < end; number++) {
        tl_vec3 where;
        if (!(s->points ? point_passes : zone_passes)(s, mesh, number, &where))
            continue;
        const double far = s->f->near ? tl_v3_norm2(tl_v3_sub(where, *s->f->near)) : 0;
        if (s->f->near && *count > 0 && !(far < *nearest))
            continue;
        *count = s->f->near ? 0 : *count;
        *nearest = far;
        (*names)[(*count)++] = (tl_zone_name){mesh->body, number};
    }
    return true;
}

static tl_status take_all(const search *s, tl_zone_name **names, size_t *count)
{
    const struct tl_zones *z = s->m->zones;
    uint32_t *order = meshes_in_order(z);
    size_t capacity = 0;
    double nearest = INFINITY;
    bool enough = order != NULL;
    for (size_t k = 0; enough && k < z->mesh_count; k++)
        if (mesh_passes(s, &z->mesh[order[k]]))
            enough = take_mesh(s, &z->mesh[order[k]], names, count, &capacity, &nearest);
    free(order);
    return enough ? TL_OK : tl_fail_memory(&s->m->error);
}

/* Finds what is asked for among the meshes that there are. */
static tl_status find_parts(search *s, tl_zone_name **names, size_t *count)
{
    const char *solid = s->f->solid;
    s->solid = solid ? tl_solid_find(s->m, solid) : TL_NO_ROW;
    if (solid && s->solid == TL_NO_ROW)
        return tl_fail(&s->m->error, TL_E_NOT_FOUND, "there is no solid '%.80s' in this model", solid);
    if (!s->m->zones)
        return TL_OK;
    tl_status status = mark_blocks(s);
    return status == TL_OK ? take_all(s, names, count) : status;
}

tl_zone_filter tl_zone_filter_default(void)
{
    return (tl_zone_filter){.size = sizeof(tl_zone_filter), .plastic = -1, .surface = -1, .fixed = -1};
}

static tl_status select_parts(tl_model *m, const tl_zone_filter *f, bool points, tl_zone_name **names, size_t *count)
{
    const tl_zone_filter all = tl_zone_filter_default();
    search s = {.m = m, .f = f ? f : &all, .points = points};
    *names = NULL;
    *count = 0;
    tl_rows_tidy(m);
    tl_status status = find_parts(&s, names, count);
    if (status == TL_OK && !*names && !(*names = malloc(sizeof **names)))
        status = tl_fail_memory(&m->error);
    free(s.wanted);
    free(s.reached);
    if (status != TL_OK) {
        free(*names);
        *names = NULL;
        *count = 0;
    }
    return status;
}

tl_status tl_zones_select(tl_model *m, const tl_zone_filter *filter, tl_zone_name **names, size_t *count)
{
    return select_parts(m, filter, false, names, count);
}

tl_status tl_gridpoints_select(tl_model *m, const tl_zone_filter *filter, tl_zone_name **names, size_t *count)
{
    return select_parts(m, filter, true, names, count);
}

/* ---------------------------------------------------------------- values ----------------- */

/* The mesh of a name, or NULL with a sentence. */
static const tl_body_mesh *mesh_of(tl_model *m, tl_zone_name name, bool point)
{
    const uint32_t mesh = tl_mesh_of(m, name.body);
    const tl_body_mesh *of = mesh != TL_NO_ROW ? &m->zones->mesh[mesh] : NULL;
    const uint32_t end = !of ? 0 : point ? of->point_end - of->point_begin : of->zone_end - of->zone_begin;
    if (name.number < end)
        return of;
    if (tl_block_row(m, name.body) == TL_NO_ROW)
        return NULL; /* the block has gone: said */
    tl_fail(&m->error, TL_E_STALE, "block %u has no %s %u: it is not deformable any more, or has %u", name.body,
            point ? "gridpoint" : "zone", name.number, end);
    return NULL;
}

tl_status tl_zone_field(tl_model *m, tl_zone_name zone, size_t index, tl_field_value *value)
{
    const tl_body_mesh *mesh = mesh_of(m, zone, false);
    if (!mesh)
        return m->error.status;
    const tl_zone_at at = tl_zone_at_number(m, mesh, zone.number);
    *value = (tl_field_value){{0}, NULL};
    zone_numbers(&at, index, value->number);
    if (index == Z_solid)
        value->text = m->zones->solid[at.parcel->solid].name;
    if (index == Z_group)
        value->text = tl_group_name(m, (size_t)value->number[0]);
    if (index == Z_state)
        value->text = tl_zone_state_name((uint32_t)value->number[0]);
    return TL_OK;
}

tl_status tl_gridpoint_field(tl_model *m, tl_zone_name gridpoint, size_t index, tl_field_value *value)
{
    const tl_body_mesh *mesh = mesh_of(m, gridpoint, true);
    if (!mesh)
        return m->error.status;
    *value = (tl_field_value){{0}, NULL};
    point_numbers(m, mesh, mesh->point_begin + gridpoint.number, index, value->number);
    if (index == P_group)
        value->text = tl_group_name(m, (size_t)value->number[0]);
    return TL_OK;
}

/* Columns of a state of a solid by its name; false: it has none. */
static bool find_state(const tl_kind *kind, const char *name, uint32_t *begin, uint32_t *width)
{
    *begin = 0;
    for (uint32_t k = 0; k < kind->state_count; k++) {
        *width = tl_state_width(tl_kind_state(kind, k)->kind);
        if (strcmp(tl_kind_state(kind, k)->name, name) == 0)
            return true;
        *begin += *width;
    }
    return false;
}

/* The width of a state that some solid has, or 0. */
static size_t state_width(const tl_model *m, const char *name)
{
    uint32_t begin, width;
    for (size_t k = 0; m->zones && k < m->zones->solid_count; k++)
        if (find_state(m->zones->solid[k].of.kind, name, &begin, &width))
            return width;
    return 0;
}

static void put_state(const tl_zone_at *at, const char *name, size_t width, double *out)
{
    const struct tl_zones *z = at->m->zones;
    uint32_t begin, own;
    const bool has = find_state(z->solid[at->parcel->solid].of.kind, name, &begin, &own) && own == width;
    for (size_t k = 0; k < width; k++)
        out[k] = has ? z->zones.state[begin + k][at->row] : NAN;
}

/* What a name asks for: all numbers of a field, or one component, as "stress.zz" and "displacement.z". */
typedef struct column {
    size_t field, first, width; /* the number of the field, or of fields: there is none */
} column;

static column column_named(const tl_field *fields, size_t count, const char *name)
{
    static const char *const parts[] = {"x", "y", "z", "xx", "yy", "zz", "xy", "yz", "zx"};
    const char *point = strchr(name, '.');
    const size_t length = point ? (size_t)(point - name) : strlen(name);
    column c = {0, 0, 0};
    while (c.field < count &&
           (strncmp(fields[c.field].name, name, length) != 0 || fields[c.field].name[length] != '\0'))
        c.field++;
    c.width = c.field < count ? tl_field_width(fields[c.field].kind) : 0;
    if (!point || (c.width != 3 && c.width != 6))
        return point ? (column){count, 0, 0} : c;
    const char *const *of = parts + (c.width == 3 ? 0 : 3);
    while (c.first < c.width && strcmp(of[c.first], point + 1) != 0)
        c.first++;
    return c.first < c.width ? (column){c.field, c.first, 1} : (column){count, 0, 0};
}

static tl_status no_column(tl_model *m, const char *what, const char *name, bool text)
{
    return text ? tl_fail(&m->error, TL_E_ARGUMENT, "the field '%.80s' of a %s is a text, not a number", name, what)
                : tl_fail(&m->error, TL_E_NOT_FOUND, "a %s has no field '%.80s'", what, name);
}

tl_status tl_zones_values(tl_model *m, const tl_zone_name *names, size_t count, const char *name, double *out,
                          size_t *width)
{
    const column c = column_named(zone_fields, Z_COUNT, name);
    const size_t state = state_width(m, name);
    const bool text = c.field < Z_COUNT && c.width == 0;
    if (text || (c.field == Z_COUNT && state == 0))
        return no_column(m, "zone", name, text);
    *width = c.field < Z_COUNT ? c.width : state;
    for (size_t k = 0; out && k < count; k++) {
        const tl_body_mesh *mesh = mesh_of(m, names[k], false);
        double all[6] = {0};
        if (!mesh)
            return m->error.status;
        const tl_zone_at at = tl_zone_at_number(m, mesh, names[k].number);
        if (c.field < Z_COUNT)
            zone_numbers(&at, c.field, all);
        else
            put_state(&at, name, state, all);
        memcpy(out + k * *width, all + c.first, *width * sizeof *out);
    }
    return TL_OK;
}

tl_status tl_gridpoints_values(tl_model *m, const tl_zone_name *names, size_t count, const char *name, double *out,
                               size_t *width)
{
    const column c = column_named(point_fields, P_COUNT, name);
    const bool text = c.field < P_COUNT && c.width == 0;
    if (text || c.field == P_COUNT)
        return no_column(m, "gridpoint", name, text);
    *width = c.width;
    for (size_t k = 0; out && k < count; k++) {
        const tl_body_mesh *mesh = mesh_of(m, names[k], true);
        double all[6] = {0};
        if (!mesh)
            return m->error.status;
        point_numbers(m, mesh, mesh->point_begin + names[k].number, c.field, all);
        memcpy(out + k * *width, all + c.first, *width * sizeof *out);
    }
    return TL_OK;
}

tl_status tl_zones_corners(tl_model *m, const tl_zone_name *names, size_t count, uint32_t (*corners)[4])
{
    for (size_t k = 0; k < count; k++) {
        const tl_body_mesh *mesh = mesh_of(m, names[k], false);
        if (!mesh)
            return m->error.status;
        const tl_zone_at at = tl_zone_at_number(m, mesh, names[k].number);
        for (int a = 0; a < 4; a++) {
            const uint16_t local = m->zones->zones.corner[a][at.row];
            corners[k][a] = m->zones->listed[at.parcel->point_begin + local] - mesh->point_begin;
        }
    }
    return TL_OK;
}
