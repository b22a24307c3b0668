/* test_number.c - the text of a number is that of the C library with the fewest digits that read back. */
#include "base/number.h"
#include "base/random.h"
#include "check.h"

#include <math.h>

#define CASES 40000

/* What the text is to be: digit after digit is tried. */
static void tried(double value, char text[TL_NUMBER_TEXT])
{
    if (isnan(value))
        value = (double)NAN; /* its sign is not shown */
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(text, TL_NUMBER_TEXT, "%.*g", digits, value);
        double back = strtod(text, NULL);
        if (!isfinite(value) || !(back < value || back > value))
            return;
    }
}

static int agrees(double value)
{
    char text[TL_NUMBER_TEXT], wanted[TL_NUMBER_TEXT];
    size_t length = tl_number_text(value, text);
    tried(value, wanted);
    if (strcmp(text, wanted) == 0 && length == strlen(text))
        return 1;
    printf("  %a: '%s' is not '%s'\n", value, text, wanted);
    return 0;
}

static double from_bits(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static double neighbour(double value, int steps)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return from_bits(bits + (uint64_t)(int64_t)steps);
}

TEST(texts_of_single_numbers)
{
    const double numbers[] = {0,       1,       -1,       0.1,    0.3,   1e5,  999999,
                              1e6,     1234567, 12345678, 0.5,    1e-4,  1e-5, 9.5e-5,
                              1e-10,   1e-11,   9.9e14,   1e15,   1e22,  1e23, 5e-324,
                              1.7e308, 2600,    9.81,     1 / 3., 2 / 3.};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        CHECK(agrees(numbers[i]));
        CHECK(agrees(-numbers[i]));
    }
    CHECK(agrees((double)INFINITY));
    CHECK(agrees(-(double)INFINITY));
    char text[TL_NUMBER_TEXT];
    tl_number_text(-(double)NAN, text);
    CHECK_TEXT(text, "nan");
}

/* Any bits; of the size of coordinates; with few digits; powers of two and ten and their neighbours. */
TEST(texts_of_random_numbers)
{
    int wrong = 0;
    for (uint64_t i = 0; i < CASES; i++) {
        uint64_t bits = tl_key(7, i);
        double share = tl_uniform(bits);
        char few[TL_NUMBER_TEXT];
        snprintf(few, sizeof few, "%.*g", 1 + (int)(bits % 17), share * 1e3 - 500);
        wrong += !agrees(from_bits(bits));
        wrong += !agrees(ldexp(share - 0.5, (int)(bits % 90) - 36));
        wrong += !agrees(strtod(few, NULL));
        wrong += !agrees(floor(ldexp(share, (int)(bits % 64))));
        wrong += !agrees(neighbour(ldexp(1, (int)(bits % 120) - 60), (int)(bits >> 32) % 4 - 2));
        snprintf(few, sizeof few, "%de%d", 1 + (int)(bits % 9), (int)(bits >> 8 & 31) - 14);
        wrong += !agrees(neighbour(strtod(few, NULL), (int)(bits >> 32) % 4 - 2));
        if (wrong > 9)
            break;
    }
    CHECK_INT(wrong, 0);
}

TEST_MAIN(RUN(texts_of_single_numbers), RUN(texts_of_random_numbers))
