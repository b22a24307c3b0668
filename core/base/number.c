/* number.c - the shortest text of a double, as "%.*g" writes it. It has the fewest digits, from six on, that read
 * back as the same double.
 *
 * Numbers between 1e-10 and 1e15, which are nearly all, go without the C library, exactly, in integers of 128 bits.
 * The double is m 2^e with m < 2^53. The integer k is chosen so that
 *
 *     value 10^k = m 5^k / 2^s,   s = -(e + k),
 *
 * lies between 1e16 and 1e17: its whole part has 17 digits, which always read back. Here m 5^k < 2^116 and s > 0, as
 * 2 <= k <= 27. Fewer digits read back when the decimal number nearest to the double lies within half a step of the
 * doubles. That is 5^k / 2 in the units of m 5^k. The edge counts when m is even, since ties are read as the even
 * one. Where a number of digits does so does every larger number, since what it can write is no farther from the
 * double. A power of two is nearer to the double below it than to the one above. It is left to the C library, as are
 * the very large and small. */
#include "base/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>

#define LEAST_DIGITS 6
#define MOST_DIGITS 17
/* Cost only: between these the digits are found in integers. */
#define LEAST 1e-10
#define MOST 1e15

__extension__ typedef unsigned __int128 wide;

static const uint64_t tens[MOST_DIGITS + 1] = {1u,
                                               10u,
                                               100u,
                                               1000u,
                                               10000u,
                                               100000u,
                                               1000000u,
                                               10000000u,
                                               100000000u,
                                               1000000000u,
                                               10000000000u,
                                               100000000000u,
                                               1000000000000u,
                                               10000000000000u,
                                               100000000000000u,
                                               1000000000000000u,
                                               10000000000000000u,
                                               100000000000000000u};

/* A double times a power of ten: a whole part and the rest, over 2^shift. */
typedef struct scaled_value {
    uint64_t whole, rest;
    uint64_t step;       /* between doubles, in the unit of the rest */
    int shift, exponent; /* decimal, of the first digit */
    bool even;           /* the double's mantissa */
} scaled_value;

/* Decimal digits, and the exponent of the first. */
typedef struct decimal {
    uint64_t digits;
    int count, exponent;
} decimal;

static uint64_t power_of_five(int power)
{
    uint64_t out = 1;
    while (power-- > 0)
        out *= 5;
    return out;
}

static scaled_value scale(uint64_t mantissa, int binary, int exponent)
{
    int k = MOST_DIGITS - 1 - exponent;
    scaled_value out = {.step = power_of_five(k), .shift = -(binary + k), .exponent = exponent};
    wide all = (wide)mantissa * out.step;
    out.whole = (uint64_t)(all >> out.shift);
    out.rest = (uint64_t)(all & (((wide)1 << out.shift) - 1));
    out.even = mantissa % 2 == 0;
    return out;
}

/* Rounds to so many digits, ties to even; says whether they read back as the double. */
static bool round_to(const scaled_value *of, int count, decimal *out)
{
    uint64_t unit = tens[MOST_DIGITS - count], digits = of->whole / unit, over = of->whole % unit;
    /* twice what is cut off, and the unit, in the unit of the rest */
    wide cut = (((wide)over << of->shift) + of->rest) * 2, full = (wide)unit << of->shift;
    bool up = cut > full || (cut == full && digits % 2 == 1);
    wide error = up ? 2 * full - cut : cut;
    *out = (decimal){digits + up, count, of->exponent};
    if (out->digits == tens[count]) { /* 9.99... became 10 */
        out->digits /= 10;
        out->exponent++;
    }
    return error < of->step || (error == of->step && of->even);
}

/* The fewest digits that read back. */
static decimal fewest(const scaled_value *of)
{
    decimal out, fewer;
    round_to(of, MOST_DIGITS, &out);
    for (int count = MOST_DIGITS - 1; count >= LEAST_DIGITS && round_to(of, count, &fewer); count--)
        out = fewer;
    return out;
}

/* ---------------------------------------------------------------- text ------------------- */

/* Writes a whole number with so many digits at least. */
static char *put_whole(char *to, uint64_t value, int least)
{
    char digits[20];
    int count = 0;
    for (; value > 0 || count < least; value /= 10)
        digits[count++] = (char)('0' + value % 10);
    while (count > 0)
        *to++ = digits[--count];
    return to;
}

/* As "%.*g": with an exponent when it is below -4 or not below the number of digits, without zeros at the end. */
static char *put_decimal(char *to, decimal d)
{
    bool scientific = d.exponent < -4 || d.exponent >= d.count;
    while (d.count > 1 && d.digits % 10 == 0) {
        d.digits /= 10;
        d.count--;
    }
    int before = scientific ? 1 : d.exponent + 1; /* digits before the point */
    if (before <= 0) {
        to = put_whole(to, 0, 1);
        *to++ = '.';
        to = put_whole(to, d.digits, d.count - before);
    } else if (before >= d.count) {
        to = put_whole(to, d.digits * tens[before - d.count], 1);
    } else {
        uint64_t unit = tens[d.count - before];
        to = put_whole(to, d.digits / unit, 1);
        *to++ = '.';
        to = put_whole(to, d.digits % unit, d.count - before);
    }
    if (scientific) {
        *to++ = 'e';
        *to++ = d.exponent < 0 ? '-' : '+';
        to = put_whole(to, (uint64_t)abs(d.exponent), 2);
    }
    return to;
}

static bool reads_back(double value, int digits, char text[TL_NUMBER_TEXT])
{
    tl_text_print(text, TL_NUMBER_TEXT, "%.*g", digits, value);
    double back = tl_number_read(text, NULL);
    return !isfinite(value) || !(back < value || back > value);
}

/* The same with the digits of the C library. */
static size_t by_library(double value, char text[TL_NUMBER_TEXT])
{
    /* The sign of a NaN, which some systems print, says nothing to a user. */
    if (isnan(value))
        value = (double)NAN;
    int digits = LEAST_DIGITS;
    while (!reads_back(value, digits, text) && digits < MOST_DIGITS)
        digits++;
    return strlen(text);
}

size_t tl_number_text(double value, char text[TL_NUMBER_TEXT])
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    double size = fabs(value);
    char *to = text;
    if (bits >> 63)
        *to++ = '-';
    if (size < (double)tens[LEAST_DIGITS] && size == (double)(uint64_t)size) {
        to = put_whole(to, (uint64_t)size, 1);
    } else {
        uint64_t fraction = bits & (((uint64_t)1 << 52) - 1);
        if (!(size >= LEAST && size < MOST) || fraction == 0)
            return by_library(value, text);
        int binary = (int)(bits >> 52 & 2047) - 1023; /* size is between 2^binary and twice that */
        uint64_t mantissa = fraction | (uint64_t)1 << 52;
        int exponent = (int)floor(binary * 0.30103); /* of ten, or one less */
        scaled_value of = scale(mantissa, binary - 52, exponent);
        if (of.whole >= tens[MOST_DIGITS])
            of = scale(mantissa, binary - 52, exponent + 1);
        to = put_decimal(to, fewest(&of));
    }
    *to = '\0';
    return (size_t)(to - text);
}
