-- Laws that break the plugin interface: each is found and named, with joint, blocks and cycle; laws that do not pass.
-- program only
local talus = require "talus"
local check = require "check"

local bad = os.getenv("TALUS_BAD_PLUGIN_DIR") .. "/liar.so"
local program = os.getenv("TALUS_PROGRAM")

-- The program runs this file once more for each lie, with the plugin, and then with the arguments that `scenes` takes.
if not arg[1] then
    local function said(words, threads)
        local pipe = io.popen(string.format("'%s' --quiet --threads %d --plugin '%s' '%s' %s 2>&1", program, threads, bad,
            arg[0], words))
        local text = pipe:read("a")
        return pipe:close() or false, text
    end
    local function refused(words, ...)
        local _, first = said(words, 1)
        for _, part in ipairs { ... } do
            check.holds(first:find(part, 1, true), words .. ": '" .. part .. "' in: " .. first)
        end
        local good, text = said(words, 3)
        check.equal(good, false)
        check.equal(text, first) -- the same contact, on any number of threads
    end
    local function passes(words)
        local good, text = said(words, 2)
        check.holds(good, words .. ": " .. text)
    end

    -- Reports without an end, empty, or with codes of terminals become one line that names the plugin.
    local function mumble(law, damping, context)
        local chunk = [==[
            local talus = require "talus"
            local model = talus.model { gravity = { 0, 0, -10 } }
            model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
            model:generate("box", { min = { 0, 0, 1 }, max = { 1, 1, 2 }, density = 2000 })
            model:blocks { below = { origin = { 0, 0, 1 }, dip = 0, dip_direction = 0 } }:fix()
            for what, part in pairs {
                full = (": %s$"):format(("x"):rep(255)),
                nothing = ": no reason given %(status 8: a value that must be finite is not%)$",
                codes = [=[: one\x1b%[31m\ntwo\t]=] .. "\xc3\xbc" .. [=[\xc2\x9bthree\x7f$]=] } do
                local good, text = pcall(function()
                    model:joint("*", "mumbles", { where = LAW, what = what })
                    model:damping("mumbles", { where = DAMPING, what = what })
                    if CONTEXT:find "^generator" then
                        model:generate("mumbles", { what = what == "nothing" and what or "codes" })
                    end
                    model:cycle(5)
                end)
                if what == "full" and CONTEXT:find "^generator" then part = "" end
                assert(not good and text:find(CONTEXT .. " of plugin 'bad.mumbles'", 1, true) and text:find(part), text)
            end]==]
        chunk = chunk:gsub("LAW", '"' .. law .. '"'):gsub("DAMPING", '"' .. damping .. '"')
        chunk = chunk:gsub("CONTEXT", '("' .. context .. '")')
        local path = os.getenv("TALUS_TEST_TMP") .. "/mumble.lua"
        local file = assert(io.open(path, "w"))
        file:write(chunk)
        file:close()
        local pipe = io.popen(string.format("'%s' --quiet --plugin '%s' '%s' 2>&1", program,
            os.getenv("TALUS_BAD_PLUGIN_DIR") .. "/mumbles.so", path))
        local text = pipe:read("a")
        check.holds(pipe:close(), law .. ", " .. damping .. ": " .. text)
    end
    mumble("create", "never", "law 'mumbles'")
    mumble("update", "never", "law 'mumbles'")
    mumble("never", "create", "damping 'mumbles'")
    mumble("never", "begin", "damping 'mumbles'")
    mumble("never", "update", "damping 'mumbles'")
    mumble("never", "never", "generator 'mumbles'")

    -- What is static is refused where the joint gets the law.
    local stiffness = "joint 'J1', law 'liar' of plugin 'bad.liar': its stiffness() gives kn = "
    refused("slide negative", stiffness .. "1e+08 and ks = -1e+08 Pa/m; both must be finite and 0 or at least 1e-250")
    refused("slide not_a_number", stiffness .. "nan and")
    refused("slide infinite", stiffness .. "inf and")

    -- The rest by the step; the blocks are those of the joint J1, 2 and 3.
    local where = "law 'liar' of plugin 'bad.liar', contact of blocks 2 and 3, joint J1:1: "
    refused("slide state", "cycle 3, " .. where .. "it leaves nan in its state 'wear', which must be a finite number")
    refused("slide normal", "cycle 3, " .. where .. "the force is not a finite number: the law gives a normal force of nan N",
        "for a closure of ", "look at its properties")
    refused("slide shear", "cycle 3, " .. where .. "the force is not a finite number: the law gives a normal force of ",
        "a shear force of inf N")
    refused("tumble normal", "law 'liar' of plugin 'bad.liar', contact of blocks ", "the law gives a normal force of nan N")
    for _, scale in ipairs { 1, 1e-3, 1e3 } do -- the same model in other units of length
        refused("slide tilted 1 " .. scale, where .. "its shear force of ", " N along the normal", "common plane")
        refused("slide weak 100 " .. scale, where, " force rises by ", "Pa/m here", "upper bounds")
        refused("slide weak 20 " .. scale, where, " force rises by ", "Pa/m here")
        refused("slide weak_shear 50 " .. scale, where .. "its shear force rises by ")
        for _, scene in ipairs { "slide", "tumble" } do
            passes(scene .. " none 1 " .. scale)
            passes(scene .. " weak 5 " .. scale)
            passes(scene .. " rounding " .. scale .. " " .. scale) -- a share of the size
        end
    end
    refused("tumble weak 1e4", "law 'liar' of plugin 'bad.liar', contact of blocks ", "force rises by ")
    passes("in_situ none")
    passes("weights none")

    -- A law that fails says in which point, and need not be right: in a lane of padding, or beyond them all. The contact is
    -- one of its own, and the law is named.
    for _, point in ipairs { 0, 1, 7, 8, 31, 32, 100, 143, 144, 1e6, 4294967295, 1e49 } do
        refused("slide place " .. point, "cycle 1, " .. where .. "it fails somewhere")
    end
    return
end

-- ---------------------------------------------------------------- scenes

local lie, factor, scale = arg[2], tonumber(arg[3] or "100"), tonumber(arg[4] or "1")
local scenes = {}

local function scaled(x, y, z)
    return { x * scale, y * scale, z * scale }
end

-- kn in Pa/m: the same motion when lengths are in other units needs stiffness per area to go with the density, which
-- stays, and gravity, which is scaled.
local function model_of(gravity)
    return talus.model { gravity = scaled(table.unpack(gravity)) }
end

-- Steps one by one: one that fails leaves the state as it was, and fails again in the same way.
local function cycle(model, steps)
    for _ = 1, steps do
        local hash = model:state_hash()
        local good, why = pcall(model.cycle, model, 1)
        if not good then
            local _, again = pcall(model.cycle, model, 1)
            if model:state_hash() ~= hash or again ~= why then why = "the step has changed something: " .. why end
            error(why, 0)
        end
    end
end

-- A block on a floor, cut by J1, whose upper part slides.
function scenes.slide()
    local model = model_of { 0, 0, -10 }
    model:generate("box", { min = scaled(5, 1, 0), max = scaled(6, 2, 2), density = 2500, group = "rock" })
    model:generate("joint", { joint = "J1", dip = 20, dip_direction = 60, origin = scaled(5.5, 1.5, 1) })
    for i = 0, 2 do
        model:generate("box", { min = scaled(4 * i, 0, -1), max = scaled(4 * i + 4, 4, 0), density = 2500, group = "floor" })
    end
    model:blocks { group = "floor" }:fix()
    model:joint("*", "coulomb", { kn = 1e8 * scale, ks = 1e8 * scale, friction = 40 })
    model:joint("J1", "liar", { lie = lie, factor = factor, kn = 1e8 * scale })
    cycle(model, 200)
end

-- Blocks that fall on their corners and turn.
function scenes.tumble()
    local model = model_of { 0, 0, -10 }
    model:generate("box", { min = scaled(-4, -4, -1), max = scaled(8, 4, 0), density = 2500, group = "floor" })
    model:blocks { group = "floor" }:fix()
    for i = 0, 3 do
        model:generate("polyhedron", { density = 2500, group = "rock", vertices = {
            scaled(2 * i, 0, 0.02), scaled(2 * i + 1, 0.1, 0.2), scaled(2 * i, 1, 0.3), scaled(2 * i + 0.1, 0, 1),
            scaled(2 * i + 0.9, 0.8, 0.9) } })
    end
    model:blocks { group = "rock" }:set { angular_velocity = { 1, 2, 0.5 } }
    model:joint("*", "liar", { lie = lie, factor = factor, kn = 1e8 * scale })
    model:damping "local"
    cycle(model, 400)
end

-- A large initial force at closures that are rounding.
function scenes.in_situ()
    local model = model_of { 0, 0, -10 }
    model:generate("box", { min = { 0, 0, 0 }, max = { 3, 3, 3 }, density = 2500, group = "rock" })
    for i, set in ipairs { { 65, 33 }, { 50, 160 }, { 12, 290 } } do
        model:generate("jointset", { joint = "J" .. i, dip = set[1], dip_direction = set[2], spacing = 0.7, number = 4,
            origin = { 1.5, 1.5, 1.5 } })
    end
    model:joint("*", "liar", { lie = lie, kn = 1e8 })
    model:insitu { stress = { xx = -1e6, yy = -1e6, zz = -1e6 } }
    model:cycle(1)
end

-- The stress of the weight of cut rocks between plates. On some of their points the closure is far less than rounding of
-- the force.
function scenes.weights()
    for seed = 1, 50 do
        local model = talus.model { seed = seed, gravity = { 0, 0, -10 } }
        math.randomseed(seed)
        local wide = 2 + 8 * math.random()
        local thick = wide / 20
        model:generate("box", { min = { 0, 0, 0 }, max = { wide, wide, wide }, density = 2600, group = "rock" })
        for i, dip in ipairs { 2, 88, 86 } do
            model:generate("jointset", { joint = "J" .. i, dip = dip, dip_direction = 90 * i, dip_dev = 0.5,
                dip_direction_dev = 0.5, spacing = wide / 4, spacing_dev = wide / 20, number = 3,
                origin = { wide / 2, wide / 2, wide / 2 } })
        end
        for _, corners in ipairs { { { -thick, -thick, -thick }, { wide + thick, wide + thick, 0 } },
            { { -thick, 0, 0 }, { 0, wide, wide } }, { { wide, 0, 0 }, { wide + thick, wide, wide } },
            { { 0, -thick, 0 }, { wide, 0, wide } }, { { 0, wide, 0 }, { wide, wide + thick, wide } } } do
            model:generate("box", { min = corners[1], max = corners[2], density = 2600, group = "plate" })
        end
        model:blocks { group = "plate" }:fix()
        model:joint("*", "liar", { lie = lie, kn = 1e9 })
        model:insitu { at = { 0, 0, wide }, gradient = { zz = 26000, xx = 13000, yy = 13000 } }
        model:cycle(1)
    end
end

scenes[arg[1]]()
