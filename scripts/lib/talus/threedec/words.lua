-- words.lua - the table of 3DEC's commands: what each becomes in Talus, or why it becomes nothing.
--
-- A row names its commands (several with `|`), their form, what they become, and examples that tests convert and run. Its
-- `convert(c, a)` reads the arguments `a` and writes with c.emit (converter.lua). In its place stands `needless`, for what
-- Talus does by itself, or `lacks`: why there is no counterpart.
local words = { rows = {}, tree = { children = {}, names = {} } }

-- Adds a row, and its commands to the tree by which words are found.
function words.row(commands, row)
    row.commands = {}
    for command in (commands .. "|"):gmatch "%s*(.-)%s*|" do
        row.commands[#row.commands + 1] = command
        local node = words.tree
        for word in command:gmatch "%S+" do
            if not node.children[word] then
                node.children[word] = { children = {}, names = {} }
                node.names[#node.names + 1] = word
            end
            node = node.children[word]
        end
        assert(not node.row, command)
        node.row = row
    end
    words.rows[#words.rows + 1] = row
end

for _, part in ipairs { "shapes", "contacts", "motion", "runs", "zones", "others" } do
    require("talus.threedec.words_" .. part)(words.row)
end

return words
