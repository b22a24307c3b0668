-- reference_dynamics.lua - what the tests of structures and of single moving blocks compare with.
--
-- Computed independently of Talus: limit equilibrium, limit analysis by linear programming, exact
-- event-driven integration and quadrature. Each case names its source. Units SI, angles in degrees.
local reference = {}

-- Block toppling on a stepped base. Lengths in m: block width dx along the base, which dips psi;
-- a1, a2 height gained and lost per block below and above the crest (block number `crest`), b the
-- height of a step. `friction` is the angle at limiting equilibrium, `modes` what each block does
-- there, from the toe (block 1) up.
reference.goodman_bray = {
    source = "R. E. Goodman and J. W. Bray, Toppling of rock slopes, ASCE Rock Engineering for "
        .. "Foundations and Slopes (1976); Hoek and Bray, Rock Slope Engineering, chapter 10",
    { name = "GB.standard", dx = 10, psi = 30, a1 = 5, a2 = 5, b = 1, n = 16, crest = 10,
        unit_weight = 25e3, thickness = 10, friction = 38.15120143337421,
        heights = { 4, 8, 12, 16, 20, 24, 28, 32, 36, 40, 34, 28, 22, 16, 10, 4 },
        modes = { "stable", "slide", "slide", "topple", "topple", "topple", "topple", "topple",
            "topple", "topple", "topple", "topple", "topple", "stable", "stable", "stable" } },
    { name = "GB.small", dx = 8, psi = 28, a1 = 4.5, a2 = 4, b = 1, n = 14, crest = 9,
        unit_weight = 25e3, thickness = 10, friction = 37.42139375943317,
        heights = { 3.5, 7, 10.5, 14, 17.5, 21, 24.5, 28, 31.5, 26.5, 21.5, 16.5, 11.5, 6.5 },
        modes = { "stable", "slide", "topple", "topple", "topple", "topple", "topple", "topple",
            "topple", "topple", "topple", "topple", "stable", "stable" } },
}

-- Semicircular arch of mean radius 1: equal voussoirs with straight sides and radial joints, on two
-- fixed springers. `thickness` is the least in which an equilibrium without sliding exists.
reference.arch = {
    source = "limit analysis by linear programming; with ever more voussoirs 0.10748 (Milankovitch, "
        .. "1907; Heyman: 0.106)",
    { name = "S.arch.11", voussoirs = 11, thickness = 0.10458916664123535 },
    { name = "S.arch.15", voussoirs = 15, thickness = 0.10606806755065919 },
    { name = "S.arch", voussoirs = 21, thickness = 0.10669480085372923 },
}

-- A running-bond wall of dry bricks, lengths in m: even courses of whole bricks, odd ones with a half
-- brick at either end. Gravity turned from straight down towards +x, along the wall, or +y, across.
reference.wall = {
    source = "limit analysis by linear programming, an upper bound for Coulomb friction; across: "
        .. "toppling, tan of the tilt = thickness / height of the wall",
    courses = 6, bricks_per_course = 4, length = 0.4, height = 0.2, thickness = 0.2, bricks = 27,
    along = { { mu = 0.3, tilt = 16.69904327392578 }, { mu = 0.5, tilt = 26.564807891845703 },
        { mu = 0.7, tilt = 31.61431121826172 } },
    across = { mu = 0.5, tilt = 9.462322208025618 },
}

-- A wedge on planes A and B (dip, dip direction) whose lower edge carries too.
reference.wedge_edge = {
    source = "Hart, Cundall and Lemos (1988), example 1, second run; springs of both faces, and of the mean "
        .. "overlap at the edge",
    A = { 40, 130 }, B = { 60, 220 },
}

-- Friction coefficient at failure of a wedge on A (dip as listed, dip direction 130) and B (60/220).
reference.dip_scan = {
    source = "Hoek and Bray (1977)", dip_direction = 130, B = { 60, 220 },
    { dip = 20, mu = 0.3425686426188372 }, { dip = 30, mu = 0.5039416053995672 },
    { dip = 39, mu = 0.6430932379831764 }, { dip = 40, mu = 0.6583077909604231 },
    { dip = 41, mu = 0.6734927433248323 }, { dip = 60, mu = 0.9682458365518539 },
    { dip = 80, mu = 1.3811834186873106 },
}

