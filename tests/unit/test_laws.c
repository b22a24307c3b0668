/* test_laws.c - what every contact law must keep to, and what each of ours must do. The laws come
 * through the real loader, as a model gets them. */
#include "law_cases.h"

static double limit_of(double area, double f_n)
{
    return COHESION * area + f_n * tan(FRICTION * 3.14159265358979323846 / 180);
}

/* Random areas, in situ forces and increments around the strength of the joint; every seventh lane is
 * inert. */
static void randomize(lanes *p, uint64_t *seed, int first)
{
    for (int i = 0; i < LANES; i++) {
        if (i % 7 == 3)
            continue;
        if (first) {
            p->area[i] = 0.01 + check_random(seed);
            p->f_n0[i] = 1e5 * p->area[i] * (check_random(seed) - 0.3);
        }
        double closing = 4e-5 * (check_random(seed) - 0.5);
        p->closure[i] += closing;
        p->du_n[i] = -closing;
        for (int k = 0; k < 2; k++)
            p->du_s[k][i] = 2e-4 * (check_random(seed) - 0.5);
    }
}

TEST(batch_and_single_points_give_the_same_bits)
{
    for (int number = 0; number < LAWS; number++) {
        law l = open_number(number);
        lanes whole;
        lanes_reset(&l, &whole);
        uint64_t seed = 11;
        for (int step = 0; step < 50; step++) {
            randomize(&whole, &seed, step == 0);
            lanes before = whole, split = whole;
            law_step(&l, &whole, 0, LANES, 1);
            law_step(&l, &split, 0, 40, 1);
            law_step(&l, &split, 40, 24, 1);
            CHECK(memcmp(&whole, &split, sizeof whole) == 0);
            int i = step % LANES;
            lanes alone;
            lanes_reset(&l, &alone);
            alone.area[0] = before.area[i];
            alone.closure[0] = before.closure[i];
            alone.f_n0[0] = before.f_n0[i];
            alone.f_n[0] = before.f_n[i];
            for (int k = 0; k < 3; k++) {
                alone.du_s[k][0] = before.du_s[k][i];
                alone.f_s[k][0] = before.f_s[k][i];
            }
            for (int s = 0; s < STATES; s++)
                alone.state[s][0] = before.state[s][i];
            alone.flags[0] = before.flags[i];
            law_step(&l, &alone, 0, 8, 1);
            CHECK(alone.f_n[0] == whole.f_n[i] && alone.flags[0] == whole.flags[i]);
            CHECK(alone.stored[0] == whole.stored[i]);
            CHECK(alone.dissipated[0] == whole.dissipated[i]);
            for (int k = 0; k < 3; k++)
                CHECK(alone.f_s[k][0] == whole.f_s[k][i]);
            for (int s = 0; s < STATES; s++)
                CHECK(alone.state[s][0] == whole.state[s][i] || s >= (int)l.kind->state_count);
        }
        law_close(&l);
    }
}

TEST(energy_columns_do_not_change_the_forces)
{
    for (int number = 0; number < LAWS; number++) {
        law l = open_number(number);
        lanes with, without;
        lanes_reset(&l, &with);
        uint64_t seed = 5;
        for (int step = 0; step < 30; step++) {
            randomize(&with, &seed, step == 0);
            without = with;
            law_step(&l, &with, 0, LANES, 1);
            law_step(&l, &without, 0, LANES, 0);
            CHECK(memcmp(with.f_n, without.f_n, sizeof with.f_n) == 0);
            CHECK(memcmp(with.f_s, without.f_s, sizeof with.f_s) == 0);
            CHECK(memcmp(with.flags, without.flags, sizeof with.flags) == 0);
        }
        law_close(&l);
    }
}

TEST(zero_increment_leaves_forces_unchanged)
{
    for (int number = 0; number < LAWS; number++) {
        if (law_cases[number].ages)
            continue;
        law l = open_number(number);
        lanes p;
        lanes_reset(&l, &p);
        uint64_t seed = 23;
        int slipping = 0;
        for (int step = 0; step < 200; step++) {
            randomize(&p, &seed, step == 0);
            law_step(&l, &p, 0, LANES, 1);
            for (int i = 0; i < LANES; i++)
                slipping += p.flags[i] == TL_POINT_SLIPPING;
            lanes still = p;
            memset(still.du_n, 0, sizeof still.du_n);
            memset(still.du_s, 0, sizeof still.du_s);
            law_step(&l, &still, 0, LANES, 1);
            CHECK(memcmp(still.f_n, p.f_n, sizeof p.f_n) == 0);
            CHECK(memcmp(still.f_s, p.f_s, sizeof p.f_s) == 0);
            CHECK(memcmp(still.state, p.state, sizeof p.state) == 0);
        }
        /* The hard case, a point exactly at its limit, must have occurred. */
        CHECK(slipping > 0 || number != 1);
        law_close(&l);
    }
}

