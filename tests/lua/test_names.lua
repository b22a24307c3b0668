-- Names of groups, joints and files: what is no UTF-8 is refused where it would come into a file of JSON, and a sentence stays one
-- line whatever names are in it.
local check = require "check"
local talus = require "talus"

local folder = assert(os.getenv("TALUS_TEST_TMP")) .. "/names_" .. (tostring({}):match("0x(%x+)") or "0")
local LATIN = "caf\xe9" -- in ISO 8859-1
local LINES = "two\nlines\27[2J\x7f"

local function model_of_box(group)
    local model = talus.model {}
    model:generate("box", { min = { 0, 0, 0 }, max = { 2, 1, 1 }, density = 2000, group = group })
    return model
end

local function text_of(path)
    local file = assert(io.open(path, "rb"))
    local text = file:read "a"
    file:close()
    return text
end

-- ---------------------------------------------------------------- no UTF-8

local model = model_of_box "ok"
check.refused(model, function()
    model:generate("box", { min = { 0, 0, 0 }, max = { 2, 1, 1 }, density = 2000, group = LATIN })
end, [[group 'caf\xe9' is not a text in UTF-8]])
check.refused(model, function() model:blocks():set { group = LATIN } end, [[set: group = 'caf\xe9' is not a text in UTF-8]])
for _, bad in ipairs { "\xc3", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "a\x80b", "\xff" } do
    check.refused(model, function() model:blocks():set { group = bad } end, "is not a text in UTF-8")
end
check.refused(model, function()
    model:generate("joint", { joint = LATIN, dip = 90, dip_direction = 90, origin = { 1, 0, 0 } })
end, [[joint = 'caf\xe9' is not a name]])
check.refused(model, function() model:write_vtk(folder .. "/" .. LATIN) end, [[must end in a name in UTF-8]])
check.refused(model, function() model:write_section(folder .. "/" .. LATIN, { dip = 90 }) end, [[caf\xe9' must end in a name in UTF-8]])

-- A file of blocks that another program wrote.
model:write_blocks(folder .. "/blocks.json")
local text = text_of(folder .. "/blocks.json")
talus.write_file(folder .. "/latin.json", (text:gsub('"ok"', '"' .. LATIN .. '"')))
check.refused(model, function() model:generate("blocks", { file = folder .. "/latin.json" }) end, [[group 'caf\xe9' is not a text in UTF-8]])

-- Letters of all lengths go through files and back.
local good = "Tür, 岩, \u{1F5FB}, \u{7FF}\u{800}\u{FFFF}\u{10000}"
local named = model_of_box(good)
named:generate("joint", { joint = "Kluft Tür, 岩", dip = 90, dip_direction = 90, origin = { 1, 0, 0 } })
named:write_blocks(folder .. "/good.json")
named:save(folder .. "/good.talus")
local again = talus.model {}
again:generate("blocks", { file = folder .. "/good.json" })
check.equal(again:blocks()[1].group, good)
check.equal(talus.restore(folder .. "/good.talus"):blocks()[1].group, good)
check.equal(again:joints()[1].name, named:joints()[1].name)

-- A folder may have any name, and a page any title; what is written is UTF-8.
named:write_vtk(folder .. "/" .. LATIN .. "/run")
named:write_html(folder .. "/" .. LATIN .. "/run", { title = LATIN .. " <1> \xf0\x9f & \xe2\x82" })
named:write_html(folder .. "/" .. LATIN)
for _, name in ipairs { "/good.json", "/" .. LATIN .. "/run_blocks.vtk.series", "/" .. LATIN .. "/run.html", "/" .. LATIN .. ".html" } do
    check.holds(utf8.len(text_of(folder .. name)), name .. " is UTF-8")
end
check.holds(text_of(folder .. "/" .. LATIN .. "/run.html"):find("<title>caf\u{FFFD} &lt;1&gt; \u{FFFD}\u{FFFD} &amp; \u{FFFD}\u{FFFD}</title>", 1, true),
    "the title of the page")

-- ---------------------------------------------------------------- several lines

local SHOWN = [[two\nlines\x1b[2J\x7f]]
local lines = model_of_box(LINES)
lines:write_blocks(folder .. "/lines.json")
again = talus.model {}
again:generate("blocks", { file = folder .. "/lines.json" })
check.equal(again:blocks()[1].group, LINES)

local function refused(f, part)
    check.refused(lines, f, part or "")
    local _, sentence = pcall(f)
    check.holds(sentence:find(SHOWN, 1, true), "the name is shown escaped: " .. sentence)
    check.holds(not sentence:find "%c", "one line: " .. sentence)
end
refused(function() lines:joint(LINES, "coulomb", { kn = 1, ks = 1, friction = 30 }) end, "unknown joint")
refused(function() lines:joint("*", LINES, {}) end, "unknown law")
refused(function() lines:joint("*", "coulomb", { kn = 1, ks = 1, [LINES] = 30 }) end, "unknown parameter")
refused(function() lines:joint("*", "coulomb", { kn = 1, ks = 1, friction = LINES }) end, "must be a number")
refused(function() lines:damping(LINES) end, "unknown damping")
refused(function() lines:generate(LINES, {}) end, "unknown generator")
refused(function() lines:generate("import", { file = LINES .. ".stl", density = 2000 }) end, "file '")
refused(function() lines:generate("import", { file = LINES, density = 2000 }) end, "does not end in")
refused(function() lines:generate("blocks", { file = folder .. "/" .. LINES }) end, "file '")
refused(function() lines:generate("joint", { joint = LINES, dip = 90, dip_direction = 0, origin = { 1, 0, 0 } }) end, "is not a name")
refused(function() lines:write_vtk(LINES .. "/") end, "must end in a name")
refused(function() lines:write_blocks("/dev/null/" .. LINES) end, "cannot write")
refused(function() lines:save("/dev/null/" .. LINES) end, "/dev/null/")
refused(function() talus.restore("/nowhere/" .. LINES) end, "/nowhere/")
refused(function() talus.write_file("/dev/null/" .. LINES, "") end, "cannot write")
refused(function() return lines[LINES] end)
refused(function() return lines:blocks()[1][LINES] end, "has no field")
refused(function() return lines:blocks():values(LINES) end, "has no field")
refused(function() lines:blocks { [LINES] = 1 } end, "unknown parameter")
refused(function() lines:history { name = "h", value = LINES } end)
refused(function() lines:keyblocks { friction = { [LINES] = 30 } } end)
refused(function() lines:cycle(LINES) end)
refused(function() talus.law_test { law = LINES, path = { 1 } } end)

os.execute(string.format("rm -r '%s'", folder))

-- Of a name without end the sentence says the beginning and the end.
do
    local good, said = pcall(function() model:blocks { boundary = ("x"):rep(100000) } end)
    check.holds(not good and #said < 3000 and said:find("xxx ... xxx", 1, true), said:sub(1, 300))
end
