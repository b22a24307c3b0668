-- words_others.lua - commands for what Talus has not got or does otherwise, and calls of other files.
return function(row)
    row("program call|call", { form = "file", becomes = "the commands of that file, in its place",
        example = "program call 'more.dat'", convert = function(c, a)
            c.call(a:text "the file")
            while a:more() do
                a:text "an option"
            end
        end })
    row("fish set|fish", { form = "set @name f ...", becomes = "a local variable", example = "fish set @kn=1e9",
        convert = function(c, a)
            a:take "set"
            while a:more() do
                local token = a:peek()
                if token.kind ~= "expression" and token.kind ~= "word" or a:sees("callback", "history", "list", "operator", "create") then
                    c.leave "functions of FISH are not converted"
                end
                a.at = a.at + 1
                c.assign(token.text, a:number "the value")
            end
        end })
    row("plot|print|program log|program log-file|program list|list|model list|model display|block list|program playback|" ..
        "program undo|program pause|program system|program load|pause|log|log-file|view|movie|fish list|block vtk|export|block export",
        { lacks = "pictures and lists: model:write_vtk, model:write_html, talus.report, talus.plot" })
    row("structure|sel|cable|beam|liner|shell|block structure",
        { lacks = "support is placed by model:element, as \"bolt\", \"anchor\" or \"liner\"" })
    row("block water|block fluid|water|fluid|block zone fluid|model fluid|block flow|flow",
        { lacks = "water in joints is set by model:water: \"table\", \"uniform\", \"field\" or \"flow\"" })
    row("block thermal|thermal|model thermal", { lacks = "Talus has no heat" })
    row("dfn|fracture", { lacks = "fractures are cut by generate{\"dfn\"}" })
    row("quiet|free-field|block dynamic", { lacks = "model:boundary has quiet sides and free fields, talus.record records" })
    row("model factor-of-safety", { lacks = "factors are found by model:factor_of_safety{} and model:safety_map{}" })
    row("block analyze-stability", { lacks = "blocks that can move are found by model:keyblocks{}" })
    row("geometry|data|block import|block cells|block densify|block fragment|block fill|block makewall|block joint-plane|" ..
        "zone|python|ffield|model python|python-reset-state|block remove|model undo", { lacks = "no counterpart" })
    row("block relax|block trace|block merge-start|block to-flac3d|block to-pfc|block to-udec|" ..
        "block contact use-actual|block update|fblock|feblock", { lacks = "no counterpart" })
end
