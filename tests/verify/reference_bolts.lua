-- Reference results for bolts: pull-out, slip of the grout, an opening joint, a hanging block, a shearing joint. SI.
--
-- From closed forms and from finite differences of E A w'' = t, by a program of its own in Python.
-- pull: Cox, Br. J. Appl. Phys. 3 (1952) 72-79; Farmer, Int. J. Rock Mech. Min. Sci. 12 (1975) 347-351;
-- St John and Van Dillen, 24th US Symp. Rock Mech. (1983).
-- slip: a piecewise solution. opening: two pull-outs in series.
-- shear: axial spring and dowel at the crossing, small displacement, after Lorig (1985).

return {
    ["BOLT.pull.stiff"] = {
        inputs = {
            E = 200e9,
            diameter = 0.025,
            length = 2.0,
            grout_stiffness_per_metre = 5000000000.0,
            force = 100000.0,
        },
        expected = {
            beta = 7.13649646461,
            stiffness = 700623902.049,
            u0 = 0.000142729929292,
            tau_line0 = 713649.646462,
            tau_line_end = 0.903302019625,
            axial_force_at = {
                [0] = 100000.0,
                [0.25] = 16794.4096117,
                [0.5] = 2820.5219407,
                [1] = 79.5533899126,
                [1.5] = 2.24203720046,
            },
            stiffness_of_chain_with_n_elements = {
                [4] = 1432959820.89, [8] = 938881702.931, [16] = 767157156.078, [32] = 717835576.314,
            },
        },
    },
    ["BOLT.pull.soft"] = {
        inputs = {
            E = 200e9,
            diameter = 0.025,
            length = 2.0,
            grout_stiffness_per_metre = 100000000.0,
            force = 100000.0,
        },
        expected = {
            beta = 1.00925300881,
            stiffness = 95646183.4903,
            u0 = 0.00104552002339,
            tau_line0 = 104552.002339,
            tau_line_end = 27298.4401611,
            axial_force_at = {
                [0] = 100000.0,
                [0.25] = 76783.8041001,
                [0.5] = 58481.8048357,
                [1] = 32174.59748,
                [1.5] = 14235.9316114,
            },
            stiffness_of_chain_with_n_elements = {
                [4] = 98495688.1849, [8] = 96367925.8872, [16] = 95827221.469, [32] = 95691480.9094,
            },
        },
    },
    ["BOLT.slip.plastic"] = {
        inputs = {
            E = 200e9,
            diameter = 0.025,
            length = 2.0,
            grout_stiffness_per_metre = 1000000000.0,
            bond_strength_per_metre = 400000.0,
            residual_per_metre = 400000.0,
        },
        expected = {
            force_by_mouth_displacement = {
                [0.0002] = { force = 62665.3489434, slipped_length = 0.0 },
                [0.0004] = { force = 125330.697887, slipped_length = 0.0 },
                [0.0008] = { force = 217078.589424, slipped_length = 0.229375676988 },
                [0.0012] = { force = 280245.767878, slipped_length = 0.38730708913 },
                [0.002] = { force = 375981.211642, slipped_length = 0.62672222997 },
            },
            ultimate = 800000.0,
        },
    },
    ["BOLT.slip.brittle"] = {
        inputs = {
            E = 200e9,
            diameter = 0.025,
            length = 2.0,
            grout_stiffness_per_metre = 1000000000.0,
            bond_strength_per_metre = 400000.0,
            residual_per_metre = 100000.0,
        },
        expected = {
            force_by_mouth_displacement = {
                [0.0002] = { force = 62665.3489434, slipped_length = 0.0 },
                [0.0004] = { force = 125330.697887, slipped_length = 0.0 },
                [0.0008] = { force = 153495.477367, slipped_length = 0.281683855707 },
                [0.0012] = { force = 177231.468299, slipped_length = 0.519197366557 },
                [0.002] = { force = 216935.202589, slipped_length = 0.918554057135 },
            },
        },
    },
    ["BOLT.opening.1e+09"] = {
        inputs = {
            E = 200e9,
            diameter = 0.025,
            length_on_either_side = 1.0,
            grout_stiffness_per_metre = 1000000000.0,
            opening = 0.001,
        },
        expected = { force_at_joint = 156135.661576, stiffness = 156135661.576 },
    },
    ["BOLT.opening.5e+09"] = {
        inputs = {
            E = 200e9,
            diameter = 0.025,
            length_on_either_side = 1.0,
            grout_stiffness_per_metre = 5000000000.0,
            opening = 0.001,
        },
        expected = { force_at_joint = 350311.507618, stiffness = 350311507.618 },
    },
    ["BOLT.hang"] = {
        inputs = {
            E = 200e9,
            diameter = 0.025,
            free_length = 1.8,
            plate_stiffness = 50000000.0,
            weight = 37500.0,
            pretension = 20000.0,
        },
        expected = {
            elongation_at_rest = 0.000670856365273,
            stiffness = 26086060.9005,
            force = 37500.0,
            period = 0.0753340386082,
        },
    },
    ["BOLT.shear.0"] = {
        inputs = {
            angle_to_normal_deg = 0,
            axial_stiffness = 20000000.0,
            dowel_stiffness = 100000000.0,
            axial_yield = 240000.0,
            dowel_yield = 120000.0,
            normal_force = 100000.0,
            friction_deg = 35,
        },
        expected = {
            by_shear_displacement = {
                [1e-3] = {
                    axial = 0.0, dowel = 100000.0, along = 100000.0, closing = 0.0,
                    resistance = 170020.753821,
                },
                [0.005] = {
                    axial = 0.0, dowel = 120000.0, along = 120000.0, closing = 0.0,
                    resistance = 190020.753821,
                },
                [0.02] = {
                    axial = 0.0, dowel = 120000.0, along = 120000.0, closing = 0.0,
                    resistance = 190020.753821,
                },
            },
        },
    },
    ["BOLT.shear.30"] = {
        inputs = {
            angle_to_normal_deg = 30,
            axial_stiffness = 20000000.0,
            dowel_stiffness = 100000000.0,
            axial_yield = 240000.0,
            dowel_yield = 120000.0,
            normal_force = 100000.0,
            friction_deg = 35,
        },
        expected = {
            by_shear_displacement = {
                [1e-3] = {
                    axial = 10000.0, dowel = 86602.5403784, along = 80000.0, closing = -34641.0161514,
                    resistance = 125764.853181,
                },
                [0.005] = {
                    axial = 50000.0, dowel = 120000.0, along = 128923.048454, closing = -16698.7298108,
                    resistance = 187251.225783,
                },
                [0.02] = {
                    axial = 200000.0, dowel = 120000.0, along = 203923.048454, closing = 113205.080757,
                    resistance = 353210.853185,
                },
            },
        },
    },
    ["BOLT.shear.45"] = {
        inputs = {
            angle_to_normal_deg = 45,
            axial_stiffness = 20000000.0,
            dowel_stiffness = 100000000.0,
            axial_yield = 240000.0,
            dowel_yield = 120000.0,
            normal_force = 100000.0,
            friction_deg = 35,
        },
        expected = {
            by_shear_displacement = {
                [1e-3] = {
                    axial = 14142.1356237, dowel = 70710.6781187, along = 60000.0, closing = -40000.0,
                    resistance = 102012.452293,
                },
                [0.005] = {
                    axial = 70710.6781187, dowel = 120000.0, along = 134852.813742,
                    closing = -34852.8137424, resistance = 180469.364653,
                },
                [0.02] = {
                    axial = 240000.0, dowel = 120000.0, along = 254558.441227, closing = 84852.8137424,
                    resistance = 383993.774869,
                },
            },
        },
    },
    ["BOLT.shear.60"] = {
        inputs = {
            angle_to_normal_deg = 60,
            axial_stiffness = 20000000.0,
            dowel_stiffness = 100000000.0,
            axial_yield = 240000.0,
            dowel_yield = 120000.0,
            normal_force = 100000.0,
            friction_deg = 35,
        },
        expected = {
            by_shear_displacement = {
                [1e-3] = {
                    axial = 17320.5080757, dowel = 50000.0, along = 40000.0, closing = -34641.0161514,
                    resistance = 85764.8531805,
                },
                [0.005] = {
                    axial = 86602.5403784, dowel = 120000.0, along = 135000.0, closing = -60621.7782649,
                    resistance = 162572.9277,
                },
                [0.02] = {
                    axial = 240000.0, dowel = 120000.0, along = 267846.096908, closing = 16076.9515459,
                    resistance = 349124.053393,
                },
            },
        },
    },
}
