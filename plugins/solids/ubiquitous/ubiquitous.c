/* ubiquitous.c - solid "ubiquitous": Mohr-Coulomb rock with a weak plane of one attitude everywhere.
 *
 *     rock    as solid "mohr_coulomb": talus/solid_returns.h
 *     plane   |t| + s tan(joint friction) <= joint cohesion,  s <= joint tension,  flow |t| + s tan(joint dilation)
 *
 * with s the normal stress on the plane, positive in tension, and t the shear stress. The return is implicit: what both
 * have taken off the elastic stress, each returns by itself,
 *
 *     off_rock = what the rock's return takes off (trial - off_plane)
 *     off_plane = what the plane's return takes off (trial - off_rock)
 *
 * by turns until nothing changes (Dykstra 1983), with an eye on where the turns lead (Anderson 1965). Where one of them yields alone that is at once. The normal of the plane
 * is a state: it turns with the zone. */
#include <talus/solid_returns.h>
#include <talus/version.h>

/* Limit: turns of rock and plane; the plane's limits hold whenever it ends. Half of the zones in which both yield take 8
 * or fewer, 3 in 1000 more than 130. Test: property/solid_returns. */
#define MOST_TURNS 200
/* Tolerance: change of a turn, relative to the stresses, that counts as none. Test: property/solid_returns. */
#define SETTLED 1e-14
/* Tolerance: square of the sine of two changes below which they count as alike. */
#define ALIKE 1e-12
/* Cost only: a turn that changes so many times as much as the best one has been misled; so many turns go on with
 * foresight, then one without. */
#define MISLED 1.5
#define LONGEST 12

typedef struct params {
    tl_mohr_coulomb_params rock; /* first, as its rows need it */
    double joint_cohesion, joint_friction, joint_dilation, joint_tension, dip, dip_direction;
} params;

static const tl_param param_table[] = {
    TL_PARAMS_MOHR_COULOMB,
    TL_PARAM_NOT_NEGATIVE(params, joint_cohesion, "Pa", "cohesion of the weak plane"),
    TL_PARAM_ANGLE(params, joint_friction, TL_PARAM_REQUIRED, "angle of friction of the weak plane"),
    TL_PARAM_ANGLE(params, joint_dilation, 0, "angle of dilation of the weak plane, at most that of its friction"),
    TL_PARAM(TL_PARAM_REAL, params, joint_tension, "Pa",
             "tensile strength of the weak plane; no more than its cohesion / tan(friction), which it is when left out",
             .flags = TL_PARAM_OPTIONAL, .min = 0, .max = INFINITY),
    TL_PARAMS_DIP(params, "the weak plane"),
};

static const tl_state state_table[] = {
    TL_STATES_MOHR_COULOMB,
    TL_STATE(TL_STATE_AXIS, "normal", "", "unit normal of the weak plane"),
};

typedef struct weak_plane {
    double cohesion, friction, dilation, tension; /* Pa, tangents, Pa */
    tl_vec3 normal;
} weak_plane;

typedef struct solid {
    tl_rock rock;
    tl_isotropic elastic;
    weak_plane plane;
} solid;

static tl_status create(const void *given, void **self, tl_report *report)
{
    const params *p = given;
    solid made;
    tl_status status = tl_rock_of(&p->rock, &made.rock, report);
    if (status != TL_OK)
        return status;
    made.elastic = made.rock.elastic;
    made.plane.cohesion = p->joint_cohesion;
    made.plane.friction = tl_tan(p->joint_friction * TL_DEGREE);
    made.plane.dilation = tl_tan(fmin(p->joint_dilation, p->joint_friction) * TL_DEGREE);
    double apex = made.plane.friction > 0 ? p->joint_cohesion / made.plane.friction : INFINITY;
    made.plane.tension = p->joint_tension < apex ? p->joint_tension : apex;
    made.plane.normal = tl_plane_normal(p->dip, p->dip_direction);
    return tl_keep(&made, sizeof made, self, report);
}

