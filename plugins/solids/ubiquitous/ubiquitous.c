/* ubiquitous.c - solid "ubiquitous": Mohr-Coulomb rock with a weak plane of one attitude everywhere.
 *
 *     rock    as solid "mohr_coulomb": talus/solid_returns.h
 *     plane   |t| + s tan(joint friction) <= joint cohesion,  s <= joint tension,  flow |t| + s tan(joint dilation)
 *
 * with s the normal stress on the plane, positive in tension, and t the shear stress. Each return is implicit and
 * exact: that of the rock, then that of the plane, by turns until both are met. Where only one of them yields that
 * is at once. Where both do, each turn is a small plastic step of its own. The parts that rock and plane have of the
 * flow then hang on the size of the steps, to first order. The normal of the plane is a state: it turns with the
 * zone. */
#include <talus/solid_returns.h>
#include <talus/version.h>

/* Limit: turns of rock and plane; the plane's limits hold whenever they end. Test: property/solid_returns. */
#define MOST_TURNS 100

typedef struct params {
    tl_mohr_coulomb_params rock; /* first, as its rows need it */
    double joint_cohesion, joint_friction, joint_dilation, joint_tension, dip, dip_direction;
} params;

static const tl_param param_table[] = {
    TL_PARAMS_MOHR_COULOMB,
    TL_PARAM_STRONG(params, joint_cohesion, "Pa", "cohesion of the weak plane"),
    TL_PARAM_ANGLE(params, joint_friction, TL_PARAM_REQUIRED | TL_PARAM_STRENGTH_ANGLE,
                   "angle of friction of the weak plane"),
    TL_PARAM_ANGLE(params, joint_dilation, TL_PARAM_STRENGTH_ANGLE,
                   "angle of dilation of the weak plane, at most that of its friction"),
    TL_PARAM(TL_PARAM_REAL, params, joint_tension, "Pa",
             "tensile strength of the weak plane; no more than its cohesion / tan(friction), which it is when left out",
             .flags = TL_PARAM_OPTIONAL | TL_PARAM_STRENGTH, .min = 0, .max = INFINITY),
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
        int yield = shears || tears;
        yields[i] = yield ? 1 : 0;
        double slid = yield ? (size - left) / (size > 0 ? size : 1) : 0;
        double opened = yield ? (normal - pull) / constrained : 0;
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
    tl_lanes6 stress;
    tl_lanes shear, tension; /* measures of the rock's plastic strains */
    tl_lanes shears, tears, slides;
} turns;

TL_IN_LOOP void make_turns(const solid *self, const tl_strength_lanes *strength, const tl_lanes n[3],
                           const tl_lanes6 trial, turns *t)
{
    double any = 1;
    memset(t, 0, sizeof *t);
    memcpy(t->stress, trial, sizeof t->stress);
    /* a zone in which nothing yields any more stays what it is, to the bit, while others of its group go on */
    for (int turn = 0; turn < MOST_TURNS && any > 0; turn++) {
        tl_lanes6 after, off;
        tl_lanes may, shear, tension, mark, yields;
        if (tl_may_yield((const tl_lanes *)t->stress, strength, may)) {
            tl_group_return(&self->elastic, strength, may, (const tl_lanes *)t->stress, after, shear, tension, mark);
        } else {
            memcpy(after, t->stress, sizeof after);
            memset(shear, 0, sizeof shear);
            memset(tension, 0, sizeof tension);
            memset(mark, 0, sizeof mark);
        }
        plane_return(self, n, (const tl_lanes *)after, off, yields);
        any = 0;
        for (uint32_t k = 0; k < 6; k++)
            TL_EACH_LANE(i)
        t->stress[k][i] = after[k][i] - off[k][i];
        TL_EACH_LANE(i)
        {
            t->shear[i] += shear[i];
            t->tension[i] += tension[i];
            double tears = mark[i] >= TL_ZONE_TENSION ? TL_ZONE_TENSION : 0, shears = mark[i] - tears;
            t->tears[i] = tears > 0 ? tears : t->tears[i];
            t->shears[i] = shears > 0 ? shears : t->shears[i];
            t->slides[i] = yields[i] > 0 ? TL_ZONE_JOINT : t->slides[i];
            any += yields[i];
        }
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
        TL_EACH_LANE(i)
        mark[i] = t.shears[i] + t.tears[i] + t.slides[i];
        tl_rock_wear(&own->rock, batch, begin, t.shear, t.tension);
        tl_isotropic_put(batch, begin, &own->elastic, (const tl_lanes *)trial, (const tl_lanes *)t.stress, mark);
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
