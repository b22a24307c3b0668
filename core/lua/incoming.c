/* incoming.c - waves that come in through quiet faces of deformable blocks: the gridpoints on these faces.
 *
 * A face bears triangles of zones. Each gridpoint gets a third of the area of its triangles. Their impedances are those
 * of the solids of their zones, (rho M)^(1/2) and (rho G)^(1/2), as of the dashpots of the face (core/zone/outer.c). */
#include "lua/incoming.h"

#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/living.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/fields.h>
#include <talus/views.h>
#include <talus/vmath.h>
#include <talus/zones.h>

/* Tolerance: over the square root of a face's area, how far off its plane corners of its triangles may be. Test:
 * lua/test_quiet_zones. */
#define OFF_PLANE 1e-3
/* Tolerance: by so much of it the area of a face may be more than that of its bare part. Test: lua/test_quiet_zones. */
#define COVERED 1e-3

/* What a gridpoint of a face stands for: sums of areas, and of areas times impedances. */
typedef struct portion {
    double area, along, across;
} portion;

/* Zones of a block, and gridpoints of its body. */
typedef struct zones_of {
    tl_id block;
    size_t count, points;
    const uint32_t (*corner)[4];
    const double *along, *across; /* impedances of each zone */
    const tl_vec3 *at;
    portion *to;
} zones_of;

static void *room(lua_State *L, size_t count, size_t size)
{
    void *p = lua_newuserdatauv(L, (count + 1) * size, 0);
    memset(p, 0, (count + 1) * size);
    return p;
}

/* Moduli of a solid, Pa. */
static void moduli_of(lua_State *L, const tl_solid_info *solid, double *constrained, double *shear)
{
    const tl_solid_ops *ops = solid->kind->ops;
    tl_report report = {.size = sizeof report};
    void *self = NULL;
    if (ops->create && ops->create(solid->params, &self, &report) != TL_OK)
        tl_lua_fail(L, "boundary: solid '%s' cannot be made: %s", solid->name, report.text);
    ops->moduli(ops->create ? self : solid->params, constrained, shear);
    if (ops->destroy && ops->create)
        ops->destroy(self);
}

static size_t field_index(const char *name)
{
    size_t count, i = 0;
    const tl_field *fields = tl_zone_fields(&count);
    while (strcmp(fields[i].name, name) != 0)
        i++;
    return i;
}

/* Impedances of zones by their solids. */
static void read_impedances(lua_State *L, tl_model *model, const tl_zone_name *zone, zones_of *of)
{
    double density, *along = room(L, of->count, sizeof *along), *across = room(L, of->count, sizeof *across);
    size_t width, solids = tl_solid_count(model), solid = field_index("solid");
    double(*moduli)[2] = room(L, solids, sizeof *moduli);
    tl_lua_ok(L, model, tl_blocks_values(model, &of->block, 1, "density", &density, &width));
    for (size_t i = 0; i < of->count; i++) {
        tl_field_value value;
        size_t k = 0;
        tl_lua_ok(L, model, tl_zone_field(model, zone[i], solid, &value));
        while (k + 1 < solids && strcmp(tl_solid_at(model, k).name, value.text) != 0)
            k++;
        const tl_solid_info info = tl_solid_at(model, k);
        if (moduli[k][0] == 0)
            moduli_of(L, &info, &moduli[k][0], &moduli[k][1]);
        along[i] = sqrt(density * moduli[k][0]);
        across[i] = sqrt(density * moduli[k][1]);
    }
    of->along = along;
    of->across = across;
}

