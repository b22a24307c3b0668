/* solid_returns.c - returns of Mohr-Coulomb's surface from random stresses, against a linear complementarity problem
 * over all nine planes of unsorted principal stresses: six of shear, three of tension. All sets of up to three planes
 * are tried. So neither order nor regions are presumed, as the solids' own returns do. */
#include "solid_zones.h"

#define DEGREE (3.14159265358979323846 / 180)

typedef struct rock {
    double bulk, shear, cohesion, friction, dilation, tension; /* Pa and deg */
} rock;

typedef struct planes {
    double normal[9][3], taken[9][3], limit[9]; /* taken: stress that a unit of flow takes off */
} planes;

static void list_planes(const rock *r, planes *p)
{
    double f = sin(r->friction * DEGREE), d = sin(r->dilation * DEGREE), lame = r->bulk - 2 * r->shear / 3;
    int count = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double flow[3] = {0, 0, 0};
            memset(p->normal[count], 0, sizeof p->normal[count]);
            if (i != j) {
                p->normal[count][i] = 1 + f;
                p->normal[count][j] = -(1 - f);
                flow[i] = 1 + d;
                flow[j] = -(1 - d);
                p->limit[count] = 2 * r->cohesion * cos(r->friction * DEGREE);
            } else {
                p->normal[count][i] = flow[i] = 1;
                p->limit[count] = r->tension;
            }
            for (int k = 0; k < 3; k++)
                p->taken[count][k] = lame * (flow[0] + flow[1] + flow[2]) + 2 * r->shear * flow[k];
            count++;
        }
}

static double over(const planes *p, int k, const double s[3])
{
    return p->normal[k][0] * s[0] + p->normal[k][1] * s[1] + p->normal[k][2] * s[2] - p->limit[k];
}

/* Solves for the flows of up to three planes; 0 where they are not independent. */
static int solve(double a[3][4], int n, double x[3])
{
    for (int c = 0; c < n; c++) {
        int pivot = c;
        for (int r = c + 1; r < n; r++)
            if (fabs(a[r][c]) > fabs(a[pivot][c]))
                pivot = r;
        if (fabs(a[pivot][c]) < 1e-9)
            return 0;
        for (int k = 0; k <= n; k++) {
            double swap = a[c][k];
            a[c][k] = a[pivot][k];
            a[pivot][k] = swap;
        }
        for (int r = 0; r < n; r++)
            for (int k = n; r != c && k >= c; k--)
                a[r][k] -= a[r][c] / a[c][c] * a[c][k];
    }
    for (int c = 0; c < n; c++)
        x[c] = a[c][n] / a[c][c];
    return 1;
}

/* The stress that a set of planes leads to; 0 where a flow is backward or another plane is exceeded. */
static int try_set(const planes *p, const rock *r, const double s[3], const int *set, int n, double scale,
                   double out[3])
{
    double a[3][4], flow[3];
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++)
            a[i][j] = (p->normal[set[i]][0] * p->taken[set[j]][0] + p->normal[set[i]][1] * p->taken[set[j]][1] +
                       p->normal[set[i]][2] * p->taken[set[j]][2]) /
                      r->shear;
        a[i][n] = over(p, set[i], s);
    }
    if (!solve(a, n, flow))
        return 0;
    double most = 0;
    for (int i = 0; i < n; i++)
        most = fmax(most, fabs(flow[i]));
    for (int k = 0; k < 3; k++)
        out[k] = s[k];
    for (int i = 0; i < n; i++) {
        if (flow[i] < -1e-12 * most)
            return 0;
        for (int k = 0; k < 3; k++)
            out[k] -= flow[i] / r->shear * p->taken[set[i]][k];
    }
    for (int k = 0; k < 9; k++)
        if (over(p, k, out) > 1e-10 * scale)
            return 0;
    return 1;
}

