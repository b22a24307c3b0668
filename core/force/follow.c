/* follow.c - what a step does with every contact whose facets stand: gaps, normals and relative motion
 * of its points in the present place.
 *
 * Shear forces are turned with the common plane, exactly from the old normal to the new and by the bodies' mean spin
 * about it; (5) of Hart, Cundall and Lemos (1988) is the first order of this. Two bodies that turn as one make no
 * slip, and their forces turn with them.
 *
 * Eight contacts are worked on side by side (tl_rank). What is the same for all points of a contact is brought into
 * matrices first, one in each lane (*frames*), so that what is left for a point are a few products, in loops over
 * columns without a branch. Ranks of one flush patch in each lane, as most are, take the shortest way; else slot
 * follows slot, and each lane goes on to its contact's next facet where that begins. */
#include "force/follow.h"

#include "base/columns.h"
#include "contact/detection.h"
#include "contact/places.h"
#include "contact/points.h"
#include "force/frames.h"
#include "force/turning.h"

#include <string.h>

/* Lanes up to which each is followed on its own. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) /* without vectors */
#define FEW TL_LANES
#else
#define FEW 3
#endif

/* ---------------------------------------------------------------- points ----------------- */

/* Columns of points and lanes, row 0 of both the first of a rank. */
typedef struct columns {
    const int16_t *face, *edge; /* tl_lean, in steps */
    const double *reference;
    double *p[3], *f_s[3];
    double *arm[3], *normal[3], *closure, *du_n, *du_s[3], *couple[3];
} columns;

static columns columns_at(const tl_points_table *p, size_t row, const tl_point_lanes *t,
                          size_t lane)
{
    return (columns){
        .p = {p->p[0] + row, p->p[1] + row, p->p[2] + row},
        .face = p->lean_face + row,
        .edge = p->lean_edge + row,
        .reference = p->reference ? p->reference + row : t->zero + lane,
        .f_s = {p->f_s[0] + row, p->f_s[1] + row, p->f_s[2] + row},
        .arm = {t->arm[0] + lane, t->arm[1] + lane, t->arm[2] + lane},
        .normal = {t->normal[0] + lane, t->normal[1] + lane, t->normal[2] + lane},
        .closure = t->closure + lane,
        .du_n = t->du_n + lane,
        .du_s = {t->du_s[0] + lane, t->du_s[1] + lane, t->du_s[2] + lane},
        .couple = {t->couple[0] + lane, t->couple[1] + lane, t->couple[2] + lane},
    };
}

TL_INLINE void put(double *const column[3], size_t i, tl_vec3 v)
{
    tl_columns_put(column, i, v);
}

/* The points of flush patches: all of a contact have one normal. */
TL_VECTORIZED static void follow_level(const columns *c, size_t slots, const tl_frames *restrict f)
{
    for (size_t at = 0; at < slots * TL_LANES; at += TL_LANES)
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++) {
            size_t i = at + l;
            tl_mat3 to = tl_lanes9_get(&f->to, l), motion = tl_lanes9_get(&f->m, l);
            tl_mat3 turn = tl_lanes9_get(&f->turn, l);
            tl_vec3 n = tl_lanes3_get(&f->n, l);
            tl_vec3 x = tl_m3_mul(&to, tl_columns_get(c->p, i));
            tl_vec3 du = tl_v3_add(tl_lanes3_get(&f->way, l), tl_m3_mul(&motion, x));
            double du_n = tl_v3_dot(du, n);
            put(c->arm, i, x);
            put(c->normal, i, n);
            c->closure[i] =
                f->offset[l] - tl_v3_dot(tl_lanes3_get(&f->plane, l), x) - c->reference[i];
            c->du_n[i] = du_n;
            put(c->du_s, i, tl_v3_madd(du, -du_n, n));
            put(c->f_s, i, tl_m3_mul(&turn, tl_columns_get(c->f_s, i)));
        }
}

/* Turns the shear force of a point with its facet, and then, as the tilt has changed, from its normal `before` that was
 * turned as well into its normal n: v - (v . n)(before + n) / (1 + before . n), short of the fourth power of the change, and into
 * the plane of n whatever rounding has left of v beside that of `before`. */
