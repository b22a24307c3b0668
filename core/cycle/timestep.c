/* timestep.c - the stable time step.
 *
 * "paper": dt = FRAC 2 (M_min / (2 K_max))^1/2, K_max the largest max(kn, ks) A_c of a contact (27).
 * "body":  dt = FRAC 2 (1 / (2 rate))^1/2 with the highest rate of a body (rates.c): no motion of a body and its
 *          neighbours is faster, so FRAC 1 is stable.
 * By either rule no body's step is longer than its largest face allows, whatever areas its contacts have.
 * A step that would carry or turn a block too far is made shorter (travel.c); the one in use stays, for when it has gone by.
 * Mass scaling gives every free body the bound of the one that has the most; with a step asked for it adds inertia to the
 * bodies that need it (added_mass.c), and that step is taken. */
#include "cycle/added_mass.h"

#include "cycle/rates.h"
#include "cycle/travel.h"
#include "model/options.h"

#include "contact/detection.h"
#include "detect/detect.h"
#include "force/joint_laws.h"

#include <string.h>

/* The step in use is kept while the rule gives one between it and this many times it: a step that
 * changes all the time would cost accuracy. */
#define STEP_GROWTH 1.1

/* A given step is far too long from this many times the stable one on, which is safe by up to the square root of 2. */
#define TOO_LONG 2

/* Steps after which a given step is compared with the stable one again. */
#define COMPARE_EVERY 64

/* Rate over that of a push from which on turning is what makes a body fast: of a cube on a face it is some 2.5. */
#define MOSTLY 4.0

/* M or I over 2 K of the body, or of the smallest mass and the stiffest contact, that controls the step. */
typedef struct bound {
    double least;
    uint32_t body;    /* row, or TL_NO_ROW: there is no bound */
    uint32_t contact; /* row of the contact, or TL_NO_ROW */
    double stiffness;
} bound;

static void stiffest_range(void *user, size_t begin, size_t end, size_t chunk, unsigned thread)
{
    (void)chunk;
    tl_row_search *s = user;
    const tl_model *m = s->m;
    const tl_contacts *c = &m->detect->contacts;
    tl_row_value found = {0, TL_NO_ROW};
    for (uint32_t i = (uint32_t)begin; i < end; i++) {
        if (c->law[i] == TL_NO_ROW)
            continue;
        double k = tl_law_stiffness(&m->joint_laws[c->law[i]]) * c->area[i];
        /* most are not stiffer: what is dearer to know is asked last */
        if (k > found.value && (tl_body_counts(m, m->blocks.body[c->a[i]]) ||
                                tl_body_counts(m, m->blocks.body[c->b[i]])))
            found = (tl_row_value){k, i};
    }
    tl_row_search_note(s, thread, found);
}

/* M_min / (2 K_max), with K_max over the contacts of free bodies; no bound where none has an area. */
static bound paper_rule(tl_model *m)
{
    const struct tl_step_bounds *bounds = &m->cycle->step_bounds;
    tl_row_search s = {.m = m};
    tl_row_value stiffest =
        tl_row_search_run(&s, m->detect->contacts.table.rows, TL_CONTACT_CHUNK, stiffest_range);
    if (stiffest.row == TL_NO_ROW)
        return (bound){INFINITY, TL_NO_ROW, TL_NO_ROW, 0};
    return (bound){bounds->least_mass / (2 * stiffest.value), bounds->lightest, stiffest.row,
                   stiffest.value};
}

/* What controls the step. `report`: looked at anew, and the stiffness as well; nothing is kept then. */
static bound controlling(tl_model *m, bool report)
{
    tl_row_value fastest = report ? tl_rates_anew(m, 0) : tl_rates_keep(m, 0);
    bound out = {INFINITY, fastest.row, TL_NO_ROW, 0};
    if (fastest.row != TL_NO_ROW)
        out.least = 0.5 / fastest.value;
    if (!tl_rates_points(m)) {
        bound paper = paper_rule(m);
        if (paper.least <= out.least)
            out = paper;
    }
    if (report && out.body != TL_NO_ROW && out.contact == TL_NO_ROW)
        out.stiffness = tl_rate_stiffness(m, out.body);
    return out;
}

double tl_timestep_fraction(const tl_model *m)
{
    if (!isnan(m->timestep.fraction))
        return m->timestep.fraction;
    return m->timestep.rule == TL_TIMESTEP_BODY ? TL_BODY_FRACTION : TL_PAPER_FRACTION;
}

