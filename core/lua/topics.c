/* topics.c - the functions of the Lua front end as the help shows them. Their parameters come from
 * the tables that check them; only calls, methods and what they give are told here. */
#include "front.h"

static const tl_kind_type laws = TL_KIND_LAW, dampings = TL_KIND_DAMPING,
                          generators = TL_KIND_GENERATOR, screens = TL_KIND_SCREEN;

static const tl_lua_key block_verbs[] = {
    {"#sel, sel[i], ipairs(sel)", "", "number of blocks, the i-th one, all in order of id"},
    {"sel:sum(field)", "", "sum of a field of numbers; of a vector field a vector"},
    {"sel:max(field), sel:min(field)", "", "largest and smallest value of a field of numbers"},
    {"sel:values(field)", "",
     "list of the field's values, in the order of the selection: much faster than one by one. A "
     "vector is {x, y, z}; with \"flat\" after the field {x, y, z, x, y, z, ...}"},
    {"sel:bounds()", "", "{min = {x, y, z}, max = {x, y, z}} over all vertices"},
    {"sel:where(function(block) ... end)", "", "those for which the function answers true"},
    {"sel:hide(), sel:show()", "", "hidden blocks are not cut and not selected unless asked for"},
    {"sel:delete()", "", "removes the blocks"},
    {"sel:join(), sel:unjoin()", "",
     "makes one rigid body of the blocks and of what they were joined to; makes each a body of its "
     "own. Momentum and angular momentum are kept"},
    {"sel:load{...}", "", "a force and a moment: talus help load"},
    {"sel:drive{...}", "", "a prescribed motion, until sel:free(): talus help drive"},
    {"sel:fix{x =, y =, z =, rotation =}", "",
     "holds components of the motion; all of it when nothing is named: talus help fix"},
    {"sel:free()", "", "lets fixed and driven blocks go"},
    {"sel:reaction()", "",
     "sum of the forces that hold their bodies, N: {x, y, z}, of held components only"},
    {"sel:reset_displacement()", "", "displacements count from now"},
    {"sel:set{density =, group =, velocity =, angular_velocity =}", "",
     "changes properties: talus help set"},
    {NULL, NULL, NULL},
};

static const tl_lua_key contact_verbs[] = {
    {"#sel, sel[i], ipairs(sel)", "", "number of contacts, the i-th one, all in order of id"},
    {"sel:sum(field)", "",
     "sum of a field of numbers, or of a state of a law by its name; of a vector a vector"},
    {"sel:max(field), sel:min(field)", "",
     "largest and smallest value of a field of numbers, or of a state, where the law has it"},
    {"sel:values(field)", "",
     "list of the field's values, in the order of the selection; likewise a state of a law, by its "
     "name, NaN where the contact's law has no such state. With \"flat\" after it vectors are not "
     "lists of their own"},
    {"sel:where(function(contact) ... end)", "", "those for which the function answers true"},
    {NULL, NULL, NULL},
};

static const tl_lua_key run_results[] = {
    {"reason", "",
     "why it ended: \"ratio\", \"velocity\", \"failure\", \"overlap\" (blocks that were made "
     "overlapping push it apart), \"cycles\", \"time\", \"stop\" or "
     "\"interrupt\" (Ctrl-C at the prompt; in a script it raises an error)"},
    {"ratio", "", "mean unbalanced force over mean contact force"},
    {"ratio_maximum", "", "largest unbalanced force over mean contact force"},
    {"ratio_local", "",
     "largest unbalanced force of a block over its own contact forces, or its weight and load "
     "where "
     "these are more"},
    {"measure", "", "the measure that may end the run"},
    {"worst", "",
     "the block farthest from rest by the measure \"local\": nil when there is none that can move, "
     "or "
     "no force on any"},
    {"failing", "",
     "a block that fails steadily: it moves on in one direction without slowing down, and the "
     "force "
     "that pushes it stays; nil when none does"},
    {"cycles", "", "steps of this call"},
    {"time", "", "the model's time at the end, s"},
    {"wall", "", "seconds it took"},
    {"max_velocity", "", "largest speed of a block that forces move, m/s"},
    {NULL, NULL, NULL},
};

