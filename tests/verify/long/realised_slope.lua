-- What keyblocks say of 400 realisations of a slope, and what runs of them do: whether it fails, which block, and why the two differ
-- where they do.
--
-- The slope is that of tests/bench/drawn_slope.lua, with its sides and its rear held. Keyblocks say that it fails where one of 1 m3 or
-- more has a factor below 1; a run, where such a block fails. Each difference has a cause that is tried:
--
--     pressed by neighbours   the keyblock fails when all other blocks are held: what lies on it presses it into its joints
--     wedged                  it fails alone when only the faces on which it would slide have friction: it has sunk a little between others
--     a smaller one first     what has failed does not when the unsafe keyblocks below 1 m3 are held
--     together                what has failed is an unsafe keyblock when it is joined
--     turning                 what has failed does not when its rotation is held
--     against each other      what has failed rests when it is joined: blocks push others aside
package.path = "tests/verify/?.lua;tests/bench/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"
local slope = require "drawn_slope"

local ROWS, SEED = 400, 1
local SHARE = tonumber(os.getenv "TALUS_TEST_SHARE" or 1)
local RATIO, PATIENCE = 1e-4, 50000 -- unbalanced force ratio at rest; cycles
local SCREEN = 1.2                  -- least factor up to which realisations are run

local function listed(model, ids, inside)
    return model:blocks { where = function(block) return (ids[block.id] ~= nil) == inside end }
end

-- The blocks that fail in a run, by id, and whether one of them counts; nil when the run ends otherwise. Where only smaller ones fail
-- they are deleted, and the run goes on.
local function run(model)
    local result, failed, counts
    repeat
        result, failed, counts = model:relax { ratio = RATIO, max_cycles = PATIENCE }, {}, false
        for _, block in ipairs(result.failing or {}) do
            failed[block.id] = true
            counts = counts or block.volume >= slope.smallest
        end
        if not counts then
            listed(model, failed, true):delete()
        end
    until counts or not next(failed)
    if not counts and result.reason ~= "rest" then
        return nil, false
    end
    return failed, counts
end

-- The unsafe keyblocks by id, those that count and the smaller ones; and the least factor of those that count.
local function unsafe_of(model, friction)
    local large, small, least = {}, {}, 10
    for _, key in ipairs(model:keyblocks { friction = friction }) do
        local counts = key.volume >= slope.smallest
        least = counts and math.min(least, key.safety) or least
        if key.safety < 1 then
            (counts and large or small)[key.block.id] = key
        end
    end
    return large, small, least
end

-- Why a keyblock does not fail.
local function why_held(model, key, friction)
    local alone = model:copy()
    listed(alone, { [key.block.id] = true }, false):fix()
    local smooth = alone:copy()
    if select(2, run(alone)) then
        return "pressed by neighbours"
    end
    smooth:joint("*", { friction = 0 })
    for _, face in ipairs(key.faces) do
        smooth:joint(face.joint, { friction = friction })
    end
    return select(2, run(smooth)) and "wedged" or "unexplained"
end

-- Why blocks fail that are no unsafe keyblocks.
local function why_failed(model, failed, small, friction)
    local held, joined, straight = model:copy(), model:copy(), model:copy()
    if next(small) then
        listed(held, small, true):fix()
        if not select(2, run(held)) then
            return "a smaller one first"
        end
    end
    listed(joined, failed, true):join()
    for id in pairs(unsafe_of(joined, friction)) do
        if failed[id] then
            return "together"
        end
    end
    listed(straight, failed, true):fix { rotation = true }
    if not select(2, run(straight)) then
        return "turning"
    end
    return select(2, run(joined)) and "unexplained" or "against each other"
end

local function meets(a, b)
    for id in pairs(a) do
        if b[id] then
            return true
        end
    end
    return false
end

-- One realisation: what both say, and why they differ.
local function compare(model, draw)
    local friction = slope.friction_of(draw)
    local large, small, least = unsafe_of(model, friction)
    slope.strengthen(model, friction)
    local made = model:copy()
    local failed, counts = run(model)
    local unsafe = next(large) ~= nil
    local row = { failed = counts, least = least, screened = least > SCREEN and not next(small), verdict = "agree", held = "", went = "" }
    if not failed then
        row.verdict = "undecided"
    elseif counts ~= unsafe or (counts and not meets(failed, large)) then
        row.verdict = counts == unsafe and "other block" or counts and "run only" or "keyblocks only"
        local reasons = {}
        for _, key in pairs(large) do
            reasons[why_held(made, key, friction)] = true
        end
        row.held = reasons.unexplained and "unexplained" or reasons.wedged and "wedged" or next(reasons) or ""
        row.went = counts and why_failed(made, failed, small, friction) or ""
    end
    return row
end

local N = math.max(8, ROWS // SHARE)
figures.case("PF.slope", ("%d realisations of a slope whose three joint sets are drawn anew, some 180 blocks each: whether a keyblock of 1 m3 or "
    .. "more is unsafe, whether such a block fails in a run, which, and a cause of each difference that is tried."):format(N),
    "model:keyblocks and model:relax of the same models")
local set = talus.realisations { number = N, seed = SEED, build = slope.build_held, measure = compare }
local verdicts, causes, missed = {}, {}, 0
for _, row in ipairs(set:rows()) do
    verdicts[row.verdict] = (verdicts[row.verdict] or 0) + 1
    for _, cause in ipairs { row.held, row.went } do
        causes[cause] = (causes[cause] or 0) + 1
    end
    missed = missed + (row.screened and row.failed and 1 or 0)
end
local function share(what, number, most)
    figures.between(what, number or 0, 0, most * N)
end
figures.between("rows that err", set.errors, 0, 0)
figures.between("neither at rest nor failed", verdicts.undecided or 0, 0, 0)
figures.between("the same verdict, and block", verdicts.agree, 0.8 * N, N)
share("a keyblock is unsafe, the run rests", verdicts["keyblocks only"], 0.15)
share("the run fails, no keyblock is unsafe", verdicts["run only"], 0.06)
share("both fail, by other blocks", verdicts["other block"], 0.03)
share("unsafe keyblocks that do not fail: pressed by neighbours", causes["pressed by neighbours"], 0.15)
share("... wedged", causes.wedged, 0.02)
share("failed though no unsafe keyblock: a smaller one first", causes["a smaller one first"], 0.06)
share("... several together", causes.together, 0.01)
share("... turning", causes.turning, 0.01)
share("... against each other", causes["against each other"], 0.01)
figures.between("without a cause that is known", causes.unexplained or 0, 0, 0)
figures.between(("fails though no keyblock is below %g, nor a smaller one below 1"):format(SCREEN), missed, 0, 0)
figures.finish()
