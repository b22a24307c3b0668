/* unfit.c - a law, a damping, a generator and a screen that each break one rule of the conformance check, which a parameter names. */
#include <talus/plugin.h>

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* ---------------------------------------------------------------- law -------------------- */

enum {
    NONE,
    RUNS,
    REPEATS,
    ALONE,
    SPLIT,
    ENERGIES,
    WRITES_INPUT,
    WRITES_BEHIND,
    WRITES_STATE,
    PADDING,
    FINITE,
    PLANE,
    STILL,
    TURNED,
    SOFTER,
    SHEAR_SOFTER,
    CYCLE,
    STATES,
    STATELESS,
    PULLS,
    ADDS_STATE,
    READS,
    STORED,
    HEAT,
    LOST,
    UNWRITTEN,
    AREA,
    FLAGS
};

typedef struct law_params {
    int32_t law_fault;
    double kn;
} law_params;

static const char *const law_faults[] = {
    "none",         "runs",      "repeats",   "alone", "split",      "energies", "writes_input", "writes_behind",
    "writes_state", "padding",   "finite",    "plane", "still",      "turned",   "softer",       "shear_softer",
    "cycle",        "states",    "stateless", "pulls", "adds_state", "reads",    "stored",       "heat",
    "lost",         "unwritten", "area",      "flags", NULL};

static const tl_param law_table[] = {
    TL_PARAM(TL_PARAM_ENUM, law_params, law_fault, "", "what is wrong with the law", .choices = law_faults),
    TL_PARAM(TL_PARAM_REAL, law_params, kn, "Pa/m", "stiffness", .def = {1e8}, .min = 1e6, .max = 1e10),
};

static const tl_state law_state[] = {
    TL_STATE(TL_STATE_SCALAR, "path", "m", "length of shear so far", .transfer = TL_TRANSFER_RESET),
};

static int calls; /* which no plugin may count */

/* What a point gets besides the springs' forces. */
static void spoil(const law_params *p, const tl_law_batch *batch, uint32_t i)
{
    double k = p->kn * batch->area[i];
    switch (p->law_fault) {
    case REPEATS: batch->f_n[i] += k * 1e-12 * (calls++ % 7); break;
    case ALONE: batch->f_n[i] *= batch->count > TL_LANES ? 1 + 1e-15 : 1; break;
    case SPLIT: batch->f_n[i] *= i % 3 == 2 ? 1 + 1e-15 : 1; break;
    case ENERGIES: batch->f_n[i] *= batch->stored ? 1 + 1e-15 : 1; break;
    case WRITES_INPUT: ((double *)(uintptr_t)batch->du_n)[i] = 0; break;
    case WRITES_BEHIND: batch->f_n[batch->count] = 0; break;
    case WRITES_STATE: batch->state[1][i] = 1; break;
    case ADDS_STATE: batch->state[1][i] += 1e-9; break;
    case READS: batch->f_n[i] *= batch->state[1][i] > 0 ? 1 + 1e-15 : 1; break;
    case AREA: batch->f_n[i] *= batch->area[i] > 0.5 ? 1 - 1e-5 : 1; break;
    case FLAGS: batch->flags[i] = 0; break;
    case PADDING: batch->f_n[i] += p->kn * 1e-9; break;
    case FINITE: batch->f_n[i] += 0 * batch->du_n[i] / batch->dt; break;
    case PLANE:
        for (int j = 0; j < 3; j++)
            batch->f_s[j][i] += 1e-6 * batch->f_n[i] * batch->normal[j][i];
        break;
    case STILL: batch->f_n[i] *= batch->du_n[i] == 0 ? 0.999 : 1; break;
    case TURNED: /* east is not like north */ batch->f_n[i] *= 1 + 1e-6 * fabs(batch->normal[0][i]); break;
    default: break;
    }
}

