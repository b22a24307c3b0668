/* number.h - numbers as text that gives back the same number. */
#ifndef TL_BASE_NUMBER_H
#define TL_BASE_NUMBER_H

#include <stddef.h>

/* Bytes of the longest text of tl_number_text, with the zero at its end. */
#define TL_NUMBER_TEXT 32

/* The shortest decimal text that reads back as the same double, from six digits on; returns its length. */
size_t tl_number_text(double value, char text[TL_NUMBER_TEXT]);

#endif
