-- reference_3dec.lua - what 3DEC 7.00 wrote about arches of rigid voussoirs, unrefined: subcontacts at the corners of the faces.
-- Its files are published with compas_3dec (https://github.com/BlockResearchGroup/compas_3dec). SI units.
local reference = {}

-- tests/Test_Segovia/M1_Arch/contact_grav.txt, 3DEC 7.00 release 159: 20 voussoirs of 9 degrees between the radii 5 and 5.5 m, 0.5 m
-- wide, the first and the last held. `joints`, from the springing to the crown: normal displacements of the subcontacts,
-- negated, at the extrados and at the intrados. `thrust`: the sum of the normal forces at the crown.
reference.M1 = {
    source = "3DEC 7.00, release 159: compas_3dec (BlockResearchGroup, github), tests/Test_Segovia/M1_Arch/contact_grav.txt",
    density = 1000, gravity = 9.806, kn = 9e10, ks = 5e10, friction = 35,
    thrust = 2 * (1438.24 + 2876.48),
    normal_force = 2 * (2639.18 + 5278.35 + 568.673 + 1137.35), -- of the first joint
    joints = {
        { 1.40756e-06, 3.03292e-07 }, { 7.06272e-07, 8.92413e-07 }, { 3.16513e-07, 1.14794e-06 },
        { 1.66712e-07, 1.15287e-06 }, { 1.85641e-07, 9.89493e-07 }, { 3.0602e-07, 7.3532e-07 },
        { 4.67824e-07, 4.5938e-07 }, { 6.2116e-07, 2.18967e-07 }, { 7.28625e-07, 5.699e-08 },
        { 7.67062e-07, -1.33362e-06 },
    },
}

-- The same arch of other stone, release 161; friction 90 degrees at the supports, so nothing slips. The corners were rounded to 1 mm.
reference.M1_161 = {
    source = "3DEC 7.00, release 161: compas_3dec (BlockResearchGroup, github)",
    density = 2400, gravity = 9.81, kn = 6e10, ks = 2.5e10, rounding = 1e-3,
    thrust = 20723.4, vertical = 48366.2, normal_force = 46232.3, shear_force = 13680, joint_area = 0.25006,
    closures = { { joint = 1, 5.06651e-6 }, { joint = 9, intrados = true, 0.203155e-6 } },
    -- Independent statics of the moved voussoirs on joints of 200 springs each, without tension.
    refined = { thrust = 21075.29 },
}

-- Five voussoirs, (x, z) of intrados and extrados, 0.5 m wide; springs that slip, so the way of loading counts.
reference.five = {
    source = "3DEC 7.00: compas_3dec (BlockResearchGroup, github), docs/examples/old_examples/contact_grav.txt",
    density = 2200, gravity = 9.81, kn = 2e8, ks = 2e8 / 3.6, friction = 35, width = 0.5,
    intrados = { { 1.5, 0 }, { 0.9414475098, 0.3159612662 }, { 0.3208630573, 0.4793238793 } },
    extrados = { { 1.62, 0.16 }, { 1.0167633105, 0.5012381675 }, { 0.3465321018, 0.6776697896 } },
    thrust = 2705.2, vertical = 3571.23, crown = -1.112e-3, volume = 0.0661876, slips = true,
    crown_rounded = 0.0005 / 1.112, -- relative: half of the last digit printed
    -- Independent statics of the moved voussoirs on joints of 200 springs each, without tension, with the slip of each. Where they
    -- were drawn, they have 3812.4 N and -1.5685e-3 m: the arch is flat, and its crown sinks by 1/300 of its rise.
    refined = { thrust = 3831.52, crown = -1.58198e-3 },
}

-- A cube of 1 m, 0.275 m off the middle of the one that holds it; closures of its corners, m.
reference.cube = {
    source = "3DEC 7.00, release 161: compas_3dec (BlockResearchGroup, github)",
    normal_force = 9806.0, closures = { 0.933e-7, 2.07e-7 },
}

-- The heavy arch with an extrados of 5.3 m: it collapses by hinges at these angles, degrees, and at those of the other half.
reference.thin = {
    source = "3DEC 7.00, release 161: compas_3dec (BlockResearchGroup, github)",
    hinges = "9 extrados, 36 intrados, 90 extrados, 144 intrados, 171 extrados",
}

return reference
