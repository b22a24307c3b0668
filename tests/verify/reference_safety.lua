-- reference_safety.lua - factors of safety by limit equilibrium: closed forms, each found in two ways (a formula, and the
-- solution of the equations of equilibrium for F by bisection). SI units, angles in degrees, attitudes {dip, dip
-- direction}, axes x east, y north, z up.
--
-- plane: a prism 1 m wide on a plane of dip 35 towards -x. Hoek and Bray, Rock Slope Engineering (1977), chapter 7.
-- wedges: a block above planes A and B, behind a face and below an upper surface that meets their line `height` above the
--   toe, in the origin; with a crack, in front of that. Hoek and Bray's wedge as a vector solution, with areas and volume
--   by clipping half-spaces; HB_water and HB_dry also by the short solution (Wyllie and Mah, 4th edition, with exact
--   angles). The water of `lifted` stands to its top and takes it off B: it slides on A.
-- two_blocks: an active block pushes a passive one, shear at its limit on all three planes; the interface is vertical.
--
-- `load` is the resultant of water pressure, bolts and earthquake, N.
local reference = {}

reference.plane = {
    dip = 35, density = 2500, g = 10, width = 1, front = 2, rear = 10, top = 12,
    cases = {
        { id = "FS.plane.dry", friction = 40, cohesion = 0,
            load = { 0.0, 0.0, 0.0 }, FS = 1.19835846572 },
        { id = "FS.plane.cohesion", friction = 30, cohesion = 20000.0,
            load = { 0.0, 0.0, 0.0 }, FS = 1.04286936742 },
        { id = "FS.plane.water", friction = 45, cohesion = 0,
            load = { -264879.632, 0.0, 199916.985 }, FS = 0.964929520324 },
        { id = "FS.plane.water_half", friction = 45, cohesion = 0,
            load = { -101215.753, 0.0, 99958.492 }, FS = 1.23638353947 },
        { id = "FS.plane.water_cohesion", friction = 40, cohesion = 15000.0,
            load = { -264879.632, 0.0, 199916.985 }, FS = 0.956613801568 },
        { id = "FS.plane.bolt_active", friction = 35, cohesion = 0,
            load = { 33978.777, 0.0, 226063.708 }, FS = 1.05627228483 },
        { id = "FS.plane.kh", friction = 45, cohesion = 0,
            load = { -233962.643, 0.0, 0.0 }, FS = 1.05264753492 },
        { id = "FS.plane.all", friction = 38, cohesion = 10000.0,
            load = { -64005.683, 0.0, 151722.301 }, FS = 1.12797452631 },
    },
}

reference.wedges = {
    { id = "FS.wedge.HB_water", A = { 45, 105 }, B = { 70, 235 }, face = { 65, 185 },
        upper = { 12, 195 }, height = 40.0,
        friction = { 30, 20 }, cohesion = { 24000.0, 48000.0 }, density = 2500, g = 10.0,
        load = { -5366946, -42037334, 60885743 }, volume = 6698.16496952, FS = 1.34194036235 },
    { id = "FS.wedge.HB_dry", A = { 45, 105 }, B = { 70, 235 }, face = { 65, 185 },
        upper = { 12, 195 }, height = 40.0,
        friction = { 30, 20 }, cohesion = { 24000.0, 48000.0 }, density = 2500, g = 10.0,
        load = { 0, 0, 0 }, volume = 6698.16496952, FS = 1.97206193269 },
    { id = "FS.wedge.HB_frictional", A = { 45, 105 }, B = { 70, 235 }, face = { 65, 185 },
        upper = { 12, 195 }, height = 40.0,
        friction = { 30, 20 }, cohesion = { 0.0, 0.0 }, density = 2500, g = 10.0,
        load = { 0, 0, 0 }, volume = 6698.16496952, FS = 1.2335092498 },
    { id = "FS.wedge.HB_table", A = { 45, 105 }, B = { 70, 235 }, face = { 65, 185 },
        upper = { 12, 195 }, height = 40.0,
        friction = { 30, 20 }, cohesion = { 24000.0, 48000.0 }, density = 2500, g = 10.0,
        load = { -1181588, -13507214, 19903214 }, volume = 6698.16496952, FS = 1.76658721141 },
    { id = "FS.wedge.HB_crack_water", A = { 45, 105 }, B = { 70, 235 }, face = { 65, 185 },
        upper = { 12, 195 }, height = 40.0, crack = { 80, 185 }, crack_at = 0.7,
        friction = { 35, 30 }, cohesion = { 20000.0, 30000.0 }, density = 2500, g = 10.0,
        load = { -861455, -9847079, 14509884 }, volume = 6431.60071793, FS = 1.88874625711 },
    { id = "FS.wedge.HB_kh", A = { 45, 105 }, B = { 70, 235 }, face = { 65, 185 },
        upper = { 12, 195 }, height = 40.0,
        friction = { 40, 35 }, cohesion = { 24000.0, 48000.0 }, density = 2500, g = 10.0,
        load = { -1751351, -20018029, 0 }, volume = 6698.16496952, FS = 2.16016943306 },
    { id = "FS.wedge.HB_bolt", A = { 45, 105 }, B = { 70, 235 }, face = { 65, 185 },
        upper = { 12, 195 }, height = 40.0,
        friction = { 30, 20 }, cohesion = { 0.0, 0.0 }, density = 2500, g = 10.0,
        load = { 1029980, 11772723, -2083778 }, volume = 6698.16496952, FS = 1.43055905083 },
    { id = "FS.wedge.single", A = { 40, 160 }, B = { 60, 110 }, face = { 75, 160 },
        upper = { 0, 0 }, height = 20.0,
        friction = { 35, 35 }, cohesion = { 10000.0, 0.0 }, density = 2500, g = 10.0,
        load = { 0, 0, 0 }, volume = 32461.3452125, FS = 0.93715286208 },
    { id = "FS.wedge.lifted", A = { 50, 130 }, B = { 60, 220 }, face = { 80, 175 },
        upper = { 0, 0 }, height = 15.0,
        friction = { 40, 40 }, cohesion = { 5000.0, 5000.0 }, density = 2500, g = 10.0,
        load = { 809163.627168, -9248782.579918, 9298792.668548 }, volume = 766.175333208, FS = 0.144910158931 },
}

reference.two_blocks = {
    { id = "FS.two_blocks.dry", dip = { 50, 15 }, length = { 8.0, 10.0 },
        thickness = 6.0, unit_weight = 25000.0, friction = 35,
        cohesion = 0.0, uplift = { 0.0, 0.0 }, FS = 1.31274336245 },
    { id = "FS.two_blocks.cohesion", dip = { 55, 10 }, length = { 8.0, 10.0 },
        thickness = 6.0, unit_weight = 25000.0, friction = 30,
        cohesion = 20000.0, uplift = { 0.0, 0.0 }, FS = 1.54255607081 },
    { id = "FS.two_blocks.uplift", dip = { 45, 20 }, length = { 8.0, 10.0 },
        thickness = 6.0, unit_weight = 25000.0, friction = 40,
        cohesion = 0.0, uplift = { 169705.627485, 281907.786236 }, FS = 1.20930564709 },
}

return reference
