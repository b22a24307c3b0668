/* joint.c - model:joint: the law of a joint, or of contacts between groups or selections. */
#include "lua/joint.h"

#include "lua/block.h"
#include "lua/contact.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/item.h"
#include "lua/living.h"

#include <stdlib.h>
#include <string.h>

const tl_lua_key tl_lua_joint_keys[] = {
    {"joint", "\"J1\", \"J1:3\" or \"*\"", "in a table: contacts on this joint; any when left out"},
    {"between", "{\"stone\", \"support\"}",
     "in a table: contacts between blocks of two groups, either way round; a selection of blocks or a block serves in "
     "the place of a group. The same group twice: contacts inside it"},
    {"group", "\"GROUP\"", "in a table: contacts with at least one block of the group"},
    {"blocks", "selection of blocks", "in a table: contacts with at least one of these blocks, or of their parts"},
    {"contacts", "selection of contacts",
     "in a table: contacts between the two blocks of one of these, or between their parts"},
    {NULL, NULL, NULL},
};

static const tl_lua_spec which_spec = {"joint", NULL, 0, tl_lua_joint_keys};

/* ---------------------------------------------------------------- which contacts ---------- */

static void check_owner(lua_State *L, const tl_lua_model *owner, const char *what)
{
    if (owner != lua_touserdata(L, 1))
        tl_lua_fail(L, "joint: %s of another model", what);
}

/* Whether the value at the top of the stack is a block, or a selection of them: then they are a side of the scope. */
static bool read_blocks(lua_State *L, tl_law_scope *scope, int side)
{
    static const tl_id none = TL_NO_ID; /* an empty selection has no list, but NULL would mean any block */
    const tl_lua_selection *blocks = luaL_testudata(L, -1, TL_LUA_BLOCKS);
    const tl_lua_item *block = luaL_testudata(L, -1, TL_LUA_BLOCK);
    if (!blocks && !block)
        return false;
    check_owner(L, blocks ? blocks->owner : block->owner, "blocks");
    scope->block_count[side] = blocks ? blocks->count : 1;
    scope->blocks[side] = block ? &block->name.block : blocks->count ? blocks->names : &none;
    return true;
}

/* The same of contacts. */
static bool read_contacts(lua_State *L, tl_law_scope *scope)
{
    static const tl_contact_name none = {TL_NO_ID, TL_NO_ID, 0};
    const tl_lua_selection *contacts = luaL_testudata(L, -1, TL_LUA_CONTACTS);
    const tl_lua_item *contact = luaL_testudata(L, -1, TL_LUA_CONTACT);
    if (!contacts && !contact)
        return false;
    check_owner(L, contacts ? contacts->owner : contact->owner, "contacts");
    scope->contact_count = contacts ? contacts->count : 1;
    scope->contacts = contact ? &contact->name.contact : contacts->count ? contacts->names : &none;
    return true;
}

/* A group or blocks at the top of the stack, which it stays on. */
static void read_side(lua_State *L, tl_law_scope *scope, int side)
{
    if (lua_type(L, -1) == LUA_TSTRING)
        scope->group[side] = tl_lua_text(L, lua_gettop(L), "joint", "a group's name");
    else if (!read_blocks(L, scope, side))
        tl_lua_fail(L, "joint, between: item %d must be a group's name, a selection of blocks or a block, not %s",
                    side + 1, tl_lua_describe(L, -1));
}

static void read_between(lua_State *L, tl_law_scope *scope)
{
    if (!lua_istable(L, -1) || lua_rawlen(L, -1) != 2)
        tl_lua_fail(L, "joint: between must be a list of two groups or selections of blocks, not %s",
                    lua_istable(L, -1) ? lua_pushfstring(L, "a list of %I", (lua_Integer)lua_rawlen(L, -1))
                                       : tl_lua_describe(L, -1));
    const int pair = lua_gettop(L);
    tl_lua_check_list(L, pair, "joint, between: the list of two", 2);
    for (int side = 0; side < 2; side++) {
        lua_rawgeti(L, pair, side + 1);
        read_side(L, scope, side);
    }
}

