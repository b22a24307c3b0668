-- reference_laws.lua - what the verification tests of the joint laws compare with.
--
-- Computed independently of Talus, from closed forms and by integration of the published equations in Python (numpy, scipy);
-- where two ways lead to a number they agree. Each case names the paper. Units SI; angles in degrees, those of LAW.cy in
-- radians; joint stresses and closures compression positive.
local reference = {}

reference["LAW.barton.peak"] = {
    source = "Barton & Choubey 1977",
    inputs = { JCS = 100000000.0, phi_r = 30.0, limit_of_the_angle = 70.0 },
    expected = {
        tau = {
            ["0.01 MPa, JRC 2"] = 7812.85626507, ["0.01 MPa, JRC 5"] = 11917.5359259,
            ["0.01 MPa, JRC 10"] = 27474.7741945, ["0.01 MPa, JRC 20"] = 27474.7741945,
            ["0.1 MPa, JRC 2"] = 72654.2528005, ["0.1 MPa, JRC 5"] = 100000.0,
            ["0.1 MPa, JRC 10"] = 173205.080757, ["0.1 MPa, JRC 20"] = 274747.741945,
            ["1 MPa, JRC 2"] = 674508.516842, ["1 MPa, JRC 5"] = 839099.631177,
            ["1 MPa, JRC 10"] = 1191753.59259, ["1 MPa, JRC 20"] = 2747477.41945,
            ["5 MPa, JRC 2"] = 3197886.70106, ["5 MPa, JRC 5"] = 3700500.91851,
            ["5 MPa, JRC 10"] = 4664256.17115, ["5 MPa, JRC 20"] = 7418556.87115,
            ["20 MPa, JRC 2"] = 12207065.1683, ["20 MPa, JRC 5"] = 13235126.1453,
            ["20 MPa, JRC 10"] = 15065444.7981, ["20 MPa, JRC 20"] = 19299883.8461,
        },
        slope_at_1MPa_JRC10 = 1.00829980413,
        instantaneous = { phi_i = 45.2367878736, formula = 45.2367878654 },
    },
}

reference["LAW.barton.scale"] = {
    source = "Bandis, Lumsden & Barton 1981",
    inputs = { JRC0 = 10.0, JCS0 = 100000000.0, L0 = 0.1 },
    expected = {
        ["0.1 m"] = { JRC = 10.0, JCS = 100000000.0 },
        ["0.5 m"] = { JRC = 7.24779663678, JCS = 61703386.272 },
        ["1.0 m"] = { JRC = 6.3095734448, JCS = 50118723.3627 },
        ["5.0 m"] = { JRC = 4.57305051927, JCS = 30924949.4711 },
    },
}

reference["LAW.barton.shear"] = {
    source = "Barton 1982; Barton, Bandis & Bakhtar 1985",
    inputs = {
        JRC = 10.0, JCS = 100000000.0, phi_r = 30.0, L = 1.0, sigma_n = 1000000.0,
        table_of_JRCmob = {
            { 0.3, 0.0 }, { 0.6, 0.75 }, { 1.0, 1.0 }, { 2.0, 0.85 }, { 4.0, 0.7 },
            { 10.0, 0.5 }, { 25.0, 0.4 }, { 100.0, 0.0 },
        },
        start = "tau = 0 at u = 0: JRC_mob/JRC = -phi_r/i there, linear to 0 at 0.3 u_peak",
    },
    expected = {
        u_peak = 0.004275924179,
        tau = {
            [0] = 0.0, [0.15] = 267949.192431, [0.3] = 577350.26919, [0.6] = 1000000.0,
            [1] = 1191753.59259, [2] = 1072368.71002, [4] = 965688.774807, [10] = 839099.631177,
            [25] = 781285.626507, [100] = 577350.26919,
        },
        dilation_deg = { [1] = 10.0, [2] = 8.5, [10] = 5.0 },
    },
}

