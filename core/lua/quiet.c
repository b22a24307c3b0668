/* quiet.c - quiet faces of rigid blocks: what model:boundary{quiet = true} makes of the faces that it has found.
 *
 * Elements of the kind "quiet" get the block, face, area, height across the face and density of each. They get the
 * stiffness of a joint's law, or the velocities of waves. A wave that comes in is given by displacements and velocities
 * at the samples of its record. */
#include "lua/quiet.h"

#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/living.h"
#include "lua/record.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elements.h>
#include <talus/fields.h>
#include <talus/settings.h>
#include <talus/vmath.h>

#define KIND "quiet"
/* Tolerance: least component of the normal of a face along an axis for the face to look along it. */
#define ALONG 0.99995

/* ---------------------------------------------------------------- blocks ----------------- */

static double *numbers_of(lua_State *L, tl_model *model, const tl_id *blocks, size_t count, const char *field,
                          size_t width)
{
    double *out = lua_newuserdatauv(L, (width * count + 1) * sizeof *out, 0);
    size_t is;
    tl_lua_ok(L, model, tl_blocks_values(model, blocks, count, field, out, &is));
    return out;
}

/* Whether the faces are of rigid blocks; raises where some are and others not. */
static bool are_rigid(lua_State *L, tl_model *model, const tl_lua_quiet *plan)
{
    const double *deforms = numbers_of(L, model, plan->block, plan->face_count, "deformable", 1);
    for (size_t i = 1; i < plan->face_count; i++)
        if (deforms[i] != deforms[0])
            tl_lua_fail(L,
                        "boundary: block %d is rigid and block %d deformable: give quiet faces of either by a call of "
                        "their own, with box",
                        (int)plan->block[deforms[i] != 0 ? 0 : i], (int)plan->block[deforms[i] != 0 ? i : 0]);
    return plan->face_count > 0 && deforms[0] == 0;
}

/* The axis along which a face looks, as TL_FIX_X to _Z; 0: along none. */
static unsigned axis_of(tl_vec3 n)
{
    return fabs(n.x) > ALONG ? TL_FIX_X : fabs(n.y) > ALONG ? TL_FIX_Y : fabs(n.z) > ALONG ? TL_FIX_Z : 0;
}

/* The first of the faces of a block, or the number of all. They go by ascending blocks. */
static size_t first_of(const tl_boundary_result *found, tl_id block)
{
    size_t low = 0, high = found->face_count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (found->faces[middle].block < block)
            low = middle + 1;
        else
            high = middle;
    }
    return low < found->face_count && found->faces[low].block == block ? low : found->face_count;
}

/* Components in which the same call holds a block by rollers; raises where it holds all. */
static unsigned held_by(lua_State *L, const tl_boundary_action *actions, const tl_boundary_result *found, size_t count,
                        tl_id block)
{
    unsigned held = 0;
    for (size_t k = 0; k < count; k++) {
        const tl_boundary_action *a = &actions[k];
        size_t i = a->fixed || a->drive || a->roller ? first_of(&found[k], block) : found[k].face_count;
        if (i < found[k].face_count && (a->fixed || a->drive))
            tl_lua_fail(L,
                        "boundary: block %d has a quiet face, and the same call holds it whole: a quiet face moves, so "
                        "give such blocks rollers, or leave them out by a box",
                        (int)block);
        for (; i < found[k].face_count && found[k].faces[i].block == block; i++)
            held |= axis_of(found[k].faces[i].normal) | (a->rotation ? TL_FIX_ROTATION : 0u);
    }
    return held;
}

/* In what components the blocks are let go: across their faces or, if they are held in all, in all. What the same call
 * holds by rollers stays. */
static void plan_release(lua_State *L, tl_model *model, const tl_boundary_action *actions,
                         const tl_boundary_result *found, size_t count, tl_lua_quiet *plan)
{
    plan->what = lua_newuserdatauv(L, plan->face_count + 1, 0);
    memset(plan->what, 0, plan->face_count);
    tl_lua_ok(L, model, tl_blocks_release(model, plan->block, plan->face_count, plan->what)); /* none is driven */
    const double *fixed = numbers_of(L, model, plan->block, plan->face_count, "fixed", 1);
    for (size_t i = 0; i < plan->face_count; i++) {
        const unsigned held = held_by(L, actions, found, count, plan->block[i]);
        const unsigned all = fixed[i] != 0 ? TL_FIX_ALL : axis_of(plan->faces[i].normal);
        plan->what[i] = (uint8_t)(all & ~held);
    }
}

/* ---------------------------------------------------------------- what was cut off ------- */

/* The parameter of a law by its name; NaN: it has none that is a number. */
static double number_of(const tl_plugin_setting *law, const char *name)
{
    for (uint32_t k = 0; k < law->kind->param_count; k++) {
        const tl_param *p = &law->kind->params[k];
        double value;
        if (strcmp(p->name, name) != 0 || p->type != TL_PARAM_REAL)
            continue;
        memcpy(&value, (const char *)law->params + p->offset, sizeof value);
        return value;
    }
    return NAN;
}