TL_INLINE tl_vec3 turn_shear(tl_vec3 v, size_t l, const tl_frames *restrict f, tl_vec3 n,
                             double face, double edge)
{
    tl_mat3 turn = tl_lanes9_get(&f->turn, l);
    v = tl_m3_mul(&turn, v);
    tl_vec3 before =
        tl_leaning(tl_lanes3_get(&f->was, l), tl_lanes3_get(&f->was_lean, l),
                   tl_lanes3_get(&f->was_across, l), f->was2[l], f->was_l2[l], face, edge);
    tl_vec3 way = tl_v3_sub(n, before);
    double lifted = f->tilted[l] * tl_v3_dot(v, way), along = tl_v3_dot(v, n);
    tl_vec3 out = tl_v3_madd(tl_v3_scale(1 + 0.5 * tl_v3_dot(way, n), n), -0.5, way);
    out = tl_v3_madd(v, -along, out);
    /* what has not turned stays as it is, to the bit */
    return tl_v3(lifted != 0 ? out.x : v.x, lifted != 0 ? out.y : v.y, lifted != 0 ? out.z : v.z);
}

/* A point of any facet, in row i of lane l. Features of a tilted patch move: a vertex of A with A (lean -1), one of B with
 * B (lean 1), what lies between with both; so do the points until the patch is made anew, and the gap opens along the
 * point's normal. */
TL_INLINE void follow_point(const columns *c, size_t i, size_t l, const tl_frames *restrict f,
                            double face, double edge)
{
    tl_mat3 to = tl_lanes9_get(&f->to, l), motion = tl_lanes9_get(&f->m, l);
    tl_vec3 lean = tl_lanes3_get(&f->lean, l), across = tl_lanes3_get(&f->across, l);
    tl_vec3 p = tl_columns_get(c->p, i);
    tl_vec3 x = tl_v3_add(tl_m3_mul(&to, p), tl_lanes3_get(&f->from, l));
    tl_vec3 n =
        tl_leaning(tl_lanes3_get(&f->mean, l), lean, across, f->mean2[l], f->l2[l], face, edge);
    tl_vec3 du = tl_v3_add(tl_lanes3_get(&f->way, l), tl_m3_mul(&motion, x));
    double du_n = tl_v3_dot(du, n);
    /* with the features that made it, along the faces; where two edges cross, also up the faces by how far one edge has
     * slid over the other */
    tl_vec3 go = tl_v3_scale(f->carry[l] * (1 + face), du);
    go = tl_v3_madd(go, f->slide[l] * edge * tl_v3_dot(across, du), lean);
    x = tl_v3_add(x, go);
    put(c->p, i, tl_v3_add(p, tl_m3_tmul(&to, go)));
    c->closure[i] = f->offset[l] - tl_v3_dot(tl_lanes3_get(&f->plane, l), x) - c->reference[i];
    put(c->arm, i, x);
    put(c->normal, i, n);
    c->du_n[i] = du_n;
    put(c->du_s, i, tl_v3_madd(du, -du_n, n));
    put(c->f_s, i, turn_shear(tl_columns_get(c->f_s, i), l, f, n, face, edge));
}

typedef int16_t steps __attribute__((vector_size(TL_LANES * sizeof(int16_t))));
typedef int32_t whole __attribute__((vector_size(TL_LANES * sizeof(int32_t))));
typedef double octet __attribute__((vector_size(TL_LANES * sizeof(double))));

/* Steps of all lanes as they are kept, times the length of one. */
TL_INLINE void widen(double *to, const int16_t *from, double step)
{
    steps some;
    memcpy(&some, from, sizeof some);
    octet all = step * __builtin_convertvector(__builtin_convertvector(some, whole), octet);
    memcpy(to, &all, sizeof all);
}

/* Points of any facets, all lanes at once. */
TL_VECTORIZED static void follow_any(const columns *in, size_t begin, size_t end,
                                     const tl_frames *restrict f)
{
    const columns copy = *in, *c = &copy; /* which no store through a column can change */
    for (size_t slot = begin; slot < end; slot++) {
        double face[TL_LANES], edge[TL_LANES];
        widen(face, c->face + slot * TL_LANES, (double)TL_LEAN_FACE_STEP);
        widen(edge, c->edge + slot * TL_LANES, (double)TL_LEAN_EDGE_STEP);
#pragma omp simd
        for (size_t l = 0; l < TL_LANES; l++)
            follow_point(c, slot * TL_LANES + l, l, f, face[l], edge[l]);
    }
}

