-- A hole that is excavated from elastic rock under two stresses, by joined blocks: a quarter of the plane.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local figures = require "check_figures"
local reference = require "reference_deformable"
local zones = require "check_zones"

local STRESS = 0.04   -- of the far stress, with 16 zones round a quarter, at 1.25 radii and more
local AT_REST = 1e-6  -- unbalanced force ratio
local SIDE, ROUND, THICK = 12, 16, 0.2 -- m: half of the square; zones round the quarter; m
local SECTORS = 8

local case = reference["DF.kirsch"]
local i = case.inputs
figures.case("DF.kirsch", "A hole is taken out of joined blocks under stress in situ: stresses on three rays. The square is 24 "
    .. "radii wide, under tractions of the far stress.", case.source)

local model = zones.model { young = i.E, poisson = i.nu }
local zone = math.pi / 2 * i.radius / ROUND
local function point(r, k)
    local a = math.pi / 2 * k / SECTORS
    return { r * math.cos(a), r * math.sin(a), 0 }
end
-- Where the ray of corner k leaves the square.
local function far(k)
    local a = math.pi / 2 * k / SECTORS
    local r = SIDE / math.max(math.cos(a), math.sin(a))
    return point(r, k)
end
local core = { { 0, 0, 0 } }
for k = 0, SECTORS do
    core[#core + 1] = point(i.radius, k)
end
model:generate("prism", { base = core, axis = { 0, 0, THICK }, density = 2500, group = "core" })
for k = 1, SECTORS do
    model:generate("prism", { base = { point(i.radius, k - 1), far(k - 1), far(k), point(i.radius, k) }, axis = { 0, 0, THICK },
        density = 2500 })
end
model:joint("*", "elastic", { kn = 1e12, ks = 1e12 })
model:blocks { group = "rock" }:join()
model:blocks():deformable { solid = "rock", zone = function(p)
    return math.max(zone, zone * math.sqrt(p[1] * p[1] + p[2] * p[2]) / i.radius)
end }
for _, wall in ipairs { { "xmin", "x" }, { "ymin", "y" }, { "zmin", "z" }, { "zmax", "z" } } do
    model:boundary { side = wall[1], roller = true }
end
model:cycle(0)
-- plane strain
local stress = { xx = i.sxx, yy = i.syy, zz = i.nu * (i.sxx + i.syy) }
model:insitu { stress = stress }
model:boundary { side = "xmax", stress = stress }
model:boundary { side = "ymax", stress = stress }
local first = model:cycle(1)
figures.near("ratio before the hole is made", first.ratio_local, 0, 1e-8)
model:blocks { group = "core" }:delete()
local result = model:relax { ratio = AT_REST }
figures.equal("comes to rest", result.reason, "rest")
model:cycle(1)

-- Stresses of the closed form at a place.
local function kirsch(r, t)
    local a, px, py = i.radius, i.sxx, i.syy
    local q, c, s = a * a / r / r, math.cos(2 * t), math.sin(2 * t)
    return (px + py) / 2 * (1 - q) + (px - py) / 2 * (1 - 4 * q + 3 * q * q) * c,
        (px + py) / 2 * (1 + q) - (px - py) / 2 * (1 + 3 * q * q) * c, -(px - py) / 2 * (1 + 2 * q - 3 * q * q) * s
end

-- The reference at points of rays; zones hold means: the mean of the differences from the closed form over the zones
-- about a point is what the point is off.
local most = -math.min(i.sxx, i.syy)
local all = model:zones {}
local x, y, wx, wy = {}, {}, {}, {}
for _, r in ipairs { 1.25, 1.5, 2, 3 } do
    for _, t in ipairs { 0, 45, 90 } do
        local wanted = case.expected.line[string.format("r%g_t%d", r, t)]
        local px, py, reach = r * math.cos(math.rad(t)), r * math.sin(math.rad(t)), 1.5 * zone * r
        local off, volume = { 0, 0, 0 }, 0
        for _, z in ipairs(all) do
            local cx, cy = z.centroid[1], z.centroid[2]
            if (cx - px) ^ 2 + (cy - py) ^ 2 < reach * reach then
                local a, s, v = math.atan(cy, cx), z.stress, z.volume
                local c, n = math.cos(a), math.sin(a)
                local sr, st, srt = kirsch(math.sqrt(cx * cx + cy * cy), a)
                off[1] = off[1] + v * (s.xx * c * c + s.yy * n * n + 2 * s.xy * c * n - sr)
                off[2] = off[2] + v * (s.xx * n * n + s.yy * c * c - 2 * s.xy * c * n - st)
                off[3] = off[3] + v * ((s.yy - s.xx) * c * n + s.xy * (c * c - n * n) - srt)
                volume = volume + v
            end
        end
        local name = string.format("r = %g, %d degrees: ", r, t)
        for k, what in ipairs { "sr", "st", "srt" } do
            figures.near(name .. what .. ", Pa", wanted[what] + off[k] / volume, wanted[what], STRESS * most)
        end
        if t == 0 then
            x[#x + 1], y[#y + 1], wx[#wx + 1], wy[#wy + 1] = r, (wanted.st + off[2] / volume) / 1e6, r, wanted.st / 1e6
        end
    end
end
figures.plot { title = "DF.kirsch: tangential stress on the ray along x", x = "distance from the axis, m", y = "stress, MPa",
    series = { { name = "closed form", x = wx, y = wy, style = "line" }, { name = "zones", x = x, y = y, style = "points" } } }
figures.finish()
