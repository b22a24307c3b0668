/* autosave.c - runs that are saved as they go: `talus run --autosave MINUTES SCRIPT` saves the model that runs, from time to time, in a
 * file beside the script, and after `talus run --resume SCRIPT` talus.resumed() gives it back. When a save happens goes by the
 * clock, which is no harm: saving does not change a run. */
#include "front.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ENDING ".autosave.talus"

char *tl_lua_autosave_path(const char *script)
{
    size_t room = strlen(script) + sizeof ENDING;
    char *path = malloc(room);
    if (path)
        snprintf(path, room, "%s%s", script, ENDING);
    return path;
}

void tl_lua_autosave(tl_lua_options *options, tl_model *model)
{
    if (!(options->autosave > 0) || !options->save_path)
        return;
    double now = tl_lua_clock();
    if (options->save_due == 0) /* the first step of all */
        options->save_due = now + options->autosave;
    if (now < options->save_due)
        return;
    options->save_due = now + options->autosave;
    if (tl_model_save(model, options->save_path) !=
        TL_OK) { /* the run is worth more than its save */
        char text[TL_ERROR_TEXT + 32];
        snprintf(text, sizeof text, "autosave: %s", tl_model_error(model)->text);
        tl_lua_log(options, text);
    }
}
