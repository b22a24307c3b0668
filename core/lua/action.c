/* action.c - what acts on blocks from outside: selection:load{...}, selection:drive{...} and selection:reaction().
 *
 * A drive given by functions of the script is kept as an *anchor*: a userdata whose user values are the
 * functions. Anchors are in a table that is a user value of the model's userdata. So a function that refers
 * to its model does not keep it alive. When a drive ends the kernel touches no Lua state: it marks the
 * anchor, which goes with the next verb.
 *
 * The functions are called in a step, on the thread and in the frame of the run, in protected calls. An
 * error ends the run and is then raised as it was. */
#include "lua/action.h"

#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/living.h"

#include <math.h>
#include <talus/boundary.h>

static const char *const key_names[] = {
    [TL_LUA_VELOCITY] = "velocity",
    [TL_LUA_ANGULAR_VELOCITY] = "angular_velocity",
};

const tl_lua_key tl_lua_drive_keys[] = {
    {"velocity", "{x, y, z} or function(t)",
     "velocity of the centroid, m/s; the function gives {x, y, z} or three numbers for a time t, "
     "s: the middle of each step. Zero when left out"},
    {"angular_velocity", "{x, y, z} or function(t)", "angular velocity, rad/s, likewise"},
    {NULL, NULL, NULL},
};

/* ---------------------------------------------------------------- anchors ---------------- */

tl_lua_anchor *tl_lua_anchor_push(lua_State *L, int model_index)
{
    tl_lua_anchor *a = lua_newuserdatauv(L, sizeof *a, TL_LUA_MOTIONS);
    a->ended = true;
    lua_getiuservalue(L, model_index, 1);
    lua_pushvalue(L, -2);
    lua_rawsetp(L, -2, a);
    lua_pop(L, 1);
    return a;
}

static void on_release(void *user)
{
    tl_lua_anchor *a = user;
    a->ended = true;
}

/* ---------------------------------------------------------------- in a step -------------- */

typedef struct call {
    tl_lua_anchor *anchor;
    int key;
    double t;
    tl_vec3 velocity;
} call;

/* Raises at the place where the function at index 2 is defined. */
static int bad_velocity(lua_State *L, const call *c, const char *what)
{
    lua_pushnumber(L, c->t);
    tl_lua_push_number_text(L, -1);
    return tl_lua_fail_in(L, 2, "drive: %s(%s) must give three finite numbers: it gave %s",
                          key_names[c->key], lua_tostring(L, -1), what);
}

/* Three numbers from index `first` on. */
static tl_vec3 read_velocity(lua_State *L, const call *c, int first)
{
    double v[3];
    for (int k = 0; k < 3; k++) {
        if (lua_type(L, first + k) != LUA_TNUMBER)
            bad_velocity(L, c, tl_lua_describe(L, first + k));
        v[k] = lua_tonumber(L, first + k);
        if (!isfinite(v[k]))
            bad_velocity(L, c, tl_lua_describe(L, first + k));
    }
    return (tl_vec3){v[0], v[1], v[2]};
}

/* Runs protected. Arguments: the call, the function. */
static int call_function(lua_State *L)
{
    call *c = lua_touserdata(L, 1);
    lua_pushvalue(L, 2);
    lua_pushnumber(L, c->t);
    lua_call(L, 1, LUA_MULTRET);
    int given = lua_gettop(L) - 2;
    luaL_checkstack(L, 16, "too many values");
    if (given == 1 && lua_istable(L, 3)) {
        if (lua_rawlen(L, 3) != 3)
            bad_velocity(L, c, lua_pushfstring(L, "a list of %I", (lua_Integer)lua_rawlen(L, 3)));
        for (int k = 1; k <= 3; k++)
            lua_rawgeti(L, 3, k);
        c->velocity = read_velocity(L, c, 4);
    } else if (given == 3) {
        c->velocity = read_velocity(L, c, 3);
    } else {
        bad_velocity(L, c,
                     given == 1 ? tl_lua_describe(L, 3) : lua_pushfstring(L, "%d values", given));
    }
    return 0;
}

static bool evaluate(tl_lua_anchor *a, int key, double t, tl_vec3 *velocity)
{
    lua_State *L = tl_lua_run_state();
    call c = {.anchor = a, .key = key, .t = t};
    lua_pushcfunction(L, call_function);
    lua_pushlightuserdata(L, &c);
    lua_getiuservalue(L, TL_LUA_AT_MODEL, 1);
    lua_rawgetp(L, -1, a);
    lua_getiuservalue(L, -1, key);
    lua_replace(L, -3);
    lua_pop(L, 1);
    if (lua_pcall(L, 2, 0, 0) != LUA_OK) {
        tl_lua_run_keep_error();
        return false;
    }
    *velocity = c.velocity;
    return true;
}

static bool velocity_at(void *user, double t, tl_vec3 *velocity)
{
    return evaluate(user, TL_LUA_VELOCITY, t, velocity);
}

