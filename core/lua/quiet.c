/* quiet.c - quiet faces of rigid blocks and free fields: what model:boundary makes of the faces that it has found.
 *
 * Elements of the kind "quiet" get the block, face, area, height across the face and density of each. They get the
 * stiffness of a joint's law, or the velocities of waves. A wave that comes in is given by displacements and velocities
 * at the samples of its record. Those of the kind "free_field" get the same of the faces
 * of a side, and what stays held of each block. The base of the call and the model's damping are theirs, too. */
#include "lua/quiet.h"

#include "lua/convert.h"
#include "lua/element.h"
#include "lua/fail.h"
#include "lua/incoming.h"
#include "lua/living.h"
#include "lua/record.h"
#include "lua/wave_checks.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/elements.h>
#include <talus/fields.h>
#include <talus/settings.h>
#include <talus/vmath.h>

#define QUIET "quiet"
#define FREE_FIELD "free_field"
#define INCOMING "incoming"
/* Tolerance: least component of the normal of a face along an axis for the face to look along it. */
#define ALONG 0.99995
/* Tolerance: sine of the dip of a bed that counts as level at a free field. Test: lua/test_free_field. */
#define LEVEL 1e-3

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

/* Components in which the same call holds a block: by rollers, or all of them. */
static unsigned held_by(const tl_lua_sides *sides, tl_id block)
{
    unsigned held = 0;
    for (size_t k = 0; k < sides->count; k++) {
        const tl_boundary_action *a = &sides->actions[k];
        const tl_boundary_result *found = &sides->found[k];
        size_t i = a->fixed || a->drive || a->roller ? first_of(found, block) : found->face_count;
        if (i < found->face_count && (a->fixed || a->drive))
            return TL_FIX_ALL;
        for (; i < found->face_count && found->faces[i].block == block; i++)
            held |= axis_of(found->faces[i].normal) | (a->rotation ? TL_FIX_ROTATION : 0u);
    }
    return held;
}

/* Whether a block of the side that is held whole was so by rollers of several sides: where free fields meet the side,
 * and other blocks of it are not held whole. */
static bool are_corners(const tl_lua_sides *sides, const tl_lua_quiet *plan, const double *fixed)
{
    bool free_field = false, other = false;
    for (size_t k = 0; k < sides->count; k++)
        free_field = free_field || sides->free_field[k];
    for (size_t i = 0; i < plan->face_count; i++)
        other = other || fixed[i] == 0;
    return free_field && other;
}

/* In what components the blocks are let go: across their faces or, if they are held in all, in all. What the same call
 * holds by rollers stays. */
