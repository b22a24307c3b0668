/* scene_zones.c - see scene_zones.h; docs/scene_format.md says what is in the chunks.
 *
 * A frame has all zones, so that a section can go through them. Of more than MOST it has those at surfaces only. */
#include "io/scene_zones.h"

#include "base/columns.h"
#include "base/error.h"
#include "io/json.h"
#include "io/scene_put.h"
#include "io/zone_list.h"
#include "query/zone_fields.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/zones.h>

/* Limit: zones of a model up to which all are sent. A page that is turned and cut with more is slow. */
#define MOST 400000
/* Zones whose values are asked for at a time. */
#define ASKED 256

/* ---------------------------------------------------------------- which zones ------------ */

/* The zones of a frame. */
typedef struct shown {
    tl_zone_list list;
    uint32_t *zone_of_part; /* [parts] number in the list of the zone of a triangle */
    uint32_t *number;       /* [zones] of a zone among those that are sent, or TL_NO_ROW */
    uint32_t *picked;       /* [count] numbers in the list of those that are sent */
    size_t count;
    bool whole; /* all are sent */
} shown;

/* The rows of the corners of a zone or of a triangle with its zone's fourth corner, ascending. */
typedef struct corners {
    uint32_t row[4];
} corners;

static corners in_order(corners c)
{
    for (int i = 1; i < 4; i++)
        for (int k = i; k > 0 && c.row[k - 1] > c.row[k]; k--) {
            const uint32_t kept = c.row[k];
            c.row[k] = c.row[k - 1];
            c.row[k - 1] = kept;
        }
    return c;
}

static corners corners_of_zone(const tl_zone_list *l, size_t zone)
{
    corners c;
    for (int a = 0; a < 4; a++)
        c.row[a] = tl_zone_list_corner(l, zone, a);
    return in_order(c);
}

static corners corners_of_part(const tl_surface_part *part)
{
    return in_order((corners){{part->corner[0], part->corner[1], part->corner[2], part->apex}});
}

static size_t place_of(const corners *c, size_t mask)
{
    uint64_t mixed = 0;
    for (int i = 0; i < 4; i++)
        mixed = (mixed ^ c->row[i]) * UINT64_C(0x9e3779b97f4a7c15);
    return (size_t)(mixed >> 32) & mask;
}

/* Triangles by their corners: slots hold their numbers, or TL_NO_ROW. A zone may have several. */
static bool find_parts(shown *s)
{
    const tl_zone_list *l = &s->list;
    size_t size = 16;
    while (size < 2 * l->parts)
        size *= 2;
    uint32_t *slot = malloc(size * sizeof *slot);
    corners *of = malloc((l->parts + 1) * sizeof *of);
    for (size_t k = 0; slot && k < size; k++)
        slot[k] = TL_NO_ROW;
    for (size_t mesh = 0; slot && of && mesh < l->meshes; mesh++)
        for (uint32_t i = l->part_start[mesh]; i < l->part_start[mesh + 1]; i++) {
            of[i] = corners_of_part(tl_zone_list_part(l, mesh, i - l->part_start[mesh]));
            size_t at = place_of(&of[i], size - 1);
            while (slot[at] != TL_NO_ROW)
                at = (at + 1) & (size - 1);
            slot[at] = i;
        }
    for (uint32_t zone = 0; slot && of && zone < l->zones; zone++) {
        const corners c = corners_of_zone(l, zone);
        for (size_t at = place_of(&c, size - 1); slot[at] != TL_NO_ROW; at = (at + 1) & (size - 1))
            if (memcmp(&c, &of[slot[at]], sizeof c) == 0)
                s->zone_of_part[slot[at]] = zone;
    }
    const bool enough = slot && of;
    free(slot);
    free(of);
    return enough;
}

static void pick(shown *s)
{
    const tl_zone_list *l = &s->list;
    s->whole = l->zones <= MOST;
    for (uint32_t i = 0; i < l->zones; i++)
        s->number[i] = s->whole ? i : TL_NO_ROW;
    for (size_t k = 0; !s->whole && k < l->parts; k++)
        s->number[s->zone_of_part[k]] = 0;
    for (uint32_t i = 0; i < l->zones; i++)
        if (s->number[i] != TL_NO_ROW) {
            s->number[i] = (uint32_t)s->count;
            s->picked[s->count++] = i;
        }
}

static void free_shown(shown *s)
{
    free(s->zone_of_part);
    free(s->number);
    free(s->picked);
    tl_zone_list_free(&s->list);
}

static tl_status find_shown(tl_model *m, shown *s)
{
    *s = (shown){.count = 0};
    const tl_status status = tl_zone_list_make(m, &s->list);
    if (status != TL_OK)
        return status;
    s->zone_of_part = calloc(s->list.parts + 1, sizeof *s->zone_of_part);
    s->number = malloc((s->list.zones + 1) * sizeof *s->number);
    s->picked = malloc((s->list.zones + 1) * sizeof *s->picked);
    if (!s->zone_of_part || !s->number || !s->picked || !find_parts(s))
        return tl_fail_memory(&m->error);
    pick(s);
    return TL_OK;
}