/* What is wrong with the energies of a point. */
static void spoil_energies(const law_params *p, const tl_law_batch *batch, uint32_t i, double before)
{
    if (!batch->stored)
        return;
    switch (p->law_fault) {
    case STORED: batch->stored[i] *= -42; break;
    case HEAT: batch->dissipated[i] = -batch->dissipated[i]; break;
    case LOST: batch->dissipated[i] = 0; break;
    case UNWRITTEN: batch->stored[i] = before; break;
    default: break;
    }
}

static tl_status law_update(const void *self, const tl_law_batch *batch, tl_report *report)
{
    const law_params *p = self;
    if (p->law_fault == RUNS) {
        strcpy(report->text, "it does not feel like it");
        return TL_E_NUMERIC;
    }
    for (uint32_t i = 0; i < batch->count; i++) {
        double k = p->kn * batch->area[i], moved = 0, along = 0, shear2 = 0;
        double total = k * batch->closure[i] + batch->f_n0[i];
        double f_n = total > 0 || p->law_fault == PULLS ? total : 0;
        /* a stiffness that grows with the pressure, in increments: sheared under load and back without, it gives energy */
        double shear = p->law_fault == CYCLE && k > 0 ? k * f_n / (f_n + 1e5 * batch->area[i]) : k;
        for (int j = 0; j < 3; j++) {
            double before = batch->f_s[j][i], trial = before - shear * batch->du_s[j][i];
            moved += batch->du_s[j][i] * batch->du_s[j][i];
            along += trial * before;
            batch->f_s[j][i] = total > 0 ? trial : 0;
            shear2 += batch->f_s[j][i] * batch->f_s[j][i];
        }
        batch->f_n[i] = f_n;
        batch->flags[i] = total > 0 || p->law_fault == PULLS ? 0 : TL_POINT_OPEN;
        if (p->law_fault != STATES)
            batch->state[0][i] += sqrt(moved);
        spoil(p, batch, i);
        double per = k > 0 ? 0.5 / k : 0, was = batch->stored ? batch->stored[i] : 0;
        if (batch->stored)
            batch->stored[i] = per * (f_n * f_n + shear2);
        if (batch->dissipated)
            batch->dissipated[i] = total > 0 || !(along > 0) ? 0 : per * along;
        spoil_energies(p, batch, i, was);
    }
    return TL_OK;
}

static void law_stiffness(const void *self, double *kn, double *ks)
{
    const law_params *p = self;
    *kn = *ks = p->kn;
    if (p->law_fault == SOFTER)
        *kn = 0.9 * p->kn;
    if (p->law_fault == SHEAR_SOFTER)
        *ks = 0.9 * p->kn;
}

static int law_stateless(const void *self)
{
    return ((const law_params *)self)->law_fault == STATELESS;
}

/* Whatever stiffness() says. */
static void law_across_gap(const void *self, const tl_law_batch *batch, double *lift, double *hold)
{
    const law_params *p = self;
    for (uint32_t i = 0; i < batch->count; i++) {
        double k = p->kn * batch->area[i];
        lift[i] = batch->f_n0[i] / (k > 0 ? k : 1);
        hold[i] = 0;
    }
}

static uint32_t law_pulls(const void *self)
{
    (void)self;
    return TL_PULL_NONE;
}

static const tl_law_ops law_ops = {.size = sizeof law_ops,
                                   .update = law_update,
                                   .stiffness = law_stiffness,
                                   .stateless = law_stateless,
                                   .pulls = law_pulls,
                                   .across_gap = law_across_gap};

/* ---------------------------------------------------------------- damping ---------------- */

enum {
    D_NONE,
    D_RUNS,
    D_REPEATS,
    D_ALONE,
    D_SPLIT,
    D_WRITES,
    D_MOVING,
    D_GROWS,
    D_STATE,
    D_FINITE,
    D_BRAKES,
    D_ALPHA,
    D_RESTS,
    D_FACTOR,
    D_STATES
};

typedef struct damping_params {
    int32_t damping_fault;
} damping_params;

