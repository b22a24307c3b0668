-- program only
-- The program `talus` from outside: exit status, one sentence on standard error, help, options.
local check = require "check"

local program = os.getenv("TALUS_PROGRAM") or arg[-1]
local folder = os.getenv("TALUS_TEST_TMP") or "/tmp"

local function write(name, text)
    local path = folder .. "/" .. name
    local file = assert(io.open(path, "w"))
    file:write(text)
    file:close()
    return path
end

-- Runs the program; gives exit status, standard output, standard error.
local function run(arguments, input, environment)
    local errors = folder .. "/program_errors.txt"
    local pipe = assert(io.popen(string.format("%s '%s' %s 2>'%s' <%s", environment or "", program,
        arguments, errors, input or "/dev/null")))
    local output = pipe:read("a")
    local _, _, status = pipe:close()
    local file = assert(io.open(errors))
    local text = file:read("a")
    file:close()
    return status, output, text
end

local function contains(text, part)
    check.holds(text:find(part, 1, true), "'" .. part .. "' in: " .. text)
end

-- One sentence of one line on standard error, and exit status 1.
local function refused(arguments, part)
    local status, _, errors = run(arguments)
    check.equal(status, 1)
    contains(errors, part)
    check.holds(errors:match("^talus: [^\n]+\n$"), "one line that begins with talus: " .. errors)
end

-- Scripts.
local script = write("program_good.lua", [[
print(arg[0]:match("[^/]+$"), arg[1], arg[2], ...)
print(require "talus" == require "talus", require("talus").model{}.threads)
]])
local status, output, errors = run(script .. " one 'two words'")
check.equal(status, 0)
check.equal(output, "program_good.lua\tone\ttwo words\tone\ttwo words\ntrue\t1\n")
check.equal(errors, "")
contains(select(2, run("--threads 2 " .. script)), "true\t2")
contains(select(2, run(script, nil, "TALUS_THREADS=3")), "true\t3")
contains(select(2, run("--threads 2 " .. script, nil, "TALUS_THREADS=3")), "true\t2")
status, output, errors = run(script, nil, "TALUS_THREADS=many")
check.equal(status, 1)
contains(errors, "program_good.lua:2: the environment's TALUS_THREADS = 'many'")

script = write("program_bad.lua", [[
local talus = require "talus"
local model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 0 })
]])
refused(script, "program_bad.lua:3: generator 'box': density = 0 kg/m3 must be > 0")
refused(write("program_syntax.lua", "local x = = 3\n"), "program_syntax.lua:1: unexpected symbol")
refused(write("program_global.lua", "local friction = 30\nprint(frction)\n"),
    "program_global.lua:2: the variable 'frction' is not declared; did you mean 'friction'?")
refused(write("program_table.lua", "error({})\n"), "an error that is a table")
status, _, errors = run("-v " .. script)
check.equal(status, 1)
contains(errors, "program_bad.lua:3: generator 'box'")
contains(errors, "stack traceback")
refused(folder .. "/no_such_script.lua", "no_such_script.lua")

-- Assigning declares, even nil; reading through rawget never raises.
status = run(write("program_declared.lua", [[
flag = nil
assert(flag == nil)
value = 3
assert(value == 3 and rawget(_G, "unknown") == nil)
]]))
check.equal(status, 0)

-- Chunks and standard input.
status, output = run("-e 'print(talus.version)'")
check.equal(status, 0)
check.holds(output:match("^%d+%.%d+%.%d+\n$"), "a version")
refused("-e 'x.y = 3'", "(command line):1: the variable 'x' is not declared")
check.equal(select(2, run("", write("program_input.lua", "print(1 + 1)\n"))), "2\n")

-- Options.
refused("--threds 2 x.lua", "unknown option '--threds'; did you mean '--threads'?")
refused("--threads 0 x.lua", "--threads: '0' is not a whole number in [1, 256]")
refused("--threads", "--threads needs a value")
refused("--plugin " .. folder .. "/no_such_plugin.so -e 'x = 1'", "no_such_plugin.so")
check.equal(run("--quiet -e 'x = 1'"), 0)

-- Plugins that must be refused, with path and reason; one of them is of another major version. Those
-- in `loads` load: half_way fails when it is used, single_blocks, failing, liar, unfit, unfit_solid, crasher and mumbles when told to,
-- older_minor, blank_screen, halving and half_marked never.
local bad = os.getenv("TALUS_BAD_PLUGIN_DIR")
if bad then
    local reasons = { wrong_major = "ABI 2.16", no_entry = "tl_plugin_entry", missing_ops = "stiffness" }
    local loads = { half_way = true, single_blocks = true, failing = true, older_minor = true, liar = true, crasher = true,
        mumbles = true, unfit = true, unfit_solid = true, blank_screen = true, halving = true, half_marked = true }
    local refusals = 0
    local list = io.popen("ls '" .. bad .. "'/*.so")
    for path in list:lines() do
        local name = path:match("([%w_]+)%.so$")
        if not loads[name] then
            refused("--plugin '" .. path .. "' -e 'x = 1'", path)
            refused("--plugin '" .. path .. "' -e 'x = 1'", reasons[name] or path)
            refusals = refusals + 1
        end
    end
    list:close()
    check.holds(refusals >= 3, "plugins to refuse")
    script = write("program_half_way.lua", [[
local model = require("talus").model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 1000 })
local before = model:state_hash()
local good, message = pcall(function() model:generate("half_way") end)
assert(not good and #model:blocks() == 1 and model:state_hash() == before)
error(message, 0)
]])
    refused("--plugin '" .. bad .. "/half_way.so' " .. script, "program_half_way.lua:4: generator 'half_way'")