/* ---------------------------------------------------------------- SURF ------------------- */

typedef struct surface_columns {
    unsigned char *body, *points, *zones, *triangles, *made, *corner, *solid, *home, *triangle, *zone, *block, *face;
} surface_columns;

static void put_mesh(const shown *s, size_t k, surface_columns *to)
{
    const tl_zone_list *l = &s->list;
    const struct tl_zones *z = l->of;
    const tl_body_mesh *mesh = &z->mesh[l->mesh[k]];
    uint32_t zones = 0;
    for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++)
        to->made = tl_put_vec3(to->made, tl_columns_get(z->points.ref, row));
    for (uint32_t i = l->zone_start[k]; i < l->zone_start[k + 1]; i++) {
        if (s->number[i] == TL_NO_ROW)
            continue;
        for (int a = 0; a < 4; a++)
            to->corner = tl_put_u32(to->corner, tl_zone_list_point(l, k, tl_zone_list_corner(l, i, a)));
        to->solid = tl_put_u16(to->solid, z->parcels.of[l->parcel[i]].solid);
        to->home = tl_put_u32(to->home, z->parcels.of[l->parcel[i]].block);
        zones++;
    }
    for (uint32_t i = l->part_start[k]; i < l->part_start[k + 1]; i++) {
        const tl_surface_part *part = tl_zone_list_part(l, k, i - l->part_start[k]);
        for (int c = 0; c < 3; c++)
            to->triangle = tl_put_u32(to->triangle, tl_zone_list_point(l, k, part->corner[c]));
        to->zone = tl_put_u32(to->zone, s->number[s->zone_of_part[i]]);
        to->block = tl_put_u32(to->block, part->block);
        to->face = tl_put_u32(to->face, part->face);
    }
    to->body = tl_put_u32(to->body, mesh->body);
    to->points = tl_put_u32(to->points, l->point_start[k + 1] - l->point_start[k]);
    to->zones = tl_put_u32(to->zones, zones);
    to->triangles = tl_put_u32(to->triangles, l->part_start[k + 1] - l->part_start[k]);
}

static tl_status put_surface(tl_model *m, const shown *s, tl_piece *out)
{
    const size_t n = s->list.meshes, points = s->list.points, zones = s->count, triangles = s->list.parts;
    const size_t bytes = 20 + 16 * n + 12 * points + 20 * zones + tl_scene_column_bytes(zones, 2) + 24 * triangles;
    unsigned char *to = tl_scene_chunk(out, "SURF", bytes, &m->error);
    if (!to)
        return m->error.status;
    to = tl_put_u32(to, (uint32_t)n);
    to = tl_put_u32(to, (uint32_t)points);
    to = tl_put_u32(to, (uint32_t)zones);
    to = tl_put_u32(to, (uint32_t)triangles);
    to = tl_put_u32(to, s->whole);
    surface_columns columns = {.body = tl_scene_column(&to, n, 4),
                               .points = tl_scene_column(&to, n, 4),
                               .zones = tl_scene_column(&to, n, 4),
                               .triangles = tl_scene_column(&to, n, 4),
                               .made = tl_scene_column(&to, points, 12),
                               .corner = tl_scene_column(&to, zones, 16),
                               .solid = tl_scene_column(&to, zones, 2),
                               .home = tl_scene_column(&to, zones, 4),
                               .triangle = tl_scene_column(&to, triangles, 12),
                               .zone = tl_scene_column(&to, triangles, 4),
                               .block = tl_scene_column(&to, triangles, 4),
                               .face = tl_scene_column(&to, triangles, 4)};
    for (size_t k = 0; k < n; k++)
        put_mesh(s, k, &columns);
    return TL_OK;
}

tl_status tl_scene_surface(tl_model *m, tl_hash sent, tl_hash *next, tl_piece *out)
{
    *next = (tl_hash){0, 0};
    if (!tl_model_deforms(m) && sent.a == 0 && sent.b == 0)
        return TL_OK;
    shown s;
    const size_t begin = out->length;
    tl_status status = find_shown(m, &s);
    if (status == TL_OK)
        status = put_surface(m, &s, out);
    free_shown(&s);
    if (status != TL_OK)
        return status;
    *next = tl_hash_start();
    tl_hash_bytes(next, out->data + begin, out->length - begin);
    if (sent.a == next->a && sent.b == next->b)
        out->length = begin;
    return TL_OK;
}

/* ---------------------------------------------------------------- SPOS ------------------- */

