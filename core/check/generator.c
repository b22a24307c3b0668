/* generator.c - the conformance check of generators.
 *
 * A generator is run on a cube of 10 m, or in an empty model where it does not work on that. Each call of a service
 * that can fail goes through a function here, which counts it and can let it fail. */
#include "check/generator.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Calls that are let fail, one in each run: the first ones, and then ever fewer. */
#define FIRST_CALLS 40

enum { REPEATS, KEEPS, PASSES_ON };

static const tl_check_rule rules[] = {
    [REPEATS] = {"repeats", "the same parameters and seed give the same model"},
    [KEEPS] = {"parameters", "parameters are not written to"},
    [PASSES_ON] = {"failures", "a failure of a service is passed on at once"},
    {NULL, NULL},
};

/* What one run is to do and has done. */
typedef struct watch {
    const tl_host *host;
    const tl_generator_ops *ops;
    size_t params_size;
    bool prepare;   /* make the cube, and nothing else */
    size_t fail_at; /* let this call fail, counted from 1; 0: none */
    size_t calls;   /* of services that can fail */
    size_t after;   /* calls after the one that failed */
    bool wrote;     /* to its parameters */
} watch;

/* The generator being watched by this thread, for functions that have no other way to know. */
static _Thread_local watch *current;

/* Counts a call; not TL_OK when it is to fail. */
static tl_status count(void)
{
    watch *w = current;
    w->after += w->fail_at > 0 && w->calls >= w->fail_at;
    if (++w->calls == w->fail_at)
        return w->host->fail(w->host, TL_E_MEMORY, "let fail by the check");
    return TL_OK;
}

/* The services that can fail: name, parameters in brackets, and what is handed on. */
#define SERVICES(DO)                                                                                                   \
    DO(create_hull, (const tl_host *h, const tl_vec3 *vertices, size_t n, double density, const char *group), h,       \
       vertices, n, density, group)                                                                                    \
    DO(create_box, (const tl_host *h, tl_vec3 min, tl_vec3 max, double density, const char *group), h, min, max,       \
       density, group)                                                                                                 \
    DO(create_block, (const tl_host *h, const tl_block_shape *shape), h, shape)                                        \
    DO(create_solid, (const tl_host *h, const tl_solid_shape *shape, size_t *parts), h, shape, parts)                  \
    DO(joint, (const tl_host *h, const char *name, uint32_t *number), h, name, number)                                 \
    DO(cut, (const tl_host *h, tl_vec3 normal, tl_vec3 point, tl_tag tag, double persistence), h, normal, point, tag,  \
       persistence)                                                                                                    \
    DO(cut_disc,                                                                                                       \
       (const tl_host *h, tl_vec3 normal, tl_vec3 point, double radius, tl_tag tag, double persistence, size_t *met),  \
       h, normal, point, radius, tag, persistence, met)                                                                \
    DO(cut_polygon, (const tl_host *h, const tl_vec3 *corners, size_t n, tl_tag tag, double persistence, size_t *met), \
       h, corners, n, tag, persistence, met)                                                                           \
    DO(progress, (const tl_host *h, double fraction), h, fraction)                                                     \
    DO(meets, (const tl_host *h, size_t index, const tl_half_space *spaces, size_t n, bool *answer), h, index, spaces, \
       n, answer)                                                                                                      \
    DO(cut_block, (const tl_host *h, size_t index, tl_vec3 normal, tl_vec3 point, size_t *above), h, index, normal,    \
       point, above)                                                                                                   \
    DO(set_group, (const tl_host *h, size_t index, const char *group), h, index, group)                                \
    DO(part, (const tl_host *h, const size_t *indices, size_t n), h, indices, n)                                       \
    DO(join, (const tl_host *h, const size_t *indices, size_t n), h, indices, n)                                       \
    DO(remove, (const tl_host *h, size_t index), h, index)                                                             \
    DO(hide, (const tl_host *h, size_t index), h, index)                                                               \
    DO(show, (const tl_host *h), h)

/* Counts the call and hands it on to the host. */
#define WATCH(service, parameters, ...)                                                                                \
    static tl_status watched_##service parameters                                                                      \
    {                                                                                                                  \
        tl_status status = count();                                                                                    \
        return status != TL_OK ? status : current->host->service(__VA_ARGS__);                                         \
    }
