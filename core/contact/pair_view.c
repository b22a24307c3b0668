/* pair_view.c - what the geometry of a pair gets of the model: where the two blocks are, and the rule of their
 * joint. */
#include "contact/pair_view.h"

#include "model/joints.h"
#include "model/scope.h"
#include "narrow/flush.h"

#include <float.h>

tl_pair_view tl_pair_view_at(const tl_model *m, uint32_t a, uint32_t b, tl_sides sides)
{
    const tl_blocks *blocks = &m->blocks;
    const tl_mat3 *ra = tl_side_rotation(m, sides.a), *rb = tl_side_rotation(m, sides.b);
    return (tl_pair_view){.a = tl_pair_shape(m, a, b),
                          .b = tl_pair_shape(m, b, a),
                          .turn = tl_m3_tproduct(ra, rb),
                          .shift = tl_m3_tmul(ra, tl_sides_apart(m, sides)),
                          .size = fmin(blocks->size[a], blocks->size[b]),
                          .mean_face = fmin(blocks->mean_face[a], blocks->mean_face[b])};
}

tl_touch_rule tl_touch_rule_of(const tl_model *m, uint32_t a, uint32_t b, const tl_pair_view *view, tl_tag tag,
                               double over)
{
    tl_min_area_rule rule = tl_min_area_of(m, tag);
    const tl_law *law = tl_law_of(m, tag, a, b);
    double tolerance = TL_CONTACT_TOLERANCE * TL_CONTACT_RELEASE * view->size;
    bool absolute = !isnan(rule.absolute);
    return (tl_touch_rule){.min_area = absolute ? rule.absolute : rule.fraction * view->mean_face,
                           .corners = m->config.contact_points == TL_POINTS_CORNERS,
                           .volumes = law && tl_law_presses(law),
                           .opens = law && tl_law_opens(law),
                           .reach = over + tolerance};
}

bool tl_pair_at_corners(const tl_model *m, uint32_t a, uint32_t face_a, uint32_t b, uint32_t face_b)
{
    return m->config.contact_points == TL_POINTS_CORNERS &&
           tl_at_corners(tl_pair_shape(m, a, b), face_a, tl_pair_shape(m, b, a), face_b);
}

/* ---------------------------------------------------------------- where they were --------
 *
 * Odometers count the motion of both sides together, as of blocks that ride side by side on others; against each other
 * these may not have moved at all. */

/* Tolerance: half the spacing of the floats at 1: no number is rounded by a larger share. */
#define ROUNDED (FLT_EPSILON / 2)

typedef struct tl_relative {
    tl_vec3 centroid;
    tl_quat turn;
} tl_relative;

static tl_relative relative(const tl_model *m, tl_sides sides)
{
    return (tl_relative){tl_m3_tmul(tl_side_rotation(m, sides.a), tl_sides_apart(m, sides)),
                         tl_q_mul(tl_q_conj(tl_side_quaternion(m, sides.a)), tl_side_quaternion(m, sides.b))};
}

tl_spot tl_spot_of(const tl_model *m, tl_sides sides, double remaining)
{
    tl_relative s = relative(m, sides);
    return (tl_spot){{(float)s.centroid.x, (float)s.centroid.y, (float)s.centroid.z},
                     {(float)s.turn.w, (float)s.turn.x, (float)s.turn.y, (float)s.turn.z},
                     (float)remaining};
}

/* The difference of two unit quaternions is 2 sin of a quarter of the angle between them. A quaternion and its negative
 * are the same rotation. */
double tl_spot_moved(const tl_model *m, const tl_spot *then, tl_sides sides, double radius)
{
    tl_relative now = relative(m, sides);
    tl_vec3 centroid = {then->centroid[0], then->centroid[1], then->centroid[2]};
    tl_quat p = {then->turn[0], then->turn[1], then->turn[2], then->turn[3]}, q = now.turn;
    double sign = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < 0 ? -1 : 1;
    double w = q.w - sign * p.w, x = q.x - sign * p.x, y = q.y - sign * p.y, z = q.z - sign * p.z;
    double angle = 2 * (sqrt(w * w + x * x + y * y + z * z) + ROUNDED);
    return tl_v3_norm(tl_v3_sub(now.centroid, centroid)) + ROUNDED * tl_v3_norm(centroid) + angle * radius;
}
