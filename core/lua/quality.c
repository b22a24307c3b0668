/* quality.c - what cutting made and what may fall: talus.report(model), model:filter{...} and model:keyblocks{...}. */
#include "lua/quality.h"

#include "lua/block.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/item.h"
#include "lua/living.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <talus/zones.h>

/* The block that controls the step and, by zones, its gridpoint. */
static void name_controlling(tl_model *model, const tl_timestep_report *r, char *text, size_t size)
{
    tl_zone_name point;
    if (r->by == TL_STEP_BY_ZONES && tl_model_timestep_gridpoint(model, &point) == TL_OK && point.body != TL_NO_ID)
        tl_text_print(text, size, "gridpoint %u of block %u", point.number, point.body);
    else
        tl_text_print(text, size, "block %u", r->block);
}

void tl_lua_push_timestep(lua_State *L, tl_model *model, const tl_timestep_report *r)
{
    char numbers[120], name[64];
    tl_text_print(numbers, sizeof numbers, "dt = %.4g s, mass %.4g kg, stiffness %.4g N/m", r->dt, r->mass,
                  r->stiffness);
    if (r->by == TL_STEP_BY_SPEED)
        tl_text_print(numbers, sizeof numbers, "dt = %.4g s", r->dt);
    if (r->block == TL_NO_ID) {
        lua_pushnumber(L, r->dt);
        tl_lua_push_number_text(L, -1);
        lua_pushfstring(L, "no block controls the step: dt = %s s", lua_tostring(L, -1));
        lua_insert(L, -3);
        lua_pop(L, 2);
    } else if (r->partner == TL_NO_ID) {
        static const char *const how[] = {"", " by turning", " by the speed at which it moves", ""};
        name_controlling(model, r, name, sizeof name);
        lua_pushfstring(L, "%s controls the step%s: %s", name, how[r->by], numbers);
    } else {
        lua_pushfstring(L, "block %I controls the step, with the stiffest contact at block %I: %s",
                        (lua_Integer)r->block, (lua_Integer)r->partner, numbers);
    }
}

/* ---------------------------------------------------------------- report ----------------- */

typedef struct extreme_name {
    const char *field, *block_field, *label, *unit;
    size_t offset;
} extreme_name;

static const extreme_name extremes[] = {
    {"smallest_volume", "smallest_volume_block", "smallest volume", " m3", offsetof(tl_quality, smallest_volume)},
    {"smallest_edge", "smallest_edge_block", "smallest edge", " m", offsetof(tl_quality, smallest_edge)},
    {"smallest_face", "smallest_face_block", "smallest face", " m2", offsetof(tl_quality, smallest_face)},
    {"worst_aspect", "worst_aspect_block", "worst aspect", "", offsetof(tl_quality, worst_aspect)},
};

enum { EXTREMES = sizeof extremes / sizeof *extremes };

static tl_extreme extreme_of(const tl_quality *q, const extreme_name *name)
{
    return *(const tl_extreme *)(const void *)((const char *)q + name->offset);
}

/* Pushes the sentence about a refused cut. */
static void push_reason(lua_State *L, tl_model *model, const tl_refused_cut *cut)
{
    char text[240];
    const char *joint = tl_tag_name(model, cut->joint);
    tl_text_print(
        text, sizeof text, "%s%s%s does not cut block %u: a side would be %.3g m thick, less than the limit of %.3g m",
        *joint ? "joint '" : "a plane without joint", joint, *joint ? "'" : "", cut->block, cut->thickness, cut->limit);
    lua_pushstring(L, text);
}

static void set_refused_cuts(lua_State *L, tl_model *model, const tl_quality *q)
{
    lua_createtable(L, (int)q->refused_listed, 0);
    for (size_t i = 0; i < q->refused_listed; i++) {
        const tl_refused_cut *cut = &q->refused_cuts[i];
        lua_createtable(L, 0, 7);
        tl_lua_set_text(L, "joint", tl_tag_name(model, cut->joint));
        /* A number: the block may be cut or deleted since. */
        tl_lua_set_count(L, "block", cut->block);
        tl_lua_set_vec3(L, "normal", cut->normal);
        tl_lua_set_vec3(L, "point", cut->point);
        TL_LUA_SET_NUMBERS(L, {"thickness", cut->thickness}, {"limit", cut->limit});
        push_reason(L, model, cut);
        lua_setfield(L, -2, "reason");
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "refused_cuts");
}

