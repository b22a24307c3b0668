-- Damping of contacts: the fraction of critical damping of one block on its joint by Rayleigh's formula, pressed and sheared;
-- heat in the ledger.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require("reference_earthquakes").rayleigh

local DENSITY, RATIO, BALANCE = 2000, 0.01, 1e-3
local GRAVITY = 0.02 -- m/s2: at 1 Hz the block sinks in by half a millimetre

-- A cube of 1 m that vibrates with `frequency` along `axis`, and does not turn.
local function vibrate(frequency, axis)
    local k = (2 * math.pi * frequency) ^ 2 * DENSITY
    local model = talus.model { gravity = { 0, 0, -GRAVITY } }
    model:generate("box", { min = { -2, -2, -1 }, max = { 3, 3, 0 }, density = DENSITY, group = "base" })
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = DENSITY, group = "block" })
    local base, block = model:blocks { group = "base" }, model:blocks { group = "block" }
    base:fix()
    block:fix { rotation = true }
    model:joint("*", "coulomb", { kn = k, ks = k, friction = 80 })
    model:damping "local"
    model:solve { ratio = 1e-10 }
    block:reset_displacement()
    model:damping("rayleigh", { ratio = reference.ratio, from = reference.from, to = reference.to })
    model:timestep { fraction = 0.02 }
    -- far less than the block has sunk in
    local v = { 0, 0, 0 }
    v[axis] = 0.1 * GRAVITY * DENSITY / k * 2 * math.pi * frequency
    block:set { velocity = v }
    -- Turning points; the way from one to the next does not depend on where the middle lies.
    local turns, before, last, worst = {}, 0, 0, 0
    while #turns < 12 do
        model:cycle(1)
        local u = block[1].displacement[axis]
        if (last - before) * (u - last) < 0 then
            turns[#turns + 1] = last
        end
        before, last = last, u
        worst = math.max(worst, math.abs(model:energy().balance))
    end
    local decrement = math.log((turns[1] - turns[2]) / (turns[11] - turns[12])) / 5
    return decrement / math.sqrt(4 * math.pi ^ 2 + decrement ^ 2), worst
end

figures.case("DYN.rayleigh", "One block on its joint, set off across the joint and along it: fraction of critical damping by "
    .. "logarithmic decrement", reference.source)
for _, row in ipairs(reference) do
    for axis, name in pairs { [3] = "across", [1] = "along" } do
        local ratio, worst = vibrate(row[1], axis)
        figures.relative(string.format("%g Hz, %s the joint", row[1], name), ratio, row[2], RATIO)
        figures.between("worst energy balance, of the largest term", worst, 0, BALANCE)
    end
end
figures.finish()
