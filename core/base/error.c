/* error.c - see error.h. */
#include "base/error.h"

#include <stdio.h>
#include <string.h>
#include <talus/number.h>

tl_status tl_fail(tl_error *error, tl_status status, const char *format, ...)
{
    if (error) {
        va_list args;
        va_start(args, format);
        error->status = status;
        tl_text_vprint(error->text, sizeof error->text, format, args);
        va_end(args);
        tl_text_clean(error->text, sizeof error->text);
    }
    return status;
}

tl_status tl_fail_memory(tl_error *error)
{
    return tl_fail(error, TL_E_MEMORY, "%s", tl_status_text(TL_E_MEMORY));
}

tl_status tl_error_prefix(tl_error *error, const char *format, ...)
{
    char sentence[TL_ERROR_TEXT];
    memcpy(sentence, error->text, sizeof sentence);
    va_list args;
    va_start(args, format);
    int n = tl_text_vprint(error->text, sizeof error->text, format, args);
    va_end(args);
    if (n >= 0 && (size_t)n < sizeof error->text)
        snprintf(error->text + n, sizeof error->text - (size_t)n, "%s", sentence);
    tl_text_clean(error->text, sizeof error->text);
    return error->status;
}

const char *tl_report_text(tl_report *report, tl_status status)
{
    report->text[sizeof report->text - 1] = '\0';
    tl_text_clean(report->text, sizeof report->text);
    if (report->text[strspn(report->text, " ")] == '\0')
        snprintf(report->text, sizeof report->text, "no reason given (status %d: %s)", (int)status,
                 tl_status_text(status));
    return report->text;
}

const char *tl_status_text(tl_status status)
{
#define TL_STATUS_TEXT(name, text) text,
    static const char *const texts[] = {TL_STATUS_LIST(TL_STATUS_TEXT)};
#undef TL_STATUS_TEXT
    return (unsigned)status < TL_STATUS_COUNT ? texts[status] : "unknown status";
}