static const char *const damping_faults[] = {"none",   "runs",   "repeats", "alone",  "split",  "writes",
                                             "moving", "grows",  "state",   "finite", "brakes", "alpha",
                                             "rests",  "factor", "states",  NULL};

static const tl_param damping_table[] = {
    TL_PARAM(TL_PARAM_ENUM, damping_params, damping_fault, "", "what is wrong with the damping",
             .choices = damping_faults),
};

static const tl_state damping_state[] = {
    {.size = sizeof(tl_state), .name = "steps", .unit = "", .doc = "steps so far"},
};

static tl_status damping_begin(const void *self, const tl_damping_totals *totals, double *const *state,
                               tl_report *report)
{
    const damping_params *p = self;
    (void)totals;
    if (p->damping_fault == D_RUNS) {
        strcpy(report->text, "it does not feel like it");
        return TL_E_NUMERIC;
    }
    if (p->damping_fault != D_STATES)
        *state[0] += 1;
    return TL_OK;
}

static tl_status damping_update(const void *self, const tl_damping_batch *batch, tl_report *report)
{
    const damping_params *p = self;
    (void)report;
    for (uint32_t i = 0; i < batch->count; i++) {
        double sign = p->damping_fault == D_BRAKES && i % 5 == 0 ? 1 : -1;
        for (int k = 0; k < 3; k++)
            batch->damping_force[k][i] = sign * batch->mass[i] * batch->velocity[k][i];
        batch->alpha[i] = p->damping_fault == D_ALPHA ? -1 : 0.5;
        switch (p->damping_fault) {
        case D_REPEATS: batch->alpha[i] += 1e-9 * (calls++ % 7); break;
        case D_ALONE: batch->alpha[i] += batch->count > TL_LANES ? 1e-9 : 0; break;
        case D_SPLIT: batch->alpha[i] += i % 3 == 2 ? 1e-9 : 0; break;
        case D_WRITES: ((double *)(uintptr_t)batch->velocity[0])[i] = 0; break;
        case D_MOVING: ((double *)(uintptr_t)batch->moving_mass)[i] = 0; break;
        case D_GROWS: batch->alpha[i] *= batch->moving_mass[i]; break;
        case D_STATE: *batch->state[0] += 1; break;
        case D_FINITE: batch->damping_moment[0][i] = 0 / batch->angular_velocity[0][i]; break;
        case D_RESTS: batch->damping_force[2][i] += batch->velocity[2][i] == 0 ? 1e-9 : 0; break;
        default: break;
        }
    }
    return TL_OK;
}

static double damping_factor(const void *self)
{
    return ((const damping_params *)self)->damping_fault == D_FACTOR ? 1.5 : 1;
}

static const tl_damping_ops damping_ops = {
    .size = sizeof damping_ops, .begin = damping_begin, .update = damping_update, .step_factor = damping_factor};

/* ---------------------------------------------------------------- generator -------------- */

enum { G_NONE, G_REPEATS, G_PARAMETERS, G_FAILURES, G_GOES_ON };

typedef struct generator_params {
    int32_t generator_fault;
    tl_vec3 at;
} generator_params;

static const char *const generator_faults[] = {"none", "repeats", "parameters", "failures", "goes_on", NULL};

static const tl_param generator_table[] = {
    TL_PARAM(TL_PARAM_ENUM, generator_params, generator_fault, "", "what is wrong with the generator",
             .choices = generator_faults),
    TL_PARAM(TL_PARAM_VEC3, generator_params, at, "m", "lowest corner of the first cube", .def = {20, 0, 0}),
};

static tl_status generate(const tl_host *host, const void *given)
{
    const generator_params *p = given;
    tl_vec3 at = p->at;
    tl_status first = TL_OK;
    if (p->generator_fault == G_REPEATS)
        at.y += calls++;
    if (p->generator_fault == G_PARAMETERS)
        ((generator_params *)(uintptr_t)given)->at.x = 0;
    for (int i = 0; i < 3; i++, at.x += 2) {
        tl_status status = host->create_box(host, at, (tl_vec3){at.x + 1, at.y + 1, at.z + 1}, 2000, NULL);
        if (status != TL_OK && p->generator_fault != G_FAILURES && p->generator_fault != G_GOES_ON)
            return status;
        if (status != TL_OK)
            first = status;
    }
    return p->generator_fault == G_FAILURES ? TL_OK : first;
}