/* The return of principal stresses; 0: no set of planes does it. */
static int complementarity(const rock *r, const double s[3], double out[3])
{
    planes p;
    list_planes(r, &p);
    double scale = fabs(s[0]) + fabs(s[1]) + fabs(s[2]) + p.limit[1] + r->tension, most = 0;
    for (int k = 0; k < 9; k++)
        most = fmax(most, over(&p, k, s));
    memcpy(out, s, 3 * sizeof *out);
    if (most <= 1e-12 * scale)
        return 1;
    for (int a = 0; a < 9; a++)
        if (try_set(&p, r, s, (int[]){a}, 1, scale, out))
            return 1;
    for (int a = 0; a < 9; a++)
        for (int b = a + 1; b < 9; b++)
            if (try_set(&p, r, s, (int[]){a, b}, 2, scale, out))
                return 1;
    for (int a = 0; a < 9; a++)
        for (int b = a + 1; b < 9; b++)
            for (int c = b + 1; c < 9; c++)
                if (try_set(&p, r, s, (int[]){a, b, c}, 3, scale, out))
                    return 1;
    return 0;
}

static double apart(const double a[3], const double b[3])
{
    return fmax(fabs(a[0] - b[0]), fmax(fabs(a[1] - b[1]), fabs(a[2] - b[2])));
}

static rock any_rock(uint64_t *seed)
{
    rock r;
    double poisson = 0.49 * check_random(seed) - (check_random(seed) < 0.1 ? 0.3 : 0);
    double young = 1e10;
    r.bulk = young / 3 / (1 - 2 * poisson);
    r.shear = young / 2 / (1 + poisson);
    r.cohesion = 1e6 * (0.1 + check_random(seed));
    r.friction = check_random(seed) < 0.15 ? 0 : 60 * check_random(seed);
    double share = check_random(seed);
    r.dilation = r.friction * (share < 0.3 ? 0 : share < 0.6 ? 1 : check_random(seed));
    double apex = r.friction > 0 ? r.cohesion / tan(r.friction * DEGREE) : 3e6;
    share = check_random(seed);
    r.tension = apex * (share < 0.2 ? 0 : share < 0.4 ? 1 : check_random(seed));
    return r;
}

static int make_rock(zones *z, const rock *r)
{
    const tl_value values[] = {tl_arg_number("bulk", r->bulk),         tl_arg_number("shear", r->shear),
                               tl_arg_number("cohesion", r->cohesion), tl_arg_number("friction", r->friction),
                               tl_arg_number("dilation", r->dilation), tl_arg_number("tension", r->tension)};
    return zones_make(z, "mohr_coulomb", values, sizeof values / sizeof *values);
}

static void begin_zone(zones *z, size_t i, uint64_t *seed)
{
    double size = 1e6 * pow(10, 1.5 * zones_any(seed)), mean = size * zones_any(seed);
    double alike = check_random(seed) < 0.2 ? 1e-9 : 1;
    for (int k = 0; k < 6; k++) {
        STRESS(z, k, i) = size * alike * zones_any(seed) + (k < 3 ? mean : 0);
        if (check_random(seed) < 0.1)
            STRESS(z, k, i) = 0;
        STRAIN(z, k, i) = 0;
    }
}

static double worst_off, worst_over;
static int by_flag[4];

