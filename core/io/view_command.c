/* view_command.c - reads the commands of those who look at a model (talus/view.h): one JSON object each.
 *
 * What comes from outside is never trusted. A command is one of a list, with numbers, ids and the name of a joint.
 * Nothing that is not asked for is taken. Objects have no objects in them, so no reader for all of JSON is needed. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>
#include <talus/text.h>
#include <talus/view.h>

/* Limit: steps that one command may ask for. */
#define MOST_STEPS 1000000000.0
/* Bytes of a key or of a command's name. */
#define KEY 24
/* Bytes of a number. */
#define NUMBER 64

/* What an op asks for, as bits. */
enum {
    STEPS = 1,
    BLOCKS = 2,
    JOINT = 4,
    VALUE = 8,
    DIP = 16,
    DIRECTION = 32,
    ORIGIN = 64,
    ANY_BLOCKS = 128, /* blocks may be left out */
    OP = 256          /* "op" itself */
};

static const struct {
    const char *name;
    unsigned asks;
} ops[] = {
    [TL_VIEW_PAUSE] = {"pause", 0},
    [TL_VIEW_GO] = {"go", 0},
    [TL_VIEW_STEP] = {"step", STEPS},
    [TL_VIEW_HIDE] = {"hide", BLOCKS},
    [TL_VIEW_SHOW] = {"show", BLOCKS | ANY_BLOCKS},
    [TL_VIEW_FIX] = {"fix", BLOCKS},
    [TL_VIEW_FREE] = {"free", BLOCKS},
    [TL_VIEW_DELETE] = {"delete", BLOCKS},
    [TL_VIEW_JOIN] = {"join", BLOCKS},
    [TL_VIEW_UNJOIN] = {"unjoin", BLOCKS},
    [TL_VIEW_CUT] = {"cut", JOINT | DIP | DIRECTION | ORIGIN},
    [TL_VIEW_FRICTION] = {"friction", JOINT | VALUE},
    [TL_VIEW_VTK] = {"write_vtk", 0},
    [TL_VIEW_SNAPSHOT] = {"snapshot", 0},
    [TL_VIEW_SAFETY] = {"factor_of_safety", 0},
};
#define OPS (sizeof ops / sizeof ops[0])

static const struct {
    const char *name;
    unsigned bit;
} members[] = {{"n", STEPS}, {"blocks", BLOCKS},           {"joint", JOINT},  {"value", VALUE},
               {"dip", DIP}, {"dip_direction", DIRECTION}, {"origin", ORIGIN}};
#define MEMBERS (sizeof members / sizeof members[0])

const char *tl_view_op_name(tl_view_op op)
{
    return ops[op].name;
}

typedef struct reader {
    const char *at, *end;
    char *why;
    size_t size;
} reader;

__attribute__((format(printf, 2, 3))) static bool refuse(reader *r, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    tl_text_vprint(r->why, r->size, format, list);
    va_end(list);
    return false;
}

/* ---------------------------------------------------------------- JSON ------------------- */

static void skip_spaces(reader *r)
{
    while (r->at < r->end && strchr(" \t\r\n", *r->at) && *r->at)
        r->at++;
}

/* Takes a letter, if it is the next after spaces. */
static bool take(reader *r, char letter)
{
    skip_spaces(r);
    if (r->at == r->end || *r->at != letter)
        return false;
    r->at++;
    return true;
}

static bool expect(reader *r, char letter)
{
    return take(r, letter) || refuse(r, "the command is no JSON object: '%c' is missing", letter);
}

/* The four hexadecimal digits of an escape. */
static bool read_hex(reader *r, unsigned *code)
{
    *code = 0;
    for (int i = 0; i < 4; i++) {
        const char *digits = "0123456789abcdef", *found = NULL;
        if (r->at < r->end && *r->at)
            found = strchr(digits, *r->at >= 'A' && *r->at <= 'F' ? *r->at - 'A' + 'a' : *r->at);
        if (!found)
            return refuse(r, "the command has a bad \\u in a text");
        *code = *code << 4 | (unsigned)(found - digits);
        r->at++;
    }
    return true;
}

