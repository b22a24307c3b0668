-- reference.lua - what the verification tests compare with.
--
-- Computed independently of Talus: closed forms, half-space clipping and exact rational
-- arithmetic. Each case
-- names its source. Units SI, angles in degrees, x east, y north, z up; forces of a wedge
-- over its weight.
local reference = {}

-- `mu` is the friction coefficient at failure when both planes have the same; `FS` the factor of
-- safety of the frictions the case gives.
reference.wedge = {
    source = "Hoek and Bray (1977); Goodman and Shi (1985); E1: Hart, Cundall and Lemos "
        .. "(1988), example 1",
    ["E1.run1"] = { mode = "A and B", plunge = 37.05829541482056, trend = 155.8480721118792,
        normal = { 0.6733123018471942, 0.2421064263431546 }, mu = 0.6583077909604231 },
    ["W1"] = { mode = "A and B", plunge = 28.71051480359793, trend = 148.434948822922,
        normal = { 0.7994080650317895, 0.153846153846154 }, mu = 0.5039416053995672 },
    ["W2"] = { mode = "A and B", plunge = 44.47379176223819, trend = 164.5302760129254,
        normal = { 0.5376240320965323, 0.3272109667493154 }, mu = 0.8100769937276235 },
    ["W3"] = { mode = "A and B", plunge = 31.19651405300514, trend = 157.7324072096123,
        normal = { 0.7978552839853349, 0.4898338742276652 }, mu = 0.4022515555696533 },
    ["W4"] = { mode = "A and B", plunge = 30.78973302883215, trend = 180,
        normal = { 0.5740385350638952, 0.5740385350638952 }, mu = 0.4458663541327156 },
    ["W5"] = { mode = "A and B", plunge = 35.88450421706355, trend = 219.5638949506469,
        normal = { 0.2936869360159818, 0.6370027964700855 }, mu = 0.6298052262763701 },
    ["W6.unequal"] = { mode = "A and B", plunge = 37.05829541482056, trend = 155.8480721118792,
        normal = { 0.6733123018471942, 0.2421064263431546 }, FS = 0.9202237474781775 },
    ["W7.single"] = { mode = "A", plunge = 40.00000000000001, trend = 150,
        normal = { 0.766044443118978, 0 }, FS = 0.595876796297105 },
    ["W8.single"] = { mode = "B", plunge = 38.00000000000001, trend = 170,
        normal = { 0, 0.7880107536067219 }, FS = 0.3839824896579236 },
}

reference.roof_wedge = {
    source = "Hart, Cundall and Lemos (1988), example 2; Goodman, Shi and Boyle (1982); re-derived",
    E2 = { mu = 0.6847642727597889, settlement = 0.0003333333333333334, blocks = 8,
        volume = 0.577350269189626, centroid = { 0, 0, 0.25 },
        normal_stress = 35833.33333333333, shear_stress = 24537.3864405591,
        initial_normal_stress = 37499.99999999999, initial_shear_stress = 21650.63509461097,
            face_area = 1.154700538379252 },
    table = {
        { kn = 1e+07, ks = 1e+07, sigma = 50000, dip = 60, height = 1, mu = 0.6847642727597889,
            settlement = 0.0003333333333333334 },
        { kn = 1e+07, ks = 5e+06, sigma = 50000, dip = 60, height = 1, mu = 0.6878479283646739,
            settlement = 0.0005333333333333335 },
        { kn = 1e+07, ks = 1e+06, sigma = 50000, dip = 60, height = 1, mu = 0.6962501266068954,
            settlement = 0.001025641025641026 },
        { kn = 1e+07, ks = 2e+07, sigma = 50000, dip = 60, height = 1, mu = 0.6826649762730757,
            settlement = 0.0001904761904761905 },
        { kn = 1e+08, ks = 1e+08, sigma = 50000, dip = 60, height = 1, mu = 0.6847642727597889,
            settlement = 3.333333333333334e-05 },
        { kn = 1e+07, ks = 1e+07, sigma = 20000, dip = 60, height = 1, mu = 0.8660254037844392,
            settlement = 0.0003333333333333334 },
        { kn = 1e+07, ks = 1e+07, sigma = 100000, dip = 60, height = 1, mu = 0.6298366572977737,
            settlement = 0.0003333333333333334 },
        { kn = 1e+07, ks = 1e+07, sigma = 20000, dip = 65, height = 1, mu = 0.6703296716080952,
            settlement = 0.000281745507827133 },
        { kn = 5e+07, ks = 2e+07, sigma = 100000, dip = 55, height = 2, mu = 0.8564387543365071,
            settlement = 0.0002560349239684228 },
        { kn = 1e+07, ks = 1e+07, sigma = 50000, dip = 70, height = 1.5, mu = 0.4486512356163067,
            settlement = 0.0003420201433256688 },
        { kn = 2e+07, ks = 1e+07, sigma = 30000, dip = 50, height = 0.5, mu = 1.017758095586027,
            settlement = 0.0001516177390720681 },
        { kn = 1e+09, ks = 1e+08, sigma = 50000, dip = 60, height = 1, mu = 0.6962501266068954,
            settlement = 1.025641025641026e-05 },
    },
}