TEST(returns_are_those_of_the_nine_planes)
{
    uint64_t seed = 1953;
    for (int n = 0; n < check_cases(2000); n++) {
        zones z;
        rock r = any_rock(&seed);
        double before[ZONES][6];
        if (!make_rock(&z, &r))
            return;
        for (size_t i = 0; i < ZONES; i++) {
            begin_zone(&z, i, &seed);
            for (int k = 0; k < 6; k++)
                before[i][k] = STRESS(&z, k, i);
        }
        zones_step(&z);
        planes p;
        list_planes(&r, &p);
        for (size_t i = 0; i < ZONES; i++) {
            double after[6], trial[3], got[3], wanted[3];
            for (int k = 0; k < 6; k++)
                after[k] = STRESS(&z, k, i);
            zones_principal(before[i], trial);
            zones_principal(after, got);
            double scale = fabs(trial[0]) + fabs(trial[2]) + p.limit[1];
            int found = complementarity(&r, trial, wanted);
            if (found) {
                double off = apart(got, wanted) / scale;
                worst_off = fmax(worst_off, off);
                if (off > 1e-9)
                    printf("friction %.17g dilation %.17g cohesion %g tension %.17g bulk %g shear %g, trial %.17g "
                           "%.17g %.17g: "
                           "%.10g %.10g %.10g, wanted %.10g %.10g %.10g flags %u\n",
                           r.friction, r.dilation, r.cohesion, r.tension, r.bulk, r.shear, trial[0], trial[1], trial[2],
                           got[0], got[1], got[2], wanted[0], wanted[1], wanted[2], z.flags[i]);
                CHECK(off <= 1e-9);
            }
            CHECK(found);
            for (int k = 0; k < 9; k++)
                worst_over = fmax(worst_over, over(&p, k, got) / scale);
            by_flag[z.flags[i] & 3]++;
        }
        tl_solid_clear(&z.solid);
    }
    CHECK(worst_over <= 1e-12);
    printf("off the nine planes by %.2g, over the surface by %.2g; %d elastic, %d shear, %d tension, %d both\n",
           worst_off, worst_over, by_flag[0], by_flag[1], by_flag[2], by_flag[3]);
}

/* ---------------------------------------------------------------- the other surfaces ----- */

/* Principal plastic strains of a return: what it has taken off the principal stresses, over the moduli. */
static void plastic_of(double bulk, double shear, const double trial[3], const double got[3], double out[3])
{
    double mean = (trial[0] - got[0] + trial[1] - got[1] + trial[2] - got[2]) / 3;
    for (int k = 0; k < 3; k++)
        out[k] = (trial[k] - got[k] - mean) / (2 * shear) + mean / (3 * bulk);
}

/* Hoek-Brown: the stress is on the surface; the flow has the dilation that it should have, none is backward, and s2 takes
 * part only where it equals another. */
static void check_hoek_brown(const double trial[3], const double got[3], uint32_t flags, double sine)
{
    const double bulk = 1e10 / 1.5, shear = 4e9, sigma = 5e7, m = 3, s = 0.01, a = 0.52;
    double x = s - m * got[0] / sigma, strength = sigma * pow(x > 0 ? x : 0, a), plastic[3];
    double scale = fabs(trial[0]) + fabs(trial[2]) + strength;
    /* at the apex the surface is so steep that roundings of s1 count */
    double rounded = x + m * 1e-14 * scale / sigma, reach = sigma * pow(rounded > 0 ? rounded : 0, a);
    CHECK(got[0] - got[2] - reach <= 1e-12 * scale && got[0] <= s * sigma / m + 1e-12 * scale);
    plastic_of(bulk, shear, trial, got, plastic);
    double size = fabs(plastic[0]) + fabs(plastic[2]), enough = 1e-9 * size + 1e-11 * scale / shear;
    if (!(flags & (TL_ZONE_SHEAR | TL_ZONE_TENSION))) {
        CHECK(size <= 1e-12 * scale / shear);
        return;
    }
    CHECK(plastic[0] >= -enough);
    if (flags & TL_ZONE_TENSION) {
        CHECK_NEAR(got[0], s * sigma / m, 1e-12 * scale);
        CHECK(plastic[0] + plastic[1] + plastic[2] >= -enough);
        return;
    }
    double slope = 1 + a * m * pow(x, a - 1), tangent = (slope - 1) / (slope + 1),
           flow = sine < tangent ? sine : tangent;
    double up = plastic[0] + fmax(plastic[1], 0), down = -plastic[2] - fmin(plastic[1], 0);
    CHECK_NEAR(up * (1 - flow), down * (1 + flow), 1e-7 * size + enough);
    CHECK(fabs(plastic[1]) <= 1e-7 * size + enough ||
          fabs(got[1] - (plastic[1] > 0 ? got[0] : got[2])) <= 1e-9 * scale);
}

