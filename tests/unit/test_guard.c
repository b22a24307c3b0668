/* test_guard.c - which requests the screen "browser" takes for its own page's. */
#include "guard.h"

#include "check.h"

TEST(only_the_loopbacks_names_are_hosts)
{
    static const char *const own[] = {"127.0.0.1", "127.0.0.1:1",    "127.0.0.1:65535",
                                      "localhost", "localhost:8080", "LocalHost:80"};
    static const char *const foreign[] = {"",
                                          ":80",
                                          "127.0.0.1:",
                                          "127.0.0.1:80x",
                                          "127.0.0.1:800000",
                                          "127.0.0.1.evil.example:80",
                                          "127.0.0.10:80",
                                          "127.0.0.2:80",
                                          "localhost.evil.example",
                                          "localhost:80:80",
                                          "localhost:-1",
                                          "evil.example",
                                          "evil.example:80",
                                          "0.0.0.0:80",
                                          "[::1]:80",
                                          "localhos",
                                          " localhost",
                                          "user@localhost:80",
                                          "localhost@evil.example"};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (!CHECK(host_is_local(own[i])))
            printf("  %s\n", own[i]);
    for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++)
        if (!CHECK(!host_is_local(foreign[i])))
            printf("  %s\n", foreign[i]);
    CHECK(!host_is_local(NULL));
}

TEST(an_origin_that_is_sent_is_the_hosts)
{
    static const char host[] = "127.0.0.1:8080";
    CHECK(origin_is_own(host, NULL, NULL));
    CHECK(origin_is_own(host, "http://127.0.0.1:8080", NULL));
    CHECK(origin_is_own(host, NULL, "none"));
    CHECK(origin_is_own(host, "http://127.0.0.1:8080", "same-origin"));
    CHECK(!origin_is_own(host, "http://127.0.0.1:8081", NULL));
    CHECK(!origin_is_own(host, "http://localhost:8080", NULL));
    CHECK(!origin_is_own(host, "https://127.0.0.1:8080", NULL));
    CHECK(!origin_is_own(host, "http://evil.example", NULL));
    CHECK(!origin_is_own(host, "http://127.0.0.1:8080/", NULL));
    CHECK(!origin_is_own(host, "http://", NULL));
    CHECK(!origin_is_own(host, "null", NULL));
    CHECK(!origin_is_own(host, "", NULL));
    CHECK(!origin_is_own(host, NULL, "same-site"));
    CHECK(!origin_is_own(host, NULL, "cross-site"));
    CHECK(!origin_is_own(host, NULL, ""));
    CHECK(!origin_is_own(host, "http://127.0.0.1:8080", "cross-site"));
}

TEST(tokens_are_drawn_and_compared)
{
    char token[TOKEN_TEXT], other[TOKEN_TEXT];
    CHECK(token_draw(token) && token_draw(other));
    CHECK_INT(strlen(token), TOKEN_TEXT - 1);
    CHECK_INT(strspn(token, "0123456789abcdef"), TOKEN_TEXT - 1);
    CHECK(strcmp(token, other) != 0);
    CHECK(token_is(token, token));
    CHECK(!token_is(other, token));
    CHECK(!token_is(NULL, token));
    CHECK(!token_is("", token));
    for (size_t i = 0; i < TOKEN_TEXT - 1; i++) {
        char wrong[TOKEN_TEXT];
        memcpy(wrong, token, sizeof wrong);
        wrong[i] = wrong[i] == '0' ? '1' : '0';
        CHECK(!token_is(wrong, token));
        wrong[i] = '\0'; /* shorter */
        CHECK(!token_is(wrong, token));
    }
    char longer[TOKEN_TEXT + 1];
    snprintf(longer, sizeof longer, "%s0", token);
    CHECK(!token_is(longer, token));
}

TEST_MAIN(RUN(only_the_loopbacks_names_are_hosts), RUN(an_origin_that_is_sent_is_the_hosts),
          RUN(tokens_are_drawn_and_compared))