/* What the plane's return takes off stresses `s`. `yields`: 1 where it does. */
TL_IN_LOOP void plane_return(const solid *self, const tl_lanes n[3], const tl_lanes6 s, tl_lanes6 off, tl_lanes yields)
{
    const weak_plane *p = &self->plane;
    const double lame = self->elastic.lame, shear = self->elastic.shear, constrained = self->elastic.constrained;
    const double both = shear + constrained * p->friction * p->dilation;
    TL_EACH_ALONE
    TL_EACH_LANE(i)
    {
        double nx = n[0][i], ny = n[1][i], nz = n[2][i];
        double x = s[0][i] * nx + s[3][i] * ny + s[5][i] * nz;
        double y = s[3][i] * nx + s[1][i] * ny + s[4][i] * nz;
        double z = s[5][i] * nx + s[4][i] * ny + s[2][i] * nz;
        double normal = x * nx + y * ny + z * nz;
        x -= normal * nx;
        y -= normal * ny;
        z -= normal * nz;
        double size = sqrt(x * x + y * y + z * z), scale = TL_YIELD_ROUNDING * (size + fabs(normal) + p->cohesion);
        double over = size + normal * p->friction - p->cohesion, flow = over / both;
        int shears = over > scale, tears = normal - p->tension > scale;
        double at = normal - constrained * p->dilation * flow;
        int shear_alone = shears && at <= p->tension;
        int tension_alone = tears && size + p->tension * p->friction <= p->cohesion;
        double corner = p->cohesion - p->tension * p->friction;
        double left = shear_alone ? size - shear * flow : tension_alone ? size : corner > 0 ? corner : 0;
        double pull = shear_alone ? at : p->tension;
        yields[i] = shears || tears ? 1 : 0;
        double slid = yields[i] > 0 ? (size - left) / (size > 0 ? size : 1) : 0;
        double opened = yields[i] > 0 ? (normal - pull) / constrained : 0;
        double volume = lame * opened, axial = 2 * shear * opened;
        off[0][i] = 2 * slid * x * nx + volume + axial * nx * nx;
        off[1][i] = 2 * slid * y * ny + volume + axial * ny * ny;
        off[2][i] = 2 * slid * z * nz + volume + axial * nz * nz;
        off[3][i] = slid * (x * ny + y * nx) + axial * nx * ny;
        off[4][i] = slid * (y * nz + z * ny) + axial * ny * nz;
        off[5][i] = slid * (z * nx + x * nz) + axial * nz * nx;
    }
}

/* What a group comes to in turns of rock and plane. */
typedef struct turns {
    tl_lanes6 off_rock, off_plane;
    tl_lanes shear, tension, mark; /* of the rock */
    tl_lanes yields;               /* the plane */
    tl_lanes moving;               /* 1: the last turn has changed something */
} turns;

/* The last two turns: what the plane took off, and by how much that was more than before; the turn that changed least. */
typedef struct history {
    tl_lanes6 off[2], more[2], best;
    tl_lanes least; /* what the best one changed */
    tl_lanes age;   /* turns since the history began */
} history;

/* Where the plane's part is going, of which a turn makes `off`, by `more` more: the mixture of the last three turns whose
 * change is least (Anderson 1965). A kink of the surfaces may mislead: after a turn that changes much more than the best
 * one, all begins anew there. */
TL_IN_LOOP void foresee(const tl_lanes6 off, const tl_lanes6 more, double change, history *h, uint32_t i,
                        tl_lanes6 ahead)
{
    double aa = 0, ab = 0, bb = 0, a = 0, b = 0;
    for (uint32_t k = 0; k < 6; k++) {
        double last = more[k][i] - h->more[0][k][i], before = h->more[0][k][i] - h->more[1][k][i];
        aa += last * last;
        ab += last * before;
        bb += before * before;
        a += last * more[k][i];
        b += before * more[k][i];
    }
    double both = aa * bb - ab * ab;
    int two = h->age[i] > 1 && both > ALIKE * aa * bb, lost = change > MISLED * h->least[i];
    double of_last = two ? (a * bb - b * ab) / (two ? both : 1) : aa > 0 ? a / (aa > 0 ? aa : 1) : 0;
    double of_before = two ? (b * aa - a * ab) / (two ? both : 1) : 0;
    int plain = h->age[i] < 1;
    of_last = plain ? 0 : of_last;
    of_before = plain ? 0 : of_before;
    int best = change < h->least[i];
    for (uint32_t k = 0; k < 6; k++) {
        double mixed =
            off[k][i] - of_last * (off[k][i] - h->off[0][k][i]) - of_before * (h->off[0][k][i] - h->off[1][k][i]);
        ahead[k][i] = lost ? h->best[k][i] : mixed;
        h->best[k][i] = best ? off[k][i] : h->best[k][i];
        h->off[1][k][i] = h->off[0][k][i];
        h->more[1][k][i] = h->more[0][k][i];
        h->off[0][k][i] = off[k][i];
        h->more[0][k][i] = more[k][i];
    }
    h->least[i] = lost ? INFINITY : best ? change : h->least[i];
    h->age[i] = lost || h->age[i] >= LONGEST ? 0 : h->age[i] + 1;
}

/* Takes over the lanes of a turn that had not come to an end. Gives whether any goes on. */
TL_IN_LOOP int take_turn(const tl_lanes6 trial, const turns *next, int turn, history *h, turns *t)
{
    tl_lanes6 more, ahead;
    double any = 0;
    TL_EACH_LANE(i)
    {
        double change = 0, scale = 0;
        for (uint32_t k = 0; k < 6; k++) {
            more[k][i] = next->off_plane[k][i] - t->off_plane[k][i];
            change += fabs(more[k][i]);
            scale += fabs(trial[k][i]);
        }
        foresee((const tl_lanes *)next->off_plane, (const tl_lanes *)more, change, h, i, ahead);
        int moves = t->moving[i] > 0, goes_on = moves && change > SETTLED * scale && turn < MOST_TURNS - 1;
        for (uint32_t k = 0; k < 6; k++) {
            t->off_rock[k][i] = moves ? next->off_rock[k][i] : t->off_rock[k][i];
            t->off_plane[k][i] = goes_on ? ahead[k][i] : moves ? next->off_plane[k][i] : t->off_plane[k][i];
        }
        t->shear[i] = moves ? next->shear[i] : t->shear[i];
        t->tension[i] = moves ? next->tension[i] : t->tension[i];
        t->mark[i] = moves ? next->mark[i] : t->mark[i];
        t->yields[i] = moves ? next->yields[i] : t->yields[i];
        t->moving[i] = goes_on ? 1 : 0;
        any += t->moving[i];
    }
    return any > 0;
}

