-- words_zones.lua - commands that let blocks deform.
local range = require "talus.threedec.range"

-- Names of properties in 3DEC and in Talus's solids.
local PROPERTIES = { density = "density", bulk = "bulk", shear = "shear", young = "young", poisson = "poisson", cohesion = "cohesion",
    friction = "friction", tension = "tension", dilation = "dilation" }
local KNOWN = {}
for word in pairs(PROPERTIES) do
    KNOWN[#KNOWN + 1] = word
end
table.sort(KNOWN)

local MODELS = { elastic = "elastic", ["mohr-coulomb"] = "mohr_coulomb", ["drucker-prager"] = "drucker_prager" }

local function generate(c, a)
    local edge
    while not a:at_range() do
        local word = a:keyword { "edgelength", "edge-length", "edge", "center", "center-point", "quad", "hexahedron", "mixed-tetrahedron" }
        if word == "edgelength" or word == "edge" or word == "edge-length" then
            edge = a:number "the edge"
        elseif word == "center" or word == "center-point" then
            edge = { lua = "1e9", value = 1e9 }
        else
            c.leave("zones of the kind '" .. word .. "'; deformable{zone =} makes tetrahedra")
        end
    end
    if not edge then
        c.leave "zones need an edge length"
    end
    c.zones(range.read(c, a), edge)
end

local function model(c, a)
    a:take "assign"
    local word = a:keyword { "elastic", "mohr-coulomb", "drucker-prager", "ubiquitous-joint", "anisotropic", "hoek-brown", "null",
        "strain-softening", "softening-ubiquitous", "cam-clay", "double-yield", "finn", "imass" }
    if not MODELS[word] then
        c.leave("the law '" .. word .. "' of zones; those of Talus: talus help solids")
    end
    c.zone_law(range.read(c, a), MODELS[word], a.command)
end

local function property(c, a)
    local changes = {}
    while not a:at_range() do
        local word = a:keyword(KNOWN)
        changes[word] = a:number(word)
    end
    c.zone_properties(range.read(c, a), changes)
end

return function(row)
    row("block zone generate|generate", { form = "edgelength f | center [range] (gen edge f)", becomes = "selection:deformable{zone =, solid =}",
        example = { "block zone generate edgelength 0.6\nblock zone cmodel assign elastic\nblock zone property density 2500 bulk 1e9 shear 5e8",
            "gen edge 0.6\nprop mat=1 dens 2500 bulk 1e9 shear 5e8" }, convert = generate })
    row("block zone cmodel", { form = "assign elastic | mohr-coulomb [range]", becomes = 'model:solid("...", "elastic", {...})',
        example = "block zone gen edge .6\nblock zone cmodel assign mohr-c\nblock zone prop dens 2500 young 1e9 poiss 0.2 coh 1e6 fric 30",
        convert = model })
    row("block zone property", { form = "density f bulk f shear f (young f poisson f) [cohesion f friction f tension f] [range]",
        becomes = 'model:solid("...", ..., {bulk =, shear =, ...}), selection:set{density =, solid =}',
        example = "block zone gen edge .6\nblock zone cmodel assign elastic\nblock zone property dens 2500 bulk 1e9 shear 5e8",
        convert = property })
    row("block zone nodal-mixed-discretization|block zone list|block zone group|block zone initialize|block zone history",
        { lacks = "zones are read by model:zones{...}" })
end
