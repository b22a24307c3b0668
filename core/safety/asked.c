/* asked.c - whether what is asked of a search for factors can be answered, and which laws it divides. */
#include "safety/asked.h"

#include "base/error.h"
#include "base/number.h"
#include "base/strength.h"
#include "cycle/element_strength.h"
#include "cycle/meshes.h"
#include "model/joints.h"
#include "model/scope.h"
#include "zone/solids.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <talus/number.h>
#include <talus/talus.h>
#include <talus/workers.h>

/* What is asked, and the answer: which laws are divided. */
typedef struct question {
    const char *what; /* begins sentences */
    tl_model *asked;
    tl_safety options;
    uint8_t *which; /* of the laws */
} question;

static tl_status check_number(const question *t, const char *name, double value, bool good, const char *allowed)
{
    char text[TL_NUMBER_TEXT];
    tl_number_text(value, text);
    return good ? TL_OK
                : tl_fail(&t->asked->error, TL_E_ARGUMENT, "%s: %s = %s must be %s", t->what, name, text, allowed);
}

static tl_status check_options(const question *t)
{
    const tl_safety *o = &t->options;
    char from[TL_NUMBER_TEXT], to[TL_NUMBER_TEXT];
    tl_number_text(o->from, from);
    tl_number_text(o->to, to);
    tl_status status =
        check_number(t, "from", o->from, o->from >= TL_LEAST_FACTOR && isfinite(o->from), "at least 0.05");
    if (status == TL_OK)
        status = check_number(t, "to", o->to, isfinite(o->to), "a finite number");
    if (status == TL_OK && !(o->from < o->to))
        status = tl_fail(&t->asked->error, TL_E_ARGUMENT, "%s: from = %s must be below to = %s", t->what, from, to);
    if (status == TL_OK)
        status = check_number(t, "resolution", o->resolution, o->resolution >= 1e-4 && o->resolution <= 0.5,
                              "in [1e-4, 0.5]");
    if (status == TL_OK)
        status = check_number(t, "step", o->step, o->step >= 1e-3 && isfinite(o->step), "at least 0.001");
    if (status == TL_OK)
        status = check_number(t, "least_volume", o->least_volume, o->least_volume >= 0 && isfinite(o->least_volume),
                              "a finite number >= 0");
    if (status == TL_OK)
        status = check_number(t, "max_cycles", (double)o->max_cycles, o->max_cycles >= 1, "at least 1");
    if (status == TL_OK)
        status = check_number(t, "workers", (double)o->workers, o->workers >= 1 && o->workers <= TL_MOST_WORKERS,
                              "in [1, 256]");
    return status;
}

/* Marks the laws of one name. */
static tl_status mark_laws(question *t, const char *name)
{
    tl_model *m = t->asked;
    tl_tag tag;
    char error[TL_ERROR_TEXT];
    bool some = false;
    if (tl_joint_parse(m, name, &tag) != TL_OK) {
        tl_text_print(error, sizeof error, "%s", m->error.text);
        return tl_fail(&m->error, TL_E_ARGUMENT, "%s: joints: %s", t->what, error);
    }
    for (size_t i = 0; i < m->joint_law_count; i++)
        if (tl_tag_matches(tag, m->joint_laws[i].scope.tag)) {
            t->which[i] = 1;
            some = true;
        }
    return some ? TL_OK
                : tl_fail(&m->error, TL_E_ARGUMENT,
                          "%s: joint '%s' has no law of its own whose strengths could be divided; give it one", t->what,
                          name);
}

/* Names the laws that have no strengths, when none has. */
static tl_status say_unmarked(const question *t)
{
    tl_model *m = t->asked;
    char names[200] = "";
    size_t used = 0;
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const char *name = m->joint_laws[i].kind->name;
        if (t->which[i] && !strstr(names, name) && used + strlen(name) + 8 < sizeof names) {
            tl_text_print(names + used, sizeof names - used, "%s'%s'", used ? ", " : "", name);
            used = strlen(names);
        }
    }
    if (!used)
        return tl_fail(&m->error, TL_E_STATE, "%s: the model has no law whose strengths could be divided", t->what);
    return tl_fail(&m->error, TL_E_ARGUMENT,
                   "%s: no parameter of the laws %s is marked as a strength, so there is nothing to divide; a plugin "
                   "marks them with TL_PARAM_STRENGTH",
                   t->what, names);
}

static tl_status choose_laws(question *t)
{
    const tl_model *m = t->asked;
    const tl_safety *o = &t->options;
    tl_status status = TL_OK;
    bool some = false;
    t->which = calloc(m->joint_law_count + 1, 1);
    if (!t->which)
        return tl_fail_memory(&t->asked->error);
    if (o->joints)
        for (size_t k = 0; k < o->joint_count && status == TL_OK; k++)
            status = mark_laws(t, o->joints[k]);
    else
        memset(t->which, 1, m->joint_law_count);
    for (size_t i = 0; i < m->joint_law_count; i++) {
        const bool has = tl_kind_has_strength(m->joint_laws[i].kind);
        some = some || (t->which[i] && has);
    }
    for (size_t k = 0; o->solids && m->zones && k < m->zones->solid_count; k++)
        some = some || tl_kind_has_strength(m->zones->solid[k].of.kind);
    some = some || (o->elements && tl_elements_have_strength(m));
    if (status == TL_OK && !some)
        return say_unmarked(t);
    for (size_t i = 0; i < m->joint_law_count; i++)
        t->which[i] = t->which[i] && tl_kind_has_strength(m->joint_laws[i].kind);
    return status;
}

/* Refuses what has no factor: nothing that is free, or something that is driven. */
static tl_status check_bodies(const question *t)
{
    const tl_model *m = t->asked;
    size_t free = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++) {
        free += tl_body_is_free(m, body);
        if (m->bodies.drive[body])
            return tl_fail(&t->asked->error, TL_E_STATE, "%s: block %u is driven: take the drive off first", t->what,
                           m->bodies.id[body]);
    }
    return free > 0 ? TL_OK : tl_fail(&t->asked->error, TL_E_STATE, "%s: nothing can move: no block is free", t->what);
}

static void no_job(void *user, uint64_t job, const void **data, size_t *size)
{
    (void)user, (void)job, (void)data, (void)size;
}

/* Refuses processes where there can be none, before any work is done. */
static tl_status check_processes(const question *t)
{
    tl_workers *workers = NULL;
    tl_error error;
    if (t->options.workers < 2)
        return TL_OK;
    tl_status status = tl_workers_start(1, no_job, NULL, &workers, &error);
    tl_workers_end(workers);
    return status == TL_OK ? TL_OK : tl_fail(&t->asked->error, status, "%s: %s", t->what, error.text);
}

tl_status tl_asked_check(tl_model *m, const char *what, const tl_safety *options, uint8_t **which)
{
    question of = {what, m, *options, NULL}, *t = &of;
    tl_status status = tl_model_may_set(t->asked, "find a factor of safety");
    if (status == TL_OK)
        status = check_options(t);
    if (status == TL_OK)
        status = choose_laws(t);
    if (status == TL_OK)
        status = check_bodies(t);
    if (status == TL_OK)
        status = check_processes(t);
    *which = t->which;
    return status;
}
