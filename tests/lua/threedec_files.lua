-- threedec_files.lua - data files of 3DEC 7 for models that 3DEC has been run on and whose results are public.
--
-- Geometry from formulas; commands as its users type them: gravity in ten portions, each solved by its local ratio.
local files = {}

local function point(x, y, z)
    return ("%.10g,%.10g,%.10g"):format(x, y, z)
end

-- A wedge-shaped stone between two sections of an arch in the plane xz, `width` along y.
local function stone(inner, outer, i, width, group)
    local a, b, c, d = inner[i], inner[i + 1], outer[i + 1], outer[i]
    local function at(p, y)
        return point(p[1], y, p[2])
    end
    local faces = {
        { at(a, 0), at(b, 0), at(c, 0), at(d, 0) }, { at(a, width), at(d, width), at(c, width), at(b, width) },
        { at(a, 0), at(d, 0), at(d, width), at(a, width) }, { at(b, 0), at(b, width), at(c, width), at(c, 0) },
        { at(a, 0), at(a, width), at(b, width), at(b, 0) }, { at(d, 0), at(c, 0), at(c, width), at(d, width) },
    }
    local lines = {}
    for k, face in ipairs(faces) do
        lines[k] = "    face " .. table.concat(face, " ")
    end
    return ("block create polyhedron group '%s' ...\n%s"):format(group, table.concat(lines, " ...\n"))
end

-- An arch of the sections given by points {x, z} of both of its faces; the first and the last stone are held, and with `rough`
-- nothing slips on them.
local function arch(p)
    local lines = { "; " .. p.title, "model new", "model large-strain on" }
    for i = 1, #p.inner - 1 do
        lines[#lines + 1] = stone(p.inner, p.outer, i, p.width, (i == 1 or i == #p.inner - 1) and "Supports" or "Blocks")
    end
    local stiffness = ("stiffness-normal [kn] stiffness-shear [%s]"):format(p.ks)
    lines[#lines + 1] = ([[
[kn = %s]
block contact generate-subcontacts
block property density %g
block contact jmodel assign mohr
block contact property %s friction 35
%sblock contact material-table default property %s friction 35
block fix range group 'Supports'
block mechanical damping global
]]):format(p.kn, p.density, stiffness,
        p.rough and ("block contact property %s friction 90 range group 'Supports'\n"):format(stiffness) or "", stiffness)
    for k = 1, 10 do
        lines[#lines + 1] = ("model gravity 0 0 [-9.81*%d/10.0]\nmodel solve ratio-local 1e-6"):format(k)
    end
    return table.concat(lines, "\n") .. "\n"
end

local function sections(radius)
    local list = {}
    for k = 0, 20 do
        local angle = math.rad(9 * k)
        list[k + 1] = { math.floor(radius * math.cos(angle) * 1000 + 0.5) / 1000, math.floor(radius * math.sin(angle) * 1000 + 0.5) / 1000 }
    end
    return list
end

local function mirrored(list)
    local all = table.move(list, 1, #list, 1, {})
    for i = #list, 1, -1 do
        all[#all + 1] = { -list[i][1], list[i][2] }
    end
    return all
end

-- 20 stones of 9 degrees, corners rounded to a millimetre.
function files.arch_20(thickness)
    return arch { title = "semicircular arch", inner = sections(5), outer = sections(5 + thickness), width = 0.5, density = 2400, kn = "6e10",
        ks = "2.5e10", rough = true }
end

function files.arch_5()
    return arch { title = "arch of five stones", width = 0.5, density = 2200, kn = "2e8", ks = "kn/3.6",
        inner = mirrored { { 1.5, 0 }, { 0.9414475098, 0.3159612662 }, { 0.3208630573, 0.4793238793 } },
        outer = mirrored { { 1.62, 0.16 }, { 1.0167633105, 0.5012381675 }, { 0.3465321018, 0.6776697896 } } }
end

-- A unit cube, 0.275 m off the middle of the one that holds it.
function files.cube()
    return [[
; eccentric cube
model new
block create brick 0 1 0 1 -1 0 group 'base'
block create brick 0.275 1.275 0 1 0 1 group 'cube'
block property density 1000
block contact generate-subcontacts
block contact jmodel assign mohr
block contact property stiffness-normal 9e10 stiffness-shear 5e10 friction 35
block contact material-table default property stiffness-normal 9e10 stiffness-shear 5e10 friction 35
block fix range group 'base'
block mechanical damping global
model gravity 9.806
model solve ratio-local 1e-7
]]
end

-- Converts a data file and runs it: the model, what the script has said at last, and what the conversion tells.
function files.run(text)
    local threedec = require "talus.threedec"
    local result, said = threedec.convert("model.3ddat", { text = text }), ""
    local chunk = assert(load(threedec.chunk(result) .. " return model", "@model.3ddat"))
    local print_before = print
    print = function(line)
        said = line
    end
    local model = chunk()
    print = print_before
    return model, said, result
end

-- The hinges of an arch of arch_20: sections where the stones touch at one edge only, which is a contact of one point.
function files.hinges(model, thickness)
    local hinges = {}
    for section = 1, 19 do
        local a, b = model:blocks { id = section }[1], model:blocks { id = section + 1 }[1]
        local contact = model:contacts { between = { a, b } }[1]
        if #contact.points == 1 then
            -- Where the hinge was before the stones moved: from the nearest vertex of the stone, moved back.
            local p, u, best, radius = contact.point, b.displacement, math.huge, nil
            for _, r in ipairs { 5, 5 + thickness } do
                local angle = math.rad(9 * section)
                local far = (p[1] - u[1] - r * math.cos(angle)) ^ 2 + (p[3] - u[3] - r * math.sin(angle)) ^ 2
                if far < best then
                    best, radius = far, r
                end
            end
            hinges[#hinges + 1] = 9 * section .. (radius == 5 and " intrados" or " extrados")
        end
    end
    return table.concat(hinges, ", ")
end

return files
