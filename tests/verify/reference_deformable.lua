-- reference_deformable.lua - what the tests of deformable blocks must obtain: closed forms and independent
-- calculations, with their inputs and sources. SI units, angles in degrees; stress and strain tension positive, six
-- components in the order xx yy zz xy yz zx with shear strains of the tensor; pressures, far stresses and strengths
-- compression positive.
local solids = require "solid_reference"

local reference = {}

-- Those that one zone alone answers are those of the tests of solids.
for name, case in pairs(solids) do
    reference["DF." .. name] = case
end

reference["DF.patch_affine"] = {
    source = "patch test, Irons 1966",
    inputs = {
        E = 10000000000.0,
        nu = 0.25,
        gradient = {
            { 1.2301533574825744e-06, 0.00029874553750846986, -0.00027413785536221756 },
            { -0.0008905918387572742, -0.00045467078517172257, -0.0009916465549964623 },
            { 6.0143602597438484e-05, 0.0013402152455545336, -0.0004922065185513296 },
        },
    },
    expected = {
        stress_per_unit = {
            { -3772747.3746024184, -2367385.2049952173, -855977.0110591162 },
            { -2367385.2049952173, -7419954.88283606, 1394274.7622322852 },
            { -855977.0110591162, 1394274.7622322852, -7720240.749872915 },
        },
    },
}

reference["DF.rotation"] = {
    source = "Hughes and Winget 1980",
    inputs = { turns = 10, steps_per_turn = { 60, 600 }, stress = { -1000000.0, 0, 500000.0, 200000.0, 0, 0 } },
    expected = { stress = "as before, in the axes of the body" },
}

reference["DF.spinning_bar"] = {
    source = "rod theory",
    inputs = { E = 10000000000.0, nu = 0.0, rho = 2500.0, length = 2.0, omega = 20.0 },
    expected = { stress_middle = 500000.0, elongation = 6.666666666666667e-05 },
}

reference["DF.cantilever"] = {
    source = "Timoshenko 1921, Cowper 1966",
    inputs = { E = 10000000000.0, nu = 0.25, length = 8.0, side = 1.0, end_load = 100000.0 },
    expected = { tip = 0.020716000000000002, tip_bernoulli = 0.02048 },
}

-- The same case for each Poisson's ratio, dilation or number of joints: what differs is in rows.
local function each(rows, put)
    for _, row in ipairs(rows) do
        put(table.unpack(row))
    end
end

each({
    { 0.25, { 30.506024229117163, 77.51824599542104, 138.16263878607285 } },
    { 0.49, { 30.396161198699314, 76.64849700461309, 135.51677080350967 } },
}, function(nu, bending)
    reference["DF.beam_modes_nu" .. nu] = {
        source = "Timoshenko beam, free-free; roots of the exact determinant",
        inputs = { E = 10000000000.0, nu = nu, rho = 2500.0, length = 8.0, side = 1.0, support = "none" },
        expected = { bending_hz = bending, axial_hz = 125.0, rigid_modes = 6 },
    }
end)

each({
    { 0.3, 0.0014213333333333335, 57777.77777777778 },
    { 0.49, 0.00159132, 66222.22222222222 },
    { 0.499, 0.0015991332, 66622.22222222222 },
}, function(nu, wall, mean)
    reference["DF.lame_nu" .. nu] = {
        source = "Lame 1852",
        inputs = { E = 1000000000.0, nu = nu, inner = 1.0, outer = 4.0, pressure = 1000000.0, plane = "strain" },
        expected = { u_inner = wall, mean_stress = mean, sr_r2 = -200000.0, st_r2 = 333333.3333333334 },
    }
end)

