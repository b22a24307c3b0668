/* text_screen.c - a screen with a text among its parameters, which lives only as long as the call that gives it. */
#include "plain_screen.h"

typedef struct text_params {
    const char *name;
} text_params;

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_STRING, text_params, name, "", "some name", .flags = TL_PARAM_OPTIONAL),
};

PLAIN_SCREEN("text_screen", take, TL_KIND_PARAMS(text_params, param_table));