/* The same lane by lane: for a few it is quicker. */
static void follow_few(const columns *c, size_t begin, size_t end, const tl_frames *restrict f,
                       size_t lanes)
{
    for (size_t slot = begin; slot < end; slot++)
        for (size_t l = 0; l < lanes; l++) {
            size_t i = slot * TL_LANES + l;
            follow_point(c, i, l, f, (double)TL_LEAN_FACE_STEP * c->face[i],
                         (double)TL_LEAN_EDGE_STEP * c->edge[i]);
        }
}

/* ---------------------------------------------------------------- ranks ------------------ */

/* Turns the tangent states of a contact's points. */
static void turn_states(tl_model *m, uint32_t contact, const tl_facet *f, const columns *c,
                        size_t l, tl_vec3 half, uint32_t tangents)
{
    tl_points_table *p = &m->detect->points;
    for (uint32_t k = 0; k + 2 < p->state_columns; k++) {
        double *v[3] = {p->state[k], p->state[k + 1], p->state[k + 2]};
        for (uint32_t j = f->begin; j < f->begin + (uint32_t)f->count && tangents >> k & 1; j++) {
            size_t row = tl_point_row(&m->detect->contacts, contact, j), lane = j * TL_LANES + l;
            tl_vec3 before = tl_facet_last_normal(f, tl_point_lean(p, row));
            tl_columns_put(
                v, row,
                tl_turn_one(tl_columns_get(v, row), before, tl_columns_get(c->normal, lane), half));
        }
    }
}

/* The states that turn, and the normal to turn from in the next step. */
static void finish_facet(tl_model *m, const tl_rank *rank, const columns *c, const tl_frames *f,
                         size_t l, uint32_t tangents)
{
    tl_facet *facet = f->facet[l];
    if (!facet)
        return;
    if (tangents)
        turn_states(m, rank->contact[l], facet, c, l, tl_lanes3_get(&f->half, l), tangents);
    facet->last = tl_lanes3_get(&f->mean, l);
    facet->last_lean = tl_lanes3_get(&f->lean, l);
}

/* The same of flush patches: theirs do not lean, and did not. */
static void finish_level(const tl_frames *f)
{
    for (size_t l = 0; l < TL_LANES; l++)
        if (f->facet[l])
            f->facet[l]->last = tl_lanes3_get(&f->n, l);
}

/* Lanes of the rank that hold a contact of one patch and nothing else, or no contact: all of them? `some` is one of the
 * former. */
static bool take_patches(tl_detect *d, const tl_rank *rank, tl_frames *f, size_t *some)
{
    tl_contacts *c = &d->contacts;
    *some = TL_LANES;
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t contact = rank->contact[l];
        f->facet[l] = NULL;
        if (contact == TL_NO_ROW)
            continue;
        f->facet[l] = &c->facet[c->facet_start[contact]];
        if (c->facet_count[contact] != 1 || f->facet[l]->kind != TL_FACET_PATCH)
            return false;
        *some = l;
    }
    return *some < TL_LANES;
}

static double carry_of(const tl_contacts *contacts, uint32_t contact)
{
    return contacts->fresh[contact] ? 0 : 0.5;
}

/* The bodies of the contacts of a rank; lanes without a facet do as lane `some`. */
static void look_up_bodies(const tl_model *m, const tl_rank *rank, const tl_frames *f, size_t some,
                           tl_body_rows *rows)
{
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_pose *pose = m->bodies.pose;
    rows->dt = m->dt;
    for (size_t l = 0; l < TL_LANES; l++) {
        uint32_t contact = rank->contact[f->facet[l] ? l : some];
        rows->a[l] = &pose[m->blocks.body[contacts->a[contact]]].r.m[0][0];
        rows->b[l] = &pose[m->blocks.body[contacts->b[contact]]].r.m[0][0];
    }
}

/* How a step found a rank: flush now and before; tilted, but with areas that do not depend on it; with couples. */
typedef enum found { FLUSH, TILTED, COUPLED } found;

/* The patches that have been taken. */
static found follow_patches(tl_model *m, const tl_rank *rank, const columns *c, tl_frames *f,
                            size_t some)
{
    tl_patch_rows rows;
    look_up_bodies(m, rank, f, some, &rows.bodies);
    for (size_t l = 0; l < TL_LANES; l++) {
        size_t from = f->facet[l] ? l : some;
        rows.facet[l] = &f->facet[from]->na.x;
        rows.carry[l] = carry_of(&m->detect->contacts, rank->contact[from]);
    }
    if (!tl_frames_put_patches(f, &rows)) {
        follow_level(c, rank->slots, f);
        return FLUSH;
    }
    follow_any(c, 0, rank->slots, f);
    tl_lanes3 swing = {0};
    double coupled = 0;
    for (size_t l = 0; l < TL_LANES; l++) {
        tl_vec3 one = f->facet[l] ? tl_facet_swing(f->facet[l]) : tl_v3(0, 0, 0);
        tl_lanes3_put(&swing, l, one);
        coupled += fabs(one.x) + fabs(one.y) + fabs(one.z);
    }
    if (!(coupled > 0))
        return TILTED;
    tl_frames_put_couples(c->couple, 0, rank->slots, &f->to, &swing);
    return COUPLED;
}

