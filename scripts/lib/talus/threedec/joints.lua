-- joints.lua - which law which contacts have: what model:joint is called with.
--
-- 3DEC gives properties to the contacts of a range, and to those that come later by a table. Talus keeps rules. A rule
-- here is a target of model:joint with all its properties so far; it is written anew whenever one of them changes. Rules
-- are as many as the parts into which ranges divide each other: a contact has what the smallest rule that holds it says.
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

-- ---------------------------------------------------------------- targets ----------------
--
-- A target is what all of its elements hold for: a joint, one group or two, and conditions. Two targets have a target in
-- common, or none: two groups of a contact make `between`, and a contact has one joint.

-- What tells a target from others, and of how many elements it is.
local function key_of(t)
    local parts = { t.joint or "*" }
    table.move(t.groups, 1, #t.groups, 2, parts)
    local conditions = {}
    for text in pairs(t.conditions) do
        conditions[#conditions + 1] = text
    end
    table.sort(conditions)
    return table.concat(parts, "\n") .. "\n\n" .. table.concat(conditions, "\n"), #parts - (t.joint and 0 or 1) + #conditions
end

local function finish(t)
    t.key, t.size = key_of(t)
    t.plain = next(t.conditions) == nil
    return t
end

-- The groups of contacts with both; nil when no contact has.
local function common_groups(one, other)
    if #one > #other then
        one, other = other, one
    end
    if #one == 0 then
        return other
    elseif #one == 1 and #other == 1 then
        local a, b = one[1], other[1]
        return a == b and one or a < b and { a, b } or { b, a }
    elseif #one == 1 then
        return (one[1] == other[1] or one[1] == other[2]) and other or nil
    end
    return one[1] == other[1] and one[2] == other[2] and one or nil
end

-- Whether no place is in both ranges of one axis.
local function apart(one, other)
    if one.kind ~= "axis" or other.kind ~= "axis" or one.axis ~= other.axis or one.negate or other.negate then
        return false
    end
    local function span(e)
        local low, high = math.min(e.from.value, e.to.value), math.max(e.from.value, e.to.value)
        return e.about and low - 1e-6 or low, e.about and high + 1e-6 or high
    end
    local low, high = span(one)
    local other_low, other_high = span(other)
    return high < other_low or other_high < low
end

-- The target of what is in both; nil when nothing is.
local function common(one, other)
    local groups = common_groups(one.groups, other.groups)
    if not groups or one.joint and other.joint and one.joint ~= other.joint then
        return nil
    end
    local conditions = {}
    for text, e in pairs(one.conditions) do
        conditions[text] = e
    end
    for text, e in pairs(other.conditions) do
        for _, known in pairs(one.conditions) do
            if apart(known, e) then
                return nil
            end
        end
        conditions[text] = e
    end
    return finish { joint = one.joint or other.joint, groups = groups, conditions = conditions }
end

local ALL = finish { groups = {}, conditions = {} }

local function holds(whole, part)
    local both = common(whole, part)
    return both ~= nil and both.key == part.key
end

-- The target of one element of a range.
local function target_of(c, e)
    if not e.negate and e.kind == "group" and #e.names == 1 then
        return finish { groups = { e.names[1] }, conditions = {} }
    elseif not e.negate and e.kind == "between" then
        return finish { groups = e[1] < e[2] and { e[1], e[2] } or { e[2], e[1] }, conditions = {} }
    elseif not e.negate and e.kind == "joint" then
        return finish { joint = e.joint, groups = {}, conditions = {} }
    end
    return finish { groups = {}, conditions = { [range.predicate({ e }, "contact", c)] = e } }
end

-- The target of a range of contacts; nil when none can be in it.
function joints.target(c, list)
    list = range.flat(list or {})
    if list.union and #list > 1 then
        list = { { kind = "named", range = list } }
    end
    local target = ALL
    for _, e in ipairs(list) do
        target = target and common(target, target_of(c, e))
    end
    return target
end

-- What model:joint is called with.
local function target_text(c, t)
    local parts = { t.joint and ("joint = %q"):format(t.joint) }
    if not t.plain then
        local list = {}
        if #t.groups == 1 then
            list[1] = { kind = "group", names = t.groups }
        elseif #t.groups == 2 then
            list[1] = { kind = "between", t.groups[1], t.groups[2] }
        end
        local texts = {}
        for text in pairs(t.conditions) do
            texts[#texts + 1] = text
        end
        table.sort(texts)
        for _, text in ipairs(texts) do
            list[#list + 1] = t.conditions[text]
        end
        parts[#parts + 1] = "contacts = model:contacts { where = " .. range.predicate(list, "contact", c) .. " }"
    elseif #t.groups == 2 then
        parts[#parts + 1] = ("between = { %q, %q }"):format(t.groups[1], t.groups[2])
    elseif #t.groups == 1 then
        parts[#parts + 1] = ("group = %q"):format(t.groups[1])
    else
        return ("%q"):format(t.joint or "*")
    end
    return "{ " .. table.concat(parts, ", ") .. " }"
end

-- ---------------------------------------------------------------- rules ------------------

-- Limit: rules of a file. Ranges that overlap need one for each of their common parts, up to 2^n of n ranges.
local MOST_RULES = 100

local function not_zero(item)
    return item ~= nil and item.value ~= 0
end

-- Law and parameters of a rule as text; nil while its stiffness is not known.
local function law_text(rule)
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
    return ("%q, { %s }"):format(law, table.concat(parts, ", "))
end

-- The rule of just this target, or nil.
local function find(c, target)
    for _, rule in ipairs(c.rules) do
        if rule.target.key == target.key then
            return rule
        end
    end
    return nil
end

-- Adds the rule of a target. It begins as the smallest of the rules that hold it, which is part of all others.
local function add(c, target, rules)
    local base
    for _, rule in ipairs(rules) do
        if holds(rule.target, target) and (not base or rule.target.size > base.target.size) then
            base = rule
        end
    end
    local new = { target = target, law = base and base.law or "mohr", material = base and base.material or 1, properties = {} }
    for name, item in pairs(base and base.properties or {}) do
        new.properties[name] = item
    end
    c.rules[#c.rules + 1] = new
    return new
end

-- The rules of all contacts of a target. In 3DEC the last command wins, in Talus the rule that names more, and of equal
-- ones the later. So what a target has in common with each rule becomes a rule of its own.
local function rules_of(c, target)
    local before = table.move(c.rules, 1, #c.rules, 1, {})
    local own = find(c, target) or add(c, target, before)
    for _, rule in ipairs(before) do
        local both = common(rule.target, target)
        if both and not find(c, both) then
            if #c.rules < MOST_RULES then
                add(c, both, before)
            else
                own.crowded = true
            end
        end
    end
    if own.crowded then
        c.note(("more than %d ranges of contacts overlap: some keep the properties of another range"):format(MOST_RULES))
    end
    local inside = {}
    for _, rule in ipairs(c.rules) do
        if holds(target, rule.target) then
            inside[#inside + 1] = rule
        end
    end
    return inside
end

-- Writes rules, the smaller after the larger, and again those of contacts inside of them, which are to be the later
-- ones. `first` is what the command names; the others may have no contacts any more.
local function write(c, changed, first)
    local list = {}
    for order, rule in ipairs(c.rules) do
        local written
        for _, one in ipairs(changed) do
            written = written or rule == one or not rule.target.plain and holds(one.target, rule.target)
        end
        rule.order = order
        list[#list + 1] = written and rule or nil
    end
    table.sort(list, function(a, b)
        if a.target.size ~= b.target.size then
            return a.target.size < b.target.size
        end
        return a.order < b.order
    end)
    for _, rule in ipairs(list) do
        local law, target = law_text(rule), target_text(c, rule.target)
        local always = rule.target.key == first.key or rule.target.plain and #rule.target.groups == 0
        if law and not always then
            c.use "joint_again"
        end
        if law then -- c.ready tells when a run begins without
            c.emit(("%s(%s, %s)"):format(always and "model:joint" or "joint_again", target, law))
        end
    end
end

-- Gives the contacts of a target properties, or another law.
function joints.apply(c, target, changes, law)
    if not target then
        c.note "no contact is in this range"
        return
    end
    local rules = rules_of(c, target)
    for _, rule in ipairs(rules) do
        rule.law = law or rule.law
        for name, item in pairs(changes) do
            rule.properties[name] = item
        end
    end
    write(c, rules, target)
end

-- The law of contacts that come later: in Talus that of all contacts without a rule of their own.
function joints.later(c, changes, law)
    local rule, differ = find(c, ALL), nil
    if not rule then
        joints.apply(c, ALL, changes, law)
        return
    end
    for name, item in pairs(changes) do
        local now = rule.properties[name]
        differ = differ or now and now.value ~= item.value and name
        rule.properties[name] = now or item
    end
    if differ then
        c.note("new contacts have the " .. differ .. " of those that are there")
    end
    write(c, { rule }, ALL)
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

-- Properties of the joint material `number` change: so do the contacts that have it. All contacts begin with number 1.
function joints.material(c, number, changes)
    local material = c.joint_materials[number] or {}
    c.joint_materials[number] = material
    for name, item in pairs(changes) do
        material[name] = item
    end
    if number == 1 and not find(c, ALL) then
        add(c, ALL, {})
    end
    local changed = {}
    for _, rule in ipairs(c.rules) do
        if rule.material == number then
            changed[#changed + 1] = rule
            for name, item in pairs(changes) do
                rule.properties[name] = item
            end
        end
    end
    write(c, changed, ALL)
end

-- The contacts of a target get the joint material `number`, with all of its properties.
function joints.assign(c, number, target)
    if not target then
        c.note "no contact is in this range"
        return
    end
    local rules = rules_of(c, target)
    for _, rule in ipairs(rules) do
        rule.material, rule.properties = number, {}
        for name, item in pairs(c.joint_materials[number] or {}) do
            rule.properties[name] = item
        end
    end
    write(c, rules, target)
end

return joints
