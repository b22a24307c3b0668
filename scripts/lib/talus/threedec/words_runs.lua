-- words_runs.lua - commands for the whole model: gravity, damping, runs, histories, saves.
local range = require "talus.threedec.range"
local lexer = require "talus.threedec.lexer"

local function gravity(c, a)
    local first = a:number "gravity"
    local y = a:optional()
    if not y then
        c.emit("model.gravity = { 0, 0, -" .. (first.level < 4 and "(" .. first.lua .. ")" or first.lua) .. " }")
        return
    end
    c.emit("model.gravity = " .. c.list { first, y, a:number "gravity" })
end

local function damping(c, a)
    local word = a:keyword { "local", "global", "auto", "combined", "rayleigh", "viscous", "none", "maxwell", "stiffness" }
    if word == "global" or word == "auto" then
        c.emit 'model:damping "adaptive"'
        a.at = #a.tokens + 1
    elseif word == "local" or word == "combined" then
        local alpha = a:optional()
        c.emit(alpha and ('model:damping("local", { alpha = %s })'):format(alpha.lua) or 'model:damping "local"')
        if word == "combined" then
            c.note "combined damping becomes local"
        end
    elseif word == "rayleigh" then
        local fraction, frequency = a:number "the fraction of critical damping", a:number "the frequency"
        local kind = a:take("mass", "stiffness")
        if fraction.value == 0 or frequency.value == 0 then
            c.emit 'model:damping "none"'
        elseif kind == "stiffness" then
            c.leave "damping in proportion to stiffness"
        else
            if not kind then
                c.note "the part in proportion to stiffness is dropped"
            end
            c.emit(('model:damping("viscous", { alpha = %s })'):format(c.value((kind and 2 or 1) * 2 * math.pi * fraction.value *
                frequency.value).lua))
        end
    elseif word == "none" then
        c.emit 'model:damping "none"'
    else
        c.leave("'" .. word .. "' damping; Talus has local, adaptive, viscous and kinetic")
    end
end

-- Classic `damp auto`, `damp local`, `damp f1 f2 mass`.
local function classic_damping(c, a)
    if a:sees_number() then
        table.insert(a.tokens, a.at, { kind = "word", text = "rayleigh" })
    end
    damping(c, a)
end

local function cycle(c, a)
    local number = a:number "the number of cycles"
    c.ready()
    if not c.dynamic and not c.scaled then
        c.emit "model:mass_scaling(true)"
        c.scaled = true
    end
    c.emit("model:cycle(" .. number.lua .. ")")
end

local MEASURES = { ["ratio"] = "average", ["ratio-average"] = "average", ["ratio-maximum"] = "maximum", ["ratio-local"] = "local",
    convergence = "local" }