TL_IN_LOOP void make_turns(const solid *self, const tl_strength_lanes *strength, const tl_lanes n[3],
                           const tl_lanes6 trial, turns *t)
{
    history h;
    memset(t, 0, sizeof *t);
    memset(&h, 0, sizeof h);
    TL_EACH_LANE(i)
    {
        t->moving[i] = 1;
        h.least[i] = INFINITY;
    }
    for (int turn = 0; turn < MOST_TURNS; turn++) {
        turns next;
        tl_lanes6 s, after;
        tl_lanes may;
        for (uint32_t k = 0; k < 6; k++)
            TL_EACH_LANE(i)
        s[k][i] = trial[k][i] - t->off_plane[k][i];
        (void)tl_may_yield((const tl_lanes *)s, strength, may);
        tl_group_return(&self->elastic, strength, may, (const tl_lanes *)s, after, next.shear, next.tension, next.mark);
        for (uint32_t k = 0; k < 6; k++)
            TL_EACH_LANE(i)
            {
                next.off_rock[k][i] = s[k][i] - after[k][i];
                s[k][i] = trial[k][i] - next.off_rock[k][i];
            }
        plane_return(self, n, (const tl_lanes *)s, next.off_plane, next.yields);
        if (!take_turn(trial, &next, turn, &h, t))
            return;
    }
}

TL_VECTORIZED static tl_status update(const void *self, const tl_solid_batch *batch, tl_report *report)
{
    (void)report;
    const solid *own = self;
    for (uint32_t begin = 0; begin < batch->count; begin += TL_LANES) {
        tl_strength_lanes strength;
        tl_lanes6 trial, off;
        tl_lanes may, yields, mark = {0}, normal[3];
        double any = 0;
        tl_solid_trial(batch, begin, &own->elastic, trial);
        tl_strength_at(&own->rock, batch, begin, &strength);
        TL_EACH_LANE(i)
        {
            double n[3];
            tl_axis_at(batch->state, TL_MOHR_COULOMB_STATES, begin + i, own->plane.normal, n);
            for (uint32_t k = 0; k < 3; k++)
                normal[k][i] = batch->state[TL_MOHR_COULOMB_STATES + k][begin + i] = n[k];
        }
        int rock_may = tl_may_yield((const tl_lanes *)trial, &strength, may);
        plane_return(own, (const tl_lanes *)normal, (const tl_lanes *)trial, off, yields);
        TL_EACH_LANE(i)
        any += yields[i];
        if (!rock_may && !(any > 0)) {
            tl_isotropic_put(batch, begin, &own->elastic, (const tl_lanes *)trial, (const tl_lanes *)trial, mark);
            continue;
        }
        turns t;
        make_turns(own, &strength, (const tl_lanes *)normal, (const tl_lanes *)trial, &t);
        for (uint32_t k = 0; k < 6; k++)
            TL_EACH_LANE(i)
        off[k][i] = trial[k][i] - (t.off_rock[k][i] + t.off_plane[k][i]);
        TL_EACH_LANE(i)
        mark[i] = t.mark[i] + (t.yields[i] > 0 ? TL_ZONE_JOINT : 0);
        tl_rock_wear(&own->rock, batch, begin, t.shear, t.tension);
        tl_isotropic_put(batch, begin, &own->elastic, (const tl_lanes *)trial, (const tl_lanes *)off, mark);
    }
    return TL_OK;
}

TL_VECTORIZED static void energy(const void *self, uint32_t count, const double *const stress[6], double *const *state,
                                 double *stored)
{
    (void)state;
    tl_isotropic_energies(&((const solid *)self)->elastic, count, stress, stored);
}

TL_SOLID_MODULI(solid);

static const tl_solid_ops ops = TL_SOLID_OPS();

static const tl_kind kind =
    TL_KIND(TL_KIND_SOLID, ops, .name = "ubiquitous",
            .doc = "Mohr-Coulomb with a weak plane of one attitude everywhere, as of schistosity.",
            TL_KIND_PARAMS(params, param_table), TL_KIND_STATES(state_table));

TL_PLUGIN_SINCE(10, kind, .id = "talus.solid_ubiquitous", .version = TALUS_VERSION,
                .doc = "Solid with a weak plane everywhere.", .licence = "BSD-3-Clause");
