/* test_damping.c - the dampings through the loader: single forces, and one degree of freedom against
 * closed forms. The host's part, equation (23), is written out here for one body. */
#include "base/error.h"
#include "check.h"

#include <stdalign.h>
#include <talus/talus.h>

#define NUMBER(name, value)                                                                                            \
    {                                                                                                                  \
        .key = (name), .type = TL_VALUE_NUMBER, .number = (value)                                                      \
    }

enum { BODIES = 8 };

typedef struct damping {
    const tl_kind *kind;
    const tl_damping_ops *ops;
    double params[32], value;
    double *state[1];
    void *self;
} damping;

/* Bodies in columns, as the host hands them over. */
typedef struct bodies {
    alignas(64) double velocity[3][BODIES], spin[3][BODIES], force[3][BODIES], moment[3][BODIES];
    alignas(64) double force_before[3][BODIES], moment_before[3][BODIES];
    alignas(64) double mass[BODIES], inertia[BODIES];
    alignas(64) double damping_force[3][BODIES], damping_moment[3][BODIES], alpha[BODIES];
} bodies;

static tl_status damping_open(damping *d, const char *name, const tl_value *values, size_t count, tl_report *report)
{
    *d = (damping){.kind = tl_plugin_find(TL_KIND_DAMPING, name)};
    if (!CHECK(d->kind != NULL))
        exit(1);
    d->ops = d->kind->ops;
    d->value = d->kind->state_count ? d->kind->states[0].initial : 0;
    d->state[0] = &d->value;
    tl_args args = {values, count};
    tl_error error = {TL_OK, ""};
    tl_status status = tl_args_read(d->kind->params, d->kind->param_count, d->kind->param_stride, &args, false,
                                    d->params, name, &error);
    if (!CHECK_INT(status, TL_OK))
        printf("%s\n", error.text);
    *report = (tl_report){.size = sizeof *report};
    d->self = d->params;
    return d->ops->create ? d->ops->create(d->params, &d->self, report) : TL_OK;
}

static void damping_close(damping *d)
{
    if (d->ops->destroy)
        d->ops->destroy(d->self);
}

static void damping_update(damping *d, bodies *b, double dt)
{
    memset(b->damping_force, 0, sizeof b->damping_force);
    memset(b->damping_moment, 0, sizeof b->damping_moment);
    memset(b->alpha, 0, sizeof b->alpha);
    tl_damping_batch batch = {.size = sizeof batch,
                              .count = BODIES,
                              .dt = dt,
                              .mass = b->mass,
                              .inertia = b->inertia,
                              .alpha = b->alpha,
                              .state = d->state,
                              .moving_mass = b->mass,
                              .moving_inertia = b->inertia};
    for (int k = 0; k < 3; k++) {
        batch.velocity[k] = b->velocity[k];
        batch.angular_velocity[k] = b->spin[k];
        batch.force[k] = b->force[k];
        batch.moment[k] = b->moment[k];
        batch.force_before[k] = b->force_before[k];
        batch.moment_before[k] = b->moment_before[k];
        batch.damping_force[k] = b->damping_force[k];
        batch.damping_moment[k] = b->damping_moment[k];
    }
    tl_report report = {.size = sizeof report};
    CHECK_INT(d->ops->update(d->self, &batch, &report), TL_OK);
}

/* One body of mass 2 on the first axis. */
typedef struct oscillator {
    bodies b;
    double x, dt, kinetic_before;
    double ratio; /* the R the damping saw last */
} oscillator;

static void oscillator_start(oscillator *o, double x, double dt)
{
    memset(o, 0, sizeof *o);
    o->x = x;
    o->dt = dt;
    for (int i = 0; i < BODIES; i++)
        o->b.mass[i] = o->b.inertia[i] = 2;
}

/* One step under the force `force` per unit of mass. */
static void oscillator_step(oscillator *o, damping *d, double force)
{
    double *v = &o->b.velocity[0][0], dt = o->dt, mass = o->b.mass[0];
    double kinetic = 0.5 * mass * *v * *v;
    tl_damping_totals totals = {.size = sizeof totals,
                                .dt = dt,
                                .kinetic = kinetic,
                                .kinetic_rate = (kinetic - o->kinetic_before) / dt,
                                .power_unit = 2 * kinetic};
    o->kinetic_before = kinetic;
    tl_report report = {.size = sizeof report};
    if (d->ops->begin)
        CHECK_INT(d->ops->begin(d->self, &totals, d->state, &report), TL_OK);
    o->ratio = d->value * totals.power_unit / fabs(totals.kinetic_rate);
    o->b.force[0][0] = mass * force;
    damping_update(d, &o->b, dt);
    double a = o->b.alpha[0], d1 = 1 - a * dt / 2, d2 = 1 / (1 + a * dt / 2);
    *v = (d1 * *v + (o->b.force[0][0] + o->b.damping_force[0][0]) / mass * dt) * d2;
    o->x += *v * dt;
}

