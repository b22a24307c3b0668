/* output_file.h - a file that appears whole or not at all.
 *
 * It is written without a name, or under a temporary one beside its place, and gets its name when all is well. So a
 * reader (ParaView refreshing a series) never sees half a file, and a failure leaves what was there. */
#ifndef TL_BASE_OUTPUT_FILE_H
#define TL_BASE_OUTPUT_FILE_H

#include <stdbool.h>
#include <stdio.h>
#include <talus/types.h>

typedef struct tl_output {
    FILE *file;      /* to write to, until finished; write errors are found by tl_output_finish */
    int nameless;    /* descriptor of a finished file without a name; 0: there is none */
    char *path;      /* as the user gave it */
    char *place;     /* the same without symbolic links */
    char *temporary; /* its name until it is committed; NULL: it has none */
    int code;        /* errno of the first failure of tl_output_put */
    bool durable;    /* set after the opening: it is to outlive a crash of the machine from the commit on */
} tl_output;

/* From the opening of a file until it is dropped the caller holds the signals that end a program (base/signals.h). So
 * its end leaves no temporary file. */

/* Opens the file that is to become `path`, making the folders on the way. Only a regular file is ever replaced: a
 * device, a pipe or a folder is refused. A symbolic link stays, and the file that it leads to is replaced. */
tl_status tl_output_open(tl_output *output, const char *path, tl_error *error);
/* Writes many bytes at once; what fails is found by tl_output_finish. */
void tl_output_put(tl_output *output, const void *data, size_t bytes);
/* Writes out and closes; TL_E_IO when anything since the opening failed. */
tl_status tl_output_finish(tl_output *output, tl_error *error);
/* Gives the finished file its name, in place of any older one. */
tl_status tl_output_commit(tl_output *output, tl_error *error);
/* Removes what is not committed and frees; does nothing to a zeroed or dropped output. */
void tl_output_drop(tl_output *output);
/* Puts what a file holds; TL_OK or the status of an error. */
typedef tl_status (*tl_output_fn)(tl_output *output, void *user);
/* All of it: a file that `fill` writes, while the signals that end a program are held. */
tl_status tl_output_whole(const char *path, tl_output_fn fill, void *user, tl_error *error);
/* What the user gave before the ending that the files get in any case, in memory of its own; NULL when there is none
 * left. */
char *tl_output_prefix(const char *given, const char *ending);
/* Makes every folder in front of the last '/' of `path`; 0 or an errno. */
int tl_output_folders(const char *path);
/* TL_E_IO: "cannot write 'path': " and the text of an errno. */
tl_status tl_output_fail(tl_error *error, const char *path, int code);

#endif