/* The law of a joint, or that which rules it; false: there is none. */
static bool find_law(tl_model *model, const char *joint, tl_plugin_setting *law)
{
    const char *name, *ruled_by = joint;
    for (size_t i = 0; tl_model_joint_at(model, i, &name, &ruled_by); i++)
        if (strcmp(name, joint) == 0)
            break;
        else
            ruled_by = joint;
    char wanted[256];
    tl_text_print(wanted, sizeof wanted, "%s", ruled_by ? ruled_by : joint);
    for (size_t i = 0; tl_model_law_at(model, i, &name, law); i++)
        if (strcmp(name, wanted) == 0 && !tl_law_names_blocks(model, i))
            return true;
    return false;
}

/* Puts kn and ks of a joint's law into the table at the top. */
static void put_stiffness(lua_State *L, tl_model *model, const char *joint)
{
    tl_plugin_setting law;
    if (!find_law(model, joint, &law))
        tl_lua_fail(L,
                    "boundary: joint '%s' has no law to take the stiffness of what was cut off from: give it one with "
                    "model:joint, name another joint, or give p_velocity and s_velocity",
                    joint);
    const double kn = number_of(&law, "kn"), ks = number_of(&law, "ks");
    if (!(kn > 0 && ks > 0))
        tl_lua_fail(L,
                    "boundary: law '%s' of joint '%s' has no kn and ks above 0 to take the stiffness of what was cut "
                    "off from: name another joint, or give p_velocity and s_velocity",
                    law.kind->name, joint);
    tl_lua_set_number(L, "kn", kn);
    tl_lua_set_number(L, "ks", ks);
}

static double option(lua_State *L, int table, const char *key)
{
    const double value = tl_lua_option(L, table, key) == LUA_TNIL ? NAN : lua_tonumber(L, -1);
    lua_pop(L, 1);
    return value;
}

static void put_rock(lua_State *L, tl_model *model, int table)
{
    const double p = option(L, table, "p_velocity"), s = option(L, table, "s_velocity");
    const bool named = tl_lua_option(L, table, "joint") != LUA_TNIL;
    const char *joint = named ? lua_tostring(L, -1) : "*";
    lua_insert(L, -2); /* below the table that is filled */
    if (isnan(p) != isnan(s) || (named && !isnan(p)))
        tl_lua_fail(L, "boundary: what was cut off is given by joint, or by both p_velocity and s_velocity");
    if (isnan(p))
        put_stiffness(L, model, joint);
    else {
        tl_lua_set_number(L, "p_velocity", p);
        tl_lua_set_number(L, "s_velocity", s);
    }
}

/* ---------------------------------------------------------------- faces and waves -------- */

static void add_number(luaL_Buffer *text, double number)
{
    char digits[TL_LUA_NUMBER];
    luaL_addstring(text, tl_lua_number_text(number, 6, digits));
    luaL_addchar(text, ' ');
}

static void put_faces(lua_State *L, tl_model *model, int table, const tl_lua_quiet *plan)
{
    const int to = lua_gettop(L);
    const double given = option(L, table, "density");
    const double *centroid = numbers_of(L, model, plan->block, plan->face_count, "centroid", 3);
    const double *density = numbers_of(L, model, plan->block, plan->face_count, "density", 1);
    luaL_Buffer text;
    luaL_buffinit(L, &text);
    for (size_t i = 0; i < plan->face_count; i++) {
        const tl_boundary_face *f = &plan->faces[i];
        const tl_vec3 c = {centroid[3 * i], centroid[3 * i + 1], centroid[3 * i + 2]};
        add_number(&text, f->block);
        add_number(&text, f->face);
        add_number(&text, f->area);
        add_number(&text, 2 * tl_v3_dot(f->normal, tl_v3_sub(f->centroid, c)));
        add_number(&text, isnan(given) ? density[i] : given);
    }
    luaL_pushresult(&text);
    lua_setfield(L, to, "faces");
    lua_pushvalue(L, to);
}

