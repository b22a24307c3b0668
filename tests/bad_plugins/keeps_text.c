/* keeps_text.c - a law with a text among its parameters, which lives only as long as the call that gives it. */
#include "plain.h"

typedef struct text_params {
    const char *name;
} text_params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, text_params, name, "", "some name", .flags = TL_PARAM_OPTIONAL),
};
static const tl_law_ops ops = PLAIN_OPS;
static const tl_kind kind = PLAIN_KIND("keeps_text", TL_KIND_PARAMS(text_params, param_table));

PLAIN_PLUGIN("bad.keeps_text");
