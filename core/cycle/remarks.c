/* remarks.c - what is legal and yet improbable: said once a model, with what to do.
 *
 * Units are any consistent set, so only ratios tell. Under its own weight a block of density rho and size L closes a
 * face contact by about rho g L / kn: rho g / kn of its size, whatever the units. Its zones shorten by rho g L / M of
 * its size, with the constrained modulus M. Gravity near 10 tells metres and seconds; then densities have a unit of
 * mass, t or kg, that goes with kN or N. */
#include "cycle/remarks.h"

#include "base/params.h"
#include "contact/contacts.h"
#include "cycle/limits.h"
#include "detect/overlap.h"
#include "model/body_shape.h"
#include "model/deformable.h"
#include "model/scope.h"
#include "zone/zones.h"

#include <string.h>
#include <talus/elementary.h>
#include <talus/number.h>

/* Tolerance: closure under its own weight over a block's size beyond which a remark doubts kn: faces pass through each
 * other's corners. */
#define SOFT 0.01
/* Tolerance: closure over a block's size below which a remark doubts kn. It is lost in the rounding of places, some
 * 1e-13 of a size, and steps are needlessly short. */
#define STIFF 1e-10
/* Tolerance: shortening of a block's zones under its own weight, over its size, beyond which a remark doubts the moduli
 * of a solid: 10 m of soft clay shorten by 7 %. */
#define SQUEEZED 0.1
/* Tolerance: the same below which it doubts them: hard rock 1 mm thick shortens by more. */
#define UNSQUEEZED 1e-10
/* Tolerance: gravity between these is the Earth's in m/s2. */
#define EARTH_LEAST 9.0
#define EARTH_MOST 11.0
/* Tolerance: densities of solids in t/m3, from pumice to dense ore; and in kg/m3, to the densest metals. Weights lie
 * between and above. */
#define TONNES_LEAST 0.5
#define TONNES_MOST 10.0
#define KILOGRAMS_LEAST 100.0
#define KILOGRAMS_MOST 20000.0
/* Tolerance: kn / (rho g), 1/m, with densities in t/m3, above which kn is rather in Pa/m: 8e10 Pa/m for rock, a joint
 * without a flaw. */
#define RIGID 3e6

/* Tolerance: overlap under load over the thickness of the thinner block from which joints are too soft for what
 * presses. A tenth of a layer has vanished in its joint. Test: lua/test_remarks. */
#define CLOSED 0.1
/* Cost only: steps after which contacts are looked at for that: loads do not last shorter. */
#define CLOSED_EVERY 64

/* The densities of the blocks that can move, and whose they are. */
typedef struct densities {
    double least, most;
    uint32_t lightest, densest; /* rows, or TL_NO_ROW */
} densities;

static densities find_densities(const tl_model *m)
{
    densities d = {INFINITY, 0, TL_NO_ROW, TL_NO_ROW};
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        double density = m->blocks.density[row];
        if (tl_body_is_held(m, m->blocks.body[row]))
            continue;
        if (density < d.least) {
            d.least = density;
            d.lightest = row;
        }
        if (density > d.most) {
            d.most = density;
            d.densest = row;
        }
    }
    return d;
}

static bool is_density(double density)
{
    return (density >= TONNES_LEAST && density <= TONNES_MOST) ||
           (density >= KILOGRAMS_LEAST && density <= KILOGRAMS_MOST);
}

static void remark_density(tl_model *m, const densities *d, double g)
{
    uint32_t row = is_density(d->most) ? d->lightest : d->densest;
    if (g < EARTH_LEAST || g > EARTH_MOST || is_density(m->blocks.density[row]) || !tl_model_says(m, TL_REMARK_DENSITY))
        return;
    tl_model_say(m,
                 "density = %g of block %u is not that of a solid, with gravity = %g m/s2: rock has 2000 to 3000 "
                 "kg/m3, with kn in Pa/m, or 2 to 3 t/m3, with kn in kPa/m; give the mass of a volume, not its weight",
                 m->blocks.density[row], m->blocks.id[row], g);
}