/* Puts a character of the plane in UTF-8. */
static size_t put_utf8(unsigned code, char out[4])
{
    if (code < 0x80) {
        out[0] = (char)code;
        return 1;
    }
    size_t length = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    for (size_t i = length - 1; i > 0; i--, code >>= 6)
        out[i] = (char)(0x80 | (code & 0x3f));
    out[0] = (char)((0xf00 >> length & 0xff) | code);
    return length;
}

/* After a backslash. */
static bool read_escape(reader *r, unsigned *code)
{
    static const char letters[] = "\"\\/bfnrt", meant[] = "\"\\/\b\f\n\r\t";
    char letter = r->at < r->end ? *r->at++ : '\0';
    const char *found = letter ? strchr(letters, letter) : NULL;
    *code = found ? (unsigned char)meant[found - letters] : 0;
    if (found)
        return true;
    if (letter != 'u')
        return refuse(r, "the command has a bad \\ in a text");
    unsigned low;
    if (!read_hex(r, code))
        return false;
    if (*code < 0xd800 || *code > 0xdfff)
        return true;
    if (*code > 0xdbff || r->end - r->at < 6 || r->at[0] != '\\' || r->at[1] != 'u')
        return refuse(r, "the command has half a character in a text");
    r->at += 2;
    if (!read_hex(r, &low))
        return false;
    if (low < 0xdc00 || low > 0xdfff)
        return refuse(r, "the command has half a character in a text");
    *code = 0x10000 + ((*code - 0xd800) << 10) + (low - 0xdc00);
    return true;
}

/* Reads a character of a text, as bytes. */
static bool read_character(reader *r, const char *what, char bytes[4], size_t *count)
{
    unsigned code;
    bytes[0] = *r->at++;
    *count = 1;
    if (bytes[0] != '\\')
        return true;
    if (!read_escape(r, &code))
        return false;
    *count = put_utf8(code, bytes);
    return code != 0 || refuse(r, "%s has a zero byte in it", what);
}

static bool read_text(reader *r, const char *what, char *out, size_t capacity)
{
    size_t length = 0;
    if (!take(r, '"'))
        return refuse(r, "%s must be a text in quotes", what);
    for (;;) {
        char bytes[4];
        size_t count;
        if (r->at == r->end || (unsigned char)*r->at < ' ')
            return refuse(r, "%s has no end", what);
        if (*r->at == '"')
            break;
        if (!read_character(r, what, bytes, &count))
            return false;
        if (length + count >= capacity)
            return refuse(r, "%s is longer than %zu bytes", what, capacity - 1);
        memcpy(out + length, bytes, count);
        length += count;
    }
    r->at++;
    out[length] = '\0';
    return tl_text_is_utf8(out) || refuse(r, "%s is no UTF-8", what);
}

static bool read_number(reader *r, const char *what, double *out)
{
    char text[NUMBER];
    const char *end;
    size_t length = 0;
    skip_spaces(r);
    while (r->at + length < r->end && length < NUMBER - 1 && r->at[length] && strchr("+-.eE0123456789", r->at[length]))
        length++;
    memcpy(text, r->at, length);
    text[length] = '\0';
    *out = tl_number_read(text, &end);
    if (length == 0 || *end)
        return refuse(r, "%s must be a number", what);
    r->at += length;
    return isfinite(*out) || refuse(r, "%s is too large", what);
}

/* A number that is whole, of a range. */
static bool read_whole(reader *r, const char *what, double least, double most, double *out)
{
    if (!read_number(r, what, out))
        return false;
    if (*out >= least && *out <= most && floor(*out) >= *out)
        return true;
    return refuse(r, "%s = %g must be a whole number in [%.0f, %.0f]", what, *out, least, most);
}

/* ---------------------------------------------------------------- members ---------------- */

static bool read_blocks(reader *r, tl_view_command *command)
{
    bool more = take(r, '[') && !take(r, ']');
    command->block_count = 0;
    while (more) {
        double id;
        if (command->block_count == TL_VIEW_BLOCKS)
            return refuse(r, "blocks has more than %d ids", TL_VIEW_BLOCKS);
        if (!read_whole(r, "a block's id", 1, UINT32_MAX, &id))
            return false;
        command->blocks[command->block_count++] = (tl_id)id;
        more = take(r, ',');
        if (!more && !expect(r, ']'))
            return false;
    }
    return command->block_count > 0 || refuse(r, "blocks must be a list of block ids");
}

