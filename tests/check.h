/* check.h - the test harness: a test program is a list of cases made of checks.
 *
 * A failed check prints the expression, both values, the tolerance and file:line, and the test goes
 * on. A program ends with "name: N checks, F failed" and exit status 1 when F > 0.
 *
 *     TEST(box_has_unit_volume) { CHECK_NEAR(tl_poly_mass(box).volume, 1.0, 1e-15); }
 *     TEST_MAIN(RUN(box_has_unit_volume)) */
#ifndef TALUS_TESTS_CHECK_H
#define TALUS_TESTS_CHECK_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int check_count, check_failed;
static const char *check_case = "";

#define TEST(name) static void name(void)
#define RUN(name) (check_case = #name, name())
#define TEST_MAIN(...)                                                                                                 \
    int main(void)                                                                                                     \
    {                                                                                                                  \
        (void)(__VA_ARGS__);                                                                                           \
        printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);                                     \
        return check_failed != 0;                                                                                      \
    }

static inline int check_note(int passed, const char *file, int line, const char *what)
{
    check_count++;
    if (!passed) {
        check_failed++;
        printf("%s:%d: in %s: %s", file, line, check_case, what);
    }
    return passed;
}

#define CHECK(condition) (check_note((condition) != 0, __FILE__, __LINE__, #condition) ? 1 : (printf(" is false\n"), 0))

/* |a - b| <= tolerance; false for NaN. */
#define CHECK_NEAR(a, b, tolerance) check_near((a), (b), (tolerance), __FILE__, __LINE__, #a " near " #b)
/* |a - b| <= tolerance * |b| */
#define CHECK_REL(a, b, tolerance) check_near((a), (b), fabs(b) * (tolerance), __FILE__, __LINE__, #a " near " #b)
#define CHECK_INT(a, b) check_int((long long)(a), (long long)(b), __FILE__, __LINE__, #a " == " #b)
#define CHECK_TEXT(a, b) check_text((a), (b), __FILE__, __LINE__, #a)
/* `text` contains `part`. */
#define CHECK_CONTAINS(text, part) check_contains((text), (part), __FILE__, __LINE__, #text)

static inline int check_near(double a, double b, double tolerance, const char *file, int line, const char *what)
{
    int ok = check_note(fabs(a - b) <= tolerance, file, line, what);
    if (!ok)
        printf(": %.17g and %.17g differ by %.3g, allowed %.3g\n", a, b, a - b, tolerance);
    return ok;
}

static inline int check_int(long long a, long long b, const char *file, int line, const char *what)
{
    int ok = check_note(a == b, file, line, what);
    if (!ok)
        printf(": %lld and %lld\n", a, b);
    return ok;
}

static inline int check_text(const char *a, const char *b, const char *file, int line, const char *what)
{
    int ok = check_note(a && b && strcmp(a, b) == 0, file, line, what);
    if (!ok)
        printf(": '%s' and '%s'\n", a ? a : "(null)", b ? b : "(null)");
    return ok;
}

static inline int check_contains(const char *text, const char *part, const char *file, int line, const char *what)
{
    int ok = check_note(text && strstr(text, part), file, line, what);
    if (!ok)
        printf(": '%s' does not contain '%s'\n", text ? text : "(null)", part);
    return ok;
}

/* A small seeded generator for property tests (xorshift64*), uniform in [0, 1). */
static inline double check_random(uint64_t *state)
{
    uint64_t x = *state ? *state : 88172645463325252u;
    x ^= x >> 12;
    x ^= x << 25;
    x ^= x >> 27;
    *state = x;
    return (double)((x * 2685821657736338717u) >> 11) * 0x1p-53;
}

/* Of a number of cases how many are tried: all, or one in TALUS_TEST_SHARE. "./bootstrap test" tries one in ten, with --full one
 * in four (with sanitizers one in twenty), and "./bootstrap soak" all. */
static inline int check_cases(int count)
{
    const char *share = getenv("TALUS_TEST_SHARE");
    int by = share ? atoi(share) : 1, some = by > 1 ? count / by : count;
    return some > 0 ? some : 1;
}

/* How many cases random draws are to give at the least, where all of them give `count`. Of fewer than one draw in ten
 * they are so few that chance counts: two standard deviations less, 2 sqrt(n). */
static inline int check_least(int count)
{
    int some = check_cases(count), fewer = 0;
    while (some < count / 10 && (fewer + 1) * (fewer + 1) <= 4 * some)
        fewer++;
    return some > fewer ? some - fewer : 0;
}

/* Whether case i is one of them. */
static inline int check_takes(size_t i)
{
    return i % (size_t)(1000 / check_cases(1000)) == 0;
}

#endif
