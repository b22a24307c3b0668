/* library.c - the modules of Talus that are written in Lua (scripts/lib/talus), and files for them.
 *
 * `require "talus.plot"` finds them beside the program or the library talus.so, wherever these lie. A searcher of its
 * own comes before the search path of scripts, so the modules are of the same Talus. Where talus.so has not
 * been loaded yet, Lua's search for C modules loads it for its function luaopen_talus_NAME. */
#include "lua/library.h"

#include "lua/chance.h"
#include "lua/convert.h"
#include "lua/fail.h"
#include "lua/workers.h"

#include <ctype.h>
#include <limits.h>
#include <string.h>

#define PREFIX "talus."

/* Pushes the loader of a module and its path; or one sentence why there is none, and returns 1. */
static int push_loader(lua_State *L, const char *name)
{
    char file[128], path[PATH_MAX];
    size_t length = strlen(name);
    if (length + sizeof ".lua" > sizeof file || strspn(name, "abcdefghijklmnopqrstuvwxyz_.") != length)
        return 0;
    strcpy(file, name);
    for (char *c = file; *c; c++)
        *c = *c == '.' ? '/' : *c;
    strcat(file, ".lua");
    tl_error error;
    if (tl_library_find(file, path, sizeof path, &error) != TL_OK) {
        lua_pushstring(L, error.text);
        return 1;
    }
    if (luaL_loadfilex(L, path, "t") != LUA_OK)
        return lua_error(L);
    lua_pushstring(L, path);
    return 2;
}

/* Modules in C that those in Lua use. */
static const luaL_Reg inner[] = {
    {PREFIX "chance", tl_lua_chance_open}, {PREFIX "workers", tl_lua_workers_open}, {NULL, NULL}};

/* One of package.searchers. */
static int search(lua_State *L)
{
    const char *name = luaL_checkstring(L, 1);
    for (const luaL_Reg *one = inner; one->name; one++)
        if (strcmp(name, one->name) == 0) {
            lua_pushcfunction(L, one->func);
            return 1;
        }
    return strncmp(name, PREFIX, sizeof PREFIX - 1) == 0 ? push_loader(L, name) : 0;
}

/* What luaopen_talus_NAME does. */
static int open_module(lua_State *L, const char *name)
{
    tl_lua_library_open(L);
    if (push_loader(L, name) != 2)
        return tl_lua_fail(L, "%s", lua_tostring(L, -1));
    lua_pushstring(L, name);
    lua_insert(L, -2);
    lua_call(L, 2, 1);
    return 1;
}

TL_API int luaopen_talus_back_analysis(lua_State *L);
TL_API int luaopen_talus_bolt_pattern(lua_State *L);
TL_API int luaopen_talus_bolt_test(lua_State *L);
TL_API int luaopen_talus_convert(lua_State *L);
TL_API int luaopen_talus_plot(lua_State *L);
TL_API int luaopen_talus_poles(lua_State *L);
TL_API int luaopen_talus_realisations(lua_State *L);
TL_API int luaopen_talus_stereonet(lua_State *L);

int luaopen_talus_back_analysis(lua_State *L)
{
    return open_module(L, PREFIX "back_analysis");
}

int luaopen_talus_bolt_pattern(lua_State *L)
{
    return open_module(L, PREFIX "bolt_pattern");
}

int luaopen_talus_bolt_test(lua_State *L)
{
    return open_module(L, PREFIX "bolt_test");
}

int luaopen_talus_convert(lua_State *L)
{
    return open_module(L, PREFIX "convert");
}

int luaopen_talus_plot(lua_State *L)
{
    return open_module(L, PREFIX "plot");
}

int luaopen_talus_poles(lua_State *L)
{
    return open_module(L, PREFIX "poles");
}

int luaopen_talus_realisations(lua_State *L)
{
    return open_module(L, PREFIX "realisations");
}

int luaopen_talus_stereonet(lua_State *L)
{
    return open_module(L, PREFIX "stereonet");
}

