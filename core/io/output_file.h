/* output_file.h - a file that appears whole or not at all.
 *
 * It is written under a temporary name beside its place and renamed when all is well, so a reader
 * (ParaView refreshing a series) never sees half a file and a failure leaves what was there. */
#ifndef TL_IO_OUTPUT_FILE_H
#define TL_IO_OUTPUT_FILE_H

#include <stdio.h>
#include <talus/types.h>

typedef struct tl_output {
    FILE *file; /* to write to, until finished; write errors are found by tl_output_finish */
    char *path, *temporary;
} tl_output;

/* Opens the temporary file of `path`, making the folders on the way. */
tl_status tl_output_open(tl_output *output, const char *path, tl_error *error);
/* Writes out and closes; TL_E_IO when anything since the opening failed. */
tl_status tl_output_finish(tl_output *output, tl_error *error);
/* Gives the finished file its name, in place of any older one. */
tl_status tl_output_commit(tl_output *output, tl_error *error);
/* Removes what is not committed and frees; does nothing to a zeroed or dropped output. */
void tl_output_drop(tl_output *output);

#endif
