-- test_zones_slide.lua - energy of soft zoned blocks on stiff elastic joints, whose segments are laid anew all the time.
local check = require "check"
local talus = require "talus"

local BALANCE = 3e-3 -- Tolerance: areas that change have no potential; without the motion half-way it is 1.1e-2, and grows

local function plane(normal)
    local n = normal[3] < 0 and { -normal[1], -normal[2], -normal[3] } or normal
    return math.deg(math.acos(math.min(1, n[3]))), math.deg(math.atan(n[1], n[2])) % 360
end

do
    local model = talus.model { gravity = { 0, 0, 0 } }
    model:generate("box", { min = { 0, 0, 0 }, max = { 3, 1, 1 }, density = 2500 })
    for i, cut in ipairs {
        { { 0.029755348, -0.539326825, -0.655526614 }, { 2.000414974, 0.636274287, 0.435598252 } },
        { { 0, 1, 0 }, { 1.260325624, 0.360252091, 0.402771813 } },
        { { -0.851414035, -0.231613210, -0.203702455 }, { 1.5309747897, 0.4547358283, 0.3780898825 } },
    } do
        local dip, direction = plane(cut[1])
        model:generate("joint", { joint = "J" .. i, dip = dip, dip_direction = direction, origin = cut[2] })
    end
    model:generate("box", { min = { -1, -1, -1 }, max = { 4, 2, 0 }, density = 2500, group = "base" })
    model:joint("*", "elastic", { kn = 932670508.558, ks = 519774130.657 })
    model:solid("soft", "elastic", { young = 13863974.62, poisson = 0 })
    model:blocks({ group = "base" }):fix()
    model:blocks({ group = "rock" }):deformable { zone = 0.98150434948, solid = "soft" }
    model:blocks({ group = "rock" }):set { velocity = { -0.787867116, 0.811753119, -0.877800988 } }
    while model.time < 0.13 do
        model:cycle(50)
    end
    check.holds(math.abs(model:energy().balance) < BALANCE)
end
