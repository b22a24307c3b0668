-- FISH of data files of 3DEC that runs while they are converted: loops, branches, tables, arguments; what is told of the rest.
require "talus"
local check = require "check"
local threedec = require "talus.threedec"

local function convert(text)
    return threedec.convert("test.3ddat", { text = text })
end

local function code_of(result)
    local all = {}
    for _, item in ipairs(result.items) do
        table.move(item.code, 1, #item.code, #all + 1, all)
    end
    return all
end

local function run(text)
    local result = convert(text)
    assert(#result.mistakes == 0, result.mistakes[1] and result.mistakes[1].reason)
    return assert(load(threedec.chunk(result) .. " return model", "@test.3ddat"))(), result
end

local function has(text, part)
    assert(text:find(part, 1, true), ("'%s' is not in: %s"):format(part, text))
end

-- A wall of n by 3 bricks, each row moved by half a brick, the lowest held.
local WALL = [[
* a wall, classic comments
fish define wall(n, rows)
  loop local k (1, rows)
    local shift = 0.5 * (k - 1 - 2 * ((k - 1) / 2))
    loop local i (1, n)
      x = i + shift
      command
        block create brick [x] [x + 1] 0 1 [k - 1] @k group 'row'
      end_command
    end_loop
    if k = 1 then
      command
        block fix
      endcommand
    else if k > 2 & k < 1 then
    endif
  endloop
end
[wall(4, 3)]
]]
-- `&` is no word of conditions: the whole function is told.
local told = convert(WALL)
check.equal(#told.left_out, 1)
has(told.left_out[1].reason, "'&' is not expected")
local model, result = run((WALL:gsub("    else if[^\n]*\n", "    else if k > 2 and not (k < 1 or k # 3) then\n      last = k\n    else\n      middle = k\n")))
check.equal(#result.left_out, 0)
check.equal(#model:blocks {}, 12)
local xs, held = {}, 0
for _, block in ipairs(model:blocks {}) do
    local c = block.centroid
    xs[c[3]] = (xs[c[3]] or 0) + c[1]
    held = held + (block.fixed and 1 or 0)
end
check.near({ xs[0.5], xs[1.5], xs[2.5] }, { 12, 14, 12 }, 1e-12)
check.equal(held, 4)
-- A function that is not called does nothing; each line of one that runs counts once.
check.equal(#code_of(convert "def f\na = 1\nend"), 0)
local _, twice = run "def f\nloop i (1,5)\na = i\nendloop\nend\nf\n@f\nmodel gravity [a]"
check.equal(twice.converted, 6)

-- Values: what was set in a loop or branch is known afterwards, locals and parameters are not.
local lines = code_of(convert "def f(a)\nlocal b = 2*a\nif b >= 4\nc = b\nelse\nc = 0\nendif\nend\n[f(2)]\nmodel gravity [c]")
check.equal(lines[#lines], "model.gravity = { 0, 0, -c }")
check.equal(convert("def f(a)\nlocal b = 2*a\nend\n[f(2)]\nmodel gravity [b]").left_out[1].line, 5)
check.equal(convert("[a = 7]\ndef f(a)\nend\n[f(2)]\nblock create brick 0 @a").items[4].code[1]:match "max = { (%w+)", "a")

-- Tables: rows are sorted by time, and a row takes the place of one of its time.
lines = code_of(convert "def f\nloop i (1,3)\ntable('push', 4 - i) = i\nendloop\ntable.value('push', 2) = 9\nend\nf\ntable 'push' add 2.5 7")
check.equal(lines[#lines], "table_push = { { 4 - 3, 3 }, { 2, 9 }, { 2.5, 7 }, { 4 - 1, 1 } }")
check.equal(#convert("table 'a b' add 0 0\ntable 'a-b' add 1 1\nblock apply vel-z 1 table 'a b'\nblock apply vel-z 1 table 'a-b'").left_out, 0)

-- What is told: the lines that cannot be converted, once each, and what hangs on values that are not known.
result = convert "def f\nloop i (1,4)\na = gp.pos(i)\nif a > 1\nb = 1\nendif\nendloop\nend\n[b = 3]\nf\nmodel gravity @b\nmodel gravity @a"
check.equal(#result.left_out, 4)
for i, line in ipairs { 3, 4, 11, 12 } do
    check.equal(result.left_out[i].line, line)
end
for text, part in pairs {
    ["def f\nloop while 1 < 2\nendloop\nend"] = "'loop while 1 < 2' in line 2",
    ["def f\nloop foreach i block.list\nendloop\nend"] = "foreach",
    ["def f\nif 1 < 2\nend"] = "'if 1 < 2' in line 2",
    ["def f\nendif\nend"] = "'endif' ends nothing",
    ["def f\nblock.pos.x(i) = 3\nend"] = "block.pos.x(i) = 3",
    ["def f\nf\nend\nf"] = "calls itself",
    ["def f\nloop i (1,100000)\na = i\nendloop\nend\nf"] = "more than 5000 statements",
    ["def f\nloop i (3,1)\nendloop\nend\nf"] = "from 3 down to 1",
    ["def f(a)\nend\nf"] = "has 1 arguments, not 0",
    ["[g(1)]"] = "'g' is not converted",
} do
    result = convert(text)
    assert(#result.left_out == 1, text)
    has(result.left_out[1].reason, part)
    assert(load(threedec.script(result)))
end

-- ---------------------------------------------------------------- abbreviations ----------

for _, word in ipairs { "or", "org", "origin", "ori" } do
    has(code_of(convert("poly brick 0 1\njset dip 10 dd 20 " .. word .. " 1,2,3"))[2], "origin = { 1, 2, 3 }")
end
check.equal(code_of(convert "dam local 0.5")[1], code_of(convert "damping local 0.5")[1])
has(code_of(convert "poly brick 0 1\nhide range plane dip 1 dd 2 or 0 0 3 above")[2], "origin = { 0, 0, 3 }")
-- Classic files give variables and call functions by their bare names.
has(code_of(convert "def f\nkk = 2e9\nend\nf\nprop jmat=1 jkn=kk jks kk")[2], "kn = kk, ks = kk")
check.equal(convert("* jset\n  ** dip\nnew").converted, 1)

-- ---------------------------------------------------------------- the last command -------
--
-- In 3DEC a property of a contact is what the last command says whose range the contact was in.

local TOWER = [[
block create brick 0 2 0 2 0 3
block cut joint-set dip 0 origin 0 0 1 spacing 1 number 1 jointset-id 1
block cut joint-set dip 0 origin 0 0 2 jointset-id 2
block cut joint-set dip 90 dip-direction 90 origin 1 0 0 jointset-id 3
block group 'a' range position-z 0 1 position-x 0 1
block group 'b' range position-z 1 2
block group 'c' range position-z 2 3
block fix
block contact property stiffness-normal 1e9 stiffness-shear 1e9
]]
local RANGES = {
    { "", function() return true end },
    { "range group 'a'", function(c) return c.a == "a" or c.b == "a" end },
    { "range group 'b'", function(c) return c.a == "b" or c.b == "b" end },
    { "range group-intersection 'c' 'b'", function(c) return c.a == "b" and c.b == "c" or c.a == "c" and c.b == "b" end },
    { "range group-intersection 'b' 'b'", function(c) return c.a == "b" and c.b == "b" end },
    { "range joint-set 2", function(c) return c.joint == "J2" end },
    { "range joint-set 3", function(c) return c.joint == "J3" end },
    { "range joint-set 3 group 'c'", function(c) return c.joint == "J3" and (c.a == "c" or c.b == "c") end },
    { "range position-x 0 0.9", function(c) return c.x[1] <= 0.9 end },
    { "range position-z 1.4 2.2", function(c) return c.x[3] >= 1.4 and c.x[3] <= 2.2 end },
    { "range not position-z 1.4 2.2", function(c) return c.x[3] < 1.4 or c.x[3] > 2.2 end },
    { "range union group 'a' position-x 1.2 2", function(c) return c.a == "a" or c.b == "a" or c.x[1] >= 1.2 end },
}

local function facts_of(model)
    local list = {}
    for i, c in ipairs(model:contacts {}) do
        list[i] = { a = c.blocks[1].group, b = c.blocks[2].group, x = c.point, joint = c.joint:match "^[^:]*" }
    end
    return list
end

-- Group after contact, and contact after group.
model = run(TOWER .. "block contact property friction 11 range position-x 0 0.9\nblock contact property friction 22 range group 'a'")
for _, c in ipairs(model:contacts { where = function(c) return c.blocks[1].group == "a" or c.blocks[2].group == "a" end }) do
    check.equal(model:laws()[c.law_number].parameters.friction, 22)
end

local WORDS = { friction = "friction", cohesion = "cohesion", tension = "tension" }
for _ = 1, check.cases(150) do
    local text, given = { TOWER }, {}
    for k = 1, math.random(2, 7) do
        local name, value, range = next(WORDS, ({ nil, "friction", "cohesion", "tension" })[math.random(0, 3) + 1]), math.random(1, 20), math.random(#RANGES)
        name = name or "friction"
        given[k] = { name, value, RANGES[range][2] }
        text[#text + 1] = ("block contact property %s %d %s\n"):format(name, value, RANGES[range][1])
    end
    model, result = run(table.concat(text))
    check.equal(#result.in_part, 0)
    local laws = model:laws()
    local facts = facts_of(model)
    for i, c in ipairs(model:contacts {}) do
        local wanted = { friction = 0, cohesion = 0, tension = 0 }
        for _, one in ipairs(given) do
            wanted[one[1]] = one[3](facts[i]) and one[2] or wanted[one[1]]
        end
        for name, value in pairs(wanted) do
            local got = laws[c.law_number].parameters[name] or 0
            assert(got == value, ("%s of %s between %s and %s at z %g: %g, not %g\n%s"):format(name, c.joint, facts[i].a, facts[i].b,
                facts[i].x[3], got, value, table.concat(text)))
        end
    end
end

-- Joint materials: what is changed later of a material changes for the contacts that have it now.
model = run(TOWER .. "prop jmat=1 jkn=1e9 jks=1e9 jfric=10\nprop jmat=2 jkn=2e9 jks=2e9 jfric=20\nchange jmat=2 range group 'b'\nchange jmat=1 range position-x 0 0.9\n" ..
    "prop jmat=1 jfric=15\nprop jmat=2 jcoh=5")
for i, c in ipairs(facts_of(model)) do
    local p = model:laws()[model:contacts {}[i].law_number].parameters
    local second = c.x[1] > 0.9 and (c.a == "b" or c.b == "b")
    check.equal(p.friction, second and 20 or 15)
    check.equal(p.cohesion or 0, second and 5 or 0)
end
-- Ranges that have no contact, or no block, any more.
model = run(TOWER .. "block contact property friction 11 range group 'a'\nblock contact property friction 12 range position-z 0 1.5\n" ..
    "block delete range group 'a'\nblock contact property friction 13")
check.equal(model:laws()[model:contacts {}[1].law_number].parameters.friction, 13)

-- A line that begins as another branch and is none leaves the function out, with its lines, as anything else that cannot be read.
local broken = convert "fish define f\n  if 1 > 0 then\n    a = 1\n  else = 2\n  endif\nend\nblock create brick 0 [a] 0 1 0 1\n"
check.holds(#broken.left_out > 0)
has(broken.left_out[1].reason, "'else = 2' in line 4")