static void remark_stiffness(tl_model *m, const densities *d, double g, const tl_law *law)
{
    char of[TL_SCOPE_TEXT];
    double sunk = d->most * g / law->kn, least = d->least * g / law->kn;
    bool tonnes = g >= EARTH_LEAST && g <= EARTH_MOST && d->least >= TONNES_LEAST && d->most <= TONNES_MOST;
    if (sunk > SOFT && tl_model_says(m, TL_REMARK_SOFT))
        tl_model_say(m,
                     "%s: kn = %g is soft: block %u sinks in by %.3g %% of its size under its own weight; give "
                     "a larger kn, or look at the units of kn (Pa/m), density and gravity",
                     tl_scope_text(m, &law->scope, of), law->kn, m->blocks.id[d->densest], 100 * sunk);
    else if (tonnes && sunk * RIGID < 1 && tl_model_says(m, TL_REMARK_DENSITY))
        tl_model_say(m,
                     "%s: kn = %g goes with density = %g of block %u only if kn is in kPa/m and rock is that "
                     "stiff; if kn is in Pa/m, give the density in kg/m3",
                     tl_scope_text(m, &law->scope, of), law->kn, d->most, m->blocks.id[d->densest]);
    else if (least < STIFF && tl_model_says(m, TL_REMARK_STIFF))
        tl_model_say(m,
                     "%s: kn = %g is improbably stiff: block %u closes the joint by %.2g of its size under its "
                     "own weight, and steps are short for nothing; look at the units of kn (Pa/m), density and gravity",
                     tl_scope_text(m, &law->scope, of), law->kn, m->blocks.id[d->lightest], least);
}

/* ---------------------------------------------------------------- solids ----------------- */

void tl_remark_friction(tl_model *m, const char *of, const tl_kind *kind, const void *params)
{
    for (uint32_t i = 0; i < kind->param_count; i++) {
        tl_param p = tl_param_row(kind->params, i, kind->param_stride);
        if (p.type != TL_PARAM_REAL || strcmp(p.name, "friction") != 0 || strcmp(p.unit, "deg") != 0)
            continue;
        double value;
        memcpy(&value, (const char *)params + p.offset, sizeof value);
        if (value > 0 && value <= 1 && tl_model_says(m, TL_REMARK_FRICTION))
            tl_model_say(m,
                         "%s: friction = %g deg is nearly none: it is an angle in degrees; a coefficient of %g is %.3g "
                         "deg, and %g rad are %.3g deg",
                         of, value, value, tl_atan2(value, 1) * 180 / TL_PI, value, value * 180 / TL_PI);
    }
}

/* What the zones of a parcel say of their solid. */
static void remark_solid(tl_model *m, double g, const tl_parcel *parcel)
{
    const tl_named_solid *solid = &m->zones->solid[parcel->solid];
    const uint32_t row = tl_block_row_quiet(m, parcel->block);
    const double weight = m->blocks.density[row] * g * m->blocks.size[row], squeezed = weight / solid->of.constrained;
    char of[200];
    tl_text_print(of, sizeof of, "solid '%.80s', of kind '%.40s'", solid->name, solid->of.kind->name);
    tl_remark_friction(m, of, solid->of.kind, solid->of.params);
    if (squeezed > SQUEEZED && tl_model_says(m, TL_REMARK_SOFT))
        tl_model_say(
            m,
            "%s is soft: block %u would shorten by %.3g of its size under its own weight; give larger moduli, or "
            "look at their units (Pa), density and gravity",
            of, parcel->block, squeezed);
    else if (weight > 0 && squeezed < UNSQUEEZED && tl_model_says(m, TL_REMARK_STIFF))
        tl_model_say(
            m,
            "%s is improbably stiff: block %u shortens by %.2g of its size under its own weight, and steps are "
            "short for nothing; look at the units of its moduli (Pa), density and gravity",
            of, parcel->block, squeezed);
}

void tl_remark_units(tl_model *m)
{
    uint64_t version = 1 + m->structure + m->constraints + m->laws + (m->zones ? m->zones->version : 0);
    if (m->remarked == version)
        return;
    m->remarked = version;
    double g = tl_v3_norm(m->config.gravity);
    for (size_t k = 0; m->zones && k < m->zones->parcels.table.rows; k++)
        remark_solid(m, g, &m->zones->parcels.of[k]);
    densities d = find_densities(m);
    if (d.densest == TL_NO_ROW || !(g > 0))
        return;
    remark_density(m, &d, g);
    for (size_t i = 0; i < m->joint_law_count; i++)
        if (m->joint_laws[i].kn > 0)
            remark_stiffness(m, &d, g, &m->joint_laws[i]);
}

