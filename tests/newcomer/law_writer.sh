# A researcher with a contact law in mind, who can read C.

talus new law sticky >told.txt
cat told.txt
grep -q "cmake -S sticky -B sticky/build" told.txt

# PREFIX/bin is in PATH, so CMake finds the rest
cmake -S sticky -B sticky/build >cmake.txt
cmake --build sticky/build >>cmake.txt 2>&1
! grep -q warning cmake.txt || { cat cmake.txt; exit 1; }
ctest --test-dir sticky/build --output-on-failure >tests.txt || { cat tests.txt; exit 1; }

# the change: cohesion
sed -i -e 's/double kn, ks, peak, residual, distance;/double kn, ks, peak, residual, distance, cohesion;/' \
    -e 's/^    TL_PARAM(TL_PARAM_REAL, params, distance,/    TL_PARAM(TL_PARAM_REAL, params, cohesion, "Pa", "shear strength without pressure", .min = 0, .max = INFINITY, .flags = TL_PARAM_STRENGTH),\n&/' \
    -e 's/limit = f_n \* (low + drop \* left)/glue = f_n > 0 ? p->cohesion * area : 0, limit = glue + f_n * (low + drop * left)/' \
    -e 's/slip_of(trial, limit, f_n \* low,/slip_of(trial, limit, glue + f_n * low,/' sticky/sticky.c
grep -c cohesion sticky/sticky.c | grep -q 3
cmake --build sticky/build >>cmake.txt 2>&1
! grep -q warning cmake.txt || { cat cmake.txt; exit 1; }
talus check sticky/build/sticky.so
talus check sticky/build/sticky.so cohesion=1e5 friction=30 | tail -n 1 | grep -q '24 checks, 0 faults'
talus --plugin sticky/build/sticky.so help sticky | grep -A 1 cohesion | grep -q 'shear strength without pressure'

# the law at work: a slab on a table, tilted by 25 degrees. Its own weight drives it with 10.6 kPa and holds it with 6.1
cat >slab.lua <<'LUA'
local talus = require "talus"
local g, slope = 10, math.rad(25)
local function run(cohesion)
    local model = talus.model { gravity = { g * math.sin(slope), 0, -g * math.cos(slope) } }
    model:generate("box", { min = {0, 0, 0}, max = {20, 4, 1}, density = 2500, group = "table" })
    model:generate("box", { min = {1, 1, 1}, max = {3, 3, 2}, density = 2500, group = "slab" })
    model:blocks { group = "table" }:fix()
    model:joint("*", "sticky", { kn = 1e9, ks = 1e9, friction = 15, residual = 15, cohesion = cohesion })
    model:damping("local")
    return model:solve { ratio = 1e-5, max_cycles = 5000, stop_at_failure = true }.reason
end
print(run(3e3), run(6e3))
assert(run(3e3) ~= "ratio" and run(6e3) == "ratio")
LUA
TALUS_PLUGIN_PATH=sticky/build talus slab.lua

# a mistake that would have blown the model up: the law is stiffer than it says
sed -i 's/    \*kn = p->kn;/    *kn = p->kn \/ 2;/' sticky/sticky.c
cmake --build sticky/build >>cmake.txt 2>&1
if talus check sticky/build/sticky.so >told.txt; then
    echo "the check does not see that the law is stiffer than it says"
    exit 1
fi
grep -A 1 'FAULT  stiffness' told.txt