local function solve(c, a)
    local ratio, measure, cycles, time = nil, "average", nil, nil
    local known = { "ratio", "ratio-average", "ratio-maximum", "ratio-local", "convergence", "cycles", "steps", "cycles-total", "time",
        "time-total", "elastic", "fos", "mechanical", "clock", "or", "and", "unbalanced-maximum", "force", "maximum", "average", "local" }
    while a:more() do
        local word = a:sees_number() and "ratio" or a:keyword(known)
        if MEASURES[word] then
            ratio, measure = a:number(word), MEASURES[word]
        elseif word == "maximum" or word == "average" or word == "local" then
            measure = word
        elseif word == "cycles" or word == "steps" or word == "cycles-total" then
            cycles = a:number(word)
        elseif word == "time" or word == "time-total" then
            time = a:number(word)
        elseif word == "elastic" then
            a:take "only"
            c.note "the elastic stage of solve is left out"
        elseif word == "fos" then
            c.leave "a factor of safety by strength reduction"
        elseif word ~= "mechanical" and word ~= "or" and word ~= "and" then
            a:number(word)
            c.note("the limit '" .. word .. "' is dropped")
        end
    end
    c.ready()
    local parts = {}
    if time then
        parts = { "ratio = 0", "max_time = " .. time.lua }
    else
        parts = { "ratio = " .. (ratio and ratio.lua or "1e-5"), ("measure = %q"):format(measure) }
    end
    if cycles then
        parts[#parts + 1] = "max_cycles = " .. cycles.lua
    end
    local inside = table.concat(parts, ", ")
    if time or c.dynamic or c.driven then
        if not c.dynamic and not c.scaled and not time then
            c.emit "model:mass_scaling(true)"
            c.scaled = true
        end
        c.emit(('print("solve: " .. model:solve { %s }.reason)'):format(inside))
    else
        c.emit(('print("solve: " .. model:relax { %s }.message)'):format(inside))
    end
end

local function dynamic(c, on)
    c.dynamic = on
    if c.scaled then
        c.emit "model:mass_scaling(false)"
        c.scaled = false
    else
        c.nothing = true
    end
end

local function file_name(name)
    return (name:gsub("%.sav$", ""):gsub("%.3dsav$", "")) .. ".talus"
end

local FIELDS = { displacement = "displacement", velocity = "velocity", fob = "force" }
local RATIOS = { ["unbalanced"] = "ratio", ["unbalanced-maximum"] = "ratio_maximum", ratio = "ratio", ["ratio-local"] = "ratio_local",
    ["ratio-average"] = "ratio", ["ratio-maximum"] = "ratio_maximum", convergence = "ratio_local", mechanical = "ratio" }

local function history_known()
    local known = { "name", "interval", "position", "gridpoint", "export", "write", "id", "ncycle", "nc", "n", "mechanical", "dynamic",
        "time", "list", "delete", "purge", "file", "label", "xdisplacement", "ydisplacement", "zdisplacement", "xvelocity",
        "yvelocity", "zvelocity", "stress", "szz", "sxx", "syy", "damp", "acceleration", "type", "add", "create" }
    for word in pairs(FIELDS) do
        known[#known + 1] = word
        for axis in ("xyz"):gmatch "." do
            known[#known + 1] = word .. "-" .. axis
        end
    end
    for word in pairs(RATIOS) do
        known[#known + 1] = word
    end
    table.sort(known)
    return known
end
local HISTORY = history_known()

local function history(c, a)
    local name, place, what, field, axis
    while a:more() do
        if a:sees_number() then
            if not what then
                a:number "the number"
            elseif place then
                lexer.mistake("%s: the number %s is not expected", a.command, a:number("it").lua)
            else
                place = a:vector "the place"
            end
        else
            local word = a:keyword(HISTORY)
            local plain = word:gsub("%-[xyz]$", ""):gsub("^[xyz](%a+)$", "%1")
            if word == "name" or word == "id" or word == "label" then
                name = a:text "the name"
            elseif word == "interval" or word == "ncycle" or word == "nc" or word == "n" then
                c.history_interval = a:number(word).lua
            elseif word == "position" then
                place = a:vector "the place"
            elseif word == "export" or word == "write" or word == "file" then
                local file
                while a:more() do
                    file = a:text "a file"
                end
                file = file and file:match "%D" and file:gsub("%.%w+$", "") or "histories"
                c.emit(("model:write_histories(%q)"):format(file .. ".csv"))
                return
            elseif FIELDS[plain] then
                what, field = word, FIELDS[plain]
                axis = word:match "%-([xyz])$" or word:match "^([xyz])%a"
            elseif RATIOS[word] then
                what, field = word, nil
            elseif word ~= "add" and word ~= "create" and word ~= "type" then
                c.leave("a history of '" .. word .. "'; model:history{...} samples any function")
            end
        end
    end
    if not what then
        c.nothing = true
        return
    end
    c.histories = c.histories + 1
    name = name or tostring(c.histories)
    local head = ("model:history { name = %q, every = %s, "):format(name, c.history_interval)
    if not field then
        c.emit(head .. ("value = %q }"):format(RATIOS[what]))
        return
    end
    if not place then
        c.leave "a history without a place"
    end
    c.use "distance"
    c.use "nearest"
    c.emit(head .. ("of = nearest %s, field = %q }"):format(c.list(place), field))
    if axis then
        c.remark(what .. " is number " .. ({ x = 1, y = 2, z = 3 })[axis] .. " of the three; of the centroid")
    end
end

return function(row)
    row("model new|new", { form = "", becomes = "talus.model{...}", example = "model new",
        convert = function(c, a)
            if c.blocks_made then
                c.restart()
            else
                c.nothing = true
            end
            a.at = #a.tokens + 1
        end })
    row("model gravity|gravity|set gravity", { form = "f | gx gy gz", becomes = "model.gravity = {gx, gy, gz}",
        example = { "model gravity 9.81", "grav 0 0 -10" }, convert = gravity })
    row("block mechanical damping", { form = "local [f] | global | rayleigh f f [mass]",
        becomes = 'model:damping "local", "adaptive", "viscous"', example = { "block mechanical damping global",
            "block mech damp loc 0.7", "block mech damp rayleigh 0.1 5 mass" }, convert = damping })
    row("damping|damp", { form = "auto | local [f] | f f [mass]", becomes = 'model:damping "adaptive", "local", "viscous"',
        example = { "damp auto", "damp local", "damp 0.1 5 mass" }, convert = classic_damping })
    row("block mechanical mass-scale|mscale", { form = "[on | off] [timestep f]", becomes = "model:mass_scaling(true), {dt =}",
        example = { "mscale on", "block mech mass-scale on timestep 1e-4" }, convert = function(c, a)
            local on = a:switch(true)
            local dt = a:take("timestep", "dt") and a:number "timestep"
            c.emit(dt and ("model:mass_scaling { dt = %s }"):format(dt.lua) or ("model:mass_scaling(%s)"):format(tostring(on)))
            c.scaled = on
        end })
    row("model solve|solve", { form = "[ratio f | ratio-local f | ratio-maximum f] [cycles i] [time f]",
        becomes = "model:relax{ratio =, measure =}; in time, and where blocks are driven, model:solve{...}",
        example = { "block contact prop stiffness-normal 1e9 stiffness-shear 1e9 fric 30\nblock fix\nmodel solve ratio-local 1e-5",
            "prop jmat=1 jkn 1e9 jks 1e9\nfix\nsolve ratio 1e-5 steps 100", "prop jmat=1 jkn 1e9 jks 1e9\nfix\nsolve time 1e-3" },
        convert = solve })
    row("model cycle|model step|cycle|step", { form = "i", becomes = "model:cycle(i), static ones with model:mass_scaling(true)",
        example = { "block contact prop stiffness-normal 1e9 stiffness-shear 1e9\nmodel cycle 10", "prop jmat=1 jkn 1e9 jks 1e9\ncyc 5" },
        convert = cycle })
    row("model dynamic|set dynamic", { form = "active on | off", becomes = "runs in time, without mass scaling",
        example = "model dynamic active on", convert = function(c, a)
            a:take "active"
            if a:sees("on", "off", "yes", "no", "true", "false") then
                dynamic(c, a:switch(true))
            else
                c.leave "give the time step by model:timestep{dt = ...}"
            end
        end })
    row("block history|history|model history", { form = "displacement-x | velocity-z | ratio ... position v [name s] [interval i]; export",
        becomes = "model:history{...}, model:write_histories",
        example = { "block history displacement-z position 0.5 0.5 0.5 name 'roof'", "hist n=5 zdisp .5 .5 .5\nhist unbal",
            "history interval 20" }, convert = history })
    row("model save|save", { form = "s", becomes = "model:save(...)", example = "model save 'state'",
        convert = function(c, a)
            local name = a:text "the file"
            a:take("compress", "text", "binary")
            c.ready()
            c.emit(("model:save(%q)"):format(file_name(name)))
        end })
    row("model restore|restore", { form = "s", becomes = "talus.restore(...)", example = "model save 'state'\nmodel restore 'state'",
        convert = function(c, a)
            c.emit(("model = talus.restore(%q)"):format(file_name(a:text "the file")))
        end })
    row("model title|title|heading", { form = "s", becomes = "a comment", example = "model title 'a wall'",
        convert = function(c, a)
            local list = {}
            while a:more() do
                list[#list + 1] = a:text "the title"
            end
            c.remark(table.concat(list, " "))
            c.nothing = true
        end })
    row("model configure|config|model large-strain|model deterministic|block energy|block mechanical energy|program echo|" ..
        "program threads|set", { needless = "Talus follows large displacements, keeps an energy ledger and gives the same bits always",
        example = { "model large-strain on", "config dynamic" } })
    row("return|ret|program return|end|quit|exit|stop|program quit|program exit|program stop", { needless = "the end of the file" })
    row("model random", { form = "i", needless = "draws follow from talus.model{seed = ...}; those of 3DEC are others" })
end
