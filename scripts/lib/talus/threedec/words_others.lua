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
    row("structure|sel|cable|beam|liner|shell|block structure", { lacks = "Talus has no support elements yet" })
    row("block water|block fluid|water|fluid|block zone fluid|block thermal|thermal|model fluid|model thermal|block flow|flow",
        { lacks = "Talus has no water and no heat" })
    row("dfn|fracture|geometry|data|block import|block cells|block densify|block fragment|block fill|block makewall|" ..
        "block joint-plane|zone|python|ffield|quiet|free-field|model python|python-reset-state|block remove|model undo", { lacks = "no counterpart" })
    row("block analyze-stability|block relax|block trace|block merge-start|block to-flac3d|block to-pfc|block to-udec|" ..
        "block dynamic|block contact use-actual|block update|fblock|feblock", { lacks = "no counterpart" })
end