/* Whether a contact may have closed so far, from its force alone: cheap, and true of few. */
static bool may_have_closed(const tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    if (c->law[contact] == TL_NO_ROW)
        return false;
    uint32_t a = c->a[contact], b = c->b[contact];
    double thickness = fmin(tl_least_thickness(m, a), tl_least_thickness(m, b));
    double stiffness = m->joint_laws[c->law[contact]].kn * c->area[contact];
    return tl_v3_norm(c->force[contact]) > CLOSED * thickness * stiffness && !tl_blocks_fixed(m, a, b);
}

void tl_remark_closure(tl_model *m)
{
    if (m->cycles % CLOSED_EVERY != 0 || m->said & 1u << TL_REMARK_CLOSURE)
        return;
    const tl_contacts *c = &m->detect->contacts;
    for (uint32_t row = 0; row < c->table.rows; row++) {
        tl_overlap_share closed;
        if (!may_have_closed(m, row) || !tl_overlap_measure(m, row, &closed) ||
            !(closed.overlap >= CLOSED * closed.thickness) || !tl_model_says(m, TL_REMARK_CLOSURE))
            continue;
        char name[320], of[TL_SCOPE_TEXT];
        tl_contact_describe(m, row, name, sizeof name);
        const tl_law *law = &m->joint_laws[c->law[row]];
        tl_model_say(m,
                     "%s: kn = %.3g is soft for what presses: the %s has closed by %.3g m, %.0f %% of the thickness of "
                     "block %u, %.3g m; give a larger kn, or look at the units of kn (Pa/m), densities and loads",
                     tl_scope_text(m, &law->scope, of), law->kn, name, closed.overlap,
                     100 * closed.overlap / closed.thickness, m->blocks.id[closed.thinner], closed.thickness);
        return;
    }
}

/* ---------------------------------------------------------------- overlaps --------------- */

/* Whether a contact has an initial stress, which presses by itself. */
static bool is_stressed(const tl_model *m, uint32_t contact)
{
    const tl_detect *d = m->detect;
    bool stressed = false;
    for (size_t k = 0; d->points.initial && k < d->contacts.point_count[contact]; k++)
        stressed = stressed || d->points.f_n0[tl_point_row(&d->contacts, contact, k)] != 0;
    return stressed;
}

/* Weight of the blocks that can move, N. */
static double free_weight(const tl_model *m)
{
    double mass = 0;
    for (uint32_t body = 0; body < m->bodies.table.rows; body++)
        mass += tl_body_is_held(m, body) ? 0 : m->bodies.mass[body];
    return mass * tl_v3_norm(m->config.gravity);
}

void tl_remark_overlaps(tl_model *m)
{
    const tl_contacts *c = &m->detect->contacts;
    const double weight = free_weight(m);
    double force = 0, most = 0;
    uint32_t deepest = TL_NO_ROW;
    for (uint32_t row = 0; row < c->table.rows; row++) {
        if (tl_blocks_fixed(m, c->a[row], c->b[row]) || c->law[row] == TL_NO_ROW || is_stressed(m, row))
            continue;
        const double pressed = tl_v3_norm(c->force[row]);
        const double overlap = pressed / (m->joint_laws[c->law[row]].kn * c->area[row]);
        force += pressed;
        if (overlap > most) {
            most = overlap;
            deepest = row;
        }
    }
    if (deepest == TL_NO_ROW || !(weight > 0) || !(force > weight) || !tl_model_says(m, TL_REMARK_SEAT))
        return;
    tl_overlap_share of;
    if (tl_overlap_measure(m, deepest, &of))
        most = of.overlap;
    tl_model_say(
        m,
        "before the first step overlaps press with %.3g times the weight (largest: %.3g m between blocks %u and "
        "%u): %s takes blocks as drawn as fitting",
        force / weight, most, m->blocks.id[c->a[deepest]], m->blocks.id[c->b[deepest]],
        tl_words(m, "model:seat{}", "tl_model_seat()"));
}
