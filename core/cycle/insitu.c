/* insitu.c - initial stress put on the contacts of a model: tractions sigma n on the face patches that exist now; and
 * on zones and segments of deformable blocks (insitu_zones.c).
 *
 * sigma(z) = stress + gradient (z - at.z), tension positive. A point of area a and normal n (A to B) gets f_n = -(n .
 * sigma n) a and f_s = -(sigma n - (n . sigma n) n) a on B, and its closure counts from now. Field contacts begin
 * without force, and so do faces with rock between them and contacts made later, but those of blocks that are cut
 * (contact/cut_contacts.c). Improbable stresses are remarked on. */
#include "base/columns.h"
#include "contact/across_gap.h"
#include "contact/body_contacts.h"
#include "contact/contacts.h"
#include "contact/pair_view.h"
#include "contact/places.h"
#include "contact/store.h"
#include "cycle/cycle_data.h"
#include "cycle/insitu_zones.h"
#include "cycle/undo.h"
#include "detect/detect.h"
#include "geometry/measure.h"
#include "geometry/seam.h"
#include "model/options.h"
#include "segment/meets.h"

#include <stdlib.h>

/* Tolerance: a traction below this share of the largest stress given is none. */
#define NO_TRACTION 1e-9
/* Tolerance: a mean tension on a contact below this share of the largest stress on any is none. At a free surface the
 * stress of a gradient passes through 0. */
#define PULL 0.01
/* Tolerance: an outer face has more than this share of it, and of the mean face of its block, on no body, its own
 * included. Less carries no force to speak of. */
#define BARE 0.01
/* Tolerance: a contact without a patch on more than this share of the mean face of its blocks should have one. Edges
 * and vertices press on less. Test: lua/test_remarks. */
#define MUCH 0.1
/* Limit: largest component of a stress, Pa, and of its gradient, Pa/m, that is taken: forces and their energies stay
 * finite. Test: lua/test_insitu. */
#define MOST_STRESS 1e50

/* The stress at a height. */
static tl_sym3 stress_at(const tl_insitu *s, double z)
{
    return tl_s3_madd(s->stress, z - s->at.z, s->gradient);
}

/* Whether the faces of a patch are together: in the mean over its area not farther apart than blocks in contact are.
 * Faces with a wedge of rock between them touch along its edge and have a patch, but the wedge carries their stress. */
static bool faces_meet(const tl_model *m, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_points_table *p = &m->detect->points;
    double size = tl_contact_size(m, c);
    double area = 0, apart = 0;
    for (size_t i = 0; i < contacts->point_count[c]; i++) {
        size_t point = tl_point_row(contacts, c, i);
        area += p->area[point];
        apart -= p->area[point] * (m->detect->lanes[0].closure[i] + p->reference[point]);
    }
    return apart <= TL_CONTACT_TOLERANCE * size * area;
}

/* Gives a point the traction of a stress, tension positive, as its initial force. Its closure, and what slip has
 * opened, count from now. n from A to B. */
static void load_point(tl_points_table *p, size_t i, const tl_sym3 *stress, tl_vec3 n, double closure, double opening)
{
    tl_vec3 traction = tl_s3_mul(*stress, n);
    double normal = tl_v3_dot(n, traction);
    tl_vec3 shear = tl_v3_madd(traction, -normal, n);
    p->reference[i] += closure + opening;
    p->f_n0[i] = p->f_n[i] = -normal * p->area[i];
    tl_columns_put(p->f_s, i, tl_v3_scale(-p->area[i], shear));
    p->flags[i] = 0;
}

