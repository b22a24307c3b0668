-- reference_site.lua - what the tests of data of the site and of realisations compare with.
--
-- Computed independently of Talus: closed forms, integrals and Monte Carlo of other random numbers (numpy, scipy). Each
-- case names its source. SI, angles in degrees, x east, y north, z up.
local reference = {}

-- A prism that slides on a plane, 1 m wide: its front is x = 2, its rear x = 10 a crack, its top z = 12. V and U are
-- thrust and uplift of the water when the crack is full.
reference.plane = { source = "Hoek and Bray (1977), chapter 7",
    dip = 35, dip_direction = 270, density = 2500, gravity = 10, weight = 1559750.95415, area = 9.76619671009,
    V = 124896.252431, U = 244053.574803,
    crack = 4.9979246179, safety_dry_40 = 1.19835846572, safety_full_45 = 0.964929520324 }

reference.probability = {
    -- Friction normal(40, 3) in [0, 90], dry, without cohesion: a distribution function.
    friction = { source = "one random variable: its distribution function", mean = 40, sd = 3,
        probability = 0.0477903522728, critical = 35 },
    -- Friction normal(40, 3), cohesion lognormal of mean 15 kPa and deviation 5 kPa,
    -- depth of water uniform up to the full crack.
    three = { source = "double integral, and Monte Carlo of 400,000", friction = { 40, 3 }, cohesion = { 1.5e4, 5e3 },
        probability = 0.141487005017, mean = 1.18926356301, sd = 0.171723223569,
        correlation = { friction = 0.641759411357, cohesion = 0.306171269689, water = -0.69463541364 } },
    -- {hits, of, low, high} with 95 %.
    interval = { source = "Clopper and Pearson (1934)",
        { 0, 1, 0, 0.975 },
        { 1, 1, 0.025, 1 },
        { 1, 2, 0.0125791170934, 0.987420882907 },
        { 1, 3, 0.00840375865961, 0.905700675950 },
        { 5, 5, 0.478176249895, 1 },
        { 0, 100, 0, 0.0362166926452 },
        { 100, 100, 0.963783307355, 1 },
        { 1, 1000, 2.53174874913e-05, 0.00555892427983 },
        { 3, 200, 0.00310410762155, 0.0432082819177 },
        { 50, 1000, 0.0373353976047, 0.0653904879155 },
        { 120, 10000, 0.00995893343186, 0.0143321689906 },
    },
}

-- {cohesion, friction at which the factor of safety is 1}, the crack full of water.
reference.back = { source = "inverse of the plane's factor of safety",
    { 0, 46.0225186814 },
    { 10000, 43.0706632029 },
    { 20000, 39.8045082416 },
}

-- Poles after Fisher: R / N, angles from the mean below which a share of the poles is, and the mean of |cos| of them.
reference.fisher = { source = "Fisher (1953)",
    { kappa = 5, resultant = 0.800090803982, angles = { { 0.5, 30.5281560937 }, { 0.9, 57.3459900439 }, { 0.99, 85.4193166094 } },
        cosine = 0.80267714037 },
    { kappa = 20, resultant = 0.95, angles = { { 0.5, 15.128563802 }, { 0.9, 27.7643806247 }, { 0.99, 39.6693193828 } },
        cosine = 0.950000000206 },
    { kappa = 80, resultant = 0.9875, angles = { { 0.5, 7.54778358806 }, { 0.9, 13.7799514801 }, { 0.99, 19.5353480984 } },
        cosine = 0.9875 },
}

-- Radii with a density proportional to r^-(1 + a) on [min, max].
reference.power_law = { source = "closed form",
    { exponent = 2.5, min = 1, max = 20, mean = 1.64895456048, mean_square = 3.88413731001, median = 1.31921297524 },
    { exponent = 3, min = 0.5, max = 50, mean = 0.749925749926, mean_square = 0.742500742501, median = 0.629960314961 },
    { exponent = 2, min = 1, max = 10, mean = 1.81818181818, mean_square = 4.65168705655, median = 1.40719508946 },
}

-- Discs with Poisson centres in a box of 20 m grown by the largest radius.
reference.baecher = { source = "Baecher, Lanney and Einstein (1977); Dershowitz and Herda (1992)",
    p30 = 0.05, exponent = 2.5, min = 1, max = 6, kappa = 20, box = 20, p32 = 0.470091653465, p10 = 0.446587070889,
        deviation = 0.0405885208465 }

return reference