end

-- Help, version, plugins.
status, output = run("--version")
check.equal(status, 0)
contains(output, "Talus ")
contains(output, "plugin interface ")
contains(output, "compiler: ")
contains(output, "build: ")
status, output = run("help")
check.equal(status, 0)
for _, word in ipairs { "talus plugins", "--threads", "generate", "solve", "coulomb", "adaptive", "jointset" } do
    contains(output, word)
end
status, output = run("help solve")
check.equal(status, 0)
contains(output, "default 1e-05")
contains(output, "on_progress")
status, output = run("help joint") -- a function and a generator
contains(output, "model:joint(")
contains(output, "generator 'joint'")
contains(output, "in [0, 90]")
contains(select(2, run("help coulomb")), "in [0, 90)")
contains(select(2, run("help blocks")), "kinetic_energy")
refused("help solv", "there is no help on 'solv'; did you mean 'solve'?")
refused("help join", "there is no page 'join'; these speak of it (talus help NAME): blocks")
refused("help Cohesion", "there is no page 'Cohesion'; these speak of it (talus help NAME): keyblocks, factor_of_safety, cohesive,")
refused("help friction", ", ...") -- more than a sentence holds
refused("help submarine", "there is no help on 'submarine', and no page speaks of it; `talus help` lists all")
refused("help volt", "there is no help on 'volt', and no page speaks of it") -- not "bolt"
status, output = run("plugins")
check.equal(status, 0)
contains(output, "law 'coulomb'")
contains(output, "coulomb.so")

-- A data file of 3DEC: as a script, and at once. A mistake is told with its place, and ends both with status 1.
local data = write("program_data.3ddat", "model new\nblock create brick 0 1 ; one\nblock property density 2000\nplot create\n")
local told
status, output, told = run("convert " .. data)
check.equal(status, 0)
contains(output, 'model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 }) -- one\n')
contains(told, "program_data.3ddat:4: plot create: pictures and lists")
local script = folder .. "/program_data.lua"
status, output = run("convert --up y " .. data .. " " .. script)
check.equal(status, 0)
check.equal(output, "")
check.equal(run(script), 0)
status, output, told = run("run " .. data)
check.equal(status, 0)
contains(told, "program_data.3ddat:4: plot create: pictures and lists")
status, output, told = run(write("program_wrong.dat", "block create brick 0 1\n\nblok fix\n"))
check.equal(status, 1)
contains(told, "\ntalus: " .. folder .. "/program_wrong.dat:3: commands: unknown word 'blok'; did you mean 'block'?\n")
status = run("convert " .. folder .. "/program_wrong.dat")
check.equal(status, 1)
status, output, told = run(write("program_late.DAT", "\nblock create brick 0 1\nblock property density -1\n")) -- in capitals, too
check.equal(status, 1)
contains(told, "program_late.DAT:3: ")
refused("convert", "convert: name the data file")
refused("convert --down x", "unknown option '--down'")
refused("convert no_such_file.dat", "convert: cannot read 'no_such_file.dat'")
refused("convert --up x " .. data, "up = 'x' is none of")
contains(select(2, run "help"), "talus convert")
contains(select(2, run "help convert"), "talus.convert{")

-- What is printed to where there is no room for it.
if io.open("/dev/full") then
    local page = write("program_page.lua", [[
local talus = require "talus"
local model = talus.model {}
model:generate("box", { min = { 0, 0, 0 }, max = { 1, 1, 1 }, density = 2000 })
model:timestep { dt = 0.001 }
if arg[1] == "report" then
    talus.report(model)
elseif arg[1] == "parameters" then
    model:parameters()
elseif arg[1] == "often" then
    for i = 1, 20000 do io.write(i, "\n") end
else
    print "one line"
end
if arg[2] then os.exit(true, arg[2] == "close") end
]])
    for _, words in ipairs { "help", "help coulomb", "--help", "--version", "plugins", "-e 'print(1)'", "-e 'os.exit(0, print(1))'",
        page, page .. " report", page .. " parameters", page .. " often", page .. " line exit", page .. " line close" } do
        refused(words .. " >/dev/full", "not all that was printed could be written to the standard output")
        check.equal(run(words .. " >/dev/null"), 0)
    end
    check.equal(run(page .. " report >&-"), 1)
    check.equal(run("-e 'local nothing = 1' >&-"), 0)
end
