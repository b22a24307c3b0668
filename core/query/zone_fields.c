/* zone_fields.c - what can be asked of zones and gridpoints: which ones, their named fields, states of their solids. */
#include "query/zone_fields.h"

#include "base/columns.h"
#include "base/error.h"
#include "base/solid_columns.h"
#include "geometry/measure.h"
#include "model/fields.h"
#include "zone/grid.h"
#include "zone/solids.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elementary.h>
#include <talus/fields.h>

/* ---------------------------------------------------------------- one zone --------------- */

/* A zone where it is: its mesh, row and parcel, and the places of its corners now and as made. */
typedef struct place {
    const tl_model *m;
    const tl_body_mesh *mesh;
    const tl_parcel *parcel;
    uint32_t row;
    tl_vec3 x[4], ref[4];
} place;

/* The parcel that has a row: they ascend. */
static const tl_parcel *parcel_of(const struct tl_zones *z, const tl_body_mesh *mesh, uint32_t row)
{
    uint32_t low = mesh->parcel_begin, high = mesh->parcel_end;
    while (high - low > 1) {
        const uint32_t middle = (low + high) / 2;
        if (z->group[z->parcels.of[middle].group_begin].start <= row)
            low = middle;
        else
            high = middle;
    }
    return &z->parcels.of[low];
}

static place place_of(const tl_model *m, const tl_body_mesh *mesh, uint32_t number)
{
    const struct tl_zones *z = m->zones;
    place at = {.m = m, .mesh = mesh, .row = z->row_of[mesh->zone_begin + number]};
    at.parcel = parcel_of(z, mesh, at.row);
    for (int a = 0; a < 4; a++) {
        const uint32_t point = z->listed[at.parcel->point_begin + z->zones.corner[a][at.row]];
        at.x[a] = tl_gridpoint_place(&z->points, point);
        at.ref[a] = tl_columns_get(z->points.ref, point);
    }
    return at;
}

static double volume_of(const tl_vec3 x[4])
{
    return tl_v3_dot(tl_v3_sub(x[1], x[0]), tl_v3_cross(tl_v3_sub(x[2], x[0]), tl_v3_sub(x[3], x[0]))) / 6;
}

static tl_vec3 centroid_of(const place *at)
{
    const tl_vec3 sum = tl_v3_add(tl_v3_add(at->x[0], at->x[1]), tl_v3_add(at->x[2], at->x[3]));
    return tl_v3_madd(at->m->origin, 0.25, sum);
}

static tl_sym3 stress_of(const place *at)
{
    double *const *s = at->m->zones->zones.stress;
    const uint32_t row = at->row;
    return (tl_sym3){s[0][row], s[1][row], s[2][row], s[3][row], s[4][row], s[5][row]};
}

/* How the zone has stretched and turned since it was made: edges now by those then. */
static tl_mat3 gradient_of(const place *at)
{
    tl_mat3 f = {{{0}}};
    const double six = 6 * volume_of(at->ref);
    tl_vec3 e[3], r[3];
    for (int a = 0; a < 3; a++) {
        e[a] = tl_v3_sub(at->x[a + 1], at->x[0]);
        r[a] = tl_v3_sub(at->ref[a + 1], at->ref[0]);
    }
    for (int a = 0; a < 3; a++) {
        const tl_vec3 g = tl_v3_scale(1 / six, tl_v3_cross(r[(a + 1) % 3], r[(a + 2) % 3]));
        const double x[3] = {e[a].x, e[a].y, e[a].z}, y[3] = {g.x, g.y, g.z};
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                f.m[i][j] += x[i] * y[j];
    }
    return f;
}

/* A tensor of principal values about axes. */
static tl_sym3 about(tl_quat axes, const double value[3])
{
    const tl_mat3 q = tl_q_matrix(axes);
    double t[3][3] = {{0}};
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                t[i][j] += value[k] * q.m[i][k] * q.m[j][k];
    return (tl_sym3){t[0][0], t[1][1], t[2][2], t[0][1], t[1][2], t[2][0]};
}

