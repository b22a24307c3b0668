-- Vaults and domes from files of OBJ, PLY and JSON to their verdict, with corners off: what stands by limit analysis stands, with
-- the thrust of the exact assembly, and what falls falls.
-- program only: the models are the same ones with a stock Lua.
package.path = "tests/lua/?.lua;" .. package.path -- run in the source root
local check = require "check"
local masonry = require "masonry"
local talus = require "talus"

local folder = assert(os.getenv("TALUS_TEST_TMP"))
local stem = string.format("%s/masonry_%s.", folder, tostring({}):match("0x(%x+)") or "0")

local function write(ending, list, o)
    return masonry.write[ending](stem .. ending, list, o)
end

-- ---- verdicts ----

-- The least thickness over the radius is 0.1075 for an arch and 0.042 for a dome.
local kinds = {
    { name = "barrel", make = { stones = 9, rings = 3, wide = 0.6 }, thick = 0.5, thin = 0.25 },
    { name = "dome", make = { rings = 6, around = 12 }, thick = 0.4, thin = 0.06 },
    { name = "cross", make = { stones = 3, courses = 1 }, thick = 0.5, thin = 0.12 },
}
local formats = { { "obj" }, { "ply" }, { "json" }, { "obj", welded = true }, { "ply", welded = true } }

local function assembly(kind, thick)
    local o = { thick = thick }
    for key, value in pairs(kind.make) do
        o[key] = value
    end
    return masonry[kind.name](o)
end

local function verdict(kind, thick, format, seed)
    local size = math.min(thick, 0.4)
    local list = masonry.survey(assembly(kind, thick), { seed = seed, shared = 0.04 * size, own = 0.005 * size })
    local model, seat = masonry.model(write(format[1], list, format), { flat = 0.06 * size, seat = 0.15 * size })
    check.equal(#seat.beyond, 0)
    return model:relax {}.reason
end

-- A format for each kind, and all of them with a share of 1.
for number, kind in ipairs(kinds) do
    for k = 1, check.cases(#formats) do
        local format = formats[(number + k - 2) % #formats + 1]
        for _, thick in ipairs { kind.thick, kind.thin } do
            local what = ("%s of %g m, %s%s"):format(kind.name, thick, format[1], format.welded and ", welded" or "")
            local reason = verdict(kind, thick, format, k)
            check.equal(what .. " " .. reason, what .. (thick == kind.thick and " rest" or " failure"))
        end
    end
end

-- Stones of the groins touch their neighbours' seams by an edge.
check.equal(verdict(kinds[3], kinds[3].thick, formats[1], 34), "rest")

-- ---- thrusts ----

local function thrust(kind, jitter, seed)
    local list = masonry.survey(assembly(kind, kind.thick), { seed = seed, own = jitter * 0.4 })
    local flat = math.max(4 * jitter * 0.4, 1e-7)
    local model, seat = masonry.model(write("obj", list), { flat = flat, weld = 1e-8, seat = 10 * flat })
    check.equal(#seat.beyond, 0)
    check.equal(model:relax {}.reason, "rest")
    return masonry.thrust(model)
end

for _, kind in ipairs { kinds[2], kinds[3] } do
    local exact, weight = thrust(kind, 0, 1)
    for case, jitter in ipairs(check.some { 1e-4, 1e-6, 1e-5, 1e-3 }) do
        local now, carried = thrust(kind, jitter, case)
        check.near(now, exact, (jitter <= 1e-4 and 0.01 or 0.02) * exact)
        check.near(carried, weight, 1e-3 * weight)
    end
end

-- ---- rings of a barrel that only touch: nothing moves them aside ----

do
    local list = masonry.survey(masonry.barrel { thick = 0.4, rings = 4 }, {})
    local model = masonry.model(write("obj", list), { flat = 1e-7, weld = 1e-8, seat = 1e-6 })
    check.equal(model:relax {}.reason, "rest")
    for _, block in ipairs(model:blocks()) do
        check.holds(math.abs(block.displacement[2]) < 1e-5, "a stone that moves along the vault, by " .. block.displacement[2])
    end
end

-- ---- a dome in bond: beds of neighbours are tilted against each other by half a stone's angle ----

do
    local list = masonry.survey(masonry.dome { thick = 0.4, bond = true, around = 20, rings = 10 }, {})
    local model, seat = masonry.model(write("obj", list), { flat = 0.02 })
    check.holds(#seat.beyond > 100, "pairs beyond 1 % of a stone")
    local gap, overlap = seat.gap, seat.overlap
    for _, pair in ipairs(seat.beyond) do -- half a bed of 0.5 m, tilted by 4.5 degrees and less to each side, and no stone's thickness
        check.holds(pair.overlap < 0.03 and pair.gap < 0.03, ("overlap %g, gap %g"):format(pair.overlap, pair.gap))
        gap, overlap = math.max(gap, pair.gap), math.max(overlap, pair.overlap)
    end
    local all = model:seat { gap = 1.01 * gap, overlap = 1.01 * overlap }
    check.equal(#all.beyond, 0)
    check.equal(model:relax {}.reason, "rest")
end

for _, ending in ipairs { "obj", "ply", "json" } do
    os.remove(stem .. ending)
end