/* Puts the stress on a contact, whose points have initial forces. */
static void load_contact(tl_model *m, const tl_insitu *s, uint32_t c)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_point_lanes *lanes = &m->detect->lanes[0];
    double centroid_z = m->origin.z + tl_side_place(m, tl_contact_sides(m, c).a).z;
    tl_contact_places(m, c, lanes);
    m->detect->contacts.holds_over_gap[c] = true; /* perhaps: the next step tells */
    if (contacts->facet[c].kind != TL_FACET_PATCH || !faces_meet(m, c))
        return;
    contacts->stored[c] = NAN;
    double opening[TL_LANES];
    for (size_t i = 0; i < contacts->point_count[c]; i++) {
        if (i % TL_LANES == 0)
            tl_contact_point_openings(m, c, i, opening);
        tl_sym3 stress = stress_at(s, centroid_z + lanes->arm[2][i]);
        load_point(&m->detect->points, tl_point_row(contacts, c, i), &stress, tl_columns_get(lanes->normal, i),
                   lanes->closure[i], opening[i % TL_LANES]);
    }
}

/* Says so when the stress pulls at faces: most likely its sign is that of compression. */
static void say_tension(tl_model *m, const tl_insitu *s)
{
    const tl_detect *d = m->detect;
    double most = 0;
    size_t pulled = 0;
    tl_id a = TL_NO_ID, b = TL_NO_ID;
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t c = 0; c < d->contacts.table.rows; c++) {
            double force = 0, area = 0;
            for (uint32_t k = 0; k < d->contacts.point_count[c]; k++) {
                size_t i = tl_point_row(&d->contacts, c, k);
                bool loaded = d->points.f_n0 && d->points.f_n0[i] != 0;
                force += loaded ? d->points.f_n0[i] : 0;
                area += loaded ? d->points.area[i] : 0;
            }
            double stress = area > 0 ? force / area : 0;
            if (pass == 0)
                most = fmax(most, fabs(stress));
            else if (stress < -PULL * most && pulled++ == 0) {
                a = m->blocks.id[d->contacts.a[c]];
                b = m->blocks.id[d->contacts.b[c]];
            }
        }
    const tl_id zoned = pulled ? TL_NO_ID : tl_insitu_pulls(m, PULL);
    if (zoned != TL_NO_ID && tl_model_says(m, TL_REMARK_TENSION))
        tl_model_say(m,
                     "insitu: the mean stress in block %u is tension, which is positive; give compression as negative "
                     "numbers",
                     zoned);
    if (pulled && tl_model_says(m, TL_REMARK_TENSION))
        tl_model_say(m,
                     "insitu: the stress pulls at %zu contact%s (first: between blocks %u and %u): it is positive in "
                     "tension; give compression as negative numbers, as in zz = %g",
                     pulled, pulled == 1 ? "" : "s", a, b, s->stress.zz != 0 ? -fabs(s->stress.zz) : -1e6);
}

/* Says which contacts were left out although much of a face presses there: their blocks overlap too deeply for a patch,
 * or their faces tilt. */
static void say_left_out(tl_model *m)
{
    const tl_contacts *c = &m->detect->contacts;
    size_t count = 0;
    uint32_t first = TL_NO_ROW;
    for (uint32_t i = 0; i < c->table.rows; i++) {
        const double face = fmin(m->blocks.mean_face[c->a[i]], m->blocks.mean_face[c->b[i]]);
        if (!tl_facet_is_field(&c->facet[i]) || c->point_count[i] == 0 || !(c->area[i] > MUCH * face))
            continue;
        first = count++ == 0 ? i : first;
    }
    if (count)
        tl_model_say(
            m,
            "insitu: %zu contact%s (first: between blocks %u and %u, which overlap by %.3g m) got no stress, for "
            "faces that overlap or tilt so much have no patch to bear it: %s before insitu takes them as "
            "fitting",
            count, count == 1 ? "" : "s", m->blocks.id[c->a[first]], m->blocks.id[c->b[first]],
            tl_press_row_of(m, first)->press.deepest, tl_words(m, "model:seat{}", "tl_model_seat()"));
}

/* Area of a block's face that is covered by contact patches. */
static double covered_area(const tl_model *m, uint32_t row, uint32_t face)
{
    const tl_contacts *c = &m->detect->contacts;
    double area = 0;
    for (tl_body_contacts at = tl_contacts_of_block(m, row); tl_next_contact(&at);) {
        uint32_t i = at.contact;
        const tl_facet *f = &c->facet[i];
        if (tl_facet_is_patch(f) && (c->a[i] == row ? f->ia : f->ib) == face)
            area += c->area[i];
    }
    return area;
}

