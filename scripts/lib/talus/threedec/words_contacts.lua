-- words_contacts.lua - commands that give joints their laws and properties.
local joints = require "talus.threedec.joints"
local range = require "talus.threedec.range"

local function property(c, a)
    local changes = joints.read(c, a)
    joints.apply(c, joints.target(c, range.read(c, a)), changes)
end

local function model(c, a)
    a:take "assign"
    local law = joints.law(c, a:text "the joint model", a.command)
    joints.apply(c, joints.target(c, range.read(c, a)), {}, law)
end

local function material_table(c, a)
    local word = a:keyword { "default", "add", "apply", "list", "modify", "remove", "property" }
    if word ~= "default" and word ~= "property" then
        c.leave("new contacts have the rules of model:joint; '" .. word .. "' is not converted")
    end
    local law
    if a:take "jmodel" then
        law = joints.law(c, a:text "the joint model", a.command)
    end
    local changes = {}
    if word == "property" or a:take "property" then
        changes = joints.read(c, a)
    end
    joints.later(c, changes, law)
end

-- `prop mat=i ...` or `prop jmat=i ...`, both may stand in one command.
local function classic_property(c, a)
    local kind, number
    local known = { "material", "jmaterial", "density", "kn", "ks", "bulk", "shear", "young", "poisson", "k", "g", "cohesion",
        "bcohesion", "friction", "phi", "tension", "dilation", "psi" }
    for _, row in ipairs(joints.properties) do
        known[#known + 1] = row[3]
    end
    local block, joint = {}, {}
    while a:more() do
        local word = a:keyword(known)
        if word == "material" or word == "jmaterial" then
            kind, number = word, a:whole "the material's number"
        else
            local item = a:number(word)
            if word:sub(1, 1) == "j" or word:sub(1, 3) == "res" or word == "zdilation" or kind == "jmaterial" then
                joint[#joint + 1] = { word, item }
            else
                block[word] = item
            end
        end
    end
    number = number or 1
    if #joint > 0 then
        local changes = {}
        for _, pair in ipairs(joint) do
            for _, row in ipairs(joints.properties) do
                if pair[1] == row[3] or pair[1] == row[1] then
                    changes[row[1]] = pair[2]
                end
            end
        end
        joints.material(c, number, changes)
    end
    if next(block) then
        c.material(number, block)
    end
end

local function change(c, a)
    local what = {}
    local known = { "material", "jmaterial", "constitutive", "jconstitutive" }
    while not a:at_range() do
        local word = a:keyword(known)
        what[word] = a:whole("the number after " .. word)
    end
    local list = range.read(c, a)
    if what.material then
        c.change_material(what.material, list)
    end
    if what.jconstitutive and what.jconstitutive > 2 then
        c.leave("jcons=" .. what.jconstitutive .. " is not converted; laws of Talus: talus help laws")
    end
    if what.jmaterial then
        joints.assign(c, what.jmaterial, joints.target(c, list))
    end
    if what.constitutive then
        c.zone_law(list, what.constitutive == 1 and "elastic" or "mohr_coulomb", a.command)
    end
    c.nothing = not what.jmaterial and not what.material
end

return function(row)
    row("block contact jmodel", { form = "assign mohr | elastic [range]", becomes = 'model:joint("*", "coulomb", {...}), ' ..
        '"coulomb_tensile" with cohesion or tension, "elastic"; of a range model:joint({group = ...}, ...)',
        example = { "block contact jmodel assign mohr\nblock contact prop stiffness-normal 1e9 stiffness-shear 1e9",
            "block con prop stiff-n 1e9 stiff-s 1e9\nblock contact jmodel assign elastic" }, convert = model })
    row("block contact property", { form = "stiffness-normal f stiffness-shear f [friction f] [cohesion f] [tension f] " ..
        "[dilation f] [dilation-zero f] [friction-residual f] ... [range]",
        becomes = 'model:joint("*", "coulomb", {kn =, ks =, friction =, ...})',
        example = { "block contact property stiffness-normal 1e9 stiffness-shear 5e8 friction 30",
            "block contact property stiffness-normal 1e9 stiffness-shear 5e8 fric 30 coh 1e5 ten 1e4 fric-res 25" },
        convert = property })
    row("block contact material-table", { form = "default [jmodel s] property ...", becomes = 'model:joint("*", ...)',
        example = "block contact material-table default property stiffness-normal 1e9 stiffness-shear 1e9 friction 20",
        convert = material_table })
    row("property", { form = "mat i dens f [bulk f shear f ...] | jmat i jkn f jks f [jfric f] [jcoh f] [jten f] [jdil f]",
        becomes = 'selection:set{density = ...}, model:joint("*", ...), model:solid(...)',
        example = { "prop mat=1 dens=2500", "prop jmat=1 jkn=1e9 jks=1e9 jfric=30 jcoh 1e4" }, convert = classic_property })
    row("change", { form = "mat i | jmat i | jcons i | cons i [range]",
        becomes = "selection:set{density = ...}, model:joint({group = ...}, ...)",
        example = { "prop mat=2 dens=2700\nchange mat=2 range z 0.5 1", "prop jmat=1 jkn 1e9 jks 1e9\nchange jcons 1 jmat 1" },
        convert = change })
    row("block contact generate-subcontacts", { needless = "contacts are found by themselves" })
    row("block contact reset", { lacks = "shear displacement of contacts follows from displacements: reset those" })
    row("block contact tolerance|block tolerance|block contact area-minimum|block contact compute|atol|ctol",
        { needless = "contacts are found by themselves, with tolerances by the size of blocks" })
    row("block contact list|block contact history|block contact group|block contact group-subcontact|" ..
        "block contact apply|block contact join", { lacks = "contacts are read by model:contacts{...}, which may be a history" })
    row("block face triangulate", { form = "[radial-8 | edge-max f]",
        becomes = 'model.contact_points = "consistent": the joint that 3DEC tends to with finer faces',
        example = "block face triangulate radial-8",
        convert = function(c, a)
            c.emit 'model.contact_points = "consistent"'
            a.at = #a.tokens + 1
        end })
end
