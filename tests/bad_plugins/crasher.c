/* crasher.c - a law, a damping and a generator that crash on request, and a kind of a type that no host knows. */
#define _POSIX_C_SOURCE 200809L
#include <talus/plugin.h>

#include <math.h>
#include <signal.h>
#include <stdlib.h>

enum { NEVER, SEGV, FPE, ILL, ABORT, STACK };

typedef struct params {
    int32_t how, when;
    double kn;
} params;

static const char *const ways[] = {"never", "segv", "fpe", "ill", "abort", "stack", NULL};
static const char *const times[] = {"update", "stiffness", NULL};

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_ENUM, params, how, "", "how it crashes", .choices = ways),
    TL_PARAM(TL_PARAM_ENUM, params, when, "", "in which function", .choices = times),
    TL_PARAM(TL_PARAM_REAL, params, kn, "Pa/m", "stiffness", .def = {1e8}, .min = 0, .max = INFINITY),
};

/* Uses up the stack; as far as the compiler knows it may end. */
static volatile int deep_enough;
static int deeper(volatile char *above)
{
    volatile char here[4096];
    here[0] = above[0];
    return deep_enough ? 0 : deeper(here) + here[0];
}

static void crash(int how)
{
    volatile char seed = 1;
    switch (how) {
    case SEGV: raise(SIGSEGV); break;
    case FPE: raise(SIGFPE); break;
    case ILL: __builtin_trap();
    case ABORT: abort();
    case STACK: (void)deeper(&seed); break;
    default: break;
    }
}

static tl_status update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    (void)report;
    const params *p = self;
    for (uint32_t i = 0; i < batch->count; i++)
        batch->f_n[i] = fmax(0, p->kn * batch->area[i] * batch->closure[i]);
    if (p->when == 0)
        crash(p->how);
    return TL_OK;
}

static void stiffness(const void *self, double *kn, double *ks)
{
    const params *p = self;
    if (p->when == 1)
        crash(p->how);
    *kn = *ks = p->kn;
}

static tl_status damp(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    (void)batch;
    (void)report;
    crash(((const params *)self)->how);
    return TL_OK;
}

static double step_factor(const void *self)
{
    (void)self;
    return 1;
}

/* A null pointer the compiler does not know of. */
static double *volatile nowhere;

static tl_status generate(const tl_host *host, const void *given)
{
    (void)host;
    (void)given;
    *nowhere = 1;
    return TL_OK;
}

static const tl_law_ops law_ops = {.size = sizeof law_ops, .update = update, .stiffness = stiffness};
static const tl_damping_ops damping_ops = {.size = sizeof damping_ops, .update = damp, .step_factor = step_factor};
static const tl_generator_ops generator_ops = {.size = sizeof generator_ops, .generate = generate};

#define KIND(type_, ops_)                                                                                              \
    {                                                                                                                  \
        .size = sizeof(tl_kind), .type = (type_), .name = "crasher", .doc = "A kind for the test of crashes.",         \
        TL_KIND_PARAMS(params, param_table), .ops = (ops_)                                                             \
    }

static const tl_kind kinds[] = {KIND(TL_KIND_LAW, &law_ops), KIND(17, NULL), KIND(TL_KIND_DAMPING, &damping_ops),
                                KIND(TL_KIND_GENERATOR, &generator_ops)};

TL_PLUGIN(kinds, .id = "bad.crasher", .version = "1", .doc = "A plugin for the test of crashes.",
          .licence = "BSD-3-Clause");