/* Puts the waves that come in into the table at the top. */
static void put_waves(lua_State *L, tl_model *model, int table)
{
    static const char *const names[] = {"input_x", "input_y", "input_z"};
    const int to = lua_gettop(L);
    const tl_record *records[3] = {NULL, NULL, NULL};
    tl_vec3 constant = {0, 0, 0};
    if (tl_lua_option(L, table, "input") == LUA_TNIL) {
        lua_pop(L, 1);
        return;
    }
    if (!tl_lua_record_velocity(L, records, &constant) || tl_v3_norm2(constant) > 0)
        tl_lua_fail(L, "boundary: input must be {x, y, z}, each a talus.record or 0, and one of them a record");
    const tl_plugin_setting damping = tl_model_damping_now(model);
    if (damping.kind && strcmp(damping.kind->name, "local") == 0)
        tl_lua_fail(L, "boundary: a wave comes in under damping 'local', which takes out vibrations of all "
                       "frequencies: use \"rayleigh\", \"dashpot\" or \"none\"");
    for (int k = 0; k < 3; k++) {
        if (!records[k])
            continue;
        luaL_Buffer text;
        luaL_buffinit(L, &text);
        add_number(&text, tl_model_time(model));
        add_number(&text, tl_record_dt(records[k]));
        for (size_t i = 0; i < tl_record_count(records[k]); i++) {
            const double t = (double)i * tl_record_dt(records[k]);
            add_number(&text, tl_record_displacement(records[k], t));
            add_number(&text, tl_record_velocity(records[k], t));
        }
        luaL_pushresult(&text);
        lua_setfield(L, to, names[k]);
    }
    lua_pushvalue(L, to);
}

/* ---------------------------------------------------------------- the call --------------- */

static bool holds(const tl_boundary_action *a)
{
    return a->fixed || a->roller || a->drive;
}

bool tl_lua_quiet_plan(lua_State *L, tl_model *model, const char *side, const tl_boundary_action *actions,
                       const tl_boundary_result *found, size_t count, size_t which, tl_lua_quiet *plan)
{
    if (!actions[which].quiet)
        return false;
    if (holds(&actions[which]))
        tl_lua_fail(L, "boundary: a quiet face moves, so it cannot be held as well: give quiet without fixed, roller "
                       "and velocity");
    luaL_checkstack(L, 20, "too many sides");
    *plan = (tl_lua_quiet){.faces = found[which].faces, .face_count = found[which].face_count};
    plan->block = lua_newuserdatauv(L, (plan->face_count + 1) * sizeof *plan->block, 0);
    for (size_t i = 0; i < plan->face_count; i++)
        plan->block[i] = plan->faces[i].block;
    if (side)
        lua_getfield(L, 2, side);
    else
        lua_pushvalue(L, 2);
    const int table = lua_gettop(L);
    const bool rigid = are_rigid(L, model, plan);
    const bool input = tl_lua_option(L, table, "input") != LUA_TNIL;
    if (!rigid && input)
        tl_lua_fail(L,
                    "boundary: waves come in through quiet faces of rigid blocks, and block %d is deformable: let "
                    "them in through a row of rigid blocks",
                    (int)plan->block[0]);
    if (!rigid)
        return false;
    plan_release(L, model, actions, found, count, plan);
    lua_newtable(L);
    put_rock(L, model, table);
    put_faces(L, model, table, plan);
    put_waves(L, model, table);
    tl_lua_args(L, lua_gettop(L), "boundary", NULL, &plan->args);
    tl_vec3 *places;
    size_t nodes;
    tl_lua_ok(L, model, tl_model_element_places(model, KIND, &plan->args, 1, &places, &nodes));
    free(places);
    return true;
}

/* Whether a face is among those of a plan, which go by ascending blocks and faces. */
static bool is_planned(const tl_lua_quiet *plan, tl_id block, double face)
{
    size_t low = 0, high = plan->face_count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        const tl_boundary_face *f = &plan->faces[middle];
        if (f->block == block && f->face + 1 == face)
            return true;
        if (f->block < block || (f->block == block && f->face + 1 < face))
            low = middle + 1;
        else
            high = middle;
    }
    return false;
}

/* Takes away what earlier calls have placed on the faces. */
static tl_status give_way(tl_model *model, const tl_lua_quiet *plan)
{
    const tl_element_filter filter = {.size = sizeof filter, .kind = KIND};
    tl_id *ids = NULL;
    size_t count = 0, gone = 0;
    tl_status status = tl_elements_select(model, &filter, &ids, &count);
    for (size_t i = 0; i < count && status == TL_OK; i++) {
        tl_element_node_info node;
        double face = 0;
        status = tl_element_node_get(model, ids[i], 0, &node);
        if (status == TL_OK)
            status = tl_element_value(model, ids[i], SIZE_MAX, "face", &face);
        if (status == TL_OK && is_planned(plan, node.block, face))
            ids[gone++] = ids[i];
    }
    if (status == TL_OK)
        status = tl_elements_delete(model, ids, gone);
    free(ids);
    return status;
}

void tl_lua_quiet_place(lua_State *L, tl_model *model, const tl_lua_quiet *plan)
{
    tl_status status = give_way(model, plan);
    if (status == TL_OK)
        status = tl_model_element(model, KIND, &plan->args, 1, KIND, NULL, NULL);
    if (status == TL_OK)
        status = tl_blocks_release(model, plan->block, plan->face_count, plan->what);
    tl_lua_ok(L, model, status);
}