/* What the table at index 2 has beside the joint: one of four keys, whose values stay on the stack. */
static void read_table(lua_State *L, tl_law_scope *scope)
{
    int named = 0;
    tl_lua_read(L, 2, &which_spec, false, NULL);
    if (tl_lua_option(L, 2, "joint") != LUA_TNIL)
        scope->joint = tl_lua_text(L, lua_gettop(L), "joint", "joint, the joint's name,");
    if (tl_lua_option(L, 2, "between") != LUA_TNIL && ++named)
        read_between(L, scope);
    if (tl_lua_option(L, 2, "group") != LUA_TNIL && ++named)
        scope->group[0] = tl_lua_text(L, lua_gettop(L), "joint", "group, the group's name,");
    if (tl_lua_option(L, 2, "blocks") != LUA_TNIL && ++named && !read_blocks(L, scope, 0))
        tl_lua_fail(L, "joint: blocks must be a selection of blocks or a block, not %s", tl_lua_describe(L, -1));
    if (tl_lua_option(L, 2, "contacts") != LUA_TNIL && ++named && !read_contacts(L, scope))
        tl_lua_fail(L, "joint: contacts must be a selection of contacts or a contact, not %s", tl_lua_describe(L, -1));
    if (named > 1)
        tl_lua_fail(L, "joint: of between, group, blocks and contacts give one");
    if (named == 0 && !scope->joint)
        tl_lua_fail(L, "joint: the table says which contacts the law is for: give joint, between, group, blocks or "
                       "contacts");
}

int tl_lua_model_joint(lua_State *L, tl_model *model)
{
    tl_law_scope scope = tl_law_scope_default();
    const char *law = NULL, *context = "joint";
    int table = 3;
    lua_settop(L, 4);
    lua_pushvalue(L, 2);
    if (lua_istable(L, 2)) {
        read_table(L, &scope);
    } else if (!read_blocks(L, &scope, 0) && !read_contacts(L, &scope)) {
        scope.joint = tl_lua_text(L, 2, "joint", "the joint's name");
        context = lua_pushfstring(L, "joint '%s'", scope.joint);
    }
    if (!lua_isnil(L, 4) || lua_type(L, 3) == LUA_TSTRING) {
        law = tl_lua_text(L, 3, "joint", "the law's name");
        table = 4;
    }
    if (!law && !lua_istable(L, 3))
        tl_lua_fail(L, "%s: give a law's name, or a table of properties to change, not %s", context,
                    tl_lua_describe(L, 3));
    tl_args args;
    tl_lua_args(L, table, context, NULL, &args);
    tl_lua_ok(L, model, tl_joint_law_for(model, &scope, law, &args));
    return 0;
}

/* ---------------------------------------------------------------- what laws name ---------- */

/* Pushes side k: a group's name, or the blocks of the list. */
static void push_side(lua_State *L, const tl_law_scope *scope, int k)
{
    if (scope->group[k]) {
        lua_pushstring(L, scope->group[k]);
        return;
    }
    tl_lua_selection *blocks = tl_lua_selection_push(L, &tl_lua_block_kind, 1);
    const size_t bytes = scope->block_count[k] * sizeof *scope->blocks[k];
    blocks->names = malloc(bytes + 1);
    if (!blocks->names)
        tl_lua_fail(L, "out of memory");
    memcpy(blocks->names, scope->blocks[k], bytes);
    blocks->count = scope->block_count[k];
}

static int release_scope(lua_State *L)
{
    tl_law_scope_free(lua_touserdata(L, 1));
    return 0;
}

void tl_lua_set_scope(lua_State *L, tl_model *model, size_t index)
{
    tl_law_scope *scope = tl_lua_hold(L, sizeof *scope, "talus.law_scope", release_scope);
    tl_lua_ok(L, model, tl_law_scope_get(model, index, scope));
    lua_insert(L, -2);
    tl_lua_set_text(L, "joint", scope->joint);
    const bool one = scope->group[0] || scope->blocks[0], two = scope->group[1] || scope->blocks[1];
    if (scope->contacts)
        tl_lua_set_count(L, "contacts", scope->contact_count);
    if (two) {
        lua_createtable(L, 2, 0);
        for (int k = 0; k < 2; k++) {
            push_side(L, scope, k);
            lua_rawseti(L, -2, k + 1);
        }
        lua_setfield(L, -2, "between");
    } else if (one) {
        push_side(L, scope, 0);
        lua_setfield(L, -2, scope->group[0] ? "group" : "blocks");
    }
    tl_law_scope_free(scope);
    lua_remove(L, -2);
}