static const tl_lua_key model_members[] = {
    {"model.gravity", "", "acceleration of gravity {x, y, z}, m/s2; may be assigned"},
    {"model.rotation", "", "\"exact\" or \"paper\"; may be assigned"},
    {"model.contact_points", "",
     "\"consistent\" or \"corners\" (not of faces that meet another at less than 20 degrees); may "
     "be assigned"},
    {"model.reuse_geometry", "", "true or false; may be assigned"},
    {"model.time, model.cycles", "", "simulated time, s, and steps so far"},
    {"model.mass_scaled", "", "whether mass scaling is on"},
    {"model.dt", "", "the step the next cycle will use, s"},
    {"model.threads, model.seed", "", "as given when it was made"},
    {NULL, NULL, NULL},
};

static const tl_lua_key energy_terms[] = {
    {"kinetic", "", "of motion, J"},
    {"potential", "", "minus the work of gravity, J"},
    {"stored", "", "elastic, in all contacts, those of held blocks, too, J"},
    {"friction", "", "turned to heat by slip, J"},
    {"damping", "", "taken out by the damping, J"},
    {"external", "",
     "work of loads and driven bodies, and given by setting velocities and by edits of blocks and "
     "laws, J"},
    {"balance", "", "error of the sum over the largest change of a term so far"},
    {NULL, NULL, NULL},
};

static const tl_lua_key timestep_results[] = {
    {"dt", "", "the step the next cycle will use, s; 0 where nothing can move and no law is set"},
    {"block", "", "the block that controls it, or nil"},
    {"partner", "", "the block at the stiffest contact, or nil"},
    {"mass, stiffness", "",
     "of the block's body, kg; of the contact, of all its contacts or of the part of its largest "
     "face that counts, N/m"},
    {"message", "", "the same in a sentence"},
    {NULL, NULL, NULL},
};

static const tl_lua_key mass_scaling_results[] = {
    {"on", "",
     "whether inertia is scaled; the other fields are there after mass_scaling{dt =} only"},
    {"dt, most", "", "the step, s, and the largest share, as given"},
    {"added", "",
     "mass that the last step has added, as a share of that of the bodies that can move"},
    {"bodies", "", "how many have got some"},
    {"worst", "",
     "{block =, factor =}: the number of the block with the highest factor, and its inertia over "
     "its "
     "own; nil when none has got any"},
    {NULL, NULL, NULL},
};

static const tl_lua_key report_results[] = {
    {"blocks, bodies", "", "number of blocks, and of bodies they make"},
    {"volume, volume_error", "",
     "of all blocks, m3; and its relative difference from what was created less what was deleted"},
    {"smallest_volume, smallest_edge, smallest_face", "",
     "m3, m and m2; smallest_volume_block and so on are the blocks that have them"},
    {"worst_aspect, worst_aspect_block", "",
     "largest aspect of a block: its diameter (largest distance between two vertices) over its "
     "thickness (smallest extent along the normal of a face); 1.73 for a cube"},
    {"cuts, refused, coincident", "",
     "cuts made, refused because a side would be too thin, and fallen on existing faces, since the "
     "model was made"},
    {"refused_cuts", "",
     "the first 1000 refused cuts, each a table: joint, normal and point of the plane, block (its "
     "number), thickness and limit of the thinner side, and the reason as a sentence"},
    {"dt, timestep_block, timestep_message", "",
     "the time step, s, the block that controls it, and the same in a sentence; when some contact "
     "has no law yet, there is only the sentence"},
    {NULL, NULL, NULL},
};

static const tl_lua_key filter_results[] = {
    {"found, deleted, joined", "", "number of slivers, and what was done with them"},
    {"volume", "", "of all slivers, m3"},
    {"slivers", "",
     "each a table: block (its number), volume, edge, aspect, beyond (which limits: \"volume\", "
     "\"edge\", \"aspect\") and joined_to (a block, or nil)"},
    {NULL, NULL, NULL},
};

static const tl_lua_key keyblock_results[] = {
    {"block", "", "the block, the oldest one of a body of several"},
    {"mode", "",
     "\"falling\", \"sliding\" (on one face), \"sliding on two\", or \"stable\": removable, but "
     "pressed in by its weight"},
    {"safety", "", "factor of safety: 0 falling, math.huge stable"},
    {"faces", "",
     "the faces it slides on, none to two: {joint =, normal = (outward), area =, normal_force =}"},
    {"direction, driving_force", "",
     "of the motion, and the force along it, N; a stable one has no direction"},
    {"force, mass, volume", "", "weight and load, N; of the body, kg and m3"},
    {"pyramid", "",
     "edges of the joint pyramid, unit vectors: it can move in all directions between them"},
    {NULL, NULL, NULL},
};