static bool read_origin(reader *r, tl_vec3 *origin)
{
    static const char between[] = "[,,";
    double place[3];
    for (int i = 0; i < 3; i++)
        if (!expect(r, between[i]) || !read_number(r, "a number of origin", &place[i]))
            return false;
    *origin = (tl_vec3){place[0], place[1], place[2]};
    return expect(r, ']');
}

static bool read_degrees(reader *r, const char *what, double most, double *out)
{
    if (!read_number(r, what, out))
        return false;
    return (*out >= 0 && *out <= most) || refuse(r, "%s = %g must be in [0, %g] degrees", what, *out, most);
}

static bool read_op(reader *r, tl_view_command *command)
{
    char name[KEY];
    if (!read_text(r, "op", name, sizeof name))
        return false;
    for (size_t i = 0; i < OPS; i++) {
        if (strcmp(ops[i].name, name) == 0) {
            command->op = (tl_view_op)i;
            return true;
        }
    }
    return refuse(r, "there is no command '%s'", name);
}

static bool read_member(reader *r, unsigned member, tl_view_command *command)
{
    double steps;
    switch (member) {
    case STEPS:
        if (!read_whole(r, "n", 1, MOST_STEPS, &steps))
            return false;
        command->steps = (int64_t)steps;
        return true;
    case BLOCKS: return read_blocks(r, command);
    case JOINT:
        return read_text(r, "joint", command->joint, sizeof command->joint) &&
               (command->joint[0] || refuse(r, "joint must be the name of a joint"));
    case VALUE: return read_number(r, "value", &command->value);
    case DIP: return read_degrees(r, "dip", 90, &command->dip);
    case DIRECTION: return read_degrees(r, "dip_direction", 360, &command->dip_direction);
    default: return read_origin(r, &command->origin);
    }
}

/* Reads a member of the object; its bit joins `given`. */
static bool read_next(reader *r, tl_view_command *command, unsigned *given)
{
    char key[KEY];
    unsigned bit = 0;
    if (!read_text(r, "a name", key, sizeof key) || !expect(r, ':'))
        return false;
    if (strcmp(key, "op") == 0)
        bit = OP;
    for (size_t i = 0; i < MEMBERS && !bit; i++)
        if (strcmp(members[i].name, key) == 0)
            bit = members[i].bit;
    if (!bit)
        return refuse(r, "a command has no '%s'", key);
    if (*given & bit)
        return refuse(r, "'%s' is there twice", key);
    *given |= bit;
    return bit == OP ? read_op(r, command) : read_member(r, bit, command);
}

/* Whether all that the op asks for was given, and no more. */
static bool check_members(reader *r, tl_view_op op, unsigned given)
{
    unsigned asks = ops[op].asks;
    for (size_t i = 0; i < MEMBERS; i++) {
        unsigned bit = members[i].bit;
        if (given & bit & ~asks)
            return refuse(r, "%s takes no '%s'", ops[op].name, members[i].name);
        if (asks & ~given & bit && !(bit == BLOCKS && asks & ANY_BLOCKS))
            return refuse(r, "%s needs '%s'", ops[op].name, members[i].name);
    }
    return true;
}

int tl_view_command_read(const char *text, size_t length, tl_view_command *command, char *why, size_t size)
{
    reader r = {text, text + length, why, size};
    unsigned given = 0;
    *command = (tl_view_command){.op = TL_VIEW_PAUSE};
    bool more = expect(&r, '{');
    if (!more)
        return 0;
    while (more) {
        if (!read_next(&r, command, &given))
            return 0;
        more = take(&r, ',');
    }
    if (!expect(&r, '}'))
        return 0;
    skip_spaces(&r);
    if (r.at != r.end)
        return refuse(&r, "something follows the command");
    if (!(given & OP))
        return refuse(&r, "a command needs 'op'");
    return check_members(&r, command->op, given);
}
