/* talus/check.h - the conformance check of plugins, which `talus check FILE.so` runs.
 *
 * Each law, damping and generator of the file is tried with several sets of parameters: its defaults, the values given,
 * and drawn ones within the ranges it declares. A screen is tried with its defaults and the values given.
 * docs/writing_a_plugin.md says what each check asks. */
#ifndef TALUS_CHECK_H
#define TALUS_CHECK_H

#include <talus/plugins.h>
#include <talus/values.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What one check found. */
typedef struct tl_check_finding {
    const tl_kind *kind;
    const char *check; /* "one by one" */
    const char *doc;   /* what it asks, in one sentence */
    const char *fault; /* what was found instead, and with which parameters; NULL when it holds */
} tl_check_finding;

typedef void (*tl_check_fn)(void *user, const tl_check_finding *finding);

/* Loads the file and checks all its kinds; `tell` hears of each check in turn. `args`, which may be NULL, are values of
 * parameters of any of the kinds. `*faults` is the number of checks that found something. Fails when the file is no
 * plugin, or nothing can be tried with its parameters. */
TL_API tl_status tl_plugin_check(const char *path, const tl_args *args, tl_check_fn tell, void *user, size_t *faults,
                                 tl_error *error);

#ifdef __cplusplus
}
#endif
#endif