reference["DF.kirsch"] = {
    source = "Kirsch 1898; finite square: Kirsch within 2 (a/L)^2",
    inputs = {
        E = 7000000000.0,
        nu = 0.2,
        radius = 1.0,
        sxx = -10000000.0,
        syy = -20000000.0,
        domain = "square 20 x 20 or more, far stress as tractions, excavated from in situ stress",
    },
    expected = {
        wall_0deg = -50000000.0,
        wall_90deg = -10000000.0,
        line = {
            ["r1.25_t0"] = { sr = -7056000.000000001, st = -35744000.0, srt = -0.0 },
            ["r1.25_t45"] = { sr = -5400000.0, st = -24600000.000000004, srt = -5256000.000000002 },
            ["r1.25_t90"] = { sr = -3743999.999999999, st = -13456000.000000006, srt = -6.436743576318491e-10 },
            ["r1.5_t0"] = { sr = -9259259.25925926, st = -29629629.62962963, srt = -0.0 },
            ["r1.5_t45"] = { sr = -8333333.333333334, st = -21666666.666666668, srt = -6481481.481481481 },
            ["r1.5_t90"] = { sr = -7407407.407407409, st = -13703703.703703705, srt = -7.937525550029141e-10 },
            r2_t0 = { sr = -10312500.0, st = -24687500.0, srt = -0.0 },
            r2_t45 = { sr = -11250000.0, st = -18750000.0, srt = -6562500.0 },
            r2_t90 = { sr = -12187500.0, st = -12812500.0, srt = -8.036744619404505e-10 },
            r3_t0 = { sr = -10370370.37037037, st = -21851851.85185185, srt = -0.0 },
            r3_t45 = { sr = -13333333.333333332, st = -16666666.666666668, srt = -5925925.925925926 },
            r3_t90 = { sr = -16296296.296296295, st = -11481481.481481483, srt = -7.257166217169501e-10 },
        },
        u_r_wall = { ["0"] = -0.0006857142857142857, ["45"] = -0.0025714285714285713, ["90"] = -0.0044571428571428574 },
    },
}

each({
    { 30, 0.02810346291398272, 0.029552747254938977 },
    { 0, 0.012167121237129217, 0.012644858860956776 },
}, function(dilation, wall, wall_outer10)
    reference["DF.salencon_psi" .. dilation] = {
        source = "Salencon 1969; displacement also by an ODE, the two agree to 1e-9",
        inputs = {
            K = 3900000000.0,
            G = 2800000000.0,
            cohesion = 3450000.0,
            friction = 30.0,
            dilation = dilation,
            far = 30000000.0,
            radius = 1.0,
            outer = 10.0,
        },
        expected = {
            plastic_radius = 1.7349981445793943,
            wall = wall,
            plastic_radius_outer10 = 1.7484115837652119,
            wall_outer10 = wall_outer10,
        },
    }
end)

reference["DF.prandtl"] = {
    source = "Prandtl 1920",
    inputs = {
        E = 200000000.0,
        nu = 0.3,
        cohesion = 100000.0,
        friction = 0.0,
        half_width = 2.0,
        domain = { 10.0, 5.0 },
        footing = "rough, driven; load over half width + half a zone",
    },
    expected = { q_over_c = 5.141592653589793 },
}

each({
    { 10, 8.344926109310922, 2.4714356250900327 },
    { 20, 14.834711777931204, 6.399393521085211 },
    { 30, 30.139627791519086, 18.401122218708668 },
}, function(friction, Nc, Nq)
    reference["DF.prandtl_phi" .. friction] = {
        source = "Prandtl, Reissner 1924",
        inputs = { friction = friction, dilation = friction, weightless = true },
        expected = { Nc = Nc, Nq = Nq },
    }
end)

reference["DF.gravity_column"] = {
    source = "Hooke",
    inputs = { E = 10000000000.0, nu = 0.25, rho = 2500.0, height = 10.0, g = 10.0, sides = "rollers", base = "held" },
    expected = { szz_base = -250000.0, settlement = 0.00010416666666666667, k0 = 0.3333333333333333 },
}

reference["DF.insitu_rest"] = {
    source = "equilibrium of a uniform stress",
    inputs = {
        blocks = "any: cubes, Voronoi cells, dispersed joints, tunnel; zones of any size",
        stress = { -5000000.0, -8000000.0, -3000000.0, 1000000.0, 0, 500000.0 },
        gradient = "with weight: zz, xx, yy by depth",
        outer = "same stress as tractions, or held",
    },
    expected = { unbalanced_ratio = 0.0 },
}