TEST(inert_lanes_stay_zero_and_all_is_finite)
{
    for (int number = 0; number < LAWS; number++) {
        law l = open_number(number);
        lanes p;
        lanes_reset(&l, &p);
        uint64_t seed = 31;
        for (int step = 0; step < 100; step++) {
            randomize(&p, &seed, step == 0);
            law_step(&l, &p, 0, LANES, 1);
            for (int i = 0; i < LANES; i++) {
                CHECK(isfinite(p.f_n[i]) && isfinite(lane_shear(&p, i)));
                CHECK(isfinite(p.stored[i]) && p.stored[i] >= 0);
                CHECK(isfinite(p.dissipated[i]) && p.dissipated[i] >= 0);
                if (i % 7 == 3)
                    CHECK(p.f_n[i] == 0 && lane_shear(&p, i) == 0 && p.stored[i] == 0 && p.dissipated[i] == 0);
            }
        }
        law_close(&l);
    }
}

TEST(nan_reaches_the_forces)
{
    for (int number = 0; number < LAWS; number++) {
        law l = open_number(number);
        lanes p;
        lanes_reset(&l, &p);
        p.area[0] = p.area[1] = 1;
        p.closure[0] = NAN;
        p.du_s[0][1] = NAN;
        law_step(&l, &p, 0, 8, 1);
        CHECK(isnan(p.f_n[0]));
        CHECK(isnan(p.f_s[0][1]));
        law_close(&l);
    }
}

/* The work of the walls on lane i in one step: mean forces times increments. */
static double work_of(const lanes *before, const lanes *after, int i)
{
    double work = 0.5 * (before->f_n[i] + after->f_n[i]) * -after->du_n[i];
    for (int k = 0; k < 3; k++)
        work -= 0.5 * (before->f_s[k][i] + after->f_s[k][i]) * after->du_s[k][i];
    return work;
}

/* Shear under constant closure: work = change of stored energy + heat, to rounding, for any path that
 * does not jump across the yield surface in one step. */
TEST(shear_work_is_stored_or_dissipated)
{
    for (int number = 0; number < LAWS; number++) {
        law l = open_number(number);
        lanes p;
        lanes_reset(&l, &p);
        p.area[0] = 0.5;
        p.closure[0] = 1e-4;
        law_step(&l, &p, 0, 8, 1);
        double work = 0, heat = 0, start = p.stored[0], turnover = 0;
        for (int step = 0; step < 4000; step++) {
            double angle = step * 1e-2;
            p.du_s[0][0] = 2e-6 * cos(angle);
            p.du_s[1][0] = 1e-6 * sin(0.7 * angle);
            lanes before = p;
            law_step(&l, &p, 0, 8, 1);
            double w = work_of(&before, &p, 0);
            work += w;
            turnover += fabs(w);
            heat += p.dissipated[0];
        }
        /* Tolerance: roundings of 4000 steps of like size. */
        CHECK_NEAR(work, p.stored[0] - start + heat, 1e-12 * turnover);
        CHECK(heat > 0 || number == 0);
        law_close(&l);
    }
}

/* Error of the energies of a law, over the most that was stored, while walls that slide are pressed together and let go in `steps`
 * steps. */
static double error_of(const law *l, int steps)
{
    lanes p;
    lanes_reset(l, &p);
    p.area[0] = 0.5;
    p.closure[0] = 1e-4;
    law_step(l, &p, 0, 8, 1);
    double work = 0, heat = 0, start = p.stored[0], most = start;
    for (int step = 1; step <= steps; step++) {
        double turn = 6.283185307179586 * step / steps, closure = 1e-4 + 5e-5 * sin(turn);
        p.du_n[0] = p.closure[0] - closure;
        p.closure[0] = closure;
        p.du_s[0][0] = 1e-3 / steps;
        lanes before = p;
        law_step(l, &p, 0, 8, 1);
        work += work_of(&before, &p, 0);
        heat += p.dissipated[0];
        most = fmax(most, p.stored[0]);
    }
    return fabs(p.stored[0] - start + heat - work) / most;
}

