-- joints.lua - which law which contacts have: what model:joint is called with.
--
-- 3DEC gives properties to the contacts of a range, and to those that come later by a table. Talus keeps rules. A rule
-- here is a target of model:joint with all its properties so far; it is written anew whenever one of them changes.
local lexer = require "talus.threedec.lexer"
local match = require "talus.threedec.match"
local range = require "talus.threedec.range"
local joints = {}

-- Words of 3DEC 7, the classic ones, and parameters of Talus's laws.
local properties = {
    { "kn", "stiffness-normal", "jkn" },
    { "ks", "stiffness-shear", "jks" },
    { "friction", "friction", "jfriction" },
    { "cohesion", "cohesion", "jcohesion" },
    { "tension", "tension", "jtension" },
    { "dilation", "dilation", "jdilation" },
    { "dilation_limit", "dilation-zero", "zdilation" },
    { "residual_friction", "friction-residual", "resfriction" },
    { "residual_cohesion", "cohesion-residual", "rescohesion" },
    { "residual_tension", "tension-residual", "restension" },
}
joints.properties = properties

local names, classic = {}, {}
for _, row in ipairs(properties) do
    names[#names + 1], names[row[2]] = row[2], row[1]
    classic[#classic + 1], classic[row[3]] = row[3], row[1]
end

-- Reads `stiffness-normal 1e9 ...` up to the range; `is_classic` for jkn ....
function joints.read(c, a, is_classic)
    local words, changes = is_classic and classic or names, {}
    while not a:at_range() do
        local word = a:keyword(words)
        changes[words[word]] = a:number(word)
    end
    return changes
end

-- The target of model:joint for a range of contacts.
function joints.target(c, list)
    list = list and range.flat(list)
    if not list or #list == 0 then
        return '"*"'
    end
    local e = list[1]
    if #list == 1 and not e.negate then
        if e.kind == "group" and #e.names == 1 then
            return ("{ group = %q }"):format(e.names[1])
        elseif e.kind == "between" then
            return ("{ between = { %q, %q } }"):format(e[1], e[2])
        elseif e.kind == "joint" then
            return ("%q"):format(e.joint)
        end
    end
    return "{ contacts = model:contacts { where = " .. range.predicate(list, "contact", c) .. " } }"
end

local function not_zero(item)
    return item ~= nil and item.value ~= 0
end

-- The call of a rule; nil while its stiffness is not known.
local function call_of(c, rule)
    local p = rule.properties
    if not p.kn or not p.ks then
        return nil
    end
    local law = "elastic"
    local order = { "kn", "ks" }
    if rule.law == "mohr" then
        local bonded = not_zero(p.cohesion) or not_zero(p.tension)
        law = bonded and "coulomb_tensile" or "coulomb"
        order = bonded and { "kn", "ks", "friction", "cohesion", "tension", "residual_friction", "residual_cohesion",
            "residual_tension", "dilation", "dilation_limit" } or { "kn", "ks", "friction", "dilation", "dilation_limit" }
    end
    local parts = {}
    for _, name in ipairs(order) do
        local item = p[name]
        if item and (name == "kn" or name == "ks" or not_zero(item) or name == "residual_friction") then
            parts[#parts + 1] = name .. " = " .. item.lua
        end
    end
    return ("model:joint(%s, %q, { %s })"):format(rule.target, law, table.concat(parts, ", "))
end

-- Nothing is written while kn or ks is not known; c.ready tells when a run begins so.
local function write(c, rule)
    local call = call_of(c, rule)
    if call then
        c.emit(call)
    end
end

-- Gives the contacts of a target properties, or another law. All contacts are those of every rule.
function joints.apply(c, target, changes, law)
    local rule, own = nil, {}
    for _, known in ipairs(c.rules) do
        own[known.target] = known
    end
    rule = own[target]
    if not rule then
        rule = { target = target, law = "mohr", properties = {} }
        local all = own['"*"']
        if all then
            rule.law = all.law
            for name, item in pairs(all.properties) do
                rule.properties[name] = item
            end
        end
        c.rules[#c.rules + 1] = rule
    end
    for _, known in ipairs(target == '"*"' and c.rules or { rule }) do
        known.law = law or known.law
        for name, item in pairs(changes) do
            known.properties[name] = item
        end
        write(c, known)
    end
end

-- The law of contacts that come later: in Talus that of all contacts without a rule of their own.
function joints.later(c, changes, law)
    for _, rule in ipairs(c.rules) do
        if rule.target == '"*"' then
            local differ
            for name, item in pairs(changes) do
                local now = rule.properties[name]
                differ = differ or now and now.value ~= item.value and name
                rule.properties[name] = now or item
            end
            if differ then
                c.note("new contacts have the " .. differ .. " of those that are there")
            end
            write(c, rule)
            return
        end
    end
    joints.apply(c, '"*"', changes, law)
end

-- mohr or elastic; other joint models are left out.
local MODELS = { "mohr", "elastic", "bilinear-mohr", "softening-mohr", "nonlinear", "power", "cyjm", "ratestate",
    "velocity-weakening" }
function joints.law(c, word, command)
    local model = match.find(word, MODELS, command) or word
    if model ~= "mohr" and model ~= "elastic" then
        c.leave("the joint model '" .. model .. "' is not converted; laws of Talus: talus help laws")
    end
    return model
end

-- ---------------------------------------------------------------- classic materials ------

-- Properties of the joint material `number` change: so do the contacts that have it.
function joints.material(c, number, changes, law)
    local material = c.joint_materials[number]
    if not material then
        material = { properties = {}, targets = number == 1 and { '"*"' } or {} }
        c.joint_materials[number] = material
    end
    for name, item in pairs(changes) do
        material.properties[name] = item
    end
    for _, target in ipairs(material.targets) do
        joints.apply(c, target, changes, law)
    end
end

-- The contacts of a target get the joint material `number`.
function joints.assign(c, number, target)
    for other, material in pairs(c.joint_materials) do
        for i = #material.targets, 1, -1 do
            if material.targets[i] == target then
                table.remove(material.targets, i)
            end
        end
    end
    joints.material(c, number, {})
    local material = c.joint_materials[number]
    material.targets[#material.targets + 1] = target
    if next(material.properties) then
        joints.apply(c, target, material.properties)
    end
end

return joints