/* Area of a block's face that lies on other blocks of its body. */
static tl_status inner_area(tl_model *m, uint32_t row, uint32_t face, double *area)
{
    const tl_poly *shape = m->blocks.shape[row];
    uint32_t body = m->blocks.body[row];
    const uint32_t *member = tl_body_blocks(m, body);
    *area = 0;
    for (uint32_t i = 0; i < m->bodies.member_count[body]; i++) {
        const tl_poly *other = m->blocks.shape[member[i]];
        for (uint32_t f = 0; f < other->face_count && member[i] != row; f++) {
            double shared;
            if (!tl_poly_shared_area(shape, face, other, f, &shared))
                return tl_fail_memory(&m->error);
            *area += shared;
        }
    }
    return TL_OK;
}

/* Length of the traction on a block's face. */
static double face_traction(const tl_model *m, const tl_insitu *s, uint32_t row, uint32_t face)
{
    uint32_t body = m->blocks.body[row];
    const tl_poly *shape = m->blocks.shape[row];
    tl_vec3 n = tl_m3_mul(&m->bodies.pose[body].r, shape->plane[face].normal);
    double z = tl_model_point(m, body, tl_poly_face_centroid(shape, face)).z;
    return tl_v3_norm(tl_s3_mul(stress_at(s, z), n));
}

/* Sets *outer when the stress would act on a bare part of the block's surface. Tractions below `least` are none. */
static tl_status has_outer_face(tl_model *m, const tl_insitu *s, uint32_t row, double least, bool *outer)
{
    const tl_poly *shape = m->blocks.shape[row];
    tl_status status = TL_OK;
    *outer = false;
    for (uint32_t f = 0; f < shape->face_count && !*outer && status == TL_OK; f++) {
        if (shape->covered[f] || face_traction(m, s, row, f) <= least)
            continue;
        double area = tl_poly_face_area(shape, f), bare = area - covered_area(m, row, f), inner = 0;
        double enough = BARE * fmax(area, m->blocks.mean_face[row]);
        if (bare > enough)
            status = inner_area(m, row, f, &inner);
        *outer = bare - inner > enough;
    }
    return status;
}

/* Blocks that can move and have an outer face on which the stress would act: nothing holds it there. */
typedef struct outer_blocks {
    size_t count;
    tl_id first;
} outer_blocks;

static tl_status find_outer(tl_model *m, const tl_insitu *s, outer_blocks *found)
{
    *found = (outer_blocks){0, TL_NO_ID};
    double most = 0;
    for (uint32_t row = 0; row < m->blocks.table.rows; row++)
        for (uint32_t f = 0; f < m->blocks.shape[row]->face_count; f++)
            most = fmax(most, face_traction(m, s, row, f));
    tl_status status = TL_OK;
    for (uint32_t row = 0; row < m->blocks.table.rows && status == TL_OK; row++) {
        bool outer = false;
        if (m->bodies.fixed[m->blocks.body[row]] != TL_FIX_ALL)
            status = has_outer_face(m, s, row, NO_TRACTION * most, &outer);
        found->count += outer;
        if (outer && found->first == TL_NO_ID)
            found->first = m->blocks.id[row];
    }
    return status;
}

static void say_outer(tl_model *m, const outer_blocks *found)
{
    if (found->count)
        tl_model_say(m,
                     "insitu: %zu block%s that can move (first: block %u) %s an outer face on which the stress does "
                     "not act; fix the blocks around the region of interest",
                     found->count, found->count == 1 ? "" : "s", found->first, found->count == 1 ? "has" : "have");
}

static bool is_bearable(tl_sym3 t)
{
    return fabs(t.xx) <= MOST_STRESS && fabs(t.yy) <= MOST_STRESS && fabs(t.zz) <= MOST_STRESS &&
           fabs(t.xy) <= MOST_STRESS && fabs(t.yz) <= MOST_STRESS && fabs(t.zx) <= MOST_STRESS;
}

