-- Relaxation against a slow run on random models, of which about half fail: 60 of them and those of which the path of the loads decides, or
-- by hand those with the seeds given.
--
--     talus --quiet tests/verify/long/relax.lua [FIRST LAST [relax|slow [margin|stick]]]
--
-- With seeds: a line for each, then a summary. `slow` only fills the file of slow answers. TALUS_RELAX_SLOW names that file, which spares
-- the slow runs, an hour for 300 models, the next time. With `margin` the friction of each model is first brought near that at which the
-- quick verdict changes, and both sides are compared: two lines a seed, hard ones.
-- With `stick` friction is 100 times as much, so that little slips and displacements can be compared.
package.path = "tests/verify/?.lua;tests/lua/?.lua;" .. package.path -- run in the source root
local relax_judge = require "relax_judge"

local MODELS = 60
-- Toppling columns and a wall that stand unless their weight is a blow; an
-- excavation whose blow throws out a block that is clamped; and a slope that fails if its weight comes slowly.
local BY_PATH = { 158, 285, 229, 253 }

local judge = relax_judge.new { slow = os.getenv "TALUS_RELAX_SLOW" }
local first, last = math.tointeger(tonumber(arg[1] or "1")), math.tointeger(tonumber(arg[2] or arg[1] or tostring(MODELS)))
local method = arg[3] or "relax"

if method == "slow" then
    for seed = first, last do
        local outcome, about = judge:slow(seed)
        print(("%4d %-8s %-10s %7d %7d steps %6.1f s %s of %d: %s"):format(seed, outcome.verdict, outcome.stage, outcome.steps,
            outcome.all, outcome.seconds, about.kind, about.blocks, about.text))
        io.stdout:flush()
    end
    return
end

local rows, seeds = {}, {}
for seed = first, last do
    seeds[#seeds + 1] = seed
end
if not arg[1] then
    table.move(BY_PATH, 1, #BY_PATH, #seeds + 1, seeds)
end
for _, seed in ipairs(seeds) do
    local near = arg[4] == "margin"
    for _, row in ipairs(near and (judge:near_margin(seed, method) or {}) or { judge:try(seed, method, arg[4] == "stick" and 100) }) do
        rows[#rows + 1] = row
        print(judge.line(row))
        io.stdout:flush()
    end
end
local sum = judge.summary(rows)
print(judge.summary_text(sum))
if arg[1] then
    return
end

local figures = require "check_figures"
figures.case("S.relax", #seeds .. " random models, of which about half fail: slopes, floors, tunnels and rooms under initial stress, stacks, columns, "
    .. "arches, walls, wedges, toppling columns, hanging blocks and joined bodies, with slivers, and laws with and without bonds. A quick way to "
    .. "rest says of each what a slow run with damping \"local\" says, but where the slow run changes its mind with 1 % of friction, when weight "
    .. "and excavation come slowly or, of brittle laws, when loads change by 5 %.", "the slow run")
figures.between("share of models that fail", sum.fails / sum.rows, 0.4, 0.6)
figures.between("models at rest that do not stand", sum.class["wrong rest"] or 0, 0, 0)
figures.between("models said to fail that stand", sum.class["wrong failure"] or 0, 0, 0)
figures.between("models of which one of the two says nothing", sum.class.undecided or 0, 0, 0.02 * #seeds)
figures.between("steps of the quick way over those of the slow one: median", sum.all.median, 0, 0.1)
figures.between("steps of the quick way over those of the slow one: worst", sum.all.worst, 0, 0.5)
figures.between("displacements where nothing slips: largest difference over the mean closure", sum.worst_off, 0, 0.05)
figures.finish()