static void print_zones(const tl_zone_summary *zones)
{
    char numbers[120];
    if (zones->zones == 0)
        return;
    printf("%-18s%zu in %zu blocks, with %zu gridpoints and %zu segments\n", "zones", zones->zones, zones->blocks,
           zones->gridpoints, zones->segments);
    tl_text_print(numbers, sizeof numbers, "%.4g m", zones->least_altitude);
    printf("%-18s%s, block %u\n", "smallest altitude", numbers, zones->worst);
}

/* The page, from the table of the report at the top of the stack. */
static void print_page(lua_State *L, tl_model *model, const tl_quality *q, const tl_zone_summary *zones)
{
    enum { SHOWN = 5 }; /* refused cuts of the page; the table has them all */
    printf("%-18s%zu in %zu bodies\n", "blocks", q->blocks, q->bodies);
    char numbers[120];
    tl_text_print(numbers, sizeof numbers, "%.10g m3, kept to %.1e", q->volume, q->volume_error);
    printf("%-18s%s\n", "volume", numbers);
    for (size_t i = 0; i < EXTREMES; i++) {
        tl_extreme e = extreme_of(q, &extremes[i]);
        if (e.block == TL_NO_ID)
            continue;
        tl_text_print(numbers, sizeof numbers, "%.4g%s", e.value, extremes[i].unit);
        printf("%-18s%s, block %u\n", extremes[i].label, numbers, e.block);
    }
    print_zones(zones);
    printf("%-18s%zu made, %zu refused, %zu on existing faces\n", "cuts", q->cuts, q->refused, q->coincident);
    for (size_t i = 0; i < q->refused_listed && i < SHOWN; i++) {
        push_reason(L, model, &q->refused_cuts[i]);
        printf("%-18s%s\n", i ? "" : "refused", lua_tostring(L, -1));
        lua_pop(L, 1);
    }
    if (q->refused > SHOWN)
        printf("%-18sand %zu more\n", "", q->refused - SHOWN);
    if (q->slivers) {
        tl_text_print(numbers, sizeof numbers, "%.2g %% of the volume; the others allow %.3g times the step",
                      100 * q->sliver_share, q->sliver_gain);
        printf("%-18s%zu, %s: model:filter{ auto = true } joins them\n", "slivers", q->slivers, numbers);
    }
    lua_getfield(L, -1, "timestep_message");
    printf("%-18s%s\n", "time step", lua_tostring(L, -1));
    lua_pop(L, 1);
}

/* What deformable blocks there are, in the table of the report. */
static void set_zones(lua_State *L, const tl_zone_summary *zones)
{
    TL_LUA_SET_COUNTS(L, {"deformable", zones->blocks}, {"zones", zones->zones}, {"gridpoints", zones->gridpoints},
                      {"clusters", zones->clusters}, {"segments", zones->segments});
    if (zones->zones == 0)
        return;
    tl_lua_set_number(L, "smallest_altitude", zones->least_altitude);
    tl_lua_set_block(L, "smallest_altitude_block", zones->worst);
}

/* Without a law for some contact there is no time step to tell of; the report then says why. */
static void set_timestep(lua_State *L, tl_model *model)
{
    tl_timestep_report step;
    if (tl_model_timestep_report(model, &step) != TL_OK) {
        tl_lua_set_text(L, "timestep_message", tl_model_error(model)->text);
        return;
    }
    tl_lua_set_number(L, "dt", step.dt);
    tl_lua_set_block(L, "timestep_block", step.block);
    tl_lua_push_timestep(L, model, &step);
    lua_setfield(L, -2, "timestep_message");
}

