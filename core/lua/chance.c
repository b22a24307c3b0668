/* chance.c - the module talus.chance, for modules of Talus that are written in Lua: draws by keys, quantiles of
 * distributions, intervals of probabilities, orientations of planes and their mean.
 *
 * Arguments come from those modules, which have checked what users give. */
#include "lua/chance.h"

#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/living.h"

#include <float.h>
#include <math.h>
#include <string.h>
#include <talus/distributions.h>
#include <talus/draws.h>
#include <talus/poles.h>

/* Constant: the level of all intervals, 95 %. */
#define LEVEL 0.95

/* ---------------------------------------------------------------- draws ------------------ */

/* (seed, row, name, part, latin) from index 1 on. */
static tl_draw read_draw(lua_State *L)
{
    return (tl_draw){.seed = (uint64_t)luaL_checkinteger(L, 1),
                     .row = (uint64_t)luaL_checkinteger(L, 2),
                     .name = luaL_checkstring(L, 3),
                     .part = (uint32_t)luaL_optinteger(L, 4, 0),
                     .latin = (uint64_t)luaL_optinteger(L, 5, 0)};
}

static int uniform(lua_State *L)
{
    const tl_draw draw = read_draw(L);
    lua_pushnumber(L, tl_draw_uniform(&draw));
    return 1;
}

static int key(lua_State *L)
{
    const tl_draw draw = read_draw(L);
    lua_pushinteger(L, (lua_Integer)tl_draw_key(&draw));
    return 1;
}

/* ---------------------------------------------------------------- distributions ---------- */

/* A distribution with its parameters, cut off to [min, max]. */
typedef struct distribution {
    double a, b, c, min, max;
} distribution;

static double normal_share(const distribution *d, double x)
{
    return tl_normal_below((x - d->a) / d->b);
}

static double normal_value(const distribution *d, double u)
{
    return d->a + d->b * tl_normal_quantile(u);
}

static double lognormal_share(const distribution *d, double x)
{
    return tl_lognormal_below(tl_lognormal_of(d->a, d->b), x);
}

static double lognormal_value(const distribution *d, double u)
{
    return tl_lognormal_quantile(tl_lognormal_of(d->a, d->b), u);
}

static double uniform_value(const distribution *d, double u)
{
    return d->a + u * (d->b - d->a);
}

static double triangular_value(const distribution *d, double u)
{
    return tl_triangular_quantile(d->a, d->b, d->c, u);
}

static double power_law_value(const distribution *d, double u)
{
    return tl_power_law_quantile(d->a, d->b, d->c, u);
}

/* The share below a value, and the value at a share. Without `share` nothing cuts it off. */
static const struct family {
    const char *name;
    double (*share)(const distribution *, double x);
    double (*value)(const distribution *, double u);
} families[] = {{"normal", normal_share, normal_value}, {"lognormal", lognormal_share, lognormal_value},
                {"uniform", NULL, uniform_value},       {"triangular", NULL, triangular_value},
                {"power_law", NULL, power_law_value},   {NULL, NULL, NULL}};

/* quantile(family, u, a, b, c, min, max): the value; nothing where less than TL_LEAST_SHARE lies in the range. */
static int quantile(lua_State *L)
{
    const char *name = luaL_checkstring(L, 1);
    const struct family *f = families;
    while (f->name && strcmp(f->name, name) != 0)
        f++;
    if (!f->name)
        return tl_lua_fail(L, "there is no distribution '%s'", name);
    const double u = luaL_checknumber(L, 2);
    const distribution d = {luaL_checknumber(L, 3), luaL_checknumber(L, 4), luaL_optnumber(L, 5, 0),
                            luaL_optnumber(L, 6, -INFINITY), luaL_optnumber(L, 7, INFINITY)};
    double low = 0, high = 1;
    if (f->share && d.b > 0) {
        low = isfinite(d.min) ? f->share(&d, d.min) : 0;
        high = isfinite(d.max) ? f->share(&d, d.max) : 1;
    } else if (f->share) { /* without a deviation all lies at the mean */
        high = d.a >= d.min && d.a <= d.max;
    }
    if (high - low < TL_LEAST_SHARE)
        return 0;
    const double x = f->share && !(d.b > 0) ? d.a : f->value(&d, tl_within(u, low, high));
    lua_pushnumber(L, fmin(fmax(x, d.min), d.max));
    return 1;
}

static int normal_below(lua_State *L)
{
    lua_pushnumber(L, tl_normal_below(luaL_checknumber(L, 1)));
    return 1;
}

static int normal_quantile(lua_State *L)
{
    lua_pushnumber(L, tl_normal_quantile(luaL_checknumber(L, 1)));
    return 1;
}

/* interval(hits, count): the ends of the interval that holds the probability. */
static int interval(lua_State *L)
{
    double low, high;
    tl_binomial_interval((uint64_t)luaL_checkinteger(L, 1), (uint64_t)luaL_checkinteger(L, 2), LEVEL, &low, &high);
    lua_pushnumber(L, low);
    lua_pushnumber(L, high);
    return 2;
}

/* ---------------------------------------------------------------- orientations ----------- */

static void push_vector(lua_State *L, tl_vec3 v)
{
    tl_lua_push_numbers(L, &v.x, 3);
}

/* normal(dip, dip_direction): the upward normal, a list of three. */
static int normal(lua_State *L)
{
    push_vector(L, tl_plane_normal(luaL_checknumber(L, 1), luaL_checknumber(L, 2)));
    return 1;
}