/* Amplitude ratios of `count` half cycles from rest at 1, circular frequency 1. */
static void half_cycles(damping *d, double dt, int count, double *ratios)
{
    oscillator o;
    oscillator_start(&o, 1, dt);
    double peak = 1;
    for (int n = 0; n < count;) {
        double before = o.b.velocity[0][0], x = o.x;
        oscillator_step(&o, d, -o.x);
        if (before * o.b.velocity[0][0] < 0) {
            ratios[n++] = fabs(x) / peak;
            peak = fabs(x);
        }
    }
}

TEST(none_does_nothing)
{
    damping d;
    tl_report report;
    CHECK_INT(damping_open(&d, "none", NULL, 0, &report), TL_OK);
    bodies b;
    memset(&b, 0, sizeof b);
    b.velocity[0][0] = b.force[1][0] = 3;
    damping_update(&d, &b, 0.1);
    for (int k = 0; k < 3; k++)
        CHECK(b.damping_force[k][0] == 0 && b.damping_moment[k][0] == 0 && b.alpha[0] == 0);
    CHECK(d.ops->step_factor(d.self) == 1);
    damping_close(&d);
}

TEST(viscous_has_the_discrete_amplitude)
{
    const double omega = 10, alpha = 1, dt = 0.01;
    const tl_value values[] = {NUMBER("alpha", alpha)};
    damping d;
    tl_report report;
    CHECK_INT(damping_open(&d, "viscous", values, 1, &report), TL_OK);
    CHECK(d.ops->step_factor(d.self) == 1);
    oscillator o;
    oscillator_start(&o, 1, dt);
    /* x(n+1) - T x(n) + D x(n-1) = 0 with T = 1 + D1 D2 - D2 w^2 dt^2 and D = D1 D2: the quadratic
     * form x1^2 - T x1 x0 + D x0^2 shrinks by D, the square of the amplitude's factor, each step. */
    double d2 = 1 / (1 + alpha * dt / 2), det = (1 - alpha * dt / 2) * d2;
    double trace = 1 + det - d2 * omega * omega * dt * dt, before = 0, last = 0;
    for (int n = 0; n < 500; n++) {
        double x0 = o.x;
        oscillator_step(&o, &d, -omega * omega * o.x);
        double form = o.x * o.x - trace * o.x * x0 + det * x0 * x0;
        if (n > 0)
            CHECK_REL(form / before, det, 1e-12);
        before = form;
        last = o.x;
    }
    CHECK(fabs(last) < 0.1);
    /* Terminal velocity g / alpha, a fixed point of (23). */
    oscillator_start(&o, 0, dt);
    for (int n = 0; n < 5000; n++)
        oscillator_step(&o, &d, 10);
    CHECK_REL(o.b.velocity[0][0], 10 / alpha, 1e-12);
    damping_close(&d);
}

TEST(local_works_on_each_component_alone)
{
    const tl_value values[] = {NUMBER("alpha", 0.5)};
    damping d;
    tl_report report;
    CHECK_INT(damping_open(&d, "local", values, 1, &report), TL_OK);
    bodies b;
    memset(&b, 0, sizeof b);
    const double velocity[3] = {2, -1e-9, 0}, force[3] = {-4, -6, 8};
    for (int k = 0; k < 3; k++) {
        b.velocity[k][1] = velocity[k];
        b.force[k][1] = force[k];
        b.spin[k][2] = -velocity[k];
        b.moment[k][2] = 10 * force[k];
    }
    damping_update(&d, &b, 0.1);
    const double expected[3] = {-2, 3, 0};
    for (int k = 0; k < 3; k++) {
        CHECK(b.damping_force[k][1] == expected[k]);
        CHECK(b.damping_moment[k][2] == -10 * expected[k]);
        CHECK(b.damping_force[k][0] == 0 && b.damping_moment[k][1] == 0);
    }
    CHECK(b.alpha[1] == 0);
    CHECK_REL(d.ops->step_factor(d.self), 1 / sqrt(1.5), 1e-15);
    damping_close(&d);
}

