/* sides.h - the two sides of a contact: where they are, how they move and on which bodies their forces act.
 *
 * A side is a row of the table of poses (tl_pose), in which the bodies come first. A block is rigid, so its side is its
 * body. No other source looks up the pose of a side. */
#ifndef TL_CONTACT_SIDES_H
#define TL_CONTACT_SIDES_H

#include "contact/detection.h"
#include "model/model.h"
#include "model/seats.h"

typedef struct tl_sides {
    uint32_t a, b; /* rows of poses */
} tl_sides;

/* The side of a block, and those of two blocks and of a contact. */
static inline uint32_t tl_block_side(const tl_model *m, uint32_t block)
{
    return m->blocks.body[block];
}
static inline tl_sides tl_pair_sides(const tl_model *m, uint32_t block_a, uint32_t block_b)
{
    return (tl_sides){tl_block_side(m, block_a), tl_block_side(m, block_b)};
}
/* Those of a contact some of whose sides may be carried. */
tl_sides tl_carried_sides(const tl_contacts *c, uint32_t contact, tl_sides own);
static inline tl_sides tl_contact_sides(const tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    const tl_sides out = tl_pair_sides(m, c->a[contact], c->b[contact]);
    return __builtin_expect(c->carrier[0] != NULL, 0) ? tl_carried_sides(c, contact, out) : out;
}
/* What carries a side; NULL: its body does. */
static inline const tl_carrier *tl_side_carrier(const tl_model *m, uint32_t side)
{
    if (__builtin_expect(!(side & TL_CARRIED), 1))
        return NULL;
    return &m->detect->contacts.carrier[side & 1][(side & ~TL_CARRIED) / 2];
}
/* The body of a side. */
static inline uint32_t tl_side_body(const tl_model *m, uint32_t side)
{
    const uint32_t contact = (side & ~TL_CARRIED) / 2;
    if (!(side & TL_CARRIED))
        return side;
    return m->blocks.body[(side & 1 ? m->detect->contacts.b : m->detect->contacts.a)[contact]];
}
/* The bodies to whose sums the forces on the two sides are added. */
static inline tl_sides tl_contact_bodies(const tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    return (tl_sides){m->blocks.body[c->a[contact]], m->blocks.body[c->b[contact]]};
}

static inline const tl_pose *tl_side_pose(const tl_model *m, uint32_t side)
{
    const tl_carrier *by = tl_side_carrier(m, side);
    return by ? &by->pose : &m->bodies.pose[side];
}
/* The rotation of a side as a matrix and as a quaternion. */
static inline const tl_mat3 *tl_side_rotation(const tl_model *m, uint32_t side)
{
    return &tl_side_pose(m, side)->r;
}
static inline tl_quat tl_side_quaternion(const tl_model *m, uint32_t side)
{
    const tl_carrier *by = tl_side_carrier(m, side);
    return by ? by->q : m->bodies.q[side];
}
/* Present place of a side's centroid, relative to the origin: arms of a contact begin at that of A. */
static inline tl_vec3 tl_side_place(const tl_model *m, uint32_t side)
{
    const tl_pose *pose = tl_side_pose(m, side);
    return tl_v3_add(pose->x_ref, pose->u);
}
/* A place relative to the origin in a side's frame. */
static inline tl_vec3 tl_side_local(const tl_model *m, uint32_t side, tl_vec3 place)
{
    return tl_m3_tmul(tl_side_rotation(m, side), tl_v3_sub(place, tl_side_place(m, side)));
}
/* The arm of a point of a side's frame: from the centroid, in the model's axes. */
static inline tl_vec3 tl_side_arm(const tl_model *m, uint32_t side, tl_vec3 local)
{
    return tl_m3_mul(tl_side_rotation(m, side), local);
}
/* From A's centroid to B's. */
static inline tl_vec3 tl_sides_apart(const tl_model *m, tl_sides sides)
{
    const tl_pose *a = &m->bodies.pose[sides.a], *b = &m->bodies.pose[sides.b];
    if (__builtin_expect((sides.a | sides.b) & TL_CARRIED, 0)) {
        a = tl_side_pose(m, sides.a);
        b = tl_side_pose(m, sides.b);
    }
    return tl_apart(a->x_ref, a->u, b->x_ref, b->u);
}

/* Velocity of a side at an arm. */
static inline tl_vec3 tl_side_velocity(const tl_model *m, uint32_t side, tl_vec3 arm)
{
    const tl_carrier *by = tl_side_carrier(m, side);
    const tl_vec3 v = by ? by->v : m->bodies.v[side], w = by ? by->w : m->bodies.w[side];
    return tl_v3_add(v, tl_v3_cross(w, arm));
}
/* No point of a side is farther from its centroid. */
static inline double tl_side_radius(const tl_model *m, uint32_t side)
{
    return m->bodies.radius[tl_side_body(m, side)];
}
/* The odometers of both sides, summed. */
double tl_carried_odometer(const tl_model *m, uint32_t contact);
static inline double tl_contact_odometer(const tl_model *m, uint32_t contact)
{
    const tl_contacts *c = &m->detect->contacts;
    if (__builtin_expect(c->carrier[0] != NULL, 0))
        return tl_carried_odometer(m, contact);
    return m->bodies.odometer[m->blocks.body[c->a[contact]]] + m->bodies.odometer[m->blocks.body[c->b[contact]]];
}

/* Whether a block is on side B of its contact: a contact's force acts on B as it is, on A reversed. */
static inline bool tl_contact_is_b(const tl_contacts *c, uint32_t contact, uint32_t block)
{
    return c->b[contact] == block;
}
static inline double tl_contact_sign(const tl_contacts *c, uint32_t contact, uint32_t block)
{
    return tl_contact_is_b(c, contact, block) ? 1 : -1;
}
/* Moment of forces of a contact on A, or on B, about the centroid of that side; of a force and a moment on B, about A's
 * centroid. */
static inline tl_vec3 tl_contact_moment_of(const tl_model *m, uint32_t contact, bool on_b, tl_vec3 force,
                                           tl_vec3 moment)
{
    if (!on_b)
        return tl_v3_neg(moment);
    tl_vec3 apart = tl_sides_apart(m, tl_contact_sides(m, contact));
    return tl_v3_sub(moment, tl_v3_cross(apart, force));
}
/* Of its own forces. */
static inline tl_vec3 tl_contact_moment(const tl_model *m, uint32_t contact, bool on_b)
{
    const tl_contacts *c = &m->detect->contacts;
    return tl_contact_moment_of(m, contact, on_b, c->force[contact], c->moment[contact]);
}

#endif
