-- report_titles.lua - what the cases of docs/verification.md are, in a few words: of an id the title, or nil. The first pattern
-- that fits the whole id counts; %1 and so on are its captures.
local TITLES = {
    { "C.fig2%.(%w+)%.cube2", "cube of 2 m cut by three sets, as in figure 2 of the paper, %1 values" },
    { "C.fig2%.(%w+)%.unit", "unit cube cut by three sets, as in figure 2 of the paper, %1 values" },
    { "C.ortho", "cutting by three sets at right angles" },
    { "C.persistence", "joint sets that cut only some blocks" },
    { "D.bounce%.(%d)", "cube that falls flat and bounces, case %1" },
    { "D.coast", "cube that slides to rest on a level plane" },
    { "D.collapse", "dominoes and piles that fall, in one energy" },
    { "D.freefall", "free fall" },
    { "D.impact%.(%d+)%.(%d+)", "smooth cube that falls turned by %1 and %2 degrees" },
    { "D.impacts", "impacts without friction keep their energy" },
    { "D.incline", "cube on an incline that sticks or slides" },
    { "D.invariance", "falling blocks in other axes, units and places" },
    { "D.meet%.([%d.]+)", "two free cubes that meet, one turned by %1 degrees" },
    { "D.newmark%.(%d)", "block that slips on a shaken base, case %1" },
    { "D.rocking%.(%d)", "block that rocks on its edges, case %1" },
    { "D.spin.spherical", "spin with a single moment of inertia" },
    { "D.top%.(%w+)", "box that spins freely about its %1 axis" },
    { "D.tray", "stones that fall into a tray" },
    { "E1.dipscan", "paper's wedge, friction at failure over the dip of a plane" },
    { "E1.run(%d)", "paper's wedge, run %1" },
    { "E2", "paper's roof pyramid, cut and under stress" },
    { "E2.table", "roof pyramids, friction at failure" },
    { "E3", "paper's tunnel under three faults" },
    { "E4", "paper's slope of 49 blocks" },
    { "GB%.(%w+)", "toppling columns of Goodman and Bray, %1" },
    { "GB%.(%w+)%.corners", "toppling columns of Goodman and Bray, %1, forces at corners" },
    { "M%.(.+)", "mass and inertia of a block: %1" },
    { "P.adaptive%.([%d.]+)", "adaptive damping, target %1" },
    { "P.combined%.([%d.]+)", "combined damping, alpha %1" },
    { "P.kinetic", "kinetic damping" },
    { "P.local%.([%d.]+)", "local damping, alpha %1" },
    { "P.viscous%.(%d)", "viscous damping, case %1" },
    { "S.arch", "least thickness of an arch of 21 voussoirs" },
    { "S.arch%.(%d+)", "least thickness of an arch of %1 voussoirs" },
    { "S.block_on_slope", "block on an incline that slides, topples or both" },
    { "S.eq5", "shear force of a joint that turns with its blocks" },
    { "S.rest", "piles, arch and beam that come to rest" },
    { "S.series", "two joints in series between plates" },
    { "S.shear", "joint sheared to and fro" },
    { "S.stack%.(%d+)", "%1 cubes on each other at rest" },
    { "S.tension", "bonded joint pulled apart" },
    { "S.wall", "dry brick wall on a tilting table" },
    { "T.chain.3", "three cubes at the critical time step" },
    { "T.eq27", "critical time step of equation (27)" },
    { "W(%d)", "wedge %1, friction at failure" },
    { "W(%d).unequal", "wedge %1, unequal frictions, friction at failure" },
    { "W(%d).single", "wedge %1, on a single plane, friction at failure" },
    { "common_volume", "nothing presses without a common volume" },
    { "determinism", "the same bits on any number of threads" },
    { "keyblock E1.run1", "keyblock: the paper's wedge" },
    { "keyblock E2", "keyblock: pyramid in a roof" },
    { "keyblock E3", "keyblock: wedge in a tunnel's roof" },
    { "keyblock W(%d)[%w.]*", "keyblock: wedge %1" },
    { "press", "two pressed blocks push each other apart" },
    { "quickstart", "the first example" },
    { "topple", "column that topples, rigid and elastic" },
    { "wedge, closed forms", "the wedge example and its closed forms" },
}

return function(id)
    for _, row in ipairs(TITLES) do
        local captures = { id:match("^" .. row[1] .. "$") }
        if captures[1] then
            return (row[2]:gsub("%%(%d)", function(k)
                return (captures[tonumber(k)]:gsub("_", " "))
            end))
        end
    end
end