reference.incline = {
    source = "Coulomb: a = g (sin theta - mu cos theta), sticks when mu >= tan theta; g = 10",
    { theta = 30, mu = 0.3, sticks = false, acceleration = 2.401923788646683 },
    { theta = 30, mu = 0.5, sticks = false, acceleration = 0.6698729810778059 },
    { theta = 30, mu = 0.57835026919, sticks = true, acceleration = 0 },
    { theta = 45, mu = 0.2, sticks = false, acceleration = 5.656854249492379 },
    { theta = 20, mu = 0.1, sticks = false, acceleration = 2.480508812470779 },
    { theta = 60, mu = 0.8, sticks = false, acceleration = 4.660254037844385 },
    { theta = 35, mu = 0.7, sticks = false, acceleration = 0.001700053487517783 },
}

reference.coast = {
    source = "Coulomb: t = v0 / (mu g), x = v0^2 / (2 mu g); g = 10",
    { v0 = 1, mu = 0.5, time = 0.2, distance = 0.1 },
    { v0 = 2, mu = 0.3, time = 0.6666666666666666, distance = 0.6666666666666666 },
    { v0 = 0.5, mu = 0.2, time = 0.25, distance = 0.0625 },
}

reference.freefall = {
    source = "g t^2 / 2, which central differences started from rest with half a kick sum exactly",
    g = 10, dt = 0.001, steps = 1000, drop = 5.0,
}