SERVICES(WATCH)

static void say(const tl_host *h, const char *format, ...)
{
    (void)h; /* remarks are for users of the model */
    (void)format;
}

/* In the place of the generator's own function. */
static tl_status generate_watched(const tl_host *host, const void *params)
{
    watch *w = current;
    tl_host own = *host;
#define HAND_OUT(service, ...) own.service = watched_##service;
    SERVICES(HAND_OUT)
#undef HAND_OUT
    own.log = say;
    w->host = host;
    if (w->prepare)
        return host->create_box(host, tl_v3(-5, -5, -5), tl_v3(5, 5, 5), 2500, NULL);
    void *copy = malloc(w->params_size + 1);
    if (!copy)
        return host->fail(host, TL_E_MEMORY, "out of memory");
    memcpy(copy, params, w->params_size);
    tl_status status = w->ops->generate(&own, params);
    w->wrote = memcmp(copy, params, w->params_size) != 0;
    free(copy);
    return status;
}

/* ---------------------------------------------------------------- runs ------------------- */

typedef struct trial {
    tl_checker *c;
    tl_args args;
    bool cube; /* begin with a cube */
    watch w;
} trial;

static void hush(void *user, const char *text)
{
    (void)user;
    (void)text;
}

/* One run in a model of its own; the state of the model after it goes to `hash`. */
static tl_status run(trial *t, size_t fail_at, char hash[33])
{
    tl_model *m;
    tl_status status = tl_model_create(NULL, &m, t->c->error);
    if (status != TL_OK)
        return status;
    tl_model_log(m, hush, NULL);
    t->w.fail_at = t->w.calls = t->w.after = 0;
    t->w.wrote = false;
    t->w.prepare = true;
    if (t->cube)
        status = tl_generate(m, t->c->kind->name, &t->args, NULL);
    t->w.prepare = false;
    t->w.fail_at = fail_at;
    if (status == TL_OK)
        status = tl_generate(m, t->c->kind->name, &t->args, NULL);
    if (status != TL_OK)
        *t->c->error = *tl_model_error(m);
    else
        status = tl_state_hash(m, hash);
    tl_model_destroy(m);
    return status;
}

static void check_failures(trial *t, size_t calls)
{
    char hash[33];
    for (size_t at = 1; at <= calls; at += at < FIRST_CALLS ? 1 : at / 4) {
        tl_status status = run(t, at, hash);
        if (status == TL_OK)
            tl_check_note(t->c, PASSES_ON, "call %zu of a service fails, and generate() gives TL_OK", at);
        else if (t->w.after > 0)
            tl_check_note(t->c, PASSES_ON, "call %zu of a service fails, and %zu more follow", at, t->w.after);
    }
}

static tl_status run_trial(trial *t)
{
    char first[33], second[33];
    t->cube = true;
    tl_status status = run(t, 0, first);
    if (status != TL_OK) {
        t->cube = false;
        status = run(t, 0, first);
    }
    if (status != TL_OK)
        return status;
    size_t calls = t->w.calls;
    if (t->w.wrote)
        tl_check_note(t->c, KEEPS, "generate() writes to its parameters");
    status = run(t, 0, second);
    if (status != TL_OK)
        tl_check_note(t->c, REPEATS, "a second run fails: %s", t->c->error->text);
    else if (strcmp(first, second) != 0)
        tl_check_note(t->c, REPEATS, "two runs give models of the hashes %s and %s", first, second);
    check_failures(t, calls);
    return TL_OK;
}

static tl_status check_kind(tl_checker *c)
{
    trial t = {.c = c};
    tl_kind *kind = (tl_kind *)(uintptr_t)c->kind; /* the host's copy, which no other thread uses here */
    tl_generator_ops own = {.size = sizeof own, .generate = generate_watched};
    const void *ops = kind->ops;
    void *held;
    tl_value *values;
    tl_status status = tl_check_values(c, 0, TL_CHECK_NONE, &values, &t.args.count, &held);
    t.args.values = values;
    t.w.ops = ops;
    t.w.params_size = kind->params_size;
    if (status == TL_OK) {
        current = &t.w;
        kind->ops = &own;
        status = run_trial(&t);
        kind->ops = ops;
        current = NULL;
    }
    free(values);
    free(held);
    return status;
}

const tl_check_type tl_check_generators = {rules, check_kind};
