/* pair_view.c - what the geometry of a pair gets of the model: where the two blocks are, and the rule of their
 * joint. */
#include "contact/pair_view.h"

#include "model/joints.h"
#include "narrow/flush.h"

tl_pair_view tl_pair_view_at(const tl_model *m, uint32_t a, uint32_t b, tl_sides sides)
{
    const tl_blocks *blocks = &m->blocks;
    const tl_mat3 *ra = tl_side_rotation(m, sides.a), *rb = tl_side_rotation(m, sides.b);
    return (tl_pair_view){.a = blocks->shape[a],
                          .b = blocks->shape[b],
                          .turn = tl_m3_tproduct(ra, rb),
                          .shift = tl_m3_tmul(ra, tl_sides_apart(m, sides)),
                          .size = fmin(blocks->size[a], blocks->size[b]),
                          .mean_face = fmin(blocks->mean_face[a], blocks->mean_face[b])};
}

tl_touch_rule tl_touch_rule_of(const tl_model *m, const tl_pair_view *view, tl_tag tag, double over)
{
    tl_min_area_rule rule = tl_min_area_of(m, tag);
    const tl_law *law = tl_law_of(m, tag);
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
           tl_at_corners(m->blocks.shape[a], face_a, m->blocks.shape[b], face_b);
}