void tl_lua_library_open(lua_State *L)
{
    static const char key; /* its address is where the registry keeps that it is done */
    bool done = lua_rawgetp(L, LUA_REGISTRYINDEX, &key) != LUA_TNIL;
    lua_pop(L, 1);
    if (done || lua_getglobal(L, "package") != LUA_TTABLE) {
        lua_settop(L, done ? lua_gettop(L) : lua_gettop(L) - 1);
        return;
    }
    if (lua_getfield(L, -1, "searchers") == LUA_TTABLE) {
        for (lua_Integer i = (lua_Integer)lua_rawlen(L, -1); i >= 2; i--) {
            lua_rawgeti(L, -1, i);
            lua_rawseti(L, -2, i + 1);
        }
        lua_pushcfunction(L, search);
        lua_rawseti(L, -2, 2); /* after package.preload */
        lua_pushboolean(L, true);
        lua_rawsetp(L, LUA_REGISTRYINDEX, &key);
    }
    lua_pop(L, 2);
}

/* ---------------------------------------------------------------- commands and readers --- */

bool tl_library_command(const char *name, char *path, size_t size)
{
    char file[64];
    tl_error error;
    if (strspn(name, "abcdefghijklmnopqrstuvwxyz") != strlen(name) || strlen(name) < 2 || strlen(name) > 20)
        return false;
    int n = snprintf(file, sizeof file, "talus/commands/%s.lua", name);
    return n > 0 && tl_library_find(file, path, size, &error) == TL_OK;
}

/* Whether a module of Talus reads files of this script's ending; path gets the module's place. */
static bool find_reader(const char *script, char *path, size_t size)
{
    char file[64] = "talus/readers/";
    size_t length = strlen(file);
    const char *ending = strrchr(script, '.');
    if (!ending || strlen(ending) < 2 || strlen(ending) > 16)
        return false;
    for (const char *c = ending + 1; *c; c++) {
        if (!isalnum((unsigned char)*c))
            return false;
        file[length++] = (char)tolower((unsigned char)*c);
    }
    strcpy(file + length, ".lua");
    tl_error error;
    return tl_library_find(file, path, size, &error) == TL_OK;
}

int tl_lua_script_load(lua_State *L, const char *script)
{
    char path[PATH_MAX];
    if (!script || !find_reader(script, path, sizeof path))
        return luaL_loadfile(L, script);
    int status = luaL_loadfilex(L, path, "t");
    if (status != LUA_OK)
        return status;
    lua_pushstring(L, script);
    status = lua_pcall(L, 1, 1, 0);
    if (status != LUA_OK)
        return status;
    size_t length;
    const char *text = luaL_checklstring(L, -1, &length);
    lua_pushfstring(L, "@%s", script);
    status = luaL_loadbufferx(L, text, length, lua_tostring(L, -1), "t");
    lua_replace(L, -3);
    lua_pop(L, 1);
    return status;
}

static int module_write_file(lua_State *L)
{
    tl_lua_arity(L, 2, "talus.write_file");
    const char *path = tl_lua_text(L, 1, "talus.write_file", "the file's name");
    if (lua_type(L, 2) != LUA_TSTRING)
        return tl_lua_fail(L, "talus.write_file: the text must be a string, not %s", tl_lua_describe(L, 2));
    size_t length;
    const char *text = lua_tolstring(L, 2, &length);
    tl_error error;
    if (tl_write_file(path, text, length, &error) != TL_OK)
        return tl_lua_fail(L, "talus.write_file: %s", error.text);
    return 0;
}

/* ---------------------------------------------------------------- help ------------------- */

static const tl_lua_key plot_keys[] = {
    {"file", "text in quotes, required", "name of the SVG file; folders are made"},
    {"series", "list of {x =, y =, name =, style =, colour =}",
     "lines: lists of numbers x (1, 2, 3, ... when left out) and y; style is \"line\", \"points\" "
     "or \"both\", colour \"#0072b2\". Numbers that are not finite make a gap. Or {history =, "
     "component =, against =, name =}: history is one of model:histories(), component \"x\", "
     "\"y\", \"z\" or a number (all when left out), against \"time\" or \"cycle\""},
    {"model", "model", "draws histories of this model"},
    {"histories", "list of names", "which of them, in this order; all when left out"},
    {"x_axis, y_axis", "text or {name =, unit =, log =, range =}",
     "name and unit of the axis; log = true is a logarithmic one, which leaves out numbers not "
     "above 0; range = {from, to} when left out takes in all"},
    {"title", "text in quotes, may be left out", "stands above the picture"},
    {"legend", "true or false",
     "whether a list of the lines stands beside; left out: when there are several, or names"},
    {"grid", "true or false, default true", "whether ticks have lines across"},
    {"width, height", "number, default 720 and 440", "of the picture, pixels"},
    {NULL, NULL, NULL},
};