-- Blocks after three sets at right angles to each other: k planes of a set cross a box, and a block in a
-- plane's way is cut with the set's persistence (set 1: always).
reference.persistence = {
    source = "every meeting of block and plane an independent draw: the number after two sets is "
        .. "binomial; mean (k1 + 1)(1 + p2 k2)(1 + p3 k3)",
    { k1 = 9, k2 = 7, p2 = 0.5, k3 = 0, p3 = 0, mean = 45, deviation = 4.183300132670378 },
    { k1 = 9, k2 = 7, p2 = 0.5, k3 = 5, p3 = 0.3, mean = 112.5, deviation = 12.514991010783827 },
    { k1 = 19, k2 = 9, p2 = 0.25, k3 = 0, p3 = 0, mean = 65, deviation = 5.809475019311125 },
    { k1 = 4, k2 = 9, p2 = 0.8, k3 = 9, p3 = 0.8, mean = 336.2, deviation = 23.30596490171561 },
}

-- Block on a moving base: velocity of the base A / (2 pi f) sin(2 pi f t) down the dip beta.
-- `slip`: of the block against the base at the end of each cycle; `speed`: largest against the base.
reference.newmark = {
    source = "N. M. Newmark, Effects of earthquakes on dams and embankments, Geotechnique 15 (1965); "
        .. "exact integration from event to event; g = 10",
    { name = "D.newmark.1", A = 6, f = 2, mu = 0.3, beta = 0, speed = 0.3269931163620956,
        slip = { 0.027407940608694215, 0.02750071975517636, 0.02750176702615384,
            0.02750177886814658, 0.027501779002052338 } },
    { name = "D.newmark.2", A = 5, f = 1, mu = 0.2, beta = 0, speed = 0.7133653562382692,
        slip = { 0.1428535824731773, 0.1557854411470479, 0.15711119770495832,
            0.15724763009053402, 0.15726167518549133 } },
    { name = "D.newmark.3", A = 4, f = 2, mu = 0.5, beta = 20, speed = 0.3498463266958653,
        slip = { 0.0628236091333645, 0.125647218266729, 0.1884708274000935, 0.25129443653345795,
            0.3141180456668225 } },
    { name = "D.newmark.4", A = 12, f = 3, mu = 0.1, beta = 0, speed = 0.6962877357514003,
        slip = { 0.023301482165913042, 0.03992905424939931, 0.051796986074765204,
            0.060268676127466794, 0.06631634750297888 } },
}

-- Rigid block 2b wide and 2h high on a base, let go at a tilt of theta0 times alpha = atan(b / h).
-- `period`: of the first full swing without loss; `impact`: from letting go to the first impact;
-- `uplift`: least base acceleration that lifts an edge; `rectangle`, `sine`: least amplitudes of a pulse
-- of base acceleration, by its duration, that overturn the block without an impact.
reference.rocking = {
    source = "G. W. Housner, The behavior of inverted pendulum structures during earthquakes, Bull. "
        .. "Seism. Soc. Am. 53 (1963); quadrature, and integration of the nonlinear equation; g = 10",
    { name = "D.rocking.1", b = 0.5, h = 2, theta0 = 0.5, p = 1.9073631996934917,
        period = 2.7667085110388405, impact = 0.6916771277597101, uplift = 2.5,
        restitution = 0.9117647058823529,
        rectangle = { [0.3] = 5.750042848855049, [0.6] = 3.6676721024589805 },
        sine = { [0.3] = 8.86288109539938, [0.6] = 5.4258507546713615 } },
    { name = "D.rocking.2", b = 0.5, h = 1, theta0 = 0.3, p = 2.5900200641113513,
        period = 1.3973129700653595, impact = 0.34932824251633987, uplift = 5,
        restitution = 0.7,
        rectangle = { [0.3] = 9.288815163103035 }, sine = { [0.3] = 14.175376724856925 } },
}

return reference
