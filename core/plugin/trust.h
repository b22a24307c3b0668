/* trust.h - where the program lies, and whether a folder or file is a place to load code from. */
#ifndef TL_PLUGIN_TRUST_H
#define TL_PLUGIN_TRUST_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>

/* The file of the program or library that this code is in, without links; false when the system does not tell. */
bool tl_own_file(char file[PATH_MAX]);

/* Whether nobody but root, the user and the owner of the file `program` can have put the folder or file there;
 * otherwise `why` says who could. */
bool tl_path_is_trusted(const char *path, const char *program, char *why, size_t size);

#endif