static void plan_release(lua_State *L, tl_model *model, const tl_lua_sides *sides, tl_lua_quiet *plan)
{
    tl_lua_ok(L, model, tl_blocks_release(model, plan->block, plan->face_count, plan->what)); /* none is driven */
    const double *fixed = numbers_of(L, model, plan->block, plan->face_count, "fixed", 1);
    const bool corners = are_corners(sides, plan, fixed);
    for (size_t i = 0; i < plan->face_count; i++) {
        const unsigned held = held_by(sides, plan->block[i]);
        const unsigned all = fixed[i] != 0 && !corners ? TL_FIX_ALL : axis_of(plan->faces[i].normal);
        if (held == TL_FIX_ALL)
            tl_lua_fail(L,
                        "boundary: block %d has a quiet face, and the same call holds it whole: a quiet face moves, so "
                        "give such blocks rollers, or leave them out by a box",
                        (int)plan->block[i]);
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

/* Puts a number into the table at the top, by the key prefix .. name. */
static void put_number(lua_State *L, const char *prefix, const char *name, double number)
{
    lua_pushfstring(L, "%s%s", prefix, name);
    lua_pushnumber(L, number);
    lua_rawset(L, -3);
}

/* Puts kn and ks of a joint's law into the table at the top. */
static void put_stiffness(lua_State *L, tl_model *model, const char *joint, const char *prefix)
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
    put_number(L, prefix, "kn", kn);
    put_number(L, prefix, "ks", ks);
}

static double option(lua_State *L, int table, const char *key)
{
    const double value = tl_lua_option(L, table, key) == LUA_TNIL ? NAN : lua_tonumber(L, -1);
    lua_pop(L, 1);
    return value;
}

/* Puts the stiffness of what was cut off into the table at the top, its keys with a prefix. `table`: the options on the
 * stack, or 0. */
static void put_rock(lua_State *L, tl_model *model, int table, const char *prefix)
{
    const double p = table ? option(L, table, "p_velocity") : NAN, s = table ? option(L, table, "s_velocity") : NAN;
    const bool named = table && tl_lua_option(L, table, "joint") != LUA_TNIL;
    const char *joint = named ? lua_tostring(L, -1) : "*";
    if (table)
        lua_insert(L, -2); /* below the table that is filled */
    if (isnan(p) != isnan(s) || (named && !isnan(p)))
        tl_lua_fail(L, "boundary: what was cut off is given by joint, or by both p_velocity and s_velocity");
    if (isnan(p))
        put_stiffness(L, model, joint, prefix);
    else {
        put_number(L, prefix, "p_velocity", p);
        put_number(L, prefix, "s_velocity", s);
    }
}

/* ---------------------------------------------------------------- faces and waves -------- */

static void add_number(luaL_Buffer *text, double number)
{
    char digits[TL_LUA_NUMBER];
    luaL_addstring(text, tl_lua_number_text(number, 6, digits));
    luaL_addchar(text, ' ');
}

/* Puts a list of the faces into the table at the top, with the components that stay held of each if `held` is given. */
static void put_faces(lua_State *L, tl_model *model, const tl_lua_quiet *plan, const unsigned *held)
{
    const int to = lua_gettop(L);
    const double given = plan->table ? option(L, plan->table, "density") : NAN;
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
        if (held)
            add_number(&text, held[i]);
    }
    luaL_pushresult(&text);
    lua_setfield(L, to, "faces");
    lua_pushvalue(L, to);
}

