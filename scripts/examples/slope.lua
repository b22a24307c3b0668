-- slope.lua - a rock slope with steep foliation, flat fractures and two discontinuities that cut a
-- wedge out of it.
--
--     build/release/talus scripts/examples/slope.lua [folder]
--
-- Five foliation planes (76/270) rise from the toe of the slope to the rear, three fractures
-- (12/270) lie above each other; what is in front of the slope is excavated. Two discontinuities,
-- 70/200 and 60/330, meet in a line that plunges 42 degrees out of the slope: the four pieces
-- above both slide along it when the friction falls below that of the wedge,
--
--     27.14 degrees        (vector solution for a wedge, Hoek and Bray 1977)
--
-- while the rest of the slope rests on the fractures, which dip 12 degrees: without the two
-- discontinuities it slides at that friction. What lies below the lowest fracture or behind the
-- last foliation plane is held. This is example 4 of Hart, Cundall and Lemos, Int. J. Rock Mech.
-- Min. Sci. 25 (1988) 117-125; the paper gives no dimensions, these are chosen to give its 49
-- blocks.
local talus = require "talus"

local slope = {}

slope.page_every = 5 -- of so many frames the page gets one

slope.box = { min = { 0, 0, 0 }, max = { 60, 40, 28 } } -- m
slope.toe = { 20, 20, 10 }
slope.foliation = { dip = 76, dip_direction = 270, number = 5, spacing = 6 }
slope.fracture = { dip = 12, dip_direction = 270, number = 3, spacing = 12 }
slope.D1 = { dip = 70, dip_direction = 200, origin = { 26, 22, 15 } }
slope.D2 = { dip = 60, dip_direction = 330, origin = { 38, 32, 16 } }

-- Along the dip of foliation and fractures, through the wedge.
slope.section = { dip = 90, dip_direction = 0, origin = { 0, 23, 0 } }

local DENSITY, GRAVITY = 2000, 10 -- kg/m3, m/s2
local STIFFNESS = 1e9             -- Pa/m, normal and shear
local FAILED = 0.05               -- displacement that identifies the failure, m
local AT_REST = 1e-4              -- unbalanced force ratio of equilibrium; a slide keeps it at 1e-3
local PATIENCE = 100000           -- cycles

-- The upward normal of a set, and the point `distance` from the toe along it.
local function from_toe(set, distance)
    local dip, direction = math.rad(set.dip), math.rad(set.dip_direction)
    local n = { math.sin(dip) * math.sin(direction), math.sin(dip) * math.cos(direction),
        math.cos(dip) }
    local toe = slope.toe
    return { toe[1] + distance * n[1], toe[2] + distance * n[2], toe[3] + distance * n[3] }
end

-- The planes of a set start at the toe and go on to one side (+1: along the normal).
local function cut_set(model, name, set, side)
    local middle = side * (set.number - 1) / 2 * set.spacing
    model:generate("jointset", { joint = name, dip = set.dip, dip_direction = set.dip_direction,
        spacing = set.spacing, number = set.number, origin = from_toe(set, middle) })
end

local function plane(set, distance)
    return { dip = set.dip, dip_direction = set.dip_direction, origin = from_toe(set, distance) }
end

-- The slope, with what cannot move held. `options.two_dimensional`: without D1 and D2.
function slope.build(friction, options)
    options = options or {}
    local foliation, fracture = slope.foliation, slope.fracture
    local model = talus.model { gravity = { 0, 0, -GRAVITY }, threads = options.threads }
    model:generate("box", { min = slope.box.min, max = slope.box.max, density = DENSITY })
    cut_set(model, "foliation", foliation, -1)
    cut_set(model, "fracture", fracture, 1)
    -- The excavation: in front of the slope and above its foot.
    local above = {}
    for _, block in ipairs(model:blocks { above = plane(fracture, 0) }) do
        above[block.id] = true
    end
    model:blocks { above = plane(foliation, 0), where = function(block)
        return above[block.id]
    end }:delete()
    if not options.two_dimensional then
        for _, name in ipairs { "D1", "D2" } do
            local d = slope[name]
            model:generate("joint", { joint = name, dip = d.dip, dip_direction = d.dip_direction,
                origin = d.origin })
        end
    end
    model:blocks { below = plane(fracture, 0) }:fix()
    model:blocks { below = plane(foliation, -(foliation.number - 1) * foliation.spacing) }:fix()
    model:joint("*", "coulomb", { kn = STIFFNESS, ks = STIFFNESS, friction = friction })
    return model
