/* view_line.c - commands of those who look at a model, as lines of Lua: what is done is what is logged, so a log repeats it.
 *
 * Numbers have the digits that give back the same double. */
#include "view.h"

#include <stdio.h>
#include <stdlib.h>

/* Digits of a number at least. */
#define DIGITS 6

/* A text in quotes, with what could end it or its line as numbers. */
static void add_text(luaL_Buffer *line, const char *text)
{
    luaL_addchar(line, '"');
    for (; *text; text++) {
        char number[8];
        unsigned char letter = (unsigned char)*text;
        if (letter == '"' || letter == '\\') {
            luaL_addchar(line, '\\');
            luaL_addchar(line, *text);
        } else if (letter < ' ' || letter == 127) {
            snprintf(number, sizeof number, "\\%03u", letter);
            luaL_addstring(line, number);
        } else {
            luaL_addchar(line, *text);
        }
    }
    luaL_addchar(line, '"');
}

static void add_numbers(luaL_Buffer *line, const double *values, size_t count)
{
    luaL_addstring(line, "{ ");
    for (size_t i = 0; i < count; i++) {
        luaL_addstring(line, i ? ", " : "");
        tl_lua_add_number(line, values[i], DIGITS);
    }
    luaL_addstring(line, " }");
}

/* model:blocks { id = { 3, 5 } } */
static void add_blocks(luaL_Buffer *line, const tl_view_command *command, bool hidden)
{
    double ids[TL_VIEW_BLOCKS];
    for (size_t i = 0; i < command->block_count; i++)
        ids[i] = command->blocks[i];
    luaL_addstring(line, "model:blocks { id = ");
    if (command->block_count == 1)
        tl_lua_add_number(line, ids[0], DIGITS);
    else
        add_numbers(line, ids, command->block_count);
    luaL_addstring(line, hidden ? ", hidden = \"any\" }" : " }");
}

static void add_cut(luaL_Buffer *line, const tl_view_command *command)
{
    const double origin[] = {command->origin.x, command->origin.y, command->origin.z};
    luaL_addstring(line, "model:generate(\"joint\", { joint = ");
    add_text(line, command->joint);
    luaL_addstring(line, ", dip = ");
    tl_lua_add_number(line, command->dip, DIGITS);
    luaL_addstring(line, ", dip_direction = ");
    tl_lua_add_number(line, command->dip_direction, DIGITS);
    luaL_addstring(line, ", origin = ");
    add_numbers(line, origin, 3);
    luaL_addstring(line, " })");
}

static void add_friction(luaL_Buffer *line, const tl_view_command *command)
{
    luaL_addstring(line, "model:joint(");
    add_text(line, command->joint);
    luaL_addstring(line, ", { friction = ");
    tl_lua_add_number(line, command->value, DIGITS);
    luaL_addstring(line, " })");
}

/* model:METHOD("PREFIX" and the rest of the name) */
static void add_file(luaL_Buffer *line, const char *method, const char *name)
{
    luaL_addstring(line, "model:");
    luaL_addstring(line, method);
    luaL_addchar(line, '(');
    add_text(line, name);
    luaL_addchar(line, ')');
}

/* Whether a block of the command is hidden: a selection then has to ask for it. */
static bool any_hidden(tl_model *model, const tl_view_command *command)
{
    bool hidden = false;
    for (size_t i = 0; i < command->block_count && !hidden; i++) {
        tl_block_filter filter = tl_block_filter_default();
        tl_id *found;
        size_t count;
        filter.id = command->blocks[i];
        filter.hidden = 1;
        if (tl_blocks_select(model, &filter, &found, &count) != TL_OK)
            break;
        hidden = count > 0;
        free(found);
    }
    return hidden;
}

bool tl_lua_view_line(lua_State *L, tl_model *model, const tl_view_command *command,
                      const char *prefix)
{
    luaL_Buffer line;
    for (size_t i = 0; i < command->block_count; i++) {
        if (tl_block_check(model, command->blocks[i]) != TL_OK) {
            lua_pushfstring(L, "%s: %s", tl_view_op_name(command->op), tl_model_error(model)->text);
            return false;
        }
    }
    bool hidden = any_hidden(model, command);
    char cycle[32];
    snprintf(cycle, sizeof cycle, "_%09lld.talus", (long long)tl_model_cycles(model));
    const char *name = lua_pushfstring(L, "%s%s", prefix, command->op == TL_VIEW_VTK ? "" : cycle);
    luaL_buffinit(L, &line);
    switch (command->op) {
    case TL_VIEW_PAUSE:
    case TL_VIEW_GO:
    case TL_VIEW_STEP: break;
    case TL_VIEW_CUT: add_cut(&line, command); break;
    case TL_VIEW_FRICTION: add_friction(&line, command); break;
    case TL_VIEW_VTK: add_file(&line, "write_vtk", name); break;
    case TL_VIEW_SNAPSHOT: add_file(&line, "save", name); break;
    default:
        if (command->block_count > 0)
            add_blocks(&line, command, hidden);
        else
            luaL_addstring(&line, "model:blocks { hidden = true }");
        luaL_addchar(&line, ':');
        luaL_addstring(&line, tl_view_op_name(command->op));
        luaL_addstring(&line, "()");
    }
    luaL_pushresult(&line);
    lua_remove(L, -2);
    if (lua_rawlen(L, -1) == 0) {
        lua_pop(L, 1);
        lua_pushnil(L);
    }
    return true;
}