static const tl_lua_key stereonet_keys[] = {
    {"file", "text in quotes, required", "name of the SVG file; folders are made"},
    {"model", "model", "draws the joint sets of this model, from the faces of its blocks as they lie now"},
    {"joints", "list of names", "which of its joint sets (\"J1\"), in this order; all when left out"},
    {"sets", "list of {name =, dip =, dip_direction =}",
     "further sets, degrees; or {name =, planes = {{dip, dip_direction}, ...}} for several planes"},
    {"poles", "poles or list of poles", "what talus.poles gave, or a list of sets as its method sets gives"},
    {"keyblocks", "list of keyblocks", "what model:keyblocks{...} gave: a cross for the direction of each movement"},
    {"projection", "\"equal_area\" or \"equal_angle\"", "of Schmidt and Lambert, the default, or of Wulff"},
    {"great_circles", "\"mean\", \"all\" or \"none\"",
     "of the mean plane of each set, the default, of every plane, or of none"},
    {"title", "text in quotes, may be left out", "stands above the picture"},
    {"legend", "true or false, default true", "whether a list of the sets stands beside, with mean dip/dip direction"},
    {"grid", "true or false, default true",
     "whether plunges of 30 and 60 degrees and every 30 degrees of trend are drawn"},
    {"size", "number, default 480", "of the square picture without the legend, pixels"},
    {NULL, NULL, NULL},
};

static const tl_lua_key convert_keys[] = {
    {"file", "text in quotes, required", "name of the data file, of 3DEC 7 to 9 or a classic one"},
    {"to", "text in quotes, may be left out", "name of the script that is written; folders are made"},
    {"up", "\"z\" or \"y\"",
     "axis that points up in the file, z when left out; with \"y\" dip directions count from z, as in left-handed "
     "files"},
    {NULL, NULL, NULL},
};

static const tl_lua_key convert_result[] = {
    {"script", "", "the script, a text"},
    {"report", "", "lines that tell what was converted and what was not"},
    {"converted, needless", "", "number of commands; of those for which Talus needs nothing"},
    {"left_out, in_part, mistakes", "",
     "lists of {file =, line =, source =, reason =}: commands without counterpart, "
     "those of which a part has none, and those that are wrong"},
    {NULL, NULL, NULL},
};

static const tl_lua_key realisations_keys[] = {
    {"number", "whole number, required", "of realisations"},
    {"build", "function(draw), required", "gives the model of a realisation, by what it draws"},
    {"measure", "function(model, draw), required",
     "gives a table of what is measured: numbers, true and false, texts; the same names in each realisation"},
    {"screen", "function(model, draw)",
     "cheap test before the measure: gives a table likewise, and true when that decides, so that nothing is measured"},
    {"seed", "whole number, default 1", "of all draws"},
    {"latin", "true or false, default false",
     "a Latin hypercube: of n realisations each n-th part of a distribution has one"},
    {"workers", "whole number, default 1", "processes that work at once; the rows are the same for any number"},
    {"file", "text in quotes, may be left out",
     "file of rows; one that is there is gone on with, and rows that it has are not computed again"},
    {"stop_when", "{field =, half_width =, at_least =}",
     "ends when the 95 % interval of the probability of the field has at most this half width, of so many rows or "
     "more"},
    {"on_row", "function(rows)", "called after each row that is written, with the number of rows"},
    {NULL, NULL, NULL},
};

static const tl_lua_key realisations_draws[] = {
    {"draw.normal(name, mean, sd, range)", "", "a number; range {min =, max =} cuts the distribution off"},
    {"draw.lognormal(name, mean, sd, range)", "", "likewise, by mean and deviation of the number itself"},
    {"draw.uniform(name, min, max)", "", "each alike"},
    {"draw.triangular(name, min, mode, max)", "", "most often near the mode"},
    {"draw.power_law(name, exponent, min, max)", "", "density proportional to x^-(1 + exponent)"},
    {"draw.fisher(name, dip, dip_direction, kappa)", "",
     "dip and dip direction of a plane; kappa is the concentration"},
    {"draw.choice(name, list, weights)", "", "one of the list"},
    {"draw.seed(name)", "", "a seed for a model"},
    {"draw.correlated(names, {{mean, sd}, ...}, correlation)", "",
     "numbers of normal distributions, or with distribution = \"lognormal\" in a pair, correlated before they are cut "
     "off by min and max; a number for two, else a matrix. With latin for at most 1,000,000 realisations"},
    {"draw.row", "", "number of the realisation"},
    {"set:probability(field)", "",
     "share of rows in which the field is true or not 0; low and high of its 95 % interval"},
    {"set:mean(field), set:sd(field), set:quantile(field, share)", "", "of its numbers"},
    {"set:histogram(field, intervals)", "", "{edges =, counts =}"},
    {"set:sensitivity(field)", "",
     "list of {name =, rank_correlation =, correlation =} of the draws, the strongest first"},
    {"set:rows()", "", "list of {row =, error =, NAME = value}"},
    {"set:model(row)", "", "the model of a realisation, built anew"},
    {"set.errors, set.stopped, #set", "", "rows with an error; whether stop_when has ended it; rows"},
    {NULL, NULL, NULL},
};

