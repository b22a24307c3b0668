-- tutorial_pictures.lua - draws the models of docs/tutorial.md as they are at the end of their scripts.
--
--     build/release/talus --quiet scripts/tools/tutorial_pictures.lua docs/tutorial.md docs/pictures
--
-- Runs the scripts as they stand on the page. Writes tutorial_NAME.svg: a section along x and z, or all blocks seen from the
-- south. Held blocks are grey, those that have moved by more than MOVED red. Below it stand a scale, where one looks, and the time.
local talus = require "talus"

local MOVED = 0.05        -- m
local SIZE, MARGIN = 560, 8 -- of a picture, pixels
local FOOT = 30             -- strip below it with scale, direction and time, pixels

-- Name of a script: which of its models is drawn, where the section lies (y, m; nil: seen from the south), what of it (x and z, m).
local PICTURES = {
    slope = { model = 1, y = 5, box = { 0, 0, 28, 24 } },
    tunnel = { model = 1, y = 6, box = { -10, -10, 10, 10 } },
    arch = { model = 3, y = 0.5, box = { -6, -1, 6, 6 } },
    shaking = { model = 1, box = { -6, -1, 6, 3 } },
}

-- The convex polygon around points {x, z}, counter-clockwise.
local function hull(points)
    table.sort(points, function(a, b)
        return a[1] < b[1] or (a[1] == b[1] and a[2] < b[2])
    end)
    local function half(first, last, step)
        local chain = {}
        for i = first, last, step do
            local p = points[i]
            while #chain > 1 do
                local a, b = chain[#chain - 1], chain[#chain]
                if (b[1] - a[1]) * (p[2] - a[2]) - (b[2] - a[2]) * (p[1] - a[1]) > 0 then
                    break
                end
                chain[#chain] = nil
            end
            chain[#chain + 1] = p
        end
        chain[#chain] = nil
        return chain
    end
    local polygon = half(1, #points, 1)
    table.move(half(#points, 1, -1), 1, #points, #polygon + 1, polygon)
    return polygon
end

-- What of a block is drawn: the polygon in which the plane cuts it, or its outline.
local function outline(block, y)
    local points, vertices = {}, block.vertices
    for _, face in ipairs(y and block.faces or {}) do
        local loop = face.vertices
        for i, one in ipairs(loop) do
            local a, b = vertices[one], vertices[loop[i % #loop + 1]]
            if (a[2] < y) ~= (b[2] < y) then
                local share = (y - a[2]) / (b[2] - a[2])
                points[#points + 1] = { a[1] + share * (b[1] - a[1]), a[3] + share * (b[3] - a[3]) }
            end
        end
    end
    for _, v in ipairs(y and {} or vertices) do
        points[#points + 1] = { v[1], v[3] }
    end
    return #points >= 3 and hull(points) or nil
end

local function colour(block)
    local d = block.displacement
    if block.fixed then
        return "#c9ccd1"
    end
    return d[1] ^ 2 + d[2] ^ 2 + d[3] ^ 2 > MOVED ^ 2 and "#d6382a" or "#e9d9b8"
end

-- The longest of 1, 2 and 5 times a power of ten that is no longer than `most`.
local function round_length(most)
    local power = 10 ^ math.floor(math.log(most, 10))
    return (most >= 5 * power and 5 or most >= 2 * power and 2 or 1) * power
end

local function foot(model, picture, scale, height)
    local left, _, right = table.unpack(picture.box)
    local length, y = round_length((right - left) / 5), height - FOOT / 2
    local from, to = MARGIN, MARGIN + scale * length
    local where = picture.y and ("section at y = %g m"):format(picture.y) or "seen from the south"
    return table.concat({
        ('<path d="M%.1f %.1fv6h%.1fv-6" fill="none" stroke="#262626"/>'):format(from, y - 3, to - from),
        '<g font-family="sans-serif" font-size="12" fill="#262626">',
        ('<text x="%.1f" y="%.1f">%g m</text>'):format(to + 6, y + 4, length),
        ('<text x="%d" y="%.1f" text-anchor="end">%s, west left, east right; t = %.3g s</text>'):format(SIZE - MARGIN, y + 4, where, model.time),
        "</g>" }, "\n")
end

local function draw(model, picture)
    local left, low, right, high = table.unpack(picture.box)
    local scale = (SIZE - 2 * MARGIN) / (right - left)
    local height = scale * (high - low) + 2 * MARGIN + FOOT
    local out = { ('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 %d %.0f" width="%d" height="%.0f">'):format(SIZE,
        height, SIZE, height), '<rect width="100%" height="100%" fill="#ffffff"/>',
        '<g stroke="#262626" stroke-width="1" stroke-linejoin="round">' }
    for _, block in ipairs(model:blocks { hidden = "any" }) do
        local polygon, corners = outline(block, picture.y), {}
        for i, p in ipairs(polygon or {}) do
            corners[i] = ("%.1f,%.1f"):format(MARGIN + scale * (p[1] - left), MARGIN + scale * (high - p[2]))
        end
        if polygon then
            out[#out + 1] = ('<polygon points="%s" fill="%s"/>'):format(table.concat(corners, " "), colour(block))
        end
    end
    out[#out + 1] = "</g>"
    out[#out + 1] = foot(model, picture, scale, height)
    out[#out + 1] = "</svg>\n"
    return table.concat(out, "\n")
end

-- The models that a script makes, in their order.
local function models_of(script, name)
    local made, make = {}, talus.model
    talus.model = function(options)
        made[#made + 1] = make(options)
        return made[#made]
    end
    local quiet = setmetatable({ print = function() end }, { __index = _G })
    assert(load(script, "=" .. name, "t", quiet))()
    talus.model = make
    return made
end

local page, folder = ...
assert(folder, "usage: talus scripts/tools/tutorial_pictures.lua PAGE FOLDER")
local file = assert(io.open(page))
local text = file:read "a"
file:close()
for name, script in text:gmatch "<!%-%- file: (%w+)%.lua %-%->\n```lua\n(.-)```" do
    local picture = assert(PICTURES[name], "no picture of " .. name)
    local svg = draw(models_of(script, name)[picture.model], picture)
    local out = assert(io.open(folder .. "/tutorial_" .. name .. ".svg", "w"))
    assert(out:write(svg))
    assert(out:close())
end