each({
    { 1, 0.00021666666666666666 },
    { 3, 0.00031666666666666665 },
    { 9, 0.0006166666666666666 },
}, function(joints, shortening)
    reference["DF.series_column_" .. joints] = {
        source = "springs in series",
        inputs = {
            E = 10000000000.0,
            nu = 0.25,
            joints = joints,
            height = 2.0,
            kn = 20000000000.0,
            load = -1000000.0,
            sides = "rollers",
        },
        expected = { shortening = shortening },
    }
end)

reference["DF.goodman"] = {
    source = "Goodman 1989; Singh 1973",
    inputs = {
        E = 10000000000.0,
        nu = 0.25,
        kn = 20000000000.0,
        ks = 10000000000.0,
        spacing = 0.5,
        normal_to_load = { 0, 30, 45, 60 },
    },
    expected = {
        E_equivalent = {
            ["0"] = 5000000000.0,
            ["30"] = 5161290322.580645,
            ["45"] = 5714285714.285714,
            ["60"] = 6956521739.130434,
        },
    },
}

reference["DF.patch_joints"] = {
    source = "equilibrium and compatibility of persistent planes",
    inputs = {
        joints = "persistent sets of any attitude through a cube, cohesion so large that nothing slips; meshes of all blocks different",
        tractions = "sigma n on all outer faces",
        stress = { -1000000.0, -2000000.0, -4000000.0, 300000.0, -200000.0, 500000.0 },
    },
    expected = { zone_stress = "sigma in every zone", joint_traction = "sigma n at every contact point" },
}

reference["DF.direct_shear"] = {
    source = "Coulomb",
    inputs = {
        cohesion = 100000.0,
        friction = 30.0,
        normal = 1000000.0,
        area = 1.0,
        kn = 20000000000.0,
        ks = 10000000000.0,
    },
    expected = {
        peak = 677350.2691896257,
        stiffness_series_thin = "1/(1/ks + h/G) for blocks sheared uniformly, h their total height",
    },
}

reference["DF.incline"] = {
    source = "Newton",
    inputs = { angle = 35.0, friction = 25.0, E = 100000000.0, g = 10.0 },
    expected = { acceleration = 1.9159956490576664, sticks_below = 25.0 },
}

reference["DF.wave_speed"] = {
    source = "d'Alembert; Lysmer and Kuhlemeyer 1969",
    inputs = { E = 10000000000.0, nu = 0.25, rho = 2500.0 },
    expected = {
        cp = 2190.8902300206646,
        cs = 1264.9110640673518,
        free_end = "velocity doubles, stress 0",
        fixed_end = "stress doubles, velocity 0",
        quiet_end = "energy left after the wave has passed below 1e-4 (normal incidence)",
    },
}

reference["DF.pyrak_nolte"] = {
    source = "Pyrak-Nolte, Myer and Cook 1990: T = 1/(1 + i x) with x = omega Z/(2 k)",
    inputs = { Z = "rho c of the wave (P with kn, S with ks)", x = "omega Z / (2 k)" },
    expected = {
        by_x = {
            ["0.1"] = { T = 0.9950371902099893, R = 0.09950371902099893, phase = 0.09966865249116204 },
            ["0.5"] = { T = 0.8944271909999159, R = 0.4472135954999579, phase = 0.4636476090008061 },
            ["1.0"] = { T = 0.7071067811865475, R = 0.7071067811865475, phase = 0.7853981633974483 },
            ["2.0"] = { T = 0.4472135954999579, R = 0.8944271909999159, phase = 1.1071487177940904 },
            ["5.0"] = { T = 0.19611613513818404, R = 0.9805806756909202, phase = 1.373400766945016 },
            ["10.0"] = { T = 0.09950371902099892, R = 0.9950371902099892, phase = 1.4711276743037347 },
        },
    },
}

