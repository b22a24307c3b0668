/* hoek_brown.c - solid "hoek_brown": elastic to the generalized criterion of Hoek, Carranza-Torres and Corkum
 * (2002), with a tension cut-off.
 *
 *     f = s1 - s3 - F(s1) <= 0,  F(s1) = sigma_ci (s - mb s1 / sigma_ci)^a,  s1 <= T <= s sigma_ci / mb
 *
 * with principal stresses s1 >= s2 >= s3, positive in tension. The flow is that of Mohr-Coulomb of the angle of
 * dilation, or of the angle of friction of f's tangent where that is smaller. The return is implicit. It goes to the
 * surface, to an edge of it where two principal stresses come out equal, to the cut-off, or to where they meet. It
 * finds the strength F at its end by false position, since s1 - s3 = F and s1 = (s sigma_ci - sigma_ci (F /
 * sigma_ci)^(1/a)) / mb. */
#include <talus/solid_returns.h>
#include <talus/version.h>

/* Tolerance: width of the bracket of F, and what f may be, relative to the stresses. */
#define CLOSED 1e-15
/* Limit: passes; from the twelfth on every third halves the bracket, so 180 leave no number in it. Most returns take
 * some eight. */
#define MOST_PASSES 180
#define FALSE_POSITIONS 12

typedef struct params {
    double young, poisson, bulk, shear;
    double sigma_ci, mb, s, a, gsi, mi, disturbance, dilation, tension;
} params;

/* A strength, > 0. With sigma_ci and mb divided by F, s and a as they are, s3 - s1 at any s1 is 1/F of what it was. */
#define CRITERION(member, unit, more, ...)                                                                             \
    TL_PARAM(TL_PARAM_REAL, params, member, unit, __VA_ARGS__,                                                         \
             .flags = TL_PARAM_STRENGTH | TL_PARAM_MIN_OPEN | (more), .min = 0, .max = INFINITY)

static const tl_param param_table[] = {
    TL_PARAMS_ELASTIC(params),
    CRITERION(sigma_ci, "Pa", TL_PARAM_REQUIRED, "uniaxial strength of the intact rock"),
    CRITERION(mb, "", TL_PARAM_OPTIONAL, "constant of the rock mass; with s, or gsi and mi in their place"),
    TL_PARAM(TL_PARAM_REAL, params, s, "", "constant of the rock mass, 1 of intact rock", .flags = TL_PARAM_OPTIONAL,
             .min = 0, .max = 1),
    TL_PARAM(TL_PARAM_REAL, params, a, "", "exponent; with mb and s", .flags = TL_PARAM_OPTIONAL, .min = 0.5, .max = 1),
    TL_PARAM(TL_PARAM_REAL, params, gsi, "", "geological strength index; with mi", .flags = TL_PARAM_OPTIONAL, .min = 0,
             .max = 100),
    CRITERION(mi, "", TL_PARAM_OPTIONAL, "constant of the intact rock; with gsi"),
    TL_PARAM(TL_PARAM_REAL, params, disturbance, "", "factor D of blasting and relief; with gsi",
             .flags = TL_PARAM_OPTIONAL, .min = 0, .max = 1),
    TL_PARAM_ANGLE(params, dilation, TL_PARAM_STRENGTH_ANGLE,
                   "angle of dilation, at most that of friction at the stress"),
    TL_PARAM(TL_PARAM_REAL, params, tension, "Pa",
             "tensile strength; no more than s sigma_ci / mb, which it is when left out",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_STRENGTH, .min = 0, .max = INFINITY),
};

