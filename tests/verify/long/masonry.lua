-- Vaults and domes of more than 400 stones from files of OBJ, PLY and JSON, off plane by 4 % of a stone and overlapping by 1 %, to
-- their verdicts; thrusts of those whose corners are off by 1e-4 of a stone. tests/lua/test_masonry.lua does the same with fewer stones.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local masonry = require "masonry"

local kinds = {
    { name = "barrel", stones = 400, thick = 0.4, thin = 0.3 },
    { name = "dome", stones = 400, thick = 0.4, thin = 0.08, bonded = { around = 28, rings = 16 } },
    { name = "cross", stones = 400, thick = 0.4, thin = 0.1 },
}
local formats = { { "obj" }, { "ply" }, { "json" }, { "obj", welded = true }, { "ply", welded = true } }

figures.case("L.masonry", "Barrel vault, hemispherical dome and cross vault of more than 400 stones, radius 3 m, with a thickness above and below the least "
    .. "of limit analysis, as files of OBJ, PLY and JSON: corners common to stones are moved by up to 4 % of a stone, and those of each stone by 0.5 %. "
    .. "The thick ones stand, as does a dome in bond; the thin ones fall. With corners off by up to 1e-4 of a stone their thrust on their "
    .. "supports is that of exact ones.",
    "Heyman, The Stone Skeleton: least thickness over radius 0.1075 of an arch, 0.042 of a dome")

local function verdict(list, size, format, seed)
    local path = os.tmpname() .. "." .. format[1]
    list = masonry.survey(list, { seed = seed, shared = 0.04 * size, own = 0.005 * size })
    local model, seat = masonry.model(masonry.write[format[1]](path, list, format), { flat = 0.06 * size, seat = 0.15 * size })
    os.remove(path)
    return model:relax {}.reason, #seat.beyond, #list
end

for k, kind in ipairs(kinds) do
    local wrong, beyond, fewest = 0, 0, math.huge
    for f, format in ipairs(formats) do
        for _, thick in ipairs { kind.thick, kind.thin } do
            if f <= 3 or thick == kind.thick then
                local reason, left, stones = verdict(masonry[kind.name] { thick = thick }, thick, format, 10 * k + f)
                wrong = wrong + (reason == (thick == kind.thick and "rest" or "failure") and 0 or 1)
                beyond, fewest = beyond + left, math.min(fewest, stones)
            end
        end
    end
    if kind.bonded then
        local bonded = kind.bonded
        bonded.thick, bonded.bond = kind.thick, true
        local reason, left = verdict(masonry[kind.name](bonded), 0.2, formats[1], k) -- of stones from 0.7 to 0.1 m
        wrong, beyond = wrong + (reason == "rest" and 0 or 1), beyond + left
    end
    figures.between(kind.name .. ": stones", fewest, kind.stones, 600)
    figures.between(kind.name .. ": wrong verdicts", wrong, 0, 0)
    figures.between(kind.name .. ": pairs that could not be seated", beyond, 0, 0)
end

local function thrust(kind, jitter, seed)
    local path = os.tmpname() .. ".obj"
    local list = masonry.survey(masonry[kind.name] { thick = kind.thick }, { seed = seed, own = jitter * kind.thick })
    local flat = math.max(4 * jitter * kind.thick, 1e-7)
    local model = masonry.model(masonry.write.obj(path, list), { flat = flat, weld = 1e-8, seat = 10 * flat })
    os.remove(path)
    model:relax {}
    return (masonry.thrust(model))
end

for _, kind in ipairs(kinds) do
    local exact = thrust(kind, 0, 1)
    for seed, jitter in ipairs { 1e-6, 1e-5, 1e-4 } do
        figures.relative(("%s, corners off by %g: thrust, N"):format(kind.name, jitter), thrust(kind, jitter, seed), exact, 0.01)
    end
end
figures.finish()