static int module_report(lua_State *L)
{
    tl_lua_arity(L, 1, "talus.report");
    if (!luaL_testudata(L, 1, TL_LUA_MODEL_TYPE))
        return tl_lua_fail(L, "talus.report: give the model, not %s", tl_lua_describe(L, 1));
    tl_model *model = tl_lua_model_of(L, "report");
    tl_quality q;
    tl_lua_ok(L, model, tl_model_quality(model, &q));
    lua_createtable(L, 0, 30);
    TL_LUA_SET_COUNTS(L, {"blocks", q.blocks}, {"bodies", q.bodies}, {"cuts", q.cuts}, {"refused", q.refused},
                      {"coincident", q.coincident}, {"slivers", q.slivers});
    TL_LUA_SET_NUMBERS(L, {"volume", q.volume}, {"volume_error", q.volume_error}, {"sliver_share", q.sliver_share},
                       {"sliver_gain", q.sliver_gain});
    for (size_t i = 0; i < EXTREMES; i++) {
        tl_extreme e = extreme_of(&q, &extremes[i]);
        tl_lua_set_number(L, extremes[i].field, e.value);
        tl_lua_set_block(L, extremes[i].block_field, e.block);
    }
    set_refused_cuts(L, model, &q);
    const tl_zone_summary zones = tl_model_zone_summary(model);
    set_zones(L, &zones);
    set_timestep(L, model);
    if (!tl_lua_options_of(L)->quiet)
        print_page(L, model, &q, &zones);
    return 1;
}

/* ---------------------------------------------------------------- filter ----------------- */

static int free_filter_result(lua_State *L)
{
    free(((tl_filter_result *)lua_touserdata(L, 1))->slivers);
    return 0;
}