static bool angular_velocity_at(void *user, double t, tl_vec3 *velocity)
{
    return evaluate(user, TL_LUA_ANGULAR_VELOCITY, t, velocity);
}

void tl_lua_anchor_drive(lua_State *L, tl_lua_anchor *a, tl_drive *drive)
{
    bool moves = lua_getiuservalue(L, -1, TL_LUA_VELOCITY) == LUA_TFUNCTION;
    bool turns = lua_getiuservalue(L, -2, TL_LUA_ANGULAR_VELOCITY) == LUA_TFUNCTION;
    lua_pop(L, 2);
    *drive = tl_drive_default();
    drive->velocity_at = moves ? velocity_at : NULL;
    drive->angular_velocity_at = turns ? angular_velocity_at : NULL;
    drive->user = a;
    drive->release = on_release;
}

/* ---------------------------------------------------------------- verbs ------------------ */

tl_status tl_lua_blocks_load(lua_State *L, const tl_lua_selection *b)
{
    tl_load load = tl_load_default();
    tl_lua_read_function(L, 2, "load", NULL, &load);
    if (!lua_istable(L, 2))
        tl_lua_fail(L, "load: give force, moment and at in a table; load{} takes the load off");
    return tl_blocks_load(b->owner->model, b->ids, b->count, &load);
}

/* Reads one of the two velocities of the table at index 2; true when it is given. A function goes to
 * the anchor at the top of the stack. */
static bool read_motion(lua_State *L, int key, tl_vec3 *constant, tl_drive_fn *function,
                        tl_drive_fn ours)
{
    static const tl_param vectors[] = {
        [TL_LUA_VELOCITY] = TL_PARAM(TL_PARAM_VEC3, tl_drive, velocity, "m/s", "", .def = {0.0}),
        [TL_LUA_ANGULAR_VELOCITY] =
            TL_PARAM(TL_PARAM_VEC3, tl_drive, angular_velocity, "rad/s", "", .def = {0.0}),
    };
    int type = lua_getfield(L, 2, key_names[key]);
    if (type == LUA_TFUNCTION) {
        lua_setiuservalue(L, -2, key);
        *function = ours;
        return true;
    }
    if (type != LUA_TNIL) {
        int top = lua_gettop(L);
        tl_drive read;
        tl_lua_spec spec = {"drive", &vectors[key], 1, NULL};
        if (type != LUA_TTABLE)
            tl_lua_fail(L, "drive: %s must be a list of 3 numbers or a function(t), not %s",
                        key_names[key], tl_lua_describe(L, -1));
        tl_lua_read_one(L, top, &spec, key_names[key], &read);
        *constant = key == TL_LUA_VELOCITY ? read.velocity : read.angular_velocity;
        lua_settop(L, top);
    }
    lua_pop(L, 1);
    return type != LUA_TNIL;
}

tl_status tl_lua_blocks_drive(lua_State *L, const tl_lua_selection *b)
{
    tl_lua_spec spec = {"drive", NULL, 0, tl_lua_drive_keys};
    tl_lua_read(L, 2, &spec, false, NULL);
    lua_settop(L, 2);
    lua_getiuservalue(L, 1, 1);
    tl_lua_anchor *a = tl_lua_anchor_push(L, 3);
    tl_drive drive = tl_drive_default();
    drive.user = a;
    drive.release = on_release;
    bool moves = false;
    if (lua_istable(L, 2)) {
        moves = read_motion(L, TL_LUA_VELOCITY, &drive.velocity, &drive.velocity_at, velocity_at);
        moves |= read_motion(L, TL_LUA_ANGULAR_VELOCITY, &drive.angular_velocity,
                             &drive.angular_velocity_at, angular_velocity_at);
    }
    if (!moves)
        tl_lua_fail(L, "drive: give velocity, angular_velocity or both; to hold blocks use "
                       "selection:fix(), to let them go selection:free()");
    tl_status status = tl_blocks_drive(b->owner->model, b->ids, b->count, &drive);
    if (status == TL_OK && b->count > 0)
        a->ended = false;
    return status;
}

int tl_lua_blocks_reaction(lua_State *L, const tl_lua_selection *blocks)
{
    tl_model *model = tl_lua_living(L, blocks->owner);
    tl_vec3 force;
    tl_lua_ok(L, model, tl_blocks_reaction(model, blocks->ids, blocks->count, &force));
    tl_lua_push_vec3(L, force);
    return 1;
}

const tl_lua_topic tl_lua_action_topics[] = {
    {.name = "load",
     .usage = "selection:load{force = {0, 0, -1e3}, at = {x, y, z}}",
     .function = "load"},
    {.name = "drive",
     .usage = "selection:drive{velocity = function(t) return 0.1 * math.sin(t), 0, 0 end}",
     .doc = "Prescribes the motion of the blocks' bodies, in the place of any fixing, until "
            "selection:free(). A function is called in the middle of a step: it may read the "
            "model, but not change it. A body that is driven to turn is not cut in two.",
     .keys = tl_lua_drive_keys},
    {.name = NULL},
};
