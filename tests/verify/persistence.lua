-- Discontinuous joints: the mean number of blocks over many seeds, and that adding a joint set changes
-- no draw of another.
package.path = "tests/verify/?.lua;scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local reference = require("reference_dynamics").persistence

local SEEDS = 200
local DEVIATIONS = 4 -- of the mean of so many seeds: one chance in 16,000 to be outside

-- Three sets normal to x, y and z, their planes spread over a unit cube.
local function set(model, k, count, persistence)
    if count == 0 then
        return
    end
    local attitude = { { 90, 90 }, { 90, 0 }, { 0, 0 } }
    model:generate("jointset", { joint = "J" .. k, dip = attitude[k][1],
        dip_direction = attitude[k][2], spacing = 1 / (count + 1), number = count,
        origin = { 0.5, 0.5, 0.5 }, persistence = persistence })
end

local function cube(seed)
    local model = talus.model { seed = seed }
    model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
    return model
end

figures.case("C.persistence", "Three sets at right angles, of which two cut only some of the blocks in "
    .. "their way: mean number of blocks over 200 seeds", reference.source)
local rows, expected, obtained = {}, {}, {}
for i, row in ipairs(reference) do
    local sum = 0
    for seed = 1, SEEDS do
        local model = cube(seed)
        set(model, 1, row.k1, 1)
        set(model, 2, row.k2, row.p2)
        set(model, 3, row.k3, row.p3)
        sum = sum + #model:blocks()
    end
    local mean = sum / SEEDS
    figures.near(string.format("mean blocks, %d planes; %d of %g; %d of %g", row.k1, row.k2, row.p2,
        row.k3, row.p3), mean, row.mean, DEVIATIONS * row.deviation / math.sqrt(SEEDS))
    rows[i], expected[i], obtained[i] = i, row.mean, mean
end
figures.plot { title = "Mean number of blocks over 200 seeds", x = "row", y = "blocks", series = {
    { name = "expected", x = rows, y = expected, style = "line" },
    { name = "obtained", x = rows, y = obtained, style = "points" },
} }

-- The traces of set 2, with and without set 3 after it: whichever blocks set 3 makes, the area of the
-- planes of set 2 that is cut stays the same.
local function cut_area(model, plane)
    local area = 0
    for _, block in ipairs(model:blocks { joint = plane }) do
        for _, face in ipairs(block.faces) do
            if face.joint == plane then
                local v, at = block.vertices, face.vertices
                local sum = { 0, 0, 0 }
                for k = 2, #at - 1 do
                    local o, p, q = v[at[1]], v[at[k]], v[at[k + 1]]
                    for c = 1, 3 do
                        local d, e = c % 3 + 1, (c + 1) % 3 + 1
                        sum[c] = sum[c] + (p[d] - o[d]) * (q[e] - o[e]) - (p[e] - o[e]) * (q[d] - o[d])
                    end
                end
                area = area + 0.5 * math.sqrt(sum[1] ^ 2 + sum[2] ^ 2 + sum[3] ^ 2)
            end
        end
    end
    return area
end

local AREA = 1e-12 -- rounding of sums of areas about 1
local compared, cut = 0, 0
for seed = 1, 10 do
    local alone, more = cube(seed), cube(seed)
    set(alone, 1, 4, 1)
    set(more, 1, 4, 1)
    set(alone, 2, 3, 0.5)
    set(more, 2, 3, 0.5)
    set(more, 3, 4, 0.5)
    for plane = 1, 3 do
        local name = "J2:" .. plane
        local first, second = cut_area(alone, name), cut_area(more, name)
        compared = compared + (math.abs(first - second) <= AREA and 1 or 0)
        cut = cut + first / 2
    end
end
figures.equal("planes of set 2 that a later set leaves as they were", compared, 30)
figures.between("share of set 2's planes that is cut", cut / 30, 0.5 - 4 * 0.5 / math.sqrt(150),
    0.5 + 4 * 0.5 / math.sqrt(150))
figures.finish()