typedef struct mass {
    tl_isotropic elastic;
    double sigma, m, s, a, power; /* power: 1 / a */
    double tension, apex;         /* apex: s sigma_ci / mb, Pa */
    double dilation;              /* sin psi */
} mass;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    mass m;
    tl_status status = tl_isotropic_of(p->young, p->poisson, p->bulk, p->shear, &m.elastic, report);
    if (status != TL_OK)
        return status;
    int direct = !isnan(p->mb) + !isnan(p->s), by_index = !isnan(p->gsi) + !isnan(p->mi);
    int odd = direct ? !isnan(p->disturbance) : !isnan(p->a);
    if (!((direct == 2 && by_index == 0) || (direct == 0 && by_index == 2)) || odd)
        return tl_refuse(report, "give mb and s, and a where it is not 0.5; or gsi and mi, and disturbance");
    double d = isnan(p->disturbance) ? 0 : p->disturbance;
    m.sigma = p->sigma_ci;
    m.m = direct ? p->mb : p->mi * tl_lane_exp((p->gsi - 100) / (28 - 14 * d));
    m.s = direct ? p->s : tl_lane_exp((p->gsi - 100) / (9 - 3 * d));
    m.a = direct ? 0.5 : 0.5 + (tl_lane_exp(-p->gsi / 15) - tl_lane_exp(-20. / 3)) / 6;
    m.a = isnan(p->a) ? m.a : p->a;
    m.power = 1 / m.a;
    m.apex = m.s * m.sigma / m.m;
    m.tension = p->tension < m.apex ? p->tension : m.apex;
    m.dilation = tl_sin_degrees(p->dilation);
    return tl_keep(&m, sizeof m, self, report);
}

/* x^power of x >= 0. */
TL_IN_LOOP double power_of(double x, double power)
{
    double least = x > 1e-300 ? x : 1e-300;
    double value = tl_lane_exp(power * tl_lane_log(least));
    return x > 1e-300 ? value : 0;
}

/* F(s1), Pa; 0 beyond the apex. */
TL_IN_LOOP double strength_at(const mass *m, double s1)
{
    double x = m->s - m->m * s1 / m->sigma;
    return m->sigma * power_of(x > 0 ? x : 0, m->a);
}

/* sin psi of the flow where f has the strength F = sigma y, y^(1/a) = x: its tangent is s3 = N s1 with N = 1 + a mb
 * y / x.
 */
TL_IN_LOOP double dilation_at(const mass *m, double x, double y)
{
    double slope = m->a * m->m * y, friction = slope / (2 * x + slope > 0 ? 2 * x + slope : 1);
    friction = x > 0 ? friction : 1;
    return m->dilation < friction ? m->dilation : friction;
}

/* A return to f along one flow, or that of two planes that share it: `u` and `w`, the stresses that come to s1 and
 * s3, are means of `many_u` and `many_w` principal stresses. */
typedef struct line {
    double u, w, many_u, many_w;
} line;

/* Where the line is when f has the strength F: s1 = t, s3 = t - F - over; over = 0 is the return. */
typedef struct line_point {
    double over, t, flow, dilation;
} line_point;

TL_IN_LOOP line_point line_at(const mass *m, const line *l, double strength)
{
    double y = strength / m->sigma, x = power_of(y, m->power);
    line_point at;
    at.dilation = dilation_at(m, x, y);
    at.t = m->apex - x * m->sigma / m->m;
    double volume = 2 * m->elastic.lame * at.dilation, twice = 2 * m->elastic.shear;
    at.flow = (l->u - at.t) / (volume + twice * (1 + at.dilation) / l->many_u);
    double w = l->w - at.flow * (volume - twice * (1 - at.dilation) / l->many_w);
    at.over = at.t - w - strength;
    return at;
}

typedef struct line_lanes {
    tl_lanes u, w, many_u, many_w;
} line_lanes;

/* Ends of a bracket of F, of which over is above 0 at `low` and below 0 at `high`; `moved` is 1 when the last pass has
 * moved the former, -1 when the latter. */
typedef struct brackets {
    tl_lanes low, high, over_low, over_high, scale, open, moved;
} brackets;

