/* commands.h - sub-commands of the program that need no Lua. Each gets the words after its name, returns the status. */
#ifndef TL_COMMANDS_H
#define TL_COMMANDS_H

#include <talus/plugin.h>

/* Puts "talus: " and a sentence on the standard error, in one line whatever names are in it; gives false. */
bool tl_command_fail(const char *format, ...) TL_PRINTF(1, 2);
/* talus check FILE.so [NAME=VALUE...] */
int tl_command_check(int argc, char **argv);
/* talus new law|damping|generator|solid|element NAME [FOLDER] */
int tl_command_new(int argc, char **argv);

#endif
