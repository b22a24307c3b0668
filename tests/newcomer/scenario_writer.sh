# An engineer who knows rock and some Lua: a slope with joints, results, pictures.
# In PATH is talus; nothing else is known of it.

talus help | grep -q '^  jointset' || { echo "the overview does not name jointset"; exit 1; }
talus help jointset | grep -q 'spacing .*number, m, > 0, required'
test -f "$PREFIX/share/doc/talus/docs/lua.md"
test -f "$PREFIX/share/man/man1/talus.1"

cat >slope.lua <<'LUA'
local talus = require "talus"

-- a bench of rock, 20 m high, in SI units; z is up
local model = talus.model { gravity = {0, 0, -9.81} }
model:generate("box", { min = {0, 0, 0}, max = {40, 10, 20}, density = 2600, group = "rock" })
model:generate("jointset", { joint = "bedding", dip = 30, dip_direction = 270, spacing = 4, number = 7,
    origin = {20, 5, 10} })
model:generate("jointset", { joint = "cross", dip = 80, dip_direction = 90, spacing = 8, number = 5, origin = {20, 5, 10} })

-- the face: what lies in front of it is dug away; what lies deep or far behind is held
local face = { dip = 60, dip_direction = 270, origin = {8, 0, 0} }
model:blocks { above = face }:delete()
local base = { dip = 30, dip_direction = 270, origin = {8, 0, 2} }
model:blocks { below = base }:fix()
model:blocks { where = function(b) return b.centroid[1] > 32 end }:fix()
print("blocks", #model:blocks(), "free", #model:blocks { fixed = false })

-- it rests under much friction, and not under little
model:joint("*", "coulomb", { kn = 1e9, ks = 5e8, friction = 40 })
model:damping("local")
print("friction 40:", model:solve { ratio = 1e-4 }.reason)
model:write_vtk("out/slope")

model:joint("*", { frction = 20 })
model:damping("none")
model:cycle(4000)
model:write_vtk("out/slope")

local moved, most = 0, 0
for _, block in ipairs(model:blocks { fixed = false }) do
    local u = block.displacement
    local length = math.sqrt(u[1] ^ 2 + u[2] ^ 2 + u[3] ^ 2)
    most = math.max(most, length)
    moved = moved + (length > 0.05 and 1 or 0)
end
print(string.format("friction 20: %d blocks have moved by more than 5 cm, the farthest by %.2f m in %.2f s", moved, most,
    model.time))
local pressed = 0
for _, contact in ipairs(model:contacts { joint = "bedding" }) do
    pressed = pressed + contact.normal_force
end
print(string.format("force on the bedding: %.0f kN", pressed / 1000))
LUA

# a slip of the pen is told with line, name and what was meant
if talus slope.lua >first.txt 2>errors.txt; then
    echo "a misspelt parameter was taken"
    exit 1
fi
grep -q "slope.lua:24: joint '\*', law 'coulomb': unknown parameter 'frction'; did you mean" errors.txt
sed -i 's/frction/friction/' slope.lua

talus slope.lua | tee results.txt
grep -q 'friction 40:.ratio' results.txt
grep -Eq 'friction 20: [1-9][0-9]* blocks' results.txt
grep -Eq 'bedding: [1-9][0-9]* kN' results.txt

# what ParaView opens
test -f out/slope_blocks.vtk.series
test "$(ls out/slope_blocks_*.vtk | wc -l)" = 2
test "$(ls out/slope_contacts_*.vtk | wc -l)" = 2
head -c 26 out/slope_blocks_000001.vtk | grep -q '# vtk DataFile'