/* The facet of a contact that begins in a slot, looked for from number *next on; NULL when none does. */
static tl_facet *facet_at(const tl_contacts *contacts, uint32_t contact, uint32_t slot,
                          uint32_t *next)
{
    if (contact == TL_NO_ROW || slot >= contacts->point_count[contact])
        return NULL;
    tl_facet *facet = &contacts->facet[contacts->facet_start[contact]];
    while (*next < contacts->facet_count[contact]) {
        tl_facet *one = &facet[(*next)++];
        if (one->begin == slot && one->count > 0)
            return one;
    }
    return NULL;
}

/* Goes on to the facets that begin in a slot; where a lane's contact ends before, it stays as it is, inert. Returns the
 * lanes that go on, a bit each; *until is the slot up to which no other facet begins. */
static uint32_t next_facets(tl_model *m, const tl_rank *rank, const columns *c, tl_frames *f,
                            uint32_t *next, uint32_t slot, uint32_t tangents, uint32_t *until)
{
    uint32_t on = 0, first = rank->slots;
    for (uint32_t l = 0; l < TL_LANES; l++)
        on |= (uint32_t)(f->end[l] == slot) << l;
    for (uint32_t left = on; left; left &= left - 1) {
        size_t l = (size_t)__builtin_ctz(left);
        finish_facet(m, rank, c, f, l, tangents);
        f->facet[l] = facet_at(&m->detect->contacts, rank->contact[l], slot, &next[l]);
        f->end[l] = f->facet[l] ? slot + f->facet[l]->count : rank->slots;
    }
    for (size_t l = 0; l < TL_LANES; l++)
        first = f->end[l] < first ? f->end[l] : first;
    *until = first;
    return on;
}

/* Lanes up to the last that has a contact. */
static size_t used_lanes(const tl_rank *rank)
{
    size_t lanes = TL_LANES;
    while (lanes > 0 && rank->contact[lanes - 1] == TL_NO_ROW)
        lanes--;
    return lanes;
}

/* A rank whose contacts have no facets: inert, but finite. */
static void follow_nothing(const columns *c, size_t slots, tl_frames *f)
{
    memset(f, 0, sizeof *f);
    for (size_t l = 0; l < TL_LANES; l++)
        f->mean2[l] = f->was2[l] = 1;
    follow_any(c, 0, slots, f);
}

/* Puts a facet of contact c into lane l of rows whose bodies are there. */
static void put_row(tl_facet_rows *rows, size_t l, const tl_model *m, uint32_t c,
                    const tl_facet *facet, double carry)
{
    rows->facet[l] = &facet->na.x;
    rows->carry[l] = carry;
    rows->kind[l] = facet->kind;
    tl_lanes3_put(&rows->swing, l, tl_facet_swing(facet));
    if (facet->kind != TL_FACET_EDGES)
        return;
    const tl_contacts *contacts = &m->detect->contacts;
    const tl_poly *a = m->blocks.shape[contacts->a[c]], *b = m->blocks.shape[contacts->b[c]];
    const tl_edge *ea = &a->edge[facet->ia], *eb = &b->edge[facet->ib];
    tl_vec3 from_a = a->vertex[ea->a], from_b = b->vertex[eb->a];
    tl_lanes3_put(&rows->from_a, l, from_a);
    tl_lanes3_put(&rows->from_b, l, from_b);
    tl_lanes3_put(&rows->along_a, l, tl_v3_sub(a->vertex[ea->b], from_a));
    tl_lanes3_put(&rows->along_b, l, tl_v3_sub(b->vertex[eb->b], from_b));
    rows->new_edges = true;
}

/* Whatever facets the rank has: from where one begins in some lane to where the next does. Lanes without one do as another,
 * or as their last; nothing in their rows moves. */