/* False position, with the value at an end that stays for a second time halved (Illinois), or the middle. */
TL_IN_LOOP int narrow(const mass *m, const line_lanes *l, brackets *b, int pass)
{
    double any = 0;
    TL_EACH_ALONE
    TL_EACH_LANE(i)
    {
        const line own = {l->u[i], l->w[i], l->many_u[i], l->many_w[i]};
        double low = b->low[i], high = b->high[i], from = b->over_low[i], to = b->over_high[i];
        double apart = from - to, cut = low + (high - low) * (from / (apart > 0 ? apart : 1));
        double middle = 0.5 * (low + high);
        int halves = pass >= FALSE_POSITIONS && pass % 3 == 2;
        double next = halves || !(cut > low && cut < high) ? middle : cut;
        double over = line_at(m, &own, next).over;
        int opens = b->open[i] > 0, up = over > 0;
        b->low[i] = opens && up ? next : low;
        b->high[i] = opens && !up ? next : high;
        b->over_low[i] = opens ? (up ? over : b->moved[i] < 0 ? 0.5 * from : from) : from;
        b->over_high[i] = opens ? (up ? (b->moved[i] > 0 ? 0.5 * to : to) : over) : to;
        b->moved[i] = up ? 1 : -1;
        int done = fabs(over) <= CLOSED * b->scale[i] || b->high[i] - b->low[i] <= CLOSED * b->scale[i];
        /* the last one tried is the best */
        b->low[i] = opens && done ? next : b->low[i];
        b->open[i] = opens && !done ? 1 : 0;
    }
    TL_EACH_LANE(i)
    any += b->open[i];
    return any > 0;
}

TL_IN_LOOP double sum_of(const tl_lanes of)
{
    double sum = 0;
    TL_EACH_LANE(i)
    sum += of[i];
    return sum;
}

/* The strengths F at the ends of lines of a group; `met` is 0 where the line passes the cut-off first. */
TL_IN_LOOP void find_ends(const mass *m, const line_lanes *l, const tl_lanes wanted, tl_lanes strength, tl_lanes met)
{
    brackets b;
    TL_EACH_ALONE
    TL_EACH_LANE(i)
    {
        const line own = {l->u[i], l->w[i], l->many_u[i], l->many_w[i]};
        double nearest = own.u < m->tension ? own.u : m->tension, flow = m->dilation;
        double volume = 2 * m->elastic.lame * flow, twice = 2 * m->elastic.shear;
        double rate = (volume - twice * (1 - flow) / own.many_w) / (volume + twice * (1 + flow) / own.many_u);
        /* without any strength the line would end where s1 = s3 */
        double alike = (own.w - rate * own.u) / (1 - rate), scale = fabs(own.u) + fabs(own.w);
        double low = strength_at(m, nearest);
        double high = strength_at(m, alike < nearest ? alike : nearest) + CLOSED * scale;
        double over_low = line_at(m, &own, low).over, over_high = line_at(m, &own, high).over;
        b.scale[i] = scale;
        b.low[i] = low;
        b.high[i] = high;
        b.over_low[i] = over_low;
        b.over_high[i] = over_high;
        b.moved[i] = 0;
        met[i] = over_low >= 0 ? 1 : 0;
        b.open[i] = ((wanted[i] > 0) & (over_low > 0) & (over_high < 0)) ? 1 : 0;
    }
    int any = sum_of(b.open) > 0;
    for (int pass = 0; pass < MOST_PASSES && any; pass++)
        any = narrow(m, l, &b, pass);
    TL_EACH_LANE(i)
    strength[i] = b.low[i];
}

/* Principal stresses and directions of a group, how they yield, what they come to and its flags. */
typedef struct group {
    tl_lanes s[3], v[3][3];
    tl_lanes shears, tears, to[3], mark;
} group;

