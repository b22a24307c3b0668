-- The factor of safety of a homogeneous slope of one deformable block, whose solid's strengths are divided.
package.path = "tests/verify/?.lua;" .. package.path -- run in the source root
local talus = require "talus"
local figures = require "check_figures"

-- Slope 2 : 1 on a firm base, friction 20 degrees, c / (unit weight H) = 0.05, no dilation: example 1 of the source. Finite elements
-- give 1.40 there; the charts of Bishop and Morgenstern (1960) 1.38.
local H, FRICTION, SHARE, WEIGHT = 10, 20, 0.05, 20e3 -- m, degrees, -, N/m3
local FACTOR = 1.40

-- A slice one zone thick, with sides on rollers.
local function build(zone)
    local model = talus.model { gravity = { 0, 0, -10 } }
    model:generate("profile", { section = { { 0, 0 }, { 3.2 * H, 0 }, { 3.2 * H, H }, { 2 * H, H } }, from = 0, to = zone,
        density = WEIGHT / 10 })
    model:solid("soil", "mohr_coulomb", { young = 1e8, poisson = 0.3, cohesion = SHARE * WEIGHT * H, friction = FRICTION,
        dilation = 0 })
    model:blocks():deformable { zone = zone, solid = "soil" }
    model:boundary { xmax = "roller", ymin = "roller", ymax = "roller", zmin = "fixed" }
    return model
end

figures.case("FS.griffiths", "A slope of 2 : 1 in soil with cohesion and friction, as one deformable block with zones of 2, 1 and 0.5 m to a height of "
    .. "10 m: coarse zones are too strong.", "Griffiths and Lane, Geotechnique 49 (1999) 387-403, example 1")
local before = math.huge
for _, zone in ipairs { 2, 1, 0.5 } do
    local model = build(zone)
    local hash = model:state_hash()
    local r = model:factor_of_safety { from = 1.3, to = 1.6, resolution = 0.02 }
    local name = string.format("zones of %g m", zone)
    figures.between(name .. ": factor", r.factor, FACTOR * 0.98, math.min(before, 1.1 * FACTOR))
    figures.equal(name .. ": mode", r.mode, "yields")
    figures.equal(name .. ": undecided", r.undecided, 0)
    figures.equal(name .. ": the model is as it was", model:state_hash(), hash)
    before = r.factor
end
figures.relative("factor with zones of 0.5 m", before, FACTOR, 0.05)
figures.finish()
