-- reference_statics.lua - what the tests of statics and of the time step must obtain: closed forms
-- and independent calculations, with their inputs and sources. SI units, angles in degrees.
local reference = {}

reference["S.stack.10"] = {
    source = "weight of the blocks above each joint",
    n = 10,
    side = 1.0,
    rho = 2000.0,
    g = 10.0,
    kn = 100000000.0,
    joint_force = {
        200000.0, 180000.0, 160000.0, 140000.0, 120000.0, 100000.0, 80000.0, 60000.0, 40000.0,
        20000.0,
    },
    base_force = 200000.0,
}

reference["S.stack.3"] = {
    source = "weight of the blocks above each joint",
    n = 3,
    side = 0.5,
    rho = 2500.0,
    g = 10.0,
    kn = 1000000000.0,
    joint_force = { 9375.0, 6250.0, 3125.0 },
    base_force = 9375.0,
}

reference["S.series"] = {
    source = "springs in series",
    rows = {
        {
            d = 0.001,
            kn1 = 10000000.0,
            kn2 = 10000000.0,
            w = 0,
            sigma_upper = 5000.0,
            sigma_lower = 5000.0,
            block_displacement = 0.0005,
        },
        {
            d = 0.001,
            kn1 = 10000000.0,
            kn2 = 30000000.0,
            w = 0,
            sigma_upper = 7500.0,
            sigma_lower = 7500.0,
            block_displacement = 0.00025,
        },
        {
            d = 0.002,
            kn1 = 50000000.0,
            kn2 = 10000000.0,
            w = 20000.0,
            sigma_upper = 0.0,
            sigma_lower = 20000.0,
            block_displacement = 0.002,
        },
    },
}

reference["S.shear"] = {
    source = "Hart, Cundall and Lemos (1988), equations (7) and (9) to (12)",
    rows = {
        {
            ks = 10000000.0,
            sigma = 100000.0,
            c = 0.0,
            phi_deg = 30.0,
            peak = 57735.026918962576,
            u_peak = 0.005773502691896258,
            path = {
                0.0, 0.0014433756729740645, 0.002886751345948129, 0.005196152422706633,
                0.005773502691896258, 0.008660254037844387, 0.017320508075688773,
                0.014433756729740644, 0.008660254037844387, 0.002886751345948129,
                -0.005773502691896258, 0.0,
            },
            tau = {
                0.0, 14433.756729740646, 28867.51345948129, 51961.52422706633,
                57735.026918962576, 57735.026918962576, 57735.026918962576, 28867.51345948128,
                -28867.513459481288, -57735.026918962576, -57735.026918962576,
                7.275957614183426e-12,
            },
        },
        {
            ks = 10000000.0,
            sigma = 100000.0,
            c = 20000.0,
            phi_deg = 30.0,
            peak = 77735.02691896257,
            u_peak = 0.007773502691896257,
            path = {
                0.0, 0.0019433756729740643, 0.0038867513459481286, 0.006996152422706631,
                0.007773502691896257, 0.011660254037844386, 0.02332050807568877,
                0.019433756729740643, 0.011660254037844386, 0.0038867513459481286,
                -0.007773502691896257, 0.0,
            },
            tau = {
                0.0, 19433.756729740642, 38867.513459481284, 69961.52422706631,
                77735.02691896257, 77735.02691896257, 77735.02691896257, 38867.513459481284,
                -38867.513459481284, -77735.02691896257, -77735.02691896257, 0.0,
            },
        },
        {
            ks = 50000000.0,
            sigma = 200000.0,
            c = 50000.0,
            phi_deg = 20.0,
            peak = 122794.04685324046,
            u_peak = 0.002455880937064809,
            path = {
                0.0, 0.0006139702342662023, 0.0012279404685324046, 0.0022102928433583285,
                0.002455880937064809, 0.0036838214055972137, 0.007367642811194427,
                0.006139702342662023, 0.0036838214055972137, 0.0012279404685324046,
                -0.002455880937064809, 0.0,
            },
            tau = {
                0.0, 30698.511713310116, 61397.02342662023, 110514.64216791643,
                122794.04685324046, 122794.04685324046, 122794.04685324046, 61397.02342662025,
                -61397.023426620224, -122794.04685324046, -122794.04685324046, 0.0,
            },
        },
    },
}

reference["S.tension"] = {
    source = "Hart, Cundall and Lemos (1988), text before equation (10)",
    tension = 50000.0,
    kn = 100000000.0,
    rows = {
        { opening = 0.0001, sigma = -10000.0 },
        { opening = 0.0003, sigma = -29999.999999999996 },
        { opening = 0.0004999, sigma = -49989.99999999999 },
        { opening = 0.0005001, sigma = 0.0 },
        { opening = 0.001, sigma = 0.0 },
    },
    opening_at_failure = 0.0005,
}

reference["T.eq27"] = {
    source = "Hart, Cundall and Lemos (1988), equation (27); limit 2 / omega of central "
        .. "differences",
    rows = {
        { mass = 2000.0, stiffness = 10000000.0, fraction = 0.1, dt = 0.002 },
        {
            mass = 1890.8146055865786,
            stiffness = 18908146.0,
            fraction = 0.1,
            dt = 0.0014142135644623045,
        },
        {
            mass = 1154.7005383792516,
            stiffness = 11547005.0,
            fraction = 0.1,
            dt = 0.0014142135858754915,
        },
    },
    limits = {
        two_free = 1.0,
        one_on_base = 1.4142135623730951,
        long_chain = 0.7071067811865476,
        cube_translation = 0.5773502691896258,
        cube_rotation_corners = 0.3333333333333333,
    },
}

reference["T.chain.3"] = {
    source = "eigenvalues of three masses and their springs",
    mass = 1.0,
    stiffness = 1.0,
    dt_crit_free = 1.1547005383792517,
    dt_crit_on_base = 1.1099162641747424,
}

return reference