static const tl_lua_key generate_results[] = {
    {"before, after", "", "number of blocks before and after"},
    {"cuts, refused, coincident", "",
     "cuts made, refused because a side would be too thin, and fallen on an existing face"},
    {"smallest_volume, smallest_edge, smallest_face", "", "of the model after, m3, m and m2"},
    {"volume_error", "", "relative change of the volume that is not accounted for"},
    {NULL, NULL, NULL},
};

const tl_lua_topic tl_lua_topics[] = {
    {.name = "model",
     .usage = "model = talus.model{gravity = {0, 0, -9.81}, ...}",
     .function = "model",
     .title = "Fields of the model",
     .verbs = model_members},
    {.name = "generate",
     .usage = "summary = model:generate(\"GENERATOR\", {...})",
     .doc = "Creates or cuts blocks; acts on visible blocks only, wholly or not at all. A list of "
            "tables, {{...}, {...}}, in the place of one: once for each, in their order and in one "
            "go.",
     .type = &generators,
     .title = "Fields of the summary",
     .verbs = generate_results},
    {.name = "blocks",
     .usage = "selection = model:blocks{...}",
     .doc = "Selects blocks, visible ones unless asked otherwise; all conditions must hold.",
     .spec = &tl_lua_blocks_spec,
     .kind = &tl_lua_block_kind,
     .title = "Methods of the selection",
     .verbs = block_verbs},
    {.name = "contacts",
     .usage = "selection = model:contacts{...}",
     .doc = "Selects contacts; all conditions must hold.",
     .spec = &tl_lua_contacts_spec,
     .kind = &tl_lua_contact_kind,
     .title = "Methods of the selection",
     .verbs = contact_verbs},
    {.name = "joint",
     .usage = "model:joint(\"J1\", \"LAW\", {...})  or  model:joint(\"J1\", {friction = 30})",
     .doc =
         "Sets the law of a joint set (\"J1\"), of one of its planes (\"J1:3\") or of every joint "
         "not named otherwise (\"*\"); without a law's name it changes properties.",
     .type = &laws},
    {.name = "joints",
     .usage = "list = model:joints()",
     .doc = "Lists the joint sets, in the order they were made.",
     .title = "Fields of each joint set",
     .verbs = tl_lua_joints_results},
    {.name = "laws",
     .usage = "list = model:laws()",
     .doc = "Lists the laws that were set by model:joint, with their parameters.",
     .title = "Fields of each law",
     .verbs = tl_lua_laws_results},
    {.name = "groups",
     .usage = "list = model:groups()",
     .doc = "Lists the groups that blocks have.",
     .title = "Fields of each group",
     .verbs = tl_lua_groups_results},
    {.name = "kinds",
     .usage =
         "list = talus.laws()  or  list = talus.dampings()  or  list = talus.generators()  or  "
         "list = talus.screens()",
     .doc = "Lists the laws, dampings, generators or screens that are loaded.",
     .title = "Fields of each kind",
     .verbs = tl_lua_kinds_results},
    {.name = "law_test",
     .usage = "curve = talus.law_test{law = \"coulomb\", params = {kn = 1e10, ks = 1e9, friction = "
              "30}, normal_stress = 1e6, path = {0.005, -0.005}}",
     .function = "law_test",
     .keys = tl_lua_law_test_keys,
     .title = "Fields of the curve",
     .verbs = tl_lua_law_test_results},
    {.name = "insitu",
     .usage = "model:insitu{stress = {zz = -1e6}, gradient = {zz = 2e4}, at = {0, 0, 0}}",
     .function = "insitu",
     .keys = tl_lua_insitu_keys},
    {.name = "damping",
     .usage = "model:damping(\"DAMPING\", {...})",
     .doc = "Chooses how motion is damped; \"none\" is no damping, and the default.",
     .type = &dampings},
    {.name = "fix",
     .usage = "selection:fix{x = true, rotation = true}  or  selection:fix()",
     .doc = "Holds components of the motion of the blocks' bodies, besides what is held already; "
            "all of it when nothing is named.",
     .spec = &tl_lua_fix_spec},
    {.name = "set",
     .usage = "selection:set{group = \"wedge\", velocity = {0, 0, -1}}",
     .doc = "Changes properties of blocks; what is not named stays.",
     .spec = &tl_lua_set_spec},
    {.name = "load",
     .usage = "selection:load{force = {0, 0, -1e3}, at = {x, y, z}}",
     .function = "load"},
    {.name = "boundary",
     .usage = "result = model:boundary{side = \"xmax\", stress = {xx = -1e6}}  or  "
              "model:boundary{xmin = \"roller\", zmin = \"fixed\", zmax = {pressure = 1e5}}",
     .doc =
         "Finds outer faces of the model: those, or parts of those, that lie on no other block. "
         "Holds their bodies, or puts a traction on them as a load: its force and moment about "
         "each body's centroid take the place of the load the body had, keep their direction and "
         "go with the body. What one call puts on a body adds up. When a face is cut, each part of "
         "it "
         "gets its share.",
     .spec = &tl_lua_boundary_spec,
     .title = "Fields of the result",
     .verbs = tl_lua_boundary_results},
    {.name = "drive",
     .usage = "selection:drive{velocity = function(t) return 0.1 * math.sin(t), 0, 0 end}",
     .doc =
         "Prescribes the motion of the blocks' bodies, in the place of any fixing, until "
         "selection:free(). A function is called in the middle of a step: it may read the model, "
         "but not change it. A body that is driven to turn is not cut in two.",
     .keys = tl_lua_drive_keys},
    {.name = "timestep",
     .usage = "model:timestep{fraction = 0.3}  or  report = model:timestep()",
     .function = "timestep",
     .title = "Fields of the report",
     .verbs = timestep_results},
    {.name = "mass_scaling",
     .usage = "model:mass_scaling(true)  or  model:mass_scaling{dt = 1e-4}  or  "
              "added = model:mass_scaling()",
     .function = "mass_scaling",
     .title = "Fields of what it tells",
     .verbs = mass_scaling_results},
    {.name = "contact_area",
     .usage = "model:contact_area{fraction = 0.01}",
     .function = "contact_area"},
    {.name = "parameters",
     .usage = "table = model:parameters()",
     .doc = "Tells all parameters the model has now, with defaults and units, as a table, and "
            "prints them (not with --quiet).",
     .title = "Fields of the table",
     .verbs = tl_lua_parameters_fields},
    {.name = "cycle",
     .usage = "result = model:cycle(1000)  or  model:cycle(1000, {every = 100, on_progress = f})",
     .function = "cycle",
     .keys = tl_lua_cycle_keys,
     .title = "Fields of the result",
     .verbs = run_results},
    {.name = "solve",
     .usage = "result = model:solve{ratio = 1e-5, ...}",
     .function = "solve",
     .keys = tl_lua_solve_keys,
     .title = "Fields of the result",
     .verbs = run_results},
    {.name = "history",
     .usage = "model:history{name = \"gap\", every = 10, value = function(m) return "
              "m:contacts():max(\"gap\") end}  or  model:history{name = \"wedge\", of = selection, "
              "field = \"displacement\"}",
     .doc =
         "Samples a value at once and then every so many steps of all runs, until it is removed.",
     .spec = &tl_lua_history_spec},
    {.name = "histories",
     .usage = "histories = model:histories()",
     .doc = "Gives a table with the samples of each history, by name: copies of them.",
     .title = "Fields of each history",
     .verbs = tl_lua_histories_fields},
    {.name = "write_histories",
     .usage = "model:write_histories(\"out/run.csv\")",
     .doc = "Writes the samples of all histories into a CSV file: the columns cycle, time and one "
            "for each history, in "
            "the order in which they were made, or name.x, name.y and name.z. A cell is empty "
            "where a history has no "
            "sample of that cycle. Folders are made; the file is written whole or not at all."},
    {.name = "plot",
     .usage = "talus.plot{file = \"out/run.svg\", model = model, histories = {\"roof\"}, y_axis = "
              "{name = \"subsidence\", unit = "
              "\"m\"}}",
     .doc = "Draws lists and histories as lines, with axes, ticks and a legend, into an SVG file.",
     .keys = tl_lua_plot_keys},
    {.name = "stereonet",
     .usage = "talus.stereonet{file = \"out/joints.svg\", model = model, keyblocks = "
              "model:keyblocks{friction = 30}}",
     .doc =
         "Draws joint sets by poles and great circles on the lower hemisphere, into an SVG file.",
     .keys = tl_lua_stereonet_keys},
    {.name = "energy",
     .usage = "energy = model:energy()",
     .doc = "The energy of the bodies that are free to move, at the last force evaluation, counted "
            "from the first step.",
     .title = "Fields of the energy",
     .verbs = energy_terms},
    {.name = "stage",
     .usage = "model:stage(\"excavated\")",
     .doc =
         "Begins a stage: displacements of all blocks count from now, as after "
         "reset_displacement, and so does what model:verdict and pages tell of slip and opening. "
         "What laws keep stays. The name is at most 63 bytes; copies and files have it."},
    {.name = "verdict",
     .usage = "verdict = model:verdict()",
     .doc = "Tells how the model stands as of its last step: at rest, moving, accelerating or "
            "failed, and what has moved since the stage began. Nothing changes by it.",
     .title = "Fields of the verdict",
     .verbs = tl_lua_verdict_fields},
    {.name = "report",
     .usage = "table = talus.report(model)",
     .doc = "Tells how good the blocks are that cutting made, and prints it on a page (not with "
            "--quiet).",
     .title = "Fields of the report",
     .verbs = report_results},
    {.name = "filter",
     .usage = "result = model:filter{volume = 1e-6, aspect = 100, action = \"join\"}",
     .function = "filter",
     .title = "Fields of the result",
     .verbs = filter_results},
    {.name = "keyblocks",
     .usage = "list = model:keyblocks{friction = 35}",
     .function = "keyblocks",
     .keys = tl_lua_keyblocks_keys,
     .title = "Fields of each keyblock",
     .verbs = keyblock_results},
    {.name = "profile",
     .usage = "model:profile(true); model:cycle(100); result = model:profile()",
     .function = "profile",
     .title = "Fields of the result",
     .verbs = tl_lua_profile_fields},
    {.name = "memory",
     .usage = "bytes = model:memory()",
     .doc = "Bytes the model holds, by what they are for, room for growth included.",
     .title = "Fields of the result",
     .verbs = tl_lua_memory_fields},
    {.name = "write_vtk",
     .usage = "model:write_vtk(\"out/run\", {contacts = false, block_fields = {height = "
              "function(b) return b.centroid[3] end}})",
     .function = "write_vtk",
     .keys = tl_lua_field_keys},
    {.name = "write_section",
     .usage =
         "model:write_section(\"out/cut\", {dip = 90, dip_direction = 90, origin = {0, 0, 0}})",
     .function = "write_section"},
    {.name = "write_html",
     .usage = "model:write_html(\"out/run\", {title = \"Slope\", block_fields = "
              "{\"kinetic_energy\"}})",
     .function = "write_html",
     .keys = tl_lua_page_keys},
    {.name = "view",
     .usage = "address = model:view{title = \"Slope\"}",
     .function = "view",
     .keys = tl_lua_view_keys,
     .type = &screens},
    {.name = "write_blocks",
     .usage = "model:write_blocks(\"out/blocks.json\")",
     .function = "write_blocks"},
    {.name = "write_file",
     .usage = "talus.write_file(\"out/table.csv\", text)",
     .doc = "Writes a text into a file, whole or not at all. Folders are made; only a regular file "
            "is replaced."},
    {.name = "state_hash",
     .usage = "text = model:state_hash()",
     .doc = "A digest of all that what comes next depends on, settings too: models with the same "
            "text go on alike, to the last bit. Takes about as long as a step."},
    {.name = "copy",
     .usage = "twin = model:copy()",
     .doc =
         "The same model once more in memory: equal state, and equal bits after equal calls from "
         "then on. The functions of drives are shared; frames of the copy begin with 0."},
    {.name = "save",
     .usage = "model:save(\"out/run.talus\")",
     .doc =
         "Saves all that the next steps depend on, to the bit, compressed and with checksums. The "
         "file appears whole or not at all, in the place of an older one, and outlives a crash "
         "of the machine; folders are made. The model goes on as if it had not been saved. "
         "Histories are saved with all their samples; functions of drives and histories are not. "
         "Frames of files go on with the next number."},
    {.name = "restore",
     .usage = "model = talus.restore(\"out/run.talus\", {threads = 2})",
     .doc =
         "The model that a file holds: it goes on as the saved one does, to the bit, on any number "
         "of threads. Laws and damping must be loaded in the version that it was saved with. A "
         "damaged file, and one of another format, is refused.",
     .keys = tl_lua_restore_keys},
    {.name = "resumed",
     .usage = "model = talus.resumed()",
     .doc =
         "The model that `talus run --autosave MINUTES SCRIPT` saved last, after `talus run "
         "--resume "
         "SCRIPT`; nil when the script is not resumed, or nothing was saved. Takes the options of "
         "talus.restore. The file lies beside the script: SCRIPT.autosave.talus."},
    {.name = NULL},
};
