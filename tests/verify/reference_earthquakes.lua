-- reference_earthquakes.lua - what the tests of earthquakes compare with.
--
-- Computed independently of Talus: statics, exact lattices, and integration of Newmark's block with sub-steps. Each case
-- names its source. Units SI, angles in degrees.
local reference = {}

-- The accelerogram of Newmark's cases, of which some samples are listed: the sum of 60 sines of frequencies f from 0.3 to
-- 12 Hz, spaced geometrically, with phases 2 pi r and amplitudes f / (f + 0.5) / (1 + (f / 4)^2). The envelope is (t / 2)^2 up
-- to 2 s, 1 to 8 s and exp(-0.35 (t - 8)) after. It is scaled to a peak, `scaled_to`; then a parabola that fits its velocity
-- best is taken off. r: x / 2^31 of x <- (1103515245 x + 12345) mod 2^31 from `seed` on.
function reference.accelerogram(seed, scaled_to)
    local x, samples, peak = seed, {}, 0
    local phase, frequency = {}, {}
    for i = 1, 60 do
        x = (1103515245 * x + 12345) % 2147483648
        phase[i], frequency[i] = 2 * math.pi * x / 2147483648, 0.3 * 40 ^ ((i - 1) / 59)
    end
    for k = 0, 4000 do
        local t, sum = 0.005 * k, 0
        for i = 1, 60 do
            local f = frequency[i]
            sum = sum + f / (f + 0.5) / (1 + (f / 4) ^ 2) * math.sin(2 * math.pi * f * t + phase[i])
        end
        local envelope = t < 2 and (t / 2) ^ 2 or t < 8 and 1 or math.exp(-0.35 * (t - 8))
        samples[k + 1] = sum * envelope
        peak = math.max(peak, math.abs(samples[k + 1]))
    end
    for k = 1, #samples do
        samples[k] = samples[k] * scaled_to / peak
    end
    return samples
end

-- A block on a plane of dip `dip` that dips to +x; the ground moves along x. `slip`: down the dip in the end; `total`: of
-- slip either way.
reference.newmark = {
    source = "N. M. Newmark, Effects of earthquakes on dams and embankments, Geotechnique 15 (1965); integration with 50 "
        .. "sub-steps a sample; g = 9.81",
    { name = "DYN.newmark.level", seed = 3, mu = 0.2, dip = 0, scaled_to = 3.5, peak = 3.4966107272, slip = -0.0469214830872,
        total = 0.0818902871226, samples = { [0] = -0.00500986605549, [200] = 0.657521997159, [1000] = 1.05487624844,
            [2000] = -0.464992158918, [3999] = -0.0222538324182 } },
    { name = "DYN.newmark.slope", seed = 3, mu = 0.8, dip = 30, scaled_to = 3.5, peak = 3.4966107272,
        slip = 0.0924757700056, total = 0.0924757700056, samples = {} },
    { name = "DYN.newmark.slope2", seed = 11, mu = 0.7, dip = 25, scaled_to = 4, peak = 4.00497050494,
        slip = 0.215487117287, total = 0.215487117287, samples = { [0] = -0.00911124231322, [200] = -0.0342659193356,
            [1000] = -0.311931383427, [2000] = -0.724043563354, [3999] = -0.0207855192146 } },
}

-- Fractions of critical damping by frequency, Hz.
reference.rayleigh = {
    source = "Rayleigh, The Theory of Sound (1877)", from = 2, to = 10, ratio = 0.05, alpha = 1.0471975512,
    beta = 0.00132629119243,
    { 1, 0.0875 }, { 2, 0.05 }, { 4.47213595499958, 0.037267799625 }, { 10, 0.05 }, { 20, 0.0875 },
}

-- A column of rigid blocks that shear against each other and a held base: frequencies of the lattice, 2 (k/m)^(1/2)
-- sin((2 n - 1) pi / (2 (2 N + 1))) / (2 pi).
reference.site = {
    source = "exact lattice; S. L. Kramer, Geotechnical Earthquake Engineering (1996)", blocks = 20, height = 2,
    density = 2500, ks = 1e9, f1 = 5.45249023021, f2 = 16.3254733099,
}

