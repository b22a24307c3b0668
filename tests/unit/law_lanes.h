/* law_lanes.h - a batch of contact points in plain arrays, and a law from the real loader to move it. */
#ifndef TALUS_TESTS_LAW_LANES_H
#define TALUS_TESTS_LAW_LANES_H

#include "base/error.h"
#include "check.h"

#include <stdalign.h>
#include <talus/talus.h>

enum { LANES = 64, STATES = 8 };

typedef struct lanes {
    alignas(64) double area[LANES], closure[LANES], f_n0[LANES], normal[3][LANES];
    alignas(64) double du_n[LANES], du_s[3][LANES], f_n[LANES], f_s[3][LANES];
    alignas(64) double apart[LANES]; /* 0 */
    alignas(64) double stored[LANES], dissipated[LANES], state[STATES][LANES];
    alignas(64) uint32_t flags[LANES];
} lanes;

typedef struct law {
    const tl_kind *kind;
    const tl_law_ops *ops;
    double params[32]; /* room for any law's struct */
    void *self;
} law;

static inline law law_open(const char *name, const tl_args *args)
{
    law l = {.kind = tl_plugin_find(TL_KIND_LAW, name)};
    if (!CHECK(l.kind != NULL))
        exit(1);
    l.ops = l.kind->ops;
    tl_error error = {TL_OK, ""};
    tl_status status =
        tl_args_read(l.kind->params, l.kind->param_count, l.kind->param_stride, args, false, l.params, name, &error);
    if (!CHECK_INT(status, TL_OK))
        printf("%s\n", error.text);
    tl_report report = {.size = sizeof report};
    if (l.ops->create)
        CHECK_INT(l.ops->create(l.params, &l.self, &report), TL_OK);
    return l;
}

/* A law without `create` works on its params; they move with the struct. */
static inline const void *law_self(const law *l)
{
    return l->self ? l->self : l->params;
}

static inline void law_close(law *l)
{
    if (l->ops->destroy && l->self)
        l->ops->destroy(l->self);
    l->self = NULL;
}

/* Every state at its initial value, everything else zero. */
static inline void lanes_reset(const law *l, lanes *p)
{
    memset(p, 0, sizeof *p);
    for (uint32_t s = 0; s < l->kind->state_count; s++)
        for (int i = 0; i < LANES; i++)
            p->state[s][i] = l->kind->states[s].initial;
    for (int i = 0; i < LANES; i++)
        p->normal[2][i] = 1;
}

/* One step on the lanes [begin, begin + count). */
static inline void law_step(const law *l, lanes *p, uint32_t begin, uint32_t count, int energy)
{
    double *state[STATES];
    for (int s = 0; s < STATES; s++)
        state[s] = p->state[s] + begin;
    tl_law_batch batch = {
        .size = sizeof batch,
        .count = count,
        .dt = 1e-3,
        .area = p->area + begin,
        .closure = p->closure + begin,
        .closure_edge = p->closure + begin,
        .closure_apart = p->apart + begin,
        .f_n0 = p->f_n0 + begin,
        .normal = {p->normal[0] + begin, p->normal[1] + begin, p->normal[2] + begin},
        .du_n = p->du_n + begin,
        .du_s = {p->du_s[0] + begin, p->du_s[1] + begin, p->du_s[2] + begin},
        .f_n = p->f_n + begin,
        .f_s = {p->f_s[0] + begin, p->f_s[1] + begin, p->f_s[2] + begin},
        .state = state,
        .flags = p->flags + begin,
        .stored = energy ? p->stored + begin : NULL,
        .dissipated = energy ? p->dissipated + begin : NULL,
    };
    tl_report report = {.size = sizeof report};
    CHECK_INT(l->ops->update(law_self(l), &batch, &report), TL_OK);
}

static inline double lane_shear(const lanes *p, int i)
{
    return sqrt(p->f_s[0][i] * p->f_s[0][i] + p->f_s[1][i] * p->f_s[1][i] + p->f_s[2][i] * p->f_s[2][i]);
}

#endif
