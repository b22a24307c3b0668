/* verdict.c - how a model stands: model:stage and model:verdict. */
#include "front.h"

int tl_lua_stage(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "stage");
    tl_lua_arity(L, 2, "stage");
    tl_lua_ok(L, model, tl_model_stage(model, tl_lua_text(L, 2, "stage", "the name")));
    return 0;
}

static void set_id(lua_State *L, const char *name, tl_id id)
{
    lua_pushinteger(L, (lua_Integer)id);
    lua_setfield(L, -2, name);
}

static void set_count(lua_State *L, const char *name, size_t count)
{
    lua_pushinteger(L, (lua_Integer)count);
    lua_setfield(L, -2, name);
}

static void set_text(lua_State *L, const char *name, const char *text)
{
    lua_pushstring(L, text);
    lua_setfield(L, -2, name);
}

int tl_lua_verdict(lua_State *L)
{
    tl_model *model = tl_lua_model_of(L, "verdict");
    tl_lua_arity(L, 1, "verdict");
    tl_verdict v;
    char text[512];
    tl_lua_ok(L, model, tl_model_verdict(model, &v));
    tl_verdict_text(&v, text, sizeof text);
    lua_createtable(L, 0, 16);
    set_text(L, "standing", tl_standing_name(v.standing));
    set_text(L, "text", text);
    set_text(L, "stage", v.stage);
    tl_lua_set_number(L, "ratio", v.ratio);
    tl_lua_set_number(L, "closed", v.closed);
    set_count(L, "moved", v.moved);
    tl_lua_set_number(L, "volume", v.volume);
    tl_lua_push_vec3(L, v.direction);
    lua_setfield(L, -2, "direction");
    set_id(L, "farthest", v.farthest);
    tl_lua_set_number(L, "displacement", v.displacement);
    tl_lua_set_number(L, "slip", v.slip);
    set_id(L, "slipped", v.slipped);
    tl_lua_set_number(L, "opening", v.opening);
    set_id(L, "opened", v.opened);
    set_count(L, "contacts", v.contacts);
    set_count(L, "slipping", v.slipping);
    return 1;
}

const tl_lua_key tl_lua_verdict_fields[] = {
    {"standing", "",
     "\"at rest\" below the local ratio of the last solve, else below 1e-5; \"failed\" by the "
     "criterion of stop_at_failure in the last solve; \"accelerating\" where unbalanced forces "
     "push "
     "on; else \"moving\". \"unknown\" before the first step"},
    {"text", "", "all of this as one line"},
    {"stage", "", "name given to model:stage, or \"\""},
    {"ratio", "", "the local unbalanced force ratio"},
    {"closed", "",
     "blocks that have not moved, but closed their joints, have displacements up to this, m"},
    {"moved, volume", "",
     "blocks that have moved by more than that, and by more than a twentieth of the largest "
     "displacement, a body of several parts as one; their volume, m3"},
    {"direction", "", "of their mean motion, a unit vector"},
    {"farthest, displacement", "", "id of the block that has moved the most, and how far, m"},
    {"slip, slipped", "",
     "how far two bodies have moved along each other since the stage began, the largest, m: the "
     "mean, by area, of their "
     "contacts on faces that look the same way; id of the first of these"},
    {"opening, opened", "", "the same apart, m; id of such a contact, 0: none"},
    {"contacts, slipping", "", "contacts there are, and those that slip"},
    {NULL, NULL, NULL},
};
