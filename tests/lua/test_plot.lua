-- talus.plot: where lines, ticks and names stand in the SVG file, bad input, the same bytes each time.
local talus = require "talus"
local check = require "check"

local folder = string.format("%s/plot_%s", assert(os.getenv("TALUS_TEST_TMP")),
    tostring({}):match("0x(%x+)") or "0")
local path = folder .. "/deep/er/picture.svg"

local function read(name)
    local file = assert(io.open(name))
    local text = file:read("a")
    file:close()
    return text
end

local function draw(arguments)
    arguments.file = arguments.file or path
    talus.plot(arguments)
    local text = read(arguments.file)
    check.equal(text:sub(1, 4), "<svg")
    check.equal(text:sub(-7), "</svg>\n")
    check.equal(select(2, text:gsub("<g[ >]", "")), select(2, text:gsub("</g>", "")))
    check.holds(utf8.len(text), "UTF-8")
    return text
end

-- Texts in their order: { x =, y =, anchor =, text = }.
local function texts(svg)
    local list = {}
    for x, y, anchor, text in svg:gmatch('<text x="([^"]*)" y="([^"]*)" font%-size="[^"]*" text%-anchor="(%a+)"[^>]*>(.-)</text>') do
        list[#list + 1] = { x = tonumber(x), y = tonumber(y), anchor = anchor, text = text }
    end
    return list
end

local function labels(svg, anchor)
    local list = {}
    for _, one in ipairs(texts(svg)) do
        if one.anchor == anchor then
            list[#list + 1] = one.text
        end
    end
    return list
end

local function has(svg, part)
    check.holds(svg:find(part, 1, true), "'" .. part .. "'")
end

-- Points of the lines, in their order.
local function lines(svg)
    local list = {}
    for path_text in svg:gmatch('<path d="(M[^"]*)" fill="none" stroke="#%x+" stroke%-width="1.5"') do
        local points = {}
        for x, y in path_text:gmatch("([%d.-]+) ([%d.-]+)") do
            points[#points + 1] = { tonumber(x), tonumber(y) }
        end
        list[#list + 1] = points
    end
    return list
end

-- The frame: left, top, right, bottom.
local function frame(svg)
    local x, y, w, h = svg:match('<clipPath id="area"><rect x="([^"]*)" y="([^"]*)" width="([^"]*)" height="([^"]*)"/>')
    return tonumber(x), tonumber(y), tonumber(x) + tonumber(w), tonumber(y) + tonumber(h)
end

-- A line from corner to corner, with ticks at round numbers.
check.equal(type(talus.plot), "function")
check.holds(require "talus.plot" == talus.plot, "the module is what talus has")
local svg = draw { series = { { x = { 0, 10 }, y = { -1, 2 } } }, x_axis = { name = "time", unit = "s" },
    y_axis = { name = "stress", unit = "MPa", range = { -1, 2 } }, title = "Here" }
local left, top, right, bottom = frame(svg)
local line = lines(svg)[1]
check.near(line[1], { left, bottom }, 0.011)
check.near(line[2], { right, top }, 0.011)
check.equal(table.concat(labels(svg, "end"), " "), "−1.0 −0.5 0.0 0.5 1.0 1.5 2.0")
check.equal(table.concat(labels(svg, "middle"), "|"), "0|2|4|6|8|10|Here|time (s)|stress (MPa)")
-- A tick stands where its number is.
for _, one in ipairs(texts(svg)) do
    local value = one.anchor == "middle" and tonumber(one.text)
    if value then
        check.near(one.x, left + value / 10 * (right - left), 0.011)
    end
end
-- The same bytes.
local again = folder .. "/again.svg"
draw { file = again, series = { { x = { 0, 10 }, y = { -1, 2 } } }, x_axis = { name = "time", unit = "s" },
    y_axis = { name = "stress", unit = "MPa", range = { -1, 2 } }, title = "Here" }
check.equal(read(again), svg)

-- Numbers far from one have a power of ten with the unit; text for an axis is its name.
svg = draw { series = { { y = { 0, 3e7 } } }, y_axis = { name = "force", unit = "N" }, x_axis = "step" }
has(svg, ">force (10⁶ N)</text>")
has(svg, ">step</text>")
has(svg, ">30</text>")
svg = draw { series = { { y = { 0, -2.5e-4 } } }, y_axis = "gap" }
has(svg, ">gap (10⁻⁶)</text>")
has(svg, ">−250</text>")
svg = draw { series = { { y = { 1000.0001, 1000.0002 } } } }
has(svg, ">1000.00016</text>")
svg = draw { series = { { y = { 7, 7, 7 } } } } -- a constant
check.near(lines(svg)[1][1][2], (select(2, frame(svg)) + select(4, frame(svg))) / 2, 0.011)

-- Logarithmic axes: powers of ten at even distances; what is not above zero makes a gap.
svg = draw { series = { { x = { 1, 10, 100, 1000 }, y = { 1, 0, 1e-4, 1e-6 } } }, x_axis = { log = true, range = { 1, 1000 } },
    y_axis = { log = true, range = { 1e-6, 1 } } }
left, top, right, bottom = frame(svg)
has(svg, '10<tspan dy="-4" font-size="9">−6</tspan>')
check.equal(#lines(svg), 1)
check.near(lines(svg)[1][1], { left + (right - left) * 2 / 3, top + (bottom - top) * 2 / 3 }, 0.011)
has(svg, "<circle") -- the point left alone
local ticks = {}
for _, one in ipairs(texts(svg)) do
    if one.anchor == "middle" and one.text:find("^10<") then
        ticks[#ticks + 1] = one.x
    end
end
check.equal(#ticks, 4)
for k = 1, 4 do
    check.near(ticks[k], left + (k - 1) / 3 * (right - left), 0.011)
end
svg = draw { series = { { y = { 2.1, 4.9 } } }, y_axis = { log = true } } -- a part of a decade
check.holds(#labels(svg, "end") >= 2, "ticks within a decade")

-- Gaps at nan and infinity; several series with a legend; styles; names escaped.
svg = draw { series = {
    { name = "a & b <c> \"d\" 'e'", y = { 1, 2, 0 / 0, 3, 4, 1 / 0, 5 } },
    { y = { 1, 2, 3, 4, 5, 6, 7 }, style = "points" },
    { name = "bad \xff\n", y = { 2, 3, 4, 5, 6, 7, 8 }, style = "both", colour = "#123456" },
} }
check.equal(#lines(svg), 3) -- two stretches of the first, one of the last
has(svg, "a &amp; b &lt;c&gt; &quot;d&quot; &apos;e&apos;")
has(svg, ">series 2</text>")
has(svg, "bad ??")
has(svg, 'stroke="#123456"')
check.holds(not draw({ series = { { y = { 1, 2 } } } }):find("series 1", 1, true), "no legend of one line without a name")
check.holds(not draw({ series = { { name = "n", y = { 1, 2 } } }, legend = false, y_axis = "y" }):find(">n<", 1, true), "no legend")

-- Of many points those are kept that can be seen: the highest and lowest of each half pixel.
local many = { x = {}, y = {} }
for i = 1, 100000 do
    many.x[i], many.y[i] = i, i == 54321 and 100 or i % 2
end
svg = draw { series = { many } }
check.holds(#lines(svg)[1] < 6000, "thinned out")
local highest = math.huge
for _, point in ipairs(lines(svg)[1]) do
    highest = math.min(highest, point[2])
end
left, top, right, bottom = frame(svg)
check.near(highest, top + 0.05 / 1.1 * (bottom - top), 0.011)

-- Histories.
local model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
check.raises(function() talus.plot { file = path, model = model } end, "the model has no history")
model:history { name = "fall", every = 1, of = model:blocks(), field = "displacement" }
model:history { name = "clock", every = 2, value = function(m) return m.time, m.cycles end }
model:history { name = "kinetic", every = 1, value = "kinetic" }
model:joint("*", "coulomb", { kn = 1e8, ks = 1e8 })
model:timestep { dt = 1e-3 }
model:cycle(10)
svg = draw { model = model }
for _, name in ipairs { "clock.1", "clock.2", "fall.x", "fall.y", "fall.z", "kinetic", "time (s)" } do
    has(svg, ">" .. name .. "</text>")
end
svg = draw { model = model, histories = { "kinetic" }, y_axis = { name = "energy", unit = "J" } }
check.equal(#lines(svg), 1)
check.equal(#lines(svg)[1], 11)
svg = draw { series = { { history = model:histories().fall, component = "z", against = "cycle", name = "sink" } } }
check.equal(#lines(svg), 1)
has(svg, ">cycle</text>")
has(svg, ">10</text>")

-- Bad input: one sentence at the line of the script, and no file.
local empty = folder .. "/none.svg"
local function refused(arguments, part)
    if type(arguments) == "table" and arguments.file == nil then
        arguments.file = empty
    end
    check.raises(function() talus.plot(arguments) end, part)
    check.equal(io.open(empty), nil)
end
local good = { { y = { 1, 2 } } }
refused(nil, "plot: the argument must be a table, not nil")
refused({ file = 3, series = good }, "plot: file must be text, not the number 3")
check.raises(function() talus.plot { series = good } end, "plot: 'file' is missing")
refused({ sries = good }, "plot: unknown parameter 'sries'; did you mean 'series'?")
refused({}, "plot: give series = {{x = {...}, y = {...}}, ...}, model or both")
refused({ series = 3 }, "series must be a table, not the number 3")
refused({ series = { 3 } }, "plot, series 1: the series must be a table")
refused({ series = { { y = { 1 }, nmae = "" } } }, "plot, series 1: unknown parameter 'nmae'; did you mean 'name'?")
refused({ series = { { x = { 1 } } } }, "plot, series 1: give y, a list of numbers, or history")
refused({ series = { good[1], { y = { 1, "2" } } } }, "plot, series 2: y[2] must be a number, not the string '2'")
refused({ series = { { x = { 1 }, y = { 1, 2 } } } }, "x has 1 numbers and y 2")
refused({ series = { { y = {} } } }, "no series has a point that can be drawn")
refused({ series = { { y = { 0 / 0, 1 / 0, 1e301 } } } }, "no series has a point that can be drawn")
refused({ series = { { y = { 0, -1 } } }, y_axis = { log = true } }, "a logarithmic axis takes numbers above 0 only")
refused({ series = { { y = { 1 }, style = "lines" } } }, "style = 'lines' is none of 'line', 'points', 'both'; did you mean 'line'?")
refused({ series = { { y = { 1 }, colour = 'red"/>' } } }, "is not of the form '#0072b2'")
refused({ series = { { y = { 1 }, component = 1 } } }, "component goes with history")
refused({ series = { { history = 3 } } }, "history must be one of model:histories(), not the number 3")
refused({ series = { { history = model:histories().fall, component = "w" } } }, "component must be \"x\", \"y\", \"z\" or")
refused({ series = { { history = model:histories().kinetic, component = 1 } } }, "has no component")
refused({ series = { { history = model:histories().kinetic, y = { 1 } } } }, "give either history or x and y")
refused({ model = 3 }, "model must be a model, not the number 3")
refused({ histories = { "fall" } }, "give model, too")
refused({ model = model, histories = { "fal" } }, "the model has no history 'fal' (it has: clock, fall, kinetic)")
refused({ series = good, x_axis = 3 }, "plot, x_axis: the axis must be a table")
refused({ series = good, x_axis = { unti = "s" } }, "did you mean 'unit'?")
refused({ series = good, x_axis = { log = 1 } }, "log must be true or false, not the number 1")
refused({ series = good, x_axis = { range = { 2, 1 } } }, "must ascend and be finite")
refused({ series = good, x_axis = { range = { 0 / 0, 1 } } }, "must ascend and be finite")
refused({ series = good, x_axis = { range = 3 } }, "range must be a list of two numbers")
refused({ series = good, x_axis = { range = { 0, 1 }, log = true } }, "of a logarithmic axis must be above 0")
refused({ series = good, width = 1e9 }, "width = 1000000000 is outside [200, 10000]")
refused({ series = good, width = 0 / 0 }, "width")
refused({ series = good, title = 3 }, "title must be text")
refused({ series = good, file = folder }, "plot: cannot write")
refused({ series = good, file = "" }, "the name of the file is empty")

-- Files of text.
local text = folder .. "/new/text.txt"
talus.write_file(text, "one\0two\n")
check.equal(read(text), "one\0two\n")
talus.write_file(text, "")
check.equal(read(text), "")
check.raises(function() talus.write_file(folder, "x") end, "talus.write_file: cannot write")
check.raises(function() talus.write_file(text) end, "the text must be a string, not nil")
check.raises(function() talus.write_file(3, "x") end, "the file's name must be a string, not the number 3")
check.raises(function() talus.write_file(text, "x", 1) end, "1 argument too many")

-- The help names every parameter that is taken, and no other.
local program = os.getenv("TALUS_PROGRAM")
for _, topic in ipairs { "plot", "stereonet" } do
    local pipe = assert(io.popen("'" .. program .. "' help " .. topic))
    local help = pipe:read("a")
    pipe:close()
    local names = {}
    for name in help:match("Parameters:\n(.*)$"):gmatch("\n?  (%l[%l_, ]-)  +[^\n]") do
        for word in name:gmatch("[%l_]+") do
            names[#names + 1] = word
        end
    end
    table.sort(names)
    local message = select(2, pcall(talus[topic], { file = empty, qqqqqqqqqqqqqqqqqqqqqq = 1 }))
    check.equal(message:match("%(known: (.*)%)$"), table.concat(names, ", "))
end

os.execute("rm -rf '" .. folder .. "'")

-- Numbers at the ends of what numbers are, on axes of both kinds, end in a picture of numbers or in a sentence.
local pictures, sentences = 0, 0
local ends = { 0, 1, -1, 0.1, 1e300, -1e300, 9.9e299, 1e301, 1.7e308, -1.7e308, 5e-324, 1e-320, 2.3e-308, 1e-307, 1e-300, 1e16 + 2,
    math.maxinteger, math.mininteger, 1 / 0, -1 / 0, 0 / 0 }
local function try(arguments)
    arguments.file = path
    local good, message = pcall(function() talus.plot(arguments) end)
    pictures, sentences = pictures + (good and 1 or 0), sentences + (good and 0 or 1)
    if good then
        local svg = read(path)
        check.holds(not svg:find "nan" and not svg:find "inf" and #svg < 100000, svg:sub(1, 400))
    else
        check.holds(message:find "^[^\n]+test_plot.lua:%d+: plot[^\n]+$", message)
    end
end
for _, a in ipairs(ends) do
    for _, b in ipairs(ends) do
        for _, log in ipairs { false, true } do
            try { series = { { y = { a, b }, style = "both" } }, y_axis = { log = log } }
            try { series = { { y = { a, b }, x = { b, a } } }, x_axis = { log = log } }
            try { series = { { y = { 1, 2, a } } }, y_axis = { log = log, range = { a, b } } }
        end
    end
end
check.holds(pictures > 900 and sentences > 900, pictures .. " pictures, " .. sentences .. " sentences")