static int push_attitude(lua_State *L, tl_vec3 n)
{
    double dip, dip_direction;
    tl_plane_attitude(n, &dip, &dip_direction);
    lua_pushnumber(L, dip);
    lua_pushnumber(L, dip_direction);
    return 2;
}

static tl_vec3 read_vector(lua_State *L, int index)
{
    double v[3];
    for (int k = 0; k < 3; k++) {
        lua_rawgeti(L, index, k + 1);
        v[k] = luaL_checknumber(L, -1);
        lua_pop(L, 1);
    }
    return (tl_vec3){v[0], v[1], v[2]};
}

/* attitude({x, y, z}): dip and dip direction of the plane with this normal, degrees. */
static int attitude(lua_State *L)
{
    return push_attitude(L, read_vector(L, 1));
}

/* fisher(dip, dip_direction, k, u, v): dip and dip direction. */
static int fisher(lua_State *L)
{
    const tl_vec3 mean = tl_plane_normal(luaL_checknumber(L, 1), luaL_checknumber(L, 2));
    return push_attitude(
        L, tl_fisher_direction(mean, luaL_checknumber(L, 3), luaL_checknumber(L, 4), luaL_checknumber(L, 5)));
}

/* Reads the lists of normals and weights at indices 1 and 2 into memory on the Lua stack. */
static size_t read_poles(lua_State *L, tl_vec3 **normals, double **weights)
{
    const size_t count = (size_t)lua_rawlen(L, 1);
    *normals = lua_newuserdatauv(L, (count + 1) * sizeof **normals, 0);
    *weights = lua_newuserdatauv(L, (count + 1) * sizeof **weights, 0);
    for (size_t i = 0; i < count; i++) {
        lua_rawgeti(L, 1, (lua_Integer)i + 1);
        (*normals)[i] = read_vector(L, lua_gettop(L));
        lua_rawgeti(L, 2, (lua_Integer)i + 1);
        (*weights)[i] = luaL_checknumber(L, -1);
        lua_pop(L, 2);
    }
    return count;
}

/* axis(normals, weights): the principal axis. */
static int axis(lua_State *L)
{
    tl_vec3 *normals;
    double *weights;
    const size_t count = read_poles(L, &normals, &weights);
    push_vector(L, tl_poles_axis(normals, weights, count));
    return 1;
}

/* mean(normals, weights): {normal =, resultant =, kappa =, cone =}. */
static int mean(lua_State *L)
{
    tl_vec3 *normals;
    double *weights;
    const size_t count = read_poles(L, &normals, &weights);
    const tl_poles_mean m = tl_poles_mean_of(normals, weights, count);
    lua_createtable(L, 0, 6);
    tl_lua_set_vec3(L, "normal", m.mean);
    TL_LUA_SET_NUMBERS(L, {"resultant", m.resultant}, {"kappa", m.concentration}, {"cone", m.cone});
    return 1;
}

static int free_table(lua_State *L)
{
    tl_csv *table = lua_touserdata(L, 1);
    free(table->at);
    table->at = NULL;
    return 0;
}

/* read_poles(text): a list of {dip, dip_direction, weight}, sorted; or nil and a sentence. */
static int read_table(lua_State *L)
{
    static const tl_csv_column columns[] = TL_POLES_COLUMNS;
    size_t length;
    const char *text = luaL_checklstring(L, 1, &length);
    const bool is_text = strlen(text) == length;
    tl_csv *table = tl_lua_hold(L, sizeof *table, "talus.csv", free_table);
    table->column = columns;
    table->columns = 3;
    if (!is_text || !tl_csv_read(table, text)) {
        lua_pushnil(L);
        lua_pushstring(L, is_text ? table->why : "it holds a zero byte: it is no text; save it as UTF-8");
        return 2;
    }
    qsort(table->at, table->rows, 3 * sizeof *table->at, tl_measured_order);
    lua_createtable(L, (int)table->rows, 0);
    for (size_t i = 0; i < table->rows; i++) {
        tl_lua_push_numbers(L, table->at + 3 * i, 3);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    return 1;
}

/* ---------------------------------------------------------------- others ----------------- */

/* number_text(x): the shortest text that reads back as the same number, nan, inf or -inf. */
static int number_text(lua_State *L)
{
    char text[TL_LUA_NUMBER];
    const double x = luaL_checknumber(L, 1);
    if (lua_isinteger(L, 1))
        lua_pushfstring(L, "%I", lua_tointeger(L, 1));
    else if (isfinite(x))
        lua_pushstring(L, tl_lua_number_text(x, DBL_DIG, text));
    else
        lua_pushstring(L, isnan(x) ? "nan" : x > 0 ? "inf" : "-inf");
    return 1;
}

/* is_model(value) */
static int is_model(lua_State *L)
{
    lua_pushboolean(L, luaL_testudata(L, 1, TL_LUA_MODEL_TYPE) != NULL);
    return 1;
}

int tl_lua_chance_open(lua_State *L)
{
    static const luaL_Reg functions[] = {{"uniform", uniform},
                                         {"key", key},
                                         {"quantile", quantile},
                                         {"normal_below", normal_below},
                                         {"normal_quantile", normal_quantile},
                                         {"interval", interval},
                                         {"normal", normal},
                                         {"attitude", attitude},
                                         {"fisher", fisher},
                                         {"axis", axis},
                                         {"mean", mean},
                                         {"read_poles", read_table},
                                         {"number_text", number_text},
                                         {"is_model", is_model},
                                         {NULL, NULL}};
    luaL_newlib(L, functions);
    return 1;
}
