-- dat.lua - how `talus run FILE.dat` reads a data file of 3DEC: gives it as a chunk of Lua, line by line.
return require("talus.threedec").read(...)