end

local function length(v)
    return math.sqrt(v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2)
end

-- The free blocks that have moved by more than the failure's displacement, by volume; and the
-- farthest that one of the others has moved.
function slope.moving(model)
    local volumes, still = {}, 0
    for _, block in ipairs(model:blocks { fixed = false }) do
        local d = length(block.displacement)
        if d > FAILED then
            volumes[#volumes + 1] = block.volume
        else
            still = math.max(still, d)
        end
    end
    table.sort(volumes)
    return volumes, still
end

-- Runs by `go`, "solve" or "relax", until `pieces` blocks have failed (true), or the slope is at rest or
-- patience ends (false).
local function fails(model, go, pieces)
    local free = model:blocks { fixed = false }
    local run = model[go](model, { ratio = AT_REST, stop_at_failure = false, max_cycles = PATIENCE, every = 20,
        stop = function()
            local count = 0
            for _, block in ipairs(free) do
                count = count + (length(block.displacement) > FAILED and 1 or 0)
            end
            return count >= pieces
        end })
    return run.reason == "stop", run
end

-- As the paper's run: from a cold start until the failure is identified.
function slope.identify(friction, pieces, options)
    local model = slope.build(friction, options)
    model:damping "adaptive"
    model:mass_scaling(true)
    model:timestep { rule = "body", fraction = 0.5 }
    local failed, run = fails(model, "solve", pieces)
    local volumes, still = slope.moving(model)
    return { model = model, failed = failed, run = run, volumes = volumes, still = still }
end

-- Lowers the friction over the given degrees, at rest each time. Gives the last that holds, and the
-- first that does not; nil where there is none. The third value is a friction at which neither is found
-- within the cycles given: it ends the search.
function slope.bracket(frictions, options)
    local model = slope.build(frictions[1], options)
    local held
    for _, friction in ipairs(frictions) do
        model:joint("*", { friction = friction })
        local failed, run = fails(model, "relax", 1)
        if failed then
            return held, friction
        end
        if run.reason ~= "rest" then
            return held, nil, friction
        end
        held = friction
    end
    return held
end

-- The collapse in `frames` pictures after the first, whole and in section, as files for ParaView, and
-- every fifth as a page.
function slope.film(friction, frames, name)
    local model = slope.build(friction)
    model:timestep { rule = "body", fraction = 0.3 }
    local interval = 0.1 -- s
    for frame = 0, frames do
        while model.time < frame * interval do
            model:cycle(50)
        end
        model:write_vtk(name)
        model:write_section(name, slope.section)
        if frame % slope.page_every == 0 or frame == frames then
            model:write_html(name, { title = "A slope with a wedge" })
        end
    end
end

-- What was found by bracket, in a sentence.
local function tell(what, expected, held, failed, undecided)
    local found
    if undecided then
        found = string.format("neither slides nor comes to rest at %g degrees within %d cycles",
            undecided, PATIENCE)
    elseif not held then
        found = string.format("slides at %g degrees, the first friction tried", failed)
    elseif not failed then
        found = string.format("holds at %g degrees, the last friction tried", held)
    else
        found = string.format("holds at %g degrees and slides at %g", held, failed)
    end
    print(string.format("%s %s; expected %s", what, found, expected))
end

function slope.main(folder)
    local r = slope.identify(25, 4)
    print(string.format("%d blocks, %d of them held", #r.model:blocks(),
        #r.model:blocks { fixed = true }))
    print(string.format("friction 25: failure %s after %d cycles, %.2f s",
        r.failed and "identified" or "not found", r.run.cycles, r.run.wall))
    print(string.format("    %d pieces have moved more than %g m, the others less than %.4f m",
        #r.volumes, FAILED, r.still))
    tell("the wedge", "27.14", slope.bracket { 30, 27.6, 26.5 })
    tell("without D1 and D2 the slope", "12",
        slope.bracket({ 14, 12.3, 11.7 }, { two_dimensional = true }))
    slope.film(20, 20, folder .. "/slope")
    print(string.format("%s/slope.html shows the collapse in a browser,", folder))
    print(string.format("%s/slope_blocks.vtk.series shows the collapse at friction 20,", folder))
    print(string.format("%s/slope_section.vtk.series a section along the dip", folder))
end

-- A test that says require "examples.slope" wants the functions only.
if ... ~= "examples.slope" then
    slope.main(arg and arg[1] or "out/slope")
end
return slope