-- Inertia at density 1 about the centroid, rows xx xy xz, yx yy yz, zx zy zz.
reference.mass = {
    source = "exact rational arithmetic over tetrahedra of the faces",
    { name = "M.unit_cube",
        vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
            { 1, 1, 1 }, { 0, 1, 1 } },
        volume = 1, centroid = { 1 / 2, 1 / 2, 1 / 2 },
        inertia = { { 1 / 6, 0, 0 }, { 0, 1 / 6, 0 }, { 0, 0, 1 / 6 } } },
    { name = "M.box_1_2_3",
        vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 2, 0 }, { 0, 2, 0 }, { 0, 0, 3 }, { 1, 0, 3 },
            { 1, 2, 3 }, { 0, 2, 3 } },
        volume = 6, centroid = { 1 / 2, 1, 3 / 2 },
        inertia = { { 13 / 2, 0, 0 }, { 0, 5, 0 }, { 0, 0, 5 / 2 } } },
    { name = "M.trirect_tetra_1_1_1",
        vertices = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
        volume = 1 / 6, centroid = { 1 / 4, 1 / 4, 1 / 4 },
        inertia = { { 1 / 80, 1 / 480, 1 / 480 }, { 1 / 480, 1 / 80, 1 / 480 }, { 1 / 480,
            1 / 480, 1 / 80 } } },
    { name = "M.tetra_2_3_4",
        vertices = { { 0, 0, 0 }, { 2, 0, 0 }, { 0, 3, 0 }, { 0, 0, 4 } },
        volume = 4, centroid = { 1 / 2, 3 / 4, 1 },
        inertia = { { 15 / 4, 3 / 10, 2 / 5 }, { 3 / 10, 3, 3 / 5 }, { 2 / 5, 3 / 5, 39 / 20 } } },
    { name = "M.regular_tetra_edge_2sqrt2",
        vertices = { { 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 }, { -1, -1, 1 } },
        volume = 8 / 3, centroid = { 0, 0, 0 },
        inertia = { { 16 / 15, 0, 0 }, { 0, 16 / 15, 0 }, { 0, 0, 16 / 15 } } },
    { name = "M.right_triangular_prism",
        vertices = { { 0, 0, 0 }, { 3, 0, 0 }, { 0, 4, 0 }, { 0, 0, 5 }, { 3, 0, 5 }, { 0, 4, 5 } },
        volume = 30, centroid = { 1, 4 / 3, 5 / 2 },
        inertia = { { 535 / 6, 10, 0 }, { 10, 155 / 2, 0 }, { 0, 0, 125 / 3 } } },
    { name = "M.square_pyramid",
        vertices = { { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 }, { -1, 1, 0 }, { 0, 0, 3 } },
        volume = 4, centroid = { 0, 0, 3 / 4 },
        inertia = { { 43 / 20, 0, 0 }, { 0, 43 / 20, 0 }, { 0, 0, 8 / 5 } } },
    { name = "M.octahedron",
        vertices = { { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { 0, 0,
            -1 } },
        volume = 4 / 3, centroid = { 0, 0, 0 },
        inertia = { { 4 / 15, 0, 0 }, { 0, 4 / 15, 0 }, { 0, 0, 4 / 15 } } },
    { name = "M.frustum_4_2_3",
        vertices = { { -2, -2, 0 }, { 2, -2, 0 }, { 2, 2, 0 }, { -2, 2, 0 }, { -1, -1, 3 }, { 1,
            -1, 3 }, { 1, 1, 3 }, { -1, 1, 3 } },
        volume = 28, centroid = { 0, 0, 33 / 28 },
        inertia = { { 6091 / 140, 0, 0 }, { 0, 6091 / 140, 0 }, { 0, 0, 248 / 5 } } },
}

-- A unit cube cut by three sets: 4 x 4 x 6 boxes. `volumes`: {volume, number of blocks of it}.
reference.ortho = {
    source = "products of (.25 .25 .25 .25), (.3 .2 .2 .3) and (.3 .1 .1 .1 .1 .3); joints "
        .. "symmetric about the origin",
    sets = {
        { joint = "J1", dip = 90, dip_direction = 90, spacing = 0.25, number = 3 },
        { joint = "J2", dip = 90, dip_direction = 0, spacing = 0.2, number = 3 },
        { joint = "J3", dip = 0, dip_direction = 0, spacing = 0.1, number = 5 },
    },
    origin = { 0.5, 0.5, 0.5 }, blocks = 96,
    volumes = { { 0.005, 32 }, { 0.0075, 32 }, { 0.015, 16 }, { 0.0225, 16 } },
    faces = 576, vertices = 768,
}

-- A block of height h and base b along a plane of dip psi, friction phi.
reference.slope = {
    source = "Bray and Goodman's limits with Sagaseta's (1986) dynamic boundary; Hoek and "
        .. "Bray, Rock Slope Engineering",
    { b = 10, h = 10, psi = 40, phi = 40.1, mode = "stable" },
    { b = 10, h = 5, psi = 40, phi = 20, mode = "sliding" },
    { b = 10, h = 20, psi = 40, phi = 42, mode = "toppling" },
    { b = 10, h = 20, psi = 40, phi = 30, mode = "toppling" },
    { b = 10, h = 30, psi = 25, phi = 35, mode = "toppling" },
    { b = 10, h = 12, psi = 30, phi = 20, mode = "sliding" },
    { b = 10, h = 40, psi = 20, phi = 15, mode = "sliding+toppling" },
    { b = 10, h = 10, psi = 50, phi = 44, mode = "sliding" },
    { b = 4, h = 10, psi = 30, phi = 27, mode = "toppling" },
}

return reference