TEST(returns_of_hoek_brown_flow_as_they_should)
{
    static const double angles[] = {0, 12, 70};
    uint64_t seed = 2002;
    for (int n = 0; n < check_cases(600); n++) {
        zones z;
        double before[ZONES][6], angle = angles[n % 3];
        const tl_value values[] = {tl_arg_number("young", 1e10),    tl_arg_number("poisson", 0.25),
                                   tl_arg_number("sigma_ci", 5e7),  tl_arg_number("mb", 3),
                                   tl_arg_number("s", 0.01),        tl_arg_number("a", 0.52),
                                   tl_arg_number("dilation", angle)};
        if (!zones_make(&z, "hoek_brown", values, sizeof values / sizeof *values))
            return;
        for (size_t i = 0; i < ZONES; i++) {
            begin_zone(&z, i, &seed);
            for (int k = 0; k < 6; k++)
                before[i][k] = STRESS(&z, k, i);
        }
        zones_step(&z);
        for (size_t i = 0; i < ZONES; i++) {
            double after[6], trial[3], got[3];
            for (int k = 0; k < 6; k++)
                after[k] = STRESS(&z, k, i);
            zones_principal(before[i], trial);
            zones_principal(after, got);
            check_hoek_brown(trial, got, z.flags[i], sin(angle * DEGREE));
        }
        tl_solid_clear(&z.solid);
    }
}

/* Rock and weak plane: neither is exceeded, and a second return changes nothing. */
TEST(returns_of_rock_and_weak_plane_meet_both)
{
    uint64_t seed = 1987;
    int both = 0, short_of = 0;
    double worst = 0;
    for (int n = 0; n < check_cases(1000); n++) {
        zones z;
        rock r = any_rock(&seed);
        planes p;
        double t = tan(40 * check_random(&seed) * DEGREE), c = 5e5 * check_random(&seed);
        const tl_value values[] = {tl_arg_number("bulk", r.bulk),
                                   tl_arg_number("shear", r.shear),
                                   tl_arg_number("cohesion", r.cohesion),
                                   tl_arg_number("friction", r.friction),
                                   tl_arg_number("dilation", r.dilation),
                                   tl_arg_number("tension", r.tension),
                                   tl_arg_number("joint_cohesion", c),
                                   tl_arg_number("joint_friction", atan(t) / DEGREE),
                                   tl_arg_number("dip", 90)};
        if (!zones_make(&z, "ubiquitous", values, sizeof values / sizeof *values))
            return;
        for (size_t i = 0; i < ZONES; i++)
            begin_zone(&z, i, &seed);
        double scales[ZONES];
        for (size_t i = 0; i < ZONES; i++) {
            scales[i] = r.cohesion;
            for (int k = 0; k < 6; k++)
                scales[i] += fabs(STRESS(&z, k, i));
        }
        zones_step(&z);
        list_planes(&r, &p);
        for (size_t i = 0; i < ZONES; i++) {
            /* the plane dips towards north: its normal is y */
            double after[6], got[3], shear = hypot(STRESS(&z, 3, i), STRESS(&z, 4, i)), most = 0;
            CHECK(shear + STRESS(&z, 1, i) * t - c <= 1e-12 * scales[i]);
            for (int k = 0; k < 6; k++)
                after[k] = STRESS(&z, k, i);
            zones_principal(after, got);
            for (int k = 0; k < 9; k++)
                most = fmax(most, over(&p, k, got));
            int yields = (z.flags[i] & TL_ZONE_JOINT) && (z.flags[i] & (TL_ZONE_SHEAR | TL_ZONE_TENSION));
            both += yields;
            short_of += most > 1e-12 * scales[i];
            worst = fmax(worst, most / scales[i]);
        }
        tl_solid_clear(&z.solid);
    }
    CHECK(both > 0 && short_of <= both / 20 && worst < 0.01);
    printf("%d zones yield in both, %d of them end beyond the rock's surface, by %.2g at the most\n", both, short_of,
           worst);
}

int main(void)
{
    tl_plugins_load_default();
    RUN(returns_are_those_of_the_nine_planes);
    RUN(returns_of_hoek_brown_flow_as_they_should);
    RUN(returns_of_rock_and_weak_plane_meet_both);
    printf("%s: %d checks, %d failed\n", __FILE__, check_count, check_failed);
    return check_failed != 0;
}
