-- reference_motion.lua - what the tests of motion must obtain: closed forms and independent
-- calculations, with their inputs and sources. SI units, angles in degrees.
local reference = {}

reference["D.top.intermediate"] = {
    source = "Euler's equations by an eighth-order method to 1e-11; period by elliptic functions "
        .. "(Landau and Lifshitz, Mechanics, 37)",
    box = { 1.0, 2.0, 3.0 },
    density = 1000.0,
    inertia = { 6500.0, 5000.0, 2500.0 },
    w0 = { 0.01, 5.0, 0.02 },
    energy = 62500.825,
    angular_momentum = { 65.0, 25000.0, 50.0 },
    period = 11.675677970961784,
    samples = {
        {
            t = 0.5,
            w_body = { 0.04231850257445248, 4.999648289652673, 0.05511564959087889 },
            rotation = {
                0.3153094431144261, 0.005900840556943588, 0.9489579721446207,
                0.004888994452973683,
            },
        },
        {
            t = 1.0,
            w_body = { 0.1433168796395185, 4.995746727545504, 0.17968298657298878 },
            rotation = {
                -0.8010117105897256, 0.01832833968751265, 0.5983157267270003,
                -0.007912181340342698,
            },
        },
        {
            t = 2.0,
            w_body = { 1.5076032386592504, 4.50251524678718, 1.8830606308180151 },
            rotation = {
                0.27672038856932224, -0.22113131250117232, -0.934434077862181,
                -0.03687442625191112,
            },
        },
        {
            t = 4.0,
            w_body = { 0.24794415148942792, -4.987217389617552, 0.3100758480149475 },
            rotation = {
                -0.03118123664608799, -0.12708332320671864, -0.018331095204134194,
                -0.991232329170399,
            },
        },
        {
            t = 6.0,
            w_body = { -0.01716401656789948, -4.999959522315483, 0.02652510895360841 },
            rotation = {
                -0.0017531067531866183, 0.9150686685066074, -0.0033629882479258937,
                -0.4032802361191296,
            },
        },
    },
}

reference["D.top.major"] = {
    source = "Euler's equations by an eighth-order method to 1e-11; period by elliptic functions "
        .. "(Landau and Lifshitz, Mechanics, 37)",
    box = { 1.0, 2.0, 3.0 },
    density = 1000.0,
    inertia = { 6500.0, 5000.0, 2500.0 },
    w0 = { 3.0, 0.3, 0.2 },
    energy = 29525.0,
    angular_momentum = { 19500.0, 1500.0, 500.0 },
    period = 3.021528034843622,
    samples = {
        {
            t = 0.5,
            w_body = { 3.007021499504921, -0.04763548206496946, 0.32526626882652393 },
            rotation = {
                0.7279425871048376, 0.6828287079287477, 0.02790517264221198,
                0.055370089825475824,
            },
        },
        {
            t = 1.0,
            w_body = { 2.997503940901324, -0.34804864387687484, 0.12902172732373574 },
            rotation = {
                0.06261101969418466, 0.9976718671075562, -0.0064332905767101375,
                0.026254877019954367,
            },
        },
        {
            t = 2.0,
            w_body = { 3.0070800454016284, 0.0392016471393707, -0.32610952630392154 },
            rotation = {
                -0.9906582866503107, 0.12618904650758211, 0.038851707689095655,
                -0.034103202814677984,
            },
        },
        {
            t = 4.0,
            w_body = { 2.9978911164665383, -0.34104195625592254, 0.14236498184191992 },
            rotation = {
                0.9646256741849208, -0.2530876970760735, -0.002232950855727064,
                0.07374917099529102,
            },
        },
    },
}

reference["D.spin.spherical"] = {
    source = "Hart, Cundall and Lemos (1988), equations (20) and (23)",
    alpha = 0.5,
    w0 = { 1, -2, 2 },
    dt = 0.001,
    steps = 2000,
    w_final = { 0.3678794335072282, -0.7357588670144564, 0.7357588670144564 },
    angle = 6.0,
    axis = { 0.3333333333333333, -0.6666666666666666, 0.6666666666666666 },
}

reference["D.bounce.1"] = {
    source = "exact solution of m x\" = m g - F(x), F by check_joint.lua",
    side = 1.0,
    rho = 2000.0,
    kn = 100000000.0,
    drop_height = 0.05,
    g = 10.0,
    omega = 223.60679774997897,
    v_impact = 1.0,
    t_impact = 0.1,
    v_rebound = 1.0,
}

reference["D.bounce.2"] = {
    source = "exact solution of m x\" = m g - F(x), F by check_joint.lua",
    side = 0.5,
    rho = 2700.0,
    kn = 1000000000.0,
    drop_height = 0.2,
    g = 10.0,
    omega = 860.6629658238704,
    v_impact = 2.0,
    t_impact = 0.2,
    v_rebound = 2.0,
}

return reference