static found follow_facets(tl_model *m, const tl_rank *rank, const columns *c, tl_frames *f,
                           uint32_t tangents)
{
    const tl_contacts *contacts = &m->detect->contacts;
    uint32_t next[TL_LANES] = {0}, until;
    size_t some = 0;
    tl_body_rows bodies;
    tl_facet_rows rows;
    memset(f->end, 0, sizeof f->end);
    memset(f->facet, 0, sizeof f->facet);
    uint32_t on = next_facets(m, rank, c, f, next, 0, tangents, &until);
    while (some < TL_LANES && !f->facet[some])
        some++;
    if (some == TL_LANES) {
        follow_nothing(c, rank->slots, f);
        return TILTED;
    }
    look_up_bodies(m, rank, f, some, &bodies);
    tl_frames_put_bodies(f, &rows, &bodies);
    for (size_t l = 0; l < TL_LANES; l++)
        put_row(&rows, l, m, rank->contact[some], f->facet[some], 0);
    for (uint32_t slot = 0; slot < rank->slots; slot = until) {
        if (slot > 0)
            on = next_facets(m, rank, c, f, next, slot, tangents, &until);
        for (; on; on &= on - 1) {
            size_t l = (size_t)__builtin_ctz(on);
            rows.carry[l] = 0;
            if (f->facet[l])
                put_row(&rows, l, m, rank->contact[l], f->facet[l],
                        carry_of(contacts, rank->contact[l]));
        }
        tl_frames_put_facets(f, &rows);
        follow_any(c, slot, until, f);
        tl_frames_put_couples(c->couple, slot, until, &rows.ra, &rows.swing);
    }
    return COUPLED;
}

/* The couples per energy of the points of some slots, for the facets a few lanes have there. */
static void put_few_couples(const tl_model *m, const tl_rank *rank, const columns *c,
                            const tl_frames *f, size_t begin, size_t end, size_t lanes)
{
    const tl_contacts *contacts = &m->detect->contacts;
    for (size_t l = 0; l < lanes; l++) {
        tl_vec3 couple = {0, 0, 0};
        if (f->facet[l]) {
            uint32_t a = m->blocks.body[contacts->a[rank->contact[l]]];
            couple = tl_m3_mul(&m->bodies.pose[a].r, tl_facet_swing(f->facet[l]));
        }
        for (size_t slot = begin; slot < end; slot++)
            put(c->couple, slot * TL_LANES + l, couple);
    }
}

/* The same for a few lanes, one by one. */
static found follow_few_facets(tl_model *m, const tl_rank *rank, const columns *c, tl_frames *f,
                               size_t lanes, uint32_t tangents)
{
    uint32_t next[TL_LANES] = {0};
    memset(f, 0, sizeof *f);
    for (size_t l = 0; l < TL_LANES; l++)
        f->mean2[l] = f->was2[l] = 1;
    for (uint32_t slot = 0, until; slot < rank->slots; slot = until) {
        uint32_t on = next_facets(m, rank, c, f, next, slot, tangents, &until);
        for (; on; on &= on - 1) {
            size_t l = (size_t)__builtin_ctz(on);
            uint32_t contact = rank->contact[l];
            f->carry[l] = f->slide[l] = 0;
            if (f->facet[l])
                tl_frames_put(f, l, m, contact, f->facet[l],
                              carry_of(&m->detect->contacts, contact));
        }
        follow_few(c, slot, until, f, lanes);
        put_few_couples(m, rank, c, f, slot, until, lanes);
    }
    return COUPLED;
}

bool tl_rank_follow(tl_model *m, const tl_rank *rank, const tl_point_lanes *t, size_t lane,
                    uint32_t tangents)
{
    uint8_t *fresh = m->detect->contacts.fresh;
    columns c = columns_at(&m->detect->points, rank->start, t, lane);
    tl_frames f;
    size_t some, lanes = used_lanes(rank);
    found how;
    if (lanes <= FEW)
        how = follow_few_facets(m, rank, &c, &f, lanes, tangents);
    else if (take_patches(m->detect, rank, &f, &some))
        how = follow_patches(m, rank, &c, &f, some);
    else
        how = follow_facets(m, rank, &c, &f, tangents);
    if (how == FLUSH && !tangents)
        finish_level(&f);
    for (size_t l = 0; l < TL_LANES; l++) {
        if (how != FLUSH || tangents)
            finish_facet(m, rank, &c, &f, l, tangents);
        if (rank->contact[l] != TL_NO_ROW && fresh[rank->contact[l]])
            fresh[rank->contact[l]] = false;
    }
    return how == COUPLED;
}
