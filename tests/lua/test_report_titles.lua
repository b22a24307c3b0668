-- Every case of docs/verification.md has a title in words, and no two cases have the same.
package.path = (os.getenv("TALUS_SOURCE_DIR") or ".") .. "/tests/verify/?.lua;" .. package.path
local check = require "check"
local title_of = require "report_titles"

check.equal(title_of "S.stack.10", "10 cubes on each other at rest")
check.equal(title_of "M.unit_cube", "mass and inertia of a block: unit cube")
check.equal(title_of "P.local.0.8", "local damping, alpha 0.8")
check.equal(title_of "no such case", nil)

local cases, of_title = 0, {}
for line in io.lines((os.getenv("TALUS_SOURCE_DIR") or ".") .. "/docs/verification.md") do
    local heading = line:match("^## (.*)$")
    if heading then
        local words, id = heading:match("^(.*) %(([^()]*)%)$")
        check.holds(words and title_of(id), "a title in tests/verify/report_titles.lua for " .. heading)
        check.equal(words:lower(), title_of(id):lower())
        check.equal(of_title[words] or id, id)
        of_title[words] = id
        cases = cases + 1
    end
end
check.holds(cases > 100, "cases in docs/verification.md")
