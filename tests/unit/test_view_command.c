/* test_view_command.c - commands of those who look: what each takes, and the sentence that refuses what is none. */
#include "check.h"

#include <talus/talus.h>

static tl_view_command command;
static char why[256];

static int read_text(const char *text)
{
    strcpy(why, "");
    return tl_view_command_read(text, strlen(text), &command, why, sizeof why);
}

static void refused(const char *text, const char *sentence)
{
    CHECK(!read_text(text));
    if (!CHECK_CONTAINS(why, sentence))
        printf("  of %s\n", text);
}

TEST(each_command_takes_what_it_needs)
{
    CHECK(read_text("{\"op\":\"pause\"}"));
    CHECK_INT(command.op, TL_VIEW_PAUSE);
    CHECK(read_text(" { \"op\" : \"go\" } \n"));
    CHECK_INT(command.op, TL_VIEW_GO);
    CHECK(read_text("{\"n\": 1e3, \"op\": \"step\"}"));
    CHECK_INT(command.op, TL_VIEW_STEP);
    CHECK_INT(command.steps, 1000);
    CHECK(read_text("{\"op\":\"delete\",\"blocks\":[3, 4294967295]}"));
    CHECK_INT(command.block_count, 2);
    CHECK_INT(command.blocks[0], 3);
    CHECK_INT(command.blocks[1], 4294967295u);
    CHECK(read_text("{\"op\":\"show\"}"));
    CHECK_INT(command.block_count, 0);
    CHECK(read_text("{\"op\":\"friction\",\"joint\":\"J1:3\",\"value\":32.5}"));
    CHECK_TEXT(command.joint, "J1:3");
    CHECK(command.value == 32.5);
    CHECK(read_text("{\"op\":\"cut\",\"joint\":\"new\",\"dip\":60,\"dip_direction\":90.25,"
                    "\"origin\":[1.5,-2e-3,1e300]}"));
    CHECK(command.dip == 60 && command.dip_direction == 90.25);
    CHECK(command.origin.x == 1.5 && command.origin.y == -2e-3 && command.origin.z == 1e300);
    for (int op = 0; op <= TL_VIEW_SAFETY; op++) {
        char text[64];
        snprintf(text, sizeof text, "{\"op\":\"%s\"}", tl_view_op_name((tl_view_op)op));
        CHECK(read_text(text) ? command.op == (tl_view_op)op : strstr(why, "needs") != NULL);
    }
}

TEST(texts_are_those_of_json)
{
    CHECK(read_text("{\"op\":\"friction\",\"value\":1,\"joint\":\"a\\\"b\\\\c\\/"
                    "\\n\\u00e4\\u20ac\\ud83d\\ude00\"}"));
    CHECK_TEXT(command.joint, "a\"b\\c/\n\xc3\xa4\xe2\x82\xac\xf0\x9f\x98\x80");
    CHECK(read_text("{\"op\":\"friction\",\"value\":1,\"joint\":\"\xc3\xa4\"}"));
    CHECK_TEXT(command.joint, "\xc3\xa4");
    refused("{\"op\":\"friction\",\"value\":1,\"joint\":\"\\u0000\"}", "zero byte");
    refused("{\"op\":\"friction\",\"value\":1,\"joint\":\"\\ud83d\"}", "half a character");
    refused("{\"op\":\"friction\",\"value\":1,\"joint\":\"\\ud83d\\u0041\"}", "half a character");
    refused("{\"op\":\"friction\",\"value\":1,\"joint\":\"\\x\"}", "bad \\");
    refused("{\"op\":\"friction\",\"value\":1,\"joint\":\"a\nb\"}", "joint has no end");
    refused("{\"op\":\"friction\",\"value\":1,\"joint\":\"\"}", "joint must be the name");
    refused("{\"op\":\"friction\",\"value\":1,\"joint\":\"a\xff\"}", "joint is no UTF-8");
    refused("{\"op\":\"friction\",\"value\":1,\"joint\":\"\xe6\x96\"}", "joint is no UTF-8");
    refused("{\"op\":\"friction\",\"value\":1,\"joint\":\"\xc0\x80\"}", "joint is no UTF-8");
    refused("{\"op\":\"friction\",\"value\":1,\"joint\":\"\xed\xa0\x80\"}", "joint is no UTF-8");
}