/* Each sliver gets a block it is joined to, which the action tells. */
static void push_filter_result(lua_State *L, const tl_filter_result *r)
{
    lua_createtable(L, 0, 6);
    TL_LUA_SET_COUNTS(L, {"found", r->count}, {"deleted", r->deleted}, {"joined", r->joined});
    tl_lua_set_number(L, "volume", r->volume);
    if (!isnan(r->gain))
        tl_lua_set_number(L, "gain", r->gain);
    lua_createtable(L, (int)r->count, 0);
    for (size_t i = 0; i < r->count; i++) {
        const tl_sliver *s = &r->slivers[i];
        lua_createtable(L, 0, 6);
        tl_lua_set_count(L, "block", s->block); /* a number: it may have been deleted */
        TL_LUA_SET_NUMBERS(L, {"volume", s->volume}, {"edge", s->edge}, {"aspect", s->aspect});
        const char *which[] = {s->small ? "volume" : NULL, s->short_edge ? "edge" : NULL, s->thin ? "aspect" : NULL};
        lua_createtable(L, 3, 0);
        for (int k = 0; k < 3; k++)
            if (which[k]) {
                lua_pushstring(L, which[k]);
                lua_rawseti(L, -2, (lua_Integer)lua_rawlen(L, -2) + 1);
            }
        lua_setfield(L, -2, "beyond");
        tl_lua_set_block(L, "joined_to", s->block);
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
    lua_setfield(L, -2, "slivers");
}

/* Writes what the action did into the table at the top of the stack, without needing memory. */
static void set_filtered(lua_State *L, const tl_filter_result *r)
{
    tl_lua_set_count(L, "deleted", r->deleted);
    tl_lua_set_count(L, "joined", r->joined);
    if (!isnan(r->gain))
        tl_lua_set_number(L, "gain", r->gain);
    lua_getfield(L, -1, "slivers");
    for (size_t i = 0; i < r->count; i++) {
        lua_rawgeti(L, -1, (lua_Integer)i + 1);
        tl_lua_item_rename(L, "joined_to", r->slivers[i].joined_to);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

/* First a report, for which there must be memory, and then the action: a call that fails changes nothing. */
static int model_filter(lua_State *L, tl_model *model)
{
    tl_filter limits = tl_filter_default();
    tl_lua_read_function(L, 2, "filter", NULL, &limits);
    if (limits.automatic && lua_getfield(L, 2, "action") == LUA_TNIL)
        limits.action = TL_FILTER_JOIN;
    lua_settop(L, 2);
    tl_filter report = limits;
    report.action = TL_FILTER_REPORT;
    tl_filter_result *found = tl_lua_hold(L, sizeof *found, "talus.filter", free_filter_result);
    tl_filter_result *done = tl_lua_hold(L, sizeof *done, "talus.filter", free_filter_result);
    tl_lua_ok(L, model, tl_model_filter(model, &report, found));
    push_filter_result(L, found);
    tl_lua_ok(L, model, tl_model_filter(model, &limits, done));
    set_filtered(L, done);
    return 1;
}

/* ---------------------------------------------------------------- keyblocks -------------- */

static const tl_lua_key keyblocks_keys[] = {
    {"friction", "number or {JOINT = number}",
     "friction angle of the joints, degrees, in [0, 90): one for all, or by joint: {[\"*\"] = 35, "
     "J1 = 30, [\"J1:3\"] = 25}; the closest name counts"},
    {"cohesion", "number or {JOINT = number}", "cohesion of the joints, Pa, likewise; 0 where none is given"},
    {NULL, NULL, NULL},
};

static tl_joint_strength read_strength(lua_State *L, const char *key, const char *joint)
{
    if (lua_type(L, -1) != LUA_TNUMBER)
        tl_lua_fail(L, "keyblocks: %s of joint '%s' must be a number, not %s", key, joint, tl_lua_describe(L, -1));
    double number = lua_tonumber(L, -1);
    if (!isfinite(number))
        tl_lua_fail(L, "keyblocks: %s of joint '%s' must be finite", key, joint);
    bool friction = key[0] == 'f';
    return (tl_joint_strength){joint, friction ? number : NAN, friction ? NAN : number};
}

/* Reads the entries of the strength `key` of the table at index 2 into the list, if there is one. Returns how many. */
static size_t read_strengths(lua_State *L, const char *key, tl_joint_strength *list)
{
    size_t count = 0;
    int type = lua_getfield(L, 2, key);
    if (type == LUA_TNUMBER) {
        if (list)
            list[0] = read_strength(L, key, "*");
        count = 1;
    } else if (type == LUA_TTABLE) {
        for (lua_pushnil(L); lua_next(L, -2); lua_pop(L, 1), count++) {
            if (!list)
                continue;
            if (lua_type(L, -2) != LUA_TSTRING)
                tl_lua_fail(L, "keyblocks: %s: the joints are named by text, not by %s", key, tl_lua_describe(L, -2));
            list[count] = read_strength(L, key, tl_lua_text(L, -2, "keyblocks", "the name of a joint"));
        }
    } else if (type != LUA_TNIL) {
        tl_lua_fail(L, "keyblocks: %s must be a number or a table {JOINT = number}, not %s", key,
                    tl_lua_describe(L, -1));
    }
    lua_pop(L, 1);
    return count;
}

static void set_faces(lua_State *L, tl_model *model, const tl_keyblock *block)
{
    lua_createtable(L, (int)block->face_count, 0);
    for (size_t k = 0; k < block->face_count; k++) {
        const tl_keyblock_face *face = &block->faces[k];
        lua_createtable(L, 0, 4);
        tl_lua_set_text(L, "joint", tl_tag_name(model, face->joint));
        tl_lua_set_vec3(L, "normal", face->normal);
        TL_LUA_SET_NUMBERS(L, {"area", face->area}, {"normal_force", face->normal_force});
        lua_rawseti(L, -2, (lua_Integer)k + 1);
    }
    lua_setfield(L, -2, "faces");
}

/* Pushes the list of the keyblocks; the model's userdata is at index 1. */
static void push_keyblocks(lua_State *L, tl_model *model, const tl_keyblocks *all)
{
    static const char *const modes[] = {[TL_KEYBLOCK_FALLING] = "falling",
                                        [TL_KEYBLOCK_SLIDING] = "sliding",
                                        [TL_KEYBLOCK_SLIDING_ON_TWO] = "sliding on two",
                                        [TL_KEYBLOCK_STABLE] = "stable"};
    lua_createtable(L, (int)all->count, 0);
    for (size_t i = 0; i < all->count; i++) {
        const tl_keyblock *block = &all->blocks[i];
        lua_createtable(L, 0, 12);
        tl_lua_set_block(L, "block", block->block);
        tl_lua_set_text(L, "mode", modes[block->mode]);
        TL_LUA_SET_NUMBERS(L, {"safety", block->safety}, {"volume", block->volume}, {"mass", block->mass},
                           {"driving_force", block->driving});
        tl_lua_set_vec3(L, "force", block->force);
        if (block->mode != TL_KEYBLOCK_STABLE)
            tl_lua_set_vec3(L, "direction", block->direction);
        if (!isnan(block->support))
            tl_lua_set_number(L, "support", block->support);
        if (!isnan(block->support_pressure))
            tl_lua_set_number(L, "support_pressure", block->support_pressure);
        set_faces(L, model, block);
        const double *edges = (const double *)(all->edges + block->edge_start);
        tl_lua_push_rows(L, edges, block->edge_count, 3, 3);
        lua_setfield(L, -2, "pyramid");
        lua_rawseti(L, -2, (lua_Integer)i + 1);
    }
}

static int collect_keyblocks(lua_State *L)
{
    tl_keyblocks_free(lua_touserdata(L, 1));
    return 0;
}

int tl_lua_keyblocks_find(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "keyblocks");
    tl_lua_arity(L, 2, "keyblocks");
    lua_settop(L, 2);
    tl_keyblock_query query = tl_keyblock_query_default();
    tl_lua_read_function(L, 2, "keyblocks", keyblocks_keys, &query);
    if (!lua_istable(L, 2))
        return tl_lua_fail(L, "keyblocks: give the parameters in a table: {friction = 35}");
    query.count = read_strengths(L, "friction", NULL) + read_strengths(L, "cohesion", NULL);
    tl_joint_strength *list = lua_newuserdatauv(L, (query.count + 1) * sizeof *list, 0);
    size_t frictions = read_strengths(L, "friction", list);
    read_strengths(L, "cohesion", list + frictions);
    query.strength = list;
    tl_keyblocks *all = tl_lua_hold(L, sizeof *all, "talus.keyblocks", collect_keyblocks);
    tl_lua_ok(L, model, tl_model_keyblocks(model, &query, all));
    return 1;
}

static int model_keyblocks(lua_State *L, tl_model *model)
{
    tl_lua_keyblocks_find(L);
    push_keyblocks(L, model, lua_touserdata(L, -1));
    return 1;
}

/* ---------------------------------------------------------------- how a model stands ------
 *
 * How a model stands: model:stage and model:verdict. */

static int model_stage(lua_State *L, tl_model *model)
{
    tl_lua_ok(L, model, tl_model_stage(model, tl_lua_text(L, 2, "stage", "the name")));
    return 0;
}

static int model_verdict(lua_State *L, tl_model *model)
{
    tl_verdict v;
    char text[512];
    tl_lua_ok(L, model, tl_model_verdict(model, &v));
    tl_verdict_text(&v, text, sizeof text);
    lua_createtable(L, 0, 16);
    tl_lua_set_text(L, "standing", tl_standing_name(v.standing));
    tl_lua_set_text(L, "text", text);
    tl_lua_set_text(L, "stage", v.stage);
    tl_lua_set_vec3(L, "direction", v.direction);
    TL_LUA_SET_NUMBERS(L, {"ratio", v.ratio}, {"closed", v.closed}, {"volume", v.volume},
                       {"displacement", v.displacement}, {"slip", v.slip}, {"opening", v.opening});
    TL_LUA_SET_COUNTS(L, {"moved", v.moved}, {"farthest", v.farthest}, {"contacts", v.contacts},
                      {"slipping", v.slipping}, {"slipped", (size_t)tl_contact_number(v.slipped)},
                      {"opened", (size_t)tl_contact_number(v.opened)});
    return 1;
}

static const tl_lua_key verdict_fields[] = {
    {"standing", "",
     "\"at rest\" below the local ratio of the last solve, else below 1e-5; \"failed\" by the "
     "criterion of stop_at_failure in the last solve; \"accelerating\" where unbalanced forces "
     "push on; else \"moving\". \"unknown\" before the first step"},
    {"text", "", "all of this as one line"},
    {"stage", "", "name given to model:stage, or \"\""},
    {"ratio", "", "the local unbalanced force ratio"},
    {"closed", "", "blocks that have not moved, but closed their joints, have displacements up to this, m"},
    {"moved, volume", "",
     "blocks that have moved by more than that, and by more than a twentieth of the largest "
     "displacement, a body of several parts as one; their volume, m3"},
    {"direction", "", "of their mean motion, a unit vector"},
    {"farthest, displacement", "", "id of the block that has moved the most, and how far, m"},
    {"slip, slipped", "",
     "how far two bodies have moved along each other since the stage began, the largest, m: the "
     "mean, by area, of their contacts on faces that look the same way; id of the first of these"},
    {"opening, opened", "", "the same apart, m; id of such a contact, 0: none"},
    {"contacts, slipping", "", "contacts there are, and those that slip"},
    {NULL, NULL, NULL},
};

/* ---------------------------------------------------------------- what a model costs ------
 *
 * What a model costs: model:profile() in time, model:memory() in bytes. */

/* profile(true) begins, profile(false) ends, profile() gives the result so far. */
static int model_profile(lua_State *L, tl_model *model)
{
    if (!lua_isnil(L, 2)) {
        int32_t on;
        tl_lua_spec spec = tl_lua_spec_of("profile", NULL);
        tl_lua_read_one(L, 2, &spec, "on", &on);
        tl_model_profiling(model, on != 0);
        return 0;
    }
    tl_profile profile = tl_model_profile(model);
    lua_createtable(L, 0, 9);
    lua_createtable(L, 0, TL_PHASE_COUNT);
#define SET(item, name, doc)                                                                                           \
    lua_pushnumber(L, profile.seconds[TL_PHASE_##item]);                                                               \
    lua_setfield(L, -2, #name);
    TL_PHASES(SET)
#undef SET
    lua_setfield(L, -2, "seconds");
    const tl_zone_summary zones = tl_model_zone_summary(model);
    TL_LUA_SET_COUNTS(L, {"steps", (size_t)profile.steps}, {"pairs", profile.pairs}, {"contacts", profile.contacts},
                      {"loaded", profile.loaded}, {"points", profile.points}, {"zones", zones.zones},
                      {"gridpoints", zones.gridpoints}, {"segments", zones.segments});
    return 1;
}

static int model_memory(lua_State *L, tl_model *model)
{
    tl_memory memory = tl_model_memory(model);
    lua_createtable(L, 0, 14);
#define SET(name, doc) tl_lua_set_count(L, #name, memory.name);
    TL_MEMORY(SET)
#undef SET
    tl_lua_set_count(L, "total", memory.total);
    return 1;
}

static const tl_lua_key profile_fields[] = {
#define KEY(item, name, doc) {"seconds." #name, "", doc},
    TL_PHASES(KEY)
#undef KEY
        {"steps", "", "steps since profiling began"},
    {"pairs", "", "candidate pairs of the broad phase, now"},
    {"contacts, loaded", "", "contacts there are, and those that carry a force"},
    {"points", "", "contact points"},
    {"zones, gridpoints, segments", "", "of deformable blocks; segments are where their surfaces lie on others"},
    {NULL, NULL, NULL},
};

static const tl_lua_key memory_fields[] = {
#define KEY(name, doc) {#name, "", doc},
    TL_MEMORY(KEY)
#undef KEY
        {"total", "", "all of them"},
    {NULL, NULL, NULL},
};

static const tl_lua_key report_results[] = {
    {"blocks, bodies", "", "number of blocks, and of bodies they make"},
    {"volume, volume_error", "",
     "of all blocks, m3; and its relative difference from what was created less what was deleted"},
    {"smallest_volume, smallest_edge, smallest_face", "",
     "m3, m and m2; smallest_volume_block and so on are the blocks that have them"},
    {"worst_aspect, worst_aspect_block", "",
     "largest aspect of a block: its diameter (largest distance between two vertices) over its "
     "thickness (smallest extent along the normal of a face); 1.73 for a cube"},
    {"slivers, sliver_share", "",
     "number of bodies whose shape makes the time step short where all joints are equally stiff, and their share of "
     "the "
     "volume; model:filter{auto = true} joins them"},
    {"sliver_gain", "", "how many times longer a step the others allow"},
    {"deformable, zones, gridpoints, clusters, segments", "",
     "number of blocks that have zones, and what they have; segments are where their surfaces lie on others"},
    {"smallest_altitude, smallest_altitude_block", "",
     "smallest altitude of a zone over its largest side, m, and the block that has it; nil without zones"},
    {"cuts, refused, coincident", "",
     "cuts made, refused because a side would be too thin, and fallen on existing faces, since the model was made"},
    {"refused_cuts", "",
     "the first 1000 refused cuts, each a table: joint, normal and point of the plane, block (its "
     "number), thickness and limit of the thinner side, and the reason as a sentence"},
    {"dt, timestep_block, timestep_message", "",
     "the time step, s, the block that controls it, and the same in a sentence; when some contact "
     "has no law yet, there is only the sentence"},
    {NULL, NULL, NULL},
};

static const tl_lua_key filter_results[] = {
    {"found, deleted, joined", "", "number of slivers, and what was done with them"},
    {"volume", "", "of all slivers, m3"},
    {"gain", "",
     "how many times longer the time step is or, where slivers are only reported, would be; as long as "
     "some contact has no law, where all joints are equally stiff; nil without auto"},
    {"slivers", "",
     "each a table: block (its number), volume, edge, aspect, beyond (which limits: \"volume\", "
     "\"edge\", \"aspect\") and joined_to (a block, or nil)"},
    {NULL, NULL, NULL},
};

static const tl_lua_key keyblock_results[] = {
    {"block", "", "the block, the oldest one of a body of several"},
    {"mode", "",
     "\"falling\", \"sliding\" (on one face), \"sliding on two\", or \"stable\": removable, but "
     "pressed in by its weight"},
    {"safety", "", "factor of safety: 0 falling, math.huge stable"},
    {"faces", "", "the faces it slides on, none to two: {joint =, normal = (outward), area =, normal_force =}"},
    {"direction, driving_force", "", "of the motion, and the force along it, N; a stable one has no direction"},
    {"force, mass, volume", "", "weight and load, N; of the body, kg and m3"},
    {"support, support_pressure", "",
     "with target: least force against the motion that brings that factor, N; and the pressure on its outer faces that "
     "pushes as much against the motion, Pa, whatever it adds to normal forces; 0 where nothing is needed, nil where "
     "outer faces do not look along the motion"},
    {"pyramid", "", "edges of the joint pyramid, unit vectors: it can move in all directions between them"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_quality_topics[] = {
    {.name = "report",
     .usage = "table = talus.report(model)",
     .doc = "Tells how good the blocks are that cutting made, and prints it on a page (not with --quiet).",
     .title = "Fields of the report",
     .verbs = report_results,
     .call = module_report},
    {.name = "filter",
     .usage = "result = model:filter{volume = 1e-6, aspect = 100, action = \"join\"}",
     .function = "filter",
     .title = "Fields of the result",
     .verbs = filter_results,
     .arguments = 1,
     .method = model_filter},
    {.name = "keyblocks",
     .usage = "list = model:keyblocks{friction = 35, target = 1.5}",
     .function = "keyblocks",
     .keys = keyblocks_keys,
     .title = "Fields of each keyblock",
     .verbs = keyblock_results,
     .arguments = 1,
     .method = model_keyblocks},
    {.name = "stage",
     .usage = "model:stage(\"excavated\")",
     .doc = "Begins a stage: displacements of all blocks count from now, as after reset_displacement, "
            "and so does what model:verdict and pages tell of slip and opening. What laws keep stays. "
            "The name is at most 63 bytes; copies and files have it.",
     .arguments = 1,
     .method = model_stage},
    {.name = "verdict",
     .usage = "verdict = model:verdict()",
     .doc = "Tells how the model stands as of its last step: at rest, moving, accelerating or "
            "failed, and what has moved since the stage began. Nothing changes by it.",
     .title = "Fields of the verdict",
     .verbs = verdict_fields,
     .method = model_verdict},
    {.name = "profile",
     .usage = "model:profile(true); model:cycle(100); result = model:profile()",
     .function = "profile",
     .title = "Fields of the result",
     .verbs = profile_fields,
     .arguments = 1,
     .method = model_profile},
    {.name = "memory",
     .usage = "bytes = model:memory()",
     .doc = "Bytes the model holds, by what they are for, room for growth included.",
     .title = "Fields of the result",
     .verbs = memory_fields,
     .method = model_memory},
    {.name = NULL},
};
