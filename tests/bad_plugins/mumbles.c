/* mumbles.c - a law, a damping and a generator that fail where they are told to, with a report that is not a sentence: full to
 * its last byte without an end, empty, or with line ends and codes of terminals. */
#include <stdlib.h>
#include <string.h>
#include <talus/plugin.h>

enum { NEVER, CREATE, BEGIN, UPDATE };
enum { FULL, NOTHING, CODES };

typedef struct params {
    int32_t where, what;
} params;

static const char *const places[] = {"never", "create", "begin", "update", NULL};
static const char *const texts[] = {"full", "nothing", "codes", NULL};
/* a colour, a line's end, the end of a word in another alphabet, and a code of one letter of that */
static const char codes[] = "one\x1b[31m\ntwo\t\xc3\xbc\xc2\x9bthree\x7f";

static const tl_param param_table[] = {
    TL_PARAM(TL_PARAM_ENUM, params, where, "", "function that fails", .choices = places),
    TL_PARAM(TL_PARAM_ENUM, params, what, "", "what it says", .choices = texts),
};

static tl_status say(const params *p, int32_t where, tl_report *report)
{
    if (p->where != where)
        return TL_OK;
    if (p->what == FULL)
        memset(report->text, 'x', sizeof report->text);
    else if (p->what == CODES)
        memcpy(report->text, codes, sizeof codes);
    return TL_E_NUMERIC;
}

static tl_status create(const void *given, void **self, tl_report *report)
{
    tl_status status = say(given, CREATE, report);
    if (status != TL_OK)
        return status;
    *self = malloc(sizeof(params));
    if (!*self)
        return TL_E_MEMORY;
    memcpy(*self, given, sizeof(params));
    return TL_OK;
}

static tl_status update_law(const void *self, const tl_law_batch *batch, tl_report *report)
{
    for (uint32_t i = 0; i < batch->count; i++)
        batch->f_n[i] = 1e6 * batch->area[i] * batch->closure[i];
    return say(self, UPDATE, report);
}

static void stiffness(const void *self, double *kn, double *ks)
{
    (void)self;
    *kn = *ks = 1e6;
}

static const tl_law_ops law_ops = {
    .size = sizeof law_ops, .create = create, .update = update_law, .stiffness = stiffness, .destroy = free};

static tl_status begin(const void *self, const tl_damping_totals *totals, double *const *state, tl_report *report)
{
    (void)totals;
    (void)state;
    return say(self, BEGIN, report);
}

static tl_status update_damping(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    (void)batch;
    return say(self, UPDATE, report);
}

static double step_factor(const void *self)
{
    (void)self;
    return 1;
}

static const tl_damping_ops damping_ops = {.size = sizeof damping_ops,
                                           .create = create,
                                           .begin = begin,
                                           .update = update_damping,
                                           .step_factor = step_factor,
                                           .destroy = free};

static tl_status generate(const tl_host *host, const void *given)
{
    const params *p = given;
    if (p->what == NOTHING)
        return host->fail(host, TL_E_NUMERIC, "%s", "");
    return host->fail(host, TL_E_NUMERIC, "%s", codes);
}

static const tl_generator_ops generator_ops = {.size = sizeof generator_ops, .generate = generate};

#define KIND(type_, ops_)                                                                                              \
    {                                                                                                                  \
        .size = sizeof(tl_kind), .type = (type_), .name = "mumbles", .doc = "It says nothing.",                        \
        TL_KIND_PARAMS(params, param_table), .ops = &(ops_),                                                           \
    }

static const tl_kind kinds[] = {KIND(TL_KIND_LAW, law_ops), KIND(TL_KIND_DAMPING, damping_ops),
                                KIND(TL_KIND_GENERATOR, generator_ops)};

TL_PLUGIN(kinds, .id = "bad.mumbles", .version = "1", .doc = "A plugin for the test of reports.",
          .licence = "BSD-3-Clause");
