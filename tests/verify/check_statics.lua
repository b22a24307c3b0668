-- check_statics.lua - how the tests of structures ask whether one stands: it is run until the
-- forces balance, or until a block has gone much further than the joints' springs can yield.
local statics = {}

-- Longest displacement in a selection of blocks, m.
function statics.travel(blocks)
    local longest = 0
    for _, block in ipairs(blocks) do
        local u = block.displacement
        longest = math.max(longest, u[1] * u[1] + u[2] * u[2] + u[3] * u[3])
    end
    return math.sqrt(longest)
end

-- Waits for equilibrium after a change: true at rest, false when a block has moved by `moving`.
function statics.stands(model, blocks, options)
    blocks:reset_displacement()
    local run = model:solve { ratio = options.ratio, max_cycles = options.max_cycles, every = 50,
        stop = function() return statics.travel(blocks) > options.moving end }
    assert(run.reason == "ratio" or run.reason == "stop", "neither at rest nor failing: ratio "
        .. run.ratio)
    return run.reason == "ratio", run
end

-- Changes a value from `first` towards failure, all history kept, while stands(value) says true: in
-- strides of `coarse` to `near`, from there on in strides of `fine`. Gives the middle of the bracket
-- between the last value that stood and the first that did not.
function statics.search(first, near, coarse, fine, stands)
    local sign = near < first and -1 or 1
    local value = first
    assert(stands(value), "it does not even stand at the first value")
    while true do
        local stride = (near - value) * sign > 1e-9 * fine
            and math.min(coarse, (near - value) * sign) or fine
        local next = value + sign * stride
        if not stands(next) then
            return value + sign * stride / 2
        end
        value = next
    end
end

return statics
