/* test_number.c - the text of a number is that of the C library with the fewest digits that read back. What reads and writes
 * numbers (talus/number.h) does what the C library does where the decimal point is a point; tests/python/test_locale.py looks
 * where it is none. */
#include "base/number.h"
#include "base/random.h"
#include "check.h"

#include <math.h>
#include <talus/number.h>

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
    const double numbers[] = {0,        1,    -1,     0.1,     0.3,    1e5,   999999, 1e6,    1234567,
                              12345678, 0.5,  1e-4,   1e-5,    9.5e-5, 1e-10, 1e-11,  9.9e14, 1e15,
                              1e22,     1e23, 5e-324, 1.7e308, 2600,   9.81,  1 / 3., 2 / 3.};
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

/* ---------------------------------------------------------------- reading ---------------- */

/* Whether the reader gives the C library's number, and ends where it does. */
static int reads(const char *text)
{
    const char *end;
    char *wanted_end;
    double value = tl_number_read(text, &end), wanted = strtod(text, &wanted_end);
    if (memcmp(&value, &wanted, sizeof value) == 0 && end == wanted_end)
        return 1;
    printf("  '%.60s': %a up to '%.20s' is not %a up to '%.20s'\n", text, value, end, wanted, wanted_end);
    return 0;
}

TEST(single_numbers_are_read)
{
    const char *const texts[] = {"0",
                                 "-0",
                                 "+0.0",
                                 "000",
                                 "1",
                                 "-1.5",
                                 "+.5",
                                 "5.",
                                 ".",
                                 "",
                                 "-",
                                 "e5",
                                 "1e",
                                 "1e+",
                                 "1e-x",
                                 "1E5",
                                 "1e5.5",
                                 "1.2.3",
                                 "1,5",
                                 "12 13",
                                 "1e400",
                                 "-1e400",
                                 "1e-400",
                                 "0e999999999",
                                 "nan",
                                 "inf",
                                 "-inf",
                                 "INFINITY",
                                 "north",
                                 "infinite",
                                 "0.1e1",
                                 "1e0005",
                                 "1e22",
                                 "1e23",
                                 "4.9e-324",
                                 "2.4e-324",
                                 "2.5e-324",
                                 "1.7976931348623158e308",
                                 "1.7976931348623159e308",
                                 "9007199254740993",
                                 "9007199254740992.9999",
                                 "0.000001",
                                 "1e99999999999999999999",
                                 "1e-99999999999999999999",
                                 "00012.500e-003xyz"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        CHECK(reads(texts[i]));
    const char *end, *hexadecimal = "0x1p3";
    CHECK_NEAR(tl_number_read(hexadecimal, &end), 0, 0);
    CHECK(end == hexadecimal + 1);
    CHECK_NEAR(tl_number_read(" 1", &end), 0, 0);
    CHECK_NEAR(tl_number_read("2.5", NULL), 2.5, 0);
}

/* More digits than are looked at: half-way between two doubles, and a little more, far behind. */
TEST(long_numbers_are_read)
{
    static char text[4000];
    for (int tail = 700; tail < 1700; tail += 37) {
        for (int last = 0; last < 2; last++) {
            int n = snprintf(text, sizeof text, "1.00000000000000011102230246251565404236316680908203125");
            memset(text + n, '0', (size_t)tail);
            snprintf(text + n + tail, 40, "%de%d", last, tail % 5 - 2);
            CHECK(reads(text));
            text[1] = '0'; /* without a point */
            CHECK(reads(text));
        }
    }
    memset(text, '0', 3000);
    text[1] = '.';
    strcpy(text + 3000, "123e2999");
    CHECK(reads(text));
    memset(text, '7', 3000);
    strcpy(text + 3000, "e-2990");
    CHECK(reads(text));
}

TEST(random_numbers_are_read)
{
    int wrong = 0;
    for (uint64_t i = 0; i < CASES && wrong < 10; i++) {
        uint64_t bits = tl_key(8, i);
        char text[1200];
        snprintf(text, sizeof text, "%.*g", 1 + (int)(bits >> 8 & 31), from_bits(bits));
        wrong += !reads(text);
        snprintf(text, sizeof text, "%.*f", (int)(bits >> 8 & 63), ldexp(tl_uniform(bits), (int)(bits % 1100) - 100));
        wrong += !reads(text);
        snprintf(text, sizeof text, "%.800g", from_bits(tl_key(9, i)));
        wrong += !reads(text);
    }
    CHECK_INT(wrong, 0);
}

/* ---------------------------------------------------------------- writing ---------------- */

TL_PRINTF(3, 4)
static int library_print(char *to, size_t size, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(to, size, format, arguments);
    va_end(arguments);
    return length;
}

/* Both writers, in a room of every size. */
#define WRITES(...)                                                                                                    \
    for (size_t size_ = 0; size_ < 60; size_++) {                                                                      \
        char wanted[400], got[400];                                                                                    \
        memset(wanted, '#', sizeof wanted);                                                                            \
        memset(got, '#', sizeof got);                                                                                  \
        wanted[size_] = got[size_] = '\0'; /* a size of 0 writes no end */                                             \
        int length = library_print(wanted, size_, __VA_ARGS__);                                                        \
        CHECK_INT(tl_text_print(got, size_, __VA_ARGS__), length);                                                     \
        CHECK(strcmp(got, wanted) == 0);                                                                               \
        CHECK(memcmp(got + size_, wanted + size_, sizeof got - size_) == 0);                                           \
    }

TEST(texts_are_written)
{
    WRITES("%s", "");
    WRITES("nothing");
    WRITES("100 %% of %s", "it");
    WRITES("%d %u %x %X %o %c%c", -5, 7u, 255u, 255u, 8u, 'a', 'b');
    WRITES("%ld %lu %lld %llu", -5l, 7ul, INT64_MIN + 0ll, UINT64_MAX + 0ull);
    WRITES("%zu %zd %jd %td %hhu %hd", (size_t)-1, (size_t)5, (intmax_t)-9, (ptrdiff_t)-3, (unsigned char)200,
           (short)-2);
    WRITES("%04o|%-8s|%8s|%.2s|%-*s|%*d|%.*s|", 7u, "ab", "cd", "efgh", 6, "x", 5, 42, 3, "long");
    WRITES("%.*s|%*d", -1, "whole", -5, 42);
    WRITES("%g %e %f %a %G %E %A", 0.1, 1e300, 1e22, 0.1, 1e-9, -3.5, 1e-300);
    WRITES("%.3g|%10.4f|%-10.1e|%+g|% g|%05.1f|%#g|%.0f", 1 / 3., 2.5, 1e-5, 1., 2., 3.5, 4., 0.5);
    WRITES("%.*g %*.*f", 12, 1 / 3., 9, 2, 1 / 3.);
    WRITES("{%g, %g, %g} m, block %u of '%s'", 1.5, -2.25, 1e9, 12u, "J1, J2");
    char text[8];
    snprintf(text, sizeof text, "%p", (void *)text);
    WRITES("%p", (void *)text);
}

TEST_MAIN(RUN(texts_of_single_numbers), RUN(texts_of_random_numbers), RUN(single_numbers_are_read),
          RUN(long_numbers_are_read), RUN(random_numbers_are_read), RUN(texts_are_written))