/* Walls that move while slip opens the joint: what slip pays for that is of the second order of the step, too. */
TEST(walls_that_slide_and_close_balance_to_the_second_order)
{
    for (int number = 0; number < LAWS; number++) {
        law l = open_number(number);
        /* Four times the steps: a quarter of an error of the first order, 1/16 of one of the second; between them, for forces bend. */
        double coarse = error_of(&l, 1000), fine = error_of(&l, 4000);
        CHECK(fine <= fmax(coarse / 8, 1e-12)); /* which is rounding */
        law_close(&l);
    }
}

enum { STEPS = 400, CYCLES = 5 };

/* Closed paths of all lanes through the law, their shapes drawn from `seed`: the work of the walls and the
 * most that was ever stored. */
static void closed_cycles(const law *l, lanes *p, uint64_t *seed, double *work, double *peak)
{
    double amplitude[3][LANES], phase[3][LANES], last[3][LANES] = {{0}};
    lanes_reset(l, p);
    for (int i = 0; i < LANES; i++) {
        p->area[i] = 1;
        work[i] = peak[i] = 0;
        for (int k = 0; k < 3; k++) {
            amplitude[k][i] = (k == 0 ? 5e-5 : 3e-4) * check_random(seed);
            phase[k][i] = 6.28 * check_random(seed);
        }
    }
    law_step(l, p, 0, LANES, 1);
    for (int step = 1; step <= CYCLES * STEPS; step++) {
        double t = 6.283185307179586 * step / STEPS;
        for (int i = 0; i < LANES; i++) {
            double at[3];
            for (int k = 0; k < 3; k++)
                at[k] = amplitude[k][i] * (sin(t * (k + 1) + phase[k][i]) - sin(phase[k][i]));
            p->du_n[i] = -(at[0] - last[0][i]);
            p->closure[i] = at[0];
            p->du_s[0][i] = at[1] - last[1][i];
            p->du_s[1][i] = at[2] - last[2][i];
            for (int k = 0; k < 3; k++)
                last[k][i] = at[k];
        }
        lanes before = *p;
        law_step(l, p, 0, LANES, 1);
        for (int i = 0; i < LANES; i++) {
            work[i] += work_of(&before, p, i);
            peak[i] = fmax(peak[i], p->stored[i]);
        }
    }
}

/* Random closed paths of closing and shear, in small steps, over opening and slip: what comes out is
 * never more than was put in. */
TEST(closed_cycles_make_no_energy)
{
    for (int number = 0; number < LAWS; number++) {
        law l = open_number(number);
        uint64_t seed = 77;
        for (int round = 0; round < 8; round++) {
            lanes p;
            double work[LANES], peak[LANES];
            closed_cycles(&l, &p, &seed, work, peak);
            /* Tolerance: opening falls between two steps, which misplaces 1/STEPS of the energy. */
            for (int i = 0; i < LANES; i++)
                CHECK(work[i] - p.stored[i] >= -(number == 0 ? 1e-9 : 2.0 / STEPS) * peak[i]);
        }
        law_close(&l);
    }
}

/* Slip under constant closure opens the joint by tan(dilation) a unit, which presses it; the work that
 * does not go into that is heat. */