static const tl_generator_ops generator_ops = {.size = sizeof generator_ops, .generate = generate};

/* ---------------------------------------------------------------- screen ----------------- */

enum { S_NONE, S_OPENS, S_ADDRESS, S_NOBODY, S_SHOWS, S_HASTY, S_MADE_UP, S_PARAMETERS, S_BEHIND };

typedef struct screen_params {
    int32_t screen_fault;
} screen_params;

static const char *const screen_faults[] = {"none",  "opens",   "address",    "nobody", "shows",
                                            "hasty", "made_up", "parameters", "behind", NULL};

static const tl_param screen_table[] = {
    TL_PARAM(TL_PARAM_ENUM, screen_params, screen_fault, "", "what is wrong with the screen", .choices = screen_faults),
};

static tl_status open_screen(const tl_screen_page *page, const void *given, void **self, tl_report *report)
{
    static int32_t fault;
    (void)page;
    if (((const screen_params *)given)->screen_fault == S_OPENS && fault == S_OPENS) {
        snprintf(report->text, sizeof report->text, "it is open already");
        return TL_E_STATE;
    }
    fault = ((const screen_params *)given)->screen_fault;
    if (fault == S_PARAMETERS)
        ((screen_params *)(uintptr_t)given)->screen_fault = S_NONE;
    *self = &fault;
    return TL_OK;
}

static int32_t fault_of(const void *self)
{
    return *(const int32_t *)self;
}

static const char *address(const void *self)
{
    return fault_of(self) == S_ADDRESS ? "" : "nowhere";
}

static uint32_t watchers(const void *self)
{
    return fault_of(self) == S_NOBODY;
}

static tl_status put(void *self, const tl_screen_frame *frame, tl_report *report)
{
    if (fault_of(self) != S_SHOWS || frame->news_length > 0)
        return TL_OK;
    snprintf(report->text, sizeof report->text, "nothing is new");
    return TL_E_ARGUMENT;
}

static int take(void *self, char *text, size_t room, double seconds)
{
    const struct timespec wait = {0, (long)(1e9 * seconds) + 1000};
    int32_t fault = fault_of(self);
    if (fault != S_HASTY)
        nanosleep(&wait, NULL);
    if (fault == S_BEHIND)
        text[room] = '\0';
    return fault == S_MADE_UP;
}

static void close_screen(void *self)
{
    (void)self;
}

static const tl_screen_ops screen_ops = {sizeof screen_ops, open_screen, address, watchers, put, take, close_screen};

/* ---------------------------------------------------------------- descriptor ------------- */

static const tl_kind kinds[] = {
    TL_KIND(TL_KIND_LAW, law_ops, .name = "unfit", .doc = "A law for the tests of the conformance check.",
            TL_KIND_PARAMS(law_params, law_table), TL_KIND_STATES(law_state)),
    TL_KIND(TL_KIND_DAMPING, damping_ops, .name = "unfit", .doc = "A damping for the tests of the conformance check.",
            TL_KIND_PARAMS(damping_params, damping_table), TL_KIND_STATES(damping_state)),
    TL_KIND(TL_KIND_GENERATOR, generator_ops, .name = "unfit",
            .doc = "A generator for the tests of the conformance check.",
            TL_KIND_PARAMS(generator_params, generator_table)),
    TL_KIND(TL_KIND_SCREEN, screen_ops, .name = "unfit", .doc = "A screen for the tests of the conformance check.",
            TL_KIND_PARAMS(screen_params, screen_table)),
};

TL_PLUGIN(kinds, .id = "bad.unfit", .version = "1", .doc = "A plugin for the tests of the conformance check.",
          .licence = "BSD-3-Clause");