TEST(local_halves_amplitudes_by_the_closed_form)
{
    const double alphas[] = {0.1, 0.3, 0.5, 0.8};
    for (int n = 0; n < 4; n++) {
        const tl_value values[] = {NUMBER("alpha", alphas[n])};
        damping d;
        tl_report report;
        CHECK_INT(damping_open(&d, "local", values, 1, &report), TL_OK);
        double ratios[4], closed = sqrt((1 - alphas[n]) / (1 + alphas[n]));
        half_cycles(&d, 0.001, 4, ratios);
        /* Tolerance: a turning point falls between two steps, first order in omega dt. */
        for (int i = 0; i < 4; i++)
            CHECK_NEAR(ratios[i], closed, 0.002);
        damping_close(&d);
    }
}

TEST(combined_works_on_each_component_alone)
{
    const tl_value values[] = {NUMBER("alpha", 0.5)};
    damping d;
    tl_report report;
    CHECK_INT(damping_open(&d, "combined", values, 1, &report), TL_OK);
    bodies b;
    memset(&b, 0, sizeof b);
    /* Velocity, force, force before, and what is expected: both signs of the change with both signs of
     * the velocity, no change, no velocity. */
    const double cases[6][4] = {{1, -4, -3, -2}, {1, -4, -5, 0}, {-1, 4, 3, 2},
                                {-1, 4, 5, 0},   {2, 4, 4, -1},  {0, 4, 3, 0}};
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 3; k++) {
            b.velocity[k][i] = b.spin[k][i] = cases[i][0];
            b.force[k][i] = cases[i][1];
            b.force_before[k][i] = cases[i][2];
            b.moment[k][i] = 10 * cases[i][1];
            b.moment_before[k][i] = 10 * cases[i][2];
        }
    damping_update(&d, &b, 0.1);
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 3; k++) {
            CHECK(b.damping_force[k][i] == cases[i][3]);
            CHECK(b.damping_moment[k][i] == 10 * cases[i][3]);
        }
    CHECK_REL(d.ops->step_factor(d.self), 1 / sqrt(1.5), 1e-15);
    /* A vibration about a steady motion, v = 1 - cos / 10 under F = sin: local damping would only brake
     * the motion; this one brakes half as much and takes energy out of the vibration. */
    double drag = 0, local_drag = 0, power = 0, local_power = 0;
    const int period = 1000;
    for (int n = 0; n < period; n++) {
        double t = 2 * 3.14159265358979323846 / period, swing = -0.1 * cos(n * t);
        b.velocity[0][0] = 1 + swing;
        b.force_before[0][0] = sin((n - 1) * t);
        b.force[0][0] = sin(n * t);
        damping_update(&d, &b, 0.1);
        double local = -0.5 * fabs(b.force[0][0]);
        drag += b.damping_force[0][0] / period;
        power += b.damping_force[0][0] * swing / period;
        local_drag += local / period;
        local_power += local * swing / period;
    }
    CHECK(local_drag < -0.3);
    CHECK_NEAR(drag, 0.5 * local_drag, 2e-3);
    CHECK_NEAR(local_power, 0, 1e-15);
    /* alpha / 2 times the mean of |sin| |cos| / 10, 1 / (10 pi) */
    CHECK_NEAR(power, -0.25 * 0.1 / 3.14159265358979323846, 1e-4);
    damping_close(&d);
}

TEST(adaptive_holds_its_target_on_an_oscillator)
{
    const double targets[] = {0.3, 0.5, 0.8};
    for (int n = 0; n < 3; n++) {
        const tl_value values[] = {NUMBER("target", targets[n])};
        damping d;
        tl_report report;
        CHECK_INT(damping_open(&d, "adaptive", values, 1, &report), TL_OK);
        double ratios[6], closed = sqrt((1 - targets[n]) / (1 + targets[n]));
        half_cycles(&d, 0.002, 6, ratios);
        /* Tolerance: the servo may not follow alpha to infinity at a turning point. */
        for (int i = 0; i < 6; i++)
            CHECK_REL(ratios[i], closed, 0.05);
        damping_close(&d);
    }
}