/* Logarithmic strain, ln V of F = V R, in the axes of the model. */
static tl_sym3 strain_of(const place *at)
{
    const tl_mat3 f = gradient_of(at);
    double b[3][3] = {{0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                b[i][j] += f.m[i][k] * f.m[j][k];
    tl_vec3 squares;
    tl_quat axes;
    tl_principal_axes((tl_sym3){b[0][0], b[1][1], b[2][2], b[0][1], b[1][2], b[2][0]}, &squares, &axes);
    const double ln[3] = {0.5 * tl_log1p(squares.x - 1), 0.5 * tl_log1p(squares.y - 1), 0.5 * tl_log1p(squares.z - 1)};
    return about(axes, ln);
}

/* Principal stresses, the largest (tension) first. */
static tl_vec3 principal_of(const place *at)
{
    tl_vec3 ascending;
    tl_quat axes;
    tl_principal_axes(stress_of(at), &ascending, &axes);
    return tl_v3(ascending.z, ascending.y, ascending.x);
}

static double mean_of(const place *at)
{
    const tl_sym3 s = stress_of(at);
    return (s.xx + s.yy + s.zz) / 3;
}

/* sqrt(3 J2), of the deviator: that of a uniaxial stress is the stress. */
static double deviator_of(const place *at)
{
    const tl_sym3 s = stress_of(at);
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

#define ZONE_FIELDS(FIELD)                                                                                             \
    FIELD(block, COUNT, "", "block that it is of: the lowest of a body of several", at->mesh->body)                    \
    FIELD(number, COUNT, "", "its number in the block, from 0", z->zones.number[at->row])                              \
    FIELD(solid, TEXT, "", "name of its solid", at->parcel->solid)                                                     \
    FIELD(centroid, VEC3, "m", "present place of its centroid", centroid_of(at))                                       \
    FIELD(volume, SCALAR, "m3", "present volume", volume_of(at->x))                                                    \
    FIELD(stress, SYM3, "Pa", "Cauchy stress, tension positive", stress_of(at))                                        \
    FIELD(strain, SYM3, "", "logarithmic strain since it was made", strain_of(at))                                     \
    FIELD(principal, VEC3, "Pa", "principal stresses, the largest first", principal_of(at))                            \
    FIELD(mean, SCALAR, "Pa", "mean stress", mean_of(at))                                                              \
    FIELD(deviator, SCALAR, "Pa", "sqrt(3 J2): of a uniaxial stress its size", deviator_of(at))                        \
    FIELD(state, TEXT, "", "\"elastic\", \"shear\", \"tension\" or \"joint\" now, or \"shear past\" ...",              \
          tl_zone_state(z->zones.flags[at->row]))                                                                      \
    FIELD(plastic, BOOL, "", "whether it has ever yielded", z->zones.flags[at->row] != 0)

#define POINT_FIELDS(FIELD)                                                                                            \
    FIELD(block, COUNT, "", "block that it is of: the lowest of a body of several", mesh->body)                        \
    FIELD(number, COUNT, "", "its number in the block, from 0", row - mesh->point_begin)                               \
    FIELD(position, VEC3, "m", "present place", tl_v3_add(m->origin, tl_gridpoint_place(p, row)))                      \
    FIELD(displacement, VEC3, "m", "since it was made", tl_columns_get(p->u, row))                                     \
    FIELD(velocity, VEC3, "m/s", "half a step ago", tl_columns_get(p->v, row))                                         \
    FIELD(force, VEC3, "N", "unbalanced", tl_columns_get(p->force, row))                                               \
    FIELD(mass, SCALAR, "kg", "a quarter of that of each of its zones", p->mass[row])                                  \
    FIELD(fixed, COUNT, "", "components that are held: 1 x, 2 y, 4 z, added up", p->fixed[row])

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

static void zone_numbers(const place *at, size_t field, double out[6])
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

/* Whether a mesh has one of the blocks. */
static bool has_block(const tl_model *m, const tl_body_mesh *mesh, const tl_zone_filter *f)
{
    bool some = f->blocks == NULL;
    for (size_t k = 0; k < f->block_count && !some; k++) {
        const uint32_t row = tl_block_row_quiet(m, f->blocks[k]);
        some = row != TL_NO_ROW && m->blocks.body[row] == mesh->row;
    }
    return some;
}

static bool passes(const tl_model *m, const tl_body_mesh *mesh, uint32_t number, const tl_zone_filter *f,
                   uint32_t solid)
{
    const struct tl_zones *z = m->zones;
    const uint32_t row = z->row_of[mesh->zone_begin + number];
    return (f->plastic < 0 || (f->plastic != 0) == (z->zones.flags[row] != 0)) &&
           (!f->solid || parcel_of(z, mesh, row)->solid == solid);
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

static tl_status select_parts(tl_model *m, const tl_zone_filter *f, bool points, tl_zone_name **names, size_t *count)
{
    const struct tl_zones *z = m->zones;
    size_t capacity = 0;
    *names = NULL;
    *count = 0;
    const uint32_t solid = f->solid ? tl_solid_find(m, f->solid) : TL_NO_ROW;
    if (f->solid && solid == TL_NO_ROW)
        return tl_fail(&m->error, TL_E_NOT_FOUND, "there is no solid '%.80s' in this model", f->solid);
    uint32_t *order = z ? meshes_in_order(z) : NULL;
    bool enough = !z || order;
    for (size_t k = 0; enough && z && k < z->mesh_count; k++) {
        const tl_body_mesh *mesh = &z->mesh[order[k]];
        const uint32_t end = points ? mesh->point_end - mesh->point_begin : mesh->zone_end - mesh->zone_begin;
        if (!has_block(m, mesh, f))
            continue;
        enough = tl_grow(names, &capacity, *count + end + 1, sizeof **names);
        for (uint32_t number = 0; enough && number < end; number++)
            if (points || passes(m, mesh, number, f, solid))
                (*names)[(*count)++] = (tl_zone_name){mesh->body, number};
    }
    free(order);
    if (enough && !*names)
        enough = tl_grow(names, &capacity, 1, sizeof **names);
    return enough ? TL_OK : tl_fail_memory(&m->error);
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
    tl_fail(&m->error, TL_E_STALE, "block %u has no %s %u: it is not deformable any more, or has %u", name.body,
            point ? "gridpoint" : "zone", name.number, end);
    return NULL;
}

tl_status tl_zone_field(tl_model *m, tl_zone_name zone, size_t index, tl_field_value *value)
{
    const tl_body_mesh *mesh = mesh_of(m, zone, false);
    if (!mesh)
        return m->error.status;
    const place at = place_of(m, mesh, zone.number);
    *value = (tl_field_value){{0}, NULL};
    zone_numbers(&at, index, value->number);
    if (index == Z_solid)
        value->text = m->zones->solid[at.parcel->solid].name;
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

static void put_state(const place *at, const char *name, size_t width, double *out)
{
    const struct tl_zones *z = at->m->zones;
    uint32_t begin, own;
    const bool has = find_state(z->solid[at->parcel->solid].of.kind, name, &begin, &own) && own == width;
    for (size_t k = 0; k < width; k++)
        out[k] = has ? z->zones.state[begin + k][at->row] : NAN;
}

/* The field of a name among some; `count`: there is none. */
static size_t field_named(const tl_field *fields, size_t count, const char *name)
{
    size_t k = 0;
    while (k < count && strcmp(fields[k].name, name) != 0)
        k++;
    return k;
}

static tl_status no_column(tl_model *m, const char *what, const char *name, bool text)
{
    return text ? tl_fail(&m->error, TL_E_ARGUMENT, "the field '%.80s' of a %s is a text, not a number", name, what)
                : tl_fail(&m->error, TL_E_NOT_FOUND, "a %s has no field '%.80s'", what, name);
}

tl_status tl_zones_values(tl_model *m, const tl_zone_name *names, size_t count, const char *name, double *out,
                          size_t *width)
{
    const size_t field = field_named(zone_fields, Z_COUNT, name), state = state_width(m, name);
    const bool text = field < Z_COUNT && zone_fields[field].kind == TL_FIELD_TEXT;
    if (text || (field == Z_COUNT && state == 0))
        return no_column(m, "zone", name, text);
    *width = field < Z_COUNT ? tl_field_width(zone_fields[field].kind) : state;
    for (size_t k = 0; out && k < count; k++) {
        const tl_body_mesh *mesh = mesh_of(m, names[k], false);
        double all[6] = {0};
        if (!mesh)
            return m->error.status;
        const place at = place_of(m, mesh, names[k].number);
        if (field < Z_COUNT)
            zone_numbers(&at, field, all);
        else
            put_state(&at, name, state, all);
        memcpy(out + k * *width, all, *width * sizeof *out);
    }
    return TL_OK;
}

tl_status tl_gridpoints_values(tl_model *m, const tl_zone_name *names, size_t count, const char *name, double *out,
                               size_t *width)
{
    const size_t field = field_named(point_fields, P_COUNT, name);
    if (field == P_COUNT)
        return no_column(m, "gridpoint", name, false);
    *width = tl_field_width(point_fields[field].kind);
    for (size_t k = 0; out && k < count; k++) {
        const tl_body_mesh *mesh = mesh_of(m, names[k], true);
        double all[6] = {0};
        if (!mesh)
            return m->error.status;
        point_numbers(m, mesh, mesh->point_begin + names[k].number, field, all);
        memcpy(out + k * *width, all, *width * sizeof *out);
    }
    return TL_OK;
}
