-- The number of bodies that a list of blocks is of.
return function(selection)
    local seen, count = {}, 0
    for _, block in ipairs(selection) do
        if not seen[block.body] then
            seen[block.body] = true
            count = count + 1
        end
    end
    return count
end