bool tl_lua_damps_all(const char *name)
{
    return strcmp(name, "local") == 0 || strcmp(name, "combined") == 0;
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
    if (damping.kind && tl_lua_damps_all(damping.kind->name))
        tl_lua_fail(L,
                    "boundary: a wave comes in under damping '%s', which takes out vibrations of all frequencies: use "
                    "\"rayleigh\", \"dashpot\" or \"none\"",
                    damping.kind->name);
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

/* Begins a plan of an action. Pushes its lists and its table of options. */
static tl_lua_quiet begin_plan(lua_State *L, const tl_lua_sides *sides, size_t which, const char *kind)
{
    const tl_boundary_result *found = &sides->found[which];
    tl_lua_quiet plan = {.kind = kind, .faces = found->faces, .face_count = found->face_count};
    luaL_checkstack(L, 30, "too many sides");
    plan.block = lua_newuserdatauv(L, (plan.face_count + 1) * sizeof *plan.block, 0);
    for (size_t i = 0; i < plan.face_count; i++)
        plan.block[i] = plan.faces[i].block;
    plan.what = lua_newuserdatauv(L, plan.face_count + 1, 0);
    memset(plan.what, 0, plan.face_count + 1);
    if (sides->keyed)
        lua_getfield(L, 2, tl_side_names()[sides->actions[which].where.side - TL_SIDE_XMIN]);
    else
        lua_pushvalue(L, 2);
    plan.table = lua_istable(L, -1) ? lua_gettop(L) : 0;
    return plan;
}

/* Reads the options at the top into a plan, and tries them. */
static void end_plan(lua_State *L, tl_model *model, tl_lua_quiet *plan)
{
    tl_vec3 *places;
    size_t nodes;
    tl_lua_args(L, lua_gettop(L), "boundary", NULL, &plan->args);
    tl_lua_ok(L, model, tl_model_element_places(model, plan->kind, &plan->args, 1, &places, &nodes));
    free(places);
}

/* Waves that come in through quiet faces of deformable blocks, whose dashpots the kernel has. */
static void plan_incoming(lua_State *L, tl_model *model, tl_lua_quiet *plan)
{
    const bool input = tl_lua_option(L, plan->table, "input") != LUA_TNIL;
    lua_pop(L, 1);
    plan->kind = input ? INCOMING : NULL;
    if (!input)
        return;
    lua_newtable(L);
    put_waves(L, model, plan->table);
    tl_lua_incoming_put(L, model, plan->faces, plan->face_count);
    end_plan(L, model, plan);
}

/* false: the kernel makes the dashpots of faces of deformable blocks. */
static bool plan_quiet(lua_State *L, tl_model *model, const tl_lua_sides *sides, size_t which, tl_lua_quiet *plan)
{
    const tl_boundary_action *a = &sides->actions[which];
    if (a->fixed || a->roller || a->drive)
        tl_lua_fail(L, "boundary: a quiet face moves, so it cannot be held as well: give quiet without fixed, roller "
                       "and velocity");
    *plan = begin_plan(L, sides, which, QUIET);
    if (!are_rigid(L, model, plan)) {
        plan_incoming(L, model, plan);
        return false;
    }
    plan_release(L, model, sides, plan);
    lua_newtable(L);
    put_rock(L, model, plan->table, "");
    put_faces(L, model, plan, NULL);
    put_waves(L, model, plan->table);
    end_plan(L, model, plan);
    return true;
}

/* ---------------------------------------------------------------- free fields ------------ */

/* Damping of the model by mass, 1/s, and by the stiffness of contacts, s, as far as it is one for all. */
static void damping_of(const tl_model *model, double *alpha, double *beta)
{
    const tl_plugin_setting d = tl_model_damping_now(model);
    const char *name = d.kind ? d.kind->name : "none";
    *alpha = *beta = 0;
    if (strcmp(name, "rayleigh") == 0) {
        const double ratio = number_of(&d, "ratio"), from = number_of(&d, "from"), to = number_of(&d, "to");
        *alpha = 4 * TL_PI * ratio * from * to / (from + to);
        *beta = ratio / (TL_PI * (from + to));
    } else if (strcmp(name, "dashpot") == 0)
        *beta = number_of(&d, "ratio") / (TL_PI * number_of(&d, "frequency"));
    else if (strcmp(name, "viscous") == 0)
        *alpha = number_of(&d, "alpha");
}

/* Components of each block that stay held in the call. Those are let go across the side that are not held whole. */
static unsigned *plan_held(lua_State *L, tl_model *model, const tl_lua_sides *sides, const tl_lua_quiet *quiet,
                           size_t quiets, tl_lua_quiet *plan)
{
    const double *held = numbers_of(L, model, plan->block, plan->face_count, "held", 1);
    unsigned *stays = lua_newuserdatauv(L, (plan->face_count + 1) * sizeof *stays, 0);
    for (size_t i = 0; i < plan->face_count; i++) {
        const tl_id block = plan->block[i];
        unsigned now = (unsigned)held[i];
        for (size_t k = 0; k < quiets; k++)
            for (size_t j = 0; j < quiet[k].face_count; j++)
                now &= quiet[k].block[j] == block ? ~(unsigned)quiet[k].what[j] : TL_FIX_ALL;
        const unsigned by = held_by(sides, block);
        const unsigned across = now == TL_FIX_ALL || by == TL_FIX_ALL ? 0 : axis_of(plan->faces[i].normal);
        plan->what[i] = (uint8_t)(across & ~by);
        stays[i] = (now | by) & ~(unsigned)plan->what[i];
    }
    return stays;
}

/* The normal of the face that has the edge between two corners from the other side, or NULL. */
static const tl_vec3 *normal_beside(const tl_block_mesh *mesh, uint32_t from, uint32_t to)
{
    for (size_t f = 0; f < mesh->face_count; f++) {
        const uint32_t *corner = mesh->loops + mesh->start[f], count = mesh->start[f + 1] - mesh->start[f];
        for (uint32_t k = 0; k < count; k++)
            if (corner[k] == to && corner[(k + 1) % count] == from)
                return &mesh->normals[f];
    }
    return NULL;
}

/* Dip of the top or foot of a block that begins at a level edge of its side, in degrees; 0: both are level. Edges above
 * `ground` are left out. */
static double dip_of(const tl_block_mesh *mesh, uint32_t side, double ground)
{
    const uint32_t *corner = mesh->loops + mesh->start[side], count = mesh->start[side + 1] - mesh->start[side];
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t from = corner[k], to = corner[(k + 1) % count];
        const tl_vec3 edge = tl_v3_sub(mesh->vertices[to], mesh->vertices[from]);
        const tl_vec3 *n = normal_beside(mesh, from, to);
        const bool is_level = edge.z * edge.z <= LEVEL * LEVEL * tl_v3_norm2(edge);
        if (n && is_level && mesh->vertices[from].z <= ground && n->x * n->x + n->y * n->y > LEVEL * LEVEL)
            return tl_atan2(sqrt(n->x * n->x + n->y * n->y), fabs(n->z)) * (180 / TL_PI);
    }
    return 0;
}