static tl_status put_places(tl_model *m, const tl_zone_list *l, tl_piece *out, double *largest)
{
    const tl_gridpoints *p = &m->zones->points;
    unsigned char *to = tl_scene_chunk(out, "SPOS", 4 + 24 * l->points, &m->error);
    if (!to)
        return m->error.status;
    to = tl_put_u32(to, (uint32_t)l->points);
    unsigned char *place = tl_scene_column(&to, l->points, 12), *moved = tl_scene_column(&to, l->points, 12);
    for (size_t k = 0; k < l->meshes; k++) {
        const tl_body_mesh *mesh = &l->of->mesh[l->mesh[k]];
        for (uint32_t row = mesh->point_begin; row < mesh->point_end; row++) {
            const tl_vec3 u = tl_columns_get(p->u, row);
            place = tl_put_vec3(place, tl_gridpoint_place(p, row));
            moved = tl_put_vec3(moved, u);
            *largest = fmax(*largest, tl_v3_norm(u));
        }
    }
    return TL_OK;
}

/* ---------------------------------------------------------------- ZFLD ------------------- */

static const char *const components[] = {"stress xx", "stress yy", "stress zz", "stress xy", "stress yz", "stress zx"};

enum { COMPONENTS = sizeof components / sizeof *components };

static unsigned char *put_state(const shown *s, unsigned char *to)
{
    const struct tl_zones *z = s->list.of;
    for (size_t k = 0; k < s->count; k++)
        to = tl_put_f32(to, tl_zone_state(z->zones.flags[s->list.row[s->picked[k]]]));
    return to;
}

/* A state of the solids that is one number. */
static tl_status put_solid_state(tl_model *m, const shown *s, const char *name, unsigned char *to)
{
    tl_zone_name names[ASKED];
    double values[ASKED];
    size_t width;
    tl_status status = TL_OK;
    for (size_t begin = 0, next; begin < s->count && status == TL_OK; begin = next) {
        next = s->count - begin < ASKED ? s->count : begin + ASKED;
        for (size_t k = begin; k < next; k++)
            names[k - begin] = s->list.zone_name[s->picked[k]];
        status = tl_zones_values(m, names, next - begin, name, values, &width);
        for (size_t k = begin; k < next && status == TL_OK; k++)
            to = tl_put_f32(to, values[k - begin]);
    }
    return status;
}

/* Begins the next field. NULL: it does not fit. */
static unsigned char *begin_field(tl_model *m, const shown *s, uint32_t *number, tl_piece *out)
{
    unsigned char *to = tl_scene_chunk(out, "ZFLD", 8 + 4 * s->count, &m->error);
    if (!to)
        return NULL;
    to = tl_put_u32(to, (*number)++);
    return tl_put_u32(to, (uint32_t)s->count);
}

static tl_status put_fields(tl_model *m, const shown *s, tl_piece *out)
{
    const tl_state *states[TL_ZONE_STATES];
    const size_t count = tl_zone_states(m, states);
    uint32_t number = 0;
    unsigned char *to = NULL;
    for (int c = 0; c < COMPONENTS; c++) {
        if (!(to = begin_field(m, s, &number, out)))
            return m->error.status;
        for (size_t k = 0; k < s->count; k++)
            to = tl_put_f32(to, m->zones->zones.stress[c][s->list.row[s->picked[k]]]);
    }
    if (!(to = begin_field(m, s, &number, out)))
        return m->error.status;
    put_state(s, to);
    tl_status status = TL_OK;
    for (size_t k = 0; k < count && status == TL_OK; k++) {
        if (states[k]->kind != TL_STATE_SCALAR)
            continue;
        to = begin_field(m, s, &number, out);
        status = to ? put_solid_state(m, s, states[k]->name, to) : m->error.status;
    }
    return status;
}

tl_status tl_scene_zones(tl_model *m, tl_piece *out, double *largest)
{
    if (!tl_model_deforms(m))
        return TL_OK;
    shown s;
    tl_status status = find_shown(m, &s);
    if (status == TL_OK)
        status = put_places(m, &s.list, out, largest);
    if (status == TL_OK)
        status = put_fields(m, &s, out);
    free_shown(&s);
    return status;
}

/* ---------------------------------------------------------------- HEAD ------------------- */

void tl_scene_zones_head(const tl_model *m, tl_piece *text)
{
    if (!tl_model_deforms(m))
        return;
    const tl_state *states[TL_ZONE_STATES];
    const size_t count = tl_zone_states(m, states);
    tl_json_put(text, ", \"solids\": [");
    for (size_t i = 0; i < m->zones->solid_count; i++)
        tl_json_print(text, i ? ", %s" : "%s", m->zones->solid[i].name);
    tl_json_put(text, "], \"zone_states\": [");
    for (uint32_t k = 0; tl_zone_state_name(k); k++)
        tl_json_print(text, k ? ", %s" : "%s", tl_zone_state_name(k));
    tl_json_put(text, "], \"zone_fields\": [");
    for (int c = 0; c < COMPONENTS; c++)
        tl_json_print(text, "{\"name\": %s, \"unit\": \"Pa\"}, ", components[c]);
    tl_json_put(text, "{\"name\": \"state\", \"unit\": \"\"}");
    for (size_t k = 0; k < count; k++)
        if (states[k]->kind == TL_STATE_SCALAR)
            tl_json_print(text, ", {\"name\": %s, \"unit\": %s}", states[k]->name, states[k]->unit);
    tl_json_put(text, "]");
}
