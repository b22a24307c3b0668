-- talus.stereonet: poles, great circles and movements where the projections put them; sets of a model; bad input.
local talus = require "talus"
local check = require "check"

local folder = string.format("%s/stereonet_%s", assert(os.getenv("TALUS_TEST_TMP")),
    tostring({}):match("0x(%x+)") or "0")
local path = folder .. "/new/net.svg"
local rad = math.rad

local function draw(arguments)
    arguments.file = arguments.file or path
    talus.stereonet(arguments)
    local file = assert(io.open(arguments.file))
    local svg = file:read("a")
    file:close()
    return svg
end

local function has(svg, part)
    check.holds(svg:find(part, 1, true), "'" .. part .. "'")
end

-- Poles of the first set, drawn as circles: x to the east and y to the north, in radii from the centre.
local SIZE = 480
local RADIUS = SIZE / 2 - 34
local function poles(svg)
    local list = {}
    for x, y in svg:gmatch('<circle cx="([^"]*)" cy="([^"]*)" r="4" fill="#0072b2" fill%-opacity') do
        list[#list + 1] = { (tonumber(x) - SIZE / 2) / RADIUS, (SIZE / 2 - tonumber(y)) / RADIUS }
    end
    return list
end

-- Points of the great circles, likewise.
local function circles(svg)
    local list = {}
    for text in svg:gmatch('<path d="(M[^"]*)" fill="none"') do
        local points = {}
        for x, y in text:gmatch("([%d.-]+) ([%d.-]+)") do
            points[#points + 1] = { (tonumber(x) - SIZE / 2) / RADIUS, (SIZE / 2 - tonumber(y)) / RADIUS }
        end
        list[#list + 1] = points
    end
    return list
end

local TWO_DECIMALS = 0.008 / RADIUS

-- The pole of dip and dip direction lies opposite to the dip, at sqrt(2) sin(dip / 2) or tan(dip / 2).
check.holds(talus.stereonet == require "talus.stereonet", "the module is what talus has")
for _, projection in ipairs { "equal_area", "equal_angle" } do
    local function radius(angle)
        return projection == "equal_area" and math.sqrt(2) * math.sin(rad(angle) / 2) or math.tan(rad(angle) / 2)
    end
    for _, plane in ipairs { { 0, 0 }, { 30, 90 }, { 55, 120 }, { 70, 359 }, { 90, 45 } } do
        local dip, direction = plane[1], plane[2]
        local svg = draw { projection = projection, sets = { { dip = dip, dip_direction = direction } } }
        local r = radius(dip)
        check.equal(#poles(svg), 1)
        check.near(poles(svg)[1], { -r * math.sin(rad(direction)), -r * math.cos(rad(direction)) }, TWO_DECIMALS)
        -- The great circle is deepest towards the dip direction, and ends on the rim in the strike.
        local circle = circles(svg)[1]
        local deepest = radius(90 - dip)
        check.near(circle[46], { deepest * math.sin(rad(direction)), deepest * math.cos(rad(direction)) }, TWO_DECIMALS)
        -- That of a horizontal plane goes all round, the others half.
        check.equal(#circle, dip == 0 and 181 or 91)
        local least = 1
        for _, point in ipairs(circle) do
            least = math.min(least, point[1] * math.sin(rad(direction)) + point[2] * math.cos(rad(direction)))
        end
        check.near(least, dip == 0 and -1 or 0, 1e-3)
        for _, at in ipairs { 1, #circle } do
            check.near(circle[at][1] ^ 2 + circle[at][2] ^ 2, 1, 1e-4)
            check.near(circle[at][1] * math.sin(rad(direction)) + circle[at][2] * math.cos(rad(direction)), 0, 1e-4)
        end
    end
end

-- By equal angle a great circle is an arc of radius 1 / cos(dip) about tan(dip) towards the pole.
local svg = draw { projection = "equal_angle", sets = { { dip = 40, dip_direction = 90 } } }
for _, point in ipairs(circles(svg)[1]) do
    check.near(math.sqrt((point[1] + math.tan(rad(40))) ^ 2 + point[2] ^ 2), 1 / math.cos(rad(40)), 2 * TWO_DECIMALS)
end

-- The mean of planes on both sides of the vertical is not that of their poles' coordinates.
svg = draw { sets = { { name = "K", planes = { { 85, 90 }, { dip = 85, dip_direction = 270 } } } } }
has(svg, "mean 90°/")
has(svg, ">K</text>")
has(svg, "2 planes")
check.equal(#circles(svg), 1)
check.equal(#circles(draw { great_circles = "all", sets = { { planes = { { 85, 90 }, { 85, 270 } } } } }), 2)
check.equal(#circles(draw { great_circles = "none", sets = { { planes = { { 85, 90 }, { 85, 270 } } } } }), 0)
svg = draw { sets = { { dip = 60, dip_direction = 359.7 } }, title = "<here>" }
has(svg, ">60°/000°, 1 plane<")
has(svg, "&lt;here&gt;")
has(svg, "equal area, lower hemisphere")

-- The sets of a model: one pole for each plane, however many faces it made, in the order of their numbers.
local model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 10, 10, 10 }, density = 2500 })
check.raises(function() talus.stereonet { file = path, model = model } end, "no face of the model was made by a joint")
for _, set in ipairs { { "J10", 60, 120, 3 }, { "J2", 70, 240, 2 }, { "slip", 20, 0, 1 } } do
    model:generate("jointset", { joint = set[1], dip = set[2], dip_direction = set[3], number = set[4], spacing = 2,
        origin = { 5, 5, 5 } })
end
svg = draw { model = model }
local at = 1
for _, part in ipairs { ">J2</text>", "mean 70°/240°, 2 planes", ">J10</text>", "mean 60°/120°, 3 planes", ">slip</text>",
    ">20°/000°, 1 plane" } do
    at = svg:find(part, at, true)
    check.holds(at, part)
end
check.equal(#poles(svg), 2)
check.equal(svg, draw { model = model, file = folder .. "/again.svg" })
svg = draw { model = model, joints = { "J10" } }
check.equal(#poles(svg), 3)
for _, pole in ipairs(poles(svg)) do
    check.near(pole, { -math.sqrt(2) * math.sin(rad(30)) * math.sin(rad(120)),
        -math.sqrt(2) * math.sin(rad(30)) * math.cos(rad(120)) }, TWO_DECIMALS)
end

-- Movements of keyblocks: a cross for each; those that point up are told apart.
local function crosses(list)
    return select(2, draw({ keyblocks = list, legend = false, grid = false }):gsub('stroke%-width="1.8"', "")) / 2
end
check.equal(crosses { { mode = "falling", direction = { 0, 0, -1 } }, { mode = "stable" } }, 1)
svg = draw { keyblocks = { { mode = "sliding", direction = { 0.6, 0, -0.8 } } } }
local r = math.sqrt(2) * math.sin(math.acos(0.8) / 2)
local x = SIZE / 2 + RADIUS * r
has(svg, string.format('d="M%.2f 245L%.2f 235"', x - 5, x + 5))
has(svg, "movement of a keyblock")
svg = draw { keyblocks = { { mode = "sliding", direction = { 0.6, 0, 0.8 } } } }
has(svg, ">the same, upward<")
has(svg, string.format('d="M%.2f 245L', SIZE / 2 - RADIUS * r - 5))
check.equal(crosses(model:keyblocks { friction = 30 }) > 0, true)

-- Bad input: one sentence at the line of the script, and no file.
local empty = folder .. "/none.svg"
local function refused(arguments, part)
    if type(arguments) == "table" and arguments.file == nil then
        arguments.file = empty
    end
    check.raises(function() talus.stereonet(arguments) end, part)
    check.equal(io.open(empty), nil)
end
local set = { dip = 10, dip_direction = 20 }
refused(nil, "stereonet: the argument must be a table, not nil")
refused({}, "stereonet: give model, sets = {{dip =, dip_direction =}, ...}, poles or keyblocks")
refused({ sts = {} }, "stereonet: unknown parameter 'sts'; did you mean 'sets'?")
refused({ sets = { { dip = 10 } } }, "stereonet, set 1: 'dip_direction' is missing")
refused({ sets = { set, { dip = 91, dip_direction = 0 } } }, "stereonet, set 2: dip = 91 is outside [0, 90]")
refused({ sets = { { dip = 1, dip_direction = -1 } } }, "dip_direction = -1 is outside [0, 360]")
refused({ sets = { { dip = 0 / 0, dip_direction = 0 } } }, "dip = ")
refused({ sets = { { dip = "1", dip_direction = 0 } } }, "dip must be a number, not the string '1'")
refused({ sets = { { dip = 1, planes = { { 1, 2 } } } } }, "give either dip and dip_direction or planes")
refused({ sets = { { planes = { { 1, 2 }, { 1 } } } } }, "stereonet, set 1, plane 2: 'dip_direction' is missing")
refused({ sets = { { planes = {} } } }, "planes is empty")
refused({ sets = { { planes = { 3 } } } }, "the plane must be a table, not the number 3")
refused({ sets = { 3 } }, "the set must be a table")
refused({ sets = 3 }, "sets must be a table")
-- What was given is said in one line of UTF-8, and not all of a long text.
refused({ sets = { set }, projection = "a\nb\0\xff" }, "a\\x0ab\\x00\\xff")
refused({ sets = { set }, projection = ("x"):rep(5000) }, "x ... x")
refused({ model = 3 }, "model must be a model, not the number 3")
refused({ sets = { set }, joints = "J1" }, "give model, too")
refused({ model = model, joints = { "J3" } }, "no face of the model is of a joint 'J3' (there are: J2, J10, slip)")
refused({ keyblocks = { 3 } }, "item 1 is not of it")
refused({ sets = { set }, projection = "equal_are" }, "did you mean 'equal_area'?")
refused({ sets = { set }, great_circles = true }, "great_circles must be text, not true")
refused({ sets = { set }, size = 1 }, "size = 1 is outside [150, 10000]")
refused({ sets = { set }, file = folder }, "stereonet: cannot write")

os.execute("rm -rf '" .. folder .. "'")