/* Refuses beds that dip from the side into the model, for those of the column beside are level. The ground may slope:
 * that is what lies above the middle of the highest face. */
static void look_at_beds(lua_State *L, tl_model *model, const tl_lua_quiet *plan)
{
    double ground = -INFINITY;
    for (size_t i = 0; i < plan->face_count; i++)
        ground = fmax(ground, plan->faces[i].centroid.z);
    for (size_t i = 0; i < plan->face_count; i++) {
        tl_block_mesh mesh;
        tl_lua_ok(L, model, tl_block_mesh_get(model, plan->block[i], &mesh));
        const double dip = dip_of(&mesh, plan->faces[i].face, ground);
        tl_block_mesh_free(&mesh);
        char degrees[32];
        tl_text_print(degrees, sizeof degrees, "%.3g", dip);
        if (dip > 0)
            tl_lua_fail(
                L,
                "boundary: the top or the foot of block %d dips by %s degrees from the side into the model, and "
                "the beds of the free field beside are level: let beds be level at the side, or make it quiet",
                (int)plan->block[i], degrees);
    }
}

/* The quiet base of the call, or NULL. */
static const tl_lua_quiet *base_of(const tl_lua_sides *sides, const tl_lua_quiet *quiet, size_t quiets)
{
    for (size_t k = 0; k < sides->count; k++)
        for (size_t i = 0; i < quiets && sides->actions[k].where.side == TL_SIDE_ZMIN; i++)
            if (quiet[i].faces == sides->found[k].faces && quiet[i].kind && strcmp(quiet[i].kind, QUIET) == 0)
                return &quiet[i];
    return NULL;
}

static void plan_free_field(lua_State *L, tl_model *model, const tl_lua_sides *sides, size_t which,
                            const tl_lua_quiet *quiet, size_t quiets, tl_lua_quiet *plan)
{
    if (sides->actions[which].drive)
        tl_lua_fail(L, "boundary: a free field moves with its base: give it no velocity");
    *plan = begin_plan(L, sides, which, FREE_FIELD);
    if (!are_rigid(L, model, plan))
        tl_lua_fail(L, "boundary: free fields are at sides of rigid blocks, and block %d is deformable",
                    (int)plan->block[0]);
    const tl_lua_quiet *base = base_of(sides, quiet, quiets);
    const unsigned *held = plan_held(L, model, sides, quiet, quiets, plan);
    lua_newtable(L);
    put_rock(L, model, plan->table, "");
    put_faces(L, model, plan, held);
    if (base) {
        const double density = option(L, base->table, "density");
        put_rock(L, model, base->table, "base_");
        if (!isnan(density))
            tl_lua_set_number(L, "base_density", density);
        put_waves(L, model, base->table);
    }
    double alpha, beta;
    damping_of(model, &alpha, &beta);
    tl_lua_set_number(L, "alpha", alpha);
    tl_lua_set_number(L, "beta", beta);
    end_plan(L, model, plan);
    look_at_beds(L, model, plan);
}