TEST(what_is_no_command_is_refused)
{
    refused("", "'{' is missing");
    refused("pause", "'{' is missing");
    refused("{}", "a name must be a text");
    refused("{\"op\":\"pause\"", "'}' is missing");
    refused("{\"op\":\"pause\"}{", "something follows");
    refused("{\"op\":\"pause\",}", "a name must be a text");
    refused("{\"op\":\"explode\"}", "there is no command 'explode'");
    refused("{\"op\":\"pause\",\"op\":\"go\"}", "'op' is there twice");
    refused("{\"n\":3}", "needs 'op'");
    refused("{\"op\":\"pause\",\"n\":3}", "pause takes no 'n'");
    refused("{\"op\":\"pause\",\"path\":\"/etc\"}", "has no 'path'");
    refused("{\"op\":\"step\"}", "step needs 'n'");
    refused("{\"op\":\"step\",\"n\":0}", "n = 0 must be a whole number in [1, 1000000000]");
    refused("{\"op\":\"step\",\"n\":1.5}", "n = 1.5 must be a whole number");
    refused("{\"op\":\"step\",\"n\":\"3\"}", "n must be a number");
    refused("{\"op\":\"step\",\"n\":1e999}", "too large");
    refused("{\"op\":\"delete\"}", "delete needs 'blocks'");
    refused("{\"op\":\"delete\",\"blocks\":[]}", "blocks must be a list");
    refused("{\"op\":\"delete\",\"blocks\":3}", "blocks must be a list");
    refused("{\"op\":\"delete\",\"blocks\":[0]}", "a block's id = 0 must be");
    refused("{\"op\":\"delete\",\"blocks\":[3,]}", "a block's id must be a number");
    refused("{\"op\":\"delete\",\"blocks\":[3 4]}", "']' is missing");
    refused("{\"op\":\"cut\",\"joint\":\"J\",\"dip\":91,\"dip_direction\":0,\"origin\":[0,0,0]}",
            "dip = 91 must be in [0, 90]");
    refused("{\"op\":\"cut\",\"joint\":\"J\",\"dip\":9,\"dip_direction\":-1,\"origin\":[0,0,0]}",
            "dip_direction = -1 must be in [0, 360]");
    refused("{\"op\":\"cut\",\"joint\":\"J\",\"dip\":9,\"dip_direction\":1,\"origin\":[0,0]}", "',' is missing");
    refused("{\"op\":\"cut\",\"joint\":\"J\",\"dip\":nan,\"dip_direction\":1,\"origin\":[0,0,0]}",
            "dip must be a number");
    refused("{\"op\":\"an op that is much too long\"}", "op is longer than 23 bytes");
}

/* Anything gives a command of the list or a sentence, and reads no byte behind the end: the sanitizers look on. */
TEST(random_texts_are_read_to_their_end)
{
    static const char *const parts[] = {"{",  "}",     "[",      "]",        ",",         ":",          "\"",
                                        "\\", "\\u12", "\"op\"", "\"step\"", "\"n\"",     "\"blocks\"", "1",
                                        "-",  "e9",    ".5",     " ",        "\"joint\"", "\"cut\"",    "\xff"};
    uint64_t seed = 7;
    int taken = 0;
    for (int i = 0; i < 20000; i++) {
        char text[256];
        size_t length = 0, count = (size_t)(12 * check_random(&seed));
        for (size_t k = 0; k < count; k++) {
            const char *part = parts[(size_t)(sizeof parts / sizeof parts[0] * check_random(&seed))];
            memcpy(text + length, part, strlen(part));
            length += strlen(part);
        }
        char *exact = malloc(length + 1);
        memcpy(exact, text, length);
        exact = realloc(exact, length ? length : 1);
        strcpy(why, "");
        int good = tl_view_command_read(exact, length, &command, why, sizeof why);
        taken += good;
        CHECK(good == (why[0] == '\0'));
        free(exact);
    }
    CHECK(taken < 20000);
}

TEST_MAIN(RUN(each_command_takes_what_it_needs), RUN(texts_are_those_of_json), RUN(what_is_no_command_is_refused),
          RUN(random_texts_are_read_to_their_end))