static double damping_factor(const tl_model *m)
{
    if (!m->damping)
        return 1;
    const tl_damping_ops *ops = m->damping->ops;
    tl_enter(m->damping, "step_factor");
    double factor = ops->step_factor ? ops->step_factor(m->damping_self) : 1;
    tl_leave();
    return factor;
}

double tl_timestep_rate_limit(const tl_model *m)
{
    double share = tl_timestep_fraction(m) * damping_factor(m) / m->added_dt;
    return tl_adds_mass(m) ? 2 * share * share : 0;
}

/* A plugin's factor is its word: refused when it cannot be. */
static tl_status check_factor(tl_model *m)
{
    double factor = damping_factor(m);
    if (!(factor > 0 && factor <= 1))
        return tl_fail(&m->error, TL_E_PLUGIN,
                       "damping '%s' gives the step factor %g, which is outside (0, 1]",
                       m->damping->name, factor);
    return TL_OK;
}

/* Why no step follows from the model. */
static tl_status no_step(tl_model *m, double dt)
{
    const char *way_out = tl_words(m, "a step with model:timestep{ dt = ... }",
                                   "a step with dt of tl_model_timestep()");
    const char *joint = tl_words(m, "model:joint(\"*\", ...)", "tl_joint_law()");
    if (m->joint_law_count == 0)
        return tl_fail(
            &m->error, TL_E_STATE,
            "no time step follows from the model: no law says how stiff a contact is; set "
            "a law with %s or %s",
            joint, way_out);
    if (!(tl_stiffest_law(m) > 0))
        return tl_fail(&m->error, TL_E_STATE,
                       "no time step follows from the model: kn and ks of all laws are 0; set a "
                       "stiffness with %s or %s",
                       joint, way_out);
    return tl_fail(
        &m->error, TL_E_STATE,
        "no time step follows from the model: by its masses and stiffnesses it would be %g "
        "s; check the units of density, sizes and kn, or set %s",
        dt, way_out);
}

static void say_long(tl_model *m, double stable, uint32_t body)
{
    tl_model_say(m,
                 "timestep: dt = %g s is %.3g times the longest stable step, %.3g s, which block "
                 "%u sets: contact forces will grow without bound; give a shorter one, or leave dt "
                 "out",
                 m->timestep.dt, m->timestep.dt / stable, stable, m->bodies.id[body]);
}

/* Notes whether the step that was given is far above the longest that is stable whatever the rule, that of the body
 * which is the fastest now, and says so once. All are looked at when there are more contacts than ever, and now and then:
 * an impact lasts one such step. */
static void judge_step(tl_model *m)
{
    struct tl_cycle *c = m->cycle;
    size_t contacts = m->detect->contacts.table.rows;
    bool due = c->dt <= 0 || m->cycles % COMPARE_EVERY == 0 || contacts > c->contacts;
    c->contacts = contacts > c->contacts ? contacts : c->contacts;
    if (!due || c->all_held || m->mass_scaling)
        return;
    double far_above = TOO_LONG / m->timestep.dt, bearable = 2 * far_above * far_above;
    tl_row_value fastest = tl_rates_anew(m, bearable);
    double stable = 2 * sqrt(0.5 / fastest.value);
    c->long_step = fastest.row != TL_NO_ROW && fastest.value > bearable;
    if (c->long_step && tl_model_says(m, TL_REMARK_STEP))
        say_long(m, stable, fastest.row);
}

/* The step that inertia is added for, or a shorter one that is given as well. */
static tl_status choose_added(tl_model *m, double *dt, bool report)
{
    struct tl_cycle *c = m->cycle;
    double wanted = m->added_dt, given = m->timestep.dt;
    if (given > wanted)
        return tl_fail(
            &m->error, TL_E_STATE,
            "timestep: dt = %g s is longer than %g s, the dt of mass_scaling; give one of "
            "them only, or the longer one to mass_scaling",
            given, wanted);
    if (!report) {
        double limit = tl_timestep_rate_limit(m);
        tl_rates_keep(m, limit);
        tl_status status = tl_added_find(m, limit);
        if (status != TL_OK)
            return status;
        c->mass_scale = 0;
        c->long_step = false;
    }
    *dt = c->dt = isnan(given) ? wanted : given;
    return TL_OK;
}

/* The step; 0 where there is no body that can move or does. A report asks `by` what controls it, and leaves the scale of the
 * inertia alone. */