static const tl_lua_key poles_methods[] = {
    {"#poles", "", "number of planes"},
    {"poles:mean()", "",
     "{dip =, dip_direction =, normal =, resultant =, kappa =, cone =} after Fisher: R / N, the concentration (N - 1) "
     "/ (N "
     "- R), and the half angle of the 95 % cone, degrees"},
    {"poles:sets(count, {seed =})", "", "a list of poles: sets by k-means on axes, the largest first"},
    {"poles:terzaghi{trend =, plunge =, most = 10}", "", "poles weighted by 1 / |cos| of their angle to a scan line"},
    {"poles:draw(number, {seed =, distribution =})", "",
     "list of {dip =, dip_direction =}, each \"measured\" or by \"fisher\" about the mean"},
    {"poles:list()", "", "list of {dip, dip_direction}"},
    {"poles:write(file)", "", "writes a table that talus.poles and the generators jointset and dfn read"},
    {NULL, NULL, NULL},
};

static const tl_lua_key back_analysis_keys[] = {
    {"build", "function(values), required", "gives the model for values {NAME = number} of the unknown"},
    {"unknown", "{NAME = {from, to}}, required", "the interval in which its value is sought"},
    {"observed", "{FIELD = value}, required", "what was observed: a number, a pair {low, high} of them, true or false"},
    {"measure", "function(model, values)",
     "gives a table with the field; when left out the second value that build gives is that table"},
    {"tolerance", "number, default 1e-4", "share of the interval that is left when the search ends"},
    {NULL, NULL, NULL},
};

static const tl_lua_key back_analysis_result[] = {
    {"value, low, high", "",
     "of the unknown; the ends of the interval that is left or, of a pair, the values for its two ends"},
    {"trials", "", "list of {NAME = value, FIELD = measured}"},
    {NULL, NULL, NULL},
};

static const tl_lua_key pattern_keys[] = {
    {"on", "result of model:boundary, required", "the faces that are bolted"},
    {"spacing", "list of 2 numbers, required",
     "of the grid in the plane of each face, across and along, m, both above 0"},
    {"length", "number, required", "of the bolts, m, from 1e-3 to 1e4"},
    {"direction", "vector or text, default \"normal\"", "into the rock; faces that a bolt would not enter get none"},
    {"along", "vector, default {0, 1, 0}", "direction of the rows, as it lies in each face: the axis of a tunnel"},
    {"origin", "vector", "a point of the grid; left out: the centroid of the faces"},
    {"node_spacing", "number", "`spacing` of the nodes of each bolt, m"},
    {NULL, NULL, NULL},
};

static const tl_lua_key bolt_test_keys[] = {
    {"length", "number, required", "of the bolt, m, from 0.01 to 1000"},
    {"pull", "number", "how far its mouth is drawn out, m; or `shear`"},
    {"shear", "number", "how far a joint across its middle slides, m"},
    {"angle", "number, default 0", "between the bolt and the normal of that joint, degrees, 0 to 89"},
    {"steps", "number, default 200", "points of the curve"},
    {NULL, NULL, NULL},
};

