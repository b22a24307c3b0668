-- A pile of irregular blocks, which touch by edges and vertices as much as by faces, comes to rest: nothing goes on
-- moving between two states of a contact. Then contacts stand as they are, and forces stay.
-- program only: the models are the same ones with a stock Lua.
package.path = "tests/bench/?.lua;" .. package.path
local check = require "check"
local pile = require "pile"

local CYCLES = 20000 -- with 8600 the ratio is reached
-- Largest speeds, m/s: at that ratio, and when local damping has taken all but what rounding keeps up.
local SLOW, REST = 1e-3, 1e-11
local BALANCE = 0.01 -- of the energy ledger: blocks settle first, from as far as contacts were dipped in
local SAME = 1e-9    -- share by which forces change in LATER cycles
local LATER = 500

local model = pile.load("tests/bench/pile_30.json", 1)
local pieces = model:blocks { group = "pile" }
local result = model:solve { ratio = 1e-6, max_cycles = CYCLES }
check.equal(result.reason, "ratio")
check.holds(pieces:max "speed" < SLOW, "that blocks hardly move at a small ratio")
model:solve { ratio = 0, max_cycles = 6000 }
check.holds(pieces:max "speed" < REST, "that the pile rests")
check.holds(math.abs(model:energy().balance) < BALANCE, "the energy ledger")

local contacts = model:contacts()
local forces, areas, loaded = contacts:sum "normal_force", contacts:sum "area", model:profile().loaded
model:cycle(LATER)
contacts = model:contacts()
check.near(contacts:sum "normal_force", forces, SAME * forces)
check.near(contacts:sum "area", areas, SAME * areas)
check.equal(model:profile().loaded, loaded)