static tl_status choose(tl_model *m, double *dt, bound *by)
{
    struct tl_cycle *c = m->cycle;
    tl_status status = check_factor(m);
    if (status != TL_OK)
        return status;
    tl_rates_count(m);
    if (tl_adds_mass(m)) {
        if (by)
            *by = (bound){INFINITY, TL_NO_ROW, TL_NO_ROW, 0};
        return choose_added(m, dt, by != NULL);
    }
    c->adds = false;
    bool given = !isnan(m->timestep.dt);
    double least = 0;
    if (by) {
        *by = controlling(m, true);
        least = by->least;
    } else if (m->mass_scaling || !given) {
        least = controlling(m, false).least;
        c->mass_scale = m->mass_scaling && isfinite(least) ? least : 0;
    } else {
        c->mass_scale = 0;
    }
    if (given) {
        if (!by)
            judge_step(m);
        *dt = c->dt = m->timestep.dt;
        return TL_OK;
    }
    c->long_step = false;
    double fresh = tl_timestep_fraction(m) * damping_factor(m) * 2 * sqrt(least);
    if (!(isfinite(fresh) && fresh > 0)) {
        *dt = 0;
        return tl_model_moves(m) ? no_step(m, fresh) : TL_OK;
    }
    if (!by && !m->mass_scaling)
        tl_sliver_remark(m);
    if (!(c->dt > 0) || fresh < c->dt || fresh > STEP_GROWTH * c->dt)
        c->dt = fresh;
    *dt = c->dt;
    uint32_t body;
    status = tl_travel_shorten(m, dt, &body);
    if (by && body != TL_NO_ROW)
        *by = (bound){0.25 * *dt * *dt, body, TL_NO_ROW, 0};
    return status;
}

tl_status tl_timestep_choose(tl_model *m, double *dt)
{
    return choose(m, dt, NULL);
}

tl_status tl_model_timestep(tl_model *m, const tl_timestep *given)
{
    tl_timestep read;
    const tl_timestep *timestep = &read;
    tl_status status = TL_OPTIONS_READ(tl_timestep, given, &read, &m->error);
    if (status == TL_OK)
        status = tl_model_may_set(m, "set timestep");
    if (status != TL_OK)
        return status;
    if (!isnan(timestep->fraction) &&
        !(timestep->fraction >= TL_FRACTION_LEAST && timestep->fraction <= TL_FRACTION_MOST))
        return tl_fail(&m->error, TL_E_ARGUMENT, "timestep: fraction = %g is outside [%g, %g]",
                       timestep->fraction, TL_FRACTION_LEAST, TL_FRACTION_MOST);
    if (!isnan(timestep->dt) &&
        !(timestep->dt >= TL_STEP_LEAST && timestep->dt <= 1 / TL_STEP_LEAST))
        return tl_fail(&m->error, TL_E_ARGUMENT, "timestep: dt = %g s is outside [%g, %g]",
                       timestep->dt, TL_STEP_LEAST, 1 / TL_STEP_LEAST);
    m->timestep = *timestep;
    if (m->cycle) {
        m->cycle->dt = 0;
        m->cycle->stiffness_rates.version = 0; /* another rule asks something else of contacts */
    }
    return TL_OK;
}

tl_status tl_model_timestep_report(tl_model *m, tl_timestep_report *report)
{
    *report = (tl_timestep_report){0};
    tl_status status = tl_cycle_prepare(m);
    if (status == TL_OK)
        status = tl_detect_refresh(m);
    if (status != TL_OK)
        return status;
    struct tl_cycle *c = m->cycle;
    double in_use = c->dt;
    bound by;
    status = choose(m, &report->dt, &by);
    c->dt = in_use;
    if (status != TL_OK || by.body == TL_NO_ROW)
        return status;
    report->block = m->bodies.id[by.body];
    report->mass = m->bodies.mass[by.body];
    report->stiffness = by.stiffness;
    report->by = !(by.stiffness > 0) ? TL_STEP_BY_SPEED
                 : by.contact == TL_NO_ROW && 0.5 / by.least > MOSTLY * by.stiffness / report->mass
                     ? TL_STEP_BY_TURN
                     : TL_STEP_BY_PUSH;
    if (by.contact != TL_NO_ROW) {
        /* the paper's rule joins the smallest mass and the stiffest contact, wherever they are */
        const tl_contacts *contacts = &m->detect->contacts;
        bool a_free = tl_body_counts(m, m->blocks.body[contacts->a[by.contact]]);
        report->partner = m->blocks.id[a_free ? contacts->a[by.contact] : contacts->b[by.contact]];
    }
    return TL_OK;
}

tl_status tl_model_dt(tl_model *m, double *dt)
{
    tl_timestep_report report;
    tl_status status = tl_model_timestep_report(m, &report);
    *dt = report.dt;
    return status;
}