reference["DF.joint_pulse"] = {
    source = "displacement discontinuity, integrated",
    inputs = { Z = 5477225.575051662, kn = 5000000000.0, pulse = "sin^2(pi t/T), T = 0.01 s" },
    expected = {
        t = { 0.0, 0.0025, 0.005, 0.0075, 0.01, 0.0125, 0.015, 0.0175, 0.02, 0.0225, 0.025 },
        transmitted_over_peak = {
            0.0, 0.3455977114940746, 0.9470474024327024, 0.6538507025081057, 0.052946851916905256,
            0.000551526155849882, 5.745037692173664e-06, 6.011340262531009e-08, 6.233672739205145e-10,
            6.492776599050878e-12, 6.685890823443916e-14,
        },
        peak = 0.9726603209213371,
    },
}

reference["DF.miller"] = {
    source = "Miller 1978; here with a rigid-plastic joint: the transmitted stress is the incident one cut off at tau_s",
    inputs = {
        strength_over_amplitude = { "0.1", "0.3", "0.5", "0.7", "0.9", "1.0" },
        wave = "harmonic SH or shear wave, normal incidence, joint of high stiffness and cohesion tau_s, no friction",
    },
    expected = {
        energy = {
            ["0.1"] = {
                transmitted = 0.01915032317363366,
                reflected = 0.7649274652209644,
                absorbed = 0.21592221160540193,
            },
            ["0.3"] = {
                transmitted = 0.1568691945555913,
                reflected = 0.4045445229512122,
                absorbed = 0.4385862824931965,
            },
            ["0.5"] = {
                transmitted = 0.3910022189557654,
                reflected = 0.17300665686735295,
                absorbed = 0.4359911241768817,
            },
            ["0.7"] = {
                transmitted = 0.6716264497261306,
                reflected = 0.04786726147455682,
                absorbed = 0.28050628879931255,
            },
            ["0.9"] = {
                transmitted = 0.9282756906475348,
                reflected = 0.003047837611395196,
                absorbed = 0.06867647174107001,
            },
            ["1.0"] = { transmitted = 1.0, reflected = 0.0, absorbed = 0.0 },
        },
    },
}

reference["DF.bars_impact"] = {
    source = "Saint-Venant 1867",
    inputs = {
        E = 10000000000.0,
        nu = 0.25,
        rho = 2500.0,
        L1 = 1.0,
        L2 = 3.0,
        v = 1.0,
        kn = "100 M / zone or more, no damping, rollers on the sides",
    },
    expected = {
        v1_after = 0.0,
        v2_mean_after = 0.3333333333333333,
        restitution = 0.3333333333333333,
        contact_time = 0.0009128709291752768,
        equal_bars = { v1 = 0.0, v2 = 1.0 },
    },
}

reference["DF.punch"] = {
    source = "Fourier series, Galerkin with Chebyshev functions; converged to 1e-11",
    inputs = {
        E = 1000000000.0,
        nu = 0.25,
        half_width = 1.0,
        width = 6.0,
        depth = 4.0,
        plane = "strain",
        base = "smooth",
        side = "rollers at 0 (symmetry) and at 6",
        punch = "rigid block, friction 0, pressed on through contacts (kn 100 E/zone)",
    },
    expected = {
        mean_pressure_per_indentation = 494386244.88127065,
        other_resolutions = { 494386244.7905231, 494386244.876088 },
    },
}

-- Dams of zones, before still water up to `level`; the face leans back by `batter`. `moment`: how far off the moment of the
-- base may be, as the water follows a dam that strains by 1e-6.
reference.reservoir = {
    source = "hydrostatics", young = 1e12, poisson = 0.2, density = 2400, g = 9.81, unit_weight = 9810, height = 10, breadth = 8,
    width = 2, zone = 2, moment = 1e-5,
    { name = "DF.reservoir.upright", level = 7.3, batter = 0 }, { name = "DF.reservoir.full", level = 10, batter = 0 },
    { name = "DF.reservoir.battered", level = 7.3, batter = 0.2 },
}

return reference
