-- fig2.lua - a cube cut by three joint sets, two of them discontinuous.
--
--     build/release/talus scripts/examples/fig2.lua [folder]
--
-- The table of Figure 2 in Hart, Cundall and Lemos, Int. J. Rock Mech. Min. Sci. 25 (1988) 117-125:
--
--     set  dip  dip direction  spacing  deviation  planes  persistence
--      1    45       220        0.25       0.1       15        1
--      2    45        70        0.5        0         15        0.5
--      3    45        70        0.5        0         15        0.5
--
-- As printed the third set falls on the second; a plane then cuts a block with probability 3/4.
-- With 320 for its dip direction the sets make a jointed rock mass. Every draw comes from the
-- model's seed.
local talus = require "talus"

local fig2 = {}

fig2.page_every = 5 -- of so many frames the page gets one

fig2.sets = {
    { joint = "J1", dip = 45, dip_direction = 220, spacing = 0.25, spacing_dev = 0.1, number = 15 },
    { joint = "J2", dip = 45, dip_direction = 70, spacing = 0.5, number = 15, persistence = 0.5 },
    { joint = "J3", dip = 45, dip_direction = 320, spacing = 0.5, number = 15, persistence = 0.5 },
}

-- Cuts the box from `low` to `high` in every direction. Options: `seed`; `exact` leaves out
-- deviations and persistence; `third`, the dip direction of the third set.
function fig2.build(low, high, options)
    options = options or {}
    local model = talus.model { gravity = { 0, 0, -10 }, seed = options.seed or 1 }
    model:generate("box", { min = { low, low, low }, max = { high, high, high }, density = 2000 })
    local last
    for i, set in ipairs(fig2.sets) do
        local values = {}
        for key, value in pairs(set) do
            values[key] = value
        end
        if options.exact then
            values.spacing_dev, values.persistence = 0, 1
        end
        if i == 3 then
            values.dip_direction = options.third or values.dip_direction
        end
        last = model:generate("jointset", values)
    end
    return model, last
end

-- The base is held, the rest may slide out: `frames` pictures after the first, whole and in a
-- section from west to east through the middle, and every fifth as a page.
function fig2.collapse(model, frames, name)
    model:blocks { where = function(block)
        for _, vertex in ipairs(block.vertices) do
            if vertex[3] < -0.999 then
                return true
            end
        end
        return false
    end }:fix()
    model:joint("*", "coulomb", { kn = 1e8, ks = 1e8, friction = 15 })
    model:timestep { rule = "body", fraction = 0.2 }
    local interval = 0.02 -- s
    for frame = 0, frames do
        while model.time < frame * interval do
            model:cycle(20)
        end
        model:write_vtk(name)
        model:write_section(name, { dip = 90, dip_direction = 0 })
        if frame % fig2.page_every == 0 or frame == frames then
            model:write_html(name, { title = "A jointed cube" })
        end
    end
end

function fig2.main(folder)
    for _, third in ipairs { 70, 320 } do
        local model = fig2.build(-1, 1, { exact = true, third = third })
        print(string.format("third set 45/%d, continuous:    %3d blocks", third, #model:blocks()))
        local sum = 0
        for seed = 1, 100 do
            sum = sum + #fig2.build(-1, 1, { third = third, seed = seed }):blocks()
        end
        print(string.format("third set 45/%d, discontinuous: %.1f blocks, mean of 100 seeds", third,
            sum / 100))
    end
    local model, summary = fig2.build(-1, 1)
    print(string.format("seed 1: %d blocks, volume kept to %.1e, the smallest %.2e m3",
        #model:blocks(), summary.volume_error, summary.smallest_volume))
    fig2.collapse(model, 20, folder .. "/fig2")
    print(string.format("%s/fig2.html shows the collapse in a browser,", folder))
    print(string.format("%s/fig2_blocks.vtk.series shows the collapse,", folder))
    print(string.format("%s/fig2_section.vtk.series a section from west to east", folder))
end

-- A test that says require "examples.fig2" wants the functions only.
if ... ~= "examples.fig2" then
    fig2.main(arg and arg[1] or "out/fig2")
end
return fig2
