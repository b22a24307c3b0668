-- Data files of 3DEC: every row of the table of commands is converted and run; words, values, ranges, files, mistakes.
local talus = require "talus"
local check = require "check"
local threedec = require "talus.threedec"
local words = require "talus.threedec.words"

local function convert(text, options)
    options = options or {}
    options.text = text
    return threedec.convert("test.3ddat", options)
end

-- What a text becomes, each command in one line; without the head.
local function lines(text, options)
    local result = convert(text, options)
    local all = {}
    for _, item in ipairs(result.items) do
        table.move(item.code, 1, #item.code, #all + 1, all)
    end
    return all, result
end

-- The one line that a command becomes; what comes before it is left away.
local function line(text, before)
    local all, result = lines((before and before .. "\n" or "") .. text)
    check.equal(#result.mistakes, 0)
    return all[#all], result
end

-- The sentence of the first mistake of a text.
local function mistake(text)
    local result = convert(text)
    assert(result.mistakes[1], "no mistake in: " .. text)
    return result.mistakes[1].reason, result.mistakes[1].line
end

-- Runs a text; gives the model.
local function run(text, options)
    local result = convert(text, options)
    assert(#result.mistakes == 0, result.mistakes[1] and result.mistakes[1].reason)
    local chunk = assert(load(threedec.chunk(result) .. " return model", "@test.3ddat"))
    return chunk(), result
end

local function has(text, part)
    assert(text:find(part, 1, true), ("'%s' is not in: %s"):format(part, text))
end

-- ---------------------------------------------------------------- every row --------------

local BEFORE = [[
model new
block create brick 0 1 0 1 0 1 group 'rock'
block create brick 0 1 0 1 1 2 group 'stone'
block create brick 1 2 0 1 0 1 group 'drift'
block create brick 2 3 0 1 0 1 group 'base'
]]

local function read_more(path)
    return path:match "more.dat" and "block fix range position-z 0 1\n" or nil, "no such file"
end

local function examples_of(row)
    return type(row.example) == "string" and { row.example } or row.example or {}
end

local here = os.tmpname()
os.remove(here)
local tried = 0
local print_before = print
for _, row in ipairs(words.rows) do
    for _, example in ipairs(examples_of(row)) do
        local given = row.form == nil and "" or BEFORE
        local text = (given .. example):gsub("'state'", "'" .. here .. "'")
        local result = convert(text, { read = read_more })
        local where = row.commands[1] .. ": " .. example
        assert(#result.mistakes == 0, where .. ": " .. (result.mistakes[1] and result.mistakes[1].reason or ""))
        assert(#result.left_out == 0, where .. ": left out: " .. (result.left_out[1] and result.left_out[1].reason or ""))
        local script = assert(load(threedec.script(result), "=script"), where)
        print = function() end
        local good, why = pcall(script)
        print = print_before
        assert(good, where .. ": " .. tostring(why))
        -- line by line it does the same
        local chunk = assert(load(threedec.chunk(result) .. " return model", "@test.3ddat"))
        print = function() end
        good, why = pcall(chunk)
        print = print_before
        assert(good, where .. ": " .. tostring(why))
        tried = tried + 1
    end
    -- What has no example says why.
    assert(row.example or row.lacks or row.needless or row.commands[1] == "block create", row.commands[1])
    assert(not row.convert or row.form and row.becomes, row.commands[1])
    for _, command in ipairs(row.commands) do
        if row.lacks then
            local result = convert(command .. " 1 2 3")
            check.equal(#result.left_out, 1)
            check.equal(result.left_out[1].reason, row.lacks)
            has(threedec.script(result), "-- left out: " .. command)
        elseif row.needless then
            local result = convert(command)
            check.equal(result.needless, 1)
            has(threedec.script(result), "-- " .. command .. " (" .. row.needless)
        end
    end
end
os.remove(here .. ".talus")
assert(tried > 60, tried)

-- ---------------------------------------------------------------- shapes -----------------

local model = run [[
block create brick -1 1
poly brick (5,6) (0,2) (0,3)
block create tetrahedron 10 0 0 11 0 0 10 1 0 10 0 1
block create prism face-1 20 0 0 22 0 0 20 2 0 face-2 20 0 1 22 0 1 20 2 1
block create polyhedron face 30,0,0 30,1,0 31,1,0 31,0,0 ...
    face 30,0,0 31,0,0 31,0,1 30,0,1 ... ; a side
    face 30,1,0 30,1,1 31,1,1 31,1,0 &
    face 30,0,0 30,0,1 30,1,1 30,1,0 ...
    face 31,0,0 31,1,0 31,1,1 31,0,1 face 30,0,1 31,0,1 31,1,1 30,1,1
block create drum center-1 40 0 0 center-2 40 0 2 radius-1 1 radius-2 1 edges 4
block property density 2000
]]
local volumes = { 8, 6, 1 / 6, 2, 1, 4 }
for i, volume in ipairs(volumes) do
    check.near(model:blocks { id = i }[1].volume, volume, 1e-12)
    check.near(model:blocks { id = i }[1].mass, 2000 * volume, 1e-9)
end

-- A prism with an end that is not convex is its convex hull, and that is told.
local dented = "poly prism a 0 0 0 2 0 0 2 2 0 1 %s 0 0 2 0 b 0 0 1 2 0 1 2 2 1 1 %s 1 0 2 1"
local model_of_dent, told = run(dented:format("2.5", "2.5"))
check.near(model_of_dent:blocks {}[1].volume, 4.5, 1e-12)
check.equal(#told.in_part, 0)
model_of_dent, told = run(dented:format("1.9", "2.5"))
check.equal(#told.in_part, 1)
has(told.in_part[1].reason, "convex hull")

-- The first density of a file is that of the blocks before it is given, and there is none without one.
has(line "block create brick 0 1\nprop mat=1 dens=2345", "model:blocks {}:set { density = 2345 }")
has((lines "block create brick 0 1\nblock property dens 2345")[1], "density = 2345")
has((lines "prop mat=1 dens 2345\npoly brick 0 1 0 1 0 1 region 3")[1], 'density = 2345, group = "region 3"')

-- Joint sets: as many planes, in the same place.
model = run "block create brick 0 4 0 4 0 4\njset dip 0 dd 0 spacing 1 num 3 org 2 2 2\njset dip 90 dd 90 org 1 0 0"
check.equal(#model:blocks {}, 8)
check.equal(#model:joints(), 2)
-- A cut of a range leaves the others whole, and all visible.
model = run "block create brick 0 1 0 1 0 1\nblock create brick 0 1 0 1 1 2\nblock cut joint-set dip 90 dip-d 90 ori 0.5 0 0 range pos-z 1 2"
check.equal(#model:blocks {}, 3)
-- Number of a set, and of those without one.
has(line("jset dip 10 dd 20 id 2", "block create brick 0 1"), 'joint = "J2"')
has(line("jset dip 10 dd 20", "block create brick 0 1\njset dip 10 dd 20 id 1"), 'joint = "J2"')
has(line("block contact property stiffness-normal 1 stiffness-shear 1 range joint-set 4", "jset dip 10 dd 20 id 4"), 'model:joint("J4", ')

-- Dips beyond Talus's ranges are those of the same plane; above and below follow. With y up dip directions count from z.
has(line "jset dip 120 dd 90", "dip = 60, dip_direction = 270")
has(line "jset dip 30 dd -90", "dip = 30, dip_direction = 270")
has(line "jset dip 30 dd 450", "dip = 30, dip_direction = 90")
has(line "hide range plane dip 120 dd 90 above", "below = { dip = 60, dip_direction = 270")
has(line "hide range plane normal 0 0 -2 origin 1 2 3 above", "below = { dip = 0, dip_direction = 0, origin = { 1, 2, 3 } }")
local y_up = lines("jset dip 0 dd 0", { up = "y" })[1] -- horizontal: its normal is y
has(y_up, "dip = 90, dip_direction = 0")
has(lines("jset dip 90 dd 0", { up = "y" })[1], "dip = 0") -- normal z
has(lines("jset dip 90 dd 90", { up = "y" })[1], "dip = 90, dip_direction = 90") -- normal x

-- ---------------------------------------------------------------- ranges -----------------

local THREE = "block create brick 0 1 0 1 0 1 group 'a'\nblock create brick 1 2 0 1 0 1 group 'b'\nblock create brick 2 3 0 1 0 1 group 'c'\n"
local function fixed(text)
    local fixed_model = run(THREE .. "block fix range " .. text)
    local ids = {}
    for _, block in ipairs(fixed_model:blocks { fixed = true }) do
        ids[#ids + 1] = block.id
    end
    return table.concat(ids, " ")
end
check.equal(fixed "group 'a'", "1")
check.equal(fixed "group a or b", "1 2")
check.equal(fixed "not group 'a'", "2 3")
check.equal(fixed "group 'a' not group 'a'", "")
check.equal(fixed "union group 'a' group 'c'", "1 3")
check.equal(fixed "position-x 0.4 1.6", "1 2")
check.equal(fixed "x 0.4 1.6 z 0 1", "1 2")
check.equal(fixed "pos-x 1.6 0.4", "1 2")
check.equal(fixed "pos-x 1.5", "2")
check.equal(fixed "position 1 0 0 3 1 1", "2 3")
check.equal(fixed "position (3,1,1) (1,0,0) not group c", "2")
check.equal(fixed "id 2", "2")
check.equal(fixed "id 2 3", "2 3")
check.equal(fixed "id-list 1 3", "1 3")
check.equal(fixed "plane dip 90 dip-direction 90 origin 1.2 0 0 above", "2 3")
check.equal(fixed "plane dip 90 dd 90 ori 1.2 0 0 below", "1")
check.equal(fixed "plane dip 90 dd 90 ori 1.5 0 0 distance 0.1", "2")
check.equal(fixed "plane dip 90 dd 90 ori 1.2 0 0 above plane dip 90 dd 90 ori 2.2 0 0 below", "2")
check.equal(fixed "sphere center 0.5 0.5 0.5 radius 1.1", "1 2")
check.equal(fixed "cylinder end-1 0 .5 .5 end-2 2 .5 .5 radius 0.1", "1 2")
check.equal(fixed "volume 0.9 1.1 group 'c'", "3")
check.equal(fixed "all", "1 2 3")
check.equal(line("block fix range named-range 'low' group 'x'", "model range create 'low' position-z 0 1"),
    'model:blocks { group = "x", where = function(b) return 0 <= b.centroid[3] and b.centroid[3] <= 1 end }:fix()')
check.equal(line("fix range name low", "range name low group 'x' not group 'y'"),
    'model:blocks { group = "x", where = function(b) return not (b.group == "y") end }:fix()')
local _, left
-- Materials: the last change of a block counts, and its density is that of its material, given before or after.
model = run(THREE .. "prop mat=2 dens=2000\nchange mat=2 range x 0 1.7\nchange mat=3 range x 1.2 1.7\nprop mat=3 dens 3000\nprop mat=2 dens 2100")
check.near(model:blocks { id = 1 }[1].density, 2100, 0)
check.near(model:blocks { id = 2 }[1].density, 3000, 0)
-- Named ranges, several in a classic one: what is in one of them.
check.equal(#run(THREE .. "range name p group a\nrange name q x 2 3\nrange name both union nrange p q\nfix range nrange both")
    :blocks { fixed = true }, 2)
check.equal(#run(THREE .. "range name p group a\nrange name q x 2 3\nfix range nrange p q x 0 1"):blocks { fixed = true }, 1)
-- A region is a group, until its blocks get another one.
model = run "poly reg 2 brick 0 1 0 1 0 1\npoly brick 1 2 0 1 0 1\nmark region 3 range x 1 2\nfix range region 2\ndelete range region 3"
check.equal(#model:blocks {}, 1)
check.equal(model:blocks {}[1].group, "region 2")
check.equal(model:blocks {}[1].fixed, true)
_, left = lines "poly reg 2 brick 0 1 0 1 0 1\ngroup 'a' range region 2"
has(left.in_part[1].reason, "one group a block")
-- What has no counterpart is told.
_, left = lines "block fix range dfn 'x'"
has(left.left_out[1].reason, "dfn")
_, left = lines "jset dip 0 dd 0\nblock fix range id 3"
has(left.left_out[1].reason, "numbers of blocks after cuts")

-- ---------------------------------------------------------------- joints -----------------

local KN = "block contact property stiffness-normal 1e9 stiffness-shear 5e8 "
check.equal(line(KN .. "friction 30"), 'model:joint("*", "coulomb", { kn = 1e9, ks = 5e8, friction = 30 })')
check.equal(line(KN .. "fric 30 coh 1e5 ten 2e4 fric-res 20 dil 5 dil-zero 1e-3"), 'model:joint("*", "coulomb_tensile", { kn = 1e9, ' ..
    "ks = 5e8, friction = 30, cohesion = 1e5, tension = 2e4, residual_friction = 20, dilation = 5, dilation_limit = 1e-3 })")
check.equal(line("block contact jmodel assign elastic", KN), 'model:joint("*", "elastic", { kn = 1e9, ks = 5e8 })')
check.equal(line("block contact property friction 20", KN), 'model:joint("*", "coulomb", { kn = 1e9, ks = 5e8, friction = 20 })')
check.equal(line(KN .. "fric 40 range group 'Supports'"), 'model:joint({ group = "Supports" }, "coulomb", { kn = 1e9, ks = 5e8, friction = 40 })')
check.equal(line(KN .. "range group-intersection 'a' 'b'"), 'model:joint({ between = { "a", "b" } }, "coulomb", { kn = 1e9, ks = 5e8 })')
check.equal(line("change jmat=2 range z 0 1", "prop jmat=2 jkn=1e9 jks=1e8 jfric=25 jcoh=10"), "model:joint({ contacts = model:contacts " ..
    '{ where = function(c) return 0 <= c.point[3] and c.point[3] <= 1 end } }, "coulomb_tensile", ' ..
    "{ kn = 1e9, ks = 1e8, friction = 25, cohesion = 10 })")
-- Properties of all contacts are those of contacts with a rule of their own as well.
local all = lines(KN .. "range group 'a'\n" .. "block contact property friction 33")
check.equal(#all, 2)
all = lines(KN .. "\n" .. KN .. "friction 10 range group 'a'\nblock contact property friction 33")
check.equal(#all, 4)
has(all[4], 'joint_again({ group = "a" }, "coulomb", { kn = 1e9, ks = 5e8, friction = 33 })')
-- The table of new contacts gives what all contacts have not.
has(line "block contact material-table default property stiffness-normal 1e9 stiffness-shear 1e8", '"*"')
_, left = line("block contact material-table default property friction 20", KN .. "friction 30")
has(left.in_part[1].reason, "friction")
_, left = lines "block contact jmodel assign softening-mohr"
has(left.left_out[1].reason, "softening-mohr")
_, left = lines "block contact property friction 30\nmodel solve"
has(left.in_part[1].reason, "no stiffness")
-- In the model the laws are those of the ranges: of each contact, also by its place.
model = run(THREE .. KN .. "friction 30\n" .. KN .. "friction 20 range group-intersection 'a' 'b'\n" ..
    "block contact jmodel assign elastic range position-x 1.9 2.1\nblock fix\nmodel cycle 1")
check.equal(#model:contacts {}, 2)
check.equal(model:contacts { where = function(contact) return contact.point[1] < 1.5 end }[1].law, "coulomb")
check.equal(model:contacts { where = function(contact) return contact.point[1] > 1.5 end }[1].law, "elastic")
local frictions = {}
for _, law in ipairs(model:laws()) do
    frictions[#frictions + 1] = law.parameters.friction
end
table.sort(frictions)
check.equal(table.concat(frictions, " "), "20.0 30.0")

-- ---------------------------------------------------------------- values and FISH --------

check.equal(line "model gravity 0 0 [-9.81]", "model.gravity = { 0, 0, -9.81 }")
check.equal(line "model gravity -10", "model.gravity = { 0, 0, -(-10) }") -- two signs would begin a comment of Lua
check.equal(line("model gravity [g]", "[g = 2]\n[g = -g]"), "model.gravity = { 0, 0, -g }")
check.equal(line("block property density [2*rho]", "[rho = 1250]"), "model:blocks {}:set { density = 2 * rho }")
check.equal(line("block property density @rho", "[global rho = 1250.0]"), "model:blocks {}:set { density = rho }")
check.equal(line "prop mat 1 dens 2.5d3\nblock property density 1.e3", "model:blocks {}:set { density = 1e3 }")
check.equal(line("block cre bri [-a] [a]", "[a = 3/2]"), -- whole numbers
    "model:generate(\"box\", { min = { -a, -a, -a }, max = { a, a, a }, density = 1000 })")
check.equal(lines("[a = 3/2]\n[b = 3.0/2]\n[c = (a + b)^2 - -1]\n[d = math.sqrt(c) * math.sin(math.pi/6.0)]")[3], "local c = (a + b)^2 - -1")
local values = { "3/2 1", "-3/2 -1", "3.0/2 1.5", "2+3*4 14", "(2+3)*4 20", "2^3^2 64", "-2^2 -4", "10-4-3 3", "abs(-2) 2", "math.max(1,5,3) 5",
    "int(2.7) 2", "int(-2.7) -2", "float(1)/4 0.25", "12/2/3 2", "2/3*3 0", "8-(4-3) 7", "-(-2) 2", "3-(-(-2)) 1", "--2 2", "1-2*3 -5", "2.0/(4/2) 1.0" }
for _, row in ipairs(values) do
    local expression, value = row:match "^(%S+) (%S+)$"
    local text = lines("[v = " .. expression .. "]")[1]
    check.near(assert(load(text .. " return v"))(), tonumber(value), 1e-12)
end
-- A name is the same in upper and lower case; a word of Lua is not taken.
check.equal(line("block property density @RHO", "[Rho = 1.0]"), "model:blocks {}:set { density = rho }")
check.equal(line("block property density @end", "[end = 1.0]"), "model:blocks {}:set { density = end_ }")
-- Functions of assignments run where they are called; others are told with their lines, and so are their calls.
all, left = lines "fish define values\n  kn = 2e9 ; stiff\n  ks = kn/2.5\nend\n@values\nprop jmat=1 jkn @kn jks [ks]"
check.equal(all[1], "local kn = 2e9")
check.equal(all[2], "local ks = kn / 2.5")
check.equal(#left.left_out, 0)
_, left = lines "def walk\n  loop while a < 3\n    a = 2\n  endloop\nend\n[walk]\nblock property density @a"
check.equal(#left.left_out, 3)
has(left.left_out[1].reason, "'walk', lines 1 to 5")
check.equal(left.left_out[2].line, 6)
has(left.left_out[3].reason, "'a'")
-- More variables than a script of Lua has locals: numbers.
local many = {}
for i = 1, 250 do
    many[i] = ("[v%d = %d.5]"):format(i, i)
end
model = run(table.concat(many, "\n") .. "\nblock create brick 0 1\nblock property density [v250 + v1]")
check.near(model:blocks {}[1].density, 252, 0)

-- ---------------------------------------------------------------- holding and loading ----

model = run "block create brick 0 1\nblock fix velocity-x rotation"
check.equal(model:blocks {}[1].fixed, false)
check.equal(line "fix", "model:blocks {}:fix()")
check.equal(line "block fix vel-x vel-y range group 'a'", 'model:blocks { group = "a" }:fix { x = true, y = true }')
check.equal(line "block free velocity-z", "model:blocks {}:free():fix { x = true, y = true, rotation = true }")
model = run(THREE .. [[
block apply velocity-x 0.5 range group 'a'
block apply velocity-z 0.25 range group 'a'
block contact property stiffness-normal 1e8 stiffness-shear 1e8
model dynamic active on
model solve time 1
]])
assert(model.time >= 1)
check.near(model:blocks { id = 1 }[1].displacement, { 0.5 * model.time, 0, 0.25 * model.time }, 1e-9)
-- A table of velocities: the way is the area below it.
model = run("block create brick 0 1\ntable 'v' add 0 0 1 1 2 1\nblock apply velocity-z 2 table 'v'\n" .. KN .. "\nmodel dynamic active on\nmodel solve time 2")
check.near(model:blocks {}[1].displacement[3], 3 + 2 * (model.time - 2), 1e-3)
-- A FISH function of the time: the way of a sine.
model = run("block create brick 0 1\n[w = 2.0]\nfish def wave\n  wave = math.sin(w*mech.time)\nend\nblock apply velocity-x 3 fish wave\n" .. KN ..
    "\nmodel dynamic active on\nmodel solve time 1")
check.near(model:blocks {}[1].displacement[1], 1.5 * (1 - math.cos(2 * model.time)), 1e-3)
-- Forces at the corners of a rigid block add up, with their moment.
model = run("block create brick 0 1\nblock property density 1\nblock gridpoint apply force-z 2 range position-z 0.9 1.1\n" ..
    KN .. "\nblock mechanical damping none\nmodel dynamic active on\nmodel solve time 0.1")
check.near(model:blocks {}[1].velocity[3], 8 * model.time, 0.05)
-- Stress on a face.
model = run("block create brick 0 2 0 1 0 1\nblock face apply stress 0 0 -50 0 0 0 range position-z 0.99 1.01\nblock fix\n" .. KN .. "\nmodel cycle 2")
check.near(model:blocks {}:reaction()[3], 100, 1e-9)
_, left = lines "block face apply stress 0 0 -1 0 0 0 range group 'top'"
has(left.left_out[1].reason, "positions")
_, left = lines "block apply velocity-x 1 fish wave range group 'a'"
has(left.left_out[1].reason, "'wave'")
check.equal(line "insitu stress -1e6,-2e6,-3e6,0,5,0 zgrad 1e4,1e4,2e4,0,0,0 nodis",
    "model:insitu { stress = { xx = -1e6, yy = -2e6, zz = -3e6, xz = 5 }, gradient = { xx = 1e4, yy = 1e4, zz = 2e4 } }")

-- ---------------------------------------------------------------- runs -------------------

check.equal(line("model solve ratio-local 1e-6", KN), 'print("solve: " .. model:relax { ratio = 1e-6, measure = "local" }.message)')
check.equal(line("solve", KN), 'print("solve: " .. model:relax { ratio = 1e-5, measure = "average" }.message)')
check.equal(line("solve ratio 1e-6 steps 100", KN), 'print("solve: " .. model:relax { ratio = 1e-6, measure = "average", max_cycles = 100 }.message)')
check.equal(line("model solve time 2.5", KN), 'print("solve: " .. model:solve { ratio = 0, max_time = 2.5 }.reason)')
check.equal(line("damp 0.1 5 mass"), ('model:damping("viscous", { alpha = %.15g })'):format(4 * math.pi * 0.1 * 5))
check.equal(lines(KN .. "\ncycle 10\nmodel dynamic active on\ncycle 10")[3], "model:cycle(10)")
check.equal(lines(KN .. "\ncycle 10\nmodel dynamic active on\ncycle 10")[4], "model:mass_scaling(false)")
-- Damping is local unless a file says otherwise.
has(threedec.script(convert "block create brick 0 1"), 'model:damping "local"')
assert(not threedec.script(convert "block mech damp global"):find('damping "local"', 1, true))
-- `model new` after blocks begins anew.
model = run "block create brick 0 1\nblock create brick 2 3\nmodel new\nblock create brick 0 1"
check.equal(#model:blocks {}, 1)
-- Refined faces are Talus's default contact.
check.equal(run("block create brick 0 1").contact_points, "corners")
check.equal(run("block create brick 0 1\nblock face triangulate radial-8").contact_points, "consistent")
-- Histories.
model = run(THREE .. "block history displacement-z position 1.5 .5 .5 name 'middle'\nhist ncycle 3\nhist zvel 0.5 .5 .5\n" .. KN ..
    "\nmodel gravity 9.81\nmodel dynamic active on\nmodel cycle 9")
check.equal(#model:histories().middle.value, 1)
check.equal(#model:histories()["2"].value, 4)
check.equal(#model:histories()["2"].value[1], 3)

-- Zones: the law of all, then of a group.
model = run(THREE .. [[
block zone generate edgelength 0.6
block zone cmodel assign elastic
block zone property density 2500 young 1e9 poisson 0.25
block zone cmodel assign mohr-coulomb range group 'b'
block zone property cohesion 1e6 friction 30 range group 'b'
]])
assert(#model:zones {} > 12)
check.equal(#model:zones { group = "b" }, #model:zones { solid = "zones 2" })
check.near(model:blocks { id = 2 }[1].density, 2500, 0)

-- ---------------------------------------------------------------- mistakes ---------------

check.equal(mistake "blok fix", "commands: unknown word 'blok'; did you mean 'block'?")
has(mistake "block creat brik 0 1", "did you mean 'brick'?")
has(mistake "model gravity down", "gravity must be a number, not 'down'")
has(mistake "block create brick 0", "x2 must be a number")
has(mistake "block fix range grop 'a'", "did you mean 'group'?")
has(mistake "block fix range group", "the group is missing")
has(mistake "block group 'a", "the quote ' is not closed")
has(mistake "model gravity 0 0 [9.81", "the bracket [ is not closed")
has(mistake "block create polyhedron", "a polyhedron needs faces")
has(mistake "block contact property stifness-normal 1e9", "unknown word 'stifness-normal'; did you mean 'stiffness-normal'?")
has(mistake "block contact property stiff 1e9", "may be stiffness-normal or stiffness-shear")
has(mistake "program call 'nowhere.dat'", "cannot be read")
has(mistake "fish define f\n a = 1", "has no end")
has(mistake "1 2 3", "begins with a word")
local _, at = mistake "block create ...\n brick 0 1\n\nblok"
check.equal(at, 4)
-- It is raised where the file has it, and what comes before is done.
local bad = assert(load(threedec.chunk(convert "block create brick 0 1\n\nblok fix"), "@test.3ddat"))
local good, why = pcall(bad)
assert(not good)
check.equal(why, "test.3ddat:3: commands: unknown word 'blok'; did you mean 'block'?")
-- So are errors of Talus, in the line of the command.
good, why = pcall(assert(load(threedec.chunk(convert "\n\nblock create brick 0 1\nblock property density -5"), "@test.3ddat")))
assert(not good and why:find("^test.3ddat:4: "), why)

-- Files that call each other: lines are those of the call, reports name the file itself.
local files = { ["dir/main.dat"] = "\ncall 'geometry'\nblock fix", ["dir/geometry.dat"] = "block create brick 0 1\n\nblok",
    ["dir/ring.dat"] = "call 'ring.dat'" }
local function read(path)
    return files[path], "no such file"
end
local result = threedec.convert("dir/main.dat", { read = read })
check.equal(result.mistakes[1].file, "dir/geometry.dat")
check.equal(result.mistakes[1].line, 3)
local chunk_lines = {}
for one in threedec.chunk(result):gmatch "([^\n]*)\n" do
    chunk_lines[#chunk_lines + 1] = one
end
has(chunk_lines[2], "model:generate")
has(chunk_lines[3], ":fix()")
has(threedec.convert("dir/ring.dat", { read = read }).mistakes[1].reason, "call each other")

-- Comments, blank lines and a summary are kept.
local script = threedec.script(convert "; a wall\n\nblock create brick 0 1 ; a brick\nplot create\nmodel large-strain on")
has(script, "-- a wall\n\nmodel:generate")
has(script, "-- a brick\n")
has(script, "-- left out: plot create -- pictures")
has(script, "-- test.3ddat: 1 command is converted, 1 more need nothing in Talus")
has(script, "-- test.3ddat:4: plot create: pictures")

-- talus.convert
check.equal(pcall(talus.convert, {}), false)
good, why = pcall(talus.convert, { file = "no/such/file" })
has(why, "convert: cannot read 'no/such/file'")
good, why = pcall(talus.convert, { fil = "x" })
has(why, "did you mean 'file'?")

-- A script never takes the place of a file that it was made of, by whatever name that is called.
local base = os.tmpname()
local function write(name, text)
    local file = assert(io.open(name, "wb"))
    file:write(text)
    file:close()
end
local function read_back(name)
    local file = assert(io.open(name, "rb"))
    local text = file:read "a"
    file:close()
    return text
end
write(base .. ".dat", "poly brick 0 1\n")
write(base .. "_main.dat", "call " .. base .. ".dat\n")
for _, one in ipairs { { base .. ".dat", base .. ".dat" }, { base .. ".dat", (base:gsub("/([^/]*)$", "/./%1")) .. ".dat" },
    { base .. "_main.dat", base .. ".dat" } } do
    good, why = pcall(talus.convert, { file = one[1], to = one[2] })
    check.equal(good, false)
    has(why, "is the data file, which the script would replace")
    check.equal(read_back(one[2]), "poly brick 0 1\n")
end
talus.convert { file = base .. ".dat", to = base .. ".lua" }
talus.convert { file = base .. ".dat", to = base .. ".lua" } -- a script of before is replaced
has(read_back(base .. ".lua"), "model:generate")
for _, ending in ipairs { "", ".dat", "_main.dat", ".lua" } do
    os.remove(base .. ending)
end
