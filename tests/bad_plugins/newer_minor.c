/* newer_minor.c - claims a newer minor version, yet its structs have shrunk. */
#include "plain.h"

static const tl_param param_table[] = {PLAIN_VALUE};
static const tl_law_ops ops = {.size = sizeof ops - sizeof(void *), .update = update, .stiffness = stiffness};
static const tl_kind kind = PLAIN_KIND("newer_minor", TL_KIND_PARAMS(params, param_table));

PLAIN_PLUGIN_CLAIMS(sizeof(tl_plugin), TL_ABI_MAJOR, TL_ABI_MINOR + 1, "bad.newer_minor");