TEST(dilation_opens_and_presses_the_joint)
{
    const double rad = 3.14159265358979323846 / 180, area = 0.5, x0 = 1e-5;
    law l = open_number(3);
    lanes p;
    lanes_reset(&l, &p);
    p.area[0] = area;
    p.closure[0] = x0;
    law_step(&l, &p, 0, 8, 1);
    double work = 0, heat = 0, slip = 0, start = p.stored[0];
    for (int step = 0; step < 1000; step++) {
        p.du_s[0][0] = 1e-6;
        lanes before = p;
        law_step(&l, &p, 0, 8, 1);
        work += work_of(&before, &p, 0);
        heat += p.dissipated[0];
        /* du = elastic + plastic */
        slip += 1e-6 + (p.f_s[0][0] - before.f_s[0][0]) / (KS * area);
    }
    CHECK_REL(p.state[0][0], slip * tan(DILATION * rad), 1e-12);
    CHECK_REL(p.f_n[0], KN * area * (x0 + p.state[0][0]), 1e-14);
    CHECK_REL(-p.f_s[0][0], limit_of(area, p.f_n[0]), 1e-14);
    CHECK_REL(work, p.stored[0] - start + heat, 1e-12);
    /* (c A + f_n (tan(friction) - tan(dilation))) slip, f_n growing linearly. Tolerance: the step in
     * which slip begins. */
    double mean = 0.5 * (KN * area * x0 + p.f_n[0]);
    double split = tan(FRICTION * rad) - tan(DILATION * rad);
    CHECK_REL(heat, (COHESION * area + mean * split) * slip, 2e-3);
    /* Without shear, unloading goes back along the same line, down to opening, and up again. */
    const double opening = p.state[0][0];
    const double closures[] = {-0.5 * opening, -2 * opening, -0.9 * opening, x0};
    p.du_s[0][0] = p.f_s[0][0] / (KS * area);
    law_step(&l, &p, 0, 8, 1);
    p.du_s[0][0] = 0;
    for (int k = 0; k < 4; k++) {
        p.closure[0] = closures[k];
        law_step(&l, &p, 0, 8, 1);
        CHECK_REL(p.f_n[0], fmax(0, KN * area * (closures[k] + opening)), 1e-14);
        CHECK(p.state[0][0] == opening);
    }
    law_close(&l);
}

TEST(dilation_ends_at_its_limit_and_may_not_exceed_friction)
{
    const double rad = 3.14159265358979323846 / 180;
    law l = open_number(4);
    lanes p;
    lanes_reset(&l, &p);
    p.area[0] = 1;
    p.closure[0] = 1e-4;
    for (int step = 0; step < 100; step++) {
        p.du_s[1][0] = step % 20 < 10 ? 1e-4 : -1e-4;
        law_step(&l, &p, 0, 8, 1);
        CHECK(p.dissipated[0] >= 0);
    }
    CHECK_REL(p.state[1][0], 2e-4 * tan(20 * rad), 1e-14);
    law_close(&l);
    const char *const names[] = {"coulomb", "coulomb_tensile"};
    const tl_value steep[] = {NUMBER("kn", KN), NUMBER("ks", KS), NUMBER("friction", 10), NUMBER("dilation", 11)};
    for (int k = 0; k < 2; k++) {
        const tl_kind *kind = tl_plugin_find(TL_KIND_LAW, names[k]);
        const tl_law_ops *ops = kind->ops;
        double params[32];
        void *self = NULL;
        tl_error error = {TL_OK, ""};
        tl_report report = {.size = sizeof report};
        const tl_args args = {steep, 4};
        CHECK_INT(
            tl_args_read(kind->params, kind->param_count, kind->param_stride, &args, false, params, names[k], &error),
            TL_OK);
        CHECK_INT(ops->create(params, &self, &report), TL_E_ARGUMENT);
        CHECK_TEXT(report.text, "dilation = 11 deg must be <= friction = 10 deg, or slip would make energy");
    }
}

TEST(elastic_carries_tension_without_limit)
{
    law l = open_number(0);
    lanes p;
    lanes_reset(&l, &p);
    p.area[0] = 2;
    p.closure[0] = -1e-3;
    p.f_n0[0] = 5e4;
    p.du_s[1][0] = 1e-2;
    law_step(&l, &p, 0, 8, 1);
    CHECK_REL(p.f_n[0], -KN * 2 * 1e-3 + 5e4, 1e-15);
    CHECK_REL(p.f_s[1][0], -KS * 2 * 1e-2, 1e-15);
    CHECK_INT(p.flags[0], 0);
    double stored = p.f_n[0] * p.f_n[0] / (2 * KN * 2) + p.f_s[1][0] * p.f_s[1][0] / (2 * KS * 2);
    CHECK_REL(p.stored[0], stored, 1e-14);
    double kn, ks;
    l.ops->stiffness(law_self(&l), &kn, &ks);
    CHECK(kn == KN && ks == KS);
    law_close(&l);
}