TEST(adaptive_follows_free_fall_and_releases_steady_motion)
{
    damping d;
    tl_report report;
    CHECK_INT(damping_open(&d, "adaptive", NULL, 0, &report), TL_OK);
    oscillator o;
    oscillator_start(&o, 0, 0.01);
    /* Ideal servo: dv/dt = g / (1 + f), alpha t = f. Tolerance: the start. */
    int steps = 5000;
    for (int n = 0; n < steps; n++)
        oscillator_step(&o, &d, 10);
    double t = steps * o.dt;
    CHECK_REL(o.b.velocity[0][0] / t, 10 / 1.5, 0.02);
    CHECK_REL(d.value * t, 0.5, 0.1);
    CHECK_REL(o.ratio, 0.5, 0.05);
    /* Steady sliding: the force is gone, and soon the drag. */
    for (int n = 0; n < 400; n++)
        oscillator_step(&o, &d, 0);
    double coasting = o.b.velocity[0][0];
    for (int n = 0; n < 1000; n++)
        oscillator_step(&o, &d, 0);
    CHECK(coasting > 0.99 * 10 / 1.5 * t);
    CHECK_REL(o.b.velocity[0][0], coasting, 1e-3);
    damping_close(&d);
}

TEST(adaptive_stays_within_its_bounds)
{
    const tl_value values[] = {NUMBER("start", 0.5), NUMBER("minimum", 0.1), NUMBER("maximum", 2),
                               NUMBER("factor", 1.5)};
    damping d;
    tl_report report;
    CHECK_INT(damping_open(&d, "adaptive", values, 4, &report), TL_OK);
    CHECK(d.value == 0);
    oscillator o;
    oscillator_start(&o, 1, 0.01);
    oscillator_step(&o, &d, -o.x);
    CHECK(d.value == 0.5);
    double low = INFINITY, high = 0, step = 1;
    for (int n = 0; n < 3000; n++) {
        double before = d.value;
        oscillator_step(&o, &d, -o.x);
        low = fmin(low, d.value);
        high = fmax(high, d.value);
        step = fmax(step, fmax(before / d.value, d.value / before));
    }
    CHECK_NEAR(low, 0.1, 1e-15);
    CHECK_NEAR(high, 2, 1e-15);
    CHECK(step <= 1.5 * (1 + 1e-14) && step > 1.4);
    damping_close(&d);
    const tl_value crossed[] = {NUMBER("minimum", 3), NUMBER("maximum", 2)};
    CHECK_INT(damping_open(&d, "adaptive", crossed, 2, &report), TL_E_ARGUMENT);
    CHECK_TEXT(report.text, "minimum = 3 1/s must be <= maximum = 2 1/s");
}

/* Nothing moves, forever: the coefficient sinks to its bound and stays finite; then motion begins and it
 * is back within a few hundred steps. */
TEST(kinetic_stops_all_when_forces_brake)
{
    damping d;
    tl_report report;
    CHECK_INT(damping_open(&d, "kinetic", NULL, 0, &report), TL_OK);
    const double powers[] = {3, 0, -1e-30};
    for (int n = 0; n < 3; n++) {
        bodies b = {0};
        tl_damping_totals totals = {.size = sizeof totals, .dt = 0.1, .power = powers[n]};
        CHECK_INT(d.ops->begin(d.self, &totals, d.state, &report), TL_OK);
        damping_update(&d, &b, 0.1);
        for (int i = 0; i < BODIES; i++)
            CHECK(b.alpha[i] == (powers[n] < 0 ? 2 / 0.1 : 0));
        CHECK(b.damping_force[0][0] == 0 && b.damping_moment[2][0] == 0);
    }
    CHECK(d.ops->step_factor(d.self) == 1);
    damping_close(&d);
}

TEST(adaptive_survives_rest)
{
    damping d;
    tl_report report;
    CHECK_INT(damping_open(&d, "adaptive", NULL, 0, &report), TL_OK);
    oscillator o;
    oscillator_start(&o, 0, 0.01);
    for (int n = 0; n < 1000; n++)
        oscillator_step(&o, &d, 0);
    CHECK_REL(d.value, 1e-8 / 0.01, 1e-12);
    for (int n = 0; n < 500; n++)
        oscillator_step(&o, &d, 10);
    CHECK_REL(o.ratio, 0.5, 0.05);
    damping_close(&d);
}

int main(void)
{
    tl_plugins_load_default();
    RUN(none_does_nothing);
    RUN(viscous_has_the_discrete_amplitude);
    RUN(local_works_on_each_component_alone);
    RUN(local_halves_amplitudes_by_the_closed_form);
    RUN(combined_works_on_each_component_alone);
    RUN(adaptive_holds_its_target_on_an_oscillator);
    RUN(adaptive_follows_free_fall_and_releases_steady_motion);
    RUN(adaptive_stays_within_its_bounds);
    RUN(adaptive_survives_rest);
    RUN(kinetic_stops_all_when_forces_brake);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
