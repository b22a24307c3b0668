/* read_poly.c - blocks of a data file of 3DEC that are given by their faces:
 *
 *     block create group "Arch" polyhedron face 5.5,0,0 5.5,0.5,0 5,0.5,0 face ...
 *     poly reg 2 face 0 0 0  0 1 0  1 0 0 &
 *          face 0 0 0  1 0 0  0 0 1
 *
 * A command goes on in the next line after & or "...", and ends at a semicolon. Words may be cut to four letters. The
 * coordinates are apart by spaces, commas or brackets. Each command is an object, with its group and, as its name, its
 * number. Other commands are counted and left aside. */
#include "text.h"

#include <string.h>
#include <talus/kit.h>

typedef struct reader {
    soup *s;
    text_line l;
    size_t blocks, corners;
    uint32_t corner[MOST_SIDES];
    const char *group;
} reader;

/* Whether a word, without the case of its letters, is `whole` cut to `least` letters or more. */
static bool short_for(const char *word, const char *whole, size_t least)
{
    size_t length = strlen(word);
    if (length < least || length > strlen(whole))
        return false;
    for (size_t i = 0; i < length; i++)
        if (text_small(word[i]) != whole[i])
            return false;
    return true;
}

/* Cuts the line off at its comment, and makes spaces of commas, brackets and '=', outside quotes. */
static void blank_line(char *at)
{
    char quote = 0;
    for (; *at; at++) {
        if (quote) {
            quote = *at == quote ? 0 : quote;
            continue;
        }
        if (*at == '"' || *at == '\'')
            quote = *at;
        else if (*at == ';') {
            *at = '\0';
            return;
        } else if (strchr(",()=", *at))
            *at = ' ';
    }
}

/* Takes a word, or what stands between quotes. */
static char *take(text_line *l)
{
    while (text_space(*l->rest))
        l->rest++;
    char quote = *l->rest;
    if (quote != '"' && quote != '\'')
        return line_take(l);
    char *word = ++l->rest;
    while (*l->rest && *l->rest != quote)
        l->rest++;
    if (*l->rest)
        *l->rest++ = '\0';
    return word;
}

static tl_status end_face(reader *r)
{
    if (r->corners < 3)
        return SOUP_FAULT(r->s, ", line %zu: a face of %zu corners; it must have 3 or more", r->l.number, r->corners);
    tl_status status = soup_face(r->s, r->corner, r->corners);
    r->corners = 0;
    return status;
}

static bool begins_number(const char *word)
{
    return (*word >= '0' && *word <= '9') || *word == '-' || *word == '+' || *word == '.';
}

static tl_status read_corner(reader *r, const char *word)
{
    double at[3];
    for (int i = 0; i < 3; i++) {
        if (!word)
            return SOUP_FAULT(r->s, ", line %zu: a corner has %d coordinates, not 3; go on with & at the line's end",
                              r->l.number, i);
        tl_status status = text_number(r->s, word, r->l.number, &at[i]);
        if (status != TL_OK)
            return status;
        word = i < 2 ? line_take(&r->l) : NULL;
    }
    if (r->corners == MOST_SIDES)
        return SOUP_FAULT(r->s, ", line %zu: a face has more than %d corners", r->l.number, MOST_SIDES);
    r->corner[r->corners++] = (uint32_t)r->s->vertices;
    return soup_vertex(r->s, (tl_vec3){at[0], at[1], at[2]}, "line", r->l.number);
}

/* The words of a block from its first face on; then regions, materials and the like. */
static tl_status read_faces(reader *r)
{
    char name[32];
    bool face = true;
    tl_text_print(name, sizeof name, "%zu", ++r->blocks);
    tl_status status = soup_object(r->s, name, strlen(name), r->group, r->group ? strlen(r->group) : 0);
    for (char *word; status == TL_OK && (word = take(&r->l)) != NULL;) {
        if (short_for(word, "face", 4)) {
            status = face ? end_face(r) : TL_OK;
            face = true;
        } else if (begins_number(word)) {
            if (face)
                status = read_corner(r, word);
        } else {
            status = face ? end_face(r) : TL_OK;
            face = false;
            if (short_for(word, "group", 4) && status == TL_OK && (word = take(&r->l)) != NULL)
                status = soup_group(r->s, word, strlen(word));
        }
    }
    return status == TL_OK && face ? end_face(r) : status;
}

/* A command; what is no block by faces is counted. */
static tl_status read_command(reader *r)
{
    bool polyhedron = short_for(r->l.word, "polyhedron", 4);
    r->group = NULL;
    for (char *word; (word = take(&r->l)) != NULL;) {
        if (short_for(word, "polyhedron", 4))
            polyhedron = true;
        else if (short_for(word, "group", 4))
            r->group = take(&r->l);
        else if (polyhedron && short_for(word, "face", 4))
            return read_faces(r);
    }
    r->s->unread++;
    return TL_OK;
}

/* Goes to the next command; its line ends in & or "..." where it goes on. */
static bool next_command(text_line *l)
{
    while (*l->next) {
        char *begin = l->next;
        size_t length = strcspn(begin, "\n");
        bool more = true;
        l->number++;
        for (char *from = begin; more;) {
            char *end = from + length, kept = *end;
            *end = '\0';
            blank_line(from);
            size_t used = strlen(from);
            while (used > 0 && text_space(from[used - 1]))
                used--;
            size_t dots = used >= 3 && memcmp(from + used - 3, "...", 3) == 0 ? 3 : used > 0 && from[used - 1] == '&';
            more = dots > 0 && kept != '\0' && end[1] != '\0';
            memset(from + used - dots, ' ', (size_t)(end - from) - used + dots);
            l->next = kept ? end + 1 : end;
            *end = more ? ' ' : '\0';
            from = l->next;
            length = strcspn(from, "\n");
            l->number += more;
        }
        l->rest = begin;
        l->word = take(l);
        if (l->word)
            return true;
    }
    return false;
}

tl_status read_poly(soup *s, char *text, size_t count)
{
    reader *r = calloc(1, sizeof *r);
    if (!r)
        return soup_no_memory(s);
    r->s = s;
    r->l.next = text;
    tl_status status = text_check(s, text, count);
    while (status == TL_OK && next_command(&r->l))
        status = read_command(r);
    free(r);
    return status;
}