static const tl_lua_key bolt_test_results[] = {
    {"displacement", "", "list of the displacement of the mouth, or of the joint, m"},
    {"force", "", "list of the force at the mouth, N; nil with shear"},
    {"axial", "", "list of the largest tension, N; nil with pull"},
    {"dowel", "", "list of the dowel's force, N; nil with pull"},
    {"along", "", "list of the force that resists the slip, N; nil with pull"},
    {"closing", "", "list of the force that presses the joint together, N; nil with pull"},
    {"yielded", "", "whether the bolt has yielded at the end"},
    {"broken", "", "whether it has broken"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_library_topics[] = {
    {.name = "back_analysis",
     .usage = "found = talus.back_analysis{build = function(v) return model, {safety = v.friction / 30} end, unknown = "
              "{friction = {20, 60}}, observed = {safety = 1}}",
     .doc = "Finds the value of an unknown for which a model does what was observed, by halving an interval. Measured "
            "must "
            "be something that passes the observed value once in it.",
     .keys = back_analysis_keys,
     .title = "Fields of the result",
     .verbs = back_analysis_result},
    {.name = "bolt_pattern",
     .usage = "bolts = talus.bolt_pattern{on = model:boundary{facing = {0, 0, -1}}, spacing = {1.5, 1.5}, length = 3}",
     .doc = "Lays a grid of bolts over outer faces and gives a list for model:element(\"bolt\", list). "
            "Other entries are parameters of the element \"bolt\", for each.",
     .keys = pattern_keys},
    {.name = "bolt_test",
     .usage = "curve = talus.bolt_test{length = 2, pull = 0.01, grout_strength = 2e5}  or  "
              "curve = talus.bolt_test{length = 2, shear = 0.01, dowel_stiffness = 1e8}",
     .doc = "Draws a bolt out of rock, or shears it by a joint, without a model, and gives the curve as lists. "
            "Other entries are parameters of the element \"bolt\". Its places, and in a pull its plate and pretension, "
            "are those of the test.",
     .keys = bolt_test_keys,
     .title = "Fields of the curve",
     .verbs = bolt_test_results},
    {.name = "convert",
     .usage = "result = talus.convert{file = \"scripts/examples/fault.3ddat\"}",
     .doc = "Writes a data file of 3DEC as a script of Talus, one line a command, and tells what is left out. "
            "`talus convert [--up y] FILE [SCRIPT.lua]` does the same from a shell, and `talus run FILE.3ddat`, or "
            "FILE.dat, runs it at once.",
     .keys = convert_keys,
     .title = "Fields of the result",
     .verbs = convert_result},
    {.name = "plot",
     .usage = "talus.plot{file = \"out/run.svg\", model = model, histories = {\"roof\"}, y_axis = "
              "{name = \"subsidence\", unit = \"m\"}}",
     .doc = "Draws lists and histories as lines, with axes, ticks and a legend, into an SVG file.",
     .keys = plot_keys},
    {.name = "poles",
     .usage = "poles = talus.poles{{30, 120}, {32, 118}}  or  talus.poles(\"FILE\", {declination = 3.5})",
     .doc = "Reads measured orientations of joints: a table whose first line names the columns dip and dip_direction, "
            "and weight "
            "if there is one; or a list of {dip, dip_direction}. Cells are separated by commas, semicolons or tabs; "
            "with semicolons or tabs numbers may have decimal commas. Poles are axes, and their order means nothing. "
            "declination, degrees in [-180, 180], default 0, is that of magnetic from true north, east positive: it is "
            "added to all dip directions. Tables that are written are from true north.",
     .title = "Methods",
     .verbs = poles_methods},
    {.name = "realisations",
     .usage = "set = talus.realisations{number = 3, build = function(draw) return model end, measure = function(model, "
              "draw) "
              "return {failed = draw.uniform(\"u\", 0, 1) < 0.1} end}",
     .doc = "Builds and measures many models, each with draws of its own, in worker processes, and gives the set of "
            "rows. A draw is "
            "a pure function of seed, row and name. A row that errs has its sentence in `error`; more than 5 % of them "
            "end the "
            "run. `talus run --shard i/n SCRIPT` makes the rows i, i + n, ... in FILE.shard-i-of-n, and `talus merge "
            "FILE` one "
            "file of the shards.",
     .keys = realisations_keys,
     .title = "Draws, and methods of the set",
     .verbs = realisations_draws},
    {.name = "stereonet",
     .usage = "talus.stereonet{file = \"out/joints.svg\", model = model, keyblocks = model:keyblocks{friction = 30}}",
     .doc = "Draws joint sets by poles and great circles on the lower hemisphere, into an SVG file.",
     .keys = stereonet_keys},
    {.name = "write_file",
     .usage = "talus.write_file(\"out/table.csv\", text)",
     .doc = "Writes a text into a file, whole or not at all. Folders are made; only a regular file is replaced.",
     .call = module_write_file},
    {.name = NULL},
};