-- Surface over outcrop of an undamped layer of soil of 40 m on rock: 1 / |cos(k H) + i a sin(k H)|, a the ratio of impedances
-- of soil and rock.
reference.amplification = {
    source = "J. M. Roesset, in: Numerical Methods in Geotechnical Engineering (1977); S. L. Kramer, Geotechnical "
        .. "Earthquake Engineering (1996)",
    blocks = 20, height = 2, density = 2500, speed = 894.427191, impedance_ratio = 0.25,
    { frequency = 1, ratio = 1.03812121412 }, { frequency = 2, ratio = 1.16737754614 },
    { frequency = 5.5901699437494745, ratio = 4 }, { frequency = 6, ratio = 3.65445897594 },
    { frequency = 16.77050983124842, ratio = 4 },
}

-- A block of b along a plane of dip `dip` and h across it, pushed by kh times its weight out of the slope. The water behind
-- it, to a height `water`, and below it push with V and U.
reference.kh = {
    source = "statics", unit_weight = 25e3,
    { name = "KH.block.squat", b = 2, h = 1, dip = 15, friction = 35, kh = 0.363970234266, tips = false },
    { name = "KH.block.slender", b = 1, h = 3, dip = 5, friction = 40, kh = 0.238878289056, tips = true },
    { name = "KH.block.slender_water", b = 1.5, h = 3, dip = 5, friction = 40, water = 1.5, V = 11207.1903535,
        U = 11207.1903535, kh = 0.299413684907, tips = true },
}

-- Energy that a row of rigid blocks sends back from its end, by blocks a wave: exact for the lattice, with a dashpot behind a
-- spring of 2 k, and with the dashpot on the block. Then that of a plane dashpot by the angle between the wave and its normal,
-- r = (cos a - 1) / (cos a + 1). Then a column on a quiet base, with the wave 0.1 sin^2(pi t / T) coming in.
reference.quiet = {
    source = "J. Lysmer and R. L. Kuhlemeyer, J. Eng. Mech. Div. ASCE 95 (1969); exact lattice",
    reflection = { { blocks = 6, series = 0.00515477614287, dashpot = 0.0717967697245 },
        { blocks = 8, series = 0.00156547863499, dashpot = 0.0395661298966 },
        { blocks = 10, series = 0.000629288879503, dashpot = 0.0250856309369 } },
    oblique = { { angle = 30, energy = 0.00515477614287 }, { angle = 45, energy = 0.0294372515229 },
        { angle = 60, energy = 0.111111111111 } },
}
reference.input = {
    source = "W. B. Joyner and A. T. F. Chen, Bull. Seism. Soc. Am. 65 (1975)", blocks = 20, height = 2, density = 2500,
    ks = 1e9, size = 0.1, T = 0.4, peak = 0.2, arrival = 0.04472135955,
}

-- Ground that is the same everywhere and goes on for ever cannot tell its columns apart: 10 x 1 x 10 blocks, the wave
-- size sin^2(pi t / T) coming in. Quiet sides in the place of free fields lose at least that part of the peak.
reference.free_field = {
    source = "symmetry; P. A. Cundall, H. Hansteen, S. Lacasse and P. B. Selnes, NESSI, Norwegian Geotechnical Institute, "
        .. "report 51508-9 (1980)",
    blocks = 10, height = 2, density = 2500, kn = 2.5e9, ks = 1e9, size = 1e-3, T = 0.1, difference = 1e-6,
    quiet_sides_lose = 0.2,
}

-- A bar of zones, and pulses of so many metres: quiet faces leave at most that part of the energy.
reference.quiet_zones = {
    source = "J. Lysmer and R. L. Kuhlemeyer, J. Eng. Mech. Div. ASCE 95 (1969); W. B. Joyner and A. T. F. Chen, "
        .. "Bull. Seism. Soc. Am. 65 (1975)",
    E = 1e10, nu = 0.25, rho = 2500, zone = 1, length = 40, pulse = 24, size = 1e-3, left = 1e-3,
}

return reference