reference["LAW.bandis.closure"] = {
    source = "Bandis, Lumsden & Barton 1983", inputs = { kni = 20000000000.0, vm = 0.0002 },
    expected = {
        by_stress = {
            [100000.0] = {
                closure = 4.87804878049e-06, kn = 21012500000.0, energy_per_m2 = 0.241894950346,
            },
            [1000000.0] = { closure = 4e-05, kn = 31250000000.0, energy_per_m2 = 18.5148410514 },
            [5000000.0] = {
                closure = 0.000111111111111, kn = 101250000000.0, energy_per_m2 = 204.299728529,
            },
            [20000000.0] = {
                closure = 0.000166666666667, kn = 720000000000.0, energy_per_m2 = 766.740908716,
            },
        },
        half_closure_stress = 4000000.0,
    },
}

reference["LAW.cy.monotonic"] = {
    source = "Cundall & Hart 1984; Cundall & Lemos 1990",
    inputs = {
        sn = 1000000.0, an = 10000000000.0, en = 0.0, as_ = 2000000000.0, es = 0.0,
        phi_i = 0.872664625997, phi = 0.523598775598, R = 0.002,
    },
    expected = {
        at = {
            {
                u = 0.0001, tau = 184097.077719, phi_m_deg = 49.9206432437,
                dilation_deg = -19.5688115687, work = 9.46286087447,
            },
            {
                u = 0.0005, tau = 669024.162577, phi_m_deg = 48.4117364938,
                dilation_deg = 3.78347896548, work = 191.713978871,
            },
            {
                u = 0.001, tau = 905410.675543, phi_m_deg = 45.2120053603,
                dilation_deg = 12.1580280481, work = 597.967894738,
            },
            {
                u = 0.002, tau = 934561.307693, phi_m_deg = 39.294033178,
                dilation_deg = 13.0626450874, work = 1529.59107753,
            },
            {
                u = 0.005, tau = 934561.307693, phi_m_deg = 32.0737791122,
                dilation_deg = 13.0626450874, work = 4333.2750006,
            },
            {
                u = 0.01, tau = 934561.307693, phi_m_deg = 30.1702261558,
                dilation_deg = 13.0626450874, work = 9006.08153907,
            },
            {
                u = 0.02, tau = 934561.307693, phi_m_deg = 30.0011469748,
                dilation_deg = 13.0626450874, work = 18351.694616,
            },
        },
        peak_u = 0.001319225, peak_tau = 934561.307693,
    },
}

reference["LAW.cy.cycle"] = {
    source = "Cundall & Hart 1984; Cundall & Lemos 1990",
    inputs = {
        sn = 1000000.0, an = 10000000000.0, en = 0.0, as_ = 2000000000.0, es = 0.0,
        phi_i = 0.872664625997, phi = 0.523598775598, R = 0.002,
    },
    expected = {
        at = {
            {
                u = 0.002, tau = 934561.307249, phi_m_deg = 39.2940331767,
                dilation_deg = 13.0626450738, work = 1529.59107628,
            },
            {
                u = -0.002, tau = -650032.13277, phi_m_deg = 31.8692194935,
                dilation_deg = 3.02516178782, work = 3051.90878864,
            },
            {
                u = 0.002, tau = 587608.03541, phi_m_deg = 30.3447040704,
                dilation_deg = 0.438837212179, work = 4677.43822145,
            },
        },
        peak_u = 0.00131925, peak_tau = 934561.307249,
    },
}

reference["LAW.slip_weakening.5e+08"] = {
    source = "Ida 1972; Andrews 1976; Rice 1983",
    inputs = {
        sigma_n = 10000000.0, mu_peak = 0.7, mu_residual = 0.5, Dc = 0.001, form = "linear",
        spring = 500000000.0,
    },
    expected = {
        k_critical = 2000000000.0, stable = false, fracture_energy = 1000.0,
        strength_at = {
            [0] = 7000000.0, [0.00025] = 6500000.0, [0.001] = 5000000.0, [0.005] = 5000000.0,
        },
        stress_after_instability = 3000000.0,
    },
}