const tl_lua_selection *tl_lua_free_fields(lua_State *L, tl_model *model)
{
    return tl_lua_elements_push(L, model, &(tl_element_filter){.size = sizeof(tl_element_filter), .kind = FREE_FIELD});
}

void tl_lua_free_field_damp(lua_State *L, tl_model *model, const tl_lua_selection *fields)
{
    double alpha, beta;
    if (fields->count == 0)
        return;
    damping_of(model, &alpha, &beta);
    const tl_value values[] = {tl_arg_number("alpha", alpha), tl_arg_number("beta", beta)};
    const tl_args args = {values, 2};
    tl_lua_ok(L, model, tl_elements_set(model, fields->names, fields->count, &args));
}

/* ---------------------------------------------------------------- plans ------------------ */

static bool are_there(lua_State *L, tl_model *model, const char *kind)
{
    const tl_element_filter filter = {.size = sizeof filter, .kind = kind};
    tl_id *ids = NULL;
    size_t count = 0;
    tl_lua_ok(L, model, tl_elements_select(model, &filter, &ids, &count));
    free(ids);
    return count > 0;
}

size_t tl_lua_quiet_plan(lua_State *L, tl_model *model, const tl_lua_sides *sides, tl_lua_quiet *plans, bool *planned)
{
    size_t count = 0;
    const bool incoming = are_there(L, model, INCOMING);
    for (size_t i = 0; i < sides->count; i++) {
        const tl_boundary_action *a = &sides->actions[i];
        const bool other = incoming && !sides->add && (a->loads || a->fixed || a->roller || a->drive);
        planned[i] = a->quiet && plan_quiet(L, model, sides, i, &plans[count]);
        if (other && !a->quiet)
            plans[count] = begin_plan(L, sides, i, NULL);
        count += a->quiet || other;
    }
    const size_t quiets = count;
    for (size_t i = 0; i < sides->count; i++)
        if (sides->free_field[i]) {
            plan_free_field(L, model, sides, i, plans, quiets, &plans[count++]);
            planned[i] = true;
        }
    return count;
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

/* Whether a face of a block that looks along n is among those of a plan. */
static bool is_planned_side(const tl_lua_quiet *plan, tl_id block, tl_vec3 n)
{
    for (size_t i = 0; i < plan->face_count; i++)
        if (plan->block[i] == block && tl_v3_dot(plan->faces[i].normal, n) > ALONG)
            return true;
    return false;
}

/* Whether an element lies on a face of a plan. */
static bool is_in_the_way(tl_model *model, tl_id element, const tl_lua_quiet *plan, tl_status *status)
{
    tl_element_info info;
    *status = tl_element_get(model, element, &info);
    const bool one_face = *status == TL_OK && strcmp(info.kind->name, FREE_FIELD) != 0;
    double face = 0;
    tl_vec3 n = {0, 0, 0};
    if (one_face)
        *status = tl_element_value(model, element, SIZE_MAX, "face", &face);
    else if (*status == TL_OK && (*status = tl_element_value(model, element, SIZE_MAX, "normal_x", &n.x)) == TL_OK)
        *status = tl_element_value(model, element, SIZE_MAX, "normal_y", &n.y);
    for (size_t k = 0; *status == TL_OK && k < info.nodes; k++) {
        tl_element_node_info node;
        *status = tl_element_node_get(model, element, k, &node);
        if (*status == TL_OK && node.block &&
            (one_face ? is_planned(plan, node.block, face) : is_planned_side(plan, node.block, n)))
            return true;
    }
    return false;
}

/* Takes away what earlier calls have placed on the faces. */
static tl_status give_way(tl_model *model, const tl_lua_quiet *plan, const char *kind)
{
    const tl_element_filter filter = {.size = sizeof filter, .kind = kind};
    tl_id *ids = NULL;
    size_t count = 0, gone = 0;
    tl_status status = tl_elements_select(model, &filter, &ids, &count);
    for (size_t i = 0; i < count && status == TL_OK; i++)
        if (is_in_the_way(model, ids[i], plan, &status))
            ids[gone++] = ids[i];
    if (status == TL_OK)
        status = tl_elements_delete(model, ids, gone);
    free(ids);
    return status;
}

/* Velocities of waves in what was cut off behind the faces. */
static tl_lua_wave_face *wave_faces(lua_State *L, tl_model *model, const tl_lua_quiet *plan)
{
    const double given = option(L, plan->table, "density"), p = option(L, plan->table, "p_velocity");
    const double s = option(L, plan->table, "s_velocity");
    const double *centroid = numbers_of(L, model, plan->block, plan->face_count, "centroid", 3);
    const double *density = numbers_of(L, model, plan->block, plan->face_count, "density", 1);
    tl_lua_wave_face *faces = lua_newuserdatauv(L, (plan->face_count + 1) * sizeof *faces, 0);
    double kn = NAN, ks = NAN;
    if (isnan(p)) {
        lua_newtable(L);
        put_rock(L, model, plan->table, "");
        kn = option(L, lua_gettop(L), "kn");
        ks = option(L, lua_gettop(L), "ks");
    }
    for (size_t i = 0; i < plan->face_count; i++) {
        const tl_boundary_face *f = &plan->faces[i];
        const tl_vec3 c = {centroid[3 * i], centroid[3 * i + 1], centroid[3 * i + 2]};
        const double height = 2 * tl_v3_dot(f->normal, tl_v3_sub(f->centroid, c));
        const double per = height / (isnan(given) ? density[i] : given);
        faces[i] = (tl_lua_wave_face){plan->block[i], height, isnan(p) ? sqrt(kn * per) : p,
                                      isnan(p) ? sqrt(ks * per) : s, f->normal};
    }
    return faces;
}

/* Remarks on waves that cannot come in as they are. */
static void look_at_waves(lua_State *L, tl_model *model, const tl_lua_quiet *plan)
{
    const tl_record *records[3] = {NULL, NULL, NULL};
    tl_vec3 constant = {0, 0, 0};
    const int top = lua_gettop(L);
    const bool input = plan->table && plan->kind && tl_lua_option(L, plan->table, "input") != LUA_TNIL;
    if (input && tl_lua_record_velocity(L, records, &constant)) {
        tl_lua_waves_step(L, model, records);
        if (strcmp(plan->kind, QUIET) == 0)
            tl_lua_waves_blocks(L, records, wave_faces(L, model, plan), plan->face_count);
    }
    lua_settop(L, top);
}

void tl_lua_quiet_place(lua_State *L, tl_model *model, const tl_lua_quiet *plan)
{
    tl_status status = plan->kind ? give_way(model, plan, QUIET) : TL_OK;
    if (status == TL_OK && plan->kind)
        status = give_way(model, plan, FREE_FIELD);
    if (status == TL_OK)
        status = give_way(model, plan, INCOMING);
    if (status == TL_OK && plan->kind)
        status = tl_model_element(model, plan->kind, &plan->args, 1, plan->kind, NULL, NULL);
    size_t count = 0;
    for (size_t i = 0; i < plan->face_count; i++)
        if (plan->what[i]) {
            plan->block[count] = plan->block[i];
            plan->what[count++] = plan->what[i];
        }
    if (status == TL_OK)
        status = tl_blocks_release(model, plan->block, count, plan->what);
    tl_lua_ok(L, model, status);
    look_at_waves(L, model, plan);
}
