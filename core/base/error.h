/* error.h - the error record: one status and one sentence. */
#ifndef TL_BASE_ERROR_H
#define TL_BASE_ERROR_H

#include <stdarg.h>
#include <talus/plugin.h>
#include <talus/text.h>
#include <talus/types.h>

/* Puts a formatted sentence into `error` (which may be NULL) and returns `status`. Line ends in names, and the like,
 * are shown escaped (talus/text.h): a sentence is one line. */
tl_status tl_fail(tl_error *error, tl_status status, const char *format, ...) TL_PRINTF(3, 4);
/* TL_E_MEMORY with its sentence. */
tl_status tl_fail_memory(tl_error *error);
/* Puts a formatted text in front of the sentence already there; returns its status. */
tl_status tl_error_prefix(tl_error *error, const char *format, ...) TL_PRINTF(2, 3);
/* The sentence in a report that came back with `status`, ended and cleaned; what is told where it is empty. */
const char *tl_report_text(tl_report *report, tl_status status);
/* The text of a status code. */
const char *tl_status_text(tl_status status);

#endif