TEST(coulomb_keeps_to_its_limit)
{
    law l = open_number(1);
    lanes p;
    lanes_reset(&l, &p);
    uint64_t seed = 3;
    int slipping = 0, open = 0;
    for (int step = 0; step < 300; step++) {
        randomize(&p, &seed, step == 0);
        law_step(&l, &p, 0, LANES, 1);
        for (int i = 0; i < LANES; i++) {
            double limit = limit_of(p.area[i], p.f_n[i]), shear = lane_shear(&p, i);
            CHECK(p.f_n[i] >= 0);
            CHECK(shear <= limit * (1 + 1e-14));
            if (p.flags[i] == TL_POINT_SLIPPING) {
                slipping++;
                CHECK_REL(shear, limit, 1e-14);
            }
            if (p.flags[i] == TL_POINT_OPEN) {
                open++;
                CHECK(p.f_n[i] == 0 && shear == 0);
            }
        }
    }
    CHECK(slipping > 100);
    CHECK(open > 100);
    law_close(&l);
}

TEST(friction_opposes_the_motion_of_b)
{
    law l = open_number(1);
    lanes p;
    lanes_reset(&l, &p);
    p.area[0] = 1;
    p.closure[0] = 1e-4;
    p.du_s[0][0] = 1;
    law_step(&l, &p, 0, 8, 1);
    CHECK_REL(p.f_s[0][0], -limit_of(1, KN * 1e-4), 1e-14);
    CHECK_INT(p.flags[0], TL_POINT_SLIPPING);
    law_close(&l);
}

TEST(coulomb_reloads_only_after_its_gap_is_closed)
{
    law l = open_number(1);
    lanes p;
    lanes_reset(&l, &p);
    p.area[0] = 1;
    const double closure[] = {1e-5, -1e-5, -5e-6, 2e-6};
    const double f_n[] = {KN * 1e-5, 0, 0, KN * 2e-6};
    const uint32_t flags[] = {0, TL_POINT_OPEN, TL_POINT_OPEN, 0};
    for (int step = 0; step < 4; step++) {
        p.closure[0] = closure[step];
        law_step(&l, &p, 0, 8, 1);
        CHECK_REL(p.f_n[0], f_n[step], 1e-15);
        CHECK_INT(p.flags[0], flags[step]);
    }
    law_close(&l);
}

TEST(bond_holds_its_tensile_strength_and_snaps_beyond)
{
    law l = open_number(2);
    lanes p;
    lanes_reset(&l, &p);
    p.area[0] = 0.5;
    p.closure[0] = -TENSION / KN * (1 - 1e-12);
    law_step(&l, &p, 0, 8, 1);
    CHECK_REL(p.f_n[0], -TENSION * 0.5, 1e-11);
    CHECK_INT(p.flags[0], 0);
    CHECK(p.state[0][0] == 1 && p.dissipated[0] == 0);
    p.closure[0] = -TENSION / KN * (1 + 1e-12);
    law_step(&l, &p, 0, 8, 1);
    CHECK(p.f_n[0] == 0 && p.state[0][0] == 0);
    CHECK_INT(p.flags[0], TL_POINT_OPEN | TL_POINT_FAILED);
    /* The spring's energy at the strength: T^2 A / (2 kn). */
    CHECK_REL(p.dissipated[0], TENSION * TENSION * 0.5 / (2 * KN), 1e-11);
    p.closure[0] = 1e-6;
    law_step(&l, &p, 0, 8, 1);
    CHECK_REL(p.f_n[0], KN * 0.5 * 1e-6, 1e-14);
    CHECK_INT(p.flags[0], TL_POINT_FAILED);
    p.closure[0] = -1e-9;
    law_step(&l, &p, 0, 8, 1);
    CHECK(p.f_n[0] == 0 && p.dissipated[0] == 0);
    CHECK_INT(p.flags[0], TL_POINT_OPEN | TL_POINT_FAILED);
    law_close(&l);
}

