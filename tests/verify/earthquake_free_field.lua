-- Free fields at the sides of a site of rigid blocks: columns that cannot be told apart, waves that leave, and statics.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require "reference_earthquakes"

local i = reference.free_field
local LEFT, BALANCE, SYMMETRY = 2e-3, 1e-8, 1e-7 -- places have roundings of 1e-8 of the motions
local PEAK, ARRIVAL = 0.01, 0.05 -- ten blocks are a lattice, not a continuum
local H, N, KN, KS, DENSITY = i.height, i.blocks, i.kn, i.ks, i.density

-- N rows and `wide` columns of blocks, in rows and columns: rows[k][j].
local function site(o)
    local model, list, rows = talus.model { gravity = { 0, 0, o.gravity or 0 } }, {}, {}
    for k = 0, N - 1 do
        for j = 0, (o.wide or N) - 1 do
            list[#list + 1] = { min = { j * H, 0, k * H }, max = { (j + 1) * H, H, (k + 1) * H }, density = DENSITY }
        end
    end
    model:generate("box", list)
    model:joint("*", "elastic", { kn = KN, ks = KS })
    model:blocks():fix(o.fix)
    for k = 1, N do
        rows[k] = {}
        for j = 1, o.wide or N do
            rows[k][j] = model:blocks { containing = { (j - 0.5) * H, H / 2, (k - 0.5) * H } }[1]
        end
    end
    return model, rows
end

local function record(size)
    local at = {}
    for k = 0, 100 do
        at[k + 1] = size * math.sin(math.pi * k / 100) ^ 2
    end
    return talus.record { at = at, dt = i.T / 100, quantity = "velocity" }
end

local function along(axis, what)
    return { axis == 1 and what or 0, axis == 2 and what or 0, axis == 3 and what or 0 }
end

-- Runs for a time: peak of all blocks, the most by which blocks of a row differ, when the middle of the top has its peak.
local function shake(model, rows, axis, time)
    local peak, apart, top, when = 0, 0, 0, 0
    local from = model.time
    while model.time < from + time do
        model:cycle(1)
        for _, row in ipairs(rows) do
            local low, high = math.huge, -math.huge
            for _, block in ipairs(row) do
                local v = block.velocity[axis]
                low, high = math.min(low, v), math.max(high, v)
            end
            apart, peak = math.max(apart, high - low), math.max(peak, high, -low)
        end
        local v = rows[N][math.ceil(#rows[N] / 2)].velocity[axis]
        if v > top then
            top, when = v, model.time - from
        end
    end
    return peak, apart, when
end

local TIME = i.T + 0.15
local UPRIGHT, TURNS = { y = true, rotation = true }, { y = true }
local cases = {
    { "SH", 2, { z = true, rotation = true }, KS }, { "P", 3, UPRIGHT, KN }, { "SV", 1, UPRIGHT, KS }, { "SV, blocks that turn", 1, TURNS },
}

figures.case("DYN.freefield", "Waves come up through the quiet base of 10 x 1 x 10 blocks between free fields: how far columns differ",
    i.source)
for _, case in ipairs(cases) do
    local name, axis, fix, stiffness = table.unpack(case)
    local model, rows = site { fix = fix }
    model:boundary { zmin = { quiet = true, input = along(axis, record(i.size)) }, xmin = "free_field", xmax = "free_field" }
    local peak, apart, when = shake(model, rows, axis, TIME)
    figures.between(name .. ": difference over peak", apart / peak, 0, i.difference)
    if stiffness then
        figures.relative(name .. ": peak at the top over that of the wave", peak / i.size, 2, PEAK)
        figures.relative(name .. ": way to the top, s", when - i.T / 2, N * H / (H * math.sqrt(stiffness / (DENSITY * H))), ARRIVAL)
    end
    figures.between(name .. ": balance", math.abs(model:energy().balance), 0, BALANCE)
end
do
    local model, rows = site { fix = { z = true, rotation = true } }
    model:boundary { zmin = { quiet = true, input = { 0, record(i.size), 0 } }, xmin = { quiet = true }, xmax = { quiet = true } }
    local peak = shake(model, rows, 2, TIME)
    figures.between("with quiet sides: peak over that of the wave", peak / i.size, 0, 2 * (1 - i.quiet_sides_lose))
end

figures.case("DYN.freefield.base", "The same on a base that follows a record, beside one column alone, and under weight with Rayleigh damping",
    i.source)
do
    local tops = {}
    for _, wide in ipairs { N, 1 } do
        local model, rows = site { fix = UPRIGHT, wide = wide }
        model:timestep { dt = 2e-4 }
        model:boundary { zmin = { velocity = { record(i.size), 0, 0 } } }
        if wide > 1 then
            model:boundary { xmin = "free_field", xmax = "free_field" }
        end
        local _, apart = shake(model, rows, 1, TIME)
        if wide > 1 then
            figures.between("driven base: difference over peak", apart / i.size, 0, i.difference)
        end
        tops[#tops + 1] = rows[N][1].velocity[1]
    end
    figures.near("driven base: top over that of one column", tops[1] / tops[2], 1, i.difference)
    local model, rows = site { fix = UPRIGHT, gravity = -10 }
    model:damping "local"
    model:boundary { zmin = "roller", xmin = "roller", xmax = "roller" }
    model:solve { ratio = 1e-11, max_cycles = 100000 }
    model:damping("rayleigh", { ratio = 0.05, from = 2, to = 20 })
    model:boundary { zmin = { quiet = true, input = { record(i.size), 0, 0 } }, xmin = "free_field", xmax = "free_field" }
    local peak, apart = shake(model, rows, 1, TIME)
    figures.between("Rayleigh damping: difference over peak", apart / peak, 0, i.difference)
end

figures.case("DYN.freefield.leave", "Waves of a row of blocks that is struck leave through free fields and base, alike on both sides", "symmetry")
do
    local model, rows = site { fix = UPRIGHT, wide = 2 * N }
    model:boundary { zmin = { quiet = true }, xmin = "free_field", xmax = "free_field" }
    model:blocks { containing = { 10 * H - 0.5, 1, 11 } }:set { velocity = { 0, 0, i.size } }
    model:blocks { containing = { 10 * H + 0.5, 1, 11 } }:set { velocity = { 0, 0, i.size } }
    model:cycle(1)
    local energy = model:energy()
    local sent = energy.kinetic + energy.stored
    local uneven, peak = 0, 0
    while model.time < 1 do
        model:cycle(1)
        for k = 1, N do
            local left, right = rows[k][1].velocity, rows[k][2 * N].velocity
            uneven = math.max(uneven, math.abs(left[1] + right[1]), math.abs(left[3] - right[3]))
            peak = math.max(peak, math.abs(left[1]), math.abs(left[3]))
        end
    end
    energy = model:energy()
    figures.between("energy left", (energy.kinetic + energy.stored) / sent, 0, LEFT)
    figures.between("left and right differ, over peak", uneven / peak, 0, SYMMETRY)
    figures.between("balance", math.abs(energy.balance), 0, BALANCE)
end
figures.finish()