reference["LAW.slip_weakening.5e+09"] = {
    source = "Ida 1972; Andrews 1976; Rice 1983",
    inputs = {
        sigma_n = 10000000.0, mu_peak = 0.7, mu_residual = 0.5, Dc = 0.001, form = "linear",
        spring = 5000000000.0,
    },
    expected = {
        k_critical = 2000000000.0, stable = true, fracture_energy = 1000.0,
        strength_at = {
            [0] = 7000000.0, [0.00025] = 6500000.0, [0.001] = 5000000.0, [0.005] = 5000000.0,
        },
    },
}

reference["LAW.rate_state"] = {
    source = "Dieterich 1979; Ruina 1983; Rice & Ruina 1983",
    inputs = {
        mu0 = 0.6, a = 0.01, b = 0.015, Dc = 1e-05, V0 = 1e-06, sn = 10000000.0,
        law = "aging (Dieterich)",
        spring_slider = "k/kc = 1.5 and 0.5, load point 1e-6 m/s, radiation damping 5e6 Pa s/m",
    },
    expected = {
        steady_mu = { [1e-09] = 0.634538776395, [1e-06] = 0.6, [0.001] = 0.565461223605 },
        k_critical = 5000000000.0,
        step_1e6_to_1e5 = {
            [0] = 0.62302585093, [5e-06] = 0.616468671782, [1e-05] = 0.610404327111,
            [5e-05] = 0.589370183566,
        },
        stable_at_1_5_kc = true, final_V_at_1_5_kc = 1.00003649992e-06,
        stick_slip_period_at_0_5_kc = 359.929737347, stress_range_at_0_5_kc = 881048.075813,
        period_estimate_stress_drop_over_k_Vl = 352.419230325,
    },
}

reference["LAW.cohesive.I"] = {
    source = "Camanho & Davila 2002; LMGC90 masonry: Bisoffi-Sauve, Morel & Dubois 2019",
    inputs = {
        kn = 40000000000.0, ks = 16000000000.0, tension = 250000.0, cohesion = 350000.0,
        GI = 18.0, GII = 125.0, path = { 1, 0 },
    },
    expected = {
        onset = 6.25e-06, failure = 0.000144, work_normal = 17.999999987, work_shear = 0.0,
        sum_of_shares = 0.999999999277, peak_normal = 249996.499825, peak_shear = 0.0,
    },
}

reference["LAW.cohesive.II"] = {
    source = "Camanho & Davila 2002; LMGC90 masonry: Bisoffi-Sauve, Morel & Dubois 2019",
    inputs = {
        kn = 40000000000.0, ks = 16000000000.0, tension = 250000.0, cohesion = 350000.0,
        GI = 18.0, GII = 125.0, path = { 0, 1 },
    },
    expected = {
        onset = 2.1875e-05, failure = 0.000714285714286, work_normal = 1.17168730563e-30,
        work_shear = 124.999997378, sum_of_shares = 0.999999979024,
        peak_normal = 5.35768309814e-11, peak_shear = 349990.420217,
    },
}

reference["LAW.cohesive.mixed"] = {
    source = "Camanho & Davila 2002; LMGC90 masonry: Bisoffi-Sauve, Morel & Dubois 2019",
    inputs = {
        kn = 40000000000.0, ks = 16000000000.0, tension = 250000.0, cohesion = 350000.0,
        GI = 18.0, GII = 125.0, path = { 1, 1 },
    },
    expected = {
        onset = 8.49875129563e-06, failure = 0.000200260798074, work_normal = 17.0196669626,
        work_shear = 6.80786678504, sum_of_shares = 0.999999987758, peak_normal = 240377.546378,
        peak_shear = 96151.0185513,
    },
}

reference["LAW.cohesive.mixed30"] = {
    source = "Camanho & Davila 2002; LMGC90 masonry: Bisoffi-Sauve, Morel & Dubois 2019",
    inputs = {
        kn = 40000000000.0, ks = 16000000000.0, tension = 250000.0, cohesion = 350000.0,
        GI = 18.0, GII = 125.0, path = { 0.866025403784, 0.5 },
    },
    expected = {
        onset = 7.12064901425e-06, failure = 0.000165349258499, work_normal = 17.6609103211,
        work_shear = 2.35478804281, sum_of_shares = 0.999999988845, peak_normal = 246656.75806,
        peak_shear = 56962.9382654,
    },
}

return reference