static zones_of read_zones(lua_State *L, tl_model *model, tl_id block)
{
    zones_of of = {.block = block};
    tl_zone_filter filter = tl_zone_filter_default();
    tl_zone_name *found = NULL;
    tl_gridpoint_views views;
    filter.blocks = &block;
    filter.block_count = 1;
    tl_lua_ok(L, model, tl_zones_select(model, &filter, &found, &of.count));
    tl_zone_name *zone = room(L, of.count, sizeof *zone);
    memcpy(zone, found, of.count * sizeof *zone);
    free(found);
    uint32_t(*corner)[4] = room(L, of.count, sizeof *corner);
    tl_lua_ok(L, model, tl_zones_corners(model, zone, of.count, corner));
    of.corner = (const uint32_t(*)[4])corner;
    read_impedances(L, model, zone, &of);
    tl_lua_ok(L, model, tl_view_gridpoints(model, block, &views));
    of.points = views.mass.count;
    tl_vec3 *at = room(L, of.points, sizeof *at);
    for (size_t i = 0; i < of.points; i++) {
        double x[3];
        for (int k = 0; k < 3; k++)
            x[k] = views.reference[k].data[i * views.reference[k].stride] +
                   views.displacement[k].data[i * views.displacement[k].stride];
        at[i] = tl_v3_add(views.origin, tl_v3(x[0], x[1], x[2]));
    }
    of.at = at;
    of.to = room(L, of.points, sizeof *of.to);
    return of;
}

/* Adds a side of a zone, where it lies in the face; its area. */
static double add_side(const zones_of *of, size_t zone, const uint32_t corner[3], const tl_boundary_face *f)
{
    const double off = OFF_PLANE * sqrt(f->area);
    const tl_vec3 *x = of->at;
    for (int a = 0; a < 3; a++)
        if (fabs(tl_v3_dot(f->normal, tl_v3_sub(x[corner[a]], f->centroid))) > off)
            return 0;
    const tl_vec3 area =
        tl_v3_scale(0.5, tl_v3_cross(tl_v3_sub(x[corner[1]], x[corner[0]]), tl_v3_sub(x[corner[2]], x[corner[0]])));
    const double size = tl_v3_norm(area);
    for (int a = 0; a < 3; a++) {
        portion *to = &of->to[corner[a]];
        to->area += size / 3;
        to->along += size / 3 * of->along[zone];
        to->across += size / 3 * of->across[zone];
    }
    return size;
}

static void put_numbers(luaL_Buffer *text, const double *number, size_t count)
{
    char digits[TL_LUA_NUMBER];
    for (size_t i = 0; i < count; i++) {
        luaL_addstring(text, tl_lua_number_text(number[i], 17, digits));
        luaL_addchar(text, ' ');
    }
}

/* Puts the nodes of a face into the text. */
static void put_face(lua_State *L, luaL_Buffer *text, const zones_of *of, const tl_boundary_face *f)
{
    static const uint8_t side[4][3] = {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}};
    double area = 0;
    memset(of->to, 0, of->points * sizeof *of->to);
    for (size_t i = 0; i < of->count; i++)
        for (int s = 0; s < 4; s++) {
            const uint32_t corner[3] = {of->corner[i][side[s][0]], of->corner[i][side[s][1]],
                                        of->corner[i][side[s][2]]};
            area += add_side(of, i, corner, f);
        }
    if (!(fabs(area - f->area) <= COVERED * f->area))
        tl_lua_fail(L,
                    "boundary: a wave comes in through whole faces, and other blocks cover a part of face %d of block "
                    "%d: leave it out by a box, or cut the block where they end",
                    (int)f->face + 1, (int)f->block);
    for (size_t i = 0; i < of->points; i++) {
        const portion *to = &of->to[i];
        if (to->area > 0)
            put_numbers(text,
                        (const double[]){f->block, f->face, of->at[i].x, of->at[i].y, of->at[i].z, f->normal.x,
                                         f->normal.y, f->normal.z, to->area, to->along / to->area,
                                         to->across / to->area},
                        11);
    }
}

void tl_lua_incoming_put(lua_State *L, tl_model *model, const tl_boundary_face *faces, size_t count)
{
    const int table = lua_gettop(L);
    luaL_checkstack(L, 40, "too many sides");
    lua_pushliteral(L, "");
    for (size_t i = 0, end; i < count; i = end) {
        const int top = lua_gettop(L);
        const zones_of of = read_zones(L, model, faces[i].block);
        luaL_Buffer text;
        luaL_buffinit(L, &text);
        for (end = i; end < count && faces[end].block == faces[i].block; end++)
            put_face(L, &text, &of, &faces[end]);
        luaL_pushresult(&text);
        lua_insert(L, top + 1);
        lua_settop(L, top + 1);
        lua_concat(L, 2);
    }
    lua_setfield(L, table, "nodes");
}