static double largest(tl_sym3 t)
{
    return fmax(fmax(fabs(t.xx), fmax(fabs(t.yy), fabs(t.zz))), fmax(fabs(t.xy), fmax(fabs(t.yz), fabs(t.zx))));
}

/* Fails when the gradient alone makes more of a stress in some block than is taken. */
static tl_status check_gradient(tl_model *m, const tl_insitu *s)
{
    const double steepest = largest(s->gradient);
    for (uint32_t row = 0; row < m->blocks.table.rows; row++) {
        const uint32_t body = m->blocks.body[row];
        const double z = m->origin.z + tl_body_place(&m->bodies, body).z;
        const double height = fabs(z - s->at.z) + m->bodies.radius[body];
        if (!(steepest * height <= MOST_STRESS))
            return tl_fail(&m->error, TL_E_ARGUMENT,
                           "insitu: the gradient, %g Pa/m, over the height of %g m between at and block %u makes more "
                           "than the %g Pa that are taken: give an at near the blocks, or a smaller gradient",
                           steepest, height, m->blocks.id[row], MOST_STRESS);
    }
    return TL_OK;
}

/* Lists which rows of blocks are meant, 1 each, or NULL for all. */
static tl_status choose_blocks(tl_model *m, const tl_insitu *s, uint8_t **chosen)
{
    *chosen = NULL;
    if (!s->blocks)
        return TL_OK;
    *chosen = calloc(m->blocks.table.rows + 1, 1);
    if (!*chosen)
        return tl_fail_memory(&m->error);
    for (size_t k = 0; k < s->block_count; k++)
        (*chosen)[tl_block_row_quiet(m, s->blocks[k])] = 1;
    return TL_OK;
}

/* Puts the stress on what is meant. Rows of blocks have been tidied. */
static tl_status put_stress(tl_model *m, const tl_insitu *s)
{
    uint8_t *chosen;
    const tl_contacts *c = &m->detect->contacts;
    tl_status status = choose_blocks(m, s, &chosen);
    if (status == TL_OK && !(tl_detect_hold_initial(m->detect) && tl_insitu_zones_prepare(m)))
        status = tl_fail_memory(&m->error);
    for (uint32_t i = 0; status == TL_OK && i < c->table.rows; i++)
        if (!chosen || chosen[c->a[i]] || chosen[c->b[i]])
            load_contact(m, s, i);
    if (status == TL_OK)
        tl_insitu_zones(m, s, chosen);
    free(chosen);
    return status;
}

tl_status tl_model_insitu(tl_model *m, const tl_insitu *given)
{
    tl_insitu insitu;
    tl_status status = TL_OPTIONS_READ(tl_insitu, given, &insitu, &m->error);
    if (status == TL_OK)
        status = tl_model_may_set(m, "put stress on contacts");
    if (status != TL_OK)
        return status;
    if (!is_bearable(insitu.stress) || !is_bearable(insitu.gradient) || !tl_v3_finite(insitu.at))
        return tl_fail(&m->error, TL_E_ARGUMENT,
                       "insitu: stress, Pa, gradient, Pa/m, and at must be finite numbers, the first two of at most %g",
                       MOST_STRESS);
    status = check_gradient(m, &insitu);
    if (status != TL_OK)
        return status;
    if (insitu.blocks)
        status = tl_blocks_check(m, insitu.blocks, insitu.block_count);
    if (status != TL_OK)
        return status;
    /* in the present places, where a step that failed has left the contacts already */
    tl_segments_forget_asked(m);
    status = tl_detect_update(m);
    if (status == TL_OK)
        status = tl_segments_find(m);
    outer_blocks outer;
    if (status == TL_OK)
        status = find_outer(m, &insitu, &outer);
    if (status == TL_OK)
        status = put_stress(m, &insitu);
    if (status != TL_OK)
        return status;
    m->split_count = 0; /* new faces carry what the stress says, and no longer what holds parts as the whole went on */
    m->laws++;          /* contacts hold another energy */
    tl_undo_by_hand(m);
    tl_held_wake(m);
    say_outer(m, &outer);
    say_left_out(m);
    say_tension(m, &insitu);
    return TL_OK;
}