/* The plane first, and an edge of it where the order of the stresses would change. */
TL_IN_LOOP void return_shear(const mass *m, group *g)
{
    line_lanes l;
    tl_lanes strength, met, edge;
    TL_EACH_LANE(i)
    {
        l.u[i] = g->s[0][i];
        l.w[i] = g->s[2][i];
        l.many_u[i] = l.many_w[i] = 1;
    }
    find_ends(m, &l, g->shears, strength, met);
    TL_EACH_ALONE
    TL_EACH_LANE(i)
    {
        double s1 = g->s[0][i], s2 = g->s[1][i], s3 = g->s[2][i];
        const line own = {s1, s3, 1, 1};
        line_point end = line_at(m, &own, strength[i]);
        double a = end.t, c = end.t - strength[i], b = s2 - 2 * m->elastic.lame * end.dilation * end.flow;
        int upper = b > a, lower = b < c;
        g->to[0][i] = a;
        g->to[1][i] = b;
        g->to[2][i] = c;
        g->mark[i] = met[i] > 0 ? TL_ZONE_SHEAR : 0;
        double which = upper ? 1 : lower ? 2 : 0;
        edge[i] = g->shears[i] > 0 ? which : 0;
        l.u[i] = upper ? 0.5 * (s1 + s2) : s1;
        l.w[i] = upper ? s3 : 0.5 * (s2 + s3);
        l.many_u[i] = upper ? 2 : 1;
        l.many_w[i] = upper ? 1 : 2;
    }
    if (!(sum_of(edge) > 0))
        return;
    find_ends(m, &l, edge, strength, met);
    TL_EACH_ALONE
    TL_EACH_LANE(i)
    {
        const line own = {l.u[i], l.w[i], l.many_u[i], l.many_w[i]};
        line_point end = line_at(m, &own, strength[i]);
        double a = end.t, c = end.t - strength[i], mark = met[i] > 0 ? TL_ZONE_SHEAR : 0;
        g->to[0][i] = edge[i] > 0 ? a : g->to[0][i];
        g->to[1][i] = edge[i] > 0 ? (edge[i] > 1 ? c : a) : g->to[1][i];
        g->to[2][i] = edge[i] > 0 ? c : g->to[2][i];
        g->mark[i] = edge[i] > 0 ? mark : g->mark[i];
    }
}

/* Of the ways to yield the right one, as for Mohr-Coulomb. Stays as it is what does not yield. */
TL_IN_LOOP void choose(const mass *m, group *g)
{
    const double tension = m->tension, strength = strength_at(m, tension);
    const double dilation = dilation_at(m, m->s - m->m * tension / m->sigma, strength / m->sigma);
    TL_EACH_ALONE
    TL_EACH_LANE(i)
    {
        double s1 = g->s[0][i], s2 = g->s[1][i], s3 = g->s[2][i];
        tl_returned by_tension = tl_return_tension(&m->elastic, tension, s1, s2, s3);
        tl_returned by_both = tl_return_both(&m->elastic, dilation, tension, tension - strength, s1, s2, s3);
        int shears = g->shears[i] > 0, tears = g->tears[i] > 0, by_shear = shears & (g->mark[i] > 0);
        int torn = tears & (by_tension.a - by_tension.c <= strength);
        double a = torn ? by_tension.a : by_both.a, b = torn ? by_tension.b : by_both.b;
        double c = torn ? by_tension.c : by_both.c, mark = torn ? by_tension.mark : by_both.mark;
        a = by_shear ? g->to[0][i] : a;
        b = by_shear ? g->to[1][i] : b;
        c = by_shear ? g->to[2][i] : c;
        mark = by_shear ? g->mark[i] : mark;
        int yields = shears | tears;
        g->to[0][i] = yields ? a : s1;
        g->to[1][i] = yields ? b : s2;
        g->to[2][i] = yields ? c : s3;
        g->mark[i] = yields ? mark : 0;
    }
}

/* Whether a zone may yield, 1 or 0, by bounds in the mean stress p and J2: s1 <= p + sqrt(4 J2 / 3), and s1 - s3 <=
 * 2 sqrt(J2). Gives whether any may. */
TL_IN_LOOP int may_yield(const mass *m, const tl_lanes6 s, tl_lanes may)
{
    TL_EACH_ALONE
    TL_EACH_LANE(i)
    {
        double p = (s[0][i] + s[1][i] + s[2][i]) / 3, xx = s[0][i] - p, yy = s[1][i] - p, zz = s[2][i] - p;
        double shear = s[3][i] * s[3][i] + s[4][i] * s[4][i] + s[5][i] * s[5][i];
        double j2 = 0.5 * (xx * xx + yy * yy + zz * zz) + shear, highest = p + sqrt(4. / 3 * j2);
        int stays = (highest <= m->tension) & (2 * sqrt(j2) <= strength_at(m, highest));
        may[i] = stays ? 0 : 1;
    }
    return sum_of(may) > 0;
}

