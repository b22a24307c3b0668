/* commands.c - what sub-commands of the program say when they fail. */
#include "commands.h"

#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <talus/number.h>
#include <talus/text.h>

bool tl_command_fail(const char *format, ...)
{
    char sentence[3 * PATH_MAX];
    va_list arguments;
    va_start(arguments, format);
    tl_text_vprint(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    tl_text_clean(sentence, sizeof sentence);
    fprintf(stderr, "talus: %s\n", sentence);
    return false;
}
