/* scene_finding.c - FIND: how the model stands, as JSON. */
#include "io/json.h"
#include "io/scene_parts.h"

static void put_number(tl_piece *to, const char *name, double value)
{
    tl_json_put(to, ", \"");
    tl_json_put(to, name);
    tl_json_put(to, "\": ");
    tl_json_number(to, value);
}

void tl_scene_finding(const tl_verdict *v, const char *hash, tl_piece *text)
{
    char sentence[512];
    tl_verdict_text(v, sentence, sizeof sentence);
    tl_json_put(text, "{\"standing\": ");
    tl_json_text(text, tl_standing_name(v->standing));
    tl_json_put(text, ", \"text\": ");
    tl_json_text(text, sentence);
    tl_json_put(text, ", \"stage\": ");
    tl_json_text(text, v->stage);
    put_number(text, "closed", v->closed);
    put_number(text, "moved", (double)v->moved);
    put_number(text, "contacts", (double)v->contacts);
    put_number(text, "slipping", (double)v->slipping);
    if (hash) {
        tl_json_put(text, ", \"hash\": ");
        tl_json_text(text, hash);
    }
    tl_json_put(text, "}");
}