TEST(bond_breaks_in_shear_to_its_residual)
{
    law l = open_number(2);
    lanes p;
    lanes_reset(&l, &p);
    p.area[0] = 1;
    p.closure[0] = 1e-5;
    double f_n = KN * 1e-5, peak = limit_of(1, f_n), residual = peak - COHESION;
    p.du_s[0][0] = -0.999 * peak / KS;
    law_step(&l, &p, 0, 8, 1);
    CHECK_REL(p.f_s[0][0], 0.999 * peak, 1e-14);
    CHECK_INT(p.flags[0], 0);
    p.du_s[0][0] = -0.002 * peak / KS;
    law_step(&l, &p, 0, 8, 1);
    CHECK_REL(p.f_s[0][0], residual, 1e-14);
    CHECK_INT(p.flags[0], TL_POINT_SLIPPING | TL_POINT_FAILED);
    CHECK(p.state[0][0] == 0);
    p.du_s[0][0] = 1e-3 * residual / KS;
    law_step(&l, &p, 0, 8, 1);
    CHECK_REL(p.f_s[0][0], 0.999 * residual, 1e-14);
    CHECK_INT(p.flags[0], TL_POINT_FAILED);
    law_close(&l);
}

TEST(residual_strengths_are_the_ones_given)
{
    const tl_value values[] = {NUMBER("kn", KN),
                               NUMBER("ks", KS),
                               NUMBER("friction", 40),
                               NUMBER("cohesion", COHESION),
                               NUMBER("tension", TENSION),
                               NUMBER("residual_friction", FRICTION),
                               NUMBER("residual_cohesion", COHESION / 4),
                               NUMBER("residual_tension", TENSION / 4)};
    law l = law_open("coulomb_tensile", &(tl_args){values, 8});
    lanes p;
    lanes_reset(&l, &p);
    p.area[0] = 1;
    p.closure[0] = 1e-5;
    p.du_s[1][0] = 1;
    law_step(&l, &p, 0, 8, 1);
    CHECK_REL(lane_shear(&p, 0), limit_of(1, KN * 1e-5) - 0.75 * COHESION, 1e-14);
    p.du_s[1][0] = 0;
    p.closure[0] = -0.999 * TENSION / 4 / KN;
    law_step(&l, &p, 0, 8, 1);
    CHECK_REL(p.f_n[0], -0.999 * TENSION / 4, 1e-12);
    p.closure[0] = -1.001 * TENSION / 4 / KN;
    law_step(&l, &p, 0, 8, 1);
    CHECK(p.f_n[0] == 0 && lane_shear(&p, 0) == 0);
    law_close(&l);
}

/* The law sees no direction but those of its vectors: permuted axes give permuted forces. */
TEST(laws_do_not_know_the_axes)
{
    for (int number = 0; number < LAWS; number++) {
        law l = open_number(number);
        lanes p, q;
        lanes_reset(&l, &p);
        uint64_t seed = 9;
        randomize(&p, &seed, 1);
        q = p;
        for (int step = 0; step < 30; step++) {
            randomize(&p, &seed, 0);
            memcpy(q.closure, p.closure, sizeof q.closure);
            for (int k = 0; k < 3; k++)
                memcpy(q.du_s[(k + 1) % 3], p.du_s[k], sizeof p.du_s[k]);
            law_step(&l, &p, 0, LANES, 1);
            law_step(&l, &q, 0, LANES, 1);
            /* Tolerance: the squares are summed in another order. */
            for (int i = 0; i < LANES; i++)
                for (int k = 0; k < 3; k++)
                    CHECK_NEAR(q.f_s[(k + 1) % 3][i], p.f_s[k][i], 1e-13 * lane_shear(&p, i));
        }
        law_close(&l);
    }
}

int main(void)
{
    tl_plugins_load_default();
    RUN(batch_and_single_points_give_the_same_bits);
    RUN(energy_columns_do_not_change_the_forces);
    RUN(zero_increment_leaves_forces_unchanged);
    RUN(inert_lanes_stay_zero_and_all_is_finite);
    RUN(nan_reaches_the_forces);
    RUN(shear_work_is_stored_or_dissipated);
    RUN(walls_that_slide_and_close_balance_to_the_second_order);
    RUN(closed_cycles_make_no_energy);
    RUN(dilation_opens_and_presses_the_joint);
    RUN(dilation_ends_at_its_limit_and_may_not_exceed_friction);
    RUN(elastic_carries_tension_without_limit);
    RUN(coulomb_keeps_to_its_limit);
    RUN(friction_opposes_the_motion_of_b);
    RUN(coulomb_reloads_only_after_its_gap_is_closed);
    RUN(bond_holds_its_tensile_strength_and_snaps_beyond);
    RUN(bond_breaks_in_shear_to_its_residual);
    RUN(residual_strengths_are_the_ones_given);
    RUN(laws_do_not_know_the_axes);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
