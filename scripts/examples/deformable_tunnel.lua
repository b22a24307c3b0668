-- deformable_tunnel.lua - the wedge in the roof of tunnel.lua, with rock that deforms beside rock that does not.
--
--     build/release/talus scripts/examples/deformable_tunnel.lua [folder]
--
-- The tunnel of example 3 of Hart, Cundall and Lemos (1988), once as they have it, everything rigid and held but the
-- wedge, and once with zones in all blocks, held at the outside of the cube. Two questions are asked of both.
-- How does the wedge fall? Alike but for a few per cent: a slide on a plane asks little of the rock.
-- Which friction holds it, when the top of the cube is the ground and the rock bears its own weight, a third of it
-- sideways? Rigid rock presses on the wedge as the rock did before there was a tunnel, whatever the joints are. Rock that
-- deforms lets go: little of the stress is left in a flat roof. Soft joints hardly feel that, for they give more than
-- the rock moves. Stiff ones lose their pressure.
package.path = "scripts/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local tunnel = require "examples.tunnel"

local deformable = {}

deformable.young, deformable.poisson = 5e9, 0.25 -- of the rock, Pa
local GROUND, WEIGHT = 8, 2000 * 10              -- height of the ground, m, and weight of the rock, N/m3

local function length(v)
    return math.sqrt(v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2)
end

-- The wanted edge of zones: smallest at the wedge.
local function zone_at(p)
    local away = length { p[1] - tunnel.inside[1], p[2] - tunnel.inside[2], p[3] - tunnel.inside[3] }
    return 0.6 + 0.3 * math.max(0, away - 1.5)
end

-- Stress of the weight above. Sideways it is that of elastic rock that cannot give.
local function press(model)
    local share = deformable.poisson / (1 - deformable.poisson)
    model:insitu { stress = {}, at = { 0, 0, GROUND }, gradient = { xx = share * WEIGHT, yy = share * WEIGHT, zz = WEIGHT } }
end

-- Excavated, with the wedge in the group "wedge". kn: stiffness of joints, Pa/m; stressed: by the weight of the rock.
function deformable.rigid(friction, kn, stressed)
    local model, wedge = tunnel.build(friction)
    model:joint("*", "coulomb", { kn = kn, ks = kn, friction = friction })
    if stressed then
        press(model)
    end
    return model, wedge
end

function deformable.zoned(friction, kn, stressed)
    local model = tunnel.cut()
    local wedge = model:blocks { containing = tunnel.inside }:set { group = "wedge" }
    model:joint("*", "coulomb", { kn = kn, ks = kn, friction = friction })
    model:solid("rock", "elastic", { young = deformable.young, poisson = deformable.poisson })
    model:blocks():deformable { solid = "rock", zone = zone_at }
    if stressed then
        press(model)
    end
    model:boundary { xmin = "fixed", xmax = "fixed", ymin = "fixed", ymax = "fixed", zmin = "fixed" }
    model:blocks { group = "tunnel" }:delete()
    return model, wedge
end

-- Mean acceleration over gravity of the wedge on its way of 0.3 m, without stress and damping.
function deformable.drop(build, friction)
    local model, wedge = build(friction, 1e8)
    model:timestep { rule = "body", fraction = 0.2 }
    repeat
        model:cycle(10)
    until length(wedge[1].displacement) > 0.3
    return 2 * length(wedge[1].displacement) / model.time ^ 2 / 10
end

-- Whether the wedge stays, and the mean normal stress on it, Pa.
function deformable.holds(build, friction, kn)
    local model, wedge = build(friction, kn, true)
    local run = model:relax { ratio = 1e-4, max_cycles = 20000 }
    local touching = model:contacts { between = { wedge, model:blocks() } }
    return run.reason == "rest", touching:sum "normal_force" / touching:sum "area", model
end

-- The least friction that holds the wedge, to half a degree.
function deformable.least_friction(build, kn)
    local low, high = 0, 64
    while high - low > 0.5 do
        local middle = (low + high) / 2
        if deformable.holds(build, middle, kn) then
            high = middle
        else
            low = middle
        end
    end
    return high
end

function deformable.main(folder)
    print "friction   a/g: expected   rigid   zones"
    local s, c = math.sin(math.rad(tunnel.slide[1])), math.cos(math.rad(tunnel.slide[1]))
    for _, mu in ipairs { 0, 0.3, 0.577 } do
        local friction = math.deg(math.atan(mu))
        print(string.format("   %5.3f        %6.3f  %6.3f  %6.3f", mu, s - mu * c,
            deformable.drop(deformable.rigid, friction), deformable.drop(deformable.zoned, friction)))
    end
    print "\njoints, Pa/m   least friction, deg: rigid   zones   pressure at 62 deg, kPa: rigid   zones"
    for _, kn in ipairs { 1e8, 1e9, 1e10 } do
        local _, rigid = deformable.holds(deformable.rigid, 62, kn)
        local _, zoned = deformable.holds(deformable.zoned, 62, kn)
        print(string.format("       %.0e                      %5.1f   %5.1f                             %4.1f    %4.1f", kn,
            deformable.least_friction(deformable.rigid, kn), deformable.least_friction(deformable.zoned, kn),
            rigid / 1000, zoned / 1000))
    end
    local _, _, model = deformable.holds(deformable.zoned, 62, 1e10)
    model:write_html(folder .. "/deformable_tunnel", { title = "A tunnel in rock that deforms" })
    print(string.format("%s/deformable_tunnel.html shows the stress around the tunnel in a browser", folder))
end

-- A test that says require "examples.deformable_tunnel" wants the functions only.
if ... ~= "examples.deformable_tunnel" then
    deformable.main(arg and arg[1] or "out/deformable_tunnel")
end
return deformable
