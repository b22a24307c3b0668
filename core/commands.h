/* commands.h - sub-commands of the program that need no Lua: each gets the words after its name and gives the exit status. */
#ifndef TL_COMMANDS_H
#define TL_COMMANDS_H

/* talus check FILE.so [NAME=VALUE...] */
int tl_command_check(int argc, char **argv);
/* talus new law|damping|generator NAME [FOLDER] */
int tl_command_new(int argc, char **argv);

#endif