/* Principal stresses of a group. */
TL_IN_LOOP void find_principal(const tl_lanes6 s, group *g)
{
    TL_EACH_LANE(i)
    {
        tl_principal p = tl_principal_of(s[0][i], s[1][i], s[2][i], s[3][i], s[4][i], s[5][i]);
        g->s[0][i] = p.s[0], g->s[1][i] = p.s[1], g->s[2][i] = p.s[2];
        g->v[0][0][i] = p.v[0][0], g->v[0][1][i] = p.v[0][1], g->v[0][2][i] = p.v[0][2];
        g->v[1][0][i] = p.v[1][0], g->v[1][1][i] = p.v[1][1], g->v[1][2][i] = p.v[1][2];
        g->v[2][0][i] = p.v[2][0], g->v[2][1][i] = p.v[2][1], g->v[2][2][i] = p.v[2][2];
    }
}

/* The stresses of a group brought back; 0: none yields. */
TL_IN_LOOP int bring_back(const mass *m, const tl_lanes6 s, tl_lanes6 after, tl_lanes mark)
{
    group g;
    tl_lanes may;
    if (!may_yield(m, s, may))
        return 0;
    find_principal(s, &g);
    TL_EACH_ALONE
    TL_EACH_LANE(i)
    {
        double s1 = g.s[0][i], s3 = g.s[2][i], strength = strength_at(m, s1);
        double scale = TL_YIELD_ROUNDING * (fabs(s1) + fabs(s3) + strength);
        g.shears[i] = ((may[i] > 0) & (s1 - s3 - strength > scale)) ? 1 : 0;
        g.tears[i] = ((may[i] > 0) & (s1 - m->tension > scale)) ? 1 : 0;
    }
    if (!(sum_of(g.shears) + sum_of(g.tears) > 0))
        return 0;
    return_shear(m, &g);
    choose(m, &g);
    TL_EACH_ALONE
    TL_EACH_LANE(i)
    {
        const tl_principal p = {{0, 0, 0},
                                {{g.v[0][0][i], g.v[0][1][i], g.v[0][2][i]},
                                 {g.v[1][0][i], g.v[1][1][i], g.v[1][2][i]},
                                 {g.v[2][0][i], g.v[2][1][i], g.v[2][2][i]}}};
        double a = g.s[0][i] - g.to[0][i], b = g.s[1][i] - g.to[1][i], c = g.s[2][i] - g.to[2][i];
        mark[i] = g.mark[i];
        after[0][i] = s[0][i] - tl_principal_part(&p, a, b, c, 0, 0);
        after[1][i] = s[1][i] - tl_principal_part(&p, a, b, c, 1, 1);
        after[2][i] = s[2][i] - tl_principal_part(&p, a, b, c, 2, 2);
        after[3][i] = s[3][i] - tl_principal_part(&p, a, b, c, 0, 1);
        after[4][i] = s[4][i] - tl_principal_part(&p, a, b, c, 1, 2);
        after[5][i] = s[5][i] - tl_principal_part(&p, a, b, c, 2, 0);
    }
    return 1;
}

TL_VECTORIZED static tl_status update(const void *self, const tl_solid_batch *batch, tl_report *report)
{
    (void)report;
    const mass *m = self;
    for (uint32_t begin = 0; begin < batch->count; begin += TL_LANES) {
        tl_lanes6 trial, after;
        tl_lanes mark = {0};
        tl_solid_trial(batch, begin, &m->elastic, trial);
        int yields = bring_back(m, (const tl_lanes *)trial, after, mark);
        tl_isotropic_put(batch, begin, &m->elastic, (const tl_lanes *)trial, (const tl_lanes *)(yields ? after : trial),
                         mark);
    }
    return TL_OK;
}

TL_VECTORIZED static void energy(const void *self, uint32_t count, const double *const stress[6], double *const *state,
                                 double *stored)
{
    (void)state;
    tl_isotropic_energies(&((const mass *)self)->elastic, count, stress, stored);
}

TL_SOLID_MODULI(mass);

static const tl_solid_ops ops = TL_SOLID_OPS();

static const tl_kind kind = TL_KIND(TL_KIND_SOLID, ops, .name = "hoek_brown",
                                    .doc = "Generalized Hoek-Brown criterion of 2002 with a tension cut-off.",
                                    TL_KIND_PARAMS(params, param_table));

TL_PLUGIN_SINCE(10, kind, .id = "talus.solid_hoek_brown", .version = TALUS_VERSION,
                .doc = "Solid that yields by Hoek and Brown.", .licence = "BSD-3-Clause");
