-- A block hangs on the element: at rest it bears the weight.
local talus = require "talus"
local model = talus.model { gravity = { 0, 0, -10 } }
model:generate("box", { min = { -0.5, -0.5, -0.5 }, max = { 0.5, 0.5, 0.5 }, density = 1000 })
model:damping "local"
local bar = model:element("my_element", { from = { 0, 0, 0 }, to = { 0, 0, 3 }, stiffness = 1e6 })
model:solve { measure = "local", ratio = 1e-6, max_cycles = 20000 }
print(("the bar bears %.6g N of 10000 N"):format(bar[1].axial))
assert(math.abs(bar[1].axial - 1e4) < 1, "the bar bears the weight")
